#!/usr/bin/env python3
"""Light by way of two balls of glass or mirrors in turn, sampled: maps of rays, and the same mean as by chance.

usage: test_caustic_pairs.py PROGRAM SOURCE_DIR [--deep | CASE...]

A sun of a twentieth of a degree stands above two balls and a matte ball as small as a pea, the only thing that is lit. Here rays are followed
from the sun, over a grid of its beam; where the places at which neighbours arrive surround the middle of the pea, the ray between them
arrives there, and the light that it brings is that of the sun times the area of the beam over the area that it lights. What comes with
one segment less is the same in both of two pictures, of which one allows for one segment more: their difference is the light of chains of
that length, without its noise.
"""
import math
import statistics
import sys


from program_cases import picture, run_cases
from pfm import read_pfm
from vectors import cross, dot, unit

HALF, SUN, ALBEDO = 0.05, 1e6, 0.5
PEA = 0.00390625
GRID, FINER = 160, 6  # cells of the beam, and their parts where rays arrive
FINE = GRID * FINER
MIRROR = {"type": "metal", "albedo": [1, 1, 1]}


def glass(index=1.5, fresnel="exact"):
    return {"type": "dielectric", "refraction_index": index, "fresnel": fresnel}


def add(s, a, b):
    return (s * a[0] + b[0], s * a[1] + b[1], s * a[2] + b[2])


def beside(w):
    s = unit(cross(w, (1, 0, 0) if abs(w[0]) < 0.5 else (0, 1, 0)))
    return s, cross(w, s)


def fresnel(cosine, ratio):
    """Reflectance, unpolarised; `ratio`: the index behind over before."""
    square = 1 - (1 - cosine * cosine) / ratio ** 2
    if square <= 0:
        return 1
    other = math.sqrt(square)
    return (((cosine - ratio * other) / (cosine + ratio * other)) ** 2 + ((ratio * cosine - other) / (ratio * cosine + other)) ** 2) / 2


class Ball:
    def __init__(self, center, radius, material):
        self.center, self.radius, self.material = center, radius, material
        self.index = material.get("refraction_index")

    def distance(self, origin, direction, inside=False):
        """To where a ray meets the ball, or None."""
        way = add(-1, self.center, origin)
        along, apart = dot(way, direction), dot(way, way) - self.radius ** 2
        square = along * along - apart
        if square <= 0 or (not inside and (along >= 0 or apart < 0)):
            return None
        return -along + math.sqrt(square) if inside else -along - math.sqrt(square)

    def share(self, cosine, ratio, passes):
        if self.index is None:
            return 0 if passes else 1
        if self.material["fresnel"] == "none":
            return 1 if passes else 0
        reflected = fresnel(cosine, ratio)
        return 1 - reflected if passes else reflected

    def lead(self, origin, direction, chords):
        """Through the ball by so many chords: where the ray leaves, its direction and what is left of it; or None."""
        left, length = 1, 0
        for hit in range(chords + 1):
            t = self.distance(origin, direction, hit > 0)
            if t is None:
                return None
            if hit == 0:
                length = t
            origin = add(t, direction, origin)
            normal = unit(add(-1, self.center, origin))
            if hit > 0:
                normal = add(-2, normal, normal)
            cosine = -dot(direction, normal)
            ratio = (1 / self.index if hit > 0 else self.index) if self.index else 1
            passes = chords > 0 and hit in (0, chords)
            left *= self.share(cosine, ratio, passes)
            if passes:
                square = 1 - (1 - cosine * cosine) / ratio ** 2
                if square <= 0:
                    return None
                direction = unit(add(cosine / ratio - math.sqrt(square), normal, add(1 / ratio - 1, direction, direction)))
            else:
                direction = add(2 * cosine, normal, direction)
        return origin, direction, left, length


