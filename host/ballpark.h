/* ballpark.h: the public interface of libballpark, a path tracer for spheres and triangles on any OpenCL
 * device.
 *
 * In short: load a scene, open a render of it on a list of devices, step until it is finished, read
 * the picture, destroy. After a call has failed, report it and destroy.
 *
 *     BpScene *scene = NULL; BpRender *render = NULL; BpError err = {0};
 *     BpProgress progress = {0}; BpPicture picture = {0};
 *     BpStatus status = bp_scene_load("cover.json", &scene, &err);
 *     if (status == BP_OK) status = bp_render_create(scene, NULL, NULL, 0, &render, &err);
 *     while (status == BP_OK && !progress.finished) status = bp_render_step(render, &progress, &err);
 *     if (status == BP_OK) status = bp_render_read(render, &picture, &err);
 *     if (status == BP_OK)
 *         status = bp_picture_write(&picture, "cover.png", BP_FORMAT_PNG, BP_TRANSFER_GAMMA2, &err);
 *     if (status != BP_OK) {
 *         bp_error_add_remedy(&err, BP_INTERFACE_C);
 *         fprintf(stderr, "%s: %s\n", err.file[0] != 0 ? err.file : bp_status_name(status), err.message);
 *     }
 *     bp_picture_clear(&picture); bp_render_destroy(&render); bp_scene_destroy(&scene);
 *     bp_error_clear(&err);
 *
 * General rules, stated once:
 * - Errors. A function that can fail returns BpStatus and takes `BpError *err` last; `err` may be NULL. Begin
 *   with a zeroed BpError and end with bp_error_clear(); before its message is shown, bp_error_add_remedy()
 *   completes it. Any such function can fail with BP_ERR_MEMORY, and one that works on a device with
 *   BP_ERR_DEVICE; comments name what else is to be expected. After a failed step of a render or a study,
 *   destroy it; every other failure leaves its arguments as they were.
 * - Arguments. A pointer must not be NULL unless it is called Optional here.
 * - Ownership. A function that takes the address of a handle to fill it gives an object that the caller owns;
 *   the handle is NULL before, and stays NULL on failure. `_destroy` takes its address, frees it and sets
 *   it to NULL; it accepts NULL and the address of NULL. `_clear` releases what a caller's struct holds and
 *   zeroes it. What a getter points to belongs to the handle; it is valid until that changes or is destroyed.
 * - Strings are UTF-8, end with a zero byte and are copied; no function keeps a caller's pointer beyond the
 *   call unless its comment states that.
 * - Threads. A handle is used by one thread at a time, but functions that take a `const` handle may run at
 *   the same time: many threads may render one scene, each by a render of its own. Different handles are
 *   independent, also in the first calls of a process: there is no state outside of handles, except for
 *   caches in files and the start of the OpenCL drivers, which one thread does while the others wait. The
 *   environment (BALLPARK_KERNELS, and what OpenCL drivers read) must not change meanwhile. No function
 *   prints, exits or touches signals; a driver may: PoCL ends the process by abort() when it lacks memory.
 * - Processes. OpenCL drivers do not survive fork(). In a process forked from one that has used OpenCL, every
 *   function that would need a driver fails with BP_ERR_DEVICE; pictures, films and scenes remain usable, and
 *   `_destroy` frees the host's memory alone. A process may fork before anything uses OpenCL, and then
 *   use it.
 * - Drivers. All OpenCL drivers of the machine start with the first call that needs a device. One that
 *   does not answer within 20 seconds, when it starts or opens a device, is given up: BP_ERR_DEVICE, with
 *   a message that names it where possible. The thread that waits for it cannot be ended and stays behind;
 *   while that holds a lock of the system's loader, exit() waits for it, and _exit() does not.
 *   BALLPARK_DRIVER_SECONDS in the environment sets another limit; with 0 there is none, and drivers start
 *   in the caller's thread. A library cannot prevent a driver from crashing or ending the process.
 *   `ballpark devices` tries each driver in a process of its own and names the broken one, which is not
 *   loaded if OCL_ICD_VENDORS names the .icd file of another.
 * - Options. A struct of options is filled by its function `_defaults`; then change what matters. New members
 *   may come in a minor version, so a struct that was filled member by member would lack them.
 * - Versions. While the version is 0.x, structs may grow in a minor version and not in a patch: see
 *   BP_API_VERSION. There are no callbacks, variadic functions or structs passed by value, so that other
 *   languages can call everything.
 * - Units. Colours are linear RGB radiance. Lengths are the scene's own unit. Angles are degrees where named
 *   so. Times are seconds of wall clock. Errors (NRMSE) are fractions: 0.01 is 1 %. */
#ifndef BALLPARK_H
#define BALLPARK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Marks what the shared library exports. */
#if defined(__GNUC__)
#define BP_API __attribute__((visibility("default")))
#else
#define BP_API
#endif

/* 1000 * major + minor of the version: 0.1. A program must be compiled again for another value; the shared
 * library's name follows it (libballpark.so.0.1), and bp_api_version() returns that of the loaded library. */
#define BP_API_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

/* ---- status and errors ------------------------------------------------------------------------------- */

