"""Capsules: what the kernels make of them, and what is refused.

Every form of the kernel gives the same picture, bit for bit; furnaces have the values that optics knows; glass of index 1 is not
there; a capsule without a length is the sphere; and what capsules cannot do is refused, with its place and a remedy.

Run as: python3 test_capsules.py PROGRAM SOURCE_DIR
"""

import json

import cli
from scene_pictures import ScenePictures

MATERIALS = {
    "clay": {"type": "lambertian", "albedo": [0.8, 0.5, 0.3]}, "glass": {"type": "dielectric", "refraction_index": 1.5},
    "air": {"type": "dielectric", "refraction_index": 1}, "mirror": {"type": "metal", "albedo": [0.9, 0.7, 0.5]},
    "lamp": {"type": "diffuse_light", "emit": [4, 4, 4]}, "glow": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5], "emit": [1, 1, 1]},
    "skin": {"type": "interface"}, "mapped": {"type": "lambertian", "albedo": {"texture": "map"}}}
BAR = {"ends": [[-0.7, -0.2, 0.1], [0.6, 0.4, -0.3]], "radius": 0.3}


def scene(**members):
    camera = {"image_width": 24, "aspect_ratio": 1.5, "samples_per_pixel": 16, "max_depth": 60, "vfov": 30, "lookfrom": [0.5, 0.8, 4], "lookat": [0, 0, 0]}
    camera.update(members.pop("camera", {}))
    textures = {"map": {"type": "checker", "mapping": "surface", "repeat": [4, 2], "colors": [[0.9, 0.9, 0.9], [0.1, 0.1, 0.1]]}}
    return {"format": 1, "camera": camera, "textures": textures, "materials": MATERIALS, **members}


def bar(material, **members):
    return {**BAR, "material": material, **members}


