/* SPDX-License-Identifier: Apache-2.0 */
/* film_box.h -- where on the film a part of the scene is seen, such as a display.
 *
 * Units    pixels of the whole frame, from its upper left corner.
 * Threads  no shared state.  Fails  never.
 */
#pragma once
#include "camera/camera.h"

typedef struct FilmBox {
    float x0, y0, x1, y1;
} FilmBox;

/* The smallest box around all of the part that faces the camera, within the frame; false where
 * nothing does. Occlusion is not tested. */
bool film_box_of_part(const Camera *camera, const Scene *scene, int part_id, FilmBox *out);
