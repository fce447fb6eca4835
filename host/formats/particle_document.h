/* particle_document.h: the scene document that a file of particles alone stands for.
 *
 * In:    a path.   Out: the text of a document beside it.
 * Knows: defaults.   Does not know: what is in the file. */
#ifndef BP_FORMATS_PARTICLE_DOCUMENT_H
#define BP_FORMATS_PARTICLE_DOCUMENT_H

#include "base/status.h"

/* Free *text with free(). */
BpStatus bp_particle_document(const char *path, char **text, BpError *err);

#endif
