#!/usr/bin/env python3
"""What closed forms and symmetry say of pictures of triangles: furnaces, glass that shifts and turns rays, a ball made of
triangles beside a sphere, and pictures that must be the same whatever way a scene is written.

Run as: python3 test_triangle_optics.py PROGRAM SOURCE_DIR
"""

import json
import math
import pathlib
import random
import struct
import subprocess
import tempfile
import unittest

import cli

WHITE = {"background": [1, 1, 1]}
GRADIENT = {"background": {"bottom": [0, 0, 0], "top": [1, 1, 1]}}
EYE = {"lookfrom": [2.5, 2.2, 5], "lookat": [0, 0.5, 0], "vfov": 40}


def matte(*albedo):
    return {"type": "lambertian", "albedo": list(albedo)}


def glass(index=1.5, **members):
    return {"type": "dielectric", "refraction_index": index, **members}


def quad(corner, u, v, material):
    return {"corner": corner, "u": u, "v": v, "material": material}


def triangles(points, faces, material):
    return [{"vertices": [points[i] for i in face], "material": material} for face in faces]


OCTAHEDRON = ([1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1])
OCTANTS = [(x, y, z) if (x + y + z) % 2 == 0 else (x, z, y) for x in (0, 1) for y in (2, 3) for z in (4, 5)]


def turns_outward(a, b, c):
    """Whether three points run counter-clockwise, seen from outside a ball around the origin."""
    return sum(a[i] * (b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2]) for i in range(3)) > 0


def ball(rounds, points=OCTAHEDRON, faces=OCTANTS):
    """Points and faces of a solid, each face in four, `rounds` times, pushed out to the unit sphere; outward."""
    points = list(points)
    for _ in range(rounds):
        middles, finer = {}, []

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                sums = [p + q for p, q in zip(points[a], points[b])]
                length = math.hypot(*sums)
                middles[key] = len(points)
                points.append([s / length for s in sums])
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    return points, faces


def at(points, centre, size=1):
    return [[c + size * p for c, p in zip(centre, point)] for point in points]


