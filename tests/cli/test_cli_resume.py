"""A render that is stopped keeps what it has, says how to go on, and goes on to the picture that it would have made."""

import os
import shlex
import shutil
import signal
import subprocess
import time

import bpa
import cli


class Resume(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", cli.scene(64, 48, spheres=4, camera={"samples_per_pixel": 6000}))
        self.succeed("render", "s.json", "--spp", 1, "-o", "first.exr", "-q")  # builds the kernels, once
        self.succeed("render", "s.json", "--spp", 32, "--adaptive", "-o", "first.exr", "-q")
        os.remove(self.path("first.exr"))

    def start(self, *arguments):
        return subprocess.Popen([cli.PROGRAM, "render", "s.json", *map(str, arguments)], cwd=self.folder,
                                env=self.environment, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)

    def stop_at(self, file, number, *arguments):
        """Starts a render and sends the signal as soon as `file` is there, or it has ended; its exit code and what it said."""
        process = self.start(*arguments)
        while file not in self.files() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(number)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        return process.returncode, said

    def command_in(self, said):
        lines = [line for line in said.splitlines() if line.startswith("ballpark render ")]
        self.assertEqual(len(lines), 1, said)
        return shlex.split(lines[0])

    def go_on(self, said, *more):
        command = self.command_in(said)
        return self.succeed(*command[1:], *more)

    def test_every_signal(self):
        """What there is is kept and can be gone on from, and the message has the command."""
        for kind in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGXCPU):
            code, said = self.stop_at("a.bpa", kind, "--spp", 60000000, "--checkpoint", 0.05, "-o", "a.pfm")
            self.assertEqual(code, 130, f"{kind.name}: {said}")
            self.assertIn("a.pfm holds the picture so far; this command continues it", said)
            self.assertEqual(self.command_in(said), ["ballpark", "render", "s.json", "--resume", "a.bpa", "--output", "a.pfm",
                                                     "--spp", "60000000", "--checkpoint", "0.05"])
            self.assertEqual(self.files(), ["a.bpa", "a.pfm", "s.json"])
            header, _ = bpa.read(self.read("a.bpa"))
            self.assertEqual(header["plan"]["samples_max"], 60000000)
            self.succeed("merge", "a.bpa", "-o", "b.pfm", "-q")  # the same samples in both
            self.assert_same(self.read("a.pfm"), self.read("b.pfm"), kind.name)
            for name in ("a.bpa", "a.pfm", "b.pfm"):
                os.remove(self.path(name))

    def interrupted_and_whole(self, suffix, *options):
        """The file of one render, and that of one which was stopped and went on, three times."""
        name = "a" + suffix
        self.succeed("render", "s.json", *options, "-o", "whole" + suffix, "-q")
        code, said = self.stop_at("a.bpa", signal.SIGTERM, *options, "--checkpoint", 0.02, "-o", name)
        stops = 0
        while code == 130 and stops < 3:
            stops += 1
            process = subprocess.Popen([cli.PROGRAM, *self.command_in(said)[1:]], cwd=self.folder, env=self.environment,
                                       stdin=subprocess.DEVNULL, stderr=subprocess.PIPE)
            time.sleep(0.5)
            process.send_signal(signal.SIGUSR1)
            new = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
            code, said = process.returncode, new if "ballpark render " in new else said
            self.assertIn(code, (0, 130), new)
        if code == 130:
            self.go_on(said)
        self.assert_same(self.read(name), self.read("whole" + suffix), options)
        self.assertNotIn("a.bpa" if suffix != ".bpa" else "a.exr", self.files())
        os.remove(self.path(name))
        return stops

    @cli.deep
    def test_the_same_bits(self):
        self.interrupted_and_whole(".exr")
        self.interrupted_and_whole(".exr", "--error", 0.15, "--adaptive")
        for options in (["--first-sample", 77], ["--adaptive", "--sampler", "independent"], ["--share", "2/3", "--seed", 2**64 - 1]):
            samples = 5000
            while self.interrupted_and_whole(".bpa", "--spp", samples, *options) == 0:
                samples *= 4  # the render was faster than its signal
                self.assertLess(samples, 10**7)

    def test_more_samples_than_before(self):
        """A finished file goes on, too; also one of sums alone, and one that was merged of neighbours."""
        self.succeed("render", "s.json", "--spp", 20, "-o", "whole.bpa", "-q")
        self.succeed("render", "s.json", "--spp", 9, "-o", "a.bpa", "-q")
        self.write("sums.bpa", bpa.sums_alone(self.read("a.bpa")))
        self.succeed("render", "s.json", "--spp", 3, "--first-sample", 9, "-o", "b.bpa", "-q")
        self.succeed("merge", "a.bpa", "b.bpa", "-o", "ab.bpa", "-q")
        for name in ("a.bpa", "sums.bpa", "ab.bpa"):
            self.succeed("render", "s.json", "--resume", name, "--spp", 20, "-o", "more.bpa", "-q")
            self.assert_same(self.read("more.bpa"), self.read("whole.bpa"), name)
        # Nothing is left to do where it had finished.
        before = self.read("whole.bpa")
        said = self.succeed("render", "s.json", "--resume", "whole.bpa", "-o", "again.bpa").errors
        self.assert_same(self.read("again.bpa"), before)
        self.assertIn("0 samples traced", said)

    def test_options_that_contradict(self):
        self.succeed("render", "s.json", "--spp", 8, "--first-sample", 4, "-o", "a.bpa", "-q")
        before = self.read("a.bpa")
        for options, says in ((["--seed", 1], "--seed 1 contradicts --resume a.bpa, which has --seed 0"),
                              (["--depth", 3], "--depth 3 contradicts --resume a.bpa, which has --depth 10"),
                              (["--width", 65], "--width 65 contradicts --resume a.bpa, which is 64 pixels wide"),
                              (["--first-sample", 5], "--first-sample 5 contradicts --resume a.bpa, which begins with sample 4"),
                              (["--sampler", "independent"], "--sampler independent contradicts --resume a.bpa, which has --sampler sobol"),
                              (["--precision", "double"], "--precision double contradicts"),
                              (["--math", "fast"], "--math fast contradicts"),
                              (["--numerics", "plain"], "--numerics plain contradicts"),
                              (["--adaptive"], "--adaptive contradicts --resume a.bpa, which is of a render without it"),
                              (["--share", "1/2"], "--share 1/2 contradicts"),
                              (["--spp", 7], "--spp 7 contradicts --resume a.bpa, which is to have 8 samples per pixel")):
            self.fail_with(2, "render", "s.json", "--resume", "a.bpa", "-o", "b.bpa", *options, says=says)
        self.succeed("render", "s.json", "--resume", "a.bpa", "--seed", 0, "--depth", 10, "--width", 64, "--first-sample", 4,
                     "--sampler", "sobol", "--precision", "single", "--spp", 8, "-o", "b.bpa", "-q")
        self.assert_same(self.read("b.bpa"), before)
        self.write("t.json", cli.scene(64, 48, spheres=5))
        self.fail_with(2, "render", "t.json", "--resume", "a.bpa", "-o", "b.bpa", says=["a.bpa", "t.json", "rendered from another scene than"])
        self.fail_with(1, "render", "s.json", "--resume", "none.bpa", "-o", "b.bpa", says="none.bpa")
        self.fail_with(1, "render", "s.json", "--resume", "s.json", "-o", "b.bpa", says="not a .bpa file")
        self.succeed("render", "s.json", "--spp", 2, "--first-sample", 90, "-o", "c.bpa", "-q")
        self.succeed("merge", "a.bpa", "c.bpa", "-o", "gap.bpa", "-q")
        self.fail_with(2, "render", "s.json", "--resume", "gap.bpa", "-o", "b.bpa", says="not of one range of samples")

    def test_files_that_are_there(self):
        """A checkpoint replaces nothing that it did not make."""
        self.succeed("render", "s.json", "--spp", 4, "-o", "a.bpa", "-q")
        before = self.read("a.bpa")
        self.fail_with(2, "render", "s.json", "--spp", 4, "--checkpoint", 1, "-o", "a.png",
                       says=["--checkpoint would replace a.bpa", "already exists beside the picture"])
        self.assert_same(self.read("a.bpa"), before)
        self.succeed("render", "s.json", "--spp", 5, "--checkpoint", 1, "-o", "a.bpa", "-q")  # a result is replaced, as ever
        code, said = self.stop_at("b.bpa", signal.SIGINT, "--spp", 60000000, "--checkpoint", 0.05, "-o", "b.bpa")
        self.assertEqual(code, 130, said)
        for output in ("b.bpa", "b.png"):
            self.fail_with(2, "render", "s.json", "--spp", 4, "--checkpoint", 1, "-o", output,
                           says=["would replace b.bpa, an unfinished render", "--resume b.bpa"])
        before = self.read("b.bpa")
        self.fail_with(2, "render", "s.json", "--resume", "a.bpa", "--checkpoint", 1, "-o", "b.bpa",
                       says=["would replace b.bpa, an unfinished render"])
        self.assert_same(self.read("b.bpa"), before)
        for output in ("-", "/dev/null"):
            self.fail_with(2, "render", "s.json", "--checkpoint", 1, "-o", output, "--format", "pfm", says="--checkpoint has no place")

    def test_no_result_replaces_the_sums(self):
        """Neither those that a render goes on from, nor those that it keeps: whatever names lead to them."""
        self.succeed("render", "s.json", "--spp", 4, "-o", "a.bpa", "-q")
        before = self.read("a.bpa")
        os.symlink("a.bpa", self.path("link.json"))
        os.link(self.path("a.bpa"), self.path("same.png"))
        for options in (["-o", "b.png", "--stats", "a.bpa"], ["-o", "b.png", "--stats", "link.json"],
                        ["-o", "b.png", "--error-map", "same.png"], ["-o", "same.png"], ["-o", "a.bpa", "--stats", "./a.bpa"]):
            self.fail_with(2, "render", "s.json", "--resume", "a.bpa", "--spp", 8, *options)
            self.assert_same(self.read("a.bpa"), before, options)
        self.fail_with(2, "render", "s.json", "--resume", "a.bpa", "--spp", 8, "-o", "b.png", "--stats", "link.json",
                       says="--stats link.json would overwrite the film that --resume names")
        self.fail_with(2, "render", "s.json", "--checkpoint", 1, "-o", "c.png", "--stats", "c.bpa",
                       says="--stats c.bpa would overwrite the sums that --checkpoint keeps")
        self.succeed("render", "s.json", "--resume", "a.bpa", "--spp", 8, "-o", "a.bpa", "-q")  # more sums take their place

    def test_no_clobber(self):
        """A render's own checkpoints are not in its way, nor is its unfinished picture in that of the command that goes
        on; somebody else's file is."""
        self.succeed("render", "s.json", "--checkpoint", 0.01, "--no-clobber", "-o", "a.bpa", "-q")
        self.assertEqual(self.files(), ["a.bpa", "s.json"])
        self.fail_with(1, "render", "s.json", "--checkpoint", 0.01, "--no-clobber", "-o", "a.bpa", says="File exists")
        samples = 6000
        while True:
            code, said = self.stop_at("b.bpa", signal.SIGTERM, "--checkpoint", 0.02, "--no-clobber", "-o", "b.exr", "--spp", samples)
            if code != 0 or samples > 10**7:
                break
            os.remove(self.path("b.exr"))
            samples *= 4  # the render was faster than its signal
        self.assertEqual(code, 130, said)
        self.go_on(said, "-q")
        self.assertEqual(self.files(), ["a.bpa", "b.exr", "s.json"])
        process = self.start("--checkpoint", 1, "--time", 3, "--threads", 1, "--no-clobber", "-o", "c.bpa", "-q")
        time.sleep(0.5)
        self.write("c.bpa", "theirs")
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 1, said)
        self.assertEqual(self.read("c.bpa"), b"theirs")
        # On a slow machine the file is there before the render is. No further try leaves a further file.
        self.assertLessEqual(said.count("the checkpoint was not written"), 1, said)

    def test_several_scenes(self):
        """What is in the way of the last one's checkpoint is found before the first one is rendered."""
        self.write("a.json", cli.scene())
        self.write("b.json", cli.scene())
        self.succeed("render", "b.json", "-o", "b.bpa", "-q")
        self.fail_with(2, "render", "a.json", "b.json", "--checkpoint", 1, says="--checkpoint would replace b.bpa")
        self.assertEqual(self.files(), ["a.json", "b.bpa", "b.json", "s.json"])

    def test_a_finished_render_leaves_no_checkpoint(self):
        self.succeed("render", "s.json", "--checkpoint", 0.01, "-o", "a.exr", "-q")
        self.assertEqual(self.files(), ["a.exr", "s.json"])

    def test_a_time_that_is_over(self):
        """--time of the command that goes on is what was left; without any end the render is refused."""
        code, said = self.stop_at("a.bpa", signal.SIGTERM, "--time", 300, "--checkpoint", 0.05, "-o", "a.pfm")
        self.assertEqual(code, 130, said)
        command = self.command_in(said)
        left = int(command[command.index("--time") + 1])
        self.assertTrue(0 < left <= 300, left)
        self.fail_with(2, "render", "s.json", "--resume", "a.bpa", "-o", "a.pfm", says=["had only a time limit", "--time"])
        self.succeed("render", "s.json", "--resume", "a.bpa", "--time", 0.2, "-o", "a.pfm", "-q")

    def test_odd_names(self):
        self.write("it's a.json", cli.scene(64, 48, spheres=4))
        process = subprocess.Popen([cli.PROGRAM, "render", "it's a.json", "--spp", "60000000", "--checkpoint", "0.05"],
                                   cwd=self.folder, env=self.environment, stderr=subprocess.PIPE)
        while "it's a.bpa" not in self.files() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGTERM)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(self.command_in(said)[:5], ["ballpark", "render", "it's a.json", "--resume", "it's a.bpa"])

    @cli.deep
    def test_a_checkpoint_that_cannot_be_written(self):
        """It is warned about, the render goes on, and what it has is not lost: here the folder goes away."""
        os.mkdir(self.path("d"))
        os.mkdir(self.path("tmp"))
        self.environment["TMPDIR"] = self.path("tmp")
        process = self.start("--spp", 20000, "--checkpoint", 0.05, "-o", "d/a.pfm")
        while process.poll() is None and not os.path.exists(self.path("d/a.bpa")):
            time.sleep(0.01)
        shutil.rmtree(self.path("d"))
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 1, said)
        self.assertIn("warning: the checkpoint was not written, and rendering continues: ", said)
        kept = os.listdir(self.path("tmp"))
        self.assertEqual(len(kept), 1, said)
        self.succeed("merge", os.path.join("tmp", kept[0]), "-o", "a.pfm", "-q")
        self.succeed("render", "s.json", "--spp", 20000, "-o", "whole.pfm", "-q")
        self.assert_same(self.read("a.pfm"), self.read("whole.pfm"))


if __name__ == "__main__":
    cli.main()
