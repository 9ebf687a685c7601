/* tile.h -- renders a rectangle of pixels: the seam between the render loop and the kernel.
 *
 * What happens to it, and for which instruction set, kernel.h tells.
 */
#pragma once
#include "camera/camera.h"
#include "film/film.h"
#include "path/path.h"

typedef struct TileJob {
    const PathContext *context;
    const Camera      *camera;
    Film    *film;
    bool     with_features; /* fill the layers of the first surface, not only the colour */
    uint32_t seed;
    uint32_t first_sample, end_sample; /* half-open */
} TileJob;
