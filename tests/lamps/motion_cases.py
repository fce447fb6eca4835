"""Hard cases of lamps that move while the shutter is open: small scenes, and what their one point shows. As disc_cases.py, and
after the numbers of image_cases.py.

In:    a folder, which they do not need.   Out: cases, each a scene document with the radiance that it must show.
Knows: cases.py, forms.py, the scene's grammar.   Does not know: the program, how it samples.

A picture shows the mean over time, and at any time a lamp is one that rests: so what is expected is a closed form, summed over
time.
"""
import math
import random

import forms
from cases import (BLACK, LIGHT, PI, POINT_NORMAL, Case, add, dot, found_by_chance, fuzzy, lambertian, lamp, lamp_at, lit,
                   on_unit_sphere, scale, sphere, towards, unit)
from disc_cases import disc

TIMES = forms.nodes(64)


def moving(first, last, radius, material="lamp"):
    return {**sphere(first, radius, material), "center_end": list(last)}


def over_time(function):
    return forms.integrate(function, 0, 1, TIMES)


def share_at(center, radius, point=POINT_NORMAL, normal=POINT_NORMAL):
    """What a lamp brings to a matte point, over its radiance."""
    way = add(center, scale(-1, point))
    distance = math.sqrt(dot(way, way))
    return forms.irradiance(math.asin(radius / distance), math.acos(max(-1.0, min(1.0, dot(way, normal) / distance))))


def share_moving(first, last, radius):
    return over_time(lambda t: share_at(add(scale(1 - t, first), scale(t, last)), radius))


def place(omega, distance, azimuth=0.0):
    return add(POINT_NORMAL, scale(distance, towards(omega, azimuth)))


MATERIALS = {"receiver": lambertian(), "lamp": lamp(), "other": lamp(scale(2, LIGHT[::-1]))}
WAYS = {
    "across": (place(0.3, 3), place(1.0, 3, 2.0), 0.7),
    "nearer": (place(0.4, 8), place(0.4, 1.5), 0.9),
    "below the horizon": (place(0.9, 3), place(2.4, 3), 0.8),
    "far, through the view of the point": (place(0.8, 60, 0.0), place(0.8, 60, PI), 0.5),
    "small": (place(0.2, 3), place(0.9, 3, 1.0), 0.01),
}


def case_80(_):
    """The only lamp moves."""
    for name, (first, last, radius) in WAYS.items():
        share = share_moving(first, last, radius)
        yield Case(f"a lamp moves: {name}", on_unit_sphere(MATERIALS, [moving(first, last, radius)]), lit(share),
                   chance=found_by_chance(share), deep=name in ("nearer", "far, through the view of the point"))
    first, last, radius = WAYS["across"]
    yield Case("a lamp moves, in double", on_unit_sphere(MATERIALS, [moving(first, last, radius)]), lit(share_moving(first, last, radius)),
               options=("--precision", "double"), deep=True)


def case_81(_):
    """Beside one that rests: the probability of each depends on the time."""
    first, last, radius = place(1.2, 2.5), place(0.1, 2.5, 2.0), 0.6
    there, here = place(1.2, 3, 4.0), place(0.8, 2, 4.5)
    for name, other in (("rests", lamp_at(0.6, 3, 0.5, PI, "other")),
                        ("moves too", moving(there, here, 0.5, "other")),
                        ("is far", lamp_at(0.6, 300, 50, PI, "other"))):
        shares = share_moving(first, last, radius), (share_moving(there, here, 0.5) if "center_end" in other
                                                     else share_at(other["center"], other["radius"]))
        wanted = add(lit(shares[0]), lit(shares[1], MATERIALS["other"]["emit"]))
        yield Case(f"a lamp moves, and another {name}", on_unit_sphere(MATERIALS, [moving(first, last, radius), other]), wanted,
                   deep=name == "is far")


def case_82(_):
    """So many that there are nodes of them: some rest, some move far, and some hardly."""
    draw = random.Random(82)
    others, share = [], [0.0, 0.0]
    for i in range(60):
        first = place(draw.uniform(0, 1.3), draw.uniform(4, 9), draw.uniform(0, 2 * PI))
        last = add(first, scale((0, 0.1, 3)[i % 3], unit([draw.gauss(0, 1) for _ in range(3)])))
        radius = draw.uniform(0.01, 0.06)
        others.append(moving(first, last, radius, ("lamp", "other")[i % 2]))
        share[i % 2] += share_moving(first, last, radius)
    # Lamps may hide each other, but are so small that this is less than a thousandth.
    yield Case("sixty lamps, of which most move", on_unit_sphere(MATERIALS, others),
               add(lit(share[0]), lit(share[1], MATERIALS["other"]["emit"])), chance=False, samples=4096, rounding=1e-3)


def case_83(_):
    """Metal, whose lobe the lamp passes."""
    reflected = towards(math.acos(0.8))
    for fuzz, ball in ((0.5, False), (0.3, True)):
        scene = fuzzy(fuzz, ball, 0.8, 0.4, 3, 0.4, PI)
        last = fuzzy(fuzz, ball, 0.8, 0.4, 3, 0.4, PI / 2)["spheres"][-1]["center"]
        moves = scene["spheres"][-1]
        moves["center_end"] = last

        def share(t, first=moves["center"], last=last, fuzz=fuzz, ball=ball):
            way = add(scale(1 - t, first), scale(t, last), scale(-1, POINT_NORMAL))
            distance = math.sqrt(dot(way, way))
            return forms.fuzz_share(fuzz, ball, math.asin(0.4 / distance), math.acos(dot(way, reflected) / distance))

        yield Case(f"a lamp passes the lobe of fuzz {fuzz}", scene, lit(forms.integrate(share, 0, 1, forms.nodes(24))), deep=ball)


def case_84(_):
    """With a disc in the sky: the choice among it and the tree is made at the path's time too."""
    first, last, radius = WAYS["below the horizon"]
    scene = on_unit_sphere(MATERIALS, [moving(first, last, radius)])
    half = 10.0
    scene["background"] = {"bottom": list(BLACK), "top": list(BLACK), "discs": [disc(0.7, half, LIGHT, 2.5)]}
    share = share_moving(first, last, radius) + forms.irradiance(math.radians(half), 0.7)
    yield Case("a lamp that moves, and a disc", scene, lit(share))


NUMBERED = {int(name[-2:]): function for name, function in sorted(globals().items()) if name.startswith("case_")}
