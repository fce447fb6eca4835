"""Ballpark on 64-bit ARM, without such a machine: built by a cross compiler, run by qemu-user.

Usage: test_aarch64.py BUILD_DIR SOURCE_DIR [--nightly]

In:    aarch64-linux-gnu-gcc, qemu-aarch64, and Debian's packages for arm64, which make_root unpacks (58 MB from the network,
       the first time).
Out:   BUILD_DIR/aarch64, with the root and the build in it. They are kept, so a second run takes less.

The host code is built with warnings as errors, as a user would (-O3), and the unit tests that need no device run. There
`char` has no sign, `long double` has 128 bits, and the compiler has fused multiply-adds that nobody asked for.

Then PoCL for ARM compiles kernels, vectors of four lanes, and pictures must have the same bits as on this machine, whose
pictures test_cli_bits compares with the recorded ones. An emulated compiler takes ten times as long, so these are two
kernels, and PoCL optimises nothing. --nightly compares every recorded picture in every form that processors use, with kernels
as users have them.

qemu-user lets a program start only programs of this machine, so PoCL is given this machine's linker, for ARM.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import trim_pocl
from drivers import icd

build, source, nightly = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), "--nightly" in sys.argv
# Scene, width and samples; options; the form of the kernel, which for processors is packets. A tree of 2002 spheres of three
# materials.
PICTURES = [("swarm", 12, 8, [], "packet"), ("swarm", 12, 8, ["--kernel", "sample", "--precision", "double"], "sample")]
# Unit tests of much arithmetic, which take an emulator ten seconds to minutes.
LEFT_OUT = {"test_adaptive", "test_cost_parts", "test_divide", "test_effects_scenes", "test_film_damaged",
            "test_tree_shape", "test_tree_traversal"}
# Forks beside a thread that is at work: a child of qemu-user has the emulator's own locks as they were, some of them held by
# a thread that the child does not have, and may wait for them for ever.
LEFT_OUT |= {"test_output_forked"}
COMPILER = "aarch64-linux-gnu-gcc"
qemu = shutil.which("qemu-aarch64-static") or shutil.which("qemu-aarch64")
# Below the folder of the tests' own build, and on no path with links: PoCL finds its files from where its library lies.
home = build.resolve() / "aarch64"
root, own = home / "root", home / "build"


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def run(command, environment=None, seconds=900, code=0):
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=seconds, check=False,
                          stdin=subprocess.DEVNULL, env={**os.environ, **(environment or {})})
    assert code is None or done.returncode == code, \
        f"{command}: exit code {done.returncode}\n{done.stdout[-6000:]}{done.stderr[-6000:]}"
    done.seconds = time.monotonic() - start
    return done


def emulated(command, environment=None, **options):
    return run([qemu, "-L", root, *command], environment, **options)


def make():
    made = run([source / "tests/aarch64/make_root", root], code=None)
    if made.returncode == 77:
        print(made.stdout, end="")
        sys.exit(77)
    assert made.returncode == 0, f"make_root: exit code {made.returncode}\n{made.stdout}{made.stderr}"
    start = time.monotonic()
    run(["cmake", "-S", source, "-B", own, "-G", "Ninja", "--toolchain", source / "cmake/aarch64.cmake",
         f"-DAARCH64_ROOT={root}", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_COMPILE_WARNING_AS_ERROR=ON",
         "-DBALLPARK_BENCH=OFF", "-DBALLPARK_VIEW=OFF", "-DBALLPARK_TEXT=OFF", "-DBALLPARK_MPI=OFF", "--log-level=WARNING"])
    run(["cmake", "--build", own, "--target", "ballpark", "host_tests", "--", "--quiet"])
    machine = run(["file", "-b", own / "ballpark"]).stdout if shutil.which("file") else "aarch64"
    assert "aarch64" in machine, machine
    print(f"built without warnings in {time.monotonic() - start:.0f} s", flush=True)


def unit_tests():
    """Those in C that need no device, as ctest would run them."""
    listed = json.loads(run(["ctest", "--test-dir", own, "--show-only=json-v1", "-L", "^host$", "-LE", "^deep$"]).stdout)
    ran, failed = 0, []
    for test in listed["tests"]:
        command = test.get("command", [])
        if not command or not command[0].startswith(str(own)) or test["name"] in LEFT_OUT:
            continue  # not a program, or too much work
        properties = {p["name"]: p["value"] for p in test["properties"]}
        environment = dict(line.split("=", 1) for line in properties.get("ENVIRONMENT", []))
        done = emulated(command, environment, code=None)
        ran += 1
        if done.returncode not in (0, 77):
            failed.append(f"{test['name']}: exit code {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    assert not failed, "\n".join(failed)
    assert ran >= 30, f"only {ran} unit tests were found"
    print(f"{ran} unit tests that need no device passed", flush=True)


def pocl(folder):
    """The environment in which PoCL for ARM finds its files and a linker."""
    library = next((root / "usr/lib/aarch64-linux-gnu").glob("libpocl.so.*"))
    try:  # this machine's LLVM reads what that of ARM reads, if they are of one version
        _, llvm = trim_pocl.installed_pocl()
        if (library.parent / llvm.name).exists():
            library = trim_pocl.copy_pocl(library, llvm, folder / "pocl", source)
    except trim_pocl.CannotTrim as error:
        print(f"PoCL as it is installed: {error}")
    (folder / "vendors").mkdir()
    (folder / "vendors/pocl.icd").write_text(f"{library}\n")
    compiler_files = pathlib.Path(run([COMPILER, "-print-libgcc-file-name"]).stdout.strip()).parent
    linker = folder / "bin/ld"
    linker.parent.mkdir()
    linker.write_text(f"#!/bin/sh\nexec aarch64-linux-gnu-ld '--sysroot={root}' -L=/usr/lib/aarch64-linux-gnu "
                      f"-L=/lib/aarch64-linux-gnu '-L{compiler_files}' \"$@\"\n")
    linker.chmod(0o755)
    for name in ("cache", "kernels"):
        (folder / name).mkdir()
    # COMPILER_PATH: before the linker of a cross compiler that it finds here by itself, which knows nothing of the root.
    return {"OCL_ICD_VENDORS": str(folder / "vendors"), "COMPILER_PATH": str(folder / "bin"),
            "XDG_CACHE_HOME": str(folder / "cache"), "POCL_CACHE_DIR": str(folder / "kernels")}


def same_pictures(folder, environment):
    stats = folder / "stats.json"
    for scene, width, samples, options, form in PICTURES:
        files = folder / "here.pfm", folder / "there.pfm"
        words = ["render", source / f"tests/agree/scenes/{scene}.json", "--width", width, "--spp", samples, *options,
                 "--quiet", "--stats", stats, "-o"]
        soon = {"POCL_EXTRA_BUILD_FLAGS": "-cl-opt-disable -DSHORT_CHAINS"}
        run([build / "ballpark", *words, files[0]], {"OCL_ICD_VENDORS": icd("pocl.icd"), **soon})
        done = emulated([own / "ballpark", *words, files[1]], {**environment, **soon})
        what = f"{scene}, {form} {' '.join(options)}"
        assert files[0].read_bytes() == files[1].read_bytes(), f"{what}: the pictures differ"
        assert json.loads(stats.read_text())["kernel"] == form, f"{what}: {stats.read_text()}"
        print(f"{what}: the same bits; the kernel and the picture took {done.seconds:.0f} s", flush=True)


def recorded_pictures(folder, environment):
    report = folder / "report.json"
    emulated([own / "ballpark", "check", "--bits", "--quiet", "--json", report], environment, seconds=3600)
    results = json.loads(report.read_text())["results"]
    forms = {(r["kernel"], r["acceleration"], r["precision"], r["refinement"]) for r in results if r["verdict"] == "agree"}
    assert len(forms) == 12 and all(r["verdict"] == "agree" for r in results), results
    print(f"{len(results)} recorded pictures in {len(forms)} forms: the same bits")


if qemu is None or shutil.which(COMPILER) is None:
    skip("no emulator or compiler for 64-bit ARM (Debian: qemu-user, gcc-aarch64-linux-gnu)")
home.mkdir(parents=True, exist_ok=True)
make()
unit_tests()
with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name).resolve()
    settings = pocl(place)
    if nightly:
        recorded_pictures(place, settings)
    else:
        same_pictures(place, settings)
