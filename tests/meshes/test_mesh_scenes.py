"""Meshes in scenes, through the program: where they stand, their materials and colours, what is refused, and every command.

Pictures are compared with those of boxes and triangles that stand in the scene itself, places with a transformation of this
file's own.

Run as: PYTHONPATH=tests/support python3 test_mesh_scenes.py PROGRAM SOURCE_DIR
"""
import base64
import json
import math
import os
import struct
import unittest
import zlib

import samples
from cli import ProgramTest, main
from jpeg import jpeg
from pfm import read_pfm

CORNERS = [[corner >> axis & 1 for axis in range(3)] for corner in range(8)]
# As the program cuts a box, so that the triangles have the same numbers.
SIDES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
CUBE = [face for a, b, c, d in SIDES for face in ((a, b, c), (a, c, d))]
MATERIALS = {"clay": {"type": "lambertian", "albedo": [0.7, 0.4, 0.25]}, "glass": {"type": "dielectric", "refraction_index": 1.5},
             "frost": {"type": "dielectric", "refraction_index": 1.5, "roughness": 0.3}, "skin": {"type": "interface"},
             "normals": {"type": "normals"}, "steel": {"type": "metal", "albedo": [0.9, 0.9, 0.9], "fuzz": 0.1},
             "mapped": {"type": "lambertian", "albedo": {"texture": "map"}}}
TEXTURES = {"map": {"type": "checker", "mapping": "surface", "repeat": [4, 2], "colors": [[0.9, 0.9, 0.9], [0.1, 0.1, 0.1]]}}
CAMERA = {"image_width": 48, "aspect_ratio": 1.5, "samples_per_pixel": 8, "max_depth": 10, "vfov": 35, "lookfrom": [4, 3, 5], "lookat": [0.5, 0.5, 0]}
BUNNY = "/usr/share/glmark2/models/bunny.obj"
GROUND = {"center": [0, -100, 0], "radius": 99, "material": "clay"}


def off(vertices, faces):
    """Vertices of three numbers, or of three and a colour; faces likewise, of three corners."""
    word = "COFF" if len(vertices[0]) > 3 else "OFF"
    rows = [f"{len(face[:3])} " + " ".join(map(str, face)) for face in faces]
    return "\n".join([word, f"{len(vertices)} {len(faces)} 0"] + [" ".join(map(str, v)) for v in vertices] + rows) + "\n"


def placed(point, scale=(1, 1, 1), rotate=(0, 0, 0), translate=(0, 0, 0)):
    """By matrices: the product of those about z, y and x, in this order, turns about x first."""
    x, y, z = (math.radians(angle) for angle in rotate)
    about_x = [[1, 0, 0], [0, math.cos(x), -math.sin(x)], [0, math.sin(x), math.cos(x)]]
    about_y = [[math.cos(y), 0, math.sin(y)], [0, 1, 0], [-math.sin(y), 0, math.cos(y)]]
    about_z = [[math.cos(z), -math.sin(z), 0], [math.sin(z), math.cos(z), 0], [0, 0, 1]]

    def product(a, b):
        return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]

    matrix = product(about_z, product(about_y, about_x))
    scaled = [point[i] * scale[i] for i in range(3)]
    return [sum(matrix[i][j] * scaled[j] for j in range(3)) + translate[i] for i in range(3)]


