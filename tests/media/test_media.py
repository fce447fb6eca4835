#!/usr/bin/env python3
"""Media, through the program: closed forms, the rule for nested ones, forms of the kernel, documents, explain.

usage: test_media.py PROGRAM SOURCE_DIR [--deep | CASE...]

Parallel rays go through the centres of pixels, so the chord of a sphere that a pixel shows is known. Before a white sky, an
absorbing medium leaves exp(-density * chord) of it, without noise. Of a medium that scatters, a low depth shows only
what it does not scatter, or scatters once.
"""
import json
import math
import os
import sys
import tempfile

from program_cases import effects, picture, run, run_cases, told_apart, with_file
from pfm import read_pfm

SIDE = 16
EDGE = {"type": "interface"}
GLASS = {"type": "dielectric", "refraction_index": 1.5, "fresnel": "none"}
MATCHED = {"type": "dielectric", "refraction_index": 1}
MATTE = {"type": "lambertian", "albedo": [0.8, 0.6, 0.4]}
LAMP = {"type": "diffuse_light", "emit": [9, 8, 7]}


def scene(spheres, media, span=1.0, depth=8, camera=None, **members):
    camera = {"image_width": SIDE, "max_depth": depth, "pixel_sampling": "center", "projection": "orthographic",
              "view_height": span, "lookfrom": [0, 0, 10], "lookat": [0, 0, 0], **(camera or {})}
    if camera["projection"] == "perspective":
        del camera["view_height"]
    return {"camera": camera, "background": [1, 1, 1], "media": media,
            "materials": {"edge": EDGE, "glass": GLASS, "matched": MATCHED, "matte": MATTE, "lamp": LAMP}, "spheres": spheres, **members}


def ball(center, radius, interior=None, material="edge", **members):
    return {"center": center, "radius": radius, "material": material, **({"interior": interior} if interior else {}), **members}


def pinhole(**members):
    return {"projection": "perspective", "vfov": 0.01, **members}


def pixels(document, *options):
    numbers = read_pfm(picture(document, *options))[2]
    return [numbers[i:i + 3].tolist() for i in range(0, len(numbers), 3)]


def mean(document, *options):
    found = pixels(document, *options)
    return [sum(p[c] for p in found) / len(found) for c in range(3)]


def close(found, wanted, allowed, what):
    assert abs(found - wanted) <= allowed * abs(wanted) + 1e-37, f"{what}: {found} instead of {wanted}"


def chords():
    """A sphere of diameter 1, all chords, from 1e-6 to 1e6 mean free paths a diameter."""
    for density in (1e-6, 1e-3, 0.1, 1, 10, 1e3, 1e6):
        found = pixels(scene([ball([0, 0, 0], 0.5, "m")], {"m": {"absorption": [density, density / 2, 0]}}, 0.99), "--spp", "1")
        for row in range(SIDE):
            for column in range(SIDE):
                x, y = ((i + 0.5) / SIDE * 0.99 - 0.495 for i in (column, row))
                chord = 2 * math.sqrt(max(0.25 - x * x - y * y, 0))
                r, g, b = found[row * SIDE + column]
                for value, share in ((r, 1), (g, 0.5)):
                    left = density * share * chord
                    if left < 70:
                        close(value, math.exp(-left), 1e-3 if left < 1 else 1e-4 * left, f"density {density}, chord {chord}")
                    elif left > 90:
                        assert value == 0, (density, chord, value)
                assert b == 1, b
    return "within 0.1 %"


def scattered_light_is_lost():
    """Three segments show only what is not scattered: exp(-density) of the middle chord, by colours too."""
    for density, weights in ((1e-3, (1, 1, 1)), (0.5, (1, 1, 1)), (2, (1, 1, 1)), (1, (1, 2, 0.25))):
        media = {"m": {"scattering": [density * w for w in weights]}}
        samples = 2048 * SIDE * SIDE
        found = mean(scene([ball([0, 0, 0], 0.5, "m")], media, 1e-3, 3), "--spp", "2048")
        for value, w in zip(found, weights):
            wanted = math.exp(-density * w)
            # Of colours, weights are up to 3.
            error = math.sqrt(wanted * (1 - wanted) / samples) * (3 if len(set(weights)) > 1 else 1)
            assert abs(value - wanted) < 4.5 * error + 1e-6, (density, w, value, wanted)
    return "as much as is scattered"


