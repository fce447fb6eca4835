/* scene_validate.c: see scene_fault.h, and bp_scene_validate in scene.h. */
#include "base/message_text.h"
#include "body_rules.h"
#include "capsule_rules.h"
#include "material.h"
#include "scene_fault.h"
#include "scene_side.h"
#include "shape_rules.h"
#include "triangle_rules.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#define PI 3.14159265358979323846
#define LENGTH_MIN 1.0e-30 /* below, squares of lengths vanish even in double */
#define ALONG_VIEW_MAX                                                                                       \
    1.0e-9 /* sine of the angle between vup and the view that still gives a picture plane */

/* True, with the fault set, unless low <= value <= high; never true for a NaN. */
static bool outside(BpFault *fault, BpFaultSubject subject, const char *member, double value, double low,
                    double high, const char *expected) {
    if (value >= low && value <= high) return false;
    char text[BP_NUMBER_TEXT_SIZE];
    return bp_fault_set(fault, subject, member, "found %s, expected %s", bp_number_text(value, text),
                        expected);
}

static bool any_outside(BpFault *fault, BpFaultSubject subject, const char *member, const double value[3],
                        double low, double high, const char *expected) {
    return outside(fault, subject, member, value[0], low, high, expected) ||
           outside(fault, subject, member, value[1], low, high, expected) ||
           outside(fault, subject, member, value[2], low, high, expected);
}

static bool coordinates_outside(BpFault *fault, BpFaultSubject subject, const char *member,
                                const double value[3]) {
    return any_outside(fault, subject, member, value, -BP_COORDINATE_MAX, BP_COORDINATE_MAX,
                       "coordinates from -1e12 to 1e12; choose a larger unit of length");
}

static double length(const double v[3]) {
    return hypot(hypot(v[0], v[1]), v[2]);
}

static bool camera_basis_fault(const BpCamera *camera, BpFault *fault) {
    const double view[3] = {camera->lookat[0] - camera->lookfrom[0], camera->lookat[1] - camera->lookfrom[1],
                            camera->lookat[2] - camera->lookfrom[2]};
    const double distance = length(view), up_length = length(camera->vup);
    if (!(distance >= LENGTH_MIN))
        return bp_fault_set(
            fault, BP_FAULT_CAMERA, "lookat",
            "found the same point for lookfrom and lookat, expected two: the camera looks from "
            "one to the other");
    if (!(up_length >= LENGTH_MIN))
        return bp_fault_set(fault, BP_FAULT_CAMERA, "vup",
                            "found no direction, expected the one that is up, such as [0, 1, 0]");
    double v[3], u[3];
    for (int i = 0; i < 3; i++) {
        v[i] = view[i] / distance;
        u[i] = camera->vup[i] / up_length;
    }
    const double cross[3] = {v[1] * u[2] - v[2] * u[1], v[2] * u[0] - v[0] * u[2], v[0] * u[1] - v[1] * u[0]};
    if (!(length(cross) >= ALONG_VIEW_MAX))
        return bp_fault_set(
            fault, BP_FAULT_CAMERA, "vup",
            "found a direction parallel to the view, expected another: to look straight down, "
            "use [0, 0, -1]");
    return false;
}

/* Whether the plane in focus is too large for rays to be aimed at it in float. */
static bool plane_fault(const BpCamera *camera, BpFault *fault) {
    char vfov[BP_NUMBER_TEXT_SIZE], focus[BP_NUMBER_TEXT_SIZE];
    const double half_height = bp_camera_plane_height(camera) / 2;
    if (half_height <= BP_HALF_HEIGHT_MAX) return false;
    return bp_fault_set(
        fault, BP_FAULT_CAMERA, "vfov",
        "found %s with a focus_dist of %s, which makes the plane in focus %.3g high, expected at most "
        "%g; choose a smaller vfov or focus_dist",
        bp_number_text(camera->vfov_degrees, vfov), bp_number_text(camera->focus_dist, focus),
        2 * half_height, 2 * BP_HALF_HEIGHT_MAX);
}

