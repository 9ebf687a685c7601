/* SPDX-License-Identifier: Apache-2.0 */
#include "review/vary/variants.h"

#include <math.h>
#include <string.h>

#include "base/confidence.h"
#include "base/mathd.h"
#include "review/judge.h"
#include "review/light/setup.h"
#include "review/request/request_check.h"
#include "review/review_decide.h"
#include "review/run/rests.h"
#include "review/run/run.h"
#include "scene/load/scene_load.h"

#define JUDGE_BYTES ((size_t)1 << 20)
#define SCENE_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

/* ---- differences ------------------------------------------------------------------------- */

/* The margin that a case would have if it reflected so much. */
static double margin_with(const ReviewCase *of, double reflected, const Profile *profile,
                          Arena scratch) {
    ReviewCase c = *of;
    c.luminance_cd_m2.reflected = reflected;
    judge_contrasts(&c, (MeanInterval){reflected, reflected});
    judge_case(&c, profile, &scratch);
    return c.margin;
}

/* The jackknife's margin, without one batch; by all where batches are not known. */
static double margin_without(const ReviewCase *of, int batch, const Profile *profile,
                             Arena scratch) {
    double all = of->luminance_cd_m2.reflected;
    double left =
        of->batches ? (CASE_BATCHES * all - of->batches[batch]) / (CASE_BATCHES - 1) : all;
    return margin_with(of, left, profile, scratch);
}

/* Half the interval of a margin that an image in glass decides, whose batches are not kept:
 * with the panel's own error, so that a difference is known at least as well; 0: none does. */
static double image_half(const ReviewCase *of) {
    const LimitVerdict *limit = of->limit_id >= 0 ? &of->limits[of->limit_id] : NULL;
    return limit && limit->by_pane ? 0.5 * (limit->high - limit->low) / limit->value : 0;
}

/* Half the interval of a margin whose light is the review's, within a share. */
static double alike_half(const ReviewCase *of, const Profile *profile, Arena scratch) {
    double light = of->luminance_cd_m2.reflected;
    if (isnan(of->alike_within)) return 0;
    return fabs(margin_with(of, light * (1 + of->alike_within), profile, scratch) -
                margin_with(of, light, profile, scratch));
}

/* By how much bright light that paths may have missed moves a margin: what the upper end of the
 * reflected light has more than the lower. Where one case lacks it so does the other. */
static double margin_of_bright(const ReviewCase *of, const Profile *profile, Arena scratch) {
    double light = of->luminance_cd_m2.reflected;
    double bright = of->reflected_range.high + of->reflected_range.low - 2 * light;
    if (!(bright > 0)) return 0;
    return margin_with(of, light + bright, profile, scratch) -
           margin_with(of, light, profile, scratch);
}

static void set_difference(const Profile *profile, ReviewDifference *of, Arena scratch) {
    double each[CASE_BATCHES], mean = 0, squares = 0;
    of->margin = of->after->margin - of->before->margin;
    for (int i = 0; i < CASE_BATCHES; i++) {
        each[i] = margin_without(of->after, i, profile, scratch) -
                  margin_without(of->before, i, profile, scratch);
        mean += each[i] / CASE_BATCHES;
    }
    for (int i = 0; i < CASE_BATCHES; i++) squares += (each[i] - mean) * (each[i] - mean);
    double error = sqrt(squares * (CASE_BATCHES - 1) / CASE_BATCHES);
    double half = student_quantile(CASE_BATCHES - 1) * error;
    double images = hypot_d(image_half(of->before), image_half(of->after));
    if (images > 0) half = hypot_d(half, images);
    double alike = alike_half(of->after, profile, scratch);
    if (alike > 0) half = hypot_d(half, alike);
    double bright = margin_of_bright(of->after, profile, scratch) -
                    margin_of_bright(of->before, profile, scratch);
    of->margin_range =
        (MeanInterval){of->margin - half + fmin(bright, 0), of->margin + half + fmax(bright, 0)};
}

