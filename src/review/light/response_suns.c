/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/response_suns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "review/light/sky_table.h"

/* Paths of one piece of work: pieces are added in order. By mirror a path reaches few suns. */
#define SUN_CHUNK 4
#define MIRROR_CHUNK 1024
#define NEAR_CHUNK 64
#define SUN_BYTES ((size_t)16 << 20) /* tables that are not added yet */

typedef struct SunTrace {
    const ProbeAim *aim;
    const ResponseOptions *options;
    const ProbeSuns *suns;
    float *tables;
    Vec3 *towards;
    long *near;       /* of pieces: ProbeAnswers's */
    int first, paths; /* first path of the pieces in hand; all paths */
    int chunk;
    bool is_by_target; /* a piece is a target's */
} SunTrace;

/* The aim at one of its targets. */
static ProbeAim aim_at_target(const ProbeAim *aim, int target) {
    ProbeAim one = *aim;
    one.targets = aim->targets + target;
    one.patches = aim->patches ? aim->patches + target : NULL;
    one.target_count = 1;
    return one;
}

static void trace_suns(void *user, int item, int worker) {
    (void)worker;
    SunTrace *trace = user;
    PathStatistics statistics = {0};
    size_t count = (size_t)trace->suns->count;
    float *table = trace->tables + (size_t)item * count * RESPONSE_BANDS;
    int first = trace->first + item * trace->chunk, end = first + trace->chunk;
    ProbeAim aim =
        trace->is_by_target ? aim_at_target(trace->aim, first / trace->chunk) : *trace->aim;
    memset(table, 0, count * RESPONSE_BANDS * sizeof(float));
    ProbeAnswers answers = {table, trace->towards + (size_t)item * count, 0};
    trace->options->kernel->sample_suns(
        &aim, trace->suns, first, end < trace->paths ? end : trace->paths, &answers, &statistics);
    trace->near[item] = answers.near_suns;
}

#define MIRROR_HITS 1024.0 /* paths that meet the sun's image, evenly: 0.6 % */
#define MIRROR_PATHS_LEAST 4096.0
#define MIRROR_PATHS_MOST 4194304.0

/* As the eye sees the patches, so large is the part of the sky in them: a flat mirror keeps
 * solid angles. */
int response_mirror_paths(const ProbeAim *aim, float radius) {
    double seen = 0, sun = (double)(PI_F * radius * radius);
    for (int i = 0; i < aim->target_count && aim->patches; i++) {
        Vec3 to = vec3_sub(aim->targets[i], aim->eye);
        Vec3 area = vec3_cross(aim->patches[i].along, aim->patches[i].down);
        float squared = vec3_dot(to, to);
        seen += (double)(fabsf(vec3_dot(area, to)) / (squared * sqrtf(squared)));
    }
    return (int)fmin(fmax(MIRROR_HITS * seen / sun, MIRROR_PATHS_LEAST), MIRROR_PATHS_MOST);
}

typedef struct SunHeight {
    float y;
    int sun;
} SunHeight;

static int compare_heights(const void *a, const void *b) {
    const SunHeight *left = a, *right = b;
    if (left->y != right->y) return left->y < right->y ? -1 : 1;
    return (left->sun > right->sun) - (left->sun < right->sun);
}

/* order[i]: which sun is the i-th from below. */
static int *rising_order(const ProbeSuns *suns, Arena *arena) {
    int *order = ARENA_NEW(arena, int, suns->count);
    Arena scratch = *arena;
    SunHeight *heights = ARENA_NEW(&scratch, SunHeight, suns->count);
    for (int i = 0; i < suns->count; i++) heights[i] = (SunHeight){suns->towards[i].y, i};
    qsort(heights, (size_t)suns->count, sizeof *heights, compare_heights);
    for (int i = 0; i < suns->count; i++) order[i] = heights[i].sun;
    return order;
}

/* What is sampled by target. */
typedef struct TargetSums {
    const float *weights;
    double *of;       /* [sun][target] */
    const int *order; /* which sun is the i-th of a table */
    int targets;
} TargetSums;

static void add_target(const SunTrace *trace, const float *table, int target,
                       const TargetSums *to) {
    for (int i = 0; i < trace->suns->count; i++)
        to->of[(size_t)to->order[i] * (size_t)to->targets + (size_t)target] =
            light_bands_sum(table + (size_t)i * RESPONSE_BANDS, to->weights) / trace->chunk;
}

/* sums: [sun][band] over all paths. to: NULL: not by target. */
static void sum_suns(SunTrace *trace, int pieces, double *sums, const TargetSums *to) {
    size_t size = (size_t)trace->suns->count * RESPONSE_BANDS;
    for (; trace->first < trace->paths; trace->first += pieces * trace->chunk) {
        int left = (trace->paths - trace->first + trace->chunk - 1) / trace->chunk;
        int now = left < pieces ? left : pieces;
        parallel_for(trace->options->threads, now, trace_suns, trace);
        for (int k = 0; k < now; k++) {
            const float *table = trace->tables + (size_t)k * size;
            for (size_t i = 0; i < size; i++) sums[i] += (double)table[i];
            if (to) add_target(trace, table, trace->first / trace->chunk + k, to);
        }
    }
}

