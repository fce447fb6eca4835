"""Expressions over particles: random ones beside Python's own evaluation, `within` beside all pairs in all images, words of real
files beside MDAnalysis, errors by their place.

Run as: PYTHONPATH=tests/support python3 test_select.py particle_select [Class ...]
BALLPARK_READERS_PYTHON names the Python that has MDAnalysis and its tests' files, where it is not this one.
"""
import itertools
import json
import math
import os
import random
import subprocess

import listed
from listed import ListTest

COLUMNS = "abc"
HERE = os.path.dirname(os.path.abspath(__file__))


class SelectTest(ListTest):
    def ask_for(self, path, expression, kind="truth", frame=0):
        result = self.answer(path, frame, kind, expression)
        self.assertEqual(result.returncode, 0, (expression, result.stderr))
        return json.loads(result.stdout)

    def select(self, path, expression, frame=0):
        """The numbers of the particles; [] where the program says that there are none."""
        result = self.answer(path, frame, "truth", expression)
        if result.returncode == 1 and result.stderr.startswith("found no particle for which this holds: "):
            return []
        self.assertEqual(result.returncode, 0, (expression, result.stderr))
        return json.loads(result.stdout)

    def refused(self, path, expression, kind="truth"):
        result = self.answer(path, 0, kind, expression)
        self.assertEqual(result.returncode, 1, (expression, result.stdout))
        return result.stderr


def table(rows, names=COLUMNS):
    """A CSV file whose particles lie apart."""
    lines = ["x,y,z," + ",".join(names)]
    lines += [f"{i},{i * i % 7},{-i}," + ",".join(repr(value) for value in row) for i, row in enumerate(rows)]
    return "\n".join(lines) + "\n"


