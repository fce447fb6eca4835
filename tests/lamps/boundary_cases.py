"""Hard cases of lamps behind the boundaries of media: small scenes, and what their one point shows. As disc_cases.py, and after
the numbers of motion_cases.py.

In:    a folder, which they do not need.   Out: cases, each a scene document with the radiance that it must show.
Knows: cases.py, forms.py, the scene's grammar, the rule for nested media.   Does not know: the program, how it samples.

Media that only absorb leave exp(-density * length) of what a lamp brings, summed here over the lamp's cone. Of media that
scatter, `max_depth` lets no path through that is scattered twice. So what is expected is a sum over known directions.
"""
import math

import forms
from cases import (BLACK, LIGHT, PI, POINT_NORMAL, Case, add, cross, document, dot, glass, lambertian, lamp, lamp_at, lit, on_unit_sphere,
                   scale, sphere, towards, unit)
from disc_cases import disc

RINGS = 180  # the edges of balls in the cone leave an error of some 1e-4
EDGE = {"type": "interface"}
MATERIALS = {"receiver": lambertian(), "lamp": lamp(), "edge": EDGE, "black": lambertian(BLACK)}


def boundary(center, radius, interior=None, material="edge", **more):
    return {**sphere(center, radius, material), **({"interior": interior} if interior else {}), **more}


def roots(origin, direction, center, radius):
    """Where a line meets a sphere, or None."""
    way = add(center, scale(-1, origin))
    middle = dot(way, direction)
    aside = radius * radius - (dot(way, way) - middle * middle)
    return None if aside < 0 else (middle - math.sqrt(aside), middle + math.sqrt(aside))


def depth_along(origin, direction, length, balls, densities):
    """The sum of density times length up to there; of the balls around a point the smallest one counts."""
    places = {0.0, length}
    met = [roots(origin, direction, ball["center"], ball["radius"]) for ball in balls]
    for pair in met:
        places.update(t for t in pair or () if 0 < t < length)
    places = sorted(places)
    total = 0.0
    for low, high in zip(places, places[1:]):
        middle = 0.5 * (low + high)
        around = [ball for ball, pair in zip(balls, met) if pair and pair[0] < middle < pair[1]]
        if around:
            total += densities.get(min(around, key=lambda ball: ball["radius"]).get("interior"), 0.0) * (high - low)
    return total


def over_lamp(origin, center, radius, share, rings=RINGS):
    """The integral over the directions to a sphere of share(direction, how far it is)."""
    way = add(center, scale(-1, origin))
    distance = math.sqrt(dot(way, way))
    axis = unit(way)
    across = unit(cross(axis, (1, 0, 0) if abs(axis[0]) < 0.7 else (0, 1, 0)))
    other = cross(axis, across)

    def density(theta, phi):
        s = math.sin(theta)
        direction = add(scale(math.cos(theta), axis), scale(s * math.cos(phi), across), scale(s * math.sin(phi), other))
        aside = max(0.0, radius * radius - (distance * s) ** 2)
        return share(direction, distance * math.cos(theta) - math.sqrt(aside))

    return forms.over_cone(density, math.asin(radius / distance), rings, rings)


def lit_through(lamp_ball, balls, densities):
    """What the matte point scatters of a lamp behind balls that absorb."""
    def share(direction, length):
        return max(0.0, dot(direction, POINT_NORMAL)) / PI * math.exp(-depth_along(POINT_NORMAL, direction, length, balls, densities))
    return over_lamp(POINT_NORMAL, lamp_ball["center"], lamp_ball["radius"], share)


def absorbing(densities):
    return {name: {"absorption": density} for name, density in densities.items()}


DENSITIES = {"thin": 0.7, "thick": 2.5, "clear": 0.0}


def floor_case(name, balls, lamp_ball=None, depth=12, others=(), **more):
    lamp_ball = lamp_ball or lamp_at(0.4, 4, 0.9)
    scene = on_unit_sphere(MATERIALS, [lamp_ball, *balls, *others], depth=depth, media=absorbing(DENSITIES))
    return Case(name, scene, lit(lit_through(lamp_ball, balls, DENSITIES)), rounding=3e-4, **more)


