/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/cases.h"

#include <math.h>

#include "base/sampler.h"
#include "base/units.h"
#include "review/chain/causes.h"
#include "review/chain/remedies.h"
#include "review/eye/eye_reading.h"
#include "review/judge.h"
#include "review/keep/frame_kept.h"
#include "review/light/setup.h"
#include "review/light/response_suns.h"
#include "review/review_decide.h"
#include "review/run/alike.h"
#include "review/run/case_visibility.h"
#include "review/run/private_images.h"
#include "review/run/symbols.h"
#include "scene/load/material_data.h"
#include "text/text.h"
#include "vision/grey_steps.h"

/* Read on from setup_cases, which is the first function. A case is made in this order:
 *   1. face_lux: the illuminance of the display, which says what ambient limits are of;
 *   2. judge_eye: the worst of the eye's points, by a coarse reading of each; a variant takes the
 *      review's reading where its light is the same (like_of);
 *   3. judge_look: the symbol from that point. see_symbol finds its visible share, size, emission
 *      and stray light, and read_part the reflected light of its worst part, sampled until the
 *      verdict is clear. Colours of other symbols and private images follow, then the verdict;
 *   4. causes, the share of light without data, and remedies (case_of).
 */

#define FACE_PRECISION 0.02
#define FACE_PRECISION_VARIANT 0.05 /* where that tells day from night: it has no other use */
#define FACE_PATHS 16384
#define FACE_SEED 0x66616365u
#define EYE_SEED 0x65796573u
#define SUN_PATHS SYMBOL_POINTS
/* Times the paths of a review with variants, and of those: where most of two readings is common to
 * both, their difference is then known twice as well as two such reviews would know it. */
#define COMPARED_TIMES 2
#define COARSE_PRECISION 0.05
#define COARSE_PATHS 8192
#define COARSE_SEED 0x626f7865u /* the worst of many is not read again from what made it so */

/* The display's luminance to the eye by direct sun alone, cd m^-2. */
typedef struct DirectSun {
    double scattered, mirror;
    double beside[2]; /* X and Z of the mirror's */
} DirectSun;

/* What was read of a look. */
typedef struct LookReading {
    ReviewCase of;
    DirectSun direct; /* of what is reflected */
} LookReading;

/* One point of an eye that looks at a symbol; coarse: to find the worst of many points; bare:
 * without stray light. */
typedef struct CaseLook {
    const SetupSymbol *symbol;
    Vec3 eye;
    bool is_coarse, is_bare;
    bool is_open;       /* of coarse ones: fewer paths leave its verdict open */
    bool has_colour;    /* that is asked for */
    const Vec3 *points; /* [point_count], all of the eye's; NULL: no glass is searched */
    int point_count;
    const LookReading *like; /* of a variant: the review's, which is this one's, too; NULL: it is
                                read by itself */
    double within;           /* this share of each other */
} CaseLook;

/* The question of one symbol and one eye. */
typedef struct CaseArgs {
    const ReviewEye *eye;
    const SetupSymbol *symbol;
    double face_lux;
    bool is_bare; /* its light and verdict alone */
} CaseArgs;

static bool case_of(const CaseTools *tools, const CaseArgs *args, Arena *arena, ReviewCase *out,
                    Error *err);
static double face_lux(const CaseTools *tools, const SetupSymbol *symbol, Arena scratch);
static ReviewCase start_case(const CaseTools *tools, const ReviewEye *eye,
                             const SetupSymbol *symbol);
static ProbeAim judge_eye(const CaseTools *tools, CaseLook *look, ReviewCase *c, Arena *arena);
static ProbeAim judge_look(const CaseTools *tools, const CaseLook *look, ReviewCase *c,
                           DirectSun *direct, Arena *arena);
static ProbeAim see_symbol(const CaseTools *tools, const CaseLook *look, ReviewCase *c,
                           DirectSun *direct, Arena *arena);

/* ---- all cases --------------------------------------------------------------------------- */

