/* cmd_explain.c: `ballpark explain`.
 *
 * In:    scenes.   Out: which effects are in each scene's kernel and why; with --measure what each effect
 * costs; with --pixel the steps of one path; as text or JSON.
 * Knows: the analysis of effects, cost measurements, path logs, tables.   Does not know: OpenCL. */
#include "commands.h"

#include "base/escape.h"
#include "base/format.h"
#include "base/json_text.h"
#include "base/names.h"
#include "base/plural.h"
#include "base/wrap.h"
#include "cli/job/setup.h"
#include "cli/job/unseen_text.h"
#include "cli/output/json_file.h"
#include "cli/output/output.h"
#include "cli/terminal/page.h"
#include "cli/terminal/terminal.h"
#include "explain_chains.h"
#include "render/path_log.h"
#include "render/pilot.h"
#include "render/render_plan.h"
#include "scene/material.h"
#include "study/effect_costs.h"

#include <errno.h>
#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROUNDS 21u
#define ROUND_SECONDS 0.12 /* long against a dispatch, short against a disturbance */
/* Pictures are measured at this width unless --width says otherwise: a ratio needs no large picture. */
#define MEASURED_WIDTH 400u

/* ---- one path ---------------------------------------------------------------------------------------- */

static bool is_black(const double colour[3]) {
    return colour[0] == 0 && colour[1] == 0 && colour[2] == 0;
}

/* What the surface did with the path. */
static const char *outcome(const BpPathStep *step, BpMaterialKind kind) {
    if (!step->goes_on && bp_material_is(kind, BP_SCATTERS)) return "absorbs it";
    if (step->goes_on && bp_material_is(kind, BP_HAS_INSIDE) && kind != BP_MATERIAL_INTERFACE) {
        if (step->enters) return step->inward ? "refracts it inward" : "reflects it";
        return step->inward ? "reflects it back inside" : "refracts it outward";
    }
    return bp_material_types[kind].outcome;
}

/* "sphere 3"; of other shapes also which member lists it. */
static const char *shape_name(const BpScene *scene, uint32_t shape, char text[BP_SPHERE_NAME_SIZE]) {
    if (shape >= scene->sphere_count) return bp_shape_name(scene, shape, text);
    snprintf(text, BP_SPHERE_NAME_SIZE, "sphere %" PRIu32, shape);
    return text;
}

static void print_lamp_ray(const BpScene *scene, const BpPathStep *step, FILE *out) {
    char name[BP_SPHERE_NAME_SIZE];
    if (!is_black(step->led))
        fprintf(out, "       by way of a ball of glass or a mirror come (%.4g, %.4g, %.4g)\n", step->led[0],
                step->led[1], step->led[2]);
    if (!step->to_lamp) return;
    if (step->to_image)
        fputs("       a ray to the image around", out);
    else if (!step->to_disc && step->lamp >= scene->sphere_count)
        fprintf(out, "       a ray to %s", shape_name(scene, step->lamp, name));
    else
        fprintf(out, "       a ray to %s %" PRIu32, step->to_disc ? "disc" : "lamp", step->lamp);
    if (!step->stopped)
        fprintf(out, " brings (%.4g, %.4g, %.4g)\n", step->lit[0], step->lit[1], step->lit[2]);
    else
        fprintf(out, " is stopped by %s\n", shape_name(scene, step->seen, name));
}

static void print_roulette(const BpPathStep *step, FILE *out) {
    if (step->chance > 0 && step->ended)
        fprintf(out, "       roulette, with a chance of %.4g to go on, ends the path here\n", step->chance);
    else if (step->chance > 0)
        fprintf(out, "       roulette, with a chance of %.4g, lets it go on and carry %.4g times as much\n",
                step->chance, 1 / step->chance);
}

