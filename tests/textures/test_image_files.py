"""Images as other programs write them: what a file says of its windows, layers and colours holds, and what is changed or left out is
said.

In:    files made here, by the formats' documents.   Out: pictures, compared with those of a plain file of the texels that are right,
       or with numbers that others have published.
"""
import struct
import zlib

from cli import ProgramTest, main, scene
from jpeg import jpeg
from pfm import read_pfm
from test_images import images

WIDTH, HEIGHT = 12, 6
WHOLE = (0, 0, WIDTH - 1, HEIGHT - 1)
REC709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)


# From linear colours of these primaries to linear Rec. 709: XYZ by IEC 61966-2-1 with seven digits (B. Lindbloom), ACES by the
# Academy's transforms, Rec. 2020 by ITU-R BT.2087, Display P3 by CSS Color 4.
MATRICES = {
    "xyz": ((1, 0, 0, 1, 0, 0, 1 / 3, 1 / 3),
            ((3.2404542, -1.5371385, -0.4985314), (-0.9692660, 1.8760108, 0.0415560), (0.0556434, -0.2040259, 1.0572252))),
    "ap0": ((0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767),
            ((2.5216862, -1.1341310, -0.3875552), (-0.2764799, 1.3727191, -0.0962392), (-0.0153781, -0.1529753, 1.1683534))),
    "ap1": ((0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767),
            ((1.7050510, -0.6217921, -0.0832589), (-0.1302564, 1.1408047, -0.0105483), (-0.0240034, -0.1289690, 1.1529723))),
    "2020": ((0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329),
             ((1.660491, -0.587641, -0.072850), (-0.124550, 1.132900, -0.008349), (-0.018151, -0.100579, 1.118730))),
    "p3": ((0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329),
           ((1.2249402, -0.2249402, 0), (-0.0420570, 1.0420570, 0), (-0.0196376, -0.0786361, 1.0982736)))}


def share(x, y, c):
    return (37 * (x + 9) + 91 * (y + 9) + 53 * c + 7 * x * y) % 256 / 255


def channel(c):
    return lambda x, y: share(x, y, c)


RGB = {"R": channel(0), "G": channel(1), "B": channel(2)}


