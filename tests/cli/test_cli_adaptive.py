"""`render --adaptive`: every stop rule works with it, its counts are told, its files merge."""

import json

import exr
from cli import ProgramTest, main, scene


class Adaptive(ProgramTest):
    def setUp(self):
        super().setUp()
        # Noise below, where the light that balls and ground exchange is; a sky without any above.
        self.write("s.json", scene(48, 40, [
            {"center": [0, 0, -1.2], "radius": 0.5, "material": "m"},
            {"center": [0, -100.5, -1], "radius": 100, "material": "m"}], background=[1, 1, 1]))

    def render(self, *options, output="out.bpa"):
        said = self.succeed("render", "s.json", "--adaptive", "-o", output, "--stats", "stats.json", *options).errors
        stats = json.loads(self.read("stats.json"))
        self.assertTrue(stats["adaptive"])
        self.assertAlmostEqual(stats["samples_mean"] * stats["width"] * stats["height"], stats["samples"], delta=1e-3)
        self.assertLessEqual(stats["samples_min"], stats["samples_mean"])
        self.assertLessEqual(stats["samples_mean"], stats["samples_max"])
        self.assertIn(f"({stats['samples_min']} to {stats['samples_max']})", said)
        return stats

    def test_samples(self):
        stats = self.render("--spp", 100)
        self.assertEqual(stats["stopped_by"], "samples")
        self.assertTrue(95 < stats["samples_mean"] <= 100, stats["samples_mean"])
        self.assertTrue(stats["samples_min"] < 100 < stats["samples_max"])
        again = self.read("out.bpa")
        self.render("--spp", 100)
        self.assert_same(again, self.read("out.bpa"))

    def test_other_forms(self):
        """Chunks that are lists of pixels, by every form of the kernel."""
        self.render("--spp", 40)
        packets = self.read("out.bpa")
        for form in ("sample", "pool"):
            self.assertEqual(self.render("--spp", 40, "--kernel", form)["kernel"], form)
            self.assert_same(packets, self.read("out.bpa"), form)

    def test_error(self):
        stats = self.render("--error", 2)
        self.assertEqual(stats["stopped_by"], "error")
        self.assertTrue(0.01 < stats["nrmse"] <= 0.02, stats["nrmse"])
        even = json.loads(self.succeed("render", "s.json", "-o", "even.png", "--error", 2, "--stats", "-", "-q").stdout)
        self.assertLess(stats["samples_mean"], even["samples_mean"])
        self.assertEqual((even["adaptive"], even["samples_min"], even["samples_max"]),
                         (False, even["samples_per_pixel"], even["samples_per_pixel"]))

    def test_time_and_the_first_rule(self):
        self.assertEqual(self.render("--time", 0.5)["stopped_by"], "time")
        self.assertEqual(self.render("--time", 60, "--error", 3)["stopped_by"], "error")
        self.assertEqual(self.render("--time", 60, "--error", 0.01, "--spp", 40)["stopped_by"], "samples")

    def test_black_and_constant_pictures_end(self):
        self.write("s.json", scene(20, 20, 0, background=[0, 0, 0]))
        self.assertEqual(self.render("--error", 1)["stopped_by"], "black")
        self.write("s.json", scene(20, 20, 0, background=[1, 1, 1]))
        self.assertEqual(self.render("--error", 1)["stopped_by"], "constant")

    def test_counts_are_a_layer(self):
        stats = self.render("--spp", 64, output="out.exr")
        width, height, layers = exr.read(self.read("out.exr"))
        counts = layers["samples"]
        self.assertEqual((min(counts), max(counts), sum(counts)),
                         (stats["samples_min"], stats["samples_max"], stats["samples"]))
        # More of them below, where the noise is, than in the sky.
        self.assertGreater(sum(counts[len(counts) // 2:]), 1.3 * sum(counts[:len(counts) // 2]))
        self.render("--spp", 64, "--error-map", "map.png")
        self.assertIn("map.png", self.files())

    def test_merge(self):
        stats = self.render("--spp", 64, output="a.bpa")
        self.succeed("render", "s.json", "--spp", 16, "-o", "b.bpa", "--first-sample", stats["samples_max"])
        self.succeed("render", "s.json", "--spp", 16, "-o", "c.bpa", "--first-sample", 32)
        said = self.succeed("merge", "a.bpa", "b.bpa", "-o", "ab.exr").errors
        self.assertIn("incomplete in some pixels", said)
        counts = exr.read(self.read("ab.exr"))[2]["samples"]
        self.assertEqual((min(counts), max(counts)), (stats["samples_min"] + 16, stats["samples_max"] + 16))
        refused = self.run_program("merge", "a.bpa", "c.bpa", "-o", "ac.exr")
        self.assertEqual(refused.returncode, 2)
        self.assertIn("would count twice", refused.errors)

    def test_refusals(self):
        for options, says in ((["--spp", 31], "--spp 32"), ([], "8 samples"), (["--spp", 31, "--error", 1], "--spp 32")):
            refused = self.run_program("render", "s.json", "--adaptive", *options)
            self.assertEqual(refused.returncode, 2, options)
            self.assertIn(says, refused.errors)
        self.assertEqual(self.run_program("check", "s.json", "--adaptive").returncode, 2)
        self.assertEqual(self.files(), ["s.json"])


if __name__ == "__main__":
    main()
