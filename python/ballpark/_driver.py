"""Which OpenCL driver is used: the system's, or that of the extra `cpu`, which comes from PyPI.

In:    the environment, the system's list of drivers, installed packages.   Out: OCL_ICD_VENDORS, if it has to be set.
Knows: how the OpenCL loader looks for drivers.   Does not know: what drivers do.
"""

import importlib.metadata
import os
import pathlib
import typing

SYSTEM_FOLDER = "/etc/OpenCL/vendors"  # where drivers register
# Packages of PyPI with a driver, the best first, and what their libraries are called.
PACKAGES = (("intel-opencl-rt", "libintelocl.so"), ("pocl-binary-distribution", "libpocl-*.so"))


def packaged_driver() -> typing.Optional[pathlib.Path]:
    """The library of the first of the packages that is installed."""
    for package, name in PACKAGES:
        try:
            files = importlib.metadata.files(package) or []
        except importlib.metadata.PackageNotFoundError:
            continue
        for file in files:
            library = pathlib.Path(str(file.locate()))
            if file.match(name) and library.is_file():
                return library.resolve()
    return None


def choose(system_folder: str = SYSTEM_FOLDER) -> typing.Optional[str]:
    """Points the OpenCL loader to the driver from PyPI where it is needed, and returns its path, or None.

    It is needed where the system has no driver at all, or where BALLPARK_DRIVER=pypi asks for it. An OCL_ICD_VENDORS
    that is set already stays as it is. The loader reads it when it is called first, so this comes before.
    """
    wanted = os.environ.get("BALLPARK_DRIVER", "")
    if wanted not in ("", "pypi", "system"):
        raise ValueError(f'BALLPARK_DRIVER: found "{wanted}", expected "pypi" or "system"')
    if wanted == "system" or (wanted == "" and os.environ.get("OCL_ICD_VENDORS")):
        return None
    if wanted == "" and any(pathlib.Path(system_folder).glob("*.icd")):
        return None
    library = packaged_driver()
    if library is None:
        if wanted == "pypi":
            raise ImportError("BALLPARK_DRIVER=pypi: no driver is installed: pip install 'ballpark-render[cpu]'")
        return None
    os.environ["OCL_ICD_VENDORS"] = str(library)
    return str(library)
