/* atom.c: what the formats of molecules say of an atom in the same way; see reader.h.
 *
 * In:    names as a file has them.   Out: a particle's element and flags.
 * Knows: elements.h.   Does not know: how a format is written. */
#include "elements.h"
#include "reader.h"

#include <strings.h>

/* Symbols that programs of molecular dynamics give to sites without a nucleus: extra and virtual points, lone
 * pairs, the Drude particles of polarizable models, dummies. */
static bool is_site(const char *symbol) {
    static const char *const sites[] = {"EP", "LP", "VS", "DU"};
    for (size_t i = 0; i < sizeof sites / sizeof *sites; i++)
        if (strcasecmp(symbol, sites[i]) == 0) return true;
    return false;
}

void atom_identify(Particle *atom, const char *symbol, const char *name, bool fixed) {
    bool dummy = false;
    const uint8_t by_name = bp_element_of_name(name, atom->residue, fixed, &dummy);
    atom->element = bp_element_of_species(symbol);
    if (atom->element != 0) return; /* whatever its name: MN1 is manganese too */
    dummy |= is_site(symbol);
    if (strcasecmp(symbol, "X") != 0) { /* X: the file says that it is unknown */
        atom->element = by_name;
        if (by_name != 0) atom->flags |= BP_PARTICLE_ELEMENT_GUESSED;
    }
    if (dummy) {
        atom->flags = BP_PARTICLE_DUMMY;
        atom->element = 0;
    }
}

void atom_note_masses(BpParticles *particles, size_t known, size_t count, const char *things, bool united) {
    if (known == count && count > 0)
        bp_particles_note(particles, "elements from masses%s",
                          united ? " (CH, CH2, CH3 and CH4 as carbon)" : "");
    else if (known > 0)
        bp_particles_note(particles, "no elements, since the masses of %zu of %zu %s are those of none",
                          count - known, count, things);
}
