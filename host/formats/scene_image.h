/* scene_image.h: the images that a scene document names.
 *
 * In:    the nodes of a path and of how the file is meant.   Out: images that the scene owns.
 * Knows: where relative paths begin.   Does not know: how formats are read (image/image_file.h), what an
 * image is for. */
#ifndef BP_FORMATS_SCENE_IMAGE_H
#define BP_FORMATS_SCENE_IMAGE_H

#include "document.h"
#include "scene/scene.h"

/* The image that the node names, as `encoding` and `scale`, nodes too, say; it is the
 * scene's, which has each file once. `inside`: of the images in a glTF file this one, counted from 1; 0: the
 * file is the image. */
BpStatus bp_parse_image(const BpNode *file, const BpNode *encoding, const BpNode *scale, uint32_t inside,
                        unsigned flags, BpScene *scene, BpImage **image, BpError *err);

#endif
