/* read_ply.c: the points of a PLY file as particles; see reader.h.
 *
 * The clouds of scene documents are the same files, read straight into spheres (formats/ply.c). This reader
 * hands over what that one has no use for: every property by its name, for colours and radii, and files
 * packed by gzip. */
#include "reader.h"

#include "ply_rows.h"

#include "base/format.h"
#include "base/plural.h"

#include <stdlib.h>

static BpStatus add_point(BpParticleFile *file, const PlyHeader *header, const double *values, BpError *err) {
    Particle particle = PARTICLE_NONE;
    for (int i = 0; i < 3; i++) {
        particle.position[i] = values[header->place[i]];
        if (header->color[i] >= 0) particle.color[i] = values[header->color[i]];
    }
    if (header->radius >= 0) particle.radius = header->radius_scale * values[header->radius];
    particle.values = values;
    return frame_add(file, &particle, header->form == PLY_ASCII, err);
}

static void note_faces(BpParticles *particles, const PlyHeader *header) {
    char number[32];
    if (particles == NULL) return;
    for (size_t i = 0; i < header->element_count; i++) {
        const PlyElement *const element = &header->elements[i];
        if (element->faces && element->count > 0)
            bp_particles_note(particles, "%s %s%s left out",
                              bp_format_whole(element->count, number, sizeof number),
                              element->strips ? "strip" : "face", bp_plural(element->count));
    }
}

static BpStatus take_points(BpParticleFile *file, PlyHeader *header, BpError *err) {
    const char *names[PLY_PROPERTIES_MAX];
    double values[PLY_PROPERTIES_MAX];
    BP_TRY(ply_read_header(&file->input, header, err));
    const PlyElement *const element = &header->elements[header->vertex];
    for (size_t i = 0; i < element->property_count; i++) names[i] = ply_property(header, (int)i)->name;
    BP_TRY(frame_begin(file, names, element->property_count, err));
    if (header->color[0] >= 0) file->colors = ply_color_range(header);
    BP_TRY(ply_begin_points(&file->input, header, err));
    for (uint64_t row = 0; row < element->count; row++) {
        BP_TRY(ply_take_point(&file->input, header, row, values, err));
        BP_TRY(add_point(file, header, values, err));
    }
    note_faces(file->out, header);
    return ply_end_points(&file->input, header, err);
}

BpStatus read_ply(BpParticleFile *file, bool *end, BpError *err) {
    *end = file->frame > 0;
    if (*end) return BP_OK;
    PlyHeader *const header = malloc(sizeof *header);
    if (header == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    const BpStatus status = take_points(file, header, err);
    free(header);
    return status;
}
