/* explain_chains.c: see explain_chains.h. */
#include "explain_chains.h"

#include "base/escape.h"
#include "base/format.h"
#include "base/names.h"
#include "base/status.h"
#include "cli/output/json_file.h"
#include "packed/focusers.h"
#include "packed/lamp_tree.h"
#include "scene/vector.h"
#include "study/chains.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct BpChainEntry {
    BpChain chain;
    BpChainWay ways[BP_CHAIN_WAYS_MAX];
    size_t count;
};

/* The first step that hits a matte surface, or the number of steps. */
static size_t first_matte(const BpScene *scene, const BpPathLog *path) {
    size_t i = 0;
    while (i < path->count &&
           !(path->steps[i].met && scene->materials[path->steps[i].material].kind == BP_MATERIAL_LAMBERTIAN))
        ++i;
    return i;
}

/* The kernel's point is rounded; this is the nearest point on the sphere. */
static BpChainPoint point_of(const BpScene *scene, const BpPathStep *step) {
    const BpSphere *sphere = &scene->spheres[step->sphere];
    BpChainPoint point = {.sphere = step->sphere, .scatter = scene->materials[step->material].scatter};
    double out[3];
    for (int a = 0; a < 3; ++a) out[a] = step->point[a] - sphere->center[a];
    bp_normalize(out);
    const double towards = bp_dot(out, step->direction);
    for (int a = 0; a < 3; ++a) {
        point.point[a] = sphere->center[a] + fabs(sphere->radius) * out[a];
        point.normal[a] = towards < 0 ? out[a] : -out[a];
    }
    return point;
}

