"""ballpark view: by a window that plays a script, and in a real one under Xvfb.

test_view.py PROGRAM SOURCE_DIR FAKE_WINDOW [unittest's arguments]"""

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
import unittest

FAKE_WINDOW = os.path.abspath(sys.argv.pop(3))

from cli import LIMIT_SECONDS, PROGRAM, SOURCE, ProgramTest, main  # noqa: E402
from png import read_png  # noqa: E402

BALLS = {"camera": {"image_width": 80, "image_height": 40, "lookfrom": [0, 0, 10], "lookat": [0, 0, 0], "vfov": 20,
                    "samples_per_pixel": 4, "max_depth": 4},
         "background": [0.2, 0.2, 0.2],
         "materials": {"red": {"type": "diffuse_light", "emit": [0.9, 0, 0]},
                       "blue": {"type": "diffuse_light", "emit": [0, 0, 0.9]},
                       "matte": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
         "spheres": [{"center": [0, 0, 0], "radius": 1, "material": "red"},
                     {"center": [0, 0, -3], "radius": 0.9, "material": "blue"},
                     {"center": [0, -20, 0], "radius": 18, "material": "matte"}]}


class Scripted(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", BALLS)

    def view(self, *script, options=(), code=0, environment=None):
        """Runs the script; the lines of the log, split into words."""
        self.write("script", "\n".join(script) + "\n")
        result = self.run_program("view", "s.json", "-q", *options,
                                  environment={"BALLPARK_WINDOW": FAKE_WINDOW, "FAKE_WINDOW_SCRIPT": "script",
                                               "FAKE_WINDOW_LOG": "log", **(environment or {})})
        self.assertEqual(result.returncode, code, result.errors)
        self.result = result
        lines = [line.split(" ") for line in self.read("log").decode().splitlines()] if code == 0 else []
        self.assertFalse([line for line in lines if line[0] == "cannot"], lines)
        if code == 0:
            self.assertEqual(lines[-1], ["close"])
        return lines

    def shown(self, lines):
        """Size and mean colour of each picture."""
        return [(int(w), int(h), tuple(map(float, rgb[:3]))) for kind, w, h, *rgb in
                (line for line in lines if line[0] == "show")]

    def test_it_rests_at_the_wanted_noise(self):
        lines = self.view("rest", "quit", options=("--error", "2%"))
        pictures = self.shown(lines)
        self.assertEqual(lines[0], ["open", "80", "40", "s.json"])
        self.assertTrue(all(size[:2] == (80, 40) for size in pictures))
        self.assertGreater(len(pictures), 1)
        self.assertEqual(self.files(), ["log", "s.json", "script"])

    def test_the_title_tells(self):
        lines = self.view("rest", "key +", "rest", "quit", options=("--error", "0.2%"))
        titles = [" ".join(line[1:]) for line in lines if line[0] == "title"]
        self.assertRegex(titles[0], r"^s\.json: 80x40, \d+ samples?")
        self.assertTrue(any(re.search(r"noise [\d.]+ %, 0\.2 % in ", title) for title in titles) or
                        any("noise" in title for title in titles), titles)
        self.assertIn("+0.33 stops", titles[-1])

    def test_orbit_shows_what_was_hidden(self):
        """From the front the red sphere hides the blue one; from the right both are seen."""
        lines = self.view("rest", "drag 1 -20 0", "rest", "quit")  # half the height: 90 degrees
        first, last = self.shown(lines)[0][2], self.shown(lines)[-1][2]
        self.assertLess(abs(first[2] - first[1]), 3)
        self.assertGreater(last[2] - last[1], 3, lines)

    def test_pan_zoom_and_reset(self):
        lines = self.view("rest", "drag 3 0 -200", "rest", "key r", "rest", "wheel 8", "rest", "wheel -16", "rest",
                          "quit", options=("--error", "5%"))
        stops = self.stops(lines)
        red = [color[0] - color[1] for _, _, color in stops]
        self.assertEqual(len(red), 5)
        self.assertLess(red[1], 1)  # into the matte sphere, where it is black and yet comes to rest
        self.assertLess(abs(red[2] - red[0]), 3)  # back again
        self.assertGreater(red[3], 2 * red[0])  # nearer
        self.assertLess(red[4], red[0])  # farther

    def stops(self, lines):
        """The last picture before each rest."""
        rests = [number for number, line in enumerate(lines) if line[0] == "rested"]
        return [self.shown(lines[:number])[-1] for number in rests]

    def test_resizing(self):
        lines = self.view("rest", "resize 200 60", "rest", "quit", options=("--error", "5%"))
        self.assertEqual(self.shown(lines)[-1][:2], (120, 60))

    def test_what_does_nothing(self):
        """Keys without a meaning, and clicks on the background or beside the picture: what is seen has come to rest, and stays."""
        lines = self.view("rest", "key x", "click 0.01 0.01", "click 1.5 0.5", "click -0.5 0.5", "click 0.5 1.5", "click 0.5 -0.5", "rest",
                          "key s", "frames 0", "quit", options=("--error", "5%"))
        rested = [number for number, line in enumerate(lines) if line[0] == "rested"]
        self.assertEqual(len(rested), 2)
        self.assertEqual(self.shown(lines[rested[0]:rested[1]]), [])
        self.assertEqual(self.result.stdout.decode(), "ballpark render s.json --set 'camera=" + self.command_camera() + "'\n")

    def command_camera(self):
        """The camera of s.json as a command has it that is printed without any move."""
        self.view("rest", "key s", "frames 0", "quit", options=("--error", "5%"))
        return re.fullmatch(r"ballpark render s\.json --set 'camera=(.*)'\n", self.result.stdout.decode())[1]

    def test_a_click_with_a_lens(self):
        """It is drawn anew, sharp where the click was; wider and narrower angles are undone by each other."""
        lines = self.view("rest", "click 0.5 0.5", "rest", "key [", "key ]", "rest", "key s", "frames 0", "quit",
                          options=("--error", "5%", "--set", "camera.aperture=1", "--set", "camera.focus_dist=5"))
        rested = [number for number, line in enumerate(lines) if line[0] == "rested"]
        self.assertGreater(len(self.shown(lines[rested[0]:rested[1]])), 0)
        said = self.result.stdout.decode()
        self.assertAlmostEqual(float(re.search(r'"focus_dist": ([\d.]+)', said)[1]), 9, delta=0.05)
        self.assertAlmostEqual(float(re.search(r'"vfov": ([\d.]+)', said)[1]), 20, delta=1e-6)

    def test_exposure(self):
        lines = self.view("rest", "key +", "key +", "key +", "rest", "key 0", "rest", "quit",
                          options=("--error", "5%", "--transfer", "linear"))
        stops = [color[1] for _, _, color in self.stops(lines)]
        self.assertAlmostEqual(stops[1] / stops[0], 2, delta=0.1)
        self.assertAlmostEqual(stops[2], stops[0], delta=1)

    def test_the_printed_command_carries_what_is_seen(self):
        """Options, exposure and camera: the command renders the saved picture again, but for its noise."""
        options = ("--error", "2%", "--transfer", "linear", "--set", "background=[0.1,0.3,0.2]", "--exposure", "-1",
                   "--width", "60", "--lighting", "soft")
        self.view("rest", "drag 1 -3 2", "key -", "rest", "key s", "frames 0", "quit", options=options)
        command = shlex.split(self.result.stdout.decode())
        self.assertEqual(command[:3], ["ballpark", "render", "s.json"])
        self.assertAlmostEqual(float(command[command.index("--exposure") + 1]), -4 / 3)
        self.succeed(*command[1:], "--error", "2%", "-o", "again.png")
        saved, again = (read_png(self.read(name)) for name in ("s-view-1.png", "again.png"))
        self.assertEqual(saved[:2], again[:2])
        means = [sum(sum(row) for row in rows) for *_, rows, _ in (saved, again)]
        self.assertAlmostEqual(means[1] / means[0], 1, delta=0.05)

    def test_a_command_that_is_too_long(self):
        """Where --set is there as often as it can be, the camera is printed for itself."""
        many = ("--set", "background=[0.1,0.3,0.2]") * 256
        self.view("rest", "key s", "frames 0", "quit", options=("--error", "5%", *many))
        self.assertRegex(self.result.stdout.decode(), r'^camera=\{.*\}\n$')

    def test_saving(self):
        self.write("s-view-1.png", "somebody's")
        self.view("rest", "drag 1 -10 3", "key ]", "click 0.5 0.5", "rest", "key s", "rest", "key s", "frames 0", "quit",
                  options=("--error", "3%"))
        self.assertEqual(self.read("s-view-1.png"), b"somebody's")
        self.assertTrue(self.read("s-view-2.png").startswith(b"\x89PNG"))
        self.assertTrue(self.read("s-view-3.png").startswith(b"\x89PNG"))
        commands = self.result.stdout.decode().splitlines()
        self.assertEqual(len(commands), 2)
        match = re.fullmatch(r"ballpark render s\.json --set '(camera=.*)'", commands[0])
        self.assertIsNotNone(match, commands)
        self.succeed("render", "s.json", "--set", match[1], "-o", "again.ppm")
        self.succeed("render", "s.json", "-o", "before.ppm")
        self.assert_different(self.read("again.ppm"), self.read("before.ppm"))
        # The click has focused on the red sphere, nine units away.
        focus = float(re.search(r'"focus_dist": ([\d.]+)', match[1])[1])
        self.assertAlmostEqual(focus, 9, delta=0.05)

    def test_moves_without_end_do_not_starve_it(self):
        """A picture that takes longer than the next move is shown all the same, and the next ones are smaller."""
        self.write("s.json", {"camera": {"image_width": 320, "image_height": 160, "lookfrom": [0, 0, 5], "lookat": [0, 0, 0],
                                         "samples_per_pixel": 1, "max_depth": 300},
                              "materials": {"white": {"type": "lambertian", "albedo": [1, 1, 1], "emit": [0.001, 0.001, 0.001]}},
                              "spheres": [{"center": [0, 0, 0], "radius": 10, "material": "white"}]})
        widths = [width for width, *_ in self.shown(self.view("frames 1", "flood 4 drag 1 1 0", "quit"))]
        self.assertGreaterEqual(len(widths), 5)
        self.assertLessEqual(widths[-1], widths[0])

    def test_a_move_interrupts_the_full_size(self):
        """The first picture is small, as those of a moving camera are, and what rests is as large as the window."""
        widths = [width for width, *_ in self.shown(self.view("rest", "drag 1 5 0", "frames 1", "quit", options=(
            "--width", "1600", "--error", "20%")))]
        self.assertLess(widths[0], 1600)
        self.assertIn(1600, widths)

    def test_many_moves_leak_nothing(self):
        """Memory after 1,000 moves is what it was after 200. Large pages, which the other tests ask for, would blur that."""
        self.write("script", "rest\ntimes 1100 drag 1 1 0\nframes 1\nquit\n")
        process = subprocess.Popen([PROGRAM, "view", "s.json", "-q"], cwd=self.folder,
                                   env=dict(self.environment, BALLPARK_WINDOW=FAKE_WINDOW, FAKE_WINDOW_SCRIPT="script",
                                            FAKE_WINDOW_LOG="log", GLIBC_TUNABLES=""))
        self.addCleanup(lambda: process.poll() is None and (process.kill(), process.wait()))
        sizes = []
        while process.poll() is None:
            try:
                with open(f"/proc/{process.pid}/status") as status:
                    resident = int(re.search(r"VmRSS:\s+(\d+)", status.read())[1])
                frames = self.read("log").count(b"show")
                sizes.append((frames, resident))
            except (OSError, TypeError):
                pass
            time.sleep(0.05)
        self.assertEqual(process.returncode, 0)
        early = max(size for frames, size in sizes if 100 < frames < 400)
        late = max(size for frames, size in sizes if 900 < frames < 1050)
        self.assertLess(late, early + 4096, "kB")

    def test_faults(self):
        self.write("script", "quit\n")
        for environment, code, words in (({"FAKE_WINDOW_FAILS": "open"}, 1, "there is no room for it"),
                                         ({"FAKE_WINDOW_FAILS": "ready"}, 1, "there is no screen"),
                                         ({"FAKE_WINDOW_FAILS": "show"}, 1, "the window: the screen has gone"),
                                         ({"BALLPARK_WINDOW": "/nowhere.so"}, 2, "libsdl2-dev"),
                                         ({"BALLPARK_WINDOW": "libc.so.6"}, 2, "not a module of this version")):
            self.view("rest", "quit", code=code, environment=environment)
            self.assertIn(words, self.result.errors)
        # Without a screen, the error is all that is said, before any work.
        result = self.run_program("view", "nowhere.json", environment={"BALLPARK_WINDOW": FAKE_WINDOW,
                                                                       "FAKE_WINDOW_FAILS": "ready"})
        self.assertEqual(result.errors.splitlines(), [
            "ballpark: no window can be opened: there is no screen; without one, `ballpark render --show` draws in the "
            "terminal"])
        # Keys are told when the window is there to hear them.
        result = self.run_program("view", "s.json", environment={"BALLPARK_WINDOW": FAKE_WINDOW,
                                                                 "FAKE_WINDOW_FAILS": "open"})
        self.assertNotIn("left drag", result.errors)
        result = self.run_program("view", "nowhere.json", environment={"BALLPARK_WINDOW": FAKE_WINDOW})
        self.assertEqual(result.returncode, 2)
        self.assertIn("nowhere.json", result.errors)

    def test_ctrl_c(self):
        self.write("script", "frames 100000000\n")
        process = subprocess.Popen([PROGRAM, "view", "s.json"], cwd=self.folder, stderr=subprocess.PIPE, text=True,
                                   env=dict(self.environment, BALLPARK_WINDOW=FAKE_WINDOW, FAKE_WINDOW_SCRIPT="script",
                                            FAKE_WINDOW_LOG="log"))
        self.addCleanup(lambda: process.poll() is None and (process.kill(), process.wait()))
        deadline = time.monotonic() + LIMIT_SECONDS
        while b"show" not in (self.read("log") if os.path.exists(self.path("log")) else b""):
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        errors = process.communicate(timeout=LIMIT_SECONDS)[1]
        self.assertEqual(process.returncode, 130, errors)
        self.assertIn("left drag", errors)  # what keys do


MODULE = os.path.join(os.path.dirname(PROGRAM), "ballpark_window.so")
class NoScreen(ProgramTest):
    def test_libraries_are_silent(self):
        """The error is the only line, also where no folder for sockets is set, as over ssh and in containers."""
        for name in ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR"):
            self.environment.pop(name, None)
        result = self.run_program("view", "nowhere.json", environment={"SDL_VIDEODRIVER": "wayland"})
        if "cannot be loaded" in result.errors:
            self.skipTest("built without SDL 2")
        self.assertEqual(result.returncode, 1, result.errors)
        self.assertRegex(result.errors, r"^ballpark: no window can be opened: [^\n]+\n$")

    def test_without_a_display(self):
        """SDL opens a window that nobody sees, so nobody could close it."""
        self.write("s.json", BALLS)
        for driver in ("dummy", "offscreen"):
            result = self.run_program("view", "s.json", environment={"SDL_VIDEODRIVER": driver})
            if "cannot be loaded" in result.errors:
                self.skipTest("built without SDL 2")
            self.assertEqual(result.returncode, 1, result.errors)
            self.assertRegex(result.errors, r"^ballpark: no window can be opened: .*(display|not available)")


LACKS = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]


@unittest.skipIf(not os.path.exists(MODULE), "this build has no window, since SDL 2 (libsdl2-dev) was missing")
@unittest.skipIf(LACKS, f"no {' and no '.join(LACKS)} here, to try a real window")
class Screen(ProgramTest):
    def setUp(self):
        super().setUp()
        reading, writing = os.pipe()
        # Without -noreset the server restarts when its last client disconnects. That is xdotool, and may come before the
        # window, whose connection is then refused.
        server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "800x600x24", "-nolisten", "tcp",
                                   "-noreset"], pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        self.addCleanup(lambda: (server.terminate(), server.wait()))
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        if not number:
            self.skipTest("Xvfb does not start here")
        self.environment = {**self.environment, "DISPLAY": f":{number}", "SDL_VIDEODRIVER": "x11"}

    def tool(self, *arguments):
        result = subprocess.run(["xdotool", *arguments], env=self.environment, capture_output=True, text=True)
        return result.stdout.strip()

    def wait_for(self, process, ask, what):
        deadline = time.monotonic() + LIMIT_SECONDS
        while time.monotonic() < deadline:
            answer = ask()
            if answer:
                return answer
            if process.poll() is not None:
                self.fail(f"the program ended before {what}: {process.stderr.read()}")
            time.sleep(0.05)
        self.fail(f"waited too long for {what}")

    def test_a_real_window(self):
        scene = os.path.join(SOURCE, "scenes/v4-22-defocus.json")
        process = subprocess.Popen([PROGRAM, "view", scene, "--width", "320", "-q"], cwd=self.folder,
                                   env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(lambda: process.poll() is None and (process.kill(), process.wait()))
        title = lambda: self.tool("search", "--name", "v4-22-defocus", "getwindowname", "%@")  # noqa: E731
        self.wait_for(process, lambda: re.search(r": 320x180, \d+ samples, noise", title()), "a picture")
        self.tool("search", "--name", "v4-22-defocus", "windowfocus")
        self.tool("mousemove", "400", "300", "mousedown", "1", "mousemove", "430", "310", "mousemove", "450", "320",
                  "mouseup", "1")
        self.wait_for(process, lambda: self.press("s"), "the saved picture")
        self.tool("key", "q")
        out, errors = process.communicate(timeout=LIMIT_SECONDS)
        self.assertEqual(process.returncode, 0, errors)
        command = out.splitlines()[0]
        camera = re.search(r'"lookfrom": \[([^]]+)\]', command)[1].split(",")
        self.assertNotEqual([float(x) for x in camera], [-2, 2, 1])  # the drag has moved it
        self.assertTrue(self.read("v4-22-defocus-view-1.png").startswith(b"\x89PNG"))

    def press(self, key):
        self.tool("key", key)
        time.sleep(0.3)
        return "v4-22-defocus-view-1.png" in self.files()


main()