def at(distance, omega=0.4, azimuth=0.0):
    return add(POINT_NORMAL, scale(distance, towards(omega, azimuth)))


def case_90(_):
    """The shadow of balls that absorb: before the lamp, beside it, around it, cut by it, around the point."""
    yield floor_case("a ball before the lamp", [boundary(at(2), 0.6, "thin")])
    yield floor_case("a ball that hides a part of it", [boundary(at(2, 0.6, 0.5), 0.5, "thick")])
    yield floor_case("the lamp in a ball", [boundary(at(4), 1.3, "thin")], deep=True)
    yield floor_case("the lamp in a ball, aside", [boundary(at(4.2, 0.45, 0.3), 1.6, "thick")])
    yield floor_case("the lamp cut by the boundary", [boundary(at(3.6, 0.5), 1.0, "thick")])
    yield floor_case("the boundary touches the lamp", [boundary(at(2.5), 0.6, "thin")])
    yield floor_case("the boundary is the lamp", [boundary(at(4), 0.9, "thin")])
    yield floor_case("a clear boundary", [boundary(at(2), 0.6)])
    yield floor_case("a wall behind the lamp", [boundary(at(2), 0.6, "thin")], others=[sphere(at(9.2), 4, "black")])
    yield floor_case("a small lamp", [boundary(at(4), 1.3, "thin")], lamp_at(0.4, 4, 1e-4), chance=False)
    yield floor_case("in double", [boundary(at(2), 0.6, "thin")], options=("--precision", "double"), deep=True)


def case_91(_):
    """Nested and touching boundaries: each is passed, the smallest around a point decides."""
    yield floor_case("nested", [boundary(at(2), 0.8, "thin"), boundary(at(2.1), 0.5, "thick"), boundary(at(2), 0.2)])
    yield floor_case("overlapping", [boundary(at(1.8), 0.6, "thin"), boundary(at(2.3, 0.5), 0.5, "thick")])
    yield floor_case("touching", [boundary(at(1.4), 0.5, "thin"), boundary(at(2.4), 0.5, "thick")])
    yield floor_case("nearly the same twice", [boundary(at(2), 0.6, "thin"), boundary(at(2), 0.601, "thick")], deep=True)
    yield floor_case("touching inside, the lamp in both", [boundary(at(3.7), 1.5, "thin"), boundary(at(4), 1.2, "thick")])


def around_point(interior, lamp_ball, density, **more):
    """The point and the camera in a ball: on the way from the point to the camera light is lost too."""
    ball = boundary(BLACK, 2.5, interior)
    share = lit_through(lamp_ball, [ball], DENSITIES) * math.exp(-0.05 * density)
    scene = on_unit_sphere(MATERIALS, [lamp_ball, ball], depth=12, media=absorbing(DENSITIES))
    return Case(f"camera and point in a ball, {more.pop('name')}", scene, lit(share), rounding=1e-4, **more)


def case_92(_):
    """The camera is inside."""
    yield around_point("thin", lamp_at(0.4, 4, 0.9), 0.7, name="the lamp outside")
    yield around_point("thick", lamp_at(0.4, 1.6, 0.9), 2.5, name="the lamp cut by its boundary", deep=True)


def case_93(_):
    """A boundary is a segment for the ray to a lamp too: with one segment too few there is no light."""
    balls = [boundary(at(2), 0.8, "thin"), boundary(at(2), 0.5, "thick")]
    lamp_ball = lamp_at(0.4, 4, 0.3)
    # camera, two boundaries in, two out, the lamp
    yield floor_case("six segments", balls, lamp_ball, depth=6)
    scene = on_unit_sphere(MATERIALS, [lamp_ball, *balls], depth=5, media=absorbing(DENSITIES))
    yield Case("five segments", scene, BLACK, exact=True, samples=256)


