"""Triangles, quads and boxes: what the kernels make of them, and what is refused.

Every form of the kernel gives the same picture, bit for bit; pictures agree with the reference, which intersects triangles
by another algorithm; values that optics knows come out; and what triangles cannot do yet is refused, with its place and a
remedy.

Run as: python3 test_triangles.py PROGRAM SOURCE_DIR
"""

import json
import math
import re

import cli
from scene_pictures import ScenePictures

MATERIALS = {
    "white": {"type": "lambertian", "albedo": [0.73, 0.73, 0.73]}, "mint": {"type": "lambertian", "albedo": [0.2, 0.8, 0.5]},
    "glass": {"type": "dielectric", "refraction_index": 1.5}, "air": {"type": "dielectric", "refraction_index": 1}, "frosted": {"type": "dielectric", "refraction_index": 1.5, "roughness": 0.3},
    "mirror": {"type": "metal", "albedo": [0.9, 0.9, 0.9]}, "lamp": {"type": "diffuse_light", "emit": [4, 4, 4]},
    "normals": {"type": "normals"}, "skin": {"type": "interface"},
    "checked": {"type": "lambertian", "albedo": {"texture": "checks"}}, "mapped": {"type": "lambertian", "albedo": {"texture": "map"}}}
FLOOR = {"corner": [-10, 0, 10], "u": [20, 0, 0], "v": [0, 0, -20], "material": "white"}


def scene(**members):
    textures = {"checks": {"type": "checker", "size": 0.3, "colors": [[0.9, 0.9, 0.9], [0.1, 0.1, 0.1]]},
                "map": {"type": "checker", "mapping": "surface", "repeat": [4, 2], "colors": [[0.9, 0.9, 0.9], [0.1, 0.1, 0.1]]}}
    camera = {"image_width": 32, "aspect_ratio": 1.6, "samples_per_pixel": 16, "max_depth": 12, "vfov": 40, "lookfrom": [3, 2, 6], "lookat": [0, 0.5, 0]}
    camera.update(members.pop("camera", {}))
    return {"format": 1, "camera": camera, "textures": textures, "materials": MATERIALS, **members}


MIXED = scene(
    spheres=[{"center": [-1.2, 0.5, 0.3], "radius": 0.5, "material": "mint"}, {"center": [0.3, 0.4, 1.6], "radius": 0.4, "material": "glass"},
             {"center": [0, 3.5, 1], "radius": 0.8, "material": "lamp"}],
    triangles=[{"vertices": [[-0.4, 0, -1.2], [1.6, 0, -1.4], [0.6, 1.8, -1.3]], "material": "mirror"}],
    quads=[{**FLOOR, "material": "checked"}],
    boxes=[{"corners": [[0.9, 0.01, 0], [1.7, 0.81, 0.8]], "rotate": [0, 20, 0], "material": "glass"},
           {"corners": [[-0.6, 0, -0.4], [0.1, 1.2, 0.3]], "rotate": [0, 30, 0], "material": "mint"}])
ALONE = scene(quads=[FLOOR, {"corner": [-1.5, 0.2, -1], "u": [3, 0, 0], "v": [0, 2, 0.5], "material": "lamp"}],
              boxes=[{"corners": [[0.2, 0.01, 0], [1.2, 0.8, 0.8]], "rotate": [10, 20, 30], "translate": [0, 0.6, 0], "material": "glass"},
                     {"corners": [[-1, 0, 0], [-0.2, 0.8, 0.8]], "material": "mirror"}])


