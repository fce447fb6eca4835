"""Smooth triangles against what is known of them in closed form or by quadrature.

Furnaces are exact however normals lie, since what a lobe sends below the surface is mirrored up with its weight; light from a sky
or a disc has the density of both directions that become one; mirror directions stay above the surface by the stated law; a ball of
triangles shows a sphere's normals.

Run as: python3 test_smooth.py PROGRAM SOURCE_DIR
"""

import json
import math
import random
import unittest

import cli
import test_triangle_optics as optics
from test_triangle_optics import WHITE, at, ball, glass, matte

BLACK = {"background": [0, 0, 0]}
# Straight down on the origin of a floor, which is so large that nothing else is seen.
ABOVE = {"lookfrom": [0, 5, 0], "lookat": [0, 0, 0], "vup": [0, 0, -1], "vfov": 1e-3, "image_width": 16, "max_depth": 3}


def unit(v):
    length = math.sqrt(sum(c * c for c in v))
    return [c / length for c in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def smooth(points, faces, normals, material):
    return [{"vertices": [points[i] for i in face], "normals": [normals[i] for i in face], "material": material} for face in faces]


def tilted(degrees):
    """A normal at this angle from upwards, towards x."""
    return [math.sin(math.radians(degrees)), math.cos(math.radians(degrees)), 0]


def floor(normal, material="m"):
    corners = [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]]
    return smooth(corners, [(0, 1, 2), (0, 2, 3)], [normal] * 4, material)


def folded_mean(density, normal, value, steps=400):
    """The mean of `value` over directions about a normal with a density of their cosine, where those below the floor are mirrored at it."""
    n, total = unit(normal), 0.0
    s = unit([n[1], -n[0], 0])
    t = [n[1] * s[2] - n[2] * s[1], n[2] * s[0] - n[0] * s[2], n[0] * s[1] - n[1] * s[0]]
    for i in range(steps):
        c = (i + 0.5) / steps
        r = math.sqrt(1 - c * c)
        for j in range(steps):
            turn = 2 * math.pi * (j + 0.5) / steps
            w = [c * a + r * (math.cos(turn) * b + math.sin(turn) * d) for a, b, d in zip(n, s, t)]
            total += density(c) * value([w[0], abs(w[1]), w[2]])
    return total * 2 * math.pi / steps ** 2


LOBES = {"lambertian": lambda c: c / math.pi, "cosine_cubed": lambda c: 2 * c ** 3 / math.pi, "hemisphere": lambda c: 1 / (2 * math.pi)}


