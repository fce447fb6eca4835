"""Calibration, on a processor's driver that says it is a GPU (gpu_shim.c): which form of the kernel a GPU gets is tried
once, remembered, tried again where the memory is damaged, said where users look, and changes no picture.

Usage: test_calibration.py BALLPARK SOURCE_DIR GPU_SHIM
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from drivers import icd

program, source, shim = sys.argv[1], pathlib.Path(sys.argv[2]), os.path.abspath(sys.argv[3])
if not os.path.exists("/etc/OpenCL/vendors/pocl.icd"):
    print("skipped: no pocl.icd here")
    sys.exit(77)
CPU = {**os.environ, "OCL_ICD_VENDORS": icd("pocl.icd")}
GPU = {**CPU, "LD_PRELOAD": shim}


def run(environment, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=600, check=False, env=environment)
    assert done.returncode == 0, f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr[-3000:]}"
    return done.stdout + done.stderr


def render(environment, *options):
    """The picture's bytes, what --stats says, and what the program says."""
    picture, stats = folder / "picture.pfm", folder / "stats.json"
    said = run(environment, "render", source / "tests/agree/scenes/bubble.json", "--width", 24, "--spp", 4, "-o", picture,
               "--stats", stats, *options)
    return picture.read_bytes(), json.loads(stats.read_text()), said


def checksum(text):
    """FNV-1a, as base/hash.h."""
    hashed = 0xcbf29ce484222325
    for byte in text.encode():
        hashed = (hashed ^ byte) * 0x100000001b3 % 2 ** 64
    return f"checksum: {hashed:016x}\n"


def rewrite(**lines):
    """The remembered outcome with other lines, and a checksum that fits."""
    text = "".join(f"{line.split(':')[0]}: {lines[line.split(':')[0]]}\n" if line.split(":")[0] in lines else line + "\n"
                   for line in memory().read_text().splitlines()[:-1])
    memory().write_text(text + checksum(text))


def memory():
    found = list((folder / "ballpark").glob("calibration-*.txt"))
    assert len(found) == 1, found
    return found[0]


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    CPU["XDG_CACHE_HOME"] = GPU["XDG_CACHE_HOME"] = name

    # A processor has the packet form, and is not tried.
    expected, stats, said = render(CPU, "--kernel", "sample")
    assert stats["calibration"] is None and "calibrated" not in said, said
    assert json.loads(run(CPU, "devices", "--json", "-"))["devices"][0]["calibration"] is None
    assert "calibrated" not in run(CPU, "devices")
    assert stats["device"]["type"] == "cpu" and not list((folder / "ballpark").glob("calibration-*"))

    # Nor is a GPU whose form the user names.
    for kernel in ("sample", "pool"):
        picture, stats, said = render(GPU, "--kernel", kernel)
        assert (stats["kernel"], stats["calibration"]) == (kernel, None), stats
        assert "calibrated" not in said and not list((folder / "ballpark").glob("calibration-*")), said
    assert "not calibrated yet" in run(GPU, "devices")
    assert json.loads(run(GPU, "devices", "--json", "-"))["devices"][0]["calibration"] is None
    float_picture = picture  # hits are refined in float

    # The first render tries, and says so; the next remembers.
    picture, first, said = render(GPU)
    found = first["calibration"]
    assert picture == float_picture, "calibration changes the picture"
    assert found["seconds"] > 0 and found["gain"] >= 1 and first["kernel"] == found["kernel"], first
    assert "once: --kernel " + found["kernel"] in " ".join(said.split()), said
    kept = memory().read_text()
    picture, again, said = render(GPU)
    assert again["calibration"] == {**found, "seconds": 0, "gain": again["calibration"]["gain"]}, (found, again)
    assert "calibrated" not in said and memory().read_text() == kept and picture == float_picture
    listed = json.loads(run(GPU, "devices", "--json", "-"))["devices"][0]["calibration"]
    assert listed == {key: value for key, value in again["calibration"].items() if key != "seconds"}, listed
    assert "calibrated: --kernel " + found["kernel"] in run(GPU, "devices")

    # What is remembered decides, whatever it is, and --kernel decides over it.
    for lines, kernel in (({"kernel": "pool", "group": 32, "samples": 5, "gain": 1.5}, "pool"),
                          ({"kernel": "sample", "group": 16, "samples": 1, "gain": 1.25}, "sample")):
        rewrite(**lines)
        picture, stats, _ = render(GPU)
        assert stats["kernel"] == kernel and picture == float_picture, stats
        assert stats["calibration"] == {"kernel": kernel, "group": lines["group"], "samples_per_item": lines["samples"],
                                        "gain": lines["gain"], "seconds": 0}, stats
        assert f"{lines['gain']:.2f} times as fast" in " ".join(run(GPU, "devices").split())
    _, stats, _ = render(GPU, "--kernel", "pool")
    assert (stats["kernel"], stats["calibration"]) == ("pool", None), stats

    # A damaged memory is none: it is tried again, and mended.
    text = memory().read_text()
    memory().write_text(text.replace("kernel: sample", "kernel: pool"))  # and the checksum is that of the other text
    assert "not calibrated yet" in run(GPU, "devices")
    _, stats, _ = render(GPU)
    assert stats["calibration"]["seconds"] > 0, stats
    _, stats, _ = render(GPU)
    assert stats["calibration"]["seconds"] == 0, stats

    # Without a home for what is remembered, it is tried each time.
    (folder / "file").write_text("")
    picture, stats, _ = render({**GPU, "XDG_CACHE_HOME": str(folder / "file")})
    assert stats["calibration"]["seconds"] > 0 and picture == float_picture, stats
