"""Meshes as arrays.

In:    vertices and faces, as other packages have them.   Out: triangles as the library reads them.
Knows: quads, colours of vertices and of faces.   Does not know: scenes, rendering.
"""

import ctypes as c
import dataclasses
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib
from ._arguments import Array, c_name, c_text, floats, read
from ._colors import Color, linear_colors

# What bare meshes are made of.
CLAY: typing.Dict[str, typing.Any] = {"type": "lambertian", "albedo": [0.6, 0.58, 0.55]}


def rows(array: typing.Optional[npt.NDArray[typing.Any]], per_row: bool) -> lib.BpRows:
    """An array for the library; `per_row`: it has a row for each thing, not one for all."""
    if array is None:
        return lib.BpRows()
    strides = array.strides
    row = strides[0] if per_row else 0
    column = strides[-1] if array.ndim == 2 or (array.ndim == 1 and not per_row) else 0
    kind = 1 if array.dtype == np.float64 else 0
    return lib.BpRows(c.c_void_p(array.ctypes.data), row, column, kind)


def vertex_places(vertices: npt.ArrayLike, letter: str) -> Array:
    """Points as an array of three columns; `letter` is how messages call their number."""
    places = floats(vertices, "vertices")
    if places.ndim != 2 or places.shape[1] != 3:
        hint = "; transpose it, as in vertices.T" if places.ndim == 2 and places.shape[0] == 3 else ""
        raise lib.SceneError(f"vertices: found an array of shape {places.shape}, expected ({letter}, 3){hint}")
    return places


def expect_vertices(numbers: Array, count: int, noun: str) -> None:
    """Refuses rows, of "face" or "line", that name a vertex that is not among `count`."""
    bad = np.flatnonzero(((numbers < 0) | (numbers >= count)).any(axis=1))
    if len(bad) > 0:
        wrong = next(int(vertex) for vertex in numbers[bad[0]] if not 0 <= vertex < count)
        expected = f"numbers from 0 to {count - 1}" if count > 0 else "none, since there are no vertices"
        raise lib.SceneError(f"{noun}s: found vertex {wrong} in {noun} {bad[0]} (from 0), expected {expected}")


