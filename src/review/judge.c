/* SPDX-License-Identifier: Apache-2.0 */
#include "review/judge.h"

#include <math.h>

/* A figure with its 95 % interval. */
typedef struct Figure {
    double found, low, high;
} Figure;

void judge_ambient(ReviewCase *review_case, const Profile *profile, bool sun_on_display)
{
    review_case->ambient =
        profile_ambient(profile, review_case->display_lux, sun_on_display);
}

void judge_contrasts(ReviewCase *review_case, MeanInterval reflected)
{
    ReviewCase           *c = review_case;
    const CaseLuminances *l = &c->luminance_cd_m2;
    double veil = isnan(l->veil) ? 0 : l->veil;
    c->reflected_range = reflected;
    c->contrast_ratio = luminance_contrast(l->foreground, l->background, l->reflected);
    c->contrast_low = luminance_contrast(l->foreground, l->background, reflected.high);
    c->contrast_high = luminance_contrast(l->foreground, l->background, reflected.low);
    c->contrast_with_veil =
        luminance_contrast(l->foreground, l->background, l->reflected + veil);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* A contrast ratio is 1 + d/(k + r): d between the two luminances, k the darker, r reflected; a
 * veil v makes it 1 + d/(k + r + v). So 1/(ratio - 1) grows by v/d, and by as much at the ends
 * of an interval as for the case's own ratio. Rising with the ratio, so that ends stay ends. */
static double below_veil(const ReviewCase *c, double ratio)
{
    if (!(ratio > 1 && c->contrast_ratio > 1 && c->contrast_with_veil > 1)) return ratio;
    double veil = 1 / (c->contrast_with_veil - 1) - 1 / (c->contrast_ratio - 1);
    return 1 + 1 / (1 / (ratio - 1) + veil);
}

static Figure contrast_figure(const ReviewCase *c, const Profile *profile)
{
    if (!profile->uses_veil)
        return (Figure){c->contrast_ratio, c->contrast_low, c->contrast_high};
    return (Figure){c->contrast_with_veil, below_veil(c, c->contrast_low),
                    below_veil(c, c->contrast_high)};
}

/* A contrast ratio in the words of a kind of limit; rising with it. */
static double in_words_of(LimitKind kind, double ratio)
{
    if (kind == LIMIT_LUMINANCE_CONTRAST) return ratio - 1;
    if (kind == LIMIT_MODULATION) return (ratio - 1) / (ratio + 1);
    return ratio;
}

/* The way back. */
static double ratio_of(LimitKind kind, double value)
{
    if (kind == LIMIT_LUMINANCE_CONTRAST) return value + 1;
    if (kind == LIMIT_MODULATION) return value < 1 ? (1 + value) / (1 - value) : INFINITY;
    return value;
}

static Figure figure_of(LimitKind kind, const ReviewCase *c, const Profile *profile)
{
    if (kind == LIMIT_CHARACTER_HEIGHT)
        return (Figure){c->height_arcmin, c->height_arcmin, c->height_arcmin};
    if (!limit_kinds[kind].is_contrast) return (Figure){NAN, NAN, NAN};
    Figure ratio = contrast_figure(c, profile);
    return (Figure){in_words_of(kind, ratio.found), in_words_of(kind, ratio.low),
                    in_words_of(kind, ratio.high)};
}

/* ---- limits ------------------------------------------------------------------------------ */

static bool is_asked(const ProfileLimit *limit, const ReviewCase *c)
{
    if (!limit->ambients[c->ambient]) return false;
    return !limit->slope.has_slope || !(c->height_arcmin < limit->slope.from_arcmin ||
                                        c->height_arcmin > limit->slope.to_arcmin);
}

static double value_at(const ProfileLimit *limit, double height_arcmin)
{
    const LimitSlope *s = &limit->slope;
    if (!s->has_slope) return limit->value;
    return limit->value + s->per_arcmin * (s->reference_arcmin - height_arcmin);
}

/* Comparisons with NaN are false: what is not known is too close to call. */
static Verdict verdict_of(Figure figure, double limit, bool is_upper)
{
    if (is_upper) {
        if (figure.high <= limit) return VERDICT_PASS;
        return figure.low > limit ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
    }
    if (figure.low >= limit) return VERDICT_PASS;
    return figure.high < limit ? VERDICT_FAIL : VERDICT_TOO_CLOSE;
}

static LimitVerdict judge_limit(const ProfileLimit *limit, const ReviewCase *c,
                                const Profile *profile)
{
    const LimitKindFacts *kind = &limit_kinds[limit->kind];
    bool   is_visible = c->visible_share > 0;
    Figure figure = is_visible ? figure_of(limit->kind, c, profile) : (Figure){NAN, NAN, NAN};
    double value = value_at(limit, c->height_arcmin);
    return (LimitVerdict){
        .name = limit->name, .kind = kind->name, .unit = kind->unit, .source = limit->source,
        .value = value, .read_in_the_standard = limit->read_in_the_standard,
        .is_upper = limit->is_upper, .is_advice = limit->is_advice, .found = figure.found,
        .low = figure.low, .high = figure.high,
        .margin = (limit->is_upper ? value / figure.found : figure.found / value) - 1,
        .verdict = is_visible ? verdict_of(figure, value, limit->is_upper)
                              : VERDICT_NOT_VISIBLE};
}

/* ---- the case ---------------------------------------------------------------------------- */

static bool counts(const ProfileLimit *limit)
{
    return !limit->is_advice && limit_kinds[limit->kind].is_measured;
}

static Verdict worse(Verdict one, Verdict other)
{
    return verdict_rank(one) >= verdict_rank(other) ? one : other;
}

void judge_paths(ReviewCase *review_case)
{
    ReviewCase *c = review_case;
    c->paths_to_decide = NAN;
    if (c->verdict != VERDICT_TOO_CLOSE) return;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        if (limit->is_advice || limit->verdict != VERDICT_TOO_CLOSE || isnan(limit->found))
            continue;
        bool   is_above = limit->found > limit->value;
        double half = is_above ? limit->found - limit->low : limit->high - limit->found;
        double ratio = 2 * half / fabs(limit->found - limit->value);
        c->paths_to_decide =
            fmax(c->paths_to_decide, (double)c->paths * fmax(ratio * ratio, 1));
    }
}

void judge_case(ReviewCase *review_case, const Profile *profile, Arena *arena)
{
    ReviewCase   *c = review_case;
    LimitVerdict *limits = ARENA_NEW(arena, LimitVerdict, profile->limit_count);
    double        greatest = -INFINITY;
    c->limits = limits;
    c->limit_count = 0;
    c->limit_id = -1;
    c->margin = NAN;
    c->verdict = c->visible_share > 0 ? VERDICT_PASS : VERDICT_NOT_VISIBLE;
    for (int i = 0; i < profile->limit_count; i++) {
        const ProfileLimit *limit = &profile->limits[i];
        if (!is_asked(limit, c)) continue;
        LimitVerdict judged = judge_limit(limit, c, profile);
        if (counts(limit)) c->verdict = worse(judged.verdict, c->verdict);
        double asked = ratio_of(limit->kind, judged.value);
        if (counts(limit) && limit_kinds[limit->kind].is_contrast && !limit->is_upper &&
            asked > greatest) {
            greatest = asked;
            c->limit_id = c->limit_count;
            c->margin = judged.margin;
        }
        limits[c->limit_count++] = judged;
    }
}
