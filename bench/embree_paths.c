/* embree_paths.c: see embree_paths.h. */
#include "embree_paths.h"

#include <math.h>
#include <string.h>

#define DIMENSION_CAMERA 0x80000000u /* bounces count from 0 */

enum {
    FLAG_KIND = 7,
    FLAG_BALL = 8,         /* scatter cosine_cubed, or fuzz_shape ball: a point of the ball */
    FLAG_HEMISPHERE = 16,
    FLAG_EXACT = 32,       /* fresnel */
    FLAG_NO_FRESNEL = 64,
    FLAG_ABSORB = 128,     /* total reflection */
    FLAG_REFRACT = 256
};

/* ---- the world ---- */

static uint32_t material_flags(const BpMaterial *material) {
    uint32_t flags = (uint32_t)material->kind;
    switch (material->kind) {
    case BP_MATERIAL_LAMBERTIAN:
        if (material->scatter == BP_SCATTER_COSINE_CUBED) flags |= FLAG_BALL;
        if (material->scatter == BP_SCATTER_HEMISPHERE) flags |= FLAG_HEMISPHERE;
        break;
    case BP_MATERIAL_METAL:
        if (material->fuzz_shape == BP_FUZZ_BALL) flags |= FLAG_BALL;
        break;
    case BP_MATERIAL_DIELECTRIC:
        if (material->fresnel == BP_FRESNEL_EXACT) flags |= FLAG_EXACT;
        if (material->fresnel == BP_FRESNEL_NONE) flags |= FLAG_NO_FRESNEL;
        if (material->total_reflection == BP_TOTAL_ABSORB) flags |= FLAG_ABSORB;
        if (material->total_reflection == BP_TOTAL_REFRACT) flags |= FLAG_REFRACT;
        break;
    case BP_MATERIAL_DIFFUSE_LIGHT:
    case BP_MATERIAL_NORMALS: break;
    }
    return flags;
}

static uint32_t material_has(const BpMaterial *material) {
    const uint32_t flags = material_flags(material);
    uint32_t has = 0;
    if (material->kind == BP_MATERIAL_METAL) has |= HAS_METAL;
    if (material->kind == BP_MATERIAL_DIELECTRIC) has |= HAS_GLASS;
    if (material->kind == BP_MATERIAL_NORMALS) has |= HAS_NORMALS;
    for (int k = 0; k < 3; k++) {
        if (material->emit[k] > 0) has |= HAS_EMISSION;
    }
    if (flags & FLAG_BALL) has |= HAS_BALL;
    if (flags & FLAG_HEMISPHERE) has |= HAS_HEMISPHERE;
    if (flags & FLAG_EXACT) has |= HAS_EXACT;
    if (flags & (FLAG_ABSORB | FLAG_REFRACT)) has |= HAS_TOTAL_OTHER;
    return has;
}

static void set_surface(World *world, size_t entry, const BpMaterial *material, bool inside_out) {
    float *values = world->values[entry];
    world->flags[entry] = material_flags(material);
    for (int k = 0; k < 3; k++) {
        values[k] = material->kind == BP_MATERIAL_DIELECTRIC ? 1 : (float)material->albedo[k];
        values[4 + k] = (float)material->emit[k];
    }
    const double index = inside_out ? 1 / material->refraction_index : material->refraction_index;
    values[3] = (float)(material->kind == BP_MATERIAL_DIELECTRIC ? index : material->fuzz);
}

