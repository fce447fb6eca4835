"""Whole pictures with light sampling and without: the same light, the same paths; and no bit depends on the kernel's form.

    test_lamp_pairs.py PROGRAM SOURCE_DIR [--deep] [NAME...]

Each scene (lamp_scenes.py) is drawn with the same seed with lamps on, off, and on in the other form of the kernel.
Asked are: as many ray segments and cut paths on as off; the same sums in both forms; and that on minus off is 0 in the mean,
for each channel of the whole picture and of 3 x 2 blocks of it. The error bar of that difference comes from the four
replicates of each pixel, which are independent of each other: the spread of their differences, three degrees of
freedom a pixel. A difference is wrong beyond Z_MAX standard errors, which some 700 such tests of a right program reach by
chance with a probability of 1e-4. What a scene's picture shows of a bias with 90 % probability, 6.5 standard errors, is
printed. A block in which chance found next to nothing is not judged. With --deep: every scene, 16 times the samples, and
the generated ones against the reference tracer, which samples no lamps, by `ballpark check`: its test of the means of the
whole picture. Its other tests ask for equal spreads and enough light everywhere, which chance does not have.
Some scenes without lamps are drawn with lamps on and off: no bit may differ.
"""
import array
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import bpa
import lamp_scenes

Z_MAX = 5.2
ROUNDING = 2e-5
BLOCKS = (3, 2)
QUICK = ["lamps", "metals", "crowd-of-lamps", "twins", "discs"]
QUICK_DARK = ["v4-10-lambertian", "v1-red-sphere"]
# Where chance varies in fewer pixels than these, it found too little to say how much it missed.
LIVELY = 30
# With so little found by chance, differences are no news: the largest bias that must be found in a picture, deep.
FOUND_MAX = 0.10
# A disc that chance finds too seldom for that; tests/lamps/disc_cases.py compares such with closed forms.
TOO_SMALL = {"studio"}


class Trouble(Exception):
    pass


class Sums:
    """A .bpa file: its header, and what stands behind it."""

    def __init__(self, path):
        self.header, arrays = bpa.read(path.read_bytes())
        self.body = [arrays[name] for name in ("sums", "fine_sums", "counts") if name in arrays]
        numbers = array.array("q", arrays["sums"])
        if sys.byteorder == "big":
            numbers.byteswap()
        unit = 2.0 ** -self.header["scale_log2"]
        if "fine_sums" in arrays:
            fine = array.array("q", arrays["fine_sums"])
            if sys.byteorder == "big":
                fine.byteswap()
            self.values = [(a + b * 2.0 ** -38) * unit for a, b in zip(numbers, fine)]
        else:
            self.values = [a * unit for a in numbers]


