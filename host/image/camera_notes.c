/* camera_notes.c: see camera_notes.h. */
#include "camera_notes.h"

#include "base/message_text.h"

#include <string.h>

/* Whether an ICC profile calls itself sRGB, in ASCII or in UTF-16. */
static bool is_srgb_profile(const unsigned char *profile, size_t size) {
    for (size_t i = 0; i + 4 <= size; i++)
        if (memcmp(profile + i, "sRGB", 4) == 0 ||
            (i + 7 <= size && memcmp(profile + i, "s\0R\0G\0B", 7) == 0))
            return true;
    return false;
}

void bp_note_profile(BpImage *image, const char *name, const unsigned char *profile, size_t size) {
    char printable[80];
    if (is_srgb_profile(profile, size)) return;
    if (name == NULL) {
        bp_texels_note(image, "its ICC profile is not applied: read as sRGB");
        return;
    }
    bp_printable(name, printable, sizeof printable);
    bp_texels_note(image, "its ICC profile \"%s\" is not applied: read as sRGB", printable);
}

static unsigned long exif_number(const unsigned char *bytes, int count, bool big_first) {
    unsigned long value = 0;
    for (int i = 0; i < count; i++) value = value << 8 | bytes[big_first ? i : count - 1 - i];
    return value;
}

/* The orientation in Exif data (a TIFF file's first directory), from 1, rows as they are stored, to 8; 0: it
 * has none. */
static unsigned exif_orientation(const unsigned char *data, size_t size) {
    enum { HEAD = 8, ENTRY = 12, TAG = 0x0112 };
    if (size < HEAD) return 0;
    const bool big_first = data[0] == 'M';
    const size_t directory = exif_number(data + 4, 4, big_first);
    if (directory < HEAD || directory + 2 > size) return 0;
    const size_t count = exif_number(data + directory, 2, big_first);
    for (size_t i = 0; i < count && directory + 2 + (i + 1) * ENTRY <= size; i++) {
        const unsigned char *const entry = data + directory + 2 + i * ENTRY;
        if (exif_number(entry, 2, big_first) == TAG) return (unsigned)exif_number(entry + 8, 2, big_first);
    }
    return 0;
}

/* Cameras store rows as their sensor lies, and note how it was held. */
void bp_note_orientation(BpImage *image, const unsigned char *exif, size_t size) {
    const unsigned orientation = exif_orientation(exif, size);
    if (orientation < 2 || orientation > 8) return;
    bp_texels_note(image, "its Exif orientation, %u, is not applied: read %s", orientation,
                   orientation == 3                       ? "upside down"
                   : orientation == 6 || orientation == 8 ? "turned by 90 degrees"
                   : orientation == 2                     ? "mirrored"
                                                          : "mirrored and turned");
}
