/* SPDX-License-Identifier: Apache-2.0 */
#include "review/engine/engine.h"

#include "base/file.h"
#include "review/engine/condition_file.h"
#include "review/keep/frame_kept.h"
#include "review/review_decide.h"
#include "review/run/frames.h"
#include "review/run/join.h"
#include "review/run/run.h"
#include "review/vary/variants.h"

#define GUIDE_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* ---- a condition ------------------------------------------------------------------------- */

/* The part by which its variants are held against it, and its guide, is all that they need. */
static bool read_with_variants(const ReviewRun *run, int id, Arena *arena, ConditionFound *out,
                               Error *err) {
    const ReviewRequest *request = run->request;
    ReviewRun varying = *run;
    *out = (ConditionFound){.variants = ARENA_NEW(arena, Review, request->variant_count)};
    varying.base = &out->own.review;
    if (!review_run_condition(run, id, arena, &out->own, err)) return false;
    for (; out->variant_count < request->variant_count; out->variant_count++) {
        ReviewOutcome varied;
        if (!review_variant_condition(&varying, &request->variants[out->variant_count], id, arena,
                                      &varied, err))
            return false;
        out->variants[out->variant_count] = varied.review;
    }
    return true;
}

static bool read_condition(const ReviewRun *run, int id, Arena *arena, ConditionFound *out,
                           Error *err) {
    MomentGuide guide = {.room = arena_reserve(GUIDE_BYTES)};
    ReviewRun own = *run;
    guide.skies.room = &guide.room;
    own.means.moment_guide = &guide;
    bool ok = read_with_variants(&own, id, arena, out, err);
    arena_release(&guide.room);
    return ok;
}

static void count_as_done(const ReviewRun *run, int id) {
    const ReviewRequest *request = run->request;
    int steps = review_condition_steps(request, &request->conditions[id]);
    progress_update(run->progress, run->progress->done + steps * (1 + request->variant_count));
}

/* One that was stopped has it. What is of another request, scene or program, or damaged, is
 * read again. */
static bool find_kept(const ReviewRun *run, int id, const char *path, const char *identity,
                      Arena *arena, ConditionFound *out) {
    Error ignored;
    return file_exists(path) && condition_read(run, id, path, arena, out, &ignored) &&
           condition_is_reusable(out, identity, *arena);
}

static bool take_condition(const ReviewRun *run, int id, Arena *arena, ConditionFound *out,
                           Error *err) {
    if (run->merged) return condition_read(run, id, run->merged[id], arena, out, err);
    if (!run->unfinished) return read_condition(run, id, arena, out, err);
    const char *path =
        arena_format(arena, "%s/%s", run->unfinished, condition_file_name(run->request, id, arena));
    const char *identity = condition_identity(run, id, arena, err);
    if (!identity) return false;
    if (find_kept(run, id, path, identity, arena, out)) {
        count_as_done(run, id);
        return true;
    }
    return read_condition(run, id, arena, out, err) &&
           condition_write(out, path, identity, *arena, err);
}

/* ---- all of them ------------------------------------------------------------------------- */

/* Those that are reviewed, in the request's order. */
typedef struct Conditions {
    ConditionFound *list;
    int *ids;
    int count;
} Conditions;

/* Scenes of the last stay open: its worst case may have a picture. */
static bool take_all(const ReviewRun *run, Arena *arena, Conditions *out, Error *err) {
    int count = run->request->condition_count, before = NO_ID;
    *out = (Conditions){ARENA_NEW(arena, ConditionFound, count), ARENA_NEW(arena, int, count), 0};
    for (int i = 0; i < count; i++) {
        if (!review_is_wanted(run, i)) continue;
        if (before != NO_ID && !review_scene_comes_again(run, before))
            scenes_kept_close(run->means.scenes, before);
        if (!take_condition(run, i, arena, &out->list[out->count], err)) return false;
        out->ids[out->count++] = before = i;
    }
    return true;
}

/* variant: -1: the review itself. */
static void join(const ReviewRun *run, const Conditions *all, int variant, Arena *arena,
                 ReviewOutcome *out) {
    const ReviewOutcome **parts = ARENA_NEW(arena, const ReviewOutcome *, all->count);
    for (int i = 0; i < all->count; i++) {
        ReviewOutcome *varied = variant < 0 ? NULL : ARENA_NEW(arena, ReviewOutcome, 1);
        if (varied) varied->review = all->list[i].variants[variant];
        parts[i] = varied ? varied : &all->list[i].own;
    }
    review_join(run, parts, all->count, arena, out);
}

static void join_variants(const ReviewRun *run, const Conditions *all, Arena *arena,
                          Review *review) {
    const ReviewRequest *request = run->request;
    int count = request->variant_count;
    review->variants = ARENA_NEW(arena, ReviewVariantFound, count);
    for (; review->variant_count < count; review->variant_count++) {
        int i = review->variant_count;
        ReviewOutcome *found = ARENA_NEW(arena, ReviewOutcome, 1);
        join(run, all, i, arena, found);
        review_variant_compare(run, &request->variants[i], review, &found->review, arena,
                               &review->variants[i]);
    }
}

/* What frames show of the cases, into the conditions' own. */
static void hand_back(const Review *review, Conditions *all) {
    int cases = 0, sweeps = 0;
    for (int i = 0; i < all->count; i++) {
        Review *own = &all->list[i].own.review;
        for (int k = 0; k < own->case_count; k++) own->cases[k] = review->cases[cases++];
        for (int k = 0; k < own->sweep_count; k++) own->sweeps[k] = review->sweeps[sweeps++];
    }
}

static bool keep_parts(const ReviewRun *run, const Review *review, Conditions *all, Arena scratch,
                       Error *err) {
    hand_back(review, all);
    for (int i = 0; i < all->count; i++) {
        Arena own = scratch;
        const char *path = arena_format(&own, "%s/conditions/%s", run->folder,
                                        condition_file_name(run->request, all->ids[i], &own));
        const char *identity = condition_identity(run, all->ids[i], &own, err);
        if (!identity || !condition_write(&all->list[i], path, identity, own, err)) return false;
    }
    return true;
}

/* Pictures that are traced take as long as verdicts do: these are told before. */
static bool make_frames(const ReviewRun *run, ReviewOutcome *out, Arena *arena, Error *err) {
    if (!run->request->frames.worst) return true;
    return (run->merged || !run->news.verdicts || run->news.verdicts(run->news.user, out, err)) &&
           review_frames(run, out, arena, err);
}

static bool review_all(const ReviewRun *run, bool is_strict, Arena *arena, ReviewOutcome *out,
                       Error *err) {
    Review *review = &out->review;
    Conditions all;
    if (!take_all(run, arena, &all, err)) return false;
    join(run, &all, -1, arena, out);
    review_add_notes(run, review, arena);
    review->is_strict = is_strict;
    review_decide(review);
    join_variants(run, &all, arena, review);
    return review_goes_on(err) && make_frames(run, out, arena, err) && review_goes_on(err) &&
           (!run->only || keep_parts(run, review, &all, *arena, err));
}

bool review_run(const ReviewRun *run, bool is_strict, Arena *arena, ReviewOutcome *out,
                Error *err) {
    SunSearches searches = sun_searches_start();
    ScenesKept scenes = {NULL};
    ReviewRun own = *run;
    own.sun_searches = &searches;
    own.means.scenes = &scenes;
    bool ok = review_all(&own, is_strict, arena, out, err);
    scenes_kept_close(&scenes, NO_ID);
    sun_searches_end(&searches);
    return ok;
}