/* name, exit code of the command line program, text */
#define BP_STATUS_LIST(X)                                                                                    \
    X(BP_OK, 0, "done")                                                                                      \
    X(BP_ERR_FILE, 1, "file error")                                                                          \
    X(BP_ERR_MEMORY, 1, "out of memory")                                                                     \
    X(BP_ERR_DEVICE, 1, "device error")                                                                      \
    X(BP_ERR_BUILD, 1, "kernel build error")                                                                 \
    X(BP_ERR_LIMIT, 1, "limit exceeded")                                                                     \
    X(BP_ERR_USAGE, 2, "usage error")                                                                        \
    X(BP_ERR_SCENE, 2, "bad scene")                                                                          \
    X(BP_ERR_DISAGREE, 3, "kernel and reference disagree")                                                   \
    X(BP_ERR_INTERRUPTED, 130, "interrupted")                                                                \
    X(BP_ERR_INCONCLUSIVE, 4, "not enough evidence that kernel and reference agree")                         \
    X(BP_ERR_NO_DEVICE, 5, "no such device")                                                                 \
    X(BP_ERR_BROKEN_DEVICE, 6, "a device or its driver is broken")

typedef enum BpStatus {
#define BP_STATUS_ENUM(name, exit_code, text) name,
    BP_STATUS_LIST(BP_STATUS_ENUM)
#undef BP_STATUS_ENUM
} BpStatus;

/* What helps after a failure, where each interface to the library has a name of its own for it: an option of
 * the command line, an argument of Python's functions, a member of a struct. */
typedef enum BpRemedy {
    BP_REMEDY_NONE, /* or the message has it, in words that suit everybody */
    BP_REMEDY_SMALLER_WIDTH,
    BP_REMEDY_OR_SMALLER_WIDTH, /* in addition to what the message advises; so are the others with OR_ */
    BP_REMEDY_WIDTH_AT_MOST,    /* `remedy_value`: the greatest width in pixels */
    BP_REMEDY_SMALLER_WIDTH_OR_OTHER_DEVICE,
    BP_REMEDY_WIDTH_AT_MOST_OR_OTHER_DEVICE, /* `remedy_value`: the greatest width in pixels */
    BP_REMEDY_OTHER_DEVICE,
    BP_REMEDY_OR_OTHER_DEVICE,
    BP_REMEDY_SINGLE_PRECISION_OR_OTHER_DEVICE,
    BP_REMEDY_DOUBLE_PRECISION,
    BP_REMEDY_SMALLER_DEPTH,
    BP_REMEDY_OTHER_FIRST_SAMPLE,
    BP_REMEDY_SAME_SEED,
    BP_REMEDY_SAME_WIDTH,
    BP_REMEDY_SAME_DEPTH,
    BP_REMEDY_SAME_SETTING, /* `remedy_value`: a member of BpRenderOptions, such as "light_sampling" */
    BP_REMEDY_WRITABLE_PLACE,
    BP_REMEDY_OR_OTHER_PLACE,
    BP_REMEDY_OTHER_NAME
} BpRemedy;

/* Whose names a remedy is worded with. */
typedef enum BpInterface { BP_INTERFACE_C, BP_INTERFACE_COMMAND_LINE, BP_INTERFACE_PYTHON } BpInterface;

/* Describes a failure. Zero it before its first use; it is written on failure alone, and may be used
 * again. */
typedef struct BpError {
    BpStatus code;
    char message[1024]; /* what happened; where in the file is in the next members */
    char file[512];     /* the file at fault, or ""; a message about a file as a whole may name it too */
    int line, column;   /* from 1; 0 when unknown */
    char *attachment;   /* Optional. A long text, such as a whole build log. */
    BpRemedy remedy;
    char remedy_value[24]; /* "" where the remedy needs none */
} BpError;

/* "file error", and "unknown status" for a number that is not a BpStatus; static. */
BP_API const char *bp_status_name(BpStatus status);
/* The exit code of the command line program: 0 for BP_OK, never 0 for another. */
BP_API int bp_status_exit_code(BpStatus status);
/* Appends the remedy to the message, in the words of `interface`, and sets `remedy` to BP_REMEDY_NONE: so a
 * second call does nothing. `err`: Optional. */
BP_API void bp_error_add_remedy(BpError *err, BpInterface interface);
/* Releases the attachment and zeroes the rest. `err`: Optional. */
BP_API void bp_error_clear(BpError *err);

/* Releases memory that a function below documents as to be released with it. `memory`: Optional. */
BP_API void bp_free(void *memory);

/* "0.1.0 (commit abcdef1)"; static. */
BP_API const char *bp_version(void);
/* The BP_API_VERSION that the library was compiled with. */
BP_API int bp_api_version(void);

/* ---- scenes ------------------------------------------------------------------------------------------ */

typedef struct BpScene BpScene;

typedef enum BpTransfer { BP_TRANSFER_GAMMA2, BP_TRANSFER_SRGB, BP_TRANSFER_LINEAR } BpTransfer;

/* Reads and validates a scene document (docs: scenes/README.md), or a file of particles (docs/PARTICLES.md),
 * which becomes a scene with everything chosen by what it holds. BP_ERR_SCENE: the scene is invalid, or the
 * file cannot be opened; BP_ERR_FILE: reading failed. Errors name file:line:column. */
BP_API BpStatus bp_scene_load(const char *path, BpScene **scene, BpError *err);
/* The same, of the particles of all files only those for which `select` holds, an expression such as
 * "chain == \"A\" and not hydrogen" (docs/PARTICLES.md). It is thread-safe as bp_scene_load() is.
 * BP_ERR_SCENE: also an invalid expression, which the error's attachment shows with a mark below the place;
 * one that holds for no particle; a scene without particles. */
BP_API BpStatus bp_scene_load_selected(const char *path, const char *select, BpScene **scene, BpError *err);

