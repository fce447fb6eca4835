"""The structs and words of python/ballpark/_library.py are those of ballpark.h, as the compiler sees it; and so are the
functions that it calls.

Usage: test_python_structs.py SOURCE_DIR BUILD_DIR CC
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import package

source, build, compiler = sys.argv[1:]
ballpark, _ = package.load(source, build)
from ballpark import _library as lib

ENUMS = [("BP_TRANSFER", lib.TRANSFERS), ("BP_FORMAT", lib.FORMATS), ("BP_DEVICE", lib.DEVICE_TYPES)]
ENUMS += [(f"BP_{name.upper()}", words) for name, words in lib.CHOICES.items()]

lines = ['#include <ballpark.h>', '#include <stdio.h>', 'int main(void) {', 'printf("{");']
for struct in lib.STRUCTS:
    name = struct.__name__
    lines.append(f'printf("\\"{name}\\": {{\\"\\": %zu", sizeof({name}));')
    for member in (field[0] for field in struct._fields_):
        lines.append(f'printf(", \\"{member}\\": [%zu, %zu]", offsetof({name}, {member}), sizeof((({name} *)0)->{member}));')
    lines.append('printf("}, ");')
lines.append('printf("\\"enums\\": {\\"\\": 0");')
for prefix, words in ENUMS:
    for word in words:
        name = f"{prefix}_{word.upper().replace('-', '_')}"
        lines.append(f'printf(", \\"{name}\\": %d", (int){name});')
lines.append('printf("}}"); return 0; }')

with tempfile.TemporaryDirectory() as folder:
    program = pathlib.Path(folder, "layout")
    program.with_suffix(".c").write_text("\n".join(lines))
    subprocess.run([compiler, "-std=c11", f"-I{source}/host", program.with_suffix(".c"), "-o", program], check=True)
    found = json.loads(subprocess.run([program], capture_output=True, text=True, check=True).stdout)

import ctypes
header = pathlib.Path(source, "host/ballpark.h").read_text()
for struct in lib.STRUCTS:
    layout = found[struct.__name__]
    assert ctypes.sizeof(struct) == layout.pop(""), f"{struct.__name__}: its size"
    for member, place in layout.items():
        field = getattr(struct, member)
        assert [field.offset, field.size] == place, f"{struct.__name__}.{member}: {field}, the header has {place}"
    # A member that hides in what would be padding moves nothing: so they are counted too.
    body = re.search(r"typedef struct %s \{(.*?)\n\} %s;" % (struct.__name__, struct.__name__), header, re.S).group(1)
    body = re.sub(r"/\*.*?\*/", "", body, flags=re.S)
    declared = sum(statement.count(",") + 1 for statement in body.split(";") if statement.strip())
    assert declared == len(struct._fields_), f"{struct.__name__}: {len(struct._fields_)} members, {declared} declared"
for prefix, words in ENUMS:
    for number, word in enumerate(words):
        name = f"{prefix}_{word.upper().replace('-', '_')}"
        assert found["enums"][name] == number, f"{name} is {found['enums'][name]}, not {number}"
    listed = set(re.findall(rf"\b({prefix}_[A-Z0-9_]+)\b(?=[,\s}}])", re.sub(r"/\*.*?\*/", "", header, flags=re.S)))
    assert len(listed) == len(words), f"{prefix}: {sorted(listed)}, expected {words}"

assert lib.API_VERSION == int(re.search(r"#define BP_API_VERSION (\d+)", header).group(1))
library = lib.library()
for name in [*lib._STATUS, *lib._OTHER]:
    match = re.search(rf"BP_API [\w ]+[ *]{name}\((.*?)\);", header, re.S)
    assert match, f"{name} is not declared"
    parameters = [] if match.group(1) == "void" else match.group(1).split(",")
    assert len(getattr(library, name).argtypes) == len(parameters), f"{name}: {match.group(1)}"
print(f"{len(lib.STRUCTS)} structs, {len(lib._STATUS) + len(lib._OTHER)} functions: as declared")
