/* requests.h: a program for scripts that answers one question about a file, or many, one after another:
 * starting a process for each takes longer than reading most files, ten times as long with sanitizers.
 *
 * As PROGRAM ARGUMENT... it answers once. As `PROGRAM -` it answers every line of standard input, whose
 * arguments are separated by tabs: what the answer prints, or the message if the file is refused, and then a
 * line "= EXIT_CODE". */
#ifndef BALLPARK_TESTS_REQUESTS_H
#define BALLPARK_TESTS_REQUESTS_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REQUEST_ARGUMENTS_MAX = 8, REQUEST_LINE_MAX = 8192 };

/* Returns the exit code of the program. `answer` is given arguments as main is, and prints messages to
 * `messages`. */
static int answer_requests(int argc, char **argv, int answer(int argc, char **argv, FILE *messages)) {
    if (argc != 2 || strcmp(argv[1], "-") != 0) return answer(argc, argv, stderr);
    char line[REQUEST_LINE_MAX];
    while (fgets(line, sizeof line, stdin) != NULL) {
        char *end = strchr(line, '\n');
        if (end == NULL) return 2;
        *end = '\0';
        char *words[REQUEST_ARGUMENTS_MAX + 1] = {argv[0]};
        int count = 1;
        for (char *word = line; word != NULL && count < REQUEST_ARGUMENTS_MAX; count++) {
            words[count] = word;
            word = strchr(word, '\t');
            if (word != NULL) *word++ = '\0';
        }
        const int code = answer(count, words, stdout);
        printf("= %d\n", code);
        fflush(stdout);
    }
    return 0;
}

#endif
