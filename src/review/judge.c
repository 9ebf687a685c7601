/* SPDX-License-Identifier: Apache-2.0 */
#include "review/judge.h"

#include <math.h>
#include <string.h>

#include "base/confidence.h"
#include "base/count.h"
#include "base/mathd.h"
#include "review/ask_colour.h"
#include "review/ask_visibility_level.h"
#include "review/pane_verdict.h"
#include "review/private_image.h"
#include "review/road_verdict.h"

#define ROOT_HALF 0.70710678118654752
/* of what may be true: more is reported as what no paths decide */
#define UNDECIDABLE_SHARE 0.5

void judge_ambient(ReviewCase *review_case, const Profile *profile, bool sun_on_display) {
    review_case->ambient = profile_ambient(profile, review_case->display_lux, sun_on_display);
}

/* ---- contrasts --------------------------------------------------------------------------- */

/* Sampling, and the panel's three errors as factors. */
enum { REFLECTED, REFLECTS, BRIGHTER, DARKER, INPUTS };

static double ratio_at(const double *at, const void *user) {
    const CaseLuminances *l = user;
    if (isnan(l->foreground) || isnan(l->background)) return (double)NAN;
    return luminance_contrast(at[BRIGHTER] * fmax(l->foreground, l->background),
                              at[DARKER] * fmin(l->foreground, l->background),
                              at[REFLECTED] * at[REFLECTS]);
}

void judge_contrasts(ReviewCase *review_case, MeanInterval reflected) {
    ReviewCase *c = review_case;
    const CaseLuminances *l = &c->luminance_cd_m2;
    double reflects = INTERVAL_SIGMAS * c->panel.reflection_error;
    double emits = INTERVAL_SIGMAS * c->panel.emission_error;
    double veil = isnan(l->veil) ? 0 : l->veil;
    const IntervalInput in[INPUTS] = {[REFLECTED] = {l->reflected, reflected.high, reflected.low},
                                      [REFLECTS] = {1, 1 + reflects, fmax(1 - reflects, 0)},
                                      [BRIGHTER] = {1, fmax(1 - emits, 0), 1 + emits},
                                      [DARKER] = {1, 1 + emits, fmax(1 - emits, 0)}};
    FigureInterval range = interval_of(ratio_at, l, in, INPUTS);
    c->reflected_range = reflected;
    c->contrast_ratio = ratio_at((double[INPUTS]){l->reflected, 1, 1, 1}, l);
    c->contrast_low = range.low < 1 ? 1 : range.low; /* NaN stays */
    c->contrast_high = range.high;
    c->contrast_with_veil = ratio_at((double[INPUTS]){l->reflected + veil, 1, 1, 1}, l);
    for (int above = 0; above < 2; above++)
        c->sampling_share[above] = interval_share(&range, !above, REFLECTED, 1);
}

/* ---- one limit --------------------------------------------------------------------------- */

static bool has_slope_for(const LimitSlope *slope, double height_arcmin) {
    return !slope->has_slope ||
           !(height_arcmin < slope->from_arcmin || height_arcmin > slope->to_arcmin);
}

static double value_at(const ProfileLimit *limit, double height_arcmin) {
    const LimitSlope *s = &limit->slope;
    if (!s->has_slope) return limit->value;
    return limit->value + s->per_arcmin * (s->reference_arcmin - height_arcmin);
}

/* Nothing, or nothing that hangs on the light, can be judged, whatever the figures. */
static bool is_unjudged(const Evidence *e, bool is_of_light) {
    return !e->is_seen || !e->is_usable || (is_of_light && !e->has_data);
}

static LimitVerdict judge_limit(const ProfileLimit *limit, const Evidence *e) {
    const ReviewQuantity *of = quantities[limit->kind];
    Figure figure = e->is_seen && of->find ? of->find(e, limit->is_upper) : figure_unknown();
    LimitVerdict judged = {.name = limit->name,
                           .kind = limit_kind_names[limit->kind],
                           .unit = of->unit,
                           .source = limit->source,
                           .value = value_at(limit, e->c ? e->c->height_arcmin : 0),
                           .read_in_the_standard = limit->read_in_the_standard,
                           .is_upper = limit->is_upper,
                           .is_advice = limit->is_advice,
                           .found = figure.found,
                           .low = figure.low,
                           .high = figure.high,
                           .age_years = figure.age_years,
                           .beside = figure.beside,
                           .sampling = {figure.sampling[0], figure.sampling[1]},
                           .is_veils = {figure.is_veils[0], figure.is_veils[1]},
                           .has_veil = figure.has_veil};
    judged.margin = quantity_margin(limit->kind, limit->is_upper, judged.found, judged.value);
    judged.verdict = is_unjudged(e, of->is_of_light) ? VERDICT_UNJUDGED : quantity_verdict(&judged);
    return judged;
}

