/* scene_particles.c: the particles of a scene document.
 *
 * In:    the node of "particles".   Out: the particles of the files that it names, as spheres.
 * Knows: the members of an entry, where relative paths begin. Does not know: how formats are read
 * (particles/file.c). */
#include "base/input_file.h"
#include "base/json_memory.h"
#include "base/known_file.h"
#include "base/message_text.h"
#include "base/words.h"
#include "named_file.h"
#include "particles/style.h"
#include "scene_parse.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- the style ---------------------------------------------------------------------------------------- */

static BpStatus read_above_zero(const BpNode *node, double *value, BpError *err) {
    BP_TRY(bp_node_number(node, value, err));
    if (node->value != NULL && !(*value > 0 && *value <= BP_COORDINATE_MAX))
        return bp_node_wrong(node, "a number above 0", err);
    return BP_OK;
}

static BpStatus read_color(const BpNode *node, double color[3], BpError *err) {
    BP_TRY(bp_node_vector(node, color, err));
    for (int c = 0; c < 3; c++)
        if (!(color[c] >= 0 && color[c] <= 1))
            return bp_node_wrong(node, "shares of light from 0 to 1: [r, g, b]", err);
    return BP_OK;
}

static BpStatus read_column(const BpNode *node, char column[64], BpError *err) {
    const char *text = "";
    BP_TRY(bp_node_string(node, &text, err));
    if (text[0] == '\0' || strlen(text) > 63)
        return bp_node_wrong(node, "the name of a column, at most 63 letters", err);
    memcpy(column, text, strlen(text) + 1);
    return BP_OK;
}

/* { "C": ..., "O": ... }: radii (numbers) or colours. */
static BpStatus read_named(const BpNode *node, bool colors, BpStyleNamed *list, size_t *count, BpError *err) {
    const char *name;
    json_t *value;
    if (node->value == NULL) return BP_OK;
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object of types or elements: { \"C\": ... }", err);
    json_object_foreach(node->value, name, value) {
        const BpNode child = bp_node_member(node, name);
        if (*count == BP_STYLE_NAMED_MAX)
            return bp_node_fail(&child, BP_PART_NAME, err, "found more than %d types, expected fewer",
                                BP_STYLE_NAMED_MAX);
        BpStyleNamed *const named = &list[*count];
        if (strlen(name) >= sizeof named->name)
            return bp_node_fail(&child, BP_PART_NAME, err,
                                "found a name of more than %zu bytes, expected a shorter one",
                                sizeof named->name - 1);
        memcpy(named->name, name, strlen(name) + 1);
        if (colors)
            BP_TRY(read_color(&child, named->value, err));
        else
            BP_TRY(read_above_zero(&child, named->value, err));
        ++*count;
    }
    return BP_OK;
}

/* The words for which a document may ask, each with its value; the other values have no word. */
#define RADIUS_WORDS(X) X(BP_RADIUS_VDW, "vdw") X(BP_RADIUS_COVALENT, "covalent")
#define COLOR_WORDS(X)                                                                                       \
    X(BP_COLOR_ELEMENT, "element")                                                                           \
    X(BP_COLOR_CHAIN, "chain") X(BP_COLOR_RESIDUE, "residue") X(BP_COLOR_TYPE, "type")
#define WORD(value, word) word,
#define VALUE(value, word) value,
static const char *const radius_words[] = {RADIUS_WORDS(WORD)};
static const BpRadiusBy radius_values[] = {RADIUS_WORDS(VALUE)};
static const char *const color_words[] = {COLOR_WORDS(WORD)};
static const BpColorBy color_values[] = {COLOR_WORDS(VALUE)};

#define EXPECTED_SIZE 256

/* `first`, the words, then `last` if there is one: "a number, \"vdw\" or \"covalent\"". */
static const char *list_words(const char *first, const char *const *words, size_t count, const char *last,
                              char text[EXPECTED_SIZE]) {
    size_t used = (size_t)snprintf(text, EXPECTED_SIZE, "%s", first);
    for (size_t i = 0; i < count && used < EXPECTED_SIZE; i++)
        used += (size_t)snprintf(text + used, EXPECTED_SIZE - used, "%s\"%s\"",
                                 i + 1 == count && last == NULL ? " or " : ", ", words[i]);
    if (last != NULL && used < EXPECTED_SIZE) snprintf(text + used, EXPECTED_SIZE - used, ", or %s", last);
    return text;
}