class Grammar(SelectTest):
    """Random expressions, as texts without any parentheses that the grammar does not ask for, beside Python's eval()."""

    def setUp(self):
        super().setUp()
        self.random = random.Random(20)

    def number(self, depth):
        """An expression that is a number, in Python's words."""
        pick = self.random.random()
        if depth == 0 or pick < 0.25:
            return self.random.choice([*COLUMNS, "x", "y", "z", "index", str(self.random.randint(0, 9)), "0.5", "2.25", "1e1", ".125"])
        one, other = self.number(depth - 1), self.number(depth - 1)
        if pick < 0.65:
            return f"{one} {self.random.choice('+-*')} {other}"
        if pick < 0.72:
            return f"({one}) {self.random.choice(['/', '%'])} {self.random.choice(['4', '0.75', '-8', '(-3)'])}"
        if pick < 0.78:
            return f"-{one}"
        if pick < 0.84:
            return f"{self.random.choice([*COLUMNS, '(' + one + ')', '2', '-3'])} ** 2{self.random.choice(['', '** 2', ' ** 1'])}"
        if pick < 0.94:
            return f"({one})"
        return self.random.choice([f"abs({one})", f"min({one}, {other})", f"max({one}, {other}, 3)", f"floor({one})", f"ceil({one})",
                                   f"round({one})", f"sqrt(abs({one}))", f"norm({one}, {other})"])

    def truth(self, depth):
        pick = self.random.random()
        if depth == 0 or pick < 0.3:
            signs = ("<", "<=", ">", ">=", "==", "!=")
            if self.random.random() < 0.15:
                return f"{self.number(1)} {self.random.choice(['in', 'not in'])} ({', '.join(str(self.random.randint(-3, 9)) for _ in range(3))})"
            many = 2 if self.random.random() < 0.8 else 3
            return "".join(self.number(2) + (f" {self.random.choice(signs)} " if k < many - 1 else "") for k in range(many))
        if pick < 0.75:
            return f"{self.truth(depth - 1)} {self.random.choice(['and', 'or'])} {self.truth(depth - 1)}"
        return f"not {self.truth(depth - 1)}" if pick < 0.9 else f"({self.truth(depth - 1)})"

    MEANING = {"abs": abs, "min": min, "max": max, "floor": math.floor, "ceil": math.ceil, "round": round, "sqrt": math.sqrt,
               "norm": lambda *v: math.sqrt(sum(x * x for x in v))}

    def expected(self, expression, rows):
        code = compile(expression, "expression", "eval")
        return [eval(code, {"__builtins__": {}}, dict(self.MEANING, x=i, y=i * i % 7, z=-i, index=i, **dict(zip(COLUMNS, row))))
                for i, row in enumerate(rows)]

    def test_random_expressions(self):
        rows = [[self.random.choice([0.0, 1.0, -2.0, 0.5, 3.0, 7.0, -0.25]) for _ in COLUMNS] for _ in range(40)]
        path, some = self.write("a.csv", table(rows)), 0
        for _ in range(1500):
            expression = self.truth(self.random.randint(1, 4))
            found = self.select(path, expression)
            self.assertEqual(found, [i for i, holds in enumerate(self.expected(expression, rows)) if holds], expression)
            some += 0 < len(found) < len(rows)
        self.assertGreater(some, 500)
        for _ in range(1500):
            expression = self.number(self.random.randint(1, 5))
            found, expected = self.ask_for(path, expression, "number"), self.expected(expression, rows)
            for a, b in zip(found, expected):
                self.assertLessEqual(abs(a - b), 1e-12 * abs(b), (expression, a, b))

    def test_other_spellings(self):
        path = self.write("a.csv", table([[float(i), 0.0, 0.0] for i in range(9)]))
        for one, other in [("a > 2 && !(a > 5) || a == 0", "a > 2 and not (a > 5) or a == 0"), ("a^2 == 9", "a ** 2 == 9"),
                           ("2 < a < 5", "2 < a and a < 5"), ("a not in (1, 2)", "not a in (1, 2)"), (" a>3 ", "a > 3"),
                           ("column(\"a\") > 3", "a > 3"), ("column('a')>+3", "a > 3"), ("-2^2 < a - 5 < 1", "0 - 4 < a - 5 and a < 6"),
                           ("2^3^2 - 511 == a", "a == 1"), ("all and a < 3", "a < 3"), ("none or a < 3", "a < 3")]:
            found = self.select(path, one)
            self.assertEqual(found, self.select(path, other), one)
            self.assertTrue(0 < len(found) < 9, one)

    def test_functions(self):
        values = [0.25, 1.0, 2.5, 40.0]
        path = self.write("a.csv", table([[v, -v, 3.0] for v in values]))
        for name, function in [("sqrt", math.sqrt), ("exp", math.exp), ("log", math.log), ("log10", math.log10), ("sin", math.sin),
                               ("cos", math.cos), ("tan", math.tan), ("floor", math.floor), ("ceil", math.ceil), ("round", round),
                               ("abs", abs)]:
            self.near(self.ask_for(path, f"{name}(a)", "number"), [function(v) for v in values], 1e-9 * math.exp(40))
            self.near([self.ask_for(path, f"{name}(a)", "number")[2]], [function(2.5)], 1e-15 * 20)
        self.near(self.ask_for(path, "atan2(a, b)", "number"), [math.atan2(v, -v) for v in values], 1e-15)
        self.near(self.ask_for(path, "norm(a, b, c)", "number"), [math.sqrt(2 * v * v + 9) for v in values], 1e-13)

    def test_missing_values(self):
        """They are unequal to all, and neither less nor greater."""
        path = self.write("a.csv", "x,y,z,a\n0,0,0,1\n1,0,0,\n2,0,0,nan\n3,0,0,4\n")
        self.assertEqual(self.select(path, "a > 0"), [0, 3])
        self.assertEqual(self.select(path, "a <= 1"), [0])
        self.assertEqual(self.select(path, "a != 1"), [1, 2, 3])
        self.assertEqual(self.select(path, "not a > 0"), [1, 2])
        self.assertEqual(self.select(path, "a == a"), [0, 3])
        self.assertEqual(self.select(path, "max(a, 9) == 9"), [0, 3])
        self.assertEqual(self.select(path, "a in (1, 4)"), [0, 3])

    def test_deep_and_long_ones_end(self):
        path = self.write("a.csv", table([[float(i), 0.0, 0.0] for i in range(700)]))
        self.assertEqual(self.select(path, "(" * 50 + "a > 697" + ")" * 50), [698, 699])
        for deep in ("(" * 2000 + "a", "not " * 1000 + "a > 1", "-" * 3000 + "a > 1", "2^" * 1500 + "a > 1", "abs(" * 900 + "a",
                     "within 1 of " * 300 + "a > 1"):
            self.assertIn("levels of parentheses and signs", self.refused(path, deep))
        self.assertEqual(self.select(path, "+".join(["a"] * 1500) + " > 1048000"), [699])
        self.assertEqual(self.select(path, " or ".join(f"a=={k}" for k in range(400))), list(range(400)))
        self.assertEqual(self.select(path, f"a in ({','.join(map(str, range(600, 0, -1)))})"), list(range(1, 601)))
        self.assertIn("expected at most 4096", self.refused(path, "a > 1 " + " " * 4096))


