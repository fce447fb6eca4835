"""LAMMPS's files: atom styles, sections, cells, masses and units of data files and dumps.

Run as: python3 test_lammps_files.py particle_summary [Written | Masses | Beside]
Beside compares with LAMMPS itself and MDAnalysis, where BALLPARK_READERS_PYTHON has them.
"""
import gzip
import json
import math
import os
import subprocess
import sys
import unittest

import test_particle_files as files

HEAD = "t\n\n2 atoms\n3 atom types\n0 10 xlo xhi\n0 11 ylo yhi\n0 12 zlo zhi\n\n"
PLACES = [[1.25, 2.25, 4.5], [3.125, 5.5, 6.5]]
# Two atoms of types 1 and 3, with charge -0.75, molecule 7 and diameter 0.875 where a style has them, as LAMMPS 22 Jul 2025
# wrote them in each style (write_data). By hand: wavepacket, which it was built without; template, with other types; the x0 of
# smd and the z of line, so that other columns than x, y and z would show.
WRITTEN = {
    "amoeba": ("1 7 1 -0.75 1.25 2.25 4.5 0 0 0", "2 7 3 -0.75 3.125 5.5 6.5 0 0 0"),
    "angle": ("1 7 1 1.25 2.25 4.5 0 0 0", "2 7 3 3.125 5.5 6.5 0 0 0"),
    "atomic": ("1 1 1.25 2.25 4.5 0 0 0", "2 3 3.125 5.5 6.5 0 0 0"),
    "body": ("1 1 0 0.8769256837412915 1.25 2.25 4.5 0 0 0", "2 3 0 0.8769256837412915 3.125 5.5 6.5 0 0 0"),
    "bond": ("1 7 1 1.25 2.25 4.5 0 0 0", "2 7 3 3.125 5.5 6.5 0 0 0"),
    "bpm/sphere": ("1 7 1 0.875 2.5 1.25 2.25 4.5 0 0 0", "2 7 3 0.875 2.5 3.125 5.5 6.5 0 0 0"),
    "charge": ("1 1 -0.75 1.25 2.25 4.5 0 0 0", "2 3 -0.75 3.125 5.5 6.5 0 0 0"),
    "dielectric": ("1 7 1 -0.75 1.25 2.25 4.5 0 0 1 1 0 1 1 0 0 0 0", "2 7 3 -0.75 3.125 5.5 6.5 0 0 1 1 0 1 1 0 0 0 0"),
    "dipole": ("1 1 -0.75 1.25 2.25 4.5 0 0 1 0 0 0", "2 3 -0.75 3.125 5.5 6.5 0 0 1 0 0 0"),
    "dpd": ("1 1 0 1.25 2.25 4.5 0 0 0", "2 3 0 3.125 5.5 6.5 0 0 0"),
    "edpd": ("1 1 1 100000 1.25 2.25 4.5 0 0 0", "2 3 1 100000 3.125 5.5 6.5 0 0 0"),
    "electron": ("1 1 -0.75 1 1 1.25 2.25 4.5 0 0 0", "2 3 -0.75 1 1 3.125 5.5 6.5 0 0 0"),
    "ellipsoid": ("1 1 0 2.5 1.25 2.25 4.5 0 0 0", "2 3 0 2.5 3.125 5.5 6.5 0 0 0"),
    "full": ("1 7 1 -0.75 1.25 2.25 4.5 0 0 0", "2 7 3 -0.75 3.125 5.5 6.5 0 0 0"),
    "line": ("1 7 1 0 2.5 1.25 2.25 4.5 0 0 0", "2 7 3 0 2.5 3.125 5.5 6.5 0 0 0"),
    "mdpd": ("1 1 0 1.25 2.25 4.5 0 0 0", "2 3 0 3.125 5.5 6.5 0 0 0"),
    "molecular": ("1 7 1 1.25 2.25 4.5 0 0 0", "2 7 3 3.125 5.5 6.5 0 0 0"),
    "peri": ("1 1 3.5 2.5 1.25 2.25 4.5 0 0 0", "2 3 3.5 2.5 3.125 5.5 6.5 0 0 0"),
    "rheo": ("1 1 0 1 1.25 2.25 4.5 0 0 0", "2 3 0 1 3.125 5.5 6.5 0 0 0"),
    "rheo/thermal": ("1 1 0 1 0 1.25 2.25 4.5 0 0 0", "2 3 0 1 0 3.125 5.5 6.5 0 0 0"),
    "smd": ("1 1 7 3.5 0.8769256837412915 0.4375 0.5 1 1 1 1.25 2.25 4.5 0 0 0",
            "2 3 7 3.5 0.8769256837412915 0.4375 0.5 1 1 1 3.125 5.5 6.5 0 0 0"),
    "sph": ("1 1 0 0 1 1.25 2.25 4.5 0 0 0", "2 3 0 0 1 3.125 5.5 6.5 0 0 0"),
    "sphere": ("1 1 0.875 2.5 1.25 2.25 4.5 0 0 0", "2 3 0.875 2.5 3.125 5.5 6.5 0 0 0"),
    "spin": ("1 1 1.25 2.25 4.5 0 0 1 2.2 0 0 0", "2 3 3.125 5.5 6.5 0 0 1 2.2 0 0 0"),
    "tdpd": ("1 1 1.25 2.25 4.5 0 0 0 0 0", "2 3 3.125 5.5 6.5 0 0 0 0 0"),
    "template": ("1 7 1 1 1 1.25 2.25 4.5 0 0 0", "2 7 1 2 3 3.125 5.5 6.5 0 0 0"),
    "tri": ("1 7 1 0 2.5 1.25 2.25 4.5 0 0 0", "2 7 3 0 2.5 3.125 5.5 6.5 0 0 0"),
    "wavepacket": ("1 1 -0.75 1 0.5 1 0.1 0.2 1.25 2.25 4.5 0 0 0", "2 3 -0.75 1 0.5 2 0.1 0.2 3.125 5.5 6.5 0 0 0"),
    "hybrid": ("1 1 1.25 2.25 4.5 -0.75 0.875 2.5 0 0 0", "2 3 3.125 5.5 6.5 -0.75 0.875 2.5 0 0 0"),
    "hybrid charge sphere": ("1 1 1.25 2.25 4.5 -0.75 0.875 2.5 0 0 0", "2 3 3.125 5.5 6.5 -0.75 0.875 2.5 0 0 0"),
    "hybrid dipole full": ("1 1 1.25 2.25 4.5 -0.75 0 0 1 7 0 0 0", "2 3 3.125 5.5 6.5 -0.75 0 0 1 7 0 0 0"),
}
CHARGED = {"amoeba", "charge", "dielectric", "dipole", "electron", "full", "wavepacket", "hybrid charge sphere",
           "hybrid dipole full"}
