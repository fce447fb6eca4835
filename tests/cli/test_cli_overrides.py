"""--set and --fresnel: scenes that are changed on the command line, before they are checked; units of values; --threads."""

import json
import os

import bpa
from cli import SOURCE, ProgramTest, main, scene

MATERIALS = {"m": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}, "my.glass": {"type": "dielectric", "refraction_index": 1.5}}


class Set(ProgramTest):
    def setUp(self):
        super().setUp()
        self.document = scene(materials=MATERIALS, spheres=2)
        self.document["spheres"][1]["material"] = "my.glass"
        self.write("s.json", json.dumps(self.document, indent=1))

    def film(self, name, *options):
        """The header and the numbers; of one kernel, whatever the materials are."""
        self.succeed("render", name, "-o", "a.bpa", "-q", "--effects", "all", *options)
        return bpa.read(self.read("a.bpa"))

    def test_like_the_file(self):
        """A film with --set is that of a file that says so, with the hash of its scene."""
        cases = [
            (["camera.vfov=30"], lambda d: d["camera"].update(vfov=30)),
            (["camera.lookfrom=[1, 2, 3]"], lambda d: d["camera"].update(lookfrom=[1, 2, 3])),
            (["camera.lookfrom=[1,2,3]", "camera.lookfrom[1]=0.5"], lambda d: d["camera"].update(lookfrom=[1, 0.5, 3])),
            (["spheres[1].radius=0.3"], lambda d: d["spheres"][1].update(radius=0.3)),
            (["spheres[0].material=my.glass"], lambda d: d["spheres"][0].update(material="my.glass")),
            (["materials.m.albedo[0]=0.9"], lambda d: d["materials"]["m"]["albedo"].__setitem__(0, 0.9)),
            (["materials.my.glass.refraction_index=1.2"], lambda d: d["materials"]["my.glass"].update(refraction_index=1.2)),
            (["background.top=[1,0,0]"], lambda d: d.update(background={"top": [1, 0, 0]})),
            (["background=[0,0,1]"], lambda d: d.update(background=[0, 0, 1])),
            (["materials.m={\"type\": \"metal\", \"albedo\": [1, 1, 1]}"],
             lambda d: d["materials"].update(m={"type": "metal", "albedo": [1, 1, 1]})),
            (["materials.new.type=lambertian", "materials.new.albedo=[1,0,0]", "spheres[0].material=new"],
             lambda d: (d["materials"].update(new={"type": "lambertian", "albedo": [1, 0, 0]}), d["spheres"][0].update(material="new"))),
            (["camera.image_width=null", "camera.image_width=20"], lambda d: d["camera"].update(image_width=20)),
        ]
        plain = self.film("s.json")
        for given, change in cases:
            with self.subTest(given=given):
                document = json.loads(json.dumps(self.document))
                change(document)
                self.write("t.json", document)
                options = [word for text in given for word in ("--set", text)]
                header, numbers = self.film("s.json", *options)
                of_file = self.film("t.json")
                self.assertEqual(header, of_file[0], given)
                self.assert_same(numbers, of_file[1], given)
                self.assert_different(numbers["sums"], plain[1]["sums"], given)
                self.assertNotEqual(header["scene_hash"], plain[0]["scene_hash"], given)

    def test_word_is_text(self):
        said = self.succeed("explain", "s.json", "--set", "title=word", "--set", "materials.m.scatter=hemisphere").stdout
        self.assertIn(b"word", said)

    def test_removed(self):
        self.write("a.json", scene(camera={"aspect_ratio": 2}))
        self.fail_with(2, "render", "a.json", "--set", "camera.image_height=5", says="beside \"aspect_ratio\"")
        said = self.succeed("render", "a.json", "--set", "camera.image_height=5", "--set", "camera.aspect_ratio=null").errors
        self.assertIn("16x5", said)

    def test_check_and_others(self):
        self.assertIn(b"16x16", self.succeed("explain", "s.json", "--set", "spheres=[]").stdout)
        self.succeed("check", "s.json", "--width", 8, "--spp", 64, "--margin", "5%", "--set", "spheres[0].radius=0.2")
        self.succeed("bench", "s.json", "--rounds", 1, "--time", 0.05, "--set", "camera.vfov=20")

    def test_wrong(self):
        for given, says in [
            ("camera.vfow=30", ["camera.vfow: unknown member; did you mean \"vfov\"?", "(by --set camera.vfow=30)"]),
            # One that the scene has as well: it was to be overridden.
            ("camera.max_detph=30", ["camera.max_detph: unknown member; did you mean \"max_depth\"?"]),
            ("camera.vfov=300", ["camera.vfov: found 300, expected degrees above 0 and below 180"]),
            ("camera.vfov=wide", ["found the text \"wide\", expected a number"]),
            ("camera.vfov=.5", ["--set camera.vfov=.5: the value is not JSON"]),
            ("camera.vfov=[1", ["the value is not JSON"]),
            ("camera.vfov={\"a\":1,\"a\":2}", ["the value is not JSON"]),
            ("camera.vfov=", ["found no value"]),
            ("camera.vfov", ["expected MEMBER=VALUE"]),
            ("camera.max_depth.x=3", ["camera.max_depth is 10, which has no members"]),
            ("=3", ["expected the name of a member"]),
            ("camera..vfov=3", ["expected the name of a member"]),
            ("spheres[2].radius=3", ["spheres has 2 elements"]),
            ("spheres.radius=3", ["spheres is a list of 2", "such as spheres[0]"]),
            ("spheres[x].radius=3", ["an element such as [0]"]),
            ("spheres[0]radius=3", ["behind an element"]),
            ("spheres[0]=null", ["null removes members of objects only"]),
            ("camera[0]=3", ["camera is an object, expected a list"]),
            ("spheres[1].radius=0", ["s.json: spheres[1].radius: found 0"]),
            ("spheres[1].material=non", ["spheres[1].material: found the material \"non\""]),
            ("camera=null", ["found no \"camera\""]),
            ("materials.x.albedo=[1,1,1]", ["materials.x: found no \"type\"", "(by --set materials.x.albedo=[1,1,1])"]),
            ("transfer=foo", ["expected \"gamma2\", \"srgb\" or \"linear\""]),
        ]:
            with self.subTest(given=given):
                self.fail_with(2, "render", "s.json", "--set", given, says=says)
        self.assertEqual(self.files(), ["s.json"])

    def test_a_material_that_nothing_has(self):
        matte = '={"type":"lambertian","albedo":[1,1,1]}'
        for name, said in (("mm", True), ("m", False), ("my.glass", False)):
            errors = self.succeed("explain", "s.json", "--set", f"materials.{name}{matte}").errors
            self.assertEqual("no sphere has this material" in errors, said, name)
        errors = self.succeed("explain", "s.json", "--set", "materials.mm" + matte, "--set", "spheres[0].material=mm").errors
        self.assertNotIn("no sphere", errors)

    def test_other_errors_keep_their_place(self):
        """Members that are added, removed or replaced do not shift what is said of those after them."""
        document = json.loads(json.dumps(self.document))
        document["camera"]["vup"] = 3
        text = json.dumps(document, indent=1)
        self.write("bad.json", text)
        before = text[:text.index('"vup": ') + len('"vup": ')]
        place = f"bad.json:{before.count(chr(10)) + 1}:{len(before) - before.rindex(chr(10))}: camera.vup: found 3"
        for given in ("background.top=[1,1,1]", "camera.max_depth=null", "camera.image_width=null", "camera.vfov=30", "camera.max_depth=3"):
            self.fail_with(2, "render", "bad.json", "--set", given, says=place)

    def test_statistics_and_pixels(self):
        """Overrides reach what a command reads later: the depth of --stats."""
        stats = json.loads(self.succeed("render", "s.json", "--set", "camera.max_depth=3", "-q", "--stats", "-", "-o", "x.png").stdout)
        self.assertEqual(stats["max_depth"], 3)


