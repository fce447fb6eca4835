/* pack.c: see pack.h. Everything is packed in double; narrow() is the last step. */
#include "pack.h"

#include "base/color.h"
#include "base/pages.h"
#include "base/status.h"
#include "base/thread_pool.h"
#include "boundaries.h"
#include "environment_table.h"
#include "focusers.h"
#include "reals.h"
#include "scene/material.h"

#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

#define SAME_KIND(identifier, name, kernel_kind, effect, traits, weight, members, needed, outcome)           \
    _Static_assert((int)BP_MATERIAL_##identifier == KIND_##kernel_kind,                                      \
                   name " differs between host and kernel");
BP_MATERIAL_LIST(SAME_KIND)
_Static_assert((int)BP_SCATTER_LAMBERTIAN == LOBE_LAMBERTIAN &&
                   (int)BP_SCATTER_COSINE_CUBED == LOBE_COSINE_CUBED &&
                   (int)BP_SCATTER_HEMISPHERE == LOBE_HEMISPHERE,
               "lobes differ between host and kernel");
_Static_assert((int)BP_FUZZ_SPHERE == FUZZ_SPHERE && (int)BP_FUZZ_BALL == FUZZ_BALL,
               "shapes of fuzz differ between host and kernel");
_Static_assert((int)BP_FRESNEL_SCHLICK == FRESNEL_SCHLICK && (int)BP_FRESNEL_EXACT == FRESNEL_EXACT &&
                   (int)BP_FRESNEL_NONE == FRESNEL_NONE,
               "Fresnel forms differ between host and kernel");
_Static_assert((int)BP_TOTAL_REFLECT == TOTAL_REFLECT && (int)BP_TOTAL_ABSORB == TOTAL_ABSORB &&
                   (int)BP_TOTAL_REFRACT == TOTAL_REFRACT,
               "forms of total reflection differ between host and kernel");

static BpStatus out_of_memory(const BpScene *scene, BpError *err) {
    return bp_fail(err, BP_ERR_MEMORY, "out of memory while packing a scene of %zu spheres",
                   scene->sphere_count);
}

/* Copies `count` doubles to a new array of reals, with room for `least` at least. NULL: out of memory. */
static void *narrow(const double *values, size_t count, size_t least, bool single) {
    void *array = calloc(count > least ? count : least, single ? sizeof(float) : sizeof(double));
    if (array == NULL) return NULL;
    for (size_t i = 0; i < count; ++i) bp_reals_store(array, single, i, values[i]);
    return array;
}

/* ---- camera and sky -------------------------------------------------------------------------------- */

/* Scaled by the largest component first, so that no square leaves the range of double. Pictures depend on how
 * this is rounded, so it is not bp_normalize(). */
static void normalize(double v[3]) {
    const double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    for (int a = 0; a < 3; ++a) v[a] /= largest;
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int a = 0; a < 3; ++a) v[a] /= length;
}

