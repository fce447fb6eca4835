/* pilot_choice.c: whether rays to lamps should go through focusers, too.
 *
 * In:    what a pilot has found, with such rays and without.
 * Out:   whether they take away more noise than the time that they cost would.
 * Knows: roughly how bright the picture is.   Does not know: kernels. So a scene has one answer on all
 * devices.
 *
 * At equal time, noise falls if the variance of a sample falls by more than its time grows. Of the variance,
 * the pilot knows the part that is left to chance; to it come the rims of lights in the picture, and all the
 * rest is taken for ORDINARY of the squared brightness. Such rays are taken for TIMES as slow as none, and
 * those by way of two focusers too for TIMES_OF_PAIRS (docs/UNSEEN.md has what was measured). Where light is
 * by far too rare for samples to find, these guesses hardly matter. */
#include "pilot_state.h"

#include "base/color.h"
#include "packed/focusers.h"
#include "scene/vector.h"

#include <math.h>

#define PI 3.14159265358979323846
#define ORDINARY 0.5
#define TIMES 5.0
#define TIMES_OF_PAIRS 12.0
/* A disk of A pixels has 2 sqrt(pi A) 4 / pi pixels on its rim, of which it fills any part alike: the mean of
 * f (1 - f) is 1/6. */
#define RIM 0.752
#define EYES 4096u /* that are looked at, of all pixels alike */

static double total(const double *values, size_t count) {
    double sum = 0;
    for (size_t i = 0; i < count; ++i) sum += values[i];
    return sum;
}

/* The light of what surrounds the scene, in the mean over directions; discs, which are lights, apart. */
static double sky_luminance(const BpScene *scene) {
    if (scene->environment != NULL) return scene->environment->mean;
    return 0.5 * (bp_luminance_of(scene->background_bottom) + bp_luminance_of(scene->background_top));
}

/* The light that comes to a point from a light, if nothing stands between, over pi: what a white surface
 * sends back of it. */
static double irradiance_over_pi(const BpPilotLight *light, const BpPilotEye *eye) {
    double to[3], solid_angle = 2 * PI * light->cap;
    for (int a = 0; a < 3; ++a) to[a] = light->place[a] - (light->distant ? 0 : eye->point[a]);
    const double away2 = bp_dot(to, to);
    if (!light->distant) solid_angle = fmin(PI * light->radius * light->radius / away2, 2 * PI);
    const double cosine = bp_dot(to, eye->normal) / sqrt(away2);
    return cosine > 0 ? light->share * solid_angle * cosine / PI : 0;
}

/* The mean luminance of the picture, if nothing cast a shadow and light were scattered once; and the mean
 * variance of samples in pixels that a light fills in part. */
static double brightness(const BpPilot *pilot, double *rims) {
    const BpPilotAim *aim = pilot->aim;
    const double sky = sky_luminance(pilot->scene);
    const double squares = (double)pilot->plan.width * pilot->plan.height,
                 pixels = squares * pilot->plan.side * pilot->plan.side;
    const double paths = squares * pilot->plan.of_pixel;
    const size_t stride = pilot->eye_count / EYES + 1;
    double sum = 0, looked = 0, standing = 0, seen = 0;
    for (size_t i = 0; i < pilot->eye_count; i += stride, ++looked) {
        const BpPilotEye *eye = &pilot->eyes[i];
        const double odds = eye->share * pilot->plan.of_pixel;
        standing += odds;
        sum += odds * sky * bp_luminance_of(eye->throughput);
        for (size_t l = 0; l < aim->light_count; ++l) {
            double radiance[3];
            for (int c = 0; c < 3; ++c) radiance[c] = eye->throughput[c] * aim->lights[l].radiance[c];
            sum += odds * bp_luminance_of(radiance) * irradiance_over_pi(&aim->lights[l], eye);
        }
    }
    *rims = 0;
    for (size_t l = 0; l < aim->light_count; ++l) {
        const double y = bp_luminance_of(aim->lights[l].radiance), part = pilot->hits[l] / paths;
        seen += y * part;
        *rims += y * y * fmin(part, RIM * sqrt(part / pixels));
    }
    const double eyes = looked > 0 ? (double)pilot->eye_count / looked / paths : 0;
    return sum * eyes + sky * fmax(0, 1 - standing * eyes) + seen;
}

bool bp_pilot_focusing_pays(const BpPilot *pilot) {
    const size_t pixels = pilot->parts.chance.pixels;
    const double found = total(pilot->parts.focused.square, pixels) / (double)pixels;
    const double left = total(pilot->parts.chance.square, pixels) / (double)pixels;
    double rims;
    const double bright = brightness(pilot, &rims), rest = left + rims + ORDINARY * bright * bright;
    const double times = bp_focusers_pair(pilot->scene) ? TIMES_OF_PAIRS : TIMES;
    return found + rest > times * rest;
}