def run(program, command, folder, scenes, *options):
    """The exit code, what was written to standard output, and what to standard error."""
    done = subprocess.run([program, command, *map(str, scenes), "--quiet", "--effects", "all", "--width", "24", *options],
                          cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr.strip()


def render(program, folder, scenes, lamps, samples, *options):
    """{scene: (sums, statistics) or Trouble}. All in one run, since starting the program takes longer than drawing a scene; where
    that fails, one by one."""
    code, _, errors = run(program, "render", folder, scenes, "--light-sampling", lamps, "--seed", "11", "--spp", str(samples), "-o", "./",
                          "--format", "bpa", "--stats", "pair-stats.json", *options)
    if "that were invalid" in errors and len(scenes) == 1:
        return {scenes[0]: Trouble(f"invalid samples with lamps {lamps}: {errors}")}
    if code != 0 and len(scenes) == 1:
        return {scenes[0]: Trouble(f"exit code {code}: {errors}")}
    if code != 0:
        return {scene: drawn for each in scenes
                for scene, drawn in render(program, folder, [each], lamps, samples, *options).items()}
    stats = json.loads((folder / "pair-stats.json").read_text())
    drawn = {}
    for scene, one in zip(scenes, stats["renders"] if len(scenes) > 1 else [stats]):
        drawn[scene] = (Sums(folder / f"{scene.stem}.bpa"), one)
        if one["invalid_samples"] != 0:
            drawn[scene] = Trouble(f"{one['invalid_samples']} invalid samples with lamps {lamps}")
    return drawn


def check(program, folder, scenes):
    """{scene: the verdict of `ballpark check`, or Trouble}"""
    code, written, errors = run(program, "check", folder, scenes, "--light-sampling", "on", "--spp", "512", "--seed", "12", "--json", "-")
    if code in (0, 3, 4):
        return dict(zip(scenes, json.loads(written)["results"]))
    if len(scenes) == 1:
        return {scenes[0]: Trouble(f"check: exit code {code}: {errors}")}
    return {scene: verdict for each in scenes for scene, verdict in check(program, folder, [each]).items()}


def found_for(scene, drawn):
    if isinstance(drawn[scene], Trouble):
        raise drawn[scene]
    return drawn[scene]


def compare(on, off, samples):
    """The worst z of on minus off, and the share of the picture's mean that would have been found."""
    width, height, replicates = (on.header[name] for name in ("width", "height", "replicates"))
    columns, rows = BLOCKS
    cells = {}
    for y in range(height):
        for x in range(width):
            at = (y * width + x) * replicates * 3
            for c in range(3):
                pairs = [(on.values[at + 3 * r + c], off.values[at + 3 * r + c]) for r in range(replicates)]
                apart = [(a - b) * replicates / samples for a, b in pairs]
                mean = sum(apart) / replicates
                variance = sum((d - mean) ** 2 for d in apart) / (replicates - 1) / replicates
                level = sum(b for _, b in pairs) / samples
                lively = len({b for _, b in pairs}) > 1
                for block in ("picture", (x * columns // width, y * rows // height)):
                    cell = cells.setdefault((block, c), [0, 0.0, 0.0, 0.0, 0])
                    cell[0] += 1
                    cell[1] += mean
                    cell[2] += variance
                    cell[3] += level
                    cell[4] += lively
    worst, found, where = 0.0, 0.0, ""
    for (block, c), (count, total, variance, level, lively) in cells.items():
        if lively < LIVELY:
            continue
        rest = max(0.0, abs(total) - ROUNDING * level)
        z = rest / math.sqrt(variance) if variance > 0 else (math.inf if rest > 0 else 0.0)
        if z > worst:
            worst = z
            where = f"{block}, channel {c}: {total / count:+.3g} on {level / count:.3g}"
        if block == "picture" and level > 0:
            found = max(found, (Z_MAX + 1.28) * math.sqrt(variance) / level)
    return worst, found, where


def judge(scene, pictures, verdicts, samples, deep):
    """One line about a scene; Trouble where it is wrong."""
    (on, on_stats), (off, off_stats), one, other = (found_for(scene, drawn) for drawn in pictures)
    if on_stats["light_sampling"] != "on" or off_stats["light_sampling"] != "off":
        raise Trouble(f"lamps {on_stats['lamps']} and {off_stats['lamps']}")
    if off_stats["shadow_rays"] != 0 or on_stats["shadow_rays"] == 0:
        raise Trouble(f"{on_stats['shadow_rays']} rays to lamps with lamps on, {off_stats['shadow_rays']} with lamps off")
    if one[1]["shadow_rays"] != other[1]["shadow_rays"]:
        raise Trouble("the numbers of rays to lamps differ between the forms of the kernel")
    for member in ("rays", "cut_paths"):
        if on_stats[member] != off_stats[member]:
            raise Trouble(f"{member}: {on_stats[member]} with lamps on, {off_stats[member]} with lamps off")
        if one[1][member] != other[1][member]:
            raise Trouble(f"{member} differ between the forms of the kernel")
    if one[0].body != other[0].body:
        raise Trouble("the forms of the kernel differ")
    z, found, where = compare(on, off, samples)
    if not z <= Z_MAX:
        raise Trouble(f"on minus off: z = {z:.1f} ({where})")
    if deep and found > FOUND_MAX and scene.stem not in TOO_SMALL:
        raise Trouble(f"a bias below {found:.1%} would not be found")
    said = ""
    if scene in verdicts:
        verdict = found_for(scene, verdicts)
        means = next(test["z"] for test in verdict["tests"] if test["family"] == "picture")
        if not means <= Z_MAX:
            raise Trouble(f"against the reference: z = {means:.1f}")
        said = f"; reference: z {means:.1f}, {verdict['brightness']['ratio']:.4f} as bright"
    return f"on - off: z {z:.1f}; finds {found:.2%}; noise {on_stats['nrmse']:.3f} for {off_stats['nrmse']:.3f}{said}"


def main():
    program, source, *rest = sys.argv[1:]
    program, deep = os.path.abspath(program), "--deep" in rest
    lit, dark = lamp_scenes.in_files(source)
    every = {path.stem: path.resolve() for path in lit}
    named = [word for word in rest if word != "--deep"]
    names = named or ([*every, *lamp_scenes.GENERATED] if deep else QUICK)
    samples = 4096 if deep else 256
    failures = 0
    with tempfile.TemporaryDirectory(prefix="ballpark-lamps-") as folder:
        folder = pathlib.Path(folder)
        scenes, made = [], []
        for name in names:
            if name not in every:
                made.append(folder / f"{name}.json")
                made[-1].write_text(json.dumps(lamp_scenes.generated(name)))
            scenes.append(every[name] if name in every else made[-1])
        on, off = (render(program, folder, scenes, lamps, samples) for lamps in ("on", "off"))
        if deep:
            one, other = (render(program, folder, scenes, "on", 32, "--kernel", form) for form in ("packet", "sample"))
        else:
            one, other = on, render(program, folder, scenes, "on", samples, "--kernel", "sample")
        verdicts = check(program, folder, made) if deep and made else {}
        for scene in scenes:
            try:
                print(f"{scene.stem:20} {judge(scene, (on, off, one, other), verdicts, samples, deep)}", flush=True)
            except Trouble as trouble:
                failures += 1
                print(f"{scene.stem:20} FAILED: {trouble}", flush=True)
        dark = [] if named else [path.resolve() for path in (dark[::5] if deep else dark) if deep or path.stem in QUICK_DARK]
        on, off = (render(program, folder, dark, lamps, 8) if dark else {} for lamps in ("on", "off"))
        for scene in dark:
            try:
                (on_sums, on_stats), (off_sums, _) = found_for(scene, on), found_for(scene, off)
                if on_sums.body != off_sums.body or on_stats["light_sampling"] != "off":
                    raise Trouble("lamps on and off differ, without a lamp")
            except Trouble as trouble:
                failures += 1
                print(f"{scene.stem:20} FAILED: {trouble}", flush=True)
    count = len(scenes) + len(dark)
    print(f"{count} scenes, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
