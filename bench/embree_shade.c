/* embree_shade.c: one bounce, loop by loop, each a plain loop over lanes (embree_paths.h). */
#include "embree_lanes.h"
#include "embree_paths.h"

#include <string.h>

/* ---- huge spheres ---- */

void batch_meet_huge(Batch *batch, const World *world) {
    const uint32_t count = batch->active;
    FLOATS3(ox, oy, oz, batch->origin);
    FLOATS3(dx, dy, dz, batch->direction);
    FLOATS(t, batch->t);
    WORDS(huge, batch->huge);
    EACH_LANE {
        t[i] = INFINITY;
        huge[i] = NO_HIT;
    }
    for (uint32_t h = 0; h < world->huge_count; h++) {
        const uint32_t sphere = world->huge[h];
        const float *point = world->points + 4 * (size_t)sphere;
        const float cx = point[0], cy = point[1], cz = point[2], radius2 = point[3] * point[3];
        EACH_LANE {
            /* Haines, Guenther and Akenine-Moeller 2019: the discriminant from the perpendicular */
            const float x = cx - ox[i], y = cy - oy[i], z = cz - oz[i];
            const float along = x * dx[i] + y * dy[i] + z * dz[i];
            const float px = x - along * dx[i], py = y - along * dy[i], pz = z - along * dz[i];
            const float square = radius2 - (px * px + py * py + pz * pz);
            const float half = sqrtf(square > 0 ? square : 0.0f);
            const float near = along - half, far = along + half;
            const float root = near > 0 ? near : far;
            const float limit = square > 0 ? t[i] : 0.0f;
            const uint32_t nearer = root < limit ? 1u : 0u, ahead = root > 0 ? 1u : 0u;
            t[i] = nearer & ahead ? root : t[i];
            huge[i] = nearer & ahead ? sphere : huge[i];
        }
    }
}

/* Lanes that met nothing nearer than their huge sphere met that. */
static void take_huge(const Batch *batch, const World *world) {
    const uint32_t count = batch->active;
    const float *restrict const points = world->points;
    FLOATS3(ox, oy, oz, batch->origin);
    FLOATS3(dx, dy, dz, batch->direction);
    FLOATS3(nx, ny, nz, batch->normal);
    FLOATS(t, batch->t);
    WORDS(huge, batch->huge);
    WORDS(sphere, batch->sphere);
    WORDS(entry, batch->entry);
    EACH_LANE {
        entry[i] = huge[i] != NO_HIT ? 4 * huge[i] : 0u;
    }
    EACH_LANE {
        const uint32_t take = sphere[i] == NO_HIT ? 1u : 0u;
        const float x = ox[i] + t[i] * dx[i] - points[entry[i]];
        const float y = oy[i] + t[i] * dy[i] - points[entry[i] + 1];
        const float z = oz[i] + t[i] * dz[i] - points[entry[i] + 2];
        nx[i] = take ? x : nx[i];
        ny[i] = take ? y : ny[i];
        nz[i] = take ? z : nz[i];
        sphere[i] = take ? huge[i] : sphere[i];
    }
}

/* ---- a bounce ---- */

/* The surface's normal facing the ray. The normal that comes in points outward and is as long as the radius.
 */
static void meet_surfaces(const Batch *batch) {
    const uint32_t count = batch->active;
    FLOATS3(nx, ny, nz, batch->normal);
    FLOATS3(ox, oy, oz, batch->origin);
    FLOATS3(dx, dy, dz, batch->direction);
    FLOATS(t, batch->t);
    FLOATS(cosine, batch->cosine);
    FLOATS(offset, batch->offset);
    WORDS(front, batch->front);
    WORDS(sphere, batch->sphere);
    EACH_LANE {
        const float length2 = sphere[i] != NO_HIT ? nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i] : 1.0f;
        const float scale = 1 / sqrtf(length2);
        const float outward = (dx[i] * nx[i] + dy[i] * ny[i] + dz[i] * nz[i]) * scale;
        const float facing = outward < 0 ? scale : -scale;
        const float distance = sphere[i] != NO_HIT ? t[i] : 0.0f;
        const float c = fabsf(outward);
        front[i] = outward < 0 ? 1u : 0u;
        cosine[i] = c < 1 ? c : 1.0f;
        nx[i] *= facing;
        ny[i] *= facing;
        nz[i] *= facing;
        ox[i] += distance * dx[i];
        oy[i] += distance * dy[i];
        oz[i] += distance * dz[i];
        offset[i] = 0x1p-21f * (length2 * scale + fabsf(ox[i]) + fabsf(oy[i]) + fabsf(oz[i]));
    }
}