static void print_path(const BpScene *scene, const BpPathLog *path, uint32_t x, uint32_t y, uint64_t sample,
                       uint64_t seed, FILE *out) {
    fprintf(out, "  pixel (%" PRIu32 ", %" PRIu32 "), sample %" PRIu64 ", seed %" PRIu64 ", on ", x, y,
            sample, seed);
    bp_print_escaped(path->device.name, false, out);
    fputc('\n', out);
    const double nothing[3] = {0};
    const double *radiance = nothing;
    for (size_t i = 0; i < path->count; ++i) {
        const BpPathStep *step = &path->steps[i];
        fprintf(out, "  %3zu  from (%.6g, %.6g, %.6g) along (%.4f, %.4f, %.4f)\n", i + 1, step->origin[0],
                step->origin[1], step->origin[2], step->direction[0], step->direction[1], step->direction[2]);
        if (step->scattered) {
            fprintf(out,
                    "       after %.6g a medium scatters it at (%.6g, %.6g, %.6g), throughput (%.4g, %.4g, "
                    "%.4g)\n",
                    step->distance, step->point[0], step->point[1], step->point[2], step->throughput[0],
                    step->throughput[1], step->throughput[2]);
            print_lamp_ray(scene, step, out);
        } else if (step->met) {
            char name[BP_SPHERE_NAME_SIZE];
            const BpMaterial *material = &scene->materials[step->material];
            fprintf(out, "       after %.6g hits %s from %s at (%.6g, %.6g, %.6g)\n", step->distance,
                    shape_name(scene, step->sphere, name), step->enters ? "outside" : "inside",
                    step->point[0], step->point[1], step->point[2]);
            fputs("       ", out);
            bp_print_escaped(material->name, false, out);
            fprintf(out, " (%s) %s", bp_material_types[material->kind].name, outcome(step, material->kind));
            if (step->goes_on)
                fprintf(out, ", throughput (%.4g, %.4g, %.4g)", step->throughput[0], step->throughput[1],
                        step->throughput[2]);
            fprintf(out, "\n");
            print_lamp_ray(scene, step, out);
        } else {
            const bool backdrop = i == 0 && scene->backdrop != BP_BACKDROP_SKY;
            if (step->caught)
                fprintf(out, "       after %.6g the shadow catcher, %s", step->distance,
                        step->dark ? "in shadow\n" : "lit: ");
            else
                fprintf(out, "       hits nothing: ");
            if (step->dark) {
                radiance = step->radiance;
                continue;
            }
            fprintf(out, "the %s", backdrop ? "backdrop" : "sky");
            for (uint32_t disc = 0; disc < 32 && !backdrop; ++disc)
                if ((step->discs >> disc & 1u) != 0) fprintf(out, " and disc %" PRIu32, disc);
            fputc('\n', out);
        }
        print_roulette(step, out);
        radiance = step->radiance;
    }
    if (path->cut) fprintf(out, "       the depth limit cuts the path here\n");
    if (path->count == 0) fprintf(out, "       no segments: the depth limit is 0\n");
    fprintf(out, "  radiance of the sample: (%.6g, %.6g, %.6g)%s\n", radiance[0], radiance[1], radiance[2],
            is_black(radiance) ? ", black" : "");
}

/* What the ray meets is a sphere, or for a disc or an image that nothing hides null. */
static json_t *lamp_ray_json(const BpPathStep *step) {
    json_t *const meets = step->stopped                     ? json_integer(step->seen)
                          : step->to_disc || step->to_image ? json_null()
                                                            : json_integer(step->lamp);
    if (step->to_image)
        return json_pack("{s:b, s:o, s:o}", "image", 1, "meets", meets, "brings", bp_json_triple(step->lit));
    return json_pack("{s:I, s:o, s:o}", step->to_disc ? "disc" : "lamp", (json_int_t)step->lamp, "meets",
                     meets, "brings", bp_json_triple(step->lit));
}

