"""Images through the program: every kind of file, damaged ones, written and read back, in all forms; and how much sooner a picture
is done when rays are sent to where an image is bright.

In:    images that scripts/images packs, or pictures that the program has written.   Knows: the files' formats.
"""
import importlib.machinery
import importlib.util
import json
import os
import struct
import zlib

from cli import SOURCE, ProgramTest, deep, main, scene
from pfm import read_pfm

loader = importlib.machinery.SourceFileLoader("images", os.path.join(SOURCE, "scripts/images"))
images = importlib.util.module_from_spec(importlib.util.spec_from_loader("images", loader))
loader.exec_module(images)

WIDTH, HEIGHT = 6, 4


def number(x, y, c):
    return (37 * x + 91 * y + 53 * c + 7 * x * y) % 256


def colours(x, y):
    return [number(x, y, c) for c in range(3)]


def shares(x, y):
    return [number(x, y, c) / 255 for c in range(3)]


def wide(x, y):
    return [257 * n for n in colours(x, y)]


def adam7(texel):
    """An interlaced PNG."""
    rows = b""
    for x0, y0, dx, dy in ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)):
        for y in range(y0, HEIGHT, dy):
            row = bytes(n for x in range(x0, WIDTH, dx) for n in texel(x, y))
            rows += b"\0" + row if row else b""
    head = struct.pack(">2I5B", WIDTH, HEIGHT, 8, 2, 0, 0, 1)
    return (b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", head) + images.chunk(b"IDAT", zlib.compress(rows)) +
            images.chunk(b"IEND", b""))


def palette(texel):
    entries = [bytes(texel(x, y)) for y in range(HEIGHT) for x in range(WIDTH)]
    rows = b"".join(b"\0" + bytes(range(y * WIDTH, (y + 1) * WIDTH)) for y in range(HEIGHT))
    return (b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", struct.pack(">2I5B", WIDTH, HEIGHT, 8, 3, 0, 0, 0)) +
            images.chunk(b"PLTE", b"".join(entries)) + images.chunk(b"IDAT", zlib.compress(rows)) + images.chunk(b"IEND", b""))


def big_endian(texel):
    rows = b"".join(struct.pack(">3f", *texel(x, y)) for y in reversed(range(HEIGHT)) for x in range(WIDTH))
    return b"PF %d %d 1.0\n" % (WIDTH, HEIGHT) + rows


def document(file="a.png", member="albedo", material=None, texture=None, **more):
    textures = {"t": {"type": "image", "file": file, **(texture or {})}}
    matte = {"type": "lambertian", "albedo": [0.5, 0.5, 0.5], member: {"texture": "t"}}
    return scene(materials={"m": material or matte}, textures=textures, **more)


