/* places.c: see places.h. */
#include "places.h"

#include "base/hash.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FIRST_CAPACITY = 4096 };

/* A particle of a site that has alternative places. */
typedef struct Place {
    uint64_t site, name;
    uint32_t letter, atom; /* letter 0: none */
    uint16_t residue;
} Place;

/* Different texts get different numbers, as far as 64 bits allow. */
static uint64_t number_of(const char *text) {
    return bp_hash_text(BP_HASH_START, text);
}

static uint32_t letter_of(const char *text) {
    uint32_t letter = 0;
    for (int i = 0; i < 4 && text[i] != '\0'; i++) letter = letter << 8 | (unsigned char)text[i];
    return letter;
}

/* The number of an atom's name; deuterium has that of the hydrogen in whose place it stands. */
static uint64_t number_of_name(const BpParticles *p, size_t atom) {
    const char *const text = p->names.count > 0 ? p->names.text[p->tag[atom].name] : "";
    char name[16];
    const size_t digits = strspn(text, "0123456789");
    if (p->tag[atom].element != 1 || (text[digits] | 32) != 'd' || strlen(text) >= sizeof name)
        return number_of(text);
    snprintf(name, sizeof name, "%s", text);
    name[digits] = (char)(text[digits] - 'd' + 'h');
    return number_of(name);
}

static bool grow(Places *places) {
    const size_t capacity = places->capacity > 0 ? 2 * places->capacity : FIRST_CAPACITY;
    uint64_t *const sites = realloc(places->site, capacity * sizeof *sites);
    if (sites != NULL) places->site = sites;
    uint32_t *const letters = realloc(places->letter, capacity * sizeof *letters);
    if (letters != NULL) places->letter = letters;
    if (sites == NULL || letters == NULL) return false;
    places->capacity = capacity;
    return true;
}

/* The site of the last particle, whose residue has no number: that of the particle before, unless this is
 * again its first atom, and at no other of its places. */
static uint64_t unnumbered_site(Places *places, const BpParticles *p, uint64_t site, uint32_t letter) {
    const BpParticleTag *const tag = &p->tag[p->count - 1];
    const uint64_t bit = letter == 0 ? UINT64_MAX : (uint64_t)1 << letter % 61;
    const bool goes_on = places->unnumbered.number > 0 && places->unnumbered.site == site &&
                         places->unnumbered.residue == tag->residue;
    const bool is_first = tag->name == places->unnumbered.name;
    if (!goes_on || (is_first && (places->unnumbered.letters & bit) != 0)) {
        places->unnumbered.number++;
        places->unnumbered.site = site;
        places->unnumbered.letters = bit;
        places->unnumbered.name = tag->name;
        places->unnumbered.residue = tag->residue;
    } else if (is_first) {
        places->unnumbered.letters |= bit;
    }
    return bp_hash_bytes(site, &places->unnumbered.number, sizeof places->unnumbered.number);
}

BpStatus places_take(Places *places, const BpParticles *particles, const char *site, bool numbered,
                     const char *letter, BpError *err) {
    if (places->count >= particles->count) return BP_OK;
    if (places->count == places->capacity && !grow(places))
        return bp_fail(err, BP_ERR_MEMORY, "out of memory for the places of %zu atoms", places->count);
    const uint64_t number = number_of(site);
    const uint32_t own = letter_of(letter);
    places->site[places->count] = numbered ? number : unnumbered_site(places, particles, number, own);
    places->letter[places->count++] = own;
    places->any |= letter[0] != '\0';
    return BP_OK;
}

static int compare_numbers(const void *a, const void *b) {
    const uint64_t one = *(const uint64_t *)a, other = *(const uint64_t *)b;
    return one < other ? -1 : one > other;
}

/* By sites, in them by residues and names, and then as in the file. */
static int compare_places(const void *a, const void *b) {
    const Place *const one = a, *const other = b;
    if (one->site != other->site) return one->site < other->site ? -1 : 1;
    if (one->residue != other->residue) return one->residue < other->residue ? -1 : 1;
    if (one->name != other->name) return one->name < other->name ? -1 : 1;
    return one->atom < other->atom ? -1 : one->atom > other->atom;
}

static int compare_letters(const void *a, const void *b) {
    const Place *const one = a, *const other = b;
    if (one->letter != other->letter) return one->letter < other->letter ? -1 : 1;
    return one->residue < other->residue ? -1 : one->residue > other->residue;
}

