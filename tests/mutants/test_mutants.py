#!/usr/bin/env python3
"""Every known bug must be found: applies each mutant to a copy of the product's text, builds what is needed, runs its
trials, and fails when one survives. What was not killed is named once more at the end.

usage: test_mutants.py SOURCE_DIR BUILD_DIR RESULT.json [NAME...]
       test_mutants.py --changed SOURCE_DIR BUILD_DIR RESULT.json    those whose texts changed since their kept kill, and an eighth
       test_mutants.py --keep SOURCE_DIR BUILD_DIR RESULT.json       all, and keeps the kills in tests/mutants/kills.json
       test_mutants.py --fit SOURCE_DIR BUILD_DIR                    only whether every patch still finds its place

Kernel text is patched in a copy that the program reads through BALLPARK_KERNELS. Host text is patched in a copy,
compiled with the command that built the product, and linked before the library. A build that fails, a crash, or a
text that no longer stands where a patch looks for it is an error, not a kill. Before the first mutant of a trial, the
trial is run on the product unpatched: there it must pass. These runs share a kernel cache, one at a time, so that they
compile each kernel once. A mutant is tried with a copy of what its trial used of that cache, so that only the kernels that
its patch changes are compiled.

A trial is no more than what finds the bug: one case of a test program, and as few samples as are needed. Most of the time
goes into compiling kernels. A bug does not depend on how well it is compiled, so PoCL optimises nothing, in the control
too: that takes a quarter less time. Where a small kernel runs for long, it optimises: such a trial then takes a fifth.
"""
import concurrent.futures
import glob
import json
import os
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import kills
from mutants import MUTANTS, Check, Lister, Program, Script

SURVIVED, KILLED, ERROR = "SURVIVED", "killed", "ERROR"
RUN_LONG = ("test_lobes", "test_kernel_samplers", "tests/unseen/test_unseen_means.py")  # longer than they compile
TEXT_MODULE = "ballpark_text.so"
LONGEST = 10  # mutants, that whoever adds a long one sees it


def environment_of(cache):
    """Names the folder of a kernel cache to drivers, and asks for kernels that are compiled soon."""
    return {"POCL_CACHE_DIR": cache, "MESA_SHADER_CACHE_DIR": cache, "POCL_EXTRA_BUILD_FLAGS": "-cl-opt-disable"}


def used_since(cache, start):
    """The programs in a kernel cache of PoCL, XX/YYY each, that were compiled or found there since a time."""
    marks = glob.glob(os.path.join(cache, "*", "*", "last_accessed"))
    return [os.path.relpath(os.path.dirname(mark), cache) for mark in marks if os.stat(mark).st_mtime >= start]


def copy_program(source, target):
    """What is compiled by links, which cost next to nothing: it is written once. The rest is small."""
    for folder, _, names in os.walk(source):
        there = os.path.join(target, os.path.relpath(folder, source))
        os.makedirs(there, exist_ok=True)
        for name in names:
            one, other = os.path.join(folder, name), os.path.join(there, name)
            if name.endswith((".bc", ".so")) and not os.path.lexists(other):
                os.link(one, other)
            elif not name.endswith((".bc", ".so")):
                shutil.copyfile(one, other)


