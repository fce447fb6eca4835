/* elements.c: see elements.h, and ballpark.h for what is offered to others.
 *
 * Radii of van der Waals: M. Mantina et al. 2009 for the main groups, S. Alvarez 2013 for the others (2.45
 * where neither has one). Covalent radii: B. Cordero et al. 2008 (2.0 where there is none). The colours are
 * our own: the customary hues (after R. Corey, L. Pauling, W. Koltun) at half their saturation. */
#include "elements.h"

#include "ballpark.h"
#include "base/color.h"

#include <math.h>
#include <string.h>
#include <strings.h>

const BpElement bp_elements[BP_ELEMENT_MAX + 1] = {
    {"", 0, 1.7f, 0.77f, {190, 150, 190}},           {"H", 1.008f, 1.1f, 0.31f, {225, 225, 225}},
    {"He", 4.003f, 1.4f, 0.28f, {126, 204, 204}},    {"Li", 6.94f, 1.81f, 1.28f, {176, 132, 210}},
    {"Be", 9.012f, 1.53f, 0.96f, {170, 208, 96}},    {"B", 10.81f, 1.92f, 0.84f, {222, 174, 164}},
    {"C", 12.011f, 1.7f, 0.76f, {140, 142, 148}},    {"N", 14.007f, 1.55f, 0.71f, {98, 122, 202}},
    {"O", 15.999f, 1.52f, 0.66f, {212, 96, 88}},     {"F", 18.998f, 1.47f, 0.57f, {150, 208, 140}},
    {"Ne", 20.18f, 1.54f, 0.58f, {126, 204, 204}},   {"Na", 22.99f, 2.27f, 1.66f, {160, 120, 200}},
    {"Mg", 24.305f, 1.73f, 1.41f, {120, 180, 110}},  {"Al", 26.982f, 1.84f, 1.21f, {184, 172, 172}},
    {"Si", 28.085f, 2.1f, 1.11f, {206, 176, 136}},   {"P", 30.974f, 1.8f, 1.07f, {226, 150, 80}},
    {"S", 32.06f, 1.8f, 1.05f, {226, 204, 98}},      {"Cl", 35.45f, 1.75f, 1.02f, {122, 198, 112}},
    {"Ar", 39.948f, 1.88f, 1.06f, {126, 204, 204}},  {"K", 39.098f, 2.75f, 2.03f, {142, 106, 186}},
    {"Ca", 40.078f, 2.31f, 1.76f, {110, 176, 120}},  {"Sc", 44.956f, 2.58f, 1.7f, {136, 178, 184}},
    {"Ti", 47.867f, 2.46f, 1.6f, {170, 174, 180}},   {"V", 50.941f, 2.42f, 1.53f, {136, 184, 172}},
    {"Cr", 51.996f, 2.45f, 1.39f, {128, 142, 186}},  {"Mn", 54.938f, 2.45f, 1.39f, {156, 122, 190}},
    {"Fe", 55.845f, 2.44f, 1.32f, {208, 128, 84}},   {"Co", 58.933f, 2.4f, 1.26f, {214, 140, 150}},
    {"Ni", 58.693f, 2.4f, 1.24f, {120, 186, 124}},   {"Cu", 63.546f, 2.38f, 1.32f, {204, 140, 96}},
    {"Zn", 65.38f, 2.39f, 1.22f, {134, 138, 178}},   {"Ga", 69.723f, 1.87f, 1.22f, {184, 175, 132}},
    {"Ge", 72.63f, 2.11f, 1.2f, {184, 157, 132}},    {"As", 74.922f, 1.85f, 1.19f, {184, 163, 132}},
    {"Se", 78.971f, 1.9f, 1.2f, {220, 168, 86}},     {"Br", 79.904f, 1.83f, 1.2f, {166, 96, 80}},
    {"Kr", 83.798f, 2.02f, 1.16f, {126, 204, 204}},  {"Rb", 85.468f, 3.03f, 2.2f, {151, 110, 184}},
    {"Sr", 87.62f, 2.49f, 1.95f, {109, 178, 107}},   {"Y", 88.906f, 2.75f, 1.9f, {136, 184, 161}},
    {"Zr", 91.224f, 2.52f, 1.75f, {136, 184, 184}},  {"Nb", 92.906f, 2.56f, 1.64f, {136, 161, 184}},
    {"Mo", 95.95f, 2.45f, 1.54f, {136, 184, 166}},   {"Tc", 97.907f, 2.44f, 1.47f, {136, 178, 184}},
    {"Ru", 101.07f, 2.46f, 1.46f, {136, 155, 184}},  {"Rh", 102.906f, 2.44f, 1.42f, {136, 184, 172}},
    {"Pd", 106.42f, 2.15f, 1.39f, {110, 140, 160}},  {"Ag", 107.868f, 2.53f, 1.45f, {188, 190, 196}},
    {"Cd", 112.414f, 2.49f, 1.44f, {136, 184, 178}}, {"In", 114.818f, 1.93f, 1.42f, {184, 163, 132}},
    {"Sn", 118.71f, 2.17f, 1.39f, {184, 169, 132}},  {"Sb", 121.76f, 2.06f, 1.39f, {184, 175, 132}},
    {"Te", 127.6f, 2.06f, 1.38f, {184, 157, 132}},   {"I", 126.904f, 1.98f, 1.39f, {142, 88, 164}},
    {"Xe", 131.293f, 2.16f, 1.4f, {110, 176, 190}},  {"Cs", 132.905f, 3.43f, 2.44f, {151, 110, 184}},
    {"Ba", 137.327f, 2.68f, 2.15f, {109, 178, 107}}, {"La", 138.905f, 2.98f, 2.07f, {129, 199, 186}},
    {"Ce", 140.116f, 2.88f, 2.04f, {129, 199, 185}}, {"Pr", 140.908f, 2.92f, 2.03f, {129, 199, 183}},
    {"Nd", 144.242f, 2.95f, 2.01f, {129, 199, 181}}, {"Pm", 144.913f, 2.93f, 1.99f, {129, 199, 180}},
    {"Sm", 150.36f, 2.9f, 1.98f, {129, 199, 178}},   {"Eu", 151.964f, 2.87f, 1.98f, {129, 199, 176}},
    {"Gd", 157.25f, 2.83f, 1.96f, {129, 199, 175}},  {"Tb", 158.925f, 2.79f, 1.94f, {129, 199, 173}},
    {"Dy", 162.5f, 2.87f, 1.92f, {129, 199, 171}},   {"Ho", 164.93f, 2.81f, 1.92f, {129, 199, 170}},
    {"Er", 167.259f, 2.83f, 1.89f, {129, 199, 168}}, {"Tm", 168.934f, 2.79f, 1.9f, {129, 199, 166}},
    {"Yb", 173.054f, 2.8f, 1.87f, {129, 199, 165}},  {"Lu", 174.967f, 2.74f, 1.87f, {129, 199, 163}},
    {"Hf", 178.49f, 2.63f, 1.75f, {136, 184, 161}},  {"Ta", 180.948f, 2.53f, 1.7f, {136, 184, 184}},
    {"W", 183.84f, 2.57f, 1.62f, {110, 160, 190}},   {"Re", 186.207f, 2.49f, 1.51f, {136, 184, 166}},
    {"Os", 190.23f, 2.48f, 1.44f, {136, 178, 184}},  {"Ir", 192.217f, 2.41f, 1.41f, {136, 155, 184}},
    {"Pt", 195.084f, 2.29f, 1.36f, {196, 196, 206}}, {"Au", 196.967f, 2.32f, 1.36f, {220, 186, 84}},
    {"Hg", 200.592f, 2.45f, 1.32f, {170, 170, 190}}, {"Tl", 204.38f, 1.96f, 1.45f, {184, 163, 132}},
    {"Pb", 207.2f, 2.02f, 1.46f, {110, 112, 120}},   {"Bi", 208.98f, 2.07f, 1.48f, {184, 175, 132}},
    {"Po", 208.982f, 1.97f, 1.4f, {184, 157, 132}},  {"At", 209.987f, 2.02f, 1.5f, {128, 95, 76}},
    {"Rn", 222.018f, 2.2f, 1.5f, {126, 204, 204}},   {"Fr", 223.02f, 3.48f, 2.6f, {151, 110, 184}},
    {"Ra", 226.025f, 2.83f, 2.21f, {109, 178, 107}}, {"Ac", 227.028f, 2.8f, 2.15f, {113, 152, 189}},
    {"Th", 232.038f, 2.93f, 2.06f, {113, 155, 189}}, {"Pa", 231.036f, 2.88f, 2.0f, {113, 158, 189}},
    {"U", 238.029f, 2.71f, 1.96f, {113, 161, 189}},  {"Np", 237.048f, 2.82f, 1.9f, {113, 163, 189}},
    {"Pu", 244.064f, 2.81f, 1.87f, {113, 166, 189}}, {"Am", 243.061f, 2.83f, 1.8f, {113, 169, 189}},
    {"Cm", 247.07f, 3.05f, 1.69f, {113, 171, 189}},  {"Bk", 247.07f, 3.4f, 2.0f, {113, 174, 189}},
    {"Cf", 251.08f, 3.05f, 2.0f, {113, 177, 189}},   {"Es", 252.083f, 2.7f, 2.0f, {113, 180, 189}},
    {"Fm", 257.095f, 2.45f, 2.0f, {113, 182, 189}},  {"Md", 258.098f, 2.45f, 2.0f, {113, 185, 189}},
    {"No", 259.101f, 2.45f, 2.0f, {113, 188, 189}},  {"Lr", 262.11f, 2.45f, 2.0f, {113, 189, 187}},
    {"Rf", 267.0f, 2.45f, 2.0f, {136, 166, 184}},    {"Db", 268.0f, 2.45f, 2.0f, {136, 184, 161}},
    {"Sg", 269.0f, 2.45f, 2.0f, {136, 184, 184}},    {"Bh", 270.0f, 2.45f, 2.0f, {136, 161, 184}},
    {"Hs", 269.0f, 2.45f, 2.0f, {136, 184, 166}},    {"Mt", 277.0f, 2.45f, 2.0f, {136, 178, 184}},
    {"Ds", 281.0f, 2.45f, 2.0f, {136, 155, 184}},    {"Rg", 282.0f, 2.45f, 2.0f, {136, 184, 172}},
    {"Cn", 285.0f, 2.45f, 2.0f, {136, 172, 184}},    {"Nh", 286.0f, 2.45f, 2.0f, {184, 163, 132}},
    {"Fl", 290.0f, 2.45f, 2.0f, {184, 169, 132}},    {"Mc", 290.0f, 2.45f, 2.0f, {184, 175, 132}},
    {"Lv", 293.0f, 2.45f, 2.0f, {184, 157, 132}},    {"Ts", 294.0f, 2.45f, 2.0f, {128, 95, 76}},
    {"Og", 294.0f, 2.45f, 2.0f, {126, 204, 204}}};

