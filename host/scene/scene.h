/* scene.h: the scene as its author wrote it, in doubles, validated.
 *
 * In:    what a reader of documents, a generator or a caller's arrays fill in.   Out: a valid BpScene.
 * Knows: the grammar's terms.   Does not know: how documents are read (it keeps a few parts of them as
 * texts), OpenCL, packed data.
 *
 * Invariants of every BpScene that reaches another module (bp_scene_validate proves them): all numbers are
 * finite; radius != 0 (negative: inside out); indices of materials and textures in range; albedo in [0,1];
 * emit >= 0; 0 <= fuzz <= 1; refraction_index > 0; of discs a direction, and half angles from 1e-4 to 90
 * degrees; centers when the shutter closes like those when it opens; 0 < vfov < 180, and the size of the
 * plane in focus fits a float; lookfrom != lookat; vup not parallel to the view; 1 <= width, height <=
 * BP_PICTURE_SIDE_MAX; no two coincident dielectrics; a pinhole camera on the surface of at most one sphere;
 * of triangles what triangle_rules.h lists, of capsules what capsule_rules.h does, and of bodies what
 * body_rules.h does.
 */
#ifndef BP_SCENE_SCENE_H
#define BP_SCENE_SCENE_H

#include "ballpark.h"
#include "bodies.h"
#include "figure/figure.h"
#include "image/texels.h"
#include "material.h"
#include "medium.h"
#include "texture.h"

#include <math.h>
#include <stdio.h>

#define BP_PICTURE_SIDE_MAX 65535u
#define BP_DEPTH_MAX 1000000u
#define BP_SPHERES_MAX 134217728u   /* 2^27 */
#define BP_COORDINATE_MAX 1.0e12    /* |centre|, |radius|, |lookfrom|: squares stay finite in float */
#define BP_VERTEX_MAX 1.0e9         /* of triangles: products of four lengths stay finite in float */
#define BP_TRIANGLE_SIDE_MIN 1.0e-9 /* and those of their longest sides normal */
#define BP_CAPSULE_RADIUS_MIN 1.0e-12
#define BP_CAPSULE_LENGTH_MIN                                                                                \
    1.0e-15 /* a shorter capsule is a sphere: the square of its length stays normal in float */
#define BP_REFRACTION_INDEX_MAX 1.0e6 /* and at least its reciprocal */
#define BP_FOCUS_DIST_MIN 1.0e-15     /* rays begin as vectors of this length: squares stay normal in float */
#define BP_HALF_HEIGHT_MAX 1.0e14     /* of the plane in focus; it is up to 65,535 times as wide */
#define BP_DISCS_MAX 32u
#define BP_HALF_ANGLE_MIN 1.0e-4 /* degrees: directions in float are 3e-6 degrees apart */
#define BP_NO_ALBEDO UINT32_MAX

typedef enum BpScatter { BP_SCATTER_LAMBERTIAN, BP_SCATTER_COSINE_CUBED, BP_SCATTER_HEMISPHERE } BpScatter;
typedef enum BpFuzzShape { BP_FUZZ_SPHERE, BP_FUZZ_BALL } BpFuzzShape;
typedef enum BpFresnel { BP_FRESNEL_SCHLICK, BP_FRESNEL_EXACT, BP_FRESNEL_NONE } BpFresnel;
typedef enum BpTotalReflection { BP_TOTAL_REFLECT, BP_TOTAL_ABSORB, BP_TOTAL_REFRACT } BpTotalReflection;
typedef enum BpPixelSampling { BP_PIXEL_SQUARE, BP_PIXEL_CENTER } BpPixelSampling;

struct BpMaterial {
    char *name;
    BpMaterialKind kind;
    uint32_t texture[BP_MEMBER_COUNT]; /* of a member that varies, into textures[], counted from 1; 0: none.
                                          The member itself is then the largest value that its texture has */
    double albedo[3];                  /* of kinds that have one */
    double emit[3];                    /* any kind; (0,0,0): does not emit */
    BpScatter scatter;
    double fuzz;
    BpFuzzShape fuzz_shape;
    double roughness;        /* of kinds that have one */
    double refraction_index; /* of the inside over the outside */
    double opacity;          /* 0: the document says nothing, which is 1 (bp_material_opacity) */
    BpFresnel fresnel;
    BpTotalReflection total_reflection;
};

