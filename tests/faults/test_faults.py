"""Every call that can fail fails once: memory, and everything that is done to a file (shim.c).

Whatever fails, the program neither crashes nor hangs. With exit code 0 its results are those of an undisturbed run;
with exit code 1 there is a message, which says "memory" where memory was refused, every result is the old file or
the new one, whole, and nothing else is left behind but what the message names, and checkpoints.

Run as: python3 test_faults.py PROGRAM SOURCE_DIR SHIM COMMANDS TRIES [unittest's arguments]
COMMANDS: names of COMMANDS below, with commas between; "every": all of them. TRIES: how many calls of each kind are let fail, one
at a time, spread evenly over all that there are; "all": all of them."""

import gzip
import json
import os
import re
import sys
import xml.etree.ElementTree as xml

SHIM, CHOSEN = os.path.abspath(sys.argv[3]), sys.argv[4].split(",")
TRIES = None if sys.argv[5] == "all" else int(sys.argv[5])
sys.argv[3:6] = []

import cli

FILE_KINDS = ("open", "unnamed", "stream", "read", "write", "sync", "close", "rename", "link")
MEMORY_KINDS = ("alloc", "json", "library")
OLD = b"what was there before"
# The sky outshines the lamp, so no rays are sent to it: a program that were to find so only with enough memory would make
# another picture without.
# Its title stands in files of sums.
SCENE = cli.scene(16, 9, title="two balls", camera={"samples_per_pixel": 1}, materials={
    "m": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}, "l": {"type": "diffuse_light", "emit": [0.3, 0.3, 0.3]}},
    spheres=[{"center": [0.3 * i - 0.1, 0, -1 - 0.01 * i], "radius": 0.5, "material": "ml"[i]} for i in range(2)])
XYZ = "2\nfirst\nC 0 0 0\nO 1 0 0\n2\nsecond\nC 0 0 0\nO 1.2 0 0\n"


class Command:
    """One run of the program: what it writes, which of that differs from run to run (`varies`), what may be left
    unfinished by a run that fails (`checkpoint`), the commands that make what it reads. A study makes one long document
    and many small pictures by the same few calls of jansson and libpng, a suite checks many scenes alike: of "all" calls
    of a kind in `often`, only so many times fewer are tried.
    `codes`: the exit codes of what a failing file may lead to. A child of `check` that cannot say anything counts as a
    driver that crashed (6). `new_only`: it replaces no file."""

    def __init__(self, line, results, varies=(), checkpoint=None, inputs=(), often=None, codes=(0, 1), new_only=False):
        self.line, self.results, self.varies, self.checkpoint = line.split(), results, varies, checkpoint
        self.inputs, self.often, self.codes, self.new_only = inputs, often or {}, codes, new_only


PARTS = ("render s.json --spp 4 -o 0.bpa", "render s.json --spp 4 --first-sample 4 -o 1.bpa")
COMMANDS = {
    "render": Command("render s.json -o a.pfm --error-map e.png --stats t.json", ("a.pfm", "e.png", "t.json"), ("t.json",)),
    "merge": Command("merge 0.bpa 1.bpa -o m.bpa --error-map e.png", ("m.bpa", "e.png"), inputs=PARTS),
    "cost": Command("cost s.json --width 4 --time 0.1 -o c.html --csv c.csv --json c.json", ("c.html", "c.csv", "c.json"),
                    ("c.html", "c.csv", "c.json"), often={"json": 12, "library": 12}),
    "checkpoint": Command("render s.json --spp 300 --checkpoint 0.000001 -o a.pfm", ("a.pfm",), checkpoint="a.bpa"),
    "resume": Command("render s.json --resume 0.bpa --spp 8 -o a.pfm", ("a.pfm",), inputs=PARTS),
    "share": Command("render s.json --spp 64 --share 1/2 -o a.bpa", ("a.bpa",)),
    "frames": Command("render p.xyz.gz --frames 0:2 --width 16 --spp 1 --format pfm", ("p-0000.pfm", "p-0001.pfm")),
    "several": Command("render s.json p.xyz --width 16 --spp 1 --format ppm --stats t.json", ("s.ppm", "p.ppm", "t.json"), ("t.json",)),
    "check": Command("check s.json --width 8 --json j.json --junit j.xml --map m.png", ("j.json", "j.xml", "m.png"),
                     ("j.json", "j.xml"), codes=(0, 1, 6)),
    "against": Command("check s.json --width 8 --against old.json --json j.json", ("j.json",), ("j.json",),
                       inputs=("check s.json --width 8 --json old.json",), codes=(0, 1, 6)),
    "clobber": Command("render s.json --no-clobber -o a.pfm --error-map e.png", ("a.pfm", "e.png"), new_only=True),
    "exr": Command("merge 0.bpa 1.bpa -o m.exr", ("m.exr",), inputs=PARTS),
    "suite": Command("check --suite --effects all --width 4 --spp 512 --margin 100 --json j.json --junit j.xml", ("j.json", "j.xml"),
                     ("j.json", "j.xml"), often={"alloc": 20, "json": 200, "write": 10}, codes=(0, 1, 6)),
    "scene": Command("scene p.xyz -o p.json", ("p.json",)),
    "cover": Command("generate cover --grid 0 -o c.json", ("c.json",)),
    "field": Command("generate field --count 5 -o f.ply", ("f.ply",)),
}


