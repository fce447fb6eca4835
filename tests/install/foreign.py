"""The installed shared library as another language calls it: through ctypes, from what the header says alone.

Usage: foreign.py LIBRARY SCENE FOLDER C_COMPILER
"""

import ctypes as c
import json
import math
import pathlib
import subprocess
import sys

library, scene_path, folder = c.CDLL(sys.argv[1]), sys.argv[2].encode(), pathlib.Path(sys.argv[3])
for name in ("bp_version", "bp_status_name", "bp_stop_reason_name"):
    getattr(library, name).restype = c.c_char_p
library.bp_film_nrmse.restype = c.c_double
library.bp_pixel_relative_error.restype = c.c_double
library.bp_pixel_relative_error.argtypes = [c.c_void_p, c.c_size_t]


class Error(c.Structure):
    _fields_ = [("code", c.c_int), ("message", c.c_char * 1024), ("file", c.c_char * 512), ("line", c.c_int),
                ("column", c.c_int), ("attachment", c.c_char_p), ("remedy", c.c_int), ("remedy_value", c.c_char * 24)]


class SceneInfo(c.Structure):
    _fields_ = [("title", c.c_char_p), ("source", c.c_char_p), ("width", c.c_uint32), ("height", c.c_uint32),
                ("samples_per_pixel", c.c_uint32), ("max_depth", c.c_uint32), ("spheres", c.c_size_t),
                ("materials", c.c_size_t), ("transfer", c.c_int), ("triangles", c.c_size_t), ("capsules", c.c_size_t)]


class RenderOptions(c.Structure):
    _fields_ = [("samples_per_pixel", c.c_uint64), ("first_sample", c.c_uint64), ("max_depth", c.c_uint32),
                ("seed", c.c_uint64), ("precision", c.c_int), ("math", c.c_int), ("numerics", c.c_int),
                ("sampler", c.c_int), ("light_sampling", c.c_int), ("caustics", c.c_int), ("roulette", c.c_int), ("kernel", c.c_int), ("all_effects", c.c_bool),
                ("extra_effects", c.c_uint32), ("adaptive", c.c_bool), ("features", c.c_bool), ("samples_only", c.c_bool), ("force", c.c_bool),
                ("job_first", c.c_uint64), ("job_samples", c.c_uint64), ("replicates", c.c_uint32),
                ("threads", c.c_uint32), ("chunk_samples", c.c_uint32), ("local_size", c.c_uint32), ("tree_width", c.c_uint32),
                ("packet_lanes", c.c_uint32), ("force_list", c.c_bool), ("force_tree", c.c_bool),
                ("force_float_refine", c.c_bool), ("build_mark", c.c_uint64)]


class Progress(c.Structure):
    _fields_ = [("samples_done", c.c_uint64), ("samples_total", c.c_uint64), ("trace_seconds", c.c_double),
                ("finished", c.c_bool)]


class StopRule(c.Structure):
    _fields_ = [("error", c.c_double), ("seconds", c.c_double), ("samples_max", c.c_uint64),
                ("samples_min", c.c_uint64), ("adaptive", c.c_bool)]


class Picture(c.Structure):
    _fields_ = [("width", c.c_uint32), ("height", c.c_uint32), ("rgb", c.POINTER(c.c_float)),
                ("error", c.POINTER(c.c_float)), ("samples", c.POINTER(c.c_uint64)), ("alpha", c.POINTER(c.c_float)),
                ("depth", c.POINTER(c.c_float)), ("normal", c.POINTER(c.c_float)), ("albedo", c.POINTER(c.c_float))]


def layout_here(structure):
    return [c.sizeof(structure)] + [getattr(structure, name).offset for name, _ in structure._fields_]


