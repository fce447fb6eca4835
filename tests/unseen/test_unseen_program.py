"""Light that is found by chance, through the program: what films keep of it, what stop rules and people are told, and that
scenes without it have nothing of it."""

import json
import os
import pathlib
import subprocess
import unittest

import bpa
import cli
import mpi

SCENES = os.path.join(cli.SOURCE, "tests/unseen/scenes")


def scene_of(name):
    return os.path.join(SCENES, name + ".json")


class Unseen(cli.ProgramTest):
    def render(self, scene, name, *options):
        """What --stats says of a render to the film `name`, by chance if the options do not say otherwise."""
        if "--caustics" not in options:
            options += ("--caustics", "off")
        self.succeed("render", scene, *options, "-o", name, "-q", "--stats", "stats.json")
        return json.loads(self.read("stats.json"))

    def light(self, name):
        header, arrays = bpa.read(self.read(name))
        self.assertIs(header["unseen"], True)
        return arrays["unseen"], arrays["unseen_tint"]

    def told(self, stats):
        """What is of the pilot alone: the share depends on the picture too."""
        return {key: value for key, value in stats["unseen"].items() if key not in ("seconds", "share")}

    def test_seeds_and_samples(self):
        """Pictures of other seeds and numbers of samples have the same pilot, and claim nearly the same noise per sample."""
        first = self.render(scene_of("sun-0.27"), "a.bpa", "--spp", 16)
        pilot = self.light("a.bpa")
        for options in (("--spp", 16, "--seed", 7), ("--spp", 5, "--first-sample", 1000), ("--spp", 64, "--adaptive", "--seed", 8)):
            stats = self.render(scene_of("sun-0.27"), "b.bpa", *options)
            self.assertTrue(self.light("b.bpa") == pilot, options)
            self.assertEqual(self.told(stats), self.told(first), options)
            samples = stats["samples_mean"]
            ratio = stats["nrmse"] * samples ** 0.5 / (first["nrmse"] * 4)
            if "--adaptive" in options:  # more samples where the light is
                self.assertTrue(0.5 < ratio < 1, ratio)
            else:
                self.assertAlmostEqual(ratio, 1, delta=0.02, msg=options)
            self.assertGreater(stats["unseen_part"], 0.99)

    def test_narrow_lobes(self):
        """What rough metal and its like throw on matte surfaces is looked for where the lobe is narrow and a light small."""
        matte = {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}
        for material, radius, found in (({"type": "metal", "fuzz": 0.05}, 0.02, True), ({"type": "metal", "fuzz": 0.05}, 1, False),
                                        ({"type": "metal", "fuzz": 0.8}, 0.02, False), ({"type": "metal", "roughness": 0.15}, 0.02, True),
                                        ({"type": "metal", "roughness": 0.7}, 0.02, False), ({"type": "glossy"}, 0.02, True),
                                        ({"type": "dielectric", "refraction_index": 1.5, "roughness": 0.1}, 0.02, True),
                                        ({"type": "oren_nayar", "roughness": 0.1}, 0.02, False)):
            if material["type"] != "dielectric":
                material = {**material, "albedo": [0.5, 0.5, 0.5]}
            spheres = [{"center": [0, -100, 0], "radius": 100, "material": "floor"}, {"center": [0, 0.5, 0], "radius": 0.5, "material": "ball"},
                       {"center": [1.5, 2, 1], "radius": radius, "material": "lamp"}]
            self.write("lobes.json", json.dumps({
                "camera": {"lookfrom": [0, 1, 6], "lookat": [0, 0.5, 0], "vfov": 12, "image_width": 16, "aspect_ratio": 2}, "background": [0, 0, 0], "spheres": spheres,
                "materials": {"floor": matte, "ball": material, "lamp": {"type": "diffuse_light", "emit": [50, 50, 50]}}}))
            said = " ".join(self.succeed("explain", "lobes.json").stdout.decode().split())
            self.assertEqual("by way of spheres[1] (ball)" in said, found, (material, radius, said))

    def test_widths(self):
        """What narrow lobes send and show has the same variance at all sizes of a picture, and the true one."""
        truth = json.loads((pathlib.Path(__file__).parent / "truth.json").read_text())
        for scene in ("fuzz-0.05", "rough-metal", "coat", "frosted-sun"):
            for width in (32, 128, 640):
                stats = self.render(scene_of(scene), "a.pfm", "--spp", 1, "--width", width)
                ratio = (stats["unseen"]["variance"] / truth[scene]["variance"][0]) ** 0.5
                self.assertTrue(1 / 1.5 < ratio < 1.5, (scene, width, ratio))

    def test_resumes_and_merges(self):
        """The whole, one resumed, and parts merged in either order: the same film, the same claim, to the bit."""
        scene = scene_of("sun-0.27")
        whole = self.render(scene, "whole.bpa", "--spp", 24)
        self.render(scene, "begun.bpa", "--spp", 10)
        resumed = self.render(scene, "resumed.bpa", "--spp", 24, "--resume", "begun.bpa")
        self.assert_same(self.read("whole.bpa"), self.read("resumed.bpa"), "resumed")
        self.assertEqual(resumed["nrmse"], whole["nrmse"])
        self.assertEqual(resumed["unseen_part"], whole["unseen_part"])
        self.render(scene, "other.bpa", "--spp", 14, "--first-sample", 10)
        for order in (("begun.bpa", "other.bpa"), ("other.bpa", "begun.bpa")):
            said = self.succeed("merge", *order, "-o", "merged.bpa").errors
            self.assert_same(self.read("whole.bpa"), self.read("merged.bpa"), order)
            self.assertRegex(said, rf"noise {100 * whole['nrmse']:.0f} %")
        for part in (1, 2):
            self.render(scene, f"{part}.bpa", "--spp", 24, "--share", f"{part}/2")
        self.succeed("merge", "2.bpa", "1.bpa", "-o", "merged.bpa", "-q")
        self.assert_same(self.read("whole.bpa"), self.read("merged.bpa"), "shares")
        whole = self.render(scene, "whole.bpa", "--spp", 96, "--adaptive")
        self.render(scene, "begun.bpa", "--spp", 40, "--adaptive")
        resumed = self.render(scene, "resumed.bpa", "--spp", 96, "--resume", "begun.bpa")
        self.assertEqual(self.light("whole.bpa"), self.light("resumed.bpa"))

    def test_a_film_without(self):
        """One that knows nothing of such light merges with one that does, and goes on."""
        scene = scene_of("sun-0.27")
        self.render(scene, "sums.bpa", "--spp", 10)
        self.write("sums.bpa", bpa.sums_alone(self.read("sums.bpa")))
        self.render(scene, "new.bpa", "--spp", 14, "--first-sample", 10)
        pilot = self.light("new.bpa")
        for order in (("sums.bpa", "new.bpa"), ("new.bpa", "sums.bpa")):
            self.succeed("merge", *order, "-o", "merged.bpa", "-q")
            self.assertTrue(self.light("merged.bpa") == pilot, order)
        whole = self.render(scene, "whole.bpa", "--spp", 24)
        resumed = self.render(scene, "resumed.bpa", "--spp", 24, "--resume", "sums.bpa")
        self.assertTrue(self.light("resumed.bpa") == pilot)
        self.assertEqual(resumed["nrmse"], whole["nrmse"])

    @cli.deep
    def test_forms(self):
        """All forms of the kernel: the same film, the same claim."""
        for scene in ("sun-0.27", "bulb", "coat", "frosted"):
            films = []
            for form in ("packet", "sample", "pool"):
                stats = self.render(scene_of(scene), "a.bpa", "--spp", 8, "--kernel", form)
                films.append((self.read("a.bpa"), stats["nrmse"], stats["unseen_part"], self.told(stats)))
            for film in films[1:]:
                self.assertTrue(film == films[0], scene)

    @cli.deep
    @unittest.skipIf(mpi.reason_to_skip(), mpi.reason_to_skip())
    def test_ranks(self):
        for name, *options in (("sun-0.27", "--spp", 16, "--caustics", "off"), ("sun-0.27", "--spp", 16, "--caustics", "auto"),
                              ("sun-0.27", "--spp", 64, "--adaptive", "--caustics", "off"),
                              ("lamp-0.4", "--error", "30%", "--spp", 4096, "--caustics", "off")):
            scene = scene_of(name)
            alone = self.render(scene, "alone.bpa", *options)
            self.assertEqual(alone["stopped_by"], "error" if "--error" in options else "samples")
            for ranks in (2, 3):
                subprocess.run([mpi.MPIRUN, *mpi.FLAGS, "-n", str(ranks), cli.PROGRAM, "render", scene, *map(str, options),
                                "-o", "some.bpa", "-q", "--stats", "some.json"], cwd=self.folder, env=self.environment, check=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=cli.LIMIT_SECONDS)
                some = json.loads(self.read("some.json"))
                self.assert_same(self.read("alone.bpa"), self.read("some.bpa"), (ranks, options))
                for member in ("nrmse", "unseen_part", "samples_per_pixel", "stopped_by"):
                    self.assertEqual(some[member], alone[member], (member, ranks, options))
                self.assertEqual(self.told(some), self.told(alone))

    def test_a_rule_does_not_end_early(self):
        """A noise of 4 % takes millions of samples: the one sample in a million that finds the sun has not been drawn."""
        for options in ((), ("--adaptive",)):
            stats = self.render(scene_of("sun-0.27"), "a.bpa", "--error", "4%", "--spp", 512, *options)
            self.assertEqual(stats["stopped_by"], "samples", options)
            self.assertGreater(stats["nrmse"], 1)
            self.assertGreater(stats["samples_mean"], 450)  # as near to 512 as doublings of tiles come
        stats = self.render(scene_of("control-no-glass"), "a.bpa", "--error", "4%", "--spp", 512)
        self.assertEqual(stats["stopped_by"], "error")

    def test_errors_of_pixels(self):
        """What an EXR says of each pixel is what is claimed for the picture."""
        stats = self.render(scene_of("sun-0.27"), "a.bpa", "--spp", 16)
        header, arrays = bpa.read(self.read("a.bpa"))
        self.assertTrue(header["unseen"])
        numbers = memoryview(arrays["unseen"]).cast("f")
        variance = sum(numbers[1::2]) / len(numbers[1::2]) / 16
        expected = stats["nrmse"] ** 2 * stats["unseen_part"]
        luminance = stats["unseen"]["mean"] / stats["unseen"]["share"]
        self.assertAlmostEqual(variance / luminance ** 2 / expected, 1, delta=0.01)

    def test_light_sampling_off(self):
        """Then all light is found by chance, and nothing is claimed of it."""
        stats = self.render(scene_of("sun-0.27"), "a.bpa", "--spp", 16, "--light-sampling", "off")
        self.assertIsNone(stats["unseen"])
        self.assertEqual(stats["unseen_part"], 0)
        header, arrays = bpa.read(self.read("a.bpa"))
        self.assertIs(header["unseen"], False)
        self.assertNotIn("unseen", arrays)

    def less_with_caustics(self, *scenes):
        for scene, least, most in scenes:
            off = self.render(scene_of(scene), "a.bpa", "--spp", 4)["unseen"]["variance"]
            on = self.render(scene_of(scene), "b.bpa", "--spp", 4, "--caustics", "on")["unseen"]["variance"]
            self.assertTrue(least * off < on < most * off, (scene, on / off))

    @cli.deep
    def test_caustics_on_for_lamps(self):
        self.less_with_caustics(("caustic-alone-lamp", 0, 0.1), ("lamp-0.03", 0, 0.01), ("lens", 0, 0.01))

    def test_caustics_on(self):
        """Where rays to lamps go through glass, what they find is not left to chance, and the rest of the light is: that of five and
        more surfaces of one ball, and much of that of two balls in a row, but little of that of a ball and a mirror. Of the hollow ball's light, most comes off its inner surface (samples: 0.93) and
        meets three surfaces in all, as many as a chain of one ball."""
        self.less_with_caustics(("caustic-alone-sun", 0, 0.0002), ("sun-0.27", 0, 0.0003), ("balls-in-a-row", 0.3, 0.6), ("hollow", 0.8, 0.95),
                                ("orthographic", 0.1, 0.25))
        # In one mirror, every image of a lamp is found, but not by parallel rays, which see one on the ball in "orthographic".
        self.assertIsNone(self.render(scene_of("lamp-in-mirror"), "b.bpa", "--spp", 4, "--caustics", "on")["unseen"])
        said = self.succeed("render", scene_of("balls-in-a-row"), "--spp", 16, "-o", "c.pfm", "--caustics", "on").errors
        self.assertIn("hardly found", said)
        self.assertNotIn("--caustics", said)
        said = self.succeed("render", scene_of("moving"), "--spp", 16, "-o", "c.pfm").errors
        self.assertIn("hardly found", said)
        self.assertNotIn("--caustics", said)  # which does nothing where spheres move

    def choices(self, expected):
        for word, names in expected:
            for name in names:
                stats = self.render(scene_of(name), "a.bpa", "--spp", 2, "--caustics", "auto")
                self.assertEqual(stats["caustics"], word, name)

    def test_auto(self):
        """Of itself the program sends rays to lamps through glass where pictures are then better at equal time, as measured
        (docs/UNSEEN.md), and nowhere else: not where samples find the light anyway, where the rims of lamps make most of the noise,
        or where what is left comes by way of two spheres."""
        self.choices((("on", ("lamp-0.1",)), ("off", ("hollow", "gold-mirror"))))
        for name, word in (("sun-0.27", "on"), ("lamp-0.4", "off")):
            chosen = self.render(scene_of(name), "chosen.bpa", "--spp", 16, "--caustics", "auto")
            given = self.render(scene_of(name), "given.bpa", "--spp", 16, "--caustics", word)
            self.assert_same(self.read("chosen.bpa"), self.read("given.bpa"), name)
            self.assertEqual((chosen["caustics"], self.told(chosen)), (word, self.told(given)))
            self.succeed("render", scene_of(name), "--spp", 16, "-o", "usual.bpa", "-q")
            self.assert_same(self.read("usual.bpa"), self.read("given.bpa"), f"{name}, without the option")
            if word == "off":
                continue
            # The choice does not change with the samples, so parts fit; and a film goes on as it was begun.
            self.succeed("render", scene_of(name), "--spp", 1, "-o", "first.bpa", "-q")
            self.succeed("render", scene_of(name), "--spp", 15, "--first-sample", 1, "-o", "rest.bpa", "-q")
            self.succeed("merge", "first.bpa", "rest.bpa", "-o", "merged.bpa", "-q")
            self.assert_same(self.read("merged.bpa"), self.read("given.bpa"), f"{name}, in parts")
            other = {"on": "off", "off": "on"}[word]
            self.render(scene_of(name), "begun.bpa", "--spp", 4, "--caustics", other)
            self.succeed("render", scene_of(name), "--resume", "begun.bpa", "--caustics", "auto", "--spp", 8, "-o", "more.bpa", "-q")
            self.succeed("render", scene_of(name), "--resume", "more.bpa", "--spp", 16, "-o", "ended.bpa", "-q")
            self.render(scene_of(name), "whole.bpa", "--spp", 16, "--caustics", other)
            self.assert_same(self.read("ended.bpa"), self.read("whole.bpa"), f"{name}, begun with {other}")
        said = self.succeed("explain", scene_of("sun-0.27")).stdout.decode()
        self.assertIn("by chance", said)
        self.assertNotIn("What helps: --caustics", said)  # it is on
        self.assertRegex(said, r"(?m)^  --caustics +on +rays to lamps go through balls of glass")
        self.assertRegex(self.succeed("explain", scene_of("lamp-0.4")).stdout.decode(), r"(?m)^  --caustics +off +light by way of glass")
        stats = self.render(scene_of("sun-0.27"), "a.bpa", "--spp", 2, "--caustics", "auto", "--light-sampling", "off")
        self.assertEqual(stats["caustics"], "off")

    @cli.deep
    def test_auto_elsewhere(self):
        self.choices((("on", ("lamp-0.01", "lamps-two", "disc-1", "textured", "lamp-in-mirror")),
                      ("off", ("balls-in-a-row", "mirrors-corner", "control-no-glass", "moving"))))

    def test_auto_knows_no_units(self):
        """Light a thousand times as bright, and all lengths a thousand times as large: the same choice."""
        def scaled(name, bright, large):
            scene = json.loads(self.read(scene_of(name)))
            scene["background"] = {key: [bright * x for x in value] for key, value in scene["background"].items()}
            for material in scene["materials"].values():
                if "emit" in material:
                    material["emit"] = [bright * x for x in material["emit"]]
            for key in ("lookfrom", "lookat"):
                scene["camera"][key] = [large * x for x in scene["camera"][key]]
            for sphere in scene["spheres"]:
                sphere["center"] = [large * x for x in sphere["center"]]
                sphere["radius"] *= large
            return self.write("scaled.json", scene)
        for name, word in (("lamp-0.1", "on"), ("lamp-0.4", "off")):
            for bright, large in ((2 ** -10, 1), (2 ** 10, 2 ** -10)):
                stats = self.render(scaled(name, bright, large), "a.bpa", "--spp", 1, "--caustics", "auto")
                self.assertEqual(stats["caustics"], word, (name, bright, large))

    def rare_ways(self, *widths):
        """What glass reflects inside once and twice is found at every size of the picture: the claim for a sample is the same. (With
        rays through glass, in this scene nothing else is left to chance: of glass with so low an index they are sent straight through alone.)"""
        claims = []
        scene = json.loads(pathlib.Path(scene_of("caustic-through-glass")).read_text(encoding="utf-8"))
        scene["materials"]["glass"]["refraction_index"] = 1.4
        low = self.write("low.json", scene)
        for width in widths:
            stats = self.render(low, "a.bpa", "--spp", 1, "--width", width, "--caustics", "on")
            claims.append(stats["unseen"]["variance"] ** 0.5)
        self.assertLess(max(claims), 2 * min(claims), claims)

    def test_rare_ways(self):
        self.rare_ways(32, 128, 192, 320)

    @cli.deep
    def test_rare_ways_in_large_pictures(self):
        self.rare_ways(32, 128, 192, 320, 1280)

    def test_scenes_without(self):
        """Without lights, or without what focuses them, there is no pilot in the program: a fault in its text is not met."""
        broken = cli.broken_kernels(self, "entry/pilot.cl", "Path path;", "this is no OpenCL C;")
        large = self.write("large.json", cli.scene(spheres=[
            {"center": [0, 0, -2], "radius": 0.5, "material": "m"}, {"center": [0, 3, -1], "radius": 1, "material": "lamp"}],
            materials={"m": {"type": "metal", "albedo": [0.5, 0.4, 0.3], "fuzz": 0.2}, "lamp": {"type": "diffuse_light", "emit": [4, 4, 4]}}))
        plain = self.write("plain.json", cli.scene())
        for scene in (scene_of("control-no-glass"), scene_of("control-large-lamp"), scene_of("control-sky"), large, plain):
            # At 64 pixels, no lamp is smaller than one: those are looked for without glass as well.
            self.succeed("render", scene, "--width", 64, "--spp", 4, "-o", "with.bpa", "-q", "--stats", "stats.json", environment=broken)
            stats = json.loads(self.read("stats.json"))
            self.assertIsNone(stats["unseen"])
            self.assertEqual(stats["unseen_part"], 0)
            self.succeed("render", scene, "--width", 64, "--spp", 4, "-o", "without.bpa", "-q", "--stats", "stats.json")
            self.assert_same(self.read("with.bpa"), self.read("without.bpa"), scene)
            self.assertIs(bpa.read(self.read("with.bpa"))[0]["unseen"], False)
        self.fail_with(1, "render", scene_of("sun-0.27"), "--spp", 4, "-o", "x.bpa", "-q", "--caustics", "off", environment=broken,
                       says="the kernel does not compile")
        self.succeed("render", scene_of("sun-0.27"), "--spp", 4, "-o", "x.bpa", "-q", "--light-sampling", "off", environment=broken)

    def test_what_is_said(self):
        """`render` and `explain` name the spheres, how rare it is, and what helps; but for nothing where nothing is unseen."""
        off = ("--caustics", "off")
        said = self.succeed("render", scene_of("sun-0.27"), "--spp", 64, "-o", "a.pfm", "--stats", "a.json", *off).errors
        stats = json.loads(self.read("a.json"))
        unseen = stats["unseen"]
        self.assertRegex(said, r"most of this noise is light that samples have hardly found yet\. About [0-9.]+ % of the light comes by way of "
                               r"spheres\[2\] \(mirror\) and spheres\[1\] \(glass\), and one sample in [0-9.]+ million finds it\. What helps: "
                               r"--caustics auto, larger lamps or discs, a fuzz of 1/64 or a roughness of 1/16 for mirrors, or many more samples\.")
        self.assertEqual([sphere["sphere"] for sphere in unseen["spheres"]], [2, 1])
        self.assertAlmostEqual(sum(sphere["part"] for sphere in unseen["spheres"]) + unseen["direct"], 1, places=6)
        self.assertAlmostEqual(unseen["mean"] ** 2 / unseen["variance"] / unseen["found"], 1, places=6)
        self.assertEqual(self.succeed("render", scene_of("sun-0.27"), "--spp", 4, "-o", "b.pfm", "-q", *off).errors, "")
        told = self.succeed("explain", scene_of("sun-0.27"), *off).stdout.decode()
        self.assertRegex(told, r"(?m)^ *by chance +yes +About [0-9.]+ % of the light comes by way of spheres\[2\] \(mirror\) and spheres\[1\] "
                               r"\(glass\), and one sample in [0-9.]+ million finds it\. .* At 64 samples per pixel that is a noise of about [0-9]+ %\.")
        document = json.loads(self.succeed("explain", scene_of("sun-0.27"), "--json", "-", *off).stdout)
        entry = document.get("scenes", [document])[0]["unseen"]
        self.assertEqual(sorted(entry), sorted(unseen))
        for key in ("mean", "variance", "found", "direct", "spheres"):
            self.assertEqual(entry[key], unseen[key], key)
        # A lamp that is smaller than a pixel is no matter of glass.
        said = self.succeed("render", scene_of("lamp-seen"), "--spp", 16, "-o", "c.pfm").errors
        self.assertRegex(said, r"comes straight from lights that are smaller than a pixel, and one sample in .* finds it\. What helps: "
                               r"larger lights, or more samples\.")
        # Where samples find it, or there is none, nothing is said of it.
        said = self.succeed("render", scene_of("control-no-glass"), "--spp", 16, "-o", "d.pfm").errors
        self.assertNotIn("hardly found", said)
        told = self.succeed("explain", scene_of("control-no-glass")).stdout.decode()
        self.assertRegex(told, r"(?m)^ *by chance +no\b")
        document = json.loads(self.succeed("explain", scene_of("control-no-glass"), "--json", "-").stdout)
        self.assertIsNone(document.get("scenes", [document])[0]["unseen"])

    def test_what_is_said_of_triangles(self):
        floor = {"corner": [-9, 0, 9], "u": [18, 0, 0], "v": [0, 0, -18], "material": "m"}
        box = {"corners": [[-0.5, 0.5, -0.5], [0.5, 1.5, 0.5]], "rotate": [0, 20, 0], "material": "block"}
        document = cli.scene(spheres=[{"center": [1, 4, 0], "radius": 0.05, "material": "lamp"}], quads=[floor], boxes=[box], materials={
            "m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}, "block": {"type": "dielectric", "refraction_index": 1.5},
            "lamp": {"type": "diffuse_light", "emit": [200, 200, 200]}})
        document["camera"].update(lookfrom=[0, 3, 5], lookat=[0, 0.5, 0], vfov=40, image_width=40)
        self.write("a.json", document)
        told = self.succeed("explain", "a.json").stdout.decode()
        self.assertRegex(told, r"(?m)^ *by chance +yes +About [0-9.]+ % of the light comes by way of triangles \(block\), and one sample in "
                               r"[0-9.]+ \w+ finds it\. What helps: larger lamps or discs, or many more samples\.")
        unseen = json.loads(self.succeed("explain", "a.json", "--json", "-").stdout)
        unseen = unseen.get("scenes", [unseen])[0]["unseen"]
        self.assertAlmostEqual(unseen["triangles"], 1, places=6)
        self.assertEqual(unseen["spheres"], [])
        capsule = {key: value for key, value in document.items() if key not in ("quads", "boxes")}
        capsule["spheres"] = capsule["spheres"] + [{"center": [0, -100, 0], "radius": 100, "material": "m"}]
        capsule["capsules"] = [{"ends": [[-0.5, 0.8, 0], [0.5, 0.8, 0]], "radius": 0.4, "material": "block"}]
        self.write("c.json", capsule)
        self.assertRegex(self.succeed("explain", "c.json").stdout.decode(), r"comes by way of capsules\s+\(block\)")
        # A lamp of triangles, to which rays are sent: there is nothing to look for, until a mirror shows it.
        document["materials"]["block"] = dict(document["materials"]["m"])
        document["quads"].append({"corner": [1, 3, 0], "u": [0.5, 0, 0], "v": [0, 0, 0.5], "material": "lamp"})
        del document["spheres"]
        self.write("b.json", document)
        self.assertIsNone(json.loads(self.read_stats("b.json"))["unseen"])
        document["materials"]["block"] = {"type": "metal", "albedo": [0.9, 0.9, 0.9], "fuzz": 0}
        self.write("b.json", document)
        unseen = json.loads(self.read_stats("b.json"))["unseen"]
        self.assertAlmostEqual(unseen["triangles"], 1, places=6)
        self.assertIsNone(json.loads(self.read_stats("b.json", "--light-sampling", "off"))["unseen"])

    def read_stats(self, scene, *options):
        self.succeed("render", scene, "--spp", 4, "-o", "x.pfm", "-q", "--stats", "x.stats", *options)
        return self.read("x.stats")


cli.main()
