/* program.c: see program.h. */
#include "program.h"

#include "base/clock.h"
#include "base/hash.h"
#include "forked.h"
#include "packed/effects.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Which programs contain a file: those of one form, those of one kind of numerics, or all. IN_SINGLE: the
 * forms whose work-items follow one path at a time. */
enum { IN_SAMPLE = 1, IN_PACKET = 2, IN_ROBUST = 4, IN_PLAIN = 8, IN_POOL = 16, IN_SINGLE = 32, IN_ALL = 0 };

/* The order in which a program contains the files of kernels/. A lanes_... file says for how many lanes the
 * files behind it are compiled (dialect/lanes.cl); some files are read again for another number of lanes. */
static const struct {
    const char *name;
    unsigned only_in;
} files[] = {
    {"dialect/real.cl", IN_ALL},
    {"dialect/fused.cl", IN_ALL},
    {"scene_types.h", IN_ALL},
    {"aov_list.h", IN_ALL},
    {"roulette_types.h", IN_ALL},
    /* for one lane */
    {"dialect/lanes_one.cl", IN_ALL},
    {"dialect/lanes.cl", IN_ALL},
    {"dialect/lane_by_lane.cl", IN_ALL},
    {"dialect/divide.cl", IN_ALL},
    {"dialect/vector.cl", IN_ALL},
    {"shape/ray.cl", IN_ALL},
    {"shape/sphere_robust.cl", IN_ROBUST},
    {"shape/sphere_plain.cl", IN_PLAIN},
    {"shape/wide.cl", IN_ROBUST},
    {"shape/capsule_robust.cl", IN_ROBUST},
    {"shape/capsule_plain.cl", IN_PLAIN},
    {"shape/triangle_robust.cl", IN_ROBUST},
    {"shape/triangle_plain.cl", IN_PLAIN},
    {"bvh/parts.cl", IN_ALL},
    {"bvh/flat_tree.cl", IN_PACKET},
    {"bvh/geometry.cl", IN_ALL},
    {"bvh/hit.cl", IN_ALL},
    {"bvh/box_ray.cl", IN_ALL},
    /* for the children of a node */
    {"dialect/lanes_node.cl", IN_ALL},
    {"dialect/lanes.cl", IN_ALL},
    {"dialect/lane_by_lane.cl", IN_ALL},
    {"dialect/divide.cl", IN_ALL},
    {"dialect/vector.cl", IN_ALL},
    {"shape/ray.cl", IN_ALL},
    {"shape/sphere_robust.cl", IN_ROBUST},
    {"shape/sphere_plain.cl", IN_PLAIN},
    {"shape/wide.cl", IN_ROBUST},
    {"shape/capsule_robust.cl", IN_ROBUST},
    {"shape/capsule_plain.cl", IN_PLAIN},
    {"shape/triangle_robust.cl", IN_ROBUST},
    {"shape/triangle_plain.cl", IN_PLAIN},
    {"bvh/child_mask.cl", IN_ALL},
    {"bvh/node.cl", IN_ALL},
    /* for one path, or for the paths of a packet */
    {"dialect/lanes_one.cl", IN_SINGLE},
    {"dialect/lanes_packet.cl", IN_PACKET},
    {"dialect/lanes.cl", IN_ALL},
    {"dialect/lane_by_lane.cl", IN_PACKET},
    {"dialect/divide.cl", IN_PACKET},
    {"dialect/vector.cl", IN_PACKET},
    {"shape/ray.cl", IN_PACKET},
    {"shape/sphere_robust.cl", IN_PACKET | IN_ROBUST},
    {"shape/sphere_plain.cl", IN_PACKET | IN_PLAIN},
    {"shape/wide.cl", IN_PACKET | IN_ROBUST},
    {"shape/capsule_robust.cl", IN_PACKET | IN_ROBUST},
    {"shape/capsule_plain.cl", IN_PACKET | IN_PLAIN},
    {"shape/triangle_robust.cl", IN_PACKET | IN_ROBUST},
    {"shape/triangle_plain.cl", IN_PACKET | IN_PLAIN},
    {"bvh/hit.cl", IN_PACKET},
    {"bvh/box_ray.cl", IN_PACKET},
    {"bvh/traverse_single.cl", IN_SINGLE},
    {"bvh/traverse_packet.cl", IN_PACKET},
    {"sampling/rng.cl", IN_ALL},
    {"sampling/sampler.cl", IN_ALL},
    {"sampling/warps.cl", IN_ALL},
    {"light/sky.cl", IN_ALL},
    {"camera/camera.cl", IN_ALL},
    {"bsdf/bsdf.cl", IN_ALL},
    {"bsdf/lambertian.cl", IN_ALL},
    {"bsdf/metal.cl", IN_ALL},
    {"bsdf/fresnel.cl", IN_ALL},
    {"bsdf/dielectric.cl", IN_ALL},
    {"bsdf/interface.cl", IN_ALL},
    {"bsdf/oren_nayar.cl", IN_ALL},
    {"bsdf/rough_metal.cl", IN_ALL},
    {"bsdf/glossy.cl", IN_ALL},
    {"bsdf/rough_dielectric.cl", IN_ALL},
    {"medium/phase.cl", IN_ALL},
    {"bsdf/scatter.cl", IN_ALL},
    {"bsdf/fold.cl", IN_ALL},
    {"integrator/scene.cl", IN_ALL},
    {"texture/sphere_map.cl", IN_ALL},
    {"texture/triangle_map.cl", IN_ALL},
    {"texture/image.cl", IN_ALL},
    {"light/environment.cl", IN_ALL},
    {"light/lamps.cl", IN_ALL},
    {"light/triangle_lamps.cl", IN_ALL},
    {"light/discs.cl", IN_ALL},
    {"light/focusers.cl", IN_ALL},
    {"light/focuser_pairs.cl", IN_ALL},
    {"integrator/path_state.cl", IN_ALL},
    {"integrator/path_effects.cl", IN_ALL},
    {"integrator/path.cl", IN_ALL},
    {"integrator/fetch_surface.cl", IN_ALL},
    {"texture/lattice.cl", IN_ALL},
    {"texture/checker.cl", IN_ALL},
    {"texture/noise.cl", IN_ALL},
    {"texture/patterns.cl", IN_ALL},
    {"integrator/smooth_surface.cl", IN_ALL},
    {"integrator/vary_surface.cl", IN_ALL},
    {"integrator/vertex.cl", IN_ALL},
    {"integrator/opacity.cl", IN_ALL},
    {"medium/exponential.cl", IN_ALL},
    {"medium/flight.cl", IN_ALL},
    {"integrator/pixels.cl", IN_ALL},
    {"integrator/lamps_direct.cl", IN_ALL},
    {"integrator/chain_trace.cl", IN_ALL},
    {"integrator/caustic_pairs.cl", IN_ALL},
    {"integrator/caustics.cl", IN_ALL},
    {"integrator/discs_direct.cl", IN_ALL},
    {"integrator/shadow_catcher.cl", IN_ALL},
    {"integrator/segment.cl", IN_ALL},
    {"integrator/background_seen.cl", IN_ALL},
    {"integrator/surface_seen.cl", IN_ALL},
    {"integrator/bounce.cl", IN_ALL},
    {"integrator/roulette.cl", IN_ALL},
    {"integrator/one_path.cl", IN_SINGLE},
    {"entry/trace_sample.cl", IN_SAMPLE},
    {"entry/trace_pool.cl", IN_POOL},
    {"entry/trace_packet.cl", IN_PACKET},
    {"film/accumulate.cl", IN_ALL},
};

