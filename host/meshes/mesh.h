/* mesh.h: files of meshes, and the one form in which all of them are handed over.
 *
 * In:    a path, or an open file.   Out: vertices, triangles, their materials and colours; the first edge
 * that is not closed. Knows: which formats there are.   Does not know: scenes, how a mesh is placed and
 * traced.
 *
 * Formats: PLY with faces, OBJ with MTL, STL, OFF, glTF; each also packed by gzip. Nothing in a file is
 * trusted: memory grows with what was read and never with what a count promises, and every error names the
 * file, and the line where there are lines. Coordinates are as written, in the file's unit of length. */
#ifndef BP_MESHES_MESH_H
#define BP_MESHES_MESH_H

#include "base/status.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* At most so many vertices, and as many triangles. */
#define BP_MESH_COUNT_MAX 134217728u
/* Coordinates are finite and at most so large, so that products of them are finite. */
#define BP_MESH_COORDINATE_MAX 1e100
/* In face_material: the face has none. */
#define BP_MESH_NO_MATERIAL UINT32_MAX

/* A material by name, and what the file or its MTL file says of it: an offer to whoever has no material of
 * that name. */
typedef struct BpMeshMaterial {
    char *name;        /* owned by the mesh */
    size_t face_count; /* triangles that have it; 0: no face uses it */
    bool has_kd, has_ke, has_ni, has_d, has_surface;
    double kd[3],
        ke[3];    /* linear red, green and blue: diffuse reflectance, emitted radiance; finite, from 0 */
    double ni, d; /* index of refraction, above 0; opacity in [0, 1] */
    double metallic, roughness; /* of glTF, in [0, 1] */
    /* The image that lies on its faces, multiplied by kd: a file, relative to the mesh, of the heap, or NULL;
     * or one inside of a glTF file, counted from 1, or 0. */
    char *image_file;
    uint32_t image_inside;
    bool image_clamped; /* it appears once, and its edges go on */
} BpMeshMaterial;

typedef struct BpMesh {
    double (*positions)[3];
    size_t vertex_count;
    uint32_t (
        *faces)[3]; /* triangles of three different vertices and an area above 0, wound as in the file */
    size_t face_count;
    uint32_t *face_material; /* Optional; an index into materials, or BP_MESH_NO_MATERIAL */
    BpMeshMaterial *materials;
    size_t material_count;
    /* Optional: all vertices, or all faces, have one; grey where the file lacks it. Linear red, green and
     * blue in [0, 1]: bytes of files are decoded as sRGB. */
    float (*vertex_colors)[3], (*face_colors)[3];
    float (*face_normals)[3][3]; /* Optional: at the corners of each face, as in the file: not of unit length,
                                    zeros where one is missing */
    float (*face_coordinates)[6]; /* Optional: u and v, which grows upwards, at one corner of each face after
                                     the other; NaN at all of them where one is missing */
    size_t polygons;              /* faces of the file with more than three corners, which were cut */
    size_t dropped_degenerate;    /* triangles, whole or of polygons, without area or with a corner twice */
    size_t welded;   /* vertices (of STL) that were equal to an earlier one, and became that one */
    char notes[480]; /* what was guessed or passed over: "3 lines left out; ..." */
} BpMesh;

/* Whether name and contents tell of a mesh, also of one in a format that bp_mesh_read() only refuses by name
 * (FBX). A PLY file is a mesh if it has faces. False if the file cannot be read. */
bool bp_mesh_is_file(const char *path);

/* Reads a regular file into *mesh, which need not be initialised; release it with bp_mesh_clear(). MTL files
 * are sought beside it. Polygons become triangles: convex ones by a fan from their first corner, others by
 * ear clipping. Fails with BP_ERR_SCENE on what is damaged or unsupported, with file and line. May be called
 * by several threads at once. */
BpStatus bp_mesh_read(const char *path, BpMesh *mesh, BpError *err);
/* The same of an open file with a descriptor, which stays open; `path` names it and tells its format. */
BpStatus bp_mesh_read_stream(FILE *stream, const char *path, BpMesh *mesh, BpError *err);
void bp_mesh_clear(BpMesh *mesh);

/* Reads image number `number`, counted from 0, that lies inside of a glTF file: the bytes of a PNG, say. The
 * caller frees *bytes. Fails with BP_ERR_SCENE where the file is no glTF or has no such image. */
BpStatus bp_mesh_read_image(FILE *stream, const char *path, size_t number, unsigned char **bytes,
                            size_t *length, BpError *err);

typedef enum BpMeshEdgeFault {
    BP_MESH_EDGE_GOOD,   /* every edge has two faces, which go along it in opposite directions */
    BP_MESH_EDGE_OPEN,   /* one face has the edge */
    BP_MESH_EDGE_SHARED, /* three faces or more have it */
    BP_MESH_EDGE_TURNED  /* two have it, and go along it in the same direction */
} BpMeshEdgeFault;

typedef struct BpMeshEdge {
    BpMeshEdgeFault fault;
    uint32_t vertices[2]; /* in the direction of the face */
    uint32_t face;        /* the first face with a bad edge */
} BpMeshEdge;

/* Finds the first edge, by faces, at which the mesh is not closed or not consistently wound. Vertices at one
 * place (0 and -0 are the same) count as one. BP_ERR_MEMORY is the only error. */
BpStatus bp_mesh_find_open_edge(const BpMesh *mesh, BpMeshEdge *edge, BpError *err);
/* What that fault is, for messages: "no second face has it". Static. */
const char *bp_mesh_edge_fault_text(BpMeshEdgeFault fault);

#endif
