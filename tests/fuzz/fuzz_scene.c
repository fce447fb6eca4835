/* fuzz_scene.c: any text as a scene document. What is accepted is valid, and the same scene after it was
 * written and read.
 *
 * Files of clouds are not opened; fuzz_cloud.c does that. */
#include "film/film.h"
#include "formats/scene_load.h"
#include "fuzz.h"

static char *print(const BpScene *scene, size_t *length) {
    char *text = NULL;
    FILE *stream = open_memstream(&text, length);
    require(stream != NULL && bp_scene_print(scene, stream, NULL) == BP_OK);
    fclose(stream);
    return text;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    BpScene *scene = NULL, *again = NULL;
    BpError err = {0};
    const BpSceneChanges alone = {.flags = BP_PARSE_NO_CLOUDS};
    const BpStatus status = bp_scene_parse_changed((const char *)data, size, "x.json", &alone, &scene, &err);
    if (status != BP_OK) {
        require(scene == NULL && err.code == status && err.message[0] != '\0');
        require(err.line >= 1 && err.column >= 1);
        bp_error_clear(&err);
        return 0;
    }
    require(bp_scene_validate(scene, NULL) == BP_OK);
    size_t length = 0, length_again = 0;
    char *text = print(scene, &length);
    require(bp_scene_parse_changed(text, length, "x.json", &alone, &again, NULL) == BP_OK);
    require(bp_scene_hash(scene) == bp_scene_hash(again));
    char *text_again = print(again, &length_again);
    require(length == length_again && memcmp(text, text_again, length) == 0);
    free(text);
    free(text_again);
    bp_scene_destroy(&scene);
    bp_scene_destroy(&again);
    return 0;
}