World world_create(const BpScene *scene, uint64_t seed) {
    PeerCamera camera;
    peer_camera(scene, &camera);
    World world = {.scene = scene,
                   .lens = camera.lens,
                   .center = camera.center,
                   .max_depth = scene->camera.max_depth,
                   .seed = (uint32_t)(seed * 0x9e3779b97f4a7c15u >> 32)};
    for (int k = 0; k < 3; k++) {
        world.corner[k] = (float)camera.corner[k];
        world.right[k] = (float)camera.right[k];
        world.down[k] = (float)camera.down[k];
        world.lens_right[k] = (float)camera.lens_right[k];
        world.lens_up[k] = (float)camera.lens_up[k];
        const double bottom = scene->background_bottom[k], top = scene->background_top[k];
        world.sky_bottom[k] = (float)(0.5 * (bottom + top)); /* at y = 0 */
        world.sky_slope[k] = (float)(0.5 * (top - bottom));
    }
    /* Surfaces: each material as it is and inside out, then one for every sphere with a colour of its own. */
    const size_t spheres = scene->sphere_count, materials = scene->material_count;
    size_t own = 0;
    for (size_t i = 0; i < spheres; i++) own += scene->spheres[i].albedo != BP_NO_ALBEDO;
    world.values = peer_allocate(2 * materials + own, sizeof *world.values);
    world.flags = peer_allocate(2 * materials + own, sizeof *world.flags);
    world.points = peer_allocate(spheres, 4 * sizeof(float));
    world.surface = peer_allocate(spheres, sizeof *world.surface);
    for (size_t m = 0; m < 2 * materials; m++) set_surface(&world, m, &scene->materials[m / 2], m & 1);
    size_t next = 2 * materials;
    for (size_t i = 0; i < spheres; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        const BpMaterial *material = &scene->materials[sphere->material];
        const bool inside_out = sphere->radius < 0;
        world.has |= material_has(material);
        for (int k = 0; k < 3; k++) world.points[4 * i + (size_t)k] = (float)(sphere->center[k] - camera.origin[k]);
        world.points[4 * i + 3] = (float)fabs(sphere->radius);
        world.surface[i] = 2 * sphere->material + inside_out;
        if (sphere->albedo != BP_NO_ALBEDO) {
            set_surface(&world, next, material, inside_out);
            if (material->kind != BP_MATERIAL_DIELECTRIC)
                memcpy(world.values[next], scene->albedos[sphere->albedo], 3 * sizeof(float));
            world.surface[i] = (uint32_t)next++;
        }
    }
    return world;
}

Batch batch_create(uint32_t lanes) {
    Batch batch = {.lanes = lanes};
    float **floats[] = {batch.origin,     batch.direction, batch.throughput, batch.radiance,
                        batch.normal,     batch.uniform,   batch.random,     batch.next};
    for (size_t a = 0; a < sizeof floats / sizeof *floats; a++) {
        for (int k = 0; k < 3; k++) floats[a][k] = peer_allocate(lanes, sizeof(float));
    }
    batch.t = peer_allocate(lanes, sizeof(float));
    batch.value = peer_allocate(lanes, sizeof(float));
    batch.offset = peer_allocate(lanes, sizeof(float));
    batch.cosine = peer_allocate(lanes, sizeof(float));
    uint32_t **words[] = {&batch.column, &batch.sample, &batch.depth, &batch.sphere,
                          &batch.front,  &batch.alive,  &batch.kind};
    for (size_t a = 0; a < sizeof words / sizeof *words; a++) *words[a] = peer_allocate(lanes, sizeof(uint32_t));
    return batch;
}

/* ---- random numbers ---- */

/* pcg3d (Jarzynski and Olano 2020): three words of three. */
static inline void hash3(uint32_t *x, uint32_t *y, uint32_t *z) {
    uint32_t a = *x * 1664525u + 1013904223u, b = *y * 1664525u + 1013904223u, c = *z * 1664525u + 1013904223u;
    a += b * c;
    b += c * a;
    c += a * b;
    a ^= a >> 16;
    b ^= b >> 16;
    c ^= c >> 16;
    a += b * c;
    b += c * a;
    c += a * b;
    *x = a;
    *y = b;
    *z = c;
}

static inline float to_uniform(uint32_t word) { return (float)(int32_t)(word >> 8) * 0x1p-24f; }

