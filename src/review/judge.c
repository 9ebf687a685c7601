/* SPDX-License-Identifier: Apache-2.0 */
#include "review/judge.h"

#include <math.h>

#include "base/confidence.h"
#include "base/count.h"
#include "base/mathd.h"
#include "review/private_image.h"
#include "review/visibility_figure.h"

#define ROOT_HALF 0.70710678118654752
/* of what may be true: more is reported as what no paths decide */
#define UNDECIDABLE_SHARE 0.5

/* A figure with its 95 % interval. */
typedef struct Figure {
    double found, low, high;
} Figure;

void judge_ambient(ReviewCase *review_case, const Profile *profile, bool sun_on_display) {
    review_case->ambient = profile_ambient(profile, review_case->display_lux, sun_on_display);
}

/* ---- contrasts --------------------------------------------------------------------------- */

/* What the eye gets of the brighter and the darker part: shares of what each emits. */
typedef struct Shown {
    double brighter, darker;
} Shown;

static double contrast_of(const CaseLuminances *l, Shown shown, double reflected) {
    double brighter = fmax(l->foreground, l->background);
    double darker = fmin(l->foreground, l->background);
    if (isnan(l->foreground) || isnan(l->background)) return (double)NAN;
    return luminance_contrast(shown.brighter * brighter, shown.darker * darker, reflected);
}

static const Shown AS_IT_IS = {1, 1};

/* One end of the interval, where so much is reflected; sign: -1 the low one. The doubts of
 * sampling, of what the panel reflects and of each of its two luminances are independent. */
static double contrast_end(const ReviewCase *c, double reflected, double sign) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double reflects = sign * INTERVAL_SIGMAS * c->panel.reflection_error;
    double emits = sign * INTERVAL_SIGMAS * c->panel.emission_error;
    double middle = c->contrast_ratio, squares = 0;
    const double ends[] = {contrast_of(l, AS_IT_IS, reflected),
                           contrast_of(l, AS_IT_IS, l->reflected * fmax(1 - reflects, 0)),
                           contrast_of(l, (Shown){fmax(1 + emits, 0), 1}, l->reflected),
                           contrast_of(l, (Shown){1, fmax(1 - emits, 0)}, l->reflected)};
    if (isinf(middle) || (reflects == 0 && emits == 0)) return ends[0];
    for (int i = 0; i < COUNT_OF(ends); i++) squares += (ends[i] - middle) * (ends[i] - middle);
    return sign < 0 ? fmax(middle - sqrt(squares), 1) : middle + sqrt(squares);
}

void judge_contrasts(ReviewCase *review_case, MeanInterval reflected) {
    ReviewCase *c = review_case;
    const CaseLuminances *l = &c->luminance_cd_m2;
    double veil = isnan(l->veil) ? 0 : l->veil;
    c->reflected_range = reflected;
    c->contrast_ratio = contrast_of(l, AS_IT_IS, l->reflected);
    c->contrast_low = contrast_end(c, reflected.high, -1);
    c->contrast_high = contrast_end(c, reflected.low, 1);
    c->contrast_with_veil = contrast_of(l, AS_IT_IS, l->reflected + veil);
}

/* ---- figures ----------------------------------------------------------------------------- */

/* A contrast ratio is 1 + d/(k + r): d between the two luminances, k the darker, r reflected; a
 * veil v makes it 1 + d/(k + r + v). So 1/(ratio - 1) grows by v/d, and by as much at the ends
 * of an interval as for the case's own ratio. Rising with the ratio, so that ends stay ends. */
static double below_veil(const ReviewCase *c, double ratio) {
    if (!(ratio > 1 && c->contrast_ratio > 1 && c->contrast_with_veil > 1)) return ratio;
    double veil = 1 / (c->contrast_with_veil - 1) - 1 / (c->contrast_ratio - 1);
    return 1 + 1 / (1 / (ratio - 1) + veil);
}

static Figure contrast_figure(const ReviewCase *c, const Profile *profile) {
    if (!profile->uses_veil) return (Figure){c->contrast_ratio, c->contrast_low, c->contrast_high};
    return (Figure){c->contrast_with_veil, below_veil(c, c->contrast_low),
                    below_veil(c, c->contrast_high)};
}

