"""The orthographic camera: nothing looks smaller for being far, whatever the distance, with every way to place it."""

import json
import math

import cli
import exr

LAMP = {"m": {"type": "diffuse_light", "emit": [1, 1, 1]}}
SIZE = ("--width", 40, "--spp", 16, "--quiet")


def camera(**members):
    return {"projection": "orthographic", "view_height": 4, "lookfrom": [0, 0, 5], "lookat": [0, 0, 0], **members}


class Projection(cli.ProgramTest):
    def layers(self, name, *options):
        self.succeed("render", name, "-o", "out.exr", *SIZE, *options)
        return exr.read(self.read("out.exr"))

    def scene(self, name, spheres, view, **members):
        self.write(name, cli.scene(40, 30, camera=view, materials=LAMP, backdrop="none", spheres=[
            {"center": center, "radius": radius, "material": "m"} for center, radius in spheres], **members))

    def test_far_and_near_look_alike(self):
        self.scene("near.json", [([0.3, 0.2, 3], 0.8)], camera())
        self.scene("far.json", [([0.3, 0.2, -3000], 0.8)], camera())
        near, far = (self.layers(name)[2] for name in ("near.json", "far.json"))
        self.assertEqual(near["A"], far["A"])
        # The depth counts from lookfrom, wherever rays begin.
        for name, depth in (("near.json", 2), ("far.json", 3005)):
            found = min(self.layers(name)[2]["depth.Z"])
            self.assertAlmostEqual(found, depth - 0.8, delta=1e-2)

    def test_coverage_is_that_of_a_disc(self):
        for options in ([], ["--kernel", "sample", "--precision", "double"]):
            self.scene("scene.json", [([0.3, 0.2, -7], 0.8)], camera())
            alpha = self.layers("scene.json", "--spp", 64, "--sampler", "independent", *options)[2]["A"]
            expected = math.pi * 0.8 ** 2 / (4 * 4 * 40 / 30)
            deviation = math.sqrt(sum(a * (1 - a) / 64 for a in alpha)) / len(alpha)
            self.assertLess(abs(sum(alpha) / len(alpha) - expected), 4 * deviation)

    def test_a_million_units_away(self):
        """The scene far from the origin, and the camera far from the scene: the same picture."""
        self.scene("near.json", [([0.3, 0.2, 0], 0.8), ([-0.5, 0, 1], 0.3)], camera())
        self.scene("moved.json", [([1e6 + 0.3, 0.2 - 1e6, 1e6], 0.8), ([1e6 - 0.5, -1e6, 1e6 + 1], 0.3)],
                   camera(lookfrom=[1e6, -1e6, 1e6 + 5], lookat=[1e6, -1e6, 1e6]))
        self.scene("far.json", [([0.3, 0.2, 0], 0.8), ([-0.5, 0, 1], 0.3)], camera(lookfrom=[0, 0, 1e6]))
        near = self.layers("near.json")[2]["A"]
        for name in ("moved.json", "far.json"):
            other = self.layers(name)[2]["A"]
            self.assertLess(sum(abs(a - b) for a, b in zip(near, other)) / len(near), 2e-4, name)

    def test_without_a_height_lookat_looks_as_large_as_before(self):
        for projection in ("perspective", "orthographic"):
            self.scene("scene.json", [([0, 0, 0], 0.5)], {"lookfrom": [0, 0, 100], "lookat": [0, 0, 0], "vfov": 2})
            alpha = self.layers("scene.json", "--projection", projection)[2]["A"]
            area = math.pi * 0.25 / ((200 * math.tan(math.radians(1))) ** 2 * 40 / 30)
            self.assertAlmostEqual(sum(alpha) / len(alpha), area, delta=2e-3)

    def test_fit(self):
        self.write("a.xyz", "2\n\nO 0 0 0\nC 0 0 9\n")
        self.succeed("scene", "a.xyz", "--projection", "orthographic", "-o", "a.json", "--quiet")
        document = json.loads(self.read("a.json"))
        self.assertEqual((document["camera"]["projection"], document["camera"]["fit"]), ("orthographic", "particles"))
        self.assertNotIn("view_height", document["camera"])
        self.succeed("render", "a.xyz", "--projection", "orthographic", "-o", "a.pfm", *SIZE)
        self.succeed("render", "a.json", "-o", "b.pfm", *SIZE)
        self.assert_same(self.read("a.pfm"), self.read("b.pfm"))
        self.succeed("render", "a.json", "--turntable", 2, "-o", "t.exr", *SIZE, "--set", 'backdrop="none"')
        one, two = (exr.read(self.read(f"t-000{i}.exr"))[2]["A"] for i in range(2))
        self.assertAlmostEqual(sum(one), sum(two), delta=0.02 * sum(one))
        self.assertGreater(sum(one), 0)

    def test_scenes_are_written_again(self):
        for view in (camera(), camera(aperture=0.5, focus_dist=4), {"projection": "orthographic", "vfov": 20}):
            self.scene("scene.json", [([0.3, 0.2, -2], 0.8)], view)
            self.succeed("scene", "scene.json", "-o", "again.json", "--quiet")
            self.assertEqual(self.layers("scene.json")[2]["A"], self.layers("again.json")[2]["A"])

    def test_explain_shows_parallel_rays(self):
        self.scene("scene.json", [([0, 0, -1000], 50)], camera())
        for pixel in ("0,0", "39,29"):
            text = self.succeed("explain", "scene.json", "--pixel", pixel, "--wide").stdout.decode()
            self.assertIn("along (0.0000, 0.0000, -1.0000)", text.replace("-0.0000", "0.0000"))

    def test_mistakes(self):
        for view, words in (({"projection": "parallel"}, "camera.projection"),
                            ({"view_height": 2}, "camera.view_height: found without"),
                            ({"projection": "orthographic", "view_height": 0}, "camera.view_height: found 0"),
                            ({"projection": "orthographic", "view_height": 1, "fit": "scene"},
                             "camera.view_height: found beside \"fit\"")):
            self.scene("scene.json", [([0, 0, -1], 0.5)], view)
            self.fail_with(2, "render", "scene.json", "-o", "a.png", says=("scene.json:", words))


cli.main()
