/* ranks.h: assigns a device, threads and whole pictures to each of several ranks.
 *
 * In:    the communicator, the command line, devices.   Out: those of this rank.
 * Knows: ranks of one machine share its devices.   Does not know: how pictures are shared (render/round.h).
 */
#ifndef BP_CLI_JOB_RANKS_H
#define BP_CLI_JOB_RANKS_H

#include "cli/line/options.h"
#include "cluster/comm.h"

/* Without --device, replaces the default device by the one for this rank: the ranks of a machine take its
 * devices of that kind in turn. Does nothing when alone. */
BpStatus bp_ranks_choose_device(const BpCommandLine *line, BpDeviceInfo *device, BpError *err);

/* Threads of a processor that this rank may use, unless --threads says otherwise; 0: all. */
uint32_t bp_ranks_threads(const BpCommandLine *line, const BpDeviceInfo *device);

/* The number of pictures, from the first on, that are rendered by one rank each, in turn; all ranks share the
 * rest, so that no rank is idle for long. 0 when alone, and if there are fewer pictures than ranks. */
size_t bp_ranks_dealt(const BpComm *comm, size_t pictures);
bool bp_ranks_is_mine(const BpComm *comm, size_t picture);

#endif
