"""Small whole pictures with lamps, to be drawn with sampling and without.

In:    the folder of the sources.   Out: scene documents by name: those of scenes/ and tests/agree/scenes that have a lamp,
       and generated ones, each crowded with what light sampling must get right.
Knows: the scene's grammar.   Does not know: the program.
"""
import json
import math
import pathlib
import random

from cases import BLACK, glass, lambertian, lamp, metal, sphere

FLOOR = sphere((0, -1000, 0), 1000, "floor")
NORMALS = {"type": "normals"}


def picture(materials, spheres, depth=20, background=BLACK, **camera):
    return {"camera": {"image_width": 24, "aspect_ratio": [3, 2], "samples_per_pixel": 256, "max_depth": depth, "vfov": 40,
                       "lookfrom": [0, 2, 8], "lookat": [0, 0.8, 0], **camera},
            "background": list(background), "materials": materials, "spheres": spheres}


def lobes(draw):
    """Every matte lobe beside each other, under three lamps."""
    del draw
    return picture({"floor": lambertian((0.6, 0.6, 0.5)), "a": lambertian((0.8, 0.3, 0.2)),
                    "b": lambertian((0.3, 0.8, 0.3), scatter="cosine_cubed"), "c": lambertian((0.3, 0.3, 0.8), scatter="hemisphere"),
                    "x": lamp((9, 6, 3)), "y": lamp((2, 4, 20))},
                   [FLOOR, sphere((-1.8, 0.8, 0), 0.8, "a"), sphere((0, 0.8, 0), 0.8, "b"), sphere((1.8, 0.8, 0), 0.8, "c"),
                    sphere((-1, 3, 1.5), 0.5, "x"), sphere((2.4, 2.4, -1), 0.4, "x"), sphere((0.9, 0.3, 1.8), 0.25, "y")])


def metals(draw):
    """Fuzz of both shapes, below and above the bound, and mirrors."""
    del draw
    materials = {"floor": lambertian((0.3, 0.3, 0.3)), "x": lamp((9, 6, 3)), "y": lamp((2, 4, 20))}
    spheres = [FLOOR, sphere((-1, 3, 1.5), 0.5, "x"), sphere((2.4, 2.4, 3), 0.4, "y")]
    for i, (fuzz, shape) in enumerate(((0, "sphere"), (0.015, "sphere"), (0.05, "sphere"), (0.3, "ball"), (0.7, "sphere"),
                                       (1, "ball"), (1, "sphere"))):
        materials[f"m{i}"] = metal(fuzz, (0.9, 0.8, 0.7), fuzz_shape=shape)
        spheres.append(sphere((-2.7 + 0.9 * i, 0.45, 0.8 * (i % 2)), 0.45, f"m{i}"))
    return picture(materials, spheres)


def caustics(draw):
    """Solid and hollow glass, and glass of index 1, between lamps and floor."""
    del draw
    return picture({"floor": lambertian((0.6, 0.6, 0.5)), "glass": glass(), "air": glass(1 / 1.5), "nothing": glass(1),
                    "x": lamp((9, 6, 3))},
                   [FLOOR, sphere((-1.6, 0.7, 0), 0.7, "glass"), sphere((0.2, 0.7, 0), 0.7, "glass"), sphere((0.2, 0.7, 0), 0.6, "air"),
                    sphere((1.9, 0.7, 0), 0.7, "nothing"), sphere((0, 3, 1), 0.8, "x"), sphere((1.9, 0.7, 0), 0.3, "x")])


def sunken(draw):
    """Lamps that stand on the floor, in it, in each other and in a wall."""
    del draw
    return picture({"floor": lambertian((0.6, 0.6, 0.5)), "wall": lambertian((0.5, 0.2, 0.2)), "x": lamp((3, 2, 1)),
                    "y": lamp((0.5, 1, 3))},
                   [FLOOR, sphere((0, 0, -52), 50, "wall"), sphere((-1.5, 0.5, 0), 0.5, "x"), sphere((0, 0, 0), 0.5, "y"),
                    sphere((1.5, 0.4, 0), 0.6, "x"), sphere((1.8, 0.6, 0.2), 0.6, "y"), sphere((0.3, 1.4, -2), 0.6, "x"),
                    sphere((-1.5, 0.5, 1.2), 0.5, "wall")])


