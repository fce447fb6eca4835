/* test_bodies.c: the meshes of particles that are no spheres: the sphere's, beside its volume, moments and
 * stated error; hulls, whose faces are held against all points in whole numbers; and ellipsoids in a scene,
 * beside their equation. */
#include "base/orient.h"
#include "base/random.h"
#include "meshes/mesh.h"
#include "particles/add_to_scene.h"
#include "particles/convex_hull.h"
#include "particles/geodesic.h"
#include "support/unit_test.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
__extension__ typedef __int128 Wide;

static BpRandom generator = {17};

static int draw(int below) {
    return (int)(bp_random_bits(&generator) % (uint64_t)below);
}

static void assert_near(double found, double expected, double error) {
    if (fabs(found - expected) <= error) return;
    fail_msg("found %.17g, expected %.17g within %g", found, expected, error);
}

static void assert_closed(double (*positions)[3], size_t vertices, uint32_t (*faces)[3], size_t count) {
    const BpMesh mesh = {
        .positions = positions, .vertex_count = vertices, .faces = faces, .face_count = count};
    BpMeshEdge edge;
    assert_int_equal(bp_mesh_find_open_edge(&mesh, &edge, NULL), BP_OK);
    assert_int_equal(edge.fault, BP_MESH_EDGE_GOOD);
}

/* The volume and the second moments of a closed mesh, as sums over the tetrahedra from the origin. */
static double moments_of(const double (*at)[3][3], size_t count, double moments[3][3]) {
    double volume = 0;
    memset(moments, 0, 9 * sizeof(double));
    for (size_t t = 0; t < count; t++) {
        const double *const a = at[t][0], *const b = at[t][1], *const c = at[t][2];
        const double six = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                           a[2] * (b[0] * c[1] - b[1] * c[0]);
        volume += six / 6;
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                const double sum = a[i] + b[i] + c[i], other = a[k] + b[k] + c[k];
                moments[i][k] += six / 120 * (sum * other + a[i] * a[k] + b[i] * b[k] + c[i] * c[k]);
            }
    }
    return volume;
}

/* The distance of the origin from a triangle's points, by the plane's and those of the sides. */
static double nearest_of(const double (*at)[3]) {
    double u[3], v[3], n[3], length = 0, distance = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = at[1][i] - at[0][i];
        v[i] = at[2][i] - at[0][i];
    }
    for (int i = 0; i < 3; i++) n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
    for (int i = 0; i < 3; i++) {
        length += n[i] * n[i];
        distance += n[i] * at[0][i];
    }
    return distance / sqrt(length); /* all triangles are acute, so the foot lies inside */
}

