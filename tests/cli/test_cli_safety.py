"""No file is lost: targets that cannot be replaced, two names of one file, inputs, open files, full devices, limits."""

import contextlib
import json
import os
import re
import select
import signal
import stat
import subprocess
import time

import cli
from cli import ProgramTest, main, scene

NOBODY = 65534


class Safety(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(8))

    def shell(self, line, code=0):
        """`line` by a shell; "$B" is the program."""
        result = subprocess.run(["/bin/sh", "-c", line], cwd=self.folder, env=dict(self.environment, B=cli.PROGRAM),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=cli.LIMIT_SECONDS)
        result.errors = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, code, f"{line}: {result.errors}")
        return result


class Replacing(Safety):
    def test_mounted_target(self):
        """A file on which another is mounted cannot be renamed over: the render is copied into it."""
        self.write("a.png", "")
        self.write("outside", "old")
        if subprocess.run(["mount", "--bind", self.path("outside"), self.path("a.png")], check=False,
                          stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("nothing can be mounted here")
        self.addCleanup(subprocess.run, ["umount", self.path("a.png")], check=True)
        self.succeed("render", "s.json", "-o", "a.png", "-q")
        self.assertTrue(self.read("outside").startswith(b"\x89PNG"))
        self.assertEqual(self.files(), ["a.png", "outside", "s.json"])

    def test_anothers_file_in_a_sticky_folder(self):
        if os.geteuid() != 0:
            self.skipTest("only root can make a file of somebody else's")
        os.chmod(self.folder, 0o1777)
        self.write("a.png", "old" * 1000)
        os.chown(self.path("a.png"), 12345, 12345)
        os.chmod(self.path("a.png"), 0o666)
        self.succeed("render", "s.json", "-o", "a.bpa", "-q")
        command = ("merge", "a.bpa", "-o", "a.png", "-q")
        try:
            result = subprocess.run([cli.PROGRAM, *command], cwd=self.folder, check=False, user=NOBODY, group=NOBODY,
                                    extra_groups=[], env=self.environment, stderr=subprocess.PIPE)
        except PermissionError:
            self.skipTest("another user cannot run the program here")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(self.read("a.png").startswith(b"\x89PNG"))
        self.assertEqual(os.stat(self.path("a.png")).st_uid, 12345)
        self.assertEqual(self.files(), ["a.bpa", "a.png", "s.json"])

    def test_permissions(self):
        self.write("a.png", "old")
        if os.geteuid() == 0:
            os.chown(self.path("a.png"), NOBODY, NOBODY)
        os.chmod(self.path("a.png"), 0o6751)
        self.succeed("render", "s.json", "-o", "a.png", "-q")
        state = os.stat(self.path("a.png"))
        self.assertEqual(stat.S_IMODE(state.st_mode), 0o751, "set-ID bits are not for another content")
        if os.geteuid() == 0:
            self.assertEqual((state.st_uid, state.st_gid), (NOBODY, NOBODY))

    def lose_the_folder(self, *options, **environment):
        """A render whose folder disappears after it was found to be writable; what it says."""
        os.mkdir(self.path("d"))
        os.mkfifo(self.path("pipe.json"))
        process = subprocess.Popen([cli.PROGRAM, "render", "pipe.json", *options], cwd=self.folder,
                                   env=dict(self.environment, **environment), stderr=subprocess.PIPE)
        with open(self.path("pipe.json"), "wb") as pipe:  # opens when the program reads, hence after the check
            os.rmdir(self.path("d"))
            pipe.write(self.read("s.json"))
        os.remove(self.path("pipe.json"))
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("create the folder first", said)
        return said

    def test_folder_that_disappears(self):
        """The sums are kept, in $TMPDIR or else in the current folder, and the command that is named makes the picture."""
        self.succeed("render", "s.json", "-o", "right.png", "-q")
        os.mkdir(self.path("tmp"))
        for folder, name in ((self.path("tmp"), "d/a.png"), ("/dev/null/no", "d/a.exr"), ("/dev/null/no", "d/a.bpa")):
            said = self.lose_the_folder("-o", name, "-q", TMPDIR=folder)
            kept = re.search(r"ballpark merge (\S+) -o FILE` makes the picture", said)
            self.assertTrue(kept, said)
            kept = os.path.join(self.folder, kept.group(1))
            self.assertEqual(os.path.dirname(os.path.normpath(kept)), folder if folder[1:4] != "dev" else self.folder)
            self.succeed("merge", kept, "-o", "kept.png", "-q")
            self.assert_same(self.read("kept.png"), self.read("right.png"))
            os.remove(kept)
            self.assertEqual(os.listdir(self.path("tmp")), [])

    def test_pipe_that_is_closed(self):
        """Who closes it wants no more of the picture: nothing is kept."""
        os.mkdir(self.path("tmp"))
        self.write("large.json", scene(200))
        errors = self.shell("TMPDIR=tmp \"$B\" render large.json -o - --format pfm -q | head -c 9 > start").errors
        self.assertEqual(errors, "")
        self.assertEqual(os.listdir(self.path("tmp")), [])

    def test_limit_on_the_size_of_files(self):
        self.write("a.pfm", "old")
        self.write("large.json", scene(64))
        self.succeed("render", "large.json", "-o", "a.bpa", "-q")
        result = self.shell("ulimit -f 1; exec \"$B\" merge a.bpa -o a.pfm -q", 1)  # drivers write files, too
        for text in ("File too large", "ulimit -f"):
            self.assertIn(text, result.errors)
        self.assertEqual(self.read("a.pfm"), b"old")
        self.assertEqual(self.files(), ["a.bpa", "a.pfm", "large.json", "s.json"])


class SmallDisk(Safety):
    """A disk that fills up, or can no longer be written, while a render goes on: what was written stays, what was rendered
    since is kept elsewhere, and both are told."""

    def setUp(self):
        super().setUp()
        self.write("s.json", scene(40, 30, spheres=3))
        for folder in ("disk", "tmp"):
            os.mkdir(self.path(folder))
        self.environment["TMPDIR"] = self.path("tmp")
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", self.path("disk")], check=False,
                              stderr=subprocess.DEVNULL)
        if done.returncode != 0:
            self.skipTest("nothing can be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", self.path("disk")], check=True)

    def begin(self):
        process = subprocess.Popen([cli.PROGRAM, "render", "s.json", "--spp", "60000000", "--checkpoint", "0.05", "-o", "disk/a.pfm",
                                    "-q"], cwd=self.folder, env=self.environment, stderr=subprocess.PIPE)
        self.addCleanup(process.stderr.close)
        self.addCleanup(lambda: process.poll() is None and (process.kill(), process.wait()))
        while "a.bpa" not in os.listdir(self.path("disk")) and process.poll() is None:
            time.sleep(0.01)
        return process

    def end(self, process, fault):
        """After the first warning."""
        said = process.stderr.readline().decode()
        self.assertIn("warning: the checkpoint was not written, and rendering continues: ", said)
        self.assertIn(fault, said)
        process.send_signal(signal.SIGTERM)
        said = process.stderr.read().decode()
        self.assertEqual(process.wait(timeout=cli.LIMIT_SECONDS), 1, said)
        self.assertIn(fault, said)
        kept = os.listdir(self.path("tmp"))
        self.assertEqual(len(kept), 1, said)
        self.assertIn(f"tmp/{kept[0]}", said)
        self.compare(os.path.join("tmp", kept[0]))
        self.compare("disk/a.bpa")

    def compare(self, film):
        """The picture of the film that goes on is that of a render without a break."""
        samples = str(json.loads(self.read(film).split(b"\n", 1)[0])["plan"]["done"] + 64)
        self.succeed("render", "s.json", "--resume", film, "--spp", samples, "-o", "resumed.pfm", "-q")
        self.succeed("render", "s.json", "--spp", samples, "-o", "whole.pfm", "-q")
        self.assert_same(self.read("resumed.pfm"), self.read("whole.pfm"))

    def test_disk_that_fills_up(self):
        process = self.begin()
        with open(self.path("disk/filler"), "wb", buffering=0) as filler:
            while process.poll() is None and not select.select([process.stderr], [], [], 0.01)[0]:
                with contextlib.suppress(OSError):
                    while filler.write(bytes(4096)) > 0:
                        pass
            self.end(process, "No space left")
        self.assertEqual(sorted(os.listdir(self.path("disk"))), ["a.bpa", "filler"])

    @cli.deep
    def test_disk_that_becomes_read_only(self):
        process = self.begin()
        while subprocess.run(["mount", "-o", "remount,ro", self.path("disk")], check=False,
                             stderr=subprocess.DEVNULL).returncode != 0:  # a checkpoint is being written
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        self.end(process, "Read-only file system")
        self.assertEqual(os.listdir(self.path("disk")), ["a.bpa"])
        for command in (("render", "s.json", "-o", "disk/b.png"), ("render", "s.json", "-o", "b.png", "--checkpoint", "1", "--resume", "disk/a.bpa"),
                        ("merge", "disk/a.bpa", "-o", "disk/b.png"), ("render", "s.json", "-o", "b.png", "--stats", "disk/b.json")):
            self.fail_with(1, *command, says=["disk/", "Read-only file system"])
            self.assertEqual(os.listdir(self.path("disk")), ["a.bpa"])