/* The same from `length` bytes of memory, which need not end with a zero byte; `name` stands in messages
 * where a path would, and relative files of the scene (clouds) are looked up beside it. */
BP_API BpStatus bp_scene_parse(const char *text, size_t length, const char *name, BpScene **scene,
                               BpError *err);

/* A strided view of an array of the caller's, one row per sphere: number `column` of row `row` is
 * at data + row * row_stride + column * column_stride, in bytes. A row_stride of 0 gives every sphere the
 * same row. So for vertices, triangles and lines. */
typedef enum BpNumberType { BP_NUMBER_FLOAT, BP_NUMBER_DOUBLE } BpNumberType;
typedef struct BpRows {
    const void *data;
    ptrdiff_t row_stride, column_stride;
    BpNumberType type;
} BpRows;

/* Spheres of one material, as arrays. Zero it, then set what there is. */
typedef struct BpSphereSet {
    size_t count;
    BpRows center; /* 3 columns */
    BpRows radius; /* 1 column; not 0, negative: inside out */
    BpRows color;  /* 3 columns, linear, from 0 to 1: replaces the material's albedo. data NULL: none */
    const char *material; /* Optional. A name from the scene's "materials"; NULL: matte */
    const char *name;     /* Optional. What messages call the set; NULL: "the spheres" */
    const char *interior; /* Optional. What fills the spheres, a name from the scene's "media": the material
                             lets light in */
} BpSphereSet;

/* The same as bp_scene_parse(), with `set_count` sets of spheres after those that the document names, in the
 * order of `sets`. A camera that is fitted to the particles or the scene is fitted to them too. The arrays
 * are copied, and read once. BP_ERR_SCENE names the sphere, counted from 0 in its set. */
BP_API BpStatus bp_scene_parse_with_spheres(const char *text, size_t length, const char *name,
                                            const BpSphereSet *sets, size_t set_count, BpScene **scene,
                                            BpError *err);

/* A mesh of one material, as arrays. Zero it, then set what there is. */
typedef struct BpMeshSet {
    size_t vertex_count, triangle_count;
    BpRows vertex; /* 3 columns, from -1e9 to 1e9 */
    const uint32_t
        *triangle; /* 3 of each: its vertices, counted from 0, counter-clockwise seen from outside */
    BpRows color;  /* of triangles; 3 columns, linear, from 0 to 1: replaces the material's albedo. data NULL:
                      none */
    const char *material; /* Optional. A name from the scene's "materials"; NULL: matte */
    const char *name;     /* Optional. What messages call the mesh; NULL: "the mesh" */
    BpRows normal;   /* of vertices; 3 columns, of any length, zeros where one is missing: the mesh is smooth.
                        data   NULL: none */
    uint32_t smooth; /* 1: also without them, by those of its faces */
    uint32_t uv_of_corners; /* 1: rows of uv are those of corners, three for each triangle, so that a vertex
                               may have several */
    BpRows uv; /* texture coordinates, of vertices; 2 columns, u and v, which grows upwards, from -1e6 to 1e6,
                  kept as floats: by them textures lie on the mesh. data NULL: none */
    const char *interior; /* Optional. What fills the mesh, which is closed, a name from the scene's "media":
                             the material lets light in */
} BpMeshSet;

/* Lines of one material, as arrays: capsules, with a radius and round ends, a sphere where both ends are in
 * one place. Zero it, then set what there is. */
typedef struct BpLineSet {
    size_t point_count, line_count;
    BpRows point;         /* 3 columns, from -1e9 to 1e9, in the scene's unit of length */
    const uint32_t *line; /* Optional. 2 of each: its ends, points counted from 0. NULL: line i has the points
                             2 i and 2 i + 1 */
    BpRows radius;        /* of lines; 1 column, from 1e-12 to 1e9 */
    BpRows color[2];      /* of the halves by a line's first and second end, a row for each line; 3 columns,
                             linear, from 0 to 1: both replace the material's albedo. data NULL: none */
    const char *material; /* Optional. A name from the scene's "materials", which does not emit;
                             NULL: matte */
    const char *name;     /* Optional. What messages call the set; NULL: "the lines" */
    const char *interior; /* Optional. What fills each line, a name from the scene's "media": the material
                             lets light in */
} BpLineSet;

/* Shapes as arrays. Zero it, then set what there is. */
typedef struct BpShapeSets {
    const BpSphereSet *spheres;
    size_t sphere_set_count;
    const BpMeshSet *meshes;
    size_t mesh_set_count;
    const BpLineSet *lines;
    size_t line_set_count;
} BpShapeSets;

/* The same with sets of several kinds of shapes, each after what the document names of its kind. A camera
 * that is fitted to the particles is fitted to spheres and lines, and one that is fitted to the scene to
 * meshes too. Triangles without an area are left out. `shapes` and its arrays are the caller's: they are read
 * during the call, and may be released after it. Calls with different `scene` may run at once, with the same
 * arrays too. BP_ERR_SCENE names the sphere, vertex, triangle or line, counted from 0 in its set, and for
 * glass that is not closed the edge. BP_ERR_USAGE: an array is missing, or has an unknown type of number.
 * *scene is NULL then. */
BP_API BpStatus bp_scene_parse_with_shapes(const char *text, size_t length, const char *name,
                                           const BpShapeSets *shapes, BpScene **scene, BpError *err);

BP_API void bp_scene_destroy(BpScene **scene);

/* Overrides the picture's width in pixels; the height follows from the scene's aspect ratio. BP_ERR_USAGE: a
 * side would be out of range. No render or study of the scene may live meanwhile. */
