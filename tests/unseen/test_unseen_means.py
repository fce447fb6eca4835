"""Does a pilot find as much light as there is? Scenes in which all of one light is found by chance, and large enough that samples find
it: the means and mean squares that the pilot says, and those of a picture of many samples.

    python3 tests/unseen/test_unseen_means.py PROGRAM SOURCE_DIR [--deep] [unittest's arguments]

Where there is other light too, the scene is rendered once more with what the light comes by made black: the difference is that light.
Paths are so short (max_depth) that nothing else makes a difference. A pilot's few hundred paths to what is seen leave 5 % to chance.
"""

import json
import math

import cli

WEIGHTS = (0.2126, 0.7152, 0.0722)
FLOOR = {"type": "lambertian", "albedo": [0.8, 0.8, 0.8]}
GLASS = {"type": "dielectric", "refraction_index": 1.5}
EXACT = dict(GLASS, fresnel="exact")
MIRROR = {"type": "metal", "albedo": [1, 1, 1], "fuzz": 0}
BLACK = {"type": "lambertian", "albedo": [0, 0, 0]}


def lamp(radiance):
    return {"type": "diffuse_light", "emit": [radiance] * 3}


class Means(cli.ProgramTest):
    def picture(self, document, samples):
        """Of the luminance of a sample, the mean and the mean square, and what the pilot says."""
        self.write("s.json", document)
        self.succeed("render", "s.json", "--spp", samples, "--sampler", "independent", "-o", "a.pfm", "-q", "--caustics", "off", "--stats", "a.json")
        stats = json.loads(self.read("a.json"))
        mean = sum(w * v for w, v in zip(WEIGHTS, stats["mean_radiance"]))
        self.assertLess(stats["unseen_part"], 0.3)  # samples have found it, often
        return mean, ((stats["nrmse"] or 0) * mean) ** 2 * samples, stats["unseen"] or {"mean": 0, "variance": 0}

    def compare(self, document, samples, without=None, within=0.15):
        mean, square, unseen = self.picture(document, samples)
        found, found_square = unseen["mean"], unseen["variance"]
        if without is not None:
            dark, _, rest = self.picture(without, samples)
            mean, found = mean - dark, found - rest["mean"]
        else:  # or there is the noise of other light as well
            self.assertAlmostEqual(found_square / square, 1, delta=2 * within)
        self.assertAlmostEqual(found / mean, 1, delta=within)

    def coated(self, coat, inside, direction, depth=4, half_angle=8):
        """A ball of radius 10 in a coat, under a disc; seen from above its top."""
        materials = {"inside": inside}
        spheres = [{"center": [0, -10, 0], "radius": 9.9, "material": "inside"}]
        if coat is not None:
            materials["coat"] = coat
            spheres.append({"center": [0, -10, 0], "radius": 10, "material": "coat"})
        return {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": depth, "lookfrom": [0, 12, 0],
                           "lookat": [0, 0, 0], "vup": [0, 0, 1], "vfov": 20},
                "background": {"bottom": [0, 0, 0], "top": [0, 0, 0],
                               "discs": [{"direction": direction, "half_angle": half_angle, "radiance": [10, 10, 10]}]},
                "materials": materials, "spheres": spheres}

    def below_the_horizon(self, ball, radius=0.15):
        """A floor that curves away from a lamp, and a ball above that sends it light; the camera sees the floor alone."""
        return {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": 3, "lookfrom": [0, 0.9, -3], "lookat": [0.2, 0, 0],
                           "vfov": 18},
                "background": {"bottom": [0, 0, 0], "top": [0, 0, 0]},
                "materials": {"floor": FLOOR, "ball": ball, "lamp": lamp(100)},
                "spheres": [{"center": [0, -10, 0], "radius": 10, "material": "floor"}, {"center": [0, 1.5, 0], "radius": 0.5, "material": "ball"},
                            {"center": [4, -0.62, 0], "radius": radius, "material": "lamp"}]}

    def test_light_of_narrow_lobes(self):
        """Rays are sent to the lamp from there, but which of the floor's rays come there is left to chance."""
        white = {"type": "metal", "albedo": [1, 1, 1]}
        self.compare(self.below_the_horizon({**white, "fuzz": 0.2, "fuzz_shape": "ball"}), 2048)
        self.compare(self.below_the_horizon({**white, "roughness": 0.25}), 2048)
        self.compare(self.below_the_horizon({**white, "fuzz": 0.15}), 2048, within=0.25)  # the density has a pole, which samples find seldom

    def test_light_of_coats(self):
        for roughness in (0, 0.3):
            self.compare(self.below_the_horizon({"type": "glossy", "albedo": [0, 0, 0], "roughness": roughness, "refraction_index": 3}, 0.25), 4096, within=0.25)

    def test_light_through_rough_glass(self):
        """From a lamp straight above the ball, that also reflects; the lamp lights the floor, too."""
        document = self.below_the_horizon({"type": "dielectric", "refraction_index": 1.5, "roughness": 0.25}, 0.1)
        document["camera"]["max_depth"] = 4
        document["spheres"][2]["center"] = [0.3, 3.5, 0]
        without = json.loads(json.dumps(document))
        without["materials"]["ball"] = BLACK
        self.compare(document, 1024, without)

    def test_glints(self):
        """Of a lamp that a ball shows the camera: smaller than a pixel."""
        for ball in ({"type": "metal", "albedo": [1, 1, 1], "fuzz": 0.05, "fuzz_shape": "ball"}, {"type": "metal", "albedo": [1, 1, 1], "roughness": 0.2}):
            document = self.below_the_horizon(ball, 0.1)
            document["camera"].update({"lookfrom": [1, 3, -8], "lookat": [0, 1.5, 0], "vfov": 30, "image_width": 16, "max_depth": 2})
            document["materials"]["floor"] = BLACK
            document["spheres"][2]["center"] = [4, 3, -3]
            self.compare(document, 16384, within=0.3)

    def test_glass_by_schlick(self):
        """What the book's reflectance makes of grazing light differs between both ways through a surface."""
        self.compare(self.coated(GLASS, FLOOR, [1, 0.25, 0]), 1024)

    def test_glass_exact(self):
        self.compare(self.coated(EXACT, FLOOR, [1, 0.25, 0]), 1024)
        self.compare(self.coated(EXACT, FLOOR, [1, 1, 0.2]), 1024)

    def test_lobes_in_glass(self):
        """Each lobe, under light from 60 degrees."""
        for lobe in ("cosine_cubed", "hemisphere"):
            self.compare(self.coated(EXACT, dict(FLOOR, scatter=lobe), [1, 0.6, 0]), 1024)

    def test_brushed_metal_in_glass(self):
        """Around the mirror direction."""
        for shape in ("sphere", "ball"):
            self.compare(self.coated(EXACT, {"type": "metal", "albedo": [1, 1, 1], "fuzz": 0.5, "fuzz_shape": shape}, [1, 1, 0.1]), 1024)

    def from_wall_to_wall(self, lobe):
        """Light that comes through glass to a surface of any lobe, and from there to another, as the camera sees it."""
        document = self.coated(dict(EXACT, refraction_index=1.1), dict(FLOOR, scatter=lobe), [1, 0.25, 0], depth=6)
        document["camera"].update(lookfrom=[0, 2, 0], lookat=[0, 6, 0.01], vfov=90)
        document["materials"]["wall"] = FLOOR
        document["spheres"].append({"center": [0, 7, 0], "radius": 3, "material": "wall"})
        black = json.loads(json.dumps(document))
        black["materials"]["inside"] = BLACK
        self.compare(document, 8192, black, 0.3)

    def test_from_wall_to_wall(self):
        self.from_wall_to_wall("hemisphere")

    def test_from_wall_to_wall_by_cosine_cubed(self):
        self.from_wall_to_wall("cosine_cubed")

    def test_glass_in_glass(self):
        """A way of light belongs to the sphere that it meets first, though others behind it are aimed at as well."""
        document = self.coated(EXACT, FLOOR, [1, 1, 0.2], depth=6)
        document["materials"]["gap"] = dict(EXACT, refraction_index=1 / 1.5)
        document["spheres"].append({"center": [0, -10, 0], "radius": 9.95, "material": "gap"})
        self.compare(document, 2048)

    def test_small_lamps(self):
        """Smaller than a pixel, and seen with nothing between: on paper."""
        places = [(x, y) for x in (-1.9, -0.6, 0.7, 2) for y in (-2.1, -0.8, 0.5, 1.8)]
        document = {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": 1, "lookfrom": [0, 0, 10],
                               "lookat": [0, 0, 0], "vfov": 35},
                    "background": {"bottom": [0, 0, 0], "top": [0, 0, 0]}, "materials": {"lamp": lamp(1e4), "floor": FLOOR},
                    "spheres": [{"center": [x, y, 0], "radius": 0.01, "material": "lamp"} for x, y in places]
                               + [{"center": [0, 0, 20], "radius": 1, "material": "floor"}]}  # behind the camera
        self.write("s.json", document)
        self.succeed("render", "s.json", "--spp", 2, "-o", "a.pfm", "-q", "--caustics", "off", "--stats", "a.json")
        unseen = json.loads(self.read("a.json"))["unseen"]
        mean = 1e4 * len(places) * math.pi * 0.01 ** 2 / (20 * math.tan(math.radians(17.5))) ** 2
        # About twelve camera paths pass each of them.
        self.assertAlmostEqual(unseen["mean"] / mean, 1, delta=0.25)
        self.assertAlmostEqual(unseen["variance"] / (1e4 * mean), 1, delta=0.25)
        self.assertEqual(unseen["direct"], 1)

    def test_mirror_and_floor(self):
        """A floor lit by a lamp by way of a mirror ball."""
        document = {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": 3, "lookfrom": [0, 6, 0],
                               "lookat": [0, 0, 0], "vup": [0, 0, 1], "vfov": 35},
                    "background": {"bottom": [0, 0, 0], "top": [0, 0, 0]},
                    "materials": {"floor": FLOOR, "mirror": MIRROR, "lamp": lamp(20)},
                    "spheres": [{"center": [0, -1000, 0], "radius": 1000, "material": "floor"},
                                {"center": [3.2, 1, 0], "radius": 1, "material": "mirror"},
                                {"center": [-3.5, 2.5, 0], "radius": 0.5, "material": "lamp"}]}
        black = json.loads(json.dumps(document))
        black["materials"]["mirror"] = dict(MIRROR, albedo=[0, 0, 0])
        self.compare(document, 4096, black)

    def test_bulb(self):
        """A lamp inside glass, off its middle, and a floor."""
        document = {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": 4, "lookfrom": [0, 6, 0],
                               "lookat": [0, 0, 0], "vup": [0, 0, 1], "vfov": 35},
                    "background": {"bottom": [0, 0, 0], "top": [0, 0, 0]},
                    "materials": {"floor": FLOOR, "glass": GLASS, "lamp": lamp(20)},
                    "spheres": [{"center": [0, -1000, 0], "radius": 1000, "material": "floor"},
                                {"center": [3.5, 1.5, 0], "radius": 1, "material": "glass"},
                                {"center": [3.2, 1.7, 0], "radius": 0.4, "material": "lamp"}]}
        self.compare(document, 2048)

    # ---- triangles ----

    def slab(self, glass, direction, depth=6):
        """A floor of two triangles under a box of glass, under a disc; seen from above."""
        document = self.coated(None, FLOOR, direction, depth)
        document.update(spheres=[], quads=[self.quad([-9, -1, 9], [18, 0, 0], [0, 0, -18], "inside")],
                        boxes=[{"corners": [[-2.7, -0.9, -2.7], [3.7, -0.1, 2.7]], "material": "glass"}])
        document["materials"]["glass"] = glass
        return document

    @staticmethod
    def quad(corner, u, v, material):
        return {"corner": corner, "u": u, "v": v, "material": material}

    def room(self, depth, materials, *quads, **more):
        """A floor of many triangles, seen from above."""
        grid = [self.quad([x, 0, z + 1], [1, 0, 0], [0, 0, -1], "floor") for x in range(-6, 6) for z in range(-6, 6)]
        return {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": depth, "lookfrom": [0, 6, 0],
                           "lookat": [0, 0, 0], "vup": [0, 0, 1], "vfov": 35},
                "background": {"bottom": [0, 0, 0], "top": [0, 0, 0]}, "materials": dict(materials, floor=FLOOR), "quads": grid + list(quads), **more}

    def test_box_of_glass(self):
        self.compare(self.slab(EXACT, [1, 0.25, 0]), 1024)
        self.compare(self.slab(GLASS, [1, 0.25, 0]), 1024)

    def test_box_in_a_box(self):
        """The index of a box that lies in glass is one over the ratio from inside."""
        document = self.slab(EXACT, [1, 1, 0.2], depth=10)
        document["boxes"].append({"corners": [[-2.6, -0.7, -2.6], [3.6, -0.3, 2.6]], "material": "gap"})
        document["materials"]["gap"] = dict(EXACT, refraction_index=1 / 1.5)
        self.compare(document, 2048)

    def test_flat_mirror(self):
        """Light of a lamp by way of a mirror on a wall."""
        wall = self.quad([2.5, 0.2, -2], [0, 0, 4], [-0.5, 2, 0], "mirror")
        lamps = [{"center": [-3.5, 2.5, 0], "radius": 0.5, "material": "lamp"}]
        document = self.room(3, {"mirror": MIRROR, "lamp": lamp(20)}, wall, spheres=lamps)
        black = json.loads(json.dumps(document))
        black["materials"]["mirror"] = dict(MIRROR, albedo=[0, 0, 0])
        self.compare(document, 2048, black)

    def test_lamps_in_a_window(self):
        """Small lamps that are seen through a pane of glass, or in it, as Fresnel has it on paper: 4 % at each side, and 0.01 % if the
        glass is nearly air. Nothing is matte, so no ray is sent to any of them."""
        places = [(x, y) for x in (-1.9, -0.6, 0.7, 2) for y in (-2.1, -0.8, 0.5, 1.8)]
        pane = [{"corners": [[-9, -9.01, -0.002], [9.01, 9, 0]], "material": "glass"}]
        thin = (0.02 / 2.02) ** 2
        for index, depth, z, part in ((1.5, 3, -10, 0.96 ** 2), (1.5, 2, 20, 0.04), (1.5, 4, 20, 0.04 + 0.96 ** 2 * 0.04), (1.02, 2, 20, thin)):
            away = 10 + abs(z)
            document = {"camera": {"image_width": 24, "aspect_ratio": 1, "samples_per_pixel": 64, "max_depth": depth, "lookfrom": [0, 0, 10],
                                   "lookat": [0, 0, 0], "vfov": 35},
                        "background": {"bottom": [0, 0, 0], "top": [0, 0, 0]}, "materials": {"lamp": lamp(1e4), "glass": dict(EXACT, refraction_index=index)},
                        "boxes": pane,
                        "spheres": [{"center": [x, y, z], "radius": 0.01, "material": "lamp"} for x, y in places]}
            self.write("s.json", document)
            self.succeed("render", "s.json", "--spp", 2, "-o", "a.pfm", "-q", "--stats", "a.json")
            unseen = json.loads(self.read("a.json"))["unseen"]
            mean = part * 1e4 * len(places) * math.pi * 0.01 ** 2 / (2 * away * math.tan(math.radians(17.5))) ** 2
            # About 15 camera paths tell of each of them, which leaves 7 % to chance.
            self.assertAlmostEqual(unseen["mean"] / mean, 1, delta=0.15, msg=(index, depth))
            self.assertAlmostEqual(unseen["variance"] / (1e4 * mean), 1, delta=0.15, msg=(index, depth))

    def test_lamp_of_triangles(self):
        """Rays are sent to them: nothing is left to chance on the way to a floor, straight or by way of a wall."""
        document = self.room(3, {"lamp": lamp(20)}, self.quad([3, 2.5, 0], [0.6, 0, 0], [0, 0, 0.6], "lamp"),
                             self.quad([3.7, 0, -3], [0, 0, 6], [0, 5, 0], "floor"), self.quad([2, 1.9, -3], [3, 0, 0], [0, 0, 6], "floor"))
        self.assertEqual(self.picture(document, 64)[2]["mean"], 0)

    def test_lamp_of_triangles_in_a_mirror(self):
        """From either side."""
        wall = self.quad([2.5, 0.2, -2], [0, 0, 4], [-0.5, 2, 0], "mirror")
        for sides in (([0, 0.9, 0.3], [0.3, 0, 0.9]), ([0.3, 0, 0.9], [0, 0.9, 0.3])):
            document = self.room(3, {"mirror": MIRROR, "lamp": lamp(20)}, wall, self.quad([-3.5, 2.2, 0], *sides, "lamp"))
            black = json.loads(json.dumps(document))
            black["materials"]["mirror"] = dict(MIRROR, albedo=[0, 0, 0])
            self.compare(document, 2048, black)

    def test_lamp_of_triangles_behind_glass(self):
        """What meets glass first belongs to the glass, and what does not is sampled."""
        aside = self.quad([6, 6.5, -1], [2, 0, 0], [0, 0, 2], "lamp")
        glass = [{"corners": [[2.2, 1, -1.5], [4.4, 1.6, 1.5]], "material": "glass"}]  # out of sight
        document = self.room(6, {"lamp": lamp(20), "glass": EXACT}, aside, boxes=glass)
        black = json.loads(json.dumps(document))
        black["materials"]["glass"] = BLACK
        self.compare(document, 4096, black)


cli.main()
