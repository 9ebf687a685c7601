/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/remedies.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "review/judge.h"
#include "review/quantity.h"

#define COATED 0.25 /* of a mirror's light that a usual anti-reflection coating leaves */
#define BRIGHTER_MOST 10.0 /* times as bright: more is not built */
#define PANEL_LEAST 0.1    /* of today's reflection: less is not built either */
#define SEAT_LEAST 0.1     /* of the light: an empty seat's back that is worth a word */
#define TURNED 0.5         /* cosine of 60 degrees: no display is so far from straight ahead */

/* What all remedies share: one case. */
typedef struct Remedying {
    const RemedyAsk  *ask;
    const CauseFacts *facts;
    ReviewCase       *c;
    int               limit; /* that they are for */
    CaseRemedy       *list;
    Arena            *arena;
} Remedying;

/* ---- judged again ------------------------------------------------------------------------ */

/* What a remedy changes: a factor on what the display emits and on its own light that comes
 * back to it, and all that it reflects else. */
typedef struct Remedied {
    double brighter, reflected; /* reflected: cd m^-2 beside its own light, after */
} Remedied;

static double own_light(const Remedying *m)
{
    return fmin(m->facts->own_cd_m2, m->c->luminance_cd_m2.reflected);
}

/* The case with so much light, judged again; its doubt is in proportion. */
static ReviewCase judged_with(const Remedying *m, Remedied with)
{
    ReviewCase      out = *m->c;
    CaseLuminances *l = &out.luminance_cd_m2;
    double          before = l->reflected;
    l->foreground *= with.brighter;
    l->background *= with.brighter;
    l->reflected = with.reflected + with.brighter * own_light(m);
    l->veil += (with.brighter - 1) * m->c->veil_displays;
    double scale = before > 0 ? l->reflected / before : 1;
    out.level *= with.brighter;
    judge_contrasts(&out, (MeanInterval){scale * m->c->reflected_range.low,
                                         scale * m->c->reflected_range.high});
    judge_case(&out, m->ask->profile, m->arena);
    return out;
}

/* That with `left` of all that is reflected. */
static ReviewCase with_light(const Remedying *m, double left)
{
    return judged_with(m, (Remedied){1, fmax(left - own_light(m), 0)});
}

static bool keeps_limit(const Remedying *m, const ReviewCase *then)
{
    return then->limit_count == m->c->limit_count &&
           then->limits[m->limit].verdict == VERDICT_PASS;
}

/* As much more is reflected as the interval is wide: fresh paths find what is kept then kept as
 * well. */
static double doubt_of(const Remedying *m)
{
    double half = 0.5 * (m->c->reflected_range.high - m->c->reflected_range.low);
    return m->c->limits[m->limit].is_upper ? -half : half;
}

/* Nothing that leaves the figure within its interval. */
static void add(Remedying *m, RemedyKind kind, const char *what, const ReviewCase *then)
{
    const LimitVerdict *before = &m->c->limits[m->limit], *after = &then->limits[m->limit];
    if (then->limit_count != m->c->limit_count ||
        !(before->is_upper ? after->found < before->low : after->found > before->high))
        return;
    m->list[m->c->remedy_count++] =
        (CaseRemedy){kind, what, then->contrast_ratio, then->level, *after, then->verdict};
}

static void add_with(Remedying *m, RemedyKind kind, const char *what, double left)
{
    ReviewCase then = with_light(m, left);
    add(m, kind, what, &then);
}

/* A direction to try, of which no figure is known. */
static void add_to_try(Remedying *m, RemedyKind kind, const char *what)
{
    LimitVerdict then = m->c->limits[m->limit];
    then.found = then.low = then.high = then.margin = (double)NAN;
    then.verdict = VERDICT_UNJUDGED;
    m->list[m->c->remedy_count++] =
        (CaseRemedy){kind, what, (double)NAN, m->c->level, then, VERDICT_UNJUDGED};
}

/* Without a part of the light, which other paths found: by its share of theirs. */
static double left_without(const Remedying *m, double cd_m2)
{
    double share = fmin(cd_m2 / m->facts->all.cd_m2, 1);
    return (1 - share) * m->c->luminance_cd_m2.reflected;
}

/* Of the limits of contrast that count and are missed, or that no paths decide, the one that is
 * missed by most; -1. */