/* All particles of the sites in which some have letters. NULL: out of memory. */
static Place *list_places(const Places *places, const BpParticles *p, size_t *count) {
    uint64_t *const sites = malloc((places->count + 1) * sizeof *sites);
    size_t lettered = 0;
    for (size_t i = 0; sites != NULL && i < places->count; i++)
        if (places->letter[i] != 0) sites[lettered++] = places->site[i];
    if (sites != NULL) qsort(sites, lettered, sizeof *sites, compare_numbers);
    Place *const list = malloc((places->count + 1) * sizeof *list);
    *count = 0;
    for (size_t i = 0; sites != NULL && list != NULL && i < places->count; i++)
        if (bsearch(&places->site[i], sites, lettered, sizeof *sites, compare_numbers) != NULL)
            list[(*count)++] = (Place){places->site[i], number_of_name(p, i), places->letter[i], (uint32_t)i,
                                       p->tag[i].residue};
    free(sites);
    if (sites == NULL) {
        free(list);
        return NULL;
    }
    return list;
}

/* The letter that the places before `end` are shown with. */
static const Place *choose(const Place *begin, const Place *end) {
    const Place *first = NULL;
    for (const Place *place = begin; place < end; place++) {
        if (place->letter == 0) continue;
        if (place->letter == 'A') return place;
        if (first == NULL || place->atom < first->atom) first = place;
    }
    return first;
}

/* Whether several residues of different names share a site, each with letters of its own. Changes the order.
 */
static bool is_mixed(Place *begin, Place *end) {
    bool several = false;
    qsort(begin, (size_t)(end - begin), sizeof *begin, compare_letters);
    while (begin < end && begin->letter == 0) begin++;
    for (const Place *place = begin + 1; place < end; place++) {
        const bool other = place->residue != place[-1].residue;
        if (other && place->letter == place[-1].letter) return false;
        several |= other;
    }
    return several;
}

static const Place *end_of_residue(const Place *begin, const Place *end) {
    const Place *place = begin;
    while (place < end && place->residue == begin->residue) place++;
    return place;
}

static const Place *end_of_name(const Place *begin, const Place *end) {
    const Place *place = begin;
    while (place < end && place->name == begin->name) place++;
    return place;
}

/* Hides all places but those of one letter; without letters nothing is hidden. */
static void hide_but(BpParticles *p, const Place *begin, const Place *end, uint32_t letter) {
    for (const Place *place = begin; place < end; place++)
        if (place->letter != 0 && place->letter != letter)
            p->tag[place->atom].flags |= BP_PARTICLE_ALTERNATIVE;
}

/* The places of one atom: one without a letter, or the residue's letter, or the first. */
static uint32_t letter_of_atom(const Place *begin, const Place *end, uint32_t wanted) {
    uint32_t letter = begin->letter;
    for (const Place *place = begin; place < end; place++) {
        if (place->letter == 0) return 0;
        if (place->letter == wanted) letter = wanted;
    }
    return letter;
}

static void mark_residue(BpParticles *p, const Place *begin, const Place *end) {
    const Place *const chosen = choose(begin, end);
    while (begin < end && chosen != NULL) {
        const Place *const after = end_of_name(begin, end);
        hide_but(p, begin, after, letter_of_atom(begin, after, chosen->letter));
        begin = after;
    }
}

static void mark_site(BpParticles *p, Place *begin, Place *end) {
    const uint16_t residue = choose(begin, end)->residue;
    const bool mixed = is_mixed(begin, end);
    qsort(begin, (size_t)(end - begin), sizeof *begin, compare_places);
    for (const Place *place = begin; place < end;) {
        const Place *const after = end_of_residue(place, end);
        if (mixed && place->residue != residue)
            hide_but(p, place, after, 0);
        else
            mark_residue(p, place, after);
        place = after;
    }
}

BpStatus places_mark(Places *places, BpParticles *particles, BpError *err) {
    const size_t taken = places->count;
    const bool any = places->any;
    size_t count = 0;
    places->any = false;
    if (!any) {
        places->count = 0;
        return BP_OK;
    }
    Place *const list = list_places(places, particles, &count);
    places->count = 0;
    if (list == NULL) return bp_fail(err, BP_ERR_MEMORY, "out of memory for the places of %zu atoms", taken);
    qsort(list, count, sizeof *list, compare_places);
    for (size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && list[end].site == list[begin].site) end++;
        mark_site(particles, &list[begin], &list[end]);
    }
    free(list);
    return BP_OK;
}

void places_clear(Places *places) {
    free(places->site);
    free(places->letter);
    *places = (Places){0};
}
