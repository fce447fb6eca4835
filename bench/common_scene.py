#!/usr/bin/env python3
"""Turns a scene into what other renderers know as well: every metal a mirror, Fresnel's equations for glass.

    common_scene.py SCENE.json OUT.json

In:    a scene.   Out: the same with fuzz 0, exact Fresnel, and the files of its clouds found beside OUT too.
Knows: the scene's grammar.   Does not know: other renderers.
"""
import json
import os
import pathlib
import sys


def common(document):
    for material in document["materials"].values():
        if material["type"] == "metal":
            material["fuzz"] = 0
            material.pop("fuzz_shape", None)
        if material["type"] == "dielectric":
            material["fresnel"] = "exact"
    return document


def write(source, target):
    source, target = pathlib.Path(source).resolve(), pathlib.Path(target).resolve()
    document = common(json.loads(source.read_text()))
    for cloud in document.get("clouds", []):
        cloud["file"] = os.path.relpath(source.parent / cloud["file"], target.parent)
    target.write_text(json.dumps(document, indent=1) + "\n")
    return target


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write(*sys.argv[1:])