static int limit_to_mend(const ReviewCase *c)
{
    int worst = -1;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        LimitKind           kind = limit_kind_named(limit->kind);
        bool is_known = limit->verdict == VERDICT_FAIL || limit->verdict == VERDICT_TOO_CLOSE;
        bool is_missed = limit->margin < 0 || case_is_undecidable(c);
        if (limit->is_advice || !is_known || !is_missed || !limit_kinds[kind].is_contrast)
            continue;
        if (worst < 0 || limit->margin < c->limits[worst].margin) worst = i;
    }
    return worst;
}

static double ratio_needed(const Remedying *m)
{
    const LimitVerdict *limit = &m->c->limits[m->limit];
    return ratio_from_contrast(limit_kind_named(limit->kind), limit->value);
}

static double veil_of(const Remedying *m)
{
    double veil = m->c->luminance_cd_m2.veil;
    return m->ask->profile->uses_veil && veil > 0 ? veil : 0;
}

/* To three digits, away from 1. */
static double rounded_out(double factor)
{
    double digit = pow_d(10, floor(log10_d(factor)) - 2);
    return digit * (factor > 1 ? ceil(factor / digit) : floor(factor / digit));
}

/* ---- brightness -------------------------------------------------------------------------- */

/* By how much the display must be brighter, or darker, for a contrast,
 * (H x + R + O x) / (L x + R + O x) = C, O its own light that is reflected, or scattered in the
 * eye, R all other; NaN: no brightness does it. */
static double brighter_for(const CaseLuminances *l, double own, double other, double needed)
{
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    double gain = high + own - needed * (low + own);
    return gain > 0 ? other * (needed - 1) / gain : (double)NAN;
}

#define TRIES 40
#define TRY_STEP 1.05 /* the panel's errors are in the interval, too */

/* The least with which the limit is judged to be kept. */
static void add_brightness(Remedying *m)
{
    bool   is_upper = m->c->limits[m->limit].is_upper;
    double own = own_light(m), other = m->c->luminance_cd_m2.reflected - own;
    double veil = veil_of(m), grows = veil > 0 ? m->c->veil_displays : 0;
    double doubt = doubt_of(m), most = fmax(other + veil - grows + 2 * doubt, 0);
    double x = brighter_for(&m->c->luminance_cd_m2, own + grows, most, ratio_needed(m));
    for (int i = 0; i < TRIES && x > 0 && x < BRIGHTER_MOST; i++) {
        double     factor = rounded_out(x);
        ReviewCase sure = judged_with(m, (Remedied){factor, fmax(other + doubt, 0)});
        x *= is_upper ? 1 / TRY_STEP : TRY_STEP;
        if (!keeps_limit(m, &sure)) continue;
        ReviewCase then = judged_with(m, (Remedied){factor, other});
        add(m, REMEDY_BRIGHTNESS,
            arena_format(m->arena, "the display %.3g times as bright", factor), &then);
        return;
    }
}

/* ---- tilt -------------------------------------------------------------------------------- */

#define TILTS 7
static const float TILT_DEG[TILTS] = {0, 3, -3, 6, -6, 9, -9}; /* back is positive */
#define TILT_PATHS 1024
#define MIRROR_MOST 0.7 /* of the light: the mirror's new picture tells the rest, too */
#define GATHERED 0.8    /* length of the mean direction of light that comes from one side */
#define BESIDE 0.87f    /* cosine of 30 degrees: beside the mirror's direction */
#define TRY_DEG 5.0f    /* by which a direction is tried */

/* The symbol's middle as a mirror that turns about its level axis. */
typedef struct Mirror {
    Vec3 start, normal, up;
} Mirror;

static Mirror mirror_of(const RemedyAsk *ask)
{
    const SymbolPoint *middle = &ask->middle;
    Vec3 right = vec3_normalize(vec3_cross(vec3(0, 1, 0), middle->ns));
    return (Mirror){symbol_point_start(ask->aim->context->scene, middle), middle->ns,
                    vec3_cross(middle->ns, right)};
}

static Vec3 mirrored(const Mirror *mirror, float tilt_deg, Vec3 from_eye)
{
    double turn = radians_from_degrees((double)tilt_deg);
    Vec3   n = vec3_along(vec3_scale(mirror->normal, (float)cos_d(turn)), mirror->up,
                          (float)sin_d(turn));
    return vec3_along(from_eye, n, -2 * vec3_dot(from_eye, n));
}

typedef struct TiltSearch {
    const RemedyAsk *ask;
    Mirror           mirror;
    double           cd_m2[TILTS]; /* mean of what stands in the mirror's direction */
} TiltSearch;

static void add_light(void *user, const PathHistory *history, const float xyz[3])
{
    (void)history;
    *(double *)user += (double)xyz[1];
}

