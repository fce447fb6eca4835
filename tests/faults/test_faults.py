"""Every call that can fail fails once: memory, and everything that is done to a file (shim.c).

Whatever fails, the program neither crashes nor hangs. With exit code 0 its results are those of an undisturbed run;
with exit code 1 there is a message, which says "memory" where memory was refused, every result is the old file or
the new one, whole, and nothing else is left behind but what the message names.

Run as: python3 test_faults.py PROGRAM SOURCE_DIR SHIM COMMAND STEP [unittest's arguments]
COMMAND: render, merge or cost. STEP: of the refused allocations of a render, only every STEP-th is tried."""

import os
import re
import sys

SHIM, COMMAND, STEP = os.path.abspath(sys.argv[3]), sys.argv[4], int(sys.argv[5])
sys.argv[3:6] = []

import cli

KINDS = ("open", "unnamed", "stream", "write", "sync", "close", "rename", "link")
OLD = b"what was there before"


class Faults(cli.ProgramTest):
    """The results stand in self.results; whatever else appears in the folder is a leftover."""

    def setUp(self):
        super().setUp()
        os.mkdir(self.path("elsewhere"))  # $TMPDIR
        self.write("s.json", cli.scene(16, 9, camera={"samples_per_pixel": 1}))
        if COMMAND == "render":
            self.arguments = ("render", "s.json", "-o", "a.pfm", "--error-map", "e.png", "--stats", "t.json", "-q")
            self.results, self.varies = ("a.pfm", "e.png", "t.json"), ("t.json",)
        elif COMMAND == "merge":
            for number in (0, 1):
                self.succeed("render", "s.json", "--first-sample", number, "-o", f"{number}.bpa", "-q")
            self.arguments = ("merge", "0.bpa", "1.bpa", "-o", "m.bpa", "--error-map", "e.png", "-q")
            self.results, self.varies = ("m.bpa", "e.png"), ()
        else:
            self.arguments = ("cost", "s.json", "--time", "0.1", "-o", "c.html", "--csv", "c.csv", "--json", "c.json", "-q")
            self.results = self.varies = ("c.html", "c.csv", "c.json")
        self.inputs = set(os.listdir(self.folder))
        self.run_with("none", 0)  # a device's self-test is remembered from here on, its kernels are built
        self.right = {name: self.read(name) for name in self.results}

    def run_with(self, kind, at):
        """One run with one fault; its result and how many calls of the kind there were."""
        log = os.path.join(self.path("elsewhere"), "log")
        result = self.run_program(*self.arguments, environment={
            "LD_PRELOAD": SHIM, "FAULT_KIND": kind, "FAULT_AT": str(at), "FAULT_LOG": log,
            "TMPDIR": self.path("elsewhere")})
        with open(log, encoding="ascii") as file:
            calls = int(file.read())
        os.remove(log)
        return result, calls

    def picture_of(self, sums):
        """What the sums of a render that could not be written make."""
        picture = self.path("kept.pfm")
        self.succeed("merge", sums, "-o", picture, "-q")
        with open(picture, "rb") as file:
            content = file.read()
        os.remove(picture)
        return content

    def is_right(self, name, content):
        """Whether that is what an undisturbed run writes; of what differs from run to run, whether it is whole."""
        if name not in self.varies:
            return content == self.right[name]
        return content.rstrip()[-7:] == self.right[name].rstrip()[-7:] if name.endswith(("json", "html")) \
            else content.endswith(b"\n") and content.count(b"\n") == self.right[name].count(b"\n")

    def try_one(self, kind, at, existing, where):
        for name in set(os.listdir(self.folder)) - self.inputs:
            os.remove(self.path(name))
        for name in os.listdir(self.path("elsewhere")):
            os.remove(os.path.join(self.path("elsewhere"), name))
        if existing:
            for name in self.results:
                self.write(name, OLD)
        result, _ = self.run_with(kind, at)
        self.assertIn(result.returncode, (0, 1), f"{where}: {result.errors}")
        if result.returncode == 1:
            self.assertRegex(result.errors, r"(?m)^ballpark: .*\w", where)
        if result.returncode == 1 and kind == "alloc":
            self.assertIn("memory", result.errors.lower(), where)
        named = re.findall(r"the complete result is in (\S+)", result.errors)
        for name in self.results:
            there = self.read(name) if os.path.exists(self.path(name)) else None
            good = there is not None and self.is_right(name, there)
            if result.returncode == 1 and there == (OLD if existing else None):
                good = True
            self.assertTrue(good, f"{where}: {name} is {there and there[:60]}, {result.errors}")
        for path in re.findall(r"ballpark merge (\S+) -o FILE makes the picture", result.errors):
            path = os.path.join(self.folder, path)
            self.assertEqual(self.picture_of(path), self.right["a.pfm"], where)
            os.remove(path)
        for folder in (self.folder, self.path("elsewhere")):
            for name in set(os.listdir(folder)) - self.inputs - set(self.results):
                path = os.path.join(folder, name)
                self.assertIn(path, [os.path.join(self.folder, one) for one in named], f"{where}: left behind: {result.errors}")
                with open(path, "rb") as file:
                    self.assertTrue(self.is_right(name.rsplit(".", 1)[0], file.read()), f"{where}: {name} is not whole")
        return result

    def every(self, kind, step=1):
        _, calls = self.run_with(kind, 0)
        failed = 0
        for at in range(1, calls + 1, step):
            existing = at % 2 == 0 or kind == "rename"
            where = f"{COMMAND}, {kind} {at} of {calls}"
            with self.subTest(where):
                failed += self.try_one(kind, at, existing, where).returncode
        return calls, failed

    def test_files(self):
        for kind in KINDS:
            for name in self.results:
                self.write(name, OLD)  # so that there is something to rename over
            calls, failed = self.every(kind)
            self.assertGreater(calls, 0, f"{kind}: nothing was tried")
            if kind == "write":
                self.assertEqual(failed, calls, "a write failed and the program did not")

    def test_files_always(self):
        """The same call fails every time: no unnamed files here, no rename, no link."""
        for kind in ("unnamed", "rename", "link"):
            for existing in (False, True):
                result = self.try_one(kind, "all", existing, f"{COMMAND}, every {kind}, existing: {existing}")
                if kind == "unnamed" or existing:
                    self.assertEqual(result.returncode, 0, f"every {kind}: {result.errors}")

    def test_memory(self):
        if COMMAND == "cost":
            self.skipTest("of a study's allocations, thousands, those of a render are tried with the render")
        calls, failed = self.every("alloc", STEP)
        self.assertGreater(calls, 50)
        self.assertGreater(failed, 0)


if __name__ == "__main__":
    if not os.path.exists(SHIM):
        print("skipped: the library that makes calls fail is not built")
        sys.exit(77)
    cli.main()
