"""Hard cases of discs in the sky: small scenes, and what their one point shows. As cases.py, and after its numbers.

In:    a folder, which they do not need.   Out: cases, each a scene document with the radiance that it must show.
Knows: cases.py, forms.py, the scene's grammar.   Does not know: the program, how it samples.

A disc of half angle sigma lights a point as a sphere that fills the same cone does, so the closed forms are the same.
"""
import math

import forms
from cases import (ALBEDO, BLACK, LIGHT, PI, POINT_NORMAL, Case, add, document, fuzzy, glass, lamp, lamp_at, lambertian, lit,
                   many_lamps, on_unit_sphere, scale, sphere, towards, found_by_chance)


def disc(omega, degrees, radiance=LIGHT, azimuth=0.0, **more):
    """A disc around the direction at an angle omega to the normal of the point that is looked at."""
    return {"direction": list(scale(3, towards(omega, azimuth))), "half_angle": degrees, "radiance": list(radiance), **more}


def sky(*discs, colour=BLACK):
    return {"bottom": list(colour), "top": list(colour), "discs": list(discs)}


def under(*discs, receiver=None, others=(), materials=None, **more):
    """A unit sphere under discs in a black sky."""
    scene = on_unit_sphere({"receiver": receiver or lambertian(), **(materials or {})}, list(others), **more)
    scene["background"] = sky(*discs)
    return scene


def case_51(_):
    """One disc over a lone convex receiver."""
    for omega, degrees in ((0.0, 20), (0.3, 60), (0.7, 20), (0.7, 5), (0.9, 0.25), (1.2, 1)):
        share = forms.irradiance(math.radians(degrees), omega)
        light = scale(0.1 / share, LIGHT)
        yield Case(f"disc of {degrees} degrees at {omega}", under(disc(omega, degrees, light)), lit(share, light),
                   chance=found_by_chance(share), deep=omega not in (0.3, 0.9))


def case_52(_):
    """The same, cut by the horizon; a disc of 90 degrees is half of the sky."""
    for omega, degrees in ((1.2, 40), (PI / 2, 20), (1.9, 50), (1.55, 5), (0.0, 90), (0.7, 90), (PI / 2, 90), (2.2, 90), (3.0, 90)):
        share = forms.irradiance(math.radians(degrees), omega)
        yield Case(f"disc of {degrees} degrees at {omega:.2f}", under(disc(omega, degrees)), lit(share),
                   chance=found_by_chance(share), deep=(omega, degrees) not in ((1.9, 50), (0.7, 90)), samples=4096 if omega > 2.9 else 1024)
    yield Case("below the horizon", under(disc(2.2, 20)), BLACK, exact=True, samples=64)


def case_53(_):
    """The other matte lobes."""
    for omega, degrees in ((0.0, 20), (0.9, 25), (0.5, 1)):
        sigma = math.radians(degrees)
        for name, share in (("cosine_cubed", forms.cosine_cubed(sigma, omega)), ("hemisphere", forms.hemisphere(sigma))):
            yield Case(f"{name}, disc of {degrees} degrees at {omega}", under(disc(omega, degrees), receiver=lambertian(scatter=name)),
                       lit(share), chance=found_by_chance(share), deep=omega != 0.9)


def case_54(_):
    """The depth; and who sees a disc."""
    share = forms.irradiance(math.radians(20), 0.7)
    for depth in (0, 1, 2):
        yield Case(f"receiver, depth {depth}", under(disc(0.7, 20), depth=depth), lit(share) if depth == 2 else BLACK,
                   exact=depth < 2, samples=1024 if depth == 2 else 16)
    for seen in (True, False):
        more = {} if seen else {"visible_to_camera": False}
        scene = under(disc(0.7, 20, **more), depth=2)
        yield Case(f"receiver, disc visible to the camera: {seen}", scene, lit(share), deep=seen)
        scene = under(disc(0.7, 20, **more), depth=2)
        eye = scene["camera"]["lookfrom"]
        for omega, light in ((0.7, LIGHT), (0.7 + math.radians(19.9), LIGHT), (0.7 - math.radians(20.1), BLACK)):
            scene = {**scene, "camera": {**scene["camera"], "lookat": list(add(eye, towards(omega)))}}
            yield Case(f"disc itself at {omega:.3f}, visible: {seen}", scene, light if seen else BLACK, exact=True, samples=16,
                       deep=omega < 0.7)
    # With its back to the surface, nothing is lit, whatever is in sight.
    yield Case("camera rays, depth 1", {**scene, "camera": {**scene["camera"], "max_depth": 1}}, BLACK, exact=True, samples=16, deep=True)


