/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/false_sun_times.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "base/units.h"
#include "review/chain/chains.h"
#include "review/judge.h"
#include "vision/eye_spread.h"

#define STEP_MINUTES 1
#define STEP_DEG 0.25

/* ---- where an eye looks ------------------------------------------------------------------ */

typedef struct Gaze {
    const char *name;
    Vec3 direction; /* unit, world */
} Gaze;

typedef struct Gazes {
    Gaze *list;
    int count;
} Gazes;

static void add_symbols(const Sweep *sweep, int eye_id, Gazes *to) {
    for (int i = 0; i < sweep->symbol_count; i++) {
        const Sight *sight = &sweep->sights[eye_id * sweep->symbol_count + i];
        Vec3 middle = symbol_middle(sight->symbol).position;
        to->list[to->count++] =
            (Gaze){sight->symbol->name, vec3_normalize(vec3_sub(middle, sight->from))};
    }
}

static Gazes gazes_of(const Sweep *sweep, int eye_id, Arena *arena) {
    const ReviewRequest *request = sweep->run->request;
    Gazes gazes = {ARENA_NEW(arena, Gaze, sweep->symbol_count + request->gaze_count), 0};
    add_symbols(sweep, eye_id, &gazes);
    for (int i = 0; i < request->gaze_count; i++) {
        const ReviewGaze *gaze = &request->gazes[i];
        if (review_is_look(gaze, eye_id))
            gazes.list[gazes.count++] = (Gaze){gaze->name, vec3_from_doubles(gaze->direction)};
    }
    return gazes;
}

/* ---- one sun ----------------------------------------------------------------------------- */

typedef struct Veil {
    double cd_m2, angle_deg;
    int gaze_id;
} Veil;

/* The worst that a source does to any gaze. */
static Veil worst_veil(const Gazes *gazes, HumanEye whose, Vec3 seen, double lux) {
    Veil worst = {0, 0, NO_ID};
    for (int i = 0; i < gazes->count; i++) {
        double cosine = (double)vec3_dot(gazes->list[i].direction, seen);
        double angle = degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
        if (!(cosine > 0)) continue;
        double veil =
            lux * cosine * eye_spread_at(fmin(fmax(angle, FALSE_SUN_NEAR_DEG), 90), whose);
        if (veil > worst.cd_m2) worst = (Veil){veil, angle, i};
    }
    return worst;
}

/* The sun in one mirror as one eye sees it. */
typedef struct Tally {
    int part_id;
    double minutes, suns, longest;
    double run;   /* minutes at a stretch so far, */
    int run_step; /* up to this step */
    double run_heading;
    Veil worst;
    double lux;
    SweepSun sun; /* of the worst */
} Tally;

#define TALLIES 256

typedef struct Tallies {
    Tally list[TALLIES];
    int count;
    double minutes, suns; /* that were tested */
} Tallies;

static Tally *tally_of(Tallies *all, int part_id) {
    for (int i = 0; i < all->count; i++)
        if (all->list[i].part_id == part_id) return &all->list[i];
    if (all->count == TALLIES) return NULL;
    all->list[all->count] = (Tally){.part_id = part_id, .run_step = -2};
    return &all->list[all->count++];
}

static void add_run(Tally *tally, const SweepSun *sun) {
    bool follows = tally->run_step + 1 == sun->step && tally->run_heading == sun->heading_deg;
    tally->run = (follows ? tally->run : 0) + sun->minutes;
    tally->run_step = sun->step;
    tally->run_heading = sun->heading_deg;
    tally->longest = fmax(tally->longest, tally->run);
}

typedef struct Watch {
    const Sweep *sweep;
    const FalseSuns *images;
    Gazes gazes;
    HumanEye whose;
    Tallies *tallies;
} Watch;

static void watch_sun(const Watch *watch, const SweepSun *sun) {
    const Setup *setup = watch->sweep->setup;
    SunAngles angles = {sun->azimuth_deg, sun->elevation_deg};
    float bands[LIGHT_BANDS];
    double lux = 0;
    watch->tallies->minutes += sun->minutes;
    watch->tallies->suns++;
    if (sun->elevation_deg < -SUN_MEAN_RADIUS_DEG) return;
    FalseSunSight sight = false_suns_at(watch->images, setup_direction(setup, angles));
    if (!(sight.share > 0)) return;
    sky_table_sun(&watch->sweep->table, sun->elevation_deg, sun->light, bands);
    for (int b = 0; b < LIGHT_BANDS; b++) lux += (double)bands[b];
    Veil veil = worst_veil(&watch->gazes, watch->whose, sight.seen, sight.share * lux);
    Tally *tally =
        veil.cd_m2 >= FALSE_SUN_VEIL_CD_M2 ? tally_of(watch->tallies, sight.part_id) : NULL;
    if (!tally) return;
    tally->minutes += sun->minutes;
    tally->suns++;
    add_run(tally, sun);
    if (veil.cd_m2 <= tally->worst.cd_m2) return;
    tally->worst = veil;
    tally->lux = sight.share * lux;
    tally->sun = *sun;
}

