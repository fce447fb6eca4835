/* output_temporary.h: the temporary files behind output_file.h.
 *
 * In:    a target path.   Out: a file without a name, or with a unique one.
 * Knows: unnamed files, links, renames, the names that are in use.   Does not know: what is written, how
 * errors are reported: everything here returns an errno.
 *
 * The names of unfinished temporaries are kept in one list, so that the thread that ends the program on a
 * signal can remove them. */
#ifndef BP_BASE_OUTPUT_TEMPORARY_H
#define BP_BASE_OUTPUT_TEMPORARY_H

#include <stdbool.h>
#include <sys/types.h>

/* Creates the temporary of `target` in its folder, for reading and writing: without a name where the system
 * supports it (*unnamed), else as TARGET.XXXXXX (*name, heap). Returns the descriptor, or -1 and errno. */
int bp_temporary_create(const char *target, mode_t mode, bool *unnamed, char **name);
/* The same with a name in `folder`. */
int bp_temporary_create_in(const char *folder, const char *target, mode_t mode, char **name);
/* The same in $TMPDIR or /tmp. */
int bp_temporary_create_elsewhere(const char *target, mode_t mode, char **name);

/* Puts the finished temporary at `target`; 0, or an errno. After a failure it still exists, as it was or with
 * a name. `replace`: replaces an existing file; otherwise EEXIST if one exists by then. */
int bp_temporary_place(bool *unnamed, char **name, int descriptor, const char *target, bool replace);

/* Gives a finished temporary without a name one in $TMPDIR or /tmp, by copying it; 0, or an errno. */
int bp_temporary_name_elsewhere(int descriptor, const char *target, char **name);

/* Copies a finished temporary into the file at `target`, which stays the same file; 0, or an errno. */
int bp_temporary_copy(int descriptor, const char *target);

/* Removes the temporary, and forgets and frees its name. Accepts NULL. */
void bp_temporary_remove(char **name);
/* Transfers the name to the caller; the file will no longer be removed. */
char *bp_temporary_keep(char **name);

/* See bp_output_abandon(). */
void bp_temporary_abandon(void);

#endif