IN_MOLECULES = {"amoeba", "angle", "bond", "bpm/sphere", "dielectric", "full", "line", "molecular", "smd", "template", "tri",
                "hybrid dipole full"}
RADII = {"bpm/sphere": 0.4375, "electron": 1, "smd": 0.5, "sphere": 0.4375, "wavepacket": 0.5, "hybrid charge sphere": 0.4375}


def data(atoms, heading="Atoms", head=HEAD, before="", after=""):
    return head + before + f"{heading}\n\n" + "\n".join(atoms) + "\n" + after


# Also seeds of the fuzzing.
GENERAL_DUMP = ("ITEM: UNITS\nnano\nITEM: TIME\n0.5\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS abc origin pp pp pp\n"
                "0 4 0 -1\n-4 1 0 -2\n1 0 5 -3\nITEM: ATOMS id mass xs ys zs\n1 1.9944e-5 0 0 0\n2 1.9944e-5 0.5 0.25 0.5\n")
LABELLED = ("t, units = real\n\n2 atoms\n2 atom types\n1 bonds\n1 2 -3 xy xz yz\n-1 9 zlo zhi\n0 5 ylo yhi\n1 7 xlo xhi\n\n"
            "Atom Type Labels\n\n1 C\n2 CH3\n\nMasses\n\nC 12.011\nCH3 15.035\n\nPairIJ Coeffs # lj96/cut\n\nC CH3 1 2\n\n"
            "Atoms # hybrid charge bond\n\n7 C 1 2 3 -0.5 1\n9 CH3 4 5 6 0.5 1\n\nCMAP\n\n1 1\n\nBonds\n\n1 C-CH3 7 9\n\n"
            "Velocities\n\n9 0.5 -1.5 2\n7 4 5 6\n")
SHAPED = ("t\n\n3 atoms\n2 atom types\n2 ellipsoids\n4 0 0 avec\n1 4 0 bvec\n0 0 4 cvec\n-1 0 0 abc origin\n\nAtoms\n\n"
          "4 1 1 1.0 1 2 3\n5 1 0 1.0 1 1 1\n6 2 1 1.0 1 1 2 0 0 0\n\nEllipsoids\n\n6 1 2 4 1 0 0 0\n4 1 1 27 1 0 0 0\n")


class LammpsTest(files.FileTest):
    def values(self, name, content, column="", frame=0):
        return self.of(name, content, frame, column, "values")

    def notes(self, name, content):
        return self.of(name, content)["notes"]


