/* analytic.c: see analytic.h. Every expectation is worked out here, from the optics, not by a tracer. */
#include "analytic.h"

#include <math.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;

static void set(double v[3], double x, double y, double z) {
    v[0] = x;
    v[1] = y;
    v[2] = z;
}

static void name_case(AnalyticCase *analytic, const char *name, const char *variant, double number) {
    built_scene_init(&analytic->built);
    snprintf(analytic->name, sizeof analytic->name, "%s %s %g", name, variant, number);
}

static void sky(AnalyticCase *analytic, double bottom, double top) {
    for (int c = 0; c < 3; ++c) {
        analytic->built.scene.background_bottom[c] = bottom;
        analytic->built.scene.background_top[c] = top;
    }
}

/* The sky's value in a direction, sky(0, 1): half of 1 + y. */
static double height(double y, double length) {
    return 0.5 * (1 + y / length);
}

static const char *lobe_names[3] = {"lambertian", "cosine cubed", "hemisphere"};
/* The mean cosine of each lobe: 2/3, 4/5, 1/2. */
static const double lobe_cosine[3] = {2.0 / 3, 4.0 / 5, 0.5};

/* Inside an emitting sphere every segment adds E and keeps rho: E (1 - rho^K) / (1 - rho) after K of them. */
static void furnace(AnalyticCase *analytic, int lobe, uint32_t depth) {
    name_case(analytic, "furnace", lobe < 3 ? lobe_names[lobe] : "mirror", depth);
    BpMaterial *material;
    const double rho[3] = {0.3, 0.6, 0.9}, emit[3] = {1, 0.5, 2};
    built_material(&analytic->built, lobe < 3 ? BP_MATERIAL_LAMBERTIAN : BP_MATERIAL_METAL, 0, &material);
    material->scatter = lobe < 3 ? (BpScatter)lobe : BP_SCATTER_LAMBERTIAN;
    for (int c = 0; c < 3; ++c) {
        material->albedo[c] = rho[c];
        material->emit[c] = emit[c];
        analytic->expected[c] = emit[c] * (1 - pow(rho[c], depth)) / (1 - rho[c]);
    }
    built_sphere(&analytic->built, 0.3, -0.2, 0.1, 2, 0);
    analytic->built.scene.camera.max_depth = depth;
}

/* A matte sphere in a sky that grows with height: rho times the sky at the lobe's mean cosine along the
 * normal. The ray meets a sphere of radius 2 at a point whose normal is (sin, cos) of the angle from the
 * upright. */
static void matte_in_gradient(AnalyticCase *analytic, int lobe, double degrees) {
    name_case(analytic, "matte in gradient", lobe_names[lobe], degrees);
    BpMaterial *material;
    built_material(&analytic->built, BP_MATERIAL_LAMBERTIAN, 0.7, &material);
    material->scatter = (BpScatter)lobe;
    const double y = cos(degrees * pi / 180), z = sin(degrees * pi / 180);
    built_sphere(&analytic->built, 0, -2 * y, -5 - 2 * z, 2, 0);
    BpCamera *camera = &analytic->built.scene.camera; /* the point hit is (0, 0, -5), from straight outside */
    set(camera->lookfrom, 0, 4 * y, -5 + 4 * z);
    set(camera->lookat, 0, 0, -5);
    set(camera->vup, 1, 0, 0);
    sky(analytic, 0, 1);
    for (int c = 0; c < 3; ++c) analytic->expected[c] = 0.7 * height(lobe_cosine[lobe] * y, 1);
}

/* A lamp of radius R, its centre d away at an angle from the normal, wholly above the horizon, covers
 * (R/d)^2 cos of a Lambertian lobe (its projected solid angle over pi). */
static void lamp_over_matte(AnalyticCase *analytic, double degrees) {
    name_case(analytic, "lamp over", "matte", degrees);
    BpMaterial *lamp;
    built_material(&analytic->built, BP_MATERIAL_LAMBERTIAN, 0.5, NULL);
    built_material(&analytic->built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &lamp);
    set(lamp->emit, 4, 8, 2);
    const double distance = 3, radius = 0.9, angle = degrees * pi / 180;
    built_sphere(&analytic->built, 0, -1, 0, 1, 0); /* its top is the origin */
    built_sphere(&analytic->built, distance * sin(angle), distance * cos(angle), 0, radius, 1);
    BpCamera *camera = &analytic->built.scene.camera;
    set(camera->lookfrom, -2, 1, 0);
    set(camera->lookat, 0, 0, 0);
    sky(analytic, 0, 0);
    for (int c = 0; c < 3; ++c)
        analytic->expected[c] = 0.5 * lamp->emit[c] * pow(radius / distance, 2) * cos(angle);
}

