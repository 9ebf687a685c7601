/* SPDX-License-Identifier: Apache-2.0 */
/* luminaire_doubts.h -- what a luminaire's table leaves open or says twice, and whether its
 * light can be: angles that leave directions out, one direction with several intensities, more
 * light than its lamps have.
 *
 * Memory   the arena's. Threads: no shared state. Fails: never.
 */
#pragma once
#include "import/luminaire/luminaire.h"

#define LUMINAIRE_FLUX_MOST 1.05 /* times the light that the file states */

/* Of what the file states a luminaire takes no more, snoots among them; coarse angles miss less. */
#define LUMINAIRE_TAKES_MOST 0.99

/* Adds to the luminaire's doubts. */
void luminaire_doubts_find(Luminaire *luminaire, Arena *arena);
