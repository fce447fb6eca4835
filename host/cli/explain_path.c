/* explain_path.c: see explain_path.h. */
#include "explain_path.h"

#include "base/json_text.h"
#include "base/shown.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static const char *kind_name(BpMaterialKind kind) {
    switch (kind) {
    case BP_MATERIAL_LAMBERTIAN:
        return "lambertian";
    case BP_MATERIAL_METAL:
        return "metal";
    case BP_MATERIAL_DIELECTRIC:
        return "dielectric";
    case BP_MATERIAL_DIFFUSE_LIGHT:
        return "diffuse_light";
    case BP_MATERIAL_NORMALS:
        return "normals";
    }
    return "unknown";
}

static bool is_black(const double colour[3]) {
    return colour[0] == 0 && colour[1] == 0 && colour[2] == 0;
}

/* What the surface did with the path. */
static const char *outcome(const BpPathStep *step, BpMaterialKind kind) {
    if (!step->goes_on) {
        if (kind == BP_MATERIAL_DIFFUSE_LIGHT) return "a lamp: the path ends";
        if (kind == BP_MATERIAL_NORMALS) return "shows its normal: the path ends";
        return "absorbs the path";
    }
    if (kind == BP_MATERIAL_DIELECTRIC) {
        if (step->enters) return step->inward ? "refracts it into the sphere" : "reflects it";
        return step->inward ? "reflects it back inside" : "refracts it out of the sphere";
    }
    return kind == BP_MATERIAL_METAL ? "reflects it" : "scatters it";
}

void bp_path_print(const BpScene *scene, const BpPathLog *path, uint32_t x, uint32_t y, uint64_t sample,
                   uint64_t seed) {
    printf("  pixel (%" PRIu32 ", %" PRIu32 "), sample %" PRIu64 ", seed %" PRIu64 ", on ", x, y, sample,
           seed);
    bp_show(path->device.name, false, stdout);
    putchar('\n');
    const double nothing[3] = {0};
    const double *radiance = nothing;
    for (size_t i = 0; i < path->count; ++i) {
        const BpPathStep *step = &path->steps[i];
        printf("  %3zu  from (%.6g, %.6g, %.6g) along (%.4f, %.4f, %.4f)\n", i + 1, step->origin[0],
               step->origin[1], step->origin[2], step->direction[0], step->direction[1], step->direction[2]);
        if (step->met) {
            const BpMaterial *material = &scene->materials[step->material];
            printf("       after %.6g meets sphere %" PRIu32 " from %s at (%.6g, %.6g, %.6g)\n",
                   step->distance, step->sphere, step->enters ? "outside" : "inside", step->point[0],
                   step->point[1], step->point[2]);
            fputs("       ", stdout);
            bp_show(material->name, false, stdout);
            printf(" (%s) %s", kind_name(material->kind), outcome(step, material->kind));
            if (step->goes_on)
                printf(", with (%.4g, %.4g, %.4g) of its light", step->throughput[0], step->throughput[1],
                       step->throughput[2]);
            printf("\n");
        } else {
            printf("       meets nothing: the sky\n");
        }
        radiance = step->radiance;
    }
    if (path->cut) printf("       the depth cap ends it here\n");
    if (path->count == 0) printf("       no segment at all: the depth cap is 0\n");
    printf("  the sample: (%.6g, %.6g, %.6g)%s\n", radiance[0], radiance[1], radiance[2],
           is_black(radiance) ? ", black" : "");
}

static json_t *triple(const double v[3]) {
    return json_pack("[f,f,f]", v[0], v[1], v[2]);
}

static json_t *step_json(const BpScene *scene, const BpPathStep *step) {
    json_t *root = json_pack("{s:o, s:o, s:o, s:o, s:b}", "origin", triple(step->origin), "direction",
                             triple(step->direction), "throughput", triple(step->throughput), "radiance",
                             triple(step->radiance), "met", step->met);
    if (root == NULL || !step->met) return root;
    const BpMaterial *material = &scene->materials[step->material];
    json_t *meeting = json_pack("{s:f, s:o, s:I, s:s, s:s, s:b, s:b, s:b}", "distance", step->distance,
                                "point", triple(step->point), "sphere", (json_int_t)step->sphere, "material",
                                material->name, "type", kind_name(material->kind), "enters", step->enters,
                                "goes_on", step->goes_on, "inward", step->inward);
    const bool whole = meeting != NULL && json_object_update(root, meeting) == 0;
    json_decref(meeting);
    if (whole) return root;
    json_decref(root);
    return NULL;
}

json_t *bp_path_json(const BpScene *scene, const BpPathLog *path, uint32_t x, uint32_t y, uint64_t sample) {
    json_t *steps = json_array();
    for (size_t i = 0; i < path->count && steps != NULL; ++i) {
        if (json_array_append_new(steps, step_json(scene, &path->steps[i])) == 0) continue;
        json_decref(steps);
        steps = NULL;
    }
    return json_pack("{s:[I,I], s:I, s:o, s:b, s:o}", "pixel", (json_int_t)x, (json_int_t)y, "sample",
                     (json_int_t)sample, "device", bp_json_text(path->device.name), "cut", path->cut, "steps",
                     steps);
}
