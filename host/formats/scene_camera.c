/* scene_camera.c: see scene_camera.h. */
#include "scene_camera.h"

#include "base/words.h"
#include "scene/fit.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static BpStatus read_aspect(const BpNode *node, double *aspect, BpError *err) {
    if (node->value == NULL) return BP_OK;
    double side[2] = {0, 1};
    if (json_array_size(node->value) == 2) {
        for (size_t i = 0; i < 2; i++) {
            const BpNode element = bp_node_element(node, i);
            BP_TRY(bp_node_number(&element, &side[i], err));
        }
    } else if (json_is_number(node->value)) {
        side[0] = json_number_value(node->value);
    } else {
        return bp_node_wrong(node, "a number, or two: [16, 9]", err);
    }
    *aspect = side[0] / side[1];
    if (!(side[0] > 0 && side[1] > 0 && *aspect > 0 && isfinite(*aspect)))
        return bp_node_fail(node, BP_PART_VALUE, err,
                            "found a ratio that is not above 0, expected a number above 0, or two: [16, 9]");
    return BP_OK;
}

static BpStatus read_size(const BpNode *node, BpCamera *camera, BpError *err) {
    const BpNode width = bp_node_member(node, "image_width");
    const BpNode height = bp_node_member(node, "image_height");
    const BpNode aspect = bp_node_member(node, "aspect_ratio");
    BP_TRY(bp_node_integer(&width, 1, BP_PICTURE_SIDE_MAX, &camera->width, err));
    if (height.value != NULL) {
        if (aspect.value != NULL)
            return bp_node_fail(&height, BP_PART_NAME, err,
                                "found beside \"aspect_ratio\", expected one of the two; remove one");
        BP_TRY(bp_node_integer(&height, 1, BP_PICTURE_SIDE_MAX, &camera->height, err));
        camera->aspect_ratio = (double)camera->width / camera->height;
        return BP_OK;
    }
    BP_TRY(read_aspect(&aspect, &camera->aspect_ratio, err));
    camera->height = bp_camera_height(camera->width, camera->aspect_ratio);
    if (camera->height > BP_PICTURE_SIDE_MAX)
        return bp_node_fail(&aspect, BP_PART_VALUE, err,
                            "found a picture %u pixels high, expected at most %u", (unsigned)camera->height,
                            BP_PICTURE_SIDE_MAX);
    return BP_OK;
}

static BpStatus read_lens(const BpNode *node, BpCamera *camera, BpError *err) {
    const BpNode focus = bp_node_member(node, "focus_dist");
    const BpNode aperture = bp_node_member(node, "aperture");
    const BpNode angle = bp_node_member(node, "defocus_angle");
    double diameter = 0, degrees = 0;
    BP_TRY(bp_node_number(&focus, &camera->focus_dist, err));
    BP_TRY(bp_node_number(&aperture, &diameter, err));
    BP_TRY(bp_node_number(&angle, &degrees, err));
    if (aperture.value != NULL && angle.value != NULL)
        return bp_node_fail(&aperture, BP_PART_NAME, err,
                            "found beside \"defocus_angle\", expected one of the two; remove one");
    if (diameter < 0)
        return bp_node_wrong(&aperture, "the diameter of the lens: 0 (all in focus) or more", err);
    if (degrees < 0 || degrees >= 180)
        return bp_node_wrong(&angle, "degrees from 0 (all in focus) to below 180", err);
    if (angle.value != NULL)
        camera->lens_radius = bp_lens_radius(degrees, camera->focus_dist);
    else
        camera->lens_radius = diameter / 2;
    return BP_OK;
}

static BpStatus read_view(const BpNode *node, BpCamera *camera, BpError *err) {
    if (node->value == NULL) {
        camera->view = BP_VIEW_THREE_QUARTER;
        return BP_OK;
    }
    if (json_is_string(node->value)) {
        int choice = 0;
        BP_TRY(bp_node_choice(node, bp_view_names + 1, BP_VIEW_COUNT - 1, &choice, err));
        camera->view = (BpView)(choice + 1);
        return BP_OK;
    }
    if (!json_is_array(node->value))
        return bp_node_wrong(node,
                             "the name of a view, such as \"front\", or a direction to the camera, such as "
                             "[1, 1, 1]",
                             err);
    BP_TRY(bp_node_vector(node, camera->view_direction, err));
    camera->view = BP_VIEW_NONE;
    const double *const d = camera->view_direction;
    if (d[0] != 0 || d[1] != 0 || d[2] != 0) return BP_OK;
    return bp_node_wrong(node, "a direction to the camera, such as [1, 1, 1]", err);
}

static BpStatus read_projection(const BpNode *node, BpCamera *camera, BpError *err) {
    const BpNode projection = bp_node_member(node, "projection");
    const BpNode height = bp_node_member(node, "view_height");
    int choice = BP_PERSPECTIVE;
    BP_TRY(bp_node_choice(&projection, bp_projection_names, 2, &choice, err));
    camera->projection = (BpProjection)choice;
    BP_TRY(bp_node_number(&height, &camera->view_height, err));
    if (height.value == NULL) return BP_OK;
    if (camera->projection == BP_PERSPECTIVE)
        return bp_node_fail(&height, BP_PART_NAME, err,
                            "found without \"projection\": \"orthographic\", expected \"vfov\" instead");
    if (!(camera->view_height >= BP_FOCUS_DIST_MIN && camera->view_height <= 2 * BP_HALF_HEIGHT_MAX))
        return bp_node_wrong(&height, "how much the picture's height shows, above 0 and up to 2e14", err);
    return BP_OK;
}

