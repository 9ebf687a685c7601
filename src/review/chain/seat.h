/* SPDX-License-Identifier: Apache-2.0 */
/* seat.h -- the back of the seat behind an eye, by its place: models name seats in any
 * language. The figures of a seated person are rough.
 *
 * Units    m, scene.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"

typedef struct ChainSeat {
    Vec3 eye;
    Vec3 ahead; /* unit, level: where who sits there faces */
} ChainSeat;

/* Of an eye that looks at a symbol's middle: who sits there faces where the vehicle points
 * (forward, [3]), unless the symbol is far from there. */
ChainSeat seat_of_eye(Vec3 eye, Vec3 middle, const double *forward);

/* Does a point lie where the seat's back is? Ahead of it is who sits there. */
bool seat_is_back(const ChainSeat *seat, Vec3 p);
