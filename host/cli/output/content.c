/* content.c: see content.h. */
#include "content.h"

#include "film/film_file.h"
#include "output.h"

static BpStatus print_scene(const void *scene, FILE *out, BpError *err) {
    return bp_scene_print(scene, out, err);
}

BpStatus bp_line_write_scene(const BpCommandLine *line, const char *path, const BpScene *scene,
                             BpError *err) {
    return bp_line_write(line, path, print_scene, scene, err);
}

static BpStatus print_film(const void *film, FILE *out, BpError *err) {
    return bp_film_write_stream(film, out, err);
}

BpStatus bp_line_write_film(const BpCommandLine *line, const char *path, const BpFilm *film, BpError *err) {
    return bp_line_write(line, path, print_film, film, err);
}

typedef struct Printed {
    const BpPicture *picture;
    BpFormat format;
    BpTransfer transfer;
    const BpImageExtra *extra;
} Printed;

static BpStatus print_picture(const void *what, FILE *out, BpError *err) {
    const Printed *printed = what;
    return bp_picture_write_extra(printed->picture, out, printed->format, printed->transfer, printed->extra,
                                  err);
}

BpStatus bp_line_write_picture(const BpCommandLine *line, const char *path, const BpPicture *picture,
                               BpFormat format, BpTransfer transfer, const BpImageExtra *extra,
                               BpError *err) {
    const BpImageExtra none = {.note_count = 0};
    const Printed printed = {picture, format, transfer, extra != NULL ? extra : &none};
    return bp_line_write(line, path, print_picture, &printed, err);
}
