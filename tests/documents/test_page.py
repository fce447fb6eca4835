"""The commands of a page run in their order, as a reader would type them, and print what the page shows.

A block ```sh is run by bash in one folder for the whole page. A block ```text right below it must be in what its commands print: "..."
stands for anything, and blanks and line ends count alike. A line that ends with "# exit code N" must fail so. A block that
begins with "# needs: NAME" is left out where NAME is not installed, or for Pango, where its module was not built; for Slurm there is
a stand-in.

Run as: PYTHONPATH=tests/support python3 test_page.py PROGRAM SOURCE_DIR PAGE [FOLDER]

FOLDER, which must not exist, keeps what the commands make, to look at.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from png import read_png

# Runs a script once for each task of its array, one after the other, in the place of Slurm.
SBATCH = """#!/bin/bash
script=${!#}
last=$(sed -n 's/^#SBATCH --array=1-//p' "$script")
for task in $(seq "$last"); do
    SLURM_ARRAY_TASK_ID=$task SLURM_ARRAY_TASK_COUNT=$last bash "$script" || exit
done
"""
SRUN = "#!/bin/sh\nexec \"$@\"\n"


def size_of(folder, name):
    """(width, height, bits, channels) and the chunks by name."""
    width, height, bits, channels, _, chunks = read_png((folder / name).read_bytes())
    return (width, height, bits, channels), dict(chunks)


def look_at_guide(folder):
    """What the page says of its pictures, and no command prints."""
    for name, wanted in {"small.png": (400, 225, 8, 3), "scene.png": (400, 225, 8, 3), "noise.png": (400, 279, 8, 3),
                         "figure.png": (992, 744, 16, 3), "clear.png": (400, 300, 8, 4),
                         "turn/shell-0023.png": (320, 240, 8, 3), "path/scene-23.png": (320, 180, 8, 3)}.items():
        found, chunks = size_of(folder, name)
        assert found == wanted, f"{name}: {found}"
        if name == "figure.png":
            assert chunks["pHYs"] == (11811).to_bytes(4, "big") * 2 + b"\1", "figure.png is not of 300 dpi"
            text = b"".join(body for chunk, body in read_png((folder / name).read_bytes())[5] if chunk in ("tEXt", "iTXt"))
            assert b"ballpark render" in text, "figure.png does not say how it was made"
    if (folder / "bar.png").exists():  # 60 mm at 300 dots per inch, and the bar beside them
        (width, height, *_), _ = size_of(folder, "bar.png")
        assert height == 531 and 760 < width < 1000, f"bar.png: {width} x {height}"
    assert len(list((folder / "turn").iterdir())) == 24 and len(list((folder / "path").iterdir())) == 24
    assert (folder / "parallel.exr").read_bytes()[:4] == b"v/1\1"
    assert "<html" in (folder / "cost.html").read_text(encoding="utf-8")[:500]
    alphas = read_png((folder / "clear.png").read_bytes())[4]
    assert alphas[0][3] == 0 and max(row[4 * x + 3] for row in alphas for x in range(400)) == 255


LOOK_AT = {"GUIDE.md": look_at_guide}


def blocks(text):
    """The commands of each block, and what the page says they print, or ""."""
    return re.findall(r"^```sh\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", text, re.S | re.M)


def as_script(commands):
    """Lines that must fail do so with the code that the page names."""
    return re.sub(r"(?m)^(.*?) +# exit code (\d+)$",
                  r"code=0; { \1; } || code=$?; [ $code = \2 ] || { echo exit code $code; exit 99; }", commands)


def plain(text):
    return " ".join(text.split())


def run_page(program, page, kept):
    text = page.read_text(encoding="utf-8")
    found = blocks(text)
    assert len(found) > 8 and text.count("```sh\n") == len(found), f"{page}: found {len(found)} blocks of commands"
    left_out = set()
    if kept:
        kept.mkdir()
    with tempfile.TemporaryDirectory() as name:
        folder = kept or pathlib.Path(name)
        tools = pathlib.Path(name, ".tools")
        tools.mkdir()
        for tool, script in {"ballpark": f'#!/bin/sh\nexec "{program}" "$@"\n', "sbatch": SBATCH, "srun": SRUN}.items():
            (tools / tool).write_text(script)
            (tools / tool).chmod(0o755)
        environment = dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}", LC_ALL="C.UTF-8", COLUMNS="10000")
        for commands, printed in found:
            needs = re.match(r"# needs: (\S+)", commands)
            if needs and not (pathlib.Path(program).with_name("ballpark_text.so").exists() if needs[1] == "Pango" else
                              shutil.which(needs[1], path=environment["PATH"])):
                left_out.add(needs[1])
                continue
            result = subprocess.run(["bash", "-euo", "pipefail", "-c", as_script(commands)], cwd=folder, env=environment, timeout=300,
                                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            assert result.returncode == 0, f"{page.name}: these commands end with {result.returncode}:\n{commands}\n{result.stdout}"
            for line in printed.splitlines():
                pattern = re.escape(plain(line)).replace(re.escape("..."), ".*?")
                assert re.search(pattern, plain(result.stdout)), \
                    f"{page.name}: \"{line}\" is not in what these commands print:\n{commands}\n{result.stdout}"
        if page.name in LOOK_AT:
            LOOK_AT[page.name](folder)
    for tool in sorted(left_out):
        print(f"skipped: a block of commands needs {tool}")
    print(f"{page.name}: {len(found)} blocks of commands")


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    run_page(os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2], "docs", sys.argv[3]),
             pathlib.Path(sys.argv[4]).resolve() if len(sys.argv) > 4 else None)
