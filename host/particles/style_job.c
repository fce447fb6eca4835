/* style_job.c: see style_job.h. */
#include "style_job.h"

#include "elements.h"

#include <stdarg.h>
#include <stdio.h>
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
