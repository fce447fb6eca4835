/* write_documents.c: a program of the build: writes the help as manual pages and as completions for shells.
 *
 * In:    the tables of commands and options.   Out: a folder with manual pages, and files for three shells.
 * Knows: how man(7), bash, zsh and fish write things.   Does not know: which options there are. */
#include "cli/line/option_table.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

static FILE *open_file(const char *folder, const char *name) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *const file = fopen(path, "w");
    if (file == NULL) fprintf(stderr, "write_documents: cannot write %s: %s\n", path, strerror(errno));
    return file;
}

static int close_file(FILE *file) {
    const bool failed = ferror(file) != 0;
    return fclose(file) == 0 && !failed ? 0 : 1;
}

/* Whether the command accepts the option: its own, and those of all commands. */
static bool takes(const BpCommand *command, BpOption option) {
    return option == BP_OPTION_HELP || bp_option_taken(option, command);
}

static bool is_flag(BpOption option) {
    char metavar[80];
    return bp_option_metavar(option, metavar, sizeof metavar)[0] == '\0';
}

static bool is_file(BpOption option) {
    char metavar[80];
    return strncmp(bp_option_metavar(option, metavar, sizeof metavar), "FILE", 4) == 0;
}

/* "cover|field": operands that are words, not files. */
static bool has_words(const BpCommand *command) {
    if (strchr(command->operands, '|') == NULL) return false;
    for (const char *at = command->operands; *at != '\0'; at++)
        if (isupper((unsigned char)*at)) return false;
    return true;
}

/* ---- manual pages -------------------------------------------------------------------------------------- */

/* Text of one paragraph; `last` is what stood before it on the line. Commands of roff begin with a point or
 * an apostrophe at the start of a line, and a bare hyphen would become a dash. */
static void put_roff(const char *text, size_t length, FILE *out) {
    for (size_t i = 0; i < length; i++) {
        if (i == 0 && (text[i] == '.' || text[i] == '\'')) fputs("\\&", out);
        if (text[i] == '\\')
            fputs("\\e", out);
        else if (text[i] == '-')
            fputs("\\-", out);
        else if (text[i] == '\'')
            fputs("\\(aq", out);
        else if (text[i] == '`')
            fputs("\\(ga", out);
        else if (text[i] == '^')
            fputs("\\(ha", out);
        else if (text[i] == '~')
            fputs("\\(ti", out);
        else
            fputc(text[i], out);
    }
}

static void put_text(const char *text, FILE *out) {
    put_roff(text, strlen(text), out);
}

static void put_paragraphs(const char *text, FILE *out) {
    for (const char *at = text; *at != '\0';) {
        const size_t length = strcspn(at, "\n");
        if (length > 0) {
            if (at != text) fputs(".PP\n", out);
            put_roff(at, length, out);
            fputc('\n', out);
        }
        at += length + (at[length] == '\n');
    }
}

/* The foot of every page. */
typedef struct Edition {
    const char *version, *date;
} Edition;

static void put_head(const char *title, const Edition *edition, FILE *out) {
    fputs(".TH ", out);
    for (const char *at = title; *at != '\0'; at++) {
        if (*at == '-') fputc('\\', out);
        fputc(toupper((unsigned char)*at), out);
    }
    fprintf(out, " 1 \"%s\" \"Ballpark %s\" \"Ballpark\"\n.SH NAME\n", edition->date, edition->version);
    put_text(title, out);
}

static void put_option(BpOption option, const BpCommand *command, FILE *out) {
    char metavar[80], help[512];
    fputs(".TP\n", out);
    if (bp_option_letter(option) != 0) fprintf(out, "\\fB\\-%c\\fR, ", bp_option_letter(option));
    fputs("\\fB\\-\\-", out);
    put_text(bp_option_name(option), out);
    fputs("\\fR", out);
    if (!is_flag(option)) {
        fputs(" \\fI", out);
        put_text(bp_option_metavar(option, metavar, sizeof metavar), out);
        fputs("\\fR", out);
    }
    fputc('\n', out);
    put_text(bp_option_help(option, command, help, sizeof help), out);
    fputc('\n', out);
}

