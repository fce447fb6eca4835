"""`ballpark explain` end to end: the tables and JSON of scenes whose effects are known, and a measurement's shape.

Usage: test_explain.py BALLPARK SCENES [--measure]

--measure measures a scene with a single effect, and does nothing else.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

from pfm import read_pfm

program, scenes = sys.argv[1], pathlib.Path(sys.argv[2])
# By their one list.
ALL = re.findall(r"^ +X\([A-Z_]+, \"([a-z_]+)\"", (scenes.parent / "host/packed/effects.h").read_text(), re.MULTILINE)


def run(*arguments, code=0):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, f"{arguments}: exit {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def check_measured(scene, effects, target):
    """One kernel for each effect that is out, between the specialised and the general one; returns {name: kernel}."""
    run("explain", scene, "--measure", "--width", 64, "--json", target)
    costs = json.loads(target.read_text())["scenes"][0]["costs"]
    names = [kernel["name"] for kernel in costs["kernels"]]
    assert names == ["specialised"] + [f"with {name}" for name in ALL if name not in effects] + ["general"], names
    first, last = costs["kernels"][0], costs["kernels"][-1]
    assert first["effects"] == effects and last["effects"] == ALL
    assert first["ratio"] == first["low"] == first["high"] == 1
    for kernel in costs["kernels"]:
        assert 0 < kernel["low"] <= kernel["ratio"] <= kernel["high"], kernel
        assert kernel["samples_per_second"] > 0
        assert (kernel["cold_seconds"] is not None) == (kernel["forced"] is None), kernel
    # What the driver keeps is not built again.
    assert first["warm_seconds"] < first["cold_seconds"] and last["warm_seconds"] < last["cold_seconds"], costs
    return dict(zip(names, costs["kernels"]))


if "--measure" in sys.argv:
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder, "scene.json")
        disc = {"direction": [0, 1, 0], "half_angle": 5, "radiance": [1, 1, 1]}
        scene.write_text(json.dumps({"camera": {"image_width": 64}, "background": {"discs": [disc]}}))
        kernels = check_measured(scene, ["discs"], pathlib.Path(folder, "effects.json"))
    # A lens of no size is really sampled when it is forced in: the same sky took 1.15 (AVX-512) and 1.23 (AVX2) times as long.
    assert kernels["with lens"]["ratio"] > 1, kernels["with lens"]
    print(f"{len(kernels)} kernels measured")
    sys.exit(0)

# A table: every effect once, in or out, with a reason.
table = run("explain", scenes / "v4-13-metal.json", "--wide").stdout.splitlines()
rows = {line.split()[0]: line.split(maxsplit=2)[1:] for line in table[1:len(ALL) + 1]}
assert list(rows) == ALL, table
assert [name for name in ALL if rows[name][0] == "in"] == ["lambertian", "metal", "roulette"], table
assert all(rows[name][0] in ("in", "out") and len(rows[name][1]) > 10 for name in ALL), table
assert "no dielectric among the 4 materials in use" in rows["dielectric"][1]
assert f"3 of {len(ALL)} effects" in table[len(ALL) + 1]
assert table[len(ALL) + 2].split(maxsplit=2) == ["acceleration", "list", "4 spheres: a list, no tree"], table

# JSON of all scenes says what the tables say, one entry a scene, in the order given.
paths = sorted(scenes.glob("*.json"))
paths = [path for path in paths if path.name != "scene.schema.json"]
document = json.loads(run("explain", *paths, "--json", "-").stdout)["scenes"]
assert [entry["scene"] for entry in document] == list(map(str, paths))
for entry in document:  # those of the scene, by its own members
    scene = json.loads(pathlib.Path(entry["scene"]).read_text())
    listed = len(scene.get("triangles", [])) + 2 * len(scene.get("quads", [])) + 12 * len(scene.get("boxes", []))
    assert entry["triangles"] == listed, entry["scene"]
for entry in document:
    assert [effect["name"] for effect in entry["effects"]] == ALL
    assert all(effect["reason"] and effect["description"] for effect in entry["effects"])
    assert "costs" not in entry
    shapes = entry["spheres"] + entry["triangles"]
    assert entry["acceleration"] == ("tree" if shapes > 32 else "list"), entry["scene"]
    assert entry["acceleration"] in entry["acceleration_reason"] or shapes == 0, entry["scene"]

# Mistakes are refused, and leave no file.
with tempfile.TemporaryDirectory() as folder:
    target = pathlib.Path(folder, "effects.json")
    run("explain", code=2)
    run("explain", scenes / "nothing-like-this.json", "--json", target, code=2)
    run("explain", paths[0], "--measure", "--device", "nothing like this", "--json", target, code=1)
    assert not target.exists()

    # A path's steps hang together, and its radiance is that of the rendered pixel.
    picture, scene = pathlib.Path(folder, "one.pfm"), scenes / "v4-18-glass-hollow.json"
    run("render", scene, "--width", 48, "--spp", 1, "--seed", 7, "-o", picture, "--quiet")
    width, height, values = read_pfm(picture.read_bytes())
    assert (width, height) == (48, 27)
    lengths = set()
    for x, y in ((0, 0), (24, 13), (15, 14), (12, 20), (35, 14), (24, 25)):
        place = ((height - 1 - y) * width + x) * 3  # rows of a PFM go upwards
        pixel = values[place : place + 3]
        run("explain", scene, "--pixel", f"{x},{y}", "--width", 48, "--seed", 7, "--json", target)
        path = json.loads(target.read_text())["scenes"][0]["path"]
        steps = path["steps"]
        assert path["pixel"] == [x, y] and not path["cut"]
        for before, after in zip(steps, steps[1:]):
            assert before["met"] and before["goes_on"] and before["point"] == after["origin"], path
        assert all(abs(a - b) <= 1e-6 for a, b in zip(steps[-1]["radiance"], pixel)), (pixel, path)
        lengths.add(len(steps))
        text = run("explain", scene, "--pixel", f"{x},{y}", "--width", 48, "--seed", 7, "--wide").stdout
        assert text.count("from (") == len(steps) and "hits nothing: the sky" in text, text
    assert len(lengths) > 1, "every path is as long as the others"
    run("explain", scene, "--pixel", "48,0", "--width", 48, code=2)
print(f"{len(document)} scenes explained")
