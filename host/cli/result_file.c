/* result_file.c: see result_file.h. */
#include "result_file.h"

#include "file_conflicts.h"

#include "base/format.h"
#include "base/output_file.h"
#include "film/film_file.h"
#include "image/color_bar.h"
#include "image/error_map.h"
#include "image/image.h"
#include "json_file.h"
#include "keep_sums.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *format_ending(BpFormat format) {
    switch (format) {
    case BP_FORMAT_PNG:
        return ".png";
    case BP_FORMAT_PPM:
    case BP_FORMAT_PPM_ASCII:
        return ".ppm";
    case BP_FORMAT_PFM:
        return ".pfm";
    case BP_FORMAT_EXR:
        return ".exr";
    case BP_FORMAT_BPA:
        return ".bpa";
    }
    return "";
}

/* The last part of `path` with another ending, in the current folder. */
static BpStatus default_name(const char *path, BpFormat format, BpResultFile *result, BpError *err) {
    const char *base = strrchr(path, '/');
    base = base == NULL ? path : base + 1;
    int stem = (int)strlen(base);
    if (stem > 3 && strcmp(base + stem - 3, ".gz") == 0) stem -= 3; /* protein.pdb.gz becomes protein.png */
    for (int i = stem - 1; i > 0; i--) {
        if (base[i] != '.') continue;
        stem = i;
        break;
    }
    const int length =
        snprintf(result->path, sizeof result->path, "%.*s%s", stem, base, format_ending(format));
    if (length >= (int)sizeof result->path)
        return bp_fail(err, BP_ERR_FILE, "the name %.200s... is too long", base);
    return BP_OK;
}

static BpStatus choose_output(const BpCommandLine *line, const char *default_path, BpResultFile *result,
                              BpError *err) {
    const bool has_format = bp_option_given(line, BP_OPTION_FORMAT);
    result->format = has_format ? line->format : BP_FORMAT_PNG;
    if (line->output == NULL && strcmp(default_path, "-") == 0)
        return bp_fail(
            err, BP_ERR_USAGE,
            "a scene from standard input has no name for the picture; give one with --output FILE");
    if (line->output == NULL) {
        BP_TRY(default_name(default_path, result->format, result, err));
        BP_TRY(bp_file_conflicts_check(line, result->path, err));
        return bp_output_check(result->path, err);
    }
    const size_t length = strlen(line->output);
    if (length >= sizeof result->path)
        return bp_fail(err, BP_ERR_FILE, "the path after --output is too long");
    memcpy(result->path, line->output, length + 1);
    if (strcmp(line->output, "-") == 0) {
        if (isatty(STDOUT_FILENO) && result->format != BP_FORMAT_PPM_ASCII)
            return bp_fail(err, BP_ERR_USAGE,
                           "--output -: refusing to write a picture to the terminal; redirect standard "
                           "output to a file or a pipe");
        return BP_OK;
    }
    if (!has_format && !bp_format_from_path(line->output, &result->format))
        return bp_fail(
            err, BP_ERR_USAGE,
            "--output %.400s: unknown ending; use .png, .ppm, .pfm, .exr or .bpa, or give --format",
            line->output);
    return bp_output_check(result->path, err);
}

BpStatus bp_result_choose(const BpCommandLine *line, const char *default_path, BpResultFile *result,
                          BpError *err) {
    BP_TRY(choose_output(line, default_path, result, err));
    if (line->stats != NULL) BP_TRY(bp_json_check(line->stats, err));
    if (line->error_map != NULL) {
        BpFormat format;
        if (!bp_format_from_path(line->error_map, &format) || format != BP_FORMAT_PNG)
            return bp_fail(err, BP_ERR_USAGE, "--error-map %.400s: expected a name that ends in .png",
                           line->error_map);
        BP_TRY(bp_output_check(line->error_map, err));
    }
    return BP_OK;
}

BpStatus bp_result_write(const BpCommandLine *line, const BpResultFile *result, const BpFilm *film,
                         bool rendered, BpTransfer transfer, const BpLegend *legend, BpError *err) {
    BpStatus status = BP_OK;
    BpPicture picture = {0};
    const bool to_stream = strcmp(result->path, "-") == 0;
    const bool is_picture = result->format != BP_FORMAT_BPA;
    if (bp_option_given(line, BP_OPTION_TRANSFER)) transfer = line->transfer;
    if (is_picture || line->error_map != NULL)
        BP_TRY_GOTO(status, bp_film_picture(film, &picture, err), done);
    const bool bytes = result->format == BP_FORMAT_PNG || result->format == BP_FORMAT_PPM ||
                       result->format == BP_FORMAT_PPM_ASCII;
    if (status == BP_OK && legend != NULL && legend->shown && bytes)
        status = bp_color_bar_draw(&picture, transfer, (const float(*)[3])legend->colors, legend->range,
                                   legend->title, err);
    if (status != BP_OK) goto done;
    if (is_picture && to_stream)
        status = bp_picture_write_stream(&picture, stdout, result->format, transfer, err);
    else if (is_picture)
        status = bp_picture_write(&picture, result->path, result->format, transfer, err);
    else if (to_stream)
        status = bp_film_write_stream(film, stdout, err);
    else
        status = bp_film_write(film, result->path, err);
done:
    if (status != BP_OK && rendered) bp_keep_sums(film, result->path, err);
    if (status == BP_OK && line->error_map != NULL)
        status = bp_error_map_write(&picture, line->error_map, err);
    bp_picture_clear(&picture);
    return status;
}

const char *bp_result_name(const BpResultFile *result) {
    return strcmp(result->path, "-") == 0 ? "standard output" : result->path;
}

void bp_result_warn(const BpFilm *film) {
    const double off = bp_film_rounding(film);
    char text[32];
    if (isinf(off))
        fprintf(stderr,
                "warning: the picture is black because its light is more than 10^17 times dimmer than the "
                "brightest path, too dim for the sums to hold; dim or remove the brightest lamp\n");
    else if (off > BP_ROUNDING_MAX)
        fprintf(stderr,
                "warning: rounding may have changed the picture by %s, because its light is so much dimmer "
                "than the brightest path; dim or remove the brightest lamp\n",
                bp_format_percent(off, text, sizeof text));
    if (film->unverified)
        fprintf(stderr, "warning: a .bpa file of version 1 has no checksum, so damage cannot be detected; "
                        "render its samples again if in doubt\n");
}
