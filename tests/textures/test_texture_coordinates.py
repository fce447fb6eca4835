"""Textures on triangles, by the coordinates at their vertices: every pixel against the value that the definitions of scenes/README.md
give at the point that its ray meets, computed here in double.

In:    lamps whose light is an image or a checker, so a picture shows its values.   Knows: the program's documents and pictures.
"""
import importlib.machinery
import importlib.util
import json
import math
import os
import random

from cli import SOURCE, ProgramTest, deep, main
from pfm import read_pfm
from vectors import cross, dot, unit

loader = importlib.machinery.SourceFileLoader("images", os.path.join(SOURCE, "scripts/images"))
images = importlib.util.module_from_spec(importlib.util.spec_from_loader("images", loader))
loader.exec_module(images)

WIDTH, HEIGHT = 7, 5
COLORS = [[0.25, 0.5, 1], [2, 3, 4]]


def texel(x, y):
    """Of the image, counted from its upper left corner."""
    return [1 + (37 * x + 91 * y + 53 * c + 7 * x * y) % 256 / 64 for c in range(3)]


def way(a, b):
    return [y - x for x, y in zip(a, b)]


def picture_of(u, v, repeat=(1, 1), clamped=False):
    """The image's value at a place, by how near the middles of the four texels around it are."""
    x, y = u * repeat[0] * WIDTH - 0.5, (1 - v) * repeat[1] * HEIGHT - 0.5
    value = [0.0, 0.0, 0.0]
    for i in (math.floor(x), math.floor(x) + 1):
        for j in (math.floor(y), math.floor(y) + 1):
            near = (1 - abs(i - x)) * (1 - abs(j - y))
            place = (min(max(i, 0), WIDTH - 1), min(max(j, 0), HEIGHT - 1)) if clamped else (i % WIDTH, j % HEIGHT)
            value = [sum_ + near * part for sum_, part in zip(value, texel(*place))]
    return value


def field_of(u, v, repeat):
    return COLORS[(math.floor(2 * repeat[0] * u) + math.floor(2 * repeat[1] * v)) % 2]


