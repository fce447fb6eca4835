"""Discs of the background, through the program: written, changed, explained, counted, merged, and seen or not."""

import json
import struct

from cli import ProgramTest, main, scene

SUN = {"direction": [0.3, 1, 0.6], "half_angle": 3, "radiance": [60, 50, 40]}
BEHIND = {"direction": [0, 0, -1], "half_angle": 60, "radiance": [0.5, 0.25, 0.125]}


def document(*discs, **members):
    background = {"bottom": [0, 0, 0], "top": [0, 0, 0], "discs": list(discs)}
    return scene(background=background, **members)


class Discs(ProgramTest):
    def picture(self, name, *options):
        return self.succeed("render", name, "-o", "-", "--format", "pfm", "-q", *options).stdout

    def pixels(self, name, *options):
        """Rows of the picture from the bottom up, as floats."""
        head, body = self.picture(name, *options).split(b"\n", 3)[1:4:2]
        width = int(head.split()[0])
        values = struct.unpack(f"<{len(body) // 4}f", body)
        return [values[i:i + 3] for i in range(0, len(values), 3)], width

    def test_seen_by_the_camera_or_not(self):
        """What is not the sphere shows the disc, unless it is hidden; the sphere is lit in both cases."""
        self.write("seen.json", document(BEHIND, SUN))
        self.write("hidden.json", document({**BEHIND, "visible_to_camera": False}, SUN))
        seen, width = self.pixels("seen.json", "--spp", 4)
        hidden, _ = self.pixels("hidden.json", "--spp", 4)
        middle = len(seen) // 2 + width // 2
        self.assertEqual(seen[0], tuple(BEHIND["radiance"]))
        self.assertEqual(hidden[0], (0, 0, 0))
        self.assertEqual(seen[middle], hidden[middle])
        self.assertGreater(min(hidden[middle + 2 * width]), 0)

    def test_written_reads_back(self):
        self.write("s.json", document(SUN, {**BEHIND, "visible_to_camera": False}, spheres=2))
        written = self.succeed("scene", "s.json").stdout
        self.write("again.json", written)
        self.assertEqual(json.loads(written)["background"]["discs"], [SUN, {**BEHIND, "visible_to_camera": False}])
        self.assertEqual(self.picture("s.json"), self.picture("again.json"))
        self.assertEqual(self.succeed("scene", "again.json").stdout, written)

    def test_set(self):
        self.write("s.json", document(SUN, BEHIND))
        self.write("brighter.json", document({**SUN, "radiance": [9, 8, 7]}, BEHIND))
        self.assertEqual(self.picture("s.json", "--set", "background.discs[0].radiance=[9,8,7]"), self.picture("brighter.json"))
        self.fail_with(2, "render", "s.json", "-o", "x.png", "--set", "background.discs[1].half_angle=0",
                       says=["background.discs[1].half_angle: found 0", "0.0001 to 90", "--set"])
        self.assertEqual(self.files(), ["brighter.json", "s.json"])

    def test_lamps_off(self):
        """The same paths, and about as much light, with more noise."""
        self.write("s.json", document(SUN, width=32))
        found = {}
        for lamps in ("on", "off"):
            self.succeed("render", "s.json", "-q", "--light-sampling", lamps, "--spp", 256, "-o", f"{lamps}.png", "--stats", f"{lamps}.json")
            found[lamps] = json.loads(self.read(f"{lamps}.json"))
            self.assertEqual(found[lamps]["light_sampling"], lamps)
        on, off = found["on"], found["off"]
        self.assertEqual(on["effects"], ["lambertian", "light_sampling", "discs", "roulette"])
        for member in ("rays", "cut_paths", "invalid_samples"):
            self.assertEqual(on[member], off[member])
        self.assertGreater(off["nrmse"], 3 * on["nrmse"])
        for a, b in zip(on["mean_radiance"], off["mean_radiance"]):
            self.assertLess(abs(a / b - 1), 6 * off["nrmse"] / 32)

    def test_explain(self):
        self.write("s.json", document(SUN, BEHIND, width=32))
        table = self.succeed("explain", "s.json").stdout.decode()
        self.assertRegex(table, r"light_sampling +in +2 discs that can light 1 sphere")
        self.assertRegex(table, r"discs +in +2 discs in the background")
        rays, stopped, seen = [], 0, 0
        for x in range(8, 28, 3):
            path = json.loads(self.succeed("explain", "s.json", "--pixel", f"{x},14", "--json", "-").stdout)["scenes"][0]["path"]
            text = self.succeed("explain", "s.json", "--pixel", f"{x},14").stdout.decode()
            for step in path["steps"]:
                if "lamp_ray" in step:
                    ray = step["lamp_ray"]
                    rays.append(ray["disc"])
                    stopped += ray["meets"] is not None
                    self.assertNotIn("lamp", ray)
                    self.assertIn(f"a ray to disc {ray['disc']} ", text)
                    if ray["meets"] is None:
                        self.assertGreater(min(ray["brings"]), 0)
                if not step["met"] and step.get("discs"):
                    seen += 1
                    self.assertIn("hits nothing: the sky and disc", text)
        self.assertGreater(len(rays), 3)
        self.assertEqual(set(rays), {0, 1} if 1 in rays else {0})
        self.assertGreater(seen, 0)
        off = json.loads(self.succeed("explain", "s.json", "--pixel", "16,14", "--light-sampling", "off", "--json", "-").stdout)
        self.assertFalse(any("lamp_ray" in step for step in off["scenes"][0]["path"]["steps"]))

    def test_films_of_other_discs_do_not_merge(self):
        self.write("s.json", document(SUN))
        self.write("wider.json", document({**SUN, "half_angle": 4}))
        self.succeed("render", "s.json", "-q", "-o", "a.bpa")
        self.succeed("render", "wider.json", "-q", "--first-sample", 8, "-o", "b.bpa")
        self.fail_with(2, "merge", "a.bpa", "b.bpa", "-o", "c.png", says=["scene"])


if __name__ == "__main__":
    main()
