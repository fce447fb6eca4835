"""Every JSON line of the table "From C++ to JSON" in docs/BOOK.md is a part of a scene that the program reads, and all that it says
is in the scene that `ballpark scene` prints. The numbers that the table computes from the book's are right.

Run as: PYTHONPATH=tests/support python3 test_book_lines.py PROGRAM SOURCE_DIR
"""
import json
import math
import re

from cli import SOURCE, ProgramTest, main

NAMED = {"camera": {"lookfrom": [-20, 5, 30]}, "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}, "edge": {"type": "interface"}},
         "textures": {"t": {"type": "checker", "colors": [0, 1]}}, "media": {"smoke": {"scattering": 1}}}


def rows():
    with open(SOURCE + "/docs/BOOK.md", encoding="utf-8") as file:
        table = re.search(r"(?s)## From C\+\+ to JSON\n(.*?)\n## ", file.read())[1]
    for book, ours in re.findall(r"(?m)^\| (.*?) \| (.*?) \|$", table):
        for line in re.findall(r"`(\"[^`]*)`", ours):
            yield book, json.loads("{" + line + "}")


def within(part, whole):
    """Whether all that `part` says is in `whole`, which may say a grey as one number and a colour as a gradient of one."""
    if isinstance(part, list) and whole in ({"bottom": part, "top": part}, part[0] if part == [part[0]] * 3 else None):
        return True
    if isinstance(part, dict):
        return isinstance(whole, dict) and all(name in whole and within(value, whole[name]) for name, value in part.items())
    if isinstance(part, list) and part and isinstance(part[0], dict):
        return all(any(within(one, other) for other in whole) for one in part)
    if isinstance(part, list):
        return isinstance(whole, list) and len(part) == len(whole) and all(map(within, part, whole))
    return part == whole


def turned_and_moved(x, y, z, box):
    """The book's rotate_y and translate."""
    angle = math.radians(box.get("rotate", [0, 0, 0])[1])
    move = box.get("translate", [0, 0, 0])
    place = (math.cos(angle) * x + math.sin(angle) * z, y, -math.sin(angle) * x + math.cos(angle) * z)
    return tuple(round(a + b, 9) for a, b in zip(place, move))


class Lines(ProgramTest):
    def scene_with(self, members):
        """A scene in which everything that the line names exists, and is used."""
        document = json.loads(json.dumps(NAMED))
        for name, value in members.items():
            if isinstance(value, dict) and name in document:
                document[name].update(value)
            else:
                document[name] = value
        if "textures" in members:
            document["materials"]["m"]["albedo"] = {"texture": "t"}
        document.setdefault("spheres", []).append({"center": [0, 9, 0], "radius": 1, "material": "m"})
        if "media" in members:
            document["spheres"].append({"center": [0, -9, 0], "radius": 1, "material": "edge", "interior": "smoke"})
        return document

    def test_each_is_read(self):
        # A picture is read by what it holds, and not by its name.
        self.write("earthmap.jpg", open(SOURCE + "/scenes/earth.png", "rb").read())
        count = 0
        for book, members in rows():
            with self.subTest(book):
                document = self.scene_with(members)
                printed = json.loads(self.succeed("scene", self.write("s.json", document)).stdout)
                corners = {tuple(round(x, 9) for x in vertex) for triangle in printed.get("triangles", [])
                           for vertex in triangle["vertices"]}
                for quad in members.pop("quads", []):
                    self.assertEqual(corners, {tuple(sum(parts) for parts in zip(quad["corner"], *sides))
                                               for sides in ([], [quad["u"]], [quad["v"]], [quad["u"], quad["v"]])})
                for box in members.pop("boxes", []):
                    self.assertEqual(corners, {turned_and_moved(x, y, z, box) for x in (0, 165) for y in (0, 330) for z in (0, 165)})
                self.assertTrue(within(members, printed), (members, printed))
            count += 1
        self.assertGreater(count, 25)

    def one(self, text):
        found = [members for book, members in rows() if text in book]
        self.assertEqual(len(found), 1, text)
        return found[0]

    def test_numbers(self):
        marble = self.one("sin(scale * p.z()")["textures"]["t"]
        self.assertAlmostEqual(marble["period"], 2 * math.pi / 4, places=4)
        self.assertAlmostEqual(marble["distortion"], 10 / (2 * math.pi), places=4)
        for text in ("noise.noise(scale", "noise.turb(scale"):
            self.assertEqual(self.one(text)["textures"]["t"]["size"], 1 / 4)
        smoke = self.one("color(0.2, 0.4, 0.9)")["media"]["smoke"]
        for i, albedo in enumerate((0.2, 0.4, 0.9)):
            self.assertAlmostEqual(smoke["scattering"][i], 0.2 * albedo)
            self.assertAlmostEqual(smoke["scattering"][i] + smoke["absorption"][i], 0.2)
        rectangle = self.one("xz_rect")["quads"][0]
        self.assertEqual([a + b + c for a, b, c in zip(rectangle["corner"], rectangle["u"], rectangle["v"])], [343, 554, 332])
        self.assertAlmostEqual(self.one("dielectric>(1.00 /")["materials"]["m"]["refraction_index"], 1 / 1.5)

    def test_the_scale_that_the_page_promises(self):
        """A reader who writes the book's scale gets the number of the table."""
        for text, name in (("noise.noise(scale", "size"), ("noise.turb(scale", "size"), ("sin(scale * p.z()", "period"),
                           ("checker_texture", "size")):
            members = self.one(text)
            number = members["textures"]["t"].pop(name)
            members["textures"]["t"]["scale"] = 0.32 if "checker" in text else 4
            self.fail_with(2, "scene", self.write("s.json", self.scene_with(members)), says=f'"{name}": {number:g} here')


if __name__ == "__main__":
    main()
