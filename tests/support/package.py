"""For tests of the Python package: imports it from the source tree, with the library of the build tree.

Usage: ballpark, np = package.load(SOURCE_DIR, BUILD_DIR), before anything else of the package is imported. Without numpy
the test ends as skipped.
"""

import os
import pathlib
import sys


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


def load(source, build):
    try:
        import numpy
    except ImportError:
        skip("no numpy for this Python")
    os.environ["BALLPARK_LIBRARY"] = str(pathlib.Path(build, "libballpark.so"))
    sys.path.insert(0, str(pathlib.Path(source, "python")))
    sys.dont_write_bytecode = True
    import ballpark
    return ballpark, numpy


def refused(kind, words, function, *arguments, **named):
    """Calls the function, which must raise `kind` with a message that has all words; returns the exception."""
    try:
        function(*arguments, **named)
    except kind as error:
        for word in [words] if isinstance(words, str) else words:
            assert word in str(error), f'"{error}" lacks "{word}"'
        return error
    raise AssertionError(f"not refused: {arguments} {named}")
