#!/usr/bin/env python3
"""Writes one set of particles for several renderers: a porous crystal, half of whose sites are empty.

    particle_data.py COUNT FOLDER      writes COUNT.gsd, COUNT.dat (Tachyon) and COUNT.json (ballpark)

In:    a number of particles.
Out:   the same particles, camera and light for everyone: spheres of radius 0.5 and of four matte colours, a white sky all
       around, and nothing else. Paths of two segments are ambient occlusion: light that reaches a surface from the sky
       directly.
Knows: the formats' grammar.   Does not know: how long anyone takes.
"""
import array
import json
import math
import os
import random
import struct
import sys

WIDTH, HEIGHT = 640, 480
VFOV = 25.0  # degrees
DIRECTION = (1.0, 0.7, 0.6)  # from the centre to the camera
DISTANCE = 4.2  # of the camera from the centre, in edges of the crystal
COLORS = [(0.7, 0.7, 0.7), (0.7, 0.3, 0.2), (0.2, 0.4, 0.7), (0.6, 0.6, 0.2)]  # albedos
RADIUS = 0.5


def places(count):
    """x, y, z of all particles, one after the other, and the edge of the crystal."""
    draw = random.Random(count).random
    edge = math.ceil((2 * count) ** (1 / 3))
    while True:
        numbers, half = array.array("f"), (edge - 1) / 2
        for site in range(edge ** 3):
            if draw() < 0.5:
                i, rest = divmod(site, edge * edge)
                j, k = divmod(rest, edge)
                numbers.extend((i - half + 0.4 * draw() - 0.2, j - half + 0.4 * draw() - 0.2, k - half + 0.4 * draw() - 0.2))
        if len(numbers) >= 3 * count:
            return numbers[:3 * count], edge
        edge += 1


def camera(edge):
    """Where it is, and the unit vector in which it looks."""
    length = math.sqrt(sum(x * x for x in DIRECTION))
    return [DISTANCE * edge * x / length for x in DIRECTION], [-x / length for x in DIRECTION]


def gsd(numbers):
    """One frame, by the layout that gsd.readthedocs.io describes. Types A to D take turns."""
    count = len(numbers) // 3
    kinds = array.array("I", [number % 4 for number in range(count)])
    side = 2.0 * math.ceil(max(map(abs, numbers)) + RADIUS)
    chunks = [("configuration/box", 9, 1, 6, struct.pack("<6f", side, side, side, 0, 0, 0)),
              ("particles/N", 3, 1, 1, struct.pack("<I", count)), ("particles/types", 5, 2, 4, b"A\0B\0C\0D\0"),
              ("particles/typeid", 3, 1, count, kinds.tobytes()), ("particles/position", 9, 3, count, numbers.tobytes())]
    index, at = b"", 256
    for number, (_, kind, columns, rows, data) in enumerate(chunks):
        index += struct.pack("<QQqIHBB", 0, rows, at, columns, number, kind, 0)
        at += len(data)
    index += bytes(32)
    names = b"\0".join(name.encode() for name, *_ in chunks) + b"\0"
    names = names.ljust((len(names) // 64 + 1) * 64, b"\0")
    header = struct.pack("<QQQQQII", 0x65DF65DF65DF65DF, at, len(index) // 32, at + len(index), len(names) // 64, 0x10004,
                         2 << 16) + b"ballpark".ljust(64, b"\0") + b"hoomd".ljust(64, b"\0") + bytes(80)
    return b"".join([header, *(data for *_, data in chunks), index, names])


def tachyon(numbers, edge):
    """Its zoom is the distance of the picture's plane, over the picture's height. Its pictures are mirror images of what
    others show, so x and y change places here, which mirrors them back."""
    at, forward = camera(edge)
    at, forward = ([y, x, z] for x, y, z in (at, forward))
    lines = ["BEGIN_SCENE", f"RESOLUTION {WIDTH} {HEIGHT}", "CAMERA", "PROJECTION PERSPECTIVE",
             f"ZOOM {0.5 / math.tan(math.radians(VFOV) / 2):.6f}", "ASPECTRATIO 1", "ANTIALIASING 0", "RAYDEPTH 8",
             "CENTER {} {} {}".format(*at), "VIEWDIR {} {} {}".format(*forward), "UPDIR 0 0 1", "END_CAMERA", "BACKGROUND 1 1 1"]
    for number, color in enumerate(COLORS):
        lines.append(f"TEXDEF m{number} AMBIENT 0 DIFFUSE 1 SPECULAR 0 OPACITY 1 PHONG PLASTIC 0 PHONG_SIZE 0 "
                     "COLOR {} {} {} TEXFUNC 0".format(*color))
    for number in range(len(numbers) // 3):
        x, y, z = numbers[3 * number:3 * number + 3]
        lines.append(f"SPHERE CENTER {y:.5f} {x:.5f} {z:.5f} RAD {RADIUS} m{number % 4}")
    return "\n".join([*lines, "END_SCENE", ""])


def scene(file, edge):
    at, _ = camera(edge)
    return {"camera": {"image_width": WIDTH, "aspect_ratio": [WIDTH, HEIGHT], "vfov": VFOV, "lookfrom": at, "lookat": [0, 0, 0],
                       "vup": [0, 0, 1], "max_depth": 2},
            "background": [1, 1, 1],
            "particles": [{"file": file, "radius": RADIUS, "whole": False,
                           "color": {"types": dict(zip("ABCD", map(list, COLORS)))}}]}


def write(count, folder):
    """The paths of what it writes without their endings, unless they are there already."""
    stem = os.path.join(folder, str(count))
    if os.path.exists(stem + ".json"):
        return stem
    numbers, edge = places(count)
    with open(stem + ".gsd", "wb") as file:
        file.write(gsd(numbers))
    with open(stem + ".dat", "w") as file:
        file.write(tachyon(numbers, edge))
    with open(stem + ".json", "w") as file:
        json.dump({**scene(os.path.basename(stem) + ".gsd", edge), "title": f"{count} particles"}, file, indent=1)
    return stem


if __name__ == "__main__":
    if len(sys.argv) != 3 or not sys.argv[1].isdigit():
        sys.exit(__doc__)
    write(int(sys.argv[1]), sys.argv[2])