BP_API BpStatus bp_scene_set_width(BpScene *scene, uint32_t width, BpError *err);

/* Facts about a scene; its strings are valid while the scene lives. */
typedef struct BpSceneInfo {
    const char *title, *source; /* "" where the document has none */
    uint32_t width, height, samples_per_pixel, max_depth;
    size_t spheres, materials;
    BpTransfer transfer;
    size_t triangles; /* those of quads and boxes too */
    size_t capsules;  /* bonds, the edges of cells, and lines from arrays */
} BpSceneInfo;
BP_API void bp_scene_info(const BpScene *scene, BpSceneInfo *info);

/* The current camera: fitted to the spheres, if the scene has a fitted camera. */
typedef struct BpCameraInfo {
    double vfov; /* of the picture's height */
    double lookfrom[3], lookat[3], vup[3];
    double aperture;   /* diameter of the lens; 0: all in focus */
    double focus_dist; /* along the view, from lookfrom to the plane in focus */
} BpCameraInfo;
BP_API void bp_scene_camera(const BpScene *scene, BpCameraInfo *info);

/* An effect that the kernel can simulate, and whether a scene calls for it. */
typedef struct BpEffectInfo {
    const char *name, *description; /* static: "lens", "a lens with an aperture: defocus blur" */
    bool simulated;
    char reason[160]; /* why it is simulated or not, as a readable text */
} BpEffectInfo;

/* How many effects there are: the same ones in the same order for every scene, at most 31. */
BP_API size_t bp_effect_count(void);
/* Fills `info` with effect `index`, from 0, and returns true; false where there is none of that number. Looks
 * through all spheres each time. */
BP_API bool bp_scene_effect(const BpScene *scene, size_t index, BpEffectInfo *info);

/* ---- how particles look ------------------------------------------------------------------------------ */

/* The colours and radii that files of particles get, for spheres from other sources. */
typedef struct BpElementInfo {
    char symbol[4];                 /* "" for the unknown element */
    double mass;                    /* standard atomic weight */
    double van_der_waals, covalent; /* radii in angstrom */
    double color[3];                /* linear */
} BpElementInfo;

/* Fills `info` with the element of that number, from 0 (an unknown one) to 118; false beyond. */
BP_API bool bp_element_info(unsigned atomic_number, BpElementInfo *info);
/* The atomic number of an atom from its name and its residue's, as in PDB files: "CA" is calcium in the
 * residue "CA", and a carbon in "ALA". 0: unknown. `residue`: Optional. */
BP_API unsigned bp_element_of_atom(const char *name, const char *residue);
/* The linear colour of a type that has none of its own; they cycle through a palette of ten soft colours. */
BP_API void bp_type_color(size_t type, double color[3]);
/* The names of the colour maps, "viridis" first; NULL where there is none of that number. Static. */
BP_API const char *bp_color_map_name(size_t index);
/* The linear colour at `share`, 0 to 1, of a map; false where no map is called so. */
BP_API bool bp_color_map(const char *name, double share, double color[3]);

/* ---- devices ----------------------------------------------------------------------------------------- */

typedef enum BpDeviceType { BP_DEVICE_CPU, BP_DEVICE_GPU, BP_DEVICE_OTHER } BpDeviceType;

typedef struct BpDeviceInfo {
    unsigned number; /* as bp_device_find() takes it; counts over all platforms, from 0 */
    BpDeviceType type;
    char platform[128], name[256], vendor[128], version[128], driver[128];
    unsigned compute_units;
    unsigned
        float_lanes; /* of its vector instructions, as the driver reports; 1: none, or not reported.
                        4 with PoCL on 64-bit ARM, since PoCL reports 1 for all processors except x86's */
    uint64_t memory_bytes, largest_allocation_bytes;
    bool has_double, has_compiler, available;
    char refusal[128];      /* what the device lacks, so that it cannot render; "": nothing */
    unsigned clock_mhz;     /* the highest, as the driver reports; 0: not reported */
    bool has_shared_memory; /* its memory is the host's, as that of GPUs inside a processor */
} BpDeviceInfo;

/* Every device of every platform. Release *list with bp_free(). No platform or no device at all is not an
 * error: *count is 0. */
BP_API BpStatus bp_devices_list(BpDeviceInfo **list, size_t *count, BpError *err);

/* The device that `text` means: its number; "gpu" (the most capable) or "cpu" (the first); a part of its
 * name, vendor, version, driver version or platform (any case); or for NULL or "" the default: the most
 * capable GPU if there is one, else a CPU. A GPU with memory of its own is more capable than one without; of
 * one platform, that with more compute units times its clock; of several, that with more memory. A device
 * that cannot render is skipped; if its number is given, it is refused with what it lacks. BP_ERR_DEVICE:
 * nothing fits, or a text fits different devices; the error lists the devices, or what to install. */
BP_API BpStatus bp_device_find(const char *text, BpDeviceInfo *device, BpError *err);

/* ---- rendering --------------------------------------------------------------------------------------- */

