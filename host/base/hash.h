/* hash.h: a hash of 64 bits for keys and checksums; it is not cryptographic.
 *
 * In:    bytes.   Out: their hash.
 * Knows: FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo).   Does not know: what is hashed. */
#ifndef BP_BASE_HASH_H
#define BP_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#define BP_HASH_START 0xcbf29ce484222325u

/* Continues `hash`, which begins as BP_HASH_START. A change of one byte always changes the result. */
static inline uint64_t bp_hash_bytes(uint64_t hash, const void *bytes, size_t count) {
    const unsigned char *at = bytes;
    for (size_t i = 0; i < count; ++i) hash = (hash ^ at[i]) * 0x100000001b3u;
    return hash;
}

static inline uint64_t bp_hash_text(uint64_t hash, const char *text) {
    for (; *text != '\0'; ++text) hash = (hash ^ (unsigned char)*text) * 0x100000001b3u;
    return hash;
}

#endif
