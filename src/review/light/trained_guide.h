/* SPDX-License-Identifier: Apache-2.0 */
/* trained_guide.h -- trains a guide for a setup's paths on a condition's light, before any of
 * them counts.
 *
 * Memory   the guide comes from the arena, or from the room that variants inherit it from
 *          (inherited.h).
 * Threads  starts its own; the same guide for any count.
 */
#pragma once
#include "review/light/setup.h"

/* Of a variant: takes the guide that the review itself trained under this condition. False:
 * there is none. */
bool trained_guide_inherit(Setup *setup);

/* A guide for an eye, m, that looks towards what is judged: from the setup's folder of guides,
 * or a new one, which is kept there. One that is damaged is trained again. */
void trained_guide_take(Setup *setup, Vec3 eye, Vec3 towards, Arena *arena);
