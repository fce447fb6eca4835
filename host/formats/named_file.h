/* named_file.h: the files that a scene document names: points, particles, images.
 *
 * In:    the node that names a file, or what a scene keeps of it.   Out: an open stream; the name in a scene;
 * errors that have their place in the document; the name that a document elsewhere must use. Knows: where
 * relative paths begin, files that the program itself holds.   Does not know: what the files hold. */
#ifndef BP_FORMATS_NAMED_FILE_H
#define BP_FORMATS_NAMED_FILE_H

#include "document.h"
#include "scene/scene.h"

#include <stdio.h>

/* Opens a file that a document names at `node`, `path` being its path; no pipe. An error stands in the
 * document. `expected` says in it what should have been there. The caller closes the stream. */
BpStatus bp_node_open_file(const BpNode *node, const char *path, const char *expected, FILE **stream,
                           uint64_t *size, BpError *err);
/* Adds the place in the scene that names the file to an error in the file of points. */
void bp_name_document(const BpNode *file_node, const char *what, BpError *err);
/* Keeps the name of a file of points or of a mesh, or of a set of lines, whose shapes begin at `first`.
 * `entry`: see BpShapeFile, copied. */
BpStatus bp_keep_point_file(const char *file, size_t first, const char *entry, BpScene *scene, BpError *err);
BpStatus bp_keep_mesh_file(const char *file, size_t first, const char *entry, BpScene *scene, BpError *err);
BpStatus bp_keep_line_set(const char *name, size_t first, BpScene *scene, BpError *err);

/* Names the file of an entry of "particles" or "meshes" as a document at the path `to` must: by its path
 * below the folder of `to` where it lies there, otherwise by its absolute path. `document`: the path of what
 * named it. */
BpStatus bp_shape_file_move(const char *document, const char *to, BpShapeFile *file, BpError *err);
/* The same for an image. */
BpStatus bp_image_move(const char *document, const char *to, BpImage *image, BpError *err);

#endif
