#include "review/light/eye_reading.h"

#include <math.h>

#include "base/parallel.h"
#include "base/units.h"
#include "review/light/response.h"
#include "vision/disability_glare.h"
#include "vision/discomfort.h"
#include "vision/position_index.h"

#define PATHS 4096
#define CHUNK 64
#define SEED 0x7665696cu
#define SUN_PATHS 16
#define FROM_DEG DISABILITY_GLARE_MIN_DEG
#define TO_DEG 89.9
#define SUN_RADIUS_DEG 0.26645
#define WITHIN_SUN_DEG 0.3 /* such a direction would meet the disc */

/* Angles are drawn evenly in their logarithm, as f cos theta sin theta, about 1 / theta, asks;
 * Hammersley's points. */
typedef struct EyePaths {
    const Stage *stage;
    ProbeAim     aim;
    Vec3         gaze, right, up; /* unit: the head's axes */
    HumanEye     whose;
    Vec3        *targets;         /* one a path; the rest likewise: */
    double      *solid_angles;    /* sr that it stands for */
    double      *luminances;      /* cd m^-2 that it found, without the sun's disc */
    Vec3         sun;
    bool         has_sun;
} EyePaths;

static Vec3 local_direction(double theta, double phi)
{
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                (float)cos(theta));
}

static void aim_path(EyePaths *paths, const Frame *gaze, int i)
{
    double range = log(TO_DEG / FROM_DEG), u = (i + 0.5) / PATHS;
    double theta = radians_from_degrees(FROM_DEG * exp(range * u));
    double phi = 2 * PI * reverse_bits((uint32_t)i) * 0x1p-32;
    Vec3   d = frame_to_world(gaze, local_direction(theta, phi));
    paths->targets[i] = vec3_add(paths->aim.eye, d);
    paths->solid_angles[i] = sin(theta) * theta * range * 2 * PI / PATHS;
}

static Vec3 direction_of(const EyePaths *paths, int i)
{
    return vec3_normalize(vec3_sub(paths->targets[i], paths->aim.eye));
}

static double degrees_between(Vec3 a, Vec3 b)
{
    return degrees_from_radians(acos(fmin(fmax((double)vec3_dot(a, b), -1), 1)));
}

static void read_chunk(void *user, int item, int worker)
{
    (void)worker;
    EyePaths      *paths = user;
    PathStatistics statistics = {0};
    ProbeLook      looks[CHUNK];
    int            first = item * CHUNK;
    paths->stage->tools.kernel->look(&paths->aim, first, first + CHUNK, looks, &statistics);
    for (int i = 0; i < CHUNK; i++) {
        bool is_sun = paths->has_sun && looks[i].is_far &&
                      degrees_between(direction_of(paths, first + i), paths->sun) <
                          WITHIN_SUN_DEG;
        paths->luminances[first + i] = is_sun ? 0 : (double)looks[i].seen[1];
    }
}

/* Illuminance of the pupil by the disc itself. */
static double lux_of_sun(const EyePaths *paths, Arena scratch)
{
    const Stage *stage = paths->stage;
    Vec3  towards;
    float bands[LIGHT_BANDS];
    double lux = 0;
    if (!stage_sun(stage, &towards, bands) || vec3_dot(towards, paths->gaze) <= 0) return 0;
    LitPoint        pupil = {paths->aim.eye, paths->gaze, false};
    ProbeAim        aim = {.context = &stage->context, .meter = &pupil, .seed = SEED};
    ProbeSuns       suns = {&towards, 1, 0.99999f, false};
    ResponseOptions options = {stage->tools.kernel, 0, SUN_PATHS, stage->tools.threads, 0};
    const float    *shares = response_suns(&aim, &options, &suns, &scratch);
    for (int b = 0; b < LIGHT_BANDS; b++) lux += (double)shares[b] * (double)bands[b];
    return lux;
}

/* ---- figures ----------------------------------------------------------------------------- */

static double position_of(const EyePaths *paths, Vec3 d)
{
    return position_index((double)vec3_dot(d, paths->right), (double)vec3_dot(d, paths->up),
                          (double)vec3_dot(d, paths->gaze));
}

typedef struct EyeSums {
    EyeReading   reading;
    GlareSource *sources;
    int          count;
    double       source_lx;
} EyeSums;

static void add_light(const EyePaths *paths, Vec3 d, double luminance, double solid_angle,
                      EyeSums *sums)
{
    double cosine = (double)vec3_dot(d, paths->gaze);
    double lux = luminance * solid_angle * cosine;
    double degrees = fmax(degrees_between(d, paths->gaze), FROM_DEG);
    sums->reading.vertical_lx += lux;
    sums->reading.veil += lux * disability_glare(degrees, paths->whose);
    if (luminance <= EYE_GLARE_CD_M2) return;
    sums->source_lx += lux;
    sums->sources[sums->count++] =
        (GlareSource){luminance, solid_angle, position_of(paths, d), 0};
}

static EyeReading sum_up(const EyePaths *paths, double sun_lx, Arena scratch)
{
    EyeSums sums = {.sources = ARENA_NEW(&scratch, GlareSource, PATHS + 1)};
    for (int i = 0; i < PATHS; i++)
        add_light(paths, direction_of(paths, i), paths->luminances[i], paths->solid_angles[i],
                  &sums);
    if (sun_lx > 0) {
        double sine = sin(radians_from_degrees(SUN_RADIUS_DEG)), disc = PI * sine * sine;
        double cosine = (double)vec3_dot(paths->sun, paths->gaze);
        add_light(paths, paths->sun, sun_lx / (disc * cosine), disc, &sums);
    }
    EyeReading *r = &sums.reading;
    double      background = (r->vertical_lx - sums.source_lx) / PI;
    r->dgp = discomfort_dgp(r->vertical_lx, sums.sources, sums.count) *
             discomfort_dgp_low_light(r->vertical_lx);
    r->ugr = sums.count ? discomfort_ugr(background, sums.sources, sums.count) : (double)NAN;
    return *r;
}

EyeReading eye_read(const Stage *stage, Vec3 eye, Vec3 at, Arena scratch)
{
    const ReviewObserver *observer = &stage->request->observer;
    float    bands[LIGHT_BANDS];
    EyePaths paths = {.stage = stage, .gaze = vec3_normalize(vec3_sub(at, eye)),
                      .whose = {observer->age_years, observer->pigment},
                      .targets = ARENA_NEW(&scratch, Vec3, PATHS),
                      .solid_angles = ARENA_NEW(&scratch, double, PATHS),
                      .luminances = ARENA_NEW(&scratch, double, PATHS)};
    Frame    frame = frame_from_z(paths.gaze);
    paths.right = vec3_normalize(vec3_cross(paths.gaze, vec3(0, 1, 0)));
    paths.up = vec3_cross(paths.right, paths.gaze);
    paths.aim = (ProbeAim){.context = &stage->context, .eye = eye, .targets = paths.targets,
                           .target_count = PATHS, .seed = SEED};
    paths.has_sun = stage_sun(stage, &paths.sun, bands);
    for (int i = 0; i < PATHS; i++) aim_path(&paths, &frame, i);
    parallel_for(stage->tools.threads, PATHS / CHUNK, read_chunk, &paths);
    return sum_up(&paths, lux_of_sun(&paths, scratch), scratch);
}
