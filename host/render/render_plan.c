/* render_plan.c: see render_plan.h. */
#include "render_plan.h"

#include "base/status.h"
#include "packed/acceleration.h"
#include "packed/rounding.h"
#include "roulette_types.h"

#include <string.h>

/* Drivers of CPUs that know vectors spread explicit vectors over their lanes. There, a kernel follows many
 * paths at a time through sixteen-wide nodes; double costs little. A CPU driver that splits vectors
 * up (it reports one lane) gains nothing from many lanes, and one was seen to compile that form for ever.
 * GPUs spread work-items, and many have hardly any double: one lane, narrower nodes, error-free float
 * transforms. The options can force each choice, so every arrangement can be tested on every device. */
static void choose_form(const BpDeviceInfo *device, const BpRenderOptions *options,
                        BpProgramOptions *program) {
    const bool cpu = device->type == BP_DEVICE_CPU;
    const bool vectors = cpu && device->float_lanes >= 4;
    program->form = options->kernel != BP_KERNEL_AUTO ? options->kernel
                    : vectors                         ? BP_KERNEL_PACKET
                                                      : BP_KERNEL_SAMPLE;
    program->tree_width = options->tree_width != 0 ? options->tree_width : vectors ? 16 : 4;
    program->double_refine = cpu && device->has_double && !options->force_float_refine;
}

/* Paths of a packet: sixteen where a vector has as many lanes, else eight, which need fewer registers. But
 * while rays walk through a large tree they wait for memory, and with sixteen there is more to do meanwhile:
 * so vectors of eight lanes follow sixteen there (docs/TUNING.md). */
static uint32_t choose_packet_lanes(const BpDeviceInfo *device, const BpRenderOptions *options,
                                    const BpTree *tree) {
    if (options->packet_lanes != 0) return options->packet_lanes;
    const bool walks = tree->leaf_count - tree->first_leaves > FLAT_LEAVES_MAX;
    return device->float_lanes >= 16 || (device->float_lanes >= 8 && walks) ? 16 : 8;
}

BpLightSampling bp_render_light_sampling_of(const BpEffects *effects, const BpRenderOptions *options) {
    return bp_effects_has(effects->bits, BP_EFFECT_LAMPS) ? options->light_sampling : BP_LIGHT_SAMPLING_OFF;
}

BpCaustics bp_render_caustics_of(const BpEffects *effects, const BpRenderOptions *options) {
    return effects->caustics && bp_render_light_sampling_of(effects, options) == BP_LIGHT_SAMPLING_ON
               ? options->caustics
               : BP_CAUSTICS_OFF;
}

BpCaustics bp_render_caustics(const BpScene *scene, const BpRenderOptions *options) {
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    return bp_render_caustics_of(&effects, options);
}

/* Whether a path can be as deep as roulette begins, and carry less by then. */
static bool may_play(const BpEffects *effects, const BpRenderOptions *options) {
    return effects->dims && options->max_depth > ROULETTE_SEGMENTS;
}

BpRoulette bp_render_roulette_of(const BpEffects *effects, const BpRenderOptions *options) {
    return may_play(effects, options) ? options->roulette : BP_ROULETTE_OFF;
}

BpRoulette bp_render_roulette(const BpScene *scene, const BpRenderOptions *options) {
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    return bp_render_roulette_of(&effects, options);
}

BpLightSampling bp_render_light_sampling(const BpScene *scene, const BpRenderOptions *options) {
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    return bp_render_light_sampling_of(&effects, options);
}

static uint32_t choose_effects(const BpEffects *effects, const BpRenderOptions *options) {
    /* The scene may say another depth than the options. */
    const uint32_t own = effects->bits & ~(1u << BP_EFFECT_ROULETTE);
    uint32_t wanted = options->all_effects ? BP_EFFECTS_ALL : own | (options->extra_effects & BP_EFFECTS_ALL);
    if (bp_render_caustics_of(effects, options) == BP_CAUSTICS_ON) wanted |= 1u << BP_EFFECT_CAUSTICS;
    /* Where it is never played, the general kernel is the same for all scenes. */
    if (may_play(effects, options)) {
        wanted &= ~(1u << BP_EFFECT_ROULETTE);
        if (options->roulette == BP_ROULETTE_ON) wanted |= 1u << BP_EFFECT_ROULETTE;
    }
    if (options->light_sampling == BP_LIGHT_SAMPLING_OFF)
        wanted &= ~(1u << BP_EFFECT_LAMPS | 1u << BP_EFFECT_CAUSTICS | 1u << BP_EFFECT_TRIANGLE_LAMPS);
    return wanted;
}

