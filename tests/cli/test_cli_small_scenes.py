"""Every command on scenes with next to nothing in them: no sphere, one or two, a picture of one pixel, with and without each
thing that a scene may have. A kernel with all effects, which reads arrays that such a scene leaves empty, makes the same picture
as the scene's own; the steps of a path end in the radiance of its pixel; and the reference agrees.

Run as: python3 test_cli_small_scenes.py PROGRAM SOURCE_DIR [--deep] [unittest's arguments]"""

import itertools
import json
import random
import struct

import cli
from pfm import read_pfm

MATERIALS = {
    "matte": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]},
    "metal": {"type": "metal", "albedo": [0.8, 0.7, 0.6], "fuzz": 0.3},
    "glass": {"type": "dielectric", "refraction_index": 1.5},
    "lamp": {"type": "diffuse_light", "emit": [3, 2, 1]},
    "normals": {"type": "normals"},
    "edge": {"type": "interface"},
    "checked": {"type": "lambertian", "albedo": {"texture": "checker"}},
    "noisy": {"type": "metal", "albedo": {"texture": "noise"}, "fuzz": {"texture": "grey"}},
    "painted": {"type": "diffuse_light", "emit": {"texture": "image"}},
}
TEXTURES = {
    "checker": {"type": "checker", "colors": [[0.2, 0.3, 0.1], [0.9, 0.9, 0.9]], "size": 0.3},
    "grey": {"type": "checker", "mapping": "surface", "colors": [0, 0.5], "repeat": [3, 2]},
    "noise": {"type": "noise", "pattern": "marble", "colors": [0.1, [0.9, 0.9, 0.8]], "size": 0.2},
    "image": {"type": "image", "file": "sky.pfm"},
}
# What may vary: of each, all that it can be.
CHOICES = {
    "spheres": (0, 1, 2),
    "first": tuple(MATERIALS),
    "second": tuple(MATERIALS),
    "sky": ("gradient", "black", "discs", "image", "image and disc", "backdrop"),
    "medium": ("none", "clear", "around", "inside", "both"),
    "camera": ("pinhole", "lens", "parallel", "inside"),
    "catcher": (False, True),
    "moves": (False, True),
    "particles": ("none", "one"),
    "size": ((1, 1), (3, 2)),
    "depth": (0, 1, 12),
}
SKIES = {
    "gradient": {}, "black": {"bottom": [0, 0, 0], "top": [0, 0, 0]},
    "discs": {"bottom": [0.1, 0.1, 0.1], "top": [0, 0, 0.2],
              "discs": [{"direction": [1, 2, 3], "half_angle": 20, "radiance": [5, 4, 3]},
                        {"direction": [0, -1, 0], "half_angle": 90, "radiance": [0.2, 0.2, 0.2]}]},
    "image": {"image": "sky.pfm"},
    "image and disc": {"image": "sky.pfm", "discs": [{"direction": [1, 2, 3], "half_angle": 20, "radiance": [5, 4, 3]}]},
    "backdrop": {},
}


NOTHING = {**{name: values[0] for name, values in CHOICES.items()}, "depth": 12}


def small_scene(choice):
    """The document of one choice of each."""
    width, height = choice["size"]
    camera = {"image_width": width, "image_height": height, "samples_per_pixel": 1, "max_depth": choice["depth"], "vfov": 60}
    camera.update({"lens": {"defocus_angle": 5, "focus_dist": 1}, "parallel": {"projection": "orthographic"},
                   "inside": {"lookfrom": [-0.1, 0, -1]}, "pinhole": {}}[choice["camera"]])
    if choice["camera"] == "inside":
        camera["lookat"] = [1, 0.3, -3]
    spheres = [{"center": [0.3 * i - 0.2, 0, -1 - 0.1 * i], "radius": 0.6 - 0.2 * i, "material": choice[name]}
               for i, name in enumerate(("first", "second")[:choice["spheres"]])]
    if choice["moves"] and spheres:
        spheres[-1]["center_end"] = [0.2, 0.3, -1.2]
    document = {"camera": camera, "background": SKIES[choice["sky"]], "materials": MATERIALS, "textures": TEXTURES,
                "spheres": spheres, "media": {"fog": {"absorption": 0.3, "scattering": [1, 2, 0.5], "anisotropy": 0.4},
                                              "clear": {"absorption": 0}}}
    if choice["sky"] == "backdrop":
        document["backdrop"] = {"bottom": [0.5, 0, 0], "top": [0, 0.5, 0]}
    if choice["medium"] in ("around", "both", "clear"):
        document["medium"] = "clear" if choice["medium"] == "clear" else "fog"
    for sphere in spheres:
        if choice["medium"] in ("inside", "both") and sphere["material"] in ("glass", "edge"):
            sphere["interior"] = "fog"
    if choice["catcher"]:
        document["shadow_catcher"] = True
    if choice["particles"] == "one":
        document["particles"] = [{"file": "one.xyz"}]
    return document


def is_possible(choice):
    """What is refused, with a reason, is left to other tests."""
    return not (choice.get("catcher") and "image" in choice.get("sky", ""))


def covering(strength, seed=1):
    """Choices in which any `strength` things come together in every way that they can, found by a greedy search among random ones."""
    chance = random.Random(seed)
    names = list(CHOICES)
    groups = list(itertools.combinations(names, strength))
    left = {(group, values) for group in groups for values in itertools.product(*(CHOICES[name] for name in group))
            if is_possible(dict(zip(group, values)))}

    def covered(choice):
        return {(group, tuple(choice[name] for name in group)) for group in groups} & left

    while left:
        group, values = min(left, key=repr)
        tries = [{**{name: chance.choice(CHOICES[name]) for name in names}, **dict(zip(group, values))} for _ in range(40)]
        best = max(filter(is_possible, tries), default={}, key=lambda choice: len(covered(choice)))
        if best:
            left -= covered(best)
            yield best


