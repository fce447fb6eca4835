"""Tables by an enumeration are complete: compilers refuse one that lacks a value, and say nothing of one that does not; nothing
in host/ has such a table otherwise. Usage: test_words.py SOURCE_DIR CC"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1])
COMPILERS = {sys.argv[2], *filter(shutil.which, ("gcc", "clang"))}  # each warns of other things
PROGRAM = """#include "base/words.h"
#include <stddef.h>
typedef enum Sort { SORT_A, SORT_B, SORT_C } Sort;
#define SORTS(X) X(SORT_A, "a") X(SORT_B, "b") %s
%s(Sort, static const char *const names, SORTS);
int main(void) { return names[SORT_B][0] - 'b'; }
"""


def compiles(compiler, *parts):
    with tempfile.TemporaryDirectory() as folder:  # in a file, since clang warns of less in its standard input
        program = pathlib.Path(folder, "sort.c")
        program.write_text(PROGRAM % parts)
        done = subprocess.run([compiler, "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", "-I", source / "host",
                               program], text=True, capture_output=True, check=False)
    return done.returncode == 0, done.stderr


for cc in COMPILERS:
    for macro in ("BP_WORDS", "BP_WORDS_ENDED"):
        good, errors = compiles(cc, 'X(SORT_C, "c")', macro)
        assert good, errors
        good, errors = compiles(cc, "", macro)
        assert not good and "SORT_C" in errors, errors

tables = [f"{path.relative_to(source)}: {found.group()}" for path in sorted((source / "host").rglob("*.[ch]"))
          for found in re.finditer(r"\w+\[\] = \{\s*\[[A-Z]+_\w+\] =", path.read_text())]
assert not tables, f"these tables may lack a value; BP_WORDS (base/words.h) makes sure that they do not: {tables}"
print("tables by enumerations: ok")
