"""Tables of points: what XYZ, CSV and PLY files mean, value by value, as other programs write them.

Run as: python3 test_table_files.py particle_summary
BALLPARK_READERS_PYTHON names the Python that has ASE, plyfile and NumPy, where it is not this one; tests that compare with
them are skipped where they are missing.
"""
import csv
import gzip
import io
import json
import math
import os
import struct
import subprocess
import sys
import unittest

from answers import AnswersTest
from test_particle_files import GSD_FRAMES, floats, gsd_file, whole

READERS_PYTHON = os.environ.get("BALLPARK_READERS_PYTHON", sys.executable)


def linear(encoded):
    """IEC 61966-2-1."""
    return encoded / 12.92 if encoded <= 0.04045 else ((encoded + 0.055) / 1.055) ** 2.4


class TableTest(AnswersTest):
    def summary(self, name, content, *arguments):
        return self.answer(self.write(name, content), *arguments)

    def of(self, name, content, *arguments):
        """All that the reader finds: positions, radii, colours and a column, particle by particle."""
        result = self.summary(name, content, *(arguments or (0,)))
        self.assertEqual(result.returncode, 0, f"{content[:200]!r}: {result.stderr}")
        return json.loads(result.stdout)

    def refuse(self, name, content, *says, frame=0):
        result = self.summary(name, content, frame)
        self.assertEqual(result.returncode, 1, f"{content[:200]!r}: {result.stdout[:300]}{result.stderr[-1000:]}")
        for text in says:
            self.assertIn(text, result.stderr)

    def near(self, one, other, tolerance=1e-7):
        self.assertEqual(len(one), len(other), (one, other))
        for a, b in zip(one, other):
            self.assertLessEqual(abs(a - b), tolerance * max(1, abs(b)), (one, other))

    def places(self, name, content, expected, note=""):
        found = self.of(name, content)
        self.assertEqual(found["positions"], [list(map(float, place)) for place in expected], content)
        self.assertEqual(found["notes"], note, content)
        return found

    def colours(self, name, content, expected, note=""):
        """`expected`: shares of light, linear."""
        found = self.of(name, content)
        self.near(sum(found["colors"], []), sum(map(list, expected), []), 1e-6)
        self.assertIn(note, found["notes"], content)
        return found


BYTES, SHARES, WORDS = ("colours read as bytes (sRGB)", "colours read as linear shares from 0 to 1",
                        "colours read as 16 bits (sRGB)")
MARK = b"\xef\xbb\xbf"
PLY = "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n%send_header\n"
PDB = "ATOM      1  C   LIG A   1       1.000   2.000   3.000  1.00 10.00           C\n"
FILES = {"a.xyz": "1\nc\nC 1 2 3\n", "a.pdb": PDB, "a.csv": "x,y,z\n1,2,3\n", "a.ply": PLY % (1, "") + "1 2 3\n",
         "a.gro": "t\n1\n    1SOL     OW    1   1.000   2.000   3.000\n   9.0   9.0   9.0\n",
         "a.dump": "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS id type x y z\n"
                   "1 1 1 2 3\n",
         "a.data": "t\n\n1 atoms\n1 atom types\n\nAtoms # atomic\n\n1 1 1 2 3\n",
         "a.cif": "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\nC 1 2 3\n"}


class Encodings(TableTest):
    def test_byte_order_marks(self):
        """Before the first line, packed too, and where files were joined."""
        for name, text in FILES.items():
            plain = self.of(name, text)
            self.assertEqual(plain["positions"], [[1, 2, 3]], name)
            for content in (MARK + text.encode(), MARK + text.replace("\n", "\r\n").encode()):
                self.assertEqual(self.of(name, content), plain, name)
                self.assertEqual(self.of(name + ".gz", gzip.compress(content)), plain, name)
        for name in ("a.xyz", "a.dump", "a.gro"):
            joined = 2 * (MARK + FILES[name].encode())
            self.assertEqual((self.of(name, joined, 1)["frames"], self.of(name, joined, 1)["positions"]), (2, [[1, 2, 3]]), name)

    def test_formats_are_found_behind_a_mark(self):
        for name, text in FILES.items():
            if name[2:] in ("pdb", "ply", "dump", "cif"):
                for content in (text.encode(), MARK + text.encode()):
                    self.assertEqual(self.of("any.name", content), self.of(name, text), name)

    def test_marks_before_binary_rows(self):
        head = (PLY % (2, "")).replace("ascii", "binary_little_endian").encode()
        self.places("a.ply", MARK + head + struct.pack("<6f", 1, 2, 3, 4, 5, 6), [(1, 2, 3), (4, 5, 6)])

    def test_wide_texts(self):
        """UTF-16 and UTF-32, with a mark or without, packed or not, name what to do."""
        for name, text in FILES.items():
            for codec in ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-32-le", "utf-32-be"):
                content = text.encode(codec)
                says = ("expected UTF-8", f"iconv -f {codec[:6].upper()} -t UTF-8")
                self.refuse(name, content, name + ":0: ", *says)
                self.refuse(name + ".gz", gzip.compress(content), *says)

    def test_line_ends(self):
        """CR alone, as computers of Apple wrote them before 2001, and what else ends lines."""
        for name, text in FILES.items():
            plain = self.of(name, text)
            for end in ("\r\n", "\r", "\r\r\n"):
                self.assertEqual(self.of(name, text.replace("\n", end)), plain, (name, end))
            self.assertEqual(self.of(name, text.rstrip("\n").replace("\n", "\r\n") + "\r\n\x1a"), plain, name)  # the end of a text of DOS
        self.refuse("a.csv", "x,y,z\n1,2,3\n\x1a\n4,5,6\n", ":3:")
        self.places("a.csv", "x,y,z,text\r1,2,3,\"" + "a" * 3000 + "\"\r4,5,6,b\r", [(1, 2, 3), (4, 5, 6)])
        head = (PLY % (1, "")).replace("ascii", "binary_big_endian").replace("\n", "\r").encode()
        self.places("a.ply", head + struct.pack(">3f", 1, 2, 3), [(1, 2, 3)])


