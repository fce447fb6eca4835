"""Files of particles: what each reader finds in them, beside independent readers, and that hostile files are refused.

Run as: python3 test_particle_files.py particle_summary
BALLPARK_READERS_PYTHON names the Python that has ASE, MDAnalysis and gsd, where it is not this one; tests that compare
with them are skipped where they are missing.
"""
import gzip
import json
import math
import os
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

SUMMARY = os.path.abspath(sys.argv[1])
HERE = os.path.dirname(os.path.abspath(__file__))
READERS_PYTHON = os.environ.get("BALLPARK_READERS_PYTHON", sys.executable)
MEMORY = 1 << 29  # bytes that a hostile file may make the program ask for, which sanitizers cannot be held to
SANITIZED = "asan" in SUMMARY

XYZ = "3\nwater\nO 0 0 0.5\nH 0.75 0 -1e-1\nH -0.75 0.0 -0.1 extra\n"
EXTENDED = ('2\nLattice="10 0 0 2 9 0 1 1 8" Origin="-1 -2 -3" Properties=id:I:1:species:S:1:pos:R:3:radius:R:1:color:R:3:'
            'force:R:3 pbc="T T F"\n1 Fe 1 2 3 0.5 1 0.5 0 7 8 9\n2 C1 4 5 6 0.25 0 0 1 1 1 1\n')
PDB = """\
CRYST1   40.000   50.000   60.000  90.00  90.00 120.00 P 1           1
MODEL        1
ATOM      1  N   ALA A   1      11.104   6.134  -6.504  1.00 10.50           N
ATOM      2  CA AALA A   1      11.639   6.071  -5.147  0.60 11.00
ATOM      3  CA BALA A   1      11.700   6.100  -5.100  0.40 11.00
HETATM    4 CA    CA A   2       1.000   2.000   3.000  1.00 20.00
HETATM    5  O   HOH B   3      -1.000  -2.000  -3.000  1.00 30.00
HETATM    6  MW  SOL B   4      -1.500  -2.000  -3.000
ENDMDL
MODEL        2
ATOM      1  N   ALA A   1      12.104   6.134  -6.504  1.00 10.50           N
ENDMDL
END
"""
CIF = """\
data_TEST
# a remark
_cell.length_a 40.0
_cell.length_b 50.0
_cell.length_c 60.0
_cell.angle_alpha 90
_cell.angle_beta 90
_cell.angle_gamma 120
_struct.title
;A text with loop_ and
_atom_site.Cartn_x in it
;
loop_
_other.a
_other.b
1 'two words'
2 "it's"
loop_
_atom_site.group_PDB
_atom_site.type_symbol
_atom_site.label_atom_id
_atom_site.label_alt_id
_atom_site.label_comp_id
_atom_site.auth_asym_id
_atom_site.Cartn_x
_atom_site.Cartn_y
_atom_site.Cartn_z
_atom_site.B_iso_or_equiv
_atom_site.pdbx_PDB_model_num
ATOM N N . ALA A 11.104 6.134 -6.504 10.5 1
ATOM C CA A ALA A 11.639 6.071 -5.147 11 1
ATOM C CA B ALA A 11.700 6.100 -5.100 11 1
HETATM CA CA . CA A 1.0 2.0 3.0 20 1
HETATM O "O" . HOH B -1.0 -2.0 -3.0 30 1
ATOM N N . ALA A 12.104 6.134
-6.504 10.5 2
#
"""
GRO = """\
Water, t= 0.0
    3
    1SOL     OW    1   0.126   1.624   1.679  0.1227 -0.0580  0.0434
    1SOL    HW1    2   0.190   1.661   1.747  0.8085  0.3191 -0.7791
    1SOL     MW    3   0.177   1.568   1.613 -0.9045 -2.6469  1.3180
   1.82060   1.82060   1.82060
"""
DUMP = """\
ITEM: TIMESTEP
0
ITEM: NUMBER OF ATOMS
2
ITEM: BOX BOUNDS xy xz yz pp pp pp
-1.0 13.0 2.0
-2.0 12.0 1.0
0.0 10.0 -3.0
ITEM: ATOMS id type xs ys zs q
2 1 0.5 0.5 0.5 -1.5
1 2 0 0 0 1
ITEM: TIMESTEP
100
ITEM: NUMBER OF ATOMS
1
ITEM: BOX BOUNDS pp pp ff
0 1
0 1
0 1
ITEM: ATOMS id x y z radius
1 5 6 7 0.25
"""
DATA = """\
A title with 100 atoms in it

3 atoms
2 bonds
2 atom types
-1 9 xlo xhi
0 10 ylo yhi
0 10 zlo zhi
1 2 3 xy xz yz

Masses

1 15.9994 # oxygen
2 1.008

Atoms # full

7 1 1 -0.8 1 2 3
5 1 2 0.4 4 5 6 0 0 1
9 1 2 0.4 7 8 9

Bonds

 # number type atoms
1 1 7 5
2 1 7 9
"""
CSV = "x, y, z, radius, charge, species\n1,2,3,0.5,-1,\"a\"\n4, 5 ,6e0,0.25,2,b\n"
PLY = """\
ply
format ascii 1.0
element other 1
property list uchar int numbers
element vertex 2
property float x
property float y
property double z
property float radius
property uchar red
property uchar green
property uchar blue
property float heat
end_header
2 8 9
1 2 3 0.5 255 0 0 10
4 5 6 0.25 0 255 0 20
"""


