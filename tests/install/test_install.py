"""Installs into an empty folder, moves it, and builds and runs the example program against what is there.

Usage: test_install.py BUILD_DIR SOURCE_DIR CC
"""

import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

build, source, compiler = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]


def run(*command, **options):
    print("+", *command, flush=True)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    print(done.stdout, done.stderr, sep="", flush=True)
    assert done.returncode == 0, f"{command[0]}: exit code {done.returncode}"
    return done.stdout


def read_png(path):
    """Width, height and the decompressed rows of a PNG file; every checksum is verified."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG signature"
    place, size, packed = 8, None, b""
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place : place + 8])
        body = data[place + 8 : place + 8 + length]
        (crc,) = struct.unpack(">I", data[place + 8 + length : place + 12 + length])
        assert crc == zlib.crc32(kind + body), f"checksum of {kind}"
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            packed += body
        place += 12 + length
    return size, zlib.decompress(packed)


with tempfile.TemporaryDirectory() as folder:
    first, prefix = pathlib.Path(folder, "first"), pathlib.Path(folder, "moved")
    run("cmake", "--install", build, "--prefix", first)
    shutil.move(first, prefix)

    assert run(prefix / "bin/ballpark", "--version").strip(), "--version prints nothing"
    headers = [str(path.relative_to(prefix)) for path in prefix.rglob("*.h")]
    assert headers == ["include/ballpark.h"], f"one public header, found {headers}"
    scene = prefix / "share/ballpark/scenes/cover.json"
    assert scene.is_file(), "the scenes are not installed"

    (pkgconfig,) = prefix.rglob("pkgconfig")
    search = os.environ.get("PKG_CONFIG_PATH", "")
    environment = dict(os.environ, PKG_CONFIG_PATH=f"{pkgconfig}:{search}", LD_LIBRARY_PATH=str(pkgconfig.parent))
    flags = run("pkg-config", "--cflags", "--libs", "ballpark", env=environment).split()
    example = prefix / "example"
    # A line of the public header that no strict C11 compiler takes would fail here.
    strict = ["-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    run(compiler, *strict, source / "tests/install/example.c", *flags, "-o", example)

    picture = prefix / "cover.png"
    run(example, scene, picture, env=environment)
    size, rows = read_png(picture)
    assert size[0] == 160, f"width {size[0]}"
    assert len(set(rows)) > 100, "the picture is nearly uniform"
    print("installed, moved, built against, rendered: ok")
