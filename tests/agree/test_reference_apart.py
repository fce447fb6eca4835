#!/usr/bin/env python3
"""The reference tracer must share nothing with the kernel: neither include path, nor headers, nor symbols.

usage: test_reference_apart.py BUILD_DIR SOURCE_DIR
Reads compile_commands.json, and tries what must fail with the reference's own command line.
"""
import json
import os
import shlex
import subprocess
import sys

build, source = (os.path.realpath(p) for p in sys.argv[1:3])
kernels = os.path.join(source, "kernels")
failures = []


def command_of(entry, *more):
    """The entry's command without its outputs, with `more` at the end."""
    words = shlex.split(entry["command"])
    kept, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-MF", "-MT", "-MQ"):
            skip = True
        elif word not in ("-c", "-MD", "-MMD"):
            kept.append(word)
    return kept + list(more)


with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
    entries = [e for e in json.load(file) if "/host/reference/" in e["file"]]
if len(entries) < 4:
    sys.exit(f"only {len(entries)} files of host/reference in compile_commands.json")

# Headers of its own, the scene, the public header, errors: nothing else of the project.
allowed = [os.path.join(source, "host", p) for p in ("reference/", "scene/scene.h", "figure/figure.h", "scene/bodies.h", "scene/material.h", "scene/texture.h", "image/texels.h", "scene/medium.h", "ballpark.h", "base/status.h")]
allowed.append(os.path.join(source, "tests/support/count_exit.h"))  # put before every source that scripts/coverage counts
for entry in entries:
    words = shlex.split(entry["command"])
    for before, word in zip([""] + words, words):
        path = word[2:] if word.startswith("-I") and len(word) > 2 else word if before in ("-I", "-isystem") else ""
        if path and os.path.realpath(os.path.join(entry["directory"], path)) == kernels:
            failures.append(f"{entry['file']}: kernels/ is on the include path")
    made = subprocess.run(command_of(entry, "-M"), cwd=entry["directory"], capture_output=True, text=True, check=True)
    for word in made.stdout.replace("\\\n", " ").split(":", 1)[1].split():
        path = os.path.realpath(os.path.join(entry["directory"], word))
        if path.startswith(source + os.sep) and not any(path.startswith(a) for a in allowed):
            failures.append(f"{entry['file']}: includes {os.path.relpath(path, source)}")

# Asking for the kernel's header by name must not compile; a header of the reference must.
words = command_of(entries[0])
words = [w for w in words if w != entries[0]["file"]] + ["-x", "c", "-fsyntax-only", "-Wno-pedantic", "-"]
for text, should in (('#define BP_HOST\n#include "scene_types.h"\n', False), ("#include <math.h>\n", True)):
    done = subprocess.run(words, cwd=entries[0]["directory"], input=text, capture_output=True, text=True)
    if (done.returncode == 0) != should:
        failures.append(f"{text.splitlines()[-1]} {'compiles' if not should else 'does not compile'}: {done.stderr}")

# Symbols from outside: the C library and the error helper only.
for entry in entries:
    words = shlex.split(entry["command"])
    made = os.path.join(entry["directory"], words[words.index("-o") + 1])
    listed = subprocess.run(["nm", "--undefined-only", made], capture_output=True, text=True, check=True).stdout
    for symbol in (line.split()[-1] for line in listed.splitlines()):
        if symbol.startswith("bp_") and not symbol.startswith(("bp_ref_", "bp_reference_", "bp_sums_", "bp_pixel_sums_")):
            if symbol not in ("bp_fail", "bp_fail_with"):
                failures.append(f"{entry['file']}: uses {symbol}")

print("\n".join(failures) or f"{len(entries)} files of the reference stand apart")
sys.exit(1 if failures else 0)
