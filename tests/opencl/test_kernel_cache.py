"""Kept programs through the whole program: the same picture from them, whatever became of their files.

Run as: PYTHONPATH=tests/support python3 test_kernel_cache.py PROGRAM SOURCE_DIR [--deep]
"""
import os
import subprocess

import cli
from drivers import icd

SIZE = ("--width", 16, "--spp", 4, "--quiet", "--force")


class KernelCache(cli.ProgramTest):
    """With PoCL, which keeps programs itself, so that BALLPARK_KERNEL_CACHE=on must ask for it."""

    def setUp(self):
        super().setUp()
        self.environment["OCL_ICD_VENDORS"] = icd("pocl.icd")
        if self.run_program("devices").returncode != 0:
            self.skipTest("PoCL is not installed as pocl.icd")
        os.mkdir(self.path("home"))
        self.environment.setdefault("POCL_CACHE_DIR", self.path("home"))
        self.environment["XDG_CACHE_HOME"] = self.path("home")
        self.environment.pop("BALLPARK_KERNEL_CACHE", None)
        self.write("s.json", cli.scene(width=16))

    def kept(self):
        folder = self.path("home/ballpark/kernels")
        return sorted(os.path.join(folder, name) for name in os.listdir(folder)) if os.path.isdir(folder) else []

    def picture(self, name="p.pfm", mode="on", **environment):
        environment["BALLPARK_KERNEL_CACHE"] = mode
        self.assertEqual(self.succeed("render", "s.json", "-o", name, *SIZE, environment=environment).errors, "")
        return self.read(name)

    def test_the_same_picture(self):
        wanted = self.picture(mode="off")
        self.assertEqual(self.kept(), [])
        self.picture(mode="")  # PoCL needs no help
        self.assertEqual(self.kept(), [])
        self.assert_same(self.picture(), wanted)
        files = self.kept()
        self.assertEqual(len(files), 1)  # the self-test was behind us
        self.assert_same(self.picture(), wanted)
        self.assertEqual(self.kept(), files)
        whole = self.read(files[0])
        for damage in (b"", whole[:100], whole[:-1], whole[:9999] + b"?" + whole[10000:], b"\0" * len(whole)):
            self.write(files[0], damage)
            self.assert_same(self.picture(), wanted, len(damage))
            self.assertEqual(self.kept(), files)
            self.assertEqual(os.path.getsize(files[0]) > 10000, True)
        os.remove(files[0])
        os.mkdir(files[0])
        self.assert_same(self.picture(), wanted, "a folder in its place")

    def test_a_home_that_cannot_be_written(self):
        wanted = self.picture(mode="off")
        for home in ("/proc/self", "/dev/null", self.path("s.json")):
            self.assert_same(self.picture(XDG_CACHE_HOME=home), wanted, home)

    def test_bad_word(self):
        self.fail_with(2, "render", "s.json", *SIZE, environment={"BALLPARK_KERNEL_CACHE": "yes"},
                       says='BALLPARK_KERNEL_CACHE is "yes"; expected on or off')

    @cli.deep
    def test_eight_at_once(self):
        """They begin with nothing kept; each has a cache of PoCL's own, so that ours is the one that they share."""
        wanted = self.picture(mode="off")
        running = []
        for i in range(8):
            os.mkdir(self.path(f"pocl{i}"))
            environment = dict(self.environment, BALLPARK_KERNEL_CACHE="on", POCL_CACHE_DIR=self.path(f"pocl{i}"))
            running.append(subprocess.Popen([cli.PROGRAM, "render", "s.json", "-o", f"{i}.pfm", *map(str, SIZE)],
                                            cwd=self.folder, env=environment, stdin=subprocess.DEVNULL))
        for i, process in enumerate(running):
            self.assertEqual(process.wait(timeout=cli.LIMIT_SECONDS), 0)
            self.assert_same(self.read(f"{i}.pfm"), wanted, i)
        self.assertEqual(len(self.kept()), 1)


cli.main()
