/* launch.c: see launch.h. */
#include "launch.h"

#include <stddef.h>
#include <stdlib.h>

/* 0 where there is none. */
static uint32_t number_in(const char *variable) {
    const char *value = getenv(variable);
    const unsigned long number = value != NULL ? strtoul(value, NULL, 10) : 0;
    return number < UINT32_MAX ? (uint32_t)number : UINT32_MAX;
}

BpLaunch bp_launch_find(void) {
    /* The first that is set counts: mpirun inside a Slurm job starts its processes through srun. */
    static const struct {
        const char *size, *rank, *launcher;
    } known[] = {
        {"OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "mpirun"}, /* Open MPI */
        {"MV2_COMM_WORLD_SIZE", "MV2_COMM_WORLD_RANK", "mpiexec"},  /* MVAPICH */
        {"PMI_SIZE", "PMI_RANK", "mpiexec"},                        /* MPICH, Intel MPI, srun --mpi=pmi2 */
        {"SLURM_STEP_NUM_TASKS", "SLURM_PROCID", "srun"}, /* a batch script itself lacks the first */
    };
    for (size_t k = 0; k < sizeof known / sizeof known[0]; ++k) {
        const uint32_t size = number_in(known[k].size);
        if (size > 0) return (BpLaunch){size, number_in(known[k].rank), known[k].launcher};
    }
    return (BpLaunch){1, 0, ""};
}
