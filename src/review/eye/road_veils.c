/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/road_veils.h"

#include <math.h>

#include "scene/load/material_data.h"
#include "vision/eye_spread.h"
#include "vision/road_glare.h"

struct RoadVeils {
    const Scene *scene;
    RoadAges ages;
    int paths, rounds;
    bool *lacks_data;          /* [part] */
    double *seen;              /* [path][display][way], cd m^-2 */
    double *without_data;      /* [path] likewise */
    int *mirror;               /* [path] the first part that mirrors; NO_ID */
    EstimateSums *sums;        /* [age][display], and the whole */
    double *by_spread;         /* [age] */
    double *known, *variance;  /* [age] */
    double (*ways)[ROAD_WAYS]; /* [display] for the first age */
    double *mirrored;          /* [display][part] likewise */
    double without_data_veil;
};

/* ---- what was found ---------------------------------------------------------------------- */

RoadReading road_reading_start(int ages, int displays, Arena *arena) {
    return (RoadReading){ages, displays, ARENA_NEW(arena, RoadFound, ages * (displays + 1)),
                         ARENA_NEW(arena, RoadShares, displays), ARENA_NEW(arena, double, 1)};
}

/* ---- gathered ---------------------------------------------------------------------------- */

RoadVeils *road_veils_start(const Scene *scene, const RoadAges *ages, Arena *arena) {
    RoadVeils *veils = ARENA_NEW(arena, RoadVeils, 1);
    int parts = scene->part_count, displays = scene->display_count;
    veils->scene = scene;
    veils->ages = *ages;
    veils->lacks_data = ARENA_NEW(arena, bool, parts);
    for (int i = 0; i < parts; i++) veils->lacks_data[i] = !part_has_data(scene, i);
    veils->sums = ARENA_NEW(arena, EstimateSums, ages->count * (displays + 1));
    veils->by_spread = ARENA_NEW(arena, double, ages->count);
    veils->known = ARENA_NEW(arena, double, ages->count);
    veils->variance = ARENA_NEW(arena, double, ages->count);
    veils->ways = (double(*)[ROAD_WAYS])ARENA_NEW(arena, double, displays *ROAD_WAYS);
    veils->mirrored = ARENA_NEW(arena, double, displays *parts);
    return veils;
}

void road_veils_expect(RoadVeils *veils, int paths, int rounds, Arena *arena) {
    int displays = veils->scene->display_count;
    veils->paths = paths;
    veils->rounds = rounds;
    veils->seen = ARENA_NEW(arena, double, (size_t)paths *(size_t)displays *ROAD_WAYS);
    veils->without_data = ARENA_NEW(arena, double, paths);
    veils->mirror = ARENA_NEW(arena, int, paths);
    for (int i = 0; i < paths; i++) veils->mirror[i] = NO_ID;
    for (int i = 0; i < veils->ages.count * (displays + 1); i++)
        veils->sums[i] =
            (EstimateSums){.batches = rounds, .paths = paths, .piece = paths / rounds, .share = 1};
}

int road_veils_ages(const RoadVeils *veils) {
    return veils->ages.count;
}

double road_veils_age(const RoadVeils *veils, int age) {
    return veils->ages.list[age];
}

static int display_of(const RoadVeils *veils, int part_id) {
    const Scene *scene = veils->scene;
    return part_id == NO_ID ? NO_ID
                            : scene->materials[scene->parts[part_id].material_id].display_id;
}

static double *seen_of(const RoadVeils *veils, int path, int display) {
    size_t at = (size_t)path * (size_t)veils->scene->display_count + (size_t)display;
    return &veils->seen[at * ROAD_WAYS];
}

void road_light_add(RoadVeils *veils, int path, const PathHistory *history, double y) {
    RoadWay way = ROAD_STRAIGHT;
    int mirror = NO_ID;
    for (int i = 0; i < path_steps_kept(history) && way != ROAD_SCATTERED; i++) {
        const PathStep *step = &history->step[i];
        if (step->event == PATH_SCATTERS) way = ROAD_SCATTERED;
        else if (step->event == PATH_REFLECTS) way = ROAD_MIRRORED;
        if (step->event == PATH_REFLECTS && mirror == NO_ID) mirror = step->part_id;
    }
    for (int i = 0; i < path_steps_kept(history); i++)
        if (veils->lacks_data[history->step[i].part_id]) {
            veils->without_data[path] += y;
            break;
        }
    if (history->source != LIGHTS_EMITTERS) return;
    int display = display_of(veils, history->source_id);
    if (display == NO_ID) return;
    seen_of(veils, path, display)[way] += y;
    if (way == ROAD_MIRRORED) veils->mirror[path] = mirror;
}

/* ---- summed up --------------------------------------------------------------------------- */

static EstimateSums *sums_of(const RoadVeils *veils, int age, int display) {
    return &veils->sums[age * (veils->scene->display_count + 1) + display];
}

/* The veil of so many lux, 0 nearer than the formula holds. */
static double veil_of(const RoadVeils *veils, int age, double degrees, double lx) {
    if (!(degrees >= ROAD_VEIL_FROM_DEG)) return 0;
    return lx * road_veil_at(fmin(degrees, 90), veils->ages.list[age]);
}

static void add_spread(RoadVeils *veils, double degrees, double lx) {
    if (!(degrees >= ROAD_VEIL_FROM_DEG)) return;
    for (int a = 0; a < veils->ages.count; a++) {
        HumanEye eye = {veils->ages.list[a], veils->ages.pigment};
        veils->by_spread[a] += lx * eye_spread_at(fmin(degrees, 90), eye);
    }
}

