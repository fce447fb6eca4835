"""The layers of an EXR that follow from the scene: depth, normal and albedo, against what geometry says."""

import math

import bpa
import cli
import exr
from pfm import read_pfm
from vectors import cross, dot, unit

TOLERANCE = 2e-6  # of single precision, a few roundings on


def rays(camera, width, height):
    """Unit directions of the rays through the pixels' centres: the book's camera."""
    position, target = camera["lookfrom"], camera["lookat"]
    forward = unit([t - p for p, t in zip(position, target)])
    right = unit(cross(forward, camera["vup"]))
    up = cross(right, forward)
    half = math.tan(math.radians(camera["vfov"]) / 2)
    for row in range(height):
        for column in range(width):
            x = (2 * (column + 0.5) / width - 1) * half * width / height
            y = (1 - 2 * (row + 0.5) / height) * half
            yield unit([f + x * r + y * u for f, r, u in zip(forward, right, up)])


class Features(cli.ProgramTest):
    def layers(self, document, *options):
        """(width, height, function of a layer's name and a pixel) of a render."""
        self.write("scene.json", document)
        self.succeed("render", "scene.json", "-o", "out.exr", *options)
        width, height, channels = exr.read(self.read("out.exr"))

        def values(layer, pixel):
            names = {"depth": ["depth.Z"], "normal": ["normal.X", "normal.Y", "normal.Z"],
                     "albedo": ["albedo.R", "albedo.G", "albedo.B"]}[layer]
            return [channels[name][pixel] for name in names]
        return width, height, values

    def assert_close(self, found, expected, scale=1.0, what=None):
        for one, other in zip(found, expected, strict=True):
            self.assertLessEqual(abs(one - other), TOLERANCE * scale, f"{what}: {found} for {expected}")

    def test_a_sphere_on_the_axis(self):
        camera = {"lookfrom": [0, 0, 2], "lookat": [0, 0, 0], "vup": [0, 1, 0], "vfov": 40,
                  "pixel_sampling": "center", "samples_per_pixel": 1}
        self.check_sphere(camera, [0, 0, -3], 1.0, 33, 21)
        width, height, values = self.layers(cli.scene(33, 21, camera=camera, spheres=[
            {"center": [0, 0, -3], "radius": 1, "material": "m"}]))
        middle = height // 2 * width + width // 2
        self.assert_close(values("depth", middle), [4.0])
        self.assert_close(values("normal", middle), [0, 0, 1])

    def test_a_tilted_view(self):
        camera = {"lookfrom": [7, -2, 1], "lookat": [1, 1.5, 3], "vup": [0.2, 1, 0.1], "vfov": 50,
                  "pixel_sampling": "center"}
        self.check_sphere(camera, [1.2, 1.3, 3.3], 1.7, 24, 17, "--spp", 20)

    def check_sphere(self, camera, centre, radius, columns, rows, *options):
        width, height, values = self.layers(cli.scene(columns, rows, camera=camera, spheres=[
            {"center": centre, "radius": radius, "material": "m"}]), *options)
        forward = unit([t - p for p, t in zip(camera["lookfrom"], camera["lookat"])])
        to_centre = [c - p for p, c in zip(camera["lookfrom"], centre)]
        met = 0
        for pixel, ray in enumerate(rays(camera, width, height)):
            along = dot(ray, to_centre)
            left = radius ** 2 - dot(to_centre, to_centre) + along ** 2
            if abs(left) < 0.02 * radius ** 2:
                continue  # the edge, where rounding counts
            if left < 0:
                self.assertEqual(values("depth", pixel), [math.inf])
                self.assertEqual(values("normal", pixel), [0, 0, 0])
                self.assertEqual(values("albedo", pixel), [0, 0, 0])
                continue
            met += 1
            point = [(along - math.sqrt(left)) * r for r in ray]
            # A grazing ray's distance errs by more: the root's slope.
            scale = 4 * radius / math.sqrt(left)
            self.assert_close(values("depth", pixel), [dot(point, forward)], 8 * scale, pixel)
            self.assert_close(values("normal", pixel), [(p - c) / radius for p, c in zip(point, to_centre)],
                              2 * scale, pixel)
            self.assert_close(values("albedo", pixel), [0.5, 0.4, 0.3], what=pixel)
        self.assertGreater(met, 30)

    def test_what_each_material_scatters(self):
        materials = {"diffuse": {"type": "lambertian", "albedo": [0.8, 0.1, 0.25]},
                     "metal": {"type": "metal", "albedo": [0.2, 0.9, 0.4], "fuzz": 0.3},
                     "glass": {"type": "dielectric", "refraction_index": 1.5},
                     "lamp": {"type": "diffuse_light", "emit": [4, 5, 6]},
                     "debug": {"type": "normals"}}
        expected = {"diffuse": [0.8, 0.1, 0.25], "metal": [0.2, 0.9, 0.4], "glass": [1, 1, 1], "lamp": [0, 0, 0],
                    "debug": [0, 0, 0]}
        spheres = [{"center": [2 * i - 4, 0, -20], "radius": 0.9, "material": name}
                   for i, name in enumerate(materials)]
        camera = {"vfov": 2 * math.degrees(math.atan(1 / 20))}  # a square a sphere
        for form in "sample", "packet":
            width, height, values = self.layers(
                cli.scene(15, 3, spheres, materials, camera=camera), "--kernel", form)
            for i, name in enumerate(materials):
                self.assert_close(values("albedo", width + 3 * i + 1), expected[name], what=(form, name))

    def test_edges_are_averages(self):
        # The axis touches the sphere 5 away: it fills the lower half of the middle row's pixels.
        camera = {"vfov": 10, "samples_per_pixel": 64}
        spheres = [{"center": [0, -10, -5], "radius": 10, "material": "m"}]
        width, height, values = self.layers(cli.scene(5, 5, spheres, camera=camera))
        for pixel in range(2 * width, 3 * width):
            self.assertTrue(3 < values("depth", pixel)[0] < 5, values("depth", pixel))
            for layer, full in ("normal", 1.0), ("albedo", 0.4):
                share = values(layer, pixel)[1] / full
                self.assertTrue(0.2 < share < 0.8, (layer, share))

    def test_colour_pays_nothing(self):
        self.write("scene.json", cli.scene(24, 16, 3))
        self.succeed("render", "scene.json", "-o", "out.pfm", "--seed", 5)
        layers = {}
        for form in "sample", "packet":
            self.succeed("render", "scene.json", "-o", f"{form}.exr", "--seed", 5, "--kernel", form)
            layers[form] = exr.read(self.read(f"{form}.exr"))
        width, height, channels = layers["packet"]
        self.assertEqual((width, height), (24, 16))
        self.assertEqual(sorted(channels), sorted(
            ["R", "G", "B", "error.R", "error.G", "error.B", "samples", "depth.Z", "normal.X", "normal.Y", "normal.Z",
             "albedo.R", "albedo.G", "albedo.B"]))
        for name in channels:
            self.assert_same(channels[name], layers["sample"][2][name], name)
        pfm = read_pfm(self.read("out.pfm"))[2].tolist()
        for channel, name in enumerate("RGB"):
            rows = [channels[name][y * 24:(y + 1) * 24] for y in reversed(range(16))]
            self.assert_same(pfm[channel::3], [value for row in rows for value in row], name)

    def test_merged_pictures_have_them(self):
        """Bit for bit those of one render, whichever samples the parts are of, and however few."""
        self.write("scene.json", cli.scene(12, 8))
        self.succeed("render", "scene.json", "-o", "whole.exr", "--spp", 22)
        for name, first, count in (("a", 0, 3), ("b", 3, 17), ("c", 20, 2)):
            self.succeed("render", "scene.json", "-o", name + ".bpa", "--spp", count, "--first-sample", first)
        said = self.succeed("merge", "c.bpa", "a.bpa", "b.bpa", "-o", "sum.exr").errors
        self.assertNotIn("omitted", said)
        self.assertEqual(self.read("sum.exr"), self.read("whole.exr"))
        self.succeed("merge", "c.bpa", "b.bpa", "-o", "bc.bpa")
        self.succeed("merge", "a.bpa", "bc.bpa", "-o", "sum.exr")
        self.assertEqual(self.read("sum.exr"), self.read("whole.exr"))

    def test_films_of_sums_alone_do_not_hold_them(self):
        self.write("scene.json", cli.scene(12, 8))
        for name, first in (("a", 0), ("b", 4)):
            self.succeed("render", "scene.json", "-o", name + ".bpa", "--spp", 4, "--first-sample", first)
            self.write(name + "2.bpa", bpa.sums_alone(self.read(name + ".bpa")))
        result = self.succeed("merge", "a2.bpa", "b2.bpa", "-o", "old.exr")
        self.assertIn("omitted: none of the .bpa files holds them", result.errors)
        self.assertEqual(sorted(exr.read(self.read("old.exr"))[2]),
                         sorted(["R", "G", "B", "error.R", "error.G", "error.B", "samples"]))
        self.succeed("merge", "a.bpa", "b.bpa", "-o", "new.exr")
        self.succeed("merge", "a2.bpa", "b.bpa", "-o", "mixed.exr")  # one that has them is enough
        self.assertEqual(self.read("mixed.exr"), self.read("new.exr"))


if __name__ == "__main__":
    cli.main()