static bool camera_fault(const BpCamera *camera, BpFault *fault) {
    const char *const side = "1 to 65535 pixels";
    char text[BP_NUMBER_TEXT_SIZE];
    if (!(camera->vfov_degrees > 0 && camera->vfov_degrees < 180))
        return bp_fault_set(fault, BP_FAULT_CAMERA, "vfov",
                            "found %s, expected degrees above 0 and below 180",
                            bp_number_text(camera->vfov_degrees, text));
    return outside(fault, BP_FAULT_CAMERA, "image_width", camera->width, 1, BP_PICTURE_SIDE_MAX, side) ||
           outside(fault, BP_FAULT_CAMERA, "image_height", camera->height, 1, BP_PICTURE_SIDE_MAX, side) ||
           outside(fault, BP_FAULT_CAMERA, "aspect_ratio", camera->aspect_ratio, DBL_MIN, DBL_MAX,
                   "a number above 0, or [width, height]") ||
           outside(fault, BP_FAULT_CAMERA, "samples_per_pixel", camera->samples_per_pixel, 1, UINT32_MAX,
                   "at least 1") ||
           outside(fault, BP_FAULT_CAMERA, "max_depth", camera->max_depth, 0, BP_DEPTH_MAX, "0 to 1000000") ||
           outside(fault, BP_FAULT_CAMERA, "focus_dist", camera->focus_dist, BP_FOCUS_DIST_MIN,
                   BP_COORDINATE_MAX,
                   "a distance above 0, from 1e-15 to 1e12; choose another unit of length") ||
           plane_fault(camera, fault) ||
           outside(fault, BP_FAULT_CAMERA, "aperture", camera->lens_radius, 0, BP_COORDINATE_MAX,
                   "a lens of radius 0 to 1e12") ||
           coordinates_outside(fault, BP_FAULT_CAMERA, "lookfrom", camera->lookfrom) ||
           coordinates_outside(fault, BP_FAULT_CAMERA, "lookat", camera->lookat) ||
           coordinates_outside(fault, BP_FAULT_CAMERA, "vup", camera->vup) ||
           camera_basis_fault(camera, fault);
}

static bool noise_fault(const BpTexture *texture, BpFault *fault) {
    return outside(fault, BP_FAULT_TEXTURE, "octaves", texture->octaves, 1, BP_OCTAVES_MAX,
                   "1 to 12 octaves") ||
           (bp_texture_has_waves(texture) &&
            (outside(fault, BP_FAULT_TEXTURE, "period", texture->period, BP_TEXTURE_SIZE_MIN,
                     BP_COORDINATE_MAX, "the length of a wave, from 1e-12 to 1e12") ||
             outside(fault, BP_FAULT_TEXTURE, "distortion", texture->distortion, 0, BP_DISTORTION_MAX,
                     "0 to 1000 waves")));
}

/* Whether columns or rows of all repetitions together are too many. */
static bool repeat_fault(const BpTexture *texture, BpFault *fault) {
    for (int i = 0; i < 2 && bp_texture_has(texture, BP_TEXTURE_FILE); i++) {
        const uint32_t side = i == 0 ? texture->image->width : texture->image->height;
        const uint64_t all = (uint64_t)side * texture->repeat[i];
        if (all > BP_COLUMNS_MAX)
            return bp_fault_set(
                fault, BP_FAULT_TEXTURE, "repeat",
                "found %u times %u texels, expected at most %u together; repeat it less often",
                (unsigned)texture->repeat[i], (unsigned)side, BP_COLUMNS_MAX);
    }
    return false;
}

