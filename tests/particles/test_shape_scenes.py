"""Particles that are no spheres, through the program: what a picture shows of them, beside geometry.

Run as: PYTHONPATH=tests/support python3 test_shape_scenes.py PROGRAM SOURCE_DIR
"""
import json
import math

import exr
from cli import ProgramTest, main
from test_gsd_files import frame, texts
from test_particle_files import floats, gsd_file
from vectors import cross, dot, unit

# A turn of 100 degrees about (1, 2, 3), and an ellipsoid of which no two axes are alike: no order of axes, sign or
# order of components is like another.
DEGREES, AXIS, AXES, CENTER = 100, (1, 2, 3), (2.0, 1.0, 0.5), (3.0, -1.0, 2.0)
CAMERA = {"image_width": 48, "aspect_ratio": [4, 3], "samples_per_pixel": 1, "vfov": 30, "pixel_sampling": "center",
          "lookfrom": [7, 5, 9], "lookat": list(CENTER), "vup": [0, 0, 1]}
CUBE = [[x, y, z] for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.75, 0.75)]


def turned(v, degrees=DEGREES, axis=AXIS):
    """By Rodrigues' formula, which has no quaternion."""
    k, angle = unit(axis), math.radians(degrees)
    return [math.cos(angle) * x + math.sin(angle) * y + (1 - math.cos(angle)) * dot(k, v) * z for x, y, z in zip(v, cross(k, v), k)]


def quaternion():
    """x, y, z and w, of the half angle."""
    half = math.radians(DEGREES) / 2
    return [math.sin(half) * x for x in unit(AXIS)] + [math.cos(half)]