class Written(LammpsTest):
    def check_style(self, style, heading, lines):
        found = {c: self.values("a.data", data(lines, heading), c) for c in ("q", "mol", "type")}
        s = found["q"]
        self.assertEqual((s["positions"], s["types"]), (PLACES, ["1", "3"]), heading)
        self.assertEqual(s["values"], [-0.75 if style in CHARGED else None] * 2, heading)
        self.assertEqual(found["mol"]["values"], [7 if style in IN_MOLECULES else None] * 2, heading)
        self.assertEqual(found["type"]["values"], [1, 3])
        self.assertEqual(s["radii"], [RADII[style]] * 2 if style in RADII else [], heading)
        self.assertEqual("hybrid without" in s["notes"], style == "hybrid")
        self.assertFalse("guess" in s["notes"] or "only one" in s["notes"])

    def test_styles_by_name(self):
        for style, lines in WRITTEN.items():
            short = [line.rsplit(" ", 3)[0] for line in lines]
            self.check_style(style, f"Atoms # {style}", lines)
            self.check_style(style, f"Atoms  #{style.upper()}  ", short)
            first, *rest = style.split()
            self.check_style(style, " ".join([f"Atoms # {first}/kk", *rest]), lines)
            self.check_style(style, f"Atoms # {style}: id type x y z" if not rest else f"Atoms # ({style})", lines)
        documented = "1 1 -0.75 1.25 2.25 4.5 0 0 1 1 0 1 1 0", "2 3 -0.75 3.125 5.5 6.5 0 0 1 1 0 1 1 0"
        self.assertEqual(self.values("a.data", data(documented, "Atoms # dielectric"), "q")["positions"], PLACES)
        # The manual has the columns of template in another order than LAMMPS writes; the header's types tell here.
        s = self.values("a.data", data(["1 1 7 1 4 1.25 2.25 4.5", "2 3 7 1 5 3.125 5.5 6.5"], "Atoms # template"), "mol")
        self.assertEqual((s["types"], s["values"], "template" in s["notes"]), (["1", "3"], [7, 7], False))

    def test_unknown_style(self):
        for name in ("fulll", "bpm", "spheres/kk"):
            self.refuse("a.data", data(WRITTEN["full"], f"Atoms # {name}"), f'"{name}"', ":9:",
                        "angle, atomic, body", "wavepacket or hybrid")
        self.assertIn("atom style full, the only one", self.notes("a.data", data(WRITTEN["full"], "Atoms # I like remarks")))

    def test_lines_that_are_none_of_the_style(self):
        for style, line, says in [("atomic", "1 1 0.5 1 2 3", "found 6 words, expected 5, or three more"),
                                  ("full", "1 0.5 1 0 1 2 3", '"0.5", expected a whole number: atom style full'),
                                  ("full", "1 1 4 0 1 2 3", '"4", expected a type from 1 to 3'),
                                  ("charge", "1 0 0.5 1 2 3", '"0", expected a type from 1 to 3'),
                                  ("charge", "1 1 x 1 2 3", '"x", expected a finite number'),
                                  ("atomic", "1 1 1 2 3 0.5 0 0", '"0.5", expected the whole number of a periodic image'),
                                  ("line", "1 1 1 2 1 1 2 3", '"2", expected 0 or 1'),
                                  ("tdpd", "1 1 1 2", "found 4 words, expected at least 5")]:
            self.refuse("a.data", data([line], f"Atoms # {style}").replace("2 atoms", "1 atoms"), ":11:", says)

    def test_guesses(self):
        """Only where one reading is left. Types go from 1 to 3 in these files, the box from 0 to 10, 11 and 12."""
        bonds = HEAD.replace("3 atom", "1 bonds\n3 atom")
        for style, lines, head in [
                ("atomic", ["1 1 1 2 3", "2 3 4 5 6"], HEAD),
                ("atomic", ["1 1 1.5 2 3 0 0 1", "2 3 4 5 6 0 -1 0"], HEAD),
                ("charge", ["1 1 0 1.5 2 3", "2 3 0 4 5 6"], HEAD),
                ("charge", ["1 1 1 1.5 2 3", "2 1 1 4 5 6", "3 2 -2 1 1 1"], HEAD.replace("2 atoms", "3 atoms")),
                ("charge", ["1 1 0.5 1.5 2 3 1 0 0", "2 3 -.5 4 5 6 0 0 0"], HEAD),
                ("molecular", ["1 4 1 1 2 3", "2 5 3 4 5 6"], HEAD),
                ("molecular", ["1 0 1 1 2 3 0 0 0", "2 0 3 4 5 6 1 0 0"], HEAD),
                ("molecular", ["1 1 1 1 2 3", "2 1 3 4 5 6"], bonds),
                ("full", ["1 1 1 0.0 1 2 3", "2 1 3 0.0 4 5 6"], HEAD),
                ("full", ["1 1 1 0.5 1 2 3", "2 1 3 -0.5 4 5 6"], HEAD),
                ("full", ["1 1 1 0.5 1 2 3 0 0 0", "2 1 3 0.5 4 5 6 0 0 0"], bonds),
                ("sphere", ["1 1 1.0 2.5 1 2 3", "2 3 0.5 2.5 4 5 6"], HEAD),
                ("ellipsoid", ["1 1 1 2.5 1 2 3", "2 3 0 2.5 4 5 6"], HEAD.replace("3 atom", "1 ellipsoids\n3 atom"))]:
            text = data(lines, head=head)
            self.assertIn(f"atom style {style}, the only one that the lines fit", self.notes("a.data", text), lines)
            named = self.values("a.data", data(lines, f"Atoms # {style}", head=head), "q")
            guessed = self.values("a.data.gz", gzip.compress(text.encode()), "q")
            self.assertEqual({k: v for k, v in guessed.items() if k != "notes"}, {k: v for k, v in named.items() if k != "notes"})

    def test_no_guess(self):
        one = HEAD.replace("2 atoms", "1 atoms")
        for lines, head, says in [
                (["1 1 1 1.5 2 3", "2 2 1 4 5 6"], HEAD, "may be of style charge or molecular"),
                (["1 1 1 0.5 1 2 3", "2 2 1 0.5 4 5 6"], HEAD, "may be of style full or sphere"),
                (["1 1 1.5 2 3 0 0 1 2", "2 1 2.5 2.5 3 0 0 1 2"], HEAD, "charge or spin"),
                (["1 1 0.0 1 1.5 3 2 1"], one, "atomic or electron"),
                (["1 1 1.0 0 0.25 0.5 0.25 0.125", "2 2 1.0 0 0.25 0.75 0.25 0.125"], HEAD, "style electron"),
                (["1 1 1000 0 1 1 2 3", "2 2 1000 0 1 2 3 3"], HEAD, "style electron"),
                (["1 1 0.5 1 2 3 0 0 1.5"], one, "none of atomic, charge"),
                (["1 1 1 2 3 0 0 1 2.2"], one, "style spin"),
                (["1 1 1 2 3 0 0 1 2 0 0 0"], one, "style spin"),
                (["1 4 0.5 1 2 3"], one, "none of"),
                (["1 1 C 0.5 1 2 3"], one, "none of")]:
            self.refuse("a.data", data(lines, head=head), ":9:", says, "Atoms # ")

    def test_labels(self):
        labels = "Atom Type Labels\n\n1 C\n2 O\n3 Atoms2\n\n"
        masses = "Masses\n\nC 12.011 # carbon\nO 15.9994\nAtoms2 1.008\n\n"
        for before in (labels + masses, labels + "Masses\n\n1 12.011\n2 15.9994\n3 1.008\n\n", masses):
            for heading in ("Atoms # full", "Atoms"):
                if heading == "Atoms" and not before.startswith("Atom"):
                    continue  # no label is known then
                s = self.values("a.data", data(["1 1 C -.1 1 2 3", "2 1 Atoms2 .1 4 5 6"], heading, before=before), "type")
                self.assertEqual((s["symbols"], s["types"], s["angstrom"]), (["C", "H"], ["C", "Atoms2"], 1))
                self.assertEqual(s["values"], [1, 3] if before.startswith("Atom") else [None, None])
        s = self.values("a.data", data(["1 1 1 -.1 1 2 3", "2 1 3 .1 4 5 6"], "Atoms # full", before=labels + masses))
        self.assertEqual((s["symbols"], s["types"]), (["C", "H"], ["C", "Atoms2"]))
        after = "\nBonds\n\n1 C-H 1 2\n"
        s = self.values("a.data", data(["1 1 C -.1 1 2 3", "2 1 O .1 4 5 6"], "Atoms # full", HEAD.replace("3 atom", "1 bonds\n3 atom"),
                                       labels, after))
        self.assertEqual((s["pairs"], s["notes"]), ([[0, 1]], ""))

    def test_wrong_masses(self):
        for line, says in (("2 1.1.7", '"1.1.7"'), ("2 x", '"x"'), ("2 1 1", '"2"'), ("2", '"2"')):
            self.refuse("a.data", data(WRITTEN["atomic"], "Atoms # atomic", before=f"Masses\n\n1 1\n{line}\n\n"),
                        f"found {says}, expected a type and its mass")

    def test_sections(self):
        own = ["Pair Coeffs # lj/class2/coul/long", "PairIJ Coeffs # lj96/cut", "Bond Coeffs", "BondBond13 Coeffs",
               "AngleAngleTorsion Coeffs  # class2", "Bond Type Labels", "Improper Type Labels", "Lines", "Triangles", "Bodies",
               "Dihedrals"]
        atoms = ["1 1 1 2 3", "2 3 4 5 6"]
        masses = "Masses\n\n1 12.011\n2 1.008\n3 15.999\n\n"
        plain = self.values("a.data", data(atoms, "Atoms # atomic", before=masses))
        self.assertEqual(plain["symbols"], ["C", "O"])
        for name in own + ["CMAP", "d_rho2", "i_flag # property/atom", "My Own2 Values"]:
            section = f"{name}\n\n1 1 0.5\n2 2 0.5 # x\n\n"
            labelled = f"{name}\n\nC-C 0.5 1\nC-O 1 2\n\n"
            note = f"section {name.split(' #')[0]} passed over"
            for text in (data(atoms, "Atoms # atomic", before=masses + section),
                         data(atoms, "Atoms # atomic", before=masses + labelled),
                         data(atoms, "Atoms # atomic", before=section + masses),
                         data(atoms, "Atoms # atomic", before=masses, after="\n" + section),
                         data(atoms, "Atoms # atomic", after="\n" + section + masses)):
                s = self.values("a.data", text)
                self.assertEqual(note in s["notes"], name not in own, (name, s["notes"]))
                self.assertEqual({**s, "notes": ""}, {**plain, "notes": ""}, text)
        # Where the header does not count the types, the shape of the lines tells.
        text = data(atoms, "Atoms # atomic", HEAD.replace("3 atom types\n", ""), masses + "CMAP\n\n1 1 1 1 1 1\n\n")
        self.assertEqual(self.values("a.data", text)["symbols"], ["C", "O"])

    def test_any_name(self):
        """The header tells the format where the name does not; the name counts where it does."""
        for name in ("system", "system.in.real", "Data.x", "system.lammps", "system.gz"):
            for text in (data(WRITTEN["full"], "Atoms # full"), data(WRITTEN["full"], "Atoms # full").replace("xlo xhi", "xlo\t xhi")):
                self.assertEqual(self.values(name, gzip.compress(text.encode()) if name == "system.gz" else text)["positions"], PLACES)
        self.refuse("a.xyz", data(WRITTEN["full"], "Atoms # full"), "expected the number of atoms")

    def test_numbers_of_atoms(self):
        head = HEAD.replace("3 atom", "1 bonds\n3 atom")
        self.refuse("a.data", data(["5 1 1 1 2 3", "5 1 1 2 2 3"], "Atoms # bond", head, after="\nBonds\n\n1 1 5 5\n"), "two atoms with the number 5")
        self.refuse("a.data", data(["5 1 1 1 2 3", "6 1 1 2 2 3"], "Atoms # bond", head, after="\nBonds\n\n1 1 5 6\n2 1 6 5\n"),
                    "found 2 lines of bonds, expected 1")
        self.refuse("a.data", data(["1 1 1 2 3"], "Atoms # atomic", HEAD.replace("2 atoms\n", "")), "their number in the header")

    def test_velocities(self):
        after = "\nVelocities\n\n9 0.5 -1.5 2 1 1 1\n7 4 5 6 0 0 0\n"
        for c, expected in (("vx", [4, 0.5]), ("vy", [5, -1.5]), ("vz", [6, 2])):
            self.assertEqual(self.values("a.data", data(["7 1 1 2 3", "9 1 4 5 6"], "Atoms # atomic", after=after), c)["values"], expected)
        self.assertEqual(self.values("a.data", data(["7 1 1 2 3", "9 1 4 5 6"], "Atoms # atomic"), "vx")["values"], [None, None])

    def test_labels_and_parts_of_hybrid(self):
        s = self.values("a.data", LABELLED, "q")
        self.assertEqual((s["positions"], s["types"], s["symbols"]), ([[1, 2, 3], [4, 5, 6]], ["C", "CH3"], ["C", "C"]))
        self.assertEqual((s["values"], s["pairs"], s["cell"]), ([-0.5, 0.5], [[0, 1]], [[6, 0, 0], [1, 5, 0], [2, -3, 10]]))
        self.assertEqual(s["notes"], "section CMAP passed over; elements from masses (CH, CH2, CH3 and CH4 as carbon)")

    def test_shapes(self):
        s = self.values("a.data", SHAPED.replace("Atoms", "Atoms # ellipsoid"))
        self.assertEqual((s["notes"], s["radii"][1]), ("", None))
        self.assertEqual(s["bodies"], [[1, 0.5, 0.5, 13.5, 1, 0, 0, 0], [0] * 8, [1, 0.5, 1, 2, 1, 0, 0, 0]])
        powers = SHAPED.replace("Atoms", "Atoms # ellipsoid").replace("4 1 1 27 1 0 0 0", "4 1 1 27 1 0 0 0 2 %s")
        for power, notes in ((2, ""), (4, "1 superellipsoid taken for an ellipsoid")):
            self.assertEqual(self.values("a.data", powers % power)["notes"], notes)
        for radius, axes in ((s["radii"][0], (0.5, 0.5, 13.5)), (s["radii"][2], (0.5, 1, 2))):
            self.assertAlmostEqual(4 / 3 * math.pi * radius ** 3, 4 / 3 * math.pi * math.prod(axes), 4)
        for kind, style, atom, section in [("1 lines", "line", "1 1 1 1 1 1 2 3", "Lines\n\n1 1 0 2 0"),
                                           ("1 triangles", "tri", "1 1 1 1 1 1 2 3", "Triangles\n\n1 0 0 0 1 0 0 0 1 0"),
                                           ("1 bodies", "body", "1 1 1 1 1 2 3", "Bodies\n\n1 1 6\n2\n1 1 4 0 0 0")]:
            text = data([atom], f"Atoms # {style}", HEAD.replace("2 atoms\n", f"1 atoms\n{kind}\n"), after=f"\n{section}\n")
            one = {"lines": "line", "triangles": "triangle", "bodies": "body"}[kind[2:]]
            self.assertEqual(self.values("a.data", text)["notes"], f"1 {one} drawn as a sphere")

    def test_cells(self):
        atoms = ["1 1 0 0 0", "2 3 1 1 1"]
        for box, origin, cell in [
                ("1 4 0 bvec\n4 0 0 avec\n-0.5 0.25 4 cvec\n-1 -2 -3 abc origin", [-1, -2, -3], [[4, 0, 0], [1, 4, 0], [-0.5, 0.25, 4]]),
                ("0 3 0 avec\n-3 0 0 bvec", [0, 0, 0], [[0, 3, 0], [-3, 0, 0], [0, 0, 1]]),
                ("1 2 -3 xy xz yz\n-1 9 zlo zhi\n0 5 ylo yhi\n1 7 xlo xhi", [1, 0, -1], [[6, 0, 0], [1, 5, 0], [2, -3, 10]]),
                ("0 5 ylo yhi\n1 7 xlo xhi", [1, 0, -0.5], [[6, 0, 0], [0, 5, 0], [0, 0, 1]])]:
            s = self.values("a.data", data(atoms, "Atoms # atomic", f"t\n\n2 atoms\n3 atom types\n{box}\n\n"))
            self.assertEqual((s["origin"], s["cell"]), (origin, cell))
        self.assertNotIn("cell", self.values("a.data", data(atoms, "Atoms # atomic", "t\n\n2 atoms\n3 atom types\n\n")))
        self.refuse("a.data", data(atoms, "Atoms # atomic", HEAD + "1 x 0 avec\n"), '"x"')
        s = self.values("a.dump", GENERAL_DUMP)
        self.assertEqual((s["origin"], s["cell"]), ([-1, -2, -3], [[0, 4, 0], [-4, 1, 0], [1, 0, 5]]))
        self.assertEqual(s["positions"], [[-1, -2, -3], [-1 - 1 + 0.5, -2 + 2 + 0.25, -3 + 2.5]])


