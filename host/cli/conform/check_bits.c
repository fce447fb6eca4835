/* check_bits.c: see check_bits.h. */
#include "check_bits.h"

#include "base/escape.h"
#include "base/input_file.h"
#include "base/json_memory.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/words.h"
#include "check/bits.h"
#include "check_entry.h"
#include "cli/process/interrupt.h"
#include "cli/terminal/terminal.h"
#include "device_items.h"
#include "item_device.h"
#include "packed/acceleration.h"
#include "render/render.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In generated code (cmake/embed_files.cmake). */
const char *bp_recorded_bits_file(const char *name);

/* ---- what is recorded --------------------------------------------------------------------------------- */

static bool whole(const json_t *picture) {
    return json_is_string(json_object_get(picture, "scene")) &&
           json_is_integer(json_object_get(picture, "width")) &&
           json_is_integer(json_object_get(picture, "samples_per_pixel")) &&
           json_is_integer(json_object_get(picture, "seed")) &&
           json_is_string(json_object_get(picture, "precision")) &&
           json_is_string(json_object_get(picture, "refinement")) &&
           json_is_string(json_object_get(picture, "hash")) &&
           json_is_string(json_object_get(picture, "radiance"));
}

static BpStatus read_text(const char *path, char **text, size_t *length, BpError *err) {
    FILE *in = fopen(path, "rb");
    if (in == NULL)
        return bp_fail(err, BP_ERR_FILE, "the recorded pictures: cannot open %s: %s", path, strerror(errno));
    const BpStatus status = bp_stream_read(in, 0, path, text, length, err);
    fclose(in);
    return status;
}

