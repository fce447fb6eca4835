/* reader.h: the interface that every format's reader has, and how it hands points over.
 *
 * In:    an input.   Out: calls of frame_begin and frame_add.
 * Knows: what all formats share.   Does not know: which formats there are.
 *
 * A reader is one function that reads one frame. It is called repeatedly until it reports that there are no
 * more. */
#ifndef BP_PARTICLES_READER_H
#define BP_PARTICLES_READER_H

#include "color_range.h"
#include "input.h"
#include "particles.h"

/* What stands behind a frame that was read, in formats whose frames tell how many particles they have. */
typedef enum Behind {
    BEHIND_FRAME_OR_END,
    BEHIND_TEXT,     /* of another kind, and so no more frames */
    BEHIND_PARTICLES /* more than the frame tells: its number is wrong */
} Behind;

struct BpParticleFile {
    Input input;
    BpParticleFormat format;
    char wanted[BP_PARTICLE_WANTED_MAX][64];
    size_t wanted_count, needed; /* the first `needed` must be in every frame */
    uint64_t frame;              /* the number of the next frame */
    uint64_t frame_count;        /* once it is known */
    bool frame_count_known;      /* from an index, or from reading all */
    bool cut;                    /* behind the last whole frame there is a part of another */
    Behind behind;
    BpParticles *out;   /* where frame_add puts points; NULL: nowhere */
    size_t taken_count; /* how many wanted columns this frame has; 0 when it is passed over */
    int wanted_column[BP_PARTICLE_WANTED_MAX];   /* which columns of the frame these are */
    size_t wanted_place[BP_PARTICLE_WANTED_MAX]; /* and which of the wanted */
    size_t added;                                /* in this frame, with those that were left out */
    uint32_t *gone;                              /* the numbers of those that were left out, rising */
    size_t gone_count, gone_capacity;
    struct {
        uint64_t bodies;          /* in this frame: ellipsoids, and what has another shape */
        uint64_t flat;            /* ellipsoids with an axis of 0 */
        uint64_t super;           /* superellipsoids, which are nearer to boxes or stars */
        uint64_t scaled, without; /* quaternions whose length is not 1, or that have no direction */
        bool has_orientations;    /* set by the reader after frame_begin */
        const char *order;        /* set by the reader: how it read those that do not say it; NULL: they do */
    } shapes;
    /* Columns of this frame that seem to hold colours, and axes of ellipsoids; "". A reader that reads the
     * latter empties it. */
    char unread_color[32], unread_shape[32];
    ColorRange colors; /* of this frame; what the type says of them, the reader sets after frame_begin */
    void *state;       /* of the format's reader, freed with the file */
};

/* One particle. Texts may be NULL and are copied; those of BP_PARTICLE_NAME_SIZE bytes and more are
 * refused, since names that were cut could become equal. */
typedef struct Particle {
    double position[3]; /* NaN: it has no place */
    const char *name, *residue, *chain, *type;
    uint8_t element, flags;
    double radius;         /* NaN: none */
    double color[3];       /* color[0] NaN: none; else numbers of any scale (color_range.h) */
    const double *values;  /* of the columns named to frame_begin */
    double half_axes[3];   /* of an ellipsoid, which has no other radius; all 0: it is none */
    double orientation[4]; /* w, x, y, z, of any length */
    uint32_t body;         /* BP_BODY_SPHERE, or BP_BODY_SHAPES and more: a shape of out->shapes */
    bool super;            /* the ellipsoid is a superellipsoid */
} Particle;

#define PARTICLE_NONE                                                                                        \
    {                                                                                                        \
        .radius = NAN, .color = {NAN, NAN, NAN}, .orientation = { 1, 0, 0, 0 }                               \
    }

/* The line behind a frame, other than blank ones, which stays to be taken; NULL: the file ends, or cannot be
 * read on, as the next frame will report. The line is a copy in `text`, and may be cut. */
const char *frame_line_behind(BpParticleFile *file, char text[1024]);
/* Fails, since there are more particles than the frame's `number`: "the number above them". */
BpStatus frame_fail_behind(BpParticleFile *file, const char *number, BpError *err);
/* Begins a frame whose numeric columns are `columns`; fails if a wanted one is not among them. */
BpStatus frame_begin(BpParticleFile *file, const char *const *columns, size_t column_count, BpError *err);
/* Hands one particle over. One without a place (a coordinate that is NaN) is left out and counted. Fails on
 * coordinates that are infinite or too large, and on colours that can be none. `with_line`: the error names
 * the line last taken. */
