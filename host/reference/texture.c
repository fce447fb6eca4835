/* texture.c: what a texture is at a point of a sphere or a triangle; see trace.h.
 *
 * From the definitions (scenes/README.md), with the library's functions of angles, in the scene's own
 * coordinates. */
#include "trace.h"

#define PI 3.14159265358979323846

/* `v` turned about a unit vector, counter-clockwise seen from its tip. */
static Vec turned(Vec v, Vec about, double angle) {
    const Vec along = scale(dot(v, about), about), aside = sub(v, along);
    return add(along, add(scale(cos(angle), aside), scale(sin(angle), cross(about, aside))));
}

/* The direction of `radial` on a globe that stands upright and is not turned: what was done to the globe is
 * undone in the opposite order, the turn about its axis, then the tilt of that axis away from y. */
static Vec upright(const double up[3], double turn_degrees, Vec radial) {
    const Vec y = {0, 1, 0}, pole = unit(vec(up));
    const Vec unturned = turned(radial, pole, -turn_degrees * (PI / 180));
    const Vec axis = cross(y, pole);
    if (!(length2(axis) > 0)) return pole.y > 0 ? unturned : turned(unturned, (Vec){1, 0, 0}, PI);
    return turned(unturned, unit(axis), -atan2(sqrt(length2(axis)), pole.y));
}

/* The second book's coordinates: longitude over a turn, latitude over half of one, from the south pole. */
static void map_of(const BpTexture *texture, Vec radial, double *u, double *v) {
    const Vec p = upright(texture->up, texture->turn_degrees, radial);
    *u = (atan2(-p.z, p.x) + PI) / (2 * PI);
    *v = acos(fmax(-1, fmin(1, -p.y))) / PI;
}

/* ---- triangles ---- */

/* The shares of the second and the third vertex are those by which the edges from the first lead closest to
 * the point: by the normal equations of least squares. */
static bool coordinates_of(const BpScene *scene, const Hit *hit, double *u, double *v) {
    if (hit->triangle == NULL) return false;
    const float *const at = bp_triangle_coordinates(scene, (size_t)(hit->triangle - scene->triangles));
    if (at == NULL) return false;
    const Vec first = vec(hit->triangle->vertices[0]), one = sub(vec(hit->triangle->vertices[1]), first),
              two = sub(vec(hit->triangle->vertices[2]), first), way = sub(hit->point, first);
    const double aa = dot(one, one), ab = dot(one, two), bb = dot(two, two);
    const double pa = dot(way, one), pb = dot(way, two), all = aa * bb - ab * ab;
    const double shares[3] = {1 - (pa * (bb - ab) + pb * (aa - ab)) / all, (pa * bb - pb * ab) / all,
                              (pb * aa - pa * ab) / all};
    *u = *v = 0;
    for (int k = 0; k < 3; ++k) {
        *u += shares[k] * (double)at[2 * k];
        *v += shares[k] * (double)at[2 * k + 1];
    }
    return true;
}

static bool is_odd(double number) {
    return fmod(number, 2) != 0;
}

/* ---- images: host/scene/texture.h says what lies between texels ---- */

/* `number` modulo `count`, from 0 up. */
static size_t wrapped_around(double number, uint32_t count) {
    const double rest = fmod(number, count);
    return (size_t)(rest < 0 ? rest + count : rest);
}

/* The texel at a column and a row, whole numbers that may lie outside; `rows`: of all repetitions, beyond
 * which the nearest one counts. */
static Vec texel(const BpImage *image, double column, double row, double rows, bool clamped) {
    const size_t x =
        clamped ? (size_t)fmin(fmax(column, 0), image->width - 1.0) : wrapped_around(column, image->width);
    const size_t y = wrapped_around(fmin(fmax(row, 0), (clamped ? image->height : rows) - 1), image->height);
    const float *rgb = image->texels + 3 * (y * image->width + x);
    return (Vec){(double)rgb[0], (double)rgb[1], (double)rgb[2]};
}

/* Each of the four texels around a place counts by how near its middle is. `x`, `y`: in texels from the upper
 * left corner. */
static Vec bilinear(const BpImage *image, double x, double y, double rows, bool clamped) {
    const double left = floor(x - 0.5), top = floor(y - 0.5);
    Vec sum = {0, 0, 0};
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            const double near = (1 - fabs(left + i + 0.5 - x)) * (1 - fabs(top + j + 0.5 - y));
            sum = add(sum, scale(near, texel(image, left + i, top + j, rows, clamped)));
        }
    return sum;
}

static Vec pictured(const BpScene *scene, const BpTexture *texture, const Hit *hit) {
    const BpImage *image = texture->image;
    double rows = (double)image->height * texture->repeat[1];
    double u, v;
    if (coordinates_of(scene, hit, &u, &v)) {
        const double columns = (double)image->width * texture->repeat[0];
        if (texture->wrap == BP_WRAP_CLAMP) return bilinear(image, u * columns, (1 - v) * rows, rows, true);
        /* Far from both edges of a strip that has no end. */
        const double upwards = v - floor(v);
        return bilinear(image, u * columns, (2 - upwards) * rows, 3 * rows, false);
    }
    map_of(texture, hit->radial, &u, &v);
    return bilinear(image, u * texture->repeat[0] * image->width, (1 - v) * rows, rows,
                    texture->wrap == BP_WRAP_CLAMP);
}

