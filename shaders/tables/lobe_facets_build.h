/* SPDX-License-Identifier: Apache-2.0 */
/* lobe_facets_build.h -- computes the table of lobe_facets.h.
 *
 * Memory   from the arena, 1.2 MB.  Threads  any.  Fails  never. It takes some seconds: the
 *          build of the program does it once (tables/make_tables.c).
 */
#pragma once
#include "base/arena.h"
#include "shaders/facets/lobe_facets.h"

const FacetTable *facet_table_build(Arena *arena);
