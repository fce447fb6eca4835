"""`ballpark bench`: what it writes, and that its figures fit together."""
import atexit
import json
import os
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

program = sys.argv[1]
folder = tempfile.mkdtemp()
atexit.register(shutil.rmtree, folder)
environment = dict(os.environ, TMPDIR=folder)


def run(*words, code=0):
    done = subprocess.run([program, "bench", *words], capture_output=True, text=True, env=environment)
    assert done.returncode == code, (words, done.returncode, done.stderr)
    return done


def close(a, b, tolerance=1e-9):
    assert abs(a - b) <= tolerance * max(abs(a), abs(b)), (a, b)


# The fixed scenes on request, and nothing else.
scenes = os.path.join(folder, "scenes")
done = run("cover", "diffuse", "glass", "field-500", "ball-80", "-o", scenes)
assert done.stdout == ""
assert sorted(os.listdir(scenes)) == ["ball-80.json", "cover.json", "diffuse.json", "field-500.json", "field-500.ply", "glass.json"]
cover, diffuse, glass = (json.load(open(os.path.join(scenes, n + ".json"))) for n in ("cover", "diffuse", "glass"))
assert len(cover["spheres"]) == len(diffuse["spheres"]) == len(glass["spheres"]) > 450
assert {m["type"] for m in diffuse["materials"].values()} == {"lambertian"}
assert sum(m["type"] == "lambertian" for m in glass["materials"].values()) == 1
assert [s["center"] for s in cover["spheres"]] == [s["center"] for s in glass["spheres"]]
# The ball is closed and seen from outside: each edge once each way, and corners run counter-clockwise.
corners = [[tuple(v) for v in t["vertices"]] for t in json.load(open(os.path.join(scenes, "ball-80.json")))["triangles"]]
edges = [(t[k], t[k - 2]) for t in corners for k in range(3)]
assert len(corners) == 80 and len({v for t in corners for v in t}) == 42
assert len(set(edges)) == 240 and {(b, a) for a, b in edges} == set(edges)
for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in corners:
    assert ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx) > 0

# A measurement: a file and a fixed scene, small and short.
path = os.path.join(scenes, "cover.json")
report = json.loads(run(path, "field-500", "--width", "40", "--time", "0.03", "--rounds", "3", "--json", "-", "-q").stdout)
assert report["rounds"] == 3 and report["device"]["name"]
assert [s["name"] for s in report["scenes"]] == [path, "field-500"]
for scene in report["scenes"]:
    assert scene["width"] == 40 and scene["height"] == 22
    for key in ("samples_per_second", "segments_per_second", "nanoseconds_per_segment", "cpu_nanoseconds_per_segment",
                "load_seconds", "tree_seconds", "kernel_build_seconds"):
        figure = scene[key]
        assert len(figure["rounds"]) == 3 and min(figure["rounds"]) > 0, (key, figure)
        low, middle, high = statistics.quantiles(figure["rounds"], n=4, method="inclusive")
        close(figure["low"], low)
        close(figure["median"], middle)
        close(figure["high"], high)
    close(scene["nanoseconds_per_segment"]["median"] * scene["segments_per_second"]["median"], 1e9)
    # samples of different rounds see the same picture, so segments a sample stay close
    for samples, segments in zip(scene["samples_per_second"]["rounds"], scene["segments_per_second"]["rounds"]):
        close(segments / samples, scene["segments_per_sample"], .2)
    assert 1 <= scene["segments_per_sample"] < 10
    assert scene["bytes_per_sphere"] * scene["spheres"] >= 16 * scene["spheres"]
    assert scene["invalid_samples"] == 0 and all(0 < m < 1 for m in scene["mean_radiance"])
assert report["scenes"][1]["spheres"] == 500
assert os.listdir(folder) == ["scenes"], "the temporary folder must be gone"

# The table; --quiet leaves it out.
options = ["field-500", "--width", "20", "--time", "0.02", "--rounds", "1"]
lines = run(*options).stdout.splitlines()
assert any(line.startswith("field-500") and " 500 " in line for line in lines), lines
assert run(*options, "-q").stdout == ""

# What cannot be measured is refused by name.
assert "nowhere.json" in run("nowhere.json", code=2).stderr
for name in ("field-0", "ball-0", "ball-81", "ball-320x"):
    assert name in run(name, code=2).stderr
assert "depth" in run("field-500", "--depth", "0", "--width", "20", "-q", code=2).stderr
assert os.listdir(folder) == ["scenes"]

# However it ends, the folder of the fixed scenes goes with it: Ctrl-C, an impatient second one, a kill.
# The kills come as soon as there is anything to leave behind.
for signals in ([signal.SIGINT], [signal.SIGINT, signal.SIGINT], *3 * [[signal.SIGKILL]]):
    process = subprocess.Popen([program, "bench", "field-200000", "--time", "60"], env=environment,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    limit = time.monotonic() + 60
    while os.listdir(folder) == ["scenes"] and time.monotonic() < limit:
        if signals[0] == signal.SIGINT:
            time.sleep(0.005)
    assert os.listdir(folder) != ["scenes"], "it has written no scene"
    for number in signals:
        if number == signal.SIGINT:
            os.killpg(process.pid, number)  # as the terminal sends it
        else:
            process.send_signal(number)
        time.sleep(0.3)
    code = process.wait(timeout=60)
    assert code == (130 if signals[0] == signal.SIGINT else -signal.SIGKILL), code
    limit = time.monotonic() + 60
    while os.listdir(folder) != ["scenes"] and time.monotonic() < limit:
        time.sleep(0.01)
    assert os.listdir(folder) == ["scenes"], signals
