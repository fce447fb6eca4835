#!/usr/bin/env python3
"""The gate against lost speed: ballpark over the book's algorithm in scalar C, in the same run.

usage: gate.py PROGRAM BOOK_PEER [--record] [--demand FACTOR]

Both take turns; rates are ray segments for a second of processor time, so that other work on the machine hardly
shows, and the figure judged is the median of the rounds' ratios. It fails when a ratio lies more than 15 % below the
recorded one, twice. The records (recorded.json) go by the device's name and the processor's family and model, since a
ratio belongs to a machine, and hypervisors give many the same name: where none is recorded, nothing is judged and the
exit code is 77. --record writes this machine's; do so when ballpark became faster.
--demand multiplies the records, and then exits with 0 only if the gate fails: the test of the gate.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

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
    for _ in range(rounds):
        yardsticks = {scene: book.rate() for scene, book in books.items()}
        for case in CASES:
            rate, device = rate_of_ours(program, paths[case[0]], case[1])
            ratios[case].append(rate / yardsticks[case[0]])
    return {f"{scene} {kernel}": statistics.median(r) for (scene, kernel), r in ratios.items()}, device


def lost(ratios, recorded):
    return [name for name, ratio in ratios.items() if name in recorded and ratio < (1 - LOSS) * recorded[name]]


def main():
    program, peer = sys.argv[1:3]
    options = sys.argv[3:]
    demand = float(options[options.index("--demand") + 1]) if "--demand" in options else 1.0
    with open(RECORDS) as file:
        records = json.load(file)
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
        if device not in records:
            print(f"no record for this device; ratios now: {ratios}. gate.py --record makes one")
            return 77
        recorded = {name: demand * ratio for name, ratio in records[device].items()}
        for attempt in (1, 2):
            for name, ratio in ratios.items():
                print(f"{name}: {ratio:.2f} times the book's tree, recorded {recorded.get(name, float('nan')):.2f}")
            if not lost(ratios, recorded):
                break
            if attempt == 1 and demand == 1:
                print("once more, to be sure")
                ratios, _ = measure(program, peer, paths)
    slower = lost(ratios, recorded)
    if slower:
        print(f"more than {LOSS:.0%} lost: {', '.join(slower)}")
    return int(bool(slower)) if demand == 1 else int(not slower)


sys.exit(main())
