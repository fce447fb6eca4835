/* ply_type.h: the types of numbers in PLY files, for all readers: of clouds (formats/ply.c), of particles
 * (read_ply.c) and of meshes (meshes/read_ply.c).
 *
 * In:    a type's name, a number's bytes.   Out: the type, its size, the number.
 * Does not know: what properties mean. */
#ifndef BP_PARTICLES_PLY_TYPE_H
#define BP_PARTICLES_PLY_TYPE_H

#include "base/words.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The integers first. */
typedef enum PlyType {
    PLY_NONE,
    PLY_INT8,
    PLY_UINT8,
    PLY_INT16,
    PLY_UINT16,
    PLY_INT32,
    PLY_UINT32,
    PLY_FLOAT32,
    PLY_FLOAT64
} PlyType;

/* The names of types in files. */
enum { PLY_TYPE_NAMES = 16 };
extern const char *const ply_type_names[PLY_TYPE_NAMES];
/* The type named "float", "float32", ...; PLY_NONE: there is no such type. */
PlyType ply_type_named(const char *name);

/* The rest is inline, since millions of numbers are read. */

#define PLY_TYPE_SIZES(X)                                                                                    \
    X(PLY_NONE, 0)                                                                                           \
    X(PLY_INT8, 1)                                                                                           \
    X(PLY_UINT8, 1)                                                                                          \
    X(PLY_INT16, 2) X(PLY_UINT16, 2) X(PLY_INT32, 4) X(PLY_UINT32, 4) X(PLY_FLOAT32, 4) X(PLY_FLOAT64, 8)
BP_WORDS(PlyType, static const unsigned char ply_type_sizes, PLY_TYPE_SIZES);

/* Its size in bytes; 0 for PLY_NONE. */
static inline size_t ply_type_size(PlyType type) {
    return ply_type_sizes[type];
}

/* The number in ply_type_size() bytes; `swap`: their order is not this machine's. */
static inline double ply_decode(const unsigned char *bytes, PlyType type, bool swap) {
    unsigned char raw[8] = {0};
    if (swap) {
        const size_t size = ply_type_size(type);
        for (size_t i = 0; i < size; i++) raw[i] = bytes[size - 1 - i];
        bytes = raw;
    }
    switch (type) {
    case PLY_NONE:
        return 0;
    case PLY_INT8:
        return *(const signed char *)bytes;
    case PLY_UINT8:
        return *bytes;
#define PLY_DECODE(name, c_type)                                                                             \
    case name: {                                                                                             \
        c_type value;                                                                                        \
        memcpy(&value, bytes, sizeof value);                                                                 \
        return (double)value;                                                                                \
    }
        PLY_DECODE(PLY_INT16, int16_t)
        PLY_DECODE(PLY_UINT16, uint16_t)
        PLY_DECODE(PLY_INT32, int32_t)
        PLY_DECODE(PLY_UINT32, uint32_t)
        PLY_DECODE(PLY_FLOAT32, float)
        PLY_DECODE(PLY_FLOAT64, double)
#undef PLY_DECODE
    }
    return 0;
}

#endif
