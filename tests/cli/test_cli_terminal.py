"""What a person at a terminal sees: the progress bar, its width, and Ctrl-C."""

import json
import os
import re
import signal
import subprocess
import time
import unicodedata

from cli import LIMIT_SECONDS, PROGRAM, ProgramTest, deep, main, scene
from terminal import Terminal

# What renders for as long as a test looks leaves the other cores to other tests.
FOREVER = ("--threads", "1", "--spp", "60000000")


class Bar(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(64))

    def draw(self, *options, seconds="0.7", **terminal):
        screen = Terminal(self, "render", "s.json", "--threads", "1", "--time", seconds, *options, **terminal)
        self.assertEqual(screen.finish(), 0, screen.seen)
        return screen

    def test_what_it_says(self):
        # How often it is drawn in a second is the machine's affair: one that stands still for one gets another chance.
        for seconds in "1.5", "6", "24":
            screen = self.draw(seconds=seconds)
            bars = [text for text in screen.drawings() if "%" in text]
            if len(bars) > 2:
                break
        self.assertGreater(len(bars), 2)
        self.assertRegex(bars[-1], r"^[█░▏▎▍▌▋▊▉]+ +\d+ %  \d+ s left  noise [\d.]+ %  [\d.]+ \w+ samples/s$")
        shares = [int(re.search(r"(\d+) %", text)[1]) for text in bars]
        self.assertGreater(shares[-1], shares[0])
        self.assertEqual(screen.drawings()[-1], "", "it takes itself away")
        self.assertRegex(screen.seen.decode().split("\x1b[K")[-1], r"^s\.png: 64x64, ")

    def test_width(self):
        for columns in (20, 33, 60, 80, 200):
            for text in self.draw(columns=columns).drawings():
                self.assertLess(sum(not unicodedata.combining(c) for c in text), columns, text)

    @deep
    def test_every_narrow_width(self):
        """One render, whose terminal is resized: what is drawn never reaches the last column, where lines would wrap."""
        screen = Terminal(self, "render", "s.json", *FOREVER, columns=80)
        screen.read_until(rb"left  noise")  # the bar itself, not the wait for the kernel before it
        for columns in range(1, 41):
            screen.resize(columns)
            self.assertTrue(screen.drawings())
            for text in screen.drawings():
                self.assertLess(len(text), columns, text)
                self.assertTrue(columns < 7 or "%" in text, text)
        os.kill(screen.process.pid, signal.SIGINT)
        self.assertEqual(screen.finish(), 130)

    def test_waiting_in_a_narrow_terminal(self):
        os.mkfifo(self.path("slöw.json"))
        for columns in (1, 7, 8, 10, 17, 18):
            screen = Terminal(self, "render", "slöw.json", columns=columns)
            screen.read_until(rb"\x1b\[K[^\x1b]*\x1b\[K")
            for text in screen.drawings():
                self.assertLess(len(text), columns, text)
                self.assertRegex(text, r"\A\Z|\d s\Z", "a number is drawn whole or not at all")
            self.assertEqual(any(screen.drawings()), columns >= 8)
            screen.process.kill()

    def test_plain_letters(self):
        screen = self.draw(environment={"LC_ALL": "C"})
        self.assertTrue(screen.seen.isascii())
        self.assertIn(b"#", screen.seen)

    def test_nothing_where_it_is_not_wanted(self):
        self.assertNotIn(b"\x1b", self.draw("--quiet").seen)
        self.assertEqual(self.draw("--quiet").seen, b"")
        self.assertNotIn(b"\x1b", self.draw(environment={"TERM": "dumb"}).seen)
        piped = self.succeed("render", "s.json", "--time", "0.7")
        self.assertNotIn("\x1b", piped.errors)
        self.assertNotIn("\r", piped.errors)

    def test_no_picture_on_a_terminal(self):
        screen = Terminal(self, "render", "s.json", "-o", "-")
        self.assertEqual(screen.finish(), 2)
        self.assertIn(b"terminal", screen.seen)
        with open(self.path("out.ppm"), "wb") as file:
            screen = Terminal(self, "render", "s.json", "-o", "-", "--format", "ppm", stdout=file)
            self.assertEqual(screen.finish(), 0)
        self.assertTrue(self.read("out.ppm").startswith(b"P6\n64 64\n"))

    def test_waiting(self):
        """A scene that takes a while to read says so; a pipe that is slow to deliver it stands in for a large one."""
        os.mkfifo(self.path("slow.json"))
        screen = Terminal(self, "render", "slow.json", "--spp", "1")
        screen.read_until(rb"reading slow\.json")
        with open(self.path("slow.json"), "wb") as pipe:
            pipe.write(b'{"camera": {}, "spheres": 3}')
        self.assertEqual(screen.finish(), 2)
        self.assertNotRegex(screen.seen.decode().split("\x1b[K")[-1], "reading")


