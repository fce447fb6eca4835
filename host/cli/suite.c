/* suite.c: see suite.h. */
#include "suite.h"

#include "temporary_folder.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* In generated code (cmake/embed_files.cmake). */
const char *bp_agreement_file_at(size_t index, const char **name, size_t *size);

static bool is_scene(const char *name) {
    const size_t length = strlen(name);
    return length > 5 && strcmp(name + length - 5, ".json") == 0;
}

/* Scenes look for the files of their points beside them, so these must be files. */
static BpStatus unpack_points(const char *folder, BpError *err) {
    const char *name, *bytes;
    size_t size;
    for (size_t i = 0; (bytes = bp_agreement_file_at(i, &name, &size)) != NULL; ++i) {
        if (is_scene(name)) continue;
        char path[640];
        snprintf(path, sizeof path, "%s/%s", folder, name);
        FILE *out = fopen(path, "wb");
        const bool written = out != NULL && fwrite(bytes, 1, size, out) == size;
        const bool closed = out != NULL && fclose(out) == 0;
        if (!written || !closed)
            return bp_fail(err, BP_ERR_FILE, "cannot write %s: %s; set TMPDIR to a folder with room", path,
                           strerror(errno));
    }
    return BP_OK;
}

static BpStatus load_scenes(const char *folder, BpSuite *suite, BpError *err) {
    const char *name, *text;
    size_t size;
    for (size_t i = 0; (text = bp_agreement_file_at(i, &name, &size)) != NULL; ++i) {
        if (!is_scene(name)) continue;
        char path[640];
        snprintf(path, sizeof path, "%s/%s", folder, name);
        BP_TRY(bp_scene_parse(text, size, path, &suite->scenes[suite->count], err));
        snprintf(suite->names[suite->count++], sizeof suite->names[0], "%.*s", (int)strlen(name) - 5, name);
    }
    return BP_OK;
}

BpStatus bp_suite_load(BpSuite *suite, BpError *err) {
    BpTemporaryFolder folder = {0};
    const char *name;
    size_t files = 0, size;
    *suite = (BpSuite){0};
    while (bp_agreement_file_at(files, &name, &size) != NULL) ++files;
    suite->names = calloc(files + 1, sizeof *suite->names);
    suite->scenes = calloc(files + 1, sizeof *suite->scenes);
    if (suite->names == NULL || suite->scenes == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the agreement scenes");
    BP_TRY(bp_temporary_folder_make(&folder, err));
    BpStatus status = unpack_points(folder.path, err);
    if (status == BP_OK) status = load_scenes(folder.path, suite, err);
    bp_temporary_folder_remove(&folder);
    return status;
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