static inline bool bp_material_emits(const BpMaterial *material) {
    return material->emit[0] > 0 || material->emit[1] > 0 || material->emit[2] > 0;
}

typedef struct BpSphere {
    double center[3];
    double radius;     /* < 0: inside out */
    uint32_t material; /* into materials[] */
    uint32_t albedo;   /* into albedos[], replacing the material's; or BP_NO_ALBEDO */
} BpSphere;

/* Its vertices run counter-clockwise, seen from outside. */
typedef struct BpTriangle {
    double vertices[3][3];
    uint32_t material; /* into materials[] */
    uint32_t albedo;   /* as of a sphere */
} BpTriangle;

/* All points within the radius of the line between its ends. */
typedef struct BpCapsule {
    double ends[2][3];
    double radius;      /* > 0 */
    uint32_t material;  /* into materials[] */
    uint32_t albedo[2]; /* of the halves by its ends; as of a sphere, both or none */
} BpCapsule;

#define BP_QUAD_TRIANGLES 2u
#define BP_BOX_TRIANGLES 12u

/* The spheres to which a camera is fitted (fit.h), instead of being placed by lookfrom and lookat. */
typedef enum BpFit { BP_FIT_NONE, BP_FIT_SCENE, BP_FIT_PARTICLES } BpFit;

/* A direction by its name (fit.h). */
typedef enum BpView {
    BP_VIEW_NONE, /* a direction, not a name */
    BP_VIEW_THREE_QUARTER,
    BP_VIEW_FRONT,
    BP_VIEW_BACK,
    BP_VIEW_LEFT,
    BP_VIEW_RIGHT,
    BP_VIEW_TOP,
    BP_VIEW_BOTTOM,
    BP_VIEW_COUNT
} BpView;

typedef enum BpProjection { BP_PERSPECTIVE, BP_ORTHOGRAPHIC } BpProjection;

typedef struct BpCamera {
    uint32_t width, height;
    double aspect_ratio; /* as given; height follows from width by it */
    uint32_t samples_per_pixel, max_depth;
    BpProjection projection;
    double vfov_degrees; /* of the full picture height */
    double view_height;  /* of BP_ORTHOGRAPHIC: how much the picture's height shows; 0: as much as vfov shows
                            at lookat */
    double lookfrom[3], lookat[3], vup[3];
    double lens_radius; /* aperture / 2, or focus_dist * tan(defocus_angle / 2); 0: pinhole */
    double focus_dist;  /* along the view, from lookfrom to the plane in focus; > 0 */
    BpPixelSampling pixel_sampling;
    /* How lookfrom, lookat and focus_dist were found, to be written again; nothing else depends on it. */
    BpFit fit;
    BpView view;
    double view_direction[3]; /* with BP_VIEW_NONE: from the spheres to the camera */
    double margin;            /* share of width and height that is left free at each side */
    double fit_vup[3];        /* as given; 0: by the particles' format */
} BpCamera;

/* A disc in the sky, a lamp at infinity: adds its radiance to that of the background in a cone of directions.
 */
typedef struct BpDisc {
    double direction[3];       /* to its middle, of any length */
    double half_angle_degrees; /* from there to its rim */
    double radiance[3];
    bool visible_to_camera; /* camera rays see it; scattered ones always do */
} BpDisc;

/* What camera rays that meet nothing show. All other rays that meet nothing show the background. */
typedef enum BpBackdrop {
    BP_BACKDROP_SKY,    /* the background too */
    BP_BACKDROP_COLORS, /* a colour, or a gradient over the picture's height */
    BP_BACKDROP_NONE    /* nothing: black, and the picture has an alpha */
} BpBackdrop;

/* A plane that only camera rays meet, from above, and that shows nothing but the shadow on it. */
typedef struct BpShadowCatcher {
    bool present, has_height;
    double up[3];               /* of any length; 0: the scene's */
    double height;              /* along `up`, of length 1; else it lies under the lowest sphere */
    double normal[3], distance; /* what follows: of length 1; of its points along the normal */
} BpShadowCatcher;

