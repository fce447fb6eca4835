/* suite.h: the agreement scenes of `ballpark check --suite`, small ones of one effect each.
 *
 * In:    the files of tests/agree/scenes, which the program holds.   Out: scenes.
 * Knows: how the files are embedded.   Does not know: how scenes are checked.
 *
 * They are embedded, so that an installed program has the scenes that it was tested with. */
#ifndef BP_CLI_CONFORM_SUITE_H
#define BP_CLI_CONFORM_SUITE_H

#include "base/status.h"

typedef struct BpSuite {
    size_t count;
    char (*names)[64]; /* "lobe-lambertian", in alphabetical order */
    BpScene **scenes;
} BpSuite;

/* Loads all of them. Clear it in any case. */
BpStatus bp_suite_load(BpSuite *suite, BpError *err);
/* The scene of that name, or NULL. */
BpScene *bp_suite_find(const BpSuite *suite, const char *name);
void bp_suite_clear(BpSuite *suite);

#endif