/* Adds the numbers of the discs that a segment ends in, where there are any; takes `root` over. */
static json_t *with_discs(json_t *root, uint32_t discs) {
    json_t *list = json_array();
    bool whole = list != NULL;
    for (uint32_t disc = 0; disc < 32 && whole; ++disc)
        if ((discs >> disc & 1u) != 0) whole = json_array_append_new(list, json_integer(disc)) == 0;
    if (whole && discs != 0) whole = json_object_set(root, "discs", list) == 0;
    json_decref(list);
    if (whole) return root;
    json_decref(root);
    return NULL;
}

/* NULL where it was not played. */
static json_t *roulette_json(const BpPathStep *step) {
    if (!(step->chance > 0)) return NULL;
    return json_pack("{s:f, s:b}", "chance", step->chance, "goes_on", !step->ended);
}

static json_t *step_json(const BpScene *scene, const BpPathStep *step) {
    json_t *root = json_pack("{s:o, s:o, s:o, s:o, s:b, s:o*, s:o*}", "origin", bp_json_triple(step->origin),
                             "direction", bp_json_triple(step->direction), "throughput",
                             bp_json_triple(step->throughput), "radiance", bp_json_triple(step->radiance),
                             "met", step->met, "led", is_black(step->led) ? NULL : bp_json_triple(step->led),
                             "roulette", roulette_json(step));
    if (root == NULL) return root;
    if (step->scattered) {
        if (json_object_set_new(root, "scattered", json_true()) == 0 &&
            json_object_set_new(root, "distance", json_real(step->distance)) == 0 &&
            json_object_set_new(root, "point", bp_json_triple(step->point)) == 0)
            return root;
        json_decref(root);
        return NULL;
    }
    if (!step->met) return with_discs(root, step->discs);
    const BpMaterial *material = &scene->materials[step->material];
    json_t *meeting = json_pack("{s:f, s:o, s:I, s:s, s:s, s:b, s:b, s:b}", "distance", step->distance,
                                "point", bp_json_triple(step->point), "sphere", (json_int_t)step->sphere,
                                "material", material->name, "type", bp_material_types[material->kind].name,
                                "enters", step->enters, "goes_on", step->goes_on, "inward", step->inward);
    bool whole = meeting != NULL && json_object_update(root, meeting) == 0;
    json_decref(meeting);
    if (step->to_lamp) whole = whole && json_object_set_new(root, "lamp_ray", lamp_ray_json(step)) == 0;
    if (whole) return root;
    json_decref(root);
    return NULL;
}

/* A new object, or NULL without memory. */
static json_t *path_json(const BpScene *scene, const BpPathLog *path, uint32_t x, uint32_t y, uint64_t sample,
                         json_t *chains) {
    json_t *steps = json_array();
    for (size_t i = 0; i < path->count && steps != NULL; ++i) {
        if (json_array_append_new(steps, step_json(scene, &path->steps[i])) == 0) continue;
        json_decref(steps);
        steps = NULL;
    }
    return json_pack("{s:[I,I], s:I, s:o, s:b, s:o, s:o}", "pixel", (json_int_t)x, (json_int_t)y, "sample",
                     (json_int_t)sample, "device", bp_json_text(path->device.name), "cut", path->cut, "steps",
                     steps, "chains", chains);
}

/* ---- the table of effects ----------------------------------------------------------------------------- */

static void print_heading(const char *path, const BpScene *scene, FILE *out) {
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    bp_print_escaped(path, false, out);
    fputs(": ", out);
    bp_print_escaped(info.title, false, out);
    char spheres[32], triangles[32], capsules[32], both[96] = "", all[96] = "";
    bp_format_whole(info.spheres, spheres, sizeof spheres);
    bp_format_whole(info.triangles, triangles, sizeof triangles);
    if (info.triangles > 0)
        snprintf(both, sizeof both, ", %s triangle%s", triangles, bp_plural(info.triangles));
    bp_format_whole(info.capsules, capsules, sizeof capsules);
    if (info.capsules > 0) snprintf(all, sizeof all, ", %s capsule%s", capsules, bp_plural(info.capsules));
    fprintf(out, "%s%s sphere%s%s%s, %zu material%s, %ux%u\n", info.title[0] != '\0' ? "; " : "", spheres,
            bp_plural(info.spheres), both, all, info.materials, bp_plural(info.materials), info.width,
            info.height);
}

