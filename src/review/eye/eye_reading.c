/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/eye_reading.h"

#include <math.h>
#include <stdlib.h>

#include "base/count.h"
#include "base/units.h"
#include "estimate/estimate.h"
#include "review/eye/unmet_lamps.h"
#include "review/light/reading.h"
#include "vision/eye_spread.h"
#include "vision/road_glare.h"

#define PATHS 4096
#define CHUNK 64
#define SEED 0x7665696cu
#define SHIFT_SEED 0x73686966u
#define FROM_DEG 0.1 /* nearer is looked at */
#define TO_DEG 89.9
#define BY_SPREAD (-1.0) /* no age of a road's veil */
#define IMAGES_APART 2   /* roots of what a path stands for: its neighbours are nearer */

/* The light that one path finds. The veil of lamps, displays and the sun that the eye sees by
 * themselves is read by light samples, which find small ones too. */
typedef struct EyePath {
    double apart[EYE_SOURCES]; /* cd m^-2 that light samples do not read; */
    double shown;              /* and what lamps and displays show by themselves; */
    double images;             /* and of the glints the sun's */
    double beside[2][2];       /* X and Z of `apart`, of `shown` */
    int lamp;                  /* part that was met by mirrors; NO_ID: none */
    float share;               /* that its last mirror lets the eye see of what lies there: */
    Ray image;                 /* (0: it met none) */
    bool is_first;             /* the first mirror, in which compact emitters are sampled */
} EyePath;

/* Sums over the pupil's light samples. */
typedef struct PupilSums {
    double sun_veil, lamp_veil, sun_lx, lamp_lx;
    double image_veil; /* of lamps and small emitters in mirrors; their lux are lamps' */
    double beside[2];  /* X and Z of all of that veil */
} PupilSums;

/* Angles are drawn evenly in their logarithm: f cos theta sin theta is about as 1 / theta;
 * Hammersley's points, which each round but the first shifts (Cranley and Patterson 1976). */
typedef struct EyePaths {
    const Setup *setup;
    ProbeAim aim;
    int count; /* paths of all rounds */
    Vec3 gaze; /* unit */
    HumanEye whose;
    Vec3 *targets;        /* one a path; the rest likewise: */
    double *solid_angles; /* sr that it stands for */
    EyePath *found;
    PupilSums *pupils; /* one a round */
    const FalseSuns *images;
    double close_deg; /* nearer to the gaze lamps are read by paths; 0: nowhere */
    RoadVeils *road;  /* or NULL */
} EyePaths;

/* u, shifted round the unit circle as the round requires for that axis. */
static double shifted(double u, int round, uint32_t axis) {
    double by = hash_combine(hash_u32(SHIFT_SEED + axis), (uint32_t)round) * 0x1p-32;
    double sum = u + (round ? by : 0);
    return sum - floor(sum);
}

static void aim_path(EyePaths *paths, const Frame *gaze, int i) {
    int round = i / PATHS, k = i % PATHS;
    double range = log(TO_DEG / FROM_DEG), u = shifted((k + 0.5) / PATHS, round, 0);
    double theta = radians_from_degrees(FROM_DEG * exp(range * u));
    double phi = 2 * PI * shifted(reverse_bits((uint32_t)k) * 0x1p-32, round, 1);
    Vec3 local =
        vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
    paths->targets[i] = vec3_add(paths->aim.eye, frame_to_world(gaze, local));
    paths->solid_angles[i] = sin(theta) * theta * range * 2 * PI / paths->count;
    paths->found[i].lamp = NO_ID;
}

static Vec3 direction_of(const EyePaths *paths, int i) {
    return vec3_normalize(vec3_sub(paths->targets[i], paths->aim.eye));
}

static double degrees_between(Vec3 a, Vec3 b) {
    return degrees_from_radians(acos(fmin(fmax((double)vec3_dot(a, b), -1), 1)));
}

static EyeSource source_of(const PathHistory *history) {
    bool is_mirrored = false;
    for (int i = 0; i < path_steps_kept(history); i++) {
        if (history->step[i].event == PATH_SCATTERS) return EYE_SURFACES;
        is_mirrored |= history->step[i].event == PATH_REFLECTS;
    }
    if (history->source == LIGHTS_SKY) return is_mirrored ? EYE_SURFACES : EYE_SKY;
    if (is_mirrored) return EYE_GLINTS;
    return history->source == LIGHTS_SUN ? EYE_SUN : EYE_LAMPS;
}

