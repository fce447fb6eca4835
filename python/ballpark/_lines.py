"""Lines as arrays.

In:    pairs of points, or points and pairs of their numbers.   Out: lines as the library reads them.
Knows: colours of lines, of their ends and of points.   Does not know: scenes, rendering.
"""

import dataclasses
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib
from ._arguments import Array, c_name, c_text, floats, read
from ._colors import Color, linear_colors
from ._mesh import expect_vertices, rows, vertex_places


@dataclasses.dataclass
class Lines:
    """Lines of one material, as arrays: capsules, with a radius and round ends. Both ends in one place make a sphere.

    lines: (N, 2, 3), the two ends of each, in any unit of length; or (N, 2), whole numbers of any type: its ends among `vertices`, counted
        from 0.
    vertices: (V, 3), the points that the numbers mean. None: `lines` has the ends themselves.
    radius: a number, or (N,).
    colors: linear shares of light (r, g, b), (N, 3) of lines, (N, 2, 3) of their ends, or (V, 3) of vertices; a line with two colours has
        each up to its middle. uint8 arrays and "#rrggbb" are sRGB; numbers (N,), (N, 2) or (V,) go through the colour map `cmap`, as in
        Spheres. As many of vertices as of lines: they are those of lines. None: the material's own.
    material: a name from the scene's "materials", or a material itself, which does not emit. None: matte.
    interior: what fills each, a name from the scene's "media", or a medium itself, such as {"scattering": 0.1}: its material lets light in.
    up, view, name: as in Spheres.
    """

    lines: npt.ArrayLike
    vertices: typing.Optional[npt.ArrayLike] = None
    radius: npt.ArrayLike = 0.1
    colors: typing.Optional[Color] = None
    material: typing.Union[None, str, typing.Mapping[str, typing.Any]] = None
    cmap: str = ""
    color_range: typing.Optional[typing.Tuple[float, float]] = None
    up: str = "y"
    view: typing.Union[str, typing.Sequence[float]] = "three-quarter"
    name: str = "lines"
    interior: typing.Union[None, str, typing.Mapping[str, typing.Any]] = None

    def _pairs(self) -> typing.Optional[Array]:
        """(N, 2), the numbers of points; None: `lines` are points."""
        if self.vertices is None:
            return None
        pairs, mask = read(self.lines, "lines", "numbers of vertices")
        if pairs.shape == (0,):  # an empty list
            return np.empty((0, 2), np.intp)
        if pairs.ndim != 2 or pairs.shape[1] != 2:
            hint = "; transpose it, as in lines.T" if pairs.ndim == 2 and pairs.shape[0] == 2 else ""
            raise lib.SceneError(f"lines: found an array of shape {pairs.shape}, expected (N, 2) beside vertices{hint}")
        if pairs.dtype.kind not in "iu" or mask is not None:
            raise lib.SceneError(f"lines: found {'masked numbers' if mask is not None else pairs.dtype}, expected whole numbers, which count "
                                 "vertices, as in lines.astype(int)")
        return pairs

    def _ends(self, pairs: typing.Optional[Array], places: typing.Optional[Array]) -> Array:
        """(N, 2, 3), all of them finite. `places`: the vertices that the pairs count."""
        if pairs is None or places is None:
            ends = floats(self.lines, "lines")
            if ends.shape == (0,):
                return np.empty((0, 2, 3))
            if ends.ndim != 3 or ends.shape[1:] != (2, 3):
                hint = ("; one line is [[[x, y, z], [x, y, z]]]" if ends.shape == (2, 3) else
                        "; for a line through all points, numpy.stack([points[:-1], points[1:]], axis=1)" if ends.ndim == 2 and
                        ends.shape[1] == 3 else "; whole numbers need the vertices that they count" if ends.ndim == 2 and
                        ends.shape[1] == 2 else "")
                raise lib.SceneError(f"lines: found an array of shape {ends.shape}, expected (N, 2, 3){hint}")
        else:
            expect_vertices(pairs, len(places), "line")
            ends = places[pairs.astype(np.intp)]
        self._expect_all("lines" if pairs is None else "vertices", ~np.isfinite(ends).all(axis=(1, 2)), "finite number in an end of")
        return ends

    def _expect_all(self, what: str, missing: Array, thing: str) -> None:
        lacking = np.flatnonzero(missing)
        if len(lacking) > 0:
            more = f", nor of {len(lacking) - 1:,} more" if len(lacking) > 1 else ""
            raise lib.SceneError(f"{what}: found no {thing} line {lacking[0]} (from 0) of {self.name}{more}, expected one")

    def _radii(self, count: int) -> Array:
        radii = floats(self.radius, "radius")
        if radii.shape not in ((), (count,)):
            raise lib.SceneError(f"radius: found an array of shape {radii.shape}, expected a number or ({count},)")
        self._expect_all("radius", np.atleast_1d(np.isnan(radii)), "number for")
        return radii

    def _colors(self, count: int, pairs: typing.Optional[Array], points: int) -> typing.Optional[Array]:
        """Of `points` vertices, or of -1 without pairs: one for all (3,), of lines (N, 3) or of their ends (N, 2, 3)."""
        if self.colors is None or isinstance(self.colors, str):
            return linear_colors(self.colors, count, None, self.cmap, self.color_range, "colors")
        array, mask = read(self.colors, "colors", 'numbers; a text such as "#4477aa" gives all lines one colour')
        colors: typing.Any = array if mask is None else np.ma.array(array, mask=mask)  # type: ignore[no-untyped-call]
        one_for_all = array.shape == (3,) and not self.cmap and self.color_range is None
        of_ends = array.shape in ((count, 2), (count, 2, 3))
        of_points = array.shape in ((points,), (points, 3)) and points != count and not one_for_all
        if not (one_for_all or of_ends or of_points or array.shape in ((count,), (count, 3))):
            alpha = array.shape[-1:] == (4,) and array.ndim < 4
            raise lib.SceneError(f"colors: found an array of shape {array.shape}, expected (3,), ({count}, 3) of lines, ({count}, 2, 3) of their "
                                 f"ends{'' if pairs is None else f', ({points}, 3) of vertices'}, or as many numbers for a colour map"
                                 f"{'; leave the alpha out, as in colors[..., :3]' if alpha else ''}")
        if of_ends:
            colors = colors.reshape(2 * count, *array.shape[2:])
        linear = linear_colors(colors, 2 * count if of_ends else points if of_points else count, None, self.cmap, self.color_range, "colors")
        if linear is None or linear.ndim == 1:
            return linear
        linear = linear.reshape(count, 2, 3) if of_ends else linear[typing.cast(Array, pairs).astype(np.intp)] if of_points else linear
        self._expect_all("colors", np.isnan(linear).reshape(count, -1).any(axis=1), "colour for")
        return linear

    def _set(self, material: typing.Optional[str], interior: typing.Optional[str], keep: typing.List[typing.Any]) -> lib.BpLineSet:
        """For the library; `keep` gets what must live until it has read the arrays."""
        pairs = self._pairs()
        places = None if pairs is None else vertex_places(typing.cast(npt.ArrayLike, self.vertices), "V")
        ends = self._ends(pairs, places)
        count = len(ends)
        points, radii = ends.reshape(-1, 3), self._radii(count)
        colors = self._colors(count, pairs, -1 if places is None else len(places))
        halves = [colors, colors] if colors is None or colors.ndim < 3 else [colors[:, 0], colors[:, 1]]
        keep += [points, radii, colors]
        return lib.BpLineSet(2 * count, count, rows(points, True), None, rows(radii, radii.ndim == 1),
                             (lib.BpRows * 2)(*[rows(half, half is not None and half.ndim == 2) for half in halves]),
                             c_name("material", material), c_text("name", self.name), c_name("interior", interior))
