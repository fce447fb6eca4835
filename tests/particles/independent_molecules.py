"""Every atom that an independent reader finds in a file of molecules: JSON on standard output.

python3 independent_molecules.py gemmi FILE [FRAME]        PDB and mmCIF
python3 independent_molecules.py mdanalysis FILE [FRAME]   GRO and PQR
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


def main():
    read = {"gemmi": by_gemmi, "mdanalysis": by_mdanalysis}[sys.argv[1]]
    try:
        print(json.dumps(read(sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 0)))
    except ImportError:
        return 77
    return 0


sys.exit(main())
