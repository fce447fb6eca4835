"""What a file says at its head that it does not know, it does not know.

A head has the sentence "Does not know: scenes, OpenCL, how they are packed (film_stream.h)." Each part is either a noun of NOUNS, whose
pattern must not be found in the code of the file or of the headers that it includes itself; or it begins with a word such as what, how
or who: what the code is for, and who it serves, can be read in no code. A file that such a part names in brackets must not be included.

Run as: python3 test_heads.py SOURCE_DIR
"""
import pathlib
import re
import sys

CLAUSE = re.compile(r"(what|how|who|where|why|when|which|whether|whose|to whom)\b")
# Patterns of code without comments. Public words of ballpark.h are known to all of host/, so it is not looked into.
NOUNS = {
    "OpenCL": r"\bCL/|\bcl_[a-z]|\bcl[A-Z]\w*\(|\bCL_[A-Z]|\"opencl/",
    "MPI": r"\bmpi\.h|\bMPI_",
    "SDL": r"\bSDL_|\bSDL\.h",
    "JSON": r"jansson|\bjson_",
    "XML": r"<\?xml",
    "files": r"\bFILE\b|\bf?open\(|\bpath\b|\"(base/)?output_file\.h",
    "the terminal": r"\bisatty\b|TIOCGWINSZ|\"(cli/)?terminal\w*\.h",
    "the command line": r"\bBpCommandLine\b|\bargv\b",
    "exit codes": r"\bexit\(|\bEXIT_|\bexit_code",
    "threads": r"\bpthread|\bBpTeam\b",
    "windows": r"\bBpWindow\b|\"(view/)?window\.h|\bSDL_",
    "clocks": r"\bclock_gettime\b|\bbp_clock\w*|\"(base/)?clock\.h",
    "time": r"seconds|_ns\b|\"(base/)?clock\.h",
    "scenes": r"\bBpScene\b|\"(scene/)?scene\.h",
    "particles": r"\bBpParticles?\b|\"(particles/)?particles\.h",
    "effects": r"\bBpEffects?\b|\"(packed/)?effects\.h",
    "packed data": r"\bBpPacked\b|\"(packed/)?pack\.h|\"scene_types\.h",
    "pictures": r"\bBpPicture\b|\"image/(?!texels)",
    "devices": r"\bBpDevice(Info)?\b|\bcl_device_id\b|\"(opencl/)?device\.h",
    "kernels": r"\bcl_kernel\b|\"(opencl/)?program\.h",
    "buffers": r"\bcl_mem\b|\bclCreateBuffer\b",
    "stop rules": r"\bBpStopRule\b|\"(render/)?stop_rule\.h",
    "pixels": r"\bpixel|PIXEL",
    "chunks": r"\bchunk|CHUNK",
    # of kernels/
    "lanes": r"\blane|LANE|\bany_lane\b",
    "rays": r"\bRay\b|\bray->",
    "spheres": r"[sS]phere|SPHERE",
    "trees": r"\btree|TREE|\bnode|NODE",
    "nodes": r"\bnode|NODE",
    "leaves": r"\blea[fv]|LEAF",
    "paths": r"\bPath\b|\bpath->",
    "surfaces": r"\bSurface\b|\bsurface->",
    "materials": r"material|MATERIAL",
    "lobes": r"\blobe|LOBE",
    "other lobes": r"\b(?!STEM_)(lambertian|metal|dielectric|interface)_(sample|eval|pdf)\b",
    "media": r"\bmedi(um|a)\b|MEDIUM|(?<!EFFECT_)MEDIA",
    "the sky": r"\bsky|SKY|background",
    "shadows": r"shadow|SHADOW|occluded",
}


def code_of(text):
    return re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)


def claim_of(text):
    """The parts of "Does not know: ...", and the files that they name."""
    head = re.match(r"/\*.*?\*/", text, re.S)
    lines = (re.sub(r"^ \*/?|\*/$", "", line).strip() for line in head.group()[2:].split("\n")) if head else ()
    claim = re.search(r"Does not know: (.*?)\.(?: |$)", " ".join(lines) + " ")
    if claim is None:
        return [], []
    files = re.findall(r"\(([^()]*)\)", claim.group(1))
    parts = re.sub(r" \([^()]*\)", "", claim.group(1)).split(", ")
    return [re.sub(r"^or ", "", part) for part in parts], re.findall(r"[\w/]+\.(?:h|c|cl)\b", " ".join(files))


def faults_of(source):
    for path in sorted([*source.glob("host/**/*.[ch]"), *source.glob("kernels/**/*.cl"), *source.glob("kernels/**/*.h")]):
        text, place = path.read_text(encoding="utf-8"), path.relative_to(source)
        if re.search(r"Does not know: ", text) and not claim_of(text)[0]:
            yield f"{place}: \"Does not know: ...\" is not a sentence of its head"
        parts, files = claim_of(text)
        known = {place: code_of(text)}
        for include in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE):
            for folder in (path.parent, source / "host", source / "kernels"):
                if (folder / include).is_file() and include != "ballpark.h":
                    known[include] = code_of((folder / include).read_text(encoding="utf-8"))
                    break
        for name in files:
            if not any((folder / name).is_file() for folder in (path.parent, source / "host", source / "kernels")):
                yield f"{place}: names {name}, which is not there"
        for part in parts:
            if CLAUSE.match(part):
                continue
            if part not in NOUNS:
                yield f"{place}: \"{part}\" is neither a noun of this test nor a clause"
                continue
            for name, code in known.items():
                found = re.search(NOUNS[part].replace("STEM", path.stem), code)
                if found:
                    yield f"{place}: does not know {part}, and {name} has \"{found.group()}\""
                    break


def main():
    faults = list(faults_of(pathlib.Path(sys.argv[1])))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
