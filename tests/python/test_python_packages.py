"""Objects of ASE, MDAnalysis and gsd become spheres; where a package is not installed, an object that looks like its own
takes its place. Radii and colours are those of files of particles.

Usage: test_python_packages.py SOURCE_DIR BUILD_DIR
"""

import pathlib
import sys
import tempfile
import types

import package

source, build = sys.argv[1:]
ballpark, np = package.load(source, build)
left_out = []


def installed(name):
    try:
        return __import__(name, fromlist=["_"])
    except Exception as problem:  # of a package that is broken as well
        left_out.append(f"{name} ({problem.__class__.__name__})")
        return None


def same_picture(spheres, file, **named):
    """As the library reads the file itself."""
    scene = ballpark.Scene.load(file)
    mine = ballpark.make_scene(spheres, **named)
    assert mine.spheres == scene.spheres
    close = [np.allclose(a, b, atol=1e-4) for a, b in ((mine.camera.lookfrom, scene.camera.lookfrom),
                                                       (mine.camera.vup, scene.camera.vup))]
    assert all(close), (mine.camera, scene.camera)
    a, b = (ballpark.render(one, width=40, spp=64).radiance for one in (mine, scene))
    assert abs(a - b).mean() < 0.005, abs(a - b).mean()


class FakeAtoms:
    def get_atomic_numbers(self):
        return np.array([8, 1, 1])

    def get_positions(self):
        return np.array([[0, 0, 0.119], [0, 0.763, -0.477], [0, -0.763, -0.477]])


def test_ase(folder):
    spheres = ballpark.from_ase(FakeAtoms())
    assert np.allclose(spheres.radius, [1.52, 1.1, 1.1])
    assert spheres.color[0][0] > spheres.color[0][2] and spheres.color[1][0] > 0.6  # red oxygen, white hydrogen
    half = ballpark.from_ase(FakeAtoms(), radius="covalent", scale=0.5, color="#ffffff")
    assert np.allclose(half.radius, [0.33, 0.155, 0.155]) and half.color == "#ffffff"
    package.refused(ValueError, ["radius", "covalent"], ballpark.from_ase, FakeAtoms(), radius="atomic")
    (folder / "water.xyz").write_text("3\n\nO 0 0 0.119\nH 0 0.763 -0.477\nH 0 -0.763 -0.477\n")
    same_picture(spheres, folder / "water.xyz")
    if installed("ase.io"):
        import ase.io
        same_picture(ballpark.from_ase(ase.io.read(folder / "water.xyz")), folder / "water.xyz")


PDB = "".join("ATOM  %5d %-4s %3s A%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n" % atom for atom in (
    (1, " N", "ALA", 1, 0, 0, 0, "N"), (2, " CA", "ALA", 1, 1.46, 0, 0, "C"), (3, " C", "ALA", 1, 2.0, 1.4, 0, "C"),
    (4, " O", "ALA", 1, 1.3, 2.4, 0.5, "O"))) + "END\n"


def test_mdanalysis(folder):
    fake = types.SimpleNamespace(positions=np.float32([[0, 0, 0], [3, 0, 0]]), elements=np.array(["C", "Cl"], object))
    spheres = ballpark.from_mdanalysis(fake)
    assert np.allclose(spheres.radius, [1.7, 1.75])
    # By names where the topology knows no elements; "CA" is a carbon in one residue and calcium in the other.
    fake = types.SimpleNamespace(positions=np.zeros((3, 3), np.float32), names=np.array(["CA", "CA", "OW"], object),
                                 resnames=np.array(["ALA", "CA", "SOL"], object))
    assert np.allclose(ballpark.from_mdanalysis(fake).radius, [1.7, 2.31, 1.52])
    # A universe holds its atoms; those without a name look alike.
    universe = types.SimpleNamespace(atoms=types.SimpleNamespace(positions=np.zeros((2, 3), np.float32)))
    assert np.allclose(ballpark.from_mdanalysis(universe).radius, 1.7)
    (folder / "ala.pdb").write_text(PDB)
    module = installed("MDAnalysis")
    if module:
        import warnings
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            universe = module.Universe(str(folder / "ala.pdb"))
        same_picture(ballpark.from_mdanalysis(universe), folder / "ala.pdb")
        assert len(ballpark.from_mdanalysis(universe.select_atoms("name CA")).positions) == 1


def test_gsd(folder):
    particles = types.SimpleNamespace(position=np.float32([[0, 0, 0], [2, 0, 0], [0, 2, 1]]), typeid=np.array([0, 1, 0]),
                                      diameter=np.float32([1, 2, 1]))
    frame = types.SimpleNamespace(particles=particles, configuration=types.SimpleNamespace(dimensions=3))
    spheres = ballpark.from_gsd(frame)
    assert np.allclose(spheres.radius, [0.5, 1, 0.5]) and spheres.up == "z"
    assert (spheres.color[0] == spheres.color[2]).all() and (spheres.color[0] != spheres.color[1]).any()
    frame.configuration.dimensions = 2
    assert ballpark.make_scene(ballpark.from_gsd(frame)).camera.vup == (0, 1, 0)
    particles.diameter = particles.typeid = None
    assert np.allclose(ballpark.from_gsd(frame).radius, 0.5)
    ballpark.make_scene(ballpark.from_gsd(frame, scale=0.5))
    module = installed("gsd.hoomd")
    if module:
        real = (getattr(module, "Frame", None) or module.Snapshot)()
        real.particles.N = 3
        real.particles.position = [[0, 0, 0], [2, 0, 0], [0, 2, 1]]
        real.particles.types, real.particles.typeid = ["A", "B"], [0, 1, 0]
        real.particles.diameter = [1, 2, 1]
        real.configuration.box = [8, 8, 8, 0, 0, 0]
        path = folder / "frame.gsd"
        with module.open(name=str(path), mode="w" if hasattr(module, "Frame") else "wb") as file:
            file.append(real)
        with module.open(name=str(path), mode="r" if hasattr(module, "Frame") else "rb") as file:
            same_picture(ballpark.from_gsd(file[0]), path)


def test_refused(folder):
    """What is no object of the package is named, and so is the function that takes it."""
    arrays = np.zeros((2, 3))
    for function, expected in ((ballpark.from_ase, "ase.Atoms"), (ballpark.from_mdanalysis, "AtomGroup"),
                               (ballpark.from_gsd, "trajectory[0]")):
        for thing in (3, None, arrays, "water.xyz", [FakeAtoms()]):
            package.refused(TypeError, [function.__name__, type(thing).__name__, expected], function, thing)
    foreign = type("Atoms", (FakeAtoms,), {"__module__": "ase.atoms", "positions": arrays, "__len__": lambda self: 2})()
    package.refused(TypeError, ["found Atoms", "ballpark.from_ase()"], ballpark.from_mdanalysis, foreign)
    package.refused(TypeError, ["found Atoms", "positions (N, 3)", "ballpark.from_ase()"], ballpark.render, foreign)
    package.refused(ValueError, ["scale", "text"], ballpark.from_ase, FakeAtoms(), scale="half")
    empty = types.SimpleNamespace(particles=types.SimpleNamespace(position=None), configuration=None)
    package.refused(TypeError, ["positions", "NoneType"], ballpark.from_gsd, empty)


with tempfile.TemporaryDirectory() as name:
    for function in (test_ase, test_mdanalysis, test_gsd, test_refused):
        print(function.__name__, flush=True)
        function(pathlib.Path(name))
for name in left_out:
    print(f"skipped: not installed: {name}")
print("ok")
