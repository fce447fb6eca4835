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


def room(unit, camera=None, background=None, media=None, **materials):
    """A matte ball, one of glass and a lamp, over a ground that is a ball too, with all lengths in that unit."""
    kinds = {"a": {"type": "lambertian", "albedo": [0.5] * 3}, "g": {"type": "dielectric", "refraction_index": 1.5},
             "l": {"type": "diffuse_light", "emit": [4] * 3}}
    for name, members in materials.items():
        kinds[name].update(members)
    balls = (([0, -0.1, -3], 0.5, "a"), ([0.9, 0, -3], 0.4, "g"), ([-0.9, 0.5, -3], 0.3, "l"), ([0, -50.6, -3], 50, "a"))
    return cli.scene(16, materials=kinds, camera={"max_depth": 20, "vfov": 60, "lookat": [0, 0, -unit],
                                                  "focus_dist": min(max(3 * unit, 1e-15), 1e12), **(camera or {})},
                     background=background or {"bottom": [0.2] * 3, "top": [1] * 3}, media=media or {},
                     spheres=[{"center": [place * unit for place in center], "radius": radius * unit, "material": material}
                              for center, radius, material in balls])


class Extremes(cli.ProgramTest):
    def numbers(self, document, *options, spp=256):
        self.write("s.json", document)
        result = self.succeed("render", "s.json", "--spp", spp, "-o", "p.pfm", "-q", *options)
        self.assertNotIn("not finite", result.errors)
        return read_pfm(self.read("p.pfm"))[2]

    def assert_one_light(self, document, within, what, *options, spp=256):
        """The pixels of both precisions differ by no more than that share of the picture's mean (root mean square)."""
        single, double = (self.numbers(document, "--precision", one, *options, spp=spp) for one in ("single", "double"))
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

    def test_cells_that_are_huge(self):
        """A corner of cells lies in the middle of the picture: on which side of it a point is does not depend on their size."""
        pictures = []
        for size in (1e3, 1e6, 1e9, 1e12):
            for origin in ([0, 0, 0], [-1e-3, -0.2, 0.1]):
                document = room(1)
                document["textures"] = {"t": {"type": "checker", "colors": [0.1, 0.9], "size": size, "origin": origin}}
                document["materials"]["a"]["albedo"] = {"texture": "t"}
                self.assert_one_light(document, 1e-4, (size, origin))
                if origin == [0, 0, 0]:
                    pictures.append(self.numbers(document))
        self.assertTrue(all(one == pictures[0] for one in pictures[1:]))

    def test_ends_of_every_member(self):
        """Whatever a number is, from one end of what is accepted to the other, all else being usual."""
        cases = {f"unit {unit:g}": room(unit) for unit in (1e-28, 1e-18, 1e-12, 1e-9, 1e6, 1e10)}
        for vfov in (1e-9, 1e-3, 179, 179.999):
            cases[f"vfov {vfov}"] = room(1, camera={"vfov": vfov})
        for distance in (1e-15, 1e-6, 1e6, 1e12):
            cases[f"focus_dist {distance}"] = room(1, camera={"focus_dist": distance, "defocus_angle": 2})
        for angle in (1e-4, 0.01, 90):
            light = 3 / math.sin(math.radians(angle)) ** 2
            cases[f"half_angle {angle}"] = room(1, background={"discs": [
                {"direction": [1, 2, 1], "half_angle": angle, "radiance": [min(1e12, light)] * 3}]})
        for light in (1e-30, 1e-12, 1e12):
            cases[f"emit {light}"] = room(1, background={"bottom": [0] * 3, "top": [0] * 3}, l={"emit": [light] * 3})
            cases[f"sky {light}"] = room(1, background={"bottom": [light] * 3, "top": [light] * 3})
        for density in (1e-12, 1e-3, 1e3, 1e12):
            for member in ("absorption", "scattering"):
                cases[f"{member} {density}"] = document = room(1, media={"f": {member: density}})
                document["spheres"][1]["interior"] = "f"
        for fuzz in (1e-30, 1e-6, 1 - 1e-7):
            cases[f"fuzz {fuzz}"] = room(1, a={"type": "metal", "fuzz": fuzz})
        for near in (1 + 1e-12, 1 + 1e-7, 1 - 1e-8, 1 + 1e-4):
            cases[f"index {near}"] = room(1, g={"refraction_index": near, "fresnel": "exact"})
        for far in (1e3, 1e6, 1e11):
            cases[f"far {far}"] = document = room(1, camera={"lookfrom": [far] * 3, "lookat": [far, far, far - 1]})
            for sphere in document["spheres"]:
                sphere["center"] = [place + far for place in sphere["center"]]
        for way in (1e-30, 1e3, 1e6):
            cases[f"moves {way}"] = document = room(1)
            document["spheres"][0]["center_end"] = [way, -0.1, -3]
        for name, document in cases.items():
            with self.subTest(name):
                # Where squares of lengths vanish in float, a lamp is found by chance alone: both are right, by other paths.
                within = 0.05 if name == "unit 1e-28" else 3e-3
                self.assert_one_light(document, within, name, "--effects", "all", spp=64)


if __name__ == "__main__":
    cli.main()
