/* scene_image.c: see scene_image.h. */
#include "scene_image.h"

#include "image/image_file.h"

#include "base/input_file.h"
#include "base/words.h"
#include "meshes/mesh.h"
#include "named_file.h"
#include "scene_changes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ENCODING_WORDS(X)                                                                                    \
    X(BP_ENCODING_OF_FORMAT, NULL) X(BP_ENCODING_SRGB, "srgb") X(BP_ENCODING_LINEAR, "linear")
BP_WORDS(BpEncoding, static const char *const encoding_names, ENCODING_WORDS);

/* An image inside of a glTF file. */
static BpStatus read_inside(FILE *gltf, const char *path, uint32_t inside, BpEncoding encoding, double scale,
                            uint64_t left, BpImage **image, BpError *err) {
    unsigned char *bytes = NULL;
    size_t length = 0;
    BP_TRY(bp_mesh_read_image(gltf, path, inside - 1, &bytes, &length, err));
    FILE *const stream = fmemopen(bytes, length > 0 ? length : 1, "rb");
    const BpStatus status = stream != NULL
                                ? bp_image_read(stream, length, path, encoding, scale, left, image, err)
                                : bp_fail(err, BP_ERR_MEMORY, "out of memory for an image");
    if (stream != NULL) fclose(stream);
    free(bytes);
    return status;
}

static BpStatus read_file(const BpNode *node, const char *file, uint32_t inside, BpEncoding encoding,
                          double scale, const BpScene *scene, BpImage **image, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0, left = BP_IMAGE_TEXELS_MAX;
    for (size_t i = 0; i < scene->image_count; i++)
        left -= (uint64_t)scene->images[i]->width * scene->images[i]->height;
    char *path = bp_path_beside(node->document->name, file);
    if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    BpStatus status = bp_node_open_file(node, path, "an image: PNG, JPEG, OpenEXR, PFM or Radiance (.hdr)",
                                        &stream, &size, err);
    if (status == BP_OK) {
        status = inside > 0 ? read_inside(stream, path, inside, encoding, scale, left, image, err)
                            : bp_image_read(stream, size, path, encoding, scale, left, image, err);
        fclose(stream);
        if (status == BP_ERR_SCENE && err != NULL) bp_name_document(node, "an image", err);
    }
    free(path);
    return status;
}

/* One grey texel for a file that is not opened. */
static BpStatus stand_in(BpEncoding encoding, double scale, BpImage **image, BpError *err) {
    BP_TRY(bp_texels_create(1, 1, image, err));
    for (int c = 0; c < 3; c++) (*image)->texels[c] = (float)fmin(0.5, 0.5 / fmax(scale, 1));
    (*image)->encoding = encoding;
    return bp_texels_finish(*image, scale, "", err);
}

static BpStatus keep_image(const char *file, uint32_t inside, BpImage *image, BpScene *scene, BpError *err) {
    BpImage **images = realloc(scene->images, (scene->image_count + 1) * sizeof *images);
    if (images != NULL) scene->images = images;
    image->inside = inside;
    BpStatus status = images != NULL ? bp_copy_text(file, &image->file, err)
                                     : bp_fail(err, BP_ERR_MEMORY, "out of memory for an image");
    if (status == BP_OK)
        images[scene->image_count++] = image;
    else
        bp_texels_destroy(&image);
    return status;
}

BpStatus bp_parse_image(const BpNode *file_node, const BpNode *encoding_node, const BpNode *scale_node,
                        uint32_t inside, unsigned flags, BpScene *scene, BpImage **image, BpError *err) {
    const char *file = NULL;
    int choice = -1;
    double scale = 1;
    BP_TRY(bp_node_string(file_node, &file, err));
    BP_TRY(bp_node_choice(encoding_node, encoding_names + 1, BP_COUNT(encoding_names) - 1, &choice, err));
    BP_TRY(bp_node_number(scale_node, &scale, err));
    if (!(scale >= 0 && scale <= BP_IMAGE_SCALE_MAX))
        return bp_node_wrong(scale_node, "a factor from 0 to 1e12", err);
    const BpEncoding encoding = (BpEncoding)(choice + 1);
    for (size_t i = 0; i < scene->image_count; i++) {
        *image = scene->images[i];
        if (strcmp((*image)->file, file) == 0 && (*image)->inside == inside &&
            (*image)->encoding == encoding && !((*image)->scale < scale) && !((*image)->scale > scale))
            return BP_OK;
    }
    *image = NULL;
    if (scene->image_count >= BP_IMAGES_MAX)
        return bp_node_fail(file_node, BP_PART_VALUE, err,
                            "found image number %u, expected at most %u images", BP_IMAGES_MAX + 1,
                            BP_IMAGES_MAX);
    BpStatus status = (flags & BP_PARSE_NO_CLOUDS) != 0
                          ? stand_in(encoding, scale, image, err)
                          : read_file(file_node, file, inside, encoding, scale, scene, image, err);
    if (status == BP_OK) status = keep_image(file, inside, *image, scene, err);
    if (status == BP_OK && (*image)->notes[0] != '\0')
        status = bp_scene_note(scene, file, (*image)->notes, err);
    return status;
}
