/* fuzz.h: what the fuzz targets share: a check that stops the fuzzer, and numbers drawn from its bytes.
 *
 * In:    the bytes that the fuzzer tries.   Out: values, or a crash.
 * Knows: nothing of what is fuzzed. */
#ifndef BP_FUZZ_FUZZ_H
#define BP_FUZZ_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Stops the fuzzer, which keeps the input, unless what the target demands holds. */
static inline void require_at(bool holds, const char *file, int line, const char *text) {
    if (holds) return;
    fprintf(stderr, "%s:%d: this does not hold: %s\n", file, line, text);
    abort();
}
#define require(holds) require_at(holds, __FILE__, __LINE__, #holds)

/* Bytes that are taken one after the other; past their end they repeat, each time stirred differently, so
 * that a short input makes a whole picture or scene too. */
typedef struct Bytes {
    const uint8_t *data;
    size_t size, used;
} Bytes;

static inline uint8_t take_byte(Bytes *bytes) {
    if (bytes->size == 0) return 0;
    const size_t round = bytes->used / bytes->size;
    const uint8_t byte = bytes->data[bytes->used++ % bytes->size];
    return (uint8_t)(byte ^ (round * 0x9du));
}

static inline uint64_t take_bits(Bytes *bytes, size_t size) {
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++) bits |= (uint64_t)take_byte(bytes) << (8 * i);
    return bits;
}

static inline float take_float(Bytes *bytes) {
    const uint32_t bits = (uint32_t)take_bits(bytes, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double take_double(Bytes *bytes) {
    const uint64_t bits = take_bits(bytes, 8);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline bool at_end(const Bytes *bytes) {
    return bytes->used >= bytes->size;
}

#endif
