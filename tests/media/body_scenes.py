"""Boxes, meshes and capsules with media inside, and how long a ray is in them: by other ways than the program's.

In:    nothing.   Out: parts of scene documents, files of meshes as text, lengths.
Knows: the scene's grammar, the rule for nested media.   Does not know: the program.
"""
import math
import random

from vectors import cross, dot


def add(a, b):
    return [x + y for x, y in zip(a, b)]


def scale(s, a):
    return [s * x for x in a]


def turned(degrees, point):
    """About x, then y, then z, as the grammar has it."""
    for axis, angle in enumerate(degrees):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        j, k = (axis + 1) % 3, (axis + 2) % 3
        point = list(point)
        point[j], point[k] = c * point[j] - s * point[k], s * point[j] + c * point[k]
    return point


def turned_back(degrees, point):
    for axis, angle in reversed(list(enumerate(degrees))):
        point = turned([-angle if a == axis else 0 for a in range(3)], point)
    return point


def box(low, high, interior=None, material="edge", **placed):
    return {"corners": [list(low), list(high)], "material": material, **({"interior": interior} if interior else {}), **placed}


def box_stretch(each, origin, direction):
    """Where a line is in a box, from and to, by the slabs between its sides; None: nowhere."""
    degrees, way = each.get("rotate", [0, 0, 0]), each.get("translate", [0, 0, 0])
    o, d = turned_back(degrees, add(origin, scale(-1, way))), turned_back(degrees, direction)
    low, high = (([f(p) for p in zip(*each["corners"])]) for f in (min, max))
    begin, end = -math.inf, math.inf
    for a in range(3):
        if abs(d[a]) < 1e-300:
            if not low[a] <= o[a] <= high[a]:
                return None
            continue
        one, other = sorted(((low[a] - o[a]) / d[a], (high[a] - o[a]) / d[a]))
        begin, end = max(begin, one), min(end, other)
    return (begin, end) if begin < end else None


def ball_stretch(each, origin, direction):
    to = add(each["center"], scale(-1, origin))
    middle, square = dot(to, direction), dot(direction, direction)
    room = middle * middle - square * (dot(to, to) - each["radius"] ** 2)
    return None if room <= 0 else ((middle - math.sqrt(room)) / square, (middle + math.sqrt(room)) / square)


def capsule_stretch(each, origin, direction):
    """Of the cylinder between the ends, and of the balls there, which together are the capsule; it is convex."""
    first, radius = each["ends"][0], each["radius"]
    axis = add(each["ends"][1], scale(-1, first))
    to = add(origin, scale(-1, first))
    along, forth = dot(to, axis), dot(direction, axis)
    aside, way = (add(v, scale(-part / dot(axis, axis), axis)) for v, part in ((to, along), (direction, forth)))
    stretches = [ball_stretch({"center": end, "radius": radius}, origin, direction) for end in each["ends"]]
    if dot(way, way) > 1e-20 * dot(direction, direction):
        side = ball_stretch({"center": [0, 0, 0], "radius": radius}, aside, way)
    else:  # along the axis
        side = (-math.inf, math.inf) if dot(aside, aside) < radius ** 2 else None
    if forth != 0 and side:
        near, far = sorted((-along / forth, (dot(axis, axis) - along) / forth))
        stretches.append((max(side[0], near), min(side[1], far)))
    elif 0 <= along <= dot(axis, axis):
        stretches.append(side)
    stretches = [s for s in stretches if s and s[0] < s[1]]
    return (min(s[0] for s in stretches), max(s[1] for s in stretches)) if stretches else None


def volume(each):
    if "corners" in each:
        return math.prod(abs(a - b) for a, b in zip(*each["corners"]))
    ball = 4 / 3 * math.pi * abs(each["radius"]) ** 3
    return ball + math.pi * each["radius"] ** 2 * math.dist(*each["ends"]) if "ends" in each else ball


def stretch_of(each, origin, direction):
    if "corners" in each:
        return box_stretch(each, origin, direction)
    return capsule_stretch(each, origin, direction) if "ends" in each else ball_stretch(each, origin, direction)


def depth_along(shapes, densities, origin, direction, around=None):
    """The sum of density times length from the origin on: of the shapes around a point the one of least volume counts."""
    stretches = [stretch_of(each, origin, direction) for each in shapes]
    places = sorted({0.0, *(t for s in stretches if s for t in s if t > 0)})
    total = 0.0
    for low, high in zip(places, places[1:]):
        middle = 0.5 * (low + high)
        inside = [each for each, s in zip(shapes, stretches) if s and s[0] < middle < s[1]]
        name = min(inside, key=volume).get("interior") if inside else around
        total += densities.get(name, 0.0) * (high - low)
    return total * math.sqrt(dot(direction, direction))