bool setup_cases(const CaseTools *tools, Arena *arena, ReviewCase *out, Error *err) {
    const ReviewRequest *request = tools->setup->request;
    int symbols = tools->symbol_count, count = request->eye_count * symbols;
    double *faces = ARENA_NEW(arena, double, symbols);
    bool *is_known = ARENA_NEW(arena, bool, symbols);
    for (int i = 0; i < count; i++) {
        int s = i % symbols;
        if (!is_known[s]) faces[s] = face_lux(tools, &tools->symbols[s], *arena);
        is_known[s] = true;
        CaseArgs args = {&request->eyes[i / symbols], &tools->symbols[s], faces[s],
                         tools->base != NULL};
        if (!case_of(tools, &args, arena, &out[i], err)) return false;
        if (tools->progress) progress_update(tools->progress, tools->progress->done + 1);
    }
    return true;
}

bool setup_case(const CaseTools *tools, const SetupSymbol *symbol, const ReviewEye *eye,
                Arena *arena, ReviewCase *out, Error *err) {
    CaseArgs args = {eye, symbol, face_lux(tools, symbol, *arena), tools->base != NULL};
    return case_of(tools, &args, arena, out, err);
}

bool setup_verdict(const CaseTools *tools, const SetupSymbol *symbol, const ReviewEye *eye,
                   Arena *arena, ReviewCase *out, Error *err) {
    return case_of(tools, &(CaseArgs){eye, symbol, out->display_lux, true}, arena, out, err);
}

/* ---- one case ---------------------------------------------------------------------------- */

static bool case_of(const CaseTools *tools, const CaseArgs *args, Arena *arena, ReviewCase *out,
                    Error *err) {
    int count;
    Vec3 *points = setup_eye_points(tools->setup, args->eye, &count, arena, err);
    ReviewCase c = start_case(tools, args->eye, args->symbol);
    CaseLook look = {.symbol = args->symbol, .is_bare = args->is_bare};
    if (!points || !review_goes_on(err)) return false;
    c.display_lux = args->face_lux;
    c.eye_failed_share = (double)NAN;
    look.has_colour = !c.must_not_be_read &&
                      (profile_has(tools->profile, LIMIT_COLOUR_SHIFT) ||
                       tools->setup->request->symbols[args->symbol->symbol_id].distinct_count);
    look.points = points;
    look.point_count = count;
    ProbeAim aim = judge_eye(tools, &look, &c, arena);
    world_from_scene(tools->setup->scene->origin, look.eye, c.eye_m);
    c.panel = symbol_panel(args->symbol, arena);
    if (aim.target_count && !args->is_bare) {
        long paths = tools->cause_paths ? tools->cause_paths : CAUSE_PATHS;
        int rays = tools->cause_rays ? tools->cause_rays : CAUSE_RAYS;
        const Setup *setup = tools->setup;
        ChainSeat seat =
            seat_of_eye(aim.eye, symbol_middle(args->symbol).position, setup->request->forward);
        bool is_empty = !setup->condition || setup->condition->with_id == NO_ID;
        CauseArgs causes = {&setup->tools, &aim, paths, rays, is_empty ? &seat : NULL};
        case_causes(&causes, &c, arena);
        judge_case(&c, tools->profile, arena); /* now that its share without data is known */
        case_remedies(tools->profile, tools->setup->request->max_level, &c, arena);
    }
    *out = c;
    return true;
}

/* Illuminance of a symbol's middle. */
static double face_lux(const CaseTools *tools, const SetupSymbol *symbol, Arena scratch) {
    const Setup *setup = tools->setup;
    SymbolPoint point = symbol_middle(symbol);
    LitPoint head = {symbol_point_start(setup->scene, &point), point.ns, false};
    ReadingGoal goal = {.precision = tools->base ? FACE_PRECISION_VARIANT : FACE_PRECISION,
                        .most = FACE_PATHS};
    Reading face = setup_meter(setup, head, FACE_SEED, &goal, scratch);
    if (tools->base && profile_ambient(tools->profile, face.interval.low, false) !=
                           profile_ambient(tools->profile, face.interval.high, false)) {
        goal.precision = FACE_PRECISION;
        face = setup_meter(setup, head, FACE_SEED, &goal, scratch);
    }
    return face.reflected;
}

