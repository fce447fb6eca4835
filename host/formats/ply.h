/* ply.h: points from a PLY file as spheres of a scene.
 *
 * In:    a binary (little or big endian) or ASCII PLY file, version 1.0.   Out: spheres added to a BpScene.
 * Knows: what points of clouds need.   Does not know: JSON, how the file was found, how rows are written
 * (particles/ply_rows.h).
 *
 * Read are the properties of the element "vertex" called x y z, radius, red green blue (or other names of
 * particles/column_names.h), and material; other properties and elements, lists too, are passed over. What
 * the numbers of colours mean, particles/color_range.h says; they replace the albedo of materials that have
 * one. Points without a place (NaN) are left out. Nothing in a file is trusted: counts are held against its
 * size before memory is taken for them. */
#ifndef BP_FORMATS_PLY_H
#define BP_FORMATS_PLY_H

#include "base/status.h"
#include "scene/scene.h"

#include <stdio.h>

#define BP_PLY_NO_MATERIAL UINT32_MAX

typedef struct BpPlyOptions {
    double radius;             /* of points in a file without radii; 0: such a file is an error */
    uint32_t material;         /* of points that name none, into the scene's; or BP_PLY_NO_MATERIAL */
    const uint32_t *materials; /* what the file's material numbers mean, into the scene's */
    size_t material_count;     /* 0: the file's material numbers are passed over */
} BpPlyOptions;

enum { BP_PLY_NOTES_SIZE = 160 };

/* Reads `stream`, a regular file of `size` bytes; `name` stands in messages. Errors name the header's line,
 * or the vertex, counted from 0. On failure the scene is as it was. `notes`: Optional; what was left out and
 * decided, "" if nothing. */
BpStatus bp_ply_read(FILE *stream, uint64_t size, const char *name, const BpPlyOptions *options,
                     BpScene *scene, char notes[BP_PLY_NOTES_SIZE], BpError *err);

#endif