/* Light by its name, which stands in the camera's frame (lighting.h). */
typedef enum BpLighting {
    BP_LIGHTING_SKY, /* none: the background as the scene has it */
    BP_LIGHTING_SOFT,
    BP_LIGHTING_STUDIO,
    BP_LIGHTING_REMBRANDT,
    BP_LIGHTING_OVERHEAD,
    BP_LIGHTING_COUNT
} BpLighting;

/* A file of shapes: those from `first` on, up to the next file's or the end. Of a cloud one sphere a vertex;
 * of particles those that are shown, of which bonds and cells are capsules; of a mesh triangles. */
typedef struct BpShapeFile {
    char *file; /* as the scene names it */
    size_t first;
    char *entry;       /* NULL for a cloud; else that of "particles" or "meshes", as JSON */
    bool in_memory;    /* no file: a set that the caller handed over, whose name `file` is */
    bool of_particles; /* among meshes: particles of this file that are no spheres */
} BpShapeFile;

struct BpScene {
    char *path; /* where it came from, for messages */
    char *title, *source;
    BpCamera camera;
    BpLighting lighting;                            /* that the background was made by */
    double background_bottom[3], background_top[3]; /* down and up; linear in between */
    double background_up[3];                        /* which way up is, of any length; 0: the y axis */
    BpImage *environment;    /* in place of bottom and top, which are then black: one of images[], or NULL */
    double environment_turn; /* degrees about `up`, counter-clockwise seen from its tip */
    BpDisc discs[BP_DISCS_MAX]; /* where they overlap, they add up */
    size_t disc_count;
    BpBackdrop backdrop;
    double backdrop_bottom[3],
        backdrop_top[3]; /* of BP_BACKDROP_COLORS: at the picture's lower and upper edge */
    BpShadowCatcher shadow_catcher;
    BpTransfer transfer;
    BpImage **images; /* of textures and the background, each file once */
    size_t image_count;
    BpTexture *textures;
    size_t texture_count;
    BpMedium *media;
    size_t medium_count;
    uint32_t medium; /* the whole scene lies in it: into media[], counted from 1; 0: none */
    BpMaterial *materials;
    size_t material_count;
    BpSphere *spheres;
    size_t sphere_count;
    double (*center_ends)[3]; /* of the first moving_count spheres: the centre when the shutter closes */
    size_t moving_count;      /* 0: no sphere moves */
    uint32_t *interiors; /* of the first interior_count spheres: what fills them, counted as `medium` is */
    size_t interior_count;
    uint32_t *triangle_interiors, *capsule_interiors; /* the same of the first triangles and capsules */
    size_t triangle_interior_count, capsule_interior_count;
    BpBodies bodies;       /* of the triangles that are boundaries of media */
    BpTriangle *triangles; /* those that are listed, then those of quads, of boxes and of meshes */
    size_t triangle_count, quad_count, box_count;
    float (*normals)[3][3]; /* of the first normal_count triangles: at the vertices, of unit length, on either
                               side; all 0: the triangle is flat */
    size_t normal_count;
    float (
        *coordinates)[6]; /* of the first coordinate_count triangles: u and v at one vertex after the other,
                             by which textures lie on them, at most BP_UV_MAX either way; NaN: none */
    size_t coordinate_count;
    BpCapsule *capsules;
    size_t capsule_count,
        listed_capsules;    /* those that are not listed come from "particles" and sets of lines */
    BpShapeFile *line_sets; /* in the order of their capsules, all of them in memory */
    size_t line_set_count;
    BpShapeFile *mesh_files; /* in the order of their triangles */
    size_t mesh_file_count;
    float (*albedos)[3]; /* linear, in [0,1]; of points and triangles that bring their own colour */
    size_t albedo_count;
    BpShapeFile *point_files; /* in the order of their spheres, which follow all others */
    size_t point_file_count;
    size_t particle_first;    /* the spheres from here on come from "particles"; with sphere_count 0: 0 */
    size_t implicit_material; /* of particles that name none: into materials[]; SIZE_MAX: there is none */
    bool has_particles;
    BpFigure figure; /* its bar is of the last particles that ask for one */
    bool has_color_range;
    double color_range[2]; /* of the column that gives the last particles' colours */
    int up;                /* the axis that the particles' world has up: 1 y, 2 z */
    bool flat;             /* the particles lie in a plane: two dimensions */
    char *notes;           /* readable lines about what was guessed; "" */
};