/* Pages name documents as the sources do, docs/PARTICLES.md for example. */
static void put_documents(FILE *out) {
    fputs(".PP\nThe documents that the manual pages name (README.md, docs, scenes) are installed in\n"
          ".IR share/doc/ballpark ,\nusually\n.IR /usr/share/doc/ballpark .\n",
          out);
}

static int write_command_page(const BpCommand *command, const char *folder, const Edition *edition) {
    char name[96], title[80];
    snprintf(title, sizeof title, "ballpark-%s", command->name);
    snprintf(name, sizeof name, "%s.1", title);
    FILE *const out = open_file(folder, name);
    if (out == NULL) return 1;
    put_head(title, edition, out);
    fputs(" \\- ", out);
    put_text(command->summary, out);
    fputs("\n.SH SYNOPSIS\n\\fBballpark ", out);
    put_text(command->name, out);
    fputs("\\fR", out);
    if (command->operands[0] != '\0') {
        fputs(" \\fI", out);
        put_text(command->operands, out);
        fputs("\\fR", out);
    }
    if (command->bit != 0) fputs(" [\\fIOPTION\\fR]...", out);
    fputs("\n.SH DESCRIPTION\n", out);
    put_paragraphs(command->description, out);
    fputs(".SH OPTIONS\n", out);
    for (int o = 0; o < BP_OPTION_NUMBER; o++)
        if (takes(command, (BpOption)o)) put_option((BpOption)o, command, out);
    if (command->examples[0] != '\0') {
        fputs(".SH EXAMPLES\n.nf\n", out);
        for (const char *at = command->examples; *at != '\0';) {
            const size_t length = strcspn(at, "\n");
            put_roff(at, length, out);
            fputc('\n', out);
            at += length + (at[length] == '\n');
        }
        fputs(".fi\n", out);
    }
    fputs(".SH SEE ALSO\n.BR ballpark (1)\n", out);
    put_documents(out);
    return close_file(out);
}

static int write_main_page(const char *folder, const Edition *edition) {
    FILE *const out = open_file(folder, "ballpark.1");
    if (out == NULL) return 1;
    put_head("ballpark", edition, out);
    fputs(" \\- render scenes of spheres on any OpenCL device, and report the noise\n"
          ".SH SYNOPSIS\n\\fBballpark\\fR \\fICOMMAND\\fR [\\fIOPTION\\fR]...\n"
          ".SH DESCRIPTION\n"
          "Ballpark is a path tracer for spheres. It renders scenes and files of particles on any OpenCL "
          "device\n"
          "and reports how much noise is left in the picture. Each command has a page of its own.\n"
          ".SH COMMANDS\n",
          out);
    for (size_t c = 0; c < bp_command_count; c++) {
        fputs(".TP\n\\fBballpark\\-", out);
        put_text(bp_commands[c].name, out);
        fputs("\\fR(1)\n", out);
        put_text(bp_commands[c].summary, out);
        fputc('\n', out);
    }
    fputs(".SH OPTIONS\n.TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nprint help; after a command, about that "
          "command\n"
          ".TP\n\\fB\\-V\\fR, \\fB\\-\\-version\\fR\nprint version and commit\n"
          ".SH EXIT STATUS\n"
          "0: success. 1: failure at run time (device, memory, file, invalid samples in a picture). 2: "
          "invalid\n"
          "command line or scene. 130: interrupted. Of \\fBballpark check\\fR also 3: disagreement; 4: not "
          "enough evidence; 5: no such "
          "device;\n"
          "6: a device or its driver failed.\n"
          ".SH ENVIRONMENT\n"
          ".TP\n\\fBOCL_ICD_VENDORS\\fR\nwhere the OpenCL loader looks for drivers\n"
          ".TP\n\\fBPOCL_CACHE_DIR\\fR\nwhere PoCL, the driver for processors, keeps compiled kernels\n"
          ".TP\n\\fBBALLPARK_KERNEL_CACHE\\fR\n\\fBon\\fR or \\fBoff\\fR: whether Ballpark keeps compiled "
          "kernels, in\n\\fI$XDG_CACHE_HOME/ballpark/kernels\\fR or \\fI~/.cache/ballpark/kernels\\fR; "
          "by default\nthose that took long, except PoCL's\n"
          ".TP\n\\fBBALLPARK_SHOW\\fR\n\\fBkitty\\fR, \\fBiterm2\\fR, \\fBsixel\\fR or \\fBblocks\\fR: how "
          "\\fBballpark render \\-\\-show\\fR draws,\ninstead of what it detects of the terminal\n"
          ".TP\n\\fBBALLPARK_MPI\\fR\nthe module for MPI to load instead of the installed one, or "
          "\\fBoff\\fR:\neach copy that mpirun starts renders on its own\n"
          ".SH EXAMPLES\n.nf\n"
          "ballpark devices                        list the devices of this computer\n"
          "ballpark generate cover \\-o cover.json   write the book's cover scene\n"
          "ballpark render cover.json              render it to cover.png\n.fi\n"
          ".SH SEE ALSO\n",
          out);
    for (size_t c = 0; c < bp_command_count; c++) {
        fputs(".BR ballpark\\-", out);
        put_text(bp_commands[c].name, out);
        fprintf(out, " (1)%s\n", c + 1 < bp_command_count ? "," : "");
    }
    put_documents(out);
    return close_file(out);
}

