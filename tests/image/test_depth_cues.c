/* test_depth_cues.c: outlines and depth fog on pictures whose depths are known (host/image/depth_cues.h). */
#include "support/output_temp.h"

#include "image/depth_cues.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 64, PIXELS = SIDE * SIDE };

/* A picture of 0.5, all of it background. */
static BpPicture blank(bool alpha) {
    BpPicture picture = {.width = SIDE, .height = SIDE};
    picture.rgb = malloc(3 * PIXELS * sizeof *picture.rgb);
    picture.depth = malloc(PIXELS * sizeof *picture.depth);
    picture.normal = calloc(3 * PIXELS, sizeof *picture.normal);
    if (alpha) picture.alpha = calloc(PIXELS, sizeof *picture.alpha);
    for (size_t i = 0; i < PIXELS; i++) {
        picture.depth[i] = INFINITY;
        for (int c = 0; c < 3; c++) picture.rgb[3 * i + (size_t)c] = alpha ? 0 : 0.5f;
    }
    return picture;
}

/* What a pixel shows, of which things cover `share`. */
static void put(BpPicture *picture, int x, int y, double depth, double share, float value) {
    const size_t i = (size_t)(y * SIDE + x);
    picture->depth[i] = (float)depth;
    picture->normal[3 * i + 2] = (float)share;
    if (picture->alpha != NULL) picture->alpha[i] = (float)share;
    const float behind = picture->alpha != NULL ? 0 : 0.5f;
    for (int c = 0; c < 3; c++)
        picture->rgb[3 * i + (size_t)c] = (float)share * value + (1 - (float)share) * behind;
}

static void put_rectangle(BpPicture *picture, int x, int y, int width, int height, double depth,
                          float value) {
    for (int j = y; j < y + height; j++)
        for (int i = x; i < x + width; i++) put(picture, i, j, depth, 1, value);
}

static float shown(const BpPicture *picture, int x, int y) {
    return picture->rgb[3 * (y * SIDE + x)];
}

static void draw(BpPicture *picture, double outlines, double fog) {
    const BpDepthCues cues = {outlines, fog, {0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
    assert_int_equal(bp_depth_cues_draw(picture, &cues, NULL), BP_OK);
}

static void is_near(double found, double wanted, double within) {
    if (!(fabs(found - wanted) <= within)) fail_msg("%g, not %g", found, wanted);
}

static void lines_lie_around_what_is_nearer(void **state) {
    (void)state;
    BpPicture picture = blank(false);
    put_rectangle(&picture, 10, 10, 40, 40, 3, 0.8f);
    put_rectangle(&picture, 20, 20, 10, 10, 2, 0.7f);
    draw(&picture, 1.5, 0);
    is_near((double)shown(&picture, 24, 24), 0.7, 1e-6); /* the nearer thing, up to its edge */
    is_near((double)shown(&picture, 20, 24), 0.7, 1e-6);
    is_near((double)shown(&picture, 29, 29), 0.7, 1e-6);
    is_near((double)shown(&picture, 19, 24), 0, 1e-6); /* a pixel and a half on the farther one */
    is_near((double)shown(&picture, 18, 24), 0.4, 1e-6);
    is_near((double)shown(&picture, 17, 24), 0.8, 1e-6);
    is_near((double)shown(&picture, 30, 24), 0, 1e-6);
    is_near((double)shown(&picture, 24, 19), 0, 1e-6);
    is_near((double)shown(&picture, 24, 30), 0, 1e-6);
    is_near((double)shown(&picture, 10, 40), 0.8, 1e-6); /* the farther thing's own edge, and its line */
    is_near((double)shown(&picture, 9, 40), 0, 1e-6);
    is_near((double)shown(&picture, 8, 40), 0.25, 1e-6);
    is_near((double)shown(&picture, 7, 40), 0.5, 1e-6);
    bp_picture_clear(&picture);
}

/* The depth of spheres falls without bound towards their limbs, of large ones and of small ones. */
static void limbs_of_spheres_are_no_edges(void **state) {
    (void)state;
    for (double radius = 3; radius < 31; radius += 0.7) {
        BpPicture picture = blank(false);
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                const double square = (x - 31.3) * (x - 31.3) + (y - 32.1) * (y - 32.1);
                if (square < radius * radius)
                    put(&picture, x, y, 100 - sqrt(radius * radius - square), 1, 0.8f);
            }
        draw(&picture, 1, 0);
        int dark = 0;
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++) {
                if (isfinite((double)picture.depth[y * SIDE + x]))
                    is_near((double)shown(&picture, x, y), 0.8, 1e-6);
                dark += shown(&picture, x, y) < 0.01f;
            }
        assert_true(dark > 4 * radius); /* the line is there */
        bp_picture_clear(&picture);
    }
}

static void small_steps_are_no_edges(void **state) {
    (void)state;
    BpPicture picture = blank(false);
    put_rectangle(&picture, 0, 0, SIDE, 20, 1, 0.8f);
    put_rectangle(&picture, 0, 20, SIDE, 20, 1.02, 0.8f); /* 2 % of what is seen */
    put_rectangle(&picture, 0, 40, SIDE, 24, 2, 0.8f);
    draw(&picture, 1, 0);
    is_near((double)shown(&picture, 9, 20), 0.8, 1e-6);
    is_near((double)shown(&picture, 9, 40), 0, 1e-6);
    bp_picture_clear(&picture);
}

