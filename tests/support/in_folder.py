"""A test that writes files into a folder of its own."""
import os
import shutil
import tempfile
import unittest


class FolderTest(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="ballpark-files-")
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, content):
        """A file of text or bytes; returns its path."""
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())
        return path

    def near(self, one, other, tolerance=1e-6):
        """Numbers, and lists of them."""
        self.assertEqual(len(one), len(other))
        for a, b in zip(one, other):
            if isinstance(a, (list, tuple)):
                self.near(a, b, tolerance)
            else:
                self.assertLessEqual(abs(a - b), tolerance, (one, other))
