/* check_failure.c: see check_failure.h. */
#include "check_failure.h"

#include "base/json_memory.h"
#include "base/json_text.h"
#include "check_junit.h"
#include "cli/output/json_file.h"
#include "cli/output/output.h"
#include "cli/terminal/page.h"
#include "junit_file.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* "scene.json:3:7: message". */
static json_t *reason_of(const BpError *error) {
    char place[560] = "", text[sizeof place + sizeof error->message];
    if (error->file[0] != '\0' && error->line > 0)
        snprintf(place, sizeof place, "%s:%d:%d: ", error->file, error->line, error->column);
    else if (error->file[0] != '\0')
        snprintf(place, sizeof place, "%s: ", error->file);
    snprintf(text, sizeof text, "%s%s", place, error->message);
    return bp_json_text(text);
}

static json_t *junit_suites(const char *name, const BpError *error, const json_t *broken) {
    json_t *suites = bp_check_junit(NULL, broken);
    json_t *suite = json_pack("{s:s, s:{s:s}, s:[{s:o, s:s, s:f, s:s, s:s, s:o}]}", "name", "ballpark check",
                              "properties", "ballpark", bp_version(), "cases", "name", bp_json_text(name),
                              "class", "ballpark.check", "seconds", 0.0, "outcome", "error", "type",
                              bp_status_name(error->code), "reason", reason_of(error));
    if (json_array_append_new(suites, suite) == 0) return suites;
    json_decref(suites);
    return NULL;
}

static json_t *document(const char *suite, const char *name, const BpError *error, const json_t *broken) {
    const bool scenes = suite != NULL && strcmp(suite, "bits") != 0;
    return json_pack("{s:s, s:o, s:[], s:s, s:{s:s, s:o, s:o, s:i, s:i}, s:O}", "ballpark", bp_version(),
                     suite != NULL ? "suite" : "scene", bp_json_text(name), scenes ? "scenes" : "results",
                     "verdict", "failed", "error", "kind", bp_status_name(error->code), "message",
                     bp_json_text(error->message), "file", bp_json_text(error->file), "line", error->line,
                     "column", error->column, "broken_drivers", broken);
}

/* What can be said without memory for more. */
static BpStatus print_lack_of_memory(const void *what, FILE *out, BpError *err) {
    return bp_print_end(out, fputs(what, out) != EOF, err);
}
static const char junit_without_memory[] =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
    "  <testsuite name=\"ballpark check\" tests=\"1\" failures=\"0\" errors=\"1\" skipped=\"0\" time=\"0\">\n"
    "    <testcase classname=\"ballpark.check\" name=\"check\" time=\"0\">\n"
    "      <error type=\"out of memory\" message=\"out of memory\"/>\n    </testcase>\n"
    "  </testsuite>\n</testsuites>\n";
static const char json_without_memory[] =
    "{\n  \"results\": [],\n  \"verdict\": \"failed\",\n"
    "  \"error\": {\"kind\": \"out of memory\", \"message\": \"out of memory\", \"file\": \"\", \"line\": 0, "
    "\"column\": 0},\n  \"broken_drivers\": []\n}\n";

/* Whether the file does not exist, is empty, or begins like such a document. */
static bool looks_like(const char *path, const char *begin) {
    char found[16] = "";
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0) return true;
    FILE *in = fopen(path, "rb");
    if (in == NULL) return false;
    const bool read = fgets(found, sizeof found, in) != NULL;
    fclose(in);
    return read && strncmp(found, begin, strlen(begin)) == 0;
}

static void write_one(const BpCommandLine *line, const char *path, json_t *what, bool is_junit,
                      bool careful) {
    BpError fault = {0};
    BpStatus status = BP_OK;
    const bool whole = what != NULL && !bp_json_memory_failed();
    if (careful && !looks_like(path, is_junit ? "<?xml" : "{")) {
        json_decref(what);
        bp_say(line, "warning: %s is left as it is, since it is none of this program's documents", path);
        return;
    }
    bp_line_say_overwritten(line, path);
    if (whole)
        status =
            is_junit ? bp_junit_write(line, what, path, &fault) : bp_json_write(line, what, path, &fault);
    else
        status = bp_line_write(line, path, print_lack_of_memory,
                               is_junit ? junit_without_memory : json_without_memory, &fault);
    if (!whole) json_decref(what);
    bp_error_add_remedy(&fault, BP_INTERFACE_COMMAND_LINE);
    if (status != BP_OK) bp_say(line, "warning: %s could not be written: %s", path, fault.message);
    bp_error_clear(&fault);
}

void bp_check_failure_write(const BpCommandLine *line, const char *suite, const BpError *error,
                            json_t *broken, bool junit, bool json, bool careful) {
    const char *name = suite != NULL ? suite : line->operand_count > 0 ? line->operands[0] : "";
    if (junit) write_one(line, line->junit, junit_suites(name, error, broken), true, careful);
    if (json) write_one(line, line->json, document(suite, name, error, broken), false, careful);
    json_decref(broken);
}
