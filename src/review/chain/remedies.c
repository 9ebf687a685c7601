/* SPDX-License-Identifier: Apache-2.0 */
#include "review/chain/remedies.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "path/path_context.h"
#include "review/judge.h"
#include "review/private_image.h"
#include "review/quantity.h"
#include "review/request/request.h"
#include "review/symbol/symbol_surface.h"

/* ---- x ----------------------------------------------------------------------------------- */

/* A display as if its face leant back or forward where it stands.
 *
 * Its triangles stay, and what rays meet with them; its shading normals are turned, about the
 * level axis about which a variant's tilt_deg turns a node. So its mirror, its haze and what it
 * emits are those of the tilted display, and what stands before it and behind is seen from
 * where it is now: of a display 0.1 m high the edges would move by 9 mm for 10 degrees.
 *
 * Frames   scene.  Units  degrees, positive: the face turns up.
 * Memory   from the arena; the context that it is made of must outlive it.
 * Threads  any. */

typedef struct LeaningArgs {
    const PathContext   *context;
    const ReviewDisplay *display;
    Vec3                 normal; /* unit, of its middle */
    const double        *ahead;  /* [3] of the vehicle: counts where the display lies flat */
} LeaningArgs;

typedef struct LeaningDisplay {
    Scene       scene;
    PathContext context; /* of that scene: it must not be moved */
} LeaningDisplay;

#define UPRIGHT 0.985f /* cosine of 10 degrees (scene/change/node_change.c) */

typedef struct Turn {
    Vec3  axis; /* unit */
    float cosine, sine;
} Turn;

/* Rodrigues' formula. */
static Vec3 turned(const Turn *turn, Vec3 v)
{
    Vec3 sum = vec3_along(vec3_scale(v, turn->cosine), vec3_cross(turn->axis, v), turn->sine);
    return vec3_along(sum, turn->axis, (1 - turn->cosine) * vec3_dot(turn->axis, v));
}

static Turn turn_of(const LeaningArgs *args, double back_deg)
{
    const Vec3 up = vec3(0, 1, 0);
    double     angle = radians_from_degrees(back_deg);
    Vec3       n = args->normal;
    if (fabsf(n.y) >= UPRIGHT) n = vec3_neg(vec3_from_doubles(args->ahead));
    return (Turn){vec3_normalize(vec3_cross(n, up)), (float)cos_d(angle), (float)sin_d(angle)};
}

static uint32_t end_vertex(const Scene *scene, const Part *part)
{
    uint32_t end = part->first_vertex;
    for (uint32_t t = 0; t < part->triangle_count; t++)
        for (int i = 0; i < 3; i++) {
            uint32_t vertex = scene->triangles[part->first_triangle + t].vertex[i];
            if (vertex >= end) end = vertex + 1;
        }
    return end;
}

/* Normals of a part that has none of its own: of its triangles, by their area. */
static void add_flat_normals(const Scene *scene, const Part *part, Vec3 *normals)
{
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        uint32_t triangle = part->first_triangle + t;
        Vec3     a = scene_corner(scene, triangle, 0);
        Vec3     n = vec3_cross(vec3_sub(scene_corner(scene, triangle, 1), a),
                                vec3_sub(scene_corner(scene, triangle, 2), a));
        for (int i = 0; i < 3; i++) {
            Vec3 *sum = &normals[scene_corner_place(scene, triangle, i)];
            *sum = vec3_add(*sum, n);
        }
    }
}

static Vec3 *turned_normals(const Scene *scene, const Part *part, const Turn *turn,
                            Arena *arena)
{
    uint32_t count = end_vertex(scene, part) - part->first_vertex;
    Vec3    *normals = ARENA_NEW(arena, Vec3, count);
    if (part->normals) memcpy(normals, part->normals, count * sizeof *normals);
    else add_flat_normals(scene, part, normals);
    for (uint32_t i = 0; i < count; i++)
        normals[i] = vec3_normalize(turned(turn, normals[i]));
    return normals;
}

