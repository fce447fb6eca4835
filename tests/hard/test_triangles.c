/* test_triangles.c: rays aimed at edges and vertices of closed meshes, and what they meet when they leave.
 *
 *     hard_triangles double|float|all-double RAYS
 *
 * From inside, every ray meets something: a crack would let it out. Then it leaves the triangle that it has
 * met in any direction, to either side, a quarter of the times grazing it, and what it meets next is compared
 * with the exact ray from the exact point, in 113 bits. Exit code 1: a promise of docs/NUMERICS.md was
 * broken. */
#include "turns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 4000 };
enum { EDGES, VERTICES, ANYWHERE, KINDS };

typedef struct Mesh {
    double vertices[400][3];
    uint32_t faces[800][3];
    size_t vertex_count, face_count;
    BpTriangle triangles[800];
    double normals[800][3], size;
    bool convex;
} Mesh;

/* ---- meshes ---- */

static void add_face(Mesh *mesh, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t face[3] = {a, b, c};
    memcpy(mesh->faces[mesh->face_count++], face, sizeof face);
}

static uint32_t middle(Mesh *mesh, uint32_t a, uint32_t b) {
    double m[3], length = 0;
    for (int i = 0; i < 3; ++i) m[i] = mesh->vertices[a][i] + mesh->vertices[b][i];
    length = sqrt(lab_dot(m, m));
    for (int i = 0; i < 3; ++i) m[i] /= length;
    for (uint32_t v = 0; v < mesh->vertex_count; ++v)
        if (fabs(mesh->vertices[v][0] - m[0]) + fabs(mesh->vertices[v][1] - m[1]) +
                fabs(mesh->vertices[v][2] - m[2]) <
            1e-9)
            return v;
    memcpy(mesh->vertices[mesh->vertex_count], m, sizeof m);
    return (uint32_t)mesh->vertex_count++;
}

/* An octahedron, each face in four, `rounds` times, pushed out to the unit sphere. */
static void make_ball(Mesh *mesh, int rounds) {
    static const double corners[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh->vertex_count = 6;
    memcpy(mesh->vertices, corners, sizeof corners);
    for (uint32_t x = 0; x < 2; ++x)
        for (uint32_t y = 2; y < 4; ++y)
            for (uint32_t z = 4; z < 6; ++z) {
                const bool even = (x + y + z) % 2 == 0;
                add_face(mesh, x, even ? y : z, even ? z : y);
            }
    for (int round = 0; round < rounds; ++round) {
        uint32_t old[800][3];
        const size_t count = mesh->face_count;
        memcpy(old, mesh->faces, sizeof old);
        mesh->face_count = 0;
        for (size_t f = 0; f < count; ++f) {
            const uint32_t a = old[f][0], b = old[f][1], c = old[f][2];
            const uint32_t ab = middle(mesh, a, b), bc = middle(mesh, b, c), ca = middle(mesh, c, a);
            add_face(mesh, a, ab, ca);
            add_face(mesh, ab, b, bc);
            add_face(mesh, ca, bc, c);
            add_face(mesh, ab, bc, ca);
        }
    }
}

static void make_cube(Mesh *mesh) {
    static const uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int corner = 0; corner < 8; ++corner)
        for (int a = 0; a < 3; ++a) mesh->vertices[corner][a] = (corner >> a & 1) != 0 ? 1 : -1;
    mesh->vertex_count = 8;
    for (int side = 0; side < 6; ++side) {
        add_face(mesh, sides[side][0], sides[side][1], sides[side][2]);
        add_face(mesh, sides[side][0], sides[side][2], sides[side][3]);
    }
}

static void difference(const double *to, const double *from, double out[3]) {
    for (int a = 0; a < 3; ++a) out[a] = to[a] - from[a];
}

