/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/facets/index_tables.h"

#define STENCIL 4

/* Weights of four neighbouring nodes at an index: 1 and 0 to the bit at a node. */
static int weights_at(float ior, double weight[STENCIL]) {
    int first = 0;
    while (first < INDEX_NODES - STENCIL && ior >= index_nodes[first + 2]) first++;
    for (int i = 0; i < STENCIL; i++) {
        double here = (double)index_nodes[first + i];
        weight[i] = 1;
        for (int j = 0; j < STENCIL; j++) {
            double other = (double)index_nodes[first + j];
            if (j != i) weight[i] *= ((double)ior - other) / (here - other);
        }
    }
    return first;
}

static float mixed(const float *const shape[STENCIL], const double weight[STENCIL], int at) {
    double sum = 0;
    for (int i = 0; i < STENCIL; i++) sum += weight[i] * (double)shape[i][at];
    return clampf((float)sum, 0, 1);
}

static void mix_row(Energy *row, int count, const float *const shape[STENCIL],
                    const double weight[STENCIL]) {
    for (int i = 0; i < count; i++) row[i].shape = mixed(shape, weight, i);
}

const EnergyTable *energy_table_of(float ior, Arena *arena) {
    if (ior == common_energy_table.ior) return &common_energy_table;
    if (!(ior >= index_nodes[0] && ior <= index_nodes[INDEX_NODES - 1]))
        return energy_table_build(ior, arena);
    EnergyTable *table = ARENA_NEW(arena, EnergyTable, 1);
    double weight[STENCIL];
    const float *average[STENCIL], *directional[STENCIL];
    int first = weights_at(ior, weight);
    *table = common_energy_table; /* with `all`, which no index changes */
    table->ior = ior;
    for (int i = 0; i < STENCIL; i++) {
        average[i] = common_index_shapes[first + i].average;
        directional[i] = common_index_shapes[first + i].directional[0];
    }
    mix_row(table->average, ENERGY_ALPHAS, average, weight);
    mix_row(table->directional[0], ENERGY_ALPHAS * ENERGY_COSINES, directional, weight);
    return table;
}
