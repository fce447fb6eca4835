/* document.h: a JSON text as a tree of nodes that know their position in the text.
 *
 * In:    the text of a scene document.   Out: values, checked for type; errors with file:line:column.
 * Knows: JSON (jansson).                 Does not know: what a scene is.
 *
 * jansson keeps positions for syntax errors only. A node therefore remembers its path from the root, and an
 * error follows that path through the text (document_locate.c). Without errors, nothing is located. */
#ifndef BP_FORMATS_DOCUMENT_H
#define BP_FORMATS_DOCUMENT_H

#include "base/message_text.h"
#include "base/status.h"

#include <jansson.h>

/* Files that a program holds: the bytes, name and size of number `index`; NULL behind the last. */
typedef const char *BpHeldFiles(size_t index, const char **name, size_t *size);

typedef struct BpDocument {
    const char *name; /* stands in messages where a path would */
    const char *text; /* the caller's; without a byte order mark */
    size_t length;
    json_t *root;      /* an object */
    BpHeldFiles *held; /* Optional: the files that the document names are these, and no others */
    /* When members were changed since (document_change.h): */
    json_t *written; /* what the text says; NULL: the same as `root` */
    struct BpChange *changes;
    size_t change_count;
    const char *changed_by; /* what messages call a change, "--set"; the caller's */
} BpDocument;

/* A member that does not come from the text. */
typedef struct BpChange {
    char path[256];     /* as messages write it: "spheres[3].radius" */
    const char *origin; /* what changed it, "camera.vfov=30"; the caller's */
} BpChange;

/* One value of the document. Lives on the stack of its reader, and its parents below it. */
typedef struct BpNode {
    const BpDocument *document;
    const struct BpNode *parent; /* NULL: the root */
    const char *member;          /* its name in the parent; NULL: element `index` of a list */
    size_t index;
    json_t *value; /* borrowed; NULL: the member is absent */
} BpNode;

/* The place to which an error points: the value, or the name before the colon. */
typedef enum BpPart { BP_PART_VALUE, BP_PART_NAME } BpPart;

/* Parses `text`, which must outlive the document. Refuses what is not JSON, repeated members, and a root that
 * is not an object. Close what was opened. */
BpStatus bp_document_open(const char *text, size_t length, const char *name, BpDocument *document,
                          BpError *err);
void bp_document_close(BpDocument *document);

BpNode bp_node_root(const BpDocument *document);
BpNode bp_node_member(const BpNode *object, const char *name);
BpNode bp_node_element(const BpNode *list, size_t index);

/* Fails with BP_ERR_SCENE at the node's place; the message opens with its path, as "spheres[3].radius: ". */
BpStatus bp_node_fail(const BpNode *node, BpPart part, BpError *err, const char *format, ...)
    BP_PRINTF_LIKE(4, 5);
/* A description of a value, for a message: "an object", "the text \"sky\"", "20". */
void bp_json_describe(const json_t *value, char *out, size_t size);

/* Fails with "found X, expected `expected`". */
BpStatus bp_node_wrong(const BpNode *node, const char *expected, BpError *err);
/* The message about a name that `list` of the document lacks; the nearest of `names`, all that
 * are there, is proposed. `kind`: what the thing is called. */
enum { BP_MISSING_NAME_SIZE = 256 };
void bp_missing_name_text(const char *kind, const char *list, const char *const *names, size_t count,
                          const char *name, char out[BP_MISSING_NAME_SIZE]);
/* Finds `name` among `count` things of `size` bytes, each of which begins with its name; *number counts
 * from 1. Where there is none, *number is 0 and `missing` that text. BP_ERR_MEMORY. */
BpStatus bp_find_name(const char *name, const char *kind, const char *list, const void *things, size_t size,
                      size_t count, uint32_t *number, char missing[BP_MISSING_NAME_SIZE], BpError *err);
/* The same of what the node, a string, names. Fails with that text. */
BpStatus bp_node_find(const BpNode *node, const char *kind, const char *list, const void *things, size_t size,
                      size_t count, uint32_t *number, BpError *err);

/* Fails unless `object` has the member. `expected` says what it should be. */
BpStatus bp_node_require(const BpNode *object, const char *name, const char *expected, BpError *err);

/* The readers leave *value as it is when the node is absent, and fail when the type is wrong. */
BpStatus bp_node_object(const BpNode *node, const char *const *names, size_t name_count, BpError *err);
BpStatus bp_node_list(const BpNode *node, const char *expected, BpError *err);
BpStatus bp_node_number(const BpNode *node, double *value, BpError *err);
BpStatus bp_node_integer(const BpNode *node, uint32_t low, uint32_t high, uint32_t *value, BpError *err);
BpStatus bp_node_boolean(const BpNode *node, bool *value, BpError *err);
BpStatus bp_node_vector(const BpNode *node, double value[3], BpError *err);
BpStatus bp_node_string(const BpNode *node, const char **value, BpError *err);
/* One of `names`; the error names the nearest. */
BpStatus bp_node_choice(const BpNode *node, const char *const *names, size_t name_count, int *value,
                        BpError *err);

/* The offset in `text`, a valid JSON text, of the value reached by taking member or element steps[0] of the
 * root, steps[1] of that, and so on, or of the last step's name. */
size_t bp_json_locate(const char *text, size_t length, const size_t *steps, size_t step_count, BpPart part);
/* Line and column, from 1, of an offset; columns count characters, not bytes. */
void bp_text_position(const char *text, size_t length, size_t offset, int *line, int *column);

#define BP_COUNT(array) (sizeof(array) / sizeof *(array))

#endif
