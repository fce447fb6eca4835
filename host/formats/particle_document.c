/* particle_document.c: see particle_document.h. */
#include "particle_document.h"

#include "base/json_memory.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char form[] =
    "{\n"
    "  \"format\": 1,\n"
    "  \"title\": %s,\n"
    "  \"source\": \"made by `ballpark scene`\",\n"
    "  \"camera\": {\n"
    "    \"image_width\": 800, \"aspect_ratio\": [4, 3], \"samples_per_pixel\": 32, \"max_depth\": 20,\n"
    "    \"vfov\": 30, \"fit\": \"particles\", \"view\": \"three-quarter\", \"margin\": 0.05\n"
    "  },\n"
    "  \"lighting\": \"soft\",\n"
    "  \"transfer\": \"srgb\",\n"
    "  \"particles\": [\n"
    "    { \"file\": %s }\n"
    "  ]\n"
    "}\n";

BpStatus bp_particle_document(const char *path, char **text, BpError *err) {
    const char *const slash = strrchr(path, '/');
    bool no_memory = false;
    char *const quoted = bp_json_quote(slash != NULL ? slash + 1 : path, &no_memory);
    *text = NULL;
    if (no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a document");
    if (quoted == NULL) {
        const BpStatus status =
            bp_fail(err, BP_ERR_SCENE,
                    "found a name that is not UTF-8, expected UTF-8, as scene documents are: rename it");
        bp_error_at(err, path, 0, 0);
        return status;
    }
    const size_t size = sizeof form + 2 * strlen(quoted);
    *text = malloc(size);
    if (*text != NULL) snprintf(*text, size, form, quoted, quoted);
    free(quoted);
    return *text != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for a document");
}
