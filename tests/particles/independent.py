"""What an independent reader finds in a file: one line of JSON. Run by test_particle_files.py, in a Python that has it.

python3 independent.py ase|mdanalysis|gsd FILE FORMAT FRAME
python3 independent.py write FOLDER         writes files by ASE and gsd, and says what they hold
"""
import json
import os
import sys
import warnings

warnings.filterwarnings("ignore")


def summary(points):
    low = [min(p[i] for p in points) for i in range(3)]
    high = [max(p[i] for p in points) for i in range(3)]
    return {"count": len(points), "low": low, "high": high}


def by_ase(path, kind, frame):
    import ase.io
    style = {"lammps-data": {"style": "charge"}}.get(kind, {})  # which old versions do not guess
    try:
        atoms = ase.io.read(path, index=frame, format=kind, **style)
    except TypeError:
        atoms = ase.io.read(path, index=frame, format=kind)
    return dict(summary(atoms.get_positions().tolist()), cell=atoms.get_cell().tolist())


def by_mdanalysis(path, kind, frame):
    import MDAnalysis
    universe = MDAnalysis.Universe(path, format=kind or None, topology_format=kind or None)
    universe.trajectory[frame]
    points = universe.atoms.positions.astype(float).tolist()
    return dict(summary(points), frames=len(universe.trajectory))


def by_gsd(path, _, frame):
    import gsd.hoomd
    with gsd.hoomd.open(path, "r" if hasattr(gsd.hoomd, "Frame") else "rb") as file:
        snapshot = file[frame]
        return dict(summary(snapshot.particles.position.astype(float).tolist()), frames=len(file),
                    bonds=int(snapshot.bonds.N))


def write_ase(folder):
    import ase
    import ase.io
    import numpy
    random = numpy.random.default_rng(1)
    frames = []
    for frame in range(3):
        count = 40 + 7 * frame
        frames.append(ase.Atoms(numbers=random.choice([1, 6, 7, 8, 26], count), pbc=True,
                                positions=random.uniform(-3, 30, (count, 3)),
                                cell=[[20, 0, 0], [4, 21, 0], [-3, 5, 22]]))
    for name, kind in [("a.extxyz", "extxyz"), ("a.xyz", "xyz"), ("a.pdb", "proteindatabank")]:
        ase.io.write(os.path.join(folder, name), frames, format=kind)
    ase.io.write(os.path.join(folder, "a.lmp"), frames[0], format="lammps-data", atom_style="charge")


def write_gsd(folder):
    import gsd.hoomd
    import numpy
    random = numpy.random.default_rng(2)
    make = getattr(gsd.hoomd, "Frame", None) or gsd.hoomd.Snapshot
    with gsd.hoomd.open(os.path.join(folder, "a.gsd"), "w" if hasattr(gsd.hoomd, "Frame") else "wb") as file:
        for step in range(4):
            frame = make()
            frame.configuration.step = step
            frame.configuration.box = [10, 11, 12, 0.1, 0.2, -0.3]
            frame.particles.N = 50 if step < 3 else 20
            frame.particles.position = random.uniform(-5, 5, (frame.particles.N, 3))
            if step in (0, 3):
                frame.particles.types = ["A", "Bee"]
                frame.particles.typeid = random.integers(0, 2, frame.particles.N)
                frame.particles.diameter = random.uniform(0.5, 1, frame.particles.N)
            frame.bonds.N = 2
            frame.bonds.types = ["b"]
            frame.bonds.group = [[0, 1], [1, 2]]
            file.append(frame)


def main():
    if sys.argv[1] == "write":
        written = []
        for name, write in [("ase", write_ase), ("gsd", write_gsd)]:
            try:
                write(sys.argv[2])
                written.append(name)
            except ImportError:
                pass
        print(json.dumps(written))
        return 0
    read = {"ase": by_ase, "mdanalysis": by_mdanalysis, "gsd": by_gsd}[sys.argv[1]]
    try:
        print(json.dumps(read(sys.argv[2], sys.argv[3], int(sys.argv[4]))))
    except ImportError:
        return 77
    return 0


sys.exit(main())
