/* exr_layers.c: see exr_layers.h. */
#include "exr_layers.h"

#include "base/message_text.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { LIST_SIZE = 320 };

/* What has been seen of a file's layers. */
typedef struct Search {
    BpExrLayer first, named; /* the first suitable layer; the first with a name of the whole picture */
    size_t plain, layers, named_count;
    bool chroma;          /* one has luminance and chroma */
    char list[LIST_SIZE]; /* their names */
} Search;

/* The length of the layer's part of a channel's name, including the dot. */
static size_t prefix_length(const char *name) {
    const char *const point = strrchr(name, '.');
    return point != NULL ? (size_t)(point - name) + 1 : 0;
}

/* The channel `letters` of the layer of `name`, or NULL. */
static const exr_attr_chlist_entry_t *find_channel(const exr_attr_chlist_t *channels, const char *name,
                                                   const char *letters) {
    const size_t length = prefix_length(name);
    for (int i = 0; i < channels->num_channels; i++) {
        const char *const other = channels->entries[i].name.str;
        if (strncmp(other, name, length) == 0 && strcmp(other + length, letters) == 0)
            return &channels->entries[i];
    }
    return NULL;
}

/* Whether the channel `name` is the one by which its layer is known: R beside G and B, or Y alone; a Y
 * between X and Z is a coordinate. */
static bool begins_layer(const exr_attr_chlist_t *channels, const char *name, bool *gray, bool *chroma) {
    const char *const letters = name + prefix_length(name);
    const bool has_colors = find_channel(channels, name, "R") != NULL &&
                            find_channel(channels, name, "G") != NULL &&
                            find_channel(channels, name, "B") != NULL;
    *gray = strcmp(letters, "Y") == 0;
    *chroma =
        *gray && (find_channel(channels, name, "RY") != NULL || find_channel(channels, name, "BY") != NULL);
    if (!*gray) return strcmp(letters, "R") == 0 && has_colors;
    static const char *const others[] = {"R", "G", "B", "X"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (find_channel(channels, name, others[i]) != NULL) return false;
    return !*chroma;
}

/* A layer's name for people: that of its part, if it has one, and its own. */
static void layer_name(exr_const_context_t exr, int part, const char *prefix, char name[BP_EXR_NAME_SIZE]) {
    const char *part_name = NULL;
    char text[BP_EXR_NAME_SIZE];
    const size_t length = strlen(prefix);
    if (exr_get_name(exr, part, &part_name) != EXR_ERR_SUCCESS || part_name == NULL) part_name = "";
    snprintf(text, sizeof text, "%.100s%s%.*s", part_name, part_name[0] != '\0' && length > 0 ? "." : "",
             length > 100 ? 100
             : length > 0 ? (int)length - 1
                          : 0,
             prefix);
    bp_printable(text, name, BP_EXR_NAME_SIZE);
}

static bool is_whole_picture(const char *name) {
    static const char *const names[] = {"Combined", "beauty", "rgba"};
    const char *const last = name + prefix_length(name);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasecmp(last, names[i]) == 0) return true;
    return false;
}

static void list_name(const char *name, char list[LIST_SIZE]) {
    const size_t used = strlen(list);
    if (used + strlen(name) + 8 < LIST_SIZE)
        snprintf(list + used, LIST_SIZE - used, "%s\"%s\"", used > 0 ? ", " : "", name);
    else if (used > 0 && list[used - 1] != '.')
        strcat(list, ", ...");
}

static void take_layer(exr_const_context_t exr, int part, const char *channel, bool gray, Search *search) {
    BpExrLayer layer = {.part = part, .gray = gray};
    const size_t length = prefix_length(channel);
    char name[BP_EXR_NAME_SIZE];
    if (length >= sizeof layer.prefix) return; /* the library allows no name so long */
    memcpy(layer.prefix, channel, length);
    layer_name(exr, part, layer.prefix, name);
    if (length == 0 ? search->plain++ == 0 : search->plain == 0 && search->layers == 0) search->first = layer;
    if (is_whole_picture(name) && search->named_count++ == 0) search->named = layer;
    search->layers++;
    list_name(name, search->list);
}

static bool is_deep(exr_const_context_t exr, int part) {
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    return exr_get_storage(exr, part, &storage) != EXR_ERR_SUCCESS ||
           (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED);
}

