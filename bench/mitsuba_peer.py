#!/usr/bin/env python3
"""Mitsuba 3 as a peer: draws a scene of ballpark with the integrator `path`, which samples lamps too.

    mitsuba_peer.py SCENE.json [--width N] [--spp N] [--passes N] [--seed N] [--depth N] [--output FILE.pfm]
    mitsuba_peer.py --why            exit code 0 if Mitsuba runs here; else 77, and the reason

In:    a scene of what both know: spheres, triangles and meshes; matte, mirror, glass with exact Fresnel, lamps, one colour of
       sky, a camera without lens. bench/common_scene.py makes such a scene of any other, `ballpark scene` triangles of quads and boxes.
Out:   one object of JSON, as the other peers print it: seconds and processor seconds of each pass (after a first one that
       compiles and does not count), mean radiance and its standard error, and the squared error of a pass relative to
       the picture; with --output the mean picture.

It needs the packages of bench/mitsuba_setup, whose Python runs this; nothing else in ballpark needs them.
"""
import argparse
import glob
import json
import os
import pathlib
import re
import struct
import sys
import tempfile
import time

VARIANT = "llvm_ad_rgb"


class Unable(Exception):
    pass


def llvm_library():
    """A libLLVM that Dr.Jit can use. LLVM 15 stops the whole process on processors with AVX-512, and 16 is not tried."""
    found = []
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*"):
        version = re.search(r"libLLVM(?:-(\d+)[.\d]*\.so|\.so\.(\d+))", path)
        if version and int(version.group(1) or version.group(2)) >= 17:
            found.append((int(version.group(1) or version.group(2)), path))
    return max(found)[1] if found else None


def load():
    """The module mitsuba, ready."""
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        path = llvm_library()
        if path is None:
            raise Unable("no libLLVM of version 17 or later (Debian: libllvm19)")
        os.environ["DRJIT_LIBLLVM_PATH"] = path
    try:
        import mitsuba
        mitsuba.set_variant(VARIANT)
    except ImportError as error:
        raise Unable(f"mitsuba cannot be used: {str(error).splitlines()[0]}") from error
    return mitsuba


def material(described, mi):
    """(bsdf, radiance or None) of a material."""
    kind = described["type"]
    emit = described.get("emit", [0, 0, 0])
    if kind == "lambertian" and described.get("scatter", "lambertian") == "lambertian":
        bsdf = {"type": "twosided", "inside": {"type": "diffuse", "reflectance": {"type": "rgb", "value": described["albedo"]}}}
    elif kind == "metal" and described.get("fuzz", 0) == 0:
        bsdf = {"type": "conductor", "material": "none",
                "specular_reflectance": {"type": "rgb", "value": described["albedo"]}}
    elif kind == "dielectric" and described.get("fresnel") == "exact":
        bsdf = {"type": "dielectric", "int_ior": described["refraction_index"], "ext_ior": 1.0}
    elif kind == "diffuse_light":
        bsdf = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0, 0, 0]}}
    else:
        raise Unable(f"Mitsuba has no counterpart of {described}")
    return mi.load_dict(bsdf), emit if any(emit) else None


