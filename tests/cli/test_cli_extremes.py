"""Scenes with numbers at the ends of what is accepted: single and double precision, which follow the same paths by the same
random numbers, bring the same light, or the scene is refused with the limit and a remedy.

Run as: python3 test_cli_extremes.py PROGRAM SOURCE_DIR [--deep] [unittest's arguments]"""

import math

import cli
from pfm import read_pfm

UP = [0.9606838054956776, -0.2370300730120966, -0.1445799790642653]


def ball(index, **members):
    """A ball of glass before a sky from black to white."""
    return cli.scene(12, materials={"g": {"type": "dielectric", "refraction_index": index, **members}},
                     spheres=[{"center": [0.013, 0.027, -3.1], "radius": 1, "material": "g"}],
                     camera={"vfov": 38, "max_depth": 60, "lookat": [0.01, 0.02, -1]},
                     background={"bottom": [0, 0, 0], "top": [1, 1, 1], "up": UP})


class Extremes(cli.ProgramTest):
    def numbers(self, document, *options, spp=256):
        self.write("s.json", document)
        result = self.succeed("render", "s.json", "--spp", spp, "-o", "p.pfm", "-q", *options)
        self.assertNotIn("not finite", result.errors)
        return read_pfm(self.read("p.pfm"))[2]

    def assert_one_light(self, document, within, what):
        """The pixels of both precisions differ by no more than that share of the picture's mean (root mean square)."""
        single, double = (self.numbers(document, "--precision", one) for one in ("single", "double"))
        off = math.sqrt(sum((a - b) ** 2 for a, b in zip(single, double)) / len(single))
        self.assertLess(off, within * sum(double) / len(double), what)

    def test_indices_far_from_1(self):
        """At 1e4 a ray is off by 1e-3, at random: what is off in a pixel is far less. Rays that went elsewhere were off by
        a tenth."""
        for index in (1e-4, 1e-2, 9, 1e3, 1e4):
            for members in ({"fresnel": "none"}, {"fresnel": "exact"}, {"total_reflection": "refract"}):
                for radius in (1, -1):
                    document = ball(index, **members)
                    document["spheres"][0]["radius"] = radius
                    self.assert_one_light(document, 1e-3, (index, members, radius))

    def test_a_hollow_ball_of_an_index_far_from_1(self):
        document = ball(1e4, fresnel="none")
        document["spheres"].append({**document["spheres"][0], "radius": -0.9})
        self.assert_one_light(document, 3e-3, "hollow")

    def test_indices_too_far_from_1(self):
        for index in (0.99e-4, 1e-6, 1.01e4, 1e6):
            self.write("s.json", ball(index))
            for command in (("render", "-o", "p.pfm"), ("check",)):
                self.fail_with(2, command[0], "s.json", *command[1:],
                               says=("materials.g.refraction_index", "1e-4 to 1e4", "--precision double"))
            self.succeed("render", "s.json", "--precision", "double", "-o", "p.pfm", "-q")
        unused = ball(1e6)
        unused["materials"]["m"] = {"type": "normals"}
        unused["spheres"][0]["material"] = "m"
        self.numbers(unused)

    def test_a_sky_that_is_black_at_an_end(self):
        """Rounding puts directions a little beyond the end, where the sky was less than black."""
        for step in range(24):
            up = [math.sin(step + 1), math.cos(2.3 * step), math.sin(3.1 * step + 2)]
            length = math.hypot(*up)
            for sign, ends in ((1, ((1, 1, 1), (0, 0, 0))), (-1, ((0, 0, 0), (1, 1, 1)))):
                document = cli.scene(2, spheres=[], background={"bottom": ends[0], "top": ends[1], "up": up}, camera={
                    "lookat": [sign * value / length for value in up], "vup": [0.3, 0.5, 0.7], "projection": "orthographic"})
                for precision in ("single", "double"):
                    for value in self.numbers(document, "--precision", precision, spp=1):
                        self.assertTrue(0 <= value < 1e-6, (step, sign, value))


if __name__ == "__main__":
    cli.main()
