/* exr_layers.h: chooses the channels of an OpenEXR file that are the image.
 *
 * In:    an open file.   Out: a part and a layer that has R, G and B, or Y alone.
 * Knows: parts, names of channels and layers.   Does not know: what pixels hold. */
#ifndef BP_IMAGE_EXR_LAYERS_H
#define BP_IMAGE_EXR_LAYERS_H

#include "reader.h"

#include <openexr.h>

enum { BP_EXR_NAME_SIZE = 256 };

typedef struct BpExrLayer {
    int part;
    char prefix[BP_EXR_NAME_SIZE];   /* of its channels' names: "", "beauty." */
    bool gray;                       /* Y alone */
    char note[2 * BP_EXR_NAME_SIZE]; /* which layer was taken, where there are others; "" */
} BpExrLayer;

/* The first part that has the channels without a layer's name, else the only layer that has them, else the
 * only one called "Combined", "beauty" or "rgba". BP_ERR_SCENE: several layers qualify, which the message
 * names, or channels are integers, chroma or subsampled. */
BpStatus bp_exr_layer_choose(const BpImageInput *input, exr_const_context_t exr, BpExrLayer *layer,
                             BpError *err);

/* The index of a channel within a texel: 0 to 2; -1 if it is not part of the layer. */
int bp_exr_channel_place(const BpExrLayer *layer, const char *channel);
/* Whether a channel is the layer's alpha. */
bool bp_exr_channel_is_alpha(const BpExrLayer *layer, const char *channel);

#endif
