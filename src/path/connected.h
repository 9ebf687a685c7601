/* SPDX-License-Identifier: Apache-2.0 */
/* connected.h -- which ways of light from a lamp to a surface paths connect, and which they
 * leave to chance: the one place that says so.
 *
 * A lamp without a surface is met by no chance: light of its that no connection finds is lost.
 * That of the sun and of emitters is met by few of a million paths.
 */
#pragma once
#include "path/path_context.h"

typedef enum ChainLight { CHAIN_SUN, CHAIN_LAMP, CHAIN_EMITTER } ChainLight; /* lamp: punctual */

/* The smooth boundaries between a light and the first surface that scatters it; what passes
 * thin windows straight on is no event. */
typedef struct LightChain {
    ChainLight from;
    int mirrors; /* met in air, about the interpolated normal */
    int plates;  /* solids crossed straight by two flat parallel faces */
    int others;  /* wedges and curved solids, inner reflections, bent normals, ends in a solid */
    bool is_compact; /* of an emitter (light/compact_emitters.h) */
} LightChain;

static inline bool chain_is_connected(const PathContext *context, const LightChain *chain) {
    if (chain->others) return false;
    if (!chain->mirrors) return chain->from != CHAIN_EMITTER || !chain->plates;
    if (chain->from == CHAIN_SUN && !context->beams[BEAMS_OF_SUN].mirrors)
        return false; /* --no-mirrors */
    if (chain->from == CHAIN_EMITTER && !chain->is_compact) return false;
    return chain->mirrors == 1 && !chain->plates;
}