static void trace_tilt(void *user, int item, int worker)
{
    (void)worker;
    TiltSearch     *search = user;
    const ProbeAim *aim = search->ask->aim;
    Arena           own = arena_reserve((size_t)1 << 20);
    Vec3           *targets = ARENA_NEW(&own, Vec3, aim->target_count);
    for (int i = 0; i < aim->target_count; i++) {
        Vec3 from_eye = vec3_normalize(vec3_sub(aim->targets[i], aim->eye));
        targets[i] = vec3_add(search->mirror.start,
                              mirrored(&search->mirror, TILT_DEG[item], from_eye));
    }
    double         sum = 0;
    PathListener   listener = {.on_light = add_light, .user = &sum};
    PathStatistics statistics = {0};
    ProbeAim       out = {.context = aim->context, .eye = search->mirror.start,
                          .targets = targets, .target_count = aim->target_count,
                          .is_spread = true, .seed = aim->seed};
    search->ask->tools->kernel->trace(&out, 0, TILT_PATHS, &listener, &statistics);
    search->cd_m2[item] = sum / TILT_PATHS;
    arena_release(&own);
}

static const char *tilt_words(float tilt_deg, Arena *arena)
{
    return arena_format(arena, "the display leaning %s by %.3g degrees, scattered light "
                               "as it is",
                        tilt_deg > 0 ? "back" : "forward", (double)fabsf(tilt_deg));
}

/* The least that is enough; else that which leaves least light. */
static void add_traced_tilt(Remedying *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    TiltSearch search = {.ask = m->ask, .mirror = mirror_of(m->ask)};
    double     least = l->reflected;
    int        at = 0;
    parallel_for(m->ask->tools->threads, TILTS, trace_tilt, &search);
    if (!(search.cd_m2[0] > 0)) return;
    for (int i = 1; i < TILTS; i++) {
        double left = l->reflected - l->mirror * (1 - search.cd_m2[i] / search.cd_m2[0]);
        if (!(left < least)) continue;
        ReviewCase then = with_light(m, left);
        least = left;
        at = i;
        if (keeps_limit(m, &then)) break;
    }
    if (at) add_with(m, REMEDY_TILT, tilt_words(TILT_DEG[at], m->arena), least);
}

/* Turns the mirror away from where the light comes from. */
static void add_tilt_to_try(Remedying *m)
{
    Mirror mirror = mirror_of(m->ask);
    Vec3   from_eye = vec3_normalize(vec3_sub(mirror.start, m->ask->aim->eye));
    Vec3   arrives = vec3_from_doubles(m->facts->arrives);
    float  gathered = vec3_length(arrives) / (float)m->facts->all.cd_m2;
    arrives = vec3_normalize(arrives);
    if (!(gathered > (float)GATHERED) ||
        !(vec3_dot(arrives, mirrored(&mirror, 0, from_eye)) > BESIDE))
        return;
    float back = vec3_dot(arrives, mirrored(&mirror, TRY_DEG, from_eye));
    float forward = vec3_dot(arrives, mirrored(&mirror, -TRY_DEG, from_eye));
    add_to_try(m, REMEDY_TILT,
               back < forward ? "the display leaning back by a few degrees"
                              : "the display leaning forward by a few degrees");
}

static void add_tilt(Remedying *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    if (l->mirror > MIRROR_MOST * l->reflected) add_traced_tilt(m);
    else add_tilt_to_try(m);
}

/* ---- a hood ------------------------------------------------------------------------------ */

static const float HOOD_M[PLACE_HOODS] = {0.03f, 0.06f, 0.1f};

static PlaceFace face_of(const RemedyAsk *ask)
{
    return place_face(ask->aim->context->scene, ask->display->part_ids,
                      ask->display->part_count);
}

static bool hides_symbol(const RemedyAsk *ask, const PlaceFace *face, float depth_m)
{
    const ProbeAim *aim = ask->aim;
    for (int i = 0; i < aim->target_count; i++) {
        Vec3 to_eye = vec3_sub(aim->eye, aim->targets[i]);
        if (place_is_hooded(face, depth_m, aim->targets[i], vec3_normalize(to_eye),
                            vec3_length(to_eye)))
            return true;
    }
    return false;
}

/* The least that is enough; else that which gives most. */
static void add_hood(Remedying *m)
{
    PlaceFace face = face_of(m->ask);
    int       best = -1;
    for (int i = 0; i < PLACE_HOODS && face.is_upright; i++) {
        if (hides_symbol(m->ask, &face, HOOD_M[i])) break;
        ReviewCase then = with_light(m, left_without(m, m->facts->hooded[i]));
        best = i;
        if (keeps_limit(m, &then)) break;
    }
    if (best >= 0)
        add_with(m, REMEDY_HOOD,
                 arena_format(m->arena, "a hood of %.0f mm over the display",
                              1000 * (double)HOOD_M[best]),
                 left_without(m, m->facts->hooded[best]));
}

