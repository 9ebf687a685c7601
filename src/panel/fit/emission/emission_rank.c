/* SPDX-License-Identifier: Apache-2.0 */
/* Few components for all tables: a model of low rank of the logarithms, fitted to the numbers
 * themselves with their own noise, so that what drowns in noise (or is below the black pattern)
 * weighs little and is determined by what it has in common with the rest.
 *
 * Gauss-Newton on M = M_black + exp(model), directions and channels in turn, with Huber's
 * weights against rows that stand out. */
#include "panel/fit/emission/emission_rank.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/sort.h"
#include "panel/fit/common/small_matrix.h"
#include "panel/shape/least_squares.h"
#include "panel/query/panel_components.h"

#define COMPONENTS_MAX 24
#define ITERATIONS 6
#define PATIENCE 3         /* so many more components without any gain are enough */
#define ASKED_ROWS 5000    /* loadings are found from about so many */
#define HUBER 4.0          /* sigmas */
#define UNKNOWN_BLACK 0.1f /* relative error of a black estimated from neighbours */
#define STRAY 0.3          /* a sample this far off, */
#define STRAYS 1e-3        /* and with few like it, is none that a component is made for */
#define SCORE_MOST 1e3
#define PRIOR 400.0 /* 1/variance: a channel's loadings against a brighter one's */

float emission_rank_fall(float cosine_power, Vec3 direction) {
    return cosine_power * log_f(clampf(direction.z, PANEL_LEAST_COS, 1));
}

void emission_rank_logs(const EmissionRank *rank, int channels, const float *components, float fall,
                        float *logs) {
    for (int c = 0; c < channels; c++) {
        const float *loading = rank->loading + c * rank->components;
        float sum = fall + rank->mean[c];
        for (int k = 0; k < rank->components; k++) sum += loading[k] * components[k];
        logs[c] = sum;
    }
}

/* ---- the start ------------------------------------------------------------------------- */

static bool is_black_channel(const EmissionSamples *s, int channel) {
    return s->black >= 0 && channel >= s->black;
}

static size_t number(const EmissionSamples *s, int row, int channel) {
    return (size_t)row * (size_t)s->channels + (size_t)channel;
}

/* E = M - M_black and its standard deviation. */
static float added_light(const EmissionSamples *s, int row, int channel, float *sigma) {
    size_t at = number(s, row, channel);
    *sigma = s->sigma[at];
    if (s->black < 0 || is_black_channel(s, channel)) return s->total[at];
    size_t dark = number(s, row, s->black + channel % 3);
    float dim = isinf(s->sigma[dark]) ? UNKNOWN_BLACK * s->total[dark] : s->sigma[dark];
    *sigma = sqrtf(*sigma * *sigma + dim * dim);
    return s->total[at] - s->total[dark];
}

/* d ln E / d ln cos theta of a channel over the last fifth of the cone; false: no light. */
static bool channel_power(const EmissionSamples *s, int channel, double *power) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < s->rows; i++) {
        float sigma, e = added_light(s, i, channel, &sigma);
        double z = (double)s->direction[i].z;
        if (acos_d(fmin(1, z)) < 0.8 * s->cone || z < (double)PANEL_LEAST_COS) continue;
        if (!(e > 5 * sigma)) continue;
        double u = log_d(z), v = log_d((double)e);
        n++, x += u, y += v, xx += u * u, xy += u * v;
    }
    double spread = n * xx - x * x;
    if (n < 4 || !(spread > 1e-9 * n * n)) return false;
    *power = (n * xy - x * y) / spread;
    return true;
}

static float shared_power(const EmissionSamples *s) {
    double sum = 0, count = 0, power;
    for (int c = 0; c < s->channels; c++)
        if (channel_power(s, c, &power)) sum += fmin(9.5, fmax(0.5, power)), count++;
    return count > 0 ? (float)(sum / count) : 1.0f;
}

/* ln E less the fall, no lower than what noise leaves to be seen; holes have the channel's
 * mean. weight[c]: how much of a channel is clear of noise and of black. */
