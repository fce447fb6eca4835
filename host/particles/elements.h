/* elements.h: what is known of the chemical elements.
 *
 * Knows: published tables.   Does not know: files, scenes. */
#ifndef BP_PARTICLES_ELEMENTS_H
#define BP_PARTICLES_ELEMENTS_H

#include <stdbool.h>
#include <stdint.h>

enum { BP_ELEMENT_MAX = 118 };

typedef struct BpElement {
    char symbol[3];
    float mass;          /* standard atomic weight, or the longest-lived isotope's (IUPAC 2021) */
    float van_der_waals; /* radius in angstrom */
    float covalent;      /* radius in angstrom */
    uint8_t color[3];    /* 8-bit sRGB */
} BpElement;

/* Elements by atomic number; number 0 is an unknown element. */
extern const BpElement bp_elements[BP_ELEMENT_MAX + 1];

/* The atomic number of a symbol in any case, D and T being hydrogen; 0: none. */
uint8_t bp_element_of_symbol(const char *symbol);
/* The same of a symbol with something behind its letters: a number, a charge or a label, as in Fe3+, C12, O_w
 * and H(Iso=2). */
uint8_t bp_element_of_species(const char *species);
/* The element of an atom from its name and its residue's, as in PDB and GRO files; `name` may begin with a
 * blank, as columns 13 to 16 of a PDB line do, which distinguishes CA (calcium) from " CA" (a carbon).
 * `fixed`: the name is such a column. 0: unknown. *dummy: a site of a model (of water, say) and no atom. */
uint8_t bp_element_of_name(const char *name, const char *residue, bool fixed, bool *dummy);
/* The element of a mass in daltons as people round it: within 0.05 % (0.012 dalton for the light ones) of the
 * element's, or that with one decimal; 0: none. *united: it is the carbon of a group that stands as one atom:
 * CH, CH2, CH3 or CH4. */
uint8_t bp_element_of_mass(double mass, bool *united);
/* Residues that are water, and those that are single ions of the water around a molecule. */
bool bp_residue_is_water(const char *residue);
bool bp_residue_is_ion(const char *residue);
/* Those that molecular dynamics and the Protein Data Bank call so, with the names of MDAnalysis. */
bool bp_residue_is_protein(const char *residue);
bool bp_residue_is_nucleic(const char *residue);
/* Water, ions, and the residues of proteins and nucleic acids, where names of atoms are known. */
bool bp_residue_is_common(const char *residue);

#endif
