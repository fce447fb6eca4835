/* particle_summary.c: prints what a file of particles holds, as one line of JSON; for the scripts beside it.
 *
 * particle_summary FILE [FRAME [COLUMN [values]]]. It lists each particle if there are at most LISTED_MAX, or
 * if asked for values; a column "" is none. Exit code 1 and the message on standard error when it is refused.
 * `particle_summary -` does so for many files (requests.h).
 */
#include "particles/elements.h"
#include "particles/particles.h"
#include "requests.h"

#include <inttypes.h>
#include <stdlib.h>

enum { LISTED_MAX = 1000 };

static void print_text(const char *text) {
    putchar('"');
    for (; *text != '\0'; text++) {
        if (*text == '"' || *text == '\\') putchar('\\');
        putchar(*text);
    }
    putchar('"');
}

static void print_numbers(const double *numbers, size_t count) {
    printf("%s", count > 1 ? "[" : "");
    for (size_t i = 0; i < count; i++) {
        printf("%s", i > 0 ? ", " : "");
        if (isnan(numbers[i]))
            printf("null");
        else
            printf("%.17g", numbers[i]);
    }
    printf("%s", count > 1 ? "]" : "");
}

static void print_color(const float color[3]) {
    print_numbers((const double[3]){(double)color[0], (double)color[1], (double)color[2]}, 3);
}

static const char *name_of(const BpParticles *p, uint16_t number) {
    return p->names.count > 0 ? p->names.text[number] : "";
}

/* Of each particle its kind, half-axes and orientation; and the faces of shapes, as polygons. */
static void print_bodies(const BpParticles *p) {
    printf(", \"bodies\": [");
    for (size_t i = 0; i < p->count; i++) {
        const BpParticleBody *const body = &p->body[i];
        const float *const axes = body->half_axes, *const q = body->orientation;
        const double numbers[8] = {body->kind,   (double)axes[0], (double)axes[1], (double)axes[2],
                                   (double)q[0], (double)q[1],    (double)q[2],    (double)q[3]};
        printf("%s", i > 0 ? ", " : "");
        print_numbers(numbers, 8);
    }
    printf("], \"shapes\": [");
    for (size_t s = 0; s < p->shape_count; s++) {
        const BpParticleShape *const shape = &p->shapes[s];
        printf("%s{\"kind\": \"%s\", \"type\": ", s > 0 ? ", " : "", shape->kind);
        print_text(shape->type);
        printf(", \"radius\": %.17g, \"capsule\": %.17g, \"rounding\": %.17g, \"vertices\": [", shape->radius,
               shape->capsule_radius, shape->rounding);
        for (size_t v = 0; v < shape->vertex_count; v++) {
            printf("%s", v > 0 ? ", " : "");
            print_numbers(shape->vertices[v], 3);
        }
        printf("], \"faces\": [");
        for (size_t f = 0, c = 0; f < shape->face_count; f++) {
            printf("%s[", f > 0 ? ", " : "");
            for (bool first = true; c < shape->ends[f]; c++, first = false)
                printf("%s%u", first ? "" : ", ", (unsigned)shape->corners[c]);
            putchar(']');
        }
        printf("]}");
    }
    putchar(']');
}

/* Lists of one entry a particle, in the file's order; empty where the frame has no such thing. And the ends
 * of all bonds. */
static void print_lists(const BpParticles *p) {
    enum { POSITIONS, TYPES, NAMES, SYMBOLS, RADII, COLORS, VALUES, LISTS };
    static const char *const lists[LISTS] = {"positions", "types",  "atom_names", "symbols",
                                             "radii",     "colors", "values"};
    const bool has[LISTS] = {
        true, true, true, true, p->radius != NULL, p->color != NULL, p->column[0] != NULL};
    for (int list = 0; list < LISTS; list++) {
        printf(", \"%s\": [", lists[list]);
        for (size_t i = 0; i < p->count && has[list]; i++) {
            printf("%s", i > 0 ? ", " : "");
            if (list == POSITIONS) print_numbers(p->position[i], 3);
            if (list == TYPES) print_text(name_of(p, p->tag[i].type));
            if (list == NAMES) print_text(name_of(p, p->tag[i].name));
            if (list == SYMBOLS) print_text(bp_elements[p->tag[i].element].symbol);
            if (list == RADII) print_numbers(&(double){(double)p->radius[i]}, 1);
            if (list == COLORS) print_color(p->color[i]);
            if (list == VALUES) print_numbers(&(double){(double)p->column[0][i]}, 1);
        }
        putchar(']');
    }
    if (p->body != NULL) print_bodies(p);
    printf(", \"pairs\": [");
    for (size_t b = 0; b < p->bond_count; b++)
        printf("%s[%u, %u]", b > 0 ? ", " : "", (unsigned)p->bonds[b][0], (unsigned)p->bonds[b][1]);
    putchar(']');
}

