/* particles.h: files of particles, and the one form in which all of them are handed over.
 *
 * In:    an open file, or a trajectory of many frames.   Out: one frame of points at a time.
 * Knows: which formats there are.   Does not know: scenes, how points look (style.h), how a file was found.
 *
 * Formats: XYZ (plain and extended), PDB, PQR, mmCIF, CIF, POSCAR, GRO, LAMMPS dump and data, GSD, CSV, PLY;
 * each also packed by gzip. Nothing in a file is trusted: memory grows with what was read and never with what
 * a count promises, and every error names the file, and the line where there are lines. A reader that has to
 * guess reports that in `notes`. Coordinates are as written, in the file's unit of length. */
#ifndef BP_PARTICLES_PARTICLES_H
#define BP_PARTICLES_PARTICLES_H

#include "base/status.h"

#include <math.h>
#include <stdio.h>

typedef enum BpParticleFormat {
    BP_PARTICLES_NONE, /* no file of particles, as far as name and beginning tell */
    BP_PARTICLES_XYZ,
    BP_PARTICLES_PDB,
    BP_PARTICLES_PQR,
    BP_PARTICLES_CIF,
    BP_PARTICLES_CRYSTAL, /* a CIF file that turned out to be a crystal's */
    BP_PARTICLES_POSCAR,
    BP_PARTICLES_GRO,
    BP_PARTICLES_DUMP,
    BP_PARTICLES_DATA,
    BP_PARTICLES_GSD,
    BP_PARTICLES_CSV,
    BP_PARTICLES_PLY,
    BP_PARTICLES_FORMAT_COUNT
} BpParticleFormat;

/* "XYZ", "PDB", ...; static. */
const char *bp_particle_format_name(BpParticleFormat format);

enum {
    BP_PARTICLE_COLUMNS_MAX = 128, /* numeric columns of a file */
    BP_PARTICLE_WANTED_MAX = 56,   /* columns kept at a time */
    BP_PARTICLE_NAME_SIZE =
        1024, /* of the name of an atom, a residue, a chain, a type; longer ones are refused */
    BP_PARTICLE_NOTES_SIZE = 480
};

/* Texts that repeat, each kept once. Number 0 is "". */
typedef struct BpNames {
    char **text;
    size_t count, capacity;
    uint32_t *slots; /* a hash table of numbers */
    size_t slot_count;
} BpNames;

enum {
    BP_PARTICLE_ALTERNATIVE = 1, /* another place of an atom that is shown elsewhere */
    BP_PARTICLE_DUMMY = 2,       /* a site of a model, no atom */
    BP_PARTICLE_ELEMENT_GUESSED = 4,
    BP_PARTICLE_HETERO = 8 /* in a record HETATM */
};

/* Attributes of a particle for its style, beside its position. */
typedef struct BpParticleTag {
    uint16_t name, residue, chain, type; /* into names */
    uint8_t element;                     /* atomic number; 0: unknown */
    uint8_t flags;                       /* BP_PARTICLE_... */
} BpParticleTag;

/* A shape that all particles of a type have. */
typedef struct BpParticleShape {
    const char *kind; /* "polyhedron"; static */
    char *type;       /* that has it */
    double (*vertices)[3];
    size_t vertex_count;
    uint32_t *corners, *ends; /* of its faces, polygons of vertices, counter-clockwise seen from outside: face
                                 f has the corners from ends[f - 1], or 0, to ends[f] */
    size_t face_count;
    uint32_t (*triangles)[3]; /* that the faces are cut into; NULL until someone does */
    size_t triangle_count;
    bool closed;           /* the triangles enclose a body; false until then */
    double capsule_radius; /* above 0: instead of faces, all points so near the line between two vertices */
    double rounding;       /* of edges and corners, which the faces do without; 0: none */
    double radius;         /* of the sphere around its centre that reaches its farthest point */
} BpParticleShape;

/* What a particle is where it is no sphere. */
enum { BP_BODY_SPHERE = 0, BP_BODY_ELLIPSOID = 1, BP_BODY_SHAPES = 2 };
typedef struct BpParticleBody {
    uint32_t kind;        /* BP_BODY_SHAPES + i: shapes[i] */
    float half_axes[3];   /* of an ellipsoid; above 0 */
    float orientation[4]; /* w, x, y, z: the unit quaternion that turns the body */
} BpParticleBody;

