"""`ballpark check` as a tool of quality assurance: verdicts, evidence, the suite, documents, comparisons, time."""

import json
import os
import re
import shutil
import xml.etree.ElementTree as xml

import cli

SCENES = [name[:-5] for name in sorted(os.listdir(os.path.join(cli.SOURCE, "tests/agree/scenes"))) if name.endswith(".json")]
# Small pictures by one kernel: what agrees is not the matter here.
SMALL_SUITE = ("check", "--suite", "--effects", "all", "--width", "6", "--spp", "128", "--margin", "90")


class Check(cli.ProgramTest):
    WORDS = ("check", "s.json", "--width", "16", "--spp", "64")

    def setUp(self):
        super().setUp()
        self.write("s.json", cli.scene())

    def run_code(self, code, *arguments, says=(), **options):
        result = self.run_program(*arguments, **options)
        self.assertEqual(result.returncode, code, f"{arguments}: {result.errors}")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, result.stdout.decode() + result.errors, arguments)
        return result

    def broken_kernels(self):
        """A sky whose gradient runs the wrong way, as BALLPARK_KERNELS."""
        return cli.broken_kernels(self, "light/sky.cl", "madd3(fma(splat(R(0.5)), height",
                                  "madd3(fma(splat(R(-0.5)), height")

    def report(self, name="r.json"):
        return json.loads(self.read(name))


class Verdicts(Check):
    def test_nothing_passes_without_evidence(self):
        """No difference is found in either case; only what is shown to be equal agrees."""
        result = self.run_code(4, *self.WORDS, "--margin", "0.001", "--json", "r.json",
                               says=["INCONCLUSIVE", "NOT ENOUGH", "s.json: inconclusive: brightness is shown to be equal"])
        entry, = self.report()["results"]
        self.assertEqual((entry["verdict"], entry["agree"], self.report()["verdict"]), ("inconclusive", False, "inconclusive"))
        self.assertFalse(any(test["rejected"] for test in entry["tests"]))
        within = 100 * entry["brightness"]["shown_within"]
        self.assertGreater(within, 0.001)
        self.assertRegex(result.errors, r"--spp \d+ would probably settle it")
        self.run_code(0, *self.WORDS, "--margin", str(within * 1.01), says="agree (")
        self.run_code(4, *self.WORDS, "--margin", str(within * 0.99), says="INCONCLUSIVE")

    def test_the_samples_that_it_asks_for_settle_it(self):
        result = self.run_code(4, "check", "s.json", "--width", "16", "--spp", "16", "--margin", "0.2")
        needed = re.search(r"--spp (\d+) would", result.errors).group(1)
        self.run_code(0, "check", "s.json", "--width", "16", "--spp", needed, "--margin", "0.2")

    def test_a_black_picture_shows_nothing(self):
        self.write("b.json", cli.scene(background=[0, 0, 0]))
        self.run_code(4, "check", "b.json", "--spp", "64", "--margin", "100", says=["black", "INCONCLUSIVE"])

    def test_the_deepest_paths(self):
        """The reference follows a path of 65,535 segments, of surfaces that let light on, too: its stack is large enough."""
        for opacity in (1, 0.999999):
            self.write("deep.json", cli.scene(materials={"m": {"type": "metal", "albedo": [1, 1, 1], "opacity": opacity}}, background=[0, 0, 0],
                                              spheres=[{"center": [0, 0, 0], "radius": 2, "material": "m"}],
                                              camera={"max_depth": 65535, "lookfrom": [0, 0, 0], "lookat": [0, 0, -1]}))
            self.run_code(4, "check", "deep.json", "--width", "4", "--spp", "2", "--margin", "100", "--json", "deep-r.json", says=["black", "INCONCLUSIVE"])
            entry, = self.report("deep-r.json")["results"]
            self.assertGreater(entry["segments"]["reference"], 60000, opacity)

    def test_disagreement_comes_first(self):
        fault = self.broken_kernels()
        result = self.run_code(3, *self.WORDS, "--margin", "100", "--json", "r.json", environment=fault)
        self.assertRegex(result.errors, r"(?m)^ballpark: .*disagree")
        entry, = self.report()["results"]
        self.assertEqual((entry["verdict"], entry["agree"]), ("disagree", False))
        self.assertRegex(entry["reason"], r"\|z\| is \d")

    def test_drivers_in_every_verdict(self):
        text = self.succeed(*self.WORDS, "--margin", "20", "--json", "r.json", "--junit", "r.xml").stdout.decode()
        device = self.report()["results"][0]["device"]
        listed = json.loads(self.succeed("devices", "--json", "-").stdout)["devices"]
        self.assertIn(device["driver"], [d["driver"] for d in listed])
        title = f"{device['name']} ({device['platform']}, driver {device['driver']})"
        self.assertIn(title, text)
        self.assertEqual(xml.fromstring(self.read("r.xml"))[0].get("name"), title)
        table = self.succeed(*self.WORDS, "--margin", "20", "--device", "all").stdout.decode()
        self.assertIn(title, table)
        if [d["driver"] for d in listed].count(device["driver"]) == 1:
            self.succeed(*self.WORDS, "--margin", "20", "--device", device["driver"])

    def test_missing_device(self):
        self.fail_with(5, *self.WORDS, "--device", "none of them", says="no device matches")
        self.fail_with(1, "render", "s.json", "--device", "none of them", says="no device matches")

    def test_refused(self):
        for words, says in ((["check"], "missing SCENE"), (["check", "s.json", "--suite"], "brings its own scenes"),
                            (["check", "s.json", "--bits"], "brings its own scenes"),
                            (["check", "--suite", "--map", "m.png"], "--map does not go with --suite"),
                            (["check", "--bits", "--suite"], "--suite does not go with --bits"),
                            (["check", "--bits", "--spp", "4"], "--spp does not go with --bits"),
                            (["check", "--bits", "--against", "r.json"], "--against does not go with --bits"),
                            (["check", "s.json", "--margin", "0"], "--margin"), (["check", "s.json", "--timeout", "0"], "--timeout"),
                            (["check", "s.json", "--spp", "1"], "at least 2 samples"),
                            (["check", "s.json", "--junit", "s.json"], "would overwrite its own input"),
                            (["check", "s.json", "--json", "r.xml", "--junit", "r.xml"], "both name r.xml"),
                            (["render", "s.json", "--junit", "r.xml"], "unsupported option --junit")):
            self.fail_with(2, *words, says=says)
        self.fail_with(1, "check", "s.json", "--junit", "no/such.xml", says="no/such.xml")
        self.assertEqual(self.files(), ["s.json"])


