#!/usr/bin/env python3
"""Russian roulette: its chances and decisions by value, rooms whose light is known, the same means as without, and the same bits
in every form of the kernel.

usage: test_roulette.py PROGRAM SOURCE_DIR [--deep | CASE...]

The constants, the generator and the formula are written anew here, from their definitions (kernels/roulette_types.h,
kernels/sampling/rng.cl).
"""
import json
import math
import os
import sys
import tempfile

from pfm import read_pfm
from program_cases import picture, run, run_cases, with_file

SOURCE = sys.argv[2]
SEGMENTS, LIMIT = 8, 1 / 64
LOW = 0xffffffff
ON, OFF = ("--roulette", "on"), ("--roulette", "off")

# A closed room in which everything shines with the radiance 1, whatever the albedo.
ALBEDO = [0.8, 0.6, 0.3]
ROOM = {"camera": {"image_width": 24, "max_depth": 400, "vfov": 70, "lookfrom": [0, 0, 2], "lookat": [0, 0, 0]},
        "background": [0, 0, 0],
        "materials": {"room": {"type": "lambertian", "albedo": ALBEDO, "emit": [1 - a for a in ALBEDO]}},
        "spheres": [{"center": [0, 0, 0], "radius": 3, "material": "room"}]}


def room(**members):
    return {**json.loads(json.dumps(ROOM)), **members}


def foggy(scattering, anisotropy=0.3):
    """The room, filled with what scatters, and takes nothing away."""
    return room(medium="fog", media={"fog": {"scattering": scattering, "anisotropy": anisotropy}})


def means(document, *options):
    """Of the three colours, and their standard errors from pixel to pixel."""
    values = read_pfm(picture(document, "--sampler", "independent", *options))[2]
    found = []
    for channel in range(3):
        of_pixels = values[channel::3]
        n = len(of_pixels)
        mean = math.fsum(of_pixels) / n
        found.append((mean, math.sqrt(math.fsum((v - mean) ** 2 for v in of_pixels) / (n - 1) / n)))
    return found


# ---- by value -----------------------------------------------------------------------------------------------------------------

def pcg4d(x, y, z, w):
    """M. Jarzynski and M. Olano, 2020, listing 4."""
    x, y, z, w = ((a * 1664525 + 1013904223) & LOW for a in (x, y, z, w))
    for turn in range(2):
        x = (x + y * w) & LOW
        y = (y + z * x) & LOW
        z = (z + x * y) & LOW
        w = (w + y * z) & LOW
        if turn == 0:
            x, y, z, w = (a ^ a >> 16 for a in (x, y, z, w))
    return x, w


def number(pixel, sample, dimension):
    """24 random bits of a dimension, for the seed 0."""
    a, b = pcg4d(pixel, sample, 0, 0)
    x = (a + dimension * 0x9e3779b9) & LOW
    x ^= x >> 16
    x = (x * 0x21f0aaad + b) & LOW
    x ^= x >> 15
    x = x * 0xd35a2d97 & LOW
    return (x ^ x >> 15) >> 8


def steps_of(document, pixel, sample, *options):
    x, y = pixel
    words = ("--pixel", f"{x},{y}", "--first-sample", str(sample), "--json", "-", *options)
    return json.loads(with_file(document, lambda path: run("explain", path, *words).stdout))["scenes"][0]["path"]


def check_path(document, pixel, sample, *options):
    """How often roulette was played on one path, and whether it ended it; every chance and decision is right."""
    path, depth = steps_of(document, pixel, sample, *ON, *options), document["camera"]["max_depth"]
    width, steps, played = document["camera"]["image_width"], path["steps"], 0
    albedo, clear = document["materials"]["room"]["albedo"], "medium" not in document
    carried = [1, 1, 1]  # without the weights of flights
    for place, step in enumerate(steps):
        if step["met"]:
            carried = [c * a for c, a in zip(carried, albedo)]
        most, segments = max(step["throughput"] if clear else carried), place + 1
        goes_on = step.get("goes_on", step.get("scattered", False))
        due = goes_on and SEGMENTS <= segments < depth and most < LIMIT
        if abs(most / LIMIT - 1) > 1e-5:  # floats have rounded
            assert ("roulette" in step) == due, f"step {segments}: {carried}, {step}"
        if "roulette" not in step:
            continue
        played += 1
        steps_of_chance = step["roulette"]["chance"] * 2 ** 24
        chance = round(steps_of_chance)
        slack = 1e-3 if clear else 1e-3 + 1e-5 * chance
        assert abs(steps_of_chance - chance) < 1e-3 and (slack if clear else -slack) < chance - most / LIMIT * 2 ** 24 < 1 + slack, \
            f"step {segments}: {carried} gives {step}"
        carried = [c * 2 ** 24 / chance for c in carried]
        lives = number(pixel[1] * width + pixel[0], sample, 16 + 16 * place + 6) < chance
        assert step["roulette"]["goes_on"] == lives, f"step {segments}: {step}"
        assert lives == (segments < len(steps)), f"step {segments} of {len(steps)}"
        if lives and clear:
            after = [t * a * 2 ** 24 / chance for t, a in zip(step["throughput"], albedo)]
            now = steps[place + 1]["throughput"]
            assert all(abs(a - b) <= 1e-5 * max(now) for a, b in zip(after, now)), f"step {segments}: {after}, not {now}"
    return played, bool(played) and "roulette" in steps[-1] and not steps[-1]["roulette"]["goes_on"]