/* Roughened, sized and moved; vertices are floats. */
static void finish(Mesh *mesh, double rough, double size, double far, uint64_t *random) {
    double way[3];
    lab_direction(random, way);
    mesh->size = size;
    for (size_t v = 0; v < mesh->vertex_count; ++v) {
        const double grown = size * (1 + rough * (2 * lab_unit(random) - 1));
        for (int a = 0; a < 3; ++a)
            mesh->vertices[v][a] = lab_float(mesh->vertices[v][a] * grown + way[a] * far);
    }
    for (size_t f = 0; f < mesh->face_count; ++f) {
        double u[3], v[3];
        mesh->triangles[f].albedo = BP_NO_ALBEDO;
        for (int k = 0; k < 3; ++k)
            memcpy(mesh->triangles[f].vertices[k], mesh->vertices[mesh->faces[f][k]],
                   sizeof mesh->vertices[0]);
        difference(mesh->triangles[f].vertices[1], mesh->triangles[f].vertices[0], u);
        difference(mesh->triangles[f].vertices[2], mesh->triangles[f].vertices[0], v);
        lab_cross(u, v, mesh->normals[f]);
        const double length = sqrt(lab_dot(mesh->normals[f], mesh->normals[f]));
        for (int a = 0; a < 3; ++a) mesh->normals[f][a] /= length;
    }
}

/* ---- the truth ---- */

typedef struct Meeting {
    long face; /* -1: none */
    bool outside;
    Wide t;
} Meeting;

/* On which sides of a face's plane the vertices of another lie that are not its own: 1 above, 2 below. */
static int sides_of(const Mesh *mesh, size_t plane, size_t face) {
    int sides = 0;
    for (int i = 0; i < 3; ++i) {
        const uint32_t v = mesh->faces[face][i], *own = mesh->faces[plane];
        if (v == own[0] || v == own[1] || v == own[2]) continue;
        double from[3];
        difference(mesh->vertices[v], mesh->triangles[plane].vertices[0], from);
        const double height = lab_dot(from, mesh->normals[plane]);
        const double rounding = 1e-14 * (fabs(from[0]) + fabs(from[1]) + fabs(from[2]));
        sides |= height > rounding ? 1 : height < -rounding ? 2 : 0;
    }
    return sides;
}

/* Rules out most faces without 113 bits: two edge functions of clearly different signs. `tiny` is far more
 * than the rounding of long doubles, also at a thousand sizes from the origin. */
static bool surely_passes_by(const BpTriangle *triangle, const long double origin[3], const double *d,
                             long double tiny) {
    long double at[3][3];
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) at[k][a] = (long double)triangle->vertices[k][a] - origin[a];
    bool below = false, above = false;
    for (int k = 0; k < 3; ++k) {
        const long double *p = at[(k + 1) % 3], *q = at[(k + 2) % 3];
        const long double w = (long double)d[0] * (p[1] * q[2] - p[2] * q[1]) +
                              (long double)d[1] * (p[2] * q[0] - p[0] * q[2]) +
                              (long double)d[2] * (p[0] * q[1] - p[1] * q[0]);
        below = below || w < -tiny;
        above = above || w > tiny;
    }
    return below && above;
}

/* What the exact ray meets first that leaves a face from the exact point that its first part met it at. */
static Meeting exact_next(const Mesh *mesh, size_t own, const double *ray, const double *direction) {
    const BpTriangle *left = &mesh->triangles[own];
    Wide origin[3], d[3], w[3], point[3], t;
    bool outside;
    for (int a = 0; a < 3; ++a) origin[a] = (Wide)ray[a] + (Wide)ray[3 + a], d[a] = (Wide)ray[6 + a];
    turns_passes(left, origin, d, (Wide)1e300, w, &t, &outside);
    Wide sum = w[0] + w[1] + w[2], b[3], all = 0;
    for (int k = 0; k < 3; ++k) b[k] = w[k] / sum > 0 ? w[k] / sum : 0, all += b[k];
    for (int a = 0; a < 3; ++a) {
        point[a] = 0;
        for (int k = 0; k < 3; ++k) point[a] += b[k] / all * (Wide)left->vertices[k][a];
        d[a] = (Wide)direction[a];
    }
    const bool above = lab_dot(direction, mesh->normals[own]) > 0;
    Meeting best = {-1, false, 0};
    const Wide size = (Wide)mesh->size;
    long double near_point[3];
    for (int a = 0; a < 3; ++a) near_point[a] = (long double)point[a];
    for (size_t f = 0; f < mesh->face_count; ++f) {
        bool from_outside;
        if (f == own || surely_passes_by(&mesh->triangles[f], near_point, direction,
                                         1e-12L * (long double)(mesh->size * mesh->size)))
            continue;
        if (!turns_passes(&mesh->triangles[f], point, d, 1e-26 * size * size, w, &t, &from_outside)) continue;
        if (from_outside != above || t < -1e-24 * size)
            continue; /* of a closed mesh only faces of the side that the ray is on */
        if (wide_abs(t) < 1e-20 * size) {
            const int there = sides_of(mesh, own, f), here = sides_of(mesh, f, own);
            if ((there & (above ? 1 : 2)) == 0 ||
                !((here == 1 && from_outside) || (here == 2 && !from_outside)))
                continue;
        }
        if (best.face >= 0 && t >= best.t) continue;
        best = (Meeting){(long)f, from_outside, t};
    }
    return best;
}