class LightSampling(Check):
    """What renders do is checked as well as what the reference does."""
    def setUp(self):
        super().setUp()
        shutil.copy(os.path.join(cli.SOURCE, "tests/agree/scenes/lamp.json"), self.path("lamp.json"))

    def sampling(self):
        report = self.report()
        return [(check["light_sampling"], check["results"][0]["verdict"]) for check in report.get("scenes", [report])]

    def test_which(self):
        words = ("check", "lamp.json", "--width", "16", "--spp", "256", "--margin", "50", "--json", "r.json")
        text = self.succeed(*words).stdout.decode()
        self.assertEqual(self.sampling(), [("off", "agree"), ("on", "agree")])
        self.assertEqual(self.report()["light_sampling"], "off")
        self.assertRegex(text, r"(?m)^lamp\.json on ")
        self.assertRegex(text, r"(?m)^lamp\.json \(lights sampled\) on ")
        self.succeed(*words, "--junit", "r.xml")
        self.assertEqual([case.get("name") for case in xml.fromstring(self.read("r.xml")).iter("testcase")],
                         ["lamp.json", "lamp.json (lights sampled)"])
        self.succeed(*words[:-1], "again.json", "--against", "r.json")
        self.assertEqual(self.report("again.json")["against"]["changes"], [])
        for choice in ("on", "off"):
            self.succeed(*words, "--light-sampling", choice)
            self.assertEqual(self.sampling(), [(choice, "agree")])

    def test_a_wrong_sampling(self):
        """A fault of light sampling alone is found, and the verdicts say where."""
        fault = cli.broken_kernels(self, "integrator/lamps_direct.cl", "divide(splat(2), splat(PI_INVERSE)) * cap", "divide(splat(2.2), splat(PI_INVERSE)) * cap")
        self.run_code(3, "check", "lamp.json", "--width", "32", "--spp", "1024", "--margin", "50", "--json", "r.json", environment=fault,
                      says="disagree in 1 of 2 checks")
        self.assertEqual(self.sampling(), [("off", "agree"), ("on", "disagree")])


