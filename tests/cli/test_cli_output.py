"""Where results go: pipes, folders, files that are there already, readers that leave."""

import json
import os
import re
import signal
import subprocess
import time

from cli import LIMIT_SECONDS, PROGRAM, ProgramTest, deep, main, scene
from terminal import Terminal


class Generate(ProgramTest):
    def test_documented_pipe(self):
        self.write("cover.png", "old")
        done = subprocess.run(["sh", "-c", "\"$B\" generate cover --grid 1 | \"$B\" render - -o cover.png --width 16 --spp 1"],
                              cwd=self.folder, env=dict(self.environment, B=PROGRAM), stderr=subprocess.PIPE, timeout=LIMIT_SECONDS)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.files(), ["cover.png"])
        self.assertTrue(self.read("cover.png").startswith(b"\x89PNG"))

    def test_into_a_file(self):
        with open(self.path("redirected"), "wb") as file:
            self.succeed("generate", "cover", "--grid", "1", stdout=file)
        self.assertEqual(self.files(), ["redirected"])
        self.assertIn("camera", json.loads(self.read("redirected")))

    def test_on_a_terminal(self):
        screen = Terminal(self, "generate", "cover", "--grid", "1")
        self.assertEqual(screen.finish(), 0)
        self.assertEqual(self.files(), ["cover.json"])
        screen = Terminal(self, "generate", "field", "-o", "-")
        self.assertEqual(screen.finish(), 2)
        self.assertIn(b"refusing to write a binary PLY", screen.seen)

    def test_field(self):
        piped = self.succeed("generate", "field", "--count", "100").stdout
        self.succeed("generate", "field", "--count", "100", "-o", "a.ply")
        self.assert_same(piped, self.read("a.ply"))

    def test_endings(self):
        for what, name, right in ("cover", "a.png", ".json"), ("cover", "a.ply", ".json"), ("cover", "a", ".json"), \
                                 ("cover", ".json", ".json"), ("field", "a.json", ".ply"), ("field", "a.png", ".ply"):
            self.fail_with(2, "generate", what, "--output", name, says=[name, f"ends in {right}"])
        self.assertEqual(self.files(), [])
        self.succeed("generate", "cover", "--grid", "0", "-o", "A.JSON")
        self.succeed("generate", "cover", "--grid", "0", "-o", "/dev/null")