class Images(ProgramTest):
    def picture(self, name, *options):
        return self.succeed("render", name, "-o", "-", "--format", "pfm", "-q", *options).stdout

    def refused(self, file, content, *says, **how):
        if content is not None:
            self.write(file, content)
        self.write("s.json", document(file, **how))
        self.fail_with(2, "render", "s.json", "-o", "x.png", says=[file, *says])
        self.assertFalse(os.path.exists(self.path("x.png")))

    def test_formats(self):
        """The same numbers in every kind of file are the same picture, bit for bit."""
        files = {"a.png": images.png(WIDTH, HEIGHT, colours), "deep.png": images.png(WIDTH, HEIGHT, wide, 16),
                 "alpha.png": images.png(WIDTH, HEIGHT, lambda x, y: [*colours(x, y), 9 * x], 8, 4),
                 "interlaced.png": adam7(colours), "palette.png": palette(colours),
                 "a.pfm": images.pfm(WIDTH, HEIGHT, shares), "big.pfm": big_endian(shares),
                 "lines.exr": images.exr(WIDTH, HEIGHT, shares), "tiles.exr": images.exr(WIDTH, HEIGHT, shares, tile=3),
                 "alpha.exr": images.exr(WIDTH, HEIGHT, lambda x, y: [*shares(x, y), 0.5], "RGBA")}
        first = None
        for name, content in files.items():
            self.write(name, content)
            linear = {"encoding": "linear"} if name.endswith("png") else {}
            self.write("s.json", document(name, texture=linear))
            picture = self.picture("s.json")
            first = first or picture
            self.assert_same(picture, first, name)
        gray = {"gray.png": images.png(WIDTH, HEIGHT, lambda x, y: [number(x, y, 0)], 8, 1),
                "gray.pfm": images.pfm(WIDTH, HEIGHT, lambda x, y: shares(x, y)[:1], 1),
                "gray.exr": images.exr(WIDTH, HEIGHT, lambda x, y: shares(x, y)[:1], "Y")}
        pictures = []
        for name, content in gray.items():
            self.write(name, content)
            self.write("s.json", document(name, texture={"encoding": "linear"}))
            pictures.append(self.picture("s.json"))
        self.assertTrue(pictures[0] == pictures[1] == pictures[2] != first)

    def test_palettes(self):
        """Of 1, 2, 4 and 8 bits, whole or with numbers beyond them: those are black, which is said with their count."""
        for bits, count in ((1, 1), (2, 3), (4, 9), (4, 16), (8, 60)):
            numbers = [[(5 * y + 3 * x) % 2 ** bits for x in range(WIDTH)] for y in range(HEIGHT)]
            entries = [(40 + i % 200, (77 * i) % 256, 255 - i % 256) for i in range(count)]
            rows = b""
            for row in numbers:
                text = "".join(f"{n:0{bits}b}" for n in row)
                text += "0" * (-len(text) % 8)
                rows += b"\0" + bytes(int(text[i:i + 8], 2) for i in range(0, len(text), 8))
            self.write("p.png", b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", struct.pack(">2I5B", WIDTH, HEIGHT, bits, 3, 0, 0, 0)) +
                       images.chunk(b"PLTE", bytes(sum(entries, ()))) + images.chunk(b"tRNS", b"\0") +
                       images.chunk(b"IDAT", zlib.compress(rows)) + images.chunk(b"IEND", b""))
            self.write("a.png", images.png(WIDTH, HEIGHT, lambda x, y: (entries + [(0, 0, 0)] * 256)[numbers[y][x]]))
            self.write("s.json", document("p.png"))
            self.write("t.json", document("a.png"))
            self.assert_same(self.picture("s.json"), self.picture("t.json"), (bits, count))
            outside = sum(n >= count for row in numbers for n in row)
            said = self.succeed("render", "s.json", "-o", "x.png").errors
            if outside > 0:
                self.assertIn(f"{outside} texel{'s' * (outside > 1)} of a colour that its palette lacks: black", said)
            else:
                self.assertNotIn("palette", said)

    def test_srgb_and_scale(self):
        """One texel: what it stands for is what a lamp of it shows."""
        lamp = {"type": "diffuse_light", "emit": {"texture": "t"}}
        self.write("a.png", images.png(1, 1, lambda x, y: (188, 10, 255)))
        light = (((188 / 255 + 0.055) / 1.055) ** 2.4, 10 / 255 / 12.92, 1)
        for texture, expected in (({}, light), ({"encoding": "linear"}, (188 / 255, 10 / 255, 1)),
                                  ({"encoding": "srgb", "scale": 8}, [8 * value for value in light])):
            self.write("s.json", document(material=lamp, texture=texture, camera={"vfov": 1, "samples_per_pixel": 1}))
            for found, value in zip(read_pfm(self.picture("s.json"))[2], expected):
                self.assertAlmostEqual(found / value, 1, delta=3e-6)

    @deep
    def test_own_pictures(self):
        """What the program writes it reads: as an image around, a mirror shows it; ZIP in an EXR."""
        self.write("sky.json", scene(width=32, spheres=[], background={"bottom": [0.2, 3, 0.5], "top": [2, 1, 0.1]}))
        for name in ("sky.exr", "sky.pfm"):
            self.succeed("render", "sky.json", "-q", "-o", name)
        pictures = []
        for name in ("sky.exr", "sky.pfm"):
            self.write("s.json", scene(background={"image": name}))
            pictures.append(self.picture("s.json"))
        self.assert_same(*pictures)

    def test_poles_and_seam(self):
        """At a pole the first row shows alone, at the seam both edges alike, and clamped each of them its own."""
        lamp = {"type": "diffuse_light", "emit": {"texture": "t"}}
        top = (0.25, 0.5, 0.75)
        self.write("a.pfm", images.pfm(4, 3, lambda x, y: top if y == 0 else (x, x, x)))
        camera = {"pixel_sampling": "center", "samples_per_pixel": 1, "image_width": 1, "vfov": 10}
        for repeat in ([1, 1], [3, 2]):
            self.write("s.json", document("a.pfm", material=lamp, texture={"repeat": repeat},
                                          spheres=[{"center": [0, -2, 0], "radius": 1, "material": "m"}],
                                          camera={**camera, "lookat": [0, -1, 0], "vup": [0, 0, 1]}))
            self.assertEqual(tuple(read_pfm(self.picture("s.json"))[2]), top)
        for wrap, values in (("repeat", (1.5, 1.5)), ("clamp", (0, 3))):
            for z, value in zip((1e-4, -1e-4), values):
                self.write("s.json", document("a.pfm", material=lamp, texture={"wrap": wrap},
                                              spheres=[{"center": [0, 0, 0], "radius": 1, "material": "m"}],
                                              camera={**camera, "lookfrom": [-3, 0, z], "lookat": [0, 0, z]}))
                for found in read_pfm(self.picture("s.json"))[2]:
                    self.assertAlmostEqual(found, value, delta=1e-3, msg=(wrap, z))

    @deep
    def test_middle_of_an_environment(self):
        """Which way an image around is: its middle at -z, its right at x, its top up; turned to the left."""
        texel = lambda x, y: (x, y, 0)
        self.write("sky.pfm", images.pfm(8, 4, texel))
        camera = {"pixel_sampling": "center", "samples_per_pixel": 1, "image_width": 1, "vfov": 1}
        for background, lookat, found in (({}, [0, 0, -1], (3.5, 1.5)), ({}, [1, 0, 0], (5.5, 1.5)), ({}, [-1, 0, 0], (1.5, 1.5)),
                                          ({}, [0, 1, -1e-3], (None, 0)), ({}, [0, 1, -1], (3.5, 0.5)), ({"turn": 90}, [-1, 0, 0], (3.5, 1.5)),
                                          ({"turn": 90}, [0, 0, -1], (5.5, 1.5)), ({"up": [0, 0, 1]}, [0, 1, 0], (3.5, 1.5)),
                                          ({"up": [0, 0, 1]}, [0, 0, 1], (None, 0))):
            vup = [1, 0, 0] if lookat[0] == 0 else [0, 1, 0]
            self.write("s.json", scene(spheres=[], background={"image": "sky.pfm", **background},
                                       camera={**camera, "lookat": lookat, "vup": vup}))
            for value, expected in zip(read_pfm(self.picture("s.json"))[2], found):
                if expected is not None:
                    self.assertAlmostEqual(value, expected, delta=1e-4, msg=(background, lookat))

    def test_refused(self):
        png, pfm, exr = images.png(WIDTH, HEIGHT, colours), images.pfm(WIDTH, HEIGHT, shares), images.exr(WIDTH, HEIGHT, shares)
        self.refused("none.png", None, "s.json:1:", "textures.t.file", "No such file")
        self.refused("a.txt", b"hello", "found a text, expected an image", "PNG, JPEG, OpenEXR, PFM or Radiance (.hdr)", "an image of s.json:1:")
        self.refused("a.png", b"", "found an empty file")
        self.refused("a.png", png[:60], "found a damaged PNG file")
        self.refused("a.png", png[:40] + b"?" + png[41:], "found a damaged PNG file")
        self.refused("a.pfm", pfm[:-1], "found 287 bytes behind the header, expected 288")
        self.refused("a.pfm", pfm + b"!", "found 289 bytes")
        self.refused("a.pfm", b"PF\n0 4\n-1\n", "found 0 by 4 texels")
        self.refused("a.pfm", b"PF\n4\n", "found a header that is none")
        self.refused("a.exr", exr[:-5], "found a damaged OpenEXR file")
        self.refused("a.exr", exr[:50], "found a damaged OpenEXR file: its header")
        self.refused("a.exr", images.exr(2, 2, lambda x, y: (1, 1), "GR"), "no channels R, G and B")
        self.refused("a.exr", exr, "whose numbers are linear", texture={"encoding": "srgb"})
        # A few bytes that ask for much.
        huge = b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", struct.pack(">2I5B", 60000, 60000, 16, 6, 0, 0, 0))
        self.refused("a.png", huge + images.chunk(b"IDAT", b""), "expected at least")
        self.refused("a.pfm", b"PF\n60000 60000\n-1\n", "found 0 bytes behind the header")
        self.refused("a.exr", exr.replace(struct.pack("<4i", 0, 0, 5, 3), struct.pack("<4i", 0, 0, 20000, 20000)), "20001 by 20001 texels",
                     "134217728")

    def test_texels_have_their_place(self):
        for value, said in ((float("nan"), "NaN"), (float("inf"), "inf"), (-float("inf"), "-inf"), (2e12, "2e+12")):
            self.refused("a.pfm", images.pfm(5, 4, lambda x, y: (0, 0, value) if (x, y) == (3, 1) else (0, 0, 0)),
                         f"found {said} as the blue of the texel in column 3 of row 1")
            self.refused("a.exr", images.exr(5, 4, lambda x, y: (0, value, 0) if (x, y) == (4, 2) else (0, 0, 0)),
                         f"found {said} as the green of the texel in column 4 of row 2")
        steel = {"type": "metal", "albedo": [0.5] * 3, "fuzz": {"texture": "t"}}
        self.write("a.png", images.png(WIDTH, HEIGHT, colours))
        self.write("bright.pfm", images.pfm(600, 1, lambda x, y: (0.5, 1.25, 0)))
        for changes, said in (({"material": steel}, "materials.m.fuzz: found an image with colours"),
                              ({"file": "bright.pfm"}, "materials.m.albedo: found 1.25, expected shares of light from 0 to 1"),
                              ({"file": "bright.pfm", "texture": {"repeat": [60000, 1]}}, "textures.t.repeat: found 60000 times 600 texels")):
            self.write("s.json", document(**changes))
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=["s.json:1:", said])

    def test_written_and_moved(self):
        os.mkdir(self.path("maps"))
        self.write("maps/a.pfm", images.pfm(WIDTH, HEIGHT, shares))
        texture = {"scale": 0.5, "wrap": "clamp", "up": [1, 2, 0], "turn": 30, "repeat": [2, 1]}
        self.write("s.json", document("maps/a.pfm", texture=texture, background={"image": "maps/a.pfm", "turn": 12, "up": [0, 0, 1]}))
        written = self.succeed("scene", "s.json").stdout
        again = json.loads(written)
        self.assertEqual(again["textures"]["t"], {"type": "image", "file": "maps/a.pfm", **texture})
        self.assertEqual(again["background"], {"image": "maps/a.pfm", "turn": 12, "up": [0, 0, 1]})
        self.succeed("scene", "s.json", "-o", "maps/moved.json")
        self.assertEqual(json.loads(self.read("maps/moved.json"))["background"]["image"], "a.pfm")
        picture = self.picture("s.json")
        self.assert_same(self.picture("maps/moved.json"), picture)
        self.assert_different(self.picture("s.json", "--set", "textures.t.wrap=repeat"), picture)
        # Another light replaces the image.
        self.assert_different(self.picture("s.json", "--lighting", "studio"), picture)
        self.assertNotIn("image", json.loads(self.succeed("scene", "s.json", "--lighting", "studio").stdout).get("background", {}))

    def sunny(self, **more):
        self.write("sun.pfm", images.pfm(24, 12, images.sun))
        self.write("light.pfm", images.pfm(4, 2, lambda x, y: (x, y, 1)))
        materials = {"m": {"type": "lambertian", "albedo": [0.6, 0.5, 0.4]}, "n": {"type": "metal", "albedo": [0.9] * 3, "fuzz": 0.4},
                     "l": {"type": "diffuse_light", "emit": {"texture": "t"}}}
        spheres = [{"center": [0, -100.5, -1], "radius": 100, "material": "m"}, {"center": [-0.6, 0, -1.2], "radius": 0.5, "material": "n"},
                   {"center": [0.6, 0, -1.2], "radius": 0.5, "material": "m"}, {"center": [0, 0.7, -1.2], "radius": 0.2, "material": "l"}]
        background = {"image": "sun.pfm", "discs": [{"direction": [1, 1, 1], "half_angle": 5, "radiance": [9, 9, 9]}]}
        return scene(materials=materials, spheres=spheres, background=background, textures={"t": {"type": "image", "file": "light.pfm"}}, **more)

    @deep
    def test_forms_give_the_same_picture(self):
        self.write("s.json", self.sunny())
        for precision in ("single", "double"):
            first = self.picture("s.json", "--precision", precision)
            for options in (["--kernel", "sample"], ["--effects", "all"], ["--kernel", "sample", "--effects", "all"]):
                self.assert_same(self.picture("s.json", "--precision", precision, *options), first, options)

    @deep
    def test_explained(self):
        self.write("s.json", self.sunny())
        table = self.succeed("explain", "s.json", "--wide").stdout.decode()
        self.assertRegex(table, r"images +in +1 material with images, on 1 of 4 spheres")
        self.assertRegex(table, r"environment +in +an image of 24 by 12 texels")
        self.assertRegex(table, r"light_sampling +in +the image around, 1 lamp and 1 disc that can light 3 spheres")
        seen = set()
        for x in range(16):
            entry = json.loads(self.succeed("explain", "s.json", "--pixel", f"{x},13", "--json", "-").stdout)["scenes"][0]
            for step in entry["path"]["steps"]:
                seen.update(step.get("lamp_ray", {}))
        self.assertTrue({"image", "disc"} <= seen, seen)
        text = "".join(self.succeed("explain", "s.json", "--pixel", f"{x},13").stdout.decode() for x in range(16))
        self.assertIn("a ray to the image around brings", text)

    @deep
    def test_films_of_other_images_do_not_merge(self):
        self.write("s.json", self.sunny())
        self.succeed("render", "s.json", "-q", "-o", "a.bpa")
        for option in ("background.turn=1", "background.scale=2", "textures.t.wrap=clamp"):
            self.succeed("render", "s.json", "-q", "--first-sample", 8, "-o", "b.bpa", "--set", option)
            self.fail_with(2, "merge", "a.bpa", "b.bpa", "-o", "c.png", says=["scene"])
        self.write("light.pfm", images.pfm(4, 2, lambda x, y: (3 - x, y, 1)))
        self.succeed("render", "s.json", "-q", "--first-sample", 8, "-o", "b.bpa")
        self.fail_with(2, "merge", "a.bpa", "b.bpa", "-o", "c.png", says=["scene"])

    @deep
    def test_a_sun_is_found(self):
        """A sun of half a degree: its variance is less than a hundredth of what chance leaves. The noise by chance is estimated by
        few hits, so what is taken for it is a tenth of the estimate."""
        sun = lambda x, y: (30000.0, 27000.0, 20000.0) if x in (300, 301) and y in (90, 91) else (0.3, 0.5, 0.9) if y < 180 else (0.1, 0.1, 0.1)
        self.write("sky.pfm", images.pfm(720, 360, sun))
        self.write("s.json", scene(width=32, background={"image": "sky.pfm"},
                                   spheres=[{"center": [0, -100, 0], "radius": 100, "material": "m"}],
                                   camera={"lookfrom": [0, 3, 3], "lookat": [0, 0, 0], "vfov": 20, "max_depth": 2}))
        noise = {}
        for lamps, samples in (("on", 64), ("off", 1024)):
            self.succeed("render", "s.json", "-q", "-o", "x.pfm", "--light-sampling", lamps, "--spp", samples, "--stats", "x.json")
            noise[lamps] = json.loads(self.read("x.json"))["nrmse"] ** 2 * samples
        self.assertGreater(noise["off"] / 10 / noise["on"], 100, noise)

    @deep
    def test_sixteen_thousand_columns(self):
        """The largest image: as texture and around. Black but for a few texels, so that it packs well."""
        with open("/proc/meminfo", encoding="ascii") as file:
            free = next(int(line.split()[1]) for line in file if line.startswith("MemAvailable"))
        if free < 12 << 20:
            self.skipTest("less than 12 GiB of memory free")
        width, height = 16384, 8192
        pack, data = zlib.compressobj(1), []
        dark, bright = b"\0" + bytes(3 * width), bytearray(b"\0" + bytes(3 * width))
        bright[1 + 3 * 8000:1 + 3 * 8010] = b"\xff" * 30
        for row in range(height):
            data.append(pack.compress(bytes(bright) if 1000 <= row < 1010 else dark))
        data.append(pack.flush())
        head = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)
        self.write("a.png", b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", head) + images.chunk(b"IDAT", b"".join(data)) +
                   images.chunk(b"IEND", b""))
        background = {"image": "a.png", "scale": 1e5}
        # One sphere that fills the picture, under light from one side: no shadows, no edges.
        self.write("s.json", scene(background=background, spheres=[{"center": [0, -100, 0], "radius": 100, "material": "m"}],
                                   camera={"lookfrom": [0, 3, 3], "lookat": [0, 0, 0], "vfov": 20}))
        self.succeed("render", "s.json", "-q", "-o", "x.pfm", "--spp", 256, "--stats", "x.json")
        stats = json.loads(self.read("x.json"))
        self.assertTrue(stats["nrmse"] < 0.05 and stats["mean_radiance"][0] > 0, stats)
        self.write("s.json", document(background=background))
        self.fail_with(2, "render", "s.json", "-o", "y.png", says=["of which 0 are left", "use a smaller image"])


if __name__ == "__main__":
    main()