def case_94(_):
    """Glass is no boundary for such a ray, whatever is inside; nor is a matte ball."""
    materials = {**MATERIALS, "glass": glass(1.2)}
    lamp_ball = lamp_at(0.4, 4, 0.1)
    # A path through the glass has four segments, and may have three.
    for name, balls, depth in (("glass", [boundary(at(2), 0.6, "thin", "glass")], 3),
                               ("a matte ball in a ball", [boundary(at(2), 0.7, "thin"), sphere(at(2), 0.4, "black")], 12)):
        scene = on_unit_sphere(materials, [lamp_ball, *balls], depth=depth, media=absorbing(DENSITIES))
        yield Case(f"{name} hides the lamp", scene, BLACK, exact=True, samples=256)


def single_scattering(ball, lamp_ball, scattering, absorption, g, eye, away, others=()):
    """What a ray from `eye` shows of light that the medium of a ball scatters once."""
    total = scattering + absorption
    densities = {"smoke": total}
    low, high = roots(eye, away, ball["center"], ball["radius"])
    low = max(low, 0.0)

    def at_depth(s):
        point = add(eye, scale(low + s, away))

        def share(direction, length):
            cosine = dot(direction, away)
            phase = (1 - g * g) / (4 * PI) / (1 + g * g - 2 * g * cosine) ** 1.5
            return phase * math.exp(-depth_along(point, direction, length, [ball, *others], densities))

        return scattering * math.exp(-total * s) * over_lamp(point, lamp_ball["center"], lamp_ball["radius"], share, 40)

    return forms.integrate(at_depth, 0, high - low, forms.nodes(24))


def smoke_case(name, ball, lamp_ball, scattering, absorption, g, eye, depth, **more):
    scene = document(MATERIALS, [ball, lamp_ball], eye, BLACK, depth,
                     media={"smoke": {"scattering": scattering, "absorption": absorption, "anisotropy": g}})
    share = single_scattering(ball, lamp_ball, scattering, absorption, g, eye, unit(scale(-1, eye)))
    return Case(name, scene, scale(share, LIGHT), rounding=3e-4, samples=4096, **more)


def case_95(_):
    """Smoke lit from outside, scattered once: the camera outside (four segments) and inside (three)."""
    ball = boundary(BLACK, 1, "smoke")
    outside = sphere((0.6, 2.5, 1.0), 0.8, "lamp")
    yield smoke_case("smoke and a lamp outside", ball, outside, 0.8, 0.3, 0, (0, 0.1, 4), 4)
    yield smoke_case("smoke that scatters ahead", ball, outside, 1.5, 0.0, 0.6, (3, 0.1, 2), 4, deep=True)
    yield smoke_case("the camera in the smoke", ball, outside, 0.8, 0.3, -0.5, (0, 0.1, 0.5), 3)


def case_96(_):
    """A disc, behind the boundary too: as far away as it is, the media end before it."""
    ball = boundary(at(2), 1.6, "thin")
    half = 12.0
    scene = on_unit_sphere(MATERIALS, [ball], depth=6, media=absorbing(DENSITIES))
    scene["background"] = {"bottom": list(BLACK), "top": list(BLACK), "discs": [disc(0.4, half, LIGHT)]}

    def share(direction, _):
        return max(0.0, dot(direction, POINT_NORMAL)) / PI * math.exp(-depth_along(POINT_NORMAL, direction, 1e6, [ball], DENSITIES))

    far = scale(1e6, towards(0.4))
    wanted = over_lamp(POINT_NORMAL, add(POINT_NORMAL, far), 1e6 * math.sin(math.radians(half)), share)
    yield Case("a disc behind a ball", scene, lit(wanted), rounding=1e-4)


def case_97(_):
    """A boundary that moves, along the line from the point to a small lamp: always the same length of it is crossed."""
    lamp_ball = lamp_at(0.4, 6, 0.05)
    share = forms.irradiance(math.asin(0.05 / 6), 0.4) * math.exp(-1.2 * 0.7)
    ball = boundary(at(1.5), 0.6, "thin", center_end=list(at(4)))
    scene = on_unit_sphere(MATERIALS, [lamp_ball, ball], depth=8, media=absorbing(DENSITIES))
    yield Case("a ball that moves to the lamp", scene, lit(share), rounding=3e-3, chance=False)


NUMBERED = {int(name[-2:]): function for name, function in sorted(globals().items()) if name.startswith("case_")}
