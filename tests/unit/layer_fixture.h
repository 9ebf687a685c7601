/* SPDX-License-Identifier: Apache-2.0 */
/* layer_fixture.h -- stacks of layers that coated surfaces are tried with. */
#pragma once
#include "base/arena.h"
#include "spectrum/thin_film.h"

static inline void fill_constant(Curve *curve, double value) {
    for (int i = 0; i < CURVE_COUNT; i++) curve->value[i] = (float)value;
}

static inline OpticalConstants *constants_of(double n, double k, Arena *arena) {
    OpticalConstants *index = ARENA_NEW(arena, OpticalConstants, 1);
    fill_constant(&index->n, n);
    fill_constant(&index->k, k);
    return index;
}

/* media: n, k and thickness of each, from outside inwards. */
static inline LayerStack *stack_of(int count, const ThinMedium *media, Arena *arena) {
    LayerStack *stack = ARENA_NEW(arena, LayerStack, 1);
    ThinLayer *layer = ARENA_NEW(arena, ThinLayer, count + 1);
    for (int i = 0; i < count; i++) {
        layer[i].index = *constants_of(media[i].n, media[i].k, arena);
        layer[i].thickness_nm = media[i].thickness_nm;
    }
    *stack = (LayerStack){.outside = 1, .layers = layer, .count = count};
    return stack;
}

/* Four clear layers, of some colour. */
static inline LayerStack *stack_four(Arena *arena) {
    return stack_of(
        4, (ThinMedium[]){{1.38, 0, 92.1}, {2.1, 0, 115.5}, {1.65, 0, 58.8}, {1.46, 0, 140.3}},
        arena);
}

/* Silver between two oxides: it absorbs. */
static inline LayerStack *stack_silver(Arena *arena) {
    return stack_of(3, (ThinMedium[]){{2.4, 0, 18}, {0.05, 3.5, 18}, {2.4, 0, 18}}, arena);
}