/* The margin of one case less that of another. */
static ReviewDifference review_difference(const Profile *profile, const ReviewCase *before,
                                          const ReviewCase *after) {
    ReviewDifference d = {.before = before,
                          .after = after,
                          .margin = (double)NAN,
                          .margin_range = {(double)NAN, (double)NAN}};
    if (!before || !after) return d;
    d.is_other_part = !strcmp(before->symbol, after->symbol) &&
                      memcmp(&before->whole.part, &after->whole.part, sizeof(CaseBox)) != 0;
    Arena scratch = arena_reserve(JUDGE_BYTES);
    set_difference(profile, &d, scratch);
    arena_release(&scratch);
    return d;
}

/* The case or sweep's worst with the least margin of contrast; NULL: none has one. */
static const ReviewCase *review_least_margin(const Review *review) {
    const ReviewCase *least = NULL;
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        if (!isnan(c->margin) && (!least || c->margin < least->margin)) least = c;
    }
    return least;
}

static ReviewDifference sweeps_of(ReviewDifference d, const Review *base, const Review *review) {
    if (d.before) d.sweep_before = review_sweep_of(base, d.before);
    if (d.after) d.sweep_after = review_sweep_of(review, d.after);
    return d;
}

static void compare(const Profile *profile, const Review *base, ReviewVariantFound *found,
                    Arena *arena) {
    const Review *review = found->review;
    found->difference_count = review_case_count(review);
    found->differences = ARENA_NEW(arena, ReviewDifference, found->difference_count);
    for (int i = 0; i < found->difference_count; i++) {
        const ReviewCase *after = review_case_at(review, i);
        ReviewDifference d = review_difference(profile, review_case_like(base, after), after);
        found->differences[i] = sweeps_of(d, base, review);
    }
    ReviewDifference worst =
        review_difference(profile, review_least_margin(base), review_least_margin(review));
    found->worst = sweeps_of(worst, base, review);
}

/* ---- before all -------------------------------------------------------------------------- */

static bool check_one(const ReviewRun *run, const ReviewVariant *variant, Error *err) {
    Arena scratch = arena_reserve(SCENE_BYTES);
    ReviewRequest request = review_request_variant(run->request, variant, &scratch);
    SetupOptions options = {.request = &request, .means = run->means};
    Scene *scene;
    bool ok = setup_scene(&options, &scratch, run->problems, &scene, err);
    if (ok) {
        ok = review_request_check(&request, scene, run->problems) ||
             problems_verdict(run->problems, err);
        scene_close(scene);
    }
    arena_release(&scratch);
    return ok || error_prefix(err, "variant '%.100s'", variant->name);
}

bool review_variants_check(const ReviewRun *run, Error *err) {
    const ReviewRequest *request = run->request;
    for (int i = 0; i < request->variant_count; i++)
        if (!check_one(run, &request->variants[i], err)) return false;
    return true;
}

/* ---- all of them ------------------------------------------------------------------------- */

bool review_variant_condition(const ReviewRun *run, const ReviewVariant *variant, int condition_id,
                              Arena *arena, ReviewOutcome *out, Error *err) {
    ReviewRequest *request = ARENA_NEW(arena, ReviewRequest, 1);
    ReviewRun own = *run;
    *request = review_request_variant(run->request, variant, arena);
    own.request = request;
    return review_run_condition(&own, condition_id, arena, out, err) ||
           (err->code && error_prefix(err, "variant '%.100s'", variant->name));
}

void review_variant_compare(const ReviewRun *run, const ReviewVariant *variant, Review *base,
                            Review *found, Arena *arena, ReviewVariantFound *out) {
    *out = (ReviewVariantFound){.name = variant->name,
                                .words = variant->words,
                                .word_count = variant->word_count,
                                .review = found};
    found->is_strict = base->is_strict;
    review_decide(found);
    compare(run->profile, base, out, arena);
    rests_add_files_of(found, base, arena);
}
