/* scene_load.h: scenes from texts and files.
 *
 * In:    a document, or the path of one or of a file of particles.   Out: a BpScene.
 * Knows: which files are documents, the changes of a command line.   Does not know: how a document is read
 * (scene_parse.h). */
#ifndef BP_FORMATS_SCENE_LOAD_H
#define BP_FORMATS_SCENE_LOAD_H

#include "scene_changes.h"

/* bp_scene_parse with changes. */
BpStatus bp_scene_parse_changed(const char *text, size_t length, const char *name,
                                const BpSceneChanges *changes, BpScene **scene, BpError *err);
/* bp_scene_load with changes. */
BpStatus bp_scene_load_changed(const char *path, const BpSceneChanges *changes, BpScene **scene,
                               BpError *err);

#endif
