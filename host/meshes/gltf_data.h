/* gltf_data.h: the numbers of a glTF file, which lie in buffers outside of its JSON.
 *
 * In:    a file as glTF 2.0, in JSON or binary.   Out: its document, and the rows of its accessors.
 * Knows: binary chunks, buffers (also in base64, and as files), views, accessors, sparse ones too.
 * Does not know: what the numbers mean.
 *
 * Every index and length of the file is checked before it is used. */
#ifndef BP_MESHES_GLTF_DATA_H
#define BP_MESHES_GLTF_DATA_H

#include "particles/input.h"

#include <jansson.h>
#include <stdbool.h>

typedef struct GltfBuffer {
    const unsigned char *bytes;
    size_t length;
    unsigned char *own; /* what is to be freed; NULL for the chunk of a binary file */
} GltfBuffer;

typedef struct GltfData {
    Input *input;
    const char *path;    /* of the file; others are sought beside it */
    unsigned char *file; /* the whole */
    json_t *root;
    const unsigned char *chunk; /* of a binary file */
    size_t chunk_length;
    GltfBuffer *buffers;
    size_t buffer_count;
} GltfData;

/* Reads the file whole, its document, and its buffers. Release *data with gltf_clear(), also where it fails.
 */
BpStatus gltf_read(GltfData *data, Input *input, const char *path, BpError *err);
void gltf_clear(GltfData *data);

/* Fails with BP_ERR_SCENE and the file's name. `place`: where in the document, "accessors[3]"; may be "". */
BpStatus gltf_fail(const GltfData *data, const char *place, BpError *err, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);

BpStatus gltf_fail_memory(BpError *err);

/* Element `number` of a list at the top of the document, an object. */
BpStatus gltf_element(const GltfData *data, const char *list, size_t number, json_t **element, BpError *err);
/* A member that is a whole number from 0; *found: it is there. */
BpStatus gltf_whole(const GltfData *data, const json_t *object, const char *member, const char *place,
                    bool *found, size_t *value, BpError *err);
/* `count` numbers of a member; untouched if there is no such member. */
BpStatus gltf_numbers(const GltfData *data, const json_t *object, const char *member, const char *place,
                      double *values, size_t count, BpError *err);

/* An image of the document: its bytes, which are the file's, or `own`, which the caller frees; or the file
 * beside it that it names, in *name, which the caller frees. */
typedef struct GltfImage {
    const unsigned char *bytes;
    size_t length;
    unsigned char *own;
    char *name;
} GltfImage;
BpStatus gltf_image(const GltfData *data, size_t number, GltfImage *image, BpError *err);

/* The rows of an accessor. */
typedef struct GltfRows {
    double *values; /* `components` for each row; the caller frees it */
    size_t count, components;
    bool whole_numbers; /* of a whole type, and not normalised */
} GltfRows;
/* Reads accessor `number`, of which each row must have one of two counts of components. */
BpStatus gltf_rows(const GltfData *data, size_t number, size_t components, size_t or_components,
                   GltfRows *rows, BpError *err);

#endif
