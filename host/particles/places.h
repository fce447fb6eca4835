/* places.h: which of the alternative places of atoms are shown.
 *
 * In:    for each particle of a frame its site and its letter.   Out: flags of the frame's particles.
 * Knows: what alternative places are in PDB and mmCIF files.   Does not know: how these are written.
 *
 * Each atom is shown at one place. A site is a residue: chain, number and insertion code. Of its places those
 * with letter A are shown, or if it has none, those with its first letter; an atom that has no such place is
 * shown at its first. Where residues of different names share a site, and no letter, they are alternatives as
 * well (microheterogeneity). An atom without a letter is always shown. Residues without a number, such as
 * water in mmCIF files that have no author's numbers, are told apart by their first atom, which comes again.
 */
#ifndef BP_PARTICLES_PLACES_H
#define BP_PARTICLES_PLACES_H

#include "particles.h"

/* Begins as zero; release with places_clear(). */
typedef struct Places {
    uint64_t *site; /* of each particle, in their order */
    uint32_t *letter;
    size_t count, capacity;
    bool any; /* some particle has a letter */
    struct {
        uint64_t site, number; /* its own number, from 1; 0: none so far */
        uint64_t letters;      /* those of its first atom so far, as bits */
        uint16_t name, residue;
    } unnumbered; /* the last residue without a number, and its first atom's name */
} Places;

/* Takes what was handed over last; nothing, if that has no place, so that it is none of the particles.
 * `site`: the text that names its residue in the file, `numbered`: with a number; `letter`: at most four
 * bytes of it count; "": it has one place. */
BpStatus places_take(Places *places, const BpParticles *particles, const char *site, bool numbered,
                     const char *letter, BpError *err);
/* Marks what is not shown among the particles, which are those taken since the beginning or the last call,
 * and begins anew. */
BpStatus places_mark(Places *places, BpParticles *particles, BpError *err);
void places_clear(Places *places);

#endif
