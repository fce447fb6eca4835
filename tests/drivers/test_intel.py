"""Intel's runtime for processors: every recorded picture bit for bit, and a kernel that is compiled once.

Usage: test_intel.py BALLPARK SOURCE_DIR

The runtime is looked for where BALLPARK_INTEL_OPENCL names its libintelocl.so, and among the system's drivers.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

program, source = sys.argv[1], pathlib.Path(sys.argv[2])
VENDORS = pathlib.Path("/etc/OpenCL/vendors")


def library():
    """Where the runtime is, or None."""
    named = os.environ.get("BALLPARK_INTEL_OPENCL")
    if named:
        return named
    for file in sorted(VENDORS.glob("*.icd")):
        line = file.read_text().strip()
        if "intelocl" in line:
            return line
    return None


def run(*arguments, code=0):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, env=environment, timeout=900,
                          check=False)
    assert done.returncode == code, f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr[-3000:]}"
    return done


def render(folder, *options):
    """The picture's bytes and what --stats says."""
    stats, picture = folder / "stats.json", folder / "picture.pfm"
    run("render", source / "scenes/cover.json", "--width", 48, "--spp", 4, "--quiet", "--force", "-o", picture, "--stats",
        stats, *options)
    return picture.read_bytes(), json.loads(stats.read_text())


found = library()
if found is None:
    print("skipped: no CPU runtime of Intel's here (pip install intel-opencl-rt intel-cmplr-lib-rt; CONTRIBUTING.md)")
    sys.exit(77)
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "vendors").mkdir()
    (folder / "vendors/intel.icd").write_text(found + "\n")
    environment = {**os.environ, "OCL_ICD_VENDORS": str(folder / "vendors"), "XDG_CACHE_HOME": name}
    environment.pop("BALLPARK_KERNEL_CACHE", None)
    listed = json.loads(run("devices", "--json", "-").stdout)["devices"]
    assert any("Intel" in device["platform"] for device in listed), f"{found} brings no device: {listed}"

    first, cold = render(folder)
    assert "Intel" in cold["device"]["platform"], cold["device"]
    kept = sorted((folder / "ballpark/kernels").glob("program-*.bin"))
    assert kept, "nothing is kept"
    second, warm = render(folder)
    times = [stats["seconds"]["kernel_build"] for stats in (cold, warm)]
    print(f"{cold['device']['name']}, driver {cold['device']['driver']}, {cold['kernel']}: compiled in {times[0]:.2f} s, "
          f"read in {times[1]:.3f} s")
    assert second == first, "another picture from the kept program"
    # Reading takes a fiftieth; a third is what a busy machine may make of it.
    assert times[1] < times[0] / 3, "the kept program is not used"
    # A part of the processor is a device of its own to the driver, but no other program.
    for options in (("--threads", 1), ("--kernel", "sample"), ("--device", "intel")):
        assert render(folder, *options)[0] == first, options
    for file in kept:
        file.write_bytes(file.read_bytes()[:-1])
    assert render(folder)[0] == first, "another picture after a damage"

    report = folder / "report.json"
    run("check", "--bits", "--quiet", "--json", report)
    results = json.loads(report.read_text())["results"]
    forms = {(r["kernel"], r["acceleration"], r["precision"], r["refinement"]) for r in results if r["verdict"] == "agree"}
    same = sum(r["verdict"] == "agree" for r in results)
    print(f"{same} pictures the same, in {len(forms)} forms")
    assert same == len(results) and len(forms) == 12, (same, len(results), forms)