static Figure level_figure(const CaseVisibility *of) {
    return of ? (Figure){of->level, of->low, of->high} : (Figure){NAN, NAN, NAN};
}

static Figure figure_of(const ProfileLimit *limit, const ReviewCase *c, const Profile *profile) {
    LimitKind kind = limit->kind;
    if (kind == LIMIT_VISIBILITY_LEVEL)
        return level_figure(visibility_decisive(c, limit->is_upper));
    if (kind == LIMIT_CHARACTER_HEIGHT)
        return (Figure){c->height_arcmin, c->height_arcmin, c->height_arcmin};
    if (kind == LIMIT_STROKE_RATIO)
        return (Figure){c->stroke_ratio, c->stroke_ratio, c->stroke_ratio};
    if (!limit_kinds[kind].is_contrast) return (Figure){NAN, NAN, NAN};
    if (limit_kinds[kind].falls)
        return (Figure){contrast_from_ratio(kind, c->contrast_ratio),
                        contrast_from_ratio(kind, c->contrast_high),
                        contrast_from_ratio(kind, c->contrast_low)};
    Figure ratio = contrast_figure(c, profile);
    return (Figure){contrast_from_ratio(kind, ratio.found), contrast_from_ratio(kind, ratio.low),
                    contrast_from_ratio(kind, ratio.high)};
}

/* ---- limits ------------------------------------------------------------------------------ */

static bool is_asked(const ProfileLimit *limit, const ReviewCase *c) {
    if (!limit->ambients[c->ambient]) return false;
    if (limit_kinds[limit->kind].falls != c->must_not_be_read) return false;
    return !limit->slope.has_slope || !(c->height_arcmin < limit->slope.from_arcmin ||
                                        c->height_arcmin > limit->slope.to_arcmin);
}

static double value_at(const ProfileLimit *limit, double height_arcmin) {
    const LimitSlope *s = &limit->slope;
    if (!s->has_slope) return limit->value;
    return limit->value + s->per_arcmin * (s->reference_arcmin - height_arcmin);
}

/* Nothing, or nothing that hangs on the light, of the case can be judged, whatever its
 * figures. */
static bool is_unjudged(const ReviewCase *c, bool is_of_light) {
    return !case_is_seen(c) || c->panel.is_unusable ||
           (is_of_light && c->without_data_share > UNJUDGED_DATA_SHARE);
}

/* Whose level it is; 0: the limit is about nobody's. */
static double age_of(const ProfileLimit *limit, const ReviewCase *c) {
    if (limit->kind != LIMIT_VISIBILITY_LEVEL) return 0;
    const CaseVisibility *of = visibility_decisive(c, limit->is_upper);
    return of ? of->age_years : 0;
}

static LimitVerdict judge_limit(const ProfileLimit *limit, const ReviewCase *c,
                                const Profile *profile) {
    const LimitKindFacts *kind = &limit_kinds[limit->kind];
    bool is_visible = case_is_seen(c);
    Figure figure = is_visible ? figure_of(limit, c, profile) : (Figure){NAN, NAN, NAN};
    LimitVerdict judged = {.name = limit->name,
                           .kind = kind->name,
                           .unit = kind->unit,
                           .source = limit->source,
                           .value = value_at(limit, c->height_arcmin),
                           .read_in_the_standard = limit->read_in_the_standard,
                           .is_upper = limit->is_upper,
                           .is_advice = limit->is_advice,
                           .found = figure.found,
                           .low = figure.low,
                           .high = figure.high,
                           .age_years = age_of(limit, c)};
    judged.margin = quantity_margin(limit->kind, limit->is_upper, judged.found, judged.value);
    judged.verdict =
        is_unjudged(c, kind->is_of_light) ? VERDICT_UNJUDGED : quantity_verdict(&judged);
    return judged;
}

/* ---- the case ---------------------------------------------------------------------------- */

/* Advice does not, nor what is not measured: of a shape that has no strokes their width. */
static bool counts(const ProfileLimit *limit, const ReviewCase *c) {
    if (limit->kind == LIMIT_STROKE_RATIO && isnan(c->stroke_ratio)) return false;
    return !limit->is_advice && limit_kinds[limit->kind].is_measured;
}

