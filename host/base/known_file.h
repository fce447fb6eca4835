/* known_file.h: recognises files that are often given by mistake.
 *
 * In:    a file's name and its first bytes.   Out: its kind, and advice.
 * Knows: the first bytes and names of such files.   Does not know: what was expected, or how to read them. */
#ifndef BP_BASE_KNOWN_FILE_H
#define BP_BASE_KNOWN_FILE_H

#include <stdbool.h>
#include <stddef.h>

typedef enum BpFileKind {
    BP_FILE_SUMS,      /* of a render: .bpa */
    BP_FILE_PICTURE,   /* that this program reads */
    BP_FILE_IMAGE,     /* a picture that others read */
    BP_FILE_GZIP,      /* which files of particles may be packed by */
    BP_FILE_PACKED,    /* otherwise */
    BP_FILE_PARTICLES, /* of other programs: trajectories, crystals */
    BP_FILE_POINTS,    /* of other programs: clouds and tables */
    BP_FILE_MESH,      /* that this program reads, from a file of its name */
    BP_FILE_SOURCE     /* of a program */
} BpFileKind;

typedef struct BpKnownFile {
    BpFileKind kind;
    const char *what; /* "a PNG picture"; static */
} BpKnownFile;

/* Whether it is one of them, by its first bytes or its name, which may be a path and need not exist. */
bool bp_known_file(const char *name, const char *bytes, size_t length, BpKnownFile *found);

/* Whether a file that begins so is an image that this program reads. */
bool bp_is_picture(const void *bytes, size_t length);

/* Advice on such a file where a scene was expected: "; ..." or "". Static. */
const char *bp_known_file_remedy(const BpKnownFile *file);

#endif
