/* read_crystal.c: CIF files of crystals: the sites of a data block, repeated by its operations; see reader.h.
 *
 * Each block that has sites is a frame, whose atoms fill one cell. Cartesian sites without symmetry stay
 * where they are. */
#include "base/plural.h"
#include "disorder.h"
#include "elements.h"
#include "lattice.h"
#include "reader.h"
#include "scene/vector.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Shares from here on belong to the next cell: a third of four digits times three is no 1. */
#define WRAP 0.9995
/* The height of a cell above its base, in parts of its edge. */
#define FLATTEST 1.0e-3

typedef struct State {
    CifReading reading;
    CifBlock block;
    size_t frames;  /* read so far */
    bool more;      /* behind the first block are others with sites */
    CellAtom *atom; /* of each particle of the frame */
    size_t atom_count, atom_capacity;
} State;

void crystal_state_destroy(void *state) {
    State *const crystal = state;
    if (crystal == NULL) return;
    cif_block_clear(&crystal->block);
    free(crystal->atom);
    free(crystal);
}

bool crystal_has_more(const void *state) {
    return ((const State *)state)->more;
}

/* A place of a site in the cell, as shares, and by which operation it comes. */
typedef struct Image {
    double share[3];
    uint16_t operation;
} Image;

/* ---- the space group --------------------------------------------------------------------------------------
 */

/* Whether a name or number is that of the group without symmetry. */
static bool is_p1(const char *name) {
    char plain[CIF_TEXT_SIZE];
    size_t length = 0;
    for (const char *c = name; *c != '\0'; c++)
        if (*c != ' ' && *c != '_') plain[length++] = *c;
    plain[length] = '\0';
    return strcasecmp(plain, "P1") == 0 || strcmp(plain, "1") == 0;
}

/* Completes the operations; the identity is the first one. */
static BpStatus find_operations(BpParticleFile *file, CifBlock *block, Symmetry *symmetry, BpError *err) {
    const bool is_named = block->group_name[0] != '\0' && !is_p1(block->group_name);
    BP_TRY(symmetry_add(symmetry, &symmetry_identity, err));
    for (size_t i = 0; i < block->operations.count; i++)
        BP_TRY(symmetry_add(symmetry, &block->operations.operation[i], err));
    BP_TRY(symmetry_multiply(symmetry, &block->centering, err));
    if (is_named && block->operations.count == 0) {
        BpStatus status = input_fail(&file->input, false, err,
                                     "found the space group \"%s\" without its operations, which say where "
                                     "the other atoms are, expected "
                                     "_space_group_symop_operation_xyz; ASE adds them, for example: python3 "
                                     "-c \"from ase.io import *; "
                                     "write('new.cif', read('old.cif'))\"",
                                     block->group_name);
        bp_error_at(err, file->input.name, (int)block->group_line, 0);
        return status;
    }
    if (is_named && symmetry->count == 1)
        bp_particles_note(file->out, "no symmetry operation but x,y,z, though the space group is %s",
                          block->group_name);
    else if (block->has_shares && block->operations.count == 0 && block->group_name[0] == '\0')
        bp_particles_note(file->out, "no symmetry in the file, so these are its sites alone");
    return BP_OK;
}

/* ---- the cell
 * ----------------------------------------------------------------------------------------------- */

