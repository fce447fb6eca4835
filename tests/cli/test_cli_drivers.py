"""Drivers that hang or crash are named and take nothing along: `devices` and `check` with drivers made for it."""

import json
import os
import xml.etree.ElementTree as xml

import cli

LIBRARIES = os.path.join(os.path.dirname(cli.PROGRAM), "tests")


class Drivers(cli.ProgramTest):
    """Kinds of drivers: "hang" and "crash" do so when they are asked for their platforms; "fake" has the devices
    of FAKE_DEVICES, some of which hang or crash when they are used."""

    def setUp(self):
        super().setUp()
        os.mkdir(self.path("vendors"))
        self.environment["OCL_ICD_VENDORS"] = self.path("vendors")
        self.environment["FAKE_DEVICES"] = "cpu=Good@8.1"
        os.mkdir(self.path("tmp"))
        self.environment["TMPDIR"] = self.path("tmp")
        self.write("s.json", cli.scene(width=4))

    def tearDown(self):
        self.assertEqual(os.listdir(self.path("tmp")), [], "a temporary folder is left")

    def install(self, *kinds):
        for kind in kinds:
            library = os.path.join(LIBRARIES, f"lib{kind}_icd.so")
            self.assertTrue(os.path.exists(library), "the drivers of the tests are not built")
            self.write(f"vendors/{kind}.icd", library + "\n")

    def add_pocl(self):
        """Adds PoCL to the drivers, or skips the test."""
        found = self.run_program("devices", "--json", "-", environment={"OCL_ICD_VENDORS": "pocl.icd"})
        if found.returncode != 0:
            self.skipTest("PoCL is not installed as pocl.icd")
        with open("/etc/OpenCL/vendors/pocl.icd") as file:
            self.write("vendors/pocl.icd", file.read())

    def devices(self, *options):
        return json.loads(self.succeed("devices", "--json", "-", *options).stdout)

    def test_a_good_driver_is_left_alone(self):
        self.install("fake")
        found = self.devices()
        self.assertEqual([d["name"] for d in found["devices"]], ["Good"])
        self.assertEqual(found["broken_drivers"], [])
        self.assertEqual(self.succeed("devices").errors, "")

    def test_a_driver_that_crashes(self):
        self.install("crash", "fake")
        found = self.devices()
        self.assertEqual([d["name"] for d in found["devices"]], ["Good"])
        broken, = found["broken_drivers"]
        self.assertEqual(broken["file"], self.path("vendors/crash.icd"))
        self.assertEqual(broken["library"], os.path.join(LIBRARIES, "libcrash_icd.so"))
        self.assertRegex(broken["failure"], "^crashed: ")
        result = self.succeed("devices")
        self.assertIn(b"Good", result.stdout)
        self.assertRegex(result.errors, r"warning: the OpenCL driver .*crash\.icd .* left out, as it crashed: ")

    def test_a_driver_that_hangs(self):
        self.install("hang", "fake")
        broken, = self.devices("--timeout", "2")["broken_drivers"]
        self.assertEqual(broken["file"], self.path("vendors/hang.icd"))
        self.assertEqual(broken["failure"], "hung: there was no answer within 2 s")

    def test_one_file_in_place_of_a_folder(self):
        self.install("crash")
        self.fail_with(1, "devices", says=["crash.icd", "crashed: "],
                       environment={"OCL_ICD_VENDORS": self.path("vendors/crash.icd")})
        self.fail_with(1, "devices", says=["libcrash_icd.so", "crashed: "],
                       environment={"OCL_ICD_VENDORS": os.path.join(LIBRARIES, "libcrash_icd.so")})

    def test_none_is_left(self):
        self.install("crash")
        self.fail_with(6, "check", "s.json", says=["no OpenCL device is left", "crash.icd", "crashed: ", "OCL_ICD_VENDORS"])
        self.fail_with(6, "check", "s.json", "--device", "all", says="crash.icd")

    def test_what_is_missing_may_be_the_broken_drivers(self):
        self.install("crash", "fake")
        self.fail_with(6, "check", "s.json", "--device", "Other", says=["no device matches 'Other'", "crash.icd"])
        os.remove(self.path("vendors/crash.icd"))
        self.fail_with(5, "check", "s.json", "--device", "Other", says=["no device matches 'Other'", "Good"])
        self.fail_with(5, "check", "s.json", "--device", "8.2", says="driver 8.1")

    def test_no_driver_at_all(self):
        self.fail_with(5, "check", "s.json", says="no OpenCL platform")
        self.fail_with(5, "check", "--bits", says="no OpenCL platform")

    def test_devices_that_hang_and_crash_in_use(self):
        """The others are checked all the same; table, JSON and JUnit file name each with its driver."""
        self.install("fake", "crash")
        self.add_pocl()
        fake = {"FAKE_DEVICES": "hanging=Slow@1.5,crashing=Bad@2.5,old=Old"}
        result = self.run_program("check", "s.json", "--spp", "64", "--margin", "20", "--device", "all", "--timeout", "10",
                                  "--json", "r.json", "--junit", "r.xml", environment=fake)
        self.assertEqual(result.returncode, 6, result.errors)
        report = json.loads(self.read("r.json"))
        found = {r["device"]["name"]: r for r in report["results"]}
        self.assertEqual([found[n]["verdict"] for n in ("Slow", "Bad", "Old")], ["failed"] * 3)
        self.assertIn("hung while building the kernel", found["Slow"]["reason"])
        self.assertIn("crashed: ", found["Bad"]["reason"])
        self.assertIn("OpenCL 1.1", found["Old"]["reason"])
        self.assertEqual(found["Slow"]["device"]["driver"], "1.5")
        good = [r for name, r in found.items() if name not in ("Slow", "Bad", "Old")]
        self.assertTrue(good and all(r["agree"] for r in good), report)
        self.assertEqual(report["verdict"], "failed")
        self.assertEqual(report["broken_drivers"][0]["file"], self.path("vendors/crash.icd"))
        for text in ("Slow (Fake One, driver 1.5)", "Bad (Fake One, driver 2.5)", "hung while building", "agree"):
            self.assertIn(text, result.stdout.decode())
        suites = {suite.get("name"): suite for suite in xml.fromstring(self.read("r.xml"))}
        self.assertEqual(len(suites), len(found) + 1)
        slow = suites["Slow (Fake One, driver 1.5)"]
        self.assertEqual((slow.get("errors"), slow.get("failures")), ("1", "0"))
        self.assertIn("hung while", slow.find("testcase/error").get("message"))
        self.assertEqual(slow.find("properties/property[@name='driver']").get("value"), "1.5")
        self.assertIn("crashed: ", suites[self.path("vendors/crash.icd")].find("testcase/error").get("message"))

    def test_one_broken_device(self):
        self.install("fake")
        self.environment["FAKE_DEVICES"] = "crashing=Bad@2.5,old=Old"
        self.fail_with(6, "check", "s.json", "--device", "Bad", says="Bad (Fake One, driver 2.5) crashed: ")
        self.fail_with(6, "check", "s.json", "--device", "2.5", says="Bad (Fake One, driver 2.5) crashed: ")
        self.fail_with(6, "check", "s.json", "--device", "1", says="OpenCL 1.1")
        self.fail_with_output(6, "check", "--bits", "--device", "Bad", "--json", "b.json", says="a device failed")
        results = json.loads(self.read("b.json"))["results"]
        self.assertEqual({r["verdict"] for r in results}, {"failed", "skipped"})
        reasons = [r["reason"] for r in results if r["verdict"] == "failed"]
        self.assertRegex(reasons[0], "^crashed: ")
        self.assertRegex(reasons[1], "^not reached, since the device failed earlier \\(crashed: ")

    def test_a_broken_driver_costs_others_nothing(self):
        """A device that was asked for by name is judged by itself."""
        self.install("crash")
        self.add_pocl()
        words = "check", "s.json", "--spp", "64", "--margin", "20"
        result = self.succeed(*words, "--device", "portable")
        self.assertIn("crash.icd", result.errors)
        self.assertEqual(self.succeed(*words, "--device", "portable", "--quiet").errors, "")
        self.fail_with_output(6, *words, "--device", "all", says="crash.icd could not be checked")

    def fail_with_output(self, code, *arguments, says):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, result.errors)
        self.assertIn(says, result.errors)


if __name__ == "__main__":
    cli.main()