static void name_symbol(const Setup *setup, const SetupSymbol *symbol, ReviewCase *c) {
    c->symbol = symbol->name;
    c->display = symbol->display_name;
    c->level = (double)setup->scene->displays[symbol->display.display_id].level;
    c->panel = symbol->panel;
}

static ReviewCase start_case(const CaseTools *tools, const ReviewEye *eye,
                             const SetupSymbol *symbol) {
    const Setup *setup = tools->setup;
    Vec3 towards;
    ReviewCase c = review_case_unknown();
    c.condition = setup->condition->name;
    c.eye = eye->name;
    name_symbol(setup, symbol, &c);
    c.is_optional = review_is_optional(setup->request, symbol->symbol_id, eye);
    c.must_not_be_read = review_is_private(setup->request, symbol->symbol_id, eye);
    memcpy(c.origin_m, setup->scene->origin, sizeof c.origin_m);
    if (setup_sun(setup, &towards, NULL)) {
        SunAngles angles = setup_angles(setup, towards);
        c.has_sun = true;
        c.sun_azimuth_deg = angles.azimuth_deg;
        c.sun_elevation_deg = angles.elevation_deg;
    }
    return c;
}

/* ---- light straight from the sun ---------------------------------------------------------- */

static DirectSun direct_sun(const Setup *setup, const ProbeAim *aim, Arena scratch) {
    Vec3 towards;
    float bands[3][LIGHT_BANDS];
    DirectSun direct = {0};
    if (!setup_sun_xyz(setup, aim->colour, &towards, bands)) return direct;
    float radius = (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG);
    ProbeSuns suns = {&towards, 1, radius, false};
    ResponseOptions options = {setup->tools, 0, SUN_PATHS, 0};
    for (int by_mirror = 0; by_mirror < 2; by_mirror++) {
        Arena room = scratch;
        suns.by_mirror = by_mirror;
        if (by_mirror) options.paths = response_mirror_paths(aim, radius);
        const float *shares = response_suns(aim, &options, &suns, &room);
        *(by_mirror ? &direct.mirror : &direct.scattered) = light_bands_sum(shares, bands[1]);
        for (int k = 0; k < 2 && by_mirror; k++)
            direct.beside[k] = light_bands_sum(shares, bands[2 * k]);
    }
    return direct;
}

/* Does most of what the display reflects come straight from the sun? Then it stands in the sun,
 * whichever part of it. */
static bool is_in_sun(DirectSun direct, double reflected) {
    return direct.scattered + direct.mirror > CASE_SUNLIT * reflected;
}

/* The share of a reading's interval that is known of the sun's image: no path lessens it. */
static double known_share(DirectSun direct, MeanInterval reflected) {
    double range = reflected.high - reflected.low;
    return range > 0 ? fmin(4 * RESPONSE_MIRROR_ERROR * direct.mirror / range, 1) : 0;
}

/* ---- an eye: the worst of its points ------------------------------------------------------ */

/* The points of an eye; readings: NULL, or [count] to be filled; like: of a variant, the review's
 * readings [count], or NULL. */
typedef struct EyePlaces {
    const Vec3 *points;
    int count;
    LookReading *readings;
    const LookReading *like;
} EyePlaces;

/* What a case of a review with variants leaves for them. */
typedef struct CaseKept {
    const CasePilot *pilot;
    LookReading own;
    int at;                    /* which of the eye's points it is of */
    const LookReading *points; /* of all of them, where there are several */
} CaseKept;

/* What must not be read is judged by its least part; lenses have no pilot. */
static bool is_kept(const CaseTools *tools, const ReviewCase *c) {
    const Setup *setup = tools->setup;
    return setup->request->variant_count && !c->must_not_be_read &&
           !(setup->condition && setup->condition->glasses);
}

/* The pilot of a part and, from all points, of all. */
static const CasePilot *pilot_of(const CaseTools *tools, const CaseLook *look, const ProbeAim *part,
                                 double mirror, Arena *arena) {
    PilotArgs args = {tools->setup, &look->symbol->surface, part,
                      mirror,       look->points,           look->point_count};
    return case_pilot(&args, arena);
}

