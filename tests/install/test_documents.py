"""Manual pages and completions: every command and option of --help is in all of them, pages render without a warning, and
the shells complete what they should.

Usage: test_documents.py BUILD_DIR
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

build = pathlib.Path(sys.argv[1]).resolve()
folder = build / "documents"
left_out = []


def run(*command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)


def help_of(*command):
    done = run(build / "ballpark", "help", *command)
    assert done.returncode == 0, done.stderr
    return done.stdout


COMMANDS = re.findall(r"^  (\w+)  ", re.search(r"^Commands:\n(.*?)\n\n", help_of(), re.M | re.S).group(1), re.M)
OPTIONS = {command: re.findall(r"^  (?:-\w, |    )--([\w-]+)", help_of(command), re.M) for command in COMMANDS}
assert len(COMMANDS) >= 10 and "spp" in OPTIONS["render"] and "json" in OPTIONS["devices"], OPTIONS


def plain(page):
    """What a reader of the page sees, in one line."""
    done = run("man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", page, env={"MANWIDTH": "78", "LC_ALL": "C.UTF-8",
                                                                           "PATH": "/usr/bin:/bin"})
    assert done.returncode == 0 and not done.stderr.strip(), f"{page.name}: {done.stderr}"
    return re.sub(r"\s+", " ", re.sub("\x1b\\[[0-9;]*m|.\x08", "", done.stdout))


def check_pages():
    pages = sorted(path.name for path in folder.glob("*.1"))
    assert pages == sorted(["ballpark.1", *(f"ballpark-{command}.1" for command in COMMANDS)]), pages
    for command in COMMANDS:
        source = (folder / f"ballpark-{command}.1").read_text()
        for option in OPTIONS[command]:
            assert f"\\fB\\-\\-{option}".replace("-", "\\-").replace("\\\\-", "\\-") in source, f"ballpark-{command}.1: --{option}"
        assert f"\\fBballpark\\-{command}\\fR(1)" in (folder / "ballpark.1").read_text()
    if shutil.which("mandoc"):
        for page in pages:
            done = run("mandoc", "-Tlint", "-Wwarning", folder / page)
            assert done.returncode == 0, done.stdout
    else:
        left_out.append("mandoc is not installed")
    if not shutil.which("man") or not shutil.which("groff"):
        left_out.append("man or groff is not installed: pages are not rendered")
        return
    for command in COMMANDS:
        text = plain(folder / f"ballpark-{command}.1")
        for option in OPTIONS[command]:
            assert f"--{option}" in text, f"ballpark-{command}.1 shows no --{option}"
    render = plain(folder / "ballpark-render.1")
    assert "samples per pixel (default: the scene" in render.replace("’", "'"), render[:2000]
    assert "ballpark render cover.json --error 1%" in render and "--precision single|double" in render
    assert "ballpark-render(1)" in plain(folder / "ballpark.1")


def check_bash():
    bash = shutil.which("bash")
    if not bash:
        left_out.append("bash is not installed")
        return
    script = folder / "ballpark.bash"

    def complete(*words, place=None):
        code = f'. "{script}"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _ballpark; printf "%s\\n" "${{COMPREPLY[@]}}"'
        done = run(bash, "--norc", "-u", "-c", code, "bash", "ballpark", *words, cwd=place)
        assert done.returncode == 0 and not done.stderr, done.stderr
        return sorted(done.stdout.split())

    assert complete("") == sorted([*COMMANDS, "--help", "--version"]) and complete("ren") == ["render"]
    for command in COMMANDS:
        assert complete(command, "--") == sorted({*(f"--{option}" for option in OPTIONS[command]), "--help"}), command
    assert complete("render", "--prec") == ["--precision"] and complete("merge", "--prec") == []
    assert complete("render", "--precision", "") == ["double", "single"]
    assert complete("render", "--precision", "=", "d") == ["double"] and complete("render", "--precision", "=") == ["double", "single"]
    assert complete("render", "--format", "p") == ["pdf", "pfm", "png", "ppm", "ppm-ascii"]
    assert complete("render", "--spp", "") == [] and complete("devices", "") == []
    assert complete("generate", "") == ["cover", "field"] and complete("help", "ch") == ["check"]
    assert complete("-q", "render", "--error-") == ["--error-map"]
    with tempfile.TemporaryDirectory() as place:
        pathlib.Path(place, "scene.json").touch()
        assert complete("render", "sc", place=place) == ["scene.json"] == complete("render", "-o", "s", place=place)


def check_fish():
    fish = shutil.which("fish")
    if not fish:
        left_out.append("fish is not installed")
        return
    with tempfile.TemporaryDirectory() as home:
        pathlib.Path(home, "scene.json").touch()

        def complete(line):
            done = run(fish, "--no-config", "-c", f"source '{folder}/ballpark.fish'; complete -C '{line}'", cwd=home,
                       env={"HOME": home, "PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8"})
            assert done.returncode == 0 and not done.stderr, done.stderr
            return {row.split("\t")[0]: row for row in done.stdout.splitlines()}

        assert set(COMMANDS) <= set(complete("ballpark ")), complete("ballpark ")
        for command in COMMANDS:
            assert set(f"--{option}" for option in OPTIONS[command]) <= set(complete(f"ballpark {command} --")), command
        assert set(complete("ballpark render --precision ")) == {"single", "double"}
        assert set(complete("ballpark generate ")) == {"cover", "field"}
        assert "scene.json" in complete("ballpark render s") and "scene.json" not in complete("ballpark devices s")
        assert "samples per pixel" in complete("ballpark render --sp")["--spp"]


def check_zsh():
    text = (folder / "_ballpark").read_text()
    for command in COMMANDS:
        part = re.search(rf"^        {command}\)\n(.*?);;$", text, re.M | re.S).group(1)
        for option in OPTIONS[command]:
            assert re.search(rf"--{option}[=\[}}]", part), f"_ballpark: {command} --{option}"
    zsh = shutil.which("zsh")
    if not zsh:
        left_out.append("zsh is not installed")
        return
    # A shell of its own at a pseudo-terminal gets the words and two tabs, and lists what fits.
    code = r'''
zmodload zsh/zpty
zpty z "zsh -f -i"
zpty -w z "PS1=; fpath=($2 \$fpath); autoload -Uz compinit; compinit -D -u; bindkey '^I' complete-word; zstyle ':completion:*' list-colors ''; LISTMAX=0; cd $1; echo be''gun"
zpty -r -m z out '*begun*'
zpty -w -n z "ballpark render --precision "$'\t\t'
out=; for turn in {1..300}; do
    while zpty -r -t z more; do out+=$more; done
    [[ $out == *single* ]] && break
    sleep 0.1
done
print -r -- "$out"
zpty -d z
'''
    with tempfile.TemporaryDirectory() as place:
        done = run(zsh, "-n", folder / "_ballpark")
        assert done.returncode == 0 and not done.stderr, done.stderr
        try:
            done = subprocess.run([zsh, "-f", "-c", code, "zsh", place, str(folder)], capture_output=True, text=True,
                                  timeout=60, check=False, env={"HOME": place, "PATH": "/usr/bin:/bin", "TERM": "dumb"})
        except subprocess.TimeoutExpired:
            left_out.append("zsh did not answer: its completion was read, not used")
            return
        if "--precision" not in done.stdout:
            left_out.append("zsh has no pseudo-terminal: its completion was read, not used")
        else:
            assert re.search(r"double +single", done.stdout), done.stdout


check_pages()
check_bash()
check_fish()
check_zsh()
for reason in left_out:
    print(f"skipped: {reason}")
print(f"{len(COMMANDS)} commands, {sum(map(len, OPTIONS.values()))} options: ok")
