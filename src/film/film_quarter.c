/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_quarter.h"

#include "film/film_add.h"
#include "film/pixels.h"

Film *film_quarter(const Film *film, Arena *arena) {
    const FilmRect crop = film->crop;
    const FilmRect all = {0, 0, (crop.x1 - crop.x0 + 1) / 2, (crop.y1 - crop.y0 + 1) / 2};
    Film *quarter = film_create(all.x1, all.y1, all, film->layers, &film->lights, arena);
    Arena scratch = *arena;
    PixelSums *pixel = arena_alloc(&scratch, film->stride, _Alignof(PixelSums), 1);
    if (film->has_blind) film_set_blind(quarter);
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++) {
            const int u = (x - crop.x0) / 2, v = (y - crop.y0) / 2;
            Error never;
            film_gather(film, film_index(film, x, y), 1, pixel);
            film_add_pixels(quarter, (FilmRect){u, v, u + 1, v + 1}, pixel, FILM_SAMPLES_MAX,
                            &never);
        }
    return quarter;
}
