/* scene_types.h: the layout of everything that host and device share.
 *
 * Read by both compilers: the host's C compiler (which defines BP_HOST) and the OpenCL compiler. It is the
 * only such file. Change a struct here and both sides change. Neither compiler accepts a struct that it would
 * lay out with padding, so both have every member at the same place.
 *
 * `real` is double on the host, which packs in double; on the device it is float, or double under
 * --precision double. Packed structs hold reals only or uints only, so that narrowing a whole buffer is one
 * loop (pack.c) and no padding can appear. All sizes are multiples of 16 bytes.
 *
 * All points are relative to the camera's position (bp_camera_origin), subtracted in double before narrowing.
 */
#ifndef BP_SCENE_TYPES_H
#define BP_SCENE_TYPES_H

#ifdef BP_HOST
#include <stddef.h>
#include <stdint.h>
typedef double real;
typedef uint32_t packed_uint;
#elif defined(__OPENCL_C_VERSION__)
typedef uint packed_uint;
#else
#error "scene_types.h: define BP_HOST, or compile as OpenCL C"
#endif

/* The pinhole or thin-lens camera. A ray leaves `lens_right * x + lens_up * y`, (x, y) in the unit disk,
 * towards `corner + right * column + down * row`, a point of the plane in focus. Rows run downwards.
 *
 * With ahead[3] = 1 it is orthographic: each ray has a lens of its own, and `ahead` leads from there to the
 * plane in focus. Rays begin nearer to the spheres (bp_camera_origin), on a plane for which `corner` and so
 * on give the middle of what comes through a lens; it has shrunk to the share corner[3] by there.
 *
 * right[3] is 0 where no density belongs to a direction through a pixel: the camera is orthographic, or only
 * looks through the middles of pixels. */
typedef struct PackedCamera {
    real corner[4];                 /* upper left corner of pixel (0, 0) */
    real right[4];                  /* one pixel to the right; half of a pixel's diagonal, or 0: see above */
    real down[4];                   /* one pixel down */
    real lens_right[4], lens_up[4]; /* scaled by the lens radius */
    real inward[4];   /* unit vector to the centre of the sphere that a pinhole stands on, or 0 */
    real own_slot[4]; /* the slot of that sphere, in two halves (a float counts to 2^24): its low 16 bits,
                         its high 16 bits; NO_SLOT: none; how far off the surface; 0 */
    real ahead[4];    /* straight to the plane in focus; whether the camera is orthographic */
} PackedCamera;

/* Radiance of a ray that meets nothing: bottom against `up`, top along it, linear in the cosine between;
 * top[3] says how many discs stand in front.
 *
 * A camera ray shows the backdrop instead, where there is one: `backdrop_bottom[3]` is 1, or 0. It is linear
 * over the picture's height, so a ray's place there is asked for: where it crosses the plane in focus, whose
 * points have a scalar product of view_ahead[3] with `view_ahead`, and with `view_up` 1 at the upper edge of
 * the picture, -1 at the lower.
 *
 * Where `columns` is not 0, the first of the images is shown instead, with as many texels around and `rows`
 * from top to bottom. `axes` are unit vectors: to its left and right edge, a quarter to the right of it, and
 * downwards. `image_power`: its mean luminance, in the unit of the lamps' power (below), or 0 where no rays
 * are sent to it.
 *
 * The shadow catcher is a plane: its unit normal `catcher`, and in catcher[3] the scalar product of its
 * points with it. Light that reaches it comes in parts: the share catcher_light[2] from the gradient, if it
 * were everywhere as bright as at its brightest, `catcher_share` of a disc from that, if it stood in the
 * zenith. Over the brightest luminance, that of the gradient is catcher_light[0] at the bottom and
 * catcher_light[1] more at the top. catcher_light[3]: how far rays begin ahead of the camera. */
typedef struct PackedSky {
    real bottom[4], top[4], up[4];
    real backdrop_bottom[4], backdrop_top[4];
    real view_ahead[4], view_up[4];
    real axes[9];
    real columns, rows;
    real image_power;
    real catcher[4], catcher_light[4];
} PackedSky;