/* Advice does not, nor what is not measured, or has no meaning of that shape. */
bool limit_counts(const LimitVerdict *limit) {
    const ReviewQuantity *of = quantity_of(limit);
    return !limit->is_advice && !(of && of->may_be_missing && isnan(limit->found));
}

/* ---- all limits of one subject ----------------------------------------------------------- */

/* Limits as they are judged. */
typedef struct Judging {
    LimitVerdict *list;
    int count, counted;
    Verdict verdict; /* the worst of those that count */
} Judging;

static const LimitVerdict *hold_against(Judging *to, const ProfileLimit *limit, const Evidence *e) {
    LimitVerdict *judged = &to->list[to->count++];
    *judged = judge_limit(limit, e);
    if (!limit_counts(judged)) return judged;
    to->counted++;
    if (verdict_rank(judged->verdict) > verdict_rank(to->verdict)) to->verdict = judged->verdict;
    return judged;
}

static bool is_asked(const ProfileLimit *limit, QuantityOf of, const Evidence *e) {
    return quantities[limit->kind]->of == of && limit->ambients[e->ambient] &&
           (!e->c || has_slope_for(&limit->slope, e->c->height_arcmin));
}

static Unjudged why_not(const Judging *of, const Evidence *e) {
    if (of->verdict != VERDICT_UNJUDGED) return UNJUDGED_NOT;
    return !e->is_usable ? UNJUDGED_PANEL : !e->has_data ? UNJUDGED_DATA : UNJUDGED_FIGURE;
}

/* ---- what keeps it open ------------------------------------------------------------------ */

/* Shares of a normal variable of mean `at` and spread 1 within +-distance. */
static double share_within(double at, double distance) {
    return 0.5 * (erfc_d((at - distance) * ROOT_HALF) - erfc_d((at + distance) * ROOT_HALF));
}

/* The half of the interval towards the limit has three parts: what paths lessen, in standard
 * errors; what is known of the sun's image, which adds to that as it is; what the panel leaves
 * in doubt, which adds as squares. Would more paths decide it? Not where it lies, more likely
 * than not, within what none lessen. */
static OpenBy open_by(const LimitVerdict *limit, double fixed) {
    bool is_above = limit->found > limit->value;
    double half = is_above ? limit->found - limit->low : limit->high - limit->found;
    double away = fabs(limit->found - limit->value), share = limit->sampling[!is_above];
    double error = (1 - fixed) * share * half / NORMAL_QUANTILE, sun = fixed * share * half;
    double panel = half * sqrt(fmax(1 - share * share, 0));
    if (limit->by_pane) return OPEN_BY_IMAGE;
    if (error > 0 && share_within(away / error, hypot_d(sun, panel) / error) <= UNDECIDABLE_SHARE)
        return OPEN_BY_PATHS;
    return panel < sun ? OPEN_BY_SUN : limit->is_veils[!is_above] ? OPEN_BY_VEIL : OPEN_BY_PANEL;
}

/* The first limit that no paths decide says why. */
void judge_open(ReviewCase *review_case, double fixed) {
    ReviewCase *c = review_case;
    c->open_by = OPEN_NOT;
    if (c->verdict != VERDICT_TOO_CLOSE) return;
    for (int i = 0; i < c->limit_count && !case_is_undecidable(c); i++)
        if (limit_is_open(&c->limits[i])) c->open_by = open_by(&c->limits[i], fixed);
}

/* ---- a symbol ---------------------------------------------------------------------------- */

static Evidence evidence_of(const ReviewCase *c, const Profile *profile) {
    return (Evidence){.profile = profile,
                      .c = c,
                      .ambient = c->ambient,
                      .is_seen = case_is_seen(c),
                      .is_usable = !c->panel.is_unusable,
                      .has_data = !(c->without_data_share > UNJUDGED_DATA_SHARE)};
}