static void print_effects(const BpScene *scene, const BpEffectInfo *effects, size_t count, FILE *out) {
    char reason[BP_ACCELERATION_REASON_SIZE];
    size_t in = 0;
    for (size_t e = 0; e < count; ++e) in += effects[e].simulated ? 1 : 0;
    for (size_t e = 0; e < count; ++e)
        fprintf(out, "  %-14s %-4s " BP_HANG "%s\n", effects[e].name, effects[e].simulated ? "in" : "out",
                effects[e].reason);
    fprintf(out, "  %zu of %zu effects %s in the kernel\n", in, count, in == 1 ? "is" : "are");
    const BpAcceleration chosen = bp_acceleration_choose(scene, reason);
    fprintf(out, "  %-14s %-4s " BP_HANG "%s\n", "acceleration", bp_acceleration_name(chosen), reason);
}

/* ---- what they cost ----------------------------------------------------------------------------------- */

/* A bar of one sign for each percent over 1, at most `columns`. */
static void print_bar(double ratio, unsigned columns, bool utf8, FILE *out) {
    const double percent = 100.0 * (ratio - 1.0);
    const unsigned signs = percent > 0.5 ? (unsigned)(percent + 0.5) : 0;
    for (unsigned i = 0; i < signs && i < columns; ++i) fputs(utf8 ? "\xe2\x96\x88" : "#", out);
    if (signs > columns) fputs("...", out);
}

static void print_costs(const BpCosts *costs, FILE *out) {
    const bool utf8 = bp_terminal_has_utf8();
    const unsigned terminal = bp_terminal_width(fileno(stdout));
    const unsigned columns = terminal > 60 ? terminal - 56 : 8;
    char rate[32];
    fputs("  ", out);
    bp_print_escaped(costs->device.name, false, out);
    fprintf(out, ", %s kernel, %ux%u, %u rounds of %s samples%s\n", bp_kernel_names[costs->form],
            costs->width, costs->height, costs->rounds,
            bp_format_count((double)costs->samples, rate, sizeof rate),
            costs->device.type == BP_DEVICE_CPU ? ", processor time" : "");
    fprintf(out, "  %-19s %6s %15s\n", "kernel", "time", "quartiles");
    for (size_t k = 0; k < costs->kernel_count; ++k) {
        const BpKernelCost *kernel = &costs->kernels[k];
        fprintf(out, "  %-19s %6.3f", kernel->name, kernel->ratio);
        if (k == 0)
            fprintf(out, "  %s samples/s%s\n", bp_format_count(kernel->samples_per_second, rate, sizeof rate),
                    costs->device.type == BP_DEVICE_CPU ? " per core" : "");
        else {
            fprintf(out, " %6.3f .. %5.3f  ", kernel->low, kernel->high);
            print_bar(kernel->ratio, columns, utf8, out);
            fprintf(out, "\n");
        }
    }
    for (size_t k = 0; k < costs->kernel_count; ++k) {
        const BpKernelCost *kernel = &costs->kernels[k];
        if (isnan(kernel->cold_seconds)) continue;
        fprintf(out, "  %s: ready to trace in %.2f s, in %.2f s from the driver's cache", kernel->name,
                kernel->cold_seconds, kernel->warm_seconds);
        if (kernel->registers > 0) fprintf(out, "; %llu registers", (unsigned long long)kernel->registers);
        if (kernel->private_bytes > 0)
            fprintf(out, "; %llu bytes of private memory", (unsigned long long)kernel->private_bytes);
        fprintf(out, "\n");
    }
}

/* What `ballpark render` would be told. */
static BpStatus render_options(const BpCommandLine *line, const BpScene *scene, BpRenderOptions *options,
                               BpError *err) {
    BP_TRY(bp_setup_options(line, scene, options, err));
    if (!bp_option_given(line, BP_OPTION_SAMPLER)) options->sampler = BP_SAMPLER_SOBOL;
    return BP_OK;
}

