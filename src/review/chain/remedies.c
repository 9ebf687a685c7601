/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/remedies.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "review/finding.h"
#include "review/judge.h"
#include "review/pane_verdict.h"
#include "review/private_image.h"
#include "review/quantity.h"
#include "review/road_verdict.h"
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
    *remedy = (CaseRemedy){.what = what,
                           .contrast_ratio = then->contrast_ratio,
                           .level = then->level,
                           .then = *after,
                           .verdict = then->verdict};
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

/* ---- what else a level changes ----------------------------------------------------------- */

/* A display that is `factor` times as bright as at that level; NaN: at any. eye: the only one
 * that sees it so; NULL: all do. */
typedef struct LevelChange {
    const char *display, *eye;
    double level, factor;
    const ReviewCase *of; /* whose remedy it is; or NULL */
} LevelChange;

static bool is_named(const char *name, const char *other) {
    return name && other && !strcmp(name, other);
}

static void move_line(LimitVerdict *line, double by, const double found_low_high[3]) {
    line->found += by * found_low_high[0];
    line->low += by * found_low_high[1];
    line->high += by * found_low_high[2];
    line->verdict = quantity_verdict(line);
}

/* The lines of a finding with it, in their order; of what it does not change its own. */
static const LimitVerdict *lines_with(const Profile *profile, const LevelChange *change,
                                      const Finding *f, Arena *arena) {
    double by = change->factor - 1;
    LimitVerdict *lines = ARENA_NEW(arena, LimitVerdict, f->limit_count);
    if (f->limit_count) memcpy(lines, f->limits, (size_t)f->limit_count * sizeof *lines);
    if (f->c && is_named(f->c->display, change->display) &&
        (isnan(change->level) || f->c->level == change->level)) {
        Remedying m = {.profile = profile, .c = f->c, .arena = arena};
        ReviewCase then =
            judged_with(&m, change->factor, f->c->luminance_cd_m2.reflected - own_light(f->c));
        return then.limit_count == f->limit_count ? then.limits : lines;
    }
    if (f->pane && is_named(f->pane->shows, change->display))
        move_line(lines, by, (double[3]){lines->found, lines->low, lines->high});
    for (int i = 0; f->gaze && f->gaze->road && i < f->limit_count; i++)
        for (int a = 0; a < f->gaze->road->age_count; a++) {
            const RoadAge *age = &f->gaze->road->ages[a];
            for (int d = 0; d < age->display_count; d++) {
                const RoadDisplay *own = &age->displays[d];
                if (limit_kind_named(lines[i].kind) == LIMIT_THRESHOLD_INCREMENT &&
                    age->age_years == lines[i].age_years && is_named(own->display, change->display))
                    move_line(&lines[i], by,
                              (double[3]){own->increment_pct, own->increment_range.low,
                                          own->increment_range.high});
            }
        }
    return lines;
}

static int find_breaks(const Profile *profile, const LevelChange *change, const Findings *all,
                       const RemedyBreak **out, Arena *arena) {
    RemedyBreak *list = ARENA_NEW(arena, RemedyBreak, all->count);
    int count = 0;
    for (int i = 0; i < all->count; i++) {
        const Finding *f = &all->list[i];
        const LimitVerdict *then, *worst = NULL;
        if (!f->counts || (f->c && f->c == change->of) ||
            (change->eye && !is_named(f->viewer, change->eye)))
            continue;
        then = lines_with(profile, change, f, arena);
        for (int k = 0; k < f->limit_count; k++)
            if (limit_counts(&f->limits[k]) && f->limits[k].verdict == VERDICT_PASS &&
                then[k].verdict != VERDICT_PASS && (!worst || limit_is_worse(&then[k], worst)))
                worst = &then[k];
        if (worst) list[count++] = (RemedyBreak){f->subject, f->viewer, *worst};
    }
    *out = list;
    return count;
}

void remedies_judge(const Profile *profile, Review *review, Arena *arena) {
    Findings all = review_findings(review, arena);
    for (int i = 0; i < all.count; i++) {
        const ReviewCase *c = all.list[i].c;
        CaseRemedy *remedy = c && c->remedy_count ? c->remedies : NULL;
        if (!remedy) continue;
        LevelChange change = {c->display, c->must_not_be_read ? c->eye : NULL, c->level,
                              remedy->level / c->level, c};
        remedy->break_count = find_breaks(profile, &change, &all, &remedy->breaks, arena);
    }
    for (int i = 0; i < review->pane_image_count; i++) {
        PaneFinding *f = &review->pane_images[i];
        LevelChange change = {f->shows, NULL, (double)NAN, pane_level_share(f), NULL};
        bool is_wanted = f->has_limit && !f->none && f->limit.verdict != VERDICT_PASS;
        if (is_wanted && !isnan(change.factor))
            f->break_count = find_breaks(profile, &change, &all, &f->breaks, arena);
    }
}
