#!/usr/bin/env python3
"""The ways of light that `explain --pixel` names, against rays in all directions.

usage: test_explained_ways.py PROGRAM SOURCE_DIR [CASE...]

In:    scenes, and what the program says of one of their pixels.
Out:   whether all light that comes to the point by way of a sphere is named, and brings as much as it says.
Knows: balls, mirrors, Snell's law, Fresnel's equations, the book's approximation of them.   Does not know: how the program finds ways.

From the point a ray goes to each cell of the cone that a sphere fills, is traced through it or off it by the laws of optics, and ends in
the lamp or not. Cells at the rim of the lamp's image are divided. Nothing is solved for, and nothing is known of planes.
"""
import json
import math
import sys

from program_cases import run, run_cases, with_file

FINE = 6  # how often a cell at a rim is divided in four


def add(a, b, s=1.0):
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def distance_to(origin, direction, sphere, leaving):
    """Along a ray of length 1, or None; `leaving`: it begins on this sphere."""
    to = add(sphere["center"], origin, -1)
    along = dot(to, direction)
    if leaving:
        return 2 * along if along > 0 else None
    off = add(to, direction, -along)
    room = sphere["radius"] ** 2 - dot(off, off)
    if room <= 0:
        return None
    near, far = along - math.sqrt(room), along + math.sqrt(room)
    return near if near > 0 else far if far > 0 else None


def first_hit(scene, origin, direction, leaves):
    found = (math.inf, None)
    for number, sphere in enumerate(scene["spheres"]):
        t = distance_to(origin, direction, sphere, number == leaves)
        if t is not None and t < found[0]:
            found = (t, number)
    return found


def reflectance(glass, cosine, ratio):
    """`ratio`: the index on the ray's side over that beyond."""
    kind = glass.get("fresnel", "schlick")
    if kind == "none":
        return 0.0
    if kind == "schlick":
        least = ((1 - ratio) / (1 + ratio)) ** 2
        return least + (1 - least) * (1 - cosine) ** 5
    beyond = math.sqrt(max(0, 1 - ratio * ratio * (1 - cosine * cosine)))
    across, along = (ratio * cosine - beyond) / (ratio * cosine + beyond), (cosine - ratio * beyond) / (cosine + ratio * beyond)
    return (across * across + along * along) / 2


def lobe(material, cosine):
    if cosine <= 0:
        return 0.0
    kind = material.get("scatter", "lambertian")
    return {"lambertian": cosine / math.pi, "cosine_cubed": 2 * cosine ** 3 / math.pi, "hemisphere": 0.5 / math.pi}[kind]


