/* series.h: the pictures of one `ballpark render`: a single one, or one per frame or step of a turntable.
 *
 * In:    the command line.   Out: one scene after the other, and the names of their pictures.
 * Knows: --frame, --frames, --turntable, --fit.   Does not know: how a picture is made. */
#ifndef BP_CLI_JOB_SERIES_H
#define BP_CLI_JOB_SERIES_H

#include "cli/line/options.h"
#include "formats/particle_cache.h"
#include "formats/scene_changes.h"
#include "scene/scene.h"

typedef struct BpSeries {
    const BpCommandLine *line;
    uint64_t count, next; /* pictures in all; the number of the next, from 0 */
    BpParticleCache cache;
    BpFilmSelections film; /* of its frames */
    int64_t first_frame;
    uint64_t step;
    BpCamera camera; /* of all frames, or of the turntable's first picture */
    bool has_camera, has_range;
    double range[2];
    BpScene *scene; /* the last one; a turntable's is read once */
    char output[4096];
} BpSeries;

/* Refuses conflicting options; for several pictures, determines what they share: the number of frames, a
 * camera that shows all, the range of a column's values. */
BpStatus bp_series_begin(const BpCommandLine *line, BpSeries *series, BpError *err);
void bp_series_end(BpSeries *series);

/* The command line of the next picture, with a numbered file name if there are several. */
BpStatus bp_series_line(BpSeries *series, BpCommandLine *line, BpError *err);
/* The scene of the next picture, with --width applied; it is valid until the next call, and the series
 * continues. */
BpStatus bp_series_scene(BpSeries *series, const BpScene **scene, BpError *err);

#endif
