"""mypy --strict accepts the package, and every name of the public interface is documented.

Usage: test_python_typing.py SOURCE_DIR BUILD_DIR
"""

import importlib.util
import inspect
import pathlib
import subprocess
import sys

import package

source = pathlib.Path(sys.argv[1])
ballpark, _ = package.load(source, sys.argv[2])

assert (source / "python/ballpark/py.typed").exists()
guide = (source / "docs/PYTHON.md").read_text(encoding="utf-8")
for name in ballpark.__all__:
    assert inspect.getdoc(getattr(ballpark, name)), f"{name} has no documentation"
for name in ("render", "make_scene", "Spheres", "Mesh", "Lines", "Render", "Interrupted", "from_ase", "from_gsd", "from_mdanalysis", "devices",
             "SceneError", "DeviceError"):
    assert name in guide, f"docs/PYTHON.md does not speak of {name}"

if importlib.util.find_spec("mypy") is None:
    package.skip("mypy is not installed for this Python: types are not checked")
done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", "/dev/null", source / "python/ballpark"],
                      capture_output=True, text=True, check=False)
print(done.stdout, done.stderr)
sys.exit(done.returncode)