uint8_t bp_element_of_symbol(const char *symbol) {
    if (symbol[0] == '\0' || strlen(symbol) > 2) return 0;
    if (strcasecmp(symbol, "D") == 0 || strcasecmp(symbol, "T") == 0) return 1;
    for (int z = 1; z <= BP_ELEMENT_MAX; z++)
        if (strcasecmp(symbol, bp_elements[z].symbol) == 0) return (uint8_t)z;
    return 0;
}

uint8_t bp_element_of_species(const char *species) {
    char symbol[4] = "";
    size_t letters = 0;
    const size_t nucleons = strspn(species, "0123456789"); /* of an isotope: 13C */
    if (nucleons <= 3 && species[nucleons] != '\0') species += nucleons;
    while (letters < 3 && ((species[letters] | 32) >= 'a' && (species[letters] | 32) <= 'z')) {
        symbol[letters] = species[letters];
        letters++;
    }
    const char *const rest = species + letters;
    return *rest == '\0' || strchr("0123456789+-_(:*@", *rest) != NULL ? bp_element_of_symbol(symbol) : 0;
}

/* Masses of groups lie close: O2 is 0.2 % from sulphur, CH2 0.14 % from nitrogen. */
static bool is_mass_of(double mass, double own) {
    const double rounded = floor(10 * own + 0.5) / 10, off = fabs(mass - own);
    if (off <= fmax(0.012, 0.0005 * own)) return true;
    /* Not where that is a whole number far off: 45 is a bead of Martini and no scandium. */
    return own > 2 && fabs(mass - rounded) < 1e-6 && (rounded != floor(rounded) || off < 0.04);
}

