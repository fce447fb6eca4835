/* roulette_types.h: the paths for which Russian roulette is played, and what they carry after it.
 *
 * Read by both compilers: kernels play it (integrator/roulette.cl), and the host bounds what samples can be
 * by it (film/film_scene.c). */
#ifndef BP_ROULETTE_TYPES_H
#define BP_ROULETTE_TYPES_H

/* Those that have so many segments already, */
#define ROULETTE_SEGMENTS 8u
/* and carry less of each colour than this, a power of 2. Those that go on carry no more than this. */
#define ROULETTE_LIMIT 0x1p-6f

#endif