/* veil: what it adds to the mean over all paths. */
static void add_by_path(const RoadVeils *veils, EstimateSums *to, int path, double veil) {
    double alone = veil * veils->paths;
    to->batch[path / (veils->paths / veils->rounds)] += alone;
    bright_add(&to->bright, alone);
}

static double counted_light(const double *seen, bool is_near) {
    return seen[ROAD_STRAIGHT] + seen[ROAD_MIRRORED] + (is_near ? 0 : seen[ROAD_SCATTERED]);
}

static void add_ways(RoadVeils *veils, int display, const RoadPath *path, const double *seen) {
    double veil = veil_of(veils, 0, path->degrees, path->lx);
    int mirror = veils->mirror[path->path];
    for (int w = 0; w < ROAD_WAYS; w++)
        if (w != ROAD_SCATTERED || !path->is_near) veils->ways[display][w] += veil * seen[w];
    if (mirror != NO_ID)
        veils->mirrored[display * veils->scene->part_count + mirror] += veil * seen[ROAD_MIRRORED];
}

void road_veils_add_path(RoadVeils *veils, const RoadPath *path) {
    int displays = veils->scene->display_count;
    add_spread(veils, path->degrees, path->lx * path->cd_m2);
    veils->without_data_veil += veil_of(veils, 0, path->degrees, path->lx) *
                                fmin(veils->without_data[path->path], path->cd_m2);
    for (int a = 0; a < veils->ages.count; a++) {
        double veil = veil_of(veils, a, path->degrees, path->lx);
        add_by_path(veils, sums_of(veils, a, displays), path->path, veil * path->cd_m2);
    }
    for (int d = 0; d < displays; d++) {
        const double *seen = seen_of(veils, path->path, d);
        double light = counted_light(seen, path->is_near);
        if (!(light > 0)) continue;
        add_ways(veils, d, path, seen);
        for (int a = 0; a < veils->ages.count; a++)
            add_by_path(veils, sums_of(veils, a, d), path->path,
                        light * veil_of(veils, a, path->degrees, path->lx));
    }
}

/* Of each age, one after the other: by display, the whole, by the eye's own spread. */
static int chunk_sums(const RoadVeils *veils) {
    return veils->scene->display_count + 2;
}

double *road_veils_chunk(const RoadVeils *veils, Arena *arena) {
    return ARENA_NEW(arena, double, veils->ages.count *chunk_sums(veils));
}

void road_veils_add_sample(const RoadVeils *veils, const RoadSample *sample, double *chunk) {
    int displays = veils->scene->display_count, display = display_of(veils, sample->part_id);
    if (!(sample->degrees >= ROAD_VEIL_FROM_DEG)) return;
    for (int a = 0; a < veils->ages.count; a++, chunk += chunk_sums(veils)) {
        HumanEye eye = {veils->ages.list[a], veils->ages.pigment};
        double veil = veil_of(veils, a, sample->degrees, sample->lx);
        chunk[displays] += veil;
        chunk[displays + 1] += sample->lx * eye_spread_at(fmin(sample->degrees, 90), eye);
        if (display != NO_ID) chunk[display] += veil;
    }
}

void road_veils_add_chunk(RoadVeils *veils, int round, double share, const double *chunk) {
    int displays = veils->scene->display_count;
    for (int a = 0; a < veils->ages.count; a++, chunk += chunk_sums(veils)) {
        veils->by_spread[a] += share * chunk[displays + 1];
        for (int d = 0; d <= displays; d++) {
            sums_of(veils, a, d)->batch[round] += share * chunk[d] * veils->paths;
            if (a == 0 && d < displays) veils->ways[d][ROAD_STRAIGHT] += share * chunk[d];
        }
    }
}

void road_veils_add_known(RoadVeils *veils, double degrees, double lx) {
    add_spread(veils, degrees, lx);
    for (int a = 0; a < veils->ages.count; a++) {
        double veil = veil_of(veils, a, degrees, lx);
        veils->known[a] += veil;
        veils->variance[a] += veil * veil;
    }
}

void road_veils_set_unmet(RoadVeils *veils, int age, double cd_m2) {
    sums_of(veils, age, veils->scene->display_count)->unmet = cd_m2;
}

/* ---- read -------------------------------------------------------------------------------- */

static RoadFound found_of(const RoadVeils *veils, int age, int display) {
    Estimate estimate = estimate_of(sums_of(veils, age, display));
    bool is_whole = display == veils->scene->display_count;
    if (is_whole) estimate_add_known(&estimate, veils->known[age], sqrt(veils->variance[age]));
    return (RoadFound){estimate.mean, estimate.interval.low, estimate.interval.high,
                       is_whole ? veils->by_spread[age] : (double)NAN};
}

static RoadShares shares_of(const RoadVeils *veils, int display) {
    RoadShares shares = {.mirrored = 0};
    int parts = veils->scene->part_count;
    const double *mirrored = &veils->mirrored[display * parts];
    for (int w = 0; w < ROAD_WAYS; w++) shares.way[w] = veils->ways[display][w];
    for (int i = 0; i < parts; i++)
        if (mirrored[i] > shares.mirrored) {
            shares.mirror = i;
            shares.mirrored = mirrored[i];
        }
    return shares;
}

void road_veils_read(const RoadVeils *veils, RoadReading *out) {
    int displays = veils->scene->display_count;
    for (int a = 0; a < veils->ages.count; a++)
        for (int d = 0; d <= displays; d++)
            out->found[a * (displays + 1) + d] = found_of(veils, a, d);
    for (int d = 0; d < displays; d++) out->shares[d] = shares_of(veils, d);
    double all = road_found_whole(out, 0).mean;
    *out->without_data = all > 0 ? fmin(veils->without_data_veil / all, 1) : 0;
}
