/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/response.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "review/light/sky_table.h"

#define WAVE 16     /* chunks that sample every triangle once, */
#define TOGETHER 64 /* and those that are traced before they are added, in order */
#define PILOT 8     /* chunks that sample every triangle */
/* widths of a triangle: what is sampled for a sun; one lies within, or more */
#define NEAR 1.2f
/* Later ones sample a cell that those found in every so manyth chunk: as many rays go out along
 * so many times as many paths, whose noise is greater than that of directions within a
 * triangle. */
#define OFTEN RESPONSE_CLASSES
#define SELDOM (8 * OFTEN) /* a cell that none of those found */

/* ---- which triangles are sampled --------------------------------------------------------- */

static ProbeCells cells_of_level(int level, Arena *arena) {
    int count = (int)geodesic_count(level), octant = count / 4;
    const Geodesic *geodesic = geodesic_create(level, arena);
    GeodesicSampler *samplers = ARENA_NEW(arena, GeodesicSampler, count);
    for (int i = 0; i < count; i++) {
        GeodesicTriangle triangle = geodesic_triangle(level, (uint32_t)i);
        samplers[i] = geodesic_sampler(&triangle, geodesic->areas[level][i % octant]);
    }
    return (ProbeCells){
        .geodesic = geodesic, .samplers = samplers, .level = level, .count = 2 * count};
}

static int slab_of(float y) {
    int slab = (int)floorf((y + 1) * (RESPONSE_SLABS / 2.0f));
    return slab < 0 ? 0 : slab < RESPONSE_SLABS ? slab : RESPONSE_SLABS - 1;
}

/* How seldom each is sampled, of so many times. is_open: NULL: always. */
static void set_every(const bool *is_open, ProbeCells *cells, float *every) {
    for (int cell = 0; cell < cells->count; cell++)
        every[cell] = !is_open ? 1 : is_open[cell] ? OFTEN : SELDOM;
    cells->every = every;
}

/* A chunk's cells: some of the open ones for all of them, a few of the others for many. Cells
 * that follow each other are neighbours and are sampled by different chunks; later by others
 * again, since chunks come back to the same points of a symbol. asked: room for all. */
static ProbeCells cells_of_chunk(const ProbeCells *cells, int chunk, int *asked) {
    ProbeCells part = *cells;
    part.asked_count = 0;
    for (int cell = 0; cell < cells->count; cell++) {
        int every = (int)cells->every[cell];
        if ((cell + chunk + chunk / every) % every) continue;
        asked[part.asked_count++] = cell;
    }
    part.asked = asked;
    return part;
}

/* Those that got something, and all that lie within a triangle's width of them. */
static bool *open_cells(const Response *response, const double *sums, Arena *arena) {
    int count = response->cells.count;
    const Vec3 *centers = response->centers;
    bool *is_open = ARENA_NEW(arena, bool, count);
    size_t order = (size_t)count * RESPONSE_BANDS;
    float reach = 2.2f * sqrtf(4 * PI_F / (float)count), near = cosf(reach);
    for (int i = 0; i < count; i++) {
        double found = 0;
        for (int b = 0; b < RESPONSE_BANDS; b++)
            found += sums[(size_t)i * RESPONSE_BANDS + (size_t)b] +
                     sums[order + (size_t)i * RESPONSE_BANDS + (size_t)b];
        if (!(found > 0)) continue;
        int end = response->slab_first[slab_of(centers[i].y + reach) + 1];
        for (int k = response->slab_first[slab_of(centers[i].y - reach)]; k < end; k++)
            is_open[response->slabs[k]] |=
                vec3_dot(centers[i], centers[response->slabs[k]]) >= near;
    }
    return is_open;
}

/* ---- tracing ----------------------------------------------------------------------------- */

