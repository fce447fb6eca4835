"""Pictures for print: resolution, width in millimetres, 16 bits, and what tells where a picture comes from."""

import json
import math
import struct

import cli
import exr
from pfm import read_pfm
from png import read_png


def texts(chunks):
    """{key: text} of the uncompressed tEXt and iTXt chunks."""
    found = {}
    for name, body in chunks:
        key, _, rest = body.partition(b"\0")
        if name == "tEXt":
            found[key.decode("latin-1")] = rest.decode("latin-1")
        if name == "iTXt":
            assert rest[:2] == b"\0\0", "compressed"
            found[key.decode("latin-1")] = rest[2:].split(b"\0", 2)[2].decode()
    return found


class Figure(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("scene.json", cli.scene(16, 8, spheres=2))

    def render(self, name, *options):
        self.succeed("render", "scene.json", "-o", name, "--quiet", *options)
        return self.read(name)

    def test_resolution(self):
        chunks = dict(read_png(self.render("a.png", "--dpi", 300))[5])
        self.assertEqual(struct.unpack(">IIB", chunks["pHYs"]), (11811, 11811, 1))  # a metre has 39.37 inches
        self.assertNotIn("pHYs", dict(read_png(self.render("b.png"))[5]))
        header, _ = exr.attributes(self.render("a.exr", "--dpi", 299.5))
        self.assertEqual(struct.unpack("<f", header["xDensity"]), (299.5,))
        self.assertNotIn("xDensity", exr.attributes(self.render("b.exr"))[0])

    def test_width_in_millimetres(self):
        self.assertEqual(read_png(self.render("a.png", "--dpi", 127, "--width-mm", 5))[:2], (25, 12))
        self.assert_same(self.render("a.png", "--dpi", 127, "--width-mm", 5), self.render("b.png", "--dpi", 127, "--width", 25))
        self.fail_with(2, "render", "scene.json", "--width-mm", 5, says=("--width-mm needs --dpi", "--dpi 300"))
        self.fail_with(2, "render", "scene.json", "--dpi", 100, "--width-mm", 5, "--width", 7, says="do not go together")
        self.fail_with(2, "render", "scene.json", "--dpi", 50000, "--width-mm", 5000, says=("9842520 pixels", "1 to 65535"))
        self.fail_with(2, "render", "scene.json", "--dpi", 1, "--width-mm", 1, says="0 pixels")

    def test_16_bits(self):
        for transfer in ("linear", "gamma2"):
            width, height, bits, channels, rows, _ = read_png(self.render("a.png", "--bit-depth", 16, "--transfer", transfer))
            self.assertEqual((width, height, bits, channels), (16, 8, 16, 3))
            values = list(read_pfm(self.render("a.pfm"))[2])
            for y, row in enumerate(rows):
                for i, word in enumerate(row):
                    linear = values[(height - 1 - y) * 3 * width + i]
                    encoded = min(linear if transfer == "linear" else linear ** 0.5, 1)
                    self.assertAlmostEqual(word, 65535 * encoded, delta=0.6)
        self.assert_same(self.render("a.png", "--bit-depth", 8), self.render("b.png"))

    def test_exposure(self):
        """So many stops multiply the radiance before the transfer curve; noise and its map stay as they are."""
        for stops in (1.5, -2):
            for transfer in ("linear", "gamma2"):
                rows = read_png(self.render("a.png", "--bit-depth", 16, "--transfer", transfer, "--exposure", stops))[4]
                values = list(read_pfm(self.render("a.pfm"))[2])
                for y, row in enumerate(rows):
                    for i, word in enumerate(row):
                        linear = values[(8 - 1 - y) * 3 * 16 + i] * 2 ** stops
                        self.assertAlmostEqual(word, 65535 * min(linear if transfer == "linear" else linear ** 0.5, 1), delta=0.6)
        self.assert_same(self.render("a.png", "--exposure", 0), self.render("b.png"))
        brighter = self.render("a.png", "--exposure", 1, "--error-map", "a-map.png")
        self.assert_different(brighter, self.render("b.png", "--error-map", "b-map.png"))
        self.assert_same(self.read("a-map.png"), self.read("b-map.png"))
        self.render("a.bpa")
        self.succeed("merge", "a.bpa", "--exposure", 1, "-o", "merged.png")
        self.assert_same(self.read("merged.png"), brighter)
        self.succeed("render", "scene.json", "--exposure", 1, "--preview", 0.001, "-o", "previewed.png")
        self.assert_same(self.read("previewed.png"), brighter)
        for ending in ("exr", "pfm", "bpa"):
            self.fail_with(2, "render", "scene.json", "--exposure", 1, "-o", f"a.{ending}", says="--exposure applies to PNG")

    def test_16_bits_with_alpha(self):
        self.write("scene.json", cli.scene(16, 8, spheres=1, backdrop="none", transfer="linear"))
        width, height, bits, channels, rows, _ = read_png(self.render("a.png", "--bit-depth", 16))
        self.assertEqual((bits, channels), (16, 4))
        layers = exr.read(self.render("a.exr"))[2]
        for pixel, (alpha, red) in enumerate(zip(layers["A"], layers["R"])):
            shown = rows[pixel // width][4 * (pixel % width):][:4]
            self.assertAlmostEqual(shown[3], 65535 * alpha, delta=0.6)
            self.assertAlmostEqual(shown[0], 65535 * min(red / alpha, 1) if alpha > 0 else 0, delta=0.7)

    def test_outlines_and_fog(self):
        """Both change the picture as its depth says, and neither its errors nor its layers."""
        self.write("scene.json", cli.scene(32, 16, spheres=2, backdrop={"bottom": [1, 1, 1], "top": [1, 1, 1]}))
        cues = ("--outlines", 1, "--depth-fog", "50%")
        plain, drawn = (exr.read(self.render(name, *options))[2] for name, options in (("a.exr", ()), ("b.exr", cues)))
        self.assertEqual(set(plain), set(drawn))
        for layer in plain:
            same = list(plain[layer]) == list(drawn[layer])
            self.assertEqual(same, layer not in "RGB", layer)
        seen = [i for i, depth in enumerate(plain["depth.Z"]) if math.isfinite(depth)]
        nearest, farthest = (choose(plain["depth.Z"][i] for i in seen) for choose in (min, max))
        faded = exr.read(self.render("c.exr", "--depth-fog", 50))[2]
        for i, depth in enumerate(plain["depth.Z"]):
            share = 0.5 * (depth - nearest) / (farthest - nearest) if i in seen else 0
            self.assertAlmostEqual(faded["G"][i], plain["G"][i] + share * (1 - plain["G"][i]), delta=1e-6)
        lined = exr.read(self.render("d.exr", "--outlines", 1))[2]
        black = [i for i in range(32 * 16) if lined["G"][i] == 0 != plain["G"][i]]
        self.assertGreater(len(black), 5)
        # A pixel across is no further than a picture's row, and what a line lies around is nearer.
        for i in black:
            around = [plain["depth.Z"][j] for dx in (-1, 0, 1) for dy in (-1, 0, 1)
                      if 0 <= i % 32 + dx < 32 and 0 <= (j := i + dx + 32 * dy) < 32 * 16]
            self.assertLess(min(around), plain["depth.Z"][i])

    def test_outlines_of_merged_sums(self):
        self.write("scene.json", cli.scene(32, 16, spheres=2, backdrop="none"))
        cues = ("--outlines", 1.5, "--depth-fog", 60)
        self.render("whole.bpa")
        whole = self.render("whole.png", *cues)
        self.succeed("merge", "whole.bpa", "-o", "merged.png", "-q", *cues)
        self.assert_same(self.read("merged.png"), whole)
        self.assertNotEqual(self.render("plain.png"), whole)
        self.assertEqual(read_png(whole)[3], 4)

    def test_error_map_of_a_drawn_picture(self):
        self.write("scene.json", cli.scene(32, 16, spheres=2, backdrop=[1, 1, 1]))
        self.render("a.png", "--error-map", "a-error.png")
        self.render("b.png", "--error-map", "b-error.png", "--outlines", 2, "--depth-fog", 90)
        self.assertNotEqual(self.read("a.png"), self.read("b.png"))
        self.assert_same(self.read("a-error.png"), self.read("b-error.png"))

    def test_cues_that_cannot_be(self):
        self.fail_with(2, "render", "scene.json", "--depth-fog", 50, says=("backdrop", "--set 'backdrop=[1,1,1]'"))
        self.succeed("render", "scene.json", "--depth-fog", 50, "--set", "backdrop=[1,1,1]", "-q", "-o", "a.png")
        self.fail_with(2, "render", "scene.json", "--outlines", 1, "-o", "a.bpa", says=("holds sums", "ballpark merge"))
        self.render("sums.bpa")
        self.fail_with(2, "merge", "sums.bpa", "--depth-fog", 50, "-o", "b.png", says=("alpha", "none"))
        self.succeed("merge", "sums.bpa", "--outlines", 1, "-o", "b.png")
        for option, value in (("--outlines", 0), ("--outlines", 101), ("--depth-fog", "101%"), ("--depth-fog", -1)):
            self.fail_with(2, "render", "scene.json", option, value, says=option)

    def test_cues_of_a_preview(self):
        """A preview has no depth yet, and does without."""
        self.write("scene.json", cli.scene(16, 8, spheres=2, backdrop=[1, 1, 1]))
        self.render("a.png", "--outlines", 1, "--preview", 0.001)
        self.assert_same(self.read("a.png"), self.render("b.png", "--outlines", 1))

    def test_metadata(self):
        version = self.succeed("--version").stdout.decode().strip().removeprefix("ballpark ")
        name = "pic ture's \u03b1.png"
        found = texts(read_png(self.render(name, "--metadata", "--seed", 7, "--spp", 2))[5])
        self.succeed("render", "scene.json", "-o", "a.bpa", "--seed", 7, "--spp", 2, "--quiet")
        scene_hash = json.loads(self.read("a.bpa").split(b"\n", 1)[0])["scene_hash"]
        self.assertEqual(found, {
            "Software": f"Ballpark {version}", "Seed": "7", "Scene hash": scene_hash,
            "Command": "ballpark render scene.json --output 'pic ture'\\''s \u03b1.png' --spp 2 --metadata --seed 7 --quiet"})
        header, _ = exr.attributes(self.render("a.exr", "--metadata", "--seed", 7))
        self.assertEqual(header["seed"], b"7")
        self.assertEqual(header["sceneHash"].decode(), scene_hash)
        self.assertEqual(header["software"].decode(), f"Ballpark {version}")
        self.assertIn(b"ballpark render scene.json --output a.exr", header["command"])
        merged = self.succeed("merge", "a.bpa", "-o", "m.png", "--metadata", "--quiet") and self.read("m.png")
        found = texts(read_png(merged)[5])
        self.assertEqual((found["Command"], found["Scene hash"]), ("ballpark merge a.bpa --output m.png --metadata --quiet", scene_hash))

    def test_the_same_command_makes_the_same_file(self):
        options = ("--metadata", "--dpi", 300, "--bit-depth", 16)
        self.assert_same(self.render("a.png", *options), self.render("a.png", *options))
        self.assert_same(self.render("a.exr", "--metadata"), self.render("a.exr", "--metadata"))
        self.assertEqual(texts(read_png(self.render("a.png"))[5]), {"Software": "Ballpark"})  # unless it is asked for

    def test_what_has_no_place(self):
        for name, options, words in (("a.ppm", ("--dpi", 300), "--dpi: PNG, EXR, PDF and SVG can record a resolution, ppm cannot"),
                                     ("a.bpa", ("--metadata",), "--metadata can be recorded in PNG and EXR pictures, not in bpa"),
                                     ("a.exr", ("--bit-depth", 16), "--bit-depth applies to PNG pictures, and this one is exr"),
                                     ("a.png", ("--bit-depth", 12), "8 or 16")):
            self.fail_with(2, "render", "scene.json", "-o", name, *options, says=words)
        self.assertEqual(self.files(), ["scene.json"])


cli.main()
