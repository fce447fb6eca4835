#!/usr/bin/env python3
"""Media in boxes, meshes and capsules, through the program: closed forms, aimed rays, the rule for nested ones, refusals.

usage: test_body_media.py PROGRAM SOURCE_DIR [--deep | CASE...]

As test_media.py: rays go through the centres of pixels, so how long each is in a body is known (body_scenes.py), and an
absorbing medium leaves exp(-density * length) of a white sky, without noise.
"""
import itertools
import json
import math
import os
import random
import subprocess
import sys
import tempfile

from body_scenes import add, box, box_stretch, comb, crossings_length, depth_along, off, pillow, scale, star, turned
from pfm import read_pfm
from program_cases import PROGRAM, effects, picture, run, run_cases, told_apart, with_file

SIDE = 16
MATERIALS = {"edge": {"type": "interface"}, "glass": {"type": "dielectric", "refraction_index": 1.5, "fresnel": "none"},
             "matched": {"type": "dielectric", "refraction_index": 1}, "matte": {"type": "lambertian", "albedo": [0.8, 0.6, 0.4]},
             "lamp": {"type": "diffuse_light", "emit": [9, 8, 7]}}
MEDIA = {"a": {"absorption": 1}, "b": {"absorption": 0.3}, "c": {"absorption": 2.5}, "fog": {"absorption": 0.1}}
DENSITIES = {"a": 1, "b": 0.3, "c": 2.5, "fog": 0.1}


def scene(media=None, span=1.0, depth=40, side=SIDE, camera=None, **members):
    camera = {"image_width": side, "max_depth": depth, "pixel_sampling": "center", "projection": "orthographic",
              "view_height": span, "lookfrom": [0, 0, 10], "lookat": [0, 0, 0], **(camera or {})}
    if camera["projection"] == "perspective":
        del camera["view_height"]
    return {"camera": camera, "background": [1, 1, 1], "media": MEDIA if media is None else media, "materials": MATERIALS, **members}


def pinhole(**members):
    return {"projection": "perspective", "vfov": 40, **members}


def ball(center, radius, interior=None, material="edge", **members):
    return {"center": list(center), "radius": radius, "material": material, **({"interior": interior} if interior else {}), **members}


def capsule(a, b, radius, interior=None, material="edge"):
    return {"ends": [list(a), list(b)], "radius": radius, "material": material, **({"interior": interior} if interior else {})}


def rays(document):
    """Of the centres of its pixels, row by row, the lowest first, as in a PFM file."""
    camera = document["camera"]
    side, eye = camera["image_width"], camera["lookfrom"]
    back = scale(1 / math.dist(eye, camera["lookat"]), add(eye, scale(-1, camera["lookat"])))
    up = camera.get("vup", [0, 1, 0])
    right = [up[1] * back[2] - up[2] * back[1], up[2] * back[0] - up[0] * back[2], up[0] * back[1] - up[1] * back[0]]
    right = scale(1 / math.hypot(*right), right)
    up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]]
    parallel = camera["projection"] == "orthographic"
    height = camera["view_height"] if parallel else 2 * math.tan(math.radians(camera["vfov"] / 2))
    for row in range(side):
        for column in range(side):
            aside = add(scale(height * ((column + 0.5) / side - 0.5), right), scale(height * ((row + 0.5) / side - 0.5), up))
            yield (add(eye, aside), scale(-1, back)) if parallel else (eye, add(aside, scale(-1, back)))


