/* reader.h: the interface that every format's reader has.
 *
 * In:    a builder with an input.   Out: vertices and polygons, handed to the builder.
 * Does not know: which formats there are.
 *
 * A reader reads the whole file. What follows (cutting polygons, colours) is mesh_finish(). */
#ifndef BP_MESHES_READER_H
#define BP_MESHES_READER_H

#include "builder.h"

#include <string.h>

typedef BpStatus ReadMesh(MeshBuilder *builder, BpError *err);
ReadMesh mesh_read_ply, mesh_read_obj, mesh_read_stl, mesh_read_off, mesh_read_gltf;

/* Whether a PLY file, at its beginning, has faces; without them it is a file of points. */
bool mesh_ply_has_faces(Input *input);
/* Whether a file, at its beginning, is as long as a binary STL file of as many triangles as it counts. Passes
 * over some of it. */
bool mesh_stl_is_binary(Input *input);
/* Reads an MTL file: adds materials, or completes those that are there. Lines that make no sense become a
 * note. */
BpStatus mesh_read_mtl(MeshBuilder *builder, Input *input, BpError *err);
/* Four bytes as a whole number, the least first. */
static inline uint32_t mesh_word_at(const unsigned char *bytes) {
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}
/* The same four bytes as a float. */
static inline double mesh_float_at(const unsigned char *bytes) {
    const uint32_t bits = mesh_word_at(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}
/* The name that the rest of a line is, with blanks amid it, but not around it. Cuts it off in place. */
char *mesh_name_in(char *rest);

#endif
