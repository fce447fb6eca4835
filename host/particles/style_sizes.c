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

BpStatus bp_style_choose_shown(BpStyleJob *job, BpError *err) {
    enum { NOTHING, WATER, ION, DUMMY, ALTERNATIVE, KINDS };
    static const char *const words[KINDS] = {"", "of water", "of ions", "dummy", "in alternative places"};
    BpParticles *const p = job->p;
    size_t counts[KINDS] = {0};
    unsigned char *const kind = calloc(p->count + 1, 1);
    /* Looked up once for each name. */
    unsigned char *const by_residue = calloc(p->names.count + 1, 1);
    job->shown = calloc(p->count + 1, sizeof *job->shown);
    if (kind == NULL || by_residue == NULL || job->shown == NULL) {
        free(kind);
        free(by_residue);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu particles", p->count);
    }
    for (size_t n = 0; n < p->names.count; n++)
        by_residue[n] = bp_residue_is_water(p->names.text[n]) ? WATER
                        : bp_residue_is_ion(p->names.text[n]) ? ION
                                                              : NOTHING;
    for (size_t i = 0; i < p->count; i++) {
        const BpParticleTag *const tag = &p->tag[i];
        kind[i] = tag->residue != 0 ? by_residue[tag->residue] : NOTHING;
        if ((tag->flags & BP_PARTICLE_ALTERNATIVE) != 0) kind[i] = ALTERNATIVE;
        if ((tag->flags & BP_PARTICLE_DUMMY) != 0) kind[i] = DUMMY;
        counts[kind[i]]++;
    }
    const bool solute = counts[NOTHING] > 0, solvent = job->style->solvent || !solute;
    for (size_t i = 0; i < p->count; i++) {
        const bool show = kind[i] == NOTHING || ((kind[i] == WATER || kind[i] == ION) && solvent) ||
                          (kind[i] != NOTHING && counts[NOTHING] + counts[WATER] + counts[ION] == 0);
        job->shown[i] = show;
        job->shown_count += show;
    }
    char hidden[160] = "", number[32];
    for (int k = WATER; k < KINDS; k++) {
        if (counts[k] == 0 || ((k == WATER || k == ION) && solvent) || job->shown_count == p->count) continue;
        const size_t used = strlen(hidden);
        snprintf(hidden + used, sizeof hidden - used, "%s%s %s", used > 0 ? ", " : "",
                 bp_format_whole(counts[k], number, sizeof number), words[k]);
    }
    if (hidden[0] != '\0') bp_style_say(job, "hidden: %s", hidden);
    free(kind);
    free(by_residue);
    return BP_OK;
}

BpStatus bp_style_choose_radii(BpStyleJob *job, BpError *err) {
    const BpParticleStyle *const style = job->style;
    BpParticles *const p = job->p;
    job->radius_by = style->radius_by;
    if ((style->radius_by == BP_RADIUS_VDW || style->radius_by == BP_RADIUS_COVALENT) && !p->has_element)
        return bp_fail(err, BP_ERR_SCENE,
                       "found no elements, expected them for radii by element; give \"radius\" as a number");
    bool elements = p->has_element && p->angstrom > 0;
    if (style->radius_by == BP_RADIUS_AUTO && p->radius == NULL && elements && p->element_guessed) {
        /* Beads of coarse-grained models have names that look like atoms', but lie further apart than bonds
         * reach. */
        BP_TRY(bp_particles_spacing(p, job->shown, &job->spacing, err));
        elements = job->spacing < COARSE_ANGSTROM * p->angstrom;
    }
    if (style->radius_by == BP_RADIUS_AUTO && p->radius == NULL && elements) job->radius_by = BP_RADIUS_VDW;
    bool spacing_needed = job->radius_by == BP_RADIUS_AUTO && p->radius == NULL;
    for (size_t i = 0; i < p->count && !spacing_needed && job->radius_by == BP_RADIUS_AUTO; i++)
        spacing_needed = job->shown[i] && !(p->radius[i] > 0 && isfinite(p->radius[i]));
    if ((job->radius_by == BP_RADIUS_VDW || job->radius_by == BP_RADIUS_COVALENT) && p->angstrom == 0)
        p->angstrom = 1;
    if (spacing_needed) {
        BP_TRY(bp_particles_spacing(p, job->shown, &job->spacing, err));
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
        return style->radius * (double)p->column[0][i];
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