/* A direction over the whole sphere, and one number more, from (pixel, sample, depth). */
static void draw_random(const Batch *batch, uint32_t first_pixel, uint32_t seed) {
    const uint32_t count = batch->active;
    FLOATS3(rx, ry, rz, batch->random);
    FLOATS(uniform, batch->uniform);
    WORDS(column, batch->column);
    WORDS(sample, batch->sample);
    WORDS(depth, batch->depth);
    EACH_LANE {
        uint32_t a = first_pixel + column[i], b = sample[i], c = depth[i] + seed;
        hash3(&a, &b, &c);
        const float z = 1 - 2 * to_uniform(a), radius2 = 1 - z * z;
        const float radius = sqrtf(radius2 > 0 ? radius2 : 0.0f);
        float sine, cosine;
        circle(to_uniform(b), &sine, &cosine);
        rx[i] = radius * cosine;
        ry[i] = radius * sine;
        rz[i] = z;
        uniform[i] = to_uniform(c);
    }
}

/* What the spheres are made of, and the radiance found there or in the sky. */
static void gather_surfaces(const Batch *batch, const World *world) {
    const uint32_t count = batch->active, has = world->has, max_depth = world->max_depth;
    const uint32_t sky_sphere = (uint32_t)world->shapes; /* a miss meets the sky's surface */
    const uint32_t *restrict const surface = world->surface, *restrict const flags = world->flags;
    const float *restrict const values = world->values;
    FLOATS(value, batch->value);
    WORDS(sphere, batch->sphere);
    WORDS(entry, batch->entry);
    WORDS(kind, batch->kind);
    WORDS(alive, batch->alive);
    WORDS(depth, batch->depth);
    EACH_LANE {
        entry[i] = surface[sphere[i] < sky_sphere ? sphere[i] : sky_sphere];
    }
    EACH_LANE {
        kind[i] = flags[entry[i]];
        value[i] = values[entry[i] * SURFACE_VALUES + 3];
        depth[i]++;
    }
    EACH_LANE {
        const uint32_t scatters = (kind[i] & FLAG_KIND) <= BP_MATERIAL_DIELECTRIC ? 1u : 0u;
        alive[i] = depth[i] < max_depth ? scatters : 0;
    }
    FLOATS(dy, batch->direction[1]);
    for (int k = 0; k < 3; k++) {
        FLOATS(throughput, batch->throughput[k]);
        FLOATS(radiance, batch->radiance[k]);
        FLOATS(normal, batch->normal[k]);
        const float middle = world->sky_middle[k], slope = world->sky_slope[k];
        if (has & HAS_EMISSION) {
            EACH_LANE {
                radiance[i] += throughput[i] * values[entry[i] * SURFACE_VALUES + 4 + (uint32_t)k];
            }
        }
        if (has & HAS_NORMALS) {
            EACH_LANE {
                const float shown = throughput[i] * (0.5f * normal[i] + 0.5f);
                radiance[i] += (kind[i] & FLAG_KIND) == BP_MATERIAL_NORMALS ? shown : 0.0f;
            }
        }
        EACH_LANE {
            const float sky = throughput[i] * (middle + slope * dy[i]);
            radiance[i] += sphere[i] != NO_HIT ? 0.0f : sky;
            throughput[i] *= values[entry[i] * SURFACE_VALUES + (uint32_t)k];
        }
    }
}

