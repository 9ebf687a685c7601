/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/gazes.h"

#include <math.h>

#include "base/units.h"
#include "review/chain/chains.h"
#include "review/eye/eye_reading.h"
#include "review/eye/gaze_reading.h"
#include "review/judge.h"
#include "review/light/setup.h"
#include "review/run/cases.h"
#include "review/run/road.h"

#define ROUNDS 16
#define PRECISION 0.01
#define EYE_BYTES ((size_t)1 << 34) /* of address space */
#define PATHS_MOST 131072
#define COARSE_PATHS 4096 /* to find the worst of many points */

/* ---- one eye's point --------------------------------------------------------------------- */

static GazeGoal goal_of(Vec3 eye, const ReviewGaze *gaze, int most) {
    return (GazeGoal){eye, vec3_from_doubles(gaze->direction), PRECISION, most};
}

/* Light over the view, quickly. */
static double coarse_veil(const Setup *setup, const GazeGoal *goal, Arena scratch) {
    EyeLook look = {goal->eye, goal->towards, 1, NULL, false, NULL};
    return eye_read(setup, &look, scratch).veil + gaze_read(setup, goal, scratch).mirrored.mean;
}

static Vec3 worst_point(const Setup *setup, const ReviewGaze *gaze, const Vec3 *points, int count,
                        Arena scratch) {
    int worst = 0;
    double most = -1;
    for (int i = 0; i < count && count > 1; i++) {
        GazeGoal goal = goal_of(points[i], gaze, COARSE_PATHS);
        double veil = coarse_veil(setup, &goal, scratch);
        if (veil > most) worst = i;
        most = fmax(most, veil);
    }
    return points[worst];
}

/* ---- figures ----------------------------------------------------------------------------- */

static void name_mirrored(const Setup *setup, const GazeMirrored *most, GazeFinding *out,
                          Arena *arena) {
    static const char *const SOURCES[LIGHT_SETS] = {"sun", "sky", "a display", "a lamp"};
    if (most->pane_id == NO_ID) return;
    out->mirrored_by = chain_part_words(setup->scene, most->pane_id, arena);
    out->mirrored_from = most->part_id == NO_ID
                             ? SOURCES[most->source]
                             : chain_part_words(setup->scene, most->part_id, arena);
}

/* Of its own light, and of what lies over that. */
static double contrast_left(const double *at, const void *user) {
    (void)user;
    return at[0] + at[1] > 0 ? at[0] / (at[0] + at[1]) : (double)NAN;
}

/* Of a sum of two that are read independently; from 0 on. */
static MeanInterval sum_range(double a, MeanInterval of_a, double b, MeanInterval of_b) {
    return (MeanInterval){fmax(a + b - hypot(a - of_a.low, b - of_b.low), 0),
                          a + b + hypot(of_a.high - a, of_b.high - b)};
}

static void set_contrasts(const GazeReading *along, GazeFinding *out) {
    double own = along->through.mean, mirrored = along->mirrored.mean, near = out->veil_parts.near;
    double veil = out->veil - near;
    MeanInterval of_own = along->through.interval;
    MeanInterval of_veil = {out->veil_range.low - near, out->veil_range.high - near};
    MeanInterval over = sum_range(mirrored, along->mirrored.interval, veil, of_veil);
    const IntervalInput in[2] = {{own, of_own.low, of_own.high},
                                 {mirrored + veil, over.high, over.low}};
    FigureInterval range = interval_of(contrast_left, NULL, in, 2);
    out->contrast_behind_glass = contrast_left((double[2]){own, mirrored}, NULL);
    out->contrast_left = contrast_left((double[2]){own, mirrored + veil}, NULL);
    out->contrast_range = (MeanInterval){(double)NAN, (double)NAN};
    if (!isnan(out->contrast_left))
        out->contrast_range = (MeanInterval){fmax(range.low, 0), fmin(range.high, 1)};
}

static double sun_from_gaze(const Setup *setup, Vec3 gaze) {
    Vec3 towards;
    if (!setup_sun(setup, &towards, NULL)) return (double)NAN;
    double cosine = (double)vec3_dot(towards, vec3_normalize(gaze));
    return degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
}

/* The sun in mirrors is looked for, if there is a sun. ages: of a road, or NULL. */
static EyeReading read_eye(const Setup *setup, SunSearches *searches, const GazeGoal *goal,
                           const RoadAges *ages, RoadReading *road) {
    EyeLook look = {goal->eye, goal->towards, ROUNDS, NULL, false, NULL};
    Arena scratch = arena_reserve(EYE_BYTES);
    FalseSuns images;
    Vec3 towards;
    float bands[LIGHT_BANDS];
    if (setup_sun(setup, &towards, bands)) {
        images = false_suns_of(sun_searches_find(searches, setup, goal->eye), bands, &scratch);
        look.images = &images;
    }
    if (road) look.road = road_veils_start(setup->scene, ages, &scratch);
    EyeReading eye = eye_read(setup, &look, scratch);
    if (road) road_veils_read(look.road, road);
    arena_release(&scratch);
    return eye;
}

