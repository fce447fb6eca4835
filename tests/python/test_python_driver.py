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

    # Where pip puts the drivers of two packages, and its list of their files.
    site = folder / "lib/python3/site-packages"
    for package_name, file in (("pocl_binary_distribution", "pyopencl/.libs/libpocl-0123abcd.so"),
                               ("intel_opencl_rt", "../../libintelocl.so")):
        library = site / file
        library.parent.mkdir(parents=True, exist_ok=True)
        library.touch()
        if file.startswith(".."):
            library = library.resolve()
        info = site / f"{package_name}-3.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package_name.replace('_', '-')}\nVersion: 3.0\n")
        (info / "RECORD").write_text(f"{package_name}/__init__.py,,\n{file},,\n")
        if package_name.startswith("pocl"):
            sys.path.insert(0, str(site))
            assert _driver.packaged_driver() == library, _driver.packaged_driver()

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
