"""Hard cases of light sampling: small scenes, and what their one point shows.

In:    a folder for the files of points.   Out: cases, each a scene document with the radiance that it must show.
Knows: forms.py, the scene's grammar.   Does not know: the program, how it samples.

Nearly all cases look at one point: 16 x 16 pixels, all through their centres, in a field of view so narrow that each shows
the same point. So the pixels are 256 independent estimates of one number, whose spread is the estimate's error.
"""
import array
import math
import sys
from dataclasses import dataclass, field

import forms

PI = math.pi
SIDE = 16
NARROW = 1e-5  # degrees
POINT_NORMAL = (0.36, 0.8, 0.48)  # of the point on the unit sphere that is looked at
ALBEDO = (0.8, 0.5, 0.2)
LIGHT = (5.0, 4.0, 3.0)
BLACK = (0.0, 0.0, 0.0)


def add(*vectors):
    return tuple(map(sum, zip(*vectors)))


def scale(factor, vector):
    return tuple(factor * x for x in vector)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(vector):
    return scale(1 / math.sqrt(dot(vector, vector)), vector)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


TANGENT = unit(cross(POINT_NORMAL, (1, 0, 0)))
SIDEWAYS = cross(POINT_NORMAL, TANGENT)


def towards(omega, azimuth=0.0, axis=POINT_NORMAL, tangent=TANGENT):
    """The direction at an angle omega to the axis."""
    across = add(scale(math.cos(azimuth), tangent), scale(math.sin(azimuth), cross(axis, tangent)))
    return add(scale(math.cos(omega), axis), scale(math.sin(omega), across))


@dataclass
class Case:
    """`expected`: radiance of each channel, None where only chance knows it. `exact`: to the bit, in every pixel.
    `chance`: without sampling the same comes out, and is held to the same value. `bits`: sampling changes no bit.
    `sent`: how many rays to lamps each sample sends, where all send as many.
    `like`: another document that must give the same bits. `rounding`: relative, what single precision and the sums may cost."""
    name: str
    scene: dict
    expected: tuple = None
    exact: bool = False
    chance: bool = True
    bits: bool = False
    sent: int = None
    like: dict = None
    samples: int = 1024
    rounding: float = 2e-5
    options: tuple = ()
    deep: bool = False
    files: dict = field(default_factory=dict)


def lambertian(albedo=ALBEDO, **more):
    return {"type": "lambertian", "albedo": list(albedo), **more}


def metal(fuzz, albedo=ALBEDO, **more):
    return {"type": "metal", "albedo": list(albedo), "fuzz": fuzz, **more}


def glass(index=1.5, **more):
    return {"type": "dielectric", "refraction_index": index, **more}


def lamp(emit=LIGHT):
    return {"type": "diffuse_light", "emit": list(emit)}


def sphere(center, radius, material):
    return {"center": list(center), "radius": radius, "material": material}


def document(materials, spheres, eye, at, depth=50, background=BLACK, **more):
    across = min(((abs(unit(add(at, scale(-1, eye)))[a]), a) for a in range(3)))[1]
    return {"camera": {"image_width": SIDE, "aspect_ratio": 1, "vfov": NARROW, "pixel_sampling": "center", "max_depth": depth,
                       "samples_per_pixel": 1024, "lookfrom": list(eye), "lookat": list(at),
                       "vup": [float(a == across) for a in range(3)]},
            "background": list(background), "materials": materials, "spheres": spheres, **more}


def on_unit_sphere(materials, others, view=None, depth=50, **more):
    """The scene around a unit sphere of material `receiver`, seen at the point POINT_NORMAL from near by."""
    eye = add(POINT_NORMAL, scale(0.05, view or towards(0.6, PI)))
    return document(materials, [sphere(BLACK, 1, "receiver"), *others], eye, POINT_NORMAL, depth, **more)


def lamp_at(omega, distance, radius, azimuth=0.0, material="lamp"):
    return sphere(add(POINT_NORMAL, scale(distance, towards(omega, azimuth))), radius, material)


def lit(share, light=LIGHT, albedo=ALBEDO):
    return tuple(a * e * share for a, e in zip(albedo, light))