def part(channels, data=WHOLE, display=WHOLE, tile=None, kind=2, more=(), name=None):
    """One part of an EXR: its attributes and its blocks. Pixels are asked for by their places in the file's own frame."""
    x0, y0, x1, y1 = data
    order, letter = sorted(channels), {0: "I", 1: "e", 2: "f"}[kind]
    listing = b"".join(n.encode() + b"\0" + struct.pack("<iB3xii", kind, 0, 1, 1) for n in order) + b"\0"
    values = [("channels", "chlist", listing), ("compression", "compression", b"\0"), ("dataWindow", "box2i", struct.pack("<4i", *data)),
              ("displayWindow", "box2i", struct.pack("<4i", *display)), ("lineOrder", "lineOrder", b"\0"),
              ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", bytes(8)),
              ("screenWindowWidth", "float", struct.pack("<f", 1)), *more]

    def block(columns, rows):
        lines = b"".join(struct.pack(f"<{len(columns)}{letter}", *(channels[n](x, y) for x in columns)) for y in rows for n in order)
        return struct.pack("<I", len(lines)) + lines
    if tile:
        values.append(("tiles", "tiledesc", struct.pack("<IIB", tile, tile, 0)))
        blocks = [struct.pack("<4i", (x - x0) // tile, (y - y0) // tile, 0, 0) +
                  block(range(x, min(x + tile, x1 + 1)), range(y, min(y + tile, y1 + 1)))
                  for y in range(y0, y1 + 1, tile) for x in range(x0, x1 + 1, tile)]
    else:
        blocks = [struct.pack("<i", y) + block(range(x0, x1 + 1), [y]) for y in range(y0, y1 + 1)]
    if name:
        values += [("name", "string", name.encode()), ("type", "string", b"tiledimage" if tile else b"scanlineimage"),
                   ("chunkCount", "int", struct.pack("<i", len(blocks)))]
    head = b"".join(n.encode() + b"\0" + k.encode() + b"\0" + struct.pack("<I", len(v)) + v for n, k, v in values) + b"\0"
    return head, blocks, bool(tile)


def exr(*parts):
    several = len(parts) > 1
    flags = 0x1000 if several else 0x200 if parts[0][2] else 0
    head = struct.pack("<II", 20000630, 2 | flags) + b"".join(p[0] for p in parts) + (b"\0" if several else b"")
    place, table, content = len(head) + 8 * sum(len(p[1]) for p in parts), b"", b""
    for number, (_, blocks, _) in enumerate(parts):
        for each in blocks:
            table += struct.pack("<Q", place + len(content))
            content += (struct.pack("<i", number) if several else b"") + each
    return head + table + content


def chromaticities(values):
    return [("chromaticities", "chromaticities", struct.pack("<8f", *values))]


def seen(channels, data, display):
    """The texels that are right: those of the display window, black where there are no data."""
    def texel(x, y):
        place = (x + display[0], y + display[1])
        inside = data[0] <= place[0] <= data[2] and data[1] <= place[1] <= data[3]
        return [channels[c](*place) if inside else 0 for c in "RGB"]
    return images.pfm(display[2] - display[0] + 1, display[3] - display[1] + 1, texel)


def png(chunks, texels=((188, 100, 30),), kind=2, bits=8):
    """One row; `kind`: 0 grey, 2 colours, 3 a palette, and 4 more with alpha."""
    body = b"\0" + b"".join(n.to_bytes(bits // 8, "big") for texel in texels for n in texel)
    head = struct.pack(">2I5B", len(texels), 1, bits, kind, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + images.chunk(b"IHDR", head) + b"".join(images.chunk(k, v) for k, v in chunks) +
            images.chunk(b"IDAT", zlib.compress(body)) + images.chunk(b"IEND", b""))


def linear(byte):
    value = byte / 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


class ImageFiles(ProgramTest):
    def around(self, file, content):
        """What is seen of an image around, in front and behind, and what is said."""
        self.write(file, content)
        for name, z in (("s", -1), ("behind", 1)):
            self.write(f"{name}.json", scene(width=24, spheres=[], background={"image": file}, camera={"vfov": 110, "lookat": [0, 0, z]}))
        # In one run, since starting the program takes longer than drawing.
        result = self.succeed("render", "s.json", "behind.json", "-o", "./", "--format", "pfm")
        pictures = [self.read("s.pfm"), self.read("behind.pfm")]
        said = self.words(result.errors.split("./s.pfm")[0])
        return pictures, said

    @staticmethod
    def words(text):
        return " ".join(text.split())

    def texel(self, file, content, **texture):
        """The colour of the first texel of an image, as light of a lamp, and what is said."""
        self.write(file, content)
        lamp = {"type": "diffuse_light", "emit": {"texture": "t"}}
        self.write("s.json", scene(materials={"m": lamp}, textures={"t": {"type": "image", "file": file, **texture}},
                                   camera={"vfov": 1, "samples_per_pixel": 1}))
        result = self.succeed("render", "s.json", "-o", "x.pfm")
        return list(read_pfm(self.read("x.pfm"))[2])[:3], self.words(result.errors.split("x.pfm")[0])

    def assert_near(self, found, expected, delta, message=None):
        for value, right in zip(found, expected, strict=True):
            self.assertAlmostEqual(value, max(0, right), delta=delta, msg=message)

    def test_windows(self):
        """Black where the display window has no data; what lies around it is not shown."""
        for name, data, display in (("part", (2, 1, 6, 3), WHOLE), ("overscan", (-3, -2, 13, 8), WHOLE),
                                    ("negative", (-5, -4, 6, 1), (-5, -4, 6, 1)), ("shifted", (7, 2, 20, 9), (3, 1, 14, 6)),
                                    ("both", (-4, 2, 5, 11), WHOLE)):
            for tile in (None, 4):
                expected, _ = self.around("right.pfm", seen(RGB, data, display))
                for kind in (1, 2):
                    halves = {c: lambda x, y, f=f: struct.unpack("<e", struct.pack("<e", f(x, y)))[0] for c, f in RGB.items()}
                    channels = halves if kind == 1 else RGB
                    right = self.around("right.pfm", seen(channels, data, display))[0] if kind == 1 else expected
                    found, said = self.around("a.exr", exr(part(channels, data, display, tile, kind)))
                    self.assertEqual(found, right, (name, tile, kind))
                columns = min(data[2], display[2]) - max(data[0], display[0]) + 1
                rows = min(data[3], display[3]) - max(data[1], display[1]) + 1
                texels = (display[2] - display[0] + 1) * (display[3] - display[1] + 1)
                pixels = (data[2] - data[0] + 1) * (data[3] - data[1] + 1)
                for count, sentence in ((texels - columns * rows, f"data for {columns * rows} of {texels} texels, and the others are black"),
                                        (pixels - columns * rows, f"{pixels - columns * rows} pixels outside its display window are left out")):
                    (self.assertIn if count else self.assertNotIn)(sentence, said, name)
        found, said = self.around("a.exr", exr(part(RGB, (100, 100, 103, 103))))
        self.assertFalse(any(read_pfm(found[0])[2]))
        self.assertIn("data for 0 of 72 texels", said)

    def test_compressions(self):
        """B44 packs 4 x 4 half floats into 14 bytes, or 3 where all are alike, and leaves other kinds of numbers, channel by channel."""
        halves = {"R": 0x3800, "G": 0x3c00, "B": 0x4000}  # 0.5, 1, 2
        value = {c: struct.unpack("<e", struct.pack("<H", bits))[0] for c, bits in halves.items()}
        plain = {c: lambda x, y, v=v: v for c, v in value.items()}

        def packed(kind, window, compression, body, channels):
            head, _, _ = part(channels, window, window, kind=kind)
            name = b"compression\0compression\0" + struct.pack("<I", 1)
            return exr((head.replace(name + b"\0", name + bytes([compression])), [struct.pack("<iI", 0, len(body)) + body], False))

        blocks = b"".join(struct.pack(">HB", 0x8000 | halves[c], 0xfc) * 6 for c in "BGR")
        right, _ = self.around("right.pfm", seen(plain, WHOLE, WHOLE))
        for compression in 6, 7:
            self.assertEqual(self.around("a.exr", packed(1, WHOLE, compression, blocks, plain))[0], right)
        small = (0, 0, 1, 0)
        lines = b"".join(struct.pack("<2H", *2 * [halves[c]]) for c in "BGR")
        # Left as they are, packed though they become larger, and floats, which may be lines or channels.
        for kind, window, body in (2, WHOLE, b"".join(struct.pack("<72f", *72 * [value[c]]) for c in "BGR")), (1, small, blocks[:18]), (1, small, lines):
            self.write("s.json", scene(spheres=[], background={"image": "a.exr"}))
            self.write("a.exr", packed(kind, window, 6, body, plain))
            self.fail_with(2, "render", "s.json", "--wide", says=["expected another compression, such as ZIP"])

    def test_layers(self):
        """R, G and B without a layer's name come first; else the only layer, or the one that is called the whole."""
        right = self.around("right.pfm", seen(RGB, WHOLE, WHOLE))[0]
        def layer(name, shift=0):
            return {f"{name}.{c}": (f if not shift else lambda x, y, f=f: 1 - f(x, y)) for c, f in RGB.items()}
        vector = {f"Normal.{c}": channel(k + 1) for k, c in enumerate("XYZ")}
        for channels, says in (({**RGB, **layer("other", 1), "A": channel(5)}, ""),
                               (layer("ViewLayer.Combined"), 'the layer "ViewLayer.Combined" is used, of 1 in the file'),
                               ({**layer("diffuse"), **vector}, 'the layer "diffuse" is used, of 1'),
                               ({**layer("A.Combined"), **layer("A.DiffDir", 1)}, 'the layer "A.Combined" is used, of 2'),
                               ({**layer("a.RGBA"), **layer("0.ao", 1)}, 'the layer "a.RGBA" is used, of 2')):
            found, said = self.around("a.exr", exr(part(channels)))
            self.assertEqual(found, right, says)
            self.assertIn(says, said)
            self.assertEqual("layer" in said, says != "", said)
        found, said = self.around("a.exr", exr(part(vector | {"Z": channel(1)}, name="depth"), part(RGB, name="left"),
                                               part({c: f for c, f in zip("RGB", (channel(3), channel(4), channel(5)))}, name="right", tile=5)))
        self.assertEqual(found, right)
        self.assertIn('the layer "left" is used, of 2 in the file', said)
        # Alpha, of the layer that is used and within the display window.
        def clear(x, y):
            return 0.25 if x == 3 and y < 4 else 1
        for channels, note in (({**RGB, "A": clear}, True), ({**RGB, "other.A": clear}, False), ({**layer("beauty"), "beauty.A": clear}, True),
                               ({**layer("beauty"), "A": clear}, False), ({"Y": channel(0), "A": clear}, True), ({**RGB, "A": lambda x, y: 1}, False)):
            for tile, kind in ((None, 2), (4, 1)):
                colours = self.around("b.exr", exr(part({n: f for n, f in channels.items() if not n.endswith("A")}, tile=tile, kind=kind)))[0]
                found, said = self.around("a.exr", exr(part(channels, tile=tile, kind=kind)))
                self.assertEqual(found, colours)
                self.assertEqual(f"its alpha is left out, though 4 of {WIDTH * HEIGHT} texels are not opaque" in said, note, (list(channels), said))
        found, said = self.around("a.exr", exr(part({**RGB, "A": clear}, (2, 1, 6, 3))))
        self.assertIn(f"its alpha is left out, though 3 of {WIDTH * HEIGHT} texels", said)
        luminance = exr(part({"Y": channel(0), "Z": channel(1)}))
        gray = images.pfm(WIDTH, HEIGHT, lambda x, y: [share(x, y, 0)], 1)
        self.assertEqual(self.around("a.exr", luminance)[0], self.around("right.pfm", gray)[0])
        for channels, kind, says in (({**layer("one"), **layer("two")}, 2, 'the layers "one", "two", expected'),
                                     ({"X": channel(0), "Y": channel(1), "Z": channel(2)}, 2, "no channels R, G and B, nor Y alone"),
                                     ({"Y": channel(0), "RY": channel(1), "BY": channel(2)}, 2, "luminance and chroma"),
                                     ({c: lambda x, y: 3 for c in "RGB"}, 0, "whole numbers in channel B")):
            self.write("a.exr", exr(part(channels, kind=kind)))
            self.fail_with(2, "render", "s.json", "-o", "x.png", "--set", "background.image=a.exr", says=["a.exr", says])
        cube = exr(part(RGB, more=[("envmap", "envmap", b"\1")]))
        self.write("a.exr", cube)
        self.fail_with(2, "render", "s.json", "-o", "x.png", "--set", "background.image=a.exr", says=["a.exr", "cube map"])

    def test_chromaticities(self):
        for color in ((0.2, 0.4, 0.6), (0.5, 0.5, 0.5), (3, 2, 0.25)):
            channels = {c: lambda x, y, v=v: v for c, v in zip("RGB", color)}
            for name, (places, matrix) in MATRICES.items():
                expected = [sum(m * v for m, v in zip(row, color)) for row in matrix]
                found, said = self.texel("a.exr", exr(part(channels, more=chromaticities(places))))
                self.assert_near(found, expected, 5e-4 * max(1, *color), (name, color))
                self.assertIn('converted to the primaries of Rec. 709 (the attribute "chromaticities")', said)
                self.assertEqual("below 0" in said, min(expected) < 0, said)
            found, said = self.texel("a.exr", exr(part(channels, more=chromaticities(REC709))))
            self.assertEqual((found, said), ([struct.unpack("f", struct.pack("f", v))[0] for v in color], ""))
        gray = exr(part({"Y": lambda x, y: 0.5}, more=chromaticities(MATRICES["ap0"][0])))
        self.assertEqual(self.texel("a.exr", gray), ([0.5] * 3, ""))
        for places in ([0.0] * 8, (0.6, 0.3, 0.6, 0.3, 0.15, 0.06, 0.3127, 0.329), (*REC709[:7], 0), (float("nan"), *REC709[1:])):
            self.write("a.exr", exr(part(RGB, more=chromaticities(places))))
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=["a.exr", "found primaries that span no colours"])
        # What is not finite is refused at its own place, not at one that the conversion spread it to.
        channels = {**RGB, "B": lambda x, y: float("inf") if (x, y) == (3, 2) else 0}
        self.write("a.exr", exr(part(channels, more=chromaticities(MATRICES["ap1"][0]))))
        self.fail_with(2, "render", "s.json", "-o", "x.png", says=["found inf as the blue of the texel in column 3 of row 2"])

    # ---- Radiance ------------------------------------------------------------------------------------------

    @staticmethod
    def bytes_of(x, y):
        return bytes([(40 * x + 11 * y) % 256, (90 * y + 3 * x) % 256, (7 * x * y + 5) % 256, 120 + (x + y) % 12])

    @classmethod
    def value_of(cls, x, y):
        """Mantissas of eight bits, and the exponent above 128."""
        r, g, b, e = cls.bytes_of(x, y)
        return [m / 256 * 2.0 ** (e - 128) for m in (r, g, b)]

    @staticmethod
    def packed(line):
        """A line of texels, each component by itself, with runs where bytes are equal."""
        out = struct.pack(">BBH", 2, 2, len(line))
        for c in range(4):
            row, i = [t[c] for t in line], 0
            while i < len(row):
                run = 1
                while i + run < len(row) and run < 127 and row[i + run] == row[i]:
                    run += 1
                if run > 2:
                    out, i = out + bytes([128 + run, row[i]]), i + run
                else:
                    end = min(i + 5, len(row))
                    out, i = out + bytes([end - i]) + bytes(row[i:end]), end
        return out

    @staticmethod
    def runs(line):
        """As the first versions wrote: 1, 1, 1 and the digits of how often the texel before is repeated."""
        out, i = b"", 0
        while i < len(line):
            run = 1
            while i + run < len(line) and line[i + run] == line[i]:
                run += 1
            out, left, i = out + line[i], run - 1, i + run
            while left:
                out, left = out + bytes([1, 1, 1, left % 256]), left // 256
        return out

    def hdr(self, size, lines, pack, variables=b"FORMAT=32-bit_rle_rgbe\n", magic=b"#?RADIANCE\n"):
        return magic + variables + b"\n" + size + b"\n" + b"".join(pack(line) for line in lines)

    def test_radiance(self):
        """Each way to pack, and each order of rows and columns, is the same picture as floats."""
        right = self.around("right.pfm", images.pfm(WIDTH, HEIGHT, self.value_of))[0]
        rows = [[self.bytes_of(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]
        columns = [[self.bytes_of(x, y) for y in range(HEIGHT)] for x in range(WIDTH)]
        flat = b"".join
        normal = b"-Y 6 +X 12"
        for size, lines, pack in ((normal, rows, flat), (normal, rows, self.packed), (normal, rows, self.runs),
                                  (b"+Y 6 +X 12", rows[::-1], self.packed), (b"-Y 6 -X 12", [row[::-1] for row in rows], flat),
                                  (b"+X 12 -Y 6", columns, flat), (b"-X 12 +Y 6", [c[::-1] for c in columns[::-1]], flat)):
            found, said = self.around("a.hdr", self.hdr(size, lines, pack))
            self.assertEqual((found, said), (right, ""), size)
        more = b"# made by a test\nSOFTWARE=" + b"x" * 5000 + b"\nFORMAT=32-bit_rle_rgbe\r\nPIXASPECT=1\n"
        self.assertEqual(self.around("a.hdr", self.hdr(normal, rows, self.packed, more, b"#?RGBE\n"))[0], right)
        # A sky of one colour in long runs, of both kinds, over the bounds of one byte.
        plain = [[bytes([128, 64, 32, 129])] * 1000] * 3
        right = self.around("right.pfm", images.pfm(1000, 3, lambda x, y: (1, 0.5, 0.25)))[0]
        for pack in (self.packed, self.runs):
            self.assertEqual(self.around("a.hdr", self.hdr(b"-Y 3 +X 1000", plain, pack))[0], right)

    def test_radiance_variables(self):
        one = lambda variables, texel=(128, 64, 32, 129): self.texel("a.hdr", self.hdr(b"-Y 1 +X 1", [[bytes(texel)]], b"".join, variables))
        self.assertEqual(one(b""), ([1, 0.5, 0.25], ""))
        self.assertEqual(one(b"", (255, 1, 0, 0)), ([0, 0, 0], ""))
        found, said = one(b"EXPOSURE=2\nEXPOSURE= 0.25\nCOLORCORR=4 1 0.5\n")
        self.assertEqual(found, [0.5, 1, 1])
        self.assertIn("its EXPOSURE or COLORCORR is undone: values are multiplied by 0.5, 2 and 4", said)
        for name, variables in (("xyz", b"FORMAT=32-bit_rle_xyze\n"), ("ap1", b"PRIMARIES=0.713 0.293 0.165 0.83 0.128 0.044 0.32168 0.33767\n"),
                                ("2020", b"PRIMARIES= .708 .292 .17 .797 .131 .046 .3127 .329\n")):
            found, said = one(variables)
            self.assert_near(found, [sum(m * v for m, v in zip(row, (1, 0.5, 0.25))) for row in MATRICES[name][1]], 5e-4, name)
            self.assertIn("converted to the primaries of Rec. 709", said)
        self.assertEqual(one(b"PRIMARIES=0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329\n"), ([1, 0.5, 0.25], ""))

    def test_radiance_refused(self):
        self.write("s.json", scene(background={"image": "a.hdr"}))
        rows = [[self.bytes_of(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]
        good = self.hdr(b"-Y 6 +X 12", rows, self.packed)
        for content, says in ((good[:-1], "found the end of the file in line 5 of 6"), (good[:30], "found no end of the header"),
                              (self.hdr(b"-Y 6 +X 12", rows, b"".join)[:-4], "found the end of the file in line 5 of 6"),
                              (self.hdr(b"6 12", rows, self.packed), 'found the line "6 12", expected the size'),
                              (self.hdr(b"-Y 6 +Y 12", rows, self.packed), "expected the size"), (self.hdr(b"-Y 0 +X 12", rows, self.packed), "expected the size"),
                              (self.hdr(b"-Y 6 +X 13", rows, self.packed), "found 12 texels in line 0, expected 13"),
                              (self.hdr(b"-Y 6 +X 70000", rows, self.packed), "70000 by 6 texels"),
                              (self.hdr(b"-Y 1 +X 12", [[b"\2\2\0\x0c\x8d\1"]], b"".join), "found a run that leaves line 0"),
                              (self.hdr(b"-Y 1 +X 12", [[b"\1\1\1\2"]], b"".join), "found a run that leaves line 0"),
                              (self.hdr(b"-Y 6 +X 12", rows, self.packed, b"FORMAT=64-bit\n"), 'found the line "FORMAT=64-bit"'),
                              (self.hdr(b"-Y 6 +X 12", rows, self.packed, b"EXPOSURE=0\n"), 'found the line "EXPOSURE=0", expected numbers above 0')):
            self.write("a.hdr", content)
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=["a.hdr: ", says])

    def test_negative(self):
        """What is below 0 counts as 0, in all formats alike, and is counted."""
        texel = lambda x, y: {(1, 1): (-1e-7, 0.5, -2.5), (4, 2): (0.25, -0.0, 1), (5, 2): (1, 1, -1e30)}.get((x, y), (1, 0.5, 0.25))
        right = self.around("right.pfm", images.pfm(WIDTH, HEIGHT, lambda x, y: [max(0, v) for v in texel(x, y)]))
        self.assertEqual(right[1], "")
        for name, content in (("a.pfm", images.pfm(WIDTH, HEIGHT, texel)), ("a.exr", images.exr(WIDTH, HEIGHT, texel))):
            found, said = self.around(name, content)
            self.assertEqual(found, right[0])
            self.assertIn(f"{name}: 2 of 72 texels have values below 0, down to -1e+30, which count as 0", said)
        self.write("a.pfm", images.pfm(5, 4, lambda x, y: (0, float("-inf") if (x, y) == (2, 3) else 0, 0)))
        self.write("s.json", scene(background={"image": "a.pfm"}))
        self.fail_with(2, "render", "s.json", "-o", "x.png", says=["found -inf as the green of the texel in column 2 of row 3"])

    def test_pfm_headers(self):
        color = (0.25, 0.5, 4)
        little, big = struct.pack("<3f", *color), struct.pack(">3f", *color)
        for content in (b"PF\n1 1\n-1\n" + little, b"PF\n#?RADIANCE\n1 1\n-1.0\n" + little, b"PF 1 1 -1 " + little,
                        b"PF\r\n1 1\r\n-1.0\r\n" + little, b"PF\n# a\n# b 3\n\n1\n# c\n1\n-1.000000\n" + little, b"PF  1\t1 \n -1 \n" + little,
                        b"PF\n1 1\n1.0\n" + big, b"PF\n1 1\n+1\r\n" + big):
            self.assertEqual(self.texel("a.pfm", content), (list(color), ""), content)
        self.assertEqual(self.texel("a.pfm", b"Pf\n#x\n1 1\n-1\n" + little[8:]), ([4.0] * 3, ""))
        found, said = self.texel("a.pfm", b"PF\n1 1\n2.5\n" + big)
        self.assertEqual(found, list(color))
        self.assertIn("a.pfm: the factor 2.5 of its header is not used", said)
        # The first byte of a number may look like white space.
        odd = struct.pack("<I", 0x3e0a0d20) + struct.pack("<2f", 1, 1)
        self.assertEqual(self.texel("a.pfm", b"PF\n1 1\n-1\n" + odd)[0], [struct.unpack("<f", odd[:4])[0], 1, 1])
        for content in (b"PF\n1 1\n-1\n" + little[:-1], b"PF\n1 1\n-1\n!" + little, b"PF\n#", b"PF\n1 1\n-1" + little):
            self.write("a.pfm", content)
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=["a.pfm"])

    def test_png_colors(self):
        """gAMA and cHRM are followed where nothing overrides them; the other spaces are named."""
        srgb = [linear(v) for v in (188, 100, 30)]
        gamma = lambda value: (b"gAMA", struct.pack(">I", value))
        places = lambda p: (b"cHRM", struct.pack(">8I", *(round(1e5 * v) for v in (*p[6:], *p[:6]))))
        p3, matrix = MATRICES["p3"]
        profile = lambda text: (b"iCCP", b"name\0\0" + zlib.compress(self.profile(text), 0))
        power = lambda e: [(v / 255) ** e for v in (188, 100, 30)]
        converted = [sum(m * v for m, v in zip(row, srgb)) for row in matrix]
        for chunks, expected, says in (
                ([], srgb, ""), ([gamma(45455), places(REC709)], srgb, ""), ([(b"sRGB", b"\0")], srgb, ""), ([gamma(45000)], srgb, ""),
                ([gamma(100000)], power(1), "decoded by the gamma of its gAMA chunk, 1"),
                ([gamma(55556)], power(1.8), "decoded by the gamma of its gAMA chunk, 0.5556"),
                ([places(p3)], converted, "converted to the primaries of Rec. 709 (its cHRM chunk)"),
                ([(b"cICP", bytes([9, 16, 0, 1]))], srgb, "(primaries 9, curve 16 of its cICP chunk) is not known: read as sRGB"),
                ([(b"cICP", bytes([1, 13, 0, 1])), gamma(100000)], srgb, ""),
                ([profile(b"Adobe RGB (1998)"), gamma(100000)], srgb, 'its ICC profile "name" is not applied: read as sRGB'),
                # Damaged chunks, or such as do not suit the pixels, which libpng leaves out.
                ([(b"iCCP", b"Adobe RGB\0\0" + zlib.compress(bytes(200)))], srgb, "since a chunk is not used (iCCP: "),
                ([(b"gAMA", b"\0\1")], srgb, "since a chunk is not used (gAMA: "), ([(b"cHRM", bytes(31))], srgb, "since a chunk is not used (cHRM: "),
                ([(b"tEXt", b"no keyword")], srgb, ""), ([(b"sBIT", b"\9")], srgb, ""),
                ([profile(b"sRGB IEC61966-2.1")], srgb, ""), ([profile("sRGB".encode("utf-16-be"))], srgb, "")):
            found, said = self.texel("a.png", png(chunks))
            self.assert_near(found, expected, 5e-6 if expected is not converted else 2e-4, (chunks, said))
            self.assertIn(says, said)
            self.assertEqual(said == "", says == "", said)
        # The scene's word is above the file's.
        self.assert_near(self.texel("a.png", png([gamma(100000)]), encoding="srgb")[0], srgb, 5e-6)
        found, said = self.texel("a.png", png([gamma(55556), places(p3)]), encoding="linear")
        self.assert_near(found, power(1), 5e-6)
        self.assertEqual(said, "")
        self.assertEqual(self.texel("a.png", png([places(p3)], [(128,)], kind=0))[1], "")

    @staticmethod
    def exif(order, value, tag=0x0112):
        entries = [struct.pack(order + "HHIHH", 0x010f, 3, 1, 8, 0), struct.pack(order + "HHIHH", tag, 3, 1, value, 0)]
        return (b"MM\0*" if order == ">" else b"II*\0") + struct.pack(order + "IH", 8, len(entries)) + b"".join(entries) + bytes(4)

    def test_png_orientation(self):
        """Exif data of both byte orders, before and behind the texels; damaged data has no orientation."""
        srgb, exif = [linear(v) for v in (188, 100, 30)], self.exif

        for order in "<>":
            for value, says in ((1, ""), (2, "mirrored"), (3, "read upside down"), (4, "mirrored and turned"), (6, "turned by 90 degrees"),
                                (8, "turned by 90 degrees"), (9, ""), (0, "")):
                whole = exif(order, value)
                behind = png([])[:-12] + images.chunk(b"eXIf", whole) + png([])[-12:]
                for content in (png([(b"eXIf", whole)]), behind):
                    found, said = self.texel("a.png", content)
                    self.assert_near(found, srgb, 5e-6)
                    self.assertEqual(said == "", says == "", said)
                    self.assertIn(f"its Exif orientation, {value}, is not applied" if says else "", said)
                    self.assertIn(says, said)
            self.assertEqual(self.texel("a.png", png([(b"eXIf", exif(order, 6, 0x0111))]))[1], "")
            for size in range(4, 30):
                self.assert_near(self.texel("a.png", png([(b"eXIf", exif(order, 6)[:size])]))[0], srgb, 5e-6)
            for far in (exif(order, 6)[:4] + b"\xff" * 4 + exif(order, 6)[8:], exif(order, 6)[:8] + b"\xff\xff" + exif(order, 6)[10:]):
                self.assert_near(self.texel("a.png", png([(b"eXIf", far)]))[0], srgb, 5e-6)

    # ---- JPEG ----------------------------------------------------------------------------------------------

    def test_jpeg(self):
        """Grey and colours, whole and halved, in one scan and in several: the picture of the bytes that were packed, to two of 255."""
        noisy = lambda x, y: [round(255 * share(x, y, c)) for c in range(3)]
        smooth = lambda x, y: [100 + 6 * x, 200 - 9 * y, 80 + 3 * x + 5 * y]
        for width, height in ((WIDTH, HEIGHT), (17, 9)):
            for texel, options in ((noisy, {}), (noisy, {"progressive": True}), (noisy, {"gray": True}), (noisy, {"gray": True, "progressive": True}),
                                   (smooth, {"halve": True}), (smooth, {"halve": True, "progressive": True})):
                bytes_of = (lambda x, y: [noisy(x, y)[0]] * 3) if options.get("gray") else texel
                right = self.around("right.pfm", images.pfm(width, height, lambda x, y: [linear(v) for v in bytes_of(x, y)]))[0]
                found, said = self.around("a.jpg", jpeg(width, height, texel, **options))
                self.assertEqual(said, "")
                off = [abs(a - b) for one, other in zip(found, right) for a, b in zip(read_pfm(one)[2], read_pfm(other)[2], strict=True)]
                self.assertLess(max(off), 5 / 255 if options.get("halve") else 2 * 2.3 / 255, options)
                self.assertLess(sum(off) / len(off), 0.006 if options.get("halve") else 0.003, options)

    def test_jpeg_colors(self):
        """Numbers are sRGB's unless the scene says otherwise; profiles and orientations are named."""
        color = (188, 100, 30)
        srgb, one = [linear(v) for v in color], lambda *markers: jpeg(1, 1, lambda x, y: color, markers=markers)
        icc = lambda text: (0xe2, b"ICC_PROFILE\0\1\1" + self.profile(text))
        exif = lambda order, value: (0xe1, b"Exif\0\0" + self.exif(order, value))
        for markers, says in (([], ""), ([icc(b"sRGB IEC61966-2.1")], ""), ([icc("sRGB".encode("utf-16-be"))], ""),
                              ([icc(b"Adobe RGB (1998)")], "its ICC profile is not applied: read as sRGB"),
                              ([exif("<", 6)], "its Exif orientation, 6, is not applied: read turned by 90 degrees"),
                              ([(0xe1, b"http://ns.adobe.com/xap/1.0/\0<x/>"), exif(">", 3)], "its Exif orientation, 3, is not applied: read upside down"),
                              ([exif(">", 1)], ""), ([(0xe1, b"Exif\0\0")], ""), ([(0xe1, b"Exif\0\0MM\0*\0\0")], ""), ([(0xfe, b"a comment")], "")):
            found, said = self.texel("a.jpg", one(*markers))
            self.assert_near(found, srgb, 0.008, markers)
            self.assertIn(says, said)
            self.assertEqual(said == "", says == "", said)
        self.assert_near(self.texel("a.jpg", one(), encoding="srgb")[0], srgb, 0.008)
        found, said = self.texel("a.jpg", one(icc(b"Adobe RGB (1998)")), encoding="linear")
        self.assert_near(found, [v / 255 for v in color], 0.008)
        self.assertEqual(said, "")

    def test_jpeg_refused(self):
        """What the library would fill with grey is refused, by how many rows are whole; so is what has no colours that are known here."""
        whole = jpeg(16, 64, lambda x, y: [(x * y * 7 + 31 * c) % 256 for c in range(3)])
        frame = whole.index(b"\xff\xc0")
        huge = whole[:frame + 5] + struct.pack(">HH", 8000, 9000) + whole[frame + 9:]
        larger = whole[:frame + 5] + struct.pack(">HH", 65500, 65500) + whole[frame + 9:]
        for content, says in ((whole[:len(whole) // 2], "a damaged JPEG file: Premature end of JPEG file; "), (whole[:-2], "64 of 64 rows could be read"),
                              (whole[:40], "a JPEG file that cannot be read"), (whole[:3], "a JPEG file that cannot be read"),
                              (whole[:-400] + b"\xff\xd9", "a damaged JPEG file: Corrupt JPEG data: premature end of data segment; "), (huge, "expected at least 35156 for 9000 by 8000 texels"),
                              (larger, "expected at least"), (jpeg(8, 8, lambda x, y: (1, 2, 3), channels=4), "of four inks (CMYK)"),
                              (whole[:frame + 1] + b"\xc9" + whole[frame + 2:], "of arithmetic coding"),
                              (whole[:frame + 4] + b"\x0c" + whole[frame + 5:], "a JPEG file that cannot be read: ")):
            self.write("a.jpg", content)
            self.write("s.json", scene(background={"image": "a.jpg"}))
            self.fail_with(2, "render", "s.json", "-o", "x.png", says=["a.jpg: found ", says])

    def test_png_alpha(self):
        """It changes no colour, and a note counts the texels that it would make transparent."""
        color, grey = (188, 100, 30), (100,)
        table = [(b"PLTE", bytes((*color, *color, *color)))]
        for kind, bits, chunks, texels, transparent in (
                (6, 8, [], [(*color, 255)] * 3, 0), (6, 8, [], [(*color, 255), (*color, 0), (*color, 254)], 2),
                (6, 16, [], [(*(257 * n for n in color), 65535), (*(257 * n for n in color), 65534)], 1),
                (4, 8, [], [(*grey, 0), (*grey, 255)], 1), (4, 16, [], [(25700, 255), (25700, 65535), (25700, 0)], 2),
                (3, 8, table, [(0,), (1,), (2,)], 0), (3, 8, table + [(b"tRNS", b"\xff\0")], [(0,), (1,), (2,), (1,)], 2),
                (3, 8, table + [(b"tRNS", b"\x80")], [(0,), (2,)], 1), (3, 8, table + [(b"tRNS", b"\xff\xff")], [(0,), (1,)], 0),
                (2, 8, [(b"tRNS", bytes((0, 188, 0, 100, 0, 30)))], [color, color], 2),
                (2, 8, [(b"tRNS", bytes((0, 188, 0, 100, 0, 31)))], [color, color], 0),
                (0, 8, [(b"tRNS", bytes((0, 100)))], [grey, grey], 2), (0, 8, [(b"tRNS", bytes((0, 99)))], [grey, grey], 0)):
            found, said = self.texel("a.png", png(chunks, texels, kind, bits))
            self.assert_near(found, [linear(v) for v in (grey * 3 if kind in (0, 4) else color)], 5e-6, (kind, bits, chunks))
            note = f"its alpha is left out, though {transparent} of {len(texels)} texels are not opaque"
            self.assertEqual(note in said, transparent > 0, (kind, bits, chunks, said))
            self.assertEqual(said == "", transparent == 0, said)

    @staticmethod
    def profile(text):
        """The least that libpng takes for an ICC profile of colours."""
        tags = struct.pack(">I4sII", 1, b"desc", 144, len(text) + (-len(text) % 4))
        body = tags + text + bytes(-len(text) % 4)
        head = struct.pack(">I4sI4s4s4s", 128 + len(body), b"test", 0x02400000, b"mntr", b"RGB ", b"XYZ ") + bytes(12) + b"acsp" + bytes(28)
        return head + struct.pack(">3I", 63190, 65536, 54061) + bytes(48) + body


if __name__ == "__main__":
    main()
