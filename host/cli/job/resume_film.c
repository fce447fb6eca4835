/* resume_film.c: see resume_film.h. */
#include "resume_film.h"

#include "base/names.h"
#include "base/plural.h"
#include "cli/line/option_table.h"
#include "film/film_file.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <stdio.h>

BpStatus bp_resume_load(const BpCommandLine *line, const BpComm *shared, BpFilm **film, BpError *err) {
    *film = NULL;
    if (line->resume == NULL) return BP_OK;
    return bp_comm_is_root(shared) ? bp_film_read(line->resume, film, err)
                                   : bp_film_read_header(line->resume, film, err);
}

/* Error: `option` was given, but the film has the value `has`, in the notation of the option. */
static BpStatus contradicts(const BpCommandLine *line, BpOption option, const char *has, BpError *err) {
    char given[80];
    bp_option_show(option, line, given, sizeof given);
    return bp_fail(err, BP_ERR_USAGE, "--%s%s%s contradicts --resume %.400s, which %s; leave it out",
                   bp_option_name(option), given[0] != '\0' ? " " : "", given, line->resume, has);
}

BpStatus bp_resume_scene(const BpCommandLine *line, const BpFilm *film, BpScene *scene, BpError *err) {
    char has[80];
    snprintf(has, sizeof has, "is %" PRIu32 " pixels wide", film->width);
    if (bp_option_given(line, BP_OPTION_WIDTH) && line->width != film->width)
        return contradicts(line, BP_OPTION_WIDTH, has, err);
    BP_TRY(bp_scene_set_width(scene, film->width, err));
    if (bp_scene_hash(scene) == film->scene_hash && scene->camera.height == film->height) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE,
                   "--resume %.400s: it was rendered from another scene than %.400s, or that has changed "
                   "since; give the scene that it was rendered from",
                   line->resume, line->operands[0]);
}

static uint64_t first_sample(const BpFilm *film) {
    if (film->plan != NULL) return film->plan->first_sample;
    return film->range_count > 0 ? film->ranges[0].first : 0;
}

BpStatus bp_resume_options(const BpCommandLine *line, const BpFilm *film, BpRenderOptions *options,
                           BpError *err) {
    char has[120];
    const uint64_t first = first_sample(film);
    if (bp_option_given(line, BP_OPTION_SEED) && options->seed != film->seed) {
        snprintf(has, sizeof has, "has --seed %" PRIu64, film->seed);
        return contradicts(line, BP_OPTION_SEED, has, err);
    }
    if (bp_option_given(line, BP_OPTION_DEPTH) && options->max_depth != film->max_depth) {
        snprintf(has, sizeof has, "has --depth %" PRIu32, film->max_depth);
        return contradicts(line, BP_OPTION_DEPTH, has, err);
    }
    const bool shared = bp_option_given(line, BP_OPTION_SHARE);
    if ((bp_option_given(line, BP_OPTION_FIRST_SAMPLE) &&
         line->first_sample != (film->job.count > 0 ? film->job.first : first))) {
        snprintf(has, sizeof has, "begins with sample %" PRIu64, first);
        return contradicts(line, BP_OPTION_FIRST_SAMPLE, has, err);
    }
    if (shared && (options->first_sample != first || options->job_first != film->job.first ||
                   options->job_samples != film->job.count)) {
        snprintf(has, sizeof has, "is another part, from sample %" PRIu64 " on", first);
        return contradicts(line, BP_OPTION_SHARE, has, err);
    }
    if (line->adaptive && (film->plan == NULL || !film->plan->adaptive))
        return contradicts(line, BP_OPTION_ADAPTIVE, "is of a render without it", err);
    if (options->caustics == BP_CAUSTICS_AUTO) options->caustics = film->caustics; /* as it was chosen then */
#define SETTING_OPTION_sampler BP_OPTION_SAMPLER
#define SETTING_OPTION_precision BP_OPTION_PRECISION
#define SETTING_OPTION_math BP_OPTION_MATH
#define SETTING_OPTION_numerics BP_OPTION_NUMERICS
#define SETTING_OPTION_light_sampling BP_OPTION_LIGHT_SAMPLING
#define SETTING_OPTION_caustics BP_OPTION_CAUSTICS
#define SETTING_OPTION_roulette BP_OPTION_ROULETTE
#define TAKE(type, member, option, plural)                                                                   \
    if (bp_option_given(line, SETTING_OPTION_##member) && options->member != film->member) {                 \
        snprintf(has, sizeof has, "has --" option " %s", bp_##member##_names[film->member]);                 \
        return contradicts(line, SETTING_OPTION_##member, has, err);                                         \
    }                                                                                                        \
    options->member = film->member;
    BP_SETTING_LIST(TAKE)
#undef TAKE
    options->seed = film->seed;
    options->max_depth = film->max_depth;
    options->first_sample = first;
    options->job_first = film->job.first;
    options->job_samples = film->job.count;
    options->replicates = film->replicates;
    options->adaptive = film->plan != NULL && film->plan->adaptive;
    return BP_OK;
}

BpStatus bp_resume_rule(const BpCommandLine *line, const BpFilm *film, BpStopRule *rule, BpError *err) {
    const BpFilmPlan *plan = film->plan;
    const uint64_t there = bp_film_range_total(film);
    const bool has_spp = bp_option_given(line, BP_OPTION_SPP),
               has_error = bp_option_given(line, BP_OPTION_ERROR);
    rule->adaptive = plan != NULL && plan->adaptive;
    if (!has_spp && plan == NULL)
        rule->samples_max = has_error || line->time_seconds > 0 ? rule->samples_max : there;
    else if (!has_spp && plan->samples_max > 0)
        rule->samples_max = plan->samples_max;
    if (!has_error && plan != NULL) rule->error = plan->error;
    const uint64_t least = rule->adaptive ? plan->target : there;
    if (rule->samples_max < least)
        return bp_fail(err, BP_ERR_USAGE,
                       "--spp %" PRIu64 " contradicts --resume %.400s, which is to have %" PRIu64
                       " sample%s per pixel; ask for at least as many, or leave it out",
                       rule->samples_max, line->resume, least, bp_plural(least));
    /* The render was limited by time, which is not in the film. */
    if (rule->error <= 0 && rule->seconds <= 0 && rule->samples_max >= BP_SPP_MAX && !has_spp)
        return bp_fail(
            err, BP_ERR_USAGE,
            "--resume %.400s: its render had only a time limit; give this one --time, --spp or --error",
            line->resume);
    return BP_OK;
}
