"""With an effect's bit off, its code is not in the kernel: looked up in the preprocessed source of many sets, with a list
and with a tree: those that have, or lack, one effect at most, and a covering array (dump_kernels.c). Programs for triangles
alone have no code for spheres.

Usage: test_effects_source.py DUMP_KERNELS
"""

import concurrent.futures
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

NAMES = ["clang"] + [f"clang-{version}" for version in range(22, 13, -1)]
clang = next(filter(None, map(shutil.which, NAMES)), None)
if clang is None:
    print("skipped: no clang here")
    sys.exit(77)

# The order of the bits, from the one list of effects.
header = pathlib.Path(__file__).parents[2] / "host/packed/effects.h"
BITS = re.findall(r"^ +X\(([A-Z_]+), \"", header.read_text(), re.MULTILINE)


def effects_of(path, name):
    """The effects that a macro of a source names."""
    text = (pathlib.Path(__file__).parents[2] / path).read_text().replace("\\\n", " ")
    return set(re.findall(r"EFFECT_(?:BIT\()?([A-Z_]+)", re.search(rf"#define {name} +(.+)", text).group(1)))


# What rays to lamps light, and media.
LIT = effects_of("kernels/dialect/real.cl", "IS_LIT")

# Words that stand in the code of one effect and nowhere else.
MARKS = {
    "LAMBERTIAN": ["lambertian_sample", "hemisphere"],
    "METAL": [" metal_sample", "(fuzzy, fuzzy)"],
    "DIELECTRIC": [" dielectric_sample", "fresnel_schlick"],
    "OREN_NAYAR": ["oren_nayar_sample", "angle_of"],
    "ROUGH_METAL": ["rough_metal_sample(surface, key, bounce), sample)"],
    "ROUGH_DIELECTRIC": ["rough_dielectric_sample", "facets_unhidden"],
    "GLOSSY": ["glossy_sample", "coat_reflects"],
    "EMISSION": ["emitted = vec3"],
    "NORMALS": ["shows_normal"],
    "LENS": ["lens_x", "->lens_up", "sample_disk(u"],
    "LAMPS": [],  # NEEDING_OTHERS
    "DISCS": ["disc_contains", "discs_radiance"],
    "TEXTURES": ["lattice_axis", "checker_colour", "vary_surface"],
    "NOISE": [],  # TOGETHER
    "IMAGES": [],  # TOGETHER
    "ENVIRONMENT": ["environment_radiance", "has_environment"],
    "MOTION": ["path->time", "ray->time"],
    "MEDIA": ["medium_around", "exp_minus", "interface_sample"],
    "BODY_MEDIA": [],  # TOGETHER
    "CAUSTICS": [],  # FOCUSING
    "TRIANGLE_LAMPS": [],  # TOGETHER, SHINING
    "SMOOTH_NORMALS": [],  # TOGETHER
    "TEXTURE_COORDINATES": [],  # TOGETHER
    "TRIANGLES": ["triangle_decide", "load_triangle", "first_triangles", "coloured_slots"],
    "CAPSULES": ["choose_ball", "capsule_is_candidate", "leaf_axes", "be_sphere"],
    "ROULETTE": ["roulette_chance"],
    "SHADOW_CATCHER": ["meets_catcher", "light_of_catcher", "lies_in_shadow"],
    "OPACITY": ["let_through", "go_behind", "ray->passes"],
    "TREE": ["BoxRay", "leaf_children"],  # no effect, but looked for in the same way
}
# Code that several effects share.
SHARED = {
    "random_ball_radius": {"LAMBERTIAN", "METAL"},
    "surface->variant = ": {"METAL", "DIELECTRIC"},
    "fresnel_exact": {"DIELECTRIC", "GLOSSY", "ROUGH_DIELECTRIC"},
    "surface->refraction_index = ": {"DIELECTRIC", "GLOSSY", "ROUGH_DIELECTRIC"},
    "smith_root": {"ROUGH_METAL", "GLOSSY", "ROUGH_DIELECTRIC"},
    "throughput, vertex->emitted": {"EMISSION", "NORMALS"},
}
# Code that needs all of these.
TOGETHER = {"gradient_noise": {"TEXTURES", "NOISE"}, "pattern_colour": {"TEXTURES", "NOISE"},
            "image_texture": {"TEXTURES", "IMAGES"}, " TriangleView": {"TRIANGLES", "TRIANGLE_LAMPS"},
            "smooth_surface": {"TRIANGLES", "SMOOTH_NORMALS"}, "scatter_folded": {"TRIANGLES", "SMOOTH_NORMALS"},
            "bodies_beyond": {"TRIANGLES", "MEDIA", "BODY_MEDIA"},
            "path->bodies": {"TRIANGLES", "MEDIA", "BODY_MEDIA"}, "ball_around_origin": {"CAPSULES", "MEDIA", "BODY_MEDIA"},
            "normal_leaves": {"TRIANGLES", "SMOOTH_NORMALS"},
            **{mark: {"TRIANGLES", "TEXTURES", "TEXTURE_COORDINATES"}
               for mark in ("triangle_map", "MapPlace", "map_place", "coordinate_leaves", "triangle_coordinates", "triangle_between")}}
