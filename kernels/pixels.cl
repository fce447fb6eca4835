/* pixels.cl: the pixels of a chunk, one after the other, in lane code: a range, or places of a list for adaptive
 * sampling.
 *
 * Counted along, since division is slow, in lanes above all. */
#if PIXEL_LIST
#define PIXEL_LIST_PARAMETER , __global const uint *pixel_list
#define PIXEL_LIST_ARGUMENT pixel_list,
#define PIXEL_LIST_FIRST __global const uint *pixel_list,
#else
#define PIXEL_LIST_PARAMETER
#define PIXEL_LIST_ARGUMENT
#define PIXEL_LIST_FIRST
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
    uints row, column;
} Pixels;

/* Pixel `ahead` of a chunk of `pixel_count` that begins at `first`. */
static Pixel pixel_of_chunk(PIXEL_LIST_FIRST uint first, uint ahead, uint pixel_count, uint width) {
    Pixel pixel;
#if PIXEL_LIST
    pixel.list = pixel_list;
    pixel.place = first + ahead;
    pixel.last_place = first + pixel_count - 1;
    const uint number = pixel_list[pixel.place];
#else
    const uint number = first + ahead;
#endif
    pixel.row = number / width;
    pixel.column = number % width;
    return pixel;
}

/* Goes on to the next pixel; beyond the last one it may stay. */
static void next_pixel(Pixel *pixel, uint width) {
#if PIXEL_LIST
    pixel->place = min(pixel->place + 1u, pixel->last_place);
    const uint number = pixel->list[pixel->place];
    pixel->row = number / width;
    pixel->column = number % width;
#else
    ++pixel->column;
    if (pixel->column < width) return;
    pixel->column = 0;
    ++pixel->row;
#endif
}

/* The pixels `ahead` of this one, of which the chunk need not have all. */
static Pixels pixels_ahead(const Pixel *pixel, uints ahead, uint width) {
    Pixels pixels;
#if PIXEL_LIST
    pixels.row = splat_uint(pixel->row);
    pixels.column = splat_uint(pixel->column);
    if (any_lane(mask_of_uint(ahead > splat_uint(0)))) {
        const uints place = pixel->place + ahead;
        const uints last = splat_uint(pixel->last_place);
        const uints number = gather_uints(pixel->list, choose_uint(mask_of_uint(place < last), place, last));
        pixels.row = number / width;
        pixels.column = number - pixels.row * width;
    }
#else
    pixels.row = splat_uint(pixel->row);
    pixels.column = pixel->column + ahead;
    for (;;) {
        const masks beyond = mask_of_uint(pixels.column >= splat_uint(width));
        if (!any_lane(beyond)) break;
        pixels.column = choose_uint(beyond, pixels.column - width, pixels.column);
        pixels.row = choose_uint(beyond, pixels.row + 1u, pixels.row);
    }
#endif
    return pixels;
}
