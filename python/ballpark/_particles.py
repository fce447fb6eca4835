"""Spheres from the objects of other packages, which are not imported here.

In:    ASE's Atoms, MDAnalysis' AtomGroup and Universe, frames of gsd.   Out: Spheres.
Knows: where those keep positions, elements and types.   Does not know: scenes, rendering.
"""

import ctypes as c
import functools
import typing

import numpy as np
import numpy.typing as npt

from . import _library as lib
from ._arguments import floats, warn, wrong_type
from ._colors import Color
from ._scene import Document, Spheres

RADII = {"vdw": "van_der_waals", "covalent": "covalent"}


def _expect(function: str, thing: typing.Any, members: typing.Sequence[str], expected: str) -> None:
    """Refuses what lacks a member."""
    if not all(hasattr(thing, member) for member in members):
        raise wrong_type(function, thing, expected)


@functools.lru_cache(maxsize=None)
def _elements() -> typing.Tuple[npt.NDArray[np.float64], npt.NDArray[np.float64], npt.NDArray[np.float32],
                                typing.Dict[str, int]]:
    """Radii (van der Waals, covalent) and colours by atomic number, and numbers by symbol."""
    vdw: typing.List[float] = []
    covalent: typing.List[float] = []
    colors: typing.List[typing.List[float]] = []
    numbers: typing.Dict[str, int] = {}
    info = lib.BpElementInfo()
    while lib.library().bp_element_info(len(vdw), c.byref(info)):
        numbers[info.symbol.decode().upper()] = len(vdw)
        vdw.append(info.van_der_waals)
        covalent.append(info.covalent)
        colors.append(info.color[:])
    return np.array(vdw), np.array(covalent), np.array(colors, np.float32), numbers


def _of_elements(function: str, numbers: npt.NDArray[typing.Any], radius: typing.Union[str, npt.ArrayLike], scale: float,
                 color: typing.Optional[Color]) -> typing.Tuple[npt.ArrayLike, typing.Optional[Color]]:
    vdw, covalent, colors, _ = _elements()
    known = np.where((numbers >= 0) & (numbers < len(vdw)), numbers, 0).astype(np.intp)
    unknown = int(np.count_nonzero(known == 0))
    if unknown > 0 and (isinstance(radius, str) or color is None):
        warn(f"ballpark: {function}: no element is known of {unknown:,} of {len(known):,} atoms")
    if isinstance(radius, str):
        if radius not in RADII:
            raise lib.SceneError(f'radius: found "{radius}", expected "vdw", "covalent", a number or an array')
        radii = (vdw if radius == "vdw" else covalent)[known]
    else:
        radii = floats(radius, "radius")
    return floats(scale, "scale") * radii, colors[known] if color is None else color


def from_ase(atoms: typing.Any, *, radius: typing.Union[str, npt.ArrayLike] = "vdw", scale: float = 1.0,
             color: typing.Optional[Color] = None,
             material: typing.Union[None, str, Document] = None) -> Spheres:
    """The atoms of an ase.Atoms, by default with radii of van der Waals and colours by element.

    radius: "vdw", "covalent", or in angstrom; scale multiplies it. color: as in Spheres. A warning counts atoms of unknown
    elements, which look alike.
    """
    _expect("from_ase", atoms, ("get_atomic_numbers", "get_positions"), "an ase.Atoms")
    numbers = np.asarray(atoms.get_atomic_numbers())
    radii, colors = _of_elements("from_ase", numbers, radius, scale, color)
    return Spheres(np.asarray(atoms.get_positions()), radii, colors, material, name="atoms")


def _numbers_of(symbols: npt.NDArray[typing.Any]) -> npt.NDArray[np.int64]:
    """Atomic numbers of symbols in any case; 0 where there is none."""
    table = _elements()[3]
    distinct, places = np.unique(symbols.astype(str), return_inverse=True)
    numbers = np.array([table.get(symbol.strip().upper(), 0) for symbol in distinct], np.int64)
    taken: npt.NDArray[np.int64] = np.take(numbers, places.reshape(-1))
    return taken


def _guess(names: npt.NDArray[typing.Any], residues: npt.NDArray[typing.Any]) -> npt.NDArray[np.int64]:
    """Atomic numbers by the names of atoms and residues, as the readers of PDB and GRO files guess them."""
    pairs = np.char.add(np.char.add(names.astype(str), "\n"), residues.astype(str))
    distinct, places = np.unique(pairs, return_inverse=True)
    guessed = [lib.library().bp_element_of_atom(*(part.encode() for part in pair.split("\n"))) for pair in distinct]
    taken: npt.NDArray[np.int64] = np.take(np.array(guessed, np.int64), places.reshape(-1))
    return taken