class Masses(LammpsTest):
    def element(self, mass, head="t"):
        text = data(["1 1 1 2 3", "2 1 2 2 3"], "Atoms # atomic", HEAD.replace("t\n", head + "\n", 1), f"Masses\n\n1 {mass}\n\n")
        s = self.values("a.data", text)
        dump = (f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id mass x y z\n"
                f"1 {mass} 0 0 0\n")
        if head == "t":
            self.assertEqual(self.values("a.dump", dump)["symbols"][0], s["symbols"][0], mass)
            self.assertEqual("as carbon" in self.notes("a.dump", dump), "as carbon" in s["notes"])
        return s["symbols"][0] + ("*" if "as carbon" in s["notes"] else "")

    def test_as_force_fields_write_them(self):
        for symbol, masses in {
                "H": "1.008 1.00784 1.00797 1.0079 1.00794 1.01 2.014 2.0141 1.00e0", "He": "4.0026 4.003 4.0",
                "Li": "6.94 6.941", "C": "12.011 12.01 12.0107 12.0 12.01115 12", "N": "14.007 14.0067 14.01 14.0 14.003",
                "O": "15.9994 15.999 16.0 15.99491 16", "F": "18.998 18.9984 19.0", "Na": "22.99 22.98977 22.9898 23",
                "Mg": "24.305 24.3", "Al": "26.9815 26.98 27.0", "Si": "28.085 28.0855 28.086 28.09 28.1",
                "P": "30.9738 30.974 31.0", "S": "32.06 32.064 32.065 32.066 32.1", "Cl": "35.45 35.453 35.4527 35.5",
                "Ar": "39.948 39.95", "K": "39.0983 39.098 39.1", "Ca": "40.078 40.08 40.1", "Ti": "47.867 47.88 47.9",
                "Fe": "55.845 55.847 55.85", "Co": "58.9332 58.933", "Ni": "58.6934 58.69 58.71 58.7", "Cu": "63.546 63.55",
                "Zn": "65.38 65.39 65.409", "Ge": "72.63 72.64 72.61", "Br": "79.904 79.9", "Mo": "95.94 95.95", "Ag": "107.868 107.87",
                "I": "126.904 126.9", "Pt": "195.084 195.078 195.09", "Au": "196.967 196.97 197", "Hg": "200.59", "Pb": "207.2",
                "U": "238.03 238.029"}.items():
            for mass in masses.split():
                if mass != "1.00e0":
                    self.assertEqual(self.element(mass), symbol, mass)

    def test_of_groups_and_beads(self):
        """United atoms are carbons; no other mass of a group is an element's, nor is 1."""
        for mass in ("13.019 13.0187 13.02 14.027 14.0266 14.02 14.03 15.035 15.0345 15.03 16.043 16.04".split()):
            self.assertEqual(self.element(mass), "C*", mass)
        for mass in ("1 1.0 1.00 0.4 2 3.024 10 16.023 17.007 17.03 18.015 20 28.01 28.0134 28.054 30.07 31.998 32.042 44.01 45 54 56 "
                     "60 72 100 144 1e-5 0").split():
            self.assertEqual(self.element(mass), "", mass)

    def test_every_element(self):
        """The table's masses, and those with two and three decimals, give the element itself, or one of as much mass."""
        with open(os.path.join(os.path.dirname(files.HERE), "..", "host", "particles", "elements.c"), encoding="utf-8") as file:
            text = file.read()
        found = [line.split('"')[1:] for line in text.replace("}, ", "},\n").split("\n") if line.strip().startswith('{"')]
        table = {symbol: float(rest.split(",")[1].rstrip("f")) for symbol, rest in found if symbol}
        self.assertEqual(len(table), 118)
        for symbol, mass in list(table.items())[:103]:
            for shown in (f"{mass:.2f}", f"{mass:.3f}"):
                other = self.element(shown)
                self.assertLess(abs(table[other] - float(shown)), abs(mass - float(shown)) + 1e-4 if other != symbol else 1, symbol)

    def test_all_or_none(self):
        masses = "Masses\n\n1 12.011\n2 72\n3 15.999\n\n"
        s = self.values("a.data", data(["1 1 1 2 3", "2 3 4 5 6"], "Atoms # atomic", before=masses))
        self.assertEqual((s["symbols"], s["notes"]), (["C", "O"], "elements from masses"))  # type 2 has no atom
        s = self.values("a.data", data(["1 1 1 2 3", "2 2 4 5 6"], "Atoms # atomic", before=masses))
        self.assertEqual((s["symbols"], s["angstrom"]), (["", ""], 0))
        self.assertEqual(s["notes"], "no elements, since the masses of 1 of 2 types are those of none")
        dump = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS id mass x y z\n"
                "1 12.011 0 0 0\n2 72 0 0 1\n")
        s = self.values("a.dump", dump)
        self.assertEqual((s["symbols"], s["angstrom"]), (["", ""], 0))
        self.assertEqual(s["notes"], "no elements, since the masses of 1 of 2 atoms are those of none")

    def test_units(self):
        """Lengths and masses: 12.011 daltons and an angstrom in each unit style's units (LAMMPS manual, units)."""
        kg, bohr = 12.011 * 1.66053906660e-27, 0.529177210903e-10
        for units, mass, angstrom in [("real", 12.011, 1), ("metal", 12.011, 1), ("si", kg, 1e-10), ("cgs", kg * 1e3, 1e-8),
                                      ("electron", 12.011, 1e-10 / bohr), ("micro", kg * 1e15, 1e-4), ("nano", kg * 1e21, 0.1),
                                      ("lj", 12.011, 0)]:
            title = f"LAMMPS data file via write_data, version 22 Jul 2025, timestep = 0, units = {units}"
            self.assertEqual(self.element(repr(mass), title), "" if units == "lj" else "C", units)
            text = data(["1 1 1 2 3", "2 1 2 2 3"], "Atoms # atomic", HEAD.replace("t\n", title + "\n", 1))
            self.assertAlmostEqual(self.values("a.data", text)["angstrom"] / (angstrom or 1), angstrom > 0, 5)
            frame = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
                     "ITEM: ATOMS id %s x y z\n1 %s 0 0 0\n")
            for columns in (("mass", repr(mass)), ("element", "C"), ("type", "1")):
                one = frame % columns
                dump = f"ITEM: UNITS\n{units}\nITEM: TIME\n0.5\n{one}ITEM: TIME\n1.5\n{one}{one}"
                for number in (0, 1, 2, -1):  # the units are named once
                    s = self.values("a.dump", dump, frame=number)
                    self.assertAlmostEqual(s["angstrom"] / (angstrom or 1), angstrom > 0, 5, (units, columns, number))
                    expected = "" if columns[0] == "type" or (columns[0] == "mass" and units == "lj") else "C"
                    self.assertEqual((s["symbols"], s["frames"]), ([expected], 3), (units, columns))
        self.refuse("a.dump", "ITEM: UNITS\nfeet\n" + files.DUMP, ":2:", '"feet"', "lj, real, metal")

    def test_columns_of_dumps(self):
        head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: ATOMS "
        s = self.values("a.dump", head + "diameter c_pe[1] z y x typelabel id\n0.5 -1.25 3 2 1 Fe2 2\n1 2.5 6 5 4 O 1\n", "c_pe[1]")
        self.assertEqual((s["positions"], s["types"]), ([[1, 2, 3], [4, 5, 6]], ["Fe2", "O"]))
        self.assertEqual((s["values"], s["radii"]), ([-1.25, 2.5], [0.25, 0.5]))


