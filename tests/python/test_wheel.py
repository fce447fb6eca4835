"""scripts/wheel makes a wheel that works in a fresh environment, away from the source tree: with the system's driver, and
with that of the extra `cpu`, without a driver of the system. Its libraries come with it.

Usage: test_wheel.py SOURCE_DIR BUILD_DIR. What needs PyPI and cannot reach it is skipped.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

import package

source, build = map(pathlib.Path, sys.argv[1:])
left_out = []

DRAW = """
import os, pathlib, sys
import numpy as np, ballpark
assert "site-packages" in ballpark.__file__, ballpark.__file__
picture = ballpark.render(np.random.default_rng(1).random((1000, 3)), radius=0.03, color="#4477aa", width=32, spp=4)
picture.save(sys.argv[1])
maps = pathlib.Path("/proc/self/maps").read_text()
print("LIBRARIES", *sorted({line.split()[-1] for line in maps.splitlines() if ".so" in line}))
print("DRIVER", ballpark.devices()[0].driver)
"""


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    print("+", *command, done.stdout, done.stderr, flush=True)
    return done


def environment_with(**variables):
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "BALLPARK_", "OCL_ICD"))}
    return {**clean, **variables}


def draw(python, folder, name, **variables):
    done = run(python, "-c", DRAW, folder / name, cwd=folder, env=environment_with(**variables))
    assert done.returncode == 0, done.stderr
    return (folder / name).read_bytes(), done.stdout


def main(folder):
    made = run(sys.executable, source / "scripts/wheel", folder, cwd=folder, env={**os.environ, "BALLPARK_BUILD": str(build)})
    assert made.returncode == 0, made.stderr
    wheel = pathlib.Path(made.stdout.splitlines()[-1])
    assert re.fullmatch(r"ballpark_render-[\d.]+-py3-none-(manylinux_\d+_\d+|linux)_\w+\.whl", wheel.name), wheel.name
    with zipfile.ZipFile(wheel) as archive:
        assert archive.testzip() is None
        names = archive.namelist()
        assert sum(name.endswith("LICENSE") for name in names) == 1 and "ballpark/py.typed" in names
        bundled = "manylinux" in wheel.name
        if bundled:
            assert any(re.search(r"\.libs/libOpenCL", name) for name in names), names
        else:
            left_out.append("auditwheel cannot be had: the wheel stands on the system's libraries")

    environment = folder / "environment"
    if run(sys.executable, "-m", "venv", environment).returncode != 0:
        package.skip("this Python makes no virtual environments (python3-venv)")
    python = environment / "bin/python"
    pip = [python, "-m", "pip", "--disable-pip-version-check", "--quiet", "install"]
    online = run(*pip, wheel).returncode == 0
    if not online:
        left_out.append("PyPI cannot be reached: numpy is the system's, and the extra is not tried")
        assert run(sys.executable, "-m", "venv", "--system-site-packages", environment).returncode == 0
        assert run(*pip, "--no-deps", "--no-index", wheel).returncode == 0
        if run(python, "-c", "import numpy").returncode != 0:
            package.skip("no numpy, and no PyPI to fetch it from")
    assert "ballpark-render" in run(python, "-m", "pip", "list").stdout

    picture, output = draw(python, folder, "system.pfm")
    libraries = next(line for line in output.splitlines() if line.startswith("LIBRARIES")).split()[1:]
    mine = [path for path in libraries if str(environment) in path]
    assert any("/ballpark/libballpark" in path for path in mine), libraries
    if bundled:
        for name in ("libOpenCL", "libjansson", "libpng16", "libOpenEXRCore"):
            assert any(f"/{name}" in path for path in mine), (name, mine)

    # The same bits as the library of the build tree.
    expected = folder / "expected.pfm"
    done = run(sys.executable, "-c", DRAW.replace('assert "site-packages"', 'assert "ballpark"'), expected,
               env=dict(os.environ, PYTHONPATH=f"{source}/python", BALLPARK_LIBRARY=f"{build}/libballpark.so"))
    if done.returncode == 0:
        assert expected.read_bytes() == picture, "the wheel draws other bits than the build tree"
    else:
        left_out.append("no numpy beside the test: the bits are not compared with the build tree's")

    if not online:
        return
    if run(*pip, f"{wheel}[cpu]").returncode != 0:
        left_out.append("intel-opencl-rt cannot be fetched: the extra is not tried")
        return
    packaged, output = draw(python, folder, "packaged.pfm", BALLPARK_DRIVER="pypi", XDG_CACHE_HOME=str(folder / "cache"))
    assert "/libintelocl.so" in output, output
    assert packaged == picture, "the driver from PyPI draws other bits"


with tempfile.TemporaryDirectory() as name:
    main(pathlib.Path(name))
for reason in left_out:
    print(f"skipped: {reason}")
print("ok")
