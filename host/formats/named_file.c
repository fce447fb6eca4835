/* named_file.c: see named_file.h. */
#ifdef __linux__
#define _GNU_SOURCE /* memfd_create */
#endif
#include "named_file.h"

#include "base/input_file.h"
#include "base/json_memory.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* ---- reading ------------------------------------------------------------------------------------------ */

/* A stream that has a descriptor, as readers need. */
static BpStatus open_held(BpHeldFiles *held, const char *wanted, FILE **stream, uint64_t *size,
                          BpError *err) {
    const char *name = NULL, *bytes = NULL;
    size_t length = 0;
    for (size_t i = 0; (bytes = held(i, &name, &length)) != NULL && strcmp(name, wanted) != 0;) i++;
    if (bytes == NULL) return bp_fail(err, BP_ERR_SCENE, "it is not among the files of this program");
    *size = length;
#ifdef __linux__
    const int descriptor = memfd_create(name, MFD_CLOEXEC);
    size_t written = 0;
    for (ssize_t more = 1; descriptor >= 0 && written < length && more > 0;
         written += more > 0 ? (size_t)more : 0)
        more = write(descriptor, bytes + written, length - written);
    const bool whole = descriptor >= 0 && written == length && lseek(descriptor, 0, SEEK_SET) == 0;
    *stream = whole ? fdopen(descriptor, "rb") : NULL;
    if (*stream == NULL && descriptor >= 0) close(descriptor);
    if (*stream != NULL) return BP_OK;
#else
    *stream = tmpfile();
    if (*stream != NULL && fwrite(bytes, 1, length, *stream) == length && fseeko(*stream, 0, SEEK_SET) == 0)
        return BP_OK;
    if (*stream != NULL) fclose(*stream);
#endif
    return bp_fail(err, BP_ERR_MEMORY, "no memory for the file: %s", strerror(errno));
}

BpStatus bp_node_open_file(const BpNode *node, const char *path, const char *expected, FILE **stream,
                           uint64_t *size, BpError *err) {
    BpError inner = {0};
    BpHeldFiles *const held = node->document->held;
    BpStatus status = held != NULL ? open_held(held, path, stream, size, &inner)
                                   : bp_file_open(path, false, expected, stream, size, &inner);
    if (status != BP_OK) { /* the fault lies with the document, so the error stands there */
        char printable[256];
        bp_printable(path, printable, sizeof printable);
        const BpStatus at_node =
            bp_node_fail(node, BP_PART_VALUE, err, "\"%s\": %s", printable, inner.message);
        if (status != BP_ERR_MEMORY) status = at_node;
        bp_error_clear(&inner);
    }
    return status;
}

void bp_name_document(const BpNode *file_node, const char *what, BpError *err) {
    BpError place = {0};
    const size_t used = strlen(err->message);
    bp_node_fail(file_node, BP_PART_VALUE, &place, "%s", "");
    snprintf(err->message + used, sizeof err->message - used, " (%s of %.400s:%d:%d)", what, place.file,
             place.line, place.column);
    bp_error_clear(&place);
}

static BpStatus keep_file(const char *file, size_t first, const char *entry, BpShapeFile **files,
                          size_t *count, BpError *err) {
    BpShapeFile *const grown = realloc(*files, (*count + 1) * sizeof *grown);
    if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the name of a file");
    *files = grown;
    BpShapeFile *const kept = &grown[(*count)++];
    *kept = (BpShapeFile){.first = first};
    if (entry != NULL) BP_TRY(bp_copy_text(entry, &kept->entry, err));
    return bp_copy_text(file, &kept->file, err);
}

BpStatus bp_keep_point_file(const char *file, size_t first, const char *entry, BpScene *scene, BpError *err) {
    return keep_file(file, first, entry, &scene->point_files, &scene->point_file_count, err);
}

BpStatus bp_keep_mesh_file(const char *file, size_t first, const char *entry, BpScene *scene, BpError *err) {
    return keep_file(file, first, entry, &scene->mesh_files, &scene->mesh_file_count, err);
}

BpStatus bp_keep_line_set(const char *name, size_t first, BpScene *scene, BpError *err) {
    BP_TRY(keep_file(name, first, NULL, &scene->line_sets, &scene->line_set_count, err));
    scene->line_sets[scene->line_set_count - 1].in_memory = true;
    return BP_OK;
}

/* ---- a document at another place ----------------------------------------------------------------------- */

/* The part of `path` below the folder of `to`, or NULL. */
static const char *path_below(const char *path, const char *to) {
    const char *const slash = strrchr(to, '/');
    const size_t length = slash != NULL ? (size_t)(slash - to) + 1 : 0;
    if (length == 0) return path[0] != '/' ? path : NULL;
    return strncmp(path, to, length) == 0 && path[length] != '/' ? path + length : NULL;
}

/* How a document at the path `to` must name the file that `document` names as `file`: by its path below the
 * folder of `to` where it lies there, otherwise by its absolute path. The caller frees it. NULL: out of
 * memory, which *no_memory says, or no current folder. */
static char *path_moved(const char *document, const char *to, const char *file, bool *no_memory) {
    char folder[4096] = "/";
    char *const path = bp_path_beside(document, file);
    const char *const below = path != NULL ? path_below(path, to) : NULL;
    char *moved = NULL;
    if (below != NULL) {
        moved = strdup(below);
    } else if (path != NULL && (path[0] == '/' || getcwd(folder, sizeof folder - 2) != NULL)) {
        strcat(folder, folder[1] != '\0' ? "/" : "");
        moved = bp_path_beside(folder, path);
    }
    *no_memory = path == NULL || (below != NULL && moved == NULL);
    free(path);
    return moved;
}

BpStatus bp_shape_file_move(const char *document, const char *to, BpShapeFile *file, BpError *err) {
    BpStatus status = BP_OK;
    bool no_memory = false;
    char *const moved = path_moved(document, to, file->file, &no_memory);
    json_t *const entry = json_loads(file->entry, 0, NULL);
    char *text = NULL;
    if (moved != NULL && entry != NULL && json_object_set_new(entry, "file", json_string(moved)) == 0)
        text = json_dumps(entry, JSON_PRESERVE_ORDER);
    if (text == NULL && (no_memory || bp_json_memory_failed())) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for the path of %.200s", file->file);
    } else if (text == NULL) {
        status = bp_fail(err, BP_ERR_SCENE, "cannot name %.200s in UTF-8; write the document beside it",
                         file->file);
    } else {
        free(file->entry);
        file->entry = text;
        status = bp_copy_text(moved, &file->file, err);
    }
    json_decref(entry);
    free(moved);
    return status;
}

BpStatus bp_image_move(const char *document, const char *to, BpImage *image, BpError *err) {
    bool no_memory = false;
    char *const moved = path_moved(document, to, image->file, &no_memory);
    const BpStatus status =
        moved != NULL ? bp_copy_text(moved, &image->file, err)
                      : bp_fail(err, BP_ERR_MEMORY, "out of memory for the path of %.200s", image->file);
    free(moved);
    return status;
}
