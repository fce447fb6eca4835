"""GSD files, value by value, beside the package gsd; names of any length and shapes of particles in all formats.

Run as: python3 test_gsd_files.py particle_summary
BALLPARK_READERS_PYTHON: as in test_particle_files.py.
"""
import json
import math
import os
import subprocess
import sys
import unittest

import test_particle_files as files
from test_particle_files import floats, gsd_file, whole

LONG = "a_name_that_is_longer_than_any_buffer_of_its_reader_" * 4


def texts(*values, width=0):
    """A chunk of texts, each ended by a byte of value 0."""
    size = max([width] + [len(v) + 1 for v in values])
    return 5, size, len(values), b"".join(v.encode().ljust(size, b"\0") for v in values)


def frame(points, **chunks):
    """A frame of particles; `chunks`: of particles, by their names."""
    made = {"configuration/box": floats(1, 20, 20, 20, 0, 0, 0), "particles/N": whole(1, len(points)),
            "particles/position": floats(3, *sum(points, []))}
    made.update({f"particles/{name}": chunk for name, chunk in chunks.items()})
    return made


class ValuesTest(files.FileTest):
    def values(self, name, content, number=0, column=""):
        return self.of(name, content, number, column, "values")


class Shapes(ValuesTest):
    POINTS = [[0, 0, 0], [4, 0, 0], [0, 5, 0]]

    def gsd(self, *shapes, typeid=(0, 1, 1), **chunks):
        kinds = [chr(ord("A") + i) for i in range(len(shapes))]
        return gsd_file([frame(self.POINTS, types=texts(*kinds), typeid=whole(1, *typeid),
                               type_shapes=texts(*(s if isinstance(s, str) else json.dumps(s) for s in shapes)), **chunks)])

    def test_spheres(self):
        small, big = {"type": "Sphere", "diameter": 0.5}, {"type": "Sphere", "diameter": 3}
        s = self.values("a.gsd", self.gsd(small, big), 0, "diameter")
        self.assertEqual((s["radii"], s["values"], s["notes"]), ([0.25, 1.5, 1.5], [0.5, 3, 3], ""))
        # The diameters of the particles go before, and what has no shape keeps the default.
        s = self.values("a.gsd", self.gsd(small, big, diameter=floats(1, 7, 8, 9)))
        self.assertEqual(s["radii"], [3.5, 4, 4.5])
        s = self.values("a.gsd", self.gsd({}, big))
        self.assertEqual((s["radii"], s["notes"]), ([0.5, 1.5, 1.5], ""))
        # Fewer shapes than types; and frames that inherit them.
        first = frame(self.POINTS, types=texts("A", "B"), typeid=whole(1, 0, 1, 1), type_shapes=texts(json.dumps(big)))
        self.assertEqual(self.values("a.gsd", gsd_file([first, frame(self.POINTS)]), 1)["radii"], [1.5, 0.5, 0.5])

    def test_other_shapes(self):
        """Radii, also beside diameters of particles, which shapes do not go by; and what is a sphere after all."""
        mesh = {"type": "Mesh", "vertices": [[2, 3, 6], [0, 0, 1], [1, 0, 0]], "indices": [[0, 1, 2]]}
        for shape, radius, kind, says in [
                ({"type": "Ellipsoid", "a": 1, "b": 2, "c": 4}, 2, 1, ""),
                ({"type": "Ellipsoid", "a": 3, "b": 3, "c": 3}, 3, 0, ""),
                ({"type": "Ellipsoid", "a": 0, "b": 0, "c": 0}, 0, 0, ""),
                ({"type": "Polygon", "rounding_radius": 0.5, "vertices": [[3, 0], [0, 4], [-1, 0]]}, 4, 2, ""),
                ({"type": "ConvexPolyhedron", "vertices": [[1, 2, 2], [0, 0, 1], [1, 0, 0], [0, 1, 0]]}, 3, 2, ""),
                (mesh, 7, 2, ""), ({"type": "Cone"}, 0.5, 0, "2 other shapes drawn as spheres")]:
            s = self.values("a.gsd", self.gsd({}, shape))
            self.near(s["radii"], [0.5, radius, radius])
            self.assertEqual((s["notes"], [body[0] for body in s.get("bodies", [[0]] * 3)]), (says, [0, kind, kind]))
            if kind > 0:
                s = self.values("a.gsd", self.gsd({}, shape, diameter=floats(1, 7, 8, 9)), 0, "diameter")
                self.near(s["radii"] + s["values"], [3.5, radius, radius, 7, 8, 9])

    def test_orientations(self):
        """w, x, y, z; made of length 1, with a note where they are far from it; frame 0's, and the default."""
        ellipsoid, tiny = {"type": "Ellipsoid", "a": 1, "b": 0.5, "c": 0.25}, math.sqrt(0.5)
        s = self.values("a.gsd", self.gsd(ellipsoid, {}, typeid=(0, 0, 1), orientation=floats(4, tiny, 0, tiny, 0, 1, 2, 4, 10, 1, 1, 1, 1)))
        self.near(s["bodies"][0], [1, 1, 0.5, 0.25, tiny, 0, tiny, 0])
        self.near(s["bodies"][1], [1, 1, 0.5, 0.25, 1 / 11, 2 / 11, 4 / 11, 10 / 11])
        self.assertEqual((s["bodies"][2], s["notes"]), ([0] * 8, "1 quaternion of another length than 1, scaled to it"))
        s = self.values("a.gsd", self.gsd(ellipsoid, {}))
        self.assertEqual((s["bodies"][0][4:], s["notes"]), ([1, 0, 0, 0], ""))
        s = self.values("a.gsd", self.gsd(ellipsoid, {}, orientation=floats(4, *[0] * 4, *[1, 0, 0, 0] * 2)))
        self.assertEqual((s["bodies"][0][4:], s["notes"]), ([1, 0, 0, 0], "1 quaternion without a direction, by which nothing is turned"))
        s = self.values("a.gsd", self.gsd(ellipsoid, {}, orientation=floats(4, math.nan, *[0] * 3, *[1, 0, 0, 0] * 2)))
        self.assertEqual(s["bodies"][0][4:], [1, 0, 0, 0])
        flat = {"type": "Ellipsoid", "a": 4, "b": 0, "c": 2}
        s = self.values("a.gsd", self.gsd({}, flat))
        self.near(s["bodies"][1][1:4] + s["radii"][1:2], [4, 0.2, 2, 1.6 ** (1 / 3)])
        self.assertEqual(s["notes"], "2 ellipsoids with an axis of 0, which became a twentieth of the longest")

    def test_bodies(self):
        """Corners, and faces that are counter-clockwise from outside."""
        cube = [[x, y, z] for x in (-1, 1) for y in (-2, 2) for z in (-3, 3)]
        s = self.values("a.gsd", self.gsd({}, {"type": "ConvexPolyhedron", "rounding_radius": 0.5,
                                               "vertices": cube + [[0, 0, 0], [1, 0, 0], [0, 2, 0.5]]}))
        [shape] = s["shapes"]
        self.assertEqual((shape["kind"], shape["type"], shape["rounding"], len(shape["faces"])), ("polyhedron", "B", 0.5, 12))
        self.near([shape["radius"], self.volume(shape)], [math.sqrt(14), 48])
        self.assertEqual(set(sum(shape["faces"], [])), set(range(8)))
        # A polygon that is not convex, either way around, becomes a prism a tenth as thick as wide.
        arrow = [[3, 0], [-1, 2], [0, 0], [-1, -2]]
        for vertices in (arrow, arrow[::-1]):
            [shape] = self.values("a.gsd", self.gsd({}, {"type": "Polygon", "vertices": vertices}))["shapes"]
            self.assertEqual([len(face) for face in shape["faces"]], [4, 4, 4, 4, 4, 4])
            self.near([self.volume(shape), shape["radius"]], [6 * 0.6, 3])
            self.near([max(v[2] for v in shape["vertices"]), min(v[2] for v in shape["vertices"])], [0.3, -0.3])
        given = {"type": "Mesh", "vertices": cube, "indices": [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]}
        [shape] = self.values("a.gsd", self.gsd({}, given))["shapes"]
        self.assertEqual((shape["faces"], shape["vertices"]), (given["indices"], cube))
        self.near([self.volume(shape)], [48])
        # One corner that is rounded is a sphere beside the centre, and two are a capsule.
        s = self.values("a.gsd", self.gsd({}, {"type": "ConvexPolyhedron", "rounding_radius": 0.5, "vertices": [[0, 0, 3]]}))
        self.assertEqual((s["positions"], s["radii"], s["notes"]), ([[0, 0, 0], [4, 0, 3], [0, 5, 3]], [0.5] * 3, ""))
        s = self.values("a.gsd", self.gsd({}, {"type": "ConvexPolyhedron", "rounding_radius": 0.5, "vertices": [[0, 0, 3], [0, 0, -1]]}))
        self.assertEqual((s["shapes"][0]["capsule"], s["shapes"][0]["kind"], s["radii"][1]), (0.5, "spherocylinder", 3.5))
        first = frame(self.POINTS, types=texts("A", "B"), typeid=whole(1, 0, 1, 1), type_shapes=texts("{}", json.dumps(given)))
        self.assertEqual(self.values("a.gsd", gsd_file([first, frame(self.POINTS)]), 1)["shapes"][0]["faces"], given["indices"])

    @staticmethod
    def volume(shape):
        """By the divergence theorem, faces cut from their first corner."""
        total = 0
        for face in shape["faces"]:
            a = shape["vertices"][face[0]]
            for b, c in zip(face[1:], face[2:]):
                b, c = shape["vertices"][b], shape["vertices"][c]
                total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        return total

    def test_unions(self):
        """Turned by a third of a circle around (1, 1, 1), x becomes y and y becomes z."""
        union = {"type": "SphereUnion", "diameters": [1, 2], "centers": [[2, 0, 0], [0, 3, 0]]}
        turned = self.gsd({"type": "Sphere", "diameter": 4}, union, orientation=floats(4, 1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0.5, 0.5))
        s = self.values("a.gsd", turned)
        for got, wanted in zip(s["positions"], [[0, 0, 0], [6, 0, 0], [4, 3, 0], [0, 7, 0], [0, 5, 3]]):
            self.near(got, wanted)
        self.assertEqual((s["radii"], s["types"]), ([2, 0.5, 1, 0.5, 1], ["A", "B", "B", "B", "B"]))
        self.assertEqual(s["notes"], "2 sphere unions drawn as 4 spheres")
        # A quaternion (w, x, y, z) of a quarter around z, by hand.
        quarter = math.sqrt(0.5)
        s = self.values("a.gsd", self.gsd(union, {}, orientation=floats(4, quarter, 0, 0, quarter, *[1, 0, 0, 0] * 2)))
        self.near(s["positions"][0] + s["positions"][1], [0, 2, 0, -3, 0, 0])
        # Bonds go on between the particles, of which there are now more.
        content = frame(self.POINTS, types=texts("A", "B"), typeid=whole(1, 0, 1, 1), type_shapes=texts(json.dumps(union)))
        content.update({"bonds/N": whole(1, 2), "bonds/group": whole(2, 0, 1, 1, 2)})
        self.assertEqual(self.values("a.gsd", gsd_file([content]))["pairs"], [[0, 2], [2, 3]])
        many = {"type": "SphereUnion", "diameters": [1] * 300, "centers": [[0, 0, i / 100] for i in range(300)]}
        s = self.values("a.gsd", self.gsd({}, many))
        self.near(s["radii"], [0.5, 3.49, 3.49])
        self.assertEqual(s["notes"], "2 sphere unions drawn as spheres")

    def test_wrong_shapes(self):
        for shape, says in [("{", "not JSON"), ("[]", "no object"), ('{"type": "Sphere"}', 'no "diameter"'),
                            ('{"type": "Sphere", "diameter": -1}', 'no "diameter"'), ('{"type": "Sphere", "diameter": "1"}', 'no "diameter"'),
                            ('{"type": "Ellipsoid", "a": 1, "b": 1}', 'no "c"'), ('{"type": "Polygon"}', 'no "vertices"'),
                            ('{"type": "Mesh", "vertices": [[1]]}', "no point at 0"), ("[" * 100000, "not JSON"),
                            ('{"type": "SphereUnion", "diameters": [1], "centers": []}', '0 "centers" and 1 "diameters"')]:
            self.refuse("a.gsd", self.gsd({}, shape), 'particles/type_shapes: shape 1 (from 0), of the type "B"', says)
        for kind, says, members in [
                ("Ellipsoid", 'no "b", expected a number of at least 0', {"a": 1, "b": -1, "c": 1}),
                ("Polygon", "3 \"vertices\" on one line", {"vertices": [[0, 0], [1, 1], [2, 2]]}),
                ("ConvexPolyhedron", "in one plane", {"vertices": [[0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1], [0.5, 0.5, 1]]}),
                ("ConvexPolyhedron", "in one plane", {"vertices": [[0, 0, 1]]}),
                ("ConvexPolyhedron", "in one plane", {"vertices": [[0.1 * i, 0.3 * i, 0.7 * i] for i in range(1)] * 5}),
                ("ConvexPolyhedron", "1025 \"vertices\", expected at most 1024", {"vertices": [[i, i * i, i ** 3] for i in range(1025)]}),
                ("ConvexPolyhedron", "farther away than 1e12", {"vertices": [[1e13, 0, 0]]}),
                ("Mesh", 'no "indices"', {"vertices": [[0, 0, 1]]}),
                ("Mesh", '2 "indices" at face 0', {"vertices": [[0, 0, 1]] * 3, "indices": [[0, 1]]}),
                ("Mesh", "no vertex at corner 2 of face 0", {"vertices": [[0, 0, 1]] * 3, "indices": [[0, 1, 3]]}),
                ("Mesh", "no vertex at corner 0 of face 0", {"vertices": [[0, 0, 1]] * 3, "indices": [[-1, 1, 2]]})]:
            self.refuse("a.gsd", self.gsd({}, dict(members, type=kind)), 'of the type "B"', says)

    def test_columns_of_text_files(self):
        dump = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
                "ITEM: ATOMS id x y z %s\n1 1 1 1 2 4 8\n2 3 3 3 6 6 6\n3 5 5 5 0 0 0\n")
        unturned = "no orientations in the file, so no ellipsoid is turned"
        for names in ("shapex shapey shapez", "c_shape[1] c_shape[2] c_shape[3]", "c_diameter[1] c_diameter[2] c_diameter[3]"):
            s = self.values("a.dump", dump % names)
            self.near(s["radii"][:2], [1.0 * 2, 3])
            self.assertEqual((s["radii"][2], s["notes"]), (None, unturned))
            self.assertEqual(s["bodies"], [[1, 1, 2, 4, 1, 0, 0, 0], [0] * 8, [0] * 8])
        for name in ("aspherical_shape", "shape"):
            s = self.values("a.xyz", f"3\nProperties=pos:R:3:{name}:R:3\n1 1 1 1 2 4\n3 3 3 3 3 3\n5 5 5 2 2 0.25\n")
            self.near(s["radii"], [2, 3, 1])
            self.assertEqual(([body[:4] for body in s["bodies"]], s["notes"]), ([[1, 1, 2, 4], [0] * 4, [1, 2, 2, 0.25]], unturned))
        s = self.values("a.xyz", "2\nProperties=pos:R:3:radius:R:1:shape:R:3\n1 1 1 5 1 2 4\n2 2 2 5 0 0 0\n")
        self.near(s["radii"], [2, 5])

    def test_quaternions_of_text_files(self):
        """Each format has its own order of the components: 2, 3 and 6 of 7 belong to x, y and z."""
        dump = ("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
                "ITEM: ATOMS id x y z shapex shapey shapez %s\n1 1 1 1 2 4 8 %s\n")
        wanted = [0, 2 / 7, 3 / 7, 6 / 7]
        wanted_w = [6 / 7, 2 / 7, 3 / 7, 0]
        for names, words, quaternion, says in [
                ("quatw quati quatj quatk", "0 2 3 6", wanted, ""), ("quatk quatj quatw quati", "0 3 6 2", wanted_w, ""),
                ("c_q[1] c_q[2] c_q[3] c_q[4]", "6 2 3 0", wanted_w, "c_q[1] to [4] read as quatw, quati, quatj and quatk; "),
                ("c_quat[1] c_quat[2] c_quat[3] c_quat[4]", "6 2 3 0", wanted_w,
                 "c_quat[1] to [4] read as quatw, quati, quatj and quatk; "),
                ("c_orient[1] c_orient[2] c_orient[3] c_orient[4]", "2 3 0 6", wanted_w,
                 "c_orient[1] to [4] read as quati, quatj, quatk and quatw; ")]:
            s = self.values("a.dump", dump % (names, words))
            self.near(s["bodies"][0][4:], quaternion)
            self.assertEqual(s["notes"], says + "1 quaternion of another length than 1, scaled to it")
        s = self.values("a.xyz", "1\nProperties=pos:R:3:Aspherical_shape:R:3:orientation:R:4\n0 0 0 1 2 4 2 3 0 6\n")
        self.near(s["bodies"][0][4:], wanted_w)
        for name, content in (("a.dump", dump % ("quatw quati quatj quatk block1 block2", "1 0 0 0 2 8")),
                              ("a.xyz", "1\nProperties=pos:R:3:shape:R:3:orientation:R:4:superquadric_roundness:R:2\n0 0 0 1 2 4 0 0 0 1 1 0.5\n")):
            self.assertEqual(self.values(name, content)["notes"], "1 superellipsoid taken for an ellipsoid")
        # Digits that were cut do not count as another length.
        s = self.values("a.xyz", "1\nProperties=pos:R:3:Aspherical_shape:R:3:orientation:R:4\n0 0 0 1 2 4 0.577 0.577 0 0.577\n")
        self.assertEqual(s["notes"], "")
        self.refuse("a.dump", dump % ("quatw quati quatj quatk", "0 2 x 6"), ":10:", '"x"', "a number of a quaternion")
        self.refuse("a.xyz", "1\nProperties=pos:R:3:Aspherical_shape:R:3:orientation:R:4\n0 0 0 1 2 4 2 3 nan 6\n", ":3:", "of a quaternion")
        self.refuse("a.xyz", "2\nProperties=pos:R:3:Aspherical_shape:R:3\n0 0 0 1 2 4\n0 0 0 1 -2 4\n", ":4:", "particle 1 (from 0)",
                    "a half-axis of -2, expected numbers from 0 to 1e12")
        s = self.values("a.xyz", "1\nProperties=pos:R:3:Aspherical_shape:R:3:orientation:R:4\n0 0 0 1 2 0 0 0 0 1\n")
        self.near(s["bodies"][0][1:4], [1, 2, 0.1])
        self.assertEqual(s["notes"], "1 ellipsoid with an axis of 0, which became a twentieth of the longest")

    def test_axes_that_are_not_read(self):
        """Under other names than those that are read: the spheres are said, unless a column is the radius or the colour."""
        says = '2 particles drawn as spheres, since axes such as "%s" are not read'
        dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS x y z "
        ply = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        rows = [[0, 0, 0, 1, 2, 3], [4, 4, 4, 3, 2, 1]]
        for names in ("Aspherical Shape.X", "AsphericalShape.Y", "AsphericalShape.Z"), ("radius_x", "radius_y", "radius_z"), ("scale_0", "scale_1", "scale_2"), \
                     ("semi_axis_1", "semi_axis_2", "semi_axis_3"):
            table = "x,y,z," + ",".join(names) + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows)
            self.assertIn(says % names[0], self.of("a.csv", table)["notes"])
            self.assertNotIn("sphere", self.of("a.csv", table, 0, names[1])["notes"])
            self.assertNotIn("sphere", self.of("a.csv", table.replace(names[2], "other"))["notes"])
            if " " not in names[0]:
                body = "".join(" ".join(map(str, row)) + "\n" for row in rows)
                self.assertIn(says % names[0], self.of("a.dump", dump + " ".join(names) + "\n" + body)["notes"])
                self.assertIn(says % names[0], self.of("a.ply", ply + "".join(f"property float {n}\n" for n in names) + "end_header\n" + body)["notes"])
        self.assertIn(says % "AsphericalShape_x", self.of("a.xyz", "2\nProperties=species:S:1:pos:R:3:AsphericalShape:R:3\nC 0 0 0 1 2 3\nC 4 4 4 1 2 3\n")["notes"])
        for shape in ("1 1 1", "1 2 3"):
            read = [self.of("a.xyz", f"1\nProperties=species:S:1:pos:R:3:aspherical_shape:R:3\nC 0 0 0 {shape}\n"),
                    self.of("a.dump", dump.replace("\n2\n", "\n1\n") + f"shapex shapey shapez\n0 0 0 {shape}\n")]
            for found in read:
                self.assertNotIn("are not read", found["notes"])


