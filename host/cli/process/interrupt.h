/* interrupt.h: signals that would end the program are recorded instead of ending it at once: Ctrl-C (SIGINT),
 * SIGTERM, SIGHUP (the terminal was closed; unless ignored, as nohup arranges), SIGXCPU (the limit on
 * processor time), SIGUSR1 and SIGUSR2 (a batch system's notice that time is nearly over).
 *
 * In:    signals.   Out: whether one has arrived; a message, printed if the program does not react in time.
 * Knows: signals, the thread that waits for them, that unfinished files must be removed.   Does not know:
 * what is interrupted.
 *
 * At first there is nothing to save, and a signal ends the program with code 130. A command that has
 * something worth saving calls bp_interrupt_catch(), polls bp_interrupted() between steps, saves, and returns
 * BP_ERR_INTERRUPTED. */
#ifndef BP_CLI_PROCESS_INTERRUPT_H
#define BP_CLI_PROCESS_INTERRUPT_H

#include <stdbool.h>

/* Called once by main, before anything else, so that threads and processes started later block the signals;
 * and by a forked process that should be interruptible like this one. */
void bp_interrupt_install(void);

/* From this call on, the first signal is recorded, and a second SIGINT or SIGTERM ends the program at once.
 * (Signals within a quarter of a second of the first are the same Ctrl-C, delivered twice.) */
void bp_interrupt_catch(void);
bool bp_interrupted(void);

/* Sets the message that is printed to standard error if it is still set most of a second after a signal: the
 * process may be waiting for an event that never comes, and may then be killed. Copied; "": none. */
void bp_interrupt_explain(const char *text);

#endif
