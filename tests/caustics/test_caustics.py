#!/usr/bin/env python3
"""Light through balls of glass and off mirrors, sampled: closed forms, and the same mean as by chance.

usage: test_caustics.py PROGRAM SOURCE_DIR [--deep | CASE...]
       test_caustics.py PROGRAM SOURCE_DIR --kept-chance CASE...     takes what chance finds from by_chance.json
       test_caustics.py PROGRAM SOURCE_DIR --keep-chance CASE...     writes it there

Where chance is the judge, most of the time goes into its pictures, and they are the same bits each time. Whoever changes only how
directions are sampled, as known bugs do (tests/mutants), takes the means from the file. Otherwise they are found anew, and must be
those of the file.

A sun of a twentieth of a degree stands in the zenith, and a ball above a matte floor. Rays are parallel, so each circle of them,
of impact parameter b, falls on a circle of the floor of radius x(b), and the floor's irradiance is that of the sun times the
sum of b |db / dx| / |x| and of what the surfaces let through, over all b with |x(b)| = x: the map of rays. The paths are cut
where nothing else can add to it. These suns are so small that by chance a path finds one once in a million.
"""
import json
import math
import os
import statistics
import sys
import tempfile

from program_cases import OPTIONS, picture, run_cases
from pfm import read_pfm

KEPT = os.path.join(sys.argv[2], "tests/caustics/by_chance.json")

HALF = 0.05  # degrees
# The floor is a sphere of a radius that, like the camera's height above it, single precision holds exactly: its place matters.
ALBEDO = 0.5
SUN = 1e6
FLOOR = {"type": "lambertian", "albedo": [ALBEDO] * 3}
MIRROR = {"type": "metal", "albedo": [0.9, 0.6, 0.3]}


def glass(index=1.5, fresnel="none"):
    return {"type": "dielectric", "refraction_index": index, "fresnel": fresnel}


def document(ball, height, lookfrom, lookat, depth, discs=(), spheres=(), vfov=0.0005, background=0.0, **materials):
    return {"camera": {"image_width": 4, "aspect_ratio": 1, "max_depth": depth, "vfov": vfov, "lookfrom": lookfrom, "lookat": lookat},
            "background": {"bottom": [background] * 3, "top": [background] * 3, "discs": list(discs)},
            "materials": {"floor": FLOOR, "ball": ball, **materials},
            "spheres": [{"center": [0, -1024, 0], "radius": 1024, "material": "floor"},
                        {"center": [0, height, 0], "radius": 1, "material": "ball"}, *spheres]}


ZENITH = {"direction": [0, 1, 0], "half_angle": HALF, "radiance": [SUN] * 3}