/* A disc in the sky, a lamp at infinity: its radiance is added to the sky's in a cone of directions. */
typedef struct PackedDisc {
    real direction[3]; /* unit, to its middle */
    real cap;          /* 1 - cos of its half angle; 2 pi times this is its solid angle */
    real radiance[3];
    real power;  /* luminance times squared sine, in the unit of the lamps' power (below) */
    real sine;   /* of the half angle, which is 90 degrees at most */
    real chord2; /* squared distance of its rim from `direction` */
    real seen;   /* 1: by camera rays too, 0: not by them */
    real catcher_share;
} PackedDisc;

/* A texture: a checker of two colours, noise that mixes them, or an image. What is a whole number stands in
 * PackedTextureKind.
 *
 * Solid, a point's place in the lattice is scale * point + offset, in cells; `scale` is the unevaluated sum
 * scale + scale_low, and the offset, which moves the camera back to where the scene has it, a whole number of
 * cells modulo LATTICE_PERIOD and a rest below 1: at least 0, or, of a checker, -1 / LATTICE_BESIDE. Over a
 * surface, `axes` are unit vectors: to longitude 0, to a quarter, to the north pole; fields[0] stand around,
 * fields[1] from pole to pole; of an image those are its texels with all repetitions. Waves of marble are a
 * lattice of their own along one axis; those of wood stand around `centre`, again a sum of two. */
typedef struct PackedTexture {
    real first[3]; /* of even cells, of noise at 0 */
    real scale;
    real second[3]; /* of odd ones, of noise at 1 */
    real scale_low;
    real rest[3]; /* of the offset */
    real fields[2];
    real axes[9];
    real centre[3], centre_low[3];
    real wave, wave_low, wave_rest; /* of marble and wood: waves a unit of length; of the offset */
    real distortion;
} PackedTexture;

typedef struct PackedTextureKind {
    packed_uint mapping;
    packed_uint cell[3]; /* of the offset */
    packed_uint pattern; /* PATTERN_... */
    packed_uint octaves, seed, axis;
    packed_uint image, width, height; /* the number of its first texel, and its sides */
    packed_uint clamped;              /* 1: it does not repeat */
} PackedTextureKind;

/* The numbers of a material. What it scatters stands with each sphere. */
typedef struct PackedMaterial {
    real emit[3];
    real opacity;          /* in (0, 1]: the share of paths that meet the surface */
    real fuzz;             /* in [0, 1] */
    real refraction_index; /* inside over outside; for a negative radius already its reciprocal */
    real roughness;        /* in [0, 1] */
    real lets_in;          /* of a coat: the share of light from all sides that enters */
} PackedMaterial;

/* The kinds of a material, values of the enums below. */
typedef struct PackedMaterialKind {
    packed_uint kind;
    packed_uint lobe;    /* LOBE_...: lambertian's scatter */
    packed_uint variant; /* FUZZ_... for metal, FRESNEL_... for dielectric */
    packed_uint total_reflection;
} PackedMaterialKind;

/* A medium, per unit of length. Number 0 is clear. */
typedef struct PackedMedium {
    real scattering[3];
    real anisotropy; /* Henyey and Greenstein's g: the mean cosine */
    real absorption[3];
    real reserved;
} PackedMedium;

/* A focuser: a ball of glass, or a mirror, by which light of lamps is led on to other surfaces. */
typedef struct PackedFocuser {
    real centre[3];
    real radius;
    real power; /* of the light that it catches, in the unit of the lamps' power: over 4 times its radius
                   squared */
    real refraction_index; /* of a mirror any above 1 */
    real chains[4];        /* the probabilities with which each chain is tried: by the number of its chords */
    real pair_power;       /* as `power`, of the light that other focusers bring to it */
    real turn;             /* cos of the angle that is left to vertex and target by three chords */
} PackedFocuser;

/* The slot of its sphere, FRESNEL_... or FOCUSER_MIRROR, and its targets: the number of the first, and how
 * many. */
typedef struct PackedFocuserPlace {
    packed_uint slot, variant, first, count;
} PackedFocuserPlace;

/* What light for a focuser comes from: a lamp, or a disc of the sky. Every line between focuser and lamp
 * crosses the plane across the line of their centres within `extent` of the lamp's. A bit is added to what is
 * aimed at, so that rounding does not make its rim darker. */
typedef struct PackedTarget {
    real centre[3]; /* of a disc the unit direction to its middle */
    real extent;    /* of a disc 1 - cos of its half angle */
    real share;     /* the probability with which the focuser's light is sought here */
    real reserved[3];
} PackedTarget;

