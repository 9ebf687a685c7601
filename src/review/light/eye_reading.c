#include "review/light/eye_reading.h"

#include <math.h>

#include "base/parallel.h"
#include "base/units.h"
#include "vision/disability_glare.h"
#include "vision/discomfort.h"
#include "vision/position_index.h"

#define PATHS 4096
#define CHUNK 64
#define SEED 0x7665696cu
#define FROM_DEG DISABILITY_GLARE_MIN_DEG
#define TO_DEG 89.9

/* Angles are drawn evenly in their logarithm, as f cos theta sin theta, about 1 / theta, asks;
 * Hammersley's points. */
typedef struct EyePaths {
    const Stage *stage;
    ProbeAim     aim;
    Vec3         gaze, right, up; /* unit: the head's axes */
    HumanEye     whose;
    Vec3        *targets;         /* one a path; the rest likewise: */
    double      *solid_angles;    /* sr that it stands for */
    double      *seen;            /* cd m^-2 that it found, without the sun's disc; */
    double      *apart;           /* of it, what light samples do not read */
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

/* What one path hears. The veil of lamps, displays and the sun that the eye sees by themselves
 * is read by light samples, which find small ones too. */
typedef struct EyePath {
    double seen;  /* cd m^-2, without the sun's disc */
    double apart; /* of it, what light samples do not read */
} EyePath;

static void hear_path(void *user, const PathTale *tale, const float xyz[3])
{
    EyePath *path = user;
    bool     is_direct = tale->count == 0;
    if (is_direct && tale->source == LIGHTS_SUN) return;
    path->seen += (double)xyz[1];
    if (!is_direct || tale->source == LIGHTS_SKY) path->apart += (double)xyz[1];
}

static void read_chunk(void *user, int item, int worker)
{
    (void)worker;
    EyePaths      *paths = user;
    PathStatistics statistics = {0};
    for (int i = item * CHUNK; i < (item + 1) * CHUNK; i++) {
        EyePath      path = {0, 0};
        PathListener listener = {hear_path, &path};
        paths->stage->tools.kernel->hear(&paths->aim, i, i + 1, &listener, &statistics);
        paths->seen[i] = path.seen;
        paths->apart[i] = path.apart;
    }
}

/* ---- what is seen by itself -------------------------------------------------------------- */

/* Sums over the pupil's light samples. */
typedef struct PupilSums {
    const EyePaths *paths;
    double          veil, sun_lx;
} PupilSums;

static double veil_of(const EyePaths *paths, Vec3 towards, double lux)
{
    double degrees = degrees_between(towards, paths->gaze);
    return degrees >= FROM_DEG ? lux * disability_glare(degrees, paths->whose) : 0;
}

static void hear_pupil(void *user, const PathTale *tale, const float xyz[3])
{
    PupilSums *sums = user;
    if (tale->count || tale->source == LIGHTS_SKY) return;
    sums->veil += veil_of(sums->paths, tale->towards, (double)xyz[1]);
    if (tale->source == LIGHTS_SUN) sums->sun_lx += (double)xyz[1];
}

typedef struct PupilWork {
    ProbeAim   aim;
    const EyePaths *paths;
    PupilSums *sums; /* one a chunk */
} PupilWork;

static void read_pupil_chunk(void *user, int item, int worker)
{
    (void)worker;
    PupilWork     *work = user;
    PathStatistics statistics = {0};
    PathListener   listener = {hear_pupil, &work->sums[item]};
    work->sums[item] = (PupilSums){.paths = work->paths};
    work->paths->stage->tools.kernel->hear(&work->aim, item * CHUNK, (item + 1) * CHUNK,
                                           &listener, &statistics);
}

/* Lamps, displays and the sun's disc: light samples alone find them here. */
static PupilSums read_pupil(const EyePaths *paths, Arena scratch)
{
    LitPoint    pupil = {paths->aim.eye, paths->gaze, false};
    PathContext lights_only = paths->stage->context;
    PupilWork   work = {{.context = &lights_only, .meter = &pupil, .seed = SEED + 1}, paths,
                        ARENA_NEW(&scratch, PupilSums, PATHS / CHUNK)};
    PupilSums   all = {.paths = paths};
    lights_only.strategy = PATH_LIGHTS_ONLY;
    lights_only.max_bounces = 1;
    parallel_for(paths->stage->tools.threads, PATHS / CHUNK, read_pupil_chunk, &work);
    for (int i = 0; i < PATHS / CHUNK; i++) {
        all.veil += work.sums[i].veil / PATHS;
        all.sun_lx += work.sums[i].sun_lx / PATHS;
    }
    return all;
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

static void add_source(const EyePaths *paths, Vec3 d, double luminance, double solid_angle,
                       EyeSums *sums)
{
    double lux = luminance * solid_angle * (double)vec3_dot(d, paths->gaze);
    sums->reading.vertical_lx += lux;
    if (luminance <= EYE_GLARE_CD_M2) return;
    sums->source_lx += lux;
    sums->sources[sums->count++] =
        (GlareSource){luminance, solid_angle, position_of(paths, d), 0};
}

static void add_path(const EyePaths *paths, int i, EyeSums *sums)
{
    Vec3   d = direction_of(paths, i);
    double weight = paths->solid_angles[i] * (double)vec3_dot(d, paths->gaze);
    add_source(paths, d, paths->seen[i], paths->solid_angles[i], sums);
    sums->reading.veil += veil_of(paths, d, paths->apart[i] * weight);
}

static EyeReading sum_up(const EyePaths *paths, const PupilSums *pupil, Arena scratch)
{
    EyeSums sums = {.sources = ARENA_NEW(&scratch, GlareSource, PATHS + 1)};
    Vec3    towards;
    float   bands[LIGHT_BANDS];
    for (int i = 0; i < PATHS; i++) add_path(paths, i, &sums);
    if (pupil->sun_lx > 0 && stage_sun(paths->stage, &towards, bands)) {
        double sine = sin(radians_from_degrees(SUN_MEAN_RADIUS_DEG)), disc = PI * sine * sine;
        double cosine = (double)vec3_dot(towards, paths->gaze);
        add_source(paths, towards, pupil->sun_lx / (disc * cosine), disc, &sums);
    }
    EyeReading *r = &sums.reading;
    double      background = (r->vertical_lx - sums.source_lx) / PI;
    r->veil += pupil->veil;
    r->dgp = discomfort_dgp(r->vertical_lx, sums.sources, sums.count) *
             discomfort_dgp_low_light(r->vertical_lx);
    r->ugr = sums.count ? discomfort_ugr(background, sums.sources, sums.count) : (double)NAN;
    return *r;
}

EyeReading eye_read(const Stage *stage, Vec3 eye, Vec3 at, Arena scratch)
{
    const ReviewObserver *observer = &stage->request->observer;
    EyePaths paths = {.stage = stage, .gaze = vec3_normalize(vec3_sub(at, eye)),
                      .whose = {observer->age_years, observer->pigment},
                      .targets = ARENA_NEW(&scratch, Vec3, PATHS),
                      .solid_angles = ARENA_NEW(&scratch, double, PATHS),
                      .seen = ARENA_NEW(&scratch, double, PATHS),
                      .apart = ARENA_NEW(&scratch, double, PATHS)};
    Frame    frame = frame_from_z(paths.gaze);
    paths.right = vec3_normalize(vec3_cross(paths.gaze, vec3(0, 1, 0)));
    paths.up = vec3_cross(paths.right, paths.gaze);
    paths.aim = (ProbeAim){.context = &stage->context, .eye = eye, .targets = paths.targets,
                           .target_count = PATHS, .seed = SEED};
    for (int i = 0; i < PATHS; i++) aim_path(&paths, &frame, i);
    parallel_for(stage->tools.threads, PATHS / CHUNK, read_chunk, &paths);
    PupilSums pupil = read_pupil(&paths, scratch);
    return sum_up(&paths, &pupil, scratch);
}