class Numbers(TableTest):
    def test_exponents(self):
        """As Fortran and Mathematica write them, wherever a format has words."""
        cases = [("1.5D+00", 1.5), ("-2.5d-1", -0.25), ("0.4Q1", 4), ("-4.7*^-1", -0.47), ("25*^-2", 0.25), ("0.25-103", 0.25e-103),
                 ("1e-2", 0.01), ("+1.25E+02", 125), ("0.123456789012345678D+01", 1.23456789012345678)]
        for text, value in cases:
            for name, content in [("a.xyz", FILES["a.xyz"].replace(" 2 ", f" {text} ")), ("a.csv", FILES["a.csv"].replace(",2,", f",{text},")),
                                  ("a.ply", FILES["a.ply"].replace(" 2 ", f" {text} ")), ("a.cif", FILES["a.cif"].replace(" 2 ", f" {text} ")),
                                  ("a.dump", FILES["a.dump"].replace(" 1 2 3", f" 1 {text} 3")),
                                  ("a.data", FILES["a.data"].replace(" 1 2 3", f" 1 {text} 3"))]:
                self.near([self.of(name, content)["positions"][0][1]], [value], 1e-15)

    def test_what_is_no_exponent(self):
        for text in ("1D", "1.5*^", "1*2", "1-103", "1.5-1034", "1.5-12", "1.5D5x", "1e5D3", "1D400", "1.5+101"):
            self.refuse("a.xyz", FILES["a.xyz"].replace(" 2 ", f" {text} "), ":3:")

    def test_the_wrong_word_is_shown(self):
        for words, wrong in (("x 2 3", "x"), ("1 x 3", "x"), ("1 2 x", "x"), ("1.5 0 inf", "inf")):
            self.refuse("a.xyz", f"1\nc\nC {words}\n", f'found "{wrong}"')
        head = "1\nProperties=species:S:1:pos:R:3:color:R:3\n"
        self.refuse("a.xyz", head + "C 1 2 3 0.5 green 0\n", 'found "green"')
        self.refuse("a.xyz", head + "C 1 2 3 0.5 -1 0\n", "green: found -1")

    def test_points_without_a_place(self):
        """They are left out with a note, in every format."""
        for word in ("nan", "NaN", "-nan", "+NAN", "-nan(ind)", "nan(0x7)", "-1.#IND", "1.#QNAN", "*", "********"):
            for name, text in FILES.items():
                if name == "a.gro":  # its first atom says how wide the columns are
                    text = text.replace("\n1\n", "\n2\n").replace("    1SOL", text.split("\n")[2] + "\n    1SOL", 1)
                    text = text[:-70] + text[-70:].replace("   2.000", word.rjust(8)) if len(word) <= 8 else None
                elif name == "a.pdb":
                    text = text.replace("   2.000", word.rjust(8)) if len(word) <= 8 else None
                else:
                    text = text.replace("1 2 3\n", f"1 {word} 3\n").replace("1,2,3\n", f"1,{word},3\n")
                if name == "a.cif":  # brackets hold uncertainties; a table of atoms without any place is refused
                    text = text + "C 1 2 3\n" if "(" not in word else None
                if text is not None and not (name == "a.data" and "#" in word):  # a remark
                    found = self.of(name, text)
                    self.assertEqual(found["positions"], [[1, 2, 3]] if name in ("a.cif", "a.gro") else [], (name, word))
                    self.assertTrue(found["notes"].endswith("1 point without a place left out"), (name, word, found["notes"]))
        self.places("a.xyz", "4\n\nC 1 2 3\nC nan 0 0\nC 4 5 6\nC 0 0 ****\n", [(1, 2, 3), (4, 5, 6)], "2 points without a place left out")
        for bad in ("inf", "-Infinity", "1e13"):
            self.refuse("a.csv", FILES["a.csv"].replace("2", bad), ":2:")

    def test_points_without_a_place_in_binary_files(self):
        nan = math.nan
        for order, form in ("<", "little"), (">", "big"):
            for letter, kind in ("f", "float"), ("d", "double"):
                head = (PLY % (3, "")).replace("ascii", f"binary_{form}_endian").replace("float", kind)
                self.places("a.ply", head.encode() + struct.pack(f"{order}9{letter}", nan, nan, nan, 1, 2, 3, 4, nan, 6), [(1, 2, 3)],
                            "2 points without a place left out")

    def test_bonds_beside_points_without_a_place(self):
        """Bonds count the particles of the file: those that are left keep theirs."""
        data = ("t\n\n4 atoms\n1 atom types\n3 bonds\n\nAtoms # molecular\n\n10 1 1 0 0 0\n20 1 1 nan 0 0\n30 1 1 1 0 0\n40 1 1 2 0 0\n\n"
                "Bonds\n\n1 1 30 40\n2 1 10 20\n3 1 10 30\n")
        pdb = "".join(f"HETATM{n:5d}  C   LIG A   1    {x:>8s}   0.000   0.000\n" for n, x in
                      [(10, "0.000"), (20, "     nan"), (30, "1.000"), (40, "2.000")]) + "CONECT   30   40\nCONECT   10   20   30\n"
        nan = math.nan
        gsd = gsd_file([dict(GSD_FRAMES[0], **{
            "particles/N": whole(1, 4), "particles/position": floats(3, 0, 0, 0, 0, nan, 0, 1, 0, 0, 2, 0, 0), "particles/typeid": whole(1, 0, 1, 0, 1),
            "particles/diameter": floats(1, 1, 2, 3, 4), "bonds/N": whole(1, 3), "bonds/group": whole(2, 2, 3, 0, 1, 0, 2)})])
        found = self.of("a.gsd", gsd)
        self.assertEqual((found["radii"], found["types"]), ([0.5, 1.5, 2], ["A", "A", "Bee"]))
        for name, content in ("a.data", data), ("a.pdb", pdb), ("a.gsd", gsd):
            found = self.of(name, content)
            self.assertEqual(found["positions"], [[0, 0, 0], [1, 0, 0], [2, 0, 0]], name)
            self.assertEqual((sorted(map(sorted, found["pairs"])), found["left_out"]), ([[0, 1], [1, 2]], 1), name)
            self.assertIn("1 point without a place left out", found["notes"])

    def test_guessed_styles_beside_points_without_a_place(self):
        """A data file that does not name its style: such a point speaks for none, and refuses none."""
        for rows in ("1 1 nan 2 3\n2 1 4 5 6\n", "1 1 1 2 3\n2 1 4 nan 6\n"):
            found = self.of("a.data", "t\n\n2 atoms\n1 atom types\n\nAtoms\n\n" + rows)
            self.assertEqual(found["positions"], [[4, 5, 6]] if "nan 2" in rows else [[1, 2, 3]])
            self.assertIn("1 point without a place left out", found["notes"])

    def test_types_names_and_columns_stay_with_their_points(self):
        found = self.of("a.csv", "x,y,z,type,q\n1,2,3,A,10\n,,3,B,20\n4,5,6,C,30\n", 0, "q")
        self.assertEqual((found["types"], found["values"], found["count"]), (["A", "C"], [10, 30], 2))


