/* segment.cl: where the next segment of a path ends: at a surface, at the shadow catcher, in a medium, or nowhere.
 *
 * In:    paths, their rays, and the surfaces that these hit.   Out: the end of each; what media leave of the light.
 * Knows: shadow_catcher.cl, flight.cl.   Does not know: surfaces, the sky. */
ON_CHAINS static Segment end_segment(const Scene *scene, const Ray *ray, const Hit *hit, vbool moving, Path *path) {
    Segment end;
    vreal length = to_real(hit->t);
    const vbool at_catcher = meets_catcher(scene, path, hit, moving, &length);
    path->depth = choose_uint(moving, path->depth + 1u, path->depth);
    find_media(scene, ray, WITH_HIT(hit) moving, path);
    vreal flown = length;
    end.scattered = fly(scene, moving, length, path, &flown);
    const vbool arrived = moving & vbool_not(end.scattered);
    end.caught = arrived & at_catcher;
    end.dark = lies_in_shadow(scene, path, end.caught, length);
    end.met = arrived & is_hit(hit) & vbool_not(end.caught);
    end.escaped = arrived & vbool_not(end.met);
    end.entered = hit->enters;
    end.distance = choose_refined(end.caught | end.scattered, to_refined(flown), hit->t);
    return end;
}