def embers(draw):
    """Nothing but surfaces that give light and scatter it."""
    materials = {}
    spheres = []
    for i in range(14):
        emit = [draw.random() * 0.5 for _ in range(3)]
        kind = (lambertian((0.7, 0.6, 0.5), emit=emit), lambertian((0.4, 0.6, 0.8), emit=emit, scatter="hemisphere"),
                metal(0.4, (0.9, 0.9, 0.9), emit=emit), metal(0, (0.9, 0.9, 0.9), emit=emit), glass(1.5, emit=emit),
                {"type": "normals", "emit": emit})[i % 6]
        materials[f"m{i}"] = kind
        spheres.append(sphere([draw.uniform(-2.5, 2.5), draw.uniform(0, 2), draw.uniform(-2, 2)], draw.uniform(0.3, 0.8), f"m{i}"))
    return picture(materials, spheres)


def crowd(draw):
    """A tree of spheres, lamps among them."""
    materials = {"floor": lambertian((0.5, 0.5, 0.5)), "matte": lambertian((0.7, 0.5, 0.3)), "fuzzy": metal(0.3, (0.8, 0.8, 0.9)),
                 "glass": glass(), "x": lamp((9, 6, 3)), "y": lamp((2, 4, 12))}
    spheres = [FLOOR]
    for i in range(60):
        radius = draw.uniform(0.1, 0.4)
        spheres.append(sphere([draw.uniform(-3, 3), radius + draw.choice((0, draw.uniform(0, 2))), draw.uniform(-3, 3)], radius,
                              ("matte", "fuzzy", "glass", "matte", "x", "y")[i % 6]))
    return picture(materials, spheres)


def sparks(draw):
    """Some hundred small lamps over a floor."""
    materials = {"floor": lambertian((0.5, 0.5, 0.5)), "matte": lambertian((0.7, 0.5, 0.3)), "fuzzy": metal(0.2, (0.8, 0.8, 0.9)),
                 "x": lamp((40, 25, 10)), "y": lamp((10, 20, 60))}
    spheres = [FLOOR, sphere((-1.3, 0.9, 0), 0.9, "matte"), sphere((1.3, 0.9, 0), 0.9, "fuzzy")]
    for i in range(300):
        spheres.append(sphere([draw.uniform(-4, 4), draw.uniform(0.05, 3), draw.uniform(-4, 4)], 0.05, "xy"[i % 2]))
    return picture(materials, spheres)


def shallow(draw):
    """A depth of 3: the last allowed vertex is reached everywhere."""
    scene = lobes(draw)
    scene["camera"]["max_depth"] = 3
    return scene


def room(draw):
    """A closed room with small lamps, bright and dim: much light comes by several bounces."""
    del draw
    return picture({"wall": lambertian((0.75, 0.7, 0.6)), "matte": lambertian((0.2, 0.5, 0.8)), "x": lamp((30, 20, 10)),
                    "y": lamp((0.5, 1, 3))},
                   [sphere((0, 0, 0), 9, "wall"), sphere((0, 0.8, 0), 0.8, "matte"), sphere((3, 4, 0), 0.3, "x"),
                    sphere((-3, 1, 1), 0.9, "y")], depth=12)


def twins(draw):
    """Coincident spheres, negative radii, a light of 0."""
    scene = lobes(draw)
    scene["materials"]["dark"] = lamp(BLACK)
    more = [dict(each) for each in scene["spheres"][1:]]
    for each, material in zip(more, ("x", "dark", "a", "y", "b", "x")):
        each["material"], each["radius"] = material, -each["radius"]
    scene["spheres"] += more
    return scene


