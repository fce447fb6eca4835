"""Hard cases of triangles and quads that emit: small scenes, and what their one point shows. As cases.py, and after its numbers.

In:    a folder, which they do not need.   Out: cases, each a scene document with the radiance that it must show.
Knows: cases.py, polygon_forms.py, the scene's grammar.   Does not know: the program, how it samples.
"""
import array
import itertools
import math

import forms
import polygon_forms
from cases import (ALBEDO, BLACK, LIGHT, PI, POINT_NORMAL, SIDEWAYS, TANGENT, Case, add, cross, document, dot, found_by_chance, glass, lamp,
                   lamp_at, lambertian, lit, metal, on_unit_sphere, scale, sphere, towards, unit)


def place(x, y, z):
    """Over the point that is looked at: x and y along its surface, z away from it."""
    return add(POINT_NORMAL, scale(x, TANGENT), scale(y, SIDEWAYS), scale(z, POINT_NORMAL))


def triangle(corners, material="lamp"):
    return {"vertices": [list(corner) for corner in corners], "material": material}


def quad(corner, u, v, material="lamp"):
    return {"corner": list(corner), "u": list(u), "v": list(v), "material": material}


def quad_corners(each):
    corner, u, v = (tuple(each[name]) for name in ("corner", "u", "v"))
    return [corner, add(corner, u), add(corner, u, v), add(corner, v)]


def under(shapes, receiver=None, others=(), materials=None, light=LIGHT, **more):
    """A unit sphere that triangles and quads light."""
    made = on_unit_sphere({"receiver": receiver or lambertian(), "lamp": lamp(light), **(materials or {})}, list(others), **more)
    made["triangles"] = [each for each in shapes if "vertices" in each]
    made["quads"] = [each for each in shapes if "corner" in each]
    return made


def narrowed(corners, made):
    """As the device has them: from the camera, in single precision."""
    eye = made["camera"]["lookfrom"]
    return [add(eye, array.array("f", [x - y for x, y in zip(corner, eye)])) for corner in corners]


def share_of(corners):
    return polygon_forms.irradiance(corners, POINT_NORMAL, POINT_NORMAL)


# A triangle of side about 1 around the point's zenith, none of whose edges is parallel to an axis.
FLAT = ((-0.45, -0.35, 0), (0.6, -0.2, 0), (-0.1, 0.55, 0))


def over(height, tilt=0.0, aside=0.0, size=1.0):
    """FLAT at a height, turned around the second axis, and moved aside."""
    c, s = math.cos(tilt), math.sin(tilt)
    return [place(aside + size * c * x, size * y, height + size * s * x) for x, y, _ in FLAT]


def case_101(_):
    """A triangle at several heights, straight and aslant, above and beside."""
    for height, tilt, aside in ((1, 0, 0), (10, 0, 0), (3, 0, 0), (0.3, 0, 0), (0.1, 0, 0), (0.03, 0, 0), (0.003, 0, 0), (0.5, 0.7, 0.2), (1, 1.3, 0.4),
                                (0.3, 0.4, 3), (0.05, 0.02, 0.5)):
        corners = over(height, tilt, aside)
        share = share_of(corners)
        made = under([triangle(corners)])
        made["camera"]["lookfrom"] = list(add(POINT_NORMAL, scale(min(0.05, 0.3 * height), towards(0.6, PI))))
        yield Case(f"triangle at {height}, turned by {tilt}, {aside} aside", made, lit(share),
                   chance=found_by_chance(share), deep=height not in (1, 0.1, 0.5), sent=1 if tilt == aside == 0 else None)
    yield Case("triangle turned around", under([triangle(over(1)[::-1])]), lit(share_of(over(1))), sent=1)


def case_102(_):
    """Partly below the horizon, with one corner or two; seen from behind; wholly below."""
    for name, corners in (("one corner below", [place(0.4, -0.2, -0.3), place(0.9, 0.5, 0.8), place(0.3, 0.7, 0.5)]),
                          ("two corners below", [place(0.5, -0.6, -0.4), place(0.7, 0.6, -0.2), place(0.4, 0.1, 0.9)]),
                          ("a wall", [place(0.2, -1, -1), place(0.2, 1, -1), place(0.2, 0, 1)])):
        # On a plane of its own, since the unit sphere would be cut.
        floor = quad(place(-0.1, -0.1, 0), scale(0.2, TANGENT), scale(0.2, SIDEWAYS), "receiver")
        made = under([triangle(corners), floor])
        del made["spheres"]
        share = share_of(corners)
        yield Case(name, made, lit(share), chance=found_by_chance(share), deep=name == "a wall")
        other = under([triangle(corners[::-1]), floor])
        del other["spheres"]
        yield Case(f"{name}, from behind", other, lit(share), chance=False, deep=name != "two corners below")
    below = [place(0.2, 0, -0.3), place(0.9, 0.2, -0.1), place(0.9, -0.2, -0.2)]
    made = under([triangle(below), quad(place(-0.1, -0.1, 0), scale(0.2, TANGENT), scale(0.2, SIDEWAYS), "receiver")])
    yield Case("below the horizon", made, BLACK, exact=True, samples=64)