def chances():
    """Each is the largest colour over the limit, rounded up to whole steps of 2^-24, and decides by a number of its own."""
    plays = ends = 0
    for sampler in ("independent", "sobol"):
        for pixel, sample in (((3, 5), 0), ((20, 7), 3), ((11, 23), 12)):
            played, ended = check_path(ROOM, pixel, sample, "--sampler", sampler)
            plays, ends = plays + played, ends + ended
    for sample in range(2):
        check_path(foggy(0.5), (9, 14), sample)
        check_path(foggy([0.05, 0.3, 0.9]), (9, 14), sample)
    assert plays > 10 and ends == 6, (plays, ends)
    short = room(camera={**ROOM["camera"], "max_depth": SEGMENTS})
    assert check_path(short, (3, 5), 0)[0] == 0
    dark = room(materials={"room": {**ROOM["materials"]["room"], "albedo": [0.3, 0.5, 0.2]}})
    assert check_path(dark, (3, 5), 0)[0] > 0  # from the first segment that counts
    assert not any("roulette" in step for step in steps_of(ROOM, (3, 5), 0, *OFF)["steps"])
    return f"{plays} plays on six paths"


def explained():
    """A person reads what roulette did."""
    text = with_file(ROOM, lambda path: run("explain", path, "--pixel", "3,5", *ON).stdout.decode())
    assert "       roulette, with a chance of 0." in text and "to go on, ends the path here\n" in text, text
    return "both are said" if "lets it go on and carry" in text else "an end is said"


# ---- light that is known ------------------------------------------------------------------------------------------------------

def check_room(name, document, *options, within=1.5e-3):
    found = means(document, "--spp", "128", *ON, *options)
    assert max(error for _, error in found) > 0, f"{name}: no roulette"
    for (mean, error), without in zip(found, means(document, "--spp", "8", *OFF, *options)):
        assert error < within, f"{name}: {mean} +- {error} shows nothing"
        assert abs(mean - 1) < 5 * error + 1e-6, f"{name}: {mean} +- {error}, not 1"
        assert abs(without[0] - 1) < 5 * without[1] + 1e-5, f"{name}, without roulette: {without}"


def rooms():
    """In a closed room that shines everywhere with the radiance 1, every picture is white: whatever surfaces keep, they give."""
    check_room("matte", ROOM)
    glass = room(materials={**ROOM["materials"], "glass": {"type": "dielectric", "refraction_index": 1.5, "fresnel": "exact"}})
    glass["spheres"] = ROOM["spheres"] + [{"center": [0, 0, 0], "radius": 1, "material": "glass"}]
    check_room("with a ball of glass", glass, "--kernel", "sample")
    check_room("in fog", foggy(0.3))
    return "matte, glass, fog"


def coloured_fog():
    """Where colours fly differently, the weights of flights rise and fall; no sample is out of the film's range for it."""
    document = foggy([0.05, 0.3, 0.9])
    check_room("in coloured fog", document, within=8e-3)
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "s.json")
        with_file(document, lambda path: run("render", path, "-q", "-o", os.path.join(folder, "x.pfm"), "--stats", stats, "--spp", "256", *ON))
        with open(stats, encoding="utf-8") as file:
            assert json.load(file)["invalid_samples"] == 0
    return "white"


# ---- the same means -----------------------------------------------------------------------------------------------------------

BOOK = ("cover", "lamps", "studio", "facets", "lobes", "checkers", "next-smoke", "next-cornell-box", "next-final-spheres",
        "v4-10-lambertian", "v4-18-glass-hollow")
SMALL = ("furnace", "media-fog", "media-smoke", "rough-metal", "rough-glass", "oren-nayar", "glossy", "everything", "triangles-room",
         "capsules-mixed")