/* Which textures the members of a material have that vary, counted from 1; 0: none. */
typedef struct PackedVariation {
    packed_uint albedo, fuzz, emit, reserved;
} PackedVariation;

/* The kernel gathers members for several lanes at once, from the structs as arrays of their only type. Places
 * of members in them: */
#define MATERIAL_EMIT 0u
#define MATERIAL_OPACITY 3u
#define MATERIAL_FUZZ 4u
#define MATERIAL_INDEX 5u
#define MATERIAL_ROUGHNESS 6u
#define MATERIAL_LETS_IN 7u
#define MATERIAL_LOBE 1u /* of PackedMaterialKind, like the next two */
#define MATERIAL_VARIANT 2u
#define MATERIAL_TOTAL_REFLECTION 3u
#define VARIATION_ALBEDO 0u
#define VARIATION_FUZZ 1u
#define VARIATION_EMIT 2u
#define VARIATIONS 3u
#define TEXTURE_FIRST 0u
#define TEXTURE_SCALE 3u
#define TEXTURE_SECOND 4u
#define TEXTURE_SCALE_LOW 7u
#define TEXTURE_REST 8u
#define TEXTURE_FIELDS 11u
#define TEXTURE_AXES 13u
#define TEXTURE_CENTRE 22u
#define TEXTURE_CENTRE_LOW 25u
#define TEXTURE_WAVE 28u
#define TEXTURE_WAVE_LOW 29u
#define TEXTURE_WAVE_REST 30u
#define TEXTURE_DISTORTION 31u
#define TEXTURE_MAPPING 0u /* of PackedTextureKind, like those that follow */
#define TEXTURE_CELL 1u
#define TEXTURE_PATTERN 4u
#define TEXTURE_OCTAVES 5u
#define TEXTURE_SEED 6u
#define TEXTURE_AXIS 7u
#define TEXTURE_IMAGE 8u
#define TEXTURE_WIDTH 9u
#define TEXTURE_HEIGHT 10u
#define TEXTURE_CLAMPED 11u
#define MEDIUM_SCATTERING 0u
#define MEDIUM_ANISOTROPY 3u
#define MEDIUM_ABSORPTION 4u
#define FOCUSER_CENTRE 0u
#define FOCUSER_RADIUS 3u
#define FOCUSER_POWER 4u
#define FOCUSER_INDEX 5u
#define FOCUSER_CHAINS 6u
#define FOCUSER_PAIR_POWER 10u
#define FOCUSER_TURN 11u
#define FOCUSER_SLOT 0u /* of PackedFocuserPlace, like the next three */
#define FOCUSER_VARIANT 1u
#define FOCUSER_FIRST 2u
#define FOCUSER_COUNT 3u
#define FOCUSER_MIRROR 3u /* no FRESNEL_... */
#define TARGET_CENTRE 0u
#define TARGET_EXTENT 3u
#define TARGET_SHARE 4u
#define DISC_DIRECTION 0u
#define DISC_CAP 3u
#define DISC_RADIANCE 4u
#define DISC_POWER 7u
#define DISC_SINE 8u
#define DISC_CHORD2 9u
#define DISC_SEEN 10u
#define DISC_CATCHER 11u

/* A leaf is `width` spheres as structure of arrays: width reals each of center x, y, z and radius (> 0).
 * An empty lane has its center at NaN, which no ray may meet, and radius -1, and only empty ones follow it.
 * Lane l of leaf f is slot f * width + l. What a path needs of a sphere that it has met stands by slot, so
 * that nothing has to be looked up to find it: `slot_sphere`, the sphere's index in the scene (NO_SPHERE when
 * empty); `slot_material`; `slot_albedo`, ALBEDO_REALS each. Of triangles without colours of their own the
 * last has none: it ends with `coloured_slots`, and a colour for each material follows. Sizes in reals: */
#define LEAF_REALS(width) (4 * (width))
#define ALBEDO_REALS 3
/* Leaves from `first_triangles` on are triangles instead, in an array of their own: width reals each of x, y
 * and z of the first vertex, then of the second and the third. They run counter-clockwise seen from outside.
 * In an empty lane all three are NaN, which no ray meets. The index of a triangle in `slot_sphere` is
 * the number of spheres and its own number among the triangles. */
