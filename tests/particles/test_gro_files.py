"""GRO files: fields of all precisions, velocities, titles and boxes; beside MDAnalysis too. See listed.py."""
import glob
import gzip
import os

import listed


def frame(precision, rows, title="title", box=(2.0, 3.0, 4.0), end="\n"):
    """A frame as GROMACS writes it: fields of precision + 5, of velocities too, which have one decimal more."""
    width = precision + 5
    lines = [title, f"{len(rows):5d}"]
    for i, (place, velocity) in enumerate(rows):
        line = f"{i % 100000 + 1:5d}{'MOL':<5s}{'C':>5s}{i % 100000 + 1:5d}" + "".join(f"{x:{width}.{precision}f}" for x in place)
        lines.append(line + "".join(f"{v:{width}.{precision + 1}f}" for v in velocity or ()))
    box_precision = max(precision, 5)
    lines.append("".join(f"{x:{box_precision + 5}.{box_precision}f}" for x in box))
    return end.join(lines) + end


ROWS = [((0.1, 0.25, -1.5), (-1.0, 2.0, -3.0)), ((10.0, 20.5, 30.125), (10.0, -20.0, -30.0)), ((-10.5, -20.25, 0.0), (0.5, -0.25, 99.5))]


class Gro(listed.ListTest):
    def check(self, found, rows, velocities):
        self.near(found.places(), [list(place) for place, _ in rows], 1e-9)
        for member, axis in (("first", velocities[0]), ("second", velocities[1])):
            self.assertEqual(found.of(member), [v and v[axis] for _, v in rows], member)

    def test_no_box(self):
        """Of zeros, or a blank line where ASE has no cell to write; a missing line is an error."""
        frame = "t\n1\n    1ALA     CA    1   1.000   2.000   3.000\n"
        for box in ("0 0 0\n", "\n", "  \n", "   0.00000   0.00000   0.00000"):
            found = self.of("a.gro", frame + box)
            self.assertEqual((found.places(), "cell" in found.head, found.head["frames"]), ([(1, 2, 3)], False, 1), box)
        found = self.of("a.gro", (frame + "\n") * 2 + frame.replace("1.000", "4.000") + "5 6 7\n", 2)
        self.assertEqual((found.places(), found.head["cell"][2][2], found.head["frames"]), ([(4, 2, 3)], 7, 3))
        self.refuse("a.gro", frame, "the line of the box")
        self.refuse("a.gro", frame + "5 5\n", "the box: 3 or 9 numbers")

    def test_ions(self):
        """Names of CHARMM and GROMOS, which are the residue's as well; amid organic atoms they are none."""
        ions = [("NA", "Na"), ("CL", "Cl"), ("NA+", "Na"), ("CL-", "Cl"), ("CA2+", "Ca"), ("MG2+", "Mg"), ("ZN2+", "Zn"), ("CU2+", "Cu"), ("CAL", "Ca"),
                ("CES", "Cs"), ("RUB", "Rb"), ("LIT", "Li"), ("BAR", "Ba"), ("SOD", "Na"), ("CLA", "Cl"), ("POT", "K"), ("CA", "Ca"), ("K", "K")]
        lines = [f"{i + 1:5d}{name:<5s}{name:>5s}{i + 1:5d}   1.000   2.000   3.000" for i, (name, _) in enumerate(ions)]
        lines += ["   99ALA     CA   99   1.000   2.000   3.000", "   99LIG    CAL   99   1.000   2.000   3.000", "   99LIG   CA2+   99   1.000   2.000   3.000"]
        found = self.of("a.gro", f"t\n{len(lines)}\n" + "\n".join(lines) + "\n0 0 0\n")
        self.assertEqual(found.of("element"), [element for _, element in ions] + ["C", "C", "C"])

    def test_velocities_of_all_precisions(self):
        """Signs and digits stay in their fields, also where fields touch (0.25 and 99.5 are exact in a float)."""
        for precision in (3, 4, 5, 6, 9):
            for columns, axes in ((("vx", "vy"), (0, 1)), (("vy", "vz"), (1, 2))):
                path = self.write("a.gro", frame(precision, ROWS))
                self.check(self.list(path, 0, *columns), ROWS, axes)

    def test_fields_that_touch(self):
        rows = [((100.5, -100.25, 999.125), (-10.5, -20.25, -30.5)), ((-999.5, -888.25, -777.125), (-99.5, -88.25, -77.5))]
        self.assertIn("-100.250 999.125-10.5000-20.2500", frame(3, rows))
        self.check(self.of("a.gro", frame(3, rows), 0, "vx", "vz"), rows, (0, 2))

    def test_velocities_that_are_missing(self):
        rows = [ROWS[0], (ROWS[1][0], None), ROWS[2]]
        found = self.of("a.gro", frame(3, rows), 0, "vx", "vy")
        self.check(found, rows, (0, 1))
        self.assertNotIn("velocities", found.head["notes"])
        for wrong in (" 10.0000-20.0000", " 10.0000-20.0000   words"):
            text = frame(3, ROWS).replace(" 10.0000-20.0000-30.0000", wrong)
            found = self.of("a.gro", text, 0, "vx", "vy")
            self.check(found, rows, (0, 1))
            self.assertIn("1 atom without readable velocities", found.head["notes"])

    def test_wider_velocities(self):
        """Fields that are wider than those of the positions, as some programs write them."""
        text = "t\n1\n    1MOL      C    1   0.100   0.200   0.300  -1.0000 -20.0000   3.5000\n 1 1 1\n"
        self.check(self.of("a.gro", text, 0, "vy", "vz"), [((0.1, 0.2, 0.3), (-1.0, -20.0, 3.5))], (1, 2))

    def test_titles(self):
        """A title may be empty, a number, or have times; blank lines between frames and at the end are no titles."""
        for end in ("\n", "\r\n"):
            for titles in (["", "", ""], ["a", "", "b"], ["", "b", ""], ["7", "8", "9"], ["t= 1.0", "x t=  2.50000 step= 3", "   "]):
                for more in ("", end, end + " " + end):
                    path = self.write("a.gro", "".join(frame(3, ROWS[:i + 1], t, end=end) for i, t in enumerate(titles)) + more)
                    for i in (0, 1, 2, -1):
                        found = self.list(path, i)
                        self.assertEqual(found.head["frames"], 3, (titles, more))
                        self.check(found, [(p, None) for p, _ in ROWS[:i + 1 if i >= 0 else 3]], (0, 1))
        between = (end + end).join(frame(3, ROWS, "title", end=end) for _ in range(2))
        self.assertEqual(self.of("a.gro", between, 1).head["frames"], 2)
        self.refuse("a.gro", "\n\n\n", "title")
        self.refuse("a.gro", "title\n", "number of atoms")
        self.refuse("a.gro", "title\nwords\n", "number of atoms")

    def test_boxes(self):
        nine = [5.0, 6.0, 7.0, 0.25, 0.5, 1.0, 0.125, 1.5, 2.0]  # v1x v2y v3z v1y v1z v2x v2z v3x v3y
        edges = [[5.0, 0.25, 0.5], [1.0, 6.0, 0.125], [1.5, 2.0, 7.0], [0, 0, 0]]
        for precision in (3, 6, 9):
            self.near(self.of("a.gro", frame(precision, ROWS, box=nine)).head["cell"], edges)
            wide = [1000.5 * x for x in nine]
            self.near(self.of("a.gro", frame(precision, ROWS, box=wide)).head["cell"], [[1000.5 * x for x in e] for e in edges], 1e-4)
            touching = [10000.5, 20000.25, 30000.125]
            self.near(self.of("a.gro", frame(precision, ROWS, box=touching)).head["cell"][:3],
                      [[10000.5, 0, 0], [0, 20000.25, 0], [0, 0, 30000.125]])
        self.refuse("a.gro", frame(3, ROWS, box=(1.0, 2.0)), "3 or 9 numbers")
        self.refuse("a.gro", frame(3, ROWS).replace("4.00000", "4.0000x"), "3 or 9 numbers")

    def test_first_atoms_without_a_place(self):
        """They tell no width, which those behind them do."""
        text = frame(3, ROWS)
        for gone in (1, 2):
            lines = text.split("\n")
            for i in range(gone):
                lines[2 + i] = lines[2 + i][:20] + "     nan" * 3 + lines[2 + i][44:]
            found = self.of("a.gro", "\n".join(lines), 0, "vx", "vy")
            self.check(found, ROWS[gone:], (0, 1))
            self.assertIn(f"{gone} point", found.head["notes"])
        self.refuse("a.gro", text.replace("   0.100", "     abc"), ":3:", "points at equal distances")

    def test_points_that_do_not_fit(self):
        good = frame(3, ROWS[:1])
        self.refuse("a.gro", good.replace("   0.250", "  0.2500"), ":3:", "points at equal distances")
        self.refuse("a.gro", frame(3, ROWS).replace("  20.500", " 2 0.500"), ":4:", "2 0.500")
        # A number too long for its columns moves all behind it, at unchanged distances of the points.
        for precision in (2, 3, 5):
            wide = ((-1234.5, 1234.25, 9999.75), (99.5, -999.25, 1.0))
            for row in (wide, (wide[0], None), (wide[0], wide[1][::-1]), ((12345.5, 1.0, 2.0), ROWS[0][1]), ((1.0, 12345.5, 2.0), None)):
                for before in ([], ROWS[:1]):
                    self.refuse("a.gro", frame(precision, before + [row]), f":{3 + len(before)}:")
            touching = [((1234.5, 1234.25, 9999.75), (999.25, 999.5, -99.5))]
            self.check(self.of("a.gro", frame(precision, touching), 0, "vx", "vz"), touching, (0, 2))


