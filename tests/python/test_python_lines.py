"""Lines from arrays: the same pictures as capsules of a document, what a ray meets by an algorithm of its own, colours of lines, ends
and vertices, and what is refused.

Usage: test_python_lines.py SOURCE_DIR BUILD_DIR
"""

import sys

import package
from package import refused

ballpark, np = package.load(*sys.argv[1:])

rng = np.random.default_rng(5)
POINTS = rng.uniform(-1, 1, (6, 3)).round(3)
PAIRS = np.array([[0, 1], [1, 2], [3, 2], [4, 5], [5, 5]])
ENDS = POINTS[PAIRS]
RADII = np.array([0.25, 0.125, 0.1875, 0.0625, 0.375])
CAMERA = {"image_width": 32, "vfov": 45, "lookfrom": [0.5, 1, 4], "lookat": [0, 0, 0]}
DOCUMENT = {"camera": CAMERA, "materials": {"clay": {"type": "lambertian", "albedo": [0.5, 0.25, 0.125]},
                                            "glass": {"type": "dielectric", "refraction_index": 1.5},
                                            "lamp": {"type": "diffuse_light", "emit": [1, 1, 1]}}}


def rgb(scene, spp=4):
    return np.array(ballpark.render(scene, spp=spp).radiance)


def with_lines(*arguments, **named):
    return ballpark.Scene(DOCUMENT, ballpark.Lines(*arguments, **named))


def listed(material, colors=None, radii=RADII):
    """The lines as capsules of the document."""
    capsules = [{"ends": ends.tolist(), "radius": float(radius), "material": material} for ends, radius in zip(ENDS, radii)]
    for capsule, both in zip(capsules, [] if colors is None else np.asarray(colors, np.float64)):
        capsule["colors"] = both.tolist()
    return ballpark.Scene({**DOCUMENT, "capsules": capsules})


# Every type and layout of the arrays is the picture of the same capsules in a document, bit for bit.
for material in ("clay", "glass"):
    expected = rgb(listed(material))
    for lines in (ENDS, np.asfortranarray(ENDS), ENDS.tolist(), np.repeat(ENDS, 2, axis=2)[..., ::2], np.repeat(ENDS, 2, axis=1)[:, ::2]):
        assert np.array_equal(rgb(with_lines(lines, radius=RADII, material=material)), expected)
    for points in (POINTS, np.asfortranarray(POINTS), POINTS.tolist(), np.repeat(POINTS, 2, axis=1)[:, ::2]):
        assert np.array_equal(rgb(with_lines(PAIRS, points, radius=RADII, material=material)), expected)
    for pairs in (PAIRS.astype(np.uint8), PAIRS.astype(np.int16), PAIRS.astype(np.uint64), PAIRS.tolist(), np.asfortranarray(PAIRS)):
        assert np.array_equal(rgb(with_lines(pairs, POINTS, radius=RADII.astype(np.float32), material=material)), expected)
coarse = (ENDS * 8).round() / 8
assert np.array_equal(rgb(with_lines(coarse.astype(np.float32), radius=RADII, material="clay")), rgb(with_lines(coarse, radius=RADII, material="clay")))
assert np.array_equal(rgb(with_lines(ENDS, radius=0.125, material="clay")), rgb(listed("clay", radii=[0.125] * 5)))
assert with_lines(ENDS, material="clay").capsules == 5
assert "5 capsules" in repr(with_lines(ENDS, material="clay"))
for nothing in (with_lines(np.empty((0, 2, 3)), material="clay"), with_lines([], material="clay"), with_lines([], POINTS, material="clay")):
    assert nothing.capsules == 0