def atom(i, name, residue, place, chain="A", number=1, element="", record="ATOM"):
    return (f"{record:6s}{i + 1:5d} {name:4s} {residue:>3s} {chain}{number:4d}    {place[0]:8.3f}{place[1]:8.3f}{place[2]:8.3f}"
            f"  1.00{10 + i:6.2f}          {element:>2s}\n")


class Words(SelectTest):
    def test_words_of_molecules(self):
        rows = [(" N  ", "ALA", "N"), (" CA ", "ALA", "C"), (" C  ", "ALA", "C"), (" O  ", "ALA", "O"), (" CB ", "ALA", "C"),
                (" HA ", "ALA", "H"), (" P  ", " DA", "P"), (" O  ", "HOH", "O"), (" H1 ", "HOH", "H"), ("NA  ", " NA", "NA"),
                (" C1 ", "LIG", "C"), ("FE  ", "HEM", "FE"), (" CA ", "LIG", "C"), ("CA  ", " CA", "CA")]
        text = "".join(atom(i, name, residue, (3 * i, 0, 0), "AB"[i > 6], i, element, "HETATM" if i > 6 else "ATOM")
                       for i, (name, residue, element) in enumerate(rows))
        path = self.write("a.pdb", text)
        for expression, expected in [
                ("all", range(14)), ("hydrogen", (5, 8)), ("water", (7, 8)), ("ion", (9,)), ("solvent", (7, 8, 9)),
                ("protein", range(6)), ("nucleic", (6,)), ("backbone", (0, 1, 2, 3)), ("ligand", (10, 11, 12, 13)), ("hetero", range(7, 14)),
                ("hetero and not solvent", (10, 11, 12, 13)), ('chain == "B"', range(7, 14)), ("chain == A and not hydrogen", (0, 1, 2, 3, 4, 6)),
                ("B == chain", range(7, 14)), ("chain != A", range(7, 14)), ("resname in (LIG, HEM)", (10, 11, 12)),
                ("resname not in (ALA, LIG, HEM, 'DA')", (7, 8, 9, 13)), ("element == Fe", (11,)), ("element == \"FE\"", (11,)),
                ("element in (ca, NA)", (9, 13)), ("name == CA", (1, 12, 13)), ("name == ca", ()), ("chain == a", ()), ("resname == ala", ()),
                ("name == resname", (9, 13)), ("name == 'CA' and element == C", (1, 12)), ("index < 2", (0, 1)), ("index in (0, 13)", (0, 13)),
                ("3 <= resid <= 5", (3, 4, 5)), ("residue_number == 9", (9,)), ("bfactor > 21.5", (12, 13)), ("x >= 36 and y == 0", (12, 13)),
                ("index % 5 == 3", (3, 8, 13)), ('element == ""', ()), ("name in (N)", (0,))]:
            self.assertEqual(self.select(path, expression), list(expected), expression)

    def test_numbers_are_doubles(self):
        """A column is compared as it is written, not as a float that is nearest to it."""
        path = self.write("a.csv", "x,y,z,q,id\n0,0,0,0.1,16777216\n1,0,0,0.2,16777217\n2,0,0,-0.3,16777218\n")
        self.assertEqual(self.select(path, "q == 0.1"), [0])
        self.assertEqual(self.select(path, "q in (0.2, -0.3)"), [1, 2])
        self.assertEqual(self.select(path, "id == 16777217"), [1])

    def test_types_are_numbers_or_names(self):
        dump = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS id type x y z c_s[1] v-w\n"
                "1 2 1 1 1 5 1\n2 10 2 2 12 6 2\n3 2 3 3 13 7 3\n4 1 4 4 14 8 4\n")
        path = self.write("a.dump", dump)
        for expression, expected in [("type == 2 and z > 10", [2]), ("type == \"2\"", [0, 2]), ("type in (2, 1)", [0, 2, 3]),
                                     ("type in ('10')", [1]), ("type > 1.5", [0, 1, 2]), ("2 * type == 20", [1]), ("2 < type < 11", [1]),
                                     ("c_s[1] > 6", [2, 3]), ('column("v-w") >= 3', [2, 3]), ("id == 1", [0]), ("type != 2", [1, 3])]:
            self.assertEqual(self.select(path, expression), expected, expression)
        xyz = self.write("a.extxyz", "3\nProperties=type:S:1:pos:R:3\nA 0 0 0\nB 1 0 0\n7 2 0 0\n")
        self.assertEqual(self.select(xyz, "type == A"), [0])
        self.assertEqual(self.select(xyz, "type == 7"), [2])
        self.assertEqual(self.select(xyz, "type < 8"), [2])
        self.assertEqual(self.select(xyz, "not type < 8"), [0, 1])

    def test_index_counts_what_has_no_place(self):
        """It is the number in the file, from 0, also behind particles that are left out."""
        path = self.write("a.csv", "x,y,z\nnan,0,0\n" + "".join(f"{i},0,{'nan' if i % 97 == 3 else 0}\n" for i in range(1, 1200)))
        kept = [i for i in range(1, 1200) if i % 97 != 3]
        self.assertEqual(self.ask_for(path, "index", "number"), kept)
        self.assertEqual(self.select(path, "index == 1199"), [len(kept) - 1])
        self.assertEqual(self.select(path, "index == 0"), [])

    def test_frames(self):
        path = self.write("a.xyz", "".join(f"3\n\nC {k} 0 0\nC {k + 1} 0 0\nO {k + 2} 0 0\n" for k in range(4)))
        self.assertEqual(self.select(path, "x > 2"), [])
        self.assertEqual(self.select(path, "x > 2", 1), [2])
        self.assertEqual(self.select(path, "x > 2", -1), [0, 1, 2])


