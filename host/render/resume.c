/* resume.c: takes up a render where another one left off; see bp_render_resume() in ballpark.h.
 *
 * In:    a render without a sample yet, a film.   Out: the render as it was when that film was read.
 * Knows: plans with the limits of a stop rule, the schedule, adaptive sampling.   Does not know: when a
 * render is stopped, where films are stored. */
#include "render.h"

#include "base/status.h"
#include "render_state.h"
#include "round.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static BpStatus not_one_render(const char *why, BpError *err) {
    return bp_fail(err, BP_ERR_USAGE, "the film %s, so it does not say how its render would go on", why);
}

/* The plan of a film that has none: every pixel has all samples of one range. */
static BpStatus plan_of_whole(const BpFilm *film, BpFilmPlan *plan, BpError *err) {
    if (film->partial) return not_one_render("lacks samples in some pixels, and has been merged", err);
    if (film->range_count != 1) return not_one_render("is not of one range of samples", err);
    *plan = (BpFilmPlan){.first_sample = film->ranges[0].first,
                         .target = film->ranges[0].count,
                         .done = film->ranges[0].count};
    return BP_OK;
}

static BpStatus check_settings(const BpRender *render, const BpFilm *film, const BpFilmPlan *plan,
                               BpError *err) {
    const BpRenderOptions *options = &render->options;
    BpFilm own = {.width = render->scene->camera.width,
                  .height = render->scene->camera.height,
                  .replicates = options->replicates};
    BpStatus status = bp_render_describe(render, &own, err);
    if (status == BP_OK) status = bp_film_check_same(film, &own, err);
    free(own.title);
    free(own.ranges);
    BP_TRY(status);
    if (plan->adaptive != options->adaptive)
        return bp_fail(err, BP_ERR_USAGE, "the film is%s of an adaptive render, but the render is%s adaptive",
                       plan->adaptive ? "" : " not", options->adaptive ? "" : " not");
    if (plan->first_sample != options->first_sample)
        return bp_fail(err, BP_ERR_USAGE,
                       "the film begins with sample %" PRIu64 ", but the render with sample %" PRIu64,
                       plan->first_sample, options->first_sample);
    return bp_render_check_samples(render, plan->target, err);
}

/* The pass under way, over a list of pixels. */
static BpStatus restore_pass(BpRender *render, const BpFilmPlan *plan, BpError *err) {
    BpAdaptivePass pass;
    BP_TRY(bp_adaptive_restore(render->adaptive, plan->decisions, plan->decision_bytes, err));
    render->decides = true;
    render->dispatch.schedule.samples = 0; /* all is handed out, unless a pass is under way */
    if (!bp_adaptive_pass(render->adaptive, &pass)) return BP_OK;
    return bp_render_begin_pass(render, &pass, err);
}

/* Whether the render, as it stands now, has taken the samples that the film names. */
static BpStatus check_samples(const BpRender *render, const BpFilm *film, BpError *err) {
    const BpSchedule *schedule = &render->dispatch.schedule;
    BpFilm own = {.width = film->width, .height = film->height, .replicates = film->replicates};
    BpStatus status = bp_render_describe(render, &own, err);
    const bool fits =
        schedule->done + schedule->pass_samples <= schedule->samples &&
        schedule->next_pixel < schedule->pixels && own.partial == film->partial &&
        own.range_count == film->range_count &&
        (own.range_count == 0 || memcmp(own.ranges, film->ranges, own.range_count * sizeof *own.ranges) == 0);
    if (status == BP_OK && !fits)
        status = bp_fail(err, BP_ERR_FILE, "the film is damaged: its plan contradicts its samples");
    free(own.title);
    free(own.ranges);
    return status;
}

static BpStatus copy_film(const BpFilm *film, BpFilm **copy, BpError *err) {
    BP_TRY(bp_film_create(film->width, film->height, film->replicates, copy, err));
    BP_TRY(bp_film_add_sums(*copy, film, err));
    if (film->pixel_segments == NULL) return BP_OK;
    const size_t bytes = (size_t)film->width * film->height * sizeof *film->pixel_segments;
    (*copy)->pixel_segments = malloc(bytes);
    if ((*copy)->pixel_segments == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "no memory for the path lengths of a picture");
    memcpy((*copy)->pixel_segments, film->pixel_segments, bytes);
    return BP_OK;
}

/* `decisions`: those of adaptive sampling, which a film that is a header alone lacks; NULL: there are none.
 */
static BpStatus take_up(BpRender *render, const BpFilm *film, uint8_t *decisions, BpError *err) {
    BpFilmPlan plan = {.adaptive = false};
    if (film->plan != NULL)
        plan = *film->plan;
    else
        BP_TRY(plan_of_whole(film, &plan, err));
    plan.decisions = decisions;
    BP_TRY(check_settings(render, film, &plan, err));
    if (bp_comm_is_root(render->comm) && (film->met != NULL) != (render->scene->backdrop == BP_BACKDROP_NONE))
        return bp_fail(err, BP_ERR_FILE, "the film is damaged: it %s an alpha, unlike its scene",
                       film->met != NULL ? "has" : "lacks");
    render->resumed = true;
    if (bp_comm_is_root(render->comm)) BP_TRY(copy_film(film, &render->base, err)); /* once among all ranks */
    BP_TRY(bp_render_extend(render, plan.target, err));
    render->goal_samples = plan.samples_max;
    render->goal_error = plan.error;
    if (plan.decision_bytes > 0) BP_TRY(restore_pass(render, &plan, err));
    render->dispatch.schedule.done = plan.done;
    render->dispatch.schedule.pass_samples = plan.pass_samples;
    render->dispatch.schedule.next_pixel = plan.next_pixel;
    if (render->dispatch.schedule.samples < plan.done && plan.decision_bytes > 0 && plan.pass_samples == 0)
        render->dispatch.schedule.samples = plan.done; /* of the last pass, which is done */
    return check_samples(render, film, err);
}

/* Pixel samples in the film. */
static uint64_t count_samples(const BpFilm *film) {
    const size_t cells = (size_t)film->width * film->height * film->replicates;
    uint64_t samples = film->invalid_samples;
    for (size_t i = 0; i < cells; ++i) samples += film->counts[i];
    return samples;
}

BpStatus bp_render_resume(BpRender *render, const BpFilm *film, BpError *err) {
    const bool is_root = bp_comm_is_root(render->comm), plans = film->plan != NULL;
    if (bp_render_has_begun(render) || render->resumed)
        return bp_fail(err, BP_ERR_USAGE, "a render that has begun cannot go on from a film");
    uint64_t samples = is_root ? count_samples(film) : 0;
    uint8_t *received = NULL;
    BP_TRY(bp_round_share_resumed(render->comm, &samples, plans ? film->plan->decisions : NULL,
                                  plans ? film->plan->decision_bytes : 0, &received, err));
    render->base_samples = samples;
    const BpStatus status =
        take_up(render, film, received != NULL || !plans ? received : film->plan->decisions, err);
    free(received);
    return status;
}
