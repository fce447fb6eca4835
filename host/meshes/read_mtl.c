/* read_mtl.c: MTL files, the materials of OBJ; see reader.h.
 *
 * Knows: Kd, Ke, Ni, d, Tr and map_Kd.   Does not know: how a mesh looks in the end.
 *
 * What an MTL file says is an offer, so nothing in it is an error: lines that make no sense are left out, and
 * a note counts them. */
#include "reader.h"

#include "base/input_file.h"
#include "base/message_text.h"
#include "base/plural.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
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

/* The numbers or words behind an option of a texture, at most; 0: it is none. */
static size_t words_behind(const char *option) {
    static const char *const one[] = {"-blendu", "-blendv",  "-boost", "-texres", "-clamp",
                                      "-bm",     "-imfchan", "-type",  "-cc"};
    for (size_t i = 0; i < sizeof one / sizeof *one; i++)
        if (strcmp(option, one[i]) == 0) return 1;
    if (strcmp(option, "-mm") == 0) return 2;
    return strcmp(option, "-o") == 0 || strcmp(option, "-s") == 0 || strcmp(option, "-t") == 0 ? 3 : 0;
}

/* Cuts a word off in place. */
static char *take_word(char **at) {
    char *const word = *at + strspn(*at, " \t");
    *at = word + strcspn(word, " \t");
    if (**at != '\0') *(*at)++ = '\0';
    return word;
}

/* The file behind map_Kd, without options and folders of the other kind; its name may have blanks. Relative
 * to the mesh, as the MTL file is beside it or below. */
static BpStatus take_image(const MeshBuilder *builder, const Input *input, char *rest,
                           BpMeshMaterial *material, bool *moved, BpError *err) {
    rest += strspn(rest, " \t");
    while (*rest == '-') {
        char *at = rest;
        const char *const option = take_word(&at);
        const size_t most = words_behind(option);
        if (most == 0) break;
        *moved |= most == 3;
        for (size_t i = 0; i < most; i++) {
            double number = 0;
            char *const before = at;
            char *const word = take_word(&at);
            if (strcmp(option, "-clamp") == 0) material->image_clamped = strcmp(word, "on") == 0;
            if (most < 3 || word_number(word, &number)) continue;
            /* Fewer numbers than there may be: this is the file already. */
            if (at > word + strlen(word)) at[-1] = ' ';
            at = before;
            break;
        }
        rest = at + strspn(at, " \t");
    }
    char *const name = mesh_name_in(rest);
    for (char *at = name; *at != '\0'; at++)
        if (*at == '\\') *at = '/';
    if (*name == '\0') return BP_OK;
    char *const path = bp_path_beside(input->name, name);
    const char *const slash = strrchr(builder->path, '/');
    const size_t folder = slash != NULL ? (size_t)(slash - builder->path) + 1 : 0;
    if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    const bool below = folder > 0 && strncmp(path, builder->path, folder) == 0;
    free(material->image_file);
    material->image_file = strdup(below ? path + folder : path);
    free(path);
    return material->image_file != NULL ? BP_OK : bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
}

BpStatus mesh_read_mtl(MeshBuilder *builder, Input *input, BpError *err) {
    char *line = NULL, *words[WORDS_MAX];
    uint32_t material = BP_MESH_NO_MATERIAL;
    uint64_t wrong = 0, first_wrong = 0;
    bool has_textures = false, moved = false;
    for (;;) {
        BP_TRY(input_full_line(input, &line, err));
        if (line == NULL) break;
        line += strspn(line, " \t\r");
        if (strncmp(line, "newmtl", 6) == 0 && (line[6] == ' ' || line[6] == '\t')) {
            BP_TRY(mesh_find_material(builder, mesh_name_in(line + 6), &material, err));
            continue;
        }
        if (strncmp(line, "map_Kd", 6) == 0 && (line[6] == ' ' || line[6] == '\t') &&
            material != BP_MESH_NO_MATERIAL) {
            BP_TRY(take_image(builder, input, line + 6, &builder->mesh->materials[material], &moved, err));
            continue;
        }
        line[strcspn(line, "#")] = '\0';
        const size_t count = split_words(line, words, WORDS_MAX);
        if (count == 0) continue;
        has_textures |= strncmp(words[0], "map_", 4) == 0;
        if (material != BP_MESH_NO_MATERIAL && count <= WORDS_MAX &&
            take(&builder->mesh->materials[material], words, count))
            continue;
        if (count > WORDS_MAX) continue; /* options of a texture */
        if (wrong++ == 0) first_wrong = input->line;
    }
    if (has_textures) mesh_note(builder->mesh, "textures other than map_Kd left out");
    if (moved) mesh_note(builder->mesh, "textures are neither moved nor scaled, as an MTL file says");
    if (wrong > 0) {
        const char *const slash = strrchr(input->name, '/');
        char shown[64];
        bp_printable(slash != NULL ? slash + 1 : input->name, shown, sizeof shown);
        mesh_note(builder->mesh, "%" PRIu64 " line%s of %s left out, from line %" PRIu64 " on", wrong,
                  bp_plural(wrong), shown, first_wrong);
    }
    return BP_OK;
}