static void search_part(exr_const_context_t exr, int part, Search *search) {
    const exr_attr_chlist_t *channels = NULL;
    if (exr_get_channels(exr, part, &channels) != EXR_ERR_SUCCESS) return;
    for (int i = 0; i < channels->num_channels; i++) {
        bool gray = false, chroma = false;
        const char *const name = channels->entries[i].name.str;
        if (begins_layer(channels, name, &gray, &chroma)) take_layer(exr, part, name, gray, search);
        search->chroma = search->chroma || chroma;
    }
}

/* Whether the layer's channels can become texels. */
static BpStatus check_layer(const BpImageInput *input, exr_const_context_t exr, const BpExrLayer *layer,
                            BpError *err) {
    const exr_attr_chlist_t *channels = NULL;
    if (exr_get_channels(exr, layer->part, &channels) != EXR_ERR_SUCCESS)
        return bp_image_fail(input, err, "found a damaged OpenEXR file: its channels");
    for (int i = 0; i < channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *channel = &channels->entries[i];
        if (bp_exr_channel_place(layer, channel->name.str) < 0) continue;
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return bp_image_fail(input, err,
                                 "found a channel %s with fewer samples than pixels, expected one for each",
                                 channel->name.str + strlen(layer->prefix));
        if (channel->pixel_type != EXR_PIXEL_HALF && channel->pixel_type != EXR_PIXEL_FLOAT)
            return bp_image_fail(input, err, "found whole numbers in channel %s, expected floats",
                                 channel->name.str + strlen(layer->prefix));
    }
    return BP_OK;
}

static BpStatus fail_no_layer(const BpImageInput *input, const Search *search, bool deep, BpError *err) {
    if (search->layers > 1)
        return bp_image_fail(input, err,
                             "found the layers %s, expected channels R, G and B, or one layer that has them; "
                             "save the one you want as a separate file",
                             search->list);
    if (search->chroma)
        return bp_image_fail(
            input, err,
            "found luminance and chroma (the channels Y, RY and BY), expected channels R, G and B; "
            "convert it");
    if (deep) return bp_image_fail(input, err, "found deep data, expected an image");
    return bp_image_fail(input, err, "found no channels R, G and B, nor Y alone, expected these");
}

BpStatus bp_exr_layer_choose(const BpImageInput *input, exr_const_context_t exr, BpExrLayer *layer,
                             BpError *err) {
    Search search = {0};
    int parts = 0;
    bool deep = false;
    if (exr_get_count(exr, &parts) != EXR_ERR_SUCCESS || parts < 1)
        return bp_image_fail(input, err, "found a damaged OpenEXR file: its header");
    for (int part = 0; part < parts; part++) {
        deep = deep || is_deep(exr, part);
        if (!is_deep(exr, part)) search_part(exr, part, &search);
    }
    if (search.plain > 0 || search.layers == 1)
        *layer = search.first;
    else if (search.named_count == 1)
        *layer = search.named;
    else
        return fail_no_layer(input, &search, deep, err);
    const bool only_part = search.plain == 1 && parts == 1;
    char name[BP_EXR_NAME_SIZE];
    layer_name(exr, layer->part, layer->prefix, name);
    if (!only_part && (search.layers > 1 || layer->prefix[0] != '\0'))
        snprintf(layer->note, sizeof layer->note, "the layer \"%s\" is used, of %zu in the file", name,
                 search.layers);
    return check_layer(input, exr, layer, err);
}

/* The channel's name within the layer, if that is one letter; else 0. */
static char letter_of(const BpExrLayer *layer, const char *channel) {
    const size_t length = strlen(layer->prefix);
    return strncmp(channel, layer->prefix, length) == 0 && strlen(channel) == length + 1 ? channel[length]
                                                                                         : 0;
}

int bp_exr_channel_place(const BpExrLayer *layer, const char *channel) {
    const char *const letters = layer->gray ? "Y" : "RGB";
    const char letter = letter_of(layer, channel);
    const char *const place = letter != 0 ? strchr(letters, letter) : NULL;
    return place != NULL ? (int)(place - letters) : -1;
}

bool bp_exr_channel_is_alpha(const BpExrLayer *layer, const char *channel) {
    return letter_of(layer, channel) == 'A';
}