/* A status line while kernels are built and timed. */
static void tell_terminal(const char *what, void *context) {
    const BpCommandLine *line = context;
    if (bp_terminal_is_live(line->quiet)) bp_terminal_show(what);
}

static BpStatus measure(const BpCommandLine *line, BpScene *scene, const BpDeviceInfo *device, BpCosts *costs,
                        BpError *err) {
    BpRenderOptions options;
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    if (!bp_option_given(line, BP_OPTION_WIDTH) && info.width > MEASURED_WIDTH)
        BP_TRY(bp_scene_set_width(scene, MEASURED_WIDTH, err));
    BP_TRY(render_options(line, scene, &options, err));
    const BpCostPlan plan = {.rounds = ROUNDS,
                             .round_seconds = ROUND_SECONDS,
                             .builds = true,
                             .tell = tell_terminal,
                             .tell_context = (void *)(uintptr_t)line};
    const BpStatus status = bp_costs_measure(scene, &options, device, &plan, costs, err);
    if (bp_terminal_is_live(line->quiet)) bp_terminal_show("");
    return status;
}

/* ---- what samples find by chance ---- */

/* What was found out about one scene. */
typedef struct Findings {
    BpEffectInfo effects[BP_EFFECT_COUNT];
    size_t count;
    BpCosts costs;       /* with --measure */
    BpPathLog path;      /* with --pixel */
    BpChainLight chains; /* at the end of one of its segments */
    bool sampled;        /* rays are sent along these */
    bool by_rays;        /* of the render: --caustics on, or as good */
    BpUnseenLight unseen;
    double luminance;                            /* of the picture, roughly */
    char unknown[sizeof((BpError *)0)->message]; /* why it is not known what is found by chance; "": it is */
} Findings;

/* One path, and the light that its first matte point gets by way of spheres. */
static BpStatus follow(const BpCommandLine *line, const BpScene *scene, const BpDeviceInfo *device,
                       Findings *found, BpError *err) {
    BpRenderOptions options;
    BpEffects effects;
    BP_TRY(render_options(line, scene, &options, err));
    BP_TRY(bp_render_choose_caustics(scene, &options, device, err));
    BP_TRY(bp_path_log(scene, &options, device, line->pixel.x, line->pixel.y, (uint32_t)options.first_sample,
                       &found->path, err));
    bp_effects_analyse(scene, &effects);
    found->sampled = bp_render_caustics_of(&effects, &options) == BP_CAUSTICS_ON;
    if (!effects.caustics || options.light_sampling == BP_LIGHT_SAMPLING_OFF) return BP_OK;
    return bp_chain_light_find(scene, &found->path, options.max_depth, &found->chains, err);
}

/* So many samples of each pixel tell how bright the picture is, for the share of what is found by chance. */
#define LOOK_SAMPLES 4

static BpStatus look(const BpCommandLine *line, const BpScene *scene, const BpDeviceInfo *device,
                     Findings *found, BpError *err) {
    BpRenderOptions options;
    BpRender *render = NULL;
    const BpFilm *film = NULL;
    BpProgress progress = {.finished = false};
    BP_TRY(render_options(line, scene, &options, err));
    options.samples_per_pixel = LOOK_SAMPLES;
    options.adaptive = false;
    BpStatus status = bp_render_create(scene, &options, device, 1, &render, err);
    if (status == BP_OK) status = bp_render_unseen(render, &found->unseen, err);
    if (status == BP_OK) {
        BpRenderReport report;
        bp_render_report(render, &report);
        found->by_rays = report.caustics == BP_CAUSTICS_ON;
    }
    while (status == BP_OK && found->unseen.mean > 0 && !progress.finished)
        status = bp_render_step(render, &progress, err);
    if (status == BP_OK && found->unseen.mean > 0) status = bp_render_read_film(render, &film, err);
    if (film != NULL) found->luminance = bp_film_claim(film).luminance;
    bp_render_destroy(&render);
    return status;
}

