"""Scenes with arrays larger than the device's largest buffer: they are split, and the picture is the same, bit for bit.

Usage: test_parts.py BALLPARK SOURCE_DIR [packet | --deep]

The shim refuses larger buffers, so a picture that comes out was made of parts. Quick: a packet of paths for each work-item, with lamps, and
one path, or the packet alone. --deep: the pool form, double precision, spheres that move, lamps among them, lamps alone in parts, layers of an
EXR and `explain --pixel` too.
"""
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

program, deep, packet_alone = sys.argv[1], "--deep" in sys.argv, "packet" in sys.argv
source = pathlib.Path(sys.argv[2])
SPHERES = 3000
LIMIT = 20000  # of bytes; in single precision, the spheres take about 70,000, the tree of 900 lamps 50,000
LAMPS_ALONE = 90000  # that of 2700 lamps takes more, and no other array does


def scene(moving=False, lamps=0):
    """`lamps`: how many of ten spheres are lamps."""
    draw = random.Random(7).uniform
    spheres = []
    for number in range(SPHERES):
        center = [draw(-4, 4), draw(-4, 4), draw(-4, 4)]
        sphere = {"center": center, "radius": draw(0.1, 0.3), "material": "lamp" if number % 10 < lamps else ("matte", "metal", "dark")[number % 3]}
        if moving and number % 2:
            sphere["center_end"] = [x + draw(-0.2, 0.2) for x in center]
        spheres.append(sphere)
    return {"camera": {"image_width": 12, "aspect_ratio": 1, "lookfrom": [9, 8, 10], "lookat": [0, 0, 0], "samples_per_pixel": 8,
                       "max_depth": 5},
            "materials": {"matte": {"type": "lambertian", "albedo": [0.7, 0.5, 0.3]},
                          "metal": {"type": "metal", "albedo": [0.8, 0.8, 0.9], "fuzz": 0.2},
                          "dark": {"type": "lambertian", "albedo": [0.1, 0.2, 0.3]},
                          "lamp": {"type": "diffuse_light", "emit": [4, 4, 4]}},
            "spheres": spheres}


def run(limit, *arguments, code=0):
    pretended = {} if limit is None else {"LD_PRELOAD": shim, "PRETEND_ALLOCATION": str(limit)}
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=900, check=False,
                          env={**os.environ, **pretended})
    assert done.returncode == code, f"{arguments}: exit code {done.returncode}\n{done.stdout}{done.stderr[-3000:]}"
    return done


def same(folder, file, limit, *options):
    pictures = []
    for number, most in enumerate((None, limit)):
        path = folder / f"{number}.pfm"
        run(most, "render", file, "--quiet", "-o", path, *options)
        pictures.append(path.read_bytes())
    if pictures[0] != pictures[1]:
        print(f"FAILED: in parts, {file.name} with {options} makes another picture")
        sys.exit(1)
    print(f"{file.name} {' '.join(options)}: the same picture")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    shim = folder / "allocation_shim.so"
    compiler = os.environ.get("CC") or shutil.which("cc")
    if compiler is None:
        print("skipped: no C compiler to make the shim")
        sys.exit(77)
    subprocess.run([*compiler.split(), "-std=c11", "-shared", "-fPIC", source / "tests/drivers/allocation_shim.c", "-o", shim, "-ldl"],
                   check=True)
    scenes = {"still": {}, "moving": {"moving": True}, "lamps": {"lamps": 3}, "moving-lamps": {"moving": True, "lamps": 3},
              "many-lamps": {"lamps": 9}}
    for title, options in scenes.items():
        (folder / f"{title}.json").write_text(json.dumps(scene(**options)))
    still, moving, lamps, moving_lamps, many_lamps = (folder / f"{title}.json" for title in scenes)
    same(folder, lamps, LIMIT, "--kernel", "packet")
    if packet_alone:
        sys.exit(0)
    same(folder, still, LIMIT, "--kernel", "sample")

    # Not even the most parts suffice: what is too large, and what the device allows.
    failed = run(3000, "render", still, "--quiet", "--width", "4", "-o", folder / "no.pfm", code=1).stderr
    assert "the spheres takes" not in failed and "in one allocation, and 8 are used for it at most; use a smaller scene" in failed, failed
    # The picture is never split.
    failed = run(LIMIT, "render", still, "--quiet", "--width", "40", "-o", folder / "no.pfm", code=1).stderr
    assert "the picture's sums" in failed and "in one allocation; use a smaller picture" in failed, failed

    if deep:
        same(folder, still, LIMIT, "--kernel", "packet")
        same(folder, still, LIMIT, "--kernel", "pool")
        same(folder, still, LIMIT, "--precision", "double", "--kernel", "packet")
        same(folder, moving, LIMIT, "--kernel", "packet")
        same(folder, moving, LIMIT, "--kernel", "sample")
        same(folder, lamps, LIMIT, "--kernel", "sample")
        same(folder, moving_lamps, LIMIT, "--kernel", "packet")
        same(folder, many_lamps, LAMPS_ALONE, "--kernel", "packet")
        layers = []
        for most in (None, LIMIT):
            run(most, "render", still, "--quiet", "-o", folder / "layers.exr")
            layers.append((folder / "layers.exr").read_bytes())
            layers.append(run(most, "explain", still, "--pixel", "6,6").stdout)
        assert layers[0] == layers[2] and layers[1] == layers[3], "in parts, layers or paths differ"
        print("layers and the paths of a pixel: the same")