class Place:
    """A matte point, and what a chain from there brings."""

    def __init__(self, scene, step):
        self.scene, self.floor = scene, step["sphere"]
        sphere = scene["spheres"][self.floor]
        self.normal = unit(add(step["point"], sphere["center"], -1))
        self.point = add(sphere["center"], self.normal, sphere["radius"])
        self.material = scene["materials"][sphere["material"]]

    def chain(self, direction, ball, chords):
        """What becomes of a ray: (share that is left of each colour, where it leaves, its direction, what stops it)."""
        scene, sphere = self.scene, self.scene["spheres"][ball]
        material = scene["materials"][sphere["material"]]
        mirror = material["type"] == "metal"
        index = 0 if mirror else material["refraction_index"] if sphere["radius"] > 0 else 1 / material["refraction_index"]
        left, origin, leaves, stopped = [1.0] * 3, self.point, self.floor, None
        for meeting in range(chords + 1):
            t, number = first_hit(scene, origin, direction, leaves)
            if number != ball:
                stopped = stopped if stopped is not None else number
                t = distance_to(origin, direction, sphere, leaves == ball)
                if t is None:
                    return None
            origin = add(origin, direction, t)
            normal = unit(add(origin, sphere["center"], -1))
            if dot(normal, direction) > 0:
                normal = tuple(-x for x in normal)
            cosine = -dot(normal, direction)
            if mirror:
                left = material["albedo"]
                share = 1.0
            else:
                ratio = 1 / index if meeting == 0 else index
                share = reflectance(material, cosine, ratio)
            if not mirror and chords > 0 and meeting in (0, chords):
                beyond = math.sqrt(max(0, 1 - ratio * ratio * (1 - cosine * cosine)))
                direction = unit(add(tuple(ratio * x for x in direction), normal, ratio * cosine - beyond))
                share = 1 - share
            else:
                direction = add(direction, normal, 2 * cosine)
            left = [x * share for x in left]
            leaves = ball
        return left, origin, direction, stopped

    def brings(self, direction, ball, chords, light):
        """(colours, whether it would meet the light but for what stands in the way, what does)."""
        passed = self.chain(direction, ball, chords)
        if passed is None:
            return [0.0] * 3, False, None
        left, origin, onward, stopped = passed
        t, number = first_hit(self.scene, origin, onward, ball)
        if "half_angle" in light:
            meets = math.acos(max(-1, min(1, dot(unit(light["direction"]), onward)))) <= math.radians(light["half_angle"])
            stopped = stopped if stopped is not None else number
            radiance = light["radiance"]
        else:
            meets = distance_to(origin, onward, light, False) is not None
            if self.scene["spheres"][number if number is not None else 0] is not light and stopped is None:
                stopped = number
            radiance = self.scene["materials"][light["material"]]["emit"]
        density = lobe(self.material, dot(direction, self.normal))
        shines = meets and stopped is None
        return [density * a * b if shines else 0.0 for a, b in zip(left, radiance)], meets and density > 0, stopped

    def integral(self, ball, chords, light):
        """Over all directions to the ball."""
        sphere = self.scene["spheres"][ball]
        to = add(sphere["center"], self.point, -1)
        distance, axis = math.sqrt(dot(to, to)), unit(to)
        s = unit(cross(axis, (1, 0, 0) if abs(axis[0]) < 0.5 else (0, 1, 0)))
        t = cross(axis, s)
        known = {}

        def cosine_of(u):  # the sine of the angle of incidence grows with sin u
            return math.sqrt(1 - (abs(sphere["radius"]) / distance * math.sin(u)) ** 2)

        def value(u, v):
            if (u, v) not in known:
                c = cosine_of(u)
                sine = math.sqrt(max(0, 1 - c * c))
                direction = add(tuple(c * x for x in axis), add(tuple(math.cos(v) * x for x in s), t, math.sin(v)), sine)
                known[u, v] = self.brings(direction, ball, chords, light)[0]
            return known[u, v]

        def cell(u0, u1, v0, v1, level):
            corners = [value(u, v) for u in (u0, u1) for v in (v0, v1)]
            lit = [c[0] > 0 for c in corners]
            if level > 0 and (level == FINE or any(lit) != all(lit) or (any(lit) and level > FINE - 2)):
                u, v = (u0 + u1) / 2, (v0 + v1) / 2
                parts = [cell(*part, level - 1) for part in ((u0, u, v0, v), (u, u1, v0, v), (u0, u, v, v1), (u, u1, v, v1))]
                return [sum(part[c] for part in parts) for c in range(3)]
            measure = (cosine_of(u0) - cosine_of(u1)) * (v1 - v0)
            return [measure * sum(corner[c] for corner in corners) / 4 for c in range(3)]

        total, rings, turns = [0.0] * 3, 36, 48
        for i in range(rings):
            for j in range(turns):
                part = cell(math.pi / 2 * i / rings, math.pi / 2 * (i + 1) / rings, 2 * math.pi * j / turns, 2 * math.pi * (j + 1) / turns, FINE)
                total = [a + b for a, b in zip(total, part)]
        return total


def explained(scene, *options):
    def ask(path):
        return json.loads(run("explain", path, "--pixel", "0,0", "--json", "-", *options).stdout)["scenes"][0]["path"]
    return with_file(scene, ask)


def printed(scene, *options):
    return with_file(scene, lambda path: run("explain", path, "--pixel", "0,0", *options).stdout.decode())


GLASS = {"type": "dielectric", "refraction_index": 1.5}


