#include "review/light/veil.h"

#include <math.h>

#include "base/parallel.h"
#include "base/units.h"
#include "review/light/response.h"
#include "vision/disability_glare.h"

#define PATHS 4096
#define CHUNK 64
#define SEED 0x7665696cu
#define SUN_PATHS 16
#define FROM_DEG DISABILITY_GLARE_MIN_DEG
#define TO_DEG 89.9

/* Angles are drawn evenly in their logarithm, as f cos theta sin theta, about 1 / theta, asks;
 * Hammersley's points. */
typedef struct VeilPaths {
    const Stage *stage;
    ProbeAim     aim;
    Vec3        *targets;  /* one a path */
    double      *weights;  /* cd m^-2 of veil by cd m^-2 seen there, over the paths */
    double      *sums;     /* one a chunk */
    Vec3         sun;
    bool         has_sun;
    double       cos_sun;  /* within: the disc, which is not met by chance */
} VeilPaths;

static double van_der_corput(uint32_t i)
{
    return reverse_bits(i) * 0x1p-32;
}

static void aim_path(VeilPaths *paths, const Frame *gaze, HumanEye eye, int i)
{
    double range = log(TO_DEG / FROM_DEG), u = (i + 0.5) / PATHS;
    double degrees = FROM_DEG * exp(range * u), theta = radians_from_degrees(degrees);
    double phi = 2 * PI * van_der_corput((uint32_t)i);
    Vec3   local = vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                        (float)cos(theta));
    paths->targets[i] = vec3_add(paths->aim.eye, frame_to_world(gaze, local));
    double solid_angle = sin(theta) * theta * range * 2 * PI / PATHS;
    paths->weights[i] = disability_glare(degrees, eye) * cos(theta) * solid_angle;
}

static void read_chunk(void *user, int item, int worker)
{
    (void)worker;
    VeilPaths     *paths = user;
    PathStatistics statistics = {0};
    ProbeLook      looks[CHUNK];
    int            first = item * CHUNK;
    paths->stage->tools.kernel->look(&paths->aim, first, first + CHUNK, looks, &statistics);
    for (int i = 0; i < CHUNK; i++) {
        Vec3 d = vec3_normalize(vec3_sub(paths->targets[first + i], paths->aim.eye));
        bool is_sun = paths->has_sun && looks[i].is_far &&
                      (double)vec3_dot(d, paths->sun) >= paths->cos_sun;
        if (!is_sun)
            paths->sums[item] += paths->weights[first + i] * (double)looks[i].seen[1];
    }
}

/* The disc itself, by its illuminance of the pupil. */
static double veil_of_sun(const Stage *stage, Vec3 eye, Vec3 gaze, HumanEye whose,
                          Arena scratch)
{
    Vec3  towards;
    float bands[LIGHT_BANDS];
    if (!stage_sun(stage, &towards, bands)) return 0;
    double cosine = (double)vec3_dot(towards, gaze), lux = 0;
    double degrees = degrees_from_radians(acos(fmin(fmax(cosine, -1), 1)));
    if (cosine <= 0) return 0;
    LitPoint        pupil = {eye, gaze, false};
    ProbeAim        aim = {.context = &stage->context, .meter = &pupil, .seed = SEED};
    ProbeSuns       suns = {&towards, 1, 0.99999f, false};
    ResponseOptions options = {stage->tools.kernel, 0, SUN_PATHS, stage->tools.threads};
    const float    *shares = response_suns(&aim, &options, &suns, &scratch);
    for (int b = 0; b < LIGHT_BANDS; b++) lux += (double)shares[b] * (double)bands[b];
    return lux > 0 ? lux * disability_glare(fmax(degrees, FROM_DEG), whose) : 0;
}

double veil_read(const Stage *stage, Vec3 eye, Vec3 at, Arena scratch)
{
    const ReviewObserver *observer = &stage->request->observer;
    HumanEye  whose = {observer->age_years, observer->pigment};
    Vec3      gaze = vec3_normalize(vec3_sub(at, eye));
    Frame     frame = frame_from_z(gaze);
    float     bands[LIGHT_BANDS];
    VeilPaths paths = {.stage = stage, .targets = ARENA_NEW(&scratch, Vec3, PATHS),
                       .weights = ARENA_NEW(&scratch, double, PATHS),
                       .sums = ARENA_NEW(&scratch, double, PATHS / CHUNK),
                       .cos_sun = cos(radians_from_degrees(0.3))};
    paths.aim = (ProbeAim){.context = &stage->context, .eye = eye, .targets = paths.targets,
                           .target_count = PATHS, .seed = SEED};
    paths.has_sun = stage_sun(stage, &paths.sun, bands);
    for (int i = 0; i < PATHS; i++) aim_path(&paths, &frame, whose, i);
    parallel_for(stage->tools.threads, PATHS / CHUNK, read_chunk, &paths);
    double veil = veil_of_sun(stage, eye, gaze, whose, scratch);
    for (int k = 0; k < PATHS / CHUNK; k++) veil += paths.sums[k];
    return veil;
}
