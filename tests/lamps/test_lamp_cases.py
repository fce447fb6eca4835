"""Hard cases of light sampling through the real program, with sampling and without (cases.py,
disc_cases.py, image_cases.py, motion_cases.py, boundary_cases.py and triangle_cases.py have the scenes).

    test_lamp_cases.py PROGRAM SOURCE_DIR [--deep] [--on] [--own] [NUMBER[.PLACE]...]

Each case is a point whose radiance is known in closed form, or by chance alone, or to the bit. A closed form is held
with sampling on, to a standard error of at most 0.2 %; and, where chance finds the lamp, with sampling off too. Where
only chance knows, both are compared pixel by pixel, to a standard error of at most 0.5 %. A value is wrong when it
lies more than Z_MAX standard errors and a rounding (2e-5, as a rule) from what is expected: of some 600 such tests of a
right program one fails by chance with a probability of 1e-4, and a deviation of 6.5 standard errors, which is at most
1.3 % and 0.05 % in the middle of the cases, is found with 90 %.

A number stands for several cases; 32.2 is the second of them. Without numbers: all cases but those that repeat others with
other values; --deep: those alone. --on: only what sampling alone shows, for the quick part and the mutants: no picture is
drawn without, what needs one is left out, and the first case that fails is the last. --own: each case by a kernel with the
effects of its scene, as renders have it. Otherwise one kernel has all effects: compiled once for all cases, but in a longer
time.
"""
import itertools
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import boundary_cases
import cases
import disc_cases
import image_cases
import motion_cases
import triangle_cases
from pfm import read_pfm

Z_MAX = 5.2
PRECISE = 0.002        # largest standard error of a closed form
BRUTE_PRECISE = 0.005  # of a comparison with chance


class Trouble(Exception):
    pass


class Bench:
    def __init__(self, program, folder, own):
        self.program, self.folder, self.pictures = os.path.abspath(program), folder, 0
        self.effects = [] if own else ["--effects", "all"]
        self.drawn = {}  # by render_together, for render

    def run(self, names, lamps, samples, options):
        """What the program said, and the statistics of each scene if it succeeded."""
        command = [self.program, "render", *names, "--quiet", *self.effects, "--light-sampling", lamps, "--seed", "3", "--spp",
                   str(samples), "-o", "./", "--format", "pfm", "--stats", "stats.json", *options]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        if done.returncode != 0:
            return done, []
        stats = json.loads((self.folder / "stats.json").read_text())
        return done, stats["renders"] if len(names) > 1 else [stats]

    def render_together(self, wanted):
        """Draws all scenes that have the same options in one run, since starting the program takes longer than drawing a scene.
        Where a run fails, render draws its scenes one by one."""
        groups = {}
        for scene, *how in wanted:
            groups.setdefault(tuple(how), []).append(scene)
        for how, scenes in groups.items():
            names = [f"case-{number}.json" for number in range(len(scenes))]
            for name, scene in zip(names, scenes):
                (self.folder / name).write_text(json.dumps(scene))
            _, stats = self.run(names, *how)
            for name, scene, one in zip(names, scenes, stats):
                picture = (self.folder / name).with_suffix(".pfm").read_bytes()
                self.drawn[(json.dumps(scene), *how)] = picture, one

    def render(self, scene, lamps, samples, options=()):
        """The picture's bytes, its pixels' channels as three lists, and the statistics."""
        self.pictures += 1
        drawn = self.drawn.get((json.dumps(scene), lamps, samples, options))
        if drawn is None:
            (self.folder / "case.json").write_text(json.dumps(scene))
            done, stats = self.run(["case.json"], lamps, samples, options)
            if "samples are invalid" in done.stderr or "that were invalid" in done.stderr:
                raise Trouble(f"invalid samples with lamps {lamps}")
            if done.returncode != 0:
                raise Trouble(f"exit code {done.returncode}: {done.stderr.strip()}")
            drawn = (self.folder / "case.pfm").read_bytes(), stats[0]
        picture, stats = drawn
        if stats["invalid_samples"] != 0:
            raise Trouble(f"{stats['invalid_samples']} invalid samples with lamps {lamps}")
        numbers = read_pfm(picture)[2]
        return picture, [list(numbers[c::3]) for c in range(3)], stats


def judge(values, expected, what, rounding):
    """Says what is wrong with independent estimates of a number, if anything, and returns (z, relative standard error)."""
    count = len(values)
    mean = statistics.fmean(values)
    error = statistics.stdev(values) / math.sqrt(count)
    apart = max(0.0, abs(mean - expected) - rounding * abs(expected))
    z = apart / error if error > 0 else (math.inf if apart > 0 else 0.0)
    if not z <= Z_MAX:
        raise Trouble(f"{what}: {mean:.9g}, expected {expected:.9g} ({mean / expected - 1 if expected else math.inf:+.3%}), z = {z:.1f}")
    return z, error / abs(expected) if expected else 0.0


