/* keep_sums.c: see keep_sums.h. */
#include "keep_sums.h"

#include "base/output_file.h"
#include "base/output_temporary.h"
#include "film/film_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool goes_to_a_file(const char *result) {
    struct stat info;
    const int failed = strcmp(result, "-") == 0 ? fstat(STDOUT_FILENO, &info) : stat(result, &info);
    return failed != 0 || S_ISREG(info.st_mode);
}

/* Writes to the open new file `name`, whole or not at all; returns its name, or NULL. */
static char *write_film(const BpFilm *film, int descriptor, char **name) {
    FILE *out = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    bool good = out != NULL && bp_film_write_stream(film, out, NULL) == BP_OK;
    if (out != NULL && fclose(out) != 0) good = false;
    if (out == NULL && descriptor >= 0) close(descriptor);
    if (good) return bp_temporary_keep(name);
    bp_temporary_remove(name);
    return NULL;
}

void bp_keep_sums(const BpFilm *film, const char *result, BpError *err) {
    if (err == NULL || !goes_to_a_file(result) || strstr(err->message, BP_OUTPUT_KEPT_AS) != NULL) return;
    static const char target[] = "ballpark.bpa"; /* a suffix makes the name unique */
    char *name = NULL;
    char *kept = write_film(film, bp_temporary_create_elsewhere(target, 0600, &name), &name);
    if (kept == NULL) kept = write_film(film, bp_temporary_create_in(".", target, 0600, &name), &name);
    if (kept == NULL) return;
    bp_error_add_remedy(err, BP_INTERFACE_COMMAND_LINE);
    char text[sizeof err->message];
    const int length =
        snprintf(text, sizeof text,
                 "the samples are kept: `ballpark merge %s -o FILE` makes the picture from them", kept);
    const size_t used = strlen(err->message);
    if (length >= 0 && used + 2 + (size_t)length < sizeof err->message)
        strcat(strcat(err->message, "; "), text);
    else
        bp_error_attach(err, text);
    free(kept);
}
