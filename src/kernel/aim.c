/* SPDX-License-Identifier: Apache-2.0 */
#include "kernel/aim.h"

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"
#include "path/collect/seen.h"
#include "path/path_features.h"

/* place: the pair in [0, 1)^2 that is a pixel path's place in the pixel. The choice of the
 * target leaves a number that is as even. */
static Vec3 target_of(const ProbeAim *aim, int path, Vec2 place, int *which) {
    int target = path % aim->target_count;
    float along = place.x;
    if (aim->is_spread) {
        float scaled = place.x * (float)aim->target_count;
        target = (int)scaled < aim->target_count ? (int)scaled : aim->target_count - 1;
        along = scaled - (float)target;
    }
    *which = target;
    if (!aim->patches) return aim->targets[target];
    const ProbePatch *patch = &aim->patches[target];
    return vec3_add(aim->targets[target], vec3_add(vec3_scale(patch->along, along - 0.5f),
                                                   vec3_scale(patch->down, place.y - 0.5f)));
}

/* A path of a probe: its sampler behind the wavelengths, and where it goes. */
typedef struct ProbePath {
    PathStart start;
    Wavelengths wavelengths;
    Sampler sampler;
    Ray ray; /* of an eye */
    int target;
} ProbePath;

/* place: of the path's sampler. */
static void set_ray(const ProbeAim *aim, int path, Vec2 place, ProbePath *out) {
    const ProbePixel *pixel = aim->pixel;
    if (pixel) {
        out->ray = camera_pixel_ray(pixel->camera, pixel->x, pixel->y, place, &out->sampler);
        return;
    }
    Vec3 to = vec3_sub(target_of(aim, path, place, &out->target), aim->eye);
    out->ray = (Ray){aim->eye, vec3_normalize(to), 0, INFINITY};
}

/* All light that is counted is counted by these weights. */
static void colour_eye(const Curve *colour, Wavelengths *wavelengths) {
    Spectrum share = curve_lookup(colour, wavelengths);
    for (int i = 0; i < 3; i++) wavelengths->xyz[i] *= share;
}

static void start_path(const ProbeAim *aim, int path, PathStatistics *statistics, ProbePath *out) {
    const ProbePixel *pixel = aim->pixel;
    int x = pixel ? pixel->x : 0, y = pixel ? pixel->y : 0;
    out->sampler = sampler_start(aim->seed, x, y, (uint32_t)path);
    Vec2 place = sampler_2d(&out->sampler);
    wavelengths_sample(sampler_1d(&out->sampler), &out->wavelengths);
    if (aim->colour) colour_eye(aim->colour, &out->wavelengths);
    out->start = (PathStart){.context = aim->context,
                             .wavelengths = &out->wavelengths,
                             .sampler = &out->sampler,
                             .statistics = statistics};
    out->target = 0;
    if (!aim->meter) set_ray(aim, path, place, out);
}

/* ---- by the light that is there ---------------------------------------------------------- */

static void look(const ProbeAim *aim, int path, ProbeLook *out, PathStatistics *statistics) {
    ProbePath own;
    SeenLight seen;
    float emitted[3];
    SeenRequest request = {.listener = NULL};
    *out = (ProbeLook){.is_found = false};
    start_path(aim, path, statistics, &own);
    path_seen(&own.start, own.ray, &request, &seen);
    if (!seen.path.hit ||
        !path_display_emission(aim->context, &seen.path, &own.wavelengths, emitted)) {
        *out = (ProbeLook){.is_found = false};
        return;
    }
    out->is_found = true;
    out->target = own.target;
    for (int i = 0; i < 3; i++) {
        out->reflected[i] = seen.path.xyz[i] - emitted[i];
        out->mirror[i] = seen.path.mirror[i];
    }
}

static void read_meter(const ProbeAim *aim, int path, ProbeLook *out, PathStatistics *statistics) {
    ProbePath own;
    *out = (ProbeLook){.is_found = true};
    start_path(aim, path, statistics, &own);
    path_from_point(&own.start, *aim->meter, out->reflected);
}

/* A pixel's paths are no probe's but those of its frame. */
static ProbeAim aim_of_first(const ProbeAim *aim, PathContext *room) {
    ProbeAim own = *aim;
    *room = *aim->context;
    room->is_probe = !aim->meter && !aim->pixel;
    own.context = room;
    return own;
}

void aim_look(const ProbeAim *asked, int first, int end, ProbeLook *out,
              PathStatistics *statistics) {
    PathContext context;
    ProbeAim aim = aim_of_first(asked, &context);
    for (int path = first; path < end; path++)
        (aim.meter ? read_meter : look)(&aim, path, &out[path - first], statistics);
}

/* Traces the path for its collectors alone. */
static void go(const ProbeAim *aim, const ProbePath *path) {
    float ignored[3];
    if (aim->meter) path_from_point(&path->start, *aim->meter, ignored);
    else path_from_ray(&path->start, path->ray, NULL);
}

