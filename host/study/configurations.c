/* configurations.c: which configurations are compared; see configurations.h. */
#include "configurations.h"

#include "base/names.h"
#include "base/words.h"
#include "render/render_plan.h"

#include <stdio.h>
#include <string.h>

/* The changes of a row; 0 keeps the base's value, enumerations are stored plus 1. */
typedef struct Change {
    uint32_t depth;
#define MEMBER(type, member, option, plural) unsigned member;
    BP_SETTING_LIST(MEMBER)
#undef MEMBER
    BpStudyFresnel fresnel;
    bool adaptive;
} Change;

typedef struct Row {
    const char *axis, *name;
    Change change;
} Row;

#define SAMPLER(x) .sampler = (BP_SAMPLER_##x + 1)
#define PRECISION(x) .precision = (BP_PRECISION_##x + 1)
#define MATH(x) .math = (BP_MATH_##x + 1)
#define NUMERICS(x) .numerics = (BP_NUMERICS_##x + 1)
#define LIGHT_SAMPLING(x) .light_sampling = (BP_LIGHT_SAMPLING_##x + 1)
#define CAUSTICS(x) .caustics = (BP_CAUSTICS_##x + 1)
#define ROULETTE(x) .roulette = (BP_ROULETTE_##x + 1)
#define FRESNEL(x) .fresnel = BP_STUDY_FRESNEL_##x

/* One line for each configuration. A new axis that is a setting of base/names.h is a line here; another is
 * also a member of Change, and a line each in apply() and write_command(). */
static const Row rows[] = {
    {"truth",
     "no approximations",
     {.depth = BP_STUDY_DEPTH, PRECISION(DOUBLE), MATH(STRICT), NUMERICS(ROBUST), FRESNEL(EXACT)}},
    {"sampler", "independent samples", {SAMPLER(INDEPENDENT)}},
    {"sampler", "Sobol samples", {SAMPLER(SOBOL)}},
    {"adaptive", "adaptive samples", {.adaptive = true}},
    {"light_sampling", "rays to lamps", {LIGHT_SAMPLING(ON)}},
    {"light_sampling", "lamps found by chance", {LIGHT_SAMPLING(OFF)}},
    {"caustics", "rays through focusers", {CAUSTICS(ON)}},
    {"caustics", "caustics found by chance", {CAUSTICS(OFF)}},
    {"roulette", "roulette for deep paths", {ROULETTE(ON)}},
    {"roulette", "deep paths traced on", {ROULETTE(OFF)}},
    {"depth", "depth 5", {.depth = 5}},
    {"depth", "depth 10", {.depth = 10}},
    {"depth", "depth 20", {.depth = 20}},
    {"depth", "depth 50", {.depth = 50}},
    {"depth", "depth 1000", {.depth = BP_STUDY_DEPTH}},
    {"precision", "double precision", {PRECISION(DOUBLE)}},
    {"precision", "single precision", {PRECISION(SINGLE)}},
    {"math", "fast math", {MATH(FAST)}},
    {"math", "strict math", {MATH(STRICT)}},
    {"numerics", "plain numerics", {NUMERICS(PLAIN)}},
    {"numerics", "robust numerics", {NUMERICS(ROBUST)}},
    {"fresnel", "exact Fresnel", {FRESNEL(EXACT)}},
    {"fresnel", "Schlick's Fresnel", {FRESNEL(SCHLICK)}},
    {"together",
     "as in the book",
     {.depth = 50, SAMPLER(INDEPENDENT), PRECISION(DOUBLE), NUMERICS(PLAIN), FRESNEL(SCHLICK)}},
    {"together", "all shortcuts", {.depth = 10, MATH(FAST), NUMERICS(PLAIN)}},
};

#define FRESNEL_WORDS(X)                                                                                     \
    X(BP_STUDY_FRESNEL_SCENE, "scene")                                                                       \
    X(BP_STUDY_FRESNEL_SCHLICK, "schlick") X(BP_STUDY_FRESNEL_EXACT, "exact")
BP_WORDS(BpStudyFresnel, static const char *const fresnel_names, FRESNEL_WORDS);

const char *bp_study_fresnel_name(BpStudyFresnel fresnel) {
    return fresnel_names[fresnel];
}

