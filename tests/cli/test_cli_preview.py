"""The picture while it is rendered: --preview rewrites the file, --show draws in the terminal."""

import base64
import os
import re
import shutil
import signal
import subprocess
import time

from cli import LIMIT_SECONDS, PROGRAM, ProgramTest, deep, main, scene
from png import read_png
from terminal import Terminal

WIDTH, HEIGHT = 40, 24
QUICK = ("--spp", "64", "--transfer", "srgb")
PLAIN = {name: "" for name in ("COLORTERM", "TERM_PROGRAM", "LC_TERMINAL")}


def read_ppm(data):
    """Rows of pixels of a P6."""
    header = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
    width, height = int(header[1]), int(header[2])
    pixels = data[header.end():]
    return [[tuple(pixels[3 * (y * width + x):][:3]) for x in range(width)] for y in range(height)]


def mean(rows):
    pixels = [pixel for row in rows for pixel in row]
    return [sum(pixel[c] for pixel in pixels) / len(pixels) for c in range(3)]


def read_sixels(data):
    """Rows of pixels of ESC P ... q ... ESC \\."""
    text = re.search(rb'\x1bP[\d;]*q"1;1;(\d+);(\d+)(.*?)\x1b\\', data, re.DOTALL)
    width, height = int(text[1]), int(text[2])
    rows = [[None] * width for _ in range(height)]
    colours, colour, x, top = {}, 0, 0, 0
    for token in re.finditer(rb"#(\d+)(?:;2;(\d+);(\d+);(\d+))?|!(\d+)([?-~])|([?-~])|([$-])", text[3]):
        if token[1] is not None:
            colour = int(token[1])
            if token[2] is not None:
                colours[colour] = tuple(int(token[i]) * 255 / 100 for i in (2, 3, 4))
        elif token[8] is not None:
            x, top = 0, top + 6 * (token[8] == b"-")
        else:
            count, letter = (int(token[5]), token[6]) if token[5] else (1, token[7])
            for _ in range(count):
                for bit in range(6):
                    if (letter[0] - 63) >> bit & 1:
                        assert rows[top + bit][x] is None, "a pixel is drawn twice"
                        rows[top + bit][x] = colours[colour]
                x += 1
    return rows


class Preview(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(WIDTH, HEIGHT, spheres=3))

    def start(self, *options):
        process = subprocess.Popen([PROGRAM, "render", "s.json", *options], cwd=self.folder, env=self.environment,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(lambda: process.poll() is None and (process.kill(), process.wait()))
        return process

    def test_the_file_grows_better(self):
        process = self.start("--spp", "60000000", "--preview", "0.1", "-o", "a.ppm")
        seen, deadline = [], time.monotonic() + LIMIT_SECONDS
        while len(seen) < 3 and time.monotonic() < deadline:
            if os.path.exists(self.path("a.ppm")):
                data = self.read("a.ppm")
                self.assertEqual(len(read_ppm(data)), HEIGHT)  # never half a file
                if data not in seen:
                    seen.append(data)
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=LIMIT_SECONDS), 130)
        self.assertEqual(len(seen), 3, "the file was not rewritten")
        self.assertEqual(self.files(), ["a.ppm", "s.json"])

    @deep
    def test_bits_stay_the_same(self):
        for options in ((), ("--adaptive",)):
            self.succeed("render", "s.json", "--spp", "256", *options, "-o", "a.pfm")
            self.succeed("render", "s.json", "--spp", "256", *options, "-o", "b.pfm", "--preview", "1e-6",
                         "--error-map", "e.png")
            self.assert_same(self.read("a.pfm"), self.read("b.pfm"), options)
        self.assertIn("e.png", self.files())

    def test_a_folder_that_goes_is_said_once(self):
        os.mkdir(self.path("gone"))
        self.succeed("render", "s.json", "--spp", "1", "-o", "gone/first.png", "-q")  # builds the kernel
        self.environment["TMPDIR"] = self.folder
        process = self.start("--time", "2", "--preview", "0.05", "-o", "gone/a.png")
        deadline = time.monotonic() + LIMIT_SECONDS
        while not os.path.exists(self.path("gone/a.png")) and time.monotonic() < deadline:
            time.sleep(0.01)
        shutil.rmtree(self.path("gone"))
        errors = process.communicate(timeout=LIMIT_SECONDS)[1]
        self.assertEqual(process.returncode, 1, errors)
        self.assertEqual(errors.count("the preview was not written, and rendering continues"), 1, errors)
        kept = re.search(r"ballpark merge (\S+) -o", errors)
        self.assertTrue(kept and os.path.exists(kept[1]), errors)  # the sums are kept, as for any render

    def test_refusals(self):
        for options, words in ((("--preview", "1", "-o", "a.bpa"), "--checkpoint keeps those"),
                               (("--preview", "1", "-o", "-"), "rewrites a file"),
                               (("--preview", "1", "--no-clobber"), "--no-clobber refuses"),
                               (("--preview", "0"), "--preview"),
                               (("--show",), "needs standard error to be a terminal"),
                               (("--show", "-q"), "allows only errors")):
            result = self.run_program("render", "s.json", *options)
            self.assertEqual(result.returncode, 2, result.errors)
            self.assertIn(words, result.errors)
            self.assertEqual(self.files(), ["s.json"])