static void add_found(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    const EyePaths *paths = to->user;
    EyePath *path = &paths->found[to->piece->path];
    bool is_direct = history->count == 0 || (history->count == 1 && history->is_sampled);
    if (is_direct && history->source == LIGHTS_SUN) return;
    if (paths->road && (!is_direct || history->source == LIGHTS_SKY))
        road_light_add(paths->road, to->piece->path, history, (double)xyz[1]);
    bool is_shown = is_direct && history->source == LIGHTS_EMITTERS;
    bool is_apart = !is_direct || history->source == LIGHTS_SKY;
    if (is_apart) path->apart[source_of(history)] += (double)xyz[1];
    if (is_shown) path->shown += (double)xyz[1];
    for (int k = 0; k < 2 && (is_apart || is_shown); k++)
        path->beside[is_shown][k] += (double)xyz[2 * k];
    if (is_direct || source_of(history) != EYE_GLINTS) return;
    if (history->source == LIGHTS_SUN) path->images += (double)xyz[1];
    if (history->source == LIGHTS_EMITTERS) path->lamp = history->source_id;
}

static void note_mirror(const ProbePart *to, const PathHistory *history, Vec3 towards,
                        float share) {
    EyePath *path = &((const EyePaths *)to->user)->found[to->piece->path];
    if (history->count > PATH_STEPS_MAX) return;
    for (int i = 0; i < history->count; i++)
        if (history->step[i].event == PATH_SCATTERS) return;
    path->share = share;
    path->is_first = history->is_sampled;
    path->image = (Ray){history->step[history->count - 1].position, towards, 0, INFINITY};
}

/* ---- what is seen by itself -------------------------------------------------------------- */

/* Comes light to the pupil by itself, or by one mirror from a lamp or a small emitter? */
static bool is_seen_by_itself(const PathHistory *history) {
    if (history->source == LIGHTS_SKY) return false;
    return !history->count ||
           (history->count == 1 && history->source != LIGHTS_SUN && history->is_sampled);
}

static double veil_of(const EyePaths *paths, Vec3 towards, double lux) {
    double degrees = degrees_between(towards, paths->gaze);
    return degrees >= FROM_DEG ? lux * eye_spread_at(fmin(degrees, 90), paths->whose) : 0;
}

static bool is_close(const EyePaths *paths, Vec3 towards) {
    return paths->close_deg > 0 && degrees_between(towards, paths->gaze) < paths->close_deg;
}

static double veil_at_age(const EyePaths *paths, Vec3 towards, double lux, double age) {
    double degrees = degrees_between(towards, paths->gaze);
    if (age == BY_SPREAD) return veil_of(paths, towards, lux);
    return degrees >= FROM_DEG ? lux * road_veil_at(fmin(degrees, 90), age) : 0;
}

static void add_to_pupil(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    const EyePaths *paths = to->user;
    PupilSums *sums = to->own;
    bool is_sun = history->source == LIGHTS_SUN;
    if (!is_seen_by_itself(history)) return;
    *(is_sun ? &sums->sun_lx : &sums->lamp_lx) += (double)xyz[1];
    if (history->source == LIGHTS_EMITTERS && is_close(paths, history->towards)) return;
    *(is_sun           ? &sums->sun_veil
      : history->count ? &sums->image_veil
                       : &sums->lamp_veil) += veil_of(paths, history->towards, (double)xyz[1]);
    for (int k = 0; k < 2; k++)
        sums->beside[k] += veil_of(paths, history->towards, (double)xyz[2 * k]);
}

/* Light samples alone, and of mirrors what lamps and small emitters send by one. */
static PathContext pupil_context(const Setup *setup) {
    PathContext context = setup->context;
    context.strategy = PATH_LIGHTS_ONLY;
    context.beams[BEAMS_OF_SUN].mirrors = NULL;
    bool has_images =
        context.beams[BEAMS_OF_LAMPS].mirrors || context.beams[BEAMS_OF_EMITTERS].mirrors;
    context.max_bounces = has_images ? 2 : 1;
    return context;
}

/* times: as many samples as the eye has paths. */
static void read_pupil(const EyePaths *paths, uint32_t seed, int times, const ProbeFold *fold,
                       Arena scratch) {
    LitPoint pupil = {paths->aim.eye, paths->gaze, false};
    PathContext lights_only = pupil_context(paths->setup);
    ProbeAim aim = {
        .context = &lights_only, .meter = &pupil, .seed = review_seed(paths->setup->request, seed)};
    ProbeGoal goal = {
        .pieces = paths->count / CHUNK, .paths = CHUNK * times, .together = CHUNK * times};
    probe_read(&aim, &goal, &paths->setup->tools, fold, 1, scratch);
}

