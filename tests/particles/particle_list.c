/* particle_list.c: prints every particle of a frame, for scripts that compare each with an independent
 * reader.
 *
 * particle_list FILE [FRAME [COLUMN [COLUMN]]]. One line of JSON for the frame, then one for each particle:
 * [x, y, z, element, flags, name, residue, chain, radius, column, column]. Exit code 1 and the message on
 * standard error when the file is refused. `particle_list -` does so for many
 * files (requests.h). */
#include "particles/elements.h"
#include "particles/particles.h"
#include "requests.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 2 };

static void print_number(bool there, double value) {
    if (!there || isnan(value))
        printf(", null");
    else
        printf(", %.9g", value);
}

static void print_text(const BpParticles *p, uint16_t number) {
    printf(", \"");
    for (const char *c = p->names.count > 0 ? p->names.text[number] : ""; *c != '\0'; c++)
        printf(*c == '"' || *c == '\\' ? "\\%c" : "%c", *c);
    printf("\"");
}

static void print_frame(const BpParticles *p, const char *format, uint64_t frames) {
    printf("{\"format\": \"%s\", \"frames\": %" PRIu64 ", \"left_out\": %zu, \"notes\": \"%s\"", format,
           frames, p->bonds_left_out, p->notes);
    if (p->has_cell) {
        static const bool nowhere[sizeof p->periodic] = {false};
        printf(", \"repeats\": %s, \"cell\": [",
               memcmp(&p->periodic, nowhere, sizeof p->periodic) != 0 ? "true" : "false");
        for (int i = 0; i < 3; i++)
            printf("[%.12g, %.12g, %.12g], ", p->cell[i][0], p->cell[i][1], p->cell[i][2]);
        printf("[%.12g, %.12g, %.12g]]", p->cell_origin[0], p->cell_origin[1], p->cell_origin[2]);
    }
    printf(", \"bonds\": [");
    for (size_t b = 0; b < p->bond_count; b++)
        printf("%s[%" PRIu32 ", %" PRIu32 "]", b > 0 ? ", " : "", p->bonds[b][0], p->bonds[b][1]);
    printf("]}\n");
}

static void print_particle(const BpParticles *p, size_t i) {
    const BpParticleTag *const tag = &p->tag[i];
    printf("[%.12g, %.12g, %.12g, \"%s\", %d", p->position[i][0], p->position[i][1], p->position[i][2],
           bp_elements[tag->element].symbol, tag->flags);
    print_text(p, tag->name);
    print_text(p, tag->residue);
    print_text(p, tag->chain);
    print_number(p->radius != NULL, p->radius != NULL ? (double)p->radius[i] : 0);
    for (int c = 0; c < COLUMNS; c++)
        print_number(p->column[c] != NULL, p->column[c] != NULL ? p->column[c][i] : 0);
    printf("]\n");
}

static int list(int argc, char **argv, FILE *messages) {
    BpError err = {0};
    BpParticles particles = {0};
    BpParticleFile *file = NULL;
    uint64_t frames = 0;
    const char *const *const wanted = (const char *const *)argv + 3;
    FILE *const stream = argc > 1 ? fopen(argv[1], "rb") : NULL;
    if (stream == NULL) return 2;
    const BpParticleFormat format = bp_particle_format_find(argv[1], stream);
    BpStatus status = format == BP_PARTICLES_NONE ? BP_ERR_USAGE : BP_OK;
    if (status == BP_OK)
        status = bp_particle_file_open(stream, argv[1], format, wanted, argc > 3 ? (size_t)argc - 3 : 0,
                                       argc > 3 ? (size_t)argc - 3 : 0, &file, &err);
    if (status == BP_OK)
        status = bp_particle_file_frame(file, argc > 2 ? strtol(argv[2], NULL, 10) : 0, &particles, &err);
    if (status == BP_OK) status = bp_particle_file_count(file, &frames, &err);
    if (status == BP_OK) {
        print_frame(&particles, bp_particle_format_name(format), frames);
        for (size_t i = 0; i < particles.count; i++) print_particle(&particles, i);
    } else {
        fprintf(messages, "%s:%d: %s\n", err.file, err.line, err.message);
    }
    bp_particle_file_close(&file);
    bp_particles_clear(&particles);
    bp_error_clear(&err);
    fclose(stream);
    return status == BP_OK ? 0 : 1;
}

int main(int argc, char **argv) {
    return answer_requests(argc, argv, list);
}
