/* cmd_check.c: `ballpark check`.
 *
 * In:    a scene, or the agreement scenes; devices.   Out: whether kernel and reference agree, by table,
 * documents, a picture, and an exit code.
 * Knows: the order of the steps: scenes, devices, checks, documents.
 * Does not know: how a device is used without trusting it (cli/process/device_survey.h,
 * cli/conform/device_items.h), what documents look like (cli/conform/check_report.h,
 * cli/conform/check_junit.h). */
#include "commands.h"

#include "base/escape.h"
#include "base/format.h"
#include "base/plural.h"
#include "cli/conform/check_against.h"
#include "cli/conform/check_bits.h"
#include "cli/conform/check_failure.h"
#include "cli/conform/check_junit.h"
#include "cli/conform/check_report.h"
#include "cli/conform/check_run.h"
#include "cli/conform/junit_file.h"
#include "cli/conform/suite.h"
#include "cli/job/setup.h"
#include "cli/line/file_conflicts.h"
#include "cli/line/option_table.h"
#include "cli/output/json_file.h"
#include "cli/output/output.h"
#include "cli/process/device_survey.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/page.h"
#include "image/image.h"
#include "opencl/driver_start.h"
#include "render/render_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SUITE_NAME "agreement"
#define SUITE_LEVEL 1e-3  /* of the whole suite; each scene gets an equal part */
#define SUITE_MARGIN 0.01 /* which every scene of it reaches with the default number of samples */
#define SURVEY_SECONDS_MIN 5.0
/* Paths that find lights by chance, as the reference's do; light sampling; and also light sampling by way of
 * balls of glass and mirrors. */
enum { CHECKS_OF_A_SCENE = 3 };

/* One run of the command. */
typedef struct Session {
    const BpCommandLine *line;
    BpSuite suite;      /* of --suite and --bits */
    BpScene *scene;     /* else the one of the command line */
    BpCheckItem *items; /* the scenes to be checked */
    size_t item_count;
    json_t *earlier; /* Optional. The document of --against. */
    BpDeviceSurvey survey;
    BpDeviceInfo *devices; /* the devices to be checked */
    size_t device_count;
    BpFormat map_format;
    json_t *scenes;                /* cli/conform/check_report.h */
    BpError error;                 /* of the first item that failed by an error */
    char *text[CHECKS_OF_A_SCENE]; /* the verdicts for people, of one scene on one device */
    bool interrupted, junit_written, json_written;
} Session;

static bool wants_all(const BpCommandLine *line) {
    return line->device != NULL && strcmp(line->device, "all") == 0;
}

static bool wants_documents(const BpCommandLine *line) {
    return line->json != NULL || line->junit != NULL;
}

static bool is_stdout(const char *path) {
    return path != NULL && strcmp(path, "-") == 0;
}

/* ---- the command line --------------------------------------------------------------------------------- */

static BpStatus refuse(const BpCommandLine *line, const char *with, const BpOption *options, size_t count,
                       const char *why, BpError *err) {
    for (size_t i = 0; i < count; ++i)
        if (bp_option_given(line, options[i]))
            return bp_fail(err, BP_ERR_USAGE, "--%s does not go with %s: %s", bp_option_name(options[i]),
                           with, why);
    return BP_OK;
}