def inside(draw):
    """The camera in a lamp that holds the scene, with another lamp and glass that gives light."""
    scene = lobes(draw)
    scene["materials"].update(shell=lamp((0.2, 0.3, 0.4)), ember=glass(1.5, emit=[0.5, 0.2, 0.1]))
    scene["spheres"] += [sphere((0, 0, 0), 30, "shell"), sphere((0.9, 1.9, 1), 0.5, "ember"), sphere((0, 60, 0), 8, "a")]
    return scene


def sun(draw):
    """A huge lamp far away, and one that fills half the sky."""
    scene = lobes(draw)
    scene["materials"].update(sun=lamp((25, 22, 20)), moon=lamp((0.1, 0.1, 0.3)))
    scene["spheres"] = scene["spheres"][:4] + [sphere((1e8, 2e8, 1e8), 1e7, "sun"), sphere((-30, 15, 10), 25, "moon")]
    scene["background"] = [0.05, 0.1, 0.2]
    return scene


def resized(factor):
    def make(draw):
        scene = crowd(draw)
        scene["spheres"] = [dict(each) for each in scene["spheres"]]  # the floor is that of all scenes
        for each in scene["spheres"]:
            each["center"], each["radius"] = [factor * x for x in each["center"]], factor * each["radius"]
        for name in ("lookfrom", "lookat"):
            scene["camera"][name] = [factor * x for x in scene["camera"][name]]
        scene["camera"]["focus_dist"] = factor
        return scene
    return make


def lens(draw):
    """A wide lens, a sky with a gradient."""
    scene = crowd(draw)
    scene["camera"].update(defocus_angle=8, focus_dist=8)
    scene["background"] = {"bottom": [0.1, 0.05, 0.02], "top": [0.02, 0.05, 0.2]}
    return scene


def spread(draw):
    """Lamps of very different power, far apart, some hidden."""
    materials = {"floor": lambertian((0.5, 0.5, 0.5)), "matte": lambertian((0.7, 0.5, 0.3)),
                 "even": lambertian((0.4, 0.6, 0.6), scatter="hemisphere")}
    spheres = [FLOOR, sphere((-1.3, 0.9, 0), 0.9, "matte"), sphere((1.3, 0.9, 0), 0.9, "even")]
    for i in range(24):
        materials[f"x{i}"] = lamp([10 ** draw.uniform(-1, 2.5) for _ in range(3)])
        distance = 10 ** draw.uniform(0.2, 1.5)
        turn = draw.uniform(0, 2 * math.pi)
        spheres.append(sphere([distance * math.cos(turn), draw.uniform(-0.5, 3), distance * math.sin(turn)],
                              distance * draw.uniform(0.01, 0.06), f"x{i}"))
    return picture(materials, spheres)


def walls(draw):
    """Lamps behind a closed wall, and a gap in it."""
    del draw
    return picture({"floor": lambertian((0.6, 0.6, 0.5)), "wall": lambertian((0.5, 0.5, 0.5)), "x": lamp((30, 20, 10))},
                   [FLOOR, sphere((-1.5, 1, 0), 1.2, "wall"), sphere((-1.5, 1, 0), 0.5, "x"), sphere((1, 1.2, -1), 1, "wall"),
                    sphere((2.4, 1.2, -3), 0.7, "x"), sphere((1, 0.6, 1.5), 0.1, "x")])


def disc(direction, half_angle, radiance, **more):
    return {"direction": list(direction), "half_angle": half_angle, "radiance": list(radiance), **more}


def soft_boxes(draw):
    """A sun, a soft box and a wide glow, which overlap, over every lobe; and a lamp."""
    scene = lobes(draw)
    scene["spheres"] = scene["spheres"][:5] + [sphere((0.9, 0.3, 1.8), 0.25, "steel"), sphere((-0.9, 0.3, 1.8), 0.3, "glass")]
    scene["materials"].update(steel=metal(0.2, (0.9, 0.8, 0.7)), glass=glass())
    scene["background"] = {"bottom": [0.1, 0.05, 0.02], "top": [0.02, 0.05, 0.2],
                           "discs": [disc((1, 2, 1), 5, (60, 50, 40)), disc((-2, 1, 1), 20, (1, 2, 4), visible_to_camera=False),
                                     disc((1, 1.5, 1), 40, (0.3, 0.6, 0.3)), disc((0, 0.1, -1), 30, (0.5, 0.2, 0.1))]}
    return scene