/* Whether a dielectric in use would look different with this Fresnel. */
static bool fresnel_matters(const BpScene *scene, BpStudyFresnel fresnel) {
    const BpFresnel wanted = fresnel == BP_STUDY_FRESNEL_EXACT ? BP_FRESNEL_EXACT : BP_FRESNEL_SCHLICK;
    for (size_t s = 0; s < scene->sphere_count && fresnel != BP_STUDY_FRESNEL_SCENE; s++) {
        const BpMaterial *material = &scene->materials[scene->spheres[s].material];
        if (material->kind == BP_MATERIAL_DIELECTRIC && material->fresnel != BP_FRESNEL_NONE &&
            material->fresnel != wanted)
            return true;
    }
    return false;
}

/* The options of `ballpark render` when none is given. */
static const BpRenderOptions defaults = {.sampler = BP_SAMPLER_SOBOL};

/* The options that `ballpark render` needs beside the scene, which has a depth of its own. */
static void write_command(const BpScene *scene, BpStudyConfiguration *configuration) {
    const BpRenderOptions *options = &configuration->options;
    char *command = configuration->command;
    command[0] = '\0';
#define ADD(...)                                                                                             \
    snprintf(command + strlen(command), sizeof configuration->command - strlen(command), __VA_ARGS__)
    /* A setting that the program chooses itself is named only if the scene leaves a choice. */
    const BpRenderOptions through = {.caustics = BP_CAUSTICS_ON};
    const bool other_caustics =
        options->caustics != BP_CAUSTICS_AUTO && bp_render_caustics(scene, &through) == BP_CAUSTICS_ON;
    BpRenderOptions usual = defaults;
    if (!other_caustics) usual.caustics = options->caustics;
#define ADD_SETTING(type, member, option, plural)                                                            \
    if (options->member != usual.member) ADD(" --" option " %s", bp_##member##_names[options->member]);
    BP_SETTING_LIST(ADD_SETTING)
    if (options->adaptive) ADD(" --adaptive");
    if (options->max_depth != scene->camera.max_depth) ADD(" --depth %u", options->max_depth);
#undef ADD_SETTING
#undef ADD
    if (command[0] != '\0') memmove(command, command + 1, strlen(command));
}

/* Makes a configuration of a row; false when it is the base itself. */
static bool apply(const Row *row, const BpScene *scene, const BpRenderOptions *base,
                  BpStudyConfiguration *configuration) {
    const Change *change = &row->change;
    BpRenderOptions *options = &configuration->options;
    *configuration = (BpStudyConfiguration){.axis = row->axis, .name = row->name};
    *options = *base;
    if (change->depth > 0) options->max_depth = change->depth;
    bool differs = false;
#define APPLY(type, member, option, plural)                                                                  \
    if (change->member > 0) options->member = (type)(change->member - 1);                                    \
    differs = differs || options->member != base->member;
    BP_SETTING_LIST(APPLY)
#undef APPLY
    if (change->light_sampling > 0 && bp_render_light_sampling(scene, &defaults) == BP_LIGHT_SAMPLING_OFF)
        return false;
    const BpRenderOptions through = {.caustics = BP_CAUSTICS_ON};
    if (change->caustics > 0 && bp_render_caustics(scene, &through) == BP_CAUSTICS_OFF) return false;
    const BpRenderOptions played = {.max_depth = options->max_depth, .roulette = BP_ROULETTE_ON};
    if (change->roulette > 0 && bp_render_roulette(scene, &played) == BP_ROULETTE_OFF) return false;
    if (change->adaptive) options->adaptive = true;
    if (fresnel_matters(scene, change->fresnel)) configuration->fresnel = change->fresnel;
    write_command(scene, configuration);
    return differs || options->max_depth != base->max_depth || options->adaptive != base->adaptive ||
           configuration->fresnel != BP_STUDY_FRESNEL_SCENE;
}

size_t bp_study_configurations(const BpScene *scene, const BpRenderOptions *base, bool has_double,
                               BpStudyConfiguration configurations[BP_STUDY_CONFIGURATIONS_MAX]) {
    _Static_assert(sizeof rows / sizeof rows[0] < BP_STUDY_CONFIGURATIONS_MAX,
                   "room for every row and the base");
    size_t count = 1;
    configurations[0] =
        (BpStudyConfiguration){.axis = "base", .name = "base configuration", .options = *base};
    write_command(scene, &configurations[0]);
    for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
        const bool differs = apply(&rows[r], scene, base, &configurations[count]);
        const bool possible = has_double || configurations[count].options.precision == BP_PRECISION_SINGLE;
        /* The truth is a separate row even if the base equals it. */
        if (possible && (differs || r == 0)) count++;
    }
    return count;
}