def mean(scene, spp, *options):
    found = read_pfm(picture(scene, "--spp", str(spp), "--caustics", "on", *options))[2]
    return [sum(found[c::3]) / (len(found) // 3) for c in range(3)]


def fresnel(cosine, index):
    """Reflectance from outside, unpolarised."""
    other = math.sqrt(1 - (1 - cosine * cosine) / index ** 2)
    across, along = (cosine - index * other) / (cosine + index * other), (index * cosine - other) / (index * cosine + other)
    return (across * across + along * along) / 2


def landing(b, height, turn):
    """Where on the floor a ray of impact parameter b falls that has been turned towards the axis by an angle."""
    return b * math.cos(turn) - (height - b * math.sin(turn)) * math.tan(turn)


def through(index):
    return lambda b: 2 * (math.asin(b) - math.asin(b / index))


def mirrored(b):
    return 2 * math.asin(b) - math.pi


def irradiance(x, above, turn, share, low=1e-9, high=1 - 1e-9, steps=20000):
    """Over that of the sun: all circles of rays that fall at x, found by bisection between the points of a fine grid."""
    height = above + x * x / 2048  # the floor curves down

    def place(b):
        return landing(b, height, turn(b)) if abs(turn(b)) < math.pi / 2 and turn(b) != 0 else math.inf

    total = 0
    for side in (1, -1):
        last_b, last = None, None
        for i in range(steps + 1):
            b = low + (high - low) * i / steps
            off = place(b) - side * x
            if last is not None and math.isfinite(off) and math.isfinite(last) and off * last < 0:
                a, z, sign = last_b, b, last
                for _ in range(60):
                    middle = (a + z) / 2
                    if (place(middle) - side * x) * sign > 0:
                        a = middle
                    else:
                        z = middle
                root, h = (a + z) / 2, 1e-6
                slope = (place(root + h) - place(root - h)) / (2 * h)
                total += share(root) * root / abs(slope * x)
            last_b, last = b, off
    return total


def full_sun():
    return SUN * math.pi * math.sin(math.radians(HALF)) ** 2 * ALBEDO / math.pi


WORST = [0.0]


def close(found, wanted, allowed, what):
    WORST[0] = max(WORST[0], abs(found / wanted - 1))
    assert abs(found / wanted - 1) <= allowed, f"{what}: {found} instead of {wanted}, {found / wanted - 1:+.3%}"


def at_floor(ball, height, x, depth, spp, **options):
    """The radiance of the floor at a distance from the axis, seen from the side, below the ball."""
    return mean(document(ball, height, [x, 0.375, 6], [x, 0, 0], depth, [ZENITH], **options), spp)


def largest():
    return f"within {WORST[0]:.2%}"


def on_axis():
    """The power of a ball lens: paraxial rays meet at index / (2 (index - 1)) radii from its centre."""
    for height in (2.5, 4.0):
        wanted = full_sun() / (1 - height / 1.5) ** 2
        close(at_floor(glass(), height, 0.001, 4, 4096)[0], wanted, 0.002, f"on the axis, height {height}")
    return largest()


def across():
    """Points with one circle of rays and points with three."""
    for x, height in ((0.3, 4.0), (0.8, 4.0), (0.1, 1.6), (0.03, 2.0), (0.02, 1.2)):
        wanted = full_sun() * irradiance(x, height, through(1.5), lambda b: 1)
        close(at_floor(glass(), height, x, 4, 4096)[0], wanted, 0.003, f"x = {x}, height {height}")
    return largest()


def what_surfaces_let_through():
    """Fresnel's equations, at both surfaces."""
    for x, height in ((0.3, 4.0), (1.5, 4.0)):
        def share(b):
            return (1 - fresnel(math.sqrt(1 - b * b), 1.5)) ** 2

        wanted = full_sun() * irradiance(x, height, through(1.5), share)
        if x > 1:
            wanted += full_sun() * (1 + irradiance(x, height, mirrored, lambda b: fresnel(math.sqrt(1 - b * b), 1.5)))
        close(at_floor(glass(fresnel="exact"), height, x, 4, 8192)[0], wanted, 0.003, f"x = {x}")
    return largest()


def off_a_mirror():
    """The sun beside what a mirror adds to it, without its own share of the light."""
    for x, height in ((1.3, 1.2), (1.6, 1.2), (2.0, 1.2)):
        found = at_floor(MIRROR, height, x, 3, 4096)
        for c in range(3):
            added = found[c] - full_sun()
            wanted = full_sun() * MIRROR["albedo"][c] * irradiance(x, height, mirrored, lambda b: 1)
            close(added, wanted, 0.005, f"x = {x}, colour {c}")
    return largest()


def cut_by_depth():
    """A ray through a ball has three segments from the floor, and one before; one segment less, and the floor is dark."""
    assert at_floor(glass(), 4.0, 0.001, 3, 64)[0] == 0, "a chain that is too long"
    assert at_floor(glass(), 4.0, 0.001, 4, 64)[0] > 0, "no chain of the right length"
    beside = at_floor(MIRROR, 1.2, 1.3, 2, 64)[0]
    close(beside, full_sun(), 0.001, "without the mirror's light")


BLACK = {"type": "lambertian", "albedo": [0, 0, 0]}
AWAY = 5.0  # of the camera, in radii of the ball before it


def glints(ball, forward, lens=0.0, width=9, off=0, spheres=(), vfov=40, **materials):
    """A picture of nothing but a ball in the middle, and a sun behind the camera, or straight ahead and hidden by the ball. Something
    matte lies out of sight: without that, no rays are sent to lamps."""
    sun = {"direction": [off, 0, -1 if forward else 1], "half_angle": HALF, "radiance": [SUN] * 3}
    return {"camera": {"image_width": width, "aspect_ratio": 1, "max_depth": 8, "vfov": vfov, "lookfrom": [0, 0, AWAY], "lookat": [0, 0, 0],
                       "focus_dist": 3, "defocus_angle": lens},
            "background": {"bottom": [0] * 3, "top": [0] * 3, "discs": [sun]},
            "materials": {"ball": ball, "black": BLACK, **materials},
            "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "ball"}, {"center": [0, -50, 0], "radius": 1, "material": "black"},
                        *spheres]}


def glint(turn, share, width, vfov=40):
    """The radiance of the middle pixel: the sun is seen by the rays whose turn from the axis is less than its half angle, and those
    fill a cone about it. `turn`: of a ray that leaves the camera at an angle to the axis."""
    low, high = 0.0, 0.1
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if abs(turn(middle)) < math.radians(HALF) else (low, middle)
    side = 2 * math.tan(math.radians(vfov / 2)) / width
    return SUN * share * math.pi * math.tan(low) ** 2 / side ** 2


def reflected(angle):
    return 2 * math.asin(AWAY * math.sin(angle)) - angle


def refracted(index):
    def turn(angle):
        incidence = math.asin(AWAY * math.sin(angle))
        return angle - 2 * (incidence - math.asin(math.sin(incidence) / index))
    return turn


def reflected_inside(index):
    def turn(angle):
        incidence = math.asin(AWAY * math.sin(angle))
        return 2 * incidence - 4 * math.asin(math.sin(incidence) / index) - angle
    return turn


def glint_in_a_ball():
    """The sun in a mirror, through a ball of glass and on its far side: a patch far smaller than a pixel, in one pixel of many, which
    no sample finds by chance."""
    r0 = fresnel(1, 1.5)
    for what, ball, forward, wanted in (
            ("mirror", MIRROR, False, glint(reflected, MIRROR["albedo"][0], 9)), ("glass", glass(), True, glint(refracted(1.5), 1, 9)),
            ("glass, both sides", glass(fresnel="exact"), False, glint(reflected, r0, 9) + glint(reflected_inside(1.5), (1 - r0) ** 2 * r0, 9))):
        found = read_pfm(picture(glints(ball, forward), "--spp", "4096", "--caustics", "on"))[2][::3]
        middle = len(found) // 2
        close(found[middle], wanted, 0.005, what)
        if what != "glass, both sides":  # which has a ring close to the rim as well
            assert sum(found) - found[middle] < 1e-4 * wanted, f"{what}: light in other pixels, {sum(found) - found[middle]} beside {wanted}"
    return largest()


def glint_across_pixels():
    """Beside the axis the sum over a picture is the same for all sizes of pixels, with and without a lens."""
    for ball, forward, lens in ((MIRROR, False, 0), (MIRROR, False, 1), (glass(fresnel="exact"), True, 0)):
        sums = []
        for width in (8, 60):
            found = read_pfm(picture(glints(ball, forward, lens, width, 0.2), "--spp", str(16384 if width == 8 else 1024), "--caustics", "on"))[2][::3]
            sums.append(sum(found) / width ** 2)
        close(sums[0], sums[1], 0.02, f"8 and 60 pixels, {ball['type']}, lens {lens}")
    return largest()


def glint_aside():
    """The camera looks past the ball, so that the plane of its pixels is slanted: a cone of directions there fills more of it. Or the
    picture has four pixels, and the ball lies where they meet."""
    wide = glint(reflected, MIRROR["albedo"][0], 2, 60)
    for what, degrees, width, vfov, wanted in (("aside", 30, 40, 90, glint(reflected, MIRROR["albedo"][0], 40, 90)), ("four", 0, 2, 60, wide)):
        scene = glints(MIRROR, False, width=width, vfov=vfov)
        scene["camera"]["lookat"] = [AWAY * math.tan(math.radians(degrees)), 0, 0]
        found = read_pfm(picture(scene, "--spp", "4096", "--caustics", "on"))[2][::3]
        close(sum(found), wanted / math.cos(math.radians(degrees)) ** 3, 0.005, what)
    return largest()


def glint_hidden():
    """A black ball between the camera and the glint; the camera inside a ball of glass; parallel rays, which have no density."""
    black = [{"center": [0, 0, 2], "radius": 0.5, "material": "black"}]
    found = mean(glints(MIRROR, False, spheres=black), 256)
    assert found[0] == 0, f"seen through a black ball: {found}"
    around = [{"center": [0, 0, AWAY], "radius": 1, "material": "other"}]
    assert mean(glints(glass(), True, spheres=around, other=glass(1.2)), 256)[0] < 1, "rays begin inside of glass"
    parallel = glints(MIRROR, False)
    del parallel["camera"]["defocus_angle"]
    parallel["camera"]["projection"] = "orthographic"
    assert mean(parallel, 256)[0] == 0, "parallel rays, none of which sees this sun"


def same_seen(what, ball, lens, lamp, sun, spp):
    scene = room(ball, lamp, 4, sun=sun, second=MIRROR)
    scene["materials"]["floor"] = BLACK
    scene["camera"].update({"vfov": 24, "defocus_angle": lens, "focus_dist": 4})
    return same("seen: " + what, scene, spp)


def same_glint_in_a_mirror():
    """The camera's light and chance weigh 1 together."""
    return same_seen("mirror", MIRROR, 0, 0.4, None, 2048)


def same_glints():
    """The same through glass, with a lens and without."""
    return "; ".join([same_seen("glass", glass(fresnel="exact"), 0, 0.4, None, 8192),
                      same_seen("glass and a lens", {"type": "dielectric", "refraction_index": 1.5}, 4, 0.3, None, 8192),
                      same_seen("disc", glass(fresnel="exact"), 0, 0, 10, 8192)])



def hidden():
    """A black ball before the sun, before the floor, and inside the glass."""
    for what, center, radius in (("before the sun", [0, 9, 0], 1.5), ("before the floor", [0, 0.25, 0], 0.2), ("inside", [0, 4, 0], 0.95)):
        found = at_floor(glass(), 4.0, 0.001, 4, 64, spheres=[{"center": center, "radius": radius, "material": "black"}], black=BLACK)
        assert found[0] == 0, f"{what}: {found}"




def room(ball, lamp, depth, floor=None, sun=None, second=None):
    """A lamp above a floor with a ball, seen from above: wide, so that its noise is that of light on the floor."""
    spheres = [{"center": [0, -100, 0], "radius": 100, "material": "floor"}, {"center": [0, 0.5, 0], "radius": 0.5, "material": "ball"}]
    if lamp:
        spheres.append({"center": [0.6, 1.7, 0.2], "radius": lamp, "material": "lamp"})
    if second:
        spheres.append({"center": [-1.1, 0.5, 0.2], "radius": 0.5, "material": "second"})
    discs = [{"direction": [1, 2, 0.5], "half_angle": sun, "radiance": [20, 20, 20]}] if sun else []
    return {"camera": {"image_width": 12, "aspect_ratio": 1, "max_depth": depth, "vfov": 30, "lookfrom": [0, 2.2, 4], "lookat": [-0.2, 0.1, 0]},
            "background": {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": discs},
            "materials": {"floor": floor or FLOOR, "ball": ball, "second": second or MIRROR,
                          "lamp": {"type": "diffuse_light", "emit": [8, 8, 8]}},
            "spheres": spheres}


def by_chance(name, means):
    """The mean of what means() returns, one of each seed, and its standard error; or what the file has of this name."""
    with open(KEPT, encoding="utf-8") as file:
        kept = json.load(file)
    if "--kept-chance" in OPTIONS:
        return kept[name]
    found = mean_of(means())
    if "--keep-chance" in OPTIONS:
        kept[name] = found
        with open(KEPT, "w", encoding="utf-8") as file:
            file.write(json.dumps(kept, indent=1, sort_keys=True) + "\n")
    assert all(map(math.isclose, found, kept[name])), f"{name}: {found} by chance, {KEPT} has {kept[name]}; --keep-chance writes it anew"
    return found


def mean_of(means):
    return [statistics.mean(means), statistics.stdev(means) / math.sqrt(len(means))]


def same(name, scene, spp, seeds=8):
    """The means with and without, of pictures with independent seeds, are a few of their standard errors apart."""
    def means(word, first):
        for seed in range(first, first + seeds):
            numbers = read_pfm(picture(scene, "--spp", str(spp), "--seed", str(seed), "--caustics", word, "--roulette", "off"))[2]
            yield sum(numbers) / len(numbers)

    a, da = by_chance(name, lambda: list(means("off", 0)))
    b, db = mean_of(list(means("on", 1000)))
    z, error = (b - a) / math.hypot(da, db), math.hypot(da, db) / a
    assert abs(z) < 4, f"{name}: {z:+.1f} standard errors of {error:.2%}"
    assert error < 0.01, f"{name}: only known to {error:.2%}"
    return f"{z:+.1f} standard errors of {error:.2%}"


def same_through_glass():
    return same("glass", room({"type": "dielectric", "refraction_index": 1.5}, 0.3, 50), 4096)


def same_off_a_mirror():
    return same("mirror", room(MIRROR, 0.3, 50), 4096)


def same_of_a_disc():
    return same("disc", room({"type": "dielectric", "refraction_index": 1.5, "fresnel": "exact"}, 0, 50, sun=12), 4096)


def same_rough():
    return same("fuzzy floor", room({"type": "dielectric", "refraction_index": 1.5}, 0.3, 50,
                             floor={"type": "metal", "albedo": [0.8] * 3, "fuzz": 0.6}), 4096)


def same_facets():
    """What such a floor weighs depends on the direction that light comes from."""
    return same("floor of facets", room({"type": "dielectric", "refraction_index": 1.5}, 0.3, 50,
                                        floor={"type": "metal", "albedo": [0.8] * 3, "roughness": 1}), 4096)


def same_deep_cases():
    same("diamond", room({"type": "dielectric", "refraction_index": 2.4}, 0.3, 50), 4096)
    same("water, low depth", room({"type": "dielectric", "refraction_index": 1.33}, 0.3, 5), 4096)
    same("cosine cubed", room({"type": "dielectric", "refraction_index": 1.5}, 0.3, 50,
                              floor={"type": "lambertian", "albedo": [0.7] * 3, "scatter": "cosine_cubed"}), 4096)


def from_the_image(seeds=8):
    """Points of the floor under a wide sun, close behind the ball: on the axis and beside it, where the sun is seen as a ring, beside the
    edge of the caustic, where two of its images merge and disappear, and where both happen. Directions are drawn from all of the
    sun's image there. Chance is the judge."""
    found = []
    for height, x, half in ((1.1, 0.0, 1.5), (1.1, 0.02, 1.5), (1.1, 0.08, 3), (1.1, 0.12, 1.5), (1.3, 0.01, 1.5)):
        scene = document(glass(fresnel="exact"), height, [x, 0.1, 6], [x, 0, 0], 6,
                         [{"direction": [0, 1, 0], "half_angle": half, "radiance": [100] * 3}])
        wanted, error = by_chance(f"floor at {height}, {x}", lambda scene=scene: [
            mean(scene, 8192, "--seed", str(seed), "--caustics", "off")[0] for seed in range(seeds)])
        drawn = mean(scene, 8192, "--seed", str(seeds))[0]
        found.append(f"{height}, {x}: {drawn / wanted - 1:+.2%} of {error / wanted:.2%}")
        assert error < 0.006 * wanted, found[-1]
        assert abs(drawn - wanted) < 5 * error, found[-1]
    return "; ".join(found)


def claims():
    """What a picture says of its noise is what the pictures of many seeds differ by; and that is little. Without directions from the
    image of the whole lamp they differ by 5.1 %."""
    path = os.path.join(sys.argv[2], "tests/unseen/scenes/lamp-0.1.json")
    with open(path, encoding="utf-8") as file:
        scene = json.load(file)
    pictures, claimed = [], []
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        for seed in range(24):
            pictures.append(read_pfm(picture(scene, "--spp", "1024", "--seed", str(seed), "--caustics", "on", "--stats", stats))[2][1::3])
            with open(stats, encoding="utf-8") as file:
                claimed.append(json.load(file)["nrmse"])
            os.remove(stats)
    pixels = list(zip(*pictures))
    spread = math.sqrt(statistics.mean(map(statistics.variance, pixels))) / statistics.mean(map(statistics.mean, pixels))
    ratio = statistics.median(claimed) / spread
    assert 0.8 < ratio < 1.25 and spread < 0.035, f"claims {statistics.median(claimed):.2%}, differs by {spread:.2%}"
    return f"claims {statistics.median(claimed):.2%}, differs by {spread:.2%}"


def near_lamp():
    """Lines that reach a lamp close by at a slant: only the plane across the line of centres knows the cosine."""
    scene = room({"type": "dielectric", "refraction_index": 1.5, "fresnel": "none"}, 0, 6)
    scene["spheres"] += [{"center": [0, 1.7, 0], "radius": 0.28, "material": "lamp"}]
    scene["camera"].update({"lookat": [0, 0, 0.3], "vfov": 14})
    return same("near lamp", scene, 4096, 24)  # few find it by chance, so their spread is not that of a bell


def near_lamp_off_a_mirror():
    """The same without a ball of glass, where directions follow from points of the lamp everywhere."""
    scene = room(MIRROR, 0, 6)
    scene["spheres"] += [{"center": [0.3, 1.25, 0], "radius": 0.15, "material": "lamp"}]
    return same("near lamp, mirror", scene, 4096)


def two_lamps():
    scene = room({"type": "dielectric", "refraction_index": 1.5, "fresnel": "none"}, 0.3, 6)
    scene["spheres"] += [{"center": [-0.8, 1.6, 0.2], "radius": 0.2, "material": "lamp"}]
    return same("two lamps", scene, 4096)


def two_balls():
    return same("two balls", room({"type": "dielectric", "refraction_index": 1.5}, 0.3, 50, second=MIRROR), 4096)


def same_bits():
    """Forms of the kernel."""
    scene = room({"type": "dielectric", "refraction_index": 1.5}, 0.3, 50, sun=5, second=MIRROR)
    pictures = [list(read_pfm(picture(scene, "--spp", "4", "--caustics", "on", "--kernel", form))[2]) for form in ("packet", "sample", "pool")]
    assert pictures[0] == pictures[1] == pictures[2], "forms differ"


# The quick ones are closed forms: what is compared with chance takes many samples, and the forms a kernel each.
CASES = [on_axis, across, what_surfaces_let_through, off_a_mirror, cut_by_depth, hidden, glint_in_a_ball, glint_aside, glint_hidden]
DEEP_CASES = [claims, from_the_image, same_through_glass, same_off_a_mirror, same_of_a_disc, same_glint_in_a_mirror, same_bits, glint_across_pixels, same_glints,
              same_rough, same_facets, near_lamp, near_lamp_off_a_mirror, two_lamps, two_balls, same_deep_cases]

sys.exit(run_cases(CASES, DEEP_CASES, ("--kept-chance", "--keep-chance")))