class Triangles(ScenePictures):
    def test_forms(self):
        for document in (MIXED, ALONE):
            first, *_ = self.render(document, "--kernel", "packet")
            for options in (("--kernel", "sample"), ("--kernel", "pool"), ("--kernel", "packet", "--effects", "all")):
                self.assertEqual(self.render(document, *options)[0], first, f"{options}: other bits")

    def test_reference(self):
        """At once: brightness and colour of every block, and path lengths."""
        for document in (MIXED, ALONE):
            made = self.run_ballpark(document, "check", "--spp", "2048")
            self.assertEqual(made.returncode, 0, made.stdout + made.stderr)

    def centre(self, document):
        _, width, height, pixels = self.render(document, "--spp", "1")
        place = 3 * (height // 2 * width + width // 2)
        return pixels[place:place + 3]

    def test_index_one(self):
        """Glass of the air's index is not there."""
        looking = {"camera": {"lookfrom": [0.3, 0.4, 5], "lookat": [0, 0.5, 0], "pixel_sampling": "center"}}
        box = {"corners": [[-1, 0.05, -1], [1, 1.5, 1]], "rotate": [0, 25, 0], "material": "air"}
        with_box = self.render(scene(**looking, quads=[{**FLOOR, "material": "normals"}], boxes=[box]), "--spp", "1")
        without = self.render(scene(**looking, quads=[{**FLOOR, "material": "normals"}]), "--spp", "1")
        self.assertLess(max(abs(a - b) for a, b in zip(with_box[3], without[3])), 1e-6)

    def test_prism(self):
        """A ray straight through a prism of 60 degrees is turned by 37.1808 degrees (index 1.5, symmetric passage)."""
        half, top = 1.0, math.sqrt(3)
        front, back = [[-half, 0, 1], [half, 0, 1], [0, top, 1]], [[-half, 0, -1], [half, 0, -1], [0, top, -1]]
        faces = [(front[0], front[1], front[2]), (back[0], back[2], back[1])]
        for i in range(3):
            a, b, c, d = front[i], front[(i + 1) % 3], back[(i + 1) % 3], back[i]
            faces += [(a, d, c), (a, c, b)]
        inward = math.asin(1.5 * math.sin(math.radians(30)))  # the angle to the normal outside
        tilt = inward - math.radians(30)                      # of the ray over the horizontal: it rises towards the left face
        turned = 2 * inward - math.radians(60)
        self.assertAlmostEqual(math.degrees(turned), 37.1808, places=4)
        middle = [-half / 2, top / 2, 0]
        camera = [middle[0] - 3 * math.cos(tilt), middle[1] - 3 * math.sin(tilt), 0]
        glass = dict(MATERIALS["glass"], fresnel="none")
        # What is met beyond is the sky, whose gradient is linear in the height of the direction: 0 below, 1 above.
        document = scene(camera={"lookfrom": camera, "lookat": middle, "vfov": 0.001, "image_width": 3, "aspect_ratio": 1,
                                 "pixel_sampling": "center"},
                         background={"bottom": [0, 0, 0], "top": [1, 1, 1]},
                         triangles=[{"vertices": list(face), "material": "glass"} for face in faces])
        document["materials"] = {**MATERIALS, "glass": glass}
        height = 2 * self.centre(document)[1] - 1
        self.assertAlmostEqual(math.degrees(math.asin(height)), math.degrees(tilt - turned), places=3)

    def test_three_mirrors(self):
        """A corner of three mirrors sends every ray back along its direction."""
        sides = [{"corner": [0, 0, 0], "u": u, "v": v, "material": "mirror"}
                 for u, v in (([4, 0, 0], [0, 4, 0]), ([0, 4, 0], [0, 0, 4]), ([0, 0, 4], [4, 0, 0]))]
        _, _, _, pixels = self.render(scene(camera={"lookfrom": [3, 2.5, 2], "lookat": [0.4, 0.4, 0.4], "vfov": 5, "pixel_sampling": "center"}, quads=sides,
                                            background={"bottom": [0, 0, 0], "top": [1, 1, 1]}), "--spp", "1")
        _, _, _, straight = self.render(scene(camera={"lookfrom": [0.4, 0.4, 0.4], "lookat": [3, 2.5, 2], "vfov": 5, "pixel_sampling": "center"},
                                              background={"bottom": [0, 0, 0], "top": [1, 1, 1]}), "--spp", "1")
        middle = 3 * (10 * 32 + 16)
        self.assertAlmostEqual(pixels[middle], 0.9 ** 3 * straight[middle], places=2)

    def seen(self, **members):
        """What a ray along -z meets, that is exactly at x = y = 0: the colour of a lamp."""
        lamps = {name: {"type": "diffuse_light", "emit": emit} for name, emit in (("red", [1, 0, 0]), ("green", [0, 1, 0]))}
        document = scene(camera={"lookfrom": [0, 0, 5], "lookat": [0, 0, 0], "vfov": 90, "image_width": 1, "aspect_ratio": 1,
                                 "pixel_sampling": "center"}, background=[0, 0, 1], **members)
        document["materials"] = lamps
        return self.centre(document)

    def test_exactly_on_an_edge(self):
        """What two or more triangles share belongs to them all: the diagonal of a quad, and the tip of a pyramid."""
        quad = {"corner": [-1, -1, 0], "u": [2, 0, 0], "v": [0, 2, 0], "material": "red"}
        self.assertEqual(self.seen(quads=[quad]), (1, 0, 0))
        base = [[1, 1, -1], [-1, 1, -1], [-1, -1, -1], [1, -1, -1]]
        sides = [{"vertices": [base[i], base[(i + 1) % 4], [0, 0, 1]], "material": "red"} for i in range(4)]
        self.assertEqual(self.seen(triangles=sides), (1, 0, 0))
        self.assertEqual(self.seen(triangles=[{"vertices": [[0, 0, 0], [1, 0.5, 0], [0.5, 1, 0]], "material": "green"}]), (0, 1, 0))

    def test_first_of_two(self):
        """Of two at one distance the earlier in the scene is met."""
        red, green = ({"vertices": [[-1, -1, 0], [2, -1, 0], [-1, 2, 0]], "material": name} for name in ("red", "green"))
        self.assertEqual(self.seen(triangles=[red, green]), (1, 0, 0))
        self.assertEqual(self.seen(triangles=[green, red]), (0, 1, 0))

    def places(self, **members):
        """The vertices of each triangle, as the program writes the scene."""
        return [triangle["vertices"] for triangle in json.loads(self.run_ballpark(scene(**members), "scene").stdout)["triangles"]]

    def test_places_of_quads(self):
        self.assertEqual(self.places(quads=[{"corner": [1, 2, 3], "u": [2, 0, 1], "v": [0, 4, 1], "material": "white"}]),
                         [[[1, 2, 3], [3, 2, 4], [3, 6, 5]], [[1, 2, 3], [3, 6, 5], [1, 6, 4]]])

    def test_places_of_boxes(self):
        """Turned about x, then y, then z, counter-clockwise seen from the axis's end, then moved."""
        box = {"corners": [[2, 2, 3], [1, 4, 6]], "rotate": [90, 90, 0], "translate": [10, 20, 30], "material": "white"}
        found = self.places(boxes=[box])
        # About x, (x, y, z) becomes (x, -z, y); about y, that becomes (y, -z, -x).
        expected = {(y + 10, 20 - z, 30 - x) for x in (1, 2) for y in (2, 4) for z in (3, 6)}
        self.assertEqual({tuple(vertex) for triangle in found for vertex in triangle}, expected)
        middle = [13, 15.5, 28.5]
        area = volume = 0
        for a, b, c in found:
            u, v, way = ([q - p for p, q in zip(a, other)] for other in (b, c, middle))
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            self.assertLess(sum(p * q for p, q in zip(normal, way)), 0, "the normal points inward")
            area += math.hypot(*normal) / 2
            volume -= sum(p * q for p, q in zip(normal, way)) / 6
        self.assertAlmostEqual(area, 2 * (1 * 2 + 2 * 3 + 3 * 1))
        self.assertAlmostEqual(volume, 6)

    def test_written_again(self):
        first = self.run_ballpark(MIXED, "scene").stdout
        again = self.run_ballpark(json.loads(first), "scene").stdout
        self.assertEqual(first, again)
        self.assertEqual(len(json.loads(first)["triangles"]), 1 + 2 + 24)

    def refused(self, says, **members):
        made = self.run_ballpark(scene(**members), "render", "-o", "out.png", "--force")
        self.assertEqual(made.returncode, 2, made.stderr)
        said = re.sub(r"\s+", " ", made.stderr)
        for text in says:
            self.assertIn(text, said)

    def test_rays_to_triangles_are_named(self):
        lamp = {"corner": [-1, 3, 1], "u": [2, 0, 0], "v": [0, 0, -2], "material": "lamp"}
        told = self.run_ballpark(scene(quads=[FLOOR, lamp]), "explain", "--pixel", "16,17", "--wide").stdout
        self.assertRegex(told, r"a ray to quads\[1\] brings \(")

    def test_where_light_may_be_left_to_chance(self):
        """A pilot looks for it there, and nowhere else."""
        ball = {"center": [0.3, 0.4, 1.6], "radius": 0.4, "material": "glass"}
        lamp = {"center": [0, 3.5, 1], "radius": 0.01, "material": "lamp"}
        mirror = {"corner": [-2, 0, -3], "u": [4, 0, 0], "v": [0, 3, 0], "material": "mirror"}
        shining = {**mirror, "material": "lamp"}
        for members, by_triangles in (({"spheres": [ball, lamp], "quads": [FLOOR]}, 0), ({"spheres": [lamp], "quads": [FLOOR, mirror]}, 1),
                                      ({"quads": [FLOOR, shining]}, None), ({"quads": [FLOOR, mirror, {**mirror, "corner": [-2, 0, 9], "material": "lamp"}]}, 1),
                                      ({"spheres": [ball], "quads": [FLOOR]}, None),
                                      ({"quads": [FLOOR, mirror]}, None)):
            made = self.run_ballpark(scene(**members), "render", "--spp", "2", "-o", "p.pfm", "--stats", "p.json")
            self.assertEqual(made.returncode, 0, made.stderr)
            unseen = json.loads((self.path / "p.json").read_text())["unseen"]
            self.assertEqual(unseen is not None, by_triangles is not None, (members, unseen))
            if unseen is not None:
                self.assertGreater(unseen["variance"], 0)
                self.assertEqual(unseen["triangles"] > 0.5, by_triangles == 1, unseen)

    def test_refusals(self):
        triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
        quad = {"corner": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0]}
        box = {"corners": [[0, 0, 0], [1, 1, 1]], "material": "glass"}
        self.refused(["triangles[0].vertices", "without an area"], triangles=[{"vertices": [[0, 0, 0], [1, 1, 1], [2, 2, 2]], "material": "white"}])
        self.refused(["triangles[0].vertices", "three points"], triangles=[{"vertices": triangle[:2], "material": "white"}])
        self.refused(["triangles[0].material", "gold"], triangles=[{"vertices": triangle, "material": "gold"}])
        self.refused(["triangles[0].interior", 'found the medium "fog"'], triangles=[{"vertices": triangle, "material": "white", "interior": "fog"}])
        self.refused(["-1e9 to 1e9", "larger unit"], triangles=[{"vertices": [[0, 0, 0], [2e9, 0, 0], [0, 1, 0]], "material": "white"}])
        self.refused(["quads[0].material", "open edge", "use a box"], quads=[{**quad, "material": "glass"}])
        self.refused(["quads[0].material", "open edge", "use a box"], quads=[{**quad, "material": "frosted"}])
        self.refused(["boxes[1]", "boxes[0] and boxes[1] in one plane"],
                     boxes=[{**box, "material": "frosted"}, {"corners": [[1, 0, 0], [2, 1, 1]], "material": "white"}])
        self.refused(["quads[0].material", "open edge", "use a box"], quads=[{**quad, "material": "skin"}])
        self.refused(["triangles[0].material", "no texture coordinates", "solid"], triangles=[{"vertices": triangle, "material": "mapped"}])
        self.refused(["boxes[1]", "boxes[0] and boxes[1] in one plane", "millionth"],
                     boxes=[box, {"corners": [[1, 0, 0], [2, 1, 1]], "material": "glass"}])
        self.refused(["quads[0] and boxes[0] in one plane"], quads=[FLOOR], boxes=[box])
        self.refused(["lookfrom of the camera on quads[0]"], quads=[FLOOR], camera={"lookfrom": [1, 0, 1], "lookat": [0, 1, 0]})


if __name__ == "__main__":
    cli.main()