typedef struct Trace {
    const ProbeAim *aim;
    const ResponseOptions *options;
    const ProbeCells *cells;
    int first_chunk, chunks; /* that are traced together */
    int *asked[TOGETHER];    /* cells of a chunk, */
    Vec3 *towards[TOGETHER];
    float *tables[TOGETHER];         /* its sums, */
    double sent[TOGETHER];           /* and all of them */
    double *sums;                    /* over all chunks */
    double *groups;                  /* as a response's, sums */
    double reading[RESPONSE_GROUPS]; /* under a uniform sky */
    float white[RESPONSE_BANDS];
} Trace;

/* A wave samples every open triangle once, so that groups of whole waves are alike. */
static int group_of(int chunk) {
    return chunk < PILOT ? 0 : (chunk - PILOT) / WAVE % RESPONSE_GROUPS;
}

/* How many of the first so many chunks are of a group. */
static int group_chunks(int group, int chunks) {
    int waves = chunks > PILOT ? (chunks - PILOT) / WAVE : 0;
    int left = chunks > PILOT ? (chunks - PILOT) % WAVE : 0;
    int own = (waves - group + RESPONSE_GROUPS - 1) / RESPONSE_GROUPS * WAVE;
    own += waves % RESPONSE_GROUPS == group ? left : 0;
    return own + (group ? 0 : chunks < PILOT ? chunks : PILOT);
}

static int groups_used(int chunks) {
    int used = 0;
    while (used < RESPONSE_GROUPS && group_chunks(used, chunks) > 0) used++;
    return used;
}

static size_t table_size(const ProbeCells *cells) {
    return (size_t)PROBE_ORDERS * (size_t)cells->count * RESPONSE_BANDS;
}

static size_t groups_size(const ProbeCells *cells) {
    return (size_t)cells->count * 2 * RESPONSE_GROUPS;
}

static void trace_chunk(void *user, int item, int worker) {
    (void)worker;
    Trace *trace = user;
    PathStatistics statistics = {0};
    int chunk = trace->first_chunk + item;
    int group = group_of(chunk);
    int first = group_chunks(group, chunk) * RESPONSE_CHUNK;
    size_t size = table_size(trace->cells);
    ProbeAim aim = *trace->aim; /* a stream of the group's own */
    aim.seed = hash_combine(hash_u32(aim.seed), (uint32_t)group);
    aim.is_spread = true;
    memset(trace->tables[item], 0, size * sizeof(float));
    ProbeCells part = cells_of_chunk(trace->cells, chunk - PILOT, trace->asked[item]);
    ProbeAnswers answers = {trace->tables[item], trace->towards[item], 0};
    trace->options->tools.kernel->sample_cells(&aim, &part, first, first + RESPONSE_CHUNK, &answers,
                                               &statistics);
    double sent = 0;
    for (size_t i = 0; i < size; i++) sent += (double)trace->tables[item][i];
    trace->sent[item] = sent;
}

#define ADD_CELLS 512 /* in one piece of work */

static void add_chunk(Trace *trace, int chunk, int first, int end) {
    size_t order = (size_t)trace->cells->count * RESPONSE_BANDS;
    const float *table = trace->tables[chunk];
    int group = group_of(trace->first_chunk + chunk);
    for (int cell = first; cell < end; cell++) {
        size_t at = (size_t)cell * RESPONSE_BANDS;
        const float *shares = table + at;
        double *to = trace->groups + (size_t)cell * 2 * RESPONSE_GROUPS;
        for (size_t b = at; b < at + RESPONSE_BANDS; b++) {
            trace->sums[b] += (double)table[b];
            trace->sums[order + b] += (double)table[order + b];
        }
        double rest = light_bands_sum(shares + order, trace->white);
        to[group] += light_bands_sum(shares, trace->white) + rest;
        to[RESPONSE_GROUPS + group] += rest;
    }
}

static void add_cells(void *user, int item, int worker) {
    (void)worker;
    Trace *trace = user;
    int first = item * ADD_CELLS, end = first + ADD_CELLS, count = trace->cells->count;
    for (int k = 0; k < trace->chunks; k++) add_chunk(trace, k, first, end < count ? end : count);
}

