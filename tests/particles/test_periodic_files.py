"""Cells that are periodic in part, and bonds across them: what files say, and what the program draws.

Run as: python3 test_periodic_files.py ballpark particle_summary
BALLPARK_READERS_PYTHON names a Python that has ASE, where it is not this one; the comparison with it is skipped without it.
"""
import itertools
import json
import os
import random
import re
import subprocess
import sys
import unittest

from in_folder import FolderTest

BALLPARK, SUMMARY = map(os.path.abspath, sys.argv[1:3])
HERE = os.path.dirname(os.path.abspath(__file__))
READERS_PYTHON = os.environ.get("BALLPARK_READERS_PYTHON", sys.executable)

DUMP = """\
ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS %s
%s
ITEM: ATOMS id element x y z
1 C %s
2 C %s
"""
# Beside each other across the side that one of the edges joins.
PAIRS = [("0.2 2 2", "3.4 2 2"), ("2 0.2 2", "2 3.4 2"), ("2 2 0.2", "2 2 3.4")]
ASE = """\
import json, sys
try:
    import ase, numpy
    from ase.neighborlist import neighbor_list
except ImportError:
    sys.exit(77)
found = []
for case in json.load(sys.stdin):
    atoms = ase.Atoms(case["symbols"], positions=case["positions"], cell=case["cell"], pbc=case["pbc"])
    reach = {tuple(pair[:2]): pair[2] for pair in case["reach"]}
    i, k, d, s = neighbor_list("ijdS", atoms, reach)
    keep = d >= 0.4
    inside = sum(1 for a, b, n, good in zip(i, k, s, keep) if good and a < b and not n.any())
    found.append([inside, int(keep.sum()) // 2 - inside])
print(json.dumps(found))
"""
COVALENT = {"C": 0.76, "O": 0.66, "Na": 1.66, "Cl": 1.02, "Si": 1.11, "Cs": 2.44}


def xyz(symbols, positions, cell, pbc=None):
    flags = "" if pbc is None else ' pbc="' + " ".join("FT"[bool(p)] for p in pbc) + '"'
    rows = "".join(f"{s} {' '.join(repr(x) for x in p)}\n" for s, p in zip(symbols, positions))
    edges = " ".join(repr(x) for edge in cell for x in edge)
    return f'{len(symbols)}\nLattice="{edges}"{flags} Properties=species:S:1:pos:R:3\n{rows}'


