"""Files of crystals (CIF): symmetry, special positions, disorder, cells, all spellings; beside gemmi and ASE too. See listed.py.

Structures are those of textbooks, and where their atoms lie is worked out here from Wyckoff positions, not by operations."""
import gzip
import itertools
import math
import os
import random
import re

import listed
from listed import ALTERNATIVE, DUMMY
from test_pdb_files import standard

F_CENTRED = ["x,y,z", "x,y+1/2,z+1/2", "x+1/2,y,z+1/2", "x+1/2,y+1/2,z"]
QUARTZ = ["x,y,z", "-y,x-y,z+2/3", "-x+y,-x,z+1/3", "y,x,-z", "x-y,-y,-z+1/3", "-x,-x+y,-z+2/3"]
C2C = ["x,y,z", "-x,y,-z+1/2", "-x,-y,-z", "x,-y,z+1/2", "x+1/2,y+1/2,z", "-x+1/2,y+1/2,-z+1/2", "-x+1/2,-y+1/2,-z", "x+1/2,-y+1/2,z+1/2"]
HEXAGONAL = ["x,y,z", "-y,x-y,z", "-x+y,-x,z", "-x,-y,z+1/2", "y,-x+y,z+1/2", "x-y,x,z+1/2", "y,x,-z", "x-y,-y,-z", "-x,-x+y,-z", "-y,-x,-z+1/2",
             "-x+y,y,-z+1/2", "x,x-y,-z+1/2", "-x,-y,-z", "y,-x+y,-z", "x-y,x,-z", "x,y,-z+1/2", "-y,x-y,-z+1/2", "-x+y,-x,-z+1/2", "-y,-x,z",
             "-x+y,y,z", "x,x-y,z", "y,x,z+1/2", "x-y,-y,z+1/2", "-x,-x+y,z+1/2"]
COLUMNS = ["label", "type_symbol", "fract_x", "fract_y", "fract_z"]
CUBE = ((5, 5, 5), (90, 90, 90))


def cell(lengths, angles):
    names = ["length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"]
    return "".join(f"_cell_{name} {value}\n" for name, value in zip(names, [*lengths, *angles]))


def operations(texts, name="_symmetry_equiv_pos_as_xyz"):
    return f"loop_\n{name}\n" + "".join(f"'{text}'\n" for text in texts)


def sites(*rows, columns=()):
    names = COLUMNS + list(columns)
    return "loop_\n" + "".join(f"_atom_site_{name}\n" for name in names) + "".join(" ".join(map(str, row)) + "\n" for row in rows)


def crystal(box, texts, *rows, columns=()):
    return "data_x\n" + cell(*box) + operations(texts) + sites(*rows, columns=columns)


def halves(shares):
    return [tuple((x + s) % 1 for x, s in zip(share, shift)) for shift in ((0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0)) for share in shares]


NACL = crystal(((5.64,) * 3, (90, "90.", "9.0e1")), F_CENTRED, ("Na1", "Na1+", 0, 0, 0), ("Cl1", "Cl1-", 0.5, 0.5, 0.5))

DISORDERED = crystal(CUBE, ["x,y,z", "-x,y,z"], ("C1", "C", "0.06(1)", 0.3, 0.3, 0.5, ".", -1), ("O1", "?", 0.1, 0.8, 0.3, 0.6, "A", 1),
                     ("N1", "N", 0.1, 0.8, 0.3, 0.4, "A", 2), ("X1", "X", "?", 0, 0, 1, ".", "."), columns=("occupancy", "disorder_assembly", "disorder_group"))
MAGNETIC = "data_y\n" + cell(*CUBE) + operations(["x,y,z,+1", "-x,y,1/2+z,-1"], "_space_group_symop_magn_operation.xyz") + \
    operations(["x,y,z,+1", "x+1/2,y,z,-1"], "_space_group_symop_magn_centering.xyz") + \
    "loop_\n_atom_site.label\n_atom_site.fract_x\n_atom_site.fract_y\n_atom_site.fract_z\nFe1 0.1 0.2 0.3\n" + NACL


class CrystalTest(listed.ListTest):
    def match(self, found, box, expected, tolerance=2e-3):
        """`expected`: by element, shares of the cell. Each atom has one of its own within `tolerance` angstrom in some image."""
        edges = standard(*box)
        self.near(found.head["cell"][:3], edges, 1e-9)
        self.assertEqual((found.head["repeats"], found.head["cell"][3]), (True, [0, 0, 0]))
        left = [(element, share) for element, shares in expected.items() for share in shares]
        self.assertEqual(len(found.atoms), len(left))
        for atom in found.atoms:
            def distance(share):
                best = 1e9
                # From the atom's own shares, so that images are near.
                own = self.shares(edges, atom[:3])
                off = [s - o for s, o in zip(share, own)]
                for image in itertools.product((-1, 0, 1), repeat=3):
                    d = [o - round(o) + i for o, i in zip(off, image)]
                    best = min(best, math.dist([0, 0, 0], [sum(d[e] * edges[e][k] for e in range(3)) for k in range(3)]))
                return best
            near = [one for one in left if one[0] == atom.element and distance(one[1]) < tolerance]
            self.assertEqual(len(near), 1, (atom, left))
            left.remove(near[0])
            self.assertTrue(all(-0.0006 < s < 0.9996 for s in self.shares(edges, atom[:3])), atom)

    @staticmethod
    def shares(edges, place):
        """Edges are those of standard(): a along x, b in the plane of x and y."""
        c = place[2] / edges[2][2]
        b = (place[1] - c * edges[2][1]) / edges[1][1]
        return [(place[0] - b * edges[1][0] - c * edges[2][0]) / edges[0][0], b, c]


