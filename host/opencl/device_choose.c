/* device_choose.c: see device_choose.h. */
#include "device_choose.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool contains(const char *text, const char *part) {
    const size_t length = strlen(part);
    for (; *text != '\0'; ++text) {
        size_t i = 0;
        while (i < length && tolower((unsigned char)text[i]) == tolower((unsigned char)part[i])) ++i;
        if (i == length) return true;
    }
    return false;
}

static bool same(const char *a, const char *b) {
    return strlen(a) == strlen(b) && contains(a, b);
}

/* By what lists of devices show. */
static bool fits_shown(const BpDeviceInfo *device, const char *text) {
    return contains(device->name, text) || contains(device->platform, text) || contains(device->driver, text);
}

static bool fits_hidden(const BpDeviceInfo *device, const char *text) {
    return contains(device->vendor, text) || contains(device->version, text);
}

/* Vendor and version, which are not displayed, are searched only if no displayed text matches. */
static bool fits(const BpDeviceInfo *device, const char *text, bool shown) {
    return shown ? fits_shown(device, text) : fits_hidden(device, text);
}

static bool any_fits_shown(const BpDeviceInfo *list, size_t count, const char *text) {
    for (size_t i = 0; i < count; ++i)
        if (fits_shown(&list[i], text)) return true;
    return false;
}

/* Appends "; 0: name (platform)" for each device that matches `text` (all for NULL), as far as there is room.
 */
static void append_devices(char *to, size_t size, const BpDeviceInfo *list, size_t count, const char *text) {
    const char *separator = "";
    const bool shown = text == NULL || any_fits_shown(list, count, text);
    for (size_t i = 0; i < count; ++i) {
        if (text != NULL && !fits(&list[i], text, shown)) continue;
        const size_t used = strlen(to);
        snprintf(to + used, size - used, "%s%u: %s (%s, driver %s%s%s%s%s)%s%s", separator, list[i].number,
                 list[i].name, list[i].platform, list[i].driver, shown ? "" : ", vendor ",
                 shown ? "" : list[i].vendor, shown ? "" : ", version ", shown ? "" : list[i].version,
                 list[i].refusal[0] != '\0' ? ", cannot render: " : "", list[i].refusal);
        separator = "; ";
    }
}

/* The first device of `type` that can render, or NULL. */
static const BpDeviceInfo *first_of_type(const BpDeviceInfo *list, size_t count, BpDeviceType type) {
    for (size_t i = 0; i < count; ++i)
        if (list[i].type == type && list[i].refusal[0] == '\0') return &list[i];
    return NULL;
}

/* Above 0 if a > b, below 0 if a < b. */
static int order(uint64_t a, uint64_t b) {
    return (a > b) - (a < b);
}

/* Above 0: GPU `a` is more capable than `b`. The width of a compute unit depends on the vendor: units are
 * compared within a platform (`one_platform`), and between platforms only as a last resort. */
static int compare_gpus(const BpDeviceInfo *a, const BpDeviceInfo *b, bool one_platform) {
    const int own_memory = order(b->has_shared_memory, a->has_shared_memory);
    const int memory = order(a->memory_bytes, b->memory_bytes);
    const int work = order((uint64_t)a->compute_units * (a->clock_mhz > 0 ? a->clock_mhz : 1),
                           (uint64_t)b->compute_units * (b->clock_mhz > 0 ? b->clock_mhz : 1));
    if (own_memory != 0) return own_memory;
    const int first = one_platform ? work : memory;
    return first != 0 ? first : one_platform ? memory : work;
}

/* The most capable GPU that can render, or NULL; of equal ones the first. It is the best of the platforms'
 * best, so the order of devices matters only between equal ones. */
static const BpDeviceInfo *best_gpu(const BpDeviceInfo *list, size_t count) {
    const BpDeviceInfo *best = NULL;
    for (size_t i = 0; i < count; ++i) {
        const BpDeviceInfo *gpu = &list[i];
        bool leads = gpu->type == BP_DEVICE_GPU && gpu->refusal[0] == '\0';
        for (size_t j = 0; j < count && leads; ++j) {
            const BpDeviceInfo *other = &list[j];
            if (other->type != BP_DEVICE_GPU || other->refusal[0] != '\0' ||
                strcmp(other->platform, gpu->platform) != 0)
                continue;
            leads = compare_gpus(other, gpu, true) <= 0;
        }
        if (leads && (best == NULL || compare_gpus(gpu, best, false) > 0)) best = gpu;
    }
    return best;
}

