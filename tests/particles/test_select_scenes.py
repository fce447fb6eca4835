"""Selected particles through the program: what is drawn, framed, coloured and said; films; several entries of one file; the examples of
docs/PARTICLES.md.

Run as: PYTHONPATH=tests/support python3 test_select_scenes.py PROGRAM SOURCE_DIR
"""
import json
import os
import re
import shlex
import struct
import sys

from cli import ProgramTest, main, scene

SIZE = ("--width", 24, "--spp", 2, "-q")
# Ethanol's heavy atoms and a hydroxyl hydrogen, and an iron far away.
ATOMS = [("C", 0, 0, 0), ("C", 1.5, 0, 0), ("O", 2.1, 1.3, 0.2), ("H", 3.0, 1.2, 0.3), ("Fe", 0, 0, 9)]


def xyz(atoms):
    return f"{len(atoms)}\n\n" + "".join(f"{s} {x} {y} {z}\n" for s, x, y, z in atoms)


def atom(i, name, residue, place, element, chain="A", number=1, record="ATOM", letter=" "):
    return (f"{record:6s}{i + 1:5d} {name:4s}{letter}{residue:>3s} {chain}{number:4d}    {place[0]:8.3f}{place[1]:8.3f}{place[2]:8.3f}"
            f"  1.00{10 + i:6.2f}          {element:>2s}\n")