class Crystals(CrystalTest):
    def test_rock_salt(self):
        found = self.of("a.cif", NACL)
        self.match(found, ((5.64,) * 3, (90, 90, 90)), {"Na": halves([(0, 0, 0)]), "Cl": halves([(0.5, 0.5, 0.5)])})
        self.assertEqual(found.head["notes"], "2 sites by 4 symmetry operations")
        self.assertEqual(sorted(set(found.of("name"))), ["Cl1", "Na1"])
        self.assertEqual(set(found.of("flags")), {0})
        for name, text in ("NACL.CIF", NACL), ("a.txt", NACL), ("b.cif", "# by hand\n\n" + NACL):
            self.assertEqual(self.of(name, text).atoms, found.atoms)
        self.assertEqual(self.of("a.cif.gz", gzip.compress(NACL.encode())).atoms, found.atoms)

    def test_diamond(self):
        """Two face-centred lattices, a quarter of the diagonal apart."""
        group = [f"{x},{y},{z}" for x, y, z in (text.split(",") for text in F_CENTRED)]
        group += [re.sub(r"\b([xyz])", r"1/4-\1", text) for text in group]
        self.match(self.of("a.cif", crystal(((3.567,) * 3, (90, 90, 90)), group, ("C1", "C", 0, 0, 0))), ((3.567,) * 3, (90, 90, 90)),
                   {"C": halves([(0, 0, 0), (0.25, 0.25, 0.25)])})

    def test_quartz(self):
        """Trigonal: silicon on an axis of order two; every one has four oxygens at 1.61 angstrom."""
        box, u, (x, y, z) = ((4.9134, 4.9134, 5.4052), (90, 90, 120)), 0.4697, (0.4135, 0.2669, 0.7858)
        t = 1 / 3
        expected = {"Si": [(u, 0, 2 * t), (0, u, t), (-u, -u, 0)],
                    "O": [(x, y, z), (-y, x - y, z + 2 * t), (y - x, -x, z + t), (y, x, -z), (x - y, -y, t - z), (-x, y - x, 2 * t - z)]}
        for third in "0.66666666", "0.6667", "0.667":
            found = self.of("a.cif", crystal(box, QUARTZ, ("Si1", "Si4+", "0.4697(1)", 0, third), ("O1", "O2-", "0.4135(3)", "0.2669(2)", "0.7858(2)")))
            self.match(found, box, expected, 3e-3)
        edges = standard(*box)
        found = self.of("a.cif", crystal(box, QUARTZ, ("Si1", "Si4+", "0.4697(1)", 0, "0.66666667"), ("O1", "O2-", "0.4135(3)", "0.2669(2)", "0.7858(2)")))
        for silicon in (atom for atom in found.atoms if atom.element == "Si"):
            ways = [math.dist(silicon[:3], [p + sum(i[e] * edges[e][k] for e in range(3)) for k, p in enumerate(oxygen[:3])])
                    for oxygen in found.atoms if oxygen.element == "O" for i in itertools.product((-1, 0, 1), repeat=3)]
            self.assertEqual(len([w for w in ways if 1.59 < w < 1.63]), 4)
            self.assertEqual(len([w for w in ways if w < 2.5]), 4)

    def test_monoclinic(self):
        """C 2/c with an atom on a centre, one on an axis and one at a general place; all angles of the cell count."""
        box, y, (a, b, c) = ((10, 9, 5.5), (90, 106.3, 90)), 0.137, (0.213, -0.07, 0.362)
        eight = [(a, b, c), (-a, b, 0.5 - c), (-a, -b, -c), (a, -b, 0.5 + c)]
        expected = {"Fe": [(0, 0, 0), (0, 0, 0.5)], "Ca": [(0, y, 0.25), (0, -y, 0.75)], "O": eight}
        expected = {element: shares + [(p + 0.5, q + 0.5, r) for p, q, r in shares] for element, shares in expected.items()}
        self.match(self.of("a.cif", crystal(box, C2C, ("Fe1", "Fe3+", 0, 0, 0), ("Ca1", "Ca2+", 0, y, 0.25), ("O1", "O2-", a, b, c))), box, expected)

    def test_triclinic(self):
        box, (x, y, z) = ((6.1, 7.2, 8.3), (82, 95.5, 113)), (0.21, 1.84, -0.33)
        self.match(self.of("a.cif", crystal(box, ["x,y,z", "-x,-y,-z"], ("N1", "N", x, y, z))), box, {"N": [(x, y, z), (-x, -y, -z)]})

    def test_hexagonal(self):
        """Thirds of two, three and four digits are one special position: two atoms of magnesium, not 24 nor 6."""
        box = ((3.21, 3.21, 5.21), (90, 90, 120))
        for one, two in (("0.3333", "0.6667"), ("0.333333", "0.666667"), ("0.333", "0.667"), (".33", ".67"), ("0.3333(2)", "-0.3333")):
            found = self.of("a.cif", crystal(box, HEXAGONAL, ("Mg1", "Mg", one, two, 0.25)))
            self.match(found, box, {"Mg": [(1 / 3, 2 / 3, 0.25), (2 / 3, 1 / 3, 0.75)]}, 0.03)

    def test_what_is_one_place(self):
        """Images nearer than 0.4 angstrom are one atom, those farther apart are two."""
        for off, count in ((0.19, 1), (0.21, 2)):
            found = self.of("a.cif", crystal(CUBE, ["x,y,z", "-x,y,z"], ("C1", "C", off / 5, 0.3, 0.3)))
            self.assertEqual(len(found.atoms), count, off)
        # Across the side of the cell as well, and along the diagonal of an oblique one.
        self.assertEqual(len(self.of("a.cif", crystal(CUBE, ["x,y,z", "-x,y,z"], ("C1", "C", 0.501, 0.3, 0.3))).atoms), 1)
        oblique = ((5, 5, 5), (90, 90, 30))
        for share, count in ((0.02, 1), (0.05, 1), (0.3, 2)):
            # a - b is 2.588 long here, so that both shares may be off by much more than 0.4 / 5.
            self.assertEqual(len(self.of("a.cif", crystal(oblique, ["x,y,z", "-x,-y,z"], ("C1", "C", share, -share, 0.3))).atoms), count, share)

    def test_sides_of_the_cell(self):
        """Atoms lie in one cell, and thirds that do not add up to 1 lie at its origin."""
        found = self.of("a.cif", crystal(CUBE, ["x,y,z", "x,y,z+1/3"], ("C1", "C", -0.25, 3.5, 0.6667)))
        self.near(sorted(found.places()), [(3.75, 2.5, 0), (3.75, 2.5, 3.3335)], 3e-3)
        found = self.of("a.cif", crystal(CUBE, ["x,y,z"], ("C1", "C", 0.9994, 0.9996, 1)))
        self.near(found.places(), [(4.997, -0.002, 0)], 1e-9)


