/* scene_fault.c: see scene_fault.h. */
#include "scene_fault.h"

#include <stdarg.h>
#include <stdio.h>

bool bp_fault_set(BpFault *fault, BpFaultSubject subject, const char *member, const char *format, ...) {
    fault->subject = subject;
    fault->member = member;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(fault->text, sizeof fault->text, format, arguments);
    va_end(arguments);
    return true;
}