/* One of `words`. Any other word is probably meant as the name of a column, unless it is nearly one of them.
 * `first`: what may stand here instead of a word. */
static BpStatus read_by(const BpNode *node, const char *const *words, size_t count, const char *first,
                        int *choice, BpError *err) {
    const char *word = json_string_value(node->value);
    char expected[EXPECTED_SIZE], text[EXPECTED_SIZE + 128];
    bool known = bp_nearest_name(word, words, count) != NULL;
    for (size_t i = 0; i < count; i++) known = known || strcmp(word, words[i]) == 0;
    if (known) return bp_node_choice(node, words, count, choice, err);
    snprintf(text, sizeof text, "%s; for a column of the file, { \"column\": \"%s\" }",
             list_words(first, words, count, NULL, expected), strlen(word) <= 64 ? word : "NAME");
    return bp_node_wrong(node, text, err);
}

static BpStatus read_radius(const BpNode *node, BpParticleStyle *style, BpError *err) {
    static const char *const names[] = {"by", "column", "scale", "types"};
    static const char object[] = "an object such as { \"by\": \"vdw\", \"scale\": 0.5 }, "
                                 "{ \"column\": \"mass\", \"scale\": 0.1 } or { \"types\": { \"A\": 0.5 } }";
    char expected[EXPECTED_SIZE];
    int choice = 0;
    if (node->value == NULL) return BP_OK;
    if (json_is_number(node->value)) {
        style->radius_by = BP_RADIUS_CONSTANT;
        return read_above_zero(node, &style->radius, err);
    }
    if (json_is_string(node->value)) {
        BP_TRY(read_by(node, radius_words, BP_COUNT(radius_words), "a number", &choice, err));
        style->radius_by = radius_values[choice];
        return BP_OK;
    }
    if (!json_is_object(node->value)) {
        list_words("a number", radius_words, BP_COUNT(radius_words), object, expected);
        return bp_node_wrong(node, expected, err);
    }
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode by = bp_node_member(node, "by"), column = bp_node_member(node, "column");
    const BpNode scale = bp_node_member(node, "scale"), types = bp_node_member(node, "types");
    if (by.value != NULL && column.value != NULL)
        return bp_node_fail(&column, BP_PART_NAME, err,
                            "found beside \"by\", expected one of the two; remove one");
    if (by.value != NULL) {
        BP_TRY(bp_node_choice(&by, radius_words, BP_COUNT(radius_words), &choice, err));
        style->radius_by = radius_values[choice];
    }
    if (column.value != NULL) {
        style->radius_by = BP_RADIUS_COLUMN;
        BP_TRY(read_column(&column, style->radius_column, err));
    }
    BP_TRY(read_above_zero(&scale, &style->radius, err));
    return read_named(&types, false, style->radii, &style->radius_count, err);
}

static BpStatus read_range(const BpNode *node, BpParticleStyle *style, BpError *err) {
    if (node->value == NULL) return BP_OK;
    if (json_array_size(node->value) != 2) return bp_node_wrong(node, "two numbers: [least, most]", err);
    for (size_t i = 0; i < 2; i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(bp_node_number(&element, &style->range[i], err));
    }
    if (!(style->range[0] <= style->range[1])) return bp_node_wrong(node, "the lesser number first", err);
    style->has_range = true;
    return BP_OK;
}

