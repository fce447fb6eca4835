"""What docs/CLUSTERS.md shows is what works: its job scripts, with stand-ins for the two commands of Slurm."""

import contextlib
import os
import re
import signal
import subprocess
import time

from cli import PROGRAM, SOURCE, ProgramTest, main, scene
from mpi import FLAGS, MPIRUN, reason_to_skip

# srun runs the program at hand; scontrol notes what is handed in again.
STAND_INS = {"srun": "#!/bin/sh\nwhile [ \"${1#-}\" != \"$1\" ]; do shift; done\nshift\nexec $LAUNCHER \"$BALLPARK\" \"$@\"\n",
             "scontrol": "#!/bin/sh\necho \"$@\" >>requeued\n"}


class Clusters(ProgramTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("bin"))
        for name, text in STAND_INS.items():
            self.write(os.path.join("bin", name), text)
            os.chmod(self.path(os.path.join("bin", name)), 0o755)
        self.environment.update(PATH=self.path("bin") + ":" + os.environ["PATH"], BALLPARK=PROGRAM, TMPDIR=self.folder)
        self.write("cover.json", scene(64, 48, spheres=4))
        with open(os.path.join(SOURCE, "docs/CLUSTERS.md"), encoding="utf-8") as file:
            self.text = file.read()

    def script(self, number, *changes):
        text = re.findall(r"(?ms)^```bash\n(.*?)^```", self.text)[number]
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        return text

    def start(self, text, **environment):
        return subprocess.Popen(["bash", "-c", text], cwd=self.folder, env=dict(self.environment, **environment),
                                stderr=subprocess.PIPE)

    def finish(self, process):
        said = process.communicate(timeout=300)[1].decode()
        return process.returncode, said

    def child_of(self, process, name):
        """The program that the script has begun; it is stopped as Slurm would stop the step."""
        while process.poll() is None:
            if name in self.files():
                found = subprocess.run(["ps", "-o", "pid=,args=", "--ppid", str(process.pid)], stdout=subprocess.PIPE, text=True)
                lines = [line for line in found.stdout.splitlines() if " render " in line]
                if lines:
                    return int(lines[0].split()[0])
            time.sleep(0.01)
        return None

    @staticmethod
    def stop_step(child):
        """As Slurm does; the step may have ended by itself meanwhile."""
        if child is not None:
            with contextlib.suppress(ProcessLookupError):
                os.kill(child, signal.SIGUSR1)

    def finish_job(self, process, text, job, **slurm):
        """Starts the script again, as Slurm does, for as long as it hands its job in again."""
        code, said = self.finish(process)
        while code == 130:
            self.assertEqual(self.read("requeued").decode(), f"requeue {job}\n")
            os.remove(self.path("requeued"))
            code, said = self.finish(self.start(text, **slurm))
        self.assertEqual(code, 0, said)

    def test_ranks(self):
        """By mpirun as srun; Slurm signals all ranks."""
        if reason := reason_to_skip():
            self.skipTest(reason)
        self.environment["LAUNCHER"] = " ".join([MPIRUN, *FLAGS, "-n", "2"])
        text = self.script(0, ("--error 0.1", "--error 0.3"), ("--checkpoint 600", "--checkpoint 0.05"))
        process = self.start(text, SLURM_JOB_ID="5")
        launcher = self.child_of(process, "cover.bpa")
        listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(launcher)], check=False, stdout=subprocess.PIPE, text=True).stdout
        for rank in listed.split():
            self.stop_step(int(rank))
        self.finish_job(process, text, "5", SLURM_JOB_ID="5")
        self.succeed("render", "cover.json", "--error", 0.3, "--adaptive", "-o", "whole.exr", "-q")
        self.assert_same(self.read("cover.exr"), self.read("whole.exr"))
        self.assertNotIn("cover.bpa", self.files())

    def test_array(self):
        samples = 20000
        text = self.script(1, ("--spp 65536", f"--spp {samples}"), ("--checkpoint 600", "--checkpoint 0.05"))
        names = [f"cover-{part}.bpa" for part in (1, 2, 3)]
        for part, name in enumerate(names, 1):
            task = dict(SLURM_ARRAY_TASK_ID=str(part), SLURM_ARRAY_TASK_COUNT="3", SLURM_ARRAY_JOB_ID="77")
            process = self.start(text, **task)
            child = self.child_of(process, name) if part == 2 else None
            self.stop_step(child)
            self.finish_job(process, text, "77_2", **task)
        merged = re.search(r"(?m)^    ballpark (merge cover-\*\.bpa -o cover\.exr)$", self.text)[1]
        said = self.succeed("merge", *names, "-o", "cover.exr").errors
        self.assertEqual(merged, "merge cover-*.bpa -o cover.exr")
        self.assertNotIn("missing", said)
        self.succeed("render", "cover.json", "--spp", samples, "-o", "whole.exr", "-q")
        self.assert_same(self.read("cover.exr"), self.read("whole.exr"))

    def test_one_long_render(self):
        text = self.script(2, ("--error 0.1", "--error 0.3"), ("--checkpoint 600", "--checkpoint 0.05"))
        process = self.start(text, SLURM_JOB_ID="5")
        child = self.child_of(process, "cover.bpa")
        self.stop_step(child)
        self.finish_job(process, text, "5", SLURM_JOB_ID="5")
        self.succeed("render", "cover.json", "--error", 0.3, "--adaptive", "-o", "whole.exr", "-q")
        self.assert_same(self.read("cover.exr"), self.read("whole.exr"))
        self.assertNotIn("cover.bpa", self.files())


if __name__ == "__main__":
    main()