class Capsules(ScenePictures):
    def test_forms(self):
        document = scene(spheres=[{"center": [0.3, 0.5, 1], "radius": 0.2, "material": "glass"}],
                         triangles=[{"vertices": [[-1, -0.6, 1], [1, -0.6, 1], [0, -0.6, -2]], "material": "clay"}],
                         capsules=[bar("mirror"), {"ends": [[0.8, -0.5, 0.5], [0.8, 0.5, 0.5]], "radius": 0.15, "material": "glass"},
                                   {"ends": [[-0.9, -0.45, 0.4], [0.2, -0.45, 0.9]], "radius": 0.15, "material": "clay"}])
        for numerics in ("robust", "plain"):
            first, *_ = self.render(document, "--numerics", numerics)
            for options in (("--kernel", "sample"), ("--kernel", "pool"), ("--effects", "all")):
                self.assertEqual(self.render(document, "--numerics", numerics, *options)[0], first, f"{numerics} {options}: other bits")

    # Convex and under a white sky: what a matte surface shows is its albedo, glass is not seen, and mirrors show their colour once.
    def test_furnaces(self):
        white = {"background": [1, 1, 1]}
        for material, colour in (("clay", (0.8, 0.5, 0.3)), ("mirror", (0.9, 0.7, 0.5)), ("glass", (1, 1, 1))):
            *_, values = self.render(scene(capsules=[bar(material)], **white))
            for channel in range(3):
                ends = sorted({round(value, 5) for value in values[channel::3]})
                self.assertAlmostEqual(ends[0], colour[channel], delta=2e-5, msg=material)
                self.assertAlmostEqual(ends[-1], 1, delta=2e-5, msg=material)

    # Rays pass straight on, so a gradient looks as if nothing were there.
    def test_index_one(self):
        *_, seen = self.render(scene(capsules=[bar("air")]))
        *_, empty = self.render(scene())
        for one, other in zip(seen, empty):
            self.assertAlmostEqual(one, other, delta=1e-5)

    def test_no_length(self):
        end = BAR["ends"][0]
        for material in ("clay", "glass", "mirror"):
            capsule, *_ = self.render(scene(capsules=[{"ends": [end, end], "radius": 0.6, "material": material}]))
            sphere, *_ = self.render(scene(spheres=[{"center": end, "radius": 0.6, "material": material}]))
            self.assertEqual(capsule, sphere, material)

    # Where it lies is read back from where it is seen along the axes.
    def test_place(self):
        square = {"image_width": 200, "aspect_ratio": 1, "samples_per_pixel": 1, "pixel_sampling": "center", "max_depth": 1, "projection": "orthographic",
                  "view_height": 4, "lookfrom": [0, 0, 9], "lookat": [0, 0, 0]}
        ends, radius = [[-1.2, -0.4, 0.7], [0.9, 1.1, -0.5]], 0.35
        *_, values = self.render(scene(camera=square, background=[1, 1, 1], capsules=[{"ends": ends, "radius": radius, "material": "clay"}]))
        wrong = 0
        for row in range(200):
            for column in range(200):
                x, y = (column + 0.5) / 50 - 2, (row + 0.5) / 50 - 2
                way = [ends[1][a] - ends[0][a] for a in range(2)]
                place = min(1, max(0, ((x - ends[0][0]) * way[0] + (y - ends[0][1]) * way[1]) / (way[0] ** 2 + way[1] ** 2)))
                away = ((x - ends[0][0] - place * way[0]) ** 2 + (y - ends[0][1] - place * way[1]) ** 2) ** 0.5
                dark = values[3 * (200 * row + column)] < 0.5
                wrong += abs(away - radius) > 1e-5 and dark != (away < radius)
        self.assertEqual(wrong, 0)

    # Under a white sky each point of a convex matte surface shows its albedo: that of the half of which the ball that a ray
    # along z meets first, the highest on the axis, is part.
    def test_colors(self):
        ends, radius, colors = [[-1.2, -0.4, 0.7], [0.9, 1.1, -0.8]], 0.5, [[0.75, 0.25, 0.125], [0.125, 0.5, 0.875]]
        square = {"image_width": 60, "aspect_ratio": 1, "samples_per_pixel": 2, "pixel_sampling": "center", "projection": "orthographic",
                  "view_height": 4, "lookfrom": [0, 0, 9], "lookat": [0, 0, 0]}

        def height(place, x, y):
            at = [ends[0][a] + place * (ends[1][a] - ends[0][a]) for a in range(3)]
            square_left = radius ** 2 - (x - at[0]) ** 2 - (y - at[1]) ** 2
            return at[2] + square_left ** 0.5 if square_left > 0 else square_left - 9

        for material in ("clay", "plain"):  # "plain" has a texture, in place of which they stand, too
            materials = {**MATERIALS, "plain": {"type": "lambertian", "albedo": {"texture": "cells"}}}
            textures = {"cells": {"type": "checker", "colors": [[0.9, 0.9, 0.9], [0.1, 0.1, 0.1]], "size": 0.3}}
            document = {**scene(camera=square, background=[1, 1, 1], capsules=[{"ends": ends, "radius": radius, "material": material, "colors": colors}]),
                        "materials": {"clay": materials["clay"], material: materials[material]}, "textures": textures}
            *_, values = self.render(document)
            seen = [0, 0]
            for row in range(60):
                for column in range(60):
                    x, y = (column + 0.5) / 15 - 2, (row + 0.5) / 15 - 2
                    low, high = 0.0, 1.0  # the height is concave where it is one
                    for _ in range(60):
                        one, other = low + (high - low) / 3, high - (high - low) / 3
                        low, high = (one, high) if height(one, x, y) < height(other, x, y) else (low, other)
                    if height(low, x, y) < -8:
                        continue
                    self.assertGreater(abs(low - 0.5), 1e-6)
                    pixel = 3 * (60 * row + column)
                    for channel in range(3):
                        self.assertAlmostEqual(values[pixel + channel], colors[low > 0.5][channel], delta=2e-6, msg=f"{material} {x} {y} {low}")
                    seen[low > 0.5] += 1
            self.assertGreater(min(seen), 200)
        checked = self.run_ballpark(scene(capsules=[{"ends": ends, "radius": radius, "material": "mirror", "colors": colors}]), "check")
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    # Triangles look the same beside a capsule that is the first of all shapes in the tree: the half that their rays would meet of it
    # says nothing about them.
    def test_colors_beside_triangles(self):
        square = {"image_width": 40, "aspect_ratio": 1, "samples_per_pixel": 2, "pixel_sampling": "center", "projection": "orthographic",
                  "view_height": 4, "lookfrom": [0, 0, 9], "lookat": [0, 0, 0]}
        wall = [{"corner": [-2, -2, -1], "u": [4, 0, 0], "v": [0, 4, 0], "material": "mirror"}]
        colors = [[0.75, 0.25, 0.125], [0.125, 0.5, 0.875]]
        sticks = [{"ends": [[-1.5, -1 + 0.5 * k, 4], [-1, -1 + 0.5 * k, 4]], "radius": 0.1, "material": "clay", "colors": colors} for k in range(5)]
        for count in (1, 5):
            *_, values = self.render(scene(camera=square, background=[1, 1, 1], quads=wall, capsules=sticks[:count]), "--depth", "2")
            for row in range(40):
                for column in range(20, 40):  # the way back of the mirror is as far from the capsules
                    for channel, albedo in enumerate((0.9, 0.7, 0.5)):
                        self.assertAlmostEqual(values[3 * (40 * row + column) + channel], albedo, delta=2e-6, msg=f"{count}: {column}, {row}")

    def test_written_again(self):
        colors = [[0.5, 0.25, 0.125], [0, 1, 0.1]]
        document = scene(capsules=[bar("clay"), bar("mirror", colors=colors), {"ends": [[1, 2, 3], [1.0625, 2, 3.5]], "radius": 1e-3, "material": "glass"}])
        made = self.run_ballpark(document, "scene")
        self.assertEqual(made.returncode, 0, made.stderr)
        again = json.loads(made.stdout)["capsules"]
        self.assertAlmostEqual(again[1]["colors"][1].pop(), colors[1].pop(), delta=1e-8)  # colours are floats
        self.assertEqual(again, document["capsules"])

    def test_refusals(self):
        there = {"lookfrom": [0, 0, 0.3], "lookat": [0, 0, -1]}
        for said, members in (
                ("capsules[0].radius", {"capsules": [bar("clay", radius=-0.3)]}), ("capsules[0].radius", {"capsules": [bar("clay", radius=0)]}),
                ("no rays are sent to capsules", {"capsules": [bar("lamp")]}), ("no rays are sent to capsules", {"capsules": [bar("glow")]}),
                ("capsules have no longitude", {"capsules": [bar("mapped")]}),
                ("capsules stand still", {"capsules": [bar("clay", center_end=[0, 0, 0])]}), ("found in a capsule whose material is of type \"lambertian\"", {"media": {"fog": {}}, "capsules": [bar("clay", interior="fog")]}),
                ("two points", {"capsules": [bar("clay", ends=[[0, 0, 0]])]}), ("1e9", {"capsules": [bar("clay", ends=[[0, 0, 0], [2e9, 0, 0]])]}),
                ("capsules[0].colors: found colours for the material \"glass\", which has no albedo", {"capsules": [bar("glass", colors=[[0, 0, 0], [1, 1, 1]])]}),
                ("capsules[0].colors: found a list of 1, expected two colours", {"capsules": [bar("clay", colors=[[0, 0, 0]])]}),
                ("capsules[0].colors[1][2]: found 1.5, expected a share of light from 0 to 1", {"capsules": [bar("clay", colors=[[0, 0, 0], [0, 1, 1.5]])]}),
                ("capsules[0].colors[0]: found 0.5, expected a colour", {"capsules": [bar("clay", colors=[0.5, 0.5])]}),
                ("a capsule has two halves", {"capsules": [bar("clay", color=[0.5, 0.5, 0.5])]}),
                ("which is glass too", {"capsules": [bar("glass"), bar("air", ends=BAR["ends"][::-1])]}),
                ("move one of them slightly", {"camera": there, "capsules": [bar("clay", ends=[[-1, 0, 0], [1, 0, 0]])]})):
            made = self.run_ballpark(scene(**members), "render")
            self.assertEqual(made.returncode, 2, (said, made.stderr))
            self.assertIn(said, " ".join(made.stderr.split()))


if __name__ == "__main__":
    cli.main()
