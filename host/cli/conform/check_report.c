/* check_report.c: see check_report.h. */
#include "check_report.h"

#include "base/escape.h"
#include "base/json_text.h"
#include "base/names.h"
#include "cli/output/json_file.h"
#include "render/render_plan.h"

#include <math.h>
#include <string.h>

json_t *bp_check_scene_json(const char *name, const BpScene *scene, const BpRenderOptions *options) {
    return json_pack(
        "{s:o, s:s, s:s, s:i, s:i, s:I, s:i, s:o, s:I, s:I, s:I, s:[]}", "scene", bp_json_text(name),
        BP_CHECK_SAMPLING, bp_light_sampling_names[bp_render_light_sampling(scene, options)],
        BP_CHECK_CAUSTICS, bp_caustics_names[bp_render_caustics(scene, options)], "width",
        (int)scene->camera.width, "height", (int)scene->camera.height, "samples_per_pixel",
        (json_int_t)options->samples_per_pixel, "max_depth", (int)options->max_depth, "seed",
        bp_json_whole(options->seed), "spheres", (json_int_t)scene->sphere_count, "triangles",
        (json_int_t)scene->triangle_count, "capsules", (json_int_t)scene->capsule_count, "results");
}

void bp_check_count_all(const json_t *scenes, BpCheckCounts *counts) {
    size_t s, r;
    json_t *scene, *entry;
    json_array_foreach(scenes, s, scene) {
        json_array_foreach(json_object_get(scene, "results"), r, entry) {
            bp_check_count(entry, counts);
        }
    }
}

json_t *bp_check_document(json_t *scenes, json_t *broken, const char *suite, double level) {
    BpCheckCounts counts = {0};
    bp_check_count_all(scenes, &counts);
    json_t *document = json_pack("{s:s}", "ballpark", bp_version());
    int failed = document == NULL;
    if (suite != NULL) {
        failed |= json_object_set_new(document, "suite", json_string(suite));
        failed |= json_object_set_new(document, "level", json_real(level));
        failed |= json_object_set(document, "scenes", scenes);
    } else {
        failed |= json_object_update(document, json_array_get(scenes, 0));
        if (json_array_size(scenes) > 1) failed |= json_object_set(document, "scenes", scenes);
    }
    failed |= json_object_set_new(document, "verdict", json_string(bp_check_overall(&counts)));
    failed |= json_object_set(document, "broken_drivers", broken);
    json_decref(scenes);
    json_decref(broken);
    if (!failed) return document;
    json_decref(document);
    return NULL;
}

json_t *bp_check_document_scenes(const json_t *document) {
    json_t *scenes = json_object_get(document, "scenes");
    if (json_is_array(scenes)) return json_incref(scenes);
    if (!json_is_array(json_object_get(document, "results"))) return NULL;
    scenes = json_array();
    if (scenes == NULL) return NULL;
    json_t *copy = json_copy((json_t *)(uintptr_t)document); /* shallow; jansson's argument is not const */
    if (json_array_append_new(scenes, copy) == 0) return scenes;
    json_decref(scenes);
    return NULL;
}

static void print_row(const json_t *entry, const char *name, FILE *out) {
    const char *verdict = bp_check_text(entry, "verdict");
    const bool agrees = json_is_true(json_object_get(entry, "agree"));
    fprintf(out, "  %-13s ",
            agrees                                 ? "agree"
            : strcmp(verdict, "disagree") == 0     ? "DISAGREE"
            : strcmp(verdict, "inconclusive") == 0 ? "INCONCLUSIVE"
                                                   : "FAILED");
    const json_t *brightness = json_object_get(entry, "brightness");
    const json_t *ratio = json_object_get(brightness, "ratio");
    const json_t *within = json_object_get(brightness, "shown_within");
    if (json_is_real(ratio))
        fprintf(out, "%.6f ", json_real_value(ratio));
    else
        fprintf(out, "%8s ", "-");
    double worst = 0;
    size_t index;
    json_t *test;
    json_array_foreach(json_object_get(entry, "tests"), index, test) {
        worst = fmax(worst, json_real_value(json_object_get(test, "z")) /
                                json_real_value(json_object_get(test, "limit")));
    }
    if (json_object_get(entry, "tests") != NULL)
        fprintf(out, "%9.2f ", worst);
    else
        fprintf(out, "%9s ", "-");
    if (json_is_real(within))
        fprintf(out, "%7.3g %%  ", 100 * json_real_value(within));
    else
        fprintf(out, "%9s  ", "-");
    bp_print_escaped(name, false, out);
    fputc('\n', out);
    if (agrees) return;
    fputs("                ", out);
    bp_print_escaped(bp_check_text(entry, "reason"), false, out);
    fputc('\n', out);
}

static void print_head(const char *last, FILE *out) {
    fprintf(out, "  verdict          ratio |z|/limit    within  %s\n", last);
}

void bp_check_print_table(const json_t *scenes, bool quiet, FILE *out) {
    const size_t count = json_array_size(scenes);
    const json_t *first = json_object_get(json_array_get(scenes, 0), "results");
    const size_t devices = json_array_size(first);
    char title[700], name[BP_CHECK_LABEL_SIZE];
    if (count == 1 && !quiet) print_head("device", out);
    for (size_t d = 0; d < devices; ++d) {
        const json_t *entry = json_array_get(first, d);
        const int number =
            (int)json_integer_value(json_object_get(json_object_get(entry, "device"), "number"));
        snprintf(name, sizeof name, "%d: %s", number, bp_check_device_title(entry, title, sizeof title));
        if (count == 1) {
            if (!quiet || !json_is_true(json_object_get(entry, "agree"))) print_row(entry, name, out);
            continue;
        }
        BpCheckCounts counts = {0};
        fprintf(out, "device %s\n", name);
        if (!quiet) print_head("scene", out);
        for (size_t s = 0; s < count; ++s) {
            const json_t *scene = json_array_get(scenes, s);
            entry = json_array_get(json_object_get(scene, "results"), d);
            bp_check_count(entry, &counts);
            if (!quiet || !json_is_true(json_object_get(entry, "agree")))
                print_row(entry, bp_check_label(scene, name, sizeof name), out);
        }
        fprintf(out, "  %zu checks: %u agree, %u disagree, %u inconclusive, %u failed\n", count, counts.agree,
                counts.disagree, counts.inconclusive, counts.failed);
    }
}