def looking_at(x, z, spheres, discs=(), depth=20, scatter="lambertian", glass=None, **materials):
    """One pixel of a floor; sphere 1 is the ball, of radius 0.5, two lengths above its lower side."""
    return {"camera": {"image_width": 1, "aspect_ratio": 1, "max_depth": depth, "vfov": 0.01, "lookfrom": [x, 0.5, 6], "lookat": [x, 0, z]},
            "background": {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": list(discs)},
            "materials": {"floor": {"type": "lambertian", "albedo": [0.6, 0.5, 0.4], "scatter": scatter}, "glass": glass or GLASS,
                          "mirror": {"type": "metal", "albedo": [0.9, 0.6, 0.3]}, "lamp": {"type": "diffuse_light", "emit": [8, 6, 4]},
                          "clay": {"type": "lambertian", "albedo": [0.5] * 3}, **materials},
            "spheres": [{"center": [0, -64, 0], "radius": 64, "material": "floor"}, *spheres]}


def ball(material="glass", radius=0.5, height=0.7):
    return {"center": [0, height, 0], "radius": radius, "material": material}


def lamp(x, y, z, radius):
    return {"center": [x, y, z], "radius": radius, "material": "lamp"}


SUN = {"direction": [1, 2, 0.5], "half_angle": 3, "radiance": [90, 80, 70]}


def judge(scene, wanted, allowed=0.02, **options):
    """`wanted`: how many ways each chain (sphere, lamp or disc, chords) has at least. All that are named are traced, and each chain's sum compared."""
    path = explained(scene)
    chains, step = path["chains"], path["steps"][path["chains"]["step"] - 1]
    place = Place(scene, step)
    found, worst = {}, 0.0
    for way in chains["ways"]:
        what = (way["sphere"], "disc" if "disc" in way else "lamp", way.get("disc", way.get("lamp")), way["chords"])
        found.setdefault(what, []).append(way)
        light = scene["background"]["discs"][what[2]] if what[1] == "disc" else scene["spheres"][what[2]]
        direction, sphere = way["direction"], scene["spheres"][way["sphere"]]
        t = distance_to(place.point, direction, sphere, False)
        at = add(place.point, direction, t)
        assert max(abs(a - b) for a, b in zip(at, way["at"])) < 1e-5, (way, at)
        _, meets, _ = place.brings(direction, way["sphere"], way["chords"], light)
        assert meets, f"{way} does not lead to the lamp"
        if way["to_middle"]:
            _, origin, onward, _ = place.chain(direction, way["sphere"], way["chords"])
            aim = unit(light["direction"]) if what[1] == "disc" else unit(add(light["center"], origin, -1))
            assert dot(aim, onward) > 1 - 1e-9, f"{way} misses the middle: {aim}, {onward}"
        normal = unit(add(way["at"], sphere["center"], -1))
        assert abs(math.degrees(math.acos(-dot(normal, direction))) - way["degrees"]) < 1e-3, way
    counts = {what: len(ways) for what, ways in found.items()}
    assert all(counts.get(what, 0) >= count for what, count in wanted.items()), f"{counts} instead of {wanted}"
    for number, sphere in enumerate(scene["spheres"]):
        material = scene["materials"][sphere["material"]]
        if material["type"] not in ("dielectric", "metal"):
            continue
        lights = [("lamp", i, s) for i, s in enumerate(scene["spheres"]) if s["material"] == "lamp"]
        lights += [("disc", i, d) for i, d in enumerate(scene["background"]["discs"])]
        for kind, light_number, light in lights:
            for chords in (0,) if material["type"] == "metal" else (0, 1, 2):
                said = [sum(way["brings"][c] for way in found.get((number, kind, light_number, chords), [])) for c in range(3)]
                true = [a * b for a, b in zip(place.integral(number, chords, light), step["throughput"])]
                for a, b in zip(said, true):
                    off = abs(a - b) / max(b, 1e-5)
                    worst = max(worst, off)
                    assert off < allowed, f"sphere {number}, {kind} {light_number}, {chords} chords: {said} instead of {true}"
    return f"{sum(counts.values())} ways, sums within {worst:.2%}"


def through_glass():
    return judge(looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15)]), {(1, "lamp", 2, 1): 1})


def three_ways():
    """Near the axis, before the focus: straight through, and near the rim on both sides."""
    return judge(looking_at(-0.02, 0.0, [ball(height=0.6), lamp(0, 6, 0.02, 0.3)]), {(1, "lamp", 2, 1): 3}, 0.03)


def reflected_inside():
    """Back to where the light came from, by two ways, and off the outside."""
    return judge(looking_at(1.0, 0.2, [ball(height=0.6), lamp(3, 1, 0.1, 0.3)]), {(1, "lamp", 2, 2): 2, (1, "lamp", 2, 0): 1}, 0.03)


def of_a_sun():
    return judge(looking_at(-0.3, -0.1, [ball(), ball("mirror") | {"center": [1.6, 0.5, 0]}], [SUN]), {(1, "disc", 0, 1): 1}, 0.03)


def off_a_mirror():
    scene = looking_at(-0.2, 0.3, [ball("mirror", height=0.6), lamp(-1.4, 1.5, 0.5, 0.2)], [SUN])
    return judge(scene, {(1, "lamp", 2, 0): 1})


def other_surfaces():
    """Other laws of reflection, other lobes of the floor, a ball that is inside out."""
    said = [judge(looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15)], scatter=scatter, glass={**GLASS, **glass}),
                  {(1, "lamp", 2, 1): 1}, 0.03)
            for scatter, glass in (("cosine_cubed", {"fresnel": "exact"}), ("hemisphere", {"fresnel": "none"}),
                                   ("lambertian", {"refraction_index": 2.4}))]
    said.append(judge(looking_at(-0.35, 0.1, [ball(radius=-0.5), lamp(1.0, 2.2, 0.3, 0.15)], glass={**GLASS, "refraction_index": 0.625}),
                      {(1, "lamp", 2, 1): 1}, 0.03))
    return "; ".join(said)