def found_by_chance(share):
    """Whether paths meet the lamp often enough that their number is nearly normal."""
    return share > 0.004


def simple(omega, distance, radius, receiver=None, light=LIGHT, **more):
    materials = {"receiver": receiver or lambertian(), "lamp": lamp(light)}
    return on_unit_sphere(materials, [lamp_at(omega, distance, radius)], **more)


# ---- the cases, by their numbers -----------------------------------------------------------------------------

def case_01(_):
    """A lone convex receiver under a black sky."""
    for omega, distance, radius in ((0.0, 3, 1), (0.3, 2, 1.9), (0.7, 3, 1), (1.0, 2, 0.2), (0.5, 50, 1), (0.5, 50, 20)):
        share = forms.irradiance(math.asin(radius / distance), omega)
        yield Case(f"lamp at {omega}, radius {radius} at {distance}", simple(omega, distance, radius), lit(share), sent=1,
                   chance=found_by_chance(share), deep=omega not in (0.3, 0.7))


def case_02(_):
    """The same, the lamp cut by the horizon."""
    for omega, distance, radius in ((1.2, 2, 1.2), (PI / 2, 3, 1), (1.9, 2, 1.5), (1.65, 10, 1), (1.55, 3, 0.3)):
        share = forms.irradiance(math.asin(radius / distance), omega)
        yield Case(f"lamp at {omega:.2f}, radius {radius} at {distance}", simple(omega, distance, radius), lit(share),
                   chance=found_by_chance(share), deep=omega not in (1.2, 1.9))


def case_03(_):
    """The other matte lobes."""
    for omega, distance, radius in ((0.0, 3, 1), (0.9, 3, 1.2), (0.5, 30, 1)):
        sigma = math.asin(radius / distance)
        for name, share in (("cosine_cubed", forms.cosine_cubed(sigma, omega)), ("hemisphere", forms.hemisphere(sigma))):
            yield Case(f"{name}, lamp at {omega}, half angle {sigma:.2f}",
                       simple(omega, distance, radius, lambertian(scatter=name)), lit(share),
                       chance=found_by_chance(share), deep=omega != 0.9)


def case_04(_):
    """The depth: 0 is black, 1 sees lamps, 2 has direct light; and the interreflections of a closed shell."""
    share = forms.irradiance(math.asin(1 / 3), 0.7)
    for depth in (0, 1, 2):
        yield Case(f"receiver, depth {depth}", simple(0.7, 3, 1, depth=depth), lit(share) if depth == 2 else BLACK,
                   exact=depth < 2, samples=1024 if depth == 2 else 16)
        lamp_center = lamp_at(0.7, 3, 1)["center"]
        scene = simple(0.7, 3, 1, depth=depth)
        scene["camera"]["lookat"] = lamp_center
        yield Case(f"lamp itself, depth {depth}", scene, LIGHT if depth > 0 else BLACK, exact=True,
                   samples=16, deep=depth != 1)
    # A shell of radius 2 around a lamp of radius 0.5: each point sees the lamp with a share of 1/16 and else the shell.
    shell = document({"shell": lambertian(), "lamp": lamp()}, [sphere(BLACK, 2, "shell"), sphere(BLACK, 0.5, "lamp")],
                     (0, 0, 1.5), (1.2, 0, 1.6))
    for depth in (2, 3, 4, 50):
        radiance = BLACK
        for _ in range(depth - 1):
            radiance = tuple(a * (e / 16 + b * 15 / 16) for a, e, b in zip(ALBEDO, LIGHT, radiance))
        scene = {**shell, "camera": {**shell["camera"], "max_depth": depth}}
        yield Case(f"shell around a lamp, depth {depth}", scene, radiance,
                   samples=4096 if depth == 3 else 1024, deep=depth in (2, 4))


def case_05(_):
    """A lamp of a thousandth of the radius and a million times the radiance."""
    for shrink in (1e-1, 1e-3, 1e-5):
        sigma = math.asin(shrink / 3)
        light = scale(shrink ** -2, LIGHT)
        yield Case(f"radius x {shrink}", simple(0.7, 3, shrink, light=light), lit(forms.irradiance(sigma, 0.7), light),
                   chance=False, deep=shrink != 1e-3)