class TwoNames(Safety):
    def refuse(self, *arguments, says):
        before = {name: self.read(name) for name in self.files() if os.path.isfile(self.path(name))}
        self.fail_with(2, *arguments, "--device", "none", says=says)
        for name, content in before.items():
            self.assert_same(self.read(name), content, name)
        return before

    def test_results(self):
        os.mkdir(self.path("d"))
        os.symlink("..", self.path("d/up"))
        os.symlink("a.png", self.path("link.png"))
        for other in ("./a.png", "d/../a.png", "d/up/a.png", "link.png", self.path("a.png")):
            self.refuse("render", "s.json", "-o", "a.png", "--error-map", other, says="both name " + other)
        self.refuse("render", "s.json", "--error-map", "./s.png", says="both name ./s.png")
        self.refuse("render", "s.json", "--stats", "s.png", says="both name s.png")
        self.write("a.png", "old")
        os.link(self.path("a.png"), self.path("hard.png"))
        self.refuse("render", "s.json", "-o", "a.png", "--error-map", "hard.png", says="both name hard.png")
        os.mkdir(self.path("other"))
        self.succeed("render", "s.json", "-o", "b.png", "--error-map", "other/b.png", "-q")

    def test_results_are_no_scenes(self):
        """What the program has written itself is named, with what to do about it."""
        for ending, says in (("bpa", "`ballpark merge FILE.bpa -o FILE.png` makes the picture"), ("png", "found a PNG picture"),
                             ("exr", "found an EXR picture"), ("ppm", "found a PPM picture"), ("pfm", "found a PFM picture")):
            self.succeed("render", "s.json", "--spp", "1", "-o", f"made.{ending}", "-q")
            self.fail_with(2, "explain", f"made.{ending}", says=says)

    def test_endings_of_documents(self):
        """A page in cost.pdf, or a scene in s.png, would be found out much later."""
        for arguments, says in ((("cost", "s.json", "-o", "cost.pdf"), "use a name that ends in .html"),
                                (("scene", "s.json", "-o", "s.png"), "use a name that ends in .json"),
                                (("generate", "field", "--count", "3", "-o", "f.json"), "use a name that ends in .ply"),
                                (("generate", "cover", "-o", "c.ply"), "use a name that ends in .json")):
            self.fail_with(2, *arguments, says=says)
        for name in "cost.pdf", "s.png", "f.json", "c.ply":
            self.assertFalse(os.path.exists(self.path(name)), name)

    def test_inputs(self):
        self.write("s.png", scene(8))  # a scene may be called that
        self.refuse("render", "s.png", says="s.png is named like a picture, and the result would overwrite it")
        os.link(self.path("s.json"), self.path("hard.png"))
        self.refuse("render", "s.json", "-o", "hard.png", says="--output hard.png would overwrite")
        self.write("points.png", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                 "property float z\nend_header\n0 0 -2\n")
        os.mkdir(self.path("d"))
        cloud = scene(4, spheres=0, clouds=[{"file": "../points.png", "radius": 1, "material": "m"}])
        self.write("d/points.json", cloud)
        for more in (("-o", "points.png"), ("-o", "x.png", "--error-map", "points.png"), ()):
            self.refuse("render", "d/points.json", *more, says="points.png would overwrite points of the scene")
        self.refuse("check", "d/points.json", "--map", "points.png", says="points of the scene")
        os.rename(self.path("points.png"), self.path("m-0.png"))  # as the map of device 0 is called
        self.write("d/points.json", json.dumps(cloud).replace("points.png", "m-0.png"))
        points, every = self.read("m-0.png"), ("--device", "all", "--spp", "2", "--width", "2", "-q")
        self.fail_with(2, "check", "d/points.json", "--map", "m.png", *every, says="m-0.png would overwrite points")
        self.assert_same(self.read("m-0.png"), points)
        self.write("s-0.png", scene(8))
        self.fail_with(2, "check", "s-0.png", "--map", "s.png", *every, says="--map s-0.png would overwrite its own input")
        self.fail_with(2, "check", "s.json", "--map", "n.png", "--json", "n-0.png", *every, says="both name n-0.png")
        with open(self.path("s.json"), "rb") as sent:
            self.fail_with(2, "render", "-", "-o", "s.json", "--format", "png", stdin=sent, says="would overwrite")

    def test_names_of_what_is_made(self):
        """The operand of `generate` is no file, even if there is one of that name."""
        self.write("cover", "old")
        os.symlink("cover", self.path("cover.json"))
        self.succeed("generate", "cover", "-o", "cover.json", "-q")
        self.assertIn(b"camera", self.read("cover"))


