"""Pictures: arrays of the library's memory, and files.

In:    a film of a render.   Out: numpy arrays without a copy, bytes of files, what notebooks show.
Knows: how the library lays out a picture.   Does not know: how it was made.
"""

import ctypes as c
import math
import os
import pathlib
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib
from ._arguments import c_text


class _Memory:
    """A BpPicture, released when the last array that looks at it is gone."""

    def __init__(self) -> None:
        self.struct = lib.BpPicture()

    def __del__(self) -> None:
        if lib._loaded is not None and hasattr(self, "struct"):
            lib.library().bp_picture_clear(c.byref(self.struct))


class _View:
    """Lets numpy see an array of the memory, which it keeps alive."""

    def __init__(self, memory: _Memory, address: int, shape: typing.Tuple[int, ...], kind: str):
        self.memory = memory
        self.__array_interface__ = {"version": 3, "data": (address, False), "shape": shape, "typestr": kind}


class Picture:
    """A rendered picture. The arrays look at the library's memory: nothing is copied, and they may be changed.

    radiance: (height, width, 3) float32, linear.
    standard_error: the same shape, of each channel's mean; NaN where unknown.
    samples: (height, width) uint64, valid samples of each pixel.
    alpha: (height, width), the share of camera rays that met something, where the scene's backdrop is "none", else None;
        the radiance is premultiplied by it.
    depth (height, width), normal and albedo (height, width, 3): with aovs=True, else None.
    invalid: how many samples were left out, by cause: "not finite", "negative", "out of range"; all 0 unless a device errs.
    noise: the picture's noise over its mean brightness (NRMSE), a fraction; NaN where unknown.
    stopped: why the render ended: "samples", "error", "time", "constant", "black", "invalid", "interrupt".
    seconds: what tracing took.
    """

    def __init__(self, film: lib.Handle, transfer: str, stopped: str, seconds: float):
        self._film = film
        self._memory = _Memory()
        lib.call("bp_film_picture", film.pointer, c.byref(self._memory.struct))
        struct = self._memory.struct
        self.width: int = struct.width
        self.height: int = struct.height
        self.transfer, self.stopped, self.seconds = transfer, stopped, seconds
        self.noise: float = lib.library().bp_film_nrmse(film.pointer)
        info = lib.BpFilmInfo()
        lib.library().bp_film_info(film.pointer, c.byref(info))
        self.invalid: typing.Dict[str, int] = {"not finite": info.not_finite_samples, "negative": info.negative_samples,
                                               "out of range": info.out_of_range_samples}
        self.radiance: npt.NDArray[np.float32] = self._array("rgb", 3)
        self.standard_error: npt.NDArray[np.float32] = self._array("error", 3)
        self.samples: npt.NDArray[np.uint64] = self._array("samples", 1, "<u8")
        self.alpha: typing.Optional[npt.NDArray[np.float32]] = self._optional("alpha", 1)
        self.depth: typing.Optional[npt.NDArray[np.float32]] = self._optional("depth", 1)
        self.normal: typing.Optional[npt.NDArray[np.float32]] = self._optional("normal", 3)
        self.albedo: typing.Optional[npt.NDArray[np.float32]] = self._optional("albedo", 3)

    def _array(self, member: str, channels: int, kind: str = "<f4") -> npt.NDArray[typing.Any]:
        shape = (self.height, self.width) + ((channels,) if channels > 1 else ())
        return np.asarray(_View(self._memory, getattr(self._memory.struct, member), shape, kind))

    def _optional(self, member: str, channels: int) -> typing.Optional[npt.NDArray[np.float32]]:
        return self._array(member, channels) if getattr(self._memory.struct, member) else None

    def _transfer(self, transfer: typing.Optional[str]) -> int:
        name = transfer or self.transfer
        if name not in lib.TRANSFERS:
            raise lib.SceneError(f'transfer: found "{name}", expected one of {", ".join(lib.TRANSFERS)}')
        return lib.TRANSFERS.index(name)

    def rgb8(self, transfer: typing.Optional[str] = None) -> npt.NDArray[np.uint8]:
        """(height, width, 3) bytes, as in an 8-bit file; `transfer`: "gamma2", "srgb", "linear", or the scene's."""
        out = np.empty((self.height, self.width, 3), np.uint8)
        lib.library().bp_picture_bytes(c.byref(self._memory.struct), self._transfer(transfer), out.ctypes.data)
        return out

    def encode(self, format: str = "png", transfer: typing.Optional[str] = None) -> bytes:
        """The bytes of a file: "png", "ppm", "ppm-ascii", "pfm" or "exr"."""
        if format not in lib.PICTURES:
            raise lib.SceneError(f'format: found "{format}", expected one of {", ".join(lib.PICTURES)}')
        data, size = c.c_void_p(), c.c_size_t()
        lib.call("bp_picture_encode", c.byref(self._memory.struct), lib.FORMATS.index(format),
                 self._transfer(transfer), c.byref(data), c.byref(size))
        try:
            return c.string_at(data.value or 0, size.value)
        finally:
            lib.library().bp_free(data)

    def save(self, path: typing.Union[str, "os.PathLike[str]"], transfer: typing.Optional[str] = None) -> None:
        """Writes a file, whole or not at all; its ending is .png, .ppm, .pfm, .exr (with all layers) or .bpa.

        A .bpa file holds the sums of the render, whatever was changed in the arrays since; `ballpark merge` adds it to
        others.
        """
        ending = pathlib.Path(path).suffix[1:].lower()
        if ending not in [*lib.PICTURES, "bpa"]:
            raise lib.SceneError(f'{path}: found the ending ".{ending}", expected .png, .ppm, .pfm, .exr or .bpa')
        if ending == "bpa":
            lib.call("bp_film_write", self._film.pointer, c_text("path", path))
        else:
            lib.call("bp_picture_write", c.byref(self._memory.struct), c_text("path", path), lib.FORMATS.index(ending),
                     self._transfer(transfer))

    def save_error_map(self, path: typing.Union[str, "os.PathLike[str]"]) -> None:
        """Writes a heat map of each pixel's noise, with a legend, as a PNG."""
        lib.call("bp_error_map_write", c.byref(self._memory.struct), c_text("path", path))

    def _repr_png_(self) -> bytes:
        """What notebooks show."""
        return self.encode("png")

    def __repr__(self) -> str:
        samples = float(self.samples.mean())
        noise = f"{100 * self.noise:.2g} % noise" if math.isfinite(self.noise) else "noise unknown"
        return (f"<ballpark.Picture: {self.width} x {self.height} pixels, {samples:.6g} sample{'s' if samples != 1 else ''} "
                f"per pixel, {noise}, stopped by {self.stopped}>")