void aim_trace(const ProbeAim *asked, int first, int end, const PathListener *listener,
               PathStatistics *statistics) {
    PathContext context;
    ProbeAim own = aim_of_first(asked, &context), *aim = &own;
    for (int path = first; path < end; path++) {
        ProbePath one;
        HistoryCollector by_way = history_collector(listener, NULL);
        PolarisedRows rows;
        start_path(aim, path, statistics, &one);
        one.start.collector = &by_way.base;
        one.start.manner.is_spared = one.start.manner.has_sheets =
            listener->reach == PATH_BY_MIRRORS;
        if (listener->is_polarised && aim->context->eye) {
            rows = polarised_rows(aim->context->eye, NULL, one.start.collector);
            one.start.collector = &rows.base;
        }
        go(aim, &one);
    }
}

/* ---- by light from anywhere -------------------------------------------------------------- */

/* Traces a dark path (PathManner), which gets light by the collector. */
static void trace(const ProbeAim *aim, int path, PathCollector *collector,
                  PathStatistics *statistics) {
    ProbePath one;
    start_path(aim, path, statistics, &one);
    one.start.collector = collector;
    one.start.manner.is_dark = true;
    go(aim, &one);
}

static void add_lanes(float *sums, float weight, const float *share) {
    for (int lane = 0; lane < SPECTRUM_LANES; lane++) sums[lane] += weight * share[lane];
}

/* The z axis of the cells' hemisphere is the scene's y axis. */
static Vec3 world_of_cells(Vec3 d) {
    return vec3(d.y, d.z, d.x);
}

static Vec3 cells_of_world(Vec3 d) {
    return vec3(d.z, d.x, d.y);
}

Vec3 aim_cell_center(const ProbeCells *cells, int cell) {
    int half = cells->count / 2;
    Vec3 d = geodesic_center(cells->level, (uint32_t)(cell % half));
    if (cell >= half) d.z = -d.z;
    return world_of_cells(d);
}

static int cell_of(const ProbeCells *cells, Vec3 direction) {
    Vec3 d = cells_of_world(direction);
    int first = d.z < 0 ? cells->count / 2 : 0;
    d.z = fabsf(d.z);
    return first + (int)geodesic_find(cells->geodesic, cells->level, d).id;
}

typedef struct CellSums {
    const ProbeCells *cells;
    float *sums;
} CellSums;

static float *cell_sums(const CellSums *to, int order, int cell) {
    size_t at = (size_t)order * (size_t)to->cells->count + (size_t)cell;
    return to->sums + at * SPECTRUM_LANES;
}

/* One over the density with which calls sample a direction, sr. */
static float sr_of_cell(const ProbeCells *cells, int cell) {
    return cells->samplers[cell % (cells->count / 2)].area * cells->every[cell];
}

/* The balance heuristic (Veach 1997, 9.2.2) of light samples and of ways. */
static void add_cell(void *user, int i, int bounce, const float *share, float pdf) {
    const CellSums *to = user;
    int cell = to->cells->asked[i];
    float sr = sr_of_cell(to->cells, cell);
    add_lanes(cell_sums(to, bounce > 0, cell), sr / (1 + pdf * sr), share);
}

static void add_escaped_cell(void *user, Vec3 direction, int bounce, const float *share,
                             float pdf) {
    const CellSums *to = user;
    int cell = cell_of(to->cells, direction);
    float sought = pdf * sr_of_cell(to->cells, cell);
    add_lanes(cell_sums(to, bounce > 1, cell), pdf > 0 ? sought / (1 + sought) : 1, share);
}

static void draw_cells(const ProbeAim *aim, const ProbeCells *cells, int path, Vec3 *towards) {
    int half = cells->count / 2;
    for (int i = 0; i < cells->asked_count; i++) {
        int cell = cells->asked[i];
        Sampler sampler = sampler_start(aim->seed + 1, cell, 0, (uint32_t)path);
        Vec2 u = sampler_2d(&sampler);
        Vec3 d = geodesic_sampler_draw(&cells->samplers[cell % half], u.x, u.y);
        if (cell >= half) d.z = -d.z;
        towards[i] = world_of_cells(d);
    }
}

void aim_sample_cells(const ProbeAim *asked, const ProbeCells *cells, int first, int end,
                      ProbeAnswers *out, PathStatistics *statistics) {
    PathContext context;
    ProbeAim own = aim_of_first(asked, &context), *aim = &own;
    CellSums to = {cells, out->sums};
    PathDistant distant = {.towards = out->towards,
                           .count = cells->asked_count,
                           .add = add_cell,
                           .add_escaped = add_escaped_cell,
                           .user = &to,
                           .has_ways = true};
    for (int path = first; path < end; path++) {
        draw_cells(aim, cells, path, out->towards);
        DistantCollector questions = distant_collector(&distant);
        trace(aim, path, &questions.base, statistics);
    }
}

/* ---- by suns ----------------------------------------------------------------------------- */

typedef struct SunSums {
    const ProbeSuns *suns;
    float chord2; /* squared distance of unit vectors one radius apart: cosines of
                     such angles have no digits left */
    float *sums;
    float per_sr; /* one over the disc's solid angle */
    long near;    /* ProbeAnswers's */
} SunSums;

