"""PDB and PQR files as programs write them: cells in frames of their own, alternative places, elements, numbers that do not fit,
radii; values by hand, by closed forms, and beside gemmi and MDAnalysis. See listed.py."""
import glob
import itertools
import math
import os
import random

import listed
from listed import ALTERNATIVE, DUMMY, GUESSED, HETERO


def atom(serial=1, name=" CA ", letter=" ", residue="ALA", chain="A", number=1, code=" ", place=(0, 0, 0), occupancy=1.0, symbol="",
         segment="", record="ATOM", charge=""):
    """A line of an atom, in the columns of version 3.3."""
    x, y, z = place
    return (f"{record:<6s}{serial:>5} {name:4s}{letter}{residue:>3s} {chain}{number:>4}{code}   {x:8.3f}{y:8.3f}{z:8.3f}{occupancy:6.2f}"
            f"{10:6.2f}      {segment:<4s}{symbol:>2s}{charge}").rstrip() + "\n"


def standard(lengths, angles):
    """The edges of a cell with a along x and b in the plane of x and y (crystallography's convention)."""
    (a, b, c), (alpha, beta, gamma) = lengths, [math.radians(x) for x in angles]
    y = (math.cos(alpha) - math.cos(beta) * math.cos(gamma)) / math.sin(gamma)
    return [[a, 0, 0], [b * math.cos(gamma), b * math.sin(gamma), 0],
            [c * math.cos(beta), c * y, c * math.sqrt(1 - math.cos(beta) ** 2 - y * y)]]


def rotation(seed):
    """A rotation from a random quaternion."""
    r = random.Random(seed)
    w, x, y, z = q = [r.gauss(0, 1) for _ in range(4)]
    s = 2 / sum(v * v for v in q)
    return [[1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)]]


def apply(matrix, v):
    return [sum(m * x for m, x in zip(row, v)) for row in matrix]


def solve(matrix, right):
    """Cramer's rule."""
    def det(m):
        return sum(m[0][i] * (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]) for i in range(3))
    return [det([[right[r] if c == k else matrix[r][c] for c in range(3)] for r in range(3)]) / det(matrix) for k in range(3)]


def inverse(matrix):
    columns = [solve(matrix, [float(i == k) for i in range(3)]) for k in range(3)]
    return [[columns[c][r] for c in range(3)] for r in range(3)]


def shares_of(edges, origin):
    """Rows of the transformation from places to shares of the cell, each with its share at the place 0."""
    rows = inverse([[edges[c][r] for c in range(3)] for r in range(3)])
    return [row + [-sum(m * o for m, o in zip(row, origin))] for row in rows]


def cryst(lengths, angles):
    return "CRYST1" + "".join(f"{x:9.3f}" for x in lengths) + "".join(f"{x:7.2f}" for x in angles) + " P 1           1\n"


def scale(rows, which=(1, 2, 3)):
    return "".join(f"SCALE{i + 1}    " + "".join(f"{x:10.6f}" for x in row[:3]) + f"     {row[3]:10.5f}\n"
                   for i, row in enumerate(rows) if i + 1 in which)


CELLS = [((20, 20, 20), (90, 90, 90)), ((60.38, 106.07, 80.62), (90, 103.5, 90)), ((40, 50, 60), (90, 90, 120)),
         ((54.1, 61.7, 43.3), (81.3, 97.2, 108.9)), ((512.7, 340.2, 877.4), (90, 95.3, 90))]
TURNS = [[[0, 1, 0], [0, 0, 1], [1, 0, 0]], rotation(1), rotation(2), [[1, 0, 0], [0, -1, 0], [0, 0, -1]]]


