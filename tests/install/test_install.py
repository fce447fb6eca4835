"""Installs into an empty folder, moves it, and uses the library there as others do: what the shared form shows is what
the header declares; the header is C11 and C++17; both examples build without a warning, shared and static, and draw
what they should; another language can call it.

Usage: test_install.py BUILD_DIR SOURCE_DIR CC CXX; CXX may be "", and then C++ is left out.
"""

import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import exr

build, source = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
compiler, cxx_compiler = sys.argv[3], sys.argv[4]

# A line of the public header that no strict compiler takes would fail with these.
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]


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


def declared(header):
    """The names of all functions that the header declares."""
    text = run(compiler, "-std=c11", "-E", "-P", header)
    return sorted(set(re.findall(r"\b(bp_\w+)\s*\(", text)))


def exported(library):
    """The names that the shared library shows to others."""
    lines = run("nm", "-D", "--defined-only", library).splitlines()
    return sorted(line.split()[-1] for line in lines)


def check_names(prefix, library):
    header = prefix / "include/ballpark.h"
    names = declared(header)
    assert len(names) > 20 and "bp_render_create" in names, names
    hidden, undeclared = set(names) - set(exported(library)), set(exported(library)) - set(names)
    assert not hidden and not undeclared, f"declared but hidden: {hidden}; shown but not declared: {undeclared}"


def check_version(prefix, library, environment):
    """The header, the soname and pkg-config agree."""
    version = run("pkg-config", "--modversion", "ballpark", env=environment).strip()
    major, minor, _ = version.split(".")
    header = (prefix / "include/ballpark.h").read_text()
    (number,) = re.findall(r"#define BP_API_VERSION (\d+)", header)
    assert int(number) == 1000 * int(major) + int(minor), f"BP_API_VERSION {number}, version {version}"
    assert library.name == f"libballpark.so.{version}", library
    soname = f"libballpark.so.{major}.{minor}"
    assert f"[{soname}]" in run("readelf", "-d", library), f"the soname is not {soname}"
    for link in (soname, "libballpark.so"):
        assert (library.parent / link).resolve() == library.resolve(), f"{link} does not lead to the library"


def check_header(prefix):
    """The header stands alone, in C11 and in C++17."""
    flags = [*WARNINGS, f"-I{prefix}/include", "-c", "-o", prefix / "header.o"]
    file = prefix / "header.c"
    file.write_text("#include <ballpark.h>\nint main(void) { return bp_api_version() - BP_API_VERSION; }\n")
    run(compiler, "-std=c11", *flags, file)
    if cxx_compiler:
        run(cxx_compiler, "-x", "c++", "-std=c++17", *flags, file)


def check_synopsis(prefix, flags, environment):
    """The program that the header's comment begins with compiles without a warning, and makes its picture; where a call fails,
    it says so and ends."""
    header = (prefix / "include/ballpark.h").read_text()
    comment = header[: header.index("*/")]
    lines = re.findall(r"^ \*     (\s*\S.*)$", comment, re.MULTILINE)
    assert len(lines) > 5 and "bp_render_step" in " ".join(lines), lines
    file = prefix / "synopsis.c"
    file.write_text("#include <ballpark.h>\n#include <stdio.h>\nint main(void) {\n" + "\n".join(lines) + "\nreturn (int)status;\n}\n")
    run(compiler, "-std=c11", *WARNINGS, file, *flags, "-o", prefix / "synopsis")
    scene = json.loads((prefix / "share/ballpark/scenes/v4-22-defocus.json").read_text())
    scene["camera"].update(image_width=32, samples_per_pixel=1)
    (prefix / "cover.json").write_text(json.dumps(scene))
    run(prefix / "synopsis", env=environment, cwd=prefix)
    size, _ = read_png(prefix / "cover.png")
    assert size[0] == 32, size
    (prefix / "cover.png").unlink()
    check_failing_calls(prefix, [prefix / "synopsis"], environment)
    (prefix / "cover.json").unlink()
    failed = subprocess.run([prefix / "synopsis"], env=environment, cwd=prefix, capture_output=True, text=True, timeout=60, check=False)
    assert failed.returncode != 0 and "cover.json" in failed.stderr, failed


def check_failing_calls(prefix, command, environment):
    """Each call of a library in which it fails: a program says so and ends, without a picture."""
    declarations = " ".join((prefix / "include/ballpark.h").read_text().split())
    for name in ("bp_render_create", "bp_render_step", "bp_render_read", "bp_picture_write"):
        types = re.search(rf"BpStatus {name}\(([^)]*)\)", declarations).group(1)
        source_file, library = prefix / "failing.c", prefix / "failing.so"
        source_file.write_text(f"#include <ballpark.h>\n#include <string.h>\nBpStatus {name}({types}) {{\n"
                               'strcpy(err->message, "it was made to fail");\nreturn err->code = BP_ERR_DEVICE;\n}\n')
        run(compiler, "-std=c11", "-shared", "-fPIC", "-w", f"-I{prefix}/include", source_file, "-o", library)
        failed = subprocess.run(command, env={**environment, "LD_PRELOAD": str(library)}, cwd=prefix, capture_output=True, text=True,
                                timeout=60, check=False)
        assert failed.returncode not in (0, 134, 139) and failed.returncode > 0, f"{name}: {failed}"
        assert "it was made to fail" in failed.stderr, f"{name}: {failed}"
        assert not (prefix / "cover.png").exists(), f"{name} failed, and there is a picture"


