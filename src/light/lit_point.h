/* SPDX-License-Identifier: Apache-2.0 */
/* lit_point.h -- what lights need to know of a point that is lit. */
#pragma once
#include "base/vec.h"

typedef struct LitPoint {
    Vec3 position;   /* m, scene */
    Vec3 ns;         /* unit, world: its shading normal */
    bool both_sides; /* light from behind counts, too; else only from the normal's side */
} LitPoint;
