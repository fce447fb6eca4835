"""Tachyon, beside which bench/particle_peers measures, shows the same particles in the same light: equal means, square by square.

    test_particle_peers.py PROGRAM SOURCE_DIR
"""
import importlib.machinery
import importlib.util
import math
import os
import pathlib
import shutil
import sys
import tempfile

program, source = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("particle_peers", str(source / "bench/particle_peers"))
peers = importlib.util.module_from_spec(importlib.util.spec_from_loader("particle_peers", loader))
loader.exec_module(peers)

COUNT, SAMPLES, BAND = 2000, 16, 48
TOLERANCE = 0.03  # of white; Tachyon's pixels lie half a pixel beside ours, which costs up to 0.02

if shutil.which("tachyon") is None:
    print("skipped: no Tachyon (Debian: tachyon)")
    sys.exit(77)

with tempfile.TemporaryDirectory() as folder:
    stem = peers.particle_data.write(COUNT, folder)
    bands = []
    for one in (peers.Ballpark({"build": str(program.parent)}), peers.Tachyon()):
        path = os.path.join(folder, "picture" + one.ending)
        peers.run(one.command(stem, path, SAMPLES, 4))
        shown, row = peers.pixels(path), 3 * peers.particle_data.WIDTH
        # Squares of BAND pixels, in which neither noise nor the rims of single particles matter much.
        bands.append([math.fsum(shown[y * row + 3 * x + c] for y in range(top, top + BAND) for x in range(left, left + BAND)) / BAND ** 2
                      for top in range(0, peers.particle_data.HEIGHT, BAND)
                      for left in range(0, peers.particle_data.WIDTH - BAND + 1, BAND) for c in range(3)])
    worst = max(abs(a - b) for a, b in zip(*bands))
    means = [math.fsum(band) / len(band) for band in bands]
    print(f"means {means[0]:.4f} and {means[1]:.4f}; squares differ by at most {worst:.4f} of white")
    assert len(bands[0]) == len(bands[1]) > 300
    assert min(bands[0]) < 0.5 < max(bands[0]), "the particles are not in the picture"
    assert worst < TOLERANCE and abs(means[0] - means[1]) < 0.005