#define TRIANGLE_REALS(width) (9 * (width))
/* If a triangle of the scene is smooth, all have an entry in `triangle_normals`, at the places of the
 * vertices in `triangles`: the unit normals there, or zeros where a triangle is flat. */
/* If a texture lies on a triangle of the scene, all have an entry in `triangle_coordinates`: width reals each
 * of u and v at the first vertex, then at the second and the third; zeros where a triangle has none. */
#define COORDINATE_REALS(width) (6 * (width))
/* How far a leaf's spheres move while the shutter is open: width reals each of x, y, z; -0 where they do not,
 * which leaves every centre as it is. Empty where no sphere of the scene moves and no kernel asks. */
#define MOTION_REALS(width) (3 * (width))
/* Of a leaf's capsules, which are spheres with an axis: from the centre, which is one end, to the other,
 * width reals each of x, y, z; 0 of spheres. Then the colour of the half by the other end. In kernels that
 * know capsules, whose index in `slot_sphere` is the number of spheres and triangles and their own number. */
#define AXIS_REALS(width) (6 * (width))
/* A node is `width` child boxes as structure of arrays: low x, y, z, high x, y, z, width reals each. Empty
 * lanes have low > high. Its `width` child words stand in a buffer of their own. */
#define NODE_REALS(width) (6 * (width))
#define CHILD_LEAF 0x80000000u /* set: the rest is a leaf number; clear: a node number */
#define NO_SPHERE 0xffffffffu
#define NO_SLOT 0xffffffffu
#define DISC_SLOT 0xffffff00u /* and its number: a disc, where others stand for the sphere in a slot */
#define DISCS_MAX 32u
#define IMAGE_SLOT (DISC_SLOT + DISCS_MAX) /* the image around the scene */
/* A texel is TEXEL_UINTS floats in all precisions, as their bits; images follow each other. The image around
 * the scene is chosen from by two tables of lower bounds in units of 2^-SHARE_BITS: `sky_rows`, of its rows,
 * and `sky_columns`, of the texels of each row; both end with 1. `sky_heights`: of the parallels between rows
 * from the top to the middle, the squared sine of half the angle to the top. */
#define TEXEL_UINTS 3u
#define SHARE_BITS 24
/* Shapes that light passes through, each as its slot and the number of the medium inside, the smallest
 * first: a point lies in the medium of the first that it is inside. The last entry is NO_SLOT and the medium
 * outside of all. */
#define BOUNDARY_UINTS 2u
/* For kernels that know media in bodies, `boundaries` begins otherwise: with the place of the first entry
 * there, the bodies that the camera is in, as bits, and how many bodies there are. Then come, for each
 * material, the bits of bodies that a path is in on the inner side of such a surface, and on the outer side;
 * a body's triangles have an entry of their own in the table of materials. For the slot of a body stands
 * BODY_SLOT and its number. */
#define BODY_HEAD 3u
#define BODY_MASKS 2u
#define BODIES_MAX 32u
#define BODY_SLOT 0xfffffe00u
/* Focusers (light/focusers.cl) end with one in NO_SLOT. `target_lamps`: the slot of each target's lamp, or
 * DISC_SLOT and the number of a disc. */
/* The tree of lamps (light/lamps.cl). A node is LAMP_WIDTH children as structure of arrays, LAMP_WIDTH reals
 * each of centre x, y, z, radius and power. A child of positive radius is a lamp where the shutter opens, and
 * its word is CHILD_LEAF and the lamp's slot; one of negative radius is a node, whose lamps stay in a ball of
 * the radius without its sign, and its word is the node's number. Power: the sum of radiance (its luminance)
 * times squared radius, in a unit in which the radiance of no lamp and no disc exceeds 1; an empty child has
 * none. Node 0 is the root. The width and the order are the same for every device, since a picture depends on
 * which lamp is chosen. `slot_lamp`: where the lamp in a slot stands, LAMP_CHILD_BITS bits for each level,
 * the root's in the lowest, or NO_LAMP.
 */
#define LAMP_WIDTH 8u
#define LAMP_NODE_REALS (5u * LAMP_WIDTH)
#define LAMP_CHILD_BITS 3u
#define LAMP_DEPTH_MAX 10u
#define NO_LAMP 0xffffffffu
/* Packets do not walk through a tree of so many leaves at most: they test the boxes of its leaves in a row.
 */
