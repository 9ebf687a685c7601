/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/variants.h"

#include <math.h>

#include "base/confidence.h"
#include "review/judge.h"
#include "review/output/review_decide.h"
#include "review/run/run.h"

#define JUDGE_BYTES ((size_t)1 << 20)

/* ---- differences ------------------------------------------------------------------------- */

/* The margin that a case would have if it reflected so much. */
static double margin_with(const ReviewCase *of, double reflected, const Profile *profile,
                          Arena scratch)
{
    ReviewCase c = *of;
    c.luminance_cd_m2.reflected = reflected;
    judge_contrasts(&c, (Range){reflected, reflected});
    judge_case(&c, profile, &scratch);
    return c.margin;
}

/* What all batches but one say; all of them where batches are not known. */
static double margin_without(const ReviewCase *of, int batch, const Profile *profile,
                             Arena scratch)
{
    double all = of->luminance_cd_m2.reflected;
    double left = of->batches
                      ? (CASE_BATCHES * all - of->batches[batch]) / (CASE_BATCHES - 1)
                      : all;
    return margin_with(of, left, profile, scratch);
}

static void set_difference(const Profile *profile, ReviewDifference *of, Arena scratch)
{
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
    of->margin_range = (Range){of->margin - half, of->margin + half};
}

static ReviewDifference difference_of(const Profile *profile, const Review *base,
                                      const Review *review, const ReviewCase *after,
                                      Arena scratch)
{
    ReviewDifference d = {.after = after, .before = review_case_like(base, after),
                          .margin = (double)NAN, .margin_range = {(double)NAN, (double)NAN}};
    d.sweep_after = review_sweep_of(review, after);
    if (!d.before) return d;
    d.sweep_before = review_sweep_of(base, d.before);
    set_difference(profile, &d, scratch);
    return d;
}

static void keep_least(const ReviewCase *c, const ReviewCase **least)
{
    if (isnan(c->margin)) return;
    if (!*least || c->margin < (*least)->margin) *least = c;
}

/* The case of the least margin; NULL: none has one. */
static const ReviewCase *least_margin(const Review *review)
{
    const ReviewCase *least = NULL;
    for (int i = 0; i < review->case_count; i++) keep_least(&review->cases[i], &least);
    for (int i = 0; i < review->sweep_count; i++) keep_least(&review->sweeps[i].worst, &least);
    return least;
}

static void compare(const Profile *profile, const Review *base, ReviewVariantFound *found,
                    Arena *arena)
{
    const Review *review = found->review;
    Arena         scratch = arena_reserve(JUDGE_BYTES);
    found->difference_count = review->case_count + review->sweep_count;
    found->differences = ARENA_NEW(arena, ReviewDifference, found->difference_count);
    for (int i = 0; i < found->difference_count; i++) {
        int               sweep = i - review->case_count;
        const ReviewCase *after =
            sweep < 0 ? &review->cases[i] : &review->sweeps[sweep].worst;
        found->differences[i] = difference_of(profile, base, review, after, scratch);
    }
    found->worst = (ReviewDifference){least_margin(base), least_margin(review), NULL, NULL,
                                      (double)NAN, {(double)NAN, (double)NAN}};
    if (found->worst.before && found->worst.after) {
        found->worst.sweep_before = review_sweep_of(base, found->worst.before);
        found->worst.sweep_after = review_sweep_of(review, found->worst.after);
        set_difference(profile, &found->worst, scratch);
    }
    arena_release(&scratch);
}

/* ---- all of them ------------------------------------------------------------------------- */

bool review_variant(const ReviewRun *run, const ReviewVariant *variant, const Review *base,
                    Arena *arena, ReviewVariantFound *out, Error *err)
{
    ReviewRequest *request = ARENA_NEW(arena, ReviewRequest, 1);
    ReviewOutcome *outcome = ARENA_NEW(arena, ReviewOutcome, 1);
    ReviewRun      own = *run;
    *request = review_request_variant(run->request, variant, arena);
    own.request = request;
    own.base = base;
    own.identity = NULL;
    own.share = (ReviewShare){0};
    if (!review_run(&own, arena, outcome, err))
        return err->code > 128 ? false : error_prefix(err, "variant '%.100s'", variant->name);
    *out = (ReviewVariantFound){.name = variant->name, .words = variant->words,
                                .word_count = variant->word_count,
                                .review = &outcome->review};
    out->review->is_strict = base->is_strict;
    review_decide(out->review);
    compare(run->profile, base, out, arena);
    return true;
}

bool review_variants(const ReviewRun *run, ReviewOutcome *outcome, Arena *arena, Error *err)
{
    const ReviewRequest *request = run->request;
    Review   *review = &outcome->review;
    Progress  progress = progress_start(run->progress, "variants", "variants",
                                        request->variant_count);
    ReviewVariantFound *list = ARENA_NEW(arena, ReviewVariantFound, request->variant_count);
    for (int i = 0; i < request->variant_count; i++) {
        if (!review_variant(run, &request->variants[i], review, arena, &list[i], err))
            return false;
        progress_update(&progress, i + 1);
    }
    progress_end(&progress, request->variant_count);
    review->variants = list;
    review->variant_count = request->variant_count;
    return true;
}
