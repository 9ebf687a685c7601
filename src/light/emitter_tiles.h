/* emitter_tiles.h -- gathers the cells of emitters into tiles. Private to src/light. */
#pragma once
#include "light/emitters.h"

/* weight: luminance x area of every cell, the sum above 0. Fills tiles and what cells know of
 * them. */
void emitter_tiles_build(const Scene *scene, const double *weight, Arena *arena,
                         Emitters *emitters);