def case_06(_):
    """Lamps that float directions miss: half angles of 1e-5 to 1e-9."""
    for s in (1e-5, 1e-6, 1e-7, 1e-8, 1e-9):
        light = (1e12, 1e12, 1e12)
        yield Case(f"half angle {s}", simple(0.7, 1e3, 1e3 * s, light=light),
                   lit(s * s * math.cos(0.7), light), chance=False, rounding=1e-3 if s < 1e-8 else 2e-5,
                   deep=s not in (1e-5, 1e-7, 1e-9))


def case_07(_):
    """A half angle whose square underflows: nothing, and no NaN."""
    yield Case("half angle 1e-24", simple(0.7, 1e12, 1e-12, light=(1e12, 1e12, 1e12)), BLACK, exact=True, samples=64)


def furnace_radiance():
    return (1.0, 0.5, 0.25)


def furnace(view, receiver, receiver_at=(0, 0, 0)):
    radiance = furnace_radiance()

    def balanced(kind, albedo, **more):
        emit = [b * (1 - a) for a, b in zip(albedo, radiance)]
        return {"type": kind, "albedo": list(albedo), "emit": emit, **more}

    materials = {
        "shell": balanced("lambertian", (0.6, 0.5, 0.4)), "lamp": lamp(radiance),
        "matte": balanced("lambertian", ALBEDO), "cubed": balanced("lambertian", ALBEDO, scatter="cosine_cubed"),
        "even": balanced("lambertian", ALBEDO, scatter="hemisphere"), "glass": glass(),
        "mirror": balanced("metal", ALBEDO, fuzz=0), "sphere fuzz": balanced("metal", ALBEDO, fuzz=0.4),
        "ball fuzz": balanced("metal", ALBEDO, fuzz=0.4, fuzz_shape="ball")}
    spheres = [sphere(BLACK, 6, "shell"), sphere((2, 2, 0), 0.8, "lamp"), sphere((-2, 2, 1), 0.3, "lamp")]
    if receiver != "shell":
        spheres += [sphere(receiver_at, 1, receiver)]
    # What fuzz absorbs is not in balance, but the reflections straight out are, if they never come back.
    if receiver != "shell" and "fuzz" not in receiver:
        spheres += [sphere((1.2, -1.6, 1.4), 0.7, "glass"), sphere((-1.8, -1.2, 1.2), 0.7, "mirror"),
                    sphere((0.2, 0.6, 2.2), 0.5, "cubed")]
    used = {each["material"] for each in spheres}
    eye = scale(1.2, unit(view))
    at = scale(1.0, unit(view)) if receiver != "shell" else scale(6.0, unit(view))
    if "fuzz" in receiver:
        materials["shell"] = balanced("lambertian", BLACK)
    return document({name: m for name, m in materials.items() if name in used}, spheres, eye, at, depth=200)


def case_08(_):
    """A furnace in balance: every surface gives and passes on the same radiance."""
    view = (0.6, 0.5, 0.4)
    for receiver in ("shell", "matte", "cubed", "even", "glass", "mirror", "sphere fuzz", "ball fuzz"):
        yield Case(f"furnace, {receiver}", furnace(view, receiver), furnace_radiance(), samples=256, deep=receiver not in ("shell", "cubed", "glass", "ball fuzz"))


def case_09(_):
    """An emissive shell seen from inside is never sampled."""
    materials = {"receiver": lambertian(), "shell": lamp()}
    inside = [sphere((0.3, 0.1, 0), 5, "shell")]
    yield Case("shell around everything", on_unit_sphere(materials, inside), lit(1), bits=True, samples=64)
    outside = inside + [sphere((20, 0, 0), 1, "receiver")]
    yield Case("shell around the receiver", on_unit_sphere(materials, outside), lit(1), bits=True, samples=64)


def case_10(_):
    """The camera inside a lamp."""
    scene = document({"receiver": lambertian(), "lamp": lamp()},
                     [sphere((0, 0, 0), 1, "lamp"), sphere((5, 0, 0), 1, "receiver")], (0.1, 0, 0), (1, 0.2, 0.3))
    yield Case("camera inside a lamp", scene, LIGHT, exact=True, samples=16)


