"""Textures through the program: written, changed, explained, in layers, in films, under points with colours."""

import json
import struct

import exr
from cli import ProgramTest, main, scene

TILES = {"type": "checker", "colors": [[0.8, 0.2, 0.1], [0.1, 0.3, 0.9]], "size": 0.25}
GLOBE = {"type": "checker", "mapping": "surface", "colors": [0, 0.5], "up": [1, 1, 0], "turn": 10, "repeat": [3, 2]}
VEINS = {"type": "noise", "pattern": "marble", "colors": [[0, 0, 0], [3, 2, 1]], "size": 0.3, "period": 0.2}
METAL = {"type": "metal", "albedo": {"texture": "tiles"}, "fuzz": {"texture": "globe"}, "emit": {"texture": "veins"}}


def document(material=None, **members):
    textures = {"tiles": TILES, "globe": GLOBE, "veins": VEINS}
    return scene(materials={"m": material or METAL}, textures=members.pop("textures", textures), **members)


class Textures(ProgramTest):
    def picture(self, name, *options):
        return self.succeed("render", name, "-o", "-", "--format", "pfm", "-q", *options).stdout

    def test_written_reads_back(self):
        self.write("s.json", document(spheres=2))
        written = self.succeed("scene", "s.json").stdout
        self.write("again.json", written)
        again = json.loads(written)
        self.assertEqual(again["materials"]["m"], {**METAL, "type": "metal"})
        self.assertEqual(again["textures"]["tiles"], {**TILES, "mapping": "solid"})
        self.assertEqual(again["textures"]["globe"], GLOBE)
        self.assertEqual(again["textures"]["veins"]["colors"], [0, [3, 2, 1]])
        self.assertEqual(self.picture("s.json"), self.picture("again.json"))
        self.assertEqual(self.succeed("scene", "again.json").stdout, written)

    def test_forms_give_the_same_picture(self):
        self.write("s.json", document(spheres=40))
        first = self.picture("s.json")
        for options in (["--kernel", "sample"], ["--effects", "all"], ["--kernel", "sample", "--effects", "all"]):
            self.assert_same(self.picture("s.json", *options), first, options)

    def test_set(self):
        self.write("s.json", document())
        self.write("larger.json", document(textures={"tiles": {**TILES, "size": 0.5}, "globe": GLOBE, "veins": VEINS}))
        before = self.picture("s.json")
        changed = self.picture("s.json", "--set", "textures.tiles.size=0.5")
        self.assert_same(changed, self.picture("larger.json"))
        self.assert_different(changed, before)
        plain = self.picture("s.json", "--set", "materials.m.albedo=[0.8,0.2,0.1]")
        self.assert_different(plain, before)
        self.fail_with(2, "render", "s.json", "-o", "x.png", "--set", "textures.globe.repeat=[0,1]",
                       says=["textures.globe.repeat[0]: found 0", "1 to 65536", "--set"])
        self.fail_with(2, "render", "s.json", "-o", "x.png", "--set", 'materials.m.fuzz={"texture":"tile"}',
                       says=["materials.m.fuzz.texture: found the texture \"tile\"", 'did you mean "tiles"'])
        self.assertEqual(self.files(), ["larger.json", "s.json"])

    def test_equal_colours_are_no_texture(self):
        """A texture of one colour draws what the colour draws, bit for bit."""
        same = {"type": "noise", "pattern": "wood", "colors": [[0.75, 0.5, 0.25]] * 2}
        self.write("varied.json", document({"type": "lambertian", "albedo": {"texture": "t"}}, textures={"t": same}))
        self.write("plain.json", document({"type": "lambertian", "albedo": [0.75, 0.5, 0.25]}, textures={}))
        self.assert_same(self.picture("varied.json"), self.picture("plain.json"))

    def test_explain_and_stats(self):
        self.write("s.json", document())
        self.write("plain.json", document({"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}))
        table = self.succeed("explain", "s.json").stdout.decode()
        self.assertRegex(table, r"textures +in +1 material with textures, on 1 of 1 sphere")
        self.assertRegex(table, r"noise +in +1 material with noise, on 1 of 1 sphere")
        table = self.succeed("explain", "plain.json").stdout.decode()
        self.assertRegex(table, r"textures +out +no material has a texture")
        self.assertRegex(table, r"noise +out +no material has a texture of noise")
        self.succeed("render", "s.json", "-q", "-o", "x.png", "--stats", "x.json")
        self.assertEqual(json.loads(self.read("x.json"))["effects"], ["metal", "emission", "textures", "noise", "roulette"])

    def test_one_path_is_the_picture(self):
        """What `explain --pixel` follows has textures too."""
        self.write("s.json", document({"type": "diffuse_light", "emit": {"texture": "tiles"}}))
        colours = set()
        for x in (5, 8, 10):
            entry = json.loads(self.succeed("explain", "s.json", "--pixel", f"{x},8", "--json", "-").stdout)["scenes"][0]
            step = entry["path"]["steps"][0]
            if step["met"]:
                colours.add(tuple(round(v, 5) for v in step["radiance"]))
        self.assertTrue(colours and colours <= {tuple(c) for c in TILES["colors"]}, colours)

    def test_layers_show_textures(self):
        camera = {"image_width": 16, "pixel_sampling": "center", "samples_per_pixel": 1, "max_depth": 2}
        self.write("s.json", document({"type": "lambertian", "albedo": {"texture": "tiles"}}, camera=camera))
        self.succeed("render", "s.json", "-q", "-o", "x.exr")
        _, _, channels = exr.read(self.read("x.exr"))
        found = {tuple(round(v, 5) for v in rgb) for rgb in zip(*(channels[f"albedo.{c}"] for c in "RGB"))}
        self.assertEqual(found, {(0, 0, 0), *map(tuple, TILES["colors"])})

    def test_points_with_colours(self):
        """Colours of a cloud's points replace the texture of their material."""
        points = b"".join(struct.pack("<3f3B", x, 0, -2, *colour) for x, colour in ((-0.4, (255, 0, 0)), (0.4, (0, 0, 255))))
        header = ("ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                  "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n")
        self.write("points.ply", header.encode() + points)
        clouds = [{"file": "points.ply", "radius": 0.35, "material": "m"}]
        matte = {"type": "lambertian", "albedo": {"texture": "tiles"}}
        self.write("s.json", document(matte, spheres=[], clouds=clouds))
        self.write("plain.json", document({"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}, spheres=[], clouds=clouds))
        self.assert_same(self.picture("s.json"), self.picture("plain.json"))

    def test_films_of_other_textures_do_not_merge(self):
        self.write("s.json", document())
        self.succeed("render", "s.json", "-q", "-o", "a.bpa")
        self.succeed("render", "s.json", "-q", "--first-sample", 8, "-o", "b.bpa", "--set", "textures.veins.seed=1")
        self.fail_with(2, "merge", "a.bpa", "b.bpa", "-o", "c.png", says=["scene"])


if __name__ == "__main__":
    main()