static const BpDeviceInfo *default_device(const BpDeviceInfo *list, size_t count) {
    const BpDeviceInfo *device = best_gpu(list, count);
    if (device == NULL) device = first_of_type(list, count, BP_DEVICE_CPU);
    if (device == NULL) device = first_of_type(list, count, BP_DEVICE_OTHER);
    return device;
}

/* A text of one or two digits is a device's number and nothing else; "4090" may also be a part of a name. */
static bool is_number(const char *text) {
    const size_t digits = strspn(text, "0123456789");
    return digits > 0 && digits <= 2 && text[digits] == '\0';
}

/* The device whose number is `text`, or NULL if no device of the list has it. */
static const BpDeviceInfo *by_number(const BpDeviceInfo *list, size_t count, const char *text) {
    char *end;
    if (!isdigit((unsigned char)text[0])) return NULL;
    const unsigned long long number = strtoull(text, &end, 10);
    return *end == '\0' && number < count ? &list[number] : NULL;
}

/* The device that `text` matches among those that can render (or among all, if none can). NULL if none
 * matches, or (*ambiguous) if different ones do; of equal ones, the first. */
static const BpDeviceInfo *by_text(const BpDeviceInfo *list, size_t count, const char *text,
                                   bool *ambiguous) {
    const BpDeviceInfo *chosen = NULL;
    const bool shown = any_fits_shown(list, count, text);
    *ambiguous = false;
    for (size_t i = 0; i < count; ++i) {
        if (!fits(&list[i], text, shown)) continue;
        if (chosen == NULL || (chosen->refusal[0] != '\0' && list[i].refusal[0] == '\0')) {
            chosen = &list[i];
            *ambiguous = false;
        } else if (list[i].refusal[0] == '\0' || chosen->refusal[0] != '\0') {
            /* A name given in full means that device, even where it is a part of another's. */
            const bool chosen_whole = same(chosen->name, text), other_whole = same(list[i].name, text);
            if (other_whole && !chosen_whole) {
                chosen = &list[i];
                *ambiguous = false;
            } else if (!chosen_whole || other_whole) {
                if (!same(list[i].name, chosen->name) || !same(list[i].platform, chosen->platform) ||
                    !same(list[i].driver, chosen->driver))
                    *ambiguous = true;
            }
        }
    }
    return chosen;
}

BpStatus bp_device_choose(const BpDeviceInfo *list, size_t count, const char *text, BpDeviceInfo *device,
                          BpError *err) {
    const BpDeviceInfo *chosen = NULL;
    bool ambiguous = false;
    char there[800] = "";
    if (text == NULL) text = "";
    if (text[0] == '\0')
        chosen = default_device(list, count);
    else if ((chosen = by_number(list, count, text)) == NULL && !is_number(text)) {
        if (same(text, "gpu")) chosen = best_gpu(list, count);
        if (same(text, "cpu")) chosen = first_of_type(list, count, BP_DEVICE_CPU);
        if (chosen == NULL) chosen = by_text(list, count, text, &ambiguous);
    }
    append_devices(there, sizeof there, list, count, ambiguous ? text : NULL);
    if (chosen == NULL && text[0] == '\0')
        return bp_fail(err, BP_ERR_NO_DEVICE, "no OpenCL device can render (found %s): " BP_NO_DEVICE_REMEDY,
                       there);
    if (chosen == NULL)
        return bp_fail(err, BP_ERR_NO_DEVICE, "no device matches '%.200s'%s; available: %s", text,
                       strchr(text, ',') != NULL ? ", and only one can be named" : "", there);
    if (ambiguous)
        return bp_fail(err, BP_ERR_NO_DEVICE, "'%s' matches several devices; give a number: %s", text, there);
    if (chosen->refusal[0] != '\0')
        return bp_fail(err, BP_ERR_BROKEN_DEVICE, "device %u (%s) cannot render: %s", chosen->number,
                       chosen->name, chosen->refusal);
    *device = *chosen;
    return BP_OK;
}
