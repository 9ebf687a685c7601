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

static bool pixel_in_range(const PixelSums *sums, size_t layer_numbers, uint32_t most_samples) {
    return sums->samples <= most_samples && sums->hits <= sums->samples &&
           sums->display_hits <= sums->samples && sums->odd_samples <= sums->samples &&
           sums_in_range((const Fixed *)(const void *)sums, LEADING_SUMS, sums->samples) &&
           sums_in_range(sums->layers, layer_numbers, sums->samples);
}

/* Which id is shown is settled by the lowest sample index. */
static void add_id(uint32_t *sample, int32_t *id, uint32_t other_sample, int32_t other_id) {
    if (other_sample >= *sample) return;
    *sample = other_sample;
    *id = other_id;
}

static void add_pixel(PixelSums *to, const PixelSums *from, size_t layer_numbers) {
    Fixed *sums = (Fixed *)(void *)to;
    const Fixed *others = (const Fixed *)(const void *)from;
    for (size_t i = 0; i < LEADING_SUMS; i++) sums[i] += others[i];
    for (size_t i = 0; i < layer_numbers; i++) to->layers[i] += from->layers[i];
    to->samples += from->samples;
    to->hits += from->hits;
    to->display_hits += from->display_hits;
    to->odd_samples += from->odd_samples;
    add_id(&to->part_sample, &to->part_id, from->part_sample, from->part_id);
    add_id(&to->display_sample, &to->display_id, from->display_sample, from->display_id);
}

bool film_add_pixels(Film *film, FilmRect rect, const void *pixels, uint32_t most_samples,
                     Error *err) {
    size_t layer_numbers = (film->stride - sizeof(PixelSums)) / sizeof(Fixed);
    const char *next = pixels;
    assert(rect.x0 >= film->crop.x0 && rect.x1 <= film->crop.x1);
    assert(rect.y0 >= film->crop.y0 && rect.y1 <= film->crop.y1);
    for (int y = rect.y0; y < rect.y1; y++)
        for (int x = rect.x0; x < rect.x1; x++, next += film->stride) {
            const PixelSums *from = (const PixelSums *)(const void *)next;
            PixelSums *to = film_sums(film, x, y);
            if (!pixel_in_range(from, layer_numbers, most_samples) ||
                from->samples > FILM_SAMPLES_MAX - to->samples)
                return error_set(err, ERROR_INPUT,
                                 "damaged sums: pixel %d,%d has sums that %u samples cannot "
                                 "have made",
                                 x, y, most_samples);
            add_pixel(to, from, layer_numbers);
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
