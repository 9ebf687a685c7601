/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/case_visibility.h"

#include <math.h>
#include <string.h>

#include "vision/eye_spread.h"
#include "vision/visibility.h"

double symbol_stroke_deg(const SymbolSplit *split, double height_arcmin) {
    double height_px = (split->box[3] - split->box[1]) * split->light.content_height;
    return height_arcmin / 60 * split->stroke_px / height_px;
}

void case_visibility_start(const ReviewRequest *request, const SymbolSplit *split, ReviewCase *c,
                           Arena *arena) {
    const double nan = (double)NAN;
    const ReviewVisibility *asked = &request->visibility;
    CaseVisibility *list = ARENA_NEW(arena, CaseVisibility, asked->age_count + 1);
    CaseVisibility unknown = {.size_arcmin = 60 * symbol_stroke_deg(split, c->height_arcmin),
                              .glance_s = asked->glance_s,
                              .veil_times = 1,
                              .adapted_cd_m2 = nan,
                              .threshold_cd_m2 = nan,
                              .level = nan,
                              .low = nan,
                              .high = nan};
    double own = request->observer.age_years;
    c->visibilities = list;
    c->visibility_count = 0;
    for (int i = -1; i < asked->age_count; i++) {
        double age = i < 0 ? own : asked->ages[i];
        if (i >= 0 && age == own) continue;
        CaseVisibility *v = &list[c->visibility_count++];
        *v = unknown;
        v->age_years = age;
        v->is_observer = i < 0;
    }
}

/* Far enough from the observer's for the line to be known. */
static double other_age(double own) {
    double middle = 0.5 * (VISIBILITY_AGE_MIN + VISIBILITY_AGE_MAX);
    return own < middle ? VISIBILITY_AGE_MAX : VISIBILITY_AGE_MIN;
}

static double veil_at(const Setup *lit, const EyeLook *look, double age_years, Arena scratch) {
    ReviewRequest request = *lit->request;
    Setup setup = *lit;
    request.observer.age_years = age_years;
    setup.request = &request;
    return eye_read(&setup, look, scratch).veil;
}

/* Half the interval over the veil: of the older and the younger eye alike, whose paths are the
 * same. */
static double doubt_of(const EyeReading *reading) {
    MeanInterval range = reading->veil_range;
    double half = fmax(range.high - reading->veil, reading->veil - range.low);
    return half > 0 ? half / reading->veil : 0;
}

void case_visibility_veils(const Setup *lit, const EyeLook *look, const EyeReading *observers,
                           ReviewCase *c, Arena *arena) {
    double own = lit->request->observer.age_years, other = other_age(own), rise = 0;
    if (!(observers->veil > 0)) return;
    CaseVisibility *list = ARENA_NEW(arena, CaseVisibility, c->visibility_count);
    memcpy(list, c->visibilities, (size_t)c->visibility_count * sizeof *list);
    if (c->visibility_count > 1)
        rise = (veil_at(lit, look, other, *arena) / observers->veil - 1) /
               (eye_spread_aging(other) - eye_spread_aging(own));
    for (int i = 0; i < c->visibility_count; i++) {
        double aging = eye_spread_aging(list[i].age_years) - eye_spread_aging(own);
        list[i].veil_times = 1 + rise * aging;
        list[i].veil_doubt = doubt_of(observers);
    }
    c->visibilities = list;
}
