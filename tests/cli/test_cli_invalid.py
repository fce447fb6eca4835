"""Samples that are left out: each cause is counted and named for what it is, from the kernel to the end of a render, in statistics,
in films and in what is merged of them.

In:    kernels whose sky is wrong in a known share of the samples.   Out: counts, compared with the share.
"""
import json
import os
import shutil

import bpa
from cli import ProgramTest, broken_kernels, main, scene

# By member of the statistics: what makes a sample invalid in this way, and the cause in words.
WHAT = {"not_finite_samples": ("splat(NAN)", "not finite"), "negative_samples": ("splat(R(-0.25))", "negative"),
        "out_of_range_samples": ("splat(R(1e6))", "brighter than the sums can hold")}


class Invalid(ProgramTest):
    def sky(self, value):
        if "kernels" in self.files():
            shutil.rmtree(self.path("kernels"))
        right = "madd3(fma(splat(R(0.5)), height, splat(R(0.5))), subtract3(top, bottom), bottom);"
        return broken_kernels(self, "light/sky.cl", f"const Vec3 radiance = {right}", f"Vec3 light = {right} light.x = {value}; return light;\n    const Vec3 radiance = light;")

    def render(self, here, *options, code=1):
        result = self.run_program("render", "s.json", "--stats", "s.stats", "-o", "s.bpa", *options, environment=here)
        self.assertEqual(result.returncode, code, result.errors)
        return json.loads(self.read("s.stats")), result.errors

    def counts(self, stats):
        return {name: stats[name] for name in WHAT}

    def setUp(self):
        super().setUp()
        # The camera looks along -z with x to the right, and samples lie in the middles of pixels, so that x below c z holds for
        # whole columns: below z / 2, for a quarter of them.
        self.write("s.json", scene(16, spheres=0, background=[0.5, 0.6, 0.7],
                                   camera={"vfov": 90, "pixel_sampling": "center", "samples_per_pixel": 4, "aspect_ratio": 1}))

    def test_causes(self):
        """A quarter of 16 * 16 * 4 samples, of each cause; in single and double precision, and by merge."""
        for precision in ("single", "double"):
            for name, (value, words) in WHAT.items():
                here = self.sky(f"choose(direction.x < splat(R(0.5)) * direction.z, {value}, light.x)")
                stats, said = self.render(here, "--precision", precision)
                self.assertEqual(stats["invalid_samples"], 256, name)
                self.assertEqual(self.counts(stats), {other: 256 if other == name else 0 for other in WHAT})
                self.assertIn(f"warning: 256 samples were invalid (256 {words}) and left out of the picture", said)
                self.assertIn(f"ballpark: s.bpa lacks 256 of 1024 samples that were invalid (256 {words}); `ballpark check`", said)
                self.fail_with(1, "merge", "s.bpa", "-o", "m.png",
                               says=f"ballpark: m.png lacks 256 samples that were invalid (256 {words}); `ballpark check`")
                self.assertIn("m.png", self.files())
                os.remove(self.path("m.png"))

    def test_all_at_once(self):
        """Three strips; a merge and a render that goes on add each cause to its like."""
        value = "light.x"
        for limit, (bad, _) in zip((0.25, 0.5, 0.75), WHAT.values()):
            value = f"choose(direction.x < splat(R({limit})) * direction.z, {bad}, {value})"
        here = self.sky(value)
        stats, said = self.render(here)
        # Columns 0 and 1, 2 and 3, 4 and 5: the last of the choices is the first that is asked.
        self.assertEqual(self.counts(stats), dict.fromkeys(WHAT, 128))
        causes = "128 not finite, 128 negative, 128 brighter than the sums can hold"
        self.assertIn(f"warning: 384 samples were invalid ({causes})", said)
        self.fail_with(1, "render", "s.json", "-q", "--first-sample", 4, "-o", "t.bpa", environment=here,
                       says=f"t.bpa lacks 384 of 1024 samples that were invalid ({causes})")
        doubled = causes.replace("128", "256")
        self.fail_with(1, "merge", "s.bpa", "t.bpa", "-o", "m.png", says=f"768 samples that were invalid ({doubled})")
        self.fail_with(1, "render", "s.json", "--resume", "s.bpa", "--spp", 8, "-o", "u.png", environment=here,
                       says=[f"warning: 768 samples were invalid ({doubled})",
                             f"u.png lacks 768 of 2048 samples that were invalid ({doubled})"])
        self.assertEqual(self.counts(bpa.read(self.read("t.bpa"))[0]), dict.fromkeys(WHAT, 128))

    def test_several_pictures(self):
        """What several scenes and a turntable are asked for is made to the end; the message counts what lacks samples."""
        here = self.sky("choose(direction.x < splat(R(0.5)) * direction.z, splat(NAN), light.x)")
        self.write("t.json", scene(8, spheres=0, background=[0.5, 0.6, 0.7], camera={"lookfrom": [0, 0, 0], "lookat": [1, 0, 0]}))
        # From the middle of the scene along x: nothing of the picture's directions lies to the left of the wrong part.
        self.write("u.json", json.loads(self.read("s.json")))
        self.fail_with(1, "render", "s.json", "t.json", "u.json", "--stats", "all.stats", environment=here,
                       says="ballpark: s.png lacks 256 of 1024 samples that were invalid (256 not finite), and so do 1 more of 3 pictures; ")
        self.assertTrue({"s.png", "t.png", "u.png"} <= set(self.files()))
        lost = [one["not_finite_samples"] for one in json.loads(self.read("all.stats"))["renders"]]
        self.assertEqual(lost, [256, 0, 256])
        here = self.sky("choose(direction.y < splat(R(-0.4)), splat(R(-1.0)), light.x)")
        self.fail_with(1, "render", "s.json", "--turntable", 3, "-o", "turn.png", environment=here,
                       says="negative), and so do 2 more of 3 pictures; ")
        self.assertEqual(len([name for name in self.files() if name.startswith("turn-")]), 3)

    def test_nothing_left(self):
        """When most samples are invalid there is no picture, and the cause is the one."""
        for name, (value, words) in WHAT.items():
            here = self.sky(value)
            self.fail_with(1, "render", "s.json", "-o", "x.png", environment=here,
                           says=[f"1024 of 1024 samples are invalid (1024 {words}), so x.png was not written"])
            self.assertNotIn("x.png", self.files())

    def test_valid(self):
        """Without any, films and statistics have zeros."""
        stats, said = self.render({}, code=0)
        self.assertEqual(self.counts(stats), dict.fromkeys(WHAT, 0))
        self.assertNotIn("invalid", said)
        self.assertEqual(self.counts(bpa.read(self.read("s.bpa"))[0]), dict.fromkeys(WHAT, 0))


if __name__ == "__main__":
    main()