class Chain:
    """Of light, from the sun on: balls, and the chords inside them."""

    def __init__(self, sun, parts, others, place, normal):
        self.sun, self.parts, self.others, self.place, self.normal = sun, parts, others, place, normal
        self.across = beside(sun)
        self.along = beside(normal)

    def blocked(self, origin, direction, length, but):
        return any(ball is not but and (t := ball.distance(origin, direction)) is not None and 1e-9 < t < length for ball in self.others)

    def land(self, u, v):
        """Where in the plane of the pea a ray of the beam arrives, and what is left of it."""
        first = self.parts[0][0]
        origin = add(20, self.sun, add(u, self.across[0], add(v, self.across[1], first.center)))
        direction, left, last = add(-2, self.sun, self.sun), 1, None
        for ball, chords in self.parts:
            passed = ball.lead(origin, direction, chords)
            if passed is None or self.blocked(origin, direction, passed[3], last):
                return None
            origin, direction, last = passed[0], passed[1], ball
            left *= passed[2]
        falls = dot(direction, self.normal)
        if falls >= 0:
            return None
        t = dot(add(-1, origin, self.place), self.normal) / falls
        if t <= 0 or self.blocked(origin, direction, t, last):
            return None
        off = add(-1, self.place, add(t, direction, origin))
        return dot(off, self.along[0]), dot(off, self.along[1]), left

    def refine(self, u, v):
        """The ray that arrives in the middle, its area over the area that it lights, and what is left."""
        step = 1e-6 * self.parts[0][0].radius
        before, least = (u, v), math.inf
        for _ in range(60):
            here, right, up = self.land(u, v), self.land(u + step, v), self.land(u, v + step)
            if None in (here, right, up) or math.hypot(here[0], here[1]) >= least:  # too far: half of the way
                u, v = (before[0] + u) / 2, (before[1] + v) / 2
                continue
            before, least = (u, v), math.hypot(here[0], here[1])
            a, b = (right[0] - here[0]) / step, (up[0] - here[0]) / step
            c, d = (right[1] - here[1]) / step, (up[1] - here[1]) / step
            area = a * d - b * c
            if least < 1e-9:
                return u, v, here[2] / abs(area)
            u, v = u + (b * here[1] - d * here[0]) / area, v + (c * here[0] - a * here[1]) / area
        return None

    def irradiance(self):
        """Over that of the sun, in the middle of the pea."""
        radius = self.parts[0][0].radius
        found, landed = [], {}

        def land(i, j):
            if (i, j) not in landed:
                landed[i, j] = self.land(radius * (2 * i / FINE - 1), radius * (2 * j / FINE - 1))
            return landed[i, j]

        def look(i, j, size):
            """Both triangles of a cell."""
            for corners in (((i, j), (i + size, j), (i, j + size)), ((i + size, j + size), (i + size, j), (i, j + size))):
                places = [land(*corner) for corner in corners]
                if None in places:
                    continue
                signs = [p[0] * q[1] - p[1] * q[0] > 0 for p, q in zip(places, places[1:] + places[:1])]
                if signs[0] != signs[1] or signs[0] != signs[2]:
                    continue
                root = self.refine(*(radius * (2 * sum(corner[a] for corner in corners) / 3 / FINE - 1) for a in (0, 1)))
                if root and all(math.hypot(root[0] - r[0], root[1] - r[1]) > 1e-5 * radius for r in found):
                    found.append(root)

        steps = range(0, FINE, FINE // GRID)
        valid = {(i, j) for i in steps for j in steps if land(i, j)}
        wide = FINE // GRID
        cells = {(i + a * wide, j + b * wide) for i, j in valid for a in (-2, -1, 0, 1) for b in (-2, -1, 0, 1)}
        for i, j in cells:
            for a in range(0, wide, wide // FINER):
                for b in range(0, wide, wide // FINER):
                    look(i + a, j + b, wide // FINER)
        return sum(root[2] for root in found)


def chains_of(segments, balls):
    """All chains from a vertex to the sun of so many segments, by way of one ball or two: parts from the sun on."""
    def possible(ball, chords):
        return ball.index is not None or chords == 0

    for ball in balls:
        if possible(ball, segments - 2):
            yield [(ball, segments - 2)]
    for first in balls:
        for second in balls:
            for chords in range(segments - 2):
                if first is not second and possible(first, chords) and possible(second, segments - 3 - chords):
                    yield [(first, chords), (second, segments - 3 - chords)]


def scene_of(balls, place, normal, sun, eye, depth, width=1):
    """The camera sees nothing but the middle of the pea."""
    materials = {f"ball{i}": ball.material for i, ball in enumerate(balls)}
    return {"camera": {"image_width": width, "aspect_ratio": 1, "max_depth": depth, "vfov": 0.001, "lookfrom": list(eye), "lookat": list(place)},
            "background": {"bottom": [0] * 3, "top": [0] * 3, "discs": [{"direction": list(sun), "half_angle": HALF, "radiance": [SUN] * 3}]},
            "materials": {"pea": {"type": "lambertian", "albedo": [ALBEDO] * 3}, **materials},
            "spheres": [{"center": list(add(-PEA, normal, place)), "radius": PEA, "material": "pea"}]
                       + [{"center": list(ball.center), "radius": ball.radius, "material": f"ball{i}"} for i, ball in enumerate(balls)]}


WORST = [0.0]


def check_chain(what, balls, sun, parts, u, v, allowed=0.01, spp=65536):
    """Light of all chains as long as the one by way of `parts`, at the place where a ray of its beam meets the ground."""
    sun = unit(sun)
    probe = Chain(sun, parts, balls, (0, 0, 0), (0, 1, 0))
    radius = parts[0][0].radius
    landed = probe.land(u * radius, v * radius)
    assert landed, f"{what}: no such ray"
    ground = add(landed[0], probe.along[0], add(landed[1], probe.along[1], (0, 0, 0)))
    place, normal = tuple(round(x * 1024) / 1024 for x in ground), (0, 1, 0)
    segments = 1 + sum(chords + 1 for _, chords in parts)
    wanted = sum(Chain(sun, other, balls, place, normal).irradiance() for other in chains_of(segments, balls))
    wanted *= SUN * math.sin(math.radians(HALF)) ** 2 * ALBEDO
    eye = add(1, place, (0.125, 6, 0.25))

    def radiance(depth):
        return read_pfm(picture(scene_of(balls, place, normal, sun, eye, depth), "--spp", str(spp), "--caustics", "on", "--roulette", "off"))[2][0]

    found = radiance(segments + 1) - radiance(segments)
    WORST[0] = max(WORST[0], abs(found / wanted - 1))
    assert abs(found / wanted - 1) <= allowed, f"{what} at {place}: {found} instead of {wanted}, {found / wanted - 1:+.3%}"


def largest():
    return f"within {WORST[0]:.2%}"


SUN_ASIDE = (-4, 3, 2)
LEFT, RIGHT = (-0.75, 0.5, 0.25), (0.75, 0.5, 0)
GLASS_AND_MIRROR = [Ball(LEFT, 0.5, glass()), Ball(RIGHT, 0.5, MIRROR)]
MIRRORS = [Ball(LEFT, 0.5, MIRROR), Ball(RIGHT, 0.5, MIRROR)]
GLASSES = [Ball(LEFT, 0.5, glass(1.3)), Ball(RIGHT, 0.5, glass(1.7))]
ROW = [Ball((-0.25, 0.625, 0.25), 0.5, glass()), Ball((-1.5, 1.5625, 0.875), 0.375, glass())]


def chains(balls, probes, **options):
    """`probes`: the ball that light meets first, the chords inside it and inside the other, and places in the first one's beam. They are far from
    folds, where neighbours of a ray go elsewhere."""
    for first, chords, others, *places in probes:
        for u, v in places:
            check_chain(f"{first} by {chords}, then {others}", balls, SUN_ASIDE, [(balls[first], chords), (balls[1 - first], others)], u, v, **options)
    return largest()


def through_glass_off_a_mirror():
    """A mirror stands in the beam of a ball of glass, and sends it to the ground beside itself."""
    return chains(GLASS_AND_MIRROR, [(0, 1, 0, (0.134, 0.827), (0.230, 0.818))])


def off_a_mirror_through_glass():
    return chains(GLASS_AND_MIRROR, [(1, 0, 1, (0.090, 0.212), (0.058, 0.222))])


def off_both():
    """Off a mirror, and off glass; once where one in three of the sun's points was missed, since steps of a root were small that were too large
    for the sun."""
    return "; ".join([chains(GLASS_AND_MIRROR, [(0, 0, 0, (-0.822, -0.560), (-0.707, -0.684)), (1, 0, 0, (0.115, 0.438), (0.357, 0.372))]),
                      chains(MIRRORS, [(1, 0, 0, (0.275, 0.419), (0.371, 0.355))])])


def reflected_inside():
    return chains(GLASS_AND_MIRROR, [(1, 0, 2, (0.228, 0.229), (0.083, 0.256))], spp=524288)


def two_kinds_of_glass():
    return chains(GLASSES, [(0, 1, 0, (0.551, 0.763), (0.607, 0.734)), (0, 0, 1, (-0.566, -0.799))])


def in_a_row():
    """The light that one ball of glass gathers is reflected off the next. What passes the next one too is mostly left to chance: Newton's method
    comes to few of those chains."""
    return chains(ROW, [(1, 1, 0, (0.350, -0.318), (0.561, -0.095))])


def reflected_twice_inside():
    """A single ball: as many chords as are sought."""
    ball = Ball(LEFT, 0.5, glass())
    check_chain("three chords", [ball], SUN_ASIDE, [(ball, 3)], 0.222, 0.836, spp=262144)
    return largest()


def lit(balls, light, half):
    """A floor under two balls, in a wide sun or near a large lamp, so that chance finds what chains bring, too."""
    lamps = [{"center": [-1.2, 2.2, 1.2], "radius": half, "material": "lamp"}] if light == "lamp" else []
    discs = [{"direction": list(SUN_ASIDE), "half_angle": half, "radiance": [100] * 3}] if light == "sun" else []
    return {"camera": {"image_width": 16, "aspect_ratio": 1, "vfov": 30, "lookfrom": [0, 4, 6], "lookat": [0, 0, 0.3]},
            "background": {"bottom": [0] * 3, "top": [0] * 3, "discs": discs},
            "materials": {"floor": {"type": "lambertian", "albedo": [ALBEDO] * 3}, "lamp": {"type": "diffuse_light", "emit": [40] * 3},
                          **{f"ball{i}": ball.material for i, ball in enumerate(balls)}},
            "spheres": [{"center": [0, -512, 0], "radius": 512, "material": "floor"}, *lamps]
                       + [{"center": list(ball.center), "radius": ball.radius, "material": f"ball{i}"} for i, ball in enumerate(balls)]}


def means(scene, depth, word, seeds, spp):
    """Of the light of chains that have as many segments as paths may have."""
    for seed in seeds:
        light = []
        for segments in (depth - 1, depth):
            scene["camera"]["max_depth"] = segments
            numbers = read_pfm(picture(scene, "--spp", str(spp), "--seed", str(seed), "--caustics", word, "--roulette", "off"))[2]
            light.append(sum(numbers) / len(numbers))
        yield light[1] - light[0]


def same(what, balls, light, half, depth, spp, most=0.05):
    """With and without: of as many chains as chance finds of so wide a light."""
    scene = lit(balls, light, half)
    chance, found = list(means(scene, depth, "off", range(8), spp)), list(means(scene, depth, "on", range(100, 108), spp // 4))
    error = math.hypot(statistics.stdev(chance), statistics.stdev(found)) / math.sqrt(8)
    wanted = statistics.mean(chance)
    off = statistics.mean(found) - wanted
    assert abs(off) < 4 * error, f"{what}: {off / error:+.1f} standard errors of {error / wanted:.2%}"
    assert error < most * wanted, f"{what}: only known to {error / wanted:.2%}"
    return f"{what} {off / error:+.1f} standard errors of {error / wanted:.2%}"


def with_chance():
    """Two mirrors, where all light of four segments is that of pairs and of one mirror with the floor: chance and chains weigh 1 together."""
    return "; ".join([same("sun", MIRRORS, "sun", 12, 4, 16384), same("lamp", MIRRORS, "lamp", 0.4, 4, 16384)])


def what_is_not_found():
    """Of two balls of glass in a row, Newton's method comes to few chains. The rest is met by chance, and counts in full."""
    return same("in a row", ROW, "sun", 12, 6, 16384)


CASES = []
DEEP_CASES = [through_glass_off_a_mirror, off_a_mirror_through_glass, off_both, reflected_inside, two_kinds_of_glass, in_a_row, reflected_twice_inside, with_chance, what_is_not_found]

if __name__ == "__main__":
    sys.exit(run_cases(CASES, DEEP_CASES))
