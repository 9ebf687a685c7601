/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_quarter.h"

#include "base/parallel.h"
#include "film/film_add.h"
#include "film/pixels.h"

typedef struct QuarterWork {
    const Film *film;
    Film *quarter;
    char *pixels; /* one a worker */
} QuarterWork;

/* Two of the film's rows are one of the quarter's: no other item touches it. */
static void add_rows(void *user, int item, int worker) {
    const QuarterWork *work = user;
    const Film *film = work->film;
    const FilmRect crop = film->crop;
    void *pixel = work->pixels + (size_t)worker * film->stride;
    for (int y = crop.y0 + 2 * item; y < crop.y1 && y < crop.y0 + 2 * item + 2; y++)
        for (int x = crop.x0; x < crop.x1; x++) {
            const int u = (x - crop.x0) / 2;
            Error never;
            film_gather(film, film_index(film, x, y), 1, pixel);
            film_add_pixels(work->quarter, (FilmRect){u, item, u + 1, item + 1}, pixel,
                            FILM_SAMPLES_MAX, &never);
        }
}

Film *film_quarter(const Film *film, int threads, Arena *arena) {
    const FilmRect crop = film->crop;
    const FilmRect all = {0, 0, (crop.x1 - crop.x0 + 1) / 2, (crop.y1 - crop.y0 + 1) / 2};
    QuarterWork work = {film, film_create(all.x1, all.y1, all, film->layers, &film->lights, arena),
                        NULL};
    Arena scratch = *arena;
    work.pixels = arena_alloc(&scratch, film->stride, _Alignof(PixelSums), (size_t)threads);
    if (film->has_blind) film_set_blind(work.quarter);
    parallel_for(threads, all.y1, add_rows, &work);
    return work.quarter;
}
