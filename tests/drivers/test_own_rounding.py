"""A device that does not round quotients and roots correctly gives the recorded pictures all the same, bit for bit.

Usage: test_own_rounding.py BALLPARK SOURCE_DIR GPU_SHIM [--deep]

The device is PoCL's, which says that it does not round (gpu_shim.c), and whose quotients and roots, in a copy of the
kernels, are off by as much as OpenCL allows. --deep compares all pictures that are recorded in single precision, in both
forms, and on GPUs' terms too.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from drivers import icd

program, source, shim = sys.argv[1], pathlib.Path(sys.argv[2]), os.path.abspath(sys.argv[3])
deep = "--deep" in sys.argv
SCENES = ("bubble", "noise")
recorded = [p for p in json.loads((source / "host/check/bits.json").read_text())["pictures"] if p["precision"] == "single"
            and (deep or p["scene"] in SCENES)]
ROUGH = {"#define DEVICE_QUOTIENT(a, b) ((a) / (b))":
         "#define DEVICE_QUOTIENT(a, b) (real_of_bits(bits_of_real((a) / (b)) + 2u))",
         "#define DEVICE_ROOT(x) sqrt(x)": "#define DEVICE_ROOT(x) (real_of_bits(bits_of_real(sqrt(x)) - 3u))"}
NONE = {"#if !OWN_ROUNDING || REAL_IS_DOUBLE\n#define divide(a, b) ((a) / (b))\n#define square_root(x) sqrt(x)\n":
        "#if !REAL_IS_DOUBLE\n#define divide(a, b) real_of_bits(bits_of_real((vreal)((a) / (b))) + 2u)\n"
        "#define square_root(x) sqrt(x)\n"}


def run(environment, *arguments, code=0):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=900, check=False,
                          env={**os.environ, "OCL_ICD_VENDORS": icd("pocl.icd"), **environment})
    assert done.returncode == code, f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr[-3000:]}"
    return done


def kernels(folder, name, changes):
    """A copy of the kernels with changes of divide.cl, as BALLPARK_KERNELS."""
    shutil.copytree(source / "kernels", folder / name)
    file = folder / name / "dialect/divide.cl"
    text = file.read_text()
    for before, after in changes.items():
        assert text.count(before) == 1, before
        text = text.replace(before, after)
    file.write_text(text)
    return {"BALLPARK_KERNELS": str(folder / name)}


def compare(folder, environment, refinement, form):
    pictures = [p for p in recorded if p["refinement"] == refinement]
    (folder / "bits.json").write_text(json.dumps({"pictures": pictures}))
    run({**environment, "BALLPARK_BITS": str(folder / "bits.json")}, "check", "--bits", "--kernel", form, "--precision",
        "single", "--quiet", "--json", folder / "report.json")
    results = json.loads((folder / "report.json").read_text())["results"]
    return sum(r["verdict"] == "agree" for r in results), len(results), 2 * len(pictures)


if not os.path.exists("/etc/OpenCL/vendors/pocl.icd"):
    print("skipped: no PoCL here")
    sys.exit(77)
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    rough = {"LD_PRELOAD": shim, "PRETEND_ROUGH": "only"}
    forms = [("double", "packet"), ("float", "sample")] + deep * [("float", "packet"), ("double", "sample")]
    for refinement, form in forms:
        same, results, wanted = compare(folder, {**rough, **kernels(folder, f"{refinement}-{form}", ROUGH)}, refinement, form)
        assert same == results == wanted >= 2 * len(SCENES), (form, refinement, same, results, wanted)
        print(f"{form}, refined in {refinement}: {same} pictures the same on a device that is off by 2 and 3 units", flush=True)
    if deep:
        gpu = {"LD_PRELOAD": shim, "PRETEND_ROUGH": "1", **kernels(folder, "gpu", ROUGH)}
        same, results, wanted = compare(folder, gpu, "float", "sample")
        assert same == results == wanted, (same, results, wanted)
        print(f"a pretended GPU: {same} pictures the same")
    # Without it such a device is refused, for it has other pictures.
    none = {**rough, **kernels(folder, "none", NONE)}
    scene = ("render", source / "tests/agree/scenes/noise.json", "--width", 24, "--spp", 4, "--quiet", "--kernel", "sample")
    refused = run(none, *scene, "-o", folder / "refused.pfm", code=1)
    assert "self-test" in refused.stderr and "rounding of a / b (" in refused.stderr, refused.stderr
    run(none, *scene, "--force", "-o", folder / "none.pfm")
    run({}, *scene, "-o", folder / "right.pfm")
    assert (folder / "none.pfm").read_bytes() != (folder / "right.pfm").read_bytes(), "the fault makes no difference"

    # The pass of a build that rounds is no pass of one that does not.
    cache = folder / "cache"
    cache.mkdir()
    scene = ("render", source / "tests/agree/scenes/tie.json", "--width", 8, "--spp", 1, "--quiet", "-o", folder / "p.ppm")
    for environment, passes in (({}, 1), ({}, 1), (rough, 2), (rough, 2), ({}, 2)):
        run({**environment, "XDG_CACHE_HOME": str(cache)}, *scene)
        found = sorted((cache / "ballpark").glob("self-test-*.txt"))
        assert len(found) == passes, (environment, found)
    texts = {line for file in found for line in file.read_text().splitlines() if line.startswith("options: ")}
    assert len(texts) == 2, texts
    print("passes are kept apart:", "; ".join(sorted(texts)))
