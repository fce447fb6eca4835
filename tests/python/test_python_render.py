"""Renders through the package: the command line's bits, arrays without copies, files, stop rules, progress, errors.

Usage: test_python_render.py SOURCE_DIR BUILD_DIR
"""

import gc
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import package

source, build = map(pathlib.Path, sys.argv[1:])
ballpark, np = package.load(source, build)

SCENE = {
    "camera": {"image_width": 24, "aspect_ratio": [4, 3], "samples_per_pixel": 8, "lookfrom": [0, 1, 4],
               "lookat": (0, 0, 0), "vfov": np.float64(40)},
    "materials": {"m": {"type": "lambertian", "albedo": np.array([0.7, 0.5, 0.3])},
                  "g": {"type": "dielectric", "refraction_index": 1.5}},
    "spheres": [{"center": np.array([0, -100.5, 0]), "radius": 100, "material": "m"},
                {"center": [0.4, 0, 0], "radius": 0.5, "material": "g"}]}
POSITIONS = np.random.default_rng(3).random((50, 3))
small = {"width": 16, "spp": 4}
refused = package.refused


def by_command_line(folder, scene, *options):
    document, picture = folder / "scene.json", folder / "picture.pfm"
    document.write_text(json.dumps(scene, default=lambda value: value.tolist()))
    subprocess.run([build / "ballpark", "render", document, "-q", "-o", picture, *options], check=True)
    data = picture.read_bytes()
    _, size, _, rest = data.split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(rest, "<f4").reshape(height, width, 3)[::-1]


def test_same_bits(folder):
    expected = by_command_line(folder, SCENE, "--seed", "7", "--spp", "12")
    picture = ballpark.render(SCENE, seed=7, spp=12)
    assert np.array_equal(picture.radiance, expected)
    assert (picture.width, picture.height, picture.stopped) == (24, 18, "samples")
    assert (picture.samples == 12).all()
    again = ballpark.render(str(folder / "scene.json"), seed=7, spp=12)
    assert np.array_equal(again.radiance, expected)
    assert not np.array_equal(ballpark.render(SCENE, seed=8, spp=12).radiance, expected)
    exact = by_command_line(folder, SCENE, "--precision", "double", "--sampler", "independent", "--depth", "3")
    other = ballpark.render(ballpark.Scene(SCENE), precision="double", sampler="independent", depth=3)
    assert np.array_equal(other.radiance, exact)
    assert ballpark.render(SCENE, width=12, spp=2).radiance.shape == (9, 12, 3)


def test_invalid_samples(folder):
    """Counted by cause, with a warning: by a sky that is negative below, in a process that has such kernels."""
    assert ballpark.render(SCENE, spp=1).invalid == {"not finite": 0, "negative": 0, "out of range": 0}
    shutil.copytree(source / "kernels", folder / "kernels")
    sky = folder / "kernels" / "light" / "sky.cl"
    right = "const Vec3 radiance = madd3("
    assert sky.read_text().count(right) == 1
    sky.write_text(sky.read_text().replace(right, "if (any_lane(direction.y < splat(R(-0.3)))) return vec3(splat(-1), splat(-1), splat(-1));\n    " + right))
    program = (f"import sys, warnings; sys.path.insert(0, {str(source / 'tests/support')!r}); import package, pathlib\n"
               f"ballpark, np = package.load(pathlib.Path({str(source)!r}), pathlib.Path({str(build)!r}))\n"
               "with warnings.catch_warnings(record=True) as seen:\n"
               "    warnings.simplefilter('always')\n"
               "    picture = ballpark.render({'camera': {'image_width': 32, 'vfov': 60, 'samples_per_pixel': 4}, 'spheres': []})\n"
               "assert picture.invalid['negative'] == picture.samples.size * 4 - picture.samples.sum() > 0, picture.invalid\n"
               "assert picture.invalid['not finite'] == picture.invalid['out of range'] == 0\n"
               "text = f\"({picture.invalid['negative']:,} negative)\"\n"
               "assert len(seen) == 1 and text in str(seen[0].message), [str(one.message) for one in seen]\n")
    subprocess.run([sys.executable, "-c", program], check=True, env=dict(os.environ, BALLPARK_KERNELS=str(folder / "kernels")))