def case_11(_):
    """A point inside one lamp and outside another, which lies in the first too."""
    materials = {"receiver": lambertian(), "shell": lamp((0.5, 1.0, 2.0)), "lamp": lamp((9.0, 3.0, 1.0))}
    others = [sphere((0.3, 0.1, 0), 8, "shell"), lamp_at(0.7, 3, 1), sphere((20, 0, 0), 1, "receiver")]
    share = forms.irradiance(math.asin(1 / 3), 0.7)
    light = tuple(inner * share + outer * (1 - share) for inner, outer in zip((9.0, 3.0, 1.0), (0.5, 1.0, 2.0)))
    yield Case("inside one, outside another", on_unit_sphere(materials, others), lit(1, light))


def case_12(_):
    """A lamp that touches the floor, near the contact: it fills the sky there."""
    for floor, offset in ((1, 0.3), (1, 0.05), (1000, 0.05), (1000, 0.01)):
        angle = offset / floor
        normal = (math.sin(angle), math.cos(angle), 0.0)
        # the floor's top is the origin, where the lamp of radius 1 stands on it
        point = (floor * math.sin(angle), -2 * floor * math.sin(angle / 2) ** 2, 0.0)
        to_lamp = add((0, 1, 0), scale(-1, point))
        distance = math.sqrt(dot(to_lamp, to_lamp))
        omega = math.acos(dot(to_lamp, normal) / distance)
        # below the lamp, along the line that leaves the gap between floor and lamp
        eye = add(point, scale(0.5 * offset, unit((1, 0.6 * offset, 0))))
        scene = document({"floor": lambertian(), "lamp": lamp()},
                         [sphere((0, -floor, 0), floor, "floor"), sphere((0, 1, 0), 1, "lamp")], eye, point)
        yield Case(f"floor of {floor}, {offset} from the contact", scene,
                   lit(forms.irradiance(math.asin(1 / distance), omega)), deep=floor == 1)


def case_13(_):
    """Overlapping lamps."""
    materials = {"receiver": lambertian(), "lamp": lamp(), "other": lamp((1.0, 6.0, 2.0))}
    others = [lamp_at(0.5, 3, 1), lamp_at(0.7, 3.2, 1, 0.2, "other"), lamp_at(0.6, 2.5, 0.4, 0.1, "lamp")]
    yield Case("three overlapping lamps", on_unit_sphere(materials, others), samples=4096)
    inner = [lamp_at(0.5, 3, 1), lamp_at(0.5, 3, 0.5, material="other")]
    yield Case("a lamp inside a lamp", on_unit_sphere(materials, inner), lit(forms.irradiance(math.asin(1 / 3), 0.5)))


def case_14(_):
    """Coincident spheres: the first in the scene wins."""
    materials = {"receiver": lambertian(), "lamp": lamp(), "black": lambertian(BLACK), "other": lamp((1.0, 6.0, 2.0))}
    share = forms.irradiance(math.asin(1 / 3), 0.5)
    ordinary, twin, other = (lamp_at(0.5, 3, 1, material=name) for name in ("lamp", "black", "other"))
    yield Case("a matte twin before the lamp", on_unit_sphere(materials, [twin, ordinary]), BLACK, exact=True, samples=64)
    yield Case("a matte twin after the lamp", on_unit_sphere(materials, [ordinary, twin]), lit(share), deep=True)
    yield Case("two coincident lamps", on_unit_sphere(materials, [ordinary, other]), lit(share))
    yield Case("the other one first", on_unit_sphere(materials, [other, ordinary]), lit(share, (1.0, 6.0, 2.0)), deep=True)


def case_15(_):
    """A lamp in solid glass: lamp rays end at the glass, paths go through."""
    materials = {"receiver": lambertian(), "lamp": lamp(), "glass": glass()}
    others = [lamp_at(0.5, 3, 1.2), lamp_at(0.5, 3, 1.5, material="glass")]
    yield Case("lamp in glass", on_unit_sphere(materials, others), bits=True, samples=256)