/* *may_be: whether it is worth to open a device. */
static BpStatus may_be_unseen(const BpScene *scene, bool *may_be, BpError *err) {
    BpPilotAim aim;
    BP_TRY(bp_pilot_aim(scene, &aim, err));
    *may_be = bp_pilot_is_needed(scene, &aim);
    bp_pilot_aim_clear(&aim);
    return BP_OK;
}

/* What samples find by chance only. It takes a device; `device` may be NULL: then one is opened if there may
 * be such light. Where that fails, the rest is explained all the same. */
static void look_for_unseen(const BpCommandLine *line, const BpScene *scene, const BpDeviceInfo *device,
                            Findings *found) {
    BpError err = {0};
    BpDeviceInfo *devices = NULL;
    size_t count = 0;
    found->luminance = NAN;
    bool may_be = false;
    if (line->light_sampling == BP_LIGHT_SAMPLING_OFF) return;
    BpStatus status = may_be_unseen(scene, &may_be, &err);
    if (status == BP_OK && may_be && device == NULL) status = bp_setup_devices(line, &devices, &count, &err);
    if (status == BP_OK && may_be) status = look(line, scene, device != NULL ? device : devices, found, &err);
    bp_error_add_remedy(&err, BP_INTERFACE_COMMAND_LINE);
    if (status != BP_OK) snprintf(found->unknown, sizeof found->unknown, "%s", err.message);
    free(devices);
    bp_error_clear(&err);
}

/* Where there is a choice, what it is. */
static void print_caustics(const BpCommandLine *line, const Findings *found, FILE *out) {
    const bool given = line->caustics != BP_CAUSTICS_AUTO;
    fprintf(out, "  %-14s %-4s " BP_HANG "%s\n", "--caustics", found->by_rays ? "on" : "off",
            given ? "as asked for"
            : found->by_rays
                ? "rays to lamps go through balls of glass and off mirrors: without, pictures would be "
                  "noisier in the same time"
                : "light by way of glass and mirrors is left to chance: rays for it would take more "
                  "time than the noise that they spare");
}

static void print_unseen(const BpCommandLine *line, const BpScene *scene, const Findings *found, FILE *out) {
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    char noise[32];
    const uint64_t samples = scene->camera.samples_per_pixel;
    if (found->unknown[0] != '\0') {
        fprintf(out, "  %-14s %-4s " BP_HANG "%s\n", "by chance", "?", found->unknown);
    } else if (found->unseen.mean > 0) {
        fprintf(out, "  %-14s %-4s " BP_HANG, "by chance", "yes");
        bp_unseen_print(scene, &found->unseen, found->luminance,
                        effects.caustics && line->caustics == BP_CAUSTICS_OFF, out);
        fprintf(out, " At %" PRIu64 " samples per pixel that is a noise of about %s.\n", samples,
                bp_format_percent(sqrt(found->unseen.square / (double)samples) / found->luminance, noise,
                                  sizeof noise));
    } else {
        fprintf(out, "  %-14s %-4s " BP_HANG "%s\n", "by chance", "no",
                "no light that samples find by chance only: none is small, or seen or focused by glass or "
                "mirrors");
    }
    if (effects.caustics && found->unknown[0] == '\0' && line->light_sampling == BP_LIGHT_SAMPLING_ON)
        print_caustics(line, found, out);
}

/* ---- JSON --------------------------------------------------------------------------------------------- */

/* JSON has no NaN. */
static json_t *number_or_null(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}
static json_t *count_or_null(uint64_t value) {
    return value > 0 ? json_integer((json_int_t)value) : json_null();
}

static json_t *names_of(uint32_t bits) {
    json_t *names = json_array();
    for (int e = 0; e < BP_EFFECT_COUNT && names != NULL; ++e)
        if (bp_effects_has(bits, (BpEffect)e))
            json_array_append_new(names, json_string(bp_effect_name((BpEffect)e)));
    return names;
}

