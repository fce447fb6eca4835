/* fuzz_tree.c: any spheres, packed in both precisions, as a list and as trees of every width (tree_check.h).
 *
 * The input is the camera's position, then spheres: a byte says which way one is made (any doubles, small
 * whole numbers, on the surface seen from the camera, or copies of the one before, moved or not). */
#include "packed/rounding.h"
#include "tree_check.h"

#include "scene/scene_side.h"

#include <float.h>
#include <math.h>

#define SPHERES_MAX 400

/* Within what a scene may hold. */
static double coordinate(double value) {
    if (!(fabs(value) <= BP_COORDINATE_MAX)) return isnan(value) ? 0 : copysign(BP_COORDINATE_MAX, value);
    return value;
}

static double radius_of(double value) {
    value = coordinate(value);
    return fabs(value) < (double)FLT_MIN ? copysign((double)FLT_MIN, value) : value;
}

static double small(Bytes *bytes) {
    return (double)(int8_t)take_byte(bytes) * 0.5;
}

static BpSphere make_sphere(Bytes *bytes, unsigned way, const double camera[3], const BpSphere *before) {
    BpSphere sphere = *before;
    sphere.material = take_byte(bytes) % 5;
    switch (way) {
    case 0: /* anything */
        for (int a = 0; a < 3; ++a) sphere.center[a] = coordinate(take_double(bytes));
        sphere.radius = radius_of(take_double(bytes));
        break;
    case 1:
        for (int a = 0; a < 3; ++a) sphere.center[a] = small(bytes);
        sphere.radius = radius_of(small(bytes));
        break;
    case 2: { /* the camera stands near its surface */
        double square = 0;
        for (int a = 0; a < 3; ++a) {
            const double off = coordinate(take_double(bytes));
            sphere.center[a] = coordinate(camera[a] + off);
            square += (sphere.center[a] - camera[a]) * (sphere.center[a] - camera[a]);
        }
        sphere.radius = radius_of(sqrt(square) * (1 + small(bytes) * exp2(-(double)(take_byte(bytes) % 56))));
        break;
    }
    case 3: /* a step along one axis, a little larger */
        sphere.center[take_byte(bytes) % 3] += small(bytes);
        sphere.radius = radius_of(sphere.radius * 1.0625);
        for (int a = 0; a < 3; ++a) sphere.center[a] = coordinate(sphere.center[a]);
        break;
    case 4: /* twice as far and as large */
        for (int a = 0; a < 3; ++a) sphere.center[a] = coordinate(2 * sphere.center[a]);
        sphere.radius = radius_of(2 * sphere.radius);
        break;
    default: /* the same again */
        break;
    }
    return sphere;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static BpMaterial materials[5];
    static const BpMaterialKind kinds[5] = {BP_MATERIAL_LAMBERTIAN, BP_MATERIAL_METAL, BP_MATERIAL_DIELECTRIC,
                                            BP_MATERIAL_DIFFUSE_LIGHT, BP_MATERIAL_NORMALS};
    for (int m = 0; m < 5; ++m) materials[m] = (BpMaterial){.kind = kinds[m], .refraction_index = 1.5};
    Bytes bytes = {data, size, 0};
    BpSphere *spheres = calloc(SPHERES_MAX, sizeof *spheres);
    require(spheres != NULL);
    BpScene scene = {.spheres = spheres, .materials = materials, .material_count = 5};
    scene.camera = (BpCamera){.width = 4, .height = 3, .vfov_degrees = 90, .vup = {0, 1, 0}, .focus_dist = 1};
    const bool far = (take_byte(&bytes) & 1) != 0;
    for (int a = 0; a < 3; ++a)
        scene.camera.lookfrom[a] = far ? coordinate(take_double(&bytes)) : small(&bytes);
    for (int a = 0; a < 3; ++a) scene.camera.lookat[a] = scene.camera.lookfrom[a];
    scene.camera.lookat[2] += scene.camera.lookfrom[2] > 0 ? -BP_COORDINATE_MAX : BP_COORDINATE_MAX;

    BpSphere before = {.radius = 1, .albedo = BP_NO_ALBEDO};
    bool standing = false; /* a scene has one sphere at most whose surface the camera stands on */
    while (!at_end(&bytes) && scene.sphere_count < SPHERES_MAX) {
        const uint8_t way = take_byte(&bytes);
        for (unsigned copies = way % 16 > 2 ? way / 16 : 0, i = 0;
             i <= copies && scene.sphere_count < SPHERES_MAX; ++i) {
            const BpSphere sphere = make_sphere(&bytes, way % 16, scene.camera.lookfrom, &before);
            const bool stands = bp_sphere_side(&sphere, scene.camera.lookfrom) == BP_SIDE_ON;
            if (stands && standing) continue;
            standing = standing || stands;
            before = spheres[scene.sphere_count++] = sphere;
        }
    }
    BpRoundingWarnings limits;
    bp_rounding_warnings(&scene, BP_PRECISION_SINGLE, &limits);
    for (uint32_t width = 2; width <= 16; width *= 2)
        for (int form = 0; form < 4; ++form) {
            const BpTreeOptions options = {
                .width = width, .single_precision = form % 2 == 0, .list = form / 2 == 0, .threads = 1};
            check_packed(&scene, &options);
        }
    free(spheres);
    return 0;
}
