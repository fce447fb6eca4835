"""Within a room of host/, no file depends on itself by way of others: neither its header and code by what they include, nor its code
by the functions and tables that it uses.

A unit is NAME.h and NAME.c together. The second graph is found in the sources: whatever begins with bp_ and is defined in one .c file
of host/ is a name, and a unit uses another one if its code has a name of it. Names that a room uses of another room must be of one
that stands above it in the order of test_rooms.py.

Run as: python3 test_circles.py SOURCE_DIR
"""
import collections
import pathlib
import re
import sys

from test_heads import code_of
from test_rooms import MAY_INCLUDE

# Headers whose type is the matter of a whole group of files: it is declared there with the functions of the first of them, which
# includes what the others declare. What includes such a header is not counted.
ONE_TYPE = {"scene/scene", "film/film", "film/adaptive", "packed/tree", "study/study", "cli/line/options"}
DEFINED = re.compile(r"^(?!static|typedef|extern|#)[A-Za-z_][\w \t*]*?\**\b(bp_\w+)(?:\([^;{}]*\)\s*\{|(?:\[[^]]*\])?\s*=)", re.MULTILINE)


def circles_of(graph):
    """The sets of nodes that reach each other (R. Tarjan, 1972, by the simpler way of reachability)."""
    reached = {}
    for node in graph:
        seen, open_nodes = set(), list(graph[node])
        while open_nodes:
            other = open_nodes.pop()
            if other not in seen:
                seen.add(other)
                open_nodes.extend(graph.get(other, ()))
        reached[node] = seen
    found = {frozenset(b for b in reached[a] if a in reached.get(b, ())) for a in graph if a in reached[a]}
    return sorted(sorted(circle) for circle in found)


def unit_of(host, path):
    return str(path.relative_to(host).with_suffix(""))


def graphs_of(source):
    """Two graphs, of units by their paths: what they include, and what they use."""
    host = source / "host"
    code = {path: code_of(path.read_text(encoding="utf-8")) for path in sorted(host.glob("*/**/*.[ch]"))}
    includes, uses, home = collections.defaultdict(set), collections.defaultdict(set), {}
    for path, text in code.items():
        if path.suffix == ".c":
            home.update((name, unit_of(host, path)) for name in DEFINED.findall(text))
    for path, text in code.items():
        unit = unit_of(host, path)
        for include in re.findall(r'^#include "([^"]+)\.h"', text, re.MULTILINE):
            other = include if "/" in include else str((path.parent / include).relative_to(host))
            if other != unit and (host / f"{other}.h").exists():
                includes[unit].add(other)
        if path.suffix == ".c":
            unquoted = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)  # a message may name a function
            uses[unit] |= {home[name] for name in set(re.findall(r"\bbp_\w+", unquoted)) if home.get(name, unit) != unit}
    return includes, uses


def room_of(unit):
    return unit.rpartition("/")[0]


def within(room, graph):
    return {unit: {other for other in others if room_of(other) == room} for unit, others in graph.items() if room_of(unit) == room}


def faults_of(source):
    includes, uses = graphs_of(source)
    order = list(MAY_INCLUDE)
    for room in order:
        for circle in circles_of(within(room, uses)):
            yield f"host/{room}: uses in a circle: {', '.join(circle)}"
        graph = within(room, includes)
        for circle in circles_of({unit: others - ONE_TYPE for unit, others in graph.items()}):
            yield f"host/{room}: includes in a circle: {', '.join(circle)}"
        for unit in sorted(ONE_TYPE):
            if room_of(unit) == room and not any(unit in circle for circle in circles_of(graph)):
                yield f"{unit}: is in no circle of includes, so it need not stand in ONE_TYPE"
    for unit, others in sorted(uses.items()):
        for other in sorted(others):
            if room_of(unit) in order and room_of(other) in order and order.index(room_of(other)) > order.index(room_of(unit)):
                yield f"host/{unit}: uses {other}, which stands below its room"


def main():
    assert circles_of({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}, "e": {"f"}, "f": {"g"}, "g": {"e", "a"}}) == [["b", "c"], ["e", "f", "g"]]
    assert DEFINED.findall("int bp_a(int x) {\n}\nstatic int bp_b(void) {\nconst T bp_c[] = {\nint bp_d(void);\n"
                           "    x = bp_e(y) {\nT *bp_f(\n    int x) {\n") == ["bp_a", "bp_c", "bp_f"]
    faults = list(faults_of(pathlib.Path(sys.argv[1])))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