def values(document, *options, files=None):
    """Red of each pixel; `files`: text by name, beside the scene."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {"x.json": json.dumps(document), **(files or {})}.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        data = run("render", os.path.join(folder, "x.json"), "-o", "-", "--format", "pfm", "--quiet", "--spp", "1", *options).stdout
    return read_pfm(data)[2][0::3]


def compare(document, lengths, what, *options, files=None, allowed=1e-3, sky=1.0):
    """Pixels are exp(-length), to a thousandth. Lengths may be numbers or None where a ray is too close to a rim to tell."""
    found, count = values(document, *options, files=files), 0
    for i, (value, length) in enumerate(zip(found, lengths)):
        if length is None:
            continue
        wanted = sky * math.exp(-length)
        assert abs(value - wanted) <= allowed * wanted + 1e-30, f"{what}, pixel {i}: {value} instead of {wanted}, {math.log(wanted / max(value, 1e-37))} off"
        count += 1
    return count


def of_shapes(shapes, densities, document, around=None):
    return [depth_along(shapes, densities, o, d, around) for o, d in rays(document)]


def by_list(shapes):
    return {"spheres": [s for s in shapes if "center" in s], "boxes": [s for s in shapes if "corners" in s],
            "capsules": [s for s in shapes if "ends" in s]}


def chords():
    """A box turned about all axes, from beside and from near, from 1e-4 to 30 mean free paths thick, small, large and far away."""
    count = 0
    each = box((-0.5, -0.4, -0.6), (0.5, 0.4, 0.6), "m", rotate=[20, 35, 10])
    for density in (1e-4, 0.1, 1, 30):
        media = {"m": {"absorption": [density, 0, 0]}}
        for camera in ({}, pinhole(lookfrom=[0.3, 0.8, 1.9])):
            document = scene(media, 1.9, camera=camera, boxes=[each])
            count += compare(document, of_shapes([each], {"m": density}, document), f"density {density}")
    for size, far in ((1e-3, 0), (1e3, 0), (1, 1000)):
        moved = box(*(scale(size, c) for c in each["corners"]), "m", rotate=[20, 35, 10], translate=[far, -far, 0])
        document = scene({"m": {"absorption": [1 / size, 0, 0]}}, camera=pinhole(lookfrom=[0.3 * size + far, 0.8 * size - far, 1.9 * size], lookat=[far, -far, 0]),
                         boxes=[moved])
        count += compare(document, of_shapes([moved], {"m": 1 / size}, document), f"size {size}, {far} away")
    return f"{count} chords within 0.1 %"


def quads_and_triangles():
    """Six quads, and twelve triangles, are a box."""
    each = box((-0.5, -0.4, -0.6), (0.5, 0.4, 0.6), "a")
    (x, y, z), (u, v, w) = each["corners"]
    u, v, w = u - x, v - y, w - z
    sides = [([x, y, z], [0, v, 0], [u, 0, 0]), ([x, y, z + w], [u, 0, 0], [0, v, 0]), ([x, y, z], [u, 0, 0], [0, 0, w]),
             ([x, y + v, z], [0, 0, w], [u, 0, 0]), ([x, y, z], [0, 0, w], [0, v, 0]), ([x + u, y, z], [0, v, 0], [0, 0, w])]
    quads = [{"corner": c, "u": a, "v": b, "material": "edge", "interior": "a"} for c, a, b in sides]
    view = {"lookfrom": [1, 2, 4]}
    lengths = of_shapes([each], DENSITIES, scene(camera=view, span=2.2))
    compare(scene(camera=view, span=2.2, quads=quads), lengths, "quads")
    triangles = [{"vertices": [c, add(c, a), add(add(c, a), b)], "material": "edge", "interior": "a"} for c, a, b in sides]
    triangles += [{"vertices": [c, add(add(c, a), b), add(c, b)], "material": "edge", "interior": "a"} for c, a, b in sides]
    compare(scene(camera=view, span=2.2, triangles=triangles), lengths, "triangles")
    turned_around = [{**t, "vertices": t["vertices"][::-1]} for t in triangles]
    compare(scene(camera=view, span=2.2, triangles=turned_around), lengths, "triangles that run the other way")
    return "one body"


def concave():
    """Meshes whose rays enter and leave several times, from outside and from between."""
    count, most = 0, 0
    for name, (points, faces), views in (
            ("star", star(), ({"lookfrom": [4, 1, 2]}, {"lookfrom": [0.3, 5, 0.4]}, pinhole(lookfrom=[0, 0, 0], lookat=[1, 0.2, 0.1]),
                              pinhole(lookfrom=[0.6, 0.02, 0.3], lookat=[-1, 0.1, 0]), pinhole(lookfrom=[-0.6, 0.02, 0.3], lookat=[1, 0.1, 0]))),
            ("comb", comb(), ({"lookfrom": [6, 0.9, 0.3]}, {"lookfrom": [5, 0, 0]}, pinhole(lookfrom=[-0.3, 0.2, 0], lookat=[1, 0.1, 0.2]),
                              pinhole(lookfrom=[-0.2, 0.2, 0], lookat=[1, 0.1, 0.2])))):
        for view in views:
            document = scene(camera=view, span=1.3, meshes=[{"file": "x.off", "material": "edge", "interior": "a"}])
            lengths = []
            for o, d in rays(document):
                length = crossings_length(points, faces, o, d) * math.hypot(*d)
                # Rays that pass an edge of the surface so closely that either is right.
                beside = [crossings_length(points, faces, o, add(d, [e * 1e-6 for e in aside])) * math.hypot(*d) for aside in ((1, 1, 0), (-1, 0, 1), (0, -1, -1))]
                near = max(abs(other - length) for other in beside) > 1e-4
                lengths.append(None if near else length)
            count += compare(document, lengths, name, files={"x.off": off(points, faces)})
            most = max(most, max(length or 0 for length in lengths))
    return f"{count} rays"


def aimed(document, lengths, what, files, *options):
    return compare(document, lengths, what, *options, files=files, allowed=2e-3)


def edges_and_vertices():
    """Every ray goes through vertices or edges of a bumpy body on both sides, along the axes, aslant, and from a point."""
    side, count = 240, 0
    points, faces, apart = pillow(side, 20.0, 1)
    media = {"m": {"absorption": 0.05}}
    mesh = {"file": "x.off", "material": "edge", "interior": "m"}
    files = {"x.off": off(points, faces)}
    middle = (side - 1) / 2
    for shift in ((0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)):
        # The ray of pixel (i, j from below) goes through (i, j) + shift.
        lengths = []
        for row, column in itertools.product(range(side), range(side)):
            i, j = column, row
            k, m = i + (shift[0] > 0), j + (shift[1] > 0)
            if max(k, m) >= side:
                lengths.append(0.0 if shift == (0, 0) else None)
                continue
            lengths.append(0.05 * 0.5 * (apart[i, j] + apart[k, m]))
            if i in (0, side - 1) or j in (0, side - 1) or k in (0, side - 1) or m in (0, side - 1):
                lengths[-1] = None  # the rim itself
        place = [-middle - shift[0], -middle - shift[1], 0]
        for degrees in ([0, 0, 0], [25, 40, 70]):
            view = {"lookfrom": turned(degrees, [0, 0, 100]), "vup": turned(degrees, [0, 1, 0])}
            # Placed by hand, since the grammar turns first.
            set_up = [{**mesh, "rotate": degrees, "translate": turned(degrees, place)}]
            count += aimed(scene(media, side, camera=view, side=side, meshes=set_up), lengths, f"by {shift}, turned by {degrees}", files)
    eye = 400.0
    for name, aside in (("vertices", 0.0), ("edges", 0.5)):
        # From a point: vertices along the rays through the centres of pixels; edges half-way between.
        moved = [[(x - middle - aside) * (eye - z) / eye, (y - middle) * (eye - z) / eye, z] for x, y, z in points]
        wide = {"projection": "perspective", "vfov": 2 * math.degrees(math.atan(side / 2 / eye)), "lookfrom": [0, 0, eye], "lookat": [0, 0, 0]}
        lengths = []
        for row, column in itertools.product(range(side), range(side)):
            i, j, k = column, row, column + (aside > 0)
            inner = 0 < i and k < side - 1 and 0 < j < side - 1
            slope = math.hypot(1, (i - middle) / eye, (j - middle) / eye) if not aside else 0
            lengths.append(0.05 * slope * apart[i, j] if inner and not aside else None)
        if aside:
            # The two ends of an edge at other heights: where the middle of the pixel's ray crosses it.
            def crossing(a, b, ray):
                # In the plane of the ray's row through the eye: x and depth.
                (ax, az), (bx, bz) = ((p[0], eye - p[2]) for p in (a, b))
                s = ray / eye
                t = (s * az - ax) / ((bx - ax) - s * (bz - az))
                return az + t * (bz - az)
            front = {}
            for index, (x, y, z) in enumerate(points):
                front.setdefault((int(x), int(y)), []).append(index)
            for row, column in itertools.product(range(side), range(side)):
                i, j = column, row
                if not (0 < i < side - 2 and 0 < j < side - 1):
                    continue
                ray = i - middle
                depths = [crossing(moved[front[i, j][s]], moved[front[i + 1, j][s]], ray) for s in (0, 1)]
                lengths[row * side + column] = 0.05 * abs(depths[1] - depths[0]) * math.hypot(1, ray / eye, (j - middle) / eye)
        count += aimed(scene(media, camera=wide, side=side, meshes=[mesh]), lengths, f"{name} from a point", {"x.off": off(moved, faces)})
    return f"{count} rays, none wrong"


def glass_of_little_index():
    """Rays through the vertices of a bumpy body of glass that bends them little or not at all go on to the sky, none round and round."""
    side, count = 240, 0
    points, faces, _ = pillow(side, 20.0, 1)
    middle = (side - 1) / 2
    for name, glass in (("1", MATERIALS["matched"]), ("1.001", {"type": "dielectric", "refraction_index": 1.001, "fresnel": "none"})):
        mesh = {"file": "x.off", "material": "clear", "translate": [-middle, -middle, 0]}
        document = scene({}, side, camera={"lookfrom": [0, 0, 100]}, side=side, meshes=[mesh])
        document["materials"] = {"clear": glass}
        count += compare(document, [0.0] * side ** 2, f"glass of index {name}", files={"x.off": off(points, faces)})
    return f"{count} rays, none lost"


def nested_and_overlapping():
    """The boundary of least volume around a point decides, of equal ones the first kind; without an interior it is clear."""
    outer = box((-1, -1, -1), (1, 1, 1), "a", rotate=[10, 20, 30])
    cases = {
        "a ball in a box": [outer, ball((0.1, 0, 0.2), 0.5, "b")],
        "a box in a ball": [ball((0, 0, 0), 1.3, "a"), box((-0.4, -0.3, -0.5), (0.5, 0.4, 0.3), "c", rotate=[40, 10, 0])],
        "boxes that overlap": [box((-1, -1, -1), (0.3, 0.5, 0.6), "a"), box((-0.2, -0.4, -0.5), (1, 1, 1.1), "b", rotate=[0, 15, 5])],
        "a box and a ball that overlap": [box((-1, -0.8, -0.9), (0.4, 0.5, 0.6), "c"), ball((0.5, 0.2, 0.1), 0.7, "b")],
        "a large ball and a box that overlap": [box((-0.6, -0.5, -0.6), (0.4, 0.5, 0.6), "c"), ball((0.5, 0.2, 0.1), 0.9, "b")],
        "a capsule, a box and a ball": [outer, capsule((-1.2, 0, 0.1), (0.9, 0.5, 0), 0.4, "b"), ball((0.2, 0.2, 0), 0.6, "c")],
        "a capsule in a box in a ball": [ball((0, 0, 0), 1.9, "b"), outer, capsule((-0.3, -0.2, 0), (0.4, 0.3, 0.1), 0.3, "c")],
        "a clear box": [ball((0, 0, 0), 1.3, "a"), box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), rotate=[5, 6, 7])],
        "a clear ball in a box": [outer, ball((0, 0.1, 0), 0.6)],
        "a clear capsule in a box": [outer, capsule((-0.5, 0, 0), (0.4, 0.3, 0.2), 0.3)],
    }
    count = 0
    for name, shapes in cases.items():
        for camera in ({"lookfrom": [3, 4, 9]}, pinhole(lookfrom=[0.15, 0.1, 0.25], lookat=[1, 2, -3]), pinhole(lookfrom=[0, 0, 4])):
            document = scene(camera=camera, span=2.6, **by_list(shapes))
            count += compare(document, of_shapes(shapes, DENSITIES, document), name)
    # In fog without end, before a lamp all around.
    lamp = ball((0, 0, 0), 30, None, "lamp")
    for name, shapes in cases.items():
        document = scene(camera=pinhole(lookfrom=[0.5, 0.2, 3]), span=2.6, medium="fog", **by_list([*shapes, lamp]))
        lengths = list(fog_lengths(shapes, document))
        count += compare(document, lengths, f"{name}, in fog", sky=9)
    # Of the same volume: spheres before boxes, boxes before capsules, and what stands first.
    cube, other = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), "a"), box((-0.515625, -0.515625, -0.25), (0.484375, 0.484375, 0.75), "b")
    view = scene(camera=pinhole(lookfrom=[0.1, 0, 4], lookat=[0.1, 0, 0], vfov=0.01))
    for boxes, wanted in (([cube, other], 1 + 0.25 * 0.3), ([other, cube], 0.3 + 0.25)):
        count += compare({**view, "boxes": boxes}, [wanted] * SIDE * SIDE, "two of one size")
    return f"{count} rays"


def fog_lengths(shapes, document):
    """Up to a ball of radius 30 around the middle."""
    wall = ball((0, 0, 0), 30)
    for o, d in rays(document):
        to_wall = depth_along([{**wall, "interior": "one"}], {"one": 1}, o, d)
        inside = depth_along(shapes, DENSITIES, o, d)
        in_shapes = depth_along([{**s, "interior": "one"} for s in shapes], {"one": 1}, o, d)
        yield inside + 0.1 * (to_wall - in_shapes)


def camera_inside():
    """In a box, in a hole of one, in the wall of a hollow one, and in boxes that overlap."""
    thick = box((-1, -1, -1), (1, 1, 1), "a", rotate=[10, 20, 30])
    hole = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), None)
    count = 0
    for shapes in ([thick], [thick, hole], [thick, box((0.2, -0.2, -0.2), (1.7, 0.4, 0.5), "c")]):
        for eye in ((0, 0, 0), (0.8, 0.05, 0.1), (0.3, 0.1, 0.2), (1.4, 0.1, 0.1), (0, 0, 5), (0.9, -0.9, 0.3)):
            document = scene(camera=pinhole(lookfrom=list(eye), lookat=add(eye, (0.3, 0.5, -1))), **by_list(shapes))
            count += compare(document, of_shapes(shapes, DENSITIES, document), f"from {eye}")
    # A mesh with a hole: its inner surface runs the other way.
    outside = [[x, y, z] for x, y, z in itertools.product((-1, 1), repeat=3)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [[a, b, c] for q in quads for a, b, c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    points = [scale(1.0, p) for p in outside] + [scale(0.5, p) for p in outside]
    faces += [[a + 8, c + 8, b + 8] for a, b, c in faces]
    for eye in ((0.1, 0.2, 0), (0.7, 0.1, 0.2), (0, 0.1, 4)):
        document = scene(camera=pinhole(lookfrom=list(eye), lookat=add(eye, (0.3, 0.5, -1))), meshes=[{"file": "x.off", "material": "edge", "interior": "a"}])
        lengths = [crossings_length(points, faces, o, d) * math.hypot(*d) for o, d in rays(document)]
        assert max(lengths) > 0.4
        count += compare(document, lengths, f"hollow, from {eye}", files={"x.off": off(points, faces)})
        turned_faces = [[a, c, b] for a, b, c in faces]
        compare(document, lengths, f"hollow, turned inside out, from {eye}", files={"x.off": off(points, turned_faces)})
    # Beside the surface by a hair, on either side, and far from the origin.
    for off_by in (1e-7, 1e-4):
        for sign, length in ((-1, 1.0), (1, 0.0)):
            eye = [7000.25, 0.5 + sign * off_by, 0.1]
            shapes = [box((7000 - 0.5, -0.5, -0.5), (7000.5, 0.5, 0.5), "a")]
            document = scene(camera={**pinhole(lookfrom=eye, lookat=add(eye, (0, -1, 0)), vup=[0, 0, 1], vfov=0.001)}, **by_list(shapes))
            compare(document, [1.0] * SIDE * SIDE, f"{off_by} {sign}", allowed=2e-3)
            document["camera"]["lookat"] = add(eye, (0, 1, 0))
            compare(document, [0.0] * SIDE * SIDE, f"{off_by} {sign} away", allowed=2e-3)
    return f"{count} rays"


def furnace():
    """What only scatters, before and around it all the same light, shows exactly that light."""
    for material in ("edge", "matched", "glass"):
        for shapes in ({"boxes": [box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), "m", material, rotate=[20, 30, 40])]},
                       {"capsules": [capsule((-0.3, 0, 0), (0.3, 0.2, 0), 0.25, "m", material)]}):
            document = scene({"m": {"scattering": 8, "anisotropy": -0.5}}, 1.2, 20000, **shapes)
            found = values(document, "--spp", "4")
            assert all(v == 1 for v in found), (material, min(found), max(found))
    inside = scene({"m": {"scattering": 5}}, depth=20000, camera=pinhole(lookfrom=[0.1, 0.1, 0.1]), boxes=[box((-1, -1, -1), (1, 1, 1), "m")])
    assert all(v == 1 for v in values(inside, "--spp", "4"))
    return "exactly the sky"


def beer_in_glass():
    """Straight through glass that does not bend light, and through a slab of glass that does."""
    for material, view in (("matched", {"lookfrom": [1, 2, 4]}), ("glass", {})):
        shapes = [box((-2, -2, -0.3), (2, 2, 0.3), "a", material)]
        document = scene(camera=view, span=1.0, boxes=shapes)
        compare(document, of_shapes(shapes, DENSITIES, document), material)
    return "tinted"


def behind():
    """A small lamp behind a box, a mesh or a capsule lights a floor by exp(-density * length), by rays and by chance."""
    place, radius = (1.5, 4, 0.5), 0.02
    away = math.hypot(*place)
    direction = scale(1 / away, place)
    lamp = ball(place, radius, None, "lamp")
    ground = {"corner": [-3, 0, -3], "u": [0, 0, 6], "v": [6, 0, 0], "material": "matte"}
    camera = pinhole(lookfrom=[-0.5, 0.3, -0.25], lookat=[0, 0, 0], vfov=0.05, max_depth=12)
    bright = {**MATERIALS, "lamp": {"type": "diffuse_light", "emit": [2e4, 2e4, 2e4]}}
    points, faces = star()
    up, around = box((-1, 1, -1), (1, 1.7, 1), "a", rotate=[7, 8, 9]), box((1, 3, 0), (2, 4.9, 1.2), "a")
    inner, rod = ball(scale(1.45, direction), 0.2, "c"), capsule((0, 1.3, 0), (1, 2.2, 0.3), 0.4, "c")
    hall, near = box((-4, -0.5, -4), (4, 1.2, 4), "b"), ball(scale(0.6, direction), 0.2, "c")
    # What the middle of the lamp, as it is seen, has of a box around it.
    begin, _ = box_stretch(around, (0, 0, 0), direction)
    star_at = (0.7, 2, 0.2)
    cases = {"nothing": ({}, 0.0), "a box": ({"boxes": [up]}, depth_along([up], DENSITIES, (0, 0, 0), direction)),
             "the lamp in a box": ({"boxes": [around]}, away - radius * 2 / 3 - begin),
             "a mesh": ({"meshes": [{"file": "x.off", "material": "edge", "interior": "c", "translate": list(star_at)}]},
                        2.5 * crossings_length([add(p, star_at) for p in points], faces, (0, 0, 0), direction)),
             "a capsule": ({"capsules": [rod]}, depth_along([rod], DENSITIES, (0, 0, 0), direction)),
             "out of a box, past a ball": ({"boxes": [hall], "spheres": [near]},
                                           depth_along([hall, near], DENSITIES, (0, 0, 0), direction) + 0.3 * math.dist((0, 0, 0), camera["lookfrom"])),
             "a box and a ball in it": ({"boxes": [up], "spheres": [inner]}, depth_along([up, inner], DENSITIES, (0, 0, 0), direction))}
    found = {}
    for name, (members, length) in cases.items():
        members = {"quads": [ground], **members, "spheres": [lamp, *members.get("spheres", [])]}
        document = {**scene(camera=camera, **members), "materials": bright, "background": [0, 0, 0]}
        numbers = values(document, "--spp", "256", files={"x.off": off(points, faces)})
        found[name] = sum(numbers) / len(numbers)
        left = found[name] / found["nothing"]
        assert abs(left / math.exp(-length) - 1) < 2e-3, (name, left, math.exp(-length))
    return ", ".join(f"{name} {value / found['nothing']:.4f}" for name, value in found.items())


MIXED = {**scene({"smoke": {"absorption": 0.5, "scattering": 2, "anisotropy": 0.4}, "ink": {"absorption": [0, 1, 3], "scattering": [3, 2, 1]},
                  "fog": {"scattering": 0.1}}, 3, 14, camera={"pixel_sampling": "square", "lookfrom": [2, 3, 9]}, medium="fog"),
         "spheres": [ball((0, -101, 0), 100, None, "matte"), ball((0.6, 0, 0.3), 0.5, "ink"), ball((0, 1.3, 0), 0.3, None, "lamp")],
         "boxes": [box((-0.9, -0.9, -0.5), (0.1, 0.2, 0.5), "smoke", rotate=[0, 20, 0]), box((0.2, -0.6, -0.7), (1.2, 0.3, 0.3), "ink", "glass", rotate=[10, 0, 3]),
                   box((-0.3, 0.4, -0.3), (0.3, 1.0, 0.3), None, "edge", rotate=[1, 2, 3])],
         "capsules": [capsule((-1, 0.5, 0), (-0.2, 0.9, 0.2), 0.2, "smoke", "matched")]}


def forms():
    smoke = {**{member: MIXED[member] for member in MIXED if member != "medium"}, "background": [0.9, 0.8, 0.7]}
    few = {**smoke, "boxes": smoke["boxes"][:1]}  # few enough for a list
    for precision in ("single", "double"):
        for document in (MIXED, smoke, few):
            everything = precision == "single" and document is smoke
            first = picture(document, "--spp", "8", "--precision", precision)
            for options in (["--kernel", "sample"], ["--kernel", "pool"], *([["--effects", "all"]] if everything else [])):
                assert picture(document, "--spp", "8", "--precision", precision, *options) == first, options
    return "the same bits"


def lamps():
    """Light found by rays to lamps, and by chance, is the same."""
    for medium in ({}, {"medium": "fog"}):
        document = {**{m: MIXED[m] for m in MIXED if m != "medium"}, **medium, "background": [0.1, 0.1, 0.1]}
        means = []
        for options in ([], ["--light-sampling", "off"]):
            numbers = read_pfm(picture(document, "--spp", "4096", *options))[2]
            means.append([sum(numbers[c::3]) / (SIDE * SIDE) for c in range(3)])
        for on, out in zip(*means):
            assert abs(on / out - 1) < 0.012, (medium, means)
    return f"on and off: {means}"


def single_scattering():
    """From the middle of a cube before an even sky: what is scattered once, against quadrature."""
    camera = pinhole(lookfrom=[0, 0, 0], lookat=[0.2, 0.3, -1], vfov=1)
    each = box((-1, -1, -1), (1, 1, 1), "m")
    density, g = 0.8, 0.5
    document = scene({"m": {"scattering": density, "anisotropy": g}}, 1, 3, camera=camera, boxes=[each])
    numbers = values(document, "--spp", "4096")
    found = sum(numbers) / len(numbers)
    ahead = scale(1 / math.hypot(0.2, 0.3, 1), (0.2, 0.3, -1))
    end, once, chance = depth_along([each], {"m": 1}, (0, 0, 0), ahead), 0.0, random.Random(3)
    steps = 40000
    for i in range(steps):
        s = (i + 0.5) / steps * end
        z, turn = 2 * chance.random() - 1, 2 * math.pi * chance.random()
        away = [math.sqrt(1 - z * z) * math.cos(turn), math.sqrt(1 - z * z) * math.sin(turn), z]
        mu = sum(a * b for a, b in zip(ahead, away))
        way = depth_along([each], {"m": 1}, scale(s, ahead), away)
        once += density * math.exp(-density * (s + way)) * (1 - g * g) / (1 + g * g - 2 * g * mu) ** 1.5 * end / steps
    wanted = math.exp(-density * end) + once
    assert abs(found / wanted - 1) < 0.012, (found, wanted)
    return f"{found:.4f}, by quadrature {wanted:.4f}"


def unseen_light():
    """What the pilot's paths from a tiny lamp lose in a box around it: between what they lose in the balls inside and around that."""
    side, materials = 0.6, {**MATERIALS, "bright": {"type": "diffuse_light", "emit": [9000] * 3}, "thick": {"type": "dielectric", "refraction_index": 1.5}}
    common = [ball((0, -100, 0), 100, None, "matte"), ball((0.5, 1, 0), 0.5, None, "thick"), ball((0, 2.5, 0), 0.02, None, "bright")]
    found = []
    for around in (ball((0, 2.5, 0), side, "c"), box((-side, 2.5 - side, -side), (side, 2.5 + side, side), "c"), ball((0, 2.5, 0), side * math.sqrt(3), "c")):
        members = by_list([*common, around])
        members["boxes"] = members["boxes"] or [box((50, 50, 50), (51, 51, 51), None, "matte")]  # so that caustics are left to chance
        document = {**scene(camera=pinhole(lookfrom=[0, 2, 6], lookat=[0, 0.8, 0], max_depth=20), side=32, **members), "materials": materials, "background": [0, 0, 0]}
        with tempfile.TemporaryDirectory() as folder:
            stats = os.path.join(folder, "stats.json")
            with_file(document, lambda path, stats=stats: run("render", path, "-o", "-", "--format", "pfm", "--quiet", "--spp", "16", "--stats", stats))
            with open(stats, encoding="utf-8") as file:
                found.append(json.load(file)["unseen"]["mean"])
    assert found[0] > 1.05 * found[1] and found[1] > 1.05 * found[2], found
    return f"{found[1]:.3g}, between {found[2]:.3g} and {found[0]:.3g}"