static BpStatus check_line(const BpCommandLine *line, BpError *err) {
    static const BpOption of_pictures[] = {BP_OPTION_SUITE, BP_OPTION_WIDTH,    BP_OPTION_SPP,
                                           BP_OPTION_DEPTH, BP_OPTION_SEED,     BP_OPTION_MARGIN,
                                           BP_OPTION_MATH,  BP_OPTION_NUMERICS, BP_OPTION_EFFECTS,
                                           BP_OPTION_MAP,   BP_OPTION_AGAINST};
    static const BpOption of_one[] = {BP_OPTION_MAP};
    const char *own = line->bits ? "--bits" : "--suite";
    if (line->bits)
        BP_TRY(refuse(line, "--bits", of_pictures, sizeof of_pictures / sizeof *of_pictures,
                      "the recorded pictures determine what is rendered", err));
    if (line->suite)
        BP_TRY(
            refuse(line, "--suite", of_one, 1, "it is a picture of one scene; check that scene alone", err));
    if ((line->bits || line->suite) && line->operand_count > 0)
        return bp_fail(err, BP_ERR_USAGE, "ballpark check: %s brings its own scenes; leave out \"%.200s\"",
                       own, line->operands[0]);
    if (!line->bits && !line->suite && line->operand_count == 0)
        return bp_fail(err, BP_ERR_USAGE,
                       "ballpark check: missing SCENE (or --suite); see `ballpark help check`");
    if (!line->bits && line->samples_per_pixel == 1)
        return bp_fail(err, BP_ERR_USAGE, "a check needs at least 2 samples per pixel to measure noise");
    return BP_OK;
}

/* One that cannot be written is not tried again; the other then reports that. */
static BpStatus check_documents(Session *session, BpError *err) {
    const BpCommandLine *line = session->line;
    const BpStatus json = line->json != NULL ? bp_line_check_output(line, line->json, err) : BP_OK;
    const BpStatus junit =
        line->junit != NULL ? bp_line_check_output(line, line->junit, json == BP_OK ? err : NULL) : BP_OK;
    session->json_written = json != BP_OK;
    session->junit_written = junit != BP_OK;
    return json != BP_OK ? json : junit;
}

static BpStatus find_map_format(Session *session, BpError *err) {
    const char *map = session->line->map;
    if (map == NULL) return BP_OK;
    if (!bp_format_from_path(map, &session->map_format) || session->map_format == BP_FORMAT_BPA)
        return bp_fail(err, BP_ERR_USAGE, "--map %s: expected a name that ends in .png, .ppm, .pfm or .exr",
                       map);
    return bp_line_check_output(session->line, map, err);
}

/* ---- scenes ------------------------------------------------------------------------------------------- */

/* `index`: every check has a seed of its own, so that their errors are independent. */
static BpStatus add_item(Session *session, const char *name, BpScene *scene, BpLightSampling light_sampling,
                         BpCaustics caustics, size_t index, BpError *err) {
    const BpCommandLine *line = session->line;
    BpCheckItem *item = &session->items[session->item_count];
    *item = (BpCheckItem){.name = name, .scene = scene};
    item->options.threads = line->threads;
    item->options.margin = bp_option_given(line, BP_OPTION_MARGIN) ? line->margin_percent / 100
                           : line->suite                           ? SUITE_MARGIN
                                                                   : BP_VERDICT_MARGIN;
    BpRenderOptions *options = &item->options.render;
    BP_TRY(bp_setup_options(line, scene, options, err));
    if (!bp_option_given(line, BP_OPTION_SPP)) options->samples_per_pixel = BP_CHECK_SAMPLES_DEFAULT;
    options->sampler = BP_SAMPLER_INDEPENDENT;
    options->light_sampling = light_sampling;
    options->caustics = caustics;
    options->seed += index;
    ++session->item_count;
    if (json_array_append_new(session->scenes, bp_check_scene_json(name, scene, options)) != 0)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
    return BP_OK;
}

/* The checks of one scene. Without --light-sampling, a scene whose lights can be sampled is checked without
 * and with that: the first tests more, since spreads are then the same as the reference's; the second is what
 * renders do. Without --caustics too, one in which rays can be sent to lights by way of spheres is checked
 * with that as well. `index`: of the scene, in a suite of `count`. */