uint8_t bp_element_of_mass(double mass, bool *united) {
    static const double deuterium = 2.014, hydrogen = 1.008, carbon = 12.011;
    uint8_t nearest = 0;
    double least = INFINITY;
    *united = false;
    if (fabs(mass - hydrogen) > 0.006 && mass < 2) return 0; /* 1 is the mass of whatever has no unit */
    if (fabs(mass - deuterium) <= 0.006) return 1;
    for (int z = 1; z <= 103; z++) {
        const double own = (double)bp_elements[z].mass;
        if (!is_mass_of(mass, own) || fabs(mass - own) >= least) continue;
        least = fabs(mass - own);
        nearest = (uint8_t)z;
    }
    for (int hydrogens = 1; hydrogens <= 4; hydrogens++) {
        const double off = fabs(mass - carbon - hydrogens * hydrogen);
        if (off > 0.012 || off >= least) continue;
        *united = true;
        return 6;
    }
    return nearest;
}

static bool is_among(const char *name, const char *const *names) {
    for (; *names != NULL; names++)
        if (strcasecmp(name, *names) == 0) return true;
    return false;
}

bool bp_residue_is_water(const char *residue) {
    static const char *const names[] = {"HOH",  "WAT",  "SOL",  "H2O",  "DOD",   "D2O",   "TIP",   "TIP2",
                                        "TIP3", "TIP4", "TIP5", "TP3",  "TP4",   "TP5",   "T3P",   "T4P",
                                        "T5P",  "T3H",  "SPC",  "SPCE", "TIP3P", "TIP4P", "TIP5P", "OH2",
                                        "W",    "PW",   "WN",   "WF",   NULL};
    return is_among(residue, names);
}