class Within(SelectTest):
    SHAPES = [None, ((10, 0, 0), (0, 8, 0), (0, 0, 9)), ((10, 0, 0), (3, 8, 0), (-2, 1, 9)), ((9, 1, -1), (-1, 10, 2), (2, 0, 30)),
              ((4, 0, 0), (3.9, 1.5, 0), (1, 1, 20)), ((40, 0, 0), (0, 1.2, 0), (0, 0, 1.4)), ((6, 0, 0), (-3, 5.2, 0), (0, 0, 2.5)),
              ((5, 0, 0), (4.4, 5, 0), (4.4, 4.4, 5))]

    @staticmethod
    def nearest(a, b, shape, periodic):
        """The square of the shortest way, by trying images; enough of them for these shapes."""
        if shape is None:
            return sum((p - q) ** 2 for p, q in zip(a, b))
        ranges = [range(-3, 4) if repeats else (0,) for repeats in periodic]
        if shape[0][0] == 40:
            ranges = [r if len(r) == 1 else range(-12, 13) if e else range(-1, 2) for e, r in enumerate(ranges)]
        return min(sum((p - q + sum(n * edge[c] for n, edge in zip(image, shape))) ** 2 for c, (p, q) in enumerate(zip(a, b)))
                   for image in itertools.product(*ranges))

    def test_beside_all_pairs(self):
        rng = random.Random(7)
        count, found_some = 24, 0
        for shape, periodic in itertools.product(self.SHAPES, [(1, 1, 1), (1, 1, 0), (0, 1, 0), (0, 0, 0)]):
            if shape is None and any(periodic):
                continue
            if shape is not None and shape[0][0] == 40 and not all(periodic):
                continue
            edges = shape or ((10, 0, 0), (0, 10, 0), (0, 0, 10))
            places = []
            for _ in range(count):
                shares = [1.6 * rng.random() - 0.3 for _ in range(3)]
                places.append([round(5 + sum(s * edge[c] for s, edge in zip(shares, edges)), 6) for c in range(3)])
            lattice = "" if shape is None else ('Lattice="' + " ".join(str(v) for edge in shape for v in edge) + '" pbc="'
                                                + " ".join("FT"[p] for p in periodic) + '" Origin="5 5 5" ')
            kinds = ["C" if rng.random() < 0.15 else "O" for _ in range(count)]
            kinds[0] = "C"
            path = self.write("a.extxyz", f"{count}\n{lattice}Properties=species:S:1:pos:R:3\n"
                              + "".join(f"{k} {x} {y} {z}\n" for k, (x, y, z) in zip(kinds, places)))
            carbons = [p for k, p in zip(kinds, places) if k == "C"]
            least = [min(self.nearest(p, q, shape, periodic) for q in carbons) for p in places]
            for reach in (0.3, 0.9, 1.7, 3.1, 5.5, 30):
                self.assertFalse(any(abs(square - reach * reach) < 1e-9 for square in least if square > 0))
                found = self.select(path, f"within {reach} of element == C")
                self.assertEqual(found, [i for i, square in enumerate(least) if square <= reach * reach], (shape, periodic, reach))
                found_some += len(carbons) < len(found) < count
                # It holds for those it is measured from, binds as `not` does, and may stand in another.
                self.assertEqual(self.select(path, f"within {reach} of element == C and element == O"),
                                 [i for i in found if kinds[i] == "O"])
        self.assertGreater(found_some, 40)

    def test_reach_belongs_to_it(self):
        path = self.write("a.xyz", "4\n\nC 0 0 0\nO 3 4 0\nO 0 0 5.000001\nO 10 0 0\n")
        self.assertEqual(self.select(path, "within 5 of element == C"), [0, 1])
        self.assertEqual(self.select(path, "within 7.1 of within 5 of element == C"), [0, 1, 2])
        self.assertEqual(self.select(path, "within 7.1 of (within 5 of element == C) and not element == C"), [1, 2])
        self.assertEqual(self.select(path, "within 8.07 of within 5 of element == C"), [0, 1, 2, 3])
        self.assertEqual(self.select(path, "not within 5 of element == C"), [2, 3])
        self.assertEqual(self.select(path, "within 1 of none"), [])
        for far in ("1e300", "1e12", "11"):
            self.assertEqual(self.select(path, f"within {far} of element == C"), [0, 1, 2, 3])
        self.assertEqual(self.select(path, "within 1e-300 of element == C"), [0])

    def test_far_in_a_small_cell(self):
        """However many images lie within reach, the answer comes at once."""
        rows = "".join(f"{'CO'[k > 0]} {0.1 * (k % 10)} {0.1 * (k // 10 % 10)} {k % 3}\n" for k in range(300))
        for pbc in ("T T T", "T F F", "T T F"):
            path = self.write("a.extxyz", f'300\nLattice="1 0 0 0 1 0 0 0 1000" pbc="{pbc}" Properties=species:S:1:pos:R:3\n{rows}')
            self.assertEqual(len(self.select(path, "within 400 of element == C")), 300)
            self.assertEqual(self.select(path, "within 0.01 of element == C"), [0])


