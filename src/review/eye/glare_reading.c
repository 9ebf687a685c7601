/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/glare_reading.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/units.h"
#include "review/eye/false_suns.h"
#include "review/eye/glare_field.h"

#define SEED 0x676c6172u
#define PIXELS 320      /* over 180 degrees, of several rounds; */
#define PIXELS_ONCE 200 /* of one */
#define SOURCE_BYTES ((size_t)1 << 34) /* of address space */

/* ---- samples ----------------------------------------------------------------------------- */

void glare_sample_note(const PathHistory *history, float lx, Vec3 eye, GlareSample *out)
{
    if (history->count || !(lx > 0)) return;
    float distance = history->is_distant ? INFINITY
                                         : vec3_length(vec3_sub(history->from, eye));
    *out = (GlareSample){history->towards, lx, history->sr, distance, history->source_id};
}

typedef struct GlareWork {
    const GlareArgs *args;
    GlareTable      table;
    GlareBackground background;
    double          samples_lx[GLARE_GROUPS]; /* of the background, by samples */
    double          threshold;
    Arena          *arena;
} GlareWork;

/* Blocks of samples are each as well spread as all of them (base/sampler.h): dealt out by
 * chance, intervals would be 20 times too wide. */
static int sample_group(const GlareArgs *args, int i)
{
    return i / (args->rest.count / GLARE_GROUPS);
}

/* Rounds are groups where there are enough. Those of one round are Hammersley's points: the
 * first bits of the index stand for the angle, its last ones for the direction about the gaze,
 * so that those in the middle leave each group a raster of its own over both. */
static int path_group(const GlareArgs *args, int i)
{
    if (args->rounds % GLARE_GROUPS == 0) return sample_group(args, i);
    return i / GLARE_GROUPS % GLARE_GROUPS;
}

static double forward_of(const GlareWork *work, Vec3 d)
{
    return (double)vec3_dot(d, work->args->head.gaze);
}

static void add_piece(const GlareWork *work, Vec3 d, double luminance, double sr, GlareSum *to)
{
    const GlareHead *head = &work->args->head;
    glare_sum_add(to, luminance, sr, (double)vec3_dot(d, head->right),
                  (double)vec3_dot(d, head->up), forward_of(work, d));
}

/* What is bright enough goes to source source_id of *sources ([id] in the table, and one more;
 * 0: none yet). */
static void add_samples(GlareWork *work, LightSet set, int *sources, double least)
{
    const GlareArgs *args = work->args;
    double share = 1.0 / args->rest.count;
    for (int i = 0; i < args->rest.count; i++) {
        const GlareSample *s = &args->samples[set][i];
        double forward = forward_of(work, s->towards);
        if (!(s->lx > 0) || !(s->sr > 0) || !(forward > 0)) continue;
        double luminance = (double)s->lx / ((double)s->sr * forward);
        int    group = sample_group(args, i), *source = &sources[s->source_id];
        if (luminance <= least) {
            if (set != LIGHTS_SKY) work->samples_lx[group] += (double)s->lx * share;
            continue;
        }
        if (!*source) {
            glare_table_add(&work->table, work->arena);
            *source = work->table.count;
        }
        GlareTally *to = &work->table.list[*source - 1];
        double      sr = (double)s->sr * share, distance = (double)s->distance;
        add_piece(work, s->towards, luminance, sr, &to->group[group]);
        if (isfinite(distance)) to->area_m2 += sr * distance * distance;
    }
}

static void add_surfaces(GlareWork *work, Arena scratch)
{
    const GlareSettings *settings = &work->args->setup->request->glare;
    int   *parts = ARENA_NEW(&scratch, int, work->args->setup->scene->part_count + 1);
    int    sun = 0, sky = 0;
    double peak = fmax(settings->peak_cd_m2, work->threshold);
    add_samples(work, LIGHTS_EMITTERS, parts, work->threshold);
    add_samples(work, LIGHTS_SUN, &sun, work->threshold);
    add_samples(work, LIGHTS_SKY, &sky, peak);
}

