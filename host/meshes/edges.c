/* edges.c: whether a mesh is closed and consistently wound; see mesh.h. */
#include "mesh.h"
#include "weld.h"

#include "base/words.h"

#include <stdlib.h>

/* What is known of an edge between two places: how often faces go along it, from the lower number to the
 * higher one and back. */
typedef struct Edge {
    uint32_t low, high; /* equal: this slot is free */
    uint32_t forward, backward;
} Edge;

static size_t slot_of(uint32_t low, uint32_t high, size_t mask) {
    uint64_t hash = ((uint64_t)low << 32 | high) * UINT64_C(0x9e3779b97f4a7c15);
    return (size_t)(hash >> 20 ^ hash >> 43) & mask;
}

static Edge *find(Edge *edges, size_t mask, uint32_t a, uint32_t b) {
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    size_t slot = slot_of(low, high, mask);
    while (edges[slot].low != edges[slot].high && (edges[slot].low != low || edges[slot].high != high))
        slot = (slot + 1) & mask;
    edges[slot].low = low;
    edges[slot].high = high;
    return &edges[slot];
}

static BpMeshEdgeFault fault_of(const Edge *edge) {
    if (edge->forward + edge->backward == 1) return BP_MESH_EDGE_OPEN;
    if (edge->forward + edge->backward > 2) return BP_MESH_EDGE_SHARED;
    return edge->forward == 1 ? BP_MESH_EDGE_GOOD : BP_MESH_EDGE_TURNED;
}

#define FAULT_TEXTS(X)                                                                                       \
    X(BP_MESH_EDGE_GOOD, "it is closed")                                                                     \
    X(BP_MESH_EDGE_OPEN, "one face alone has this edge")                                                     \
    X(BP_MESH_EDGE_SHARED, "three faces or more have this edge")                                             \
    X(BP_MESH_EDGE_TURNED, "its two faces are wound against each other")
BP_WORDS(BpMeshEdgeFault, static const char *const fault_texts, FAULT_TEXTS);

const char *bp_mesh_edge_fault_text(BpMeshEdgeFault fault) {
    return fault_texts[fault];
}

static void count(const BpMesh *mesh, const uint32_t *place, Edge *edges, size_t mask) {
    for (size_t f = 0; f < mesh->face_count; f++) {
        for (int i = 0; i < 3; i++) {
            const uint32_t a = place[mesh->faces[f][i]], b = place[mesh->faces[f][(i + 1) % 3]];
            Edge *const edge = find(edges, mask, a, b);
            if (a < b)
                edge->forward++;
            else
                edge->backward++;
        }
    }
}

BpStatus bp_mesh_find_open_edge(const BpMesh *mesh, BpMeshEdge *edge, BpError *err) {
    size_t size = 16;
    while (size < 4 * mesh->face_count) size *= 2; /* three edges a face at most: some slots stay free */
    *edge = (BpMeshEdge){.fault = BP_MESH_EDGE_GOOD};
    uint32_t *const place = malloc((mesh->vertex_count + 1) * sizeof *place);
    Edge *const edges = calloc(size, sizeof *edges);
    BpStatus status = place == NULL || edges == NULL
                          ? bp_fail(err, BP_ERR_MEMORY, "out of memory for the edges of a mesh")
                          : weld_places((const double(*)[3])mesh->positions, mesh->vertex_count, place, err);
    if (status == BP_OK) count(mesh, place, edges, size - 1);
    for (size_t f = 0; status == BP_OK && f < mesh->face_count && edge->fault == BP_MESH_EDGE_GOOD; f++) {
        for (int i = 0; i < 3 && edge->fault == BP_MESH_EDGE_GOOD; i++) {
            const uint32_t a = mesh->faces[f][i], b = mesh->faces[f][(i + 1) % 3];
            const BpMeshEdgeFault fault = fault_of(find(edges, size - 1, place[a], place[b]));
            if (fault != BP_MESH_EDGE_GOOD)
                *edge = (BpMeshEdge){.fault = fault, .vertices = {a, b}, .face = (uint32_t)f};
        }
    }
    free(place);
    free(edges);
    return status;
}
