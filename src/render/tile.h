/* tile.h -- renders a rectangle of pixels: the seam between the render loop and the kernel.
 *
 * The kernel (everything between tile_render and the film) is the hot part of the program; no
 * vector type crosses this seam by value.
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

/* rect: inside the film's crop, pixels of the whole frame. Adds to *statistics. */
void tile_render(const TileJob *job, FilmRect rect, PathStatistics *statistics);

/* One sample of one pixel, without the film: what `render --replay` shows. */
void tile_sample(const TileJob *job, int x, int y, uint32_t index, FilmSample *out,
                 PathStatistics *statistics);
