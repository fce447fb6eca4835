"""The Debian packages: they are built from a clean tree, lintian finds nothing, and each holds what it should.

Usage: test_debian_package.py SOURCE_DIR
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1])


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, **options)
    print("+", *command, "\n", done.stdout[-20000:], flush=True)
    return done


for tool, package in (("dpkg-buildpackage", "dpkg-dev"), ("dh", "debhelper"), ("git", "git")):
    if shutil.which(tool) is None:
        skip(f"{package} is not installed")

version = re.search(r"project\(ballpark VERSION ([\d.]+)", (source / "CMakeLists.txt").read_text()).group(1)
assert (source / "debian/changelog").read_text().startswith(f"ballpark ({version})"), "debian/changelog: another version"

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    tree = folder / f"ballpark-{version}"
    listed = subprocess.run(["git", "-C", source, "ls-files", "-z"], capture_output=True, text=True, check=False)
    if listed.returncode != 0:
        skip("the sources are not a clone")
    for file in filter(None, listed.stdout.split("\0")):
        if not (source / file).exists():
            continue
        (tree / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source / file, tree / file)

    environment = {key: value for key, value in os.environ.items() if not key.startswith(("CFLAGS", "LDFLAGS"))}
    # Without optimising: compiling is most of this test, and the packages hold the same files.
    environment["DEB_BUILD_OPTIONS"] = "nocheck noopt parallel=2"
    done = run("dpkg-buildpackage", "-us", "-uc", "-b", cwd=tree, env=environment)
    if "Unmet build dependencies" in done.stdout:
        skip(re.search(r"Unmet build dependencies.*", done.stdout).group(0))
    assert done.returncode == 0, "dpkg-buildpackage failed"

    # The packages were built without tests, so none is found; that they would be run is shown.
    environment["DEB_BUILD_OPTIONS"] = ""
    done = run("debian/rules", "override_dh_auto_test", cwd=tree, env=environment)
    assert done.returncode == 0 and "No tests were found" in done.stdout, "debian/rules cannot run the tests"

    contents = {}
    for package in folder.glob("*.deb"):
        rows = subprocess.run(["dpkg-deb", "-c", package], capture_output=True, text=True, check=True).stdout
        contents[package.name.split("_")[0]] = set(re.findall(r" \./(\S+)", rows))
    main, library, development = (contents[each] for each in ("ballpark", "libballpark0.1", "libballpark-dev"))
    for file in ("usr/bin/ballpark", "usr/share/man/man1/ballpark-render.1.gz", "usr/share/fish/vendor_completions.d/ballpark.fish",
                 "usr/share/bash-completion/completions/ballpark", "usr/share/zsh/vendor-completions/_ballpark",
                 "usr/share/ballpark/scenes/cover.json", "usr/share/doc/ballpark/copyright"):
        assert file in main, f"ballpark lacks {file}"
    assert any(re.fullmatch(r"usr/lib/[^/]+/libballpark\.so\.\d+\.\d+\.\d+", file) for file in library), library
    assert "usr/include/ballpark.h" in development and any(file.endswith("libballpark.a") for file in development)

    # The program as it is in the package.
    (package,) = folder.glob("ballpark_*.deb")
    assert run("dpkg-deb", "-x", package, folder / "root").returncode == 0
    told = subprocess.run([folder / "root/usr/bin/ballpark", "--version"], capture_output=True, text=True, check=True).stdout
    assert told.startswith(f"ballpark {version}"), told

    if shutil.which("lintian") is None:
        skip("the packages are built; lintian is not installed")
    (changes,) = folder.glob("*.changes")
    # Ballpark is packaged here, not in Debian, so no bug there asks for it.
    done = run("lintian", "--allow-root", "--fail-on", "error,warning", "--suppress-tags", "initial-upload-closes-no-bugs",
               changes, cwd=folder)
    assert done.returncode == 0 and not re.search(r"^[EW]:", done.stdout, re.M), "lintian is not content"
print("ok")
