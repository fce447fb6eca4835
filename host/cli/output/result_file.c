/* result_file.c: see result_file.h. */
#include "result_file.h"

#include "cli/line/command_text.h"
#include "cli/line/file_conflicts.h"

#include "base/format.h"
#include "base/json_text.h"
#include "cli/terminal/page.h"
#include "content.h"
#include "figure/draw.h"
#include "film/film_file.h"
#include "image/depth_cues.h"
#include "image/error_map.h"
#include "image/image.h"
#include "keep_sums.h"
#include "output.h"

#include <inttypes.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
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
    case BP_FORMAT_PDF:
        return ".pdf";
    case BP_FORMAT_SVG:
        return ".svg";
    }
    return "";
}

/* The last part of `source`, without its ending, and `ending`: in `folder`, or in the current one ("").
 */
static BpStatus name_after(const char *source, const char *folder, const char *ending, char path[4096],
                           BpError *err) {
    const char *base = strrchr(source, '/');
    base = base == NULL ? source : base + 1;
    int stem = (int)strlen(base);
    if (stem > 3 && strcmp(base + stem - 3, ".gz") == 0) stem -= 3; /* protein.pdb.gz becomes protein.png */
    for (int i = stem - 1; i > 0; i--) {
        if (base[i] != '.') continue;
        stem = i;
        break;
    }
    const size_t end = strlen(folder);
    const char *slash = end == 0 || folder[end - 1] == '/' ? "" : "/";
    const int length = snprintf(path, 4096, "%s%s%.*s%s", folder, slash, stem, base, ending);
    if (length >= 4096) return bp_fail(err, BP_ERR_FILE, "the name %.200s... is too long", base);
    return BP_OK;
}

static bool renders(const BpCommandLine *line) {
    return line->command->bit == BP_RENDER;
}

bool bp_result_is_folder(const char *path) {
    struct stat info;
    const size_t length = strlen(path);
    return (length > 0 && path[length - 1] == '/') || (stat(path, &info) == 0 && S_ISDIR(info.st_mode));
}

/* Whether the option names a folder, for files that are named after their scenes; several scenes need one. */
static BpStatus find_folder(const BpCommandLine *line, const char *option, const char *path, bool *folder,
                            BpError *err) {
    *folder = renders(line) && bp_result_is_folder(path);
    if (*folder || !renders(line) || line->operand_count < 2) return BP_OK;
    return bp_fail(err, BP_ERR_USAGE,
                   "%s %.400s: %zu scenes need a file each; name a folder that exists, or leave %s out",
                   option, path, line->operand_count, option);
}

static BpStatus choose_output(const BpCommandLine *line, const char *source, BpResultFile *result,
                              BpError *err) {
    const bool has_format = bp_option_given(line, BP_OPTION_FORMAT);
    bool folder = false;
    result->is_own = false;
    result->format = has_format ? line->format : BP_FORMAT_PNG;
    if (line->output != NULL) BP_TRY(find_folder(line, "--output", line->output, &folder, err));
    if ((line->output == NULL || folder) && strcmp(source, "-") == 0)
        return bp_fail(
            err, BP_ERR_USAGE,
            "a scene from standard input has no name for the picture; give one with --output FILE");
    if (line->output == NULL || folder)
        return name_after(source, folder ? line->output : "", format_ending(result->format), result->path,
                          err);
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
        return bp_fail(err, BP_ERR_USAGE,
                       "--output %.400s: unknown ending; use .png, .pdf, .svg, .ppm, .pfm, .exr or .bpa, or "
                       "give --format",
                       line->output);
    return BP_OK;
}

static BpStatus choose_error_map(const BpCommandLine *line, const char *source, BpResultFile *result,
                                 BpError *err) {
    BpFormat format;
    bool folder = false;
    result->error_map[0] = '\0';
    if (line->error_map == NULL) return BP_OK;
    BP_TRY(find_folder(line, "--error-map", line->error_map, &folder, err));
    if (folder) return name_after(source, line->error_map, "-error.png", result->error_map, err);
    if (!bp_format_from_path(line->error_map, &format) || format != BP_FORMAT_PNG)
        return bp_fail(err, BP_ERR_USAGE, "--error-map %.400s: expected a name that ends in .png",
                       line->error_map);
    const int length = snprintf(result->error_map, sizeof result->error_map, "%s", line->error_map);
    if (length < (int)sizeof result->error_map) return BP_OK;
    return bp_fail(err, BP_ERR_FILE, "the path after --error-map is too long");
}

