"""Is the noise that is claimed for one picture true, where light is found by chance alone?

    python3 tests/unseen/test_unseen_claims.py --ballpark build/release/ballpark [--scenes A,B] [--seeds N] [--counts 16,64] [--table]

In:    the program; scenes/ and truth.json of this folder, which scripts/unseen-truth makes: the noise of pictures of 16 to 1024
       samples per pixel in truth, measured without the program's claims.
Out:   with --table, for each scene and number of samples: the claims over the seeds (5 %, median, 95 %) and the truth; of --error
       the samples at which pictures ended. Without it, what is wrong. Exit code 1 if something is.
Knows: the command line, and --stats.   Does not know: how the claim comes about.

Demanded, for each scene and number of samples:
- the median of the claims is within a factor 1.5 of the true root of mean squares,
- 95 % of the claims are within a factor 3 of it, or all but one where there are few seeds,
- --error ends at most 5 % of the pictures (or one) where the true noise for that number of samples exceeds 1.5 times the wanted one,
- where nothing is unseen (control-*), each claim is within 2 % of what it was before the program knew of unseen light,
- the printed noise is that of --stats.
"""

import argparse
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

FOLDER = pathlib.Path(__file__).resolve().parent
COUNTS = (16, 64, 256, 1024)
QUICK = ("sun-0.27", "lamp-0.03", "lamp-0.1", "rough-metal", "coat", "control-no-glass")
MEDIAN, MOST, STOP = 1.5, 3, 1.5
WANTED = (0.30, 0.10, 0.04)  # of --error
STOP_SAMPLES = 4096          # at which a picture ends that --error has not ended
CONTROL = 0.02


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = os.path.abspath(path), folder
        self.environment = dict(os.environ, LC_ALL="C.UTF-8", COLUMNS="10000")

    def render(self, scene, seed, *options):
        """What --stats says, and what is printed."""
        done = subprocess.run([self.path, "render", FOLDER / f"scenes/{scene}.json", "--seed", str(seed), "-o", "x.pfm", "--stats", "x.json", "--caustics", "off",
                               *map(str, options)], cwd=self.folder, env=self.environment, stderr=subprocess.PIPE, timeout=300)
        printed = done.stderr.decode(errors="replace")
        if done.returncode != 0:
            sys.exit(f"{scene} {options}: {printed}")
        return json.loads(pathlib.Path(self.folder, "x.json").read_text()), printed


def claim_of(stats):
    return math.nan if stats["nrmse"] is None else stats["nrmse"]


def true_noise(truth, samples):
    """Between the numbers of samples that were measured, by a power law; beyond, light that is rare by 1 / sqrt(samples) and
    what all pictures see as it fell last."""
    pictures = truth["pictures"]

    def along(name, low, high):
        slope = math.log(high[name] / low[name]) / math.log(high["samples"] / low["samples"])
        return high[name] * (samples / high["samples"]) ** slope
    for low, high in zip(pictures, pictures[1:]):
        if samples <= high["samples"]:
            return along("noise", low, high)
    low, high = pictures[-2:]
    if truth["way"] == "spread":
        return along("noise", low, high)
    rare = max(high["noise"] ** 2 - high["common"] ** 2, 0) * high["samples"] / samples
    return math.sqrt(rare + high["common"] ** 2 * high["samples"] / samples)


def quantile(values, share):
    ordered = sorted(math.inf if math.isnan(value) else value for value in values)
    place = share * (len(ordered) - 1)
    low = math.floor(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] if ordered[low] == ordered[high] else ordered[low] + (place - low) * (ordered[high] - ordered[low])


def percent(x):
    return f"{100 * x:8.3g}%"