class Clobber(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene())

    def commands(self):
        """Each command with every file that it can write."""
        self.succeed("render", "s.json", "-o", "in.bpa", "-q")
        small = ("--width", "4", "--spp", "4", "--margin", "99%")
        return [
            (("render", "s.json", "-o", "a.png"), ["a.png"]),
            (("render", "s.json"), ["s.png"]),
            (("render", "s.json", "-o", "b.bpa", "--stats", "b.json", "--error-map", "b.png"), ["b.bpa", "b.json", "b.png"]),
            (("merge", "in.bpa", "-o", "c.pfm", "--error-map", "c.png"), ["c.pfm", "c.png"]),
            (("check", "s.json", *small, "--json", "d.json", "--map", "d.png"), ["d.json", "d.png"]),
            (("explain", "s.json", "--json", "e.json"), ["e.json"]),
            (("cost", "s.json", "--width", "4", "--time", "0.2", "-o", "f.html", "--csv", "f.csv", "--json", "f.json"),
             ["f.html", "f.csv", "f.json"]),
            (("bench", "cover", "-o", "folder"), ["folder/cover.json"]),
            (("bench", "field-10", "-o", "folder"), ["folder/field-10.json", "folder/field-10.ply"]),
            (("bench", "s.json", "--rounds", "1", "--time", "0.05", "--json", "g.json"), ["g.json"]),
            (("devices", "--json", "h.json"), ["h.json"]),
            (("generate", "cover", "-o", "i.json"), ["i.json"]),
            (("generate", "field", "--count", "9", "-o", "i.ply"), ["i.ply"]),
        ]

    @deep
    def test_every_command(self):
        os.mkdir(self.path("folder"))
        for command, files in self.commands():
            for name in files:
                with self.subTest(command=command, name=name):
                    self.write(name, "precious")
                    self.fail_with(1, *command, "--no-clobber", says=[name, "File exists", "--no-clobber"])
                    self.assertEqual(self.read(name), b"precious")
                    said = self.succeed(*command).errors
                    self.assertIn(f"{name} exists and will be overwritten", said)
                    self.assertNotEqual(self.read(name), b"precious")
                    for other in files:
                        os.remove(self.path(other))
            said = self.succeed(*command, "--no-clobber").errors
            self.assertNotIn("overwritten", said)

    def test_a_refused_command_overwrites_nothing(self):
        """What is refused, even late, says nothing of files that it leaves alone. Documents of check are written in any case."""
        self.write("bad.json", "{}")
        self.succeed("render", "s.json", "-o", "f.bpa", "-q")
        refused = [
            ("render", "s.json", "-o", "a.png", "--error", "1%", "--share", "1/2"),
            ("render", "s.json", "-o", "a.png", "--device", "none such"),
            ("render", "s.json", "-o", "a.png", "--depth-fog", "50"),
            ("render", "s.json", "-o", "a.png", "--stats", "a.json", "--set", "camera.vfow=3"),
            ("render", "bad.json", "-o", "a.png", "--error-map", "b.png"),
            ("merge", "f.bpa", "-o", "a.png", "--depth-fog", "50"),
            ("check", "s.json", "--map", "a.png", "--device", "none such"),
            ("cost", "bad.json", "-o", "a.html", "--json", "a.json"),
            ("bench", "bad.json", "--rounds", "1", "--json", "a.json"),
            ("explain", "bad.json", "--json", "a.json"),
            ("explain", "s.json", "--pixel", "9999,9999", "--json", "a.json"),
            ("scene", "bad.json", "-o", "a.json"),
            ("generate", "cover", "--grid", "5", "--count", "5", "-o", "a.json"),
        ]
        for name in ("a.png", "b.png", "a.json", "a.html"):
            self.write(name, "precious")
        for command in refused:
            with self.subTest(command=command):
                done = self.run_program(*command)
                self.assertNotEqual(done.returncode, 0)
                self.assertNotIn("overwritten", done.errors)
        for name in ("a.png", "b.png", "a.json", "a.html"):
            self.assertEqual(self.read(name), b"precious")

    def test_not_said(self):
        self.write("a.png", "old")
        self.assertEqual(self.succeed("render", "s.json", "-o", "a.png", "-q").errors, "")
        self.assertNotIn("overwritten", self.succeed("render", "s.json", "-o", "/dev/null", "--format", "png").errors)

    def test_written_scenes_are_named(self):
        os.mkdir(self.path("folder"))
        said = self.succeed("bench", "cover", "field-10", "-o", "folder").errors
        self.assertEqual(said, "folder/cover.json: the scene cover\nfolder/field-10.json: the scene field-10\n")

    def test_devices_and_pipes_are_no_files(self):
        self.succeed("render", "s.json", "-o", "/dev/null", "--format", "png", "--no-clobber")
        self.succeed("render", "s.json", "-o", "-", "--no-clobber")

    def race(self, *arguments, environment=None):
        """Another program makes a.png while this one renders."""
        process = subprocess.Popen([PROGRAM, "render", "s.json", "--time", "2", "-o", "a.png", "--no-clobber", *arguments],
                                   cwd=self.folder, stderr=subprocess.PIPE, env=dict(self.environment, **(environment or {})))
        time.sleep(1)
        self.assertIsNone(process.poll())
        self.write("a.png", "theirs")
        errors = process.communicate(timeout=LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 1, errors)
        self.assertEqual(self.read("a.png"), b"theirs")
        kept = re.search(r"the complete result is in ([^\s;]+)", errors)[1]
        self.assertTrue(self.read(kept).startswith(b"\x89PNG"), errors)
        os.remove(self.path(kept))

    def test_race(self):
        self.race()
        self.assertEqual(self.files(), ["a.png", "s.json"])

    def test_two_programs(self):
        """Of several that write one new file at a time, exactly one does."""
        command = [PROGRAM, "generate", "cover", "--grid", "40", "-o", "c.json", "--no-clobber", "-q"]
        several = [subprocess.Popen(command, cwd=self.folder, env=self.environment, stderr=subprocess.DEVNULL) for _ in range(4)]
        codes = sorted(process.wait(timeout=LIMIT_SECONDS) for process in several)
        self.assertEqual(codes, [0, 1, 1, 1])
        json.loads(self.read("c.json"))


class ReaderLeaves(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(300))

    def run_into_nothing(self, *arguments, end=-signal.SIGPIPE):
        reading, writing = os.pipe()
        os.close(reading)
        with os.fdopen(writing, "wb") as output:
            result = self.run_program(*arguments, stdout=output)
        self.assertEqual(result.returncode, end, result.errors)
        return result.errors

    def test_quiet_end(self):
        for arguments in (("devices",), ("devices", "--json", "-"), ("explain", "s.json"), ("help", "render"), ("--version",),
                          ("generate", "cover"), ("generate", "field", "--count", "100000"),
                          ("check", "s.json", "--width", "4", "--spp", "4", "--margin", "99%"), ("bench", "s.json", "--rounds", "1", "--time", "0.05")):
            self.assertNotIn("ballpark:", self.run_into_nothing(*arguments), arguments)
            self.assertNotIn("roken pipe", self.run_into_nothing(*arguments), arguments)

    def test_other_files_are_written(self):
        self.run_into_nothing("render", "s.json", "--spp", "2", "-o", "-", "--error-map", "e.png", "--stats", "t.json", "-q")
        self.assertTrue(self.read("e.png").startswith(b"\x89PNG"))
        self.assertEqual(json.loads(self.read("t.json"))["samples_per_pixel"], 2)
        self.run_into_nothing("cost", "s.json", "--width", "4", "--time", "0.2", "-o", "c.html", "--json", "c.json", "-q", end=0)
        self.run_into_nothing("cost", "s.json", "--width", "4", "--time", "0.2", "-o", "c.html", "--json", "c.json")
        json.loads(self.read("c.json"))
        self.run_into_nothing("bench", "s.json", "--rounds", "1", "--time", "0.05", "--json", "b.json")
        json.loads(self.read("b.json"))

    def test_errors_are_told(self):
        self.assertIn("none.json", self.run_into_nothing("explain", "s.json", "none.json", end=2))


if __name__ == "__main__":
    main()
