"""docs/BOOK.md: what its table names exists, and its worked example can be applied; with --build, the example is
built, and kernel and reference agree on its scene.

test_book_page.py PROJECT [--build]"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

project = pathlib.Path(sys.argv[1])
page = (project / "docs/BOOK.md").read_text()
example = project / "docs/examples/retroreflector.patch"


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
    """The lines of C on the page are lines of the patch."""
    patch = example.read_text()
    added = {re.sub(r"\s+", "", line[1:].rstrip("\\")) for line in patch.splitlines() if line.startswith("+")}
    steps = page[page.index("## Adding a lobe"):]
    for block in re.findall(r"```c\n(.*?)```", steps, re.DOTALL):
        for line in block.splitlines():
            assert re.sub(r"\s+", "", line) in added, f"docs/BOOK.md shows a line that the example lacks: {line}"


def apply_example(tree):
    command = ["git", "apply", "-C1", str(example)]
    process = subprocess.run(command, cwd=tree, capture_output=True, text=True, env={**os.environ, "GIT_DIR": "none"})
    assert process.returncode == 0, (f"docs/examples/retroreflector.patch does not apply any more: {process.stderr}"
                                     "Change it together with the files that it changes.")


def build_example(tree, build):
    steps = [["cmake", "-S", tree, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DBALLPARK_TESTS=OFF"],
             ["cmake", "--build", build, "--target", "ballpark", "--parallel", "2"],
             [f"{build}/ballpark", "check", f"{tree}/tests/agree/scenes/retroreflector.json", "--width", "32"]]
    for step in steps:
        process = subprocess.run(step, capture_output=True, text=True)
        assert process.returncode == 0, f"{' '.join(map(str, step))}: {process.stdout}{process.stderr}"


check_table()
check_example_text()
if shutil.which("git") is None:
    print("skipped: no git here, which applies the example of docs/BOOK.md")
    sys.exit(77)
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
