"""`ballpark render`: what each option does to the picture, the statistics, the stop rules."""

import json
import math
import os
import re
import shutil

from cli import ProgramTest, SOURCE, deep, main, scene
from pfm import read_pfm


class Render(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene())

    def pfm(self, *options, name="s.json"):
        return self.succeed("render", name, "-o", "-", "--format", "pfm", "-q", *options).stdout

    def stats(self, *options, name="s.json"):
        return json.loads(self.succeed("render", name, "-o", "x.pfm", "-q", "--stats", "-", *options).stdout)


class Picture(Render):
    def test_options_that_change_the_picture(self):
        whole = self.pfm()
        self.assert_same(whole, self.pfm(), "the same run again")
        for options in (["--seed", "1"], ["--first-sample", "8"], ["--spp", "9"], ["--depth", "1"],
                        ["--width", "17"], ["--precision", "double"], ["--sampler", "independent"]):
            with self.subTest(options):
                self.assert_different(whole, self.pfm(*options), options)
        self.assertEqual(read_pfm(self.pfm("--width", "17"))[:2], (17, 17))
        self.assertEqual(set(read_pfm(self.pfm("--depth", "0"))[2]), {0.0})

    def test_options_that_do_not(self):
        whole = self.pfm()
        for options in (["--seed", "0"], ["--first-sample", "0"], ["--spp", "8"], ["--depth", "10"],
                        ["--kernel", "sample"], ["--kernel", "packet"], ["--kernel", "pool"], ["--effects", "all"], ["--device", "0"],
                        ["--precision", "single"], ["--math", "strict"], ["--sampler", "sobol"],
                        ["--numerics", "robust"], ["--force"], ["--transfer", "srgb"]):
            with self.subTest(options):
                self.assert_same(whole, self.pfm(*options), options)

    def test_fewer_samples_than_lanes(self):
        for width, samples in ((1, 1), (1, 3), (3, 1), (4, 1), (5, 3)):
            with self.subTest(width=width, samples=samples):
                tiny = ["--width", str(width), "--spp", str(samples)]
                self.assert_same(self.pfm(*tiny, "--kernel", "sample"), self.pfm(*tiny, "--kernel", "packet"), tiny)

    @deep
    def test_choices_of_computing(self):
        """Fast mathematics and plain numerics give about the same picture."""
        _, _, right = read_pfm(self.pfm("--spp", "256"))
        for options in (["--math", "fast"], ["--numerics", "plain"], ["--precision", "double"]):
            _, _, values = read_pfm(self.pfm("--spp", "256", *options))
            self.assertAlmostEqual(sum(values) / sum(right), 1.0, delta=0.01, msg=options)

    def test_seeds_of_64_bits(self):
        last = self.pfm("--seed", "18446744073709551615")
        self.assert_same(last, self.pfm("--seed", "0xffffffffffffffff"))
        self.assert_different(last, self.pfm("--seed", "4294967295"))
        self.assertEqual(self.stats("--seed", str(2**63 - 1))["seed"], 2**63 - 1)
        for seed in (2**63, 2**64 - 1):
            self.assertEqual(self.stats("--seed", str(seed))["seed"], str(seed))
            report = json.loads(self.succeed("check", "s.json", "--width", "4", "--spp", "4", "--margin", "50",
                                             "--seed", str(seed), "--json", "-").stdout)
            self.assertEqual(report["seed"], str(seed))

    def test_transfer(self):
        def bytes_of(*options):
            return self.succeed("render", "s.json", "-o", "-", "--format", "ppm", "-q", *options).stdout
        pictures = {transfer: bytes_of("--transfer", transfer) for transfer in ("gamma2", "srgb", "linear")}
        self.assertEqual(len(set(pictures.values())), 3)
        self.assertEqual(bytes_of(), pictures["gamma2"])
        self.write("s.json", scene(transfer="srgb"))
        self.assertEqual(bytes_of(), pictures["srgb"])

    def test_device(self):
        whole = self.pfm()
        listed = json.loads(self.succeed("devices", "--json", "-").stdout)["devices"]
        default = [device for device in listed if device["default"]][0]
        for text in (str(default["number"]), default["name"], default["name"][2:8].upper()):
            self.assert_same(whole, self.pfm("--device", text), text)
        if len(listed) == 1:
            self.assert_same(whole, self.pfm("--device", "all"))
        self.fail_with(1, "render", "s.json", "--device", "99", says="99")
        self.fail_with(1, "render", "s.json", "--device", "no such thing", says=[default["name"]])

    def test_shapes(self):
        for width, height in ((1, 1), (1, 2000), (2000, 1)):
            with self.subTest(f"{width}x{height}"):
                self.write("shape.json", scene(width, height))
                self.assertEqual(read_pfm(self.pfm("--spp", "2", name="shape.json"))[:2], (width, height))

    def test_numbers_of_spheres(self):
        self.write("none.json", {"camera": {"image_width": 8}})
        _, _, values = read_pfm(self.pfm(name="none.json"))
        self.assertTrue(all(0.5 <= value <= 1.0 for value in values), "the sky")
        many = [{"center": [(i % 317 - 158) * 0.02, (i // 317 - 158) * 0.02, -2], "radius": 0.008,
                 "material": "m"} for i in range(100000)]
        self.write("many.json", scene(spheres=many))
        stats = self.stats("--spp", "4", name="many.json")
        self.assertEqual((stats["spheres"], stats["triangles"], stats["capsules"]), (100000, 0, 0))
        self.assertEqual(stats["acceleration"], "tree")
        self.assertGreater(stats["rays"], stats["samples"])

    def test_too_large(self):
        self.fail_with(1, "render", "s.json", "--width", "65535", says=["65535", "use --width 32767 or less"])
        # PoCL is told of 4 GiB: a machine with much more memory would begin to render.
        self.fail_with(1, "render", "s.json", "--width", "32000", says=["scene and picture take", "use --width ", "or less, or another --device"], environment={"POCL_MEMORY_LIMIT": "4"})
        self.assertEqual(self.files(), ["s.json"])

    def test_no_device(self):
        result = self.fail_with(1, "render", "s.json", says="install",
                                environment={"OCL_ICD_VENDORS": self.path("none") + "/"})
        self.assertIn("OpenCL", result.errors)
        self.fail_with(1, "devices", says="install", environment={"OCL_ICD_VENDORS": self.path("none") + "/"})
        self.assertEqual(self.files(), ["s.json"])

    def test_a_kernel_that_does_not_build(self):
        """The whole build log, with the place in the kernel's own file."""
        shutil.copytree(os.path.join(SOURCE, "kernels"), self.path("kernels"))
        with open(self.path("kernels/integrator/bounce.cl"), "a") as file:
            file.write("\nvoid broken(void) { this_is_no_function(); }\n")
        with open(os.path.join(SOURCE, "kernels/integrator/bounce.cl")) as file:
            line = len(file.readlines()) + 2
        result = self.fail_with(1, "render", "s.json", says=[f"integrator/bounce.cl:{line}:", "this_is_no_function"],
                                environment={"BALLPARK_KERNELS": self.path("kernels")})
        self.assertIn("\n\n", result.errors, "the log stands below the message")


    def test_a_kernel_that_cannot_be_read(self):
        """A folder in its place, or a file that would be cut short, is not taken for a shorter kernel."""
        for content, says in ((None, "Is a directory"), (b"\0", "byte of value 0")):
            shutil.rmtree(self.path("kernels"), ignore_errors=True)
            shutil.copytree(os.path.join(SOURCE, "kernels"), self.path("kernels"))
            if content is None:
                os.remove(self.path("kernels/light/sky.cl"))
                os.mkdir(self.path("kernels/light/sky.cl"))
            else:
                with open(self.path("kernels/light/sky.cl"), "ab") as file:
                    file.write(content)
            self.fail_with(1, "render", "s.json", says=["light/sky.cl", says],
                           environment={"BALLPARK_KERNELS": self.path("kernels")})


class Statistics(Render):
    FIXED = {"scene": str, "width": int, "height": int, "samples_per_pixel": int, "max_depth": int, "seed": int,
             "spheres": int, "device": dict, "effects": list, "kernel": str, "sampler": str,
             "precision": str, "math": str, "numerics": str, "light_sampling": str, "caustics": str, "roulette": str, "seconds": dict, "samples": int, "rays": int,
             "mean_radiance": list, "nrmse": float, "invalid_samples": int}

    def test_names_and_types(self):
        stats = self.stats()
        self.assertEqual(list(stats)[:len(self.FIXED)], list(self.FIXED))
        for name, kind in self.FIXED.items():
            self.assertIs(type(stats[name]), kind, name)
        self.assertEqual(set(stats["device"]), {"platform", "name", "driver", "type"})
        self.assertIn(stats["device"]["type"], ("cpu", "gpu", "other"))
        self.assertLessEqual({"total", "load", "tree", "kernel_build", "trace", "write"}, set(stats["seconds"]))
        for name, seconds in stats["seconds"].items():
            self.assertGreaterEqual(seconds, 0.0, name)
            self.assertLessEqual(seconds, stats["seconds"]["total"], name)
        self.assertEqual(len(stats["mean_radiance"]), 3)

    def test_values(self):
        stats = self.stats("--seed", "5", "--depth", "7", "--spp", "6", "--width", "12", "--precision", "double")
        expected = {"scene": "s.json", "width": 12, "height": 12, "samples_per_pixel": 6, "max_depth": 7, "seed": 5,
                    "spheres": 1, "effects": ["lambertian"], "acceleration": "list", "precision": "double", "math": "strict",
                    "sampler": "sobol", "samples": 12 * 12 * 6, "invalid_samples": 0, "stopped_by": "samples",
                    "partial": False, "output": "x.pfm", "first_sample": 0}
        self.assertEqual({name: stats[name] for name in expected}, expected)
        self.assertTrue(stats["samples"] < stats["rays"] <= 7 * stats["samples"])
        width, height, values = read_pfm(self.read("x.pfm"))
        for channel in range(3):
            mean = math.fsum(values[channel::3]) / (width * height)
            self.assertAlmostEqual(stats["mean_radiance"][channel], mean, delta=1e-6)
        self.assertEqual(self.stats("--kernel", "sample")["kernel"], "sample")
        self.assertEqual(self.stats("--kernel", "packet")["kernel"], "packet")
        self.assertEqual(self.stats("--kernel", "pool")["kernel"], "pool")
        self.assertEqual(self.stats("--math", "fast")["math"], "fast")
        with open(os.path.join(SOURCE, "host/packed/effects.h"), encoding="utf-8") as file:
            names = re.findall(r'^    X\(\w+, "(\w+)"', file.read(), re.MULTILINE)
        found = self.stats("--effects", "all")["effects"]
        self.assertEqual(found, [name for name in names if name not in ("light_sampling", "caustics", "triangle_lamps")])

    def test_no_error_known(self):
        self.assertIsNone(self.stats("--spp", "1")["nrmse"], "one replicate")
        self.assertIsNone(self.stats("--depth", "0")["nrmse"], "black")

    def test_cut_paths(self):
        """In a closed white ball without light every path is cut."""
        self.write("ball.json", scene(spheres=[{"center": [0, 0, 0], "radius": 5, "material": "m"}]))
        stats = self.stats("--depth", "4", name="ball.json")
        self.assertEqual(stats["cut_paths"], stats["samples"])
        self.assertEqual(stats["rays"], 4 * stats["samples"])
        said = self.succeed("render", "ball.json", "--depth", "4", "-o", "x.png").errors
        self.assertIn("100 % of the paths were cut off at 4 segments", said)
        self.assertNotIn("medium", said)

    def test_fog_without_end(self):
        """No path gets through it to the sky, and the picture says why it is dark."""
        self.write("fog.json", scene(media={"fog": {"scattering": 1}}, medium="fog"))
        said = self.succeed("render", "fog.json", "-o", "x.png").errors
        self.assertIn('the "medium" of the whole scene has no end', said)
        self.write("clear.json", scene(media={"fog": {"absorption": 1}}, medium="fog"))
        self.assertNotIn("has no end", self.succeed("render", "clear.json", "-o", "x.png").errors)


class StopRules(Render):
    def test_error(self):
        options = ["--error", "0.5", "--sampler", "independent"]  # whose error falls with the root of the count
        stats = self.stats(*options)
        self.assertEqual(stats["stopped_by"], "error")
        self.assertLessEqual(stats["nrmse"], 0.005)
        self.assertGreater(stats["nrmse"], 0.0042, "not many times the samples needed")
        self.assertEqual(stats["samples"], stats["samples_per_pixel"] * 256)
        again = self.stats(*options)
        self.assertEqual(stats["samples_per_pixel"], again["samples_per_pixel"], "the clock has no say")
        whole = self.read("x.pfm")
        self.assert_same(whole, self.pfm("--spp", str(stats["samples_per_pixel"]), *options[2:]),
                         "the same render is the same")

    def test_error_and_samples(self):
        stats = self.stats("--error", "0.001", "--spp", "300")
        self.assertEqual((stats["stopped_by"], stats["samples_per_pixel"]), ("samples", 300))
        said = self.succeed("render", "s.json", "--error", "0.001", "--spp", "300", "-o", "x.png").errors
        self.assertIn("noise is still above --error", said)

    def test_time(self):
        # The first launch, in which a driver may compile, is in the time: on a slow machine it may be all of it.
        for seconds in "0.5", "4", "32":
            stats = self.stats("--time", seconds)
            self.assertEqual(stats["stopped_by"], "time")
            if stats["samples_per_pixel"] > 8:
                break
        self.assertGreater(stats["samples_per_pixel"], 8, "the scene's own count is no limit")
        if not stats["partial"]:
            self.assert_same(self.read("x.pfm"), self.pfm("--spp", str(stats["samples_per_pixel"])))

    def test_black(self):
        self.write("dark.json", scene(background=[0, 0, 0]))
        said = self.succeed("render", "dark.json", "--error", "1", "-o", "x.png").errors
        self.assertIn("the picture is black", said)
        self.assertEqual(self.stats("--error", "1", name="dark.json")["stopped_by"], "black")

    @deep
    def test_inside_a_sphere(self):
        for kind, is_said in ({"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}, True), ({"type": "interface"}, False):
            self.write("in.json", scene(materials={"m": kind}, background=[1, 1, 1] if is_said else [0, 0, 0],
                                        spheres=[{"center": [0, 0, 0], "radius": 1, "material": "m"}]))
            said = self.succeed("render", "in.json", "--spp", "2", "-o", "in.png").errors
            self.assertIn("the picture is black", said)
            self.assertEqual("the camera is inside a sphere" in said, is_said, said)

    def test_constant(self):
        self.write("plain.json", scene(spheres=0, background=[0.5, 0.5, 0.5]))
        stats = self.stats("--error", "1", name="plain.json")
        self.assertEqual((stats["stopped_by"], stats["nrmse"]), ("constant", 0.0))
        said = self.succeed("render", "plain.json", "--error", "1", "-o", "x.png").errors
        self.assertIn("all samples of each pixel are equal", said)

    def broken_sky(self, red):
        """Kernels whose sky has another red; the environment that uses them."""
        shutil.copytree(os.path.join(SOURCE, "kernels"), self.path("kernels"))
        with open(self.path("kernels/light/sky.cl")) as file:
            text = file.read()
        at = text.index("return ", text.index("Vec3 sky_radiance("))
        end = text.index(";", at)
        broken = f"Vec3 light = {text[at + len('return '):end]}; light.x = {red}; return light"
        with open(self.path("kernels/light/sky.cl"), "w") as file:
            file.write(text[:at] + broken + text[end:])
        return {"BALLPARK_KERNELS": self.path("kernels")}

    @deep
    def test_hardly_any_sample_is_light(self):
        """No picture then, and none of those that were there is touched."""
        here = self.broken_sky("splat(NAN)")
        self.write("n.json", scene(16, spheres=0, background=[0.5, 0.6, 0.7]))
        for output in "x.png", "x.exr", "x.bpa":
            self.write(output, "precious")
            self.fail_with(1, "render", "n.json", "-o", output, "--stats", "n.stats", environment=here,
                           says=["2048 of 2048 samples are invalid (2048 not finite)", output, "was not written", "--precision double",
                                 "unit of length"])
            self.assertEqual(self.read(output), b"precious")
        self.assertEqual(self.files(), ["kernels", "n.json", "s.json", "x.bpa", "x.exr", "x.png"])

    @deep
    def test_no_figure_of_samples_that_are_no_light(self):
        """bench would tell the speed of broken paths, cost the errors of pictures of nothing."""
        here = self.broken_sky("splat(NAN)")
        self.write("n.json", scene(16, spheres=0, background=[0.5, 0.6, 0.7]))
        for command in (("bench", "n.json", "--time", "0.01", "--rounds", "1", "--json", "n.out"),
                        ("cost", "n.json", "--time", "0.1", "--json", "n.out"),
                        ("cost", "n.json", "--time", "0.1", "--precision", "double", "--csv", "n.out")):
            self.fail_with(1, *command, environment=here, says=["samples are invalid (", " not finite)", "ballpark check"])
        shutil.rmtree(self.path("kernels"))
        here = self.broken_sky("sizeof(R(1.0)) == 4 ? splat(NAN) : light.x")  # the truth is of double precision, and right
        self.fail_with(1, "cost", "n.json", "--time", "0.1", "--json", "n.out", environment=here, says="samples are invalid")
        self.assertEqual(self.files(), ["kernels", "n.json", "s.json"])

    @deep
    def test_a_pixel_that_is_never_light(self):
        """Samples that are no numbers are left out; where a pixel has no other, --error ends and says so."""
        here = self.broken_sky("choose(direction.x < splat(R(-0.5)), splat(NAN), light.x)")
        self.write("n.json", scene(16, background=[0.5, 0.6, 0.7]))
        for options in (["--error", "0.1"], ["--error", "0.1", "--time", "100"], ["--error", "0.1", "--spp", "100000"]):
            said = self.fail_with(1, "render", "n.json", "--stats", "n.stats", *options, environment=here, says=" lacks ").errors
            self.assertIn("--error cannot be reached", said)
            self.assertIn("estimating noise needs valid samples in every pixel", said)
            self.assertRegex(said, r"warning: (\d+) samples were invalid \(\1 not finite\) and left out of the picture")
            with open(self.path("n.stats")) as file:
                stats = json.load(file)
            self.assertEqual((stats["stopped_by"], stats["nrmse"]), ("invalid", None))
            self.assertGreater(stats["invalid_samples"], 0)

    def test_summary(self):
        said = self.succeed("render", "s.json").errors
        self.assertRegex(said, r"\As\.png: 16x16, 8 samples per pixel, noise [\d.]+ %\n"
                               r"2\.05 thousand samples traced in [\d.]+ m?s \([\d.]+ .*/s\), [\d.]+ m?s in total\n"
                               r"halving the noise: [\d.]+ m?s more\n")

    def test_summary_does_not_contradict_itself(self):
        """The rate is that of the time beside it, which is a part of the whole, on short runs above all."""
        words = {"": 1.0, "thousand": 1e3, "million": 1e6, "billion": 1e9}
        for options in (["--spp", "1"], ["--spp", "2", "--width", "1"], ["--spp", "3000"]):
            said = self.succeed("render", "s.json", *options).errors
            number, word, time, unit, rate, rate_word, whole, whole_unit = re.search(
                r"([\d.]+) ?(\w*) samples traced in ([\d.]+) (m?s) \(([\d.]+) ?(\w*)/s\), ([\d.]+) (m?s) in total",
                said).groups()
            seconds = float(time) / (1e3 if unit == "ms" else 1)
            total = float(whole) / (1e3 if whole_unit == "ms" else 1)
            samples = float(number) * words[word]
            self.assertLess(abs(samples / seconds / (float(rate) * words[rate_word]) - 1), 0.1, said)
            self.assertLessEqual(seconds, total, said)


if __name__ == "__main__":
    main()
