/* SPDX-License-Identifier: Apache-2.0 */
/* index_tables.h -- the tables of energy.h for any index of refraction, most of them at once.
 *
 * Only the Fresnel curve's shape depends on the index. It is computed when the program is built
 * for INDEX_NODES indices (tables/make_tables.c); between those it is Lagrange's cubic through
 * four neighbours, at most 2e-5 away from what energy_table_build gives. A node's own table has
 * the bits of energy_table_build; outside the nodes the table is computed.
 *
 * Memory   about 31 KiB in the caller's arena, none for 1.5. Threads: const once built.
 * Fails    never.
 */
#pragma once
#include "shaders/facets/energy.h"

#define INDEX_NODES 15

/* One index's shapes, average and directional as in EnergyTable. */
typedef struct IndexShapes {
    float average[ENERGY_ALPHAS];
    float directional[ENERGY_ALPHAS][ENERGY_COSINES];
} IndexShapes;

extern const float index_nodes[INDEX_NODES]; /* rising */
extern const IndexShapes common_index_shapes[INDEX_NODES];

/* ior as energy_table_build. */
const EnergyTable *energy_table_of(float ior, Arena *arena);