/* Of vectors, with the picture as an image among them. */
static bool is_vector(BpFormat format) {
    return format == BP_FORMAT_PDF || format == BP_FORMAT_SVG;
}

/* By a transfer curve, as a screen shows it. */
static bool is_encoded(BpFormat format) {
    return format == BP_FORMAT_PNG || format == BP_FORMAT_PPM || format == BP_FORMAT_PPM_ASCII ||
           is_vector(format);
}

/* Refuses options that the chosen format cannot hold. */
static BpStatus check_figure(const BpCommandLine *line, BpFormat format, BpError *err) {
    const bool png = format == BP_FORMAT_PNG, noted = png || format == BP_FORMAT_EXR;
    if (!noted && !is_vector(format) && bp_option_given(line, BP_OPTION_DPI))
        return bp_fail(err, BP_ERR_USAGE, "--dpi: PNG, EXR, PDF and SVG can record a resolution, %s cannot",
                       bp_format_names[format]);
    if (!noted && line->metadata)
        return bp_fail(err, BP_ERR_USAGE, "--metadata can be recorded in PNG and EXR pictures, not in %s",
                       bp_format_names[format]);
    if (format == BP_FORMAT_BPA && bp_result_has_cues(line))
        return bp_fail(
            err, BP_ERR_USAGE,
            "--outlines and --depth-fog are drawn into pictures, and a .bpa file holds sums; give them to "
            "`ballpark merge`, which makes the picture");
    if (bp_option_given(line, BP_OPTION_EXPOSURE) && !is_encoded(format))
        return bp_fail(err, BP_ERR_USAGE,
                       "--exposure applies to PNG, PDF, SVG and PPM pictures, and this one is %s, which "
                       "keeps the radiance "
                       "as it is",
                       bp_format_names[format]);
    if (!png && line->bit_depth != NULL)
        return bp_fail(err, BP_ERR_USAGE, "--bit-depth applies to PNG pictures, and this one is %s",
                       bp_format_names[format]);
    return BP_OK;
}

BpCommandLine bp_result_line(const BpCommandLine *line, const BpResultFile *result) {
    BpCommandLine own = *line;
    own.output = result->path;
    own.error_map = result->error_map[0] != '\0' ? result->error_map : NULL;
    return own;
}

BpStatus bp_result_choose(const BpCommandLine *line, const char *source, BpResultFile *result, BpError *err) {
    BP_TRY(choose_output(line, source, result, err));
    BP_TRY(check_figure(line, result->format, err));
    BP_TRY(choose_error_map(line, source, result, err));
    const BpCommandLine own = bp_result_line(line, result);
    /* Files on the command line have been compared already, with messages that name the options. */
    if (line->output == NULL) {
        BpCommandLine unnamed = own;
        unnamed.output = NULL;
        BP_TRY(bp_file_conflicts_check(&unnamed, result->path, err));
    } else {
        BP_TRY(bp_file_conflicts_check(&own, NULL, err));
    }
    BP_TRY(bp_line_check_output(line, result->path, err));
    return own.error_map != NULL ? bp_line_check_output(line, own.error_map, err) : BP_OK;
}

void bp_result_say_overwritten(const BpCommandLine *line, const BpResultFile *result) {
    bp_line_say_overwritten(line, result->path);
    if (result->error_map[0] != '\0') bp_line_say_overwritten(line, result->error_map);
}

static BpStatus print_error_map(const void *picture, FILE *out, BpError *err) {
    return bp_error_map_print(picture, out, err);
}

/* What --metadata writes. */
typedef struct Metadata {
    char software[64], command[BP_COMMAND_TEXT_SIZE], seed[32], hash[32];
    json_t *command_text; /* the command as UTF-8 */
} Metadata;