#define FLAT_LEAVES_MAX 96u
/* A tree is at most this deep, so a stack of TREE_DEPTH_MAX * (width - 1) + 1 entries suffices. */
#define TREE_DEPTH_MAX 24

/* Everything that a kernel which traces is given of a scene, in this order: first the arrays, then the
 * numbers. From these lists come the kernels' parameters and the structs that carry them on the device
 * (integrator/scene.cl, bvh/geometry.cl), and on the host the members of BpPacked, upload, binding and
 * release (render/worker_buffers.c). Only what fills an array knows more of it.
 *
 * X(numbers, element, name, count, what): `numbers` is REALS or UINTS, what `element` is made of; `count`
 * says how many elements there are, in terms of `width` (of the tree), `nodes`, `sphere_leaves`,
 * `motion_leaves`, `slots`, `material_count`, `texture_count`, `texel_count`, `sky_row_count` and so on,
 * `disc_count`, `lamp_nodes` and `lamp_slots`; `what` is how a message calls it. Arrays of the first two
 * lists are pack.c's, of the third the tree of lamps', of the last the tree's.
 *
 * Arrays of slots, of lamps and of the tree grow with the spheres. Where one is larger than a buffer of the
 * device may be, all of them come in SCENE_PARTS parts of PART_LENGTH elements each, the last ones perhaps
 * empty (bvh/parts.cl). PART_LENGTH is a multiple of PART_UNIT, so that no node and no leaf lies in two
 * parts; a node of the tree of lamps may, except for the root, which is read from the first part alone.
 *
 * Materials are arrays of numbers here,
 * since Mesa's rusticl (22.3) gathers wrong ones through a pointer to structs that is cast inside a loop. */
#define MATERIAL_REALS ((packed_uint)(sizeof(PackedMaterial) / sizeof(real)))
#define MATERIAL_UINTS ((packed_uint)(sizeof(PackedMaterialKind) / sizeof(packed_uint)))
#define DISC_REALS ((packed_uint)(sizeof(PackedDisc) / sizeof(real)))
#define VARIATION_UINTS ((packed_uint)(sizeof(PackedVariation) / sizeof(packed_uint)))
#define MEDIUM_REALS ((packed_uint)(sizeof(PackedMedium) / sizeof(real)))
#define FOCUSER_REALS ((packed_uint)(sizeof(PackedFocuser) / sizeof(real)))
#define FOCUSER_UINTS ((packed_uint)(sizeof(PackedFocuserPlace) / sizeof(packed_uint)))
#define TARGET_REALS ((packed_uint)(sizeof(PackedTarget) / sizeof(real)))
#define TEXTURE_REALS ((packed_uint)(sizeof(PackedTexture) / sizeof(real)))
#define TEXTURE_UINTS ((packed_uint)(sizeof(PackedTextureKind) / sizeof(packed_uint)))
#define SCENE_PARTS_MAX 8
#define PART_UNIT 576u /* a multiple of NODE_REALS, LEAF_REALS and the like of all widths */
/* clang-format off */
#define SCENE_ARRAYS_OF_PACK(X)                                                                              \
    X(REALS, PackedCamera, camera, 1, "the camera")                                                          \
    X(REALS, PackedSky, sky, 1, "the background")                                                            \
    X(REALS, real, discs, disc_count * DISC_REALS, "the discs of the background")                            \
    X(REALS, real, materials, material_count * MATERIAL_REALS, "the table of materials")                     \
    X(UINTS, packed_uint, material_kinds, material_count * MATERIAL_UINTS, "the table of materials")         \
    X(UINTS, packed_uint, variations, material_count * VARIATION_UINTS, "the table of materials")            \
    X(REALS, real, textures, texture_count * TEXTURE_REALS, "the textures")                                  \
    X(UINTS, packed_uint, texture_kinds, texture_count * TEXTURE_UINTS, "the textures")                      \
    X(UINTS, packed_uint, texels, texel_count * TEXEL_UINTS, "the images")                                   \
    X(UINTS, packed_uint, sky_rows, sky_row_count, "the table of the background")                            \
    X(UINTS, packed_uint, sky_columns, sky_column_count, "the table of the background")                      \
    X(REALS, real, sky_heights, sky_height_count, "the table of the background")                             \
    X(REALS, real, media, medium_count * MEDIUM_REALS, "the media")                                          \
    X(UINTS, packed_uint, boundaries, boundary_uints, "the boundaries of media")