static float *start_logs(const EmissionSamples *s, float power, double *weight, Arena *arena) {
    float *logs = ARENA_NEW(arena, float, number(s, s->rows, 0));
    for (int c = 0; c < s->channels; c++) {
        double sum = 0, known = 1e-9, clear = 0;
        for (int i = 0; i < s->rows; i++) {
            float sigma, e = added_light(s, i, c, &sigma);
            float *to = &logs[number(s, i, c)];
            *to = NAN;
            if (isinf(sigma)) continue;
            float m = fmaxf(s->total[number(s, i, c)], 1e-9f), x = sigma / fmaxf(e, 1e-12f);
            *to = log_f(fmaxf(fmaxf(e, 0.3f * sigma), 1e-9f)) -
                  emission_rank_fall(power, s->direction[i]);
            sum += (double)*to;
            known++;
            clear += (double)(fmaxf(e, 0) / m / (1 + 400 * x * x));
        }
        weight[c] = fmax(1e-3, clear / known);
        for (int i = 0; i < s->rows; i++)
            if (isnan(logs[number(s, i, c)])) logs[number(s, i, c)] = (float)(sum / known);
    }
    return logs;
}

/* ---- one step -------------------------------------------------------------------------- */

/* The step of the model's logarithm towards a number, and its weight (1/variance). */
typedef struct RankWish {
    double step, weight;
} RankWish;

static RankWish wish_of(const EmissionSamples *s, int row, int channel, const float *logs) {
    size_t at = number(s, row, channel);
    double sigma = (double)s->sigma[at];
    if (isinf(sigma)) return (RankWish){0, 0};
    double e = exp_d(fmin(60, (double)logs[channel]));
    double rest = (double)s->total[at] - e;
    if (s->black >= 0 && !is_black_channel(s, channel))
        rest -= exp_d(fmin(60, (double)logs[s->black + channel % 3]));
    double far = fabs(rest) / sigma, weight = e / sigma * (e / sigma);
    if (far > HUBER) weight *= HUBER / far;
    return (RankWish){fmin(1, fmax(-1, rest / fmax(e, 1e-30))), weight};
}

/* Adds w x x^T (lower half) and w x y. */
static void add_equation(const double *x, double y, double w, int n, double *matrix,
                         double *right) {
    for (int i = 0; i < n; i++) {
        double wx = w * x[i];
        for (int j = 0; j <= i; j++) matrix[i * n + j] += wx * x[j];
        right[i] += wx * y;
    }
}

typedef struct RankWork {
    const EmissionSamples *samples;
    EmissionRank *rank;
    float *logs; /* channels */
} RankWork;

/* d M / d scores of a channel over sigma, and the rest of M over sigma; returns the weight. */
static double row_equation(const RankWork *work, size_t at, int channel, double *x, double *rest) {
    const EmissionSamples *s = work->samples;
    const EmissionRank *rank = work->rank;
    int n = rank->components, dark = s->black + channel % 3;
    double sigma = (double)s->sigma[at];
    double e = exp_d(fmin(60, (double)work->logs[channel])) / sigma, b = 0;
    if (s->black >= 0 && !is_black_channel(s, channel))
        b = exp_d(fmin(60, (double)work->logs[dark])) / sigma;
    for (int k = 0; k < n; k++) {
        x[k] = e * (double)rank->loading[channel * n + k];
        if (b > 0) x[k] += b * (double)rank->loading[dark * n + k];
    }
    *rest = (double)s->total[at] / sigma - e - b;
    return fabs(*rest) > HUBER ? HUBER / fabs(*rest) : 1;
}

/* A step is no longer than what changes a channel by a factor of e. */
static double step_length(const EmissionRank *rank, int channels, const double *step) {
    double most = 0;
    for (int c = 0; c < channels; c++) {
        double change = 0;
        for (int k = 0; k < rank->components; k++)
            change += step[k] * (double)rank->loading[c * rank->components + k];
        most = fmax(most, fabs(change));
    }
    return most > 1 ? 1 / most : 1;
}

/* New scores of a row; the prior (1: that they are of variance 1) is 1/variance. Returns the
 * information that the row has on its components, a mean. */