static BpStatus read_colors(const BpNode *node, BpParticleStyle *style, BpError *err) {
    static const char *const names[] = {"by", "column", "map", "range", "bar", "types"};
    static const char object[] =
        "an object such as { \"column\": \"charge\", \"map\": \"viridis\", \"range\": [-1, 1] } or "
        "{ \"types\": { \"A\": [0.5, 0.1, 0.1] } }";
    char expected[EXPECTED_SIZE];
    int choice = 0;
    if (node->value == NULL) return BP_OK;
    if (json_is_array(node->value)) {
        style->color_by = BP_COLOR_CONSTANT;
        return read_color(node, style->color, err);
    }
    if (json_is_string(node->value)) {
        BP_TRY(read_by(node, color_words, BP_COUNT(color_words), "[r, g, b]", &choice, err));
        style->color_by = color_values[choice];
        return BP_OK;
    }
    if (!json_is_object(node->value)) {
        list_words("[r, g, b]", color_words, BP_COUNT(color_words), object, expected);
        return bp_node_wrong(node, expected, err);
    }
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode by = bp_node_member(node, "by"), column = bp_node_member(node, "column");
    const BpNode map = bp_node_member(node, "map"), range = bp_node_member(node, "range");
    const BpNode bar = bp_node_member(node, "bar"), types = bp_node_member(node, "types");
    if (by.value != NULL && column.value != NULL)
        return bp_node_fail(&column, BP_PART_NAME, err,
                            "found beside \"by\", expected one of the two; remove one");
    if (column.value == NULL && (map.value != NULL || range.value != NULL || bar.value != NULL))
        return bp_node_fail(map.value != NULL     ? &map
                            : range.value != NULL ? &range
                                                  : &bar,
                            BP_PART_NAME, err,
                            "found without \"column\", expected the column whose numbers give the colours");
    if (by.value != NULL) {
        BP_TRY(bp_node_choice(&by, color_words, BP_COUNT(color_words), &choice, err));
        style->color_by = color_values[choice];
    }
    if (column.value != NULL) {
        style->color_by = BP_COLOR_COLUMN;
        BP_TRY(read_column(&column, style->color_column, err));
    }
    choice = BP_MAP_VIRIDIS;
    BP_TRY(bp_node_choice(&map, bp_colormap_names, BP_MAP_COUNT, &choice, err));
    style->map = (BpColormap)choice;
    BP_TRY(read_range(&range, style, err));
    BP_TRY(bp_node_boolean(&bar, &style->bar, err));
    return read_named(&types, true, style->colors, &style->color_count, err);
}

static BpStatus read_bonds(const BpNode *node, BpParticleStyle *style, BpError *err) {
    static const char *const names[] = {"radius"};
    if (json_is_object(node->value)) {
        BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
        const BpNode radius = bp_node_member(node, "radius");
        style->bonds = true;
        return read_above_zero(&radius, &style->bond_radius, err);
    }
    if (node->value != NULL && !json_is_boolean(node->value))
        return bp_node_wrong(node, "true, false or { \"radius\": 0.1 }", err);
    return bp_node_boolean(node, &style->bonds, err);
}

#define STYLE_WORDS(X) X(BP_STYLE_SPACEFILL, "spacefill") X(BP_STYLE_BALL_AND_STICK, "ball-and-stick")
BP_WORDS(BpStyleKind, static const char *const style_names, STYLE_WORDS);

static BpStatus read_style(const BpNode *node, BpParticleStyle *style, BpError *err) {
    const BpNode kind = bp_node_member(node, "style"), radius = bp_node_member(node, "radius");
    const BpNode color = bp_node_member(node, "color"), bonds = bp_node_member(node, "bonds");
    const BpNode box = bp_node_member(node, "box"), solvent = bp_node_member(node, "solvent");
    const BpNode whole = bp_node_member(node, "whole");
    int choice = 0;
    bp_particle_style_defaults(style);
    BP_TRY(bp_node_choice(&kind, style_names, BP_COUNT(style_names), &choice, err));
    style->kind = (BpStyleKind)choice;
    BP_TRY(read_radius(&radius, style, err));
    BP_TRY(read_colors(&color, style, err));
    BP_TRY(read_bonds(&bonds, style, err));
    BP_TRY(bp_node_boolean(&box, &style->box, err));
    BP_TRY(bp_node_boolean(&solvent, &style->solvent, err));
    return bp_node_boolean(&whole, &style->whole, err);
}

/* ---- the files ---------------------------------------------------------------------------------------- */

typedef struct Entry {
    const char *file;
    int64_t frame;
    uint32_t material;
    BpParticleStyle style;
    char *text; /* as JSON, owned */
} Entry;

void bp_particle_cache_clear(BpParticleCache *cache) {
    for (size_t i = 0; i < cache->count; i++) {
        bp_particle_file_close(&cache->entry[i].file);
        fclose(cache->entry[i].stream);
        free(cache->entry[i].path);
    }
    *cache = (BpParticleCache){0};
}

