/* style_bonds.h: bonds and the cell, as capsules.
 *
 * In:    bonds, particles that are spheres already.   Out: capsules.
 * Knows: which bonds can be drawn.   Does not know: how bonds are found (bonds.h). */
#ifndef BP_PARTICLES_STYLE_BONDS_H
#define BP_PARTICLES_STYLE_BONDS_H

#include "style_job.h"

/* Each half in the colour of its end. Bonds across the cell are left out, since their ends lie apart. */
BpStatus bp_style_put_bonds(BpStyleJob *job, BpError *err);
/* The edges of the cell. BP_ERR_SCENE: there is none. */
BpStatus bp_style_put_box(BpStyleJob *job, BpError *err);

#endif