class Beside(LammpsTest):
    """Values, atom by atom, beside programs that share nothing with ours."""

    def ask(self, *arguments):
        result = subprocess.run([files.READERS_PYTHON, "-B", os.path.join(files.HERE, "lammps_beside.py"), *map(str, arguments)],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode == 77:
            self.skipTest(f"{arguments[0]} is not installed for {files.READERS_PYTHON}")
        self.assertEqual(result.returncode, 0, result.stderr[-2000:])
        return json.loads(result.stdout)

    def same(self, ours, theirs, what, tolerance=1e-5, scale=1):
        self.assertEqual(len(ours), len(theirs), what)
        for a, b in zip(ours, theirs):
            if isinstance(a, list):
                self.same(a, b, what, tolerance, scale)
            elif isinstance(a, str) or a is None:
                self.assertEqual(a, b, what)
            else:
                self.assertLessEqual(abs(a - b), tolerance * max(scale, abs(b)), (what, ours, theirs))

    def test_lammps(self):
        """LAMMPS writes data files and dumps in every style that it was built with, and says what is in them."""
        written = self.ask("lammps", self.folder)
        self.assertGreater(len(written), 25)
        for name, truth in written.items():
            for column, member in (("q", "charges"), ("mol", "molecules"), ("vx", "velocities")):
                if column == "mol" and name.endswith("dump"):
                    continue
                s = self.summary(os.path.join(self.folder, name), truth.get("frame", 0), column, "values")
                scale = truth.get("angstrom", [1])[0]
                self.same(s["positions"], truth["positions"], (name, "positions"), scale=scale)
                self.assertEqual(s["types"], truth["types"], name)
                if member in truth:
                    self.same(s["values"], truth[member], (name, column), scale=1e-12 if column == "vx" else 1)
            for member in ("radii", "cell", "origin", "symbols", "angstrom"):
                if member in truth:
                    ours = s[member] if member != "angstrom" else [s[member]]
                    self.same(ours, truth[member], (name, member), scale=scale)
            if "pairs" in truth:
                self.assertEqual(sorted(map(sorted, s["pairs"])), sorted(map(sorted, truth["pairs"])))

    def test_readers(self):
        """The files of MDAnalysis's own tests."""
        truths = self.ask("mdanalysis")
        self.assertGreater(len(truths), 10)
        for path, truth in truths.items():
            for frame, theirs in truth.items():
                s = self.summary(path, frame, "", "values")
                first = s["positions"][0]
                s["ways"] = [[place[c] - first[c] for c in range(3)] for place in s["positions"]]
                s["pairs"] = sorted(map(sorted, s["pairs"]))
                for member in ("positions", "ways", "types", "pairs"):
                    if member in theirs:
                        self.same(s[member], theirs[member], (path, frame, member), 1e-4)
                for column, values in theirs["columns"].items():
                    self.same(self.summary(path, frame, column, "values")["values"], values, (path, frame, column), 1e-4)


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0]] + sys.argv[2:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
