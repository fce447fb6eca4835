/* polygon.c: see polygon.h. */
#include "polygon.h"

#include "base/orient.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A corner of the polygon, in the plane, where the outline runs counter-clockwise. */
typedef struct PolygonCorner {
    double at[2];
    uint32_t vertex, previous, next;
    uint32_t blocker; /* its place in the list of blockers */
    int8_t turn;      /* the sign of the turn here: 1 is convex */
    bool is_queued, is_gone;
} Corner;

typedef struct PolygonBox {
    double low[2], high[2];
    uint32_t triangle[3]; /* corners */
} Box;

typedef struct Clip {
    PolygonCutter *cutter;
    const double (*positions)[3];
    Corner *corners;
    uint32_t left;                     /* corners that are not gone */
    uint32_t *blockers, blocker_count; /* corners with a turn of 0 or less: only these can lie in an ear */
    uint32_t *queue;                   /* a ring of corners that may be ears */
    size_t first, queued, size;
    uint64_t work, work_max;
} Clip;

void polygon_clear(PolygonCutter *cutter) {
    free(cutter->triangles);
    free(cutter->corners);
    free(cutter->queue);
    free(cutter->blockers);
    free(cutter->boxes);
    *cutter = (PolygonCutter){0};
}

static bool make_room(PolygonCutter *cutter, size_t count) {
    if (count <= cutter->capacity) return true;
    size_t capacity = 2 * cutter->capacity > 64 ? 2 * cutter->capacity : 64;
    if (capacity < count) capacity = count;
    polygon_clear(cutter);
    cutter->triangles = calloc(capacity, sizeof *cutter->triangles);
    cutter->corners = calloc(capacity, sizeof *cutter->corners);
    cutter->queue = calloc(capacity, sizeof *cutter->queue);
    cutter->blockers = calloc(capacity, sizeof *cutter->blockers);
    cutter->boxes = calloc(capacity, sizeof *cutter->boxes);
    if (cutter->triangles == NULL || cutter->corners == NULL || cutter->queue == NULL ||
        cutter->blockers == NULL || cutter->boxes == NULL)
        return false;
    cutter->capacity = capacity;
    return true;
}

bool polygon_is_flat(const double a[3], const double b[3], const double c[3]) {
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const double p[2] = {a[i], a[j]}, q[2] = {b[i], b[j]}, r[2] = {c[i], c[j]};
        if (orient(p, q, r) != 0) return false;
    }
    return true;
}