/* As many as their tables have room for: threads wait for each other after so many. */
static int pieces_at_once(const SunTrace *trace) {
    size_t room = SUN_BYTES / ((size_t)trace->suns->count * RESPONSE_BANDS * sizeof(float) + 1);
    int all = (trace->paths + trace->chunk - 1) / trace->chunk;
    int most = room < (size_t)all ? (int)room : all;
    return most > trace->options->threads ? most : trace->options->threads;
}

/* Of one sun: does a share of the paths find no mirror direction near it? These are well spread:
 * what of a mirror is within PROBE_NEAR_SUN radii of the sun, wherever on its rim the image lies,
 * gets as many of them as the whole image of all. */
static bool is_far_from_mirror(const SunTrace *of, int pieces) {
    SunTrace some = *of;
    some.is_by_target = false;
    some.chunk = NEAR_CHUNK;
    some.paths = of->paths / (PROBE_NEAR_SUN * PROBE_NEAR_SUN);
    long near = 0;
    if (!of->suns->by_mirror || of->suns->count != 1) return false;
    for (; some.first < some.paths && !near; some.first += pieces * some.chunk) {
        int left = (some.paths - some.first + some.chunk - 1) / some.chunk;
        int now = left < pieces ? left : pieces;
        parallel_for(some.options->threads, now, trace_suns, &some);
        for (int k = 0; k < now; k++) near += some.near[k];
    }
    return !near;
}

static int paths_of_target(const ProbeAim *aim, const ResponseOptions *options) {
    return (options->paths + aim->target_count - 1) / aim->target_count;
}

/* to: its order is set; of NULL: not by target. */
static const float *suns_of(const ProbeAim *aim, const ResponseOptions *options,
                            const ProbeSuns *suns, TargetSums *to, Arena *arena) {
    size_t count = (size_t)suns->count;
    float *shares = ARENA_NEW(arena, float, count *RESPONSE_BANDS);
    Arena scratch = *arena;
    ProbeAim spread = *aim; /* few paths see all of what is looked at, too */
    ProbeSuns rising = *suns;
    int *order = rising_order(suns, &scratch);
    Vec3 *towards = ARENA_NEW(&scratch, Vec3, count);
    double *sums = ARENA_NEW(&scratch, double, count *RESPONSE_BANDS);
    for (size_t i = 0; i < count; i++) towards[i] = suns->towards[order[i]];
    rising.towards = towards;
    spread.is_spread = true;
    SunTrace trace = {.aim = &spread,
                      .options = options,
                      .suns = &rising,
                      .paths = options->paths,
                      .is_by_target = to->of != NULL,
                      .chunk = suns->by_mirror ? MIRROR_CHUNK : SUN_CHUNK};
    to->order = order;
    if (to->of) trace.chunk = paths_of_target(aim, options);
    if (to->of) trace.paths = trace.chunk * aim->target_count;
    size_t pieces = (size_t)pieces_at_once(&trace);
    trace.tables = ARENA_NEW(&scratch, float, count *RESPONSE_BANDS *pieces);
    trace.towards = ARENA_NEW(&scratch, Vec3, count * pieces);
    trace.near = ARENA_NEW(&scratch, long, pieces);
    if (is_far_from_mirror(&trace, (int)pieces)) return shares;
    sum_suns(&trace, (int)pieces, sums, to->of ? to : NULL);
    for (size_t i = 0; i < count; i++)
        for (int b = 0; b < RESPONSE_BANDS; b++)
            shares[(size_t)order[i] * RESPONSE_BANDS + (size_t)b] =
                (float)(sums[i * RESPONSE_BANDS + (size_t)b] / trace.paths);
    return shares;
}

const float *response_suns(const ProbeAim *aim, const ResponseOptions *options,
                           const ProbeSuns *suns, Arena *arena) {
    TargetSums none = {.of = NULL};
    return suns_of(aim, options, suns, &none, arena);
}

/* The same with what each of the aim's targets sends by itself: by_target[sun][target], the sum
 * over bands of shares times weights. Every target has as many paths. */
static const float *suns_by_target(const ProbeAim *aim, const ResponseOptions *options,
                                   const ProbeSuns *suns, const float weights[RESPONSE_BANDS],
                                   double *by_target, Arena *arena) {
    TargetSums to = {.weights = weights, .of = by_target, .targets = aim->target_count};
    return suns_of(aim, options, suns, &to, arena);
}

/* ---- by parts ---------------------------------------------------------------------------- */

#define BLOCK 4096 /* suns whose targets are kept apart together */