typedef enum BpPrecision { BP_PRECISION_SINGLE, BP_PRECISION_DOUBLE } BpPrecision;
typedef enum BpMath { BP_MATH_STRICT, BP_MATH_FAST } BpMath;
typedef enum BpNumerics { BP_NUMERICS_ROBUST, BP_NUMERICS_PLAIN } BpNumerics;
typedef enum BpSampler { BP_SAMPLER_INDEPENDENT, BP_SAMPLER_SOBOL } BpSampler;
/* How a kernel shares out the samples; pictures are the same. */
typedef enum BpKernelForm {
    BP_KERNEL_AUTO, /* packets on processors with vectors; on GPUs what is tried and kept at the first use */
    BP_KERNEL_SAMPLE, /* a work-item traces one pixel sample */
    BP_KERNEL_PACKET, /* a work-item follows as many paths at a time as there are lanes */
    BP_KERNEL_POOL    /* a work-item whose path has ended takes the next sample of its work-group */
} BpKernelForm;

/* Whether rays are sent to lamps; without, paths find them by chance. Both converge to the same picture. */
typedef enum BpLightSampling { BP_LIGHT_SAMPLING_ON, BP_LIGHT_SAMPLING_OFF } BpLightSampling;

/* Whether rays are sent to lamps through balls of glass and off mirrors; without, paths find that light by
 * chance. Both converge to the same picture. */
typedef enum BpCaustics {
    BP_CAUSTICS_AUTO, /* on if the light would be so rare by chance that they are worth their time, which
                         follows from the scene; reports and films then have one of the others */
    BP_CAUSTICS_OFF,
    BP_CAUSTICS_ON
} BpCaustics;

/* Whether deep paths that carry little end by chance, and those that go on carry more instead (Russian
 * roulette). Pictures take less time and have hardly more noise. Both converge to the same picture. */
typedef enum BpRoulette { BP_ROULETTE_ON, BP_ROULETTE_OFF } BpRoulette;

/* Start from bp_render_defaults(). */
typedef struct BpRenderOptions {
    uint64_t samples_per_pixel; /* 1 .. 2^32 - first_sample */
    uint64_t first_sample;      /* absolute number of the first sample of every pixel */
    uint32_t max_depth;         /* ray segments; 0 is black */
    uint64_t seed;
    BpPrecision precision;
    BpMath math;
    BpNumerics numerics;
    BpSampler sampler; /* `ballpark render` uses Sobol's sequence, which has less noise in the same time */
    BpLightSampling light_sampling; /* on has no effect in a scene that does not call for it; reports and
                                       films then record off */
    BpCaustics caustics;            /* the same; off without light sampling; BP_CAUSTICS_AUTO is off with
                                       samples_only */
    BpRoulette roulette; /* on has no effect where no path is so deep, or all surfaces pass on all light;
                            reports and films then record off */
    BpKernelForm kernel;
    bool all_effects;       /* build the general kernel instead of the specialised one */
    uint32_t extra_effects; /* bit e: simulate effect e of bp_scene_effect() although nothing calls for it */
    bool adaptive;          /* samples_per_pixel is a mean: pixels get samples where the error is */
    bool features;          /* depth, normal and albedo are needed, for bp_render_aovs() or in films */
    bool samples_only; /* errors are not needed: no paths look for light that samples may not have found */
    bool force;        /* render even on a device that fails its self-test */
    uint64_t job_first,
        job_samples; /* the samples of the job of which this render is a share; 0, 0: none. Kept in films */
    uint32_t replicates; /* K of the error estimate; 0: the default; 1: no estimate */
    uint32_t threads;    /* that a processor may use, as far as its driver can divide it; 0: all */
    /* For tests and tuning; 0 means: choose. None of these changes a picture, except that force_float_refine
     * may change the last digits in single precision: its transforms are as accurate as double, and round
     * differently. */
    uint32_t chunk_samples;  /* samples in one dispatch */
    uint32_t local_size;     /* work-items in a work-group; at most 64 in the sample form */
    uint32_t tree_width;     /* children of a tree node: 2, 4, 8 or 16 */
    uint32_t packet_lanes;   /* paths that a work-item of the packet form follows at a time: 8 or 16 */
    bool force_list;         /* no tree, however many spheres */
    bool force_tree;         /* a tree, however few */
    bool force_float_refine; /* error-free float transforms even where the device has double */
    uint64_t build_mark;     /* written into the kernel as an unused type: a new one makes every cache miss */
} BpRenderOptions;

/* Samples and depth of the scene; zeros elsewhere, which are the first choice of each enumeration. */
BP_API void bp_render_defaults(const BpScene *scene, BpRenderOptions *options);

typedef struct BpRender BpRender;
typedef struct BpFilm BpFilm; /* see "films" below */

typedef struct BpProgress {
    uint64_t samples_done, samples_total; /* of all pixels together */
    double trace_seconds;                 /* spent in bp_render_step() so far */
    bool finished;
} BpProgress;

/* Opens a render. `options`: Optional; NULL means the defaults. `devices`: Optional, `device_count` of them;
 * a count of 0 means the default device. The scene must outlive the render, unchanged. Builds the kernel, so
 * this can take a second. BP_ERR_USAGE: an option is out of range; BP_ERR_LIMIT: more samples or pixels than
 * sums or the device hold; BP_ERR_BUILD: the driver cannot build the kernel, and the error's attachment is
 * its log; BP_ERR_DEVICE: it lacks something, or fails its self-test. */
BP_API BpStatus bp_render_create(const BpScene *scene, const BpRenderOptions *options,
                                 const BpDeviceInfo *devices, size_t device_count, BpRender **render,
                                 BpError *err);

/* Traces for about 0.2 s and returns. `progress`: Optional. Does nothing once the render has finished. */
BP_API BpStatus bp_render_step(BpRender *render, BpProgress *progress, BpError *err);

