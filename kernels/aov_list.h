/* aov_list.h: the AOVs, in one list that both compilers read: what a pixel shows first, beside its radiance.
 *
 * From it come the places in the kernel's sums (entry/aovs.cl), their reading into the picture
 * (render/aovs.c), the release of its arrays (image/picture.c), the channels of an EXR (image/exr.c) and the
 * arrays of films and their files (film/film_aovs.c, film_file.c). A
 * new AOV is a line here, its values in entry/aovs.cl, and an array of floats in BpPicture.
 *
 * X(place, member, floats, mean, channels): the kernel sums `floats` numbers from AOV_<place> on. BpPicture
 * has them in `member`: their mean over the rays that met something (MET; +Inf where none did) or over all
 * rays (ALL). The channels of an EXR are <member>.<letter>, a letter of `channels` each. */
#ifndef AOV_LIST_H
#define AOV_LIST_H

#define AOV_LIST(X)                                                                                          \
    X(DEPTH, depth, 1, MET, "Z")                                                                             \
    X(NORMAL, normal, 3, ALL, "XYZ")                                                                         \
    X(ALBEDO, albedo, 3, ALL, "RGB")

/* Places in the sums of a pixel. Behind the AOVs stands how many rays met something. */
enum {
#define AOV_PLACE(place, member, floats, mean, channels)                                                     \
    AOV_##place, AOV_##place##_LAST = AOV_##place + (floats)-1,
    AOV_LIST(AOV_PLACE)
#undef AOV_PLACE
        AOV_MET,
    AOV_FLOATS
};

#endif
