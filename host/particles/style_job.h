/* style_job.h: what is known while particles become spheres; shared by the files that decide how they look.
 *
 * In:    a frame, a style, a scene.   Out: what has been decided, and the summary of it for a person.
 * Knows: particles, styles, scenes.   Does not know: what is decided (style_sizes.h, style_colors.h). */
#ifndef BP_PARTICLES_STYLE_JOB_H
#define BP_PARTICLES_STYLE_JOB_H

#include "bonds.h"
#include "scene/scene.h"
#include "style.h"

typedef struct BpStyleJob {
    BpParticles *p;
    const BpParticleStyle *style;
    BpScene *scene;
    bool may_miss; /* nothing selected is no error */
    uint32_t material;
    BpStyleColumns columns; /* those that the frame was read with */
    bool *shown;
    size_t shown_count, selected_count;
    /* Without "select" both are the same as `shown`: those that would be shown without it, by which guesses
     * go that hold for the whole file; those that would be if all were selected, which bonds join. */
    bool *usual, *base;
    double *radius_numbers, *color_numbers; /* of each particle, where these go by a column or a value */
    BpBonds bonds;
    double spacing, range[2];
    BpRadiusBy radius_by;
    BpColorBy color_by;
    size_t capacity, albedo_capacity, capsule_capacity; /* of the scene's arrays */
    uint16_t *rank; /* of a name among the kinds that get colours of the palette, from 0, in the order of the
                       file */
    double linear[256]; /* of each byte of an sRGB colour */
    char *summary;
    size_t size;
} BpStyleJob;

/* What expressions are evaluated for. */
BpSelectFrame bp_style_frame(const BpStyleJob *job);
/* The numbers of a value of the style, or else of a column, for each particle: as the caller's to free. An
 * error names `member`. */
BpStatus bp_style_numbers(const BpStyleJob *job, const BpExpression *value, const char *column,
                          const char *member, double **numbers, BpError *err);
/* Puts the member before an error in its expression. */
BpStatus bp_style_fail_in(const char *member, BpStatus status, BpError *fault, BpError *err);

/* Adds to the summary. */
void bp_style_say(BpStyleJob *job, const char *format, ...) BP_PRINTF_LIKE(2, 3);

/* A name that a tag has by its number. */
const char *bp_style_name(const BpParticles *p, uint16_t number);
/* What the style has for the tag's type or element; NULL: nothing. */
const BpStyleNamed *bp_style_named(const BpStyleNamed *list, size_t count, const BpParticles *p,
                                   const BpParticleTag *tag);

#endif