static void print_cell(const BpParticles *p) {
    printf(", \"periodic\": [%s, %s, %s], \"cell\": [", p->periodic[0] ? "true" : "false",
           p->periodic[1] ? "true" : "false", p->periodic[2] ? "true" : "false");
    for (int i = 0; i < 3; i++)
        printf("%s[%.9g, %.9g, %.9g]", i > 0 ? ", " : "", p->cell[i][0], p->cell[i][1], p->cell[i][2]);
    printf("], \"origin\": [%.9g, %.9g, %.9g]", p->cell_origin[0], p->cell_origin[1], p->cell_origin[2]);
}

static void print_summary(const BpParticles *p) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, sum[3] = {0};
    size_t elements[BP_ELEMENT_MAX + 1] = {0}, alternatives = 0, dummies = 0;
    for (size_t i = 0; i < p->count; i++) {
        for (int c = 0; c < 3; c++) {
            low[c] = fmin(low[c], p->position[i][c]);
            high[c] = fmax(high[c], p->position[i][c]);
            sum[c] += p->position[i][c];
        }
        elements[p->tag[i].element]++;
        alternatives += (p->tag[i].flags & BP_PARTICLE_ALTERNATIVE) != 0;
        dummies += (p->tag[i].flags & BP_PARTICLE_DUMMY) != 0;
    }
    printf("\"names\": %zu, ", p->names.count > 0 ? p->names.count - 1 : 0);
    printf("\"count\": %zu, \"bonds\": %zu, \"left_out\": %zu, \"angstrom\": %g, \"up\": %d, \"flat\": %s, "
           "\"alternatives\": %zu, \"dummies\": %zu, \"notes\": ",
           p->count, p->bond_count, p->bonds_left_out, p->angstrom, p->up, p->flat ? "true" : "false",
           alternatives, dummies);
    print_text(p->notes);
    if (p->count > 0)
        printf(", \"low\": [%.9g, %.9g, %.9g], \"high\": [%.9g, %.9g, %.9g], \"mean\": [%.9g, %.9g, %.9g]",
               low[0], low[1], low[2], high[0], high[1], high[2], sum[0] / (double)p->count,
               sum[1] / (double)p->count, sum[2] / (double)p->count);
    printf(", \"elements\": {");
    const char *comma = "";
    for (int z = 0; z <= BP_ELEMENT_MAX; z++) {
        if (elements[z] == 0) continue;
        printf("%s\"%s\": %zu", comma, bp_elements[z].symbol, elements[z]);
        comma = ", ";
    }
    printf("}");
    if (p->has_cell) print_cell(p);
    if (p->radius != NULL) printf(", \"radius\": %.9g", (double)p->radius[0]);
    if (p->color != NULL)
        printf(", \"color\": [%.6g, %.6g, %.6g]", (double)p->color[0][0], (double)p->color[0][1],
               (double)p->color[0][2]);
    if (p->count > 0) {
        const BpParticleTag *const tag = &p->tag[0];
        const char *const keys[] = {"{\"name\"", ", \"residue\"", ", \"chain\"", ", \"type\""};
        const uint16_t numbers[] = {tag->name, tag->residue, tag->chain, tag->type};
        printf(", \"first\": ");
        for (int i = 0; i < 4; i++) {
            printf("%s: ", keys[i]);
            print_text(name_of(p, numbers[i]));
        }
        printf("}");
    }
    if (p->column[0] != NULL) {
        double total = 0;
        for (size_t i = 0; i < p->count; i++)
            if (!isnan(p->column[0][i])) total += (double)p->column[0][i];
        printf(", \"column_sum\": %.9g", total);
    }
}

static int summarise(int argc, char **argv, FILE *messages) {
    BpError err = {0};
    BpParticles particles = {0};
    BpParticleFile *file = NULL;
    uint64_t frames = 0;
    const char *const wanted[] = {argc > 3 ? argv[3] : ""};
    FILE *const stream = argc > 1 ? fopen(argv[1], "rb") : NULL;
    if (stream == NULL) return 2;
    const BpParticleFormat format = bp_particle_format_find(argv[1], stream);
    BpStatus status = format == BP_PARTICLES_NONE ? BP_ERR_USAGE : BP_OK;
    if (status == BP_OK)
        status = bp_particle_file_open(stream, argv[1], format, wanted, wanted[0][0] != '\0',
                                       wanted[0][0] != '\0', &file, &err);
    if (status == BP_OK)
        status = bp_particle_file_frame(file, argc > 2 ? strtol(argv[2], NULL, 10) : 0, &particles, &err);
    if (status == BP_OK) status = bp_particle_file_count(file, &frames, &err);
    if (status == BP_OK) {
        printf("{\"format\": \"%s\", \"frames\": %" PRIu64 ", ", bp_particle_format_name(format), frames);
        print_summary(&particles);
        if (argc > 4 || particles.count <= LISTED_MAX) print_lists(&particles);
        printf("}\n");
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
    return answer_requests(argc, argv, summarise);
}