BpStatus frame_add(BpParticleFile *file, const Particle *particle, bool with_line, BpError *err);
static inline bool particle_has_place(const Particle *particle) {
    const double *const place = particle->position;
    return !isnan(place[0]) && !isnan(place[1]) && !isnan(place[2]);
}
/* The place among the particles that are left of the one with a number, counted as they were handed over,
 * from 0; UINT32_MAX: it was left out. */
uint32_t frame_place(const BpParticleFile *file, uint32_t number);
/* Gives the particle of that number a radius; one that is not above 0 is ignored. */
BpStatus frame_set_radius(BpParticleFile *file, uint32_t number, double radius, BpError *err);
/* `a` and `b` count the particles as they were handed over, from 0, with those that were left out. A bond of
 * one that was left out is too. */
BpStatus frame_add_bond(BpParticleFile *file, uint32_t a, uint32_t b, BpError *err);
/* After all of a frame: makes its colours linear, and notes what was left out and decided. */
BpStatus frame_end(BpParticleFile *file, BpError *err);
/* An atom whose name and residue are set (atom.c): its element, from `symbol` where the file has one ("":
 * none), else from its name, and then it is a guess; or no element, for a site of a model. `name`, `fixed`:
 * as bp_element_of_name() has them. */
void atom_identify(Particle *atom, const char *symbol, const char *name, bool fixed);
/* Notes what became of masses where elements were sought for `count` things ("types"): they are taken for all
 * of them or for none. `united`: some are carbons of united atoms. */
void atom_note_masses(BpParticles *particles, size_t known, size_t count, const char *things, bool united);

/* A cell from its lengths and angles in degrees (crystallography's convention: a along x, b in the plane of x
 * and y), its origin at 0. Cells that are none (lengths of 0 or 1, as placeholders) are passed over. */
void frame_cell_angles(BpParticleFile *file, const double lengths[3], const double angles[3]);
/* The edges of that cell, the rows, of any size. False: there is none of these lengths and angles. */
bool frame_edges_of_angles(const double lengths[3], const double angles[3], double edges[3][3]);
/* A cell from its edges, the rows, and which of them repeat. One without length does not; if those that do
 * span nothing, none does, and a note reports that. */
void frame_cell(BpParticleFile *file, const double origin[3], const double edges[3][3],
                const bool periodic[3]);
#define FRAME_PERIODIC ((const bool[3]){true, true, true})

/* Notes how many particles of the frame have another shape than the sphere that is drawn: `kind` is
 * "ellipsoid", for example, and 0 notes nothing. */
void frame_note_shapes(BpParticleFile *file, uint64_t count, const char *kind);
/* Makes the particle of that number an ellipsoid, as frame_add does. */
BpStatus frame_set_ellipsoid(BpParticleFile *file, uint32_t number, const double half_axes[3],
                             const double orientation[4], BpError *err);

/* Of frame_add() (frame_shapes.c): the body of particle p->count, and its radius. */
BpStatus frame_add_body(BpParticleFile *file, Particle *particle, bool with_line, BpError *err);
/* After all of a frame: notes what became of axes and orientations. */
void frame_end_shapes(BpParticleFile *file);
void particle_shape_clear(BpParticleShape *shape);

typedef BpStatus ReadFrame(BpParticleFile *file, bool *end, BpError *err);
ReadFrame read_xyz, read_pdb, read_cif, read_crystal, read_poscar, read_gro, read_dump, read_data, read_gsd,
    read_csv, read_ply;

/* Releases what a GSD file's index takes. */
void gsd_state_destroy(void *state);
/* Release what the readers of tables, of PDB, of mmCIF, of crystals' and of VASP's files keep from frame to
 * frame. */
void csv_state_destroy(void *state);
void pdb_state_destroy(void *state);
void cif_state_destroy(void *state);
void crystal_state_destroy(void *state);
void poscar_state_destroy(void *state);
/* Whether frames follow the first one, after which `text_follows` or not. */
bool pdb_has_more(const void *state, bool text_follows);
bool cif_has_more(const void *state);
bool crystal_has_more(const void *state);
bool poscar_has_more(const void *state, bool text_follows);
bool csv_has_more(const void *state);
BpStatus gsd_frame_count(BpParticleFile *file, uint64_t *count, BpError *err);

#endif