class Bench:
    """Where one mutant, or the product itself, is made and tried: a scratch folder and a kernel cache of its own."""

    def __init__(self, source, build, folder):
        self.source, self.build, self.scratch = source, build, os.path.join(folder, "mutant")
        os.mkdir(self.scratch)
        self.cache = os.path.join(folder, "cache")
        os.mkdir(self.cache)
        self.environment = {**os.environ, **environment_of(self.cache)}
        if os.path.exists(os.path.join(build, TEXT_MODULE)):  # a relinked program has another folder
            self.environment["BALLPARK_TEXT"] = os.path.join(build, TEXT_MODULE)
        with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
            self.compile = {os.path.realpath(e["file"]): e for e in json.load(file)}

    def texts_of(self, path):
        """{path: text} of a host file, or of all kernel files."""
        paths = [path]
        if path == "kernels":
            top = os.path.join(self.source, path)
            paths = [os.path.relpath(os.path.join(folder, name), self.source)
                     for folder, _, names in sorted(os.walk(top)) for name in sorted(names)]
        texts = {}
        for one in paths:
            with open(os.path.join(self.source, one), encoding="utf-8") as file:
                texts[one] = file.read()
        return texts

    def patched_texts(self, mutant):
        """{path: text} of the files that the patches change."""
        texts, changed = {}, {}
        for path, find, replace in mutant.patches:
            for one, text in self.texts_of(path).items():
                texts.setdefault(one, text)
            holders = [one for one, text in texts.items() if one.startswith(path) and find in text]
            if len(holders) != 1 or texts[holders[0]].count(find) != 1:
                raise LookupError(f"{path} does not hold exactly once: {find}")
            texts[holders[0]] = changed[holders[0]] = texts[holders[0]].replace(find, replace)
        return changed

    def link_command(self, target):
        listed = subprocess.run(["ninja", "-C", self.build, "-t", "commands", target], capture_output=True, text=True,
                                check=True).stdout
        return shlex.split(listed.splitlines()[-1].split(" && ")[1])

    def relink(self, target, objects):
        """The program `target` with objects replaced: those of the library by others before it. Returns its path."""
        words = self.link_command(target)
        made = os.path.join(self.scratch, os.path.basename(target))
        words[words.index("-o") + 1] = made
        words = [word for word in words if word not in objects]
        library = next(i for i, w in enumerate(words) if w.endswith("libballpark.a"))
        words[library:library] = objects.values()
        subprocess.run(words, cwd=self.build, check=True, capture_output=True, text=True, errors="replace")
        return made

    def relink_module(self, objects):
        """The module that draws text, of other objects. Returns its path."""
        words = [objects.get(word, word) for word in self.link_command(TEXT_MODULE)]
        made = words[words.index("-o") + 1] = os.path.join(self.scratch, TEXT_MODULE)
        subprocess.run(words, cwd=self.build, check=True, capture_output=True, text=True, errors="replace")
        return made

    def make(self, mutant):
        """Writes the mutant. Returns (environment, objects): where the kernels are, {object of the product: what replaces it}."""
        environment, objects = dict(self.environment), {}
        texts = self.patched_texts(mutant)
        if any(path.startswith("kernels/") for path in texts):
            folder = os.path.join(self.scratch, "kernels")
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(os.path.join(self.source, "kernels"), folder)
            environment["BALLPARK_KERNELS"] = folder
        for path, text in texts.items():
            if path.startswith("kernels/"):
                with open(os.path.join(self.scratch, path), "w", encoding="utf-8") as file:
                    file.write(text)
                continue
            entry = self.compile[os.path.join(self.source, path)]
            words = shlex.split(entry["command"])
            copy = os.path.join(self.scratch, os.path.basename(path))
            with open(copy, "w", encoding="utf-8") as file:
                file.write(text)
            made, place = copy + ".o", words.index("-o") + 1
            objects[words[place]] = made
            words[place] = made
            words = [copy if os.path.realpath(w) == os.path.join(self.source, path) else w for w in words]
            words.append("-iquote" + os.path.join(self.source, os.path.dirname(path)))
            # Headers named relative to the file: "../base/status.h".
            for sibling in os.listdir(os.path.join(self.source, "host")):
                link = os.path.join(os.path.dirname(self.scratch), sibling)
                if not os.path.lexists(link):
                    os.symlink(os.path.join(self.source, "host", sibling), link)
            subprocess.run(words, cwd=entry["directory"], check=True, capture_output=True, text=True, errors="replace")
        return environment, objects

    def run_check(self, trial, environment, program):
        book = trial.scene.startswith("book:")
        folder = os.path.join(self.source, "scenes" if book else "tests/agree/scenes")
        scene = os.path.join(folder, trial.scene.removeprefix("book:") + ".json")
        command = [program, "check", scene, "--spp", str(trial.samples), "--seed", "1", "--quiet", "--json", "-",
                   *trial.options]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, errors="replace", timeout=300)
        if done.returncode not in (0, 3, 4):
            return ERROR, f"exit code {done.returncode}: {done.stderr.strip()[:300]}"
        report = json.loads(done.stdout)
        # Without and with light sampling, where the scene calls for it: the one that disagrees, else the first.
        results = [scene["results"][0] for scene in report.get("scenes", [report])]
        result = next((r for r in results if r["verdict"] == "disagree"), results[0])
        worst = max(result["tests"], key=lambda t: t["z"] / t["limit"])
        z = "infinite" if worst["z"] >= 1e6 else f"= {worst['z']:.1f}"
        said = f"z {z}, limit {worst['limit']:.1f} ({worst['family']})"
        invalid = result["invalid_samples"]["kernel"]
        if invalid:
            said += f", {invalid} invalid samples"
        # Too few samples for evidence of equality are no kill: a verdict of disagreement is.
        return (KILLED if result["verdict"] == "disagree" else SURVIVED), said

    def run_test(self, trial, environment, program):
        done = subprocess.run([program], env={**environment, "BALLPARK_TEST_CASE": trial.case}, capture_output=True, text=True,
                              errors="replace", timeout=300)
        if done.returncode < 0:
            return ERROR, f"crashed with signal {-done.returncode}"
        if done.returncode == 77:
            return ERROR, "the test was skipped"
        said = (done.stdout + done.stderr).splitlines()
        if f"[ RUN      ] {trial.case}" not in said:
            return ERROR, "the test program has no such case"
        if done.returncode == 0:
            return SURVIVED, "passed"
        failed = f"[  FAILED  ] {trial.case}" in said
        return (KILLED, "failed") if failed else (ERROR, f"exit code {done.returncode}, though the case did not fail")

    def run_script(self, trial, environment, program):
        """A line with FAILED says what is wrong. That the program ends with an exit code of its own is no kill."""
        environment = {**environment, "PYTHONPATH": os.path.join(self.source, "tests/support")}
        command = [sys.executable, "-B", os.path.join(self.source, trial.path), program, self.source, *trial.arguments]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, errors="replace", timeout=300)
        if done.returncode == 0:
            return SURVIVED, "passed"
        failed = [line for line in done.stdout.splitlines() if "FAILED: " in line and "exit code" not in line]
        if done.returncode != 1 or not failed:
            return ERROR, (done.stdout + done.stderr).strip()[-300:]
        return KILLED, " ".join(failed[0].split())[:160]

    def run_program(self, trial, environment, program):
        """One without cases, whose exit code is 1 where it found something wrong."""
        done = subprocess.run([program, *trial.arguments], env=environment, capture_output=True, text=True, errors="replace",
                              timeout=300)
        if done.returncode == 0:
            return SURVIVED, "passed"
        return (KILLED, "failed") if done.returncode == 1 else (ERROR, f"exit code {done.returncode}: {done.stderr.strip()[:300]}")

    def run_lister(self, trial, environment, program):
        """Tests in Python of a program that answers questions about files."""
        environment = {**environment, "PYTHONPATH": os.path.join(self.source, "tests/support")}
        command = [sys.executable, "-B", os.path.join(self.source, trial.path), program, *trial.arguments]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, errors="replace", timeout=300)
        if done.returncode == 0:
            return SURVIVED, "passed"
        failed = [line for line in done.stderr.splitlines() if line.startswith("AssertionError: ")]
        if done.returncode != 1 or not failed:
            return ERROR, (done.stdout + done.stderr).strip()[-300:]
        return KILLED, failed[0][:160]

    def run(self, trial, environment, objects):
        way = {Check: self.run_check, Script: self.run_script, Program: self.run_program, Lister: self.run_lister}.get(type(trial), self.run_test)
        target = f"tests/{trial.program}" if hasattr(trial, "program") else "ballpark"
        of_module = {old: new for old, new in dict(objects).items() if "/ballpark_text.dir/" in old}
        if of_module:  # the program stays
            environment = {**environment, "BALLPARK_TEXT": self.relink_module(of_module)}
            objects = {old: new for old, new in objects.items() if old not in of_module}
        program = self.relink(target, objects) if objects else os.path.join(self.build, target)
        if getattr(trial, "program", getattr(trial, "path", "")) in RUN_LONG:
            environment = {**environment, "POCL_EXTRA_BUILD_FLAGS": ""}
        return way(trial, environment, program)


