/* crystal.h: how the cell of a crystal lies in the frame of its coordinates.
 *
 * In:    a frame's cell in the standard frame, the transformation that a file gives.   Out: the cell turned.
 * Knows: that such numbers are rounded, and may be placeholders.   Does not know: how formats write them. */
#ifndef BP_PARTICLES_CRYSTAL_H
#define BP_PARTICLES_CRYSTAL_H

#include "reader.h"

/* Share i of a place along edge i of the cell: row[i][0..2] * place + row[i][3], as SCALEn of PDB and
 * _atom_sites.fract_transf_matrix of mmCIF have it. Begins as zero: nothing is given. */
typedef struct CrystalFrame {
    double row[3][4];
    bool given[3];
} CrystalFrame;

/* The same from the way back, from shares to places: columns 0 to 2 are the edges, and column 3 is the
 * origin. False, and nothing given: the edges span no volume. */
bool crystal_frame_of_edges(CrystalFrame *frame, const double edges[3][4]);

/* Turns the cell that frame_cell_angles() has set, if there is one: its lengths and angles stay, since they
 * have more digits. A transformation that contradicts them by over 1 %, or of which necessary rows are
 * missing, is ignored: then the cell is not repeated, and a note with the name `named` reports that. */
void crystal_turn_cell(BpParticleFile *file, const CrystalFrame *frame, const char *named);

#endif
