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
RADIUS = 0.004
BRIGHTNESS = 1100
COLOURS = 24
STRANDS = 5


def colour(place):
    """Radiance: amber, rose and blue, once around the scene."""
    stops = ((1.0, 0.45, 0.12), (0.95, 0.30, 0.40), (0.16, 0.38, 1.0), (0.55, 0.62, 0.75))
    low, share = int(len(stops) * place), len(stops) * place % 1
    return [round(BRIGHTNESS * (a + share * (b - a)), 1) for a, b in zip(stops[low], stops[(low + 1) % len(stops)])]


def points():
    """(x, y, z, colour) of every lamp: strands that wind up around the scene and scatter on their way, above the picture's
    edge. Those in the picture would be smaller than a pixel, and their rims more noise than all that they light."""
    draw = random.Random(4)
    for i in range(COUNT):
        place = (i // STRANDS + draw.random()) / (COUNT // STRANDS)
        turn = i % STRANDS / STRANDS + 1.4 * place
        reach = 7.5 - 2.5 * place + draw.gauss(0, 0.25)
        angle = 2 * math.pi * turn + draw.gauss(0, 0.04)
        yield (reach * math.cos(angle), 4.9 + 4 * place + abs(draw.gauss(0, 0.3)), reach * math.sin(angle),
               int(COLOURS * turn) % COLOURS)


def document():
    materials = {"floor": {"type": "lambertian", "albedo": [0.6, 0.58, 0.55]},
                 "pearl": {"type": "lambertian", "albedo": [0.85, 0.85, 0.83]},
                 "clay": {"type": "lambertian", "albedo": [0.75, 0.35, 0.25]},
                 "slate": {"type": "lambertian", "albedo": [0.25, 0.35, 0.5]},
                 "moss": {"type": "lambertian", "albedo": [0.35, 0.5, 0.25]},
                 "brass": {"type": "metal", "albedo": [0.85, 0.7, 0.4], "fuzz": 0.3}}
    for i in range(COLOURS):
        materials[f"lamp {i}"] = {"type": "diffuse_light", "emit": colour((i + 0.5) / COLOURS)}
    spheres = [{"center": [0, -1000, 0], "radius": 1000, "material": "floor"},
               {"center": [0, 1.0, 0], "radius": 1.0, "material": "pearl"},
               {"center": [0, 2.5, 0], "radius": 0.5, "material": "brass"}]
    for i, name in enumerate(("clay", "pearl", "slate", "brass", "moss", "clay", "slate", "pearl", "moss")):
        turn = 2 * math.pi * (i + 0.35) / 9
        radius = (0.5, 0.36)[i % 2]
        spheres.append({"center": [round(2.0 * math.cos(turn), 3), radius, round(2.0 * math.sin(turn), 3)], "radius": radius,
                        "material": name})
    return {"format": 1, "title": "Ten thousand lamps", "source": "Made for docs/LIGHTS.md: a whirl of small lamps overhead",
            "camera": {"image_width": 400, "aspect_ratio": [16, 9], "samples_per_pixel": 100, "max_depth": 50, "vfov": 30,
                       "lookfrom": [0.5, 3.4, 8.6], "lookat": [0, 1.05, 0]},
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
