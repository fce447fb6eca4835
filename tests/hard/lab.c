/* lab.c: see lab.h. */
#include "lab.h"

#include "packed/effects.h"
#include "render/render.h"
#include "render/render_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOCAL_SIZE 64

static void check(BpStatus status, const BpError *err) {
    if (status == BP_OK) return;
    fprintf(stderr, "%s: %s\n%s\n", bp_status_name(status), err->message,
            err->attachment != NULL ? err->attachment : "");
    exit(1);
}

static void check_cl(cl_int code, const char *call) {
    if (code == CL_SUCCESS) return;
    fprintf(stderr, "%s: %s\n", call, bp_cl_error_name(code));
    exit(1);
}

static void *allocate(size_t count, size_t size) {
    void *memory = calloc(count > 0 ? count : 1, size);
    if (memory == NULL) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return memory;
}

/* The text of probe.cl; the caller frees it. */
static char *probe_text(void) {
    FILE *file = fopen(SOURCE_DIR "/tests/hard/probe.cl", "rb");
    char *text = allocate(1u << 16, 1);
    if (file == NULL || fread(text, 1, (1u << 16) - 1, file) == 0) {
        fprintf(stderr, "cannot read tests/hard/probe.cl\n");
        exit(1);
    }
    fclose(file);
    return text;
}

bool lab_open(Lab *lab, const char *variant) {
    BpError err = {0};
    memset(lab, 0, sizeof *lab);
    lab->name = variant;
    if (bp_device_find(getenv("BALLPARK_TEST_DEVICE"), &lab->info, &err) != BP_OK) {
        fprintf(stderr, "skipped: %s\n", err.message);
        bp_error_clear(&err);
        return false;
    }
    lab->real_double = strcmp(variant, "all-double") == 0;
    lab->refined_double = lab->real_double || strcmp(variant, "double") == 0;
    if (lab->refined_double && !lab->info.has_double) {
        fprintf(stderr, "skipped: %s has no double precision\n", lab->info.name);
        return false;
    }
    lab->options = (BpProgramOptions){
        /* probes make rays and leaves of their own */
        .effects = BP_EFFECTS_ALL & ~(1u << BP_EFFECT_MOTION | 1u << BP_EFFECT_CAPSULES),

        .tree = true,
        .precision = lab->real_double ? BP_PRECISION_DOUBLE : BP_PRECISION_SINGLE,
        .math = strcmp(variant, "fast") == 0 ? BP_MATH_FAST : BP_MATH_STRICT,
        .numerics = strcmp(variant, "plain") == 0 ? BP_NUMERICS_PLAIN : BP_NUMERICS_ROBUST,
        .sampler = BP_SAMPLER_INDEPENDENT,
        .form = BP_KERNEL_SAMPLE,
        .tree_width = lab->refined_double ? 8 : 4,
        .double_refine = lab->refined_double,
    };
    check(bp_device_open(&lab->info, &lab->device, &err), &err);
    char *text = probe_text();
    check(bp_program_build(lab->device, &lab->options, "probe.cl", text, &lab->program, &err), &err);
    free(text);
    return true;
}

void lab_close(Lab *lab) {
    bp_program_destroy(&lab->program);
    bp_device_close(&lab->device);
}

static bool is_out(LabKind kind) {
    return kind == LAB_OUT_REALS || kind == LAB_OUT_REFINED || kind == LAB_OUT_WORDS;
}

/* Bytes of one number of a buffer on the device. */
static size_t number_size(const Lab *lab, LabKind kind) {
    switch (kind) {
    case LAB_REALS:
    case LAB_OUT_REALS:
        return lab->real_double ? sizeof(double) : sizeof(float);
    case LAB_REFINED:
    case LAB_OUT_REFINED:
        return lab->refined_double ? sizeof(double) : sizeof(float);
    case LAB_WORDS:
    case LAB_OUT_WORDS:
    case LAB_NUMBER:
        return sizeof(uint32_t);
    default:
        return 1;
    }
}

static bool is_real(LabKind kind) {
    return kind <= LAB_REFINED || kind == LAB_OUT_REALS || kind == LAB_OUT_REFINED;
}

static cl_mem make_buffer(cl_context context, const Lab *lab, const LabArgument *argument) {
    const size_t size = number_size(lab, argument->kind), bytes = argument->count * size;
    const void *data = argument->data;
    float *narrow = NULL;
    cl_int code;
    if (!is_out(argument->kind) && is_real(argument->kind) && size == sizeof(float)) {
        narrow = allocate(argument->count, sizeof *narrow);
        for (size_t i = 0; i < argument->count; ++i) narrow[i] = (float)((const double *)data)[i];
        data = narrow;
    }
    const cl_mem_flags flags =
        is_out(argument->kind) ? CL_MEM_READ_WRITE : CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR;
    cl_mem buffer = clCreateBuffer(context, flags, bytes > 0 ? bytes : 4,
                                   is_out(argument->kind) ? NULL : (void *)(size_t)data, &code);
    check_cl(code, "clCreateBuffer");
    free(narrow);
    return buffer;
}

