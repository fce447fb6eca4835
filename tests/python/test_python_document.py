"""The examples of docs/PYTHON.md run, one after the other, as a reader would type them; pictures are made small.

Usage: test_python_document.py SOURCE_DIR BUILD_DIR
"""

import functools
import os
import pathlib
import re
import sys
import tempfile

import package

source, build = sys.argv[1:]
ballpark, _ = package.load(source, build)
from ballpark import _render

text = pathlib.Path(source, "docs/PYTHON.md").read_text(encoding="utf-8")
examples = re.findall(r"^```python\n(.*?)^```", text, re.S | re.M)
assert len(examples) >= 8, f"found {len(examples)} examples"

begin = _render.Render.__init__


@functools.wraps(begin)
def with_few_samples(self, scene, **options):
    if options.get("spp") is None and "error" not in options and "time" not in options:
        options["spp"] = 2
    begin(self, scene, **options)


_render.Render.__init__ = with_few_samples
names, left_out = {}, []
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for example in examples:
        needs = re.match(r"# needs: (\w+)", example)
        if needs:
            try:
                __import__(needs.group(1))
            except ImportError:
                left_out.append(needs.group(1))
                continue
        print(example, flush=True)
        exec(compile(example, "docs/PYTHON.md", "exec"), names)
    assert pathlib.Path("cloud.png").read_bytes().startswith(b"\x89PNG")
    os.chdir("/")
for name in left_out:
    print(f"skipped: an example needs {name}")
print(f"{len(examples)} examples")