class Spellings(CrystalTest):
    def equal(self, text, base=NACL):
        one, other = self.of("a.cif", text), self.of("a.cif", base)
        self.assertEqual(sorted(one.atoms), sorted(other.atoms), text)
        self.near(one.head["cell"], other.head["cell"], 1e-12)

    def test_operations(self):
        base = crystal(((5.64,) * 3, (90, 90, 90)), ["x,y,z", "-x+1/2,y-x,1/3+z"], ("C1", "C", 0.1, 0.2, 0.3))
        for other in ("1/2-x,-x+y,z+1/3", "-X+1/2, Y-X, 1/3+Z", " - x + 1 / 2 , + y - x , + 1/3 + z ", "0.5-x,y-x,.3333+z", "-x+0.50,-x+y,z+0.333333",
                      "-x-1/2,y-x,z-2/3", "-x+3/2,y-x+1,z+4/3", "1/2-x,y-x+0,z+.3334", "-1*x+1/2,y-1x,z+2/6", "-x+1/2,y-x,z+1/3,+1", "-x+1/2,y-x,z+1/3,-1"):
            self.equal(base.replace("-x+1/2,y-x,1/3+z", other), base)
        for name in ("_space_group_symop_operation_xyz", "_space_group_symop.operation_xyz", "_symmetry_equiv.pos_as_xyz", "_SYMMETRY_Equiv_Pos_As_XYZ",
                     "_space_group_symop_magn_operation.xyz", "_symmetry_equiv_pos_site_id\n_symmetry_equiv_pos_as_xyz"):
            text = NACL.replace("_symmetry_equiv_pos_as_xyz", name)
            if "site_id" in name:
                for number, line in enumerate(F_CENTRED):
                    text = text.replace(f"'{line}'", f"{number + 1} '{line}'")
            self.equal(text)
        self.equal(NACL.replace("'", ""))
        self.equal(NACL.replace("'", '"'))
        self.equal(NACL.replace("'x,y,z'\n", ""))  # the identity is there anyway
        self.equal(NACL.replace("'x,y,z'\n", "x,y,z\nx,y,z\nx+1,y,z-1\n"))
        # Those of a magnetic group: each with each centring.
        magnetic = NACL.replace(operations(F_CENTRED), operations(["x,y,z,+1"], "_space_group_symop_magn_operation.xyz") +
                                operations([t + ",-1" for t in F_CENTRED], "_space_group_symop_magn_centering.xyz"))
        self.equal(magnetic)
        both = crystal(CUBE, ["x,y,z", "-x,-y,z+1/4"], ("C1", "C", 0.1, 0.2, 0.3))
        centred = both + operations(["x,y,z,+1", "x+1/2,y+1/2,z+1/2,-1"], "_space_group_symop_magn_centering_xyz")
        self.match(self.of("a.cif", centred), CUBE, {"C": [(0.1, 0.2, 0.3), (-0.1, -0.2, 0.55), (0.6, 0.7, 0.8), (0.4, 0.3, 0.05)]})
        for wrong in ("x,y", "x,y,z,w", "x,y,", "x,x,z", "x,y,z+", "x,y,z+1/0", "x,y,z z", "x,y,2z", "x,y,q", "x;y;z", "1/2,y,z", ""):
            self.refuse("a.cif", NACL.replace("'x,y+1/2,z+1/2'", f"'{wrong}'"), "a.cif:11:", f'found "{wrong}"', "a symmetry operation such as")
        self.refuse("a.cif", NACL.replace("'x,y+1/2,z+1/2'", "x, y+1/2, z+1/2"), "in quotes, if it has blanks")
        many = operations([f"x,y,z+{i}/9999" for i in range(1100)])
        self.refuse("a.cif", "data_x\n" + cell(*CUBE) + many + sites(("C1", "C", 0, 0, 0)), "more than 1024 symmetry operations")

    def test_forms_of_text(self):
        head, _, table = NACL.partition("loop_\n_atom_site_label")
        table = "loop_\n_atom_site_label" + table
        title = "_a.b 'it's'\n_a.c \"a 'b' c\"\n_a.d\n;data_y\nloop_\n_atom_site_fract_x\n0.3\n;\n"
        for text in (NACL.replace("\n", "\r\n"), NACL.replace("\n", "\r"), "\ufeff" + NACL, NACL + "\x1a", NACL.replace("\n", "\n\n"), NACL.replace(" ", "   "),
                     NACL.upper().replace("NA1+", "Na1+").replace("CL1-", "Cl1-").replace("NA1 ", "Na1 ").replace("CL1 ", "Cl1 "),
                     NACL.replace("_atom_site_", "_atom_site."), NACL.replace("_cell_", "_cell.").replace("_cell.length_a", "_CELL.Length_A"),
                     "data_x\n" + table + head[7:], head.replace("data_x\n", "data_x\n" + title) + table, "data_global\n_a 1\nloop_\n_b\n1\n2\n" + NACL,
                     NACL.replace("5.64", "5.64(2)"), NACL.replace("5.64", "564e-2"), NACL.replace("0.5 0.5 0.5", "0.5(1) .5 +0.5"),
                     NACL.replace("0.5 0.5 0.5", "5e-1 -0.5 1.5"), NACL.replace("0.5 0.5 0.5", "0.5\n0.5 # here\n0.5"), NACL.replace("Na1 ", "'Na1' "),
                     NACL.replace("_cell_angle_alpha 90\n", ""), NACL.replace("_cell_angle_alpha 90\n", "_cell_angle_alpha ?\n"),
                     NACL.replace("data_x\n", "data_x\n_citation 'O'Keeffe, M.',\n"), NACL + "_publ 'no end\n",
                     NACL.replace("data_x\n", "data_x\nsave_f\nloop_\n_atom_site_fract_x\n0.1\n0.2\nsave_\n"),
                     NACL + "loop_\n_atom_site_aniso_label\n_atom_site_aniso_U_11\nNa1 0.1\nCl1 0.2\n", NACL.replace("data_x\n", "")):
            self.equal(text)
        self.assertIn("taken as 90 degrees", self.of("a.cif", NACL.replace("_cell_angle_alpha 90\n", "")).head["notes"])

    def test_columns_in_any_order(self):
        rows = [("Na1", "Na1+", 0, 0, 0), ("Cl1", "Cl1-", 0.5, 0.5, 0.5)]
        for order in itertools.islice(itertools.permutations(range(5)), 0, 120, 7):
            text = "loop_\n" + "".join(f"_atom_site_{COLUMNS[i]}\n_other_{i}\n" for i in order)
            text += "".join(" ".join(f"{row[i]} 'a b'" for i in order) + "\n" for row in rows)
            self.equal(NACL.replace(sites(*rows), text))

    def test_one_site_as_items(self):
        text = "data_x\n" + cell(*CUBE) + "_symmetry_equiv_pos_as_xyz 'x,y,z'\n" + "".join(
            f"_atom_site_{name} {value}\n" for name, value in zip(COLUMNS, ("Po1", "Po", 0, "0.5(1)", 0.25)))
        self.match(self.of("a.cif", text), CUBE, {"Po": [(0, 0.5, 0.25)]})

    def test_elements(self):
        """Of symbols with charges, or of labels where there are none; minerals' water, vacancies and sites of several elements."""
        for symbol, element in ("Fe3+", "Fe"), ("O2-", "O"), ("O-2", "O"), ("FE", "Fe"), ("Si0+", "Si"), ("D", "H"), ("'Cu 2+'", ""), ("NH4", "N"), ("Wat", "O"), ("H2O", "O"), \
                ("M", ""), ("Ca", "Ca"), ("Cval", "C"):
            found = self.of("a.cif", crystal(CUBE, ["x,y,z"], ("X1", symbol, 0, 0, 0)))
            self.assertEqual((found.of("element"), found.of("name")), ([element] if element else found.of("element"), ["X1"]), symbol)
        plain = "data_x\n" + cell(*CUBE) + operations(["x,y,z"]) + "loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n"
        for label, element in ("Fe1", "Fe"), ("O2A", "O"), ("OH1", "O"), ("C12", "C"), ("CL3", "Cl"), ("FE1", "Fe"), ("Cl1", "Cl"), ("CA1", "C"), ("Ca1", "Ca"), ("H1W", "H"), ("Wat1", "O"), \
                ("OW", "O"), ("AlT1", "Al"), ("SiT1", "Si"), ("T1", ""), ("M2", ""), ("Na", "Na"), ("O1'", "O"), ("O_w", "O"):
            found = self.of("a.cif", plain + f'"{label}" 0.1 0.2 0.3\n')
            self.assertEqual((found.of("element"), found.of("name"), found.of("flags")), ([element], [label], [0]), label)
        self.assertEqual(self.of("a.cif", plain + "C1 0 0 0\nVac1 0 0 0.5\n").of("flags"), [0, DUMMY])

    def test_many_labels(self):
        """Large cells number all of their atoms."""
        rows = [(f"C{i}", "C" if i % 2 else "?", i / 70001, i % 7 / 7, i % 11 / 11) for i in range(70000)]
        found = self.of("a.cif", crystal(((900, 90, 90), (90, 90, 90)), ["x,y,z"], *rows))
        self.assertEqual((len(found.atoms), set(found.of("element"))), (70000, {"C"}))