static bool texture_fault(const BpTexture *texture, BpFault *fault) {
    for (int i = 0; i < 2 && bp_texture_has(texture, BP_TEXTURE_COLORS); i++)
        if (any_outside(fault, BP_FAULT_TEXTURE, "colors", texture->colors[i], 0, BP_RADIANCE_MAX,
                        "colours from 0 to 1, of light to 1e12"))
            return true;
    if (texture->mapping == BP_MAPPING_SOLID)
        return outside(fault, BP_FAULT_TEXTURE, "size", texture->size, BP_TEXTURE_SIZE_MIN, BP_COORDINATE_MAX,
                       "the length of a cell, from 1e-12 to 1e12") ||
               coordinates_outside(fault, BP_FAULT_TEXTURE, "origin", texture->origin) ||
               (bp_texture_has(texture, BP_TEXTURE_PATTERN) && noise_fault(texture, fault));
    if (coordinates_outside(fault, BP_FAULT_TEXTURE, "up", texture->up)) return true;
    if (!(length(texture->up) >= LENGTH_MIN))
        return bp_fault_set(fault, BP_FAULT_TEXTURE, "up",
                            "found no direction, expected that of the north pole, such as [0, 1, 0]");
    return outside(fault, BP_FAULT_TEXTURE, "turn", texture->turn_degrees, -BP_TEXTURE_TURN_MAX,
                   BP_TEXTURE_TURN_MAX, "degrees from -1e6 to 1e6") ||
           outside(fault, BP_FAULT_TEXTURE, "repeat", texture->repeat[0], 1, BP_TEXTURE_REPEAT_MAX,
                   "1 to 65536 times") ||
           outside(fault, BP_FAULT_TEXTURE, "repeat", texture->repeat[1], 1, BP_TEXTURE_REPEAT_MAX,
                   "1 to 65536 times") ||
           repeat_fault(texture, fault);
}

static bool density_fault(const double density[3], const char *member, BpFault *fault) {
    for (int c = 0; c < 3; c++)
        if (density[c] != 0 && outside(fault, BP_FAULT_MEDIUM, member, density[c], BP_DENSITY_MIN,
                                       BP_DENSITY_MAX, "0, or from 1e-12 to 1e12 per unit of length"))
            return true;
    return false;
}

static bool medium_fault(const BpMedium *medium, BpFault *fault) {
    return density_fault(medium->absorption, "absorption", fault) ||
           density_fault(medium->scattering, "scattering", fault) ||
           outside(fault, BP_FAULT_MEDIUM, "anisotropy", medium->anisotropy, -BP_ANISOTROPY_MAX,
                   BP_ANISOTROPY_MAX, "a mean cosine from -0.999 to 0.999; 0 scatters evenly");
}

/* Whether a member names no texture that there is, or one of colours where a number stands. */
static bool variation_fault(const BpScene *scene, const BpMaterial *material, BpMember m, BpFault *fault) {
    const uint32_t number = material->texture[m];
    if (number == 0) return false;
    if (number <= scene->texture_count && bp_texture_has(&scene->textures[number - 1], BP_TEXTURE_FILE) &&
        bp_members[m].form != BP_FORM_COLOUR && !scene->textures[number - 1].image->is_gray)
        return bp_fault_set(fault, BP_FAULT_MATERIAL, bp_members[m].name,
                            "found an image with colours, expected a grey one, whose texels are numbers");
    if (number > scene->texture_count)
        return bp_fault_set(fault, BP_FAULT_MATERIAL, bp_members[m].name,
                            "found texture number %u, expected one of %zu textures", (unsigned)number,
                            scene->texture_count);
    if (bp_members[m].form == BP_FORM_COLOUR || bp_texture_is_number(&scene->textures[number - 1]))
        return false;
    return bp_fault_set(fault, BP_FAULT_MATERIAL, bp_members[m].name,
                        "found a texture of colours, expected one of numbers, such as \"colors\": [0, 0.3]");
}

