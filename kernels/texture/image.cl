/* image.cl: the colour at a place of an image, bilinear between the middles of its texels.
 *
 * In:    an image, a place in texels from its upper left corner.   Out: a colour.
 * Knows: the array of texels (scene_types.h).   Does not know: what the colour is for.
 *
 * Columns and rows are counted over all repetitions, whole numbers that a real holds. Equal texels give exactly their
 * colour, and no colour is below 0. */
#if EFFECT_ENVIRONMENT || (EFFECT_TEXTURES && EFFECT_IMAGES)
typedef struct Image {
    vuint first;         /* its first texel */
    vuint width, height; /* of one repetition */
    vreal columns, rows; /* of all */
    vbool ring;          /* the last column lies beside the first; else what is beyond shows the nearest */
#if MAPPED_TRIANGLES
    vbool rows_ring;     /* the same of rows */
#endif
} Image;

static Vec3 load_texel(const Scene *scene, const Image *image, vuint column, vuint row) {
    const vuint place = (image->first + row * image->width + column) * TEXEL_UINTS;
    return vec3(real_of_bits(gather_uint(scene->texels, place)), real_of_bits(gather_uint(scene->texels + 1u, place)),
                real_of_bits(gather_uint(scene->texels + 2u, place)));
}

static Vec3 image_colour(const Scene *scene, const Image *image, vreal x, vreal y) {
    const vreal last_column = image->columns - splat(1), last_row = image->rows - splat(1);
    const vreal across = x - splat(R(0.5)), down = y - splat(R(0.5));
    const vreal column = floor(across), row = floor(down);
    const vreal beyond_left = choose(image->ring, last_column, splat(0));
    const vreal beyond_right = choose(image->ring, splat(0), last_column);
    const vreal left = choose(column < splat(0), beyond_left, at_most(column, last_column));
    const vreal right = choose(column + splat(1) > last_column, beyond_right, column + splat(1));
    const vuint l = to_uint(left) % image->width, r = to_uint(right) % image->width;
#if MAPPED_TRIANGLES
    const vreal beyond_top = choose(image->rows_ring, last_row, splat(0));
    const vreal beyond_bottom = choose(image->rows_ring, splat(0), last_row);
    const vuint t = to_uint(choose(row < splat(0), beyond_top, at_most(row, last_row))) % image->height;
    const vuint b = to_uint(choose(row + splat(1) > last_row, beyond_bottom, row + splat(1))) % image->height;
#else
    const vuint t = to_uint(at_most(at_least(row, splat(0)), last_row)) % image->height;
    const vuint b = to_uint(at_most(row + splat(1), last_row)) % image->height;
#endif
    const vreal share_right = across - column, share_below = down - row;
    const Vec3 top_left = load_texel(scene, image, l, t), bottom_left = load_texel(scene, image, l, b);
    const Vec3 top = madd3(share_right, subtract3(load_texel(scene, image, r, t), top_left), top_left);
    const Vec3 bottom = madd3(share_right, subtract3(load_texel(scene, image, r, b), bottom_left), bottom_left);
    return madd3(share_below, subtract3(bottom, top), top);
}
#endif

#if EFFECT_TEXTURES && EFFECT_IMAGES
/* Of the texture that begins at `numbers` and `kinds` in its tables, on the surface of a sphere or a triangle. */
static Vec3 image_texture(const Scene *scene, vuint numbers, vuint kinds, WITH_PLACE(const MapPlace *place) Vec3 normal,
                          vbool active) {
#if MAPPED_TRIANGLES
    vreal u, v;
    map_place(scene, numbers, place, normal, active, &u, &v);
#else
    vreal axes[9], u, v;
    for (uint i = 0; i < 9; ++i) axes[i] = gather_real(scene->textures + (TEXTURE_AXES + i), numbers);
    sphere_map(normal, vec3(axes[0], axes[1], axes[2]), vec3(axes[3], axes[4], axes[5]),
               vec3(axes[6], axes[7], axes[8]), &u, &v);
#endif
    const vreal around = choose(active, gather_real(scene->textures + TEXTURE_FIELDS, numbers), splat(1));
    const vreal downwards = choose(active, gather_real(scene->textures + (TEXTURE_FIELDS + 1u), numbers), splat(1));
    const vbool clamped =
        vbool_of_uint(gather_uint(scene->texture_kinds + TEXTURE_CLAMPED, kinds) != splat_uint(0));
#if MAPPED_TRIANGLES
    u = choose(place->laid & clamped, clamped_place(place->tile_u, u), u);
    v = choose(place->laid & clamped, clamped_place(place->tile_v, v), v);
#endif
    Image image;
    image.first = choose_uint(active, gather_uint(scene->texture_kinds + TEXTURE_IMAGE, kinds), splat_uint(0));
    image.width = choose_uint(active, gather_uint(scene->texture_kinds + TEXTURE_WIDTH, kinds), splat_uint(1));
    image.height = choose_uint(active, gather_uint(scene->texture_kinds + TEXTURE_HEIGHT, kinds), splat_uint(1));
    image.columns = choose(clamped, uint_to_real(image.width), around);
    image.rows = choose(clamped, uint_to_real(image.height), downwards);
    image.ring = vbool_not(clamped);
#if MAPPED_TRIANGLES
    image.rows_ring = place->laid & vbool_not(clamped);
#endif
    return image_colour(scene, &image, u * around, (splat(1) - v) * downwards);
}
#endif
