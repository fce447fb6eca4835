"""The documents of `check` say how it ended, whatever happened: nobody takes those of an earlier check for today's."""

import json
import os
import signal
import subprocess
import time
import xml.etree.ElementTree as xml

import cli

LIBRARIES = os.path.join(os.path.dirname(cli.PROGRAM), "tests")
OLD = {"x.xml": '<?xml version="1.0"?>\n<testsuites><!-- of yesterday --></testsuites>\n', "x.json": '{"of": "yesterday"}\n'}


class Documents(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("vendors"))
        self.environment.update(OCL_ICD_VENDORS=self.path("vendors"), FAKE_DEVICES="cpu=Fine", BALLPARK_DRIVER_SECONDS="1")
        self.write("s.json", cli.scene(width=4))
        for name, text in OLD.items():
            self.write(name, text)

    def install(self, kind):
        self.write(f"vendors/{kind}.icd", os.path.join(LIBRARIES, f"lib{kind}_icd.so") + "\n")

    def documents(self):
        """The cases of the XML file, whose counts must be right, and the JSON document."""
        cases = []
        for suite in xml.fromstring(self.read("x.xml")):
            found = suite.findall("testcase")
            self.assertEqual([suite.get(k) for k in ("tests", "failures", "errors")],
                             [str(len(found)), *(str(len(suite.findall(f"testcase/{k}"))) for k in ("failure", "error"))])
            cases += found
        return cases, json.loads(self.read("x.json"))

    def assert_failed(self, code, *words, kind, says, name="s.json", file=None):
        """`check` ends with the code, and both documents say the same as the message."""
        self.fail_with(code, "check", *words, "--junit", "x.xml", "--json", "x.json", says=says)
        cases, document = self.documents()
        case = cases[-1]
        self.assertEqual((case.get("name"), case.find("error").get("type")), (name, kind))
        self.assertIn(says, case.find("error").get("message"))
        self.assertEqual((document["verdict"], document["error"]["kind"]), ("failed", kind))
        self.assertIn(says, document["error"]["message"])
        self.assertEqual(document["error"]["file"], file or "")
        self.assertEqual(document.get("scenes", document.get("results")), [])
        self.assertEqual(document["suite" if words[0].startswith("--") else "scene"], name)
        return cases, document

    def test_no_driver(self):
        self.assert_failed(5, "s.json", kind="no such device", says="no OpenCL platform")
        self.assert_failed(5, "--suite", kind="no such device", says="no OpenCL platform", name="agreement")
        self.assert_failed(5, "--bits", kind="no such device", says="no OpenCL platform", name="bits")

    def test_a_device_that_is_not_there(self):
        self.install("fake")
        self.assert_failed(5, "s.json", "--device", "nvidia", kind="no such device", says="no device matches 'nvidia'")

    def test_broken_drivers(self):
        self.install("crash")
        cases, document = self.assert_failed(6, "s.json", kind="a device or its driver is broken", says="no OpenCL device is left")
        self.assertEqual([case.get("name") for case in cases], ["list devices", "s.json"])
        self.assertEqual(document["broken_drivers"][0]["failure"], "crashed: Aborted")
        os.remove(self.path("vendors/crash.icd"))
        self.install("hang")
        _, document = self.assert_failed(6, "s.json", kind="a device or its driver is broken", says="no OpenCL device is left")
        self.assertEqual(document["broken_drivers"][0]["failure"], "hung: there was no answer within 1 s")

    def test_devices_that_break_in_use(self):
        """These have entries of their own."""
        self.install("fake")
        for device in ("crashing", "hanging"):
            self.environment["FAKE_DEVICES"] = f"{device}=Bad"
            self.fail_with(6, "check", "s.json", "--device", "0", "--junit", "x.xml", "--json", "x.json")
            (case,), document = self.documents()
            self.assertEqual(case.get("name"), "s.json")
            self.assertEqual(case.find("error").get("type"), "failed")
            self.assertEqual(document["verdict"], "failed")
            self.assertEqual(document["results"][0]["device"]["name"], "Bad")
        self.environment["FAKE_DEVICES"] = "old=Old"
        self.assert_failed(6, "s.json", "--device", "0", kind="a device or its driver is broken", says="OpenCL 1.1")

    def test_scenes(self):
        self.write("bad.json", '{"camera": {"image_width": 4},\n "spheres": 7}')
        self.assert_failed(2, "bad.json", kind="bad scene", says="spheres", name="bad.json", file="bad.json")
        self.assertIn("bad.json:2:", self.documents()[0][0].find("error").get("message"))
        self.write("none.json", "{")
        self.assert_failed(2, "none.json", kind="bad scene", says="the { of line 1 is not closed", name="none.json", file="none.json")
        self.assert_failed(2, "nowhere.json", kind="bad scene", says="No such file", name="nowhere.json", file="nowhere.json")
        os.rename(self.path("none.json"), os.fsencode(self.path("")) + b"\xff<&>.json")
        result = self.run_program("check", os.fsdecode(b"\xff<&>.json"), "--junit", "x.xml", "--json", "x.json")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(self.documents()[0][0].get("name"), "\ufffd<&>.json")

    def test_what_a_scene_that_cannot_be_read_may_name_is_left_alone(self):
        self.write("cloud.xml", "ply\nformat ascii 1.0\n")
        self.write("bad.json", '{"points": "cloud.xml", "spheres": 7}')
        result = self.run_program("check", "bad.json", "--junit", "cloud.xml", "--json", "new.json")
        self.assertEqual(result.returncode, 2)
        self.assertIn("cloud.xml is left as it is", result.errors)
        self.assertEqual(self.read("cloud.xml"), b"ply\nformat ascii 1.0\n")
        self.assertEqual(json.loads(self.read("new.json"))["verdict"], "failed")

    def test_what_is_left_alone(self):
        """After an error of the command line nobody knows what is meant; and --no-clobber holds."""
        for words in (["--suite", "s.json"], ["s.json", "--spp", "1"], ["s.json", "--map", "m.gif"]):
            self.fail_with(2, "check", *words, "--junit", "x.xml", "--json", "x.json")
            self.assertEqual([self.read(name).decode() for name in OLD], list(OLD.values()))
        self.fail_with(1, "check", "s.json", "--junit", "x.xml", "--no-clobber", says="x.xml")
        self.assertEqual(self.read("x.xml").decode(), OLD["x.xml"])

    def test_one_that_cannot_be_written(self):
        """The other reports that, and is written unless it must not be."""
        for words, name in ((["s.json"], "s.json"), (["--suite"], "agreement"), (["--bits"], "bits")):
            self.write("x.xml", OLD["x.xml"])
            self.fail_with(1, "check", *words, "--junit", "x.xml", "--json", "none/x.json", says="none/x.json")
            (case,) = xml.fromstring(self.read("x.xml")).findall("testsuite/testcase")
            self.assertEqual((case.get("name"), case.find("error").get("type")), (name, "file error"))
            self.assertIn("none/x.json", case.find("error").get("message"))
            self.write("x.json", OLD["x.json"])
            self.fail_with(1, "check", *words, "--junit", "none/x.xml", "--json", "x.json", says="none/x.xml")
            self.assertIn("none/x.xml", json.loads(self.read("x.json"))["error"]["message"])
        self.fail_with(1, "check", "s.json", "--junit", "none/x.xml", "--json", "none/x.json", says="none/x.json")
        self.write("x.xml", OLD["x.xml"])
        self.fail_with(1, "check", "s.json", "--junit", "x.xml", "--json", "none/x.json", "--no-clobber")
        self.assertEqual(self.read("x.xml").decode(), OLD["x.xml"])

    def test_standard_output(self):
        result = self.run_program("check", "s.json", "--junit", "-")
        self.assertEqual(result.returncode, 5)
        self.assertEqual(len(xml.fromstring(result.stdout).findall("testsuite/testcase/error")), 1)
        result = self.run_program("check", "s.json", "--json", "-")
        self.assertEqual(json.loads(result.stdout)["error"]["kind"], "no such device")

    def interrupt(self, *words):
        with subprocess.Popen([cli.PROGRAM, "check", *words, "--junit", "x.xml", "--json", "x.json"], cwd=self.folder,
                              stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              env=dict(self.environment, BALLPARK_DRIVER_SECONDS="100")) as process:
            time.sleep(1.5)
            begun = time.monotonic()
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(), 130)
            self.assertLess(time.monotonic() - begun, 10)
        return self.documents()

    def test_interrupted(self):
        self.install("hang")
        for words in (["s.json"], ["--suite"], ["--bits"]):
            (case,), document = self.interrupt(*words)
            self.assertEqual((case.find("error").get("type"), document["error"]["kind"]), ("interrupted", "interrupted"))
        os.remove(self.path("vendors/hang.icd"))
        self.install("fake")
        self.environment["FAKE_DEVICES"] = "hanging=Slow"
        (case,), document = self.interrupt("s.json")  # while it is checked
        self.assertIn("interrupted", case.find("failure").get("message"))
        self.assertEqual((document["verdict"], document["results"][0]["verdict"]), ("inconclusive", "inconclusive"))

    def test_memory_that_runs_out(self):
        """As much as there is: either both documents say it, or they are as they were."""
        self.write("many.json", cli.scene(width=4, spheres=3000))
        said = 0
        for megabytes in (24, 28, 32, 40, 48, 64):
            for name, text in OLD.items():
                self.write(name, text)
            result = subprocess.run(["sh", "-c", f'ulimit -v {megabytes * 1024}; exec "$@"', "sh", cli.PROGRAM, "check", "many.json",
                                     "--junit", "x.xml", "--json", "x.json"], cwd=self.folder, env=self.environment,
                                    stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            if result.returncode != 1 or b"memory" not in result.stderr:
                continue
            cases, document = self.documents()
            if cases:
                self.assertEqual(cases[-1].find("error").get("type"), "out of memory")
                self.assertEqual(document["error"]["kind"], "out of memory")
                said += 1
        if said == 0:
            self.skipTest("memory does not run out here in the right place")

    def test_devices(self):
        """The list of devices is written where there are none, too."""
        self.fail_with(1, "devices", "--json", "x.json", says="no OpenCL platform")
        self.assertEqual(json.loads(self.read("x.json")), {"devices": [], "broken_drivers": []})
        self.install("hang")
        self.fail_with(1, "devices", "--json", "x.json")
        self.assertEqual([d["library"] for d in json.loads(self.read("x.json"))["broken_drivers"]],
                         [os.path.join(LIBRARIES, "libhang_icd.so")])

    def test_a_hint_at_the_time(self):
        """Of checks that time did not suffice for."""
        if "OCL_ICD_VENDORS" in os.environ:
            self.environment["OCL_ICD_VENDORS"] = os.environ["OCL_ICD_VENDORS"]
        else:
            del self.environment["OCL_ICD_VENDORS"]
        result = self.run_program("check", "--suite", "--timeout", "0.01")
        if result.returncode == 5:
            self.skipTest("no OpenCL device")
        self.assertRegex(result.errors, r"checks are inconclusive; --timeout was too short")


if __name__ == "__main__":
    cli.main()
