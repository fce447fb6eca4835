/* style_sizes.c: see style_sizes.h. */
#include "style_sizes.h"

#include "base/format.h"
#include "elements.h"
#include "spacing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BALL_SHARE 0.28     /* of the van der Waals radius, in ball-and-stick */
#define COARSE_ANGSTROM 2.3 /* atoms of molecules have a neighbour nearer than this */

/* Why a particle may be hidden. */
typedef enum Kind { PLAIN, WATER, ION, DUMMY, ALTERNATIVE, KIND_COUNT } Kind;

static BpStatus find_kinds(const BpParticles *p, unsigned char **kind, BpError *err) {
    /* Looked up once for each name. */
    unsigned char *const by_residue = calloc(p->names.count + 1, 1);
    *kind = calloc(p->count + 1, 1);
    if (*kind == NULL || by_residue == NULL) {
        free(by_residue);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
    }
    for (size_t n = 0; n < p->names.count; n++)
        by_residue[n] = bp_residue_is_water(p->names.text[n]) ? WATER
                        : bp_residue_is_ion(p->names.text[n]) ? ION
                                                              : PLAIN;
    for (size_t i = 0; i < p->count; i++) {
        const BpParticleTag *const tag = &p->tag[i];
        (*kind)[i] = tag->residue != 0 ? by_residue[tag->residue] : PLAIN;
        if ((tag->flags & BP_PARTICLE_ALTERNATIVE) != 0) (*kind)[i] = ALTERNATIVE;
        if ((tag->flags & BP_PARTICLE_DUMMY) != 0) (*kind)[i] = DUMMY;
    }
    free(by_residue);
    return BP_OK;
}

/* Hides what is not plain, as long as something else is left among the particles of `among`, which NULL means
 * all of. Returns how many are shown; `hidden`: how many of each kind are not. */
static size_t hide_kinds(const unsigned char *kind, size_t count, const bool *among, bool solvent,
                         bool *shown, size_t hidden[KIND_COUNT]) {
    size_t counts[KIND_COUNT] = {0}, shown_count = 0;
    for (size_t i = 0; i < count; i++) counts[kind[i]] += among == NULL || among[i];
    const bool water = solvent || counts[PLAIN] == 0;
    const bool rest = counts[PLAIN] + counts[WATER] + counts[ION] == 0;
    const bool show[KIND_COUNT] = {true, water, water, rest, rest};
    for (size_t i = 0; i < count; i++) {
        shown[i] = show[kind[i]] && (among == NULL || among[i]);
        shown_count += shown[i];
    }
    for (int k = 0; k < KIND_COUNT; k++) hidden[k] = show[k] ? 0 : counts[k];
    return shown_count;
}

static void say_hidden(BpStyleJob *job, const size_t hidden[KIND_COUNT]) {
    static const char *const words[KIND_COUNT] = {"", "of water", "of ions", "dummy",
                                                  "in alternative places"};
    char list[160] = "", number[32];
    for (int k = WATER; k < KIND_COUNT; k++) {
        if (hidden[k] == 0) continue;
        const size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s %s", used > 0 ? ", " : "",
                 bp_format_whole(hidden[k], number, sizeof number), words[k]);
    }
    if (list[0] != '\0') bp_style_say(job, "hidden: %s", list);
}

/* What is selected, in job->shown. */
static BpStatus select_particles(BpStyleJob *job, BpError *err) {
    const BpSelectFrame frame = bp_style_frame(job);
    const BpExpression *const select = job->style->select;
    BpError fault = {0};
    BpStatus status = bp_select_truths(&frame, select, job->shown, &fault);
    for (size_t i = 0; i < job->p->count && status == BP_OK; i++) job->selected_count += job->shown[i];
    if (status == BP_OK && job->selected_count == 0 && !job->may_miss)
        status = bp_select_fail_nothing(&frame, select, &fault);
    return bp_style_fail_in("select", status, &fault, err);
}

