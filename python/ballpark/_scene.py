"""Scenes: documents of the JSON grammar as dicts or files, and spheres as arrays.

In:    dicts, paths, numpy arrays.   Out: a scene of the library.
Knows: how arrays lie in memory, which of their rows count.   Does not know: rendering, other packages' objects.
"""

import ctypes as c
import dataclasses
import json
import math
import os
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib
from ._arguments import Array, c_name, c_text, floats, warn, whole_number, wrong_type
from ._colors import Color, linear_colors
from ._interrupt import interruptible
from ._lines import Lines
from ._mesh import CLAY, Mesh, rows

Document = typing.Mapping[str, typing.Any]

# What a render of bare positions looks like: as files of particles do.
PARTICLE_CAMERA: typing.Dict[str, typing.Any] = {
    "image_width": 800, "aspect_ratio": [4, 3], "samples_per_pixel": 32, "max_depth": 20, "vfov": 30}
PARTICLE_SCENE: typing.Dict[str, typing.Any] = {"lighting": "soft", "transfer": "srgb"}
MESH_SCENE: typing.Dict[str, typing.Any] = {"lighting": "studio", "transfer": "srgb"}


@dataclasses.dataclass
class Spheres:
    """Many spheres of one material, as arrays.

    positions: (N, 3), in any unit of length. Arrays of float32 and float64 are read where they lie, with any strides.
        Those that are masked, None, NA or NaN in a coordinate are left out, with their radius and colour, and a warning.
    radius: a number, or (N,).
    color: linear shares of light (r, g, b) or (N, 3); uint8 arrays and "#rrggbb" are sRGB; numbers (N,) go through the
        colour map `cmap` ("viridis", "plasma", "cividis", "coolwarm"), from the least to the greatest or over
        `color_range`. None: the material's own colour.
    material: a name from the scene's "materials", or a material itself, such as {"type": "metal", "albedo": [.9, .8,
        .5], "fuzz": 0.1}. None: matte.
    interior: what fills each, a name from the scene's "media", or a medium itself, such as {"scattering": 0.1}: its material lets light in.
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
    interior: typing.Union[None, str, Document] = None

    def _places(self) -> Array:
        places = floats(self.positions, "positions")
        if places.ndim != 2 or places.shape[1] != 3:
            hint = ("; transpose it, as in positions.T" if places.ndim == 2 and places.shape[0] == 3 else
                    "; points in a plane need a third column, of zeros" if places.ndim == 2 and places.shape[1] == 2 else
                    "; one point is [[x, y, z]]" if places.shape == (3,) else "")
            raise lib.SceneError(f"positions: found an array of shape {places.shape}, expected (N, 3){hint}")
        return places

    def _kept(self, places: Array) -> typing.Optional[Array]:
        """Which points have a place; None: all."""
        kept: Array = np.asarray(~np.isnan(places).any(axis=1))
        left_out = len(kept) - int(np.count_nonzero(kept))
        if left_out == 0:
            return None
        if left_out == len(kept):
            raise lib.SceneError(f"{self.name}: found no place (masked, missing or NaN) for any of {left_out:,}, expected some")
        warn(f"ballpark: {self.name}: left out for lack of a place (masked, missing or NaN): {left_out:,} of {len(kept):,}")
        return kept

    def _radii(self, count: int, kept: typing.Optional[Array]) -> Array:
        radii = floats(self.radius, "radius")
        if radii.shape not in ((), (count,)):
            raise lib.SceneError(f"radius: found an array of shape {radii.shape}, expected a number or ({count},)")
        radii = radii[kept] if kept is not None and radii.ndim == 1 else radii
        self._expect_all("radius", np.isnan(radii), kept)
        return radii

    def _expect_all(self, what: str, missing: Array, kept: typing.Optional[Array]) -> None:
        """Refuses spheres with a place that lack something else."""
        lacking = np.flatnonzero(missing)
        if len(lacking) > 0:
            first = lacking[0] if kept is None else np.flatnonzero(kept)[lacking[0]]
            more = f", nor for {len(lacking) - 1:,} more" if len(lacking) > 1 else ""
            raise lib.SceneError(f"{what}: found no number (masked, missing or NaN) for sphere {first} (from 0) of "
                                 f"{self.name}{more}, expected one")

    def _set(self, material: typing.Optional[str], interior: typing.Optional[str], keep: typing.List[typing.Any]) -> lib.BpSphereSet:
        """For the library; `keep` gets what must live until it has read the arrays."""
        places = self._places()
        count, kept = len(places), self._kept(places)
        radii = self._radii(count, kept)
        colors = linear_colors(self.color, count, kept, self.cmap, self.color_range)
        if colors is not None:
            self._expect_all("color", np.asarray(np.isnan(colors).any(axis=-1)), kept if colors.ndim == 2 else None)
        if kept is not None:
            places = places[kept]
        name = self.name if kept is None else f"those {self.name} that have a place"
        keep += [places, radii, colors]
        return lib.BpSphereSet(len(places), rows(places, True), rows(radii, radii.ndim == 1),
                               rows(colors, colors is not None and colors.ndim == 2),
                               c_name("material", material), c_text("name", name), c_name("interior", interior))


def _member(place: str, name: typing.Union[str, int]) -> str:
    return f"{place}[{name}]" if isinstance(name, int) else f"{place}.{name}" if place else name


def _plain(value: typing.Any, place: str) -> typing.Any:
    """What json can write, with lists in place of arrays. `place` names the member in messages."""
    if isinstance(value, typing.Mapping):
        for name in value:
            if not isinstance(name, str):
                raise lib.SceneError(f"{place + ': ' if place else ''}found the name {name!r}, expected a text")
        return {name: _plain(part, _member(place, name)) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part, _member(place, number)) for number, part in enumerate(value)]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, np.generic):
        value = float(value) if isinstance(value, np.floating) else value.item()
    elif hasattr(value, "__array__"):
        masked: typing.Any = np.ma  # which not all versions of numpy have types for
        array = masked.asarray(value)
        if array.dtype.kind in "biuf" and array.dtype.itemsize <= 8 and np.isfinite(array).all():
            return array.tolist()
        return _plain(array.tolist(), place)
    if isinstance(value, float) and not math.isfinite(value):
        raise lib.SceneError(f"{place}: found {value}, expected a finite number")
    if value is not None and not isinstance(value, (str, int, float)):
        raise lib.SceneError(f"{place}: found {type(value).__name__}, expected what JSON can hold, or an array")
    return value


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


Shape = typing.Union[Spheres, Mesh, Lines]
SHAPES = (Spheres, Mesh, Lines)


def list_of_shapes(shapes: typing.Any) -> typing.List[Shape]:
    """One Spheres, Mesh or Lines, or several."""
    if isinstance(shapes, SHAPES):
        return [shapes]
    if not isinstance(shapes, (list, tuple)):
        raise wrong_type("spheres", shapes, "Spheres, a Mesh, Lines or a list of them")
    for number, one in enumerate(shapes):
        if not isinstance(one, SHAPES):
            raise wrong_type(f"spheres[{number}]", one, "Spheres, a Mesh or Lines")
    return list(shapes)


class Scene:
    """A scene: a document of the JSON grammar (scenes/README.md) as a dict, and more spheres, meshes and lines as arrays.

    Relative files that the document names are looked up in the current folder. Raises SceneError, which names the
    member at fault.
    """

    def __init__(self, document: Document, spheres: typing.Union[Shape, typing.Sequence[Shape]] = ()):
        shapes = list_of_shapes(spheres)
        text, names = self._text(document, shapes)
        keep: typing.List[typing.Any] = []
        sets = [one._set(*name, keep) for one, name in zip(shapes, names) if isinstance(one, Spheres)]
        meshes = [one._set(*name, keep) for one, name in zip(shapes, names) if isinstance(one, Mesh)]
        lines = [one._set(*name, keep) for one, name in zip(shapes, names) if isinstance(one, Lines)]
        every = lib.BpShapeSets((lib.BpSphereSet * len(sets))(*sets), len(sets), (lib.BpMeshSet * len(meshes))(*meshes), len(meshes),
                                (lib.BpLineSet * len(lines))(*lines), len(lines))
        self._handle = lib.Handle("scene")

        def parse() -> None:
            lib.call("bp_scene_parse_with_shapes", text, len(text), b"scene", c.byref(every), self._handle.address, hide_place=True)
            keep.clear()

        interruptible(parse)
        self._read()

    @staticmethod
    def _text(document: Document, sets: typing.Sequence[Shape]) -> typing.Tuple[bytes, typing.List[typing.Tuple[typing.Optional[str], typing.Optional[str]]]]:
        """The document with the sets' own materials and media, and the names of each set's material and of what fills it."""
        if not isinstance(document, typing.Mapping):
            raise lib.SceneError(f"found {type(document).__name__}, expected a dict such as {{\"camera\": {{}}}}")
        wanted = dict(document)
        names: typing.List[typing.Tuple[typing.Optional[str], typing.Optional[str]]] = []

        def name_of(number: int, member: str, members: str, thing: typing.Any) -> typing.Optional[str]:
            if isinstance(thing, typing.Mapping):
                name = f"{sets[number].name} {number}"
                wanted[members] = {**wanted.get(members, {}), name: thing}
                return name
            if thing is None or isinstance(thing, str):
                return thing
            raise wrong_type(member, thing, "a name or a dict")

        for number, one in enumerate(sets):
            material = CLAY if isinstance(one, Mesh) and one.material is None else one.material
            names.append((name_of(number, "material", "materials", material), name_of(number, "interior", "media", one.interior)))
        return json.dumps(_plain(wanted, "")).encode(), names

    @classmethod
    def load(cls, path: typing.Union[str, "os.PathLike[str]"], select: typing.Optional[str] = None) -> "Scene":
        """Reads a scene document, a file of particles (docs/PARTICLES.md) or one of a mesh; of particles, where `select` is given,
        those for which this expression holds, such as 'chain == "A" and not hydrogen'."""
        scene = cls.__new__(cls)
        scene._handle = lib.Handle("scene")
        encoded = c_text("path", path)
        if select is None:
            interruptible(lambda: lib.call("bp_scene_load", encoded, scene._handle.address))
        else:
            if not isinstance(select, str):
                raise wrong_type("select", select, "an expression such as 'type == 2'")
            expression = c_text("select", select)
            interruptible(lambda: lib.call("bp_scene_load_selected", encoded, expression, scene._handle.address))
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
        self.triangles: int = info.triangles
        self.capsules: int = info.capsules
        self.transfer: str = lib.TRANSFERS[info.transfer]
        self.camera = Camera(_triple(camera.lookfrom), _triple(camera.lookat), _triple(camera.vup), camera.vfov,
                             camera.focus_dist, camera.aperture)

    def set_width(self, width: int) -> None:
        """Changes the picture's width; the aspect ratio stays. Not while a Render of the scene is under way."""
        lib.call("bp_scene_set_width", self._handle.pointer, whole_number("width", width, 1, 65535))
        self._read()

    def __repr__(self) -> str:
        title = f" {self.title!r}" if self.title else ""
        return f"<ballpark.Scene{title}: {self.spheres:,} spheres, {self.triangles:,} triangles, {self.capsules:,} capsules, {self.width} x {self.height} pixels>"


