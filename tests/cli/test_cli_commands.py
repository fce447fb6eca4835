"""`ballpark check`, `explain`, `bench` and `devices` as their user meets them: answers, documents, exit codes."""

import json
import re

from cli import ProgramTest, broken_kernels, main, scene


class Check(ProgramTest):
    SIZE = ("--width", "16", "--spp", "64", "--margin", "20")

    def setUp(self):
        super().setUp()
        self.write("s.json", scene())

    def test_agree(self):
        result = self.succeed("check", "s.json", *self.SIZE, "--json", "r.json", "--map", "map.png", "--seed", "7")
        self.assertIn(b"agree", result.stdout)
        report = json.loads(self.read("r.json"))
        self.assertIs(type(report), dict)
        self.assertTrue(self.read("map.png").startswith(b"\x89PNG"))
        self.assertNotIn("\x1b", result.errors)
        quiet = self.succeed("check", "s.json", *self.SIZE, "--quiet")
        self.assertEqual(quiet.errors, "")

    def test_all_devices(self):
        result = self.succeed("check", "s.json", *self.SIZE, "--device", "all", "--json", "r.json")
        listed = json.loads(self.succeed("devices", "--json", "-").stdout)["devices"]
        text = self.read("r.json").decode()
        for device in listed:
            self.assertIn(device["name"], text)
            self.assertIn(device["name"].encode(), result.stdout)

    def test_disagree(self):
        """A sky whose gradient runs the wrong way must be noticed."""
        fault = broken_kernels(self, "light/sky.cl", "madd3(fma(splat(R(0.5)), height", "madd3(fma(splat(R(-0.5)), height")
        result = self.run_program("check", "s.json", *self.SIZE, environment=fault)
        self.assertEqual(result.returncode, 3, result.errors)
        self.assertRegex(result.errors, r"(?m)^ballpark: .*disagree")

    def test_wrong(self):
        self.fail_with(2, "check", "none.json", says="none.json")
        self.fail_with(5, "check", "s.json", "--device", "none", says="none")
        self.fail_with(1, "check", "s.json", *self.SIZE, "--json", "no/such.json", says="no/such.json")
        self.fail_with(1, "check", "s.json", *self.SIZE, "--map", "no/such.png", says="no/such.png")


class Explain(ProgramTest):
    def test_table(self):
        self.write("s.json", scene())
        self.write("other.json", scene(spheres=0))
        text = self.succeed("explain", "s.json", "other.json").stdout.decode()
        for word in ("s.json", "other.json", "lambertian", "dielectric"):
            self.assertIn(word, text)
        self.assertEqual(self.succeed("explain", "s.json", environment={"OCL_ICD_VENDORS": "/none/"}).returncode, 0,
                         "no device is needed")

    def test_pixel(self):
        self.write("s.json", scene())
        text = self.succeed("explain", "s.json", "--pixel", "8,8").stdout.decode()
        self.assertIn("sphere 0", text)
        self.assertIn("sky", text)
        outside = self.run_program("explain", "s.json", "--pixel", "16,3")
        self.assertEqual(outside.returncode, 2)
        self.assertIn("16", outside.errors)
        self.fail_with(2, "explain", "s.json", "--pixel", "3", says="--pixel")
        self.fail_with(2, "explain", "s.json", "--pixel", "-3,1", says="--pixel")


class Bench(ProgramTest):
    def test_table_and_document(self):
        self.write("s.json", scene(32))
        result = self.succeed("bench", "s.json", "--rounds", "1", "--time", "0.2", "--json", "b.json")
        self.assertIn(b"s.json", result.stdout)
        report = json.loads(self.read("b.json"))
        self.assertEqual(len(report["scenes"]), 1)
        self.assertGreater(report["scenes"][0]["samples_per_second"]["median"], 0)
        self.assertEqual(self.files(), ["b.json", "s.json"])
        self.fail_with(2, "bench", "none.json", says="none.json: no such file")
        missing = self.fail_with(2, "bench", "covr", says="cover, diffuse, glass and field-N")
        self.assertNotIn("round 1", missing.errors)  # before any work


class Devices(ProgramTest):
    def test_table(self):
        text = self.succeed("devices").stdout.decode()
        listed = json.loads(self.succeed("devices", "--json", "-").stdout)["devices"]
        lines = text.split("\n")
        for device in listed:
            row = [line for line in lines if device["name"] in line]
            self.assertTrue(row and device["platform"] in row[0] and device["driver"] in row[0], text)
            for member in ("number", "type", "platform", "name", "vendor", "version", "driver", "compute_units",
                           "memory_bytes", "largest_allocation_bytes", "double", "default", "refusal"):
                self.assertIn(member, device)
        self.assertEqual(sum(device["default"] for device in listed), 1)
        self.assertIn("*", text)
        # The columns stand below each other.
        name_at = lines[0].index("name")
        for device in listed:
            self.assertEqual([line for line in lines if device["name"] in line][0].index(device["name"]), name_at)

    def test_document(self):
        self.succeed("devices", "--json", "d.json")
        self.assertEqual(json.loads(self.read("d.json")), json.loads(self.succeed("devices", "--json", "-").stdout))
        self.fail_with(1, "devices", "--json", "no/such.json", says="no/such.json")


class Limits(ProgramTest):
    def test_rounding_that_shows_is_said(self):
        """A bead of 2e-4 on the book's ground is moved by rounding: render and check say so, double has no need to."""
        self.write("s.json", scene(4, camera={"lookfrom": [0, 0.0004, 0.0016], "lookat": [0, 0.0002, 0]}, spheres=[
            {"center": [0, -1000, 0], "radius": 1000, "material": "m"},
            {"center": [0, 0.0002, 0], "radius": 0.0002, "material": "m"}]))
        for words in (["render", "s.json", "--spp", "1"], ["check", "s.json", "--spp", "2"]):
            result = self.run_program(*words)
            self.assertRegex(result.errors, r"warning: .*spheres\[0\] \(radius 1000\).*spheres\[1\] \(0\.0002\).*"
                                            r"--precision double")
            self.assertNotIn("warning", self.run_program(*words, "--quiet").errors)
            self.assertNotIn("warning", self.run_program(*words, "--precision", "double").errors)


class OneOfEach(ProgramTest):
    def test_one_is_no_plural(self):
        """Where there is one of something, its noun says so."""
        self.write("s.json", scene(1, spheres=1, background=[1, 1, 1]))
        said = ""
        for words in (["render", "s.json", "--spp", "1", "--depth", "1", "-o", "a.bpa"],
                      ["render", "s.json", "--spp", "1", "--error", "0.001"],
                      ["render", "s.json", "--spp", "2", "--first-sample", str(2**32 - 1)],
                      ["merge", "a.bpa", "-o", "a.png"], ["explain", "s.json"], ["explain", "s.json", "--pixel", "0,0"],
                      ["check", "s.json", "--width", "1", "--spp", "1"], ["generate", "field", "--count", "1", "-o", "f.ply"],
                      ["generate", "cover", "--grid", "0"],
                      ["bench", "s.json", "--rounds", "1", "--time", "0.01", "--spp", "1"],
                      ["bench", "s.json", "--rounds", "1", "--time", "0.01"]):
            result = self.run_program(*words)
            said += result.stdout.decode() + result.errors
        self.assertRegex(said, r"\b1 sample per pixel")
        found = re.findall(r"[^\n]*(?<![\d.,])1 (?:sample|sphere|material|round|segment|effect|byte|device|pixel)s\b"
                           r"[^\n]*", said)
        self.assertEqual(found, [])


if __name__ == "__main__":
    main()
