/* SPDX-License-Identifier: Apache-2.0 */
/* import_rows.h -- the rows of a table while they are found one by one.
 *
 * Memory   the arena's. Threads: one at a time.
 */
#pragma once
#include "import/set/import.h"

typedef struct ImportRows {
    int rows, channels;
    double *theta_deg, *phi_deg, *value; /* value: rows x channels */
    int masked;                          /* directions marked as not measured */
    double *masked_theta_deg, *masked_phi_deg;
} ImportRows;

/* Room for `capacity` directions, and for `masked` that were not measured. */
ImportRows import_rows(Arena *arena, int capacity, int masked, int channels);

/* Where the next row's values go, for import_rows_end to make it a row. */
static inline double *import_rows_next(ImportRows *rows) {
    return rows->value + (size_t)rows->rows * (size_t)rows->channels;
}

static inline void import_rows_end(ImportRows *rows, double theta_deg, double phi_deg) {
    rows->theta_deg[rows->rows] = theta_deg;
    rows->phi_deg[rows->rows++] = phi_deg;
}

/* Adds one; `value` holds the channels. */
void import_rows_put(ImportRows *rows, double theta_deg, double phi_deg, const double *value);
void import_rows_mask(ImportRows *rows, double theta_deg, double phi_deg);

/* Adds all of a table. */
void import_rows_append(ImportRows *rows, const ImportTable *table);

/* The table's rows are these from now on; the second leaves alone what was not measured. */
void import_rows_give(const ImportRows *rows, ImportTable *table);
void import_rows_give_measured(const ImportRows *rows, ImportTable *table);
