/* SPDX-License-Identifier: Apache-2.0 */
#include "review/vary/riders.h"

#include "review/request/request_parameters.h"

#define ROOM_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

static void add_rider(ReviewRun *run, const ReviewVariant *variant, Arena *arena)
{
    ReviewRequest *request = ARENA_NEW(arena, ReviewRequest, 1);
    ReviewRider   *rider = &run->riders[run->rider_count++];
    *request = review_request_variant(run->request, variant, arena);
    *rider = (ReviewRider){variant, request, ARENA_NEW(arena, ReviewOutcome, 1),
                           arena_reserve(ROOM_BYTES)};
}

static void add_parameter(ReviewRun *run, const ReviewParameter *p, Arena *arena)
{
    double ends[2];
    review_parameter_ends(p, ends);
    if (p->kind != PARAMETER_BRIGHTNESS) return;
    for (int i = 0; i < 2; i++) {
        if (ends[i] == p->at) continue;
        ReviewVariant *variant = ARENA_NEW(arena, ReviewVariant, 1);
        *variant = review_parameter_at(run->request, p, ends[i], arena);
        add_rider(run, variant, arena);
    }
}

void review_riders_start(ReviewRun *run, bool with_parameters, Arena *arena)
{
    const ReviewRequest *request = run->request;
    int parameters = with_parameters ? request->parameter_count : 0;
    run->rider_count = 0;
    run->riders = ARENA_NEW(arena, ReviewRider, request->variant_count + 2 * parameters);
    for (int i = 0; i < request->variant_count; i++)
        if (review_variant_is_of_levels(request, &request->variants[i]))
            add_rider(run, &request->variants[i], arena);
    for (int i = 0; i < parameters; i++) add_parameter(run, &request->parameters[i], arena);
}

void review_riders_end(ReviewRun *run)
{
    for (int i = 0; i < run->rider_count; i++) arena_release(&run->riders[i].room);
    run->rider_count = 0;
}

/* A parameter's variant is made anew whenever one asks. */
static bool is_same(const ReviewVariant *a, const ReviewVariant *b)
{
    const ReviewChange *one = &a->change, *other = &b->change;
    return a == b || (one->place == other->place && one->brightness_count == 1 &&
                      other->brightness_count == 1 &&
                      one->brightness[0].level == other->brightness[0].level);
}

const ReviewRider *review_rider_of(const ReviewRun *run, const ReviewVariant *variant)
{
    for (int i = 0; i < run->rider_count; i++)
        if (is_same(run->riders[i].variant, variant)) return &run->riders[i];
    return NULL;
}
