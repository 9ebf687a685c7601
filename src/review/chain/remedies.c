/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/remedies.h"

#include <math.h>

#include "base/mathd.h"
#include "review/judge.h"
#include "review/private_image.h"
#include "review/quantity.h"
#include "review/terms.h"

#define SEEN_CD_M2 0.01    /* what is darker no eye reads */
#define BRIGHTER_MOST 10.0 /* times as bright: more is not built */

typedef struct Remedying {
    const Profile *profile;
    double level_most; /* that the display can be driven to */
    const ReviewCase *c;
    int limit; /* that it is for */
    Arena *arena;
} Remedying;

/* ---- judged again ------------------------------------------------------------------------ */

static double own_light(const ReviewCase *c) {
    return isnan(c->own_reflected) ? 0 : fmin(c->own_reflected, c->luminance_cd_m2.reflected);
}

/* The case with the display that many times as bright, judged again; other: cd m^-2 that it
 * reflects beside its own light. The doubt is in proportion. */
static ReviewCase judged_with(const Remedying *m, double brighter, double other) {
    ReviewCase out = *m->c;
    CaseLuminances *l = &out.luminance_cd_m2;
    double before = l->reflected;
    l->foreground *= brighter;
    l->background *= brighter;
    l->reflected = other + brighter * own_light(m->c);
    l->veil += (brighter - 1) * m->c->veil_displays;
    double scale = before > 0 ? l->reflected / before : 1;
    out.level *= brighter;
    out.images = case_images_scaled(&out, brighter, m->arena);
    judge_contrasts(&out, (MeanInterval){scale * m->c->reflected_range.low,
                                         scale * m->c->reflected_range.high});
    judge_case(&out, m->profile, m->arena);
    return out;
}

static bool keeps_limit(const Remedying *m, const ReviewCase *then) {
    return then->limit_count == m->c->limit_count && then->limits[m->limit].verdict == VERDICT_PASS;
}

/* As much more is reflected as the interval is wide: fresh paths find what is kept then kept as
 * well. */
static double doubt_of(const Remedying *m) {
    double half = 0.5 * (m->c->reflected_range.high - m->c->reflected_range.low);
    return limit_wants_less(&m->c->limits[m->limit]) ? -half : half;
}

/* Of the limits that hang on the light, count and are missed, or that no paths decide, the one
 * that is missed by most; -1. */
static int limit_to_mend(const ReviewCase *c) {
    int worst = -1;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        const ReviewQuantity *of = quantity_of(limit);
        bool is_known = limit->verdict == VERDICT_FAIL || limit->verdict == VERDICT_TOO_CLOSE;
        bool is_missed = limit->margin < 0 || case_is_undecidable(c);
        if (limit->is_advice || !is_known || !is_missed || !of->is_of_light) continue;
        if (worst < 0 || limit->margin < c->limits[worst].margin) worst = i;
    }
    return worst;
}

static double ratio_needed(const Remedying *m) {
    const LimitVerdict *limit = &m->c->limits[m->limit];
    return ratio_from_contrast(limit_kind_named(limit->kind), limit->value);
}

static double veil_of(const Remedying *m) {
    double veil = m->c->luminance_cd_m2.veil;
    bool counts = m->profile->uses_veil && !m->c->must_not_be_read;
    return counts && veil > 0 ? veil : 0;
}

/* With as much more reflected as the interval is wide. */
static ReviewCase judged_brighter(const Remedying *m, double factor) {
    double other = m->c->luminance_cd_m2.reflected - own_light(m->c);
    return judged_with(m, factor, fmax(other + doubt_of(m), 0));
}

/* ---- what no closed form gives ----------------------------------------------------------- */

/* What is no contrast of the symbol itself. */
static bool is_searched(const Remedying *m) {
    const LimitVerdict *limit = &m->c->limits[m->limit];
    return limit->by_pane || !quantity_is_contrast(limit_kind_named(limit->kind));
}

static double margin_by(const Remedying *m, double factor) {
    ReviewCase then = judged_brighter(m, factor);
    return then.limit_count == m->c->limit_count ? then.limits[m->limit].margin : (double)NAN;
}

#define HALVINGS 24

/* The factor between 1 and `end`, nearest to 1, with which the limit's figure keeps it; NaN:
 * even `end` does not. */
static double factor_by(const Remedying *m, double end) {
    double misses = 1, keeps = end;
    if (!(margin_by(m, end) >= 0)) return (double)NAN;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = sqrt(misses * keeps);
        *(margin_by(m, middle) >= 0 ? &keeps : &misses) = middle;
    }
    return keeps;
}

/* ---- brightness -------------------------------------------------------------------------- */

/* To three digits, away from 1. */
static double rounded_out(double factor) {
    double digit = pow_d(10, floor(log10_d(factor)) - 2);
    return digit * (factor > 1 ? ceil(factor / digit) : floor(factor / digit));
}

/* By how much the display must be brighter, or darker, for a contrast,
 * (H x + R + O x) / (L x + R + O x) = C, O its own light that is reflected, or scattered in the
 * eye, R all other; NaN: no brightness does it. */
static double brighter_for(const CaseLuminances *l, double own, double other, double needed) {
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    double gain = high + own - needed * (low + own);
    return gain > 0 ? other * (needed - 1) / gain : (double)NAN;
}

/* Three digits, towards what surely keeps the limit. */
static const char *level_words(double level, int away, Arena *arena) {
    double percent = 100 * level, digit = pow_d(10, floor(log10_d(percent)) - 2);
    double whole = floor(percent / digit + 0.5);
    if (away > 0 && whole * digit < percent * (1 - 1e-9)) whole++;
    if (away < 0 && whole * digit > percent * (1 + 1e-9)) whole--;
    return arena_format(arena, "%.4g %%", whole * digit);
}

