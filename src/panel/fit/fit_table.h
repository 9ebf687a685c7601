/* SPDX-License-Identifier: Apache-2.0 */
/* fit_table.h -- how well a panel reproduces one measured table, as a row of the report. */
#pragma once
#include <jansson.h>
#include <stddef.h>

typedef struct FitTable {
    const char *name;
    size_t text_bytes, float32_bytes; /* of the source; float32: values without angles */
    double stored_values, bytes;
    double max_error, rms_error, integral_error, noise, extrapolated;
    double outliers, outlier_error; /* samples that no error counts, and their largest */
} FitTable;

/* Deviations of a panel from a table, summed up. */
typedef struct FitErrors {
    double max, squares, count, integral, integral_source;
    double beyond, excess_squares, excess; /* of fit_table_add_excess; the largest */
    double outliers, outlier_max;          /* of fit_table_leave_out */
} FitErrors;

/* scale: what the error is relative to. */
void fit_table_add_error(FitErrors *errors, double found, double wanted, double scale,
                         double weight);

/* The same deviation without what noise explains. miss: relative, noise taken off; a sample
 * whose miss is above bound is one beyond it. */
void fit_table_add_excess(FitErrors *errors, double miss, double bound);
/* A sample that the fit does not follow: counted apart. */
void fit_table_leave_out(FitErrors *errors, double found, double wanted, double scale);
void fit_table_finish(const FitErrors *errors, FitTable *out);

/* Adds counts and sums of one table to those of all. */
void fit_table_merge(FitErrors *all, const FitErrors *one);

/* A new object of the report. */
json_t *fit_table_json(const FitTable *table);

/* One more row of the report, and into its total. */
void fit_table_append(json_t *tables, FitTable *total, const FitTable *one);
