"""Every kind of kernel program is OpenCL C 1.2 to clang, without a warning; without double where none is needed.

Usage: test_kernels_syntax.py DUMP_KERNELS [--third | --rest | --lint]

--third reads every third program, --rest the others. --lint reads every third, with every warning of clang but those listed
here. Each version of clang has its own: it is meant for Debian 12's.
"""

import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

NAMES = ["clang"] + [f"clang-{version}" for version in range(22, 13, -1)]
clang = next(filter(None, map(shutil.which, NAMES)), None)
if clang is None:
    print("skipped: no clang here")
    sys.exit(77)

COMMAND = [clang, "-x", "cl", "-cl-std=CL1.2", "-fsyntax-only", "-Xclang", "-finclude-default-header"]
# A specialised program does not use everything it has.
COMMAND += ["-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-Wno-unused-parameter", "-Wno-unused-variable"]

if "--lint" in sys.argv:
    COMMAND += ["-Weverything"]
    # The language and its extensions as they are: declarations where they are needed, comparing to 0, padding that the
    # layout check sees, the pragma that OpenCL 1.2 needs for double.
    COMMAND += [f"-Wno-{name}" for name in ("declaration-after-statement", "float-equal", "padded", "pedantic-core-features")]
    # A specialised program does not use everything it has.
    COMMAND += [f"-Wno-{name}" for name in ("unused-macros", "unused-function", "unused-parameter", "unused-variable")]
    # Meant: a name of the lane dialect stands for itself with its lanes; work-items are counted in 32 bits; a count adds
    # a 0 or 1; `float` is refined in double; rows of boxes are aligned by the host; a lane set is read only where it was
    # written.
    COMMAND += [f"-Wno-{name}" for name in ("disabled-macro-expansion", "shorten-64-to-32", "sign-conversion",
                                            "double-promotion", "cast-align", "conditional-uninitialized")]

def complaints(path):
    # Without the extension a double literal is an error, as on a device that has none.
    fp64 = "+" if path.stem.endswith("_fp64") else "-"
    command = COMMAND + ["-Xclang", f"-cl-ext={fp64}cl_khr_fp64", str(path)]
    done = subprocess.run(command, capture_output=True, text=True)
    return "" if done.returncode == 0 and not done.stderr else f"{path.name}:\n{done.stderr}"


with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.argv[1], folder], check=True)
    # The check itself must be able to fail: an undeclared name, and a double where there is none.
    for name, text in ("undeclared", "kernel void f(global float *x) { *x = y; }"), (
        "double",
        "kernel void f(global float *x) { *x = *x * 0.1; }",
    ):
        bad = pathlib.Path(folder, f"{name}.bad")
        bad.write_text(text + "\n")
        assert complaints(bad), f"{name}: clang found nothing wrong with: {text}"

    # A choice that another one decides leaves the text as it is: each text is read once.
    paths = list({path.read_bytes(): path for path in sorted(pathlib.Path(folder).glob("*.cl"))}.values())
    assert len(paths) >= 50, f"only {len(paths)} programs"
    third = paths[::3]
    if "--rest" in sys.argv:
        paths = [path for path in paths if path not in third]
    elif {"--third", "--lint"} & set(sys.argv):
        paths = third
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [text for text in pool.map(complaints, paths) if text]

for text in found[:3]:
    print(text)
print(f"{len(paths)} programs, {len(found)} with complaints ({clang})")
sys.exit(1 if found else 0)
