"""The recorded pictures on other instruction sets and drivers, bit for bit (`ballpark check --bits`).

Usage: test_bits.py BALLPARK SOURCE_DIR [--nightly]

PoCL compiles for another processor when POCL_KERNELLIB_NAME names another library of built-in functions: that of SSE2
has no fused multiply-add, that of AVX2 has no masks. All forms of the kernel on this processor are a test of
test_cli_bits. Here each library has the form that CPUs use and others, with a tree and with a list; together the
libraries have every form. This processor's own library is left out. What takes long is compiling, twice as long without fused
multiply-adds, and three times as long again where PoCL optimises. So only with --nightly it optimises packets, as it does for
users, and scenes have kernels of their own with every library; else with AVX2 alone, in one form.

Other drivers render a few pictures, by the one-path form and with hits refined in float, as GPUs do, since their
compilers are slow. Intel's has a test of its own. Mesa's takes minutes for a kernel with all effects, so it is tried with
--nightly only; test_pretended_gpu draws with smaller kernels on it.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from drivers import icd
from lamps_sampled import with_lamps

program, source, nightly = sys.argv[1], pathlib.Path(sys.argv[2]), "--nightly" in sys.argv
recorded = json.loads((source / "host/check/bits.json").read_text())["pictures"]
ran = 0
# Kernel, precision, refinement: what other code is generated for. The first of each is what CPUs use.
FORMS = {
    "avx2": [("packet", "single", "double"), ("packet", "single", "float"), ("packet", "double", "double")],
    "sse41": [("packet", "single", "double"), ("sample", "double", "double")],
    "sse2": [("packet", "single", "double"), ("sample", "single", "float"), ("sample", "single", "double")],
}
LAMPS = with_lamps(program, source, sorted({p["scene"] for p in recorded}))  # these have kernels of their own


def check(folder, environment, *more, wrapper=(), seconds=500):
    report = pathlib.Path(folder, "report.json")
    report.unlink(missing_ok=True)
    done = subprocess.run([*wrapper, program, "check", "--bits", "--quiet", "--json", str(report), *more], text=True,
                          capture_output=True, env={**os.environ, **environment}, timeout=seconds, check=False)
    results = json.loads(report.read_text())["results"] if report.exists() else []
    return done, results


def count(results, verdict):
    return sum(result["verdict"] == verdict for result in results)


def device_names(environment):
    """PoCL's devices, as it calls them; their names tell the instruction set."""
    done = subprocess.run([program, "devices", "--json", "-"], text=True, capture_output=True, check=True, timeout=60,
                          env={**os.environ, "OCL_ICD_VENDORS": icd("pocl.icd"), **environment})
    return [device["name"] for device in json.loads(done.stdout)["devices"]]


def pocl_libraries():
    """The libraries for x86-64 that this processor can run, without its own."""
    flags = pathlib.Path("/proc/cpuinfo").read_text().split() if os.path.exists("/proc/cpuinfo") else []
    known = {"avx2": "avx2", "sse41": "sse4_1", "sse2": "sse2"}
    assert known.keys() == FORMS.keys()
    found = [name for name, flag in known.items()
             if flag in flags and list(pathlib.Path("/usr/share/pocl").glob(f"kernel-x86_64-*-{name}.bc"))]
    for name in known.keys() - set(found):
        print(f"skipped: PoCL's built-in functions for {name} are not installed, or the processor lacks it")
    own = device_names({})
    for name in [name for name in found if not nightly and device_names({"POCL_KERNELLIB_NAME": name}) == own]:
        found.remove(name)
        print(f"{name} is what PoCL takes by itself on this processor: test_cli_bits")
    return found


def instruction_sets(folder):
    """PoCL as it would be on other processors."""
    global ran
    names = set()
    for library in pocl_libraries():
        for form in FORMS[library]:
            kernel, precision, refinement = form
            with_own = form == FORMS[library][0] and (nightly or library == "avx2")
            pictures = [p for p in recorded if (p["precision"], p["refinement"]) == (precision, refinement)
                        and (p["scene"] not in LAMPS or with_own)]
            pathlib.Path(folder, "pictures.json").write_text(json.dumps({"pictures": pictures}))
            done, results = check(folder, {"OCL_ICD_VENDORS": icd("pocl.icd"), "POCL_KERNELLIB_NAME": library,
                                           "POCL_EXTRA_BUILD_FLAGS": "" if nightly and kernel == "packet" else "-cl-opt-disable -DSHORT_CHAINS",
                                           "BALLPARK_BITS": str(pathlib.Path(folder, "pictures.json"))}, "--kernel", kernel)
            assert done.returncode == 0, f"{library}: exit code {done.returncode}\n{done.stdout}{done.stderr[-3000:]}\n" \
                "If pictures were to change, record them anew: scripts/record-bits"
            assert done.stderr == "", f"{library}: a compiler should say nothing: {done.stderr[-3000:]}"
            assert len(pictures) >= (25 if with_own else 15) and count(results, "agree") == 2 * len(pictures), "hardly anything was compared"
            names.add(results[0]["device"]["name"])
            print(f"PoCL, {library}, {' '.join(form)}: {2 * len(pictures)} pictures the same, {results[0]['device']['name']}",
                  flush=True)
        ran += 1
    assert len(names) == ran, f"the libraries made no difference: {names}"


def other_driver(folder, name, environment, wrapper=()):
    global ran
    small = [p for p in recorded if (p["precision"], p["refinement"]) == ("single", "float")
             and p["scene"] in (("bubble", "checker-surface", "noise", "normals", "tie") if nightly else ("bubble", "noise"))]
    pathlib.Path(folder, "small.json").write_text(json.dumps({"pictures": small}))
    environment = {**environment, "BALLPARK_BITS": str(pathlib.Path(folder, "small.json"))}
    done, results = check(folder, environment, "--kernel", "sample", "--precision", "single", wrapper=wrapper)
    if not results:
        print(f"skipped: {name} cannot be used here: {(done.stderr.strip().splitlines() or ['no message'])[-1]}")
        return
    ran += 1
    print(f"{name}: {count(results, 'agree')} pictures the same, {results[0]['device']['name']}, "
          f"driver {results[0]['device']['driver']}")
    assert done.returncode == 0 and count(results, "agree") == 2 * len(small), \
        f"{name}: exit code {done.returncode}\n{done.stdout}{done.stderr}"


with tempfile.TemporaryDirectory() as folder:
    if os.path.exists("/etc/OpenCL/vendors/pocl.icd"):
        instruction_sets(folder)
    else:
        print("skipped: no PoCL here")
    if nightly and os.path.exists("/etc/OpenCL/vendors/rusticl.icd"):
        other_driver(folder, "rusticl", {"OCL_ICD_VENDORS": "rusticl.icd", "RUSTICL_ENABLE": "llvmpipe"})
    elif nightly:
        print("skipped: no rusticl here (Debian: mesa-opencl-icd)")
    if shutil.which("oclgrind"):
        other_driver(folder, "Oclgrind", {"BALLPARK_DRIVER_SECONDS": "0"}, wrapper=("oclgrind", "--build-options", "-O0"))
    else:
        print("skipped: no oclgrind here")
sys.exit(0 if ran else 77)
