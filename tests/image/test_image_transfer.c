/* test_image_transfer.c: the arithmetic from radiance to bytes, and the book's ramps (host/image/image.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void special_values(void **state) {
    (void)state;
    static const struct {
        double linear;
        int gamma2, srgb, linear_byte;
    } cases[] = {
        {-0.1, 0, 0, 0},           {-INFINITY, 0, 0, 0}, {-0.0, 0, 0, 0},      {0, 0, 0, 0},
        {0.001, 8, 3, 0},          {0.25, 128, 137, 64}, {0.5, 181, 188, 128}, {0.998, 255, 255, 255},
        {0.999, 255, 255, 255},    {1, 255, 255, 255},   {2, 255, 255, 255},   {1e300, 255, 255, 255},
        {INFINITY, 255, 255, 255}, {NAN, 0, 0, 0},       {-NAN, 0, 0, 0},      {5e-324, 0, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(bp_transfer_byte(cases[i].linear, BP_TRANSFER_GAMMA2), cases[i].gamma2);
        assert_int_equal(bp_transfer_byte(cases[i].linear, BP_TRANSFER_SRGB), cases[i].srgb);
        assert_int_equal(bp_transfer_byte(cases[i].linear, BP_TRANSFER_LINEAR), cases[i].linear_byte);
    }
}

/* Every byte begins exactly at its 256th; the square of it under gamma 2. */
static void steps_are_where_they_belong(void **state) {
    (void)state;
    for (int byte = 1; byte < 256; byte++) {
        const double start = byte / 256.0;
        assert_int_equal(bp_transfer_byte(start, BP_TRANSFER_LINEAR), byte);
        assert_int_equal(bp_transfer_byte(nextafter(start, 0), BP_TRANSFER_LINEAR), byte - 1);
        assert_int_equal(bp_transfer_byte(start * start, BP_TRANSFER_GAMMA2), byte);
        assert_int_equal(bp_transfer_byte(start * start * (1 - 1e-12), BP_TRANSFER_GAMMA2), byte - 1);
    }
}

static void curves_never_fall(void **state) {
    (void)state;
    for (int transfer = BP_TRANSFER_GAMMA2; transfer <= BP_TRANSFER_LINEAR; transfer++) {
        int last = 0;
        for (int i = -100; i <= 110000; i++) {
            const int byte = bp_transfer_byte(i * 1e-5, (BpTransfer)transfer);
            assert_in_range(byte, last, last + 4);
            last = byte;
        }
        assert_int_equal(last, 255);
    }
}

/* The ramp pictures of the three editions: red to the right, green up or down, blue constant. */
typedef struct Ramp {
    uint32_t width, height;
    double divisor; /* of the red: width, or width - 1 */
    double first_green, blue;
} Ramp;

static void assert_first_lines(const Ramp *ramp, const char *expected) {
    const size_t pixels = (size_t)ramp->width * ramp->height;
    BpPicture picture = {
        .width = ramp->width, .height = ramp->height, .rgb = calloc(pixels * 3, sizeof(float))};
    for (uint32_t i = 0; i < ramp->width; i++) {
        picture.rgb[3 * i] = (float)(i / ramp->divisor);
        picture.rgb[3 * i + 1] = (float)ramp->first_green;
        picture.rgb[3 * i + 2] = (float)ramp->blue;
    }
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(bp_picture_write_stream(&picture, out, BP_FORMAT_PPM_ASCII, BP_TRANSFER_LINEAR, NULL),
                     BP_OK);
    fclose(out);
    text[strlen(expected)] = '\0';
    assert_string_equal(text, expected);
    free(text);
    bp_picture_clear(&picture);
}

static void first_edition_ramp(void **state) {
    (void)state;
    /* j runs down from 99, g = j / 100 */
    const Ramp ramp = {200, 100, 200, 0.99, 0.2};
    assert_first_lines(&ramp, "P3\n200 100\n255\n0 253 51\n1 253 51\n2 253 51\n");
}

/* The third edition's ramp prints a blue of 63: it multiplies by 255.999 there, and by 256 from its chapter
 * on antialiasing on. The writer is the later one, and has 64. */
static void third_edition_ramp(void **state) {
    (void)state;
    assert_int_equal((int)(255.999 * 0.25), 63);
    const Ramp ramp = {256, 256, 255, 1, 0.25};
    assert_first_lines(&ramp, "P3\n256 256\n255\n0 255 64\n1 255 64\n2 255 64\n");
}

static void fourth_edition_ramp(void **state) {
    (void)state;
    const Ramp ramp = {256, 256, 255, 0, 0};
    assert_first_lines(&ramp, "P3\n256 256\n255\n0 0 0\n1 0 0\n2 0 0\n");
}

/* The first edition multiplies by 255.99: of uniform values one in two hundred gets another byte. */
static void first_edition_bytes_differ_in_half_a_percent(void **state) {
    (void)state;
    int different = 0;
    const int count = 1000000;
    for (int i = 0; i < count; i++) {
        const double value = (i + 0.5) / count;
        different += bp_transfer_byte(value, BP_TRANSFER_LINEAR) != (int)(255.99 * value);
    }
    assert_in_range(different, 4500, 5500);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(special_values),
        cmocka_unit_test(steps_are_where_they_belong),
        cmocka_unit_test(curves_never_fall),
        cmocka_unit_test(first_edition_ramp),
        cmocka_unit_test(third_edition_ramp),
        cmocka_unit_test(fourth_edition_ramp),
        cmocka_unit_test(first_edition_bytes_differ_in_half_a_percent),
    };
    return cmocka_run_group_tests_name("image_transfer", tests, NULL, NULL);
}
