/* remedy.h: the words for remedies, which differ between the command line, Python and C.
 *
 * In:    the remedy of an error (ballpark.h), whose interface it is for.   Out: a clause such as
 * "use a smaller --width".
 * Knows: what options, arguments, members and functions are called.   Does not know: what they do.
 *
 * A message of the library names no option of the command line: Python and C have other names for it. It ends
 * before the remedy, and the error gets a code for that. A new remedy is an enumerator of BpRemedy and a row
 * in remedy.c; tests/python/test_python_remedies.py compares the names in it with what there is. */
#ifndef BP_BASE_REMEDY_H
#define BP_BASE_REMEDY_H

#include "ballpark.h"

#include <stddef.h>

#define BP_REMEDY_SIZE 160

/* In `text`, as it follows the message: "; use ..." or ", or use ..."; "" for BP_REMEDY_NONE. `value`: what
 * the remedy needs, or "". */
void bp_remedy_text(BpRemedy remedy, const char *value, BpInterface interface, char text[BP_REMEDY_SIZE]);

#endif
