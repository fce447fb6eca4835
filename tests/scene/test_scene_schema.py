#!/usr/bin/env python3
"""Every scene of scenes/ validates against scene.schema.json, and the schema refuses what the reader refuses.

Usage: test_scene_schema.py FOLDER_OF_SCENES. Exit code 77 where the module jsonschema is missing.
"""
import copy
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)

GOOD = {
    "format": 1, "title": "t", "source": "s",
    "camera": {"image_width": 400, "aspect_ratio": [16, 9], "vfov": 20, "lookfrom": [13, 2, 3], "aperture": 0.1},
    "background": {"bottom": [0, 0, 0], "up": [0, 0, 1], "discs": [{"direction": [1, 2, 0], "half_angle": 0.25, "radiance": [9, 9, 8]},
                                                  {"direction": [0, 1, 0], "half_angle": 90, "radiance": [1, 1, 1], "visible_to_camera": False}]},
    "lighting": "sky",
    "backdrop": {"bottom": [0, 0, 0], "top": [1, 1, 1]},
    "shadow_catcher": {"height": -1.5, "up": [0, 0, 2]},
    "figure": {"font": "Arial Bold", "size": 7.5, "text": "white"},
    "triangles": [{"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "normals": [[0, 0, 2], [-1, 0, 1], [0, 1e-3, 0]], "uvs": [[0, 0], [-1e6, 0.5], [1, 1]], "material": "m", "interior": "m"}],
    "quads": [{"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1e9, 0], "material": "m", "interior": "m"}],
    "boxes": [{"corners": [[0, 0, 0], [1, 1, 1]], "rotate": [0, 15, 0], "translate": [1, 2, 3], "material": "m", "interior": "m"}, {"corners": [[0, 0, 0], [1, 1, 1]], "material": "m"}],
    "capsules": [{"ends": [[0, 0, 0], [0, 0, 0]], "radius": 1e-12, "material": "m", "colors": [[0, 0.5, 1], [1, 1, 1]], "interior": "m"},
                 {"ends": [[0, 0, 0], [0, 1e9, 0]], "radius": 1e9, "material": "m"}],
    "meshes": [{"file": "a.ply", "material": "m", "scale": 2, "rotate": [0, 15, 0], "translate": [1, 2, 3], "interior": "m"},
               {"file": "a.obj", "materials": {"bark": "m"}, "scale": [1, -2, 1], "smooth": True}],
    "transfer": "srgb",
    "textures": {
        "embedded": {"type": "image", "file": "a.glb", "image": 2, "wrap": "clamp"},
        "s": {"type": "checker", "colors": [[0, 0.5, 1], 3], "size": 0.1},
        "n": {"type": "noise", "pattern": "wood", "colors": [0, 1], "size": 2, "origin": [1, 2, 3], "octaves": 12, "seed": 4294967295, "axis": "y",
              "period": 0.1, "distortion": 0},
        "p": {"type": "noise", "colors": [0, 1], "octaves": 1},
        "i": {"type": "image", "file": "a.png", "encoding": "linear", "scale": 2, "wrap": "clamp", "up": [1, 0, 0], "turn": 5, "repeat": [2, 1]},
        "j": {"type": "image", "file": "a.exr"},
        "g": {"type": "checker", "mapping": "surface", "colors": [0, 1e12], "up": [0, 0, 1], "turn": -1e6, "repeat": [1, 65536]},
    },
    "media": {"m": {"absorption": 1, "scattering": [0, 1e-12, 1e12], "anisotropy": -0.5}, "c": {}},
    "medium": "m",
    "materials": {
        "i": {"type": "interface", "emit": [1, 1, 1]},
        "t": {"type": "metal", "albedo": {"texture": "s"}, "fuzz": {"texture": "g"}, "emit": {"texture": "g"}},
        "u": {"type": "lambertian", "albedo": {"texture": "s"}},
        "a": {"type": "lambertian", "albedo": [0, 0.5, 1], "scatter": "hemisphere", "emit": [1, 1, 1]},
        "b": {"type": "metal", "albedo": [1, 1, 1], "fuzz": 3, "fuzz_shape": "ball"},
        "c": {"type": "dielectric", "refraction_index": 1.5, "fresnel": "exact", "total_reflection": "absorb"},
        "d": {"type": "diffuse_light", "emit": [4, 4, 4]},
        "e": {"type": "normals"},
    },
    "spheres": [{"center": [0, 0, -1], "radius": -0.5, "material": "a"}],
    "clouds": [{"file": "a.ply", "radius": 1, "material": "a", "materials": ["a", "b"]}],
    "particles": [{"file": "a.gsd", "frame": -1, "style": "ball-and-stick", "radius": {"by": "vdw", "scale": 0.5},
                   "color": {"column": "mass", "map": "cividis", "range": [0, 1]}, "bonds": {"radius": 0.1},
                   "box": True, "solvent": True, "whole": False, "shapes": False, "material": "a"},
                  {"file": "b.pdb", "radius": "covalent", "color": "chain"},
                  {"file": "b.pdb", "radius": {"types": {"A": 1}}, "color": {"types": {"A": [1, 0, 0]}}},
                  {"file": "b.pdb", "select": "chain == A", "radius": {"value": "2 * radius"},
                   "color": {"value": "norm(x, y)", "map": "plasma", "range": [0, 1], "bar": True, "label": "r", "unit": "Å"}}],
}

# Where, and what is put there. None: the member is removed.
BAD = [
    (["camera"], None), (["camera"], []), (["sphere"], []), (["format"], 2), (["title"], 1),
    (["transfer"], "gamma"), (["background"], [0, 0]), (["background"], {"bottom": [0, 0, -1]}),
    (["background"], {"botom": [0, 0, 1]}), (["background", "up"], [0, 1]), (["background", "up"], "z"),
    (["background", "discs"], {}), (["background", "discs", 0, "direction"], [0, 0, 0]), (["background", "discs", 0, "direction"], None),
    (["background", "discs", 0, "half_angle"], 0), (["background", "discs", 0, "half_angle"], 90.5),
    (["background", "discs", 0, "half_angle"], None), (["background", "discs", 0, "radiance"], [1, -1, 1]),
    (["background", "discs", 0, "radiance"], None), (["background", "discs", 0, "visible_to_camera"], 1),
    (["background", "discs", 0, "angle"], 1), (["background", "discs"], [{"direction": [0, 1, 0], "half_angle": 1, "radiance": [1, 1, 1]}] * 33),
    (["figure"], 7), (["figure", "font"], 1), (["figure", "size"], 0.9), (["figure", "size"], 145), (["figure", "text"], "red"), (["figure", "colour"], 1),
    (["particles", 3, "color", "label"], ""), (["particles", 3, "color", "unit"], 1), (["particles", 3, "color", "bar"], False),
    (["particles", 3, "color", "bar"], None),
    (["shadow_catcher"], "yes"), (["shadow_catcher", "height"], 2e12), (["shadow_catcher", "up"], [0, 0, 0]), (["shadow_catcher", "down"], 1),
    (["lighting"], "sun"), (["backdrop"], "nothing"), (["backdrop"], {"bottom": [0, 0, 0]}), (["backdrop", "top"], [0, 0, -1]), (["backdrop", "up"], [0, 1, 0]),
    (["camera", "image_width"], 0), (["camera", "image_width"], 1e9), (["camera", "image_width"], 1.5),
    (["camera", "image_width"], "400"), (["camera", "image_height"], 100), (["camera", "aspect_ratio"], 0),
    (["camera", "aspect_ratio"], [16, 9, 1]), (["camera", "vfov"], 0), (["camera", "vfov"], 180),
    (["camera", "defocus_angle"], 1), (["camera", "focus_dist"], 0), (["camera", "samples_per_pixel"], 0),
    (["camera", "max_depth"], -1), (["camera", "lookfrom"], [0, 0, 2e12]), (["camera", "pixel_sampling"], "centre"),
    (["materials", "a", "albedo"], [0, 0, 1.1]), (["materials", "a", "albedo"], None), (["materials", "a", "fuzz"], 0),
    (["materials", "a", "type"], "lambertain"), (["materials", "a", "type"], None),
    (["materials", "a", "emit"], [-1, 0, 0]), (["materials", "b", "fuzz"], -1), (["materials", "b", "fresnel"], "none"),
    (["materials", "c", "refraction_index"], -1.5), (["materials", "c", "refraction_index"], None),
    (["materials", "c", "albedo"], [1, 1, 1]), (["materials", "d", "emit"], None),
    (["textures", "i", "file"], None), (["textures", "i", "file"], 1), (["textures", "i", "encoding"], "gamma"), (["textures", "i", "scale"], -1),
    (["textures", "i", "wrap"], "mirror"), (["textures", "i", "colors"], [0, 1]), (["textures", "j", "size"], 1), (["textures", "j", "mapping"], "surface"),
    (["textures", "g", "file"], "a.png"), (["background", "image"], "a.exr"), (["background"], {"image": 1}), (["background"], {"turn": 1}),
    (["background"], {"image": "a.exr", "scale": -1}), (["background"], {"image": "a.exr", "top": [1, 1, 1]}), (["background"], {"image": "a.exr", "encoding": "rgb"}),
    (["textures"], []), (["textures", "s", "type"], None), (["textures", "s", "type"], "chequer"), (["textures", "s", "colors"], None),
    (["textures", "s", "colors"], [1]), (["textures", "s", "colors", 0], [1, 1]), (["textures", "s", "colors", 1], -1),
    (["textures", "s", "size"], 0), (["textures", "s", "up"], [0, 1, 0]), (["textures", "s", "turn"], 0), (["textures", "s", "repeat"], [1, 1]),
    (["textures", "n", "pattern"], "marbles"), (["textures", "n", "octaves"], 13), (["textures", "n", "octaves"], 0), (["textures", "n", "seed"], -1),
    (["textures", "n", "axis"], "w"), (["textures", "n", "period"], 0), (["textures", "n", "distortion"], -1), (["textures", "n", "mapping"], "solid"),
    (["textures", "p", "axis"], "x"), (["textures", "p", "period"], 1), (["textures", "p", "distortion"], 1), (["textures", "p", "turn"], 1),
    (["textures", "s", "octaves"], 1), (["textures", "s", "pattern"], "wood"), (["textures", "s", "seed"], 1), (["textures", "g", "origin"], [0, 0, 0]),
    (["textures", "s", "mapping"], "uv"), (["textures", "s", "colour"], 1), (["textures", "g", "size"], 1), (["textures", "g", "up"], [0, 0, 0]),
    (["textures", "g", "turn"], 1e7), (["textures", "g", "repeat"], [0, 1]), (["textures", "g", "repeat"], [1, 1.5]), (["textures", "g", "repeat"], 1),
    (["materials", "t", "albedo"], {}), (["materials", "t", "albedo"], {"texture": 1}), (["materials", "t", "fuzz"], {"textur": "g"}),
    (["materials", "c", "refraction_index"], {"texture": "g"}), (["background"], {"texture": "g"}),
    (["spheres", 0, "interior"], 1), (["boxes", 0, "interior"], 1), (["quads", 0, "interior"], ["m"]), (["triangles", 0, "interior"], 1),
    (["capsules", 0, "interior"], 1), (["meshes", 0, "interior"], 1), (["medium"], 1), (["media"], []), (["media", "m", "absorption"], -1), (["media", "m", "absorption"], 1e-13),
    (["media", "m", "scattering"], [1, 2]), (["media", "m", "anisotropy"], 1), (["media", "m", "density"], 1), (["materials", "i", "albedo"], [1, 1, 1]),
    (["spheres", 0, "center_end"], [0, 0]), (["spheres", 0, "center_end"], [0, 0, 2e12]),
    (["spheres", 0, "radius"], 0), (["spheres", 0, "radius"], None), (["spheres", 0, "center"], [0, 0]),
    (["spheres", 0, "material"], 1), (["spheres", 0, "centre"], [0, 0, 0]), (["spheres"], {}),
    (["camera", "projection"], "parallel"), (["camera", "view_height"], 1), (["camera", "fit"], "scene"), (["camera", "view"], "front"), (["camera", "margin"], 0.1),
    (["particles", 3, "select"], ""), (["particles", 3, "select"], 3), (["particles", 3, "select"], "x" * 4097),
    (["particles", 3, "solvent"], True), (["particles", 3, "color", "column"], "x"), (["particles", 3, "color", "by"], "type"),
    (["particles", 3, "color", "value"], None), (["particles", 3, "radius", "column"], "x"), (["particles", 3, "radius", "by"], "vdw"),
    (["particles", 0, "file"], None), (["particles", 0, "frame"], 0.5), (["particles", 0, "style"], "sticks"),
    (["particles", 0, "radius"], 0), (["particles", 0, "radius"], "big"), (["particles", 0, "radius", "column"], "mass"),
    (["particles", 0, "radius", "scale"], -1), (["particles", 0, "color"], [1, 1, 2]), (["particles", 0, "color"], "elements"),
    (["particles", 0, "color", "map"], "jet"), (["particles", 0, "color", "column"], None),
    (["particles", 0, "color", "range"], [1]), (["particles", 0, "bonds"], 1), (["particles", 0, "bonds", "radius"], 0),
    (["particles", 0, "box"], "yes"), (["particles", 0, "colour"], "element"), (["particles"], {}),
    (["meshes", 0, "file"], None), (["meshes", 0, "material"], None), (["meshes", 0, "scale"], 0), (["meshes", 1, "scale"], [1, 2]),
    (["meshes", 1, "scale"], [1, 0, 1]), (["meshes", 1, "materials"], ["m"]), (["meshes", 1, "materials", "bark"], 1), (["meshes", 0, "smooth"], 1), (["triangles", 0, "normals"], [[0, 0, 1]]), (["triangles", 0, "normals"], [[0, 0, 1], [0, 0, 1], [0, 1]]), (["triangles", 0, "normals", 1], [0, 0, 0]), (["triangles", 0, "uvs"], [[0, 0], [1, 0]]), (["triangles", 0, "uvs", 1], [0, 0, 0]), (["triangles", 0, "uvs", 2, 0], 2e6),
    (["capsules"], {}), (["capsules", 0, "ends"], [[0, 0, 0]]), (["capsules", 0, "ends"], None), (["capsules", 0, "ends", 1], [0, 2e9, 0]),
    (["capsules", 0, "radius"], 0), (["capsules", 1, "radius"], 2e9), (["capsules", 1, "radius"], None), (["capsules", 0, "material"], None),
    (["capsules", 0, "color"], [1, 1, 1]), (["capsules", 0, "colors"], [[1, 1, 1]]), (["capsules", 0, "colors", 1], [1, 1]),
    (["capsules", 0, "colors", 1], 1), (["capsules", 0, "colors", 0, 2], 1.5), (["capsules", 0, "colors", 0, 2], -0.5),
    (["meshes", 0, "rotate"], 90), (["meshes"], {}),
    (["clouds", 0, "file"], None), (["clouds", 0, "radius"], 0), (["clouds", 0, "materials"], []),
]


def changed(place, value):
    scene = copy.deepcopy(GOOD)
    target = scene
    for step in place[:-1]:
        target = target[step]
    if value is None:
        del target[place[-1]]
    else:
        target[place[-1]] = value
    return scene


def main():
    folder = pathlib.Path(sys.argv[1])
    schema = json.loads((folder / "scene.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    failures = []
    scenes = sorted(p for p in folder.glob("*.json") if p.name != "scene.schema.json")
    for path in scenes:
        for error in validator.iter_errors(json.loads(path.read_text())):
            failures.append(f"{path.name}: {error.json_path}: {error.message}")
    if len(scenes) < 69:
        failures.append(f"found {len(scenes)} scenes, expected 69 or more")
    failures += [f"a good scene: {error.json_path}: {error.message}" for error in validator.iter_errors(GOOD)]
    for place, value in BAD:
        if validator.is_valid(changed(place, value)):
            failures.append(f"accepted: {place} = {value!r}")
    print("\n".join(failures) if failures else f"{len(scenes)} scenes valid, {len(BAD)} bad ones refused")
    return 1 if failures else 0


sys.exit(main())
