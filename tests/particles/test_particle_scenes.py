"""Files of particles as scenes, through the program: `scene`, `render`, the member "particles", fitted cameras.

Run as: PYTHONPATH=tests/support python3 test_particle_scenes.py PROGRAM SOURCE_DIR
"""
import gzip
import json
import math
import os
import random

from cli import ProgramTest, main, scene
from pfm import read_pfm

ATOMS = "4\n\nO 0 0 0\nH 1 0 0\nC 0 2 0\nFe 0 0 4\n"
SIZE = ("--width", 24, "--spp", 2, "-q")


def pdb_line(number, name, residue, place, element="  ", chain="A", record="ATOM  "):
    return (f"{record}{number:5d} {name:4s} {residue:>3s} {chain}{number:4d}    {place[0]:8.3f}{place[1]:8.3f}{place[2]:8.3f}"
            f"  1.00  0.00          {element:>2s}\n")


def dump(frames):
    return "".join(f"ITEM: TIMESTEP\n{i}\nITEM: NUMBER OF ATOMS\n{len(points)}\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\n"
                   "ITEM: ATOMS id type x y z heat\n" +
                   "".join(f"{k} 1 {x} {y} {z} {k + 10 * i}\n" for k, (x, y, z) in enumerate(points))
                   for i, points in enumerate(frames))