/* Sets the cell if there is one; needed: the sites are shares of it. */
static BpStatus put_cell(BpParticleFile *file, CifBlock *block, bool needed, BpError *err) {
    const bool *const has = block->has_cell;
    if (!has[0] || !has[1] || !has[2]) {
        if (!needed) return BP_OK;
        return input_fail(&file->input, false, err,
                          "found shares of a cell (_atom_site_fract_x) without its lengths, expected "
                          "_cell_length_a, b and c");
    }
    for (int i = 3; i < 6; i++) {
        if (has[i]) continue;
        block->cell[i] = 90; /* as the dictionary says */
        bp_particles_note(file->out, "angles of the cell that are missing taken as 90 degrees");
    }
    static const double origin[3] = {0, 0, 0};
    double edges[3][3];
    if (frame_edges_of_angles(&block->cell[0], &block->cell[3], edges) &&
        edges[1][1] > FLATTEST * block->cell[1] && edges[2][2] > FLATTEST * block->cell[2])
        frame_cell(file, origin, (const double(*)[3])edges, FRAME_PERIODIC);
    if (file->out->has_cell && bp_particles_repeat(file->out)) return BP_OK;
    if (!needed) return BP_OK;
    return input_fail(
        &file->input, false, err,
        "found a cell of lengths %g, %g, %g and angles %g, %g, %g, expected one with a volume, in "
        "angstrom and degrees",
        block->cell[0], block->cell[1], block->cell[2], block->cell[3], block->cell[4], block->cell[5]);
}

/* Whether two places, in shares, are one in some image of the cell. */
static bool are_same(const BpLattice *cell, const double height[3], const double a[3], const double b[3]) {
    double share[3], way[3] = {0};
    for (int i = 0; i < 3; i++) {
        share[i] = b[i] - a[i];
        share[i] -= floor(share[i] + 0.5);
        if (fabs(share[i]) * height[i] >= DISORDER_SAME) return false;
    }
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) way[k] += share[i] * cell->edges[i][k];
    return bp_dot(way, way) < DISORDER_SAME * DISORDER_SAME;
}

static void wrap(double share[3]) {
    for (int i = 0; i < 3; i++) {
        share[i] -= floor(share[i]);
        if (share[i] >= WRAP) share[i] -= 1;
    }
}

/* The images of a site that differ: up to SYMMETRY_MAX. Returns how many. */
static size_t find_images(const BpLattice *cell, const double share[3], const Symmetry *symmetry,
                          Image *image) {
    size_t count = 0;
    double height[3];
    for (int i = 0; i < 3; i++) height[i] = bp_lattice_height(cell, i);
    for (size_t s = 0; s < symmetry->count; s++) {
        Image *const next = &image[count];
        bool again = false;
        symmetry_apply(&symmetry->operation[s], share, next->share);
        wrap(next->share);
        next->operation = (uint16_t)s;
        for (size_t i = 0; i < count && !again; i++)
            again = are_same(cell, height, image[i].share, next->share);
        count += !again;
    }
    return count;
}

/* ---- atoms
 * -------------------------------------------------------------------------------------------------- */

static bool is_among(const char *text, const char *const *words) {
    for (; *words != NULL; words++)
        if (strcasecmp(text, *words) == 0) return true;
    return false;
}

/* The element of a symbol, or of a label, which begins with one. Minerals have labels of their own for water,
 * for sites of several elements (T1, M2) and for empty ones. */
