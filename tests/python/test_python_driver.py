"""Which driver the package chooses: the system's, that of PyPI where there is no other, and what is asked for.

Usage: test_python_driver.py SOURCE_DIR BUILD_DIR
"""

import os
import pathlib
import sys
import tempfile

import package

ballpark, _ = package.load(*sys.argv[1:])
from ballpark import _driver

VARIABLES = ("OCL_ICD_VENDORS", "BALLPARK_DRIVER")


def chosen(system, **variables):
    for name in VARIABLES:
        os.environ.pop(name, None)
    os.environ.update(variables)
    found = _driver.choose(str(system))
    return found, os.environ.get("OCL_ICD_VENDORS")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    with_driver, without = folder / "with", folder / "without"
    with_driver.mkdir()
    without.mkdir()
    (with_driver / "some.icd").write_text("libsome.so\n")

    if _driver.packaged_driver() is None:
        assert chosen(without) == (None, None)
        package.refused(ImportError, "[cpu]", chosen, without, BALLPARK_DRIVER="pypi")

    # As pocl-binary-distribution lies in site-packages.
    (folder / "site/pocl_binary_distribution").mkdir(parents=True)
    (folder / "site/pocl_binary_distribution/__init__.py").touch()
    library = folder / "site/pyopencl/.libs/libpocl-0123abcd.so"
    library.parent.mkdir(parents=True)
    library.touch()
    sys.path.insert(0, str(folder / "site"))

    here = str(library)
    assert chosen(without) == (here, here)
    assert chosen(folder / "nowhere") == (here, here)
    assert chosen(with_driver) == (None, None)
    assert chosen(with_driver, BALLPARK_DRIVER="pypi") == (here, here)
    assert chosen(without, BALLPARK_DRIVER="system") == (None, None)
    assert chosen(without, OCL_ICD_VENDORS="/mine") == (None, "/mine")
    assert chosen(without, OCL_ICD_VENDORS="/mine", BALLPARK_DRIVER="pypi") == (here, here)
    package.refused(ValueError, ["nvidia", "pypi"], chosen, without, BALLPARK_DRIVER="nvidia")
print("ok")
