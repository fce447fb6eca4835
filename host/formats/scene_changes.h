/* scene_changes.h: what a scene is to have otherwise than its document has it.
 *
 * In:    choices of a command line.   Out: what the readers of a scene's parts go by.
 * Knows: which choices there are.   Does not know: how a document is read (scene_parse.h). */
#ifndef BP_FORMATS_SCENE_CHANGES_H
#define BP_FORMATS_SCENE_CHANGES_H

#include "document.h"
#include "scene/scene.h"

enum {
    BP_PARSE_NO_CLOUDS = 1, /* check the members, but open no file of points; an image is one grey texel */
    BP_PARSE_MADE = 2 /* the document was made for one file: errors in that need not name the document */
};

/* What the entries of "particles" have selected in the frames of a film, where no particle may be left in
 * some. For the entries before BP_FILM_ENTRIES_MAX, by their places; others must always select something. */
enum { BP_FILM_ENTRIES_MAX = 16 };
typedef struct BpFilmSelections {
    bool looking; /* the frames are gone through for the first time: these are filled, and nothing is wrong */
    bool found[BP_FILM_ENTRIES_MAX], missed[BP_FILM_ENTRIES_MAX]; /* something, or nothing, in some frame */
} BpFilmSelections;

/* Changes that a command line makes to the document. Zeros: none. */
typedef struct BpSceneChanges {
    unsigned flags;    /* BP_PARSE_... */
    BpHeldFiles *held; /* Optional: as of a document */
    bool has_frame;
    int64_t frame;          /* of every file of particles that has frames */
    const char *select;     /* Optional: a condition for all particles, beside those of the document */
    const char *select_by;  /* what messages call it, such as "--select" */
    bool fit;               /* a camera fitted to the particles, or to the scene where there are none */
    uint32_t turning;       /* the fitted camera is for a turntable of so many pictures */
    const BpCamera *camera; /* Optional: takes its place, direction and focus instead of fitting */
    BpFilmSelections *film; /* Optional: the scene is a frame of a film */
    struct BpParticleCache *cache; /* Optional: keeps files open from frame to frame */
    uint64_t *frame_count; /* Optional: counts frames instead of reading any; of several files, the least */
    bool has_range;        /* of the column that gives colours, where the document has none */
    double range[2];
    const char *const *set; /* Optional: members of the document, see document_change.h */
    size_t set_count;
    const char *set_by;     /* what messages call these changes, such as "--set" */
    const char *projection; /* Optional. "perspective" or "orthographic", instead of the document's */
    const char *lighting; /* Optional. A name of lighting.h, instead of the document's light or background */
    const char *fresnel;  /* Optional. "schlick" or "exact", for all materials that have such a member */
    size_t *fresnel_counts; /* Optional: in how many it was different, and how many have it */
    BpShapeSets shapes;     /* after all others */
} BpSceneChanges;

#endif
