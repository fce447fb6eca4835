"""Scenes: documents of the JSON grammar as dicts or files, and spheres as arrays.

In:    dicts, paths, numpy arrays.   Out: a scene of the library.
Knows: how arrays lie in memory, what colours may be.   Does not know: rendering, other packages' objects.
"""

import ctypes as c
import dataclasses
import json
import os
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib

Document = typing.Mapping[str, typing.Any]
Color = typing.Union[str, npt.ArrayLike]

# What a render of bare positions looks like: as files of particles do.
PARTICLE_CAMERA: typing.Dict[str, typing.Any] = {
    "image_width": 800, "aspect_ratio": [4, 3], "samples_per_pixel": 32, "max_depth": 20, "vfov": 30}
PARTICLE_SCENE: typing.Dict[str, typing.Any] = {"light": "soft", "transfer": "srgb"}


# What takes the objects of other packages.
ADAPTERS = {"ase": "from_ase", "MDAnalysis": "from_mdanalysis", "gsd": "from_gsd"}


def wrong_type(what: str, found: object, expected: str) -> TypeError:
    """Names what was expected, and for an object of another package the function that takes it."""
    adapter = ADAPTERS.get(type(found).__module__.partition(".")[0])
    hint = f"; see ballpark.{adapter}()" if adapter and what != adapter else ""
    return TypeError(f"{what}: found {type(found).__name__}, expected {expected}{hint}")


def _srgb_to_linear(share: npt.NDArray[np.float64]) -> npt.NDArray[typing.Any]:
    """IEC 61966-2-1."""
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def _map_colors(values: npt.NDArray[typing.Any], cmap: str,
                color_range: typing.Optional[typing.Tuple[float, float]]) -> npt.NDArray[np.float32]:
    """Colours for numbers; those that are not finite become grey."""
    if not isinstance(cmap, str):
        raise wrong_type("cmap", cmap, 'a name such as "viridis"')
    table = np.empty((257, 3), np.float32)
    rgb = (c.c_double * 3)()
    for place in range(256):
        if not lib.library().bp_color_map(cmap.encode(), place / 255, rgb):
            names: typing.List[str] = []
            while lib.library().bp_color_map_name(len(names)):
                names.append(lib.library().bp_color_map_name(len(names)).decode())
            raise lib.SceneError(f'cmap: found "{cmap}", expected one of {", ".join(names)}')
        table[place] = rgb[:]
    table[256] = 0.3
    values = np.asarray(values, np.float64)
    known = np.isfinite(values)
    low, high = (float(values[known].min()), float(values[known].max())) if known.any() else (0.0, 1.0)
    if color_range is not None:
        try:
            low, high = (float(end) for end in color_range)
        except (TypeError, ValueError):
            raise lib.SceneError(f"color_range: found {color_range!r}, expected two numbers") from None
    scale = 255 / (high - low) if high > low else 0.0
    with np.errstate(invalid="ignore"):
        places = np.clip((values - low) * scale + 0.5, 0, 255) if scale else np.full(values.shape, 127.0)
    places = np.where(known, places, 256)
    colors: npt.NDArray[np.float32] = table[places.astype(np.intp)]
    return colors


def _colors(color: Color, count: int, cmap: str,
            color_range: typing.Optional[typing.Tuple[float, float]]) -> npt.NDArray[typing.Any]:
    """Three linear shares of light, for all spheres (3,) or for each (count, 3)."""
    if isinstance(color, str):
        digits = color[1:]
        if not color.startswith("#") or len(digits) not in (3, 6) or set(digits.lower()) - set("0123456789abcdef"):
            raise lib.SceneError(f'color: found "{color}", expected "#rrggbb", (r, g, b) or an array')
        if len(digits) == 3:
            digits = "".join(digit * 2 for digit in digits)
        return _srgb_to_linear(np.array([int(digits[i:i + 2], 16) for i in (0, 2, 4)]) / 255)
    array = _array(color, "color")
    if array.shape == (count,) and (count != 3 or cmap != ""):  # three numbers are a colour, unless a map is named
        return _map_colors(array, cmap or "viridis", color_range)
    if array.shape not in ((3,), (count, 3)):
        raise lib.SceneError(f"color: found an array of shape {array.shape}, expected (3,), ({count}, 3), or ({count},) "
                             "for a colour map")
    if array.dtype == np.uint8:
        linear: npt.NDArray[np.float32] = _srgb_to_linear(np.arange(256) / 255).astype(np.float32)
        return np.take(linear, array, axis=0)
    return array


def _array(values: npt.ArrayLike, what: str) -> npt.NDArray[typing.Any]:
    """An array of numbers of any type."""
    try:
        array = np.asarray(values)
    except ValueError:
        raise lib.SceneError(f"{what}: found rows of different lengths, expected numbers") from None
    if array.dtype.kind in "US":
        raise lib.SceneError(f"{what}: found text, expected numbers")
    if array.dtype.kind == "O":
        raise wrong_type(what, values, "numbers")
    if array.dtype.kind not in "fiub":
        raise lib.SceneError(f"{what}: found {array.dtype}, expected numbers")
    return array


