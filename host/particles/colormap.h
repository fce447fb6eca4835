/* colormap.h: colours for numbers.
 *
 * Knows: published colormaps.   Does not know: what the numbers mean. */
#ifndef BP_PARTICLES_COLORMAP_H
#define BP_PARTICLES_COLORMAP_H

typedef enum BpColormap {
    BP_MAP_VIRIDIS,
    BP_MAP_PLASMA,
    BP_MAP_CIVIDIS,
    BP_MAP_COOLWARM,
    BP_MAP_COUNT
} BpColormap;

/* Names by the enumeration's value. */
extern const char *const bp_colormap_names[BP_MAP_COUNT];

/* The linear colour at `share`, which is taken as 0 below 0 and for NaN, and as 1 above 1. */
void bp_colormap_color(BpColormap map, double share, double color[3]);

#endif
