/* pilot_types.h: what pilot.cl is told of a path and what it tells, read by both compilers.
 *
 * Knows: nothing.   Does not know: what the paths are for. */
#ifndef BP_PILOT_TYPES_H
#define BP_PILOT_TYPES_H

/* Of a segment: PILOT_REALS reals. */
enum {
    PILOT_POINT,                       /* where it ends, relative to the camera */
    PILOT_DIRECTION = PILOT_POINT + 3, /* unit */
    PILOT_DISTANCE = PILOT_DIRECTION + 3,
    PILOT_THROUGHPUT,                  /* of the path, behind the vertex at its end, times the odds */
    PILOT_ODDS = PILOT_THROUGHPUT + 3, /* how much more often a picture's path would have come this way */
    PILOT_TIME,                        /* of the path: 0 where the shutter opens, 1 where it closes */
    PILOT_REALS
};
/* And PILOT_UINTS whole numbers. PILOT_SHAPE: what it met, as the scene counts shapes, or NO_SPHERE. */
enum { PILOT_SHAPE, PILOT_FLAGS, PILOT_UINTS };
/* PILOT_LIT: the vertex is one that a ray to a lamp can light. */
enum {
    PILOT_TRACED = 1, /* there is such a segment */
    PILOT_MET = 2,
    PILOT_GOES_ON = 4,
    PILOT_LIT = 8,
    PILOT_IN_MEDIUM = 16
};
/* Of a path that does not start at the camera: its origin as two parts, and its direction. */
enum { PILOT_START_REALS = 9 };

#endif
