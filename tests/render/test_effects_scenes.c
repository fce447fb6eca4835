/* test_effects_scenes.c: the effects of every scene of scenes/, against sets written by hand; and that the
 * cases of test_effects_equality cover all triples.
 *
 * A scene that has no line here fails the test: read it, and write down what its picture shows. */
#include "ballpark.h"
#include "effects_covering.h"
#include "packed/acceleration.h"
#include "packed/effects.h"

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The covers, the final scenes, the facets and the Cornell box have so much in them that they get a tree. */
static const struct {
    const char *scene, *effects;
} expected[] = {
    {"cover", "lambertian metal dielectric lens roulette; tree"},
    {"cover-v1", "lambertian metal dielectric lens roulette; tree"},
    {"cover-v3", "lambertian metal dielectric lens roulette; tree"},
    {"cover-v3-rust", "lambertian metal dielectric lens roulette; tree"},
    {"v1-defocus", "lambertian metal dielectric lens roulette"},
    {"v1-diffuse-gamma", "lambertian roulette"},
    {"v1-diffuse-linear", "lambertian roulette"},
    {"v1-glass-hollow", "lambertian metal dielectric roulette"},
    {"v1-glass-refract", "lambertian metal dielectric roulette"},
    {"v1-metal", "lambertian metal roulette"},
    {"v1-metal-fuzz", "lambertian metal roulette"},
    {"v1-normals", "normals"},
    {"v1-normals-antialiased", "normals"},
    {"v1-normals-ground", "normals"},
    {"checkers", "lambertian metal dielectric emission light_sampling textures roulette"},
    {"facets", "lambertian dielectric oren_nayar rough_metal glossy light_sampling discs textures triangles "
               "roulette; tree"},
    {"lamps", "lambertian metal dielectric emission light_sampling roulette"},
    {"lobes", "lambertian metal dielectric oren_nayar rough_metal glossy rough_dielectric light_sampling "
              "discs roulette"},
    {"maps", "lambertian emission oren_nayar glossy light_sampling discs textures images triangles "
             "triangle_lamps roulette texture_coordinates; tree"},
    {"next-checkered-spheres", "lambertian textures roulette"},
    {"next-bouncing-spheres", "lambertian metal dielectric lens textures motion roulette; tree"},
    {"next-earth", "lambertian textures images roulette"},
    {"next-cornell-box", "lambertian emission light_sampling triangles triangle_lamps roulette; tree"},
    {"next-cornell-smoke", "lambertian emission light_sampling media body_media triangles triangle_lamps "
                           "roulette; tree"},
    {"next-cornell-empty", "lambertian emission light_sampling triangles triangle_lamps roulette"},
    {"next-final",
     "lambertian metal dielectric emission light_sampling textures noise images motion media triangles "
     "triangle_lamps roulette; tree"},
    {"next-final-spheres",
     "lambertian metal dielectric emission light_sampling textures noise images motion media roulette; tree"},
    {"next-quads", "lambertian triangles roulette"},
    {"next-simple-light",
     "lambertian emission light_sampling textures noise triangles triangle_lamps roulette"},
    {"next-smoke", "lambertian dielectric emission light_sampling media roulette"},
    {"next-perlin-spheres", "lambertian textures noise roulette"},
    {"studio", "lambertian metal light_sampling discs roulette"},
    {"v1-red-sphere", "emission"},
    {"v1-sky", ""},
    {"v1-view-distant", "lambertian metal dielectric roulette"},
    {"v1-view-zoom", "lambertian metal dielectric roulette"},
    {"v1-wide", "lambertian roulette"},
    {"v3-07-diffuse", "lambertian roulette"},
    {"v3-08-gamma", "lambertian roulette"},
    {"v3-09-lambertian", "lambertian roulette"},
    {"v3-10-hemisphere", "lambertian roulette"},
    {"v3-11-metal", "lambertian metal roulette"},
    {"v3-12-metal-fuzz", "lambertian metal roulette"},
    {"v3-14-glass-always", "lambertian metal dielectric roulette"},
    {"v3-15-glass-sometimes", "lambertian metal dielectric roulette"},
    {"v3-16-glass-hollow", "lambertian metal dielectric roulette"},
    {"v3-17-wide", "lambertian roulette"},
    {"v3-18-view-distant", "lambertian metal dielectric roulette"},
    {"v3-19-view-zoom", "lambertian metal dielectric roulette"},
    {"v3-20-defocus", "lambertian metal dielectric lens roulette"},
    {"v3-normals", "normals"},
    {"v3-normals-antialiased", "normals"},
    {"v3-normals-ground", "normals"},
    {"v3-red-sphere", "emission"},
    {"v3-sky", ""},
    {"v4-07-hemisphere", "lambertian roulette"},
    {"v4-08-hemisphere", "lambertian roulette"},
    {"v4-09-hemisphere", "lambertian roulette"},
    {"v4-10-lambertian", "lambertian roulette"},
    {"v4-11-reflectance-10", "lambertian roulette"},
    {"v4-11-reflectance-30", "lambertian roulette"},
    {"v4-11-reflectance-50", "lambertian roulette"},
    {"v4-11-reflectance-70", "lambertian roulette"},
    {"v4-11-reflectance-90", "lambertian roulette"},
    {"v4-12-reflectance-10", "lambertian roulette"},
    {"v4-12-reflectance-30", "lambertian roulette"},
    {"v4-12-reflectance-50", "lambertian roulette"},
    {"v4-12-reflectance-70", "lambertian roulette"},
    {"v4-12-reflectance-90", "lambertian roulette"},
    {"v4-13-metal", "lambertian metal roulette"},
    {"v4-14-metal-fuzz", "lambertian metal roulette"},
    {"v4-16-glass-always", "lambertian metal dielectric roulette"},
    {"v4-17-air-bubble", "lambertian metal dielectric roulette"},
    {"v4-18-glass-hollow", "lambertian metal dielectric roulette"},
    {"v4-19-wide", "lambertian roulette"},
    {"v4-20-view-distant", "lambertian metal dielectric roulette"},
    {"v4-21-view-zoom", "lambertian metal dielectric roulette"},
    {"v4-22-defocus", "lambertian metal dielectric lens roulette"},
    {"v4-normals", "normals"},
    {"v4-normals-antialiased", "normals"},
    {"v4-normals-ground", "normals"},
    {"v4-red-sphere", "emission"},
    {"v4-sky", ""},
};