/* ---- bash ---------------------------------------------------------------------------------------------- */

static void put_words(BpOption option, const char *between, FILE *out) {
    const char *const *words = bp_option_words(option);
    for (size_t w = 0; words[w] != NULL; w++) fprintf(out, "%s%s", w > 0 ? between : "", words[w]);
}

static void put_operands(const BpCommand *command, FILE *out) {
    for (const char *at = command->operands; *at != '\0'; at++) fputc(*at == '|' ? ' ' : *at, out);
}

static void put_names(FILE *out) {
    for (size_t c = 0; c < bp_command_count; c++) fprintf(out, "%s%s", c > 0 ? " " : "", bp_commands[c].name);
}

/* The cases of an option as the word before. */
static void put_pattern(BpOption option, FILE *out) {
    if (bp_option_letter(option) != 0) fprintf(out, "-%c | ", bp_option_letter(option));
    fprintf(out, "--%s", bp_option_name(option));
}

static int write_bash(const char *folder) {
    FILE *const out = open_file(folder, "ballpark.bash");
    if (out == NULL) return 1;
    fputs("# Completions of ballpark for bash, written by its build.\n"
          "# shellcheck shell=bash disable=SC2207\n"
          "_ballpark() {\n"
          "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command='' "
          "word options=''\n"
          "    # readline breaks --option=value into three words.\n"
          "    if [ \"$current\" = = ]; then\n"
          "        current=''\n"
          "    elif [ \"$previous\" = = ] && ((COMP_CWORD >= 2)); then\n"
          "        previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
          "    fi\n"
          "    for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
          "        case $word in\n"
          "        -*) ;;\n"
          "        *) command=$word; break ;;\n"
          "        esac\n"
          "    done\n"
          "    COMPREPLY=()\n"
          "    case $previous in\n",
          out);
    for (int o = 0; o < BP_OPTION_NUMBER; o++) {
        if (is_flag((BpOption)o)) continue;
        fputs("    ", out);
        put_pattern((BpOption)o, out);
        if (bp_option_words((BpOption)o) != NULL) {
            fputs(") COMPREPLY=($(compgen -W '", out);
            put_words((BpOption)o, " ", out);
            fputs("' -- \"$current\")); return ;;\n", out);
        } else if (is_file((BpOption)o)) {
            fputs(") COMPREPLY=($(compgen -f -- \"$current\")); return ;;\n", out);
        } else {
            fputs(") return ;;\n", out);
        }
    }
    fputs("    esac\n    case $command in\n    '')\n        COMPREPLY=($(compgen -W '", out);
    put_names(out);
    fputs(" --help --version' -- \"$current\"))\n        return ;;\n", out);
    for (size_t c = 0; c < bp_command_count; c++) {
        fprintf(out, "    %s) options='", bp_commands[c].name);
        for (int o = 0; o < BP_OPTION_NUMBER; o++)
            if (takes(&bp_commands[c], (BpOption)o)) fprintf(out, " --%s", bp_option_name((BpOption)o));
        fputs("' ;;\n", out);
    }
    fputs("    esac\n"
          "    case $current in\n"
          "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$current\")); return ;;\n"
          "    esac\n"
          "    case $command in\n",
          out);
    for (size_t c = 0; c < bp_command_count; c++) {
        const BpCommand *const command = &bp_commands[c];
        if (has_words(command)) {
            fprintf(out, "    %s) COMPREPLY=($(compgen -W '", command->name);
            put_operands(command, out);
            fputs("' -- \"$current\")) ;;\n", out);
        } else if (strstr(command->operands, "COMMAND") != NULL) {
            fprintf(out, "    %s) COMPREPLY=($(compgen -W '", command->name);
            put_names(out);
            fputs("' -- \"$current\")) ;;\n", out);
        } else if (command->operands[0] == '\0') {
            fprintf(out, "    %s) ;;\n", command->name);
        }
    }
    fputs("    *) COMPREPLY=($(compgen -f -- \"$current\")) ;;\n"
          "    esac\n"
          "}\n"
          "complete -o filenames -F _ballpark ballpark\n",
          out);
    return close_file(out);
}

