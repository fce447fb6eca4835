/* particle_select.c: evaluates an expression for every particle of a frame, for scripts that compare with an
 * independent evaluation.
 *
 * particle_select FILE FRAME truth|number EXPRESSION. Prints the numbers of the particles, in the order in
 * which they are kept, for which it holds, or its value for each, as a list of JSON. Exit code 1, the
 * message, and below it the drawing of the place on standard error when something is refused.
 * `particle_select -` does so for many (requests.h). */
#include "particles/select.h"
#include "requests.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void print_selected(const bool *selected, size_t count) {
    const char *before = "";
    for (size_t i = 0; i < count; i++) {
        if (!selected[i]) continue;
        printf("%s%zu", before, i);
        before = ", ";
    }
}

static void print_numbers(const double *numbers, size_t count) {
    for (size_t i = 0; i < count; i++) {
        if (i > 0) printf(", ");
        if (isfinite(numbers[i]))
            printf("%.17g", numbers[i]);
        else
            printf(isnan(numbers[i]) ? "NaN" : numbers[i] > 0 ? "Infinity" : "-Infinity");
    }
}

static BpStatus evaluate(BpParticleFile *file, int64_t frame, const BpExpression *expression, bool truth,
                         const BpSelectFrame *form, BpError *err) {
    BpParticles particles = {0};
    BpSelectFrame whole = *form;
    whole.particles = &particles;
    BpStatus status = bp_particle_file_frame(file, frame, &particles, err);
    bool *const selected = calloc(particles.count + 1, sizeof *selected);
    double *const numbers = calloc(particles.count + 1, sizeof *numbers);
    size_t count = 0;
    if (selected == NULL || numbers == NULL) abort();
    if (status == BP_OK)
        status = truth ? bp_select_truths(&whole, expression, selected, err)
                       : bp_select_numbers(&whole, expression, numbers, err);
    for (size_t i = 0; i < particles.count; i++) count += selected[i];
    if (status == BP_OK && truth && count == 0) status = bp_select_fail_nothing(&whole, expression, err);
    if (status == BP_OK) {
        printf("[");
        if (truth)
            print_selected(selected, particles.count);
        else
            print_numbers(numbers, particles.count);
        printf("]\n");
    }
    free(selected);
    free(numbers);
    bp_particles_clear(&particles);
    return status;
}

static int answer(int argc, char **argv, FILE *messages) {
    BpError err = {0};
    BpParticleFile *file = NULL;
    BpExpression *expression = NULL;
    const char *columns[BP_SELECT_COLUMNS_MAX];
    FILE *const stream = argc > 4 ? fopen(argv[1], "rb") : NULL;
    if (stream == NULL) return 2;
    const bool truth = strcmp(argv[3], "truth") == 0;
    BpStatus status = bp_select_parse(argv[4], truth ? BP_VALUE_TRUTH : BP_VALUE_NUMBER, &expression, &err);
    const size_t count = status == BP_OK ? bp_select_columns(expression, columns) : 0;
    if (status == BP_OK)
        status = bp_particle_file_open(stream, argv[1], bp_particle_format_find(argv[1], stream), columns,
                                       count, 0, &file, &err);
    if (status == BP_OK) {
        const BpSelectFrame frame = {NULL, columns, count};
        status = evaluate(file, strtol(argv[2], NULL, 10), expression, truth, &frame, &err);
    }
    if (status != BP_OK)
        fprintf(messages, "%s\n%s\n", err.message, err.attachment != NULL ? err.attachment : "");
    bp_expression_destroy(&expression);
    bp_particle_file_close(&file);
    bp_error_clear(&err);
    fclose(stream);
    return status == BP_OK ? 0 : 1;
}

int main(int argc, char **argv) {
    return answer_requests(argc, argv, answer);
}