def case_55(_):
    """Cones so narrow that 1 - cos vanishes, and float directions are few in them."""
    for degrees in (0.25, 1e-2, 1e-3, 1e-4):
        sine2 = math.sin(math.radians(degrees)) ** 2
        light = scale(min(1e12, 0.1 / sine2), LIGHT) if degrees > 1e-4 else (1e12, 5e11, 2e11)
        yield Case(f"half angle of {degrees} degrees", under(disc(0.7, degrees, light)), lit(sine2 * math.cos(0.7), light),
                   chance=False, deep=degrees == 1e-2)


def case_56(_):
    """What stands before a disc."""
    black = {"ball": lambertian(BLACK)}
    whole, hidden = forms.irradiance(math.radians(30), 0.5), forms.irradiance(math.asin(0.2), 0.5)
    yield Case("a ball in the middle of the disc", under(disc(0.5, 30), materials=black, others=[lamp_at(0.5, 5, 1, material="ball")]),
               lit(whole - hidden))
    yield Case("a ball far away", under(disc(0.5, 30), materials=black, others=[lamp_at(0.5, 5e6, 1e6, material="ball")]),
               lit(whole - hidden))
    yield Case("a ball that hides the disc", under(disc(0.5, 5), materials=black, others=[lamp_at(0.5, 5, 1, material="ball")]), BLACK,
               exact=True, samples=64)
    yield Case("a ball before its rim", under(disc(0.5, 30), materials=black, others=[lamp_at(0.9, 3, 0.8, material="ball")]), samples=4096)
    glassy = {"ball": glass(1)}
    yield Case("glass of index 1 all around", under(disc(0.5, 30), materials=glassy, others=[sphere((0, 0, 0), 3, "ball")]), lit(whole), bits=True)
    shell = {"shell": lambertian()}
    for radius in (3, 1000):
        scene = under(disc(0.5, 30, scale(1e6, LIGHT)), materials=shell, others=[sphere((0, 0, 0), radius, "shell")])
        yield Case(f"inside a shell of {radius}", scene, BLACK, exact=True, samples=256, deep=radius != 3)


def case_57(_):
    """Discs that overlap add up."""
    first, second, third = disc(0.5, 20), disc(0.7, 25, (1.0, 6.0, 2.0), 0.2), disc(0.6, 8, (3.0, 0.0, 9.0), 0.1)
    shares = [forms.irradiance(math.radians(each["half_angle"]), omega) for each, omega in ((first, 0.5), (second, 0.7), (third, 0.6))]
    total = add(*(lit(share, each["radiance"]) for share, each in zip(shares, (first, second, third))))
    yield Case("three overlapping discs", under(first, second, third), total)
    twice = add(lit(shares[0]), lit(shares[0]))
    yield Case("the same disc twice", under(first, first), twice)
    yield Case("a disc in a disc", under(disc(0.5, 30), disc(0.5, 3, scale(50, LIGHT))),
               add(lit(forms.irradiance(math.radians(30), 0.5)), lit(forms.irradiance(math.radians(3), 0.5), scale(50, LIGHT))))
    many = [disc(0.08 * i, 2 + i % 5, scale(1 + i % 7, LIGHT), 2.4 * i) for i in range(32)]
    total = add(*(lit(forms.irradiance(math.radians(2 + i % 5), 0.08 * i), scale(1 + i % 7, LIGHT)) for i in range(32)))
    yield Case("32 discs, some below the horizon", under(*many), total)
    eye = under(first, second)["camera"]["lookfrom"]
    scene = document({"receiver": lambertian()}, [sphere((0, 0, 0), 1, "receiver")], eye, add(eye, towards(0.6, 0.1)))
    yield Case("both seen", {**scene, "background": sky(first, second)}, add(LIGHT, (1.0, 6.0, 2.0)), exact=True, samples=16)