# What fills the lines, and spheres beside them, is a medium of the document; shapes of the document keep what they have.
FOG, THIN = {"scattering": [3, 2, 1], "absorption": 0.5}, {"scattering": 0.5, "anisotropy": -0.5}
own = {"center": [-1.25, 0.5, 0], "radius": 0.5, "material": "glass", "interior": "fog"}
bare = {**own, "center": [1.25, -0.5, 0.25]}
del bare["interior"]
more = [{"center": [x, 0.75, 1.0], "radius": 0.375, "material": "edge", "interior": "thin"} for x in (-0.5, 0.25)]
foggy = {**DOCUMENT, "media": {"fog": FOG, "thin": THIN}, "materials": {**DOCUMENT["materials"], "edge": {"type": "interface"}}}
capsules = [{"ends": ends.tolist(), "radius": float(radius), "material": "edge", "interior": "fog"} for ends, radius in zip(ENDS, RADII)]
dry = [{"ends": [[-1, -1, 0.5], [1, -1, 0.5]], "radius": 0.125, "material": "glass"}]
expected = rgb(ballpark.Scene({**foggy, "spheres": [own, bare, *more], "capsules": dry + capsules}))
for lines, balls in (("fog", "thin"), (FOG, THIN)):
    assert np.array_equal(rgb(ballpark.Scene({**foggy, "spheres": [own, bare], "capsules": dry},
                                             [ballpark.Lines(ENDS, radius=RADII, material="edge", interior=lines),
                                              ballpark.Spheres([one["center"] for one in more], 0.375, material="edge", interior=balls)])), expected)
refused(ballpark.SceneError, 'lines: interior: found the medium "thick", expected a name from "media"', ballpark.Scene, foggy,
        ballpark.Lines(ENDS, material="edge", interior="thick"))
refused(ballpark.SceneError, 'positions: interior: found the medium "thick"', ballpark.Scene, foggy, ballpark.Spheres(POINTS, material="edge", interior="thick"))
refused(ballpark.SceneError, "interior", ballpark.Scene, foggy, ballpark.Lines(ENDS, material="clay", interior="fog"))
refused(ballpark.SceneError, "interior", ballpark.Scene, foggy, ballpark.Spheres(POINTS, material="clay", interior="fog"))
assert np.array_equal(np.array(ballpark.render(POINTS, radius=0.5, material={"type": "interface"}, interior=FOG, width=24, spp=4).radiance),
                      np.array(ballpark.render(ballpark.Spheres(POINTS, 0.5, material={"type": "interface"}, interior=FOG), width=24, spp=4).radiance))

# Beside spheres and a mesh, in one scene.
cube = ballpark.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], material="clay")
ball = ballpark.Spheres([[2.0, 0, 0]], 0.5, material="glass")
mixed = ballpark.Scene({**DOCUMENT, "capsules": [{"ends": [[0, 0, 0], [0, 0, 1]], "radius": 0.1, "material": "clay"}]},
                       [ballpark.Lines(ENDS, radius=RADII, material="clay"), cube, ball, ballpark.Lines(ENDS + 1, radius=RADII, material="glass")])
assert (mixed.spheres, mixed.triangles, mixed.capsules) == (1, 1, 11)


def first_hits(scene, colors):
    """What rays through the pixels' centres meet, by marching: every step is the distance to the closest line, which is brute force over
    the definition of a capsule and shares nothing with the roots that the kernels use. The depth is that along the view."""
    width, height, camera = scene.width, scene.height, scene.camera
    back = np.array(camera.lookfrom) - camera.lookat
    w = back / np.linalg.norm(back)
    u = np.cross(camera.vup, w)
    u /= np.linalg.norm(u)
    v, half = np.cross(w, u), np.tan(np.radians(camera.vfov) / 2)
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * half * width / height
    y = (1 - (np.arange(height) + 0.5) / height * 2) * half
    way = x[None, :, None] * u + y[:, None, None] * v - w
    way /= np.linalg.norm(way, axis=2, keepdims=True)
    at = np.zeros((height, width))
    axis = ENDS[:, 1] - ENDS[:, 0]
    square = np.maximum((axis ** 2).sum(1), 1e-300)

    def look(distance):
        point = np.array(camera.lookfrom) + distance[..., None] * way
        off = point[:, :, None] - ENDS[:, 0]
        place = np.clip((off * axis).sum(3) / square, 0, 1)
        off -= place[..., None] * axis
        length = np.linalg.norm(off, axis=3)
        nearest = (length - RADII).argmin(2)
        pick = tuple(np.indices(nearest.shape)) + (nearest,)
        return (length - RADII)[pick], off[pick] / length[pick][..., None], nearest, place[pick]

    for _ in range(300):
        away, normal, nearest, place = look(at)
        at = np.where(at < 50, at + away, at)
    away, normal, nearest, place = look(at)
    met = (at < 20) & (away < 1e-9)
    clear = np.abs((normal * way).sum(2)) > 0.05  # away from the rims, where a step of float is many of the distance
    return met, met & clear & (np.abs(place - 0.5) > 1e-3), at * -(way * w).sum(2), normal, colors[nearest, (place > 0.5).astype(int)]