def case_16(_):
    """Glass of index 1 before a lamp stops lamp rays and no path."""
    materials = {"receiver": lambertian(), "lamp": lamp(), "glass": glass(1)}
    share = forms.irradiance(math.asin(1 / 3), 0.5)
    around = [lamp_at(0.5, 3, 1), lamp_at(0.5, 3, 1.4, material="glass")]
    yield Case("around the lamp", on_unit_sphere(materials, around), lit(share), bits=True)
    before = [lamp_at(0.5, 3, 1), lamp_at(0.45, 1.2, 0.25, material="glass")]
    yield Case("before a part of the lamp", on_unit_sphere(materials, before), lit(share), samples=4096)
    eye = add(POINT_NORMAL, scale(0.05, towards(0.5)))
    seen = document(materials, [sphere(BLACK, 1, "receiver"), *around], eye, lamp_at(0.5, 3, 1)["center"])
    yield Case("between camera and lamp", seen, LIGHT, exact=True, samples=16)


def case_17(_):
    """Emissive glass: the first crossing can be sampled, the later ones cannot."""
    sigma = math.asin(1 / 3)
    materials = {"receiver": lambertian(), "lamp": glass(1, emit=list(LIGHT))}
    yield Case("index 1: two crossings", on_unit_sphere(materials, [lamp_at(0.5, 3, 1)]),
               lit(2 * forms.irradiance(sigma, 0.5)))
    materials = {"receiver": lambertian(), "lamp": glass(1.5, emit=list(LIGHT))}
    yield Case("index 1.5", on_unit_sphere(materials, [lamp_at(0.5, 3, 1)]), samples=4096, deep=True)


def case_18(_):
    """Two matte spheres that light each other."""
    materials = {"receiver": lambertian(emit=[0.5, 0.2, 0.1]), "lamp": lambertian((0.3, 0.6, 0.9), emit=[1.0, 2.0, 0.5])}
    yield Case("emissive matte pair", on_unit_sphere(materials, [lamp_at(0.4, 1.3, 1.2)]), samples=4096)


def case_19(_):
    """Light on a surface that shows its normal: the colour is no lamp, the light is."""
    emit, omega, distance, radius = (1.0, 0.2, 0.1), 0.5, 3.0, 1.0
    materials = {"receiver": lambertian(), "lamp": {"type": "normals", "emit": list(emit)}}
    center = add(POINT_NORMAL, scale(distance, towards(omega)))
    axis = towards(omega)
    tangent = unit(cross(axis, (1, 0, 0)))

    def seen(channel):
        def value(theta, phi):
            direction = towards(theta, phi, axis, tangent)
            along = distance * math.cos(theta)
            t = along - math.sqrt(max(0.0, radius ** 2 - (distance * math.sin(theta)) ** 2))
            point = add(POINT_NORMAL, scale(t, direction))
            normal = (point[channel] - center[channel]) / radius
            return (emit[channel] + 0.5 + 0.5 * normal) * max(0.0, dot(direction, POINT_NORMAL)) / PI
        return forms.over_cone(value, math.asin(radius / distance), 60, 60)

    yield Case("light on normals", on_unit_sphere(materials, [lamp_at(omega, distance, radius)]),
               tuple(a * seen(c) for c, a in enumerate(ALBEDO)), samples=4096)


def case_20(_):
    """A negative radius changes nothing."""
    scene = simple(0.7, 3, 1)
    turned = simple(0.7, 3, 1)
    for each in turned["spheres"]:
        each["radius"] = -each["radius"]
    yield Case("radii below 0", turned, lit(forms.irradiance(math.asin(1 / 3), 0.7)), like=scene)


def case_21(_):
    """A lamp below the horizon."""
    yield Case("below the horizon", simple(2.2, 4, 1), BLACK, exact=True, sent=0, samples=64)


def case_22(_):
    """A lamp wholly behind another."""
    materials = {"receiver": lambertian(), "lamp": lamp(), "behind": lamp((900.0, 900.0, 900.0))}
    others = [lamp_at(0.5, 3, 1), lamp_at(0.5, 8, 1, material="behind")]
    yield Case("behind another", on_unit_sphere(materials, others), lit(forms.irradiance(math.asin(1 / 3), 0.5)))
    materials["matte"] = lambertian(BLACK)
    others = [lamp_at(0.5, 3, 1, material="matte"), lamp_at(0.5, 8, 1, material="behind")]
    yield Case("behind a black ball", on_unit_sphere(materials, others), BLACK, exact=True, samples=64)


