/* depth_cues.c: see depth_cues.h. */
#include "depth_cues.h"

#include <math.h>
#include <stdlib.h>

/* A line is drawn where the depth jumps by more than this share of the depth that the picture shows. */
#define JUMP 0.03

typedef struct Depths {
    const BpPicture *picture;
    double nearest, range; /* 0: all visible surfaces are equally far, or there are none */
    double fog;
} Depths;

static double depth_at(const Depths *depths, int64_t x, int64_t y) {
    const int64_t width = depths->picture->width, height = depths->picture->height;
    if (x < 0 || y < 0 || x >= width || y >= height) return NAN;
    return (double)depths->picture->depth[y * width + x];
}

/* The share by which a thing fades. */
static double fade(const Depths *depths, double depth) {
    return depths->range > 0 ? depths->fog * (depth - depths->nearest) / depths->range : 0;
}

static Depths measure(const BpPicture *picture, double fog) {
    double nearest = INFINITY, farthest = -INFINITY;
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++) {
        const double depth = (double)picture->depth[i];
        if (!isfinite(depth)) continue;
        nearest = fmin(nearest, depth);
        farthest = fmax(farthest, depth);
    }
    return (Depths){picture, nearest, farthest > nearest ? farthest - nearest : 0, fog};
}

/* The coverage of pixel (x, y) by the outline of the surface at (x + dx, y + dy): 0 if that is not in front
 * of the pixel's own surface. */
static double covered(const Depths *depths, int64_t x, int64_t y, int64_t dx, int64_t dy, double width) {
    const double here = depth_at(depths, x, y), there = depth_at(depths, x + dx, y + dy);
    if (!isfinite(there) || !(here > there)) return 0;
    if (isfinite(here)) {
        /* Towards its limb a sphere's depth falls ever faster, without bound. It is an edge only where the
         * next step is not larger still. */
        const double ahead = depth_at(depths, x - dx, y - dy);
        if (here - there < JUMP * depths->range || !(ahead - here <= here - there)) return 0;
    }
    /* The edge lies half a pixel before the centre of the pixel there; this one spans the last pixel before
     * it. */
    const double share = width + 1 - hypot((double)dx, (double)dy);
    return fmin(fmax(share, 0), 1) * (1 - fade(depths, there));
}

/* The share of a pixel's rays that hit nothing, at silhouettes before the background: normals of one surface
 * are nearly equal within a pixel, and rays that hit nothing count as 0 in their mean. */
static double background_share(const BpPicture *picture, size_t pixel) {
    if (picture->normal == NULL || !isfinite(picture->depth[pixel])) return 0;
    const float *const n = &picture->normal[3 * pixel];
    const double length =
        sqrt((double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] + (double)n[2] * (double)n[2]);
    return fmin(fmax(1 - length, 0), 1);
}

static bool is_beside_background(const Depths *depths, int64_t x, int64_t y) {
    return isinf(depth_at(depths, x - 1, y)) || isinf(depth_at(depths, x + 1, y)) ||
           isinf(depth_at(depths, x, y - 1)) || isinf(depth_at(depths, x, y + 1));
}

/* How much of each pixel is line. */
static void find_lines(const Depths *depths, double width, float *lines) {
    const BpPicture *const picture = depths->picture;
    const int64_t reach = (int64_t)ceil(width);
    for (int64_t y = 0; y < picture->height; y++) {
        for (int64_t x = 0; x < picture->width; x++) {
            const size_t pixel = (size_t)(y * picture->width + x);
            double line = 0;
            for (int64_t dy = -reach; dy <= reach; dy++)
                for (int64_t dx = -reach; dx <= reach; dx++)
                    if (dx != 0 || dy != 0) line = fmax(line, covered(depths, x, y, dx, dy, width));
            if (is_beside_background(depths, x, y))
                line = fmax(line, background_share(picture, pixel) * fmin(width, 1) *
                                      (1 - fade(depths, (double)picture->depth[pixel])));
            lines[pixel] = (float)line;
        }
    }
}

BpStatus bp_depth_cues_draw(BpPicture *picture, const BpDepthCues *cues, BpError *err) {
    const size_t pixels = (size_t)picture->width * picture->height;
    if (picture->depth == NULL) return bp_fail(err, BP_ERR_USAGE, "the picture has no depth to draw by");
    const Depths depths = measure(picture, cues->fog);
    float *const lines = cues->outlines > 0 ? malloc(pixels * sizeof *lines) : NULL;
    if (cues->outlines > 0) {
        if (lines == NULL)
            return bp_fail(err, BP_ERR_MEMORY, "out of memory for the outlines of %zu pixels", pixels);
        find_lines(&depths, cues->outlines, lines);
    }
    for (size_t i = 0; i < pixels; i++) {
        const double depth = (double)picture->depth[i],
                     stays = isfinite(depth) ? 1 - fade(&depths, depth) : 1;
        const double line = lines != NULL ? (double)lines[i] : 0;
        /* Only surfaces fade, so the backdrop's share of a pixel at an edge is unchanged. */
        const double up = 1 - ((double)(i / picture->width) + 0.5) / picture->height;
        for (size_t c = 0; c < 3; c++) {
            const double behind =
                picture->alpha != NULL ? 0 : cues->bottom[c] + up * (cues->top[c] - cues->bottom[c]);
            const double faded = stays < 1 ? behind + stays * ((double)picture->rgb[3 * i + c] - behind)
                                           : (double)picture->rgb[3 * i + c];
            picture->rgb[3 * i + c] = (float)((1 - line) * faded);
        }
        if (picture->alpha != NULL)
            picture->alpha[i] = (float)(line + (1 - line) * stays * (double)picture->alpha[i]);
    }
    free(lines);
    return BP_OK;
}