static void spheres_of_all_finenesses(void **unused) {
    (void)unused;
    double before = INFINITY;
    for (unsigned parts = 1; parts <= GEODESIC_PARTS_MAX; parts++) {
        Geodesic sphere;
        double moments[3][3], least = INFINITY, most = 0;
        assert_int_equal(geodesic_create(parts, &sphere, NULL), BP_OK);
        assert_int_equal(sphere.vertex_count, 10 * parts * parts + 2);
        assert_int_equal(sphere.triangle_count, 20 * parts * parts);
        assert_closed(sphere.vertices, sphere.vertex_count, sphere.triangles, sphere.triangle_count);
        double(*at)[3][3] = malloc(sphere.triangle_count * sizeof *at);
        for (size_t t = 0; t < sphere.triangle_count; t++) {
            for (int k = 0; k < 3; k++)
                memcpy(at[t][k], sphere.vertices[sphere.triangles[t][k]], sizeof at[t][k]);
            least = fmin(least, nearest_of((const double(*)[3])at[t]));
        }
        for (size_t v = 0; v < sphere.vertex_count; v++) {
            const double *const p = sphere.vertices[v];
            most = fmax(most, sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
        }
        assert_near(moments_of((const double(*)[3][3])at, sphere.triangle_count, moments), 4 * PI / 3, 1e-12);
        assert_near(sphere.error, fmax(most - 1, 1 - least), 1e-12);
        assert_true(sphere.error < before);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                assert_near(moments[i][k], i == k ? 4 * PI / 15 : 0,
                            i == k ? sphere.error * 4 * PI / 15 : 1e-12);
        if (parts == 1)
            assert_near(sphere.error, cbrt(4 * PI / 3 / 2.5361507101204095) - 1, 1e-12); /* an icosahedron */
        /* Edges of about 1.26 / n, of which the largest triangles reach 3/8 of their squared circumradius. */
        if (parts > 4) assert_true(sphere.error < 0.2 / (parts * parts));
        before = sphere.error;
        free(at);
        geodesic_clear(&sphere);
    }
}

static Wide side_of(int (*p)[3], int a, int b, int c, int d) {
    Wide u[3], v[3], w[3];
    for (int i = 0; i < 3; i++) {
        u[i] = p[b][i] - p[a][i];
        v[i] = p[c][i] - p[a][i];
        w[i] = p[d][i] - p[a][i];
    }
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Points of a lattice, of which many share planes and lines, or lie on each other. */
static void hulls_hold_all_points(void **unused) {
    (void)unused;
    enum { MOST = 60 };
    int flat = 0, solid = 0;
    for (int round = 0; round < 20000; round++) {
        const int count = 1 + draw(MOST), width = 1 + draw(round % 3 == 0   ? 3
                                                           : round % 3 == 1 ? 12
                                                                            : 1000000);
        int p[MOST][3];
        double points[MOST][3];
        uint32_t(*faces)[3] = NULL;
        size_t face_count = 0;
        bool used[MOST] = {false}, volume = false;
        for (int i = 0; i < count; i++)
            for (int k = 0; k < 3; k++) {
                p[i][k] = draw(width) - width / 2;
                if (k == 2 && round % 50 == 7) p[i][k] = p[i][0] + 2 * p[i][1]; /* in one plane */
                points[i][k] = p[i][k] * 0.25;
            }
        assert_int_equal(convex_hull((const double(*)[3])points, (size_t)count, &faces, &face_count, NULL),
                         BP_OK);
        for (int i = 0; i < count && !volume; i++)
            for (int j = i + 1; j < count && !volume; j++)
                for (int k = j + 1; k < count && !volume; k++)
                    for (int l = k + 1; l < count && !volume; l++) volume = side_of(p, i, j, k, l) != 0;
        assert_int_equal(face_count > 0, volume);
        flat += !volume;
        solid += volume;
        if (!volume) continue;
        assert_closed(points, (size_t)count, faces, face_count);
        size_t corners = 0;
        for (size_t f = 0; f < face_count; f++)
            for (int i = 0; i < count; i++) {
                assert_true(side_of(p, (int)faces[f][0], (int)faces[f][1], (int)faces[f][2], i) <= 0);
                for (int k = 0; k < 3; k++) used[i] |= (int)faces[f][k] == i;
            }
        for (int i = 0; i < count; i++) corners += used[i];
        assert_int_equal(face_count, 2 * corners - 4); /* Euler: it is one ball */
        free(faces);
    }
    print_message("%d hulls, %d in one plane\n", solid, flat);
    assert_true(flat > 500 && solid > 5000);
}

/* Beside whole numbers of 36 bits, for points nearly in one plane, whose products doubles round. */
static void sides_are_exact(void **unused) {
    (void)unused;
    int zeros = 0, doubtful = 0;
    for (int round = 0; round < 400000; round++) {
        int64_t p[4][3];
        double at[4][3], rough[3][3];
        Wide u[3][3];
        const int s = draw(9) - 4, t = draw(9) - 4;
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                p[i][k] = (int64_t)(bp_random_bits(&generator) >> 28) - (INT64_C(1) << 35);
        for (int k = 0; k < 3; k++)
            p[3][k] = p[0][k] + s * (p[1][k] - p[0][k]) + t * (p[2][k] - p[0][k]) + (draw(4) == 0);
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++) at[i][k] = ldexp((double)p[i][k], -20);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                u[i][k] = p[i + 1][k] - p[0][k];
                rough[i][k] = at[i + 1][k] - at[0][k];
            }
        const Wide volume = u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) +
                            u[0][1] * (u[1][2] * u[2][0] - u[1][0] * u[2][2]) +
                            u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
        const double rounded = rough[0][0] * (rough[1][1] * rough[2][2] - rough[1][2] * rough[2][1]) +
                               rough[0][1] * (rough[1][2] * rough[2][0] - rough[1][0] * rough[2][2]) +
                               rough[0][2] * (rough[1][0] * rough[2][1] - rough[1][1] * rough[2][0]);
        const int sign = (volume > 0) - (volume < 0);
        assert_int_equal(orient3(at[0], at[1], at[2], at[3]), sign);
        assert_int_equal(orient3(at[1], at[0], at[2], at[3]), -sign);
        assert_int_equal(orient3(at[3], at[0], at[1], at[2]), -sign); /* an odd permutation */
        zeros += sign == 0;
        doubtful += sign != (rounded > 0) - (rounded < 0);
    }
    print_message("%d in one plane, %d whose sign doubles get wrong\n", zeros, doubtful);
    assert_true(zeros > 10000 && doubtful > 10000);
}

