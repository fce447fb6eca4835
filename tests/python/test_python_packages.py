"""Objects of ASE, MDAnalysis and gsd become spheres; where a package is not installed, an object that looks like its own
takes its place. Radii and colours are those of files of particles.

Usage: test_python_packages.py SOURCE_DIR BUILD_DIR
"""

import json
import pathlib
import sys
import tempfile
import types
import warnings

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
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # test_unknown_elements
        assert np.allclose(ballpark.from_mdanalysis(universe).radius, 1.7)
    (folder / "ala.pdb").write_text(PDB)
    module = installed("MDAnalysis")
    if module:
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


def test_gsd_shapes(folder):
    """Sizes in type_shapes, as hard particles have them: known lengths, and what the library reads of the same file."""
    shapes = [{"type": "Sphere", "diameter": 0.5}, {"type": "Ellipsoid", "a": 0.25, "b": 0.5, "c": 1},
              {"type": "ConvexPolyhedron", "rounding_radius": 0.25, "vertices": [[0.3, 0, 0.4], [0, 0.1, 0], [0, 0, 0], [0.1, 0, 0]]},
              {"type": "SphereUnion", "centers": [[0, 0, 0.5], [0, 0, -0.5]], "diameters": [0.5, 1]}, {}]
    particles = types.SimpleNamespace(position=np.float32([[2 * i, 0, i] for i in range(5)]), typeid=np.arange(5), type_shapes=shapes,
                                      diameter=np.ones(5, np.float32))
    frame = types.SimpleNamespace(particles=particles, configuration=types.SimpleNamespace(dimensions=3))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        spheres = ballpark.from_gsd(frame)
    assert np.allclose(spheres.radius, [0.25, 0.5, 0.75, 1, 0.5]), spheres.radius
    assert len(caught) == 1 and "3 of 5" in str(caught[0].message) and caught[0].filename == __file__
    particles.diameter = np.float32([1, 2, 3, 4, 5])  # the particles' own go first
    assert np.allclose(ballpark.from_gsd(frame).radius, [0.5, 1, 1.5, 2, 2.5])
    module = installed("gsd.hoomd")
    if module and hasattr(module, "Frame"):
        real = module.Frame()
        real.particles.N, real.particles.position = 3, [[0, 0, 0], [2, 0, 0], [0, 2, 1]]
        real.particles.types, real.particles.typeid, real.particles.type_shapes = ["A", "B"], [0, 1, 0], shapes[:2]
        real.configuration.box = [8, 8, 8, 0, 0, 0]
        with module.open(name=str(folder / "shapes.gsd"), mode="w") as file:
            file.append(real)
        with module.open(name=str(folder / "shapes.gsd"), mode="r") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            spheres = ballpark.from_gsd(file[0])
        assert np.allclose(spheres.radius, [0.25, 0.5, 0.25]) and np.array_equal(spheres.positions, real.particles.position)
        with_shapes = ballpark.Scene.load(folder / "shapes.gsd")
        assert (with_shapes.spheres, with_shapes.triangles) == (2, 11520)
        document = {"camera": {"image_width": 800, "aspect_ratio": [4, 3], "vfov": 30, "fit": "particles"}, "lighting": "soft",
                    "backdrop": [1, 1, 1], "particles": [{"file": "shapes.gsd", "shapes": False}]}
        (folder / "spheres.json").write_text(json.dumps(document))
        same_picture(spheres, folder / "spheres.json")


def test_values_of_ase(folder):
    """A frame of a file by ASE: positions as it gives them, and the picture of the library's own reader."""
    if installed("ase.io"):
        import ase.io
        path = folder / "frames.xyz"
        frames = [np.round(np.random.default_rng(seed).random((4, 3)) * 8, 3) for seed in (1, 2)]
        path.write_text("".join("4\n\n" + "".join(f"{symbol} {x} {y} {z}\n" for symbol, (x, y, z) in zip("CONH", frame))
                                for frame in frames))
        read = ase.io.read(path, index=":")
        for atoms, frame in zip(read, frames):
            spheres = ballpark.from_ase(atoms)
            assert np.array_equal(spheres.positions, frame) and np.allclose(spheres.radius, [1.7, 1.52, 1.55, 1.1])
            depth = ballpark.render(spheres, width=64, spp=1, aovs=True, camera={"lookfrom": [4, 4, 60], "lookat": [4, 4, 0],
                                                                               "vfov": 20}).depth
            front = (frame[:, 2] + spheres.radius).max()
            assert 60 - front - 0.01 < depth.min() < 60 - front + 0.3, (depth.min(), front)
        same_picture(ballpark.from_ase(read[0]), path)


def test_unknown_elements(_folder):
    """They are counted, where radii or colours are those of elements."""
    class Ghosts(FakeAtoms):
        def get_atomic_numbers(self):
            return np.array([8, 0, 200])

    universe = types.SimpleNamespace(positions=np.zeros((3, 3), np.float32), elements=np.array(["C", "Q", ""], object))
    for name, thing in (("from_ase", Ghosts()), ("from_mdanalysis", universe)):
        function = getattr(ballpark, name)
        for arguments, said in (({}, 1), ({"radius": "covalent"}, 1), ({"radius": 1.0}, 1), ({"color": "#ffffff"}, 1), ({"radius": 1.0, "color": "#ffffff"}, 0)):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                function(thing, **arguments)
            assert [str(one.message) for one in caught] == [f"ballpark: {name}: no element is known of 2 of 3 atoms"] * said, (name, arguments)
            assert all(one.filename == __file__ for one in caught)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ballpark.from_ase(FakeAtoms())


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
    for function in (test_ase, test_mdanalysis, test_gsd, test_gsd_shapes, test_values_of_ase, test_unknown_elements, test_refused):
        print(function.__name__, flush=True)
        function(pathlib.Path(name))
for name in left_out:
    print(f"skipped: not installed: {name}")
print("ok")
