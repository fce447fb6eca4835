"""Ten thousand lamps: a scene for which chance is hopeless, made anew wherever it is needed.

In:    a folder.   Out: ten-thousand-lamps.json and the points of its lamps, ten-thousand-lamps.ply, the same every time; or
       for other renderers large-lamps.json and large-lamps.ply.
Knows: the scene's grammar.   Does not know: who draws it.
"""
import itertools
import json
import math
import pathlib
import random
import struct

COUNT = 10000
RADIUS = 0.004
BRIGHTNESS = 1100
COLOURS = 24
GROWTH = 15  # of the lamps that other renderers get
GAP = 0.02  # at least, between those
STRANDS = 5


def colour(place):
    """Radiance: amber, rose and blue, once around the scene."""
    stops = ((1.0, 0.45, 0.12), (0.95, 0.30, 0.40), (0.16, 0.38, 1.0), (0.55, 0.62, 0.75))
    low, share = int(len(stops) * place), len(stops) * place % 1
    return [round(BRIGHTNESS * (a + share * (b - a)), 1) for a, b in zip(stops[low], stops[(low + 1) % len(stops)])]


def anywhere():
    """(x, y, z, colour) of a lamp after the other: strands that wind up around the scene and scatter on their way, above the
    picture's edge. Those in the picture would be smaller than a pixel, and their rims more noise than all that they light."""
    draw = random.Random(4)
    i = 0
    while True:
        place = (i // STRANDS % (COUNT // STRANDS) + draw.random()) / (COUNT // STRANDS)
        turn = i % STRANDS / STRANDS + 1.4 * place
        reach = 7.5 - 2.5 * place + draw.gauss(0, 0.25)
        angle = 2 * math.pi * turn + draw.gauss(0, 0.04)
        yield (reach * math.cos(angle), 4.9 + 4 * place + abs(draw.gauss(0, 0.3)), reach * math.sin(angle),
               int(COLOURS * turn) % COLOURS)
        i += 1


def apart(points, distance):
    """Those points that come no nearer than that to an earlier one."""
    taken = {}
    for point in points:
        cell = [math.floor(x / distance) for x in point[:3]]
        around = itertools.product(*((c - 1, c, c + 1) for c in cell))
        if all(math.dist(point[:3], other) >= distance for key in around for other in taken.get(key, ())):
            taken.setdefault(tuple(cell), []).append(point[:3])
            yield point


def points(growth):
    return itertools.islice(anywhere() if growth == 1 else apart(anywhere(), 2 * RADIUS * growth + GAP), COUNT)


def stem(growth):
    return "ten-thousand-lamps" if growth == 1 else "large-lamps"


def document(growth):
    """Of lamps `growth` times as large, and as bright in all. Those that have grown are for renderers that take the solid angle
    of a small lamp from 1 - cos in single precision, and see through what is close in front of a lamp: hence the
    gaps. Brass is matte there, since as a mirror it would be most of the noise: nothing but chance finds a small lamp in it."""
    materials = {"floor": {"type": "lambertian", "albedo": [0.6, 0.58, 0.55]},
                 "pearl": {"type": "lambertian", "albedo": [0.85, 0.85, 0.83]},
                 "clay": {"type": "lambertian", "albedo": [0.75, 0.35, 0.25]},
                 "slate": {"type": "lambertian", "albedo": [0.25, 0.35, 0.5]},
                 "moss": {"type": "lambertian", "albedo": [0.35, 0.5, 0.25]},
                 "brass": {"type": "metal", "albedo": [0.85, 0.7, 0.4], "fuzz": 0.3}}
    if growth != 1:
        materials["brass"] = {"type": "lambertian", "albedo": materials["brass"]["albedo"]}
    for i in range(COLOURS):
        materials[f"lamp {i}"] = {"type": "diffuse_light",
                                  "emit": [round(x / growth ** 2, 4) for x in colour((i + 0.5) / COLOURS)]}
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
            "clouds": [{"file": f"{stem(growth)}.ply", "radius": RADIUS * growth, "materials": [f"lamp {i}" for i in range(COLOURS)]}]}


def write(folder, growth=1):
    """Writes both files and returns the scene's path."""
    folder = pathlib.Path(folder)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {COUNT}\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar material\nend_header\n")
    points_of_lamps = b"".join(struct.pack("<fffB", *p) for p in points(growth))
    (folder / f"{stem(growth)}.ply").write_bytes(head.encode() + points_of_lamps)
    path = folder / f"{stem(growth)}.json"
    path.write_text(json.dumps(document(growth), indent=1) + "\n")
    return path