/* By how bad its verdict is, then by its margin. */
static bool is_worse(const ReviewCase *a, const ReviewCase *b) {
    int rank_a = verdict_rank(a->verdict), rank_b = verdict_rank(b->verdict);
    return rank_a != rank_b ? rank_a > rank_b : a->margin < b->margin;
}

static CasePlace place_of(const Setup *setup, Vec3 eye, const ReviewCase *seen) {
    CasePlace place = {.verdict = seen->verdict,
                       .visible_share = seen->visible_share,
                       .contrast_ratio = seen->contrast_ratio,
                       .contrast_low = seen->contrast_low,
                       .contrast_high = seen->contrast_high};
    world_from_scene(setup->scene->origin, eye, place.eye_m);
    return place;
}

/* The index of an eye's worst point, which all of them are read for where there are several; sets
 * the share of points that fail, and of what must not be read how each sees it. */
static int worst_point(const CaseTools *tools, const CaseLook *look, const EyePlaces *of,
                       ReviewCase *c, Arena *arena) {
    ReviewCase start = *c, worst;
    CasePlace *places = NULL;
    int at = 0, failed = 0;
    if (of->count == 1) return 0;
    if (c->must_not_be_read) {
        c->places = places = ARENA_NEW(arena, CasePlace, of->count);
        c->place_count = of->count;
    }
    for (int i = 0; i < of->count; i++) {
        Arena room = *arena;
        CaseLook one = {.symbol = look->symbol,
                        .eye = of->points[i],
                        .is_coarse = true,
                        .is_bare = true,
                        .like = of->like ? &of->like[i] : NULL,
                        .within = look->within};
        ReviewCase seen = start;
        DirectSun direct;
        judge_look(tools, &one, &seen, &direct, &room);
        if (seen.verdict == VERDICT_TOO_CLOSE) {
            one.is_open = true;
            one.like = NULL;
            seen = start;
            judge_look(tools, &one, &seen, &direct, &room);
        }
        if (of->readings) of->readings[i] = (LookReading){seen, direct};
        failed += seen.verdict == VERDICT_FAIL || seen.verdict == VERDICT_UNJUDGED;
        if (places) places[i] = place_of(tools->setup, of->points[i], &seen);
        if (i && !is_worse(&seen, &worst)) continue;
        worst = seen;
        at = i;
    }
    c->eye_failed_share = (double)failed / of->count;
    return at;
}

/* The most by which a variant's light is apart from the review's, as a share; INFINITY: they
 * differ. A sweep's worst may be under another sun. */
static double apart_from(const CaseTools *tools, const CaseLook *look, const ReviewCase *like,
                         const ReviewCase *c, Arena scratch) {
    const Setup *setup = tools->setup;
    ProbeAim aim = {.context = &setup->context, .eye = look->points[like->kept->at]};
    if (c->has_sun && c->sun_elevation_deg != like->sun_elevation_deg) return (double)INFINITY;
    aim = worst_part_aim(look->symbol, &aim, &like->whole.part, &scratch);
    if (!aim.target_count) return (double)INFINITY;
    double mirror = direct_sun(setup, &aim, scratch).mirror;
    return case_pilots_apart(like->kept->pilot, pilot_of(tools, look, &aim, mirror, &scratch));
}

/* The review's same case, where a variant's is alike: no further apart than the precision that
 * is asked of the contrast; else NULL. */
static const ReviewCase *like_of(const CaseTools *tools, CaseLook *look, const ReviewCase *c,
                                 Arena scratch) {
    const ReviewCase *like = tools->base ? review_case_like(tools->base, c) : NULL;
    if (!like || !like->kept) return NULL;
    look->within = apart_from(tools, look, like, c, scratch);
    return look->within <= tools->setup->request->precision_contrast ? like : NULL;
}