class Symmetry(CrystalTest):
    """What a file that gives no operations means."""

    def test_groups_without_operations(self):
        bare = NACL.replace(operations(F_CENTRED), "")
        for tag, name in (("_symmetry_space_group_name_H-M", "'F m -3 m'"), ("_space_group_name_H-M_alt", "'F m -3 m'"), ("_symmetry_Int_Tables_number", "225"),
                          ("_space_group_IT_number", "225"), ("_space_group_name_Hall", "'-F 4 2 3'"), ("_SYMMETRY_SPACE_GROUP_NAME_H-M", "Fm-3m")):
            self.refuse("a.cif", bare.replace("data_x\n", f"data_x\n_a 1\n{tag} {name}\n"), "a.cif:3:", name.strip("'"), "without its operations", "ASE adds them")
        for tag, name in ("_symmetry_space_group_name_H-M", "'P 1'"), ("_symmetry_space_group_name_H-M", "P1"), ("_space_group_IT_number", "1"):
            found = self.of("a.cif", bare + f"{tag} {name}\n")
            self.assertEqual((len(found.atoms), found.head["notes"]), (2, ""))
        for more in "", "_space_group_name_H-M_alt ?\n", "_space_group_IT_number .\n":
            found = self.of("a.cif", bare + more)
            self.assertEqual((len(found.atoms), found.head["notes"]), (2, "no symmetry in the file, so these are its sites alone"))
        alone = self.of("a.cif", NACL.replace(operations(F_CENTRED), operations(["x,y,z"])) + "_space_group_name_H-M_alt 'F m -3 m'\n")
        self.assertEqual(alone.head["notes"], "no symmetry operation but x,y,z, though the space group is F m -3 m")
        self.assertEqual(self.of("a.cif", NACL + "_space_group_name_H-M_alt 'F m -3 m'\n").head["notes"], "2 sites by 4 symmetry operations")

    def test_cells(self):
        for line in "_cell_length_b 5.64\n", "_cell_length_a 5.64\n":
            self.refuse("a.cif", NACL.replace(line, ""), "without its lengths", "expected _cell_length_a, b and c")
        self.refuse("a.cif", NACL.replace("_cell_length_a 5.64", "_cell_length_a long"), "a.cif:2:", '"long"', "a length of the cell")
        self.refuse("a.cif", NACL.replace("_cell_angle_alpha 90", "_cell_angle_alpha x"), "a.cif:5:", '"x"', "an angle of the cell")
        for angles in ((0, 90, 90), (90, 90, 180), (120, 120, 120), (10, 90, 20)):
            self.refuse("a.cif", "data_x\n" + cell((5, 5, 5), angles) + operations(["x,y,z"]) + sites(("C1", "C", 0, 0, 0)), "expected one with a volume")
        for lengths in ((0, 5, 5), (5, -5, 5)):
            self.refuse("a.cif", "data_x\n" + cell(lengths, (90, 90, 90)) + operations(["x,y,z"]) + sites(("C1", "C", 0, 0, 0)), "expected one with a volume")
        self.match(self.of("a.cif", crystal(((1, 1, 1), (90, 90, 90)), ["x,y,z"], ("C1", "C", 0.5, 0, 0))), ((1, 1, 1), (90, 90, 90)), {"C": [(0.5, 0, 0)]})

    def test_cartesian_sites(self):
        """As they are; in a cell with symmetry, all of its atoms."""
        table = "loop_\n_atom_site_label\n_atom_site_Cartn_x\n_atom_site_Cartn_y\n_atom_site_Cartn_z\nC1 -1.5 7.25(2) 3\nO1 1 2 3\n"
        for head in "data_x\n", "data_x\n" + cell(*CUBE), "data_x\n" + cell(*CUBE) + operations(["x,y,z"]):
            found = self.of("a.cif", head + table)
            self.near(found.places(), [(-1.5, 7.25, 3), (1, 2, 3)])
            self.assertEqual(("cell" in found.head, found.of("element")), (head != "data_x\n", ["C", "O"]))
        found = self.of("a.cif", "data_x\n" + cell(*CUBE) + operations(["x,y,z", "-x,-y,-z"]) + table)
        self.match(found, CUBE, {"C": [(-0.3, 1.45, 0.6), (0.3, -1.45, -0.6)], "O": [(0.2, 0.4, 0.6), (-0.2, -0.4, -0.6)]})
        both = "data_x\n" + cell(*CUBE) + operations(["x,y,z"]) + sites(("C1", "C", 0.1, 0.2, 0.3, 7, 8, 9), columns=("Cartn_x", "Cartn_y", "Cartn_z"))
        self.match(self.of("a.cif", both), CUBE, {"C": [(0.1, 0.2, 0.3)]})

    def test_blocks(self):
        """Each block with sites is a frame, of its own cell and symmetry."""
        second = crystal(CUBE, ["x,y,z"], ("C1", "C", 0.1, 0.2, 0.3)).replace("data_x", "data_y")
        text = "data_global\n_a 1\n" + NACL + "data_none\n_b 2\n" + second + "data_end\n_c 3\n"
        self.assertEqual([(len(f.atoms), f.head["frames"], f.head["cell"][0][0]) for f in (self.of("a.cif", text, i) for i in (0, 1, -1, -2))],
                         [(8, 2, 5.64), (1, 2, 5), (1, 2, 5), (8, 2, 5.64)])
        self.assertIn("the first of several frames", self.of("a.cif", text).head["notes"])
        self.assertNotIn("several", self.of("a.cif", NACL + "data_end\n_c 3\n").head["notes"])

    def test_refusals(self):
        self.refuse("a.cif", NACL.replace("_atom_site_fract_z\n", "_atom_site_z\n"), "without all of _atom_site_fract_x, y and z")
        self.refuse("a.cif", NACL.replace("0.5 0.5 0.5", "0.5 half 0.5"), "a.cif:21:", '"half"', "a share of the cell")
        self.refuse("a.cif", NACL.replace(" 0.5 0.5 0.5\n", " 0.5 0.5\n"), "a row of a table of 5 columns", "cut off")
        self.refuse("a.cif", NACL.replace(" 0.5 0.5 0.5\n", " 0.5 'x 0.5\n"), "a.cif:21:", "a quote that is not closed")
        self.refuse("a.cif", NACL.replace("0 0 0", "? ? ?").replace("0.5 0.5 0.5", ". 0 0"), "no site with a place")
        found = self.of("a.cif", NACL.replace("0 0 0", "? 0 0"))
        self.assertEqual((len(found.atoms), "1 point without a place left out" in found.head["notes"]), (4, True))
        self.refuse("a.cif", NACL, "no column \"charge\"", "occupancy, u_iso", arguments=(0, "charge"))


