"""Millions of lamps: a scene as large as one asks for, made anew wherever it is needed.

In:    a folder, how many lamps.   Out: many-lamps.json and the points of its lamps, many-lamps.ply, the same every time.
Knows: the scene's grammar.   Does not know: who draws it.
"""
import array
import json
import math
import pathlib
import random
import sys

BLOCK = 1000  # points that are drawn at a time, then moved as a whole
COVERED = 0.12  # share of the ceiling that the lamps would cover if they all lay beside each other
SIDE, LOW, HIGH = 20.0, 3.0, 7.0  # of the slab that they float in


def points(count):
    """Uniform in the slab: from a block of random points, moved around with wrap to golden turns, since random numbers one by one
    take minutes."""
    draw = random.Random(6)
    block = [(draw.random(), draw.random(), draw.random()) for _ in range(BLOCK)]
    turns = 0.8191725133961645, 0.6710436067037893, 0.5497004779019703  # M. Roberts' sequence in three dimensions
    numbers = array.array("f")
    for first in range(0, count, BLOCK):
        shift = [first // BLOCK * turn % 1 for turn in turns]
        for x, y, z in block[:count - first]:
            numbers.extend(((x + shift[0]) % 1 * SIDE - SIDE / 2, LOW + (y + shift[1]) % 1 * (HIGH - LOW),
                            (z + shift[2]) % 1 * SIDE - SIDE / 2))
    if sys.byteorder == "big":
        numbers.byteswap()
    return numbers.tobytes()


def document(count):
    radius = math.sqrt(COVERED * SIDE * SIDE / (math.pi * count))
    return {"format": 1, "title": f"{count:,} lamps", "source": "Made for docs/LIGHTS.md: small lamps in a slab over a floor",
            "camera": {"image_width": 120, "aspect_ratio": [3, 2], "samples_per_pixel": 64, "max_depth": 20, "vfov": 22,
                       "lookfrom": [0, 2.5, 9], "lookat": [0, 0.6, 0]},
            "background": [0, 0, 0],
            "materials": {"floor": {"type": "lambertian", "albedo": [0.6, 0.58, 0.55]},
                          "clay": {"type": "lambertian", "albedo": [0.75, 0.35, 0.25]},
                          "brass": {"type": "metal", "albedo": [0.85, 0.7, 0.4], "fuzz": 0.4},
                          "lamp": {"type": "diffuse_light", "emit": [9, 8, 6]}},
            "spheres": [{"center": [0, -1000, 0], "radius": 1000, "material": "floor"},
                        {"center": [-1.1, 1, 0], "radius": 1, "material": "clay"},
                        {"center": [1.1, 1, 0], "radius": 1, "material": "brass"}],
            "clouds": [{"file": "many-lamps.ply", "radius": radius, "material": "lamp"}]}


def write(folder, count):
    """Writes both files and returns the scene's path."""
    folder = pathlib.Path(folder)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
            "end_header\n")
    with open(folder / "many-lamps.ply", "wb") as file:
        file.write(head.encode())
        file.write(points(count))
    path = folder / "many-lamps.json"
    path.write_text(json.dumps(document(count), indent=1) + "\n")
    return path
