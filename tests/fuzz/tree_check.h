/* tree_check.h: what every packed scene must be (host/packed/tree.h, pack.h), for the fuzz targets. */
#ifndef BP_FUZZ_TREE_CHECK_H
#define BP_FUZZ_TREE_CHECK_H

#include "fuzz.h"
#include "packed/tree.h"

/* Packs the scene, which is valid, and stops the fuzzer unless: every sphere stands in exactly one slot, with
 * its numbers rounded as tree_write.c says; every node and leaf is met exactly once from the root, no deeper
 * than TREE_DEPTH_MAX; every box contains what lies below it, as the scene has it and as it is stored, with
 * the margin that the kernel's intersection needs; and the camera stays on its side of every sphere. */
void check_packed(const BpScene *scene, const BpTreeOptions *options);

#endif