/* The unit vector along which the background rises from bottom to top. */
void bp_background_up(const BpScene *scene, double up[3]);
/* The map by which an environment surrounds the scene, unit vectors: to its left and right edge, `seam`; a
 * quarter of its width to the right of the left edge, `east`; to its top, `pole`. With `up` [0, 1, 0] and no
 * turn its middle is at -z, and its right half at x. Another `up` tilts that the shortest way. */
void bp_environment_frame(const BpScene *scene, double seam[3], double east[3], double pole[3]);

/* The height of the part of the plane in focus that the picture shows, in the scene's unit. */
double bp_camera_plane_height(const BpCamera *camera);
/* The origin of the space in which rays are traced: the position of a perspective camera. For an orthographic
 * camera, the plane through lookfrom, on which rays begin, is moved forward until it is within one picture
 * height of the nearest sphere. Returns the distance by which it is moved, which takes a loop over all
 * spheres. */
double bp_camera_origin(const BpScene *scene, double origin[3]);

/* height = max(1, floor(width / aspect + 1e-6)) */
uint32_t bp_camera_height(uint32_t width, double aspect_ratio);
/* The greatest width at which a picture has at most so many pixels; 0: there is none. */
uint32_t bp_camera_width_of(uint64_t pixels, double aspect_ratio);

/* The fourth edition's camera, all by default. */
void bp_camera_defaults(BpCamera *camera);
/* The radius of a lens whose cone of rays has this angle at the point in focus. */
double bp_lens_radius(double defocus_degrees, double focus_dist);

/* Copies a string; NULL becomes "". */
BpStatus bp_copy_text(const char *text, char **copy, BpError *err);
/* Adds the line "FILE: TEXT" to the scene's notes. BP_ERR_MEMORY. */
BpStatus bp_scene_note(BpScene *scene, const char *file, const char *text, BpError *err);
/* A scene that holds nothing but defaults. */
BpStatus bp_scene_create_empty(const char *path, BpScene **scene, BpError *err);

#define BP_SPHERE_NAME_SIZE 128
/* How a message names a sphere: "spheres[3]", or "vertex 12 (from 0) of points.ply". Returns `text`. */
const char *bp_sphere_name(const BpScene *scene, size_t sphere, char text[BP_SPHERE_NAME_SIZE]);

/* The same of a triangle: "triangles[3]", or "quads[0]" or "boxes[1]", which it is part of, or "triangle 12
 * (from 0) of bunny.ply", counted without those that were left out. */
const char *bp_triangle_name(const BpScene *scene, size_t triangle, char text[BP_SPHERE_NAME_SIZE]);

/* The same of a capsule, "line 3 (from 0) of bonds" where it comes from a set, and of any shape. */
const char *bp_capsule_name(const BpScene *scene, size_t capsule, char text[BP_SPHERE_NAME_SIZE]);
const char *bp_shape_name(const BpScene *scene, size_t shape, char text[BP_SPHERE_NAME_SIZE]);

/* The triangles that stand in the scene itself; those of meshes follow. */
size_t bp_scene_listed_triangles(const BpScene *scene);
/* Those of particles, from *first up to *end. */
void bp_scene_particle_triangles(const BpScene *scene, size_t *first, size_t *end);

/* Shapes are the spheres, then the triangles, then the capsules: how many, one of them, or NULL where the
 * shape is another, the material of one, into materials[], its own albedo, into albedos[], or
 * BP_NO_ALBEDO, of a capsule that of its first half, and whether it emits. */
