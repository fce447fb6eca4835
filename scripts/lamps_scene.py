"""Ten thousand lamps: a scene for which chance is hopeless, made anew wherever it is needed.

In:    a folder.   Out: ten-thousand-lamps.json and the points of its lamps, ten-thousand-lamps.ply, the same every time.
Knows: the scene's grammar.   Does not know: who draws it.
"""
import json
import math
import pathlib
import random
import struct

COUNT = 10000
RADIUS = 0.0015
BRIGHTNESS = 700
COLOURS = 12
STRANDS = 5


def colour(place):
    """Radiance, from amber at the foot of the whirl over a pale rose to blue at its top."""
    stops = ((1.0, 0.42, 0.10), (1.0, 0.55, 0.42), (0.22, 0.45, 1.0))
    low, share = (0, 2 * place) if place < 0.5 else (1, 2 * place - 1)
    return [round(BRIGHTNESS * (a + share * (b - a)), 1) for a, b in zip(stops[low], stops[low + 1])]


def points():
    """(x, y, z, colour) of every lamp: strands that wind up around the axis and scatter on their way."""
    draw = random.Random(4)
    for i in range(COUNT):
        place = ((i // STRANDS) + draw.random()) / (COUNT // STRANDS)
        turn = 2 * math.pi * (i % STRANDS) / STRANDS + 5.0 * place ** 0.8
        reach = 3.3 * (1 - place) ** 0.75 + 0.9
        width = 0.05 + 0.22 * (1 - place)
        yield (reach * math.cos(turn) + draw.gauss(0, width), max(0.05, 0.25 + 3.1 * place ** 1.4 + draw.gauss(0, 0.6 * width)),
               reach * math.sin(turn) + draw.gauss(0, width), min(COLOURS - 1, int(COLOURS * place)))


def document():
    materials = {"floor": {"type": "lambertian", "albedo": [0.5, 0.48, 0.46]},
                 "pearl": {"type": "lambertian", "albedo": [0.8, 0.8, 0.78]},
                 "clay": {"type": "lambertian", "albedo": [0.75, 0.35, 0.25]},
                 "slate": {"type": "lambertian", "albedo": [0.25, 0.35, 0.5]},
                 "brass": {"type": "metal", "albedo": [0.85, 0.7, 0.4], "fuzz": 0.3},
                 "glass": {"type": "dielectric", "refraction_index": 1.5}}
    for i in range(COLOURS):
        materials[f"lamp {i}"] = {"type": "diffuse_light", "emit": colour((i + 0.5) / COLOURS)}
    spheres = [{"center": [0, -1000, 0], "radius": 1000, "material": "floor"},
               {"center": [0, 1.0, 0], "radius": 1.0, "material": "pearl"},
               {"center": [0, 2.55, 0], "radius": 0.55, "material": "brass"}]
    for i, name in enumerate(("clay", "glass", "slate", "brass", "pearl", "clay", "slate", "glass")):
        turn = 2 * math.pi * (i + 0.35) / 8
        spheres.append({"center": [round(2.1 * math.cos(turn), 3), 0.42, round(2.1 * math.sin(turn), 3)], "radius": 0.42,
                        "material": name})
    return {"format": 1, "title": "Ten thousand lamps", "source": "Made for docs/LIGHTS.md: a whirl of small lamps",
            "camera": {"image_width": 400, "aspect_ratio": [16, 9], "samples_per_pixel": 100, "max_depth": 50, "vfov": 33,
                       "lookfrom": [0.5, 2.9, 8.6], "lookat": [0, 1.25, 0]},
            "background": [0.0, 0.0, 0.0], "materials": materials, "spheres": spheres,
            "clouds": [{"file": "ten-thousand-lamps.ply", "radius": RADIUS, "materials": [f"lamp {i}" for i in range(COLOURS)]}]}


def write(folder):
    """Writes both files and returns the scene's path."""
    folder = pathlib.Path(folder)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {COUNT}\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar material\nend_header\n")
    (folder / "ten-thousand-lamps.ply").write_bytes(head.encode() + b"".join(struct.pack("<fffB", *p) for p in points()))
    path = folder / "ten-thousand-lamps.json"
    path.write_text(json.dumps(document(), indent=1) + "\n")
    return path
