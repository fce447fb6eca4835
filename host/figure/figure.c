/* figure.c: see figure.h. */
#include "figure.h"

#include "base/words.h"

#include <stddef.h>

#define TEXT_WORDS(X) X(BP_TEXT_AUTO, "auto") X(BP_TEXT_BLACK, "black") X(BP_TEXT_WHITE, "white")
BP_WORDS_ENDED(BpFigureText, const char *const bp_figure_text_names, TEXT_WORDS);

bool bp_figure_has_text(const BpFigure *figure) {
    return figure->bar.shown;
}
