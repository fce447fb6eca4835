/* fuzz_ply.c: any bytes as a PLY file. What is accepted makes a valid scene. */
#include "formats/ply.h"
#include "fuzz.h"

#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static FILE *file = NULL;
    static const char text[] = "{ \"camera\": {}, \"materials\": { \"a\": { \"type\": \"normals\" },"
                               "\"b\": { \"type\": \"metal\", \"albedo\": [1, 1, 1] } } }";
    static const uint32_t materials[] = {1, 0};
    if (file == NULL) file = tmpfile();
    require(file != NULL && ftruncate(fileno(file), 0) == 0);
    rewind(file);
    require(fwrite(data, 1, size, file) == size && fflush(file) == 0);
    for (int listed = 0; listed < 2; listed++) {
        const BpPlyOptions options = {.radius = listed ? 0 : 0.5,
                                      .material = listed ? BP_PLY_NO_MATERIAL : 1,
                                      .materials = materials,
                                      .material_count = listed ? 2 : 0};
        BpScene *scene = NULL;
        BpError err = {0};
        char notes[BP_PLY_NOTES_SIZE];
        require(bp_scene_parse(text, strlen(text), "x.json", &scene, NULL) == BP_OK);
        const BpStatus status = bp_ply_read(file, size, "x.ply", &options, scene, notes, &err);
        require(status == BP_OK ? bp_scene_validate(scene, NULL) == BP_OK
                                : err.code == status && err.message[0] != '\0' && scene->sphere_count == 0);
        bp_scene_destroy(&scene);
        bp_error_clear(&err);
    }
    return 0;
}