both = rng.uniform(0, 1, (5, 2, 3)).astype(np.float32)
centred = {**DOCUMENT, "camera": {**CAMERA, "image_width": 96, "pixel_sampling": "center"}}
scene = ballpark.Scene(centred, ballpark.Lines(ENDS, radius=RADII, material="clay", colors=both))
picture = ballpark.render(scene, spp=1, aovs=True)
met, sure, depth, normal, albedo = first_hits(scene, both)
assert met.mean() > 0.1 and sure.sum() > 0.8 * met.sum()
assert (np.isfinite(picture.depth) == met).mean() > 0.999
assert np.abs(picture.depth - depth)[sure].max() < 2e-5, np.abs(picture.depth - depth)[sure].max()
assert np.abs(picture.normal - normal)[sure].max() < 2e-4, np.abs(picture.normal - normal)[sure].max()
assert np.abs(picture.albedo - albedo)[sure].max() < 1e-6, np.abs(picture.albedo - albedo)[sure].max()

# Colours: of all, of lines, of ends, of vertices; linear, as bytes and texts of sRGB, by a map, masked where none is.
expected = rgb(listed("clay", both))
for given in (both, both.astype(np.float64), both.tolist(), np.asfortranarray(both)):
    assert np.array_equal(rgb(with_lines(ENDS, radius=RADII, colors=given, material="clay")), expected)
of_lines = both[:, 0]
expected = rgb(listed("clay", np.stack([of_lines, of_lines], 1)))
assert np.array_equal(rgb(with_lines(ENDS, radius=RADII, colors=of_lines, material="clay")), expected)
assert np.array_equal(rgb(with_lines(ENDS, radius=RADII, colors=np.asfortranarray(of_lines), material="clay")), expected)
of_points = rng.uniform(0, 1, (6, 3)).astype(np.float32)
assert np.array_equal(rgb(with_lines(PAIRS, POINTS, radius=RADII, colors=of_points, material="clay")), rgb(listed("clay", of_points[PAIRS])))
one = (0.5, 0.25, 0.125)
assert np.array_equal(rgb(with_lines(ENDS, radius=RADII, colors=one, material="clay")), rgb(listed("clay")))
white = np.full((5, 2, 3), 255, np.uint8)
for given in ("#fff", "#ffffff", white, white[:, 0], (1, 1, 1)):
    assert np.array_equal(rgb(with_lines(ENDS, radius=RADII, colors=given, material="clay")), rgb(listed("clay", np.ones((5, 2, 3)))))
values = np.arange(10.0).reshape(5, 2)
mapped = rgb(with_lines(ENDS, radius=RADII, colors=values, material="clay", cmap="viridis", color_range=(0, 9)))
by_points = rgb(with_lines(np.arange(10).reshape(5, 2), ENDS.reshape(-1, 3), radius=RADII, colors=np.arange(10.0), material="clay", cmap="viridis"))
assert np.array_equal(mapped, by_points)
assert np.array_equal(rgb(with_lines(ENDS, radius=RADII, colors=values[:, 0], material="clay", color_range=(0, 9))),
                      rgb(with_lines(ENDS, radius=RADII, colors=values[:, [0, 0]], material="clay", color_range=(0, 9))))
