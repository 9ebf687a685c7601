/* SPDX-License-Identifier: Apache-2.0 */
#include "review/verdict.h"

#include <math.h>

const char *const verdict_names[5] = {"pass", "fail", "too close", "cannot be judged"};
const char *const open_names[OPEN_COUNT + 1] = {[OPEN_BY_PATHS] = "paths",
                                                [OPEN_BY_PANEL] = "panel error",
                                                [OPEN_BY_SUN] = "sun's image",
                                                [OPEN_BY_VEIL] = "veil",
                                                [OPEN_BY_IMAGE] = "image in glass"};

const char *const unjudged_names[UNJUDGED_COUNT + 1] = {[UNJUDGED_HIDDEN] = "hidden",
                                                        [UNJUDGED_PANEL] = "panel not usable",
                                                        [UNJUDGED_DATA] = "no optical data",
                                                        [UNJUDGED_LIMIT] = "no limit",
                                                        [UNJUDGED_FIGURE] = "no figure"};
const char *const kept_names[KEPT_COUNT + 1] = {
    [KEPT_HIDDEN] = "hidden", [KEPT_SECURITY] = "visual security"};
const char *const ambient_names[5] = {"night", "twilight", "day", "sun"};

const char *const rest_kinds[REST_KINDS + 1] = {"panel", "material", "eye", "occupant", "limits"};
const char *const rest_bases[REST_BASES + 1] = {
    "measured", "synthetic", "not stated",           "guessed", "without data", "given", "proposed",
    "present",  "nobody",    "read in the standard", "quoted"};

int verdict_rank(Verdict verdict) {
    static const int RANKS[4] = {
        [VERDICT_PASS] = 0, [VERDICT_TOO_CLOSE] = 1, [VERDICT_UNJUDGED] = 2, [VERDICT_FAIL] = 3};
    return RANKS[verdict];
}

double luminance_contrast(double one, double other, double added) {
    double brighter = fmax(one, other) + added, darker = fmin(one, other) + added;
    return darker > 0 ? brighter / darker : brighter > 0 ? (double)INFINITY : 1;
}

ReviewCase review_case_unknown(void) {
    ReviewCase c = {.limit_id = -1, .verdict = VERDICT_UNJUDGED, .unjudged = UNJUDGED_HIDDEN};
    CaseLuminances *l = &c.luminance_cd_m2;
    c.margin = c.contrast_ratio = c.contrast_low = c.contrast_high = c.contrast_with_veil =
        c.height_arcmin = c.stroke_ratio = c.jnd = c.visibility = (double)NAN;
    l->foreground = l->background = l->reflected = l->mirror = l->scattered = l->veil = (double)NAN;
    c.reflected_range = (MeanInterval){(double)NAN, (double)NAN};
    c.eye_failed_share = c.precision_asked = c.precision_reached = c.alike_within = (double)NAN;
    c.glasses_transmittance = 1;
    c.own_reflected = (double)NAN;
    c.whole = case_whole_unknown();
    return c;
}

bool limit_is_open(const LimitVerdict *limit) {
    return !limit->is_advice && limit->verdict == VERDICT_TOO_CLOSE && !isnan(limit->found);
}

bool case_is_undecidable(const ReviewCase *c) {
    return c->open_by > OPEN_BY_PATHS;
}

bool review_is_seen(double visible_share) {
    return visible_share > SEEN_LEAST;
}

bool case_is_seen(const ReviewCase *c) {
    return c->must_not_be_read ? c->visible_share > 0 : review_is_seen(c->visible_share);
}

KeptBy case_kept_by(const ReviewCase *c) {
    if (!c->must_not_be_read || c->verdict != VERDICT_PASS) return KEPT_NOT;
    return case_is_seen(c) || c->image_count ? KEPT_SECURITY : KEPT_HIDDEN;
}

bool review_case_counts(const ReviewCase *c) {
    if (c->verdict != VERDICT_UNJUDGED) return true;
    return c->unjudged != UNJUDGED_LIMIT && !(c->is_optional && c->unjudged == UNJUDGED_HIDDEN);
}

CaseWhole case_whole_unknown(void) {
    const double nan = (double)NAN;
    return (CaseWhole){{nan, nan, nan, nan}, nan, {nan, nan}, nan, nan};
}
