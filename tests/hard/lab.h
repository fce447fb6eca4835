/* lab.h: runs the product's own functions on a device, on numbers that a test made.
 *
 * In:    a variant of the program, a kernel of probe.cl, arrays.   Out: arrays.
 * Knows: the engine, OpenCL.   Does not know: spheres, what the numbers mean.
 *
 * Any failure ends the process with its message: a test cannot go on without its device. */
#ifndef TESTS_HARD_LAB_H
#define TESTS_HARD_LAB_H

#include "base/random.h"
#include "render/worker.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* Reals an item of the probe kernels' arrays; probe.cl has the same numbers. */
enum {
    RAY_REALS = 10,
    HIT_REALS = 8,
    POINT_REALS = 10,
    PATH_SEGMENTS = 12,
    PATH_REALS = 2 * PATH_SEGMENTS + 4
};
enum { RAY_HIGH = 0, RAY_LOW = 3, RAY_DIRECTION = 6, RAY_SLACK = 9 };
enum { HIT_T, HIT_MET, HIT_ENTERS, HIT_NEAR, HIT_FAR, HIT_MEETS, HIT_MIDDLE, HIT_SLOT };
enum { POINT_HIGH = 0, POINT_LOW = 3, POINT_SLACK = 6, POINT_NORMAL = 7 };

typedef struct Lab {
    const char *name; /* "double", "float", "all-double", "fast", "plain" */
    BpDeviceInfo info;
    BpDevice *device;
    BpProgramOptions options;
    BpProgram *program;
    bool real_double, refined_double;
} Lab;

/* Opens the device BALLPARK_TEST_DEVICE names, or the default one, and builds the variant. "double": float
 * data, refined in double; "float": refined by error-free float transforms; "all-double": --precision double;
 * "fast": "float" under --math fast; "plain": --numerics plain. False: the device has no double, and the
 * variant needs it; or there is no device. */
bool lab_open(Lab *lab, const char *variant);
void lab_close(Lab *lab);

/* One argument of a kernel. Host arrays of reals are doubles, narrowed on the way (they should hold floats).
 */
typedef enum LabKind {
    LAB_REALS,   /* const double *, to the device as reals */
    LAB_REFINED, /* const double *, to the device as refined */
    LAB_WORDS,   /* const uint32_t *, to the device */
    LAB_OUT_REALS,
    LAB_OUT_REFINED, /* double *, from the device */
    LAB_OUT_WORDS,
    LAB_NUMBER, /* a uint argument: `count` is its value */
    LAB_BYTES   /* any buffer as it is: `count` bytes */
} LabKind;
typedef struct LabArgument {
    LabKind kind;
    void *data;
    size_t count;
} LabArgument;

/* Runs `kernel` for `items` items: its first argument is their number, unless `scene` binds a scene's
 * arguments before it (`scene` Optional). */
void lab_run(const Lab *lab, const char *kernel, size_t items, const LabArgument *arguments,
             size_t argument_count, BpWorker *scene);

/* A worker for a scene, with the probe kernels in its program. */
BpWorker *lab_scene(const Lab *lab, const BpScene *scene);

/* Renders a scene as the product does, in this variant; the caller clears the picture. `invalid`: Optional.
 */
void lab_render(const Lab *lab, const BpScene *scene, uint64_t samples, uint64_t seed, BpPicture *picture,
                uint64_t *invalid);

/* x rounded to float. Through memory: gcc 12 at -O3 drops a conversion to float and back from loops that it
 * vectorises. */
static inline double lab_float(double x) {
    volatile float rounded = (float)x;
    return (double)rounded;
}

/* Every run has the same numbers. */
static inline uint64_t lab_bits(uint64_t *state) {
    BpRandom random = {*state};
    const uint64_t bits = bp_random_bits(&random);
    *state = random.state;
    return bits;
}
static inline double lab_unit(uint64_t *state) {
    return (double)(lab_bits(state) >> 11) * 0x1p-53;
}
/* A unit vector, evenly distributed. */
static inline void lab_direction(uint64_t *state, double v[3]) {
    const double z = 2 * lab_unit(state) - 1, turn = 6.283185307179586 * lab_unit(state), r = sqrt(1 - z * z);
    v[0] = r * cos(turn);
    v[1] = r * sin(turn);
    v[2] = z;
}
static inline double lab_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline void lab_cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
/* Scales v to unit length in double, then rounds each part to float: as near to unit length as a kernel's
 * directions are. */
void lab_float_unit(double v[3]);
/* Brings the directions of `count` rays to the unit length that a variant in double throughout has; leaves
 * them to the others. */
void lab_unit_rays(const Lab *lab, size_t count, double *rays);

#endif