class Disorder(CrystalTest):
    """Which atoms are shown where not all can be there: those without the flag."""

    def shown(self, box, group, *rows, more=("occupancy",)):
        found = self.of("a.cif", crystal(box, group, *rows, columns=more), 0, "occupancy")
        return [atom.name for atom in found.atoms if not atom.flags & ALTERNATIVE], found

    def test_sites_of_several_elements(self):
        """One place: the element of the largest share, all the same of whichever comes first."""
        for order in itertools.permutations([("Fe1", "Fe", 0, 0, 0, 0.3), ("Ni1", "Ni", 0, 0, 0, 0.5), ("Co1", "Co", 0.001, 0, 0, 0.2)]):
            names, found = self.shown(((5.64,) * 3, (90, 90, 90)), F_CENTRED, *order)
            self.assertEqual((names, len(found.atoms)), (["Ni1"] * 4, 12))
        self.near([sorted(set(found.of("first")))], [(0.2, 0.3, 0.5)], 1e-7)
        self.assertIn("3 sites partly occupied", found.head["notes"])
        self.assertEqual(self.shown(CUBE, ["x,y,z"], ("Fe1", "Fe", 0, 0, 0, 0.5), ("Ni1", "Ni", 0, 0, 0, 0.5))[0], ["Fe1"])

    def test_split_sites(self):
        """Near each other, and not both there; but neighbours that may both be there are."""
        for distance, occupancy, count in ((0.3, 0.5, 1), (0.6, 0.5, 1), (0.6, 0.6, 2), (1.2, 0.5, 2), (0.35, 1, 1), (0.6, 1, 2)):
            names, _ = self.shown(CUBE, ["x,y,z"], ("O1", "O", 0.02, 0, 0, occupancy), ("O2", "O", 0.02 - distance / 5, 0, 0, occupancy))
            self.assertEqual(len(names), count, (distance, occupancy))
        # A site beside a mirror, split by it.
        self.assertEqual(len(self.shown(CUBE, ["x,y,z", "-x,y,z"], ("O1", "O", 0.06, 0, 0, 0.5))[0]), 1)
        self.assertEqual(len(self.shown(CUBE, ["x,y,z", "-x,y,z"], ("O1", "O", 0.06, 0, 0, 1))[0]), 2)
        self.assertEqual(len(self.shown(CUBE, ["x,y,z"], ("O1", "O", 0, 0, 0, "."), ("O2", "O", 0.5, 0, 0, "?"), ("O3", "O", 0, 0.5, 0, "0.9(1)"))[0]), 3)

    def test_groups(self):
        """Of an assembly the group of the largest mean occupancy; `.` and 0 are none; another assembly is another choice."""
        columns = ("occupancy", "disorder_assembly", "disorder_group")
        rows = [("C1", "C", 0, 0, 0, 1, ".", "."), ("C2", "C", 0.3, 0, 0, 0.4, ".", 1), ("C3", "C", 0, 0.3, 0, 0.6, ".", 2), ("C4", "C", 0.5, 0.3, 0, 0.6, ".", 2),
                ("C5", "C", 0.3, 0.3, 0.5, 0.7, "B", 1), ("C6", "C", 0.8, 0.3, 0.5, 0.3, "B", 2), ("C7", "C", 0.8, 0.8, 0.5, 0.2, ".", 0)]
        for order in (rows, rows[::-1]):
            self.assertEqual(sorted(self.shown(CUBE, ["x,y,z"], *order, more=columns)[0]), ["C1", "C3", "C4", "C5", "C7"])
        both = [row[:5] + (1,) + row[6:] for row in rows]  # all are there
        self.assertEqual(len(self.shown(CUBE, ["x,y,z"], *both, more=columns)[0]), 7)

    def test_group_about_a_centre(self):
        """A ring that lies on its own image (its group is negative) is shown once, whole, also where its atoms avoid each other."""
        rows = [(f"C{i + 1}", "C", 0.05 + 0.14 * math.cos(i * math.pi / 3 + 0.2), 0.03 + 0.14 * math.sin(i * math.pi / 3 + 0.2), 0.01, 0.5, -1) for i in range(6)]
        box = ((10, 10, 10), (90, 90, 90))
        names, found = self.shown(box, ["x,y,z", "-x,-y,-z", "x+1/2,y+1/2,z+1/2", "1/2-x,1/2-y,1/2-z"], *rows, more=("occupancy", "disorder_group"))
        self.assertEqual((len(found.atoms), sorted(names)), (24, sorted([row[0] for row in rows] * 2)))

    def test_everything_at_once(self):
        found = self.of("a.cif", DISORDERED)
        self.assertEqual([(a.name, a.flags) for a in found.atoms], [("C1", 0), ("C1", ALTERNATIVE), ("O1", 0), ("O1", 0), ("N1", ALTERNATIVE), ("N1", ALTERNATIVE)])
        self.assertEqual([len(self.of("a.cif", MAGNETIC, i).atoms) for i in (0, 1)], [4, 8])

    def test_no_atoms(self):
        found = self.of("a.cif", crystal(CUBE, ["x,y,z"], ("C1", "C", 0, 0, 0, 1, "d"), ("C2", "C", 0.5, 0, 0, 0, "d"), ("C3", "C", 0, 0.5, 0, 1, "dum"),
                                         columns=("occupancy", "calc_flag")))
        self.assertEqual(found.of("flags"), [0, DUMMY, DUMMY])

    def test_columns(self):
        found = self.of("a.cif", crystal(CUBE, ["x,y,z", "x,y,z+1/2"], ("C1", "C", 0, 0, 0, "0.5(1)", "0.02(1)"), ("C2", "C", 0.5, 0, 0, ".", "?"),
                                         columns=("occupancy", "U_iso_or_equiv")), 0, "occupancy", "u_iso")
        self.near([(a.first, a.second or 9) for a in found.atoms], [(0.5, 0.02), (0.5, 0.02), (1, 9), (1, 9)], 1e-7)
        found = self.of("a.cif", crystal(CUBE, ["x,y,z"], ("C1", "C", 0, 0, 0, 8 * math.pi ** 2 * 0.03), columns=("B_iso_or_equiv",)), 0, "u_iso")
        self.near([(found.atoms[0].first,)], [(0.03,)], 1e-7)


