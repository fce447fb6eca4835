/* scene_figure.c: see scene_figure.h. */
#include "scene_figure.h"

#include <stdio.h>
#include <string.h>

static BpStatus read_size(const BpNode *node, double *points, BpError *err) {
    BP_TRY(bp_node_number(node, points, err));
    if (node->value == NULL || (*points >= BP_FIGURE_POINTS_MIN && *points <= BP_FIGURE_POINTS_MAX))
        return BP_OK;
    return bp_node_wrong(node, "points from 1 to 144", err);
}

static BpStatus read_text(const BpNode *node, const char *expected, char text[BP_FIGURE_TEXT_SIZE],
                          BpError *err) {
    const char *found = "";
    BP_TRY(bp_node_string(node, &found, err));
    if (strlen(found) >= BP_FIGURE_TEXT_SIZE) return bp_node_wrong(node, expected, err);
    memcpy(text, found, strlen(found) + 1);
    return BP_OK;
}

BpStatus bp_parse_figure(const BpNode *node, BpScene *scene, BpError *err) {
    static const char *const names[] = {"font", "size", "text"};
    BpFigure *const figure = &scene->figure;
    int text = BP_TEXT_AUTO;
    if (node->value == NULL) return BP_OK;
    if (!json_is_object(node->value))
        return bp_node_wrong(
            node, "an object such as { \"font\": \"DejaVu Sans\", \"size\": 7, \"text\": \"black\" }", err);
    BP_TRY(bp_node_object(node, names, BP_COUNT(names), err));
    const BpNode font = bp_node_member(node, "font"), size = bp_node_member(node, "size");
    const BpNode color = bp_node_member(node, "text");
    BP_TRY(read_text(&font, "the name of a font, at most 255 bytes", figure->font, err));
    BP_TRY(read_size(&size, &figure->points, err));
    BP_TRY(bp_node_choice(&color, bp_figure_text_names, BP_TEXT_WHITE + 1, &text, err));
    figure->text = (BpFigureText)text;
    return BP_OK;
}