def check_documents(prefix):
    """Manual pages, completions and documents are where systems look for them."""
    for name in ("man/man1/ballpark.1", "man/man1/ballpark-render.1", "bash-completion/completions/ballpark",
                 "zsh/site-functions/_ballpark", "fish/vendor_completions.d/ballpark.fish", "doc/ballpark/README.md",
                 "doc/ballpark/LICENSE", "doc/ballpark/docs/FILES.md", "doc/ballpark/docs/cover.png",
                 "doc/ballpark/scenes/README.md"):
        assert (prefix / "share" / name).is_file(), f"{name} is not installed"


def check_modules(prefix, library):
    """Neither program nor library needs what a module stands on, and the program finds its module in the library folder."""
    for file in (prefix / "bin/ballpark", library):
        needed = re.findall(r"NEEDED.*\[(.*)\]", run("readelf", "-d", file))
        assert needed and not [name for name in needed if re.match(r"lib(mpi|open-|mpich|SDL|pango|cairo)", name)], f"{file} needs {needed}"
    if not (build / "ballpark_mpi.so").exists():
        return print("skipped: built without MPI, so its module is not looked for")
    assert (library.parent / "ballpark/ballpark_mpi.so").is_file(), "the module for MPI is not installed"
    # Of a launcher that it does not know, MPI says that this process is alone: so the module was there.
    environment = {**{key: value for key, value in os.environ.items() if key != "BALLPARK_MPI"}, "PMI_SIZE": "4", "PMI_RANK": "0"}
    for present in (True, False):
        done = subprocess.run([prefix / "bin/ballpark", "render", prefix / "share/ballpark/scenes/cover.json"], capture_output=True,
                              text=True, env=environment, check=False)
        told = "MPI reports 1" if present else "ballpark_mpi.so cannot be loaded"
        assert done.returncode == 2 and told in " ".join(done.stderr.split()), done.stderr
        (library.parent / "ballpark/ballpark_mpi.so").unlink(missing_ok=True)


def check_uninstall(folder):
    """Everything that was installed is removed, and nothing else."""
    prefix = folder / "removed"
    run("cmake", "--install", build, "--prefix", prefix)
    other = prefix / "share/man/man1/other.1"
    other.write_text("of another program")
    run("cmake", "--build", build, "--target", "uninstall")
    left = [path for path in prefix.rglob("*") if not path.is_dir()]
    assert left == [other], left
    folders = [path for path in prefix.rglob("ballpark*")]
    assert not folders, f"folders are left: {folders}"
    failed = subprocess.run(["cmake", "--build", build, "--target", "uninstall"], capture_output=True, text=True,
                            check=False)
    assert failed.returncode != 0 and "nothing to remove" in failed.stdout + failed.stderr, failed.stdout


def check_example(prefix, flags, environment):
    """The first example: a PNG."""
    example, picture = prefix / "example", prefix / "cover.png"
    picture.unlink(missing_ok=True)
    run(compiler, "-std=c11", *WARNINGS, source / "tests/install/example.c", *flags, "-o", example)
    run(example, prefix / "share/ballpark/scenes/cover.json", picture, env=environment)
    size, rows = read_png(picture)
    assert size[0] == 160, f"width {size[0]}"
    assert len(set(rows)) > 100, "the picture is nearly uniform"
    picture.unlink()
    if list(prefix.rglob("libballpark.so")):  # only there can a call be replaced
        check_failing_calls(prefix, [example, prefix / "share/ballpark/scenes/cover.json", picture], environment)


def luminance(values):
    return sum(weight * value for weight, value in zip((0.2126, 0.7152, 0.0722), values))


