"""What the program does on a GPU, where there is none: a processor's driver that says it is one (gpu_shim.c).

Usage: test_pretended_gpu.py BALLPARK SOURCE_DIR GPU_SHIM [--deep [--nightly]]

One work-item a sample, or a pool of samples for each work-group, narrow nodes, hits refined in float, no double anywhere:
the recorded pictures come out, bit for bit, and so does a whole render. --deep compares all recorded pictures, and whole
renders with those of Mesa's driver, which takes minutes to compile a kernel with all effects: its recorded pictures are left
to --nightly. So is noise: on Mesa's driver the other scene goes the same way through the host, and PoCL draws both.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from drivers import icd

program, source, shim = sys.argv[1], pathlib.Path(sys.argv[2]), os.path.abspath(sys.argv[3])
deep, nightly = "--deep" in sys.argv, "--nightly" in sys.argv
DRIVERS = {"pocl.icd": {}}
if deep:
    DRIVERS["rusticl.icd"] = {"RUSTICL_ENABLE": "llvmpipe"}
SCENES = ("bubble", "checker-surface", "noise", "normals", "swarm", "tie") if deep else ("bubble", "swarm", "tie")
recorded = [p for p in json.loads((source / "host/check/bits.json").read_text())["pictures"]
            if (p["precision"], p["refinement"]) == ("single", "float")]
RENDERED = ("noise", "bubble") if deep else ("bubble",)  # the last of them in parts too
ran, first = 0, {}  # pictures of the first driver, by scene


def run(environment, *arguments, code=0):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=900, check=False,
                          env={**os.environ, **environment})
    assert done.returncode == code, f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr[-3000:]}"
    return done


def compare_recorded(folder, driver, gpu):
    pictures = [p for p in recorded if driver == "pocl.icd" and deep or p["scene"] in SCENES]
    assert len(pictures) >= len(SCENES), "a scene is not recorded"
    (folder / "bits.json").write_text(json.dumps({"pictures": pictures}))
    for kernel in ("sample", "pool"):
        run(gpu, "check", "--bits", "--kernel", kernel, "--quiet", "--json", folder / "report.json")
        results = json.loads((folder / "report.json").read_text())["results"]
        same = sum(r["verdict"] == "agree" for r in results)
        assert same == len(results) == 2 * len(pictures), f"{same} of {len(results)}"
        assert {(r["kernel"], r["refinement"]) for r in results} == {(kernel, "float")}
        assert {r["device"]["type"] for r in results} == {"gpu"}
        print(f"{driver}: {same} pictures the same on a pretended GPU, --kernel {kernel}")


def pretend(folder, driver, environment):
    gpu = {**environment, "OCL_ICD_VENDORS": icd(driver), "LD_PRELOAD": shim, "BALLPARK_BITS": str(folder / "bits.json")}
    listed = json.loads(run(gpu, "devices", "--json", "-").stdout)["devices"]
    assert [(d["type"], d["double"]) for d in listed] == [("gpu", False)] * len(listed), listed

    if driver == "pocl.icd" or nightly:
        compare_recorded(folder, driver, gpu)

    # What a user gets without any option, to the file; chunks of other sizes and an interruption change nothing.
    stats = folder / "stats.json"
    size = ("--width", 24, "--quiet", "--force", "--stats", stats)
    # Mesa's compiler takes minutes for what a calibration tries.
    form = () if driver == "pocl.icd" or nightly else ("--kernel", "sample")
    for name in RENDERED if driver == "pocl.icd" or nightly else RENDERED[-1:]:
        scene = source / f"tests/agree/scenes/{name}.json"
        run(gpu, "render", scene, "--spp", 8, *size, *form, "-o", folder / "a.pfm")
        said = json.loads(stats.read_text())
        kernel = form[1] if form else said["calibration"]["kernel"]
        assert (said["device"]["type"], said["kernel"], said["invalid_samples"]) == ("gpu", kernel, 0), said
        assert first.setdefault(name, (folder / "a.pfm").read_bytes()) == (folder / "a.pfm").read_bytes(), \
            f"{driver} draws another picture of {name}"
    for begin, part in ((0, "b.bpa"), (4, "c.bpa")):
        run(gpu, "render", scene, "--spp", 4, "--first-sample", begin, *size, *form, "-o", folder / part)
    run(gpu, "merge", folder / "b.bpa", folder / "c.bpa", "--quiet", "-o", folder / "d.pfm")
    assert (folder / "a.pfm").read_bytes() == (folder / "d.pfm").read_bytes(), "parts make another picture"
    run(gpu, "render", scene, "--spp", 8, *size, "--kernel", "pool", "-o", folder / "p.pfm")
    said = json.loads(stats.read_text())
    assert (said["kernel"], said["invalid_samples"]) == ("pool", 0), said
    assert (folder / "a.pfm").read_bytes() == (folder / "p.pfm").read_bytes(), "the pool form makes another picture"
    failed = run(gpu, "render", scene, "--precision", "double", *size, "-o", folder / "e.pfm", code=1)
    assert "has no double precision" in failed.stderr, failed.stderr


for driver_icd, settings in DRIVERS.items():
    if not os.path.exists(f"/etc/OpenCL/vendors/{driver_icd}"):
        print(f"skipped: no {driver_icd} here")
        continue
    with tempfile.TemporaryDirectory() as name:
        listed = subprocess.run([program, "devices"], capture_output=True, timeout=120, check=False,
                                env={**os.environ, **settings, "OCL_ICD_VENDORS": icd(driver_icd)})
        if listed.returncode != 0:
            print(f"skipped: {driver_icd} has no device here")
            continue
        pretend(pathlib.Path(name), driver_icd, settings)
    ran += 1
sys.exit(0 if ran else 77)
