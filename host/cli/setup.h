/* setup.h: from a command line to what the library wants: the scene, the options, the devices.
 *
 * Knows: the command line, the public interface.   Does not know: what a command does with them. */
#ifndef BP_CLI_SETUP_H
#define BP_CLI_SETUP_H

#include "options.h"

/* Loads `path`; "-" is standard input, which ends up as the scene's name in messages; clouds are then sought
 * from the current folder. */
BpStatus bp_setup_load(const BpCommandLine *line, const char *path, BpScene **scene, BpError *err);

/* The same, and applies --width. */
BpStatus bp_setup_scene(const BpCommandLine *line, const char *path, BpScene **scene, BpError *err);

/* The scene's own settings, overridden by the options that were given: --spp --depth --seed --first-sample
 * --precision --math --numerics --sampler --effects --kernel. BP_ERR_USAGE when they do not go together. */
BpStatus bp_setup_options(const BpCommandLine *line, const BpScene *scene, BpRenderOptions *options,
                          BpError *err);

/* Warns on standard error, unless --quiet, of what rounding the scene to `precision` does to it. */
void bp_setup_warn(const BpCommandLine *line, const BpScene *scene, BpPrecision precision);

/* The devices that --device means: one, or with "all" every device that can render. Free *devices with
 * free(). Never empty on success. */
BpStatus bp_setup_devices(const BpCommandLine *line, BpDeviceInfo **devices, size_t *count, BpError *err);

/* Where PATH has no linker, which PoCL may need and then miss by ending the process: lets the device that
 * `name` means (as for bp_device_find) try a kernel in a process of its own. Call it before anything touches
 * OpenCL. */
BpStatus bp_setup_try_device(const char *name, BpError *err);

/* Asks every device for known answers (once per device, driver and version; a pass is remembered). One that
 * gives wrong answers is refused; with --force this is said, and no more. */
BpStatus bp_setup_self_test(const BpCommandLine *line, const BpDeviceInfo *devices, size_t count,
                            BpError *err);

#endif