static void cross(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Unit vectors; the picture lies across `back`. */
typedef struct Axes {
    double right[3], up[3], back[3];
} Axes;

static Axes camera_axes(const BpCamera *camera) {
    Axes axes;
    double vup[3];
    for (int a = 0; a < 3; ++a) {
        axes.back[a] = camera->lookfrom[a] - camera->lookat[a];
        vup[a] = camera->vup[a];
    }
    normalize(axes.back);
    normalize(vup);
    cross(vup, axes.back, axes.right);
    normalize(axes.right);
    cross(axes.back, axes.right, axes.up);
    return axes;
}

/* `moved`: see bp_camera_origin. */
static void pack_camera(const BpCamera *camera, double moved, PackedCamera *packed) {
    const bool orthographic = camera->projection == BP_ORTHOGRAPHIC;
    const Axes axes = camera_axes(camera);
    const double *const back = axes.back, *const right = axes.right, *const up = axes.up;
    const double height = bp_camera_plane_height(camera);
    const double pixel = height / camera->height; /* pixels are square */
    const double width = pixel * camera->width;
    *packed = (PackedCamera){0};
    for (int a = 0; a < 3; ++a) {
        packed->corner[a] =
            0.5 * (height * up[a] - width * right[a]) - (orthographic ? 0 : camera->focus_dist) * back[a];
        packed->ahead[a] = -camera->focus_dist * back[a];
        packed->right[a] = pixel * right[a];
        packed->down[a] = -pixel * up[a];
        packed->lens_right[a] = camera->lens_radius * right[a];
        packed->lens_up[a] = camera->lens_radius * up[a];
    }
    packed->ahead[3] = orthographic;
    packed->right[3] = bp_focusers_light_camera(camera) ? pixel * sqrt(0.5) : 0;
    packed->corner[3] = orthographic ? 1 - moved / camera->focus_dist : 0;
}

/* If a pinhole stands on a sphere, rays that leave the camera leave that sphere. A lens has only a few points
 * on the surface, so for its rays every sphere is like any other. */
static void pack_standpoint(const BpScene *scene, const BpTree *tree, PackedCamera *packed) {
    const bool one_place = scene->camera.lens_radius == 0 && scene->camera.projection == BP_PERSPECTIVE;
    const uint32_t slot = one_place ? tree->own_slot : NO_SLOT;
    packed->own_slot[0] = slot & 0xffffu;
    packed->own_slot[1] = slot >> 16;
    if (slot == NO_SLOT) return;
    const BpSphere *sphere = &scene->spheres[tree->slot_sphere[slot]];
    double size = fabs(sphere->radius);
    for (int a = 0; a < 3; ++a) {
        packed->inward[a] = sphere->center[a] - scene->camera.lookfrom[a];
        size += fabs(sphere->center[a]) + fabs(scene->camera.lookfrom[a]);
    }
    normalize(packed->inward);
    packed->own_slot[2] = 0x1p-49 * size + (tree->single_precision ? 0x1p-22 * fabs(sphere->radius) : 0);
}

/* The most that the gradient can bring to a plane: pi times its brightest luminance. */
static double most_of_gradient(const BpScene *scene) {
    return PI * fmax(bp_luminance_of(scene->background_bottom), bp_luminance_of(scene->background_top));
}

/* The most that a disc can: its luminance times its solid angle. */
static double most_of_disc(const BpDisc *disc) {
    const double s = sin(disc->half_angle_degrees * (PI / 360));
    return 4 * PI * s * s * bp_luminance_of(disc->radiance);
}

/* Of both, all that could reach the shadow catcher; 1 where there is none, so that shares of it are 0. */
static double most_for_catcher(const BpScene *scene) {
    double sum = most_of_gradient(scene);
    for (size_t i = 0; i < scene->disc_count; ++i) sum += most_of_disc(&scene->discs[i]);
    return sum > 0 ? sum : 1;
}

static void pack_catcher(const BpScene *scene, const double origin[3], double moved, PackedSky *sky) {
    if (!scene->shadow_catcher.present) return;
    const double *const normal = scene->shadow_catcher.normal;
    const double bottom = bp_luminance_of(scene->background_bottom),
                 top = bp_luminance_of(scene->background_top);
    const double brightest = fmax(bottom, top);
    sky->catcher[3] = scene->shadow_catcher.distance;
    for (int a = 0; a < 3; ++a) {
        sky->catcher[a] = normal[a];
        sky->catcher[3] -= normal[a] * origin[a];
    }
    sky->catcher_light[3] = moved;
    sky->catcher_light[2] = most_of_gradient(scene) / most_for_catcher(scene);
    if (!(brightest > 0)) return;
    sky->catcher_light[0] = bottom / brightest;
    sky->catcher_light[1] = (top - bottom) / brightest;
}

static void pack_sky(const BpScene *scene, double moved, double image_power, PackedSky *sky) {
    const Axes axes = camera_axes(&scene->camera);
    const double half = bp_camera_plane_height(&scene->camera) / 2;
    /* Numbers near 1; of parallel rays a plane that may lie anywhere. */
    const bool orthographic = scene->camera.projection == BP_ORTHOGRAPHIC;
    const double unit = orthographic ? 1 : scene->camera.focus_dist;
    *sky = (PackedSky){0};
    bp_background_up(scene, sky->up);
    for (int a = 0; a < 3; ++a) {
        sky->bottom[a] = scene->background_bottom[a];
        sky->top[a] = scene->background_top[a];
        sky->view_ahead[a] = -axes.back[a] / unit;
        sky->view_up[a] = axes.up[a] / half;
        if (scene->backdrop != BP_BACKDROP_COLORS) continue; /* black, or not there */
        sky->backdrop_bottom[a] = scene->backdrop_bottom[a];
        sky->backdrop_top[a] = scene->backdrop_top[a];
    }
    sky->view_ahead[3] = orthographic ? scene->camera.focus_dist - moved : 1;
    sky->top[3] = (double)scene->disc_count;
    if (scene->environment != NULL) {
        bp_environment_frame(scene, sky->axes, sky->axes + 3, sky->axes + 6);
        for (int a = 6; a < 9; ++a) sky->axes[a] = -sky->axes[a];
        sky->columns = scene->environment->width;
        sky->rows = scene->environment->height;
    }
    sky->backdrop_bottom[3] = scene->backdrop != BP_BACKDROP_SKY;
    sky->image_power = image_power;
    double origin[3];
    bp_camera_origin(scene, origin);
    pack_catcher(scene, origin, moved, sky);
}

static BpStatus pack_view(const BpScene *scene, double moved, double image_power, BpPacked *packed,
                          BpError *err) {
    PackedCamera camera;
    PackedSky sky;
    pack_camera(&scene->camera, moved, &camera);
    pack_standpoint(scene, &packed->tree, &camera);
    pack_sky(scene, moved, image_power, &sky);
    const size_t camera_reals = sizeof camera / sizeof(double), sky_reals = sizeof sky / sizeof(double);
    packed->camera = narrow((const double *)&camera, camera_reals, 1, packed->single_precision);
    packed->sky = narrow((const double *)&sky, sky_reals, 1, packed->single_precision);
    return packed->camera != NULL && packed->sky != NULL ? BP_OK : out_of_memory(scene, err);
}

_Static_assert(BP_DISCS_MAX <= DISCS_MAX && BP_SPHERES_MAX < DISC_SLOT, "places of discs and of spheres");

/* `unit`: of the power of lamps. */
static BpStatus pack_discs(const BpScene *scene, double unit, BpPacked *packed, BpError *err) {
    PackedDisc discs[BP_DISCS_MAX] = {{{0}, 0, {0}, 0, 0, 0, 0, 0}};
    for (size_t i = 0; i < scene->disc_count; ++i) {
        const BpDisc *disc = &scene->discs[i];
        const double half = disc->half_angle_degrees * (PI / 180), s = sin(half / 2);
        double direction[3] = {disc->direction[0], disc->direction[1], disc->direction[2]};
        const double luminance = bp_luminance_of(disc->radiance);
        normalize(direction);
        discs[i] = (PackedDisc){.cap = 2 * s * s,
                                .power = luminance * unit * sin(half) * sin(half),
                                .sine = sin(half),
                                .chord2 = 4 * s * s,
                                .seen = disc->visible_to_camera ? 1 : 0,
                                .catcher_share = most_of_disc(disc) / most_for_catcher(scene)};
        memcpy(discs[i].direction, direction, sizeof direction);
        memcpy(discs[i].radiance, disc->radiance, sizeof disc->radiance);
    }
    packed->disc_count = (uint32_t)scene->disc_count;
    packed->discs =
        narrow((const double *)discs, packed->disc_count * DISC_REALS, DISC_REALS, packed->single_precision);
    return packed->discs != NULL ? BP_OK : out_of_memory(scene, err);
}

/* ---- images ---- */

/* The first texel of an image: that around the scene stands first, the others follow in the scene's order. */
static uint64_t first_texel(const BpScene *scene, const BpImage *image) {
    uint64_t place = 0;
    if (image == scene->environment) return 0;
    if (scene->environment != NULL) place = (uint64_t)scene->environment->width * scene->environment->height;
    for (size_t i = 0; i < scene->image_count && scene->images[i] != image; ++i)
        if (scene->images[i] != scene->environment)
            place += (uint64_t)scene->images[i]->width * scene->images[i]->height;
    return place;
}

static BpStatus pack_images(const BpScene *scene, BpPacked *packed, BpError *err) {
    packed->texel_count = 0;
    for (size_t i = 0; i < scene->image_count; ++i)
        packed->texel_count += (uint64_t)scene->images[i]->width * scene->images[i]->height;
    packed->texels = malloc((size_t)(packed->texel_count + 1) * TEXEL_UINTS * sizeof *packed->texels);
    if (packed->texels == NULL) return out_of_memory(scene, err);
    for (size_t i = 0; i < scene->image_count; ++i) {
        const BpImage *image = scene->images[i];
        memcpy(packed->texels + first_texel(scene, image) * TEXEL_UINTS, image->texels,
               (size_t)image->width * image->height * TEXEL_UINTS * sizeof(float));
    }
    return BP_OK;
}

/* The tables by which rays are sent to the image around the scene, where they are. */
static BpStatus pack_environment(const BpScene *scene, bool sample, BpPacked *packed, BpError *err) {
    BpEnvironmentTable table = {0};
    if (sample) BP_TRY(bp_environment_table_build(scene->environment, &table, err));
    packed->sky_rows = table.rows;
    packed->sky_columns = table.columns;
    packed->sky_row_count = (uint32_t)table.row_count;
    packed->sky_column_count = (uint32_t)table.column_count;
    packed->sky_height_count = (uint32_t)table.height_count;
    packed->sky_heights = narrow(table.heights, table.height_count, 1, packed->single_precision);
    free(table.heights);
    return packed->sky_heights != NULL ? BP_OK : out_of_memory(scene, err);
}

/* ---- materials ------------------------------------------------------------------------------------- */

/* Where a member is stored: numbers and colours in PackedMaterial, choices in PackedMaterialKind. The albedo
 * is stored with each sphere. */
#define MATERIAL_NOWHERE 0xffu
#define COLOUR_PLACE(identifier, name, field, low, high, range, needed, place) MATERIAL_##place,
#define NUMBER_PLACE(identifier, name, field, low, high, range, needed, place, cap) MATERIAL_##place,
#define CHOICE_PLACE(identifier, name, field, place, ignored_if_zero, names) MATERIAL_##place,
static const unsigned places[] = {BP_MEMBER_LIST(COLOUR_PLACE, NUMBER_PLACE, CHOICE_PLACE)};

static void pack_material(const BpMaterial *material, bool inside_out, PackedMaterial *numbers,
                          PackedMaterialKind *kind) {
    *numbers = (PackedMaterial){.refraction_index = 1};
    *kind = (PackedMaterialKind){.kind = (packed_uint)material->kind};
    for (int m = 0; m < BP_MEMBER_COUNT; ++m) {
        if (!bp_material_has(material->kind, (BpMember)m) || places[m] == MATERIAL_NOWHERE) continue;
        if (bp_members[m].form == BP_FORM_CHOICE) {
            ((packed_uint *)kind)[places[m]] = (packed_uint)bp_member_choice(material, (BpMember)m);
            continue;
        }
        const int count = bp_members[m].form == BP_FORM_COLOUR ? 3 : 1;
        for (int a = 0; a < count; ++a)
            ((real *)numbers)[places[m] + (unsigned)a] = bp_member_values_of(material, (BpMember)m)[a];
    }
    if (material->kind == BP_MATERIAL_GLOSSY) numbers->lets_in = bp_coat_lets_in(material->refraction_index);
    numbers->opacity = bp_material_opacity(material);
    if (inside_out) numbers->refraction_index = 1 / numbers->refraction_index;
}

_Static_assert((int)BP_MAPPING_SOLID == MAPPING_SOLID && (int)BP_MAPPING_SURFACE == MAPPING_SURFACE,
               "mappings differ between host and kernel");
#define PATTERN_OF(pattern) ((int)(pattern) + PATTERN_PERLIN)
_Static_assert(PATTERN_OF(BP_PATTERN_TURBULENCE) == PATTERN_TURBULENCE &&
                   PATTERN_OF(BP_PATTERN_MARBLE) == PATTERN_MARBLE &&
                   PATTERN_OF(BP_PATTERN_WOOD) == PATTERN_WOOD && PATTERN_WOOD < PATTERN_IMAGE,
               "patterns differ between host and kernel");
_Static_assert(BP_LATTICE_PERIOD == LATTICE_PERIOD, "lattices differ between host and kernel");

/* 1 / length as a real, and what that lacks. */
static void pack_inverse(double length, bool single, real *inverse, real *low) {
    const double exact = 1 / length;
    *inverse = single ? (double)(float)exact : exact;
    *low = single ? exact - *inverse : fma(-exact, length, 1) / length;
}

/* The lattice of cells, seen from where the camera stands, `from` the texture's own origin. */
static void pack_lattice(const BpTexture *texture, const double from[3], bool single, PackedTexture *packed,
                         PackedTextureKind *kind) {
    pack_inverse(texture->size, single, &packed->scale, &packed->scale_low);
    for (int a = 0; a < 3; ++a) {
        const double place = from[a] / texture->size, period = LATTICE_PERIOD;
        double whole = floor(place);
        if (!bp_texture_has(texture, BP_TEXTURE_PATTERN) && place - whole > 1 - 1.0 / LATTICE_BESIDE) ++whole;
        packed->rest[a] = place - whole;
        kind->cell[a] = (packed_uint)(whole - floor(whole / period) * period);
    }
}

static void pack_waves(const BpTexture *texture, const double from[3], bool single, PackedTexture *packed) {
    pack_inverse(texture->period, single, &packed->wave, &packed->wave_low);
    const double waves = from[texture->axis] / texture->period;
    packed->wave_rest = waves - floor(waves);
    packed->distortion = texture->distortion;
    for (int a = 0; a < 3; ++a) {
        packed->centre[a] = single ? (double)(float)-from[a] : -from[a];
        packed->centre_low[a] = -from[a] - packed->centre[a];
    }
}

static void pack_image_texture(const BpTexture *texture, uint64_t first, PackedTexture *packed,
                               PackedTextureKind *kind) {
    const BpImage *image = texture->image;
    packed->fields[0] = (double)image->width * texture->repeat[0];
    packed->fields[1] = (double)image->height * texture->repeat[1];
    kind->image = (packed_uint)first;
    kind->width = image->width;
    kind->height = image->height;
    kind->clamped = texture->wrap == BP_WRAP_CLAMP;
}

/* PATTERN_... of scene_types.h: how the kernel computes the values. */
static packed_uint pattern_of(const BpTexture *texture) {
    switch (texture->type) {
    case BP_TEXTURE_CHECKER:
        return PATTERN_CHECKER;
    case BP_TEXTURE_NOISE:
        return (packed_uint)PATTERN_OF(texture->pattern);
    case BP_TEXTURE_IMAGE:
        return PATTERN_IMAGE;
    }
    return PATTERN_CHECKER; /* not reached */
}

/* `origin`: of the space that is packed, in the scene; `first`: the number of an image's first texel. */
static void pack_texture(const BpTexture *texture, const double origin[3], bool single, uint64_t first,
                         PackedTexture *packed, PackedTextureKind *kind) {
    *packed = (PackedTexture){.scale = 0};
    *kind = (PackedTextureKind){.mapping = (packed_uint)texture->mapping, .pattern = pattern_of(texture)};
    memcpy(packed->first, texture->colors[0], sizeof packed->first);
    memcpy(packed->second, texture->colors[1], sizeof packed->second);
    if (texture->mapping == BP_MAPPING_SURFACE) {
        bp_texture_frame(texture, packed->axes, packed->axes + 3, packed->axes + 6);
        for (int i = 0; i < 2; ++i) packed->fields[i] = 2.0 * texture->repeat[i];
        if (bp_texture_has(texture, BP_TEXTURE_FILE)) pack_image_texture(texture, first, packed, kind);
        return;
    }
    double from[3];
    for (int a = 0; a < 3; ++a) from[a] = origin[a] - texture->origin[a];
    pack_lattice(texture, from, single, packed, kind);
    if (!bp_texture_has(texture, BP_TEXTURE_PATTERN)) return;
    kind->octaves = texture->octaves;
    kind->seed = texture->seed;
    kind->axis = (packed_uint)texture->axis;
    if (bp_texture_has_waves(texture)) pack_waves(texture, from, single, packed);
}

/* `origin`: of the space that is packed, in the scene. */
static BpStatus pack_textures(const BpScene *scene, const double origin[3], BpPacked *packed, BpError *err) {
    const size_t count = scene->texture_count;
    PackedTexture *textures = calloc(count + 1, sizeof *textures);
    PackedTextureKind *kinds = calloc(count + 1, sizeof *kinds);
    packed->texture_kinds = (uint32_t *)kinds;
    packed->texture_count = (uint32_t)count;
    if (textures != NULL && kinds != NULL) {
        for (size_t i = 0; i < count; ++i)
            pack_texture(&scene->textures[i], origin, packed->single_precision,
                         first_texel(scene, scene->textures[i].image), &textures[i], &kinds[i]);
        packed->textures =
            narrow((const double *)textures, count * TEXTURE_REALS, TEXTURE_REALS, packed->single_precision);
    }
    free(textures);
    return packed->textures != NULL ? BP_OK : out_of_memory(scene, err);
}

static bool is_inside_out(const BpScene *scene, size_t shape) {
    return shape < scene->sphere_count && scene->spheres[shape].radius < 0 &&
           bp_material_is(scene->materials[scene->spheres[shape].material].kind, BP_HAS_INSIDE);
}

/* Colours of its own, as points of clouds have them, that stand in place of its material's texture. */
static bool replaces_texture(const BpScene *scene, size_t shape) {
    return bp_shape_albedo(scene, shape) != BP_NO_ALBEDO &&
           scene->materials[bp_shape_material(scene, shape)].texture[BP_MEMBER_ALBEDO] != 0;
}

/* Whether a shape could have a second entry of the material. */
static bool may_have_second(const BpMaterial *material) {
    return bp_material_is(material->kind, BP_HAS_INSIDE) || material->texture[BP_MEMBER_ALBEDO] != 0;
}

/* Whether the shape has the second entry of its material. */
static bool is_second(const BpScene *scene, size_t shape) {
    return is_inside_out(scene, shape) || replaces_texture(scene, shape);
}

/* The materials. Some get a second entry, and no material has both reasons for it. A dielectric that a sphere
 * of negative radius uses: with the reciprocal index, since seen from inside out is the same as inside and
 * outside exchanged; normals face the ray, so no other kind can tell a negative radius. And one whose albedo
 * varies, for shapes that have a colour of their own. `second[m]`: the number of that entry of material m.
 * Behind these stands an entry for each body, by which its triangles are told from others. */
static BpStatus pack_materials(const BpScene *scene, uint32_t *second, BpPacked *packed, BpError *err) {
    const size_t count = scene->material_count;
    if (count > UINT32_MAX / 4)
        return bp_fail(err, BP_ERR_LIMIT, "%zu materials; at most %u can be packed", count, UINT32_MAX / 4);
    BpStatus status = BP_OK;
    const size_t room = 2 * count + scene->bodies.count + 1;
    PackedMaterialKind *kinds = calloc(room, sizeof *kinds);
    PackedMaterial *numbers = calloc(room, sizeof *numbers);
    PackedVariation *variations = calloc(room, sizeof *variations);
    packed->variations = (uint32_t *)variations;
    if (kinds == NULL || numbers == NULL || variations == NULL) {
        status = out_of_memory(scene, err);
        goto cleanup;
    }
    uint32_t used = (uint32_t)count;
    bool any = false;
    for (size_t m = 0; m < count; ++m) {
        any = any || may_have_second(&scene->materials[m]);
        const uint32_t *texture = scene->materials[m].texture;
        pack_material(&scene->materials[m], false, &numbers[m], &kinds[m]);
        variations[m] = (PackedVariation){.albedo = texture[BP_MEMBER_ALBEDO],
                                          .fuzz = texture[BP_MEMBER_FUZZ],
                                          .emit = texture[BP_MEMBER_EMIT]};
    }
    for (size_t i = 0; i < bp_scene_shapes(scene) && any; ++i) {
        const uint32_t m = bp_shape_material(scene, i);
        if (!is_second(scene, i) || second[m] != 0) continue;
        pack_material(&scene->materials[m], is_inside_out(scene, i), &numbers[used], &kinds[used]);
        variations[used] = variations[m];
        variations[used].albedo = 0;
        second[m] = used++;
    }
    packed->first_body = used;
    for (size_t b = 0; b < scene->bodies.count; ++b, ++used) {
        const uint32_t m = scene->bodies.list[b].material;
        numbers[used] = numbers[m];
        kinds[used] = kinds[m];
        variations[used] = variations[m];
    }
    packed->material_count = used > 0 ? used : 1; /* at least one, unused */
    packed->materials =
        narrow((const double *)numbers, packed->material_count * (sizeof *numbers / sizeof(double)), 1,
               packed->single_precision);
    packed->material_kinds = (uint32_t *)kinds;
    kinds = NULL;
    if (packed->materials == NULL) status = out_of_memory(scene, err);
cleanup:
    free(kinds);
    free(numbers);
    return status;
}

/* The share of each primary colour that spheres of a material scatter: 1 for glass, 0 for a lamp, whatever
 * colour a cloud gives. */
typedef struct Scattered {
    double albedo[3];
    bool replaced; /* by a shape's own colour */
} Scattered;

static Scattered scattered_by(const BpMaterial *material) {
    Scattered result = {{0, 0, 0}, false};
    if (!bp_material_is(material->kind, BP_SCATTERS)) return result;
    result.replaced = bp_material_has(material->kind, BP_MEMBER_ALBEDO);
    for (int c = 0; c < 3; ++c) result.albedo[c] = result.replaced ? material->albedo[c] : 1;
    return result;
}

typedef struct Slots {
    const BpScene *scene;
    const uint32_t *second;
    const Scattered *scattered; /* of each material */
    BpPacked *packed;
    size_t count;
} Slots;

/* Of the half of a capsule by its other end. */
static void pack_other_colour(BpPacked *packed, size_t slot, const float *own, const double *albedo) {
    const size_t width = packed->tree.width, leaf = slot / width;
    for (size_t a = 0; a < ALBEDO_REALS; ++a)
        bp_reals_store(packed->tree.leaf_axes, packed->single_precision,
                       leaf * AXIS_REALS(width) + (3 + a) * width + slot % width,
                       own != NULL ? (double)own[a] : albedo[a]);
}

/* Of the shape's material, the packed entry that is for it. */
static uint32_t entry_for(const Slots *slots, size_t shape, uint32_t material) {
    const BpScene *scene = slots->scene;
    const size_t triangle = shape - scene->sphere_count; /* huge for spheres */
    if (scene->bodies.count > 0 && triangle < scene->triangle_count &&
        bp_body_of(scene, triangle) != BP_NO_BODY)
        return slots->packed->first_body + bp_body_of(scene, triangle);
    const bool second = slots->second[material] != 0 && is_second(scene, shape);
    return second ? slots->second[material] : material;
}

#define SLOT_CHUNK 64u

/* Shapes are asked in the order of the tree, so this mostly waits for memory. First all shapes of the chunk
 * are looked up, then all colours: no look-up waits for the one before. */
static void pack_slot_chunk(const Slots *slots, size_t first, size_t count) {
    const BpScene *scene = slots->scene;
    BpPacked *packed = slots->packed;
    const uint32_t *shapes = packed->tree.slot_sphere + first;
    uint32_t materials[SLOT_CHUNK], albedos[SLOT_CHUNK];
    for (size_t s = 0; s < count; ++s) {
        const bool used = shapes[s] != NO_SPHERE;
        materials[s] = used ? bp_shape_material(scene, shapes[s]) : 0;
        albedos[s] = used ? bp_shape_albedo(scene, shapes[s]) : BP_NO_ALBEDO;
    }
    static const Scattered nothing;
    for (size_t s = 0; s < count; ++s) {
        const bool used = shapes[s] != NO_SPHERE;
        const Scattered *scattered = used ? &slots->scattered[materials[s]] : &nothing;
        packed->slot_material[first + s] = used ? entry_for(slots, shapes[s], materials[s]) : materials[s];
        if (first + s >= packed->coloured_slots) continue;
        const float *own =
            scattered->replaced && albedos[s] != BP_NO_ALBEDO ? scene->albedos[albedos[s]] : NULL;
        for (size_t a = 0; a < ALBEDO_REALS; ++a)
            bp_reals_store(packed->slot_albedo, packed->single_precision, ALBEDO_REALS * (first + s) + a,
                           own != NULL ? (double)own[a] : scattered->albedo[a]);
        const BpCapsule *capsule = used ? bp_shape_capsule(scene, shapes[s]) : NULL;
        if (capsule != NULL)
            pack_other_colour(packed, first + s, own != NULL ? scene->albedos[capsule->albedo[1]] : NULL,
                              scattered->albedo);
    }
}

/* After the colours of slots, for those that have none. */
static void pack_material_colour(const Slots *slots, uint32_t material, const Scattered *scattered) {
    const BpPacked *packed = slots->packed;
    for (size_t a = 0; a < ALBEDO_REALS; ++a)
        bp_reals_store(packed->slot_albedo, packed->single_precision,
                       ALBEDO_REALS * ((size_t)packed->coloured_slots + material) + a, scattered->albedo[a]);
}

static bool triangles_have_colours(const BpScene *scene) {
    bool have = false;
    for (size_t i = 0; i < scene->triangle_count && scene->albedo_count > 0 && !have; ++i)
        have = scene->triangles[i].albedo != BP_NO_ALBEDO;
    return have;
}

static void pack_slot_block(void *context, uint32_t block, unsigned thread) {
    (void)thread;
    const Slots *slots = context;
    const size_t end = bp_block_end(block, slots->count);
    for (size_t chunk = bp_block_begin(block); chunk < end; chunk += SLOT_CHUNK)
        pack_slot_chunk(slots, chunk, end - chunk < SLOT_CHUNK ? end - chunk : SLOT_CHUNK);
}

/* What the shape in each slot is made of. Empty slots are black. `threads`: 0, or how many may work. */
static BpStatus pack_slots(const BpScene *scene, const uint32_t *second, unsigned threads, BpPacked *packed,
                           BpError *err) {
    BpStatus status = BP_OK;
    const size_t count = (size_t)packed->tree.leaf_count * packed->tree.width;
    packed->slot_material = bp_own_pages(count + 1, sizeof *packed->slot_material);
    packed->coloured_slots =
        triangles_have_colours(scene) ? (uint32_t)count : packed->tree.first_triangles * packed->tree.width;
    const bool shared = packed->coloured_slots < count;
    packed->colour_count = packed->coloured_slots + (uint64_t)(shared ? packed->material_count : 0);
    packed->slot_albedo =
        bp_own_pages((size_t)packed->colour_count + 1, ALBEDO_REALS * bp_packed_real_size(packed));
    Scattered *scattered = malloc((scene->material_count + 1) * sizeof *scattered);
    BpThreadPool *pool = bp_thread_pool_create(count < BP_BLOCK ? 1 : threads);
    if (packed->slot_material != NULL && packed->slot_albedo != NULL && scattered != NULL && pool != NULL) {
        for (size_t m = 0; m < scene->material_count; ++m) scattered[m] = scattered_by(&scene->materials[m]);
        Slots slots = {scene, second, scattered, packed, count};
        bp_parallel_for(pool, pack_slot_block, &slots, bp_block_count(count));
        for (uint32_t m = 0; m < scene->material_count && shared; ++m) {
            pack_material_colour(&slots, m, &scattered[m]);
            if (second[m] != 0) pack_material_colour(&slots, second[m], &scattered[m]);
        }
        for (uint32_t b = 0; b < scene->bodies.count && shared; ++b)
            pack_material_colour(&slots, packed->first_body + b, &scattered[scene->bodies.list[b].material]);
    } else {
        status = out_of_memory(scene, err);
    }
    bp_thread_pool_destroy(&pool);
    free(scattered);
    return status;
}

/* ---- media ----------------------------------------------------------------------------------------- */

static BpStatus pack_media(const BpScene *scene, BpPacked *packed, BpError *err) {
    const size_t count = scene->medium_count + 1;
    PackedMedium *media = calloc(count, sizeof *media);
    if (media == NULL) return out_of_memory(scene, err);
    for (size_t i = 1; i < count; ++i) {
        const BpMedium *medium = &scene->media[i - 1];
        memcpy(media[i].scattering, medium->scattering, sizeof media[i].scattering);
        memcpy(media[i].absorption, medium->absorption, sizeof media[i].absorption);
        media[i].anisotropy = medium->anisotropy;
    }
    packed->medium_count = (uint32_t)count;
    packed->media = narrow((const double *)media, count * MEDIUM_REALS, 1, packed->single_precision);
    free(media);
    return packed->media != NULL ? BP_OK : out_of_memory(scene, err);
}

/* ---- the whole ------------------------------------------------------------------------------------- */

BpStatus bp_scene_pack(const BpScene *scene, const BpTreeOptions *options, bool sample_lamps,
                       bool sample_caustics, BpPacked *packed, BpError *err) {
    *packed = (BpPacked){.single_precision = options->single_precision};
    BpStatus status = BP_OK;
    uint32_t *second = NULL;
    double origin[3];
    const double moved = bp_camera_origin(scene, origin);
    const bool sample_image =
        sample_lamps && scene->environment != NULL && bp_environment_varies(scene->environment);
    BP_TRY_GOTO(status, bp_tree_build(scene, origin, options, &packed->tree, err), cleanup);
    second = calloc(scene->material_count + 1, sizeof *second);
    if (second == NULL) {
        status = out_of_memory(scene, err);
        goto cleanup;
    }
    BP_TRY_GOTO(status, pack_materials(scene, second, packed, err), cleanup);
    BP_TRY_GOTO(status, pack_textures(scene, origin, packed, err), cleanup);
    BP_TRY_GOTO(status, pack_slots(scene, second, options->threads, packed, err), cleanup);
    BP_TRY_GOTO(status, pack_media(scene, packed, err), cleanup);
    BpBodyTable table = {
        options->bodies, {origin[0], origin[1], origin[2]}, packed->material_count, packed->first_body};
    BP_TRY_GOTO(
        status,
        bp_pack_boundaries(scene, &packed->tree, &table, &packed->boundaries, &packed->boundary_uints, err),
        cleanup);
    if (sample_lamps)
        BP_TRY_GOTO(status, bp_lamp_tree_build(scene, &packed->tree, &packed->lamps, err), cleanup);
    BP_TRY_GOTO(status, pack_discs(scene, packed->lamps.unit, packed, err), cleanup);
    BP_TRY_GOTO(status,
                bp_focusers_build(scene, origin, &packed->tree, sample_lamps && sample_caustics,
                                  &packed->focusers, err),
                cleanup);
    BP_TRY_GOTO(status, pack_images(scene, packed, err), cleanup);
    BP_TRY_GOTO(status, pack_environment(scene, sample_image, packed, err), cleanup);
    BP_TRY_GOTO(status,
                pack_view(scene, moved, sample_image ? scene->environment->mean * packed->lamps.unit : 0,
                          packed, err),
                cleanup);
cleanup:
    free(second);
    if (status != BP_OK) bp_packed_clear(packed);
    return status;
}

void bp_packed_clear(BpPacked *packed) {
    bp_tree_clear(&packed->tree);
    bp_lamp_tree_clear(&packed->lamps);
    bp_focusers_clear(&packed->focusers);
#define FREE_ARRAY(numbers, element, name, count, what) free(packed->name);
    SCENE_ARRAYS_OF_PACK(FREE_ARRAY)
    SCENE_ARRAYS_OF_SLOTS(FREE_ARRAY)
#undef FREE_ARRAY
    *packed = (BpPacked){0};
}
