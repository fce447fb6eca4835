/* bpa_mutator.h: changes film files so that most of them still load.
 *
 * In:    a .bpa file, or anything.   Out: the file changed, its body as long as the header says, its checksum
 * true.
 * Knows: the file's layout (host/film/film_file.h), by its own code.
 *
 * A fuzzer that changes bytes alone never gets past the tests of length and checksum: so after each change of
 * the header the body is cut or filled with zeros. One in eight is left as it is, so that wrong lengths are
 * tried too. */
#ifndef BP_FUZZ_BPA_MUTATOR_H
#define BP_FUZZ_BPA_MUTATOR_H

#include <stddef.h>
#include <stdint.h>

size_t bpa_mutate(uint8_t *data, size_t size, size_t size_max, unsigned seed);

#endif
