/* file.c: which format a file has, and the way from it to a mesh; see mesh.h. */
#include "mesh.h"

#include "base/encoding.h"
#include "base/input_file.h"
#include "base/words.h"
#include "reader.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef enum Format {
    FORMAT_NONE,
    FORMAT_PLY,
    FORMAT_OBJ,
    FORMAT_STL,
    FORMAT_OFF,
    FORMAT_GLTF,
    FORMAT_FOREIGN
} Format;

#define READERS(X)                                                                                           \
    X(FORMAT_NONE, NULL)                                                                                     \
    X(FORMAT_PLY, mesh_read_ply)                                                                             \
    X(FORMAT_OBJ, mesh_read_obj)                                                                             \
    X(FORMAT_STL, mesh_read_stl)                                                                             \
    X(FORMAT_OFF, mesh_read_off)                                                                             \
    X(FORMAT_GLTF, mesh_read_gltf)                                                                           \
    X(FORMAT_FOREIGN, NULL)
BP_WORDS(Format, static ReadMesh *const readers, READERS);

/* Formats that are not read, by what their files begin with, if that is always the same, and how they are
 * named. */
static const struct {
    const char *name, *ending, *beginning;
} foreign[] = {{"FBX", ".fbx", "Kaydara FBX Binary"},
               {"3D Studio", ".3ds", NULL},
               {"COLLADA", ".dae", NULL},
               {"Blender", ".blend", "BLENDER"},
               {"3MF", ".3mf", NULL},
               {"USD", ".usd", NULL},
               {"USD", ".usda", "#usda "},
               {"USD", ".usdc", "PXR-USDC"},
               {"USD", ".usdz", NULL},
               {"STEP", ".step", "ISO-10303-21"},
               {"STEP", ".stp", NULL},
               {"VRML", ".wrl", "#VRML "},
               {"X3D", ".x3d", NULL}};
enum { FOREIGN_COUNT = sizeof foreign / sizeof *foreign };

static bool begins_with(const Input *input, const char *text) {
    const size_t length = strlen(text);
    return input->end - input->begin >= length && memcmp(input->buffer + input->begin, text, length) == 0;
}

/* The first word of a text, after a byte order mark. */
static void first_word(const Input *input, char *word, size_t size) {
    const unsigned char *text = input->buffer + input->begin, *const end = input->buffer + input->end;
    text += bp_text_mark(text, (size_t)(end - text));
    while (text < end && strchr(" \t\r\n", *text) != NULL) text++;
    size_t length = 0;
    while (text < end && strchr(" \t\r\n", *text) == NULL && length + 1 < size)
        word[length++] = (char)*text++;
    word[length] = '\0';
}

/* Whether it is OFF, with the letters for what vertices have before it. */
static bool is_off_word(const char *word) {
    static const char *const letters[] = {"ST", "C", "N", "4", "n"};
    for (size_t i = 0; i < sizeof letters / sizeof *letters; i++)
        if (strncmp(word, letters[i], strlen(letters[i])) == 0) word += strlen(letters[i]);
    return strcmp(word, "OFF") == 0;
}

/* Whether a text begins like one of STL. */
static bool is_stl_text(const Input *input, const char *word) {
    const unsigned char *const text = input->buffer + input->begin;
    const size_t length = input->end - input->begin;
    for (size_t i = 0; strcasecmp(word, "solid") == 0 && i + 5 <= length; i++)
        if (memcmp(text + i, "facet", 5) == 0) return true;
    return false;
}

