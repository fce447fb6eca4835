/* document_change.h: changes members of a scene document, as the caller wishes.
 *
 * In:    a document, "camera.vfov=30".   Out: the document with that member.
 * Knows: paths of members, JSON.   Does not know: which members a scene may have.
 */
#ifndef BP_FORMATS_DOCUMENT_CHANGE_H
#define BP_FORMATS_DOCUMENT_CHANGE_H

#include "document.h"

/* Changes the open document by MEMBER=VALUE each, in order. MEMBER is a path as messages write it:
 * camera.vfov, spheres[0].radius, materials.glass.albedo[2]; what is absent is added, except for elements of
 * lists. VALUE is JSON; a plain word is the text of that word; null removes the member. The texts must live
 * as long as the document; so must `by`, which is what messages call a change. BP_ERR_USAGE names what was
 * found and what was expected; whether a scene may have the member at all is found when it is read. */
BpStatus bp_document_change(BpDocument *document, const char *by, const char *const *set, size_t count,
                            BpError *err);

#endif