/* ---- zsh ----------------------------------------------------------------------------------------------- */

/* In single quotes, where _arguments and _describe read colons and brackets. */
static void put_zsh(const char *text, FILE *out) {
    for (; *text != '\0'; text++) {
        if (*text == '\'')
            fputs("'\\''", out);
        else if (strchr(":[]\\", *text) != NULL)
            fprintf(out, "\\%c", *text);
        else
            fputc(*text, out);
    }
}

static void put_zsh_option(BpOption option, const BpCommand *command, FILE *out) {
    char metavar[80], help[512];
    const char *const name = bp_option_name(option);
    const char letter = bp_option_letter(option);
    const char *const equals = is_flag(option) ? "" : "=", *const plus = is_flag(option) ? "" : "+";
    const char *const many = option == BP_OPTION_SET ? "*" : "";
    fputs("            ", out);
    if (letter != 0)
        fprintf(out, "'(-%c --%s)'{-%c%s,--%s%s}'[", letter, name, letter, plus, name, equals);
    else
        fprintf(out, "'%s--%s%s[", many, name, equals);
    put_zsh(bp_option_help(option, command, help, sizeof help), out);
    fputc(']', out);
    if (!is_flag(option)) {
        fputc(':', out);
        put_zsh(bp_option_metavar(option, metavar, sizeof metavar), out);
        fputc(':', out);
        if (bp_option_words(option) != NULL) {
            fputc('(', out);
            put_words(option, " ", out);
            fputc(')', out);
        } else if (is_file(option)) {
            fputs("_files", out);
        }
    }
    fputs("' \\\n", out);
}

static int write_zsh(const char *folder) {
    FILE *const out = open_file(folder, "_ballpark");
    if (out == NULL) return 1;
    fputs("#compdef ballpark\n"
          "# Completions of ballpark for zsh, written by its build.\n"
          "_ballpark() {\n"
          "    local -a commands\n"
          "    local context state state_descr line\n"
          "    typeset -A opt_args\n"
          "    commands=(\n",
          out);
    for (size_t c = 0; c < bp_command_count; c++) {
        fprintf(out, "        '%s:", bp_commands[c].name);
        put_zsh(bp_commands[c].summary, out);
        fputs("'\n", out);
    }
    fputs("    )\n"
          "    _arguments -C '(- *)'{-h,--help}'[print help]' '(- *)'{-V,--version}'[print version and "
          "commit]' \\\n"
          "        '1:command:->command' '*::argument:->argument'\n"
          "    case $state in\n"
          "    command) _describe command commands ;;\n"
          "    argument)\n"
          "        case $line[1] in\n",
          out);
    for (size_t c = 0; c < bp_command_count; c++) {
        const BpCommand *const command = &bp_commands[c];
        fprintf(out, "        %s)\n            _arguments -s \\\n", command->name);
        for (int o = 0; o < BP_OPTION_NUMBER; o++)
            if (takes(command, (BpOption)o)) put_zsh_option((BpOption)o, command, out);
        if (has_words(command)) {
            fputs("            '*:", out);
            put_zsh(command->operands, out);
            fputs(":(", out);
            put_operands(command, out);
            fputs(")' ;;\n", out);
        } else if (strstr(command->operands, "COMMAND") != NULL) {
            fputs("            '*:command:(", out);
            put_names(out);
            fputs(")' ;;\n", out);
        } else if (command->operands[0] == '\0') {
            fputs("            ;;\n", out);
        } else {
            fputs("            '*:", out);
            put_zsh(command->operands, out);
            fputs(":_files' ;;\n", out);
        }
    }
    fputs("        esac ;;\n"
          "    esac\n"
          "}\n"
          "_ballpark \"$@\"\n",
          out);
    return close_file(out);
}

