"""docs/BOOK.md: what its table names exists, and its worked example can be applied; with --build, the example is
built, and kernel and reference agree on its scene.

test_book_page.py PROJECT [--build]"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

project = pathlib.Path(sys.argv[1])
page = (project / "docs/BOOK.md").read_text()
example = project / "docs/examples/retroreflector.example"


def check_table():
    """A name is looked for in the files that its cell links to; what stands in no cell with a file is the book's."""
    checked = 0
    for row in re.findall(r"^\|.*\|$", page, re.MULTILINE):
        for cell in row.strip("|").split("|")[2:]:
            files = [project / "docs" / link for link in re.findall(r"\]\(([^)]+)\)", cell)]
            if not files:
                continue
            text = ""
            for file in files:
                assert file.exists(), f"docs/BOOK.md links to {file}, which does not exist"
                text += "".join(f.read_text() for f in ([file] if file.is_file() else file.iterdir()))
            for name in re.findall(r"`([A-Za-z_][A-Za-z0-9_]*)`", cell):
                assert re.search(rf"\b{name}\b", text), f"docs/BOOK.md: no {name} in {', '.join(map(str, files))}"
                checked += 1
    assert checked > 20, f"only {checked} names were found in the table"


def check_example_text():
    """The lines of C on the page are lines of the example."""
    added = {re.sub(r"\s+", "", line.rstrip("\\")) for line in example.read_text().splitlines()}
    steps = page[page.index("## Adding a lobe"):]
    for block in re.findall(r"```c\n(.*?)```", steps, re.DOTALL):
        for line in block.splitlines():
            assert re.sub(r"\s+", "", line) in added, f"docs/BOOK.md shows a line that the example lacks: {line}"


def apply_example(tree):
    """What it inserts moves with the text that it names: it applies to files with other lines in front, and only once."""
    for name in ["host/scene/material.h", "kernels/bsdf/scatter.cl"]:
        (tree / name).write_text("/* moved */\n" * 7 + (tree / name).read_text())
    command = [sys.executable, project / "docs/examples/apply", example, tree]
    process = subprocess.run(command, capture_output=True, text=True)
    assert process.returncode == 0, f"docs/examples/retroreflector.example does not apply any more: {process.stderr}"
    before = (tree / "host/scene/material.h").read_text()
    again = subprocess.run(command, capture_output=True, text=True)
    assert again.returncode != 0 and "applied before" in again.stderr, again.stderr
    assert (tree / "host/scene/material.h").read_text() == before, "an example that does not apply has changed a file"


def build_example(tree, build):
    steps = [["cmake", "-S", tree, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DBALLPARK_TESTS=OFF"],
             ["cmake", "--build", build, "--target", "ballpark", "--parallel", "2"],
             [f"{build}/ballpark", "check", f"{tree}/tests/agree/scenes/retroreflector.json", "--width", "32"]]
    for step in steps:
        process = subprocess.run(step, capture_output=True, text=True)
        assert process.returncode == 0, f"{' '.join(map(str, step))}: {process.stdout}{process.stderr}"


check_table()
check_example_text()
with tempfile.TemporaryDirectory() as folder:
    tree = pathlib.Path(folder) / "tree"
    tree.mkdir()
    for name in ["CMakeLists.txt", "cmake", "host", "kernels", "scenes", "tests", "bench", "docs"]:
        source = project / name
        if source.is_dir():
            shutil.copytree(source, tree / name)
        elif source.exists():
            shutil.copy(source, tree / name)
    apply_example(tree)
    if "--build" in sys.argv[2:]:
        build_example(tree, pathlib.Path(folder) / "build")
