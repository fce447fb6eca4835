/* content.h: writes scenes, films and pictures, for any command.
 *
 * In:    the command line, a path, the content.   Out: the file, as bp_line_write() writes it (output.h).
 * Knows: which function prints each.   Does not know: when and where it is written. */
#ifndef BP_CLI_OUTPUT_CONTENT_H
#define BP_CLI_OUTPUT_CONTENT_H

#include "cli/line/options.h"
#include "film/film.h"
#include "image/image.h"
#include "scene/scene.h"

/* The scene as a JSON document. */
BpStatus bp_line_write_scene(const BpCommandLine *line, const char *path, const BpScene *scene, BpError *err);
/* The film as a .bpa file. */
BpStatus bp_line_write_film(const BpCommandLine *line, const char *path, const BpFilm *film, BpError *err);
/* The picture in any other format; `extra`: as for bp_picture_write_extra(); NULL: none. */
BpStatus bp_line_write_picture(const BpCommandLine *line, const char *path, const BpPicture *picture,
                               BpFormat format, BpTransfer transfer, const BpImageExtra *extra, BpError *err);

#endif
