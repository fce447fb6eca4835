/* resume_film.h: --resume: the film from which a render continues, and the options that it determines.
 *
 * In:    the command line, a film.   Out: render options and a stop rule as the first render had them.
 * Knows: which options a film decides.   Does not know: how sums are taken up (render/resume.c). */
#ifndef BP_CLI_JOB_RESUME_FILM_H
#define BP_CLI_JOB_RESUME_FILM_H

#include "cli/line/options.h"
#include "cluster/comm.h"
#include "film/film.h"

/* Reads the film that --resume names; *film stays NULL without it. Of the ranks that share a picture, one
 * reads all of it and the others no more than its header. `shared`: Optional. BP_ERR_FILE. */
BpStatus bp_resume_load(const BpCommandLine *line, const BpComm *shared, BpFilm **film, BpError *err);

/* Gives the scene the film's width. BP_ERR_USAGE: --width says another one, or it is another scene. */
BpStatus bp_resume_scene(const BpCommandLine *line, const BpFilm *film, BpScene *scene, BpError *err);

/* Sets the options that decide about samples as the film has them. BP_ERR_USAGE names the first that was
 * given with another value. */
BpStatus bp_resume_options(const BpCommandLine *line, const BpFilm *film, BpRenderOptions *options,
                           BpError *err);

/* Sets the stop rule: what the command line says of samples, error and time, and what it does not say as it
 * was. BP_ERR_USAGE: the film has more samples than --spp asks for, or nothing would end the render. */
BpStatus bp_resume_rule(const BpCommandLine *line, const BpFilm *film, BpStopRule *rule, BpError *err);

#endif
