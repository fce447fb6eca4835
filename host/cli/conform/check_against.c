/* check_against.c: see check_against.h. */
#include "check_against.h"

#include "base/escape.h"
#include "base/input_file.h"
#include "base/json_memory.h"
#include "base/json_text.h"
#include "check_report.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

BpStatus bp_check_against_read(const char *path, json_t **document, BpError *err) {
    json_error_t fault;
    *document = NULL;
    FILE *in = fopen(path, "rb");
    if (in == NULL) {
        const BpStatus status =
            bp_fail(err, BP_ERR_FILE, "--against %s: cannot open it: %s", path, strerror(errno));
        return status;
    }
    char *text = NULL;
    size_t length = 0;
    bool no_memory = false;
    const BpStatus read = bp_stream_read(in, 0, path, &text, &length, err);
    fclose(in);
    if (read != BP_OK) return read;
    json_t *found = bp_json_load(text, length, JSON_REJECT_DUPLICATES, &fault, &no_memory);
    free(text);
    if (no_memory) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the document of --against");
    if (found == NULL) {
        const BpStatus status = bp_fail(err, BP_ERR_USAGE, "--against: no JSON: %s", fault.text);
        bp_error_at(err, path, fault.line, fault.column);
        return status;
    }
    json_t *scenes = bp_check_document_scenes(found);
    const bool whole =
        json_is_array(scenes) && json_is_string(json_object_get(json_array_get(scenes, 0), "scene"));
    json_decref(scenes);
    if (whole) {
        *document = found;
        return BP_OK;
    }
    json_decref(found);
    if (bp_json_memory_failed())
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the document of --against");
    return bp_fail(err, BP_ERR_USAGE,
                   "--against %s: expected the JSON document of an earlier `ballpark check`", path);
}

/* ---- which is which ----------------------------------------------------------------------------------- */

static bool same_device(const json_t *one, const json_t *other) {
    return strcmp(bp_check_device_text(one, "platform"), bp_check_device_text(other, "platform")) == 0 &&
           strcmp(bp_check_device_text(one, "name"), bp_check_device_text(other, "name")) == 0;
}

/* The entry in `results` of the same device as entry `index` of `own`; equal devices match in order. NULL:
 * there is none. */
static const json_t *counterpart(const json_t *own, size_t index, const json_t *results) {
    const json_t *entry = json_array_get(own, index);
    size_t before = 0;
    for (size_t i = 0; i < index; ++i) before += same_device(json_array_get(own, i), entry);
    for (size_t i = 0; i < json_array_size(results); ++i) {
        const json_t *other = json_array_get(results, i);
        if (same_device(entry, other) && before-- == 0) return other;
    }
    return NULL;
}

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* Documents older than "light_sampling" have one check per scene, and those older than "caustics" none with
 * that. */
static bool sampled_alike(const json_t *one, const json_t *other) {
    static const char *const off = "off";
    const char *a = bp_check_text(one, BP_CHECK_SAMPLING), *b = bp_check_text(other, BP_CHECK_SAMPLING);
    const char *c = bp_check_text(one, BP_CHECK_CAUSTICS), *d = bp_check_text(other, BP_CHECK_CAUSTICS);
    if (strcmp(c[0] != '\0' ? c : off, d[0] != '\0' ? d : off) != 0) return false;
    return a[0] == '\0' || b[0] == '\0' || strcmp(a, b) == 0;
}

/* The same check: of the scene of that name; else of that file name, as folders move. */
static const json_t *find_scene(const json_t *scenes, const json_t *wanted) {
    const char *name = bp_check_text(wanted, "scene");
    const json_t *found = NULL;
    for (size_t i = 0; i < json_array_size(scenes); ++i) {
        const json_t *scene = json_array_get(scenes, i);
        const char *other = bp_check_text(scene, "scene");
        if (!sampled_alike(scene, wanted)) continue;
        if (strcmp(other, name) == 0) return scene;
        if (found == NULL && strcmp(file_name(other), file_name(name)) == 0) found = scene;
    }
    return found;
}

/* ---- changes ------------------------------------------------------------------------------------------ */

typedef struct Changes {
    json_t *list;
    unsigned regressions;
    int failed; /* memory */
} Changes;

static void add(Changes *changes, const char *kind, const char *scene, const json_t *entry, const char *was,
                const char *now) {
    char title[700];
    json_t *change =
        json_pack("{s:s, s:s, s:o, s:s, s:s}", "kind", kind, "scene", scene, "device",
                  bp_json_text(bp_check_device_title(entry, title, sizeof title)), "was", was, "now", now);
    changes->failed |= json_array_append_new(changes->list, change);
}

static bool agrees(const json_t *entry) {
    return json_is_true(json_object_get(entry, "agree"));
}

/* Documents older than "verdict" have only "agree". */
static const char *verdict_of(const json_t *entry) {
    const char *verdict = bp_check_text(entry, "verdict");
    if (verdict[0] != '\0') return verdict;
    return agrees(entry) ? "agree" : json_object_get(entry, "error") != NULL ? "failed" : "disagree";
}