def fuzzy(fuzz, ball, up, around, distance, radius, azimuth=0.0):
    """Metal of a fuzz whose reflection R stands at the cosine `up` to the normal, and a lamp at the angle `around` from R."""
    tilt = math.acos(up)
    reflected = towards(tilt, 0)
    across = towards(tilt + PI / 2, 0)  # leans to the surface
    axis = add(scale(math.cos(around), reflected),
               scale(math.sin(around), add(scale(math.cos(azimuth), across), scale(math.sin(azimuth), SIDEWAYS))))
    materials = {"receiver": metal(fuzz, fuzz_shape="ball" if ball else "sphere"), "lamp": lamp()}
    return on_unit_sphere(materials, [sphere(add(POINT_NORMAL, scale(distance, axis)), radius, "lamp")],
                          view=towards(tilt, PI))


def case_23(_):
    """Metal of fuzz 1 is matte about its reflection; other fuzz has lobes of its own."""
    for up, around, azimuth in ((1.0, 0.7, 0.0), (0.7, 0.5, PI / 2), (0.5, 0.6, PI)):
        sigma = math.asin(1 / 3)
        for ball in (False, True):
            share = forms.cosine_cubed(sigma, around) if ball else forms.irradiance(sigma, around)
            yield Case(f"fuzz 1 {'in a ball' if ball else 'on a sphere'}, R at {up}, lamp {around} from R",
                       fuzzy(1, ball, up, around, 3, 1, azimuth), lit(share), deep=up != 0.7)
    for fuzz, around, radius in ((0.5, 0.3, 0.6), (0.1, 0.05, 0.2), (0.1, 0.15, 0.3), (1 / 64, 0.01, 0.03), (0.3, 0.2, 0.02)):
        for ball in (False, True):
            share = forms.fuzz_share(fuzz, ball, math.asin(radius / 3), around)
            yield Case(f"fuzz {fuzz:.3g} {'in a ball' if ball else 'on a sphere'}, lamp of {radius} at {around} from R",
                       fuzzy(fuzz, ball, 0.8, around, 3, radius, PI), lit(share),
                       chance=found_by_chance(share), deep=fuzz not in (0.5, 0.3))


def case_24(_):
    """A lamp that covers a whole lobe: what is not absorbed."""
    for fuzz, up, radius in ((0.3, 0.2, 2.0), (0.9, 0.5, 2.9), (1 / 64, 0.9, 0.6), (0.1, 0.05, 1.0)):
        for ball in (False, True):
            yield Case(f"fuzz {fuzz:.3g} {'in a ball' if ball else 'on a sphere'}, R at {up}",
                       fuzzy(fuzz, ball, up, 0, 3, radius), lit(1 - forms.fuzz_absorbed(fuzz, ball, up)),
                       deep=fuzz not in (0.3, 1 / 64))


def case_25(_):
    """Mirrors, and fuzz below 1/64, are not sampled."""
    for fuzz in (0, 0.015):
        scene = fuzzy(fuzz, False, 0.8, 0.01, 3, 0.05)
        yield Case(f"fuzz {fuzz} alone", scene, bits=True, samples=64, deep=fuzz == 0)
        beside = {**scene, "materials": {**scene["materials"], "matte": lambertian()},
                  "spheres": scene["spheres"] + [sphere(scale(-4, POINT_NORMAL), 1, "matte")]}
        yield Case(f"fuzz {fuzz} beside something matte", beside, bits=True, samples=64)


def case_26(_):
    """A mirror between floor and lamp, and one beside both."""
    materials = {"receiver": lambertian(), "lamp": lamp(), "mirror": metal(0, (0.9, 0.9, 0.9))}
    others = [lamp_at(0.2, 4, 1), lamp_at(0.1, 1.5, 0.3, material="mirror"), lamp_at(0.9, 1.5, 1, PI / 2, "mirror")]
    yield Case("mirrors", on_unit_sphere(materials, others), samples=4096)


