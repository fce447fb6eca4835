/* test_lamp_bound.c: the sums leave room for paths that are lit by lamp rays.
 *
 * A lamp ray brings half of the lamp's radiance times the albedo at most, and each further vertex the same
 * times what the vertices before it let through. On the lamps scene that is summed up here, vertex by vertex.
 */
#include "film/film.h"
#include "support/unit_test.h"

#include <math.h>

static void lamp_rays_add_up(void **state) {
    (void)state;
    BpScene *scene = NULL;
    BpError err = {0};
    if (bp_scene_load(SOURCE_DIR "/scenes/lamps.json", &scene, &err) != BP_OK) fail_msg("%s", err.message);
    const double lamp = 9,
                 albedo = 0.9; /* the brightest of each: the white lamp, and the mirror's fuzzy metal */
    const uint32_t depths[] = {2, 3, 10, 50};
    for (size_t i = 0; i < sizeof depths / sizeof depths[0]; ++i) {
        double most = lamp, through = albedo; /* the path's own end at a lamp counts whole at most */
        for (uint32_t vertex = 1; vertex < depths[i]; ++vertex, through *= albedo)
            most += 0.5 * lamp * through;
        const double bound =
            bp_scene_radiance_bound(scene, depths[i], BP_LIGHT_SAMPLING_ON, BP_CAUSTICS_OFF, BP_ROULETTE_OFF);
        assert_true(bound >= most * (1 - 1e-12) && bound <= 2 * most);
        assert_true(ldexp(bound, bp_film_scale(scene, depths[i], BP_LIGHT_SAMPLING_ON, BP_CAUSTICS_OFF,
                                               BP_ROULETTE_OFF)) <= 0x1p38);
    }
    /* Without a vertex to be lit, nothing is added. */
    assert_true(
        fabs(bp_scene_radiance_bound(scene, 1, BP_LIGHT_SAMPLING_ON, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             lamp) <= 0);
    assert_true(
        fabs(bp_scene_radiance_bound(scene, 50, BP_LIGHT_SAMPLING_OFF, BP_CAUSTICS_OFF, BP_ROULETTE_OFF) -
             lamp) <= 0);
    bp_scene_destroy(&scene);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lamp_rays_add_up)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
