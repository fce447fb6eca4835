"""Colour bars beside pictures of particles: their text's size and colour, and that the picture stays as it is.

In:    pictures of particles with a bar.   Out: their pixels.   Knows: where the bar stands.

The heights of letters come from the tables of the font's file, which fontconfig names, and not from what draws them."""
import json
import os
import shutil
import struct
import subprocess
import unittest

from cli import PROGRAM, ProgramTest, main
from png import read_png

HAS_TEXT = "BALLPARK_TEXT" in os.environ or os.path.exists(os.path.join(os.path.dirname(PROGRAM), "ballpark_text.so"))
TICKS = {"column": "heat", "bar": True}


def capital_height():
    """Of DejaVu Sans, in the size of the font: sCapHeight of OS/2 over unitsPerEm of head."""
    name = subprocess.run(["fc-match", "-f", "%{file}", "DejaVu Sans:style=Book"], check=True, stdout=subprocess.PIPE).stdout.decode()
    with open(name, "rb") as file:
        data = file.read()
    tables = {data[at:at + 4]: struct.unpack_from(">II", data, at + 8) for at in range(12, 12 + 16 * struct.unpack_from(">H", data, 4)[0], 16)}
    units = struct.unpack_from(">H", data, tables[b"head"][0] + 18)[0]
    version = struct.unpack_from(">H", data, tables[b"OS/2"][0])[0]
    if version >= 2:
        return struct.unpack_from(">h", data, tables[b"OS/2"][0] + 88)[0] / units
    # An older table lacks it: the top of the H's outline.
    return outline_top(data, tables, "H") / units


def outline_top(data, tables, letter):
    """yMax of the letter's glyph, by the cmap of format 4 and the long or short loca."""
    cmap = tables[b"cmap"][0]
    for i in range(struct.unpack_from(">H", data, cmap + 2)[0]):
        at = cmap + struct.unpack_from(">I", data, cmap + 4 + 8 * i + 4)[0]
        if struct.unpack_from(">H", data, at)[0] == 4:
            break
    count = struct.unpack_from(">H", data, at + 6)[0] // 2
    ends, starts = at + 14, at + 16 + 2 * count
    deltas, offsets = starts + 2 * count, starts + 4 * count
    code = ord(letter)
    segment = next(s for s in range(count) if struct.unpack_from(">H", data, ends + 2 * s)[0] >= code)
    start = struct.unpack_from(">H", data, starts + 2 * segment)[0]
    offset = struct.unpack_from(">H", data, offsets + 2 * segment)[0]
    glyph = code
    if offset != 0:
        glyph = struct.unpack_from(">H", data, offsets + 2 * segment + offset + 2 * (code - start))[0]
    glyph = (glyph + struct.unpack_from(">H", data, deltas + 2 * segment)[0]) % 65536
    is_long = struct.unpack_from(">h", data, tables[b"head"][0] + 50)[0]
    loca = tables[b"loca"][0]
    place = struct.unpack_from(">I", data, loca + 4 * glyph)[0] if is_long else 2 * struct.unpack_from(">H", data, loca + 2 * glyph)[0]
    return struct.unpack_from(">h", data, tables[b"glyf"][0] + place + 8)[0]


def luminance(rgb):
    """Relative luminance of 8-bit sRGB, as WCAG 2 has it."""
    linear = [v / 255 / 12.92 if v / 255 <= 0.04045 else ((v / 255 + 0.055) / 1.055) ** 2.4 for v in rgb]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