def case_27(_):
    """Lamps of 1e12 and 1e-6 together, each in a channel of its own."""
    materials = {"receiver": lambertian(), "lamp": lamp((1e12, 0, 0)), "other": lamp((0, 1e-6, 0))}
    others = [lamp_at(0.5, 3, 1), lamp_at(0.6, 3, 1.2, PI / 2, "other")]
    first, second = forms.irradiance(math.asin(1 / 3), 0.5), forms.irradiance(math.asin(0.4), 0.6)
    yield Case("1e12 and 1e-6", on_unit_sphere(materials, others), (ALBEDO[0] * 1e12 * first, ALBEDO[1] * 1e-6 * second, 0))
    # The dim one covers a narrow lobe and the bright one a part of it: densities and probabilities at both ends.
    for ball in (False, True):
        scene = fuzzy(1 / 64, ball, 0.8, 0, 30, 25)
        scene["materials"].update(lamp=lamp((0, 1e-6, 0)), bright=lamp((1e12, 0, 0)))
        bright = fuzzy(1 / 64, ball, 0.8, 0.01, 3, 0.03, PI)["spheres"][1]
        scene["spheres"].append({**bright, "material": "bright"})
        share = forms.fuzz_share(1 / 64, ball, math.asin(0.01), 0.01)
        yield Case(f"1e12 and 1e-6, narrow lobe {'in a ball' if ball else 'on a sphere'}", scene,
                   (ALBEDO[0] * 1e12 * share, ALBEDO[1] * 1e-6 * (1 - share), 0))


def points_on_shell(count, center, radius):
    """`count` points on a sphere, spread like the seeds of a sunflower."""
    turn = PI * (3 - math.sqrt(5))
    numbers = array.array("f")
    for i in range(count):
        height = 1 - (2 * i + 1) / count
        ring = math.sqrt(1 - height * height)
        numbers.extend((center[0] + radius * ring * math.cos(turn * i), center[1] + radius * height,
                        center[2] + radius * ring * math.sin(turn * i)))
    return numbers


def ply(numbers):
    """A binary PLY of points."""
    if sys.byteorder == "big":
        numbers.byteswap()
    count = len(numbers) // 3
    return (f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n"
            f"property float z\nend_header\n").encode() + numbers.tobytes()


def case_28(folder):
    """Many equal lamps on a sparse shell, seen from outside: as all of them in its centre."""
    for count, deep in ((20000, False), (1000000, True)):
        center = scale(1, add(POINT_NORMAL, scale(4, towards(0.6))))
        name = f"shell-{count}.ply"
        radius = 1e-5
        light = scale(1e10 / count / 1000, LIGHT)
        scene = on_unit_sphere({"receiver": lambertian(), "lamp": lamp(light)}, [],
                               clouds=[{"file": name, "radius": radius, "material": "lamp"}])
        share = count * (radius / 4) ** 2 * math.cos(0.6)
        yield Case(f"{count} lamps on a shell", scene, lit(share, light), chance=False, deep=deep,
                   files={name: lambda n=count, c=center: ply(points_on_shell(n, c, 1.5))})
    del folder


def case_29(_):
    """A material whose light is 0 is no lamp."""
    materials = {"receiver": lambertian(), "lamp": lambertian(emit=[0, 0, 0]), "off": lamp(BLACK)}
    yield Case("light of 0", on_unit_sphere(materials, [lamp_at(0.5, 3, 1), lamp_at(0.5, 3, 1, 2, "off")],
                                            background=(0.3, 0.4, 0.5)), bits=True, samples=64)


def case_30(_):
    """Plain numerics."""
    for omega, distance, radius in ((0.7, 3, 1), (1.2, 2, 1.2)):
        sigma = math.asin(radius / distance)
        yield Case(f"plain numerics, lamp at {omega}", simple(omega, distance, radius), lit(forms.irradiance(sigma, omega)),
                   options=("--numerics", "plain"), deep=True)


