/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/gazes.h"

#include <math.h>

#include "base/units.h"
#include "review/chain/chains.h"
#include "review/eye/eye_reading.h"
#include "review/eye/gaze_reading.h"
#include "review/light/setup_eyes.h"
#include "review/run/cases.h"
#include "review/run/glare_found.h"

#define ROUNDS 16
#define ROUNDS_HALF 2.131450 /* of a 95 % interval, in standard errors of so many rounds' mean:
                                Student's distribution, 15 degrees of freedom */
#define PRECISION 0.01
#define EYE_BYTES ((size_t)1 << 34) /* of address space */
#define PATHS_MOST 131072
#define COARSE_PATHS 4096 /* to find the worst of many points */

/* ---- one eye's point --------------------------------------------------------------------- */

static GazeGoal goal_of(Vec3 eye, const ReviewGaze *gaze, int most)
{
    return (GazeGoal){eye, vec3_from_doubles(gaze->direction), PRECISION, most};
}

/* Light over the view, quickly. */
static double coarse_veil(const Setup *setup, const GazeGoal *goal, Arena scratch)
{
    EyeLook look = {goal->eye, goal->towards, 1, NULL};
    return eye_read(setup, &look, scratch).veil + gaze_read(setup, goal, scratch).mirrored;
}

static Vec3 worst_point(const Setup *setup, const ReviewGaze *gaze, const Vec3 *points,
                        int count, Arena scratch)
{
    int    worst = 0;
    double most = -1;
    for (int i = 0; i < count && count > 1; i++) {
        GazeGoal goal = goal_of(points[i], gaze, COARSE_PATHS);
        double   veil = coarse_veil(setup, &goal, scratch);
        if (veil > most) worst = i;
        most = fmax(most, veil);
    }
    return points[worst];
}

/* ---- figures ----------------------------------------------------------------------------- */

static void name_mirrored(const Setup *setup, const GazeMirrored *most, GazeFinding *out,
                          Arena *arena)
{
    static const char *const SOURCES[LIGHT_SETS] = {"sun", "sky", "a display", "a lamp"};
    if (most->pane_id == NO_ID) return;
    out->mirrored_by = chain_part_words(setup->scene, most->pane_id, arena);
    out->mirrored_from = most->part_id == NO_ID
                             ? SOURCES[most->source]
                             : chain_part_words(setup->scene, most->part_id, arena);
}

static MeanInterval range_of(double mean, double half)
{
    return (MeanInterval){fmax(mean - half, 0), mean + half};
}

/* Standard error of through / all, all = through + veils; the three are read independently. */
static double contrast_sigma(const GazeReading *along, double all, double veil_sigma)
{
    double by_veils = along->through * hypot(along->mirrored_sigma, veil_sigma);
    return hypot((all - along->through) * along->through_sigma, by_veils) / (all * all);
}

static void set_contrasts(const GazeReading *along, double veil_half, GazeFinding *out)
{
    double seen = along->through + along->mirrored;
    double all = seen + out->veil - out->veil_parts.near;
    out->contrast_behind_glass = seen > 0 ? along->through / seen : (double)NAN;
    out->contrast_left = all > 0 ? along->through / all : (double)NAN;
    out->contrast_range = (MeanInterval){(double)NAN, (double)NAN};
    if (!(all > 0)) return;
    double half =
        INTERVAL_SIGMAS * contrast_sigma(along, all, veil_half / INTERVAL_SIGMAS);
    out->contrast_range = (MeanInterval){fmax(out->contrast_left - half, 0),
                                  fmin(out->contrast_left + half, 1)};
}

static double sun_from_gaze(const Setup *setup, Vec3 gaze)
{
    Vec3  towards;
    float bands[LIGHT_BANDS];
    if (!setup_sun(setup, &towards, bands)) return (double)NAN;
    double cosine = (double)vec3_dot(towards, vec3_normalize(gaze));
    return degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
}

/* The sun in mirrors is looked for, if there is a sun. */
static EyeReading read_eye(const Setup *setup, SunSearches *searches, const GazeGoal *goal)
{
    EyeLook   look = {goal->eye, goal->towards, ROUNDS, NULL};
    Arena     scratch = arena_reserve(EYE_BYTES);
    FalseSuns images;
    Vec3      towards;
    float     bands[LIGHT_BANDS];
    if (setup_sun(setup, &towards, bands)) {
        images = false_suns_of(sun_searches_ask(searches, setup, goal->eye), bands, &scratch);
        look.images = &images;
    }
    EyeReading eye = eye_read(setup, &look, scratch);
    arena_release(&scratch);
    return eye;
}

static void read_gaze(const Setup *setup, SunSearches *searches, const GazeGoal *goal,
                      Arena *arena, GazeFinding *out)
{
    EyeReading  eye = read_eye(setup, searches, goal);
    GazeReading along = gaze_read(setup, goal, *arena);
    double      half = ROUNDS_HALF * eye.veil_sigma;
    out->sun_deg = sun_from_gaze(setup, goal->towards);
    out->veil = eye.veil;
    out->veil_range = range_of(eye.veil, half);
    out->veil_parts = (GazeVeil){eye.parts[EYE_SUN], eye.parts[EYE_SKY], eye.parts[EYE_LAMPS],
                                 eye.parts[EYE_GLINTS], eye.parts[EYE_SURFACES],
                                 eye.parts[EYE_NEAR]};
    out->cornea_lux = eye.vertical_lx;
    out->glare = glare_found(&eye.glare, &setup->request->glare);
    out->through = along.through;
    out->mirrored = along.mirrored;
    out->mirrored_range = range_of(along.mirrored, INTERVAL_SIGMAS * along.mirrored_sigma);
    name_mirrored(setup, &along.most, out, arena);
    set_contrasts(&along, half, out);
}

bool setup_gazes(const Setup *setup, const MomentShare *share, SunSearches *searches,
                 Arena *arena, GazeFinding *out, Error *err)
{
    const ReviewRequest *request = setup->request;
    int at = -1, looks = review_look_count(request);
    for (int g = 0; g < request->gaze_count; g++)
        for (int e = 0; e < request->eye_count; e++) {
            const ReviewGaze *gaze = &request->gazes[g];
            const ReviewEye  *eye = &request->eyes[e];
            int count;
            if (gaze->at_symbols || !gaze->for_eye[e]) continue;
            if (!moment_share_has(share, ++at, looks)) continue;
            Vec3 *points = setup_eye_points(setup, eye, &count, arena, err);
            if (!points) return false;
            GazeGoal goal = goal_of(worst_point(setup, gaze, points, count, *arena), gaze,
                                    PATHS_MOST);
            out[at] = (GazeFinding){.condition = setup->condition->name, .eye = eye->name,
                                 .gaze = gaze->name};
            read_gaze(setup, searches, &goal, arena, &out[at]);
        }
    return true;
}