/* A mirror turns a fixed ray by twice its incidence: the sky shows where to. */
static void mirror(AnalyticCase *analytic, double degrees) {
    name_case(analytic, "mirror", "in gradient", degrees);
    built_material(&analytic->built, BP_MATERIAL_METAL, 0.8, NULL);
    const double angle = degrees * pi / 180;
    /* Incidence at (0, 0, -3) on a sphere whose normal there leans upwards by the angle. */
    built_sphere(&analytic->built, 0, -sin(angle), -3 - cos(angle), 1, 0);
    sky(analytic, 0, 1);
    for (int c = 0; c < 3; ++c) analytic->expected[c] = 0.8 * height(sin(2 * angle), 1);
}

/* What is lost below the surface of a metal of fuzz f at the cosine c, x = c / f < 1: the part of the fuzz
 * sphere, or ball, below the height -c: (1 - x) / 2 and (2 - 3 x + x^3) / 4. */
static void fuzz_loss(AnalyticCase *analytic, BpFuzzShape shape, double fuzz, double degrees) {
    name_case(analytic, "fuzz loss", shape == BP_FUZZ_SPHERE ? "sphere" : "ball", degrees);
    BpMaterial *material;
    built_material(&analytic->built, BP_MATERIAL_METAL, 0.9, &material);
    material->fuzz = fuzz;
    material->fuzz_shape = shape;
    const double angle = degrees * pi / 180, x = fmin(1, cos(angle) / fuzz);
    built_sphere(&analytic->built, 0, -sin(angle), -3 - cos(angle), 1, 0);
    const double lost = shape == BP_FUZZ_SPHERE ? (1 - x) / 2 : (2 - 3 * x + x * x * x) / 4;
    for (int c = 0; c < 3; ++c) analytic->expected[c] = 0.9 * (1 - lost);
}

static double fresnel_by_angles(double incident, double n) { /* Fresnel's sine and tangent laws, entering */
    if (incident < 1e-9) return pow((n - 1) / (n + 1), 2);
    const double beyond = asin(sin(incident) / n);
    return 0.5 * (pow(sin(incident - beyond) / sin(incident + beyond), 2) +
                  pow(tan(incident - beyond) / tan(incident + beyond), 2));
}
static double schlick(double cosine, double n) {
    return pow((n - 1) / (n + 1), 2) * (1 - pow(1 - cosine, 5)) + pow(1 - cosine, 5);
}

/* A glass sphere in a unit sky weakens nothing; what is missing is cut by the depth limit K: a ray that
 * enters (1 - F) and is still inside after K segments has been reflected inside K - 2 times. */
static void glass_depth(AnalyticCase *analytic, BpFresnel fresnel, double n, double degrees, uint32_t depth) {
    name_case(analytic, fresnel == BP_FRESNEL_EXACT ? "glass exact" : "glass Schlick", "cut at", depth);
    BpMaterial *material;
    built_material(&analytic->built, BP_MATERIAL_DIELECTRIC, 1, &material);
    material->refraction_index = n;
    material->fresnel = fresnel;
    const double angle = degrees * pi / 180, inside_cosine = sqrt(1 - pow(sin(angle) / n, 2));
    built_sphere(&analytic->built, 0, -sin(angle), -3 - cos(angle), 1, 0);
    analytic->built.scene.camera.max_depth = depth;
    const double outside = fresnel == BP_FRESNEL_EXACT ? fresnel_by_angles(angle, n) : schlick(cos(angle), n);
    const double inside = fresnel == BP_FRESNEL_EXACT ? outside : schlick(inside_cosine, n);
    const double cut = (1 - outside) * pow(inside, depth - 2.0);
    for (int c = 0; c < 3; ++c) analytic->expected[c] = 1 - cut;
}

/* Through a sphere without reflections: a ray turns by incidence minus refraction twice. With a hollow inside
 * (radius times q) it meets four surfaces; entering the hollow at sine s / q, it turns there by the
 * difference of the angles outside and inside, the other way. */
static void glass_deflection(AnalyticCase *analytic, double n, double sine, double hollow, double radius) {
    name_case(analytic, "deflection", hollow > 0 ? "hollow" : "solid", hollow > 0 ? hollow : n);
    BpMaterial *material;
    built_material(&analytic->built, BP_MATERIAL_DIELECTRIC, 1, &material);
    material->refraction_index = n;
    material->fresnel = BP_FRESNEL_NONE;
    built_sphere(&analytic->built, 0, -sine * radius, -4, radius, 0);
    double turned = 2 * (asin(sine) - asin(sine / n));
    if (hollow > 0) {
        /* In the shell the impact parameter over the hollow's radius is sine / (n q), in the hollow sine / q.
         */
        turned -= 2 * (asin(sine / hollow) - asin(sine / (n * hollow)));
        built_sphere(&analytic->built, 0, -sine * radius, -4, -hollow * radius, 0);
    }
    sky(analytic, 0, 1);
    for (int c = 0; c < 3; ++c) analytic->expected[c] = height(-sin(turned), 1);
}

