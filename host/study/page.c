/* page.c: the study as one HTML page: the template report.html, filled with the study and its crops; see
 * study.h. */
#include "study.h"

#include "base/json_memory.h"
#include "image/error_map.h"
#include "image/image.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *bp_study_file(const char *name); /* embedded by the build */

/* Without a "<", nothing in a script element can end it or begin another. */
static void print_json(const char *json, FILE *out) {
    for (; *json != '\0'; json++)
        if (*json == '<')
            fputs("\\u003c", out);
        else
            fputc(*json, out);
}

static bool print_study(const BpStudyResult *result, FILE *out) {
    json_t *root = bp_study_json(result);
    char *text = root != NULL && !bp_json_memory_failed() ? json_dumps(root, JSON_REAL_PRECISION(12)) : NULL;
    if (text != NULL) print_json(text, out);
    free(text);
    json_decref(root);
    return text != NULL;
}

/* ---- crops ---- */

static void print_crop(const BpStudyCrop *crop, FILE *out) {
    fputs("{\"picture\": \"", out);
    bp_base64_print(crop->picture.bytes, crop->picture.size, out);
    fputs("\", \"map\": \"", out);
    bp_base64_print(crop->map.bytes, crop->map.size, out);
    fputs("\"}", out);
}

/* The colours of the error maps, from the least error to the largest, at equal steps of its logarithm. */
static void print_scale(FILE *out) {
    enum { STEPS = 24 };
    for (int i = 0; i <= STEPS; i++) {
        uint8_t rgb[3];
        bp_error_color(BP_ERROR_MAP_LEAST * pow(BP_ERROR_MAP_MOST / BP_ERROR_MAP_LEAST, i / (double)STEPS),
                       rgb);
        fprintf(out, "%s\"#%02x%02x%02x\"", i == 0 ? "" : ", ", rgb[0], rgb[1], rgb[2]);
    }
}

/* Crops of the truth, of every count of the base, and of every other configuration at the largest count. */
static void print_crops(const BpStudyResult *result, FILE *out) {
    const BpStudySeries *base = &result->series[0];
    fprintf(out, "{\"width\": %" PRIu32 ", \"height\": %" PRIu32 ", \"scale\": [", result->crop_width,
            result->crop_height);
    print_scale(out);
    fputs("], \"truth\": ", out);
    print_crop(&result->truth, out);
    fputs(", \"counts\": [", out);
    for (size_t i = 0; i < base->count; i++) {
        fputs(i == 0 ? "" : ", ", out);
        print_crop(&base->points[i].crop, out);
    }
    fputs("], \"others\": [", out);
    for (size_t s = 1; s < result->count; s++) {
        fputs(s == 1 ? "" : ", ", out);
        print_crop(&result->series[s].points[result->series[s].count - 1].crop, out);
    }
    fputs("]}", out);
}

/* ---- the page ---- */

/* Writes the template up to the mark; returns what follows the mark. */
static const char *print_until(const char *text, const char *mark, FILE *out) {
    const char *at = strstr(text, mark);
    if (at == NULL)
        return text; /* the template is part of the build: a test sees that both marks are there */
    fwrite(text, 1, (size_t)(at - text), out);
    return at + strlen(mark);
}

bool bp_study_print_page(const BpStudyResult *result, FILE *out) {
    const char *rest = print_until(bp_study_file("report.html"), "{{study}}", out);
    if (!print_study(result, out)) return false;
    rest = print_until(rest, "{{crops}}", out);
    print_crops(result, out);
    fputs(rest, out);
    return fflush(out) == 0 && !ferror(out);
}
