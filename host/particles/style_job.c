/* style_job.c: see style_job.h. */
#include "style_job.h"

#include "elements.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void bp_style_say(BpStyleJob *job, const char *format, ...) {
    if (job->summary == NULL) return;
    const size_t used = strlen(job->summary);
    if (used + 4 > job->size) return;
    snprintf(job->summary + used, job->size - used, "%s", used > 0 ? "; " : "");
    const size_t begin = strlen(job->summary);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(job->summary + begin, job->size - begin, format, arguments);
    va_end(arguments);
}

BpSelectFrame bp_style_frame(const BpStyleJob *job) {
    return (BpSelectFrame){job->p, job->columns.name, job->columns.count};
}

BpStatus bp_style_fail_in(const char *member, BpStatus status, BpError *fault, BpError *err) {
    if (status == BP_OK) return BP_OK;
    bp_fail(err, status, "\"%s\": %s", member, fault->message);
    bp_error_attach(err, fault->attachment);
    bp_error_clear(fault);
    return status;
}

BpStatus bp_style_numbers(const BpStyleJob *job, const BpExpression *value, const char *column,
                          const char *member, double **numbers, BpError *err) {
    const size_t count = job->p->count;
    *numbers = malloc((count + 1) * sizeof **numbers);
    if (*numbers == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu numbers", count);
    if (value != NULL) {
        const BpSelectFrame frame = bp_style_frame(job);
        BpError fault = {0};
        return bp_style_fail_in(member, bp_select_numbers(&frame, value, *numbers, &fault), &fault, err);
    }
    for (size_t c = 0; c < job->columns.needed; c++) {
        if (strcmp(job->columns.name[c], column) != 0) continue;
        /* Single precision is what pictures were made of before values could be computed. */
        for (size_t i = 0; i < count; i++) (*numbers)[i] = (double)(float)job->p->column[c][i];
    }
    return BP_OK;
}

const char *bp_style_name(const BpParticles *p, uint16_t number) {
    return p->names.count > 0 ? p->names.text[number] : "";
}

const BpStyleNamed *bp_style_named(const BpStyleNamed *list, size_t count, const BpParticles *p,
                                   const BpParticleTag *tag) {
    for (size_t i = 0; i < count; i++)
        if (strcmp(list[i].name, bp_style_name(p, tag->type)) == 0 ||
            (tag->element != 0 && strcmp(list[i].name, bp_elements[tag->element].symbol) == 0))
            return &list[i];
    return NULL;
}