#define SCENE_ARRAYS_OF_FOCUSERS(X)                                                                          \
    X(REALS, real, focusers, focuser_count * FOCUSER_REALS, "the table of focusers")                         \
    X(UINTS, packed_uint, focuser_places, focuser_count * FOCUSER_UINTS, "the table of focusers")            \
    X(REALS, real, targets, target_count * TARGET_REALS, "the table of focusers")                            \
    X(UINTS, packed_uint, target_lamps, target_count, "the table of focusers")
#define SCENE_ARRAYS_OF_SLOTS(X)                                                                             \
    X(UINTS, packed_uint, slot_material, slots, "the table of sphere materials")                             \
    X(REALS, real, slot_albedo, colours * ALBEDO_REALS, "the table of sphere colours")
#define SCENE_ARRAYS_OF_LAMPS(X)                                                                             \
    X(REALS, real, lamps, lamp_nodes * LAMP_NODE_REALS, "the tree of lamps")                                 \
    X(UINTS, packed_uint, lamp_children, lamp_nodes * LAMP_WIDTH, "the tree of lamps")                       \
    X(UINTS, packed_uint, slot_lamp, lamp_slots, "the table of lamps")
#define SCENE_ARRAYS_OF_TREE(X)                                                                              \
    X(REALS, real, node_boxes, nodes * NODE_REALS(width), "the tree's boxes")                                \
    X(UINTS, packed_uint, children, nodes * width, "the tree's nodes")                                       \
    X(REALS, real, leaves, sphere_leaves * LEAF_REALS(width), "the spheres")                                    \
    X(REALS, real, leaf_motions, motion_leaves * MOTION_REALS(width), "the spheres' motions")                 \
    X(UINTS, packed_uint, slot_sphere, slots, "the spheres' numbers")
/* Of kernels that know triangles: after the others, and before the numbers, `first_triangles` and
 * `coloured_slots`. */
#define SCENE_ARRAYS_OF_TRIANGLES(X)                                                                         \
    X(REALS, real, triangles, triangle_leaves * TRIANGLE_REALS(width), "the triangles")
/* Of kernels that know normals at vertices: after those, and `normal_leaves` after `first_triangles`. */
#define SCENE_ARRAYS_OF_NORMALS(X)                                                                           \
    X(REALS, real, triangle_normals, normal_leaves * TRIANGLE_REALS(width), "the triangles' normals")
/* Of kernels that know texture coordinates: after those, and `coordinate_leaves` after `normal_leaves`. */
#define SCENE_ARRAYS_OF_COORDINATES(X)                                                                       \
    X(REALS, real, triangle_coordinates, coordinate_leaves * COORDINATE_REALS(width),                        \
      "the triangles' texture coordinates")
/* Of kernels that know capsules, before those. */
#define SCENE_ARRAYS_OF_CAPSULES(X)                                                                          \
    X(REALS, real, leaf_axes, axis_leaves * AXIS_REALS(width), "the capsules' axes")
#define SCENE_NUMBERS(X)                                                                                     \
    X(first_leaves) X(leaf_count) X(pixel_center) X(max_depth) X(seed_low) X(seed_high) X(replicates) X(width)
/* clang-format on */

enum {
    KIND_LAMBERTIAN,
    KIND_METAL,
    KIND_DIELECTRIC,
    KIND_LIGHT,
    KIND_NORMALS,
    KIND_INTERFACE,
    KIND_OREN_NAYAR,
    KIND_ROUGH_METAL,
    KIND_GLOSSY,
    KIND_ROUGH_DIELECTRIC
};
enum { LOBE_LAMBERTIAN, LOBE_COSINE_CUBED, LOBE_HEMISPHERE };
enum { FUZZ_SPHERE, FUZZ_BALL };
enum { FRESNEL_SCHLICK, FRESNEL_EXACT, FRESNEL_NONE };
enum { TOTAL_REFLECT, TOTAL_ABSORB, TOTAL_REFRACT };
enum { MAPPING_SOLID, MAPPING_SURFACE };
/* Noise stands together, and behind it the image. */
enum { PATTERN_CHECKER, PATTERN_PERLIN, PATTERN_TURBULENCE, PATTERN_MARBLE, PATTERN_WOOD, PATTERN_IMAGE };
#define LATTICE_BESIDE                                                                                       \
    4096 /* by a part in so many of a cell a place may be told from the corner ahead of it */