class Crystals(listed.ListTest):
    """The cell lies as SCALE says, if that is a transformation of it at all."""

    def check(self, head, edges, origin=(0, 0, 0)):
        longest = max(math.hypot(*e) for e in edges)
        self.assertTrue(head["repeats"])
        # Six decimals turn an edge by 1e-6 of the longest.
        self.near(head["cell"][:3], edges, 2e-3 + 3e-6 * longest * longest)
        self.near([math.hypot(*e) for e in head["cell"][:3]], [math.hypot(*e) for e in edges], 1e-6)
        self.near(head["cell"][3], origin, 2e-3 + 2e-5 * longest)

    def test_turned_cells(self):
        for (lengths, angles), turn in itertools.product(CELLS, TURNS):
            for origin in ([0, 0, 0], [3.5, -7.25, 11]):
                edges = [apply(turn, e) for e in standard(lengths, angles)]
                records = [cryst(lengths, angles), scale(shares_of(edges, origin))]
                for order in (1, -1):  # either may come first
                    found = self.of("a.pdb", "".join(records[::order]) + atom() + "END\n")
                    self.check(found.head, edges, origin)
                    self.assertNotIn("SCALE", found.head["notes"])

    def test_mirrored_cell(self):
        lengths, angles = CELLS[3]
        edges = [[-e[0], e[1], e[2]] for e in standard(lengths, angles)]
        self.check(self.of("a.pdb", cryst(lengths, angles) + scale(shares_of(edges, [0, 0, 0])) + atom()).head, edges)

    def test_standard_cells_keep_their_digits(self):
        for lengths, angles in CELLS:
            edges = standard(lengths, angles)
            rows = shares_of(edges, [0, 0, 0])
            plain = self.of("a.pdb", cryst(lengths, angles) + atom()).head
            for which in ((1, 2, 3), (2,), (1, 3)):
                self.assertEqual(self.of("a.pdb", cryst(lengths, angles) + scale(rows, which) + atom()).head, plain)
            self.near(plain["cell"][:3], edges, 1e-9)

    def test_what_tells_nothing(self):
        """Rows that contradict the cell, placeholders and lone rows: the cell repeats nowhere, and a note says so."""
        lengths, angles = CELLS[1]
        turned = shares_of([apply(rotation(3), e) for e in standard(lengths, angles)], [0, 0, 0])
        longer = shares_of([[1.05 * x for x in e] for e in standard(lengths, angles)], [0, 0, 0])
        identity = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
        for lines in (scale(identity), scale(longer), scale([[0] * 4] * 3), scale(turned, (1, 2)), scale(turned, (3,)),
                      scale([turned[0]] * 3), scale([[0.5] * 4] * 3)):
            head = self.of("a.pdb", cryst(lengths, angles) + lines + atom()).head
            self.assertFalse(head["repeats"], lines)
            self.assertIn("SCALE contradicts the cell, so molecules are not made whole", head["notes"])
        # Without a cell, or with a placeholder of one, there is nothing to turn.
        for first in ("", cryst((1, 1, 1), (90, 90, 90))):
            head = self.of("a.pdb", first + scale(identity) + atom()).head
            self.assertEqual(("cell" in head, head["notes"]), (False, "elements from atom names"))
        # Rows that are no numbers are none.
        for words in ("SCALE1" + 4 * " ********* " + "\n", "SCALE\nSCALE4      0.1       0.1       0.1\n"):
            self.assertTrue(self.of("a.pdb", cryst(lengths, angles) + words + atom()).head["repeats"])

    def test_models(self):
        """Said once, for all models; a new cell does not lie as the one before."""
        lengths, angles = CELLS[2]
        edges = [apply(rotation(4), e) for e in standard(lengths, angles)]
        models = [f"MODEL {i}\n" + atom(place=(i, 0, 0)) + "ENDMDL\n" for i in range(3)]
        head = cryst(lengths, angles) + scale(shares_of(edges, [0, 0, 0]))
        path = self.write("a.pdb", head + "".join(models))
        for i in (0, 1, 2, -1):
            self.check(self.list(path, i).head, edges)
        other = ((70, 80, 90), (90, 100, 90))
        path = self.write("b.pdb", head + models[0] + cryst(*other) + models[1] + head + models[2])
        for i, expected in enumerate((edges, standard(*other), edges)):
            self.check(self.list(path, i).head, expected)

    def test_cells_behind_their_models(self):
        models = [f"MODEL {i}\n" + atom(place=(i, 0, 0)) + "ENDMDL\n" for i in range(3)]
        cells = [cryst((70 + i, 80, 90), (90, 90, 90)) for i in range(3)]
        behind = self.write("a.pdb", "".join(m + c for m, c in zip(models, cells)) + "CONECT    1    1\nEND\n")
        before = self.write("b.pdb", "".join(c + m for m, c in zip(models, cells)) + "CONECT    1    1\nEND\n")
        for i in (0, 1, 2, -1, -3):
            for path in (behind, before):
                found = self.list(path, i)
                self.assertEqual((found.head["cell"][0], found.atoms[0].x, found.head["left_out"]), ([70 + i % 3, 0, 0], i % 3, 1))


