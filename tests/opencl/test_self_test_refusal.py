"""A device that computes wrongly is refused by name before anything is rendered, and used all the same with --force. One that
pads a struct is refused with its name.

The wrong device is the right one with a broken kernel in its self-test, or with one more member in a struct.

Usage: test_self_test_refusal.py BALLPARK KERNELS SCENE
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program, kernels, scene = sys.argv[1:]


def run(environment, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, **environment})
    return done.returncode, done.stderr


with tempfile.TemporaryDirectory() as folder:
    broken = pathlib.Path(folder, "kernels")
    shutil.copytree(kernels, broken)
    text = (broken / "entry/self_test.cl").read_text()
    (broken / "entry/self_test.cl").write_text(text.replace("as_uint(fma(a, b, c))", "as_uint(a * b + c)"))
    assert (broken / "entry/self_test.cl").read_text() != text
    environment = {"XDG_CACHE_HOME": str(pathlib.Path(folder, "cache"))}
    picture = pathlib.Path(folder, "picture.ppm")
    os.mkdir(environment["XDG_CACHE_HOME"])
    small = ("render", scene, "--width", 16, "--spp", 1, "-o", picture)

    code, words = run(environment, *small)
    if "no OpenCL" in words:
        print("skipped:", words)
        sys.exit(77)
    assert code == 0 and picture.exists(), words
    # Twice: a pass of the right kernel is no pass of the broken one, and a failure is not remembered.
    for _ in range(2):
        picture.unlink(missing_ok=True)
        code, words = run({**environment, "BALLPARK_KERNELS": str(broken)}, *small)
        assert code == 1, f"exit {code}\n{words}"
        assert "self-test" in words and "fma(a, b, c)" in words and "--force" in words, words
        assert not picture.exists(), "a picture of a device that was refused"
    code, words = run({**environment, "BALLPARK_KERNELS": str(broken)}, *small, "--force")
    assert code == 0 and picture.exists(), words
    assert "self-test" in words, "--force without a warning"
    # Kernels that are not there say nothing about the device, so nothing can be forced.
    missing = str(pathlib.Path(folder, "no" * 100, "such" * 60, "folder" * 30, "of" * 90, "kernels" * 20))
    for options in (), ("--force",):
        picture.unlink(missing_ok=True)
        code, words = run({**environment, "BALLPARK_KERNELS": missing}, *small, *options)
        assert code == 1 and not picture.exists(), words
        for text in f"cannot open {missing[:200]}", "/real.cl: No such file", "BALLPARK_KERNELS", "unset it":
            assert text in words, f"{text}: {words}"
        assert "--force" not in words and "warning" not in words, words

    structs = re.findall(r"typedef struct (\w+) {\n", types := (pathlib.Path(kernels) / "scene_types.h").read_text())
    assert len(structs) >= 9, structs
    shutil.rmtree(broken)
    shutil.copytree(kernels, broken)
    for struct in structs:
        padded = re.sub(rf"(typedef struct {struct} {{\n)", r"\1packed_uint padding;", types)
        (broken / "scene_types.h").write_text(padded)
        code, words = run({**environment, "BALLPARK_KERNELS": str(broken)}, *small, "--force")
        assert code == 1 and not picture.exists(), f"{struct}: exit {code}\n{words}"
        assert f"{struct}_has_padding" in words, f"{struct}: {words}"
print("refused, and forced; no padding")