/* The image is seen from inside, its middle at -z and its right half towards x. */
Vec bp_ref_environment(const BpScene *scene, Vec direction) {
    static const double y[3] = {0, 1, 0};
    const BpImage *image = scene->environment;
    const bool tilted = length2(vec(scene->background_up)) > 0;
    const Vec p = unit(upright(tilted ? scene->background_up : y, scene->environment_turn, direction));
    const double u = 0.5 + atan2(p.x, -p.z) / (2 * PI), v = acos(fmax(-1, fmin(1, p.y))) / PI;
    return bilinear(image, u * image->width, v * image->height, image->height, false);
}

/* In cells, from the texture's origin. */
static Vec in_lattice(const BpTexture *texture, Vec point) {
    return scale(1 / texture->size, sub(point, vec(texture->origin)));
}

static Vec checker(const BpScene *scene, const BpTexture *texture, const Hit *hit) {
    bool odd;
    if (texture->mapping == BP_MAPPING_SURFACE) {
        double u, v;
        if (coordinates_of(scene, hit, &u, &v))
            return vec(texture->colors[is_odd(floor(u * 2 * texture->repeat[0])) !=
                                       is_odd(floor(v * 2 * texture->repeat[1]))]);
        map_of(texture, hit->radial, &u, &v);
        odd = is_odd(floor(u * 2 * texture->repeat[0])) !=
              is_odd(fmin(floor(v * 2 * texture->repeat[1]), 2.0 * texture->repeat[1] - 1));
    } else {
        const Vec place = in_lattice(texture, hit->point);
        odd = is_odd(floor(place.x)) != is_odd(floor(place.y));
        odd = odd != is_odd(floor(place.z));
    }
    return vec(texture->colors[odd]);
}

/* ---- noise: host/scene/texture.h defines it ---- */

/* A whole number modulo the lattice's period. */
static uint32_t wrapped(double whole) {
    const double rest = fmod(whole, BP_LATTICE_PERIOD);
    return (uint32_t)(rest < 0 ? rest + BP_LATTICE_PERIOD : rest);
}

static Vec gradient(double x, double y, double z, uint32_t octave, uint32_t seed) {
    static const Vec edges[16] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                  {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                  {1, 1, 0},  {0, -1, 1},  {-1, 1, 0}, {0, -1, -1}};
    uint32_t v[3] = {wrapped(x) + (octave << 22), wrapped(y), wrapped(z) + seed * 0x9e3779b9u};
    for (int i = 0; i < 3; ++i) v[i] = v[i] * 1664525u + 1013904223u;
    for (int i = 0; i < 3; ++i) v[i] += v[(i + 1) % 3] * v[(i + 2) % 3];
    for (int i = 0; i < 3; ++i) v[i] ^= v[i] >> 16;
    return edges[(v[0] + v[1] * v[2]) >> 28];
}

static double between(double a, double b, double t) {
    const double s = ((6 * t - 15) * t + 10) * t * t * t;
    return (1 - s) * a + s * b;
}

static double noise(Vec p, uint32_t octave, uint32_t seed) {
    const Vec low = {floor(p.x), floor(p.y), floor(p.z)}, t = sub(p, low);
    double slope[2][2][2];
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
            for (int k = 0; k < 2; ++k)
                slope[i][j][k] = dot(gradient(low.x + i, low.y + j, low.z + k, octave, seed),
                                     (Vec){t.x - i, t.y - j, t.z - k});
    double along_z[2];
    for (int k = 0; k < 2; ++k)
        along_z[k] = between(between(slope[0][0][k], slope[1][0][k], t.x),
                             between(slope[0][1][k], slope[1][1][k], t.x), t.y);
    return between(along_z[0], along_z[1], t.z);
}

/* From the plane through the origin along the axis, or from the axis, in waves. */
static double waves(const BpTexture *texture, Vec from) {
    const double v[3] = {from.x, from.y, from.z};
    const int axis = texture->axis, b = (axis + 1) % 3, c = (axis + 2) % 3;
    return (texture->pattern == BP_PATTERN_MARBLE ? v[axis] : hypot(v[b], v[c])) / texture->period;
}

static Vec noisy(const BpTexture *texture, Vec point) {
    const Vec place = in_lattice(texture, point);
    double s = 0, share = 0;
    for (uint32_t k = 0; k < texture->octaves; ++k)
        s += ldexp(noise(scale(ldexp(1, (int)k), place), k, texture->seed), -(int)k);
    const double moved = waves(texture, sub(point, vec(texture->origin)));
    switch (texture->pattern) {
    case BP_PATTERN_PERLIN:
        share = (1 + s) / 2;
        break;
    case BP_PATTERN_TURBULENCE:
        share = fabs(s);
        break;
    case BP_PATTERN_MARBLE:
        share = (1 + sin(2 * PI * (moved + texture->distortion * fabs(s)))) / 2;
        break;
    case BP_PATTERN_WOOD:
        share = (1 + sin(2 * PI * (moved + texture->distortion * s))) / 2;
        break;
    }
    share = fmin(fmax(share, 0), 1);
    return add(scale(1 - share, vec(texture->colors[0])), scale(share, vec(texture->colors[1])));
}

Vec bp_ref_varied(const BpScene *scene, const Hit *hit, BpMember member, const double constant[3]) {
    const uint32_t number = hit->material->texture[member];
    if (number == 0) return vec(constant);
    const BpTexture *texture = &scene->textures[number - 1];
    switch (texture->type) {
    case BP_TEXTURE_CHECKER:
        return checker(scene, texture, hit);
    case BP_TEXTURE_NOISE:
        return noisy(texture, hit->point);
    case BP_TEXTURE_IMAGE:
        return pictured(scene, texture, hit);
    }
    return vec(constant); /* not reached */
}
