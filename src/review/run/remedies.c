/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/remedies.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"

#define COATED 0.25 /* of a mirror's light that a usual anti-reflection coating leaves */
#define BRIGHTER_MOST 10.0 /* times as bright: more is not built */
#define PANEL_LEAST 0.1    /* of today's reflection: less is not built either */
#define SEAT_LEAST 0.1     /* of the light: an empty seat's back that is worth a word */
#define TURNED 0.5         /* cosine of 60 degrees: no display is so far from straight ahead */
#define REMEDIES_MOST (REMEDY_KINDS + 1)

/* What all remedies share: one case. */
typedef struct Mending {
    const RemedyAsk  *ask;
    const CauseFacts *facts;
    ReviewCase       *c;
    CaseRemedy       *list;
    double            needed; /* contrast ratio, without the veil */
    double            surely; /* reflected light at the end of the contrast's interval that is
                                 worst for it */
    Arena            *arena;
} Mending;

/* ---- contrasts --------------------------------------------------------------------------- */

/* The display's own light that comes back to it grows with its brightness. */
static double contrast(const CaseLuminances *l, double brighter, double reflected)
{
    return luminance_contrast(brighter * l->foreground, brighter * l->background, reflected);
}

/* Of a limit in its own words (profile.h). */
static double ratio_of(const LimitVerdict *limit)
{
    double value = limit->value;
    if (!strcmp(limit->kind, "luminance_contrast")) return value + 1;
    if (!strcmp(limit->kind, "modulation")) return (1 + value) / (1 - value);
    return value;
}

/* What would have to be reflected for a contrast. */
static double reflected_at(const CaseLuminances *l, double ratio)
{
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    return (high - ratio * low) / (ratio - 1);
}

/* Away from 0, or towards it, to three digits: what is printed is what was meant. */
static double rounded(double value, bool is_up)
{
    double step = pow_d(10, floor(log10_d(value)) - 2);
    return step * (is_up ? ceil(value / step) : floor(value / step));
}

static void add(Mending *m, CaseRemedy remedy)
{
    if (!isnan(remedy.contrast_ratio) && !(remedy.contrast_ratio > m->c->contrast_high)) return;
    m->list[m->c->remedy_count++] = remedy;
}

static void add_with(Mending *m, RemedyKind kind, const char *what, double reflected)
{
    ReviewCase *c = m->c;
    add(m, (CaseRemedy){kind, what, contrast(&c->luminance_cd_m2, 1, fmax(reflected, 0)),
                        c->level});
}

/* Without a part of the light, which other paths found: by its share of theirs. */
static double left_without(const Mending *m, double cd_m2)
{
    double share = fmin(cd_m2 / m->facts->all.cd_m2, 1);
    return (1 - share) * m->c->luminance_cd_m2.reflected;
}

/* ---- brightness -------------------------------------------------------------------------- */

/* By how much the display must be brighter for a contrast,
 * (H x + R + O x) / (L x + R + O x) = C, O its own light that is reflected, R all other;
 * NaN: no brightness does it. */
static double brighter_for(const CaseLuminances *l, double reflected, double own, double needed)
{
    double high = fmax(l->foreground, l->background), low = fmin(l->foreground, l->background);
    double gain = high + own - needed * (low + own);
    return gain > 0 ? (reflected - own) * (needed - 1) / gain : (double)NAN;
}

static void add_brightness(Mending *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    double own = fmin(m->facts->own_cd_m2, l->reflected);
    double brighter = brighter_for(l, m->surely, own, m->needed);
    if (!(brighter > 1) || !(brighter < BRIGHTER_MOST)) return;
    brighter = rounded(brighter, true);
    add(m, (CaseRemedy){REMEDY_BRIGHTNESS,
                        arena_format(m->arena, "the display %.3g times as bright", brighter),
                        contrast(l, brighter, l->reflected + (brighter - 1) * own),
                        m->c->level * brighter});
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
    SymbolPoint middle = symbol_middle(ask->symbol);
    Vec3 right = vec3_normalize(vec3_cross(vec3(0, 1, 0), middle.ns));
    return (Mirror){symbol_point_start(ask->aim->context->scene, &middle), middle.ns,
                    vec3_cross(middle.ns, right)};
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

/* The least that is enough; else that which gives most. */
static void add_traced_tilt(Mending *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    TiltSearch search = {.ask = m->ask, .mirror = mirror_of(m->ask)};
    double     best = 0, reflected[TILTS];
    int        at = 0;
    parallel_for(m->ask->tools->threads, TILTS, trace_tilt, &search);
    if (!(search.cd_m2[0] > 0)) return;
    for (int i = 1; i < TILTS && best < m->needed; i++) {
        reflected[i] = l->reflected - l->mirror * (1 - search.cd_m2[i] / search.cd_m2[0]);
        double found = contrast(l, 1, reflected[i]);
        if (!(found > best)) continue;
        best = found;
        at = i;
    }
    if (at) add_with(m, REMEDY_TILT, tilt_words(TILT_DEG[at], m->arena), reflected[at]);
}

/* Turns the mirror away from where the light comes from. */
static void add_tilt_to_try(Mending *m)
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
    add(m, (CaseRemedy){REMEDY_TILT,
                        back < forward ? "the display leaning back by a few degrees"
                                       : "the display leaning forward by a few degrees",
                        (double)NAN, m->c->level});
}