class Optics(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def run_ballpark(self, document, command, *arguments):
        (self.path / "s.json").write_text(json.dumps(document))
        made = subprocess.run([cli.PROGRAM, command, "s.json", *arguments], cwd=self.path, capture_output=True, text=True, check=False)
        self.assertEqual(made.returncode, 0, made.stderr)
        return made.stdout

    def scene(self, materials, camera=None, background=None, **members):
        camera = {"image_width": 32, "aspect_ratio": 1, "samples_per_pixel": 4, "max_depth": 10, **(camera or EYE)}
        return {"camera": camera, "materials": materials, **(background or GRADIENT), **members}

    def render(self, document, *options):
        """The pixels, as a list of colours, rows from below, and the invalid samples."""
        self.run_ballpark(document, "render", "-o", "out.pfm", "--stats", "out.json", "--force", "--quiet", *options)
        data = (self.path / "out.pfm").read_bytes()
        _, size, _, rest = data.split(b"\n", 3)
        width, height = map(int, size.split())
        numbers = struct.unpack(f"<{3 * width * height}f", rest)
        self.assertEqual(json.loads((self.path / "out.json").read_text())["invalid_samples"], 0)
        return [numbers[i:i + 3] for i in range(0, len(numbers), 3)]

    def mean(self, document, *options):
        pixels = self.render(document, *options)
        return sum(sum(pixel) for pixel in pixels) / (3 * len(pixels))

    def steps(self, **members):
        """The path of the one ray of a picture of one pixel."""
        camera = {"image_width": 1, "pixel_sampling": "center", "vfov": 1, **members.pop("camera")}
        document = self.scene(members.pop("materials"), camera, **members)
        return json.loads(self.run_ballpark(document, "explain", "--pixel", "0,0", "--json", "-", "--quiet"))["scenes"][0]["path"]["steps"]

    # Furnaces: every sample has the same value, or the samples that the depth cuts off are counted.

    def test_convex_furnace(self):
        """A convex matte body shows its albedo before a white sky, since whatever leaves it meets the sky."""
        for points, faces in (ball(0), ball(2)):
            document = self.scene({"m": matte(0.7, 0.4, 0.2)}, {"lookfrom": [0.3, 0.2, 4], "lookat": [0, 0, 0], "vfov": 8}, WHITE,
                                  triangles=triangles(points, faces, "m"))
            for pixel in self.render(document):
                for value, albedo in zip(pixel, (0.7, 0.4, 0.2)):
                    self.assertAlmostEqual(value, albedo, delta=2e-6)

    def test_closed_room(self):
        """Walls of radiance E and albedo rho, K segments: E (1 - rho^K) / (1 - rho), also among boxes that stand in one plane with the walls."""
        emit, albedo = 0.3, 0.6
        wall = {**matte(albedo, albedo, albedo), "emit": [emit, emit, emit]}
        room = [quad([-2, -2, -2], [0, 0, 4], [0, 4, 0], "w"), quad([2, -2, -2], [0, 4, 0], [0, 0, 4], "w"), quad([-2, -2, -2], [4, 0, 0], [0, 0, 4], "w"),
                quad([-2, 2, -2], [0, 0, 4], [4, 0, 0], "w"), quad([-2, -2, -2], [0, 4, 0], [4, 0, 0], "w"), quad([-2, -2, 2], [4, 0, 0], [0, 4, 0], "w")]
        boxes = [{"corners": [[-2, -2, -2], [-1, 0, -0.5]], "material": "w"}, {"corners": [[-0.5, -2, -1.5], [0.5, 2, -1]], "material": "w"},
                 {"corners": [[0.8, -1.5, -1.2], [1.6, -0.2, 0.1]], "rotate": [20, 30, 40], "material": "w"}]
        for depth in (1, 2, 7, 40):
            document = self.scene({"w": wall}, {"lookfrom": [0.3, 0.2, 1.7], "lookat": [0, 0, 0], "vfov": 100, "max_depth": depth}, {"background": [9, 0, 0]},
                                  quads=room, boxes=boxes)
            expected = emit * (1 - albedo ** depth) / (1 - albedo)
            # Roulette keeps the mean, and not the value of every path.
            for pixel in self.render(document, "--light-sampling", "off", "--roulette", "off"):
                for value in pixel:
                    self.assertAlmostEqual(value, expected, delta=4e-6 * expected)
            if depth in (2, 7):  # with rays to the walls, it is the mean that is exact
                sampled = self.mean(document, "--spp", "4096")
                self.assertNotEqual(sampled, expected)
                self.assertAlmostEqual(sampled / expected, 1, delta=5e-4, msg=f"depth {depth}")

    def test_glass_furnace(self):
        """Glass takes no light: every path that ends brings 1, and a box keeps none."""
        for boxes, solid in (([{"corners": [[-1, -0.5, -0.7], [1, 0.6, 0.8]], "rotate": [10, 20, 30], "material": "g"}], []),
                             ([], triangles(*ball(1), "g"))):
            document = self.scene({"g": glass()}, {"lookfrom": [0.3, 0.2, 4], "lookat": [0, 0, 0], "vfov": 30, "max_depth": 400}, WHITE, boxes=boxes, triangles=solid)
            pixels = self.render(document, "--spp", "16")
            cut = json.loads((self.path / "out.json").read_text())["cut_paths"]
            missing = 1 - sum(sum(pixel) for pixel in pixels) / (3 * len(pixels))
            self.assertAlmostEqual(missing, cut / (16 * len(pixels)), delta=1e-6)
            self.assertEqual(cut if boxes else 0, 0)

    # Glass and mirrors, by the path of one ray.

    def test_slab(self):
        """A slab of thickness 1 and index 1.5 at 45 degrees shifts a ray by 0.329142 and does not turn it."""
        steps = self.steps(camera={"lookfrom": [0, 0, 5], "lookat": [0, 0, 0]}, materials={"g": glass(fresnel="none")},
                           boxes=[{"corners": [[-3, -3, -0.5], [3, 3, 0.5]], "rotate": [0, 45, 0], "material": "g"}])
        sine = math.sin(math.radians(45))
        shift = sine * (1 - math.cos(math.radians(45)) / math.sqrt(1.5 ** 2 - sine ** 2))
        self.assertAlmostEqual(shift, 0.329142, delta=5e-7)
        self.assertEqual(len(steps), 3)
        self.assertAlmostEqual(abs(steps[2]["origin"][0]), shift, delta=1e-6)
        for got, expected in zip(steps[2]["direction"], (0, 0, -1)):
            self.assertAlmostEqual(got, expected, delta=1e-6)

    def test_corner_reflector(self):
        """Three mirrors at right angles send a ray back by its own direction."""
        sides = [quad([0, 0, 0], u, v, "m") for u, v in (([4, 0, 0], [0, 4, 0]), ([0, 4, 0], [0, 0, 4]), ([0, 0, 4], [4, 0, 0]))]
        steps = self.steps(camera={"lookfrom": [3, 2.5, 2], "lookat": [0.4, 0.3, 0]}, materials={"m": {"type": "metal", "albedo": [1, 1, 1]}}, quads=sides)
        self.assertEqual(len(steps), 4)
        for out, back in zip(steps[0]["direction"], steps[3]["direction"]):
            self.assertAlmostEqual(back, -out, delta=1e-6)

    def met(self, steps):
        return [(step["material"], step["enters"]) for step in steps if step["met"]]

    def test_a_millionth_apart(self):
        """Two boxes of glass that are a millionth apart: into one, out of it, into the other, out of it."""
        boxes = [{"corners": [[-1, -1, low], [1, 1, high]], "material": name} for low, high, name in ((1e-6, 1, "near"), (-1, 0, "far"))]
        steps = self.steps(camera={"lookfrom": [0.2, 0.3, 1.5], "lookat": [0.1, 0.1, 0]}, materials={"near": glass(fresnel="none"), "far": glass(fresnel="none")}, boxes=boxes)
        self.assertEqual(self.met(steps), [("near", True), ("near", False), ("far", True), ("far", False)])
        for got, expected in zip(steps[4]["direction"], steps[0]["direction"]):
            self.assertAlmostEqual(got, expected, delta=1e-6)

    # The same scene, written otherwise.

    def solids(self, shift=(0, 0, 0), camera=None, reverse=False, order=None):
        """On a grid of 1/64, so that a shift by whole numbers is exact."""
        def grid(points):
            return [[round(64 * c) / 64 + s for c, s in zip(point, shift)] for point in points]
        points, faces = ball(1)
        solid = triangles(grid(at(points, [0.9, 0.7, 0.2], 0.6)), faces, "mint") + triangles(grid(at(points, [-0.7, 0.6, 0.5], 0.55)), faces, "glass")
        solid += triangles(grid([[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]]), ((0, 1, 2), (0, 2, 3)), "white")
        if reverse:
            solid = [{**one, "vertices": one["vertices"][::-1]} if one["material"] != "glass" else one for one in solid]
        if order is not None:
            random.Random(order).shuffle(solid)
        look = {"lookfrom": [c + s for c, s in zip([2.5, 2.25, 5], shift)], "lookat": [c + s for c, s in zip([0, 0.5, 0], shift)], "vfov": 40, **(camera or {})}
        return self.scene({"mint": matte(0.2, 0.8, 0.5), "white": matte(0.7, 0.7, 0.7), "glass": glass()}, look, triangles=solid)

    def test_moved(self):
        """A million units from the origin, what is exact there gives the same picture."""
        self.assertEqual(self.render(self.solids()), self.render(self.solids((1e6, -2e6, 3e6))))

    def test_order(self):
        """The order of triangles changes no bit."""
        first = self.render(self.solids())
        for order in (1, 2):
            self.assertEqual(self.render(self.solids(order=order)), first)

    def test_winding(self):
        """Matte triangles look alike from both sides."""
        for one, other in zip(self.render(self.solids()), self.render(self.solids(reverse=True))):
            for a, b in zip(one, other):
                self.assertAlmostEqual(a, b, delta=1e-5)

    def test_bubble(self):
        """A mesh of glass that is inside out is its bubble: the index upside down."""
        points, faces = ball(1)
        look = {"lookfrom": [0.4, 0.3, 3], "lookat": [0, 0, 0], "vfov": 45}
        inside_out = self.scene({"g": glass(1.5, fresnel="exact")}, look, triangles=triangles(points, [face[::-1] for face in faces], "g"))
        bubble = self.scene({"g": glass(1 / 1.5, fresnel="exact")}, look, triangles=triangles(points, faces, "g"))
        sphere = self.scene({"g": glass(1.5, fresnel="exact")}, look, triangles=triangles(points, faces, "g"))
        one, other, third = (self.mean(each, "--spp", "64") for each in (inside_out, bubble, sphere))
        self.assertAlmostEqual(one / other, 1, delta=2e-4)
        self.assertGreater(abs(third / other - 1), 1e-3)

    def test_axes(self):
        """Parallel rays along an axis, which meet edges, vertices and planes exactly: the same bits in all forms."""
        boxes = [{"corners": [[-1, -1, -1], [0, 1, 1]], "material": "a"}, {"corners": [[0, -1, -2], [1, 0, 2]], "material": "b"}]
        for eye in ([0, 0, 5], [0, 0, -5], [5, 0, 0], [-5, 0, 0], [0, 5, 0], [0, -5, 0], [3, 3, 0], [3, 3, 3]):
            camera = {"image_width": 9, "projection": "orthographic", "view_height": 4.5, "lookfrom": eye, "lookat": [0, 0, 0], "pixel_sampling": "center",
                      "vup": [0, 0, 1] if eye[0] == 0 and eye[2] == 0 else [0, 1, 0]}
            document = self.scene({"a": {"type": "normals"}, "b": {"type": "metal", "albedo": [0.9, 0.8, 0.7]}}, camera, boxes=boxes,
                                  triangles=triangles(*ball(1), "a"))
            first = self.render(document, "--kernel", "packet")
            for form in ("sample", "pool"):
                self.assertEqual(self.render(document, "--kernel", form), first)

    def test_box_on_floor(self):
        """A matte box in one plane with the floor under it looks as it does a millionth higher."""
        def on(height):
            return self.scene({"m": matte(0.7, 0.6, 0.5)}, EYE, quads=[quad([-5, 0, 5], [10, 0, 0], [0, 0, -10], "m")],
                              boxes=[{"corners": [[-1, height, -0.6], [0.3, 1 + height, 0.7]], "material": "m"}])
        self.assertAlmostEqual(self.mean(on(0), "--spp", "64") / self.mean(on(1e-6), "--spp", "64"), 1, delta=1e-3)

    # Light.

    def test_lamp_in_its_own_plane(self):
        """A lamp gives no light to what lies in its plane, also where they share an edge, and none from its edge on."""
        lamp = {"type": "diffuse_light", "emit": [5, 5, 5]}
        for part in ([quad([-3, 0, 3], [3, 0, 0], [0, 0, -6], "m"), quad([0, 0, 3], [3, 0, 0], [0, 0, -6], "l")],
                     [quad([-3, 0, 3], [3, 0, 0], [0, 0, -6], "m"), quad([1, 0, 3], [3, 0, 0], [0, 0, -6], "l")]):
            look = {"lookfrom": [-1.5, 3, 0], "lookat": [-1.5, 0, 0], "vup": [0, 0, -1], "vfov": 40}
            pixels = self.render(self.scene({"m": matte(0.9, 0.9, 0.9), "l": lamp}, look, {"background": [0, 0, 0]}, quads=part), "--spp", "64")
            self.assertEqual({value for pixel in pixels for value in pixel}, {0.0})
        # A wall that shares an edge with the lamp, whose points there see half of the hemisphere's quarter lit.
        wall = [quad([0, 0, 3], [0, 0, -6], [0, 3, 0], "m"), quad([0, 0, 3], [3, 0, 0], [0, 0, -6], "l")]
        look = {"lookfrom": [3, 1, 0], "lookat": [0, 0, 0], "vfov": 1e-3, "image_width": 3, "pixel_sampling": "center"}
        for pixel in self.render(self.scene({"m": matte(0.9, 0.9, 0.9), "l": lamp}, look, {"background": [0, 0, 0]}, quads=wall), "--spp", "16"):
            self.assertTrue(all(math.isfinite(value) and 0 <= value <= 5 for value in pixel))

    def received(self, lamp, material, camera):
        """What the origin, which faces up, receives from a lamp of radiance 1 and nothing else, as a share of what a sky of 1 would bring."""
        look = {"lookfrom": camera, "lookat": [0, 0, 0], "vfov": 1e-4, "max_depth": 2, "image_width": 16}
        floor = quad([-0.1, 0, 0.1], [0.2, 0, 0], [0, 0, -0.2], "m")
        return self.mean(self.scene({"m": material, "l": {"type": "diffuse_light", "emit": [1, 1, 1]}}, look, {"background": [0, 0, 0]},
                                    triangles=[{"vertices": corners, "material": "l"} for corners in lamp], quads=[floor]), "--spp", "16384")

    @staticmethod
    def form_factor(triangle):
        """From the origin, facing up: the sum over a polygon's edges of their angle and the height of their planes (Lambert, 1760)."""
        total = 0
        for k in range(3):
            a, b = triangle[k], triangle[(k + 1) % 3]
            cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
            total += math.atan2(math.hypot(*cross), sum(p * q for p, q in zip(a, b))) * cross[1] / math.hypot(*cross)
        return abs(total) / (2 * math.pi)

    def test_solid_angles(self):
        """A lobe that scatters alike to all sides of a hemisphere finds a lamp by its solid angle: faces of a cube and of an icosahedron, from their middles."""
        everywhere = {**matte(1, 1, 1), "scatter": "hemisphere"}
        square = [[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]]
        height = (3 + math.sqrt(5)) / (4 * math.sqrt(3))
        face = [[math.cos(turn) / math.sqrt(3), height, math.sin(turn) / math.sqrt(3)] for turn in (0.3, 0.3 + 2 * math.pi / 3, 0.3 + 4 * math.pi / 3)]
        for lamp, value in (([square[:3], [square[0], *square[2:]]], 2.094395), ([square[:3]], 1.047198), ([face], 0.628319)):
            self.assertAlmostEqual(2 * math.pi * self.received(lamp, everywhere, [5, 0.1, 0.2]), value, delta=6e-4)

    def test_square_lamp(self):
        """Of side 1, above the middle at 1 and at 0.1, above a corner at 1, and at 0.01 over the plane in which it stands on its edge."""
        def square(x, y, z):
            return [[[x, y, z], [x + 1, y, z], [x + 1, y, z + 1]], [[x, y, z], [x + 1, y, z + 1], [x, y, z + 1]]]

        upright = [[[-0.5, 0.5, 0.01], [0.5, 0.5, 0.01], [0.5, 1.5, 0.01]], [[-0.5, 0.5, 0.01], [0.5, 1.5, 0.01], [-0.5, 1.5, 0.01]]]
        for lamp, value in ((square(-0.5, 1, -0.5), 0.239456), (square(-0.5, 0.1, -0.5), 0.968340), (square(0, 1, 0), 0.138532), (upright, None)):
            expected = sum(self.form_factor(part) for part in lamp)
            if value is not None:
                self.assertAlmostEqual(expected, value, delta=1e-6)
            self.assertAlmostEqual(self.received(lamp, matte(1, 1, 1), [4, 0.05, 0.1]), expected, delta=3e-4)

    def test_cornell_floor(self):
        """The middle of the floor of the Cornell box, by the light alone."""
        light = quad([343, 554, 332], [-130, 0, 0], [0, 0, -105], "l")
        floor = quad([0, 0, 0], [555, 0, 0], [0, 0, 555], "m")
        look = {"lookfrom": [278, 278, -800], "lookat": [277.5, 0, 277.5], "vfov": 1e-4, "max_depth": 2, "image_width": 64}
        mean = self.mean(self.scene({"m": matte(0.73, 0.73, 0.73), "l": {"type": "diffuse_light", "emit": [15, 15, 15]}}, look, {"background": [0, 0, 0]},
                                    quads=[floor, light]), "--spp", "2048")
        self.assertAlmostEqual(mean, 0.152701, delta=1e-3)

    def test_touching_ball(self):
        """A ball that stands on a triangle: into the ball, out of it at the point that they share, and then the triangle."""
        for name, index in (("air", 1), ("g", 1.5)):
            steps = self.steps(camera={"lookfrom": [0, 5, 0], "lookat": [0, 0, 0], "vup": [0, 0, 1]}, materials={name: glass(index, fresnel="none"), "m": matte(0.5, 0.5, 0.5)},
                               spheres=[{"center": [0, 1, 0], "radius": 1, "material": name}], quads=[quad([-3, 0, 3], [6, 0, 0], [0, 0, -6], "m")])
            self.assertEqual(self.met(steps)[:3], [(name, True), (name, False), ("m", True)])
            self.assertEqual([step["origin"][1] for step in steps[:2]], [5, 2])
        # What shines there is seen through the ball, in all forms of the kernel.
        shining = self.scene({"air": glass(1, fresnel="none"), "l": {"type": "diffuse_light", "emit": [0.25, 0.5, 1]}},
                             {"lookfrom": [0, 5, 0], "lookat": [0, 0, 0], "vup": [0, 0, 1], "image_width": 1, "pixel_sampling": "center"}, WHITE,
                             spheres=[{"center": [0, 1, 0], "radius": 1, "material": "air"}], quads=[quad([-3, 0, 3], [6, 0, 0], [0, 0, -6], "l")])
        for options in (("--kernel", "packet"), ("--kernel", "sample"), ("--kernel", "pool"), ("--precision", "double")):
            self.assertEqual(self.render(shining, "--spp", "1", *options), [(0.25, 0.5, 1)], options)

    def test_ball_of_glass(self):
        """A ball of many triangles is the sphere: their means differ by less than 0.1 %."""
        look = {"lookfrom": [0.4, 0.3, 3], "lookat": [0, 0, 0], "vfov": 50, "max_depth": 30}
        materials = {"g": glass(1.5, fresnel="exact")}
        points, faces = ball(7)
        mesh = self.mean(self.scene(materials, look, triangles=triangles(points, faces, "g")), "--spp", "256")
        sphere = self.mean(self.scene(materials, look, spheres=[{"center": [0, 0, 0], "radius": 1, "material": "g"}]), "--spp", "256")
        coarse = self.mean(self.scene(materials, look, triangles=triangles(*ball(0), "g")), "--spp", "256")
        self.assertAlmostEqual(mesh / sphere, 1, delta=1e-3)
        self.assertGreater(abs(coarse / sphere - 1), 2e-3)

    def test_large_ball_of_glass(self):
        """The same of 1.3 million triangles, from a file."""
        golden = (1 + math.sqrt(5)) / 2
        corners = [[0, x, z] for x in (-1, 1) for z in (-golden, golden)]
        corners = [[corner[(axis + k) % 3] / math.hypot(1, golden) for k in range(3)] for axis in range(3) for corner in corners]

        def near(a, b):
            return math.dist(corners[a], corners[b]) < 1.1

        sides = [(a, b, c) for a in range(12) for b in range(a) for c in range(b) if near(a, b) and near(b, c) and near(c, a)]
        outward = [side if turns_outward(*(corners[k] for k in side)) else side[::-1] for side in sides]
        points, faces = ball(8, corners, outward)
        self.assertEqual(len(faces), 1310720)
        head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n"
                f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        rows = b"".join(struct.pack("<B3i", 3, *face) for face in faces)
        (self.path / "ball.ply").write_bytes(head.encode() + b"".join(struct.pack("<3f", *point) for point in points) + rows)
        look = {"lookfrom": [0.4, 0.3, 3], "lookat": [0, 0, 0], "vfov": 50, "max_depth": 30}
        materials = {"g": glass(1.5, fresnel="exact")}
        mesh = self.mean(self.scene(materials, look, meshes=[{"file": "ball.ply", "material": "g"}]), "--spp", "256")
        sphere = self.mean(self.scene(materials, look, spheres=[{"center": [0, 0, 0], "radius": 1, "material": "g"}]), "--spp", "256")
        self.assertAlmostEqual(mesh / sphere, 1, delta=1e-3)


if __name__ == "__main__":
    cli.main()
