#!/usr/bin/env python3
"""The gate against lost speed: ballpark over the book's algorithm in scalar C, in the same run.

usage: test_gate.py PROGRAM BOOK_PEER [--record] [--demand FACTOR]

Both take turns; rates are ray segments for a second of processor time, so that other work on the machine hardly
shows, and the figure judged is the median of the rounds' ratios. It fails when a ratio lies below its bound, twice.

On a processor that is recorded (recorded.json) the bound is 15 % below the recorded ratio. Records go by the device's
name and the processor's family and model, since a ratio belongs to a machine, and hypervisors give many the same name.
--record writes this machine's; do so when ballpark became faster.

Anywhere else the bound is one that no processor should miss. Ballpark is faster than the book's tree because it visits
fewer nodes, which is the same everywhere, and because lanes work side by side, which is as good as the vectors are
wide. With vectors of 256 bits and a fused multiply-add (PoCL told that it runs on a Haswell) the ratios were 4.1, 2.1
and 7.0; vectors of half that width, which every x86-64 and AArch64 has, can at most halve them: that is the bound where
the processor has the instruction. Without it, fma() is a function in software, and the ratios were 0.30, 0.28 and 0.73
(PoCL told that it runs on an Athlon 64): the bound is half of that.

--demand multiplies the ratios that are recorded, or else those just measured, and then exits with 0 only if the gate
fails: the test of the gate. Exit code 77: there is no processor to measure.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

FUSED, UNFUSED = "anywhere with a fused multiply-add", "anywhere"
RECORDS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "recorded.json")
LOSS = .15
ROUNDS = 5
SECONDS = .25  # of processor time a core, a run
CASES = [("cover", "packet"), ("cover", "sample"), ("field-1e4", "packet")]


def call(command):
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def processor():
    """Which one it is, in numbers: its maker's, on x86 or Arm; "" where the system does not tell."""
    wanted = ("vendor_id", "cpu family", "model", "CPU implementer", "CPU part")
    try:
        with open("/proc/cpuinfo") as file:
            first = file.read().split("\n\n")[0]
    except OSError:
        return ""
    lines = [[part.strip() for part in line.partition(":")[::2]] for line in first.splitlines()]
    return "".join(f", {name} {value}" for name, value in lines if name in wanted)


def has_fused_multiply_add():
    """Every AArch64 has it; an x86 says so."""
    try:
        with open("/proc/cpuinfo") as file:
            words = file.read().split()
    except OSError:
        return False
    return "fma" in words or "fma4" in words or os.uname().machine == "aarch64"


def rate_of_ours(program, path, kernel):
    report = call([program, "bench", path, "--kernel", kernel, "--sampler", "independent", "--device", "cpu", "--rounds",
                   "1", "--time", str(SECONDS), "--quiet", "--json", "-"])
    device = f"{report['device']['name']}, {report['device']['platform']} {report['device']['driver']}{processor()}"
    return 1e9 / report["scenes"][0]["cpu_nanoseconds_per_segment"]["median"], device


class Book:
    def __init__(self, peer, path):
        self.command = [peer, path, "--method", "tree", "--spp"]
        first = call(self.command + ["1"])
        self.samples = max(1, round(SECONDS * first["threads"] / first["cpu_seconds"]))

    def rate(self):
        figures = call(self.command + [str(self.samples)])
        return figures["rays"] / figures["cpu_seconds"]


def measure(program, peer, paths, rounds=ROUNDS):
    books = {scene: Book(peer, path) for scene, path in paths.items()}
    ratios = {case: [] for case in CASES}
    for scene, kernel in CASES:
        rate_of_ours(program, paths[scene], kernel)  # PoCL compiles at a kernel's first run
    for _ in range(rounds):
        yardsticks = {scene: book.rate() for scene, book in books.items()}
        for case in CASES:
            rate, device = rate_of_ours(program, paths[case[0]], case[1])
            ratios[case].append(rate / yardsticks[case[0]])
    return {f"{scene} {kernel}": statistics.median(r) for (scene, kernel), r in ratios.items()}, device


def lost(ratios, bounds):
    return [name for name, ratio in ratios.items() if ratio < bounds[name]]


def main():
    program, peer = sys.argv[1:3]
    options = sys.argv[3:]
    demand = float(options[options.index("--demand") + 1]) if "--demand" in options else 1.0
    with open(RECORDS) as file:
        records = json.load(file)
    if b"CPU" not in subprocess.run([program, "devices"], capture_output=True).stdout:
        print("skipped: no OpenCL driver for the processor is installed")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        scenes = sorted({scene for scene, _ in CASES})
        subprocess.run([program, "bench", *scenes, "--output", folder], check=True)
        paths = {scene: os.path.join(folder, scene + ".json") for scene in scenes}
        ratios, device = measure(program, peer, paths, ROUNDS if demand == 1 else 1)
        print(f"device: {device}")
        if "--record" in options:
            records[device] = {name: round(ratio, 2) for name, ratio in ratios.items()}
            with open(RECORDS, "w") as file:
                json.dump(records, file, indent=2)
                file.write("\n")
            print(f"recorded {records[device]}")
            return 0
        if demand != 1:
            bounds = {name: (1 - LOSS) * demand * ratio for name, ratio in records.get(device, ratios).items()}
            ratios, _ = measure(program, peer, paths, 1)
        elif device in records:
            bounds = {name: (1 - LOSS) * ratio for name, ratio in records[device].items()}
        else:
            bounds = records[FUSED if has_fused_multiply_add() else UNFUSED]
            print("this processor is not recorded (test_gate.py --record does it): judged by what holds anywhere")
        for attempt in (1, 2):
            for name, ratio in ratios.items():
                print(f"{name}: {ratio:.2f} times the book's tree, at least {bounds[name]:.2f} is asked")
            if demand != 1 or not lost(ratios, bounds):
                break
            if attempt == 1:
                print("once more, to be sure")
                ratios, _ = measure(program, peer, paths)
    slower = lost(ratios, bounds)
    if slower:
        print(f"too slow: {', '.join(slower)}")
    return int(bool(slower)) if demand == 1 else int(not slower)


sys.exit(main())
