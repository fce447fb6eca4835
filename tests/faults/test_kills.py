"""A render, a merge or a job of ranks that is stopped at any moment leaves the old file or the new one, whole, and nothing else.

Run as: python3 test_kills.py PROGRAM SOURCE_DIR KILLS [unittest's arguments]
KILLS: how many tries of each command, at moments spread over a run's time by a fixed seed; by SIGINT, SIGTERM, SIGHUP
and SIGKILL in turns."""

import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

KILLS = int(sys.argv[3])
sys.argv[3:4] = []

import cli
from mpi import FLAGS, MPIRUN, rank_processes, reason_to_skip

OLD = b"what was there before"
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)


class Kills(cli.ProgramTest):
    def setUp(self):
        """A driver that is killed may leave a kernel in its cache that it cannot read again: a cache of our own."""
        super().setUp()
        self.cache = tempfile.mkdtemp(prefix="ballpark-cache-")
        self.addCleanup(shutil.rmtree, self.cache, ignore_errors=True)
        self.environment.update(POCL_CACHE_DIR=self.cache, MESA_SHADER_CACHE_DIR=self.cache)

    def forget_kernels(self):
        for name in os.listdir(self.cache):
            shutil.rmtree(os.path.join(self.cache, name), ignore_errors=True)

    def has_unnamed_files(self):
        try:
            os.close(os.open(self.folder, os.O_TMPFILE | os.O_WRONLY))
        except (OSError, AttributeError):
            return False
        return os.path.exists("/proc/self/fd/0")

    def start(self, arguments):
        return subprocess.Popen([cli.PROGRAM, *arguments], cwd=self.folder, env=self.environment,
                                stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True)

    def kill_often(self, arguments, result, is_whole):
        """`is_whole(content)`: whether that is a result. The span from which the moments are taken grows when the old
        file is left and shrinks when there is a new one, so both come about, however busy the machine is."""
        self.succeed(*arguments)  # builds the kernels
        begin = time.monotonic()
        self.succeed(*arguments)
        span = 1.1 * (time.monotonic() - begin)
        there = set(self.files()) - {result}
        chance, unnamed = random.Random(7), self.has_unnamed_files()
        outcomes, killed = {"old": 0, "new": 0}, False
        for number in range(KILLS):
            existing, kind = number % 8 < 6, SIGNALS[number % len(SIGNALS)]
            if existing:
                self.write(result, OLD)
            elif result in self.files():
                os.remove(self.path(result))
            process = self.start(arguments)
            time.sleep(chance.uniform(0, span))
            process.send_signal(kind)
            said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode(errors="replace")
            where = f"{arguments[0]} {number}, {kind.name}: {process.returncode}, {said}"
            if process.returncode == 1 and "does not compile" in said and killed:
                # An earlier SIGKILL has met the driver amid its cache. It is no fault of ours, and keeps the files, too.
                self.forget_kernels()
                self.succeed(*arguments[:-3], "-o", os.devnull, "--format", "pfm", "-q")
            else:
                # A signal before main has its own way; one that comes after the end changes nothing.
                self.assertIn(process.returncode, (0, 130, -kind), where)
            killed = killed or kind == signal.SIGKILL
            if result in self.files():
                content = self.read(result)
                self.assertTrue(is_whole(content) or (existing and content == OLD), f"{where}: {content[:40]}")
                outcomes["old" if content == OLD else "new"] += 1
            else:
                self.assertFalse(existing, f"{where}: the old file is gone")
                outcomes["old"] += 1
            span *= 1 / 1.2 if result in self.files() and self.read(result) != OLD else 1.2
            left = set(self.files()) - there - {result}
            if kind != signal.SIGKILL:
                self.assertEqual(left, set(), where)
            for name in left:
                # Nobody can be kept from being killed between giving a finished file its name and renaming it; a file
                # that is not finished has no name.
                self.assertTrue(not unnamed or is_whole(self.read(name)), f"{where}: {name} is not whole")
                os.remove(self.path(name))
        self.assertGreater(outcomes["old"], 0, outcomes)
        return outcomes

    def test_merge(self):
        self.write("s.json", cli.scene(500, 400, camera={"samples_per_pixel": 1}))
        for number in (0, 1):
            self.succeed("render", "s.json", "--first-sample", number, "-o", f"{number}.bpa", "-q")
        self.succeed("merge", "0.bpa", "1.bpa", "-o", "right.bpa", "-q")
        right = self.read("right.bpa")
        outcomes = self.kill_often(("merge", "0.bpa", "1.bpa", "-o", "m.bpa", "-q"), "m.bpa",
                                   lambda content: content == right)
        self.assertGreater(outcomes["new"], 0, outcomes)

    def test_render(self):
        """What is written when it is interrupted is a picture of what there is: it has every byte of one."""
        self.write("s.json", cli.scene(64, 64, camera={"samples_per_pixel": 3000}))
        size = len(b"PF\n64 64\n-1.0\n") + 64 * 64 * 12
        self.kill_often(("render", "s.json", "-o", "a.pfm", "-q"), "a.pfm", lambda content: len(content) == size)

    def test_checkpoints(self):
        """A render that is killed again and again, at any moment, and goes on each time from what there is: no file is
        ever broken, no sample counts twice, and in the end it is the picture of a render without a break."""
        self.write("s.json", cli.scene(96, 64, spheres=4, camera={"samples_per_pixel": 4000}))
        begin = time.monotonic()
        self.succeed("render", "s.json", "-o", "whole.exr", "-q")
        chance, span, unnamed = random.Random(9), 1.1 * (time.monotonic() - begin), self.has_unnamed_files()
        whole, kinds = self.read("whole.exr"), (signal.SIGKILL, signal.SIGKILL, signal.SIGUSR1, signal.SIGTERM)
        kills = resumed = finished = 0
        while kills < KILLS or (resumed == 0 and kills < 40):  # on a busy machine the first may all come too early
            going_on = "a.bpa" in self.files()
            arguments = ["render", "s.json", "--checkpoint", "0.02", "-o", "a.exr"] + (["--resume", "a.bpa"] if going_on else [])
            process = self.start(arguments)
            time.sleep(chance.uniform(0, span))
            kind = kinds[kills % len(kinds)]
            process.send_signal(kind)
            said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode(errors="replace")
            where = f"{kills}, {kind.name}: {process.returncode}, {said}"
            kills += 1
            resumed += going_on
            if process.returncode == 1 and "does not compile" in said:  # an earlier SIGKILL has met the driver amid its cache
                self.forget_kernels()
                self.succeed("render", "s.json", "--spp", "1", "-o", os.devnull, "--format", "exr", "-q")
            elif process.returncode == 0:
                finished += 1
                self.assert_same(self.read("a.exr"), whole, where)
                self.assertNotIn("a.bpa", self.files(), where)
                os.remove(self.path("a.exr"))
            else:
                self.assertIn(process.returncode, (130, -kind), where)
            for name in set(self.files()) - {"s.json", "whole.exr", "a.exr", "a.bpa"}:
                self.assertTrue(kind == signal.SIGKILL and (not unnamed or name.startswith("a.")), f"{where}: {name}")
                os.remove(self.path(name))  # see kill_often()
            if "a.bpa" in self.files():
                self.succeed("merge", "a.bpa", "-o", os.devnull, "--format", "pfm", "-q")  # it is whole
        self.assertGreater(resumed, 0)
        while "a.bpa" in self.files():
            self.succeed("render", "s.json", "--checkpoint", "5", "-o", "a.exr", "--resume", "a.bpa", "-q")
            self.assert_same(self.read("a.exr"), whole, "the last one")
            finished += 1
        self.assertGreater(finished, 0)

    def test_ranks(self):
        """One rank of a job is killed, any of them at any moment, again and again; as many ranks as chance has it, or a process
        alone, go on each time from what there is. The job always ends, and the last one makes the picture of a render without a break."""
        if reason := reason_to_skip():
            self.skipTest(reason)
        self.write("s.json", cli.scene(96, 64, spheres=4, camera={"samples_per_pixel": 2000}))
        self.succeed("render", "s.json", "-o", "whole.exr", "-q")
        chance, whole = random.Random(11), self.read("whole.exr")
        begin = time.monotonic()
        self.assertTrue(self.check_job(*self.job(2, None, 0), whole))
        span = 1.1 * (time.monotonic() - begin)
        kills = resumed = finished = 0
        while kills < max(KILLS // 2, 4) or (resumed == 0 and kills < 40):
            resumed += "a.bpa" in self.files()
            kills += 1
            finished += self.check_job(*self.job(chance.choice((2, 2, 3)), chance, span), whole)
        self.assertGreater(resumed, 0)
        while "a.bpa" in self.files():
            finished += self.check_job(*self.job(2, None, 0), whole)
        self.assertGreater(finished, 0)

    def job(self, ranks, chance, span):
        """Renders, from the checkpoint if there is one; `chance` kills a rank within `span`. The exit code, and what was said."""
        resume = ["--resume", "a.bpa"] if "a.bpa" in self.files() else []
        process = subprocess.Popen(
            [MPIRUN, *FLAGS, "-n", str(ranks), cli.PROGRAM, "render", "s.json", "--checkpoint", "0.02", "-o", "a.exr", *resume],
            cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        while chance is not None and process.poll() is None and len(rank_processes(process)) < ranks:
            time.sleep(0.005)
        if chance is not None:
            time.sleep(chance.uniform(0, span))
            with contextlib.suppress(KeyError, ProcessLookupError):  # when the job is done before
                os.kill(rank_processes(process)[chance.randrange(ranks)], signal.SIGKILL)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[0].decode(errors="replace")
        return process.returncode, f"{ranks} ranks{', resumed' * bool(resume)}: {process.returncode}, {said}"

    def check_job(self, code, where, whole):
        """What a job of ranks has left behind; whether it made its picture, which is taken away then."""
        if code != 0 and "does not compile" in where:  # an earlier SIGKILL has met the driver amid its cache
            self.forget_kernels()
            self.succeed("render", "s.json", "--spp", "1", "-o", os.devnull, "--format", "exr", "-q")
        for name in set(self.files()) - {"s.json", "whole.exr", "a.exr", "a.bpa"}:
            self.assertTrue(not self.has_unnamed_files() or name.startswith("a."), f"{where}: {name}")  # see kill_often()
            os.remove(self.path(name))
        if "a.bpa" in self.files():
            self.succeed("merge", "a.bpa", "-o", os.devnull, "--format", "pfm", "-q")  # it is whole
        if "a.exr" not in self.files():
            self.assertNotEqual(code, 0, where)
            return False
        # A rank that is killed when its work is done leaves a picture, and a job that counts as failed.
        self.assert_same(self.read("a.exr"), whole, where)
        os.remove(self.path("a.exr"))
        if code == 0:
            self.assertNotIn("a.bpa", self.files(), where)
        return True

    def test_hangup_and_processor_time(self):
        """A terminal that goes away and a limit on processor time end a render as Ctrl-C does: it keeps what there is."""
        self.write("s.json", cli.scene(64, 64, camera={"samples_per_pixel": 3000}))
        self.succeed("render", "s.json", "-o", "a.pfm", "-q")  # builds the kernels
        os.remove(self.path("a.pfm"))
        for kind in (signal.SIGHUP, signal.SIGXCPU):
            for wait in (0.5, 1, 2, 4, 8, 16, 32):  # a signal before there is anything to keep ends it at once
                process = self.start(("render", "s.json", "--time", "200", "-o", "a.pfm"))
                time.sleep(wait)
                process.send_signal(kind)
                said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
                self.assertEqual(process.returncode, 130, f"{kind.name}: {said}")
                if "a.pfm" in self.files():
                    break
            self.assertIn("interrupted after", said, kind.name)
            self.assertEqual(self.files(), ["a.pfm", "s.json"], kind.name)
            os.remove(self.path("a.pfm"))

    def test_nohup(self):
        """A hangup that is ignored stays ignored, also by a driver's compiler at work."""
        self.write("s.json", cli.scene(16, 9))
        process = subprocess.Popen([cli.PROGRAM, "render", "s.json", "--time", "2", "-o", "a.pfm", "-q"],
                                   cwd=self.folder, env=self.environment, stderr=subprocess.PIPE,
                                   preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        for _ in range(500):
            time.sleep(0.003)
            if process.poll() is None:
                process.send_signal(signal.SIGHUP)
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 0, said)


if __name__ == "__main__":
    cli.main()