def test_arrays_are_the_librarys(folder):
    picture = ballpark.render(SCENE, aovs=True)
    for array, shape, kind in ((picture.radiance, (18, 24, 3), np.float32), (picture.samples, (18, 24), np.uint64),
                               (picture.standard_error, (18, 24, 3), np.float32), (picture.depth, (18, 24), np.float32),
                               (picture.normal, (18, 24, 3), np.float32), (picture.albedo, (18, 24, 3), np.float32)):
        assert array.shape == shape and array.dtype == kind and not array.flags.owndata and array.flags.writeable
        assert array.flags.c_contiguous
    assert np.isfinite(picture.radiance).all() and (picture.radiance >= 0).all()
    assert np.isfinite(picture.standard_error).all() and picture.standard_error.max() > 0
    assert 0 < picture.noise < 1
    assert np.isinf(picture.depth[0, 0]) and np.isfinite(picture.depth[-1, 12])
    assert ballpark.render(SCENE).depth is None
    # What is written into the array is what is saved: it is the same memory.
    before = picture.encode("pfm")
    picture.radiance[:] = 0.25
    after = picture.encode("pfm")
    assert before != after and np.frombuffer(after[-4:], "<f4")[0] == 0.25
    assert (picture.rgb8("gamma2") == 128).all()
    # An array outlives its picture.
    kept = ballpark.render(SCENE).radiance
    copy = kept.copy()
    gc.collect()
    ballpark.render(SCENE, seed=5)
    assert np.array_equal(kept, copy)


def test_texts(_folder):
    printed = subprocess.run([build / "ballpark", "--version"], capture_output=True, text=True, check=True).stdout
    assert re.fullmatch(r"\d+\.\d+\.\d+\S*", ballpark.__version__) and ballpark.__version__ in printed.split()
    refused(AttributeError, "__versions__", getattr, ballpark, "__versions__")
    assert "1 sample per pixel, noise unknown" in repr(ballpark.render(SCENE, spp=1))
    assert re.search(r"2 samples per pixel, [\d.]+ % noise", repr(ballpark.render(SCENE, spp=2)))
    try:
        ballpark.render(SCENE, widht=20)
        raise AssertionError("accepted")
    except TypeError as error:
        assert str(error) == "ballpark.render has no option 'widht'; did you mean 'width'?", error
    refused(TypeError, ["'lamps'", "is now 'light_sampling'"], ballpark.render, SCENE, lamps="off")
    refused(TypeError, ["'light'", "is now 'lighting'"], ballpark.render, SCENE, light="soft")


def test_files(folder):
    picture = ballpark.render(SCENE, aovs=True)
    for ending in ("png", "ppm", "pfm", "exr"):
        picture.save(folder / f"picture.{ending}", "srgb")
        assert (folder / f"picture.{ending}").read_bytes() == picture.encode(ending, "srgb"), ending
    assert picture._repr_png_().startswith(b"\x89PNG\r\n") and picture._repr_png_() == picture.encode("png", "gamma2")
    ppm = picture.encode("ppm")
    assert ppm.endswith(picture.rgb8().tobytes())
    picture.save(folder / "half.bpa")
    rest = ballpark.render(SCENE, first_sample=8, aovs=True)
    rest.save(folder / "rest.bpa")
    subprocess.run([build / "ballpark", "merge", folder / "half.bpa", folder / "rest.bpa", "-q", "-o", folder / "all.pfm"],
                   check=True)
    assert (folder / "all.pfm").read_bytes() == ballpark.render(SCENE, spp=16).encode("pfm")
    picture.save_error_map(folder / "error.png")
    assert (folder / "error.png").read_bytes().startswith(b"\x89PNG")
    refused(ValueError, ["picture.gif", ".png"], picture.save, folder / "picture.gif")
    refused(ValueError, ["tiff", "exr"], picture.encode, "tiff")
    refused(ValueError, ["gamma3", "srgb"], picture.rgb8, "gamma3")
    refused(ballpark.Error, "nowhere", picture.save, folder / "nowhere/picture.png")


def test_stop_rules(folder):
    noisy = ballpark.render(SCENE, spp=4).noise
    goal = noisy / 3
    picture = ballpark.render(SCENE, error=goal)
    assert picture.stopped == "error" and picture.noise <= goal, (picture.stopped, picture.noise, goal)
    assert ballpark.render(SCENE, error=goal / 100, spp=6).stopped == "samples"
    timed = ballpark.render(SCENE, time=0.05)
    assert timed.stopped == "time" and (timed.samples > 0).all()
    adaptive = ballpark.render(SCENE, spp=256, adaptive=True)
    assert len(np.unique(adaptive.samples)) > 1 and abs(adaptive.samples.mean() - 256) < 128


