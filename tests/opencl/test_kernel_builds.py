"""How often kernels are built: once for a series of pictures or checks, and again where the driver was disturbed.

Run as: PYTHONPATH=tests/support python3 test_kernel_builds.py PROGRAM SOURCE_DIR BUILD_SHIM
"""
import json
import os
import sys

import cli

SHIM = os.path.abspath(sys.argv.pop(3))
FRAMES = "".join(f"2\n\nO 0 0 {i}\nC 0 {i + 1} 1.5\n" for i in range(4))
SIZE = ("--width", 8, "--spp", 1, "--quiet")


class Builds(cli.ProgramTest):
    def builds(self, *arguments, code=0, **environment):
        """How often the program builds a kernel, and what it says."""
        log = self.path("builds")
        if os.path.exists(log):
            os.remove(log)
        result = self.run_program(*arguments, environment={"LD_PRELOAD": SHIM, "BUILD_LOG": log, **environment})
        self.assertEqual(result.returncode, code, result.errors)
        return len(self.read("builds").splitlines()), result.errors

    def test_once_for_all(self):
        self.write("run.xyz", FRAMES)
        self.succeed("render", "run.xyz", "-o", "warm.png", *SIZE)  # the self-test is behind us
        one = self.builds("render", "run.xyz", "-o", "one.png", *SIZE)
        self.assertEqual(one, (1, ""))
        self.assertEqual(self.builds("render", "run.xyz", "--frames", "::", "-o", "f.png", *SIZE), one)
        self.assertEqual(self.builds("render", "run.xyz", "--turntable", 5, "-o", "t.png", *SIZE), one)
        # Light whose lamps come and go is another kernel, but still one.
        self.assertEqual(self.builds("render", "run.xyz", "--frames", ":2", "--lighting", "studio", "-o", "s.png", *SIZE), one)
        self.assertEqual(len([name for name in self.files() if name.startswith(("f-", "t-", "s-"))]), 4 + 5 + 2)
        # With layers there is a kernel for them in the same program.
        self.assertEqual(self.builds("render", "run.xyz", "--frames", ":3", "-o", "e.exr", *SIZE), one)

    def test_once_for_a_suite(self):
        """Whatever the number of scenes and recorded pictures, a form of the kernel is built once."""
        suite = ("check", "--suite", "--effects", "all", "--width", 4, "--spp", 512, "--margin", 100, "--quiet")
        self.succeed(*suite)  # the self-test is behind us
        builds, said = self.builds(*suite)
        self.assertEqual(said, "")
        kernels = set(self.read("builds").splitlines())
        lanes = {line.split()[1] for line in kernels}
        # One of lists, and one of trees, or one of small and one of large trees where these get packets of another size; and each
        # again with light sampling, and with light by way of two balls too, unless no such scene has a large tree.
        self.assertEqual(builds, len(kernels))
        once = 1 + len(lanes)
        self.assertIn(builds, range(once + 4, 3 * once + 1))
        with open(os.path.join(cli.SOURCE, "host/check/bits.json"), encoding="utf-8") as file:
            pictures = [p for p in json.load(file)["pictures"] if p["scene"] in ("tie", "bubble", "noise")]
        self.write("bits.json", {"pictures": pictures})
        bits = ("check", "--bits", "--kernel", "sample", "--precision", "single", "--quiet")
        self.assertEqual(self.builds(*bits, BALLPARK_BITS=self.path("bits.json"))[0], 4)  # and of hits refined in float

    def test_again_after_a_disturbance(self):
        """Without a complaint about the source, PoCL's next attempt may succeed; there is an end to attempts."""
        if b"Portable Computing Language" not in self.run_program("devices").stdout:
            self.skipTest("PoCL is not installed")
        self.write("s.json", cli.scene(width=4))
        render = ("render", "s.json", "--quiet", "--device", "portable")
        self.succeed(*render)  # the self-test is behind us
        self.assertEqual(self.builds(*render, BUILD_FAILURES="3"), (4, ""))
        builds, said = self.builds(*render, code=1, BUILD_FAILURES="1000")
        self.assertEqual(builds, 8)
        self.assertIn("the kernel does not compile", said)
        self.assertIn("CL_BUILD_PROGRAM_FAILURE", said)

    def test_no_second_attempt_at_a_fault_of_the_source(self):
        self.write("s.json", cli.scene(width=4))
        broken = cli.broken_kernels(self, "light/sky.cl", "madd3(fma(splat(R(0.5)), height", "nonsense(fma(splat(R(0.5)), height")
        builds, said = self.builds("render", "s.json", "--quiet", code=1, **broken)
        self.assertEqual(builds, 1)
        self.assertIn("the kernel does not compile", said)


cli.main()