static void read_buffer(cl_command_queue queue, const Lab *lab, const LabArgument *argument, cl_mem buffer) {
    const size_t size = number_size(lab, argument->kind), bytes = argument->count * size;
    if (is_real(argument->kind) && size == sizeof(float)) {
        float *narrow = allocate(argument->count, sizeof *narrow);
        check_cl(clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, bytes, narrow, 0, NULL, NULL),
                 "clEnqueueReadBuffer");
        for (size_t i = 0; i < argument->count; ++i) ((double *)argument->data)[i] = (double)narrow[i];
        free(narrow);
        return;
    }
    check_cl(clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, bytes, argument->data, 0, NULL, NULL),
             "clEnqueueReadBuffer");
}

void lab_run(const Lab *lab, const char *kernel, size_t items, const LabArgument *arguments,
             size_t argument_count, BpWorker *scene) {
    BpError err = {0};
    BpDevice *device = scene != NULL ? scene->device : lab->device;
    cl_int code;
    cl_mem buffers[16] = {0};
    cl_uint index = 0;
    cl_kernel made =
        clCreateKernel(scene != NULL ? scene->program->program : lab->program->program, kernel, &code);
    check_cl(code, kernel);
    if (scene != NULL) {
        check(bp_worker_bind_scene(scene, made, &err), &err);
        index = scene->scene_arguments;
    }
    const cl_uint count = (cl_uint)items;
    check_cl(clSetKernelArg(made, index++, sizeof count, &count), "clSetKernelArg");
    for (size_t i = 0; i < argument_count; ++i) {
        if (arguments[i].kind == LAB_NUMBER) {
            const cl_uint number = (cl_uint)arguments[i].count;
            check_cl(clSetKernelArg(made, index++, sizeof number, &number), "clSetKernelArg");
            continue;
        }
        buffers[i] = make_buffer(device->context, lab, &arguments[i]);
        check_cl(clSetKernelArg(made, index++, sizeof(cl_mem), &buffers[i]), "clSetKernelArg");
    }
    const size_t local = LOCAL_SIZE, global = (items + local - 1) / local * local;
    check_cl(clEnqueueNDRangeKernel(device->queue, made, 1, NULL, &global, &local, 0, NULL, NULL), kernel);
    check_cl(clFinish(device->queue), kernel);
    for (size_t i = 0; i < argument_count; ++i) {
        if (buffers[i] == NULL) continue;
        if (is_out(arguments[i].kind)) read_buffer(device->queue, lab, &arguments[i], buffers[i]);
        clReleaseMemObject(buffers[i]);
    }
    clReleaseKernel(made);
}

/* How the lab's variant renders a scene: with the choices and the tree that its probes have. */
static void set_options(const Lab *lab, const BpScene *scene, BpRenderOptions *options) {
    bp_render_defaults(scene, options);
    options->precision = lab->options.precision;
    options->numerics = lab->options.numerics;
    options->math = lab->options.math;
    options->kernel = BP_KERNEL_SAMPLE;
    options->all_effects = true;
    options->force_tree = true;
    options->tree_width = lab->options.tree_width;
    options->force_float_refine = !lab->refined_double;
}

BpWorker *lab_scene(const Lab *lab, const BpScene *scene) {
    BpError err = {0};
    BpRenderOptions options;
    BpWorkerSetup setup;
    BpPacked packed;
    BpWorker *worker = NULL;
    set_options(lab, scene, &options);
    check(bp_render_plan(scene, &options, &lab->info, &setup, &packed, &err), &err);
    setup.program = lab->options; /* the program that is built already */
    if (scene->capsule_count > 0) setup.program.effects |= 1u << BP_EFFECT_CAPSULES;
    char *text = probe_text();
    setup.extra_name = "probe.cl";
    setup.extra_text = text;
    setup.untested = true;
    setup.device = lab->device;
    check(bp_worker_create(&lab->info, &packed, &setup, &worker, &err), &err);
    free(text);
    return worker;
}

void lab_render(const Lab *lab, const BpScene *scene, uint64_t samples, uint64_t seed, BpPicture *picture,
                uint64_t *invalid) {
    BpError err = {0};
    BpRenderOptions options;
    BpRender *render = NULL;
    BpProgress progress;
    BpRenderReport report;
    set_options(lab, scene, &options);
    options.samples_per_pixel = samples;
    options.seed = seed;
    options.force = true;
    check(bp_render_create_on(scene, &options, &lab->device, 1, &render, &err), &err);
    do check(bp_render_step(render, &progress, &err), &err);
    while (!progress.finished);
    check(bp_render_read(render, picture, &err), &err);
    bp_render_report(render, &report);
    if (invalid != NULL) *invalid = report.invalid_samples;
    bp_render_destroy(&render);
}

void lab_float_unit(double v[3]) {
    const double length = sqrt(lab_dot(v, v));
    for (int a = 0; a < 3; ++a) v[a] = lab_float(v[a] / length);
}

void lab_unit_rays(const Lab *lab, size_t count, double *rays) {
    if (!lab->real_double) return;
    for (size_t i = 0; i < count; ++i) {
        double *v = rays + i * RAY_REALS + RAY_DIRECTION;
        const double length = sqrt(lab_dot(v, v));
        for (int a = 0; a < 3; ++a) v[a] /= length;
    }
}
