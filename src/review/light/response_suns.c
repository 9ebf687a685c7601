/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/response_suns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/sampler.h"
#include "base/units.h"
#include "review/light/sky_table.h"

/* Paths of one piece of work: pieces are added in order. By mirror a path reaches few suns. */
#define SUN_CHUNK 4
#define MIRROR_CHUNK 1024
#define NEAR_CHUNK 64
#define SUN_BYTES ((size_t)16 << 20) /* tables that are not added yet */

/* What is sampled by target. */
typedef struct TargetSums {
    const float *weights;
    double *of;       /* [sun][target] */
    const int *order; /* which sun is the i-th of a table */
    int targets;
} TargetSums;

typedef struct SunTrace {
    const ProbeAim *aim;
    const ProbeSuns *suns;
    int paths, chunk;     /* all of them; those of a piece */
    double *sums;         /* [sun][band] over all paths; NULL: those near a sun are counted alone */
    const TargetSums *to; /* a piece is a target's; NULL: not by target */
    long near;            /* ProbeAnswers's */
} SunTrace;

static void begin_suns(ProbePart *to, Arena *arena) {
    const SunTrace *trace = to->user;
    ProbePiece *piece = to->piece;
    ProbeAnswers *answers = to->own;
    answers->sums = ARENA_NEW(arena, float, (size_t)trace->suns->count *RESPONSE_BANDS);
    answers->towards = ARENA_NEW(arena, Vec3, trace->suns->count);
    if (trace->to) { /* the aim at one of its targets */
        piece->aim.targets += piece->id;
        if (piece->aim.patches) piece->aim.patches += piece->id;
        piece->aim.target_count = 1;
    }
    if (piece->end > trace->paths) piece->end = trace->paths;
}

static void ask_suns(const ProbePart *to, const Kernel *kernel) {
    ProbePiece *piece = to->piece;
    kernel->sample_suns(&piece->aim, ((const SunTrace *)to->user)->suns, piece->first, piece->end,
                        to->own, &piece->statistics);
}

static void merge_suns(const ProbePart *from) {
    SunTrace *trace = from->user;
    const ProbeAnswers *answers = from->own;
    const TargetSums *to = trace->to;
    size_t count = (size_t)trace->suns->count, target = (size_t)from->piece->id;
    trace->near += answers->near_suns;
    for (size_t i = 0; i < count * RESPONSE_BANDS && trace->sums; i++)
        trace->sums[i] += (double)answers->sums[i];
    for (size_t i = 0; i < count && to; i++)
        to->of[(size_t)to->order[i] * (size_t)to->targets + target] =
            light_bands_sum(answers->sums + i * RESPONSE_BANDS, to->weights) / trace->chunk;
}

/* As many pieces at once as their tables have room for: threads wait for each other after so
 * many. */
static void trace_suns(SunTrace *trace, const ProbeTools *tools, Arena scratch) {
    size_t room = SUN_BYTES / ((size_t)trace->suns->count * RESPONSE_BANDS * sizeof(float) + 1);
    ProbeGoal goal = {.pieces = (trace->paths + trace->chunk - 1) / trace->chunk,
                      .paths = trace->chunk,
                      .at_once = (int)room > tools->threads ? (int)room : tools->threads};
    ProbeFold fold = {.user = trace,
                      .bytes = sizeof(ProbeAnswers),
                      .begin = begin_suns,
                      .ask = ask_suns,
                      .merge = merge_suns};
    probe_read(trace->aim, &goal, tools, &fold, 1, scratch);
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

/* Of one sun: does a share of the paths find no mirror direction near it? These are well spread:
 * what of a mirror is within PROBE_NEAR_SUN radii of the sun, wherever on its rim the image lies,
 * gets as many of them as the whole image of all. */
static bool is_far_from_mirror(const SunTrace *of, const ProbeTools *tools, Arena scratch) {
    SunTrace some = *of;
    some.to = NULL;
    some.sums = NULL;
    some.chunk = NEAR_CHUNK;
    some.paths = of->paths / (PROBE_NEAR_SUN * PROBE_NEAR_SUN);
    if (!of->suns->by_mirror || of->suns->count != 1) return false;
    trace_suns(&some, tools, scratch);
    return !some.near;
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
                      .suns = &rising,
                      .paths = options->paths,
                      .sums = sums,
                      .to = to->of ? to : NULL,
                      .chunk = suns->by_mirror ? MIRROR_CHUNK : SUN_CHUNK};
    to->order = order;
    if (to->of) {
        trace.chunk = (options->paths + aim->target_count - 1) / aim->target_count;
        trace.paths = trace.chunk * aim->target_count;
    }
    if (is_far_from_mirror(&trace, &options->tools, scratch)) return shares;
    trace_suns(&trace, &options->tools, scratch);
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
