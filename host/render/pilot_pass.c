/* pilot_pass.c: see pilot_pass.h. */
#include "pilot_pass.h"

#include "pilot_shapes.h"

#include "scene/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
/* One in GROUP of the rays that have come one way counts, within these bounds. */
#define GROUP 32u
#define COUNT 16u
#define COUNT_MIN 4u
/* Radians: rays that pass farther off say nothing of the light. */
#define NEAR_MAX 0.7
/* The light lies beyond the rim of what the rays cover, if they pass on one side of it: if their mean is off
 * by more of their radius, squared, than half a disk of them would be, and what their number lets chance add.
 */
#define ASIDE2 0.16
#define ASIDE2_OF_ONE 0.5
/* The squared mean of n points of a disk of radius 1 is more than FEW / n in 3 of 100 cases: few rays that
 * lie no farther off may be all around, and then the light counts. */
#define FEW 1.75

/* A ray that passes a light. */
typedef struct Pass {
    double off[3], off2; /* radians */
    double size2;        /* of the light: of half the angle that it fills, squared */
    const BpPilotRay *ray;
} Pass;

static int by_way(const void *a, const void *b) {
    const BpPilotRay *x = a, *y = b;
    if (x->way != y->way) return x->way < y->way ? -1 : 1;
    return x->number < y->number ? -1 : 1;
}

/* False: it does not pass it, or something stands between. */
static bool pass_light(const BpPilotLight *light, const BpPilotRay *ray, Pass *pass) {
    *pass = (Pass){.ray = ray};
    if (light->distant) {
        if (isfinite(ray->length)) return false;
        for (int a = 0; a < 3; ++a) pass->off[a] = ray->direction[a] - light->place[a];
        pass->size2 = 2 * light->cap;
    } else {
        double to[3];
        for (int a = 0; a < 3; ++a) to[a] = light->place[a] - ray->origin[a];
        const double along = bp_dot(to, ray->direction);
        if (along <= light->radius || (ray->length < along && ray->shape != light->shape)) return false;
        for (int a = 0; a < 3; ++a) pass->off[a] = ray->direction[a] - to[a] / along;
        pass->size2 = light->radius * light->radius / (along * along);
    }
    pass->off2 = bp_dot(pass->off, pass->off);
    return pass->off2 < NEAR_MAX * NEAR_MAX;
}

/* Keeps the `most` nearest, the nearest first. */
static void keep_nearest(const Pass *pass, size_t most, Pass *nearest, size_t *count) {
    size_t place = *count;
    if (place == most && nearest[place - 1].off2 <= pass->off2) return;
    if (place == most)
        --place;
    else
        ++*count;
    for (; place > 0 && nearest[place - 1].off2 > pass->off2; --place) nearest[place] = nearest[place - 1];
    nearest[place] = *pass;
}

/* Around the light, the solid angle of mirror directions in which a lobe shows it, and how bright. */
static double glint_extent(const BpScene *scene, const BpPilotLight *lights, size_t light_count,
                           const BpPilotLight *light, const BpPilotRay *ray, double *glint) {
    const BpMaterial *material = bp_pilot_material(scene, ray->through);
    double mean;
    *glint = bp_pilot_glint_around(scene, lights, light_count, light, material, &ray->turn, &mean);
    return *glint > 0 ? mean / *glint : 0;
}

/* The rays that have come one way, and one light. */
static void pass_group(const BpScene *scene, bool focused, const BpPilotLight *lights, size_t light_count,
                       const BpPilotLight *light, const BpPilotRay *rays, size_t count, BpPilotParts *parts) {
    Pass nearest[COUNT], pass;
    size_t most = count / GROUP, found = 0;
    if (most > COUNT) most = COUNT;
    if (most < COUNT_MIN) most = COUNT_MIN;
    for (size_t i = 0; i < count; ++i)
        if (pass_light(light, &rays[i], &pass)) keep_nearest(&pass, most, nearest, &found);
    if (found < COUNT_MIN) return;
    most = found; /* fewer, if others do not pass near */
    const double near2 = nearest[most - 1].off2;
    double aside[3] = {0};
    for (size_t i = 0; i < most - 1; ++i)
        for (int a = 0; a < 3; ++a) aside[a] += nearest[i].off[a] / (double)(most - 1);
    const double counted = (double)(most - 1);
    if (bp_dot(aside, aside) > fmax(ASIDE2 + ASIDE2_OF_ONE / counted, FEW / counted) * near2) return;
    double glint = 1, extent = 0;
    if (rays[0].lobe) extent = glint_extent(scene, lights, light_count, light, nearest[0].ray, &glint);
    for (size_t i = 0; i < most - 1; ++i) { /* the last one tells how far, and does not count */
        const BpPilotRay *ray = nearest[i].ray;
        double radiance[3];
        const double size2 = rays[0].lobe ? fmin(extent / PI, near2) : nearest[i].size2;
        if (size2 >= near2 && !rays[0].lobe) return; /* rays meet it often */
        for (int c = 0; c < 3; ++c) radiance[c] = glint * ray->carried[c] * light->radiance[c];
        const bool is_found =
            focused && bp_pilot_is_found(scene, light, &ray->met, scene->camera.lookfrom, ray->begins);
        bp_pilot_add(is_found ? &parts->focused : &parts->chance, ray->pixel, radiance,
                     ray->share * size2 / near2, bp_pilot_way(scene, ray->through));
    }
}

void bp_pilot_pass(const BpScene *scene, bool focused, const BpPilotLight *lights, size_t light_count,
                   BpPilotRay *rays, size_t ray_count, BpPilotParts *parts) {
    qsort(rays, ray_count, sizeof *rays, by_way);
    for (size_t first = 0, end; first < ray_count; first = end) {
        for (end = first + 1; end < ray_count && rays[end].way == rays[first].way;) ++end;
        const BpPilotRay *ray = &rays[first];
        for (size_t l = 0; l < light_count; ++l) {
            if (lights[l].share > 1) continue;
            pass_group(scene, focused, lights, light_count, &lights[l], ray, end - first, parts);
        }
    }
}
