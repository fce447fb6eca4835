#!/usr/bin/env python3
"""`ballpark check --device all`: a kernel that crashes its process is a line in the table, a wrong one a verdict.

usage: test_check_apart.py PROGRAM SOURCE_DIR
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
scene = source / "tests/agree/scenes/lobe-lambertian.json"
store = "store_lanes(path.radiance.x, red);"


def check(folder, *more, kernels=None):
    environment = dict(os.environ)
    if kernels:
        environment["BALLPARK_KERNELS"] = str(kernels)
    return subprocess.run([program, "check", str(scene), "--device", "all", "--width", "16", "--spp", "64", *more],
                          env=environment, capture_output=True, text=True, cwd=folder)


def patched(folder, name, replacement):
    copy = pathlib.Path(folder) / name
    shutil.copytree(source / "kernels", copy)
    holders = [p for p in copy.rglob("*.cl") if store in p.read_text()]
    assert len(holders) == 1, holders
    holders[0].write_text(holders[0].read_text().replace(store, replacement))
    return copy


def expect(what, done, code, *texts):
    for text in texts:
        assert text in done.stdout + done.stderr, f"{what}: no {text!r} in {done.stdout} {done.stderr}"
    assert done.returncode == code, f"{what}: exit code {done.returncode}: {done.stdout} {done.stderr}"
    print(f"{what}: as expected")


with tempfile.TemporaryDirectory() as folder:
    right = check(folder, "--json", "report.json", "--map", "map.png")
    expect("the kernel as it is", right, 0, "agree")
    report = json.loads((pathlib.Path(folder) / "report.json").read_text())
    assert report["results"] and all(r["agree"] for r in report["results"])
    maps = sorted(pathlib.Path(folder).glob("map-*.png"))
    assert len(maps) == len(report["results"]), maps

    # The address is computed, so that no compiler can see that nothing lies there.
    crash = patched(folder, "crash", "*(volatile __global float *)(size_t)(max_depth & 1u) = 1.0f; " + store)
    expect("a kernel that crashes", check(folder, kernels=crash), 1, "FAILED", "crashed")
    done = check(folder, "--json", "-", kernels=crash)
    assert "crashed" in json.loads(done.stdout)["results"][0]["error"], done.stdout

    wrong = patched(folder, "wrong", "path.radiance = scale3(splat(R(1.1)), path.radiance); " + store)
    expect("a kernel too bright by a tenth", check(folder, kernels=wrong), 3, "DISAGREE")
    expect("a kernel that does not compile", check(folder, kernels=patched(folder, "broken", "this is no C;")), 1,
           "FAILED")
