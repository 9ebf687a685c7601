/* SPDX-License-Identifier: Apache-2.0 */
#include "film/film_merge.h"

#include <stdlib.h>

/* ---- overlap ----------------------------------------------------------------------------- */

static int larger(int a, int b) {
    return a > b ? a : b;
}

static int smaller(int a, int b) {
    return a < b ? a : b;
}

static bool check_overlap(const FilmPart *a, const FilmPart *b, Error *err) {
    FilmRect both = {larger(a->crop.x0, b->crop.x0), larger(a->crop.y0, b->crop.y0),
                     smaller(a->crop.x1, b->crop.x1), smaller(a->crop.y1, b->crop.y1)};
    uint32_t first = a->first_sample > b->first_sample ? a->first_sample : b->first_sample;
    uint32_t end = a->end_sample < b->end_sample ? a->end_sample : b->end_sample;
    if (both.x0 >= both.x1 || both.y0 >= both.y1 || first >= end) return true;
    return error_at(err, ERROR_INPUT, b->name, "",
                    "pixels %d,%d,%d,%d, samples %u:%u are in %s as well — leave one of the "
                    "two out",
                    both.x0, both.y0, both.x1, both.y1, first, end, a->name);
}

/* ---- gaps -------------------------------------------------------------------------------- */

/* The pixels and samples that all parts together must fill. */
static FilmPart hull(const FilmPart *parts, int count) {
    FilmPart all = parts[0];
    all.dropped = (FilmDropped){0};
    all.paths = all.camera_rays = all.bounce_rays = all.shadow_rays = 0;
    for (int i = 0; i < count; i++) {
        const FilmPart *part = &parts[i];
        all.crop.x0 = smaller(all.crop.x0, part->crop.x0);
        all.crop.y0 = smaller(all.crop.y0, part->crop.y0);
        all.crop.x1 = larger(all.crop.x1, part->crop.x1);
        all.crop.y1 = larger(all.crop.y1, part->crop.y1);
        if (part->first_sample < all.first_sample) all.first_sample = part->first_sample;
        if (part->asked_end > all.asked_end) all.asked_end = part->asked_end;
        all.paths += part->paths;
        all.camera_rays += part->camera_rays;
        all.bounce_rays += part->bounce_rays;
        all.shadow_rays += part->shadow_rays;
    }
    all.end_sample = all.asked_end;
    return all;
}

static int compare_ints(const void *a, const void *b) {
    return *(const int *)a < *(const int *)b ? -1 : *(const int *)a > *(const int *)b;
}

/* Sorts the edges and leaves out repeated ones; returns how many are left. */
static int sort_edges(int *edges, int count) {
    int kept = 0;
    qsort(edges, (size_t)count, sizeof *edges, compare_ints);
    for (int i = 0; i < count; i++)
        if (!kept || edges[i] != edges[kept - 1]) edges[kept++] = edges[i];
    return kept;
}

static int compare_first_samples(const void *a, const void *b) {
    const FilmPart *const *p = a, *const *q = b;
    return (*p)->first_sample<(*q)->first_sample ? -1 : (*p)->first_sample>(*q)->first_sample;
}

static bool holds(const FilmPart *part, FilmRect rect) {
    return part->crop.x0 <= rect.x0 && part->crop.x1 >= rect.x1 && part->crop.y0 <= rect.y0 &&
           part->crop.y1 >= rect.y1;
}

/* The first samples that no part has of a rectangle that no part's edge cuts. */
static bool find_gap(const FilmPart *const *sorted, int count, FilmRect rect, FilmPart *gap) {
    uint32_t at = gap->first_sample;
    for (int i = 0; i < count; i++) {
        const FilmPart *part = sorted[i];
        if (!holds(part, rect)) continue;
        if (part->first_sample > at) {
            gap->end_sample = part->first_sample;
            break;
        }
        at = part->end_sample;
    }
    gap->first_sample = at;
    gap->crop = rect;
    return at < gap->end_sample;
}

static bool report_gap(const FilmPart *parts, int count, const FilmPart *gap, Error *err) {
    for (int i = 0; i < count; i++) {
        const FilmPart *part = &parts[i];
        if (part->asked_end > part->end_sample && holds(part, gap->crop) &&
            part->end_sample <= gap->first_sample && part->asked_end > gap->first_sample)
            return error_at(err, ERROR_INPUT, part->name, "",
                            "incomplete: it was stopped after samples %u:%u of %u:%u — render "
                            "the whole part, or what is missing as a part of its own",
                            part->first_sample, part->end_sample, part->first_sample,
                            part->asked_end);
    }
    return error_set(err, ERROR_INPUT,
                     "no part has samples %u:%u of pixels %d,%d,%d,%d — add what `render "
                     "--samples %u:%u --crop %d,%d,%d,%d` makes",
                     gap->first_sample, gap->end_sample, gap->crop.x0, gap->crop.y0, gap->crop.x1,
                     gap->crop.y1, gap->first_sample, gap->end_sample, gap->crop.x0, gap->crop.y0,
                     gap->crop.x1, gap->crop.y1);
}

/* Looks at every rectangle between neighbouring edges: there are few, and it is only done when
 * something is known to be missing. */
static bool name_gap(const FilmPart *parts, int count, const FilmPart *all, Arena scratch,
                     Error *err) {
    int *xs = ARENA_NEW(&scratch, int, 2 * count), *ys = ARENA_NEW(&scratch, int, 2 * count);
    const FilmPart **sorted = ARENA_NEW(&scratch, const FilmPart *, count);
    for (int i = 0; i < count; i++) {
        sorted[i] = &parts[i];
        xs[2 * i] = parts[i].crop.x0;
        xs[2 * i + 1] = parts[i].crop.x1;
        ys[2 * i] = parts[i].crop.y0;
        ys[2 * i + 1] = parts[i].crop.y1;
    }
    qsort(sorted, (size_t)count, sizeof(*sorted), compare_first_samples);
    int columns = sort_edges(xs, 2 * count) - 1, rows = sort_edges(ys, 2 * count) - 1;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            FilmPart gap = *all;
            FilmRect rect = {xs[x], ys[y], xs[x + 1], ys[y + 1]};
            if (find_gap(sorted, count, rect, &gap)) return report_gap(parts, count, &gap, err);
        }
    return true;
}

bool film_merge_check(const FilmPart *parts, int count, Arena scratch, FilmPart *out, Error *err) {
    FilmPart all = hull(parts, count);
    uint64_t volume = 0;
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < i; j++)
            if (!check_overlap(&parts[j], &parts[i], err)) return false;
        volume += film_part_volume(&parts[i]);
    }
    if (volume != film_part_volume(&all) && !name_gap(parts, count, &all, scratch, err))
        return false;
    *out = all;
    return true;
}
