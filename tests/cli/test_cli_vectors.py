"""Figures as PDF and SVG: the text and its fonts by poppler, the pixels of the picture, and what poppler and librsvg draw of them.

In:    pictures of particles with a bar.   Out: what other programs read in the files.   Knows: the tools of poppler and librsvg."""
import base64
import json
import os
import random
import re
import shutil
import subprocess
import unittest

from cli import PROGRAM, ProgramTest, main, scene
from png import read_png

HAS_TEXT = "BALLPARK_TEXT" in os.environ or os.path.exists(os.path.join(os.path.dirname(PROGRAM), "ballpark_text.so"))
POPPLER = unittest.skipUnless(all(map(shutil.which, ("pdftotext", "pdffonts", "pdfimages", "pdftoppm", "pdfinfo"))),
                              "there is no poppler (poppler-utils)")
RSVG = unittest.skipUnless(shutil.which("rsvg-convert"), "there is no rsvg-convert (librsvg2-bin)")
WIDTH = 400
COLOR = {"column": "heat", "bar": True, "range": [-0.2, 1], "label": "speed μ²", "unit": "Å/ps"}


def straight(picture):
    """The rows of samples as lists."""
    return [list(row) for row in picture[4]]


@unittest.skipUnless(HAS_TEXT, "built without Pango")
class Vectors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("a.csv", "x,y,z,heat\n" + "".join(f"{i},{i % 3},{(i * i) % 5},{i / 11}\n" for i in range(12)))

    def render(self, name, *options, color=COLOR, width=WIDTH, spp=1):
        self.succeed("render", "a.csv", "-q", "--spp", spp, "--width", width, "-o", name, "--set", "particles[0].color=" + json.dumps(color),
                     *options)
        return self.read(name)

    def tool(self, *command):
        return subprocess.run(command, cwd=self.folder, check=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE).stdout.decode()

    def words(self, name):
        """[(text, left, top, right, bottom)] in points."""
        found = re.findall(r'<word xMin="([-\d.]+)" yMin="([-\d.]+)" xMax="([-\d.]+)" yMax="([-\d.]+)">(.*?)</word>', self.tool("pdftotext", "-bbox", name, "-"))
        return [(text, *map(float, box)) for *box, text in found]

    def images(self, name):
        """The images in a PDF: colours and masks, in the order in which they are drawn."""
        for old in self.files():
            if old.startswith("i-"):
                os.remove(self.path(old))
        self.tool("pdfimages", "-png", name, "i")
        return [self.read(file) for file in self.files() if file.startswith("i-")]

    def size(self, name):
        return tuple(map(float, re.search(r"Page size: +([\d.]+) x ([\d.]+) pts", self.tool("pdfinfo", name)).groups()))

    @POPPLER
    def test_text(self):
        """The labels are there as text, in fonts that the file has."""
        self.render("a.pdf")
        self.assertEqual(sorted(word[0] for word in self.words("a.pdf")), sorted("0.0 0.5 1.0 speed μ² (Å/ps)".split()))
        fonts = self.tool("pdffonts", "a.pdf").splitlines()[2:]
        self.assertGreater(len(fonts), 0)
        for line in fonts:
            self.assertRegex(line, r"DejaVuSans .* yes +yes +yes +\d+ +0$")  # embedded, a subset, with Unicode
        self.render("b.pdf", color=dict(COLOR, range=[-2e6, 0]))
        self.assertIn("−2.0×10⁶", self.tool("pdftotext", "b.pdf", "-"))

    @POPPLER
    def test_pixels_of_a_pdf(self):
        """The picture is the one of a PNG, exactly; one with alpha loses what multiplying by it loses in 8 bits."""
        for options in ((), ("--set", "backdrop=[0.1,0.2,0.3]", "--transfer", "gamma2", "--exposure", 0.5)):
            self.render("a.pdf", *options)
            png = straight(read_png(self.render("a.png", *options)))
            found = read_png(self.images("a.pdf")[0])
            self.assertEqual(found[:4], (WIDTH, found[1], 8, 3))
            self.assert_same(straight(found), [row[:3 * WIDTH] for row in png])
        self.render("a.pdf", "--set", "backdrop=none", spp=8)
        png = straight(read_png(self.render("a.png", "--set", "backdrop=none", spp=8)))
        self.assertGreater(len({row[4 * x + 3] for row in png for x in range(WIDTH)}), 5)
        listed = self.tool("pdfimages", "-list", "a.pdf").splitlines()[2:]
        self.assertEqual([line.split()[2] for line in listed][:2], ["image", "smask"])
        colours = straight(read_png(self.images("a.pdf")[0]))
        worst = 0
        for found, row in zip(colours, png):
            for x in range(WIDTH):
                alpha = row[4 * x + 3]
                for c in range(3):
                    worst = max(worst, abs(found[3 * x + c] - row[4 * x + c]) * alpha / 255)
        self.assertLessEqual(worst, 1)

    def test_pixels_of_an_svg(self):
        """The picture is the PNG without its margin, also with alpha."""
        for backdrop, channels in (("[1,1,1]", 3), ("none", 4)):
            svg = self.render("a.svg", "--set", f"backdrop={backdrop}", spp=8).decode()
            png = straight(read_png(self.render("a.png", "--set", f"backdrop={backdrop}", spp=8)))
            images = [base64.b64decode(data) for data in re.findall(r"data:image/png;base64,([A-Za-z0-9+/=\s]+)", svg)]
            found = read_png(images[0])
            self.assertEqual(found[2:4], (8, channels))
            self.assert_same(straight(found), [row[:channels * WIDTH] for row in png])

    @POPPLER
    def test_size_of_the_page(self):
        for dpi in (300, 96):
            self.render("a.pdf", "--dpi", dpi)
            picture = read_png(self.render("a.png", "--dpi", dpi))
            for found, pixels in zip(self.size("a.pdf"), picture):
                self.assertAlmostEqual(found, pixels * 72 / dpi, delta=0.01)
            # DejaVu Sans has digits of 0.729 em; a box of poppler is that of the font's line, 7 points high by the same rule.
            heights = {round(bottom - top, 2) for text, _, top, _, bottom in self.words("a.pdf") if text == "1.0"}
            self.assertEqual(len(heights), 1)
            self.assertAlmostEqual(heights.pop(), 7 * (0.928 + 0.236), delta=0.1)

    def test_the_same_file_again(self):
        """No date, nothing by chance."""
        for name in ("a.pdf", "a.svg"):
            for backdrop in ("[1,1,1]", "none"):
                first = self.render(name, "--set", f"backdrop={backdrop}")
                self.assert_same(first, self.render(name, "--set", f"backdrop={backdrop}"), name)
                self.assertNotIn(b"/CreationDate", first)

    @POPPLER
    def test_labels_do_not_overlap(self):
        """By the boxes that poppler finds: of ranges and sizes of all kinds."""
        draw = random.Random(4)
        for i in range(16):
            width, least = 10 ** draw.uniform(-9, 9), draw.uniform(-1, 1) * 10 ** draw.uniform(-9, 9)
            pixels = draw.choice((150, 200, 333, 500))
            options = ("--set", f"figure.size={draw.uniform(4, 12):.2f}", "--dpi", draw.choice((100, 200, 300)))
            self.render("a.pdf", *options, width=pixels, color=dict(COLOR, range=[least, least + width], label="mean speed"))
            page, words = self.size("a.pdf"), self.words("a.pdf")
            picture = pixels * 72 / options[-1]
            for n, (text, left, top, right, bottom) in enumerate(words):
                self.assertTrue(picture < left < right <= page[0] + 0.01 and -0.01 <= top < bottom <= page[1] + 0.01, (i, text, words))
                for other, *box in words[:n]:
                    self.assertTrue(right <= box[0] + 0.01 or box[2] <= left + 0.01 or bottom <= box[1] + 0.01 or box[3] <= top + 0.01, (i, text, other, words))

    def assert_drawn_alike(self, found, png):
        """The margin of a picture of four times the resolution is the PNG's: where it is, they are nearer to each other than with one of
        them moved by a pixel, and near."""
        for size, wanted in zip(found, png[:2]):
            self.assertLessEqual(abs(size - 4 * wanted), 1)  # librsvg rounds up
        grey = [[row[3 * x] for x in range(WIDTH, png[0] - 1)] for row in png[4]]
        rows, channels = found[4], found[3]
        other = [[sum(rows[4 * y + v][channels * (4 * x + u)] for v in range(4) for u in range(4)) / 16 for x in range(WIDTH, png[0] - 1)]
                 for y in range(len(grey))]
        height, width = len(grey), len(grey[0])

        def apart(dx, dy):
            return sum(abs(grey[y][x] - other[y + dy][x + dx]) for y in range(1, height - 1) for x in range(1, width - 1)) / (height * width)

        moved = [apart(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if (dx, dy) != (0, 0)]
        self.assertLess(apart(0, 0), 0.5 * min(moved))
        self.assertLess(apart(0, 0), 5)

    @POPPLER
    def test_poppler_draws_the_png(self):
        """Text and lines stand in a PDF where they stand in a PNG."""
        png = read_png(self.render("a.png"))
        self.render("a.pdf")
        self.tool("pdftoppm", "-png", "-r", "1200", "-singlefile", "a.pdf", "drawn")
        self.assert_drawn_alike(read_png(self.read("drawn.png")), png)

    @RSVG
    def test_librsvg_draws_the_png(self):
        for backdrop in ("[1,1,1]", "[0,0,0]"):
            png = read_png(self.render("a.png", "--set", f"backdrop={backdrop}"))
            self.render("a.svg", "--set", f"backdrop={backdrop}")
            self.tool("rsvg-convert", "-d", "1200", "-p", "1200", "-b", "white", "a.svg", "-o", "drawn.png")
            self.assert_drawn_alike(read_png(self.read("drawn.png")), png)

    @RSVG
    def test_a_transparent_svg_on_any_page(self):
        self.render("a.svg", "--set", "backdrop=none")
        for page, name in ((0, "black"), (255, "white")):
            self.tool("rsvg-convert", "-d", "300", "-p", "300", "-b", name, "a.svg", "-o", "drawn.png")
            width, height, _, channels, rows, _ = read_png(self.read("drawn.png"))
            label = [row[channels * x] for row in rows for x in range(width - 30, width)]
            self.assertEqual((min(label), max(label)), (0, 255))
            self.assertEqual(rows[0][-1 if channels == 3 else -2], page)

    @POPPLER
    def test_without_text(self):
        """The picture alone, also of a film and on standard output."""
        self.write("s.json", scene(32, 16))
        png = straight(read_png(self.run_png("s.json")))
        self.succeed("render", "s.json", "-q", "-o", "s.bpa")
        self.succeed("render", "s.json", "-q", "-o", "s.pdf")
        self.succeed("merge", "s.bpa", "-q", "-o", "m.pdf")
        self.write("o.pdf", self.succeed("render", "s.json", "-q", "--format", "pdf", "-o", "-").stdout)
        for name in ("s.pdf", "m.pdf", "o.pdf"):
            self.assert_same(straight(read_png(self.images(name)[0])), png)
            self.assertEqual(self.words(name), [])
            for found, wanted in zip(self.size(name), (32 * 0.24, 16 * 0.24)):
                self.assertAlmostEqual(found, wanted, delta=0.01)
        self.succeed("render", "s.json", "-q", "--format", "svg")
        self.assertIn("s.svg", self.files())

    def run_png(self, name):
        self.succeed("render", name, "-q", "-o", "s.png")
        return self.read("s.png")

    def test_refusals(self):
        self.write("s.json", scene(8, 8))
        for option, says in ((("--bit-depth", 16), "--bit-depth applies to PNG"), (("--metadata",), "--metadata can be recorded in PNG and EXR")):
            for name in ("a.pdf", "a.svg"):
                self.fail_with(2, "render", "s.json", "-o", name, *option, says=says)
        self.fail_with(2, "render", "s.json", "-o", "a.jpg", says=".png, .pdf, .svg,")
        self.fail_with(2, "render", "s.json", "-o", "a.pdf", says=("PDF or SVG can be drawn", "libpango1.0-dev"), environment={"BALLPARK_TEXT": "/nowhere"})
        for name in ("pdf", "svg"):
            self.fail_with(1, "render", "s.json", "--format", name, "-o", "/dev/full", says="No space left")
        self.assertNotIn("a.pdf", self.files())
        self.fail_with(2, "render", "a.csv", "-o", "a.pdf", "--width", 32768, "--spp", 1, says="at most 32767")


if __name__ == "__main__":
    main()