#define KERNEL_FILE_BYTES_MAX (1u << 20) /* BALLPARK_KERNELS can name a folder of anything */

static BpStatus no_memory(BpError *err) {
    return bp_fail(err, BP_ERR_MEMORY, "no memory for the kernel's source");
}

static BpStatus read_file(const char *path, char **text, BpError *err) {
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return bp_fail(err, BP_ERR_FILE,
                       "cannot open %s: %s; the environment variable BALLPARK_KERNELS must name a folder "
                       "with all kernel files: correct it, or unset it to use the built-in ones",
                       path, strerror(errno));
    char *read = malloc(KERNEL_FILE_BYTES_MAX + 2);
    const size_t length = read != NULL ? fread(read, 1, KERNEL_FILE_BYTES_MAX + 1, file) : 0;
    const int problem = ferror(file) ? errno : 0;
    fclose(file);
    if (read == NULL) return no_memory(err);
    read[length] = '\0';
    if (problem == 0 && length <= KERNEL_FILE_BYTES_MAX && strlen(read) == length) {
        *text = read;
        return BP_OK;
    }
    free(read);
    if (problem == 0 && length > KERNEL_FILE_BYTES_MAX)
        return bp_fail(err, BP_ERR_FILE, "%s is not a kernel file: it has more than %u bytes", path,
                       KERNEL_FILE_BYTES_MAX);
    return bp_fail(err, BP_ERR_FILE, "cannot read %s: %s; it must be a kernel file", path,
                   problem != 0 ? strerror(problem) : "it contains a byte of value 0");
}

