"""Tests that write a scene document, run the program on it, and look at the picture.

In:    documents.   Out: what the program said; pixels.
Knows: the program, PFM files.   Does not know: what a picture should show.
"""

import json
import pathlib
import subprocess
import tempfile
import unittest

import cli
from pfm import read_pfm


class ScenePictures(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def run_ballpark(self, document, *arguments):
        (self.path / "s.json").write_text(json.dumps(document))
        return subprocess.run([cli.PROGRAM, arguments[0], "s.json", *arguments[1:]], cwd=self.path, capture_output=True, text=True, check=False)

    def render(self, document, *options):
        """The bytes of the picture, its rows from below, and its pixels."""
        made = self.run_ballpark(document, "render", "-o", "out.pfm", "--force", "--quiet", *options)
        self.assertEqual(made.returncode, 0, made.stderr)
        data = (self.path / "out.pfm").read_bytes()
        width, height, numbers = read_pfm(data)
        return data, width, height, tuple(numbers)