class Bar(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.csv", "x,y,z,heat\n" + "".join(f"{i},{i % 3},0,{i}\n" for i in range(11)))

    def picture(self, *options, color=TICKS, name="a.png", width=300):
        self.succeed("render", "a.csv", "-q", "--spp", 1, "--width", width, "-o", name, "--set", "particles[0].color=" + json.dumps(color),
                     "--set", "transfer=srgb", *options)
        return read_png(self.read(name)) if name.endswith(".png") else self.read(name)


@unittest.skipUnless(HAS_TEXT, "built without Pango")
class Text(Bar):
    def test_the_picture_stays(self):
        """Left of the bar are the same pixels as without one; linear pictures have none; and the margin has the bar's colours."""
        for backdrop, channels in (("[1,1,1]", 3), ("none", 4)):
            options = ("--set", f"backdrop={backdrop}")
            plain, barred = (self.picture(*options, color={"column": "heat", "bar": bar}) for bar in (False, True))
            self.assertEqual((plain[0], plain[3]), (300, channels))
            self.assertEqual(plain[1], barred[1])
            self.assertGreater(barred[0], 330)
            for one, other in zip(plain[4], barred[4]):
                self.assert_same(bytes(one), bytes(other[:300 * channels]))
            margin = {tuple(row[channels * x:channels * x + 3]) for row in barred[4] for x in range(300, barred[0])}
            # The ends of viridis, dimmed by 0.9, as sRGB: about (65, 1, 80) and (241, 220, 35).
            for end in ((65, 1, 80), (241, 220, 35)):
                self.assertTrue(any(max(abs(a - b) for a, b in zip(end, colour)) <= 4 for colour in margin), end)
        for name in ("a.pfm", "b.pfm"):
            self.picture(color={"column": "heat", "bar": name == "a.pfm"}, name=name)
        self.assert_same(self.read("a.pfm"), self.read("b.pfm"))

    def test_it_stays_with_16_bits(self):
        plain, barred = (self.picture("--bit-depth", 16, color={"column": "heat", "bar": bar}) for bar in (False, True))
        for one, other in zip(plain[4], barred[4]):
            self.assertEqual(list(one), list(other[:3 * 300]))
        self.assertEqual(set(barred[4][0][-30:]), {65535})  # the margin is white

    def height(self, picture):
        """The height of a turned H, which stands alone in the last columns with ink. Its stems cover the same of each column, the first
        and the last but for a share."""
        width, _, _, channels, rows, _ = picture
        dark = [sum(1 - row[channels * x] / 255 for row in rows) for x in range(width)]
        right = max(x for x in range(width) if dark[x] > 0)
        left = right
        while dark[left - 1] > 0:
            left -= 1
        stems = sorted(dark[left:right + 1])[(right - left) // 3]  # the crossbar's columns have more
        return sum(min(1, share / stems) for share in dark[left:right + 1])

    @unittest.skipUnless(shutil.which("fc-match"), "there is no fc-match (fontconfig)")
    def test_points_are_points(self):
        """A capital letter has the height that the font says, within a tenth of a pixel."""
        capital = capital_height()
        for dpi, points in ((300, 7), (300, 11.5), (150, 7), (600, 7)):
            picture = self.picture("--set", f"figure.size={points}", "--dpi", dpi, color=dict(TICKS, label="H"), width=300)
            expected = capital * points / 72 * dpi
            self.assertAlmostEqual(self.height(picture), expected, delta=0.1, msg=(dpi, points))
            chunks = dict(picture[5])
            self.assertEqual(struct.unpack(">IIB", chunks["pHYs"]), (round(dpi / 0.0254), round(dpi / 0.0254), 1))
        # 7 points at 300 dots per inch need not be asked for.
        self.assert_same(self.picture(color=dict(TICKS, label="H"))[4],
                         self.picture("--set", "figure.size=7", "--dpi", 300, color=dict(TICKS, label="H"))[4])
        self.assertEqual(struct.unpack(">IIB", dict(self.picture()[5])["pHYs"]), (11811, 11811, 1))

    def test_ink_on_paper(self):
        """Black on light paper and white on dark paper, which is the backdrop's."""
        for backdrop, page, ink in (("[1,1,1]", 255, 0), ("[0,0,0]", 0, 255), ("[0.02,0.02,0.02]", None, 255), ("[0.4,0.4,0.4]", None, 0)):
            width, height, _, channels, rows, _ = self.picture("--set", f"backdrop={backdrop}")
            last = {tuple(rows[y][3 * x:3 * x + 3]) for y in range(height) for x in range(width - 30, width)}
            paper = tuple(rows[0][-3:])
            self.assertEqual(paper, tuple(rows[0][:3]))  # no seam
            if page is not None:
                self.assertEqual(paper, (page,) * 3)
            self.assertIn((ink,) * 3, last)
            self.assertGreater(contrast(paper, (ink,) * 3), 7)
            self.assertTrue(all(min(paper[0], ink) <= c[0] <= max(paper[0], ink) for c in last))

    def over(self, picture, page):
        """The grey of each pixel, by row, when the picture lies on a page."""
        width, height, _, channels, rows, _ = picture
        self.assertEqual(channels, 4)
        grey = lambda row, x: (row[4 * x + 1] * row[4 * x + 3] + page * (255 - row[4 * x + 3])) / 255
        return [[grey(rows[y], x) for x in range(width)] for y in range(height)]

    def test_transparent(self):
        """Every stroke is black, with white beside it, on white paper and on a black screen alike."""
        picture = self.picture("--set", "backdrop=none")
        width, height, rows = picture[0], picture[1], picture[4]
        ink = [(x, y) for y in range(height) for x in range(width - 30, width) if tuple(rows[y][4 * x:4 * x + 4]) == (0, 0, 0, 255)]
        self.assertGreater(len(ink), 100)
        self.assertEqual(rows[0][-1], 0)  # the margin is transparent
        for page in (255, 0):
            grey = self.over(picture, page)
            for x, y in ink:
                self.assertEqual(grey[y][x], 0)
                self.assertGreater(max(grey[v][u] for v in range(max(y - 5, 0), y + 6) for u in range(x - 5, min(x + 6, width))), 250, (page, x, y))

    def test_colour_of_the_text(self):
        for text, value in (("black", 0), ("white", 255)):
            rows = self.picture("--set", "backdrop=none", "--set", f"figure.text={text}")[4]
            colours = {tuple(row[4 * x:4 * x + 3]) for row in rows for x in range(len(row) // 4 - 30, len(row) // 4) if row[4 * x + 3] > 0}
            self.assertEqual(colours, {(value,) * 3})  # no rim: an alpha alone
            opaque = self.picture("--set", "backdrop=[1,1,1]", "--set", f"figure.text={text}")[4]
            shown = {row[3 * x] for row in opaque for x in range(len(row) // 3 - 30, len(row) // 3)}
            self.assertEqual(min(shown), value if text == "black" else 255)

    def test_exposure_and_transfer(self):
        """The margin is exposed as the backdrop is, so that there is no seam; letters are not."""
        for options in (("--exposure", -1), ("--transfer", "gamma2"), ("--transfer", "linear", "--exposure", 0.5)):
            width, height, _, _, rows, _ = self.picture("--set", "backdrop=[0.6,0.5,0.4]", *options)
            self.assertEqual(tuple(rows[0][-3:]), tuple(rows[0][:3]), options)
            self.assertIn(min(min(row[-90:]) for row in rows), (0,))

    def test_unicode(self):
        shown = self.succeed("render", "a.csv", "--spp", 1, "--width", 300, "-o", "u.png", "--set",
                             "particles[0].color=" + json.dumps(dict(TICKS, label="μ²", unit="Å/ps")))
        self.assertNotIn("warning", shown.errors)
        self.assert_different(self.read("u.png"), self.picture(color=dict(TICKS, label="μ", unit="Å/ps")))
        shown = self.succeed("render", "a.csv", "--spp", 1, "--width", 300, "-o", "u.png", "--set",
                             "particles[0].color=" + json.dumps(dict(TICKS, label="\U0010fffd")))
        self.assertIn("no font that is installed has all letters of", shown.errors)
        document = json.dumps({"camera": {"image_width": 30, "fit": "particles"}, "particles": [{"file": "a.csv", "color": dict(TICKS, label="LABEL")}]})
        self.write("latin.json", document.encode().replace(b"LABEL", b"\xc5/ps"))
        self.fail_with(2, "render", "latin.json", says=("latin.json:1:", "UTF-8"))
        self.fail_with(2, "render", "a.csv", "--set", b"figure.font=\xc5".decode(errors="surrogateescape"), says="UTF-8")

    def test_what_does_not_fit_is_said(self):
        shown = self.succeed("render", "a.csv", "--spp", 1, "--width", 60, "-o", "s.png", "--set", "particles[0].color=" + json.dumps(TICKS))
        self.assertIn("warning: the colour bar is left out", shown.errors)
        self.assertEqual(read_png(self.read("s.png"))[0], 60)
        shown = self.succeed("render", "a.csv", "--spp", 1, "--width", 200, "-o", "s.png", "--set",
                             "particles[0].color=" + json.dumps(dict(TICKS, label="a label that is far too long")))
        self.assertIn('warning: the label "a label that is far too long" is left out', shown.errors)
        shown = self.succeed("render", "a.csv", "--spp", 1, "--width", 200, "-o", "s.png", "--set", 'figure.font="No Such Font"', "--set",
                             "particles[0].color=" + json.dumps(TICKS))
        self.assertIn('the font "No Such Font" is not installed', shown.errors)

    def test_members(self):
        color = dict(TICKS, label="speed", unit="Å/ps")
        figure = {"font": "DejaVu Sans Bold", "size": 6.5, "text": "white"}
        self.write("x.json", {"camera": {"image_width": 30, "fit": "particles"}, "figure": figure, "particles": [{"file": "a.csv", "color": color}]})
        self.succeed("scene", "x.json", "-o", "y.json", "-q")
        written = json.loads(self.read("y.json"))
        self.assertEqual((written["figure"], written["particles"][0]["color"]), (figure, color))
        for wrong, says in ((dict(color, bar=False), 'found without "bar": true'), (dict(color, label=""), "a text of 1 to 191 bytes"),
                            (dict(color, unit=1), "unit"), (dict(color, unit="x" * 56), "a text of 1 to 55 bytes")):
            self.fail_with(2, "render", "a.csv", "--set", "particles[0].color=" + json.dumps(wrong), says=says)
        for member, value, says in (("size", 0.5, "points from 1 to 144"), ("size", 145, "points from 1 to 144"), ("text", "red", "expected"),
                                    ("font", "x" * 256, "at most 255 bytes"), ("colour", "x", "unknown member")):
            self.fail_with(2, "render", "a.csv", "--set", f"figure.{member}={value}", says=says)

    def test_frames_have_one_bar(self):
        """All pictures of a film have the same size and the same marks."""
        self.write("b.xyz", "".join("3\nProperties=species:S:1:pos:R:3:heat:R:1\n" + "".join(f"H {i} 0 0 {f * 1000 + i}\n" for i in range(3)) for f in range(2)))
        self.succeed("render", "b.xyz", "-q", "--spp", 1, "--width", 300, "--frames", "::", "-o", "f.png", "--set",
                     "particles[0].color=" + json.dumps(TICKS))
        first, second = (read_png(self.read(f"f-000{i}.png")) for i in range(2))
        self.assertEqual(first[:2], second[:2])
        for one, other in zip(first[4], second[4]):
            self.assert_same(bytes(one[3 * 300:]), bytes(other[3 * 300:]))


class Without(Bar):
    def test_without_the_module(self):
        """Refused before the render, with the package's name; all else goes on."""
        missing = {"BALLPARK_TEXT": "/nowhere/ballpark_text.so"}
        color = ("--set", "particles[0].color=" + json.dumps(TICKS))
        self.fail_with(2, "render", "a.csv", "-o", "x.png", *color, says=("no text, PDF or SVG can be drawn", "libpango1.0-dev", "/nowhere"), environment=missing)
        self.assertEqual(self.files(), ["a.csv"])
        for options in (("-o", "x.png"), ("-o", "x.pfm", *color), ("-o", "x.bpa", *color)):
            self.succeed("render", "a.csv", "-q", "--spp", 1, "--width", 40, *options, environment=missing)


if __name__ == "__main__":
    main()
