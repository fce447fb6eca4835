/* names.h: texts that repeat, each kept once.
 *
 * In:    texts.   Out: their numbers.   Does not know: what they name. */
#ifndef BP_PARTICLES_NAMES_H
#define BP_PARTICLES_NAMES_H

#include "particles.h"

/* The number of `text`; 0 for NULL and "". Fails on the 65,536th, and on those of BP_PARTICLE_NAME_SIZE bytes
 * and more: so all together never take more than 64 MiB. */
BpStatus names_number(BpNames *names, const char *text, uint16_t *number, BpError *err);
void names_clear(BpNames *names);

#endif