static void add_tilt(Mending *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    if (l->mirror > MIRROR_MOST * l->reflected) add_traced_tilt(m);
    else add_tilt_to_try(m);
}

/* ---- a hood ------------------------------------------------------------------------------ */

static const float HOOD_M[PLACE_HOODS] = {0.03f, 0.06f, 0.1f};

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
static void add_hood(Mending *m, const PlaceFace *face)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    int best = -1;
    for (int i = 0; i < PLACE_HOODS && face->is_upright; i++) {
        if (hides_symbol(m->ask, face, HOOD_M[i])) break;
        best = i;
        if (contrast(l, 1, left_without(m, m->facts->hooded[i])) >= m->needed) break;
    }
    if (best >= 0)
        add_with(m, REMEDY_HOOD,
                 arena_format(m->arena, "a hood of %.0f mm over the display",
                              1000 * (double)HOOD_M[best]),
                 left_without(m, m->facts->hooded[best]));
}

/* ---- coating, panel, trim ---------------------------------------------------------------- */

static void add_coating(Mending *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    if (l->mirror > 0)
        add_with(m, REMEDY_COATING, "a coating that leaves a quarter of the mirror's light",
                 l->reflected - (1 - COATED) * l->mirror);
}

static void add_panel(Mending *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    double share = reflected_at(l, m->needed) / m->surely;
    if (!(share < 1) || !(share > PANEL_LEAST)) return;
    share = rounded(share, false);
    add_with(m, REMEDY_PANEL,
             arena_format(m->arena, "a panel as bright that reflects %.3g times as much",
                          share), share * l->reflected);
}

static void add_trim(Mending *m)
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
    Vec3 gaze = vec3_sub(symbol_middle(ask->symbol).position, ask->aim->eye);
    Vec3 ahead = vec3_from_doubles(ask->forward);
    gaze.y = ahead.y = 0;
    gaze = vec3_normalize(gaze);
    ahead = vec3_normalize(ahead);
    bool is_aside = vec3_dot(gaze, gaze) > 0 && vec3_dot(gaze, ahead) < (float)TURNED;
    return is_aside ? gaze : ahead;
}

ChainPlaces remedy_places(const RemedyAsk *ask)
{
    const Scene         *scene = ask->aim->context->scene;
    const ReviewDisplay *display = &ask->symbol->display;
    ChainPlaces places = {.scene = scene, .eye = ask->aim->eye, .ahead = ahead_of(ask),
                          .face = place_face(scene, display->part_ids, display->part_count)};
    memcpy(places.hood_m, HOOD_M, sizeof HOOD_M);
    return places;
}

static void find_empty_seat(const RemedyAsk *ask, const CauseFacts *facts, ReviewCase *c)
{
    double share = facts->seat.what ? facts->seat.cd_m2 / facts->all.cd_m2 : 0;
    if (ask->has_occupant || !(share >= SEAT_LEAST)) return;
    c->empty_seat = facts->seat.what;
    c->empty_seat_share = fmin(share, 1);
}

void case_remedies(const RemedyAsk *ask, const CauseFacts *facts, ReviewCase *c, Arena *arena)
{
    Mending m = {ask, facts, c, ARENA_NEW(arena, CaseRemedy, REMEDIES_MOST), 0, 0, arena};
    find_empty_seat(ask, facts, c);
    if (c->limit_id < 0 || !(c->margin < 0) || !(c->visible_share > 0)) return;
    const CaseLuminances *l = &c->luminance_cd_m2;
    PlaceFace face = place_face(ask->aim->context->scene, ask->symbol->display.part_ids,
                                ask->symbol->display.part_count);
    m.needed = ratio_of(&c->limits[c->limit_id]);
    m.surely = c->contrast_low > 1 ? reflected_at(l, c->contrast_low) : c->reflected_range.high;
    add_brightness(&m);
    add_tilt(&m);
    add_hood(&m, &face);
    add_coating(&m);
    add_panel(&m);
    add_trim(&m);
    c->remedies = m.list;
}
