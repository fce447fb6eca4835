/* bench_scenes.h: the fixed scenes that `ballpark bench` measures.
 *
 * In:    a name.   Out: a scene document in a folder, which peers can read too.
 * Knows: the generators of cover and field.   Does not know: how anything is measured. */
#ifndef BP_CLI_BENCH_SCENES_H
#define BP_CLI_BENCH_SCENES_H

#include "base/status.h"

/* The names that are measured when none is given, ended by NULL. */
extern const char *const bp_bench_scene_names[];

/* "cover", "diffuse", "glass", or "field-" and a number of spheres: "field-1e6". */
bool bp_bench_scene_known(const char *name);

/* Writes the scene called `name` into `folder`, as NAME.json (a field: NAME.ply as well), and its path to
 * `path`. A field whose two files are already there is left as it is, since it takes long. */
BpStatus bp_bench_scene_write(const char *name, const char *folder, char *path, size_t path_size,
                              BpError *err);

#endif
