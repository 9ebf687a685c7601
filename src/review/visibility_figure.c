/* SPDX-License-Identifier: Apache-2.0 */
#include "review/visibility_figure.h"

#include <math.h>

#include "text/text.h"
#include "vision/visibility.h"

/* What an end of the interval is made of. */
typedef struct Seen {
    double foreground, background, reflected, veil; /* cd m^-2 */
} Seen;

static Seen seen_of(const ReviewCase *c, const CaseVisibility *v) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double veil = isnan(l->veil) ? 0 : l->veil * v->veil_times;
    return (Seen){l->foreground, l->background, l->reflected, veil};
}

static VisibilityTarget target_of(const ReviewCase *c, const CaseVisibility *v, Seen seen) {
    return (VisibilityTarget){.size_arcmin = v->size_arcmin,
                              .adapted_cd_m2 = c->glasses_transmittance *
                                               (seen.background + seen.reflected + seen.veil),
                              .age_years = v->age_years,
                              .glance_s = v->glance_s,
                              .is_darker = seen.foreground < seen.background};
}

static double level_of(const ReviewCase *c, const CaseVisibility *v, Seen seen) {
    VisibilityTarget target = target_of(c, v, seen);
    double difference = seen.foreground - seen.background;
    return visibility_level(&target, c->glasses_transmittance * difference);
}

/* How far each of the independent doubts takes the level away, to one side. */
typedef struct Away {
    double sampling, veil, front, back, reflecting;
} Away;

/* More light that the eye is adapted to asks for more of a difference: the low end, sign -1, is
 * that of the most. */
static Away away_of(const ReviewCase *c, const CaseVisibility *v, double sign) {
    double reflects = sign * INTERVAL_SIGMAS * c->panel.reflection_error;
    double emits = sign * INTERVAL_SIGMAS * c->panel.emission_error;
    Seen is = seen_of(c, v), front = is, back = is, reflecting = is, sampled = is, veil = is;
    bool is_darker = is.foreground < is.background;
    double level = level_of(c, v, is);
    sampled.reflected = sign < 0 ? c->reflected_range.high : c->reflected_range.low;
    veil.veil *= fmax(1 - sign * v->veil_doubt, 0);
    front.foreground *= fmax(1 + (is_darker ? -emits : emits), 0);
    back.background *= fmax(1 + (is_darker ? emits : -emits), 0);
    reflecting.reflected *= fmax(1 - reflects, 0);
    return (Away){level_of(c, v, sampled) - level, level_of(c, v, veil) - level,
                  level_of(c, v, front) - level, level_of(c, v, back) - level,
                  level_of(c, v, reflecting) - level};
}

static double panels_square(const Away *away) {
    return away->front * away->front + away->back * away->back +
           away->reflecting * away->reflecting;
}

/* (Where the formula's pieces meet more light asks for up to 2 % less: no end passes the level
 * for that.) */
static double end_of(const ReviewCase *c, const CaseVisibility *v, double sign) {
    Away away = away_of(c, v, sign);
    double rest = panels_square(&away) + away.veil * away.veil;
    if (isnan(v->level)) return NAN;
    if (!(rest > 0)) return v->level + sign * fmax(sign * away.sampling, 0);
    return fmax(v->level + sign * sqrt(rest + away.sampling * away.sampling), 0);
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

const CaseVisibility *visibility_levels(const ReviewCase *c, Arena *arena) {
    if (!c->visibility_count) return NULL;
    CaseVisibility *list = ARENA_NEW(arena, CaseVisibility, c->visibility_count);
    for (int i = 0; i < c->visibility_count; i++) {
        CaseVisibility *v = &list[i];
        *v = c->visibilities[i];
        Seen seen = seen_of(c, v);
        VisibilityTarget target = target_of(c, v, seen);
        v->adapted_cd_m2 = target.adapted_cd_m2;
        v->threshold_cd_m2 = visibility_threshold(&target);
        v->level = level_of(c, v, seen);
        v->low = end_of(c, v, -1);
        v->high = end_of(c, v, 1);
        v->doubts = doubts_of(&target, arena);
    }
    return list;
}

const CaseVisibility *visibility_decisive(const ReviewCase *c, bool is_upper) {
    const CaseVisibility *found = NULL;
    for (int i = 0; i < c->visibility_count; i++) {
        const CaseVisibility *v = &c->visibilities[i];
        if (isnan(v->level)) return v;
        if (!found || (is_upper ? v->level > found->level : v->level < found->level)) found = v;
    }
    return found;
}

LevelDoubt visibility_doubt(const ReviewCase *c, const CaseVisibility *of, bool is_below) {
    Away away = away_of(c, of, is_below ? -1 : 1);
    double end = is_below ? of->low : of->high;
    double share = fabs(away.sampling / (end - of->level));
    return (LevelDoubt){share < 1 ? share : 1, away.veil * away.veil > panels_square(&away)};
}