def name_of(trial):
    if isinstance(trial, Check):
        return f"{trial.scene}, {trial.samples} samples"
    if isinstance(trial, (Script, Lister)):
        return f"{os.path.basename(trial.path)} {' '.join(trial.arguments)}"
    if isinstance(trial, Program):
        return " ".join((trial.program, *trial.arguments))
    return f"{trial.program}, {trial.case}"


class Controls:
    """Trials on the product itself, each run once, when a mutant first asks for it, in the kernel cache of these tests' turn, or
    in one of its own where the environment names none."""

    def __init__(self, source, build, folder):
        self.source, self.build = source, build
        self.cache = os.environ.get("POCL_CACHE_DIR") or os.path.join(folder, "cache")
        os.makedirs(self.cache, exist_ok=True)
        self.lock = threading.Lock()
        self.results = {}  # trial: (outcome, what was said, the programs that it used)

    def of(self, trial, cache):
        """What the trial says of the product; copies the kernels that it used into the folder `cache`."""
        with self.lock:
            if trial not in self.results:
                start = time.time() - 1  # the clock of files is a little behind
                with tempfile.TemporaryDirectory() as folder:
                    bench = Bench(self.source, self.build, folder)
                    environment = {**bench.environment, **environment_of(self.cache)}
                    try:
                        outcome, said = bench.run(trial, environment, [])
                    except subprocess.TimeoutExpired:
                        outcome, said = ERROR, "it did not end"
                self.results[trial] = outcome, said, used_since(self.cache, start)
            outcome, said, programs = self.results[trial]
            for program in programs:
                copy_program(os.path.join(self.cache, program), os.path.join(cache, program))
            return outcome, said

    def failures(self):
        """A line for each trial that fails on the product."""
        return [f"CONTROL {outcome}: {name_of(trial)}: {said}" for trial, (outcome, said, _) in self.results.items()
                if outcome != SURVIVED]