static void compare_settings(Changes *changes, const json_t *scene, const json_t *old_scene,
                             const json_t *entry, const json_t *old) {
    static const char *const members[] = {"width", "height",  "samples_per_pixel", "max_depth",
                                          "seed",  "spheres", "triangles",         "capsules"};
    char name[BP_CHECK_LABEL_SIZE];
    bp_check_label(scene, name, sizeof name);
    for (size_t m = 0; m < sizeof members / sizeof *members; ++m) {
        const json_t *now = json_object_get(scene, members[m]), *was = json_object_get(old_scene, members[m]);
        if (now == NULL || was == NULL || json_equal(now, was)) continue;
        char now_text[64], was_text[64];
        char *now_value = json_dumps(now, JSON_ENCODE_ANY), *was_value = json_dumps(was, JSON_ENCODE_ANY);
        snprintf(now_text, sizeof now_text, "%s %.30s", members[m], now_value != NULL ? now_value : "?");
        snprintf(was_text, sizeof was_text, "%s %.30s", members[m], was_value != NULL ? was_value : "?");
        free(now_value);
        free(was_value);
        add(changes, "settings", name, entry, was_text, now_text);
    }
    const json_t *now = json_object_get(entry, "settings"), *was = json_object_get(old, "settings");
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)now, key, value) {
        const json_t *before = json_object_get(was, key);
        if (json_is_string(value) && json_is_string(before) && !json_equal(value, before))
            add(changes, "settings", name, entry, json_string_value(before), json_string_value(value));
    }
}

static void compare_entry(Changes *changes, const json_t *scene, const json_t *old_scene, const json_t *entry,
                          const json_t *old) {
    char name[BP_CHECK_LABEL_SIZE];
    const char *was = verdict_of(old), *now = verdict_of(entry);
    compare_settings(changes, scene, old_scene, entry, old);
    if (strcmp(was, now) == 0) return;
    const bool regressed = agrees(old) && !agrees(entry);
    changes->regressions += regressed;
    add(changes,
        regressed       ? "regression"
        : agrees(entry) ? "recovered"
                        : "verdict",
        bp_check_label(scene, name, sizeof name), entry, was, now);
}

static void compare_driver(Changes *changes, const json_t *entry, const json_t *old) {
    const char *was = bp_check_device_text(old, "driver"), *now = bp_check_device_text(entry, "driver");
    if (strcmp(was, now) != 0) add(changes, "driver", "", entry, was, now);
    was = bp_check_device_text(old, "version");
    now = bp_check_device_text(entry, "version");
    if (strcmp(was, now) != 0) add(changes, "driver", "", entry, was, now);
}

/* Devices of the earlier check of `old_scene` that this one lacks. */
static void find_gone(Changes *changes, const json_t *scene, const json_t *old_scene, bool first) {
    const json_t *results = json_object_get(scene, "results"), *old = json_object_get(old_scene, "results");
    for (size_t d = 0; d < json_array_size(old); ++d) {
        const json_t *entry = json_array_get(old, d);
        if (counterpart(old, d, results) != NULL) continue;
        changes->regressions += agrees(entry);
        if (first) add(changes, "gone", "", entry, verdict_of(entry), "");
    }
}

json_t *bp_check_against(const json_t *scenes, const json_t *earlier, const char *path, bool all) {
    json_t *old_scenes = bp_check_document_scenes(earlier), *scene;
    Changes changes = {.list = json_array()};
    size_t index;
    bool first = true;
    json_array_foreach(scenes, index, scene) {
        char name[BP_CHECK_LABEL_SIZE];
        const json_t *old_scene = find_scene(old_scenes, scene);
        bp_check_label(scene, name, sizeof name);
        const json_t *results = json_object_get(scene, "results"),
                     *old = json_object_get(old_scene, "results");
        for (size_t d = 0; d < json_array_size(results); ++d) {
            const json_t *entry = json_array_get(results, d), *before = counterpart(results, d, old);
            if (before == NULL) {
                if (first || old_scene == NULL) add(&changes, "new", name, entry, "", verdict_of(entry));
                continue;
            }
            if (first) compare_driver(&changes, entry, before);
            compare_entry(&changes, scene, old_scene, entry, before);
        }
        if (old_scene == NULL) continue;
        if (all) find_gone(&changes, scene, old_scene, first);
        first = false;
    }
    json_decref(old_scenes);
    json_t *against = json_pack("{s:o, s:s, s:i, s:o}", "file", bp_json_text(path), "ballpark",
                                bp_check_text(earlier, "ballpark"), "regressions", (int)changes.regressions,
                                "changes", changes.list);
    /* Out of memory, the list of earlier scenes may be incomplete. */
    if (!changes.failed && !bp_json_memory_failed()) return against;
    json_decref(against);
    return NULL;
}

size_t bp_check_against_gone(const json_t *against) {
    size_t count = 0, index;
    json_t *change;
    json_array_foreach(json_object_get(against, "changes"), index, change) {
        count += strcmp(bp_check_text(change, "kind"), "gone") == 0;
    }
    return count;
}

void bp_check_against_print(const json_t *against, FILE *out) {
    const json_t *changes = json_object_get(against, "changes");
    size_t index;
    json_t *change;
    fputs("against ", out);
    bp_print_escaped(bp_check_text(against, "file"), false, out);
    fputs(":\n", out);
    json_array_foreach(changes, index, change) {
        const char *kind = bp_check_text(change, "kind"), *was = bp_check_text(change, "was");
        const char *now = bp_check_text(change, "now"), *scene = bp_check_text(change, "scene");
        fprintf(out, "  %-10s  ", strcmp(kind, "regression") == 0 ? "REGRESSION" : kind);
        if (was[0] != '\0') bp_print_escaped(was, false, out);
        if (was[0] != '\0' && now[0] != '\0') fputs(" -> ", out);
        if (now[0] != '\0') bp_print_escaped(now, false, out);
        fputs(": ", out);
        if (scene[0] != '\0') {
            bp_print_escaped(scene, false, out);
            fputs(" on ", out);
        }
        bp_print_escaped(bp_check_text(change, "device"), false, out);
        fputc('\n', out);
    }
    const int regressions = (int)json_integer_value(json_object_get(against, "regressions"));
    if (json_array_size(changes) == 0)
        fputs("  nothing has changed\n", out);
    else
        fprintf(out, "  %d regression%s\n", regressions, regressions == 1 ? "" : "s");
}