static BpStatus add_items(Session *session, const char *name, BpScene *scene, size_t index, size_t count,
                          BpError *err) {
    const BpCommandLine *line = session->line;
    const bool given = bp_option_given(line, BP_OPTION_LIGHT_SAMPLING);
    const bool caustics_given =
        bp_option_given(line, BP_OPTION_CAUSTICS) && line->caustics != BP_CAUSTICS_AUTO;
    const BpCaustics caustics = caustics_given ? line->caustics : BP_CAUSTICS_OFF;
    const BpRenderOptions sampled = {.light_sampling = BP_LIGHT_SAMPLING_ON, .caustics = BP_CAUSTICS_ON};
    if (bp_option_given(line, BP_OPTION_WIDTH))
        BP_TRY(bp_scene_set_width(scene, line->width, err));
    else if (scene->camera.width > BP_CHECK_WIDTH_DEFAULT)
        BP_TRY(bp_scene_set_width(scene, BP_CHECK_WIDTH_DEFAULT, err));
    BP_TRY(add_item(session, name, scene, given ? line->light_sampling : BP_LIGHT_SAMPLING_OFF, caustics,
                    index, err));
    if (given || bp_render_light_sampling(scene, &sampled) == BP_LIGHT_SAMPLING_OFF) return BP_OK;
    BP_TRY(add_item(session, name, scene, BP_LIGHT_SAMPLING_ON, caustics, count + index, err));
    if (caustics_given || bp_render_caustics(scene, &sampled) == BP_CAUSTICS_OFF) return BP_OK;
    return add_item(session, name, scene, BP_LIGHT_SAMPLING_ON, BP_CAUSTICS_ON, 2 * count + index, err);
}

static BpStatus load_items(Session *session, BpError *err) {
    const BpCommandLine *line = session->line;
    if (line->suite) BP_TRY(bp_suite_load(&session->suite, err));
    const size_t count = line->suite ? session->suite.count : 1;
    session->items = calloc(CHECKS_OF_A_SCENE * count, sizeof *session->items);
    session->scenes = json_array();
    if (session->items == NULL || session->scenes == NULL)
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu scenes", count);
    for (size_t i = 0; i < session->suite.count; ++i)
        BP_TRY(add_items(session, session->suite.names[i], session->suite.scenes[i], i, count, err));
    if (!line->suite) {
        BP_TRY(bp_setup_scene(line, line->operands[0], &session->scene, err));
        BP_TRY(add_items(session, session->scene->path, session->scene, 0, count, err));
        bp_setup_warn(line, session->scene, session->items[0].options.render.precision);
    }
    const double level = line->suite ? SUITE_LEVEL : BP_VERDICT_LEVEL;
    for (size_t i = 0; i < session->item_count; ++i)
        session->items[i].options.level = level / (double)session->item_count;
    return BP_OK;
}

/* ---- devices ------------------------------------------------------------------------------------------ */

/* "map.png" for device 2 becomes "map-2.png". */
static void map_name(const char *map, unsigned device, char *name, size_t size) {
    const char *slash = strrchr(map, '/'), *dot = strrchr(slash != NULL ? slash : map, '.');
    const size_t stem = dot != NULL ? (size_t)(dot - map) : strlen(map);
    snprintf(name, size, "%.*s-%u%s", (int)stem, map, device, dot != NULL ? dot : "");
}

/* The devices' maps must not be any of the other files, as for the map that the command line names. */
static BpStatus check_map_names(const Session *session, BpError *err) {
    BpCommandLine line = *session->line;
    char name[4096];
    line.map = name;
    for (size_t d = 0; d < session->device_count && session->line->map != NULL; ++d) {
        map_name(session->line->map, session->devices[d].number, name, sizeof name);
        BP_TRY(bp_file_conflicts_check(&line, NULL, err));
        BP_TRY(bp_file_conflicts_check_scene(&line, NULL, session->scene, err));
        BP_TRY(bp_line_check_output(&line, name, err));
    }
    return BP_OK;
}

static void say_overwritten(const Session *session) {
    const BpCommandLine *line = session->line;
    char name[4096];
    bp_line_say_overwritten(line, line->json);
    bp_line_say_overwritten(line, line->junit);
    if (!wants_all(line)) bp_line_say_overwritten(line, line->map);
    for (size_t d = 0; d < session->device_count && line->map != NULL && wants_all(line); ++d) {
        map_name(line->map, session->devices[d].number, name, sizeof name);
        bp_line_say_overwritten(line, name);
    }
}