assert np.array_equal(rgb(with_lines(ENDS[:3], radius=0.1, colors=[0.0, 1, 2], material="clay", cmap="viridis")),
                      rgb(with_lines(ENDS[:3], radius=0.1, colors=[[0.0, 0], [1, 1], [2, 2]], material="clay", cmap="viridis")))

# Alone, lines are framed and lit; everything of them is in the picture, and a ball at each end has the same frame.
picture = ballpark.render(lines=ENDS, radius=RADII, colors=both, width=48, spp=4)
same = ballpark.render(ballpark.Lines(ENDS, radius=RADII, colors=both), width=48, spp=4)
assert np.array_equal(picture.radiance, same.radiance)
assert np.array_equal(ballpark.render(vertices=POINTS, lines=PAIRS, radius=RADII, colors=both, width=48, spp=4).radiance, same.radiance)
frame = ballpark.make_scene(lines=ENDS, radius=RADII).camera
balls = ballpark.make_scene(ENDS.reshape(-1, 3), radius=np.repeat(RADII, 2)).camera
assert np.allclose(frame.lookfrom, balls.lookfrom) and np.allclose(frame.lookat, balls.lookat)
image = np.array(picture.radiance)
seen = np.argwhere(np.abs(image - image[0, 0]).max(axis=2) > 0.05 * image.max())
assert len(seen) > 0.1 * image[..., 0].size and seen.min() > 0 and (seen.max(axis=0) < np.array(image.shape[:2]) - 1).all()
assert ballpark.make_scene(lines=ENDS, up="z").camera.vup == (0, 0, 1)
flat = ballpark.make_scene(lines=[[[0, 0, 1], [1, 0, 1]], [[1, 0, 1], [1, 1, 1]]]).camera
assert np.allclose(flat.lookfrom[:2], flat.lookat[:2]) and flat.lookfrom[2] > 1

# Beside a mesh, the ground lies under both: a cube far below the lines has its shadow at its foot.
corners = np.array([[corner >> axis & 1 for axis in range(3)] for corner in range(8)], np.float64) * [0.5, 0.5, 0.5] - [0, 3, 0]
quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
deep = [ballpark.Mesh(corners, quads, colors=(1, 0, 0)), ballpark.Lines([[[0, 0, 0], [0.5, 0, 0]]], colors=(1, 0, 0))]
image = np.array(ballpark.render(deep, width=60, height=80, spp=32).radiance)
red = image[..., 0] > 1.2 * image[..., 2]
grey = (image.max(axis=2) < 0.97 * image.max()) & ~red
assert red[:40].any() and red[40:].any() and grey[60:].sum() > 60, f"{grey[60:].sum()} pixels in shadow"

