/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/small_matrix.h"

#include <math.h>
#include <string.h>

/* ---- principal components ---------------------------------------------------------------- */

static void channel_means(const float *values, const double *row_weight, PrincipalShape shape,
                          float *mean) {
    for (int c = 0; c < shape.channels; c++) {
        double sum = 0, total = 0;
        for (int i = 0; i < shape.rows; i++) {
            sum += row_weight[i] * (double)values[(size_t)i * (size_t)shape.channels + (size_t)c];
            total += row_weight[i];
        }
        mean[c] = (float)(sum / total);
    }
}

/* Weighted covariance, symmetric, channels x channels. */
static void covariance(const float *values, const double *row_weight, const double *weight,
                       PrincipalShape shape, const float *mean, double *matrix) {
    int n = shape.channels;
    double row[4096], total = 0;
    for (int i = 0; i < shape.rows; i++) {
        for (int c = 0; c < n; c++)
            row[c] = weight[c] * (double)(values[(size_t)i * (size_t)n + (size_t)c] - mean[c]);
        for (int a = 0; a < n; a++) {
            double f = row[a] * row_weight[i];
            for (int b = a; b < n; b++) matrix[a * n + b] += f * row[b];
        }
        total += row_weight[i];
    }
    for (int a = 0; a < n; a++)
        for (int b = a; b < n; b++)
            matrix[b * n + a] = matrix[a * n + b] = matrix[a * n + b] / total;
}

static void rotate(double *matrix, double *vector, int n, int p, int q) {
    double apq = matrix[p * n + q];
    double theta = (matrix[q * n + q] - matrix[p * n + p]) / (2 * apq);
    double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
    double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < n; k++) {
        double a = matrix[k * n + p], b = matrix[k * n + q];
        matrix[k * n + p] = c * a - s * b;
        matrix[k * n + q] = s * a + c * b;
    }
    for (int k = 0; k < n; k++) {
        double a = matrix[p * n + k], b = matrix[q * n + k];
        matrix[p * n + k] = c * a - s * b;
        matrix[q * n + k] = s * a + c * b;
    }
    for (int k = 0; k < n; k++) {
        double a = vector[k * n + p], b = vector[k * n + q];
        vector[k * n + p] = c * a - s * b;
        vector[k * n + q] = s * a + c * b;
    }
}

void principal_axes(double *matrix, double *vector, int n) {
    memset(vector, 0, sizeof *vector * (size_t)n * (size_t)n);
    for (int i = 0; i < n; i++) vector[i * n + i] = 1;
    for (int sweep = 0; sweep < 30; sweep++) {
        double off = 0, trace = 0;
        for (int p = 0; p < n; p++) {
            trace += fabs(matrix[p * n + p]);
            for (int q = p + 1; q < n; q++) off += fabs(matrix[p * n + q]);
        }
        if (off <= 1e-13 * trace) return;
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++)
                if (fabs(matrix[p * n + q]) > 1e-300) rotate(matrix, vector, n, p, q);
    }
}

void principal_order(const double *matrix, int n, int *order) {
    for (int i = 0; i < n; i++) {
        int at = i;
        while (at > 0 && matrix[order[at - 1] * (n + 1)] < matrix[i * (n + 1)]) {
            order[at] = order[at - 1];
            at--;
        }
        order[at] = i;
    }
}

static int choose_count(const double *matrix, const int *order, PrincipalShape shape,
                        double *residual) {
    int n = shape.channels, count = n < shape.components_max ? n : shape.components_max;
    double rest = 0;
    for (int i = count; i < n; i++) rest += fmax(0, matrix[order[i] * (n + 1)]);
    while (count > 1) {
        double more = rest + fmax(0, matrix[order[count - 1] * (n + 1)]);
        if (sqrt(more / n) > shape.tolerance) break;
        rest = more;
        count--;
    }
    while (count % 4 && count < n && count < shape.components_max) count++;
    *residual = sqrt(rest / n);
    return count;
}

Principal principal_components(const float *values, const double *row_weight, const double *weight,
                               PrincipalShape shape, Arena *arena) {
    int n = shape.channels;
    Principal out = {.mean = ARENA_NEW(arena, float, n), .weight = weight};
    double *matrix = ARENA_NEW(arena, double, n *n);
    double *vector = ARENA_NEW(arena, double, n *n);
    int *order = ARENA_NEW(arena, int, n);
    channel_means(values, row_weight, shape, out.mean);
    covariance(values, row_weight, weight, shape, out.mean, matrix);
    principal_axes(matrix, vector, n);
    principal_order(matrix, n, order);
    int count = out.components = choose_count(matrix, order, shape, &out.residual);
    out.loading = ARENA_NEW(arena, float, n *count);
    for (int c = 0; c < n; c++)
        for (int k = 0; k < count; k++)
            out.loading[c * count + k] = (float)(vector[c * n + order[k]] / weight[c]);
    out.score = ARENA_NEW(arena, float, (size_t)shape.rows *(size_t)count);
    for (int i = 0; i < shape.rows; i++)
        for (int c = 0; c < n; c++) {
            double value =
                weight[c] * (double)(values[(size_t)i * (size_t)n + (size_t)c] - out.mean[c]);
            for (int k = 0; k < count; k++)
                out.score[i * count + k] += (float)(value * vector[c * n + order[k]]);
        }
    return out;
}
