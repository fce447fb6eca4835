"""`ballpark check --bits`: a device's pictures are the recorded ones, bit for bit; and what is said if they are not.

If the first test fails after a change that was meant to change pictures (kernels, sampling, summation, agreement
scenes), record them anew: scripts/record-bits. If no picture was to change, the change is wrong.
"""

import json
import os
import struct
import xml.etree.ElementTree as xml

import cli
from drivers import icd
from lamps_sampled import with_lamps

with open(os.path.join(cli.SOURCE, "host/check/bits.json")) as file:
    RECORDED = json.load(file)["pictures"]
NOT_OPTIMISED = "-cl-opt-disable -DSHORT_CHAINS"


def one(scene="glass-exact", precision="single", refinement="double"):
    wanted = scene, precision, refinement
    return dict(next(p for p in RECORDED if (p["scene"], p["precision"], p["refinement"]) == wanted))


def changed(radiance, pixels, by):
    """The recorded radiance with the floats of some pixels changed by the function `by`."""
    floats = list(struct.unpack(f">{len(radiance) // 8}f", bytes.fromhex(radiance)))
    for pixel in pixels:
        for channel in range(3):
            floats[3 * pixel + channel] = by(floats[3 * pixel + channel])
    return struct.pack(f">{len(floats)}f", *floats).hex()