def _triple(vector: typing.Any) -> typing.Tuple[float, float, float]:
    return vector[0], vector[1], vector[2]


def shape_document(shapes: typing.Sequence[Shape], camera: typing.Optional[Document], width: typing.Optional[int],
                      height: typing.Optional[int], members: Document) -> typing.Dict[str, typing.Any]:
    """The document for bare shapes: a fitted camera, unless `camera` says where it stands, and light, unless `members` has a
    background: soft for spheres and lines; where there is a mesh, that of a studio, with a shadow on the ground."""
    if camera is not None and not isinstance(camera, typing.Mapping):
        raise wrong_type("camera", camera, 'a dict such as {"vfov": 30}')
    own = dict(camera or {})
    first, has_mesh = shapes[0], any(isinstance(one, Mesh) for one in shapes)
    placed = {"lookfrom", "lookat", "focus_dist", "defocus_angle"} & set(own)
    whole = dict(PARTICLE_CAMERA)
    if not placed:
        whole["fit"] = "scene" if has_mesh else "particles"
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
    scene = {**(MESH_SCENE if has_mesh else PARTICLE_SCENE), **members, "camera": whole}
    if "background" in members and "lighting" not in members:
        del scene["lighting"]
    elif has_mesh:
        scene["shadow_catcher"] = {"up": [float(axis == first.up) for axis in "xyz"]}
    return scene