static double improve_row(const RankWork *work, int row, double prior) {
    const EmissionSamples *s = work->samples;
    EmissionRank *rank = work->rank;
    int n = rank->components;
    double matrix[COMPONENTS_MAX * COMPONENTS_MAX] = {0}, step[COMPONENTS_MAX] = {0};
    double x[COMPONENTS_MAX], trace = 0;
    float *score = rank->score + (size_t)row * (size_t)n;
    emission_rank_logs(rank, s->channels, score,
                       emission_rank_fall(rank->cosine_power, s->direction[row]), work->logs);
    for (int c = 0; c < s->channels; c++) {
        double rest;
        if (isinf(s->sigma[number(s, row, c)])) continue;
        double weight = row_equation(work, number(s, row, c), c, x, &rest);
        add_equation(x, rest, weight, n, matrix, step);
    }
    for (int k = 0; k < n; k++) {
        trace += matrix[k * n + k];
        matrix[k * n + k] += prior;
        step[k] -= prior * (double)score[k];
    }
    least_squares_factor(matrix, (size_t)n);
    least_squares_solve(matrix, step, (size_t)n);
    double length = step_length(rank, s->channels, step);
    for (int k = 0; k < n; k++) {
        double next = (double)score[k] + length * step[k];
        if (isfinite(next)) score[k] = (float)fmin(SCORE_MOST, fmax(-SCORE_MOST, next));
    }
    return isfinite(trace) ? trace / n : 0;
}

/* The channel whose loadings one resembles: the next brighter level's, Y of the brightest. */
static int elder(const EmissionSamples *s, int channel) {
    EmissionTable of = emission_samples_table(s->set, s->black >= 0, channel / 3);
    if (of.primary < 3 && of.level + 1 < s->set->primary[of.primary].level_count)
        return channel + 3;
    return channel % 3 == 1 ? -1 : channel / 3 * 3 + 1;
}

/* New mean and loadings of a channel. */
static void improve_channel(const RankWork *work, int channel, int stride) {
    const EmissionSamples *s = work->samples;
    EmissionRank *rank = work->rank;
    int n = rank->components, older = elder(s, channel);
    double matrix[(COMPONENTS_MAX + 1) * (COMPONENTS_MAX + 1)] = {0};
    double right[COMPONENTS_MAX + 1] = {0}, x[COMPONENTS_MAX + 1] = {1};
    float *loading = rank->loading + channel * n, logs[3];
    for (int i = 0; i < s->rows; i += stride) {
        const float *score = rank->score + (size_t)i * (size_t)n;
        int both[2] = {channel, s->black >= 0 ? s->black + channel % 3 : channel};
        float fall = emission_rank_fall(rank->cosine_power, s->direction[i]);
        for (int b = 0; b < 2; b++) {
            logs[b] = fall + rank->mean[both[b]];
            for (int k = 0; k < n; k++) logs[b] += rank->loading[both[b] * n + k] * score[k];
            work->logs[both[b]] = logs[b];
        }
        RankWish wish = wish_of(s, i, channel, work->logs);
        if (wish.weight == 0) continue;
        for (int k = 0; k < n; k++) x[k + 1] = (double)score[k];
        add_equation(x, wish.step + (double)(logs[0] - fall), wish.weight, n + 1, matrix, right);
    }
    matrix[0] += 1e-2;
    right[0] += 1e-2 * (double)rank->mean[channel];
    for (int k = 0; k < n; k++) {
        double prior = older < 0 ? 0 : (double)rank->loading[older * n + k];
        double weight = older < 0 ? 1e-2 : PRIOR;
        matrix[(k + 1) * (n + 2)] += weight;
        right[k + 1] += weight * prior;
    }
    least_squares_factor(matrix, (size_t)n + 1);
    least_squares_solve(matrix, right, (size_t)n + 1);
    rank->mean[channel] = (float)right[0];
    for (int k = 0; k < n; k++) loading[k] = (float)right[k + 1];
}

/* ---- components that are worth their order ---------------------------------------------- */

/* new = old times matrix (n x n), in place, row by row. */
static void turn_rows(float *rows, int count, const double *matrix, int n) {
    double out[COMPONENTS_MAX];
    for (int i = 0; i < count; i++) {
        float *row = rows + (size_t)i * (size_t)n;
        for (int k = 0; k < n; k++) {
            out[k] = 0;
            for (int j = 0; j < n; j++) out[k] += (double)row[j] * matrix[j * n + k];
        }
        for (int k = 0; k < n; k++) row[k] = (float)out[k];
    }
}

