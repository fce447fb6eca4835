/* page.h: the parts of the page of a study, in the order in which they stand there.
 *
 * In:    a finished study, a stream.   Out: HTML. Whether the stream failed is asked at the end (page.c).
 * Knows: HTML, SVG, how to plot.       Does not know: how anything was measured.
 *
 * The page is one file without scripts: nothing is fetched, and colours follow the reader's light or dark
 * scheme. Every figure that the page shows stands beside its text as data-value, for programs. */
#ifndef BP_COST_PAGE_H
#define BP_COST_PAGE_H

#include "study.h"

/* The style sheet, in pieces, the last NULL; static. Every colour is a variable with a light and a dark
 * value. */
extern const char *const bp_page_style[];

/* Text with what HTML would take for markup escaped. */
void bp_page_text(FILE *out, const char *text);
/* ` data-KEY="value"`; the value is empty where unknown. */
void bp_page_data(FILE *out, const char *key, double value);

/* The options of a command line, each in a <code> that is not broken. */
void bp_page_options(FILE *out, const char *options);

/* Error against seconds, with the front. */
void bp_page_front(const BpStudyResult *result, FILE *out);
/* Efficiency and bias of every way, as bars. */
void bp_page_bars(const BpStudyResult *result, FILE *out);
/* Crops and their error maps: of more samples, and of every way. */
void bp_page_strips(const BpStudyResult *result, FILE *out);
/* The figures. */
void bp_page_tables(const BpStudyResult *result, FILE *out);

#endif
