/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/regression.h"

#include <math.h>
#include <string.h>

#define RIDGE 1e-3 /* of all weights: features that hardly vary are not followed */

/* Normal equations: the sums of w f f' and, in the columns of light, of w f L; features and
 * light are relative to the middle pixel's own. */
typedef struct Equations {
    BufferRow row[ROW_FEATURES];
} Equations;

typedef struct Fit {
    float of[3][ROW_FEATURES]; /* R, G, B */
} Fit;

static size_t middle_of(const RegressionWindow *window)
{
    return (size_t)window->y * (size_t)window->buffers->width + (size_t)window->x;
}

/* The row of a place of the window, relative to the middle; returns its pixel. */
static size_t row_at(const RegressionWindow *window, int place, BufferRow *out)
{
    const DenoiseBuffers *b = window->buffers;
    int    wide = 2 * window->reach + 1;
    int    dx = place % wide - window->reach, dy = place / wide - window->reach;
    size_t middle = middle_of(window);
    size_t i = (size_t)(window->y + dy) * (size_t)b->width + (size_t)(window->x + dx);
    *out = b->rows[i] - b->rows[middle];
    (*out)[ROW_ONE] = 1;
    (*out)[ROW_X] = (float)dx / (float)window->reach;
    (*out)[ROW_Y] = (float)dy / (float)window->reach;
    return i;
}

static void gather(const RegressionWindow *window, Equations *to)
{
    int wide = 2 * window->reach + 1;
    memset(to, 0, sizeof *to);
    for (int k = 0; k < wide * wide; k++) {
        BufferRow row;
        if (window->weights[k] == 0) continue;
        row_at(window, k, &row);
        for (int i = 0; i < ROW_FEATURES; i++)
            to->row[i] += row * (window->weights[k] * row[i]);
    }
}

/* Cholesky's L in the lower triangle. The ridge keeps the matrix positive. */
static void factorise(const Equations *from, double m[ROW_FEATURES][ROW_FEATURES])
{
    double ridge = RIDGE * (double)from->row[0][ROW_ONE];
    for (int i = 0; i < ROW_FEATURES; i++)
        for (int j = 0; j <= i; j++) {
            double sum = (double)from->row[i][j] + (i == j && i > 0 ? ridge : 0);
            for (int k = 0; k < j; k++) sum -= m[i][k] * m[j][k];
            m[i][j] = i == j ? sqrt(fmax(sum, 1e-6 * ridge)) : sum / m[j][j];
        }
}

static void solve(double m[ROW_FEATURES][ROW_FEATURES], double x[ROW_FEATURES])
{
    for (int i = 0; i < ROW_FEATURES; i++) {
        for (int k = 0; k < i; k++) x[i] -= m[i][k] * x[k];
        x[i] /= m[i][i];
    }
    for (int i = ROW_FEATURES - 1; i >= 0; i--) {
        for (int k = i + 1; k < ROW_FEATURES; k++) x[i] -= m[k][i] * x[k];
        x[i] /= m[i][i];
    }
}

static void fit_light(const RegressionWindow *window, int half, Fit *fit)
{
    Equations equations;
    double    m[ROW_FEATURES][ROW_FEATURES];
    gather(window, &equations);
    factorise(&equations, m);
    for (int c = 0; c < 3; c++) {
        double x[ROW_FEATURES];
        for (int i = 0; i < ROW_FEATURES; i++)
            x[i] = (double)equations.row[i][ROW_LIGHT + 3 * half + c];
        solve(m, x);
        for (int i = 0; i < ROW_FEATURES; i++) fit->of[c][i] = (float)x[i];
        fit->of[c][0] += window->buffers->light[half][c][middle_of(window)];
    }
}

static void light_of(const Fit *fit, const BufferRow *row, float light[3])
{
    for (int c = 0; c < 3; c++) {
        light[c] = 0;
        for (int j = 0; j < ROW_FEATURES; j++) light[c] += fit->of[c][j] * (*row)[j];
    }
}

void regression_add(const RegressionWindow *window, int half, const RegressionSums *sums)
{
    int wide = 2 * window->reach + 1;
    Fit fit;
    fit_light(window, half, &fit);
    for (int k = 0; k < wide * wide; k++) {
        BufferRow row;
        float     light[3], weight = window->weights[k];
        if (weight == 0) continue;
        size_t i = row_at(window, k, &row);
        light_of(&fit, &row, light);
        for (int c = 0; c < 3; c++) sums->light[c][i] += weight * light[c];
        sums->weight[i] += weight;
    }
}