/* At the worst of its points. */
static ProbeAim judge_eye(const CaseTools *tools, CaseLook *look, ReviewCase *c, Arena *arena) {
    const ReviewCase *like = like_of(tools, look, c, *arena);
    bool keeps = is_kept(tools, c);
    EyePlaces of = {.points = look->points,
                    .count = look->point_count,
                    .readings = keeps ? ARENA_NEW(arena, LookReading, look->point_count) : NULL,
                    .like = like ? like->kept->points : NULL};
    CaseKept kept = {.at = worst_point(tools, look, &of, c, arena), .points = of.readings};
    look->eye = of.points[kept.at];
    if (like && like->kept->at == kept.at) look->like = &like->kept->own;
    ProbeAim aim = judge_look(tools, look, c, &kept.own.direct, arena);
    kept.own.of = *c;
    if (keeps && aim.target_count) {
        CaseKept *to = ARENA_NEW(arena, CaseKept, 1);
        kept.pilot = pilot_of(tools, look, &aim, kept.own.direct.mirror, arena);
        *to = kept;
        c->kept = to;
    }
    return aim;
}

/* ---- a look: one symbol from one point ---------------------------------------------------- */

/* A variant has no causes, and its light may come by other materials than the review's:
 * its own paths show, where any of them has no data. Of one whose levels alone differ, and to
 * find the worst of many points, the review's share counts. */
static double data_share_of(const CaseTools *tools, const CaseLook *look, const ProbeAim *aim,
                            const ReviewCase *c, Arena scratch) {
    const Setup *setup = tools->setup;
    const ReviewCase *like = tools->base ? review_case_like(tools->base, c) : NULL;
    CauseArgs args = {.tools = &setup->tools, .aim = aim, .paths = CAUSE_PATHS};
    int count;
    if (!like || look->is_coarse || setup->request->is_relevelled || !aim->target_count)
        return like ? like->without_data_share : 0;
    scene_without_data(setup->scene, &count, &scratch);
    return count ? case_data_share(&args, scratch) : 0;
}

/* The colours of those that the symbol must be told from, as cases of their own have them, and
 * which are seen. */
static void see_others(const CaseTools *tools, const CaseLook *look, ReviewCase *c, Arena *arena) {
    const ReviewRequest *request = tools->setup->request;
    const ReviewSymbol *asked = &request->symbols[look->symbol->symbol_id];
    CaseColour *list = ARENA_NEW(arena, CaseColour, 1 + tools->symbol_count);
    list[0] = c->colours[0];
    for (int i = 0; i < tools->symbol_count; i++) {
        const SetupSymbol *symbol = &tools->symbols[i];
        CaseLook one = {.symbol = symbol, .eye = look->eye, .is_bare = true, .has_colour = true};
        ReviewCase other = review_case_unknown();
        DirectSun direct;
        int k = 0;
        while (k < asked->distinct_count && asked->distinct_from[k] != symbol->symbol_id) k++;
        if (k == asked->distinct_count) continue;
        name_symbol(tools->setup, symbol, &other);
        other.condition = c->condition;
        other.eye = c->eye;
        other.display_lux = c->display_lux;
        if (!see_symbol(tools, &one, &other, &direct, arena).target_count) continue;
        other.colours[0].light->is_on_display =
            symbol->display.display_id == look->symbol->display.display_id;
        list[c->colour_count++] = other.colours[0];
    }
    c->colours = list;
}

/* *direct: of what is reflected. */
static ProbeAim judge_look(const CaseTools *tools, const CaseLook *look, ReviewCase *c,
                           DirectSun *direct, Arena *arena) {
    *direct = (DirectSun){0};
    ProbeAim aim = see_symbol(tools, look, c, direct, arena);
    if (c->colour_count) see_others(tools, look, c, arena);
    if (c->must_not_be_read && look->points)
        private_images_find(
            &(PrivateLook){tools->setup, look->symbol, look->points, look->point_count}, c, arena);
    judge_ambient(c, tools->profile,
                  aim.target_count && is_in_sun(*direct, c->luminance_cd_m2.reflected));
    c->without_data_share = data_share_of(tools, look, &aim, c, *arena);
    judge_case(c, tools->profile, arena);
    judge_open(c, known_share(*direct, c->reflected_range));
    return aim;
}

