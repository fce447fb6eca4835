/* style_bodies.c: see style_bodies.h.
 *
 * An ellipsoid is the unit sphere's mesh (geodesic.h), stretched and turned, with the normals of the
 * ellipsoid at its vertices. The fineness follows from how many there are, so that all have some two million
 * triangles at most, or those of the coarsest mesh that still looks like what it is. */
#include "style_bodies.h"

#include "base/format.h"
#include "base/plural.h"
#include "geodesic.h"
#include "quaternion.h"
#include "scene/vector.h"
#include "scene/vertex_normals.h"
#include "style_colors.h"
#include "style_shapes.h"
#include "style_spheres.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TRIANGLES_WANTED 2000000 /* of all ellipsoids, which take about 0.6 GB */
#define COARSE_COUNT 200000 /* so many ellipsoids have meshes of COARSE_PARTS at least; more have fewer */
enum { COARSE_PARTS = 2 };

/* ---- what is said ------------------------------------------------------------------------------------- */

/* "3 polygons", of shapes of that kind, for which `counted` holds. */
static size_t count_kind(const BpStyleJob *job, const char *kind, bool with_body, bool rounded) {
    const BpParticles *const p = job->p;
    size_t count = 0;
    for (size_t i = 0; i < p->count; i++) {
        if (!job->shown[i] || p->body[i].kind == BP_BODY_SPHERE) continue;
        const BpParticleShape *const shape = bp_style_shape(job, i);
        const bool same = shape == NULL ? kind == NULL : kind != NULL && strcmp(kind, shape->kind) == 0;
        count += same && bp_style_has_body(job, i) == with_body &&
                 (!rounded || (shape != NULL && shape->rounding > 0));
    }
    return count;
}

static const char *plural_of(const char *one, const char *many, size_t count) {
    return count == 1 ? one : many;
}

typedef struct KindWords {
    const char *kind; /* NULL: ellipsoids */
    const char *one, *many;
} KindWords;
static const KindWords kinds[] = {{NULL, "ellipsoid", "ellipsoids"},
                                  {"polyhedron", "polyhedron", "polyhedra"},
                                  {"polygon", "polygon", "polygons"},
                                  {"mesh", "mesh", "meshes"},
                                  {"spherocylinder", "spherocylinder", "spherocylinders"}};

static void say_kinds(BpStyleJob *job, const Geodesic *ellipsoid) {
    char number[32], other[32];
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const KindWords *const words = &kinds[k];
        const size_t drawn = count_kind(job, words->kind, true, false),
                     left = count_kind(job, words->kind, false, false),
                     rounded = count_kind(job, words->kind, true, true);
        bp_format_whole(drawn, number, sizeof number);
        if (drawn > 0 && words->kind == NULL)
            bp_style_say(
                job, "%s %s of %s triangles each, at most %.2g %% of the axes too large or too small", number,
                plural_of(words->one, words->many, drawn),
                bp_format_whole(ellipsoid->triangle_count, other, sizeof other), 100 * ellipsoid->error);
        else if (drawn > 0)
            bp_style_say(job, "%s %s%s", number, plural_of(words->one, words->many, drawn),
                         strcmp(words->kind, "polygon") == 0 ? ", a tenth as thick as wide" : "");
        if (rounded > 0)
            bp_style_say(job, "%s of them without rounded edges",
                         bp_format_whole(rounded, other, sizeof other));
        if (left > 0)
            bp_style_say(job, "%s %s drawn as %s%s", bp_format_whole(left, number, sizeof number),
                         plural_of(words->one, words->many, left), left == 1 ? "a sphere" : "spheres",
                         job->style->shapes ? ", since triangles cannot be so small, flat or far away" : "");
    }
}

/* ---- triangles ---------------------------------------------------------------------------------------- */

