"""`ballpark cost`: what it writes, that its figures fit together and are right where the answer is known, what it
refuses, and that Ctrl-C keeps what there is."""
import csv
import io
import json
import math
import signal

from cli import ProgramTest, deep, main, scene
from terminal import Terminal

GLASS = {"m": {"type": "dielectric", "refraction_index": 1.5},
         "ground": {"type": "lambertian", "albedo": [0.5, 0.4, 0.3]}}
SPHERES = [{"center": [0, 0, -1], "radius": 0.5, "material": "m"},
           {"center": [0, -100.5, -1], "radius": 100, "material": "ground"}]
GLASS_SCENE = scene(32, spheres=SPHERES, materials=GLASS)

# Inside a sphere that glows with 1 and reflects half: 1 + 1/2 + 1/4 + ..., so D segments give 2 (1 - 2^-D).
FURNACE = scene(8, materials={"m": {"type": "lambertian", "albedo": [0.5] * 3, "emit": [1, 1, 1]}},
                spheres=[{"center": [0, 0, 0], "radius": 5, "material": "m"}], camera={"max_depth": 50})


class Cost(ProgramTest):
    def study(self, document, *options):
        self.write("s.json", document)
        done = self.succeed("cost", "s.json", "--json", "cost.json", *options)
        self.table = done.stdout.decode()
        result = json.loads(self.read("cost.json"))
        self.series = {s["name"]: s for s in result["series"]}
        return result

    def glass(self):
        """One study for several tests."""
        if not hasattr(Cost, "shared"):
            result = self.study(GLASS_SCENE, "--time", "4", "--csv", "cost.csv")
            Cost.shared = result, self.series, self.table, self.read("cost.csv").decode()
        result, self.series, self.table, self.csv = Cost.shared
        return result

    def test_files_agree(self):
        result = self.glass()
        rows = list(csv.DictReader(io.StringIO(self.csv)))
        self.assertEqual(len(rows), sum(len(s["points"]) for s in result["series"]))
        for row in rows:
            series = self.series[row["configuration"]]
            point = next(p for p in series["points"] if p["samples"] == int(row["samples"]))
            self.assertEqual((row["axis"], row["options"]), (series["axis"], series["options"]))
            self.assertEqual(row["front"] == "1", point["front"])
            for name in ("seconds", "wall_seconds", "device_seconds", "claimed_nrmse", "nrmse", "mse", "rel_mse"):
                if point[name] is None:
                    self.assertEqual(row[name], "")
                else:
                    self.assertAlmostEqual(float(row[name]), point[name], delta=1e-8 * abs(point[name]))
        for series in result["series"]:
            self.assertIn(series["name"], self.table)
        for advice in result["advice"]:
            self.assertIn(advice["text"], " ".join(self.table.split()))
        self.assertEqual("too short to rely on" in self.table, result["warning"] is not None)

    def test_figures_fit_together(self):
        result = self.glass()
        self.assertEqual((result["width"], result["height"]), (32, 32))
        self.assertEqual({s["axis"] for s in result["series"]},
                         {"base", "truth", "sampler", "adaptive", "depth", "precision", "math", "numerics", "roulette", "fresnel", "together"})
        base, truth = result["series"][:2]
        self.assertIsNone(self.series["adaptive samples"]["time_ratio"]["value"])
        points = [p for s in result["series"] for p in s["points"]]
        counts = [p["samples"] for p in base["points"]]
        self.assertEqual(counts[:2], [4, 16])
        for series in result["series"]:
            self.assertEqual([p["samples"] for p in series["points"]], counts)
            last, other = series["points"][-1], base["points"][-1]
            self.assertAlmostEqual(series["efficiency"], other["claimed_nrmse"] ** 2 * other["seconds"] /
                                   (last["claimed_nrmse"] ** 2 * last["seconds"]), places=9)
            self.assertAlmostEqual(series["seconds_per_sample"] * last["samples"] * 32 * 32 / last["seconds"], 1)
            for point in series["points"]:
                self.assertGreater(point["device_seconds"], 0)
                self.assertGreater(point["wall_seconds"], 0)
                self.assertGreater(point["seconds"], 0)
                if series["time_ratio"]["value"] is not None:
                    same = next(p for p in base["points"] if p["samples"] == point["samples"])
                    self.assertAlmostEqual(point["seconds"] / same["seconds"], series["time_ratio"]["value"])
                if point["nrmse"] is not None:
                    self.assertAlmostEqual(point["nrmse"] ** 2, point["mse"])
                # Of two with the same picture in the same time, which a coarse clock can give, both are on it.
                this = (point["seconds"], point["nrmse"])
                better = [p for p in points if p["nrmse"] is not None and point["nrmse"] is not None and
                          p["seconds"] <= this[0] and p["nrmse"] <= this[1] and (p["seconds"], p["nrmse"]) != this]
                self.assertEqual(point["front"], point["nrmse"] is not None and not better)
        # More samples, less error: 16 times fewer at four times the samples would be luck, the half is not.
        self.assertLess(base["points"][-1]["mse"], 0.5 * base["points"][0]["mse"])
        # What the replicates claim is what the references see, where nothing but noise is wrong.
        for point in truth["points"]:
            self.assertAlmostEqual(point["mse"], point["claimed_nrmse"] ** 2,
                                   delta=5 * point["mse_error"] + 0.1 * point["mse"])
        self.assertEqual(truth["bias_square"], {"value": 0, "low": 0, "high": 0})
        # Schlick's form inside glass is off by percents, float by nothing that shows.
        floor = base["bias_square"]
        self.assertGreater(floor["low"], 0)
        self.assertAlmostEqual(self.series["exact Fresnel"]["change_square"]["value"], floor["value"],
                               delta=0.1 * floor["value"])
        self.assertLess(abs(self.series["double precision"]["change"]["value"]), 1e-3)
        self.assertLess(self.series["exact Fresnel"]["bias_square"]["high"], 0.1 * floor["value"])
        # Pairing: the interval is far narrower than that of samples which have nothing in common.
        width = {n: s["change"]["high"] - s["change"]["low"] for n, s in self.series.items() if n != base["name"]}
        self.assertLess(10 * width["depth 1000"], width["independent samples"])

    @deep
    def test_bias_that_is_known(self):
        result = self.study(FURNACE, "--time", "1", "--roulette", "off")  # every sample is known
        self.assertAlmostEqual(result["brightness"], 2, delta=1e-6)
        for depth in (5, 10):
            series = self.series[f"depth {depth}"]
            for estimate in (series["bias"], series["change"]):
                self.assertAlmostEqual(estimate["value"], -2.0 ** -depth, delta=1e-6)
            self.assertAlmostEqual(series["bias_square"]["value"], 4.0 ** -depth, delta=1e-6)
            for point in series["points"]:
                self.assertAlmostEqual(point["nrmse"], 2.0 ** -depth, delta=1e-6)
        # Depth 5 is off by 3.1 %: right for 5 %, never for 1 %; and one sample is enough.
        self.assertEqual([a["samples_per_pixel"] for a in result["advice"]], [1, 1, 1])
        self.assertTrue(all(a["configuration"] != "depth 5" for a in result["advice"][1:]))

    def test_advice_can_be_followed(self):
        result = self.glass()
        self.write("s.json", GLASS_SCENE)
        advice = result["advice"][0]
        words = advice["text"].split(": ballpark ")[1].split(", with")[0].split()
        self.assertEqual(words[:2], ["render", "s.json"])
        self.succeed(*words, "--stats", "stats.json", "-o", "x.pfm")
        stats = json.loads(self.read("stats.json"))
        self.assertEqual(stats["samples_per_pixel"], advice["samples_per_pixel"])
        self.assertLess(stats["nrmse"], 0.05 * 1.15)

    @deep
    def test_what_it_is_compared_with_can_be_chosen(self):
        result = self.study(GLASS_SCENE, "--time", "1", "--sampler", "independent", "--precision", "double",
                            "--width", "16", "--depth", "20")
        self.assertEqual(result["series"][0]["options"], "--sampler independent --precision double --depth 20")
        self.assertIn("single precision", self.series)
        self.assertIn("Sobol samples", self.series)
        self.assertNotIn("depth 20", self.series)
        self.assertEqual((result["width"], result["advice_size"]), (16, [32, 32]))

    def test_standard_output(self):
        self.write("s.json", GLASS_SCENE)
        done = self.succeed("cost", "s.json", "--time", "0.2", "--json", "-", "-q")
        self.assertEqual(json.loads(done.stdout)["width"], 32)
        done = self.succeed("cost", "s.json", "--time", "0.2", "--csv", "-", "-q")
        self.assertTrue(done.stdout.startswith(b"configuration,axis,"))
        done = self.succeed("cost", "s.json", "--time", "0.2", "-o", "-", "-q")
        self.assertTrue(done.stdout.startswith(b"<!DOCTYPE html>") and done.stdout.endswith(b"</html>\n"))
        self.assertEqual(self.files(), ["s.json"])

    @deep
    def test_noise_free(self):
        result = self.study(scene(8, spheres=0, camera={"pixel_sampling": "center"}), "--time", "1")
        for series in result["series"]:
            self.assertEqual(series["points"][-1]["claimed_nrmse"], 0)
        self.assertEqual([a["samples_per_pixel"] for a in result["advice"]], [1, 1, 1])

    def test_refusals(self):
        self.write("s.json", GLASS_SCENE)
        self.write("black.json", scene(8, background=[0, 0, 0]))
        self.fail_with(2, "cost", says="SCENE")
        self.fail_with(2, "cost", "s.json", "black.json", says="black.json")
        self.fail_with(2, "cost", "s.json", "--time", "0", says=["--time", "0"])
        self.fail_with(2, "cost", "s.json", "--spp", "4", says="--spp")
        self.fail_with(2, "cost", "s.json", "--device", "all", says="--device")
        self.fail_with(2, "cost", "s.json", "--csv", "s.json", says="--csv s.json would overwrite")
        self.fail_with(2, "cost", "s.json", "--csv", "-", "--json", "-", says=["--csv", "--json", "standard output"])
        self.fail_with(1, "cost", "s.json", "--csv", "none/x.csv", says="none/x.csv")
        self.fail_with(1, "cost", "s.json", "-o", "none/x.html", says="none/x.html")
        self.fail_with(2, "cost", "none.json", says="none.json")
        self.fail_with(2, "cost", "black.json", "--time", "1", "--json", "x.json", says=["black.json", "black"])
        self.assertEqual(self.files(), ["black.json", "s.json"])

    def test_interrupted_early(self):
        self.write("s.json", GLASS_SCENE)
        screen = Terminal(self, "cost", "s.json", "--time", "600", "--json", "cost.json")
        screen.read_until(rb"rendering the references")
        screen.process.send_signal(signal.SIGINT)
        self.assertEqual(screen.finish(), 130)
        self.assertIn(b"nothing to compare yet", screen.seen)
        self.assertEqual(self.files(), ["s.json"])

    def test_interrupted_late(self):
        self.write("s.json", dict(GLASS_SCENE, camera={"image_width": 4}))
        screen = Terminal(self, "cost", "s.json", "--time", "600", "--json", "cost.json")
        screen.read_until(rb"1024 samples")
        self.assertRegex(screen.seen.decode(), r"\d+ %  .* left  ")
        screen.process.send_signal(signal.SIGINT)
        self.assertEqual(screen.finish(), 130)
        result = json.loads(self.read("cost.json"))
        self.assertTrue(result["cut_short"])
        self.assertEqual(len({len(s["points"]) for s in result["series"]}), 1)
        self.assertGreaterEqual(len(result["series"][0]["points"]), 4)
        self.assertTrue(math.isfinite(result["advice"][0]["seconds"]))


if __name__ == "__main__":
    main()
