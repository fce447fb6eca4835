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
ReadMesh mesh_read_off;

#endif