static void merge_pupil(const ProbePart *from) {
    const PupilSums *sums = from->own;
    PupilSums *to = &((const EyePaths *)from->user)->pupils[from->piece->first / PATHS];
    to->sun_veil += sums->sun_veil / PATHS;
    to->lamp_veil += sums->lamp_veil / PATHS;
    to->image_veil += sums->image_veil / PATHS;
    for (int k = 0; k < 2; k++) to->beside[k] += sums->beside[k] / PATHS;
    to->sun_lx += sums->sun_lx / PATHS;
    to->lamp_lx += sums->lamp_lx / PATHS;
}

/* ---- figures ----------------------------------------------------------------------------- */

typedef struct EyeSums {
    EyeReading reading;
    EstimateSums veil; /* of paths in batches of rounds */
    double image_veil, image_variance;
} EyeSums;

/* veil: of a round by itself. */
static void add_veil(const EyePaths *paths, int round, EyeSource source, double veil,
                     EyeSums *sums) {
    sums->veil.batch[round] += veil * PATHS;
    sums->reading.parts[source] += veil * PATHS / paths->count;
}

/* Within the field in which images were looked for? */
static bool has_images(const EyePaths *paths, Vec3 d) {
    Vec3 ahead = vec3_from_doubles(paths->setup->request->forward);
    return paths->images && degrees_between(d, ahead) < FALSE_SUN_FIELD_DEG;
}

static EyeSource counted_as(EyeSource source, bool is_near) {
    return is_near && (source == EYE_SKY || source == EYE_SURFACES) ? EYE_NEAR : source;
}

/* All but what is looked at, and the sun's images, which are known by themselves. */
static void add_path_to_road(const EyePaths *paths, int i, Vec3 d, double weight) {
    const EyePath *path = &paths->found[i];
    double degrees = degrees_between(d, paths->gaze);
    RoadPath to = {.path = i, .degrees = degrees, .lx = weight, .is_near = degrees < EYE_NEAR_DEG};
    for (int k = 0; k < EYE_SOURCES; k++)
        if (counted_as((EyeSource)k, to.is_near) != EYE_NEAR) to.cd_m2 += path->apart[k];
    if (has_images(paths, d)) to.cd_m2 -= path->images;
    to.cd_m2 = fmax(to.cd_m2, 0); /* rounding alone is below */
    road_veils_add_path(paths->road, &to);
}

static void add_path(const EyePaths *paths, int i, EyeSums *sums) {
    const EyePath *path = &paths->found[i];
    Vec3 d = direction_of(paths, i);
    bool is_near = degrees_between(d, paths->gaze) < EYE_NEAR_DEG;
    double weight = paths->solid_angles[i] * (double)vec3_dot(d, paths->gaze);
    double veil = veil_of(paths, d, weight) * paths->count / PATHS, all = 0;
    for (int k = 0; k < EYE_SOURCES; k++) {
        double left = path->apart[k];
        if (k == EYE_GLINTS && has_images(paths, d)) left -= path->images;
        if (!(left > 0)) continue;
        sums->reading.vertical_lx += left * weight;
        add_veil(paths, i / PATHS, counted_as((EyeSource)k, is_near), left * veil, sums);
        all += left * veil * PATHS;
    }
    if (path->shown > 0 && is_close(paths, d)) {
        add_veil(paths, i / PATHS, EYE_LAMPS, path->shown * veil, sums);
        all += path->shown * veil * PATHS;
    }
    for (int k = 0; k < 4; k++)
        if (k < 2 || is_close(paths, d))
            sums->reading.beside[k % 2] += path->beside[k / 2][k % 2] * veil * PATHS / paths->count;
    bright_add(&sums->veil.bright, all);
    if (paths->road) add_path_to_road(paths, i, d, weight);
}

/* Images of the sun. */
typedef struct ImageWork {
    const EyePaths *paths;
    EyeSums *sums;
    double luminance; /* cd m^-2, of the sun */
} ImageWork;