class Alternatives(listed.ListTest):
    """Of each atom one place, of a residue one conformer."""

    def chosen(self, *atoms):
        """Which of the atoms, each (name, letter, more), are shown, by their numbers in the file; the same in PDB and mmCIF."""
        lines = [dict({"name": f" {a[0]:<3s}", "letter": a[1]}, **(a[2] if len(a) > 2 else {})) for a in atoms]
        found = self.of("a.pdb", "".join(atom(serial=i, place=(i, 0, 0), **line) for i, line in enumerate(lines)))
        result = [round(p[0]) for p in found.places(shown=True)]
        names = "id type_symbol auth_atom_id label_alt_id auth_comp_id auth_asym_id auth_seq_id pdbx_PDB_ins_code Cartn_x Cartn_y Cartn_z"
        rows = [f"{i} C {line['name'].strip()} {line['letter'].strip() or '.'} {line.get('residue', 'ALA')} {line.get('chain', 'A')} "
                f"{line.get('number', 1)} {line.get('code', '?')} {i} 0 0" for i, line in enumerate(lines)]
        if not any("segment" in line for line in lines):
            cif = "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in names.split()) + "\n".join(rows) + "\n"
            self.assertEqual([round(p[0]) for p in self.of("a.cif", cif).places(shown=True)], result)
        return result

    def test_letters(self):
        self.assertEqual(self.chosen(("N", " "), ("CA", "A"), ("CA", "B"), ("C", " ")), [0, 1, 3])
        self.assertEqual(self.chosen(("N", " "), ("CA", "B"), ("CA", "A"), ("C", " ")), [0, 2, 3])
        self.assertEqual(self.chosen(("CA", "B"), ("CB", "B"), ("CA", "C"), ("CB", "C")), [0, 1])
        self.assertEqual(self.chosen(("CA", "2"), ("CA", "1"), ("CB", "1"), ("CB", "3")), [0, 2])  # CB has no place 2
        self.assertEqual(self.chosen(("CA", "B")), [0])
        self.assertEqual(self.chosen(("CA", "B"), ("CB", "C"), ("CG", "A")), [0, 1, 2])

    def test_beside_an_atom_without_a_place(self):
        """It is left out, and takes no place from another."""
        lines = [atom(serial=i, place=(i, 0, 0), name=f" {name:<3s}", letter=letter)
                 for i, (name, letter) in enumerate([("N", " "), ("CA", "A"), ("CA", "B"), ("CB", "B"), ("CB", "A")])]
        found = self.of("a.pdb", lines[0].replace("   0.000   0.000   0.000", "     nan   0.000   0.000") + "".join(lines[1:]))
        self.assertEqual([round(p[0]) for p in found.places(shown=True)], [1, 4])
        rows = [f"C {name} {letter} ALA A 1 {x} 0 0" for name, letter, x in
                [("N", ".", "?"), ("CA", "A", 1), ("CA", "B", 2), ("CB", "B", 3), ("CB", "A", 4)]]
        names = "type_symbol auth_atom_id label_alt_id auth_comp_id auth_asym_id auth_seq_id Cartn_x Cartn_y Cartn_z"
        for unknown in ("?", "nan"):
            cif = "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in names.split()) + "\n".join(rows).replace("?", unknown) + "\n"
            self.assertEqual([round(p[0]) for p in self.of("a.cif", cif).places(shown=True)], [1, 4])

    def test_each_residue_has_its_own(self):
        def of(number, *letters, **more):
            return [("CA", letter, dict(number=number, **more)) for letter in letters]
        self.assertEqual(self.chosen(*of(1, "A", "B"), *of(2, "B", "C"), *of(3, "C", "A"), *of(4, " ")), [0, 2, 5, 6])
        self.assertEqual(self.chosen(*of(1, "A", chain="A"), *of(1, "B", chain="B")), [0, 1])
        self.assertEqual(self.chosen(*of(52, "A", code="A"), *of(52, "B", code="B"), *of(52, "B")), [0, 1, 2])
        self.assertEqual(self.chosen(*of(1, "A", chain=" ", segment="SEG1"), *of(1, "B", chain=" ", segment="SEG2")), [0, 1])
        self.assertEqual(self.chosen(*of(1, "A", chain="A", segment="S1"), *of(1, "B", chain="A", segment="S2")), [0, 1])

    def test_places_apart(self):
        """All of A and then all of B, of a residue or of a chain."""
        names = ("CA", "CB", "CG")
        self.assertEqual(self.chosen(*[(n, "A") for n in names], *[(n, "B") for n in names]), [0, 1, 2])
        self.assertEqual(self.chosen(*[(n, x, {"number": i}) for x in "AB" for i in (1, 2, 3) for n in names]), list(range(9)))

    def test_blank_counts_for_all(self):
        self.assertEqual(self.chosen(("CA", " "), ("CA", "B")), [0])
        self.assertEqual(self.chosen(("CA", "B"), ("CA", " ")), [1])
        self.assertEqual(self.chosen(("C", " "), ("C", " "), ("O", "B"), ("O", "C")), [0, 1, 2])  # names that repeat

    def test_residues_without_a_number(self):
        """As water has it in mmCIF files without the author's numbers: none takes another's places, and none is lost."""
        def found(*atoms):
            lines = [atom(i, f" {name:<3s}", letter, residue, number="    ", place=(i, 0, 0)) for i, (name, letter, residue) in enumerate(atoms)]
            shown = [p[0] for p in self.of("a.pdb", "".join(lines)).places(shown=True)]
            names = "type_symbol label_atom_id label_alt_id label_comp_id label_asym_id label_seq_id Cartn_x Cartn_y Cartn_z"
            rows = [f"C {name} {letter.strip() or '.'} {residue} B . {i} 0 0" for i, (name, letter, residue) in enumerate(atoms)]
            cif = "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in names.split()) + "\n".join(rows) + "\n"
            self.assertEqual([p[0] for p in self.of("a.cif", cif).places(shown=True)], shown)
            return shown

        def water(letters, names="O"):
            return [(name, letter, "HOH") for letter in letters for name in names]
        self.assertEqual(found(*water("  AB")), [0, 1, 2])
        self.assertEqual(found(*water("AB  ABBC")), [0, 2, 3, 4, 6])
        self.assertEqual(found(*water("ABAB A", "OHD")), [0, 1, 2, 6, 7, 8, 12, 13, 14, 15, 16, 17])
        self.assertEqual(found(("N", " ", "GLY"), ("CA", "A", "GLY"), ("CA", "B", "GLY"), ("N", " ", "GLY"), ("CA", "B", "GLY"), ("CA", "C", "GLY")), [0, 1, 3, 4])
        self.assertEqual(found(("O", "A", "HOH"), ("O", "B", "HOH"), ("O", "B", "DOD"), ("O", "C", "DOD")), [0, 2])

    def test_records_in_small_letters(self):
        """As gemmi reads them: no atom is lost, and the cell and frames are found."""
        plain = "CRYST1   20.000   30.000   40.000  90.00  90.00  90.00 P 1\nMODEL        1\n" + atom(1) + atom(2, record="HETATM", place=(4, 5, 6)) + "ENDMDL\n"
        plain += plain[plain.index("MODEL"):] + "CONECT    1    2\nEND\n"
        def everything(text):
            found = self.of("a.pdb", text)
            return found.head, found.atoms
        whole = self.of("a.pdb", plain)
        self.assertEqual((len(whole.atoms), whole.head["frames"], whole.head["bonds"], whole.head["cell"][1]), (2, 2, [[0, 1]], [0, 30, 0]))
        for record in ("ATOM", "HETATM", "CRYST1", "MODEL", "ENDMDL", "CONECT", "END\n"):
            for case in (str.lower, str.capitalize):
                self.assertEqual(everything(plain.replace(record, case(record))), (whole.head, whole.atoms), record)
        turned = plain.replace("MODEL", "SCALE1      0.000000 -0.033333  0.000000        0.00000\nSCALE2      0.050000  0.000000  0.000000        0.00000\n"
                               "SCALE3      0.000000  0.000000  0.025000        0.00000\nMODEL", 1)
        self.assertEqual(everything(turned.replace("SCALE", "scale")), everything(turned))

    def test_residues_that_share_a_number(self):
        """Of residues that are alternatives of each other one is shown; others merely have the same number."""
        pro, ser = {"residue": "PRO"}, {"residue": "SER"}
        self.assertEqual(self.chosen(("CA", "A", pro), ("CG", "A", pro), ("CA", "B", ser), ("OG", "B", ser)), [0, 1])
        self.assertEqual(self.chosen(("CA", "B", ser), ("OG", "B", ser), ("CA", "A", pro), ("CG", "A", pro)), [2, 3])
        self.assertEqual(self.chosen(("CA", "C", ser), ("OG", "C", ser), ("CA", "B", pro), ("CG", "B", pro)), [0, 1])
        self.assertEqual(self.chosen(("CG", "A", pro), ("CG", "C", pro), ("OG", "B", ser)), [0])
        water = {"residue": "HOH"}
        self.assertEqual(self.chosen(("O", "A"), ("O", "B"), ("O", "A", water), ("O", "B", water)), [0, 2])
        self.assertEqual(self.chosen(("O", " "), ("O", " ", water)), [0, 1])

    def test_deuterium(self):
        """It stands where hydrogen does, under a name of its own (neutron diffraction): one atom, at one place."""
        for names in ("D", "H"), ("DA", "HA"), ("DE2", "HE2"), ("1D", "1H"):
            for first, second in names, names[::-1]:
                lines = [atom(i, f" {name:<3s}", letter, place=(i, 0, 0), symbol=f" {symbol}")
                         for i, (name, letter, symbol) in enumerate([("N", " ", "N"), (first, "A", first.strip("1")[0]), (second, "B", second.strip("1")[0])])]
                self.assertEqual([p[0] for p in self.of("a.pdb", "".join(lines)).places(shown=True)], [0, 1], (first, second))
                rows = "".join(f"{line[77]} {line[12:16]} {line[16].strip() or '.'} {i} 0 0\n" for i, line in enumerate(lines))
                names_of_rows = ("type_symbol", "label_atom_id", "label_alt_id", "Cartn_x", "Cartn_y", "Cartn_z")
                cif = "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in names_of_rows) + rows
                self.assertEqual([p[0] for p in self.of("a.cif", cif).places(shown=True)], [0, 1], (first, second))

    def test_at_random(self):
        """Beside a slow search through the rule's words: each atom of each residue at one place, by the residue's letter if it can."""
        r = random.Random(5)
        for _ in range(60):
            atoms = [(n, x, {"number": i, "chain": c}) for c in "AB" for i in (1, 2) for n in ("N", "CA", "CB") for x in " ABC"
                     if r.random() < 0.5]
            r.shuffle(atoms)
            if not atoms:
                continue
            expected = []
            for i, (name, letter, more) in enumerate(atoms):
                residue = [a for a in atoms if a[2] == more]
                letters = [a[1] for a in residue if a[1] != " "]
                mine = [a[1] for a in residue if a[0] == name]
                wanted = " " if " " in mine else "A" if "A" in letters else letters[0]
                if " " not in mine and wanted not in mine:
                    wanted = mine[0]
                if letter in (" ", wanted):
                    expected.append(i)
            self.assertEqual(self.chosen(*atoms), expected, atoms)

    def test_atoms_without_a_place(self):
        """They are left out, and change neither what is shown of the others nor the bonds of these."""
        lines = [atom(i, name, letter, place=(i, 0, 0)) for i, (name, letter) in enumerate([(" N  ", " "), (" CA ", "A"), (" CA ", "B"), (" C  ", " ")])]
        for gone in range(4):
            text = "".join(line if i != gone else line.replace(f"{i:8.3f}   0.000", "     nan   0.000", 1) for i, line in enumerate(lines))
            found = self.of("a.pdb", text + "CONECT    0    3\n")
            shown = [i for i in range(4) if i != gone and (i != 2 or gone == 1)]
            self.assertEqual([p[0] for p in found.places(shown=True)], shown)
            self.assertIn("1 point without a place left out", found.head["notes"])
            self.assertEqual(found.head["bonds"], [[0, 2]] if gone in (1, 2) else [])
            cif = "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in ("label_atom_id", "label_alt_id", "Cartn_x", "Cartn_y", "Cartn_z"))
            for unknown in ("?", ".", "nan"):
                rows = [f"{line[12:16]} {line[16].strip() or '.'} {unknown if i == gone else i} 0 0\n" for i, line in enumerate(lines)]
                self.assertEqual([p[0] for p in self.of("a.cif", cif + "".join(rows)).places(shown=True)], shown, unknown)

    def test_many_places(self):
        """A file in which all atoms share a site, or each has one of its own, takes no longer than others."""
        for number in (lambda i: 1, lambda i: i % 9999):
            lines = "".join(atom(i % 99999, f" C{i % 97:<2d}", "ABCDEFGH"[i % 8], number=number(i)) for i in range(60000))
            self.assertEqual(len(self.of("a.pdb", lines).atoms), 60000)

    def test_frames(self):
        """Letters of one model say nothing about the next."""
        one, other = atom(letter="B"), atom(letter="A") + atom(letter="B")
        path = self.write("a.pdb", "".join(f"MODEL\n{m}ENDMDL\n" for m in (other, one, other)))
        self.assertEqual([len(self.list(path, i).places(shown=True)) for i in (0, 1, 2)], [1, 1, 1])


