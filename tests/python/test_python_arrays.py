"""Spheres from arrays: of any type and strides, with radii, colours and materials in every form, and what is refused.

Usage: test_python_arrays.py SOURCE_DIR BUILD_DIR
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import package

source, build = map(pathlib.Path, sys.argv[1:])
ballpark, np = package.load(source, build)
refused = package.refused

rng = np.random.default_rng(4)
POSITIONS = np.round(rng.random((60, 3)) * 64) / 64  # exact in every type
RADII = np.full(60, 1 / 32) + np.round(rng.random(60) * 4) / 256
COLORS = np.round(rng.random((60, 3)) * 64) / 64
small = {"width": 32, "spp": 4}


def draw(positions=POSITIONS, **named):
    return ballpark.render(positions, **{"radius": RADII, "color": COLORS, **small, **named}).radiance


EXPECTED = draw().copy()


def same(positions=POSITIONS, **named):
    return np.array_equal(draw(positions, **named), EXPECTED)


def test_any_layout():
    assert same(POSITIONS.astype(np.float32))
    assert same(POSITIONS.astype(">f8")) and same(POSITIONS.astype(np.float16), radius=RADII.astype(np.float32))
    assert same(np.asfortranarray(POSITIONS)) and same(POSITIONS[::-1].copy()[::-1])
    wide = np.zeros((120, 5), np.float32)
    wide[::2, 1:4] = POSITIONS
    assert same(wide[::2, 1:4], radius=np.repeat(RADII, 3)[::3])
    assert same(POSITIONS.tolist(), radius=RADII.tolist(), color=COLORS.tolist())
    read_only = POSITIONS.copy()
    read_only.flags.writeable = False
    assert same(read_only)
    whole = np.round(POSITIONS * 64).astype(np.int32)
    scaled = dict(radius=RADII * 64)
    assert np.array_equal(draw(whole, **scaled), draw(whole.astype(np.float64), **scaled))
    assert not same(POSITIONS[:, ::-1]) and not same(radius=RADII * 1.1)


def test_same_as_a_file(folder):
    """The command line renders the same spheres from a PLY file."""
    rows = np.concatenate([POSITIONS, RADII[:, None], COLORS], axis=1).astype("<f4")
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "radius", "red", "green", "blue"))
    (folder / "spheres.ply").write_bytes(
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n{names}end_header\n".encode() + rows.tobytes())
    (folder / "scene.json").write_text(json.dumps({
        "camera": {"image_width": 32, "aspect_ratio": [4, 3], "samples_per_pixel": 4, "max_depth": 20, "vfov": 30,
                   "fit": "scene"},
        "lighting": "soft", "transfer": "srgb",
        "materials": {"m": {"type": "lambertian", "albedo": [0.8, 0.8, 0.8]}},
        "clouds": [{"file": "spheres.ply", "material": "m"}]}))
    subprocess.run([build / "ballpark", "render", folder / "scene.json", "-q", "-o", folder / "picture.pfm"], check=True)
    assert (folder / "picture.pfm").read_bytes() == ballpark.render(
        POSITIONS, radius=RADII, color=COLORS, **small).encode("pfm")


def mean(color, **named):
    return draw(color=color, **named).reshape(-1, 3)


def test_colors():
    red = mean((0.75, 0.25, 0.125))
    assert np.array_equal(red, mean(np.tile([0.75, 0.25, 0.125], (60, 1))))
    assert np.array_equal(mean("#ff8000"), mean(np.tile(np.uint8([255, 128, 0]), (60, 1)), ) ) or np.allclose(
        mean("#ff8000"), mean(np.tile(np.uint8([255, 128, 0]), (60, 1))), atol=1e-6)
    assert np.array_equal(mean("#f00"), mean("#ff0000")) and np.array_equal(mean("#ff0000"), mean((1, 0, 0)))
    assert np.array_equal(mean("#FF0000"), mean(np.uint8([255, 0, 0])))
    linear = float(ballpark._colors.linear_colors("#808080", 60, None, "", None)[0])
    assert abs(linear - 0.21586) < 1e-4, linear
    # Numbers by a map: least and greatest get its ends, the others lie between.
    values = np.arange(60.0)
    table = ballpark._colors.map_colors(values, "viridis", None)
    assert table[0][2] > table[0][1] and table[-1][1] > table[-1][2]  # violet to yellow
    assert np.array_equal(mean(values), mean(values, cmap="viridis")) and not np.array_equal(mean(values), mean(values, cmap="plasma"))
    assert np.array_equal(mean(values), mean(values, color_range=(0, 59)))
    assert not np.array_equal(mean(values), mean(values, color_range=(0, 100)))
    assert np.array_equal(mean(values), mean(values.astype(np.int16)))
    holes = values.copy()
    holes[3] = np.nan
    assert np.array_equal(ballpark._colors.map_colors(holes, "viridis", None)[3], np.float32([0.3, 0.3, 0.3]))
    constant = ballpark._colors.map_colors(np.ones(5), "viridis", None)
    assert (constant == constant[0]).all()
    # Three spheres, three numbers: a colour, unless a map is named.
    three = POSITIONS[:3]
    a = ballpark.render(three, color=[0.9, 0.1, 0.1], radius=0.3, **small).radiance
    b = ballpark.render(three, color=[0.9, 0.1, 0.1], radius=0.3, cmap="viridis", **small).radiance
    assert not np.array_equal(a, b)


def test_materials():
    metal = {"type": "metal", "albedo": [0.9, 0.7, 0.3], "fuzz": 0.1}
    own = draw(color=None, material=metal)
    named = draw(color=None, material="gold", materials={"gold": metal})
    assert np.array_equal(own, named) and not np.array_equal(own, draw(color=None))
    assert not np.array_equal(draw(material="gold", materials={"gold": metal}), own)  # colours replace its albedo
    # Two sets are the same spheres as one.
    first = ballpark.Spheres(POSITIONS[:20], RADII[:20], COLORS[:20])
    second = ballpark.Spheres(POSITIONS[20:], RADII[20:], COLORS[20:])
    assert np.array_equal(ballpark.render([first, second], **small).radiance, EXPECTED)
    scene = ballpark.Scene({"camera": {"image_width": 16, "fit": "scene"},
                            "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "m"}],
                            "materials": {"m": metal}}, [first, second])
    assert scene.spheres == 61


def test_camera():
    scene = ballpark.make_scene(POSITIONS, radius=RADII)
    assert (scene.width, scene.height, scene.spheres, scene.camera.vup) == (800, 600, 60, (0, 1, 0))
    assert ballpark.make_scene(POSITIONS, up="z").camera.vup == (0, 0, 1)
    assert (ballpark.make_scene(POSITIONS, width=50, height=20).width, ballpark.make_scene(POSITIONS, height=20).height) == (50, 20)
    assert same(camera=scene.camera.document())
    front = ballpark.make_scene(POSITIONS, camera={"view": "front", "margin": 0.2}).camera
    assert np.allclose(np.array(front.lookfrom)[:2], np.array(front.lookat)[:2])
    placed = ballpark.make_scene(POSITIONS, camera={"lookfrom": [0, 0, 9], "vfov": 12})
    assert placed.camera.lookfrom == (0, 0, 9) and placed.camera.vfov == 12


def test_refused():
    bad = POSITIONS.copy()
    bad[7, 1] = np.inf
    refused(ValueError, ["sphere 7 (from 0) of positions", "center"], draw, bad)
    radii = RADII.copy()
    radii[9] = 0
    refused(ValueError, ["sphere 9 (from 0) of positions", "radius", "0"], draw, radius=radii)
    refused(ValueError, ["sphere 0 (from 0) of positions", "color", "1.5"], draw, color=(1.5, 0, 0))
    refused(ValueError, ["positions", "(60, 2)", "(N, 3)"], draw, POSITIONS[:, :2])
    refused(ValueError, ["radius", "(59,)", "(60,)"], draw, radius=RADII[:59])
    refused(ValueError, ["color", "(60, 4)", "(60, 3)"], draw, color=np.ones((60, 4)))
    refused(ValueError, ["color", "red", "#rrggbb"], draw, color="red")
    refused(ValueError, ["cmap", "jet", "viridis"], draw, color=np.arange(60.0), cmap="jet")
    for color in (None, "#ff0000", (0.1, 0.2, 0.3)):
        refused(ValueError, ["cmap", "one number per sphere"], draw, color=color, cmap="viridis")
        refused(ValueError, ["color_range", "one number per sphere"], draw, color=color, color_range=(0, 1))
    refused(ValueError, ["positions", "numbers"], draw, np.full((60, 3), "x"))
    refused(ValueError, ["material", '"gold"'], draw, material="golf", materials={"gold": {"type": "normals"}})
    refused(ValueError, ["up", '"w"'], draw, up="w")
    refused(ValueError, "sphere", ballpark.render, np.empty((0, 3)))
    for subject in (3, None, print, {1, 2}):
        refused(TypeError, [f"found {type(subject).__name__}", "(N, 3)", "Spheres", "path"], ballpark.render, subject)
    refused(ValueError, ["positions", "different lengths"], ballpark.render, [[0, 0, 0], [1, 1]])
    refused(ValueError, ["positions", "text"], ballpark.render, ["a.json", "b.json"])
    refused(TypeError, ["spheres[1]", "ndarray", "Spheres"], ballpark.render, [ballpark.Spheres(POSITIONS), POSITIONS])
    refused(TypeError, ["spheres", "int", "Spheres"], ballpark.Scene, {"camera": {}}, 3)
    refused(TypeError, ["camera", "str", "dict"], draw, camera="front")
    refused(TypeError, ["material", "int", "name"], draw, material=3)
    refused(TypeError, ["cmap", "int", "viridis"], draw, color=np.arange(60.0), cmap=3)
    for wrong in (3, (1,), ("a", "b")):
        refused(ValueError, ["color_range", "two numbers"], draw, color=np.arange(60.0), color_range=wrong)


with tempfile.TemporaryDirectory() as name:
    for function in [value for key, value in list(globals().items()) if key.startswith("test_")]:
        print(function.__name__, flush=True)
        function(*([pathlib.Path(name)] if function.__code__.co_argcount else []))
print("ok")