/* One frame. Arrays that are Optional are NULL where the file has no such thing. */
typedef struct BpParticles {
    size_t count;
    double (*position)[3];
    BpParticleTag *tag;
    float *radius;           /* Optional; NaN: none */
    float (*color)[3];       /* Optional; linear, in [0, 1] */
    BpParticleBody *body;    /* Optional. The radius is then that of a sphere of an ellipsoid's volume, or a
                                shape's own */
    BpParticleShape *shapes; /* Optional */
    size_t shape_count;
    double *column[BP_PARTICLE_WANTED_MAX]; /* of the wanted columns, in their order; Optional: one that need
                                               not be there; NaN: no value */
    char **column_names; /* Optional: of all columns of numbers, if one need not be there */
    size_t column_count;
    uint32_t *gone; /* Optional: the numbers, rising, of particles of the file that have no place */
    size_t gone_count;
    BpNames names;
    bool has_residue, has_chain, has_type, has_element; /* some particle has one */
    bool has_records;                                   /* the format tells ATOM and HETATM apart */
    bool element_guessed;                               /* some from its name */
    bool has_cell, periodic[3];                         /* along each edge; none where there is no cell */
    double cell_origin[3], cell[3][3]; /* the cell's edges as rows; those that repeat are independent */
    uint32_t (*bonds)[2];              /* Optional: given in the file */
    size_t bond_count;
    bool bonds_partial;    /* the format gives some bonds only (PDB): others are found by distance */
    size_t bonds_left_out; /* given, but between no two atoms of the frame */
    double angstrom;       /* in the file's unit of length; 0: the file's unit is unknown */
    int up;                /* the axis that the format's world has up: 1 y, 2 z */
    bool flat;             /* two dimensions */
    char notes[BP_PARTICLE_NOTES_SIZE]; /* what was guessed: "elements from atom names; ..." */
    size_t capacity, bond_capacity;     /* the arrays' */
} BpParticles;

void bp_particles_clear(BpParticles *particles);
/* Whether the cell repeats along some edge. */
bool bp_particles_repeat(const BpParticles *particles);
/* Adds to the notes what is not there yet. */
void bp_particles_note(BpParticles *particles, const char *format, ...) BP_PRINTF_LIKE(2, 3);

typedef struct BpParticleFile BpParticleFile;

/* Detects the format by the ending of the name and the beginning of the stream, which is read to its first
 * kilobytes and set back. What a file itself declares takes precedence over its name. BP_PARTICLES_NONE:
 * neither tells. */
BpParticleFormat bp_particle_format_find(const char *name, FILE *stream);

/* Opens a file for its frames. `stream`: a regular file, which stays the caller's and must outlive the
 * result; `name` stands in messages. `wanted`: the columns to keep, by name; a frame without one of the first
 * `needed` is an error that names those that are there. */
BpStatus bp_particle_file_open(FILE *stream, const char *name, BpParticleFormat format,
                               const char *const *wanted, size_t wanted_count, size_t needed,
                               BpParticleFile **file, BpError *err);
/* Reads the next frame into `particles`, which holds a frame or is zeroed; NULL: passes over it, and looks
 * only at what is needed for that. *end: there was none. The first frame of a file must exist. A later one
 * that breaks off at the end of the file, as while it is being written, does not count; a fault before the
 * end of the file is an error in any frame. */
BpStatus bp_particle_file_next(BpParticleFile *file, BpParticles *particles, bool *end, BpError *err);
/* Reads frame `number`, counted from 0; below 0 from the end: -1 is the last. */
BpStatus bp_particle_file_frame(BpParticleFile *file, int64_t number, BpParticles *particles, BpError *err);
/* Counts the frames, which reads the whole file unless it has an index. */
BpStatus bp_particle_file_count(BpParticleFile *file, uint64_t *count, BpError *err);
void bp_particle_file_close(BpParticleFile **file);

#endif
