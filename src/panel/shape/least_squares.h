/* SPDX-License-Identifier: Apache-2.0 */
/* least_squares.h -- normal equations of a few unknowns, by Cholesky's factor.
 *
 * Matrices are n x n, row after row, positive definite, and only their lower half is read and
 * written. Threads: pure functions. Fails: never; a pivot that rounding made negative counts as
 * 1e-150.
 */
#pragma once
#include <stddef.h>

/* The matrix becomes its lower factor L, matrix = L L^T. */
void least_squares_factor(double *matrix, size_t n);

/* Solves L L^T x = right; x into right. Returns right^T x: by how much the squares of what is
 * fitted go down. */
double least_squares_solve(const double *factor, double *right, size_t n);