/* A bubble: index 1 / n. The ray bends away from the axis; beyond the critical angle nothing goes in. */
static void bubble_total_reflection(AnalyticCase *analytic, BpTotalReflection total) {
    static const char *names[3] = {"reflect", "absorb", "refract"};
    name_case(analytic, "total reflection", names[total], 0);
    BpMaterial *material;
    built_material(&analytic->built, BP_MATERIAL_DIELECTRIC, 1, &material);
    material->refraction_index = 0.5;
    material->fresnel = BP_FRESNEL_NONE;
    material->total_reflection = total;
    const double angle = 50 * pi / 180; /* sin 50 / 0.5 = 1.53 */
    built_sphere(&analytic->built, 0, -sin(angle), -3 - cos(angle), 1, 0);
    sky(analytic, 0, 1);
    double value = 0;
    if (total == BP_TOTAL_REFLECT) value = height(sin(2 * angle), 1);
    if (total == BP_TOTAL_REFRACT) {
        /* ratio (d + cos n) - sqrt |1 - sin^2| n, with d = (0, 0, -1) and n = (0, sin, cos): then, from the
         * point hit, through the inside; the chord's far end is met from within at a cosine that always lets
         * it out. */
        const double ratio = 2, c = cos(angle), s = sin(angle), fall = sqrt(ratio * ratio * s * s - 1);
        const double across_y = ratio * c * s, across_z = ratio * (c * c - 1);
        const double y = across_y - fall * s, z = across_z - fall * c, length = sqrt(y * y + z * z);
        /* Inside, incidence on the far side has the same cosine as leaving the near one. */
        const double cosine = (-(y * s + z * c)) / length, sine = sqrt(1 - cosine * cosine);
        /* It leaves by Snell's law with ratio 1 / 2, turned by asin(sine) - asin(sine / 2), towards the
         * outward normal. */
        const double direction = atan2(y, -z);
        const double turn_back = asin(sine) - asin(sine / 2);
        /* The path bends the same sense as at entry: seen from the centre, it runs on around the side it came
         * in by. */
        const double normal_far = atan2(s + 2 * cosine * y / length, -(c + 2 * cosine * z / length));
        const double side = sin(normal_far - direction) > 0 ? 1 : -1;
        value = height(sin(direction + side * turn_back), 1);
    }
    for (int c = 0; c < 3; ++c) analytic->expected[c] = value;
}

/* A surface that shows its normal, plus what it emits. */
static void normals(AnalyticCase *analytic, double radius) {
    name_case(analytic, "normals", radius > 0 ? "outside" : "turned inside out", radius);
    BpMaterial *material;
    built_material(&analytic->built, BP_MATERIAL_NORMALS, 0, &material);
    set(material->emit, 0.25, 0, 1);
    built_sphere(&analytic->built, -0.48, -0.6, -3 - 0.64, radius,
                 0); /* normal (0.48, 0.6, 0.64) where hit */
    set(analytic->expected, 0.25 + 0.74, 0.8, 1 + 0.82);
}

/* A lens leaves what is in focus sharp: a lamp that fills the pixel's point in focus, and blurs the rest: in
 * front of it, at distance t, the disk of confusion has radius lens (1 - t / focus); a lamp ball there that
 * is small against it covers (R / confusion)^2 of it (its tilt against the axis is of second order and kept
 * below the noise). */
static void lens(AnalyticCase *analytic, bool in_focus) {
    name_case(analytic, "lens", in_focus ? "in focus" : "out of focus", 0);
    BpMaterial *lamp;
    built_material(&analytic->built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &lamp);
    set(lamp->emit, 1, 2, 3);
    BpCamera *camera = &analytic->built.scene.camera;
    camera->focus_dist = 10;
    camera->lens_radius = 0.2;
    camera->vfov_degrees = 1;
    sky(analytic, 0, 0);
    if (in_focus) {
        built_sphere(&analytic->built, 0, 0, -10, 0.001, 0); /* every ray passes its centre */
        set(analytic->expected, 1, 2, 3);
    } else {
        built_sphere(&analytic->built, 0, 0, -5, 0.02, 0);
        /* The rays that meet the ball start within the lens where the distance from its centre to the ray is
         * below 0.02: at a lens radius p the ray (p (1 - t/10), t) passes the centre at p/2 cos(atan(p/10)).
         */
        const double p2 = 0.02 * 0.02 / (0.25 - 0.02 * 0.02 / 100);
        const double share = p2 / (0.2 * 0.2);
        set(analytic->expected, share, 2 * share, 3 * share);
    }
}

