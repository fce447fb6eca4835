"""What the tests of the program share: running it in a folder of its own, and small scenes.

Each test file is run as: PYTHONPATH=tests/support python3 test_X.py PROGRAM SOURCE_DIR [--deep] [unittest's arguments]

Without --deep it leaves out the tests that are marked @deep, and with --deep it runs them alone.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else ""
SOURCE = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else ""
LIMIT_SECONDS = 300  # only so that a hang is a failure


def deep(test):
    """Marks a test that takes long and finds what is rare."""
    test.is_deep = True
    return test


class Loader(unittest.TestLoader):
    """Finds the tests that are marked @deep, or all but those."""

    def __init__(self, wants_deep):
        super().__init__()
        self.wants_deep = wants_deep

    def getTestCaseNames(self, testCaseClass):
        return [name for name in super().getTestCaseNames(testCaseClass)
                if getattr(getattr(testCaseClass, name), "is_deep", False) == self.wants_deep]


def scene(width=16, height=None, spheres=1, materials=None, **members):
    """A scene document: `spheres` small ones in a row before the camera, or the list given."""
    if isinstance(spheres, int):
        spheres = [{"center": [0.3 * i - 0.1, 0, -1 - 0.01 * i], "radius": 0.5, "material": "m"}
                   for i in range(spheres)]
    camera = {"image_width": width, "samples_per_pixel": 8, "max_depth": 10}
    if height is not None:
        camera["image_height"] = height
    camera.update(members.pop("camera", {}))
    document = {"camera": camera,
                "materials": materials or {"m": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}},
                "spheres": spheres}
    document.update(members)
    return document


class ProgramTest(unittest.TestCase):
    """Every test has an empty current folder, self.folder."""

    maxDiff = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="ballpark-cli-")
        self.addCleanup(shutil.rmtree, self.folder)
        # Messages are looked for as they are, and not as they are wrapped: tests of wrapping take COLUMNS away.
        self.environment = dict(os.environ, LC_ALL="C.UTF-8", COLUMNS="10000")

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        """A file of text, bytes, or a JSON document; returns its name."""
        if isinstance(content, (dict, list)):
            content = json.dumps(content)
        with open(self.path(name), "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return name

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def files(self):
        return sorted(os.listdir(self.folder))

    def run_program(self, *arguments, environment=None, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE):
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, stdin=stdin, stdout=stdout,
                                stderr=subprocess.PIPE, timeout=LIMIT_SECONDS,
                                env=dict(self.environment, **(environment or {})))
        result.errors = result.stderr.decode(errors="replace")
        return result

    def assert_same(self, one, other, what=None):
        """assertEqual for whole files, without showing them."""
        self.assertTrue(one == other, f"differ: {what}")

    def assert_different(self, one, other, what=None):
        self.assertTrue(one != other, f"the same: {what}")

    def succeed(self, *arguments, **options):
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, 0, f"{arguments}: {result.errors}")
        return result

    def fail_with(self, code, *arguments, says=(), **options):
        """Fails with the exit code, and a message of one "ballpark: " or "ballpark COMMAND: " line that has every text of `says`."""
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, code, f"{arguments}: {result.errors}")
        self.assertRegex(result.errors, r"(?m)^ballpark(?: [a-z]+)?: ")  # a driver may have its say first
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, result.errors, arguments)
        if options.get("stdout", subprocess.PIPE) == subprocess.PIPE:
            self.assertEqual(result.stdout, b"", arguments)
        return result


def broken_kernels(test, name, find, replace):
    """A copy of the kernels with a fault in the file `name`, as BALLPARK_KERNELS."""
    shutil.copytree(os.path.join(SOURCE, "kernels"), test.path("kernels"))
    with open(test.path("kernels/" + name)) as file:
        text = file.read()
    test.assertEqual(text.count(find), 1, "the place of the fault has moved")
    test.write("kernels/" + name, text.replace(find, replace))
    return {"BALLPARK_KERNELS": test.path("kernels")}


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup's way would be handed on to the programs that are to get it
    words = [word for word in sys.argv[3:] if word != "--deep"]
    loader = Loader("--deep" in sys.argv)
    result = unittest.main(argv=[sys.argv[0]] + words, testLoader=loader, verbosity=1, exit=False).result
    # The reasons, for the summary of scripts/test.
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    for test, text in result.failures + result.errors:
        print(f"{test.id()} FAILED: {text.strip().splitlines()[-1]}")  # for what runs single tests, as the mutants do
    if not result.wasSuccessful():
        sys.exit(1)
    # A class that is skipped as a whole is in the list, but none of its tests was begun.
    ran = result.testsRun - sum(isinstance(test, unittest.TestCase) for test, _ in result.skipped)
    if ran == 0 and not result.skipped:
        sys.exit("no test was chosen")
    sys.exit(77 if ran == 0 else 0)
