/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_gaze.h"

#include <math.h>
#include <stdlib.h>

#include "page/page.h"
#include "review/output/review_road.h"
#include "review/output/review_panes.h"
#include "review/output/review_words.h"

/* ---- the worst first --------------------------------------------------------------------- */

/* Unknown contrast (NaN) comes last; equal findings keep their order. */
static int by_contrast(const void *a, const void *b) {
    const GazeFinding *x = *(const GazeFinding *const *)a, *y = *(const GazeFinding *const *)b;
    if (isnan(x->contrast_left) != isnan(y->contrast_left)) return isnan(x->contrast_left) ? 1 : -1;
    if (x->contrast_left < y->contrast_left) return -1;
    if (x->contrast_left > y->contrast_left) return 1;
    return (x > y) - (x < y);
}

/* ---- words ------------------------------------------------------------------------------- */

/* Where most of the veil in the eye begins that takes of the contrast; "" without one. */
static const char *first_part(const GazeVeil *parts) {
    static const char *const WORDS[] = {"the sun", "the sky", "lamps and displays", "glints",
                                        "lit surfaces"};
    const double value[] = {parts->sun, parts->sky, parts->lamps, parts->glints, parts->surfaces};
    int most = 0;
    for (int i = 1; i < 5; i++)
        if (value[i] > value[most]) most = i;
    return value[most] > 0 ? WORDS[most] : "";
}

/* Light near the gaze is what the eye looks at, no veil. */
static double far_veil(const GazeFinding *g) {
    return g->veil - g->veil_parts.near;
}

const char *review_gaze_mirrored(const GazeFinding *g, Arena *arena) {
    return words_within(g->mirrored, g->mirrored_range.low, g->mirrored_range.high, arena);
}

const char *review_gaze_veil(const GazeFinding *g, Arena *arena) {
    double near = g->veil_parts.near;
    return words_within(far_veil(g), g->veil_range.low - near, g->veil_range.high - near, arena);
}

/* ---- values ------------------------------------------------------------------------------ */

static void set_gaze(json_t *to, const GazeFinding *g, Arena *arena) {
    static const char *const NAMES[] = {"eye", "gaze", "condition", "mirrored_from", NULL};
    const MeanInterval *left = &g->contrast_range;
    bool has_range = !isnan(left->low) && !isnan(left->high);
    values_set_names(to, NAMES);
    page_set(to, "mirrored", review_gaze_mirrored(g, arena));
    page_set(to, "veil", review_gaze_veil(g, arena));
    page_set(to, "mostly", first_part(&g->veil_parts));
    page_set_flag(to, "is_poor", g->contrast_left < GAZE_POOR);
    page_set(to, "left_range",
             has_range ? arena_format(arena, "%s to %s", words_share(left->low, arena),
                                      words_share(left->high, arena))
                       : NULL);
}

static void add_false_suns(const PageValues *v) {
    static const char *const NAMES[] = {"mirror", "eye", "condition", "gaze", NULL};
    json_t *list = json_object_get(v->doc, "false_suns");
    for (int i = 0; i < v->review->false_sun_count; i++)
        values_set_names(json_array_get(list, (size_t)i), NAMES);
}

void values_add_gazes(const PageValues *v) {
    const Review *review = v->review;
    const GazeFinding **list = ARENA_NEW(v->arena, const GazeFinding *, review->gaze_count + 1);
    json_t *gazes = json_object_get(v->doc, "gazes");
    json_t *all = values_list(v->doc, "ranked_gazes");
    for (int i = 0; i < review->gaze_count; i++) {
        list[i] = &review->gazes[i];
        set_gaze(json_array_get(gazes, (size_t)i), list[i], v->arena);
    }
    qsort(list, (size_t)review->gaze_count, sizeof *list, by_contrast);
    for (int i = 0; i < review->gaze_count; i++)
        json_array_append(all, json_array_get(gazes, (size_t)(list[i] - review->gazes)));
    add_false_suns(v);
    road_add_values(v->doc, v->review, v->arena);
    values_add_panes(v);
}
