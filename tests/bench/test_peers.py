"""Peers show the same pictures as ballpark: mean radiance within statistics, so that speeds are of the same work."""
import json
import math
import os
import subprocess
import sys
import tempfile

program, peers, scenes = sys.argv[1:4]
Z_MAX = 4.0  # of 3 channels of all pairs below; by chance about 1 run in 300
SAMPLES = 64


def call(command, variables={}):
    done = subprocess.run(command, check=True, capture_output=True, text=True, env={**os.environ, **variables})
    return json.loads(done.stdout)


def form(path, variables):
    """The form of the kernel that a device gets by itself."""
    return call([program, "bench", path, "--rounds", "1", "--time", "0.01", "--width", "16", "--json", "-", "-q"], variables)["kernel"]


def peer(name, path, *options):
    figures = call([os.path.join(peers, name), path, "--width", "160", "--spp", str(SAMPLES), *options])
    return figures["mean_radiance"], figures["standard_error"], figures["rays"] / figures["samples"]


def ours(path, folder):
    # the general kernel, so that one is compiled instead of one a scene; its pictures are those of the others
    stats = os.path.join(folder, "stats.json")
    subprocess.run([program, "render", path, "--width", "160", "--spp", str(SAMPLES), "--sampler", "independent", "--seed",
                    "77", "--effects", "all", "--roulette", "off", "-o", os.path.join(folder, "x.pfm"), "--stats", stats, "--quiet"], check=True)
    with open(stats) as file:
        figures = json.load(file)
    return figures["mean_radiance"], figures["rays"] / figures["samples"]


with tempfile.TemporaryDirectory() as folder:
    subprocess.run([program, "bench", "cover", "diffuse", "glass", "field-2000", "ball-1280", "-o", folder], check=True)
    paths = [os.path.join(folder, name + ".json") for name in ("cover", "diffuse", "glass", "field-2000")]
    # every lobe, fuzz, Fresnel and total reflection that the book has
    paths += [os.path.join(scenes, name + ".json") for name in
              ("v4-09-hemisphere", "v1-metal-fuzz", "v4-14-metal-fuzz", "v4-16-glass-always", "v4-17-air-bubble",
               "v3-18-view-distant", "v1-glass-hollow")]
    # what a peer cannot draw it refuses
    refused = subprocess.run([os.path.join(peers, "book_scalar"), os.path.join(scenes, "checkers.json"), "--method", "list"],
                             capture_output=True, text=True, check=False)
    assert refused.returncode == 2 and "found textures, expected none" in refused.stderr, refused
    ball = os.path.join(folder, "ball-1280.json")
    refused = subprocess.run([os.path.join(peers, "book_scalar"), ball], capture_output=True, text=True, check=False)
    assert refused.returncode == 2 and "found triangles, expected spheres" in refused.stderr, refused
    embree = os.path.exists(os.path.join(peers, "embree_peer"))
    for path in paths + [ball] * embree:
        means, rays = ours(path, folder)
        entries = [] if path == ball else [("book tree", *peer("book_scalar", path, "--method", "tree", "--seed", "1"))]
        if "cover" in path or "glass.json" in path:
            entries.append(("book list", *peer("book_scalar", path, "--method", "list", "--seed", "2")))
        methods = ("1", "16,coherent", "np", "np,huge") if "cover" in path or path == ball else ("np,robust,huge",)
        for method in methods if embree else ():
            entries.append((f"embree {method}", *peer("embree_peer", path, "--method", method, "--seed", "3")))
        for name, mean, error, peer_rays in entries:
            # ours has the variance of the peer: same samples, same scene
            zs = [(a - b) / (e * math.sqrt(2)) for a, b, e in zip(means, mean, error)]
            print(f"{os.path.basename(path):26s} {name:20s} z {' '.join(f'{z:5.1f}' for z in zs)}  "
                  f"segments a sample {rays:.4f} {peer_rays:.4f}")
            assert max(map(abs, zs)) < Z_MAX, (path, name, zs)
            assert abs(rays / peer_rays - 1) < .005, (path, name, rays, peer_rays)

    # the peers of bench/compare --isa draw what the others draw
    path = paths[0]
    means, _ = ours(path, folder)
    flags = []
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as file:
            flags = file.read().split()
    for isa, flag, embree_isa in (("avx2", "avx2", "avx2"), ("sse41", "sse4_1", "sse4.2")):
        if flag not in flags or not os.path.exists(os.path.join(peers, "book_scalar_" + isa)):
            print(f"skipped: no peers for {isa} here")
            continue
        entries = [peer("book_scalar_" + isa, path, "--method", "tree", "--seed", "4")]
        if embree:
            entries.append(peer("embree_peer_" + isa, path, "--method", "np", "--config", "isa=" + embree_isa, "--seed", "5"))
        for mean, error, _ in entries:
            zs = [(a - b) / (e * math.sqrt(2)) for a, b, e in zip(means, mean, error)]
            assert max(map(abs, zs)) < Z_MAX, (isa, zs)

    # --isa narrows the vectors of devices, too: with one float in each, a device gets no packets
    narrow = {"LD_PRELOAD": os.path.join(os.path.abspath(peers), "narrow_vectors.so"), "NARROW_VECTORS": "1"}
    if form(path, {}) == "packet":
        assert form(path, narrow) == "sample" and form(path, {**narrow, "NARROW_VECTORS": "64"}) == "packet"