#define LATTICE_PERIOD 0x400000u /* cells are counted modulo this: whole numbers that a float holds */

/* OpenCL C 1.2 has no static assertions, but no array has a negative size. */
#ifdef BP_HOST
#define REAL_BYTES 8
#define SIZE_IS(type, size) _Static_assert(sizeof(type) == (size), #type " has padding");
#else
#define REAL_BYTES (REAL_IS_DOUBLE ? 8 : 4)
#define SIZE_IS(type, size) typedef char type##_has_padding[sizeof(type) == (size) ? 1 : -1];
#endif
/* clang-format off */
SIZE_IS(PackedCamera, 32 * REAL_BYTES)
SIZE_IS(PackedSky, 48 * REAL_BYTES)
SIZE_IS(PackedDisc, 12 * REAL_BYTES)
SIZE_IS(PackedMaterial, 8 * REAL_BYTES)
SIZE_IS(PackedMaterialKind, 16)
SIZE_IS(PackedTexture, 32 * REAL_BYTES)
SIZE_IS(PackedTextureKind, 48)
SIZE_IS(PackedMedium, 8 * REAL_BYTES)
SIZE_IS(PackedVariation, 16)
SIZE_IS(PackedFocuser, 12 * REAL_BYTES)
SIZE_IS(PackedFocuserPlace, 16)
SIZE_IS(PackedTarget, 8 * REAL_BYTES)
/* clang-format on */
#undef SIZE_IS
#undef REAL_BYTES

