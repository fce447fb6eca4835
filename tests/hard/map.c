/* map.c: draws where each form of the intersection is right and where it fails, as PNG.
 *
 *     numerics_map FOLDER
 *
 * In:    a folder.   Out: map-error.png, map-wrong.png, map-grazing.png, map-leaving.png,
 * map-capsule-error.png, map-capsule-wrong.png in it. Each picture has one field for each form: of spheres
 * the book's quadratic in float, the form of Ray Tracing Gems in float, ours in float, ours in double; of
 * capsules the closed form in float, --numerics plain, and ours. A square is one pair of sizes, its colour
 * the worst it does there. */
#include "map.h"

#include "cases.h"

#include "image/image.h"
#include "image/text.h"
#include "oracle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const of_spheres[FORMS] = {"book", "ray tracing gems", "ours in float", "ours in double"};

/* From white over yellow and red to black. */
static void shade(double share, uint8_t color[3]) {
    static const double stops[5][3] = {
        {232, 245, 233}, {255, 235, 120}, {240, 130, 50}, {190, 20, 40}, {50, 0, 30}};
    const double at = share <= 0 ? 0 : share >= 1 ? 3.999 : share * 4;
    const int low = (int)at;
    for (int c = 0; c < 3; ++c)
        color[c] = (uint8_t)(stops[low][c] + (at - low) * (stops[low + 1][c] - stops[low][c]));
}

/* bp_canvas_text with a minus sign, which its letters lack. */
static void draw_text(BpCanvas *canvas, uint32_t x, uint32_t y, uint32_t scale, const char *text) {
    static const uint8_t black[3] = {0, 0, 0};
    bp_canvas_text(canvas, x, y, scale, text, black);
    for (uint32_t i = 0; text[i] != '\0'; ++i)
        if (text[i] == '-')
            bp_canvas_fill(canvas, x + i * BP_TEXT_ADVANCE * scale, y + 3 * scale, 4 * scale, scale, black);
}

static void draw_axis_number(BpCanvas *canvas, uint32_t x, uint32_t y, int exponent) {
    char text[16];
    snprintf(text, sizeof text, "%d", exponent);
    draw_text(canvas, x, y, 1, text);
}

void map_draw(const Atlas *atlas, const Map *map) {
    static const uint8_t white[3] = {255, 255, 255}, grey[3] = {200, 200, 200};
    const uint32_t field = SIDE * SQUARE;
    BpCanvas canvas = {.width = LEFT + FORMS * (field + GAP), .height = TOP + field + BOTTOM};
    canvas.rgb = calloc((size_t)canvas.width * canvas.height, 3);
    BpPicture picture = {.width = canvas.width, .height = canvas.height};
    picture.rgb = calloc((size_t)canvas.width * canvas.height * 3, sizeof *picture.rgb);
    if (canvas.rgb == NULL || picture.rgb == NULL) abort();
    bp_canvas_fill(&canvas, 0, 0, canvas.width, canvas.height, white);
    draw_text(&canvas, LEFT, 8, 2, map->title);
    for (uint32_t f = 0; f < FORMS; ++f) {
        const uint32_t left = LEFT + f * (field + GAP);
        draw_text(&canvas, left, 36, 2, (map->forms != NULL ? map->forms : of_spheres)[f]);
        for (uint32_t row = 0; row < SIDE; ++row)
            for (uint32_t column = 0; column < SIDE; ++column) {
                uint8_t color[3];
                const double value = map->value[f][row][column];
                shade((log10(fmax(value, 1e-30)) - map->low) / (map->high - map->low), color);
                bp_canvas_fill(&canvas, left + column * SQUARE, TOP + (SIDE - 1 - row) * SQUARE, SQUARE - 1,
                               SQUARE - 1, isnan(value) ? grey : color);
            }
        for (int k = 0; k < SIDE; k += 3) {
            draw_axis_number(&canvas, left + (uint32_t)k * SQUARE + 2, TOP + field + 4, map->column_low + k);
            if (f == 0)
                draw_axis_number(&canvas, LEFT - 16, TOP + field - (uint32_t)k * SQUARE - 12,
                                 map->row_low + k);
        }
        draw_text(&canvas, left, TOP + field + 16, 1, map->across);
    }
    draw_text(&canvas, 2, TOP - 10, 1, map->up);
    draw_text(&canvas, LEFT, TOP + field + 38, 1, map->best);
    const uint32_t scale = LEFT + bp_text_width(map->best, 1) + 10;
    for (uint32_t k = 0; k < 160; ++k) {
        uint8_t color[3];
        shade(k / 160.0, color);
        bp_canvas_fill(&canvas, scale + k, TOP + field + 34, 1, 16, color);
    }
    draw_text(&canvas, scale + 170, TOP + field + 38, 1, map->worst);
    for (size_t i = 0; i < (size_t)canvas.width * canvas.height * 3; ++i)
        picture.rgb[i] = ((float)canvas.rgb[i] + 0.5f) / 256.0f;
    char path[1024];
    BpError err = {0};
    snprintf(path, sizeof path, "%s/%s", atlas->folder, map->file);
    if (bp_picture_write(&picture, path, BP_FORMAT_PNG, BP_TRANSFER_LINEAR, &err) != BP_OK) {
        fprintf(stderr, "%s\n", err.message);
        exit(1);
    }
    free(canvas.rgb);
    free(picture.rgb);
    printf("%s\n", path);
}

