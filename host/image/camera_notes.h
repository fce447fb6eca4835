/* camera_notes.h: what cameras and editors write into images beside their texels.
 *
 * In:    Exif data, ICC profiles, as PNG and JPEG files hold them.   Out: notes about what is not applied.
 * Knows: where the orientation stands (Exif 2.32, section 4.6).   Does not know: how files hold them. */
#ifndef BP_IMAGE_CAMERA_NOTES_H
#define BP_IMAGE_CAMERA_NOTES_H

#include "texels.h"

#include <stddef.h>

/* Notes a profile that is not sRGB's, since profiles are not applied. `name`: its name, or NULL. */
void bp_note_profile(BpImage *image, const char *name, const unsigned char *profile, size_t size);
/* Notes an orientation that turns or mirrors the image, since that is not applied. `exif`: a TIFF file. */
void bp_note_orientation(BpImage *image, const unsigned char *exif, size_t size);

#endif