def try_mutant(bench, mutant, controls):
    outcome, said, trial = ERROR, "", None
    try:
        environment, objects = bench.make(mutant)
        for trial in mutant.trials:
            outcome, said = controls.of(trial, bench.cache)
            if outcome != SURVIVED:  # a trial that fails on the product kills nothing
                outcome, said = ERROR, "the trial fails on the product itself"
                break
            outcome, said = bench.run(trial, environment, objects)
            if outcome != SURVIVED:
                break
    except LookupError as error:
        outcome, said = ERROR, str(error)
    except subprocess.CalledProcessError as error:
        outcome, said = ERROR, "it does not build: " + error.stderr.strip()[:300]
    except subprocess.TimeoutExpired:
        outcome, said = ERROR, "it did not end"
    return {"name": mutant.name, "origin": mutant.origin, "outcome": outcome, "said": said, "layer": trial.layer if trial else "",
            "trial": name_of(trial) if trial else ""}


def fit(source, build):
    """Names the mutants whose patches no longer find their place."""
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(source, build, folder)
        for mutant in MUTANTS:
            try:
                bench.patched_texts(mutant)
            except LookupError as error:
                wrong += 1
                print(f"{mutant.name}: {error}; bring tests/mutants/mutants.py up to date")
    print(f"{len(MUTANTS) - wrong} of {len(MUTANTS)} mutants fit")
    return 1 if wrong else 0


