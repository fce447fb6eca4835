/* fuzz_ply.c: any bytes as a PLY file. What is accepted makes a valid scene. */
#include "formats/ply.h"
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char text[] = "{ \"camera\": {}, \"materials\": { \"a\": { \"type\": \"normals\" },"
                               "\"b\": { \"type\": \"metal\", \"albedo\": [1, 1, 1] } } }";
    static const uint32_t materials[] = {1, 0};
    if (size == 0) return 0; /* fmemopen has no empty files everywhere */
    for (int listed = 0; listed < 2; listed++) {
        const BpPlyOptions options = {.radius = listed ? 0 : 0.5,
                                      .material = listed ? BP_PLY_NO_MATERIAL : 1,
                                      .materials = materials,
                                      .material_count = listed ? 2 : 0};
        BpScene *scene = NULL;
        BpError err = {0};
        require(bp_scene_parse(text, strlen(text), "x.json", &scene, NULL) == BP_OK);
        FILE *stream = fmemopen((void *)(uintptr_t)data, size, "rb");
        require(stream != NULL);
        const BpStatus status = bp_ply_read(stream, size, "x.ply", &options, scene, &err);
        fclose(stream);
        require(status == BP_OK ? bp_scene_validate(scene, NULL) == BP_OK
                                : err.code == status && err.message[0] != '\0' && scene->sphere_count == 0);
        bp_scene_destroy(&scene);
        bp_error_clear(&err);
    }
    return 0;
}
