/* triangle_map.cl: where a point of a triangle stands on a map, by the texture coordinates at the vertices.
 *
 * In:    hits, and where on their triangles they are.   Out: in which tile of the plane of coordinates, and how far into it.
 * Knows: hit.cl, sphere_map.cl.   Does not know: what stands on the map.
 *
 * Tiles are squares of side 1: u grows to the right, v upwards. What repeats is the same in all of them. */
#if MAPPED_TRIANGLES
typedef struct MapPlace {
    vbool laid;  /* on a triangle; elsewhere the rest means nothing */
    vreal u, v;  /* from 0 to 1 */
    vreal tile_u, tile_v; /* whole numbers */
} MapPlace;

#define WITH_PLACE(place) place,

static MapPlace off_triangles(void) {
    MapPlace place;
    place.laid = vbool_none;
    place.u = place.v = place.tile_u = place.tile_v = splat(0);
    return place;
}

static MapPlace triangle_map(const Scene *scene, vuint slot, vbool met, const Shares *shares) {
    const Geometry *const geometry = &scene->geometry;
    MapPlace place = off_triangles();
    if (geometry->coordinate_leaves == 0) return place;
    place.laid = met & is_triangle(geometry, slot);
    if (!any_lane(place.laid)) return place;
    const uint first = geometry->first_triangles * TREE_WIDTH;
    const vuint number = choose_uint(place.laid, slot - splat_uint(first), splat_uint(0)), lane = number % TREE_WIDTH;
    const vuint at = (number - lane) * 6u + lane;
    vreal of[6];
    for (uint i = 0; i < 6u; ++i) of[i] = gather_split_real(geometry->triangle_coordinates, i * TREE_WIDTH, at);
    triangle_between(shares, of[0], of[2], of[4], &place.tile_u, &place.u);
    triangle_between(shares, of[1], of[3], of[5], &place.tile_v, &place.v);
    return place;
}

/* Where any surface stands on the map of the texture that begins at `numbers`: a sphere by its longitude and latitude. */
static void map_place(const Scene *scene, vuint numbers, const MapPlace *place, Vec3 normal, vbool active, vreal *u, vreal *v) {
    *u = place->u;
    *v = place->v;
#if SPHERES_MET
    if (!any_lane(active & vbool_not(place->laid))) return;
    vreal axes[9], around, upwards;
    for (uint i = 0; i < 9; ++i) axes[i] = gather_real(scene->textures + (TEXTURE_AXES + i), numbers);
    sphere_map(normal, vec3(axes[0], axes[1], axes[2]), vec3(axes[3], axes[4], axes[5]),
               vec3(axes[6], axes[7], axes[8]), &around, &upwards);
    *u = choose(place->laid, *u, around);
    *v = choose(place->laid, *v, upwards);
#endif
}

/* What a clamped map shows beyond its first tile is the nearest place in it. */
static vreal clamped_place(vreal tile, vreal place) {
    return choose(tile < splat(0), splat(0), choose(tile > splat(0), splat(1), place));
}
#else
#define WITH_PLACE(place)
#endif