static void trace_some(Trace *trace, int chunks) {
    int threads = trace->options->tools.threads, count = trace->cells->count;
    trace->chunks = chunks;
    parallel_for(threads, chunks, trace_chunk, trace);
    parallel_for(threads, (count + ADD_CELLS - 1) / ADD_CELLS, add_cells, trace);
    for (int k = 0; k < chunks; k++)
        trace->reading[group_of(trace->first_chunk + k)] += trace->sent[k];
    trace->first_chunk += chunks;
}

static Trace trace_start(const ProbeAim *aim, const ResponseOptions *options,
                         const ProbeCells *cells, Arena *arena) {
    Trace trace = {.aim = aim, .options = options, .cells = cells};
    trace.sums = ARENA_NEW(arena, double, table_size(cells));
    trace.groups = ARENA_NEW(arena, double, groups_size(cells));
    light_bands_white(trace.white);
    for (int k = 0; k < TOGETHER; k++) {
        trace.tables[k] = ARENA_NEW(arena, float, table_size(cells));
        trace.towards[k] = ARENA_NEW(arena, Vec3, cells->count);
        trace.asked[k] = ARENA_NEW(arena, int, cells->count);
    }
    return trace;
}

/* Groups may differ by a wave. */
static double relative_error(const Trace *trace) {
    BatchSums means = {0};
    int groups = groups_used(trace->first_chunk);
    double n = trace->first_chunk, sum = 0;
    for (int i = 0; i < groups; i++) sum += trace->reading[i];
    for (int i = 0; i < groups; i++) {
        double share = group_chunks(i, trace->first_chunk) / n;
        batch_add(&means, (trace->reading[i] - share * sum) * groups);
    }
    return sum > 0 && groups > 1 ? batch_error(&means) / sum : 0;
}

/* Counting sort: within a slab in the order of the cells. */
static void sort_slabs(Response *response, Arena *arena) {
    int count = response->cells.count;
    int *first = ARENA_NEW(arena, int, RESPONSE_SLABS + 1);
    int *slabs = ARENA_NEW(arena, int, count), next[RESPONSE_SLABS];
    for (int i = 0; i < count; i++) first[slab_of(response->centers[i].y) + 1]++;
    for (int k = 0; k < RESPONSE_SLABS; k++) {
        first[k + 1] += first[k];
        next[k] = first[k];
    }
    for (int i = 0; i < count; i++) slabs[next[slab_of(response->centers[i].y)]++] = i;
    response->slabs = slabs;
    response->slab_first = first;
}

float *response_empty(int level, Arena *arena, Response *out) {
    *out = (Response){.cells = cells_of_level(level, arena)};
    size_t size = table_size(&out->cells);
    float *shares = ARENA_NEW(arena, float, size + groups_size(&out->cells));
    Vec3 *centers = ARENA_NEW(arena, Vec3, out->cells.count);
    for (int i = 0; i < out->cells.count; i++) centers[i] = aim_cell_center(&out->cells, i);
    out->centers = centers;
    sort_slabs(out, arena);
    out->first = shares;
    out->rest = shares + size / PROBE_ORDERS;
    out->groups = shares + size;
    return shares;
}

