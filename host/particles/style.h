/* style.h: how particles are to look: what is shown, sizes, colours, bonds, the cell.
 *
 * In:    nothing.   Out: a style; the columns of a file that it needs or wants.
 * Knows: what can be chosen.   Does not know: how files are read, what is made of particles (add_to_scene.h).
 */
#ifndef BP_PARTICLES_STYLE_H
#define BP_PARTICLES_STYLE_H

#include "colormap.h"
#include "select.h"

typedef enum BpStyleKind { BP_STYLE_SPACEFILL, BP_STYLE_BALL_AND_STICK } BpStyleKind;

typedef enum BpRadiusBy {
    BP_RADIUS_AUTO,
    BP_RADIUS_CONSTANT,
    BP_RADIUS_VDW,
    BP_RADIUS_COVALENT,
    BP_RADIUS_COLUMN
} BpRadiusBy;

typedef enum BpColorBy {
    BP_COLOR_AUTO,
    BP_COLOR_CONSTANT,
    BP_COLOR_ELEMENT,
    BP_COLOR_CHAIN,
    BP_COLOR_RESIDUE,
    BP_COLOR_TYPE,
    BP_COLOR_COLUMN
} BpColorBy;

enum {
    BP_STYLE_NAMED_MAX = 128,
    BP_STYLE_NAME_SIZE = 256,
    BP_STYLE_LABEL_SIZE = 192,
    BP_STYLE_UNIT_SIZE = 56
};

/* The value of one element or type, instead of its default. */
typedef struct BpStyleNamed {
    char name[BP_STYLE_NAME_SIZE];
    double value[3]; /* of a radius: the first */
} BpStyleNamed;

typedef struct BpParticleStyle {
    BpExpression *select; /* Optional, owned: only particles for which it holds are shown, and all of these */
    BpExpression *radius_value, *color_value; /* Optional, owned: in place of the column */
    BpStyleKind kind;
    BpRadiusBy radius_by;
    double radius; /* constant; otherwise the factor */
    char radius_column[64];
    BpStyleNamed radii[BP_STYLE_NAMED_MAX]; /* by type, or by element's symbol */
    size_t radius_count;
    BpColorBy color_by;
    double color[3];       /* constant, linear */
    char color_column[64]; /* of a value, its text, which may be cut */
    BpColormap map;
    bool has_range;
    double range[2];
    bool bar;                        /* a colour bar is wanted */
    char label[BP_STYLE_LABEL_SIZE]; /* beside it; "": the name of the column */
    char unit[BP_STYLE_UNIT_SIZE];   /* of its numbers; "": none is written */
    BpStyleNamed colors[BP_STYLE_NAMED_MAX];
    size_t color_count;
    bool bonds;         /* drawn as capsules */
    double bond_radius; /* 0: by the style */
    bool box, solvent, whole;
    bool shapes; /* what is no sphere is drawn as it is; else as a sphere too */
} BpParticleStyle;

/* Space-filling, everything by what the file has, solvent hidden, molecules whole. */
void bp_particle_style_defaults(BpParticleStyle *style);
void bp_particle_style_clear(BpParticleStyle *style);

/* The linear colour that the style's colormap has at `share`: its albedo. */
void bp_particle_style_map(const BpParticleStyle *style, double share, double color[3]);

/* The columns that a file is to be opened with, of which it must have the first `needed`. */
typedef struct BpStyleColumns {
    const char *name[BP_PARTICLE_WANTED_MAX];
    size_t count, needed;
} BpStyleColumns;
void bp_particle_style_columns(const BpParticleStyle *style, BpStyleColumns *columns);

#endif