def off(points, faces):
    lines = ["OFF", f"{len(points)} {len(faces)} 0", *(" ".join(repr(x) for x in p) for p in points), *("3 " + " ".join(map(str, f)) for f in faces)]
    return "\n".join(lines) + "\n"


def crossings_length(points, faces, origin, direction):
    """How long a ray is in closed triangles: what it leaves less what it enters, all by brute force."""
    total = 0.0
    for face in faces:
        a, b, c = (add(points[i], scale(-1, origin)) for i in face)
        u, v, w = dot(direction, cross(c, b)), dot(direction, cross(a, c)), dot(direction, cross(b, a))
        if not ((u >= 0 and v >= 0 and w >= 0) or (u <= 0 and v <= 0 and w <= 0)) or u == v == w == 0:
            continue
        normal = cross(add(b, scale(-1, a)), add(c, scale(-1, a)))
        along = dot(direction, normal)
        t = dot(a, normal) / along
        if t > 0:
            total += t if along > 0 else -t
    return total


def star(points=7, inner=0.35, outer=1.0, depth=0.5):
    """A prism over a star: a ray across it enters and leaves up to `points` times."""
    rim = [[(outer if i % 2 == 0 else inner) * f(math.pi * i / points) for f in (math.cos, math.sin)] for i in range(2 * points)]
    n = len(rim)
    vertices = [[x, y, z] for z in (-depth, depth) for x, y in rim] + [[0, 0, -depth], [0, 0, depth]]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [[i, j, n + j], [i, n + j, n + i], [2 * n, j, i], [2 * n + 1, n + i, n + j]]
    return vertices, faces


def comb(teeth=5):
    """A bar with teeth, along x: a ray along it passes through all of them. Teeth and gaps are 0.1 wide, from -0.45 on."""
    outline = [[-0.45, -0.5], [-0.45 + 0.2 * teeth - 0.1, -0.5]]
    for i in reversed(range(teeth)):
        left = -0.45 + 0.2 * i
        outline += [[left + 0.1, 0.5], [left, 0.5]]
        if i > 0:
            outline += [[left, -0.25], [left - 0.1, -0.25]]
    n = len(outline)
    vertices = [[x, y, z] for z in (-0.5, 0.5) for x, y in outline]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [[i, j, n + j], [i, n + j, n + i]]
    for a, b, c in ears(outline):
        faces += [[n + a, n + b, n + c], [a, c, b]]
    return vertices, faces


def ears(outline):
    """Cuts a polygon that runs counter-clockwise into triangles."""
    def area(a, b, c):
        (x, y), (u, v), (s, t) = (outline[i] for i in (a, b, c))
        return (u - x) * (t - y) - (v - y) * (s - x)
    left = list(range(len(outline)))
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            if area(a, b, c) > 0 and not any(min(area(a, b, p), area(b, c, p), area(c, a, p)) >= 0 for p in left if p not in (a, b, c)):
                yield a, b, c
                del left[k]
                break
        else:
            raise AssertionError("no ear")
    yield tuple(left)


def pillow(side, height, seed):
    """Two sheets of vertices over a square of side x side points, from 0 on, that share their rim; how far apart they are."""
    chance = random.Random(seed)
    points, front, back, apart, rims = [], {}, {}, {}, set()
    for j in range(side):
        for i in range(side):
            rim = i in (0, side - 1) or j in (0, side - 1)
            if rim:
                rims.add(len(points))
            top, bottom = (0.0, 0.0) if rim else (height * (0.5 + chance.random()), -height * (0.5 + chance.random()))
            front[i, j] = len(points)
            points.append([float(i), float(j), top])
            back[i, j] = front[i, j] if rim else len(points)
            if not rim:
                points.append([float(i), float(j), bottom])
            apart[i, j] = top - bottom
    faces = []
    for j in range(side - 1):
        for i in range(side - 1):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            for a, b, c in ((0, 1, 2), (0, 2, 3)):
                faces.append([front[corners[a]], front[corners[b]], front[corners[c]]])
                faces.append([back[corners[a]], back[corners[c]], back[corners[b]]])
    return points, [f for f in faces if not set(f) <= rims], apart