class RareLight(Check):
    """Light that the reference hardly finds: too little is known, but nothing disagrees. The lamp is so small that a scattered path
    meets it once in a million."""
    def test_small_lamp(self):
        scene = os.path.join(cli.SOURCE, "tests/unseen/scenes/lamp-0.03.json")
        self.run_code(4, "check", scene, "--width", "32", "--spp", "256", "--json", "r.json", says="inconclusive")
        self.assertEqual([check["results"][0]["verdict"] for check in self.report()["scenes"]], ["inconclusive"] * 3)


class CausticSampling(Check):
    """Where rays can be sent to lamps by way of spheres, that is checked too."""
    def setUp(self):
        super().setUp()
        shutil.copy(os.path.join(cli.SOURCE, "tests/agree/scenes/caustics-mirror.json"), self.path("mirror.json"))

    WORDS = ("check", "mirror.json", "--effects", "all", "--width", "16", "--spp", "256", "--margin", "50", "--json", "r.json")

    def sampling(self, name="r.json"):
        report = self.report(name)
        return [(check["light_sampling"], check["caustics"], check["results"][0]["verdict"]) for check in report.get("scenes", [report])]

    def test_which(self):
        text = self.succeed(*self.WORDS, "--junit", "r.xml").stdout.decode()
        self.assertEqual(self.sampling(), [("off", "off", "agree"), ("on", "off", "agree"), ("on", "on", "agree")])
        names = ["mirror.json", "mirror.json (lights sampled)", "mirror.json (caustics sampled)"]
        for name in names:
            self.assertRegex(text, rf"(?m)^{re.escape(name)} on ")
        self.assertEqual([case.get("name") for case in xml.fromstring(self.read("r.xml")).iter("testcase")], names)
        checks = self.report()["scenes"]
        self.assertEqual([check["results"][0]["settings"]["caustics"] for check in checks], ["off", "off", "on"])
        self.assertEqual(len({check["seed"] for check in checks}), 3)
        levels = [check["results"][0]["level"] for check in checks]
        self.assertAlmostEqual(sum(levels), 1e-4)
        self.succeed(*self.WORDS[:-1], "again.json", "--against", "r.json")
        self.assertEqual(self.report("again.json")["against"]["changes"], [])
        # A document from before there was the third check.
        old = self.report()
        del old["scenes"][2]
        for check in (old, *old["scenes"]):
            check.pop("caustics", None)
        self.write("old.json", old)
        self.succeed(*self.WORDS[:-1], "again.json", "--against", "old.json")
        self.assertEqual([(c["kind"], c["scene"]) for c in self.report("again.json")["against"]["changes"]],
                         [("new", "mirror.json (caustics sampled)")])

    def test_what_is_asked_for(self):
        """As light sampling: what the command line says is checked, and nothing else."""
        for words, found in ((["--caustics", "off"], [("off", "off"), ("on", "off")]), (["--caustics", "on"], [("off", "off"), ("on", "on")]),
                             (["--light-sampling", "on"], [("on", "off")]), (["--light-sampling", "on", "--caustics", "on"], [("on", "on")]),
                             (["--set", "materials.brass.fuzz=1"], [("off", "off"), ("on", "off")])):
            self.succeed(*self.WORDS, *words)
            self.assertEqual(self.sampling(), [(*one, "agree") for one in found])

    def test_a_wrong_chain(self):
        """A fault of these rays alone is found, and the verdicts say where."""
        fault = cli.broken_kernels(self, "integrator/chain_trace.cl", "scale3(share, radiance)", "scale3(splat(2) * share, radiance)")
        self.run_code(3, *self.WORDS[:4], "--width", "32", "--spp", "1024", "--margin", "50", "--json", "r.json", environment=fault,
                      says="disagree in 1 of 3 checks")
        self.assertEqual([verdict for *_, verdict in self.sampling()], ["agree", "agree", "disagree"])