@dataclasses.dataclass
class Mesh:
    """Triangles or quads of one material, as arrays.

    vertices: (N, 3), in any unit of length. Arrays of float32 and float64 are read where they lie, with any strides.
    faces: (F, 3) or (F, 4), whole numbers of any type: their vertices, counted from 0, counter-clockwise seen from outside. Quads
        are cut from their first corner to their third.
    colors: linear shares of light (r, g, b), (F, 3) of faces or (N, 3) of vertices, of which each face gets the mean; uint8 arrays and
        "#rrggbb" are sRGB; numbers (F,) or (N,) go through the colour map `cmap`, as in Spheres. As many of vertices as of faces: they
        are those of faces. None: the material's own.
    normals: (N, 3), a direction for each vertex, of any length, zeros where one is missing: the mesh looks curved. smooth: it does so
        without them, too, by those of its faces.
    uvs: texture coordinates, by which images and checkers lie on the mesh: (N, 2), u and v of each vertex, or (F, 3, 2), for quads
        (F, 4, 2), of each corner of the faces, so that a vertex on a seam may have several; v grows upwards.
    material: a name from the scene's "materials", or a material itself. Those that let light in ask for faces that are closed.
        None: matte.
    interior: what fills it, a name from the scene's "media", or a medium itself, such as {"scattering": 0.1}: its material lets light in.
    up, view, name: as in Spheres.
    """

    vertices: npt.ArrayLike
    faces: npt.ArrayLike
    colors: typing.Optional[Color] = None
    material: typing.Union[None, str, typing.Mapping[str, typing.Any]] = None
    cmap: str = ""
    color_range: typing.Optional[typing.Tuple[float, float]] = None
    up: str = "y"
    view: typing.Union[str, typing.Sequence[float]] = "three-quarter"
    name: str = "mesh"
    normals: typing.Optional[npt.ArrayLike] = None
    smooth: bool = False
    uvs: typing.Optional[npt.ArrayLike] = None
    interior: typing.Union[None, str, typing.Mapping[str, typing.Any]] = None

    def _normals(self, count: int) -> typing.Optional[Array]:
        if self.normals is None:
            return None
        normals = floats(self.normals, "normals")
        if normals.shape != (count, 3):
            raise lib.SceneError(f"normals: found an array of shape {normals.shape}, expected ({count}, 3), one for each vertex")
        bad = np.flatnonzero(~np.isfinite(normals).all(axis=1))
        if len(bad) > 0:
            raise lib.SceneError(f"normals: found no finite number for vertex {bad[0]} (from 0), expected three")
        return normals

    def _uvs(self, corners: Array, count: int) -> typing.Optional[Array]:
        """(N, 2) of vertices, or (F, 3, 2) or (F, 4, 2) of corners."""
        if self.uvs is None:
            return None
        uvs = floats(self.uvs, "uvs")
        of_corners = corners.shape + (2,)
        if uvs.shape not in ((count, 2), of_corners):
            raise lib.SceneError(f"uvs: found an array of shape {uvs.shape}, expected ({count}, 2), a pair for each vertex, or {of_corners}, one for "
                                 "each corner of the faces")
        bad = np.argwhere(~np.isfinite(uvs))
        if len(bad) > 0:
            noun = "vertex" if uvs.ndim == 2 else "face"
            raise lib.SceneError(f"uvs: found no finite number for {noun} {bad[0][0]} (from 0), expected two for each {noun if uvs.ndim == 2 else 'corner'}")
        return uvs

    def _places(self) -> Array:
        places = vertex_places(self.vertices, "N")
        bad = np.flatnonzero(~np.isfinite(places).all(axis=1))
        if len(bad) > 0:
            more = f", nor in {len(bad) - 1:,} more" if len(bad) > 1 else ""
            raise lib.SceneError(f"vertices: found no finite number in vertex {bad[0]} (from 0){more}, expected three")
        return places

    def _corners(self, count: int) -> Array:
        """(F, 3) or (F, 4), of vertices that there are."""
        corners, mask = read(self.faces, "faces", "numbers of vertices")
        if corners.ndim != 2 or corners.shape[1] not in (3, 4):
            hint = "; transpose it, as in faces.T" if corners.ndim == 2 and corners.shape[0] in (3, 4) else ""
            raise lib.SceneError(f"faces: found an array of shape {corners.shape}, expected (F, 3) or (F, 4){hint}")
        if corners.dtype.kind not in "iu" or mask is not None:
            raise lib.SceneError(f"faces: found {'masked numbers' if mask is not None else corners.dtype}, expected whole numbers, as "
                                 "in faces.astype(int)")
        expect_vertices(corners, count, "face")
        return corners

    def _colors(self, corners: Array, count: int) -> typing.Optional[Array]:
        """Those of faces, or one for all."""
        shape = () if self.colors is None or isinstance(self.colors, str) else read(self.colors, "colors")[0].shape
        one_for_all = shape == (3,) and not self.cmap and self.color_range is None
        of_vertices = shape[:1] == (count,) and count != len(corners) and not one_for_all
        colors = linear_colors(self.colors, count if of_vertices else len(corners), None, self.cmap, self.color_range, "colors")
        if colors is None or colors.ndim == 1:
            return colors
        missing = np.flatnonzero(np.isnan(colors).any(axis=1))
        if len(missing) > 0:
            raise lib.SceneError(f"colors: found no number for {'vertex' if of_vertices else 'face'} {missing[0]} (from 0), expected one")
        means: Array = colors[corners].mean(axis=1) if of_vertices else colors
        return means

    def _set(self, material: typing.Optional[str], interior: typing.Optional[str], keep: typing.List[typing.Any]) -> lib.BpMeshSet:
        """For the library; `keep` gets what must live until it has read the arrays."""
        places = self._places()
        corners = self._corners(len(places))
        colors, normals = self._colors(corners, len(places)), self._normals(len(places))
        uvs = self._uvs(corners, len(places))
        if corners.shape[1] == 4:
            colors = np.repeat(colors, 2, axis=0) if colors is not None and colors.ndim == 2 else colors
            corners = corners[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
            uvs = uvs[:, [0, 1, 2, 0, 2, 3]] if uvs is not None and uvs.ndim == 3 else uvs
        triangles = np.ascontiguousarray(corners, np.uint32)
        of_corners = uvs is not None and uvs.ndim == 3
        uvs = np.ascontiguousarray(uvs).reshape(-1, 2) if of_corners else uvs
        keep += [places, triangles, colors, normals, uvs]
        return lib.BpMeshSet(len(places), len(triangles), rows(places, True), c.c_void_p(triangles.ctypes.data),
                             rows(colors, colors is not None and colors.ndim == 2),
                             c_name("material", material), c_text("name", self.name),
                             rows(normals, True), int(self.smooth), int(of_corners), rows(uvs, True), c_name("interior", interior))