/* A level that the display has, and of which an eye sees something. */
static bool can_be_set(const Remedying *m, double factor) {
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    double level = factor * m->c->level;
    return factor < 1 ? factor * fmax(l->foreground, l->background) >= SEEN_CD_M2
                      : level <= fmax(m->level_most, m->c->level) * (1 + 1e-9);
}

/* Nothing that leaves the figure within its interval. */
static void set_remedy(const Remedying *m, double factor, const ReviewCase *then, ReviewCase *c) {
    const LimitVerdict *before = &c->limits[m->limit], *after = &then->limits[m->limit];
    if (then->limit_count != c->limit_count ||
        !(before->is_upper ? after->found < before->low : after->found > before->high))
        return;
    const char *from = level_words(c->level, 0, m->arena);
    const char *to = level_words(then->level, factor > 1 ? 1 : -1, m->arena);
    const char *what = factor > 1 ? arena_format(m->arena, TERM_RAISE, from, to)
                                  : arena_format(m->arena, TERM_DIM "%s", from, to,
                                                 c->must_not_be_read ? TERM_TOWARDS : "");
    CaseRemedy *remedy = ARENA_NEW(m->arena, CaseRemedy, 1);
    *remedy = (CaseRemedy){what, then->contrast_ratio, then->level, *after, then->verdict};
    c->remedies = remedy;
    c->remedy_count = 1;
}

#define DIMMEST 0.01 /* of what must not be read: who may read it does so no more */
#define TRIES 40
#define TRY_STEP 1.05 /* the panel's errors are in the interval, too */

/* The least with which the limit is judged to be kept. */
void case_remedies(const Profile *profile, double level_most, ReviewCase *c, Arena *arena) {
    Remedying m = {profile, level_most, c, limit_to_mend(c), arena};
    if (c->verdict == VERDICT_UNJUDGED || m.limit < 0) return;
    bool is_private = c->must_not_be_read;
    bool wants_less = limit_wants_less(&c->limits[m.limit]);
    double own = own_light(c), other = c->luminance_cd_m2.reflected - own;
    double veil = veil_of(&m), grows = veil > 0 ? c->veil_displays : 0;
    double most = fmax(other + veil - grows + 2 * doubt_of(&m), 0);
    double end = is_private ? DIMMEST : wants_less ? 1 / BRIGHTER_MOST : BRIGHTER_MOST;
    double x = is_searched(&m)
                   ? factor_by(&m, end)
                   : brighter_for(&c->luminance_cd_m2, own + grows, most, ratio_needed(&m));
    for (int i = 0; i < TRIES && x > 0 && x < BRIGHTER_MOST; i++) {
        double factor = rounded_out(x);
        ReviewCase sure = judged_brighter(&m, factor);
        x *= wants_less ? 1 / TRY_STEP : TRY_STEP;
        if (!can_be_set(&m, factor) || (is_private && factor < DIMMEST)) return;
        if (!keeps_limit(&m, &sure)) continue;
        ReviewCase then = judged_with(&m, factor, other);
        set_remedy(&m, factor, &then, c);
        return;
    }
}

/* ---- as dark as it may be ---------------------------------------------------------------- */

static bool is_least_of_contrast(const LimitVerdict *limit) {
    return quantity_is_contrast(limit_kind_named(limit->kind)) && !limit->is_advice &&
           !limit->is_upper;
}

static bool keeps_all(const Remedying *m, double factor, double other) {
    Remedying own = *m;
    Arena scratch = *m->arena;
    own.arena = &scratch;
    ReviewCase then = judged_with(&own, factor, other);
    for (int i = 0; i < then.limit_count; i++)
        if (is_least_of_contrast(&then.limits[i]) && then.limits[i].verdict != VERDICT_PASS)
            return false;
    return true;
}

/* The least factor from `from` on with which all are judged to be kept; the interval narrows
 * as it grows. */
static double surely_from(const Remedying *m, double from, double other) {
    double low = from, high = BRIGHTER_MOST;
    if (!keeps_all(m, high, other)) return (double)INFINITY;
    for (int i = 0; i < TRIES; i++) {
        double middle = sqrt(low * high);
        *(keeps_all(m, middle, other) ? &high : &low) = middle;
    }
    return high;
}

CaseLeast case_least_level(const Profile *profile, const ReviewCase *c, Arena scratch) {
    Remedying m = {.profile = profile, .c = c, .arena = &scratch};
    double own = own_light(c), other = c->luminance_cd_m2.reflected - own, least = -1;
    double veil = veil_of(&m), grows = veil > 0 ? c->veil_displays : 0;
    if (c->verdict == VERDICT_UNJUDGED || !(c->level > 0)) return (CaseLeast){NAN, NAN};
    for (m.limit = 0; m.limit < c->limit_count; m.limit++) {
        if (!is_least_of_contrast(&c->limits[m.limit])) continue;
        double x =
            brighter_for(&c->luminance_cd_m2, own + grows, other + veil - grows, ratio_needed(&m));
        least = fmax(least, x <= BRIGHTER_MOST ? x : (double)INFINITY);
    }
    if (least < 0) return (CaseLeast){NAN, NAN};
    least = fmax(least,
                 SEEN_CD_M2 / fmax(c->luminance_cd_m2.foreground, c->luminance_cd_m2.background));
    double sure = isinf(least) ? least : surely_from(&m, fmax(least, 1e-6), other);
    return (CaseLeast){least * c->level, sure * c->level};
}