static bool material_fault(const BpScene *scene, const BpMaterial *material, BpFault *fault) {
    for (int m = 0; m < BP_MEMBER_COUNT; m++) {
        const BpMemberInfo *member = &bp_members[m];
        if (!bp_material_has(material->kind, (BpMember)m) || member->form == BP_FORM_CHOICE) continue;
        if (variation_fault(scene, material, (BpMember)m, fault)) return true;
        const double *values = bp_member_values_of(material, (BpMember)m);
        if (m == BP_MEMBER_OPACITY && *values == 0) continue; /* not given */
        if (member->form == BP_FORM_COLOUR ? any_outside(fault, BP_FAULT_MATERIAL, member->name, values,
                                                         member->low, member->high, member->range)
                                           : outside(fault, BP_FAULT_MATERIAL, member->name, *values,
                                                     member->low, member->high, member->range))
            return true;
    }
    if (material->kind == BP_MATERIAL_ROUGH_DIELECTRIC)
        return outside(
            fault, BP_FAULT_MATERIAL, "refraction_index", material->refraction_index,
            1.0 / BP_ROUGH_INDEX_MAX, BP_ROUGH_INDEX_MAX,
            "the index of the inside over that of the outside, from 0.1 to 10 where the surface is "
            "rough");
    return material->kind == BP_MATERIAL_GLOSSY &&
           outside(fault, BP_FAULT_MATERIAL, "refraction_index", material->refraction_index, 1,
                   BP_COAT_INDEX_MAX,
                   "the index of a coat over that of the air, from 1 to 10 (varnish and plastic: 1.5)");
}

/* A path that went straight on through a boundary would be in another medium at once. */
static void boundary_fault(const BpScene *scene, BpFault *fault) {
    for (size_t i = 0; i < scene->material_count; i++) {
        const BpMaterial *material = &scene->materials[i];
        if (bp_material_opacity(material) == 1 || !bp_material_is(material->kind, BP_HAS_INSIDE) ||
            !bp_scene_has_media(scene))
            continue;
        fault->index = i;
        bp_fault_set(fault, BP_FAULT_MATERIAL, "opacity",
                     "found %g in a material that light passes into, in a scene with media, expected 1: its "
                     "surface bounds a medium; remove the opacity, or the media",
                     bp_material_opacity(material));
        return;
    }
}

bool bp_sphere_find_fault(const BpSphere *sphere, BpFault *fault) {
    if (coordinates_outside(fault, BP_FAULT_SPHERE, "center", sphere->center)) return true;
    if (sphere->radius == 0)
        return bp_fault_set(
            fault, BP_FAULT_SPHERE, "radius",
            "found 0, expected another number; a negative radius turns the sphere inside out");
    return outside(fault, BP_FAULT_SPHERE, "radius", fabs(sphere->radius), (double)FLT_MIN, BP_COORDINATE_MAX,
                   "a radius from 1.2e-38 to 1e12 (or its negative); choose another unit of length");
}

static bool disc_fault(const BpDisc *disc, BpFault *fault) {
    const double low = BP_HALF_ANGLE_MIN;
    return coordinates_outside(fault, BP_FAULT_DISC, "direction", disc->direction) ||
           (!(length(disc->direction) >= LENGTH_MIN) &&
            bp_fault_set(
                fault, BP_FAULT_DISC, "direction",
                "found no direction, expected the one in which the disc stands, such as [1, 2, 0]")) ||
           outside(fault, BP_FAULT_DISC, "half_angle", disc->half_angle_degrees, low, 90,
                   "degrees from 0.0001 to 90, from the middle of the disc to its rim") ||
           any_outside(fault, BP_FAULT_DISC, "radiance", disc->radiance, 0, BP_RADIANCE_MAX,
                       "radiances from 0 to 1e12");
}

/* A pinhole may stand on one sphere. If it stood on two, its rays would have to leave both. One that moves is
 * there for no time at all. */
static bool standpoint_fault(const BpScene *scene, BpFault *fault) {
    char a[BP_SPHERE_NAME_SIZE], b[BP_SPHERE_NAME_SIZE];
    size_t found = 0, first = 0;
    if (scene->camera.lens_radius > 0 || scene->camera.projection == BP_ORTHOGRAPHIC) return false;
    for (size_t i = 0; i < scene->sphere_count; i++) {
        if (bp_sphere_side(&scene->spheres[i], scene->camera.lookfrom) != BP_SIDE_ON ||
            bp_sphere_moves(scene, i))
            continue;
        if (found++ > 0)
            return bp_fault_set(
                fault, BP_FAULT_CAMERA, "lookfrom",
                "found a point on the surfaces of both %s and %s, expected at most one surface: "
                "move the camera or one of the spheres slightly",
                bp_sphere_name(scene, first, a), bp_sphere_name(scene, i, b));
        first = i;
    }
    return false;
}