def test_progress(folder):
    seen = []
    ballpark.render(SCENE, spp=512, progress=seen.append)
    assert seen and all(isinstance(now, ballpark.Progress) for now in seen)
    assert seen[-1].fraction == 1 and seen[-1].samples == 512 * 24 * 18
    fractions = [now.fraction for now in seen]
    assert fractions == sorted(fractions)
    seen.clear()
    picture = ballpark.render(SCENE, spp=10**8 // 8, progress=lambda now: seen.append(now) or len(seen) < 2)
    assert len(seen) == 2 and picture.stopped == "interrupt" and picture.samples.max() < 10**7


def test_steps(folder):
    with ballpark.Render(ballpark.Scene(SCENE), spp=2000) as running:
        assert running.stopped is None
        running.step()
        first = running.picture()
        kept = first.radiance.copy()
        while running.step() is None:
            pass
        assert running.stopped == "samples" and running.step() == "samples"
        assert (running.picture().samples == 2000).all()
        assert np.array_equal(first.radiance, kept)
        assert running.device.name and running.progress().fraction == 1
    refused(ballpark.Error, "closed", ballpark.Render.step, running) if running.stopped is None else None
    closed = ballpark.Render(ballpark.Scene(SCENE))
    closed.close()
    refused(ballpark.Error, "closed", closed.step)


def test_light_and_backdrop(folder):
    """Those of bare positions are those of the scene grammar; a background takes the place of both."""
    plain = ballpark.render(POSITIONS, radius=0.1, **small)
    assert plain.alpha is None and (plain.radiance[0, 0] == 1).all()  # soft light before white
    studio = ballpark.render(POSITIONS, radius=0.1, lighting="studio", backdrop="none", **small)
    assert studio.alpha.min() == 0 and studio.alpha.max() == 1 and (studio.radiance[0, 0] == 0).all()
    assert not np.array_equal(studio.radiance[studio.alpha == 1], plain.radiance[studio.alpha == 1])
    sky = ballpark.render(POSITIONS, radius=0.1, background=[0.25, 0.5, 1], **small)
    assert sky.alpha is None and (sky.radiance[0, 0] == (0.25, 0.5, 1)).all()
    refused(ballpark.SceneError, ["lighting", "background"], ballpark.render, POSITIONS, lighting="soft", background=[1, 1, 1])
    refused(ballpark.SceneError, ['"sotf"', '"soft"'], ballpark.render, POSITIONS, lighting="sotf")


def test_errors(folder):
    def wrong(change):
        scene = json.loads(json.dumps(SCENE, default=lambda value: value.tolist()))
        change(scene)
        return scene
    refused(ballpark.SceneError, ["camera.lookform", '"lookfrom"'], ballpark.render,
            wrong(lambda scene: scene["camera"].update(lookform=scene["camera"].pop("lookfrom"))))
    error = refused(ValueError, ["spheres[1].radius", "found 0"], ballpark.Scene,
                    wrong(lambda scene: scene["spheres"][1].update(radius=0)))
    assert (error.status, error.file, error.line) == ("bad scene", "", 0)
    refused(ValueError, ["spheres[0].material", '"m"'], ballpark.Scene,
            wrong(lambda scene: scene["spheres"][0].update(material="mm")))
    refused(ValueError, "finite", ballpark.Scene, {"camera": {"vfov": math.nan}})
    refused(ValueError, "set", ballpark.Scene, {"camera": {1, 2}})
    refused(ValueError, "expected a dict", ballpark.Scene, [1])
    refused(ballpark.Error, "nowhere.json", ballpark.render, "nowhere.json")
    refused(ValueError, ["sampler", "sobol"], ballpark.render, SCENE, sampler="halton")
    refused(ValueError, ["spp", "0"], ballpark.render, SCENE, spp=0)
    refused(ValueError, ["spp", "2.5"], ballpark.render, SCENE, spp=2.5)
    refused(ValueError, "error", ballpark.render, SCENE, error=-1)
    refused(ValueError, "time", ballpark.render, SCENE, time=math.nan)
    refused(ValueError, ["radius", "whole scene"], ballpark.render, SCENE, radius=1)
    refused(TypeError, "sppp", ballpark.render, SCENE, sppp=1)
    refused(TypeError, ["progress", "int", "function"], ballpark.render, SCENE, progress=3)
    refused(TypeError, ["dict", "make_scene"], ballpark.Render, SCENE)
    refused(ballpark.DeviceError, "teapot", ballpark.render, SCENE, device="teapot")
    refused(RuntimeError, "", ballpark.render, SCENE, device=99)
    refused(ValueError, "width", ballpark.Scene(SCENE).set_width, 0)


def test_devices(folder):
    found = ballpark.devices()
    assert found and [device.number for device in found] == list(range(len(found)))
    usable = next(device for device in found if not device.refusal)
    assert ballpark.render(SCENE, device=usable.number, spp=1).stopped == "samples"
    assert "commit" in ballpark.library_version() or ballpark.library_version()[0].isdigit()


with tempfile.TemporaryDirectory() as name:
    for function in [value for key, value in list(globals().items()) if key.startswith("test_")]:
        print(function.__name__, flush=True)
        function(pathlib.Path(name))
print("ok")
