"""With BALLPARK_TESTS=OFF nothing asks for cmocka, and who names no build type gets Release.

Usage: test_without_tests.py SOURCE_DIR
"""

import pathlib
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1])


def configure(folder, *options):
    # A pkg-config that knows no cmocka.
    tool = folder / "pkg-config"
    tool.write_text('#!/bin/sh\nfor word; do case $word in cmocka*) exit 1 ;; esac; done\nexec pkg-config "$@"\n')
    tool.chmod(0o755)
    return subprocess.run(["cmake", "-S", source, "-B", folder / "build", "-G", "Ninja", f"-DPKG_CONFIG_EXECUTABLE={tool}",
                           "-DBALLPARK_BENCH=OFF", *options], capture_output=True, text=True, check=False)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    done = configure(folder, "-DBALLPARK_TESTS=OFF")
    assert done.returncode == 0, done.stdout + done.stderr
    cache = (folder / "build/CMakeCache.txt").read_text()
    assert "CMAKE_BUILD_TYPE:STRING=Release\n" in cache, cache
    commands = (folder / "build/compile_commands.json").read_text()
    assert "-O3" in commands and "/tests/" not in commands

    done = configure(folder, "-DBALLPARK_TESTS=ON")
    assert done.returncode != 0 and "cmocka" in done.stdout + done.stderr, "the tests do not need cmocka any more"

    done = configure(folder, "-DBALLPARK_TESTS=OFF", "-DCMAKE_BUILD_TYPE=Debug")
    assert done.returncode == 0 and "-O3" not in (folder / "build/compile_commands.json").read_text()
print("ok")
