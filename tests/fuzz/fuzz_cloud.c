/* fuzz_cloud.c: any text as a scene document with the points of any PLY file.
 *
 * The input is the document, then the PLY file, which begins at the first line that is "ply". It stands as
 * cloud.ply in a folder of its own, and the document beside it. A document that names a file in another
 * folder is read without its clouds: a fuzzer would find its way to anything on the disk. What is accepted is
 * valid, keeps the order of its clouds, and makes a tree in which every sphere stands once. */
#include "formats/scene_load.h"
#include "tree_check.h"

#include <jansson.h>
#include <stdio.h>
#include <unistd.h>

#define FOLDER "/tmp/ballpark-fuzz-XXXXXX"
#define PACKED_MAX 500 /* spheres: trees of more cost too much time */

int LLVMFuzzerInitialize(int *argc, char ***argv);

static char folder[] = FOLDER, cloud_path[sizeof FOLDER + 16], scene_path[sizeof FOLDER + 16];

static void remove_folder(void) {
    unlink(cloud_path);
    rmdir(folder);
}

int LLVMFuzzerInitialize(int *argc, char ***argv) {
    (void)argc;
    (void)argv;
    require(mkdtemp(folder) != NULL);
    snprintf(cloud_path, sizeof cloud_path, "%s/cloud.ply", folder);
    snprintf(scene_path, sizeof scene_path, "%s/x.json", folder);
    atexit(remove_folder);
    return 0;
}

/* Where the PLY file begins; `size` when there is none. */
static size_t find_ply(const uint8_t *data, size_t size) {
    for (size_t i = 0; i + 4 <= size; i++)
        if ((i == 0 || data[i - 1] == '\n') && memcmp(data + i, "ply", 3) == 0 &&
            (data[i + 3] == '\n' || data[i + 3] == '\r'))
            return i;
    return size;
}

/* Whether all clouds and particles are files of the document's own folder. */
static bool stays_home(const uint8_t *document, size_t length) {
    json_t *root = json_loadb((const char *)document, length, JSON_REJECT_DUPLICATES | JSON_ALLOW_NUL, NULL);
    json_t *cloud = NULL;
    size_t i = 0;
    bool home = root != NULL;
    json_array_foreach(json_object_get(root, "clouds"), i, cloud) {
        const char *file = json_string_value(json_object_get(cloud, "file"));
        if (file != NULL && strchr(file, '/') != NULL) home = false;
    }
    json_array_foreach(json_object_get(root, "particles"), i, cloud) {
        const char *file = json_string_value(json_object_get(cloud, "file"));
        if (file != NULL && strchr(file, '/') != NULL) home = false;
    }
    json_decref(root);
    return home;
}

static void check_scene(const BpScene *scene) {
    require(bp_scene_validate(scene, NULL) == BP_OK);
    for (size_t i = 0; i < scene->point_file_count; i++)
        require(scene->point_files[i].first <= scene->sphere_count &&
                (i == 0 || scene->point_files[i - 1].first <= scene->point_files[i].first));
    for (size_t i = 0; i < scene->sphere_count; i++) {
        const BpSphere *sphere = &scene->spheres[i];
        require(sphere->material < scene->material_count);
        require(sphere->albedo == BP_NO_ALBEDO || sphere->albedo < scene->albedo_count);
    }
    if (scene->sphere_count > PACKED_MAX) return;
    for (int single = 0; single < 2; single++) {
        const BpTreeOptions options = {
            .width = 8, .single_precision = single == 1, .list = scene->sphere_count % 2 == 0, .threads = 1};
        check_packed(scene, &options);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const size_t length = find_ply(data, size);
    FILE *file = fopen(cloud_path, "wb");
    require(file != NULL && fwrite(data + length, 1, size - length, file) == size - length &&
            fclose(file) == 0);
    BpScene *scene = NULL;
    BpError err = {0};
    const BpSceneChanges changes = {.flags = stays_home(data, length) ? 0 : BP_PARSE_NO_CLOUDS};
    const BpStatus status =
        bp_scene_parse_changed((const char *)data, length, scene_path, &changes, &scene, &err);
    if (status != BP_OK)
        require(scene == NULL && err.code == status && err.message[0] != '\0' && err.file[0] != '\0');
    else
        check_scene(scene);
    bp_error_clear(&err);
    bp_scene_destroy(&scene);
    return 0;
}