class Atoms(listed.ListTest):
    def element(self, **more):
        found = self.of("a.pdb", atom(**more)).atoms[0]
        return found.element, bool(found.flags & GUESSED)

    def test_elements(self):
        for symbol, charge, expected in [(" C", "", "C"), ("C ", "", "C"), ("CA", "", "Ca"), ("Ca", "", "Ca"), ("ca", "", "Ca"), (" d", "", "H"),
                                         ("FE", "2+", "Fe"), (" N", "1+", "N"), ("N1", "+", "N"), ("O1", "-", "O"), ("ZN", "+2", "Zn")]:
            self.assertEqual(self.element(symbol=symbol, charge=charge, residue="LIG"), (expected, False), (symbol, charge))
        # Without one, names tell: those of two letters begin one column further left.
        for name, residue, expected in [(" CA ", "LIG", "C"), ("CA  ", "LIG", "Ca"), ("CA  ", " CA", "Ca"), ("CA  ", "ALA", "C"), ("HO5'", "LIG", "H"),
                                        (" FE ", "HEM", "Fe"), (" ZN ", "LIG", "Zn"), (" CL1", "LIG", "C"), (" CA ", "ION", "Ca"), ("CAL ", "CAL", "Ca"), (" CAL", "CAL", "Ca"),
                                        ("CES ", "CES", "Cs"), ("RUB ", "RUB", "Rb"), ("LIT ", "LIT", "Li"), ("BAR ", "BAR", "Ba"), ("POT ", "POT", "K"),
                                        ("CLA ", "CLA", "Cl"), ("SOD ", "SOD", "Na"), (" CAL", "LIG", "C")]:
            self.assertEqual(self.element(name=name, residue=residue), (expected, True))
        self.assertEqual(self.element(symbol=" X", name=" UNK", residue="UNX"), ("", False))  # the file says: unknown
        # Names of sites of models are those of atoms as well, where the file says so: the manganese of photosystem II.
        for name, symbol, residue, expected in [("MN1 ", "MN", "OEX", ("Mn", 0)), ("MN1 ", "  ", "OEX", ("", DUMMY)), (" MW ", "  ", "SOL", ("", DUMMY)),
                                                (" DU ", " C", "LIG", ("C", 0)), (" LP1", " X", "LIG", ("", DUMMY)), (" M  ", " M", "HOH", ("", DUMMY)),
                                                # Symbols of OpenMM, ParmEd and MDTraj for points without a nucleus; by its name the first is deuterium.
                                                (" D1 ", "EP", "HOH", ("", DUMMY)), ("DCA ", "EP", "ALA", ("", DUMMY)), (" O1 ", "VS", "HOH", ("", DUMMY)),
                                                (" L1 ", "LP", "LIG", ("", DUMMY)), (" C1 ", "Du", "LIG", ("", DUMMY)), (" D1 ", " D", "HOH", ("H", 0))]:
            found = self.of("a.pdb", atom(name=name, symbol=symbol, residue=residue)).atoms[0]
            self.assertEqual((found.element, found.flags), expected, (name, symbol))
        # PDBQT has its types in columns 78 and 79.
        self.assertEqual(self.element(symbol=" H", charge="D", name=" HN ", residue="LIG"), ("H", True))
        self.assertEqual(self.element(symbol=" C", charge="l", name="CL1 ", residue="LIG"), ("Cl", True))

    def test_names_at_the_left(self):
        """Where a name of one letter is at the left end, columns do not tell carbon from calcium."""
        names = ["N   ", "CA  ", "CD  ", "HO  ", "CL1 ", "NB  "]
        found = self.of("a.pdb", "".join(atom(i, name, residue="LIG", place=(i, 0, 0)) for i, name in enumerate(names)))
        self.assertEqual(found.of("element"), ["N", "C", "C", "H", "Cl", "N"])

    def test_residue_numbers(self):
        """Hybrid-36, by its published table; five digits, which take the column of the insertion code; stars."""
        for text, expected in [("   1", 1), ("-999", -999), ("9999", 9999), ("A000", 10000), ("A001", 10001), ("ZZZZ", 1223055), ("a000", 1223056),
                               ("zzzz", 2436111), ("****", None), ("A-00", None)]:
            self.assertEqual(self.of("a.pdb", atom(number=text), 0, "residue_number").atoms[0].first, expected, text)
        self.assertEqual(self.of("a.pdb", atom(number=1234, code="5"), 0, "residue_number").atoms[0].first, 12345)
        self.assertEqual(self.of("a.pdb", atom(number=1234, code="B"), 0, "residue_number").atoms[0].first, 1234)

    def test_numbers_that_do_not_fit(self):
        """Six digits in front of the name, from column 6 on, or moving what follows; five and six of a residue."""
        place = (-11.104, 106.134, -6.504)
        good = atom(12345, " CA ", "B", number=1234, place=place, symbol=" C")
        moved = [good.replace("ATOM  12345", "ATOM  112345"), good.replace("ATOM  12345", "ATOM  1123456"), good.replace("ATOM  12345", "ATOM 112345"),
                 good.replace("ATOM  12345", "HETATM112345"), good.replace("1234  ", "12345  "), good.replace("A1234 ", "A12345")]
        for line in moved:
            a = self.of("a.pdb", line, 0, "residue_number", "bfactor").atoms[0]
            self.assertEqual((a[:3], a.element, a.flags, a.name, a.residue, a.chain, a.second),
                             (place, "C", HETERO if line[0] == "H" else 0, "CA", "ALA", "A", 10), line)
            self.assertEqual(a.first, 12345 if "A12345" in line else 1234, line)

    def test_coordinates_that_do_not_fit(self):
        """The first may begin further left, or move all that follows; fewer decimals are not that."""
        line = atom(1, place=(0, 0, 0), symbol=" C")
        head, tail = line[:30], line[54:]
        for text, place in [("10000.0020000.0030000.00", (1e4, 2e4, 3e4)), ("-1000.1231000.4562000.789", (-1000.123, 1000.456, 2000.789)),
                            ("-1000.123   1.456  -2.789", (-1000.123, 1.456, -2.789))]:
            for end, occupancy in (tail, 1), ("\n", None):
                a = self.of("a.pdb", head + text + end, 0, "occupancy").atoms[0]
                self.assertEqual((a[:3], a.first), (place, occupancy), (text, end))
        for text, x in ("-1000.123", -1000.123), ("12345.678", 12345.678), ("-12345.678", -12345.678):
            a = self.of("a.pdb", line[:38 - len(text)] + text + line[38:], 0, "occupancy").atoms[0]
            self.assertEqual((a[:3], a.first), ((x, 0, 0), 1), text)

    def test_chains_of_two_letters(self):
        """They take the column of a residue's fourth letter; a residue that is known by three tells which it is."""
        def chains(*rows):
            found = self.of("a.pdb", "".join(atom(i, residue=residue, chain=chain, place=(i, 0, 0)).replace(f"{residue:>3s} {chain}", f"{residue:>3s}{chain:>2s}")
                                             for i, (residue, chain) in enumerate(rows)))
            return [(a.residue, a.chain) for a in found.atoms]
        for rows in [("ALA", "AA"), ("ATP", "AA"), ("HOH", "b1")], [("ALA", "A"), ("GLY", "BA"), ("ATP", "C"), ("ATP", "CA")], [("DA", "AB")]:
            self.assertEqual(chains(*rows), rows)
        for rows in [("TIP", "3W"), ("POP", "CM"), ("HIS", "AB"), ("LYS", "HA")], [("ATP", "AA")]:
            self.assertEqual(chains(*rows), [(residue + chain[0], chain[1]) for residue, chain in rows])
        self.assertEqual(chains(("TIP", "3 "), ("ALA", " A")), [("TIP3", ""), ("ALA", "A")])

    def test_bonds_by_value(self):
        """Numbers of atoms with letters, six digits and leading zeros; lists in columns of five and more, and in words."""
        def found(serials, connections):
            text = "".join(atom(s, place=(2.0 * i, 0, 0), record="HETATM" if len(str(s)) < 6 else "ATOM") for i, s in enumerate(serials))
            text = text.replace("ATOM  1", "ATOM 1") if any(len(str(s)) == 6 for s in serials) else text
            head = self.of("a.pdb", text + connections + "END\n").head
            return sorted(map(tuple, head["bonds"])), head["left_out"]
        small, letters, wide = [1, 12, 123, 12345, 12346], ["99999", "A0000", "A0001", "186a0"], [99998, 99999, 100000, 100001, 123456]
        for serials, lines, bonds, left_out in [
                (small, "CONECT    1   12  12312345\n", [(0, 1), (0, 2), (0, 3)], 0),
                (small, "CONECT12345123461234612345\n", [(3, 4), (3, 4)], 1),
                (small, "CONECT     1    12   123\n", [(0, 1), (0, 2)], 0),            # six columns
                (small, "CONECT 12345     1\n", [(3, 0)], 0),
                (small, "CONECT      1 12345\n", [(0, 3)], 0),                         # seven
                (small, "CONECT 1 12 123\n", [(0, 1), (0, 2)], 0),                     # words
                (small, "CONECT1    12   123\n", [(0, 1), (0, 2)], 0),                 # at the left
                (small, "CONECT 12345100000100001\n", [], 1),                          # six columns: who is meant is not here
                (small, "CONECT 12345123456123457123458123459\n", [], 1),
                (letters, "CONECT99999A0000A0001186a0\n", [(0, 1), (0, 2), (0, 3)], 0),
                (letters, "CONECTA0000 A0001\n", [(1, 2)], 0),
                (wide, "CONECT 99999100000100001\n", [(1, 2), (1, 3)], 0),
                (wide, "CONECT100000100001 99998123456 99999\n", [(2, 0), (2, 1), (2, 3), (2, 4)], 0),
                (wide, "CONECT 99998 99999\n", [(0, 1)], 0),
                (wide, "CONECT99998 99999\n", [(0, 1)], 0),
                (wide, "CONECT9999899999\n", [], 1),                                   # five columns beside six: either
                (wide, "CONECT99999100000\n", [], 1),
                (wide, "CONECT 99999 123456 100000\n", [(1, 2), (1, 4)], 0),
                (["*****", "1", "2"], "CONECT*****    1\nCONECT    1    2*****\n", [(1, 2)], 2),
                ([1, 2, 1], "CONECT    1    2\n", [], 1)]:                             # a number that two atoms have
            self.assertEqual(found(serials, lines), (bonds, left_out), lines)


