/* junit_file.c: see junit_file.h. */
#include "junit_file.h"

#include "cli/output/json_file.h"

#include "base/escape.h"

#include <stdio.h>
#include <string.h>

/* Text as the value of an attribute. JSON's texts are UTF-8; what XML cannot hold becomes '?'. */
static void print_escaped(const char *text, FILE *out) {
    for (; *text != '\0'; ++text) {
        const unsigned char c = (unsigned char)*text;
        uint32_t character = 0;
        size_t length = 0;
        if (c == '&')
            fputs("&amp;", out);
        else if (c == '<')
            fputs("&lt;", out);
        else if (c == '>')
            fputs("&gt;", out);
        else if (c == '"')
            fputs("&quot;", out);
        else if (c == '\n' || c == '\t' || c == '\r')
            fprintf(out, "&#%u;", c);
        else if (c < 0x20 || c == 0x7f)
            fputc('?', out);
        else if ((length = bp_control_length(text, &character)) > 0) {
            fprintf(out, "&#%u;", (unsigned)character);
            text += length - 1;
        }
        /* U+FFFE and U+FFFF */
        else if (c == 0xef && (unsigned char)text[1] == 0xbf && (unsigned char)text[2] >= 0xbe) {
            fputc('?', out);
            text += 2;
        } else
            fputc(c, out);
    }
}

static const char *text_of(const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    return text != NULL ? text : "";
}

static void print_attribute(const char *name, const char *value, FILE *out) {
    fprintf(out, " %s=\"", name);
    print_escaped(value, out);
    fputc('"', out);
}

static void print_case(const json_t *entry, FILE *out) {
    const char *outcome = text_of(entry, "outcome");
    fputs("    <testcase", out);
    print_attribute("classname", text_of(entry, "class"), out);
    print_attribute("name", text_of(entry, "name"), out);
    fprintf(out, " time=\"%.3f\"", json_number_value(json_object_get(entry, "seconds")));
    if (strcmp(outcome, "passed") == 0) {
        fputs("/>\n", out);
        return;
    }
    fprintf(out, ">\n      <%s", outcome);
    if (strcmp(outcome, "skipped") != 0) print_attribute("type", text_of(entry, "type"), out);
    print_attribute("message", text_of(entry, "reason"), out);
    fputs("/>\n    </testcase>\n", out);
}

static unsigned count_of(const json_t *suite, const char *outcome) {
    unsigned count = 0;
    size_t index;
    json_t *entry;
    json_array_foreach(json_object_get(suite, "cases"), index, entry) {
        count += strcmp(text_of(entry, "outcome"), outcome) == 0;
    }
    return count;
}

static void print_suite(const json_t *suite, FILE *out) {
    const json_t *cases = json_object_get(suite, "cases");
    double seconds = 0;
    size_t index;
    const char *key;
    json_t *entry;
    json_array_foreach(cases, index, entry) {
        seconds += json_number_value(json_object_get(entry, "seconds"));
    }
    fputs("  <testsuite", out);
    print_attribute("name", text_of(suite, "name"), out);
    fprintf(out, " tests=\"%zu\" failures=\"%u\" errors=\"%u\" skipped=\"%u\" time=\"%.3f\">\n",
            json_array_size(cases), count_of(suite, "failure"), count_of(suite, "error"),
            count_of(suite, "skipped"), seconds);
    fputs("    <properties>\n", out);
    json_object_foreach(json_object_get(suite, "properties"), key, entry) {
        fputs("      <property", out);
        print_attribute("name", key, out);
        print_attribute("value", json_is_string(entry) ? json_string_value(entry) : "", out);
        fputs("/>\n", out);
    }
    fputs("    </properties>\n", out);
    json_array_foreach(cases, index, entry) {
        print_case(entry, out);
    }
    fputs("  </testsuite>\n", out);
}

static BpStatus print_suites(const void *what, FILE *out, BpError *err) {
    const json_t *suites = what;
    size_t index;
    json_t *suite;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n", out);
    json_array_foreach(suites, index, suite) {
        print_suite(suite, out);
    }
    fputs("</testsuites>\n", out);
    return bp_print_end(out, true, err);
}

BpStatus bp_junit_write(const BpCommandLine *line, json_t *suites, const char *path, BpError *err) {
    return bp_json_write_as(line, suites, path, print_suites, err);
}