def binary_ply(order):
    """PLY as binary numbers: "<" has the lowest byte first, ">" the highest."""
    head = PLY.split("end_header\n", 1)[0].replace("ascii", f"binary_{'little' if order == '<' else 'big'}_endian") + "end_header\n"
    return head.encode() + struct.pack(order + "Bii", 2, 8, 9) + struct.pack(order + "2fdf3Bf", 1, 2, 3, 0.5, 255, 0, 0, 10) + \
        struct.pack(order + "2fdf3Bf", 4, 5, 6, 0.25, 0, 255, 0, 20)


def gsd_file(frames, version=2, schema=b"hoomd"):
    """A GSD file: each frame is a dict from a chunk's name to (type, columns, rows, bytes)."""
    names, body, index = [], b"", []
    for number, frame in enumerate(frames):
        for name, (kind, columns, rows, data) in frame.items():
            if name not in names:
                names.append(name)
            index.append((number, rows, 256 + len(body), columns, names.index(name), kind))
            body += data
    entries = b"".join(struct.pack("<QQqIHBB", f, n, at, m, i, t, 0) for f, n, at, m, i, t in index) + bytes(32)
    if version == 1:
        listed = b"".join(name.encode().ljust(64, b"\0") for name in names)
    else:
        listed = b"\0".join(name.encode() for name in names) + b"\0"
        listed = listed.ljust((len(listed) // 64 + 1) * 64, b"\0")
    at = 256 + len(body)
    header = struct.pack("<QQQQQII", 0x65DF65DF65DF65DF, at, len(entries) // 32, at + len(entries), len(listed) // 64,
                         0x10004, version << 16) + b"test".ljust(64, b"\0") + schema.ljust(64, b"\0") + bytes(80)
    return header + body + entries + listed


def floats(columns, *values):
    return 9, columns, len(values) // columns, struct.pack(f"<{len(values)}f", *values)


def whole(columns, *values):
    return 3, columns, len(values) // columns, struct.pack(f"<{len(values)}I", *values)


GSD_FRAMES = [{"configuration/box": floats(1, 10, 8, 6, 0.5, 0, 0), "particles/N": whole(1, 2),
               "particles/types": (5, 4, 2, b"A\0\0\0Bee\0"), "particles/typeid": whole(1, 1, 0),
               "particles/diameter": floats(1, 0.5, 2), "bonds/N": whole(1, 1), "bonds/group": whole(2, 0, 1),
               "particles/position": floats(3, 1, 2, 3, -4, -3, -2)},
              {"particles/position": floats(3, 0, 0, 0, 1, 1, 1)},
              {"particles/N": whole(1, 1), "particles/position": floats(3, 4, 4, 4)}]
GSD = gsd_file(GSD_FRAMES)


class FileTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="ballpark-particles-")
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, content):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return path

    def run_summary(self, path, *arguments):
        def limit():
            if not SANITIZED:
                resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        return subprocess.run([SUMMARY, path, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              preexec_fn=limit, timeout=120, text=True, check=False)

    def summary(self, path, *arguments):
        result = self.run_summary(path, *arguments)
        self.assertEqual(result.returncode, 0, f"{path}: {result.stderr}")
        return json.loads(result.stdout)

    def of(self, name, content, *arguments):
        return self.summary(self.write(name, content), *arguments)

    def near(self, one, other, tolerance=1e-6):
        self.assertEqual(len(one), len(other))
        for a, b in zip(one, other):
            self.assertLessEqual(abs(a - b), tolerance, (one, other))

    def refuse(self, name, content, *says, arguments=()):
        result = self.run_summary(self.write(name, content), *arguments)
        self.assertEqual(result.returncode, 1, result.stderr[-2000:] + result.stdout[:200])
        for text in (name,) + says:
            self.assertIn(text, result.stderr)


class Formats(FileTest):
    def test_xyz(self):
        s = self.of("a.xyz", XYZ)
        self.assertEqual((s["format"], s["frames"], s["count"], s["elements"]), ("XYZ", 1, 3, {"H": 2, "O": 1}))
        self.near(s["low"] + s["high"], [-0.75, 0, -0.1, 0.75, 0, 0.5])
        self.assertNotIn("cell", s)

    def test_species_of_xyz(self):
        for species, element in [("Fe", "Fe"), ("C12", "C"), ("6", ""), ("Xx", ""), ("Q1", ""), ("h", "H")]:
            s = self.of("a.xyz", f"1\n\n{species} 0 0 0\n")
            self.assertEqual((list(s["elements"]), s["first"]["type"]), ([element], species))
        s = self.of("a.xyz", "1\nProperties=Z:I:1:pos:R:3\n6 0 0 0\n")
        self.assertEqual((list(s["elements"]), s["first"]["type"]), (["C"], "C"))

    def test_extended_xyz(self):
        s = self.of("a.xyz", EXTENDED, 0, "force_y")
        self.assertEqual((s["count"], s["elements"], s["periodic"]), (2, {"C": 1, "Fe": 1}, [True, True, False]))
        self.assertEqual((s["cell"], s["origin"]), ([[10, 0, 0], [2, 9, 0], [1, 1, 8]], [-1, -2, -3]))
        self.assertEqual((s["radius"], s["color"], s["column_sum"]), (0.5, [1, 0.5, 0], 9))

    def test_frames(self):
        text = "".join(f"{i + 1}\n\n" + "".join(f"He {k} {i} 0\n" for k in range(i + 1)) for i in range(4))
        path = self.write("a.xyz", text)
        for frame, count in [(0, 1), (2, 3), (-1, 4), (-4, 1)]:
            s = self.summary(path, frame)
            self.assertEqual((s["frames"], s["count"], s["high"][0]), (4, count, count - 1))
        for frame in (4, -5):
            self.refuse("a.xyz", text, "found 4 frames", f"no frame {frame}", arguments=[frame])

    def test_pdb(self):
        s = self.of("a.pdb", PDB, 0, "bfactor")
        self.assertEqual((s["format"], s["frames"], s["count"]), ("PDB", 2, 6))
        self.assertEqual(s["elements"], {"": 1, "C": 2, "N": 1, "O": 1, "Ca": 1})
        self.assertEqual((s["alternatives"], s["dummies"], s["notes"]), (1, 1, "elements from atom names"))
        self.near(s["low"] + s["high"], [-1.5, -2, -6.504, 11.7, 6.134, 3])
        self.near(s["cell"][1], [-25, 50 * 0.75 ** 0.5, 0])
        second = self.of("a.pdb", PDB, 1)
        self.assertEqual((second["count"], second["cell"]), (1, s["cell"]))

    def test_connections_of_pdb(self):
        """CONECT: as given, by the serial numbers of the frame; what cannot be a bond is counted and is no error."""
        def atoms(*serials):
            return "".join(f"HETATM{serial:>5s}  C   LIG A   1    {2.0 * i:8.3f}   0.000   0.000\n"
                           for i, serial in enumerate(serials))

        def found(text, frame=0):
            s = self.of("a.pdb", text, frame)
            return s["bonds"], s["left_out"]
        four = atoms("11", "12", "13", "00014")
        for lines, expected in [
                ("", (0, 0)),
                ("CONECT   11   12\n", (1, 0)),
                ("CONECT   11   12   13   14   12\n", (4, 0)),  # a double bond
                ("CONECT   11   12" + 15 * " " + "   13   14\n", (1, 0)),  # a hydrogen bond, in older files
                ("CONECT   1100012   14\r\n", (2, 0)),  # fields that touch
                ("CONECT   11   12   99\nCONECT   98   11\n", (1, 2)),  # atoms that are missing
                ("CONECT   11   11\n", (0, 1)),
                ("CONECT\nCONECT    \nCONECT   11\n", (0, 2)),
                ("CONECT 11 12 13\nCONECT   11  1.5   12\n", (1, 2)),  # not in columns; no whole number
                ("CONECT\x80\xff\x01    11\n", (0, 1)),
                ("CONECT   11" + 5000 * " 9999" + "\n", (0, 4))]:
            self.assertEqual(found(four + lines + "END\n"), expected, lines[:60])
        # Numbers above 99,999 are letters; of those that begin again nobody knows who is meant.
        self.assertEqual(found(atoms("A0000", "A0001", "186a0", "*****") + "CONECTA0000A0001186a0*****\n"), (2, 1))
        self.assertEqual(found(atoms("1", "2", "1", "") + "CONECT    1    2\nCONECT    2\n"), (0, 1))
        # Each frame has its own ...
        own = four + "CONECT   11   12\nEND\n" + atoms("12", "11", "7") + "CONECT    7   11   12\nEND\n" + four + "END\n"
        self.assertEqual([found(own, frame) for frame in range(3)], [(1, 0), (2, 0), (0, 0)])
        # ... or they stand once, after all models; also where frames are passed over.
        models = "".join(f"MODEL {i}\n{four}" + ("CONECT   12   13\n" if i == 1 else "") + "ENDMDL\n" for i in range(3))
        models += "CONECT   11   12   99\nCONECT   13   14\nMASTER\nEND\n"
        self.assertEqual([found(models, frame) for frame in (0, 1, 2, -1, -3)], [(2, 1), (3, 1), (2, 1), (2, 1), (2, 1)])
        path = self.write("a.pdb.gz", gzip.compress(models.encode()))
        self.assertEqual((self.summary(path, 1)["bonds"], self.summary(path)["frames"]), (3, 3))

    def test_cif(self):
        s, pdb = self.of("a.cif", CIF, 0, "bfactor"), self.of("a.pdb", PDB)
        self.assertEqual((s["format"], s["frames"], s["count"], s["column_sum"]), ("mmCIF", 2, 5, 82.5))
        self.assertEqual(s["elements"], {"C": 2, "N": 1, "O": 1, "Ca": 1})
        self.assertEqual((s["alternatives"], s["cell"], s["first"]), (1, pdb["cell"], pdb["first"]))
        self.assertEqual(self.of("a.cif", CIF, 1)["low"], [12.104, 6.134, -6.504])

    def test_gro(self):
        s = self.of("a.gro", GRO + GRO.replace("0.126", "0.226"), 0, "vx")
        self.assertEqual((s["format"], s["frames"], s["count"], s["angstrom"]), ("GRO", 2, 3, 0.1))
        self.assertEqual((s["elements"], s["dummies"]), ({"": 1, "H": 1, "O": 1}, 1))
        self.near(s["low"] + s["high"], [0.126, 1.568, 1.613, 0.19, 1.661, 1.747])
        self.near([s["column_sum"]], [0.1227 + 0.8085 - 0.9045])
        self.near(s["cell"][0] + s["cell"][1], [1.8206, 0, 0, 0, 1.8206, 0])
        touching = GRO.replace("   1.82060   1.82060   1.82060", "40000.0000040000.0000040000.00000")
        self.assertEqual(self.of("a.gro", touching)["cell"][2], [0, 0, 40000])

    def test_dump(self):
        s = self.of("a.lammpstrj", DUMP, 0, "q")
        self.assertEqual((s["format"], s["frames"], s["count"], s["column_sum"]), ("LAMMPS dump", 2, 2, -0.5))
        # x from -1 - min(0, 2, 1, 3) = -1 to 13 - 3 = 10; y from -2 + 3 to 12
        self.assertEqual((s["origin"], s["cell"]), ([-1, 1, 0], [[11, 0, 0], [2, 11, 0], [1, -3, 10]]))
        self.near(s["low"] + s["high"], [-1, 1, 0, -1 + 7, 1 + 4, 5])
        second = self.of("any.name", DUMP, 1)  # by its first line
        self.assertEqual((second["low"], second["radius"]), ([5, 6, 7], 0.25))

    def test_data(self):
        s = self.of("a.data", DATA, 0, "q")
        self.assertEqual((s["format"], s["count"], s["bonds"], s["elements"]), ("LAMMPS data", 3, 2, {"H": 2, "O": 1}))
        self.assertEqual((s["low"], s["high"], s["notes"]), ([1, 2, 3], [7, 8, 9], "elements from masses"))
        self.assertEqual((s["origin"], s["cell"]), ([-1, 0, 0], [[10, 0, 0], [1, 10, 0], [2, 3, 10]]))
        self.near([s["column_sum"]], [0])
        guessed = self.of("a.data", DATA.replace("# full", "# my own words"))
        self.assertIn("atom style full from the number of words", guessed["notes"])
        other = self.of("a.data", DATA.replace("Bonds", "Bnods"))
        self.assertEqual((other["bonds"], "section Bnods passed over" in other["notes"]), (0, True))
        hybrid = "t\n\n1 atoms\n\nAtoms # hybrid\n\n1 3 0.5 1.5 2.5 1 2 3 4 5 6\n"
        self.assertEqual(self.of("a.data", hybrid)["low"], [0.5, 1.5, 2.5])

    def test_gsd(self):
        for version in (1, 2):
            s = self.of("a.gsd", gsd_file(GSD_FRAMES, version), 0, "diameter")
            self.assertEqual((s["format"], s["frames"], s["count"], s["bonds"]), ("GSD", 3, 2, 1))
            self.assertEqual((s["low"], s["high"]), ([-4, -3, -2], [1, 2, 3]))
            self.assertEqual((s["radius"], s["first"]["type"], s["column_sum"]), (0.25, "Bee", 2.5))
            self.assertEqual((s["cell"], s["origin"]), ([[10, 0, 0], [4, 8, 0], [0, 0, 6]], [-7, -4, -3]))
        s = self.of("a.gsd", GSD, 1)  # what it lacks is frame 0's
        self.assertEqual((s["count"], s["high"], s["radius"], s["first"]["type"]), (2, [1, 1, 1], 0.25, "Bee"))
        s = self.of("a.gsd", GSD, -1)  # and where that has another number of particles, the default
        self.assertEqual((s["count"], s["radius"], s["first"]["type"]), (1, 0.5, "A"))

    def test_csv(self):
        s = self.of("a.csv", CSV, 0, "charge")
        self.assertEqual((s["format"], s["count"], s["radius"], s["column_sum"]), ("CSV", 2, 0.5, 1))
        self.assertEqual((s["low"], s["high"], s["first"]["type"]), ([1, 2, 3], [4, 5, 6], "a"))
        for text in ("1 2 3\n4 5 6\n", "# x y z\n1 2 3\n4 5 6\n", "x\ty\tz\n1\t2\t3\n4\t5\t6\n", "X;Y;Z\n1;2;3\n4;5;6"):
            s = self.of("a.csv", text)
            self.assertEqual((s["count"], s["low"], s["high"], s["flat"]), (2, [1, 2, 3], [4, 5, 6], False), text)
        self.assertIn("without names", self.of("a.csv", "1 2 3\n4 5 6\n")["notes"])
        self.assertTrue(self.of("a.csv", "x,y\n1,2\n")["flat"])

    def test_ply(self):
        s = self.of("a.ply", PLY, 0, "heat")
        self.assertEqual((s["format"], s["count"], s["radius"], s["color"]), ("PLY", 2, 0.5, [1, 0, 0]))
        self.assertEqual((s["low"], s["high"], s["column_sum"]), ([1, 2, 3], [4, 5, 6], 30))
        for order in "<>":
            self.assertEqual(self.of("b.ply", binary_ply(order), 0, "heat"), s, order)

    def test_packed_and_line_ends(self):
        """gzip, CR LF, and no line end at the last line change nothing."""
        for name, content, column in [("a.xyz", XYZ, None), ("b.xyz", EXTENDED, "id"), ("a.pdb", PDB, "bfactor"),
                                      ("a.cif", CIF, None), ("a.gro", GRO, "vx"), ("a.dump", DUMP, "q"),
                                      ("a.data", DATA, "q"), ("a.csv", CSV, "charge"), ("a.ply", PLY, "heat"),
                                      ("a.gsd", GSD, "mass")]:
            column = [0, column] if column else []
            plain = self.of(name, content, *column)
            data = content if isinstance(content, bytes) else content.encode()
            self.assertEqual(self.of(name + ".gz", gzip.compress(data), *column), plain, name)
            if name != "a.gsd":
                self.assertEqual(self.of(name, data.replace(b"\n", b"\r\n"), *column), plain, name)
                self.assertEqual(self.of(name, data.rstrip(b"\n"), *column), plain, name)

    def test_elements_from_names(self):
        def element(name, residue):
            # Four letters begin in column 13; names of two letters that are symbols do too.
            line = f"HETATM    1 {name:4s} {residue:>3s} A   1       0.000   0.000   0.000\n"
            return next(iter(self.of("a.pdb", line)["elements"]))
        for name, residue, expected in [(" CA ", "ALA", "C"), ("CA  ", "CA", "Ca"), ("HG21", "VAL", "H"), ("HG  ", "HG", "Hg"),
                                        ("1HB ", "ALA", "H"), (" OXT", "ALA", "O"), ("ZN  ", "ZN", "Zn"), (" SD ", "MET", "S"),
                                        ("FE  ", "HEM", "Fe"), (" NA ", "HEM", "N"), ("NA  ", "NA", "Na"), ("CL  ", "CL", "Cl"),
                                        ("SE  ", "MSE", "Se"), (" P  ", "DA", "P"), (" C1'", "DA", "C"), (" OW ", "SOL", "O"),
                                        ("HW1 ", "SOL", "H"), ("MW  ", "SOL", ""), (" BR ", "LIG", "B"), ("BR  ", "LIG", "Br")]:
            self.assertEqual(element(name, residue), expected, (name, residue))

    def test_columns_have_names(self):
        self.refuse("a.csv", CSV, 'found no column "charg"', "x, y, z, radius, charge", arguments=[0, "charg"])


class Hostile(FileTest):
    def test_counts_that_lie(self):
        self.refuse("a.xyz", "1000000000\n\nO 0 0 0\n", ":1:", "1000000000", "at most 134217728")
        self.refuse("a.xyz", "100000000\n\nO 0 0 0\n", ":4:", "atom 1 (from 0) of 100000000")
        self.refuse("a.xyz", "-3\n\nO 0 0 0\n", ":1:", "-3")
        self.refuse("a.xyz", "1\n\nO 0 0 0\nO 1 1 1\n", ":4:", "number of atoms", arguments=[1])
        self.refuse("a.gro", GRO.replace("    3\n", "134217728\n"), ":6:", "expected a coordinate")
        self.refuse("a.gro", GRO.replace("    3\n", "1000000000\n"), ":2:")
        self.refuse("a.dump", DUMP.replace("ATOMS\n2\n", "ATOMS\n100000000\n"), ":12:", "expected 6")
        self.refuse("a.dump", DUMP.replace("ATOMS\n2\n", "ATOMS\n1000000000\n"), ":4:", "at most 134217728")
        self.refuse("a.data", DATA.replace("3 atoms", "1000000000 atoms"), ":3:", "at most 134217728")
        self.refuse("a.data", DATA.replace("3 atoms", "100000000 atoms"), "found 3 lines", "expected 100000000")
        self.refuse("a.data", DATA.replace("2 bonds", "100000000 bonds"), "bond 3 of 100000000")
        self.refuse("a.ply", PLY.replace("vertex 2", "vertex 100000000"), ":18:", "row 2 of 100000000")
        self.refuse("a.ply", PLY.replace("vertex 2", "vertex 1000000000"), ":18:", "row 2 of 1000000000")
        binary = PLY.split("end_header\n", 1)[0].replace("ascii", "binary_little_endian") + "end_header\n"
        self.refuse("a.ply", binary.replace("vertex 2", "vertex 100000000").encode() + bytes(40), "row 1 of 100000000")
        self.refuse("a.ply", binary.encode() + b"\xff\x00", "end of the file in a list")

    def test_counts_of_gsd(self):
        def changed(at, value, size="<Q"):
            return GSD[:at] + struct.pack(size, value) + GSD[at + struct.calcsize(size):]
        self.refuse("a.gsd", changed(16, 1 << 60), "room for")
        self.refuse("a.gsd", changed(8, 1 << 60), "beyond the end")
        self.refuse("a.gsd", changed(32, 1 << 60), "room for")
        self.refuse("a.gsd", GSD[:300], "room for")
        self.refuse("a.gsd", GSD[:-40], "beyond the end")
        self.refuse("a.gsd", GSD[:100], "beyond the end")
        many = dict(GSD_FRAMES[0], **{"particles/N": whole(1, 1 << 31)})
        self.refuse("a.gsd", gsd_file([many]), "2147483648 particles")
        for kind, data, found in [(8, struct.pack("<q", -510), "-510"), (9, struct.pack("<f", 1.5), "1.5"),
                                  (10, struct.pack("<d", math.nan), "nan"), (10, struct.pack("<d", -math.inf), "-inf")]:
            wrong = dict(GSD_FRAMES[0], **{"particles/N": (kind, 1, 1, data)})
            self.refuse("a.gsd", gsd_file([wrong]), f"found {found} particles", "whole number")
        many = dict(GSD_FRAMES[0], **{"particles/N": whole(1, 100000000)})
        self.refuse("a.gsd", gsd_file([many]), "particles/position", "expected 100000000 rows of 3")
        wide = dict(GSD_FRAMES[0], **{"particles/position": (9, 3, 1 << 40, b"")})
        self.refuse("a.gsd", gsd_file([wide]), "particles/position")
        wrong = dict(GSD_FRAMES[0], **{"particles/typeid": whole(1, 7, 0)})
        self.refuse("a.gsd", gsd_file([wrong]), "type 7")
        wrong = dict(GSD_FRAMES[0], **{"bonds/group": whole(2, 0, 9)})
        self.refuse("a.gsd", gsd_file([wrong]), "bond 0")
        self.refuse("a.gsd", gsd_file(GSD_FRAMES, schema=b"other"), "schema")

    def test_numbers(self):
        for bad in ("inf", "1e999", "x", "0x10", "1,5,5", "1e13"):
            self.refuse("a.xyz", f"1\n\nO 0 {bad} 0\n", ":3:")
            self.refuse("a.csv", f"x;y;z\n0;{bad};0\n", ":2:")
            self.refuse("a.dump", DUMP.replace("0.5 0.5 0.5", f"0.5 {bad} 0.5"), ":10:")
            self.refuse("a.data", DATA.replace("1 2 3\n5", f"1 {bad} 3\n5"), ":18:")
            self.refuse("a.cif", CIF.replace("6.071", bad), ":31:")
            self.refuse("a.ply", PLY.replace("1 2 3 0.5", f"1 {bad} 3 0.5"), ":16: ")
        self.refuse("a.pdb", PDB.replace("   6.071", "     six"), ":4:")
        for order in "<>":
            place = struct.pack(order + "2fd", 1, 2, 3)
            self.refuse("a.ply", binary_ply(order).replace(place, struct.pack(order + "2fd", 1, 2, float("inf"))), "inf")
        self.refuse("a.gro", GRO.replace("1.624", "  inf"), ":3:")
        bad = dict(GSD_FRAMES[0], **{"particles/position": floats(3, 1, float("inf"), 3, 4, 5, 6)})
        self.refuse("a.gsd", gsd_file([bad]), "particle 0")

    def test_missing_parts(self):
        self.refuse("a.xyz", "1\n\nO 0 0\n", ":3:", "found 3 words, expected 4")
        self.refuse("a.xyz", EXTENDED.replace(" 7 8 9", " 7 8"), ":3:", "found 11 words, expected 12")
        self.refuse("a.xyz", EXTENDED.replace("pos:R:3", "pos:R:2"), ":2:")
        self.refuse("a.xyz", EXTENDED.replace("pos:R:3", "pos:R:99999999999"), ":2:")
        self.refuse("a.xyz", "", "empty")
        self.refuse("a.pdb", "REMARK nothing\n", "ATOM or HETATM")
        self.refuse("a.pdb", PDB.replace("   6.071  -5.147  0.60 11.00", "   6.071"), ":4:")
        self.refuse("a.gro", GRO.replace("1.661   1.747  0.8085  0.3191 -0.7791", "1.661"), ":4:")
        self.refuse("a.cif", CIF.replace("_atom_site.Cartn_y\n", ""), "Cartn_y")
        self.refuse("a.cif", CIF.replace(" 20 1", " 20"), "a value is missing")
        self.refuse("a.cif", CIF[:CIF.index(";A") + 20], "end of the file")
        self.refuse("a.cif", "data_x\nloop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.5\n", "fractions")
        self.refuse("a.cif", "data_x\n", "_atom_site")
        self.refuse("a.gro", GRO.rsplit("\n", 2)[0] + "\n", "box")
        self.refuse("a.dump", DUMP.replace("xs ys zs", "fx fy fz"), ":9:", "coordinates")
        self.refuse("a.dump", "ITEM: NUMBER OF ATOMS\n1\n", "ITEM: TIMESTEP")
        self.refuse("a.data", "title\n\n1 atoms\n", "Atoms")
        self.refuse("a.data", "t\n\n1 atoms\n\nAtoms\n\n1 3 0.5 1.5 2.5 1 2 3 4 5 6\n", ":7:", "name the style")
        self.refuse("a.data", DATA.replace("1 1 7 5", "1 1 7 6"), "6", "number of an atom")
        self.refuse("a.csv", "a,b\n1,2\n", "columns x and y")
        self.refuse("a.csv", "x,y,z\n1,2\n", ":2:", "found 2 fields, expected 3")
        self.refuse("a.csv", "x,y,z\n", "rows")
        self.refuse("a.csv", "x,y,x\n1,2,3\n", "two columns")
        self.refuse("a.ply", PLY.replace("property float y\n", ""), "x, y and z")
        self.refuse("a.ply", PLY.replace("element vertex 2", "element points 2"), "element vertex")

    def test_long_lines(self):
        """Lines longer than what is read at first, and the longest allowed one."""
        for length in (1023, 1024, 1025, 5000, (1 << 20) - 1):
            for name, pack in (("a.xyz", bytes), ("a.xyz.gz", gzip.compress)):
                text = b"2\n" + b"x" * length + b"\nO 1 2 3\nH 4 5 6\n"
                found = self.summary(self.write(name, pack(text)))
                self.assertEqual((found["count"], found["low"], found["high"]), (2, [1, 2, 3], [4, 5, 6]), (name, length))
        self.refuse("a.xyz", b"1\n" + b"x" * (1 << 20) + b"\nO 1 2 3\n", ":2:", "line of over")

    def test_wide_rows(self):
        """Rows of numbers that lie across blocks, the widest as large as what is read at first."""
        for more in (50, 100, 125):
            head = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + "".join(
                f"property double {name}\n" for name in ["x", "y", "z", *(f"p{i}" for i in range(more))]) + "end_header\n"
            rows = b"".join(struct.pack(f"<{3 + more}d", k, k + 1, k + 2, *[9.0] * more) for k in (1, 2, 3))
            found = self.summary(self.write("a.ply", head.encode() + rows))
            self.assertEqual((found["count"], found["low"], found["high"]), (3, [1, 2, 3], [3, 4, 5]), more)

    def test_damage(self):
        self.refuse("a.xyz", b"1\n\nO 0 \0 0\n", ":3:", "value 0")
        self.refuse("a.xyz", b"1\n" + b"x" * 3000000, ":2:", "line of over")
        packed = gzip.compress(XYZ.encode() * 1000)
        self.refuse("a.xyz.gz", packed[:-20], "damage", arguments=[-1])
        self.refuse("a.xyz.gz", packed[:30] + b"\xff\xff\xff" + packed[33:], "damage", arguments=[-1])
        self.refuse("a.gsd.gz", gzip.compress(GSD)[:-9], "damage")

    def test_gzip_bombs(self):
        """A kilobyte of packed blanks, digits or zeros for each megabyte: refused at once or read in bounded memory."""
        for name, start, block in [("a.xyz.gz", b"1\n", b" " * (1 << 20)), ("a.xyz.gz", b"", b"\n" * (1 << 20)),
                                   ("a.pdb.gz", b"", b"REMARK\n" * 150000), ("a.gsd.gz", b"", bytes(1 << 20)),
                                   ("a.cif.gz", b"data_x\n", b"# x\n" * 250000), ("a.csv.gz", b"x,y\n", b"1" * (1 << 20)),
                                   ("a.gro.gz", b"t\n1\n", b" " * (1 << 20)), ("a.lmp.gz", b"t\n", b"\n" * (1 << 20)),
                                   ("a.dump.gz", b"ITEM: TIMESTEP\n", b"0" * (1 << 20)),
                                   ("a.ply.gz", b"ply\nformat ascii 1.0\n", b"comment\n" * (1 << 17)),
                                   ("a.ply.gz", binary_ply("<").replace(b"vertex 2", b"vertex 100000000"), bytes(1 << 20))]:
            self.refuse(name, gzip.compress(start + block * 64, 1))

    def test_many_names(self):
        text = "70000\n\n" + "".join(f"n{i} 0 0 {i}\n" for i in range(70000))
        self.refuse("a.xyz", text, ":65538:", "different names")


class Independent(FileTest):
    """Counts and bounds, beside readers that share nothing with ours."""

    def ask(self, *arguments):
        result = subprocess.run([READERS_PYTHON, "-B", os.path.join(HERE, "independent.py"), *map(str, arguments)],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode == 77:
            self.skipTest(f"{arguments[0]} is not installed for {READERS_PYTHON}")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def compare(self, reader, name, kind, frame, scale=1.0, cell=False, sizes=False):
        path = os.path.join(self.folder, name)
        theirs, ours = self.ask(reader, path, kind, frame), self.summary(path, frame)
        self.assertEqual(ours["count"], theirs["count"], name)
        if sizes:  # they move the cell's corner to the origin
            for points in (ours, theirs):
                points["high"] = [b - a for a, b in zip(points["low"], points["high"])]
                points["low"] = [0, 0, 0]
        self.near([scale * x for x in ours["low"] + ours["high"]], theirs["low"] + theirs["high"], 2e-3)
        for member in ("frames", "bonds"):
            self.assertEqual(ours[member], theirs.get(member, ours[member]), name)
        if cell and any(map(any, theirs["cell"])):  # old versions forget it after the first frame
            self.near(sum(ours["cell"], []), sum(theirs["cell"], []), 1e-3)

    def test_files_that_they_write(self):
        written = self.ask("write", self.folder)
        if "ase" in written:
            for frame in (0, 1, -1):
                self.compare("ase", "a.extxyz", "extxyz", frame, cell=True)
                self.compare("ase", "a.xyz", "xyz", frame)
                self.compare("ase", "a.pdb", "proteindatabank", frame, cell=True)
            self.compare("ase", "a.lmp", "lammps-data", 0, cell=True)
        if "gsd" in written:
            for frame in range(4):
                self.compare("gsd", "a.gsd", "-", frame)
        if written != ["ase", "gsd"]:
            self.skipTest(f"ASE and gsd are not both installed for {READERS_PYTHON}")

    def test_ase_reads_ours(self):
        self.write("a.lammpstrj", DUMP[:DUMP.rindex("ITEM: TIMESTEP")].replace("zs q", "zs c_1").replace("id type", "id element type").replace("2 1 0.5", "2 O 1 0.5")
                   .replace("1 2 0 0", "1 H 2 0 0"))
        self.compare("ase", "a.lammpstrj", "lammps-dump-text", 0, cell=True, sizes=True)

    def test_mdanalysis(self):
        for name, content, kind, scale in [("a.pdb", PDB, "", 1), ("a.gro", GRO, "", 10), ("a.xyz", XYZ, "", 1)]:
            self.write(name, content)
            self.compare("mdanalysis", name, kind, 0, scale)

    def test_real_files(self):
        """Those of MDAnalysis's own tests, where they are installed."""
        found = subprocess.run([READERS_PYTHON, "-c", "import MDAnalysisTests, os; print(os.path.dirname(MDAnalysisTests.__file__))"],
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False).stdout.strip()
        if not found:
            self.skipTest(f"MDAnalysisTests is not installed for {READERS_PYTHON}")
        for name, kind, scale in [("adk_oplsaa.pdb", "", 1), ("adk_oplsaa.gro", "", 10), ("1hvr.pdb", "", 1),
                                  ("2r9r-1b.xyz", "", 1), ("example.gsd", "", 1), ("lammps/datatest.data", "DATA", 1)]:
            shutil.copy(os.path.join(found, "data", name), self.folder)
            self.compare("mdanalysis", os.path.basename(name), kind, 0, scale)


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0]] + sys.argv[2:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