class Suite(Check):
    @cli.deep
    def test_suite(self):
        """All agreement scenes, from anywhere, with a table, a document and a JUnit file that say the same."""
        os.mkdir(self.path("tmp"))
        result = self.succeed(*SMALL_SUITE, "--json", "r.json", "--junit", "r.xml", environment={"TMPDIR": self.path("tmp")})
        self.assertEqual(os.listdir(self.path("tmp")), [])
        report = self.report()
        checks = report["scenes"]
        self.assertEqual(list(dict.fromkeys(check["scene"] for check in checks)), SCENES)
        sampled = [check["scene"] for check in checks if (check["light_sampling"], check["caustics"]) == ("on", "off")]
        self.assertEqual([check["scene"] for check in checks if check["light_sampling"] == "off"], SCENES)
        led = [check["scene"] for check in checks if check["caustics"] == "on"]
        self.assertEqual(led, [f"caustics-{name}" for name in ("glass", "inside", "mirror", "pair", "rough", "sun", "veil")] + ["crowd", "discs"])
        self.assertLessEqual({"lamp", "discs", "environment-sun", "media-lamp", "motion-lamp", "shadow-catcher"}, set(sampled))
        self.assertNotIn("lobe-lambertian", sampled)
        self.assertEqual(len(sampled), len(set(sampled)))
        names = [check["scene"] + (" (caustics sampled)" if check["caustics"] == "on" else " (lights sampled)" if check["light_sampling"] == "on" else "")
                 for check in checks]
        for check in checks:
            self.assertEqual(check["results"][0]["settings"]["caustics"], check["caustics"])
            self.assertEqual(check["results"][0]["settings"]["light_sampling"], check["light_sampling"])
        self.assertEqual((report["suite"], report["verdict"]), ("agreement", "agree"))
        self.assertEqual(len({check["seed"] for check in checks}), len(checks))
        levels = [scene["results"][0]["level"] for scene in report["scenes"]]
        self.assertAlmostEqual(sum(levels), report["level"])
        suite = xml.fromstring(self.read("r.xml"))[0]
        self.assertEqual((suite.get("tests"), suite.get("failures"), suite.get("errors")), (str(len(checks)), "0", "0"))
        self.assertEqual([case.get("name") for case in suite.iter("testcase")], names)
        text = result.stdout.decode()
        for name in names:
            self.assertRegex(text, rf"(?m)^  agree .* {re.escape(name)}$")
        self.assertIn(f"{len(names)} checks: {len(names)} agree, 0 disagree, 0 inconclusive, 0 failed", text)
        by_hand = self.report_of("lobe-lambertian", report)
        self.succeed("check", os.path.join(cli.SOURCE, "tests/agree/scenes/lobe-lambertian.json"), *SMALL_SUITE[2:],
                     "--seed", str(by_hand["seed"]), "--json", "one.json")
        one = self.report("one.json")["results"][0]
        self.assertEqual(one["mean_kernel"], by_hand["results"][0]["mean_kernel"])

    def report_of(self, name, report):
        return next(scene for scene in report["scenes"] if scene["scene"] == name)

    @cli.deep
    def test_a_wrong_kernel(self):
        """What disagrees and what is inconclusive fails; quiet shows these alone."""
        fault = self.broken_kernels()
        words = ("check", "--suite", "--effects", "all", "--width", "6", "--spp", "64", "--margin", "0.001", "--quiet")
        result = self.run_code(3, *words, "--junit", "r.xml", environment=fault, says="disagree in")
        suite = xml.fromstring(self.read("r.xml"))[0]
        kinds = [failure.get("type") for failure in suite.iter("failure")]
        self.assertEqual(len(kinds), int(suite.get("failures")))
        self.assertEqual(set(kinds), {"disagree", "inconclusive"})
        text = result.stdout.decode()
        self.assertEqual(text.count("DISAGREE"), kinds.count("disagree"))
        self.assertEqual(text.count("INCONCLUSIVE"), kinds.count("inconclusive"))
        self.assertNotIn("  agree", text)
        self.assertNotIn("checking device", result.errors)

    def test_time(self):
        """A limit that no suite of full size keeps: what there is by then is judged, the rest is inconclusive."""
        self.succeed(*self.WORDS, "--margin", "20", "--effects", "all")  # so that the kernel is in the driver's cache
        self.run_code(4, "check", "--suite", "--effects", "all", "--spp", "1000000", "--timeout", "2", "--json", "r.json",
                      "--junit", "r.xml", says="inconclusive")
        results = [scene["results"][0] for scene in self.report()["scenes"]]
        self.assertGreater(len(results), len(SCENES))
        self.assertEqual([r for r in results if r["verdict"] in ("disagree", "failed")], [])
        cut = [r for r in results if r.get("timed_out")]
        for result in cut:
            self.assertLess(result["samples_per_pixel"], 1000000)
        for result in results:
            if result["verdict"] == "inconclusive":
                self.assertIn("time was up", result["reason"])
        self.assertGreater(sum(r["verdict"] == "inconclusive" for r in results), 0)

    def test_partial_results_of_one_scene(self):
        """However fast the machine: some limit gives a verdict by fewer samples than were asked for."""
        for seconds in (1, 2, 4, 8, 16, 32, 64):
            result = self.run_program("check", "s.json", "--spp", "60000000", "--width", "4", "--margin", "50", "--timeout",
                                      str(seconds), "--json", "r.json")
            entry, = self.report()["results"]
            if entry.get("timed_out"):
                break
            self.assertEqual(result.returncode, 4, result.errors)
        self.assertEqual(result.returncode, 0, result.errors)
        self.assertIn(b"when time was up", result.stdout)
        self.assertLess(entry["samples_per_pixel"], 60000000)
        self.assertEqual(entry["verdict"], "agree")


