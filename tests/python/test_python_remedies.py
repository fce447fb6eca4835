"""Errors of the library name no option of the command line in their messages; what helps has a code (BpRemedy), and its words
are those of whoever reads them: options for the command line, arguments for Python, members and functions for C, all of
which exist.

Usage: test_python_remedies.py SOURCE_DIR BUILD_DIR
"""

import ctypes as c
import inspect
import pathlib
import re
import sys
import tempfile

import package

source, build = sys.argv[1:]
ballpark, np = package.load(source, build)
from ballpark import _library as lib

C, COMMAND_LINE, PYTHON = range(3)
host = pathlib.Path(source, "host")
header = re.sub(r"/\*.*?\*/", "", (host / "ballpark.h").read_text(), flags=re.S)


def enumerators(name):
    return re.findall(r"\bBP_\w+", re.search(r"typedef enum %s \{(.*?)\}" % name, header, re.S).group(1))


def worded(remedy, interface, value="", message="it failed"):
    error = lib.BpError(message=message.encode(), remedy=remedy, remedy_value=value.encode())
    for _ in range(2):  # of which the second does nothing
        lib.library().bp_error_add_remedy(c.byref(error), interface)
    assert error.remedy == 0 and error.remedy_value == b"", "the remedy is still to be added"
    return error.message.decode()


# What there is.
rows = re.findall(r'OPTION\(\s*[A-Z_]+, "([\w-]+)", (0|\'\w\'),', (host / "cli/line/option_list.h").read_text())
options = {f"--{name}" for name, _ in rows} | {f"-{letter[1]}" for _, letter in rows if letter != "0"}
assert {"--width", "--no-clobber", "-o"} <= options
arguments = {name for function in (ballpark.render, ballpark.Render, ballpark.Picture.save)
             for name in inspect.signature(function).parameters}
members = set(re.findall(r"(\w+);", re.search(r"typedef struct BpRenderOptions \{(.*?)\}", header, re.S).group(1)))
functions = set(re.findall(r"BP_API [\w ]+[ *](bp_\w+)\(", header))
settings = re.findall(r"X\(\w+, (\w+), \"", (host / "base/names.h").read_text())
assert len(settings) == 7 and "light_sampling" in settings


def check(remedy, value):
    line, python, plain = (worded(remedy, interface, value) for interface in (COMMAND_LINE, PYTHON, C))
    for text in (line, python, plain):
        assert re.match(r"it failed(; |, or )[a-z]", text) and "%" not in text and not text.endswith("."), text
        assert value in text or interface_word(value) in text, f"{text}: lacks {value}"
    used = set(re.findall(r"(?<!\S)--?[a-z][\w-]*", line))
    assert used and used <= options, f"{line}: {used - options} are not options"
    named = set(re.findall(r"'(\w+)'(?<!='\w)", re.sub(r"='\w+'", "=", python))) | set(re.findall(r"(\w+)=", python))
    assert named and named <= arguments, f"{python}: {named - arguments} are not arguments"
    for word, choice in re.findall(r"(\w+)='(\w+)'", python):
        assert choice in lib.CHOICES[word], python
    for called in re.findall(r"ballpark\.(\w+)\(", python):
        assert callable(getattr(ballpark, called)), python
    assert set(re.findall(r"BpRenderOptions\.(\w+)", plain)) <= members, plain
    assert set(re.findall(r"(bp_\w+)\(\)", plain)) <= functions, plain
    assert all(word in header for word in re.findall(r"\bBP_\w+", plain)), plain
    assert not re.search(r"--|[Bb][Pp]_|Bp", python) and not re.search(r"--|'", plain) and not re.search(r"[Bb]p|'", line)
    return line, python, plain


def interface_word(value):
    return value.replace("_", "-")


remedies = enumerators("BpRemedy")
assert remedies[0] == "BP_REMEDY_NONE" and len(remedies) > 10
assert all(worded(0, interface) == "it failed" for interface in (C, COMMAND_LINE, PYTHON))
for number, name in enumerate(remedies[1:], 1):
    for value in settings if name == "BP_REMEDY_SAME_SETTING" else ["400"] if "AT_MOST" in name else [""]:
        check(number, value)