/* The contrast that is required most, as a ratio or as security, is the case's own. */
static void hold_symbol(Judging *to, const ProfileLimit *limit, const Evidence *e, ReviewCase *c,
                        double *greatest) {
    const ReviewQuantity *of = quantities[limit->kind];
    const LimitVerdict *judged = hold_against(to, limit, e);
    double asked =
        of->of == OF_PRIVATE ? judged->value : ratio_from_contrast(limit->kind, judged->value);
    if (!of->from_ratio || !limit_counts(judged) || limit->is_upper || !(asked > *greatest)) return;
    *greatest = asked;
    c->limit_id = to->count - 1;
    c->margin = judged->margin;
}

/* Each image as if it were the symbol, by the limits that the symbol itself is held against.
 * Nothing is known of how much of its light came by what has no data. */
static void hold_images(Judging *to, const Profile *profile, ReviewCase *c, Arena *arena) {
    CaseImage *images = ARENA_NEW(arena, CaseImage, c->image_count);
    for (int k = 0; k < c->image_count; k++) {
        CaseImage *image = &images[k];
        *image = c->images[k];
        ReviewCase as = *c;
        as.visible_share = image->shown_share;
        as.height_arcmin = image->height_arcmin;
        as.contrast_ratio = image->contrast_ratio;
        as.contrast_low = image->contrast_low;
        as.contrast_high = image->contrast_high;
        as.without_data_share = 0;
        Evidence e = evidence_of(&as, profile), own = evidence_of(c, profile);
        Judging of = {.list = to->list + to->count, .verdict = VERDICT_PASS};
        for (int i = 0; i < profile->limit_count && !profile->is_security_own; i++)
            if (is_asked(&profile->limits[i], OF_PRIVATE, &own))
                hold_against(&of, &profile->limits[i], &e);
        if (!of.counted) hold_against(&of, &profile->security, &e);
        for (int i = 0; i < of.count; i++) {
            LimitVerdict *judged = &of.list[i];
            judged->by_pane = image->pane;
            if (!limit_counts(judged) || (c->limit_id >= 0 && !(judged->margin < c->margin)))
                continue;
            c->limit_id = to->count + i;
            c->margin = judged->margin;
        }
        image->verdict = of.verdict;
        to->count += of.count;
        to->counted += of.counted;
        if (verdict_rank(of.verdict) > verdict_rank(to->verdict)) to->verdict = of.verdict;
    }
    c->images = images;
}

void judge_case(ReviewCase *review_case, const Profile *profile, Arena *arena) {
    ReviewCase *c = review_case;
    QuantityOf of = c->must_not_be_read ? OF_PRIVATE : OF_SYMBOL;
    int limits = (profile->limit_count + 1) * (c->image_count + 1);
    Judging to = {.list = ARENA_NEW(arena, LimitVerdict, limits), .verdict = VERDICT_PASS};
    bool is_hidden = c->must_not_be_read && c->visible_share <= 0;
    bool is_own = c->must_not_be_read && profile->is_security_own;
    double greatest = -INFINITY;
    c->limits = to.list;
    c->limit_id = -1;
    c->margin = NAN;
    c->visibilities = visibility_levels(c, arena);
    c->colours = case_colours(c, arena);
    Evidence e = evidence_of(c, profile);
    for (int i = 0; i < profile->limit_count && !is_own && !is_hidden; i++)
        if (is_asked(&profile->limits[i], of, &e))
            hold_symbol(&to, &profile->limits[i], &e, c, &greatest);
    if (c->must_not_be_read && !is_hidden && !to.counted)
        hold_symbol(&to, &profile->security, &e, c, &greatest);
    if (c->image_count) hold_images(&to, profile, c, arena);
    if (!is_hidden && (!to.counted || is_unjudged(&e, false))) to.verdict = VERDICT_UNJUDGED;
    c->limit_count = to.count;
    c->verdict = to.verdict;
    c->unjudged = why_not(&to, &e);
    if (c->unjudged && !e.is_seen && !c->image_count) c->unjudged = UNJUDGED_HIDDEN;
    else if (c->unjudged && e.is_usable && !to.counted) c->unjudged = UNJUDGED_LIMIT;
    if (c->verdict != VERDICT_TOO_CLOSE) c->open_by = OPEN_NOT;
}

/* ---- gazes and displays in glass --------------------------------------------------------- */

/* Of a road's ages each. */
static int ages_of(const GazeFinding *g, LimitKind kind) {
    if (kind != LIMIT_THRESHOLD_INCREMENT) return 1;
    return g->road && !g->road->left_out ? g->road->age_count : 0;
}