class Independent(listed.ListTest):
    def test_real_files(self):
        """Places, velocities, names and boxes of MDAnalysis's own test files, each number beside that reader's."""
        compared = 0
        for path in sorted(glob.glob(os.path.join(self.real_files(), "*.gro"))):
            if os.path.basename(path) in ("empty_atom.gro", "missing_atomname.gro"):  # which it refuses
                continue
            theirs = self.ask("mdanalysis", path)
            ours, second = self.list(path, 0, "vx", "vy"), self.list(path, 0, "vz", "residue_number")
            scale = max(1.0, *(abs(x) for place in theirs["positions"] for x in place))
            self.near([[10 * x for x in place] for place in ours.places()], theirs["positions"], 1e-6 * scale)
            self.assertEqual(ours.of("name"), theirs["names"], path)
            self.assertEqual(ours.of("residue"), theirs["residues"], path)
            if theirs["velocities"] is None:
                self.assertEqual(set(ours.of("first")), {None}, path)
            else:
                for i, velocity in enumerate(theirs["velocities"]):
                    found = [ours.atoms[i].first, ours.atoms[i].second, second.atoms[i].first]
                    if None not in found:
                        self.near([10 * v for v in found], velocity, 1e-4)
            if theirs["cell"] and "cell" in ours.head:
                self.near([[10 * x for x in e] for e in ours.head["cell"][:3]], theirs["cell"], 1e-5 * max(map(max, theirs["cell"])))
            compared += 1
        self.assertGreater(compared, 10)

    def test_frames(self):
        text = "".join(frame(5, [((i + 0.5, 2, 3), (1, -2, i))], f"t= {i}") for i in range(3))
        path, packed = self.write("a.gro", text), self.write("b.gro.gz", gzip.compress(text.encode()))
        theirs = self.ask("mdanalysis", path)
        for i in range(3):
            for name in (path, packed):
                ours = self.list(name, i, "vz")
                self.assertEqual((ours.atoms[0].x, ours.atoms[0].first), (i + 0.5, i))
        self.near([[10 * x for x in p] for p in self.list(path, 0).places()], theirs["positions"], 1e-4)


if __name__ == "__main__":
    listed.main()
