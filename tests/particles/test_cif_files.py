"""mmCIF files: tables and items, values of all forms, cells in frames of their own, blocks and models; beside gemmi too. See
listed.py."""
import itertools

import listed
from test_pdb_files import CELLS, TURNS, apply, inverse, shares_of, standard

NAMES = ["group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id", "label_asym_id", "auth_seq_id", "Cartn_x", "Cartn_y",
         "Cartn_z", "occupancy", "pdbx_PDB_model_num"]


def rows(*values):
    """A table of atoms: each as (x, y, z) or such with other fields."""
    lines = []
    for i, value in enumerate(values):
        place, more = (value, {}) if len(value) == 3 else (value[:3], value[3])
        fields = dict(zip(NAMES, ["ATOM", i + 1, "C", "CA", ".", "ALA", "A", i + 1, *place, "1.00", 1]), **more)
        lines.append(" ".join(str(fields[name]) for name in NAMES))
    return "loop_\n" + "".join(f"_atom_site.{name}\n" for name in NAMES) + "\n".join(lines) + "\n#\n"


def items(category, values):
    return "".join(f"_{category}.{name:<30s} {value}\n" for name, value in values.items())


def cell(lengths, angles):
    return items("cell", dict(zip(["length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"], [*lengths, *angles])))


def transformation(kind, matrix, vector, form="{:.9f}"):
    numbers = {f"{kind}_transf_matrix[{i + 1}][{k + 1}]": form.format(matrix[i][k]) for i in range(3) for k in range(3)}
    return dict(numbers, **{f"{kind}_transf_vector[{i + 1}]": form.format(vector[i]) for i in range(3)})


def fract(edges, origin, form="{:.9f}"):
    shares = shares_of(edges, origin)
    return transformation("fract", [row[:3] for row in shares], [row[3] for row in shares], form)


def cartn(edges, origin, form="{:.9f}"):
    return transformation("Cartn", [[edges[k][i] for k in range(3)] for i in range(3)], origin, form)


ONE = {"group_PDB": "HETATM", "type_symbol": "ZN", "label_atom_id": "ZN", "label_comp_id": "ZN", "Cartn_x": "-3.5", "Cartn_y": "1.25(2)",
       "Cartn_z": "4"}


