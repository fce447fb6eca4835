/* study_state.h: a study at work, for study.c and study_points.c alone.
 *
 * In:    what study.c has rendered.   Out: points and differences in the result.
 * Knows: renders and references.      Does not know: the order of a study. */
#ifndef BP_COST_STUDY_STATE_H
#define BP_COST_STUDY_STATE_H

#include "parts.h"
#include "references.h"

typedef enum BpStudyPhase {
    BP_STUDY_OPEN_REFERENCES,
    BP_STUDY_REFERENCES,
    BP_STUDY_OPEN_SETTINGS,
    BP_STUDY_LEVELS,
    BP_STUDY_DONE
} BpStudyPhase;

/* A setting at work. */
typedef struct BpStudyRunner {
    BpRender *render;
    double cpu_seconds, wall_seconds, warm_device_seconds;
    double seconds;                     /* of the counts before the present one, undisturbed */
    double rounds[BP_STUDY_ROUNDS_MAX]; /* seconds, of the present count */
    bool done;                          /* with the present round */
} BpStudyRunner;

struct BpStudy {
    BpStudyResult result;
    BpScene variants[3]; /* by BpStudyFresnel; share everything but the materials with the scene */
    BpDeviceInfo device;
    BpStudyPhase phase;
    double start;
    BpReferences references;
    BpStudyRunner runners[BP_STUDY_SETTINGS_MAX];
    size_t turn;               /* the setting at work */
    uint64_t level;            /* samples a pixel that everyone is given now */
    size_t round, round_count; /* of the present level */
    bool last_level;           /* the present one is */
    BpPicture first;           /* of the base, one sample a pixel */
    double *interest;          /* of every pixel: how much there is to see */
    uint32_t crop_left, crop_top;
};

/* The setting s has one sample a pixel: notes where it differs. */
BpStatus bp_study_note_first(BpStudy *study, size_t s, BpError *err);
/* Every setting has reached the present count: adds the point of s, and says how it differs from base and
 * truth. */
BpStatus bp_study_note_point(BpStudy *study, size_t s, BpError *err);

#endif
