/* names.h: the words for the values of the public enumerations, on the command line and in documents.
 *
 * Knows: the enumerations of ballpark.h.   Does not know: who reads or writes the words. */
#ifndef BP_BASE_NAMES_H
#define BP_BASE_NAMES_H

#include "ballpark.h"

/* Each by the enumeration's value; NULL ends the list. */
extern const char *const bp_precision_names[],
    *const bp_math_names[], *const bp_numerics_names[], *const bp_sampler_names[],
                                                            *const bp_kernel_names[],
                                                                *const bp_transfer_names[],
                                                                    *const bp_format_names[],
                                                                        *const bp_device_type_names[];

#endif