def png(width, height, colour):
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    rows = b"".join(b"\0" + bytes(part for x in range(width) for part in colour(x, y)) for y in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Meshes(ProgramTest):
    def scene(self, name, *meshes, **members):
        camera = {**CAMERA, **members.pop("camera", {})}
        self.write(name, {"camera": camera, "textures": TEXTURES, "materials": MATERIALS, "meshes": list(meshes), **members})
        return name

    def picture(self, name, *arguments, output="x.pfm"):
        self.succeed("render", name, "-q", "-o", output, *arguments)
        return self.read(output)

    def numbers(self, name, *arguments):
        return read_pfm(self.picture(name, *arguments))[2]

    # ---- where a mesh stands ----

    def test_as_a_box(self):
        """A cube from a file and the box of the grammar are one picture, bit for bit."""
        self.write("cube.off", off(CORNERS, CUBE))
        where = {"rotate": [10, 25, 40], "translate": [0.1, 0.2, 0.3]}
        for material in ("clay", "glass", "steel"):
            mesh = self.scene("m.json", {"file": "cube.off", "material": material, **where}, spheres=[GROUND])
            box = self.scene("b.json", spheres=[GROUND], boxes=[{"corners": [[0, 0, 0], [1, 1, 1]], "material": material, **where}])
            self.assert_same(self.picture(mesh), self.picture(box), material)
        self.assert_different(self.picture(box), self.picture(self.scene("e.json", spheres=[GROUND])))

    def test_placement(self):
        """Scaled, turned about x, y and z, moved, in this order."""
        points = [[0.1, 0.2, -0.3], [1.3, 0.1, 0.2], [0.3, 0.9, 0.4], [0.2, 0.3, 1.7]]
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        self.write("p.off", off(points, faces))
        for scale, rotate, translate in (((2, 2, 2), (0, 0, 0), (0, 0, 0)), ((1, 1, 1), (30, 0, 0), (0, 0, 0)), ((1, 1, 1), (0, 50, 0), (0, 0, 0)),
                                         ((1, 1, 1), (0, 0, -70), (0, 0, 0)), ((1, 1, 1), (30, 50, -70), (0, 0, 0)),
                                         ((0.5, 2, 3), (90, 180, 15), (1, -2, 3)), ((-1, 2, 1), (10, 20, 30), (5, 6, 7))):
            mesh = {"file": "p.off", "material": "normals", "scale": list(scale), "rotate": list(rotate), "translate": list(translate)}
            if len(set(scale)) == 1:
                mesh["scale"] = scale[0]
            there = [placed(point, scale, rotate, translate) for point in points]
            mirrored = scale[0] < 0
            listed = [{"vertices": [there[k] for k in (face[::-1] if mirrored else face)], "material": "normals"} for face in faces]
            a = self.numbers(self.scene("m.json", mesh), "--fit", "--spp", 1)
            b = self.numbers(self.scene("t.json", triangles=listed), "--fit", "--spp", 1)
            apart = sum(abs(x - y) > 1e-4 for x, y in zip(a, b))
            self.assertLess(apart, 12, f"normals, but for samples at a silhouette: {mesh}")
            self.assertGreater(sum(x == y for x, y in zip(a, a[3:])), len(a) / 8, "faces are flat, and large in the picture")

    def test_mirrored_glass(self):
        """A mirror turns the winding, so that the outside stays outside: a mirrored cube of glass is a cube of glass."""
        self.write("cube.off", off(CORNERS, CUBE))
        self.write("bubble.off", off(CORNERS, [face[::-1] for face in CUBE]))
        glass = {"file": "cube.off", "material": "glass"}
        cube, mirrored, bubble = (self.numbers(self.scene("s.json", mesh, spheres=[GROUND]), "--spp", 64) for mesh in
                                  (glass, {**glass, "scale": [-1, 1, 1], "translate": [1, 0, 0]}, {**glass, "file": "bubble.off"}))

        def apart(one, other):
            return sum(abs(a - b) for a, b in zip(one, other))

        self.assertLess(apart(mirrored, cube), apart(bubble, cube) / 4)

    def test_smooth(self):
        """Normals of a file, or by the faces' angles: those that this file places and computes, also where the mesh is mirrored."""
        points = [[0.1, 0.2, -0.3], [1.3, 0.1, 0.2], [0.3, 0.9, 0.4], [0.2, 0.3, 1.7]]
        faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
        own = [[-1, -1, -1], [3, 0, 0.5], [0.1, 1, 0], [0, 0.2, 2]]
        self.write("p.off", off(points, faces))
        self.write("n.obj", "".join(f"v {x} {y} {z}\nvn {u} {v} {w}\n" for (x, y, z), (u, v, w) in zip(points, own)) +
                   "".join("f " + " ".join(f"{k + 1}//{k + 1}" for k in face) + "\n" for face in faces))

        def way(a, b):
            return [y - x for x, y in zip(a, b)]

        def across(u, v):
            return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]

        def by_angles(there):
            sums = [[0.0] * 3 for _ in there]
            for face in faces:
                for k in range(3):
                    u, v = (way(there[face[k]], there[face[(k + step) % 3]]) for step in (1, 2))
                    normal = across(u, v)
                    angle = math.acos(sum(a * b for a, b in zip(u, v)) / math.dist(u, [0] * 3) / math.dist(v, [0] * 3))
                    sums[face[k]] = [s + angle * n / math.dist(normal, [0] * 3) for s, n in zip(sums[face[k]], normal)]
            return sums

        for scale, rotate, translate in (((1, 1, 1), (0, 0, 0), (0, 0, 0)), ((0.5, 2, 3), (90, 180, 15), (1, -2, 3)), ((-1, 2, 1), (10, 20, 30), (5, 6, 7))):
            there = [placed(point, scale, rotate, translate) for point in points]
            turned = [placed([n / s for n, s in zip(normal, scale)], (1, 1, 1), rotate) for normal in own]
            for file, normals in (("p.off", by_angles(there)), ("n.obj", turned)):
                mesh = {"file": file, "material": "normals", "scale": list(scale), "rotate": list(rotate), "translate": list(translate), "smooth": True}
                listed = [{"vertices": [there[k] for k in face], "normals": [normals[k] for k in face], "material": "normals"}
                          for face in (face[::-1] if scale[0] < 0 else face for face in faces)]
                a = self.numbers(self.scene("m.json", mesh), "--fit", "--spp", 1)
                b = self.numbers(self.scene("t.json", triangles=listed), "--fit", "--spp", 1)
                self.assertLess(sum(abs(x - y) > 1e-4 for x, y in zip(a, b)), 12, f"normals, but for samples at a silhouette: {mesh}")
                flat = self.numbers(self.scene("f.json", {**mesh, "smooth": False}), "--fit", "--spp", 1)
                self.assertGreater(sum(abs(x - y) > 0.05 for x, y in zip(a, flat)), 200)

    def test_smooth_notes(self):
        """Which normals are shown; and a scene that is written again is the same."""
        self.write("n.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n")
        self.write("p.off", off([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [(0, 1, 2)]))
        for mesh, says in (({"file": "n.obj", "smooth": True}, "smooth, by its own normals"), ({"file": "p.off", "smooth": True}, "smooth, by the means of its faces' normals"),
                           ({"file": "n.obj"}, '"smooth": true shows them')):
            made = self.run_program("render", self.scene("s.json", {"material": "clay", **mesh}), "--spp", 1, "-o", "x.pfm", "--force")
            self.assertIn(says, " ".join(made.errors.split()))
        listed = [{"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "normals": [[-1, 0, 1], [1, 0.3, 1], [0, 1, 3]], "material": "steel"}]
        first = self.picture(self.scene("s.json", triangles=listed))
        self.write("again.json", self.succeed("scene", "s.json").stdout.decode())
        self.assert_same(self.picture("again.json"), first)

    # ---- materials and colours ----

    def obj(self):
        rows = [f"v {x} {y} {z}" for x, y, z in CORNERS]
        for k, (a, b, c) in enumerate(CUBE):
            rows += {0: ["usemtl one"], 4: ["usemtl two"]}.get(k, []) + [f"f {a + 1} {b + 1} {c + 1}"]
        return "\n".join(rows) + "\n"

    def test_materials(self):
        """Names of the file have materials of the scene; the others have "material"."""
        self.write("cube.obj", self.obj())
        triangles = [[CORNERS[k] for k in face] for face in CUBE]
        for mesh, of_one, of_two in (({"materials": {"one": "clay", "two": "steel"}}, "clay", "steel"),
                                     ({"materials": {"two": "steel"}, "material": "normals"}, "normals", "steel"), ({"material": "steel"}, "steel", "steel")):
            one = self.scene("m.json", {"file": "cube.obj", **mesh}, spheres=[GROUND])
            other = self.scene("t.json", spheres=[GROUND], triangles=[
                {"vertices": corners, "material": of_one if k < 4 else of_two} for k, corners in enumerate(triangles)])
            self.assert_same(self.picture(one), self.picture(other), mesh)
        for materials, says in (({"one": "clay"}, 'found the material "two", expected it in "materials", or a "material"'),
                                ({"one": "clay", "tow": "clay"}, 'meshes[0].materials.tow: found the material "tow"'),
                                ({"one": "glass", "two": "clay"}, 'the material "glass" lets light in')):
            self.fail_with(2, "render", self.scene("s.json", {"file": "cube.obj", "materials": materials}), says=[says])

    def test_colors(self):
        """A triangle has the colour of its face, or the mean of those of its vertices, which materials without an albedo pass over."""
        red, blue = (1, 0, 0), (0, 0, 1)
        faces = [(*face, *(255 * part for part in (red if k < 6 else blue))) for k, face in enumerate(CUBE)]
        self.write("faces.off", off(CORNERS, faces))
        self.write("vertices.off", off([(*corner, *(255 * part for part in (red if corner[0] else blue)), 255) for corner in CORNERS], CUBE))
        materials = {**MATERIALS, **{f"c{share}": {"type": "lambertian", "albedo": [share / 3, 0, 1 - share / 3]} for share in range(4)}}
        triangles = [[CORNERS[k] for k in face] for face in CUBE]
        listed = [{"vertices": corners, "material": "c3" if k < 6 else "c0"} for k, corners in enumerate(triangles)]
        mean = [{"vertices": corners, "material": f"c{sum(corner[0] for corner in corners)}"} for corners in triangles]
        for name, same in (("faces.off", listed), ("vertices.off", mean)):
            mesh = self.scene("m.json", {"file": name, "material": "clay"}, spheres=[GROUND])
            by_hand = self.scene("t.json", triangles=same, spheres=[GROUND], materials=materials)
            self.assert_same(self.picture(mesh), self.picture(by_hand), name)
            self.scene("g.json", {"file": name, "material": "glass"})
            self.assertIn("12 triangles without the file's colours, since the material has no albedo", self.succeed("scene", "g.json").errors)
        self.assertIn("each triangle has the mean of the colours of its vertices",
                      self.succeed("scene", self.scene("m.json", {"file": "vertices.off", "material": "clay"})).errors)

    def test_bytes(self):
        """A triangle takes few bytes on the device: its vertices, two numbers, boxes, empty lanes, and a colour where there are some."""
        n, taken = 100, {}
        corners = [(x / n, math.sin(7 * x / n) * math.cos(5 * z / n) / 9, z / n) for z in range(n + 1) for x in range(n + 1)]
        squares = [z * (n + 1) + x for z in range(n) for x in range(n)]
        faces = [half for a in squares for half in ((a, a + n + 1, a + 1), (a + 1, a + n + 1, a + n + 2))]
        for name, listed in (("plain", faces), ("coloured", [(*face, 255, 0, 0) for face in faces])):
            self.write("grid.off", off(corners, listed))
            self.scene("s.json", {"file": "grid.off", "material": "clay"})
            self.picture("s.json", "--width", 8, "--spp", 1, "--stats", f"{name}.json", "--force")
            taken[name] = json.loads(self.read(f"{name}.json"))["scene_bytes"] / len(faces)
        self.assertGreater(taken["plain"], 9 * 4 + 2 * 4)
        self.assertLess(taken["plain"], 60, "vectors of eight lanes; with sixteen about 52")
        self.assertGreater(taken["coloured"] - taken["plain"], 3 * 4)
        self.assertLess(taken["coloured"] - taken["plain"], 3 * 4 / 0.8)

    def test_check_colors(self):
        """The reference has the same colours."""
        self.write("cube.off", off([(*corner, *(255 * part for part in corner), 255) for corner in CORNERS], CUBE))
        self.scene("s.json", {"file": "cube.off", "material": "clay"}, spheres=[GROUND])
        self.succeed("check", "s.json", "--width", 24, "--spp", 256)

    # ---- texture coordinates ----

    def test_coordinates(self):
        """A file's are those of inline triangles, to the bit, also mirrored; nothing is kept of a mesh on which no texture lies."""
        uvs = [[0.3 * x + y, 0.2 * z - 0.7 * y] for x, y, z in CORNERS]
        self.write("cube.obj", "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS) + "".join(f"vt {u} {v}\n" for u, v in uvs) +
                   "".join("f " + " ".join(f"{k + 1}/{k + 1}" for k in face) + "\n" for face in CUBE))
        for scale in ([1, 1, 1], [-1, 1, 1]):
            mesh = self.scene("m.json", {"file": "cube.obj", "material": "mapped", "scale": scale}, spheres=[GROUND])
            flip = [0, 2, 1] if scale[0] < 0 else [0, 1, 2]
            listed = [{"vertices": [[scale[0] * CORNERS[face[k]][0], *CORNERS[face[k]][1:]] for k in flip], "uvs": [uvs[face[k]] for k in flip], "material": "mapped"}
                      for face in CUBE]
            picture = self.picture(mesh)
            self.assert_same(picture, self.picture(self.scene("t.json", spheres=[GROUND], triangles=listed)))
            self.assert_different(picture, self.picture(self.scene("c.json", {"file": "cube.obj", "material": "clay", "scale": scale}, spheres=[GROUND])))
        self.assertIn("its texture coordinates are not used, since no texture lies on it", self.succeed("scene", "c.json").errors)
        self.assertNotIn("texture coordinates", self.succeed("scene", "m.json").errors)

    def test_images_of_materials(self):
        """map_Kd of MTL and base colours of glTF, beside the file or inside of it, become textures: the same picture of a square."""
        def colour(x, y):
            return [(40 * x + 90 * y + 70 * c) % 256 for c in range(3)]
        painting = png(5, 3, colour)
        self.write("sub.png", painting)
        self.write("two words.png", painting)
        os.mkdir(self.path("maps"))
        self.write("maps/a.png", painting)
        self.write("a.gif", b"GIF89a no PNG")
        photo = jpeg(5, 3, lambda x, y: [100 + 20 * x, 200 - 30 * y, 80 + 10 * x + 20 * y])
        self.write("b.jpg", photo)
        places = [(-1, 0, 0), (1, 0, 0), (1, 1.5, 0), (-1, 1.5, 0)]
        square = "mtllib m.mtl\n" + "".join("v %g %g %g\n" % p for p in places) + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paint\n"
        faces = "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
        self.write("m.mtl", "newmtl paint\nmap_Kd sub.png\n")
        self.write("a.obj", square + faces)
        document = json.loads(self.succeed("scene", "a.obj").stdout)
        plain = {"type": "image", "up": [0, 1, 0], "turn": 0, "repeat": [1, 1]}
        self.assertEqual(document["textures"], {"paint": {**plain, "file": "sub.png"}})
        self.assertEqual(document["materials"]["paint"], {"type": "lambertian", "albedo": {"texture": "paint"}})
        expected = self.picture("a.obj", "--width", 40, "--spp", 4)
        self.write("m.mtl", "newmtl paint\nKd 0.5 0.5 0.5\n")
        self.assert_different(self.picture("a.obj", "--width", 40, "--spp", 4), expected)
        for line, says in (("map_Kd maps\\a.png", None), ("map_Kd two words.png", None), ("map_Kd -clamp off -mm 0 1 sub.png", None), ("map_Kd -blendu on two words.png", None),
                           ("map_Kd -s 2 2 sub.png", "textures are neither moved nor scaled"), ("map_Kd -o 0.5 two words.png", "textures are neither moved nor scaled")):
            self.write("m.mtl", f"newmtl paint\n{line}\n")
            self.assert_same(self.picture("a.obj", "--width", 40, "--spp", 4), expected, line)
            if says is not None:
                self.assertIn(says, self.succeed("scene", "a.obj").errors)
        self.write("m.mtl", "newmtl paint\nmap_Kd b.jpg\n")
        of_photo = self.picture("a.obj", "--width", 40, "--spp", 4)
        self.assert_different(of_photo, expected)
        self.assertEqual(json.loads(self.succeed("scene", "a.obj").stdout)["textures"], {"paint": {**plain, "file": "b.jpg"}})
        self.write("m.mtl", "newmtl paint\nmap_Kd -clamp on sub.png\n")
        self.assertEqual(json.loads(self.succeed("scene", "a.obj").stdout)["textures"]["paint"]["wrap"], "clamp")
        for line, content, why in (("map_Kd gone.png", square + faces, "no such file that is a PNG"), ("map_Kd a.gif", square + faces, "no such file that is a PNG"),
                                   ("map_Kd sub.png", square + faces.replace("3/3\n", "3\n"), "not all of its faces have texture coordinates")):
            self.write("m.mtl", f"newmtl paint\n{line}\n")
            self.write("b.obj", content)
            said = self.succeed("scene", "b.obj")
            self.assertNotIn("textures", json.loads(said.stdout))
            self.assertIn(why, said.errors)

        # glTF: v grows downwards. Its base is a coat over the same colours in a document, so the scenes are compared with the material of the other.
        uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]

        def of(image, factor=1, wrap=None, content=None, **image_members):
            made = samples.gltf(places, [(0, 1, 2), (0, 2, 3)], attributes=[("TEXCOORD_0", uvs, {"form": "VEC2"})], primitive={"material": 0}, materials=[
                {"name": "paint", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [factor] * 3 + [1], "metallicFactor": 0}}],
                textures=[{"source": 0, **({"sampler": 0} if wrap else {})}], **({"samplers": [{"wrapS": wrap}]} if wrap else {}))
            made.add(images=[{"uri": image} if image else {"bufferView": made.view(content or painting), "mimeType": "image/png"}])
            self.write("a.glb", made.binary())
            return json.loads(self.succeed("scene", "a.glb").stdout)
        pictures = []
        for image in ("sub.png", "two%20words.png", None, "data:image/png;base64," + base64.b64encode(painting).decode()):
            document = of(image)
            inside = image is None or image.startswith("data")
            self.assertEqual(document["textures"]["paint"], {**plain, "file": "a.glb", "image": 0} if inside else {**plain, "file": image.replace("%20", " ")})
            self.assertEqual(document["materials"]["paint"]["albedo"], {"texture": "paint"})
            pictures.append(self.picture("a.glb", "--width", 40, "--spp", 4))
        for picture in pictures[1:]:
            self.assert_same(picture, pictures[0])
        document["materials"]["paint"] = {"type": "lambertian", "albedo": {"texture": "paint"}}
        self.write("g.json", document)
        self.assert_same(self.picture("g.json", "--width", 40, "--spp", 4), expected)
        self.assertEqual(json.loads(self.succeed("scene", "g.json").stdout)["textures"]["paint"]["image"], 0)
        self.assertEqual(of(None, 0.5)["textures"]["paint"]["scale"], 0.5)
        self.assertEqual(of(None, wrap=33071)["textures"]["paint"]["wrap"], "clamp")
        document = of(None, content=photo)
        document["materials"]["paint"] = {"type": "lambertian", "albedo": {"texture": "paint"}}
        self.write("g.json", document)
        self.assert_same(self.picture("g.json", "--width", 40, "--spp", 4), of_photo)
        self.assertNotIn("textures", of(None, content=b"GIF89a no PNG"))
        self.assertIn("1 texture of base colours left out, since only PNG and JPEG are read", self.succeed("scene", "a.glb").errors)
        # What is inside of a file.
        of("sub.png")
        for number, says in ((0, 'found image 0 in the file "sub.png"'), (1, "images"), (-1, "found -1")):
            document["textures"]["paint"] = {"type": "image", "file": "a.glb", "image": number}
            self.write("g.json", document)
            self.fail_with(2, "render", "g.json", "-o", "x.png", says=[says])
        document["textures"]["paint"] = {"type": "image", "file": "sub.png", "image": 0}
        self.write("g.json", document)
        self.fail_with(2, "render", "g.json", "-o", "x.png", says=["sub.png"])

    def test_check_coordinates(self):
        """The reference lays the texture on the same places."""
        self.write("roof.obj", "v 0 0 0\nv 2 0 0\nv 1 1.5 0.5\nv 1 1 -1\nvt 0 0\nvt 3 0.5\nvt 1.5 2\nvt -1 1\nf 1/1 2/2 3/3\nf 2/2 4/4 3/3\n")
        self.succeed("check", self.scene("s.json", {"file": "roof.obj", "material": "mapped"}, spheres=[GROUND]), "--width", 24, "--spp", 256)

    # ---- what is refused ----

    def test_refused(self):
        self.write("cube.off", off(CORNERS, CUBE))
        for mesh, says in (({}, 'meshes[0]: found no "file"'), ({"file": "cube.off"}, 'found no "material"'),
                           ({"file": "no.off", "material": "clay"}, 'meshes[0].file: "no.off": cannot open it'),
                           ({"file": "cube.off", "material": "clya"}, 'did you mean "clay"?'),
                           ({"file": "cube.off", "material": "clay", "scale": 0}, "meshes[0].scale: found 0, expected a number other than 0"),
                           ({"file": "cube.off", "material": "clay", "scale": [1, 0, 1]}, "meshes[0].scale"),
                           ({"file": "cube.off", "material": "clay", "rotate": 90}, "meshes[0].rotate"),
                           ({"file": "cube.off", "material": "clay", "smooth": 1}, "meshes[0].smooth: found 1, expected true or false"),
                           ({"file": "cube.off", "material": "clay", "interior": "fog"}, 'meshes[0].interior: found the medium "fog"'),
                           ({"file": "cube.off", "material": "clay", "motion": [0, 1, 0]}, "meshes[0].motion: not for meshes"),
                           ({"file": "cube.off", "material": "clay", "colour": 1}, "meshes[0].colour: unknown member"),
                           ({"file": "cube.off", "materials": {"bark": "clay"}}, 'meshes[0].materials.bark: the file names no materials of faces'),
                           ({"file": "cube.off", "materials": {}}, "without a material of its own"),
                           ({"file": "cube.off", "material": "mapped"}, "no texture coordinates"),
                           ({"file": "cube.off", "material": "clay", "translate": [2e9, 0, 0]}, "meshes[0]: triangle 0 (from 0) of cube.off"),
                           ("cube.off", "meshes[0]: found")):
            self.fail_with(2, "render", self.scene("s.json", mesh), says=[says])

    def test_open_glass(self):
        """The edge is named by its vertices and their places."""
        for name, faces, says in (("open.off", CUBE[:-1], "the edge from vertex 4 to 6 (from 0), (0, 0, 1) to (0, 1, 1), is open: one face alone has this edge"),
                                  ("turned.off", CUBE[:-1] + [CUBE[-1][::-1]], "is open: its two faces are wound against each other")):
            self.write(name, off(CORNERS, faces))
            for material in ("glass", "frost"):
                mesh = {"file": name, "material": material}
                said = self.fail_with(2, "render", self.scene("s.json", mesh), says=["meshes[0].file", f'the material "{material}" lets light in'])
                self.assertIn(says, " ".join(said.errors.split()))
            self.succeed("render", self.scene("s.json", {"file": name, "material": "clay"}), "--spp", 1, "-q", "-o", "x.pfm")
        inside_out = [face[::-1] for face in CUBE]
        self.write("bubble.off", off(CORNERS, inside_out))
        self.succeed("render", self.scene("s.json", {"file": "bubble.off", "material": "glass"}), "--spp", 1, "-q", "-o", "x.pfm")

    def test_glass_on_a_floor(self):
        """Both are named where a face of glass lies in a face of another."""
        self.write("cube.off", off(CORNERS, CUBE))
        floor = {"corner": [-3, 0, 3], "u": [6, 0, 0], "v": [0, 0, -6], "material": "clay"}
        said = self.fail_with(2, "render", self.scene("s.json", {"file": "cube.off", "material": "glass"}, quads=[floor]), says=["in one plane"])
        self.assertIn("of cube.off", said.errors)
        self.assertIn("quads[0]", said.errors)
        lifted = {"file": "cube.off", "material": "glass", "translate": [0, 1e-6, 0]}
        self.succeed("render", self.scene("s.json", lifted, quads=[floor]), "--spp", 1, "-q", "-o", "x.pfm")

    def test_without_area(self):
        """What has no area where it stands is left out and counted."""
        self.write("sliver.off", off(CORNERS + [[2, 0, 0], [3, 1e-15, 0], [4, 0, 0]], CUBE + [(8, 9, 10)]))
        said = self.succeed("scene", self.scene("s.json", {"file": "sliver.off", "material": "clay"})).errors
        self.assertIn("11 vertices, 12 triangles; 1 triangle without an area where the mesh stands left out", said)

    # ---- every command ----

    def test_scene_names_the_file(self):
        os.mkdir(self.path("data"))
        self.write("data/cube.off", off(CORNERS, CUBE))
        mesh = {"file": "data/cube.off", "material": "clay", "rotate": [0, 15, 0]}
        self.scene("s.json", mesh, spheres=[GROUND])
        document = json.loads(self.succeed("scene", "s.json").stdout.decode())
        self.assertEqual(document["meshes"], [mesh])
        self.assertNotIn("triangles", document)
        self.succeed("scene", "s.json", "-o", "data/t.json")
        self.assertEqual(json.loads(self.read("data/t.json"))["meshes"][0]["file"], "cube.off")
        self.assert_same(self.picture("s.json"), self.picture("data/t.json"))
        self.fail_with(2, "render", "s.json", "-o", "data/cube.off", "--format", "png", says=["a mesh of the scene"])

    def test_edits(self):
        self.write("cube.off", off(CORNERS, CUBE))
        self.scene("s.json", {"file": "cube.off", "material": "clay"}, spheres=[GROUND])
        self.scene("t.json", {"file": "cube.off", "material": "steel", "rotate": [0, 20, 0]}, spheres=[GROUND])
        edits = ("--set", "meshes[0].rotate=[0,20,0]", "--set", "meshes[0].material=steel")
        self.assert_same(self.picture("s.json", *edits), self.picture("t.json"))
        self.assert_different(self.picture("s.json"), self.picture("t.json"))

    def test_commands(self):
        self.write("cube.off", off(CORNERS, CUBE))
        self.scene("s.json", {"file": "cube.off", "material": "clay"}, {"file": "cube.off", "material": "glass", "translate": [1.5, 0.2, 0]},
                   spheres=[GROUND])
        self.assertIn("24 triangles", self.succeed("explain", "s.json").stdout.decode())
        path = self.succeed("explain", "s.json", "--pixel", "24,16").stdout.decode()
        self.assertIn("of cube.off", path)
        self.succeed("check", "s.json", "--width", 24, "--spp", 512)
        self.succeed("render", "s.json", "--turntable", 2, "--fit", "--width", 16, "--spp", 1, "-q", "-o", "t.png")
        self.assertEqual([name for name in self.files() if name.startswith("t-") or name.startswith("t.")], ["t-0000.png", "t-0001.png"])
        self.succeed("render", "s.json", "--width", 16, "--spp", 4, "-q", "-o", "x.exr", "--set", "backdrop=none", "--set", "shadow_catcher=true")
        self.succeed("cost", "s.json", "--width", 16, "--time", 1, "-q", "-o", "cost.html")

    # ---- a file alone ----

    def test_a_file_alone(self):
        """It is framed, lit, and rendered as the scene that `scene` prints."""
        self.write("cube.off", off(CORNERS, CUBE))
        said = self.succeed("render", "cube.off", "--width", 40, "--spp", 4, "-o", "a.pfm").errors
        self.assertIn("cube.off: 8 vertices, 12 triangles", said)
        self.succeed("scene", "cube.off", "-o", "cube.json")
        document = json.loads(self.read("cube.json"))
        self.assertEqual(document["meshes"], [{"file": "cube.off", "material": "surface"}])
        self.assertEqual((document["camera"]["fit"], document["lighting"], document["shadow_catcher"]), ("scene", "studio", True))
        self.assert_same(self.read("a.pfm"), self.picture("cube.json", "--width", 40, "--spp", 4))
        width, height, numbers = read_pfm(self.read("a.pfm"))
        darker = [i for i in range(width * height) if numbers[3 * i + 2] < 0.62 * numbers[0]]
        self.assertTrue(width * height / 5 < len(darker) < width * height * 3 / 4, "the cube fills the picture and is not cut off")
        for at in darker:
            self.assertTrue(0 < at % width < width - 1 and 0 < at // width < height - 1, at)

    @unittest.skipUnless(os.path.exists(BUNNY), "glmark2-data is not installed")
    def test_bunny(self):
        """As PLY and as the OBJ that it is made of, alone; and of glass, since it is closed."""
        with open(BUNNY) as file:
            rows = [line.split() for line in file]
        vertices = [row[1:4] for row in rows if row and row[0] == "v"]
        faces = [[int(corner.split("/")[0]) - 1 for corner in row[1:]] for row in rows if row and row[0] == "f"]
        head = (f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
                f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
        self.write("bunny.ply", head + "".join(" ".join(v) + "\n" for v in vertices) + "".join("3 %d %d %d\n" % tuple(f) for f in faces))
        pictures = []
        for name in ("bunny.ply", BUNNY):
            said = self.succeed("render", name, "--width", 40, "--spp", 4, "-o", "a.pfm", "--force").errors
            self.assertIn(f"{len(vertices):,} vertices, {len(faces):,} triangles", said)
            numbers = read_pfm(self.read("a.pfm"))[2]
            darker = sum(blue < 0.62 * numbers[0] for blue in numbers[2::3])
            self.assertTrue(len(numbers) / 3 / 6 < darker < len(numbers) / 3 * 3 / 4, "it fills the picture")
            pictures.append(self.read("a.pfm"))
        self.assert_same(*pictures)
        self.succeed("render", self.scene("s.json", {"file": "bunny.ply", "material": "glass"}), "--fit", "--width", 16, "--spp", 1, "-q", "-o", "x.pfm")

    def test_up(self):
        """STL files have z up: what lies at the greatest z is at the top of the picture."""
        corners = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, 9)]
        rows = ["facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x} {y} {z}\n" for x, y, z in (corners[k] for k in face)) +
                "endloop\nendfacet\n" for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))]
        self.write("spire.stl", "solid s\n" + "".join(rows) + "endsolid s\n")
        self.assertEqual(json.loads(self.succeed("scene", "spire.stl").stdout)["meshes"][0]["rotate"], [-90, 0, 0])
        self.write("turned.off", off([(x, z, -y) for x, y, z in corners], ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))))
        arguments = ("--width", 32, "--spp", 2)
        stl, turned = self.numbers("spire.stl", *arguments), self.numbers("turned.off", *arguments)
        self.assertLess(sum(abs(a - b) for a, b in zip(stl, turned)) / sum(turned), 1e-3)

    def test_points_stay_points(self):
        head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n%send_header\n0 0 0\n1 0 0\n0 1 0\n%s"
        self.write("points.ply", head % ("", ""))
        self.write("mesh.ply", head % ("element face 1\nproperty list uchar int vertex_indices\n", "3 0 1 2\n"))
        self.assertIn("particles", json.loads(self.succeed("scene", "points.ply").stdout))
        self.assertIn("meshes", json.loads(self.succeed("scene", "mesh.ply").stdout))

    def test_offers(self):
        """What MTL has of a material that faces use: Kd, Ke, and Ni and d of glass that is closed."""
        self.write("cube.obj", "mtllib a.mtl\n" + self.obj())
        self.write("a.mtl", "newmtl one\nKd 1 0.5 0.25\nKe 2 0 0\nnewmtl two\nKd 0 0 1\nd 0.1\nNi 1.4\nnewmtl three\nKd 1 1 1\n")
        result = self.succeed("scene", "cube.obj")
        document = json.loads(result.stdout)
        self.assertEqual(document["meshes"], [{"file": "cube.obj", "materials": {"one": "one", "two": "two"}}])
        self.assertEqual(document["materials"], {"one": {"type": "lambertian", "albedo": [1, 0.5, 0.25], "emit": [2, 0, 0]},
                                                 "two": {"type": "lambertian", "albedo": [0, 0, 1]}})
        self.assertIn('the material "two" lets no light in, although its opacity is 0.1: its faces are not closed', result.errors)
        self.write("a.mtl", "newmtl all\nd 0.1\nNi 1.4\n")
        self.write("cube.obj", "mtllib a.mtl\nusemtl all\n" + "\n".join(row for row in self.obj().split("\n") if not row.startswith("usemtl")))
        self.assertEqual(json.loads(self.succeed("scene", "cube.obj").stdout)["materials"], {"all": {"type": "dielectric", "refraction_index": 1.4}})
        self.succeed("render", "cube.obj", "--width", 16, "--spp", 1, "-q", "-o", "x.png")
        self.write("half.obj", "\n".join(row for row in self.obj().split("\n") if row != "usemtl one"))
        self.assertEqual(json.loads(self.succeed("scene", "half.obj").stdout)["meshes"],
                         [{"file": "half.obj", "materials": {"two": "two"}, "material": "surface"}])

    def test_gltf(self):
        """What glTF says of surfaces: metal, coats, glass that is closed, lamps; smooth where there are normals; the same picture as by hand."""
        parts = {"gold": {"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "roughnessFactor": 0.25}},
                 "paint": {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0, "roughnessFactor": 0.5}},
                 "glass": {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}, "extensions": {
                     "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.25}}},
                 "lamp": {"emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}},
                 "photo": {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}}}
        wanted = {"gold": {"type": "metal", "albedo": [1, 0.5, 0.25], "roughness": 0.25},
                  "paint": {"type": "glossy", "albedo": [0.5, 0.25, 1], "roughness": 0.5, "refraction_index": 1.5},
                  "glass": {"type": "dielectric", "refraction_index": 1.25},
                  "lamp": {"type": "lambertian", "albedo": [1, 1, 1], "emit": [4, 2, 0]},
                  "photo": {"type": "glossy", "albedo": [0.6, 0.58, 0.55], "roughness": 1, "refraction_index": 1.5}}
        cube = samples.gltf(materials=[{"name": name, **part} for name, part in parts.items()])
        first = cube.document["meshes"][0]["primitives"][0]
        cube.document["meshes"] = [{"primitives": [{**first, "material": i}]} for i in range(5)]
        cube.document["nodes"] = [{"mesh": i, "translation": [2 * i, 0, 0]} for i in range(5)]
        cube.document["scenes"] = [{"nodes": [0, 1, 2, 3, 4]}]
        self.write("parts.glb", cube.binary())
        document = json.loads(self.succeed("scene", "parts.glb").stdout)
        self.assertEqual(document["materials"], wanted)
        self.assertNotIn("smooth", document["meshes"][0])
        picture = self.numbers("parts.glb", "--width", 32, "--spp", 4)
        triangles = []
        for i, name in enumerate(parts):
            triangles += [{"vertices": [[samples.CORNERS[v][0] + 2 * i, *samples.CORNERS[v][1:]] for v in t], "material": name} for t in samples.TRIANGLES]
        document.pop("meshes")
        self.write("hand.json", json.dumps({**document, "triangles": triangles}))
        self.assertEqual(self.numbers("hand.json", "--width", 32, "--spp", 4), picture)
        self.write("smooth.glb", samples.gltf(attributes=[("NORMAL", samples.CORNERS, {})]).binary())
        self.assertEqual(json.loads(self.succeed("scene", "smooth.glb").stdout)["meshes"], [{"file": "smooth.glb", "smooth": True, "material": "surface"}])
        open_glass = samples.gltf(triangles=samples.TRIANGLES[1:], primitive={"material": 0}, materials=[{"name": "glass", **parts["glass"]}])
        self.write("open.glb", open_glass.binary())
        self.assertIn("its faces are not closed", self.succeed("scene", "open.glb").errors)

    def test_other_formats(self):
        for name, content in (("a.blend", b"BLENDER-v300" + bytes(90)), ("a.3mf", b"PK"), ("a.fbx", b"Kaydara FBX Binary" + bytes(90))):
            self.write(name, content)
            self.fail_with(2, "render", name, says=[name, "export it as PLY, OBJ, STL, OFF or glTF"])


if __name__ == "__main__":
    main()