/* Whether a kernel needs its code for spheres even if there are none: media are flown through by it, and rays
 * are sent by it to what is not a triangle. */
static bool needs_spheres(uint32_t effects) {
    const uint32_t others = 1u << BP_EFFECT_DISCS | 1u << BP_EFFECT_ENVIRONMENT | 1u << BP_EFFECT_CAUSTICS;
    return bp_effects_has(effects, BP_EFFECT_MEDIA) || bp_effects_has(effects, BP_EFFECT_CAPSULES) ||
           (bp_effects_has(effects, BP_EFFECT_LAMPS) &&
            (!bp_effects_has(effects, BP_EFFECT_TRIANGLE_LAMPS) || (effects & others) != 0));
}

static bool choose_tree(const BpScene *scene, const BpRenderOptions *options) {
    if (options->force_list) return false;
    return options->force_tree || bp_acceleration_choose(scene, NULL) == BP_ACCELERATION_TREE;
}

BpStatus bp_render_plan(const BpScene *scene, const BpRenderOptions *options, const BpDeviceInfo *device,
                        BpWorkerSetup *setup, BpPacked *packed, BpError *err) {
    if (options->precision == BP_PRECISION_DOUBLE && !device->has_double)
        return bp_fail_with(BP_REMEDY_SINGLE_PRECISION_OR_OTHER_DEVICE, err, BP_ERR_DEVICE,
                            "%s has no double precision", device->name);
    BP_TRY(bp_rounding_check_indices(scene, options->precision, err));
    memset(setup, 0, sizeof *setup);
    BpEffects effects;
    bp_effects_analyse(scene, &effects);
    setup->program.effects = choose_effects(&effects, options);
    setup->program.tree = choose_tree(scene, options);
    setup->program.focuser_pairs =
        effects.focuser_pairs && bp_effects_has(setup->program.effects, BP_EFFECT_CAUSTICS);
    setup->program.triangles_alone = effects.triangles_alone && !needs_spheres(setup->program.effects);
#define SETTING(type, member, option, plural) setup->program.member = options->member;
    BP_SETTING_LIST(SETTING)
#undef SETTING
    setup->program.pixel_list = options->adaptive;
    choose_form(device, options, &setup->program);
    setup->width = scene->camera.width;
    setup->height = scene->camera.height;
    setup->replicates = options->replicates != 0 ? options->replicates : BP_REPLICATES_DEFAULT;
    const BpCaustics caustics = bp_render_caustics_of(&effects, options);
    setup->scale_log2 =
        bp_film_scale(scene, options->max_depth, bp_render_light_sampling_of(&effects, options), caustics,
                      bp_render_roulette_of(&effects, options));
    setup->max_depth = options->max_depth;
    setup->seed = options->seed;
    setup->pixel_center = scene->camera.pixel_sampling == BP_PIXEL_CENTER;
    setup->local_size = options->local_size;
    setup->untested = options->force;
    setup->build_mark = options->build_mark;
    setup->threads = options->threads;
    const BpTreeOptions tree_options = {
        .width = setup->program.tree_width,
        .single_precision = options->precision == BP_PRECISION_SINGLE,
        .list = !setup->program.tree,
        .threads = options->threads,
        .motions = bp_effects_has(setup->program.effects, BP_EFFECT_MOTION),
        .axes = bp_effects_has(setup->program.effects, BP_EFFECT_CAPSULES),
        .bodies = bp_effects_has(setup->program.effects, BP_EFFECT_BODY_MEDIA),
    };
    BP_TRY(bp_scene_pack(scene, &tree_options, bp_effects_has(setup->program.effects, BP_EFFECT_LAMPS),
                         caustics == BP_CAUSTICS_ON, packed, err));
    setup->program.packet_lanes = choose_packet_lanes(device, options, &packed->tree);
    return BP_OK;
}