static void identify(Particle *atom, const char *symbol, const char *label) {
    static const char *const water[] = {"Wat", "H2O", "OH2", "HOH", "H3O", NULL}, *const vacancies[] = {
                                                                                      "Va", "Vac", "Vacancy",
                                                                                      "X", NULL};
    const char *const text = symbol[0] != '\0' ? symbol : label;
    char letters[16];
    snprintf(letters, sizeof letters, "%.*s",
             (int)strspn(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"), text);
    bool dummy = false;
    if (is_among(letters, vacancies)) {
        atom->flags |= BP_PARTICLE_DUMMY;
    } else if (is_among(letters, water) || strncasecmp(text, "H2O", 3) == 0 ||
               strncasecmp(text, "H3O", 3) == 0) {
        atom->element = 8;
    } else {
        if (symbol[0] != '\0') atom->element = bp_element_of_species(symbol);
        const bool is_common = atom->element > 0 && atom->element <= 103; /* NH is no nihonium */
        const bool is_site = symbol[0] == '\0' && strcmp(letters, "T") == 0;
        if (!is_common && !is_site) atom->element = bp_element_of_name(text, "", false, &dummy);
    }
    if (atom->element == 0) atom->type = text;
}

static BpStatus keep_atom(State *state, uint32_t site, uint16_t operation, BpError *err) {
    if (state->atom_count == state->atom_capacity) {
        const size_t capacity = state->atom_capacity > 0 ? 2 * state->atom_capacity : 256;
        CellAtom *const grown = realloc(state->atom, capacity * sizeof *grown);
        if (grown == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for %zu atoms", capacity);
        state->atom = grown;
        state->atom_capacity = capacity;
    }
    state->atom[state->atom_count++] = (CellAtom){site, operation};
    return BP_OK;
}

/* One atom of a site, at a place in angstrom. */
static BpStatus add_atom(BpParticleFile *file, State *state, uint32_t number, uint16_t operation,
                         const double place[3], BpError *err) {
    const CifSite *const site = &state->block.site[number];
    const BpNames *const names = &state->block.names;
    Particle particle = PARTICLE_NONE;
    const double values[2] = {site->occupancy, site->u_iso};
    memcpy(particle.position, place, sizeof particle.position);
    const char *const label = site->label != 0 ? names->text[site->label] : "",
                      *const symbol = site->symbol != 0 ? names->text[site->symbol] : "";
    particle.name = label[0] != '\0' ? label : symbol;
    particle.values = values;
    identify(&particle, symbol, label);
    if (site->is_dummy || site->occupancy <= 0) particle.flags |= BP_PARTICLE_DUMMY;
    BP_TRY(frame_add(file, &particle, false, err));
    return particle_has_place(&particle) ? keep_atom(state, number, operation, err) : BP_OK;
}

static BpStatus add_site(BpParticleFile *file, State *state, const BpLattice *cell, const Symmetry *symmetry,
                         uint32_t number, Image *image, BpError *err) {
    const double *const share = state->block.site[number].share;
    if (isnan(share[0]) || isnan(share[1]) || isnan(share[2]))
        return add_atom(file, state, number, 0, share, err);
    const size_t count = find_images(cell, share, symmetry, image);
    for (size_t i = 0; i < count; i++) {
        double place[3] = {0};
        for (int e = 0; e < 3; e++)
            for (int k = 0; k < 3; k++) place[k] += image[i].share[e] * cell->edges[e][k];
        BP_TRY(add_atom(file, state, number, image[i].operation, place, err));
    }
    return BP_OK;
}

static BpStatus fill_cell(BpParticleFile *file, State *state, const Symmetry *symmetry, BpError *err) {
    BpLattice cell = {0};
    BpStatus status = BP_OK;
    Image *const image = malloc(SYMMETRY_MAX * sizeof *image);
    if (image == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the images of a site");
    bp_lattice_scale(&cell, file->out->cell_origin, (const double(*)[3])file->out->cell);
    for (size_t s = 0; s < state->block.site_count && status == BP_OK; s++)
        status = add_site(file, state, &cell, symmetry, (uint32_t)s, image, err);
    free(image);
    return status;
}

/* Notes what was done with the sites. */
static void note_sites(BpParticles *p, const CifBlock *block, const Symmetry *symmetry) {
    size_t partial = 0;
    for (size_t s = 0; s < block->site_count; s++)
        partial += block->site[s].occupancy < 0.999 && block->site[s].occupancy > 0;
    if (symmetry->count > 1)
        bp_particles_note(p, "%zu site%s by %zu symmetry operations", block->site_count,
                          bp_plural(block->site_count), symmetry->count);
    if (partial > 0) bp_particles_note(p, "%zu site%s partly occupied", partial, bp_plural(partial));
}

/* Cartesian sites of a cell with symmetry as shares of it. */
static void find_shares(const BpParticles *p, CifBlock *block) {
    BpLattice cell = {0};
    bp_lattice_scale(&cell, p->cell_origin, (const double(*)[3])p->cell);
    for (size_t s = 0; s < block->site_count; s++) {
        CifSite *const site = &block->site[s];
        int32_t whole[3];
        bp_lattice_shares(&cell, site->place, site->share, whole);
    }
}

static BpStatus take_atoms(BpParticleFile *file, State *state, BpError *err) {
    CifBlock *const block = &state->block;
    Symmetry symmetry = {0};
    if (!block->has_shares && !block->has_places)
        return input_fail(&file->input, false, err,
                          "found sites without all of _atom_site_fract_x, y and z, expected these or "
                          "_atom_site_Cartn_x, y and z");
    BP_TRY(put_cell(file, block, block->has_shares, err));
    BpStatus status = find_operations(file, block, &symmetry, err);
    const bool repeats = block->has_shares || (symmetry.count > 1 && file->out->has_cell);
    if (status == BP_OK && !block->has_shares && repeats) find_shares(file->out, block);
    if (status == BP_OK && repeats) status = fill_cell(file, state, &symmetry, err);
    for (size_t s = 0; s < block->site_count && status == BP_OK && !repeats; s++)
        status = add_atom(file, state, (uint32_t)s, 0, block->site[s].place, err);
    if (status == BP_OK) note_sites(file->out, block, &symmetry);
    symmetry_clear(&symmetry);
    return status;
}

static BpStatus take_frame(BpParticleFile *file, State *state, BpError *err) {
    static const char *const columns[] = {"occupancy", "u_iso"};
    state->atom_count = 0;
    BP_TRY(frame_begin(file, columns, 2, err));
    if (file->out == NULL) return BP_OK;
    file->out->angstrom = 1;
    file->out->up = 2;
    BP_TRY(take_atoms(file, state, err));
    if (file->out->count == 0) {
        file->input.ended = false; /* nothing is missing behind */
        return input_fail(&file->input, false, err,
                          "found no site with a place, expected numbers in _atom_site_fract_x");
    }
    return bp_particles_repeat(file->out) ? disorder_mark(file->out, &state->block, state->atom, err) : BP_OK;
}

/* ---- blocks
 * ------------------------------------------------------------------------------------------------- */

/* The next block that has sites. *end: there is none. */
static BpStatus find_block(Input *input, State *state, bool *end, BpError *err) {
    do BP_TRY(cif_block_read(&state->reading, input, &state->block, end, err));
    while (!*end && state->block.site_count == 0);
    return BP_OK;
}

/* Looks behind the first block with sites for another one, then goes back. What is wrong there is no fault of
 * the first. */
static BpStatus look_behind(Input *input, State *state, BpError *err) {
    const size_t blocks = state->reading.blocks;
    CifBlock block = {0};
    bool end = false;
    while (!end && block.site_count == 0 &&
           cif_block_read(&state->reading, input, &block, &end, NULL) == BP_OK) {
    }
    state->more = !end;
    if (!end) {
        state->reading = (CifReading){0};
        BP_TRY(input_rewind(input, err));
        while (state->reading.blocks < blocks)
            BP_TRY(cif_block_read(&state->reading, input, &block, &end, err));
    }
    cif_block_clear(&block);
    return BP_OK;
}

BpStatus read_crystal(BpParticleFile *file, bool *end, BpError *err) {
    Input *const input = &file->input;
    if (file->state == NULL) file->state = calloc(1, sizeof(State));
    State *const state = file->state;
    if (state == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    BP_TRY(find_block(input, state, end, err));
    if (*end && state->frames == 0)
        return input_fail(
            input, false, err,
            "found no sites, expected a crystal's (loop_ _atom_site_label _atom_site_fract_x ...)");
    if (*end) return BP_OK;
    BP_TRY(take_frame(file, state, err));
    return state->frames++ == 0 ? look_behind(input, state, err) : BP_OK;
}
