"""Mitsuba 3, which samples lamps by code of its own, shows the same pictures: mean radiance within statistics.

    test_mitsuba.py PROGRAM SOURCE_DIR BUILD_DIR

Its Python is BUILD_DIR/../mitsuba/bin/python, where bench/mitsuba_setup puts it, or what MITSUBA_PYTHON names.
"""
import importlib.machinery
import importlib.util
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

program, source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
sys.path[:0] = [str(source / "bench"), str(source / "scripts"), str(source / "tests/lamps")]
import common_scene  # noqa: E402
import lamp_scenes  # noqa: E402

T_MAX = 6.0  # of 15 channels, Student's t of about 14 degrees of freedom: by chance in 1 run of 2000
WIDTH, SAMPLES, PASSES = 96, 64, 8


def stop(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def ours(scene, folder):
    """Means of PASSES seeds."""
    means = []
    for seed in range(PASSES):
        subprocess.run([program, "render", scene, "--width", str(WIDTH), "--spp", str(SAMPLES), "--seed", str(seed), "--light-sampling", "on",
                        "-o", folder / "x.pfm", "--stats", folder / "x.json", "--quiet"], check=True)
        means.append(json.loads((folder / "x.json").read_text())["mean_radiance"])
    return means


python = os.environ.get("MITSUBA_PYTHON", str(build.parent / "mitsuba/bin/python"))
if not os.path.exists(python):
    stop("no Mitsuba (bench/mitsuba_setup installs it)")
peer = [python, str(source / "bench/mitsuba_peer.py")]
tried = subprocess.run([*peer, "--why"], capture_output=True, text=True)
if tried.returncode != 0:
    stop(f"Mitsuba does not run here: {(tried.stderr.strip().splitlines() or ['it crashes'])[-1].removeprefix('skipped: ')}")

with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    paths = [common_scene.write(source / "scenes/lamps.json", folder / "lamps.json")]
    for name in ("room", "sparks", "sunken", "shallow"):
        scene = common_scene.common(lamp_scenes.generated(name))
        for material in scene["materials"].values():
            material.pop("scatter", None)
        (folder / f"{name}.json").write_text(json.dumps(scene))
        paths.append(folder / f"{name}.json")
    loader = importlib.machinery.SourceFileLoader("mesh_peers", str(source / "bench/mesh_peers"))
    mesh_peers = importlib.util.module_from_spec(importlib.util.spec_from_loader("mesh_peers", loader))
    loader.exec_module(mesh_peers)
    for name, document in mesh_peers.scenes().items():
        (folder / name).mkdir()
        paths.append(mesh_peers.common(program, document, folder / name))
    for path in paths:
        done = subprocess.run([*peer, str(path), "--width", str(WIDTH), "--spp", str(SAMPLES), "--passes", str(PASSES), "--seed", "7"],
                              check=True, capture_output=True, text=True)
        theirs = json.loads(done.stdout)["passes_mean"]
        mine = ours(path, folder)
        ts = []
        for c in range(3):
            a, b = [m[c] for m in mine], [m[c] for m in theirs]
            error = math.sqrt((statistics.variance(a) + statistics.variance(b)) / PASSES)
            ts.append((statistics.fmean(a) - statistics.fmean(b)) / error)
        print(f"{path.parent.name if path.stem == 'scene' else path.stem:16} t {' '.join(f'{t:5.1f}' for t in ts)}  error of the comparison {error / statistics.fmean(b):.2%}")
        assert max(map(abs, ts)) < T_MAX, (path.stem, ts)
