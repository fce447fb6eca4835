/* bpa_mutator.c: see bpa_mutator.h. */
#include "bpa_mutator.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#define SUMS_BYTES 24u /* of a cell: three of 8 bytes */
#define COUNT_BYTES 4u
#define AOV_BYTES 28u  /* of a pixel */
#define TINT_BYTES 12u /* of the unseen light */
#define CHECKSUM_BYTES 4u

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t size_max); /* libFuzzer's own */

/* The header line's length, with its newline; 0: there is none. */
static size_t header_length(const uint8_t *data, size_t size) {
    const uint8_t *end = size > 0 ? memchr(data, '\n', size) : NULL;
    return end == NULL ? 0 : (size_t)(end - data) + 1;
}

static uint32_t next(uint32_t *state) { /* Numerical Recipes' quick generator: only speed matters */
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* Gives one member of the header a value near what is allowed. */
static void change_member(json_t *header, uint32_t *state) {
    static const char *const sizes[] = {"width", "height", "replicates"};
    static const char *const numbers[] = {"scale_log2",      "max_depth",   "segments",     "cut_paths",
                                          "invalid_samples", "shadow_rays", "ballpark_film"};
    static const json_int_t values[] = {0,    1,   2,       3,       -1,        126,
                                        -126, 127, 1000000, 1000001, INT64_MAX, INT64_MIN};
    static const char *const words[][2] = {{"sampler", "sobol"},       {"sampler", "independent"},
                                           {"precision", "single"},    {"precision", "double"},
                                           {"math", "strict"},         {"math", "fast"},
                                           {"numerics", "plain"},      {"transfer", "linear"},
                                           {"transfer", "srgb"},       {"seed", "18446744073709551615"},
                                           {"scene_hash", "ffffffff"}, {"title", "a\x1b[31m\n"}};
    switch (next(state) % 6) {
    case 0:
        json_object_set_new(header, sizes[next(state) % 3], json_integer(1 + next(state) % 6));
        break;
    case 1:
        json_object_set_new(header, numbers[next(state) % (sizeof numbers / sizeof *numbers)],
                            json_integer(values[next(state) % (sizeof values / sizeof *values)]));
        break;
    case 2: {
        const char *const *pair = words[next(state) % (sizeof words / sizeof *words)];
        json_object_set_new(header, pair[0], json_string(pair[1]));
        break;
    }
    case 3: {
        static const char *const switches[] = {"fine_sums",      "coarse", "partial", "aovs",
                                               "pixel_segments", "alpha",  "unseen"};
        json_object_set_new(header, switches[next(state) % 7], json_boolean(next(state) % 2 == 0));
        break;
    }
    case 4: {
        static const char *const members[] = {"first_sample", "target",      "done",          "pass_samples",
                                              "next_pixel",   "samples_max", "decision_bytes"};
        json_t *plan = json_object_get(header, "plan");
        if (plan == NULL) {
            plan = json_pack("{s:b,s:b,s:i,s:i,s:i,s:i,s:i,s:i,s:f,s:i}", "adaptive", (int)(next(state) % 2),
                             "ended", 0, "first_sample", 0, "target", 8, "done", 4, "pass_samples", 0,
                             "next_pixel", 0, "samples_max", 8, "error", 0.5, "decision_bytes", 0);
            json_object_set_new(header, "plan", plan);
            break;
        }
        if (next(state) % 8 == 0)
            json_object_del(header, "plan");
        else
            json_object_set_new(plan, members[next(state) % 7], json_integer(next(state) % 70));
        break;
    }
    default: {
        json_t *ranges = json_array();
        json_int_t first = next(state) % 3;
        for (uint32_t i = next(state) % 4; i > 0; i--) {
            const json_int_t count = next(state) % 8 == 0 ? 1 << 24 : 1 + next(state) % 40;
            json_array_append_new(ranges, json_pack("[I,I]", first, count));
            first += count + (json_int_t)(next(state) % 3);
        }
        json_object_set_new(header, "ranges", ranges);
    }
    }
}

static bool says(const json_t *header, const char *member) {
    return json_is_true(json_object_get(header, member));
}

/* How many bytes of numbers there should be; 0: the header does not say, or more than `room`. */
static size_t body_length(const json_t *header, size_t room) {
    const bool fine = says(header, "fine_sums");
    uint64_t pixels = 1;
    static const char *const sizes[] = {"width", "height", "replicates"};
    json_int_t sides[3];
    for (size_t i = 0; i < 3; i++) {
        sides[i] = json_integer_value(json_object_get(header, sizes[i]));
        if (sides[i] < 1 || sides[i] > 65535) return 0;
    }
    pixels = (uint64_t)sides[0] * (uint64_t)sides[1];
    if (pixels > room || pixels * (uint64_t)sides[2] > room) return 0;
    uint64_t bytes = pixels * (uint64_t)sides[2] * ((fine ? 2 : 1) * SUMS_BYTES + COUNT_BYTES);
    const json_int_t decisions =
        json_integer_value(json_object_get(json_object_get(header, "plan"), "decision_bytes"));
    bytes += pixels * ((says(header, "aovs") ? AOV_BYTES : 0) + (says(header, "pixel_segments") ? 8 : 0) +
                       (says(header, "alpha") ? 8 : 0) + (says(header, "unseen") ? 8 : 0));
    if (says(header, "unseen")) bytes += TINT_BYTES;
    if (decisions < 0 || decisions > 65535) return 0;
    bytes += (uint64_t)decisions;
    return bytes <= room ? (size_t)bytes : 0;
}

/* The numbers of a file's body, unpacked if they can be, in new memory. */
static uint8_t *take_numbers(const uint8_t *body, size_t size, size_t *count) {
    const uLong room = 1u << 20;
    uint8_t *numbers = malloc(room > size ? room : size);
    if (numbers == NULL) abort();
    uLongf unpacked = room;
    *count = size;
    if (uncompress(numbers, &unpacked, body, (uLong)size) == Z_OK)
        *count = unpacked;
    else
        memcpy(numbers, body, size);
    return numbers;
}

/* Appends the checksum of all before it. */
static size_t append_checksum(uint8_t *data, size_t size) {
    const uLong checksum = crc32_z(crc32_z(0, NULL, 0), data, size);
    for (size_t i = 0; i < CHECKSUM_BYTES; i++) data[size + i] = (uint8_t)(checksum >> (8 * i));
    return size + CHECKSUM_BYTES;
}

size_t bpa_mutate(uint8_t *data, size_t size, size_t size_max, unsigned seed) {
    uint32_t state = seed;
    const size_t head = header_length(data, size);
    json_t *header = head > 0 ? json_loadb((const char *)data, head, 0, NULL) : NULL;
    if (!json_is_object(header) || size - head <= CHECKSUM_BYTES || next(&state) % 8 == 0) {
        json_decref(header);
        return LLVMFuzzerMutate(data, size, size_max);
    }
    size_t body = size - head - CHECKSUM_BYTES;
    uint8_t *old = take_numbers(data + head, body, &body);
    if (next(&state) % 2 == 0 && body > 0)
        LLVMFuzzerMutate(old, body, body);
    else
        change_member(header, &state);

    size_t result = size;
    char *text = json_dumps(header, JSON_PRESERVE_ORDER | JSON_COMPACT);
    const size_t text_length = text != NULL ? strlen(text) + 1 : 0;
    const size_t around = text_length + CHECKSUM_BYTES;
    const size_t wanted = text != NULL && around < size_max ? body_length(header, size_max - around) : 0;
    uint8_t *numbers = calloc(1, wanted + 1);
    if (numbers == NULL) abort();
    memcpy(numbers, old, body < wanted ? body : wanted);
    uLongf packed = compressBound((uLong)wanted);
    if (wanted > 0 && packed <= size_max - around) {
        memcpy(data, text, text_length - 1);
        data[text_length - 1] = '\n';
        if (compress2(data + text_length, &packed, numbers, (uLong)wanted, 0) != Z_OK) abort();
        result = append_checksum(data, text_length + packed);
    }
    free(numbers);
    free(text);
    free(old);
    json_decref(header);
    return result;
}