class Selections(ProgramTest):
    def picture(self, name, *arguments):
        self.succeed("render", name, *SIZE, "-o", "x.pfm", *arguments)
        return self.read("x.pfm")

    def document(self, *entries, **members):
        return self.write("x.json", dict({"camera": {"fit": "particles"}, "particles": list(entries)}, **members))

    def shapes(self, name, *arguments):
        """How many spheres and how many capsules the scene has."""
        self.succeed("explain", name, "--json", "e.json", "-q", *arguments)
        [found] = json.loads(self.read("e.json"))["scenes"]
        return found["spheres"], found["capsules"]

    def fail_at(self, *arguments):
        """Refused as a bad command line or scene is."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, 2, f"{arguments}: {result.errors}")
        return result

    def test_a_selection_is_a_file_of_its_own(self):
        """Framed, lit and sized as a file that has no other particles: the same bits."""
        self.write("a.xyz", xyz(ATOMS))
        for select, kept in (("index < 4", ATOMS[:4]), ("not hydrogen and z < 5", ATOMS[:3]), ("element in (O, Fe)", [ATOMS[2], ATOMS[4]]),
                             ("within 1.6 of element == O", ATOMS[1:4]), ("all", ATOMS)):
            self.write("b.xyz", xyz(kept))
            self.assert_same(self.picture("a.xyz", "--select", select), self.picture("b.xyz"), select)
            result = self.succeed("scene", "a.xyz", "--select", select)
            self.assertIn(f"a.xyz: selected {len(kept)} of 5 particles; van der Waals radii", result.errors)
            written = json.loads(result.stdout)
            self.assertEqual(written["particles"], [{"file": "a.xyz", "select": select}])
            self.write("c.json", written)
            self.assert_same(self.picture("c.json"), self.picture("b.xyz"), select)

    def test_bonds_have_both_ends_selected(self):
        self.write("a.xyz", xyz(ATOMS))
        for select, expected in (("all", (5, 3)), ("element == C", (2, 1)), ("not element == O", (4, 1)), ("element in (O, H)", (2, 1)),
                                 ("index in (0, 2)", (2, 0))):
            self.document({"file": "a.xyz", "style": "ball-and-stick", "select": select})
            self.assertEqual(self.shapes("x.json"), expected, select)

    def test_entries_of_one_file(self):
        self.write("a.xyz", xyz(ATOMS))
        self.document({"file": "a.xyz", "select": "element == Fe", "material": "m"},
                      {"file": "a.xyz", "select": "not element == Fe", "style": "ball-and-stick"},
                      materials={"m": {"type": "metal", "albedo": [1, 1, 1], "fuzz": 0.1}})
        self.assertEqual(self.shapes("x.json"), (5, 3))
        # What narrows all of them stands beside their own.
        self.fail_at("scene", "x.json", "--select", "z < 5")  # none of the first entry is left
        written = json.loads(self.succeed("scene", "x.json", "--select", "z > 5 or hydrogen").stdout)
        self.assertEqual([entry["select"] for entry in written["particles"]],
                         ["(element == Fe) and (z > 5 or hydrogen)", "(not element == Fe) and (z > 5 or hydrogen)"])
        self.assertEqual(self.shapes("x.json", "--select", "z > 5 or hydrogen"), (2, 0))

    def test_values_as_colors_and_radii(self):
        rows = "".join(f"{i},{i % 3},{i % 2},{v},{v * v}\n" for i, v in enumerate((1, 2, 0.5, 3, 4)))
        self.write("a.csv", "x,y,z,v,w\n" + rows)
        def shown(color, radius=0.3, select="all"):
            self.document({"file": "a.csv", "color": color, "radius": radius, "select": select})
            return self.picture("x.json")
        self.assert_same(shown({"value": "v", "bar": True}), shown({"column": "v", "bar": True}), "a column alone")
        self.assert_same(shown({"value": "v ^ 2", "map": "plasma"}), shown({"column": "w", "map": "plasma"}), "a square")
        self.assert_same(shown({"value": "norm(v, 0)"}), shown({"column": "v"}), "a norm")
        self.assert_same(shown([1, 0, 0], {"value": "v / 4", "scale": 0.5}), shown([1, 0, 0], {"column": "v", "scale": 0.125}), "radii")
        self.assertNotEqual(shown({"value": "v"}), shown({"value": "w"}))
        # The range is that of the selected.
        for select, low, high in (("all", 1.25, 17), ("v < 3", 1.25, 5), ("v > 2", 10, 17)):
            self.document({"file": "a.csv", "color": {"value": "v * v + 1"}, "select": select})
            self.assertIn(f"coloured by v * v + 1 from {low} to {high} (viridis)", self.succeed("scene", "x.json").errors)
        self.document({"file": "a.csv", "color": {"value": "vv + 1"}})
        result = self.fail_at("scene", "x.json")
        self.assertIn('"color.value": at character 1: found no column "vv"', result.errors)
        self.assertIn("\n    vv + 1\n    ^^\n", result.errors)
        self.document({"file": "a.csv", "color": {"value": "v", "column": "w"}})
        self.assertIn('found beside "column", expected one of the two', self.fail_at("scene", "x.json").errors)
        self.document({"file": "a.csv", "color": {"map": "plasma"}})
        self.assertIn('found without "column" or "value"', self.fail_at("scene", "x.json").errors)

    def test_solvent_and_alternatives(self):
        """What is selected is shown, water too; of places of one atom, one is."""
        text = "".join([atom(0, " CA ", "ALA", (0, 0, 0), "C", letter="A"), atom(1, " CA ", "ALA", (0.4, 0, 0), "C", letter="B"),
                        atom(2, " O  ", "HOH", (5, 0, 0), "O", number=2, record="HETATM"), atom(3, "NA  ", " NA", (9, 0, 0), "NA", number=3, record="HETATM")])
        self.write("a.pdb", text)
        for select, said, spheres in (("chain == A", "selected 4 of 4 particles; hidden: 1 in alternative places", 3), ("water", "selected 1 of 4", 1),
                                      ("not water", "selected 3 of 4 particles; hidden: 1 in alternative places", 2),
                                      ("bfactor == 11", "selected 1 of 4 particles; van", 1), ("not solvent", "selected 2 of 4 particles; hidden: 1", 1)):
            self.document({"file": "a.pdb", "select": select})
            self.assertIn(said, self.succeed("scene", "x.json").errors, select)
            self.assertEqual(self.shapes("x.json")[0], spheres, select)
        self.document({"file": "a.pdb", "select": "all", "solvent": True})
        self.assertIn('x.json:1:', self.fail_at("scene", "x.json").errors)
        self.assertIn('solvent: found beside "select"', self.fail_at("scene", "x.json").errors)

    def test_guesses_hold_for_the_whole_file(self):
        """The radius of beads, colours of types and places of whole molecules do not depend on the selection."""
        dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n6\nITEM: BOX BOUNDS pp pp pp\n0 20\n0 20\n0 20\nITEM: ATOMS id type x y z\n"
        self.write("a.dump", dump + "".join(f"{i} {i % 3 + 1} {2 * i} {3 * (i % 2)} 1\n" for i in range(6)))
        self.assertIn("radius 1.8", self.succeed("scene", "a.dump").errors)
        self.assertIn("radius 1.8", self.succeed("scene", "a.dump", "--select", "type == 3").errors)
        self.document({"file": "a.dump"}, camera={"lookfrom": [5, 1, 30], "lookat": [5, 1, 0]}, background=[1, 1, 1])
        whole = self.picture("x.json")
        self.document(*[{"file": "a.dump", "select": f"type == {t}"} for t in (1, 2, 3)], camera={"lookfrom": [5, 1, 30], "lookat": [5, 1, 0]},
                      background=[1, 1, 1])
        parts = self.picture("x.json")
        self.assertEqual(self.shapes("x.json")[0], 6)
        self.assert_near(whole, parts)
        # Water, which is hidden unless it is selected, takes no colour from the chains.
        self.write("c.pdb", atom(0, " CA ", "ALA", (0, 0, 0), "C", "B") + atom(1, " CA ", "ALA", (4, 0, 0), "C", "C") + atom(2, " O  ", "HOH", (2, 3, 0), "O", "A"))
        camera = {"lookfrom": [2, 0, 20], "lookat": [2, 0, 0]}
        pictures = []
        for select in ({}, {"select": "protein"}):
            self.document(dict({"file": "c.pdb", "color": "chain"}, **select), camera=camera, background=[1, 1, 1])
            pictures.append(self.picture("x.json"))
        self.assert_same(*pictures)
        # A molecule across the cell, of which one end is selected: it lies where the whole one has it.
        cell = 'Lattice="10 0 0 0 10 0 0 0 10" Properties=species:S:1:pos:R:3'
        self.write("b.extxyz", f"3\n{cell}\nC 9.5 5 5\nC 0.9 5 5\nO 2.2 5 5\n")
        camera = {"lookfrom": [11, 5, 20], "lookat": [11, 5, 5], "vfov": 40}
        self.document({"file": "b.extxyz"}, camera=camera, background=[1, 1, 1])
        whole = self.picture("x.json")
        self.document({"file": "b.extxyz", "select": "element == O"}, {"file": "b.extxyz", "select": "not element == O"}, camera=camera, background=[1, 1, 1])
        self.assertIn("molecules made whole across the cell: 2 moved", self.succeed("scene", "x.json").errors)
        self.assert_near(whole, self.picture("x.json"))
        # It is selected by where the file has it.
        self.document({"file": "b.extxyz", "select": "x > 9"})
        self.assertIn("selected 1 of 3", self.succeed("scene", "x.json").errors)

    def assert_near(self, one, other):
        """Pictures of the same spheres in another order differ by ties only."""
        self.assertEqual(len(one), len(other))
        a, b = (struct.unpack(f"<{(len(data) - 16) // 4}f", data[-((len(data) - 16) // 4 * 4):]) for data in (one, other))
        off = sum(abs(p - q) > 1e-5 for p, q in zip(a, b))
        self.assertLess(off, 0.02 * len(a))
        self.assertGreater(len(set(a)), 20)

    def test_frames_are_selected_anew(self):
        rows = [[(x + k, 0, 0) for x in range(4)] for k in range(3)]
        self.write("a.xyz", "".join(xyz([("C", *place) for place in frame]) for frame in rows))
        self.succeed("render", "a.xyz", *SIZE, "--frames", "::", "--select", "x > 2", "-o", "f.pfm")
        pictures = [self.read(f"f-{k:04d}.pfm") for k in range(3)]
        self.assertEqual(len(set(pictures)), 3)
        for k, count in enumerate((1, 2, 3)):
            self.assertIn(f"selected {count} of 4", self.succeed("scene", "a.xyz", "--frame", k, "--select", "x > 2").errors)
        result = self.fail_at("render", "a.xyz", *SIZE, "--frames", "::", "--select", "x > 9", "-o", "g.pfm")
        self.assertIn("found no particle for which this holds: x > 9; x: from 0 to 3", result.errors)

    def test_frames_in_which_nothing_is_selected(self):
        """They show the rest, or nothing; but in some frame something must be selected by each entry."""
        self.write("a.xyz", "".join(xyz([("C", 0, 0, 0), ("O", x, 0, 0)]) for x in (9, 2, 9, 2.5)))
        for lookfrom in ({}, {"lookfrom": [1, 0, 12], "lookat": [1, 0, 0]}):
            entries = [{"file": "a.xyz", "select": "element == C"}, {"file": "a.xyz", "select": "element == O and within 3 of element == C"}]
            self.document(*entries, camera=lookfrom or {"fit": "particles"}, background=[1, 1, 1])
            self.succeed("render", "x.json", *SIZE, "--frames", "::", "-o", "f.pfm")
            pictures = [self.read(f"f-{k:04d}.pfm") for k in range(4)]
            self.assert_same(pictures[0], pictures[2])
            self.assertEqual(len(set(pictures)), 3)
            entries[1]["select"] = "element == N and x > 1"
            self.document(*entries, camera=lookfrom or {"fit": "particles"}, background=[1, 1, 1])
            result = self.fail_at("render", "x.json", *SIZE, "--frames", "::", "-o", "g.pfm")
            self.assertIn("for which this holds: element == N and x > 1; x: from 0 to 9; element: C, O", result.errors)
        self.succeed("render", "a.xyz", *SIZE, "--frames", "::", "-o", "h.pfm", "--select", "x == 2.5", "--lighting", "studio", "--set", "shadow_catcher=true")
        pictures = [self.read(f"h-{k:04d}.pfm") for k in range(4)]
        self.assertEqual([pictures[0] == pictures[k] for k in range(4)], [True, True, True, False])
        self.assertEqual([name for name in self.files() if name.startswith("g")], [])

    def test_errors(self):
        self.write("a.pdb", atom(0, " CA ", "ALA", (0, 0, 0), "C") + atom(1, " N  ", "ALA", (9, 0, 0), "N", "B"))
        result = self.fail_at("render", "a.pdb", *SIZE, "--select", 'chain = "A"')
        self.assertIn('--select: at character 7: found "=", expected "==", which compares\n\n    chain = "A"\n          ^\n', result.errors)
        result = self.fail_at("render", "a.pdb", *SIZE, "--select", "chain == C")
        self.assertIn('a.pdb: "select": found no particle for which this holds: chain == C; chain: A, B\n', result.errors)
        self.document({"file": "a.pdb", "select": "z > 3 or"})
        result = self.fail_at("scene", "x.json")
        self.assertRegex(result.errors, r"x\.json:1:\d+: particles\[0\]\.select: at character 9: found the end, expected")
        self.assertIn("\n    z > 3 or\n            ^\n", result.errors)
        self.write("s.json", scene(spheres=1))
        self.assertIn("--select: s.json has no particles to select from", self.fail_at("scene", "s.json", "--select", "all").errors)
        self.assertIn("--select", self.fail_at("scene", "a.pdb", "--select", "").errors)
        self.assertEqual([name for name in self.files() if name.endswith(".png")], [])

    def test_hash_and_statistics(self):
        self.write("a.xyz", xyz(ATOMS))
        def header(*arguments):
            self.succeed("render", "a.xyz", *SIZE, "-o", "a.bpa", "--stats", "s.json", *arguments)
            return json.loads(self.read("a.bpa").split(b"\n")[0])["scene_hash"], json.loads(self.read("s.json"))["spheres"]
        whole, part = header(), header("--select", "index < 4")
        self.assertEqual((whole[1], part[1]), (5, 4))
        self.assertNotEqual(whole[0], part[0])
        self.assertEqual(header("--select", "all")[0], whole[0])
        self.assertEqual(header("--select", "index <= 3")[0], part[0])

    def test_examples_of_the_document(self):
        """Every selection and value that docs/PARTICLES.md shows is one for a protein with a ligand, or for a trajectory."""
        with open(os.path.join(os.path.abspath(sys.argv[2]), "docs", "PARTICLES.md"), encoding="utf-8") as file:
            text = file.read()
        protein = "".join(atom(i, name, residue, (1.4 * i, 0, 11 + i), element, "A" if i < 6 else "B", 10 + i, record) for i, (name, residue, element, record) in enumerate([
            (" N  ", "ALA", "N", "ATOM"), (" CA ", "ALA", "C", "ATOM"), (" C  ", "ALA", "C", "ATOM"), (" O  ", "ALA", "O", "ATOM"), (" HA ", "ALA", "H", "ATOM"),
            (" C1 ", "LIG", "C", "HETATM"), ("FE  ", "HEM", "FE", "HETATM"), (" O  ", "HOH", "O", "HETATM")]))
        names = "id type x y z vx vy vz q"
        run = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp pp pp\n0 20\n0 20\n0 20\nITEM: ATOMS " + names + "\n"
               + "".join(f"{i} {i % 2 + 1} {i} {i} {5 * i} {i} 2 3 {0.5 * i - 1}\n" for i in range(4)))
        self.write("protein.pdb", protein)
        self.write("run.lammpstrj", run)
        commands = re.findall(r"^ +ballpark render (.*--select .*)$", text, re.M)
        self.assertGreaterEqual(len(commands), 4)
        for command in commands:
            self.succeed("render", *shlex.split(command, comments=True), *SIZE)
        used = [entry for entry in re.findall(r"^ +(?:\"particles\": \[ *)?(\{ \"file\": .*?\})(?: *\]|,)?$", text, re.M) if "select" in entry or "value" in entry]
        self.assertGreaterEqual(len(used), 3)
        for entry in used:
            self.document(json.loads(entry), materials={name: {"type": "metal", "albedo": [1, 1, 1]} for name in ("gold", "shiny", "matte")})
            self.picture("x.json")


main()
