/* environment_table.h: the tables from which the kernel chooses texels of an image around the scene.
 *
 * In:    an image.   Out: for each row, and for each texel of each row, its share of the light.
 * Knows: kernels/scene_types.h.   Does not know: which other lights there are, how directions are drawn. */
#ifndef BP_PACKED_ENVIRONMENT_TABLE_H
#define BP_PACKED_ENVIRONMENT_TABLE_H

#include "image/texels.h"

#ifndef BP_HOST
#define BP_HOST
#endif
#include "scene_types.h"

typedef struct BpEnvironmentTable {
    uint32_t *rows;    /* height + 1 */
    uint32_t *columns; /* width + 1 for each row */
    double *heights;   /* (height + 1) / 2 + 1 */
    size_t row_count, column_count, height_count;
} BpEnvironmentTable;

/* Whether its light varies so much that rays to where it is bright take more noise away than they cost. */
bool bp_environment_varies(const BpImage *image);

/* BP_ERR_MEMORY. On failure `table` is empty. */
BpStatus bp_environment_table_build(const BpImage *image, BpEnvironmentTable *table, BpError *err);
void bp_environment_table_clear(BpEnvironmentTable *table);

#endif