/* How many triangles and ellipsoids are shown. */
static void count_all(const BpStyleJob *job, size_t *ellipsoids, size_t *triangles) {
    *ellipsoids = *triangles = 0;
    for (size_t i = 0; i < job->p->count; i++) {
        if (!job->shown[i] || !bp_style_has_body(job, i)) continue;
        const BpParticleShape *const shape = bp_style_shape(job, i);
        *ellipsoids += shape == NULL;
        *triangles += shape != NULL ? shape->triangle_count : 0;
    }
}

static unsigned parts_for(size_t ellipsoids) {
    const double wanted = sqrt((double)TRIANGLES_WANTED / (double)GEODESIC_TRIANGLES(1) / (double)ellipsoids);
    if (wanted >= GEODESIC_PARTS_MAX) return GEODESIC_PARTS_MAX;
    if (wanted >= COARSE_PARTS) return (unsigned)wanted;
    return ellipsoids <= COARSE_COUNT ? COARSE_PARTS : 1;
}

static BpStatus make_room(BpStyleJob *job, size_t triangles, bool smooth, BpError *err) {
    BpScene *const scene = job->scene;
    if (triangles > BP_SPHERES_MAX || bp_scene_shapes(scene) > BP_SPHERES_MAX - triangles)
        return bp_fail(err, BP_ERR_SCENE,
                       "found particles of %zu triangles, expected at most %u; \"select\" fewer, or draw "
                       "them as spheres by "
                       "\"shapes\": false",
                       triangles, BP_SPHERES_MAX);
    const size_t count = scene->triangle_count + triangles;
    BpTriangle *const grown = realloc(scene->triangles, (count + 1) * sizeof *grown);
    if (grown == NULL)
        return bp_fail(err, BP_ERR_MEMORY,
                       "out of memory for %zu triangles; \"shapes\": false draws particles as spheres",
                       count);
    scene->triangles = grown;
    return smooth ? bp_scene_make_normals(scene, count, err) : BP_OK;
}

/* Where a particle is, how large and how it is turned. */
typedef struct Stand {
    double center[3], scale, rotation[3][3];
    uint32_t albedo;
} Stand;

static BpStatus stand_of(BpStyleJob *job, size_t i, Stand *stand, BpError *err) {
    const BpParticleBody *const body = &job->p->body[i];
    double q[4], color[3];
    for (int k = 0; k < 4; k++) q[k] = (double)body->orientation[k];
    quaternion_normalize(q);
    quaternion_rotation(q, stand->rotation);
    memcpy(stand->center, job->p->position[i], sizeof stand->center);
    stand->scale = bp_style_scale(job, i);
    bp_style_color(job, i, color);
    return bp_style_put_color(job, color, &stand->albedo, err);
}

static void place(const Stand *stand, const double at[3], double out[3]) {
    quaternion_turn((const double(*)[3])stand->rotation, at, out);
    for (int c = 0; c < 3; c++) out[c] = stand->center[c] + stand->scale * out[c];
}

/* The vertices, so that all triangles have the same ones. `axes`: NULL for a shape. */
static void place_all(const Stand *stand, const double (*vertices)[3], size_t count, const float *axes,
                      double (*places)[3], float (*normals)[3]) {
    for (size_t v = 0; v < count; v++) {
        double at[3], normal[3], turned[3];
        for (int c = 0; c < 3; c++) at[c] = vertices[v][c] * (axes != NULL ? (double)axes[c] : 1);
        place(stand, at, places[v]);
        if (axes == NULL) continue;
        for (int c = 0; c < 3; c++) normal[c] = vertices[v][c] / (double)axes[c];
        bp_normalize(normal);
        quaternion_turn((const double(*)[3])stand->rotation, normal, turned);
        bp_unit_normal(turned, normals[v]);
    }
}