/* ---- rays ---- */

/* Returns the face that the point is of. */
static size_t random_point(const Mesh *mesh, int kind, uint64_t *random, double point[3]) {
    const size_t face = lab_bits(random) % mesh->face_count;
    const double(*v)[3] = (const double(*)[3])mesh->triangles[face].vertices;
    const double s = lab_unit(random), u = lab_unit(random);
    const unsigned k = (unsigned)(lab_bits(random) % 3);
    for (int a = 0; a < 3; ++a)
        point[a] = kind == EDGES      ? v[k][a] * (1 - s) + v[(k + 1) % 3][a] * s
                   : kind == VERTICES ? v[k][a]
                                      : v[0][a] * (1 - s) + v[1][a] * s * (1 - u) + v[2][a] * s * u;
    return face;
}

/* Where it goes on: anywhere, a quarter of the times along the face, but for up to 1e-4. */
static void choose_way(const Mesh *mesh, size_t face, uint64_t *random, double d[3]) {
    lab_direction(random, d);
    if (lab_bits(random) % 4 == 0) {
        const double *n = mesh->normals[face], high = lab_dot(d, n);
        const double left = 1e-4 * (2 * lab_unit(random) - 1);
        for (int a = 0; a < 3; ++a) d[a] += (left - high) * n[a];
    }
    for (int a = 0; a < 3; ++a) d[a] = lab_float(d[a]);
}

/* From near the middle, so that nothing lies in between in meshes that are seen whole from there.
 * `fine`: the kernel's reals are doubles. The low part of an origin is at most half a unit of its high part.
 */
static size_t aim(const Mesh *mesh, const double centre[3], int kind, bool fine, uint64_t *random,
                  double *ray) {
    double point[3], from[3];
    const size_t face = random_point(mesh, kind, random, point);
    lab_direction(random, from);
    memset(ray, 0, RAY_REALS * sizeof *ray);
    for (int a = 0; a < 3; ++a) {
        const double place = centre[a] + 0.3 * mesh->size * lab_unit(random) * from[a];
        ray[RAY_HIGH + a] = fine ? place : lab_float(place);
        ray[RAY_LOW + a] = fine ? 0x1p-54 * lab_unit(random) * place : lab_float(place - ray[RAY_HIGH + a]);
        ray[RAY_DIRECTION + a] = point[a] - (ray[RAY_HIGH + a] + ray[RAY_LOW + a]);
    }
    lab_float_unit(ray + RAY_DIRECTION);
    return face;
}

typedef struct Count {
    size_t rays, lost, turns, wrong, through, off_plane;
} Count;