PQR = ("REMARK   1 PQR file generated by PDB2PQR (Version 3.6)\n"
       "ATOM      1  N   ALA     1      11.104   6.134  -6.504 -0.4157 1.8240\n"
       "ATOM      2  CA  ALA     1      11.639   6.071  -5.147  0.0337 1.9080\nTER\nEND\n")


class Pqr(listed.ListTest):
    def one(self, line, name="a.pqr"):
        found = self.of(name, line + "\n", 0, "charge", "residue_number")
        a = found.atoms[0]
        self.assertEqual(found.head["format"], "PQR")
        self.near([a.radius], [self.of(name, line + "\n", 0, "radius").atoms[0].first])
        return a[:3], a.element, a.name, a.residue, a.chain, a.radius, a.first, a.second

    def test_lines(self):
        """The forms in which programs write the same atom."""
        expected = ((1.5, -2.25, 3.125), "C", "CA", "ALA", "A", 1.75, -0.5, 52)
        for line in ("ATOM      1  CA  ALA A  52       1.500  -2.250   3.125 -0.5000 1.7500",
                     "ATOM 1 CA ALA A 52 1.5 -2.25 3.125 -0.5 1.75",
                     "ATOM\t1\tCA\tALA\tA\t52\t1.5\t-2.25\t3.125\t-0.5\t1.75  ",
                     "HETATM10000 CA  ALA A  52       1.500  -2.250   3.125 -0.5000 1.7500",
                     "ATOM  123456 CA  ALA A  52       1.500  -2.250   3.125 -0.5000 1.7500",
                     "ATOM      1  CA  ALA A52B     1.500  -2.250   3.125 -0.5000 1.7500",
                     "ATOM      1  CA  ALA A  52B      1.500  -2.250   3.125 -5.0e-1 +1.75E0",
                     "ATOM      1  CA  ALA A  52       1.500  -2.250   3.125-0.50000 1.7500  C",
                     "ATOM      1  CA  ALA A  52       1.500  -2.250   3.125 -0.5000 1.7500 C"):
            self.assertEqual(self.one(line), expected, line)
        self.assertEqual(self.one("ATOM 1 CA ALA 52 1.5 -2.25 3.125 -0.5 1.75")[4], "")
        self.assertEqual(self.one("ATOM 1 CA ALA 1 52 1.5 -2.25 3.125 -0.5 1.75")[4::3], ("1", 52))

    def test_numbers_that_touch(self):
        self.assertEqual(self.one("ATOM      1  CA  ALA A1234    -100.500-200.250-300.125-10.5000 1.7500")[0], (-100.5, -200.25, -300.125))
        self.assertEqual(self.one("ATOM      1  CA  ALA A1234    1000.5002000.2503000.125  0.5000 1.7500")[0], (1000.5, 2000.25, 3000.125))
        self.assertEqual(self.one("ATOM      1  CA  ALA A12345-100.500-200.250-300.125-10.5000 1.7500")[7], 12345)

    def test_formats(self):
        """PQR by its ending, and under any name by its first lines; else such a line is PDB's."""
        for name in ("a.pqr", "a.PQR", "a.pdb", "a"):
            found = self.of(name, PQR, 0, "charge")
            self.assertEqual(found.head["format"], "PQR")
            self.near(found.of("radius"), [1.824, 1.908])
            self.near(found.of("first"), [-0.4157, 0.0337])
        self.assertEqual(self.of("a.pdb", PQR[PQR.index("ATOM"):]).head["format"], "PDB")

    def test_frames_and_bonds(self):
        models = "".join(f"MODEL {i}\nATOM 7 N ALA 1 {i} 2 3 0.5 1.5\nATOM 1234567 C ALA 1 {i} 3 3 0.5 1.5\nENDMDL\n" for i in range(3))
        path = self.write("a.pqr", models + "CONECT 7 1234567\nEND\n")
        for i in range(3):
            found = self.list(path, i)
            self.assertEqual((found.head["frames"], found.atoms[0].x, found.head["bonds"]), (3, i, [[0, 1]]))

    def test_atoms_without_a_place(self):
        atoms = PQR[PQR.index("ATOM"):PQR.index("TER")]
        lines = atoms.replace("  -6.504", "     nan") + atoms.replace("11.639", "******").replace("ATOM ", "atom ")
        found = self.of("a.pqr", lines, 0, "charge")
        self.assertEqual([(a.name, a.first) for a in found.atoms], [("CA", 0.0337), ("N", -0.4157)])
        self.assertIn("2 points without a place left out", found.head["notes"])

    def test_wrong_lines(self):
        good = "ATOM      1  CA  ALA A  52       1.500  -2.250   3.125 -0.5000 1.7500"
        for line, found in [(good.replace("-0.5000 1.7500", ""), "A"), (good.replace(" 1.7500", "-1.7500"), "-1.7500"),
                            (good.replace("1.7500", "1.75x"), "1.75x"), ("ATOM", "ATOM"),
                            (good.replace("CA  ALA", "CA  ALA B C"), "ATOM"), ("ATOM 1 CA 1 2 3 4 5", "ATOM"), (good + 300 * " 1", "ATOM")]:
            self.refuse("a.pqr", good + "\n" + line + "\n", ":2: found \"", found, "expected")