def many_discs(draw):
    """As many discs as there may be, and a crowd of spheres with lamps among them."""
    scene = crowd(draw)
    scene["background"] = {"bottom": [0, 0, 0], "top": [0.1, 0.1, 0.1], "discs": [
        disc([draw.gauss(0, 1) for _ in range(3)], 10 ** draw.uniform(0.3, 1.6), [10 ** draw.uniform(-1.5, 1) for _ in range(3)],
             visible_to_camera=i % 3 > 0) for i in range(32)]}
    return scene


def moving(draw):
    """A crowd of which half moves, lamps and others, some far."""
    scene = crowd(draw)
    scene["spheres"] = [FLOOR] + [dict(each) for each in scene["spheres"][1:]]
    for i, each in enumerate(scene["spheres"][1:]):
        if i % 4 < 2 or each["material"] == "y":
            each["center_end"] = [x + draw.gauss(0, 1) * draw.choice((0.1, 1)) for x in each["center"]]
    return scene


def swift(draw):
    """Lamps that rush past, and one that falls through the floor."""
    scene = lobes(draw)
    ends = [(3, 1, 1.5), (-3, 2.4, -1), (0.9, -0.6, 1.8)]
    scene["spheres"] = scene["spheres"][:4] + [{**each, "center_end": list(end)} for each, end in zip(scene["spheres"][4:], ends)]
    scene["spheres"].append({**sphere((2, 3, -1), 0.5, "b"), "center_end": [-2, 3, 0]})
    return scene


def smoke(draw):
    """Boundaries that are nested, touch and overlap, lamps inside, outside and between, a boundary that moves, glass with ink."""
    scene = lobes(draw)
    scene["materials"].update(edge={"type": "interface"}, glass=glass(1.3))
    scene["media"] = {"smoke": {"scattering": [1.5, 1, 0.5], "absorption": 0.2, "anisotropy": 0.5}, "ink": {"absorption": [0, 1, 2]},
                      "mist": {"scattering": 0.2, "anisotropy": -0.3}}

    def filled(center, radius, interior, material="edge", **more):
        return {**sphere(center, radius, material), **({"interior": interior} if interior else {}), **more}

    scene["spheres"] += [filled((0, 0.8, 1.6), 0.8, "smoke"), filled((0.2, 0.8, 1.6), 0.4, None), filled((-1, 3, 1.5), 0.9, "mist"),
                         filled((-1, 2.6, 1.5), 0.5, "ink"), filled((1.5, 2, 0), 0.5, "ink"), filled((1.5, 1.7, 0.6), 0.4, "smoke"),
                         filled((2.4, 2.4, -1), 0.4, "mist"), filled((-2.2, 0.6, 1.5), 0.4, "ink", "glass"),
                         filled((-0.6, 0.5, 2.6), 0.3, "smoke", center_end=[0.6, 0.9, 2.6])]
    return scene


def misty(draw):
    """All of it, camera too, in a ball of mist, under a disc; few segments, of which boundaries take some."""
    scene = smoke(draw)
    scene["camera"]["max_depth"] = 7
    scene["spheres"].append({**sphere((0, 1, 2), 9, "edge"), "interior": "mist"})
    scene["background"] = {"bottom": [0.05, 0.05, 0.05], "top": [0.05, 0.1, 0.2], "discs": [disc((1, 2, 1), 12, (5, 4, 3))]}
    return scene


# Images around scenes whose light varies so much that rays are sent to where it is bright.
VARIED_SKIES = ("street.exr", "sun.pfm", "texel.pfm")

