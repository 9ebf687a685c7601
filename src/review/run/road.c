/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/road.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/count.h"
#include "panel/query/panel_stated.h"
#include "review/chain/chains.h"
#include "review/chain/remedies.h"
#include "vision/road_glare.h"

#define SEED 0x726f6164u
#define TRIES 60        /* halvings */
#define FACTOR_MOST 1e6 /* times today's level: a display that makes next to nothing */

static const double ROAD_DIMMING[] = {0.1, 0.2, 0.3, 0.5, 1, 2};

RoadLeftOut road_left_out(const Setup *setup, const ReviewRoad *road) {
    Vec3 towards;
    if (!review_road_is_in(road, setup->condition->name)) return ROAD_OTHER_TIME;
    return setup_sun(setup, &towards, NULL) ? ROAD_BY_DAY : ROAD_EVALUATED;
}

RoadAges road_ages(const ReviewRequest *request, const ReviewRoad *road, Arena *arena) {
    double *own = ARENA_NEW(arena, double, 1);
    *own = request->observer.age_years;
    return (RoadAges){road->age_count ? road->ages : own, road->age_count ? road->age_count : 1,
                      request->observer.pigment};
}

/* ---- displays ---------------------------------------------------------------------------- */

/* What a display's panel states of itself. */
typedef struct Stated {
    double error; /* of what it emits, relative */
    bool is_unusable;
} Stated;

typedef struct RoadWork {
    const Setup *setup;
    const RoadReading *reading;
    const Stated *stated; /* [display] */
    const int *order;     /* displays that are not dark, the first age's greatest first */
    int count;
    GazeRoad *road;
    Arena *arena;
} RoadWork;

static Stated *displays_stated(const Scene *scene, Arena *arena) {
    Stated *stated = ARENA_NEW(arena, Stated, scene->display_count + 1);
    for (int i = 0; i < scene->display_count; i++) {
        PanelStated of = panel_stated(scene->displays[i].panel, arena);
        stated[i] = (Stated){of.emission_error, of.is_unusable};
    }
    return stated;
}

static void sort_displays(RoadWork *work) {
    const Scene *scene = work->setup->scene;
    int *order = ARENA_NEW(work->arena, int, scene->display_count + 1);
    for (int d = 0; d < scene->display_count; d++) {
        double veil = road_found(work->reading, 0, d).mean;
        int at = work->count;
        if (!(veil > 0)) continue;
        for (; at > 0 && road_found(work->reading, 0, order[at - 1]).mean < veil; at--)
            order[at] = order[at - 1];
        order[at] = d;
        work->count++;
    }
    work->order = order;
}

/* The half of an interval with the panels' stated errors, which are independent of it. */
static double wider(const RoadWork *work, int age, double half, int only) {
    double squares = half * half;
    for (int i = 0; i < work->count; i++) {
        int d = work->order[i];
        double error =
            INTERVAL_SIGMAS * work->stated[d].error * road_found(work->reading, age, d).mean;
        if (only == NO_ID || only == d) squares += error * error;
    }
    return sqrt(squares);
}

/* Of one display; NO_ID: of all that the eye sees. */
static RoadFound found_with_errors(const RoadWork *work, int age, int display) {
    RoadFound f = display == NO_ID ? road_found_whole(work->reading, age)
                                   : road_found(work->reading, age, display);
    f.low = fmax(f.mean - wider(work, age, f.mean - f.low, display), 0);
    f.high = f.mean + wider(work, age, f.high - f.mean, display);
    return f;
}

static void set_ways(const RoadWork *work, int display, RoadDisplay *to) {
    const RoadShares *s = &work->reading->shares[display];
    double all = s->way[ROAD_STRAIGHT] + s->way[ROAD_MIRRORED] + s->way[ROAD_SCATTERED];
    to->straight_share = s->way[ROAD_STRAIGHT] / all;
    to->mirrored_share = s->way[ROAD_MIRRORED] / all;
    to->scattered_share = s->way[ROAD_SCATTERED] / all;
    to->mirrored_by_share = s->mirrored > 0 ? s->mirrored / all : 0;
    if (s->mirrored > 0)
        to->mirrored_by = chain_part_words(work->setup->scene, (int)s->mirror, work->arena);
}

