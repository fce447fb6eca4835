"""The rooms of host/ are what ARCHITECTURE.md says: includes go downward only, and every file opens with its own name.

Run as: python3 test_rooms.py SOURCE_DIR
"""
import pathlib
import re
import sys

# Each room may include those above it in this list that its line names, and base.
MAY_INCLUDE = {
    "base": set(),
    "image": set(),
    "figure": {"image"},
    "scene": {"image", "figure"},
    "expressions": set(),
    "particles": {"scene", "expressions"},
    "meshes": {"particles"},
    "formats": {"image", "figure", "scene", "expressions", "particles", "meshes"},
    "packed": {"image", "scene"},
    "opencl": {"packed"},
    "film": {"scene"},
    "cluster": set(),
    "render": {"scene", "packed", "opencl", "film", "cluster"},
    "reference": {"scene"},
    "check": {"scene", "film", "image", "render", "reference"},
    "study": {"scene", "film", "image", "render", "reference"},
    "view": {"scene", "film", "image", "render", "reference"},
    # The command line: what it is, what people see, what a process can do, what is written, what is done.
    "cli/line": {"scene", "formats", "film"},
    "cli/terminal": {"image", "cli/line"},
    "cli/process": {"opencl", "cli/line", "cli/terminal"},
    "cli/output": {"scene", "film", "image", "figure", "render", "cli/line", "cli/terminal"},
    "cli/job": {"scene", "formats", "packed", "opencl", "film", "image", "cluster", "render", "cli/line", "cli/terminal",
                "cli/process", "cli/output"},
    "cli/conform": {"formats", "packed", "opencl", "render", "check", "cli/line", "cli/terminal", "cli/process",
                    "cli/output"},
    "cli": {"scene", "formats", "packed", "opencl", "film", "image", "cluster", "render", "check", "study", "view",
            "cli/line", "cli/terminal", "cli/process", "cli/output", "cli/job", "cli/conform"},
    # Modules, which are built apart.
    "cluster/mpi": {"cluster"},
    "view/sdl": {"view"},
    "figure/cairo": {"figure"},
}


def faults_of(source):
    host = source / "host"
    rooms = {str(path.relative_to(host)) for path in host.glob("**/*") if path.is_dir()}
    for room in sorted(rooms ^ set(MAY_INCLUDE)):
        yield f"host/{room}: a room that this test or the source tree does not know"
    kernel_headers = {path.name for path in (source / "kernels").glob("*.h")}
    for path in sorted(host.glob("*/**/*.[ch]")):
        room, text = str(path.parent.relative_to(host)), path.read_text(encoding="utf-8")
        if room not in MAY_INCLUDE:
            continue
        place = path.relative_to(source)
        if not text.startswith(f"/* {path.name}: "):
            yield f"{place}: does not open with \"/* {path.name}: ...\""
        guard = f"BP_{room}_{path.stem}_H".upper().replace("/", "_")
        if path.suffix == ".h" and f"#ifndef {guard}\n" not in text:
            yield f"{place}: its guard is not {guard}"
        for include in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE):
            other = include.rpartition("/")[0] or room
            if include == "ballpark.h" or include in kernel_headers:
                continue
            if include.startswith("."):
                yield f"{place}: includes {include}, not by its room"
            elif other == room and not (path.parent / include).exists():
                yield f"{place}: includes {include}, which is not beside it"
            elif other not in MAY_INCLUDE[room] | {room, "base"}:
                yield f"{place}: includes {include}, and {room} may not know {other}"


def main():
    faults = list(faults_of(pathlib.Path(sys.argv[1])))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