static bool is_any(const float shares[RESPONSE_BANDS]) {
    for (int b = 0; b < RESPONSE_BANDS; b++)
        if (shares[b] > 0) return true;
    return false;
}

/* Of one sun, by its targets; what all of them send on the average becomes the worst part's. */
static void take_worst(const LightParts *parts, const double *by_target,
                       float shares[RESPONSE_BANDS], Arena scratch) {
    double *means = ARENA_NEW(&scratch, double, light_parts_count(parts));
    double all = 0;
    int worst = light_parts_worst(parts, by_target, means, NULL, scratch);
    for (int i = 0; i < parts->aim.target_count; i++) all += by_target[i];
    if (worst < 0 || !(all > 0)) return;
    double ratio = means[worst] * parts->aim.target_count / all;
    for (int b = 0; b < RESPONSE_BANDS; b++) shares[b] *= (float)ratio;
}

/* shares: [sun][band], set. */
static void sample_block(const LightParts *parts, const ResponseOptions *options,
                         const ProbeSuns *suns, float *shares, Arena scratch) {
    size_t targets = (size_t)parts->aim.target_count;
    double *by_target = ARENA_NEW(&scratch, double, (size_t)suns->count *targets);
    float white[RESPONSE_BANDS];
    light_bands_white(white);
    const float *all = suns_by_target(&parts->aim, options, suns, white, by_target, &scratch);
    memcpy(shares, all, (size_t)suns->count * RESPONSE_BANDS * sizeof *shares);
    for (int i = 0; i < suns->count; i++)
        if (is_any(shares + (size_t)i * RESPONSE_BANDS))
            take_worst(parts, by_target + (size_t)i * targets, shares + (size_t)i * RESPONSE_BANDS,
                       scratch);
}

static void sample_blocks(const LightParts *parts, const ResponseOptions *options,
                          const ProbeSuns *suns, float *shares, Arena scratch) {
    for (int first = 0; first < suns->count; first += BLOCK) {
        ProbeSuns block = *suns;
        block.towards += first;
        block.count = suns->count - first < BLOCK ? suns->count - first : BLOCK;
        sample_block(parts, options, &block, shares + (size_t)first * RESPONSE_BANDS, scratch);
    }
}

/* Few suns of many have their image in what is looked at: those alone are sampled by target. */
static void sample_mirrored(const LightParts *parts, const ResponseOptions *options,
                            const ProbeSuns *suns, float *shares, Arena scratch) {
    const float *all = response_suns(&parts->aim, options, suns, &scratch);
    int *list = ARENA_NEW(&scratch, int, suns->count);
    Vec3 *towards = ARENA_NEW(&scratch, Vec3, suns->count);
    ProbeSuns some = *suns;
    some.towards = towards;
    some.count = 0;
    for (int i = 0; i < suns->count; i++) {
        if (!is_any(all + (size_t)i * RESPONSE_BANDS)) continue;
        towards[some.count] = suns->towards[i];
        list[some.count++] = i;
    }
    float *of_some = ARENA_NEW(&scratch, float, (size_t)some.count *RESPONSE_BANDS);
    sample_blocks(parts, options, &some, of_some, scratch);
    for (int i = 0; i < some.count; i++)
        memcpy(shares + (size_t)list[i] * RESPONSE_BANDS, of_some + (size_t)i * RESPONSE_BANDS,
               RESPONSE_BANDS * sizeof *shares);
}

const float *sun_parts_worst(const ProbeAim *aim, const LightParts *parts,
                             const ResponseOptions *options, const ProbeSuns *suns, Arena *arena) {
    if (!parts) return response_suns(aim, options, suns, arena);
    float *shares = ARENA_NEW(arena, float, (size_t)suns->count *RESPONSE_BANDS);
    (suns->by_mirror ? sample_mirrored : sample_blocks)(parts, options, suns, shares, *arena);
    return shares;
}

static double add_light(const LightParts *parts, const ResponseOptions *options,
                        const ProbeSuns *sun, const float bands[RESPONSE_BANDS], double *of,
                        Arena scratch) {
    double *by_target = ARENA_NEW(&scratch, double, parts->aim.target_count), sum = 0;
    suns_by_target(&parts->aim, options, sun, bands, by_target, &scratch);
    for (int i = 0; i < parts->aim.target_count; i++) {
        of[i] += by_target[i];
        sum += by_target[i];
    }
    return sum / parts->aim.target_count;
}

double sun_parts_light(const LightParts *parts, const ResponseOptions *options,
                       const ProbeSuns *sun, const float bands[RESPONSE_BANDS], double *of,
                       Arena scratch) {
    ProbeSuns once = *sun;
    ResponseOptions by_mirror = *options;
    once.by_mirror = false;
    add_light(parts, options, &once, bands, of, scratch);
    once.by_mirror = true;
    by_mirror.paths = response_mirror_paths(&parts->aim, sun->radius);
    return add_light(parts, &by_mirror, &once, bands, of, scratch);
}