static json_t *costs_json(const BpCosts *costs) {
    json_t *kernels = json_array();
    for (size_t k = 0; k < costs->kernel_count && kernels != NULL; ++k) {
        const BpKernelCost *kernel = &costs->kernels[k];
        json_t *times =
            json_pack("{s:o, s:o, s:o, s:o}", "cold_seconds", number_or_null(kernel->cold_seconds),
                      "cold_processor_seconds", number_or_null(kernel->cold_processor_seconds),
                      "warm_seconds", number_or_null(kernel->warm_seconds), "warm_processor_seconds",
                      number_or_null(kernel->warm_processor_seconds));
        json_t *entry = json_pack(
            "{s:s, s:o, s:o, s:f, s:f, s:f, s:f, s:o, s:o}", "name", kernel->name, "forced",
            kernel->forced >= 0 ? json_string(bp_effect_name((BpEffect)kernel->forced)) : json_null(),
            "effects", names_of(kernel->bits), "ratio", kernel->ratio, "low", kernel->low, "high",
            kernel->high, "samples_per_second", kernel->samples_per_second, "registers",
            count_or_null(kernel->registers), "private_bytes", count_or_null(kernel->private_bytes));
        if (entry != NULL) json_object_update(entry, times);
        json_decref(times);
        json_array_append_new(kernels, entry);
    }
    return json_pack("{s:{s:o, s:o, s:o}, s:s, s:i, s:i, s:i, s:I, s:o}", "device", "platform",
                     bp_json_text(costs->device.platform), "name", bp_json_text(costs->device.name), "driver",
                     bp_json_text(costs->device.driver), "form", bp_kernel_names[costs->form], "width",
                     (int)costs->width, "height", (int)costs->height, "rounds", (int)costs->rounds, "samples",
                     (json_int_t)costs->samples, "kernels", kernels);
}

static json_t *scene_json(const char *path, const BpScene *scene, const BpEffectInfo *effects, size_t count) {
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    char reason[BP_ACCELERATION_REASON_SIZE];
    const BpAcceleration chosen = bp_acceleration_choose(scene, reason);
    json_t *list = json_array();
    for (size_t e = 0; e < count && list != NULL; ++e)
        json_array_append_new(list, json_pack("{s:s, s:s, s:b, s:s}", "name", effects[e].name, "description",
                                              effects[e].description, "simulated", effects[e].simulated,
                                              "reason", effects[e].reason));
    return json_pack("{s:o, s:s, s:I, s:I, s:I, s:I, s:o, s:s, s:s}", "scene", bp_json_text(path), "title",
                     info.title, "spheres", (json_int_t)info.spheres, "triangles", (json_int_t)info.triangles,
                     "capsules", (json_int_t)info.capsules, "materials", (json_int_t)info.materials,
                     "effects", list, "acceleration", bp_acceleration_name(chosen), "acceleration_reason",
                     reason);
}

/* ---- the command -------------------------------------------------------------------------------------- */

/* Appends the scene's entry to `list`. */
static BpStatus append_json(const BpCommandLine *line, const char *path, const BpScene *scene,
                            const Findings *found, json_t *list, BpError *err) {
    json_t *entry = scene_json(path, scene, found->effects, found->count);
    bool whole = entry != NULL;
    if (whole && (line->measure || !bp_option_given(line, BP_OPTION_PIXEL)))
        whole = json_object_set_new(entry, "unseen", bp_unseen_json(&found->unseen, found->luminance)) == 0;
    if (whole && line->measure) whole = json_object_set_new(entry, "costs", costs_json(&found->costs)) == 0;
    if (whole && bp_option_given(line, BP_OPTION_PIXEL))
        whole = json_object_set_new(entry, "path",
                                    path_json(scene, &found->path, line->pixel.x, line->pixel.y,
                                              line->first_sample,
                                              bp_chain_light_json(&found->chains, found->sampled))) == 0;
    if (whole && json_array_append(list, entry) != 0) whole = false;
    json_decref(entry);
    return whole ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for the document on %s", path);
}