class Xyz(TableTest):
    def cell(self, comment, expected, origin=(0, 0, 0)):
        found = self.of("a.xyz", f"1\n{comment}\nC 1 2 3\n")
        self.assertEqual((found.get("cell"), found.get("origin")), (expected, list(origin) if expected else None), comment)
        return found

    def test_cells(self):
        edges = [[4, 0, 0], [1, 5, 0], [2, 3, 6]]
        p = " Properties=species:S:1:pos:R:3"
        for value in ('"4 0 0 1 5 0 2 3 6"', "'4 0 0 1 5 0 2 3 6'", "[4, 0, 0, 1, 5, 0, 2, 3, 6]", "{4 0 0 1 5 0 2 3 6}",
                      "[[4, 0, 0], [1, 5, 0], [2, 3, 6]]", "[[4,0,0],[1,5,0],[2,3,6]]", '"4.0D+00 0 0 1 5 0 2 3 6*^0"',
                      "{{4 0 0} {1 5 0} {2 3 6}}", "4,0,0,1,5,0,2,3,6", '" 4, 0, 0, 1, 5, 0, 2, 3, 6 "', '"[[4 0 0] [1 5 0] [2 3 6]]"'):
            for comment in (f"Lattice={value}{p}", f"{p[1:]} Lattice={value}", f"Lattice = {value}{p}", f"Lattice={value}",
                            f'note="a \\" Lattice=0 \'" t=\'x\' e=[1, 2] Lattice={value}{p}', f"lattice={value}{p}",
                            f"energy=-1.5 free {p} Lattice={value} pbc=[T, F, T]"):
                self.cell(comment, edges)
        self.cell("Lattice='4 5 6'" + p, [[4, 0, 0], [0, 5, 0], [0, 0, 6]])
        self.cell("Lattice=\"4 0 0 1 5 0 2 3 6\" Origin=[-1, -2.5, 3]" + p, edges, (-1, -2.5, 3))
        self.cell("Origin='1 2 3' Lattice={4 0 0 1 5 0 2 3 6}" + p, edges, (1, 2, 3))

    def test_periodic_flags(self):
        lattice = "Lattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3 pbc="
        for flags, periodic in [('"F F F"', "FFF"), ("'F T F'", "FTF"), ("[F, F, T]", "FFT"), ("{T F F}", "TFF"), ('"T T T"', "TTT"), ("[T,T,F]", "TTF"),
                                ("[True, False, True]", "TFT"), ("'1 0 1'", "TFT"),
                                ("TTF", "TTF"), ('"FTF"', "FTF"), ("t", "TTT"), ("011", "FTT"), ("F", "FFF")]:
            self.assertEqual(self.cell(lattice + flags, [[4, 0, 0], [0, 5, 0], [0, 0, 6]])["periodic"], [flag == "T" for flag in periodic], flags)

    def test_cells_that_cannot_be_read(self):
        """An error where the frame has one for certain, else a note; never silence."""
        p = " Properties=species:S:1:pos:R:3"
        for value in ('"4 0 0"x"', '"1 2 3 4"', '"4 0 0 0 4 0 0 0 x"', "[[4,0,0],[0,4,0]]", '"4 0 0 0 4 0 0 0 nan"', '"4 0 0', "[4, 0, 0",
                      "4 0 0 0 4 0 0 0 4", '""'):
            if value != '"4 0 0"x"':
                self.refuse("a.xyz", f"1\nLattice={value}{p}\nC 1 2 3\n", ":2:", "Lattice")
                self.refuse("a.xyz", f"1\nLattice={value}\nC 1 2 3\n", ":2:", "Lattice")
        self.refuse("a.xyz", f"1\nLattice='4 4 4' Origin='1 2'{p}\nC 1 2 3\n", ":2:", "Origin")
        for comment, note in [("fcc, lattice=4.05", "lattice= passed over"), ("cell='4 4 4'" + p, "cell= passed over")]:
            self.assertIn(note, self.cell(comment, None)["notes"])
        # Of two dimensions, as ASE writes surfaces, and one whose vectors span nothing.
        self.assertEqual(self.cell("Lattice='4 0 0 0 5 0 0 0 0'" + p, [[4, 0, 0], [0, 5, 0], [0, 0, 0]])["periodic"], [True, True, False])
        self.assertIn("flat", self.cell("Lattice='4 0 0 8 0 0 0 0 6'" + p, [[4, 0, 0], [8, 0, 0], [0, 0, 6]])["notes"])
        for comment in ("", " ", "\t", "it's water, \"fine", "a = b = c", "=", "(x", "Lattice of 4", "x=\"Lattice=3\""):
            self.assertEqual(self.cell(comment, None)["notes"], "", comment)

    def test_properties(self):
        atom = {"species": "C", "pos": "1 2 3", "radius": "0.5", "color": "1 0.5 0", "f": "7 8 9", "fixed": "T", "site": '"C alpha"', "id": "4"}
        kinds = {"species": "S:1", "pos": "R:3", "radius": "R:1", "color": "R:3", "f": "R:3", "fixed": "L:1", "site": "S:1", "id": "I:1"}
        orders = [list(atom), list(atom)[::-1], ["pos", "site", "species", "color", "fixed", "f", "id", "radius"]]
        for order in orders:
            for change in (str, str.upper, str.capitalize):
                names = ":".join(f"{change(name)}:{kinds[name]}" for name in order)
                for properties in (f"Properties={names}", f'Properties="{names}"', f"properties={names.replace(':R:', ':r:')}"):
                    line = " ".join(atom[name] for name in order)
                    found = self.of("a.xyz", f"1\n{properties} energy=-1\n{line}\n", 0, change("f") + "_y")
                    self.assertEqual((found["positions"], found["radii"], found["colors"], found["types"], found["values"], found["elements"]),
                                     ([[1, 2, 3]], [0.5], [[1, 0.5, 0]], ["C"], [8], {"C": 1}), (properties, line))
        for properties, line, kind, element in [("type:S:1:pos:R:3", "C 1 2 3", "C", "C"), ("pos:R:3:particle_type:I:1", "1 2 3 4", "4", ""),
                                                ("species:S:1:pos:R:3:type:I:1", "C 1 2 3 7", "C", "C"), ("type:I:1:species:S:1:pos:R:3", "7 C 1 2 3", "C", "C"),
                                                ("species:I:1:pos:R:3", "6 1 2 3", "6", ""), ("numbers:I:1:pos:R:3", "8 1 2 3", "O", "O"),
                                                ("pos:R:3:atomic_numbers:I:1:type:I:1", "1 2 3 8 5", "O", "O"), ("symbols:S:1:pos:R:3", "Fe 1 2 3", "Fe", "Fe")]:
            found = self.of("a.xyz", f"1\nProperties={properties}\n{line}\n")
            self.assertEqual((found["types"], found["elements"], found["positions"]), ([kind], {element: 1}, [[1, 2, 3]]), properties)
        for sizes, words, radius in ("diameter:R:1", "3", 1.5), ("diameter:R:1:radius:R:1", "3 5", 5), ("radius:R:1:diameter:R:1", "5 3", 5):
            self.assertEqual(self.of("a.xyz", f"1\nProperties=species:S:1:pos:R:3:{sizes}\nC 1 2 3 {words}\n")["radii"], [radius], sizes)
        head = "1\nProperties=species:S:1:pos:R:3:fixed:L:1\n"
        for word, value in [("T", 1), ("F", 0), ("True", 1), ("false", 0), ("TRUE", 1)]:
            self.assertEqual(self.of("a.xyz", head + f"C 1 2 3 {word}\n", 0, "fixed")["values"], [value])
        for properties in ("species:S:1", "species:S:1:pos:R:2", "species:S:1:pos:R", "species:S:1:pos:Q:3", "pos:R:0", "pos:R:x"):
            self.refuse("a.xyz", f"1\nProperties={properties}\nC 1 2 3\n", ":2:", "pos:R:3")
        self.refuse("a.xyz", "1\nProperties=\"species:S:1:pos:R:3\nC 1 2 3\n", ":2:", "closes it")

    def test_texts_in_quotes(self):
        head = "1\nProperties=%s\n"
        for properties, line, kind in [("species:S:1:pos:R:3:site:S:1", 'C 1 2 3 "C alpha"', "C"), ("site:S:1:species:S:1:pos:R:3", '"site a" C 1 2 3', "C"),
                                       ("site:S:1:species:S:1:pos:R:3", "'site a b' O 1 2 3", "O"), ("species:S:1:pos:R:3", '"Fe" 1 2 3', "Fe"),
                                       ("species:S:1:pos:R:3:a:S:1:b:S:1", 'C 1 2 3 "x y" "O5\' z"', "C"), ("pos:R:3:a:S:2:species:S:1", '1 2 3 "a b" c C', "C")]:
            found = self.places("a.xyz", head % properties + line + "\n", [(1, 2, 3)])
            self.assertEqual(found["types"], [kind], line)
        # Names of atoms have quotes of their own.
        found = self.of("a.xyz", "3\nProperties=name:S:1:species:S:1:pos:R:3\nO5' O 1 2 3\nH5'' H 4 5 6\n'H5 H 7 8 9\n")
        self.assertEqual((found["atom_names"], found["count"]), (["O5'", "H5''", "'H5"], 3))
        self.refuse("a.xyz", head % "species:S:1:pos:R:3:site:S:1" + 'C 1 2 3 "a b" c\n', ":3:", "expected 5")

    def test_colours(self):
        head = "2\nProperties=species:S:1:pos:R:3:color:%s:3\n"
        self.colours("a.xyz", head % "R" + "C 0 0 0 1 0.5 0\nC 1 1 1 0 0 0.25\n", [(1, 0.5, 0), (0, 0, 0.25)])
        self.colours("a.xyz", head % "R" + "C 0 0 0 255 127.5 0\nC 1 1 1 0 0 10\n", [(1, linear(0.5), 0), (0, 0, linear(10 / 255))], BYTES)
        self.colours("a.xyz", head % "I" + "C 0 0 0 255 128 0\nC 1 1 1 0 0 10\n", [(1, linear(128 / 255), 0), (0, 0, linear(10 / 255))], BYTES)
        self.colours("a.xyz", head % "I" + "C 0 0 0 1 0 0\nC 1 1 1 0 1 1\n", [(1, 0, 0), (0, 1, 1)], SHARES)
        self.colours("a.xyz", (head % "R").replace("R:3\n", "R:4\n") + "C 0 0 0 1 0.5 0 1\nC 1 1 1 0 0 0.25 0.5\n", [(1, 0.5, 0), (0, 0, 0.25)])
        # In columns of their own, here and in dumps of LAMMPS; a property or column that holds the colour goes before.
        dump = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS x y z %s\n")
        for names in ("r g b", "Red Green Blue", "color_r color_g color_b"):
            head = "2\nProperties=species:S:1:pos:R:3:" + ":".join(f"{name}:%s:1" for name in names.split()) + "\n"
            for row, last, light, note in [("1 0.5 0", "0 0 0.25", [(1, 0.5, 0), (0, 0, 0.25)], SHARES), ("255 128 0", "0 1 10", [(1, linear(128 / 255), 0),
                                           (0, linear(1 / 255), linear(10 / 255))], BYTES)]:
                for kind in ("R", "I") if note == BYTES else ("R",):
                    self.colours("a.xyz", head % (kind, kind, kind) + f"C 0 0 0 {row}\nC 1 1 1 {last}\n", light, note)
                self.colours("a.dump", dump % names + f"0 0 0 {row}\n1 1 1 {last}\n", light, note)
            self.refuse("a.xyz", head % ("R", "R", "R") + "C 0 0 0 x 0 0\nC 1 1 1 0 0 0\n", ":3:", '"x"')
            self.refuse("a.dump", dump % names + "0 0 0 0 x 0\n1 1 1 0 0 0\n", ":10:", '"x"')
        self.colours("a.xyz", "1\nProperties=species:S:1:pos:R:3:color:R:3:r:R:1:g:R:1:b:R:1\nC 0 0 0 1 0.5 0 0 0 1\n", [(1, 0.5, 0)], SHARES)
        self.assertEqual(self.of("a.xyz", "1\nProperties=species:S:1:pos:R:3:red:R:1:green:R:1\nC 0 0 0 1 0.5\n")["notes"],
                         'no colours from "red", since red, green and blue must be columns')

    def test_units(self):
        head = "1\n# CELL(abcABC): 9 9 9 90 90 90  Step: 0 Bead: 0 positions{%s} cell{atomic_unit}\nC 1 2 3\n"
        for unit, angstrom, note in [("atomic_unit", 1.8897261246, "lengths in bohr"), ("bohr", 1.8897261246, "lengths in bohr"), ("angstrom", 1, ""),
                                     ("parsec", 1, "not known")]:
            found = self.of("a.xyz", head % unit)
            self.near([found["angstrom"]], [angstrom], 1e-5)
            self.assertIn(note, found["notes"])
            self.assertIn("CELL passed over", found["notes"])

    def test_wrong_counts(self):
        one, two = "1\n\nC 0 0 0\n", "1\n\nC 0 0 0\nC 0 0 1\n"
        for text, line in ((two, 4), (two + one, 4), (one + two, 7), ("\n" + two + "\n", 5), ("1\n\n1 0 0 0\n\n1 0 0 1 9\n", 5)):
            for frame in (0, 1, -1):
                if (text, frame) == (one + two, 0):
                    continue
                result = self.summary("a.xyz", text, frame)
                self.assertIn(f":{line}: found more atoms than the number above them", result.stderr, (text, frame))
        head = "1\nProperties=pos:R:3:species:S:1\n"
        self.refuse("a.xyz", head + "0 0 0 C\n0 0 1 C\n", ":4: found more atoms")

    def test_text_behind(self):
        """What stands behind the last frame and is neither an atom nor a frame is left out, with a note."""
        numbers, names, molecule = "1341.307\t1341.3284\t1562.6731\t3038.3205\n", "C\tC\n", "InChI=1S/CH4/h1H4\tInChI=1S/CH4/h1H4\n"
        atoms = "2\ngdb 1\nC\t0\t0\t0\t-0.53\nH\t0\t0\t1.1*^0\t0.13\n"
        for behind in (numbers + names + molecule, names, "\n" + molecule, "end\n", "0.5 0.5\n"):
            for count in (1, 3):
                for frame in (0, count - 1, -1):
                    found = self.of("a.xyz", atoms * count + behind, frame)
                    self.assertEqual((found["count"], found["elements"]), (2, {"C": 1, "H": 1}))
                    note = "text behind the last frame left out"
                    self.assertEqual(note in found["notes"], frame in (count - 1, -1), (behind, count, frame))
                    self.assertEqual("the first of several" in found["notes"], count > 1 and frame == 0)
            self.refuse("a.xyz", atoms + behind, "found 1 frame,", frame=1)
        # The next frame is still being written.
        for length in range(len(atoms)):
            found = self.of("a.xyz", atoms + atoms[:length], 0)
            self.assertEqual((found["count"], "text" in found["notes"]), (2, False))
        self.refuse("a.xyz", "0.5 0 0\n1 0 0\n", ":1:", "ends in .csv")
        self.refuse("a.xyz", "x y z\n1 0 0\n", ":1:", "first line\n")