static void put_triangles(BpStyleJob *job, const Stand *stand, const uint32_t (*triangles)[3], size_t count,
                          const double (*places)[3], const float (*normals)[3]) {
    BpScene *const scene = job->scene;
    for (size_t t = 0; t < count; t++, scene->triangle_count++) {
        BpTriangle *const triangle = &scene->triangles[scene->triangle_count];
        for (int k = 0; k < 3; k++)
            memcpy(triangle->vertices[k], places[triangles[t][k]], sizeof triangle->vertices[k]);
        triangle->material = job->material;
        triangle->albedo = stand->albedo;
        for (int k = 0; k < 3 && normals != NULL; k++)
            memcpy(scene->normals[scene->triangle_count][k], normals[triangles[t][k]], sizeof normals[0]);
    }
}

static BpStatus put_capsule(BpStyleJob *job, size_t i, const BpParticleShape *shape, const Stand *stand,
                            BpError *err) {
    double ends[2][3], color[3];
    for (int e = 0; e < 2; e++) place(stand, shape->vertices[e], ends[e]);
    bp_style_color(job, i, color);
    return bp_style_put_capsule(job, ends[0], ends[1], stand->scale * shape->capsule_radius, color, color,
                                err);
}

static BpStatus put_all(BpStyleJob *job, const Geodesic *ellipsoid, double (*places)[3], float (*normals)[3],
                        BpError *err) {
    const bool inside = bp_material_is(job->scene->materials[job->material].kind, BP_HAS_INSIDE);
    for (size_t i = 0; i < job->p->count; i++) {
        Stand stand;
        if (!job->shown[i] || !bp_style_has_body(job, i)) continue;
        const BpParticleShape *const shape = bp_style_shape(job, i);
        BP_TRY(stand_of(job, i, &stand, err));
        if (shape == NULL) {
            place_all(&stand, (const double(*)[3])ellipsoid->vertices, ellipsoid->vertex_count,
                      job->p->body[i].half_axes, places, normals);
            put_triangles(job, &stand, (const uint32_t(*)[3])ellipsoid->triangles, ellipsoid->triangle_count,
                          (const double(*)[3])places, (const float(*)[3])normals);
        } else if (shape->capsule_radius > 0) {
            BP_TRY(put_capsule(job, i, shape, &stand, err));
        } else {
            if (inside && !shape->closed)
                return bp_fail(err, BP_ERR_SCENE,
                               "found the material \"%.80s\", which lets light in, on the type \"%.80s\", "
                               "whose faces are not "
                               "closed; expected another material, or \"shapes\": false, which draws spheres",
                               job->scene->materials[job->material].name, shape->type);
            place_all(&stand, (const double(*)[3])shape->vertices, shape->vertex_count, NULL, places, NULL);
            put_triangles(job, &stand, (const uint32_t(*)[3])shape->triangles, shape->triangle_count,
                          (const double(*)[3])places, NULL);
        }
    }
    return BP_OK;
}

BpStatus bp_style_put_bodies(BpStyleJob *job, BpError *err) {
    Geodesic ellipsoid = {0};
    size_t ellipsoids = 0, triangles = 0, most = 0;
    if (job->p->body == NULL) return BP_OK;
    count_all(job, &ellipsoids, &triangles);
    if (ellipsoids > 0) BP_TRY(geodesic_create(parts_for(ellipsoids), &ellipsoid, err));
    most = ellipsoid.vertex_count;
    for (size_t s = 0; s < job->p->shape_count; s++)
        most = job->p->shapes[s].vertex_count > most ? job->p->shapes[s].vertex_count : most;
    double(*places)[3] = malloc((most + 1) * sizeof *places);
    float(*normals)[3] = malloc((most + 1) * sizeof *normals);
    BpStatus status =
        places != NULL && normals != NULL
            ? make_room(job, triangles + ellipsoids * ellipsoid.triangle_count, ellipsoids > 0, err)
            : bp_fail(err, BP_ERR_MEMORY, "out of memory for the vertices of a particle");
    if (status == BP_OK) status = put_all(job, &ellipsoid, places, normals, err);
    if (status == BP_OK) say_kinds(job, &ellipsoid);
    free(places);
    free(normals);
    geodesic_clear(&ellipsoid);
    return status;
}
