/* lane_by_lane.cl: the same numbers for all lanes together, and for code that takes the lanes one by one.
 *
 * Knows: lanes.cl.   Does not know: what the numbers mean. Read once for each number of lanes.
 *
 * A member is stored and loaded as one vector, where a driver's own vstore and vload may take it in pieces. */
#define LaneReals LANED(LaneReals)
#define LaneUints LANED(LaneUints)
#define LaneRefineds LANED(LaneRefineds)

typedef union LaneReals {
    vreal all;
    real of[LANE_COUNT];
} LaneReals;

typedef union LaneUints {
    vuint all;
    uint of[LANE_COUNT];
} LaneUints;

typedef union LaneRefineds {
    vrefined all;
    refined of[LANE_COUNT];
} LaneRefineds;
