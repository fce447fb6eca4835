/* names.c: see names.h. */
#include "names.h"

#include "words.h"

#include <stddef.h>

#define PRECISION_WORDS(X) X(BP_PRECISION_SINGLE, "single") X(BP_PRECISION_DOUBLE, "double")
BP_WORDS_ENDED(BpPrecision, const char *const bp_precision_names, PRECISION_WORDS);

#define MATH_WORDS(X) X(BP_MATH_STRICT, "strict") X(BP_MATH_FAST, "fast")
BP_WORDS_ENDED(BpMath, const char *const bp_math_names, MATH_WORDS);

#define LIGHT_SAMPLING_WORDS(X) X(BP_LIGHT_SAMPLING_ON, "on") X(BP_LIGHT_SAMPLING_OFF, "off")
BP_WORDS_ENDED(BpLightSampling, const char *const bp_light_sampling_names, LIGHT_SAMPLING_WORDS);

#define CAUSTICS_WORDS(X) X(BP_CAUSTICS_AUTO, "auto") X(BP_CAUSTICS_OFF, "off") X(BP_CAUSTICS_ON, "on")
BP_WORDS_ENDED(BpCaustics, const char *const bp_caustics_names, CAUSTICS_WORDS);

#define ROULETTE_WORDS(X) X(BP_ROULETTE_ON, "on") X(BP_ROULETTE_OFF, "off")
BP_WORDS_ENDED(BpRoulette, const char *const bp_roulette_names, ROULETTE_WORDS);

#define NUMERICS_WORDS(X) X(BP_NUMERICS_ROBUST, "robust") X(BP_NUMERICS_PLAIN, "plain")
BP_WORDS_ENDED(BpNumerics, const char *const bp_numerics_names, NUMERICS_WORDS);

#define SAMPLER_WORDS(X) X(BP_SAMPLER_INDEPENDENT, "independent") X(BP_SAMPLER_SOBOL, "sobol")
BP_WORDS_ENDED(BpSampler, const char *const bp_sampler_names, SAMPLER_WORDS);

#define KERNEL_WORDS(X)                                                                                      \
    X(BP_KERNEL_AUTO, "auto")                                                                                \
    X(BP_KERNEL_SAMPLE, "sample") X(BP_KERNEL_PACKET, "packet") X(BP_KERNEL_POOL, "pool")
BP_WORDS_ENDED(BpKernelForm, const char *const bp_kernel_names, KERNEL_WORDS);

#define TRANSFER_WORDS(X)                                                                                    \
    X(BP_TRANSFER_GAMMA2, "gamma2") X(BP_TRANSFER_SRGB, "srgb") X(BP_TRANSFER_LINEAR, "linear")
BP_WORDS_ENDED(BpTransfer, const char *const bp_transfer_names, TRANSFER_WORDS);

#define FORMAT_WORDS(X)                                                                                      \
    X(BP_FORMAT_PNG, "png")                                                                                  \
    X(BP_FORMAT_PPM, "ppm")                                                                                  \
    X(BP_FORMAT_PPM_ASCII, "ppm-ascii")                                                                      \
    X(BP_FORMAT_PFM, "pfm")                                                                                  \
    X(BP_FORMAT_EXR, "exr") X(BP_FORMAT_BPA, "bpa") X(BP_FORMAT_PDF, "pdf") X(BP_FORMAT_SVG, "svg")
BP_WORDS_ENDED(BpFormat, const char *const bp_format_names, FORMAT_WORDS);

#define DEVICE_TYPE_WORDS(X) X(BP_DEVICE_CPU, "cpu") X(BP_DEVICE_GPU, "gpu") X(BP_DEVICE_OTHER, "other")
BP_WORDS_ENDED(BpDeviceType, const char *const bp_device_type_names, DEVICE_TYPE_WORDS);