BpStatus bp_scene_find_fault(const BpScene *scene, BpFault *fault, BpError *err) {
    *fault = (BpFault){.subject = BP_FAULT_NONE, .member = ""};
    if (camera_fault(&scene->camera, fault)) return BP_OK;
    if (any_outside(fault, BP_FAULT_BACKGROUND, "bottom", scene->background_bottom, 0, BP_RADIANCE_MAX,
                    "radiances from 0 to 1e12") ||
        any_outside(fault, BP_FAULT_BACKGROUND, "top", scene->background_top, 0, BP_RADIANCE_MAX,
                    "radiances from 0 to 1e12") ||
        coordinates_outside(fault, BP_FAULT_BACKGROUND, "up", scene->background_up) ||
        outside(fault, BP_FAULT_BACKGROUND, "turn", scene->environment_turn, -BP_TEXTURE_TURN_MAX,
                BP_TEXTURE_TURN_MAX, "degrees from -1e6 to 1e6") ||
        any_outside(fault, BP_FAULT_BACKDROP, "bottom", scene->backdrop_bottom, 0, BP_RADIANCE_MAX,
                    "radiances from 0 to 1e12") ||
        any_outside(fault, BP_FAULT_BACKDROP, "top", scene->backdrop_top, 0, BP_RADIANCE_MAX,
                    "radiances from 0 to 1e12"))
        return BP_OK;
    for (size_t i = 0; i < scene->disc_count; i++) {
        fault->index = i;
        if (disc_fault(&scene->discs[i], fault)) return BP_OK;
    }
    for (size_t i = 0; i < scene->texture_count; i++) {
        fault->index = i;
        if (texture_fault(&scene->textures[i], fault)) return BP_OK;
    }
    for (size_t i = 0; i < scene->medium_count; i++) {
        fault->index = i;
        if (medium_fault(&scene->media[i], fault)) return BP_OK;
    }
    for (size_t i = 0; i < scene->material_count; i++) {
        fault->index = i;
        if (material_fault(scene, &scene->materials[i], fault)) return BP_OK;
    }
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        fault->index = i;
        if (bp_sphere_find_fault(sphere, fault)) return BP_OK;
        if (i < scene->moving_count &&
            coordinates_outside(fault, BP_FAULT_SPHERE, "center_end", scene->center_ends[i]))
            return BP_OK;
        if (sphere->material >= scene->material_count) {
            bp_fault_set(fault, BP_FAULT_SPHERE, "material", "found number %u, expected one of %zu materials",
                         (unsigned)sphere->material, scene->material_count);
            return BP_OK;
        }
        if (bp_interior_fault(scene, i, BP_FAULT_SPHERE, "sphere", fault)) return BP_OK;
        if (sphere->albedo != BP_NO_ALBEDO && sphere->albedo >= scene->albedo_count) {
            bp_fault_set(fault, BP_FAULT_SPHERE, "albedo", "found number %u, expected one of %zu albedos",
                         (unsigned)sphere->albedo, scene->albedo_count);
            return BP_OK;
        }
    }
    for (size_t i = 0; i < scene->albedo_count; i++) {
        const double albedo[3] = {(double)scene->albedos[i][0], (double)scene->albedos[i][1],
                                  (double)scene->albedos[i][2]};
        fault->index = i;
        if (any_outside(fault, BP_FAULT_ALBEDO, "", albedo, 0, 1, "shares of light from 0 to 1"))
            return BP_OK;
    }
    BP_TRY(bp_scene_find_coincident(scene, fault, err));
    if (fault->subject == BP_FAULT_NONE) standpoint_fault(scene, fault);
    if (fault->subject == BP_FAULT_NONE) BP_TRY(bp_scene_find_triangle_fault(scene, fault, err));
    if (fault->subject == BP_FAULT_NONE) BP_TRY(bp_scene_find_capsule_fault(scene, fault, err));
    if (fault->subject == BP_FAULT_NONE) BP_TRY(bp_scene_find_body_fault(scene, fault, err));
    if (fault->subject == BP_FAULT_NONE) boundary_fault(scene, fault);
    return BP_OK;
}

