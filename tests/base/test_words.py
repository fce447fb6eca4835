"""Tables by an enumeration are complete: a compiler refuses one that lacks a value, and nothing in host/ has such a table
otherwise. Usage: test_words.py SOURCE_DIR CC"""

import pathlib
import re
import subprocess
import sys

source, compiler = pathlib.Path(sys.argv[1]), sys.argv[2]
PROGRAM = """#include "base/words.h"
#include <stddef.h>
typedef enum Sort { SORT_A, SORT_B, SORT_C } Sort;
#define SORTS(X) X(SORT_A, "a") X(SORT_B, "b") %s
%s(Sort, static const char *const names, SORTS);
int main(void) { return names[SORT_B][0] - 'b'; }
"""


def compiles(*parts):
    done = subprocess.run([compiler, "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only", "-I", source / "host",
                           "-x", "c", "-"], input=PROGRAM % parts, text=True, capture_output=True, check=False)
    return done.returncode == 0, done.stderr


for macro in ("BP_WORDS", "BP_WORDS_ENDED"):
    good, errors = compiles('X(SORT_C, "c")', macro)
    assert good, errors
    good, errors = compiles("", macro)
    assert not good and "SORT_C" in errors, errors

tables = [f"{path.relative_to(source)}: {found.group()}" for path in sorted((source / "host").rglob("*.[ch]"))
          for found in re.finditer(r"\w+\[\] = \{\s*\[[A-Z]+_\w+\] =", path.read_text())]
assert not tables, f"these tables may lack a value; BP_WORDS (base/words.h) makes sure that they do not: {tables}"
print("tables by enumerations: ok")