def from_mdanalysis(atoms: typing.Any, *, radius: typing.Union[str, npt.ArrayLike] = "vdw", scale: float = 1.0,
                    color: typing.Optional[Color] = None,
                    material: typing.Union[None, str, Document] = None) -> Spheres:
    """The atoms of an MDAnalysis AtomGroup or Universe in its current frame, water included.

    Elements are the topology's; where it has none, they follow from the names of atoms and residues, and where it has
    no names, atoms look alike, with a warning. Arguments: see from_ase().
    """
    given, atoms = atoms, getattr(atoms, "atoms", atoms)
    if not hasattr(atoms, "positions") and not hasattr(atoms, "n_atoms") or hasattr(atoms, "get_atomic_numbers"):
        raise wrong_type("from_mdanalysis", given, "an AtomGroup or a Universe of MDAnalysis")
    positions = np.asarray(atoms.positions)  # MDAnalysis says it where there are none
    numbers = np.zeros(len(positions), np.int64)
    if hasattr(atoms, "elements"):
        numbers = _numbers_of(np.asarray(atoms.elements))
    unknown = numbers == 0
    if unknown.any() and hasattr(atoms, "names"):
        names = np.asarray(atoms.names)
        residues = np.asarray(atoms.resnames) if hasattr(atoms, "resnames") else np.full(len(names), "")
        numbers[unknown] = _guess(names[unknown], residues[unknown])
    radii, colors = _of_elements("from_mdanalysis", numbers, radius, scale, color)
    return Spheres(positions, radii, colors, material, name="atoms")


def _shape_diameter(shape: typing.Mapping[str, typing.Any]) -> float:
    """Of the sphere that stands for a shape of HOOMD-blue: an ellipsoid's has the same volume, that of corners or of a union of
    spheres reaches the farthest point. NaN: no size is known."""
    if "diameter" in shape:
        return float(shape["diameter"])
    if {"a", "b", "c"} <= set(shape):
        return float(2 * np.cbrt(shape["a"] * shape["b"] * shape["c"]))
    if "vertices" in shape:
        return float(2 * (np.linalg.norm(shape["vertices"], axis=1).max() + shape.get("rounding_radius", 0)))
    if "centers" in shape:
        return float((2 * np.linalg.norm(shape["centers"], axis=1) + np.asarray(shape["diameters"])).max())
    return float("nan")


def _gsd_diameters(particles: typing.Any) -> npt.NDArray[typing.Any]:
    """The diameters of the frame, or where it has none (gsd then says 1), those of the types' shapes."""
    diameters = np.ones(len(particles.position)) if particles.diameter is None else floats(particles.diameter, "diameter")
    shapes, types = getattr(particles, "type_shapes", None), particles.typeid
    if not shapes or types is None or not (diameters == 1).all():
        return diameters
    types = np.asarray(types)
    known = types < len(shapes)
    of_types = np.array([_shape_diameter(shape) for shape in shapes])
    is_other = np.array([bool(shape) and shape.get("type") != "Sphere" for shape in shapes])
    others = int(np.count_nonzero(is_other[types[known]]))
    if others > 0:
        warn(f"ballpark: from_gsd: particles of other shapes drawn as spheres: {others:,} of {len(types):,}; "
             "render the file by its name to see the shapes")
    own = np.full(len(types), np.nan)
    own[known] = of_types[types[known]]
    return np.where(np.isnan(own), diameters, own)


def from_gsd(frame: typing.Any, *, radius: typing.Optional[npt.ArrayLike] = None, scale: float = 1.0,
             color: typing.Optional[Color] = None,
             material: typing.Union[None, str, Document] = None) -> Spheres:
    """The particles of a frame of gsd.hoomd: radii are half the diameters, colours go by type, z is up.

    Where the frame has no diameters, those of the types' shapes count; what is no sphere becomes one, with a warning.
    radius: instead of the diameters; scale multiplies it. color: as in Spheres. Two dimensions are seen from the front.
    """
    _expect("from_gsd", frame, ("particles", "configuration"), "a frame of gsd.hoomd, such as trajectory[0]")
    particles = frame.particles
    positions = floats(particles.position, "positions")
    if radius is None:
        radius = _gsd_diameters(particles) / 2
    if color is None:
        types = particles.typeid
        count = 1 if types is None or len(types) == 0 else int(np.max(types)) + 1
        table, rgb = np.empty((count, 3), np.float32), (c.c_double * 3)()
        for number in range(count):
            lib.library().bp_type_color(number, rgb)
            table[number] = rgb[:]
        color = table[0] if types is None else table[np.asarray(types)]
    flat = getattr(frame.configuration, "dimensions", 3) == 2
    return Spheres(positions, floats(scale, "scale") * floats(radius, "radius"), color, material, up="y" if flat else "z",
                   view="front" if flat else "three-quarter", name="particles")