static BpStatus make_metadata(const BpCommandLine *line, const BpFilm *film, Metadata *metadata,
                              BpImageExtra *extra, BpError *err) {
    snprintf(metadata->software, sizeof metadata->software, "Ballpark %s", bp_version());
    snprintf(metadata->seed, sizeof metadata->seed, "%" PRIu64, film->seed);
    snprintf(metadata->hash, sizeof metadata->hash, "%016" PRIx64, film->scene_hash);
    metadata->command_text =
        bp_json_text(bp_command_text(line, line->resume, 0, metadata->command, sizeof metadata->command));
    if (metadata->command_text == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the metadata");
    extra->software = metadata->software;
    extra->notes[0] = (BpImageNote){"Command", "command", json_string_value(metadata->command_text)};
    extra->notes[1] = (BpImageNote){"Seed", "seed", metadata->seed};
    extra->notes[2] = (BpImageNote){"Scene hash", "sceneHash", metadata->hash};
    extra->note_count = 3;
    return BP_OK;
}

BpStatus bp_result_take_width(BpCommandLine *line, BpError *err) {
    if (!bp_option_given(line, BP_OPTION_WIDTH_MM)) return BP_OK;
    if (!bp_option_given(line, BP_OPTION_DPI))
        return bp_fail(err, BP_ERR_USAGE,
                       "--width-mm needs --dpi, to compute the width in pixels; add --dpi 300");
    if (bp_option_given(line, BP_OPTION_WIDTH))
        return bp_fail(err, BP_ERR_USAGE, "--width-mm and --width do not go together; give one of them");
    const double pixels = floor(line->width_mm / 25.4 * line->dpi + 0.5);
    if (!(pixels >= 1 && pixels <= BP_PICTURE_SIDE_MAX))
        return bp_fail(err, BP_ERR_USAGE, "--width-mm %g at --dpi %g is %.0f pixels, expected 1 to %u",
                       line->width_mm, line->dpi, pixels, BP_PICTURE_SIDE_MAX);
    line->width = (uint32_t)pixels;
    line->given[BP_OPTION_WIDTH] = true;
    line->given[BP_OPTION_WIDTH_MM] = false; /* a continued render needs no second check */
    return BP_OK;
}

bool bp_result_has_cues(const BpCommandLine *line) {
    return line->outlines > 0 || line->depth_fog > 0;
}

static BpStatus draw_cues(const BpCommandLine *line, const BpScene *scene, BpPicture *picture, BpError *err) {
    BpDepthCues cues = {.outlines = line->outlines, .fog = line->depth_fog / 100};
    if (!bp_result_has_cues(line) || picture->depth == NULL) return BP_OK;
    for (int c = 0; c < 3 && scene != NULL; c++) {
        cues.bottom[c] = scene->backdrop_bottom[c];
        cues.top[c] = scene->backdrop_top[c];
    }
    return bp_depth_cues_draw(picture, &cues, err);
}

/* What is written beside the picture; NULL: it needs no figure. */
static const BpFigure *figure_of(const BpScene *scene, const BpResultFile *result) {
    static const BpFigure bare;
    if (!is_encoded(result->format)) return NULL;
    if (scene != NULL && bp_figure_has_text(&scene->figure)) return &scene->figure;
    return is_vector(result->format) ? &bare : NULL;
}

/* Margins continue a backdrop of one colour; beside any other picture they are white. */
static BpFigurePage page_of(const BpCommandLine *line, const BpScene *scene, BpTransfer transfer) {
    BpFigurePage page = {.dots_per_inch = bp_option_given(line, BP_OPTION_DPI) ? line->dpi : BP_FIGURE_DPI,
                         .transfer = transfer,
                         .paper = {1, 1, 1}};
    if (scene == NULL) return page; /* then there are no margins */
    page.is_clear = scene->backdrop == BP_BACKDROP_NONE;
    const double *const bottom = scene->backdrop_bottom, *const top = scene->backdrop_top;
    bool is_even = scene->backdrop == BP_BACKDROP_COLORS;
    for (int c = 0; c < 3; c++) is_even = is_even && !(bottom[c] < top[c]) && !(bottom[c] > top[c]);
    for (int c = 0; c < 3 && is_even; c++) page.paper[c] = bottom[c] * exp2(line->exposure);
    return page;
}

/* A figure that is written as vectors. */
typedef struct Printed {
    const BpFigure *figure;
    const BpFigurePage *page;
    const BpPicture *picture;
    BpFormat format;
} Printed;

static BpStatus print_figure(const void *what, FILE *out, BpError *err) {
    const Printed *const printed = what;
    return bp_figure_print(printed->figure, printed->page, printed->picture, printed->format, out, err);
}

BpStatus bp_result_check_text(const BpCommandLine *line, const BpResultFile *result, const BpScene *scene,
                              BpError *err) {
    const BpFigure *const figure = figure_of(scene, result);
    const uint32_t size[2] = {scene->camera.width, scene->camera.height};
    uint32_t whole[2];
    char notes[2048];
    if (figure == NULL) return BP_OK;
    const BpTransfer transfer = bp_option_given(line, BP_OPTION_TRANSFER) ? line->transfer : scene->transfer;
    const BpFigurePage page = page_of(line, scene, transfer);
    BP_TRY(bp_figure_measure(figure, &page, size, whole, notes, sizeof notes, err));
    for (char *note = strtok(notes, "\n"); note != NULL; note = strtok(NULL, "\n"))
        bp_say(line, "warning: %s", note);
    return BP_OK;
}

BpStatus bp_result_write(const BpCommandLine *line, const BpResultFile *result, const BpFilm *film,
                         bool rendered, BpTransfer transfer, const BpScene *scene, BpError *err) {
    BpStatus status = BP_OK;
    BpPicture picture = {0}, undrawn = {0};
    const bool is_picture = result->format != BP_FORMAT_BPA, has_map = result->error_map[0] != '\0';
    if (bp_option_given(line, BP_OPTION_TRANSFER)) transfer = line->transfer;
    BpImageExtra extra = {.dots_per_inch = bp_option_given(line, BP_OPTION_DPI) ? line->dpi : 0,
                          .deep = line->bit_depth != NULL && strcmp(line->bit_depth, "16") == 0};
    Metadata metadata = {.command_text = NULL};
    if (line->metadata) BP_TRY_GOTO(status, make_metadata(line, film, &metadata, &extra, err), done);
    const BpFigure *const figure = figure_of(scene, result);
    BpFigurePage page = {0};
    if (figure != NULL) page = page_of(line, scene, transfer);
    if (figure != NULL && result->format == BP_FORMAT_PNG) extra.dots_per_inch = page.dots_per_inch;
    /* The map shows the errors of the render, not of lines drawn over it. */
    const bool apart =
        (figure != NULL && !is_vector(result->format)) || bp_result_has_cues(line) || line->exposure != 0;
    if (is_picture || has_map) BP_TRY_GOTO(status, bp_film_picture(film, &picture, err), done);
    if (has_map && apart) BP_TRY_GOTO(status, bp_film_picture(film, &undrawn, err), done);
    BP_TRY_GOTO(status, draw_cues(line, scene, &picture, err), done);
    if (is_picture) bp_picture_expose(&picture, line->exposure);
    if (figure != NULL && !is_vector(result->format))
        BP_TRY_GOTO(status, bp_figure_draw(figure, &page, &picture, err), done);
    if (rendered && picture.alpha != NULL && is_picture && result->format != BP_FORMAT_PNG &&
        result->format != BP_FORMAT_EXR && !is_vector(result->format))
        bp_say(line, "%s has no alpha: transparent parts are black; .png and .exr keep it",
               bp_result_name(result));
    BpCommandLine of_result = *line;
    if (result->is_own) of_result.no_clobber = false;
    const Printed printed = {figure, &page, &picture, result->format};
    if (is_vector(result->format))
        status = bp_line_write(&of_result, result->path, print_figure, &printed, err);
    else if (is_picture)
        status =
            bp_line_write_picture(&of_result, result->path, &picture, result->format, transfer, &extra, err);
    else
        status = bp_line_write_film(&of_result, result->path, film, err);
    /* A closed pipe ends the picture, but the map is a separate file. */
    if (has_map && (status == BP_OK || strcmp(result->path, "-") == 0)) {
        const BpStatus mapped = bp_line_write(line, result->error_map, print_error_map,
                                              apart ? &undrawn : &picture, status == BP_OK ? err : NULL);
        if (status == BP_OK) {
            status = mapped;
            rendered = false; /* the picture is written */
        }
    }
done:
    json_decref(metadata.command_text);
    if (status != BP_OK && rendered) bp_keep_sums(film, result->path, err);
    bp_picture_clear(&picture);
    bp_picture_clear(&undrawn);
    return status;
}

const char *bp_result_name(const BpResultFile *result) {
    return strcmp(result->path, "-") == 0 ? "standard output" : result->path;
}

void bp_result_warn(const BpCommandLine *line, const BpFilm *film) {
    const double off = bp_film_rounding(film);
    char text[32];
    if (isinf(off))
        bp_say(line,
               "warning: the picture is black because its light is more than 10^17 times dimmer than the "
               "brightest path, too dim for the sums to hold; dim or remove the brightest lamp");
    else if (off > BP_ROUNDING_MAX)
        bp_say(line,
               "warning: rounding may have changed the picture by %s, because its light is so much dimmer "
               "than the brightest path; dim or remove the brightest lamp",
               bp_format_percent(off, text, sizeof text));
}