/* Scores to mean 0, the channels' means take it. */
static void centre(const EmissionSamples *s, EmissionRank *rank) {
    int n = rank->components;
    double mean[COMPONENTS_MAX] = {0}, area = 0;
    for (int i = 0; i < s->rows; i++) {
        area += s->area[i];
        for (int k = 0; k < n; k++) mean[k] += s->area[i] * (double)rank->score[i * n + k];
    }
    for (int i = 0; i < s->rows; i++)
        for (int k = 0; k < n; k++) rank->score[i * n + k] -= (float)(mean[k] / area);
    for (int c = 0; c < s->channels; c++)
        for (int k = 0; k < n; k++)
            rank->mean[c] += rank->loading[c * n + k] * (float)(mean[k] / area);
}

/* Covariance of rows, weighted. */
static void row_covariance(const float *rows, int count, const double *weight, int n,
                           double *matrix) {
    double total = 0;
    memset(matrix, 0, sizeof *matrix * (size_t)(n * n));
    for (int i = 0; i < count; i++) {
        const float *row = rows + (size_t)i * (size_t)n;
        total += weight[i];
        for (int a = 0; a < n; a++)
            for (int b = 0; b < n; b++)
                matrix[a * n + b] += weight[i] * (double)row[a] * (double)row[b];
    }
    for (int i = 0; i < n * n; i++) matrix[i] /= total;
}

/* Scores uncorrelated and of variance 1, then components in falling order of what they do to
 * the channels. */
static void straighten(const EmissionSamples *s, const double *weight, EmissionRank *rank) {
    int n = rank->components, order[COMPONENTS_MAX];
    double matrix[COMPONENTS_MAX * COMPONENTS_MAX], axes[COMPONENTS_MAX * COMPONENTS_MAX];
    double turn[COMPONENTS_MAX * COMPONENTS_MAX] = {0};
    double back[COMPONENTS_MAX * COMPONENTS_MAX] = {0};
    centre(s, rank);
    row_covariance(rank->score, s->rows, s->area, n, matrix);
    principal_axes(matrix, axes, n);
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++) {
            double size = sqrt(fmax(matrix[k * n + k], 1e-12));
            turn[j * n + k] = axes[j * n + k] / size;
            back[j * n + k] = axes[j * n + k] * size;
        }
    turn_rows(rank->score, s->rows, turn, n);
    turn_rows(rank->loading, s->channels, back, n);
    row_covariance(rank->loading, s->channels, weight, n, matrix);
    principal_axes(matrix, axes, n);
    principal_order(matrix, n, order);
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++) turn[j * n + k] = axes[j * n + order[k]];
    turn_rows(rank->score, s->rows, turn, n);
    turn_rows(rank->loading, s->channels, turn, n);
}

/* ---- how many -------------------------------------------------------------------------- */

/* The largest |M - model| / M, M no less than the floor, beyond what noise explains; *count:
 * how many are beyond a quarter of the tolerance. */
static double worst_rest(const RankWork *work, int *count) {
    const EmissionSamples *s = work->samples;
    const EmissionRank *rank = work->rank;
    double worst = 0;
    *count = 0;
    for (int i = 0; i < s->rows; i++) {
        emission_rank_logs(rank, s->channels, rank->score + (size_t)i * (size_t)rank->components,
                           emission_rank_fall(rank->cosine_power, s->direction[i]), work->logs);
        for (int c = 0; c < s->channels; c++) {
            size_t at = number(s, i, c);
            if (isinf(s->sigma[at]) || !(s->total[at] > 0)) continue;
            double m = exp_d((double)work->logs[c]);
            if (s->black >= 0 && !is_black_channel(s, c))
                m += exp_d((double)work->logs[s->black + c % 3]);
            double rest = fabs(m - (double)s->total[at]) - 5 * (double)s->sigma[at];
            double scale = fmax((double)s->total[at], s->floor[c]);
            worst = fmax(worst, rest / scale);
            *count += rest > 0.25 * s->tolerance * scale;
        }
    }
    return worst;
}

