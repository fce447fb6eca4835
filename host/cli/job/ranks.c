/* ranks.c: see ranks.h. */
#include "ranks.h"

#include <stdlib.h>
#include <string.h>

BpStatus bp_ranks_choose_device(const BpCommandLine *line, BpDeviceInfo *device, BpError *err) {
    BpDeviceInfo *list = NULL;
    size_t count = 0, alike = 0;
    if (line->comm == NULL || bp_option_given(line, BP_OPTION_DEVICE)) return BP_OK;
    BP_TRY(bp_devices_list(&list, &count, err));
    /* A device that two drivers offer is still one. */
    for (size_t d = 0; d < count; ++d)
        if (list[d].refusal[0] == '\0' && list[d].type == device->type &&
            strcmp(list[d].platform, device->platform) == 0)
            list[alike++] = list[d];
    if (alike > 1) *device = list[bp_comm_local_rank(line->comm) % alike];
    bp_free(list);
    return BP_OK;
}

uint32_t bp_ranks_threads(const BpCommandLine *line, const BpDeviceInfo *device) {
    if (line->comm == NULL || bp_option_given(line, BP_OPTION_THREADS)) return line->threads;
    const uint32_t cores = bp_comm_cores(line->comm);
    return device->type == BP_DEVICE_CPU && cores < device->compute_units ? cores : 0;
}

size_t bp_ranks_dealt(const BpComm *comm, size_t pictures) {
    const size_t ranks = bp_comm_size(comm);
    return ranks > 1 ? pictures / ranks * ranks : 0;
}

bool bp_ranks_is_mine(const BpComm *comm, size_t picture) {
    return picture % bp_comm_size(comm) == bp_comm_rank(comm);
}