def said_of(document, files=None):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {"x.json": json.dumps(document), **(files or {})}.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        done = subprocess.run([PROGRAM, "render", os.path.join(folder, "x.json"), "-o", os.path.join(folder, "x.pfm")], capture_output=True, check=False)
    assert done.returncode == 2, (done.returncode, document)
    return " ".join(done.stderr.decode().split())


def documents():
    written = with_file(MIXED, lambda path: run("scene", path).stdout.decode())
    again = json.loads(written)
    assert [t.get("interior") for t in again["triangles"]] == ["smoke"] * 12 + ["ink"] * 12 + [None] * 12, again["triangles"]
    assert again["capsules"][0]["interior"] == "smoke"
    assert picture(written, "--spp", "2") == picture(MIXED, "--spp", "2")
    points, faces = star()
    mesh = {"file": "x.off", "material": "edge", "interior": "a"}
    one = scene(boxes=[box((-1, -1, -1), (1, 1, 1), "a")])
    plane = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "material": "edge", "interior": "a"}
    half = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    solid = [{**plane, "vertices": [half[i] for i in f]} for f in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))]
    row = [box((2 * i, 0, 0), (2 * i + 1, 1, 1), "a") for i in range(33)]
    refused = [
        (scene(boxes=[box((-1, -1, -1), (1, 1, 1), "a", "matte")]), {}, ["boxes[0].interior", "in a triangle whose material is of type \"lambertian\"", "interface"]),
        (scene(boxes=[box((-1, -1, -1), (1, 1, 1), "x")]), {}, ['boxes[0].interior: found the medium "x"']),
        (scene(capsules=[capsule((0, 0, 0), (1, 0, 0), 0.2, "a", "matte")]), {}, ["capsules[0].interior", "in a capsule whose material"]),
        (scene(triangles=[plane]), {}, ["triangles[0]", "open edge", "(0, 0, 0)"]),
        (scene(triangles=solid[1:]), {}, ["triangles[2]", "open edge, from (0, 0, 0) to (0, 1, 0)"]),
        (scene(triangles=[*solid[:3], {**solid[3], "vertices": solid[3]["vertices"][::-1]}]), {}, ["triangles[", "open edge", "reverse its vertices"]),
        (scene(triangles=[*solid[:3], {**solid[3], "interior": "b"}]), {}, ["triangles[", "open edge", "one interior"]),
        (scene(meshes=[mesh]), {"x.off": off(points, faces[1:])}, ['meshes[0].file', 'the material "edge" lets light in, but the edge from vertex', "is open"]),
        (scene(meshes=[mesh]), {"x.off": off(points, [faces[0][::-1], *faces[1:]])}, ['the material "edge" lets light in, but the edge from vertex']),
        (scene(meshes=[{**mesh, "material": "matte"}]), {"x.off": off(points, faces)}, ["found an interior, but no material of the mesh lets light in"]),
        (scene(meshes=[{**mesh, "interior": "x"}]), {"x.off": off(points, faces)}, ['meshes[0].interior: found the medium "x"']),
        (scene(boxes=row), {}, ["boxes[32]", "found 33 boxes", "at most 32"]),
        ({**one, "camera": {**one["camera"], "lookfrom": [0.8, 0, 0.9], "lookat": [0.8, 0, 0]}}, {}, ["found the plane of the camera cut by boxes[0]"]),
        ({**one, "camera": {"image_width": 8, "vfov": 40, "lookfrom": [0, 0, 1.1], "lookat": [1, 0, 1.1], "aperture": 0.4, "focus_dist": 3}}, {},
         ["found the lens of the camera cut by boxes[0]"]),
        (scene(boxes=[box((-1, -1, -1), (1, 1, 1), "a")], quads=[{"corner": [-3, -1, -3], "u": [0, 0, 6], "v": [6, 0, 0], "material": "matte"}]), {},
         ["boxes[0]", "in one plane", "move one by a millionth"]),
    ]
    for document, files, says in refused:
        said = said_of(document, files)
        assert all(s in said for s in says), (says, said)
    # A lens inside, and one beside; 33 boxes without media, and 32 with.
    for eye in ([0, 0, 0.5], [0, 0, 1.3]):
        fine = {**one, "camera": {"image_width": 8, "vfov": 40, "lookfrom": eye, "lookat": [1, 0, eye[2]], "aperture": 0.4, "focus_dist": 3}}
        picture(fine, "--spp", "1")
    picture(scene(boxes=row[:32]), "--spp", "1")
    # Glass and media may stand side by side.
    picture(scene(spheres=[ball((0, 3, 0), 0.5, "a")], boxes=[box((-1, -1, -1), (1, 1, 1), None, "glass")]), "--spp", "1")
    return f"read, written, {len(refused)} refused"