class Independent(listed.ListTest):
    def test_real_files(self):
        """Each atom of each real file: place, name, residue, element where columns 77 and 78 have one, and whether it is shown."""
        compared = 0
        for path in sorted(glob.glob(os.path.join(self.real_files(), "**/*.pdb.gz"), recursive=True)
                           + glob.glob(os.path.join(self.real_files(), "*.pdb"))
                           + glob.glob(os.path.join(self.real_files(), "mmcif", "*.cif*"))):
            name = os.path.basename(path)
            with open(path, "rb") as file:
                packed = file.read(2) == b"\x1f\x8b"
            # What gemmi refuses, or takes for gzip; and parts of chains under one number, which are no alternatives.
            if packed != name.endswith(".gz") or name in ("incomplete.pdb", "varying_occ_tmp.pdb") or "align" in path.split(os.sep):
                continue
            theirs, ours = self.ask("gemmi", path), self.list(path, 0, "occupancy", "residue_number")
            def ordered(atoms):
                return sorted(atoms, key=lambda a: (*(round(x, 3) for x in a[:3]), a[4]))
            self.assertEqual(ours.head["frames"], theirs["frames"], path)
            one = ordered([(*a[:3], a.element, a.name, a.residue, a.first, a.second, not a.flags & ALTERNATIVE, a.flags) for a in ours.atoms])
            other = ordered([tuple(a) for a in theirs["atoms"]])
            self.near([a[:3] for a in one], [a[:3] for a in other], 1e-6)
            repeats = any(not b[8] for b in other) and all(a[8] for a in one)  # names that repeat, which gemmi thins out
            for a, b in zip(one, other):
                if len(a[5]) < 4 and len(b[5]) == 3:
                    self.assertEqual(a[4:6], b[4:6], path)
                if not a[9] & GUESSED and b[3]:
                    self.assertEqual(a[3], b[3], (path, a, b))
                if not repeats:
                    self.assertEqual(a[8], b[8], (path, a, b))
            if "cell" in ours.head and theirs["frames"] == 1 and theirs["cell"][0][0] > 1:
                self.near(ours.head["cell"], theirs["cell"], 0.02)
            compared += 1
        self.assertGreater(compared, 40)

    def test_real_pqr_files(self):
        compared = 0
        for path in sorted(glob.glob(os.path.join(self.real_files(), "*.pqr"))):
            theirs, ours = self.ask("mdanalysis", path), self.list(path, 0, "charge", "residue_number")
            self.near(ours.places(), theirs["positions"], 1e-4)
            self.near(ours.of("first"), theirs["charges"], 1e-6)
            self.near(ours.of("radius"), theirs["radii"], 1e-6)
            self.assertEqual((ours.of("name"), ours.of("residue"), ours.of("second")), (theirs["names"], theirs["residues"], theirs["numbers"]))
            compared += 1
        self.assertGreater(compared, 1)

    def test_turned_cells(self):
        for (lengths, angles), turn in itertools.product(CELLS[:4], TURNS[:3]):
            edges = [apply(turn, e) for e in standard(lengths, angles)]
            path = self.write("a.pdb", cryst(lengths, angles) + scale(shares_of(edges, [4, 5, 6])) + atom())
            self.near(self.list(path).head["cell"], self.ask("gemmi", path)["cell"], 0.05)


if __name__ == "__main__":
    listed.main()