/* ---- levels ------------------------------------------------------------------------------ */

/* A veil that grows with a factor, and the rest, which stays. */
typedef struct RoadGrowth {
    RoadFound rest, grown;
} RoadGrowth;

/* What is beside a display, or several, whose light is sampled independently of it. */
static RoadGrowth growing_of(RoadFound all, RoadFound grown) {
    double low = all.mean - all.low, high = all.high - all.mean;
    double of_low = grown.mean - grown.low, of_high = grown.high - grown.mean;
    double rest = fmax(all.mean - grown.mean, 0);
    return (RoadGrowth){{rest, rest - sqrt(fmax(low * low - of_low * of_low, 0)),
                         rest + sqrt(fmax(high * high - of_high * of_high, 0)), NAN},
                        grown};
}

/* sign: -1 the lower end of its interval, 1 the upper one, 0 the mean. */
static double veil_at(const RoadGrowth *g, double factor, int sign) {
    double mean = g->rest.mean + factor * g->grown.mean;
    double rest = sign < 0 ? g->rest.mean - g->rest.low : g->rest.high - g->rest.mean;
    double own = factor * (sign < 0 ? g->grown.mean - g->grown.low : g->grown.high - g->grown.mean);
    return mean + sign * sqrt(rest * rest + own * own);
}

/* The greatest factor up to FACTOR_MOST that keeps the veil; 0: none does. */
static double factor_for(const RoadGrowth *g, double veil, int sign) {
    double low = 0, high = FACTOR_MOST;
    if (sign == 0) {
        double factor = (veil - g->rest.mean) / g->grown.mean;
        return fmin(fmax(factor, 0), FACTOR_MOST);
    }
    if (veil_at(g, high, sign) <= veil) return high;
    if (veil_at(g, low, sign) > veil) return 0;
    for (int i = 0; i < TRIES; i++) {
        double middle = 0.5 * (low + high);
        *(veil_at(g, middle, sign) <= veil ? &low : &high) = middle;
    }
    return low;
}

typedef struct LevelMost {
    double level;
    MeanInterval range;
} LevelMost;

static LevelMost level_most(const RoadGrowth *g, double level, double veil) {
    return (LevelMost){level * factor_for(g, veil, 0),
                       {level * factor_for(g, veil, 1), level * factor_for(g, veil, -1)}};
}

/* ---- one age ----------------------------------------------------------------------------- */

static MeanInterval increments(RoadFound f, double road) {
    return (MeanInterval){road_threshold_increment(f.low, road),
                          road_threshold_increment(f.high, road)};
}

static RoadDisplay display_of(const RoadWork *work, int age, int d) {
    const Setup *setup = work->setup;
    double road = work->road->luminance_cd_m2;
    RoadFound own = found_with_errors(work, age, d);
    RoadFound all = found_with_errors(work, age, NO_ID);
    const char *name = setup->scene->displays[d].name;
    RoadDisplay out = {.display =
                           arena_string(work->arena, name ? name : "", name ? strlen(name) : 0),
                       .level = (double)setup->scene->displays[d].level,
                       .share = own.mean / all.mean,
                       .increment_pct = road_threshold_increment(own.mean, road),
                       .increment_range = increments(own, road),
                       .level_most = NAN,
                       .level_most_range = {NAN, NAN}};
    set_ways(work, d, &out);
    return out;
}

static RoadAge age_of(const RoadWork *work, int age, double years) {
    double road = work->road->luminance_cd_m2;
    RoadFound all = found_with_errors(work, age, NO_ID);
    RoadAge out = {.age_years = years,
                   .veil = all.mean,
                   .veil_range = {all.low, all.high},
                   .increment_pct = road_threshold_increment(all.mean, road),
                   .increment_range = increments(all, road),
                   .increment_by_spread_pct = road_threshold_increment(all.by_spread, road),
                   .limit = {.value = NAN, .found = NAN, .low = NAN, .high = NAN, .margin = NAN},
                   .displays = ARENA_NEW(work->arena, RoadDisplay, work->count + 1),
                   .display_count = work->count};
    for (int i = 0; i < work->count; i++) out.displays[i] = display_of(work, age, work->order[i]);
    return out;
}