/* ---- its light ---------------------------------------------------------------------------- */

static void set_contrasts(ReviewCase *c, MeanInterval reflected) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double veil = isnan(l->veil) ? 0 : l->veil, lets = c->glasses_transmittance;
    judge_contrasts(c, reflected);
    c->jnd = grey_steps_between(lets * (l->foreground + l->reflected + veil),
                                lets * (l->background + l->reflected + veil));
}

/* A stroke and a gap as wide are one cycle. */
static double visibility_of(const ReviewCase *c, const SymbolSplit *split) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double stroke_deg = symbol_stroke_deg(split, c->height_arcmin);
    double mean =
        c->glasses_transmittance * (0.5 * (l->foreground + l->background) + l->reflected + l->veil);
    double michelson = (c->contrast_with_veil - 1) / (c->contrast_with_veil + 1);
    return michelson * contrast_sensitivity(1 / (2 * stroke_deg), mean, c->height_arcmin / 60);
}

_Static_assert(CASE_BATCHES == READING_BATCHES, "a case keeps what a reading has");

/* A look without stray light has levels only where a limit is about them. */
static bool has_visibility(const CaseTools *tools, const CaseLook *look) {
    bool is_limited = profile_has(tools->profile, LIMIT_VISIBILITY_LEVEL);
    return is_limited || (!look->is_bare && tools->setup->request->visibility.is_asked);
}

static void set_mean(const Profile *profile, ReviewCase *c) {
    const CaseLuminances *l = &c->luminance_cd_m2;
    double veil = profile->uses_veil && !isnan(l->veil) ? l->veil : 0;
    c->whole.contrast_ratio =
        luminance_contrast(l->foreground, l->background, c->whole.reflected + veil);
}

/* Takes the review's reading, in the part that the review judged. No targets: another share of
 * the symbol is seen. */
static ProbeAim take_alike(const CaseTools *tools, const CaseLook *look, const ProbeAim *aim,
                           ReviewCase *c, Arena *arena) {
    const ReviewCase *like = &look->like->of;
    const CaseLuminances *was = &like->luminance_cd_m2;
    CaseLuminances *l = &c->luminance_cd_m2;
    double more = look->within * was->reflected;
    ProbeAim part = worst_part_aim(look->symbol, aim, &like->whole.part, arena);
    if (!part.target_count || like->visible_share != c->visible_share)
        return (ProbeAim){.target_count = 0};
    l->reflected = was->reflected;
    l->mirror = was->mirror;
    l->scattered = was->scattered;
    c->alike_within = look->within;
    c->paths = like->paths;
    c->batches = like->batches;
    c->whole = like->whole;
    c->precision_asked = like->precision_asked;
    c->precision_reached = like->precision_reached;
    set_mean(tools->profile, c);
    set_contrasts(c,
                  (MeanInterval){
                      fmax(l->reflected - hypot(l->reflected - like->reflected_range.low, more), 0),
                      l->reflected + hypot(like->reflected_range.high - l->reflected, more)});
    c->visibility = visibility_of(c, &look->symbol->split);
    if (c->colour_count) symbol_colour_alike(like->colours[0].light, c);
    return part;
}

static void see_stray_light(const CaseTools *tools, const SetupSymbol *symbol, Vec3 eye,
                            ReviewCase *c, Arena *arena) {
    const Setup *setup = tools->setup;
    bool has_levels = c->visibility_count > 0;
    EyeLook look = {eye,
                    vec3_sub(symbol_middle(symbol).position, eye),
                    has_levels ? VISIBILITY_ROUNDS : 1,
                    NULL,
                    has_levels,
                    NULL};
    EyeReading stray = eye_read(setup, &look, *arena);
    c->luminance_cd_m2.veil = stray.veil;
    if (c->colour_count && tools->profile->uses_veil)
        memcpy(c->colours[0].light->veil, (double[3]){stray.beside[0], stray.veil, stray.beside[1]},
               3 * sizeof(double));
    if (has_levels) case_visibility_veils(setup, &look, &stray, c, arena);
    c->veil_displays = stray.parts[EYE_LAMPS] + stray.parts[EYE_GLINTS] + stray.parts[EYE_NEAR];
}