void response_trace(const ProbeAim *aim, const ResponseOptions *options, Arena *arena,
                    Response *out) {
    int chunks = options->paths / RESPONSE_CHUNK;
    float *shares = response_empty(options->level, arena, out);
    Arena scratch = *arena;
    ProbeCells cells = out->cells;
    float *every = ARENA_NEW(&scratch, float, cells.count);
    Trace trace = trace_start(aim, options, &cells, &scratch);
    set_every(NULL, &cells, every);
    trace_some(&trace, chunks < PILOT ? chunks : PILOT);
    set_every(open_cells(out, trace.sums, &scratch), &cells, every);
    while (trace.first_chunk < chunks && (trace.first_chunk < PILOT + RESPONSE_GROUPS * WAVE ||
                                          relative_error(&trace) > options->precision)) {
        int left = chunks - trace.first_chunk;
        trace_some(&trace, left < TOGETHER ? left : TOGETHER);
    }
    out->paths = trace.first_chunk * RESPONSE_CHUNK;
    for (size_t i = 0; i < table_size(&out->cells); i++)
        shares[i] = (float)(trace.sums[i] / out->paths);
    shares += table_size(&out->cells);
    for (size_t i = 0; i < groups_size(&out->cells); i++)
        shares[i] = (float)(trace.groups[i] / out->paths);
    out->relative_error = relative_error(&trace);
}

/* ---- reading ----------------------------------------------------------------------------- */

/* Sums of a plane that is fitted to what cells about a direction send, by weight: value and
 * slopes. Without slopes a direction that lies to one side of its cells would read what those
 * send. */
typedef struct PlaneFit {
    double moment[3][3], sum[3]; /* products of 1, x, y; of these and the value */
    double least, most;
} PlaneFit;

static void fit_add(PlaneFit *fit, double weight, const double at[3], double value) {
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) fit->moment[i][j] += weight * at[i] * at[j];
        fit->sum[i] += weight * at[i] * value;
    }
    fit->least = fmin(fit->least, value);
    fit->most = fmax(fit->most, value);
}

static double minor(const PlaneFit *fit, int i, int j) {
    const double(*m)[3] = fit->moment;
    int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
}

/* Where x and y are 0, by Cramer's rule, and no more than any cell sends. The mean where cells
 * lie too oddly for slopes. */
static double fit_value(const PlaneFit *fit) {
    double all = 0, value = 0;
    double spread = fit->moment[0][0] * (fit->moment[1][1] + fit->moment[2][2]);
    for (int i = 0; i < 3; i++) {
        all += minor(fit, i, 0) * fit->moment[i][0];
        value += minor(fit, i, 0) * fit->sum[i];
    }
    if (!(all > 1e-3 * spread * (fit->moment[1][1] + fit->moment[2][2])))
        return fit->sum[0] / fit->moment[0][0];
    return fmin(fmax(value / all, fit->least), fit->most);
}

double response_without(const Response *response, int group, double sum, double of_group) {
    int chunks = response->paths / RESPONSE_CHUNK;
    return (sum - of_group) * chunks / fmax(chunks - group_chunks(group, chunks), 1);
}

/* Jackknife: K x - (K - 1) x_k are as good as K independent readings (Miller, Biometrika 61
 * (1974) 1), also of what is no mean, such as a fit. */
MeanInterval response_interval(const Response *response, double reading,
                               const double without[RESPONSE_GROUPS]) {
    BatchSums values = {0};
    int groups = groups_used(response->paths / RESPONSE_CHUNK);
    if (groups < 2) return (MeanInterval){-INFINITY, INFINITY};
    for (int k = 0; k < groups; k++)
        batch_add(&values, groups * reading - (groups - 1) * without[k]);
    double off = reading - values.sum / groups;
    MeanInterval in = batch_interval(&values);
    return (MeanInterval){in.low + off, in.high + off};
}

#define NEAR_MOST 64 /* triangles about a direction; some 5 to 10 lie there */

/* A triangle near a direction. */
typedef struct NearCell {
    int cell;
    double weight, area, at[3];
} NearCell;

static int compare_cells(const void *a, const void *b) {
    return ((const NearCell *)a)->cell - ((const NearCell *)b)->cell;
}