/* More samples: raises options.samples_per_pixel to `samples_per_pixel`, and the render is no longer
 * finished. Before the first step it may lower it as well. The picture is the one that a render of so many
 * samples gives at once; only what an adaptive render does depends on the numbers on the way too.
 * BP_ERR_USAGE: a lower number, or past the last sample number; BP_ERR_LIMIT: more than the sums hold. */
BP_API BpStatus bp_render_extend(BpRender *render, uint64_t samples_per_pixel, BpError *err);

/* Continues from the film of an earlier render of the same scene and options, whether that had finished or
 * was stopped at any moment: the sums are then those of one render, bit for bit, and so is what adaptive
 * sampling and stop rules decide. Before the first step; options.samples_per_pixel becomes what the other was
 * on its way to. The film is copied. BP_ERR_USAGE: it is of another scene or other options, which the error
 * names, or merged of parts that are not one range of samples; BP_ERR_FILE: it contradicts itself. After a
 * failure destroy the render. */
BP_API BpStatus bp_render_resume(BpRender *render, const BpFilm *film, BpError *err);

/* Samples that every pixel has so far (a pass in progress not counted); of an adaptive render, their mean. */
BP_API uint64_t bp_render_samples_done(const BpRender *render);

BP_API void bp_render_destroy(BpRender **render);

/* ---- stop rules -------------------------------------------------------------------------------------- */

/* When a render has enough samples: at the first of these. Start from bp_stop_rule_defaults(). */
typedef struct BpStopRule {
    double error; /* NRMSE to reach: noise as a share of the mean brightness, 0.01 is 1 %; 0: no such rule */
    double seconds; /* since bp_stop_create(); 0: no such rule. Every pixel gets one sample in any case. */
    uint64_t samples_max; /* a pixel; 0: as many as the sums hold, at the default of 4 replicates 2^26 */
    uint64_t samples_min; /* a pixel, before the error is believed; unless samples_max is less */
    bool adaptive;        /* as in the render's options */
} BpStopRule;

typedef enum BpStopReason {
    BP_STOP_NOT_YET,
    BP_STOP_SAMPLES,
    BP_STOP_ERROR,
    BP_STOP_TIME,
    BP_STOP_CONSTANT, /* no two samples of a pixel differ, so no error is left */
    BP_STOP_BLACK,    /* no sample brought light, so an error relative to brightness does not exist */
    BP_STOP_INVALID   /* a pixel has no valid sample, or next to none, so the error stays unknown */
} BpStopReason;

/* "samples", "error", "time", "constant", "black", "invalid"; "interrupt" for not yet; static. */
BP_API const char *bp_stop_reason_name(BpStopReason reason);

/* No error, no time, the options' samples as the limit, and a minimum that suits the picture's size: 16
 * samples per pixel, and 65536 in all. */
BP_API void bp_stop_rule_defaults(const BpScene *scene, const BpRenderOptions *options, BpStopRule *rule);

/* A render followed by a rule. */
typedef struct BpStop BpStop;

/* Begins to follow a render that has made no step yet; its clock starts now. The rule decides from here on
 * how many samples the render gets. The render must outlive it. BP_ERR_USAGE: the render has begun, the rule
 * is out of range, has no limit at all, or is adaptive where the render is not. */
BP_API BpStatus bp_stop_create(BpRender *render, const BpStopRule *rule, BpStop **stop, BpError *err);

/* Call it after every bp_render_step(), with the progress that it returned. *reason: why to stop;
 * BP_STOP_NOT_YET: continue; the render has been given more samples if it had finished the earlier ones. The
 * error is checked only at fixed sample counts, so the same scene, seed and error end at the same count on
 * every run; time ends a render at a whole number of samples, unless it slowed down. */
BP_API BpStatus bp_stop_check(BpStop *stop, const BpProgress *progress, BpStopReason *reason, BpError *err);

/* The progress of a render, for a progress bar. */
typedef struct BpStopEstimate {
    double seconds;            /* since bp_stop_create() */
    double samples_per_second; /* of all pixels together */
    double nrmse;              /* NaN: unknown */
    double fraction;           /* of the way, 0 to 1 */
    double seconds_left;       /* NaN: unknown */
} BpStopEstimate;

/* After a step, as often as wanted: it reads the sums to look at the error, but spends at most 2 % of the
 * time on that. */
BP_API BpStatus bp_stop_estimate(BpStop *stop, const BpProgress *progress, BpStopEstimate *estimate,
                                 BpError *err);

BP_API void bp_stop_destroy(BpStop **stop);

/* ---- pictures ---------------------------------------------------------------------------------------- */

/* Linear radiance, row 0 at the top, 3 floats per pixel. The arrays may be read and changed in place; they
 * are released by bp_picture_clear() alone. */
typedef struct BpPicture {
    uint32_t width, height;
    float *rgb;        /* width * height * 3 */
    float *error;      /* standard error of each channel's mean, same shape; NaN where unknown */
    uint64_t *samples; /* valid samples of each pixel */
    float *alpha; /* Optional: share of camera rays that met something, of a scene without a backdrop; rgb is
                     then premultiplied by it */
    /* Optional, see bp_render_aovs(): of what each pixel shows first, averaged over camera rays. */
    float *depth; /* along the view direction from the camera, mean of the rays that met something; +Inf: none
                     did */
    float *normal; /* 3 a pixel; unit, facing the camera, in the scene's axes; a ray that met nothing counts
                      as 0 */
    float *albedo; /* 3 a pixel; share of light scattered: the colour, 1 for glass, 0 for lamps and for
                      nothing */
} BpPicture;