GazeRoad *road_stated(const ReviewRoad *road, RoadLeftOut left_out, Arena *arena) {
    GazeRoad *out = ARENA_NEW(arena, GazeRoad, 1);
    *out = (GazeRoad){.luminance_cd_m2 = road->luminance_cd_m2,
                      .s_p = road->s_p,
                      .mesopic_cd_m2 = road_mesopic_luminance(road->luminance_cd_m2, road->s_p),
                      .left_out = left_out,
                      .without_data_share = NAN};
    return out;
}

static void set_levels(const RoadWork *work, const Profile *profile) {
    double veil = road_veil_of_increment(profile->increment_most_pct, work->road->luminance_cd_m2);
    for (int a = 0; a < work->road->age_count && veil > 0; a++)
        for (int i = 0; i < work->count; i++) {
            RoadDisplay *to = &work->road->ages[a].displays[i];
            RoadGrowth g = growing_of(found_with_errors(work, a, NO_ID),
                                      found_with_errors(work, a, work->order[i]));
            LevelMost most = level_most(&g, to->level, veil);
            to->level_most = most.level;
            to->level_most_range = most.range;
        }
}

GazeRoad *road_of(const Setup *setup, const ReviewRoad *road, const RoadReading *reading,
                  const Profile *profile, Arena *arena) {
    RoadAges ages = road_ages(setup->request, road, arena);
    RoadWork work = {.setup = setup,
                     .reading = reading,
                     .arena = arena,
                     .stated = displays_stated(setup->scene, arena),
                     .road = road_stated(road, ROAD_EVALUATED, arena)};
    sort_displays(&work);
    work.road->without_data_share = *reading->without_data;
    work.road->ages = ARENA_NEW(arena, RoadAge, ages.count);
    work.road->age_count = ages.count;
    for (int a = 0; a < ages.count; a++) work.road->ages[a] = age_of(&work, a, ages.list[a]);
    for (int i = 0; i < work.count; i++)
        if (work.stated[work.order[i]].is_unusable)
            work.road->unusable_share += work.road->ages[0].displays[i].share;
    set_levels(&work, profile);
    return work.road;
}

/* ---- the table of levels ----------------------------------------------------------------- */

/* The increments of a road, as veils on another: an increment is proportional to its veil. */
typedef struct Dimming {
    const Profile *profile;
    const ReviewCase *cases;
    int case_count;
    const GazeFinding *gaze;
    Arena *arena;
} Dimming;

/* Of a display's symbols, as the gaze's eye sees them, what takes the most light. */
static void set_least(const Dimming *dimming, RoadDimming *row) {
    row->level_least = row->level_least_sure = NAN;
    for (int i = 0; i < dimming->case_count; i++) {
        const ReviewCase *c = &dimming->cases[i];
        if (!c->eye || strcmp(c->eye, dimming->gaze->eye) != 0 || !c->display ||
            strcmp(c->display, row->display) != 0 || c->must_not_be_read)
            continue;
        CaseLeast least = case_least_level(dimming->profile, c, *dimming->arena);
        if (isnan(least.sure) || least.sure <= row->level_least_sure) continue;
        row->level_least = least.level;
        row->level_least_sure = least.sure;
        row->symbol = c->symbol;
    }
}

static RoadWindow window_of(const RoadDimming *row) {
    if (isnan(row->level_least) || isnan(row->level_most)) return ROAD_WINDOW_NONE;
    if (row->level_least_sure <= row->level_most_range.low && row->level_most_range.low > 0)
        return ROAD_WINDOW_OPEN;
    return row->level_least > row->level_most_range.high || !(row->level_most_range.high > 0)
               ? ROAD_WINDOW_EMPTY
               : ROAD_WINDOW_CLOSE;
}

static RoadFound veil_of(double mean, MeanInterval range, double road) {
    return (RoadFound){road_veil_of_increment(mean, road), road_veil_of_increment(range.low, road),
                       road_veil_of_increment(range.high, road), NAN};
}

static RoadFound display_veil(const GazeRoad *of, int age, int display) {
    const RoadDisplay *d = &of->ages[age].displays[display];
    return veil_of(d->increment_pct, d->increment_range, of->luminance_cd_m2);
}

