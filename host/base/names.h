/* names.h: the names of the values of the public enumerations, on the command line and in documents; and the
 * list of settings.
 *
 * Knows: the enumerations of ballpark.h.   Does not know: who reads or writes the words. */
#ifndef BP_BASE_NAMES_H
#define BP_BASE_NAMES_H

#include "ballpark.h"

/* The settings by which radiance is computed, besides the scene, its depth and the seed. X(type, member, its
 * option, what two of them are called): BpRenderOptions, BpProgramOptions, BpRenderReport, BpFilm and
 * BpFilmInfo each have these members. From the list follow what a render records in its film and report, what
 * .bpa files contain and a merge compares, and the members of documents. `bp_<member>_names` are its names.
 */
#define BP_SETTING_LIST(X)                                                                                   \
    X(BpSampler, sampler, "sampler", "samplers")                                                             \
    X(BpPrecision, precision, "precision", "precisions")                                                     \
    X(BpMath, math, "math", "kinds of mathematics")                                                          \
    X(BpNumerics, numerics, "numerics", "numerics")                                                          \
    X(BpLightSampling, light_sampling, "light-sampling", "ways to find lights")                              \
    X(BpCaustics, caustics, "caustics", "ways to find caustics")                                             \
    X(BpRoulette, roulette, "roulette", "choices of roulette")

/* Expands the list to members of a struct. */
#define BP_SETTING_MEMBER(type, member, option, plural) type member;

/* The names of an enumeration, indexed by value; NULL ends the list. */
#define BP_SETTING_NAMES(type, member, option, plural) extern const char *const bp_##member##_names[];
BP_SETTING_LIST(BP_SETTING_NAMES)
#undef BP_SETTING_NAMES
extern const char *const bp_kernel_names[];
extern const char *const bp_transfer_names[];
extern const char *const bp_format_names[];
extern const char *const bp_device_type_names[];

#endif
