"""What tests share whose cases are functions: running the program on a document, and the cases one after another.

Each test file is run as: PYTHONPATH=tests/support python3 test_X.py PROGRAM SOURCE_DIR [--deep | CASE...]

A case returns a few words on what it found, and fails with an AssertionError. Known bugs (tests/mutants) run single ones. What
takes long and finds what is rare is a deep case: --deep runs these, and without it they are left out.
"""

import json
import os
import re
import subprocess
import sys
import tempfile

PROGRAM, ONLY = sys.argv[1], [word for word in sys.argv[3:] if not word.startswith("--")]
OPTIONS = set(sys.argv[3:]) - set(ONLY)


def run(*arguments, code=0):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, check=False)
    if done.returncode != code:
        sys.exit(f"{' '.join(arguments)}: exit code {done.returncode}, not {code}: {done.stderr.decode()}")
    return done


def with_file(document, use):
    """What use(path) returns of a file with the document, a dictionary or text."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "x.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(document if isinstance(document, str) else json.dumps(document))
        return use(path)


def picture(document, *options):
    """The bytes of its PFM file."""
    return with_file(document, lambda path: run("render", path, "-o", "-", "--format", "pfm", "--quiet", *options).stdout)


def effects(document):
    """What `explain` says of its effects, with one space between the columns."""
    return re.sub(" +", " ", with_file(document, lambda path: run("explain", path, "--wide").stdout.decode()))


def told_apart(base, others):
    """Films of the first document are not merged with those of any of the others."""
    with tempfile.TemporaryDirectory() as folder:
        for i, document in enumerate([base, *others]):
            path = os.path.join(folder, str(i))
            with open(path + ".json", "w", encoding="utf-8") as file:
                json.dump(document, file)
            run("render", path + ".json", "-o", path + ".bpa", "--spp", "4", "--quiet", *(["--first-sample", "4"] if i > 0 else []))
            if i > 0:
                done = subprocess.run([PROGRAM, "merge", os.path.join(folder, "0.bpa"), path + ".bpa", "-o", os.path.join(folder, "x.bpa")],
                                      capture_output=True, check=False)
                assert done.returncode == 2 and b"scene" in done.stderr, i
    return "told apart"


def run_cases(cases, deep_cases, options=()):
    """Runs those that the command line asks for; returns the exit code. `options`: that a test has beside --deep."""
    known = {case.__name__: case for case in cases + deep_cases}
    if unknown := (set(ONLY) - known.keys()) | (OPTIONS - {"--deep", *options}):
        sys.exit(f"no such case or option: {', '.join(sorted(unknown))}")
    chosen = deep_cases if "--deep" in OPTIONS else [known[name] for name in ONLY] if ONLY else cases
    failed = False
    for case in chosen:
        try:
            print(f"{case.__name__}: {case()}", flush=True)
        except AssertionError as found:
            failed = True
            print(f"FAILED: {case.__name__}: {found}", flush=True)
    return failed