#define FIT_WORDS(X) X(BP_FIT_NONE, "") X(BP_FIT_SCENE, "scene") X(BP_FIT_PARTICLES, "particles")
BP_WORDS(BpFit, static const char *const fit_names, FIT_WORDS);

/* "fit" and what belongs to it. */
static BpStatus read_fit(const BpNode *node, BpCamera *camera, BpError *err) {
    static const char *const without[] = {"view", "margin"}, *const beside[] = {"lookfrom", "lookat",
                                                                                "focus_dist", "view_height"};
    const BpNode fit = bp_node_member(node, "fit");
    const BpNode view = bp_node_member(node, "view");
    const BpNode margin = bp_node_member(node, "margin");
    const BpNode vup = bp_node_member(node, "vup");
    if (fit.value == NULL) {
        for (size_t i = 0; i < BP_COUNT(without); i++) {
            const BpNode member = bp_node_member(node, without[i]);
            if (member.value != NULL)
                return bp_node_fail(&member, BP_PART_NAME, err,
                                    "found without \"fit\", expected \"fit\": \"scene\" beside it");
        }
        return BP_OK;
    }
    for (size_t i = 0; i < BP_COUNT(beside); i++) {
        const BpNode member = bp_node_member(node, beside[i]);
        if (member.value != NULL)
            return bp_node_fail(
                &member, BP_PART_NAME, err,
                "found beside \"fit\", which chooses it; expected one of the two: remove one");
    }
    const BpNode angle = bp_node_member(node, "defocus_angle");
    if (angle.value != NULL)
        return bp_node_fail(
            &angle, BP_PART_NAME, err,
            "found beside \"fit\", which chooses the distance in focus; expected \"aperture\" instead");
    int choice = 0;
    BP_TRY(bp_node_choice(&fit, fit_names + 1, BP_COUNT(fit_names) - 1, &choice, err));
    camera->fit = (BpFit)(choice + 1);
    camera->margin = BP_FIT_MARGIN;
    BP_TRY(bp_node_number(&margin, &camera->margin, err));
    if (!(camera->margin >= 0 && camera->margin <= 0.45))
        return bp_node_wrong(&margin,
                             "the share of the picture that is left free at each side, from 0 to 0.45", err);
    if (vup.value != NULL) memcpy(camera->fit_vup, camera->vup, sizeof camera->fit_vup);
    return read_view(&view, camera, err);
}

#define SAMPLING_WORDS(X) X(BP_PIXEL_SQUARE, "square") X(BP_PIXEL_CENTER, "center")
BP_WORDS(BpPixelSampling, static const char *const sampling_names, SAMPLING_WORDS);

BpStatus bp_parse_camera(const BpNode *node, BpCamera *camera, BpError *err) {
    static const char *const names[] = {"image_width",
                                        "image_height",
                                        "aspect_ratio",
                                        "samples_per_pixel",
                                        "max_depth",
                                        "vfov",
                                        "lookfrom",
                                        "lookat",
                                        "vup",
                                        "defocus_angle",
                                        "aperture",
                                        "focus_dist",
                                        "pixel_sampling",
                                        "fit",
                                        "view",
                                        "margin",
                                        "projection",
                                        "view_height"};
    bp_camera_defaults(camera);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(read_size(node, camera, err));
    const BpNode samples = bp_node_member(node, "samples_per_pixel");
    const BpNode depth = bp_node_member(node, "max_depth");
    const BpNode vfov = bp_node_member(node, "vfov");
    const BpNode lookfrom = bp_node_member(node, "lookfrom");
    const BpNode lookat = bp_node_member(node, "lookat");
    const BpNode vup = bp_node_member(node, "vup");
    const BpNode sampling = bp_node_member(node, "pixel_sampling");
    int choice = BP_PIXEL_SQUARE;
    BP_TRY(bp_node_integer(&samples, 1, UINT32_MAX, &camera->samples_per_pixel, err));
    BP_TRY(bp_node_integer(&depth, 0, BP_DEPTH_MAX, &camera->max_depth, err));
    BP_TRY(bp_node_number(&vfov, &camera->vfov_degrees, err));
    BP_TRY(bp_node_vector(&lookfrom, camera->lookfrom, err));
    BP_TRY(bp_node_vector(&lookat, camera->lookat, err));
    BP_TRY(bp_node_vector(&vup, camera->vup, err));
    BP_TRY(bp_node_choice(&sampling, sampling_names, BP_COUNT(sampling_names), &choice, err));
    camera->pixel_sampling = (BpPixelSampling)choice;
    BP_TRY(read_projection(node, camera, err));
    BP_TRY(read_fit(node, camera, err));
    return read_lens(node, camera, err);
}