class Csv(TableTest):
    def test_colours(self):
        self.colours("a.csv", "//X Y Z Rf Gf Bf\n1 2 3 1 0.5 0\n", [(1, 0.5, 0)], SHARES)
        for header in ("r,g,b", "R,G,B", "red,green,blue", "Red,Green,Blue", "color_r,color_g,color_b", "Color.R,Color.G,Color.B",
                       "RGB:0,RGB:1,RGB:2", "diffuse_red,diffuse_green,diffuse_blue", "r,g,b,a", "vertex_color_r,vertex_color_g,vertex_color_b"):
            alpha = ",7" if header.endswith(",a") else ""
            for numbers, scale, note in [((255, 128, 5, 0, 10, 11), 255, BYTES), ((1, 0.5, 0, 0, 0.25, 1), 1, SHARES),
                                         ((65535, 32768, 0, 257, 1000, 1), 65535, WORDS), ((0, 0, 0, 1, 0, 0), 1, SHARES)]:
                one, two = (",".join(map(str, numbers[3 * i:3 * i + 3])) for i in (0, 1))
                light = [n / scale if scale == 1 else linear(n / scale) for n in numbers]
                found = self.colours("a.csv", f"x,y,z,{header}\n0,0,0,{one}{alpha}\n9,9,9,{two}{alpha}\n", [light[:3], light[3:]], note)
                self.assertEqual(found["radii"], [], header)

    def test_colours_in_one_column(self):
        """Names, packed numbers and coefficients of splats: a note, unless red, green and blue are there, or a column is the colour."""
        says = 'no colours from "{}", since red, green and blue must be columns'
        for column, value in (("color", "#ff0000"), ("Colour", "red"), ("rgb", "16711680"), ("RGBA", "ff0000ff"), ("hex_color", "ff0000"), ("f_dc_0", "1.5"),
                              ("red", "1"), ("Green", "1")):
            self.assertEqual(self.of("a.csv", f"x,y,z,{column}\n1,2,3,{value}\n")["notes"], says.format(column))
            self.assertEqual(self.of("a.csv", f"x,y,z,{column},color_r,color_g,color_b\n1,2,3,{value},1,0,0\n")["notes"], SHARES)
            self.assertEqual(self.of("a.csv", f"x,y,z,{column}\n1,2,3,{value}\n", 0, "x")["notes"], "")
        self.assertEqual(self.of("a.ply", PLY % (1, "property float f_dc_0\n") + "1 2 3 4\n")["notes"], says.format("f_dc_0"))
        self.assertEqual(self.of("a.xyz", "1\nProperties=species:S:1:pos:R:3:rgb:I:1\nC 1 2 3 4\n")["notes"], says.format("rgb"))
        self.assertEqual(self.of("a.csv", "x,y,z,colorless,hexagonal\n1,2,3,4,5\n")["notes"], "")

    def test_colours_that_are_none(self):
        rows = "x,y,z,r,g,b\n0,0,0,%s\n1,1,1,0,0,0\n"
        self.refuse("a.csv", rows % "-1,0,0", ":2:", "red: found -1")
        self.refuse("a.csv", rows % "1,70000,0", ":2:", "green: found 70000")
        self.refuse("a.csv", rows % "1,,0", ":2:", "green: found nan")
        self.refuse("a.csv", rows % "0,0,1.5", ":2:", "blue: found 1.5", "shares", "bytes")
        self.refuse("a.csv", rows % "#ff0000,0,0", ":2:", "#ff0000")

    def test_radii(self):
        for header, row, radius, column in [("radius,r", "1,0.2", 1, "r"), ("r,radius", "0.2,1", 1, "r"), ("r", "0.25", 0.25, None), ("R", "0.25", 0.25, None),
                                            ("diameter", "3", 1.5, None), ("d", "3", 1.5, None), ("r,diameter", "9,3", 1.5, "r"), ("Radius", "2", 2, None),
                                            ("r,g", "0.25,7", 0.25, "g"), ("radius,r,g,b", "2,1,0,0", 2, "r"), ("r (nm)", "0.25", 0.25, None)]:
            found = self.of("a.csv", f"x,y,z,{header}\n1,2,3,{row}\n", 0, *([column] if column else []))
            self.assertEqual(found["radii"], [radius], header)
            if column:
                self.near(found["values"], [float(dict(zip(header.split(","), row.split(",")))[column])])
        self.assertEqual(self.of("a.csv", "x,y,z,radius\n1,2,3,0.5\n4,5,6,\n")["radii"], [0.5, None])
        # Beside an angle, r is the distance from the centre, and no radius.
        for header, radii in [("r,theta,phi", []), ("r,Theta (deg)", []), ("phi,r", []), ("r,theta,radius", [7]), ("theta,d", []), ("r,theta0", [5])]:
            row = [{"radius": "7", "r": "5", "d": "6"}.get(name, "1") for name in header.split(",")]
            self.assertEqual(self.of("a.csv", f"x,y,z,{header}\n1,2,3,{','.join(row)}\n")["radii"], radii, header)

    def test_names_of_places(self):
        for names in ("x,y,z", "X,Y,Z", "x (nm),y (nm),z (nm)", "x [A],y [A],z [A]", "x/nm,y/nm,z/nm", "Position.X,Position.Y,Position.Z", "pos_x,pos_y,pos_z",
                      "posx,posy,posz", "Points:0,Points:1,Points:2", "Points_0,Points_1,Points_2", "coords_0,coords_1,coords_2", "coords[0],coords[1],coords[2]",
                      "Position X,Position Y,Position Z", "x_coord,y_coord,z_coord", "X Position,Y Position,Z Position", "center_x,center_y,center_z",
                      '"x","y","z"', '"x (a, b)","y (a, b)","z (a, b)"', " x , y , z ", "x[µm],y[µm],z[µm]", "x_nm,y_nm,z_nm", "x nm,y nm,z nm",
                      "pos_x_um,pos_y_um,pos_z_um", "X_µm,Y_µm,Z_µm"):
            self.places("a.csv", f"{names}\n1,2,3\n4,5,6\n", [(1, 2, 3), (4, 5, 6)])
            self.places("a.csv", f"id,{names},q\n9,1,2,3,8\n9,4,5,6,8\n", [(1, 2, 3), (4, 5, 6)])
            self.places("a.csv", f"# {names}\n1,2,3\n", [(1, 2, 3)])
        self.places("a.csv", "z,y,x\n1,2,3\n", [(3, 2, 1)])
        self.places("a.csv", "Points:0,Points:1,Points:2,x,y,z\n7,8,9,1,2,3\n", [(1, 2, 3)], "places from x, y, z")
        self.places("a.csv", "x,y,x/y,z\n1,2,9,3\n", [(1, 2, 3)])
        self.refuse("a.csv", "x,y,z,X\n1,2,3,4\n", "found x in two columns")
        self.refuse("a.csv", "x (nm),x (px),y\n1,2,3\n", "found x in two columns")
        self.places("a.csv", "x,y,z,x_nm\n1,2,3,4\n", [(1, 2, 3)])
        self.refuse("a.csv", "x (nm),y (nm),z (um)\n1,2,3\n", "nm", "um", "one unit")
        self.refuse("a.csv", "x_nm,y_nm,z_nm,r_um\n1,2,3,4\n", "nm", "um", "one unit")
        for other in ("cm", "m", "a", "px", "nm_0"):  # a centre of mass, an index, no unit
            self.refuse("a.csv", f"x_{other},y_{other},z_{other}\n1,2,3\n", "no columns x and y")
        self.refuse("a.csv", "a,b,c\n1,2,3\n", "no columns x and y")

    def test_units_of_elements(self):
        """Radii by element are in the unit of the places."""
        for unit, angstrom in [("nm", 0.1), ("A", 1), ("Å", 1), ("pm", 100), ("um", 1e-4), ("px", 1)]:
            self.near([self.of("a.csv", f"x ({unit}),y ({unit}),z,element\n1,2,3,C\n")["angstrom"]], [angstrom])
            if len(unit) > 1 and unit != "px":
                self.near([self.of("a.csv", f"x_{unit},y_{unit},z_{unit},element\n1,2,3,C\n")["angstrom"]], [angstrom])
        self.assertEqual(self.of("a.csv", "x,y,z,element\n1,2,3,C\n")["angstrom"], 1)

    def test_texts_below_the_names(self):
        """Units, and what TrackMate repeats; places that are no texts are wrong, missing or infinite."""
        note = "%s of texts below the names passed over"
        for text, count, angstrom in [("x,y,z\nnm,nm,nm\n1,2,3\n", "1 line", 0.1), ("x,y,z\n(micron),(micron),(micron)\n1,2,3\n", "1 line", 1e-4),
                                      ("x;y;z\n[A];[A];[A]\n1,0;2;3\n", "1 line", 1), ("x,y,z,radius\nnm,nm,nm,um\n1,2,3,4\n", "1 line", 0),
                                      ("LABEL,POSITION_X,POSITION_Y,POSITION_Z,RADIUS\nLabel,X,Y,Z,Radius\nLabel,X,Y,Z,R\n,(micron),(micron),(micron),(micron)\n"
                                       "ID1,1,2,3,0.5\n", "3 lines", 1e-4), ("x (nm),y (nm),z (nm)\na,b,c\n1,2,3\n", "1 line", 0.1)]:
            found = self.places("a.csv", text, [(1, 2, 3)], note % count)
            self.near([found["angstrom"]], [angstrom])
        self.refuse("a.csv", "x,y,z\nm,m,1\n1,2,3\n", ":2:", 'found "m"')
        self.refuse("a.csv", "x,y,z\ninf,inf,inf\n1,2,3\n", ":2:", 'found "inf"')
        self.refuse("a.csv", "x,y,z\n1,2,3\nm,m,m\n", ":3:", 'found "m"')
        self.refuse("a.csv", "x,y,z\nm,m,m\n", "without rows")
        self.places("a.csv", "x,y,z\nNA,NA,NA\n1,2,3\n", [(1, 2, 3)], "1 point without a place left out")

    def test_columns_twice(self):
        self.assertIn('found two columns "v", expected one', self.summary("a.csv", "x,y,z,v,v\n1,2,3,4,5\n", 0, "v").stderr)
        self.assertEqual(self.of("a.csv", "x,y,z,v,w,w\n1,2,3,4,5,6\n", 0, "v")["values"], [4])
        dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z q q\n1 2 3 4 5 6\n"
        self.assertIn('found two columns "q"', self.summary("a.dump", dump, 0, "q").stderr)

    def test_elements(self):
        for name, word, element in ("element", "Fe2+", "Fe"), ("symbol", "na", "Na"), ("Chemical Symbol", "C", "C"), ("type", "C", ""):
            self.assertEqual(self.of("a.csv", f"x,y,z,{name}\n1,2,3,{word}\n")["elements"], {element: 1}, name)

    def test_decimal_commas(self):
        expected = [(0.5, 1.5, 0), (-1.25, 2.5e3, 1234)]
        for separator in ";\t":
            rows = [separator.join(row) for row in (("0,5", "1,5", "0"), ("-1,25", "2,5E+03", "1234"))]
            for head in (separator.join("xyz") + "\n", ""):
                self.places("a.csv", head + "\n".join(rows), expected, "" if head else "columns without names read as x, y, z, radius")
        self.places("a.csv", "x y z\n0,5 1,5 0\n-1,25 2,5E+03 1234\n", expected)
        self.places("a.csv", 'x,y,z\n"0,5","1,5",0\n"-1,25","2,5E+03",1234\n', expected)
        self.assertEqual(self.of("a.csv", "x;y;z;q\n0,5;0;0;7,25\n", 0, "q")["values"], [7.25])
        self.assertEqual(self.of("a.csv", "x;y;z;radius\n0,5;0;0;7,25\n")["radii"], [7.25])

    def test_separators_of_thousands(self):
        for text in ("1,234.5", "1.234,5", "1,234,567", "1'234", "1 234"):
            self.refuse("a.csv", f'x;y;z\n0;"{text}";0\n', ":2:", text)
        for text in ("1,234", "12,345,678.5"):
            self.refuse("a.csv", f'x,y,z\n0,"{text}",0\n', ":2:", text, "thousands")
        self.refuse("a.csv", "x;y;z\n0,5;1;2\n0;1.5;2\n", ":3:", "1.5", "decimal comma in line 2")
        self.refuse("a.csv", "x;y;z\n0.5;1;2\n0;1,5;2\n", ":3:", "1,5", "decimal point in line 2")

    def test_what_spreadsheets_add(self):
        two = [(0, 0, 0), (3, 4, 5)]
        for text in ("sep=;\nx;y;z\n0;0;0\n3;4;5\n", "sep=,\nx,y,z\n0,0,0\n3,4,5\n", "SEP=\t\nx\ty\tz\n0\t0\t0\n3\t4\t5\n", '"sep=;"\nx;y;z\n0;0;0\n3;4;5\n',
                     "x,y,z\n0,0,0,\n3,4,5,,\n", "x,y,z,\n0,0,0,\n3,4,5,\n", "x,y,z\n0,0,0\n,,\n3,4,5\n,,\n\n", ",,\nx,y,z\n0,0,0\n3,4,5\n", "x;y;z;;\n0;0;0;;\n3;4;5;;\n;;;;\n",
                     "x|y|z\n0|0|0\n3|4|5\n", '"x","y","z"\n"0","0","0"\n"3","4","5"\n', "x,y,z\n# a\n0,0,0\n  # b\n3,4,5\n# c\n", "// x,y,z\n0,0,0\n3,4,5\n",
                     "% x y z\n0 0 0\n3 4 5\n", "#a remark\n#x y z\n0 0 0\n3 4 5\n", "x,y,z\r0,0,0\r3,4,5", "x y z\n0   0\t0\n  3 4 5  \n"):
            self.places("a.csv", text, two)
        self.places("a.csv", "x,y,z\n0,0,0\n1,,2\n1,2,\nNA,1,2\n1,null,2\n1,2,#N/A\n#DIV/0!,2,3\n3,4,5\n", two, "6 points without a place left out")
        self.places("a.csv", "nan nan nan\n0 0 0\n3 4 5\n", two, "columns without names read as x, y, z, radius; 1 point without a place left out")

    def test_numbers_as_names(self):
        """pandas writes an array with its rows and columns numbered: read as points, the first coordinate would be the row."""
        for text in (",0,1,2\n0,1.5,2.5,3.5\n1,4.5,5.5,6.5\n", ";0;1;2;3\n0;1,5;2,5;3,5;1\n", ",0,1\n0,1,2\n", "\t0\t1\t2\n0\t1\t2\t3\n"):
            self.refuse("a.csv", text, "numbers as names of columns")
        # The first point has no place.
        self.assertEqual(self.of("a.csv", ",0,2\n1,2,3\n")["positions"], [[1, 2, 3]])
        self.assertEqual(self.of("a.csv", "0,1,2\n1.5,2.5,3.5\n")["positions"], [[0, 1, 2], [1.5, 2.5, 3.5]])

    def test_quotes(self):
        table = io.StringIO()
        rows = [["x", "y", "z", "type", "q"], [1, 2, 3, "a, b", 4], [5, 6, 7, 'say "hi", twice', 8], [9, 10, 11, "it's; #", 12]]
        for separator in ",;\t|":
            table = io.StringIO()
            csv.writer(table, delimiter=separator, quoting=csv.QUOTE_MINIMAL).writerows(rows)
            read = list(csv.reader(io.StringIO(table.getvalue()), delimiter=separator))
            found = self.of("a.csv", table.getvalue(), 0, "q")
            self.assertEqual(found["positions"], [[float(word) for word in row[:3]] for row in read[1:]], separator)
            self.assertEqual((found["types"], found["values"]), ([row[3] for row in read[1:]], [float(row[4]) for row in read[1:]]), separator)
        self.refuse("a.csv", 'x,y,z,type\n1,2,3,"a\nb"\n', ":2:", "quote")
        self.refuse("a.csv", "x,y,z\n1,2,3,4\n", ":2:", "found 4 fields, expected 3")
        self.refuse("a.csv", "x,y,z\n1,2\n", ":2:", "found 2 fields, expected 3")
        self.assertEqual(self.of("a.csv", "x,y,z,fixed\n1,2,3,True\n", 0, "fixed")["values"], [1])


