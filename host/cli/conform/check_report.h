/* check_report.h: the document of a check, and its table.
 *
 * In:    entries (check_entry.h) by scene.   Out: a JSON document; a table.
 * Knows: the structure of the document.   Does not know: how entries came about.
 *
 * The document of one scene is {"ballpark", "scene", "light_sampling", "caustics", "width",
 * "height", "samples_per_pixel", "max_depth", "seed", "spheres", "triangles", "capsules", "results": [an
 * entry for each device], "verdict", "broken_drivers"}; of a suite, {"ballpark", "suite", "level", "scenes":
 * [{"scene", ..., "results"}], "verdict", "broken_drivers"}. A scene whose lights are sampled stands twice in
 * "scenes": "light_sampling" is "off" in the first and "on" in the second. One whose lights are sampled by
 * way of balls of glass and mirrors stands there once more, and "caustics" is "on". The document of one such
 * scene has "scenes" as well. */
#ifndef BP_CLI_CONFORM_CHECK_REPORT_H
#define BP_CLI_CONFORM_CHECK_REPORT_H

#include "check_entry.h"

#include <stdio.h>

/* The document of one scene, without results: they are added to its "results". */
json_t *bp_check_scene_json(const char *name, const BpScene *scene, const BpRenderOptions *options);

/* The document. `scenes`: an array of the objects above, with results; `broken`: an array of drivers. Takes
 * ownership of both. `suite`: Optional, the name of the suite of that `level`; NULL: a single scene. NULL:
 * out of memory. */
json_t *bp_check_document(json_t *scenes, json_t *broken, const char *suite, double level);

/* The scenes of a document, of one scene or of a suite: a new array. NULL: it is not such a document, or
 * memory ran out. */
json_t *bp_check_document_scenes(const json_t *document);

void bp_check_count_all(const json_t *scenes, BpCheckCounts *counts);

/* Prints a table: of one scene, a line per device; of several, a line per scene below each device. `quiet`
 * omits results that agree. */
void bp_check_print_table(const json_t *scenes, bool quiet, FILE *out);

#endif
