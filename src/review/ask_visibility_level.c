/* SPDX-License-Identifier: Apache-2.0 */
#include "review/ask_visibility_level.h"

#include <math.h>

#include "review/quantity.h"
#include "text/text.h"
#include "vision/visibility.h"

enum { SAMPLED, VEIL, FRONT, BACK, REFLECTS, INPUTS }; /* cd m^-2; the panel's three as factors */

typedef struct Seeing {
    const ReviewCase *c;
    const CaseVisibility *v;
} Seeing;

static VisibilityTarget target_at(const double *at, const Seeing *s) {
    const CaseLuminances *l = &s->c->luminance_cd_m2;
    double foreground = at[FRONT] * l->foreground, background = at[BACK] * l->background;
    double light = background + at[SAMPLED] * at[REFLECTS] + at[VEIL];
    return (VisibilityTarget){.size_arcmin = s->v->size_arcmin,
                              .adapted_cd_m2 = s->c->glasses_transmittance * light,
                              .age_years = s->v->age_years,
                              .glance_s = s->v->glance_s,
                              .is_darker = foreground < background};
}

static double level_at(const double *at, const void *user) {
    const Seeing *s = user;
    const CaseLuminances *l = &s->c->luminance_cd_m2;
    VisibilityTarget target = target_at(at, s);
    double difference = at[FRONT] * l->foreground - at[BACK] * l->background;
    return visibility_level(&target, s->c->glasses_transmittance * difference);
}

/* By how much a factor is off, kept from falling below 0. */
static IntervalInput factor(double less) {
    return (IntervalInput){1, fmax(1 + less, 0), fmax(1 - less, 0)};
}

/* ---- where the formula is doubtful ------------------------------------------------------- */

static const char *doubt_words(VisibilityDoubt doubt, const VisibilityTarget *t, Arena *arena) {
    switch (doubt) {
    case VISIBILITY_DOUBT_AGE:
        return arena_format(arena, "no factor is published for %g years, only for %g to %g",
                            t->age_years, VISIBILITY_AGE_MIN, VISIBILITY_AGE_MAX);
    case VISIBILITY_DOUBT_JUMP:
        return arena_format(arena,
                            "the published factor of age falls at %g years, from %.3f "
                            "to %.3f",
                            VISIBILITY_AGE_JUMP,
                            visibility_age_factor(nextafter(VISIBILITY_AGE_JUMP, 0)),
                            visibility_age_factor(VISIBILITY_AGE_JUMP));
    case VISIBILITY_DOUBT_GLANCE:
        return arena_format(arena,
                            "whether the factor of a glance holds above %g arc minutes "
                            "is open",
                            VISIBILITY_SIZE_LARGE);
    case VISIBILITY_DOUBT_DARKER:
        return arena_format(arena,
                            "no factor of dark on light is published up to %g cd/m2; "
                            "1 is taken",
                            VISIBILITY_DARKER_MIN);
    default:
        return arena_format(arena,
                            "the eye is adapted to %.3g cd/m2; the formula was held "
                            "against people from %g to %g",
                            t->adapted_cd_m2, VISIBILITY_PEOPLE_MIN, VISIBILITY_PEOPLE_MAX);
    }
}

static const char *doubts_of(const VisibilityTarget *target, Arena *arena) {
    unsigned bits = visibility_doubts(target);
    Text text = {.arena = arena};
    if (!(target->adapted_cd_m2 > 0)) bits &= 1u << VISIBILITY_DOUBT_AGE;
    for (int i = 0; i < VISIBILITY_DOUBTS; i++)
        if (bits >> i & 1)
            text_format(&text, "%s%s", text.size ? "; " : "",
                        doubt_words((VisibilityDoubt)i, target, arena));
    return text.data;
}

/* ---- the levels -------------------------------------------------------------------------- */

/* More light that the eye is adapted to asks for more of a difference. */
static void set_level(const ReviewCase *c, CaseVisibility *v, Arena *arena) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    Seeing seeing = {c, v};
    double veil = isnan(l->veil) ? 0 : l->veil * v->veil_times;
    double emits = INTERVAL_SIGMAS * c->panel.emission_error;
    double reflects = INTERVAL_SIGMAS * c->panel.reflection_error;
    double bright = l->foreground < l->background ? emits : -emits;
    const IntervalInput in[INPUTS] = {
        [SAMPLED] = {l->reflected, c->reflected_range.high, c->reflected_range.low},
        [VEIL] = {veil, veil * (1 + v->veil_doubt), veil * fmax(1 - v->veil_doubt, 0)},
        [FRONT] = factor(bright),
        [BACK] = factor(-bright),
        [REFLECTS] = factor(reflects)};
    const double as_it_is[INPUTS] = {l->reflected, veil, 1, 1, 1};
    VisibilityTarget target = target_at(as_it_is, &seeing);
    FigureInterval range = interval_of(level_at, &seeing, in, INPUTS);
    v->adapted_cd_m2 = target.adapted_cd_m2;
    v->threshold_cd_m2 = visibility_threshold(&target);
    v->level = level_at(as_it_is, &seeing);
    v->low = range.low < 0 ? 0 : range.low; /* NaN stays */
    v->high = range.high < 0 ? 0 : range.high;
    v->doubts = doubts_of(&target, arena);
    for (int above = 0; above < 2; above++) {
        v->sampling[above] = interval_share(&range, !above, SAMPLED, 1);
        v->is_veils[above] =
            interval_share(&range, !above, VEIL, 1) > interval_share(&range, !above, FRONT, 3);
    }
}

const CaseVisibility *visibility_levels(const ReviewCase *c, Arena *arena) {
    if (!c->visibility_count) return NULL;
    CaseVisibility *list = ARENA_NEW(arena, CaseVisibility, c->visibility_count);
    for (int i = 0; i < c->visibility_count; i++) {
        list[i] = c->visibilities[i];
        set_level(c, &list[i], arena);
    }
    return list;
}

/* The least of all, of an upper limit the greatest; one that is not known comes before all. */
static Figure find(const Evidence *e, bool is_upper) {
    const CaseVisibility *of = NULL;
    for (int i = 0; i < e->c->visibility_count; i++) {
        const CaseVisibility *v = &e->c->visibilities[i];
        if (!of || isnan(v->level) || (is_upper ? v->level > of->level : v->level < of->level))
            of = v;
        if (isnan(v->level)) break;
    }
    if (!of) return figure_unknown();
    return (Figure){.found = of->level,
                    .low = of->low,
                    .high = of->high,
                    .age_years = of->age_years,
                    .sampling = {of->sampling[0], of->sampling[1]},
                    .is_veils = {of->is_veils[0], of->is_veils[1]},
                    .has_veil = true};
}

const ReviewQuantity quantity_visibility_level = {
    .unit = "1", .words = "visibility level", .is_of_light = true, .find = find};