class Boxes(ValuesTest):
    def test_boxes_that_are_none(self):
        for box in ([math.nan, 9, 9, 0, 0, 0], [9, 9, 9, 0, math.nan, 0], [9, 9, math.inf, 0, 0, 0], [9, 9, 9, math.inf, 0, 0]):
            content = frame([[0, 0, 0], [1, 0, 0]])
            content["configuration/box"] = floats(1, *box)
            s = self.values("a.gsd", gsd_file([content]))
            self.assertNotIn("cell", s, box)
            self.assertIn("a cell that is not finite", s["notes"])


class Names(ValuesTest):
    """Two names that differ in their last letter only."""
    PAIR = [LONG + "A", LONG + "B"]

    def test_types(self):
        rows = [f"{name} {i} 0 0" for i, name in enumerate(self.PAIR)]
        dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS type x y z\n"
        for name, content in [("a.xyz", "2\n\n" + "\n".join(rows)), ("a.dump", dump + "\n".join(rows)),
                              ("a.csv", "type x y z\n" + "\n".join(rows)),
                              ("a.gsd", gsd_file([frame([[0, 0, 0], [1, 0, 0]], types=texts(*self.PAIR), typeid=whole(1, 0, 1))]))]:
            self.assertEqual(self.values(name, content)["types"], self.PAIR, name)

    def test_names_of_atoms(self):
        """Names, residues and chains, which are counted where they differ."""
        item = "_atom_site."
        head = "data_x\nloop_\n" + "".join(f"{item}{name}\n" for name in ("label_atom_id", "label_comp_id", "auth_asym_id", "Cartn_x", "Cartn_y", "Cartn_z"))
        for column in range(3):
            rows = []
            for name in self.PAIR:
                words = ["CA", "ALA", "X"]
                words[column] = name
                rows.append(" ".join(words) + " 1 2 3\n")
            self.assertEqual(self.of("a.cif", head + "".join(rows))["names"], 4, column)
        s = self.of("a.xyz", "2\nProperties=species:S:1:pos:R:3:atom_name:S:1:resname:S:1\n" +
                    "".join(f"C 0 0 {i} {name} {name}\n" for i, name in enumerate(self.PAIR)))
        self.assertEqual(s["names"], 3)

    def test_columns(self):
        column = "a_column_whose_name_is_rather_long_"
        text = f"1\nProperties=pos:R:3:{column}1:R:1:{column}2:R:1:{column}3:R:3\n0 0 0 5 6 7 8 9\n"
        for end, value in [("1", 5), ("2", 6), ("3_x", 7), ("3_z", 9)]:
            self.assertEqual(self.of("a.xyz", text, 0, column + end)["column_sum"], value)
        ply = "ply\nformat ascii 1.0\nelement vertex 1\n" + "".join(f"property float {name}\n" for name in ("x", "y", "z", column + "1", column + "2"))
        for end, value in [("1", 5), ("2", 6)]:
            self.assertEqual(self.of("a.ply", ply + "end_header\n0 0 0 5 6\n", 0, column + end)["column_sum"], value)

    def test_limits(self):
        self.assertEqual(self.values("a.xyz", f"1\n\n{'n' * 1023} 0 0 0\n")["types"], ["n" * 1023])
        self.refuse("a.xyz", f"1\n\n{'n' * 1024} 0 0 0\n", ":3:", "name of 1024 bytes", "at most 1023")
        self.refuse("a.csv", f"type x y z\n{'n' * 5000} 0 0 0\n", "name of 5000 bytes")
        rows = "".join(f"{i:01000d} 0 0 {i}\n" for i in range(70000))  # 70 MB of names in a file of 70 MB
        self.refuse("a.xyz", "70000\n\n" + rows, ":65538:", "different names")


