/* placement.c: see placement.h. */
#include "placement.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

static void turn(double degrees, double *sine, double *cosine) {
    const double quarters = degrees / 90;
    *sine = sin(degrees * (PI / 180));
    *cosine = cos(degrees * (PI / 180));
    if (quarters != floor(quarters)) return;
    *sine = round(*sine);
    *cosine = round(*cosine);
}

BpPlacement bp_placement(const double scale[3], const double degrees[3], const double translate[3]) {
    BpPlacement placement;
    memcpy(placement.scale, scale, sizeof placement.scale);
    memcpy(placement.translate, translate, sizeof placement.translate);
    for (int axis = 0; axis < 3; axis++) turn(degrees[axis], &placement.sine[axis], &placement.cosine[axis]);
    return placement;
}

static void turn_about_axes(const BpPlacement *placement, double point[3]) {
    for (int axis = 0; axis < 3; axis++) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double x = point[a], y = point[b];
        point[a] = placement->cosine[axis] * x - placement->sine[axis] * y;
        point[b] = placement->sine[axis] * x + placement->cosine[axis] * y;
    }
}

void bp_place_normal(const BpPlacement *placement, double normal[3]) {
    for (int a = 0; a < 3; a++) normal[a] /= placement->scale[a];
    turn_about_axes(placement, normal);
}

void bp_place_point(const BpPlacement *placement, double point[3]) {
    for (int a = 0; a < 3; a++) point[a] *= placement->scale[a];
    turn_about_axes(placement, point);
    for (int a = 0; a < 3; a++) point[a] += placement->translate[a];
}

bool bp_placement_mirrors(const BpPlacement *placement) {
    int negative = 0;
    for (int a = 0; a < 3; a++) negative += placement->scale[a] < 0;
    return negative % 2 == 1;
}
