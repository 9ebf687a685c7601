/* SPDX-License-Identifier: Apache-2.0 */
/* distant.h -- distant light as a question: from which directions does it reach the eye, or a
 * luxmeter, and how much of it? The path samples it instead of being lit.
 *
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_collector.h"

#define PATH_WAYS 16 /* from a vertex: a ray or two each, beside hundreds of its questions */

typedef struct PathDistant {
    const Vec3 *towards; /* unit; every scattering vertex samples all of them */
    int count;
    /* share: of the radiance from towards[i], per steradian, what comes to the eye via
     * vertex `bounce` (0: the first surface that scatters), per lane; of a luxmeter to
     * tristimulus values in lx. pdf: with which ways find that direction from there, too,
     * sr^-1; 0: none does. */
    void (*add)(void *user, int i, int bounce, const float *share, float pdf);
    /* Paths that leave by a mirror or straight on, after `bounce` vertices: share of the
     * radiance from there. pdf: 0, or of a way that left by a sharp lobe, sr^-1. */
    void (*add_escaped)(void *user, Vec3 direction, int bounce, const float *share, float pdf);
    void *user;
    /* Where a display comes first its mirror alone is followed, as far as its direction is
     * asked for. NULL: the mirror is nothing special. */
    bool (*asks_mirror)(void *user, Vec3 direction);
    bool has_ways; /* vertices send out PATH_WAYS rays each, which follow mirrors and sharp
                      lobes: what leaves the scene so is added for these, not for paths */
} PathDistant;

typedef struct DistantCollector {
    PathCollector base;
    const PathDistant *distant;
    bool sent_ways; /* from the last vertex that scattered; mirrors may lie between */
} DistantCollector;

/* The path must be dark (PathManner). */
DistantCollector distant_collector(const PathDistant *distant);
