/* unseen_text.c: see unseen_text.h. */
#include "unseen_text.h"

#include "base/format.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* Spheres that bring less than this share are not named. */
#define PART_MIN 0.1

/* Whether most of it is seen with nothing between. */
static bool is_direct(const BpUnseenLight *light) {
    return light->direct > 0.5;
}

static size_t named_spheres(const BpUnseenLight *light) {
    size_t named = 0;
    const bool others = light->triangles >= PART_MIN;
    while (named < light->sphere_count && ((named == 0 && !others) || light->parts[named] >= PART_MIN))
        ++named;
    return named;
}

static void print_sphere(const BpScene *scene, size_t sphere, FILE *out) {
    char name[BP_SPHERE_NAME_SIZE];
    const char *material = scene->materials[scene->spheres[sphere].material].name;
    fputs(bp_sphere_name(scene, sphere, name), out);
    if (material != NULL && material[0] != '\0') fprintf(out, " (%s)", material);
}

/* The triangles and capsules of a material. */
static void print_others(const BpScene *scene, const BpUnseenLight *light, FILE *out) {
    const char *material = scene->materials[light->triangle_material].name;
    fputs(scene->capsule_count == 0    ? "triangles"
          : scene->triangle_count == 0 ? "capsules"
                                       : "triangles and capsules",
          out);
    if (material != NULL && material[0] != '\0') fprintf(out, " (%s)", material);
}

static void print_ways(const BpScene *scene, const BpUnseenLight *light, FILE *out) {
    const size_t named = named_spheres(light), also = light->triangles >= PART_MIN;
    double parts = light->triangles;
    for (size_t i = 0; i < named + also; ++i) {
        if (i > 0) fputs(i + 1 == named + also ? " and " : ", ", out);
        if (i == named) {
            print_others(scene, light, out);
            break;
        }
        print_sphere(scene, light->spheres[i], out);
        parts += light->parts[i];
    }
    if (parts + light->direct < 1 - 2 * PART_MIN) fputs(", and others like them", out);
}

static bool is_mirror(const BpMaterial *material) {
    return material->kind == BP_MATERIAL_METAL && !bp_material_is_lit(material);
}

static bool any_mirror(const BpScene *scene, const BpUnseenLight *light) {
    for (size_t i = 0; i < named_spheres(light); ++i)
        if (is_mirror(&scene->materials[scene->spheres[light->spheres[i]].material])) return true;
    return light->triangles >= PART_MIN && is_mirror(&scene->materials[light->triangle_material]);
}

void bp_unseen_print(const BpScene *scene, const BpUnseenLight *light, double luminance, bool caustics,
                     FILE *out) {
    char share[32], once[32];
    fprintf(out, "About %s of the light ", bp_format_percent(light->mean / luminance, share, sizeof share));
    if (is_direct(light)) {
        fputs("comes straight from lights that are smaller than a pixel", out);
    } else {
        fputs("comes by way of ", out);
        print_ways(scene, light, out);
    }
    fprintf(out, ", and one sample in %s finds it.", bp_format_count(1 / light->found, once, sizeof once));
    if (is_direct(light)) {
        fputs(" What helps: larger lights, or more samples.", out);
        return;
    }
    fprintf(out, " What helps: %slarger lamps or discs", caustics ? "--caustics auto, " : "");
    if (any_mirror(scene, light)) fputs(", a fuzz of 1/64 or a roughness of 1/16 for mirrors", out);
    fputs(", or many more samples.", out);
}

json_t *bp_unseen_json(const BpUnseenLight *light, double luminance) {
    if (!(light->mean > 0)) return json_null();
    json_t *spheres = json_array();
    for (size_t i = 0; i < light->sphere_count && spheres != NULL; ++i)
        json_array_append_new(spheres, json_pack("{s:I, s:f}", "sphere", (json_int_t)light->spheres[i],
                                                 "part", light->parts[i]));
    const double share = light->mean / luminance;
    return json_pack("{s:f, s:o, s:f, s:f, s:f, s:f, s:o, s:f}", "mean", light->mean, "share",
                     isfinite(share) ? json_real(share) : json_null(), "variance", light->square, "found",
                     light->found, "direct", light->direct, "triangles", light->triangles, "spheres", spheres,
                     "seconds", light->seconds);
}