bool bp_residue_is_ion(const char *residue) {
    static const char *const names[] = {"NA",  "CL",  "K",   "NA+", "CL-", "K+",  "SOD", "CLA", "POT", "LIT",
                                        "CES", "RUB", "NIO", "CIO", "LI+", "ION", "Na+", "Cl-", NULL};
    return is_among(residue, names);
}

/* Residues whose atoms are those of proteins, nucleic acids and lipids: there, CA is a carbon. */
static bool is_organic(const char *residue) {
    static const char *const names[] = {
        "ALA", "ARG", "ASN", "ASP", "CYS", "GLN", "GLU", "GLY", "HIS", "ILE", "LEU", "LYS", "MET", "PHE",
        "PRO", "SER", "THR", "TRP", "TYR", "VAL", "MSE", "SEC", "HSD", "HSE", "HSP", "HID", "HIE", "HIP",
        "CYX", "ASH", "GLH", "LYN", "CYM", "ACE", "NME", "NH2", "A", "C", "G", "U", "T", "I", "DA", "DC",
        "DG", "DT", "DU",
        /* GROMOS and CHARMM have names of four letters. */
        "ASPH", "ASPP", "GLUH", "GLUP", "LYSH", "ARGN", "CYSH", "CYS1", "CYS2", "HISA", "HISB", "HISH",
        "HIS1", "HIS2", "HISD", "HISE", "HISP", NULL};
    if (is_among(residue, names)) return true;
    /* The same at the ends of a chain, as AMBER names them: NALA, CLYS. */
    return strlen(residue) == 4 && (residue[0] == 'N' || residue[0] == 'C') && is_among(residue + 1, names);
}

bool bp_residue_is_common(const char *residue) {
    return bp_residue_is_water(residue) || bp_residue_is_ion(residue) || is_organic(residue);
}

/* A symbol that none but this element has: names of one letter do not begin so. */
static bool is_certain(const char *symbol) {
    static const char *const symbols[] = {"FE", "ZN", "MG", "MN", "LI", "AL", NULL};
    return is_among(symbol, symbols);
}