def _numbers(values: npt.ArrayLike, what: str) -> npt.NDArray[typing.Any]:
    """The array itself where the library can read it in place, else a copy as doubles."""
    array = _array(values, what)
    return array if array.dtype in (np.dtype(np.float32), np.dtype(np.float64)) else array.astype(np.float64)


def _rows(array: typing.Optional[npt.NDArray[typing.Any]], per_sphere: bool) -> lib.BpRows:
    if array is None:
        return lib.BpRows()
    strides = array.strides
    row = strides[0] if per_sphere else 0
    column = strides[-1] if array.ndim == 2 or (array.ndim == 1 and not per_sphere) else 0
    kind = 1 if array.dtype == np.float64 else 0
    return lib.BpRows(c.c_void_p(array.ctypes.data), row, column, kind)


@dataclasses.dataclass
class Spheres:
    """Many spheres of one material, as arrays.

    positions: (N, 3), in any unit of length. Arrays of float32 and float64 are read where they lie, with any strides.
    radius: a number, or (N,).
    color: linear shares of light (r, g, b) or (N, 3); uint8 arrays and "#rrggbb" are sRGB; numbers (N,) go through the
        colour map `cmap` ("viridis", "plasma", "cividis", "coolwarm"), from the least to the greatest or over
        `color_range`. None: the material's own colour.
    material: a name from the scene's "materials", or a material itself, such as {"type": "metal", "albedo": [.9, .8,
        .5], "fuzz": 0.1}. None: matte.
    up, view: the axis that is up, and where a fitted camera stands ("three-quarter", "front", ..., or a direction).
    name: what messages call them.
    """

    positions: npt.ArrayLike
    radius: npt.ArrayLike = 0.5
    color: typing.Optional[Color] = None
    material: typing.Union[None, str, Document] = None
    cmap: str = ""
    color_range: typing.Optional[typing.Tuple[float, float]] = None
    up: str = "y"
    view: typing.Union[str, typing.Sequence[float]] = "three-quarter"
    name: str = "positions"

    def _set(self, material: typing.Optional[str], keep: typing.List[typing.Any]) -> lib.BpSphereSet:
        """For the library; `keep` gets what must live until it has read the arrays."""
        positions = _numbers(self.positions, "positions")
        if positions.ndim != 2 or positions.shape[1] != 3:
            raise lib.SceneError(f"positions: found an array of shape {positions.shape}, expected (N, 3)")
        count = positions.shape[0]
        radius = _numbers(self.radius, "radius")
        if radius.shape not in ((), (count,)):
            raise lib.SceneError(f"radius: found an array of shape {radius.shape}, expected a number or ({count},)")
        color = None
        if self.color is not None:
            color = _numbers(_colors(self.color, count, self.cmap, self.color_range), "color")
        if (self.cmap or self.color_range is not None) and (self.color is None or np.shape(self.color) != (count,)):
            raise lib.SceneError(f"{'cmap' if self.cmap else 'color_range'}: found without numbers to map; give `color` "
                                 "as one number per sphere")
        keep += [positions, radius, color]
        return lib.BpSphereSet(count, _rows(positions, True), _rows(radius, radius.ndim == 1),
                               _rows(color, color is not None and color.ndim == 2),
                               None if material is None else material.encode(), self.name.encode())


def _plain(value: typing.Any) -> typing.Any:
    """What json does not know: arrays and numbers of numpy."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise lib.SceneError(f"found {type(value).__name__}, expected what JSON can hold, or an array")


@dataclasses.dataclass(frozen=True)
class Camera:
    """Where the camera of a scene stands, after it was fitted if the scene asks for that."""

    lookfrom: typing.Tuple[float, float, float]
    lookat: typing.Tuple[float, float, float]
    vup: typing.Tuple[float, float, float]
    vfov: float
    focus_dist: float
    aperture: float

    def document(self) -> typing.Dict[str, typing.Any]:
        """As members of a scene's "camera", so that other pictures get the same view."""
        return {name: list(value) if isinstance(value, tuple) else value
                for name, value in dataclasses.asdict(self).items()}


def list_of_spheres(spheres: typing.Any) -> typing.List[Spheres]:
    """One Spheres, or several."""
    if isinstance(spheres, Spheres):
        return [spheres]
    if not isinstance(spheres, (list, tuple)):
        raise wrong_type("spheres", spheres, "Spheres or a list of them")
    for number, one in enumerate(spheres):
        if not isinstance(one, Spheres):
            raise wrong_type(f"spheres[{number}]", one, "Spheres")
    return list(spheres)


