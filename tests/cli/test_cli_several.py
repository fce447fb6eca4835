"""Several scenes in one run, and what a render says of a picture without spheres."""

import json
import os

from cli import ProgramTest, deep, main, scene

GLASS = {"m": {"type": "dielectric", "refraction_index": 1.5}}


class Several(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.json", scene())
        self.write("b.json", scene(spheres=2))
        self.write("c.json", scene(materials=GLASS))

    def test_pictures(self):
        self.succeed("render", "a.json", "b.json", "c.json")
        for name in "abc":
            self.succeed("render", f"{name}.json", "-o", "alone.png")
            self.assert_same(self.read(f"{name}.png"), self.read("alone.png"), name)

    def test_folder(self):
        os.mkdir(self.path("out"))
        self.succeed("render", "a.json", "b.json", "-o", "out", "--format", "pfm", "--error-map", "out/")
        self.assertEqual(sorted(os.listdir(self.path("out"))), ["a-error.png", "a.pfm", "b-error.png", "b.pfm"])
        self.succeed("render", "c.json", "-o", "out/")
        self.assertTrue(os.path.exists(self.path("out/c.png")))

    def test_kernel_is_built_once(self):
        report = json.loads(self.succeed("render", "a.json", "b.json", "c.json", "--stats", "-", "-q").stdout)
        builds = [one["seconds"]["kernel_build"] for one in report["renders"]]
        self.assertEqual([one["scene"] for one in report["renders"]], ["a.json", "b.json", "c.json"])
        self.assertGreater(builds[0], 0)
        self.assertEqual(builds[1], 0)
        self.assertGreater(builds[2], 0)

    def test_refused(self):
        self.fail_with(2, "render", "a.json", "b.json", "-o", "x.png", says=["x.png", "2 scenes need a file each", "folder"])
        self.fail_with(2, "render", "a.json", "b.json", "-o", "-", says="folder")
        self.fail_with(2, "render", "a.json", "b.json", "--error-map", "x.png", says="--error-map x.png")
        self.fail_with(2, "render", "a.json", "-", "-o", ".", says="standard input has no name")
        os.mkdir(self.path("sub"))
        self.write("sub/a.json", scene())
        self.fail_with(2, "render", "a.json", "sub/a.json", says=["a.json and sub/a.json", "both become a.png"])
        self.fail_with(2, "render", "a.json", "a.json", says="both become a.png")
        os.symlink("a.png", self.path("b.png"))
        self.write("a.png", "x")
        self.fail_with(2, "render", "a.json", "b.json", says="both become b.png")
        self.fail_with(2, "render", "a.json", "b.json", "--stats", "./a.png", says="both name")
        self.assertEqual(self.read("a.png"), b"x")

    def test_a_mistake_in_the_last_is_found_first(self):
        self.write("bad.json", "{")
        self.fail_with(2, "render", "a.json", "bad.json", says="bad.json:1:2")
        self.assertFalse(os.path.exists(self.path("a.png")))

    def test_a_failure_keeps_the_others(self):
        """The second asks for too little time to have a picture: the first is there, and so are the statistics."""
        self.write("many.json", scene(2000, height=2000))
        result = self.run_program("render", "a.json", "many.json", "c.json", "--time", "0.01", "--stats", "s.json")
        if result.returncode == 0:
            self.skipTest("a device that renders 4 million pixels in a hundredth of a second")
        self.assertEqual(result.returncode, 1, result.errors)
        self.assertIn("--time 0.01 ran out before every pixel had a sample", result.errors)
        self.assertEqual([one["scene"] for one in json.loads(self.read("s.json"))["renders"]], ["a.json", "many.json"])
        self.assertEqual(self.files(), ["a.json", "a.png", "b.json", "c.json", "many.json", "many.png", "s.json"])


class Empty(ProgramTest):
    NOTHING = "the picture shows no sphere"

    def said(self, **members):
        self.write("s.json", scene(**members))
        return self.succeed("render", "s.json").errors

    def test_no_sphere_in_view(self):
        for camera in ({"lookat": [0, 9, -1]}, {"lookfrom": [0, 0, -9], "lookat": [0, 0, -20]}, {"vfov": 0.001, "lookat": [1, 0, 0]},
                       {"lookat": [0, 9, -1], "aperture": 0.1, "focus_dist": 3}):
            self.assertIn(self.NOTHING, self.said(camera=camera), camera)

    @deep
    def test_lamps_out_of_view(self):
        lamp = {"m": {"type": "diffuse_light", "emit": [1, 1, 1]}}
        self.assertIn(self.NOTHING, self.said(materials=lamp, camera={"lookat": [0, 9, -1]}))
        self.assertNotIn(self.NOTHING, self.said(materials=lamp))
        self.assertNotIn(self.NOTHING, self.said(materials={"m": {"type": "lambertian", "albedo": [0, 0, 0]}}))
        self.assertNotIn(self.NOTHING, self.said(materials={"m": {"type": "normals"}}))

    def test_no_sphere_at_all(self):
        self.assertIn("the scene has no spheres", self.said(spheres=0, materials={}))

    def test_something_is_there(self):
        for camera in ({}, {"vfov": 170}, {"lookfrom": [-0.1, 0, -1.2]}, {"max_depth": 1}):
            said = self.said(camera=camera)
            self.assertNotIn(self.NOTHING, said, camera)
            self.assertNotIn("no spheres", said)

    def test_too_small_to_be_met(self):
        """In view, but between the samples: no path met anything, and every material scatters."""
        ball = [{"center": [0, 0, -1000], "radius": 1e-6, "material": "m"}]
        self.assertIn(self.NOTHING, self.said(spheres=ball))

    @deep
    def test_huge_ground_under_the_camera(self):
        """All planes along the edges of the view cut it, though the camera looks up; and fuzzy metal may end a path at once."""
        ground = [{"center": [0, -1001, 0], "radius": 1000, "material": "m"}]
        metal = {"m": {"type": "metal", "albedo": [1, 1, 1], "fuzz": 1}}
        for camera in ({}, {"aperture": 0.1, "focus_dist": 3}):
            self.assertIn(self.NOTHING, self.said(spheres=ground, materials=metal, camera={"lookat": [0, 9, -9], "vfov": 40, **camera}))
            for seen in {"lookat": [0, -1, -9], "vfov": 40}, {"lookat": [0, 2, -9], "vfov": 40}:
                self.assertNotIn(self.NOTHING, self.said(spheres=ground, materials=metal, camera={**seen, **camera}))

    def test_quiet(self):
        self.write("s.json", scene(camera={"lookat": [0, 9, -1]}))
        self.assertEqual(self.succeed("render", "s.json", "-q").errors, "")


if __name__ == "__main__":
    main()
