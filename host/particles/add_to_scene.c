/* add_to_scene.c: see add_to_scene.h. */
#include "add_to_scene.h"

#include "base/color.h"
#include "base/format.h"
#include "base/message_text.h"
#include "base/plural.h"
#include "bonds.h"
#include "molecules.h"
#include "style_bodies.h"
#include "style_bonds.h"
#include "style_colors.h"
#include "style_sizes.h"
#include "style_spheres.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Files of three columns hold two dimensions too. */
static void find_flat(BpStyleJob *job) {
    BpParticles *const p = job->p;
    double low = INFINITY, high = -INFINITY;
    size_t count = 0;
    for (size_t i = 0; i < p->count; i++) {
        if (!job->usual[i]) continue;
        count++;
        low = p->position[i][2] < low ? p->position[i][2] : low;
        high = p->position[i][2] > high ? p->position[i][2] : high;
        if (high > low) break;
    }
    p->flat |= count > 2 && high == low;
}

/* Names that no particle that is shown has; a frame may lack types of another, so they are no error. */
static void say_unmatched(BpStyleJob *job, const char *member, const BpStyleNamed *list, size_t count) {
    const BpParticles *const p = job->p;
    char shown[64];
    for (size_t k = 0; k < count && job->summary != NULL; k++) {
        size_t i = 0;
        while (i < p->count && !(job->shown[i] && bp_style_named(&list[k], 1, p, &p->tag[i]) != NULL)) i++;
        if (i < p->count) continue;
        bp_printable(list[k].name, shown, sizeof shown);
        bp_style_say(job, "no particle has the type \"%s\" of \"%s\"", shown, member);
    }
}

/* What the file calls a particle. */
static const char *own_name(const BpParticles *p, const BpParticleTag *tag) {
    return bp_style_name(p, tag->type != 0 ? tag->type : tag->name);
}

/* Where radii or colours are those of elements, particles without one get radius and colour of none: says how
 * many are shown, and the names of the first. */
static void say_unknown(BpStyleJob *job) {
    enum { NAMES_MAX = 3 };
    const BpParticles *const p = job->p;
    const BpParticleStyle *const style = job->style;
    const bool radii = job->radius_by == BP_RADIUS_VDW || job->radius_by == BP_RADIUS_COVALENT;
    const bool colors = job->color_by == BP_COLOR_ELEMENT;
    const char *names[NAMES_MAX + 1];
    char list[160] = "", number[32], shown[40];
    size_t count = 0, named = 0;
    for (size_t i = 0; i < p->count && (radii || colors); i++) {
        const BpParticleTag *const tag = &p->tag[i];
        if (!job->shown[i] || tag->element != 0) continue;
        if ((!radii || bp_style_named(style->radii, style->radius_count, p, tag) != NULL) &&
            (!colors || bp_style_named(style->colors, style->color_count, p, tag) != NULL))
            continue;
        count++;
        const char *const name = own_name(p, tag);
        size_t n = 0;
        while (n < named && strcmp(names[n], name) != 0) n++;
        if (n == named && named <= NAMES_MAX && name[0] != '\0') names[named++] = name;
    }
    for (size_t n = 0; n < named; n++) {
        const size_t used = strlen(list);
        bp_printable(names[n], shown, sizeof shown);
        snprintf(list + used, sizeof list - used, "%s%s", n > 0 ? ", " : " (", n < NAMES_MAX ? shown : "...");
    }
    if (count > 0)
        bp_style_say(job, "no element is known of %s particle%s%s%s",
                     bp_format_whole(count, number, sizeof number), bp_plural(count), list,
                     named > 0 ? ")" : "");
}

static BpStatus run(BpStyleJob *job, BpError *err) {
    BpParticles *const p = job->p;
    char all[32], shown[32];
    BP_TRY(bp_style_choose_shown(job, err));
    if (job->shown_count == 0 && job->may_miss) {
        find_flat(job);
        bp_style_say(job, "selected 0 of %s particles", bp_format_whole(p->count, all, sizeof all));
        return BP_OK;
    }
    if (p->notes[0] != '\0') bp_style_say(job, "%s", p->notes);
    const bool bonds = job->style->bonds || job->style->kind == BP_STYLE_BALL_AND_STICK;
    const bool whole = job->style->whole && bp_particles_repeat(p) && (p->bond_count > 0 || p->has_element);
    if (bonds || whole) BP_TRY(bp_bonds_find(p, job->base, &job->bonds, err));
    if (job->bonds.crowded)
        bp_style_say(job,
                     "no bonds by distance, since atoms lie in each other; is their unit of length right?");
    size_t moved = 0;
    if (whole) BP_TRY(bp_molecules_make_whole(p, job->base, &job->bonds, &moved, err));
    if (moved > 0)
        bp_style_say(job, "molecules made whole across the cell: %s moved",
                     bp_format_whole(moved, all, sizeof all));
    find_flat(job);
    BP_TRY(bp_style_choose_radii(job, err));
    BP_TRY(bp_style_choose_colors(job, err));
    say_unknown(job);
    say_unmatched(job, "radius", job->style->radii, job->style->radius_count);
    say_unmatched(job, "color", job->style->colors, job->style->color_count);
    BP_TRY(bp_style_put_particles(job, err));
    BP_TRY(bp_style_put_bodies(job, err));
    if (bonds) BP_TRY(bp_style_put_bonds(job, err));
    if (job->style->box) BP_TRY(bp_style_put_box(job, err));
    if (job->summary != NULL) { /* the counts come first, and are known last */
        char rest[768];
        snprintf(rest, sizeof rest, "%s", job->summary);
        bp_format_whole(p->count, all, sizeof all);
        bp_format_whole(job->shown_count, shown, sizeof shown);
        if (job->style->select != NULL)
            snprintf(job->summary, job->size, "selected %s of %s particle%s%s%s",
                     bp_format_whole(job->selected_count, shown, sizeof shown), all, bp_plural(p->count),
                     rest[0] != '\0' ? "; " : "", rest);
        else if (job->shown_count == p->count)
            snprintf(job->summary, job->size, "%s particle%s%s%s", all, bp_plural(p->count),
                     rest[0] != '\0' ? "; " : "", rest);
        else
            snprintf(job->summary, job->size, "%s of %s particles%s%s", shown, all,
                     rest[0] != '\0' ? "; " : "", rest);
    }
    return BP_OK;
}

BpStatus bp_particles_add_to_scene(BpParticles *particles, const BpParticleStyle *style, bool may_miss,
                                   uint32_t material, BpScene *scene, char *summary, size_t size,
                                   double range[2], BpError *err) {
    BpStyleJob job = {.p = particles,
                      .style = style,
                      .may_miss = may_miss,
                      .scene = scene,
                      .material = material,
                      .summary = summary,
                      .size = size};
    if (summary != NULL) summary[0] = '\0';
    bp_particle_style_columns(style, &job.columns);
    bp_linear_of_bytes(job.linear);
    const BpStatus status = run(&job, err);
    if (range != NULL) memcpy(range, job.range, sizeof job.range);
    if (job.shown != job.usual) free(job.shown);
    if (job.base != job.usual) free(job.base);
    free(job.usual);
    free(job.radius_numbers);
    free(job.color_numbers);
    free(job.rank);
    free(job.bonds.bond);
    return status;
}
