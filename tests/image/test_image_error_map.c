/* test_image_error_map.c: the error map's numbers, its colours and its legend (host/image/error_map.h). */
#include "support/output_temp.h"

#include "image/error_map.h"

#include <math.h>

/* Lightness L* of CIELAB (CIE 15:2004) of an sRGB colour. */
static double lightness(const uint8_t rgb[3]) {
    static const double weights[3] = {0.2126, 0.7152, 0.0722};
    double y = 0;
    for (int c = 0; c < 3; c++) {
        const double v = (rgb[c] + 0.5) / 256;
        y += weights[c] * (v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
    return y > 0.008856 ? 116 * cbrt(y) - 16 : 903.3 * y;
}

static bool is_gray(const uint8_t rgb[3]) {
    return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

static void lightness_rises_evenly(void **state) {
    (void)state;
    double last = 0, least = 100, most = 0;
    for (int i = 0; i <= 60; i++) {
        uint8_t rgb[3];
        bp_error_color(0.001 * pow(10, i / 20.0), rgb);
        assert_false(is_gray(rgb));
        const double l = lightness(rgb);
        if (i > 0) least = fmin(least, l - last);
        if (i > 0) most = fmax(most, l - last);
        last = l;
    }
    /* 85 / 60 = 1.42 a step */
    assert_true(least > 0.9);
    assert_true(most < 1.9);
}

static void the_ends_hold_what_lies_beyond(void **state) {
    (void)state;
    uint8_t end[3], beyond[3];
    bp_error_color(0.001, end);
    bp_error_color(0, beyond);
    assert_memory_equal(end, beyond, 3);
    bp_error_color(1e-300, beyond);
    assert_memory_equal(end, beyond, 3);
    bp_error_color(1, end);
    bp_error_color((double)INFINITY, beyond);
    assert_memory_equal(end, beyond, 3);
    bp_error_color((double)NAN, beyond);
    assert_true(is_gray(beyond));
}

static void relative_errors(void **state) {
    (void)state;
    float rgb[] = {1, 1, 1, 0, 2, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, -1, 0, 0};
    float error[] = {0.1f, 0.1f, 0.1f, 0, 0.5f, 0, 0, 0, 0, 0.1f, 0, 0, NAN, 0, 0, 1, 1, 1};
    const BpPicture picture = {.width = 6, .height = 1, .rgb = rgb, .error = error};
    assert_true(fabs(bp_pixel_relative_error(&picture, 0) - 0.1) < 1e-7);
    assert_true(fabs(bp_pixel_relative_error(&picture, 1) - 0.25) < 1e-7);
    assert_true(isnan(bp_pixel_relative_error(&picture, 2)));
    assert_true(isinf(bp_pixel_relative_error(&picture, 3)));
    assert_true(isnan(bp_pixel_relative_error(&picture, 4)));
    assert_true(isinf(bp_pixel_relative_error(&picture, 5)));
}

/* Two pixels' errors known, a third not, on a picture of the given size. */
static BpPicture make_picture(uint32_t width, uint32_t height) {
    const size_t count = (size_t)width * height;
    BpPicture picture = {
        .width = width, .height = height, .rgb = malloc(count * 12), .error = malloc(count * 12)};
    for (size_t i = 0; i < 3 * count; i++) {
        picture.rgb[i] = 0.5f;
        picture.error[i] = i / 3 % 3 == 0 ? 0.005f : i / 3 % 3 == 1 ? 0.05f : NAN;
    }
    return picture;
}

/* Every pixel has its colour at its place, whatever the enlargement. */
static void assert_map(uint32_t width, uint32_t height, uint32_t zoom) {
    BpPicture picture = make_picture(width, height);
    BpCanvas canvas;
    assert_int_equal(bp_error_map_draw(&picture, &canvas, NULL), BP_OK);
    assert_true(canvas.width >= width * zoom && canvas.height > height * zoom);
    const uint32_t left = (canvas.width - width * zoom) / 2;
    for (uint32_t y = 0; y < height * zoom; y++)
        for (uint32_t x = 0; x < width * zoom; x++) {
            uint8_t expected[3];
            bp_error_color(bp_pixel_relative_error(&picture, (size_t)(y / zoom) * width + x / zoom),
                           expected);
            assert_memory_equal(canvas.rgb + 3 * ((size_t)y * canvas.width + left + x), expected, 3);
        }
    free(canvas.rgb);
    bp_picture_clear(&picture);
}

static void pixels_stand_in_their_place(void **state) {
    (void)state;
    assert_map(400, 30, 1);
    assert_map(1000, 3, 1);
    assert_map(64, 36, 5);
    assert_map(1, 1, 360);
    assert_map(1, 1440, 1);
    assert_map(2, 700, 2);
    assert_map(90, 1, 4);
}

/* The legend has the scale's whole range of colours, and the letters do not run into each other. */
static void the_legend_shows_the_scale(void **state) {
    (void)state;
    BpPicture picture = make_picture(200, 100);
    BpCanvas canvas;
    assert_int_equal(bp_error_map_draw(&picture, &canvas, NULL), BP_OK);
    uint8_t darkest[3], brightest[3];
    bp_error_color(0, darkest);
    bp_error_color(1, brightest);
    bool found_darkest = false, found_brightest = false;
    const size_t legend = canvas.height - 46;
    for (size_t i = legend * canvas.width; i < (size_t)canvas.width * canvas.height; i++) {
        found_darkest = found_darkest || memcmp(canvas.rgb + 3 * i, darkest, 3) == 0;
        found_brightest = found_brightest || memcmp(canvas.rgb + 3 * i, brightest, 3) == 0;
    }
    assert_true(found_darkest && found_brightest);
    free(canvas.rgb);
    bp_picture_clear(&picture);
}

/* Where the picture tells the sky by its depth, the sky does not lower the median. */
static void the_median_is_of_spheres(void **state) {
    (void)state;
    BpPicture picture = make_picture(320, 10), even = make_picture(320, 10);
    BpCanvas all, spheres, expected;
    picture.depth = malloc(3200 * sizeof *picture.depth);
    even.depth = calloc(3200, sizeof *even.depth);
    for (size_t i = 0; i < 3200; i++) {
        const bool sky = i % 320 >= 100;
        picture.depth[i] = sky ? (float)INFINITY : 3;
        for (size_t c = 0; c < 3; c++) {
            picture.error[3 * i + c] = sky ? 0.005f : 0.05f;
            even.error[3 * i + c] = 0.05f;
        }
    }
    assert_int_equal(bp_error_map_draw(&picture, &spheres, NULL), BP_OK);
    free(picture.depth);
    picture.depth = NULL;
    assert_int_equal(bp_error_map_draw(&picture, &all, NULL), BP_OK);
    assert_int_equal(bp_error_map_draw(&even, &expected, NULL), BP_OK);
    /* The last line of the legend. */
    const size_t end = (size_t)3 * spheres.width * spheres.height, line = (size_t)3 * spheres.width * 14;
    assert_memory_equal(spheres.rgb + end - line, expected.rgb + end - line, line);
    assert_memory_not_equal(all.rgb + end - line, expected.rgb + end - line, line);
    free(all.rgb);
    free(spheres.rgb);
    free(expected.rgb);
    bp_picture_clear(&picture);
    bp_picture_clear(&even);
}

/* Without a depth, pixels without noise do not lower the median: one or most of them, it is the same. */
static void the_median_is_where_noise_is(void **state) {
    (void)state;
    BpPicture one = make_picture(320, 10), most = make_picture(320, 10);
    BpCanvas canvas, expected;
    for (size_t i = 0; i < 3 * 3200; i++) {
        one.error[i] = i < 3 ? 0 : 0.05f;
        most.error[i] = i % 960 >= 300 ? 0 : 0.05f;
    }
    assert_int_equal(bp_error_map_draw(&one, &expected, NULL), BP_OK);
    assert_int_equal(bp_error_map_draw(&most, &canvas, NULL), BP_OK);
    const size_t end = (size_t)3 * canvas.width * canvas.height, line = (size_t)3 * canvas.width * 14;
    assert_memory_equal(canvas.rgb + end - line, expected.rgb + end - line, line);
    free(canvas.rgb);
    /* Where no pixel has any, that is what it says. */
    memset(most.error, 0, 3 * 3200 * sizeof *most.error);
    assert_int_equal(bp_error_map_draw(&most, &canvas, NULL), BP_OK);
    assert_memory_not_equal(canvas.rgb + end - line, expected.rgb + end - line, line);
    free(canvas.rgb);
    free(expected.rgb);
    bp_picture_clear(&one);
    bp_picture_clear(&most);
}

static void every_letter_has_its_own_shape(void **state) {
    (void)state;
    static const char letters[] = "0123456789.,%<=>()[]*/+-^_abcdefghijklmnopqrstuvwxyz";
    uint8_t pixels[sizeof letters][12 * 16 * 3];
    static const uint8_t white[3] = {255, 255, 255};
    for (size_t i = 0; i < sizeof letters; i++) { /* the last one is no letter: a gap */
        memset(pixels[i], 0, sizeof pixels[i]);
        BpCanvas canvas = {12, 16, pixels[i]};
        const char text[2] = {letters[i], '\0'};
        bp_canvas_text(&canvas, 0, 0, 2, text, white);
        for (size_t j = 0; j < i; j++) assert_memory_not_equal(pixels[i], pixels[j], sizeof pixels[i]);
    }
    assert_int_equal(bp_text_width("", 2), 0);
    assert_int_equal(bp_text_width("a", 2), 10);
    assert_int_equal(bp_text_width("ab", 1), 11);
}

static void drawing_stays_on_the_canvas(void **state) {
    (void)state;
    uint8_t pixels[3 * 4 * 3 + 3] = {0};
    static const uint8_t white[3] = {255, 255, 255};
    BpCanvas canvas = {4, 3, pixels};
    bp_canvas_fill(&canvas, 2, 1, UINT32_MAX, UINT32_MAX, white);
    bp_canvas_text(&canvas, 3, 0, 3, "88", white);
    assert_int_equal(pixels[3 * 12], 0);
    assert_int_equal(pixels[3 * (1 * 4 + 1)], 0);
    assert_int_equal(pixels[3 * (1 * 4 + 2)], 255);
}

static void files(void **state) {
    (void)state;
    char folder[64], path[512];
    temp_make(folder);
    BpPicture picture = make_picture(20, 10);
    BpError err = {0};
    assert_int_equal(bp_error_map_write(&picture, temp_path(path, folder, "e.png"), &err), BP_OK);
    uint8_t *bytes = temp_read(path, NULL);
    assert_memory_equal(bytes, "\x89PNG\r\n\x1a\n", 8);
    free(bytes);
    assert_int_equal(temp_count(folder), 1);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(bp_error_map_write(&picture, "/dev/full", &err), BP_ERR_FILE);
        assert_non_null(strstr(err.message, "No space left"));
    }
    free(picture.error);
    picture.error = NULL;
    assert_int_equal(bp_error_map_write(&picture, path, &err), BP_ERR_USAGE);
    bp_picture_clear(&picture);
    temp_remove(folder);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lightness_rises_evenly),
        cmocka_unit_test(the_ends_hold_what_lies_beyond),
        cmocka_unit_test(relative_errors),
        cmocka_unit_test(pixels_stand_in_their_place),
        cmocka_unit_test(the_legend_shows_the_scale),
        cmocka_unit_test(the_median_is_of_spheres),
        cmocka_unit_test(the_median_is_where_noise_is),
        cmocka_unit_test(every_letter_has_its_own_shape),
        cmocka_unit_test(drawing_stays_on_the_canvas),
        cmocka_unit_test(files),
    };
    return cmocka_run_group_tests_name("image_error_map", tests, NULL, NULL);
}