at_most = remedies.index("BP_REMEDY_WIDTH_AT_MOST")
assert check(at_most, "400") == ("it failed; use --width 400 or less", "it failed; use width=400 or less",
                                 "it failed; use a width of 400 or less (bp_scene_set_width())")
assert worded(remedies.index("BP_REMEDY_SAME_SETTING"), COMMAND_LINE, "light_sampling").endswith("the same --light-sampling for both")
# A long message loses its middle and not its remedy.
long = worded(at_most, PYTHON, "400", "cannot open " + "x" * 1000)
assert long.startswith("cannot open ") and long.endswith("; use width=400 or less") and len(long) == 1023, long


def literals(text):
    """The texts of a C file, those that stand side by side as one."""
    code = re.sub(r"/\*.*?\*/|//[^\n]*", lambda comment: " " if '"' not in comment.group() or comment.group()[:2] == "/*" else comment.group(),
                  re.sub(r"'(\\.|[^'\\])'", "0", text), flags=re.S)
    code = re.sub(r"\\\n", " ", code)
    for found in re.finditer(r'"((?:[^"\\\n]|\\.)*)"(?:\s*"((?:[^"\\\n]|\\.)*)")*', code):
        yield "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', found.group()))


def names_an_option(text):
    """Outside a whole command, which is true for whoever runs it."""
    return re.search(r"(?<![\w-])(--([a-z]|$)|-[oq]\b)", re.sub(r"`ballpark [^`]*`", "", text))


# Files whose texts are command lines: the study advises some, srun has an option of its own, and so have the maps of MTL files.
COMMANDS = {"figure/layout.c": 2, "study/configurations.c": 3, "study/text.c": 3, "cluster/comm.c": 1, "meshes/read_mtl.c": 1}
found = {}
sources = [path for path in [*host.rglob("*.[ch]"), *pathlib.Path(source, "kernels").rglob("*.h")]
           if path.relative_to(source).parts[1] not in ("cli", "main.c", "write_documents.c") and path != host / "base/remedy.c"]
assert len(sources) > 200
for path in sources:
    for text in literals(path.read_text(encoding="utf-8")):
        if names_an_option(text):
            found.setdefault(str(path.relative_to(source))[len("host/"):], []).append(text)
assert {file: len(texts) for file, texts in found.items()} == COMMANDS, found
assert sum(map(bool, map(names_an_option, literals((host / "base/remedy.c").read_text())))) > 10, "options are not found"
for path in pathlib.Path(source, "python/ballpark").glob("*.py"):
    assert not names_an_option(path.read_text()), f"{path}: names an option of the command line"

# The whole way, for some of them.
SCENE = {"camera": {"image_width": 65535, "aspect_ratio": 1.9}, "spheres": [{"center": [0, 0, -2], "radius": 1, "material": "m"}],
         "materials": {"m": {"type": "dielectric", "refraction_index": 1e5}}}
error = package.refused(ballpark.Error, "pixels, expected at most 1073741823; use width=", ballpark.render, SCENE)
widest = int(re.search(r"width=(\d+) or less$", str(error)).group(1))
scene = ballpark.Scene(SCENE)
pixels = []
for width in (widest, widest + 1):
    scene.set_width(width)
    pixels.append(scene.width * scene.height)
assert pixels[0] <= 1073741823 < pixels[1], (widest, pixels)
package.refused(ballpark.SceneError, "materials.m.refraction_index: found 100000, expected 1e-4 to 1e4 in single precision, which cannot tell "
                "apart the rays that such a surface refracts; use precision='double'", ballpark.render, SCENE, width=8)
SCENE["materials"]["m"]["refraction_index"] = 1.5
with tempfile.TemporaryDirectory() as folder:
    picture = ballpark.render(SCENE, width=8, spp=1)
    package.refused(ballpark.Error, "No such file or directory; create the folder first, or choose another 'path'", picture.save,
                    pathlib.Path(folder, "missing/a.png"))
print(f"{len(remedies) - 1} remedies, {len(sources)} sources of the library: no message names an option of the command line")
