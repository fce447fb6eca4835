/* path_state.cl: the state of the paths that a work-item follows, one a lane.
 *
 * Out:   Path and Segment, and what else reads members that only some scenes' paths have.
 * Knows: ray.cl, sampler.cl, bsdf.cl.   Does not know: what changes the state (path.cl, bounce.cl). */

/* How the latest segment of a path ended, in the lanes that moved. Where a scene has no media or no catcher, none ends there. */
typedef struct Segment {
    vbool met, entered; /* a surface; from its outside */
    vbool scattered;    /* in a medium */
    vbool caught, dark; /* at the shadow catcher; in shadow there */
    vbool escaped;      /* nowhere: it sees the background; so does what ends at the catcher */
    vrefined distance;
} Segment;

typedef struct Path {
    Point origin;
    Vec3 direction;
    Vec3 throughput, radiance;
    SampleKey key;
    vuint depth;    /* ray segments traced; of a path that its camera ray ended in the open, with MISSED_MARK */
    vuint own_slot; /* of the sphere being left */
    vbool inward;   /* it is left into its inside */
    vbool alive;
    Segment latest;
#if PILOT
    uint evenly; /* see Surface; all lanes */
    vreal odds;  /* of paths that choose so: how much more often a picture's path would have come the same way */
#endif
#if EFFECT_MOTION
    vreal time;
#endif
#if EFFECT_MEDIA
    vuint medium;    /* that it flies through */
    vbool unsure;    /* it may be another now */
    Vec3 likelihood; /* flight.cl */
#if MEDIA_IN_TRIANGLES
    vuint bodies; /* that it is in, a bit each */
#endif
#endif
#if SAMPLES_LAMPS
    Lobe lobe;          /* that `direction` was drawn from; of LOBE_NONE where no lamp is sampled */
    vbool wants_lamps;  /* its latest vertex is still to be lit; a path that is not alive may want that too */
    vreal lamp_sum;     /* of importance, seen from the latest vertex: lamps.cl */
    uint lamp_rays;     /* sent by all lanes, since path_none */
    vuint lamp_slot, seen_slot; /* for path_log.cl: the lamp that the vertex was to be lit by, or NO_SLOT, and what stands in front */
#endif
#if WEIGHTED_LOBES
    Vec3 arrived; /* the throughput before the latest vertex scattered it */
#endif
#if LAMPS_THROUGH_MEDIA
    Point vertex;      /* the latest, where `lobe` is: the boundaries of media that the path passes are none */
    vuint vertex_slot; /* of the sphere that was left there */
#endif
#if SAMPLES_CAUSTICS
    vuint chain; /* that it follows from a vertex through a focuser, or CHAIN_NONE */
    Focus focus; /* of that chain */
#endif
#if SAMPLES_PAIRS
    vuint second;        /* of a chain through two focusers: the second one */
    vuint first_chords;  /* inside the first one */
    Vec3 chain_begins;   /* the direction from the vertex */
    vreal pair_density;  /* of that, over the probability of choosing the focusers */
#endif
} Path;

/* When the path is, from 0 where the shutter opens to 1: where nothing moves, always 0. */
#if EFFECT_MOTION
#define path_time(path) ((path)->time)
#else
#define path_time(path) splat(0)
#endif

#if LAMPS_THROUGH_MEDIA
#define vertex_of(path) (&(path)->vertex)
#define vertex_slot_of(path) ((path)->vertex_slot)
#else
#define vertex_of(path) (&(path)->origin)
#define vertex_slot_of(path) ((path)->own_slot)
#endif
