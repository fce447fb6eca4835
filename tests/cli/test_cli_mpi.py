"""Several processes that mpirun starts render one picture: the one that a process alone renders, bit for bit; and whatever
happens to one of them, happens to the job."""

import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import time
import unittest

import bpa
import cli
from mpi import FLAGS, MPIRUN, rank_processes, reason_to_skip
from pfm import read_pfm

REASON = reason_to_skip()


@unittest.skipIf(REASON, REASON)
class Ranks(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", cli.scene(40, 30, spheres=3))
        # Without a test's cache of kernels in common, every rank would build its own.
        self.environment["OMPI_MCA_odls_base_sigkill_timeout"] = "5"

    def command(self, ranks, *arguments):
        return [MPIRUN, *FLAGS, "-n", str(ranks), cli.PROGRAM, "render", *map(str, arguments)]

    def by_ranks(self, ranks, *arguments, code=0, environment=None, stdin=subprocess.DEVNULL):
        done = subprocess.run(self.command(ranks, *arguments), cwd=self.folder, stdin=stdin, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, env=dict(self.environment, **(environment or {})),
                              timeout=cli.LIMIT_SECONDS)
        said = done.stderr.decode()
        self.assertEqual(done.returncode, code, said)
        done.errors = [line for line in said.splitlines() if line.startswith("ballpark: ")]
        return done

    def compare(self, ranks, *options):
        self.by_ranks(ranks, "s.json", *options, "-o", "some.bpa", "-q", "--stats", "some.json")
        self.assert_same(self.read("alone.bpa"), self.read("some.bpa"), f"{ranks} ranks, {options}")
        stats = json.loads(self.read("some.json"))
        self.assertEqual(stats["ranks"], ranks)
        for name in ("samples", "rays", "nrmse", "samples_per_pixel", "stopped_by", "mean_radiance", "invalid_samples", "shadow_rays",
                     "samples_min", "samples_mean", "samples_max", "effects"):
            self.assertEqual(stats[name], self.alone[name], name)

    def test_same_bits(self):
        """Any number of ranks, and every rule: sums, depth, normal and albedo, and where the render stopped. How a block is
        divided among how many is a test of test_partition."""
        for options, numbers in ((("--spp", 13), (1, 2, 3, 5)), (("--error", "3%"), (3,)), (("--spp", 96, "--adaptive"), (2, 3)),
                                 (("--error", "2.5%", "--adaptive"), (5,)), (("--spp", 2, "--first-sample", 5), (3,))):
            self.succeed("render", "s.json", *options, "-o", "alone.bpa", "-q", "--stats", "alone.json")
            self.alone = json.loads(self.read("alone.json"))
            self.assertEqual(self.alone["ranks"], 1)
            for ranks in numbers:
                self.compare(ranks, *options)

    def test_progress(self):
        """There is no terminal, so lines tell how far the job is: at 3 s, then twice as late each time."""
        said = self.by_ranks(2, "s.json", "--time", 4, "-o", "a.png").stderr.decode()
        self.assertEqual(len(re.findall(r"(?m)^\d+ %, \d+ s left, noise [0-9.]+ %, [0-9.]+ (?:million|thousand)? ?samples/s$", said)), 1, said)
        self.assertNotIn("\r", said)
        self.assertEqual(self.by_ranks(2, "s.json", "--time", 4, "-o", "a.png", "-q").stderr, b"")

    def test_alpha(self):
        """A picture without a backdrop: what rays have met is added as well, and goes on from a checkpoint."""
        self.write("s.json", cli.scene(24, 18, spheres=2, backdrop="none"))
        for options in (("--spp", 13), ("--spp", 96, "--adaptive")):
            self.succeed("render", "s.json", *options, "-o", "alone.bpa", "-q")
            self.by_ranks(3, "s.json", *options, "-o", "some.bpa", "-q")
            self.assert_same(self.read("alone.bpa"), self.read("some.bpa"), options)
        self.succeed("render", "s.json", "--spp", 5, "-o", "begun.bpa", "-q")
        self.by_ranks(2, "s.json", "--spp", 13, "--resume", "begun.bpa", "-o", "some.exr", "-q")
        self.succeed("render", "s.json", "--spp", 13, "-o", "alone.exr", "-q")
        self.assert_same(self.read("alone.exr"), self.read("some.exr"))

    def test_previews(self):
        """One rank writes them, of what all have; --show has no terminal under a launcher, and one picture at a time."""
        for options in (("--spp", 256), ("--spp", 256, "--adaptive")):
            self.succeed("render", "s.json", *options, "-o", "alone.pfm", "-q")
            self.by_ranks(2, "s.json", *options, "-o", "some.pfm", "--preview", "1e-6", "--error-map", "map.png", "-q")
            self.assert_same(self.read("alone.pfm"), self.read("some.pfm"), options)
        os.remove(self.path("some.pfm"))
        process = self.start(2, "s.json", "--spp", 60000000, "--preview", 0.1, "-o", "some.pfm")
        seen = []
        while len(seen) < 3 and process.poll() is None:
            if "some.pfm" in self.files() and self.read("some.pfm") not in seen:
                seen.append(self.read("some.pfm"))
            time.sleep(0.02)
        self.assertEqual(len(seen), 3, "the file was not rewritten")
        os.kill(rank_processes(process)[0], signal.SIGTERM)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 130, said)
        width, height, values = read_pfm(seen[-1])
        _, _, expected = read_pfm(self.read("alone.pfm"))
        self.assertEqual((width, height), (40, 30))
        self.assertLess(sum(abs(a - b) for a, b in zip(values, expected)), 0.02 * sum(expected))
        for scenes, words in ((("s.json",), "--preview SECONDS writes"), (("s.json", "t.json"), "2 ranks render several at once")):
            self.write("t.json", cli.scene(40, 30, spheres=2))
            done = self.by_ranks(2, *scenes, "--show", code=2)
            self.assertEqual(len(done.errors), 1, done.errors)
            self.assertIn("--show", done.errors[0])
            self.assertIn(words, done.errors[0])

    def test_no_clobber(self):
        """All ranks look before the first of them writes."""
        names = [f"p{number}" for number in range(4)]
        for name in names:
            self.write(name + ".json", cli.scene(20, 15, spheres=2))
        command = (*(name + ".json" for name in names), "-o", self.folder, "--format", "pfm", "--spp", 2, "--no-clobber", "-q")
        self.by_ranks(2, *command)
        self.assertTrue({name + ".pfm" for name in names} <= set(self.files()))
        before = self.read("p3.pfm")
        for name in names[:3]:
            os.remove(self.path(name + ".pfm"))
        done = self.by_ranks(2, *command, code=1)
        self.assertEqual(len(done.errors), 1, done.errors)
        self.assertIn("p3.pfm", done.errors[0])
        self.assertEqual([name for name in self.files() if name.endswith(".pfm")], ["p3.pfm"])
        self.assert_same(self.read("p3.pfm"), before)

    def decides(self, name):
        """Whether adaptive sampling has decided something in the film so far."""
        header, _ = bpa.read(self.read(name))
        return (header["plan"] or {}).get("decision_bytes", 0) > 0

    def test_one_rank_reads_the_film(self):
        """The others take its header: here they find no more than that."""
        os.mkdir(self.path("other"))
        self.write("other/s.json", self.read("s.json"))
        script = 'test $OMPI_COMM_WORLD_RANK = 0 || cd other; exec "$0" "$@"'
        for samples, options in ((60000000, ()), (4096, ("--adaptive",))):
            process = subprocess.Popen([cli.PROGRAM, "render", "s.json", "--spp", str(samples), *options, "-o", "a.bpa", "-q",
                                        "--checkpoint", "0.01"], cwd=self.folder, env=self.environment, stderr=subprocess.DEVNULL)
            self.addCleanup(lambda process=process: process.poll() is None and (process.kill(), process.wait()))
            while process.poll() is None and not ("a.bpa" in self.files() and self.decides("a.bpa") == bool(options)):
                time.sleep(0.005)
            process.kill()
            process.wait()
            self.assertEqual(self.decides("a.bpa"), bool(options))
            if not options:
                samples = bpa.read(self.read("a.bpa"))[0]["plan"]["done"] + 64
            self.write("other/a.bpa", self.read("a.bpa").split(b"\n", 1)[0] + b"\n")
            done = subprocess.run([MPIRUN, *FLAGS, "-n", "3", "sh", "-c", script, cli.PROGRAM, "render", "s.json", "--resume", "a.bpa",
                                   "--spp", str(samples), *options, "-o", self.path("some.pfm"), "-q"], cwd=self.folder, env=self.environment,
                                  stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=cli.LIMIT_SECONDS)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.succeed("render", "s.json", "--spp", samples, *options, "-o", "whole.pfm", "-q")
            self.assert_same(self.read("some.pfm"), self.read("whole.pfm"), options)
            os.remove(self.path("a.bpa"))

    def test_files(self):
        """Pictures and maps are written once, and one process speaks."""
        self.succeed("render", "s.json", "--spp", 9, "-o", "alone.exr", "--error-map", "alone.png", "-q")
        done = self.by_ranks(3, "s.json", "--spp", 9, "-o", "some.exr", "--error-map", "some.png")
        self.assert_same(self.read("alone.exr"), self.read("some.exr"))
        self.assert_same(self.read("alone.png"), self.read("some.png"))
        said = done.stderr.decode()
        self.assertEqual(said.count("some.exr: 40x30, 9 samples per pixel"), 1, said)
        self.assertEqual(said.count("traced in"), 1, said)

    def test_time(self):
        self.by_ranks(2, "s.json", "--time", 1, "-o", "t.bpa", "-q", "--stats", "t.json")
        stats = json.loads(self.read("t.json"))
        self.assertEqual(stats["stopped_by"], "time")
        self.succeed("render", "s.json", "--spp", stats["samples_per_pixel"], "-o", "alone.pfm", "-q")
        if not stats["partial"]:
            self.succeed("merge", "t.bpa", "-o", "t.pfm", "-q")
            self.assert_same(self.read("alone.pfm"), self.read("t.pfm"))

    def start(self, ranks, *arguments):
        process = subprocess.Popen(self.command(ranks, *arguments), cwd=self.folder, env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        return process

    def send_when_there(self, process, file, rank, number):
        while file not in self.files() and process.poll() is None:
            time.sleep(0.02)
        self.assertIsNone(process.poll(), "it ended before")
        os.kill(rank_processes(process)[rank], number)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        return said

    def command_in(self, said):
        lines = [line for line in said.splitlines() if line.startswith("ballpark render ")]
        self.assertEqual(len(lines), 1, said)
        return shlex.split(lines[0])[1:]

    def check_resumed(self, said, samples, ranks=None):
        """The command in `said`, with fewer samples to go, makes the picture of a render without a break."""
        command = self.command_in(said)
        command[command.index("--spp") + 1] = str(samples)
        if ranks is None:
            self.succeed(*command, "-q")
        else:
            self.by_ranks(ranks, *command[1:], "-q")
        self.succeed("render", "s.json", "--spp", samples, "-o", "whole.pfm", "-q")
        self.assert_same(self.read("a.pfm"), self.read("whole.pfm"))

    def test_interrupted_on_one_rank(self):
        """SIGTERM on any rank ends all of them, and keeps what there is."""
        process = self.start(2, "s.json", "--spp", 60000000, "--checkpoint", 0.2, "-o", "a.pfm")
        said = self.send_when_there(process, "a.bpa", 1, signal.SIGTERM)
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("a.pfm holds the picture so far; this command continues it", said)
        self.assertEqual(self.files(), ["a.bpa", "a.pfm", "s.json"])
        header, _ = bpa.read(self.read("a.bpa"))
        self.check_resumed(said, header["plan"]["done"] + 64, ranks=3)
        self.assertEqual(self.files(), ["a.pfm", "s.json", "whole.pfm"])

    def test_killed_rank(self):
        """The job ends, says how it goes on, and a process alone can do that."""
        process = self.start(2, "s.json", "--spp", 60000000, "--checkpoint", 0.2, "-o", "a.pfm")
        said = self.send_when_there(process, "a.bpa", 1, signal.SIGKILL)
        self.assertNotEqual(process.returncode, 0, said)
        self.assertIn("the other ranks do not answer and may be lost; this command continues from the last checkpoint", said)
        header, _ = bpa.read(self.read("a.bpa"))
        self.check_resumed(said, header["plan"]["done"] + 64)

    @cli.deep
    def test_killed_leader(self):
        """The rank that writes is killed: the launcher says which, nobody hangs, and the checkpoint is whole."""
        process = self.start(3, "s.json", "--spp", 60000000, "--checkpoint", 0.2, "-o", "a.pfm")
        said = self.send_when_there(process, "a.bpa", 0, signal.SIGKILL)
        self.assertNotEqual(process.returncode, 0, said)
        self.assertRegex(said, r"process rank 0 .*exited on signal 9")
        self.assertEqual(self.files(), ["a.bpa", "s.json"])
        header, _ = bpa.read(self.read("a.bpa"))
        self.by_ranks(2, "s.json", "--resume", "a.bpa", "--spp", header["plan"]["done"] + 64, "-o", "a.pfm", "-q")
        self.succeed("render", "s.json", "--spp", header["plan"]["done"] + 64, "-o", "whole.pfm", "-q")
        self.assert_same(self.read("a.pfm"), self.read("whole.pfm"))

    @cli.deep
    def test_killed_without_checkpoint(self):
        process = self.start(2, "s.json", "--spp", 60000000, "-o", "a.pfm", "--preview", 0.1)
        said = self.send_when_there(process, "a.pfm", 1, signal.SIGKILL)
        self.assertNotEqual(process.returncode, 0, said)
        self.assertIn("may be lost, and there is no checkpoint; with --checkpoint SECONDS", said)

    @cli.deep
    def test_folder_that_goes(self):
        """Neither checkpoint nor picture can be written, and what was rendered is kept elsewhere, by one rank."""
        for folder in ("d", "tmp"):
            os.mkdir(self.path(folder))
        self.environment["TMPDIR"] = self.path("tmp")
        process = self.start(2, "s.json", "--spp", 60000000, "--checkpoint", 0.05, "-o", "d/a.pfm")
        while process.poll() is None and not os.path.exists(self.path("d/a.bpa")):
            time.sleep(0.01)
        shutil.rmtree(self.path("d"))
        warning = "warning: the checkpoint was not written, and rendering continues: "
        self.assertTrue(any(warning in line.decode() for line in iter(process.stderr.readline, b"")), "there was no warning")
        os.kill(rank_processes(process)[0], signal.SIGTERM)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 1, said)
        kept = [name for name in os.listdir(self.path("tmp")) if name.startswith("ballpark")]
        self.assertEqual(len(kept), 1, said)
        self.assertIn(f"ballpark merge {self.path('tmp')}/{kept[0]}", said)
        film = os.path.join("tmp", kept[0])
        samples = bpa.read(self.read(film))[0]["plan"]["done"] + 64
        self.succeed("render", "s.json", "--resume", film, "--spp", samples, "-o", "a.pfm", "-q")
        self.succeed("render", "s.json", "--spp", samples, "-o", "whole.pfm", "-q")
        self.assert_same(self.read("a.pfm"), self.read("whole.pfm"))

    @cli.deep
    def test_read_only_folder(self):
        """One rank says that the picture cannot be written, before anything is rendered; where a link leads to a picture there,
        nothing is lost either."""
        os.mkdir(self.path("d"))
        self.write("d/a.png", b"what was there before")
        self.write("d/begun.bpa", b"")
        self.succeed("render", "s.json", "--spp", 2, "-o", "d/begun.bpa", "-q")
        before = self.read("d/begun.bpa")
        alone = ["unshare", *([] if os.getuid() == 0 else ["--user", "--map-root-user"]), "--mount", "sh", "-c",
                 'mount --bind d d && mount -o remount,bind,ro d && exec "$@"', "sh"]
        if subprocess.run([*alone, "true"], cwd=self.folder, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
            self.skipTest("no folder can be made read-only here")
        for options in (("-o", "d/a.png"), ("-o", "d/new.exr", "--checkpoint", "0.01"), ("--resume", "d/begun.bpa", "-o", "d/begun.bpa"),
                        ("-o", "a.png", "--error-map", "d/map.png")):
            done = subprocess.run([*alone, *self.command(2, "s.json", "--spp", 8, *options)], cwd=self.folder, env=self.environment,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=cli.LIMIT_SECONDS)
            errors = [line for line in done.stderr.decode().splitlines() if line.startswith("ballpark: ")]
            self.assertEqual((done.returncode, len(errors)), (1, 1), done.stderr)
            self.assertIn("Read-only file system", errors[0])
            self.assertEqual(sorted(os.listdir(self.path("d"))), ["a.png", "begun.bpa"])
            self.assertEqual(self.read("d/a.png"), b"what was there before")
            self.assert_same(self.read("d/begun.bpa"), before)

    def test_faults_are_told_once(self):
        self.write("bad.json", '{"camera": {"image_width": 0}}')
        for arguments, text in ((("bad.json",), "bad.json"), (("s.json", "--bogus"), "unknown option --bogus"),
                                (("s.json", "-o", "nowhere/a.png"), "nowhere"),
                                (("s.json", "-o", "/dev/full", "--format", "pfm", "--spp", "1"), "No space left on device"),
                                (("s.json", "-o", "-", "--format", "pfm"), "give the name of a file"),
                                (("-", "-o", "a.png"), "reaches only one of 3 ranks")):
            done = self.by_ranks(3, *arguments, code=1 if text in ("nowhere", "No space left on device") else 2)
            self.assertEqual(len(done.errors), 1, done.stderr.decode())
            self.assertIn(text, done.errors[0])

    def test_fault_of_one_rank(self):
        """It is told with rank and machine, by rank 0."""
        script = 'test $OMPI_COMM_WORLD_RANK = 2 && export BALLPARK_KERNELS=/nowhere; exec "$0" render s.json -o a.png'
        done = subprocess.run([MPIRUN, *FLAGS, "-n", "3", "sh", "-c", script, cli.PROGRAM], cwd=self.folder,
                              env=self.environment, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              timeout=cli.LIMIT_SECONDS)
        errors = [line for line in done.stderr.decode().splitlines() if line.startswith("ballpark: ")]
        self.assertEqual(len(errors), 1, done.stderr)
        self.assertRegex(errors[0], r"rank 2 on [^ ]+: .*/nowhere")
        self.assertEqual(self.files(), ["s.json"])

    def test_no_module(self):
        """Copies that would overwrite each other's picture refuse, unless each is to be on its own."""
        away = {"BALLPARK_MPI": "/nowhere/ballpark_mpi.so"}
        done = self.by_ranks(2, "s.json", "--spp", 1, code=2, environment=away)
        self.assertEqual(len(done.errors), 1, done.stderr.decode())
        self.assertIn("mpirun started 2 copies of this program", done.errors[0])
        self.assertIn("BALLPARK_MPI=off", done.errors[0])
        self.assertEqual(self.files(), ["s.json"])
        self.succeed("render", "s.json", "--spp", 1, "-q", environment=away)  # alone it is not looked for
        self.by_ranks(2, "s.json", "--spp", 1, "-q", environment={"BALLPARK_MPI": "off"})

    def test_other_launcher(self):
        """A launcher of another MPI starts copies that do not know of each other."""
        done = self.run_program("render", "s.json", environment={"PMI_SIZE": "4", "PMI_RANK": "0"})
        self.assertEqual(done.returncode, 2, done.errors)
        self.assertIn("mpiexec started 4 copies of this program, but its MPI reports 1", done.errors)

    def test_different_arguments(self):
        script = 'exec "$0" render s.json --spp 1 -o $OMPI_COMM_WORLD_RANK.png -q'
        command = [MPIRUN, *FLAGS, "-n", "2", "sh", "-c", script, cli.PROGRAM]
        for environment, code, files in (({}, 2, ["s.json"]), ({"BALLPARK_MPI": "off"}, 0, ["0.png", "1.png", "s.json"])):
            done = subprocess.run(command, cwd=self.folder, env=dict(self.environment, **environment),
                                  stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=cli.LIMIT_SECONDS)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertEqual(self.files(), files)

    def test_several_pictures(self):
        """Whole pictures go to one rank each, those that are left over to all; statistics come together in order."""
        names = [f"p{number}" for number in range(5)]
        for number, name in enumerate(names):
            self.write(name + ".json", cli.scene(20 + number, 15, spheres=2))
        os.mkdir(self.path("alone"))
        os.mkdir(self.path("some"))
        scenes = [name + ".json" for name in names]
        self.succeed("render", *scenes, "-o", "alone/", "--format", "exr", "-q", "--stats", "alone.json")
        self.by_ranks(2, *scenes, "-o", "some/", "--format", "exr", "-q", "--stats", "some.json")
        for name in names:
            self.assert_same(self.read(f"alone/{name}.exr"), self.read(f"some/{name}.exr"), name)
        alone, some = (json.loads(self.read(name))["renders"] for name in ("alone.json", "some.json"))
        self.assertEqual([entry["scene"] for entry in some], scenes)
        self.assertEqual([entry["samples"] for entry in some], [entry["samples"] for entry in alone])
        self.assertEqual([entry["ranks"] for entry in some], [1, 1, 1, 1, 2])

    def test_turntable(self):
        self.succeed("render", "s.json", "--turntable", 3, "--spp", 2, "-o", "alone.pfm", "-q")
        self.by_ranks(2, "s.json", "--turntable", 3, "--spp", 2, "-o", "some.pfm", "-q")
        for number in range(3):
            self.assert_same(self.read(f"alone-{number:04}.pfm"), self.read(f"some-{number:04}.pfm"), number)

    def test_interrupted_pictures(self):
        """A signal on one rank ends the pictures of the others too."""
        for name in ("p0", "p1"):
            self.write(name + ".json", cli.scene(20, 15, spheres=2))
        process = self.start(2, "p0.json", "p1.json", "--spp", 60000000, "--checkpoint", 0.2, "-o", self.folder, "--format",
                             "pfm")
        said = self.send_when_there(process, "p1.bpa", 1, signal.SIGTERM)
        self.assertEqual(process.returncode, 130, said)
        self.assertEqual(self.files(), ["p0.bpa", "p0.json", "p0.pfm", "p1.bpa", "p1.json", "p1.pfm", "s.json"])


if __name__ == "__main__":
    cli.main()
