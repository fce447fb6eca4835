#!/usr/bin/env python3
"""Hard scenes through the real program: kernel against reference; the packet kernel equals the sample kernel; the cover
moved by a million, in double, makes the picture of the cover at home.

    test_hard_scenes.py BALLPARK SOURCE_DIR
"""
import array
import json
import pathlib
import subprocess
import sys
import tempfile

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
SCENES = SOURCE / "tests/hard/scenes"


def run(*arguments):
    result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"ballpark {' '.join(map(str, arguments))}: exit {result.returncode}\n{result.stdout}{result.stderr}")
    return result


def pixels(path):
    with open(path, "rb") as file:
        for _ in range(3):
            file.readline()
        values = array.array("f")
        values.frombytes(file.read())
    return values


def difference(a, b):
    """Mean of |a - b| over the mean of a, and the share of values that are not the same."""
    total = sum(abs(x - y) for x, y in zip(a, b))
    return total / sum(a), sum(x != y for x, y in zip(a, b)) / len(a)


def main():
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for scene in sorted(SCENES.glob("*.json")):
            run("check", scene, "--width", 72, "--spp", 64, "--seed", 5, "--margin", 50)
            for kernel in ("sample", "packet"):
                run("render", scene, "--quiet", "--width", 72, "--spp", 8, "--kernel", kernel, "-o",
                    folder / f"{kernel}.pfm")
            share = difference(pixels(folder / "sample.pfm"), pixels(folder / "packet.pfm"))[1]
            print(f"{scene.stem}: kernel and reference agree; packet differs from sample in {share:.2%} of values")
            if share > 0:
                sys.exit(f"{scene.stem}: the two kernel forms differ")
            run("render", scene, "--quiet", "--width", 72, "--spp", 8, "--kernel", "sample", "--numerics", "plain",
                "-o", folder / "plain.pfm")
            apart = difference(pixels(folder / "sample.pfm"), pixels(folder / "plain.pfm"))[0]
            print(f"    --numerics plain is off by {apart:.1%} of the mean")

        run("generate", "cover", "--seed", 1, "-o", folder / "home.json")
        document = json.loads((folder / "home.json").read_text())
        camera = document["camera"]
        for name in ("lookfrom", "lookat"):
            camera[name] = [x + 1e6 for x in camera.get(name, [0, 0, 0] if name == "lookfrom" else [0, 0, -1])]
        for sphere in document["spheres"]:
            sphere["center"] = [x + 1e6 for x in sphere["center"]]
        (folder / "away.json").write_text(json.dumps(document))
        for place in ("home", "away"):
            run("render", folder / f"{place}.json", "--quiet", "--width", 90, "--spp", 16, "--precision", "double", "-o",
                folder / f"{place}.pfm")
        apart, share = difference(pixels(folder / "home.pfm"), pixels(folder / "away.pfm"))
        print(f"cover moved by 1e6: off by {apart:.2e} of the mean, {share:.1%} of values not the same")
        if apart > 1e-3:
            sys.exit("the cover moved by a million is another picture")
        run("check", folder / "away.json", "--width", 48, "--spp", 16, "--seed", 6, "--margin", 50)
        print("cover moved by 1e6: kernel and reference agree")


if __name__ == "__main__":
    main()
