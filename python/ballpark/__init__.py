"""Ballpark: a path tracer for spheres and triangles on any OpenCL device, with the noise of every picture.

    import numpy as np, ballpark
    picture = ballpark.render(np.random.rand(1000, 3), radius=0.02, color="#4477aa")
    picture.save("cloud.png")
"""

import typing

from . import _library
from ._library import DeviceError, Error, SceneError
from ._lines import Lines
from ._mesh import Mesh
from ._particles import from_ase, from_gsd, from_mdanalysis
from ._picture import Picture
from ._render import Device, Interrupted, Progress, Render, devices, make_scene, render
from ._scene import Camera, Scene, Spheres

__all__ = ["Camera", "Device", "DeviceError", "Error", "Interrupted", "Lines", "Mesh", "Picture", "Progress", "Render",
           "Scene", "SceneError", "Spheres", "devices", "from_ase", "from_gsd", "from_mdanalysis", "library_version",
           "make_scene", "render"]


def library_version() -> str:
    """The version and commit of the library, such as "0.1.0 (commit abcdef1)"."""
    text: bytes = _library.library().bp_version()
    return text.decode()


def __getattr__(name: str) -> typing.Any:
    """`__version__`, the library's, such as "0.1.0"; asked for, so that importing the package does not open the library."""
    if name == "__version__":
        return library_version().partition(" ")[0]
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