def what_stands_in_the_way():
    """A ball before the lamp, beside the way, and half in it."""
    whole = explained(looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15)]))["chains"]["ways"]
    shares = []
    for z in (0.0, 0.2, 0.5):
        scene = looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15), {"center": [0.7, 1.65, z], "radius": 0.2, "material": "clay"}])
        ways = [way for way in explained(scene)["chains"]["ways"] if way["chords"] == 1]
        shares.append(ways[0]["stopped"])
        assert ways[0]["stopped_by"] == (3 if ways[0]["stopped"] > 0 else None), ways
        if 0 < shares[-1] < 1:
            judge(scene, {(1, "lamp", 2, 1): 1}, 0.05)
            assert f"         sphere 3 stops {100 * shares[-1]:.2g} % of it\n" in printed(scene), printed(scene)
    assert shares[0] == 1 and 0.1 < shares[1] < 0.9 and shares[2] == 0, shares
    scene = looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15), {"center": [0.7, 1.65, 0], "radius": 0.2, "material": "clay"}])
    assert "lamp 2 through sphere 1 (glass) is stopped by sphere 3\n" in printed(scene), printed(scene)
    return f"{len(whole)} ways; {shares}"


def what_is_printed():
    scene = looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15)])
    text, way = printed(scene), next(way for way in explained(scene)["chains"]["ways"] if way["chords"] == 1)
    assert "  light at the end of step 1 from balls of glass and mirrors (--caustics off):\n" in text, text
    triple = ", ".join(f"{x:.4g}" for x in way["brings"])
    assert f"       lamp 2 through sphere 1 (glass) brings ({triple})\n" in text, text
    at, along = ", ".join(f"{x:.5g}" for x in way["at"]), ", ".join(f"{x:.4f}" for x in way["direction"])
    assert f"         at ({at}), along ({along})\n" in text, text
    assert all(len(line) <= 80 for line in text.splitlines()), text
    assert "mirrors (--caustics on):\n" in printed(scene, "--caustics", "on")
    assert explained(scene)["chains"]["sampled"] is False and explained(scene, "--caustics", "on")["chains"]["sampled"] is True
    # Nothing to tell: no light sampling, a path that ends in the sky, a depth that leaves no room.
    assert explained(scene, "--light-sampling", "off")["chains"] is None
    assert "mirrors: none\n" in printed(looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15)], depth=2))
    beside = looking_at(1.0, 0.2, [ball(height=0.6), lamp(3, 1, 0.1, 0.3)])
    depths = [sorted({way["chords"] for way in explained(beside, "--depth", str(depth))["chains"]["ways"]}) for depth in (2, 3, 4, 5)]
    assert depths == [[], [0], [0], [0, 2]], depths
    scene["spheres"] = scene["spheres"][1:]
    assert explained(scene)["chains"] is None


def what_samples_get():
    """A step says apart what its ray to the lamp brings and what comes through the ball: with both, all that it has."""
    scene = looking_at(-0.35, 0.1, [ball(), lamp(1.0, 2.2, 0.3, 0.15)])
    led = 0
    for sample in range(12):
        steps = explained(scene, "--caustics", "on", "--first-sample", str(sample))["steps"]
        ray = steps[0].get("lamp_ray", {"brings": [0] * 3})["brings"]
        through = steps[0].get("led", [0] * 3)
        assert max(abs(a + b - c) for a, b, c in zip(ray, through, steps[0]["radiance"])) < 1e-6, steps[0]
        if through[0] > 0:
            led += 1
            triple = ", ".join(f"{x:.4g}" for x in through)
            text = printed(scene, "--caustics", "on", "--first-sample", str(sample))
            assert f" by way of a ball of glass or a mirror come ({triple}) " in " ".join(text.split()), text
        if "lamp_ray" in steps[0] and steps[0]["lamp_ray"]["meets"] != 2:
            assert max(ray) == 0, steps[0]
    assert led > 2, led
    assert "led" not in explained(scene)["steps"][0]
    return f"{led} of 12 samples"


CASES = [through_glass, what_is_printed]
DEEP_CASES = [what_samples_get, three_ways, reflected_inside, of_a_sun, off_a_mirror, other_surfaces, what_stands_in_the_way]

sys.exit(run_cases(CASES, DEEP_CASES))