def furnace():
    """What only scatters, before and around it all the same light, shows exactly that light; colours in the mean."""
    for material in ("edge", "glass"):
        for density, g in ((0.5, 0), (30, 0.9), (8, -0.7)):
            document = scene([ball([0, 0, 0], 0.5, "m", material)], {"m": {"scattering": density, "anisotropy": g}}, 1.2, 20000)
            for options in (["--kernel", "sample"], []):
                assert all(p == [1, 1, 1] for p in pixels(document, "--spp", "4", *options)), (material, density, g)
    found = mean(scene([ball([0, 0, 0], 0.5, "m")], {"m": {"scattering": [1, 4, 0.1]}}, 0.5, 5000), "--spp", "1024")
    for value in found:
        close(value, 1, 0.01, "by colours")
    return "exactly the sky"


def beer_in_glass():
    """Straight through the middle of glass, and of glass that does not bend light."""
    for material, span in (("glass", 1e-4), ("matched", 0.9)):
        found = pixels(scene([ball([0, 0, 0], 0.5, "m", material)], {"m": {"absorption": [1, 3, 0.01]}}, span), "--spp", "1")
        x = 0.5 / SIDE * span
        for value, density in zip(found[SIDE * SIDE // 2 + SIDE // 2], (1, 3, 0.01)):
            close(value, math.exp(-density * 2 * math.sqrt(0.25 - 2 * x * x)), 1e-4, material)
    return "tinted"


def middle(spheres, media, **members):
    return pixels(scene(spheres, media, 1e-5, 30, **members), "--spp", "1")[0][0]


def nested_and_overlapping():
    """The smallest sphere around a point decides, of equal ones the first; without an interior it is clear."""
    media = {"a": {"absorption": 1}, "b": {"absorption": 0.3}, "fog": {"absorption": 0.1}}
    outer, inner = ball([0, 0, 0], 1, "a"), ball([0, 0, 0.2], 0.5, "b")
    cases = {
        "nested": ([outer, inner], 1 * 1 + 1 * 0.3),
        "nested, listed the other way": ([inner, outer], 1 * 1 + 1 * 0.3),
        "a bubble": ([outer, ball([0, 0, 0.2], 0.5)], 1),
        "a glass bubble": ([ball([0, 0, 0], 1, "a", "glass"), ball([0, 0, 0], -0.5, None, "glass")], 1),
        "three": ([outer, inner, ball([0, 0, 0.1], 0.2, "a")], 1 + 0.6 * 0.3 + 0.4),
        "overlapping": ([outer, ball([0, 0, 1], 0.8, "b")], 1.2 + 1.6 * 0.3),
        "of one size, the first": ([outer, ball([0, 0, 1], 1, "b")], 2 + 0.3),
        "of one size, the other way": ([ball([0, 0, 1], 1, "b"), outer], 2 * 0.3 + 1),
        "touching": ([outer, ball([0, 0, 1.5], 0.5, "b")], 2 + 0.3),
        "touching inside": ([outer, ball([0, 0, 0.5], 0.5, "b")], 1 + 0.3),
    }
    for name, (spheres, length) in cases.items():
        close(middle(spheres, media), math.exp(-length), 1e-4, name)
    # In fog all around, what has no interior is clear. It reaches to the sky, so a lamp stands behind.
    lamp = ball([0, 0, -4], 1, None, "lamp")
    from_lens = {"camera": pinhole(lookfrom=[0, 0, 4])}
    close(middle([lamp], media, medium="fog", **from_lens) / 9, math.exp(-0.7), 1e-4, "fog")
    close(middle([lamp, ball([0, 0, 1], 1)], media, medium="fog", **from_lens) / 9, math.exp(-0.5), 1e-4, "clear in fog")
    close(middle([lamp, outer], media, medium="fog", **from_lens) / 9, math.exp(-0.5 - 2), 1e-4, "smoke in fog")
    assert middle([], media, medium="fog") == 0, "fog without end hides the sky"
    return f"{len(cases) + 4} cases"


def camera_inside():
    media = {"a": {"absorption": 1}}
    sphere = ball([0, 0, 0], 1, "a")
    for z, length in ((0.25, 1.25), (1, 2), (-1, 0), (2, 2)):
        close(middle([sphere], media, camera=pinhole(lookfrom=[0, 0, z], lookat=[0, 0, z - 1])), math.exp(-length), 1e-4, f"from {z}")
    return "inside, and on the boundary"


def single_scattering():
    """From the middle of a ball before an even sky: what is scattered once, against quadrature."""
    camera = pinhole(lookfrom=[0, 0, 0], lookat=[0, 0, -1], vfov=40)
    for density, g in ((1, 0), (2, 0.6), (0.5, -0.8)):
        media = {"m": {"scattering": density, "anisotropy": g}}
        found = mean(scene([ball([0, 0, 0], 1, "m")], media, 1, 3, camera), "--spp", "2048")[0]
        once, steps = 0.0, 400
        for i in range(steps):
            s = (i + 0.5) / steps
            light = 0.0
            for k in range(steps):
                mu = -1 + 2 * (k + 0.5) / steps
                way = -s * mu + math.sqrt(1 - s * s * (1 - mu * mu))
                light += (1 - g * g) / 2 / (1 + g * g - 2 * g * mu) ** 1.5 * math.exp(-density * way) * 2 / steps
            once += density * math.exp(-density * s) * light / steps
        wanted = math.exp(-density) + once
        error = math.sqrt(wanted * (1 - wanted) / (2048 * SIDE * SIDE))
        assert abs(found - wanted) < 4.5 * error + 1e-4 * wanted, (density, g, found, wanted)
    return "as by quadrature"


def nothing_and_all():
    """Clear media leave the picture as it is; the densest leaves nothing, and no sample is invalid."""
    empty = scene([], {}, 1.2)
    for media in ({"m": {}}, {"m": {"absorption": 0, "scattering": [0, 0, 0]}}):
        assert picture(scene([ball([0, 0, 0], 0.5, "m")], media, 1.2), "--spp", "1") == picture(empty, "--spp", "1")
    black = pixels(scene([ball([0, 0, 0], 0.5, "m")], {"m": {"absorption": 1e12}}, 0.9, 40), "--spp", "1")
    assert any(p == [0, 0, 0] for p in black) and black[SIDE * SIDE // 2 + SIDE // 2] == [0, 0, 0]
    document = scene([ball([0, 0, 0], 0.5, "m")], {"m": {"scattering": [1e12, 1e-12, 1], "absorption": [1e-12, 0, 1e12], "anisotropy": 0.999}}, 1.2, 60)
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        for precision in ("single", "double"):
            with_file(document, lambda path: run("render", path, "-o", os.path.join(folder, "x.pfm"), "--stats", stats, "--quiet", "--spp", "16", "--precision", precision))
            with open(stats, encoding="utf-8") as file:
                assert json.load(file)["invalid_samples"] == 0
    return "0 and 1e12"


def moving():
    """A ball of smoke that moves along the view absorbs the same at all times, and glass inside moves with it."""
    media = {"a": {"absorption": 1}}
    spheres = [ball([0, 0, 0], 1, "a", center_end=[0, 0, -5]), ball([0, 0, 0], 0.5, center_end=[0, 0, -5])]
    for p in pixels(scene(spheres, media, 1e-5, 30), "--spp", "8"):
        close(p[0], math.exp(-1), 1e-4, "moving")
    return "with its medium"


MIXED = scene([ball([0, -101, 0], 100, None, "matte"), ball([-0.6, 0, 0], 0.5, "smoke"), ball([0.5, 0, 0], 0.5, "ink", "glass"),
               ball([0.5, 0, 0.1], 0.3, "smoke", center_end=[0.4, 0, 0.1]), ball([0, 0.9, 0], 0.3, None, "lamp")],
              {"smoke": {"absorption": 0.5, "scattering": 2, "anisotropy": 0.4}, "ink": {"absorption": [0, 1, 3], "scattering": [3, 2, 1]},
               "fog": {"scattering": 0.1}}, 3, 12, {"pixel_sampling": "square"}, medium="fog")


def forms():
    # In smoke without fog around it, some lanes of a packet fly through clear space: nothing may happen to them.
    smoke = {**{member: MIXED[member] for member in MIXED if member != "medium"}, "background": [0.9, 0.8, 0.7]}
    for precision in ("single", "double"):
        for document in (MIXED, smoke):
            # Kernels with every effect take long to compile: once is enough.
            everything = precision == "single" and document is smoke
            first = picture(document, "--spp", "8", "--precision", precision)
            for options in (["--kernel", "sample"], ["--effects", "all"] if everything else []):
                assert picture(document, "--spp", "8", "--precision", precision, *options) == first, options
    return "the same bits"


def lamps():
    """Light found by rays to lamps, and by chance, is the same."""
    spheres = [ball([0, -101, 0], 100, None, "matte"), ball([0, 0.2, 0], 0.7, "smoke"), ball([1.2, 0.6, 0.3], 0.5, None, "lamp")]
    for medium in ({}, {"medium": "fog"}):
        document = scene(spheres, MIXED["media"], 3, 12, {"pixel_sampling": "square"}, **{**medium, "background": [0.1, 0.1, 0.1]})
        on, off = mean(document, "--spp", "2048"), mean(document, "--spp", "2048", "--light-sampling", "off")
        for a, b in zip(on, off):
            close(a, b, 0.02, f"lamps, {medium}")
    return "on and off"


def documents():
    written = with_file(MIXED, lambda path: run("scene", path).stdout.decode())
    again = json.loads(written)
    assert again["medium"] == "fog" and again["media"]["ink"]["scattering"] == [3, 2, 1], again["media"]
    assert [s.get("interior") for s in again["spheres"]] == [s.get("interior") for s in MIXED["spheres"]]
    assert picture(written, "--spp", "2") == picture(MIXED, "--spp", "2")
    text = json.dumps(scene([ball([0, 0, 0], 1, "m")], {"m": {"absorption": 1, "scattering": 2, "anisotropy": 0}}))
    wrong = [('"absorption": 1', '"absorption": -1', ["media.m.absorption: found -1", "from 1e-12 to 1e12"]),
             ('"absorption": 1', '"absorption": [1, 2]', ["media.m.absorption", "three densities"]),
             ('"scattering": 2', '"scattering": [1, 2e12, 0]', ["media.m.scattering: found 2000000000000"]),
             ('"anisotropy": 0', '"anisotropy": 1', ["media.m.anisotropy: found 1", "-0.999 to 0.999"]),
             ('"anisotropy": 0', '"anisotropi": 0', ["media.m.anisotropi", 'did you mean "anisotropy"']),
             ('"interior": "m"', '"interior": "n"', ['spheres[0].interior: found the medium "n"', 'did you mean "m"']),
             ('"interior": "m"', '"interior": 1', ["spheres[0].interior: found 1", "text"]),
             ('"material": "edge"', '"material": "matte"', ["spheres[0].interior: found in a sphere whose material is of type \"lambertian\"", "interface"]),
             ('"spheres"', '"medium": "x", "spheres"', ['medium: found the medium "x"', 'did you mean "m"'])]
    for before, after, says in wrong:
        assert text.count(before) == 1, before
        said = with_file(text.replace(before, after), lambda path: run("render", path, "-o", "-", code=2).stderr.decode())
        assert all(s in " ".join(said.split()) for s in says), (says, said)
    said = with_file(text.replace('"media": {"m"', '"media": {"n"'), lambda path: run("render", path, "-o", "-", code=2).stderr.decode())
    assert 'did you mean "n"' in said, said
    return "read, written and refused"


def films():
    base = scene([ball([0, 0, 0], 0.5, "m")], {"m": {"absorption": 1, "scattering": 1}, "n": {"scattering": 1}})
    others = [json.loads(json.dumps(base)) for _ in range(5)]
    others[0]["media"]["m"]["absorption"] = [1, 1, 2]
    others[1]["media"]["m"]["scattering"] = 2
    others[2]["media"]["m"]["anisotropy"] = 0.1
    others[3]["medium"] = "n"
    del others[4]["spheres"][0]["interior"]
    return told_apart(base, others)


def explained():
    said = effects(MIXED)
    assert "media in 3 spheres with a medium inside, and the scene lies in one" in said, said
    clear = effects(scene([ball([0, 0, 0], 1)], {"m": {}}))
    assert "media in 1 interface, but all media are clear" in clear, clear
    none = effects(scene([ball([0, 0, 0], 1, None, "matte")], {"m": {}}, medium="m"))
    assert "media out no sphere has a medium inside" in none, none
    dense = scene([], {"m": {"scattering": 5}}, camera=pinhole(), medium="m", depth=4)
    step = with_file(dense, lambda path: run("explain", path, "--wide", "--pixel", "4,8").stdout.decode())
    assert step.count("a medium scatters it at (") == 4, step
    return "in and out, and step by step"


CASES = [chords, nested_and_overlapping, camera_inside, nothing_and_all, documents, films, explained]
DEEP_CASES = [scattered_light_is_lost, furnace, beer_in_glass, single_scattering, moving, forms, lamps]
sys.exit(run_cases(CASES, DEEP_CASES))
