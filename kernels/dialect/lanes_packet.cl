/* lanes_packet.cl: from here on, lane code means the PACKET_LANES paths of a work-item. lanes.cl, which follows, gives
 * its words their meaning. */
#undef LANE_COUNT
#undef LANED
#define LANE_COUNT PACKET_LANES
#define LANED(name) JOIN(name, _packet)