def dump(columns, *rows, frames=1):
    return "".join(f"ITEM: TIMESTEP\n{f}\nITEM: NUMBER OF ATOMS\n{len(rows)}\nITEM: BOX BOUNDS pp pp pp\n-9 9\n-9 9\n-9 9\n"
                   f"ITEM: ATOMS {columns}\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows) for f in range(frames))


def gsd(shape, points=(CENTER,), turn=None, **chunks):
    x, y, z, w = turn or quaternion()
    return gsd_file([frame([list(p) for p in points], types=texts("A"), type_shapes=texts(json.dumps(shape)),
                           orientation=floats(4, *[w, x, y, z] * len(points)), **chunks)])


class Shapes(ProgramTest):
    def document(self, file, camera=None, particles=(), **members):
        return self.write("x.json", dict({"camera": camera or CAMERA, "particles": [dict({"file": file}, **dict(particles))]}, **members))

    def layers(self, *options):
        self.succeed("render", "x.json", "-o", "x.exr", "-q", *options)
        return exr.read(self.read("x.exr"))

    def note(self, *options):
        return " ".join(self.succeed("scene", "x.json", *options).errors.split())

    def counts(self, name="x.json"):
        self.succeed("explain", name, "--json", "e.json", "-q")
        [found] = json.loads(self.read("e.json"))["scenes"]
        return found["spheres"], found["triangles"], found["capsules"]

    def compare(self, meet, error, normal_error, least=150):
        """Depths and normals of all pixels beside meet(origin, direction): the distance along the ray and the normal,
        or None."""
        width, height, channels = self.layers()
        position = CAMERA["lookfrom"]
        forward = unit([t - p for p, t in zip(position, CAMERA["lookat"])])
        right = unit(cross(forward, CAMERA["vup"]))
        up, half, met, other = cross(right, forward), math.tan(math.radians(CAMERA["vfov"]) / 2), 0, 0
        for pixel in range(width * height):
            x = (2 * (pixel % width + 0.5) / width - 1) * half * width / height
            y = (1 - 2 * (pixel // width + 0.5) / height) * half
            ray = unit([f + x * r + y * u for f, r, u in zip(forward, right, up)])
            expected, depth = meet(position, ray), channels["depth.Z"][pixel]
            if (expected is None) != math.isinf(depth):
                other += 1  # at the edge
                continue
            if expected is None:
                continue
            distance, normal = expected
            slope = max(abs(dot(normal, ray)), 0.02)
            self.assertLessEqual(abs(depth - distance * dot(ray, forward)), error / slope, pixel)
            if slope > 0.3:
                found = [channels[f"normal.{c}"][pixel] for c in "XYZ"]
                self.assertGreater(dot(found, normal), 1 - normal_error ** 2 / 2, (pixel, found, normal))
                met += 1
        self.assertGreater(met, least)
        self.assertLessEqual(other, 6)

    @staticmethod
    def ellipsoid(scale=1.0):
        rows = [turned(row) for row in ([1, 0, 0], [0, 1, 0], [0, 0, 1])]  # the body's axes in the scene

        def meet(origin, ray):
            o = [dot(row, [p - c for p, c in zip(origin, CENTER)]) / (scale * a) for row, a in zip(rows, AXES)]
            d = [dot(row, ray) / (scale * a) for row, a in zip(rows, AXES)]
            a, b, c = dot(d, d), dot(o, d), dot(o, o) - 1
            if b * b - a * c < 0:
                return None
            t = (-b - math.sqrt(b * b - a * c)) / a
            gradient = [(p + t * q) / (scale * axis) for p, q, axis in zip(o, d, AXES)]
            return t, unit([sum(g * row[i] for g, row in zip(gradient, rows)) for i in range(3)])
        return meet

    def ellipsoids(self):
        """The one ellipsoid, in each format."""
        x, y, z, w = quaternion()
        diameters = [2 * a for a in AXES]
        head = "LAMMPS\n\n1 atoms\n1 atom types\n1 ellipsoids\n-9 9 xlo xhi\n-9 9 ylo yhi\n-9 9 zlo zhi\n\nAtoms # ellipsoid\n\n1 1 1 1 "
        words = " ".join(map(str, CENTER))
        return {"e.data": head + words + "\n\nEllipsoids\n\n" + " ".join(map(str, [1, *diameters, w, x, y, z])) + "\n",
                "e.dump": dump("id type x y z shapex shapey shapez quatw quati quatj quatk", [1, 1, *CENTER, *diameters, w, x, y, z]),
                "o.dump": dump("id type x y z c_shape[1] c_shape[2] c_shape[3] c_orient[1] c_orient[2] c_orient[3] c_orient[4]",
                               [1, 1, *CENTER, *diameters, x, y, z, w]),
                "q.dump": dump("id type x y z c_shape[1] c_shape[2] c_shape[3] c_q[1] c_q[2] c_q[3] c_q[4]",
                               [1, 1, *CENTER, *diameters, w, x, y, z]),
                "e.xyz": "1\nProperties=species:S:1:pos:R:3:aspherical_shape:R:3:orientation:R:4\nA " +
                         " ".join(map(str, [*CENTER, *AXES, x, y, z, w])) + "\n",
                "e.gsd": gsd(dict(zip(("type", "a", "b", "c"), ("Ellipsoid", *AXES))))}

    def test_ellipsoids_of_every_format(self):
        for name, content in self.ellipsoids().items():
            self.write(name, content)
            self.document(name)
            self.assertIn("1 ellipsoid of 11,520 triangles each, at most 0.032 % of the axes too large or too small", self.note())
            with self.subTest(name):
                self.compare(self.ellipsoid(), 2 * 0.00033, 0.02)

    def test_radii_scale(self):
        """A radius is that of the sphere of equal volume: 1 for these axes."""
        self.write("e.gsd", self.ellipsoids()["e.gsd"])
        for radius, scale in ((1.3, 1.3), ({"value": "0.6 * radius"}, 0.6)):
            self.document("e.gsd", particles={"radius": radius})
            self.compare(self.ellipsoid(scale), 2 * 0.00033, 0.02, least=50)
        self.document("e.gsd", particles={"style": "ball-and-stick"})
        self.compare(self.ellipsoid(0.28), 2 * 0.00033, 0.02, least=8)

    def test_bodies(self):
        """A box as a hull and as a mesh, and a prism, beside their half-spaces."""
        faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        rectangle = [[-1, -0.75], [1, -0.75], [1, 0.75], [-1, 0.75]]
        for shape, size, note in [({"type": "ConvexPolyhedron", "vertices": CUBE + [[0, 0, 0]]}, (1, 0.5, 0.75), "1 polyhedron"),
                                  ({"type": "Mesh", "vertices": CUBE, "indices": faces}, (1, 0.5, 0.75), "1 mesh"),
                                  ({"type": "Polygon", "vertices": rectangle}, (1, 0.75, 0.125), "1 polygon, a tenth as thick as wide")]:
            self.write("e.gsd", gsd(shape))
            self.document("e.gsd")
            self.assertIn(note, self.note())
            self.assertEqual(self.counts(), (0, 12, 0))
            rows = [turned(row) for row in ([1, 0, 0], [0, 1, 0], [0, 0, 1])]

            def meet(origin, ray):
                o = [dot(row, [p - c for p, c in zip(origin, CENTER)]) for row in rows]
                d = [dot(row, ray) for row in rows]
                sides = sorted(((-math.copysign(size[i], d[i]) - o[i]) / d[i], i) for i in range(3))
                leave = min((math.copysign(size[i], d[i]) - o[i]) / d[i] for i in range(3))
                t, i = sides[-1]
                return (t, [-math.copysign(1, d[i]) * c for c in rows[i]]) if t < leave else None
            self.compare(meet, 1e-5, 1e-3, least=60)

    def test_many_are_coarser(self):
        """As many triangles as memory should hold, and never fewer than look like an ellipsoid."""
        for count, each, error in ((8, 11520, "0.032"), (3000, 500, "0.74"), (30000, 80, "4.6")):
            rows = [[i, 1, i % 50, i // 50 % 50, i // 2500, 0.8, 0.4, 0.2, 1, 0, 0, 0] for i in range(count)]
            self.write("e.dump", dump("id type x y z shapex shapey shapez quatw quati quatj quatk", *rows))
            self.document("e.dump")
            self.assertIn(f"{count:,} ellipsoids of {each:,} triangles each, at most {error} % of", self.note())
            self.assertIn("1 ellipsoid of 11,520 triangles each", self.note("--select", "index == 5"))
        self.assertEqual(self.counts(), (0, 80 * 30000, 0))

    def test_beside_spheres(self):
        """Colours, selections, radii and bonds go particle by particle."""
        rows = [[1, 1, 0, 0, 0, 2, 1, 1, 1, 0, 0, 0], [2, 2, 3, 0, 0, 0, 0, 0, 1, 0, 0, 0], [3, 1, 6, 0, 0, 2, 1, 1, 0.7, 0, 0.7, 0]]
        columns = "id type x y z shapex shapey shapez quatw quati quatj quatk"
        self.write("e.dump", dump(columns, *rows, frames=2))
        self.document("e.dump")
        self.assertEqual(self.counts(), (1, 2 * 11520, 0))
        self.assertIn("3 particles; 1 quaternion of another length than 1, scaled to it; the first of several frames; "
                      "radius 1.5 where the file has none", self.note())
        for options, expected in ((("--select", "type == 1"), "selected 2 of 3 particles; "), (("--select", "index == 1"), "selected 1 of 3")):
            self.assertIn(expected, self.note(*options))
        self.document("e.dump", particles={"shapes": False})
        self.assertEqual(self.counts(), (3, 0, 0))
        self.assertIn("2 ellipsoids drawn as spheres", self.note())
        self.assertIn(b'"shapes": false', self.succeed("scene", "x.json").stdout)
        # Colours by type: the albedo of what is seen in the middle.
        for shown, color in (("index == 0", [0.8, 0.1, 0.1]), ("index == 2", [0.8, 0.1, 0.1]), ("index == 1", [0.1, 0.1, 0.8])):
            self.write("y.json", {"camera": {"image_width": 9, "samples_per_pixel": 1, "fit": "particles", "view": "front"},
                                  "particles": [{"file": "e.dump", "select": shown, "color": {"types": {"1": [0.8, 0.1, 0.1], "2": [0.1, 0.1, 0.8]}}}]})
            self.succeed("render", "y.json", "-o", "y.exr", "-q")
            width, height, channels = exr.read(self.read("y.exr"))
            for c, value in zip("RGB", color):
                self.assertAlmostEqual(channels[f"albedo.{c}"][height // 2 * width + width // 2], value, 6)

    def test_cameras_and_catchers(self):
        """The ellipsoid fills the picture that is fitted to it, in one frame and in a film; a shadow catcher touches it."""
        self.write("e.dump", self.ellipsoids()["e.dump"] * 2)
        size = [math.sqrt(sum((a * turned([float(i == k) for i in range(3)])[c]) ** 2 for k, a in enumerate(AXES))) for c in range(3)]
        for margin in (0, 0.1):
            self.write("x.json", {"camera": {"image_width": 200, "samples_per_pixel": 16, "fit": "particles", "view": "front",
                                             "projection": "orthographic", "margin": margin}, "backdrop": "none",
                                  "particles": [{"file": "e.dump"}], "lighting": "soft", "shadow_catcher": True})
            width, height, channels = self.layers()
            seen = [i for i in range(width * height) if any(channels[f"normal.{c}"][i] != 0 for c in "XYZ")]
            columns, rows = [i % width for i in seen], [i // width for i in seen]
            # Seen from the front, x is to the right and z is up.
            view = max(2 * size[0], 2 * size[2]) / (1 - 2 * margin)
            self.assertLessEqual(abs((max(columns) - min(columns) + 1) / width - 2 * size[0] / view), 0.02)
            self.assertLessEqual(abs((max(rows) - min(rows) + 1) / height - 2 * size[2] / view), 0.02)
        self.succeed("render", "e.dump", "--frames", "::", "--width", 40, "--spp", 1, "-q")
        self.assertEqual(self.read("e-0000.png"), self.read("e-0001.png"))
        # The ground lies under the lowest corner, as one at that height does.
        self.write("b.gsd", gsd({"type": "ConvexPolyhedron", "vertices": CUBE}, turn=[0, 0, 0, 1]))
        pictures = []
        for catcher in (True, {"height": CENTER[2] - 0.75, "up": [0, 0, 1]}, {"height": CENTER[2] - 1, "up": [0, 0, 1]}):
            self.document("b.gsd", backdrop="none", lighting="soft", shadow_catcher=catcher)
            pictures.append(self.layers()[2]["A"])
        self.assert_same(pictures[0], pictures[1])
        self.assert_different(pictures[0], pictures[2])

    def test_capsules(self):
        """Spherocylinders are capsules of the scene, whose ends are turned with the particle."""
        self.write("e.gsd", gsd({"type": "ConvexPolyhedron", "rounding_radius": 0.4, "vertices": [[0, 0, -1], [0, 0, 1]]}))
        self.document("e.gsd")
        self.assertEqual(self.counts(), (0, 0, 1))
        self.assertIn("1 spherocylinder", self.note())
        axis = turned([0, 0, 1])

        def meet(origin, ray):
            o, best = [p - c for p, c in zip(origin, CENTER)], None
            for i in range(-400, 401):  # balls along the axis
                b = dot([p - i / 400 * a for p, a in zip(o, axis)], ray)
                c = sum((p - i / 400 * a) ** 2 for p, a in zip(o, axis)) - 0.16
                if b * b > c and (best is None or -b - math.sqrt(b * b - c) < best[0]):
                    t = -b - math.sqrt(b * b - c)
                    best = t, unit([p + t * d - i / 400 * a for p, d, a in zip(o, ray, axis)])
            return best
        self.compare(meet, 1e-4, 0.02, least=40)

    def test_materials(self):
        """Glass is for what is closed, and the message has the way out."""
        glass = {"materials": {"g": {"type": "dielectric", "refraction_index": 1.5}, "i": {"type": "interface"}}}
        vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
        opened, closed = [[0, 2, 1], [0, 1, 3], [0, 3, 2]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
        for name, shape in (("o.gsd", {"type": "Mesh", "vertices": vertices, "indices": opened}),
                            ("c.gsd", {"type": "Mesh", "vertices": vertices, "indices": closed}),
                            ("e.gsd", dict(zip(("type", "a", "b", "c"), ("Ellipsoid", *AXES)))),
                            ("p.gsd", {"type": "Polygon", "vertices": [v[:2] for v in vertices[:3]]})):
            self.write(name, gsd(shape))
        self.document("o.gsd", particles={"material": "g"}, **glass)
        self.fail_with(2, "render", "x.json", says=['the material "g"', 'on the type "A"', "not closed", '"shapes": false'])
        for name in ("c.gsd", "e.gsd", "p.gsd"):
            self.document(name, particles={"material": "g"}, **glass)
            self.succeed("render", "x.json", "-o", "x.pfm", "-q", "--width", 16)
        # A boundary of nothing is a boundary all the same: nothing is seen.
        self.document("e.gsd", particles={"material": "i"}, **glass)
        self.succeed("render", "x.json", "-o", "x.pfm", "-q", "--width", 16)

    def test_refused(self):
        self.write("e.gsd", gsd({"type": "Polygon", "vertices": [[0, 0], [3, 3], [3, 0], [0, 2]]}))
        self.fail_with(2, "render", "e.gsd", says=['the shape of the type "A": face 0', "crosses itself"])
        self.write("e.gsd", gsd({"type": "Mesh", "vertices": [[0, 0, 0], [1, 1, 1], [2, 2, 2]], "indices": [[0, 1, 2]]}))
        self.fail_with(2, "render", "e.gsd", says=['the shape of the type "A"', "no face with an area"])
        # Too small, too flat or too far away for triangles: spheres, with the reason.
        columns = "id type x y z shapex shapey shapez quatw quati quatj quatk"
        for place, axes in (((0, 0, 0), (2e-8, 1e-8, 1e-8)), ((0, 0, 0), (1, 1, 1e-5)), ((2e9, 0, 0), (2, 1, 1))):
            self.write("e.dump", dump(columns, [1, 1, *place, *axes, 1, 0, 0, 0]))
            self.document("e.dump")
            self.assertIn("1 ellipsoid drawn as a sphere, since triangles cannot be so small, flat or far away", self.note())
            self.assertEqual(self.counts(), (1, 0, 0))
        self.document("e.dump", particles={"shapes": "no"})
        self.fail_with(2, "scene", "x.json", says=["x.json:", "particles[0].shapes", "true or false"])


if __name__ == "__main__":
    main()
