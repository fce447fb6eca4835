/* setup.h: turns a command line into the scene, the render options and the devices.
 *
 * In:    the command line.   Out: a scene, BpRenderOptions, devices that passed the self-test; warnings.
 * Knows: the command line, the public interface.   Does not know: what a command does with them. */
#ifndef BP_CLI_JOB_SETUP_H
#define BP_CLI_JOB_SETUP_H

#include "cli/line/options.h"
#include "formats/scene_changes.h"

/* Loads `path`; "-" is standard input, also in messages, and clouds are then relative to the current folder.
 * A file of particles becomes a scene (--frame, --fit); guesses are reported on standard error, unless
 * --quiet. */
BpStatus bp_setup_load(const BpCommandLine *line, const char *path, BpScene **scene, BpError *err);

/* The same, with changes of the caller's own instead of --frame and --fit, and without the notes on standard
 * error. */
BpStatus bp_setup_load_changed(const BpCommandLine *line, const char *path, const BpSceneChanges *changes,
                               BpScene **scene, BpError *err);

/* Reports guesses about the scene on standard error, unless --quiet. */
void bp_setup_notes(const BpCommandLine *line, const BpScene *scene);

/* bp_setup_load(), then applies --width. */
BpStatus bp_setup_scene(const BpCommandLine *line, const char *path, BpScene **scene, BpError *err);

/* The scene's own settings, overridden by those that were given: the list's RENDER_OPTIONs, and --effects.
 * BP_ERR_USAGE if they conflict. */
BpStatus bp_setup_options(const BpCommandLine *line, const BpScene *scene, BpRenderOptions *options,
                          BpError *err);

/* With --share I/N, reduces the samples of the options to that share: whole rounds of a sample for each
 * replicate, so that shares differ by one round at most. Without --share, does nothing. BP_ERR_USAGE: there
 * are more shares than rounds, or the number of samples is not known from the beginning. */
BpStatus bp_setup_share(const BpCommandLine *line, BpRenderOptions *options, BpError *err);

/* Warns on standard error, unless --quiet, about the effects of rounding the scene to `precision`. */
void bp_setup_warn(const BpCommandLine *line, const BpScene *scene, BpPrecision precision);

/* Starts the drivers (cli/process/driver_care.h), which may start the program again, so call it before
 * anything is written. Returns the devices that --device selects: one, or with "all" every device that can
 * render. Free *devices with free(). Never empty on success. */
BpStatus bp_setup_devices(const BpCommandLine *line, BpDeviceInfo **devices, size_t *count, BpError *err);

/* Runs the self-test on every device (once per device, driver and version; a pass is remembered). A device
 * that fails is refused; with --force there is only a warning. */
BpStatus bp_setup_self_test(const BpCommandLine *line, const BpDeviceInfo *devices, size_t count,
                            BpError *err);

#endif
