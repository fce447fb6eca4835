/* pdb_connect.h: the connections that a PDB file gives in its records CONECT.
 *
 * In:    lines of CONECT, the serial numbers of atoms.   Out: bonds between atoms of a frame.
 * Knows: the columns of serial numbers, what serial numbers mean.   Does not know: where such lines stand.
 *
 * Serial numbers are compared as texts, except that leading zeros do not count: files of more than 99,999
 * atoms continue with letters (hybrid-36, hexadecimal numbers), or with six digits. */
#ifndef BP_PARTICLES_PDB_CONNECT_H
#define BP_PARTICLES_PDB_CONNECT_H

#include "reader.h"

/* Pairs of serial numbers, and how many of a line's numbers could not be read. Begins as zero; release
 * `pair` with free(). */
typedef struct PdbLinks {
    uint64_t (*pair)[2];
    size_t count, capacity, unreadable;
} PdbLinks;

/* The serial numbers of a frame's atoms, in their order. Begins as zero; release `key` with free(). */
typedef struct PdbSerials {
    uint64_t *key;
    size_t count, capacity;
    size_t longest; /* in bytes */
} PdbSerials;

/* Takes the serial number of an atom, "" if it has none. */
BpStatus pdb_take_serial(PdbSerials *serials, const char *text, BpError *err);
/* Takes a line of CONECT, which follows atoms with these serial numbers: in columns as wide as those, or
 * words between blanks. */
BpStatus pdb_take_links(PdbLinks *links, const PdbSerials *serials, const char *line, BpError *err);
/* Hands the links over as bonds. What cannot be one is counted in the frame's bonds_left_out: atoms that do
 * not exist, or whose number several atoms have. */
BpStatus pdb_add_bonds(BpParticleFile *file, const PdbLinks *links, const PdbSerials *serials, BpError *err);

#endif
