"""Every relative link of every document leads somewhere: to a file or folder that is under version control, and to a heading or a
named place of it where the link has an anchor.

Run as: python3 test_links.py SOURCE_DIR
"""
import pathlib
import re
import subprocess
import sys
import urllib.parse

FENCED = re.compile(r"(?ms)^```.*?^```")
CODE = re.compile(r"`[^`\n]*`")
IMAGE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)[^)]*\)")
LINK = re.compile(r"\[[^\[\]]*\]\(([^)\s]+)[^)]*\)")
TAG = re.compile(r"(?:src|href)=\"([^\"]+)\"")
PLACE = re.compile(r"<a (?:name|id)=\"([^\"]+)\"")
HEADING = re.compile(r"(?m)^#{1,6} +(.*?) *#*$")


def slug(heading):
    """The anchor that GitHub and GitLab give a heading: small letters, digits, hyphens and underscores stay, and each blank is a
    hyphen."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def anchors(text):
    found, seen = set(PLACE.findall(text)), {}
    for heading in HEADING.findall(FENCED.sub("", text)):
        name = slug(heading)
        found.add(name if name not in seen else f"{name}-{seen[name]}")
        seen[name] = seen.get(name, 0) + 1
    return found


def links(text):
    text = CODE.sub("", FENCED.sub("", text))
    text = re.sub(r"(?m)^    .*$", "", text)
    return IMAGE.findall(text) + LINK.findall(IMAGE.sub("", text)) + TAG.findall(text)


def indented_links_count_too(text):
    """Parts of lists may be indented by four; nothing here does that, and a link that hides so would not be read."""
    return [line for line in FENCED.sub("", text).splitlines() if re.match(r" {4,}(?:[-*]|\d+\.) .*\]\(", line)]


def faults(root, documents):
    known = set(subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"], stdout=subprocess.PIPE, text=True,
                               check=True).stdout.splitlines()) if (root / ".git").exists() else None
    for document in documents:
        text = document.read_text(encoding="utf-8")
        for line in indented_links_count_too(text):
            yield f"{document}: a link in an indented list: {line.strip()}"
        for link in links(text):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = urllib.parse.unquote(link).partition("#")
            target = (document.parent / path).resolve() if path else document
            if root not in (target, *target.parents) or not target.exists():
                yield f"{document}: {link}: there is no such file"
                continue
            name = str(target.relative_to(root))
            if known is not None and name not in known and not any(other.startswith(name + "/") for other in known):
                yield f"{document}: {link}: the file is not under version control"
            if anchor and (target.suffix != ".md" or anchor not in anchors(target.read_text(encoding="utf-8"))):
                yield f"{document}: {link}: there is no such heading"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    documents = sorted(path for path in root.rglob("*.md")
                       if not {"build", "node_modules", ".git"} & set(path.relative_to(root).parts))
    # What the test knows of Markdown, by hand.
    assert slug("The `--error` option: 1 % (really)") == "the---error-option-1--really", slug("The `--error` option: 1 % (really)")
    assert links("[a](b.md#c) `[no](x)` [![p](q.png)<br>t](r.md) <img src=\"s.png\">\n") == ["q.png", "b.md#c", "r.md", "s.png"]
    assert anchors("# A b\n## A b\n<a name=\"c\"></a>\n") == {"a-b", "a-b-1", "c"}
    assert len(documents) > 15, documents
    found = list(faults(root, documents))
    for fault in found:
        print(fault)
    print(f"{sum(len(links(document.read_text(encoding='utf-8'))) for document in documents)} links of {len(documents)} documents")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