/* ---- ellipsoids in a scene ---- */

/* A rotation by three turns about the axes, and its quaternion, of halves of their angles. */
static void turn_by(const double angles[3], double rotation[3][3], double q[4]) {
    double whole[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    q[0] = 1;
    q[1] = q[2] = q[3] = 0;
    for (int axis = 0; axis < 3; axis++) {
        const int x = (axis + 1) % 3, y = (axis + 2) % 3;
        const double c = cos(angles[axis]), s = sin(angles[axis]), ch = cos(angles[axis] / 2),
                     sh = sin(angles[axis] / 2);
        for (int k = 0; k < 3; k++) {
            const double u = whole[x][k], v = whole[y][k];
            whole[x][k] = c * u - s * v;
            whole[y][k] = s * u + c * v;
        }
        /* (ch + sh e) q, by Hamilton's rules */
        const double w = q[0], e = q[1 + axis], f = q[1 + x], g = q[1 + y];
        q[0] = ch * w - sh * e;
        q[1 + axis] = ch * e + sh * w;
        q[1 + x] = ch * f - sh * g;
        q[1 + y] = ch * g + sh * f;
    }
    memcpy(rotation, whole, sizeof whole);
}

/* One frame of so many ellipsoids as a scene. */
static BpScene *scene_of(BpParticles *particles) {
    BpParticleStyle *const style = malloc(sizeof *style);
    BpScene *scene = NULL;
    assert_int_equal(bp_scene_create_empty("test", &scene, NULL), BP_OK);
    scene->materials = calloc(1, sizeof *scene->materials);
    scene->materials[0].kind = BP_MATERIAL_LAMBERTIAN;
    scene->material_count = 1;
    bp_particle_style_defaults(style);
    style->color_by = BP_COLOR_CONSTANT;
    assert_int_equal(bp_particles_add_to_scene(particles, style, false, 0, scene, NULL, 0, NULL, NULL),
                     BP_OK);
    bp_particle_style_clear(style);
    free(style);
    return scene;
}

/* Volume, centre and moments; the equation of the ellipsoid and its gradient at each vertex; no open edge. */
static void ellipsoids_are_what_they_should_be(void **unused) {
    (void)unused;
    for (int round = 0; round < 60; round++) {
        const size_t count = round % 6 == 5 ? 4000 : 1;
        BpParticles particles = {.count = count, .up = 1};
        double axes[3], angles[3], rotation[3][3], q[4], center[3], moments[3][3];
        for (int i = 0; i < 3; i++) {
            axes[i] = exp(4 * bp_random_next(&generator) - 2);
            angles[i] = 6 * bp_random_next(&generator);
            center[i] = 20 * bp_random_next(&generator) - 10;
        }
        turn_by(angles, rotation, q);
        particles.position = calloc(count, sizeof *particles.position);
        particles.tag = calloc(count, sizeof *particles.tag);
        particles.body = calloc(count, sizeof *particles.body);
        particles.radius = calloc(count, sizeof *particles.radius);
        for (size_t i = 0; i < count; i++) {
            memcpy(particles.position[i], center, sizeof center);
            particles.position[i][0] += 100 * (double)i;
            particles.body[i].kind = BP_BODY_ELLIPSOID;
            particles.radius[i] = (float)cbrt(axes[0] * axes[1] * axes[2]);
            for (int k = 0; k < 3; k++) particles.body[i].half_axes[k] = (float)axes[k];
            for (int k = 0; k < 4; k++) particles.body[i].orientation[k] = (float)q[k];
        }
        BpScene *scene = scene_of(&particles);
        const size_t each = scene->triangle_count / count;
        assert_int_equal(each, count == 1 ? 11520 : 500);
        Geodesic sphere;
        assert_int_equal(geodesic_create(count == 1 ? 24 : 5, &sphere, NULL), BP_OK);
        const double error = sphere.error;
        geodesic_clear(&sphere);
        double(*at)[3][3] = malloc(each * sizeof *at), (*places)[3] = malloc(3 * each * sizeof *places);
        uint32_t(*faces)[3] = malloc(each * sizeof *faces);
        const size_t first = (count - 1) * each; /* the last particle */
        center[0] += 100 * (double)(count - 1);
        for (size_t t = 0; t < each; t++)
            for (int k = 0; k < 3; k++) {
                const double *const vertex = scene->triangles[first + t].vertices[k];
                const float *const normal = scene->normals[first + t][k];
                double body[3] = {0}, gradient[3] = {0}, value = 0, cosine = 0, length = 0, unit = 0;
                faces[t][k] = (uint32_t)(3 * t) + (uint32_t)k;
                memcpy(places[3 * t + (size_t)k], vertex, sizeof places[0]);
                for (int i = 0; i < 3; i++) at[t][k][i] = vertex[i] - center[i];
                for (int i = 0; i < 3; i++) {
                    for (int j = 0; j < 3; j++) body[i] += rotation[j][i] * at[t][k][j];
                    value += body[i] * body[i] / (axes[i] * axes[i]);
                }
                for (int i = 0; i < 3; i++) {
                    for (int j = 0; j < 3; j++) gradient[i] += rotation[i][j] * body[j] / (axes[j] * axes[j]);
                    cosine += gradient[i] * (double)normal[i];
                    length += gradient[i] * gradient[i];
                    unit += (double)normal[i] * (double)normal[i];
                }
                assert_true(sqrt(value) > 1 && sqrt(value) < 1 + error + 1e-5);
                assert_near(cosine / sqrt(length), 1, 1e-6);
                assert_near(unit, 1, 1e-6);
            }
        assert_closed(places, 3 * each, faces, each);
        const double volume = 4 * PI / 3 * axes[0] * axes[1] * axes[2];
        assert_near(moments_of((const double(*)[3][3])at, each, moments) / volume, 1, 1e-6);
        const double largest = fmax(axes[0], fmax(axes[1], axes[2]));
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                double expected = 0;
                for (int j = 0; j < 3; j++)
                    expected += rotation[i][j] * rotation[k][j] * axes[j] * axes[j] / 5;
                assert_near(moments[i][k] / volume, expected, error * largest * largest / 5);
            }
        assert_int_equal(scene->albedo_count, 1); /* one colour for all */
        free(at);
        free(places);
        free(faces);
        bp_particles_clear(&particles);
        bp_scene_destroy(&scene);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_of_all_finenesses), cmocka_unit_test(hulls_hold_all_points),
        cmocka_unit_test(sides_are_exact), cmocka_unit_test(ellipsoids_are_what_they_should_be)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