static LeaningDisplay *display_leaning(const LeaningArgs *args, double back_deg, Arena *arena)
{
    const Scene    *scene = args->context->scene;
    LeaningDisplay *out = ARENA_NEW(arena, LeaningDisplay, 1);
    Part *parts = ARENA_NEW(arena, Part, scene->part_count);
    Turn  turn = turn_of(args, back_deg);
    memcpy(parts, scene->parts, (size_t)scene->part_count * sizeof *parts);
    for (int i = 0; i < args->display->part_count; i++) {
        Part *part = &parts[args->display->part_ids[i]];
        part->normals = turned_normals(scene, part, &turn, arena);
    }
    out->scene = *scene;
    out->scene.parts = parts;
    out->context = *args->context;
    out->context.scene = &out->scene;
    return out;
}

#define COATED 0.25 /* of a mirror's light that a usual anti-reflection coating leaves */
#define BRIGHTER_MOST 10.0 /* times as bright: more is not built */
#define PANEL_LEAST 0.1    /* of today's reflection: less is not built either */
#define SEAT_LEAST 0.1     /* of the light: an empty seat's back that is worth a word */
#define TURNED 0.5         /* cosine of 60 degrees: no display is so far from straight ahead */

/* What all remedies share: one case. */
typedef struct Remedying {
    const RemedyArgs  *args;
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
    out.images = case_images_scaled(&out, with.brighter, m->arena);
    judge_contrasts(&out, (MeanInterval){scale * m->c->reflected_range.low,
                                         scale * m->c->reflected_range.high});
    judge_case(&out, m->args->profile, m->arena);
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
    return limit_wants_less(&m->c->limits[m->limit]) ? -half : half;
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

/* Without a part of the light, which other paths found: by its share of theirs. */
static double left_without(const Remedying *m, double cd_m2)
{
    double share = fmin(cd_m2 / m->facts->all.cd_m2, 1);
    return (1 - share) * m->c->luminance_cd_m2.reflected;
}

/* Of the limits that hang on the light, count and are missed, or that no paths decide, the one
 * that is missed by most; -1. */
static int limit_to_mend(const ReviewCase *c)
{
    int worst = -1;
    for (int i = 0; i < c->limit_count; i++) {
        const LimitVerdict *limit = &c->limits[i];
        LimitKind           kind = limit_kind_named(limit->kind);
        bool is_known = limit->verdict == VERDICT_FAIL || limit->verdict == VERDICT_TOO_CLOSE;
        bool is_missed = limit->margin < 0 || case_is_undecidable(c);
        if (limit->is_advice || !is_known || !is_missed || !limit_kinds[kind].is_of_light)
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
    bool   counts = m->args->profile->uses_veil && !m->c->must_not_be_read;
    return counts && veil > 0 ? veil : 0;
}

/* ---- what no closed form gives ----------------------------------------------------------- */

/* A level of visibility, and an image in glass. */
static bool is_searched(const Remedying *m)
{
    const LimitVerdict *limit = &m->c->limits[m->limit];
    return limit->by_pane || limit_kind_named(limit->kind) == LIMIT_VISIBILITY_LEVEL;
}

typedef ReviewCase JudgedBy(const Remedying *m, double factor);

static double margin_by(const Remedying *m, JudgedBy *judged, double factor)
{
    ReviewCase then = judged(m, factor);
    return then.limit_count == m->c->limit_count ? then.limits[m->limit].margin : (double)NAN;
}

#define HALVINGS 24

/* The factor between 1 and `end`, nearest to 1, with which the limit's figure keeps it; NaN:
 * even `end` does not. */
static double factor_by(const Remedying *m, JudgedBy *judged, double end)
{
    double misses = 1, keeps = end;
    if (!(margin_by(m, judged, end) >= 0)) return (double)NAN;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = sqrt(misses * keeps);
        *(margin_by(m, judged, middle) >= 0 ? &keeps : &misses) = middle;
    }
    return keeps;
}

static ReviewCase judged_brighter(const Remedying *m, double factor)
{
    double other = m->c->luminance_cd_m2.reflected - own_light(m);
    return judged_with(m, (Remedied){factor, fmax(other + doubt_of(m), 0)});
}

static ReviewCase judged_reflecting(const Remedying *m, double factor)
{
    return with_light(m, factor * (m->c->luminance_cd_m2.reflected + doubt_of(m)));
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

#define DIMMEST 0.01 /* of what must not be read: who may read it does so no more */
#define TRIES 40
#define TRY_STEP 1.05 /* the panel's errors are in the interval, too */

/* The least with which the limit is judged to be kept. */
static void add_brightness(Remedying *m)
{
    bool   is_private = m->c->must_not_be_read;
    bool   wants_less = limit_wants_less(&m->c->limits[m->limit]);
    double own = own_light(m), other = m->c->luminance_cd_m2.reflected - own;
    double veil = veil_of(m), grows = veil > 0 ? m->c->veil_displays : 0;
    double most = fmax(other + veil - grows + 2 * doubt_of(m), 0);
    double end = is_private ? DIMMEST : wants_less ? 1 / BRIGHTER_MOST : BRIGHTER_MOST;
    double x = is_searched(m) ? factor_by(m, judged_brighter, end)
                              : brighter_for(&m->c->luminance_cd_m2, own + grows, most,
                                             ratio_needed(m));
    for (int i = 0; i < TRIES && x > 0 && x < BRIGHTER_MOST; i++) {
        double     factor = rounded_out(x);
        ReviewCase sure = judged_brighter(m, factor);
        x *= wants_less ? 1 / TRY_STEP : TRY_STEP;
        if (is_private && factor < DIMMEST) return;
        if (!keeps_limit(m, &sure)) continue;
        ReviewCase then = judged_with(m, (Remedied){factor, other});
        add(m, REMEDY_BRIGHTNESS,
            arena_format(m->arena, "the display %.3g times as bright%s", factor,
                         is_private ? " towards this eye" : ""), &then);
        return;
    }
}

/* ---- as dark as it may be ---------------------------------------------------------------- */

static bool is_least_of_contrast(const LimitVerdict *limit)
{
    LimitKind kind = limit_kind_named(limit->kind);
    return kind < LIMIT_KIND_COUNT && limit_kinds[kind].is_contrast && !limit->is_advice &&
           !limit->is_upper;
}

static bool keeps_all(const Remedying *m, double factor, double other)
{
    Remedying  own = *m;
    Arena      scratch = *m->arena;
    own.arena = &scratch;
    ReviewCase then = judged_with(&own, (Remedied){factor, other});
    for (int i = 0; i < then.limit_count; i++)
        if (is_least_of_contrast(&then.limits[i]) && then.limits[i].verdict != VERDICT_PASS)
            return false;
    return true;
}

/* The least factor from `from` on with which all are judged to be kept; the interval narrows
 * as it grows. */
static double surely_from(const Remedying *m, double from, double other)
{
    double low = from, high = BRIGHTER_MOST;
    if (!keeps_all(m, high, other)) return (double)INFINITY;
    for (int i = 0; i < TRIES; i++) {
        double middle = sqrt(low * high);
        *(keeps_all(m, middle, other) ? &high : &low) = middle;
    }
    return high;
}

CaseLeast case_least_level(const Profile *profile, const ReviewCase *c, Arena scratch)
{
    ReviewCase of = *c;
    RemedyArgs  args = {.profile = profile};
    CauseFacts facts = {.own_cd_m2 = isnan(c->own_reflected) ? 0 : c->own_reflected};
    Remedying  m = {.args = &args, .facts = &facts, .c = &of, .arena = &scratch};
    double own = own_light(&m), other = of.luminance_cd_m2.reflected - own, least = -1;
    double veil = veil_of(&m), grows = veil > 0 ? of.veil_displays : 0;
    if (of.verdict == VERDICT_UNJUDGED || !(of.level > 0)) return (CaseLeast){NAN, NAN};
    for (m.limit = 0; m.limit < of.limit_count; m.limit++) {
        if (!is_least_of_contrast(&of.limits[m.limit])) continue;
        double x = brighter_for(&of.luminance_cd_m2, own + grows, other + veil - grows,
                                ratio_needed(&m));
        least = fmax(least, x <= BRIGHTER_MOST ? x : (double)INFINITY);
    }
    if (least < 0) return (CaseLeast){NAN, NAN};
    double sure = isinf(least) ? least : surely_from(&m, fmax(least, 1e-6), other);
    return (CaseLeast){least * of.level, sure * of.level};
}

/* ---- tilt -------------------------------------------------------------------------------- */

#define TILTS 6
static const double TILT_DEG[TILTS] = {3, -3, 6, -6, 9, -9}; /* back is positive */
#define TILT_PATHS 1024         /* of each that is tried */
#define TILT_PRECISION 0.01     /* of the contrast, of the one that is reported, */
#define TILT_MOST 65536         /* in so many paths at most, fresh ones: */
#define TILT_SEED 0x74696c74u

/* Of a class that emits nothing all is left. */
static double shown_share(double after, double before)
{
    return before > 0 ? after / before : 1;
}

/* The case with the display leaning back so far, read by paths of that seed. */
static ReviewCase judged_leaning(const Remedying *m, double back_deg, uint32_t seed,
                                 ReadingGoal goal)
{
    const RemedyArgs *args = m->args;
    Arena            own = arena_reserve((size_t)1 << 28);
    LeaningArgs       how = {args->aim->context, args->display, args->middle.ns, args->forward};
    LeaningDisplay  *leaning = display_leaning(&how, back_deg, &own);
    SymbolSurface    surface = *args->look.surface;
    SymbolLook       look = args->look;
    ProbeAim         aim = *args->aim;
    ReadingTools     tools = *args->tools;
    tools.journal = NULL; /* it knows the scene by its files */
    aim.context = &leaning->context;
    aim.seed ^= seed;
    Reading        reading = reading_take(&aim, &goal, &tools, own);
    SymbolEmission before = symbol_emission(&look, 1);
    surface.scene = &leaning->scene;
    look.surface = &surface;
    SymbolEmission  after = symbol_emission(&look, 1);
    ReviewCase      out = *m->c;
    CaseLuminances *l = &out.luminance_cd_m2;
    l->foreground *= shown_share(after.foreground_xyz[1], before.foreground_xyz[1]);
    l->background *= shown_share(after.background_xyz[1], before.background_xyz[1]);
    l->reflected = reading.reflected;
    judge_contrasts(&out, reading.interval);
    judge_case(&out, args->profile, m->arena);
    arena_release(&own);
    return out;
}

/* The least that is enough; else that which gives most. */
static void add_tilt(Remedying *m)
{
    const CaseLuminances *l = &m->c->luminance_cd_m2;
    ReadingGoal goal = {.brighter = fmax(l->foreground, l->background),
                        .darker = fmin(l->foreground, l->background), .most = TILT_PATHS};
    double best = m->c->limits[m->limit].margin;
    int    at = -1;
    for (int i = 0; i < TILTS; i++) {
        ReviewCase then = judged_leaning(m, TILT_DEG[i], 0, goal);
        if (then.limit_count != m->c->limit_count || !(then.limits[m->limit].margin > best))
            continue;
        best = then.limits[m->limit].margin;
        at = i;
        if (keeps_limit(m, &then)) break;
    }
    if (at < 0) return;
    goal.precision = TILT_PRECISION;
    goal.most = TILT_MOST;
    ReviewCase then = judged_leaning(m, TILT_DEG[at], TILT_SEED, goal);
    add(m, REMEDY_TILT,
        arena_format(m->arena, "the display leaning %s by %.3g degrees",
                     TILT_DEG[at] > 0 ? "back" : "forward", fabs(TILT_DEG[at])), &then);
}

/* ---- a hood ------------------------------------------------------------------------------ */

static const float HOOD_M[PLACE_HOODS] = {0.03f, 0.06f, 0.1f};

static PlaceFace face_of(const RemedyArgs *args)
{
    return place_face(args->aim->context->scene, args->display->part_ids,
                      args->display->part_count);
}

static bool hides_symbol(const RemedyArgs *args, const PlaceFace *face, float depth_m)
{
    const ProbeAim *aim = args->aim;
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
    PlaceFace face = face_of(m->args);
    int       best = -1;
    for (int i = 0; i < PLACE_HOODS && face.is_upright; i++) {
        if (hides_symbol(m->args, &face, HOOD_M[i])) break;
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
    double doubt = doubt_of(m), share;
    if (limit_wants_less(&m->c->limits[m->limit])) return;
    share = (reflected_at(l, ratio_needed(m)) - veil_of(m)) / (l->reflected + 2 * doubt);
    if (is_searched(m)) share = factor_by(m, judged_reflecting, PANEL_LEAST);
    for (int i = 0; i < TRIES && share > PANEL_LEAST && share < 1; i++) {
        double     factor = rounded_out(share);
        ReviewCase sure = judged_reflecting(m, factor);
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
static Vec3 ahead_of(const RemedyArgs *args)
{
    Vec3 gaze = vec3_sub(args->middle.position, args->aim->eye);
    Vec3 ahead = vec3_from_doubles(args->forward);
    gaze = vec3_normalize(vec3(gaze.x, 0, gaze.z));
    ahead = vec3_normalize(vec3(ahead.x, 0, ahead.z));
    return vec3_dot(gaze, gaze) > 0 && vec3_dot(gaze, ahead) < (float)TURNED ? gaze : ahead;
}

static const bool *occupant_parts(const RemedyArgs *args, Arena *arena)
{
    const Scene *scene = args->aim->context->scene;
    bool        *is_occupant = ARENA_NEW(arena, bool, scene->part_count);
    for (int k = 0; args->occupant && k < args->occupant->path_count; k++)
        for (int i = 0; i < scene->part_count; i++) {
            const char *file = scene->parts[i].file;
            is_occupant[i] |= file && !strcmp(file, args->occupant->paths[k]);
        }
    return is_occupant;
}

ChainPlaces remedy_places(const RemedyArgs *args, Arena *arena)
{
    ChainPlaces places = {.scene = args->aim->context->scene, .eye = args->aim->eye,
                          .is_occupant = occupant_parts(args, arena),
                          .ahead = ahead_of(args),
                          .face = face_of(args)};
    memcpy(places.hood_m, HOOD_M, sizeof HOOD_M);
    return places;
}

static void find_empty_seat(const RemedyArgs *args, const CauseFacts *facts, ReviewCase *c)
{
    double share = facts->seat.what ? facts->seat.cd_m2 / facts->all.cd_m2 : 0;
    if (args->occupant || !(share >= SEAT_LEAST)) return;
    c->empty_seat = facts->seat.what;
    c->empty_seat_share = fmin(share, 1);
}

void case_remedies(const RemedyArgs *args, const CauseFacts *facts, ReviewCase *c, Arena *arena)
{
    Remedying m = {args, facts, c, limit_to_mend(c), NULL, arena};
    find_empty_seat(args, facts, c);
    if (c->verdict == VERDICT_UNJUDGED || m.limit < 0) return;
    c->remedies = m.list = ARENA_NEW(arena, CaseRemedy, REMEDY_KINDS);
    add_brightness(&m);
    if (c->image_count) return; /* how glass would show it else is not known */
    add_tilt(&m);
    add_hood(&m);
    add_coating(&m);
    add_panel(&m);
    add_trim(&m);
}
