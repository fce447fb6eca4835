/* environment_table.c: see environment_table.h. */
#include "environment_table.h"

#include "base/color.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846
#define WHOLE (1u << SHARE_BITS)

/* With less, a lobe's own directions find the light as well. */
#define SPREAD_MIN 1.0

bool bp_environment_varies(const BpImage *image) {
    return image->spread > SPREAD_MIN;
}

/* The luminance of texel (column, row) and of its neighbours above and below, which share its square. */
static double column_light(const BpImage *image, size_t column, size_t row) {
    const size_t above = row > 0 ? row - 1 : 0, below = row + 1 < image->height ? row + 1 : row;
    const float *const texels = image->texels + 3 * column;
    const size_t stride = (size_t)3 * image->width;
    return (6 * bp_luminance(texels + row * stride) + bp_luminance(texels + above * stride) +
            bp_luminance(texels + below * stride)) /
           8;
}

/* The mean of the bilinear luminance over the square of each texel of a row: of the hats that meet there 3/4
 * are its own, 1/8 each neighbour's. Returns the sum. */
static double row_light(const BpImage *image, size_t row, double *light) {
    const size_t width = image->width;
    const double first = column_light(image, 0, row);
    double sum = 0, before = column_light(image, width - 1, row), here = first;
    for (size_t i = 0; i < width; i++) {
        const double after = i + 1 < width ? column_light(image, i + 1, row) : first;
        light[i] = (6 * here + before + after) / 8;
        sum += light[i];
        before = here;
        here = after;
    }
    return sum;
}

/* Lower bounds of shares in units of 1 / WHOLE, and WHOLE at their end. */
static void write_bounds(const double *light, size_t count, double sum, uint32_t *bounds) {
    double below = 0;
    for (size_t i = 0; i < count; i++) {
        const double bound = sum > 0 ? floor(below / sum * WHOLE + 0.5) : 0;
        bounds[i] = bound < WHOLE ? (uint32_t)bound : WHOLE;
        below += light[i];
    }
    bounds[count] = WHOLE;
}

BpStatus bp_environment_table_build(const BpImage *image, BpEnvironmentTable *table, BpError *err) {
    const size_t width = image->width, height = image->height;
    *table = (BpEnvironmentTable){
        .row_count = height + 1, .column_count = (width + 1) * height, .height_count = (height + 1) / 2 + 1};
    double *light = malloc(width * sizeof *light), *rows = malloc(height * sizeof *rows), sum = 0;
    table->rows = malloc(table->row_count * sizeof *table->rows);
    table->columns = malloc(table->column_count * sizeof *table->columns);
    table->heights = malloc(table->height_count * sizeof *table->heights);
    BpStatus status = BP_OK;
    if (light == NULL || rows == NULL || table->rows == NULL || table->columns == NULL ||
        table->heights == NULL) {
        status = bp_fail(err, BP_ERR_MEMORY, "out of memory for a table of %zu by %zu texels", width, height);
        goto done;
    }
    for (size_t i = 0; i < table->height_count; i++) {
        const double sine = sin(PI * (double)i / (2 * (double)height));
        table->heights[i] = sine * sine;
    }
    for (size_t row = 0; row < height; row++) {
        const double light_sum = row_light(image, row, light);
        write_bounds(light, width, light_sum, table->columns + row * (width + 1));
        rows[row] = light_sum * sin(PI * ((double)row + 0.5) / (double)height); /* as large as its ring */
        sum += rows[row];
    }
    write_bounds(rows, height, sum, table->rows);
done:
    free(light);
    free(rows);
    if (status != BP_OK) bp_environment_table_clear(table);
    return status;
}

void bp_environment_table_clear(BpEnvironmentTable *table) {
    free(table->rows);
    free(table->columns);
    free(table->heights);
    *table = (BpEnvironmentTable){0};
}
