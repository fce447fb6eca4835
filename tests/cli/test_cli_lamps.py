"""How many rays were sent to lamps, as --stats says: counted once each, in both forms of the kernel, in parts of a render and in
renders that go on, and told apart from ray segments."""

import json
import pathlib

import bpa
from cli import SOURCE, ProgramTest, main

SIDE, SAMPLES = 12, 37
LAMP = {"type": "diffuse_light", "emit": [50, 40, 30]}
MATTE = {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}


def ground(lamps):
    """Every camera ray meets the ground, from whose points the lamps behind the camera are in view, and nothing else is."""
    spheres = [{"center": [0, -1000, 0], "radius": 1000, "material": "matte"}]
    spheres += [{"center": [3 * i, 9, 1], "radius": 0.25, "material": "lamp"} for i in range(lamps)]
    return {"format": 1, "background": [0, 0, 0], "materials": {"matte": MATTE, "lamp": LAMP}, "spheres": spheres,
            "camera": {"image_width": SIDE, "vfov": 20, "lookfrom": [0, 5, 0], "lookat": [0, 0, 0], "vup": [0, 0, 1], "max_depth": 5}}


class LampRays(ProgramTest):
    def stats(self, *arguments):
        self.succeed("render", *arguments, "-q", "--force", "--stats", "stats.json")
        return json.loads(self.read("stats.json"))

    def test_one_for_each_vertex(self):
        """Where no path meets a second surface, each sample sends one ray. Its length counts: a ray that would be one segment
        more than --depth is not sent."""
        self.write("s.json", json.dumps(ground(2)))
        for form in ("packet", "sample", "pool"):
            for depth, each in ((0, 0), (1, 0), (2, 1), (5, 1)):
                found = self.stats("s.json", "--kernel", form, "--spp", SAMPLES, "--depth", depth, "-o", "s.png")
                self.assertEqual(found["samples"], SIDE * SIDE * SAMPLES)
                self.assertEqual(found["shadow_rays"], each * found["samples"], f"{form}, depth {depth}")
            off = self.stats("s.json", "--kernel", form, "--spp", SAMPLES, "--light-sampling", "off", "-o", "s.png")
            self.assertEqual(off["shadow_rays"], 0)
            self.assertEqual(off["rays"], found["rays"])
        self.write("dark.json", json.dumps(ground(0)))
        self.assertEqual(self.stats("dark.json", "--effects", "all", "-o", "s.png")["shadow_rays"], 0)

    def test_those_that_explain_shows(self):
        """With shadows, glass and metal, by which some vertices send no ray."""
        options = (str(pathlib.Path(SOURCE, "scenes/lamps.json")), "--width", 6, "--seed", 4)
        found = self.stats(*options, "--spp", 1, "-o", "s.png")
        rays = sent = 0
        for pixel in range(found["width"] * found["height"]):
            done = self.succeed("explain", *options, "--pixel", f"{pixel % 6},{pixel // 6}", "--json", "-")
            steps = json.loads(done.stdout)["scenes"][0]["path"]["steps"]
            rays += len(steps)
            sent += sum("lamp_ray" in step for step in steps)
        self.assertEqual(found["rays"], rays)
        self.assertEqual(found["shadow_rays"], sent)
        self.assertTrue(0 < sent < rays)

    def test_parts_add_up(self):
        """Films hold the number: parts that are merged have that of the whole, and a render that goes on ends with it."""
        self.write("s.json", json.dumps(ground(1)))
        whole = self.stats("s.json", "--spp", 24, "-o", "whole.bpa")
        self.assertEqual(whole["shadow_rays"], SIDE * SIDE * 24)
        self.assertEqual(bpa.read(self.read("whole.bpa"))[0]["shadow_rays"], whole["shadow_rays"])
        self.assertEqual(self.stats("s.json", "--spp", 8, "-o", "a.bpa")["shadow_rays"], SIDE * SIDE * 8)
        self.stats("s.json", "--spp", 16, "--first-sample", 8, "-o", "b.bpa")
        self.succeed("merge", "a.bpa", "b.bpa", "-o", "merged.bpa", "-q")
        self.assertEqual(bpa.read(self.read("merged.bpa"))[0]["shadow_rays"], whole["shadow_rays"])
        resumed = self.stats("s.json", "--resume", "a.bpa", "--spp", 24, "-o", "resumed.bpa")
        self.assertEqual(resumed["shadow_rays"], whole["shadow_rays"])
        adaptive = self.stats("s.json", "--spp", 64, "--adaptive", "-o", "s.png")
        self.assertEqual(adaptive["shadow_rays"], adaptive["samples"])
        self.stats("s.json", "--spp", 8, "--light-sampling", "off", "-o", "off.bpa")
        self.assertEqual(bpa.read(self.read("off.bpa"))[0]["shadow_rays"], 0)


if __name__ == "__main__":
    main()