static BpStatus choose_selected(BpStyleJob *job, const unsigned char *kind, BpError *err) {
    const size_t count = job->p->count;
    size_t hidden[KIND_COUNT];
    job->base = calloc(count + 1, sizeof *job->base);
    job->shown = calloc(count + 1, sizeof *job->shown);
    if (job->base == NULL || job->shown == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", count);
    hide_kinds(kind, count, NULL, true, job->base, hidden);
    BP_TRY(select_particles(job, err));
    job->shown_count = hide_kinds(kind, count, job->shown, true, job->shown, hidden);
    for (size_t i = 0; i < count; i++) job->base[i] |= job->shown[i];
    say_hidden(job, hidden);
    return BP_OK;
}

BpStatus bp_style_choose_shown(BpStyleJob *job, BpError *err) {
    const size_t count = job->p->count;
    size_t hidden[KIND_COUNT];
    unsigned char *kind = NULL;
    job->usual = calloc(count + 1, sizeof *job->usual);
    BpStatus status = job->usual != NULL
                          ? find_kinds(job->p, &kind, err)
                          : bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", count);
    if (status == BP_OK) {
        job->shown_count = hide_kinds(kind, count, NULL, job->style->solvent, job->usual, hidden);
        if (job->style->select != NULL) {
            status = choose_selected(job, kind, err);
        } else {
            job->shown = job->base = job->usual;
            say_hidden(job, hidden);
        }
    }
    free(kind);
    return status;
}

BpStatus bp_style_choose_radii(BpStyleJob *job, BpError *err) {
    const BpParticleStyle *const style = job->style;
    BpParticles *const p = job->p;
    job->radius_by = style->radius_by;
    if ((style->radius_by == BP_RADIUS_VDW || style->radius_by == BP_RADIUS_COVALENT) && !p->has_element)
        return bp_fail(err, BP_ERR_SCENE,
                       "found no elements, expected them for radii by element; give \"radius\" as a number");
    if (style->radius_by == BP_RADIUS_COLUMN)
        BP_TRY(bp_style_numbers(job, style->radius_value, style->radius_column, "radius.value",
                                &job->radius_numbers, err));
    bool elements = p->has_element && p->angstrom > 0;
    if (style->radius_by == BP_RADIUS_AUTO && p->radius == NULL && elements && p->element_guessed) {
        /* Beads of coarse-grained models have names that look like atoms', but lie further apart than bonds
         * reach. */
        BP_TRY(bp_particles_spacing(p, job->usual, &job->spacing, err));
        elements = job->spacing < COARSE_ANGSTROM * p->angstrom;
    }
    if (style->radius_by == BP_RADIUS_AUTO && p->radius == NULL && elements) job->radius_by = BP_RADIUS_VDW;
    bool spacing_needed = job->radius_by == BP_RADIUS_AUTO && p->radius == NULL;
    for (size_t i = 0; i < p->count && !spacing_needed && job->radius_by == BP_RADIUS_AUTO; i++)
        spacing_needed = job->shown[i] && !(p->radius[i] > 0 && isfinite(p->radius[i]));
    if ((job->radius_by == BP_RADIUS_VDW || job->radius_by == BP_RADIUS_COVALENT) && p->angstrom == 0)
        p->angstrom = 1;
    if (spacing_needed) {
        BP_TRY(bp_particles_spacing(p, job->usual, &job->spacing, err));
        if (job->spacing == 0) job->spacing = 1;
        bp_style_say(job, "radius %.3g%s: half the median distance of neighbours",
                     job->spacing / 2 * style->radius, p->radius != NULL ? " where the file has none" : "");
    } else if (job->radius_by == BP_RADIUS_VDW) {
        bp_style_say(job, "van der Waals radii%s", style->kind == BP_STYLE_BALL_AND_STICK ? ", scaled" : "");
    }
    return BP_OK;
}

double bp_style_radius(const BpStyleJob *job, size_t i) {
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    const BpParticleTag *const tag = &p->tag[i];
    const BpStyleNamed *const own = bp_style_named(style->radii, style->radius_count, p, tag);
    if (own != NULL) return own->value[0];
    const double scale = style->radius * (style->kind == BP_STYLE_BALL_AND_STICK ? BALL_SHARE : 1);
    switch (job->radius_by) {
    case BP_RADIUS_CONSTANT:
        return style->radius;
    case BP_RADIUS_COLUMN:
        return style->radius * job->radius_numbers[i];
    case BP_RADIUS_VDW:
        return scale * p->angstrom * (double)bp_elements[tag->element].van_der_waals;
    case BP_RADIUS_COVALENT:
        return style->radius * p->angstrom * (double)bp_elements[tag->element].covalent;
    case BP_RADIUS_AUTO:
        break;
    }
    const bool has_own = p->radius != NULL && p->radius[i] > 0 && isfinite(p->radius[i]);
    return scale * (has_own ? (double)p->radius[i] : job->spacing / 2);
}
