/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/ssim.h"

#include "base/mathd.h"

enum { RADIUS = SSIM_RADIUS, TAPS = 2 * RADIUS + 1 };

/* Quantities averaged over a window: the weight itself and the moments of the two lumas. */
enum { WEIGHT, R, T, RR, TT, RT, MOMENTS };

/* The windows' sums along x of the last rows, row y at y % TAPS; then those along y are taken
 * over them. */
typedef struct SsimWindow {
    const Planes *reference, *test;
    PixelMask mask;
    double weights[TAPS];
    double *rows[TAPS]; /* width * MOMENTS each */
    double *line;       /* the row's own moments: width * MOMENTS */
} SsimWindow;

static double luma(const Planes *planes, size_t i) {
    return 0.299 * (double)planes->rgb[0][i] + 0.587 * (double)planes->rgb[1][i] +
           0.114 * (double)planes->rgb[2][i];
}

static void set_line(const SsimWindow *window, int y) {
    int width = window->reference->width;
    for (int x = 0; x < width; x++) {
        size_t i = (size_t)y * (size_t)width + (size_t)x;
        double *m = window->line + (size_t)x * MOMENTS;
        double w = !window->mask || window->mask[i] ? 1 : 0;
        double r = w * luma(window->reference, i), t = w * luma(window->test, i);
        m[WEIGHT] = w;
        m[R] = r;
        m[T] = t;
        m[RR] = r * r;
        m[TT] = t * t;
        m[RT] = r * t;
    }
}

/* Row y, summed along x. */
static void filter_row(const SsimWindow *window, int y) {
    int width = window->reference->width;
    double *row = window->rows[y % TAPS];
    set_line(window, y);
    for (int x = 0; x < width; x++) {
        int first = x < RADIUS ? -x : -RADIUS;
        int last = x + RADIUS < width ? RADIUS : width - 1 - x;
        double sums[MOMENTS] = {0};
        for (int k = first; k <= last; k++) {
            const double *m = window->line + (size_t)(x + k) * MOMENTS;
            for (int j = 0; j < MOMENTS; j++) sums[j] += window->weights[k + RADIUS] * m[j];
        }
        for (int j = 0; j < MOMENTS; j++) row[(size_t)x * MOMENTS + (size_t)j] = sums[j];
    }
}

/* Wang et al., equation 13; C1 and C2 for codes 0 .. 1. Two equal pictures give the same bits
 * above and below the line. */
static double similarity(const double sums[MOMENTS]) {
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03, w = sums[WEIGHT];
    if (w == 0) return 1;
    double r = sums[R] / w, t = sums[T] / w;
    double rr = sums[RR] / w - r * r, tt = sums[TT] / w - t * t, rt = sums[RT] / w - r * t;
    return (2 * r * t + c1) * (2 * rt + c2) / ((r * r + t * t + c1) * (rr + tt + c2));
}

static double pixel_similarity(const SsimWindow *window, int x, int y) {
    int height = window->reference->height;
    int first = y < RADIUS ? -y : -RADIUS;
    int last = y + RADIUS < height ? RADIUS : height - 1 - y;
    double sums[MOMENTS] = {0};
    for (int k = first; k <= last; k++) {
        const double *m = window->rows[(y + k) % TAPS] + (size_t)x * MOMENTS;
        for (int j = 0; j < MOMENTS; j++) sums[j] += window->weights[k + RADIUS] * m[j];
    }
    return similarity(sums);
}

static SsimWindow window_create(const Planes *reference, const Planes *test, PixelMask mask,
                                Arena *arena) {
    const double sigma = 1.5;
    size_t values = (size_t)reference->width * MOMENTS;
    SsimWindow window = {.reference = reference, .test = test, .mask = mask};
    for (int k = -RADIUS; k <= RADIUS; k++) {
        window.weights[k + RADIUS] = exp_d(-k * k / (2 * sigma * sigma));
        window.rows[k + RADIUS] = ARENA_NEW(arena, double, values);
    }
    window.line = ARENA_NEW(arena, double, values);
    return window;
}

/* map may be NULL. */
static void add_rows(const SsimWindow *window, const int rows[2], float *map, SsimSum *sum) {
    int width = window->reference->width, height = window->reference->height;
    int filtered = rows[0] > RADIUS ? rows[0] - RADIUS : 0; /* the next row to filter */
    for (int y = rows[0]; y < rows[1]; y++) {
        for (; filtered < height && filtered <= y + RADIUS; filtered++)
            filter_row(window, filtered);
        for (int x = 0; x < width; x++) {
            size_t i = (size_t)y * (size_t)width + (size_t)x;
            double value = pixel_similarity(window, x, y);
            if (map) map[i] = (float)value;
            if (window->mask && !window->mask[i]) continue;
            sum->sum += value;
            sum->members++;
        }
    }
}

void ssim_add_rows(SsimSum *sum, const Planes *reference, const Planes *test, PixelMask mask,
                   const int rows[2], Arena scratch) {
    const SsimWindow window = window_create(reference, test, mask, &scratch);
    add_rows(&window, rows, NULL, sum);
}

double ssim_mean(const Planes *reference, const Planes *test, PixelMask mask, float *map,
                 Arena scratch) {
    const SsimWindow window = window_create(reference, test, mask, &scratch);
    SsimSum sum = {0};
    add_rows(&window, (const int[2]){0, reference->height}, map, &sum);
    return sum.sum / sum.members; /* 0 / 0: no pixel, NaN as promised */
}