def try_all(source, build, mutants, controls):
    """Their results, in order; a few are tried at a time, each with a bench of its own."""

    def one(mutant):
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            row = try_mutant(Bench(source, build, folder), mutant, controls)
        return {**row, "seconds": round(time.monotonic() - start, 1)}

    with concurrent.futures.ThreadPoolExecutor(max_workers=min(4, os.cpu_count() or 1)) as pool:
        yield from pool.map(one, mutants)


def line_of(row):
    return f"{row['outcome']:8} {row['name']:46} {row['layer']:12} {row['trial']}: {row['said']}"


def last_words(rows, failed_controls):
    """What was not killed, and what failed on the product itself, named once more where whoever sees only the end sees it."""
    left = [row for row in rows if row["outcome"] != KILLED]
    return [*failed_controls, *([f"{len(left)} mutants were not killed:"] if left else []), *map(line_of, left)]


def fingerprints_of(source, build):
    """{name: fingerprint} of all mutants that fit; one that does not is an error where it is tried."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(source, build, folder)
        fingerprints = kills.Fingerprints(source, list(bench.compile.values()))
        for mutant in MUTANTS:
            try:
                found[mutant.name] = fingerprints.of(mutant, bench.patched_texts(mutant))
            except LookupError:
                pass
    return found


def chosen(mutants, fingerprints, kept, commit):
    """Those that are tried: without a kill that still stands, or having their turn."""
    return [m for m in mutants
            if m.name not in fingerprints or kept.get(m.name) != fingerprints[m.name] or kills.has_its_turn(m.name, commit)]


def main():
    if sys.argv[1] == "--fit":
        return fit(os.path.realpath(sys.argv[2]), os.path.realpath(sys.argv[3]))
    options = [argument for argument in sys.argv[1:] if argument in ("--changed", "--keep")]
    source, build, result_path, *names = [argument for argument in sys.argv[1:] if argument not in options]
    source, build = os.path.realpath(source), os.path.realpath(build)
    kept_path = os.path.join(source, "tests/mutants/kills.json")
    mutants = [m for m in MUTANTS if not names or m.name in names]
    if unknown := set(names) - {m.name for m in mutants}:
        sys.exit(f"no such mutant: {', '.join(sorted(unknown))}")
    fingerprints = fingerprints_of(source, build)
    if "--changed" in options:
        mutants = chosen(mutants, fingerprints, kills.load(kept_path), kills.commit_of(source))
    start = time.monotonic()
    rows = []
    with tempfile.TemporaryDirectory() as kept:
        controls = Controls(source, build, kept)
        for row in try_all(source, build, mutants, controls):
            rows.append(row)
            print(line_of(row), flush=True)
        wrong = controls.failures()
    killed = sum(row["outcome"] == KILLED for row in rows)
    with open(result_path, "w", encoding="utf-8") as file:
        json.dump({"mutants": rows, "control_failures": len(wrong)}, file, indent=1)
    if "--keep" in options:
        kills.save(kept_path, {row["name"]: fingerprints[row["name"]] for row in rows if row["outcome"] == KILLED})
    longest = sorted(rows, key=lambda row: -row["seconds"])[:LONGEST]
    print("longest:", ", ".join(f"{row['name']} {row['seconds']:.0f} s" for row in longest))
    for line in last_words(rows, wrong):
        print(line)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    left_out = f" ({len(MUTANTS) - len(rows)} stand by their kept kills)" if "--changed" in options else ""
    print(f"{killed} of {len(rows)} mutants killed{left_out} in {time.monotonic() - start:.0f} s, "
          f"{used.ru_utime + used.ru_stime:.0f} s of processor time; {len(wrong)} trials fail on the product itself")
    return 0 if killed == len(rows) and not wrong else 1


if __name__ == "__main__":
    sys.exit(main())