/* sin and cos of 2 pi u, u in [0, 1): a quarter turn at a time, Taylor polynomials on +-pi/4. */
static inline void circle(float u, float *sine, float *cosine) {
    const float quarter = (float)(int32_t)(4 * u + 0.5f); /* 0 .. 4 */
    const float x = (u - 0.25f * quarter) * 6.28318530718f, q = x * x;
    const float s = x * (1 + q * (-1.6666667e-1f + q * (8.3333310e-3f + q * -1.9840874e-4f)));
    const float c = 1 + q * (-0.5f + q * (4.1666638e-2f + q * (-1.3888378e-3f + q * 2.4760495e-5f)));
    const int32_t turn = (int32_t)quarter;
    const float a = turn & 1 ? c : s, b = turn & 1 ? s : c;
    *sine = turn & 2 ? -a : a;
    *cosine = (turn + 1) & 2 ? -b : b;
}

/* Cube root of u in [0, 1): a guess from the bits, three Newton steps. */
static inline float cube_root(float u) {
    union {
        float f;
        uint32_t i;
    } bits = {u};
    bits.i = bits.i / 3 + 0x2a517d47u;
    float x = bits.f;
    for (int step = 0; step < 3; step++) x = (2 * x + u / (x * x)) * (1 / 3.0f);
    return x;
}

/* ---- camera ---- */