def difference(path, seeds):
    """The mean of the pictures with roulette less that without, its standard error, and the mean: luminances, of pixels that share
    all random numbers but those of roulette."""
    apart, all_light = [], 0.0
    for seed in seeds:
        on, off = (read_pfm(run("render", path, "-o", "-", "--format", "pfm", "-q", "--width", "24", "--spp", "64", "--depth", "60",
                                "--effects", "all", "--seed", str(seed), "--sampler", "independent", *words).stdout)[2]
                   for words in (ON, OFF))
        apart += [0.2126 * (on[i] - off[i]) + 0.7152 * (on[i + 1] - off[i + 1]) + 0.0722 * (on[i + 2] - off[i + 2])
                  for i in range(0, len(on), 3)]
        all_light += math.fsum(off)
    mean = math.fsum(apart) / len(apart)
    error = math.sqrt(math.fsum((v - mean) ** 2 for v in apart) / (len(apart) - 1) / len(apart))
    return mean, error, all_light / len(apart) / 3


def same_means():
    """Of the scenes: with roulette and without, within four standard errors of their difference."""
    said, worst = [], 0
    for folder, names in (("scenes", BOOK), ("tests/agree/scenes", SMALL)):
        for name in names:
            mean, error, light = difference(os.path.join(SOURCE, folder, name + ".json"), range(2))
            z = abs(mean) / error if error > 0 else 0
            worst = max(worst, z)
            said.append(f"{name} {mean / light:+.1e} +- {error / light:.0e}")
            assert z < 4, f"{name}: {mean} +- {error} of {light}"
            assert error < 2e-3 * light, f"{name}: {error} of {light} shows nothing"
    return f"{len(said)} scenes, z of {worst:.1f} at most: " + ", ".join(said)


# ---- the same bits ------------------------------------------------------------------------------------------------------------

def forms():
    """Packets, single paths and pools draw the same, and so does a kernel that has everything."""
    document = foggy([0.1, 0.2, 0.3])
    document["materials"] = {"room": {"type": "lambertian", "albedo": ALBEDO}, "lamp": {"type": "diffuse_light", "emit": [9, 8, 7]}}
    document["spheres"] = ROOM["spheres"] + [{"center": [0, 2, 0], "radius": 0.5, "material": "lamp"}]
    size = ("--spp", "8", "--width", "16")
    expected = picture(document, *size, *ON)
    for words in (("--kernel", "sample"), ("--kernel", "pool"), ("--effects", "all")):
        assert picture(document, *size, *ON, *words) == expected, words
    without = picture(document, *size, *OFF)
    assert without != expected, "roulette has no effect"
    assert without == picture(document, *size, *OFF, "--effects", "all"), "roulette that was not asked for"
    double = [picture(document, *size, *ON, "--precision", "double", "--kernel", form) for form in ("packet", "sample")]
    assert double[0] == double[1] != expected
    return "six"


def where_it_has_no_effect():
    """Where paths are short, or everything passes on all light, not a bit changes, and films say that it is off."""
    short = room(camera={**ROOM["camera"], "max_depth": SEGMENTS})
    white = room()
    white["materials"] = {"room": {"type": "lambertian", "albedo": [1, 1, 1], "emit": [0.01, 0.01, 0.01]}}
    white["camera"]["max_depth"] = 40
    for document in (short, white):
        for words in ((), ("--effects", "all")):
            both = [with_file(document, lambda path: run("render", path, "-o", "-", "--format", "bpa", "-q", "--spp", "4",
                                                         *words, *choice).stdout) for choice in (ON, OFF)]
            assert b'"roulette": "off"' in both[0] and both[0] == both[1], words
    return "two rooms"


def films():
    """They say whether it was on; a merge and a continuation hold on to it."""
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, name) for name in ("on.bpa", "off.bpa", "both.bpa", "more.bpa", "whole.bpa")]

        def make(path):
            for name, first, choice in ((names[0], 0, ON), (names[1], 4, OFF)):
                run("render", path, "-q", "--spp", "4", "--first-sample", str(first), "-o", name, *choice)
            run("render", path, "-q", "--spp", "8", "-o", names[3], "--resume", names[0])
            run("render", path, "-q", "--spp", "8", "-o", names[4], *ON)
            failed = run("render", path, "-q", "--spp", "8", "-o", names[3], "--resume", names[0], *OFF, code=2)
            assert b"--roulette" in failed.stderr, failed.stderr

        with_file(ROOM, make)
        read = []
        for name in names[:2] + names[3:]:
            with open(name, "rb") as file:
                read.append(file.read())
        assert [b'"roulette": "on"' in text for text in read] == [True, False, True, True]
        pictures = [run("merge", name, "-o", "-", "--format", "pfm", "-q").stdout for name in names[3:]]
        assert pictures[0] == pictures[1], "continued"
        failed = run("merge", names[0], names[1], "-o", names[2], "-q", code=2)
        assert b"choices of roulette" in failed.stderr, failed.stderr
    return "on and off are kept apart"


CASES = [chances, explained, rooms, forms, where_it_has_no_effect, films]
DEEP_CASES = [coloured_fog, same_means]

sys.exit(run_cases(CASES, DEEP_CASES))
