/* scene_write.c: a BpScene as a document of the grammar, laid out for people: one sphere a line.
 *
 * In:    a scene.   Out: JSON text that reads back to the same scene, bit for bit.
 * Knows: the grammar.  Does not know: how the file comes to stand at its place (base/output_file.h). */
#include "base/escape.h"
#include "base/json_memory.h"
#include "base/names.h"
#include "named_file.h"
#include "scene/fit.h"
#include "scene/lighting.h"
#include "scene/material.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static void put_number(FILE *out, double value) {
    char text[BP_NUMBER_TEXT_SIZE];
    fputs(bp_number_text(value, text), out);
}

static void put_vector(FILE *out, const double value[3]) {
    fputc('[', out);
    for (int i = 0; i < 3; i++) {
        if (i > 0) fputs(", ", out);
        put_number(out, value[i]);
    }
    fputc(']', out);
}

static void put_floats(FILE *out, const float value[3]) {
    put_vector(out, (const double[3]){(double)value[0], (double)value[1], (double)value[2]});
}

static BpStatus put_text(FILE *out, const char *text, BpError *err) {
    bool no_memory = false;
    char *quoted = bp_json_quote(text, &no_memory);
    if (no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory for writing the scene");
    if (quoted == NULL)
        return bp_fail(err, BP_ERR_SCENE, "cannot write the text \"%.60s\": expected UTF-8", text);
    bp_print_json_escaped(quoted, out);
    free(quoted);
    return BP_OK;
}

static bool is_dark(const double emit[3]) {
    return emit[0] == 0 && emit[1] == 0 && emit[2] == 0;
}

/* ---- the camera --------------------------------------------------------------------------------------- */

/* Writes the ratio as [w, h] of small whole numbers if they give the same number, since people write it so.
 */
static void put_aspect(FILE *out, double aspect) {
    for (int h = 1; h <= 16; h++) {
        const double w = floor(aspect * h + 0.5);
        if (w < 1 || w > 64 || w / h != aspect) continue;
        if (h == 1)
            put_number(out, aspect);
        else
            fprintf(out, "[%.0f, %d]", w, h);
        return;
    }
    put_number(out, aspect);
}

/* The lens as a defocus angle where a round one gives the same lens, else as an aperture. */
static void put_lens(FILE *out, const BpCamera *camera) {
    if (camera->lens_radius == 0) return;
    char text[BP_NUMBER_TEXT_SIZE];
    const double exact = 2 * atan(camera->lens_radius / camera->focus_dist) * (180 / PI);
    snprintf(text, sizeof text, "%.6g", exact);
    const double angle = strtod(text, NULL);
    if (angle > 0 && angle < 180 && bp_lens_radius(angle, camera->focus_dist) == camera->lens_radius) {
        fputs("\"defocus_angle\": ", out);
        put_number(out, angle);
    } else {
        fputs("\"aperture\": ", out);
        put_number(out, 2 * camera->lens_radius);
    }
    fputs(", ", out);
}

/* What a fitted camera was asked for; where it stands follows. */
static void put_fit(FILE *out, const BpCamera *camera) {
    fprintf(out, ", \"fit\": \"%s\", \"view\": ", camera->fit == BP_FIT_SCENE ? "scene" : "particles");
    if (camera->view == BP_VIEW_NONE)
        put_vector(out, camera->view_direction);
    else
        fprintf(out, "\"%s\"", bp_view_names[camera->view]);
    fputs(", \"margin\": ", out);
    put_number(out, camera->margin);
    if (!is_dark(camera->fit_vup)) {
        fputs(", \"vup\": ", out);
        put_vector(out, camera->fit_vup);
    }
    if (camera->lens_radius > 0) {
        fputs(",\n    \"aperture\": ", out);
        put_number(out, 2 * camera->lens_radius);
    }
    if (camera->pixel_sampling == BP_PIXEL_CENTER) fputs(", \"pixel_sampling\": \"center\"", out);
    fputs("\n  }", out);
}

void bp_scene_print_camera(const BpCamera *camera, FILE *out) {
    fprintf(out, "  \"camera\": {\n    \"image_width\": %u, ", (unsigned)camera->width);
    if (bp_camera_height(camera->width, camera->aspect_ratio) == camera->height) {
        fputs("\"aspect_ratio\": ", out);
        put_aspect(out, camera->aspect_ratio);
    } else {
        fprintf(out, "\"image_height\": %u", (unsigned)camera->height);
    }
    fprintf(out, ", \"samples_per_pixel\": %u, \"max_depth\": %u,\n    \"vfov\": ",
            (unsigned)camera->samples_per_pixel, (unsigned)camera->max_depth);
    put_number(out, camera->vfov_degrees);
    if (camera->projection == BP_ORTHOGRAPHIC) {
        fputs(", \"projection\": \"orthographic\"", out);
        if (camera->view_height > 0 && camera->fit == BP_FIT_NONE) {
            fputs(", \"view_height\": ", out);
            put_number(out, camera->view_height);
        }
    }
    if (camera->fit != BP_FIT_NONE) {
        put_fit(out, camera);
        return;
    }
    fputs(", \"lookfrom\": ", out);
    put_vector(out, camera->lookfrom);
    fputs(", \"lookat\": ", out);
    put_vector(out, camera->lookat);
    fputs(", \"vup\": ", out);
    put_vector(out, camera->vup);
    fputs(",\n    ", out);
    put_lens(out, camera);
    fputs("\"focus_dist\": ", out);
    put_number(out, camera->focus_dist);
    if (camera->pixel_sampling == BP_PIXEL_CENTER) fputs(", \"pixel_sampling\": \"center\"", out);
    fputs("\n  }", out);
}

/* What follows the member that names it. */
static BpStatus put_image(FILE *out, const BpImage *image, BpError *err) {
    BP_TRY(put_text(out, image->file, err));
    if (image->inside > 0) fprintf(out, ", \"image\": %u", (unsigned)image->inside - 1);
    if (image->encoding != BP_ENCODING_OF_FORMAT)
        fprintf(out, ", \"encoding\": \"%s\"", image->encoding == BP_ENCODING_SRGB ? "srgb" : "linear");
    if (image->scale < 1 || image->scale > 1) {
        fputs(", \"scale\": ", out);
        put_number(out, image->scale);
    }
    return BP_OK;
}

static BpStatus put_background(FILE *out, const BpScene *scene, BpError *err) {
    if (scene->environment != NULL) {
        fputs(",\n  \"background\": { \"image\": ", out);
        BP_TRY(put_image(out, scene->environment, err));
        fputs(", \"turn\": ", out);
        put_number(out, scene->environment_turn);
    } else {
        fputs(",\n  \"background\": { \"bottom\": ", out);
        put_vector(out, scene->background_bottom);
        fputs(", \"top\": ", out);
        put_vector(out, scene->background_top);
    }
    if (!is_dark(scene->background_up)) {
        fputs(", \"up\": ", out);
        put_vector(out, scene->background_up);
    }
    for (size_t i = 0; i < scene->disc_count; i++) {
        const BpDisc *disc = &scene->discs[i];
        fprintf(out, "%s\n      { \"direction\": ", i == 0 ? ",\n    \"discs\": [" : ",");
        put_vector(out, disc->direction);
        fputs(", \"half_angle\": ", out);
        put_number(out, disc->half_angle_degrees);
        fputs(", \"radiance\": ", out);
        put_vector(out, disc->radiance);
        if (!disc->visible_to_camera) fputs(", \"visible_to_camera\": false", out);
        fputs(" }", out);
    }
    fputs(scene->disc_count > 0 ? "\n    ]\n  }" : " }", out);
    return BP_OK;
}

/* Writes what camera rays that meet nothing see, if that is not the background. */
static void put_shadow_catcher(FILE *out, const BpShadowCatcher *catcher) {
    const bool has_up = catcher->up[0] != 0 || catcher->up[1] != 0 || catcher->up[2] != 0;
    if (!catcher->present) return;
    if (!has_up && !catcher->has_height) {
        fputs(",\n  \"shadow_catcher\": true", out);
        return;
    }
    fputs(",\n  \"shadow_catcher\": { ", out);
    if (catcher->has_height) {
        fputs("\"height\": ", out);
        put_number(out, catcher->height);
    }
    if (has_up) {
        fputs(catcher->has_height ? ", \"up\": " : "\"up\": ", out);
        put_vector(out, catcher->up);
    }
    fputs(" }", out);
}

static void put_backdrop(FILE *out, const BpScene *scene) {
    if (scene->backdrop == BP_BACKDROP_SKY) return;
    if (scene->backdrop == BP_BACKDROP_NONE) {
        fputs(",\n  \"backdrop\": \"none\"", out);
        return;
    }
    fputs(",\n  \"backdrop\": { \"bottom\": ", out);
    put_vector(out, scene->backdrop_bottom);
    fputs(", \"top\": ", out);
    put_vector(out, scene->backdrop_top);
    fputs(" }", out);
}

static BpStatus put_figure(FILE *out, const BpFigure *figure, BpError *err) {
    const char *joint = ",\n  \"figure\": { ";
    if (figure->font[0] != '\0') {
        fprintf(out, "%s\"font\": ", joint);
        BP_TRY(put_text(out, figure->font, err));
        joint = ", ";
    }
    if (figure->points > 0) {
        fprintf(out, "%s\"size\": ", joint);
        put_number(out, figure->points);
        joint = ", ";
    }
    if (figure->text != BP_TEXT_AUTO) {
        fprintf(out, "%s\"text\": \"%s\"", joint, bp_figure_text_names[figure->text]);
        joint = ", ";
    }
    if (joint[1] == ' ') fputs(" }", out);
    return BP_OK;
}

/* ---- textures, materials and spheres
 * ------------------------------------------------------------------------------
 */

/* A member that the document may leave out is left out: a choice that is the first of its names, a colour of
 * zeros, an opacity of 1. */
static BpStatus put_member(FILE *out, const BpScene *scene, const BpMaterial *material, BpMember m,
                           BpError *err) {
    const BpMemberInfo *member = &bp_members[m];
    if (material->texture[m] != 0) {
        fprintf(out, ", \"%s\": { \"texture\": ", member->name);
        BP_TRY(put_text(out, scene->textures[material->texture[m] - 1].name, err));
        fputs(" }", out);
        return BP_OK;
    }
    const bool needed = (bp_material_types[material->kind].needed >> m & 1u) != 0;
    const unsigned choice = member->form == BP_FORM_CHOICE ? bp_member_choice(material, m) : 0;
    if (member->form == BP_FORM_CHOICE && choice == 0) return BP_OK;
    if (m == BP_MEMBER_OPACITY && bp_material_opacity(material) == 1) return BP_OK;
    if (member->form == BP_FORM_COLOUR && !needed && is_dark(bp_member_values_of(material, m))) return BP_OK;
    fprintf(out, ", \"%s\": ", member->name);
    switch (member->form) {
    case BP_FORM_COLOUR:
        put_vector(out, bp_member_values_of(material, m));
        break;
    case BP_FORM_NUMBER:
        put_number(out, *bp_member_values_of(material, m));
        break;
    case BP_FORM_CHOICE:
        fprintf(out, "\"%s\"", member->names[choice]);
        break;
    }
    return BP_OK;
}

static BpStatus put_material(FILE *out, const BpScene *scene, const BpMaterial *material, BpError *err) {
    fputs("    ", out);
    BP_TRY(put_text(out, material->name, err));
    fprintf(out, ": { \"type\": \"%s\"", bp_material_types[material->kind].name);
    for (int m = 0; m < BP_MEMBER_COUNT; m++)
        if (bp_material_has(material->kind, (BpMember)m))
            BP_TRY(put_member(out, scene, material, (BpMember)m, err));
    fputs(" }", out);
    return BP_OK;
}

/* A colour, or the number that it stands for. */
static void put_value(FILE *out, const double value[3]) {
    if (value[0] == value[1] && value[0] == value[2])
        put_number(out, value[0]);
    else
        put_vector(out, value);
}

static void put_solid(FILE *out, const BpTexture *texture) {
    fputs(", \"size\": ", out);
    put_number(out, texture->size);
    if (!is_dark(texture->origin)) {
        fputs(", \"origin\": ", out);
        put_vector(out, texture->origin);
    }
    if (!bp_texture_has(texture, BP_TEXTURE_PATTERN)) return;
    fprintf(out, ", \"octaves\": %u", (unsigned)texture->octaves);
    if (texture->seed != 0) fprintf(out, ", \"seed\": %u", (unsigned)texture->seed);
    if (!bp_texture_has_waves(texture)) return;
    fprintf(out, ", \"axis\": \"%s\", \"period\": ", bp_axis_names[texture->axis]);
    put_number(out, texture->period);
    fputs(", \"distortion\": ", out);
    put_number(out, texture->distortion);
}

static BpStatus put_texture(FILE *out, const BpTexture *texture, BpError *err) {
    fputs("    ", out);
    BP_TRY(put_text(out, texture->name, err));
    fprintf(out, ": { \"type\": \"%s\"", bp_texture_type_names[texture->type]);
    if (bp_texture_has(texture, BP_TEXTURE_PATTERN))
        fprintf(out, ", \"pattern\": \"%s\"", bp_pattern_names[texture->pattern]);
    if (bp_texture_has(texture, BP_TEXTURE_MAPPING))
        fprintf(out, ", \"mapping\": \"%s\"", bp_mapping_names[texture->mapping]);
    if (bp_texture_has(texture, BP_TEXTURE_FILE)) {
        fputs(", \"file\": ", out);
        BP_TRY(put_image(out, texture->image, err));
        if (texture->wrap == BP_WRAP_CLAMP) fputs(", \"wrap\": \"clamp\"", out);
    }
    if (bp_texture_has(texture, BP_TEXTURE_COLORS)) {
        fputs(", \"colors\": [", out);
        put_value(out, texture->colors[0]);
        fputs(", ", out);
        put_value(out, texture->colors[1]);
        fputs("]", out);
    }
    if (texture->mapping == BP_MAPPING_SOLID)
        put_solid(out, texture);
    else {
        fputs(", \"up\": ", out);
        put_vector(out, texture->up);
        fputs(", \"turn\": ", out);
        put_number(out, texture->turn_degrees);
        fprintf(out, ", \"repeat\": [%u, %u]", (unsigned)texture->repeat[0], (unsigned)texture->repeat[1]);
    }
    fputs(" }", out);
    return BP_OK;
}

static BpStatus put_textures(FILE *out, const BpScene *scene, BpError *err) {
    fputs(",\n  \"textures\": {", out);
    for (size_t i = 0; i < scene->texture_count; i++) {
        fputs(i > 0 ? ",\n" : "\n", out);
        BP_TRY(put_texture(out, &scene->textures[i], err));
    }
    fputs("\n  }", out);
    return BP_OK;
}

static BpStatus put_media(FILE *out, const BpScene *scene, BpError *err) {
    fputs(",\n  \"media\": {", out);
    for (size_t i = 0; i < scene->medium_count; i++) {
        const BpMedium *medium = &scene->media[i];
        fputs(i > 0 ? ",\n    " : "\n    ", out);
        BP_TRY(put_text(out, medium->name, err));
        fputs(": { \"absorption\": ", out);
        put_value(out, medium->absorption);
        fputs(", \"scattering\": ", out);
        put_value(out, medium->scattering);
        fputs(", \"anisotropy\": ", out);
        put_number(out, medium->anisotropy);
        fputs(" }", out);
    }
    fputs("\n  }", out);
    if (scene->medium == 0) return BP_OK;
    fputs(",\n  \"medium\": ", out);
    return put_text(out, scene->media[scene->medium - 1].name, err);
}

/* Without that of particles that name none, which is the last. */
static size_t written_materials(const BpScene *scene) {
    return scene->material_count - (scene->implicit_material != SIZE_MAX);
}

static BpStatus put_materials(FILE *out, const BpScene *scene, BpError *err) {
    fputs(",\n  \"materials\": {", out);
    for (size_t i = 0; i < written_materials(scene); i++) {
        fputs(i > 0 ? ",\n" : "\n", out);
        BP_TRY(put_material(out, scene, &scene->materials[i], err));
    }
    fputs("\n  }", out);
    return BP_OK;
}

/* The member "interior" of a shape, where it has one. */
static BpStatus put_interior(FILE *out, const BpScene *scene, size_t shape, BpError *err) {
    const uint32_t interior = bp_shape_named_interior(scene, shape);
    if (interior == 0) return BP_OK;
    fputs(", \"interior\": ", out);
    return put_text(out, scene->media[interior - 1].name, err);
}

static size_t written_spheres(const BpScene *scene) {
    return scene->has_particles ? scene->particle_first : scene->sphere_count;
}

static void put_particles(FILE *out, const BpScene *scene) {
    const char *comma = "";
    fputs(",\n  \"particles\": [", out);
    for (size_t i = 0; i < scene->point_file_count; i++) {
        if (scene->point_files[i].entry == NULL) continue;
        fprintf(out, "%s\n    ", comma);
        bp_print_json_escaped(scene->point_files[i].entry, out);
        comma = ",";
    }
    fputs("\n  ]", out);
}

static BpStatus put_spheres(FILE *out, const BpScene *scene, BpError *err) {
    fputs(",\n  \"spheres\": [", out);
    for (size_t i = 0; i < written_spheres(scene); i++) {
        const BpSphere *sphere = &scene->spheres[i];
        fputs(i > 0 ? ",\n    { \"center\": " : "\n    { \"center\": ", out);
        put_vector(out, sphere->center);
        fputs(", \"radius\": ", out);
        put_number(out, sphere->radius);
        fputs(", \"material\": ", out);
        BP_TRY(put_text(out, scene->materials[sphere->material].name, err));
        if (bp_sphere_moves(scene, i)) {
            fputs(", \"center_end\": ", out);
            put_vector(out, bp_sphere_end(scene, i));
        }
        BP_TRY(put_interior(out, scene, i, err));
        fputs(" }", out);
    }
    fputs("\n  ]", out);
    return BP_OK;
}

/* Files of "meshes" come first; without one there is no list. */
static void put_meshes(FILE *out, const BpScene *scene) {
    if (scene->mesh_file_count == 0 || scene->mesh_files[0].entry == NULL) return;
    fputs(",\n  \"meshes\": [", out);
    for (size_t i = 0; i < scene->mesh_file_count; i++) {
        if (scene->mesh_files[i].entry == NULL) continue;
        fputs(i > 0 ? ",\n    " : "\n    ", out);
        bp_print_json_escaped(scene->mesh_files[i].entry, out);
    }
    fputs("\n  ]", out);
}

/* Those of quads and boxes too, since their vertices have been computed. */
static BpStatus put_triangles(FILE *out, const BpScene *scene, BpError *err) {
    fputs(",\n  \"triangles\": [", out);
    for (size_t i = 0; i < bp_scene_listed_triangles(scene); i++) {
        const BpTriangle *triangle = &scene->triangles[i];
        fputs(i > 0 ? ",\n    { \"vertices\": [" : "\n    { \"vertices\": [", out);
        for (int k = 0; k < 3; k++) {
            if (k > 0) fputs(", ", out);
            put_vector(out, triangle->vertices[k]);
        }
        const float(*const normals)[3] = bp_triangle_normals(scene, i);
        if (normals != NULL) fputs("], \"normals\": [", out);
        for (int k = 0; k < 3 && normals != NULL; k++) {
            if (k > 0) fputs(", ", out);
            put_floats(out, normals[k]);
        }
        const float *const at = bp_triangle_coordinates(scene, i);
        if (at != NULL) fputs("], \"uvs\": [", out);
        for (int k = 0; k < 3 && at != NULL; k++) {
            fputs(k > 0 ? ", [" : "[", out);
            put_number(out, (double)at[2 * k]);
            fputs(", ", out);
            put_number(out, (double)at[2 * k + 1]);
            fputc(']', out);
        }
        fputs("], \"material\": ", out);
        BP_TRY(put_text(out, scene->materials[triangle->material].name, err));
        BP_TRY(put_interior(out, scene, scene->sphere_count + i, err));
        fputs(" }", out);
    }
    fputs("\n  ]", out);
    return BP_OK;
}

static BpStatus put_capsules(FILE *out, const BpScene *scene, BpError *err) {
    fputs(",\n  \"capsules\": [", out);
    for (size_t i = 0; i < scene->listed_capsules; i++) {
        const BpCapsule *capsule = &scene->capsules[i];
        fputs(i > 0 ? ",\n    { \"ends\": [" : "\n    { \"ends\": [", out);
        put_vector(out, capsule->ends[0]);
        fputs(", ", out);
        put_vector(out, capsule->ends[1]);
        fputs("], \"radius\": ", out);
        put_number(out, capsule->radius);
        fputs(", \"material\": ", out);
        BP_TRY(put_text(out, scene->materials[capsule->material].name, err));
        BP_TRY(put_interior(out, scene, scene->sphere_count + scene->triangle_count + i, err));
        if (capsule->albedo[0] != BP_NO_ALBEDO) {
            fputs(", \"colors\": [", out);
            put_floats(out, scene->albedos[capsule->albedo[0]]);
            fputs(", ", out);
            put_floats(out, scene->albedos[capsule->albedo[1]]);
            fputc(']', out);
        }
        fputs(" }", out);
    }
    fputs("\n  ]", out);
    return BP_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

BpStatus bp_scene_print(const BpScene *scene, FILE *out, BpError *err) {
    bool coloured = false;
    for (size_t i = 0; i < written_spheres(scene); i++) coloured |= scene->spheres[i].albedo != BP_NO_ALBEDO;
    if (coloured)
        return bp_fail(
            err, BP_ERR_SCENE,
            "found points with colours of their own, expected none: the JSON grammar gives colours to "
            "materials; keep such points in a PLY file");
    fputs("{\n  \"format\": 1,\n  \"title\": ", out);
    BP_TRY(put_text(out, scene->title, err));
    fputs(",\n  \"source\": ", out);
    BP_TRY(put_text(out, scene->source, err));
    fputs(",\n", out);
    bp_scene_print_camera(&scene->camera, out);
    if (scene->lighting == BP_LIGHTING_SKY)
        BP_TRY(put_background(out, scene, err));
    else
        fprintf(out, ",\n  \"lighting\": \"%s\"", bp_lighting_names[scene->lighting]);
    put_backdrop(out, scene);
    put_shadow_catcher(out, &scene->shadow_catcher);
    fprintf(out, ",\n  \"transfer\": \"%s\"", bp_transfer_names[scene->transfer]);
    BP_TRY(put_figure(out, &scene->figure, err));
    if (scene->texture_count > 0) BP_TRY(put_textures(out, scene, err));
    if (scene->medium_count > 0) BP_TRY(put_media(out, scene, err));
    if (written_materials(scene) > 0) BP_TRY(put_materials(out, scene, err));
    if (written_spheres(scene) > 0) BP_TRY(put_spheres(out, scene, err));
    if (bp_scene_listed_triangles(scene) > 0) BP_TRY(put_triangles(out, scene, err));
    if (scene->listed_capsules > 0) BP_TRY(put_capsules(out, scene, err));
    put_meshes(out, scene);
    if (scene->has_particles) put_particles(out, scene);
    fputs("\n}\n", out);
    if (ferror(out)) return bp_fail(err, BP_ERR_FILE, "cannot write the scene: %s", strerror(errno));
    return BP_OK;
}
