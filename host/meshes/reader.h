/* reader.h: the interface that every format's reader has.
 *
 * In:    a builder with an input.   Out: vertices and polygons, handed to the builder.
 * Does not know: which formats there are.
 *
 * A reader reads the whole file. What follows (cutting polygons, colours) is mesh_finish(). */
#ifndef BP_MESHES_READER_H
#define BP_MESHES_READER_H

#include "builder.h"

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
/* The name that the rest of a line is, with blanks amid it, but not around it. Cuts it off in place. */
char *mesh_name_in(char *rest);

#endif