/* Reads the picture as it stands, during or after the render. What `picture` held is not released: clear it
 * before it is filled again. */
BP_API BpStatus bp_render_read(BpRender *render, BpPicture *picture, BpError *err);
/* Adds depth, normal and albedo to a picture that bp_render_read() filled, for a render that was created with
 * options.features: from the camera rays of samples 0 to 15 of each pixel, whichever samples the render is
 * of, by the first device. What the picture held of them is released. BP_ERR_USAGE: without options.features,
 * or for a picture of another size. */
BP_API BpStatus bp_render_aovs(BpRender *render, BpPicture *picture, BpError *err);
/* Light that the samples of a picture find by chance only: it comes to matte surfaces via glass or
 * mirrors, or from triangles that emit, or is seen in mirrors or through glass, or is smaller than a pixel.
 * It follows from the scene and the camera, whatever has been sampled; and until samples have found it, it is
 * added to bp_film_nrmse() and the errors of pixels. Luminances, means over the picture. */
#define BP_UNSEEN_SPHERES 3
typedef struct BpUnseenLight {
    double mean;   /* that it adds to a sample; 0: there is no such light */
    double square; /* the mean of its square: nearly the variance of a sample */
    double found;  /* the share of samples that find it, by the light that each brings: mean^2 / square */
    size_t sphere_count; /* spheres via which most of the noise comes, with their parts of `square` */
    size_t spheres[BP_UNSEEN_SPHERES];
    double parts[BP_UNSEEN_SPHERES];
    double triangles;         /* the part of `square` via triangles, and the material of most of them */
    size_t triangle_material; /* as the scene counts materials; 0 where there is no such part */
    double direct;  /* the part of `square` with nothing in between: of lights that are seen, and triangles
                       that emit */
    double seconds; /* that looking for it took */
} BpUnseenLight;

/* Traces the paths that look for it, if that has not been done; with light sampling off
 * (BP_LIGHT_SAMPLING_OFF), all light is found by chance, and this finds nothing. */
BP_API BpStatus bp_render_unseen(BpRender *render, BpUnseenLight *light, BpError *err);

/* `picture`: Optional. */
BP_API void bp_picture_clear(BpPicture *picture);

typedef enum BpFormat {
    BP_FORMAT_PNG,
    BP_FORMAT_PPM,
    BP_FORMAT_PPM_ASCII,
    BP_FORMAT_PFM,
    BP_FORMAT_EXR, /* with what there is of alpha, error, samples, depth, normal and albedo as layers */
    BP_FORMAT_BPA, /* sums, not a picture: bp_film_write() */
    BP_FORMAT_PDF, /* these two are written by the program alone */
    BP_FORMAT_SVG
} BpFormat;

/* Writes atomically: a temporary file beside `path`, renamed when whole. `transfer` is for the 8-bit formats,
 * PNG and PPM. BP_ERR_FILE: it cannot be written; BP_ERR_USAGE: an empty picture, or a format that holds
 * sums or that the program alone writes. */
BP_API BpStatus bp_picture_write(const BpPicture *picture, const char *path, BpFormat format,
                                 BpTransfer transfer, BpError *err);

/* The same file in memory: *bytes, of *size, to be released with bp_free(). *bytes is NULL before, and stays
 * so on failure. */
BP_API BpStatus bp_picture_encode(const BpPicture *picture, BpFormat format, BpTransfer transfer,
                                  void **bytes, size_t *size, BpError *err);

/* The bytes of an 8-bit file: width * height * 3 of them, in `rgb`, row 0 at the top. */
BP_API void bp_picture_bytes(const BpPicture *picture, BpTransfer transfer, uint8_t *rgb);

/* ---- error maps -------------------------------------------------------------------------------------- */

/* Standard error of a pixel's luminance over its luminance, a fraction; NaN where it is unknown, +Inf for
 * black with an error. `pixel`: row * width + column. The error of the luminance is taken as the weighted sum
 * of its channels' (Rec. 709), which is exact if the errors of the channels are fully correlated, as they
 * nearly are, and too large otherwise. The picture must have `error`. */
BP_API double bp_pixel_relative_error(const BpPicture *picture, size_t pixel);

/* The colour of a relative error on a map, 8-bit sRGB: from dark at 0.1 % and below to bright at 100 % and
 * above, by logarithm; grey for NaN. */
BP_API void bp_error_color(double relative_error, uint8_t rgb[3]);

/* Writes a map of the picture's errors with a legend as a PNG, atomically. The scale is the same for every
 * picture, so that two maps can be compared; small pictures are enlarged. BP_ERR_USAGE: the picture has no
 * errors; BP_ERR_FILE: it cannot be written. */
BP_API BpStatus bp_error_map_write(const BpPicture *picture, const char *path, BpError *err);

/* ---- films: the sums behind a picture ---------------------------------------------------------------- */

/* A BpFilm holds the exact sums of a render's samples, which can be kept in a file (.bpa) and added to those
 * of other samples of the same picture. */

/* The sums of a render as they stand, during or after it: a film of the caller's own, which the render does
 * not change. With options.features it has depth, normal and albedo too; and unless the render has finished,
 * it records how to continue (bp_render_resume()). */
BP_API BpStatus bp_render_film(BpRender *render, BpFilm **film, BpError *err);

/* Reads a .bpa file. BP_ERR_FILE: it cannot be read, or is damaged, as the error describes. */
BP_API BpStatus bp_film_read(const char *path, BpFilm **film, BpError *err);