class Against(Check):
    AGREE = ("--margin", "20")

    def test_nothing_changed(self):
        self.succeed(*self.WORDS, *self.AGREE, "--json", "old.json")
        result = self.succeed(*self.WORDS, *self.AGREE, "--against", "old.json", "--json", "r.json")
        self.assertIn(b"nothing has changed", result.stdout)
        self.assertEqual(self.report()["against"], {"file": "old.json", "ballpark": self.report()["ballpark"],
                                                     "regressions": 0, "changes": []})

    def kinds(self, name="r.json"):
        return [(c["kind"], c["was"], c["now"]) for c in self.report(name)["against"]["changes"]]

    def test_regression_and_recovery(self):
        self.succeed(*self.WORDS, *self.AGREE, "--json", "good.json")
        fault = self.broken_kernels()
        result = self.run_code(3, *self.WORDS, *self.AGREE, "--against", "good.json", "--json", "bad.json", environment=fault)
        self.assertEqual(self.kinds("bad.json"), [("regression", "agree", "disagree")])
        self.assertEqual(self.report("bad.json")["against"]["regressions"], 1)
        self.assertIn("REGRESSION", result.stdout.decode())
        self.assertIn("1 regression\n", result.stdout.decode())
        self.succeed(*self.WORDS, *self.AGREE, "--against", "bad.json", "--json", "r.json")
        self.assertEqual(self.kinds(), [("recovered", "disagree", "agree")])
        self.run_code(4, *self.WORDS, "--margin", "0.001", "--against", "good.json", "--json", "r.json")
        self.assertEqual(self.kinds(), [("regression", "agree", "inconclusive")])
        self.run_code(4, *self.WORDS, "--margin", "0.001", "--against", "bad.json", "--json", "r.json")
        self.assertEqual(self.kinds(), [("verdict", "disagree", "inconclusive")])

    def edited(self, edit):
        """The document of a check, changed as if it were an earlier one."""
        self.succeed(*self.WORDS, *self.AGREE, "--json", "old.json")
        document = self.report("old.json")
        edit(document)
        self.write("old.json", document)

    def test_another_driver(self):
        self.edited(lambda d: d["results"][0]["device"].update(driver="0.9"))
        result = self.succeed(*self.WORDS, *self.AGREE, "--against", "old.json", "--json", "r.json")
        driver = self.report()["results"][0]["device"]["driver"]
        self.assertEqual(self.kinds(), [("driver", "0.9", driver)])
        self.assertIn(f"0.9 -> {driver}", result.stdout.decode())

    def test_a_device_that_is_gone(self):
        def add(document):
            entry = json.loads(json.dumps(document["results"][0]))
            entry["device"].update(name="Old Card", driver="1.0")
            document["results"].append(entry)
        self.edited(add)
        self.succeed(*self.WORDS, *self.AGREE, "--against", "old.json")  # that device was not asked for
        self.run_code(5, *self.WORDS, *self.AGREE, "--against", "old.json", "--device", "all", "--json", "r.json",
                      says="1 device of the earlier check is not there")
        self.assertEqual(self.kinds(), [("gone", "agree", "")])
        self.assertEqual(self.report()["against"]["regressions"], 1)

    def test_what_is_new_and_other_settings(self):
        self.edited(lambda d: d["results"][0]["device"].update(name="Other"))
        self.succeed(*self.WORDS, *self.AGREE, "--against", "old.json", "--json", "r.json")
        self.assertEqual(self.kinds(), [("new", "", "agree")])
        self.succeed(*self.WORDS, *self.AGREE, "--json", "old.json")
        self.succeed("check", "s.json", "--width", "16", "--spp", "128", *self.AGREE, "--seed", "3", "--against", "old.json",
                     "--json", "r.json")
        self.assertEqual(self.kinds(), [("settings", "samples_per_pixel 64", "samples_per_pixel 128"),
                                        ("settings", "seed 0", "seed 3")])
        self.edited(lambda d: d.update(triangles=12, capsules=3))
        self.succeed(*self.WORDS, *self.AGREE, "--against", "old.json", "--json", "r.json")
        self.assertEqual(self.kinds(), [("settings", "triangles 12", "triangles 0"), ("settings", "capsules 3", "capsules 0")])

    @cli.deep
    def test_a_suite(self):
        self.succeed(*SMALL_SUITE, "--json", "old.json")
        document = self.report("old.json")
        document["scenes"][3]["results"][0].update(verdict="failed", agree=False)
        # Of two checks of a scene, the one with light sampling.
        document["scenes"].remove(next(c for c in document["scenes"] if (c["scene"], c["light_sampling"]) == ("checker-light", "on")))
        self.write("old.json", document)
        self.succeed(*SMALL_SUITE, "--against", "old.json", "--json", "r.json")
        changes = self.report()["against"]["changes"]
        self.assertEqual([(c["kind"], c["scene"]) for c in changes], [("recovered", SCENES[3]), ("new", "checker-light (lights sampled)")])

    def test_bad_files(self):
        self.fail_with(1, *self.WORDS, "--against", "none.json", says="none.json")
        self.write("bad.json", "{")
        self.fail_with(2, *self.WORDS, "--against", "bad.json", says="bad.json:1")
        for document in ({}, [], {"results": []}, {"scenes": [3]}, cli.scene()):
            self.write("bad.json", document)
            self.fail_with(2, *self.WORDS, "--against", "bad.json", says="expected the JSON document of an earlier")
        self.write("old.json", {"scene": "s.json", "results": [{"agree": True}, 7, {"device": 3}]})
        self.succeed(*self.WORDS, *self.AGREE, "--against", "old.json")
        self.fail_with(2, *self.WORDS, "--against", "old.json", "--json", "old.json", says="would overwrite")


class Junit(Check):
    def test_hostile_names(self):
        name = 'a<b>&"c\x1b\n\xff.json'
        self.write(name, cli.scene())
        self.succeed("check", name, "--width", "8", "--spp", "64", "--margin", "50", "--junit", "r.xml")
        case = next(xml.fromstring(self.read("r.xml")).iter("testcase"))
        self.assertEqual(case.get("name"), 'a<b>&"c?\n\xff.json')

    def test_standard_output(self):
        result = self.succeed(*self.WORDS, "--margin", "20", "--junit", "-")
        self.assertEqual(xml.fromstring(result.stdout).tag, "testsuites")


if __name__ == "__main__":
    cli.main()
