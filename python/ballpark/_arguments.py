"""What callers hand over: numbers and arrays of any kind, and how what is wrong is refused.

In:    numbers, lists, arrays of numpy and of packages whose objects become such.   Out: plain arrays, NaN where nothing is.
Knows: types of numbers, masks, None and NA.   Does not know: what the numbers mean.
"""

import os
import sys
import typing
import warnings

import numpy as np
import numpy.typing as npt

from . import _library as lib

Array = npt.NDArray[typing.Any]

# What takes the objects of other packages.
ADAPTERS = {"ase": "from_ase", "MDAnalysis": "from_mdanalysis", "gsd": "from_gsd"}


def wrong_type(what: str, found: object, expected: str) -> TypeError:
    """Names what was expected, and for an object of another package the function that takes it."""
    adapter = ADAPTERS.get(type(found).__module__.partition(".")[0])
    hint = f"; see ballpark.{adapter}()" if adapter and what != adapter else ""
    return TypeError(f"{what}: found {type(found).__name__}, expected {expected}{hint}")


def warn(message: str) -> None:
    """Warns at the line that called the package."""
    level, frame = 1, sys._getframe()
    folder = os.path.dirname(__file__)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == folder:
        level, frame = level + 1, frame.f_back
    warnings.warn(lib.shown(message), stacklevel=level)


def c_text(what: str, text: typing.Union[str, "os.PathLike[str]"]) -> bytes:
    """A name or a path for the library, whose texts end at the first zero byte."""
    if not isinstance(text, (str, bytes, os.PathLike)):
        raise wrong_type(what, text, "a text")
    encoded = os.fsencode(text)
    if b"\0" in encoded:
        raise lib.SceneError(f"{what}: found {text!r}, which has a zero byte, expected none")
    return encoded


def c_name(what: str, name: typing.Optional[str]) -> typing.Optional[bytes]:
    """A name for the library, or none."""
    return None if name is None else c_text(what, name)


def whole_number(name: str, value: typing.Any, least: int, most: int) -> int:
    """A whole number within limits."""
    try:
        number = int(value)
    except (TypeError, ValueError, OverflowError):
        number = least - 1
    if number != value or not least <= number <= most:
        raise lib.SceneError(f"{name}: found {value!r}, expected a whole number from {least} to {most}")
    return number


def _is_absent(value: object) -> bool:
    """None, or the NA of pandas."""
    return value is None or type(value).__name__ == "NAType"


def _of_objects(array: Array, what: str, expected: str) -> Array:
    """Doubles of Python's objects: their numbers, NaN where there is none."""
    numbers = np.empty(array.shape)
    for place, value in zip(np.ndindex(array.shape), array.flat):
        where = f"{what}[{', '.join(map(str, place))}]" if place else what
        if isinstance(value, (str, bytes)):
            raise lib.SceneError(f"{where}: found text, expected {expected}")
        try:
            numbers[place] = np.nan if place and _is_absent(value) else float(value)
        except (TypeError, ValueError):
            raise wrong_type(where, value, expected) from None
        except OverflowError:
            raise lib.SceneError(f"{where}: found a number beyond 1e308, expected a smaller one") from None
    return numbers


def _with_masks(values: typing.Any) -> typing.Any:
    """An array of numpy, or of its subclass that says what is masked; numpy would forget the masks of the parts of a list."""
    if isinstance(values, (list, tuple)) and any(isinstance(part, np.ma.MaskedArray) for part in values):
        masked: typing.Any = np.ma  # which not all versions of numpy have types for
        values = masked.asarray(values)
    return np.asanyarray(values)


def read(values: npt.ArrayLike, what: str, expected: str = "numbers") -> typing.Tuple[Array, typing.Optional[Array]]:
    """An array of numbers of any type, and where they are masked; None: nowhere."""
    try:
        array = _with_masks(values)
    except ValueError:
        raise lib.SceneError(f"{what}: found rows of different lengths, expected {expected}") from None
    mask, array = getattr(array, "mask", None), np.asarray(array)
    kind = array.dtype.kind
    if kind in "UST":
        raise lib.SceneError(f"{what}: found text, expected {expected}")
    if array.dtype.names:
        raise lib.SceneError(f"{what}: found a structured array with the fields {', '.join(array.dtype.names)}, expected "
                             f"{expected}; numpy.lib.recfunctions.structured_to_unstructured() makes them of fields")
    if kind == "O":
        array = _of_objects(array, what, expected)
    elif kind not in "fiub":
        raise lib.SceneError(f"{what}: found {array.dtype}, expected {'real ' if kind == 'c' else ''}{expected}")
    masked = isinstance(mask, (np.ndarray, np.bool_)) and bool(np.any(mask))
    return array, np.broadcast_to(np.asarray(mask, bool), array.shape) if masked else None


def without(array: Array, mask: typing.Optional[Array]) -> Array:
    """Floats or doubles, NaN where `mask` says so; the array itself where the library can read it in place."""
    if array.dtype not in (np.dtype(np.float32), np.dtype(np.float64)):
        array = array.astype(np.float64)
    if mask is None:
        return array
    array = np.array(array)
    array[mask] = np.nan
    return array


def floats(values: npt.ArrayLike, what: str) -> Array:
    """The array itself where the library can read it in place, else a copy; NaN is what is masked or not there."""
    return without(*read(values, what))
