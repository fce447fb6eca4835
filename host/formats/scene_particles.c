/* scene_particles.c: see scene_particles.h. */
#include "scene_particles.h"

#include "base/input_file.h"
#include "base/json_memory.h"
#include "named_file.h"
#include "particle_cache.h"
#include "particle_members.h"
#include "particle_shapes.h"
#include "particles/add_to_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Entry {
    const char *file;
    int64_t frame;
    uint32_t material;
    BpParticleStyle style;
    char *text; /* as JSON, owned */
} Entry;

static void keep_range(const BpParticleStyle *style, const double range[2], BpScene *scene) {
    BpColorBar *const bar = &scene->figure.bar;
    scene->has_color_range = true;
    memcpy(scene->color_range, range, sizeof scene->color_range);
    if (!style->bar) return;
    const char *const label = style->label[0] != '\0' ? style->label : style->color_column;
    bar->shown = true;
    if (style->unit[0] != '\0')
        snprintf(bar->label, sizeof bar->label, "%s (%s)", label, style->unit);
    else
        snprintf(bar->label, sizeof bar->label, "%s", label);
    memcpy(bar->range, range, sizeof bar->range);
    for (int i = 0; i < BP_COLOR_BAR_STOPS; i++) {
        double color[3];
        bp_particle_style_map(style, i / (double)(BP_COLOR_BAR_STOPS - 1), color);
        for (int c = 0; c < 3; c++) bar->colors[i][c] = (float)color[c];
    }
}

/* Whether an entry of a film may select nothing in this frame. */
static bool may_miss(const BpFilmSelections *film, size_t place) {
    return film != NULL && place < BP_FILM_ENTRIES_MAX && (film->looking || film->found[place]);
}

static void note_film(BpFilmSelections *film, size_t place, bool found) {
    if (film == NULL || place >= BP_FILM_ENTRIES_MAX || !film->looking) return;
    film->found[place] |= found;
    film->missed[place] |= !found;
}

static BpStatus add_particles(BpParticleFile *file, const char *path, const Entry *entry, size_t place,
                              BpFilmSelections *film, BpScene *scene, BpError *err) {
    BpParticles particles = {0};
    const size_t first = bp_scene_shapes(scene), first_triangle = scene->triangle_count;
    char summary[1024];
    double range[2];
    BpStatus status = bp_particle_file_frame(file, entry->frame, &particles, err);
    if (status == BP_OK) {
        status = bp_cut_particle_shapes(&particles, err);
        if (status == BP_ERR_SCENE) bp_error_at(err, path, 0, 0);
    }
    if (status == BP_OK) {
        status = bp_particles_add_to_scene(&particles, &entry->style, may_miss(film, place), entry->material,
                                           scene, summary, sizeof summary, range, err);
        if (status == BP_ERR_SCENE) bp_error_at(err, path, 0, 0);
    }
    const bool added = bp_scene_shapes(scene) > first;
    if (status == BP_OK && scene->triangle_count > first_triangle) {
        status = bp_keep_mesh_file(entry->file, first_triangle, NULL, scene, err);
        if (status == BP_OK) scene->mesh_files[scene->mesh_file_count - 1].of_particles = true;
    }
    if (status == BP_OK) note_film(film, place, added);
    if (status == BP_OK && entry->style.color_by == BP_COLOR_COLUMN && added)
        keep_range(&entry->style, range, scene);
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
    BpStatus status = bp_particle_cache_open(file_node, path, &entry->style, place, cache, &file, err);
    if (status == BP_OK) {
        if (changes->frame_count != NULL)
            status = bp_particle_file_count(file, &count, err);
        else
            status = add_particles(file, path, entry, place, changes->film, scene, err);
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

static BpStatus parse_entry(const BpNode *node, size_t place, const BpMaterialIndex *index,
                            const BpSceneChanges *changes, BpScene *scene, BpError *err) {
    static const char *const names[] = {"file", "frame",   "style", "radius",   "color",  "bonds",
                                        "box",  "solvent", "whole", "material", "select", "shapes"};
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
    BP_TRY_GOTO(status, bp_parse_particle_style(node, changes->select, &entry->style, err), done);
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
    if (whole && changes->select != NULL)
        whole =
            json_object_set_new(copy, "select", json_string(bp_expression_text(entry->style.select))) == 0;
    entry->text = whole ? json_dumps(copy, JSON_PRESERVE_ORDER) : NULL;
    json_decref(copy);
    if (entry->text == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for an entry of \"particles\"");
        goto done;
    }
    if ((changes->flags & BP_PARSE_NO_CLOUDS) == 0)
        status = read_file(&file, entry, place, changes, scene, err);
done:
    bp_particle_style_clear(&entry->style);
    free(entry->text);
    free(entry);
    return status;
}

/* What narrows all selections is wrong where it comes from, not in an entry. */
static BpStatus check_select(const BpSceneChanges *changes, BpError *err) {
    BpExpression *expression = NULL;
    BpError fault = {0};
    if (changes->select == NULL) return BP_OK;
    const BpStatus status = bp_select_parse(changes->select, BP_VALUE_TRUTH, &expression, &fault);
    bp_expression_destroy(&expression);
    if (status == BP_OK) return BP_OK;
    bp_fail(err, status, "%s: %s", changes->select_by, fault.message);
    bp_error_attach(err, fault.attachment);
    bp_error_clear(&fault);
    return status;
}

BpStatus bp_parse_particles(const BpNode *node, const BpMaterialIndex *index, const BpSceneChanges *changes,
                            BpScene *scene, BpError *err) {
    scene->particle_first = scene->sphere_count;
    BP_TRY(check_select(changes, err));
    BP_TRY(bp_node_list(node, "a list of files: [ { \"file\": \"run.gsd\", ... } ]", err));
    scene->has_particles = json_array_size(node->value) > 0;
    for (size_t i = 0; i < json_array_size(node->value); i++) {
        const BpNode element = bp_node_element(node, i);
        BP_TRY(parse_entry(&element, i, index, changes, scene, err));
    }
    return BP_OK;
}
