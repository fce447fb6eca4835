"""Drivers that crash or end the process when they start do not take Python along: they are left out with a warning, and where no
other is there, the error says what happened. A good start is noted, and then nothing is tried.

Usage: test_python_crash.py SOURCE_DIR BUILD_DIR
"""

import os
import pathlib
import subprocess
import sys
import tempfile

import package

source, build = map(pathlib.Path, sys.argv[1:3])
ballpark, np = package.load(source, build)
LIBRARIES = build.resolve() / "tests"
ENDS = {"crash": "crashed: Aborted", "segv": "crashed: Segmentation fault", "exit": "ended the process with exit code 0",
        "leave": "ended the process with exit code 0", "quick": "ended the process with exit code 0"}
if not all((LIBRARIES / f"lib{kind}_icd.so").exists() for kind in ENDS):
    package.skip("the broken drivers of the tests are not built")

PROGRAM = """
import concurrent.futures, sys, warnings
import ballpark
warnings.simplefilter("always")
warnings.showwarning = lambda message, *_: print("warning:", message)
def draw(number):
    return float(ballpark.render([[0, 0, 0], [1, 0, 0]], radius=0.2, width=32, spp=2, seed=number).radiance.mean())
try:
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        print(list(pool.map(draw, range(3))))
    print(len(ballpark.devices()) > 0)
except ballpark.DeviceError as error:
    print("error:", error)
"""


class Place:
    """Drivers and a cache of their own."""

    def __init__(self, folder, *kinds, pocl=True):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=folder))
        for name in ("vendors", "cache", "tmp"):
            (self.folder / name).mkdir()
        if pocl:
            given = pathlib.Path(os.environ.get("OCL_ICD_VENDORS") or "/etc/OpenCL/vendors")
            (self.vendors / "pocl.icd").write_text((given if given.is_file() else given / "pocl.icd").read_text())
        for kind in kinds:
            (self.vendors / f"{kind}.icd").write_text(f"{LIBRARIES}/lib{kind}_icd.so\n")

    @property
    def vendors(self):
        return self.folder / "vendors"

    def run(self, program=PROGRAM, **environment):
        """What it says, line by line."""
        done = subprocess.run([sys.executable, "-B", "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=120, check=False,
                              env={**os.environ, "PYTHONPATH": str(source / "python"), "OCL_ICD_VENDORS": str(self.vendors), "TMPDIR": str(self.folder / "tmp"),
                                   "XDG_CACHE_HOME": str(self.folder / "cache"), **environment})
        assert done.returncode == 0, (done.returncode, done.stdout, done.stderr)
        assert list((self.folder / "tmp").iterdir()) == [], "a temporary folder is left"
        return done.stdout.splitlines()

    def notes(self):
        return sorted((self.folder / "cache").glob("ballpark/drivers-*.txt"))


def left_out(place, kind):
    return (f"warning: ballpark: the OpenCL driver {place.vendors}/{kind}.icd ({LIBRARIES}/lib{kind}_icd.so) is left out, "
            f"as it {ENDS[kind]}")


def test_left_out(folder):
    """Whoever is broken, the picture is that of the others, in every process anew."""
    right = Place(folder).run()
    assert len(right) == 2 and right[1] == "True", right
    for kind in ENDS:
        place = Place(folder, kind)
        for _ in range(2 if kind == "segv" else 1):
            assert place.run() == [left_out(place, kind), *right], kind
    two = Place(folder, "crash", "exit")
    assert two.run() == [left_out(two, "crash"), left_out(two, "exit"), *right]


def test_none_is_left(folder):
    place = Place(folder, "segv", pocl=False)
    said = place.run()
    assert len(said) == 1 and said[0].startswith("error: an OpenCL driver crashed: Segmentation fault, while starting: "), said
    for word in (f"{place.vendors}/segv.icd ({LIBRARIES}/libsegv_icd.so) crashed", "ballpark devices", "OCL_ICD_VENDORS"):
        assert word in said[0]
    assert place.notes() == []


def test_noted(folder):
    """A driver is tried once, until its file changes or a week is over."""
    place = Place(folder)
    assert place.notes() == []
    right = place.run()
    [note] = place.notes()
    os.utime(note, (1e9, 1e9))  # too old
    assert place.run() == right and note.stat().st_mtime > 1e9
    written = note.stat().st_mtime_ns
    assert place.run() == right and note.stat().st_mtime_ns == written
    (place.vendors / "segv.icd").write_text(f"{LIBRARIES}/libsegv_icd.so\n")
    assert place.run() == [left_out(place, "segv"), *right]
    # No process is started where there is a note: here, none could be.
    place = Place(folder)
    place.run()
    nothing = PROGRAM.replace("import ballpark\n", "import ballpark, subprocess\nsubprocess.Popen.__init__ = None\n")
    assert place.run(nothing) == right
    # Nor does anything depend on a folder for notes, or on the name of Python's program.
    nowhere = {"XDG_CACHE_HOME": "/dev/null/none", "POCL_CACHE_DIR": str(place.folder / "cache")}
    assert place.run(PROGRAM.replace("import ballpark\n", "import ballpark\nsys.executable = ''\n"), **nowhere) == right
    assert place.run(**nowhere) == right


with tempfile.TemporaryDirectory() as name:
    for function in (test_left_out, test_none_is_left, test_noted):
        print(function.__name__, flush=True)
        function(name)
print("ok")
