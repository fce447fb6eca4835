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
                assert_near(moments[i][k], i == k ? 4 * PI / 15 : 0, i == k ? 2 * sphere.error : 1e-12);
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

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(spheres_of_all_finenesses),
                                       cmocka_unit_test(hulls_hold_all_points),
                                       cmocka_unit_test(sides_are_exact)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
