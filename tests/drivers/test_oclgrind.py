"""Under Oclgrind's checks for uninitialised values and data races, a small render has no report that is ours.

Usage: test_oclgrind.py BALLPARK SCENES

Two things are known of Oclgrind 21.10. It does not see that clEnqueueFillBuffer initialises a buffer, so it
reports every sum of the kernel `accumulate`; what it reads of samples is watched where the trace kernel writes
them. And it keeps one state for a whole vector, so the eight-lane kernel drowns in reports: it is left out.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program, scenes = sys.argv[1], pathlib.Path(sys.argv[2])
if shutil.which("oclgrind") is None:
    print("skipped: no oclgrind here")
    sys.exit(77)

# A kernel that does read what nobody wrote: the check must see it.
PLACE = "    const real cut ="
PLANTED = "    uint unwritten[1];\n    if (unwritten[0] == 0xffffffffu) number += 1u;\n" + PLACE

def reports(scene, folder, environment=None, check="--uninitialized", form="sample"):
    """(kernel, report) of every report; the run itself must succeed."""
    picture, log = pathlib.Path(folder, "picture.pfm"), pathlib.Path(folder, "log")
    # Oclgrind cannot run what LLVM's inliner leaves behind, so nothing is optimised.
    command = ["oclgrind", "--build-options", "-O0", check, "--max-errors", "1000000", "--log", str(log)]
    command += [program, "render", str(scenes / scene), "--width", "16", "--spp", "1", "--kernel", form]
    command += ["--device", "oclgrind", "--force", "-o", str(picture)]
    # It serves only the thread that has started it.
    environment = dict(environment or os.environ, BALLPARK_DRIVER_SECONDS="0")
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, env=environment)
    print(done.stdout, done.stderr, sep="", end="", flush=True)
    assert done.returncode == 0, f"exit code {done.returncode} for {scene}"
    assert picture.stat().st_size > 16 * 8 * 12, "the picture is too small"
    text = log.read_text(errors="replace")
    blocks = [block for block in re.split(r"\n\s*\n", text) if block.strip()]
    return [(found.group(1) if (found := re.search(r"Kernel:\s*(\w+)", block)) else "", block) for block in blocks]

with tempfile.TemporaryDirectory() as folder:
    kernels = pathlib.Path(folder, "kernels")
    shutil.copytree(scenes.parent / "kernels", kernels)
    trace = (kernels / "integrator/one_path.cl").read_text()
    assert trace.count(PLACE) == 1, "the place for the planted fault is gone from one_path.cl"
    (kernels / "integrator/one_path.cl").write_text(trace.replace(PLACE, PLANTED))

    found = reports("v4-21-view-zoom.json", folder, dict(os.environ, BALLPARK_KERNELS=str(kernels)))
    assert any(kernel == "trace" for kernel, _ in found), "a planted fault was not reported"

    ours = []
    # A list of spheres with glass, metal and diffuse ones; a tree and a lens; normals as colours.
    for scene in ("v4-21-view-zoom.json", "cover.json", "v4-normals-ground.json"):
        ours += [block for kernel, block in reports(scene, folder) if kernel != "accumulate"]
    ours += [block for kernel, block in reports("cover.json", folder, form="pool") if kernel != "accumulate"]
    for form in ("sample", "pool"):
        ours += [block for _, block in reports("v4-21-view-zoom.json", folder, check="--data-races", form=form)]

for block in ours[:5]:
    print(block, end="\n\n")
print(f"{len(ours)} reports")
sys.exit(1 if ours else 0)
