"""What Python costs beside the command line: the same million spheres, from numpy and from a PLY file, to a picture.

Usage: python_turns.py PROGRAM LIBRARY [SPHERES [ROUNDS [WIDTH [SPP]]]]

Both run as processes of their own, in turns, and what is compared is the processor time of each, threads and start of
Python included: the shortest of all rounds. The pictures must be equal bit for bit. The command line gets the
spheres as a binary PLY file, its fastest reader. The first turn of each, which compiles the kernel, is not counted.
"""

import os
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile

CAMERA = ('"camera": {"image_width": %d, "aspect_ratio": [4, 3], "samples_per_pixel": %d, "max_depth": 20, "vfov": 30, '
          '"fit": "scene", "view": "three-quarter"}, "lighting": "soft", "backdrop": [1, 1, 1], "transfer": "srgb"')
MATERIAL = '"materials": {"m": {"type": "lambertian", "albedo": [0.8, 0.8, 0.8]}}'

MAKE = """
import numpy as np
rng = np.random.default_rng(1)
np.savez("spheres.npz", positions=rng.random((%d, 3), np.float32), color=rng.random((%d, 3), np.float32))
data = np.load("spheres.npz")
rows = np.concatenate([data["positions"], data["color"]], axis=1).astype("<f4")
with open("spheres.ply", "wb") as file:
    names = "".join(f"property float {name}\\n" for name in ("x", "y", "z", "red", "green", "blue"))
    file.write(f"ply\\nformat binary_little_endian 1.0\\nelement vertex {len(rows)}\\n{names}end_header\\n".encode())
    rows.tofile(file)
"""
# numpy's array exists already when a program calls Ballpark; here it has to be read like the PLY file.
DRAW = """
import numpy as np, ballpark
data = np.load("spheres.npz")
picture = ballpark.render(data["positions"], radius=%r, color=data["color"], width=%d, spp=%d)
picture.save("python.pfm")
"""


def processor_seconds(command, folder, environment):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, env=environment, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    program, library = (os.path.abspath(path) for path in sys.argv[1:3])
    count, rounds, width, spp = [int(word) for word in sys.argv[3:]] + [1000000, 5, 400, 16][len(sys.argv) - 3:]
    radius = struct.unpack("<f", struct.pack("<f", 0.3 / count ** (1 / 3)))[0]
    package = pathlib.Path(__file__).resolve().parent.parent / "python"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        environment = dict(os.environ, BALLPARK_LIBRARY=library, PYTHONPATH=str(package))
        subprocess.run([sys.executable, "-c", MAKE % (count, count)], cwd=folder, check=True)
        (folder / "scene.json").write_text("{ %s, %s, \"clouds\": [{\"file\": \"spheres.ply\", \"radius\": %r, "
                                           "\"material\": \"m\"}] }" % (CAMERA % (width, spp), MATERIAL, radius))
        turns = {"command line": [program, "render", "scene.json", "-q", "-o", "command.pfm"],
                 "Python": [sys.executable, "-c", DRAW % (radius, width, spp)]}
        times = {turn: [] for turn in turns}
        for turn in range(rounds + 1):
            for what, command in turns.items():
                seconds = processor_seconds(command, folder, environment)
                if turn > 0:
                    times[what].append(seconds)
        same = (folder / "python.pfm").read_bytes() == (folder / "command.pfm").read_bytes()
    best = {what: min(seconds) for what, seconds in times.items()}
    for what, seconds in times.items():
        print(f"{what:12}  {best[what]:.2f} s of processor time, of {', '.join(f'{s:.2f}' for s in sorted(seconds))}")
    print(f"{count:,} spheres, {width} pixels wide, {spp} samples per pixel: Python / command line "
          f"{best['Python'] / best['command line']:.3f}; the pictures are {'the same' if same else 'DIFFERENT'}")
    return 0 if same else 1


sys.exit(main())