class Bits(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        listed = self.run_program("devices", environment={"OCL_ICD_VENDORS": icd("pocl.icd")})
        if b"Portable Computing Language" not in listed.stdout:
            self.skipTest("PoCL is not installed as pocl.icd")
        self.environment["OCL_ICD_VENDORS"] = icd("pocl.icd")

    def check(self, code, pictures, *options, says=(), **environment):
        """Runs against these pictures in place of the recorded ones; returns the result, and the document's results. PoCL
        optimises only packets, since no processor is given the other forms."""
        self.write("bits.json", {"pictures": pictures})
        if "packet" not in options:
            environment = {"POCL_EXTRA_BUILD_FLAGS": NOT_OPTIMISED, **environment}
        result = self.run_program("check", "--bits", "--json", "r.json", "--junit", "r.xml", *options,
                                  environment={"BALLPARK_BITS": self.path("bits.json"), **environment})
        self.assertEqual(result.returncode, code, result.stdout.decode() + result.errors)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, result.stdout.decode() + result.errors)
        return result, json.loads(self.read("r.json"))["results"] if os.path.exists(self.path("r.json")) else None

    def test_the_recorded_pictures(self):
        """By the form that CPUs use; scenes whose lamps are sampled have kernels of their own, and are left to
        test_the_recorded_pictures_by_all_forms."""
        lamps = with_lamps(cli.PROGRAM, cli.SOURCE, sorted({p["scene"] for p in RECORDED}))
        pictures = [p for p in RECORDED
                    if (p["precision"], p["refinement"]) == ("single", "double") and p["scene"] not in lamps]
        self.assertEqual(len(pictures), len(RECORDED) // 3 - len(lamps))
        result, results = self.check(0, pictures, "--kernel", "packet")
        compared = [r for r in results if r["verdict"] == "agree"]
        self.assertEqual({r["scene"] for r in compared}, {p["scene"] for p in pictures})
        forms = {(r["kernel"], r["acceleration"], r["precision"], r["refinement"]) for r in compared}
        self.assertEqual(forms, {("packet", a, "single", "double") for a in ("tree", "list")})
        self.assertEqual(len(compared), 2 * len(pictures))
        self.assertIn(f"{len(compared)} the same, 0 different, 0 not compared, 0 failed", result.stdout.decode())

    @cli.deep
    def test_the_recorded_pictures_by_all_forms(self):
        """Scenes whose lamps are sampled not one path at a time in single precision: test_lamp_same and test_pretended_gpu show
        that this form draws them alike."""
        lamps = with_lamps(cli.PROGRAM, cli.SOURCE, sorted({p["scene"] for p in RECORDED}))
        with_rays = [p for p in RECORDED if p["scene"] in lamps]
        compared = []
        for pictures, *options in ((RECORDED, "--kernel", "packet"),
                                   ([p for p in RECORDED if p["scene"] not in lamps], "--kernel", "sample"),
                                   (with_rays, "--kernel", "sample", "--precision", "double")):
            _, results = self.check(0, pictures, *options)
            compared += [r for r in results if r["verdict"] == "agree"]
        forms = {(r["kernel"], r["acceleration"], r["precision"], r["refinement"]) for r in compared}
        self.assertEqual(len(forms), 12)
        self.assertEqual({r["scene"] for r in compared}, {p["scene"] for p in RECORDED})
        self.assertEqual(len(compared), 4 * len(RECORDED) - 4 * len(lamps))

    @cli.deep
    def test_the_recorded_pictures_by_the_pool(self):
        """Processors get this form only where somebody asks for it."""
        result = self.run_program("check", "--bits", "--kernel", "pool", "--json", "r.json",
                                  environment={"POCL_EXTRA_BUILD_FLAGS": NOT_OPTIMISED})
        self.assertEqual(result.returncode, 0, result.stdout.decode() + result.errors)
        results = json.loads(self.read("r.json"))["results"]
        self.assertEqual({(r["kernel"], r["verdict"]) for r in results}, {("pool", "agree")})
        self.assertEqual(len(results), 2 * len(RECORDED))

    def test_another_hash(self):
        """Sums that differ by less than a float shows."""
        picture = one()
        picture["hash"] = "0" * 16
        result, results = self.check(3, [picture], "--kernel", "sample", says=[
            "DIFFERENT: glass-exact, sample, tree, single: the sums differ by less than the last digit of a pixel",
            "scripts/record-bits", "ballpark check --suite", "2 pictures differ from the recorded ones"])
        self.assertEqual([r["difference"]["different"] for r in results], [0, 0])
        self.assertEqual({r["recorded_hash"] for r in results}, {"0" * 16})
        self.assertEqual({r["hash"] for r in results}, {one()["hash"]})
        suite, = xml.fromstring(self.read("r.xml"))
        self.assertEqual((suite.get("tests"), suite.get("failures")), ("2", "2"))

    def test_caustics(self):
        """Those that are recorded with rays to lamps by way of spheres are drawn so."""
        picture = one("caustics-glass")
        _, results = self.check(0, [picture], "--kernel", "sample")
        self.assertEqual([r["caustics"] for r in results], ["on", "on"])
        del picture["caustics"]
        _, results = self.check(3, [picture], "--kernel", "sample", says="DIFFERENT: caustics-glass, sample, tree, single: ")
        picture.update(caustics="on", hash="0" * 16)
        self.check(3, [picture], "--kernel", "sample", says="DIFFERENT: caustics-glass (caustics sampled), sample, tree, single: ")

    def test_by_how_much_it_differs(self):
        size = len(one()["radiance"]) // 24
        for pixels, by, kind, says in (
                ([5], lambda x: x * (1 + 2**-22), "rounding", f"1 of {size} pixels differ"),
                ([5, 9], lambda x: x * 1.5 + 0.1, "paths", f"2 of {size} pixels differ"),
                (range(size), lambda x: x * 1.5 + 0.1, "picture", f"{size} of {size} pixels differ")):
            picture = one()
            picture.update(hash="0" * 16, radiance=changed(picture["radiance"], pixels, by))
            _, results = self.check(3, [picture], "--kernel", "sample", says=says)
            self.assertEqual(results[0]["difference"]["kind"], kind)
            self.assertEqual(results[0]["difference"]["different"], len(pixels))
        self.assertAlmostEqual(results[0]["difference"]["largest"], 0.4, delta=0.3)

    def test_a_wrong_kernel(self):
        fault = cli.broken_kernels(self, "light/sky.cl", "madd3(fma(splat(R(0.5)), height",
                                   "madd3(fma(splat(R(-0.5)), height")
        _, results = self.check(3, [one()], "--kernel", "sample", says="another picture", **fault)
        self.assertEqual({r["difference"]["kind"] for r in results if r["verdict"] != "skipped"}, {"picture"})

    def test_parts(self):
        pictures = [one(), one(precision="double")]
        _, results = self.check(0, pictures, "--kernel", "sample", "--precision", "single")
        self.assertEqual([(r["kernel"], r["acceleration"], r["precision"]) for r in results],
                         [("sample", "tree", "single"), ("sample", "list", "single")])
        self.check(4, pictures[:1], "--precision", "double", says="0 pictures were compared")  # nothing passes then

    def test_time(self):
        _, results = self.check(4, [one()], "--kernel", "sample", "--timeout", "0.000001", says="time was up")
        self.assertEqual({r["verdict"] for r in results[1:]}, {"inconclusive"})  # the first may just begin in time

    def test_bad_files(self):
        short, strange = one(), one()
        short.update(hash="0" * 16, radiance=short["radiance"][:-8])
        strange.update(hash="0" * 16, radiance="x" + strange["radiance"][1:])
        other = dict(one(), scene="none")
        for pictures, says in (([], "no recorded pictures"), ([{"scene": "tie"}], "no recorded pictures"),
                               ([short], "recorded radiance"), ([strange], "recorded radiance"),
                               ([other], "none of the agreement scenes")):
            self.check(1, pictures, "--kernel", "sample", "--precision", "single", says=[says, "record"])
        self.fail_with(1, "check", "--bits", environment={"BALLPARK_BITS": self.path("gone")}, says="gone")


if __name__ == "__main__":
    cli.main()
