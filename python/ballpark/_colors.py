"""Colours of spheres: from texts, bytes, shares of light, or numbers by a colour map.

In:    what `color`, `cmap` and `color_range` may be.   Out: linear shares of light.
Knows: sRGB, the library's colour maps.   Does not know: positions, scenes.
"""

import ctypes as c
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib
from ._arguments import Array, read, without, wrong_type

Color = typing.Union[str, npt.ArrayLike]
Range = typing.Optional[typing.Tuple[float, float]]
GREY = 0.3  # where there is no number to map


def _srgb_to_linear(share: npt.NDArray[np.float64]) -> Array:
    """IEC 61966-2-1."""
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def _of_text(color: str, what: str) -> Array:
    digits = color[1:]
    if not color.startswith("#") or len(digits) not in (3, 6) or set(digits.lower()) - set("0123456789abcdef"):
        raise lib.SceneError(f'{what}: found "{color}", expected "#rrggbb" with hexadecimal digits, (r, g, b) or an array')
    if len(digits) == 3:
        digits = "".join(digit * 2 for digit in digits)
    return _srgb_to_linear(np.array([int(digits[i:i + 2], 16) for i in (0, 2, 4)]) / 255)


def _table(cmap: str) -> npt.NDArray[np.float32]:
    """256 colours of a map, and grey."""
    if not isinstance(cmap, str):
        raise wrong_type("cmap", cmap, 'a name such as "viridis"')
    table = np.full((257, 3), GREY, np.float32)
    rgb = (c.c_double * 3)()
    for place in range(256):
        if not lib.library().bp_color_map(cmap.encode(), place / 255, rgb):
            names: typing.List[str] = []
            while lib.library().bp_color_map_name(len(names)):
                names.append(lib.library().bp_color_map_name(len(names)).decode())
            raise lib.SceneError(f'cmap: found "{cmap}", expected one of {", ".join(names)}')
        table[place] = rgb[:]
    return table


def _ends(values: Array, color_range: Range, what: str) -> typing.Tuple[float, float]:
    """What the two ends of the map mean: those of the finite `values`, unless a range is given."""
    if color_range is None:
        finite = values[np.isfinite(values)]
        if len(finite) == 0 and len(values) > 0:
            raise lib.SceneError(f"{what}: found no finite number, expected some to map, or a color_range")
        return (float(finite.min()), float(finite.max())) if len(finite) > 0 else (0.0, 1.0)
    try:
        low, high = (float(end) for end in color_range)
    except (TypeError, ValueError):
        raise lib.SceneError(f"color_range: found {color_range!r}, expected two numbers") from None
    if not -np.inf < low <= high < np.inf:
        raise lib.SceneError(f"color_range: found {color_range!r}, expected two numbers, the lesser one first")
    return low, high


def map_colors(values: Array, cmap: str, color_range: Range, what: str = "color") -> npt.NDArray[np.float32]:
    """Colours for numbers; those that are not finite become grey."""
    table = _table(cmap)
    values = np.asarray(values, np.float64)
    low, high = _ends(values, color_range, what)
    width = high - low
    unit = 0.5 if width == np.inf else 2.0**64 if width < 1e-300 else 1.0  # neither `width` nor `scale` is infinite in it
    scale = 255 / (high * unit - low * unit) if width > 0 else 0.0
    with np.errstate(invalid="ignore", over="ignore"):
        places = np.clip((values * unit - low * unit) * scale + 0.5, 0, 255) if scale else np.full(values.shape, 127.0)
    places = np.where(np.isfinite(values), places, 256)
    colors: npt.NDArray[np.float32] = table[places.astype(np.intp)]
    return colors


def _of_bytes(array: Array) -> Array:
    linear: npt.NDArray[np.float32] = _srgb_to_linear(np.arange(256) / 255).astype(np.float32)
    return np.take(linear, array, axis=0)


def _expect_shares(array: Array, count: int, what: str) -> None:
    """Refuses what is no (3,) or (count, 3), and tells what to do with it."""
    found, expected = f"{what}: found an array of shape {array.shape}, expected (3,), ({count}, 3)", f", or ({count},) for a colour map"
    if array.ndim in (1, 2) and array.shape in ((4,), (count, 4)):
        raise lib.SceneError(f"{found}{expected}; leave the alpha out, as in {what}[{':, ' if array.ndim == 2 else ''}:3]. Floats are "
                             f"linear: for sRGB ones, such as matplotlib's, give (255 * {what}).round().astype('uint8')")
    if array.shape not in ((3,), (count, 3)):
        hint = f"; transpose it, as in {what}.T" if array.shape == (3, count) else ""
        raise lib.SceneError(f"{found}{expected}{hint}")
    if array.dtype.kind in "iu" and array.dtype != np.uint8 and array.size > 0 and array.max() > 1:
        raise lib.SceneError(f"{what}: found whole numbers up to {array.max()}, expected linear shares of light from 0 to 1, or bytes "
                             f"of sRGB as an array of uint8, as in numpy.uint8({what})")


def linear_colors(color: typing.Optional[Color], count: int, kept: typing.Optional[Array], cmap: str,
                  color_range: Range, what: str = "color") -> typing.Optional[Array]:
    """Three linear shares of light, for all spheres (3,) or for each (K, 3); NaN where a colour is masked. None: no colour.

    Of `count` rows those count that `kept` marks; None: all. `what`: the argument, in messages.
    """
    mapped = bool(cmap) or color_range is not None
    array = mask = None
    if color is not None and not isinstance(color, str):
        array, mask = read(color, what, 'numbers; a text such as "#4477aa" gives all spheres one colour')
    if array is not None and array.shape == (count,) and (count != 3 or mapped):  # three numbers are a colour, unless a map is named
        values = without(array, mask)
        return map_colors(values if kept is None else values[kept], cmap or "viridis", color_range, what)
    if mapped:
        raise lib.SceneError(f"{'cmap' if cmap else 'color_range'}: found without numbers to map; give `{what}` as one number "
                             "per sphere")
    if array is None:
        return _of_text(color, what) if isinstance(color, str) else None
    _expect_shares(array, count, what)
    if kept is not None and array.ndim == 2:
        array, mask = array[kept], None if mask is None else mask[kept]
    if array.dtype == np.uint8:
        array = _of_bytes(array)
    return without(array, mask)