/* The first n of the start's components. */
static void take_start(const EmissionSamples *s, const Principal *start, int n,
                       EmissionRank *rank) {
    rank->components = n;
    for (int c = 0; c < s->channels; c++) {
        rank->mean[c] = start->mean[c];
        for (int k = 0; k < n; k++)
            rank->loading[c * n + k] = start->loading[c * start->components + k];
    }
    for (int i = 0; i < s->rows; i++)
        for (int k = 0; k < n; k++)
            rank->score[(size_t)i * (size_t)n + (size_t)k] =
                start->score[(size_t)i * (size_t)start->components + (size_t)k];
}

static void improve(const RankWork *work, const double *weight) {
    const EmissionSamples *s = work->samples;
    int stride = 1 + s->rows / ASKED_ROWS;
    straighten(s, weight, work->rank);
    for (int step = 0; step < ITERATIONS; step++) {
        for (int i = 0; i < s->rows; i += stride) improve_row(work, i, 1);
        for (int c = s->channels - 1; c >= 0; c--) improve_channel(work, c, stride);
    }
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < s->rows; i++) work->rank->belief[i] = (float)improve_row(work, i, 1);
    straighten(s, weight, work->rank);
}

/* Information to a weight in (0, 1]: what a tenth of the median knows counts a tenth. */
static void settle_belief(const EmissionSamples *s, EmissionRank *rank, Arena scratch) {
    double *sorted = ARENA_NEW(&scratch, double, s->rows);
    for (int i = 0; i < s->rows; i++) sorted[i] = (double)rank->belief[i];
    double middle = fmax(1e-9, sort_median(sorted, s->rows));
    for (int i = 0; i < s->rows; i++)
        rank->belief[i] = (float)fmin(1, (double)rank->belief[i] / middle);
}

/* Rows' areas, less where few channels are clear of noise: for the start. */
static double *start_weights(const EmissionSamples *s, Arena *arena) {
    double *weight = ARENA_NEW(arena, double, s->rows);
    for (int i = 0; i < s->rows; i++) {
        double clear = 0;
        for (int c = 0; c < s->channels; c++) {
            float sigma, e = added_light(s, i, c, &sigma);
            double x = (double)(sigma / fmaxf(e, 1e-12f));
            clear += isinf(sigma) ? 0 : 1 / (1 + 400 * x * x);
        }
        weight[i] = s->area[i] * (1e-3 + clear / s->channels);
    }
    return weight;
}

/* A fit with n components; returns how many samples it misses. */
static int try_components(const RankWork *work, const Principal *start, int n,
                          const double *weight) {
    int missed;
    take_start(work->samples, start, n, work->rank);
    improve(work, weight);
    work->rank->worst = worst_rest(work, &missed);
    return missed;
}

static bool is_enough(const EmissionSamples *s, const EmissionRank *rank, int missed) {
    double numbers = (double)s->rows * s->channels;
    return missed <= (rank->worst > STRAY ? STRAYS * numbers : 0);
}

void emission_rank_find(const EmissionSamples *s, Arena *arena, EmissionRank *out) {
    size_t channels = (size_t)s->channels, rows = (size_t)s->rows;
    double *weight = ARENA_NEW(arena, double, channels);
    int most = s->channels < COMPONENTS_MAX ? s->channels : COMPONENTS_MAX;
    *out = (EmissionRank){.cosine_power = shared_power(s)};
    out->mean = ARENA_NEW(arena, float, channels);
    out->loading = ARENA_NEW(arena, float, channels *COMPONENTS_MAX);
    out->score = ARENA_NEW(arena, float, rows *COMPONENTS_MAX);
    out->belief = ARENA_NEW(arena, float, rows);
    Arena scratch = *arena;
    RankWork work = {s, out, ARENA_NEW(&scratch, float, channels)};
    float *logs = start_logs(s, out->cosine_power, weight, &scratch);
    Principal start =
        principal_components(logs, start_weights(s, &scratch), weight,
                             (PrincipalShape){s->rows, s->channels, most, 0}, &scratch);
    int best = 0, least = INT32_MAX;
    for (int n = 1; n <= most; n++) {
        int missed = try_components(&work, &start, n, weight);
        if (missed < least) least = missed, best = n;
        if (is_enough(s, out, missed)) break;
        if (n == most || n >= best + PATIENCE) {
            try_components(&work, &start, best, weight);
            break;
        }
    }
    settle_belief(s, out, scratch);
}
