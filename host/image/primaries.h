/* primaries.h: converts colours of other primaries to those of Rec. 709.
 *
 * In:    where a file's primaries and white lie.   Out: its image in Rec. 709's.
 * Knows: CIE 1931 chromaticities, adaptation to another white.   Does not know: how files name their
 * primaries. */
#ifndef BP_IMAGE_PRIMARIES_H
#define BP_IMAGE_PRIMARIES_H

#include "reader.h"

/* CIE x and y. */
typedef struct BpPrimaries {
    double red[2], green[2], blue[2], white[2];
} BpPrimaries;

/* The matrix from linear colours of `from` to those of Rec. 709. White becomes white (adaptation by Lam's
 * Bradford matrix, 1985), except that CIE XYZ, whose "white" is a convention, is not adapted. False: the
 * primaries are degenerate. */
bool bp_primaries_matrix(const BpPrimaries *from, double matrix[3][3]);

/* Converts the image unless its primaries are Rec. 709's to within 0.0005, and notes that. `source`: the part
 * of the file that defines them, for messages. BP_ERR_SCENE. Texels that are not finite stay as they are. */
BpStatus bp_image_convert(const BpImageInput *input, const BpPrimaries *from, const char *source,
                          BpImage *image, BpError *err);

#endif