static void add_image(void *user, const FalseSun *image, double share) {
    const ImageWork *work = user;
    EyeSums *sums = work->sums;
    double cosine = (double)vec3_dot(image->seen, work->paths->gaze);
    if (!(cosine > 0)) return;
    double lux = work->luminance * share * (double)image->sr * cosine;
    double veil = veil_of(work->paths, image->seen, lux);
    sums->reading.vertical_lx += lux;
    sums->reading.parts[EYE_GLINTS] += veil;
    if (work->paths->road)
        road_veils_add_known(work->paths->road, degrees_between(image->seen, work->paths->gaze),
                             lux);
    sums->image_veil += veil;
    sums->image_variance += veil * veil; /* as if each ray had come by chance */
}

static void add_images(const EyePaths *paths, EyeSums *sums) {
    ImageWork work = {paths, sums, 0};
    Vec3 towards;
    float bands[LIGHT_BANDS];
    double disc = 2 * PI * (1 - cos(radians_from_degrees(SUN_MEAN_RADIUS_DEG)));
    if (!paths->images || !setup_sun(paths->setup, &towards, bands)) return;
    for (int b = 0; b < LIGHT_BANDS; b++) work.luminance += (double)bands[b] / disc;
    false_suns_each(paths->images, towards, add_image, &work);
}

static void add_pupils(const EyePaths *paths, EyeSums *sums) {
    const PupilSums *pupils = paths->pupils;
    int rounds = paths->count / PATHS;
    for (int r = 0; r < rounds; r++) {
        add_veil(paths, r, EYE_SUN, pupils[r].sun_veil, sums);
        add_veil(paths, r, EYE_LAMPS, pupils[r].lamp_veil, sums);
        add_veil(paths, r, EYE_GLINTS, pupils[r].image_veil, sums);
        for (int k = 0; k < 2; k++) sums->reading.beside[k] += pupils[r].beside[k] / rounds;
        sums->reading.vertical_lx += (pupils[r].sun_lx + pupils[r].lamp_lx) / rounds;
    }
}

/* More light samples than the eye's own veil has: a road's weighs a small lamp near the gaze by
 * far more than its share of the light, by which samples find it. */
#define ROAD_TIMES 8
#define ROAD_SEED (SEED + 2)

static void begin_road(ProbePart *to, Arena *arena) {
    to->own = road_veils_chunk(((const EyePaths *)to->user)->road, arena);
}

static void add_to_road(const ProbePart *to, const PathHistory *history, const float xyz[3]) {
    const EyePaths *paths = to->user;
    RoadSample sample = {.degrees = degrees_between(history->towards, paths->gaze),
                         .lx = (double)xyz[1],
                         .part_id =
                             history->source == LIGHTS_EMITTERS ? history->source_id : NO_ID};
    if (is_seen_by_itself(history)) road_veils_add_sample(paths->road, &sample, to->own);
}

static void merge_road(const ProbePart *from) {
    const EyePaths *paths = from->user;
    road_veils_add_chunk(paths->road, from->piece->first / ROAD_TIMES / PATHS,
                         1.0 / ((double)paths->count * ROAD_TIMES), from->own);
}

/* A path behind its mirror: what a lamp of 1 cd m^-2 there adds to the veil. */
typedef struct EyeImage {
    double veil;
    int path;
} EyeImage;

static int most_first(const void *a, const void *b) {
    const EyeImage *x = a, *y = b;
    if (x->veil != y->veil) return x->veil < y->veil ? 1 : -1;
    return x->path - y->path;
}

static EyeImage *find_images(const EyePaths *paths, double age, int *count, Arena *arena) {
    EyeImage *images = ARENA_NEW(arena, EyeImage, paths->count);
    *count = 0;
    for (int i = 0; i < paths->count; i++) {
        Vec3 d = direction_of(paths, i);
        double weight = paths->solid_angles[i] * (double)vec3_dot(d, paths->gaze);
        if (paths->found[i].share > 0)
            images[(*count)++] =
                (EyeImage){(double)paths->found[i].share * veil_at_age(paths, d, weight, age), i};
    }
    if (*count) qsort(images, (size_t)*count, sizeof *images, most_first);
    return images;
}

/* What a path may have of a lamp's image that none met: of lamps near its way behind a mirror,
 * as far as paths stand apart there. */
