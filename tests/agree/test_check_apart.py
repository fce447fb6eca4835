#!/usr/bin/env python3
"""`ballpark check --device all`: a kernel that crashes its process is a line in the table, a wrong one a verdict.

usage: test_check_apart.py PROGRAM SOURCE_DIR
"""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
scene = source / "tests/agree/scenes/lobe-lambertian.json"
store = "scatter4(path.radiance.x, path.radiance.y, path.radiance.z, count, number, samples);"


def check(folder, *more, kernels=None):
    environment = dict(os.environ)
    if kernels:
        environment["BALLPARK_KERNELS"] = str(kernels)
    return subprocess.run([program, "check", str(scene), "--device", "all", "--width", "16", "--spp", "64", "--margin", "2",
                           *more],
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
    expect("a kernel that crashes", check(folder, kernels=crash), 6, "FAILED", "crashed")
    done = check(folder, "--json", "-", kernels=crash)
    assert "crashed" in json.loads(done.stdout)["results"][0]["error"], done.stdout

    wrong = patched(folder, "wrong", "path.radiance = scale3(splat(R(1.1)), path.radiance); " + store)
    expect("a kernel too bright by a tenth", check(folder, kernels=wrong), 3, "DISAGREE")
    expect("a kernel that does not compile", check(folder, kernels=patched(folder, "broken", "this is no C;")), 6,
           "FAILED")


def children(process):
    try:
        return pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    except OSError:
        return []


def runs(pid):
    """Whether that process is at work; a dead one that nobody has waited for is not."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


# In a closed mirror a path ends after a million segments: this would go on for hours.
mirror = {"camera": {"image_width": 64, "samples_per_pixel": 1000, "max_depth": 1000000},
          "materials": {"m": {"type": "metal", "albedo": [1, 1, 1]}},
          "spheres": [{"center": [0, 0, 0], "radius": 5, "material": "m"}]}

with tempfile.TemporaryDirectory() as folder:
    (pathlib.Path(folder) / "mirror.json").write_text(json.dumps(mirror))
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup's way would be handed on
    for kind in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL):
        process = subprocess.Popen([program, "check", "mirror.json", "--device", "all"], cwd=folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        process.stderr.readline()  # "checking device": its process is started next
        deadline = time.monotonic() + 60
        while not children(process) and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.01)
        child = children(process)
        if not child:
            process.kill()
            print("skipped: this system does not list the children of a process")
            break
        time.sleep(1)
        process.send_signal(kind)
        said = process.communicate(timeout=60)[1]
        while runs(child[0]) and time.monotonic() < deadline:
            time.sleep(0.01)
        assert not runs(child[0]), f"{kind.name}: the process of the device goes on"
        assert process.returncode == (-kind if kind == signal.SIGKILL else 130), f"{kind.name}: {process.returncode} {said}"
        print(f"{kind.name} to the command alone: as expected")