class Smooth(unittest.TestCase):
    setUp, tearDown = optics.Optics.setUp, optics.Optics.tearDown
    run_ballpark, scene, render, mean, steps = (optics.Optics.run_ballpark, optics.Optics.scene, optics.Optics.render, optics.Optics.mean,
                                                optics.Optics.steps)

    def bodies(self):
        """Convex bodies: with normals of a sphere, and with normals that point anywhere."""
        chance = random.Random(5)
        for points, faces in (ball(0), ball(2)):
            yield smooth(points, faces, points, "m")
            yield smooth(points, faces, [unit([chance.gauss(0, 1) for _ in range(3)]) for _ in points], "m")

    # Furnaces.

    def test_convex_furnace(self):
        """What leaves a convex body meets a white sky, with the weight of the albedo."""
        look = {"lookfrom": [0.3, 0.2, 4], "lookat": [0, 0, 0], "vfov": 8}
        for body in self.bodies():
            for material in ([{**matte(0.7, 0.4, 0.2), "scatter": lobe} for lobe in LOBES] + [{"type": "metal", "albedo": [0.7, 0.4, 0.2]}]):
                for pixel in self.render(self.scene({"m": material}, look, WHITE, triangles=body)):
                    for value, albedo in zip(pixel, (0.7, 0.4, 0.2)):
                        self.assertAlmostEqual(value, albedo, delta=2e-6)
            for pixel in self.render(self.scene({"m": {"type": "oren_nayar", "albedo": [1, 1, 1], "roughness": 0.8}}, look, WHITE, triangles=body)):
                for value in pixel:
                    self.assertAlmostEqual(value, 1, delta=2e-6)

    def test_glass_furnace(self):
        """Glass takes no light, however its normals lie: every path that ends brings 1."""
        for body in self.bodies():
            document = self.scene({"m": glass()}, {"lookfrom": [0.3, 0.2, 4], "lookat": [0, 0, 0], "vfov": 30, "max_depth": 200}, WHITE, triangles=body)
            pixels = self.render(document, "--spp", "16")
            cut = json.loads((self.path / "out.json").read_text())["cut_paths"]
            missing = 1 - sum(sum(pixel) for pixel in pixels) / (3 * len(pixels))
            self.assertAlmostEqual(missing, cut / (16 * len(pixels)), delta=1e-6)

    def test_invisible(self):
        """Glass of index 1 is not there."""
        look = {"lookfrom": [0.3, 0.2, 4], "lookat": [0, 0, 0], "vfov": 30}
        for body in self.bodies():
            for one, other in zip(self.render(self.scene({"m": glass(1)}, look, triangles=body)), self.render(self.scene({"m": glass(1)}, look))):
                for a, b in zip(one, other):
                    self.assertAlmostEqual(a, b, delta=2e-6)

    def test_absorbed(self):
        """Of fuzzy metal only what lies below the normal that it shows is lost: (f - d) / 2f, or of a ball (f - d)^2 (2f + d) / 4f^3."""
        for degrees in (20, 55, 70):
            normal, d = tilted(degrees), math.cos(math.radians(degrees))
            for f in (0.3, 0.7, 1):
                if degrees > 44:  # bent: halfway between the eye and a mirror direction that rises by 1/64
                    d = math.cos(math.atan2(math.sin(2 * math.radians(degrees)), 1 / 64) / 2)
                for shape, lost in (("sphere", (f - d) / (2 * f)), ("ball", (f - d) ** 2 * (2 * f + d) / (4 * f ** 3))):
                    metal = {"type": "metal", "albedo": [1, 1, 1], "fuzz": f, "fuzz_shape": shape}
                    got = self.mean(self.scene({"m": metal}, ABOVE, WHITE, triangles=floor(normal)), "--spp", "1024")
                    self.assertAlmostEqual(got, 1 - (lost if d < f else 0), delta=3e-3, msg=f"{degrees} degrees, {shape} of {f}")

    # Light, by its density.

    def test_sky(self):
        """A floor whose normals lean, under a sky that depends on the height alone."""
        for degrees in (0, 30, 60, 88, 130):
            lean = tilted(degrees)
            shown = lean if degrees < 90 else [-c for c in lean]
            for lobe, density in LOBES.items():
                expected = folded_mean(density, shown, lambda w: 0.5 * (1 + w[1]))
                if lobe == "lambertian":
                    angle = math.radians(degrees if degrees < 90 else 180 - degrees)
                    upward = 4 / (3 * math.pi) * (math.sin(angle) + (math.pi - angle) * math.cos(angle)) - 2 / 3 * math.cos(angle)
                    self.assertAlmostEqual(expected, 0.5 * (1 + upward), delta=1e-4)
                document = self.scene({"m": {**matte(0.8, 0.8, 0.8), "scatter": lobe}}, ABOVE, {"background": {"bottom": [0, 0, 0], "top": [1, 1, 1]}},
                                      triangles=floor(lean))
                self.assertAlmostEqual(self.mean(document, "--spp", "1024") / (0.8 * expected), 1, delta=2e-3, msg=f"{lobe} at {degrees} degrees")

    def test_disc(self):
        """A disc of the sky that is low over the floor, on the side to which the normals lean: it sends light by two directions."""
        half = math.radians(4)
        for degrees, height in ((40, 10), (70, 6), (70, 40), (20, 80)):
            n, a = tilted(degrees), [math.cos(math.radians(height)), math.sin(math.radians(height)), 0]
            expected = math.sin(half) ** 2 * (dot(n, a) + max(0, dot(n, [a[0], -a[1], a[2]])))
            discs = {"background": {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": [{"direction": a, "half_angle": 4, "radiance": [9, 9, 9]}]}}
            document = self.scene({"m": matte(0.5, 0.5, 0.5)}, {**ABOVE, "max_depth": 2}, discs, triangles=floor(n))
            for options in (("--spp", "256"), ("--light-sampling", "off", "--spp", "16384")):
                self.assertAlmostEqual(self.mean(document, *options) / (4.5 * expected), 1, delta=3e-3 if len(options) < 3 else 0.02, msg=f"{degrees}, {height}")

    def test_no_light_from_below(self):
        """A lamp below a floor does not light its upper side, where that shows normals that see the lamp."""
        for material in (matte(0.9, 0.9, 0.9), {"type": "metal", "albedo": [1, 1, 1], "roughness": 0.6}, {"type": "metal", "albedo": [1, 1, 1], "fuzz": 0.8},
                         {"type": "glossy", "albedo": [0.9, 0.9, 0.9], "roughness": 0.5}):
            lamp = {"center": [3, -2, 0], "radius": 1, "material": "l"}
            document = self.scene({"m": material, "l": {"type": "diffuse_light", "emit": [9, 9, 9]}}, ABOVE, BLACK, triangles=floor(tilted(80)), spheres=[lamp])
            self.assertEqual({value for pixel in self.render(document, "--spp", "64") for value in pixel}, {0.0})

    def test_sampling(self):
        """Rays to lamps change no mean: a low ball and a panel over a floor whose normals lean towards them, or away."""
        kinds = {"rough metal": {"type": "metal", "albedo": [0.9, 0.9, 0.9], "roughness": 0.6}, "fuzz": {"type": "metal", "albedo": [0.9, 0.9, 0.9], "fuzz": 0.6},
                 "coat": {"type": "glossy", "albedo": [0.6, 0.6, 0.6], "roughness": 0.6}, "clay": {"type": "oren_nayar", "albedo": [0.7, 0.7, 0.7], "roughness": 0.8},
                 "frost": {"type": "dielectric", "refraction_index": 1.5, "roughness": 0.6}}
        for name, material in kinds.items():
            body = smooth(*(lambda points, faces: (at(points, [0, 0, 0]), faces, points))(*ball(0)), "m")
            document = self.scene({"m": material, "l": {"type": "diffuse_light", "emit": [5, 5, 5]}}, {"lookfrom": [0.5, 3, 3], "lookat": [0, 0, 0], "vfov": 42, "max_depth": 4},
                                  BLACK, triangles=body, spheres=[{"center": [2.2, -0.1, 0], "radius": 0.8, "material": "l"}],
                                  quads=[optics.quad([-2, -1.5, -1.5], [0, 2, 0], [0, 0, 3], "l")])
            on, off = self.mean(document, "--spp", "512"), self.mean(document, "--light-sampling", "off", "--spp", "2048")
            self.assertAlmostEqual(on / off, 1, delta=0.012, msg=name)

    # Mirrors, by the path of one ray.

    def mirrored(self, normal, come):
        """Where a mirror floor that shows a normal sends a ray that comes from a direction."""
        steps = self.steps(camera={"lookfrom": [5 * c for c in come], "lookat": [0, 0, 0], "vup": [0, 0.6, -0.8]}, materials={"m": {"type": "metal", "albedo": [1, 1, 1]}},
                           triangles=floor(normal))
        self.assertEqual(len(steps), 2)
        return steps[1]["direction"]

    def law(self, normal, come):
        """As docs/NUMERICS.md has it."""
        n = unit(normal)
        n = n if n[1] >= 0 else [-c for c in n]
        r = [2 * dot(come, n) * a - b for a, b in zip(n, come)]
        least = min(come[1] / 2, 1 / 64)
        return unit([r[0], max(r[1], least), r[2]])

    def test_mirrors(self):
        chance = random.Random(6)
        bent = 0
        for _ in range(24):
            come = unit([chance.uniform(-1, 1), chance.choice([0.01, 0.2, 1]), chance.uniform(-1, 1)])
            normal = unit([chance.gauss(0, 1), chance.gauss(0, 0.7), chance.gauss(0, 1)])
            expected, got = self.law(normal, come), self.mirrored(normal, come)
            bent += expected[1] < 0.016
            for a, b in zip(got, expected):
                self.assertAlmostEqual(a, b, delta=2e-5)
            self.assertGreater(got[1], 0)
        self.assertTrue(2 < bent < 20, bent)

    def test_mirrors_both_ways(self):
        """Where the normal is not bent, the way back is the same."""
        for come in ([0.3, 0.9, 0.2], [-0.5, 0.4, 0.6]):
            onward = self.mirrored([0.1, 1, -0.05], unit(come))
            for a, b in zip(self.mirrored([0.1, 1, -0.05], onward), unit(come)):
                self.assertAlmostEqual(a, b, delta=1e-5)

    # A ball.

    def test_ball(self):
        """Triangles with a sphere's normals show these, and light that a ball gets; those that a mesh gets from its faces are nearly as good."""
        points, faces = ball(3)
        look = {"lookfrom": [0, 0, 4], "lookat": [0, 0, 0], "vfov": 20}
        (self.path / "ball.off").write_text(f"OFF\n{len(points)} {len(faces)} 0\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points) +
                                            "".join(f"3 {a} {b} {c}\n" for a, b, c in faces))
        shapes = ({"triangles": smooth(points, faces, points, "m")}, {"meshes": [{"file": "ball.off", "material": "m", "smooth": True}]},
                  {"meshes": [{"file": "ball.off", "material": "m", "smooth": True, "scale": [-1, 1, 1]}]})
        sphere = {"spheres": [{"center": [0, 0, 0], "radius": 1, "material": "m"}]}
        expected = self.render(self.scene({"m": {"type": "normals"}}, look, **sphere))

        def off(shape):
            pixels = self.render(self.scene({"m": {"type": "normals"}}, look, **shape))
            return math.sqrt(sum((a - b) ** 2 for one, other in zip(pixels, expected) for a, b in zip(one, other)) / len(expected))
        flat = off({"triangles": optics.triangles(points, faces, "m")})
        for shape in shapes:
            self.assertLess(off(shape), flat / 4)
        lit = {"background": {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": [{"direction": [1, 1, 1], "half_angle": 10, "radiance": [9, 9, 9]}]}}
        expected = self.mean(self.scene({"m": matte(0.8, 0.8, 0.8)}, look, lit, **sphere), "--spp", "256")
        for shape in shapes:
            self.assertAlmostEqual(self.mean(self.scene({"m": matte(0.8, 0.8, 0.8)}, look, lit, **shape), "--spp", "256") / expected, 1, delta=4e-3)

    def test_own_normals(self):
        """Triangles whose normals are their planes' look as flat ones do."""
        points, faces = ball(0)
        def faced(face):
            u, v = ([points[face[k]][a] - points[face[0]][a] for a in range(3)] for k in (1, 2))
            return unit([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]])
        plain = optics.triangles(points, faces, "m")
        smoothed = [{**one, "normals": [faced(face)] * 3} for one, face in zip(plain, faces)]
        for material in (matte(0.8, 0.5, 0.2), {"type": "metal", "albedo": [0.9, 0.9, 0.9], "roughness": 0.4}, glass()):
            for one, other in zip(*(self.render(self.scene({"m": material}, triangles=each), "--spp", "16") for each in (plain, smoothed))):
                for a, b in zip(one, other):
                    self.assertAlmostEqual(a, b, delta=1e-4)

    def test_forms(self):
        """The same bits in all forms, with and without the code of other effects, and of few lanes."""
        points, faces = ball(0)
        members = {"triangles": smooth(points, faces, points, "a") + smooth(at(points, [2, 0, 0.3], 0.8), faces, points, "b") +
                                smooth(at(points, [-1.8, 0.1, 0.4], 0.7), faces, points, "c"),
                   "spheres": [{"center": [0, 3, 1], "radius": 0.7, "material": "l"}], "quads": [optics.quad([-9, -1, 9], [18, 0, 0], [0, 0, -18], "d")]}
        materials = {"a": {"type": "metal", "albedo": [0.9, 0.8, 0.7], "fuzz": 0.5}, "b": {"type": "dielectric", "refraction_index": 1.5, "roughness": 0.5},
                     "c": {"type": "glossy", "albedo": [0.2, 0.5, 0.8], "roughness": 0.4}, "d": matte(0.6, 0.6, 0.6), "l": {"type": "diffuse_light", "emit": [6, 6, 6]}}
        document = self.scene(materials, {"lookfrom": [0.5, 2, 6], "lookat": [0, 0, 0], "vfov": 40}, **members)
        for precision in ("single", "double"):
            first = self.render(document, "--precision", precision, "--kernel", "packet")
            for options in (("--kernel", "sample"), ("--kernel", "pool"), ("--kernel", "packet", "--effects", "all")):
                self.assertEqual(self.render(document, "--precision", precision, *options), first, f"{precision}, {options}")


if __name__ == "__main__":
    cli.main()