#ifdef BP_HOST
_Static_assert(PART_UNIT >= LAMP_NODE_REALS, "the root of the tree of lamps lies in the first part");
#define BP_PLACE(place, type, member, element)                                                               \
    _Static_assert(offsetof(type, member) == (place) * sizeof(element), "the place of " #member)
BP_PLACE(DISC_DIRECTION, PackedDisc, direction, real);
BP_PLACE(DISC_CAP, PackedDisc, cap, real);
BP_PLACE(DISC_RADIANCE, PackedDisc, radiance, real);
BP_PLACE(DISC_POWER, PackedDisc, power, real);
BP_PLACE(DISC_SINE, PackedDisc, sine, real);
BP_PLACE(DISC_CHORD2, PackedDisc, chord2, real);
BP_PLACE(DISC_SEEN, PackedDisc, seen, real);
BP_PLACE(FOCUSER_CENTRE, PackedFocuser, centre, real);
BP_PLACE(FOCUSER_RADIUS, PackedFocuser, radius, real);
BP_PLACE(FOCUSER_POWER, PackedFocuser, power, real);
BP_PLACE(FOCUSER_INDEX, PackedFocuser, refraction_index, real);
BP_PLACE(FOCUSER_CHAINS, PackedFocuser, chains, real);
BP_PLACE(FOCUSER_PAIR_POWER, PackedFocuser, pair_power, real);
BP_PLACE(FOCUSER_TURN, PackedFocuser, turn, real);
BP_PLACE(FOCUSER_SLOT, PackedFocuserPlace, slot, packed_uint);
BP_PLACE(FOCUSER_VARIANT, PackedFocuserPlace, variant, packed_uint);
BP_PLACE(FOCUSER_FIRST, PackedFocuserPlace, first, packed_uint);
BP_PLACE(FOCUSER_COUNT, PackedFocuserPlace, count, packed_uint);
BP_PLACE(TARGET_CENTRE, PackedTarget, centre, real);
BP_PLACE(TARGET_EXTENT, PackedTarget, extent, real);
BP_PLACE(TARGET_SHARE, PackedTarget, share, real);
BP_PLACE(MEDIUM_SCATTERING, PackedMedium, scattering, real);
BP_PLACE(MEDIUM_ANISOTROPY, PackedMedium, anisotropy, real);
BP_PLACE(MEDIUM_ABSORPTION, PackedMedium, absorption, real);
BP_PLACE(VARIATION_ALBEDO, PackedVariation, albedo, packed_uint);
BP_PLACE(VARIATION_FUZZ, PackedVariation, fuzz, packed_uint);
BP_PLACE(VARIATION_EMIT, PackedVariation, emit, packed_uint);
BP_PLACE(TEXTURE_FIRST, PackedTexture, first, real);
BP_PLACE(TEXTURE_SCALE, PackedTexture, scale, real);
BP_PLACE(TEXTURE_SECOND, PackedTexture, second, real);
BP_PLACE(TEXTURE_SCALE_LOW, PackedTexture, scale_low, real);
BP_PLACE(TEXTURE_REST, PackedTexture, rest, real);
BP_PLACE(TEXTURE_FIELDS, PackedTexture, fields, real);
BP_PLACE(TEXTURE_AXES, PackedTexture, axes, real);
BP_PLACE(TEXTURE_CENTRE, PackedTexture, centre, real);
BP_PLACE(TEXTURE_CENTRE_LOW, PackedTexture, centre_low, real);
BP_PLACE(TEXTURE_WAVE, PackedTexture, wave, real);
BP_PLACE(TEXTURE_WAVE_LOW, PackedTexture, wave_low, real);
BP_PLACE(TEXTURE_WAVE_REST, PackedTexture, wave_rest, real);
BP_PLACE(TEXTURE_DISTORTION, PackedTexture, distortion, real);
BP_PLACE(TEXTURE_PATTERN, PackedTextureKind, pattern, packed_uint);
BP_PLACE(TEXTURE_OCTAVES, PackedTextureKind, octaves, packed_uint);
BP_PLACE(TEXTURE_SEED, PackedTextureKind, seed, packed_uint);
BP_PLACE(TEXTURE_AXIS, PackedTextureKind, axis, packed_uint);
BP_PLACE(TEXTURE_IMAGE, PackedTextureKind, image, packed_uint);
BP_PLACE(TEXTURE_WIDTH, PackedTextureKind, width, packed_uint);
BP_PLACE(TEXTURE_HEIGHT, PackedTextureKind, height, packed_uint);
BP_PLACE(TEXTURE_CLAMPED, PackedTextureKind, clamped, packed_uint);
BP_PLACE(TEXTURE_MAPPING, PackedTextureKind, mapping, packed_uint);
BP_PLACE(TEXTURE_CELL, PackedTextureKind, cell, packed_uint);
BP_PLACE(MATERIAL_EMIT, PackedMaterial, emit, real);
BP_PLACE(MATERIAL_OPACITY, PackedMaterial, opacity, real);
BP_PLACE(MATERIAL_FUZZ, PackedMaterial, fuzz, real);
BP_PLACE(MATERIAL_INDEX, PackedMaterial, refraction_index, real);
BP_PLACE(MATERIAL_ROUGHNESS, PackedMaterial, roughness, real);
BP_PLACE(MATERIAL_LETS_IN, PackedMaterial, lets_in, real);
BP_PLACE(0, PackedMaterialKind, kind, packed_uint);
BP_PLACE(MATERIAL_LOBE, PackedMaterialKind, lobe, packed_uint);
BP_PLACE(MATERIAL_VARIANT, PackedMaterialKind, variant, packed_uint);
BP_PLACE(MATERIAL_TOTAL_REFLECTION, PackedMaterialKind, total_reflection, packed_uint);
#undef BP_PLACE
#endif

/* A count of a replicate's samples, at most 2^24, and what its sums hold beside it (host/film/film.h). */
#define COUNT_SAMPLES 0x1ffffffu
#define COUNT_HAS_FINE 0x80000000u /* its fine sums have begun; before that they are not even zeroed */
#define COUNT_COARSE 0x40000000u   /* a sample was so dim that a fine step is more than a millionth of it */

/* What a pixel counts beside its sums: ray segments, paths cut by the depth cap, samples that are left out,
 * by cause, valid ones whose camera ray met nothing, and rays to lamps, which are dealt out over pixels so
 * that their sum is right. */
enum {
    TALLY_SEGMENTS,
    TALLY_CUT,
    TALLY_NOT_FINITE,
    TALLY_NEGATIVE,
    TALLY_OUT_OF_RANGE,
    TALLY_MISSED,
    TALLY_LAMP_RAYS,
    TALLIES
};
/* Added to the number of segments of a path whose camera ray met nothing; no path has as many, and twice both
 * together, and one more, is exact in float. */
#define MISSED_MARK 0x200000u
#define MISSED_BITS 21

#define FINE_BITS 38 /* a fine step is 2^-FINE_BITS steps */

#endif
