"""Is the kept truth true? The variance of a sample from the light's side, for two scenes, by other means than the program's.

    python3 tests/unseen/test_unseen_truth.py [RAYS]

In:    scenes/caustic-alone-*.json: a floor, a glass ball outside of the picture, one sun or lamp; truth.json.
Out:   the variance that light through and off the ball gives to one sample, beside the kept one; exit code 1 if they differ.
Knows: a camera, a ball of glass, the film's measure.   Does not know: the program, which traces paths from the camera.

A sample of the picture that meets the floor at y scatters into a direction with density cos / pi, passes the ball by choices of
reflection and refraction, and finds the light: it is then worth c = albedo * L. So the mean over pixels of the variance is the integral of
c^2 over all lines from the light through the ball to the floor, by the measure w(y) dE / pi: E is the extent (etendue) of a beam of
lines, which no refraction changes, and w the share of the picture's film for each area of the floor. The probability of a chain of
choices is the same from both ends, since a ray inside a ball meets it everywhere at the same angle. What is left out is small: the
square of the mean (p c)^2, and light that scatters more than once.
"""

import json
import math
import pathlib
import random
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
LUMINANCE = (0.2126, 0.7152, 0.0722)


def add(a, b, scale=1.0):
    return (a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def frame(axis):
    """Two directions across the axis."""
    across = unit(cross(axis, (1.0, 0.0, 0.0) if abs(axis[0]) < 0.5 else (0.0, 1.0, 0.0)))
    return across, cross(axis, across)


def hit(origin, direction, sphere):
    """The first distance ahead at which a line meets a sphere from outside, or None."""
    to = add(sphere["center"], origin, -1)
    along = dot(to, direction)
    away = add(to, direction, -along)
    square = sphere["radius"] ** 2 - dot(away, away)
    if square <= 0:
        return None
    distance = along - math.sqrt(square)
    return distance if distance > 0 else None


def mirrored(direction, normal):
    return add(direction, normal, -2 * dot(direction, normal))


def reflectance(glass, cosine, ratio):
    """ratio: index of where the ray comes from over that of the other side; 1 for total reflection."""
    sine = ratio * math.sqrt(max(0.0, 1 - cosine * cosine))
    if sine >= 1:
        return 1.0
    if glass.get("fresnel", "schlick") == "schlick":
        zero = ((1 - ratio) / (1 + ratio)) ** 2
        return zero + (1 - zero) * (1 - cosine) ** 5
    behind = math.sqrt(1 - sine * sine)
    across = (ratio * cosine - behind) / (ratio * cosine + behind)
    along = (cosine - ratio * behind) / (cosine + ratio * behind)
    return 0.5 * (across * across + along * along)


def refracted(direction, normal, cosine, ratio):
    behind = math.sqrt(1 - ratio * ratio * (1 - cosine * cosine))
    return unit(add(tuple(ratio * x for x in direction), normal, ratio * cosine - behind))


def through(origin, direction, ball, glass, draw):
    """A line that has left the ball for good, by a chain of choices; None if it misses the ball."""
    distance = hit(origin, direction, ball)
    if distance is None:
        return None
    index = glass["refraction_index"]
    point = add(origin, direction, distance)
    normal = unit(add(point, ball["center"], -1))
    cosine = -dot(direction, normal)
    if draw.random() < reflectance(glass, cosine, 1 / index):
        return point, mirrored(direction, normal)
    direction = refracted(direction, normal, cosine, 1 / index)
    for _ in range(50):
        point = add(point, direction, 2 * ball["radius"] * -dot(direction, normal))
        normal = unit(add(point, ball["center"], -1))
        cosine = dot(direction, normal)
        inward = tuple(-x for x in normal)
        if draw.random() >= reflectance(glass, cosine, index):
            return point, refracted(direction, inward, cosine, index)
        direction = mirrored(direction, inward)
    return None


def on_disc(draw, center, axes, radius):
    distance, turn = radius * math.sqrt(draw.random()), 2 * math.pi * draw.random()
    return add(add(center, axes[0], distance * math.cos(turn)), axes[1], distance * math.sin(turn))


class Camera:
    def __init__(self, camera):
        self.origin = tuple(camera["lookfrom"])
        self.view = unit(add(camera["lookat"], self.origin, -1))
        self.right = unit(cross(self.view, tuple(camera.get("vup", (0, 1, 0)))))
        self.up = cross(self.right, self.view)
        width = camera["image_width"]
        height = math.floor(width * camera["aspect_ratio"][1] / camera["aspect_ratio"][0] + 1e-6)
        self.high = math.tan(math.radians(camera["vfov"]) / 2)
        self.wide = self.high * width / height

    def share(self, point, normal, hidden_by):
        """Of the film, for each area of a surface there; 0 where it is not in the picture."""
        to = add(point, self.origin, -1)
        depth = dot(to, self.view)
        if depth <= 0 or abs(dot(to, self.right)) > self.wide * depth or abs(dot(to, self.up)) > self.high * depth:
            return 0.0
        distance = math.sqrt(dot(to, to))
        direction = tuple(x / distance for x in to)
        near = hit(self.origin, direction, hidden_by)
        if near is not None and near < distance:
            return 0.0
        facing = -dot(direction, normal)
        return max(facing, 0.0) / (distance ** 2 * (depth / distance) ** 3) / (4 * self.wide * self.high)


def variance_from_the_light(scene, rays, draw):
    floor, ball = scene["spheres"][:2]
    glass = scene["materials"][ball["material"]]
    albedo = scene["materials"][floor["material"]]["albedo"]
    camera = Camera(scene["camera"])
    if len(scene["spheres"]) == 3:
        lamp = scene["spheres"][2]
        radiance = scene["materials"][lamp["material"]]["emit"]
        axis = unit(add(ball["center"], lamp["center"], -1))
        wider = 1.5  # lines through a sphere stray from its disc across the axis
    else:
        disc, = scene["background"]["discs"]
        lamp, radiance = None, disc["radiance"]
        axis = unit(tuple(-x for x in disc["direction"]))
        half_square = math.sin(math.radians(disc["half_angle"] / 2)) ** 2
        wider = 1.02
    axes = frame(axis)
    area = math.pi * (wider * ball["radius"]) ** 2
    worth = sum(w * a * e for w, a, e in zip(LUMINANCE, albedo, radiance)) ** 2 / math.pi
    total = squares = 0.0
    for _ in range(rays):
        target = on_disc(draw, ball["center"], axes, wider * ball["radius"])
        if lamp is None:
            square, turn = draw.random() * half_square, 2 * math.pi * draw.random()  # of the sine of half the angle
            sine = 2 * math.sqrt(square * (1 - square))
            direction = add(add(tuple((1 - 2 * square) * x for x in axis), axes[0], sine * math.cos(turn)), axes[1], sine * math.sin(turn))
            extent = area * 4 * math.pi * half_square * dot(direction, axis)
        else:
            source = on_disc(draw, lamp["center"], axes, wider * lamp["radius"])
            to = add(target, source, -1)
            square = dot(to, to)
            direction = tuple(x / math.sqrt(square) for x in to)
            if hit(add(source, direction, -10 * lamp["radius"]), direction, lamp) is None:
                continue
            extent = area * math.pi * (wider * lamp["radius"]) ** 2 * dot(direction, axis) ** 2 / square
        line = through(add(target, direction, -20 * ball["radius"]) if lamp is None else source, direction, ball, glass, draw)
        if line is None:
            continue
        distance = hit(*line, floor)
        if distance is None:
            continue
        point = add(*line, distance)
        found = worth * extent * camera.share(point, unit(add(point, floor["center"], -1)), ball)
        total += found
        squares += found * found
    mean = total / rays
    return mean, math.sqrt(max(squares / rays - mean * mean, 0) / rays)


def main():
    rays = int(sys.argv[1]) if len(sys.argv) > 1 else 60000
    truth = json.loads((FOLDER / "truth.json").read_text())
    wrong = False
    for name in ("caustic-alone-sun", "caustic-alone-lamp"):
        scene = json.loads((FOLDER / f"scenes/{name}.json").read_text())
        found, error = variance_from_the_light(scene, rays, random.Random(name))
        kept, kept_error = truth[name]["variance"]
        apart = (kept - found) / math.hypot(error, kept_error)
        print(f"{name}: from the light {found:.4g} +- {error:.2g}, kept {kept:.4g} +- {kept_error:.2g}: {apart:+.1f} standard errors")
        wrong |= not abs(apart) < 4 or not kept_error < 0.1 * kept
    sys.exit(1 if wrong else 0)


main()
