/* particle_cache.h: files of particles that stay open from frame to frame.
 *
 * In:    the node that names a file, how its particles look.   Out: the file, open.
 * Knows: which columns a look needs.   Does not know: what is read from the file. */
#ifndef BP_FORMATS_PARTICLE_CACHE_H
#define BP_FORMATS_PARTICLE_CACHE_H

#include "document.h"
#include "particles/particles.h"
#include "particles/style.h"

/* Files of particles that stay open, so that a trajectory is read once for all its frames. Zero-initialise
 * it. */
enum { BP_PARTICLE_CACHE_SIZE = 16 };
typedef struct BpParticleCache {
    struct {
        char *path;
        FILE *stream;
        struct BpParticleFile *file;
    } entry[BP_PARTICLE_CACHE_SIZE];
    size_t count;
} BpParticleCache;
void bp_particle_cache_clear(BpParticleCache *cache);

/* The file of entry `place` of "particles", from the cache, or opened and left in it, where there must be
 * room. It is the cache's. */
BpStatus bp_particle_cache_open(const BpNode *file_node, const char *path, const BpParticleStyle *style,
                                size_t place, BpParticleCache *cache, BpParticleFile **file, BpError *err);

#endif
