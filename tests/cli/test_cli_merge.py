"""`ballpark merge`: parts of a render make the whole, bit for bit; what does not belong together is refused."""

import os
import struct
import subprocess
import sys
import zlib

import bpa
from cli import PROGRAM, ProgramTest, deep, main, scene


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

    def test_what_is_no_film_is_called_what_it_is(self):
        for name, what in (("a.png", "a PNG picture"), ("a.exr", "an EXR picture"), ("a.pfm", "a PFM picture")):
            self.part(name, 0, 1)
            self.fail_with(1, "merge", name, "-o", "sum.png",
                           says=f"{name}: found {what}, expected a .bpa file, as `ballpark render -o FILE.bpa` writes")
        self.fail_with(1, "merge", "s.json", "-o", "sum.png", says="s.json is not a .bpa file")
        self.succeed("merge", self.part("film.txt", 0, 1, "--format", "bpa"), "-o", "sum.png")  # a film by another name

    def test_a_gap_is_no_fault(self):
        self.part("a.bpa", 0, 4)
        self.part("b.bpa", 100, 4)
        said = self.succeed("merge", "a.bpa", "b.bpa", "-o", "sum.png").errors
        self.assertIn("8 samples per pixel (0 to 3, 100 to 103)", said)
        self.assertIn("96 samples per pixel are missing: 4 to 99", said)
        self.part("c.bpa", 4, 95)
        self.assertIn("1 sample per pixel is missing: 99 to 99", self.succeed("merge", "c.bpa", "b.bpa", "a.bpa", "-o", "sum.png").errors)
        self.part("d.bpa", 99, 1)
        self.assertNotIn("missing", self.succeed("merge", "c.bpa", "b.bpa", "d.bpa", "a.bpa", "-o", "sum.png").errors)

    def test_shares(self):
        """Every sample is in one share; sizes differ by one round of the replicates at most."""
        for spp, shares in ((30, 8), (64, 3), (7, 2)):
            self.part("whole.bpa", 5, spp)
            sizes, names = [], []
            for share in range(1, shares + 1):
                names.append(f"{share}.bpa")
                self.succeed("render", "s.json", "--first-sample", 5, "--spp", spp, "--share", f"{share}/{shares}", "-o", names[-1], "-q")
                header, _ = bpa.read(self.read(names[-1]))
                self.assertEqual(header["job"], [5, spp])
                sizes += [count for _, count in header["ranges"]]
            self.assertEqual((sum(sizes), len(sizes)), (spp, shares))
            self.assertLessEqual(max(sizes[:-1]) - min(sizes[:-1]), 4, sizes)
            self.assertTrue(0 <= max(sizes) - sizes[-1] <= 7, sizes)  # the last round may have less
            names.reverse()
            said = self.succeed("merge", *names, "-o", "sum.bpa").errors
            self.assertNotIn("missing", said)
            self.assert_same(self.read("sum.bpa"), self.read("whole.bpa"), (spp, shares))
            # In two steps it is the same, and what is missing meanwhile is said.
            said = self.succeed("merge", *names[1:], "-o", "part.bpa").errors
            self.assertIn(f"missing: {5 + spp - sizes[-1]} to {4 + spp}", said)
            self.succeed("merge", "part.bpa", names[0], "-o", "sum.bpa")
            self.assert_same(self.read("sum.bpa"), self.read("whole.bpa"), (spp, shares))

    def test_shares_that_cannot_be(self):
        for share, says in (("0/4", "shares are numbered from 1/4 to 4/4"), ("5/4", "shares are numbered from 1/4 to 4/4"),
                            ("3", "expected I/N"), ("1/", "whole number"), ("1/4", None), ("1/9", "at most 8 shares of 4 samples; use fewer shares, or --spp 33 or more")):
            arguments = ("render", "s.json", "--spp", 30, "--share", share, "-o", "x.bpa")
            if says is None:
                self.succeed(*arguments)
            else:
                self.fail_with(2, *arguments, says=["--share", says])
        self.fail_with(2, "render", "s.json", "--share", "1/2", says="--share 1/2 needs a file of its own")
        self.fail_with(2, "render", "s.json", "--share", "1/2", "--error", "1", "-o", "y.bpa", says="--share and --error contradict")
        self.fail_with(2, "render", "s.json", "--share", "1/2", "--adaptive", "-o", "y.bpa", says="--share and --adaptive contradict")

    @deep
    def test_many_files(self):
        """As many as there are, in any order, and in no more memory than a few need: names like those of a job array."""
        self.write("s.json", scene(320, 180, camera={"samples_per_pixel": 1, "max_depth": 1}))
        names = []
        for number in range(16):
            names.append(self.part(f"part-{number}.bpa", number, 1))
        names.sort()
        peaks = []
        # A program with address sanitizer keeps what is freed for a while, to find who still uses it.
        quick_reuse = ":".join(filter(None, [self.environment.get("ASAN_OPTIONS"), "quarantine_size_mb=0"]))
        for count in (4, 16):
            code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
                    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
            done = subprocess.run([sys.executable, "-c", code, PROGRAM, "merge", *names[:count], "-o", f"{count}.bpa", "-q"],
                                  cwd=self.folder, env=dict(self.environment, ASAN_OPTIONS=quick_reuse),
                                  stdout=subprocess.PIPE, check=True)
            peaks.append(int(done.stdout))
        self.assertLess(peaks[1], 1.1 * peaks[0] + 8000, peaks)  # KiB
        self.part("whole.bpa", 0, 16)
        self.assert_same(self.read("16.bpa"), self.read("whole.bpa"))

    def test_unfinished(self):
        """A part that was stopped amid its samples is named, with what finishes it."""
        self.part("a.bpa", 0, 8)
        self.part("b.bpa", 8, 8)
        header, body = self.read("b.bpa").split(b"\n", 1)
        data = header.replace(b"\"partial\": false", b"\"partial\": true") + b"\n" + body[:-4]
        self.write("b.bpa", data + struct.pack("<I", zlib.crc32(data)))
        said = self.succeed("merge", "a.bpa", "b.bpa", "-o", "sum.png").errors
        self.assertIn("some pixels lack samples in b.bpa: ballpark render SCENE --resume FILE finishes it", said)

    def test_overlap(self):
        self.part("a.bpa", 0, 10)
        self.part("b.bpa", 20, 10)
        self.part("c.bpa", 25, 10)
        self.fail_with(2, "merge", "a.bpa", "b.bpa", "c.bpa", "-o", "x.png", says=["b.bpa (samples 20 to 29) and c.bpa (25 to 34)", "twice"])
        self.fail_with(2, "merge", "a.bpa", "a.bpa", "-o", "x.png", says="a.bpa (samples 0 to 9) and a.bpa (0 to 9)")
        self.fail_with(2, "merge", *["a.bpa"] * 8, "-o", "x.png", says="and 3 more pairs")
        self.assertEqual(self.files(), ["a.bpa", "b.bpa", "c.bpa", "s.json"])

    def test_what_does_not_belong_together(self):
        self.part("a.bpa", 0, 10)
        for options, says in ((["--seed", "1"], ["seeds differ (0 and 1); render both with the same --seed and different --first-sample"]),
                              (["--depth", "3"], ["depths differ (10 and 3); use the same --depth for both"]),
                              (["--width", "13"], ["widths differ (12 and 13 pixels); use the same --width for both"])):
            self.part("other.bpa", 10, 10, *options)
            self.fail_with(2, "merge", "a.bpa", "other.bpa", "-o", "x.png",
                           says=["cannot merge other.bpa and a.bpa: ", *says])
        # Kernels of their own are compiled by the deep part alone; here files say that they were made by them.
        header, body = self.read(self.part("b.bpa", 10, 10)).split(b"\n", 1)
        for name, value, other in self.KERNELS:
            changed = header.replace(f'"{name}": "{value}"'.encode(), f'"{name}": "{other}"'.encode())
            self.assertNotEqual(changed, header)
            data = changed + b"\n" + body[:-4]
            self.write("other.bpa", data + struct.pack("<I", zlib.crc32(data)))
            self.fail_with(2, "merge", "a.bpa", "other.bpa", "-o", "x.png",
                           says=["cannot merge other.bpa and a.bpa: ", f"({value} and {other}); use the same --{name} for both"])
        # What changes no sample is no difference.
        self.part("other.bpa", 10, 10, "--transfer", "srgb")
        self.succeed("merge", "a.bpa", "other.bpa", "-o", "y.png")
        self.write("s.json", scene(12, materials={"m": {"type": "lambertian", "albedo": [0.5, 0.4, 0.31]}}))
        self.part("colour.bpa", 10, 10)
        self.fail_with(2, "merge", "a.bpa", "colour.bpa", "-o", "x.png", says=["colour.bpa", "scenes differ"])
        self.assertNotIn("x.png", self.files())

    KERNELS = (("precision", "single", "double"), ("math", "strict", "fast"), ("numerics", "robust", "plain"),
               ("sampler", "sobol", "independent"))

    @deep
    def test_kernels_that_do_not_belong_together(self):
        self.part("a.bpa", 0, 10)
        for name, value, other in self.KERNELS:
            self.part("other.bpa", 10, 10, f"--{name}", other)
            self.fail_with(2, "merge", "a.bpa", "other.bpa", "-o", "x.png",
                           says=["cannot merge other.bpa and a.bpa: ", f"({value} and {other}); use the same --{name} for both"])
        for options in (["--kernel", "sample"], ["--effects", "all"]):  # these change no sample
            self.part("other.bpa", 10, 10, *options)
            self.succeed("merge", "a.bpa", "other.bpa", "-o", "y.png")

    def test_bad_files(self):
        self.part("a.bpa", 0, 10)
        data = self.read(self.part("b.bpa", 10, 10))
        self.write("short.bpa", data[:-1])
        self.write("long.bpa", data + b"x")
        self.write("empty.bpa", b"")
        for name in ("short.bpa", "long.bpa", "empty.bpa", "s.json", "none.bpa"):
            self.fail_with(1, "merge", "a.bpa", name, "-o", "x.png", says=name)
        self.assertNotIn("x.png", self.files())

    def test_samples_that_are_not_finite(self):
        """They end it with 1, and when most are, there is no picture."""
        self.part("a.bpa", 0, 10)
        header, arrays = bpa.read(self.read("a.bpa"))
        for invalid, code in ((0, 0), (1, 1), (10 * 144, 1), (10 * 144 + 1, 1)):
            self.write("b.bpa", bpa.write(dict(header, invalid_samples=invalid, negative_samples=invalid), arrays))
            result = self.run_program("merge", "b.bpa", "-o", "b.png")
            self.assertEqual(result.returncode, code, result.errors)
            if invalid > 1440:
                self.assertIn("1441 of 2881 samples are invalid (1441 negative)", result.errors)
            self.assertEqual("b.png lacks " in result.errors, 0 < invalid <= 1440, result.errors)
            self.assertEqual("b.png" in self.files(), invalid <= 1440)
            if invalid <= 1440:
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
