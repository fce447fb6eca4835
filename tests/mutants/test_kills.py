"""Which kills of mutants stand: what changes a fingerprint, and what is tried again."""
import os
import tempfile
import unittest

import kills
import test_mutants
from mutants import Mutant, check, test

COMMANDS = [{"command": "cc -o tests/CMakeFiles/test_a.dir/x/test_a.c.o -c test_a.c", "file": "test_a.c"},
            {"command": "cc -o tests/CMakeFiles/test_b.dir/x/test_b.c.o -c test_b.c", "file": "test_b.c"}]


class Kills(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.source = folder.name
        os.makedirs(os.path.join(self.source, "tests/agree/scenes"))
        for name in ("test_a.c", "test_b.c", "ray.cl", "hit.cl", "tests/agree/scenes/glass.json"):
            self.write(name, name)
        self.mutant = Mutant("m", "first", (("ray.cl", "a", "b"),), (test("test_a", "case"), check("glass")))

    def write(self, name, text):
        with open(os.path.join(self.source, name), "w", encoding="utf-8") as file:
            file.write(text)

    def of(self, mutant):
        return kills.Fingerprints(self.source, COMMANDS).of(mutant, ["ray.cl"])

    def test_a_fingerprint_is_of_all_that_the_mutant_names_and_of_nothing_else(self):
        before = self.of(self.mutant)
        for name in ("test_b.c", "hit.cl"):
            self.write(name, "other")
            self.assertEqual(self.of(self.mutant), before, name)
        for name in ("test_a.c", "ray.cl", "tests/agree/scenes/glass.json"):
            self.write(name, "other")
            self.assertNotEqual(self.of(self.mutant), before, name)
            self.write(name, name)
        self.assertNotEqual(self.of(self.mutant._replace(patches=(("ray.cl", "a", "c"),))), before)
        self.assertNotEqual(self.of(self.mutant._replace(trials=(test("test_a", "other"), check("glass")))), before)
        self.assertNotEqual(self.of(self.mutant._replace(trials=(test("test_a", "case"), check("glass", 32)))), before)

    def test_what_has_no_kill_that_stands_is_tried(self):
        names = [f"m{i}" for i in range(64)]
        mutants = [self.mutant._replace(name=name) for name in names]
        found = {name: "new" for name in names[:-1]}  # the last one's patch does not fit
        kept = {name: "new" for name in names} | {"m0": "old"}
        del kept["m1"]
        tried = {m.name for m in test_mutants.chosen(mutants, found, kept, "commit")}
        self.assertLessEqual({"m0", "m1", "m63"}, tried)
        turns = {name for name in names if kills.has_its_turn(name, "commit")}
        self.assertEqual(tried - turns, {"m0", "m1", "m63"} - turns)

    def test_every_mutant_has_its_turn(self):
        turns = [[kills.has_its_turn(f"m{i}", str(commit)) for commit in range(80)] for i in range(40)]
        self.assertTrue(all(any(of_one) for of_one in turns))
        share = sum(map(sum, turns)) / (40 * 80)
        self.assertAlmostEqual(share, 1 / kills.PARTS, delta=0.03)


if __name__ == "__main__":
    unittest.main()