static void scatter_diffuse(const Batch *batch, uint32_t has) {
    const uint32_t count = batch->active;
    FLOATS3(rx, ry, rz, batch->random);
    FLOATS3(nx, ny, nz, batch->normal);
    FLOATS3(x, y, z, batch->next);
    FLOATS(uniform, batch->uniform);
    WORDS(kind, batch->kind);
    if (has & HAS_BALL) {
        EACH_LANE {
            const float radius = cube_root(uniform[i]);
            const float scale = kind[i] & FLAG_BALL ? radius : 1.0f;
            rx[i] *= scale;
            ry[i] *= scale;
            rz[i] *= scale;
        }
    }
    EACH_LANE {
        x[i] = nx[i] + rx[i];
        y[i] = ny[i] + ry[i];
        z[i] = nz[i] + rz[i];
    }
    if (has & HAS_HEMISPHERE) {
        EACH_LANE {
            const float side = nx[i] * rx[i] + ny[i] * ry[i] + nz[i] * rz[i] < 0 ? -1.0f : 1.0f;
            x[i] = kind[i] & FLAG_HEMISPHERE ? side * rx[i] : x[i];
            y[i] = kind[i] & FLAG_HEMISPHERE ? side * ry[i] : y[i];
            z[i] = kind[i] & FLAG_HEMISPHERE ? side * rz[i] : z[i];
        }
    }
}

static void scatter_metal(const Batch *batch) {
    const uint32_t count = batch->active;
    FLOATS3(rx, ry, rz, batch->random);
    FLOATS3(nx, ny, nz, batch->normal);
    FLOATS3(dx, dy, dz, batch->direction);
    FLOATS3(x, y, z, batch->next);
    FLOATS(fuzz, batch->value);
    FLOATS(cosine, batch->cosine);
    WORDS(kind, batch->kind);
    WORDS(alive, batch->alive);
    EACH_LANE {
        const uint32_t metal = (kind[i] & FLAG_KIND) == BP_MATERIAL_METAL ? 1u : 0u;
        const float twice = 2 * cosine[i]; /* the normal faces the ray */
        const float mx = dx[i] + twice * nx[i] + fuzz[i] * rx[i];
        const float my = dy[i] + twice * ny[i] + fuzz[i] * ry[i];
        const float mz = dz[i] + twice * nz[i] + fuzz[i] * rz[i];
        const uint32_t below = mx * nx[i] + my * ny[i] + mz * nz[i] > 0 ? 0u : 1u;
        alive[i] &= ~(metal & below);
        x[i] = metal ? mx : x[i];
        y[i] = metal ? my : y[i];
        z[i] = metal ? mz : z[i];
    }
}

