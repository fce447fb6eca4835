/* fuzz_options.c: any words as a command line (host/cli/line/options.h), and any text as an option's value.
 *
 * Words end at newlines. What is accepted is within the ranges that options.h states; what is refused has its
 * reason. Nothing is run: at most files are asked whether they are the same one. */
#include "cli/line/option_table.h"
#include "cli/line/values.h"
#include "film/film.h"
#include "fuzz.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#define WORDS_MAX 64

static void check_line(const BpCommandLine *line) {
    require(line->operand_count <= WORDS_MAX);
    if (line->command == NULL) {
        require(line->help || line->version);
        return;
    }
    for (int o = 0; o < BP_OPTION_NUMBER; ++o)
        require(!line->given[o] || o == BP_OPTION_HELP || bp_option_taken((BpOption)o, line->command));
    if (line->help) return;
    require(line->operand_count >= line->command->operands_min);
    require(line->operand_count <= line->command->operands_max);
#define GIVEN(option) bp_option_given(line, option)
    require(!GIVEN(BP_OPTION_SPP) || (line->samples_per_pixel >= 1 && line->samples_per_pixel <= BP_SPP_MAX));
    require(!GIVEN(BP_OPTION_ERROR) || (line->error_percent > 0 && line->error_percent <= 100));
    require(!GIVEN(BP_OPTION_TIME) || (line->time_seconds > 0 && line->time_seconds <= 1e7));
    require(!GIVEN(BP_OPTION_WIDTH) || (line->width >= 1 && line->width <= BP_PICTURE_SIDE_MAX));
    require(!GIVEN(BP_OPTION_PIXEL) ||
            (line->pixel.x < BP_PICTURE_SIDE_MAX && line->pixel.y < BP_PICTURE_SIDE_MAX));
    require(line->max_depth <= BP_DEPTH_MAX && line->first_sample < BP_SAMPLE_NUMBERS);
    require(!GIVEN(BP_OPTION_COUNT) || (line->count >= 1 && line->count <= BP_SPHERES_MAX));
    require(!GIVEN(BP_OPTION_OUTPUT) || (line->output != NULL && line->output[0] != '\0'));
    require(!GIVEN(BP_OPTION_DEVICE) || (line->device != NULL && line->device[0] != '\0'));
    require(!GIVEN(BP_OPTION_FRAMES) || line->frames.step >= 1);
    require(!GIVEN(BP_OPTION_TURNTABLE) || line->turntable >= 2);
#undef GIVEN
}

static void try_command_line(char *text, size_t length) {
    static char program[] = "ballpark";
    char *words[WORDS_MAX + 2] = {program};
    int count = 1;
    for (size_t start = 0; start < length && count <= WORDS_MAX; start += strlen(text + start) + 1)
        words[count++] = text + start;
    words[count] = NULL;
    BpCommandLine line;
    BpError err = {0};
    const BpStatus status = bp_command_line_parse(count, words, &line, &err);
    if (status == BP_OK)
        check_line(&line);
    else
        require(err.code == status && err.message[0] != '\0' && strlen(err.message) < sizeof err.message);
    bp_error_clear(&err);
}

static void try_values(const char *text) {
    static const char *const words[] = {"single", "double", "4"};
    BpError err = {0};
    uint64_t whole = 0, again = 0;
    uint32_t x = 0, y = 0;
    unsigned choice = 0;
    double real = 0;
    char printed[64];
    if (bp_value_whole("--x", text, 1, UINT64_MAX, &whole, &err) == BP_OK) {
        snprintf(printed, sizeof printed, "%" PRIu64, whole);
        require(whole >= 1 && bp_value_whole("--x", printed, whole, whole, &again, &err) == BP_OK &&
                again == whole);
    }
    if (bp_value_real("--x", text, 0, 1e7, &real, &err) == BP_OK) require(real > 0 && real <= 1e7);
    if (bp_value_choice("--x", text, words, 3, &choice, &err) == BP_OK)
        require(choice < 3 && strcmp(words[choice], text) == 0);
    if (bp_value_pair("--x", text, 99, &x, &y, &err) == BP_OK)
        require(x <= 99 && y <= 99 && strchr(text, ',') != NULL);
    const char *nearest = bp_option_nearest(text, NULL);
    require(nearest == NULL || nearest[0] != '\0');
    const BpCommand *command = NULL;
    if (bp_command_find(text, &command, &err) == BP_OK) require(strcmp(command->name, text) == 0);
    bp_error_clear(&err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = malloc(size + 1);
    require(text != NULL);
    if (size > 0) memcpy(text, data, size);
    text[size] = '\0';
    try_values(text);
    for (size_t i = 0; i < size; i++)
        if (text[i] == '\n') text[i] = '\0';
    try_command_line(text, size);
    free(text);
    return 0;
}
