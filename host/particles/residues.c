/* residues.c: the residues of proteins and nucleic acids, by their names; see elements.h.
 *
 * In:    the name of a residue.   Out: what it is.
 * Knows: names of the Protein Data Bank and of force fields (the lists of MDAnalysis 2.7, and more).
 * Does not know: particles. */
#include "elements.h"

#include <stddef.h>
#include <string.h>
#include <strings.h>

static bool is_among(const char *name, const char *const *names) {
    for (; *names != NULL; names++)
        if (strcasecmp(name, *names) == 0) return true;
    return false;
}

bool bp_residue_is_protein(const char *residue) {
    static const char *const amino_acids[] = {"ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS",
                                              "ILE", "LEU", "LYS", "MET", "PHE", "PRO", "SER", "THR", "TRP",
                                              "TYR", "VAL", "HSD", "HSE", "HSP", "HID", "HIE", "HIP", "ASH",
                                              "GLH", "LYN", "CYM", "CYX", "ASF", NULL};
    static const char *const others[] = {
        /* Modified or rare, and caps. */
        "MSE", "SEC", "PYL", "ORN", "DAB", "HYP", "CME", "ALAD", "ACE", "NME", "NMA", "NH2", "PGLU", "QLN",
        /* GROMOS and OPLS. */
        "ARGN", "ASN1", "ASPH", "ASPP", "CYS1", "CYS2", "CYSH", "GLUH", "GLUP", "HIS1", "HIS2", "HISA",
        "HISB", "HISD", "HISE", "HISH", "HISP", "LYSH", NULL};
    if (is_among(residue, amino_acids) || is_among(residue, others)) return true;
    /* The same at the ends of a chain, as AMBER names them: NALA, CLYS. */
    return strlen(residue) == 4 && (residue[0] == 'N' || residue[0] == 'C') &&
           is_among(residue + 1, amino_acids);
}

bool bp_residue_is_nucleic(const char *residue) {
    static const char *const names[] = {"A",   "C",   "G",   "T",   "U",   "I",   "DA",  "DC",  "DG",  "DT",
                                        "DU",  "DI",  "RA",  "RC",  "RG",  "RU",  "ADE", "CYT", "GUA", "THY",
                                        "URA", "DA3", "DC3", "DG3", "DT3", "DA5", "DC5", "DG5", "DT5", "RA3",
                                        "RC3", "RG3", "RU3", "RA5", "RC5", "RG5", "RU5", NULL};
    return is_among(residue, names);
}