static inline size_t bp_scene_shapes(const BpScene *scene) {
    return scene->sphere_count + scene->triangle_count + scene->capsule_count;
}
static inline const BpCapsule *bp_shape_capsule(const BpScene *scene, size_t shape) {
    const size_t others = scene->sphere_count + scene->triangle_count;
    return shape >= others ? &scene->capsules[shape - others] : NULL;
}
static inline uint32_t bp_shape_material(const BpScene *scene, size_t shape) {
    if (shape < scene->sphere_count) return scene->spheres[shape].material;
    const BpCapsule *const capsule = bp_shape_capsule(scene, shape);
    return capsule != NULL ? capsule->material : scene->triangles[shape - scene->sphere_count].material;
}
static inline uint32_t bp_shape_albedo(const BpScene *scene, size_t shape) {
    if (shape < scene->sphere_count) return scene->spheres[shape].albedo;
    const BpCapsule *const capsule = bp_shape_capsule(scene, shape);
    return capsule != NULL ? capsule->albedo[0] : scene->triangles[shape - scene->sphere_count].albedo;
}
static inline bool bp_shape_emits(const BpScene *scene, size_t shape) {
    return bp_material_emits(&scene->materials[bp_shape_material(scene, shape)]);
}
/* The normals at a triangle's vertices; NULL: it is flat. */
static inline const float (*bp_triangle_normals(const BpScene *scene, size_t triangle))[3] {
    if (triangle >= scene->normal_count) return NULL;
    const float(*const normals)[3] = (const float(*)[3])scene->normals[triangle];
    for (int k = 0; k < 3; k++)
        if (normals[k][0] != 0 || normals[k][1] != 0 || normals[k][2] != 0) return normals;
    return NULL;
}
/* Makes room for the normals of `count` triangles in all; those that are new are 0. BP_ERR_MEMORY. */
BpStatus bp_scene_make_normals(BpScene *scene, size_t count, BpError *err);
/* The same of the interiors of spheres, triangles or capsules: an array of the scene and its count. */
BpStatus bp_make_interiors(size_t count, uint32_t **interiors, size_t *interior_count, BpError *err);

/* The texture coordinates at a triangle's vertices, six numbers; NULL: it has none. */
static inline const float *bp_triangle_coordinates(const BpScene *scene, size_t triangle) {
    if (triangle >= scene->coordinate_count || isnan(scene->coordinates[triangle][0])) return NULL;
    return scene->coordinates[triangle];
}
/* Makes room for the texture coordinates of `count` triangles in all; those that are new have none.
 * BP_ERR_MEMORY. */
BpStatus bp_scene_make_coordinates(BpScene *scene, size_t count, BpError *err);

/* Whether a texture of the material lies on surfaces, instead of filling space. */
bool bp_material_is_mapped(const BpScene *scene, const BpMaterial *material);
/* On how many triangles a texture lies. */
size_t bp_scene_mapped_triangles(const BpScene *scene);

/* "sphere", "triangle", "capsule", or "shape" where there are several kinds. */
const char *bp_scene_noun(const BpScene *scene);

/* How many triangles emit. */
size_t bp_scene_emitting_triangles(const BpScene *scene);

/* The index of a sphere's inside over that of its outside; of what is not glass 0. */
double bp_sphere_refraction_index(const BpScene *scene, size_t sphere);

/* The centre of a sphere when the shutter closes; it moves there in a straight line, at constant speed. */
static inline const double *bp_sphere_end(const BpScene *scene, size_t sphere) {
    return sphere < scene->moving_count ? scene->center_ends[sphere] : scene->spheres[sphere].center;
}
/* Inline, since trees ask in random order: what does not move needs no look at its numbers. */
static inline bool bp_sphere_moves(const BpScene *scene, size_t sphere) {
    if (sphere >= scene->moving_count) return false;
    const double *const from = scene->spheres[sphere].center, *const to = scene->center_ends[sphere];
    return from[0] != to[0] || from[1] != to[1] || from[2] != to[2];
}

/* Checks the invariants above; the message names the sphere, material or member by its index or name. */
BpStatus bp_scene_validate(const BpScene *scene, BpError *err);

/* Writes the scene as a document of the grammar that reads back to the same scene, bit for bit, one sphere a
 * line, to a stream, which the caller closes; refuses a scene with coloured cloud points, which has no such
 * document. */
BpStatus bp_scene_print(const BpScene *scene, FILE *stream, BpError *err);
/* Its member "camera" alone. */
void bp_scene_print_camera(const BpCamera *camera, FILE *stream);

/* The book's cover. edition: "1", "3", "3rust" or "4"; grid: half side, 11 in the book (cells -grid ..
 * grid-1; 3rust: -grid .. grid). The draw order is fixed: see cover.c. */
BpStatus bp_scene_generate_cover(const char *edition, unsigned grid, uint64_t seed, BpScene **scene,
                                 BpError *err);

#endif
