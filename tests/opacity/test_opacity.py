#!/usr/bin/env python3
"""Opacity of materials, through the program: closed forms, what a picture's alpha and shadows say, refusals.

usage: test_opacity.py PROGRAM SOURCE_DIR [--deep | CASE...]

A path passes a surface of opacity o with the probability 1 - o, so what shines through n of them is (1 - o)^n of it. Means are
compared within 5 standard deviations of what independent samples would give.
"""
import math
import re
import subprocess
import sys

import exr
from pfm import read_pfm
from program_cases import PROGRAM, effects, picture, run, run_cases, told_apart, with_file

SIDE, SAMPLES = 16, 256
BLACK = {"type": "lambertian", "albedo": [0, 0, 0]}
SHINE = {"type": "diffuse_light", "emit": [1, 1, 1]}


def scene(depth=20, span=1.0, lookfrom=(0, 0, 10), lookat=(0, 0, 0), materials=None, **members):
    camera = {"image_width": SIDE, "max_depth": depth, "projection": "orthographic", "view_height": span, "lookfrom": list(lookfrom),
              "lookat": list(lookat), "vup": [0, 1, 0.01]}
    known = {"black": BLACK, "shine": SHINE, **(materials or {})}
    return {"camera": camera, "background": [0, 0, 0], "materials": known, **members}


def wall(z, material, half=5.0):
    return {"corner": [-half, -half, z], "u": [2 * half, 0, 0], "v": [0, 2 * half, 0], "material": material}


def ball(center, radius, material):
    return {"center": list(center), "radius": radius, "material": material}


def mean(document, *options):
    numbers = read_pfm(picture(document, "--spp", str(SAMPLES), *options))[2]
    return sum(numbers) / len(numbers)


def close(found, expected, what, scale=1.0):
    """Of samples that are `scale` or 0."""
    share = expected / scale
    allowed = 5 * scale * math.sqrt(max(share * (1 - share), 0) / (SIDE * SIDE * SAMPLES)) + 1e-6 * scale
    assert abs(found - expected) <= allowed, f"{what}: found {found:.6f}, expected {expected:.6f} within {allowed:.6f}"


def stacks():
    """Before an emitter, and a path of one segment passes them all: none of them uses up depth."""
    for count, opacity in ((1, 0.3), (3, 0.3), (6, 0.2), (2, 0.75)):
        thin = {"thin": {**BLACK, "opacity": opacity}}
        walls = [wall(0.5 * i, "thin") for i in range(count)]
        for depth in (1, 20):
            found = mean(scene(depth, materials=thin, quads=[*walls, wall(-3, "shine")]))
            close(found, (1 - opacity) ** count, f"{count} walls of opacity {opacity}, depth {depth}")
    return "(1 - o)^n"


def many_layers():
    """Many thin ones, of which a path passes most."""
    thin = {"thin": {**BLACK, "opacity": 0.02}}
    walls = [wall(0.01 * i, "thin") for i in range(60)]
    close(mean(scene(1, materials=thin, quads=[*walls, wall(-3, "shine")])), 0.98 ** 60, "60 walls")
    return "60 walls"


def segments_apart():
    """Before a mirror and behind it chance begins anew."""
    thin = {"thin": {**BLACK, "opacity": 0.5}, "mirror": {"type": "metal", "albedo": [1, 1, 1]}}
    mirror = {"corner": [-5, 5, -5], "u": [10, 0, 0], "v": [0, -10, 10], "material": "mirror"}
    above = {"corner": [-20, 2, -20], "u": [40, 0, 0], "v": [0, 0, 40], "material": "thin"}
    lamp = {"corner": [-20, 9, -20], "u": [40, 0, 0], "v": [0, 0, 40], "material": "shine"}
    document = scene(materials=thin, lookfrom=(0, 0, 8), quads=[mirror, above, lamp, wall(6, "thin", 1)])
    document["camera"]["vup"] = [0, 1, 0]
    close(mean(document), 0.25, "two segments")
    return "0.25"