/* A profile's own key is a limit as any of its rows are. */
static const ProfileLimit *gaze_limits(const Profile *profile, int *count, Arena *arena) {
    ProfileLimit *list = ARENA_NEW(arena, ProfileLimit, profile->limit_count + 1);
    bool has_increment = false;
    *count = 0;
    for (int i = 0; i < profile->limit_count; i++) {
        if (quantities[profile->limits[i].kind]->of != OF_GAZE) continue;
        list[(*count)++] = profile->limits[i];
        has_increment |=
            profile->limits[i].kind == LIMIT_THRESHOLD_INCREMENT && !profile->limits[i].is_advice;
    }
    if (!has_increment && profile->increment_most_pct > 0)
        list[(*count)++] =
            (ProfileLimit){.name = "threshold increment at most",
                           .kind = LIMIT_THRESHOLD_INCREMENT,
                           .ambients = {true, true, true, true},
                           .is_upper = true,
                           .value = profile->increment_most_pct,
                           .source = "the profile's own key threshold_increment_max_pct"};
    return list;
}

void judge_gaze(GazeFinding *g, const Profile *profile, Arena *arena) {
    GazeRoad *road = g->road;
    bool is_road = road && !road->left_out;
    bool is_night = isnan(g->sun_deg) || (road && road->is_after_dark);
    Evidence e = {.profile = profile,
                  .gaze = g,
                  .ambient = is_night ? AMBIENT_NIGHT : AMBIENT_DAY,
                  .is_seen = true,
                  .is_usable = !(is_road && road->unusable_share > UNJUDGED_DATA_SHARE),
                  .has_data = !(is_road && road->without_data_share > UNJUDGED_DATA_SHARE)};
    int count;
    const ProfileLimit *limits = gaze_limits(profile, &count, arena);
    Judging to = {.list =
                      ARENA_NEW(arena, LimitVerdict, count * ((is_road ? road->age_count : 0) + 1)),
                  .verdict = VERDICT_PASS};
    for (int i = 0; is_road && i < road->age_count; i++) road->ages[i].limit.name = NULL;
    for (int i = 0; i < count; i++)
        for (e.age = 0; is_asked(&limits[i], OF_GAZE, &e) && e.age < ages_of(g, limits[i].kind);
             e.age++) {
            const LimitVerdict *judged = hold_against(&to, &limits[i], &e);
            if (limits[i].kind != LIMIT_THRESHOLD_INCREMENT || !limit_counts(judged)) continue;
            LimitVerdict *own = &road->ages[e.age].limit; /* of several the worst */
            if (!own->name || limit_is_worse(judged, own)) *own = *judged;
        }
    g->limits = to.list;
    g->limit_count = to.count;
    g->verdict = to.verdict;
    g->unjudged = why_not(&to, &e);
}

void judge_pane(PaneFinding *f, const Profile *profile, Ambient ambient, double contrast_most) {
    ProfileLimit least = {.name = f->area,
                          .kind = LIMIT_IMAGE_CONTRAST,
                          .is_upper = true,
                          .value = contrast_most,
                          .source = "the request's pane_images"};
    Evidence e = {.profile = profile,
                  .pane = f,
                  .ambient = ambient,
                  .is_seen = true,
                  .is_usable = true,
                  .has_data = true};
    for (int i = 0; profile && i < profile->limit_count; i++)
        if (is_asked(&profile->limits[i], OF_PANE, &e) && !profile->limits[i].is_advice &&
            !(profile->limits[i].value >= least.value))
            least = profile->limits[i];
    f->has_limit = f->area && least.value < INFINITY;
    if (f->has_limit) f->limit = judge_limit(&least, &e);
}

void judge_false_sun(ReviewFalseSun *sun, const Profile *profile, Arena *arena) {
    Evidence e = {.profile = profile,
                  .sun = sun,
                  .ambient = AMBIENT_SUN,
                  .is_seen = true,
                  .is_usable = true,
                  .has_data = true};
    Judging to = {.list = ARENA_NEW(arena, LimitVerdict, profile->limit_count),
                  .verdict = VERDICT_PASS};
    for (int i = 0; i < profile->limit_count; i++)
        if (is_asked(&profile->limits[i], OF_MIRROR, &e))
            hold_against(&to, &profile->limits[i], &e);
    sun->limits = to.list;
    sun->limit_count = to.count;
    sun->verdict = to.verdict;
}