static void put(PolygonCutter *cutter, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *const triangle = cutter->triangles[cutter->triangle_count++];
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

void polygon_fan(PolygonCutter *cutter, const double (*positions)[3], const uint32_t *vertices,
                 size_t count) {
    const uint32_t a = vertices[0];
    cutter->triangle_count = 0;
    for (size_t n = 1; n + 1 < count; n++) {
        const uint32_t b = vertices[n], c = vertices[n + 1];
        if (!polygon_is_flat(positions[a], positions[b], positions[c])) put(cutter, a, b, c);
    }
}

/* ---- the plane ---------------------------------------------------------------------------------------- */

/* The polygon's normal, twice its area long (Newell's sums, about the first corner), and a bound of its
 * rounding error. */
static double find_normal(const double (*positions)[3], const uint32_t *vertices, size_t count,
                          double normal[3]) {
    const double *const origin = positions[vertices[0]];
    double magnitude = 0;
    normal[0] = normal[1] = normal[2] = 0;
    for (size_t n = 1; n + 1 < count; n++) {
        const double *const p = positions[vertices[n]], *const q = positions[vertices[n + 1]];
        for (int a = 0; a < 3; a++) {
            const int b = (a + 1) % 3, c = (a + 2) % 3;
            const double one = (p[b] - origin[b]) * (q[c] - origin[c]);
            const double other = (p[c] - origin[c]) * (q[b] - origin[b]);
            normal[a] += one - other;
            magnitude += fabs(one) + fabs(other);
        }
    }
    return magnitude * DBL_EPSILON * (double)(count + 4);
}

static bool is_on_one_line(const double (*positions)[3], const uint32_t *vertices, size_t count) {
    const double *const first = positions[vertices[0]], *other = NULL;
    for (size_t n = 1; n < count; n++) {
        const double *const p = positions[vertices[n]];
        if (other == NULL && (p[0] != first[0] || p[1] != first[1] || p[2] != first[2])) other = p;
        if (other != NULL && !polygon_is_flat(first, other, p)) return false;
    }
    return true;
}

/* The axes, that of the normal's largest part first. */
static void order_axes(const double normal[3], int axes[3]) {
    for (int a = 0; a < 3; a++) {
        int rank = 0;
        for (int b = 0; b < 3; b++)
            rank += fabs(normal[b]) > fabs(normal[a]) || (b < a && fabs(normal[b]) == fabs(normal[a]));
        axes[rank] = a;
    }
}

/* Lays the corners into the plane of the other two axes. `turned`: seen from the side of lower coordinates.
 */
static void lay(Corner *corners, const double (*positions)[3], const uint32_t *vertices, size_t count,
                int axis, bool turned) {
    const int u = (axis + (turned ? 2 : 1)) % 3, v = (axis + (turned ? 1 : 2)) % 3;
    for (size_t n = 0; n < count; n++) {
        const double *const p = positions[vertices[n]];
        corners[n] = (Corner){.at = {p[u], p[v]},
                              .vertex = vertices[n],
                              .previous = (uint32_t)(n > 0 ? n - 1 : count - 1),
                              .next = (uint32_t)(n + 1 < count ? n + 1 : 0)};
    }
}

/* ---- convex polygons ---------------------------------------------------------------------------------- */

static bool is_below(const double a[2], const double b[2]) {
    return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
}

/* Whether the outline turns left at every corner, and goes around once: it then rises and falls once. */
static bool is_convex(const Corner *corners, size_t count) {
    size_t changes = 0;
    for (size_t n = 0; n < count; n++) {
        const double *const a = corners[corners[n].previous].at, *const b = corners[n].at;
        const double *const c = corners[corners[n].next].at;
        if (orient(a, b, c) <= 0) return false;
        changes += is_below(a, b) != is_below(b, c);
    }
    return changes == 2;
}

/* ---- ear clipping ------------------------------------------------------------------------------------- */

static bool is_same_place(const double a[2], const double b[2]) {
    return a[0] == b[0] && a[1] == b[1];
}

static int turn_at(const Corner *corners, const Corner *corner) {
    return orient(corners[corner->previous].at, corner->at, corners[corner->next].at);
}

/* Sets the turn at a corner, and lists it among the blockers or takes it from them. */
static void set_turn(Clip *clip, uint32_t n) {
    Corner *const corner = &clip->corners[n];
    const bool was_blocker = corner->turn <= 0;
    corner->turn = (int8_t)turn_at(clip->corners, corner);
    const bool is_blocker = corner->turn <= 0;
    if (is_blocker && !was_blocker) {
        corner->blocker = clip->blocker_count;
        clip->blockers[clip->blocker_count++] = n;
    } else if (was_blocker && !is_blocker) {
        const uint32_t last = clip->blockers[--clip->blocker_count];
        clip->blockers[corner->blocker] = last;
        clip->corners[last].blocker = corner->blocker;
    }
}

static void push(Clip *clip, uint32_t n) {
    if (clip->corners[n].is_queued) return;
    clip->corners[n].is_queued = true;
    clip->queue[(clip->first + clip->queued++) % clip->size] = n;
}

/* Whether an edge from a corner at the place of b runs into the ear a, b, c. */
static bool enters(const Clip *clip, const Corner *other, const double *a, const double *b, const double *c) {
    const double *const ends[2] = {clip->corners[other->previous].at, clip->corners[other->next].at};
    for (int i = 0; i < 2; i++)
        if (orient(a, b, ends[i]) > 0 && orient(b, c, ends[i]) > 0) return true;
    return false;
}

static bool is_ear(Clip *clip, uint32_t n) {
    const Corner *const corner = &clip->corners[n];
    if (corner->turn <= 0) return false;
    const double *const a = clip->corners[corner->previous].at, *const b = corner->at;
    const double *const c = clip->corners[corner->next].at;
    const double low[2] = {fmin(a[0], fmin(b[0], c[0])), fmin(a[1], fmin(b[1], c[1]))};
    const double high[2] = {fmax(a[0], fmax(b[0], c[0])), fmax(a[1], fmax(b[1], c[1]))};
    for (uint32_t i = 0; i < clip->blocker_count; i++) {
        const uint32_t m = clip->blockers[i];
        const Corner *const other = &clip->corners[m];
        const double *const p = other->at;
        clip->work++;
        if (p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1]) continue;
        if (m == corner->previous || m == corner->next) continue;
        /* Where the outline touches itself, corners at one place do not hide each other. */
        if (is_same_place(p, a) || is_same_place(p, c)) continue;
        if (is_same_place(p, b)) {
            if (enters(clip, other, a, b, c)) return false;
            continue;
        }
        if (orient(a, b, p) >= 0 && orient(b, c, p) >= 0 && orient(c, a, p) >= 0) return false;
    }
    return true;
}