class OpenFiles(Safety):
    def test_written_through(self):
        picture = self.succeed("render", "s.json", "-o", "-", "--format", "ppm", "-q").stdout
        for name in ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
            if not os.path.exists(name):
                continue
            self.write("out", "before\n")
            self.shell(f"\"$B\" render s.json --format ppm -q -o {name} >> out")
            self.assert_same(self.read("out"), b"before\n" + picture, name)
            self.shell(f"(echo before; \"$B\" render s.json --format ppm -q -o {name}; echo after) > out")
            self.assert_same(self.read("out"), b"before\n" + picture + b"after\n", name)
            piped = self.shell(f"\"$B\" render s.json --format ppm -q -o {name} | cat").stdout
            self.assert_same(piped, picture, name)
        self.shell("\"$B\" render s.json --format ppm -q -o /dev/fd/3 3> third")
        if os.path.isdir("/proc/self/fd"):  # another process's open file
            self.write("out", "before\n")
            self.shell("exec 3>> out; \"$B\" render s.json --format ppm -q -o /proc/$$/fd/3 || exit; echo after >&3")
            self.assert_same(self.read("out"), b"before\n" + picture + b"after\n")
        self.assert_same(self.read("third"), picture, "3")
        self.assertIn("no file is open", self.shell("\"$B\" render s.json --format ppm -o /dev/fd/9 9>&-", 1).errors)
        self.assertIn("no file is open", self.shell("\"$B\" render s.json --format ppm -o /dev/fd/0 < /dev/null", 1).errors)
        self.assertIn("both name", self.shell("\"$B\" render s.json --format ppm -o /dev/stdout --stats - > x", 2).errors)

    def test_named_pipe(self):
        os.mkfifo(self.path("pipe"))
        got = self.shell("cat pipe & \"$B\" render s.json --format ppm -q -o pipe; wait").stdout
        self.assertTrue(got.startswith(b"P6\n8 8\n"))
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode))

    def test_closed_streams(self):
        self.shell("\"$B\" render s.json -o a.png --stats t.json --error-map e.png <&- >&- 2>&-")
        self.succeed("render", "s.json", "-o", "b.png", "-q")
        self.assert_same(self.read("a.png"), self.read("b.png"))
        self.assertEqual(json.loads(self.read("t.json"))["width"], 8)
        if os.path.isdir("/proc/self/fd"):
            os.mkfifo(self.path("pipe"))
            process = subprocess.Popen(["/bin/sh", "-c", "exec \"$B\" render s.json --width 512 --spp 1 "
                                        "--format pfm -o pipe <&- >&- 2>&-"],
                                       cwd=self.folder, env=dict(self.environment, B=cli.PROGRAM))
            with open(self.path("pipe"), "rb"):  # both sides open it, and a pipe holds less than this picture
                opened = [os.readlink(f"/proc/{process.pid}/fd/{stream}") for stream in range(3)]
                process.kill()
                process.wait()
            self.assertEqual(opened, 3 * ["/dev/null"])
        self.assertIn("Bad file descriptor", self.shell("\"$B\" devices >&-", 1).errors)
        self.shell("\"$B\" render - -o c.png <&-", 1)

    def test_full_device(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("there is no /dev/full")
        for command in ("--version", "--help", "help render", "devices", "devices --json -", "explain s.json",
                        "explain s.json --json -", "explain s.json --pixel 1,1", "generate cover -o -",
                        "check s.json --width 4 --spp 4 --margin 50",
                        "check s.json --width 4 --spp 4 --margin 50 --device all",
                        "render s.json -o - -q", "render s.json -o a.png --stats - -q",
                        "bench s.json --time 0.01 --rounds 1"):
            self.assertIn("No space left", self.shell(f"\"$B\" {command} > /dev/full", 1).errors, command)

    def test_full_device_beside_another_failure(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("there is no /dev/full")
        errors = self.shell("\"$B\" check s.json --width 4 --spp 2 --margin 1e-6 > /dev/full", 4).errors
        self.assertIn("inconclusive", errors)
        self.assertIn("cannot write to standard output: No space left", errors)


class OneOfSeveral(Safety):
    """A document that cannot be written takes no other result of minutes of work with it."""

    @cli.deep
    def test_study(self):
        self.write("s.json", scene(4, 4))
        result = self.fail_with(1, "cost", "s.json", "--time", "0.1", "-o", "/dev/full", "--csv", "c.csv", "--json", "c.json",
                                stdout=subprocess.DEVNULL, says=["/dev/full", "No space left"])
        self.assertTrue(self.read("c.csv").endswith(b"\n"))
        self.assertIn("series", json.loads(self.read("c.json")))
        table = self.run_program("cost", "s.json", "--time", "0.1", "-o", "/dev/full")
        self.assertEqual(table.returncode, 1, result.errors)
        self.assertIn(b"Configurations", table.stdout)

    def test_check(self):
        self.write("s.json", scene(4, 4))
        result = self.run_program("check", "s.json", "--junit", "/dev/full", "--json", "j.json")
        self.assertEqual(result.returncode, 1, result.errors)
        self.assertIn("No space left", result.errors)
        self.assertIn("verdict", json.loads(self.read("j.json")))

    def test_bench(self):
        self.write("s.json", scene(4, 4))
        result = self.run_program("bench", "s.json", "--rounds", "1", "--time", "0.05", "--json", "/dev/full")
        self.assertEqual(result.returncode, 1, result.errors)
        self.assertIn(b"Msamples/s", result.stdout)


class Foreign(Safety):
    def test_escapes(self):
        evil = "\x1b]0;owned\x07\u009b31m\u202e"
        shown = "\\x1b]0;owned\\x07\\xc2\\x9b31m\\xe2\\x80\\xae"
        name = self.write("t" + evil + ".json", scene(8, title="T" + evil))
        runs = [self.succeed("explain", name), self.succeed("render", name, "-o", "p" + evil + ".png"),
                self.succeed("check", name, "--width", "4", "--spp", "4", "--margin", "50"),
                self.run_program("render", name, "-o", "no" + evil + "/a.png"),
                self.run_program("render", "none" + evil), self.run_program("what" + evil)]
        self.succeed("render", name, "-o", "a.bpa", "-q")
        runs.append(self.succeed("merge", "a.bpa", "-o", "m" + evil + ".png"))
        for run in runs:
            text = run.stdout.decode(errors="surrogateescape") + run.errors
            for bad in evil.replace("]0;owned", "").replace("31m", ""):
                self.assertNotIn(bad, text, run.args)
        self.assertIn("T" + shown, runs[0].stdout.decode())
        self.assertIn("p" + shown, runs[1].errors)
        entry = json.loads(self.succeed("explain", name, "--json", "-").stdout)["scenes"][0]
        self.assertEqual((entry["scene"], entry["title"]), (name, "T" + evil))

    def test_control_characters_in_names(self):
        """Names of files and what files hold: no line feed, no sequence for the terminal goes out, in whatever is printed."""
        odd = "a\nb\x1b[31mc\x7f\u009b31m\u202ed"
        spheres = odd + ".xyz"
        self.write(spheres, f"2\n\nC{odd[3:8]} 0 0 0\nO 0 0 1.2\n")
        document = odd + ".json"
        self.write(document, scene(8))
        shown = r"a\x0ab\x1b[31mc\x7f\xc2\x9b31m\xe2\x80\xaed"
        for arguments in (["render", spheres, "--width=8", "--spp=2", "-o", odd + ".png", "--stats", "-"],
                          ["render", document, "-o", odd + ".png", "--stats", "-"], ["scene", spheres], ["explain", spheres],
                          ["check", document, "--spp", "4", "--margin", "50", "--json", "-"],
                          ["check", document, "--spp", "4", "--margin", "50", "--junit", "-"],
                          ["explain", document, "--json", "-"], ["render", document + "x"], ["merge", document]):
            result = self.run_program(*arguments)
            self.assertNotRegex(result.stdout.decode(), "[\0-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e]", arguments)
            self.assertNotRegex(result.errors, "[\0-\x09\x0b-\x1f\x7f-\x9f\u202a-\u202e]", arguments)
            self.assertNotIn("a\nb", result.stdout.decode() + result.errors, arguments)
            if "--stats" in arguments:
                self.assertIn(shown + ".png: ", result.errors)
                self.assertEqual(json.loads(result.stdout)["scene"], arguments[1])

    def test_names_that_are_not_utf8(self):
        name = os.fsdecode(b"n\xff\xc0.json")
        try:
            self.write(name, scene(8))
        except OSError:
            self.skipTest("this file system has no such names")
        for command in (("render", name, "-o", os.fsdecode(b"o\xfe.png"), "--stats", "t.json", "-q"),
                        ("explain", name, "--json", "t.json"),
                        ("check", name, "--width", "4", "--spp", "4", "--margin", "50", "--json", "t.json"),
                        ("bench", name, "--time", "0.01", "--rounds", "1", "--json", "t.json", "-q")):
            self.succeed(*command)
            self.assertIn("n\ufffd\ufffd.json", self.read("t.json").decode(), command)
            self.assertIsInstance(json.loads(self.read("t.json")), dict)
        self.assertIn(b"o\xfe.png", os.listdir(os.fsencode(self.folder)))


class Bounds(Safety):
    def test_what_has_no_end(self):
        with open("/dev/zero", "rb") as zeros:
            self.fail_with(2, "render", "-", "-o", "a.png", stdin=zeros, says="more than 512 MiB")
        self.fail_with(2, "render", "/dev/zero", "-o", "a.png", says="found a device")
        with open(self.path("sparse.json"), "wb") as file:
            file.truncate(1 << 40)
        self.fail_with(2, "render", "sparse.json", "-o", "a.png", says="more than 512 MiB")
        self.write("p.ply", "ply\nformat ascii 1.0\n")
        with open(self.path("p.ply"), "r+b") as file:
            file.truncate(1 << 40)
        self.write("c.json", scene(4, clouds=[{"file": "p.ply", "radius": 1, "material": "m"}]))
        self.fail_with(2, "render", "c.json", "-o", "a.png", says="expected at most")


if __name__ == "__main__":
    main()