class Fresnel(ProgramTest):
    def setUp(self):
        super().setUp()
        ball = {"center": [0, 0, -1], "radius": 0.5, "material": "glass"}
        for name, more in ("schlick", {}), ("exact", {"fresnel": "exact"}), ("none", {"fresnel": "none"}):
            self.write(f"{name}.json", scene(materials={"glass": {"type": "dielectric", "refraction_index": 1.5, **more}}, spheres=[ball]))

    def render(self, name, *options):
        return self.succeed("render", name + ".json", "-o", "-", "--format", "pfm", *options)

    def test_overrides(self):
        pictures = {name: self.render(name).stdout for name in ("schlick", "exact")}
        self.assert_different(pictures["schlick"], pictures["exact"])
        for choice in "schlick", "exact":
            for name in "schlick", "exact", "none":
                done = self.render(name, "--fresnel", choice)
                self.assert_same(done.stdout, pictures[choice], (name, choice))
                self.assertIn("changes nothing: the scene has this value" if name == choice
                              else f"--fresnel {choice} overrides the scene in 1 of 1 dielectric material", done.errors)
                self.assertEqual(self.render(name, "--fresnel", choice, "-q").errors, "")

    def test_hash(self):
        """Sums of the overridden scene are those of the scene that says so, and of no other."""
        self.succeed("render", "schlick.json", "--fresnel", "exact", "-o", "a.bpa", "-q")
        self.succeed("render", "exact.json", "--first-sample", 8, "-o", "b.bpa", "-q")
        self.succeed("render", "schlick.json", "--first-sample", 8, "-o", "c.bpa", "-q")
        self.succeed("merge", "a.bpa", "b.bpa", "-o", "d.png", "-q")
        self.fail_with(2, "merge", "a.bpa", "c.bpa", "-o", "d.png", says="scene")

    def test_reference_agrees(self):
        self.succeed("check", "schlick.json", "--fresnel", "exact", "--width", 16, "--spp", 256, "--margin", "5%")

    def test_no_glass(self):
        self.write("m.json", scene())
        self.assertIn("has no dielectric", self.succeed("render", "m.json", "--fresnel", "exact").errors)

    def test_wrong(self):
        self.fail_with(2, "render", "exact.json", "--fresnel", "none", says="--fresnel: expected schlick or exact")
        self.fail_with(2, "cost", "exact.json", "--fresnel", "exact", says="it belongs to render, view, check, explain, bench")


