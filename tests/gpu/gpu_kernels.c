/* gpu_kernels.c: writes the kernels that a GPU is given for a scene, for compilers that need no GPU.
 *
 * Usage: gpu_kernels SCENE FOLDER
 *
 * In:    a scene.   Out: FORM.cl for the forms `sample` and `pool`, and FORM-rounding.cl for GPUs whose
 * quotients are not rounded correctly; each is one program with the trace kernel of that form.
 * Knows: render_plan.h, which makes a render's choices for a GPU without double.   Does not know: any device.
 */
#include "ballpark.h"
#include "opencl/program.h"
#include "render/render_plan.h"

#include <stdio.h>
#include <stdlib.h>

static BpStatus write_kernel(const BpScene *scene, BpKernelForm form, bool own_rounding, const char *path,
                             BpError *err) {
    const BpDeviceInfo gpu = {.type = BP_DEVICE_GPU, .float_lanes = 1};
    BpRenderOptions options;
    BpWorkerSetup setup;
    BpPacked packed;
    char *source = NULL;
    bp_render_defaults(scene, &options);
    options.kernel = form;
    BP_TRY(bp_render_plan(scene, &options, &gpu, &setup, &packed, err));
    bp_packed_clear(&packed);
    setup.program.own_rounding = own_rounding;
    BP_TRY(bp_program_source(&setup.program, NULL, NULL, &source, err));
    FILE *file = fopen(path, "w");
    const bool written = file != NULL && fputs(source, file) >= 0;
    if ((file != NULL && fclose(file) != 0) || !written) bp_fail(err, BP_ERR_FILE, "cannot write '%s'", path);
    free(source);
    return written ? BP_OK : BP_ERR_FILE;
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        BpKernelForm form;
        bool own_rounding;
    } kernels[] = {{"sample", BP_KERNEL_SAMPLE, false},
                   {"pool", BP_KERNEL_POOL, false},
                   {"sample-rounding", BP_KERNEL_SAMPLE, true},
                   {"pool-rounding", BP_KERNEL_POOL, true}};
    BpError err = {0};
    BpScene *scene = NULL;
    if (argc != 3) return fprintf(stderr, "usage: gpu_kernels SCENE FOLDER\n"), 2;
    BpStatus status = bp_scene_load(argv[1], &scene, &err);
    for (size_t k = 0; status == BP_OK && k < sizeof kernels / sizeof kernels[0]; ++k) {
        char path[4096];
        snprintf(path, sizeof path, "%s/%s.cl", argv[2], kernels[k].name);
        status = write_kernel(scene, kernels[k].form, kernels[k].own_rounding, path, &err);
    }
    if (status != BP_OK) fprintf(stderr, "gpu_kernels: %s\n", err.message);
    bp_scene_destroy(&scene);
    bp_error_clear(&err);
    return status == BP_OK ? 0 : 1;
}