POSCAR = """NaCl, by hand
2.0
2.0 0.0 0.0
0.5 2.5 0.0
0.25 -0.5 3.0
Na Cl
1 2
Direct
0.25 0.5 0.75
-0.5 0.0 1.25
0.1 0.2 0.3
"""
EDGES = [(4, 0, 0), (1, 5, 0), (0.5, -1, 6)]
# 0.25 a + 0.5 b + 0.75 c, and so on.
PLACES = [(1.875, 1.75, 4.5), (-2 + 0.625, -1.25, 7.5), (0.4 + 0.2 + 0.15, 1 - 0.3, 1.8)]

XDATCAR = POSCAR.replace("Direct", "Direct configuration=     1") + "Direct configuration=     2\n0.5 0.5 0.75\n" + "0.1 0.2 0.3\n" * 2


class Poscar(listed.ListTest):
    def check(self, text, edges=EDGES, places=PLACES, elements=("Na", "Cl", "Cl"), name="POSCAR", notes=""):
        found = self.of(name, text)
        self.near(found.head["cell"], [*edges, (0, 0, 0)], 1e-9)
        self.near(found.places(), places, 1e-9)
        self.assertEqual((tuple(found.of("element")), found.head["repeats"], found.head["notes"]), (tuple(elements), True, notes), text)
        return found

    def test_shares(self):
        self.check(POSCAR)
        for name in ("CONTCAR", "POSCAR_relaxed", "POSCAR.01", "CONTCAR-2", "si.vasp", "si.POSCAR", "si.poscar", "a.contcar", "anything", "a.b"):
            self.check(POSCAR, name=name)
        self.check(gzip.compress(POSCAR.encode()), name="POSCAR.gz")
        for text in (POSCAR.replace("\n", "\r\n"), "\ufeff" + POSCAR, POSCAR + "\n\n", POSCAR.rstrip("\n"), POSCAR.replace("Direct", "direct lattice"), POSCAR.replace("Direct", "D"),
                     POSCAR.replace("Direct", "Selective dynamics\nDirect").replace("0.75\n", "0.75 T F T\n"), POSCAR.replace("0.25 0.5 0.75", "2.5E-1 5.0D-1 .75 ! first"),
                     POSCAR.replace("2.0\n2.0", "  2.0  ! scale\n2.0").replace("1 2\n", "1 2 ! atoms\n")):
            self.check(text)

    def test_scales(self):
        cell = [(2, 0, 0), (0.5, 2.5, 0), (0.25, -0.5, 3)]
        volume = 2 * 2.5 * 3
        for scale, factors in (("-120", (2, 2, 2)), (str(-volume), (1, 1, 1)), ("1.0", (1, 1, 1)), ("2 3 0.5", (2, 3, 0.5))):
            edges = [tuple(x * f for x, f in zip(edge, factors)) for edge in cell]
            places = [tuple(sum(s * edge[k] for s, edge in zip(share, edges)) for k in range(3)) for share in ((0.25, 0.5, 0.75), (-0.5, 0, 1.25), (0.1, 0.2, 0.3))]
            self.check(POSCAR.replace("\n2.0\n", f"\n{scale}\n"), edges, places)
            for word in "Cartesian", "cart", "K", "k-space":
                given = [tuple(x * f for x, f in zip(share, factors)) for share in ((0.25, 0.5, 0.75), (-0.5, 0, 1.25), (0.1, 0.2, 0.3))]
                self.check(POSCAR.replace("\n2.0\n", f"\n{scale}\n").replace("Direct", word), edges, given)
        left = POSCAR.replace("0.25 -0.5 3.0", "0.25 -0.5 -3.0").replace("\n2.0\n", "\n-120\n")  # a left-handed cell has a volume too
        self.near(self.of("POSCAR", left).head["cell"][:3], [(4, 0, 0), (1, 5, 0), (0.5, -1, -6)], 1e-9)

    def test_names(self):
        for names, elements in (("Fe_pv O", ("Fe", "O", "O")), ("Fe/0123abc O_s/77", ("Fe", "O", "O")), ("H.75 He", ("H", "He", "He")), ("Na+ Cl-", ("Na", "Cl", "Cl")), ("Q Cl", ("", "Cl", "Cl"))):
            found = self.check(POSCAR.replace("Na Cl", names), elements=elements)
        self.check(POSCAR.replace("Na Cl\n1 2", "Na Cl Na\n1 1 1"), elements=("Na", "Cl", "Na"))
        self.check(POSCAR.replace("Na Cl\n1 2", "K Na Cl\n0 1 2"))
        # VASP 4: elements of the title, of the lines, or none.
        old = POSCAR.replace("Na Cl\n1 2", "1 2")
        self.check(old.replace("NaCl, by hand", "Na Cl"), notes="elements from the title")
        self.check(old.replace("0.75\n", "0.75 Na\n").replace("1.25\n", "1.25 Cl\n").replace("0.3\n", "0.3 Cl\n"))
        found = self.check(old, elements=("", "", ""), notes="no elements in the file: write them into a line above the numbers of atoms")
        self.check(old.replace("NaCl, by hand", "a title"), elements=("", "", ""), notes=found.head["notes"])

    def test_velocities(self):
        """Behind the places, per atom; in shares of the cell below a line "Direct"; what else stands there is nothing."""
        def velocities(text, *columns):
            return [(a.first, a.second) for a in self.of("CONTCAR", text, 0, *columns).atoms]
        rows = "1 2 3\n4 5 6\n-7 8 9e-3\n"
        for between in "\n", "Cartesian\n", "  \n", "Lattice velocities and vectors\n1\n" + "0 0 0\n" * 6 + "\n":
            self.near(velocities(POSCAR + between + rows, "vx", "vz"), [(1, 3), (4, 6), (-7, 0.009)], 1e-7)
        self.near(velocities(POSCAR + "Direct\n" + rows, "vx", "vy"), [(4 + 2 + 1.5, 10 - 3), (16 + 5 + 3, 25 - 6), (-28 + 8 + 0.0045, 40 - 0.009)], 1e-5)
        for behind in "", "\n", "\n1 2 3\n4 5 6\n", "\n1 2 3\n4 5 6\n7 8\n", "\nabc\n", "\n 20 20 20\n 1 2 3 4 5\n":
            self.assertEqual(velocities(POSCAR + behind, "vx", "vy"), [(None, None)] * 3)
            self.check(POSCAR + behind)

    def test_trajectories(self):
        head, rows = POSCAR.split("Direct\n")
        moved = rows.replace("0.25 0.5 0.75", "0.5 0.5 0.75")
        text = head + "Direct configuration=     1\n" + rows + "Direct configuration=     2\n" + moved
        changed = text + head.replace("\n2.0\n", "\n4.0\n") + "Direct configuration=     3\n" + rows
        for content, count in ((text, 2), (changed, 3), (text + "Direct configuration=     3\n0.1 0.2 0.3\n", 2)):
            path = self.write("XDATCAR", content)
            frames = [self.list(path, i) for i in range(count)]
            self.assertEqual([f.head["frames"] for f in frames], [count] * count)
            self.near(frames[0].places(), PLACES, 1e-9)
            self.near(frames[1].places(), [(2.875, 1.75, 4.5), *PLACES[1:]], 1e-9)
            self.near(self.list(path, -count).places(), PLACES, 1e-9)
            self.assertIn("the first of several frames", frames[0].head["notes"])
            if count == 3:
                self.near(frames[2].places(), [tuple(2 * x for x in p) for p in PLACES], 1e-9)
                self.near(frames[2].head["cell"][:3], [tuple(2 * x for x in e) for e in EDGES], 1e-9)

    def test_refusals(self):
        def refuse(old, new, *says):
            self.refuse("POSCAR", POSCAR.replace(old, new), *says)
        refuse("\n2.0\n", "\nx\n", "POSCAR:2:", '"x"', "the scale")
        refuse("\n2.0\n", "\n0\n", "POSCAR:2:", "the scale")
        refuse("\n2.0\n", "\n1 -1 1\n", "POSCAR:2:", '"-1"', "three above 0")
        refuse("0.5 2.5 0.0", "0.5 2.5", "POSCAR:4:", "an edge of the cell: three numbers")
        refuse("0.5 2.5 0.0", "1 0 0", "POSCAR:5:", "span no volume")
        refuse("1 2\n", "1\n", "POSCAR:7:", "found 1 number of atoms, expected 2")
        refuse("1 2\n", "1 2 3\n", "POSCAR:7:", "found 3 numbers of atoms, expected 2")
        refuse("1 2\n", "0 0\n", "POSCAR:7:", "add up to 0")
        refuse("1 2\n", "1 -2\n", "POSCAR:7:", '"-2"')
        refuse("1 2\n", "1 200000000\n", "POSCAR:7:", '"200000000"')
        refuse("1 2\n", "1 3\n", "the end of the file, expected 4 atoms")
        refuse("Direct", "Nothing", "POSCAR:8:", '"Nothing"', '"Direct" or "Cartesian"')
        refuse("-0.5 0.0 1.25", "-0.5 0.0 x", "POSCAR:10:", '"x"', "the place of an atom")
        refuse("Na Cl\n", " ".join(["Na"] * 300) + "\n", "POSCAR:6:", "at most 256")
        self.refuse("POSCAR", "", "expected the title")
        self.refuse("POSCAR", "a\n", "the scale of the cell")
        self.refuse("POSCAR", POSCAR, 'no column "x"', "vx, vy, vz", arguments=(0, "x"))


