"""Whole pictures by the real program whose sums are known in closed form to a few parts in a thousand: the width of a lens,
a lens and time, which must not share their numbers, how far paths fly through fog, and what fog leaves of a lamp's light.

Run as: python3 test_closed_pictures.py PROGRAM SOURCE_DIR
"""
import math

import cli
from pfm import read_pfm

BLACK = {"background": [0, 0, 0]}
LAMP = {"lamp": {"type": "diffuse_light", "emit": [1, 1, 1]}}


class ClosedPictures(cli.ProgramTest):
    def picture(self, document, lamps="off"):
        self.write("s.json", document)
        self.succeed("render", "s.json", "-o", "s.pfm", "--quiet", "--light-sampling", lamps, "--sampler", "independent")
        width, height, numbers = read_pfm(self.read("s.pfm"))
        return width, height, numbers[::3]

    # A lens of radius A at the origin, focused at distance F, looks at a small ball at distance D on its axis. A ray from the point p
    # of the lens to the middle of the ball meets the plane in focus at (1 - F / D) p. So the ball is seen there as a disk of radius
    # A |1 - F / D|, softened by the ball's own disk, S F / D wide: the mean square of the distance from the middle is half the sum of
    # the two squares.
    A, F, SIZE, S = 0.2, 4.0, 64, 0.04

    def spread(self, picture):
        """The mean square of the distance from the middle, in the plane in focus, and the standard error's share of it."""
        width, height, values = picture
        side, total, square, fourth = 1.0 / width, 0.0, 0.0, 0.0
        for row in range(height):
            for column in range(width):
                value = values[row * width + column]
                here = ((column + 0.5 - width / 2) ** 2 + (row + 0.5 - height / 2) ** 2 - 1 / 6) * side ** 2  # W. Sheppard, 1898
                total, square, fourth = total + value, square + value * here, fourth + value * here ** 2
        mean = square / total
        return mean, math.sqrt(max(0.0, fourth / total - mean ** 2) / (total * self.samples)) / mean

    def lens(self, **ball):
        self.samples = 4096
        document = cli.scene(self.SIZE, self.SIZE, materials=LAMP, **BLACK, spheres=[{"radius": self.S, "material": "lamp", **ball}],
                             camera={"vfov": math.degrees(2 * math.atan(0.5 / self.F)), "aperture": 2 * self.A, "focus_dist": self.F,
                                     "samples_per_pixel": self.samples, "max_depth": 1})
        return self.picture(document)

    def expected(self, first, last):
        """The mean over the time, in which the ball moves along the axis; it is met as often as its disk in focus is large."""
        steps, above, below = 10000, 0.0, 0.0
        for step in range(steps):
            distance = first + (last - first) * (step + 0.5) / steps
            near = (self.S * self.F / distance) ** 2
            above += near * 0.5 * ((self.A * (1 - self.F / distance)) ** 2 + near)
            below += near
        return above / below

    def assert_spread(self, picture, wanted):
        found, error = self.spread(picture)
        self.assertLess(error, 0.0025)
        self.assertLess(abs(found / wanted - 1), 3 * error + 0.002, (found, wanted, error))

    def test_how_wide_a_lens_is(self):
        self.assert_spread(self.lens(center=[0, 0, -2.2]), self.expected(2.2, 2.2))

    def test_lens_and_time(self):
        self.assert_spread(self.lens(center=[0, 0, -2.2], center_end=[0, 0, -3.2]), self.expected(2.2, 3.2))

    def test_how_far_paths_fly(self):
        """Through a ball of fog to a lamp behind it. Each crossing of its rim ends a segment, so of three segments none is left for a
        path that the fog has scattered: exp(-depth) of the light arrives, by the mean over the way through the ball."""
        density, radius, side = 2.0, 1.0, 0.2
        document = cli.scene(64, 64, materials={**LAMP, "edge": {"type": "interface"}}, media={"fog": {"scattering": density}}, **BLACK,
                             spheres=[{"center": [0, 0, -5], "radius": radius, "material": "edge", "interior": "fog"},
                                      {"center": [0, 0, -60], "radius": 40, "material": "lamp"}],
                             camera={"projection": "orthographic", "view_height": side, "samples_per_pixel": 2048, "max_depth": 3})
        values = self.picture(document)[2]
        found = sum(values) / len(values)
        wanted = sum(math.exp(-density * 2 * math.sqrt(radius ** 2 - ((x + 0.5) / 200 - 0.5) ** 2 * side ** 2 - ((y + 0.5) / 200 - 0.5) ** 2 * side ** 2))
                     for x in range(200) for y in range(200)) / 200 ** 2
        error = math.sqrt((1 - wanted) / (wanted * len(values) * 2048))
        self.assertLess(error, 0.003)
        self.assertLess(abs(found / wanted - 1), 4 * error, (found, wanted))

    def test_rough_and_white(self):
        """A white surface sends back all light, however rough it is: no sample of one under an even sky shows anything but the sky."""
        for roughness in (0, 0.3, 1):
            document = cli.scene(32, 32, materials={"m": {"type": "oren_nayar", "albedo": [1, 1, 1], "roughness": roughness}},
                                 spheres=[{"center": [0, 0, -2], "radius": 1, "material": "m"}], background=[1, 1, 1],
                                 camera={"samples_per_pixel": 64})
            self.assertEqual(set(self.picture(document)[2]), {1.0}, roughness)

    def test_fog_before_a_lamp(self):
        """A ray is sent to a tiny lamp 5 away, from ground 1 below the camera: of the light exp(-0.6 (5 + 1)) is left."""
        means = []
        for absorption in (0, 0.6):
            document = cli.scene(8, 8, materials={"lamp": {"type": "diffuse_light", "emit": [1e7, 1e7, 1e7]}, "ground": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
                                 spheres=[{"center": [0, -1000, 0], "radius": 1000, "material": "ground"}, {"center": [3, 4, 0], "radius": 0.002, "material": "lamp"}],
                                 camera={"vfov": 0.5, "lookfrom": [0, 1, 0], "lookat": [0, 0, 0], "vup": [0, 0, 1], "samples_per_pixel": 64, "max_depth": 2}, **BLACK)
            if absorption > 0:
                document.update(media={"fog": {"absorption": absorption}}, medium="fog")
            values = self.picture(document, "on")[2]
            means.append(sum(values) / len(values))
        self.assertAlmostEqual(means[1] / means[0] / math.exp(-0.6 * 6), 1, delta=0.003)


if __name__ == "__main__":
    cli.main()
