"""What the tests of files of molecules share: every particle of a file, by particle_list, and by an independent reader.

A test is run as: python3 test_..._files.py particle_list [Class ...]
BALLPARK_READERS_PYTHON names the Python that has gemmi and MDAnalysis, where it is not this one.
"""
import collections
import json
import os
import subprocess
import sys
import unittest

from answers import AnswersTest

HERE = os.path.dirname(os.path.abspath(__file__))
READERS_PYTHON = os.environ.get("BALLPARK_READERS_PYTHON", sys.executable)
ALTERNATIVE, DUMMY, GUESSED, HETERO = 1, 2, 4, 8

Atom = collections.namedtuple("Atom", "x y z element flags name residue chain radius first second")


class Listed:
    """A frame: .head is what belongs to all, .atoms are its particles."""

    def __init__(self, text):
        lines = text.splitlines()
        self.head = json.loads(lines[0])
        self.atoms = [Atom(*json.loads(line)) for line in lines[1:]]

    def places(self, shown=False):
        return [atom[:3] for atom in self.atoms if not (shown and atom.flags & ALTERNATIVE)]

    def of(self, member):
        return [getattr(atom, member) for atom in self.atoms]


class ListTest(AnswersTest):
    def list(self, path, *arguments):
        result = self.answer(path, *arguments)
        self.assertEqual(result.returncode, 0, f"{path}: {result.stderr}")
        return Listed(result.stdout)

    def of(self, name, content, *arguments):
        return self.list(self.write(name, content), *arguments)

    def refuse(self, name, content, *says, arguments=()):
        result = self.answer(self.write(name, content), *arguments)
        self.assertEqual(result.returncode, 1, result.stderr[-2000:] + result.stdout[:200])
        for text in (name,) + says:
            self.assertIn(text, result.stderr)

    def ask(self, *arguments):
        """What independent_molecules.py finds; skips where its reader is missing."""
        result = subprocess.run([READERS_PYTHON, "-B", os.path.join(HERE, "independent_molecules.py"), *map(str, arguments)],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if result.returncode == 77:
            self.skipTest(f"{arguments[0]} is not installed for {READERS_PYTHON}")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def real_files(self):
        """The folder of the files of MDAnalysis's own tests; skips where they are not installed."""
        found = subprocess.run([READERS_PYTHON, "-c", "import importlib.util as u; print(u.find_spec('MDAnalysisTests').origin)"],
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False).stdout.strip()
        if not found:
            self.skipTest(f"MDAnalysisTests is not installed for {READERS_PYTHON}")
        return os.path.join(os.path.dirname(found), "data")


def main():
    result = unittest.main(module="__main__", argv=[sys.argv[0]] + sys.argv[2:], exit=False).result
    for reason in dict.fromkeys(reason for _, reason in result.skipped):
        print(f"skipped: {reason}")
    sys.exit(0 if result.wasSuccessful() else 1)
