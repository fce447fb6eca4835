/* launch.h: whether this process is one of several that a launcher started together.
 *
 * In:    the environment.   Out: the number of processes, the rank of this one, the launcher.
 * Knows: the variables of mpirun, mpiexec and srun.   Does not know: MPI. */
#ifndef BP_CLUSTER_LAUNCH_H
#define BP_CLUSTER_LAUNCH_H

#include <stdint.h>

typedef struct BpLaunch {
    uint32_t size;        /* processes; 1: this one alone */
    uint32_t rank;        /* of this one, from 0 */
    const char *launcher; /* "mpirun"; static */
} BpLaunch;

BpLaunch bp_launch_find(void);

#endif
