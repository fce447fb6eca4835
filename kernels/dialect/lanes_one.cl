/* lanes_one.cl: from here on, lane code means one lane. lanes.cl, which follows, gives its words their meaning. */
#undef LANE_COUNT
#undef LANED
#define LANE_COUNT 1
#define LANED(name) JOIN(name, _one)
