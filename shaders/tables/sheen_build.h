/* SPDX-License-Identifier: Apache-2.0 */
/* sheen_build.h -- how sheen.h's table is made (tables/make_tables.c).
 *
 * energy: of the boundary whose facets lie beneath, and of the coat above. The table is the
 * caller's arena's; making it takes some 4 seconds.
 * Threads  pure.  Fails  never.
 */
#pragma once
#include "shaders/facets/energy.h"
#include "shaders/layers/sheen.h"

const SheenTable *sheen_table_build(const EnergyTable *energy, Arena *arena);
