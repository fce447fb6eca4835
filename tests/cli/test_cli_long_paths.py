"""Paths of a million segments, in a room of mirrors: --time and Ctrl-C do not wait for thousands of them.

How long a path takes is measured first, so that every limit is a ratio of times of this run."""

import json
import signal
import subprocess
import time

from cli import LIMIT_SECONDS, PROGRAM, ProgramTest, main, scene
from pfm import read_pfm

FORMS = ("packet", "sample")
FEW, MANY = 4 * 4, 128 * 128  # samples: of the measurement; of the first chunk there once was, whatever it cost


class LongPaths(ProgramTest):
    measured = {}

    def setUp(self):
        super().setUp()
        # PoCL: as many cores as the measurement can speak for.
        self.environment.update(POCL_MAX_PTHREAD_COUNT="2", POCL_CPU_MAX_CU_COUNT="2")
        self.write("m.json", scene(spheres=[{"center": [0.1, 0.05, 0], "radius": 5, "material": "m"}],
                                   materials={"m": {"type": "metal", "albedo": [1, 1, 1],
                                                     "emit": [1e-5, 1e-5, 1e-5]}},
                                   camera={"max_depth": 1000000, "samples_per_pixel": 1}))

    def measure(self, form):
        """Seconds of a whole run of few samples, and what many take at its rate on two cores."""
        if form in self.measured:
            return self.measured[form]
        command = ["render", "m.json", "--width", "4", "--kernel", form, "-q", "-o", "x.png", "--stats", "-"]
        self.succeed(*command)  # a driver compiles once
        start = time.monotonic()
        stats = json.loads(self.succeed(*command).stdout)
        whole = time.monotonic() - start
        self.assertEqual(stats["cut_paths"], FEW)
        self.measured[form] = whole, stats["seconds"]["trace"] * MANY / FEW / 2
        return self.measured[form]

    def test_time(self):
        for form in FORMS:
            with self.subTest(form):
                whole, many = self.measure(form)
                start = time.monotonic()
                self.fail_with(1, "render", "m.json", "--width", "128", "--kernel", form, "-o", "t.png", "--time", "0.5",
                               says=["--time 0.5 ran out before every pixel had a sample", "t.png", "--depth"])
                self.assertLess(time.monotonic() - start, whole + many / 4)
                self.assertIn("t.png", self.files())

    def test_interrupt(self):
        for form in FORMS:
            with self.subTest(form):
                whole, many = self.measure(form)
                process = subprocess.Popen([PROGRAM, "render", "m.json", "--width", "128", "--kernel", form, "-q",
                                            "-o", form + ".png"], cwd=self.folder, stderr=subprocess.PIPE,
                                           env=self.environment)
                time.sleep(2 * whole)  # by then it traces; and if not, there is nothing to save
                start = time.monotonic()
                process.send_signal(signal.SIGINT)
                _, errors = process.communicate(timeout=LIMIT_SECONDS)
                self.assertLess(time.monotonic() - start, many / 8)
                self.assertEqual(process.returncode, 130)
                if form + ".png" in self.files():
                    self.assertIn("interrupted after 0 of 1 sample", errors.decode())

    def test_the_picture_is_the_same(self):
        """The forms have chunks of other sizes."""
        pictures = [self.succeed("render", "m.json", "--width", "5", "--kernel", form, "-q", "-o", "-", "--format",
                                 "pfm", "--depth", "100000").stdout for form in FORMS]
        self.assert_same(*pictures)
        self.assertGreater(min(read_pfm(pictures[0])[2]), 0.9)


if __name__ == "__main__":
    main()
