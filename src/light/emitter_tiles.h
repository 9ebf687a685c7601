/* emitter_tiles.h -- gathers the cells of emitters into tiles. Private to src/light. */
#pragma once
#include "light/emitters.h"

/* A cell's place in its triangle. Cells stand in columns along u: column i holds
 * 2 (side - i) - 1 of them, upright ones and those turned over in turns. */
typedef struct EmitterCell {
    int  side, i, j;
    bool is_turned;
} EmitterCell;

static inline EmitterCell emitter_cell(const Emitter *emitter, uint32_t cell)
{
    int side = emitter->side, index = (int)(cell - emitter->first_cell);
    int i = side - (int)sqrtf((float)(side * side - index));
    while (i > 0 && 2 * side * i - i * i > index) i--;
    while (2 * side * (i + 1) - (i + 1) * (i + 1) <= index) i++;
    int in_column = index - (2 * side * i - i * i);
    return (EmitterCell){side, i, in_column / 2, in_column % 2};
}

/* weight: luminance x area of every cell, the sum above 0. Fills tiles and what cells know of
 * them. */
void emitter_tiles_build(const Scene *scene, const double *weight, Arena *arena,
                         Emitters *emitters);
