#!/usr/bin/env python3
"""Kernel against reference on many scenes, judged as one suite.

usage: test_agree.py PROGRAM RESULT.json SAMPLES [--seed N] [--only NAME,... | --without NAME,...] [--device D] SCENE...

Runs `ballpark check` on each scene and collects its report. An inconclusive scene fails. The whole suite rejects a right kernel with probability
1e-3 at most: each scene gets an equal part of it, and each of its four families of tests the part that the
check itself gives it, so the limits here are a little wider than those of a single check. Every scene has a seed of
its own (N, N + 1, ...), so that their errors are independent. --only and --without choose those that are run: two such parts
are one suite, whose seeds and limits are those of all scenes.
"""
import json
import os
import statistics
import subprocess
import sys
import zlib

SUITE_LEVEL = 1e-3
SHARES = {"picture": 0.45, "blocks": 0.45, "picture, squares": 0.05, "blocks, squares": 0.05}


def limit_of(level, tests):
    return statistics.NormalDist().inv_cdf(1 - level / tests / 2)


def check(program, scene, samples, more):
    command = [program, "check", scene, "--spp", str(samples), "--margin", "1", "--quiet", "--json", "-", *more]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 3, 4):
        return None, f"exit code {done.returncode}: {done.stderr.strip()}"
    return json.loads(done.stdout), ""


def judge(report, name, checks, rows):
    """Prints and keeps one check of a scene, of so many at most; returns whether it fails."""
    result = report["results"][0]
    sampled = report["light_sampling"] == "on"
    caustics = report["caustics"] == "on"
    name += " (caustics sampled)" if caustics else " (lights sampled)" if sampled else ""
    level = SUITE_LEVEL / checks
    worst = max(t["z"] / limit_of(level * SHARES[t["family"]], t["tests"]) for t in result["tests"])
    invalid = sum(result["invalid_samples"].values())
    agree = worst <= 1 and invalid == 0 and result["verdict"] != "inconclusive"
    b = result["brightness"]
    interval = f"{b['low']:.5f} .. {b['high']:.5f}" if b["low"] is not None else "-"
    ratio = f"{b['ratio']:.5f}" if b["ratio"] is not None else "-"
    bias = result["smallest_bias"]["value"]
    print(f"{name:32} {worst:11.2f}  {ratio:>9} {interval:>20}  {100 * (bias or 0):8.3f} %"
          + ("" if agree else f"  {result['verdict'].upper()}") + (f"  {invalid} invalid samples" if invalid else ""), flush=True)
    rows.append({"scene": name, "agree": agree, "worst": worst, "width": report["width"],
                 "height": report["height"], "samples": report["samples_per_pixel"], "result": result})
    return not agree


def main():
    program, result_path, samples, *rest = sys.argv[1:]
    more, seed, only, without = [], 1, None, ()
    while rest and rest[0].startswith("--"):
        option, value = rest.pop(0), rest.pop(0)
        if option == "--seed":
            seed = int(value)
        elif option == "--only":
            only = value.split(",")
        elif option == "--without":
            without = value.split(",")
        else:
            more += [option, value]
    names = [os.path.splitext(os.path.basename(scene))[0] for scene in rest]
    if unknown := {*(only or ()), *without} - set(names):
        sys.exit(f"no such scene: {', '.join(sorted(unknown))}")
    rows, failures, tried = [], 0, 0
    checks = len(rest) * (2 if "--caustics" in more else 3)
    print(f"{'scene':32} {'|z| / limit':>11}  {'ratio':>9} {'95 % interval':>20}  {'least bias':>10}")
    for name, scene in zip(names, rest):
        if name in without or only is not None and name not in only:
            continue
        tried += 1
        # A seed of its own, so that scenes that are added change no other's.
        options = [*more, "--seed", str(seed + zlib.crc32(name.encode()))]
        report, trouble = check(program, scene, samples, options)
        for times in (4, 16, 64):  # what is too noisy is judged by more samples
            if report is None or all(one["results"][0]["verdict"] != "inconclusive" for one in report.get("scenes", [report])):
                break
            report, trouble = check(program, scene, times * int(samples), options)
        if report is None:
            failures += 1
            print(f"{name:32} FAILED: {trouble}")
            rows.append({"scene": name, "error": trouble})
            continue
        for one in report.get("scenes", [report]):  # without and with light sampling, also by way of spheres, where the scene calls for it
            failures += judge(one, name, checks, rows)
    with open(result_path, "w", encoding="utf-8") as file:
        json.dump({"level": SUITE_LEVEL, "scenes": rows}, file, indent=1)
    print(f"{tried} scenes, {failures} disagree or fail (a right kernel is rejected with probability "
          f"{SUITE_LEVEL} at most)")
    return 1 if failures else 0


sys.exit(main())