def layouts_in_c(structures):
    """The size of each and the offsets of its members, as a C compiler lays out what the header declares. A member that
    is missing above goes unnoticed by the library and breaks the memory behind."""
    lines = ["#include <ballpark.h>", "#include <stddef.h>", "#include <stdio.h>", "int main(void) {"]
    for structure in structures:
        declared = f"Bp{structure.__name__}"
        values = [f"sizeof({declared})"] + [f"offsetof({declared}, {name})" for name, _ in structure._fields_]
        lines += [f'printf("%zu ", (size_t){value});' for value in values] + ['puts("");']
    source, program = folder / "layout.c", folder / "layout"
    source.write_text("\n".join(lines + ["return 0; }"]))
    subprocess.run([sys.argv[4], "-std=c11", f"-I{folder / 'include'}", source, "-o", program], check=True)
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return [[int(value) for value in line.split()] for line in printed.splitlines()]


STRUCTURES = (Error, SceneInfo, RenderOptions, Progress, StopRule, Picture)
for structure, in_c in zip(STRUCTURES, layouts_in_c(STRUCTURES), strict=True):
    here = layout_here(structure)
    assert here == in_c, f"{structure.__name__}: size and offsets are {here} here and {in_c} in C"

error = Error()


def call(name, *arguments):
    status = getattr(library, name)(*arguments, c.byref(error))
    assert status == 0, f"{name}: {library.bp_status_name(status)}: {error.message}"


assert library.bp_api_version() == 1, "this file is of another version of the library"

scene, render, stop, film = c.c_void_p(), c.c_void_p(), c.c_void_p(), c.c_void_p()
status = library.bp_scene_load(b"/nowhere.json", c.byref(scene), c.byref(error))
assert status != 0 and error.code == status and b"nowhere" in error.message + error.file, error.message
call("bp_scene_load", scene_path, c.byref(scene))
call("bp_scene_set_width", scene, 32)
info = SceneInfo()
library.bp_scene_info(scene, c.byref(info))
assert (info.width, info.spheres) == (32, len(json.loads(pathlib.Path(sys.argv[2]).read_text())["spheres"]))

options, rule, progress, reason = RenderOptions(), StopRule(), Progress(), c.c_int()
library.bp_render_defaults(scene, c.byref(options))
assert (options.samples_per_pixel, options.max_depth) == (info.samples_per_pixel, info.max_depth)
options.samples_per_pixel = 8
options.seed = 5
library.bp_stop_rule_defaults(scene, c.byref(options), c.byref(rule))
assert (rule.samples_max, rule.error, rule.adaptive) == (8, 0, False)
call("bp_render_create", scene, c.byref(options), None, c.c_size_t(0), c.byref(render))
call("bp_stop_create", render, c.byref(rule), c.byref(stop))
while reason.value == 0:
    call("bp_render_step", render, c.byref(progress))
    call("bp_stop_check", stop, c.byref(progress), c.byref(reason))
assert library.bp_stop_reason_name(reason) == b"samples"
assert progress.finished and progress.samples_done == progress.samples_total == 8 * info.width * info.height

call("bp_render_film", render, c.byref(film))
picture = Picture()
call("bp_film_picture", film, c.byref(picture))
numbers = 3 * picture.width * picture.height
# An array of this type lies where the picture's numbers lie: nothing is copied.
values = (c.c_float * numbers).from_address(c.addressof(picture.rgb.contents))
assert c.addressof(values) == c.addressof(picture.rgb.contents)
assert all(math.isfinite(value) and value >= 0 for value in values) and len(set(values)) > 100
assert all(picture.samples[p] == 8 for p in range(numbers // 3))
assert 0 < library.bp_film_nrmse(film) < 1
assert library.bp_pixel_relative_error(c.byref(picture), 0) > 0
call("bp_film_write", film, bytes(folder / "foreign.bpa"))
call("bp_error_map_write", c.byref(picture), bytes(folder / "foreign.png"))
assert (folder / "foreign.bpa").read_bytes().startswith(b"{") and (folder / "foreign.png").stat().st_size > 100

library.bp_picture_clear(c.byref(picture))
for destroy, handle in (("film", film), ("stop", stop), ("render", render), ("scene", scene)):
    getattr(library, f"bp_{destroy}_destroy")(c.byref(handle))
    assert not handle
library.bp_error_clear(c.byref(error))