def pictures_of(case, on_alone):
    """What run_case will render, if it is right."""
    yield case.scene, "on", case.samples, case.options
    if case.like is not None:
        yield case.like, "on", case.samples, case.options
    if case.chance and not on_alone:
        yield case.scene, "off", case.samples, case.options


def run_case(bench, case, on_alone=False):
    """One line about a case; Trouble where it is wrong."""
    for name, make in case.files.items():
        (bench.folder / name).write_bytes(make())
    on_bytes, on, on_stats = bench.render(case.scene, "on", case.samples, case.options)
    said = []
    if case.sent is not None and on_stats["shadow_rays"] != case.sent * on_stats["samples"]:
        raise Trouble(f"{on_stats['shadow_rays']} rays to lamps for {on_stats['samples']} samples, each of which sends {case.sent}")
    if case.like is not None:
        if bench.render(case.like, "on", case.samples, case.options)[0] != on_bytes:
            raise Trouble("another picture than without the change")
        said.append("same bits")
    if case.exact:
        for c in range(3):
            for value in on[c]:
                if not abs(value - case.expected[c]) <= 1e-6 * case.expected[c]:
                    raise Trouble(f"channel {c}: {value:.9g}, expected {case.expected[c]:.9g}")
        said.append("exact")
    elif case.expected is not None:
        worst = [judge(on[c], case.expected[c], f"lamps on, channel {c}", case.rounding) for c in range(3)]
        error = max(e for _, e in worst)
        if error > PRECISE:
            raise Trouble(f"lamps on: a standard error of {error:.3%}, more than {PRECISE:.1%}")
        said.append(f"on: z {max(z for z, _ in worst):.1f}, error {error:.4%}")
    if on_alone or not case.chance:
        return "; ".join(said)
    off_bytes, off, off_stats = bench.render(case.scene, "off", case.samples, case.options)
    if off_stats["shadow_rays"] != 0:
        raise Trouble(f"{off_stats['shadow_rays']} rays to lamps with lamps off")
    for member in ("rays", "cut_paths"):
        if on_stats[member] != off_stats[member]:
            raise Trouble(f"{member}: {on_stats[member]} with lamps on, {off_stats[member]} with lamps off")
    if case.bits:
        if on_bytes != off_bytes:
            raise Trouble("lamps on and off differ in their bits")
        said.append("on and off: same bits")
    if case.expected is not None and not case.exact:
        worst = [judge(off[c], case.expected[c], f"lamps off, channel {c}", case.rounding) for c in range(3)]
        said.append(f"off: z {max(z for z, _ in worst):.1f}, error {max(e for _, e in worst):.3%}")
    if case.expected is None and not case.bits:
        worst, error = 0.0, 0.0
        for c in range(3):
            middle = statistics.fmean(off[c])
            z, e = judge([middle + a - b for a, b in zip(on[c], off[c])], middle, f"on against off, channel {c}", case.rounding)
            worst, error = max(worst, z), max(error, e)
        if error > BRUTE_PRECISE:
            raise Trouble(f"on against off: a standard error of {error:.3%}, more than {BRUTE_PRECISE:.1%}")
        said.append(f"on - off: z {worst:.1f}, error {error:.3%}")
    return "; ".join(said)


def main():
    program, _, *rest = sys.argv[1:]
    numbered = {**cases.NUMBERED, **disc_cases.NUMBERED, **image_cases.NUMBERED, **motion_cases.NUMBERED, **boundary_cases.NUMBERED,
                **triangle_cases.NUMBERED}
    deep, on_alone = "--deep" in rest, "--on" in rest
    chosen = [word.partition(".") for word in rest if not word.startswith("--")] or [(number, "", "") for number in sorted(numbered)]
    failures = 0
    with tempfile.TemporaryDirectory(prefix="ballpark-lamps-") as folder:
        bench = Bench(program, pathlib.Path(folder), "--own" in rest)
        tried = []
        for number, _, place in chosen:
            made = numbered[int(number)](pathlib.Path(folder))  # one after the other: some closed forms take long
            tried += [(number, case) for case in (itertools.islice(made, int(place) - 1, int(place)) if place else made)
                      if case.deep == deep and not (on_alone and case.expected is None)]
        # Those with files are drawn alone: names of files repeat.
        bench.render_together([one for _, case in tried if not case.files for one in pictures_of(case, on_alone)])
        for number, case in tried:
            try:
                print(f"{number:2} {case.name:58} {run_case(bench, case, on_alone)}", flush=True)
            except Trouble as trouble:
                failures += 1
                print(f"{number:2} {case.name:58} FAILED: {trouble}", flush=True)
                if on_alone:
                    return 1
        print(f"{len(tried)} cases with {bench.pictures} pictures, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
