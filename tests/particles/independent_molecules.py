"""Every atom that an independent reader finds in a file of molecules: JSON on standard output.

python3 independent_molecules.py gemmi FILE [FRAME]        PDB and mmCIF
python3 independent_molecules.py mdanalysis FILE [FRAME]   GRO and PQR
python3 independent_molecules.py gemmi-crystal|ase-crystal FILE   CIF of crystals: [share, share, share, element] of each atom
python3 independent_molecules.py gemmi-settings ""         every setting of a space group: its name, its operations
python3 independent_molecules.py ase-poscar FOLDER         writes POSCAR files by ASE, and says what it reads in them
python3 independent_molecules.py ase-folder ""             where ASE's own files of minerals are
Exit code 77: the reader is not installed.
"""
import json
import sys
import warnings

warnings.filterwarnings("ignore")


def by_gemmi(path, frame):
    """Atoms as [x, y, z, element, name, residue, occupancy, number, shown]; the cell as its edges and its origin."""
    import gemmi
    structure = gemmi.read_structure(path)
    model, number = structure[frame], 0
    for chain in model:
        for residue in chain:
            for atom in residue:
                atom.serial = number
                number += 1
    single = structure.clone()
    single.remove_alternative_conformations()
    shown = {atom.serial for chain in single[frame] for residue in chain for atom in residue}
    atoms = [[*atom.pos.tolist(), {"X": "", "D": "H"}.get(atom.element.name, atom.element.name), atom.name, residue.name, atom.occ,
              residue.seqid.num, atom.serial in shown] for chain in model for residue in chain for atom in residue]
    edges = structure.cell.orth.mat.tolist()
    return {"frames": len(structure), "atoms": atoms,
            "cell": [[edges[k][i] for k in range(3)] for i in range(3)] + [structure.cell.orth.vec.tolist()]}


def by_mdanalysis(path, frame):
    """Positions and velocities in angstrom; charges and radii, or null."""
    import MDAnalysis
    universe = MDAnalysis.Universe(path)
    universe.trajectory[frame]
    atoms, step = universe.atoms, universe.trajectory.ts
    def values(name):
        return [float(x) for x in getattr(atoms, name)] if hasattr(atoms, name) else None
    cell = step.triclinic_dimensions
    return {"frames": len(universe.trajectory), "positions": atoms.positions.astype(float).tolist(),
            "velocities": atoms.velocities.astype(float).tolist() if step.has_velocities else None,
            "names": list(map(str, atoms.names)), "residues": list(map(str, atoms.resnames)), "numbers": values("resids"),
            "charges": values("charges"), "radii": values("radii"), "cell": None if cell is None else cell.astype(float).tolist()}


def crystal_by_gemmi(path, _):
    import gemmi
    for block in gemmi.cif.read(path):
        crystal = gemmi.make_small_structure_from_block(block)
        if crystal.sites:
            break
    return {"atoms": [[*site.fract.tolist(), {"X": "", "D": "H"}.get(site.element.name, site.element.name)]
                      for site in crystal.get_all_unit_cell_sites()]}


def crystal_by_ase(path, _):
    import ase.io
    atoms = ase.io.read(path, index=0)
    return {"atoms": [[*share, symbol] for share, symbol in zip(atoms.get_scaled_positions().tolist(), atoms.get_chemical_symbols())]}


def settings_of_gemmi(_, __):
    import gemmi
    return [[group.xhm(), [operation.triplet() for operation in group.operations()]] for group in gemmi.spacegroup_table()]


def folder_of_ase(_, __):
    import os
    import ase.test
    return os.path.join(os.path.dirname(ase.test.__file__), "testdata", "minerals")


def poscars_of_ase(folder, _):
    import os
    import ase
    import ase.io
    import numpy
    random, found = numpy.random.default_rng(4), []
    for number in range(12):
        atoms = ase.Atoms(numbers=random.choice([1, 8, 26, 79], 20), pbc=True, scaled_positions=random.uniform(-1, 2, (20, 3)),
                          cell=random.uniform(-2, 2, (3, 3)) + 9 * numpy.eye(3))
        path = os.path.join(folder, f"POSCAR{number}")
        ase.io.write(path, atoms, format="vasp", direct=number % 2 == 0, sort=number % 3 == 0, vasp5=True)
        # Version 3.22, for one, takes a negative scale for a factor, and of three the first.
        new = [int(x) for x in ase.__version__.split(".")[:2]] >= [3, 29]
        scale = ["1.0", "1.3", "-700" if new else "0.7", "1.1 0.9 1.2" if new else "2.5"][number % 4]
        with open(path, encoding="utf-8") as file:
            lines = file.read().splitlines()
        lines[1] = scale
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        read = ase.io.read(path, format="vasp")
        found.append([path, {"cell": read.cell.tolist(), "places": read.get_positions().tolist(), "elements": read.get_chemical_symbols()}])
    return found


def main():
    read = {"gemmi": by_gemmi, "mdanalysis": by_mdanalysis, "gemmi-crystal": crystal_by_gemmi, "ase-crystal": crystal_by_ase,
            "gemmi-settings": settings_of_gemmi, "ase-poscar": poscars_of_ase, "ase-folder": folder_of_ase}[sys.argv[1]]
    try:
        print(json.dumps(read(sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 0)))
    except ImportError:
        return 77
    return 0


sys.exit(main())
