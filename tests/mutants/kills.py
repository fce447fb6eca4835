"""Which mutants need no second trial: their kills are kept, each with a fingerprint of the texts that it came from.

A mutant's fingerprint covers its patches and trials, the files that it patches, and the files of its trials: the test program or
script, or the scene. While these texts stand, a kept kill stands. What else a trial uses may change unseen, for instance a file
in tests/support, so every time an eighth of the mutants is tried again, another eighth for another commit; the nightly tests and
scripts/validate try them all. Only kills are kept."""
import functools
import hashlib
import json
import os
import shlex
import subprocess

from mutants import Check, Lister, Program, Script, Test

PARTS = 8


def load(path):
    """{name: fingerprint} of a file of kept kills; nothing where there is no file."""
    if not os.path.exists(path):
        return {}
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def save(path, kills):
    with open(path, "w", encoding="utf-8") as file:
        json.dump(kills, file, indent=0, sort_keys=True)
        file.write("\n")


def commit_of(source):
    """The commit of a working tree; nothing outside a repository."""
    done = subprocess.run(["git", "-C", source, "rev-parse", "HEAD"], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def has_its_turn(name, commit):
    """Whether a mutant is tried again, whatever is kept: an eighth of them for each commit."""
    return int(hashlib.sha256(f"{commit} {name}".encode()).hexdigest(), 16) % PARTS == 0


class Fingerprints:
    """Of mutants, in a source tree and the build's list of commands."""

    def __init__(self, source, commands):
        self.source = source
        self.sources_of = {}  # {program: its own source files}
        for entry in commands:
            words = shlex.split(entry["command"])
            folder = next((part for part in words[words.index("-o") + 1].split("/") if part.endswith(".dir")), "")
            self.sources_of.setdefault(folder.removesuffix(".dir"), []).append(entry["file"])

    @functools.cache
    def digest_of(self, path):
        with open(os.path.join(self.source, path), "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()

    def files_of(self, trial):
        if isinstance(trial, Check):
            book = trial.scene.startswith("book:")
            return [f"{'scenes' if book else 'tests/agree/scenes'}/{trial.scene.removeprefix('book:')}.json"]
        if isinstance(trial, Script):
            return [trial.path]
        assert isinstance(trial, (Lister, Program, Test)), trial
        return sorted(self.sources_of[trial.program]) + ([trial.path] if isinstance(trial, Lister) else [])

    def of(self, mutant, patched):
        """`patched`: the paths of the files that the mutant's patches change."""
        files = [*sorted(patched), *(path for trial in mutant.trials for path in self.files_of(trial))]
        said = [repr(tuple(mutant)), *map(self.digest_of, files)]
        return hashlib.sha256("\n".join(said).encode()).hexdigest()[:16]