class Periodic(FolderTest):
    def summary(self, name, content):
        run = subprocess.run([SUMMARY, self.write(name, content)], stdout=subprocess.PIPE, text=True, check=True)
        return json.loads(run.stdout)

    def notes(self, name, content, *options):
        """What the program says of a file in the style of balls and sticks, on one line."""
        path = self.write(name, content)
        run = subprocess.run([BALLPARK, "scene", path, "--set", "particles[0].style=ball-and-stick", *options],
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=True, cwd=self.folder)
        self.write("scene.json", run.stdout)
        run = subprocess.run([BALLPARK, "explain", "scene.json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=True,
                             cwd=self.folder)
        return " ".join((run.stdout + run.stderr).split())

    def bonds(self, *arguments):
        """How many bonds are drawn, and how many cross the cell."""
        found = re.search(r"([\d,]+) bonds? by distance(?:, ([\d,]+) across the cell not drawn)?", self.notes(*arguments))
        return tuple(int((n or "0").replace(",", "")) for n in found.groups())

    def test_boundaries_of_dumps(self):
        plain, tilted = "\n".join(["0 4"] * 3), "\n".join(["0 4 0"] * 3)
        general = "\n".join("%d %d %d 0" % tuple(4 * (i == k) for k in range(3)) for i in range(3))
        for flags in itertools.product(("pp", "ff", "fs", "sm", "ps", "fp", "pf", "mm"), repeat=3):
            if flags.count("pp") == 0 and flags[0] != flags[1]:
                continue  # enough of those that repeat nowhere
            for head, bounds in [("%s", plain), ("xy xz yz %s", tilted), ("abc origin %s", general)]:
                content = DUMP % (head % " ".join(flags), bounds, *PAIRS[0])
                self.assertEqual(self.summary("a.dump", content)["periodic"], [f == "pp" for f in flags], (flags, head))
        self.assertEqual(self.summary("a.dump", DUMP % ("", plain, *PAIRS[0]))["periodic"], [False] * 3)  # old files
        for edge, pair in enumerate(PAIRS):
            for flags in itertools.product(("pp", "ff"), repeat=3):
                notes = self.notes("a.dump", DUMP % (" ".join(flags), plain, *pair))
                joined = flags[edge] == "pp"
                self.assertEqual(("made whole" in notes, "1 bond by" in notes), (joined, joined), (flags, pair))

    def test_pbc(self):
        head, end = '2\nLattice="4 0 0 0 4 0 0 0 4" %s Properties=species:S:1:pos:R:3\n', "C 0.2 2 2\nC 3.4 2 2\n"
        for text, expected in [("", "TTT"), ('pbc="F T T"', "FTT"), ('pbc="T F T"', "TFT"), ('pbc="T T F"', "TTF"), ('pbc="F F F"', "FFF"),
                               ('pbc="false True TRUE"', "FTT"), ('pbc="0 1 0"', "FTF"), ('pbc="t f t"', "TFT"), ("pbc=F", "FFF"),
                               ("pbc=T", "TTT"), ("pbc=[F,T,T]", "FTT"), ("pbc=[F, T, F]", "FTF"),
                               ("pbc={T F F}", "TFF"), ("pbc='F T F'", "FTF"), ('pbc="[T, F, F]"', "TFF"), ('pbc="F,F,T"', "FFT")]:
            s = self.summary("a.xyz", head % text + end)
            self.assertEqual("".join("FT"[p] for p in s["periodic"]), expected, text)
            self.assertEqual(s["notes"], "")
        for text in ('pbc="maybe"', 'pbc="T T"', 'pbc="T T T T"'):
            s = self.summary("a.xyz", head % text + end)
            self.assertEqual((s["periodic"], "pbc is not" in s["notes"]), ([True] * 3, True), text)

    def test_flat_cells(self):
        """A layer has no third edge; edges that lie in one plane repeat nowhere."""
        rows = [[1.42, 0.0, 0.0], [0.0, 0.0, 0.0]]
        layer = [[2.13, -1.2298, 0.0], [2.13, 1.2298, 0.0], [0.0, 0.0, 0.0]]
        self.assertEqual(self.bonds("a.xyz", xyz("CC", rows, layer, (1, 1, 0))), (1, 2))
        self.assertEqual(self.bonds("a.xyz", xyz("CC", rows, layer)), (1, 2))
        s = self.summary("a.xyz", xyz("CC", rows, [[2, 0, 0], [4, 0, 0], [0, 0, 9]]))
        self.assertEqual((s["periodic"], s["notes"]), ([False] * 3, "the cell is flat, so nothing repeats"))

    def test_crystals(self):
        """Bonds as they are counted by hand: four neighbours of silicon, three of graphene, six of salt, twelve and fourteen of metals."""
        a = 5.43
        primitive = [[0, a / 2, a / 2], [a / 2, 0, a / 2], [a / 2, a / 2, 0]]
        self.assertEqual(self.bonds("a.xyz", xyz(["Si", "Si"], [[0, 0, 0], [a / 4] * 3], primitive)), (1, 3))
        self.assertEqual(self.bonds("a.xyz", xyz("CC", [[0, 0, 0], [1.42, 0, 0]], [[2.13, -1.2298, 0], [2.13, 1.2298, 0], [0, 0, 15]])), (1, 2))
        self.assertEqual(self.bonds("a.xyz", xyz(["Cu"], [[1, 2, 3]], [[0, 1.805, 1.805], [1.805, 0, 1.805], [1.805, 1.805, 0]])), (0, 6))
        self.assertEqual(self.bonds("a.xyz", xyz(["Fe"], [[1, 2, 3]], [[2.866, 0, 0], [0, 2.866, 0], [1.433, 1.433, 1.433]])), (0, 7))
        for (x, y, z), shift in itertools.product([(2, 2, 1), (5, 1, 1), (1, 1, 1), (3, 2, 2)], (0, 0.3, -40)):
            d = 2.82
            sites = list(itertools.product(range(2 * x), range(2 * y), range(2 * z)))
            count = sum(all(p + (i == k) < 2 * n for k, (p, n) in enumerate(zip(site, (x, y, z)))) for site in sites for i in range(3))
            content = xyz([["Na", "Cl"][sum(s) % 2] for s in sites], [[d * p + shift for p in s] for s in sites],
                          [[2 * d * x, 0, 0], [0, 2 * d * y, 0], [0, 0, 2 * d * z]])
            self.assertEqual(self.bonds("a.xyz", content), (count, 3 * len(sites) - count), (x, y, z, shift))

    def test_wrong_unit(self):
        """Nanometres that are taken for angstroms: thousands lie within reach of each, and no bonds are drawn."""
        sites = [[0.45 * i, 0.45 * j, 0.45 * k] for i in range(12) for j in range(12) for k in range(12)]
        notes = self.notes("a.xyz", xyz(["C"] * len(sites), sites, [[5.4, 0, 0], [0, 5.4, 0], [0, 0, 5.4]]))
        self.assertIn("no bonds by distance, since atoms lie in each other", notes)
        notes = self.notes("a.xyz", xyz(["H", "H"], [[0, 0, 0], [0, 0, 1]], [[1e-3, 0, 0], [0, 1e-3, 0], [0, 0, 1e-3]]))
        self.assertIn("no bonds by distance", notes)

    def test_ase(self):
        """Random cells, as ASE finds their neighbours."""
        choose, cases = random.Random(5), []
        for number in range(40):
            while True:
                cell = [[choose.uniform(-7, 7) * (0.3 if number % 4 == 0 and e == 2 else 1) for _ in range(3)] for e in range(3)]
                volume = sum(cell[0][i] * (cell[1][(i + 1) % 3] * cell[2][(i + 2) % 3] - cell[1][(i + 2) % 3] * cell[2][(i + 1) % 3]) for i in range(3))
                if abs(volume) > 30:
                    break
            if number % 3 == 0:
                cell[1] = [b + 6 * a for a, b in zip(cell[0], cell[1])]
            symbols = [choose.choice(sorted(COVALENT)) for _ in range(choose.randint(1, 8))]
            cases.append({"symbols": symbols, "positions": [[choose.uniform(-9, 9) for _ in range(3)] for _ in symbols], "cell": cell,
                          "pbc": [choose.random() < 0.7 for _ in range(3)],
                          "reach": [[a, b, COVALENT[a] + COVALENT[b] + 0.4] for a in COVALENT for b in COVALENT]})
        run = subprocess.run([READERS_PYTHON, "-c", ASE], input=json.dumps(cases), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if run.returncode == 77:
            self.skipTest(f"ASE is not installed for {READERS_PYTHON}")
        self.assertEqual(run.returncode, 0, run.stderr)
        for case, wanted in zip(cases, json.loads(run.stdout)):
            content = xyz(case["symbols"], case["positions"], case["cell"], case["pbc"])
            self.assertEqual(list(self.bonds("a.xyz", content, "--set", "particles[0].whole=false")), wanted, content)


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0]] + sys.argv[3:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