class Independent(CrystalTest):
    def beside(self, reader, path, tolerance):
        """Our atoms and theirs: each of one has one of the other, of the same element, in some image of the cell."""
        ours, theirs = self.list(path), self.ask(reader, path)
        if theirs is None:
            return 0
        edges = ours.head["cell"][:3]
        shown = [a for a in ours.atoms if reader != "ase-crystal" or not a.flags & ALTERNATIVE]
        left = {}
        for *share, element in theirs["atoms"]:
            left.setdefault(element, []).append(share)
        self.assertEqual(len(shown), len(theirs["atoms"]), path)
        for atom in shown:
            own = self.shares(edges, atom[:3])
            def distance(share):
                d = [s - o - round(s - o) for s, o in zip(share, own)]
                return math.dist([0, 0, 0], [sum(d[e] * edges[e][k] for e in range(3)) for k in range(3)])
            candidates = left.get(atom.element, [])
            near = min(candidates, key=distance, default=None)
            self.assertTrue(near is not None and distance(near) < tolerance, (path, atom, near and distance(near)))
            candidates.remove(near)
        return len(shown)

    def test_all_settings(self):
        """The operations of every setting of gemmi's table, with sites at general and at simple places, which are often special."""
        settings = self.ask("gemmi-settings", "")
        self.assertGreater(len(settings), 500)
        random.seed(5)
        for name, texts in random.sample(settings, 120):
            box = ((11, 12, 13), (90, 90, 120 if "-y" in name or "x-y" in " ".join(texts) else 90))
            if "x-y" in " ".join(texts) or "y,z,x" in texts or "z,x,y" in texts:
                box = ((12, 12, 12), (90, 90, 120 if "x-y" in " ".join(texts) else 90))
            places = [[round(random.random(), 4) for _ in range(3)]] + [random.choices(("0", "0.5", "0.25", "0.3333", "0.6667", "0.75", "0.125"), k=3) for _ in range(2)]
            rows = [(f"{e}1", e, *place) for e, place in zip(("C", "N", "O"), places)]
            self.beside("gemmi-crystal", self.write("a.cif", crystal(box, texts, *rows)), 6e-3)

    def test_structures_of_vasp(self):
        """What ASE writes: shares and Cartesian, sorted or not; and what it reads of ours, for each kind of scale."""
        for path, expected in self.ask("ase-poscar", self.folder):
            found = self.list(path)
            self.near(found.head["cell"][:3], expected["cell"], 1e-9)
            self.near(found.places(), expected["places"], 1e-8)
            self.assertEqual(found.of("element"), expected["elements"])

    def test_real_files(self):
        """Minerals of the Crystallography Open Database, which come with ASE."""
        folder = self.ask("ase-folder", "")
        if not os.path.isdir(folder):
            self.skipTest("this version of ASE has no minerals")
        paths = sorted(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".cif"))
        self.assertGreater(len(paths), 3)
        for path in paths:
            self.assertGreater(self.beside("gemmi-crystal", path, 2e-3), 0)
            self.assertGreater(self.beside("ase-crystal", path, 2e-3), 0)


if __name__ == "__main__":
    listed.main()
