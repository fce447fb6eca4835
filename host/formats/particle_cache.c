/* particle_cache.c: see particle_cache.h. */
#include "particle_cache.h"

#include "base/known_file.h"
#include "named_file.h"

#include <stdlib.h>
#include <string.h>

void bp_particle_cache_clear(BpParticleCache *cache) {
    for (size_t i = 0; i < cache->count; i++) {
        bp_particle_file_close(&cache->entry[i].file);
        fclose(cache->entry[i].stream);
        free(cache->entry[i].path);
    }
    *cache = (BpParticleCache){0};
}

/* Says what the file is, if it is known, and how to convert it. */
static BpStatus fail_format(const BpNode *node, const char *path, FILE *stream, BpError *err) {
    char bytes[64];
    BpKnownFile known = {BP_FILE_SOURCE, "a file of an unknown format"};
    const size_t length = fread(bytes, 1, sizeof bytes, stream);
    bp_known_file(path, bytes, length, &known);
    return bp_node_fail(
        node, BP_PART_VALUE, err,
        "found %s, expected a name that ends in .xyz, .pdb, .cif, .vasp, .gro, .dump, .lammpstrj, .data, "
        ".gsd, .csv or .ply (and perhaps .gz)%s",
        known.what,
        known.kind == BP_FILE_PARTICLES ? "; convert it, with ASE or MDAnalysis"
        : known.kind == BP_FILE_POINTS  ? "; convert it, to CSV or PLY"
        : known.kind == BP_FILE_MESH    ? "; name meshes in \"meshes\""
                                        : "");
}

/* The file of an entry of "particles", from the cache, or opened and, if there is room, left in it. */
BpStatus bp_particle_cache_open(const BpNode *file_node, const char *path, const BpParticleStyle *style,
                                size_t place, BpParticleCache *cache, BpParticleFile **file, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    BpStyleColumns columns;
    if (place < cache->count) {
        *file = cache->entry[place].file;
        return BP_OK;
    }
    BP_TRY(bp_node_open_file(file_node, path, "a file of particles", &stream, &size, err));
    BpStatus status = BP_OK;
    const BpParticleFormat format = bp_particle_format_find(path, stream);
    if (format == BP_PARTICLES_NONE) status = fail_format(file_node, path, stream, err);
    char *const copy = status == BP_OK ? strdup(path) : NULL; /* the file's reader keeps the name */
    if (status == BP_OK && copy == NULL) status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    bp_particle_style_columns(style, &columns);
    if (status == BP_OK)
        status = bp_particle_file_open(stream, copy, format, columns.name, columns.count, columns.needed,
                                       file, err);
    if (status != BP_OK) {
        free(copy);
        fclose(stream);
        return status;
    }
    cache->entry[cache->count].path = copy;
    cache->entry[cache->count].stream = stream;
    cache->entry[cache->count++].file = *file;
    return BP_OK;
}
