/* pixels.cl: the pixels of a chunk, one after the other, in lane code.
 *
 * A chunk is a range of pixels, or of places in a list of pixels for adaptive sampling, times a range of samples. The
 * kernels trace_sample.cl, trace_pool.cl and trace_packet.cl write for each pixel sample of it the radiance, and in a fourth number
 * the ray segments traced, plus 1/2 for a path that the depth cap cut, plus MISSED_MARK where the camera ray met
 * nothing. What is computed for a pixel sample depends on neither of them. If the scene has lamps, each work-item also
 * writes how many rays it sent to them, in all.
 *
 * Pixels are counted along, since division is slow, in lanes above all.
 * Knows: lanes.cl.   Does not know: what is traced. */
#if PIXEL_LIST
#define PIXEL_LIST_PARAMETER , __global const uint *pixel_list
#define PIXEL_LIST_ARGUMENT , pixel_list
#else
#define PIXEL_LIST_PARAMETER
#define PIXEL_LIST_ARGUMENT
#endif

/* A pixel of the chunk. */
typedef struct Pixel {
    uint row, column;
#if PIXEL_LIST
    __global const uint *list;
    uint place, last_place;
#endif
} Pixel;

/* The same for all lanes. */
typedef struct Pixels {
    vuint row, column;
} Pixels;

static void set_pixel(Pixel *pixel, uint number, uint width) {
    pixel->row = number / width;
    pixel->column = number % width;
}

/* Pixel `ahead` of a chunk of `pixel_count` that begins at `first`. */
static Pixel pixel_of_chunk(uint first, uint ahead, uint pixel_count, uint width PIXEL_LIST_PARAMETER) {
    Pixel pixel;
#if PIXEL_LIST
    pixel.list = pixel_list;
    pixel.place = first + ahead;
    pixel.last_place = first + pixel_count - 1;
    set_pixel(&pixel, pixel_list[pixel.place], width);
#else
    set_pixel(&pixel, first + ahead, width);
#endif
    return pixel;
}

/* Goes on to the next pixel; beyond the last one it may stay. */
static void next_pixel(Pixel *pixel, uint width) {
#if PIXEL_LIST
    pixel->place = min(pixel->place + 1u, pixel->last_place);
    set_pixel(pixel, pixel->list[pixel->place], width);
#else
    ++pixel->column;
    if (pixel->column < width) return;
    pixel->column = 0;
    ++pixel->row;
#endif
}

/* Brings `digit` below `base` and adds to `carry` how often that took: mostly not once, so no division. */
static void carry_over(vuint *digit, uint base, vuint *carry) {
    for (;;) {
        const vbool beyond = vbool_of_uint(*digit >= splat_uint(base));
        if (!any_lane(beyond)) return;
        *digit = choose_uint(beyond, *digit - base, *digit);
        *carry = choose_uint(beyond, *carry + 1u, *carry);
    }
}

/* The pixels `ahead` of this one, of which the chunk need not have all. */
static Pixels pixels_ahead(const Pixel *pixel, vuint ahead, uint width) {
    Pixels pixels;
    pixels.row = splat_uint(pixel->row);
#if PIXEL_LIST
    pixels.column = splat_uint(pixel->column);
    if (any_lane(vbool_of_uint(ahead > splat_uint(0)))) {
        const vuint place = pixel->place + ahead;
        const vuint last = splat_uint(pixel->last_place);
        const vuint number = gather_uint(pixel->list, choose_uint(vbool_of_uint(place < last), place, last));
        pixels.row = number / width;
        pixels.column = number - pixels.row * width;
    }
#else
    pixels.column = pixel->column + ahead;
    carry_over(&pixels.column, width, &pixels.row);
#endif
    return pixels;
}

/* What a kernel is told that traces a chunk. */
#define TRACE_PARAMETERS                                                                                               \
    SCENE_PARAMETERS uint first_pixel, uint first_sample, uint samples_per_pixel, uint sample_count,                  \
        __global real *samples, __global uint *lamp_rays PIXEL_LIST_PARAMETER
#define TRACE_ARGUMENTS                                                                                                \
    SCENE_NAMES first_pixel, first_sample, samples_per_pixel, sample_count, samples, lamp_rays PIXEL_LIST_ARGUMENT