static RoadFound all_displays(const GazeRoad *of, int age) {
    RoadFound sum = {0, 0, 0, NAN};
    for (int i = 0; i < of->ages[age].display_count; i++) {
        RoadFound one = display_veil(of, age, i);
        double low = one.mean - one.low, high = one.high - one.mean;
        sum.mean += one.mean;
        sum.low += low * low;
        sum.high += high * high;
    }
    return (RoadFound){sum.mean, sum.mean - sqrt(sum.low), sum.mean + sqrt(sum.high), NAN};
}

/* The factor that all displays need is the greatest of theirs. */
static void set_least_of_all(const RoadDimming *rows, int count, RoadDimming *row) {
    row->level_least = row->level_least_sure = NAN;
    for (int i = 0; i < count; i++) {
        double sure = rows[i].level_least_sure / rows[i].level;
        if (isnan(sure) || sure <= row->level_least_sure) continue;
        row->level_least = rows[i].level_least / rows[i].level;
        row->level_least_sure = sure;
        row->symbol = rows[i].symbol;
    }
}

static void add_rows(const Dimming *dimming, int age, double road_cd_m2, const RoadDimming *least,
                     GazeRoad *to) {
    const RoadAge *of = &to->ages[age];
    double veil = road_veil_of_increment(dimming->profile->increment_most_pct, road_cd_m2);
    RoadFound all = {of->veil, of->veil_range.low, of->veil_range.high, NAN};
    for (int i = 0; i <= of->display_count; i++) {
        bool is_all = i == of->display_count;
        if (is_all && of->display_count < 2) continue;
        RoadDimming row = least[i];
        RoadGrowth g = growing_of(all, is_all ? all_displays(to, age) : display_veil(to, age, i));
        LevelMost most = level_most(&g, row.level, veil);
        row.age_years = of->age_years;
        row.road_cd_m2 = road_cd_m2;
        row.level_most = most.level;
        row.level_most_range = most.range;
        row.window = window_of(&row);
        to->dimming[to->dimming_count++] = row;
    }
}

/* What no road and no age changes: of each display, then of all. */
static RoadDimming *least_of(const Dimming *dimming, const RoadAge *of) {
    RoadDimming *rows = ARENA_NEW(dimming->arena, RoadDimming, of->display_count + 1);
    for (int i = 0; i < of->display_count; i++) {
        rows[i] = (RoadDimming){.display = of->displays[i].display, .level = of->displays[i].level};
        set_least(dimming, &rows[i]);
    }
    rows[of->display_count] = (RoadDimming){.level = 1};
    set_least_of_all(rows, of->display_count, &rows[of->display_count]);
    return rows;
}

/* The request's own road is one of them. */
static int roads_of(const ReviewRoad *road, double *out) {
    const double *list = road->dimming_count ? road->dimming : ROAD_DIMMING;
    int count = road->dimming_count ? road->dimming_count : COUNT_OF(ROAD_DIMMING), used = 0;
    bool has_own = false;
    for (int i = 0; i < count; i++) {
        if (!has_own && list[i] >= road->luminance_cd_m2) {
            has_own = true;
            if (list[i] > road->luminance_cd_m2) out[used++] = road->luminance_cd_m2;
        }
        out[used++] = list[i];
    }
    if (!has_own) out[used++] = road->luminance_cd_m2;
    return used;
}

void road_dim(const ReviewRoad *road, const Profile *profile, const ReviewCase *cases,
              int case_count, GazeFinding *gaze, Arena *arena) {
    GazeRoad *to = gaze->road;
    double roads[ROAD_DIMMING_MOST + 1];
    Dimming dimming = {profile, cases, case_count, gaze, arena};
    if (!to || !road_has_limit(to)) return;
    int count = roads_of(road, roads), displays = to->ages[0].display_count;
    RoadDimming *least = least_of(&dimming, &to->ages[0]);
    to->dimming = ARENA_NEW(arena, RoadDimming, to->age_count * count * (displays + 1));
    for (int a = 0; a < to->age_count; a++)
        for (int r = 0; r < count; r++) add_rows(&dimming, a, roads[r], least, to);
}