def points(path):
    """(x, y, z, number of the material) of the vertices of a PLY file as lamps_scene.py writes it."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    head = data[:end].decode()
    names = re.findall(r"^property (\w+) (\w+)$", head, re.MULTILINE)
    if "binary_little_endian" not in head or [n for _, n in names][:3] != ["x", "y", "z"]:
        raise Unable(f"{path}: not such a PLY")
    form = "<" + "".join({"float": "f", "uchar": "B"}[kind] for kind, _ in names)
    number = [n for _, n in names].index("material") if "material" in (n for _, n in names) else None
    for values in struct.iter_unpack(form, data[end:]):
        yield (*values[:3], values[number] if number is not None else 0)


def placement(mesh, mi):
    """Scaled, turned about x, y and z, moved."""
    scale = mesh.get("scale", 1)
    placed = mi.ScalarTransform4f().translate(mesh.get("translate", [0, 0, 0]))
    for axis, degrees in reversed(list(enumerate(mesh.get("rotate", [0, 0, 0])))):
        placed = placed.rotate([float(k == axis) for k in range(3)], degrees)
    return placed.scale([scale] * 3 if isinstance(scale, (int, float)) else scale)


def flat_shapes(document, path, folder, mi):
    """(material, shape without it) of what consists of triangles: those of each material become a file."""
    by_material = {}
    for each in document.get("triangles", []):
        by_material.setdefault(each["material"], []).append(each["vertices"])
    for number, (name, triangles) in enumerate(by_material.items()):
        rows = [" ".join(map(str, vertex)) for triangle in triangles for vertex in triangle]
        rows += [f"3 {3 * k} {3 * k + 1} {3 * k + 2}" for k in range(len(triangles))]
        head = ["ply", "format ascii 1.0", f"element vertex {3 * len(triangles)}", *(f"property double {axis}" for axis in "xyz"),
                f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
        file = pathlib.Path(folder, f"{number}.ply")
        file.write_text("\n".join(head + rows) + "\n")
        yield name, {"type": "ply", "filename": str(file), "face_normals": True}
    for mesh in document.get("meshes", []):
        file = path.parent / mesh["file"]
        if "materials" in mesh or file.suffix not in (".ply", ".obj"):
            raise Unable(f"{file}: neither PLY nor OBJ, or of several materials")
        yield mesh["material"], {"type": file.suffix[1:], "filename": str(file), "face_normals": True, "to_world": placement(mesh, mi)}


def build(path, options, mi):
    document = json.loads(path.read_text())
    camera = document["camera"]
    if camera.get("defocus_angle", 0) or camera.get("aperture", 0):
        raise Unable("a lens")
    width = options.width or camera["image_width"]
    aspect = camera.get("aspect_ratio", 1)
    aspect = aspect[0] / aspect[1] if isinstance(aspect, list) else aspect
    height = max(1, int(width / aspect)) if "image_height" not in camera else camera["image_height"]
    scene = {
        "type": "scene",
        # Our depth counts segments, as its does; how it ends paths early is its own affair.
        "integrator": {"type": "path", "max_depth": options.depth or camera.get("max_depth", 10)},
        "sensor": {"type": "perspective", "fov": camera.get("vfov", 90), "fov_axis": "y",
                   "to_world": mi.ScalarTransform4f().look_at(origin=camera.get("lookfrom", [0, 0, 0]),
                                                              target=camera.get("lookat", [0, 0, -1]),
                                                              up=camera.get("vup", [0, 1, 0])),
                   "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                            "component_format": "float32", "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent", "sample_count": options.spp}}}
    sky = document.get("background", {})
    if isinstance(sky, dict):
        if sky.get("bottom", [1, 1, 1]) != sky.get("top", [0.5, 0.7, 1.0]):
            raise Unable("a sky with a gradient")
        sky = sky["top"]
    if any(sky):
        scene["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": sky}}
    materials = {name: material(each, mi) for name, each in document["materials"].items()}
    count = 0

    def put_shape(shape, name):
        nonlocal count
        bsdf, emit = materials[name]
        shape["bsdf"] = bsdf
        if emit is not None:
            shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": emit}}
        scene[f"shape{count}"] = shape
        count += 1

    def put(center, radius, name):
        put_shape({"type": "sphere", "center": list(center), "radius": abs(radius)}, name)

    for each in document.get("spheres", []):
        put(each["center"], each["radius"], each["material"])
    for cloud in document.get("clouds", []):
        names = cloud.get("materials") or [cloud["material"]]
        for x, y, z, number in points(path.parent / cloud["file"]):
            put((x, y, z), cloud["radius"], names[number])
    with tempfile.TemporaryDirectory() as folder:
        for name, shape in flat_shapes(document, path, folder, mi):
            put_shape(shape, name)
        return mi.load_dict(scene), width, height


def measure(options):
    mi = load()
    import numpy
    started = time.perf_counter()
    scene, width, height = build(pathlib.Path(options.scene), options, mi)
    load_seconds = time.perf_counter() - started
    pictures, seconds, processor = [], [], []
    for number in range(options.passes + 1):
        begun, begun_processor = time.perf_counter(), time.process_time()
        picture = numpy.array(mi.render(scene, spp=options.spp, seed=1000 * options.seed + number), dtype=numpy.float64)
        if number == 0:
            first = time.perf_counter() - begun  # with its compilation: does not count
            continue
        seconds.append(time.perf_counter() - begun)
        processor.append(time.process_time() - begun_processor)
        pictures.append(picture)
    pictures = numpy.array(pictures)
    mean = pictures.mean(axis=0)
    means = pictures.mean(axis=(1, 2))
    if options.output:
        with open(options.output, "wb") as file:
            file.write(f"PF\n{width} {height}\n-1.0\n".encode() + mean[::-1].astype("<f4").tobytes())
    weights = numpy.array([0.2126, 0.7152, 0.0722])
    variance = pictures.var(axis=0, ddof=1) if options.passes > 1 else None
    luminance = pictures @ weights
    print(json.dumps({
        "program": f"mitsuba {mi.__version__} {VARIANT}", "threads": os.cpu_count(), "width": width, "height": height,
        "samples": width * height * options.spp * options.passes, "spp": options.spp, "passes": options.passes,
        "load_seconds": load_seconds, "first_seconds": first, "seconds": seconds, "cpu_seconds": processor,
        "mean_radiance": mean.mean(axis=(0, 1)).tolist(),
        "standard_error": (numpy.sqrt(variance.mean(axis=(0, 1)) / options.passes / (width * height)).tolist()
                           if variance is not None else None),
        "passes_mean": means.tolist(),
        # of one pass: mean over pixels of the variance, over the squared mean of the picture
        "relative_variance": (float(luminance.var(axis=0, ddof=1).mean() / luminance.mean() ** 2)
                              if variance is not None else None)}))


def main():
    parser = argparse.ArgumentParser(add_help=True)
    parser.add_argument("scene", nargs="?")
    parser.add_argument("--why", action="store_true")
    parser.add_argument("--width", type=int)
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--passes", type=int, default=4)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--depth", type=int)
    parser.add_argument("--output")
    options = parser.parse_args()
    try:
        if options.why:
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder, "try.json")
                path.write_text(json.dumps({"camera": {"image_width": 4, "aspect_ratio": 1}, "background": [1, 1, 1],
                                            "materials": {"m": {"type": "lambertian", "albedo": [0.5, 0.5, 0.5]}},
                                            "spheres": [{"center": [0, 0, -2], "radius": 1, "material": "m"}]}))
                options.scene = str(path)
                measure(options)
        elif options.scene is None:
            parser.error("a scene is missing")
        else:
            measure(options)
    except Unable as reason:
        print(f"skipped: {reason}", file=sys.stderr)
        return 77
    return 0


if __name__ == "__main__":
    sys.exit(main())
