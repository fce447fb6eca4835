"""Drivers that hang, crash or end the process when they start: every command goes on with the others, and says so.

usage: test_cli_driver_start.py PROGRAM SOURCE_DIR LIBRARY FAKE_WINDOW [--deep] [unittest's arguments]
"""

import json
import os
import signal
import subprocess
import sys
import time

import cli

LIBRARY, WINDOW = sys.argv[3:5]
del sys.argv[3:5]
LIBRARIES = os.path.join(os.path.dirname(cli.PROGRAM), "tests")
LIMIT = "1"  # seconds; also a loaded machine has PoCL's list by then, when asked again

ENDS = {"hang": "hung: there was no answer within 1 s", "load": "hung: there was no answer within 1 s",
        "crash": "crashed: Aborted", "segv": "crashed: Segmentation fault", "exit": "ended the process with exit code 0",
        "leave": "ended the process with exit code 0", "quick": "ended the process with exit code 0"}


class DriverStart(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("vendors"))
        os.mkdir(self.path("tmp"))
        good = self.run_program("devices", "--json", "-")
        devices = json.loads(good.stdout)["devices"] if good.returncode == 0 else []
        if not any(d["platform"] == "Portable Computing Language" for d in devices):
            self.skipTest("PoCL is not installed")
        folder = self.environment.get("OCL_ICD_VENDORS", "/etc/OpenCL/vendors")
        pocl = folder if os.path.isfile(folder) else os.path.join(folder, "pocl.icd")
        with open(pocl) as file:
            self.write("vendors/pocl.icd", file.read())
        self.environment.update(OCL_ICD_VENDORS=self.path("vendors"), TMPDIR=self.path("tmp"), BALLPARK_DRIVER_SECONDS=LIMIT,
                                FAKE_DEVICES="cpu=Fine")
        if "ASAN_OPTIONS" in self.environment:  # a fault of a driver is to be what it is without
            self.environment["ASAN_OPTIONS"] += ":handle_segv=0"
        self.write("s.json", cli.scene(width=8))

    def tearDown(self):
        if os.path.isdir(self.path("tmp")):
            self.assertEqual(os.listdir(self.path("tmp")), [], "a temporary folder is left")

    def install(self, *kinds, alone=False):
        if alone:
            os.remove(self.path("vendors/pocl.icd"))
        for kind in kinds:
            library = os.path.join(LIBRARIES, f"lib{kind}_icd.so")
            self.assertTrue(os.path.exists(library), "the drivers of the tests are not built")
            self.write(f"vendors/{kind}.icd", library + "\n")

    def assert_left_out(self, result, kind):
        self.assertEqual(result.returncode, 0, result.errors)
        self.assertIn(f"warning: the OpenCL driver {self.path('vendors')}/{kind}.icd ({LIBRARIES}/lib{kind}_icd.so) is left out, "
                      f"as it {ENDS[kind]}", result.errors)

    def test_render_goes_on_with_the_others(self):
        self.succeed("render", "s.json", "-o", "right.png")
        for kind in ENDS:
            self.install(kind)
            self.assert_left_out(self.run_program("render", "s.json", "-o", f"{kind}.png"), kind)
            self.assert_same(self.read("right.png"), self.read(f"{kind}.png"))
            os.remove(self.path(f"vendors/{kind}.icd"))

    def test_two_broken_drivers(self):
        self.install("crash", "exit")
        result = self.run_program("render", "s.json", "-o", "a.png", "--device", "portable")
        self.assert_left_out(result, "crash")
        self.assert_left_out(result, "exit")

    def test_every_command(self):
        self.install("crash")
        for words in (["bench", "s.json", "--time", "0.1", "--rounds", "1"], ["explain", "s.json", "--pixel", "1,1"],
                      ["explain", "s.json", "--pixel", "1,1", "--device", "portable"],
                      ["check", "s.json", "--spp", "64", "--margin", "20"]):
            self.assert_left_out(self.run_program(*words), "crash")
        self.assertEqual(self.run_program("scene", "s.json").errors, "", "no driver is needed")

    @cli.deep
    def test_every_command_that_measures(self):
        for kind in ("crash", "hang"):
            self.install(kind)
            for words in (["explain", "s.json", "--measure"], ["cost", "s.json", "--time", "1", "-o", f"{kind}.html"],
                          ["bench", "s.json", "--time", "1"], ["bench", "s.json", "--time", "1", "--device", "portable"]):
                self.assert_left_out(self.run_program(*words), kind)
            os.remove(self.path(f"vendors/{kind}.icd"))

    def test_view(self):
        self.install("crash")
        self.write("script", "rest\nquit\n")
        self.assert_left_out(self.run_program("view", "s.json", environment={
            "BALLPARK_WINDOW": WINDOW, "FAKE_WINDOW_SCRIPT": "script", "FAKE_WINDOW_LOG": "log"}), "crash")
        self.assertIn(b"\nshow 8 ", self.read("log"))

    def test_a_scene_from_standard_input_is_not_lost(self):
        self.install("segv")
        self.succeed("render", "s.json", "-o", "right.png")
        with subprocess.Popen(["cat", self.path("s.json")], stdout=subprocess.PIPE) as cat:
            result = self.run_program("render", "-", "-o", "a.png", "--quiet", stdin=cat.stdout)
        self.assertEqual((result.returncode, result.errors), (0, ""))
        self.assert_same(self.read("right.png"), self.read("a.png"))

    def test_operands_behind_dashes(self):
        """What starts again has the arguments as they were given."""
        self.install("crash")
        self.write("-q", cli.scene(width=8))
        self.assert_left_out(self.run_program("render", "-o", "a.png", "--", "-q"), "crash")

    def test_none_is_left(self):
        for kind in ("crash", "hang", "exit"):
            self.install(kind, alone=kind == "crash")
            for words in (["render", "s.json", "-o", "a.png"], ["render", "s.json", "-o", "a.png", "--device", "all"]):
                self.fail_with(1, *words, says=["no OpenCL device is left", f"{kind}.icd", ENDS[kind], "OCL_ICD_VENDORS"])
            os.remove(self.path(f"vendors/{kind}.icd"))

    def test_a_name_that_no_device_has(self):
        self.install("crash")
        self.fail_with(1, "render", "s.json", "-o", "a.png", "--device", "nosuch", "--quiet",
                       says=["no device matches 'nosuch'", "crash.icd", "crashed: Aborted"])

    def test_a_device_that_breaks_when_it_is_listed(self):
        self.install("fake")
        left_out = f"fake.icd ({LIBRARIES}/libfake_icd.so) is left out, as it "
        result = self.succeed("render", "s.json", "-o", "a.png", environment={"FAKE_DEVICES": "unlistable-hanging"})
        self.assertIn(left_out + ENDS["hang"], result.errors)
        self.install(alone=True)  # LLVM, which PoCL brings, handles signals too
        self.fail_with(1, "render", "s.json", "-o", "a.png", environment={"FAKE_DEVICES": "unlistable-crashing"},
                       says=[left_out + ENDS["crash"], "no OpenCL device is left"])

    def test_a_device_that_breaks_when_it_is_opened(self):
        """It is the one that was chosen, so nothing else takes its place."""
        self.install("fake")
        for words in (["render", "s.json", "-o", "a.png"], ["bench", "s.json"], ["explain", "s.json", "--pixel", "1,1"],
                      ["explain", "s.json", "--measure"], ["cost", "s.json", "-o", "c.html"]):
            self.fail_with(1, *words, "--device", "Bad", environment={"FAKE_DEVICES": "crashing=Bad@2.5"},
                           says=["crashed (Aborted) while opening device ", "(Bad, Fake One, driver 2.5)", "--device"])
        self.fail_with(1, "render", "s.json", "-o", "a.png", environment={"FAKE_DEVICES": "hanging=Bad@2.5"},
                       says=["device 0 (Bad, Fake One, driver 2.5) hangs", "within 1 s", "BALLPARK_DRIVER_SECONDS"])
        self.succeed("render", "s.json", "-o", "a.png", "--device", "portable", environment={"FAKE_DEVICES": "hanging=Bad"})
        self.fail_with(6, "check", "s.json", "--spp", "64", "--margin", "20",
                       environment={"FAKE_DEVICES": "hanging=Bad@2.5"}, says="(Bad, Fake One, driver 2.5) hangs")

    def test_the_limit(self):
        self.fail_with(2, "render", "s.json", "-o", "a.png", environment={"BALLPARK_DRIVER_SECONDS": "soon"},
                       says='BALLPARK_DRIVER_SECONDS is "soon"; expected')
        for seconds in ("0", "60.5", ""):
            self.succeed("render", "s.json", "-o", "a.png", environment={"BALLPARK_DRIVER_SECONDS": seconds})

    def interrupt(self, *words, seconds):
        with subprocess.Popen([cli.PROGRAM, *words], cwd=self.folder, stderr=subprocess.DEVNULL,
                              env=dict(self.environment, BALLPARK_DRIVER_SECONDS=seconds)) as process:
            time.sleep(1.5)
            self.assertIsNone(process.poll())
            begun = time.monotonic()
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(), 130)
            self.assertLess(time.monotonic() - begun, 5)
        deadline = time.monotonic() + 10  # the folder's keeper goes a moment later
        while os.listdir(self.path("tmp")) and time.monotonic() < deadline:
            time.sleep(0.05)

    def test_interrupted(self):
        self.install("hang")
        self.interrupt("render", "s.json", "-o", "a.png", seconds="100")
        self.interrupt("bench", "s.json", seconds="100")
        self.interrupt("devices", seconds="100")
        self.install("crash")  # asked one by one, the other one hangs
        self.interrupt("render", "s.json", "-o", "a.png", seconds="100")

    def test_library_and_python(self):
        if LIBRARY == "none":
            self.skipTest("Python cannot load the library with sanitizers")
        self.install("hang")
        library = """
import ctypes, os, sys
class Error(ctypes.Structure):
    _fields_ = [("code", ctypes.c_int), ("message", ctypes.c_char * 1024), ("rest", ctypes.c_char * 600)]
library = ctypes.CDLL(sys.argv[1])
error, found, count = Error(), ctypes.c_void_p(), ctypes.c_size_t()
for i in range(2):
    print(library.bp_devices_list(ctypes.byref(found), ctypes.byref(count), ctypes.byref(error)), error.message.decode())
"""
        begun = time.monotonic()
        said = subprocess.run([sys.executable, "-c", library, LIBRARY], env=self.environment, stdout=subprocess.PIPE, text=True,
                              check=True, timeout=60).stdout.splitlines()
        self.assertLess(time.monotonic() - begun, 20)
        self.assertEqual(len(said), 2)
        for line in said:
            self.assertRegex(line, "^3 an OpenCL driver hangs: the loader of drivers did not answer within 1 s")
            for word in ("hang.icd", "ballpark devices", "OCL_ICD_VENDORS", "BALLPARK_DRIVER_SECONDS"):
                self.assertIn(word, line)
        if subprocess.run([sys.executable, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no numpy for this Python")
        python = """
import ballpark
try: ballpark.render([[0, 0, 0]], width=8, spp=1)
except ballpark.DeviceError as error: print(error)
"""
        environment = dict(self.environment, PYTHONPATH=os.path.join(cli.SOURCE, "python"), BALLPARK_LIBRARY=LIBRARY)
        said = subprocess.run([sys.executable, "-B", "-c", python], env=environment, stdout=subprocess.PIPE, text=True,
                              check=True, timeout=60).stdout
        self.assertIn("did not answer within 1 s", said)
        environment["BALLPARK_DRIVER_SECONDS"] = "100"
        with subprocess.Popen([sys.executable, "-B", "-c", "print('READY', flush=True)\n" + python], env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            process.stdout.readline()
            time.sleep(2)
            begun = time.monotonic()
            process.send_signal(signal.SIGINT)
            errors = process.communicate(timeout=60)[1]
            self.assertLess(time.monotonic() - begun, 10)
            self.assertIn("ballpark._render.Interrupted", errors)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts what runs in the background without
    cli.main()