static void unlink_corner(Clip *clip, uint32_t n) {
    Corner *const corner = &clip->corners[n];
    if (corner->turn <= 0) { /* one without area */
        const uint32_t last = clip->blockers[--clip->blocker_count];
        clip->blockers[corner->blocker] = last;
        clip->corners[last].blocker = corner->blocker;
    }
    corner->is_gone = true;
    clip->corners[corner->previous].next = corner->next;
    clip->corners[corner->next].previous = corner->previous;
    clip->left--;
    set_turn(clip, corner->previous);
    set_turn(clip, corner->next);
    push(clip, corner->previous);
    push(clip, corner->next);
}

/* Whether the outline turns back on itself at a corner, or stands still. */
static bool is_spike(const Clip *clip, uint32_t n) {
    const Corner *const corner = &clip->corners[n];
    const double *const a = clip->corners[corner->previous].at, *const c = clip->corners[corner->next].at;
    if (corner->turn != 0) return false;
    return is_same_place(a, corner->at) || is_same_place(c, corner->at) ||
           is_below(a, corner->at) == is_below(c, corner->at);
}

/* Puts the triangle at a corner if it has an area in space, though it may have none as it is laid out. */
static void put_unless_flat(Clip *clip, uint32_t n) {
    const Corner *const corners = clip->corners;
    const uint32_t previous = corners[n].previous, next = corners[n].next;
    if (!polygon_is_flat(clip->positions[corners[previous].vertex], clip->positions[corners[n].vertex],
                         clip->positions[corners[next].vertex]))
        put(clip->cutter, previous, n, next);
}

/* Cuts off the spikes at a corner and at what becomes of it: they cover nothing of the plane, and what they
 * leave is looked at again. */
static void cut_spikes(Clip *clip, uint32_t n) {
    while (clip->left > 3 && is_spike(clip, n)) {
        const uint32_t previous = clip->corners[n].previous, next = clip->corners[n].next;
        put_unless_flat(clip, n);
        unlink_corner(clip, n);
        n = is_spike(clip, previous) ? previous : next;
    }
}

/* The next corner of the queue that is an ear; UINT32_MAX: none. */
static uint32_t take_ear(Clip *clip) {
    while (clip->queued > 0) {
        const uint32_t n = clip->queue[clip->first];
        clip->first = (clip->first + 1) % clip->size;
        clip->queued--;
        clip->corners[n].is_queued = false;
        if (!clip->corners[n].is_gone && is_ear(clip, n)) return n;
        if (clip->work > clip->work_max) break;
    }
    return UINT32_MAX;
}

/* Asks all corners that are left again whether they are ears. */
static void push_all(Clip *clip, size_t count) {
    for (uint32_t n = 0; n < count; n++)
        if (!clip->corners[n].is_gone) push(clip, n);
}

/* Cuts ears off until a triangle is left. False: there is a place where none can be cut. The corners of a
 * triangle stand in the cutter as numbers of corners. */
static bool clip_ears(Clip *clip, size_t count) {
    const Corner *const corners = clip->corners;
    bool is_second = false; /* no ear was found since all corners were asked */
    for (uint32_t n = 0; n < count; n++) {
        clip->corners[n].turn = 1;
        set_turn(clip, n);
    }
    for (uint32_t n = 0; n < count; n++)
        if (!corners[n].is_gone) cut_spikes(clip, n);
    push_all(clip, count);
    while (clip->left > 3) {
        const uint32_t n = take_ear(clip);
        if (clip->work > clip->work_max || (n == UINT32_MAX && is_second)) return false;
        is_second = n == UINT32_MAX;
        if (is_second) {
            push_all(clip, count);
            continue;
        }
        const uint32_t previous = corners[n].previous, next = corners[n].next;
        put(clip->cutter, previous, n, next);
        unlink_corner(clip, n);
        cut_spikes(clip, previous);
        if (!corners[next].is_gone) cut_spikes(clip, next);
    }
    uint32_t n = 0;
    while (corners[n].is_gone) n++;
    if (corners[n].turn >= 0) put_unless_flat(clip, n);
    return corners[n].turn >= 0;
}

/* ---- whether the triangles cover the polygon once ----------------------------------------------------- */

static int by_low(const void *one, const void *other) {
    const double a = ((const Box *)one)->low[0], b = ((const Box *)other)->low[0];
    return (a > b) - (a < b);
}

/* Whether the second triangle lies beyond an edge of the first. */
static bool is_beyond(const Corner *corners, const uint32_t one[3], const uint32_t other[3]) {
    for (int e = 0; e < 3; e++) {
        const double *const a = corners[one[e]].at, *const b = corners[one[(e + 1) % 3]].at;
        int outside = 0;
        while (outside < 3 && orient(a, b, corners[other[outside]].at) <= 0) outside++;
        if (outside == 3) return true;
    }
    return false;
}

