/* commands.c: see commands.h. */
#include "commands.h"

BpStatus bp_command_run(const BpCommandLine *line, BpError *err) {
    switch (line->command->bit) {
    case BP_RENDER:
        return bp_command_render(line, err);
    case BP_VIEW:
        return bp_command_view(line, err);
    case BP_CHECK:
        return bp_command_check(line, err);
    case BP_EXPLAIN:
        return bp_command_explain(line, err);
    case BP_COST:
        return bp_command_cost(line, err);
    case BP_MERGE:
        return bp_command_merge(line, err);
    case BP_BENCH:
        return bp_command_bench(line, err);
    case BP_DEVICES:
        return bp_command_devices(line, err);
    case BP_GENERATE:
        return bp_command_generate(line, err);
    case BP_SCENE:
        return bp_command_scene(line, err);
    default:
        return bp_command_help(line, err);
    }
}