def check_until_error(prefix, flags, environment):
    """The second example: an EXR, whose error is the one that was asked for, and the sums behind it."""
    example, picture, sums = prefix / "until_error", prefix / "cover.exr", prefix / "cover.bpa"
    for file in (picture, sums):
        file.unlink(missing_ok=True)
    run(compiler, "-std=c11", *WARNINGS, source / "tests/install/until_error.c", *flags, "-o", example)
    text = run(example, prefix / "share/ballpark/scenes/v4-22-defocus.json", "0.02", picture, sums, env=environment)
    reason, told, samples = re.match(r"stopped by (\w+): error ([\d.]+) after (\d+) samples", text).groups()
    assert reason == "error" and float(told) <= 0.02, text

    width, height, layers = exr.read(picture.read_bytes())
    pixels = range(width * height)
    assert width == 96, f"width {width}"
    assert set(layers) == {"R", "G", "B", "error.R", "error.G", "error.B", "samples", "depth.Z", "normal.X", "normal.Y",
                           "normal.Z", "albedo.R", "albedo.G", "albedo.B"}, sorted(layers)
    assert all(layers["samples"][p] == int(samples) for p in pixels), "not every pixel has the samples"
    assert sum(math.isfinite(z) and z > 0 for z in layers["depth.Z"]) > len(pixels) / 4, "little is near the camera"
    # The channels' errors taken as one bound the error of luminance from above, and not by much.
    square = sum(luminance([layers[f"error.{c}"][p] for c in "RGB"]) ** 2 for p in pixels) / len(pixels)
    mean = sum(luminance([layers[c][p] for c in "RGB"]) for p in pixels) / len(pixels)
    assert 0.95 * float(told) <= math.sqrt(square) / mean <= 1.5 * float(told), (math.sqrt(square) / mean, told)

    # The program's own picture of the same sums.
    merged = prefix / "merged.exr"
    run(prefix / "bin/ballpark", "merge", sums, "-o", merged)
    _, _, again = exr.read(merged.read_bytes())
    assert all(again[c] == layers[c] for c in "RGB"), "the sums are not those of the picture"


def check_scenes_of_the_program(prefix):
    """The agreement scenes and the recorded pictures are in the program, wherever it is. Pictures are tiny: what agrees
    is not the matter here."""
    done = subprocess.run([prefix / "bin/ballpark", "check", "--suite", "--effects", "all", "--width", "4", "--spp", "4",
                           "--quiet", "--json", "-"], capture_output=True, text=True, cwd=prefix, check=False)
    assert done.returncode == 4, f"exit code {done.returncode}: {done.stderr}"
    found = [scene["scene"] for scene in json.loads(done.stdout)["scenes"]]
    found = list(dict.fromkeys(found))  # those whose lights can be sampled are checked twice
    assert found == [path.stem for path in sorted((source / "tests/agree/scenes").glob("*.json"), key=lambda path: path.name)], found
    done = subprocess.run([prefix / "bin/ballpark", "check", "--bits", "--timeout", "0.001", "--json", "-"],
                          capture_output=True, text=True, cwd=prefix, check=False)
    recorded = {picture["scene"] for picture in json.loads((source / "host/check/bits.json").read_text())["pictures"]}
    assert {result["scene"] for result in json.loads(done.stdout)["results"]} == recorded, done.stderr


with tempfile.TemporaryDirectory() as folder:
    first, prefix = pathlib.Path(folder, "first"), pathlib.Path(folder, "moved")
    run("cmake", "--install", build, "--prefix", first)
    shutil.move(first, prefix)

    assert run(prefix / "bin/ballpark", "--version").strip(), "--version prints nothing"
    headers = [str(path.relative_to(prefix)) for path in prefix.rglob("*.h")]
    assert headers == ["include/ballpark.h"], f"one public header, found {headers}"
    assert (prefix / "share/ballpark/scenes/cover.json").is_file(), "the scenes are not installed"

    check_scenes_of_the_program(prefix)

    (pkgconfig,) = prefix.rglob("pkgconfig")
    libraries = pkgconfig.parent
    search = os.environ.get("PKG_CONFIG_PATH", "")
    environment = dict(os.environ, PKG_CONFIG_PATH=f"{pkgconfig}:{search}")
    with_library = dict(environment, LD_LIBRARY_PATH=str(libraries))
    (library,) = (path for path in libraries.glob("libballpark.so*") if not path.is_symlink())

    check_names(prefix, library)
    check_version(prefix, library, environment)
    check_header(prefix)
    check_documents(prefix)
    check_modules(prefix, library)
    check_uninstall(pathlib.Path(folder))
    shared = run("pkg-config", "--cflags", "--libs", "ballpark", env=environment).split()
    assert not [flag for flag in shared if "jansson" in flag or "OpenCL" in flag], f"the shared form needs {shared}"
    check_synopsis(prefix, shared, with_library)
    check_example(prefix, shared, with_library)
    check_until_error(prefix, shared, with_library)
    assert f"[{library.name.rsplit('.', 1)[0]}]" in run("readelf", "-d", prefix / "example"), "not linked shared"
    run(sys.executable, "-B", source / "tests/install/foreign.py", library,
        prefix / "share/ballpark/scenes/v4-22-defocus.json", prefix, compiler, env=environment)

    # Without the shared form beside it, the same flags and --static give the static one.
    for path in libraries.glob("libballpark.so*"):
        path.unlink()
    static = run("pkg-config", "--static", "--cflags", "--libs", "ballpark", env=environment).split()
    check_example(prefix, static, environment)
    check_until_error(prefix, static, environment)
    print("installed, moved, built against, rendered: ok" + ("" if cxx_compiler else "; no C++ compiler to try"))
