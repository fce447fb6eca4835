/* study_points.c: what is noted of a setting when it has reached a sample count; see study_state.h. */
#include "../base/status.h"
#include "parts.h"
#include "study_state.h"

#include <math.h>

BpStatus bp_study_note_first(BpStudy *study, size_t s, BpError *err) {
    BpPicture picture;
    BP_TRY(bp_render_read(study->runners[s].render, &picture, err));
    if (s > 0) {
        bp_study_interest_add(study->interest, &picture, &study->first, study->result.brightness);
        bp_picture_clear(&picture);
        return BP_OK;
    }
    study->first = picture;
    bp_study_interest_add(study->interest, &picture, &study->references.pictures[0],
                          study->result.brightness);
    return BP_OK;
}

/* The first sample of every pixel was the warm-up and is not in the times, hence n / (n - 1). */
static void note_times(const BpStudyRunner *runner, BpStudyPoint *point) {
    const double scale = (double)point->samples / (double)(point->samples - 1);
    BpRenderReport report;
    bp_render_report(runner->render, &report);
    point->wall_seconds = scale * runner->wall_seconds;
    point->cpu_seconds = scale * runner->cpu_seconds;
    point->device_seconds = scale * (report.device_seconds - runner->warm_device_seconds);
    point->seconds = scale * runner->seconds;
}

static bool is_truth(const BpStudyResult *result, size_t s) {
    return s == 1 && result->reference_is_kernel;
}

/* Against the base and the truth, which have the same counts: in each round the base comes first. */
static BpStatus note_differences(BpStudy *study, size_t s, const BpAccumulator *sums,
                                 const BpPicture *picture, BpError *err) {
    const BpStudyEstimate unknown = {(double)NAN, (double)NAN, (double)NAN};
    const BpPicture *truths = study->references.pictures;
    const double brightness = study->result.brightness;
    BpStudySeries *series = &study->result.series[s];
    const BpAccumulator *other = NULL;
    if (s == 0) {
        series->change = series->change_square = series->bias_square = unknown;
        series->bias = bp_study_unpaired(picture, &truths[0], &truths[1], brightness);
        return BP_OK;
    }
    BP_TRY(bp_render_accumulator(study->runners[0].render, &other, err));
    BP_TRY(bp_study_paired(sums, other, brightness, &series->change, &series->change_square, err));
    if (is_truth(&study->result, s)) {
        BpStudySeries *base = &study->result.series[0];
        series->bias = bp_study_unpaired(picture, &truths[0], &truths[1], brightness);
        series->bias_square = (BpStudyEstimate){0, 0, 0}; /* by definition */
        return bp_study_paired(other, sums, brightness, &base->bias, &base->bias_square, err);
    }
    if (!study->result.reference_is_kernel) {
        series->bias = bp_study_unpaired(picture, &truths[0], &truths[1], brightness);
        series->bias_square = unknown;
        return BP_OK;
    }
    BP_TRY(bp_render_accumulator(study->runners[1].render, &other, err));
    return bp_study_paired(sums, other, brightness, &series->bias, &series->bias_square, err);
}

BpStatus bp_study_note_point(BpStudy *study, size_t s, BpError *err) {
    BpStudySeries *series = &study->result.series[s];
    BpStudyPoint *point = &series->points[series->count++];
    const BpPicture *truths = study->references.pictures;
    const BpAccumulator *sums = NULL;
    BpPicture picture;
    BpStatus status = BP_OK;
    point->samples = study->level;
    note_times(&study->runners[s], point);
    BP_TRY(bp_render_accumulator(study->runners[s].render, &sums, err));
    point->claimed = bp_accumulator_nrmse(sums);
    BP_TRY(bp_accumulator_picture(sums, &picture, err));
    bp_study_errors(&picture, &truths[0], &truths[1], study->result.brightness, point);
    BP_TRY_GOTO(status,
                bp_study_crop(&picture, &truths[0], &truths[1], study->crop_left, study->crop_top,
                              study->result.scene->transfer, &point->crop, err),
                done);
    status = note_differences(study, s, sums, &picture, err);
done:
    bp_picture_clear(&picture);
    return status;
}
