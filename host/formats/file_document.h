/* file_document.h: the scene document that a file of particles or of a mesh alone stands for.
 *
 * In:    a path.   Out: the text of a document beside it.
 * Knows: defaults, what materials of MTL become.   Does not know: particles. */
#ifndef BP_FORMATS_FILE_DOCUMENT_H
#define BP_FORMATS_FILE_DOCUMENT_H

#include "base/status.h"

/* A fitted camera and soft light. Free *text with free(). */
BpStatus bp_particle_document(const char *path, char **text, BpError *err);

enum { BP_DOCUMENT_NOTE_SIZE = 256 };
/* A fitted camera, the light of a studio and a shadow on the ground. An OBJ file is read for what its MTL
 * files offer: Kd, Ke, map_Kd, and for d below a half glass of index Ni, where it is closed; a glTF file
 * likewise, with the images of its base colours. STL files, whose z axis
 * is up by custom, are turned. `note`: what was offered and not taken, or "". Free *text with free(). */
BpStatus bp_mesh_document(const char *path, char **text, char note[BP_DOCUMENT_NOTE_SIZE], BpError *err);

#endif