class Judge:
    def __init__(self, program, truth, seeds, table):
        self.program, self.truth, self.seeds, self.table = program, truth, seeds, table
        self.faults = []

    def say(self, text):
        if self.table:
            print(text, flush=True)

    def fault(self, text):
        self.faults.append(text)
        self.say(f"    WRONG: {text}")

    def allowed(self):
        return max(1, math.floor(0.05 * self.seeds))

    def claims(self, scene, samples):
        truth = true_noise(self.truth[scene], samples)
        claims = []
        for seed in range(self.seeds):
            stats, printed = self.program.render(scene, seed, "--spp", samples)
            claims.append(claim_of(stats))
            if seed == 0:
                self.printed(scene, samples, claims[0], printed)
        median = statistics.median(math.inf if math.isnan(claim) else claim for claim in claims)
        outside = sum(not truth / MOST <= claim <= truth * MOST for claim in claims)
        self.say(f"{scene:22} {samples:5} {percent(quantile(claims, 0.05))} {percent(median)} {percent(quantile(claims, 0.95))} "
                 f"{percent(truth)}   {median / truth:8.3f}   {outside:3} of {self.seeds}")
        if not truth / MEDIAN <= median <= truth * MEDIAN:
            self.fault(f"{scene}, {samples} samples: the median of the claims is {100 * median:.3g} %, the truth {100 * truth:.3g} %")
        if outside > self.allowed():
            self.fault(f"{scene}, {samples} samples: {outside} of {self.seeds} claims are not within a factor {MOST} of the truth")
        for seed, (claim, before) in enumerate(zip(claims, self.truth[scene].get("claims", {}).get(str(samples), []))):
            if not abs(claim - before) <= CONTROL * before:
                self.fault(f"{scene}, {samples} samples, seed {seed}: nothing is unseen, and {100 * claim:.4g} % is claimed, "
                           f"not {100 * before:.4g} %")
                break

    def printed(self, scene, samples, claim, text):
        found = re.search(r"noise ([0-9.]+) %", text)
        if not found or not abs(float(found[1]) / 100 - claim) <= 0.06 * claim:
            self.fault(f"{scene}, {samples} samples: --stats says {100 * claim:.4g} %, and printed is: {text.splitlines()[:1]}")

    def stops(self, scene, wanted):
        ended, wrong = [], 0
        for seed in range(self.seeds):
            stats, _ = self.program.render(scene, seed, "--error", f"{100 * wanted:g}%", "--spp", STOP_SAMPLES)
            if stats["stopped_by"] == "error":
                ended.append(stats["samples_per_pixel"])
                wrong += true_noise(self.truth[scene], ended[-1]) > STOP * wanted
        text = f"ended at {min(ended)} to {max(ended)} samples, {wrong} of {self.seeds} too early" if ended else "none ended"
        ideal = next((n for n in (2 ** (i / 4) for i in range(16, 49)) if true_noise(self.truth[scene], n) <= wanted), None)
        self.say(f"{scene:22} --error {100 * wanted:3g}%: {len(ended):3} of {self.seeds} {text}; true at "
                 + (f"{ideal:.0f}" if ideal else f"more than {STOP_SAMPLES}"))
        if wrong > self.allowed():
            self.fault(f"{scene}: --error {100 * wanted:g}% ended {wrong} of {self.seeds} pictures whose true noise is more than {STOP} times that")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ballpark", required=True)
    parser.add_argument("--scenes", help="names, separated by commas (default: all that truth.json has)")
    parser.add_argument("--counts", default=",".join(map(str, COUNTS)))
    parser.add_argument("--errors", default=",".join(f"{100 * wanted:g}" for wanted in WANTED), help="of --error, in percent; may be empty")
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--quick", action="store_true", help="few scenes and numbers of samples, 8 seeds, one --error")
    parser.add_argument("--table", action="store_true")
    chosen = parser.parse_args()
    if chosen.quick:
        chosen.scenes, chosen.counts, chosen.seeds, chosen.errors = ",".join(QUICK), "16,256", 8, "10"
    truth = json.loads((FOLDER / "truth.json").read_text())
    scenes = chosen.scenes.split(",") if chosen.scenes else sorted(truth)
    with tempfile.TemporaryDirectory(prefix="ballpark-unseen-") as folder:
        judge = Judge(Program(chosen.ballpark, folder), truth, chosen.seeds, chosen.table)
        judge.say(f"{'scene':22} {'spp':>5} {'claim 5%':>9} {'median':>9} {'95%':>9} {'truth':>9}   {'med/true':>8}   outside {MOST}")
        for scene in scenes:
            for samples in filter(None, chosen.counts.split(",")):
                judge.claims(scene, int(samples))
            for wanted in filter(None, chosen.errors.split(",")):
                judge.stops(scene, float(wanted) / 100)
    if chosen.table:
        print(f"{len(judge.faults)} faults")
    else:
        print("\n".join(judge.faults))
    sys.exit(1 if judge.faults else 0)


main()
