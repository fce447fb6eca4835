/* fuzz_particles.c: any bytes as a file of particles of one format, FORMAT, for which it is built: one target
 * for each reader. The first byte says, from 128 on, that the column "x" is wanted, and from 192 on that it
 * need not be there; the rest is the file.
 *
 * What is accepted is whole: arrays of one length, finite places, names and bonds that exist, and neighbours
 * are found whatever the cell. Frames are read
 * one after the other, passed over, and asked for by number, and each way finds as many. */
#include "formats/particle_shapes.h"
#include "fuzz.h"
#include "particles/elements.h"
#include "particles/molecules.h"
#include "particles/reader.h"
#include "particles/spacing.h"

#include <unistd.h>

enum { FRAMES_MAX = 64 };

static void check_particles(const BpParticles *p) {
    require(p->count <= p->capacity || p->count == 0);
    for (size_t i = 0; i < p->count; i++) {
        for (int c = 0; c < 3; c++) require(p->position[i][c] >= -1e12 && p->position[i][c] <= 1e12);
        const BpParticleTag *tag = &p->tag[i];
        require(tag->element <= BP_ELEMENT_MAX);
        require(tag->name < p->names.count || tag->name == 0);
        require(tag->residue < p->names.count || tag->residue == 0);
        require(tag->chain < p->names.count || tag->chain == 0);
        require(tag->type < p->names.count || tag->type == 0);
        if (p->color != NULL && !isnan(p->color[i][0]))
            for (int c = 0; c < 3; c++) require(p->color[i][c] >= 0 && p->color[i][c] <= 1);
    }
    for (size_t b = 0; b < p->bond_count; b++)
        require(p->bonds[b][0] < p->count && p->bonds[b][1] < p->count);
    for (int i = 0; i < 3 && p->has_cell; i++)
        for (int c = 0; c < 3; c++) require(isfinite(p->cell[i][c]) && isfinite(p->cell_origin[c]));
}

/* Bodies have a kind that exists, axes and a unit quaternion; faces have corners that exist, and are cut or
 * refused. */
static void check_bodies(BpParticles *p) {
    BpError err = {0};
    for (size_t i = 0; i < p->count && p->body != NULL; i++) {
        const BpParticleBody *const body = &p->body[i];
        double square = 0;
        require(body->kind < BP_BODY_SHAPES + p->shape_count);
        if (body->kind == BP_BODY_SPHERE) continue;
        for (int k = 0; k < 4; k++) square += (double)body->orientation[k] * (double)body->orientation[k];
        require(square > 0.999 && square < 1.001 && p->radius != NULL && isfinite(p->radius[i]));
        for (int k = 0; k < 3 && body->kind == BP_BODY_ELLIPSOID; k++)
            require(body->half_axes[k] > 0 && body->half_axes[k] <= 1e12f);
    }
    for (size_t s = 0; s < p->shape_count; s++) {
        const BpParticleShape *const shape = &p->shapes[s];
        require(isfinite(shape->radius) && shape->type != NULL);
        for (size_t f = 0, c = 0; f < shape->face_count; f++) {
            require(shape->ends[f] >= c + 3);
            for (; c < shape->ends[f]; c++) require(shape->corners[c] < shape->vertex_count);
        }
    }
    const BpStatus status = bp_cut_particle_shapes(p, &err);
    require(status == BP_OK || status == BP_ERR_SCENE);
    for (size_t s = 0; s < p->shape_count && status == BP_OK; s++)
        for (size_t t = 0; t < p->shapes[s].triangle_count; t++)
            for (int k = 0; k < 3; k++) require(p->shapes[s].triangles[t][k] < p->shapes[s].vertex_count);
    bp_error_clear(&err);
}

/* What looks for neighbours takes any cell, and what it finds exists. */
static void check_neighbours(BpParticles *p) {
    enum { MOST = 64 };
    bool shown[MOST];
    BpBonds bonds;
    BpError err = {0};
    double spacing = NAN;
    size_t moved = 0;
    if (p->count == 0 || p->count > MOST) return;
    for (size_t i = 0; i < p->count; i++) shown[i] = true;
    require(bp_particles_spacing(p, shown, &spacing, &err) == BP_OK && spacing >= 0 && isfinite(spacing));
    require(bp_bonds_find(p, shown, &bonds, &err) == BP_OK);
    for (size_t b = 0; b < bonds.count; b++)
        require(bonds.bond[b].a < p->count && bonds.bond[b].b < p->count);
    require(bp_molecules_make_whole(p, shown, &bonds, &moved, &err) == BP_OK && moved <= p->count);
    free(bonds.bond);
}

/* Whether "x" is among the columns, which are listed where one need not be there. */
static bool has_column(const BpParticles *p) {
    for (size_t c = 0; c < p->column_count; c++)
        if (strcmp(p->column_names[c], "x") == 0) return true;
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static FILE *file = NULL;
    static const char *const wanted[] = {"x"};
    BpParticleFile *particles_file = NULL;
    BpParticles particles = {0};
    BpError err = {0};
    bool end = false;
    uint64_t found = 0;
    if (size == 0) return 0;
    if (file == NULL) file = tmpfile();
    require(file != NULL && ftruncate(fileno(file), 0) == 0);
    rewind(file);
    require(fwrite(data + 1, 1, size - 1, file) == size - 1 && fflush(file) == 0);
    (void)bp_particle_format_find("x.gz", file);
    const size_t needed = data[0] >= 128 && data[0] < 192;
    require(bp_particle_file_open(file, "x", FORMAT, wanted, data[0] < 128 ? 0 : 1, needed, &particles_file,
                                  &err) == BP_OK);
    BpStatus status = BP_OK;
    while (status == BP_OK && !end && found < FRAMES_MAX) {
        status = bp_particle_file_next(particles_file, &particles, &end, &err);
        if (status == BP_OK && !end) check_particles(&particles);
        if (status == BP_OK && !end) check_bodies(&particles);
        if (status == BP_OK && !end) check_neighbours(&particles);
        found += status == BP_OK && !end;
    }
    if (status != BP_OK) require(err.code == status && err.message[0] != '\0');
    if (status == BP_OK && end) {
        uint64_t count = 0;
        require(found > 0);
        require(bp_particle_file_frame(particles_file, -1, &particles, &err) == BP_OK);
        check_particles(&particles);
        const bool there = data[0] >= 192 ? has_column(&particles) : needed == 1;
        require(particles.count == 0 || (particles.column[0] != NULL) == there);
        require(bp_particle_file_count(particles_file, &count, &err) == BP_OK && count == found);
        require(bp_particle_file_frame(particles_file, (int64_t)found, &particles, &err) == BP_ERR_SCENE);
    }
    bp_error_clear(&err);
    bp_particles_clear(&particles);
    bp_particle_file_close(&particles_file);
    return 0;
}