class Interrupt(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(64))

    def stop(self, *options, by=signal.SIGINT, wait_for=rb"left  noise"):
        screen = Terminal(self, "render", "s.json", *FOREVER, *options)
        screen.read_until(wait_for)
        os.kill(screen.process.pid, by)
        self.assertEqual(screen.finish(), 130, screen.seen)
        return screen.seen.decode().split("\x1b[K")[-1]

    def test_picture_is_there(self):
        for by in (signal.SIGINT, signal.SIGTERM):
            said = self.stop("-o", f"{by.name}.png", "--stats", "stats.json", by=by)
            samples = int(re.search(r"interrupted after (\d+) of 60000000 samples per pixel", said)[1])
            self.assertGreater(samples, 0)
            self.assertIn(f"{by.name}.png", said)
            self.assertTrue(self.read(f"{by.name}.png").endswith(b"IEND\xaeB`\x82"))
            stats = json.loads(self.read("stats.json"))
            self.assertEqual((stats["samples_per_pixel"], stats["stopped_by"]), (samples, "interrupt"))
            self.assertGreaterEqual(stats["samples"], samples * 64 * 64)
        self.assertEqual(self.files(), ["SIGINT.png", "SIGTERM.png", "s.json", "stats.json"])

    def test_control_c_from_the_keyboard(self):
        """A terminal and a shell may both pass the same key on: a quarter of a second is one key."""
        for _ in range(10):
            screen = Terminal(self, "render", "s.json", *FOREVER)
            # A session of its own has no controlling terminal: the key is stood in for by the signal to the group.
            screen.read_until(rb"left  noise")
            start = time.monotonic()
            os.killpg(screen.process.pid, signal.SIGINT)
            time.sleep(0.03)
            os.killpg(screen.process.pid, signal.SIGINT)
            self.assertEqual(screen.finish(), 130)
            # Where the machine stood still for that long between the two, they were two keys and prove nothing.
            if "s.png" in self.files() or time.monotonic() - start < 0.25:
                break
        self.assertIn("s.png", self.files())

    def test_quiet_still_tells(self):
        # Without a bar nothing tells from outside that the first samples are there; the picture tells in the end. That
        # the program has begun, a pipe tells from which it reads its scene.
        os.mkfifo(self.path("pipe.json"))
        for seconds in 1, 4, 16, 64:
            process = subprocess.Popen([PROGRAM, "render", "pipe.json", *FOREVER, "--quiet", "-o", "s.png"],
                                       cwd=self.folder, stderr=subprocess.PIPE, env=self.environment)
            with open(self.path("pipe.json"), "wb") as pipe:
                pipe.write(self.read("s.json"))
            time.sleep(seconds)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=LIMIT_SECONDS)
            self.assertEqual(process.returncode, 130)
            if "s.png" in self.files():
                break
            self.assertEqual(errors, b"")
        self.assertRegex(errors.decode(), r"\Aballpark: interrupted after \d+ of 60000000")

    def test_sums_that_were_interrupted_can_be_kept(self):
        self.stop("-o", "a.bpa")
        self.succeed("merge", "a.bpa", "-o", "a.png")

    def test_before_anything_is_there(self):
        """Nothing to save: it ends at once, and an old picture stays."""
        self.write("s.png", "precious")
        os.mkfifo(self.path("slow.json"))
        screen = Terminal(self, "render", "slow.json", "-o", "s.png")
        screen.read_until(rb"reading slow\.json")
        os.kill(screen.process.pid, signal.SIGINT)
        self.assertEqual(screen.process.wait(timeout=LIMIT_SECONDS), 130)
        self.assertEqual(self.read("s.png"), b"precious")
        self.assertEqual(self.files(), ["s.json", "s.png", "slow.json"])


if __name__ == "__main__":
    main()