static void scatter_glass(const Batch *batch, uint32_t has) {
    const uint32_t count = batch->active;
    FLOATS3(nx, ny, nz, batch->normal);
    FLOATS3(dx, dy, dz, batch->direction);
    FLOATS3(x, y, z, batch->next);
    FLOATS(index, batch->value);
    FLOATS(cosine, batch->cosine);
    FLOATS(uniform, batch->uniform);
    FLOATS(reflectance, batch->t);
    WORDS(front, batch->front);
    WORDS(kind, batch->kind);
    WORDS(alive, batch->alive);
    EACH_LANE {
        const float ratio = front[i] ? 1 / index[i] : index[i];
        const float root = (1 - ratio) / (1 + ratio), r0 = root * root, away = 1 - cosine[i];
        const float away2 = away * away;
        reflectance[i] = r0 + (1 - r0) * away2 * away2 * away; /* Schlick 1994 */
    }
    if (has & HAS_EXACT) {
        EACH_LANE {
            const float ratio = front[i] ? 1 / index[i] : index[i], c = cosine[i];
            const float square = 1 - ratio * ratio * (1 - c * c);
            const float inner = sqrtf(square > 0 ? square : 0.0f);
            const float across = (ratio * c - inner) / (ratio * c + inner);
            const float along = (c - ratio * inner) / (c + ratio * inner);
            const float exact = 0.5f * (across * across + along * along);
            reflectance[i] = kind[i] & FLAG_EXACT ? exact : reflectance[i];
        }
    }
    if (has & HAS_ODD_GLASS) {
        EACH_LANE {
            const float ratio = front[i] ? 1 / index[i] : index[i], c = cosine[i];
            const uint32_t total = ratio * ratio * (1 - c * c) > 1 ? 1u : 0u;
            const uint32_t glass = (kind[i] & FLAG_KIND) == BP_MATERIAL_DIELECTRIC ? 1u : 0u;
            const uint32_t absorbs = kind[i] & FLAG_ABSORB ? 1u : 0u;
            alive[i] &= ~(glass & total & absorbs);
            reflectance[i] = kind[i] & FLAG_NO_FRESNEL ? 0.0f : reflectance[i];
        }
    }
    EACH_LANE {
        const float ratio = front[i] ? 1 / index[i] : index[i], c = cosine[i];
        const float square = 1 - ratio * ratio * (1 - c * c); /* of the transmitted cosine */
        const float transmitted = sqrtf(fabsf(square));
        const float total = kind[i] & FLAG_REFRACT ? 0.0f : square; /* below 0: always a mirror */
        const float chance = total < 0 ? 2.0f : reflectance[i];
        const float along_ray = uniform[i] < chance ? 1.0f : ratio;
        const float along_normal = uniform[i] < chance ? 2 * c : ratio * c - transmitted;
        const uint32_t glass = (kind[i] & FLAG_KIND) == BP_MATERIAL_DIELECTRIC ? 1u : 0u;
        const float gx = along_ray * dx[i] + along_normal * nx[i];
        const float gy = along_ray * dy[i] + along_normal * ny[i];
        const float gz = along_ray * dz[i] + along_normal * nz[i];
        x[i] = glass ? gx : x[i];
        y[i] = glass ? gy : y[i];
        z[i] = glass ? gz : z[i];
    }
}

/* Unit directions; and points computed in float lie off the surface by parts of their coordinates and of the
 * radius, so that a path could meet its own sphere again or slip under it: they are moved, by four such
 * parts, to the side that the ray leaves by (as Waechter and Binder 2019 do, by other means). */
static void leave_surfaces(const Batch *batch) {
    const uint32_t count = batch->active;
    FLOATS3(x, y, z, batch->next);
    FLOATS3(nx, ny, nz, batch->normal);
    FLOATS3(ox, oy, oz, batch->origin);
    FLOATS3(dx, dy, dz, batch->direction);
    FLOATS(offset, batch->offset);
    EACH_LANE {
        const float length2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        const float scale = 1 / sqrtf(length2 > 1e-12f ? length2 : 1.0f);
        /* Next to nothing left: the random vector met the normal's opposite. Take the normal. */
        const float ux = length2 > 1e-12f ? x[i] * scale : nx[i];
        const float uy = length2 > 1e-12f ? y[i] * scale : ny[i];
        const float uz = length2 > 1e-12f ? z[i] * scale : nz[i];
        const float away = ux * nx[i] + uy * ny[i] + uz * nz[i] < 0 ? -offset[i] : offset[i];
        dx[i] = ux;
        dy[i] = uy;
        dz[i] = uz;
        ox[i] += away * nx[i];
        oy[i] += away * ny[i];
        oz[i] += away * nz[i];
    }
}

void lanes_scatter(const Batch *batch, const World *world, uint32_t first_pixel) {
    if (world->huge_count > 0) take_huge(batch, world);
    meet_surfaces(batch);
    draw_random(batch, first_pixel, world->seed);
    gather_surfaces(batch, world);
    scatter_diffuse(batch, world->has);
    if (world->has & HAS_METAL) scatter_metal(batch);
    if (world->has & HAS_GLASS) scatter_glass(batch, world->has);
    leave_surfaces(batch);
}