def case_103(_):
    """Quads: of side 1 at 1, at 0.1, over a corner, tilted, aside."""
    for name, each in (("at 1", quad(place(-0.5, -0.5, 1), TANGENT, SIDEWAYS)), ("at 0.1", quad(place(-0.5, -0.5, 0.1), TANGENT, SIDEWAYS)),
                       ("corner at 1", quad(place(0, 0, 1), TANGENT, SIDEWAYS)),
                       ("tilted", quad(place(-0.2, -0.5, 0.4), add(scale(0.8, TANGENT), scale(0.6, POINT_NORMAL)), SIDEWAYS)),
                       ("aside", quad(place(2, 1, 0.5), TANGENT, SIDEWAYS))):
        share = share_of(quad_corners(each))
        known = {"at 1": 0.239456, "at 0.1": 0.968340, "corner at 1": 0.138532}
        assert abs(share - known.get(name, share)) < 1e-6, (name, share)
        yield Case(f"quad {name}", under([each]), lit(share), chance=found_by_chance(share), deep=name in ("aside", "corner at 1"))


def case_104(_):
    """Triangles that are small, seen from afar, and slivers."""
    for size in (0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
        corners = over(3, 0.4, 0.5, size)
        share = share_of(narrowed(corners, under([])))
        light = scale(min(2e11, 0.1 / share), LIGHT)
        yield Case(f"size {size}", under([triangle(corners)], light=light), lit(share, light), chance=False, deep=size not in (1e-2, 1e-4, 1e-6),
                   rounding=1e-4)
    tiny = quad(place(0.3, 0.2, 2.1), scale(2e-6, TANGENT), add(scale(1e-6, SIDEWAYS), scale(1e-6, POINT_NORMAL)))
    corners = quad_corners(tiny)
    share = sum(share_of(narrowed(part, under([]))) for part in (corners[:3], [corners[0], *corners[2:]]))
    light = scale(2e11, LIGHT)
    yield Case("quad of 2e-6", under([tiny], light=light), lit(share, light), chance=False, rounding=1e-4)
    for width in (1e-2, 1e-4):
        corners = [place(-0.7, 0.1, 0.3), place(0.8, 0.1, 0.5), place(0.8, 0.1 + width, 0.5)]
        share = share_of(corners)
        light = scale(0.1 / share, LIGHT)
        yield Case(f"sliver of {width}", under([triangle(corners)], light=light), lit(share, light), chance=False, deep=width == 1e-2, rounding=1e-3)


def case_105(_):
    """Lobes of other shapes: even ones know the solid angle alone. And metal."""
    for height, tilt, aside in ((0.8, 0.3, 0), (0.25, 0.2, 0.1)):
        corners = over(height, tilt, aside)
        share = polygon_forms.solid_angle(corners, POINT_NORMAL) / (2 * PI)
        yield Case(f"even lobe, triangle at {height}", under([triangle(corners)], lambertian(scatter="hemisphere")), lit(share), deep=height == 0.8)
    for name, receiver in (("cubed", lambertian(scatter="cosine_cubed")), ("metal of fuzz 0.3", metal(0.3)),
                           ("rough metal", {"type": "metal", "albedo": list(ALBEDO), "roughness": 0.5}),
                           ("glossy", {"type": "glossy", "albedo": list(ALBEDO), "roughness": 0.3, "refraction_index": 1.5})):
        yield Case(f"{name}, on and off", under([triangle(over(0.6, 0.3, 0.35, 1.4))], receiver), samples=16384 if name != "cubed" else 4096)


def corners_of_box(center, half):
    return [[add(center, [half if (k >> a) & 1 else -half for a in range(3)]) for k in face]
            for face in ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))]