# Code that needs LAMPS, something to be lit (IS_LIT of dialect/real.cl), and one of the effects named.
NEEDING_OTHERS = {
    "choose_lamp": {"EMISSION"}, "lamp_hit_weight": {"EMISSION"}, "disc_importance": {"DISCS"}, "disc_hit_weight": {"DISCS"},
    "choose_disc": {"DISCS", "ENVIRONMENT"}, "sample_environment": {"ENVIRONMENT"}, "environment_hit_weight": {"ENVIRONMENT"},
    "wants_lamps": {"EMISSION", "DISCS", "ENVIRONMENT"}, "first_seen": {"EMISSION", "DISCS", "ENVIRONMENT"},
}
# Code that needs LAMPS, something to be lit, and triangles that emit.
SHINING = ["see_triangle", "sample_triangle", "distance_to_triangle"]
# Code that needs LAMPS, something to be lit, CAUSTICS, lamps or discs, and glass or mirrors.
FOCUSING = ["focuser_importance", "chain_root", "follow_chain", "light_through_focuser", "path->chain"]
# And where two of them may lead light on in turn.
PAIRING = ["pair_roots", "begin_pair", "light_through_pair", "path->second"]

# Code for spheres, which no program for triangles alone has, and every other one.
SPHERES = ["sphere_intersect", "sphere_is_candidate", "sphere_exit", "sphere_surface", "load_sphere", "leaf_candidates", "intersect_own_sphere"]


def preprocessed(path):
    command = [clang, "-E", "-P", "-x", "cl", "-cl-std=CL1.2", str(path)]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    return re.sub(r"\s+", " ", text)


def part_of(path):
    """The bits of the set of effects, and whether there is a tree: from the name of the file."""
    bits, tree = re.match(r"e([0-9a-f]+)_t([01])_", path.name).groups()
    return int(bits, 16), tree == "1"


def complaints(path):
    bits, tree = part_of(path)
    effects = {name for number, name in enumerate(BITS) if bits >> number & 1} | ({"TREE"} if tree else set())
    text = preprocessed(path)
    found = []
    for name, marks in MARKS.items():
        found += [f"{path.name}: {mark!r} of {name} {'is missing' if name in effects else 'is there'}"
                  for mark in marks if (mark in text) != (name in effects)]
    found += [f"{path.name}: {mark!r} of {sorted(names)} {'is missing' if names & effects else 'is there'}"
              for mark, names in SHARED.items() if (mark in text) != bool(names & effects)]
    found += [f"{path.name}: {mark!r} of {sorted(names)} {'is missing' if names <= effects else 'is there'}"
              for mark, names in TOGETHER.items() if (mark in text) != (names <= effects)]
    shares = "TRIANGLES" in effects and ("SMOOTH_NORMALS" in effects or {"TEXTURES", "TEXTURE_COORDINATES"} <= effects)
    if ("Shares" in text) != shares:
        found.append(f"{path.name}: 'Shares' {'is missing' if shares else 'is there'}")
    rings = {"TRIANGLES", "TEXTURES", "TEXTURE_COORDINATES"} <= effects and bool({"IMAGES", "ENVIRONMENT"} & effects)
    if ("rows_ring" in text) != rings:
        found.append(f"{path.name}: 'rows_ring' {'is missing' if rings else 'is there'}")
    for mark, sources in NEEDING_OTHERS.items():
        needed = "LAMPS" in effects and bool(LIT & effects) and bool(sources & effects)
        if (mark in text) != needed:
            found.append(f"{path.name}: {mark!r} {'is missing' if needed else 'is there'}")
    focuses = ({"LAMPS", "CAUSTICS"} <= effects and bool(LIT & effects) and bool({"EMISSION", "DISCS"} & effects) and
               bool({"METAL", "DIELECTRIC"} & effects))
    found += [f"{path.name}: {mark!r} {'is missing' if focuses else 'is there'}"
              for mark in FOCUSING if (mark in text) != focuses]
    pairs = focuses and bits % 2 == 1  # of dump_kernels, where both kinds shall be
    found += [f"{path.name}: {mark!r} {'is missing' if pairs else 'is there'}" for mark in PAIRING if (mark in text) != pairs]
    shines = {"LAMPS", "EMISSION", "TRIANGLES", "TRIANGLE_LAMPS"} <= effects and bool(LIT & effects)
    found += [f"{path.name}: {mark!r} {'is missing' if shines else 'is there'}" for mark in SHINING if (mark in text) != shines]
    if ("turn_of" in text) != (shines or bool({"TEXTURES", "ENVIRONMENT"} & effects)):
        found.append(f"{path.name}: turn_of")
    found += [f"{path.name}: {mark!r} of spheres is missing" for mark in SPHERES if mark not in text]
    return found, bits, len(text)