static void join_names(uint32_t bits, char *to, size_t size) {
    to[0] = '\0';
    for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
        if (!bp_effects_has(bits, (BpEffect)e)) continue;
        const size_t used = strlen(to);
        snprintf(to + used, size - used, "%s%s", used > 0 ? " " : "", bp_effect_name((BpEffect)e));
    }
}

static void each_scene_has_the_effects_written_by_hand(void **state) {
    (void)state;
    const size_t expected_count = sizeof expected / sizeof expected[0];
    size_t seen = 0;
    DIR *folder = opendir(SOURCE_DIR "/scenes");
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
        const char *end = strstr(entry->d_name, ".json");
        if (end == NULL || strcmp(end, ".json") != 0 || strcmp(entry->d_name, "scene.schema.json") == 0)
            continue;
        const size_t length = (size_t)(end - entry->d_name);
        char path[512], names[256];
        BpScene *scene = NULL;
        BpError err = {0};
        BpEffects effects;
        BpEffectInfo info;
        snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s", entry->d_name);
        if (bp_scene_load(path, &scene, &err) != BP_OK) fail_msg("%s: %s", path, err.message);
        bp_effects_analyse(scene, &effects);
        join_names(effects.bits, names, sizeof names);
        if (bp_acceleration_choose(scene, NULL) == BP_ACCELERATION_TREE)
            strncat(names, "; tree", sizeof names - strlen(names) - 1);
        size_t at = 0;
        while (at < expected_count && (strlen(expected[at].scene) != length ||
                                       strncmp(expected[at].scene, entry->d_name, length) != 0))
            ++at;
        if (at == expected_count) fail_msg("%s has no set written by hand; found: %s", entry->d_name, names);
        if (strcmp(names, expected[at].effects) != 0)
            fail_msg("%s: found '%s', expected '%s'", entry->d_name, names, expected[at].effects);
        /* The public face says the same. */
        assert_int_equal(bp_effect_count(), BP_EFFECT_COUNT);
        for (int e = 0; e < BP_EFFECT_COUNT; ++e) {
            assert_true(bp_scene_effect(scene, (size_t)e, &info));
            assert_string_equal(info.name, bp_effect_name((BpEffect)e));
            if (e == BP_EFFECT_LENS)
                assert_string_equal(info.description, "a lens with an aperture: defocus blur");
            assert_int_equal(info.simulated, bp_effects_has(effects.bits, (BpEffect)e));
            assert_string_equal(info.reason, effects.reason[e]);
        }
        assert_false(bp_scene_effect(scene, BP_EFFECT_COUNT, &info));
        bp_scene_destroy(&scene);
        ++seen;
    }
    closedir(folder);
    assert_int_equal(seen, expected_count);
}

