"""Files whose last frame is still being written, in all formats of several frames.

Run as: python3 test_cut_frames.py particle_summary
"""
import gzip
import sys
import unittest

import test_particle_files as files


class Cut(files.FileTest):
    NOTE = "the last frame is cut short: left out"

    def values(self, name, content, frame):
        return self.of(name, content, frame, "", "values")

    def frames(self):
        gro = "".join(files.GRO.replace("0.126", f"0.{i}26") for i in range(3))
        pdb = "".join(f"MODEL     {i:4d}\n" + "".join(f"HETATM{k:5d}  C   LIG A   1    {i:8.3f}{k:8.3f}   0.000  1.00  1.00           C\n"
                                                      for k in range(4)) + "ENDMDL\n" for i in range(3))
        xyz = "".join(f"3\nt\nO {i} 0 0.5\nH 0.75 0 -1e-1\nH -0.75 0.0 -0.125\n" for i in range(3))
        extended = "".join(files.EXTENDED.replace("4 5 6", f"{i} 5 6") for i in range(3))
        first = files.DUMP[:files.DUMP.rindex("ITEM: TIMESTEP")]
        head, rows = files.CIF.split("ATOM N N . ALA", 1)[0], []
        for model in (1, 2, 3):
            rows += [f"ATOM C C{k} . ALA A {model}.5 {k} 0.25 11 {model}\n" for k in range(3)]
        return {"a.xyz": (xyz, 3), "b.xyz": (extended, 3), "a.gro": (gro, 3), "a.pdb": (pdb, 3), "a.dump": (first * 3, 3),
                "a.cif": (head + "".join(rows), 3)}

    def test_every_length(self):
        """Cut behind each byte of the last frame, plain and packed: the frames before, and nothing else."""
        for name, (text, count) in self.frames().items():
            whole = self.values(name, text, frame=-1)
            before = self.values(name, text, frame=count - 2)
            self.assertEqual((whole["frames"], whole["notes"]), (count, before["notes"]), name)
            start = len(text) - len(text) // count
            if name == "a.cif":
                start = text.rindex("ATOM C C1 . ALA A 3.5")  # only its end tells whose a row is
            for length in range(start + 1, len(text)):
                s = self.values(name, text[:length], frame=-1)
                if s["frames"] == count:  # nothing that a frame consists of is missing
                    if name != "a.cif" or not text[:length].endswith(("\n", " 3")):  # models have no count: whole rows do
                        self.assertEqual(len(s["positions"]), len(whole["positions"]), (name, length))
                        self.assertGreater(length, len(text) - (90 if name in ("a.pdb", "a.gro") else 20), (name, length))
                    continue
                self.assertEqual(s["frames"], count - 1, (name, length))
                notes = "; ".join(filter(None, [before["notes"], self.NOTE]))
                part = text[start:length]  # one without atoms is none of a frame of a PDB file
                same = part.strip() == "" or (name == "a.pdb" and "HETATM" not in part)
                self.assertEqual({**s, "frames": 0}, {**before, "frames": 0, "notes": before["notes"] if same else notes},
                                 (name, length, part))

    def test_rows_of_cif(self):
        text, _ = self.frames()["a.cif"]
        at = text.index("ATOM C C1 . ALA A 2.5")
        self.refuse("a.cif", text[:at] + text[at:].replace(" 0.25", "", 1), "a value is missing", arguments=[-1])

    def test_packed(self):
        text = "".join(f"2\n{i ** 3 * 7919 % 1009}\nO {i} 0 {i ** 5 % 9973}\nH 1 {i ** 7 % 8887} {i ** 4 % 7919}\n" for i in range(2000))
        packed = gzip.compress(text.encode())
        for length in (len(packed) // 2, len(packed) - 4, len(packed) - 40):
            s = self.values("a.xyz.gz", packed[:length], frame=-1)
            # What stands in the file is used to the end, but for the part of a frame.
            share = s["frames"] / 2000
            self.assertTrue(abs(share - length / len(packed)) < 0.1 if length < len(packed) - 9 else share > 0.99, (share, length))
            self.assertEqual((s["notes"], s["positions"][0][0]), (self.NOTE, s["frames"] - 1))
        path = self.write("b.xyz.gz", packed[:len(packed) // 2])
        result = self.answer(path, 1999)
        self.assertEqual((result.returncode, "and a part of another" in result.stderr), (1, True), result.stderr)
        self.refuse("a.xyz.gz", packed[:200] + b"\xff\xff\xff" + packed[203:], "damage", arguments=[-1])

    def test_only_frame(self):
        for name, (text, count) in self.frames().items():
            only = text[:len(text) // count * 7 // 10]
            if name == "a.pdb":
                continue  # which has no count; a file of atoms alone is as good as any
            if name == "a.cif":
                only = text[:text.index("ATOM C C1 . ALA A 1.5") + 20]
            self.refuse(name, only)

    def test_faults_before_the_end(self):
        for name, (text, count) in self.frames().items():
            near = {"a.xyz": "O 1 0", "b.xyz": "1 2 3", "a.gro": "0.126", "a.pdb": "   1.000   2.000", "a.dump": "0.5 0.5", "a.cif": "2.5 1"}
            place = text.index(near[name], len(text) // count - 5)
            bad = text[:place] + near[name].replace("1", "x").replace("5", "x") + text[place + len(near[name]):]
            for content in (bad, bad[:-15]):
                result = self.answer(self.write(name, content), -1)
                self.assertEqual(result.returncode, 1, (name, result.stdout[:300]))
        self.refuse("a.xyz", "1\n\nO 0 0 0\nO 1 1 1\n", "more atoms", arguments=[1])

    def test_frames_of_pdb_that_differ(self):
        """Frames may have fewer atoms than those before, and the last may lack its END if it has as many."""
        def atoms(count):
            return "".join(f"HETATM{k:5d}  C   LIG A   1    {k:8.3f}   0.000   0.000\n" for k in range(count))
        for text, counts in [(atoms(3) + "END\n" + atoms(2) + "END\n", [3, 2]), (atoms(3) + "END\n" + atoms(3), [3, 3]),
                             (atoms(3) + "END\n" + atoms(2), [3]), (atoms(3), [3]),
                             ("MODEL 1\n" + atoms(3) + "MODEL 2\n" + atoms(2), [3, 2])]:
            for number, count in enumerate(counts):
                s = self.of("a.pdb", text, number)
                self.assertEqual((s["count"], s["frames"]), (count, len(counts)), text)


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0]] + sys.argv[2:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