class Ply(TableTest):
    def colour_file(self, kind, names, rows, form="ascii"):
        letters = {"uchar": "B", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d", "short": "h", "uint8": "B", "uint16": "H"}
        properties = "".join(f"property {kind} {name}\n" for name in names)
        head = (PLY % (len(rows), properties)).replace("ascii", form)
        if form == "ascii":
            return head + "".join(f"{i} 0 0 " + " ".join(map(str, row)) + "\n" for i, row in enumerate(rows))
        order = "<" if "little" in form else ">"
        return head.encode() + b"".join(struct.pack(f"{order}3f{len(names)}{letters[kind]}", i, 0, 0, *row) for i, row in enumerate(rows))

    def test_colours(self):
        byte, word, share = [(255, 128, 10), (0, 11, 3)], [(65535, 300, 0), (1, 40000, 2)], [(1, 0.5, 0.25), (0, 0.125, 0)]
        ones = [(1, 0, 0), (0, 1, 1)]
        for form in ("ascii", "binary_little_endian", "binary_big_endian"):
            for kind, rows, scale, note in [("uchar", byte, 255, ""), ("uint8", ones, 255, ""), ("ushort", word, 65535, WORDS), ("ushort", byte, 255, BYTES), ("int", byte, 255, BYTES),
                                            ("uint", word, 65535, WORDS), ("short", byte, 255, BYTES), ("int", ones, 1, SHARES), ("float", share, 1, ""), ("double", byte, 255, BYTES),
                                            ("float", word, 65535, WORDS)]:
                for names in (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("red", "green", "blue", "alpha")):
                    lines = [row + (7,) * (len(names) - 3) for row in rows]
                    light = [[n / scale if scale == 1 else linear(n / scale) for n in row] for row in rows]
                    found = self.colours("a.ply", self.colour_file(kind, names, lines, form), light, note)
                    self.assertEqual(found["notes"], note, (kind, form))

    def test_colours_that_are_none(self):
        rgb = ("red", "green", "blue")
        self.refuse("a.ply", self.colour_file("uchar", rgb, [(256, 0, 0)]), ":11:", "red: found 256", "0 to 255")
        self.refuse("a.ply", self.colour_file("float", rgb, [(0, 1.5, 0)]), ":11:", "green: found 1.5", "0 to 1")
        self.refuse("a.ply", self.colour_file("int", rgb, [(0, -1, 0)]), ":11:", "green: found -1")
        self.refuse("a.ply", self.colour_file("uchar", ("red", "green"), [(0, 1)]), "all three")

    def test_headers(self):
        plain = PLY % (2, "") + "1 2 3\n4 5 6\n"
        expected = [(1, 2, 3), (4, 5, 6)]
        head, rows = plain.split("end_header\n")
        for end in (" ", "\t", "  \t"):
            self.places("a.ply", head.replace("\n", end + "\n") + "end_header" + end + "\n" + rows.replace("\n", end + "\n"), expected)
        self.places("any.name", plain.replace("ply\n", "ply \n"), expected)
        self.places("a.ply", plain.replace("element", "comment a  b\nobj_info x\ncomment\nelement"), expected)
        self.places("a.ply", plain.replace("element", "element face 2\nproperty list uchar int vertex_indices\nelement").replace(
            "end_header\n", "end_header\n3 0 1 1\n4 0 0 1 1\n"), expected, "2 faces left out")
        self.places("a.ply", plain.replace("end_header\n", "property list uchar float more\nelement face 1\nproperty int a\nend_header\n")
                    .replace("1 2 3\n", "1 2 3 2 9 9\n").replace("4 5 6\n", "4 5 6 0\n7\n"), expected, "1 face left out")
        self.refuse("a.ply", plain.replace("1 2 3", "1 2 3 4"), ":8:", "more than 3 numbers")
        self.refuse("a.ply", plain.replace("1 2 3", "1 2"), ":8:", "expected a number for each")

    def test_names_and_sizes(self):
        for name, half in ("radius", 1), ("Radius", 1), ("RADIUS", 1), ("diameter", 0.5), ("Diameter", 0.5):
            found = self.of("a.ply", PLY % (2, f"property float {name}\n") + "1 2 3 0.5\n4 5 6 3\n")
            self.assertEqual(found["radii"], [half * 0.5, half * 3], name)
        found = self.of("a.ply", PLY % (1, "property float diameter\nproperty float radius\n") + "1 2 3 7 2\n")
        self.assertEqual(found["radii"], [2])
        capitals = (PLY % (1, "")).replace("float x", "float X").replace("float y", "float Y").replace("float z", "float Z")
        self.places("a.ply", capitals + "1 2 3\n", [(1, 2, 3)])
        self.places("a.ply", PLY % (1, "property float X\n") + "1 2 3 4\n", [(1, 2, 3)])
        self.refuse("a.ply", PLY % (1, "property float Radius\nproperty float RADIUS\n") + "1 2 3 4 5\n", "radius in two properties")

    def test_what_follows_the_points(self):
        """Points that the header does not count are lost, so they are no silence."""
        self.refuse("a.ply", PLY % (2, "") + "1 2 3\n4 5 6\n7 8 9\n", ":10:", "another line after the last element", "counts")
        packed = (PLY % (2, "")).replace("ascii", "binary_little_endian").encode() + struct.pack("<6f", 1, 2, 3, 4, 5, 6)
        self.places("a.ply", packed, [(1, 2, 3), (4, 5, 6)])
        self.refuse("a.ply", packed + struct.pack("<3f", 7, 8, 9), "12 bytes after the last element", "counts")
        faces = packed.replace(b"end_header", b"element face 1\nproperty list uchar int vertex_indices\nend_header")
        self.places("a.ply", faces + struct.pack("<B3i", 3, 0, 1, 1), [(1, 2, 3), (4, 5, 6)], "1 face left out")
        self.refuse("a.ply", faces + struct.pack("<B2i", 3, 0, 1), "truncated")
        self.places("a.ply", faces.replace(b"face 1", b"face 0"), [(1, 2, 3), (4, 5, 6)])

    def test_lists_in_binary_files(self):
        for order, form in ("<", "little"), (">", "big"):
            head = (f"ply\nformat binary_{form}_endian 1.0\nelement face 2\nproperty list uchar int i\nelement vertex 2\nproperty list ushort double l\n"
                    "property double z\nproperty short y\nproperty float x\nelement end 1\nproperty int k\nend_header\n").encode()
            body = struct.pack(order + "B3iB", 3, 0, 1, 1, 0) + struct.pack(order + "Hdhf", 0, 3, 2, 1) + struct.pack(order + "H2ddhf", 2, 8, 9, 6, 5, 4)
            self.places("a.ply", head + body + struct.pack(order + "i", 7), [(1, 2, 3), (4, 5, 6)], "2 faces left out")


class Independent(TableTest):
    """Value by value beside ASE and plyfile."""

    def ask(self, program, *arguments):
        result = subprocess.run([READERS_PYTHON, "-B", "-c", program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode == 77:
            self.skipTest(result.stdout.strip())
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_extended_xyz_beside_ase(self):
        program = """
import sys, json
try:
    import ase.io
except ImportError:
    print("ASE is not installed"); sys.exit(77)
frames = ase.io.read(sys.argv[1], index=":", format="extxyz")
print(json.dumps([[a.get_positions().tolist(), a.get_cell().tolist(), a.get_chemical_symbols()] for a in frames]))
"""
        edges = ("4.5 0.1 0 1 5 0 2 3 6", [[4.5, 0.1, 0], [1, 5, 0], [2, 3, 6]])
        comments = [f'Lattice="{edges[0]}" Properties=species:S:1:pos:R:3 pbc="T T F"', f"Lattice='{edges[0]}' pbc=[T, F, T] Properties=species:S:1:pos:R:3",
                    f"Properties=species:S:1:pos:R:3 Lattice={{{edges[0]}}} name=\"a \\\" b\"", f"note='x=1 \"' Lattice=[{edges[0].replace(' ', ', ')}]"]
        text = "".join(f"2\n{comment}\nFe {i}.25 -2 3e-1\nO 4 5.5 -6\n" for i, comment in enumerate(comments))
        path = os.path.join(self.folder, "a.xyz")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        for number, (positions, cell, symbols) in enumerate(self.ask(program, path)):
            found = self.of("a.xyz", text, number)
            self.near(sum(found["positions"], []), sum(positions, []), 1e-12)
            self.near(sum(found["cell"], []), sum(cell, []), 1e-12)
            self.assertEqual((found["types"], found["cell"]), (symbols, edges[1]))

    def test_what_ase_writes(self):
        program = """
import sys, json
try:
    import ase, ase.io, numpy
except ImportError:
    print("ASE is not installed"); sys.exit(77)
random = numpy.random.default_rng(5)
atoms = ase.Atoms(numbers=random.choice([1, 6, 26], 30), positions=random.uniform(-3, 30, (30, 3)), pbc=[True, False, True],
                  cell=[[20, 0, 0], [4, 21, 0], [-3, 5, 22]])
atoms.info.update(name="a name with blanks", table=numpy.eye(2), words=["a", "b c"], flag=True, quote='it"s')
atoms.new_array("charge", random.normal(size=30)); atoms.new_array("force", random.normal(size=(30, 3))); atoms.new_array("fixed", random.random(30) < 0.5)
ase.io.write(sys.argv[1], atoms, format="extxyz")
print(json.dumps([atoms.get_positions().tolist(), atoms.get_cell().tolist(), atoms.arrays["force"][:, 1].tolist()]))
"""
        path = os.path.join(self.folder, "w.xyz")
        positions, cell, force = self.ask(program, path)
        with open(path, "rb") as file:
            found = self.of("a.xyz", file.read(), 0, "force_y")
        self.near(sum(found["positions"], []), sum(positions, []), 1e-7)
        self.near(found["values"], force, 1e-6)
        self.near(sum(found["cell"], []), sum(cell, []), 1e-9)

    def test_ply_beside_plyfile(self):
        program = """
import sys, json
try:
    import numpy, plyfile
except ImportError:
    print("plyfile is not installed"); sys.exit(77)
random = numpy.random.default_rng(3)
kinds = [("x", "f8"), ("y", "f4"), ("z", "f4"), ("radius", "f4"), ("red", "u2"), ("green", "u2"), ("blue", "u2"), ("alpha", "u1"), ("q", "i2")]
points = numpy.zeros(40, dtype=kinds)
for name, kind in kinds:
    points[name] = random.uniform(0.1, 9, 40) if kind[0] == "f" else random.integers(0, 2 ** 15 if kind == "i2" else 2 ** 16 if kind == "u2" else 256, 40)
faces = numpy.array([([0, 1, 2],), ([3, 4, 5, 6],)], dtype=[("vertex_indices", "O")])
elements = [plyfile.PlyElement.describe(faces, "face"), plyfile.PlyElement.describe(points, "vertex")]
for number, (text, order) in enumerate([(True, "="), (False, "<"), (False, ">")]):
    plyfile.PlyData(elements[::1 if number else -1], text=text, byte_order=order, comments=["a"]).write(sys.argv[1] + str(number))
read = plyfile.PlyData.read(sys.argv[1] + "1")["vertex"]
print(json.dumps({name: read[name].tolist() for name, _ in kinds}))
"""
        base = os.path.join(self.folder, "p")
        theirs = self.ask(program, base)
        for number in "012":
            with open(base + number, "rb") as file:
                found = self.of("a.ply", file.read(), 0, "q")
            tolerance = 1e-5 if number == "0" else 1e-12  # their text has the digits of a float
            self.near(sum(found["positions"], []), [n for row in zip(theirs["x"], theirs["y"], theirs["z"]) for n in row], tolerance)
            self.near(found["radii"], theirs["radius"], 1e-5)
            self.near(found["values"], theirs["q"])
            self.near(sum(found["colors"], []), [linear(n / 65535) for row in zip(theirs["red"], theirs["green"], theirs["blue"]) for n in row], 1e-6)



class Moments(TableTest):
    """Tables with a column that numbers frames, as programs that track particles write them."""
    SEVERAL = "the first of several frames"

    def frames(self, content, expected):
        """`expected`: the places of each frame."""
        for number in [*range(len(expected)), -1]:
            found = self.of("a.csv", content, number)
            self.assertEqual(found["positions"], [list(map(float, place)) for place in expected[number]], (number, content))
            self.assertEqual(found["frames"], len(expected))
            self.assertEqual(found["notes"], self.SEVERAL if number == 0 else "")
        none = self.summary("a.csv", content, len(expected))
        self.assertEqual(none.returncode, 1)
        self.assertIn(f"found {len(expected)} frames", none.stderr)

    def whole(self, content, count, note):
        found = self.of("a.csv", content)
        self.assertEqual((found["count"], found["frames"], found["notes"]), (count, 1, note))

    def test_rows_of_one_moment_are_a_frame(self):
        places = [[(0, 0, 0), (1, 0, 0)], [(0, 2, 0)], [(0, 3, 0), (1, 3, 0), (2, 3, 1)]]
        for name, moments in (("frame", "012"), ("Frame", "347"), ("FRAME", ("-1", "0", "1")), ("time (ps)", ("0.0", "0.25", "1e3")),
                              ("timestep", ("100", "200", "1000")), ("frame_number", "123"), ("step", ("9", "10", "11"))):
            for separator in ",;\t ":
                if separator == " " in name:
                    continue
                rows = [separator.join(map(str, (*place[:2], moment, place[2]))) for moment, frame in zip(moments, places)
                        for place in frame]
                content = separator.join(("x", "y", name, "z")) + "\n" + "\n".join(rows)
                for end in ("", "\n", "\n\n"):
                    self.frames(content + end, places)
                self.frames(gzip.compress(content.encode()), places)
        self.frames("# frame x y z\n0 0 0 0\n0 1 0 0\n1 0 2 0\n", [places[0], places[1]])
        self.frames("time;x;y;z\n0,0;0;0;0\n0,0;1;0;0\n0,5;0;2;0\n", [places[0], places[1]])

    def test_many_rows(self):
        places = [[(i, frame, 0.5) for i in range(200 + frame)] for frame in range(7)]
        rows = "".join(f"{x},{y},{z},{frame}\n" for frame, one in enumerate(places) for x, y, z in one)
        self.frames("x,y,z,frame\n" + rows, places)

    def test_units_and_missing_moments(self):
        self.assertEqual(self.of("a.csv", "frame,x,y\n,nm,nm\n0,1,2\n0,2,2\n1,3,4\n")["positions"], [[1, 2, 0], [2, 2, 0]])
        self.assertEqual(self.of("a.csv", "frame,x,y\n0,1,2\n,2,2\n0,3,2\n1,3,4\n")["count"], 3)

    def test_what_makes_no_frames_is_drawn_whole_and_said(self):
        self.whole("particle,frame,x,y\n0,0,1,1\n0,1,1,2\n1,0,3,1\n1,1,3,2\n", 4,
                   'rows are not sorted by "frame": all are drawn at once')
        self.whole("time,x,y\n0,1,1\n1,1,2\n2,1,3\n", 3, 'each row has another "time": all are drawn at once')
        self.whole("frame,x,y\n5,1,1\n5,1,2\n", 2, "")
        self.whole("frame,x,y\n,1,1\na,1,2\n", 2, "")
        self.whole("frames,x,y\n0,1,1\n0,1,2\n1,0,0\n", 3, "")

    def test_a_wanted_column_is_a_value(self):
        found = self.of("a.csv", "frame,x,y\n0,1,1\n0,1,2\n1,0,0\n", 0, "frame")
        self.assertEqual((found["values"], found["notes"]), ([0, 0, 1], ""))

    def test_a_last_row_that_is_cut(self):
        found = self.of("a.csv", "x,y,frame\n0,1,1\n0,1,1\n1,0,2\n1,1", -1)
        self.assertEqual((found["frames"], found["count"]), (1, 2))
        self.refuse("a.csv", "x,y,frame\n0,1,1\n0,1,1\n1,0,2\n1,1\n0,0,3\n0,0,3\n", "a.csv:5")


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0]] + sys.argv[2:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
