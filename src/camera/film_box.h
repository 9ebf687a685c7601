/* film_box.h -- where on the film a display is seen.
 *
 * Units    pixels of the whole frame, from its upper left corner.
 * Threads  no shared state.  Fails  never.
 */
#pragma once
#include "camera/camera.h"

typedef struct FilmBox {
    float x0, y0, x1, y1;
} FilmBox;

/* The smallest box around all of the display that faces the camera and lies within the frame;
 * false where nothing does. What stands before the display is not looked for. */
bool film_box_of_display(const Camera *camera, const Scene *scene, int display_id,
                         FilmBox *out);