def case_58(_):
    """Discs and lamps that are spheres."""
    near, wide = forms.irradiance(math.asin(1 / 3), 0.5), forms.irradiance(math.radians(35), 0.5)
    materials = {"lamp": lamp((9.0, 3.0, 1.0))}
    yield Case("a lamp in the middle of a disc", under(disc(0.5, 35), materials=materials, others=[lamp_at(0.5, 3, 1)]),
               add(lit(near, (9.0, 3.0, 1.0)), lit(wide - near)))
    apart = forms.irradiance(math.radians(20), 0.6)
    yield Case("a disc beside a lamp", under(disc(0.6, 20, azimuth=PI), materials=materials, others=[lamp_at(0.5, 3, 1)]),
               add(lit(near, (9.0, 3.0, 1.0)), lit(apart)))
    for count in (9, 150):
        scene, total = many_lamps(count, 1.3, lambda i: 100 * 3 ** (i % 6))
        # at the horizon, where none of the lamps stands before them
        scene["background"] = sky(disc(1.55, 1, scale(90000, LIGHT), 0.4), disc(1.6, 3, scale(9000, LIGHT), 3))
        total = add(total, lit(forms.irradiance(math.radians(1), 1.55), scale(90000, LIGHT)),
                    lit(forms.irradiance(math.radians(3), 1.6), scale(9000, LIGHT)))
        yield Case(f"two discs and {count} lamps", scene, total, chance=False, deep=count == 9)
    below = under(disc(2.5, 20, scale(1e9, LIGHT)), materials=materials, others=[lamp_at(0.5, 3, 1)])
    yield Case("a disc below the horizon, brighter than the lamp", below, lit(near, (9.0, 3.0, 1.0)))


def case_59(_):
    """Metal: lobes that a disc touches, fills, covers."""
    for fuzz, around, degrees in ((1, 0.5, 20), (0.5, 0.3, 12), (0.1, 0.05, 4), (0.1, 0.15, 6), (1 / 64, 0.01, 0.6), (0.3, 0.2, 0.4)):
        for ball in (False, True):
            share = forms.fuzz_share(fuzz, ball, math.radians(degrees), around)
            scene = fuzzy(fuzz, ball, 0.8, around, 3, 0.1, PI)
            center = scene["spheres"].pop()["center"]
            scene["materials"].pop("lamp")
            scene["background"] = sky({"direction": list(add(center, scale(-1, POINT_NORMAL))), "half_angle": degrees, "radiance": list(LIGHT)})
            yield Case(f"fuzz {fuzz:.3g} {'in a ball' if ball else 'on a sphere'}, disc of {degrees} degrees", scene, lit(share),
                       chance=found_by_chance(share), deep=fuzz not in (0.5, 0.3))
    for fuzz, up in ((0.3, 0.2), (0.9, 0.5)):
        scene = fuzzy(fuzz, False, up, 0, 3, 0.1)
        center = scene["spheres"].pop()["center"]
        scene["materials"].pop("lamp")
        scene["background"] = sky({"direction": list(add(center, scale(-1, POINT_NORMAL))), "half_angle": 80, "radiance": list(LIGHT)})
        yield Case(f"fuzz {fuzz} under a disc that covers its lobe", scene, lit(1 - forms.fuzz_absorbed(fuzz, False, up)), deep=fuzz == 0.9)


def case_60(_):
    """Mirrors show discs, and those too that the camera does not see itself."""
    for seen in (True, False):
        scene = fuzzy(0, False, 0.8, 0, 3, 0.1)
        center = scene["spheres"].pop()["center"]
        scene["materials"].pop("lamp")
        stands = {"direction": list(add(center, scale(-1, POINT_NORMAL))), "half_angle": 0.1, "radiance": list(LIGHT), "visible_to_camera": seen}
        scene["background"] = sky(stands)
        yield Case(f"mirror, visible to the camera: {seen}", scene, lit(1), exact=True, samples=16, bits=True)
    scene["spheres"].append(sphere(scale(-4, POINT_NORMAL), 1, "matte"))
    scene["materials"]["matte"] = lambertian()
    yield Case("mirror beside something matte", scene, lit(1), exact=True, samples=16, bits=True, deep=True)