/* All triangles that have an area here turn to the left, so they cover each point as often as the outline
 * goes around it. They overlap exactly where it does so twice. */
static bool is_covered_once(const PolygonCutter *cutter) {
    const Corner *const corners = cutter->corners;
    Box *const boxes = cutter->boxes;
    size_t count = 0;
    for (size_t t = 0; t < cutter->triangle_count; t++) {
        const uint32_t *const triangle = cutter->triangles[t];
        const double *const a = corners[triangle[0]].at, *const b = corners[triangle[1]].at;
        const double *const c = corners[triangle[2]].at;
        if (orient(a, b, c) == 0) continue;
        Box *const box = &boxes[count++];
        memcpy(box->triangle, triangle, sizeof box->triangle);
        for (int i = 0; i < 2; i++) {
            box->low[i] = fmin(a[i], fmin(b[i], c[i]));
            box->high[i] = fmax(a[i], fmax(b[i], c[i]));
        }
    }
    if (count == 0) return false;
    qsort(boxes, count, sizeof *boxes, by_low);
    for (size_t s = 0; s < count; s++) {
        for (size_t t = s + 1; t < count && boxes[t].low[0] < boxes[s].high[0]; t++) {
            if (boxes[t].low[1] >= boxes[s].high[1] || boxes[s].low[1] >= boxes[t].high[1]) continue;
            if (!is_beyond(corners, boxes[s].triangle, boxes[t].triangle) &&
                !is_beyond(corners, boxes[t].triangle, boxes[s].triangle))
                return false;
        }
    }
    return true;
}

/* ---- the whole ---------------------------------------------------------------------------------------- */

/* Cuts the polygon as it is laid out; false: it cannot be done. */
static bool cut_laid(PolygonCutter *cutter, const double (*positions)[3], size_t count) {
    const Corner *const corners = cutter->corners;
    Clip clip = {.cutter = cutter,
                 .positions = positions,
                 .corners = cutter->corners,
                 .left = (uint32_t)count,
                 .blockers = cutter->blockers,
                 .queue = cutter->queue,
                 .size = count,
                 .work_max = 16 * (uint64_t)count * count};
    cutter->triangle_count = 0;
    if (!clip_ears(&clip, count) || !is_covered_once(cutter)) return false;
    for (size_t t = 0; t < cutter->triangle_count; t++)
        for (int i = 0; i < 3; i++) cutter->triangles[t][i] = corners[cutter->triangles[t][i]].vertex;
    return true;
}

PolygonResult polygon_cut(PolygonCutter *cutter, const double (*positions)[3], const uint32_t *vertices,
                          size_t count) {
    double normal[3];
    cutter->triangle_count = 0;
    if (count < 3) return POLYGON_CUT;
    if (!make_room(cutter, count)) return POLYGON_NO_MEMORY;
    if (count == 3) {
        const uint32_t a = vertices[0], b = vertices[1], c = vertices[2];
        if (!polygon_is_flat(positions[a], positions[b], positions[c])) put(cutter, a, b, c);
        return POLYGON_CUT;
    }
    const double error = find_normal(positions, vertices, count, normal);
    int axes[3];
    order_axes(normal, axes);
    lay(cutter->corners, positions, vertices, count, axes[0], normal[axes[0]] < 0);
    if (is_convex(cutter->corners, count)) {
        for (size_t n = 1; n + 1 < count; n++) put(cutter, vertices[0], vertices[n], vertices[n + 1]);
        return POLYGON_CUT;
    }
    if (count > POLYGON_CORNERS_MAX) return POLYGON_TOO_LARGE;
    /* Corners that do not lie in one plane may cross in one view and not in another. */
    for (int i = 0; i < 3 && fabs(normal[axes[i]]) > error; i++) {
        lay(cutter->corners, positions, vertices, count, axes[i], normal[axes[i]] < 0);
        if (cut_laid(cutter, positions, count)) return POLYGON_CUT;
    }
    if (fabs(normal[axes[0]]) > error) return POLYGON_CROSSES;
    /* Its normal is lost in rounding: it has no area, or nearly none. */
    if (is_on_one_line(positions, vertices, count)) return POLYGON_CUT;
    for (int i = 0; i < 6; i++) {
        lay(cutter->corners, positions, vertices, count, i / 2, i % 2 == 1);
        if (cut_laid(cutter, positions, count)) return POLYGON_CUT;
    }
    return POLYGON_CROSSES;
}
