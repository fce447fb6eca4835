"""Hard cases of an image around the scene: small scenes, and what their one point shows. As disc_cases.py, and after its
numbers.

In:    a folder, which they do not need.   Out: cases, each a scene document, its image, and the radiance that it must show.
Knows: cases.py, the scene's grammar, what lies between texels.   Does not know: the program, how it samples.

What a point sees of a bright texel is summed over a fine grid, from the definition: the middle of the image lies towards -z,
its right half towards x; the colour is bilinear, and at the poles that of the nearest row.
"""
import math
import struct

from cases import (BLACK, LIGHT, PI, POINT_NORMAL, Case, add, dot, lambertian, lamp, lamp_at, lit, metal, on_unit_sphere, scale,
                   sphere, towards)
from disc_cases import disc
import forms

GRID = 240  # steps across what a texel reaches, each way


def direction_of(u, v):
    around, down = 2 * PI * (u - 0.5), PI * v
    return (math.sin(around) * math.sin(down), math.cos(down), -math.cos(around) * math.sin(down))


def place_of(direction):
    return 0.5 + math.atan2(direction[0], -direction[2]) / (2 * PI), math.acos(direction[1]) / PI


def texel_in(direction, width, height):
    u, v = place_of(direction)
    return int(u * width) % width, min(int(v * height), height - 1)


LOBES = {"lambertian": lambda c: c / PI, "cosine_cubed": lambda c: 2 * c ** 3 / PI, "hemisphere": lambda c: 1 / (2 * PI)}


def share_of_texel(width, height, column, row, lobe="lambertian", normal=POINT_NORMAL):
    """How much of the light of one texel of radiance 1 a lobe scatters."""
    density, total = LOBES[lobe], 0.0
    top, bottom = max(0.0, row - 0.5), min(height, row + 1.5)
    for j in range(GRID):
        y = top + (bottom - top) * (j + 0.5) / GRID
        near_row = 1 - abs(y - row - 0.5)
        if row == 0 and y < 0.5 or row == height - 1 and y > height - 0.5:
            near_row = 1.0
        ring = math.sin(PI * y / height) * near_row
        for i in range(GRID):
            x = column - 0.5 + 2 * (i + 0.5) / GRID
            cosine = dot(direction_of(x / width, y / height), normal)
            if cosine > 0:
                total += density(cosine) * (1 - abs(x - column - 0.5)) * ring
    return total * 2 / GRID * (bottom - top) / GRID * 2 * PI / width * PI / height


def pfm(width, height, texels, rest=BLACK):
    """An image of one colour, but for these texels, by (column, row)."""
    head = b"PF\n%d %d\n-1.0\n" % (width, height)
    rows = []
    for row in reversed(range(height)):
        line = bytearray(struct.pack("<3f", *rest) * width)
        for (column, r), colour in texels.items():
            if r == row:
                struct.pack_into("<3f", line, 12 * column, *colour)
        rows.append(bytes(line))
    return head + b"".join(rows)


def around(width, height, texels, rest=BLACK, others=(), materials=None, receiver=None, **more):
    """A unit sphere in such an image, and the files of the case."""
    scene = on_unit_sphere({"receiver": receiver or lambertian(), **(materials or {})}, list(others), **more)
    scene["background"] = {"image": "sky.pfm"}
    return scene, {"sky.pfm": lambda: pfm(width, height, texels, rest)}


def one(name, width, height, column, row, lobe="lambertian", light=LIGHT, **more):
    share = share_of_texel(width, height, column, row, lobe)
    light = scale(0.1 / share, light)
    scene, files = around(width, height, {(column, row): light}, receiver=lambertian(scatter=lobe))
    return Case(name, scene, lit(share, light), files=files, **more)


