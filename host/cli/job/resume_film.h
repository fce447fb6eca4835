/* resume_film.h: implements --resume: the film from which a render continues, and the options that it
 * determines.
 *
 * In:    the command line, a film.   Out: render options and a stop rule as the first render had them.
 * Knows: which options a film determines.   Does not know: how sums are continued (render/resume.c). */
#ifndef BP_CLI_JOB_RESUME_FILM_H
#define BP_CLI_JOB_RESUME_FILM_H

#include "cli/line/options.h"
#include "cluster/comm.h"
#include "film/film.h"

/* Reads the film that --resume names; *film stays NULL without it. Of the ranks that share a picture, one
 * reads all of it and the others no more than its header. `shared`: Optional. BP_ERR_FILE. */
BpStatus bp_resume_load(const BpCommandLine *line, const BpComm *shared, BpFilm **film, BpError *err);

/* Gives the scene the film's width. BP_ERR_USAGE: --width differs, or the scene does. */
BpStatus bp_resume_scene(const BpCommandLine *line, const BpFilm *film, BpScene *scene, BpError *err);

/* Sets the options that determine the samples to those of the film. BP_ERR_USAGE names the first that was
 * given with another value. */
BpStatus bp_resume_options(const BpCommandLine *line, const BpFilm *film, BpRenderOptions *options,
                           BpError *err);

/* Sets the stop rule: samples, error and time from the command line, or else as in the film. BP_ERR_USAGE:
 * the film has more samples than --spp asks for, or nothing would end the render. */
BpStatus bp_resume_rule(const BpCommandLine *line, const BpFilm *film, BpStopRule *rule, BpError *err);

#endif