uint8_t bp_element_of_name(const char *name, const char *residue, bool fixed, bool *dummy) {
    static const char *const sites[] = {"MW",  "MW1", "MW2",  "MW3",  "MW4", "LP",  "LP1", "LP2",
                                        "EPW", "EP",  "EP1",  "EP2",  "LPA", "LPB", "DUM", "DU",
                                        "M",   "OM",  "MCH3", "MNH3", "MN1", NULL};
    /* CHARMM's names of ions, as atoms and as residues. */
    static const char ions[][4] = {"SOD", "CLA", "POT", "CAL", "LIT", "RUB", "CES", "BAR"};
    static const uint8_t ion_elements[] = {11, 17, 19, 20, 3, 37, 55, 56};
    char text[8] = "", letters[8] = "";
    size_t length = 0, used = 0, begin = 0;
    while (name[begin] == ' ') begin++;
    for (size_t i = begin; name[i] != '\0' && name[i] != ' ' && used < 7; i++) text[used++] = name[i];
    for (size_t i = 0; i < used && length < 7; i++)
        if ((text[i] | 32) >= 'a' && (text[i] | 32) <= 'z')
            letters[length++] = text[i];
        else if (length > 0)
            break;
    const bool organic = is_organic(residue), water = bp_residue_is_water(residue);
    *dummy = is_among(text, sites) && (!organic || text[0] != 'M') && strcasecmp(residue, "ION") != 0;
    if (strcmp(text, "M") == 0 || strcmp(text, "OM") == 0) *dummy = *dummy && water;
    if (*dummy || length == 0) return 0;
    char symbol[3] = {letters[0], letters[1], '\0'};
    const uint8_t two = letters[1] != '\0' ? bp_element_of_symbol(symbol) : 0;
    symbol[1] = '\0';
    /* TI is titanium, and no name of tritium. */
    const uint8_t one = (symbol[0] | 32) != 't' || letters[1] == '\0' ? bp_element_of_symbol(symbol) : two;
    symbol[1] = letters[1];
    /* A residue with the atom's own name is an ion or a metal: CA in CA, ZN in ZN. */
    if (two != 0 && (strncasecmp(residue, symbol, 2) == 0 && strlen(residue) <= 3) &&
        (strlen(residue) == 2 || residue[2] < 'A') && strlen(text) <= 3)
        return two;
    /* GROMOS has the charge in both: CA2+. */
    if (two != 0 && strlen(text) == 4 && strchr("+-", text[3]) != NULL && strcasecmp(residue, text) == 0)
        return two;
    if (two != 0 && strcasecmp(residue, "ION") == 0) return two;
    if (strcasecmp(residue, text) == 0 || strcasecmp(residue, "SOD") == 0 || strcasecmp(residue, "POT") == 0)
        for (size_t i = 0; i < sizeof ions / sizeof *ions; i++)
            if (strcasecmp(residue, ions[i]) == 0) return ion_elements[i];
    if (organic || water) {
        if (strcasecmp(symbol, "SE") == 0) return two;
        return one;
    }
    /* Columns 13 and 14 hold the symbol, right-justified; names of four letters begin in column 13 too. */
    if (fixed && name[0] != ' ' && !(name[0] >= '0' && name[0] <= '9') && two != 0 && name[3] == ' ')
        return two;
    if (fixed && name[0] == ' ') return is_certain(symbol) ? two : one;
    /* Elsewhere: two letters of which the second is small, or one of the few that cannot be anything else. */
    if (two != 0 && letters[1] >= 'a' && letters[1] <= 'z') return two;
    static const char *const metals[] = {"CL", "BR", "FE", "ZN", "MG", "MN", "NA",
                                         "LI", "SI", "SE", "CU", "NI", "AL", NULL};
    if (two != 0 && is_among(symbol, metals)) return two;
    return one != 0 ? one : two;
}

bool bp_element_info(unsigned atomic_number, BpElementInfo *info) {
    if (atomic_number > BP_ELEMENT_MAX) return false;
    const BpElement *const element = &bp_elements[atomic_number];
    *info = (BpElementInfo){.mass = (double)element->mass,
                            .van_der_waals = (double)element->van_der_waals,
                            .covalent = (double)element->covalent};
    memcpy(info->symbol, element->symbol, sizeof element->symbol);
    for (int c = 0; c < 3; c++) info->color[c] = bp_linear_from_srgb(element->color[c] / 255.0);
    return true;
}

unsigned bp_element_of_atom(const char *name, const char *residue) {
    bool dummy;
    return bp_element_of_name(name, residue != NULL ? residue : "", false, &dummy);
}