def says_failure(name, content):
    """Whether a document of check is whole and has an error: it is written in every outcome."""
    try:
        if name.endswith("json"):
            return "error" in json.loads(content)
        return name.endswith("xml") and xml.fromstring(content).find(".//error") is not None
    except (ValueError, xml.ParseError):
        return False


def chosen_calls(calls, often):
    """The numbers of those of `calls` calls that are let fail: in the middle of TRIES equal parts."""
    if TRIES is None:
        return range(1, calls + 1, often)
    if TRIES >= calls:
        return range(1, calls + 1)
    return [1 + (2 * part + 1) * calls // (2 * TRIES) for part in range(TRIES)]


class Faults:
    """The results stand in self.results; whatever else appears in the folder is a leftover."""

    def setUp(self):
        super().setUp()
        self.command = COMMANDS[self.NAME]
        self.results, self.varies = self.command.results, self.command.varies
        os.mkdir(self.path("elsewhere"))  # $TMPDIR
        self.write("s.json", SCENE)
        self.write("p.xyz", XYZ)
        self.write("p.xyz.gz", gzip.compress(XYZ.encode()))
        for line in self.command.inputs:
            self.succeed(*line.split(), "-q")
        self.inputs = set(os.listdir(self.folder))
        self.run_with("none", 0)  # a device's self-test is remembered from here on, its kernels are built
        self.right = {name: self.read(name) for name in self.results}

    def run_with(self, kind, at):
        """One run with one fault; its result and how many calls of each kind there were."""
        log = os.path.join(self.path("elsewhere"), "log")
        result = self.run_program(*self.command.line, "-q", environment={
            "LD_PRELOAD": SHIM, "FAULT_KIND": kind, "FAULT_AT": str(at), "FAULT_LOG": log,
            "TMPDIR": self.path("elsewhere")})
        with open(log, encoding="ascii") as file:
            calls = {name: int(number) for name, number in map(str.split, file)}
        os.remove(log)
        return result, calls

    def picture_of(self, sums, like):
        """What the sums of a render that could not be written make, in the format of the file `like`; of sums the
        picture: where memory was lacking they may be kept without depth, normals and albedo."""
        ending = os.path.splitext(like)[1]
        picture = self.path("kept" + (".pfm" if ending == ".bpa" else ending))
        self.succeed("merge", sums, "-o", picture, "-q")
        with open(picture, "rb") as file:
            content = file.read()
        os.remove(picture)
        return content

    def right_pictures(self):
        for name in self.results:
            if name.endswith(".bpa"):
                with open(self.path("right.bpa"), "wb") as file:
                    file.write(self.right[name])
                yield self.picture_of(self.path("right.bpa"), name)
                os.remove(self.path("right.bpa"))
            elif name not in self.varies:
                yield self.right[name]

    def is_right(self, name, content):
        """Whether that is what an undisturbed run writes; of what differs from run to run, whether it is whole."""
        if name not in self.varies:
            return content == self.right[name]
        return content.rstrip()[-7:] == self.right[name].rstrip()[-7:] if name.endswith(("json", "html", "xml")) \
            else content.endswith(b"\n") and content.count(b"\n") == self.right[name].count(b"\n")

    def try_one(self, kind, at, existing, where):
        for name in set(os.listdir(self.folder)) - self.inputs:
            os.remove(self.path(name))
        for name in os.listdir(self.path("elsewhere")):
            os.remove(os.path.join(self.path("elsewhere"), name))
        if existing:
            for name in self.results:
                self.write(name, OLD)
        result, made = self.run_with(kind, at)
        codes = (0, 1) if kind in MEMORY_KINDS else self.command.codes
        self.assertIn(result.returncode, codes, f"{where}: {result.errors}")
        if result.returncode != 0:
            self.assertRegex(result.errors, r"(?m)^ballpark: .*\w", where)
        if result.returncode != 0 and kind in MEMORY_KINDS:
            self.assertIn("memory", result.errors.lower(), where)
        named = re.findall(r"the complete result is in ([^\s;]+)", result.errors)
        for name in self.results:
            there = self.read(name) if os.path.exists(self.path(name)) else None
            good = there is not None and self.is_right(name, there)
            if result.returncode != 0 and there == (OLD if existing else None):
                good = True
            if result.returncode != 0 and self.command.line[0] == "check" and there is not None:
                good = good or says_failure(name, there)
            self.assertTrue(good, f"{where}: {name} is {there and there[:60]}, {result.errors}")
        for path in re.findall(r"ballpark merge (\S+) -o FILE` makes the picture", result.errors):
            path = os.path.join(self.folder, path)
            self.assertTrue(self.picture_of(path, self.results[0]) in list(self.right_pictures()), where)
            os.remove(path)
        if result.returncode == 1 and self.command.checkpoint in os.listdir(self.folder):
            self.succeed("merge", self.command.checkpoint, "-o", "/dev/null", "--format", "pfm", "-q")  # it is whole
            os.remove(self.path(self.command.checkpoint))
        for folder in (self.folder, self.path("elsewhere")):
            for name in set(os.listdir(folder)) - self.inputs - set(self.results):
                path = os.path.join(folder, name)
                self.assertIn(path, [os.path.join(self.folder, one) for one in named], f"{where}: left behind: {result.errors}")
                with open(path, "rb") as file:
                    self.assertTrue(self.is_right(name.rsplit(".", 1)[0], file.read()), f"{where}: {name} is not whole")
        return result, at == "all" or made[kind] >= at

    def count_calls(self):
        """How many calls of each kind there are where each result replaces a file, if it may."""
        for name in self.results:
            if self.command.new_only:
                os.remove(self.path(name))
            else:
                self.write(name, OLD)
        result, calls = self.run_with("none", 0)
        self.assertEqual(result.returncode, 0, result.errors)
        return calls

    def fail_each(self, kind, calls):
        """In how many runs a call failed, and how many of these runs failed. The moments of checkpoints differ from run to run,
        and so does what a study gets done in its time, so a run may make fewer calls than were counted."""
        tried = failed = 0
        for number, at in enumerate(chosen_calls(calls, self.command.often.get(kind, 1))):
            existing = not self.command.new_only and (number % 2 == 1 or kind == "rename")
            where = f"{self.NAME}, {kind} {at} of {calls}"
            with self.subTest(where):
                result, reached = self.try_one(kind, at, existing, where)
                tried += reached
                failed += result.returncode != 0
        return tried, failed

    def test_files(self):
        calls = self.count_calls()
        rare = ("read", "rename") if self.command.new_only else ("read",)
        self.assertGreater(min(calls[kind] for kind in FILE_KINDS if kind not in rare), 0, f"nothing was tried: {calls}")
        for kind in FILE_KINDS:
            tried, failed = self.fail_each(kind, calls[kind])
            if kind == "write" and self.command.checkpoint is None and len(self.command.codes) == 2:
                self.assertGreater(tried, 0, "no write failed")
                self.assertEqual(failed, tried, "a write failed and the program did not")

    def test_files_always(self):
        """The same call fails every time: no unnamed files here, no rename, no link."""
        for kind in ("unnamed", "rename", "link"):
            for existing in (False,) if self.command.new_only else (False, True):
                result, _ = self.try_one(kind, "all", existing, f"{self.NAME}, every {kind}, existing: {existing}")
                if kind == "unnamed" or existing:
                    self.assertEqual(result.returncode, 0, f"every {kind}: {result.errors}")

    def test_memory(self):
        calls = self.count_calls()
        self.assertGreater(sum(calls[kind] for kind in MEMORY_KINDS), 10)
        self.assertGreater(sum(self.fail_each(kind, calls[kind])[1] for kind in MEMORY_KINDS), 0)


for command in COMMANDS if CHOSEN == ["every"] else CHOSEN:
    globals()[command] = type(command, (Faults, cli.ProgramTest), {"NAME": command})


if __name__ == "__main__":
    if not os.path.exists(SHIM):
        print("skipped: the library that makes calls fail is not built")
        sys.exit(77)
    cli.main()