/* ---- fish ---------------------------------------------------------------------------------------------- */

static void put_fish(const char *text, FILE *out) {
    fputc('\'', out);
    for (; *text != '\0'; text++) {
        if (*text == '\'' || *text == '\\') fputc('\\', out);
        fputc(*text, out);
    }
    fputc('\'', out);
}

static int write_fish(const char *folder) {
    FILE *const out = open_file(folder, "ballpark.fish");
    if (out == NULL) return 1;
    char help[512];
    fputs("# Completions of ballpark for fish, written by its build.\n"
          "complete -c ballpark -n __fish_use_subcommand -f\n"
          "complete -c ballpark -n __fish_use_subcommand -s V -l version -d 'print version and commit'\n"
          "complete -c ballpark -n __fish_use_subcommand -s h -l help -d 'print help'\n",
          out);
    for (size_t c = 0; c < bp_command_count; c++) {
        const BpCommand *const command = &bp_commands[c];
        fprintf(out, "complete -c ballpark -n __fish_use_subcommand -a %s -d ", command->name);
        put_fish(command->summary, out);
        fputc('\n', out);
        if (has_words(command) || strstr(command->operands, "COMMAND") != NULL) {
            fprintf(out, "complete -c ballpark -n '__fish_seen_subcommand_from %s' -f -a '", command->name);
            if (has_words(command))
                put_operands(command, out);
            else
                put_names(out);
            fputs("'\n", out);
        } else if (command->operands[0] == '\0') {
            fprintf(out, "complete -c ballpark -n '__fish_seen_subcommand_from %s' -f\n", command->name);
        }
        for (int o = 0; o < BP_OPTION_NUMBER; o++) {
            if (!takes(command, (BpOption)o)) continue;
            fprintf(out, "complete -c ballpark -n '__fish_seen_subcommand_from %s'", command->name);
            if (bp_option_letter((BpOption)o) != 0) fprintf(out, " -s %c", bp_option_letter((BpOption)o));
            fprintf(out, " -l %s", bp_option_name((BpOption)o));
            if (bp_option_words((BpOption)o) != NULL) {
                fputs(" -x -a '", out);
                put_words((BpOption)o, " ", out);
                fputc('\'', out);
            } else if (!is_flag((BpOption)o)) {
                fputs(is_file((BpOption)o) ? " -r -F" : " -x", out);
            }
            fputs(" -d ", out);
            put_fish(bp_option_help((BpOption)o, command, help, sizeof help), out);
            fputc('\n', out);
        }
    }
    return close_file(out);
}

int main(int argc, char **argv) {
    if (argc != 4) return fprintf(stderr, "usage: write_documents FOLDER VERSION DATE\n"), 2;
    const Edition edition = {.version = argv[2], .date = argv[3]};
    int failed = write_main_page(argv[1], &edition);
    for (size_t c = 0; c < bp_command_count; c++)
        failed |= write_command_page(&bp_commands[c], argv[1], &edition);
    failed |= write_bash(argv[1]);
    failed |= write_zsh(argv[1]);
    failed |= write_fish(argv[1]);
    return failed;
}