static bool makes(uint32_t word, const int choices[3], uint32_t values) {
    for (int i = 0; i < 3; ++i)
        if ((word >> choices[i] & 1u) != (values >> i & 1u)) return false;
    return true;
}

static bool some_case_makes(const uint32_t *cases, size_t count, const int choices[3], uint32_t values) {
    for (size_t i = 0; i < count; ++i)
        if (makes(cases[i], choices, values)) return true;
    return false;
}

/* How many triples come together in some case; `all` gets how many there are. */
static unsigned triples_made(const uint32_t *cases, size_t count, int choice_count, unsigned *all) {
    unsigned made = 0;
    *all = 0;
    for (int a = 0; a < choice_count; ++a)
        for (int b = a + 1; b < choice_count; ++b)
            for (int c = b + 1; c < choice_count; ++c)
                for (uint32_t values = 0; values < 8; ++values, ++*all)
                    made += some_case_makes(cases, count, (const int[]){a, b, c}, values);
    return made;
}

/* Any three choices that occur together in some set occur together in a case, and the cases are few. Whatever
 * sets that can occur are drawn by chance have no other triples. */
static void few_cases_cover_all_triples(void **state) {
    (void)state;
    enum { DRAWN = 1 << 22 };
    static uint32_t cases[COVERING_CASES_MAX], more[COVERING_CASES_MAX];
    const size_t count = effects_covering(cases, 0);
    unsigned all = 0;
    for (size_t i = 0; i < count; ++i) assert_true(effects_case_can_occur(cases[i]));
    const unsigned triples = triples_made(cases, count, EFFECTS_CHOICES, &all);
    assert_in_range(triples, 8 * all / 10, all - 1); /* some cannot occur: lamps that light nothing */
    assert_in_range(count, 8, 40);
    assert_int_equal(effects_covering(cases, count), count); /* nothing is left to add */
    memcpy(more, cases, sizeof cases);
    size_t longer = count;
    uint32_t state_of_random = 1;
    for (int n = 0; n < DRAWN && longer < COVERING_CASES_MAX; ++n) {
        state_of_random = state_of_random * 1664525u + 1013904223u;
        const uint32_t word = state_of_random >> (32 - EFFECTS_CHOICES);
        if (effects_case_can_occur(word)) more[longer++] = word;
    }
    assert_in_range(longer, COVERING_CASES_MAX / 4, COVERING_CASES_MAX);
    assert_int_equal(triples_made(more, longer, EFFECTS_CHOICES, &all), triples);
}

/* For few choices and rules drawn by chance, the triples covered are those of all words that the rules allow.
 */
static void covered_is_what_can_occur(void **state) {
    (void)state;
    enum { CHOICES = 9, RULES = 8 };
    static uint32_t cases[COVERING_CASES_MAX], words[1 << CHOICES];
    uint32_t random = 7;
    for (int turn = 0; turn < 50; ++turn) {
        CoveringRule rules[RULES];
        size_t allowed = 0;
        unsigned all = 0;
        for (int r = 0; r < RULES; ++r) {
            uint32_t numbers[5];
            for (int n = 0; n < 5; ++n) numbers[n] = (random = random * 1664525u + 1013904223u) >> 16;
            rules[r].on = 1u << numbers[0] % CHOICES | 1u << numbers[1] % CHOICES;
            rules[r].off = (1u << numbers[2] % CHOICES | 1u << numbers[3] % CHOICES) & ~rules[r].on;
            if (numbers[4] % 4 == 0) rules[r].off = 0;
        }
        const CoveringRules of = {rules, RULES};
        for (uint32_t word = 0; word < 1u << CHOICES; ++word) {
            bool allows = true;
            for (int r = 0; r < RULES; ++r)
                allows = allows && ((~word & rules[r].on) != 0 || (word & rules[r].off) != 0);
            assert_int_equal(covering_allows(of, word), allows);
            if (allows) words[allowed++] = word;
        }
        const size_t count = covering(CHOICES, of, cases, 0);
        for (size_t i = 0; i < count; ++i) assert_true(covering_allows(of, cases[i]));
        assert_int_equal(triples_made(cases, count, CHOICES, &all),
                         triples_made(words, allowed, CHOICES, &all));
        assert_true(count <= allowed);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_scene_has_the_effects_written_by_hand),
                                       cmocka_unit_test(few_cases_cover_all_triples),
                                       cmocka_unit_test(covered_is_what_can_occur)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