BpStatus bp_kernel_text(const char *name, char **text, BpError *err) {
    const char *directory = getenv("BALLPARK_KERNELS");
    const char *embedded = bp_kernel_file(name);
    *text = NULL;
    if (directory != NULL && directory[0] != '\0') {
        const size_t size = strlen(directory) + strlen(name) + 2;
        char *path = malloc(size);
        if (path == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a path of %zu bytes", size);
        snprintf(path, size, "%s/%s", directory, name);
        const BpStatus status = read_file(path, text, err);
        free(path);
        return status;
    }
    if (embedded == NULL) return bp_fail(err, BP_ERR_FILE, "kernels/%s is not in this program", name);
    *text = strdup(embedded);
    return *text != NULL ? BP_OK : no_memory(err);
}

BpStatus bp_kernel_print(const char *name, FILE *out, BpError *err) {
    char *text = NULL;
    BP_TRY(bp_kernel_text(name, &text, err));
    fprintf(out, "#line 1 \"%s\"\n%s", name, text);
    free(text);
    return BP_OK;
}

BpStatus bp_kernel_close(FILE *out, BpStatus status, char **text, BpError *err) {
    const bool whole = ferror(out) == 0, closed = fclose(out) == 0;
    if (status == BP_OK && !(whole && closed)) status = no_memory(err);
    if (status == BP_OK) return BP_OK;
    free(*text);
    *text = NULL;
    return status;
}

BpStatus bp_kernel_texts(const char *const *names, size_t count, char **text, BpError *err) {
    size_t size = 0;
    char *first = NULL;
    *text = NULL;
    BP_TRY(bp_kernel_text(names[0], &first, err));
    FILE *out = open_memstream(text, &size);
    if (out != NULL) fputs(first, out);
    free(first);
    if (out == NULL) return no_memory(err);
    BpStatus status = BP_OK;
    for (size_t i = 1; i < count && status == BP_OK; ++i) status = bp_kernel_print(names[i], out, err);
    return bp_kernel_close(out, status, text, err);
}

BpStatus bp_program_source(const BpProgramOptions *options, const char *extra_name, const char *extra_text,
                           char **source, BpError *err) {
    size_t size = 0;
    BpStatus status = BP_OK;
    FILE *out = open_memstream(source, &size);
    if (out == NULL) return no_memory(err);
    const bool plain = options->numerics == BP_NUMERICS_PLAIN;
    const bool all_double = options->precision == BP_PRECISION_DOUBLE;
    fprintf(out, "#define REAL_IS_DOUBLE %d\n", all_double);
    fprintf(out, "#define REFINE_IS_DOUBLE %d\n", all_double || (options->double_refine && !plain));
    fprintf(out, "#define OWN_ROUNDING %d\n", options->own_rounding && !all_double);
    fprintf(out, "#define TREE_WIDTH %u\n", options->tree_width);
    if (options->form == BP_KERNEL_PACKET) {
        fprintf(out, "#define PACKET_LANES %u\n", options->packet_lanes);
        fprintf(out, "#define SAMPLES_PER_ITEM %uu\n", BP_PACKET_SAMPLES_PER_ITEM);
    } else if (options->form == BP_KERNEL_SAMPLE) {
        fprintf(out, "#define GROUP_MAX %uu\n", BP_SAMPLE_GROUP_MAX);
    }
    fprintf(out, "#define SAMPLER_SOBOL %d\n", options->sampler == BP_SAMPLER_SOBOL);
    fprintf(out, "#define PIXEL_LIST %d\n", options->pixel_list);
    fprintf(out, "#define PILOT %d\n", options->pilot);
    for (int e = 0; e < BP_EFFECT_COUNT; ++e)
        fprintf(out, "#define EFFECT_%s %d\n", bp_effect_identifier((BpEffect)e),
                bp_effects_has(options->effects, (BpEffect)e));
    fprintf(out, "#define ACCELERATION_TREE %d\n", options->tree);
    fprintf(out, "#define FOCUSER_PAIRS %d\n", options->focuser_pairs);
    fprintf(out, "#define TRIANGLES_ALONE %d\n", options->triangles_alone);
    if (options->parts > 1)
        fprintf(out, "#define SCENE_PARTS %u\n#define PART_LENGTH %uu\n", options->parts,
                options->part_length);
    const unsigned form = options->form == BP_KERNEL_PACKET ? IN_PACKET
                          : options->form == BP_KERNEL_POOL ? IN_SINGLE | IN_POOL
                                                            : IN_SINGLE | IN_SAMPLE;
    const unsigned kind = form | (plain ? IN_PLAIN : IN_ROBUST);
    for (size_t i = 0; i < sizeof files / sizeof files[0] && status == BP_OK; ++i)
        if ((files[i].only_in & ~kind) == 0) status = bp_kernel_print(files[i].name, out, err);
    if (extra_text != NULL)
        fprintf(out, "#line 1 \"%s\"\n%s", extra_name != NULL ? extra_name : "extra.cl", extra_text);
    return bp_kernel_close(out, status, source, err);
}

/* A program that this device has built before. False: there is none. */
static bool find_built(const BpDevice *device, BpProgram *program) {
    for (size_t i = 0; i < device->built_count; ++i) {
        const BpBuilt *built = &device->built[i];
        if (built->key != program->key) continue;
        program->log = strdup(built->log);
        if (program->log == NULL || clRetainProgram(built->program) != CL_SUCCESS) return false;
        program->program = built->program;
        return true;
    }
    return false;
}

/* Without memory it is built again the next time. */
static void keep_built(BpDevice *device, const BpProgram *program) {
    BpBuilt *grown = realloc(device->built, (device->built_count + 1) * sizeof *grown);
    if (grown == NULL) return;
    device->built = grown;
    BpBuilt *slot = &grown[device->built_count];
    slot->key = program->key;
    slot->program = program->program;
    slot->log = strdup(program->log != NULL ? program->log : "");
    if (slot->log == NULL) return;
    if (clRetainProgram(slot->program) == CL_SUCCESS)
        ++device->built_count;
    else
        free(slot->log);
}

BpStatus bp_program_build(BpDevice *device, const BpProgramOptions *options, const char *extra_name,
                          const char *extra_text, BpProgram **program, BpError *err) {
    char *source = NULL;
    BpProgram *built = calloc(1, sizeof *built);
    if (built == NULL) return bp_fail(err, BP_ERR_MEMORY, "no memory for a program");
    const bool fast = options->math == BP_MATH_FAST;
    const char *flags = fast ? "-cl-fast-relaxed-math" : "";
    BpProgramOptions chosen = *options;
    chosen.own_rounding = !fast && (options->own_rounding || !bp_device_rounds_quotients(device->id));
    BpStatus status = bp_program_source(&chosen, extra_name, extra_text, &source, err);
    if (status != BP_OK) goto failed;
    built->key = bp_hash_text(bp_hash_text(BP_HASH_START, source), flags);
    if (!find_built(device, built)) {
        free(built->log);
        built->log = NULL;
        const double start = bp_clock_seconds();
        status = bp_device_build(device, source, flags, &built->program, &built->log, err);
        built->build_seconds = bp_clock_seconds() - start;
        if (status != BP_OK) goto failed;
        keep_built(device, built);
    }
    free(source);
    *program = built;
    return BP_OK;

failed:
    free(source);
    bp_program_destroy(&built);
    return status;
}

void bp_program_destroy(BpProgram **program) {
    if (program == NULL || *program == NULL) return;
    if ((*program)->program != NULL && !bp_drivers_left_behind()) clReleaseProgram((*program)->program);
    free((*program)->log);
    free(*program);
    *program = NULL;
}