/* One scene: its table on standard output, or its entry of `list` when that is not NULL. `device`: NULL where
 * nothing but the scene is needed. */
static BpStatus explain(const BpCommandLine *line, const char *path, const BpDeviceInfo *device, json_t *list,
                        BpError *err) {
    BpStatus status = BP_OK;
    BpScene *scene = NULL;
    Findings found;
    BpPage page;
    memset(&found, 0, sizeof found);
    const bool pixel = bp_option_given(line, BP_OPTION_PIXEL);
    BP_TRY(bp_setup_scene(line, path, &scene, err));
    while (found.count < BP_EFFECT_COUNT && bp_scene_effect(scene, found.count, &found.effects[found.count]))
        ++found.count;
    if (list == NULL) {
        bp_page_begin(&page, stdout);
        print_heading(path, scene, page.text);
        if (!pixel || line->measure) print_effects(scene, found.effects, found.count, page.text);
        bp_page_end(&page, line, stdout);
        fflush(stdout); /* what follows can take a while */
    }
    if (!pixel || line->measure) {
        look_for_unseen(line, scene, device, &found);
        if (list == NULL) {
            bp_page_begin(&page, stdout);
            print_unseen(line, scene, &found, page.text);
            bp_page_end(&page, line, stdout);
        }
    }
    if (pixel) {
        BP_TRY_GOTO(status, follow(line, scene, device, &found, err), done);
        if (list == NULL) {
            bp_page_begin(&page, stdout);
            print_path(scene, &found.path, line->pixel.x, line->pixel.y, line->first_sample, line->seed,
                       page.text);
            bp_chain_light_print(scene, &found.chains, found.sampled, page.text);
            bp_page_end(&page, line, stdout);
        }
    }
    if (line->measure) {
        if (list != NULL && json_array_size(list) == 0) bp_line_say_overwritten(line, line->json);
        BP_TRY_GOTO(status, measure(line, scene, device, &found.costs, err), done);
        if (list == NULL) {
            bp_page_begin(&page, stdout);
            print_costs(&found.costs, page.text);
            bp_page_end(&page, line, stdout);
        }
    }
    if (list != NULL) status = append_json(line, path, scene, &found, list, err);

done:
    bp_path_log_clear(&found.path);
    bp_chain_light_clear(&found.chains);
    bp_scene_destroy(&scene);
    return status;
}

BpStatus bp_command_explain(const BpCommandLine *line, BpError *err) {
    BpStatus status = BP_OK;
    BpDeviceInfo *devices = NULL;
    size_t device_count = 0;
    json_t *list = NULL;
    if (line->json != NULL) BP_TRY(bp_line_check_output(line, line->json, err));
    if (line->measure || bp_option_given(line, BP_OPTION_PIXEL)) {
        BP_TRY(bp_setup_devices(line, &devices, &device_count, err));
        if (device_count > 1) {
            status = bp_fail(err, BP_ERR_USAGE,
                             "--device all: ballpark explain uses one device; give its number or name");
            goto done;
        }
        BP_TRY_GOTO(status, bp_setup_self_test(line, devices, device_count, err), done);
    }
    if (line->json != NULL && (list = json_array()) == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a document");
        goto done;
    }
    for (size_t i = 0; i < line->operand_count; ++i) {
        if (list == NULL && i > 0 && !line->quiet) printf("\n");
        BP_TRY_GOTO(status, explain(line, line->operands[i], devices, list, err), done);
    }
    if (list != NULL) {
        json_t *root = json_pack("{s:O}", "scenes", list);
        if (!line->measure) bp_line_say_overwritten(line, line->json); /* else said before it took long */
        status = bp_json_write(line, root, line->json, err);
    } else if (fflush(stdout) != 0 || ferror(stdout)) {
        status = bp_fail(err, BP_ERR_FILE, "cannot write to standard output: %s", strerror(errno));
    }

done:
    json_decref(list);
    free(devices);
    return status;
}