def case_31(_):
    """Lamps outside a closed matte shell: it is dark inside."""
    for radius in (3, 1000):
        materials = {"receiver": lambertian(), "shell": lambertian(), "lamp": lamp(scale(1e6, LIGHT))}
        spheres = [sphere(BLACK, radius, "shell"), sphere((0, radius + 1.001, 0), 1, "lamp"),
                   sphere((radius + 0.1, 0, 0), 0.09, "lamp"), sphere((0.3, 0.2, 0), 0.5, "receiver")]
        wall = document(materials, spheres, (0, 0.99 * radius, 0), (0.01 * radius, radius, 0))
        yield Case(f"wall of {radius}", wall, BLACK, exact=True, samples=256, deep=radius != 3)
        inner = document(materials, spheres, (0.3, 2.2, 0), (0.4, 0.2, 0))
        yield Case(f"receiver inside {radius}", inner, BLACK, exact=True, samples=256, deep=True)


# ---- beyond those: the choice of a lamp, and what else shares the code ------------------------------------------

def many_lamps(count, spread, power):
    """Lamps of golden turns over the point, none before another, some cut by the horizon; what they give."""
    spheres, materials, total = [], {"receiver": lambertian()}, BLACK
    for i in range(count):
        omega = 0.1 + spread * math.sqrt((i + 0.5) / count)
        azimuth = PI * (3 - math.sqrt(5)) * i
        distance = 2 + 1.5 * (i * 7 % count) / count
        radius = distance * 0.35 / math.sqrt(count)
        light = tuple(power(i) * (1 + math.cos(i + 2 * c)) for c in range(3))
        materials[f"lamp{i}"] = lamp(light)
        spheres.append(lamp_at(omega, distance, radius, azimuth, f"lamp{i}"))
        total = add(total, lit(forms.irradiance(math.asin(radius / distance), omega), light))
    return on_unit_sphere(materials, spheres, view=towards(0.02, 1)), total


def case_32(_):
    """Several lamps: one node of the tree of lamps, and more."""
    for count, name, power in ((2, "equal", lambda i: 5), (3, "unequal", lambda i: 10 ** i),
                               (8, "equal", lambda i: 5), (9, "unequal", lambda i: 2 ** (i % 5)),
                               (40, "equal", lambda i: 20), (150, "unequal", lambda i: 100 * 3 ** (i % 6))):
        scene, total = many_lamps(count, 1.3, power)
        yield Case(f"{count} {name} lamps", scene, total, chance=False, deep=count not in (3, 150))


def case_33(_):
    """The point among lamps on all sides, half of them below its horizon."""
    count, light = 600, (300.0, 200.0, 100.0)
    numbers = points_on_shell(count, POINT_NORMAL, 6)
    expected = 0.0
    for i in range(count):
        to_lamp = add(tuple(numbers[3 * i:3 * i + 3]), scale(-1, POINT_NORMAL))
        distance = math.sqrt(dot(to_lamp, to_lamp))
        omega = math.acos(max(-1.0, min(1.0, dot(to_lamp, POINT_NORMAL) / distance)))
        expected += forms.irradiance(math.asin(0.05 / distance), omega)
    scene = on_unit_sphere({"receiver": lambertian(), "lamp": lamp(light)}, [],
                           clouds=[{"file": "around.ply", "radius": 0.05, "material": "lamp"}])
    yield Case("600 lamps around the point", scene, lit(expected, light), chance=False,
               files={"around.ply": lambda: ply(array.array("f", numbers))})


def case_34(_):
    """The same light by other ways of the program."""
    share = forms.irradiance(math.asin(0.3), 0.7)
    for options in (("--sampler", "independent"), ("--precision", "double"), ("--kernel", "sample"), ("--math", "fast")):
        yield Case(" ".join(options), simple(0.7, 2, 0.6), lit(share), options=options, deep=True)


def case_35(_):
    """Every surface gives light and scatters half of what it meets, so that paths are as bright as the sums allow for, just
    below a power of two; those that sampling makes brighter must still fit."""
    materials = {"ember": lambertian((0.5, 0.5, 0.5), emit=[0.4995, 0.2, 0.1])}
    spheres = [sphere(BLACK, 4, "ember"), sphere((1, 0, 0), 1, "ember"), sphere((-1, 0.5, 0), 1, "ember")]
    yield Case("embers in an ember", document(materials, spheres, (0, 0.3, 2.4), (0.4, 0.2, 0), depth=60), (0.999, 0.4, 0.2), samples=256)


NUMBERED = {int(name[-2:]): function for name, function in sorted(globals().items()) if name.startswith("case_")}
