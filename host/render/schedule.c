/* schedule.c: see schedule.h. */
#include "schedule.h"

/* A pass has at most this many samples per pixel, unless the picture is so small that a chunk would not be
 * filled. */
#define PASS_SAMPLES_MAX 64u

void bp_schedule_init(BpSchedule *schedule, uint32_t pixels, uint64_t first_sample, uint64_t samples) {
    *schedule = (BpSchedule){.pixels = pixels, .first_sample = first_sample, .samples = samples};
}

static uint64_t at_most(uint64_t a, uint64_t b) {
    return a < b ? a : b;
}
static uint64_t at_least(uint64_t a, uint64_t b) {
    return a > b ? a : b;
}

bool bp_schedule_has_more(const BpSchedule *schedule) {
    return schedule->pass_samples > 0 || (schedule->samples != schedule->done && schedule->pixels > 0);
}

bool bp_schedule_take(BpSchedule *schedule, uint64_t wanted, BpChunk *chunk) {
    if (!bp_schedule_has_more(schedule)) return false;
    if (schedule->pass_samples == 0) {
        const uint64_t left = schedule->samples - schedule->done;
        const uint64_t most = at_least(PASS_SAMPLES_MAX, wanted / schedule->pixels);
        /* As many again as there are: 1, 1, 2, 4, 8, ... And as many as a chunk has for a whole picture. */
        const uint64_t more =
            at_least(at_least(schedule->before + schedule->done, 1), wanted / schedule->pixels);
        const uint64_t pass = at_most(at_most(more, most), at_most(left, at_most(wanted, UINT32_MAX)));
        schedule->pass_samples = (uint32_t)at_least(pass, 1);
        schedule->next_pixel = 0;
    }
    const uint64_t pixels_wanted = at_least(wanted / schedule->pass_samples, 1);
    const uint64_t pixels_left = schedule->pixels - schedule->next_pixel;
    chunk->first_pixel = schedule->next_pixel;
    chunk->pixel_count = (uint32_t)at_most(pixels_wanted, pixels_left);
    chunk->first_sample = schedule->first_sample + schedule->done;
    chunk->samples = schedule->pass_samples;
    schedule->next_pixel += chunk->pixel_count;
    if (schedule->next_pixel == schedule->pixels) {
        schedule->done += schedule->pass_samples;
        schedule->pass_samples = 0;
    }
    return true;
}
