/* ply_data.h: scenes that the tests of PLY files read points into. */
#ifndef BP_TEST_PLY_DATA_H
#define BP_TEST_PLY_DATA_H

#include "formats/ply.h"
#include "scene/scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const uint32_t two_materials[] = {1, 0};

/* A scene of two materials, a lambertian and a dielectric, and no spheres. */
static inline BpScene *empty_scene(void) {
    static const char text[] = "{ \"camera\": {}, \"materials\": {"
                               "\"matte\": { \"type\": \"lambertian\", \"albedo\": [1, 1, 1] },"
                               "\"glass\": { \"type\": \"dielectric\", \"refraction_index\": 1.5 } } }";
    BpScene *scene = NULL;
    assert_int_equal(bp_scene_parse(text, strlen(text), "x.json", &scene, NULL), BP_OK);
    return scene;
}

static inline BpStatus read_bytes(const void *bytes, size_t size, const BpPlyOptions *options, BpScene *scene,
                                  BpError *err) {
    FILE *stream = tmpfile();
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    rewind(stream);
    const BpStatus status = bp_ply_read(stream, size, "points.ply", options, scene, NULL, err);
    fclose(stream);
    return status;
}

static inline BpScene *accept(const void *bytes, size_t size, const BpPlyOptions *options) {
    BpScene *scene = empty_scene();
    BpError err = {0};
    if (read_bytes(bytes, size, options, scene, &err) != BP_OK)
        fail_msg("line %d: %s", err.line, err.message);
    assert_int_equal(bp_scene_validate(scene, NULL), BP_OK);
    return scene;
}

static inline BpScene *accept_text(const char *text, const BpPlyOptions *options) {
    return accept(text, strlen(text), options);
}

static const BpPlyOptions all_matte = {.radius = 0.5, .material = 0};

#endif
