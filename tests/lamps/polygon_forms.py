"""What a point sees of triangles and quads, in closed form.

In:    a point, its normal, polygons; all in doubles.   Out: shares of the light that a matte lobe collects; solid angles.
Knows: J. H. Lambert's formula, of which the sum over edges is taken.   Does not know: scenes, the program, how it samples.
"""
import math

PI = math.pi


def difference(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def above(polygon, point, normal):
    """The part of a convex polygon above the horizon of a point, relative to the point."""
    corners = [difference(corner, point) for corner in polygon]
    heights = [dot(corner, normal) for corner in corners]
    kept = []
    for i, (a, ha) in enumerate(zip(corners, heights)):
        b, hb = corners[i - len(corners) + 1], heights[i - len(corners) + 1]
        if ha >= 0:
            kept.append(a)
        if (ha > 0 > hb) or (ha < 0 < hb):
            share = ha / (ha - hb)
            kept.append(tuple(x + share * (y - x) for x, y in zip(a, b)))
    return kept


def irradiance(polygon, point, normal):
    """What a matte point receives from the polygon, over pi times its radiance: half of the sum over edges of the angle that
    each fills times the cosine of its plane's normal (J. H. Lambert, "Photometria", 1760), over pi."""
    corners = above(polygon, point, normal)
    total = 0.0
    for i, a in enumerate(corners):
        b = corners[i - len(corners) + 1]
        across = cross(a, b)
        length = math.sqrt(dot(across, across))
        if length > 0:
            total += math.atan2(length, dot(a, b)) * dot(across, normal) / length
    return abs(total) / (2 * PI)


def solid_angle(triangle, point):
    """A. van Oosterom and J. Strackee, 1983."""
    a, b, c = (difference(corner, point) for corner in triangle)
    la, lb, lc = (math.sqrt(dot(v, v)) for v in (a, b, c))
    volume = dot(a, cross(difference(b, a), difference(c, a)))
    return 2 * math.atan2(abs(volume), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