def films():
    base = scene(boxes=[box((-1, -1, -1), (1, 1, 1), "a")], capsules=[capsule((3, 0, 0), (4, 0, 0), 0.2, "a")])
    others = [json.loads(json.dumps(base)) for _ in range(4)]
    others[0]["boxes"][0]["interior"] = "b"
    others[1]["capsules"][0]["interior"] = "b"
    del others[2]["boxes"][0]["interior"]
    del others[3]["capsules"][0]["interior"]
    return told_apart(base, others)


def explained():
    said = effects(MIXED)
    assert "media in 4 shapes with a medium inside" in said, said
    assert "body_media in light passes into 3 bodies of triangles and 1 capsule" in said, said
    spheres = effects(scene(spheres=[ball((0, 0, 0), 1, "a")], boxes=[box((2, 2, 2), (3, 3, 3), None, "matte")]))
    assert "body_media out light passes into spheres alone" in spheres, spheres
    glass = effects({**scene(boxes=[box((2, 2, 2), (3, 3, 3), None, "glass")]), "media": {}})
    assert "body_media out there are no media" in glass, glass
    return "in and out"


CASES = [chords, quads_and_triangles, concave, nested_and_overlapping, camera_inside, documents, films, explained]
DEEP_CASES = [edges_and_vertices, glass_of_little_index, furnace, beer_in_glass, behind, single_scattering, unseen_light, forms, lamps]
sys.exit(run_cases(CASES, DEEP_CASES))