/* The open sky through one pixel of a larger picture: where the camera points, worked out by angles. */
static void view(AnalyticCase *analytic, uint32_t width, uint32_t height_pixels) {
    name_case(analytic, "view", "of the sky", width);
    BpCamera *camera = &analytic->built.scene.camera;
    camera->width = width;
    camera->height = height_pixels;
    camera->aspect_ratio = (double)width / height_pixels;
    camera->vfov_degrees = 40;
    set(camera->lookfrom, 1000, -2000, 3000);
    set(camera->lookat, 1000, -2000, 3001);
    camera->focus_dist = 7;
    sky(analytic, 0, 1);
    double sum = 0;
    for (uint32_t row = 0; row < height_pixels; ++row)
        for (uint32_t column = 0; column < width; ++column) {
            const double half = tan(20 * pi / 180), step = 2 * half / height_pixels;
            const double y = half - (row + 0.5) * step, x = (column + 0.5 - 0.5 * width) * step;
            sum += height(y, sqrt(1 + x * x + y * y));
        }
    for (int c = 0; c < 3; ++c) analytic->expected[c] = sum / (width * height_pixels);
    analytic->built.scene.background_bottom[0] =
        0.25; /* red grows by a fourth where the others start from black */
    analytic->expected[0] = 0.25 + 0.75 * analytic->expected[1];
}

/* Two equal spheres in one place: the first wins the tie. */
static void tie(AnalyticCase *analytic, bool other_first) {
    name_case(analytic, "tie", "first sphere wins", other_first);
    BpMaterial *red, *blue;
    built_material(&analytic->built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &red);
    built_material(&analytic->built, BP_MATERIAL_DIFFUSE_LIGHT, 0, &blue);
    set(red->emit, 1, 0, 0);
    set(blue->emit, 0, 0, 1);
    built_sphere(&analytic->built, 0, 0, -3, 1, other_first);
    built_sphere(&analytic->built, 0, 0, -3, 1, !other_first);
    set(analytic->expected, !other_first, 0, other_first);
}

bool analytic_case(size_t index, AnalyticCase *analytic) {
    static const uint32_t depths[4] = {1, 2, 5, 50};
    static const double tilts[4] = {0, 60, 90, 140};
    size_t i = index;
    if (i < 16) return furnace(analytic, (int)(i / 4), depths[i % 4]), true;
    i -= 16;
    if (i < 12) return matte_in_gradient(analytic, (int)(i / 4), tilts[i % 4]), true;
    i -= 12;
    if (i < 3) return lamp_over_matte(analytic, 0 + 30 * (double)i), true;
    i -= 3;
    if (i < 3) return mirror(analytic, 5 + 35 * (double)i), true;
    i -= 3;
    if (i < 6) return fuzz_loss(analytic, (BpFuzzShape)(i / 3), 0.8, (double[]){20, 60, 80}[i % 3]), true;
    i -= 6;
    if (i < 2) return fuzz_loss(analytic, (BpFuzzShape)i, 1.0, 45), true;
    i -= 2;
    if (i < 3) return glass_depth(analytic, BP_FRESNEL_EXACT, 1.5, 70, (uint32_t)i + 2), true;
    i -= 3;
    if (i < 3) return glass_depth(analytic, BP_FRESNEL_SCHLICK, 1.5, 75, (uint32_t)i + 2), true;
    i -= 3;
    if (i < 2) return glass_depth(analytic, BP_FRESNEL_EXACT, 2.42, 5, (uint32_t)i + 2), true;
    i -= 2;
    if (i < 3) return glass_deflection(analytic, (double[]){1.5, 1.33, 1.0}[i], 0.6, 0, 1), true;
    i -= 3;
    /* Shells down to a gap of 1e-5 of the radius. */
    if (i < 3) return glass_deflection(analytic, 1.5, 0.5, (double[]){0.8, 0.9998, 0.99999}[i], 0.5), true;
    i -= 3;
    if (i < 3) return bubble_total_reflection(analytic, (BpTotalReflection)i), true;
    i -= 3;
    if (i < 2) return normals(analytic, i == 0 ? 1 : -1), true;
    i -= 2;
    if (i < 2) return lens(analytic, i == 0), true;
    i -= 2;
    if (i < 3) return view(analytic, (uint32_t[]){1, 7, 16}[i], (uint32_t[]){1, 3, 9}[i]), true;
    i -= 3;
    if (i < 2) return tie(analytic, i == 1), true;
    return false;
}