static void add_sun(void *user, int i, int bounce, const float *share, float pdf) {
    (void)pdf;
    const SunSums *to = user;
    if (bounce == 0) add_lanes(to->sums + (size_t)i * SPECTRUM_LANES, 1, share);
}

/* The first sun whose y is at least that; count: none. */
static int first_sun_from(const ProbeSuns *suns, float y) {
    int low = 0, high = suns->count;
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (suns->towards[middle].y < y) low = middle + 1;
        else high = middle;
    }
    return low;
}

/* Panes on the way turn a direction by less than what is near a sun. */
static bool asks_sun(void *user, Vec3 direction) {
    SunSums *to = user;
    const ProbeSuns *suns = to->suns;
    float reach = PROBE_NEAR_SUN * sqrtf(to->chord2);
    int i = first_sun_from(suns, direction.y - reach);
    for (; i < suns->count && suns->towards[i].y <= direction.y + reach; i++) {
        Vec3 apart = vec3_sub(direction, suns->towards[i]);
        if (vec3_dot(apart, apart) > reach * reach) continue;
        to->near++;
        return true;
    }
    return false;
}

/* Via the first surface's mirror into each disc that the direction meets. */
static void add_escaped_sun(void *user, Vec3 direction, int bounce, const float *share, float pdf) {
    (void)pdf;
    const SunSums *to = user;
    const ProbeSuns *suns = to->suns;
    if (bounce != 1 || !suns->by_mirror) return;
    float reach = sqrtf(to->chord2);
    int i = first_sun_from(suns, direction.y - reach);
    for (; i < suns->count && suns->towards[i].y <= direction.y + reach; i++) {
        Vec3 apart = vec3_sub(direction, suns->towards[i]);
        if (vec3_dot(apart, apart) <= to->chord2)
            add_lanes(to->sums + (size_t)i * SPECTRUM_LANES, to->per_sr, share);
    }
}

/* Draws a place in the disc, the same in all of them: uniform over its solid angle. */
static void draw_suns(const ProbeAim *aim, const SunSums *to, int path, Vec3 *towards) {
    const ProbeSuns *suns = to->suns;
    Sampler sampler = sampler_start(aim->seed + 2, 0, 0, (uint32_t)path);
    Vec2 u = sampler_2d(&sampler);
    float below = u.x * 0.5f * to->chord2; /* 1 less the cosine */
    float cosine = 1 - below, sine = sqrtf(below * (2 - below)), s, c;
    sincos_turns(u.y, &s, &c);
    for (int i = 0; i < suns->count; i++) {
        Frame frame = frame_from_z(suns->towards[i]);
        towards[i] = frame_to_world(&frame, vec3(sine * c, sine * s, cosine));
    }
}

void aim_sample_suns(const ProbeAim *aim, const ProbeSuns *suns, int first, int end,
                     ProbeAnswers *out, PathStatistics *statistics) {
    double half = sin_d((double)suns->radius / 2);
    float chord2 = (float)(4 * half * half);
    SunSums to = {suns, chord2, out->sums, 1 / (PI_F * chord2), 0};
    int count = suns->by_mirror ? 0 : suns->count;
    PathDistant distant = {.towards = out->towards,
                           .count = count,
                           .add = add_sun,
                           .add_escaped = add_escaped_sun,
                           .user = &to,
                           .asks_mirror = suns->by_mirror ? asks_sun : NULL};
    PathContext once = *aim->context;
    ProbeAim direct = *aim;
    once.max_bounces = 1;
    direct.context = &once;
    for (int path = first; path < end; path++) {
        if (!suns->by_mirror) draw_suns(aim, &to, path, out->towards);
        DistantCollector questions = distant_collector(&distant);
        trace(&direct, path, &questions.base, statistics);
    }
    out->near_suns = to.near;
}

/* ---- mirror images ----------------------------------------------------------------------- */

#define IMAGE_BOUNCES 4

/* The part of the first mirror on the way; NO_ID: there is none, or something scattered. */
static int mirror_of(const PathHistory *history) {
    int part_id = NO_ID;
    for (int i = history->count - 1; i >= 0; i--) {
        if (history->step[i].event == PATH_SCATTERS) return NO_ID;
        if (history->step[i].event == PATH_REFLECTS) part_id = history->step[i].part_id;
    }
    return part_id;
}

static void add_image(void *user, const PathHistory *history, Vec3 direction, const float *share) {
    const ProbeImages *images = user;
    int part_id = mirror_of(history);
    if (part_id != NO_ID) images->found(images->user, part_id, direction, share);
}

void aim_sample_images(const ProbeAim *aim, int first, int end, const ProbeImages *images,
                       PathStatistics *statistics) {
    ProbeImages listener = *images;
    PathImages wanted = {add_image, &listener};
    PathContext once = *aim->context;
    ProbeAim direct = *aim;
    once.max_bounces = IMAGE_BOUNCES;
    direct.context = &once;
    for (int path = first; path < end; path++) {
        HistoryCollector ways = image_collector(&wanted);
        trace(&direct, path, &ways.base, statistics);
    }
}