class Cif(listed.ListTest):
    def test_one_row_without_loop(self):
        """A category of one row, as items: anywhere in its block, also mixed with others, and before or behind the cell."""
        for text in ("data_x\n" + items("atom_site", ONE), "data_x\n" + items("atom_site", ONE) + "#\nloop_\n_x.a\n1\n2\n",
                     "data_x\nloop_\n_x.a\n1\n2\n" + items("ATOM_SITE", {k.upper(): v for k, v in ONE.items()}),
                     "data_x\n" + "".join(f"{line}\n_y.{i} '_z'\n" for i, line in enumerate(items("atom_site", ONE).splitlines()))):
            for before, behind in itertools.product(("", cell((20, 30, 40), (90, 90, 90))), repeat=2):
                found = self.of("a.cif", text.replace("data_x\n", "data_x\n" + before) + behind)
                self.assertEqual((found.head["frames"], len(found.atoms), "cell" in found.head), (1, 1, bool(before or behind)), text)
                self.assertEqual(found.atoms[0][:5], (-3.5, 1.25, 4, "Zn", 0))
        del_z = {k: v for k, v in ONE.items() if k != "Cartn_z"}
        self.refuse("a.cif", "data_x\n" + items("atom_site", del_z), "no _atom_site.Cartn_z")

    def test_uncertainties(self):
        """Numbers with their standard uncertainty in brackets, wherever numbers are."""
        text = "data_x\n" + cell(("20.5(3)", "30.25(12)", "4.01(10)"), ("90", "100.0(5)", "90.000(2)")) + \
            rows(("0.00(3)", "-10.123(12)", "4(1)", {"occupancy": "0.5(1)"}), ("1.5e1(2)", ".5(3)", "-1.(2)"))
        found = self.of("a.cif", text, 0, "occupancy")
        self.near(found.places(), [(0, -10.123, 4), (15, 0.5, -1)])
        self.assertEqual(found.of("first"), [0.5, 1])
        self.near(found.head["cell"][:3], standard((20.5, 30.25, 4.01), (90, 100, 90)))
        for wrong in ("1.0(", "1.0()", "1.0(x)", "1.0(2)3", "(2)", "1.0(2))", "inf(1)", "1(-2)"):
            self.refuse("a.cif", "data_x\n" + rows((wrong, 0, 0)), "found \"" + wrong, "a coordinate")

    def test_charges_of_symbols(self):
        """As small-molecule CIF has them: the element's symbol, and its charge."""
        for symbol, element in ("Fe3+", "Fe"), ("O1-", "O"), ("'Na+'", "Na"), ("D", "H"), ("Q", ""):
            found = self.of("a.cif", "data_x\n" + items("atom_site", dict(ONE, type_symbol=symbol, label_atom_id="Q", label_comp_id="LIG")))
            self.assertEqual(found.of("element"), [element], symbol)

    def test_unknown_values(self):
        """"." and "?" stand for none: in the author's fields the other ones stand in, and an atom without a place is left out."""
        text = "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in "auth_atom_id label_atom_id auth_asym_id label_asym_id auth_seq_id "
                                           "label_seq_id type_symbol Cartn_x Cartn_y Cartn_z".split())
        text += "? CA . A ? 7 ? 1 2 3\nCB CX B A 8 9 N 4 5 6\n. O A A 1 1 O ? 0 0\nN N A A 1 1 N 0 0 .\n"
        found = self.of("a.cif", text, 0, "residue_number")
        self.assertEqual([(a.name, a.chain, a.first, a.element, a.x) for a in found.atoms], [("CA", "A", 7, "C", 1), ("CB", "B", 8, "N", 4)])
        self.assertIn("2 points without a place left out", found.head["notes"])
        self.refuse("a.cif", "data_x\n" + rows(("?", "?", "?")), "no atom with a place")

    def test_names_in_quotes(self):
        names = [("\"O5'\"", "O5'"), ("'C1\"'", "C1\""), ("O5'", "O5'"), ("'a b'", "a b"), ("\n;C7\n;", "C7"), ("'it's'", "it's"), ("\"_x\"", "_x"),
                 ("'loop_'", "loop_"), ("'#1'", "#1"), ("C#1", "C#1")]
        found = self.of("a.cif", "data_x\n" + rows(*[(i, 0, 0, {"label_atom_id": quoted}) for i, (quoted, _) in enumerate(names)]))
        self.assertEqual(found.of("name"), [plain for _, plain in names])
        self.assertEqual([a.x for a in found.atoms], list(range(len(names))))

    def test_tables_in_pieces(self):
        """Comments, blank lines, ends of lines, rows over lines, case of names and keywords, frames of dictionaries, wide tables."""
        text = "data_x\n" + rows((1, 2, 3), (4, 5, 6))
        plain = self.of("a.cif", text)
        head, body = text.split("_atom_site.pdbx_PDB_model_num\n")
        save = "save_other\n_atom_site.Cartn_x 7\nloop_\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n8 9\nsave_\n"
        wide = "loop_\n" + "".join(f"_wide.c{i}\n" for i in range(300)) + " ".join(map(str, range(600))) + "\n"
        for other in (head + "_atom_site.pdbx_PDB_model_num\n# 1 2 3\n\n" + body, text.replace(" 4 5 6", " 4\n# 9 9\n5\n\n6"), text.upper().replace("CARTN", "cArTn"),
                      text.replace("\n", "\r\n"), text.replace("data_x\n", "data_x\n" + save), text.replace("data_x\n", "# c\n\ndata_x\n" + wide),
                      text.replace("data_x\n", "data_x\n_a.text\n;a\ndata_y\nloop_\n_atom_site.Cartn_x\n;\n_a.b '#'\n"),
                      text.replace("data_x\n", "data_x\nloop_\n_a.b\n;\n1\n;\n'_atom_site.Cartn_x'\n")):
            found = self.of("a.cif", other)
            self.assertEqual((found.places(), found.of("name"), found.head["frames"]), (plain.places(), plain.of("name"), 1), other)

    def test_blocks_and_models(self):
        """Each model is a frame, and so is each block that has atoms, with its own cell."""
        def block(name, x, lengths=None):
            return f"data_{name}\n" + (cell(lengths, (90, 90, 90)) if lengths else "_a.b 1\n") + rows((x, 0, 0), (x + 1, 0, 0, {"pdbx_PDB_model_num": 2}))
        text = block("a", 1, (20, 30, 40)) + "data_none\nloop_\n_x.y\n1\n" + block("b", 3) + "data_c\n" + items("atom_site", dict(ONE, Cartn_x=5)) + block("d", 6, (50, 60, 70))
        path = self.write("a.cif", text + "data_last\n_a.b 1\n")
        expected = [(1, 20), (2, 20), (3, None), (4, None), (5, None), (6, 50), (7, 50)]
        for i, (x, length) in [*enumerate(expected), (-1, expected[-1]), (-7, expected[0])]:
            found = self.list(path, i)
            self.assertEqual((found.head["frames"], found.places()[0][0], found.head.get("cell", [[None]])[0][0]), (7, x, length), i)
        # What follows is no fault of the first.
        core = "data_y\nloop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.5\n"
        self.assertEqual(self.of("a.cif", block("a", 1) + core + "data_z\nloop_\n_atom_site.id\n1\n").head["frames"], 2)
        self.refuse("a.cif", core, "fractions of a cell")
        self.refuse("a.cif", core.replace("loop_\n_atom_site_label\n_atom_site_fract_x\nC1 0.5\n", "_atom_site_fract_x 0.5\n"), "fractions of a cell")

    def test_models_in_turns(self):
        """The rows of a model need not stand together: frames are the models in the order of their first rows."""
        def table(models, begin=0):
            return rows(*((begin + i, 0, 0, {"pdbx_PDB_model_num": model}) for i, model in enumerate(models)))

        def frames(text):
            path = self.write("a.cif", text)
            count = self.list(path).head["frames"]
            forwards = [[x for x, _, _ in self.list(path, i).places()] for i in range(count)]
            self.assertEqual(forwards, [[x for x, _, _ in self.list(path, i - count).places()] for i in range(count)])
            return forwards
        for models in ([1, 2], [1, 2, 1, 2], [2, 1, 1, 2, 3], [1, 1, 2, 2, 3, 3], [1, 2, 3] * 40, [5, 5, 4, 5], [1, 2, 3, 4, 1], [1, 1]):
            by_model = {}
            for i, model in enumerate(models):
                by_model.setdefault(model, []).append(i)
            expected = list(by_model.values())
            self.assertEqual(frames("data_x\n" + table(models)), expected, models)
            around = "data_w\n" + table([7, 8, 7], 500) + "data_x\n" + table(models) + "data_y\n" + items("atom_site", dict(ONE, Cartn_x=600))
            self.assertEqual(frames(around + "data_z\n" + table([1, 2, 1], 700)), [[500, 502], [501], *expected, [600], [700, 702], [701]], models)
        behind = "data_x\n" + table([1, 2, 1, 2]) + cell((20, 30, 40), (90, 90, 90))
        self.assertEqual([self.of("a.cif", behind, i).head["cell"][2][2] for i in (0, 1)], [40, 40])
        # A place of one model is none of another's.
        alternative = "data_x\n" + rows(*((i, 0, 0, {"pdbx_PDB_model_num": i % 2, "label_alt_id": "AABB"[i], "auth_seq_id": 1}) for i in range(4)))
        self.assertEqual([self.of("a.cif", alternative, i).of("flags") for i in (0, 1)], [[0, 1], [0, 1]])

    def check(self, text, edges, origin, tolerance):
        found = self.of("a.cif", text)
        self.assertTrue(found.head["repeats"])
        self.near(found.head["cell"][:3], edges, tolerance)
        self.near(found.head["cell"][3], origin, tolerance)
        self.assertEqual(found.places(), [(1, 2, 3)])

    def test_cells_in_frames_of_their_own(self):
        """Both transformations, also in a table, before and behind the atoms."""
        for (lengths, angles), turn in itertools.product(CELLS, TURNS):
            edges = [apply(turn, e) for e in standard(lengths, angles)]
            origin = [1.5, -2.25, 30]
            for given in (fract(edges, origin), cartn(edges, origin)):
                lies = items("atom_sites", given)
                table = "loop_\n" + "".join(f"_atom_sites.{name}\n" for name in given) + " ".join(given.values()) + "\n"
                for parts in ([cell(lengths, angles), lies, "A"], ["A", cell(lengths, angles), lies], [cell(lengths, angles), "A", lies], [table, cell(lengths, angles), "A"]):
                    text = "data_x\n" + "".join(rows((1, 2, 3)) if part == "A" else part for part in parts)
                    self.check(text, edges, origin, 1e-5 * max(lengths))

    def test_what_tells_nothing(self):
        lengths, angles = CELLS[1]
        edges = standard(lengths, angles)
        unit = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]
        for given in (fract(unit, [0, 0, 0]), cartn(unit, [0, 0, 0]), cartn([[1.1 * x for x in e] for e in edges], [0, 0, 0])):
            head = self.of("a.cif", "data_x\n" + cell(lengths, angles) + items("atom_sites", given) + rows((1, 2, 3))).head
            self.assertEqual((head["repeats"], "_atom_sites contradicts the cell" in head["notes"]), (False, True))
        for given in (fract(edges, [0, 0, 0], "{:.6f}"), cartn(edges, [0, 0, 0], "{:.3f}"), {f"fract_transf_matrix[{i}][{k}]": "?" for i in (1, 2, 3) for k in (1, 2, 3)},
                      {"fract_transf_matrix[0][1]": 5, "fract_transf_matrix[1][4]": 5, "fract_transf_vector[4]": 5, "Cartn_transform_axes": "?"}):
            head = self.of("a.cif", "data_x\n" + cell(lengths, angles) + items("atom_sites", given) + rows((1, 2, 3))).head
            self.assertEqual((head["repeats"], head["notes"]), (True, ""))
            self.near(head["cell"][:3], edges, 1e-9)
        self.near(inverse([[edges[k][i] for k in range(3)] for i in range(3)]), [row[:3] for row in shares_of(edges, [0, 0, 0])], 1e-12)


class Independent(listed.ListTest):
    def test_turned_cells(self):
        for (lengths, angles), turn in itertools.product(CELLS[:4], TURNS[:3]):
            edges = [apply(turn, e) for e in standard(lengths, angles)]
            path = self.write("a.cif", "data_x\n" + cell(lengths, angles) + items("atom_sites", fract(edges, [4, 5, 6])) + rows(("1.5(2)", 2, 3)))
            ours, theirs = self.list(path), self.ask("gemmi", path)
            self.near(ours.head["cell"], theirs["cell"], 1e-3)
            self.near(ours.places(), [a[:3] for a in theirs["atoms"]])


if __name__ == "__main__":
    listed.main()