/* Adds the light of one chain, if there is any. */
static BpStatus add_chain(const BpScene *scene, const BpChainPoint *point, const double weight[3],
                          const BpChain *chain, BpChainLight *light, BpError *err) {
    BpChainEntry entry = {.chain = *chain};
    BP_TRY(bp_chain_ways(scene, point, chain, entry.ways, &entry.count, err));
    if (entry.count == 0) return BP_OK;
    BpChainEntry *entries = realloc(light->entries, (light->count + 1) * sizeof *entries);
    if (entries == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for the ways of light");
    light->entries = entries;
    for (size_t w = 0; w < entry.count; ++w)
        for (int c = 0; c < 3; ++c) entry.ways[w].brings[c] *= weight[c];
    entries[light->count++] = entry;
    return BP_OK;
}

/* All chains of a sphere and a lamp that fit into `segments`. */
static BpStatus add_chains(const BpScene *scene, const BpChainPoint *point, const double weight[3],
                           BpChain chain, uint32_t segments, BpChainLight *light, BpError *err) {
    const uint32_t most = bp_focuser_vertices(scene, chain.sphere);
    for (chain.chords = 0; chain.chords < most && chain.chords + 2 <= segments; ++chain.chords)
        BP_TRY(add_chain(scene, point, weight, &chain, light, err));
    return BP_OK;
}

BpStatus bp_chain_light_find(const BpScene *scene, const BpPathLog *path, uint32_t max_depth,
                             BpChainLight *light, BpError *err) {
    char reason[160];
    *light = (BpChainLight){.step = first_matte(scene, path)};
    if (light->step == path->count || !bp_focusers_explain(scene, sizeof reason, reason)) return BP_OK;
    const BpPathStep *step = &path->steps[light->step];
    const BpChainPoint point = point_of(scene, step);
    const uint32_t segments = max_depth - (uint32_t)light->step - 1;
    const size_t enclosing = bp_enclosing_lamp(scene);
    size_t lamps[BP_FOCUSER_LAMPS_MAX], lamp_count = 0;
    light->known = true;
    for (size_t i = 0; i < scene->sphere_count && lamp_count < BP_FOCUSER_LAMPS_MAX; ++i)
        if (bp_sphere_is_sampled(scene, i, enclosing)) lamps[lamp_count++] = i;
    for (uint32_t i = 0; i < scene->sphere_count; ++i) {
        for (size_t l = 0; l < lamp_count; ++l) {
            const BpChain chain = {.sphere = i, .lamp = (uint32_t)lamps[l]};
            if (bp_focuses_lamp(scene, i, lamps[l]))
                BP_TRY(add_chains(scene, &point, step->throughput, chain, segments, light, err));
        }
        for (uint32_t d = 0; d < scene->disc_count; ++d) {
            const BpChain chain = {.sphere = i, .disc = true, .lamp = d};
            if (bp_focuses_disc(scene, i, d))
                BP_TRY(add_chains(scene, &point, step->throughput, chain, segments, light, err));
        }
    }
    return BP_OK;
}

void bp_chain_light_clear(BpChainLight *light) {
    free(light->entries);
    *light = (BpChainLight){0};
}

/* ---- for a person ---- */

static void print_way(const BpScene *scene, const BpChain *chain, const BpChainWay *way, FILE *out) {
    static const char *const hows[] = {"off", "through", "reflected inside", "reflected twice inside"};
    char share[32];
    fprintf(out, "       %s %" PRIu32 " %s sphere %" PRIu32 " (", chain->disc ? "disc" : "lamp", chain->lamp,
            hows[chain->chords], chain->sphere);
    bp_print_escaped(scene->materials[scene->spheres[chain->sphere].material].name, false, out);
    fputs(") ", out);
    if (way->stopped < 1)
        fprintf(out, "brings (%.4g, %.4g, %.4g)", way->brings[0], way->brings[1], way->brings[2]);
    else
        fprintf(out, "is stopped by sphere %" PRIu32, way->by);
    fprintf(out, "\n         at (%.5g, %.5g, %.5g), along (%.4f, %.4f, %.4f)\n", way->at[0], way->at[1],
            way->at[2], way->direction[0], way->direction[1], way->direction[2]);
    if (way->stopped > 0 && way->stopped < 1)
        fprintf(out, "         sphere %" PRIu32 " stops %s of it\n", way->by,
                bp_format_percent(way->stopped, share, sizeof share));
    if (!way->to_middle) fputs("         not to the middle of the light, but to a part of it\n", out);
}

void bp_chain_light_print(const BpScene *scene, const BpChainLight *light, bool sampled, FILE *out) {
    if (!light->known) return;
    fprintf(out, "  light at the end of step %zu from balls of glass and mirrors", light->step + 1);
    fprintf(out, light->count == 0 ? ": none\n" : " (--caustics %s):\n",
            bp_caustics_names[sampled ? BP_CAUSTICS_ON : BP_CAUSTICS_OFF]);
    for (size_t e = 0; e < light->count; ++e)
        for (size_t w = 0; w < light->entries[e].count; ++w)
            print_way(scene, &light->entries[e].chain, &light->entries[e].ways[w], out);
}

/* ---- as JSON ---- */

static json_t *way_json(const BpChain *chain, const BpChainWay *way) {
    return json_pack("{s:I, s:I, s:I, s:o, s:o, s:f, s:b, s:o, s:f, s:o}", "sphere",
                     (json_int_t)chain->sphere, chain->disc ? "disc" : "lamp", (json_int_t)chain->lamp,
                     "chords", (json_int_t)chain->chords, "at", bp_json_triple(way->at), "direction",
                     bp_json_triple(way->direction), "degrees", way->degrees, "to_middle", way->to_middle,
                     "brings", bp_json_triple(way->brings), "stopped", way->stopped, "stopped_by",
                     way->stopped > 0 ? json_integer(way->by) : json_null());
}

json_t *bp_chain_light_json(const BpChainLight *light, bool sampled) {
    if (!light->known) return json_null();
    json_t *ways = json_array();
    for (size_t e = 0; e < light->count && ways != NULL; ++e)
        for (size_t w = 0; w < light->entries[e].count && ways != NULL; ++w) {
            if (json_array_append_new(ways, way_json(&light->entries[e].chain, &light->entries[e].ways[w])) ==
                0)
                continue;
            json_decref(ways);
            ways = NULL;
        }
    return json_pack("{s:I, s:b, s:o}", "step", (json_int_t)light->step + 1, "sampled", sampled, "ways",
                     ways);
}