static void run_form(Atlas *atlas, int form, float t_min, Cases *cases, const uint32_t *own) {
    if (form < 2)
        cases_host(form == 0 ? FORM_BOOK : FORM_GEMS, t_min, cases);
    else
        cases_run(&atlas->labs[form - 2], cases, own);
}

/* Radius across, distance up: error of t, and wrong answers outside 1 % of the rim. */
static void map_sizes(Atlas *atlas) {
    Map error = {.file = "map-error.png",
                 .title = "relative error of t   worst of 600 rays within 0.9 r",
                 .across = "log10 of the radius",
                 .up = "log10 of the distance",
                 .best = "1e-7",
                 .worst = "1e-1",
                 .column_low = -3,
                 .row_low = -3,
                 .low = -7,
                 .high = -1};
    Map wrong = error;
    wrong.file = "map-wrong.png";
    wrong.title = "wrong hits and misses 1 % off the rim or more";
    wrong.best = "none of 600";
    wrong.worst = "half of them";
    wrong.low = -3.2;
    wrong.high = -0.3;
    Cases cases;
    cases_init(&cases, (size_t)SIDE * SIDE * EACH);
    uint64_t random = 1;
    for (size_t row = 0; row < SIDE; ++row)
        for (size_t column = 0; column < SIDE; ++column) {
            const Cell cell = {.radius = pow(10, -3 + (double)column),
                               .distance = pow(10, -3 + (double)row),
                               .impact_high = 1.5};
            cases_aim(&cases, (row * SIDE + column) * EACH, EACH, &cell, &random);
        }
    for (int form = 0; form < FORMS; ++form) {
        run_form(atlas, form, 0, &cases, NULL);
        for (size_t row = 0; row < SIDE; ++row)
            for (size_t column = 0; column < SIDE; ++column) {
                const Score score = cases_score(&cases, (row * SIDE + column) * EACH, EACH, 1e-2);
                error.value[form][row][column] = score.worst_t > 0 ? score.worst_t : NAN;
                if (form >= 2 && score.right_hits > 0 && score.worst_t <= 0)
                    error.value[form][row][column] = 1e-30;
                wrong.value[form][row][column] = (double)(score.false_hits + score.false_misses) / EACH;
            }
    }
    /* Where no ray starts 5e-7 r off the surface or more, there is no error to judge, in any form. */
    map_draw(atlas, &error);
    map_draw(atlas, &wrong);
    cases_clear(&cases);
}

/* Distance in radii across, distance from the rim up, radius 1. */
static void map_grazing(Atlas *atlas) {
    Map map = {.file = "map-grazing.png",
               .title = "wrong hits and misses by how near the rim",
               .across = "log10 of distance over radius",
               .up = "log10 of distance from the rim over radius",
               .best = "none of 600",
               .worst = "half of them",
               .column_low = -2,
               .row_low = -9,
               .low = -3.2,
               .high = -0.3};
    Cases cases;
    cases_init(&cases, (size_t)SIDE * SIDE * EACH);
    uint64_t random = 2;
    for (size_t row = 0; row < SIDE; ++row)
        for (size_t column = 0; column < SIDE; ++column) {
            const double off = pow(10, -9 + (double)row);
            const Cell inner = {.radius = 1,
                                .distance = pow(10, -2 + (double)column),
                                .impact_low = 1 - 3 * off,
                                .impact_high = 1 + 3 * off};
            cases_aim(&cases, (row * SIDE + column) * EACH, EACH, &inner, &random);
        }
    for (int form = 0; form < FORMS; ++form) {
        run_form(atlas, form, 0, &cases, NULL);
        for (size_t row = 0; row < SIDE; ++row)
            for (size_t column = 0; column < SIDE; ++column) {
                /* Of the rays aimed there, those that floats let pass there. */
                const double off = pow(10, -9 + (double)row);
                size_t rays = 0, wrong = 0;
                for (size_t i = 0; i < EACH; ++i) {
                    const size_t k = (row * SIDE + column) * EACH + i;
                    const Exact exact = exact_roots(cases.rays + k * RAY_REALS, cases.spheres + k * 4);
                    const double away = fabs(exact.impact - 1);
                    if (away < off / 3 || away > 3 * off) continue;
                    ++rays;
                    wrong += (exact.meets && exact.middle > 0) != (cases.hits[k * HIT_REALS + HIT_MET] != 0);
                }
                map.value[form][row][column] = rays < 10 ? NAN : (double)wrong / (double)rays;
            }
    }
    map_draw(atlas, &map);
    cases_clear(&cases);
}

