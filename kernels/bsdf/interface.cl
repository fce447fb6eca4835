/* interface.cl: a surface that does nothing to light: the boundary of a medium.
 *
 * In and out: as bsdf.cl says.   Knows: bsdf.cl.   Does not know: other lobes, media. */
#if EFFECT_MEDIA
static BsdfSample interface_sample(const Surface *surface, SampleKey key, vuint bounce) {
    BsdfSample sample = bsdf_sample_reflected(surface, surface->incoming);
    sample.transmitted = vbool_all;
    return sample;
}
#endif