# What is wrong is named, by the row of the caller's arrays.
nan_end, high = ENDS.copy(), both.copy()
nan_end[3, 1, 2] = np.nan
high[2, 1, 0] = 1.5
nan_point = np.where(np.arange(6)[:, None] == 2, np.inf, POINTS)
for words, named in (
        ("lines: found an array of shape (6, 3), expected (N, 2, 3); for a line through all points, numpy.stack", {"lines": POINTS}),
        ("lines: found an array of shape (2, 3), expected (N, 2, 3); one line is [[[x, y, z], [x, y, z]]]", {"lines": ENDS[0]}),
        ("lines: found an array of shape (5, 2), expected (N, 2, 3); whole numbers need the vertices", {"lines": PAIRS}),
        ("lines: found no finite number in an end of line 3 (from 0) of lines, expected one", {"lines": nan_end}),
        ("vertices: found no finite number in an end of line 1 (from 0) of lines, nor of 1 more", {"lines": PAIRS, "vertices": nan_point}),
        ("lines: found an array of shape (5, 2, 3), expected (N, 2) beside vertices", {"lines": ENDS, "vertices": POINTS}),
        ("as in lines.T", {"lines": PAIRS.T, "vertices": POINTS}), ("as in vertices.T", {"lines": PAIRS, "vertices": POINTS.T}),
        ("lines: found float64, expected whole numbers", {"lines": PAIRS.astype(float), "vertices": POINTS}),
        ("lines: found masked numbers", {"lines": np.ma.masked_equal(PAIRS, 3), "vertices": POINTS}),
        ("lines: found vertex 6 in line 1 (from 0), expected numbers from 0 to 5", {"lines": [[0, 1], [2, 6]], "vertices": POINTS}),
        ("lines: found vertex -1 in line 0 (from 0)", {"lines": [[0, -1]], "vertices": POINTS}),
        ("expected none, since there are no vertices", {"lines": [[0, 1]], "vertices": np.empty((0, 3))}),
        ("radius: found an array of shape (4,), expected a number or (5,)", {"lines": ENDS, "radius": RADII[:4]}),
        ("radius: found no number for line 2 (from 0) of lines", {"lines": ENDS, "radius": np.where(np.arange(5) == 2, np.nan, RADII)}),
        ("line 2 (from 0) of lines: radius: found 0, expected a radius", {"lines": ENDS, "radius": np.where(np.arange(5) == 2, 0, RADII)}),
        ("line 0 (from 0) of lines: radius: found -1, expected a radius", {"lines": ENDS, "radius": -1}),
        ("line 4 (from 0) of lines: ends: found", {"lines": ENDS * [[[1]], [[1]], [[1]], [[1]], [[1e12]]]}),
        ("colors: found an array of shape (4, 3), expected (3,), (5, 3) of lines, (5, 2, 3) of their ends, or", {"lines": ENDS, "colors": both[:4, 0]}),
        ("(6, 3) of vertices", {"lines": PAIRS, "vertices": POINTS, "colors": both[:4, 0]}),
        ("leave the alpha out, as in colors[..., :3]", {"lines": ENDS, "colors": np.ones((5, 4))}),
        ("line 2 (from 0) of lines: color: found 1.5, expected shares of light from 0 to 1", {"lines": ENDS, "colors": high}),
        ("colors: found no colour for line 2 (from 0)", {"lines": ENDS, "colors": np.where(high > 1, np.nan, high)}),
        ('colors: found "red", expected "#rrggbb"', {"lines": ENDS, "colors": "red"}),
        ("cmap: found without numbers to map; give `colors`", {"lines": ENDS, "colors": of_lines, "cmap": "viridis"})):
    refused(ballpark.SceneError, words, with_lines, **named, material="clay")
    looks = {name: named.pop(name) for name in ("radius", "cmap") if name in named}
    refused(ballpark.SceneError, words, ballpark.render, **named, **looks)
refused(ballpark.SceneError, 'found the material "gold"', with_lines, ENDS, material="gold")
refused(ballpark.SceneError, ["lines: material: found a material that emits", "let spheres"], with_lines, ENDS, material="lamp")
refused(ballpark.SceneError, "line 1 (from 0) of bars: found the surface of line 0 (from 0) of bars", with_lines, ENDS[[0, 0]], material="glass", name="bars")
refused(ballpark.SceneError, "found lookfrom of the camera on line 0 (from 0) of lines", ballpark.Scene,
        {**DOCUMENT, "camera": {**CAMERA, "lookfrom": [0, 0.25, 0], "lookat": [0, 0.25, -1]}}, ballpark.Lines([[[-1, 0, 0], [1, 0, 0]]], radius=0.25, material="clay"))
refused(TypeError, "lines: found beside what is to be rendered", ballpark.render, POINTS, lines=PAIRS)
refused(TypeError, "faces: found beside lines", ballpark.render, vertices=POINTS, lines=PAIRS, faces=[[0, 1, 2]])
refused(ballpark.SceneError, "color: found for lines, expected colors", ballpark.render, lines=ENDS, color="#fff")
refused(TypeError, "found Lines", ballpark.Render, ballpark.Lines(ENDS))
