/* names.c: see names.h. */
#include "names.h"

#include <stddef.h>

const char *const bp_precision_names[] = {
    [BP_PRECISION_SINGLE] = "single", [BP_PRECISION_DOUBLE] = "double", NULL};
const char *const bp_math_names[] = {[BP_MATH_STRICT] = "strict", [BP_MATH_FAST] = "fast", NULL};
const char *const bp_lamps_names[] = {
    [BP_LAMPS_ON] = "on",
    [BP_LAMPS_OFF] = "off",
    NULL,
};

const char *const bp_numerics_names[] = {
    [BP_NUMERICS_ROBUST] = "robust", [BP_NUMERICS_PLAIN] = "plain", NULL};
const char *const bp_sampler_names[] = {
    [BP_SAMPLER_INDEPENDENT] = "independent", [BP_SAMPLER_SOBOL] = "sobol", NULL};
const char *const bp_kernel_names[] = {[BP_KERNEL_AUTO] = "auto",
                                       [BP_KERNEL_SAMPLE] = "sample",
                                       [BP_KERNEL_PACKET] = "packet",
                                       [BP_KERNEL_POOL] = "pool",
                                       NULL};
const char *const bp_transfer_names[] = {
    [BP_TRANSFER_GAMMA2] = "gamma2", [BP_TRANSFER_SRGB] = "srgb", [BP_TRANSFER_LINEAR] = "linear", NULL};
const char *const bp_format_names[] = {[BP_FORMAT_PNG] = "png",
                                       [BP_FORMAT_PPM] = "ppm",
                                       [BP_FORMAT_PPM_ASCII] = "ppm-ascii",
                                       [BP_FORMAT_PFM] = "pfm",
                                       [BP_FORMAT_EXR] = "exr",
                                       [BP_FORMAT_BPA] = "bpa",
                                       NULL};
const char *const bp_device_type_names[] = {
    [BP_DEVICE_CPU] = "cpu", [BP_DEVICE_GPU] = "gpu", [BP_DEVICE_OTHER] = "other", NULL};
