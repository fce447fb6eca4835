"""Figures that scripts write into documents: what stands between <!-- figure NAME --> and <!-- end --> is replaced, and the
text around it is written by hand. A figure that begins after the end of a line is followed by one. A name may occur several times."""
import re
import sys

FIGURE = re.compile(r"(<!-- figure (.+?) -->)(\n?)(.*?)(\n?)(<!-- end -->)", re.S)


def put(document, values, partly=False):
    """Writes `values`, texts by name, into `document`. Without `partly`, each of its figures must have a value."""
    text = document.read_text(encoding="utf-8")
    missing = {found[2] for found in FIGURE.finditer(text)} - values.keys()
    if missing and not partly:
        sys.exit(f"{document} has figures without a value: {', '.join(sorted(missing))}")
    document.write_text(FIGURE.sub(lambda found: found[0] if found[2] in missing else "".join(
        (found[1], found[3], values[found[2]].strip("\n"), found[3], found[6])), text), encoding="utf-8")