class Scenes(ProgramTest):
    def document(self, name, *arguments):
        return json.loads(self.succeed("scene", name, *arguments).stdout)

    def notes(self, name, *arguments):
        return self.succeed("scene", name, *arguments).errors

    def picture(self, name, *arguments, output="x.pfm"):
        self.succeed("render", name, *SIZE, "-o", output, *arguments)
        return self.read(output)

    def document_with(self, particles, **members):
        return self.write("x.json", dict({"camera": {"fit": "particles"}, "particles": [particles]}, **members))

    def spheres(self, name, *arguments):
        """How many spheres the scene has."""
        self.succeed("render", name, "--width", 4, "--spp", 1, "-q", "-o", "n.pfm", "--stats", "n.json", *arguments)
        return json.loads(self.read("n.json"))["spheres"]

    def shapes(self, name):
        """How many spheres and how many capsules the scene has."""
        self.succeed("explain", name, "--json", "e.json", "-q")
        [found] = json.loads(self.read("e.json"))["scenes"]
        return found["spheres"], found["capsules"]

    def test_render_a_file(self):
        self.write("a.xyz", ATOMS)
        result = self.succeed("render", "a.xyz", "--width", 16, "--spp", 2)
        self.assertEqual(self.files(), ["a.png", "a.xyz"])
        self.assertIn("a.xyz: 4 particles; van der Waals radii", result.errors)
        self.write("b.xyz.gz", gzip.compress(ATOMS.encode()))
        self.succeed("render", "b.xyz.gz", *SIZE)
        self.assertIn("b.png", self.files())

    def test_scene_renders_alike(self):
        os.mkdir(self.path("data"))
        os.mkdir(self.path("out"))
        self.write("data/a.xyz", ATOMS)
        direct = self.picture("data/a.xyz")
        self.succeed("scene", "data/a.xyz", "-o", "data/a.json", "-q")
        self.assert_same(self.picture("data/a.json"), direct, "beside the file")
        self.assertEqual(json.loads(self.read("data/a.json"))["particles"], [{"file": "a.xyz"}])
        self.succeed("scene", "data/a.xyz", "-o", "out/a.json", "-q")
        self.assert_same(self.picture("out/a.json"), direct, "in another folder")
        self.assertEqual(json.loads(self.read("out/a.json"))["particles"], [{"file": self.path("data/a.xyz")}])
        self.succeed("scene", "data/a.xyz", "-o", "above.json", "-q")
        self.assertEqual(json.loads(self.read("above.json"))["particles"], [{"file": "data/a.xyz"}])
        self.assert_same(self.picture("above.json"), direct, "in a folder above")
        self.succeed("scene", self.path("data/a.xyz"), "-o", self.path("above.json"), "-q")
        self.assertEqual(json.loads(self.read("above.json"))["particles"], [{"file": "data/a.xyz"}])
        self.write("piped.json", self.succeed("scene", "data/a.xyz").stdout)
        self.assert_same(self.picture("piped.json"), direct, "by standard output")
        # Written and read again, a document stays the same.
        again = self.succeed("scene", "data/a.json", "-o", "data/b.json", "-q")
        self.assertEqual(again.stdout, b"")
        self.assertEqual(self.read("data/a.json"), self.read("data/b.json"))

    def test_members_survive(self):
        self.write("a.dump", dump([[(1, 1, 1), (2, 2, 2)]]))
        entry = {"file": "a.dump", "frame": -1, "style": "ball-and-stick", "radius": {"column": "heat", "scale": 0.5},
                 "color": {"column": "heat", "map": "coolwarm", "range": [0, 3], "bar": True}, "bonds": {"radius": 0.1}, "box": True,
                 "solvent": True, "whole": False, "material": "m"}
        other = {"file": "a.dump", "select": "heat >= 1 and type == 1", "radius": {"value": "0.1 * heat", "scale": 0.5},
                 "color": {"value": "heat ^ 2", "map": "coolwarm"}, "frame": -1}
        camera = {"image_width": 30, "fit": "scene", "view": [1, 2, 3], "margin": 0.1, "vup": [0, 1, 0], "aperture": 0.5}
        document = scene(camera=camera, particles=[entry, other], spheres=1)
        self.write("x.json", document)
        written = self.document("x.json")
        self.assertEqual(written["particles"], [entry, other])
        for name, value in camera.items():
            self.assertEqual(written["camera"][name], value)
        self.assertEqual((len(written["spheres"]), list(written["materials"])), (1, ["m"]))

    def test_documents_under_other_names(self):
        for name in ("x.xyz", "x.csv", "data.x"):
            self.write(name, b"\xef\xbb\xbf\n" + json.dumps(scene()).encode())
            self.assertEqual(self.spheres(name), 1)

    def test_all_scenes_can_be_printed(self):
        self.write("x.json", scene(spheres=3))
        self.write("y.json", self.succeed("scene", "x.json").stdout)
        self.assert_same(self.picture("x.json"), self.picture("y.json"))

    def test_bad_members(self):
        self.write("a.xyz", ATOMS)
        self.write("a.csv", "x,y,z,charge\n1,2,3,4\n")
        for changes, says in [({"file": "none.xyz"}, "none.xyz"), ({"file": "x.json"}, "unknown format"),
                              ({"frame": 1}, "no frame 1"), ({"frame": 0.5}, "whole number"),
                              ({"style": "stick"}, '"spacefill"'), ({"radius": 0}, "above 0"), ({"radius": "vdv"}, '"vdw"'),
                              ({"radius": {"by": "vdw", "column": "x"}}, "one of the two"), ({"colour": 1}, '"color"'),
                              ({"color": [0, 0, 2]}, "from 0 to 1"), ({"color": {"map": "viridis"}}, "column"), ({"color": {"bar": True}}, "column"),
                              ({"color": {"column": "x", "map": "virids"}}, '"viridis"'), ({"color": "chain"}, "no chains"),
                              ({"color": "temperature"}, '{ "column": "temperature" }'), ({"color": "elemnt"}, '"element"'),
                              ({"radius": "mass"}, '{ "column": "mass" }'),
                              ({"color": {"column": "x", "range": [2, 1]}}, "lesser"), ({"box": 1}, "true or false"),
                              ({"box": True}, "no cell"), ({"bonds": 3}, "true, false"), ({"material": "m"}, '"m"'),
                              ({"file": "a.csv", "color": {"column": "chrge"}}, "charge"),
                              ({"file": "a.csv", "radius": "vdw"}, "no elements")]:
            self.document_with(dict({"file": "a.xyz"}, **changes))
            self.fail_with(2, "render", "x.json", "-o", "x.png", says=says)
        for camera, says in [({"fit": "particles", "lookfrom": [1, 1, 1]}, "lookfrom"), ({"view": "front"}, "fit"),
                             ({"fit": "scene", "view": "up"}, "front"), ({"fit": "scene", "view": [0, 0, 0]}, "direction"),
                             ({"fit": "scene", "margin": 0.5}, "0.45"), ({"fit": "all"}, '"scene"'),
                             ({"fit": "scene", "defocus_angle": 1}, "aperture")]:
            self.document_with({"file": "a.xyz"}, camera=camera)
            self.fail_with(2, "render", "x.json", "-o", "x.png", says=["x.json:1:", says])
        self.write("x.json", scene(camera={"fit": "particles"}))
        self.fail_with(2, "render", "x.json", "-o", "x.png", says="the scene has none")
        self.fail_with(2, "render", "a.xyz", "-o", "a.xyz", says="overwrite")
        self.document_with({"file": "a.xyz"})
        self.fail_with(2, "render", "x.json", "-o", "a.xyz", "--format", "png", says="overwrite")

    def test_errors_name_file_and_line(self):
        self.write("a.xyz", "2\n\nO 0 0 0\nO 0 inf 0\n")
        self.fail_with(2, "render", "a.xyz", "-o", "x.png", says="a.xyz:4: ")
        self.document_with({"file": "a.xyz"})
        self.fail_with(2, "render", "x.json", "-o", "x.png", says=["a.xyz:4: ", "(particles of x.json:1:"])

    def test_hidden(self):
        water = [pdb_line(2, " O  ", "HOH", (9, 9, 9)), pdb_line(3, " H1 ", "HOH", (10, 9, 9))]
        protein = [pdb_line(1, " CA ", "ALA", (0, 0, 0))]
        extra = [pdb_line(4, " MW ", "HOH", (9, 9, 8)), pdb_line(5, "NA  ", " NA", (5, 5, 5))]
        self.write("a.pdb", "".join(protein + water + extra))
        self.assertIn("1 of 5 particles; hidden: 2 of water, 1 of ions, 1 dummy", self.notes("a.pdb"))
        self.assertEqual(self.spheres("a.pdb"), 1)
        self.document_with({"file": "a.pdb", "solvent": True})
        self.assertEqual(self.spheres("x.json"), 4)
        self.write("w.pdb", "".join(water))
        self.assertEqual(self.spheres("w.pdb"), 2)  # nothing else is there
        self.assertEqual(self.notes("a.pdb", "-q"), "")

    def test_coarse_grains(self):
        """Beads that have names like atoms are told by their distance."""
        for spacing, says in [(4.7, "half the median distance"), (1.4, "van der Waals")]:
            beads = [pdb_line(i, " C1 ", "DPP", (spacing * i, 0, 0)) for i in range(20)]
            self.write("a.pdb", "".join(beads))
            self.assertIn(says, self.notes("a.pdb"))

    def test_spacing(self):
        """Half the median of the distances to the nearest neighbour, over about a thousand particles, as all pairs give it."""
        source = random.Random(11)
        points = [tuple(source.random() for _ in range(3)) for _ in range(1500)]
        self.write("a.csv", "x,y,z\n" + "".join(f"{x!r},{y!r},{z!r}\n" for x, y, z in points))
        nearest = sorted(min(math.dist(p, q) for q in points if q != p) for p in points[::2])
        self.assertIn(f"radius {nearest[len(nearest) // 2] / 2:.3g}: half the median", self.notes("a.csv"))

    def test_molecules_made_whole(self):
        cell = "CRYST1   20.000   20.000   20.000  90.00  90.00  90.00 P 1           1\n"
        chain = [pdb_line(i, " C  ", "LIG", ((14 + 1.4 * i) % 20, 10, 10), " C") for i in range(10)]
        self.write("a.pdb", cell + "".join(chain))
        self.assertIn("made whole across the cell", self.notes("a.pdb"))
        broken = [pdb_line(i, " C  ", "LIG", (14 + 1.4 * i, 10, 10), " C") for i in range(10)]
        self.write("b.pdb", cell + "".join(broken))
        self.assertNotIn("whole", self.notes("b.pdb"))
        self.assert_same(self.picture("a.pdb"), self.picture("b.pdb"))
        # A chain without end stays.
        ring = [pdb_line(i, " C  ", "LIG", (20 / 14 * i, 10, 10), " C") for i in range(14)]
        self.write("c.pdb", cell + "".join(ring))
        self.assertNotIn("whole", self.notes("c.pdb"))

    def test_bonds_and_box(self):
        self.write("a.xyz", '2\nLattice="9 0 0 0 9 0 0 0 9" Properties=species:S:1:pos:R:3\nC 1 1 1\nO 2.2 1 1\n')
        self.assertEqual(self.spheres("a.xyz"), 2)
        self.document_with({"file": "a.xyz", "style": "ball-and-stick"})
        self.assertEqual(self.shapes("x.json"), (2, 1))
        self.document_with({"file": "a.xyz", "bonds": True})
        self.assertEqual(self.shapes("x.json"), (2, 0))  # the balls hide all of it
        self.assertIn("1 bond by distance", self.notes("x.json"))
        glass = {"glass": {"type": "dielectric", "refraction_index": 1.5}}
        self.document_with({"file": "a.xyz", "bonds": True, "material": "glass"}, materials=glass)
        self.assertEqual(self.shapes("x.json"), (2, 1))  # it is seen through the balls
        self.document_with({"file": "a.xyz", "box": True})
        self.assertEqual(self.shapes("x.json"), (2, 12))
        lamp = {"type": "diffuse_light", "emit": [1, 1, 1]}
        self.document_with({"file": "a.xyz", "style": "ball-and-stick", "material": "m"}, materials={"m": lamp})
        self.fail_with(2, "render", "x.json", says=["no rays are sent to capsules", 'leave "bonds" out'])
        self.document_with({"file": "a.xyz", "material": "m", "box": True}, materials={"m": lamp})
        self.fail_with(2, "render", "x.json", says=['leave "box" out'])

    def test_colours_of_bonds(self):
        """From above, under a white sky: each half of a bond has the colour of its end, and the bond ends where its middle says."""
        camera = {"image_width": 40, "aspect_ratio": 4, "samples_per_pixel": 1, "pixel_sampling": "center", "max_depth": 50,
                  "projection": "orthographic", "view_height": 1, "lookfrom": [0, 0, 5], "lookat": [0, 0, 0]}
        self.write("a.data", "LAMMPS\n\n2 atoms\n2 atom types\n1 bonds\n1 bond types\n-2 2 xlo xhi\n-2 2 ylo yhi\n-2 2 zlo zhi\n\nAtoms # bond\n\n1 1 1 -1 0 0\n2 1 2 1 0 0\n\nBonds\n\n1 1 1 2\n")
        entry = {"file": "a.data", "style": "ball-and-stick", "radius": 0.17, "bonds": {"radius": 0.17},
                 "color": {"types": {"1": [0.2, 0.4, 0.6], "2": [0.7, 0.3, 0.1]}}}
        self.document_with(entry, background=[1, 1, 1], camera=camera)
        self.succeed("render", "x.json", "-q", "-o", "x.pfm")
        width, height, values = read_pfm(self.read("x.pfm"))
        for column in range(11, 29):  # convex, so nothing is reflected by it into itself
            for row in range(height):
                y = (row + 0.5) / height - 0.5
                inside, color = abs(y) < 0.17, [0.2, 0.4, 0.6] if column < 20 else [0.7, 0.3, 0.1]
                for c in range(3):
                    self.assertAlmostEqual(values[3 * (row * width + column) + c], color[c] if inside else 1, delta=0.01, msg=(row, column))

    def test_long_line(self):
        """A comment longer than what is read of a file at first."""
        scenes = []
        for length in (5, 5000):
            self.write("one.xyz", "1\n" + "x" * length + "\nO 1 2 3\n")
            scenes.append(self.succeed("scene", "one.xyz").stdout)
        self.assertEqual(*scenes)

    def test_connections_of_pdb(self):
        """PDB files list some bonds only: the others are found by distance, and each is drawn once."""
        chain = [pdb_line(i, " C  ", "ALA", (1.4 * i, 0, 0), " C") for i in range(1, 6)]
        metal = pdb_line(9, "ZN  ", " ZN", (1.4, 4, 0), "ZN", record="HETATM")
        connections = "CONECT    1    9\nCONECT    9    1\nCONECT    2    1    1    3\nCONECT   50    1\n"
        self.document_with({"file": "a.pdb", "style": "ball-and-stick"})
        for text, says in [("", "4 bonds by distance\n"),
                           (connections, "5 bonds, 3 of them given by the file, the others by distance; "
                                         "left out: 1 connection to atoms that are missing or share their number\n"),
                           ("CONECT    1    9\nCONECT    3    1    2    4    5\nCONECT    2    1\nCONECT    4    5\n", "7 bonds"),
                           ("CONECT   50   51\n", "4 bonds by distance; left out: 1 connection to")]:
            self.write("a.pdb", "".join(chain) + metal + text + "END\n")
            self.assertIn(says, self.notes("x.json"))
        self.assertNotIn("bonds", self.notes("a.pdb"))  # as spheres
        # The file's bond and the one by distance are one, from whichever side it is listed.
        self.write("a.pdb", "".join(chain) + "END\n")
        plain = self.shapes("x.json")
        self.assertEqual(plain, (5, 4))
        self.write("a.pdb", "".join(chain) + "CONECT    3    2    2    4\nCONECT    2    3\nEND\n")
        self.assertEqual(self.shapes("x.json"), plain)
        # Beads of a coarse-grained model, which no distance joins.
        beads = [pdb_line(i, " C1 ", "DPP", (4.7 * i, 0, 0)) for i in range(1, 4)]
        self.write("a.pdb", "".join(beads) + "CONECT    1    2\nCONECT    2    3\n")
        self.assertRegex(self.notes("x.json"), r"2 bonds$")
        # What is wrong in a later model is the error of that model.
        self.write("a.pdb", "".join(beads) + "ENDMDL\n" + beads[0] + "\0\nENDMDL\nCONECT    1    2\n")
        self.assertIn("0 bonds by distance", self.notes("x.json"))
        self.document_with({"file": "a.pdb", "style": "ball-and-stick", "frame": 1})
        self.fail_with(2, "scene", "x.json", says=["a.pdb:6:", "value 0"])

    def test_radii_and_colours(self):
        """Two points that fill a picture each: the albedo is read off an EXR's place, here by the mean of a white dome."""
        def mean(entry):
            self.document_with(dict({"file": "a.csv"}, **entry), background=[1, 1, 1],
                               camera={"image_width": 8, "fit": "particles", "margin": 0, "view": "front", "max_depth": 50})
            self.succeed("render", "x.json", "-q", "--spp", 16, "-o", "x.pfm")
            width, height, values = read_pfm(self.read("x.pfm"))
            middle = 3 * (height // 2 * width + width // 2)
            return [values[middle + c] for c in range(3)]
        self.write("a.csv", "x,y,z,heat,type\n0,0,0,5,A\n")
        for entry, expected in [({"color": [0.2, 0.4, 0.6]}, [0.2, 0.4, 0.6]),
                                ({"color": {"types": {"A": [0.1, 0.7, 0.3]}}}, [0.1, 0.7, 0.3]),
                                # 8-bit sRGB (253, 231, 37), dimmed by 0.9
                                ({"color": {"column": "heat", "range": [0, 5]}}, [0.886, 0.719, 0.0167]),
                                ({"color": {"column": "heat", "range": [5, 9], "map": "coolwarm"}}, [0.0394, 0.0652, 0.474])]:
            for got, wanted in zip(mean(entry), expected):
                self.assertAlmostEqual(got, wanted, delta=0.012 * max(1, wanted), msg=entry)
        # A single sphere of a convex scene under a dome of 1 shows its albedo, whatever its radius.
        # A name that no particle has is likely a slip.
        for member, value in (("color", [1, 0, 0]), ("radius", 2)):
            for name, said in (("A", False), ("a", True)):
                notes = self.notes("a.csv", "--set", f'particles[0].{member}={{"types":{{"{name}":{json.dumps(value)}}}}}')
                self.assertEqual(f'no particle has the type "a" of "{member}"' in notes, said, (member, name))
        self.write("b.csv", "x,y,z,size\n0,0,0,1\n0,0,0,3\n")
        self.assertIn("half the median distance", self.notes("a.csv") + self.notes("b.csv"))

    def test_what_lacks_a_colour_is_grey(self):
        self.write("a.csv", "x,y,z,heat,type\n0,0,0,,A\n9,0,0,5,B\n0,9,0,NA,B\n0,0,9,1,B\n")
        by_heat = ("--set", 'particles[0].color={"column":"heat"}')
        self.assertIn("coloured by heat from 1 to 5 (viridis); grey for lack of a value: 2\n", self.notes("a.csv", "--wide", *by_heat))
        named = ("--set", 'particles[0].color={"column":"heat","types":{"A":[1,0,0]}}')
        self.assertIn("grey for lack of a value: 1\n", self.notes("a.csv", "--wide", *named))
        self.write("b.csv", "x,y,z,red,green,blue\n0,0,0,1,0,0\n9,0,0,,,\n")
        self.assertIn("grey for lack of a colour: 1\n", self.notes("b.csv", "--wide"))
        # The sphere without a colour encloses the other: a convex one under a dome of 1 shows its albedo.
        self.write("d.csv", "x,y,z,radius,red,green,blue,heat\n0,0,0,5,,,,\n0,0,0,1,0,0,1,3\n")
        for color in ({}, {"color": {"column": "heat"}}):
            self.document_with(dict({"file": "d.csv"}, **color), background=[1, 1, 1], camera={
                "image_width": 8, "fit": "particles", "margin": 0, "view": "front", "max_depth": 50})
            self.succeed("render", "x.json", "-q", "--spp", 16, "-o", "x.pfm")
            width, height, values = read_pfm(self.read("x.pfm"))
            middle = 3 * (height // 2 * width + width // 2)
            for value in values[middle:middle + 3]:
                self.assertAlmostEqual(value, ((152 / 255 + 0.055) / 1.055) ** 2.4, delta=0.012)
        self.write("c.csv", "x,y,z,red,green,blue,heat\n0,0,0,1,0,0,1\n")
        self.assertNotIn("grey", self.notes("c.csv") + self.notes("c.csv", *by_heat))

    def test_unknown_elements_are_said(self):
        """Where radii or colours are those of elements; not where the user or the file gives them."""
        self.write("a.xyz", "6\n\nC 0 0 0\nQ 1 0 0\nQ 2 0 0\nJ 3 0 0\nJo 4 0 0\nL 5 0 0\n")
        says = "no element is known of 5 particles (Q, J, Jo, ...)"
        for arguments in ((), ('particles[0].radius=1',), ('particles[0].color=[1,1,1]',), ('particles[0].radius={"types":{"Q":1}}',)):
            self.assertIn(says + "\n", self.notes("a.xyz", "--wide", *sum((["--set", one] for one in arguments), [])))
        for q in ("Q", "J"):
            both = [f"particles[0].{member}=" + '{"types":{"%s":%s}}' % (q, value) for member, value in (("radius", 1), ("color", [1, 0, 0]))]
            count = {"Q": "3 particles (J, Jo, L)", "J": "4 particles (Q, Jo, L)"}[q]
            self.assertIn(f"no element is known of {count}\n", self.notes("a.xyz", "--wide", "--set", both[0], "--set", both[1]))
        for arguments in (("--set", "particles[0].radius=1", "--set", "particles[0].color=type"), ("--select", "element == C")):
            self.assertNotIn("no element", self.notes("a.xyz", "--wide", *arguments))
        self.write("b.pdb", pdb_line(1, " C1 ", "LIG", (0, 0, 0), "C") + pdb_line(2, " Q1 ", "LIG", (1.5, 0, 0), "X"))
        self.assertIn("no element is known of 1 particle (Q1)\n", self.notes("b.pdb", "--wide"))
        self.write("c.xyz", "2\n\nQ 0 0 0\nJ 1 0 0\n")
        self.assertNotIn("no element", self.notes("c.xyz"))

    def test_kinds_keep_their_colours(self):
        """The order in a frame does not matter, and 10 comes after 2."""
        kinds = ["A", "B", "10", "2"]
        rows = [f"{i},0,0,{kind}" for i, kind in enumerate(kinds)]
        self.write("a.csv", "x,y,z,type\n" + "\n".join(rows))
        self.write("b.csv", "x,y,z,type\n" + "\n".join(reversed(rows)))
        self.assert_same(self.picture("a.csv"), self.picture("b.csv"))

    def test_two_dimensions(self):
        flat = "x,y,z\n" + "".join(f"{i % 7},{i // 7},0\n" for i in range(49))
        self.write("a.csv", flat)
        self.write("b.csv", flat.replace(",z", "").replace(",0\n", "\n"))
        self.document_with({"file": "a.csv"}, camera={"image_width": 800, "aspect_ratio": [4, 3], "vfov": 30, "max_depth": 20,
                                                      "fit": "particles", "view": "front", "vup": [0, 1, 0]},
                           lighting="soft")
        for name in ("b.csv", "x.json"):
            self.assert_same(self.picture("a.csv"), self.picture(name), name)

    def test_fit(self):
        """Nothing lit touches the margin, and the picture is filled."""
        self.write("a.csv", "x,y,z,radius\n" + "".join(f"{math.sin(i)},{math.cos(i)},{i / 9},0.2\n" for i in range(40)))
        for view in ("front", "right", "top", "bottom", "three-quarter", [1, -2, 0.5]):
            self.document_with({"file": "a.csv", "color": [0.1, 0.1, 0.1]}, background=[1, 1, 1],
                               camera={"image_width": 100, "aspect_ratio": 1.5, "fit": "particles", "view": view})
            self.succeed("render", "x.json", "-q", "--spp", 4, "-o", "x.pfm")
            width, height, values = read_pfm(self.read("x.pfm"))
            lit = [(i % width, i // width) for i in range(width * height) if values[3 * i] < 0.999]
            across = max(x for x, _ in lit) - min(x for x, _ in lit) + 1
            up = max(y for _, y in lit) - min(y for _, y in lit) + 1
            self.assertTrue(min(x for x, _ in lit) >= 4 and max(x for x, _ in lit) < width - 4, view)
            self.assertTrue(min(y for _, y in lit) >= 2 and max(y for _, y in lit) < height - 2, view)
            self.assertGreaterEqual(max(across, up), 0.85 * height, view)

    def test_fit_option(self):
        self.write("x.json", scene(spheres=2, background=[1, 1, 1], materials={"m": {"type": "lambertian", "albedo": [0, 0, 0]}}))
        def shares(*options):
            _, _, values = read_pfm(self.picture("x.json", *options))
            return sum(v < 0.5 for v in values) / len(values)
        self.assertLess(shares() + 0.1, shares("--fit"))
        self.assertEqual(self.document("x.json", "--fit")["camera"]["fit"], "scene")

    def test_frames(self):
        frames = [[(1, 1, 1)], [(1, 1, 1), (8, 1, 1)], [(1, 8, 1)], [(1, 1, 8)]]
        self.write("run.dump", dump(frames))
        for frame, count in [(0, 1), (1, 2), (-3, 2)]:
            self.assertEqual(self.spheres("run.dump", "--frame", frame), count)
        self.assertEqual(self.document("run.dump", "--frame", 1)["particles"], [{"file": "run.dump", "frame": 1}])
        for frame in (4, -5):
            self.fail_with(2, "render", "run.dump", "--frame", frame, says=[f"no frame {frame}", "4 frames"])
        self.write("plain.json", scene())
        for command in "render", "scene", "explain":
            self.fail_with(2, command, "plain.json", "--frame", 0, says=["--frame: plain.json has no particles"])
        self.write("counts.dump", dump(frames[1:2]).replace("ATOMS\n2", "ATOMS\n1"))
        for frame in 0, 1, -1:
            self.fail_with(2, "render", "counts.dump", "--frame", frame, says=["counts.dump:11: found more atoms than ITEM: NUMBER OF ATOMS"])
        for text, numbers in [("::", [0, 1, 2, 3]), ("1:3", [1, 2]), ("::2", [0, 2]), ("-2:", [2, 3]), (":-1:2", [0, 2])]:
            self.succeed("render", "run.dump", *SIZE, "--frames", text, "-o", "f.pfm")
            made = [name for name in self.files() if name.startswith("f-")]
            self.assertEqual(made, [f"f-{i:04d}.pfm" for i in numbers], text)
            for name in made:
                os.remove(self.path(name))
        self.succeed("render", "run.dump", *SIZE, "--frames", "1:2")
        self.assertIn("run-0001.png", self.files())
        os.mkdir(self.path("pictures"))
        for folder in ("pictures", "pictures/"):
            self.succeed("render", "run.dump", *SIZE, "--frames", "1:3", "-o", folder)
            self.assertEqual(sorted(os.listdir(self.path("pictures"))), ["run-0001.png", "run-0002.png"])
        for options, says in [(("--frames", "4:"), "no such frame"), (("--frames", "3"), "A:B:S"), (("--frames", "::0"), "A:B:S"),
                              (("--frames", "::", "--frame", 1), "--frame"), (("--frames", "::", "--turntable", 3), "together"),
                              (("--frames", "::", "--stats", "s.json"), "--stats"), (("--frames", "::", "-o", "-"), "standard output"),
                              (("--turntable", 3, "--error-map", "e.png"), "--error-map"), (("--turntable", 1), "2"),
                              (("--frame", "x"), "whole number")]:
            self.fail_with(2, "render", "run.dump", *options, says=says)
        self.write("x.json", scene())
        self.fail_with(2, "render", "x.json", "--frames", "::", says="no particles")

    def test_one_camera_for_the_bonds_of_all_frames(self):
        """Where each frame's bond, wider than its atoms, is seen follows from what all frames' bonds take: seen along z without
        perspective, their box, with the margin around it, fills the height of the picture."""
        frames, radius, margin = (((0, 0), (1.4, 0)), ((3, 1), (3, 2.4)), ((1, 1.5), (1, 1.5 + 1.2))), 0.9, 0.1
        self.write("run.xyz", "".join("2\n\n" + "".join(f"C {x} {y} 0\n" for x, y in frame) for frame in frames))
        self.document_with({"file": "run.xyz", "radius": 0.2, "color": [0, 0, 0], "bonds": {"radius": radius}}, background=[1, 1, 1],
                           camera={"image_width": 240, "aspect_ratio": 1.5, "projection": "orthographic", "fit": "particles", "view": "front",
                                   "margin": margin})
        self.succeed("render", "x.json", "-q", "--spp", 4, "--frames", "::", "-o", "f.pfm")
        ends = [end for frame in frames for end in frame]
        low, high = ([pick(end[a] for end in ends) + way * radius for a in range(2)] for pick, way in ((min, -1), (max, 1)))
        scale = 160 * (1 - 2 * margin) / (high[1] - low[1])  # pixels for a unit
        self.assertLess(scale * (high[0] - low[0]), 240 * (1 - 2 * margin))
        for number, frame in enumerate(frames):
            width, height, values = read_pfm(self.read(f"f-{number:04d}.pfm"))
            dark = [(i % width, i // width) for i in range(width * height) if values[3 * i] < 0.5]
            for a, middle in ((0, width / 2), (1, height / 2)):
                for pick, way in ((min, -1), (max, 1)):
                    expected = middle + scale * (pick(end[a] for end in frame) + way * radius - (low[a] + high[a]) / 2)
                    self.assertAlmostEqual(pick(pixel[a] for pixel in dark) + 0.5, expected - way * 0.5, delta=1.01, msg=f"frame {number}, axis {a}")

    def test_one_camera_and_range_for_all_frames(self):
        self.write("run.dump", dump([[(1, 1, 1), (2, 2, 2)], [(8, 8, 8), (2, 2, 2)]]))
        entry = {"file": "run.dump", "radius": 0.5, "color": {"column": "heat"}}
        self.document_with(entry, camera={"image_width": 24, "fit": "particles"})
        self.succeed("render", "x.json", *SIZE, "--frames", "::", "-o", "f.pfm")
        # The same camera as for both frames at once; the range of both is 0 to 11.
        ranged = dict(entry, color={"column": "heat", "range": [0, 11]})
        for frame in (0, 1):
            both = [dict(ranged, frame=0), dict(ranged, frame=1)]
            self.write("y.json", {"camera": {"image_width": 24, "fit": "particles"}, "particles": both})
            fitted = self.read(f"f-{frame:04d}.pfm")
            _, _, values = read_pfm(fitted)
            _, _, all_values = read_pfm(self.picture("y.json"))
            dark = [i for i, v in enumerate(values) if v < 0.3]
            self.assertTrue(dark)
            self.assertTrue(all(all_values[i] < 0.75 for i in dark), frame)

    def test_turntable(self):
        self.write("a.xyz", ATOMS)
        self.succeed("render", "a.xyz", *SIZE, "--turntable", 4, "-o", "t.pfm")
        self.assertEqual([name for name in self.files() if name.startswith("t-")], [f"t-{i:04d}.pfm" for i in range(4)])
        self.assertEqual(len({self.read(f"t-{i:04d}.pfm") for i in range(4)}), 4)
        self.write("x.json", scene(camera={"lookfrom": [0, 0, 2], "lookat": [0, 0, -1]}))
        self.succeed("render", "x.json", *SIZE, "--turntable", 2, "-o", "u.pfm")
        self.assert_same(self.read("u-0000.pfm"), self.picture("x.json"))

    def test_pdb_and_cif_alike(self):
        atoms = [(" N  ", "N", (1, 2, 3)), (" CA ", "C", (2.4, 2, 3)), (" O  ", "O", (3, 3, 4))]
        self.write("a.pdb", "".join(pdb_line(i, name, "ALA", place, element) for i, (name, element, place) in enumerate(atoms)))
        self.write("a.cif", "data_x\nloop_\n" + "".join(f"_atom_site.{n}\n" for n in (
            "type_symbol", "label_atom_id", "label_comp_id", "auth_asym_id", "Cartn_x", "Cartn_y", "Cartn_z")) +
            "".join(f"{e} {n.strip()} ALA A {x} {y} {z}\n" for n, e, (x, y, z) in atoms))
        self.assert_same(self.picture("a.pdb"), self.picture("a.cif"))

    def test_crystals(self):
        """Rock salt as CIF and as POSCAR is one picture; its cell has four atoms of each kind and 24 bonds, half of them across its sides."""
        places = [(0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0)]
        operations = "".join(f"'{x}+x, {y}+y, {z}+z'\n" for x, y, z in places)
        cell = "".join(f"_cell_length_{edge} 5.64\n" for edge in "abc") + "".join(f"_cell_angle_{angle} 90\n" for angle in ("alpha", "beta", "gamma"))
        sites = "loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n_atom_site_occupancy\n"
        text = "data_salt\n" + cell + "loop_\n_space_group_symop_operation_xyz\n" + operations + sites + "Na1 0 0 0 1.0\nCl1 0.5 0.5 0.5 1.0\n"
        self.write("salt.cif", text)
        chlorine = [tuple((share + 0.5) % 1 for share in place) for place in places]
        rows = "".join("{} {} {}\n".format(*place) for place in places + chlorine)
        head = "salt\n5.64\n1 0 0\n0 1 0\n0 0 1\nNa Cl\n4 4\n"
        self.write("POSCAR", head + "Direct\n" + rows)
        pictures = []
        for name, says in ("salt.cif", "8 particles; 2 sites by 4 symmetry operations; van der Waals radii"), ("POSCAR", "8 particles; van der Waals radii"):
            self.document_with({"file": name, "style": "ball-and-stick", "box": True})
            self.assertIn(says, self.notes(name).replace("\n  ", " "))
            self.assertIn("12 bonds by distance, 12 across the cell not drawn", self.notes("x.json").replace("\n  ", " "))
            self.assertEqual(self.shapes("x.json"), (8, 24))
            pictures.append(self.picture("x.json"))
        self.assertEqual(pictures[0], pictures[1])
        # Two elements at one place: one is drawn.
        self.write("mixed.cif", text.replace("Na1 0 0 0 1.0", "Na1 0 0 0 0.6\nK1 0 0 0 0.4"))
        self.assertIn("8 of 12 particles; hidden: 4 in alternative places", self.notes("mixed.cif").replace("\n  ", " "))
        self.assertEqual(self.picture("mixed.cif"), self.picture("salt.cif"))
        self.fail_with(2, "render", self.write("bare.cif", "data_x\n_space_group_name_H-M_alt 'F m -3 m'\n" + cell + sites + "Na1 0 0 0 1\n"),
                       says=["bare.cif:2", "without its operations", "ASE adds them"])
        self.write("XDATCAR", head + "Direct configuration=     1\n" + rows + "Direct configuration=     2\n" + rows.replace("0 0 0\n", "0.1 0 0\n"))
        self.succeed("render", "XDATCAR", *SIZE, "--frames", "::", "-o", "f.pfm")
        self.assertNotEqual(self.read("f-0000.pfm"), self.read("f-0001.pfm"))

    def test_every_command_takes_particles(self):
        self.write("a.xyz", ATOMS)
        self.succeed("explain", "a.xyz")
        self.succeed("check", "a.xyz", "--width", 16, "--spp", 64, "--margin", 50)


if __name__ == "__main__":
    main()
