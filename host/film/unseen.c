/* unseen.c: see unseen.h. */
#include "unseen.h"

#include "film.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

BpStatus bp_unseen_create(size_t pixels, BpUnseen **unseen, BpError *err) {
    BpUnseen *made = calloc(1, sizeof *made);
    if (made != NULL) made->pixels = calloc(pixels, sizeof *made->pixels);
    if (made == NULL || made->pixels == NULL) {
        bp_unseen_destroy(&made);
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the unseen light of %zu pixels", pixels);
    }
    *unseen = made;
    return BP_OK;
}

BpStatus bp_unseen_copy(const BpUnseen *from, size_t pixels, BpUnseen **unseen, BpError *err) {
    BP_TRY(bp_unseen_create(pixels, unseen, err));
    memcpy((*unseen)->pixels, from->pixels, pixels * sizeof *from->pixels);
    memcpy((*unseen)->tint, from->tint, sizeof from->tint);
    return BP_OK;
}

void bp_unseen_destroy(BpUnseen **unseen) {
    if (*unseen != NULL) free((*unseen)->pixels);
    free(*unseen);
    *unseen = NULL;
}

/* Of what one find brings to the pixel; its mean is not 0. */
static int octave_of(const BpUnseenPixel *pixel) {
    const int octave = ilogb((double)pixel->square / (double)pixel->mean) + BP_UNSEEN_OCTAVES / 2;
    return octave < 1 ? 1 : octave > BP_UNSEEN_OCTAVES - 2 ? BP_UNSEEN_OCTAVES - 2 : octave;
}

static bool is_lit(const BpUnseenPixel *pixel) {
    return pixel->mean > 0 && pixel->square > 0;
}

void bp_unseen_weigh(const BpFilm *film, BpUnseenWeights *weights) {
    memset(weights, 0, sizeof *weights);
    if (film->unseen == NULL) return;
    const size_t pixels = (size_t)film->width * film->height;
    for (size_t i = 0; i < pixels; i++) {
        const BpUnseenPixel *pixel = &film->unseen->pixels[i];
        if (!is_lit(pixel)) continue;
        double samples = 0;
        for (uint32_t k = 0; k < film->replicates; k++) samples += film->counts[i * film->replicates + k];
        weights->finds[octave_of(pixel)] +=
            samples * (double)pixel->mean * (double)pixel->mean / (double)pixel->square;
    }
}

double bp_unseen_weight(const BpUnseenWeights *weights, const BpUnseenPixel *pixel) {
    if (!is_lit(pixel)) return 0;
    const double *finds = &weights->finds[octave_of(pixel)];
    return BP_UNSEEN_EVIDENCE / (BP_UNSEEN_EVIDENCE + finds[-1] + finds[0] + finds[1]);
}
