/* SPDX-License-Identifier: Apache-2.0 */
/* leaning.h -- a display as if its face leant back or forward where it stands.
 *
 * Its triangles stay, and what rays meet with them; its shading normals are turned, about the
 * level axis about which a variant's tilt_deg turns a node. So its mirror, its haze and what it
 * emits are those of the tilted display, and what stands before it and behind is seen from
 * where it is now: of a display 0.1 m high the edges would move by 9 mm for 10 degrees.
 *
 * Frames   scene.  Units  degrees, positive: the face turns up.
 * Memory   from the arena; the context that it is made of must outlive it.
 * Threads  any.
 */
#pragma once
#include "path/path_context.h"
#include "review/request/request.h"
#include "review/symbol/symbol_surface.h"

typedef struct LeaningAsk {
    const PathContext   *context;
    const ReviewDisplay *display;
    Vec3                 normal; /* unit, of its middle */
    const double        *ahead;  /* [3] of the vehicle: counts where the display lies flat */
} LeaningAsk;

typedef struct LeaningDisplay {
    Scene       scene;
    PathContext context; /* of that scene: it must not be moved */
} LeaningDisplay;

LeaningDisplay *display_leaning(const LeaningAsk *ask, double back_deg, Arena *arena);