class SmallScenes(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("one.xyz", "1\n\nC 0.1 0 -2\n")
        texels = [value for v in range(2) for u in range(4) for value in (0.1 * u, 0.2, 0.3 + 0.05 * v)]
        texels[:3] = [9, 8, 7]
        self.write("sky.pfm", b"PF\n4 2\n-1.0\n" + struct.pack("<24f", *texels))

    def numbers(self, *options):
        self.succeed("render", "s.json", "--spp", "1", "-o", "p.pfm", "-q", *options)
        return list(read_pfm(self.read("p.pfm"))[2])

    def try_scene(self, choice):
        """All that is quick."""
        self.write("s.json", small_scene(choice))
        json.loads(self.succeed("scene", "s.json").stdout)
        plain = self.numbers()
        self.assertEqual(self.numbers("--kernel", "sample"), plain, choice)
        self.assertEqual(self.numbers("--effects", "all"), plain, choice)
        self.assertEqual(self.numbers("--effects", "all", "--kernel", "sample"), plain, choice)
        self.try_explain(plain, choice)
        result = self.run_program("check", "s.json", "--spp", "64", "-q")
        self.assertIn(result.returncode, (0, 4), f"{choice}: {result.stdout} {result.errors}")

    def try_explain(self, plain, choice):
        (found,) = json.loads(self.succeed("explain", "s.json", "--pixel", "0,0", "--json", "-").stdout)["scenes"]
        self.succeed("explain", "s.json", "--pixel", "0,0")
        self.assertEqual(found["spheres"], choice["spheres"] + (choice["particles"] == "one"))
        steps = found["path"]["steps"]
        self.assertLessEqual(len(steps), choice["depth"], choice)
        radiance = steps[-1]["radiance"] if steps else [0, 0, 0]
        width, height = choice["size"]
        top_left = plain[3 * width * (height - 1):][:3]
        for one, other in zip(radiance, top_left):
            self.assertAlmostEqual(one, other, delta=1e-6 * max(1, abs(other)), msg=choice)

    @cli.deep
    def test_pairs(self):
        """Any two things that a scene may have, in every way."""
        for choice in covering(2):
            with self.subTest(choice=choice):
                self.try_scene(choice)

    def test_each(self):
        """Everything that a scene may have, once at least."""
        for choice in covering(1):
            with self.subTest(choice=choice):
                self.try_scene(choice)

    def test_lanes_without_a_path(self):
        """One path among many lanes leaves a surface towards an image that is sampled: the other lanes have no direction."""
        none = "    path->radiance = zero3();\n    path_none_odds"
        made = "    const vreal none = sqrt(splat(-1));\n    path->direction = vec3(none, none, none);\n"
        self.environment.update(cli.broken_kernels(self, "integrator/path.cl", none, made + none))
        self.try_scene({**NOTHING, "spheres": 2, "first": "matte", "second": "edge", "sky": "image", "medium": "inside"})

    def test_arrays_without_elements(self):
        """Lanes that are lit by a disc look for a material in the slot of a sphere, of which there is none."""
        document = {"camera": {"image_width": 12, "max_depth": 10}, "media": {"m": {"scattering": 1}}, "medium": "m",
                    "background": {"discs": [{"direction": [0, 1, 0], "half_angle": 5, "radiance": [3, 3, 3]}]}}
        self.write("s.json", document)
        plain = self.numbers()
        for form in ("sample", "packet", "pool"):
            self.assertEqual(self.numbers("--effects", "all", "--kernel", form), plain, form)

    def test_other_commands(self):
        self.write("s.json", small_scene({**NOTHING, "sky": "discs", "medium": "around"}))
        self.succeed("bench", "s.json", "--time", "0.01", "--rounds", "1")
        nothing = {"camera": {"image_width": 1, "samples_per_pixel": 1}}
        self.write("s.json", nothing)
        for command in ("scene", "explain", "bench --time 0.01 --rounds 1", "check --spp 16", "render -q -o p.pfm"):
            name, *options = command.split()
            result = self.run_program(name, "s.json", *options)
            self.assertIn(result.returncode, (0, 4) if name == "check" else (0,), f"{command}: {result.errors}")

    @cli.deep
    def test_studies(self):
        """Those that compile a dozen kernels."""
        for choice in ({**NOTHING, "sky": "discs", "medium": "around"}, NOTHING, {**NOTHING, "spheres": 1, "first": "lamp"},
                       {**NOTHING, "spheres": 2, "sky": "image", "moves": True, "size": (3, 2)}):
            self.write("s.json", small_scene(choice))
            (found,) = json.loads(self.succeed("explain", "s.json", "--measure", "--json", "-").stdout)["scenes"]
            kernels = found["costs"]["kernels"]
            self.assertEqual(kernels[-1]["name"], "general")
            self.assertEqual(len(kernels), 2 + sum(not effect["simulated"] for effect in found["effects"]), choice)
            result = self.run_program("cost", "s.json", "--time", "0.1", "--json", "c.json")
            self.assertEqual(result.returncode, 0, f"{choice}: {result.errors}")


if __name__ == "__main__":
    cli.main()