/* A pixel that a thing covers in part leaves no seam of background between thing and line. */
static void edges_leave_no_seam(void **state) {
    (void)state;
    for (int alpha = 0; alpha < 2; alpha++) {
        BpPicture picture = blank(alpha == 1);
        put_rectangle(&picture, 20, 20, 10, 10, 2, 0.8f);
        for (int y = 20; y < 30; y++) put(&picture, 30, y, 2, 0.25, 0.8f);
        draw(&picture, 2, 0);
        is_near((double)shown(&picture, 29, 24), 0.8, 1e-6);
        is_near((double)shown(&picture, 30, 24), 0.25 * (0.25 * 0.8 + 0.75 * (alpha ? 0 : 0.5)), 1e-6);
        is_near((double)shown(&picture, 31, 24), 0, 1e-6);
        if (alpha) {
            is_near((double)picture.alpha[24 * SIDE + 30], 0.75 + 0.25 * 0.25, 1e-6);
            is_near((double)picture.alpha[24 * SIDE + 31], 1, 1e-6);
            is_near((double)picture.alpha[24 * SIDE + 40], 0, 1e-6);
        }
        bp_picture_clear(&picture);
    }
}

static void far_things_fade_into_the_backdrop(void **state) {
    (void)state;
    BpPicture picture = blank(false);
    const BpDepthCues cues = {0, 0.6, {0.2, 0.2, 0.2}, {1, 1, 1}};
    put_rectangle(&picture, 0, 10, 10, 10, 5, 0.8f);
    put_rectangle(&picture, 10, 10, 10, 10, 6, 0.8f);
    put_rectangle(&picture, 20, 10, 10, 10, 7, 0.8f);
    assert_int_equal(bp_depth_cues_draw(&picture, &cues, NULL), BP_OK);
    const double behind = 0.2 + (1 - 12.5 / SIDE) * 0.8; /* in row 12 */
    is_near((double)shown(&picture, 5, 12), 0.8, 1e-6);
    is_near((double)shown(&picture, 15, 12), 0.7 * 0.8 + 0.3 * behind, 1e-6);
    is_near((double)shown(&picture, 25, 12), 0.4 * 0.8 + 0.6 * behind, 1e-6);
    is_near((double)shown(&picture, 50, 50), 0.5, 1e-6);
    bp_picture_clear(&picture);

    picture = blank(true);
    put_rectangle(&picture, 0, 10, 10, 10, 5, 0.8f);
    put_rectangle(&picture, 20, 10, 10, 10, 7, 0.8f);
    draw(&picture, 0, 0.6);
    is_near((double)shown(&picture, 5, 12), 0.8, 1e-6);
    is_near((double)shown(&picture, 25, 12), 0.4 * 0.8, 1e-6); /* premultiplied */
    is_near((double)picture.alpha[12 * SIDE + 5], 1, 1e-6);
    is_near((double)picture.alpha[12 * SIDE + 25], 0.4, 1e-6);
    bp_picture_clear(&picture);
}

static void lines_fade_with_their_thing(void **state) {
    (void)state;
    BpPicture picture = blank(false);
    put_rectangle(&picture, 5, 5, 10, 10, 1, 0.8f);
    put_rectangle(&picture, 40, 40, 10, 10, 3, 0.8f);
    draw(&picture, 1, 0.7);
    is_near((double)shown(&picture, 4, 9), 0, 1e-6);
    is_near((double)shown(&picture, 39, 45), 0.7 * 0.5, 1e-6);
    bp_picture_clear(&picture);
}

static void nothing_to_draw_changes_nothing(void **state) {
    (void)state;
    BpPicture picture = blank(false);
    draw(&picture, 3, 0.5); /* background alone */
    for (size_t i = 0; i < 3 * PIXELS; i++) assert_true(picture.rgb[i] == 0.5f);
    put_rectangle(&picture, 0, 0, SIDE, SIDE, 2, 0.75f);
    draw(&picture, 3, 0.5); /* all of it equally far */
    for (size_t i = 0; i < 3 * PIXELS; i++) assert_true(picture.rgb[i] == 0.75f);
    free(picture.depth);
    picture.depth = NULL;
    BpError err = {0};
    const BpDepthCues cues = {.outlines = 1};
    assert_int_equal(bp_depth_cues_draw(&picture, &cues, &err), BP_ERR_USAGE);
    assert_non_null(strstr(err.message, "depth"));
    bp_picture_clear(&picture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_lie_around_what_is_nearer),   cmocka_unit_test(limbs_of_spheres_are_no_edges),
        cmocka_unit_test(small_steps_are_no_edges),          cmocka_unit_test(edges_leave_no_seam),
        cmocka_unit_test(far_things_fade_into_the_backdrop), cmocka_unit_test(lines_fade_with_their_thing),
        cmocka_unit_test(nothing_to_draw_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
