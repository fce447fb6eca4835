/* suite.c: see suite.h. */
#include "suite.h"

#include "formats/scene_load.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

BpHeldFiles bp_agreement_file_at; /* in generated code (cmake/embed_files.cmake) */

static bool is_scene(const char *name) {
    const size_t length = strlen(name);
    return length > 5 && strcmp(name + length - 5, ".json") == 0;
}

BpStatus bp_suite_load(BpSuite *suite, BpError *err) {
    const BpSceneChanges changes = {.held = bp_agreement_file_at};
    const char *name, *text;
    size_t files = 0, size;
    *suite = (BpSuite){0};
    while (bp_agreement_file_at(files, &name, &size) != NULL) ++files;
    suite->names = calloc(files + 1, sizeof *suite->names);
    suite->scenes = calloc(files + 1, sizeof *suite->scenes);
    if (suite->names == NULL || suite->scenes == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the agreement scenes");
    for (size_t i = 0; (text = bp_agreement_file_at(i, &name, &size)) != NULL; ++i) {
        if (!is_scene(name)) continue;
        BP_TRY(bp_scene_parse_changed(text, size, name, &changes, &suite->scenes[suite->count], err));
        snprintf(suite->names[suite->count++], sizeof suite->names[0], "%.*s", (int)strlen(name) - 5, name);
    }
    return BP_OK;
}

BpScene *bp_suite_find(const BpSuite *suite, const char *name) {
    for (size_t i = 0; i < suite->count; ++i)
        if (strcmp(suite->names[i], name) == 0) return suite->scenes[i];
    return NULL;
}

void bp_suite_clear(BpSuite *suite) {
    for (size_t i = 0; i < suite->count; ++i) bp_scene_destroy(&suite->scenes[i]);
    free(suite->names);
    free(suite->scenes);
    *suite = (BpSuite){0};
}