/* ---- until its verdict is clear ---------------------------------------------------------- */

/* A case of which all but the reflected light is known. */
typedef struct VerdictArgs {
    const CaseTools *tools;
    const ReviewCase *of;
    DirectSun direct; /* of the reflected light */
} VerdictArgs;

/* With so much reflected; false: sun or day, which of them is open. */
static bool judge_with(const VerdictArgs *args, double reflected, MeanInterval within,
                       ReviewCase *out, Arena *arena) {
    bool in_sun = is_in_sun(args->direct, within.low);
    *out = *args->of;
    if (in_sun != is_in_sun(args->direct, within.high)) return false;
    out->luminance_cd_m2.reflected = reflected;
    set_contrasts(out, within);
    judge_ambient(out, args->tools->profile, in_sun);
    judge_case(out, args->tools->profile, arena);
    return true;
}

/* Is each limit that counts met, or missed, wherever in the interval the light lies? */
static bool is_verdict_clear(void *user, MeanInterval reflected, Arena scratch) {
    ReviewCase c;
    if (!judge_with(user, 0.5 * (reflected.low + reflected.high), reflected, &c, &scratch))
        return false;
    for (int i = 0; i < c.limit_count; i++)
        if (limit_is_open(&c.limits[i])) return false;
    return true;
}

/* The sun's image in a display is so small that few paths meet it: it is known by itself, but
 * not as a polariser sees it. A variant takes the paths of its review's same case, a sweep's worst
 * or a moment's, or more. */
static Reading read_symbol(const CaseLook *look, const ProbeAim *aim, VerdictArgs *args,
                           Arena scratch) {
    PathContext without = *aim->context;
    ProbeAim rest = *aim;
    const Setup *setup = args->tools->setup;
    const ReviewRequest *request = setup->request;
    const CaseLuminances *shown = &args->of->luminance_cd_m2;
    const Review *review = args->tools->base;
    const ReviewCase *base = review ? review_case_like(review, args->of) : NULL;
    ReadingQuestion question = {is_verdict_clear, args, request->precision_clear};
    ReadingGoal goal = {.brighter = fmax(shown->foreground, shown->background),
                        .darker = fmin(shown->foreground, shown->background),
                        .precision = request->precision_contrast,
                        .most = request->precision_paths,
                        .known = aim->context->eye ? 0 : args->direct.mirror,
                        .times = request->is_compared ? COMPARED_TIMES : 1,
                        .least = base ? base->paths : 0,
                        .question = &question};
    if (args->of->colour_count) { /* which clear contrasts leave open */
        goal.question = NULL;
        goal.least = goal.least > READING_ASKED_LEAST ? goal.least : READING_ASKED_LEAST;
    }
    if (goal.known > 0) memcpy(goal.known_beside, args->direct.beside, sizeof goal.known_beside);
    without.without_mirrored_sun = goal.known > 0;
    rest.context = &without;
    if (look->is_coarse) {
        goal.precision = look->is_open ? COARSE_PRECISION : 0;
        goal.most = look->is_open ? COARSE_PATHS : READING_LEAST;
        goal.times = 1;
        goal.least = 0;
        goal.question = NULL;
    }
    return reading_take(&rest, &goal, &setup->tools, scratch);
}

/* Of the worst part, or of all of the symbol where that is the worse (symbols.h). Sets the
 * case's part and what is direct in its light. */
static Reading read_part(const CaseLook *look, WorstPart *part, ReviewCase *c, VerdictArgs *args,
                         Arena *arena) {
    const Setup *setup = args->tools->setup;
    args->direct = direct_sun(setup, &part->aim, *arena);
    Reading reading = read_symbol(look, &part->aim, args, *arena);
    if (!part->is_all &&
        worst_part_is_better(&part->whole, reading.interval, c->must_not_be_read)) {
        worst_part_take_all(look->symbol, part, arena);
        args->direct = direct_sun(setup, &part->aim, *arena);
        reading = read_symbol(look, &part->aim, args, *arena);
    }
    if (part->is_all && !look->is_coarse) worst_part_set_mean(&part->whole, &reading);
    c->whole = part->whole;
    set_mean(args->tools->profile, c);
    return reading;
}

