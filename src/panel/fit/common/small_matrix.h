/* SPDX-License-Identifier: Apache-2.0 */
/* small_matrix.h -- symmetric matrices of a fit: axes by Jacobi's rotations, principal
 * components with weights.
 *
 * Matrices are n x n, row after row. Memory: the arena's. Threads: pure functions. Fails:
 * never.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"

/* ---- principal components: few numbers a row instead of many -------------------------------
 *
 * row[c] = mean[c] + sum_k loading[c][k] score[k], where the rms of weight[c] times the rest
 * is below the tolerance (or the components run out). The number of components is a multiple of
 * four where it can be, which queries sum fastest. */

typedef struct PrincipalShape {
    int rows, channels;
    int components_max;
    double tolerance; /* rms of the weighted rest over rows and channels */
} PrincipalShape;

typedef struct Principal {
    int components;        /* at least 1 */
    float *mean, *loading; /* channels; channels x components */
    float *score;          /* rows x components */
    const double *weight;  /* as given */
    double residual;       /* weighted rms of what is left out */
} Principal;

/* values: rows x channels; row_weight: areas; weight: what a channel's error is worth. */
Principal principal_components(const float *values, const double *row_weight, const double *weight,
                               PrincipalShape shape, Arena *arena);

/* Jacobi's method for a symmetric n x n matrix: it becomes diagonal, and column k of `vector`
 * is the unit eigenvector of its k-th diagonal number. */
void principal_axes(double *matrix, double *vector, int n);

/* Indices of the diagonal's numbers, falling. */
void principal_order(const double *matrix, int n, int *order);