/* ---- coating, panel, trim ---------------------------------------------------------------- */

static void add_coating(Remedying *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    if (l->mirror > 0)
        add_with(m, REMEDY_COATING, "a coating that leaves a quarter of the mirror's light",
                 l->reflected - (1 - COATED) * l->mirror);
}

/* What would have to be reflected for a contrast. */
static double reflected_at(const CaseLuminances *l, double ratio)
{
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    return (high - ratio * low) / (ratio - 1);
}

/* The most that may be reflected so that the limit is judged to be kept. */
static void add_panel(Remedying *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    double doubt = doubt_of(m);
    double share = (reflected_at(l, ratio_needed(m)) - veil_of(m)) / (l->reflected + 2 * doubt);
    if (m->c->limits[m->limit].is_upper) return;
    for (int i = 0; i < TRIES && share > PANEL_LEAST && share < 1; i++) {
        double     factor = rounded_out(share);
        ReviewCase sure = with_light(m, factor * (l->reflected + doubt));
        share /= TRY_STEP;
        if (!keeps_limit(m, &sure)) continue;
        add_with(m, REMEDY_PANEL,
                 arena_format(m->arena, "a panel as bright that reflects %.3g times as much",
                              factor), factor * l->reflected);
        return;
    }
}

static void add_trim(Remedying *m)
{
    const CausePart *trim = &m->facts->trim;
    if (trim->what)
        add_with(m, REMEDY_TRIM,
                 arena_format(m->arena, "%s in matt black, of reflectance %.0f %%", trim->what,
                              100 * MATT_BLACK), left_without(m, trim->cd_m2));
}

/* ---- all of them ------------------------------------------------------------------------- */

/* Where who sits there faces: ahead, unless the display is far from there. */
static Vec3 ahead_of(const RemedyAsk *ask)
{
    Vec3 gaze = vec3_sub(ask->middle.position, ask->aim->eye);
    Vec3 ahead = vec3_from_doubles(ask->forward);
    gaze.y = ahead.y = 0;
    gaze = vec3_normalize(gaze);
    ahead = vec3_normalize(ahead);
    bool is_aside = vec3_dot(gaze, gaze) > 0 && vec3_dot(gaze, ahead) < (float)TURNED;
    return is_aside ? gaze : ahead;
}

static const bool *occupant_parts(const RemedyAsk *ask, Arena *arena)
{
    const Scene *scene = ask->aim->context->scene;
    bool        *is_occupant = ARENA_NEW(arena, bool, scene->part_count);
    for (int k = 0; ask->occupant && k < ask->occupant->path_count; k++)
        for (int i = 0; i < scene->part_count; i++) {
            const char *file = scene->parts[i].file;
            is_occupant[i] |= file && !strcmp(file, ask->occupant->paths[k]);
        }
    return is_occupant;
}

ChainPlaces remedy_places(const RemedyAsk *ask, Arena *arena)
{
    ChainPlaces places = {.scene = ask->aim->context->scene, .eye = ask->aim->eye,
                          .is_occupant = occupant_parts(ask, arena),
                          .ahead = ahead_of(ask),
                          .face = face_of(ask)};
    memcpy(places.hood_m, HOOD_M, sizeof HOOD_M);
    return places;
}

static void find_empty_seat(const RemedyAsk *ask, const CauseFacts *facts, ReviewCase *c)
{
    double share = facts->seat.what ? facts->seat.cd_m2 / facts->all.cd_m2 : 0;
    if (ask->occupant || !(share >= SEAT_LEAST)) return;
    c->empty_seat = facts->seat.what;
    c->empty_seat_share = fmin(share, 1);
}

void case_remedies(const RemedyAsk *ask, const CauseFacts *facts, ReviewCase *c, Arena *arena)
{
    Remedying m = {ask, facts, c, limit_to_mend(c), NULL, arena};
    find_empty_seat(ask, facts, c);
    if (c->verdict == VERDICT_UNJUDGED || m.limit < 0) return;
    c->remedies = m.list = ARENA_NEW(arena, CaseRemedy, REMEDY_KINDS);
    add_brightness(&m);
    add_tilt(&m);
    add_hood(&m);
    add_coating(&m);
    add_panel(&m);
    add_trim(&m);
}