class Scene:
    """A scene: a document of the JSON grammar (scenes/README.md) as a dict, and more spheres as arrays.

    Relative files that the document names are looked up in the current folder. Raises SceneError, which names the
    member at fault.
    """

    def __init__(self, document: Document, spheres: typing.Union[Spheres, typing.Sequence[Spheres]] = ()):
        sets = list_of_spheres(spheres)
        text, names = self._text(document, sets)
        keep: typing.List[typing.Any] = []
        array = (lib.BpSphereSet * max(1, len(sets)))(*(
            one._set(name, keep) for one, name in zip(sets, names)))
        self._handle = lib.Handle("scene")
        lib.call("bp_scene_parse_with_spheres", text, len(text), b"scene", array, len(sets), self._handle.address,
                 hide_place=True)
        del keep
        self._read()

    @staticmethod
    def _text(document: Document,
              sets: typing.Sequence[Spheres]) -> typing.Tuple[bytes, typing.List[typing.Optional[str]]]:
        """The document with the sets' own materials, and the name of each set's material."""
        if not isinstance(document, typing.Mapping):
            raise lib.SceneError(f"found {type(document).__name__}, expected a dict such as {{\"camera\": {{}}}}")
        whole = dict(document)
        names: typing.List[typing.Optional[str]] = []
        for number, one in enumerate(sets):
            if isinstance(one.material, typing.Mapping):
                name = f"{one.name} {number}"
                whole["materials"] = {**whole.get("materials", {}), name: one.material}
                names.append(name)
            elif one.material is None or isinstance(one.material, str):
                names.append(one.material)
            else:
                raise wrong_type("material", one.material, "a name or a dict")
        try:
            return json.dumps(whole, default=_plain, allow_nan=False).encode(), names
        except ValueError as problem:
            if isinstance(problem, lib.SceneError):
                raise
            raise lib.SceneError(f"found a number that is not finite, expected finite ones ({problem})") from None

    @classmethod
    def load(cls, path: typing.Union[str, "os.PathLike[str]"]) -> "Scene":
        """Reads a scene document or a file of particles (docs/PARTICLES.md)."""
        scene = cls.__new__(cls)
        scene._handle = lib.Handle("scene")
        lib.call("bp_scene_load", os.fsencode(path), scene._handle.address)
        scene._read()
        return scene

    def _read(self) -> None:
        info, camera = lib.BpSceneInfo(), lib.BpCameraInfo()
        lib.library().bp_scene_info(self._handle.pointer, c.byref(info))
        lib.library().bp_scene_camera(self._handle.pointer, c.byref(camera))
        self.title: str = info.title.decode()
        self.width: int = info.width
        self.height: int = info.height
        self.samples_per_pixel: int = info.samples_per_pixel
        self.max_depth: int = info.max_depth
        self.spheres: int = info.spheres
        self.transfer: str = lib.TRANSFERS[info.transfer]
        self.camera = Camera(_triple(camera.lookfrom), _triple(camera.lookat), _triple(camera.vup), camera.vfov,
                             camera.focus_dist, camera.aperture)

    def set_width(self, width: int) -> None:
        """Changes the picture's width; the aspect ratio stays. Not while a Render of the scene is under way."""
        lib.call("bp_scene_set_width", self._handle.pointer, _whole("width", width, 1, 65535))
        self._read()

    def __repr__(self) -> str:
        title = f" {self.title!r}" if self.title else ""
        return f"<ballpark.Scene{title}: {self.spheres:,} spheres, {self.width} x {self.height} pixels>"


def _triple(vector: typing.Any) -> typing.Tuple[float, float, float]:
    return vector[0], vector[1], vector[2]


def _whole(name: str, value: typing.Any, least: int, most: int) -> int:
    try:
        number = int(value)
    except (TypeError, ValueError):
        number = least - 1
    if number != value or not least <= number <= most:
        raise lib.SceneError(f"{name}: found {value!r}, expected a whole number from {least} to {most}")
    return number


def particle_document(sets: typing.Sequence[Spheres], camera: typing.Optional[Document], width: typing.Optional[int],
                      height: typing.Optional[int], members: Document) -> typing.Dict[str, typing.Any]:
    """The document for bare spheres: a fitted camera, unless `camera` says where it stands, and soft light, unless `members`
    has a background."""
    if camera is not None and not isinstance(camera, typing.Mapping):
        raise wrong_type("camera", camera, 'a dict such as {"vfov": 30}')
    own = dict(camera or {})
    placed = {"lookfrom", "lookat", "focus_dist", "defocus_angle"} & set(own)
    whole = dict(PARTICLE_CAMERA)
    if not placed:
        first = sets[0]
        whole["fit"] = "particles"
        whole["view"] = first.view
        if first.up not in ("x", "y", "z"):
            raise lib.SceneError(f'up: found "{first.up}", expected "x", "y" or "z"')
        if first.up != "y":
            whole["vup"] = [float(axis == first.up) for axis in "xyz"]
    if "image_height" in own or height is not None:
        whole.pop("aspect_ratio")
    whole.update(own)
    if width is not None:
        whole["image_width"] = width
    if height is not None:
        whole.pop("aspect_ratio", None)
        whole["image_height"] = height
    scene = {**PARTICLE_SCENE, **members, "camera": whole}
    if "background" in members and "light" not in members:
        del scene["light"]
    return scene
