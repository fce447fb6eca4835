/* json_memory.c: see json_memory.h. */
#include "json_memory.h"

#include "encoding.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Global, since jansson's allocation functions take no context. It is never reset. */
static atomic_bool refused;

static void *allocate(size_t size) {
    void *bytes = malloc(size);
    if (bytes == NULL) refused = true;
    return bytes;
}

void bp_json_memory_watch(void) {
    json_set_alloc_funcs(allocate, free);
}

bool bp_json_memory_failed(void) {
    return refused;
}

json_t *bp_json_load(const char *text, size_t length, size_t flags, json_error_t *error, bool *no_memory) {
    const size_t mark = bp_text_mark(text, length);
    errno = 0;
    json_t *root = json_loadb(text + mark, length - mark, flags, error);
    *no_memory = bp_json_memory_failed() || (root == NULL && errno == ENOMEM);
    if (!*no_memory) return root;
    json_decref(root);
    return NULL;
}

char *bp_json_quote(const char *text, bool *no_memory) {
    const int before = errno; /* may hold the reason why a stream has failed */
    errno = 0;
    json_t *value = json_string(text);
    char *quoted = value != NULL ? json_dumps(value, JSON_ENCODE_ANY) : NULL;
    *no_memory = bp_json_memory_failed() || (quoted == NULL && errno == ENOMEM);
    json_decref(value);
    errno = before;
    if (!*no_memory) return quoted;
    free(quoted);
    return NULL;
}
