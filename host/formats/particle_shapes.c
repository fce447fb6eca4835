/* particle_shapes.c: see particle_shapes.h. */
#include "particle_shapes.h"

#include "base/message_text.h"
#include "meshes/mesh.h"
#include "meshes/polygon.h"

#include <stdlib.h>
#include <string.h>

static BpStatus fail_face(const BpParticleShape *shape, size_t face, const char *text, BpError *err) {
    char shown[64];
    bp_printable(shape->type, shown, sizeof shown);
    return bp_fail(err, BP_ERR_SCENE, "the shape of the type \"%s\": face %zu (from 0): %s", shown, face,
                   text);
}

static BpStatus keep_triangles(const PolygonCutter *cutter, BpParticleShape *shape, size_t *capacity,
                               BpError *err) {
    const size_t count = shape->triangle_count + cutter->triangle_count;
    if (count > *capacity || shape->triangles == NULL) {
        *capacity = 2 * count + 16;
        uint32_t(*grown)[3] = realloc(shape->triangles, *capacity * sizeof *grown);
        if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu triangles", count);
        shape->triangles = grown;
    }
    if (cutter->triangle_count > 0)
        memcpy(shape->triangles + shape->triangle_count, cutter->triangles,
               cutter->triangle_count * sizeof *cutter->triangles);
    shape->triangle_count = count;
    return BP_OK;
}

static BpStatus cut_shape(PolygonCutter *cutter, BpParticleShape *shape, BpError *err) {
    size_t capacity = 0, begin = 0;
    char shown[64];
    for (size_t f = 0; f < shape->face_count; begin = shape->ends[f++]) {
        switch (polygon_cut(cutter, (const double(*)[3])shape->vertices, shape->corners + begin,
                            shape->ends[f] - begin)) {
        case POLYGON_CUT:
            BP_TRY(keep_triangles(cutter, shape, &capacity, err));
            break;
        case POLYGON_CROSSES:
            return fail_face(shape, f, "found an outline that crosses itself, expected a simple polygon",
                             err);
        case POLYGON_TOO_LARGE:
            return fail_face(shape, f, "found more corners than a polygon may have that is not convex", err);
        case POLYGON_NO_MEMORY:
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for a polygon");
        }
    }
    bp_printable(shape->type, shown, sizeof shown);
    if (shape->triangle_count == 0)
        return bp_fail(err, BP_ERR_SCENE,
                       "the shape of the type \"%s\": found no face with an area, expected one", shown);
    const BpMesh mesh = {.positions = shape->vertices,
                         .vertex_count = shape->vertex_count,
                         .faces = shape->triangles,
                         .face_count = shape->triangle_count};
    BpMeshEdge edge;
    BP_TRY(bp_mesh_find_open_edge(&mesh, &edge, err));
    shape->closed = edge.fault == BP_MESH_EDGE_GOOD;
    return BP_OK;
}

BpStatus bp_cut_particle_shapes(BpParticles *particles, BpError *err) {
    PolygonCutter cutter = {0};
    BpStatus status = BP_OK;
    for (size_t s = 0; s < particles->shape_count && status == BP_OK; s++)
        if (particles->shapes[s].capsule_radius == 0) status = cut_shape(&cutter, &particles->shapes[s], err);
    polygon_clear(&cutter);
    return status;
}
