"""The copy of PoCL that tests compile with draws what the installed one draws, and lacks what no kernel calls.

Usage: test_trim_pocl.py BALLPARK SOURCE_DIR
"""

import os
import pathlib
import shutil
import unittest

import cli

COPY = os.environ.get("OCL_ICD_VENDORS", "")


@unittest.skipUnless(os.path.exists(os.path.join(COPY, "pocl.icd")), "tests run with PoCL as it is installed")
class TrimmedPocl(cli.ProgramTest):
    def draw(self, scene, vendors, kernel):
        """The picture, by a kernel that is compiled now."""
        shutil.rmtree(self.path("cache"), ignore_errors=True)
        os.mkdir(self.path("cache"))
        self.succeed("render", os.path.join(cli.SOURCE, "tests/agree/scenes", f"{scene}.json"), "--width", "16", "--spp", "4",
                     "--kernel", kernel, "--quiet", "-o", "p.pfm",
                     environment={"OCL_ICD_VENDORS": vendors, "POCL_CACHE_DIR": self.path("cache")})
        return self.read("p.pfm")

    def test_the_same_pictures(self):
        for scene, kernel in (("swarm", "packet"), ("noise", "sample")):
            with self.subTest(scene):
                self.assertEqual(self.draw(scene, COPY, kernel), self.draw(scene, "pocl.icd", kernel))

    def test_it_is_smaller(self):
        """So that it is the copy that is tried, and worth having."""
        copied = pathlib.Path(COPY).parent / "share/pocl"
        trimmed = [path for path in copied.glob("kernel-*.bc") if not path.is_symlink()]
        self.assertTrue(trimmed)
        for path in [*trimmed, copied / "include/opencl-c.h"]:
            self.assertLess(4 * path.stat().st_size, (pathlib.Path("/usr/share/pocl") / path.relative_to(copied)).stat().st_size)

    def test_what_no_kernel_calls(self):
        fault = cli.broken_kernels(self, "light/sky.cl", "madd3(fma(splat(R(0.5)), height",
                                   "madd3(fma(splat(lgamma(R(0.5))), height")
        self.write("s.json", cli.scene())
        self.fail_with(1, "render", "s.json", "--spp", "1", "-o", "p.pfm", says="lgamma", environment=fault)


cli.main()
