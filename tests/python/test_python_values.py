"""Arrays of every kind reach the picture with their values: what each pixel shows is computed here from the positions given, by
the intersection of a ray with each sphere, and compared with the layers of the picture. What is masked, missing or NaN is left
out, refused or grey, and never what lies under a mask.

Usage: test_python_values.py SOURCE_DIR BUILD_DIR
"""

import decimal
import fractions
import pathlib
import sys
import warnings

import package

source, build = map(pathlib.Path, sys.argv[1:3])
ballpark, np = package.load(source, build)
refused = package.refused
left_out = []

SIZE, DISTANCE = 48, 40.0
rng = np.random.default_rng(11)
# Spheres that do not hide each other, on a grid seen from the front; all numbers are exact in float16.
GRID = np.array([(x, y) for x in range(-2, 3) for y in range(-2, 3)], float) * 2
POSITIONS = np.column_stack([GRID, np.round(rng.uniform(-2, 2, 25) * 8) / 8])
RADII = np.round(rng.uniform(0.5, 0.9, 25) * 64) / 64
COLORS = np.round(rng.random((25, 3)) * 64) / 64
HIDDEN = [3, 12, 24]
KEPT = np.setdiff1d(np.arange(25), HIDDEN)
HOLES = POSITIONS.copy()
HOLES[3, 0], HOLES[12, 2], HOLES[24] = np.nan, np.nan, np.nan
MASK = np.isnan(HOLES)
LIES = np.where(MASK, [0.5, 0.25, 3], POSITIONS)  # what lies under the mask: a place that could be drawn
CAMERA = {"lookfrom": [0, 0, DISTANCE], "lookat": [0, 0, 0], "vfov": 17, "vup": [0, 1, 0]}


def draw(positions, radius, color, **named):
    return ballpark.render(positions, radius=radius, color=color, camera=CAMERA, width=SIZE, height=SIZE, spp=1, aovs=True,
                           **named)


def first_hit(positions, radii):
    """For the middle of each pixel: the sphere it shows, or -1, and its distance along the ray."""
    half = np.tan(np.radians(CAMERA["vfov"] / 2))
    steps = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
    rays = np.stack(np.broadcast_arrays(steps[None, :] * half, -steps[:, None] * half, -1.0), axis=-1)
    rays = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    towards = np.asarray(positions, float) - [0, 0, DISTANCE]
    along = rays @ towards.T
    square = along**2 - (towards**2).sum(axis=1) + np.asarray(radii, float)**2
    distance = np.where(square > 0, along - np.sqrt(np.maximum(square, 0)), np.inf)
    shown = np.where(np.isfinite(distance.min(axis=-1)), distance.argmin(axis=-1), -1)
    return shown, distance.min(axis=-1), rays


def check(picture, positions, radii, colors):
    """Pixels whose neighbours show the same sphere lie inside it: their layers are its colour and depth."""
    shown, distance, rays = first_hit(positions, radii)
    same = np.ones_like(shown, bool)
    for axis in (0, 1):
        for step in (-1, 1):
            same &= np.roll(shown, step, axis) == shown
    inside, outside = same & (shown >= 0), same & (shown < 0)
    assert set(shown[inside]) == set(range(len(positions))), "a sphere is too small for this test"
    albedo = np.broadcast_to(np.asarray(colors, float), (len(positions), 3))[shown[inside]]
    assert np.allclose(picture.albedo[inside], albedo, atol=2e-6), np.abs(picture.albedo[inside] - albedo).max()
    assert np.isinf(picture.depth[outside]).all()
    for one in range(len(positions)):
        here = inside & (shown == one)
        # The depth of the pixel nearest to the middle of the sphere, where a fraction of a pixel changes it least.
        nearest = np.unravel_index(np.where(here, distance, np.inf).argmin(), shown.shape)
        depths = [distance[nearest], distance[nearest] * -rays[nearest][2]]  # along the ray, or along the view
        assert min(abs(picture.depth[nearest] - depth) for depth in depths) < 0.06, (one, picture.depth[nearest], depths)


def complete(positions=POSITIONS, radius=RADII, color=COLORS, colors=COLORS, **named):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check(draw(positions, radius, color, **named), POSITIONS, RADII, colors)


def holey(positions, radius=RADII, color=COLORS, colors=COLORS, **named):
    """Three points have no place; their number is said once, at the line that called."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        picture = draw(positions, radius, color, **named)
    said = [str(one.message) for one in caught if "left out" in str(one.message)]
    assert said == ["ballpark: positions: left out for lack of a place (masked, missing or NaN): 3 of 25"], said
    assert all(one.filename == __file__ for one in caught if "left out" in str(one.message))
    check(picture, POSITIONS[KEPT], RADII[KEPT], np.broadcast_to(colors, (25, 3))[KEPT])


class Convertible:
    """An object that becomes an array when numpy asks, as tensors, netCDF variables and columns of tables do."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array


