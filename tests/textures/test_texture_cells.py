#!/usr/bin/env python3
"""What a texture is at each point, pixel by pixel, and what a lamp of cells brings, against closed forms.

usage: test_texture_cells.py PROGRAM SOURCE_DIR [--deep | CASE...]

A sphere that glows is seen by parallel rays through the centres of pixels, so the point that each pixel shows, and the
cell that it lies in, follow from the definitions of scenes/README.md and host/scene/texture.h; here they are computed
with fractions, from the scene's own coordinates. Pixels whose point lies close to the edge of a checker's cell are left
out. --deep: the cases that need kernels of their own, for another form, precision or choice of effects, which are not run
without it.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
from fractions import Fraction

from pfm import read_pfm
from vectors import cross, unit

PROGRAM, ONLY = sys.argv[1], sys.argv[3:]
SIDE = 32
EVEN, ODD = [1, 2, 0.25], [0.5, 0, 4]


def scene(texture, center, radius, view, vup, span):
    """Looks along -view at the centre, from twice the radius away; `span` high."""
    lookfrom = [c + 2 * abs(radius) * d for c, d in zip(center, view)]
    return {"camera": {"image_width": SIDE, "pixel_sampling": "center", "max_depth": 1, "projection": "orthographic",
                       "view_height": span, "lookfrom": lookfrom, "lookat": center, "vup": vup},
            "background": [0, 0, 0], "textures": {"t": {"type": "checker", "colors": [EVEN, ODD], **texture}},
            "materials": {"m": {"type": "diffuse_light", "emit": {"texture": "t"}}},
            "spheres": [{"center": center, "radius": radius, "material": "m"}]}


def render(document, options):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "x.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(document, file)
        done = subprocess.run([PROGRAM, "render", path, "-o", "-", "--format", "pfm", "--quiet", *options],
                              capture_output=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(options)}: exit code {done.returncode}: {done.stderr.decode()}")
        width, height, numbers = read_pfm(done.stdout)
        pixels = [numbers[i:i + 3].tolist() for i in range(0, len(numbers), 3)]
        rows = [pixels[row * width:(row + 1) * width] for row in range(height)]
        return width, height, rows[::-1]  # the top row first


def is_chosen(name, options):
    return options != () if ONLY == ["--deep"] else name in ONLY if ONLY else options == ()


def verdict(fine):
    return "" if fine else "FAILED: "


def rotate(v, axis, angle):
    along = sum(a * b for a, b in zip(axis, v))
    across = cross(axis, v)
    return [v[i] * math.cos(angle) + across[i] * math.sin(angle) + axis[i] * along * (1 - math.cos(angle)) for i in range(3)]


def on_globe(texture, normal):
    """Longitude and latitude, from 0 to 1."""
    up = unit(texture.get("up", [0, 1, 0]))
    axis, tilt = cross([0, 1, 0], up), math.acos(max(-1, min(1, up[1])))
    axis = unit(axis) if math.hypot(*axis) > 0 else [1, 0, 0]
    n = rotate(rotate(normal, up, -math.radians(texture.get("turn", 0))), axis, -tilt)
    return (math.atan2(-n[2], n[0]) + math.pi) / (2 * math.pi), math.atan2(math.hypot(n[0], n[2]), -n[1]) / math.pi


def cell(texture, center, radius, normal):
    """The parity of the cell, and how far the nearest edge is, in cells."""
    if texture.get("mapping") == "surface":
        repeat = texture.get("repeat", [1, 1])
        places = [2 * r * x for r, x in zip(repeat, on_globe(texture, normal))]
    else:
        size = Fraction(texture.get("size", 1))
        places = [(Fraction(c) + Fraction(abs(radius)) * Fraction(n)) / size for c, n in zip(center, normal)]
    numbers = [math.floor(p) for p in places]
    edge = min(min(float(p - n), float(n + 1 - p)) for p, n in zip(places, numbers))
    return sum(numbers) % 2, edge


def pixels_of(texture, center, radius, view, vup, span, options):
    """(the normal there, what was found) of each pixel that shows the sphere."""
    center, view = list(center), unit(view)
    right, span = unit(cross(vup, view)), span or 2.2 * abs(radius)
    above = cross(view, right)
    width, height, rows = render(scene(texture, center, radius, view, list(vup), span), ["--spp", "4", *options])
    for row in range(height):
        for column in range(width):
            x = ((column + 0.5) / width - 0.5) * span / abs(radius)
            y = (0.5 - (row + 0.5) / height) * span / abs(radius)
            if x * x + y * y <= 0.98:
                z = math.sqrt(1 - x * x - y * y)
                yield [x * r + y * a + z * v for r, a, v in zip(right, above, view)], rows[row][column]


def check_cells(name, texture, center=(0, 0, 0), radius=1.0, view=(0, 0, 1), vup=(0, 1, 0), slack=1e-4, span=None,
                options=()):
    if not is_chosen(name, options):
        return None
    wrong = compared = odd_ones = 0
    for normal, found in pixels_of(texture, center, radius, view, vup, span, options):
        odd, edge = cell(texture, center, radius, normal)
        if edge < slack:
            continue
        compared += 1
        odd_ones += odd
        wrong += found != (ODD if odd else EVEN)
    fine = wrong == 0 and compared > 500 and 0.1 < odd_ones / compared < 0.9
    print(f"{name:44} {verdict(fine)}{compared} pixels, {odd_ones} odd, {wrong} wrong")
    return fine


def hash3(x, y, z):
    """pcg3d (Jarzynski and Olano 2020), its first word."""
    v, low = [x, y, z], 0xffffffff
    v = [(a * 1664525 + 1013904223) & low for a in v]
    for _ in range(2):
        v[0] = (v[0] + v[1] * v[2]) & low
        v[1] = (v[1] + v[2] * v[0]) & low
        v[2] = (v[2] + v[0] * v[1]) & low
        first = v[0]
        v = [a ^ a >> 16 for a in v]
    return first


EDGES = [(1, 1, 0), (-1, 1, 0), (1, -1, 0), (-1, -1, 0), (1, 0, 1), (-1, 0, 1), (1, 0, -1), (-1, 0, -1), (0, 1, 1), (0, -1, 1),
         (0, 1, -1), (0, -1, -1), (1, 1, 0), (0, -1, 1), (-1, 1, 0), (0, -1, -1)]


def noise(p, octave, seed):
    """`p`: fractions."""
    low = [math.floor(a) for a in p]
    t = [float(a - b) for a, b in zip(p, low)]
    s = [a ** 3 * (a * (6 * a - 15) + 10) for a in t]
    total = 0
    for i in (0, 1):
        for j in (0, 1):
            for k in (0, 1):
                x, y, z = ((a + b) % 4194304 for a, b in zip(low, (i, j, k)))
                edge = EDGES[hash3(x + (octave << 22), y, (z + seed * 0x9e3779b9) & 0xffffffff) >> 28]
                slope = edge[0] * (t[0] - i) + edge[1] * (t[1] - j) + edge[2] * (t[2] - k)
                total += slope * (s[0] if i else 1 - s[0]) * (s[1] if j else 1 - s[1]) * (s[2] if k else 1 - s[2])
    return total


def share(texture, point):
    pattern = texture.get("pattern", "perlin")
    octaves = texture.get("octaves", {"perlin": 1, "wood": 2}.get(pattern, 7))
    size = Fraction(texture.get("size", 1))
    from_origin = [a - Fraction(b) for a, b in zip(point, texture.get("origin", [0, 0, 0]))]
    s = sum(noise([a / size * 2 ** k for a in from_origin], k, texture.get("seed", 0)) / 2 ** k for k in range(octaves))
    period, axis = Fraction(texture.get("period", size)), "xyz".index(texture.get("axis", "z"))
    if pattern == "perlin":
        value = (1 + s) / 2
    elif pattern == "turbulence":
        value = abs(s)
    elif pattern == "marble":
        waves = float(from_origin[axis] / period % 1) + texture.get("distortion", 1.6) * abs(s)
        value = (1 + math.sin(2 * math.pi * waves)) / 2
    else:
        others = [float(a) for k, a in enumerate(from_origin) if k != axis]
        value = (1 + math.sin(2 * math.pi * (math.hypot(*others) / float(period) + texture.get("distortion", 0.3) * s))) / 2
    return max(0, min(1, value))


def check_noise(name, texture, center=(0, 0, 0), radius=1.0, view=(0, 0, 1), options=(), slack=1e-4):
    if not is_chosen(name, options):
        return None
    worst = compared = 0
    shares = []
    for normal, found in pixels_of({"type": "noise", **texture}, center, radius, view, (0, 1, 0), None, options):
        point = [Fraction(c) + Fraction(abs(radius)) * Fraction(n) for c, n in zip(center, normal)]
        a = share(texture, point)
        shares.append(a)
        compared += 1
        worst = max(worst, *(abs(f - (e + a * (o - e))) for f, e, o in zip(found, EVEN, ODD)))
    fine = compared > 500 and worst <= slack and max(shares) - min(shares) > 0.5
    print(f"{name:44} {verdict(fine)}{compared} pixels, off by {worst:.2g}, shares {min(shares):.3f} to {max(shares):.3f}")
    return fine


def check_lamp(options):
    """A lamp of meridians' fields, its pole towards a matte point: half of each parallel shines, so it brings half of
    what a plain lamp does, albedo (R / d)^2, wholly above the horizon."""
    if not is_chosen("lamp of fields", options):
        return None
    texture = {"mapping": "surface", "up": [0, -1, 0], "turn": 20, "repeat": [3, 1]}
    document = scene(texture, [0, 3, 0], 0.9, [0, 0, 1], [0, 1, 0], 1)
    document["textures"]["t"]["colors"] = [[8, 2, 0], [0, 4, 0]]
    document["camera"] = {"image_width": 1, "pixel_sampling": "center", "max_depth": 5, "vfov": 1, "lookfrom": [-2, 1, 0],
                          "lookat": [0, 0, 0]}
    document["materials"]["matte"] = {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}
    document["spheres"].append({"center": [0, -1, 0], "radius": 1, "material": "matte"})
    samples = 1 << 18
    _, _, rows = render(document, ["--spp", str(samples), "--sampler", "independent", *options])
    fine = True
    for channel, mean in enumerate([4, 3, 0]):
        expected = 0.5 * mean * 0.09
        # A sample is at most a few times what the lamp gives; its share of directions is 0.09.
        deviation = math.sqrt(0.25 * [64, 20, 0][channel] / 2 * 0.09 / samples)
        fine = fine and abs(rows[0][0][channel] - expected) <= 4.5 * deviation
    print(f"{'lamp of fields ' + ' '.join(options):44} {verdict(fine)}{[round(v, 5) for v in rows[0][0]]}")
    return fine


SURFACE = {"mapping": "surface"}
TILTED = {**SURFACE, "up": [2, 1, -3], "turn": 77, "repeat": [4, 5]}
results = [
    check_cells("solid", {"size": 0.3}),
    check_cells("solid, inside out", {"size": 0.3}, radius=-1.0),
    check_cells("solid, 1e6 from the origin", {"size": 0.3}, center=(1e6, -2e6, 1e6), view=(1, 2, 3)),
    check_cells("solid, 1e6 away, one path", {"size": 0.07}, center=(1e6, -2e6, 1e6), slack=1e-3,
                options=["--kernel", "sample"]),
    check_cells("solid, 1e6 away, in double", {"size": 0.003}, center=(1e6, -2e6, 1e6), slack=1e-3,
                options=["--precision", "double"]),
    check_cells("solid, a sphere of 1e6", {"size": 1e5}, radius=1e6, view=(3, 1, 2)),
    check_cells("solid, a planet's pebbles", {"size": 0.2}, center=(0, -6.4e6 + 0.05, 0), radius=6.4e6, view=(0, 1, 0),
                vup=(0, 0, -1), span=2.0, slack=0.02),
    check_cells("surface", {**SURFACE, "repeat": [5, 3]}),
    check_cells("surface, inside out", {**SURFACE, "repeat": [5, 3]}, radius=-1.0),
    check_cells("surface, from behind the seam", {**SURFACE, "repeat": [6, 4]}, view=(-1, 0, 0)),
    check_cells("surface, the north pole", {**SURFACE, "repeat": [3, 6]}, view=(0, 1, 0), vup=(0, 0, -1)),
    check_cells("surface, the south pole, in double", {**SURFACE, "repeat": [3, 6]}, view=(0, -1, 0), vup=(0, 0, 1),
                options=["--precision", "double"]),
    check_cells("surface, tilted and turned", TILTED, view=(1, 1, 0)),
    check_cells("surface, tilted, all effects, one path", TILTED, view=(-1, 0, 2),
                options=["--kernel", "sample", "--effects", "all"]),
    check_cells("surface, upside down", {**SURFACE, "up": [0, -3, 0], "turn": -30, "repeat": [4, 4]}),
    check_cells("surface, nearly upside down", {**SURFACE, "up": [1e-3, -1, 0], "turn": -30, "repeat": [4, 4]}),
    check_cells("surface, z up, 1e6 from the origin", {**SURFACE, "up": [0, 0, 1], "repeat": [8, 4]},
                center=(1e6, 1e6, 0), view=(1, 0, 1)),
    check_noise("perlin", {"size": 0.3}),
    check_noise("perlin, 1e6 from the origin", {"size": 0.3, "octaves": 5, "seed": 3}, center=(1e6, -2e6, 1e6)),
    check_noise("perlin, 12 octaves, in double", {"size": 0.5, "octaves": 12}, center=(-1e6, -2e6, 3e5), slack=1e-6,
                options=["--precision", "double"]),
    check_noise("perlin, beyond the lattice's period", {"size": 0.2}, center=(-3e6, 5, 1e6), radius=-1.0),
    check_noise("turbulence", {"pattern": "turbulence", "size": 0.4, "origin": [0.2, 0.1, 0]}, view=(1, 1, 1)),
    check_noise("marble", {"pattern": "marble", "size": 0.5, "axis": "x", "period": 0.4}),
    check_noise("marble, 1e6 away, one path", {"pattern": "marble", "size": 0.5, "axis": "y", "seed": 4294967295},
                center=(1e6, -2e6, 1e6), options=["--kernel", "sample"]),
    check_noise("wood", {"pattern": "wood", "size": 0.5, "axis": "y", "period": 0.2, "origin": [0.3, 0, -0.2]}),
    check_noise("wood, its axis 2e6 away", {"pattern": "wood", "size": 0.5, "period": 0.3, "origin": [0.33, 0.21, -0.27]},
                center=(1e6, -2e6, 1e6),
                options=["--effects", "all"]),
    check_lamp(["--light-sampling", "on"]),
    check_lamp(["--light-sampling", "off"]),
    check_lamp(["--light-sampling", "on", "--kernel", "sample", "--precision", "double"]),
]
done = [result for result in results if result is not None]
print(f"{len(done)} cases, {done.count(False)} wrong")
sys.exit(not done or False in done)
