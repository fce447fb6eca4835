"""`ballpark merge`: parts of a render make the whole, bit for bit; what does not belong together is refused."""

import os
import struct
import zlib

from cli import ProgramTest, main, scene


class Merge(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(12))

    def part(self, name, first, count, *options):
        self.succeed("render", "s.json", "--first-sample", first, "--spp", count, "-o", name, "-q", *options)
        return name

    def test_parts_are_the_whole(self):
        self.part("whole.bpa", 0, 30)
        for name, first, count in (("a.bpa", 0, 10), ("b.bpa", 10, 7), ("c.bpa", 17, 13)):
            self.part(name, first, count)
        for order in (["a.bpa", "b.bpa", "c.bpa"], ["c.bpa", "a.bpa", "b.bpa"]):
            self.succeed("merge", *order, "-o", "sum.bpa")
            self.assert_same(self.read("sum.bpa"), self.read("whole.bpa"), order)
        for form in ("png", "pfm", "exr", "ppm"):
            self.part("whole." + form, 0, 30)
            said = self.succeed("merge", "b.bpa", "c.bpa", "a.bpa", "-o", "sum." + form).errors
            self.assert_same(self.read("sum." + form), self.read("whole." + form), form)
            self.assertIn("12x12, 30 samples per pixel (0 to 29), noise", said)
        self.assertEqual(self.succeed("merge", "a.bpa", "b.bpa", "c.bpa", "-o", "-", "--format", "pfm").stdout,
                         self.read("whole.pfm"))

    def test_a_gap_is_no_fault(self):
        self.part("a.bpa", 0, 4)
        self.part("b.bpa", 100, 4)
        said = self.succeed("merge", "a.bpa", "b.bpa", "-o", "sum.png").errors
        self.assertIn("8 samples per pixel (0 to 3, 100 to 103)", said)

    def test_overlap(self):
        self.part("a.bpa", 0, 10)
        self.part("b.bpa", 20, 10)
        self.part("c.bpa", 25, 10)
        self.fail_with(2, "merge", "a.bpa", "b.bpa", "c.bpa", "-o", "x.png", says=["b.bpa", "c.bpa", "25 to 34"])
        self.fail_with(2, "merge", "a.bpa", "a.bpa", "-o", "x.png", says="a.bpa")
        self.assertEqual(self.files(), ["a.bpa", "b.bpa", "c.bpa", "s.json"])

    def test_what_does_not_belong_together(self):
        self.part("a.bpa", 0, 10)
        for options, says in ((["--seed", "1"], ["seeds differ (0 and 1)", "--first-sample"]),
                              (["--depth", "3"], ["depths differ (--depth 10 and 3)"]),
                              (["--width", "13"], ["widths differ (12 and 13 pixels: --width)"]),
                              (["--precision", "double"], ["(--precision single and --precision double)"]),
                              (["--math", "fast"], ["(--math strict and --math fast)"]),
                              (["--numerics", "plain"], ["(--numerics robust and --numerics plain)"]),
                              (["--sampler", "independent"], ["(--sampler sobol and --sampler independent)"])):
            self.part("other.bpa", 10, 10, *options)
            self.fail_with(2, "merge", "a.bpa", "other.bpa", "-o", "x.png",
                           says=["cannot merge other.bpa and a.bpa: ", *says])
        # What changes no sample is no difference.
        for options in (["--kernel", "sample"], ["--effects", "all"], ["--transfer", "srgb"]):
            self.part("other.bpa", 10, 10, *options)
            self.succeed("merge", "a.bpa", "other.bpa", "-o", "y.png")
        self.write("s.json", scene(12, materials={"m": {"type": "lambertian", "albedo": [0.5, 0.4, 0.31]}}))
        self.part("colour.bpa", 10, 10)
        self.fail_with(2, "merge", "a.bpa", "colour.bpa", "-o", "x.png", says=["colour.bpa", "scenes differ"])
        self.assertNotIn("x.png", self.files())

    def test_bad_files(self):
        self.part("a.bpa", 0, 10)
        data = self.read("a.bpa")
        self.write("short.bpa", data[:-1])
        self.write("long.bpa", data + b"x")
        self.write("empty.bpa", b"")
        for name in ("short.bpa", "long.bpa", "empty.bpa", "s.json", "none.bpa"):
            self.fail_with(1, "merge", "a.bpa", name, "-o", "x.png", says=name)
        self.assertNotIn("x.png", self.files())

    def test_samples_that_are_not_finite(self):
        """They are told, and when most are, there is no picture."""
        self.part("a.bpa", 0, 10)
        header, body = self.read("a.bpa").split(b"\n", 1)
        for invalid, code in ((0, 0), (1, 0), (10 * 144, 0), (10 * 144 + 1, 1)):
            data = header.replace(b"\"invalid_samples\": 0", b"\"invalid_samples\": %d" % invalid) + b"\n" + body[:-4]
            self.write("b.bpa", data + struct.pack("<I", zlib.crc32(data)))
            result = self.run_program("merge", "b.bpa", "-o", "b.png")
            self.assertEqual(result.returncode, code, result.errors)
            if code != 0:
                self.assertIn("1441 of 2881 samples are not finite", result.errors)
            self.assertEqual("warning: " in result.errors, 0 < invalid <= 1440, result.errors)
            self.assertEqual("b.png" in self.files(), code == 0)
            if code == 0:
                os.remove(self.path("b.png"))

    def test_output(self):
        self.part("a.bpa", 0, 10)
        self.fail_with(2, "merge", "a.bpa", "-o", "x.jpg", says=".bpa")
        self.fail_with(1, "merge", "none.bpa", "-o", "no/such.png", says="no/such.png")
        self.succeed("merge", "a.bpa", "-o", "srgb.png", "--transfer", "srgb")
        self.succeed("merge", "a.bpa", "-o", "own.png")
        self.assert_different(self.read("srgb.png"), self.read("own.png"))


if __name__ == "__main__":
    main()