GENERATED = {"lobes": lobes, "metals": metals, "caustics": caustics, "sunken": sunken, "embers": embers, "crowd-of-lamps": crowd,
             "sparks": sparks, "shallow": shallow, "room": room, "twins": twins, "inside": inside, "sun": sun,
             "crowd-x1e6": resized(1e6), "crowd-x1e-6": resized(1e-6), "lens": lens, "spread": spread, "walls": walls,
             "soft-boxes": soft_boxes, "many-discs": many_discs, "moving": moving, "swift": swift, "smoke": smoke, "misty": misty}


def generated(name):
    return GENERATED[name](random.Random(name))


def emission(scene, material):
    """Of a texture, the brightest of each channel: between its colours it mixes. Images of light are brighter than a sky."""
    emit = material.get("emit", BLACK)
    if isinstance(emit, dict):
        if scene["textures"][emit["texture"]]["type"] == "image":
            return [math.inf] * 3
        colors = [[c] * 3 if isinstance(c, (int, float)) else c for c in scene["textures"][emit["texture"]]["colors"]]
        return [max(channel) for channel in zip(*colors)]
    return emit


def outshone(scene, used):
    def luminance(colour):
        return sum(w * x for w, x in zip((0.2126, 0.7152, 0.0722), colour))

    sky = scene.get("background", {})
    ends = [sky.get("bottom", [1, 1, 1]), sky.get("top", [0.5, 0.7, 1.0])] if isinstance(sky, dict) else [sky]
    camera = scene["camera"].get("lookfrom", [0, 0, 0])
    return (max(luminance(emission(scene, each)) for each in used) <= min(map(luminance, ends))
            and all(math.dist(camera, each["center"]) >= abs(each["radius"]) for each in scene["spheres"]))


def fuzzy(fuzz):
    return isinstance(fuzz, dict) or fuzz >= 1 / 64


def scatters(scene, name):
    density = scene["media"][name].get("scattering", 0) if name else 0
    return max(density) > 0 if isinstance(density, list) else density > 0


def has_lamp(scene):
    """Something emits that does not hold all others, something matte or fuzzy or a medium is there to be
    lit, and the sky is not as bright as every lamp, as far as the camera stands in no sphere that may hide it."""
    spheres = scene.get("spheres", [])
    used = [scene["materials"][each["material"]] for each in spheres]
    lamps = [each for each, material in zip(spheres, used) if sum(emission(scene, material)) > 0]

    def holds(shell, other):
        return math.dist(shell["center"], other["center"]) + abs(other["radius"]) <= abs(shell["radius"])

    background = scene.get("background", {})
    around = background.get("image") if isinstance(background, dict) else None
    discs = background.get("discs", []) if isinstance(background, dict) else []
    discs = discs + [image for image in VARIED_SKIES if image == around]
    flat = [scene["materials"][each["material"]] for member in ("triangles", "quads", "boxes") for each in scene.get(member, [])]
    if not flat:
        lamps = [each for each in lamps if len(spheres) < 2 or not all(each is other or holds(each, other) for other in spheres)]
    lamps += [each for each in flat if sum(emission(scene, each)) > 0]
    lit = (any(each["type"] == "lambertian" or fuzzy(each.get("fuzz", 0)) for each in used + flat)
           or any(scatters(scene, name) for name in [scene.get("medium"), *(each.get("interior") for each in spheres)]))
    return bool(lamps or discs) and lit and (bool(discs or flat) or not outshone(scene, used))


def in_files(source):
    """Every scene of the repository that has a lamp, and one that has none, by name: two lists of paths."""
    paths = sorted([*pathlib.Path(source, "scenes").glob("*.json"), *pathlib.Path(source, "tests/agree/scenes").glob("*.json")])
    scenes = [(path, json.loads(path.read_text())) for path in paths if path.name != "scene.schema.json"]
    lit = [path for path, scene in scenes if has_lamp(scene)]
    return lit, [path for path, _ in scenes if path not in lit]