static void run(const Lab *lab, const Mesh *mesh, size_t wanted, uint64_t *random, Count counts[KINDS]) {
    static double rays[BATCH * RAY_REALS], directions[BATCH * 3], out[BATCH * TURN_REALS];
    double centre[3] = {0, 0, 0};
    for (size_t v = 0; v < mesh->vertex_count; ++v)
        for (int a = 0; a < 3; ++a) centre[a] += mesh->vertices[v][a] / (double)mesh->vertex_count;
    BpWorker *worker = turns_worker(lab, NULL, 0, mesh->triangles, mesh->face_count);
    for (int kind = 0; kind < KINDS; ++kind)
        for (size_t done = 0; done < wanted; done += BATCH) {
            for (size_t i = 0; i < BATCH; ++i) {
                const size_t face = aim(mesh, centre, kind, lab->real_double, random, rays + i * RAY_REALS);
                choose_way(mesh, face, random, directions + 3 * i);
            }
            lab_unit_rays(lab, BATCH, rays);
            turns_run(lab, worker, BATCH, rays, directions, out);
            Count *count = &counts[kind];
            for (size_t i = 0; i < BATCH; ++i) {
                const double *row = out + i * TURN_REALS;
                ++count->rays;
                if (row[TURN_MET] < 0) {
                    ++count->lost;
                    continue;
                }
                const size_t own = (size_t)row[TURN_MET];
                const double *first = mesh->triangles[own].vertices[0];
                Wide height = 0;
                for (int a = 0; a < 3; ++a)
                    height += ((Wide)row[TURN_HIGH + a] + (Wide)row[TURN_LOW + a] - (Wide)first[a]) *
                              (Wide)mesh->normals[own][a];
                /* The normals here err by 2^-52, over a few sizes. */
                count->off_plane += fabs((double)height) > row[TURN_ERROR] + 0x1p-49 * mesh->size;
                const double leans = lab_dot(directions + 3 * i, mesh->normals[own]);
                if (fabs(leans) < 1e-6) continue;
                const Meeting truth = exact_next(mesh, own, rays + i * RAY_REALS, directions + 3 * i);
                const bool met = row[TURN_NEXT] >= 0;
                ++count->turns;
                /* A convex mesh is not met from outside, and from inside always. */
                count->through += mesh->convex && met != (leans < 0);
                count->wrong +=
                    met != (truth.face >= 0) ||
                    (met && ((row[TURN_NEXT_OUTSIDE] > 0) != truth.outside || row[TURN_NEXT_T] < 0 ||
                             fabs(row[TURN_NEXT_T] - (double)truth.t) > 1e-4 * mesh->size));
            }
        }
    bp_worker_destroy(&worker);
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        bool cube;
        double rough, size, far;
    } meshes[] = {{"smooth ball", false, 0, 1, 0},
                  {"rough ball", false, 0.3, 1, 0},
                  {"rough ball at 1000", false, 0.3, 1, 1000},
                  {"small rough ball at 1", false, 0.3, 1e-3, 1},
                  {"cube", true, 0, 1, 0}};
    static Mesh mesh;
    Lab lab;
    bool right = true;
    uint64_t random = 31;
    if (argc != 3) {
        fprintf(stderr, "usage: hard_triangles double|float|all-double RAYS\n");
        return 2;
    }
    if (!lab_open(&lab, argv[1])) return 77;
    const size_t wanted = strtoul(argv[2], NULL, 10);
    for (size_t m = 0; m < sizeof meshes / sizeof meshes[0]; ++m) {
        Count counts[KINDS] = {{0, 0, 0, 0, 0, 0}};
        memset(&mesh, 0, sizeof mesh);
        if (meshes[m].cube)
            make_cube(&mesh);
        else
            make_ball(&mesh, 2);
        mesh.convex = meshes[m].rough == 0;
        finish(&mesh, meshes[m].rough, meshes[m].size, meshes[m].far, &random);
        run(&lab, &mesh, wanted, &random, counts);
        for (int kind = 0; kind < KINDS; ++kind) {
            static const char *const aims[] = {"edges", "vertices", "anywhere"};
            const Count *count = &counts[kind];
            printf("%s, %s, aimed at %s: %zu rays, %zu lost, %zu off their plane; %zu turns, %zu wrong, "
                   "%zu of them through a convex mesh\n",
                   lab.name, meshes[m].name, aims[kind], count->rays, count->lost, count->off_plane,
                   count->turns, count->wrong, count->through);
            /* At vertices, where many planes meet in the point that is left, up to 1 in 1000. */
            const size_t allowed = kind == VERTICES ? count->turns / 1000 : 0;
            right = right && count->lost == 0 && count->off_plane == 0 && count->wrong <= allowed &&
                    count->through == 0;
        }
    }
    lab_close(&lab);
    return right ? 0 : 1;
}
