/* SPDX-License-Identifier: Apache-2.0 */
/* sun_searches.h -- searches for suns in mirrors (false_suns.h) that are kept: one serves all
 * gazes, moments and sweeps in which the same eye sees the same scene.
 *
 * A search takes some 2 million rays; neither the sun nor any other light has a part in it.
 * Where lessons are kept, in a review that machines share, the setup's journal keeps it, too.
 *
 * Memory   of what is kept: the arena of sun_searches_start, until sun_searches_end.
 * Threads  one at a time; a search starts its own. The same figures for any count.
 */
#pragma once
#include "review/light/false_suns.h"

typedef struct SunSearch SunSearch;

/* For one request. */
typedef struct SunSearches {
    Arena      arena;
    SunSearch *last;
} SunSearches;

SunSearches sun_searches_start(void);
void        sun_searches_end(SunSearches *searches);

/* The setup's scene, lit or dark, as the eye (m, world) sees it: found before, or now. */
const FalseSunRays *sun_searches_ask(SunSearches *searches, const Setup *setup, Vec3 eye);
