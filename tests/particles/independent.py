"""What an independent reader finds in a file: one line of JSON. Run by test_particle_files.py, in a Python that has it.

python3 independent.py ase|mdanalysis|gsd FILE FORMAT FRAME
python3 independent.py write FOLDER         writes files by ASE and gsd, and says what they hold
python3 independent.py write-gsd FOLDER     writes random.gsd, and says for each frame what gsd finds in it, value by value
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


def change_frame(random, frame, what, count):
    """Gives a frame what is to be tried; everything else is left out, so that it is that of the first frame, or the default."""
    import numpy
    frame.particles.N = count
    frame.particles.position = random.uniform(-5, 5, (count, 3))
    if what in ("all", "types"):
        frame.particles.types = ["A", "Bee", "a type of forty letters, to the letter x"][:3 if what == "all" else 2]
        frame.particles.typeid = random.integers(0, len(frame.particles.types), count)
    if what in ("all", "sizes"):
        frame.particles.diameter = random.uniform(0.5, 2, count)
        frame.particles.mass = random.uniform(1, 9, count)
    if what in ("all", "motion"):
        frame.particles.charge = random.uniform(-2, 2, count)
        frame.particles.velocity = random.uniform(-9, 9, (count, 3))
        frame.particles.image = random.integers(-3, 3, (count, 3))
        frame.particles.orientation = random.uniform(-1, 1, (count, 4))
    if what in ("all", "box"):
        frame.configuration.box = numpy.concatenate([random.uniform(5, 20, 3), random.uniform(-1.4, 1.4, 3)])
    if what == "flat":
        frame.configuration.box = [7, 8, 0, 0.3, 0, 0]
        frame.configuration.dimensions = 2
        frame.particles.position[:, 2] = 0
    if what in ("all", "bonds"):
        frame.bonds.N = count // 2
        frame.bonds.types = ["b", "c"]
        frame.bonds.typeid = random.integers(0, 2, count // 2)
        frame.bonds.group = [random.choice(count, 2, replace=False) for _ in range(count // 2)]
    if what == "no bonds":
        frame.bonds.N = 0


def found_in(frame, what):
    """One frame as gsd reads it."""
    p, box = frame.particles, [float(x) for x in frame.configuration.box]
    flat = int(frame.configuration.dimensions) == 2
    lz = 1.0 if flat and box[2] == 0 else box[2]
    cell = [[box[0], 0, 0], [box[3] * box[1], box[1], 0], [box[4] * lz, box[5] * lz, lz]]
    columns = {"diameter": p.diameter, "mass": p.mass, "charge": p.charge,
               **{name: p.velocity[:, i] for i, name in enumerate(("vx", "vy", "vz"))}, "y": p.position[:, 1]}
    return {"what": what, "positions": p.position.astype(float).tolist(), "types": [p.types[i] for i in p.typeid],
            "radii": (p.diameter.astype(float) / 2).tolist(), "cell": cell, "flat": flat,
            "origin": [-(cell[0][i] + cell[1][i] + cell[2][i]) / 2 for i in range(3)],
            "pairs": [list(map(int, pair)) for pair in frame.bonds.group] if frame.bonds.N else [],
            "columns": {name: values.astype(float).tolist() for name, values in columns.items()}}


def write_random_gsd(folder):
    import gsd.hoomd
    import numpy
    random = numpy.random.default_rng(3)
    frames = [("all", 30), ("positions", 30), ("types", 30), ("sizes", 30), ("motion", 30), ("box", 30), ("bonds", 30),
              ("no bonds", 30), ("positions", 12), ("all", 12), ("bonds", 50), ("types", 50), ("flat", 30), ("positions", 40)]
    path = os.path.join(folder, "random.gsd")
    new = hasattr(gsd.hoomd, "Frame")
    with gsd.hoomd.open(path, "w" if new else "wb") as file:
        for step, (what, count) in enumerate(frames):
            frame = gsd.hoomd.Frame() if new else gsd.hoomd.Snapshot()
            frame.configuration.step = step
            change_frame(random, frame, what, count)
            file.append(frame)
    with gsd.hoomd.open(path, "r" if new else "rb") as file:
        print(json.dumps([found_in(frame, what) for frame, (what, _) in zip(file, frames)]))


def main():
    if sys.argv[1] == "write-gsd":
        try:
            write_random_gsd(sys.argv[2])
        except ImportError:
            return 77
        return 0
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
