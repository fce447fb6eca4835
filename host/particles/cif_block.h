/* cif_block.h: what one data block of a crystal's CIF file says of its crystal.
 *
 * In:    tokens.   Out: cell, operations, sites, as they stand there.
 * Knows: the names of CIF's core dictionary, in all their spellings.   Does not know: where atoms are. */
#ifndef BP_PARTICLES_CIF_BLOCK_H
#define BP_PARTICLES_CIF_BLOCK_H

#include "cif_token.h"
#include "particles.h"
#include "symmetry.h"

/* One row of _atom_site. Texts are numbers in the block's names, 0 where there is none. */
typedef struct CifSite {
    double share[3], place[3]; /* of the cell, in angstrom; NaN: unknown */
    double occupancy, u_iso;   /* in square angstrom; NaN: unknown */
    uint16_t label, symbol, assembly, group;
    bool is_dummy; /* the file says that no atom is there */
} CifSite;

/* Begins as zero; release with cif_block_clear(). */
typedef struct CifBlock {
    double cell[6]; /* lengths in angstrom, angles in degrees */
    bool has_cell[6];
    Symmetry operations, centering; /* the second of magnetic groups */
    char group_name[CIF_TEXT_SIZE]; /* a name or a number; "": none */
    uint64_t group_line;            /* where it stands */
    bool has_shares, has_places;    /* the sites' columns */
    BpNames names;
    CifSite *site;
    size_t site_count, site_capacity;
} CifBlock;

/* A file's tokens; begins as zero. */
typedef struct CifReading {
    CifTokens tokens;
    size_t blocks; /* begun so far */
} CifReading;

/* Reads to the end of the next block, whether it has sites or not. *end: there was none. */
BpStatus cif_block_read(CifReading *reading, Input *input, CifBlock *block, bool *end, BpError *err);
void cif_block_clear(CifBlock *block);
/* Whether a name is one of sites' coordinates in a crystal's file. */
bool cif_block_has_places(const char *name);

#endif
