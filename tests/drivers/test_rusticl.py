"""On a second driver, Mesa's rusticl on llvmpipe, the picture agrees with PoCL's.

Usage: test_rusticl.py BALLPARK SCENES CALL_FMA [--nightly]

CALL_FMA runs a kernel of one line. Where it crashes, the driver is broken, and the test is skipped. A scene with all
materials takes Mesa's compiler minutes, so it is for --nightly; else two matte spheres do.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

from drivers import icd
from pfm import read_pfm

program, scenes, call_fma = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
RUSTICL = dict(os.environ, OCL_ICD_VENDORS="rusticl.icd", RUSTICL_ENABLE="llvmpipe")
POCL = dict(os.environ, OCL_ICD_VENDORS=icd("pocl.icd"))


def has_device(environment):
    done = subprocess.run([program, "devices"], capture_output=True, text=True, env=environment, timeout=120)
    return done.returncode == 0 and ("llvmpipe" in done.stdout or environment is POCL)


def render(environment, scene, folder, *options):
    picture, stats = pathlib.Path(folder, "picture.pfm"), pathlib.Path(folder, "stats.json")
    command = [program, "render", str(scenes / scene), "--width", "32", "--spp", "64", "--quiet", "--force"]
    command += ["-o", str(picture), "--stats", str(stats), *options]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=500)
    assert done.returncode == 0, f"exit code {done.returncode}\n{done.stdout}{done.stderr}"
    return read_pfm(picture.read_bytes())[2], json.loads(stats.read_text())


if not os.path.exists("/etc/OpenCL/vendors/rusticl.icd") or not has_device(RUSTICL):
    print("skipped: no rusticl with llvmpipe here (Debian: mesa-opencl-icd)")
    sys.exit(77)
simplest = subprocess.run([call_fma], capture_output=True, text=True, env=RUSTICL, timeout=120)
if simplest.returncode < 0:
    print(f"skipped: this rusticl crashes (signal {-simplest.returncode}) in a kernel of one line that calls fma")
    sys.exit(77)
assert simplest.returncode == 0, f"a kernel that calls fma: exit code {simplest.returncode}\n{simplest.stdout}{simplest.stderr}"
if not has_device(POCL):
    print("skipped: no PoCL here to compare with")
    sys.exit(77)

with tempfile.TemporaryDirectory() as folder:
    scene = "v4-21-view-zoom.json" if "--nightly" in sys.argv else "v4-10-lambertian.json"
    other, other_stats = render(RUSTICL, scene, folder)
    print("rusticl:", json.dumps(other_stats["device"]), "kernel", other_stats["kernel"])
    own, own_stats = render(POCL, scene, folder, "--sampler", other_stats["sampler"])
    far, far_stats = render(POCL, scene, folder, "--sampler", other_stats["sampler"], "--seed", "1")


def luminance(stats):
    r, g, b = stats["mean_radiance"]
    return 0.2126 * r + 0.7152 * g + 0.0722 * b


def z(a, b):
    """Difference of the two pictures' brightness in standard errors, which nrmse gives a pixel."""
    pixels = a["width"] * a["height"]
    errors = [luminance(s) * s["nrmse"] / math.sqrt(pixels) for s in (a, b)]
    return (luminance(a) - luminance(b)) / math.hypot(*errors)


assert other_stats["invalid_samples"] == 0
# Other samples of the same picture: equal within statistics (|z| < 4.5: one false alarm in 150,000).
print(f"other seeds: z = {z(other_stats, far_stats):.2f}")
assert abs(z(other_stats, far_stats)) < 4.5
# The same samples: only where rounding sends a path another way may pixels differ.
apart = sum(1 for a, b in zip(other, own) if abs(a - b) > 1e-4 * max(abs(a), abs(b)))
print(f"same seed: {apart} of {len(own)} numbers differ by more than 1e-4")
assert apart <= len(own) // 20
# And the comparison can tell pictures apart: other seeds fail it.
assert sum(1 for a, b in zip(far, own) if abs(a - b) > 1e-4 * max(abs(a), abs(b))) > len(own) // 2
