/* SPDX-License-Identifier: Apache-2.0 */
#include "render/favour.h"

#include "base/parallel.h"
#include "render/tiles.h"

static int columns_of(FilmRect rect) {
    return rect.x1 - rect.x0;
}

static bool holds(FilmRect rect, int x, int y) {
    return x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1;
}

/* With the pixels next to it that the frame has: they decide the same for every crop. */
static FilmRect widened(FilmRect rect, const Camera *camera) {
    return (FilmRect){rect.x0 > 0 ? rect.x0 - 1 : 0, rect.y0 > 0 ? rect.y0 - 1 : 0,
                      rect.x1 < camera->width ? rect.x1 + 1 : camera->width,
                      rect.y1 < camera->height ? rect.y1 + 1 : camera->height};
}

typedef struct TileSearch {
    const Kernel *kernel;
    DisplaySearch search;
} TileSearch;

static void search_tile(void *context, int item, int worker) {
    const TileSearch *work = context;
    (void)worker;
    work->kernel->find_displays(&work->search, render_tile(work->search.rect, item));
}

static DisplaySearch find_displays(const Favour *favour, Arena *arena) {
    FilmRect rect = widened(favour->crop, favour->camera);
    size_t pixels = (size_t)columns_of(rect) * (size_t)(rect.y1 - rect.y0);
    TileSearch work = {favour->kernel,
                       {.context = favour->context,
                        .camera = favour->camera,
                        .display = favour->area->display,
                        .rect = rect,
                        .shows = ARENA_NEW(arena, uint8_t, pixels)}};
    parallel_for(favour->threads, render_tile_count(rect), search_tile, &work);
    return work.search;
}

static uint8_t shows_at(const DisplaySearch *search, int x, int y) {
    return search->shows[(size_t)(y - search->rect.y0) * (size_t)columns_of(search->rect) +
                         (size_t)(x - search->rect.x0)];
}

uint8_t *favour_shows(const Favour *favour, Arena *arena) {
    FilmRect crop = favour->crop;
    size_t pixels = (size_t)columns_of(crop) * (size_t)(crop.y1 - crop.y0);
    uint8_t *shows = ARENA_NEW(arena, uint8_t, pixels), *next = shows;
    Arena scratch = *arena;
    DisplaySearch search = find_displays(favour, &scratch);
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++) *next++ = shows_at(&search, x, y);
    return shows;
}

/* Edges of a display, where content ends, count as much as what lies within them. */
static bool shows_near(const DisplaySearch *search, int x, int y) {
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++)
            if (holds(search->rect, i, j) && shows_at(search, i, j)) return true;
    return false;
}

SampleShares favour_shares(const Favour *favour, Arena *arena) {
    FilmRect crop = favour->crop;
    const FilmArea *area = favour->area;
    if (!area) return (SampleShares){NULL, crop};
    bool of_display = area->display != FILM_ALL_PIXELS;
    size_t pixels = (size_t)columns_of(crop) * (size_t)(crop.y1 - crop.y0);
    uint8_t *shares = ARENA_NEW(arena, uint8_t, pixels), *next = shares;
    Arena scratch = *arena;
    DisplaySearch search = {.shows = NULL};
    if (of_display) search = find_displays(favour, &scratch);
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++) {
            bool counts = holds(area->rect, x, y) && (!of_display || shows_near(&search, x, y));
            *next++ = counts ? SAMPLE_SHARE_ALL : SAMPLE_SHARE_ALL / FAVOUR_OTHERS;
        }
    return (SampleShares){shares, crop};
}