bool batch_refill(Batch *batch, const World *world, RowCursor *cursor) {
    const BpCamera *camera = &world->scene->camera;
    const uint32_t spp = camera->samples_per_pixel;
    batch->fresh = batch->active;
    /* Few free lanes: wait, so that the loops below run over full vectors. */
    const uint32_t free_lanes = batch->lanes - batch->active;
    if (free_lanes < (batch->lanes < 4 * LANE_BLOCK ? batch->lanes / 2 : LANE_BLOCK)) return true;
    uint32_t end = batch->active;
    while (end < batch->lanes && cursor->column < camera->width) {
        batch->column[end] = cursor->column;
        batch->sample[end++] = cursor->sample;
        if (++cursor->sample == spp) {
            cursor->sample = 0;
            cursor->column++;
        }
    }
    const uint32_t first_pixel = cursor->row * camera->width;
    for (uint32_t i = batch->active; i < end; i++) {
        uint32_t a = first_pixel + batch->column[i], b = batch->sample[i], c = DIMENSION_CAMERA + world->seed;
        hash3(&a, &b, &c);
        float jitter_x = 0.5f, jitter_y = 0.5f, lens_x = 0, lens_y = 0;
        if (!world->center) {
            jitter_x = to_uniform(a);
            jitter_y = to_uniform(b);
        }
        if (world->lens) {
            uint32_t d = first_pixel + batch->column[i], e = batch->sample[i], f = DIMENSION_CAMERA + 1 + world->seed;
            hash3(&d, &e, &f);
            float sine, cosine;
            circle(to_uniform(d), &sine, &cosine);
            const float radius = sqrtf(to_uniform(e));
            lens_x = radius * cosine;
            lens_y = radius * sine;
        }
        const float x = (float)(int32_t)batch->column[i] + jitter_x, y = (float)cursor->row + jitter_y;
        float origin[3], direction[3];
        for (int k = 0; k < 3; k++) {
            origin[k] = world->lens_right[k] * lens_x + world->lens_up[k] * lens_y;
            direction[k] = world->corner[k] + x * world->right[k] + y * world->down[k] - origin[k];
        }
        const float scale =
            1 / sqrtf(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
        for (int k = 0; k < 3; k++) {
            batch->origin[k][i] = origin[k];
            batch->direction[k][i] = direction[k] * scale;
            batch->throughput[k][i] = 1;
            batch->radiance[k][i] = 0;
        }
        batch->depth[i] = 0;
    }
    batch->active = end;
    return end > 0;
}

/* ---- one bounce, loop by loop ---- */

/* Loops carry no dependence from lane to lane; arrays never overlap. */
#define EACH_LANE _Pragma("GCC ivdep") for (uint32_t i = 0; i < count; i++)

/* The surface's normal facing the ray, its numbers, and a random direction. */
static void meet_surfaces(Batch *restrict batch, const World *restrict world, uint32_t first_pixel) {
    const uint32_t count = batch->active;
    float *restrict nx = batch->normal[0], *restrict ny = batch->normal[1], *restrict nz = batch->normal[2];
    float *restrict ox = batch->origin[0], *restrict oy = batch->origin[1], *restrict oz = batch->origin[2];
    const float *dx = batch->direction[0], *dy = batch->direction[1], *dz = batch->direction[2];
    EACH_LANE {
        const bool hit = batch->sphere[i] != NO_HIT;
        const float length2 = nx[i] * nx[i] + ny[i] * ny[i] + nz[i] * nz[i];
        const float scale = hit ? 1 / sqrtf(length2) : 0;
        const float cosine = (dx[i] * nx[i] + dy[i] * ny[i] + dz[i] * nz[i]) * scale;
        const bool front = cosine < 0;
        const float facing = front ? scale : -scale;
        nx[i] *= facing;
        ny[i] *= facing;
        nz[i] *= facing;
        batch->front[i] = front;
        batch->offset[i] = length2 * scale * 0x1p-21f; /* the normal that comes in is as long as the radius */
        const float t = hit ? batch->t[i] : 0;
        batch->cosine[i] = fabsf(cosine) < 1 ? fabsf(cosine) : 1;
        ox[i] += t * dx[i];
        oy[i] += t * dy[i];
        oz[i] += t * dz[i];
    }
    EACH_LANE {
        uint32_t a = first_pixel + batch->column[i], b = batch->sample[i], c = batch->depth[i] + world->seed;
        hash3(&a, &b, &c);
        const float z = 1 - 2 * to_uniform(a), radius2 = 1 - z * z;
        const float radius = sqrtf(radius2 > 0 ? radius2 : 0);
        float sine, cosine;
        circle(to_uniform(b), &sine, &cosine);
        batch->random[0][i] = radius * cosine;
        batch->random[1][i] = radius * sine;
        batch->random[2][i] = z;
        batch->uniform[0][i] = to_uniform(c);
    }
}

/* Radiance found here: the sky, lamps, normals. Sets kind, value and alive, and multiplies the throughput. */
static void gather_surfaces(Batch *restrict batch, const World *restrict world) {
    const uint32_t count = batch->active, has = world->has;
    const uint32_t *restrict surface = world->surface, *restrict flags = world->flags;
    const float(*restrict values)[8] = (const float(*)[8])world->values;
    if (world->scene->sphere_count == 0) {
        memset(batch->alive, 0, count * sizeof *batch->alive);
    } else {
        EACH_LANE {
            const bool hit = batch->sphere[i] != NO_HIT;
            const uint32_t entry = surface[hit ? batch->sphere[i] : 0];
            const uint32_t kind = flags[entry];
            const bool last = ++batch->depth[i] >= world->max_depth;
            batch->kind[i] = hit ? kind : 0;
            batch->value[i] = values[entry][3];
            batch->alive[i] = hit & !last & ((kind & FLAG_KIND) <= BP_MATERIAL_DIELECTRIC);
        }
    }
    for (int k = 0; k < 3; k++) {
        float *restrict throughput = batch->throughput[k], *restrict radiance = batch->radiance[k];
        const float bottom = world->sky_bottom[k], slope = world->sky_slope[k];
        const float *restrict dy = batch->direction[1], *restrict normal = batch->normal[k];
        const uint32_t *restrict sphere = batch->sphere;
        if (has & HAS_EMISSION) {
            EACH_LANE {
                const float emit = values[surface[sphere[i] != NO_HIT ? sphere[i] : 0]][4 + k];
                radiance[i] += sphere[i] != NO_HIT ? throughput[i] * emit : 0;
            }
        }
        if (has & HAS_NORMALS) {
            EACH_LANE {
                const bool shows = (sphere[i] != NO_HIT) & ((batch->kind[i] & FLAG_KIND) == BP_MATERIAL_NORMALS);
                radiance[i] += shows ? throughput[i] * (0.5f * normal[i] + 0.5f) : 0;
            }
        }
        EACH_LANE {
            const bool hit = sphere[i] != NO_HIT;
            radiance[i] += hit ? 0 : throughput[i] * (bottom + slope * dy[i]);
            if (hit) throughput[i] *= values[surface[sphere[i]]][k];
        }
    }
}

static void scatter_diffuse(Batch *restrict batch, const World *restrict world) {
    const uint32_t count = batch->active;
    float *restrict rx = batch->random[0], *restrict ry = batch->random[1], *restrict rz = batch->random[2];
    const float *nx = batch->normal[0], *ny = batch->normal[1], *nz = batch->normal[2];
    if (world->has & HAS_BALL) {
        EACH_LANE {
            const float radius = cube_root(batch->uniform[0][i]);
            const float scale = batch->kind[i] & FLAG_BALL ? radius : 1;
            rx[i] *= scale;
            ry[i] *= scale;
            rz[i] *= scale;
        }
    }
    EACH_LANE {
        batch->next[0][i] = nx[i] + rx[i];
        batch->next[1][i] = ny[i] + ry[i];
        batch->next[2][i] = nz[i] + rz[i];
    }
    if (world->has & HAS_HEMISPHERE) {
        EACH_LANE {
            const bool hemisphere = batch->kind[i] & FLAG_HEMISPHERE;
            const float side = nx[i] * rx[i] + ny[i] * ry[i] + nz[i] * rz[i] < 0 ? -1.0f : 1.0f;
            batch->next[0][i] = hemisphere ? side * rx[i] : batch->next[0][i];
            batch->next[1][i] = hemisphere ? side * ry[i] : batch->next[1][i];
            batch->next[2][i] = hemisphere ? side * rz[i] : batch->next[2][i];
        }
    }
}

static void scatter_metal(Batch *restrict batch) {
    const uint32_t count = batch->active;
    const float *rx = batch->random[0], *ry = batch->random[1], *rz = batch->random[2];
    const float *nx = batch->normal[0], *ny = batch->normal[1], *nz = batch->normal[2];
    const float *dx = batch->direction[0], *dy = batch->direction[1], *dz = batch->direction[2];
    EACH_LANE {
        const bool metal = (batch->kind[i] & FLAG_KIND) == BP_MATERIAL_METAL;
        const float twice = 2 * batch->cosine[i], fuzz = batch->value[i]; /* the normal faces the ray */
        const float x = dx[i] + twice * nx[i] + fuzz * rx[i];
        const float y = dy[i] + twice * ny[i] + fuzz * ry[i];
        const float z = dz[i] + twice * nz[i] + fuzz * rz[i];
        const bool above = x * nx[i] + y * ny[i] + z * nz[i] > 0;
        batch->alive[i] &= !metal | above;
        batch->next[0][i] = metal ? x : batch->next[0][i];
        batch->next[1][i] = metal ? y : batch->next[1][i];
        batch->next[2][i] = metal ? z : batch->next[2][i];
    }
}

static void scatter_glass(Batch *restrict batch, const World *restrict world) {
    const uint32_t count = batch->active;
    const bool exact = world->has & HAS_EXACT, other = world->has & HAS_TOTAL_OTHER;
    const float *nx = batch->normal[0], *ny = batch->normal[1], *nz = batch->normal[2];
    const float *dx = batch->direction[0], *dy = batch->direction[1], *dz = batch->direction[2];
    EACH_LANE {
        const uint32_t kind = batch->kind[i];
        const bool glass = (kind & FLAG_KIND) == BP_MATERIAL_DIELECTRIC;
        const float index = glass ? batch->value[i] : 1, ratio = batch->front[i] ? 1 / index : index;
        const float cosine = batch->cosine[i];
        const float square = 1 - ratio * ratio * (1 - cosine * cosine); /* of the transmitted cosine */
        const bool total = square < 0;
        const float transmitted = sqrtf(fabsf(square));
        const float root = (1 - ratio) / (1 + ratio), r0 = root * root, away = 1 - cosine;
        const float away2 = away * away;
        float reflectance = r0 + (1 - r0) * away2 * away2 * away; /* Schlick 1994 */
        if (exact) {
            const float inner = total ? 0 : transmitted;
            const float across = (ratio * cosine - inner) / (ratio * cosine + inner);
            const float along = (cosine - ratio * inner) / (cosine + ratio * inner);
            reflectance = kind & FLAG_EXACT ? 0.5f * (across * across + along * along) : reflectance;
        }
        reflectance = kind & FLAG_NO_FRESNEL ? 0 : reflectance;
        bool mirror = batch->uniform[0][i] < reflectance;
        if (other) {
            mirror |= total & !(kind & (FLAG_ABSORB | FLAG_REFRACT));
            batch->alive[i] &= !(glass & total & ((kind & FLAG_ABSORB) != 0));
        } else {
            mirror |= total;
        }
        const float along_ray = mirror ? 1 : ratio;
        const float along_normal = mirror ? 2 * cosine : ratio * cosine - transmitted;
        batch->next[0][i] = glass ? along_ray * dx[i] + along_normal * nx[i] : batch->next[0][i];
        batch->next[1][i] = glass ? along_ray * dy[i] + along_normal * ny[i] : batch->next[1][i];
        batch->next[2][i] = glass ? along_ray * dz[i] + along_normal * nz[i] : batch->next[2][i];
    }
}

/* Unit directions; and points on float spheres lie up to about 1e-7 radii off the surface, so that a path could slip
 * under a huge one: they are moved to the side that the ray leaves by. */
static void leave_surfaces(Batch *restrict batch) {
    const uint32_t count = batch->active;
    const float *nx = batch->normal[0], *ny = batch->normal[1], *nz = batch->normal[2];
    float *restrict ox = batch->origin[0], *restrict oy = batch->origin[1], *restrict oz = batch->origin[2];
    const float *x = batch->next[0], *y = batch->next[1], *z = batch->next[2];
    float *restrict dx = batch->direction[0], *restrict dy = batch->direction[1], *restrict dz = batch->direction[2];
    EACH_LANE {
        const float length2 = x[i] * x[i] + y[i] * y[i] + z[i] * z[i];
        const bool fine = length2 > 1e-12f; /* else the random vector met the normal's opposite: take the normal */
        const float scale = 1 / sqrtf(fine ? length2 : 1);
        dx[i] = fine ? x[i] * scale : nx[i];
        dy[i] = fine ? y[i] * scale : ny[i];
        dz[i] = fine ? z[i] * scale : nz[i];
        const float offset = dx[i] * nx[i] + dy[i] * ny[i] + dz[i] * nz[i] < 0 ? -batch->offset[i] : batch->offset[i];
        ox[i] += offset * nx[i];
        oy[i] += offset * ny[i];
        oz[i] += offset * nz[i];
    }
}

static void move_lane(Batch *batch, uint32_t from, uint32_t to, bool emission) {
    for (int k = 0; k < 3; k++) {
        batch->origin[k][to] = batch->origin[k][from];
        batch->direction[k][to] = batch->direction[k][from];
        batch->throughput[k][to] = batch->throughput[k][from];
        batch->radiance[k][to] = emission ? batch->radiance[k][from] : 0;
    }
    batch->column[to] = batch->column[from];
    batch->sample[to] = batch->sample[from];
    batch->depth[to] = batch->depth[from];
}

void batch_bounce(Batch *batch, const World *world, const RowCursor *cursor, const PeerFilm *film) {
    const size_t first_pixel = (size_t)cursor->row * film->width;
    meet_surfaces(batch, world, (uint32_t)first_pixel);
    gather_surfaces(batch, world);
    scatter_diffuse(batch, world);
    if (world->has & HAS_METAL) scatter_metal(batch);
    if (world->has & HAS_GLASS) scatter_glass(batch, world);
    leave_surfaces(batch);

    uint32_t active = batch->active;
    for (uint32_t i = active; i-- > 0;) {
        if (batch->alive[i]) continue;
        double *sum = film->half[batch->sample[i] & 1] + (first_pixel + batch->column[i]) * 3;
        for (int k = 0; k < 3; k++) sum[k] += (double)batch->radiance[k][i];
        if (i != --active) move_lane(batch, active, i, world->has & HAS_EMISSION);
    }
    batch->active = active;
}
