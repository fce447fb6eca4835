#!/usr/bin/env python3
"""How much light comes by way of a ball in all, and by a reflection inside it, against the map of parallel rays.

usage: test_caustic_energy.py PROGRAM SOURCE_DIR [--deep | CASE...]

In:    small scenes.   Out: whether their light is what goes in: a ball moves light and makes none.
Knows: Snell's law, Fresnel's equations, areas of circles.   Does not know: how the program finds ways, what it chooses by.
"""
import math
import sys

from pfm import read_pfm
from program_cases import picture, run_cases

SUN, HALF = 1e6, 0.05  # radiance; degrees: so small that by chance a path finds it once in a million
ALBEDO = 0.5
INDEX = 1.5
BEAM = SUN * math.pi * math.sin(math.radians(HALF)) ** 2  # irradiance across the beam
FLOOR = {"type": "lambertian", "albedo": [ALBEDO] * 3}
GLASS = {"type": "dielectric", "refraction_index": INDEX}


def document(camera, spheres, discs, glass):
    return {"camera": {"image_width": 16, **camera}, "background": {"bottom": [0] * 3, "top": [0] * 3, "discs": discs},
            "materials": {"floor": FLOOR, "glass": {**GLASS, **glass}, "lamp": {"type": "diffuse_light", "emit": [8] * 3}}, "spheres": spheres}


def mean(scene, spp, caustics, seed=0):
    values = read_pfm(picture(scene, "--spp", str(spp), "--seed", str(seed), "--caustics", caustics))[2]
    return sum(values) / len(values)


def reflectance(cosine, ratio):
    """Unpolarised; `ratio`: the index beyond over that on the ray's side."""
    sine = math.sqrt(1 - cosine * cosine) / ratio
    beyond = math.sqrt(1 - sine * sine)
    across, along = (cosine - ratio * beyond) / (cosine + ratio * beyond), (ratio * cosine - beyond) / (ratio * cosine + beyond)
    return (across * across + along * along) / 2


def share_in_rectangle(radius, half_width, half_depth):
    """Of a circle around the middle of a rectangle."""
    outside = sum(math.acos(half / radius) for half in (half_width, half_depth) if half < radius)
    return max(0.0, 1 - 2 * outside / math.pi)


def what_goes_in():
    """A parallel camera sees a rectangle of the floor under a ball in the sun: its light is the beam's, less the ball's shadow, and what
    the ball sends there. A ray of impact parameter b is turned by 2 (asin b - asin(b / index)) and has gone through two surfaces."""
    said = []
    for height, view, fresnel in ((4.0, 3.0, "none"), (4.0, 3.0, "exact"), (6.0, 5.0, "exact")):
        wide, deep = view / 2, view / 2 * math.sqrt(2)
        camera = {"aspect_ratio": 1, "max_depth": 4, "projection": "orthographic", "view_height": view, "lookfrom": [0, 8, 8], "lookat": [0, 0, 0]}
        spheres = [{"center": [0, -4096, 0], "radius": 4096, "material": "floor"}, {"center": [0, height, 0], "radius": 1, "material": "glass"}]
        scene = document(camera, spheres, [{"direction": [0, 1, 0], "half_angle": HALF, "radiance": [SUN] * 3}], {"fresnel": fresnel})
        found = mean(scene, 1024, "on")
        area, steps, sent, reflected = 4 * wide * deep, 20000, 0.0, 0.0
        for i in range(steps):
            b = (i + 0.5) / steps
            ring, loss = 2 * math.pi * b / steps, reflectance(math.sqrt(1 - b * b), INDEX) if fresnel == "exact" else 0.0
            turn = 2 * (math.asin(b) - math.asin(b / INDEX))
            if turn < math.pi / 2:
                x = b * math.cos(turn) - (height - b * math.sin(turn)) * math.tan(turn)
                sent += ring * (1 - loss) ** 2 * share_in_rectangle(abs(x), wide, deep)
            off = math.pi - 2 * math.asin(b)  # off the outside, by this from straight on
            if off < math.pi / 2:
                x = b + (height + math.sqrt(1 - b * b)) * math.tan(off)
                reflected += ring * loss * share_in_rectangle(x, wide, deep)
        wanted = BEAM * ALBEDO / math.pi * (area - math.pi + sent + reflected) / area
        assert abs(found / wanted - 1) < 0.002, f"{fresnel}, height {height}: {found} instead of {wanted}, {found / wanted - 1:+.3%}"
        without = BEAM * ALBEDO / math.pi * (area - math.pi) / area
        said.append(f"{fresnel}: {found / wanted - 1:+.3%}, where the ball brings {wanted / without - 1:+.1%}")
    return "; ".join(said)


