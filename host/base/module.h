/* module.h: a part of the program that is loaded only when it is needed, because it depends on a library that
 * not every machine has.
 *
 * In:    its file's name, the environment.   Out: the struct of functions that it exports.
 * Knows: where modules are installed, that their versions must match.   Does not know: what any of them does.
 */
#ifndef BP_BASE_MODULE_H
#define BP_BASE_MODULE_H

#include "status.h"

/* The module that bp_module_load() is to load. */
typedef struct BpModuleName {
    const char *file;     /* "ballpark_mpi.so" */
    const char *variable; /* of the environment, which may name another file */
    const char *symbol;   /* the struct, which begins with its version as a uint32_t */
    uint32_t version;
    bool is_global; /* its symbols are for libraries that it loads itself */
} BpModuleName;

/* Looks beside the program (as built), then in the program's library folder (as installed), unless the
 * environment variable names a file. The module stays loaded until the program ends, since libraries leave
 * threads and handlers behind. BP_ERR_USAGE: the message begins with the file's name and describes the fault.
 */
BpStatus bp_module_load(const BpModuleName *name, const void **interface, BpError *err);

#endif