def case_106(_):
    """A box that emits: twelve triangles to choose from, of which most lie behind; and a ball of 320."""
    center, half = place(0.3, 0.2, 0.9), 0.25
    box = {"corners": [list(add(center, [-half] * 3)), list(add(center, [half] * 3))], "material": "lamp"}
    share = 0.0
    for face in corners_of_box(center, half):
        normal = cross(add(face[1], scale(-1, face[0])), add(face[2], scale(-1, face[0])))
        if dot(normal, add(face[0], scale(-1, center))) < 0:
            normal = scale(-1, normal)
        if dot(normal, add(POINT_NORMAL, scale(-1, face[0]))) > 0:
            share += share_of(face)
    yield Case("a box that emits", {**under([]), "boxes": [box]}, lit(share), samples=2048)
    t = (1 + math.sqrt(5)) / 2
    faces = [f for f in itertools.combinations([unit(v) for s in (1, -1) for r in (t, -t) for v in ((0, s, r), (s, r, 0), (r, 0, s))], 3)
             if all(abs(dot(add(a, scale(-1, b)), add(a, scale(-1, b))) - 4 / (1 + t * t)) < 1e-9 for a, b in itertools.combinations(f, 2))]
    assert len(faces) == 20
    for _ in range(2):
        faces = [part for a, b, c in faces for ab, bc, ca in [(unit(add(a, b)), unit(add(b, c)), unit(add(c, a)))]
                 for part in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
    center = place(0.4, -0.3, 1.2)
    ball = [[add(center, scale(0.4, v)) for v in face] for face in faces]
    share = 0.0
    for face in ball:
        normal = cross(add(face[1], scale(-1, face[0])), add(face[2], scale(-1, face[0])))
        if dot(normal, add(face[0], scale(-1, center))) < 0:
            normal = scale(-1, normal)
        if dot(normal, add(POINT_NORMAL, scale(-1, face[0]))) > 0:
            share += share_of(face)
    yield Case("a ball of 320 triangles that emit", under([triangle(face) for face in ball]), lit(share), samples=2048)


def case_107(_):
    """In one plane: the receiver brings itself nothing, nor what lies in its plane; convex bodies bring themselves nothing."""
    own = [place(-0.3, -0.2, 0), place(0.4, -0.3, 0), place(0, 0.5, 0)]
    beside = [place(0.4, -0.3, 0), place(1.2, 0.3, 0), place(0, 0.5, 0)]
    apart = [place(1, 1, 0), place(2, 1, 0), place(1, 2, 0)]
    glowing = lambertian(emit=[0.5, 0.25, 0.125])
    eye = place(0.02, 0.01, 0.5)
    for name, shapes in (("own triangle", [own]), ("a neighbour in the plane", [own, beside]), ("another in the plane", [own, apart])):
        made = document({"glowing": glowing}, [], eye, POINT_NORMAL)
        made["triangles"] = [triangle(each, "glowing") for each in shapes]
        del made["spheres"]
        yield Case(name, made, (0.5, 0.25, 0.125), exact=True, samples=64)
    bent = [place(0.4, -0.3, 0), place(1.2, 0.3, 0.8), place(0, 0.5, 0)]
    made = document({"receiver": lambertian(), "lamp": lamp()}, [], eye, POINT_NORMAL)
    del made["spheres"]
    made["triangles"] = [triangle(own, "receiver"), triangle(bent)]
    yield Case("a neighbour that is bent up", made, lit(share_of(bent)))


def case_108(_):
    """What stands between: a triangle, a sphere, half of the lamp in shadow; the other side of what emits."""
    each = quad(place(-0.5, -0.5, 1), TANGENT, SIDEWAYS)
    screen = quad(place(0, -4, 0.5), scale(8, TANGENT), scale(8, SIDEWAYS), "black")
    seen = [place(-0.5, -0.5, 1), place(0, -0.5, 1), place(0, 0.5, 1), place(-0.5, 0.5, 1)]
    yield Case("half behind a screen", under([each, screen], materials={"black": lambertian(BLACK)}), lit(share_of(seen)))
    wall = quad(place(-4, -4, 0.5), scale(8, TANGENT), scale(8, SIDEWAYS), "black")
    yield Case("behind a screen", under([each, wall], materials={"black": lambertian(BLACK)}), BLACK, exact=True, samples=64)
    other = quad(place(-4, -4, 0.9999), scale(8, TANGENT), scale(8, SIDEWAYS), "black")
    yield Case("close behind a screen", under([each, other], materials={"black": lambertian(BLACK)}), BLACK, exact=True, samples=64)
    ball = lamp_at(0, 0.6, 0.25, material="black")
    hidden = forms.irradiance(math.asin(0.25 / 0.6), 0)
    large = quad(place(-3, -3, 1), scale(6, TANGENT), scale(6, SIDEWAYS))
    yield Case("behind a sphere", under([large], others=[ball], materials={"black": lambertian(BLACK)}), lit(share_of(quad_corners(large)) - hidden))
    second = quad(place(-3, -3, 2), scale(6, TANGENT), scale(6, SIDEWAYS), "other")
    yield Case("a lamp behind a lamp", under([each, second], materials={"other": lamp((1, 2, 8))}),
               tuple(a + b for a, b in zip(lit(share_of(quad_corners(each))),
                                           lit(share_of(quad_corners(second)) - share_of(quad_corners(each)), (1, 2, 8)))))


def case_109(_):
    """With others: a sphere that emits, a disc of the sky; and one that is coincident."""
    corners = over(0.8, 0.4, -0.3)
    first = share_of(corners)
    ball = forms.irradiance(math.asin(0.3 / 2), 0.9)
    made = under([triangle(corners)], others=[lamp_at(0.9, 2, 0.3, azimuth=0.4, material="other")], materials={"other": lamp((1, 4, 16))})
    yield Case("a sphere beside", made, tuple(a + b for a, b in zip(lit(first), lit(ball, (1, 4, 16)))))
    made = under([triangle(corners)])
    made["background"] = {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": [
        {"direction": list(add(scale(math.cos(0.9), POINT_NORMAL), scale(math.sin(0.9), TANGENT))), "half_angle": 3, "radiance": [90, 60, 30]}]}
    sun = forms.irradiance(math.radians(3), 0.9)
    yield Case("a disc beside", made, tuple(a + b for a, b in zip(lit(first), lit(sun, (90, 60, 30)))))
    yield Case("twins, of which the first counts", under([triangle(corners), triangle(corners, "other")], materials={"other": lamp((1, 2, 8))}),
               lit(first), deep=True)