class Independent(ValuesTest):
    """What the package gsd wrote and reads, value by value."""

    def test_gsd(self):
        result = subprocess.run([files.READERS_PYTHON, "-B", os.path.join(files.HERE, "independent.py"), "write-gsd", self.folder],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode == 77:
            self.skipTest(f"gsd is not installed for {files.READERS_PYTHON}")
        self.assertEqual(result.returncode, 0, result.stderr)
        frames = json.loads(result.stdout)
        self.assertGreater(len(frames), 8)
        for number, theirs in enumerate(frames):
            path = os.path.join(self.folder, "random.gsd")
            s = self.summary(path, number, "", "values")
            where = f"frame {number}: {theirs['what']}"
            self.assertEqual((s["frames"], s["count"]), (len(frames), len(theirs["positions"])), where)
            for ours, wanted in [(sum(s.get("positions", []), []), sum(theirs["positions"], [])), (s.get("radii", []), theirs["radii"]),
                                 (sum(s["cell"], []), sum(theirs["cell"], [])), (s["origin"], theirs["origin"])]:
                self.assertEqual(len(ours), len(wanted), where)
                for a, b in zip(ours, wanted):
                    self.assertLessEqual(abs(a - b), 1e-6 * (1 + abs(b)), where)
            self.assertEqual((s["types"], s["pairs"], s["flat"]), (theirs["types"], theirs["pairs"], theirs["flat"]), where)
            self.assertEqual(s["periodic"], [True, True, not theirs["flat"]], where)
            for column, wanted in theirs["columns"].items():
                got = self.summary(path, number, column, "values")["values"]
                self.assertEqual(len(got), len(wanted), where)
                for a, b in zip(got, wanted):
                    self.assertLessEqual(abs(a - b), 1e-6 * (1 + abs(b)), (where, column))


if __name__ == "__main__":
    result = unittest.main(argv=[sys.argv[0]] + sys.argv[2:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
