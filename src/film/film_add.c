/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_add.h"

#include <assert.h>

#include "film/pixels.h"

/* ---- sums -------------------------------------------------------------------------------- */

#define LEADING_SUMS (offsetof(PixelSums, samples) / sizeof(Fixed))

/* No sum of one sample is beyond 2^96 steps (film.h), so that the sums of any parts that hold
 * at most FILM_SAMPLES_MAX samples between them stay within 128 bits. */
static bool sums_in_range(const Fixed *sums, size_t count, uint32_t samples) {
    Fixed most = (Fixed)samples << 96;
    for (size_t i = 0; i < count; i++)
        if (sums[i] > most || sums[i] < -most) return false;
    return true;
}

static bool pixel_in_range(const Film *film, const PixelSums *sums, uint32_t most_samples) {
    const Fixed *displays = sums->layers + film->first_display;
    size_t apart = (size_t)film->display_numbers;
    return sums->samples <= most_samples && sums->hits <= sums->samples &&
           sums->display_hits <= sums->samples && sums->odd_samples <= sums->samples &&
           sums_in_range((const Fixed *)(const void *)sums, LEADING_SUMS, sums->samples) &&
           sums_in_range(sums->layers, film_layer_numbers(film), sums->samples) &&
           sums_in_range(displays, apart, sums->display_hits);
}

/* Which id is shown is settled by the lowest sample index. */
static void add_part(PixelSums *to, const PixelSums *from) {
    if (from->hits && (!to->hits || from->part_sample < to->part_sample)) {
        to->part_sample = from->part_sample;
        to->part_id = from->part_id;
    }
    to->hits += from->hits;
}

static void add_display(PixelSums *to, const PixelSums *from) {
    if (from->display_hits && (!to->display_hits || from->display_sample < to->display_sample)) {
        to->display_sample = from->display_sample;
        to->display_id = from->display_id;
    }
    to->display_hits += from->display_hits;
}

static void add_numbers(Fixed *to, const Fixed *from, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] += from[i];
}

static void add_pixel(Film *film, size_t index, const PixelSums *from) {
    PixelSums *to = film_sums_at(film, index);
    size_t before = (size_t)film->first_display, apart = (size_t)film->display_numbers;
    const Fixed *displays = from->layers + before, *others = displays + apart;
    add_numbers((Fixed *)(void *)to, (const Fixed *)(const void *)from, LEADING_SUMS);
    add_numbers(to->layers, from->layers, before);
    add_numbers(to->layers + before, others, film_layer_numbers(film) - before - apart);
    if (from->display_hits) add_numbers(film_displays_at(film, index), displays, apart);
    add_part(to, from);
    add_display(to, from);
    to->samples += from->samples;
    to->odd_samples += from->odd_samples;
}

bool film_add_pixels(Film *film, FilmRect rect, const void *pixels, uint32_t most_samples,
                     Error *err) {
    const char *next = pixels;
    assert(rect.x0 >= film->crop.x0 && rect.x1 <= film->crop.x1);
    assert(rect.y0 >= film->crop.y0 && rect.y1 <= film->crop.y1);
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++, next += film->stride) {
            const PixelSums *from = (const PixelSums *)(const void *)next;
            size_t index = film_index(film, x, y);
            if (!pixel_in_range(film, from, most_samples) ||
                from->samples > FILM_SAMPLES_MAX - film_sums_at(film, index)->samples)
                return error_set(err, ERROR_INPUT,
                                 "damaged sums: pixel %d,%d has sums that %u samples cannot "
                                 "have made",
                                 x, y, most_samples);
            add_pixel(film, index, from);
        }
    return true;
}

/* ---- dropped samples --------------------------------------------------------------------- */

/* The order of FilmDropped: by sample, then row, then column. */
static bool comes_before(const FilmDropped *a, int i, const FilmDropped *b, int j) {
    if (a->first[i].sample_index != b->first[j].sample_index)
        return a->first[i].sample_index < b->first[j].sample_index;
    if (a->first[i].y != b->first[j].y) return a->first[i].y < b->first[j].y;
    return a->first[i].x < b->first[j].x;
}

void film_add_dropped(Film *film, const FilmDropped *dropped) {
    FilmDropped both = {.count = film->dropped.count + dropped->count};
    int i = 0, j = 0;
    while (both.kept < FILM_DROPPED_KEPT && (i < film->dropped.kept || j < dropped->kept)) {
        bool mine = j == dropped->kept ||
                    (i < film->dropped.kept && comes_before(&film->dropped, i, dropped, j));
        both.first[both.kept++] = mine ? film->dropped.first[i++] : dropped->first[j++];
    }
    film->dropped = both;
}
