"""What LAMMPS's files hold, by LAMMPS itself or by another reader, as one line of JSON. Run by test_lammps_files.py, in a Python
that has them.

python3 lammps_beside.py lammps FOLDER      LAMMPS writes files there, and says what is in them
python3 lammps_beside.py mdanalysis         what MDAnalysis finds in the LAMMPS files of its tests
"""
import bz2
import json
import os
import sys
import tempfile
import warnings

warnings.filterwarnings("ignore")
STYLES = ["amoeba", "angle", "atomic", "body nparticle 2 6", "bond", "bpm/sphere", "charge", "dielectric", "dipole", "dpd", "edpd",
          "electron", "ellipsoid", "full", "line", "mdpd", "molecular", "peri", "rheo", "rheo/thermal", "smd", "sph", "sphere",
          "spin", "tdpd 2", "template two", "tri"]
MOLECULE = "two\n\n2 atoms\n\nCoords\n\n1 0 0 0\n2 1 0 0\n\nTypes\n\n1 1\n2 3\n"
CHARGE, MOL, RADIUS = "charges", "molecules", "radii"


def start(style, units):
    import lammps
    engine = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
    engine.command("dimension " + ("2" if style == "line" else "3"))
    engine.command(f"units {units}")
    if style.startswith("template"):
        with tempfile.NamedTemporaryFile("w", suffix=".mol") as file:
            file.write(MOLECULE)
            file.flush()
            engine.command(f"molecule two {file.name}")
            engine.command(f"atom_style {style}")
    else:
        engine.command(f"atom_style {style}")
    engine.command("atom_modify map array sort 0 0.0")
    return engine


def attempt(engine, command):
    try:
        engine.command(command)
    except Exception:  # a style without that quantity
        return False
    return True


def truth_of(engine, ids):
    """What the engine has of its atoms, in the order of `ids`."""
    import numpy
    found = {}
    local = numpy.array(engine.numpy.extract_atom("id"))[:len(ids)].tolist()
    order = [local.index(i) for i in ids]
    for name, member, scale in [("x", "positions", 1), ("type", "types", 1), ("q", CHARGE, 1), ("molecule", MOL, 1),
                                ("v", "velocities", 1)]:
        values = engine.numpy.extract_atom(name)
        if values is None:
            continue
        values = numpy.array(values)[:len(ids)]
        if name == "v":
            values = values[:, 0]
        found[member] = [values[k].tolist() for k in order]
    found["types"] = [str(t) for t in found["types"]]
    if engine.extract_atom("molecule") is None:
        found[MOL] = [None] * len(ids)
    if engine.extract_atom("q") is None:
        found[CHARGE] = [None] * len(ids)
    return found


def ids_in(path, heading):
    with open(path, encoding="ascii") as file:
        text = file.read()
    lines = text[text.index(heading):].split("\n")[1:]
    ids = []
    for line in lines:
        if not line.strip():
            if ids:
                break
            continue
        if not line[0].isdigit():
            break
        ids.append(int(line.split()[0]))
    return ids


def write_style(folder, style, number):
    name = style.split()[0]
    engine = start(style, "electron" if name == "electron" else "lj")
    z = 0 if name == "line" else 1
    engine.command(f"region box block -1 10 0 11 {'-0.5 0.5' if name == 'line' else '-2 12'}")
    engine.command("create_box 3 box")
    if name.startswith("template"):
        engine.command("create_atoms 0 single 3 4 5 mol two 77")
        engine.command("create_atoms 0 single 7 8 9 mol two 78")
    else:
        for kind, x, y, depth in [(1, 1.25, 2.25, 4.5), (3, 3.125, 5.5, 6.5), (2, -0.5, 10.875, -1.75), (1, 9, 1, 1)]:
            engine.command(f"create_atoms {kind} single {x} {y} {depth * z}")
    attempt(engine, "mass * 12.5")
    for setting in ("charge -0.75", "mol 7", "diameter 0.875", "density 2.5", "dipole 0 0 1", "spin/atom 2.2 0 0 1", "volume 3.5"):
        attempt(engine, f"set group all {setting}")
    attempt(engine, "set atom 2 charge 1.25")
    attempt(engine, "set atom 3 diameter 1.5")
    engine.command("velocity all set 0.5 1.5 0")
    engine.command("velocity all ramp vx 0 4 x -1 10 sum yes")
    path = os.path.join(folder, f"style{number}.data")
    engine.command(f"write_data {path} nocoeff")
    truth = truth_of(engine, ids_in(path, "Atoms"))
    if name in ("sphere", "bpm/sphere"):
        radius = engine.numpy.extract_atom("radius")
        truth[RADIUS] = [float(radius[i]) for i in range(len(truth["types"]))]
    engine.close()
    return {os.path.basename(path): truth}


