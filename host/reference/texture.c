/* texture.c: what a texture is at a point of a sphere; see trace.h.
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
static Vec upright(const BpTexture *texture, Vec radial) {
    const Vec y = {0, 1, 0}, pole = unit(vec(texture->up));
    const Vec unturned = turned(radial, pole, -texture->turn_degrees * (PI / 180));
    const Vec axis = cross(y, pole);
    if (!(length2(axis) > 0)) return pole.y > 0 ? unturned : turned(unturned, (Vec){1, 0, 0}, PI);
    return turned(unturned, unit(axis), -atan2(sqrt(length2(axis)), pole.y));
}

/* The second book's coordinates: longitude over a turn, latitude over half of one, from the south pole. */
static void map_of(const BpTexture *texture, Vec radial, double *u, double *v) {
    const Vec p = upright(texture, radial);
    *u = (atan2(-p.z, p.x) + PI) / (2 * PI);
    *v = acos(fmax(-1, fmin(1, -p.y))) / PI;
}

static bool is_odd(double number) {
    return fmod(number, 2) != 0;
}

static Vec checker(const BpTexture *texture, Vec point, Vec radial) {
    bool odd;
    if (texture->mapping == BP_MAPPING_SURFACE) {
        double u, v;
        map_of(texture, radial, &u, &v);
        odd = is_odd(floor(u * 2 * texture->repeat[0])) !=
              is_odd(fmin(floor(v * 2 * texture->repeat[1]), 2.0 * texture->repeat[1] - 1));
    } else {
        odd = is_odd(floor(point.x / texture->size)) != is_odd(floor(point.y / texture->size));
        odd = odd != is_odd(floor(point.z / texture->size));
    }
    return vec(texture->colors[odd]);
}

Vec bp_ref_varied(const BpScene *scene, const Hit *hit, BpMember member, const double constant[3]) {
    const uint32_t number = hit->material->texture[member];
    if (number == 0) return vec(constant);
    return checker(&scene->textures[number - 1], hit->point, hit->radial);
}