def test_types_and_layouts():
    complete()
    for kind in ("f2", "f4", ">f4", ">f8", "g"):
        complete(POSITIONS.astype(kind), RADII.astype(kind), COLORS.astype(kind))
    complete(np.asfortranarray(POSITIONS), color=np.asfortranarray(COLORS))
    wide = np.full((50, 7), 99.0, np.float32)
    wide[::2, 5:2:-1] = POSITIONS
    complete(wide[::2, 5:2:-1], radius=np.repeat(RADII, 2)[::2])
    complete(np.require(POSITIONS, requirements="W"), radius=np.broadcast_to(RADII, (2, 25))[1])
    raw = np.frombuffer(b"\0" + POSITIONS.tobytes(), "u1")[1:]
    complete(np.ndarray(POSITIONS.shape, "f8", raw))  # not aligned
    complete(list(map(tuple, POSITIONS.tolist())), RADII.tolist(), list(map(tuple, COLORS.tolist())))
    complete(Convertible(POSITIONS), Convertible(RADII.astype("f4")), Convertible(COLORS))
    complete([[decimal.Decimal(x) for x in row] for row in POSITIONS.tolist()],
             np.array([fractions.Fraction(x) for x in RADII.tolist()], object))
    complete(np.ma.masked_array(POSITIONS, mask=False), np.ma.masked_array(RADII), np.ma.masked_array(COLORS, mask=False))
    whole = np.round(POSITIONS).astype(int)
    for kind in ("i1", ">i2", "i4", ">i8"):
        check(draw(whole.astype(kind), 0.75, COLORS), whole, np.full(25, 0.75), COLORS)
    check(draw(whole + 0.0, np.ones(25, np.uint8), COLORS), whole, np.ones(25), COLORS)
    complete(radius=-RADII)  # inside out


def srgb(bytes_):
    share = np.asarray(bytes_, float) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def test_colors():
    for rgb in ((68, 119, 170), (0, 10, 255)):
        complete(color="#%02x%02x%02x" % rgb, colors=srgb(rgb))
        complete(color=np.uint8(rgb), colors=srgb(rgb))
        complete(color=tuple(srgb(rgb)), colors=srgb(rgb))
    many = rng.integers(0, 256, (25, 3))
    complete(color=many.astype(np.uint8), colors=srgb(many))
    complete(color=np.asfortranarray(many.astype(np.uint8)), colors=srgb(many))
    complete(color=(many > 100).astype(int), colors=many > 100)
    # A map: the ends are those of the library, whatever the type of the numbers.
    ends = [ballpark._colors._table("coolwarm")[place] for place in (0, 255)]
    flags = np.arange(25) % 3 == 0
    expected = np.where(flags[:, None], ends[1], ends[0])
    values = [flags, flags.astype("u1"), flags.astype(">i2"), flags * 5e-324, np.where(flags, 1.7e308, -1.7e308),
              flags.astype("f2"), flags.tolist(), Convertible(flags * 2.5 - 7)]
    for value in values:
        complete(color=value, cmap="coolwarm", colors=expected)
    complete(color=flags * 6 - 2, cmap="coolwarm", color_range=(-1, 1), colors=expected)  # beyond the ends
    holes = np.where(np.arange(25) == 4, np.nan, flags * 1.0)
    grey = expected.copy()
    grey[4] = 0.3
    for value in (holes, np.ma.masked_array(flags * 1.0, mask=np.isnan(holes)), np.ma.masked_array(flags, mask=np.isnan(holes)),
                  [None if np.isnan(one) else one for one in holes.tolist()]):
        complete(color=value, cmap="coolwarm", colors=grey)
    # Three numbers are values where something says so.
    for named in ({"cmap": "viridis", "color_range": (0, 1)}, {"color_range": (0, 1)}):
        picture = draw(POSITIONS[:3], RADII[:3], [0, 1, 0], **named)
        table = ballpark._colors._table("viridis")
        check(picture, POSITIONS[:3], RADII[:3], [table[0], table[255], table[0]])


