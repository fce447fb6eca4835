/* pdb_atom.h: the line of one atom, in a PDB file and in a PQR file.
 *
 * In:    a line that begins with ATOM or HETATM.   Out: the atom that it describes.
 * Knows: columns and words of such lines, and how programs write numbers that do not fit.   Does not know:
 * which other lines there are. */
#ifndef BP_PARTICLES_PDB_ATOM_H
#define BP_PARTICLES_PDB_ATOM_H

#include "reader.h"

typedef struct PdbAtom {
    Particle particle; /* whose texts are those below, as `values` are its values */
    char name[8], residue[8], chain[8];
    char serial[12], site[32], letter[2]; /* as in pdb_connect.h and places.h */
    bool numbered;
    double values[3]; /* of pdb_columns or pqr_columns */
} PdbAtom;

enum { PDB_COLUMN_COUNT = 3 };
extern const char *const pdb_columns[PDB_COLUMN_COUNT], *const pqr_columns[PDB_COLUMN_COUNT];

/* Whether a line begins with that name, in letters of either case, as other readers have it. */
bool pdb_is_record(const char *line, const char *name);
bool pdb_is_atom(const char *line);
/* How a program writes lines of atoms, as far as those before tell; all false at the beginning of a file. */
typedef struct PdbForm {
    bool names_left;  /* some name of one letter stood at the left end of its columns, so these tell no
                         elements */
    bool wide_chains; /* names of chains have two letters, in columns 21 and 22 */
} PdbForm;

/* PDB: fixed columns. Fails without coordinates. */
BpStatus pdb_read_atom(const Input *input, const char *line, PdbAtom *atom, PdbForm *form, BpError *err);
/* PQR (PDB2PQR, APBS): words, of which the last are x, y, z, charge and radius, all in angstrom and
 * elementary charges, and perhaps an element; numbers with signs may touch. */
BpStatus pqr_read_atom(const Input *input, const char *line, PdbAtom *atom, BpError *err);

#endif