BpStatus bp_scene_validate(const BpScene *scene, BpError *err) {
    BpFault fault;
    char name[BP_SPHERE_NAME_SIZE], other[BP_SPHERE_NAME_SIZE];
    if (bp_scene_shapes(scene) > BP_SPHERES_MAX)
        return bp_fail(err, BP_ERR_LIMIT, "found %zu %ss, expected at most %u", bp_scene_shapes(scene),
                       bp_scene_noun(scene), BP_SPHERES_MAX);
    if (scene->disc_count > BP_DISCS_MAX)
        return bp_fail(err, BP_ERR_LIMIT, "background.discs: found %zu discs, expected at most %u",
                       scene->disc_count, BP_DISCS_MAX);
    BP_TRY(bp_scene_find_fault(scene, &fault, err));
    switch (fault.subject) {
    case BP_FAULT_NONE:
        return BP_OK;
    case BP_FAULT_CAMERA:
        return bp_fail(err, BP_ERR_SCENE, "camera.%s: %s", fault.member, fault.text);
    case BP_FAULT_BACKGROUND:
        return bp_fail(err, BP_ERR_SCENE, "background.%s: %s", fault.member, fault.text);
    case BP_FAULT_DISC:
        return bp_fail(err, BP_ERR_SCENE, "background.discs[%zu].%s: %s", fault.index, fault.member,
                       fault.text);
    case BP_FAULT_BACKDROP:
        return bp_fail(err, BP_ERR_SCENE, "backdrop.%s: %s", fault.member, fault.text);
    case BP_FAULT_TEXTURE:
        bp_printable(scene->textures[fault.index].name, name, sizeof name);
        return bp_fail(err, BP_ERR_SCENE, "textures.%s.%s: %s", name, fault.member, fault.text);
    case BP_FAULT_MEDIUM:
        bp_printable(scene->media[fault.index].name, name, sizeof name);
        return bp_fail(err, BP_ERR_SCENE, "media.%s.%s: %s", name, fault.member, fault.text);
    case BP_FAULT_MATERIAL:
        bp_printable(scene->materials[fault.index].name, name, sizeof name);
        return bp_fail(err, BP_ERR_SCENE, "materials.%s.%s: %s", name, fault.member, fault.text);
    case BP_FAULT_SPHERE:
        return bp_fail(err, BP_ERR_SCENE, "spheres[%zu].%s: %s", fault.index, fault.member, fault.text);
    case BP_FAULT_TRIANGLE:
        return bp_fail(err, BP_ERR_SCENE, "%s%s%s: %s", bp_triangle_name(scene, fault.index, name),
                       fault.member[0] != '\0' ? "." : "", fault.member, fault.text);
    case BP_FAULT_CAPSULE:
        return bp_fail(err, BP_ERR_SCENE, "%s%s%s: %s", bp_capsule_name(scene, fault.index, name),
                       fault.member[0] != '\0' ? "." : "", fault.member, fault.text);
    case BP_FAULT_ALBEDO:
        return bp_fail(err, BP_ERR_SCENE, "albedo %zu: %s", fault.index, fault.text);
    case BP_FAULT_COINCIDENT:
        return bp_fail(err, BP_ERR_SCENE, "%s and %s: %s", bp_sphere_name(scene, fault.other, name),
                       bp_sphere_name(scene, fault.index, other), fault.text);
    }
    return BP_OK;
}