/* One gaze. */
typedef struct GazeArgs {
    const Setup *setup;
    SunSearches *searches;
    const ReviewGaze *gaze;
    const Profile *profile;
} GazeArgs;

static EyeReading read_light(const GazeArgs *args, const GazeGoal *goal, Arena *arena,
                             GazeFinding *out) {
    const Setup *setup = args->setup;
    const ReviewRoad *road = args->gaze->road;
    RoadLeftOut left_out = road ? road_left_out(setup, road) : ROAD_EVALUATED;
    if (!road || left_out) {
        if (road) out->road = road_stated(road, left_out, arena);
        return read_eye(setup, args->searches, goal, NULL, NULL);
    }
    RoadAges ages = road_ages(setup->request, road, arena);
    RoadReading reading = road_reading_start(ages.count, setup->scene->display_count, arena);
    EyeReading eye = read_eye(setup, args->searches, goal, &ages, &reading);
    out->road = road_of(setup, road, &reading, args->profile, arena);
    return eye;
}

static void read_gaze(const GazeArgs *args, const GazeGoal *goal, Arena *arena, GazeFinding *out) {
    const Setup *setup = args->setup;
    EyeReading eye = read_light(args, goal, arena, out);
    GazeReading along = gaze_read(setup, goal, *arena);
    out->sun_deg = sun_from_gaze(setup, goal->towards);
    out->veil = eye.veil;
    out->veil_range = eye.veil_range;
    out->veil_parts =
        (GazeVeil){eye.parts[EYE_SUN],    eye.parts[EYE_SKY],      eye.parts[EYE_LAMPS],
                   eye.parts[EYE_GLINTS], eye.parts[EYE_SURFACES], eye.parts[EYE_NEAR]};
    out->cornea_lux = eye.vertical_lx;
    out->through = along.through.mean;
    out->mirrored = along.mirrored.mean;
    out->mirrored_range = along.mirrored.interval;
    name_mirrored(setup, &along.most, out, arena);
    set_contrasts(&along, out);
}

/* A sweep's name must be among the road's own conditions. */
static bool is_in_sweep(const ReviewGaze *gaze, const ReviewCondition *condition) {
    return gaze->road && gaze->road->condition_count &&
           review_road_is_in(gaze->road, condition->name);
}

bool sweep_has_roads(const ReviewRequest *request, const ReviewCondition *condition) {
    for (int g = 0; g < request->gaze_count; g++)
        if (is_in_sweep(&request->gazes[g], condition)) return true;
    return false;
}

static bool is_wanted(const Setup *setup, const ReviewGaze *gaze) {
    if (setup->condition->kind != CONDITION_MOMENT) return is_in_sweep(gaze, setup->condition);
    return gaze->road && !road_left_out(setup, gaze->road);
}

static bool add_gaze(const GazesArgs *gazes, int gaze_id, int eye_id, Arena *arena, Review *review,
                     Error *err) {
    const Setup *setup = gazes->setup;
    const ReviewGaze *gaze = &setup->request->gazes[gaze_id];
    const ReviewEye *eye = &setup->request->eyes[eye_id];
    int count;
    Vec3 *points = setup_eye_points(setup, eye, &count, arena, err);
    if (!points) return false;
    GazeGoal goal = goal_of(worst_point(setup, gaze, points, count, *arena), gaze, PATHS_MOST);
    GazeFinding *out = &review->gazes[review->gaze_count++];
    *out = (GazeFinding){.condition = setup->condition->name, .eye = eye->name, .gaze = gaze->name};
    GazeArgs args = {setup, gazes->searches, gaze, gazes->profile};
    read_gaze(&args, &goal, arena, out);
    judge_gaze(out, gazes->profile, arena);
    if (gaze->road)
        road_dim(gaze->road, gazes->profile, gazes->cases, gazes->case_count, out, arena);
    return true;
}

bool setup_gazes(const GazesArgs *gazes, Arena *arena, Review *review, Error *err) {
    const ReviewRequest *request = gazes->setup->request;
    for (int g = 0; g < request->gaze_count; g++) {
        if (gazes->roads_only && !is_wanted(gazes->setup, &request->gazes[g])) continue;
        for (int e = 0; e < request->eye_count; e++)
            if (review_is_look(&request->gazes[g], e) && !add_gaze(gazes, g, e, arena, review, err))
                return false;
    }
    return true;
}