class Errors(SelectTest):
    def test_places(self):
        path = self.write("a.pdb", atom(0, " CA ", "ALA", (0, 0, 0), element="C") + atom(1, " N  ", "GLY", (9, 0, 0), "B", 2, "N"))
        for expression, place, marked, *says in [
                ('chain = "A"', 7, "=", '"=="'), ('chian == "A"', 1, "chian", 'did you mean "chain"?'), ("bfactr > 2", 1, "bfactr", 'did you mean "bfactor"?'),
                ("z > 3 an x < 2", 7, "an", "the end, and, or"), ("(z > 3", 7, "", 'expected ")"'), ("z > 3)", 6, ")", "the end"),
                ("z >", 4, "", "a number, a text"), ("", 1, "", "a condition"), ("z", 1, "z", "which is a number"), ("waters", 1, "waters", '"water"'),
                ("z > water", 5, "water", "which is a condition, expected a number"), ("name < CA", 1, "name < CA", "== or !="),
                ("chain == 1", 10, "1", 'expected a text, such as "1"'), ("resid == '5'", 1, "resid", "it is a number"),
                ("chain in (A, 2)", 14, "2", 'such as "2"'), ("resid in (1, A)", 14, "A", "expected a number"), ("chain in A", 10, "A", "a list in parentheses"),
                ("name == 'CA", 9, "'CA", "without its end"), ("resname == 2PG", 12, "2PG", 'in quotes: "2PG"'), ("z > 1e999", 5, "1e999", "too large"),
                ("sqt(x) > 1", 1, "sqt", 'did you mean "sqrt"?'), ("min(x) > 1", 1, "min(x)", "at least 2"), ("sqrt(x, y) > 1", 1, "sqrt(x, y)", "expected 1"),
                ("within z of water", 8, "z", "a distance above 0"), ("within 0 of water", 8, "0", "a distance above 0"), ("within 5 water", 10, "water", '"of"'),
                ("within 5 of z", 13, "z", "expected a condition"), ("type == 2", 1, "type", "no types"), ("radius > 2", 1, "radius", "no radii"),
                ("z > 2 # x", 7, "#", "expected a name"), ("foo > 1", 1, "foo", "one of occupancy, bfactor, residue_number"), ("not z", 5, "z", "a condition"),
                ("column(z) > 1", 8, "z", "in quotes"), ('"A" == "B"', 1, '"A" == "B"', "two texts"), ("x and y > 1", 1, "x", "which is a number"),
                ("chain == A  and zed > 1", 17, "zed", "found no column"), ("name == 'é' and ö > 1", 17, "ö", "found no column")]:
            message, _, drawing = self.refused(path, expression).partition("\n")
            self.assertTrue(message.startswith(f"at character {place}: "), (expression, message))
            for text in says:
                self.assertIn(text, message, expression)
            shown, marks = (drawing.rstrip("\n") + "\n").split("\n")[:2]
            self.assertEqual(shown.strip(), expression.strip(), expression)
            begin = len(marks) - len(marks.lstrip(" "))
            self.assertEqual((begin, len(marks.strip())), (4 + place - 1, max(1, len(marked))), expression)
            if marked:
                self.assertEqual(shown[begin:begin + len(marked)], marked, expression)

    def test_long_ones_are_shown_in_part(self):
        path = self.write("a.xyz", "1\n\nC 0 0 0\n")
        _, shown, marks = self.refused(path, "z > 0 and " * 100 + "foo > 1 " + " or z < 1" * 50).split("\n")[:3]
        self.assertLess(len(shown), 120)
        self.assertEqual(shown[marks.index("^"):][:3], "foo")
        self.assertEqual(marks.count("^"), 3)

    def test_values_when_nothing_is_selected(self):
        path = self.write("a.pdb", atom(0, " CA ", "ALA", (0, -3, 0), element="C") + atom(1, " N  ", "GLY", (9, 2.5, 0), "B", 2, "N"))
        message = self.refused(path, "chain == C or element == O and y > 3 and bfactor < 0")
        for text in ("for which this holds: chain == C or element == O", "; chain: A, B;", "; element: C, N", "; y: from -3 to 2.5;", "; bfactor: from 10 to 11"):
            self.assertIn(text, message)
        many = self.write("b.pdb", "".join(atom(i, " CA ", f"R{i}", (3 * i, 0, 0), element="C") for i in range(90)))
        self.assertIn("resname: R0, R1, R10,", self.refused(many, "resname == X"))
        self.assertIn(", ...\n", self.refused(many, "resname == X"))

    def test_values_must_be_numbers(self):
        path = self.write("a.csv", table([[1.0, 2.0, 3.0]]))
        self.assertIn("at character 1: found a > 1, which is a condition, expected a number", self.refused(path, "a > 1", "number"))
        self.assertIn("; did you mean", self.refused(path, "colunm('a')", "number"))


