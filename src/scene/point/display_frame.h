/* SPDX-License-Identifier: Apache-2.0 */
/* display_frame.h -- how a display lies at one of its points: frame, place on the panel.
 *
 * Frame    world.  Threads  pure functions.  Fails  never.
 */
#pragma once
#include "scene/point/texture_slot.h"

/* The display's frame at a point: +z the shading normal on the front's side, +x the direction
 * of growing U of its content, +y up. */
Frame display_frame(const Scene *scene, const Display *display, uint32_t triangle,
                    const TrianglePoint *point);

/* The point's place on the panel's active area (panel_place.h), for panels that vary. */
void display_place(const Display *display, const TrianglePoint *point, float place[2]);
