/* mesh_triangles.h: a mesh becomes triangles of a scene.
 *
 * In:    a mesh, where it stands, its materials in the scene.   Out: triangles, after all others; a note.
 * Knows: what light that passes through asks of a mesh.   Does not know: where the mesh comes from. */
#ifndef BP_FORMATS_MESH_TRIANGLES_H
#define BP_FORMATS_MESH_TRIANGLES_H

#include "meshes/mesh.h"
#include "scene/placement.h"
#include "scene/scene.h"

typedef struct BpMeshUse {
    const char *name; /* what messages and notes call it */
    BpPlacement placement;
    uint32_t
        material; /* of faces that none of `materials` is for, into the scene's; UINT32_MAX: there is none */
    bool smooth;  /* by the mesh's normals, or by those of its faces where it has none */
    uint32_t interior;         /* of faces that light passes through, as that of a sphere; 0: none */
    const uint32_t *materials; /* Optional: for each of the mesh's own, one of the scene's, or UINT32_MAX */
} BpMeshUse;

/* Finds the first edge at which the faces of one material, into the scene's, are not closed or not
 * consistently wound. BP_ERR_MEMORY is the only error. */
BpStatus bp_mesh_find_part_edge(const BpMesh *mesh, const BpMeshUse *use, uint32_t material, BpMeshEdge *edge,
                                BpError *err);

/* Adds the mesh's faces to the scene's triangles, which have its colours where their material has an albedo,
 * and a note. The mesh's positions are then those in the scene. Fails with BP_ERR_SCENE on glass that is not
 * closed, on an interior where light passes through no face, on faces without a material, and on too many
 * triangles. */
BpStatus bp_mesh_add_triangles(BpMesh *mesh, const BpMeshUse *use, BpScene *scene, BpError *err);

#endif