class Coordinates(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("t.pfm", images.pfm(WIDTH, HEIGHT, texel))

    def document(self, camera, texture=None, **shapes):
        texture = {"type": "image", "file": "t.pfm"} if texture is None else texture
        return {"camera": {"pixel_sampling": "center", "samples_per_pixel": 1, "max_depth": 2, **camera}, "background": [0, 0, 0],
                "textures": {"t": texture}, "materials": {"m": {"type": "diffuse_light", "emit": {"texture": "t"}}}, **shapes}

    def render(self, document, *options):
        """Rows from above, of colours."""
        self.write("s.json", document)
        width, height, numbers = read_pfm(self.succeed("render", "s.json", "-o", "-", "--format", "pfm", "-q", *options).stdout)
        rows = [[numbers[3 * (y * width + x):3 * (y * width + x) + 3] for x in range(width)] for y in range(height)]
        return rows[::-1]

    def rays(self, camera):
        """From lookfrom, through the middles of pixels, as the book's camera has them."""
        width, height = camera["image_width"], camera["image_height"]
        back = unit(way(camera["lookat"], camera["lookfrom"]))
        right = unit(cross(camera.get("vup", [0, 1, 0]), back))
        up = cross(back, right)
        side = 2 * math.tan(math.radians(camera["vfov"]) / 2) / height
        for y in range(height):
            for x in range(width):
                across, upwards = ((x + 0.5) - width / 2) * side, (height / 2 - (y + 0.5)) * side
                yield x, y, [across * r + upwards * u - b for r, u, b in zip(right, up, back)]

    def meet(self, origin, direction, corners):
        """The shares of the vertices, or None where the triangle is missed or nearly so."""
        a, b, c = corners
        one, two, from_a = way(a, b), way(a, c), way(a, origin)
        p, q = cross(direction, two), cross(from_a, one)
        whole = dot(one, p)
        of_b, of_c = dot(from_a, p) / whole, dot(direction, q) / whole
        shares = [1 - of_b - of_c, of_b, of_c]
        return None if min(shares) < 1e-3 else shares

    def compare(self, camera, corners, uvs, texture, value, delta=2e-5, options=()):
        """How many pixels of a triangle were compared with the value at their u and v."""
        document = self.document(camera, texture, triangles=[{"vertices": corners, "uvs": uvs, "material": "m"}])
        rows, count = self.render(document, *options), 0
        for x, y, direction in self.rays(camera):
            shares = self.meet(camera["lookfrom"], direction, corners)
            if shares is None:
                continue
            u, v = (sum(share * uv[k] for share, uv in zip(shares, uvs)) for k in range(2))
            expected = value(u, v)
            if expected is None:
                continue
            count += 1
            for found, part in zip(rows[y][x], expected):
                self.assertAlmostEqual(found / part, 1, delta=delta, msg=f"pixel {x}, {y}: u {u}, v {v}")
        return count

    # A quad and a box show an image as it is.

    def upright(self, document, *options, mirrored=False):
        rows = self.render(document, *options)
        for y in range(HEIGHT):
            for x in range(WIDTH):
                for found, part in zip(rows[y][x], texel(WIDTH - 1 - x if mirrored else x, y)):
                    self.assertAlmostEqual(found / part, 1, delta=2e-5, msg=f"{x}, {y}")

    def test_head_on(self):
        """Each pixel is a texel: from far away, from near by, turned, and mirrored from behind."""
        quad = {"corner": [-WIDTH / 2, -HEIGHT / 2, 0], "u": [WIDTH, 0, 0], "v": [0, HEIGHT, 0], "material": "m"}
        near = {"image_width": WIDTH, "image_height": HEIGHT, "lookfrom": [0, 0, 4], "lookat": [0, 0, 0], "vfov": 2 * math.degrees(math.atan(HEIGHT / 8))}
        flat = {**near, "projection": "orthographic", "view_height": HEIGHT, "vfov": 90}
        flat.pop("vfov")
        for camera in (near, flat):
            self.upright(self.document(camera, quads=[quad]))
            self.upright(self.document({**camera, "lookfrom": [0, 0, -4]}, quads=[quad]), mirrored=True)
        turned = {"corner": [0, -HEIGHT / 2, WIDTH / 2], "u": [0, 0, -WIDTH], "v": [0, HEIGHT, 0], "material": "m"}
        self.upright(self.document({**near, "lookfrom": [4, 0, 0]}, quads=[turned]))

    def test_box(self):
        """From outside every side shows the whole image upright: y upwards, and on top and bottom x to the right."""
        box = {"corners": [[-3, -3, -3], [3, 3, 3]], "material": "m"}
        for eye, up in (([0, 0, 9], [0, 1, 0]), ([0, 0, -9], [0, 1, 0]), ([9, 0, 0], [0, 1, 0]), ([-9, 0, 0], [0, 1, 0]), ([0, 9, 0], [0, 0, -1]),
                        ([0, -9, 0], [0, 0, 1])):
            camera = {"image_width": 12, "image_height": 12, "lookfrom": eye, "lookat": [0, 0, 0], "vup": up, "vfov": 2 * math.degrees(math.atan(0.5))}
            rows = self.render(self.document(camera, boxes=[box]))
            for y in range(12):
                for x in range(12):
                    for found, part in zip(rows[y][x], picture_of((x + 0.5) / 12, 1 - (y + 0.5) / 12)):
                        self.assertAlmostEqual(found / part, 1, delta=2e-5, msg=f"from {eye}: {x}, {y}")

    def test_like_triangles(self):
        """A quad is two triangles with the coordinates that it says, to the bit; and so is its document when it is printed."""
        at = [[-1, -0.8, 0.2], [0.9, -0.7, -0.4], [0.7, 1.5, -0.5], [-1.2, 1.4, 0.1]]
        at[2] = [b + d - a for a, b, d in zip(at[0], at[1], at[3])]
        quad = {"corner": at[0], "u": way(at[0], at[1]), "v": way(at[0], at[3]), "material": "m"}
        camera = {"image_width": 40, "image_height": 30, "lookfrom": [0.5, 0.2, 4], "lookat": [0, 0.3, 0], "vfov": 40}
        first = self.render(self.document(camera, quads=[quad]))
        printed = json.loads(self.succeed("scene", "s.json").stdout)
        self.assertEqual([t["uvs"] for t in printed["triangles"]], [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]])
        self.assertEqual(self.render(printed), first)
        pair = [{"vertices": t["vertices"], "uvs": t["uvs"], "material": "m"} for t in printed["triangles"]]
        self.assertEqual(self.render(self.document(camera, triangles=pair)), first)

    # Values at known places.

    def test_values(self):
        """Triangles that lean away, seen in perspective, with coordinates far beyond 0 and 1, in every precision and form."""
        chance = random.Random(11)
        count = 0
        for number in range(8):
            corners = [[chance.uniform(-2, 2), chance.uniform(-2, 2), chance.uniform(-3, 1)] for _ in range(3)]
            uvs = [[chance.uniform(-3, 4) for _ in range(2)] for _ in range(3)]
            camera = {"image_width": 24, "image_height": 24, "lookfrom": [0.2, -0.3, 3], "lookat": [0, 0, -1], "vfov": 60}
            texture, value = [
                ({"type": "image", "file": "t.pfm"}, picture_of),
                ({"type": "image", "file": "t.pfm", "repeat": [3, 2]}, lambda u, v: picture_of(u, v, (3, 2))),
                ({"type": "image", "file": "t.pfm", "wrap": "clamp"}, lambda u, v: picture_of(u, v, clamped=True)),
                ({"type": "image", "file": "t.pfm", "wrap": "clamp", "repeat": [2, 3]}, lambda u, v: picture_of(u, v, (2, 3), True))][number % 4]
            count += self.compare(camera, corners, uvs, texture, value, 1e-4)
        self.assertGreater(count, 100)

    def test_plain(self):
        """The same with the usual test of triangles."""
        camera = {"image_width": 24, "image_height": 24, "lookfrom": [0.2, -0.3, 3], "lookat": [0, 0, -1], "vfov": 60}
        corners, uvs = [[-2, -1.5, -1], [2, -1, 0.5], [0.3, 2, -2]], [[-0.5, 0.2], [1.7, -1.1], [0.4, 2.2]]
        self.assertGreater(self.compare(camera, corners, uvs, None, picture_of, 1e-3, ("--numerics", "plain")), 100)

    @deep
    def test_double(self):
        camera = {"image_width": 24, "image_height": 24, "lookfrom": [0.2, -0.3, 3], "lookat": [0, 0, -1], "vfov": 60}
        corners, uvs = [[-2, -1.5, -1], [2, -1, 0.5], [0.3, 2, -2]], [[-0.5, 0.25], [1.75, -1.125], [0.5, 2.25]]
        self.assertGreater(self.compare(camera, corners, uvs, None, picture_of, 2e-7, ("--precision", "double")), 100)

    def test_forms(self):
        """One kernel is as good as another, to the bit."""
        camera = {"image_width": 24, "image_height": 24, "lookfrom": [0.2, -0.3, 3], "lookat": [0, 0, -1], "vfov": 60}
        corners, uvs = [[-2, -1.5, -1], [2, -1, 0.5], [0.3, 2, -2]], [[-0.5, 0.2], [1.7, -1.1], [0.4, 2.2]]
        document = self.document(camera, triangles=[{"vertices": corners, "uvs": uvs, "material": "m"}], spheres=[{"center": [1, 1, 0], "radius": 0.5, "material": "m"}])
        pictures = [self.render(document, *options) for options in ((), ("--kernel", "sample"), ("--kernel", "packet"), ("--kernel", "pool"), ("--effects", "all"))]
        self.assertGreater(len({tuple(pixel) for row in pictures[0] for pixel in row}), 100)
        for picture in pictures[1:]:
            self.assertEqual(picture, pictures[0])

    def test_checker(self):
        """Fields of a tile, of which there is an even number each way; those near an edge are not looked at."""
        repeat = (2, 3)

        def field(u, v):
            near = min(abs(p - round(p)) for p in (2 * repeat[0] * u, 2 * repeat[1] * v))
            return None if near < 1e-3 else field_of(u, v, repeat)
        camera = {"image_width": 32, "image_height": 32, "lookfrom": [0.2, -0.3, 3], "lookat": [0, 0, -1], "vfov": 60}
        texture = {"type": "checker", "mapping": "surface", "colors": COLORS, "repeat": list(repeat), "up": [3, 1, 0], "turn": 77}
        corners = [[-2, -1.5, -1], [2, -1, 0.5], [0.3, 2, -2]]
        for uvs in ([[-1.3, -0.2], [1.6, -1.15], [0.4, 2.2]], [[0, 0], [1, 0], [0, 1]]):
            self.assertGreater(self.compare(camera, corners, uvs, texture, field, 1e-6), 150)

    # Hard places.

    def test_tiles_far_off(self):
        """Whole numbers change nothing, however large: coordinates that a float holds beside them."""
        camera = {"image_width": 24, "image_height": 24, "lookfrom": [0.2, -0.3, 3], "lookat": [0, 0, -1], "vfov": 60}
        corners, uvs = [[-2, -1.5, -1], [2, -1, 0.5], [0.3, 2, -2]], [[-0.5, 0.25], [1.75, -1.125], [0.5, 2.25]]
        for far in (0, 4096, -65536):
            moved = [[u + far, v - far] for u, v in uvs]
            self.assertGreater(self.compare(camera, corners, moved, None, picture_of, 1e-4), 100)

    def test_wide_ground(self):
        """A ground of a million tiles each way, seen from one tile above, and counted from far away: as sharp as a small one."""
        half, far = 2.0 ** 19, 2.0 ** 18
        camera = {"image_width": 32, "image_height": 32, "lookfrom": [300.25, 1, 200.5], "lookat": [300.75, 0, 199.25], "vfov": 60}
        corners = [[-half, 0, half], [half, 0, half], [0, 0, -half]]  # less the camera's place all of them are floats
        uvs = [[far - half, far - half], [far + half, far - half], [far, far + half]]
        self.assertGreater(self.compare(camera, corners, uvs, None, lambda u, v: picture_of(u, v) if abs(u - far - 300) < 20 and abs(v - far + 200) < 20 else None,
                                        2e-3), 300)

    def test_seams(self):
        """Across both seams of tiles the image goes on: half of the colours of either side."""
        camera = {"image_width": 1, "image_height": 1, "lookfrom": [0, 0, 2], "lookat": [0, 0, 0], "vfov": 1e-3}
        corners = [[-3, -3, 0], [3, -3, 0], [0, 3, 0]]
        for u, v in ((0, 0.5), (1, 0.3), (0.3, 0), (0.6, 1), (0, 0), (-2, 3)):
            uvs = [[u - 0.5, v - 0.5], [u + 0.5, v - 0.5], [u, v + 0.5]]
            rows = self.render(self.document(camera, triangles=[{"vertices": corners, "uvs": uvs, "material": "m"}]))
            for found, part in zip(rows[0][0], picture_of(u, v)):
                self.assertAlmostEqual(found / part, 1, delta=1e-5, msg=f"{u}, {v}")

    def test_many(self):
        """A quad, and the same place as 48 triangles, whose coordinates stand in many leaves."""
        camera = {"image_width": 48, "image_height": 16, "lookfrom": [0.1, 0.2, 4], "lookat": [0, 0, 0], "vfov": 25}
        whole = self.render(self.document(camera, quads=[{"corner": [-2, -0.5, 0], "u": [4, 0, 0], "v": [0, 1, 0], "material": "m"}]))
        strips = []
        for i in range(24):
            (a, u), (b, w) = ((-2 + 4 * k / 24, k / 24) for k in (i, i + 1))
            strips += [{"vertices": [[a, -0.5, 0], [b, -0.5, 0], [b, 0.5, 0]], "uvs": [[u, 0], [w, 0], [w, 1]], "material": "m"},
                       {"vertices": [[a, -0.5, 0], [b, 0.5, 0], [a, 0.5, 0]], "uvs": [[u, 0], [w, 1], [u, 1]], "material": "m"}]
        for y, row in enumerate(self.render(self.document(camera, triangles=strips))):
            for x, pixel in enumerate(row):
                for found, part in zip(pixel, whole[y][x]):
                    self.assertAlmostEqual(found, part, delta=1e-3, msg=f"{x}, {y}")

    def test_vertices(self):
        """Each vertex has its own coordinates, whichever way the triangle is listed."""
        corners, uvs = [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0.1, 0.9], [0.5, 0.3], [0.8, 0.6]]
        for turn in range(3):
            order = [(k + turn) % 3 for k in range(3)]
            for k, corner in enumerate(corners):
                aim = [0.999 * a + 0.001 * sum(c[i] for c in corners) / 3 for i, a in enumerate(corner)]
                camera = {"image_width": 1, "image_height": 1, "lookfrom": [aim[0], aim[1], 2], "lookat": aim, "vfov": 1e-3}
                rows = self.render(self.document(camera, triangles=[{"vertices": [corners[i] for i in order], "uvs": [uvs[i] for i in order], "material": "m"}]))
                uv = [0.999 * uvs[k][a] + 0.001 * sum(pair[a] for pair in uvs) / 3 for a in range(2)]
                for found, part in zip(rows[0][0], picture_of(*uv)):
                    self.assertAlmostEqual(found / part, 1, delta=1e-4)

    # Beside other things.

    def test_spheres_keep_theirs(self):
        """A globe beside a quad with the same texture shows what it shows alone."""
        camera = {"image_width": 24, "image_height": 24, "lookfrom": [0, 0.5, 4], "lookat": [0, 0, 0], "vfov": 30}
        globe = {"center": [0, 0, 0], "radius": 1, "material": "m"}
        quad = {"corner": [-9, -9, -5], "u": [1, 0, 0], "v": [0, 1, 0], "material": "m"}
        alone, beside = (self.render(self.document(camera, spheres=[globe], **more)) for more in ({}, {"quads": [quad]}))
        self.assertGreater(len({tuple(pixel) for row in alone for pixel in row}), 100)
        self.assertEqual(alone, beside)

    def test_lamp(self):
        """Rays to a quad whose light is an image bring the same mean as chance does; one dark half lights a floor from one side."""
        self.write("half.pfm", images.pfm(2, 1, lambda x, y: [8 * x, 8 * x, 8 * x]))
        document = self.document({"image_width": 16, "image_height": 16, "lookfrom": [0, 4, 0.01], "lookat": [0, 0, 0], "vup": [0, 0, -1], "vfov": 40, "max_depth": 2},
                                 {"type": "image", "file": "half.pfm", "wrap": "clamp"},
                                 quads=[{"corner": [-1, 2, -1], "u": [2, 0, 0], "v": [0, 0, 2], "material": "m"}, {"corner": [-9, 0, 9], "u": [18, 0, 0], "v": [0, 0, -18], "material": "floor"}])
        document["materials"]["floor"] = {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}
        document["camera"]["lookfrom"] = [0, 1.9, 0.01]
        document["camera"]["vfov"] = 90
        sums = []
        for options in (("--light-sampling", "on", "--spp", "256"), ("--light-sampling", "off", "--spp", "8192")):
            rows = self.render(document, *options)
            sums.append([sum(pixel[0] for row in rows for pixel in row[:8]), sum(pixel[0] for row in rows for pixel in row[8:])])
        for on, off in zip(*sums):
            self.assertAlmostEqual(on / off, 1, delta=0.02)
        self.assertGreater(sums[0][1], 1.2 * sums[0][0])

    # Documents.

    def test_refused(self):
        triangle = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "material": "m"}
        for uvs, says in ((None, ["triangles[0].material: found a texture that lies on surfaces, but no texture coordinates", 'give "uvs"', '"mapping": "solid"']),
                          ([[0, 0], [1, 0]], ["triangles[0].uvs", "expected three pairs"]), ([[0, 0], [1, 0], [0, 1, 0]], ["triangles[0].uvs", "expected three pairs"]),
                          ([[0, 0], [1, 0], 7], ["triangles[0].uvs", "expected three pairs"]), ([[0, 0], [1, 0], [0, "1"]], ["triangles[0].uvs[2][1]", "a number"]),
                          ([[0, 0], [1, 2e6], [0, 1]], ["triangles[0].uvs[1][1]", "from -1e6 to 1e6"])):
            members = {} if uvs is None else {"uvs": uvs}
            self.write("s.json", self.document({"image_width": 8}, triangles=[{**triangle, **members}]))
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=says)
        for shape in ("quads", "boxes"):
            self.write("s.json", self.document({"image_width": 8}, **{shape: [{"uvs": [], "material": "m"}]}))
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=["uvs", "unknown member"])

    def test_without_use(self):
        """Coordinates that no texture asks for cost nothing and change nothing."""
        triangle = {"vertices": [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], "material": "m"}
        camera = {"image_width": 16, "image_height": 16, "lookfrom": [0, 0, 4], "lookat": [0, 0, 0], "vfov": 30}
        solid = {"type": "checker", "colors": COLORS, "size": 0.3}
        pictures = []
        for more in ({}, {"uvs": [[0, 0], [1, 0], [0, 1]]}):
            pictures.append(self.render(self.document(camera, solid, triangles=[{**triangle, **more}])))
            effects = json.loads(self.succeed("explain", "s.json", "--json", "-").stdout)["scenes"][0]["effects"]
            self.assertEqual([e["simulated"] for e in effects if e["name"] == "texture_coordinates"], [False])
        self.assertEqual(*pictures)


if __name__ == "__main__":
    main()