def reflected_inside():
    """The underside of a matte ball, beside the beam and far above the glass, gets the sun by a reflection inside the glass and by one off it."""
    said = []
    for fresnel, x, height in (("exact", 1.6, 9.0), ("schlick", 2.2, 9.0), ("exact", 2.8, 9.0)):
        radius = 0.5
        point = (x, height)
        camera = {"aspect_ratio": 1, "max_depth": 5, "vfov": 0.0005, "lookfrom": [x, height - 2, 6], "lookat": [x, height, 0]}
        spheres = [{"center": [x, height + radius, 0], "radius": radius, "material": "floor"}, {"center": [0, 0, 0], "radius": 1, "material": "glass"}]
        scene = document({**camera, "image_width": 4}, spheres, [{"direction": [0, 1, 0], "half_angle": HALF, "radiance": [SUN] * 3}],
                         {"fresnel": fresnel})
        found = mean(scene, 8192, "on")

        def leaves(b, chords):
            """A ray that comes down at b: where it leaves, in which direction, and its share."""
            i, r = math.asin(b), math.asin(b / INDEX)
            if fresnel == "exact":
                outer, inner = reflectance(math.cos(i), INDEX), reflectance(math.cos(r), 1 / INDEX)
            else:
                least = ((INDEX - 1) / (INDEX + 1)) ** 2
                outer, inner = (least + (1 - least) * (1 - math.cos(a)) ** 5 for a in (i, r))
            # Angles from the zenith: the surface turns by half a turn less 2 r with each chord.
            at = i + chords * (math.pi - 2 * r)
            along = 2 * i if chords == 0 else at + i
            return math.sin(at), math.cos(at), along, outer if chords == 0 else (1 - outer) * inner * (1 - inner)

        def landing(b, chords):
            out, up, along, _ = leaves(b, chords)
            return out + (height - up) * math.tan(along)

        wanted = 0.0
        for chords in (0, 2):
            for side in (1, -1):
                steps, last = 20000, None
                for k in range(1, steps):
                    b = k / steps
                    rises = math.cos(leaves(b, chords)[2]) > 0
                    off = landing(b, chords) - side * x
                    if rises and last is not None and off * last < 0 and abs(off) < 1 and abs(last) < 1:
                        low, high = (k - 1) / steps, b
                        for _ in range(60):
                            middle = (low + high) / 2
                            low, high = (middle, high) if (landing(middle, chords) - side * x) * last > 0 else (low, middle)
                        slope = (landing(high + 1e-6, chords) - landing(low - 1e-6, chords)) / (high - low + 2e-6)
                        wanted += leaves(low, chords)[3] * low / abs(slope * x)
                    last = off if rises else None
        wanted *= BEAM * ALBEDO / math.pi
        assert wanted > 0 and abs(found / wanted - 1) < 0.004, f"{fresnel}, {point}: {found} instead of {wanted}, {found / wanted - 1:+.3%}"
        said.append(f"{found / wanted - 1:+.2%}")
    return ", ".join(said)


def as_much_as_by_chance():
    """All light on a large floor under a ball and a lamp, in samples enough to know it to a thousandth."""
    camera = {"aspect_ratio": 1, "max_depth": 12, "projection": "orthographic", "view_height": 3, "lookfrom": [0, 5, 7], "lookat": [0, 0, 0], "image_width": 64}
    spheres = [{"center": [0, -4096, 0], "radius": 4096, "material": "floor"}, {"center": [0, 2.2, -1], "radius": 0.5, "material": "glass"},
               {"center": [0.3, 4.4, -1.2], "radius": 0.5, "material": "lamp"}]
    scene = document(camera, spheres, [], {"fresnel": "exact"})
    found = {}
    for word in ("off", "on"):
        means = [mean(scene, 2048, word, seed + 100 * (word == "on")) for seed in range(8)]
        middle = sum(means) / 8
        found[word] = middle, math.sqrt(sum((m - middle) ** 2 for m in means) / 56)
    (a, da), (b, db) = found["off"], found["on"]
    error = math.hypot(da, db) / a
    assert error < 0.0005, f"only known to {error:.3%}"
    assert abs(b / a - 1) < 0.002 and abs(b / a - 1) < 4 * error, f"{b} instead of {a}, {b / a - 1:+.3%}"
    return f"{b / a - 1:+.3%}, known to {error:.3%}"


CASES = []
DEEP_CASES = [what_goes_in, reflected_inside, as_much_as_by_chance]

sys.exit(run_cases(CASES, DEEP_CASES))