/* In the order of cells. */
static int near_cells(const Response *response, Vec3 towards, NearCell near[NEAR_MOST]) {
    const ProbeCells *cells = &response->cells;
    Frame frame = frame_from_z(towards);
    float width = NEAR * sqrtf(4 * PI_F / (float)cells->count), least = cosf(width);
    int count = 0;
    int low = response->slab_first[slab_of(towards.y - width)];
    int high = response->slab_first[slab_of(towards.y + width) + 1];
    for (int i = low; i < high && count < NEAR_MOST; i++) {
        int cell = response->slabs[i];
        Vec3 center = response->centers[cell];
        float cosine = vec3_dot(towards, center);
        if (cosine <= least) continue;
        double area = (double)cells->samplers[cell % (cells->count / 2)].area;
        double weight = 1 - (double)(acosf(fminf(cosine, 1)) / width);
        near[count++] =
            (NearCell){cell,
                       weight * area,
                       area,
                       {1, (double)vec3_dot(frame.x, center), (double)vec3_dot(frame.y, center)}};
    }
    qsort(near, (size_t)count, sizeof *near, compare_cells);
    return count;
}

static double fit_of(const NearCell *near, int count, const double *values) {
    PlaneFit fit = {.least = INFINITY, .most = -INFINITY};
    for (int i = 0; i < count; i++)
        fit_add(&fit, near[i].weight, near[i].at, values[i] / near[i].area);
    return fit_value(&fit);
}

/* Each group's part of white light via further vertices. */
static const float *rest_groups(const Response *response, int cell) {
    return response->groups + ((size_t)cell * 2 + 1) * RESPONSE_GROUPS;
}

/* The fit for white light. group: left out; RESPONSE_GROUPS: none. */
static double white_fit(const Response *response, const NearCell *near, int count, int group) {
    double values[NEAR_MOST] = {0};
    for (int i = 0; i < count; i++) {
        const float *rest = rest_groups(response, near[i].cell);
        values[i] = 0;
        for (int k = 0; k < RESPONSE_GROUPS; k++) values[i] += (double)rest[k];
        if (group < RESPONSE_GROUPS)
            values[i] = response_without(response, group, values[i], (double)rest[group]);
    }
    return fit_of(near, count, values);
}

/* The groups' parts of a reading via each triangle: a wave samples that with the paths of
 * one chunk. */
static void add_samples(const Response *response, const NearCell *near, int count, double reading,
                        BrightSamples *to) {
    double white = 0;
    for (int i = 0; i < count; i++) {
        const float *rest = rest_groups(response, near[i].cell);
        for (int k = 0; k < RESPONSE_GROUPS; k++)
            white += near[i].weight / near[i].area * (double)rest[k];
    }
    for (int i = 0; i < count && white > 0; i++) {
        const float *rest = rest_groups(response, near[i].cell);
        double share = near[i].weight / near[i].area * reading / white;
        for (int k = 0; k < RESPONSE_GROUPS; k++) bright_add(to, share * (double)rest[k]);
    }
}

double response_sun(const Response *response, Vec3 towards, const float bands[RESPONSE_BANDS],
                    double without[RESPONSE_GROUPS], BrightSamples *bright) {
    NearCell near[NEAR_MOST] = {{0}};
    double values[NEAR_MOST] = {0};
    int count = near_cells(response, towards, near);
    for (int i = 0; i < count; i++)
        values[i] = light_bands_sum(response->rest + (size_t)near[i].cell * RESPONSE_BANDS, bands);
    double reading = fit_of(near, count, values);
    double white = without ? white_fit(response, near, count, RESPONSE_GROUPS) : 0;
    for (int k = 0; k < RESPONSE_GROUPS && without; k++)
        without[k] = white > 0 ? reading * white_fit(response, near, count, k) / white : reading;
    if (without) add_samples(response, near, count, reading, bright);
    return reading;
}

bool response_reaches(const Response *response, Vec3 towards) {
    NearCell near[NEAR_MOST] = {{0}};
    int count = near_cells(response, towards, near);
    for (int i = 0; i < count; i++) {
        const float *first = response->first + (size_t)near[i].cell * RESPONSE_BANDS;
        for (int b = 0; b < RESPONSE_BANDS; b++)
            if (first[b] > 0) return true;
    }
    return false;
}