/* ---- all suns ---------------------------------------------------------------------------- */

static void narrow(ReviewRange *range) {
    int parts = (int)ceil(range->step / STEP_DEG);
    if (range->count < 2 || parts < 2) return;
    range->count = (range->count - 1) * parts + 1;
    range->step /= parts;
}

/* The same sweep in smaller steps, of the first heading alone: the sun's way is the same. */
static SweepSuns closer_suns(const ReviewCondition *condition, int threads, Arena *arena) {
    ReviewCondition closer = *condition;
    if (condition->kind == CONDITION_YEAR_SWEEP) {
        closer.step_minutes = fmin(STEP_MINUTES, condition->step_minutes);
        closer.heading_count = 1;
    }
    narrow(&closer.azimuth_deg);
    narrow(&closer.elevation_deg);
    return sweep_suns(&closer, threads, arena);
}

static void watch_heading(const Watch *watch, const SweepSuns *suns, const double *heading_deg) {
    for (int i = 0; i < suns->count; i++) {
        SweepSun sun = suns->list[i];
        if (heading_deg) {
            sun.heading_deg = *heading_deg;
            sun.azimuth_deg = fmod(sun.compass_deg - *heading_deg + 720, 360);
        }
        watch_sun(watch, &sun);
    }
}

static void watch_all(const Watch *watch, const SweepSuns *suns) {
    const ReviewCondition *condition = watch->sweep->setup->condition;
    if (condition->kind != CONDITION_YEAR_SWEEP) watch_heading(watch, suns, NULL);
    else
        for (int h = 0; h < condition->heading_count; h++)
            watch_heading(watch, suns, &condition->headings_deg[h]);
}

/* ---- results ----------------------------------------------------------------------------- */

static int by_veil(const void *a, const void *b) {
    const Tally *x = a, *y = b;
    if (x->worst.cd_m2 != y->worst.cd_m2) return x->worst.cd_m2 > y->worst.cd_m2 ? -1 : 1;
    return x->part_id - y->part_id;
}

static ReviewFalseSun listed(const Watch *watch, const Tally *tally, const SweepSuns *suns,
                             Arena *arena) {
    const Setup *setup = watch->sweep->setup;
    bool timed = suns->has_time;
    double all = timed ? watch->tallies->minutes : watch->tallies->suns;
    return (ReviewFalseSun){
        .condition = setup->condition->name,
        .mirror = chain_part_words(setup->scene, tally->part_id, arena),
        .share = (timed ? tally->minutes : tally->suns) / all,
        .minutes = timed ? tally->minutes : (double)NAN,
        .longest_minutes = timed ? tally->longest : (double)NAN,
        .when = sweep_suns_when(setup->condition, suns, &tally->sun, arena),
        .sun_azimuth_deg = fmod(tally->sun.azimuth_deg + 360, 360),
        .sun_elevation_deg = tally->sun.elevation_deg,
        .lux = tally->lux,
        .gaze = arena_format(arena, "%s", watch->gazes.list[tally->worst.gaze_id].name),
        .angle_deg = tally->worst.angle_deg,
        .veil_cd_m2 = tally->worst.cd_m2};
}

static void report(const Watch *watch, const ReviewEye *eye, const SweepSuns *suns, Arena *arena,
                   Review *out) {
    Tallies *all = watch->tallies;
    qsort(all->list, (size_t)all->count, sizeof *all->list, by_veil);
    for (int i = 0; i < all->count && i < FALSE_SUNS_LISTED; i++) {
        out->false_suns[out->false_sun_count] = listed(watch, &all->list[i], suns, arena);
        judge_false_sun(&out->false_suns[out->false_sun_count], watch->sweep->run->profile, arena);
        out->false_suns[out->false_sun_count++].eye = eye->name;
    }
}

/* Every eye watches the same suns, each for itself. */
typedef struct Watching {
    Watch *eyes;
    const SweepSuns *suns;
} Watching;

static void watch_eye(void *context, int eye, int worker) {
    const Watching *watching = context;
    (void)worker;
    watch_all(&watching->eyes[eye], watching->suns);
}

void false_sun_times(const Sweep *sweep, Arena scratch, Arena *arena, Review *out) {
    const ReviewRequest *request = sweep->run->request;
    SweepSuns suns = closer_suns(sweep->setup->condition, sweep->run->means.threads, &scratch);
    Watching watching = {ARENA_NEW(&scratch, Watch, request->eye_count), &suns};
    for (int e = 0; e < request->eye_count; e++)
        watching.eyes[e] = (Watch){sweep, &sweep->false_suns[e], gazes_of(sweep, e, &scratch),
                                   request->observer, ARENA_NEW(&scratch, Tallies, 1)};
    parallel_for(sweep->run->means.threads, request->eye_count, watch_eye, &watching);
    for (int e = 0; e < request->eye_count; e++)
        report(&watching.eyes[e], &request->eyes[e], &suns, arena, out);
}