/* Radius across, translation up: rays that leave a sphere outward and meet it, or inward and do not. */
static void map_leaving(Atlas *atlas) {
    Map map = {.file = "map-leaving.png",
               .title = "leaving a surface   met again or far side missed",
               .across = "log10 of the radius",
               .up = "log10 of the distance from the origin",
               .best = "none of 600",
               .worst = "half of them",
               .column_low = -3,
               .row_low = -3,
               .low = -3.2,
               .high = -0.3};
    Cases cases, left;
    const size_t count = (size_t)SIDE * SIDE * EACH;
    cases_init(&cases, count);
    cases_init(&left, count);
    double *points = calloc(count * POINT_REALS, sizeof *points);
    uint32_t *own = calloc(count, sizeof *own);
    if (points == NULL || own == NULL) abort();
    uint64_t random = 3;
    for (size_t row = 0; row < SIDE; ++row)
        for (size_t column = 0; column < SIDE; ++column) {
            const double radius = pow(10, -3 + (double)column);
            const Cell cell = {.radius = radius,
                               .distance = 3 * radius,
                               .translation = pow(10, -3 + (double)row),
                               .impact_high = 0.95};
            cases_aim(&cases, (row * SIDE + column) * EACH, EACH, &cell, &random);
        }
    for (int form = 0; form < FORMS; ++form) {
        Lab *lab = &atlas->labs[form < 2 ? 1 : form - 2];
        cases_run(lab, &cases, NULL);
        const LabArgument arguments[] = {{LAB_REALS, cases.rays, count * RAY_REALS},
                                         {LAB_REALS, cases.spheres, count * 4},
                                         {LAB_REFINED, cases.hits, count * HIT_REALS},
                                         {LAB_OUT_REFINED, points, count * POINT_REALS}};
        lab_run(lab, "probe_point", count, arguments, 4, NULL);
        uint64_t turn = 4;
        for (size_t i = 0; i < count; ++i) {
            const double *normal = points + i * POINT_REALS + POINT_NORMAL;
            double *ray = left.rays + i * RAY_REALS;
            memcpy(ray, points + i * POINT_REALS, 7 * sizeof *ray);
            ray[RAY_SLACK] = points[i * POINT_REALS + POINT_SLACK];
            memcpy(left.spheres + i * 4, cases.spheres + i * 4, 4 * sizeof(double));
            lab_direction(&turn, ray + RAY_DIRECTION);
            const double sign = (lab_dot(ray + RAY_DIRECTION, normal) > 0) == (i % 2 == 0) ? 1 : -1;
            for (int a = 0; a < 3; ++a) ray[RAY_DIRECTION + a] *= sign;
            lab_float_unit(ray + RAY_DIRECTION);
            own[i] = i % 2 == 0 ? 1 : 2;
        }
        run_form(atlas, form, 1e-3f, &left, own);
        for (size_t cell = 0; cell < (size_t)SIDE * SIDE; ++cell) {
            size_t wrong = 0, rays = 0;
            for (size_t i = cell * EACH; i < (cell + 1) * EACH; ++i) {
                if (cases.hits[i * HIT_REALS + HIT_MET] == 0) continue;
                ++rays;
                wrong += (left.hits[i * HIT_REALS + HIT_MET] != 0) != (own[i] == 2);
            }
            map.value[form][cell / SIDE][cell % SIDE] = rays < 10 ? NAN : (double)wrong / (double)rays;
        }
    }
    map_draw(atlas, &map);
    free(points);
    free(own);
    cases_clear(&cases);
    cases_clear(&left);
}

int main(int argc, char **argv) {
    Atlas atlas;
    if (argc != 2) {
        fprintf(stderr, "usage: numerics_map FOLDER\n");
        return 2;
    }
    atlas.folder = argv[1];
    if (!lab_open(&atlas.labs[0], "float") || !lab_open(&atlas.labs[1], "double") ||
        !lab_open(&atlas.plain, "plain"))
        return 77;
    map_sizes(&atlas);
    map_grazing(&atlas);
    map_leaving(&atlas);
    map_capsules(&atlas);
    lab_close(&atlas.labs[0]);
    lab_close(&atlas.labs[1]);
    lab_close(&atlas.plain);
    return 0;
}
