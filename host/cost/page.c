/* page.c: the study as one HTML page: its frame, the advice, the method; see page.h. */
#include "page.h"

#include "format.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

void bp_page_text(FILE *out, const char *text) {
    for (; *text != '\0'; text++) {
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            fputc(*text, out);
        }
    }
}

void bp_page_data(FILE *out, const char *key, double value) {
    if (isfinite(value))
        fprintf(out, " data-%s=\"%.12g\"", key, value);
    else
        fprintf(out, " data-%s=\"\"", key);
}

void bp_page_options(FILE *out, const char *options) {
    while (*options != '\0') {
        const char *next = strstr(options + 1, " --");
        const size_t length = next != NULL ? (size_t)(next - options) : strlen(options);
        fprintf(out, "<code>%.*s</code> ", (int)length, options);
        options += next != NULL ? length + 1 : length;
    }
}

static const char *base_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static const char *title_of(const BpScene *scene) {
    BpSceneInfo info;
    bp_scene_info(scene, &info);
    return info.title[0] != '\0' ? info.title : base_name(scene->path);
}

static void print_header(const BpStudyResult *result, FILE *out) {
    const BpScene *scene = result->scene;
    const BpDeviceInfo *device = &result->report.device;
    fputs("<header>\n<h1>What accuracy costs</h1>\n<p class=\"lead\">", out);
    bp_page_text(out, title_of(scene));
    fputs("</p>\n<p class=\"facts\"><span>", out);
    bp_page_text(out, base_name(scene->path));
    fprintf(out, " at %u × %u pixels</span> <span>", scene->camera.width, scene->camera.height);
    bp_page_text(out, device->name);
    fputs("</span> <span>", out);
    bp_page_text(out, device->platform);
    fputs(", driver ", out);
    bp_page_text(out, device->driver);
    fputs("</span> <span>Ballpark ", out);
    bp_page_text(out, bp_version());
    fputs("</span></p>\n</header>\n", out);
}

static void print_card(const BpStudyResult *result, const BpStudyAdvice *advice, FILE *out) {
    char seconds[32];
    const BpStudySetting *setting = &result->series[advice->series].setting;
    fputs("<div class=\"card\"", out);
    bp_page_data(out, "target", advice->target);
    bp_page_data(out, "samples", advice->samples);
    bp_page_data(out, "seconds", advice->seconds);
    fprintf(out, ">\n<p class=\"target\">%g&nbsp;%% error</p>\n", 100 * advice->target);
    if (!advice->reachable) {
        fputs("<p class=\"price\">out of reach</p>\n<p>Every way has more bias than that.</p>\n</div>\n",
              out);
        return;
    }
    fprintf(out, "<p class=\"price\">%s</p>\n<p>",
            bp_study_seconds(advice->seconds, seconds, sizeof seconds));
    fprintf(out, "<b>%s</b>, %.0f %s a pixel</p>\n<code>--spp %.0f</code> ", setting->name, advice->samples,
            advice->samples > 1 ? "samples" : "sample", advice->samples);
    bp_page_options(out, setting->command);
    if (setting->fresnel != BP_STUDY_FRESNEL_SCENE)
        fprintf(out, "<p class=\"note\">and <code>\"fresnel\": \"%s\"</code> in the scene</p>\n",
                bp_study_fresnel_name(setting->fresnel));
    fputs("</div>\n", out);
}

static void print_advice(const BpStudyResult *result, FILE *out) {
    fputs("<section id=\"advice\">\n<h2>What to use</h2>\n<div class=\"cards\">\n", out);
    for (int t = 0; t < BP_STUDY_TARGETS; t++) print_card(result, &result->advice[t], out);
    fprintf(out,
            "</div>\n<p class=\"note\">The soonest way to each error, and the time to trace a picture of "
            "%u × %u pixels on this device when it does nothing else.</p>\n</section>\n",
            result->full_width, result->full_height);
}

static void print_method(const BpStudyResult *result, FILE *out) {
    char error[32], seconds[32];
    fprintf(out,
            "<section id=\"method\">\n<h2>How it was measured</h2>\n"
            "<p><b>The truth</b> is the scene with exact Fresnel and depth %u, %s: two pictures with random "
            "numbers of their own, %" PRIu64 " samples a pixel each, whose mean is known to %s. "
            "The squared error of a picture x is the mean of (x − r₁)(x − r₂) over pixels, in luminance: the "
            "noise of "
            "the references cancels. Where it is lost in what remains, the error is a dash.</p>\n",
            BP_STUDY_DEPTH,
            result->reference_is_kernel ? "rendered in double precision with strict math"
                                        : "from the reference tracer, since this device has no double",
            result->reference_samples, bp_study_percent(result->reference_error, error, sizeof error));
    fprintf(
        out,
        "<p><b>Error</b> is the root of that over the mean brightness (NRMSE): noise and bias together. "
        "<b>Noise</b> is what the picture's own error bar says. <b>Bias</b> and change are differences of "
        "mean brightness between two pictures of the same random numbers, so that most noise cancels; "
        "the intervals hold in 95 %% of cases. <b>Floor</b> and slope fit error² = floor² + V / N to the "
        "counts measured; the error of Sobol samples falls faster than that, so their fitted floor comes out "
        "low, and "
        "the bias of a pixel, measured by pairs, is the better figure. <b>Efficiency</b> is 1 / (noise² × "
        "time), over that of “%s”.</p>\n",
        result->series[0].setting.name);
    fprintf(out,
            "<p><b>Time</b> is that of tracing, without builds, all ways taking turns. On a CPU it is the "
            "processor time over the number of cores, unless the clock on the wall says less: other work on "
            "the machine changes little. The whole study took %s%s.</p>\n</section>\n",
            bp_study_seconds(result->seconds, seconds, sizeof seconds),
            result->cut_short ? "; it was ended early" : "");
}

bool bp_study_print_page(const BpStudyResult *result, FILE *out) {
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta name=\"color-scheme\" content=\"light dark\">\n<title>What accuracy costs: ",
          out);
    bp_page_text(out, title_of(result->scene));
    /* An icon of its own, so that no browser looks for one. */
    fputs("</title>\n<link rel=\"icon\" href=\"data:,\">\n<style>\n", out);
    for (size_t i = 0; bp_page_style[i] != NULL; i++) fputs(bp_page_style[i], out);
    fputs("</style>\n</head>\n<body>\n<main>\n", out);
    print_header(result, out);
    print_advice(result, out);
    bp_page_front(result, out);
    bp_page_bars(result, out);
    bp_page_strips(result, out);
    bp_page_tables(result, out);
    print_method(result, out);
    fputs("</main>\n</body>\n</html>\n", out);
    return fflush(out) == 0 && !ferror(out);
}