def case_71(_):
    """One bright texel: all of its energy arrives, whatever its size and place."""
    for width, height, omega in ((16, 8, 0.4), (64, 32, 0.9), (7, 5, 0.3), (250, 125, 0.7)):
        column, row = texel_in(towards(omega, 0.5), width, height)
        yield one(f"texel {column}, {row} of {width} x {height}", width, height, column, row, chance=width < 64, deep=width in (7, 64))
    # Cut by the horizon; across the seam; at a pole, where a row is a cap.
    column, row = texel_in(towards(1.45, 1.0), 12, 6)
    yield one("on the horizon", 12, 6, column, row, chance=False, samples=4096)
    for width, height, column, row in ((12, 6, 0, 2), (12, 6, 11, 2), (12, 6, 4, 0), (9, 4, 8, 0)):
        if share_of_texel(width, height, column, row) > 1e-3:
            yield one(f"edge: {column}, {row} of {width} x {height}", width, height, column, row, deep=column == 4)


def case_72(_):
    """The other lobes; and metal, by chance."""
    for lobe in ("cosine_cubed", "hemisphere"):
        column, row = texel_in(towards(0.5, 2.0), 20, 10)
        yield one(lobe, 20, 10, column, row, lobe, chance=False)
    column, row = texel_in(towards(0.6), 16, 8)
    for receiver in (metal(0.4), metal(0.7, fuzz_shape="ball")):
        scene, files = around(16, 8, {(column, row): scale(30, LIGHT)}, (0.1, 0.2, 0.1), receiver=receiver)
        yield Case(f"metal {receiver['fuzz']}", scene, files=files, samples=4096, deep=receiver["fuzz"] > 0.5)


def case_73(_):
    """Beside a lamp and a disc; two bright texels and a grey sky."""
    column, row = texel_in(towards(0.5, 2.5), 24, 12)
    share = share_of_texel(24, 12, column, row)
    light = scale(0.1 / share, LIGHT)
    lamp_light = (9.0, 3.0, 1.0)
    scene, files = around(24, 12, {(column, row): light}, materials={"lamp": lamp(lamp_light)}, others=[lamp_at(0.5, 3, 0.5, 0.3)])
    scene["background"]["discs"] = [disc(0.6, 5, (2.0, 6.0, 9.0), -1.5)]
    near, far = forms.irradiance(math.asin(0.5 / 3), 0.5), forms.irradiance(math.radians(5), 0.6)
    yield Case("image, lamp and disc", scene, add(lit(share, light), lit(near, lamp_light), lit(far, (2.0, 6.0, 9.0))), files=files,
               chance=False, samples=4096)
    other = texel_in(towards(0.8, -0.5), 24, 12)
    second = share_of_texel(24, 12, *other)
    grey = (0.2, 0.1, 0.3)
    texels = {(column, row): add(light, grey), other: add(scale(0.3, light), grey)}
    scene, files = around(24, 12, texels, grey)
    yield Case("two texels before grey", scene, add(lit(share, light), lit(second, scale(0.3, light)), lit(1, grey)), files=files,
               samples=4096)


def case_74(_):
    """A sun of a quarter of a degree, in single and double precision."""
    for precision in ("single", "double"):
        column, row = texel_in(towards(0.7, 0.4), 1440, 720)
        yield one(f"1440 x 720, {precision}", 1440, 720, column, row, chance=False, options=("--precision", precision),
                  deep=precision == "double")


def case_75(_):
    """The same everywhere is the constant sky, to the bit."""
    colour = (0.75, 0.5, 0.25)
    scene, files = around(5, 3, {}, colour)
    yield Case("an image of one colour", scene, like={**scene, "background": list(colour)}, files=files, samples=64,
               expected=lit(1, colour))
    scene, files = around(1, 1, {}, colour)
    yield Case("an image of one texel", scene, like={**scene, "background": list(colour)}, files=files, samples=64,
               expected=lit(1, colour), deep=True)


def case_76(_):
    """What stands before the bright texel."""
    column, row = texel_in(towards(0.5), 64, 32)
    hides = scale(3, towards(0.5))
    for distance, radius in ((3, 1), (3e6, 1e6)):
        ball = sphere(add(POINT_NORMAL, scale(distance / 3, hides)), radius, "ball")
        scene, files = around(64, 32, {(column, row): scale(100, LIGHT)}, materials={"ball": lambertian(BLACK)}, others=[ball])
        yield Case(f"a ball of radius {radius:g}", scene, BLACK, exact=True, files=files, samples=64)


NUMBERED = {int(name[-2:]): function for name, function in sorted(globals().items()) if name.startswith("case_")}
