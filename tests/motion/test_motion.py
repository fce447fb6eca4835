#!/usr/bin/env python3
"""Spheres that move, through the program: closed forms, forms of the kernel, documents, explain.

usage: test_motion.py PROGRAM SOURCE_DIR [--deep | CASE...]

A sphere that glows, before black and by parallel rays, covers pi r^2 of the picture whenever it stands in it. The picture's
mean is then its radiance times the mean of what is covered over time.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from program_cases import PROGRAM, effects, picture, run, run_cases, with_file
from pfm import read_pfm

GLOW = {"type": "diffuse_light", "emit": [1, 2, 4]}


def scene(spheres, span=4, materials=None, **members):
    return {"camera": {"image_width": 32, "max_depth": 4, "projection": "orthographic", "view_height": span,
                       "lookfrom": [0, 0, 10], "lookat": [0, 0, 0]},
            "background": [0, 0, 0], "materials": materials or {"m": GLOW}, "spheres": spheres, **members}


def ball(center, radius, end=None, material="m"):
    return {"center": center, "radius": radius, "material": material, **({"center_end": end} if end else {})}


def mean(document, *options):
    numbers = read_pfm(picture(document, *options))[2]
    return sum(numbers[0::3]) / (len(numbers) / 3)


CROWD = scene([ball([0, -101, 0], 100, material="matte")] +
              [ball([0.5 * (i % 7) - 1.5, 0.5 * (i // 7) - 1.5, -0.3 * i], 0.2, [0.4 * (i % 5) - 1, 0.3 * (i % 9) - 1, 0.1 * i],
                    ["matte", "m", "glass", "steel"][i % 4]) for i in range(48)],
              materials={"m": GLOW, "matte": {"type": "lambertian", "albedo": [0.8, 0.6, 0.4]},
                         "glass": {"type": "dielectric", "refraction_index": 1.5},
                         "steel": {"type": "metal", "albedo": [0.9, 0.9, 0.9], "fuzz": 0.2}})
FEW = {**CROWD, "spheres": CROWD["spheres"][:20]}


def coverage():
    """In the picture at all times, in any direction, aside and ahead; out of it for a part of the time."""
    area = math.pi * 0.25 / 16
    for end, share in (([1.4, 1.2, 0], 1), ([-1, 0.3, -7], 1), ([0, 0, 5], 1), ([6, 0, 0], 1 / 3), ([0, -60, 0], 1 / 30)):
        found = mean(scene([ball([0, 0, 0], 0.5, end)]), "--spp", "2048")
        # At least four standard errors of independent samples.
        allowed = 4 * math.sqrt(1 / (area * share) / (2048 * 1024))
        assert abs(found / (area * share) - 1) < allowed, (end, found, area * share)
    return "the mean is that of the coverage"


def far():
    """By 1e4 and 1e6 of its radii along the view: the outline stays, whatever the time, in float too."""
    still = picture(scene([ball([0, 0, 0], 1)], materials={"m": {"type": "normals"}}), "--spp", "64")
    for way in (1e4, 1e6):
        moved = picture(scene([ball([0, 0, 0], 1, [0, 0, -way])], materials={"m": {"type": "normals"}}), "--spp", "64")
        a, b = read_pfm(still)[2], read_pfm(moved)[2]
        # Centres are rounded to 2^-24 of their distance, and shapes with them: 1e6 away by 0.06 of the radius along the view only.
        assert max(abs(x - y) for x, y in zip(a, b)) < (0.02 if way == 1e4 else 0.2), way
    # Across, 1e4 radii through a picture of four: a thousandth of the time.
    area = math.pi * 0.25 / 16
    found = mean(scene([ball([-2500, 0, 0], 0.5, [2500, 0, 0])]), "--spp", "4096")
    assert abs(found / (area * 4 / 5000) - 1) < 0.2, found
    return "1e4 radii"


def shutter_of_no_time():
    """A sphere that ends where it began does not move: the same bits, and no code for it."""
    rest = json.loads(json.dumps(CROWD))
    zero = json.loads(json.dumps(CROWD))
    for a, b in zip(rest["spheres"], zero["spheres"]):
        a.pop("center_end", None)
        b["center_end"] = b["center"]
    assert picture(rest, "--spp", "4") == picture(zero, "--spp", "4")
    assert picture(rest, "--spp", "4") != picture(CROWD, "--spp", "4")
    said = effects(zero)
    assert "motion out no sphere moves" in said, said
    return "the same bits"


def forms():
    """Every form of the kernel draws the same bits; with all effects in single precision, test_effects_equality tries."""
    for document, precision in ((CROWD, "single"), (FEW, "double")):
        first = picture(document, "--spp", "4", "--precision", precision)
        for options in (["--kernel", "sample"], ["--effects", "all"] if precision == "double" else []):
            assert picture(document, "--spp", "4", "--precision", precision, *options) == first, options
    return "the same bits in all forms"


def order():
    """The same spheres in another order are the same picture, in a list and, by many copies far away, in a tree."""
    back = {**FEW, "spheres": FEW["spheres"][::-1]}
    assert picture(FEW, "--spp", "4", "--light-sampling", "off") == picture(back, "--spp", "4", "--light-sampling", "off")
    more = {**FEW, "spheres": FEW["spheres"] + [ball([0, 1e4 + 3 * i, 0], 0.5, [i, 1e4, 0]) for i in range(60)]}
    assert picture(FEW, "--spp", "4", "--light-sampling", "off") == picture(more, "--spp", "4", "--light-sampling", "off")
    return "list and tree"


def documents():
    written = with_file(CROWD, lambda path: run("scene", path).stdout.decode())
    again = json.loads(written)["spheres"]
    for a, b in zip(CROWD["spheres"], again):
        assert a.get("center_end") == b.get("center_end"), (a, b)
    assert picture(written, "--spp", "2") == picture(CROWD, "--spp", "2")
    wrong = [("[0, 1]", ["spheres[0].center_end: found", "three numbers"]), ("[0, 1, 2e12]", ["spheres[0].center_end: found 2000000000000", "1e12"]),
             ("\"up\"", ["spheres[0].center_end: found", "three numbers"])]
    text = json.dumps(scene([ball([0, 0, 0], 1, [7, 7, 7])]))
    for value, says in wrong:
        said = with_file(text.replace("[7, 7, 7]", value), lambda path: run("render", path, "-o", "-", code=2).stderr.decode())
        assert all(s in said for s in says), said
    said = with_file(text.replace("center_end", "center_stop"), lambda path: run("render", path, "-o", "-", code=2).stderr.decode())
    assert "center_stop" in said and "center_end" in said, said
    # A camera that stands on a sphere at rest leaves it; on two that move it may stand.
    camera = {"camera": {"image_width": 8, "lookfrom": [0, 0, 0], "lookat": [0, 0, -1]}}
    both = scene([ball([0, 0, 1], 1, [0, 0, 2]), ball([0, 1, 0], 1, [0, 2, 0])], **camera)
    picture(both, "--spp", "1")
    # Two pieces of glass may share a place when the shutter opens, and not all the time.
    glass = {"m": {"type": "dielectric", "refraction_index": 1.5}}
    picture(scene([ball([0, 0, 0], 1), ball([0, 0, 0], 1, [1, 0, 0])], materials=glass), "--spp", "1")
    same = scene([ball([0, 0, 0], 1, [1, 0, 0]), ball([0, 0, 0], 1, [1, 0, 0])], materials=glass)
    said = with_file(same, lambda path: run("render", path, "-o", "-", code=2).stderr.decode())
    assert "the same centre and radius" in said, said
    return "read, written and refused"


def films():
    """Films of different motions are of different scenes."""
    with tempfile.TemporaryDirectory() as folder:
        for name, end in (("a", [1, 0, 0]), ("b", [2, 0, 0]), ("c", None)):
            path = os.path.join(folder, name)
            with open(path + ".json", "w", encoding="utf-8") as file:
                json.dump(scene([ball([0, 0, 0], 0.5, end)]), file)
            run("render", path + ".json", "-o", path + ".bpa", "--spp", "4", "--quiet", *(["--first-sample", "4"] if name != "a" else []))
        for name in "bc":
            done = subprocess.run([PROGRAM, "merge", *(os.path.join(folder, n + ".bpa") for n in ("a", name)), "-o", os.path.join(folder, "x.bpa")],
                                  capture_output=True, check=False)
            assert done.returncode == 2 and b"scene" in done.stderr, "merged"
    return "told apart"


def lamps():
    """A lamp that moves brings the same with and without rays to lamps, and explain counts it as one (tests/lamps has more)."""
    lamp = {"l": {"type": "diffuse_light", "emit": [8, 8, 8]}, "m": {"type": "lambertian", "albedo": [0.8, 0.8, 0.8]}}
    moving = [ball([0, 0, -100], 99, material="m"), ball([-1, 0, 1], 0.6, [1, 0, 1], "l"), ball([0, 1.2, 1], 0.5, material="l")]
    document = scene(moving, materials=lamp)
    on, off = mean(document, "--spp", "512"), mean(document, "--spp", "512", "--light-sampling", "off")
    assert abs(on / off - 1) < 0.02, (on, off)
    said = effects(document)
    assert "lamps in 2 lamps that can light 1 sphere\n" in said, said
    alone = scene(moving[:2], materials=lamp)
    said = effects(alone)
    assert "lamps in 1 lamp that can light 1 sphere\n" in said, said
    assert "motion in 1 of 2 spheres moves" in said, said
    return f"{on:.4f} and {off:.4f}"


def fitted():
    """A fitted camera has a sphere in view from first to last."""
    document = {"camera": {"image_width": 32, "aspect_ratio": 2, "max_depth": 2, "fit": "scene", "view": "front", "projection": "orthographic"},
                "background": [0, 0, 0], "materials": {"m": GLOW}, "spheres": [ball([0, 0, 0], 0.5, [5, 0, 0])]}
    _, _, numbers = read_pfm(picture(document, "--spp", "512"))
    columns = [sum(numbers[3 * (row * 32 + column)] for row in range(16)) for column in range(32)]
    assert columns[2] > 0 and columns[29] > 0 and columns[0] == 0 and columns[31] == 0, columns
    return "in view"


CASES = [coverage, documents, films, fitted]
DEEP_CASES = [far, shutter_of_no_time, forms, order, lamps]
sys.exit(run_cases(CASES, DEEP_CASES))