def shapes_let_through():
    """Both sides of a ball, a capsule and a box; of a ball in another; from within."""
    thin = {"thin": {**BLACK, "opacity": 0.4}}
    members = {"spheres": [ball((0, 0, 0), 1, "thin"), ball((10, 0, 0), 1, "thin"), ball((10, 0, 0.1), 0.5, "thin")],
               "capsules": [{"ends": [[19, 0, 0], [21, 0.1, 0]], "radius": 0.6, "material": "thin"}],
               "boxes": [{"corners": [[29, -1, -1], [31, 1, 1]], "material": "thin"}],
               "quads": [wall(-8, "shine", 90)]}
    for x, name, sides in ((0, "a ball", 2), (10, "a ball in another", 4), (20, "a capsule", 2), (30, "a box", 2)):
        close(mean(scene(1, 0.2, (x, 0, 10), (x, 0, 0), materials=thin, **members)), 0.6 ** sides, name)
        inside = scene(1, 0.2, (x, 0, 0.05), (x, 0, 0), materials=thin, **members)
        inside["camera"].update(projection="perspective", vfov=5)
        del inside["camera"]["view_height"]
        close(mean(inside), 0.6 ** (sides // 2), f"{name}, from within")
    return "both sides, and one from within"


def one_in_another():
    """Of surfaces of one place one counts, whatever their order; an opaque one stops what has passed the other."""
    thin = {"thin": {**BLACK, "opacity": 0.3}, "grey": {"type": "diffuse_light", "emit": [0.5, 0.5, 0.5]}}
    back = [wall(-8, "shine", 40)]

    def found(spheres=(), capsules=()):
        return mean(scene(1, 0.4, materials=thin, quads=back, spheres=list(spheres), capsules=list(capsules)))

    same, rod = ball((0, 0, 0), 0.9, "thin"), {"ends": [[0, 0, 0], [0, 0, -3]], "radius": 0.9, "material": "thin"}
    shorter = {**rod, "ends": [[0, 0, 0], [0, 0, -2]]}
    close(found([same, same]), 0.7 ** 2, "two balls")
    close(found([same], [rod]), 0.7 ** 3, "a ball at a capsule's end")
    close(found([same], [rod, shorter]), 0.7 ** 4, "a ball at the ends of two capsules")
    close(found([same, {**same, "material": "grey"}]), 0.35, "an opaque ball behind", 0.5)
    return "counted once"


def furnaces():
    """What loses no light is invisible, whatever passes."""
    kinds = ({"type": "lambertian", "albedo": [1, 1, 1]}, {"type": "metal", "albedo": [1, 1, 1]},
             {"type": "dielectric", "refraction_index": 1.5}, {"type": "oren_nayar", "albedo": [1, 1, 1], "roughness": 0.5})
    materials = {kind["type"]: {**kind, "opacity": 0.5} for kind in kinds}
    balls = [ball((2 * (i % 2) - 1, 2 * (i // 2) - 1, 0.3 * i), 1.1, name) for i, name in enumerate(materials)]
    document = scene(1000, 5, materials=materials, spheres=balls)
    document["background"] = [1, 1, 1]
    numbers = read_pfm(picture(document, "--spp", "64"))[2]
    assert min(numbers) > 1 - 1e-6 and max(numbers) < 1 + 1e-6, f"{min(numbers)} to {max(numbers)}"
    return "exactly 1"


def layers(document, *options):
    """The channels of an EXR file."""
    return exr.read(with_file(document, lambda path: run("render", path, "-o", "-", "--format", "exr", "--quiet", *options).stdout))[2]


def alpha_and_layers():
    """Alpha counts the samples that a surface has stopped; so do depth and normals, which know the first of these."""
    thin = {"thin": {**BLACK, "opacity": 0.4}}
    document = scene(20, 0.2, materials=thin, spheres=[ball((0, 0, 0), 1, "thin")])
    document["background"], document["backdrop"] = [1, 1, 1], "none"
    alpha = layers(document, "--spp", str(SAMPLES))["A"]
    close(sum(alpha) / len(alpha), 1 - 0.6 ** 2, "alpha of a ball")
    document = scene(20, 0.2, materials=thin, quads=[wall(0, "thin"), wall(-2, "shine")])
    channels = layers(document, "--spp", str(SAMPLES))
    depth = sum(channels["depth.Z"]) / len(channels["depth.Z"])
    expected, sigma = 0.4 * 10 + 0.6 * 12, 2 * math.sqrt(0.24 / (SIDE * SIDE * 16))
    assert abs(depth - expected) < 5 * sigma, f"depth {depth}, expected {expected}"
    return "alpha and depth"


def ground_light(thin, **members):
    """The light that a matte ground sends to a camera beside what is above it."""
    document = scene(2, 0.1, (0.02, 1, 0), (0, 0, 0), thin, **members)
    document["materials"]["ground"] = {"type": "lambertian", "albedo": [1, 1, 1]}
    document["camera"]["vup"] = [0, 0, 1]
    document["quads"] = [*members.get("quads", []), {"corner": [-9, 0, 9], "u": [18, 0, 0], "v": [0, 0, -18], "material": "ground"}]
    return mean(document)


def shadows():
    """A lamp through layers brings (1 - o)^n of its light; one that lets light through itself, what both of its sides stop."""
    roof = {"corner": [-9, 2, 9], "u": [18, 0, 0], "v": [0, 0, -18], "material": "thin"}
    aside = {**roof, "corner": [-9, -2, 9]}  # so that all scenes have the same kernel
    thin = {"thin": {**BLACK, "opacity": 0.4}, "pale": {**SHINE, "opacity": 0.4}, "lamp": SHINE}
    sun = {"background": {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": [{"direction": [0.3, 1, 0.2], "half_angle": 2, "radiance": [400, 400, 400]}]}}
    lamp, shell = ball((0.5, 4, 0), 0.5, "lamp"), ball((0.5, 4, 0), 0.9, "thin")
    flat = {"corner": [-0.5, 4, 0.5], "u": [1, 0, 0], "v": [0, 0, -1], "material": "lamp"}
    bases = {"a disc": sun, "a ball": {"spheres": [lamp]}, "a quad": {"quads": [flat]}}
    wholes = {name: ground_light(thin, **{**base, "quads": [*base.get("quads", []), aside]}) for name, base in bases.items()}
    for name, share, members in (
            ("a disc", 0.6, {**sun, "quads": [roof]}), ("a ball", 0.6, {"spheres": [lamp], "quads": [roof]}),
            ("a ball", 0.6, {"spheres": [lamp, shell], "quads": [aside]}), ("a ball", 0.36, {"spheres": [lamp, shell], "quads": [roof]}),
            ("a ball", 1 - 0.6 ** 2, {"spheres": [{**lamp, "material": "pale"}], "quads": [aside]}), ("a quad", 0.6, {"quads": [flat, roof]}),
            ("a quad", 0.4, {"quads": [{**flat, "material": "pale"}, aside]})):
        whole, found = wholes[name], ground_light(thin, **members)
        assert whole > 0 and abs(found / whole - share) < 0.01 * share, f"{name}: {found / whole:.4f} of the light, expected {share:.4f}"
    return "(1 - o) of the light"


def caught():
    """The catcher's shadow is as dark as the roof is opaque, and seen through a layer it is so once more."""
    thin = {"thin": {**BLACK, "opacity": 0.4}}
    roof = {"corner": [-900, 2, 900], "u": [1800, 0, 0], "v": [0, 0, -1800], "material": "thin"}
    for above, expected in ((1, 0.6), (3, 0.36)):
        below = {"corner": [-9, -0.5, 9], "u": [18, 0, 0], "v": [0, 0, -18], "material": "shine"}  # which the catcher hides
        document = scene(3, 0.1, (0.02, above, 0), (0, 0, 0), thin, quads=[roof, below], shadow_catcher={"height": 0}, backdrop=[1, 1, 1])
        document["camera"]["vup"], document["background"] = [0, 0, 1], [1, 1, 1]
        found = mean(document)
        assert abs(found - expected) < 0.01, f"from {above}: {found}, expected {expected}"
    return "0.6 and 0.36"


def means_of_seeds(document, *options):
    found = [mean(document, *options, "--seed", str(seed)) for seed in range(1, 7)]
    middle = sum(found) / len(found)
    return middle, sum((value - middle) ** 2 for value in found) / (len(found) * (len(found) - 1))


def both_ways():
    """Rays to lamps change noise alone."""
    path = sys.argv[2] + "/tests/agree/scenes/opacity-lamps.json"
    with open(path, encoding="utf-8") as file:
        document = file.read()
    on, on_error = means_of_seeds(document, "--light-sampling", "on")
    off, off_error = means_of_seeds(document, "--light-sampling", "off")
    allowed = 5 * math.sqrt(on_error + off_error) + 1e-4
    assert abs(on - off) < allowed, f"{on} with rays to lamps, {off} without; {allowed} allowed"
    return f"{on:.4f} and {off:.4f}"


def opaque_is_as_before():
    """Opacity 1 is no effect: the same kernel and bits as without."""
    plain = scene(5, 3, materials={"m": {"type": "lambertian", "albedo": [0.5, 0.6, 0.7]}}, spheres=[ball((0, 0, 0), 1, "m")])
    plain["background"] = [1, 1, 1]
    solid = {**plain, "materials": {**plain["materials"], "m": {**plain["materials"]["m"], "opacity": 1}}}
    assert picture(plain, "--spp", "4") == picture(solid, "--spp", "4")
    assert re.search(r"opacity out all materials have opacity 1", effects(solid)), effects(solid)
    thin = {**plain, "materials": {**plain["materials"], "m": {**plain["materials"]["m"], "opacity": 0.3}}}
    assert re.search(r"opacity in 1 material of opacity below 1, on 1 of 1 sphere", effects(thin)), effects(thin)
    assert picture(plain, "--spp", "4", "--set", "materials.m.opacity=0.3") == picture(thin, "--spp", "4")
    unused = {**thin, "materials": {**thin["materials"], "other": thin["materials"]["m"], "m": plain["materials"]["m"]}}
    assert re.search(r"opacity out 1 material has an opacity below 1, but no sphere has it", effects(unused)), effects(unused)
    other = {**plain, "materials": {**plain["materials"], "m": {**plain["materials"]["m"], "opacity": 0.4}}}
    told_apart(thin, [plain, other])
    return "the same bits"


def forms():
    """All forms and arithmetic let through the same, in list and tree; and the book's method with an epsilon."""
    thin = {"thin": {**BLACK, "opacity": 0.3}}
    balls = [ball((0.3 * (i % 9 - 4), 0.3 * (i // 9 - 4), 2 * (i % 3)), 0.25, "thin") for i in range(81)]
    document = scene(4, 2, materials=thin, spheres=balls, quads=[wall(-4, "shine", 9)])
    first = picture(document, "--spp", "16", "--kernel", "packet")
    assert picture(document, "--spp", "16", "--kernel", "sample") == first, "another form, other bits"
    means = [mean(document, *options) for options in ((), ("--precision", "double"), ("--numerics", "plain"))]
    assert max(means) - min(means) < 0.01, means
    return f"{means[0]:.4f}"


def corners():
    """Rays through corners where triangles meet end, also where each lies before the next around a saddle."""
    thin = {"thin": {**BLACK, "opacity": 0.05}}
    ring = [(math.cos(math.pi * k / 4), math.sin(math.pi * k / 4), 0.8 * (-1) ** k) for k in range(8)]
    saddle = [{"vertices": [[0, 0, 0], list(ring[k]), list(ring[(k + 1) % 8])], "material": "thin"} for k in range(8)]
    document = scene(1, 0.5, materials=thin, triangles=saddle, quads=[wall(-8, "shine", 40)])
    document["camera"].update(pixel_sampling="center", image_width=SIDE + 1, vup=[0, 1, 0])
    found = mean(document)
    assert abs(found - 0.95) < 0.01, found
    return f"{found:.4f}"


def refusals():
    media = {"media": {"fog": {"absorption": 1}}, "medium": "fog"}
    cases = ((0, {}, "opacity: found 0, expected a number from 0.001 to 1: remove what has this material"), (1.5, {}, "opacity: found 1.5, expected a number from 0.001 to 1"),
             (-0.5, {}, "opacity: found -0.5"), (1e-4, {}, "opacity: found 0.0001"), ("\"half\"", {}, "opacity: found"))
    for value, members, expected in cases:
        document = scene(materials={"m": {**BLACK, "opacity": value}}, spheres=[ball((0, 0, 0), 1, "m")], **members)
        refused(document, expected)
    refused(scene(materials={"m": {"type": "interface", "opacity": 0.5}}, spheres=[ball((0, 0, 0), 1, "m")]), "only in \"lambertian\"")
    glass = {"m": {"type": "dielectric", "refraction_index": 1.5, "opacity": 0.5}}
    refused(scene(materials=glass, spheres=[ball((0, 0, 0), 1, "m")], **media), "materials.m.opacity: found 0.5 in a material that light passes into")
    return "with their remedies"


def refused(document, expected):
    def use(path):
        return subprocess.run([PROGRAM, "render", path, "-o", "-", "--format", "pfm", "--quiet"], capture_output=True, check=False)
    done = with_file(document, use)
    said = re.sub(r"\s+", " ", done.stderr.decode())
    assert done.returncode == 2 and expected in said, f"{done.returncode}, {said}: expected {expected!r}"


CASES = [stacks, many_layers, segments_apart, shapes_let_through, one_in_another, furnaces, alpha_and_layers, shadows, caught, both_ways,
         opaque_is_as_before, corners, refusals]
DEEP = [forms]

if __name__ == "__main__":
    sys.exit(run_cases(CASES, DEEP))
