/* lattice.cl: where a point stands in a lattice of cubes: which cell, and where in it.
 *
 * In:    a point relative to the camera, known beyond the precision of a real.   Out: a cell, and a place in it.
 * Knows: ray.cl (Point), PackedTexture (scene_types.h).   Does not know: what fills the cells.
 *
 * Whole numbers of cells are taken off before small ones are added, so the place in the cell is right to 1e-6 of the cell,
 * as far as the point itself is known, wherever the camera stands and however many cells lie before it. */
#if EFFECT_TEXTURES
typedef struct LatticePlace {
    vuint x, y, z;   /* the cell, modulo LATTICE_PERIOD or more */
    Vec3 in_cell;    /* from 0 to 1 */
} LatticePlace;

/* A whole number modulo LATTICE_PERIOD, exactly. */
static vuint lattice_wrap(vreal whole) {
    return to_uint(whole - floor(whole * (R(1.0) / LATTICE_PERIOD)) * (real)LATTICE_PERIOD);
}

/* `beside`: how little below 0, in cells, a place is so that nothing is taken off. Beside 1 it would be lost, and with it on which
 * side of a corner a point of cells lies that are huge against all else. */
static void lattice_axis(real beside, vreal high, vreal low, vreal scale, vreal scale_low, vreal rest, vuint first, vuint *cell,
                         vreal *in_cell) {
    const vreal product = high * scale;
    const vreal error = fma(high, scale, -product) + fma(high, scale_low, low * scale);
    const vreal whole = choose(fabs(product) < splat(beside), splat(0), floor(product));
    const vreal sum = (product - whole) + (error + rest);
    const vreal carry = floor(sum);
    *in_cell = sum - carry;
    *cell = lattice_wrap(whole) + lattice_wrap(carry) + first;
}

/* In the lattice of the texture that begins at `numbers` and `kinds` in its tables. */
static LatticePlace lattice_place(const Scene *scene, vuint numbers, vuint kinds, real beside, const Point *point) {
    const vreal scale = gather_real(scene->textures + TEXTURE_SCALE, numbers);
    const vreal scale_low = gather_real(scene->textures + TEXTURE_SCALE_LOW, numbers);
    LatticePlace place;
    lattice_axis(beside, point->high.x, point->low.x, scale, scale_low, gather_real(scene->textures + TEXTURE_REST, numbers),
                 gather_uint(scene->texture_kinds + TEXTURE_CELL, kinds), &place.x, &place.in_cell.x);
    lattice_axis(beside, point->high.y, point->low.y, scale, scale_low,
                 gather_real(scene->textures + (TEXTURE_REST + 1u), numbers),
                 gather_uint(scene->texture_kinds + (TEXTURE_CELL + 1u), kinds), &place.y, &place.in_cell.y);
    lattice_axis(beside, point->high.z, point->low.z, scale, scale_low,
                 gather_real(scene->textures + (TEXTURE_REST + 2u), numbers),
                 gather_uint(scene->texture_kinds + (TEXTURE_CELL + 2u), kinds), &place.z, &place.in_cell.z);
    return place;
}
#endif