def case_110(_):
    """Media: fog that absorbs, around and in a ball; and fog that scatters, which triangles light."""
    corners = over(0.8, 0.0, 0.0, 1e-3)
    light = scale(0.1 / share_of(corners), LIGHT)
    made = under([triangle(corners)], light=light)
    made["media"] = {"ink": {"absorption": [0.5, 1, 2]}}
    made["medium"] = "ink"
    away = 0.8 + 0.05  # and to the camera
    yield Case("ink around", made, tuple(x * math.exp(-away * a) for x, a in zip(lit(share_of(corners), light), (0.5, 1, 2))), chance=False, rounding=1e-4)
    made = under([triangle(corners)], others=[lamp_at(0, 0.4, 0.1, material="edge")], materials={"edge": {"type": "interface"}}, light=light)
    made["spheres"][1]["interior"] = "ink"
    made["media"] = {"ink": {"absorption": [0.5, 1, 2]}}
    yield Case("ink in a ball between", made, tuple(x * math.exp(-0.2 * a) for x, a in zip(lit(share_of(corners), light), (0.5, 1, 2))),
               chance=False, rounding=1e-4)
    made = under([triangle(over(0.6, 0.3))], receiver=lambertian(BLACK))
    made["media"] = {"fog": {"scattering": 0.6, "absorption": 0.1, "anisotropy": 0.4}}
    made["medium"] = "fog"
    made["camera"].update(vfov=50, pixel_sampling="square", lookfrom=list(place(-2, 0, 0.6)), lookat=list(place(0, 0, 0.6)))
    yield Case("fog, on and off", made, samples=4096)


def case_111(_):
    """A furnace: all surfaces have the radiance that they are lit by."""
    radiance = (1.0, 0.5, 0.25)
    balanced = {"type": "lambertian", "albedo": list(ALBEDO), "emit": [b * (1 - a) for a, b in zip(ALBEDO, radiance)]}
    made = document({"wall": balanced, "lamp": lamp(radiance), "glass": glass()}, [sphere((0.5, 0.6, -0.4), 0.7, "wall")],
                    (0.2, -0.6, 1.4), (0.9, 0.5, -1.9), depth=200)
    made["boxes"] = [{"corners": [[-2, -2, -2], [2, 2, 2]], "material": "wall"},
                     {"corners": [[-1.5, -1.5, -1], [-0.7, -0.8, 0]], "rotate": [10, 20, 30], "material": "wall"},
                     {"corners": [[0.9, -1.5, 0.3], [1.5, -0.8, 0.9]], "material": "glass"}]
    made["quads"] = [quad((-1, 1.9, -1), (0.7, 0, 0), (0, 0, 0.9))]
    yield Case("furnace of triangles", made, radiance, samples=512)


def case_112(_):
    """Corners of quads that emit stand on a floor, at whose edge it is lit by half of the sky."""
    floor = quad(place(-2, -2, 0), scale(4, TANGENT), scale(4, SIDEWAYS), "receiver")
    for away in (0.3, 1e-2, 1e-3, 1e-4, 2e-5, 1e-6):
        for name, sides in (("", (scale(2, SIDEWAYS), scale(2, POINT_NORMAL))), (", turned", (scale(2, POINT_NORMAL), scale(2, SIDEWAYS)))):
            wall = quad(place(away, -1, 0), *sides)
            made = under([wall, floor])
            del made["spheres"]
            yield Case(f"{away} from the foot of a wall{name}", made, lit(share_of(quad_corners(wall))), deep=away in (1e-2, 1e-3, 2e-5),
                       rounding=1e-4)


NUMBERED = {int(name[5:]): function for name, function in sorted(globals().items()) if name.startswith("case_")}