def write_cells(folder):
    """A general triclinic box, and the restricted one that is the same; types with labels; units; data and dumps."""
    written = {}
    for units, mass, angstrom in [("real", 1, 1), ("si", 1.66053906660e-27, 1e-10), ("cgs", 1.66053906660e-24, 1e-8),
                                  ("electron", 1, 1 / 0.529177210903), ("nano", 1.66053906660e-6, 0.1)]:
        engine = start("full", units)
        s = angstrom
        engine.command(f"lattice custom 1.0 a1 {4 * s} {1 * s} 0 a2 {-s} {4 * s} {0.5 * s} a3 {0.5 * s} {0.25 * s} {5 * s} "
                       "basis 0.125 0.125 0.125 basis 0.625 0.625 0.375 triclinic/general")
        engine.command("create_box 2 NULL 0 2 0 1 0 1 bond/types 1 extra/bond/per/atom 4 extra/special/per/atom 8")
        engine.command("create_atoms 1 box basis 2 2")
        engine.command(f"mass 1 {12.011 * mass}")
        engine.command(f"mass 2 {15.9994 * mass}")
        engine.command("labelmap atom 1 C1 2 O2")
        engine.command("labelmap bond 1 C1-O2")
        engine.command("set type 1 charge 0.5")
        engine.command("bond_style zero")
        engine.command("bond_coeff *")
        engine.command(f"pair_style zero {s}")
        engine.command("pair_coeff * *")
        engine.command(f"neighbor {s} bin")
        engine.command("create_bonds single/bond 1 1 2 special no")
        engine.command("create_bonds single/bond 1 4 1 special yes")
        engine.command("velocity all set 1 2 3")
        for kind, options in [("general", "triclinic/general"), ("labels", "types labels"), ("plain", "")]:
            path = os.path.join(folder, f"{kind}_{units}.data")
            engine.command(f"write_data {path} nocoeff {options}")
            ids = ids_in(path, "Atoms")
            truth = truth_of(engine, ids)
            truth["types"] = [["", "C1", "O2"][int(t)] for t in truth["types"]]
            truth["symbols"] = [t[0] for t in truth["types"]]
            truth["angstrom"] = [angstrom]
            truth["pairs"] = [[ids.index(1), ids.index(2)], [ids.index(4), ids.index(1)]]
            low, high, xy, yz, xz, *_ = engine.extract_box()
            truth["cell"] = [[high[0] - low[0], 0, 0], [xy, high[1] - low[1], 0], [xz, yz, high[2] - low[2]]]
            truth["origin"] = list(low)
            if kind == "general":  # as the lattice was given
                a, b, c = [8 * s, 2 * s, 0], [-s, 4 * s, 0.5 * s], [0.5 * s, 0.25 * s, 5 * s]
                truth["cell"], truth["origin"] = [a, b, c], [0, 0, 0]
                shares = {1: (1 / 16, 1 / 8, 1 / 8), 2: (5 / 16, 5 / 8, 3 / 8), 3: (9 / 16, 1 / 8, 1 / 8), 4: (13 / 16, 5 / 8, 3 / 8)}
                truth["positions"] = [[sum(w * v[i] for w, v in zip(shares[k], (a, b, c))) for i in range(3)] for k in ids]
                del truth["velocities"]
            written[os.path.basename(path)] = truth
            for number, columns in enumerate(["id type x y z q vx", "vx q xs ys zs type id", "id mass q xsu ysu zsu vx",
                                              "id q vx xu yu zu element"]):
                if kind == "labels" or (kind == "general" and "s ys" in columns + "su ysu" and "xs" in columns):
                    continue
                dump = os.path.join(folder, f"{kind}_{units}_{number}.dump")
                modify = "sort id units yes time yes" + (" triclinic/general yes" if kind == "general" else "")
                modify += " element C O" if "element" in columns else ""
                engine.command(f"write_dump all custom {dump} {columns} modify {modify}")
                order = [ids.index(k) for k in sorted(ids)]
                of_dump = {m: [v[k] for k in order] if len(v) == len(ids) and m not in ("cell", "origin", "angstrom", "pairs") else v
                           for m, v in truth.items() if m != "pairs"}
                of_dump["types"] = ([str("CO".index(t[0]) + 1) for t in of_dump["types"]] if "type" in columns else
                                    [t[0] for t in of_dump["types"]] if "element" in columns else [""] * len(ids))
                if "mass" not in columns and "element" not in columns:
                    of_dump["symbols"] = [""] * len(ids)
                written[os.path.basename(dump)] = of_dump
        engine.close()
    return written


