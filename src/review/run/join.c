/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/join.h"

#include <string.h>

#include "review/pane_verdict.h"
#include "review/run/rests.h"

/* Adds the rows of one list to another that has room. */
#define ADD(to, from, list, count) \
    do { \
        if ((from)->count) \
            memcpy((to)->list + (to)->count, (from)->list, \
                   (size_t)(from)->count * sizeof *(to)->list); \
        (to)->count += (from)->count; \
    } while (0)

static void reserve(const ReviewOutcome *const *parts, int count, Arena *arena,
                    ReviewOutcome *out) {
    Review all = {0};
    int tables = 0;
    for (int i = 0; i < count; i++) {
        const Review *part = &parts[i]->review;
        all.case_count += part->case_count;
        all.sweep_count += part->sweep_count;
        all.gaze_count += part->gaze_count;
        all.false_sun_count += part->false_sun_count;
        all.pane_image_count += part->pane_image_count;
        all.response_count += part->response_count;
        tables += parts[i]->table_count;
    }
    out->tables = ARENA_NEW(arena, SweepTable, tables);
    out->review = (Review){.cases = ARENA_NEW(arena, ReviewCase, all.case_count),
                           .sweeps = ARENA_NEW(arena, ReviewSweep, all.sweep_count),
                           .gazes = ARENA_NEW(arena, GazeFinding, all.gaze_count),
                           .false_suns = ARENA_NEW(arena, ReviewFalseSun, all.false_sun_count),
                           .pane_images = ARENA_NEW(arena, PaneFinding, all.pane_image_count),
                           .responses = ARENA_NEW(arena, ReviewResponse, all.response_count)};
}

/* A response serves several conditions of one scene, and stands there once. */
static void add_responses(const Review *part, Review *to) {
    for (int i = 0; i < part->response_count; i++) {
        const ReviewResponse *response = &part->responses[i];
        int k = 0;
        while (k < to->response_count && strcmp(to->responses[k].file, response->file) != 0) k++;
        if (k == to->response_count) to->responses[to->response_count++] = *response;
    }
}

static void add_tables(const ReviewOutcome *part, int first_sweep, ReviewOutcome *to) {
    for (int i = 0; i < part->table_count; i++) {
        SweepTable *table = &to->tables[to->table_count++];
        *table = part->tables[i];
        table->sweep_id += first_sweep;
    }
}

static void add_part(const ReviewOutcome *part, Arena *arena, ReviewOutcome *out) {
    const Review *from = &part->review;
    Review *to = &out->review;
    add_tables(part, to->sweep_count, out);
    ADD(to, from, cases, case_count);
    ADD(to, from, sweeps, sweep_count);
    ADD(to, from, gazes, gaze_count);
    ADD(to, from, false_suns, false_sun_count);
    ADD(to, from, pane_images, pane_image_count);
    add_responses(from, to);
    rests_add_of(from, to, arena);
    rests_add_files_of(from, to, arena);
    if (from->without_data_count > to->without_data_count) {
        to->without_data_count = from->without_data_count;
        to->without_data = from->without_data;
    }
    out->responses_kept += part->responses_kept;
}

void review_join(const ReviewRun *run, const ReviewOutcome *const *parts, int count, Arena *arena,
                 ReviewOutcome *out) {
    const Profile *profile = run->profile;
    *out = (ReviewOutcome){0};
    reserve(parts, count, arena, out);
    out->review.title = run->request->title;
    out->review.profile = arena_format(arena, "%s, %s", profile->title, profile->edition);
    out->review.superseded_by = profile->superseded_by;
    out->review.document = run->request->document;
    rests_add_request(run->request, profile, &out->review, arena);
    for (int i = 0; i < count; i++) add_part(parts[i], arena, out);
}
