"""A series of pictures builds its kernel once.

Run as: PYTHONPATH=tests/support python3 test_series_builds.py PROGRAM SOURCE_DIR COUNT_BUILDS
"""
import os
import sys

import cli

SHIM = os.path.abspath(sys.argv.pop(3))
FRAMES = "".join(f"2\n\nO 0 0 {i}\nC 0 {i + 1} 1.5\n" for i in range(4))
SIZE = ("--width", 8, "--spp", 1, "--quiet")


class Builds(cli.ProgramTest):
    def builds(self, *arguments):
        """How often the program builds a kernel."""
        log = self.path("builds")
        if os.path.exists(log):
            os.remove(log)
        self.succeed(*arguments, environment={"LD_PRELOAD": SHIM, "BUILD_LOG": log})
        return len(self.read("builds"))

    def test_once_for_all(self):
        self.write("run.xyz", FRAMES)
        self.succeed("render", "run.xyz", "-o", "warm.png", *SIZE)  # the self-test is behind us
        one = self.builds("render", "run.xyz", "-o", "one.png", *SIZE)
        self.assertEqual(one, 1)
        self.assertEqual(self.builds("render", "run.xyz", "--frames", "::", "-o", "f.png", *SIZE), one)
        self.assertEqual(self.builds("render", "run.xyz", "--turntable", 5, "-o", "t.png", *SIZE), one)
        # Light whose lamps come and go is another kernel, but still one.
        self.assertEqual(self.builds("render", "run.xyz", "--frames", ":2", "--light", "studio", "-o", "s.png", *SIZE), one)
        self.assertEqual(len([name for name in self.files() if name.startswith(("f-", "t-", "s-"))]), 4 + 5 + 2)
        # With layers there is a kernel for them in the same program.
        self.assertEqual(self.builds("render", "run.xyz", "--frames", ":3", "-o", "e.exr", *SIZE), one)


cli.main()