def by_lammps(folder):
    written = {}
    for number, style in enumerate(STYLES):
        written.update(write_style(folder, style, number))
    written.update(write_cells(folder))
    return written


def by_mdanalysis():
    import MDAnalysis
    import MDAnalysisTests
    folder = os.path.join(os.path.dirname(MDAnalysisTests.__file__), "data", "lammps")
    unpacked = tempfile.mkdtemp(prefix="ballpark-lammps-")
    found = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if name.endswith((".data.bz2", ".lammpstrj.bz2")) and os.path.getsize(path) < 1 << 20:
            with bz2.open(path) as packed:
                path = os.path.join(unpacked, name[:-4])
                with open(path, "wb") as file:
                    file.write(packed.read())
        kind = "DATA" if ".data" in path else "LAMMPSDUMP" if path.endswith((".lammpstrj", ".dump")) else None
        if kind is None:
            continue
        if path.endswith(".data2"):  # under a name by which it is known
            link = os.path.join(unpacked, name + ".data")
            os.symlink(path, link)
            path = link
        try:
            universe = MDAnalysis.Universe(path, format=kind, topology_format=kind)
        except Exception:  # files that are there to be refused
            continue
        frames = {}
        for frame in sorted({0, len(universe.trajectory) - 1}):
            universe.trajectory[frame]
            atoms, columns = universe.atoms, {}
            ids = [int(a) for a in atoms.ids]
            order = file_order(path, kind, frame)
            places = [ids.index(i) for i in order] if len(order) == len(ids) else list(range(len(ids)))
            positions = atoms.positions.astype(float).tolist()
            truth = {"columns": columns, "types": [str(atoms.types[k]) for k in places]}
            if kind == "DATA":
                truth["positions"] = [positions[k] for k in places]
                if hasattr(atoms, "charges"):
                    columns["q"] = [float(atoms.charges[k]) for k in places]
                if universe.trajectory.ts.has_velocities:
                    # angstrom per picosecond there, per femtosecond in the file
                    columns["vx"] = [float(universe.trajectory.ts.velocities[k][0]) / 1000 for k in places]
                if hasattr(universe, "bonds"):
                    inverse = {k: n for n, k in enumerate(places)}
                    truth["pairs"] = sorted(sorted(inverse[int(k)] for k in bond) for bond in universe.bonds.indices)
            else:
                # MDAnalysis moves the corner of the cell to the origin.
                truth["ways"] = [[positions[k][c] - positions[places[0]][c] for c in range(3)] for k in places]
                if not has_column(path, "type"):
                    del truth["types"]
            frames[frame] = truth
        found[path] = frames
    return found


def file_order(path, kind, frame):
    with open(path, encoding="ascii") as file:
        text = file.read()
    if kind == "DATA":
        rows = text[text.index("\nAtoms"):].split("\n", 2)[2].strip().split("\n")
        order = []
        for row in rows:
            if not row.strip() or not row.strip()[0].isdigit():
                break
            order.append(int(row.split()[0]))
        return order
    part = text.split("ITEM: TIMESTEP\n")[1:][frame]
    head, rows = part[part.index("ITEM: ATOMS"):].split("\n", 1)
    column = head.split()[2:].index("id")
    return [int(row.split()[column]) for row in rows.strip().split("\n")]


def has_column(path, name):
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("ITEM: ATOMS"):
                return name in line.split()
    return False


def main():
    try:
        print(json.dumps(by_lammps(sys.argv[2]) if sys.argv[1] == "lammps" else by_mdanalysis()))
    except (ImportError, OSError) as error:
        print(error, file=sys.stderr)
        return 77
    return 0


sys.exit(main())