/* Says what the file is, if it is known, and how to convert it. */
static BpStatus fail_format(const BpNode *node, const char *path, FILE *stream, uint64_t size, BpError *err) {
    char bytes[4096];
    BpKnownFile known = {BP_FILE_SOURCE, "a file of an unknown format"};
    const size_t length = fread(bytes, 1, sizeof bytes, stream);
    bp_known_file(path, bytes, length, (size_t)size, &known);
    return bp_node_fail(
        node, BP_PART_VALUE, err,
        "found %s, expected a name that ends in .xyz, .pdb, .cif, .gro, .dump, .lammpstrj, .data, "
        ".gsd, .csv or .ply (and perhaps .gz)%s",
        known.what, known.kind == BP_FILE_PARTICLES ? "; convert it, with ASE or MDAnalysis" : "");
}

/* The file of an entry of "particles", from the cache, or opened and, if there is room, left in it. */
static BpStatus open_file(const BpNode *file_node, const char *path, const Entry *entry, size_t place,
                          BpParticleCache *cache, BpParticleFile **file, BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    const char *columns[BP_PARTICLE_WANTED_MAX];
    if (place < cache->count) {
        *file = cache->entry[place].file;
        return BP_OK;
    }
    BP_TRY(bp_node_open_file(file_node, path, "a file of particles", &stream, &size, err));
    BpStatus status = BP_OK;
    const BpParticleFormat format = bp_particle_format_find(path, stream);
    if (format == BP_PARTICLES_NONE) status = fail_format(file_node, path, stream, size, err);
    char *const copy = status == BP_OK ? strdup(path) : NULL; /* the file's reader keeps the name */
    if (status == BP_OK && copy == NULL) status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    if (status == BP_OK)
        status = bp_particle_file_open(stream, copy, format, columns,
                                       bp_particle_style_columns(&entry->style, columns), file, err);
    if (status != BP_OK) {
        free(copy);
        fclose(stream);
        return status;
    }
    cache->entry[cache->count].path = copy;
    cache->entry[cache->count].stream = stream;
    cache->entry[cache->count++].file = *file;
    return BP_OK;
}

static void keep_legend(const BpParticleStyle *style, const double range[2], BpScene *scene) {
    enum { STOPS = sizeof scene->legend.colors / sizeof scene->legend.colors[0] };
    scene->has_color_range = true;
    memcpy(scene->color_range, range, sizeof scene->color_range);
    if (!style->bar) return;
    scene->legend.shown = true;
    memcpy(scene->legend.title, style->color_column, sizeof scene->legend.title);
    memcpy(scene->legend.range, range, sizeof scene->legend.range);
    for (int i = 0; i < STOPS; i++) {
        double color[3];
        bp_particle_style_map(style, i / (double)(STOPS - 1), color);
        for (int c = 0; c < 3; c++) scene->legend.colors[i][c] = (float)color[c];
    }
}

static BpStatus add_particles(BpParticleFile *file, const char *path, const Entry *entry, BpScene *scene,
                              BpError *err) {
    BpParticles particles = {0};
    char summary[1024];
    double range[2];
    BpStatus status = bp_particle_file_frame(file, entry->frame, &particles, err);
    if (status == BP_OK) {
        status = bp_particles_add_to_scene(&particles, &entry->style, entry->material, scene, summary,
                                           sizeof summary, range, err);
        if (status == BP_ERR_SCENE) bp_error_at(err, path, 0, 0);
    }
    if (status == BP_OK && entry->style.color_by == BP_COLOR_COLUMN) keep_legend(&entry->style, range, scene);
    if (status == BP_OK && !particles.flat) scene->up = particles.up;
    if (status == BP_OK && particles.flat) scene->flat = true;
    bp_particles_clear(&particles);
    return status == BP_OK ? bp_scene_note(scene, entry->file, summary, err) : status;
}

static BpStatus read_file(const BpNode *file_node, const Entry *entry, size_t place,
                          const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    BpParticleCache own = {0};
    BpParticleCache *const cache =
        changes->cache != NULL && place < BP_PARTICLE_CACHE_SIZE ? changes->cache : &own;
    BpParticleFile *file = NULL;
    uint64_t count = 0;
    char *const path = bp_path_beside(file_node->document->name, entry->file);
    if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for a path");
    const size_t first = scene->sphere_count;
    BpStatus status = open_file(file_node, path, entry, place, cache, &file, err);
    if (status == BP_OK) {
        if (changes->frame_count != NULL)
            status = bp_particle_file_count(file, &count, err);
        else
            status = add_particles(file, path, entry, scene, err);
        if (status == BP_ERR_SCENE && err != NULL && (changes->flags & BP_PARSE_MADE) == 0)
            bp_name_document(file_node, "particles", err);
    }
    if (status == BP_OK && changes->frame_count != NULL && count < *changes->frame_count)
        *changes->frame_count = count;
    if (status == BP_OK) status = bp_keep_point_file(entry->file, first, entry->text, scene, err);
    bp_particle_cache_clear(&own);
    free(path);
    return status;
}