static Verdict worse(Verdict one, Verdict other) {
    return verdict_rank(one) >= verdict_rank(other) ? one : other;
}

static Unjudged why_unjudged(const ReviewCase *c, int counted) {
    if (c->verdict != VERDICT_UNJUDGED) return UNJUDGED_NOT;
    if (!case_is_seen(c) && !c->image_count) return UNJUDGED_HIDDEN;
    if (c->panel.is_unusable) return UNJUDGED_PANEL;
    if (!counted) return UNJUDGED_LIMIT;
    return c->without_data_share > UNJUDGED_DATA_SHARE ? UNJUDGED_DATA : UNJUDGED_FIGURE;
}

/* The share of sampling in a figure's doubt below or above it: the panel's stated errors are
 * the rest, and no path lessens those. Of all contrasts it is the ratio's. */
static double sampling_share(const ReviewCase *c, const LimitVerdict *limit, bool is_below) {
    if (limit_kind_named(limit->kind) == LIMIT_VISIBILITY_LEVEL)
        return visibility_doubt(c, visibility_decisive(c, limit->is_upper), is_below).sampling;
    double end = is_below ? c->reflected_range.high : c->reflected_range.low;
    double all = is_below ? c->contrast_low : c->contrast_high;
    double half = contrast_of(&c->luminance_cd_m2, AS_IT_IS, end) - c->contrast_ratio;
    double share = half / (all - c->contrast_ratio);
    return share < 1 ? share : 1;
}

/* Shares of a normal variable of mean `at` and spread 1 within +-distance. */
static double share_within(double at, double distance) {
    return 0.5 * (erfc_d((at - distance) * ROOT_HALF) - erfc_d((at + distance) * ROOT_HALF));
}

/* What a limit leaves open. The three parts of the half of the interval towards it: what
 * paths lessen, in standard errors; what is known of the sun's image, which adds to that as it
 * is; what the panel leaves in doubt, which adds as squares. */
typedef struct OpenLimit {
    double away; /* between figure and limit */
    double error, sun, panel;
} OpenLimit;

static OpenLimit open_limit(const ReviewCase *c, const LimitVerdict *limit, double fixed) {
    bool is_above = limit->found > limit->value;
    bool falls = limit_kinds[limit_kind_named(limit->kind)].falls;
    double half = is_above ? limit->found - limit->low : limit->high - limit->found;
    double share = sampling_share(c, limit, is_above != falls);
    return (OpenLimit){.away = fabs(limit->found - limit->value),
                       .error = (1 - fixed) * share * half / NORMAL_QUANTILE,
                       .sun = fixed * share * half,
                       .panel = half * sqrt(fmax(1 - share * share, 0))};
}

/* Would more paths decide it? Not where it lies, more likely than not, within what none
 * lessen. */
static bool is_decidable(const OpenLimit *open) {
    double fixed = hypot_d(open->sun, open->panel);
    return open->error > 0 &&
           share_within(open->away / open->error, fixed / open->error) <= UNDECIDABLE_SHARE;
}

/* Is most of what paths do not lessen the veil's? */
static bool is_veils(const ReviewCase *c, const LimitVerdict *limit) {
    if (limit_kind_named(limit->kind) != LIMIT_VISIBILITY_LEVEL) return false;
    return visibility_doubt(c, visibility_decisive(c, limit->is_upper), limit->found > limit->value)
        .is_veils;
}

/* The first limit that no paths decide says why. */
void judge_open(ReviewCase *review_case, double fixed) {
    ReviewCase *c = review_case;
    c->open_by = OPEN_NOT;
    if (c->verdict != VERDICT_TOO_CLOSE) return;
    for (int i = 0; i < c->limit_count && !case_is_undecidable(c); i++) {
        const LimitVerdict *limit = &c->limits[i];
        if (!limit_is_open(limit)) continue;
        OpenLimit open = open_limit(c, limit, fixed);
        c->open_by = limit->by_pane          ? OPEN_BY_IMAGE
                     : is_decidable(&open)   ? OPEN_BY_PATHS
                     : open.panel < open.sun ? OPEN_BY_SUN
                     : is_veils(c, limit)    ? OPEN_BY_VEIL
                                             : OPEN_BY_PANEL;
    }
}