ORACLE = r"""
import json, sys, warnings
warnings.filterwarnings("ignore")
import MDAnalysis
universe = MDAnalysis.Universe(sys.argv[1])
universe.trajectory[0]
print(json.dumps([universe.select_atoms(*[text], periodic=True, updating=False).indices.tolist() if text != "" else [] for text in sys.argv[2:]]))
"""


GEMMI = r"""
import json, sys
import gemmi
model = gemmi.read_structure(sys.argv[1])[0]
atoms = sorted((atom.serial, chain.name, residue.name, residue.het_flag, atom.element.name, residue.seqid.num, atom.b_iso)
               for chain in model for residue in chain for atom in residue)
print(json.dumps(atoms))
"""
ASE = r"""
import json, sys
import ase.io
from ase.geometry import get_distances
atoms = ase.io.read(sys.argv[1])
own = [i for i, symbol in enumerate(atoms.symbols) if symbol == "C"]
_, lengths = get_distances(atoms.positions, atoms.positions[own], cell=atoms.cell, pbc=atoms.pbc)
print(json.dumps(lengths.min(axis=1).tolist()))
"""


class Independent(SelectTest):
    """Index by index beside MDAnalysis, on files of its own tests (its `around` leaves out what it is measured from), beside gemmi and
    beside ASE."""

    def said_by(self, code, *arguments):
        result = subprocess.run([listed.READERS_PYTHON, "-c", code, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                check=False)
        if "ModuleNotFoundError" in result.stderr:
            self.skipTest(f"{result.stderr.split()[-1]} is not installed for {listed.READERS_PYTHON}")
        self.assertEqual(result.returncode, 0, result.stderr[-2000:])
        return json.loads(result.stdout)

    def test_beside_gemmi(self):
        """mmCIF and PDB: chains, residues, records, elements, numbers and temperature factors."""
        folder, files = self.real_files(), 0
        for name in ("4x8u.pdbx", "mmcif/1YJP.cif", "mmcif/7ETN.cif.gz", "mmcif/1BD2.cif.gz", "1hvr.pdb", "4E43.pdb"):
            path = os.path.join(folder, name)
            if not os.path.exists(path):
                continue
            if name.endswith(".pdbx"):  # an ending that gemmi does not know
                with open(path, "rb") as file:
                    path = self.write("a.cif", file.read())
            atoms, files = self.said_by(GEMMI, path), files + 1
            chain, residue = atoms[0][1], atoms[len(atoms) // 2][2]
            for ours, holds in [(f'chain == "{chain}"', lambda a: a[1] == chain), (f'resname == "{residue}"', lambda a: a[2] == residue),
                                ("hetero", lambda a: a[3] == "H"), ("element in (N, O)", lambda a: a[4] in "NO"),
                                ("resid < 20 and not hetero", lambda a: a[5] < 20 and a[3] == "A"), ("20 < bfactor <= 30.5", lambda a: 20 < round(a[6], 3) <= 30.5)]:
                self.assertEqual(self.select(path, ours), [i for i, a in enumerate(atoms) if holds(a)], (name, ours))
        self.assertGreaterEqual(files, 3)

    def test_within_beside_ase(self):
        rng = random.Random(3)
        for edges, periodic in itertools.product(Within.SHAPES[1:4] + Within.SHAPES[6:], ((1, 1, 1), (1, 0, 1))):
            rows = ["{} {} {} {}".format("C" if k % 9 == 0 else "O", *(round(sum(1.3 * rng.random() * edge[c] for edge in edges), 6) for c in range(3)))
                    for k in range(120)]
            lattice = f'Lattice="{" ".join(str(v) for edge in edges for v in edge)}" pbc="{" ".join("FT"[p] for p in periodic)}"'
            path = self.write("a.extxyz", f"120\n{lattice} Properties=species:S:1:pos:R:3\n" + "\n".join(rows) + "\n")
            least = self.said_by(ASE, path)
            for reach in (0.77, 2.13, 4.41):
                self.assertEqual(self.select(path, f"within {reach} of element == C"), [k for k, d in enumerate(least) if d <= reach], (edges, periodic, reach))

    SAME = [("protein", "protein"), ("nucleic", "nucleic"), ("backbone", "backbone"), ("name == CA", "name CA"), ("resname in (ALA, GLY, LYS)", "resname ALA GLY LYS"),
            ("protein and not name in (CA, CB)", "protein and not name CA CB"), ("10 <= resid <= 20 and name == N", "resid 10:20 and name N"),
            ("index < 1000 and name == O", "index 0:999 and name O"), ("name == CA or name == N and resname == GLY", "name CA or (name N and resname GLY)"),
            ("water", "water")]

    def beside(self, name, pairs, scale=1.0):
        folder = self.real_files()
        path = os.path.join(folder, name)
        result = subprocess.run([listed.READERS_PYTHON, "-c", ORACLE, path, *[theirs for _, theirs in pairs]],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr[-2000:])
        some = 0
        for (ours, theirs), indices in zip(pairs, json.loads(result.stdout)):
            self.assertEqual(self.select(path, ours), sorted(indices), (name, ours, theirs, scale))
            some += len(indices) > 0
        return some

    def test_proteins(self):
        for name, least in (("adk_oplsaa.gro", 9), ("adk_open.pdb", 8), ("cobrotoxin.pdb", 8)):
            self.assertGreaterEqual(self.beside(name, self.SAME), least, name)

    def test_chains_and_records(self):
        pairs = [("chain == A", "chainID A"), ("chain == B and name == CA", "chainID B and name CA"), ("hetero", "record_type HETATM"),
                 ("hetero and not water", "record_type HETATM and not water"), ("bfactor > 30", "prop tempfactor > 30"), ("occupancy < 1", "prop occupancy < 1"),
                 ("element == S", "element S"), ("x > 10 and z <= 5", "prop x > 10 and prop z <= 5")]
        for name in ("1hvr.pdb", "4E43.pdb", "5a7u.pdb"):
            folder = self.real_files()
            if os.path.exists(os.path.join(folder, name)):
                self.assertGreaterEqual(self.beside(name, pairs[:6] + pairs[7:]), 3, name)

    def test_nucleic(self):
        self.assertGreaterEqual(self.beside("nucl_res.pdb", self.SAME[:2]), 1)

    def test_within_a_periodic_cell(self):
        """A dodecahedron of water (in nm here, in angstrom there), and a box of PDB."""
        ours = ["within {} of name == CA and resid == 100 and not (name == CA and resid == 100)", "within {} of (protein and resid == 1) and water and not (protein and resid == 1)",
                "within {} of (resname == SOL and index > 47000) and not (resname == SOL and index > 47000)"]
        ours[0] = "within {} of (name == CA and resid == 100) and not (name == CA and resid == 100)"
        theirs = ["around {} (name CA and resid 100)", "water and around {} (protein and resid 1)", "around {} (resname SOL and index 47001:99999)"]
        pairs = [(o.format(reach / 10), t.format(reach)) for reach in (3.37, 7.13) for o, t in zip(ours, theirs)]
        self.assertEqual(self.beside("adk_oplsaa.gro", pairs), 6)
        pairs = [(o.format(reach), t.format(reach)) for reach in (4.37,) for o, t in zip(ours[:1], theirs[:1])]
        self.assertEqual(self.beside("adk_oplsaa.pdb", pairs), 1)


if __name__ == "__main__":
    listed.main()
