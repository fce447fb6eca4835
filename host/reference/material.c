/* material.c: how surfaces scatter; see trace.h. */
#include "trace.h"

static Vec albedo_of(const BpScene *scene, const Hit *hit) {
    const uint32_t own = hit->sphere != NULL     ? hit->sphere->albedo
                         : hit->triangle != NULL ? hit->triangle->albedo
                         : hit->capsule != NULL  ? hit->capsule->albedo[hit->beyond]
                                                 : BP_NO_ALBEDO;
    if (own == BP_NO_ALBEDO) return bp_ref_varied(scene, hit, BP_MEMBER_ALBEDO, hit->material->albedo);
    const float *albedo = scene->albedos[own];
    return (Vec){albedo[0], albedo[1], albedo[2]};
}

/* The first edition adds a point of the ball (a density of cosine cubed), the third and fourth a point of the
 * sphere (the cosine: Lambert's law); the third also shows a uniform hemisphere. */
static Vec scatter_lambertian(BpScatter lobe, Vec normal, Random *random) {
    if (lobe == BP_SCATTER_HEMISPHERE) {
        const Vec p = random_on_sphere(random);
        return dot(p, normal) > 0 ? p : scale(-1, p);
    }
    for (;;) {
        const Vec p = lobe == BP_SCATTER_COSINE_CUBED ? random_in_ball(random) : random_on_sphere(random);
        const Vec direction = add(normal, p);
        /* A point opposite to the normal gives no direction. The book then takes the normal. Drawing a new
         * point gives the exact distribution, and either happens once in 1e16. */
        if (length2(direction) > 1e-16) return direction;
    }
}

static Vec reflect(Vec direction, Vec normal) {
    return sub(direction, scale(2 * dot(direction, normal), normal));
}

static bool scatter_metal(const BpScene *scene, const Hit *hit, Vec direction, Random *random,
                          Vec *scattered) {
    const BpMaterial *metal = hit->material;
    const Vec normal = hit->normal;
    const double same[3] = {metal->fuzz, metal->fuzz, metal->fuzz};
    const double fuzz = fmin(bp_ref_varied(scene, hit, BP_MEMBER_FUZZ, same).x, 1);
    *scattered = unit(reflect(direction, normal));
    if (fuzz > 0) {
        const Vec p = metal->fuzz_shape == BP_FUZZ_BALL ? random_in_ball(random) : random_on_sphere(random);
        *scattered = add(*scattered, scale(fuzz, p));
    }
    return dot(*scattered, normal) > 0;
}

/* Reflection is chosen with the probability of the reflectance, otherwise the ray is refracted, so neither
 * has a weight. If no refraction is possible, the material's total_reflection alone decides; "refract" then
 * keeps the book's fabs under the root. */
static bool scatter_dielectric(const BpMaterial *glass, Vec direction, const Hit *hit, Random *random,
                               Vec *scattered) {
    if (glass->refraction_index ==
        1) { /* equal indices: there is no surface, whatever the Fresnel form says */
        *scattered = direction;
        return true;
    }
    const double ratio = hit->front_face ? 1 / glass->refraction_index : glass->refraction_index;
    const double cosine = fmin(-dot(direction, hit->normal), 1);
    const double sine2_beyond = ratio * ratio * (1 - cosine) * (1 + cosine);
    bool reflects;
    if (sine2_beyond > 1) {
        if (glass->total_reflection == BP_TOTAL_ABSORB) return false;
        reflects = glass->total_reflection == BP_TOTAL_REFLECT;
    } else {
        double reflectance = 0;
        if (glass->fresnel == BP_FRESNEL_SCHLICK) reflectance = bp_ref_schlick(cosine, ratio);
        if (glass->fresnel == BP_FRESNEL_EXACT) reflectance = bp_ref_fresnel(cosine, ratio);
        reflects = random_real(random) < reflectance;
    }
    if (reflects) {
        *scattered = reflect(direction, hit->normal);
        return true;
    }
    const Vec across = scale(ratio, add(direction, scale(cosine, hit->normal)));
    const Vec inward = scale(-sqrt(fabs(1 - sine2_beyond)), hit->normal);
    *scattered = add(across, inward);
    return true;
}

bool bp_ref_scatter(const BpScene *scene, const Ray *ray, const Hit *hit, Random *random, Vec *direction,
                    Vec *attenuation) {
    const Vec incoming = unit(ray->direction);
    switch (hit->material->kind) {
    case BP_MATERIAL_LAMBERTIAN:
        *attenuation = albedo_of(scene, hit);
        *direction = scatter_lambertian(hit->material->scatter, hit->normal, random);
        return true;
    case BP_MATERIAL_METAL:
        *attenuation = albedo_of(scene, hit);
        return scatter_metal(scene, hit, incoming, random, direction);
    case BP_MATERIAL_DIELECTRIC:
        *attenuation = (Vec){1, 1, 1};
        return scatter_dielectric(hit->material, incoming, hit, random, direction);
    case BP_MATERIAL_OREN_NAYAR:
        *attenuation = bp_ref_scatter_oren_nayar(hit->material->roughness, albedo_of(scene, hit), hit->normal,
                                                 incoming, random, direction);
        return true;
    case BP_MATERIAL_ROUGH_METAL:
        *attenuation = albedo_of(scene, hit);
        return bp_ref_scatter_rough_metal(hit->material->roughness, hit->normal, incoming, random, direction,
                                          attenuation);
    case BP_MATERIAL_GLOSSY:
        return bp_ref_scatter_glossy(hit->material->roughness, hit->material->refraction_index,
                                     albedo_of(scene, hit), hit->normal, incoming, random, direction,
                                     attenuation);
    case BP_MATERIAL_ROUGH_DIELECTRIC:
        *attenuation = (Vec){1, 1, 1};
        return bp_ref_scatter_rough_dielectric(hit->material->roughness,
                                               hit->front_face ? 1 / hit->material->refraction_index
                                                               : hit->material->refraction_index,
                                               hit->normal, incoming, random, direction, attenuation);
    case BP_MATERIAL_INTERFACE:
        *attenuation = (Vec){1, 1, 1};
        *direction = incoming;
        return true;
    case BP_MATERIAL_DIFFUSE_LIGHT:
    case BP_MATERIAL_NORMALS:
        break;
    }
    return false;
}