class Units(ProgramTest):
    def test_same_values(self):
        self.write("s.json", scene())
        first = None
        for value in "20", "20%", "20 %", "2e1%":
            stats = json.loads(self.succeed("render", "s.json", "--error", value, "-q", "--stats", "-", "-o", "x.png").stdout)
            first = first or stats["samples"]
            self.assertEqual((stats["samples"], stats["stopped_by"]), (first, "error"), value)
        for value in "0.2", "0.2s", "200e-3s", "0.004m", "0.004min", "0.0001h", "0.00001d":
            stats = json.loads(self.succeed("render", "s.json", "--time", value, "-q", "--stats", "-", "-o", "x.png").stdout)
            self.assertEqual(stats["stopped_by"], "time", value)

    def test_wrong(self):
        for option, values in {"--error": ["1%%", "1 percent", "%", "101%", "0%", "1%5"],
                               "--time": ["2x", "s", "1h30", "30m1h", "1m1m", "m", "1 h", "0s", "2000h2000m2000000000s", "-1m"]}.items():
            for value in values:
                with self.subTest(option=option, value=value):
                    self.fail_with(2, "render", "x.json", option, value, says=[option, "such as"])


class Threads(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("s.json", scene(32))
        self.device = next(d for d in json.loads(self.succeed("devices", "--json", "-").stdout)["devices"] if d["default"])

    def test_same_picture(self):
        pictures = [self.succeed("render", "s.json", "-o", "-", "--format", "pfm", "-q", *options).stdout
                    for options in ((), ("--threads", "1"), ("--threads", "2"), ("--threads", "65536"))]
        for picture in pictures:
            self.assert_same(picture, pictures[0])

    def test_said(self):
        if self.device["type"] != "cpu":
            self.assertIn("changes nothing", self.succeed("render", "s.json", "--threads", 1).errors)
            return
        units = self.device["compute_units"]
        self.assertIn(f"has {units}, and all of them are used", self.succeed("render", "s.json", "--threads", units + 1).errors)
        self.assertNotIn("--threads", self.succeed("render", "s.json", "--threads", units).errors)

    def test_one_thread(self):
        """The kernel runs on one core: its processor time is not above the time that passed."""
        if self.device["type"] != "cpu" or self.device["compute_units"] < 2 or "Portable" not in self.device["platform"]:
            self.skipTest("no processor that its driver divides")
        os.symlink(os.path.join(SOURCE, "scenes/cover.json"), self.path("cover.json"))
        words = ("bench", "cover.json", "--width", "200", "--rounds", "3", "--time", "0.5", "--json", "-", "-q")
        def share(*options):
            run = json.loads(self.succeed(*words, *options).stdout)["scenes"][0]
            return [cpu / wall for cpu, wall in zip(run["cpu_nanoseconds_per_segment"]["rounds"], run["nanoseconds_per_segment"]["rounds"])]
        # The host's own thread adds a little.
        self.assertLess(min(share("--threads", "1")), 1.15)

    def test_wrong(self):
        for value in "0", "-1", "65537", "all":
            self.fail_with(2, "render", "s.json", "--threads", value, says="--threads")


if __name__ == "__main__":
    main()