BpStatus bp_check_bits_read(json_t **pictures, BpError *err) {
    const char *path = getenv("BALLPARK_BITS"), *embedded = bp_recorded_bits_file("bits.json");
    json_error_t fault;
    char *text = NULL;
    size_t length = strlen(embedded);
    bool no_memory = false;
    *pictures = NULL;
    if (path != NULL) BP_TRY(read_text(path, &text, &length, err));
    json_t *document =
        bp_json_load(text != NULL ? text : embedded, length, JSON_REJECT_DUPLICATES, &fault, &no_memory);
    free(text);
    if (no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the recorded pictures");
    if (document == NULL) {
        const BpStatus status = bp_fail(err, BP_ERR_FILE, "the recorded pictures: %s", fault.text);
        if (path != NULL)
            bp_error_at(err, path, fault.line > 0 ? fault.line : 0, fault.column > 0 ? fault.column : 0);
        return status;
    }
    json_t *list = json_incref(json_object_get(document, "pictures"));
    size_t index;
    json_t *picture;
    bool good = json_is_array(list) && json_array_size(list) > 0;
    json_array_foreach(list, index, picture) {
        good = good && whole(picture);
    }
    json_decref(document);
    if (good) {
        *pictures = list;
        return BP_OK;
    }
    json_decref(list);
    return bp_fail(err, BP_ERR_FILE, "%s holds no recorded pictures; scripts/record-bits writes them",
                   path != NULL ? path : "host/check/bits.json");
}

/* ---- what is rendered --------------------------------------------------------------------------------- */

/* One picture in one form. */
typedef struct Form {
    const json_t *picture;
    BpKernelForm kernel;
    BpAcceleration acceleration;
    BpPrecision precision;
    bool float_refine;
    const char *skipped; /* Optional: why it is */
} Form;

/* All kernels, tree and list, each in single precision with both refinements, and in double. */
enum { KERNELS = 3, FORMS = KERNELS * 2 * 3 };

typedef struct Plan {
    const BpBitsRun *run;
    BpItemDevice *device; /* the child's */
    Form *forms;
    size_t count;
} Plan;

static const char *why_skip(const BpBitsRun *run, BpKernelForm kernel, BpPrecision precision,
                            bool float_refine) {
    const BpDeviceInfo *device = run->device;
    if (precision == BP_PRECISION_DOUBLE && !device->has_double) return "the device has no double precision";
    if (kernel == BP_KERNEL_PACKET && run->kernel == BP_KERNEL_AUTO &&
        (device->type != BP_DEVICE_CPU || device->float_lanes < 4))
        return "the packet form is for CPUs with vectors; --kernel packet tries it";
    if (precision == BP_PRECISION_SINGLE && !float_refine &&
        (device->type != BP_DEVICE_CPU || !device->has_double))
        return "only CPUs with double precision refine hits in double";
    return NULL;
}

/* Form by form, so that a driver that keeps the last kernel builds few. */
static BpStatus make_plan(const BpBitsRun *run, Plan *plan, BpError *err) {
    static const BpKernelForm kernels[KERNELS] = {BP_KERNEL_PACKET, BP_KERNEL_SAMPLE, BP_KERNEL_POOL};
    const size_t pictures = json_array_size(run->pictures);
    *plan = (Plan){.run = run, .forms = calloc(FORMS * pictures + 1, sizeof *plan->forms)};
    if (plan->forms == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a list of pictures");
    for (size_t form = 0; form < FORMS; ++form) {
        const BpKernelForm kernel = kernels[form / 2 % KERNELS];
        const size_t numbers = form / (2 * KERNELS);
        const BpPrecision precision = numbers < 2 ? BP_PRECISION_SINGLE : BP_PRECISION_DOUBLE;
        const bool float_refine = numbers == 1;
        if (run->kernel != BP_KERNEL_AUTO && run->kernel != kernel) continue;
        /* A processor uses the pool form only on request. */
        if (kernel == BP_KERNEL_POOL && run->kernel == BP_KERNEL_AUTO && run->device->type == BP_DEVICE_CPU)
            continue;
        if (run->one_precision && run->precision != precision) continue;
        for (size_t p = 0; p < pictures; ++p) {
            const json_t *picture = json_array_get(run->pictures, p);
            if (strcmp(bp_check_text(picture, "precision"), bp_precision_names[precision]) != 0) continue;
            if ((strcmp(bp_check_text(picture, "refinement"), "float") == 0) != float_refine) continue;
            plan->forms[plan->count++] =
                (Form){.picture = picture,
                       .kernel = kernel,
                       .acceleration = form % 2 == 0 ? BP_ACCELERATION_TREE : BP_ACCELERATION_LIST,
                       .precision = precision,
                       .float_refine = float_refine,
                       .skipped = why_skip(run, kernel, precision, float_refine)};
        }
    }
    return BP_OK;
}

/* Older records lack this member. */
static BpCaustics caustics_of(const json_t *picture) {
    const bool on = strcmp(bp_check_text(picture, "caustics"), bp_caustics_names[BP_CAUSTICS_ON]) == 0;
    return on ? BP_CAUSTICS_ON : BP_CAUSTICS_OFF;
}

static json_t *form_json(const Form *form, const BpDeviceInfo *device, const char *verdict) {
    return json_pack("{s:o, s:s, s:s, s:s, s:s, s:s, s:s, s:s, s:b}", "device", bp_check_device_json(device),
                     "scene", bp_check_text(form->picture, "scene"), "caustics",
                     bp_caustics_names[caustics_of(form->picture)], "kernel", bp_kernel_names[form->kernel],
                     "acceleration", bp_acceleration_name(form->acceleration), "precision",
                     bp_precision_names[form->precision], "refinement",
                     bp_check_text(form->picture, "refinement"), "verdict", verdict, "agree",
                     strcmp(verdict, "agree") == 0);
}

#define KIND_TEXTS(X)                                                                                        \
    X(BP_BITS_SAME, "the same picture")                                                                      \
    X(BP_BITS_ROUNDING, "rounding: all pixels are equal but for their last digits")                          \
    X(BP_BITS_PATHS, "paths that went another way: some pixels are others")                                  \
    X(BP_BITS_PICTURE, "another picture: most pixels are others")
BP_WORDS(BpBitsKind, static const char *const kind_texts, KIND_TEXTS);

#define KIND_WORDS(X)                                                                                        \
    X(BP_BITS_SAME, "same")                                                                                  \
    X(BP_BITS_ROUNDING, "rounding") X(BP_BITS_PATHS, "paths") X(BP_BITS_PICTURE, "picture")
BP_WORDS(BpBitsKind, static const char *const kind_names, KIND_WORDS);

static void describe(const BpBitsDifference *difference, char *text, size_t size) {
    if (difference->different == 0)
        snprintf(text, size, "the sums differ by less than the last digit of a pixel");
    else
        snprintf(
            text, size, "%" PRIu32 " of %" PRIu32 " pixels differ, by up to %.2g of the mean brightness; %s",
            difference->different, difference->pixels, difference->largest, kind_texts[difference->kind]);
}

static json_t *compare(const Form *form, const BpDeviceInfo *device, const BpFilm *film, BpError *err) {
    const char *hash = bp_check_text(form->picture, "hash");
    BpBitsDifference difference;
    char own[17], reason[256];
    bp_bits_hash(film, own);
    if (strcmp(own, hash) == 0) {
        json_t *entry = form_json(form, device, "agree");
        json_object_set_new(entry, "hash", json_string(own));
        return entry;
    }
    if (hash[0] == '\0') { /* for scripts/record-bits */
        snprintf(reason, sizeof reason, "nothing is recorded");
        difference = (BpBitsDifference){.kind = BP_BITS_PICTURE, .largest = NAN, .mean = NAN};
    } else {
        if (bp_bits_compare(film, hash, bp_check_text(form->picture, "radiance"), &difference, err) != BP_OK)
            return NULL;
        describe(&difference, reason, sizeof reason);
    }
    char *radiance = bp_bits_radiance(film);
    json_t *entry = form_json(form, device, "disagree");
    json_t *more = json_pack("{s:s, s:s, s:s, s:s, s:{s:s, s:i, s:i, s:o, s:o}}", "reason", reason, "hash",
                             own, "recorded_hash", hash, "radiance", radiance != NULL ? radiance : "",
                             "difference", "kind", kind_names[difference.kind], "pixels",
                             (int)difference.pixels, "different", (int)difference.different, "largest",
                             isfinite(difference.largest) ? json_real(difference.largest) : json_null(),
                             "mean", isfinite(difference.mean) ? json_real(difference.mean) : json_null());
    json_object_update(entry, more);
    json_decref(more);
    free(radiance);
    return entry;
}

/* In the child. */
static BpStatus render_item(const BpDeviceItems *items, size_t number, double seconds, FILE *out,
                            json_t **result, BpError *err) {
    const Plan *plan = items->argument;
    const Form *form = &plan->forms[number];
    const BpDeviceInfo *device = plan->run->device;
    const char *name = bp_check_text(form->picture, "scene");
    BpScene *scene = bp_suite_find(plan->run->suite, name);
    BpRenderOptions options;
    BpRender *render = NULL;
    BpProgress progress = {0};
    const BpFilm *film = NULL;
    BpStatus status = BP_OK;
    (void)seconds; /* pictures are small: the time limit ends the list, not a picture */
    if (form->skipped != NULL) {
        *result = form_json(form, device, "skipped");
        json_object_set_new(*result, "reason", json_string(form->skipped));
        return BP_OK;
    }
    if (scene == NULL)
        return bp_fail(err, BP_ERR_FILE,
                       "%s is none of the agreement scenes; scripts/record-bits records anew", name);
    if (bp_terminal_is_live(items->quiet)) {
        char text[160];
        snprintf(text, sizeof text, "picture %zu of %zu: %s", number + 1, items->count, name);
        bp_terminal_show(text);
    }
    BP_TRY(bp_scene_set_width(scene, (uint32_t)json_integer_value(json_object_get(form->picture, "width")),
                              err));
    bp_render_defaults(scene, &options);
    options.samples_per_pixel =
        (uint64_t)json_integer_value(json_object_get(form->picture, "samples_per_pixel"));
    options.seed = (uint64_t)json_integer_value(json_object_get(form->picture, "seed"));
    options.sampler = BP_SAMPLER_SOBOL;
    options.samples_only = true;
    options.caustics = caustics_of(form->picture);
    options.precision = form->precision;
    options.kernel = form->kernel;
    options.force_tree = form->acceleration == BP_ACCELERATION_TREE;
    options.force_list = form->acceleration == BP_ACCELERATION_LIST;
    options.force_float_refine = form->float_refine;
    options.all_effects = true; /* one kernel a form, whatever the scene */
    bp_item_doing(out, number, "building the kernel");
    status = bp_item_device_open(plan->device, err);
    if (status == BP_OK) status = bp_render_create_on(scene, &options, &plan->device->open, 1, &render, err);
    if (status == BP_OK) bp_item_doing(out, number, "rendering");
    while (!progress.finished && status == BP_OK) {
        status = bp_render_step(render, &progress, err);
        if (status == BP_OK && bp_interrupted()) status = bp_fail(err, BP_ERR_INTERRUPTED, "interrupted");
    }
    if (status == BP_OK) status = bp_render_read_film(render, &film, err);
    if (status == BP_OK && (*result = compare(form, device, film, err)) == NULL)
        status = err->code != BP_OK ? err->code : bp_fail(err, BP_ERR_MEMORY, "out of memory for a report");
    bp_render_destroy(&render);
    bp_item_device_done(plan->device, status);
    if (number + 1 == items->count && bp_terminal_is_live(items->quiet)) bp_terminal_show("");
    return status;
}

BpStatus bp_check_bits_run(const BpBitsRun *run, json_t **entries, BpError *err) {
    Plan plan;
    BpItemOutcome *outcomes = NULL;
    BpItemDevice device = {.info = run->device};
    BpStatus status = make_plan(run, &plan, err);
    *entries = NULL;
    if (status != BP_OK) return status;
    plan.device = &device;
    const BpDeviceItems items = {.work = render_item,
                                 .argument = &plan,
                                 .count = plan.count,
                                 .seconds = run->seconds,
                                 .quiet = run->quiet};
    outcomes = calloc(plan.count + 1, sizeof *outcomes);
    json_t *list = json_array();
    if (outcomes == NULL || list == NULL) status = bp_fail(err, BP_ERR_MEMORY, "out of memory for results");
    if (status == BP_OK) status = bp_device_items_run(&items, outcomes, err);
    for (size_t i = 0; i < plan.count && status == BP_OK; ++i) {
        const BpError *error = &outcomes[i].error;
        json_t *entry = json_incref(outcomes[i].result);
        if (error->code == BP_ERR_FILE || error->code == BP_ERR_MEMORY) {
            status = bp_fail(err, error->code, "%s", error->message);
        } else if (entry == NULL) {
            const bool open = error->code == BP_ERR_INCONCLUSIVE || error->code == BP_ERR_INTERRUPTED;
            entry = form_json(&plan.forms[i], run->device, open ? "inconclusive" : "failed");
            json_object_set_new(entry, "reason", bp_json_text(error->message));
        }
        if (status == BP_OK && json_array_append_new(list, entry) != 0)
            status = bp_fail(err, BP_ERR_MEMORY, "out of memory for results");
    }
    bp_item_outcomes_clear(outcomes, plan.count);
    free(outcomes);
    free(plan.forms);
    if (status == BP_OK)
        *entries = list;
    else
        json_decref(list);
    return status;
}

/* ---- for people --------------------------------------------------------------------------------------- */

static const char advice[] =
    "If kernels, sampling, sums or the agreement scenes were changed on purpose, and all tests pass, record\n"
    "the pictures anew: scripts/record-bits. If not, this device computes differently from those that they\n"
    "were recorded on: `ballpark check --suite` shows whether its pictures are nevertheless right. Do not\n"
    "merge its renders with those of other devices where exact bits matter, and tell the maker of the "
    "driver.\n";

const char *bp_check_bits_label(const json_t *entry, char *text, size_t size) {
    snprintf(text, size, "%s%s, %s, %s, %s%s", bp_check_text(entry, "scene"),
             caustics_of(entry) == BP_CAUSTICS_ON ? " (caustics sampled)" : "",
             bp_check_text(entry, "kernel"), bp_check_text(entry, "acceleration"),
             bp_check_text(entry, "precision"),
             strcmp(bp_check_text(entry, "refinement"), "float") == 0 ? " (refined in float)" : "");
    return text;
}

void bp_check_bits_print(const json_t *entries, bool quiet, FILE *out) {
    BpCheckCounts counts = {0};
    char title[700], label[256];
    const char *last = ""; /* a reason that holds for the rest of the list is reported once */
    size_t index;
    json_t *entry;
    fprintf(out, "device %d: %s\n",
            (int)json_integer_value(
                json_object_get(json_object_get(json_array_get(entries, 0), "device"), "number")),
            bp_check_device_title(json_array_get(entries, 0), title, sizeof title));
    json_array_foreach(entries, index, entry) {
        const char *verdict = bp_check_text(entry, "verdict"), *reason = bp_check_text(entry, "reason");
        const bool skipped = strcmp(verdict, "skipped") == 0, differs = strcmp(verdict, "disagree") == 0;
        const bool said = strcmp(reason, last) == 0;
        bp_check_count(entry, &counts);
        last = reason;
        if (strcmp(verdict, "agree") == 0 || (said && !differs) || (skipped && quiet)) continue;
        fprintf(out, "  %s: %s: ",
                skipped                                ? "skipped"
                : differs                              ? "DIFFERENT"
                : strcmp(verdict, "inconclusive") == 0 ? "NOT COMPARED"
                                                       : "FAILED",
                bp_check_bits_label(entry, label, sizeof label));
        bp_print_escaped(reason, false, out);
        fputc('\n', out);
    }
    fprintf(out, "  %zu pictures: %u the same, %u different, %u not compared, %u failed, %u skipped\n",
            json_array_size(entries), counts.agree, counts.disagree, counts.inconclusive, counts.failed,
            counts.skipped);
    if (counts.disagree > 0) fputs(advice, out);
}
