/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/shape/least_squares.h"

#include <math.h>

void least_squares_factor(double *m, size_t n) {
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = m[i * n + j];
            for (size_t k = 0; k < j; k++) sum -= m[i * n + k] * m[j * n + k];
            m[i * n + j] = i == j ? sqrt(fmax(sum, 1e-300)) : sum / m[j * n + j];
        }
}

double least_squares_solve(const double *m, double *right, size_t n) {
    double gain = 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < i; k++) right[i] -= m[i * n + k] * right[k];
        right[i] /= m[i * n + i];
        gain += right[i] * right[i];
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t k = i + 1; k < n; k++) right[i] -= m[k * n + i] * right[k];
        right[i] /= m[i * n + i];
    }
    return gain;
}