class Show(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(WIDTH, HEIGHT, spheres=3))

    def draw(self, *options, name="a.ppm", **terminal):
        """What the terminal gets, and the picture's file."""
        terminal["environment"] = {**PLAIN, **terminal.get("environment", {})}
        screen = Terminal(self, "render", "s.json", *QUICK, "--show", "-o", name, *options, **terminal)
        self.assertEqual(screen.finish(), 0, screen.seen)
        return screen.seen, self.read(name)

    def read_blocks(self, seen, pattern):
        """Colours of the last drawing: above and below of each letter, row by row."""
        drawing = seen[seen.rindex(b"\x1b7"):seen.rindex(b"\x1b8")].decode()
        rows = []
        for line in drawing.split("\r\n"):
            cells = re.findall(pattern, line)
            self.assertTrue(cells, line)
            rows.append(cells)
        return rows

    def test_half_blocks(self):
        seen, file = self.draw(columns=120, environment={"COLORTERM": "truecolor"})
        cells = self.read_blocks(seen, r"\x1b\[38;2;(\d+);(\d+);(\d+)m\x1b\[48;2;(\d+);(\d+);(\d+)m▀")
        rows = []
        for line in cells:
            rows.append([tuple(map(int, cell[:3])) for cell in line])
            rows.append([tuple(map(int, cell[3:])) for cell in line])
        self.assertEqual((len(rows), len(rows[0])), (HEIGHT, WIDTH))  # it fits, so each pixel is one half of a letter
        self.assertEqual(rows, read_ppm(file))
        self.assertIn(b"\x1b[0m", seen)

    def test_a_narrow_terminal(self):
        seen, file = self.draw(columns=17, environment={"COLORTERM": "24bit"})
        cells = self.read_blocks(seen, r"\x1b\[38;2;(\d+);(\d+);(\d+)m\x1b\[48;2;(\d+);(\d+);(\d+)m▀")
        self.assertTrue(all(len(line) <= 16 for line in cells))
        self.assertLessEqual(abs(len(cells) * 2 * WIDTH / (len(cells[0]) * HEIGHT) - 1), 0.25)
        shown = [[tuple(map(int, cell[:3])) for cell in line] for line in cells]
        for a, b in zip(mean(shown), mean(read_ppm(file))):
            self.assertLess(abs(a - b), 12)

    def test_216_colours_and_no_utf8(self):
        seen, _ = self.draw(columns=120, environment={"LC_ALL": "C"})
        cells = self.read_blocks(seen, r"\x1b\[48;5;(\d+)m ")
        self.assertTrue(all(16 <= int(cell) <= 231 for line in cells for cell in line))
        self.assertGreater(len({cell for line in cells for cell in line}), 3)
        self.assertNotIn("▀".encode(), seen)

    def test_kitty(self):
        seen, file = self.draw(name="a.png", environment={"TERM": "xterm-kitty"})
        commands = re.findall(rb"\x1b_G([^;]*);([^\x1b]*)\x1b\\", seen[seen.rindex(b"\x1b7"):])
        self.assertTrue(commands[0][0].startswith(b"a=T,f=100,q=2,"), commands[0][0])
        self.assertTrue(all(len(data) <= 4096 for _, data in commands))
        self.assertTrue(commands[-1][0].endswith(b"m=0"))
        self.assert_same(base64.b64decode(b"".join(data for _, data in commands)), file)

    def test_iterm2(self):
        seen, file = self.draw(name="a.png", environment={"TERM_PROGRAM": "iTerm.app"})
        image = re.findall(rb"\x1b\]1337;File=inline=1;size=(\d+);[^:]*:([^\a]*)\a", seen)[-1]
        self.assertEqual(int(image[0]), len(file))
        self.assert_same(base64.b64decode(image[1]), file)

    def test_sixels_where_the_terminal_says_so(self):
        screen = Terminal(self, "render", "s.json", *QUICK, "--show", "-o", "a.ppm", environment=PLAIN, controls=True)
        screen.read_until(rb"\x1b\[c")
        os.write(screen.master, b"\x1b[?62;4;22c")
        self.assertEqual(screen.finish(), 0, screen.seen)
        rows = read_sixels(screen.seen[screen.seen.rindex(b"\x1b7"):])
        self.assertTrue(all(pixel is not None for row in rows for pixel in row), "pixels are missing")
        self.assertAlmostEqual(len(rows[0]) / len(rows), WIDTH / HEIGHT, delta=0.1)
        for a, b in zip(mean(rows), mean(read_ppm(self.read("a.ppm")))):
            self.assertLess(abs(a - b), 6)

    def test_sixels_as_another_decoder_reads_them(self):
        decoder = shutil.which("sixel2png")
        if not decoder:
            self.skipTest("sixel2png (Debian's libsixel-bin) is not installed")
        seen, file = self.draw(environment={"BALLPARK_SHOW": "sixel"})
        self.write("a.six", re.findall(rb"(?s)\x1bP.*?\x1b\\", seen)[-1])
        subprocess.run([decoder, "-i", "a.six", "-o", "sixel.png"], cwd=self.folder, check=True, timeout=LIMIT_SECONDS)
        width, height, bits, channels, rows, _ = read_png(self.read("sixel.png"))
        mine = read_sixels(seen[seen.rindex(b"\x1b7"):])
        self.assertEqual((width, height, bits, channels), (len(mine[0]), len(mine), 8, 3))
        for row, line in zip(rows, mine):
            for x, pixel in enumerate(line):
                for a, b in zip(row[3 * x:], pixel):
                    self.assertLess(abs(a - b), 2)
        # Dithering changes single pixels, not what is seen: the means of a grid of nine.
        picture = read_ppm(file)

        def part(grid, i, j):
            return mean([line[len(line) * i // 3:len(line) * (i + 1) // 3]
                         for line in grid[len(grid) * j // 3:len(grid) * (j + 1) // 3]])
        for i, j in ((i, j) for i in range(3) for j in range(3)):
            for a, b in zip(part(mine, i, j), part(picture, i, j)):
                self.assertLess(abs(a - b), 8)

    def test_a_terminal_without_sixels_and_a_silent_one(self):
        for answer in (b"\x1b[?64;1;14c", b""):
            screen = Terminal(self, "render", "s.json", *QUICK, "--show", "-o", "a.ppm", environment=PLAIN, controls=True)
            screen.read_until(rb"\x1b\[c")
            if answer:
                os.write(screen.master, answer)
            self.assertEqual(screen.finish(), 0, screen.seen)
            self.assertIn("▀".encode(), screen.seen)

    def test_the_environment_decides(self):
        seen, _ = self.draw(environment={"TERM": "xterm-kitty", "BALLPARK_SHOW": "sixel"})
        self.assertIn(b"\x1bP0;1q", seen)
        seen, _ = self.draw(environment={"TERM": "xterm-kitty", "TMUX": "/tmp/x"})
        self.assertIn("▀".encode(), seen)
        screen = Terminal(self, "render", "s.json", "--show", environment={"BALLPARK_SHOW": "etch"})
        self.assertEqual(screen.finish(), 2)
        self.assertIn(b"expected kitty, iterm2, sixel or blocks", screen.seen)

    def test_it_grows_in_place(self):
        screen = Terminal(self, "render", "s.json", "--spp", "60000000", "--show", "--preview", "0.1", "-o", "a.ppm",
                          environment={**PLAIN, "COLORTERM": "truecolor"})
        screen.read_until(rb"(?s)(\x1b8.*){3}")
        os.kill(screen.process.pid, signal.SIGINT)
        self.assertEqual(screen.finish(), 130)
        heights = re.findall(rb"\x1b8\x1b\[(\d+)B", screen.seen)
        ups = re.findall(rb"\r\x1b\[K\x1b\[(\d+)A\r\n", screen.seen)
        self.assertEqual(ups, heights[:-1])  # each begins where the one before began


main()
