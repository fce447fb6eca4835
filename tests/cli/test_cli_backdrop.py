"""What camera rays show that meet nothing: the background along any axis, a backdrop, or nothing, with an alpha."""

import json
import math

import cli
import exr
from pfm import read_pfm
from png import read_png

SKY = {"bottom": [0.25, 0.5, 0.75], "top": [1, 0.125, 0.5]}


class Backdrop(cli.ProgramTest):
    def picture(self, document, *options, name="out.pfm"):
        """Rows from the top of [r, g, b]."""
        self.write("scene.json", document)
        self.succeed("render", "scene.json", "-o", name, "--quiet", *options)
        width, height, values = read_pfm(self.read(name))
        rows = [[values[3 * (y * width + x):3 * (y * width + x) + 3] for x in range(width)] for y in range(height)]
        return rows[::-1]

    def test_the_sky_rises_along_its_up(self):
        camera = {"vfov": 60, "pixel_sampling": "center", "lookat": [1, 0, 0], "vup": [0, 0, 1]}
        plain = self.picture(cli.scene(9, 7, spheres=0, camera=camera, background=SKY))
        y_up = self.picture(cli.scene(9, 7, spheres=0, camera=camera, background={**SKY, "up": [0, 7, 0]}))
        self.assertEqual(plain, y_up)
        z_up = self.picture(cli.scene(9, 7, spheres=0, camera=camera, background={**SKY, "up": [0, 0, 2]}))
        self.assertNotEqual(plain, z_up)
        half = math.tan(math.radians(30))
        for row, line in enumerate(z_up):
            for column, pixel in enumerate(line):
                up = (1 - 2 * (row + 0.5) / 7) * half
                aside = (2 * (column + 0.5) / 9 - 1) * half * 9 / 7
                share = 0.5 + 0.5 * up / math.sqrt(1 + up * up + aside * aside)
                for c in range(3):
                    self.assertAlmostEqual(pixel[c], SKY["bottom"][c] + share * (SKY["top"][c] - SKY["bottom"][c]), 6)

    def test_a_backdrop_is_linear_over_the_height_for_every_camera(self):
        backdrop = {"bottom": [1, 0, 0.5], "top": [0, 2, 0.5]}
        for camera in ({"vfov": 100}, {"vfov": 20, "vup": [1, 1, 0], "lookat": [3, 1, -2]},
                       {"vfov": 40, "defocus_angle": 5, "focus_dist": 3, "lookfrom": [1e6, 0, 0], "lookat": [1e6, 0, 1]}):
            camera = {"pixel_sampling": "center", **camera}
            rows = self.picture(cli.scene(5, 8, spheres=0, camera=camera, backdrop=backdrop), "--spp", 4)
            for row, line in enumerate(rows):
                share = 1 - (row + 0.5) / 8
                for pixel in line:
                    for c in range(3):
                        self.assertAlmostEqual(
                            pixel[c], backdrop["bottom"][c] + share * (backdrop["top"][c] - backdrop["bottom"][c]), 5)

    def test_only_camera_rays_see_it(self):
        """A mirror fills the picture and shows the sky; a lens of index 1 too, for it is met."""
        for material in ({"type": "metal", "albedo": [1, 1, 1]}, {"type": "dielectric", "refraction_index": 1}):
            document = cli.scene(4, spheres=[{"center": [0, 0, -3], "radius": 2.9, "material": "m"}],
                                 materials={"m": material}, background=[0.5, 0.25, 1], backdrop=[9, 9, 9])
            self.assertEqual({tuple(pixel) for line in self.picture(document) for pixel in line}, {(0.5, 0.25, 1)})

    def test_a_picture_without_a_backdrop_is_the_one_with_the_sky_as_backdrop(self):
        sky = [0.5, 0.25, 0.125]
        document = cli.scene(16, spheres=3, background=sky)
        self.assertEqual(self.picture(document), self.picture({**document, "backdrop": sky}))
        every = self.picture({**document, "backdrop": sky}, "--effects", "all", "--kernel", "sample")
        self.assertEqual(self.picture(document), every)

    def sphere(self, **members):
        """A grey sphere whose silhouette is known, before nothing, in a sky of 1."""
        return cli.scene(40, 30, spheres=[{"center": [0.1, 0.05, -3], "radius": 0.8, "material": "m"}],
                         materials={"m": {"type": "diffuse_light", "emit": [0.5, 0.25, 1]}}, camera={"vfov": 40},
                         background=[1, 1, 1], backdrop="none", **members)

    def coverage(self, document):
        """The share of the picture that the sphere's outline covers: an ellipse of the picture's plane, summed up finely."""
        sphere, camera = document["spheres"][0], document["camera"]
        c, r, half = sphere["center"], sphere["radius"], math.tan(math.radians(camera["vfov"] / 2))
        n, inside = 600, 0
        for row in range(n):
            y = (1 - 2 * (row + 0.5) / n) * half
            for column in range(n):
                x = (2 * (column + 0.5) / n - 1) * half * 40 / 30
                along = (x * c[0] + y * c[1] - c[2]) ** 2 / (x * x + y * y + 1)
                inside += c[0] ** 2 + c[1] ** 2 + c[2] ** 2 - along < r * r
        return inside / n ** 2

    def alpha(self, name):
        width, height, channels = exr.read(self.read(name))
        return channels

    def test_alpha_is_the_coverage(self):
        document = self.sphere()
        expected = self.coverage(document)
        self.write("scene.json", document)
        spp = 64
        for options in (["--sampler", "independent"], ["--sampler", "independent", "--kernel", "sample"],
                        ["--sampler", "independent", "--precision", "double", "--seed", 5], []):
            self.succeed("render", "scene.json", "-o", "a.exr", "--spp", spp, "--quiet", *options)
            layers = self.alpha("a.exr")
            alpha = layers["A"]
            mean = sum(alpha) / len(alpha)
            # Independent samples: the variance of each pixel's mean is a (1 - a) / n; beside it the grid's own error.
            deviation = math.sqrt(sum(a * (1 - a) / spp for a in alpha)) / len(alpha)
            self.assertLess(abs(mean - expected), 4 * deviation + 2e-5, options)
            for a, red, green, blue in zip(alpha, layers["R"], layers["G"], layers["B"]):
                self.assertEqual(a * spp, round(a * spp))
                self.assertAlmostEqual(red, 0.5 * a, 6)  # premultiplied
                self.assertAlmostEqual(green, 0.25 * a, 6)
                self.assertAlmostEqual(blue, a, 6)
        self.assertTrue(any(0 < a < 1 for a in alpha))

    def test_clear_glass_is_met(self):
        document = self.sphere()
        document["materials"]["m"] = {"type": "dielectric", "refraction_index": 1}
        self.write("scene.json", document)
        self.succeed("render", "scene.json", "-o", "a.exr", "--quiet")
        layers = self.alpha("a.exr")
        self.assertEqual(max(layers["A"]), 1)
        self.assertEqual([a for a in layers["A"]], layers["R"])  # the sky of 1, seen through the glass alone

    def test_a_depth_of_0_and_of_1(self):
        self.write("scene.json", self.sphere())
        self.succeed("render", "scene.json", "-o", "zero.exr", "--depth", 0, "--quiet")
        self.succeed("render", "scene.json", "-o", "one.exr", "--depth", 1, "--quiet")
        self.succeed("render", "scene.json", "-o", "ten.exr", "--quiet")
        self.assertEqual(self.alpha("one.exr")["A"], self.alpha("ten.exr")["A"])
        self.assertEqual(set(self.alpha("zero.exr")["R"]), {0})

    def test_png_is_straight(self):
        self.write("scene.json", self.sphere(transfer="linear"))
        self.succeed("render", "scene.json", "-o", "a.exr", "--quiet")
        self.succeed("render", "scene.json", "-o", "a.png", "--quiet")
        width, height, bits, channels, rows, _ = read_png(self.read("a.png"))
        self.assertEqual((width, height, bits, channels), (40, 30, 8, 4))
        alpha = self.alpha("a.exr")["A"]
        for pixel, a in enumerate(alpha):
            red, green, blue, shown = rows[pixel // width][4 * (pixel % width):][:4]
            self.assertEqual(shown, math.floor(a * 255 + 0.5))
            self.assertEqual((red, green, blue), (128, 64, 255) if a > 0 else (0, 0, 0))
        self.succeed("render", "scene.json", "-o", "b.png", "--quiet", "--set", "backdrop=null")
        self.assertEqual(read_png(self.read("b.png"))[3], 3)

    def test_formats_without_alpha_say_so(self):
        self.write("scene.json", self.sphere())
        for name in ("a.ppm", "a.pfm"):
            self.assertIn("has no alpha", self.succeed("render", "scene.json", "-o", name).errors)
        self.assertNotIn("alpha", self.succeed("render", "scene.json", "-o", "a.png").errors)

    def test_alpha_survives_merge_resume_and_share(self):
        self.write("scene.json", self.sphere())
        self.succeed("render", "scene.json", "-o", "whole.exr", "--spp", 32, "--quiet")
        self.succeed("render", "scene.json", "-o", "whole.bpa", "--spp", 32, "--quiet")
        self.succeed("merge", "whole.bpa", "-o", "again.exr", "--quiet")
        self.assertEqual(self.read("again.exr"), self.read("whole.exr"))
        for share in (1, 2, 3):
            self.succeed("render", "scene.json", "-o", f"part{share}.bpa", "--spp", 32, "--share", f"{share}/3", "--quiet")
        self.succeed("merge", "part1.bpa", "part2.bpa", "part3.bpa", "-o", "merged.exr", "--quiet")
        self.assertEqual(self.read("merged.exr"), self.read("whole.exr"))
        self.succeed("render", "scene.json", "-o", "half.bpa", "--spp", 12, "--quiet")
        self.succeed("render", "scene.json", "--resume", "half.bpa", "-o", "resumed.exr", "--spp", 32, "--quiet")
        self.assertEqual(self.read("resumed.exr"), self.read("whole.exr"))
        self.succeed("render", "scene.json", "--adaptive", "--spp", 64, "-o", "adaptive.exr", "--quiet")
        layers = self.alpha("adaptive.exr")
        for a, n in zip(layers["A"], layers["samples"]):
            self.assertAlmostEqual(a * n, round(a * n), 3)
        self.assertGreater(len(set(layers["samples"])), 1)

    def test_a_film_that_lies_about_its_alpha_is_refused(self):
        self.write("scene.json", self.sphere())
        self.succeed("render", "scene.json", "-o", "a.bpa", "--quiet")
        data = self.read("a.bpa")
        header = json.loads(data[:data.index(b"\n")])
        self.assertIs(header["alpha"], True)
        self.succeed("render", "scene.json", "-o", "b.bpa", "--quiet", "--set", "backdrop=[1,1,1]")
        other = json.loads(self.read("b.bpa")[:self.read("b.bpa").index(b"\n")])
        self.assertIs(other["alpha"], False)
        self.assertNotEqual(header["scene_hash"], other["scene_hash"])

    def test_scenes_are_written_again(self):
        for members in ({"backdrop": "none"}, {"backdrop": [1, 0.5, 0.25]},
                        {"backdrop": {"bottom": [1, 0, 0], "top": [0, 0, 1]}},
                        {"background": {**SKY, "up": [0.5, 0, -2]}}):
            document = cli.scene(16, spheres=2, **members)
            self.write("scene.json", document)
            self.succeed("scene", "scene.json", "-o", "again.json", "--quiet")
            self.succeed("render", "scene.json", "-o", "a.exr", "--quiet")
            self.succeed("render", "again.json", "-o", "b.exr", "--quiet")
            self.assertEqual(self.read("a.exr"), self.read("b.exr"))
            again = json.loads(self.read("again.json"))
            self.assertEqual("backdrop" in again, "backdrop" in members)

    def test_explain_names_it(self):
        self.write("scene.json", cli.scene(8, spheres=0, backdrop=[1, 2, 3]))
        text = self.succeed("explain", "scene.json", "--pixel", "1,1").stdout.decode()
        self.assertIn("hits nothing: the backdrop", text)
        self.assertIn("radiance of the sample: (1, 2, 3)", text)

    def test_mistakes(self):
        def refused(members, *words):
            self.write("scene.json", cli.scene(8, spheres=0, **members))
            self.fail_with(2, "render", "scene.json", "-o", "a.png", says=("scene.json:", *words))
        refused({"backdrop": "nothing"}, "backdrop: found the text \"nothing\"", "expected \"none\", one colour")
        refused({"backdrop": 1}, "backdrop: found 1")
        refused({"backdrop": [1, 2]}, "backdrop")
        refused({"backdrop": [1, 2, -1]}, "backdrop: found -1", "radiances from 0 to 1e12")
        refused({"backdrop": {"bottom": [1, 1, 1]}}, "backdrop", "top")
        refused({"backdrop": {"bottom": [1, 1, 1], "top": [1, 1, 2e12]}}, "backdrop.top: found 2000000000000")
        refused({"backdrop": {"bottom": [1, 1, 1], "top": [1, 1, 1], "up": [0, 1, 0]}}, "up")
        refused({"background": {"up": [0, 0, 0]}}, "background.up", "the direction that is up")
        refused({"background": {"up": [0, 0, 2e12]}}, "background.up: found 2000000000000")
        refused({"background": {"up": "z"}}, "background.up")
        self.assertFalse("a.png" in self.files())


cli.main()