/* Writes a .bpa file, atomically. BP_ERR_FILE. */
BP_API BpStatus bp_film_write(const BpFilm *film, const char *path, BpError *err);

/* Adds `from` to `into`, exactly: the result is the film of one render of all their samples. BP_ERR_USAGE:
 * they are not of the same scene, size and options, or have samples in common, as the error describes;
 * BP_ERR_LIMIT: more samples than the sums hold. `into` is unchanged on failure. */
BP_API BpStatus bp_film_merge(BpFilm *into, const BpFilm *from, BpError *err);

/* The picture of the sums, to be cleared by the caller, as bp_render_read() gives it, with depth, normal and
 * albedo if the film has them. */
BP_API BpStatus bp_film_picture(const BpFilm *film, BpPicture *picture, BpError *err);

/* NRMSE = sqrt(mean over pixels of the squared standard error of luminance) / mean luminance, a fraction.
 * Both include light that samples find by chance and may not have found yet (BpUnseenLight). NaN where it is
 * unknown: the picture is black, or a pixel has too few samples. */
BP_API double bp_film_nrmse(const BpFilm *film);
/* The part of its square, 0 to 1, that stands for light which samples may not have found yet. */
BP_API double bp_film_unseen_part(const BpFilm *film);

typedef struct BpFilmInfo {
    const char *title;          /* of the scene, or ""; valid while the film lives */
    uint32_t width, height;     /* pixels */
    uint64_t samples_per_pixel; /* that the film is of; where it is partial, not every pixel has them all */
    uint64_t samples_least, samples_most; /* valid samples of the pixels that have the fewest and the most */
    double samples_mean;
    size_t range_count;                                  /* see bp_film_range() */
    bool partial;                                        /* of an interrupted or an adaptive render */
    uint64_t segments, truncated_paths, invalid_samples; /* in all: ray segments; paths that the depth ended;
                                                      samples that are left out of the picture: */
    /* those that had a channel that was NaN or infinite; of the others, those that had a negative one; and
     * those that were finite but brighter than the sums can hold. */
    uint64_t not_finite_samples, negative_samples, out_of_range_samples;
    uint64_t shadow_rays; /* sent to lamps, in all; they do not count as segments */
    /* Properties that two films must share to be merged. */
    uint64_t scene_hash; /* of all in a scene that can change radiance */
    uint64_t seed;
    uint32_t max_depth, replicates;
    BpSampler sampler;
    BpPrecision precision;
    BpMath math;
    BpNumerics numerics;
    BpLightSampling light_sampling;
    BpCaustics caustics;
    BpRoulette roulette;
    BpTransfer transfer; /* of the scene, for writing the picture */
} BpFilmInfo;
BP_API void bp_film_info(const BpFilm *film, BpFilmInfo *info);

/* Gets one of the film's ranges of sample numbers, in rising order: *count samples from *first on.
 * False, and nothing is written, for an `index` that is not below range_count. */
BP_API bool bp_film_range(const BpFilm *film, size_t index, uint64_t *first, uint64_t *count);

BP_API void bp_film_destroy(BpFilm **film);

/* ---- studies: what accuracy costs -------------------------------------------------------------------- */

/* What `ballpark cost` does: renders a scene with many settings, and reports the time and the error of each.
 */
typedef struct BpStudy BpStudy;

/* Begins a study. `scene`: of the size to study, 240 pixels wide for example; larger ones take longer
 * to tell errors apart; it must outlive the study, unchanged. `options`: Optional; what a render would use,
 * NULL meaning the defaults. `device`: Optional; NULL means the default one. `full_width`, `full_height`:
 * pixels of the picture that the advice is for; 0 means the scene's own. `seconds`: the budget, above 0 and
 * counted from here; a study takes longer where two sample counts do not fit. Run nothing else meanwhile,
 * other threads of this process least of all: their time is measured too. BP_ERR_USAGE: no budget. */
BP_API BpStatus bp_study_create(const BpScene *scene, const BpRenderOptions *options,
                                const BpDeviceInfo *device, uint32_t full_width, uint32_t full_height,
                                double seconds, BpStudy **study, BpError *err);

typedef struct BpStudyProgress {
    char doing[80]; /* what it is doing, as a readable text */
    double fraction, seconds_left;
    bool finished;
} BpStudyProgress;

/* Works for about 0.2 s; a step that builds a kernel takes longer. `progress`: Optional. BP_ERR_SCENE: the
 * picture is black, so that no error is relative to anything; else as bp_render_create(). */
BP_API BpStatus bp_study_step(BpStudy *study, BpStudyProgress *progress, BpError *err);

/* Ends it early, with the sample counts that every setting has reached. BP_ERR_INTERRUPTED: fewer than two.
 */
BP_API BpStatus bp_study_stop(BpStudy *study, BpError *err);

typedef enum BpStudyFormat {
    BP_STUDY_TABLE, /* plain text, for a terminal */
    BP_STUDY_JSON,
    BP_STUDY_CSV,
    BP_STUDY_PAGE /* one HTML file that needs no other */
} BpStudyFormat;

/* The results of a study that has finished or was stopped, as a text that ends with a zero byte. Release
 * *text with bp_free(); it is NULL before, and stays so on failure. BP_ERR_USAGE: the study has not finished.
 */
BP_API BpStatus bp_study_text(const BpStudy *study, BpStudyFormat format, char **text, BpError *err);

BP_API void bp_study_destroy(BpStudy **study);

#ifdef __cplusplus
}
#endif
#endif