static double unmet_veil(const EyePaths *paths, double age, Arena scratch) {
    int count;
    bool *met = ARENA_NEW(&scratch, bool, paths->setup->scene->part_count);
    EyeImage *images = find_images(paths, age, &count, &scratch);
    double most = 0;
    for (int i = 0; i < paths->count; i++)
        if (paths->found[i].lamp != NO_ID) met[paths->found[i].lamp] = true;
    UnmetLamps lamps = lamps_unmet(&paths->setup->context, met, &scratch);
    for (int k = 0; k < count && lamps.count; k++) {
        int i = images[k].path;
        double apart = IMAGES_APART * sqrt(paths->solid_angles[i]);
        if (images[k].veil * lamps.list[0].cd_m2 <= most) break;
        most = fmax(most, images[k].veil * lamps_brightest(&lamps, paths->found[i].image, apart,
                                                           paths->found[i].is_first));
    }
    for (int k = 0; k < count && paths->setup->scene->light_count; k++) {
        int i = images[k].path;
        double sr = paths->solid_angles[i];
        if (!paths->found[i].is_first)
            most = fmax(most, images[k].veil / sr *
                                  lamps_point_lx(paths->setup->scene, paths->found[i].image,
                                                 IMAGES_APART * sqrt(sr)));
    }
    return estimate_unmet(most * paths->count, paths->count);
}

/* Rounds are batches. NaN of one. */
static void set_veil_range(const EyePaths *paths, EyeSums *sums, Arena scratch) {
    EyeReading *out = &sums->reading;
    out->veil_sigma = out->veil_range.low = out->veil_range.high = (double)NAN;
    if (sums->veil.batches < 2) return;
    sums->veil.unmet = unmet_veil(paths, BY_SPREAD, scratch);
    Estimate veil = estimate_of(&sums->veil);
    estimate_add_known(&veil, sums->image_veil, sqrt(sums->image_variance));
    out->veil_sigma = veil.sigma;
    out->veil_range = veil.interval;
}

static void finish_road(EyePaths *paths, Arena scratch) {
    ProbeFold fold = {
        .user = paths, .begin = begin_road, .on_light = add_to_road, .merge = merge_road};
    read_pupil(paths, ROAD_SEED, ROAD_TIMES, &fold, scratch);
    for (int a = 0; a < road_veils_ages(paths->road); a++)
        road_veils_set_unmet(paths->road, a,
                             unmet_veil(paths, road_veils_age(paths->road, a), scratch));
}

static EyeReading sum_up(EyePaths *paths, Arena scratch) {
    int rounds = paths->count / PATHS;
    EyeSums sums = {.veil = {.batches = rounds, .paths = paths->count, .piece = PATHS, .share = 1}};
    EyeReading *r = &sums.reading;
    for (int i = 0; i < paths->count; i++) add_path(paths, i, &sums);
    add_pupils(paths, &sums);
    add_images(paths, &sums);
    for (int k = 0; k < EYE_SOURCES; k++) r->veil += r->parts[k];
    set_veil_range(paths, &sums, scratch);
    if (paths->road) finish_road(paths, scratch);
    return *r;
}

EyeReading eye_read(const Setup *setup, const EyeLook *look, Arena scratch) {
    int count = look->rounds * PATHS;
    EyePaths paths = {.setup = setup,
                      .count = count,
                      .gaze = vec3_normalize(look->towards),
                      .whose = setup->request->observer,
                      .images = look->images,
                      .road = look->road,
                      .close_deg = look->is_close ? EYE_CLOSE_DEG : 0,
                      .targets = ARENA_NEW(&scratch, Vec3, count),
                      .solid_angles = ARENA_NEW(&scratch, double, count),
                      .found = ARENA_NEW(&scratch, EyePath, count),
                      .pupils = ARENA_NEW(&scratch, PupilSums, look->rounds)};
    Frame frame = frame_from_z(paths.gaze);
    if (look->road) road_veils_expect(look->road, count, look->rounds, &scratch);
    paths.aim = (ProbeAim){.context = &setup->context,
                           .eye = look->eye,
                           .targets = paths.targets,
                           .target_count = count,
                           .seed = review_seed(setup->request, SEED)};
    for (int i = 0; i < count; i++) aim_path(&paths, &frame, i);
    ProbeGoal goal = {.pieces = count / CHUNK, .paths = CHUNK};
    ProbeFold fold = {.user = &paths, .on_light = add_found, .on_mirror = note_mirror};
    probe_read(&paths.aim, &goal, &setup->tools, &fold, 1, scratch);
    ProbeFold lights = {
        .user = &paths, .bytes = sizeof(PupilSums), .on_light = add_to_pupil, .merge = merge_pupil};
    read_pupil(&paths, SEED + 1, 1, &lights, scratch);
    return sum_up(&paths, scratch);
}
