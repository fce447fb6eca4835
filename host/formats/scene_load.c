/* scene_load.c: see scene_load.h and ballpark.h. */
#include "scene_load.h"

#include "base/input_file.h"
#include "document_change.h"
#include "file_document.h"
#include "meshes/mesh.h"
#include "particles/particles.h"
#include "scene_parse.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

BpStatus bp_scene_parse_changed(const char *text, size_t length, const char *name,
                                const BpSceneChanges *changes, BpScene **scene, BpError *err) {
    BpDocument document = {0};
    BpScene *result = NULL;
    *scene = NULL;
    BpStatus status;
    BP_TRY_GOTO(status, bp_document_open(text, length, name, &document, err), done);
    document.held = changes->held;
    BP_TRY_GOTO(status, bp_document_change(&document, changes->set_by, changes->set, changes->set_count, err),
                done);
    BP_TRY_GOTO(status, bp_scene_create_empty(name, &result, err), done);
    const BpNode root = bp_node_root(&document);
    BP_TRY_GOTO(status, bp_parse_scene(&root, changes, result, err), done);
    *scene = result;
    result = NULL;
done:
    bp_scene_destroy(&result);
    bp_document_close(&document);
    return status;
}

BpStatus bp_scene_parse(const char *text, size_t length, const char *name, BpScene **scene, BpError *err) {
    const BpSceneChanges none = {0};
    return bp_scene_parse_changed(text, length, name, &none, scene, err);
}

BpStatus bp_scene_parse_with_spheres(const char *text, size_t length, const char *name,
                                     const BpSphereSet *sets, size_t set_count, BpScene **scene,
                                     BpError *err) {
    const BpShapeSets shapes = {.spheres = sets, .sphere_set_count = set_count};
    return bp_scene_parse_with_shapes(text, length, name, &shapes, scene, err);
}

BpStatus bp_scene_parse_with_shapes(const char *text, size_t length, const char *name,
                                    const BpShapeSets *shapes, BpScene **scene, BpError *err) {
    const BpSceneChanges changes = {.shapes = *shapes};
    return bp_scene_parse_changed(text, length, name, &changes, scene, err);
}

/* A document for a file of particles or of a mesh; *text is NULL for other files. */
static BpStatus make_document(const char *path, char **text, char note[BP_DOCUMENT_NOTE_SIZE], BpError *err) {
    FILE *stream = NULL;
    uint64_t size = 0;
    *text = NULL;
    note[0] = '\0';
    struct stat state;
    if (stat(path, &state) == 0 && S_ISFIFO(state.st_mode)) return BP_OK; /* what is read from it is gone */
    BP_TRY(bp_file_open(path, false, "a scene document (a JSON file) or a file of particles or a mesh",
                        &stream, &size, err));
    if (bp_mesh_is_file(path)) {
        fclose(stream);
        return bp_mesh_document(path, text, note, err);
    }
    const BpParticleFormat format = bp_particle_format_find(path, stream);
    fclose(stream);
    return format == BP_PARTICLES_NONE ? BP_OK : bp_particle_document(path, text, err);
}

BpStatus bp_scene_load_changed(const char *path, const BpSceneChanges *changes, BpScene **scene,
                               BpError *err) {
    char *text = NULL;
    size_t length = 0;
    BpSceneChanges made = *changes;
    *scene = NULL;
    char note[BP_DOCUMENT_NOTE_SIZE];
    BP_TRY(make_document(path, &text, note, err));
    if (text != NULL) {
        made.flags |= BP_PARSE_MADE;
        length = strlen(text);
    } else {
        BP_TRY(bp_file_read(path, "a scene document (a JSON file)", &text, &length, err));
    }
    BpStatus status = bp_scene_parse_changed(text, length, path, &made, scene, err);
    free(text);
    if (status == BP_OK && note[0] != '\0') status = bp_scene_note(*scene, path, note, err);
    if (status != BP_OK) bp_scene_destroy(scene);
    return status;
}

BpStatus bp_scene_load_selected(const char *path, const char *select, BpScene **scene, BpError *err) {
    const BpSceneChanges changes = {.select = select, .select_by = "select"};
    BP_TRY(bp_scene_load_changed(path, &changes, scene, err));
    if ((*scene)->has_particles) return BP_OK;
    bp_scene_destroy(scene);
    return bp_fail(err, BP_ERR_SCENE, "select: %.400s has no particles to select from", path);
}

BpStatus bp_scene_load(const char *path, BpScene **scene, BpError *err) {
    const BpSceneChanges none = {0};
    return bp_scene_load_changed(path, &none, scene, err);
}