static void keep_reading(const Reading *reading, const CaseLook *look, ReviewCase *c,
                         Arena *arena) {
    CaseLuminances *l = &c->luminance_cd_m2;
    double *batches = look->is_coarse ? NULL : ARENA_NEW(arena, double, READING_BATCHES);
    if (batches) memcpy(batches, reading->batches, sizeof reading->batches);
    c->paths = reading->paths;
    c->batches = batches;
    c->precision_reached = reading->reached;
    l->reflected = reading->reflected;
    l->mirror = reading->mirror;
    l->scattered = reading->reflected - reading->mirror;
    set_contrasts(c, reading->interval);
    c->visibility = visibility_of(c, &look->symbol->split);
    if (c->colour_count) symbol_colour_read(reading, c);
}

/* *c holds all that does not depend on the eye. The aim has no targets where it is not
 * seen; *direct: of what is reflected. */
static ProbeAim see_symbol(const CaseTools *tools, const CaseLook *look, ReviewCase *c,
                           DirectSun *direct, Arena *arena) {
    const Setup *setup = tools->setup;
    const SetupSymbol *symbol = look->symbol;
    SymbolVisibility seen = symbol_visibility(&symbol->surface, &setup->context, look->eye, NULL);
    c->visible_share = seen.visible_share;
    if (c->visible_share < 1 && !look->is_coarse)
        case_hiders(&symbol->surface, &setup->context, look->eye, c, arena);
    c->height_arcmin = symbol_height_arcmin(&symbol->surface, symbol->split.box, look->eye);
    c->stroke_ratio = symbol_stroke_ratio(symbol);
    if (has_visibility(tools, look))
        case_visibility_start(setup->request, &symbol->split, c, arena);
    if (!case_is_seen(c)) return (ProbeAim){.target_count = 0};
    SymbolLook shown = {&symbol->surface, &symbol->split, look->eye, setup->tools.threads, &seen};
    SymbolEmission emission = symbol_emission(&shown, c->level);
    ProbeAim aim = {.context = &setup->context,
                    .eye = look->eye,
                    .seed = review_seed(setup->request, look->is_coarse ? COARSE_SEED : EYE_SEED)};
    Glasses glasses =
        glasses_worn(setup->condition, vec3_sub(symbol_middle(symbol).position, look->eye), arena);
    symbol_put_on_glasses(&glasses, &shown, &aim, &emission, c, arena);
    c->luminance_cd_m2.foreground = emission.xyz[SYMBOL_FOREGROUND][1];
    c->luminance_cd_m2.background = emission.xyz[SYMBOL_BACKGROUND][1];
    if (look->has_colour && !look->is_coarse) symbol_colour_start(symbol, &emission, c, arena);
    bool wants_veil = !look->is_bare || tools->profile->uses_veil ||
                      profile_has(tools->profile, LIMIT_VISIBILITY_LEVEL);
    if (!look->is_coarse && wants_veil) see_stray_light(tools, symbol, look->eye, c, arena);
    if (look->like) {
        ProbeAim same = take_alike(tools, look, &aim, c, arena);
        *direct = look->like->direct;
        if (same.target_count) return same;
    }
    PartArgs in = {symbol, &aim, look->is_coarse, c->must_not_be_read};
    WorstPart part = worst_part_find(setup, &in, arena);
    VerdictArgs args = {.tools = tools, .of = c};
    Reading reading = read_part(look, &part, c, &args, arena);
    *direct = args.direct;
    keep_reading(&reading, look, c, arena);
    c->precision_asked = !c->colour_count && is_verdict_clear(&args, reading.interval, *arena)
                             ? setup->request->precision_clear
                             : setup->request->precision_contrast;
    return part.aim;
}