def case_61(_):
    """Discs of 1e12 and 1e-6 together, each in a channel of its own."""
    first, second = disc(0.5, 20, (1e12, 0, 0)), disc(0.6, 25, (0, 1e-6, 0), PI / 2)
    shares = forms.irradiance(math.radians(20), 0.5), forms.irradiance(math.radians(25), 0.6)
    yield Case("1e12 and 1e-6", under(first, second), (ALBEDO[0] * 1e12 * shares[0], ALBEDO[1] * 1e-6 * shares[1], 0))
    scene = fuzzy(1 / 64, False, 0.8, 0, 30, 1)
    center = scene["spheres"].pop()["center"]
    scene["materials"].pop("lamp")
    stands = {"direction": list(add(center, scale(-1, POINT_NORMAL)))}
    scene["background"] = sky({**stands, "half_angle": 60, "radiance": [0, 1e-6, 0]}, {**stands, "half_angle": 0.2, "radiance": [1e12, 0, 0]})
    share = forms.fuzz_share(1 / 64, False, math.radians(0.2), 0)
    yield Case("1e12 and 1e-6, narrow lobe", scene, (ALBEDO[0] * 1e12 * share, ALBEDO[1] * 1e-6, 0),
               rounding=2e-4)  # a step of the sums is some 1e-4 of what is 1e18 times dimmer
    materials = {"lamp": lamp((1e12, 0, 0))}
    yield Case("a lamp of 1e12, a disc of 1e-6", under(second, materials=materials, others=[lamp_at(0.6, 3, 1, -PI / 2)]),
               (ALBEDO[0] * 1e12 * forms.irradiance(math.asin(1 / 3), 0.6), ALBEDO[1] * 1e-6 * shares[1], 0))


def case_62(_):
    """A furnace in balance: two halves of the sky, and surfaces that give and pass on the same radiance."""
    radiance = (1.0, 0.5, 0.25)

    def balanced(albedo, **more):
        return lambertian(albedo, emit=[b * (1 - a) for a, b in zip(albedo, radiance)], **more)

    materials = {"receiver": balanced(ALBEDO), "cubed": balanced((0.6, 0.5, 0.4), scatter="cosine_cubed"), "glass": glass(),
                 "even": balanced((0.9, 0.2, 0.7), scatter="hemisphere"), "lamp": lamp(radiance)}
    others = [lamp_at(0.6, 2.5, 1, 0, "cubed"), lamp_at(0.9, 3, 1.2, 2, "even"), lamp_at(0.8, 2, 0.6, 4, "glass"), lamp_at(0.3, 4, 0.5, 3)]
    scene = on_unit_sphere(materials, others, depth=200)
    scene["background"] = sky(disc(0.4, 90, radiance), disc(0.4 - PI, 90, radiance))
    yield Case("furnace of two discs", scene, radiance)


def case_63(_):
    """A sky behind the disc; other ways of the program."""
    share = forms.irradiance(math.radians(20), 0.7)
    scene = under(disc(0.7, 20))
    scene["background"] = sky(disc(0.7, 20), colour=(0.3, 0.2, 0.1))
    yield Case("a sky behind", scene, tuple(a * (share * e + s) for a, e, s in zip(ALBEDO, LIGHT, (0.3, 0.2, 0.1))))
    turned = under(disc(0.7, 20))
    for each in turned["spheres"]:
        each["radius"] = -each["radius"]
    yield Case("radii below 0", turned, lit(share), like=under(disc(0.7, 20)), deep=True)
    longer = under({**disc(0.7, 20), "direction": list(scale(1024, disc(0.7, 20)["direction"]))})
    yield Case("a long direction", longer, lit(share), like=under(disc(0.7, 20)))
    for options in (("--sampler", "independent"), ("--precision", "double"), ("--kernel", "sample"), ("--math", "fast"),
                    ("--numerics", "plain")):
        yield Case(" ".join(options), under(disc(0.7, 20)), lit(share), options=options, deep=True)


NUMBERED = {int(name[-2:]): function for name, function in sorted(globals().items()) if name.startswith("case_")}