/* Which format a file has, which stands at its beginning. *other: of FORMAT_FOREIGN, its name. */
static Format find_format(Input *input, const char *path, const char **other) {
    char word[16];
    (void)input_fill(input, 512);
    for (int i = 0; i < FOREIGN_COUNT; i++) {
        *other = foreign[i].name;
        if (bp_path_has_ending(path, foreign[i].ending)) return FORMAT_FOREIGN;
        if (foreign[i].beginning != NULL && begins_with(input, foreign[i].beginning)) return FORMAT_FOREIGN;
    }
    if (bp_path_has_ending(path, ".gltf") || bp_path_has_ending(path, ".glb") || begins_with(input, "glTF"))
        return FORMAT_GLTF;
    first_word(input, word, sizeof word);
    if (word[0] == '{') return FORMAT_NONE; /* a scene document, whatever its name */
    if (strcmp(word, "ply") == 0) return FORMAT_PLY;
    if (is_off_word(word)) return FORMAT_OFF;
    if (bp_path_has_ending(path, ".ply")) return FORMAT_PLY;
    if (bp_path_has_ending(path, ".obj")) return FORMAT_OBJ;
    if (bp_path_has_ending(path, ".off")) return FORMAT_OFF;
    if (bp_path_has_ending(path, ".stl") || is_stl_text(input, word)) return FORMAT_STL;
    return !input_is_packed(input) && mesh_stl_is_binary(input) ? FORMAT_STL : FORMAT_NONE;
}

bool bp_mesh_is_file(const char *path) {
    FILE *stream = NULL;
    uint64_t size = 0;
    Input input = {0};
    const char *other = NULL;
    if (bp_file_open(path, false, "a file of a mesh", &stream, &size, NULL) != BP_OK) return false;
    bool is_mesh = false;
    if (input_init(&input, stream, path, NULL) == BP_OK) {
        const Format format = find_format(&input, path, &other);
        is_mesh = format == FORMAT_PLY ? mesh_ply_has_faces(&input) : format != FORMAT_NONE;
    }
    input_clear(&input);
    fclose(stream);
    return is_mesh;
}

static BpStatus read_input(Input *input, const char *path, BpMesh *mesh, BpError *err) {
    MeshBuilder builder;
    const char *other = NULL;
    const Format format = find_format(input, path, &other);
    if (format == FORMAT_FOREIGN)
        return input_fail(input, false, err,
                          "found a mesh as %s, which is not read; export it as PLY, OBJ, STL, OFF or glTF",
                          other);
    if (format == FORMAT_NONE)
        return input_fail(input, false, err,
                          "found no format that is known, expected a mesh as PLY, OBJ, STL, OFF or glTF");
    mesh_builder_init(&builder, input, path, mesh);
    BpStatus status = readers[format](&builder, err);
    if (status == BP_OK) status = mesh_finish(&builder, err);
    mesh_builder_clear(&builder);
    return status;
}

BpStatus bp_mesh_read_stream(FILE *stream, const char *path, BpMesh *mesh, BpError *err) {
    Input input = {0};
    *mesh = (BpMesh){0};
    /* Numbers have a point, whatever the caller's locale. */
    const locale_t point = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    if (point == (locale_t)0) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a locale");
    const locale_t before = uselocale(point);
    BpStatus status = input_init(&input, stream, path, err);
    if (status == BP_OK) status = read_input(&input, path, mesh, err);
    input_clear(&input);
    uselocale(before);
    freelocale(point);
    if (status != BP_OK) bp_mesh_clear(mesh);
    return status;
}

BpStatus bp_mesh_read(const char *path, BpMesh *mesh, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    *mesh = (BpMesh){0};
    BP_TRY(bp_file_open(path, false, "a file of a mesh", &stream, &size, err));
    const BpStatus status = bp_mesh_read_stream(stream, path, mesh, err);
    fclose(stream);
    return status;
}

void bp_mesh_clear(BpMesh *mesh) {
    for (size_t i = 0; i < mesh->material_count; i++) {
        free(mesh->materials[i].name);
        free(mesh->materials[i].image_file);
    }
    free(mesh->materials);
    free(mesh->positions);
    free(mesh->faces);
    free(mesh->face_material);
    free(mesh->vertex_colors);
    free(mesh->face_colors);
    free(mesh->face_normals);
    free(mesh->face_coordinates);
    *mesh = (BpMesh){0};
}