def spheres_in(path):
    """In a program for triangles alone."""
    text = preprocessed(path)
    assert all(mark in text for mark in MARKS["TRIANGLES"]), path.name
    return [f"{path.name}: {mark!r} of spheres is there" for mark in SPHERES if mark in text]


assert set(BITS) | {"TREE"} == set(MARKS), f"effects.h lists {BITS}: give each its marks here"
# A material that the host takes for lit must be lit by the kernel, or it costs noise, which no picture tells from the right one.
materials = (pathlib.Path(__file__).parents[2] / "host/scene/material.c").read_text()
lit = re.findall(r"kind == BP_MATERIAL_([A-Z_]+)", re.search(r"bool bp_material_is_lit\(.*?\n}", materials, re.DOTALL).group())
assert set(lit) == LIT - {"MEDIA"}, f"bp_material_is_lit() of scene/material.c has {sorted(lit)}, IS_LIT of dialect/real.cl {sorted(LIT)}"
listed = effects_of("tests/render/effects_scenes.h", "EFFECTS_LIT")
assert listed == LIT, f"EFFECTS_LIT of effects_scenes.h has {sorted(listed)}, IS_LIT of dialect/real.cl {sorted(LIT)}"
kinds = re.findall(r"X\([A-Z_]+, \"[a-z_]+\", [A-Z_]+, ([A-Z_]+),", (header.parents[1] / "scene/material.h").read_text())
counted = effects_of("kernels/bsdf/scatter.cl", "KIND_COUNT")
assert set(kinds) == counted, f"KIND_COUNT of bsdf/scatter.cl has {sorted(counted)}, the list of scene/material.h {sorted(set(kinds))}"
# Tests of equality compare what is traced; what sums it is the same text in every program.
accumulate = (pathlib.Path(__file__).parents[2] / "kernels/film/accumulate.cl").read_text()
assert "__kernel" in accumulate and "EFFECT_" not in accumulate and "LANE" not in accumulate, \
    "accumulate.cl depends on effects or form"
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.argv[1], folder], check=True)
    paths = sorted(pathlib.Path(folder).glob("e*.cl"))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(complaints, paths))
        alone = sorted(pathlib.Path(folder).glob("t*.cl"))
        with_spheres = list(pool.map(spheres_in, alone))
assert len(alone) > 10, "no programs for triangles alone were written"
found = [line for lines, _, _ in results for line in lines] + [line for lines in with_spheres for line in lines]
print(f"{len(paths)} programs, {len({bits for _, bits, _ in results})} sets of effects; "
      f"{min(size for _, _, size in results)} to {max(size for _, _, size in results)} characters")
words = {bits | tree << len(BITS) for bits, tree in map(part_of, paths)}
everything = (1 << len(BITS)) - 1
for word in [0, everything, *(1 << e for e in range(len(BITS))), *(everything ^ 1 << e for e in range(len(BITS)))]:
    assert {word, word | everything + 1} <= words, f"set {word:x} was not written with a list and with a tree"
for triple in itertools.combinations(range(len(BITS) + 1), 3):
    assert len({tuple(word >> i & 1 for i in triple) for word in words}) == 8, f"some values of {triple} never meet"
if found:
    print("\n".join(found[:40]))
    sys.exit(f"{len(found)} marks are wrong")
