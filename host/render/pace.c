/* pace.c: see pace.h. */
#include "pace.h"

/* The second pass begins while the last chunks of the first are under way, so its chunks are not measured yet
 * either. */
#define UNKNOWN_PASSES 2u

void bp_pace_init(BpPace *pace, uint32_t max_depth, uint32_t together) {
    *pace = (BpPace){.max_depth = max_depth, .together = together > 0 ? together : 1};
}

/* Samples of which each may be as long as the depth allows. */
static uint32_t unknown_samples(const BpPace *pace) {
    const uint32_t samples = BP_PACE_SEGMENTS / (pace->max_depth > 0 ? pace->max_depth : 1);
    return samples > pace->together ? samples : pace->together;
}

static uint32_t first_samples(const BpPace *pace) {
    const uint32_t samples = unknown_samples(pace);
    return samples < BP_PACE_FIRST_SAMPLES ? samples : BP_PACE_FIRST_SAMPLES;
}

void bp_pace_measure(BpPace *pace, uint64_t samples, double seconds) {
    if (samples == 0) return;
    pace->latest = seconds / (double)samples;
    /* The last chunk of a pass can be a single pixel, and its time may be that of another program's turn on
     * the processor. */
    pace->gathered_samples += samples;
    pace->gathered_seconds += seconds;
    if (pace->gathered_samples < first_samples(pace)) return;
    const double slow = pace->gathered_seconds / (double)pace->gathered_samples;
    if (slow > pace->slowest) pace->slowest = slow;
    pace->gathered_samples = 0;
    pace->gathered_seconds = 0;
}

void bp_pace_begin_pass(BpPace *pace) {
    pace->slowest_before = pace->slowest;
    pace->slowest = 0;
    if (pace->passes <= UNKNOWN_PASSES) ++pace->passes;
}

double bp_pace_slowest(const BpPace *pace) {
    return pace->slowest > pace->slowest_before ? pace->slowest : pace->slowest_before;
}

uint32_t bp_pace_samples(const BpPace *pace, double seconds, double slowest) {
    if (pace->latest <= 0) return first_samples(pace);
    double samples = seconds / pace->latest;
    const double bearable = BP_PACE_PATIENCE * seconds / slowest; /* infinite when nothing is known */
    if (samples > bearable) samples = bearable;
    const double unknown = unknown_samples(pace);
    if (pace->passes <= UNKNOWN_PASSES && samples > unknown) samples = unknown;
    if (samples < pace->together) return pace->together;
    return samples > UINT32_MAX ? UINT32_MAX : (uint32_t)samples;
}