/* ---- lamps without a surface ------------------------------------------------------------- */

/* Sums over one lamp. */
typedef struct LampSums {
    double lx[GLARE_GROUPS], facing_lx[GLARE_GROUPS];
    double weighed_lx; /* of the latter, over P^2 */
    double distance;   /* m, weighed by facing_lx */
    double total;      /* of facing_lx */
    Vec3   towards;
} LampSums;

static double lamp_sr(const GlareWork *work, int id, const LampSums *sums)
{
    const PunctualLight *light = &work->args->setup->scene->lights[id];
    double sine = sin(radians_from_degrees(SUN_MEAN_RADIUS_DEG));
    double distance = sums->distance / sums->total;
    if (!isfinite(distance)) return PI * sine * sine;
    Vec3   d = vec3_neg(sums->towards);
    float  area = opening_area(&light->opening,
                               vec3(vec3_dot(d, light->axis_x), vec3_dot(d, light->axis_y),
                                    vec3_dot(d, light->axis_z)));
    double seen = area > 0 ? (double)area : GLARE_SOURCE_SMALL_M2;
    return fmin(seen / (distance * distance), 2 * PI);
}

static void add_lamp(GlareWork *work, int id, const LampSums *sums)
{
    if (!(sums->total > 0)) return;
    double      sr = lamp_sr(work, id, sums), luminance = sums->total / sr;
    bool        is_source = luminance > work->threshold;
    GlareTally *to = is_source ? glare_table_add(&work->table, work->arena) : NULL;
    double      distance = sums->distance / sums->total;
    if (to && isfinite(distance)) to->area_m2 = sr * distance * distance;
    for (int g = 0; g < GLARE_GROUPS; g++) {
        double share = sums->facing_lx[g] / sums->total;
        if (to) to->group[g] = (GlareSum){sr * share, sums->facing_lx[g], sums->lx[g],
                                          sr * share * sums->weighed_lx / sums->total};
        else work->samples_lx[g] += sums->lx[g];
    }
}

static void add_to_lamp(const GlareWork *work, const GlareSample *s, int group, LampSums *to)
{
    double   forward = forward_of(work, s->towards), share = 1.0 / work->args->rest.count;
    double   lx = (double)s->lx * share, facing = lx / forward;
    GlareSum one = {0};
    add_piece(work, s->towards, 0, 1, &one);
    to->lx[group] += lx;
    to->facing_lx[group] += facing;
    to->weighed_lx += facing * one.weight_sr;
    to->distance += facing * (double)s->distance;
    to->total += facing;
    to->towards = s->towards;
}

static void add_lamps(GlareWork *work, Arena scratch)
{
    const GlareArgs *args = work->args;
    int       count = args->setup->scene->light_count;
    LampSums *lamps = ARENA_NEW(&scratch, LampSums, count);
    for (int i = 0; i < args->rest.count; i++) {
        const GlareSample *s = &args->samples[LIGHTS_PUNCTUAL][i];
        if (s->lx > 0 && forward_of(work, s->towards) > 0)
            add_to_lamp(work, s, sample_group(args, i), &lamps[s->source_id]);
    }
    for (int id = 0; id < count; id++) add_lamp(work, id, &lamps[id]);
}

/* ---- images of the sun ------------------------------------------------------------------- */

static int by_place(const void *a, const void *b)
{
    const GlareImage *x = a, *y = b;
    const float p[4] = {(float)x->part_id, x->seen.x, x->seen.y, x->seen.z};
    const float q[4] = {(float)y->part_id, y->seen.x, y->seen.y, y->seen.z};
    for (int i = 0; i < 4; i++)
        if (p[i] != q[i]) return p[i] < q[i] ? -1 : 1;
    return 0;
}

