"""Bad scenes, through the program: exit code 2, file:line:column, what was found, and nothing written."""

import os

from cli import ProgramTest, main, scene


class BadScene(ProgramTest):
    def refuse(self, content, *says, name="bad.json"):
        self.write(name, content)
        self.fail_with(2, "render", name, "-o", "x.png", says=(name,) + says)
        self.assertEqual(self.files(), [name])

    def test_not_a_document(self):
        self.refuse("", "bad.json:1:1: ", "empty")
        self.refuse("hello", "bad.json:1:1: ", "not JSON")
        self.refuse('{\n  "camera": {\n', "bad.json:3:1: ")
        self.refuse("[1, 2]", "bad.json:1:1: ")
        self.refuse(b"\xff\xfe\x00", "bad.json:1:")

    def test_members(self):
        self.refuse('{"camera": {\n "image_widht": 3}}', "bad.json:2:2: ", 'did you mean "image_width"?')
        self.refuse('{"camera": {\n "vfov": 30,\n "vfov": 40}}', "bad.json:3:2: ", "vfov")
        self.refuse('{"camera": {\n "vfov": "30"}}', "bad.json:2:10: ", "vfov")
        self.refuse('{"spheres": []}', "camera")
        self.refuse(scene(materials={"n": {"type": "metal", "albedo": [1, 1, 1]}}), "bad.json:1:", "\"m\"")

    def test_numbers(self):
        for text, what in [("NaN", ""), ("1e400", ""), ("Infinity", "")]:
            self.refuse('{"camera": {\n "vfov": %s}}' % text, "bad.json:2:10: ", what)
        for vfov in (0, 180, -5):
            self.refuse('{"camera": {\n "vfov": %d}}' % vfov, "bad.json:2:10: ", "vfov")
        for width in (0, 10**9, -3, 1.5):
            self.refuse('{"camera": {\n "image_width": %s}}' % width, "bad.json:2:17: ", "image_width")

    def test_geometry(self):
        self.refuse(scene(spheres=[{"center": [0, 0, -1], "radius": 0, "material": "m"}]), "bad.json:1:", "radius")
        self.refuse(scene(camera={"vup": [0, 0, 1]}), "bad.json:1:", "vup")
        self.refuse(scene(camera={"lookfrom": [0, 0, -1]}), "bad.json:1:", "lookfrom")
        self.refuse(scene(camera={"aperture": 1, "defocus_angle": 1}), "bad.json:1:", "aperture")
        glass = {"m": {"type": "dielectric", "refraction_index": -1.5}}
        self.refuse(scene(materials=glass), "bad.json:1:", "refraction_index")

    def test_no_file_to_read(self):
        self.fail_with(2, "render", "nowhere.json", "-o", "x.png", says="nowhere.json")
        os.mkdir(self.path("folder"))
        self.fail_with(2, "render", "folder", "-o", "x.png", says=["folder: ", "directory"])
        self.assertEqual(self.files(), ["folder"])

    def test_a_long_row_of_brackets(self):
        with open(self.path("deep.json"), "wb") as file:
            for _ in range(200):
                file.write(b"[" * 1_000_000)
        self.fail_with(2, "render", "deep.json", "-o", "x.png", says="deep.json:1:")
        self.assertEqual(self.files(), ["deep.json"])

    def test_name_of_the_file_that_a_scene_names(self):
        self.refuse(scene(clouds=[{"file": "none.ply", "radius": 1, "material": "m"}]), "none.ply")


if __name__ == "__main__":
    main()
