/* read_mtl.c: MTL files, the materials of OBJ; see reader.h.
 *
 * Knows: Kd, Ke, Ni, d and Tr.   Does not know: how a mesh looks in the end.
 *
 * What an MTL file says is an offer, so nothing in it is an error: lines that make no sense are left out, and
 * a note counts them. */
#include "reader.h"

#include "base/message_text.h"
#include "base/plural.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { WORDS_MAX = 8 };

/* Red, green and blue from 0; one number stands for all three. */
static bool parse_color(char **words, size_t count, double color[3]) {
    if (count != 1 && count != 3) return false;
    for (size_t i = 0; i < 3; i++)
        if (!word_number(words[count == 1 ? 0 : i], &color[i]) || color[i] < 0) return false;
    return true;
}

static bool parse_number(char **words, size_t count, double *value) {
    return count == 1 && word_number(words[0], value);
}

/* Takes a line for a material. False: it makes no sense. */
static bool take(BpMeshMaterial *material, char **words, size_t count) {
    const char *const key = words[0];
    double color[3], value = 0;
    words++;
    count--;
    const bool is_kd = strcmp(key, "Kd") == 0, is_ke = strcmp(key, "Ke") == 0;
    const bool is_d = strcmp(key, "d") == 0, is_tr = strcmp(key, "Tr") == 0;
    if (is_kd || is_ke) {
        if (!parse_color(words, count, color)) return false;
        memcpy(is_kd ? material->kd : material->ke, color, sizeof color);
        *(is_kd ? &material->has_kd : &material->has_ke) = true;
    } else if (strcmp(key, "Ni") == 0) {
        if (!parse_number(words, count, &value) || value <= 0) return false;
        material->ni = value;
        material->has_ni = true;
    } else if (is_d || is_tr) {
        if (!parse_number(words, count, &value) || value < 0 || value > 1) return false;
        if (is_tr && material->has_d) return true;
        material->d = is_tr ? 1 - value : value;
        material->has_d = true;
    }
    return true;
}

BpStatus mesh_read_mtl(MeshBuilder *builder, Input *input, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    uint32_t material = BP_MESH_NO_MATERIAL;
    uint64_t wrong = 0, first_wrong = 0;
    bool has_textures = false;
    for (;;) {
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL) break;
        line += strspn(line, " \t\r");
        if (strncmp(line, "newmtl", 6) == 0 && (line[6] == ' ' || line[6] == '\t')) {
            BP_TRY(mesh_find_material(builder, mesh_name_in(line + 6), &material, err));
            continue;
        }
        line[strcspn(line, "#")] = '\0';
        const size_t count = split_words(line, words, WORDS_MAX);
        if (count == 0) continue;
        has_textures |= strncmp(words[0], "map_Kd", 6) == 0;
        if (material != BP_MESH_NO_MATERIAL && count <= WORDS_MAX &&
            take(&builder->mesh->materials[material], words, count))
            continue;
        if (count > WORDS_MAX) continue; /* options of a texture */
        if (wrong++ == 0) first_wrong = input->line;
    }
    if (has_textures) mesh_note(builder->mesh, "textures left out");
    if (wrong > 0) {
        const char *const slash = strrchr(input->name, '/');
        char shown[64];
        bp_printable(slash != NULL ? slash + 1 : input->name, shown, sizeof shown);
        mesh_note(builder->mesh, "%" PRIu64 " line%s of %s left out, from line %" PRIu64 " on", wrong,
                  bp_plural(wrong), shown, first_wrong);
    }
    return BP_OK;
}