/* Images [first, end) are one direction's: each of its rays found the sun or did not. */
static void add_direction(GlareWork *work, int first, int end, int *source)
{
    const GlareImage *images = work->args->images;
    double step = radians_from_degrees(FALSE_SUN_STEP_DEG), sr = step * step, lx = 0;
    for (int i = first; i < end; i++) lx += (double)images[i].facing_lx;
    double forward = forward_of(work, images[first].seen);
    if (!(forward > 0)) return;
    int group = first % GLARE_GROUPS;
    if (lx / sr <= work->threshold) {
        work->samples_lx[group] += lx * forward;
        return;
    }
    if (!*source) {
        glare_table_add(&work->table, work->arena);
        *source = work->table.count;
    }
    add_piece(work, images[first].seen, lx / sr, sr,
              &work->table.list[*source - 1].group[group]);
}

static void add_images(GlareWork *work)
{
    GlareImage *images = work->args->images;
    int         count = work->args->image_count, source = 0;
    if (count) qsort(images, (size_t)count, sizeof *images, by_place);
    for (int first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && !by_place(&images[first], &images[end]);) end++;
        if (first && images[first].part_id != images[first - 1].part_id) source = 0;
        add_direction(work, first, end, &source);
    }
}

/* ---- images of lamps --------------------------------------------------------------------- */

static void add_lamp_images(GlareWork *work, Arena scratch)
{
    const GlareArgs *args = work->args;
    LampImagesArgs   wanted = {args->setup, &args->head, args->lamps, PIXELS_ONCE,
                              review_seed(args->setup->request, SEED + 1)};
    LampImages found = lamp_images_find(&wanted, &scratch);
    int       *sources = ARENA_NEW(&scratch, int, found.pairs);
    for (int i = 0; i < found.count; i++) {
        const LampImage *image = &found.list[i];
        int group = glare_group_at(image->x, image->y), *source = &sources[image->pair];
        if (image->cd_m2 <= work->threshold) {
            work->samples_lx[group] +=
                image->cd_m2 * image->sr * forward_of(work, image->towards);
            continue;
        }
        if (!*source) {
            glare_table_add(&work->table, work->arena);
            *source = work->table.count;
        }
        add_piece(work, image->towards, image->cd_m2, image->sr,
                  &work->table.list[*source - 1].group[group]);
    }
}

/* ---- all --------------------------------------------------------------------------------- */

/* The rest of the background is as unsure as the light of its paths. */
static void add_background(GlareWork *work)
{
    const GlareArgs *args = work->args;
    double rest[GLARE_GROUPS] = {0}, total = 0;
    for (int i = 0; i < args->rest.count; i++) {
        double lx = args->rest.cd_m2[i] * args->rest.sr[i] *
                    forward_of(work, args->rest.towards[i]);
        rest[path_group(args, i)] += lx;
        total += lx;
    }
    for (int g = 0; g < GLARE_GROUPS; g++) {
        double share = total > 0 ? rest[g] / total : 0;
        work->table.background_lx[g] = work->samples_lx[g] + work->background.told_lx[g] +
                                       work->background.rest_lx * share;
    }
}

GlareReading glare_read(const GlareArgs *args, Arena scratch)
{
    const GlareSettings *settings = &args->setup->request->glare;
    Arena     sources = arena_reserve(SOURCE_BYTES);
    GlareWork work = {.args = args, .threshold = glare_threshold(settings, args->task_cd_m2),
                      .arena = &sources};
    GlareRest rest = glare_rest_build(&args->head, &args->rest, work.threshold, &scratch);
    GlareFieldArgs field = {.setup = args->setup, .rest = &rest, .found = args->told,
                           .threshold_cd_m2 = work.threshold,
                           .peak_cd_m2 = fmax(settings->peak_cd_m2, work.threshold),
                           .pixels = args->rounds > 1 ? PIXELS : PIXELS_ONCE,
                           .seed = review_seed(args->setup->request, SEED)};
    add_surfaces(&work, scratch);
    add_lamps(&work, scratch);
    add_images(&work);
    add_lamp_images(&work, scratch);
    glare_field_add(&field, &work.table, &work.background, &sources);
    add_background(&work);
    GlareReading out = glare_table_read(&work.table, settings, work.threshold, scratch);
    arena_release(&sources);
    return out;
}