def test_left_out():
    lies = np.ma.masked_array(LIES, mask=MASK)
    listed = [[None if one != one else one for one in row] for row in HOLES.tolist()]
    for positions in (HOLES, HOLES.astype(">f4"), np.asfortranarray(HOLES), lies, lies.astype("f4"), np.ma.masked_invalid(HOLES), listed,
                      np.array(listed, object), Convertible(lies), Convertible(HOLES), list(lies), HOLES.tolist(),
                      np.ma.masked_array(LIES, mask=np.repeat(MASK.any(axis=1)[:, None], 3, axis=1))):
        holey(positions)
    holey([[np.ma.masked if one != one else one for one in row] for row in HOLES.tolist()])
    whole = np.round(POSITIONS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        picture = draw(np.ma.masked_array(whole.astype(int), mask=MASK), 0.75, COLORS)
    check(picture, whole[KEPT], np.full(22, 0.75), COLORS[KEPT])
    # What else belongs to them goes with them, whatever it is.
    off = MASK.any(axis=1)
    spoiled = np.where(off, np.nan, RADII)
    for radius in (spoiled, np.ma.masked_array(RADII, mask=off), np.where(off, 0, RADII), np.where(off, None, RADII)):
        holey(lies, radius=radius)
    holey(lies, color=np.ma.masked_array(COLORS, mask=np.repeat(off[:, None], 3, axis=1)))
    holey(lies, color=np.where(off[:, None], 7, COLORS))
    holey(lies, color=(COLORS * 255).astype(np.uint8), colors=srgb((COLORS * 255).astype(np.uint8)))
    values = np.where(off, 1e9, np.arange(25) % 2)  # the range is that of those that are shown
    table = ballpark._colors._table("viridis")
    holey(lies, color=values, colors=np.where((np.arange(25) % 2 == 1)[:, None], table[255], table[0]))
    # The fitted camera sees the others alone, and as many spheres are there.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fitted = ballpark.make_scene(lies, radius=RADII)
    assert fitted.spheres == 22 and fitted.camera == ballpark.make_scene(POSITIONS[KEPT], radius=RADII[KEPT]).camera
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        refused(UserWarning, "3 of 25", ballpark.make_scene, lies)


def test_refused():
    off = np.arange(25) == 5
    for radius in (np.where(off, np.nan, RADII), np.ma.masked_array(RADII, mask=off), [None if one else 1 for one in off]):
        refused(ValueError, ["radius", "sphere 5 (from 0) of positions"], draw, POSITIONS, radius, COLORS)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # counted among all points, not among those with a place
            refused(ValueError, ["radius", "sphere 5 (from 0) of positions"], draw, HOLES, radius, COLORS)
    refused(ValueError, ["radius", "sphere 0", "24 more"], draw, POSITIONS, [None] * 25, COLORS)
    for radius in (np.nan, np.ma.masked):
        refused(ValueError, ["radius", "no number"], draw, POSITIONS, radius, COLORS)
    mask = np.repeat(off[:, None], 3, axis=1)
    for color in (np.ma.masked_array(COLORS, mask=mask), np.where(mask, np.nan, COLORS),
                  np.ma.masked_array((COLORS * 255).astype(np.uint8), mask=mask), np.ma.masked_array(mask.astype(int), mask=mask)):
        refused(ValueError, ["color", "sphere 5 (from 0) of positions"], draw, POSITIONS, RADII, color)
    refused(ValueError, ["color", "no number"], draw, POSITIONS, RADII, np.ma.masked_array([1, 0.5, 0], mask=[0, 1, 0]))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        refused(ValueError, ["those positions that have a place", "radius", "found 0"], draw, HOLES, RADII * (RADII < 0.7), COLORS)
    nowhere = [HOLES * np.nan, np.ma.masked_all((25, 3)), np.full((25, 3), None)]
    for positions in nowhere:
        refused(ValueError, ["positions", "any of 25"], draw, positions, RADII, COLORS)
    for shape, hint in (((3, 25), "transpose it, as in positions.T"), ((25, 2), "third column"), ((3,), "[[x, y, z]]"),
                        ((25, 4), "(N, 3)"), ((0,), "(N, 3)"), ((2, 5, 3), "(N, 3)")):
        refused(ValueError, [f"{shape}", hint], ballpark.render, np.zeros(shape))
    for positions, words in ((POSITIONS + 0j, "real numbers"), (np.full((25, 3), "x"), "text"), ([["a", 1, 2]], "text"),
                             (np.array([["a", 1, 2]], object), "positions[0, 0]"), (POSITIONS.astype("M8[s]"), "datetime64"),
                             (np.zeros(4, [("x", "f4"), ("y", "f4")]), "fields x, y"), ([[10**400, 0, 0]], "beyond")):
        refused(ValueError, words, ballpark.render, positions)
    refused(TypeError, ["positions[1, 2]", "complex"], ballpark.render, np.array([[0, 0, 0], [0, 0, 1j]], object))


def test_refused_colors():
    def color(value, words, kind=ValueError, **named):
        refused(kind, words, draw, POSITIONS, RADII, value, **named)

    color(np.ones((25, 4)), ["(25, 4)", "color[:, :3]", "linear", "uint8"])
    color((1, 0, 0, 1), ["(4,)", "color[:3]"])
    color(COLORS.T, ["(3, 25)", "color.T"])
    color([255, 128, 0], ["up to 255", "uint8"])
    color(np.full((25, 3), 200, ">i4"), ["up to 200", "uint8"])
    color(["#ff0000"] * 25, ["text", "one colour"])
    color(COLORS + 0j, "real")
    color("#ff0000ff", "#rrggbb")
    color(np.full(25, np.nan), ["no finite number", "color_range"])
    color(np.ma.masked_all(25), ["no finite number", "color_range"])
    for ends in ((1, 0), (np.nan, 1), (0, np.inf)):
        color(np.arange(25), ["color_range", "lesser one first"], color_range=ends)
    color([0.1, 0.2, 0.3], ["color_range", "one number per sphere"], color_range=(0, 1))


def test_empty():
    nothing = ballpark.Spheres(np.empty((0, 3)), color=np.empty(0))
    assert ballpark.make_scene([ballpark.Spheres(POSITIONS), nothing]).spheres == 25
    refused(ValueError, "no sphere", ballpark.make_scene, np.empty((0, 3)))


def test_documents():
    """Errors name the member; arrays of any package stand for lists."""
    def scene(**changed):
        sphere = {"center": [0, 0, 0], "radius": 1, "material": "m", **changed}
        return ballpark.Scene({"camera": {"image_width": 10}, "spheres": [sphere],
                               "materials": {"m": {"type": "lambertian", "albedo": np.float32([0.5, 0.5, 0.5])}}})

    assert scene(center=Convertible(np.ones(3)), radius=np.longdouble(2)).spheres == 1
    for value, words in ((np.nan, "found nan"), (np.float32(np.inf), "found inf"), (1j, "complex"), (None, "null"), ({1}, "set")):
        refused(ValueError, ["spheres[0].radius", words], scene, radius=value)
    for value in (np.array([0, np.nan, 0]), [0, np.nan, 0], np.ma.masked_array([0, 0, 0], mask=[0, 1, 0])):
        refused(ValueError, "spheres[0].center[1]", scene, center=value)
    refused(ValueError, ["materials", "found the name 3"], ballpark.Scene, {"camera": {}, "materials": {3: {}}})


def test_pandas():
    pandas = installed("pandas")
    frame = pandas.DataFrame(POSITIONS, columns=list("xyz"))
    complete(frame, pandas.Series(RADII), pandas.DataFrame(COLORS))
    complete(frame.astype("Float64"), pandas.Series(RADII).astype("Float32"), pandas.DataFrame(COLORS).astype("Float64"))
    holes = pandas.DataFrame(HOLES, columns=list("xyz"))
    for one in (holes, holes.astype("Float64"), holes.astype(object), holes.astype("Float64").astype(object)):
        holey(one)
    off = pandas.Series(MASK.any(axis=1))
    holey(holes, radius=pandas.Series(RADII).astype("Float64").mask(off))
    refused(ValueError, ["radius", "sphere 3 "], draw, frame, pandas.Series(RADII).astype("Float64").mask(off), COLORS)
    table = ballpark._colors._table("viridis")
    values = pandas.Series(np.arange(25) % 2).astype("Int64").mask(off)
    expected = np.where((np.arange(25) % 2 == 1)[:, None], table[255], table[0])
    complete(frame, color=values, colors=np.where(MASK.any(axis=1)[:, None], np.float32(0.3), expected))
    refused(ValueError, ["fields", "x"], ballpark.render, frame.to_records())
    refused(ValueError, "text", draw, frame, RADII, pandas.Series(list("abcde") * 5).astype("category"))


def test_other_packages():
    for name, make in (("polars", lambda module: module.DataFrame(HOLES).fill_nan(None)),
                       ("xarray", lambda module: module.DataArray(HOLES)),
                       ("pyarrow", lambda module: module.table({name: module.array(HOLES[:, at], from_pandas=True)
                                                                for at, name in enumerate("xyz")}))):
        module = installed(name, needed=False)
        if module is not None:
            holey(make(module))


class NotInstalled(Exception):
    pass


def installed(name, needed=True):
    try:
        return __import__(name)
    except Exception:  # of a package that is broken as well
        left_out.append(name)
        if needed:
            raise NotInstalled from None
        return None


for function in [value for key, value in list(globals().items()) if key.startswith("test_")]:
    print(function.__name__, flush=True)
    try:
        function()
    except NotInstalled:
        continue
for name in left_out:
    print(f"skipped: not installed: {name}")
print("ok")
