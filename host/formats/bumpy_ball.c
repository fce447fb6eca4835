/* bumpy_ball.c: see bumpy_ball.h. */
#include "bumpy_ball.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { SIDES = 20 };

typedef struct Vertex {
    double at[3]; /* on the unit sphere */
} Vertex;

typedef struct Printer {
    FILE *stream;
    const char *material;
    uint64_t left; /* triangles that follow */
} Printer;

bool bp_ball_has(uint64_t triangles) {
    uint64_t count = SIDES;
    while (count < triangles && count < BP_BALL_TRIANGLES_MAX) count *= 4;
    return count == triangles;
}

static Vertex on_sphere(double x, double y, double z) {
    const double length = sqrt(x * x + y * y + z * z);
    return (Vertex){{x / length, y / length, z / length}};
}

/* The same for the two triangles of an edge, whichever end comes first. */
static Vertex between(const Vertex *a, const Vertex *b) {
    return on_sphere(a->at[0] + b->at[0], a->at[1] + b->at[1], a->at[2] + b->at[2]);
}

static void print_vertex(const Printer *printer, const Vertex *vertex, const char *end) {
    const double *p = vertex->at;
    const double size = 1 + 0.15 * sin(9 * p[0]) * sin(11 * p[1]) * sin(10 * p[2]) +
                        0.05 * sin(41 * p[0] + 3 * p[1]) * sin(37 * p[2]);
    fprintf(printer->stream, "[%.9g,%.9g,%.9g]%s", (double)(float)(p[0] * size), (double)(float)(p[1] * size),
            (double)(float)(p[2] * size), end);
}

static void print_side(Printer *printer, const Vertex *a, const Vertex *b, const Vertex *c, uint64_t count) {
    if (count == 1) {
        fputs("{\"vertices\":[", printer->stream);
        print_vertex(printer, a, ",");
        print_vertex(printer, b, ",");
        print_vertex(printer, c, "]");
        fprintf(printer->stream, ",\"material\":\"%s\"}%s\n", printer->material,
                --printer->left > 0 ? "," : "");
        return;
    }
    const Vertex ab = between(a, b), bc = between(b, c), ca = between(c, a);
    print_side(printer, a, &ab, &ca, count / 4);
    print_side(printer, &ab, b, &bc, count / 4);
    print_side(printer, &ca, &bc, c, count / 4);
    print_side(printer, &ab, &bc, &ca, count / 4);
}

BpStatus bp_ball_print(uint64_t triangles, const char *material, FILE *stream, BpError *err) {
    static const int sides[SIDES][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    if (!bp_ball_has(triangles))
        return bp_fail(err, BP_ERR_USAGE, "found %" PRIu64 " triangles, expected 20, 80, 320, ... up to %u",
                       triangles, BP_BALL_TRIANGLES_MAX);
    const double g = (1 + sqrt(5.0)) / 2;
    const Vertex corners[12] = {on_sphere(-1, g, 0),  on_sphere(1, g, 0),   on_sphere(-1, -g, 0),
                                on_sphere(1, -g, 0),  on_sphere(0, -1, g),  on_sphere(0, 1, g),
                                on_sphere(0, -1, -g), on_sphere(0, 1, -g),  on_sphere(g, 0, -1),
                                on_sphere(g, 0, 1),   on_sphere(-g, 0, -1), on_sphere(-g, 0, 1)};
    Printer printer = {stream, material, triangles};
    for (int s = 0; s < SIDES; s++)
        print_side(&printer, &corners[sides[s][0]], &corners[sides[s][1]], &corners[sides[s][2]],
                   triangles / SIDES);
    if (ferror(stream))
        return bp_fail(err, BP_ERR_FILE, "cannot write %" PRIu64 " triangles: %s", triangles,
                       strerror(errno));
    return BP_OK;
}