/* Plain matte, whose colour each particle brings. */
uint32_t bp_implicit_material(BpScene *scene, BpError *err) {
    if (scene->implicit_material != SIZE_MAX) return (uint32_t)scene->implicit_material;
    BpMaterial *const material = &scene->materials[scene->material_count];
    *material = (BpMaterial){.kind = BP_MATERIAL_LAMBERTIAN, .albedo = {0.8, 0.8, 0.8}};
    if (bp_copy_text("particles", &material->name, err) != BP_OK) return UINT32_MAX;
    scene->implicit_material = scene->material_count++;
    return (uint32_t)scene->implicit_material;
}

static BpStatus parse_entry(const BpNode *node, size_t place, const BpMaterialIndex *index,
                            const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    static const char *const names[] = {"file",  "frame", "style",   "radius", "color",
                                        "bonds", "box",   "solvent", "whole",  "material"};
    if (!json_is_object(node->value))
        return bp_node_wrong(node, "an object: { \"file\": \"run.gsd\", ... }", err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    BP_TRY(bp_node_require(node, "file", "the path of a file of particles, relative to the scene", err));
    const BpNode file = bp_node_member(node, "file"), frame = bp_node_member(node, "frame");
    const BpNode material = bp_node_member(node, "material");
    Entry *const entry = calloc(1, sizeof *entry);
    if (entry == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory");
    BpStatus status = BP_OK;
    double number = 0;
    BP_TRY_GOTO(status, bp_node_string(&file, &entry->file, err), done);
    BP_TRY_GOTO(status, bp_node_number(&frame, &number, err), done);
    if (!(number >= -1e15 && number <= 1e15 && number == floor(number))) {
        status = bp_node_wrong(&frame, "a whole number: 0 is the first frame, -1 the last", err);
        goto done;
    }
    entry->frame = changes->has_frame ? changes->frame : (int64_t)number;
    BP_TRY_GOTO(status, read_style(node, &entry->style, err), done);
    if (changes->has_range && entry->style.color_by == BP_COLOR_COLUMN && !entry->style.has_range) {
        entry->style.has_range = true;
        memcpy(entry->style.range, changes->range, sizeof entry->style.range);
    }
    if (material.value != NULL)
        BP_TRY_GOTO(status, bp_parse_material_name(&material, index, &entry->material, err), done);
    else
        entry->material = bp_implicit_material(scene, err);
    if (entry->material == UINT32_MAX) {
        status = BP_ERR_MEMORY;
        goto done;
    }
    json_t *const copy = json_copy(node->value);
    /* Without memory for a member, jansson leaves it out of the copy and says nothing. */
    bool whole = copy != NULL && json_object_size(copy) == json_object_size(node->value);
    if (whole && changes->has_frame)
        whole = json_object_set_new(copy, "frame", json_integer(changes->frame)) == 0;
    entry->text = whole ? json_dumps(copy, JSON_PRESERVE_ORDER) : NULL;
    json_decref(copy);
    if (entry->text == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for an entry of \"particles\"");
        goto done;
    }
    if ((changes->flags & BP_PARSE_NO_CLOUDS) == 0)
        status = read_file(&file, entry, place, changes, scene, err);
done:
    free(entry->text);
    free(entry);
    return status;
}

BpStatus bp_parse_particles(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                            BpScene *scene, BpError *err) {
    scene->particle_first = scene->sphere_count;
    BP_TRY(bp_node_list(node, "a list of files: [ { \"file\": \"run.gsd\", ... } ]", err));
    scene->has_particles = json_array_size(node->value) > 0;
    for (size_t i = 0; i < json_array_size(node->value); i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(parse_entry(&element, i, index, changes, scene, err));
    }
    return BP_OK;
}