/* The limits of a case as they are judged. */
typedef struct Judging {
    const Profile *profile;
    LimitVerdict *limits;
    double greatest; /* of the contrasts that are required: ratio, or security */
    int counted;
} Judging;

static void hold_against(const ProfileLimit *limit, Judging *to, ReviewCase *c) {
    const LimitKindFacts *kind = &limit_kinds[limit->kind];
    LimitVerdict judged = to->limits[c->limit_count++] = judge_limit(limit, c, to->profile);
    if (!counts(limit, c)) return;
    to->counted++;
    c->verdict = worse(judged.verdict, c->verdict);
    double asked = kind->falls ? judged.value : ratio_from_contrast(limit->kind, judged.value);
    if (kind->is_contrast && !limit->is_upper && asked > to->greatest) {
        to->greatest = asked;
        c->limit_id = c->limit_count - 1;
        c->margin = judged.margin;
    }
}

/* ---- images in glass --------------------------------------------------------------------- */

/* The case as if the image were the symbol: what a limit of visual security looks at. Nothing
 * is known of how much of its light came by what has no data. */
static ReviewCase seen_by_pane(const ReviewCase *c, const CaseImage *image) {
    ReviewCase as = *c;
    as.visible_share = image->shown_share;
    as.height_arcmin = image->height_arcmin;
    as.contrast_ratio = image->contrast_ratio;
    as.contrast_low = image->contrast_low;
    as.contrast_high = image->contrast_high;
    as.without_data_share = 0;
    return as;
}

static void hold_image(const ProfileLimit *limit, CaseImage *image, Judging *to, ReviewCase *c) {
    ReviewCase as = seen_by_pane(c, image);
    LimitVerdict judged = judge_limit(limit, &as, to->profile);
    judged.by_pane = image->pane;
    to->limits[c->limit_count++] = judged;
    if (!counts(limit, c)) return;
    to->counted++;
    image->verdict = worse(judged.verdict, image->verdict);
    c->verdict = worse(judged.verdict, c->verdict);
    if (c->limit_id >= 0 && !(judged.margin < c->margin)) return;
    c->limit_id = c->limit_count - 1;
    c->margin = judged.margin;
}

/* Each by the limits that the symbol itself is held against. */
static void hold_images(Judging *to, ReviewCase *c, Arena *arena) {
    const Profile *profile = to->profile;
    CaseImage *images = ARENA_NEW(arena, CaseImage, c->image_count);
    for (int k = 0; k < c->image_count; k++) {
        int before = to->counted;
        images[k] = c->images[k];
        images[k].verdict = VERDICT_PASS;
        for (int i = 0; i < profile->limit_count && !profile->is_security_own; i++)
            if (is_asked(&profile->limits[i], c))
                hold_image(&profile->limits[i], &images[k], to, c);
        if (to->counted == before) hold_image(&profile->security, &images[k], to, c);
    }
    c->images = images;
}

void judge_case(ReviewCase *review_case, const Profile *profile, Arena *arena) {
    ReviewCase *c = review_case;
    int limits = (profile->limit_count + 1) * (c->image_count + 1);
    Judging to = {profile, ARENA_NEW(arena, LimitVerdict, limits), -INFINITY, 0};
    bool is_hidden = c->must_not_be_read && c->visible_share <= 0;
    bool is_own = c->must_not_be_read && profile->is_security_own;
    c->limits = to.limits;
    c->limit_count = 0;
    c->limit_id = -1;
    c->margin = NAN;
    c->verdict = VERDICT_PASS;
    c->visibilities = visibility_levels(c, arena);
    for (int i = 0; i < profile->limit_count && !is_own && !is_hidden; i++)
        if (is_asked(&profile->limits[i], c)) hold_against(&profile->limits[i], &to, c);
    if (c->must_not_be_read && !is_hidden && !to.counted) hold_against(&profile->security, &to, c);
    if (c->image_count) hold_images(&to, c, arena);
    if (!is_hidden && (!to.counted || is_unjudged(c, false))) c->verdict = VERDICT_UNJUDGED;
    c->unjudged = why_unjudged(c, to.counted);
    if (c->verdict != VERDICT_TOO_CLOSE) c->open_by = OPEN_NOT;
}
