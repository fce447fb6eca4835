/* field.c: see field.h. */
#include "field.h"

#include "base/plural.h"
#include "base/random.h"
#include "scene/scene.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { SPHERE_BYTES = 19, SPHERES_AT_ONCE = 4096 };

static unsigned char *put_float(unsigned char *out, float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++) *out++ = (unsigned char)(bits >> 8 * i & 0xffu);
    return out;
}

static unsigned char *put_sphere(unsigned char *out, double spacing, BpRandom *random) {
    for (int i = 0; i < 3; i++)
        out = put_float(out, (float)(BP_FIELD_HALF_SIDE * (2 * bp_random_next(random) - 1)));
    out = put_float(out, (float)(spacing * (0.1 + 0.3 * bp_random_next(random))));
    for (int i = 0; i < 3; i++)
        *out++ = (unsigned char)(64 + 192 * bp_random_next(random)); /* no near blacks */
    return out;
}

BpStatus bp_field_print_ply(uint64_t count, uint64_t seed, FILE *stream, BpError *err) {
    if (count < 1 || count > BP_SPHERES_MAX)
        return bp_fail(err, BP_ERR_USAGE, "count: found %" PRIu64 ", expected 1 to %u spheres", count,
                       BP_SPHERES_MAX);
    unsigned char block[SPHERE_BYTES * SPHERES_AT_ONCE];
    const double spacing = 2 * BP_FIELD_HALF_SIDE / cbrt((double)count);
    BpRandom random = {seed};
    fprintf(
        stream,
        "ply\nformat binary_little_endian 1.0\ncomment random field, seed %" PRIu64
        "\nelement vertex %" PRIu64 "\nproperty float x\nproperty float y\nproperty float z\n"
        "property float radius\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
        seed, count);
    for (uint64_t done = 0; done < count;) {
        const uint64_t some = count - done < SPHERES_AT_ONCE ? count - done : SPHERES_AT_ONCE;
        unsigned char *end = block;
        for (uint64_t i = 0; i < some; i++) end = put_sphere(end, spacing, &random);
        if (fwrite(block, SPHERE_BYTES, (size_t)some, stream) != some)
            return bp_fail(err, BP_ERR_FILE, "cannot write the field after %" PRIu64 " sphere%s: %s", done,
                           bp_plural(done), strerror(errno));
        done += some;
    }
    return BP_OK;
}
