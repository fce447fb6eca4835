"""A picture is right however bright the lamps are that it does not show: sums keep dim light beside bright lamps."""
import json
import struct

from cli import ProgramTest, deep, main, scene
from pfm import read_pfm

HIDDEN = [1e3, 1e6, 1e9, 1e12]  # times the radiance that is seen
SEEN = [1e-6, 1e-2, 1, 1e2, 1e6]
RADIANCE_MAX = 1e12


class DimTest(ProgramTest):
    def document(self, seen, hidden, emitter, spheres=()):
        """A sky of one radiance, and behind the camera a sphere that emits."""
        materials = {"m": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}}
        spheres = list(spheres)
        if hidden > 0:
            materials["lamp"] = dict(emitter, emit=[hidden] * 3)
            spheres.append({"center": [0, 0, 1e4], "radius": 1e-3, "material": "lamp"})
        return scene(width=8, height=8, spheres=spheres, materials=materials, background=[seen] * 3,
                     camera={"max_depth": 50, "vfov": 40})

    def statistics(self, name, *options):
        self.succeed("render", name, "-o", "x.pfm", "--stats", "stats.json", "-q", *options)
        return json.loads(self.read("stats.json"))

    @deep
    def test_a_sky_keeps_its_radiance(self):
        for emitter in ({"type": "diffuse_light"}, {"type": "dielectric", "refraction_index": 1.5}):
            for seen in SEEN:
                for ratio in HIDDEN:
                    if seen * ratio > RADIANCE_MAX:
                        continue
                    with self.subTest(seen=seen, ratio=ratio, emitter=emitter["type"]):
                        self.write("scene.json", self.document(seen, seen * ratio, emitter))
                        statistics = self.statistics("scene.json", "--spp", "4")
                        exact = struct.unpack("<f", struct.pack("<f", seen))[0]
                        for channel in statistics["mean_radiance"]:
                            self.assertLessEqual(abs(channel / exact - 1), 1e-6)
                        self.assertEqual(statistics["invalid_samples"], 0)
                        self.assertLessEqual(statistics["rounding"], 1e-6)

    def lit(self, seen, ratio, emitter):
        """A matte surface that fills the picture, so nearly flat and so near the axis that its normal is the direction of the
        lamp behind the camera; the document, and what every path brings back: of the sky and of the ray to the lamp."""
        albedo, distance = [0.5, 0.4, 0.3], 1e4
        sine = min(1e-3, ratio ** -0.5)  # so small that the cosine is the same for every point of the lamp
        spheres = [{"center": [0, 0, -1001], "radius": 1000, "material": "m"},
                   {"center": [0, 0, distance - 1], "radius": distance * sine, "material": "lamp"}]
        materials = {"m": {"type": "lambertian", "albedo": albedo}, "lamp": dict(emitter, emit=[seen * ratio] * 3)}
        document = scene(width=8, height=8, spheres=spheres, materials=materials, background=[seen] * 3,
                         camera={"max_depth": 50, "vfov": 0.01})
        return document, [a * seen * (1 + ratio * sine ** 2) for a in albedo]

    def assert_lit(self, seen, ratio, emitter, *options):
        document, exact = self.lit(seen, ratio, emitter)
        self.write("scene.json", document)
        statistics = self.statistics("scene.json", "--spp", "4", "--light-sampling", "on", *options)
        for channel, right in zip(statistics["mean_radiance"], exact):
            self.assertLessEqual(abs(channel / right - 1), 1e-6)
        self.assertEqual(statistics["invalid_samples"], 0)
        self.assertLessEqual(statistics["rounding"], 1e-6)

    def test_a_surface_lit_by_a_hidden_lamp(self):
        for seen, ratio in ((1e-6, 1e6), (1e-6, 1e12), (1e-2, 1e9), (1, 1e3), (1, 1e12), (1e6, 1e6)):
            with self.subTest(seen=seen, ratio=ratio):
                self.assert_lit(seen, ratio, {"type": "diffuse_light"})

    @deep
    def test_every_surface_lit_by_a_hidden_lamp(self):
        for emitter in ({"type": "diffuse_light"}, {"type": "dielectric", "refraction_index": 1.5}):
            for options in ([], ["--precision", "double"], ["--kernel", "sample"]):
                for seen in SEEN:
                    for ratio in HIDDEN:
                        if seen * ratio <= RADIANCE_MAX:
                            with self.subTest(seen=seen, ratio=ratio, emitter=emitter["type"], options=options):
                                self.assert_lit(seen, ratio, emitter, *options)

    @deep
    def test_shaded_spheres_look_the_same(self):
        """Light of many bounces, dimmer at each: pixel by pixel, in both precisions and forms. The hidden lamp is too small
        to be found by chance; rays to it would find the little light that it brings."""
        spheres = [{"center": [0.3 * i - 0.6, 0, -2], "radius": 0.2, "material": "m"} for i in range(5)]
        for seen in (1e-6, 1e-2, 1):
            for options in ([], ["--precision", "double"], ["--kernel", "sample"]):
                with self.subTest(seen=seen, options=options):
                    pictures = []
                    for hidden in (0, seen * 1e12):
                        self.write("scene.json", self.document(seen, hidden, {"type": "diffuse_light"}, spheres))
                        self.statistics("scene.json", "--spp", "8", "--light-sampling", "off", *options)
                        pictures.append(read_pfm(self.read("x.pfm"))[2])
                    mean = sum(pictures[0]) / len(pictures[0])
                    for without, beside in zip(*pictures):
                        self.assertLessEqual(abs(without - beside), 1e-6 * (mean + without))

    def test_the_check_looks_at_the_sums(self):
        self.write("scene.json", self.document(0.01, 100, {"type": "dielectric", "refraction_index": 1.5}))
        self.succeed("check", "scene.json", "--spp", "16", "--margin", "50", "--json", "c.json")
        picture = json.loads(self.read("c.json"))["results"][0]["picture"]
        self.assertLessEqual(picture["off"], picture["limit"])
        self.assertEqual(picture["limit"], 1e-6)

    def test_what_cannot_be_kept_is_said(self):
        """Emitting glass at full depth leaves less room than the sky of this scene needs."""
        document = self.document(1e-2, 1e12, {"type": "dielectric", "refraction_index": 1.5})
        self.write("scene.json", document)
        for depth, said in (("50", False), ("1000000", True)):
            done = self.succeed("render", "scene.json", "-o", "x.bpa", "--spp", "4", "--depth", depth, "--stats", "t.json")
            self.assertEqual("warning: rounding may have changed the picture by" in done.errors, said, done.errors)
            self.assertEqual(json.loads(self.read("t.json"))["rounding"] > 1e-6, said)
        done = self.succeed("merge", "x.bpa", "-o", "y.png")
        self.assertIn("warning: rounding may have changed the picture by", done.errors)
        document["background"] = [1e-6] * 3
        self.write("scene.json", document)
        done = self.succeed("render", "scene.json", "-o", "x.png", "--spp", "4", "--depth", "1000000")
        self.assertIn("warning: the picture is black because its light is", done.errors)


if __name__ == "__main__":
    main()
