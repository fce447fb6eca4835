/* ranks.h: what each of several ranks takes for itself: a device, threads, whole pictures.
 *
 * In:    the communicator, the command line, devices.   Out: those of this rank.
 * Knows: ranks of one machine share its devices.   Does not know: how pictures are shared (render/round.h).
 */
#ifndef BP_CLI_JOB_RANKS_H
#define BP_CLI_JOB_RANKS_H

#include "cli/line/options.h"
#include "cluster/comm.h"

/* Without --device, replaces the default device by the one for this rank: the ranks of
 * a machine go through its devices of that kind in turn. Does nothing when alone. */
BpStatus bp_ranks_choose_device(const BpCommandLine *line, BpDeviceInfo *device, BpError *err);

/* Threads of a processor that this rank may use, unless --threads says otherwise; 0: all. */
uint32_t bp_ranks_threads(const BpCommandLine *line, const BpDeviceInfo *device);

/* Of `pictures`, the first so many go to one rank each, in turn, and the others to all ranks together. So no
 * rank is idle for long; 0 when alone, and where there are fewer pictures than ranks. */
size_t bp_ranks_dealt(const BpComm *comm, size_t pictures);
bool bp_ranks_is_mine(const BpComm *comm, size_t picture);

#endif