static BpStatus find_devices(Session *session, BpError *err) {
    const BpCommandLine *line = session->line;
    BpDeviceSurvey *survey = &session->survey;
    /* Even where a check may take no time, drivers need some to start. */
    double seconds = line->timeout_seconds;
    if (!bp_option_given(line, BP_OPTION_TIMEOUT))
        BP_TRY(bp_driver_seconds(&seconds, err));
    else if (seconds < SURVEY_SECONDS_MIN)
        seconds = SURVEY_SECONDS_MIN;
    BP_TRY(bp_device_survey(seconds, line->quiet, survey, err));
    session->devices = calloc(survey->count + 1, sizeof *session->devices);
    if (session->devices == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of devices");
    if (wants_all(line) && survey->count > 0) {
        memcpy(session->devices, survey->devices, survey->count * sizeof *survey->devices);
        session->device_count = survey->count;
        return BP_OK;
    }
    session->device_count = 1;
    return bp_device_survey_find(survey, wants_all(line) ? NULL : line->device, session->devices, err);
}

/* ---- checking ----------------------------------------------------------------------------------------- */

/* Adds the entries of one device, one of each scene in order, to the document's scenes. */
static BpStatus add_entries(Session *session, BpItemOutcome *outcomes, BpError *err) {
    for (size_t i = 0; i < session->item_count; ++i) {
        BpItemOutcome *outcome = &outcomes[i];
        json_t *results = json_object_get(json_array_get(session->scenes, i), "results");
        if (json_array_append(results, json_object_get(outcome->result, "entry")) != 0)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
        if (outcome->error.code == BP_ERR_INTERRUPTED) session->interrupted = true;
        if (outcome->error.code != BP_OK && session->error.code == BP_OK) {
            session->error = outcome->error;
            outcome->error = (BpError){0};
        }
    }
    return BP_OK;
}

static BpStatus check_device(Session *session, const BpDeviceInfo *device, BpError *err) {
    const BpCommandLine *line = session->line;
    char name[4096];
    BpCheckRun run = {.items = session->items,
                      .count = session->item_count,
                      .device = device,
                      .seconds = line->timeout_seconds,
                      .map = line->map,
                      .map_format = session->map_format,
                      .quiet = line->quiet,
                      .line = line};
    if (line->map != NULL && wants_all(line)) {
        map_name(line->map, device->number, name, sizeof name);
        run.map = name;
    }
    if (wants_all(line) || line->suite) bp_say(line, "checking device %u, %s", device->number, device->name);
    BpItemOutcome *outcomes = calloc(session->item_count, sizeof *outcomes);
    if (outcomes == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for results");
    BpStatus status = BP_OK;
    if (device->refusal[0] == '\0') {
        status = bp_check_run(&run, outcomes, err);
    } else {
        for (size_t i = 0; i < session->item_count; ++i)
            outcomes[i].result = json_pack("{s:o}", "entry", bp_check_entry_failed(device, device->refusal));
    }
    for (size_t i = 0; i < session->item_count && status == BP_OK && !line->suite && !wants_all(line); ++i)
        status = bp_copy_text(bp_check_text(outcomes[i].result, "text"), &session->text[i], err);
    if (status == BP_OK) status = add_entries(session, outcomes, err);
    bp_item_outcomes_clear(outcomes, session->item_count);
    free(outcomes);
    return status;
}

/* ---- what comes of it --------------------------------------------------------------------------------- */

/* One check of a scene on one device. */
static void print_verdict(const Session *session, size_t item, FILE *out) {
    const json_t *scene = json_array_get(session->scenes, item);
    const json_t *entry = json_array_get(json_object_get(scene, "results"), 0);
    const json_int_t samples = json_integer_value(json_object_get(entry, "samples_per_pixel"));
    char title[700];
    char name[BP_CHECK_LABEL_SIZE];
    bp_print_escaped(bp_check_label(scene, name, sizeof name), false, out);
    fprintf(out, " on %s\n", bp_check_device_title(entry, title, sizeof title));
    fprintf(out, "%dx%d pixels, %" JSON_INTEGER_FORMAT " sample%s each%s: %s",
            (int)json_integer_value(json_object_get(scene, "width")),
            (int)json_integer_value(json_object_get(scene, "height")), samples, bp_plural((uint64_t)samples),
            json_is_true(json_object_get(entry, "timed_out")) ? " when time was up" : "",
            session->text[item]);
}

static bool has_verdict(const Session *session, size_t item) {
    return session->text[item] != NULL && session->text[item][0] != '\0';
}

static BpStatus write_documents(Session *session, const json_t *against, BpError *err) {
    const BpCommandLine *line = session->line;
    json_t *broken = bp_device_survey_broken_json(&session->survey);
    BpStatus status = BP_OK;
    if (line->junit != NULL)
        status = bp_junit_write(line, bp_check_junit(session->scenes, broken), line->junit, err);
    session->junit_written = status != BP_ERR_MEMORY; /* else another attempt would fail too */
    if (line->json != NULL) { /* also when the other document failed: a check takes minutes */
        json_t *document = bp_check_document(json_incref(session->scenes), json_incref(broken),
                                             line->suite ? SUITE_NAME : NULL, SUITE_LEVEL);
        if (against != NULL && document != NULL)
            json_object_set(document, "against", (json_t *)(uintptr_t)against);
        const BpStatus written = bp_json_write(line, document, line->json, status == BP_OK ? err : NULL);
        session->json_written = written != BP_ERR_MEMORY;
        if (status == BP_OK) status = written;
    }
    json_decref(broken);
    return status;
}

/* Of the first check on the first device that is. */
static const char *why_inconclusive(const Session *session) {
    size_t index;
    json_t *scene;
    json_array_foreach(session->scenes, index, scene) {
        const json_t *entry = json_array_get(json_object_get(scene, "results"), 0);
        if (strcmp(bp_check_text(entry, "verdict"), "inconclusive") == 0)
            return bp_check_text(entry, "reason");
    }
    return "";
}

/* The share of its work that a check has done in its time; 0: its turn did not come. */
static double share_done(const json_t *entry, uint64_t samples) {
    const json_int_t done = json_integer_value(json_object_get(entry, "samples_per_pixel"));
    const bool stopped =
        strcmp(bp_check_text(entry, "verdict"), "inconclusive") == 0 && (uint64_t)done < samples;
    return stopped ? (double)done / (double)samples : 1;
}

/* "; --timeout was too short: ..." where --timeout left checks without evidence; else "". Of the slowest
 * device, by the work that it has done so far; building kernels counts as work that all checks share equally.
 */
static const char *hint_at_time(const Session *session, char text[160]) {
    double least = 1;
    char needed[32];
    text[0] = '\0';
    for (size_t d = 0; d < session->device_count && session->line->timeout_seconds > 0; ++d) {
        double done = 0, begun = 0;
        for (size_t i = 0; i < session->item_count; ++i) {
            const json_t *results = json_object_get(json_array_get(session->scenes, i), "results");
            const double share =
                share_done(json_array_get(results, d), session->items[i].options.render.samples_per_pixel);
            done += share;
            begun += share > 0;
        }
        done = begun < (double)session->item_count ? begun : done;
        if (done / (double)session->item_count < least) least = done / (double)session->item_count;
    }
    if (least == 1) return text;
    if (least > 0)
        snprintf(text, 160, "; --timeout was too short: all of it takes about %s",
                 bp_format_seconds(session->line->timeout_seconds / least, needed, sizeof needed));
    else
        snprintf(text, 160, "; --timeout was too short for the first of them");
    return text;
}

/* The exit code, by the worst that has happened. */
static BpStatus conclude(Session *session, const json_t *against, BpError *err) {
    const BpCommandLine *line = session->line;
    const char *name = line->suite ? "the suite" : session->items[0].name;
    const BpError *error = &session->error;
    const size_t entries = session->item_count * session->device_count;
    char hint[160];
    BpCheckCounts counts = {0};
    bp_check_count_all(session->scenes, &counts);
    if (session->interrupted)
        return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted before a verdict was reached");
    if (counts.disagree > 0 && entries == 1)
        return bp_fail(err, BP_ERR_DISAGREE, "%s: kernel and reference disagree", name);
    if (counts.disagree > 0)
        return bp_fail(err, BP_ERR_DISAGREE, "%s: kernel and reference disagree in %u of %zu checks", name,
                       counts.disagree, entries);
    if (counts.failed > 0 && entries == 1 && error->code != BP_OK) {
        const bool device = error->code == BP_ERR_DEVICE || error->code == BP_ERR_BUILD;
        const BpDeviceInfo *at = &session->devices[0];
        const BpStatus status =
            error->code == BP_ERR_BROKEN_DEVICE /* which crashed or hung, and that is all that is said */
                ? bp_fail(err, error->code, "%s (%s, driver %s) %s", at->name, at->platform, at->driver,
                          error->message)
                : bp_fail(err, device ? BP_ERR_BROKEN_DEVICE : error->code, "%s", error->message);
        if (error->file[0] != '\0') bp_error_at(err, error->file, error->line, error->column);
        bp_error_attach(err, error->attachment);
        return status;
    }
    if (counts.failed > 0 && error->code == BP_ERR_MEMORY) /* which is not the fault of a device */
        return bp_fail(err, BP_ERR_MEMORY, "%s: not every check could be made: %s", name, error->message);
    if (counts.failed > 0)
        return bp_fail(err, BP_ERR_BROKEN_DEVICE, "%s: a device failed before it could be checked", name);
    if (wants_all(line) && session->survey.broken_count > 0)
        return bp_fail(err, BP_ERR_BROKEN_DEVICE, "the driver %s could not be checked: it %s",
                       session->survey.broken[0].file, session->survey.broken[0].failure);
    const size_t gone = against != NULL ? bp_check_against_gone(against) : 0;
    if (gone > 0)
        return bp_fail(err, BP_ERR_NO_DEVICE, "%zu device%s of the earlier check %s not there", gone,
                       bp_plural(gone), gone == 1 ? "is" : "are");
    if (counts.inconclusive > 0 && !line->suite && !wants_all(line))
        return bp_fail(err, BP_ERR_INCONCLUSIVE, "%s: inconclusive: %s%s", name, why_inconclusive(session),
                       hint_at_time(session, hint));
    if (counts.inconclusive > 0)
        return bp_fail(err, BP_ERR_INCONCLUSIVE, "%s: %u of %zu checks are inconclusive%s", name,
                       counts.inconclusive, entries, hint_at_time(session, hint));
    return BP_OK;
}

static BpStatus check_all(Session *session, BpError *err) {
    const BpCommandLine *line = session->line;
    json_t *against = NULL;
    BpStatus status = BP_OK;
    BP_TRY(find_map_format(session, err));
    if (line->against != NULL) BP_TRY(bp_check_against_read(line->against, &session->earlier, err));
    if (wants_documents(line)) bp_interrupt_catch(); /* they report the interruption */
    BP_TRY(load_items(session, err));
    bp_interrupt_catch();
    if (bp_interrupted()) return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted before anything was checked");
    BP_TRY(find_devices(session, err));
    if (wants_all(line)) BP_TRY(check_map_names(session, err));
    say_overwritten(session);
    for (size_t d = 0; d < session->device_count && !session->interrupted; ++d)
        BP_TRY(check_device(session, &session->devices[d], err));
    if (session->interrupted && session->item_count * session->device_count == 1) {
        BP_TRY(write_documents(session, NULL, err));
        return conclude(session, NULL, err);
    }

    if (session->earlier != NULL) {
        against = bp_check_against(session->scenes, session->earlier, line->against, wants_all(line));
        if (against == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a comparison");
    }
    if (!is_stdout(line->json) && !is_stdout(line->junit)) {
        BpPage page;
        BpCommandLine loud = *line; /* with --quiet, the rows that remain are errors */
        loud.quiet = line->quiet && !line->suite && !wants_all(line);
        bp_page_begin(&page, stdout);
        for (size_t i = 0; i < CHECKS_OF_A_SCENE; ++i)
            if (has_verdict(session, i)) print_verdict(session, i, page.text);
        if (wants_all(line) || line->suite) bp_check_print_table(session->scenes, line->quiet, page.text);
        if (against != NULL) bp_check_against_print(against, page.text);
        bp_page_end(&page, &loud, stdout);
    }
    status = write_documents(session, against, err);
    if (status == BP_OK) status = conclude(session, against, err);
    json_decref(against);
    return status;
}

/* ---- --bits ------------------------------------------------------------------------------------------- */

static json_t *bits_case(const json_t *entry) {
    char name[256];
    const char *verdict = bp_check_text(entry, "verdict");
    return json_pack("{s:s, s:s, s:f, s:s, s:s, s:s}", "name", bp_check_bits_label(entry, name, sizeof name),
                     "class", "ballpark.check.bits", "seconds", 0.0, "outcome",
                     strcmp(verdict, "agree") == 0     ? "passed"
                     : strcmp(verdict, "skipped") == 0 ? "skipped"
                     : strcmp(verdict, "failed") == 0  ? "error"
                                                       : "failure",
                     "type", verdict, "reason", bp_check_text(entry, "reason"));
}

static json_t *bits_junit_suite(const json_t *entries) {
    json_t *suite = bp_check_junit_suite(json_array_get(entries, 0)), *entry;
    size_t index;
    int failed = suite == NULL;
    json_array_foreach(entries, index, entry) {
        failed |= json_array_append_new(json_object_get(suite, "cases"), bits_case(entry));
    }
    if (!failed) return suite;
    json_decref(suite);
    return NULL;
}

static BpStatus write_bits(Session *session, json_t *results, BpError *err) {
    const BpCommandLine *line = session->line;
    json_t *broken = bp_device_survey_broken_json(&session->survey);
    json_t *suites = bp_check_junit(NULL, broken), *entries;
    BpStatus status = BP_OK;
    BpCheckCounts counts = {0};
    json_t *all = json_array();
    size_t index, e;
    json_array_foreach(results, index, entries) {
        json_t *entry;
        if (json_array_append_new(suites, bits_junit_suite(entries)) != 0)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
        json_array_foreach(entries, e, entry) {
            bp_check_count(entry, &counts);
            json_array_append(all, entry);
        }
    }
    if (line->junit != NULL && status == BP_OK)
        status = bp_junit_write(line, suites, line->junit, err);
    else
        json_decref(suites);
    session->junit_written = status != BP_ERR_MEMORY;
    if (line->json != NULL && status == BP_OK)
        status = bp_json_write(line,
                               json_pack("{s:s, s:s, s:s, s:O, s:O}", "ballpark", bp_version(), "suite",
                                         "bits", "verdict", bp_check_overall(&counts), "broken_drivers",
                                         broken, "results", all),
                               line->json, err);
    session->json_written = status != BP_ERR_MEMORY;
    json_decref(broken);
    json_decref(all);
    if (status != BP_OK) return status;
    if (bp_interrupted()) return bp_fail(err, BP_ERR_INTERRUPTED, "interrupted");
    if (counts.disagree > 0)
        return bp_fail(err, BP_ERR_DISAGREE, "%u picture%s from the recorded one%s", counts.disagree,
                       counts.disagree == 1 ? " differs" : "s differ", counts.disagree == 1 ? "" : "s");
    if (counts.failed > 0)
        return bp_fail(err, BP_ERR_BROKEN_DEVICE, "a device failed before all pictures were compared");
    if (wants_all(line) && session->survey.broken_count > 0)
        return bp_fail(err, BP_ERR_BROKEN_DEVICE, "the driver %s could not be checked: it %s",
                       session->survey.broken[0].file, session->survey.broken[0].failure);
    if (counts.inconclusive > 0 || counts.agree == 0)
        return bp_fail(err, BP_ERR_INCONCLUSIVE, "%u pictures were compared and %u were not", counts.agree,
                       counts.inconclusive + counts.skipped);
    return BP_OK;
}

static BpStatus check_bits(Session *session, BpError *err) {
    const BpCommandLine *line = session->line;
    json_t *pictures = NULL, *results = NULL, *entries = NULL;
    BpStatus status = bp_check_bits_read(&pictures, err);
    if (status == BP_OK) status = bp_suite_load(&session->suite, err);
    bp_interrupt_catch();
    if (status == BP_OK) status = find_devices(session, err);
    if (status == BP_OK) say_overwritten(session);
    results = json_array();
    for (size_t d = 0; d < session->device_count && status == BP_OK && !bp_interrupted(); ++d) {
        const BpBitsRun run = {.pictures = pictures,
                               .suite = &session->suite,
                               .device = &session->devices[d],
                               .seconds = line->timeout_seconds,
                               .kernel = line->kernel,
                               .one_precision = bp_option_given(line, BP_OPTION_PRECISION),
                               .precision = line->precision,
                               .quiet = line->quiet};
        status = bp_check_bits_run(&run, &entries, err);
        if (status != BP_OK) break;
        if (!is_stdout(line->json) && !is_stdout(line->junit)) {
            BpPage page;
            BpCommandLine loud = *line; /* with --quiet, the rows that remain are errors */
            loud.quiet = false;
            bp_page_begin(&page, stdout);
            bp_check_bits_print(entries, line->quiet, page.text);
            bp_page_end(&page, &loud, stdout);
        }
        if (json_array_append_new(results, entries) != 0)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
    }
    if (status == BP_OK) status = write_bits(session, results, err);
    json_decref(results);
    json_decref(pictures);
    return status;
}

/* ---- the command -------------------------------------------------------------------------------------- */

/* A failed check replaces the documents of an earlier one, too; but not after an error of the command line,
 * since then the files that they may replace are unknown. */
static void write_failure(const Session *session, BpStatus status, const BpError *err) {
    const BpCommandLine *line = session->line;
    if (status == BP_OK || status == BP_ERR_USAGE) return;
    BpError told = *err;
    told.code = status; /* more exact than that of a public function */
    bp_error_add_remedy(&told, BP_INTERFACE_COMMAND_LINE);
    bp_check_failure_write(
        line,
        line->bits    ? "bits"
        : line->suite ? SUITE_NAME
                      : NULL,
        &told, bp_device_survey_broken_json(&session->survey), line->junit != NULL && !session->junit_written,
        line->json != NULL && !session->json_written, line->operand_count > 0 && session->scene == NULL);
}

BpStatus bp_command_check(const BpCommandLine *line, BpError *err) {
    Session session = {.line = line};
    BP_TRY(check_line(line, err));
    BpStatus status = check_documents(&session, err);
    if (status == BP_OK) status = line->bits ? check_bits(&session, err) : check_all(&session, err);
    write_failure(&session, status, err);
    bp_device_survey_clear(&session.survey);
    bp_suite_clear(&session.suite);
    bp_scene_destroy(&session.scene);
    bp_error_clear(&session.error);
    json_decref(session.scenes);
    json_decref(session.earlier);
    free(session.devices);
    free(session.items);
    for (size_t i = 0; i < CHECKS_OF_A_SCENE; ++i) free(session.text[i]);
    return status;
}
