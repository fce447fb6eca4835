/* fresnel.cl: how much light the border of two clear media reflects.
 *
 * In:    the cosine of incidence, the ratio of the indices.   Out: a reflectance.
 * Knows: real.cl.   Does not know: lobes. */
#if EFFECT_DIELECTRIC || EFFECT_GLOSSY || EFFECT_ROUGH_DIELECTRIC
/* Reflectance of unpolarised light. c: cosine of incidence, in [0, 1]; n: index of the far over the near side;
 * t: cosine of refraction. Fresnel's equations (M. Born and E. Wolf, Principles of Optics, 1.5.2). */
static vreal fresnel_exact(vreal c, vreal n, vreal t) {
    const vreal across = divide(c - n * t, c + n * t);
    const vreal along = divide(n * c - t, n * c + t);
    return R(0.5) * fma(across, across, along * along);
}
#endif
