#!/usr/bin/env python3
"""With rays by way of spheres, a picture depends on scene, seed and samples alone: no form of the kernel changes a bit of it.

usage: test_caustic_forms.py PROGRAM SOURCE_DIR [--deep | CASE...]

That the general kernel draws the same with a list and a tree, in single and double precision and refined in float, recorded pictures
show (tests/cli/test_cli_bits.py); that it does on devices that do not round, tests/drivers/test_own_rounding.py.
"""
import json
import os
import sys

from program_cases import picture, run_cases

SCENES = os.path.join(sys.argv[2], "tests/agree/scenes")
NAMES = ("caustics-glass", "caustics-inside", "caustics-mirror", "caustics-pair", "caustics-sun")
SIZE = ("--width", "24", "--spp", "6")


def scene(name):
    with open(os.path.join(SCENES, name + ".json"), encoding="utf-8") as file:
        return json.load(file)


def drawn(document, *options):
    return picture(document, *SIZE, "--caustics", "on", *options)


def own_kernels():
    """A kernel that has only what the scene needs draws what the general one does, in every form."""
    for name in NAMES:
        document = scene(name)
        expected = drawn(document, "--effects", "all", "--kernel", "packet")
        for form in ("packet", "sample", "pool"):
            assert drawn(document, "--kernel", form) == expected, f"{name}: {form} draws another picture than the general kernel"
        assert picture(document, *SIZE, "--caustics", "off") != expected, f"{name}: no rays by way of spheres"
        assert drawn(document, "--seed", "1") != expected, f"{name}: the seed has no effect"


def what_is_not_there():
    """Rays by way of spheres are asked for where there are none: not a bit changes."""
    document = scene("caustics-mirror")
    document["materials"]["brass"]["fuzz"] = 0.5
    for effects in (["--effects", "all"], []):
        assert drawn(document, *effects) == picture(document, *SIZE, *effects, "--caustics", "off"), effects


def double_precision():
    """Both forms draw the same in double precision, too."""
    document = scene("caustics-inside")
    first, second = drawn(document, "--precision", "double", "--kernel", "packet"), drawn(document, "--precision", "double", "--kernel", "sample")
    assert first == second, "double precision: forms differ"
    assert first != drawn(document), "double precision has no effect"


CASES = []
DEEP_CASES = [own_kernels, what_is_not_there, double_precision]

sys.exit(run_cases(CASES, DEEP_CASES))
