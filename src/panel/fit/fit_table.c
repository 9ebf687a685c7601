/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/fit_table.h"

#include <math.h>

void fit_table_add_error(FitErrors *errors, double found, double wanted, double scale,
                         double weight) {
    double relative = fabs(found - wanted) / scale;
    errors->max = fmax(errors->max, relative);
    errors->squares += relative * relative;
    errors->count += 1;
    errors->integral += weight * found;
    errors->integral_source += weight * wanted;
}

void fit_table_add_excess(FitErrors *errors, double miss, double bound) {
    double excess = fmax(0, miss);
    errors->beyond += excess > bound;
    errors->excess_squares += excess * excess;
    errors->excess = fmax(errors->excess, excess);
}

void fit_table_leave_out(FitErrors *errors, double found, double wanted, double scale) {
    errors->outliers += 1;
    errors->outlier_max = fmax(errors->outlier_max, fabs(found - wanted) / scale);
}

void fit_table_merge(FitErrors *all, const FitErrors *one) {
    all->max = fmax(all->max, one->max);
    all->squares += one->squares;
    all->count += one->count;
    all->beyond += one->beyond;
    all->excess_squares += one->excess_squares;
    all->excess = fmax(all->excess, one->excess);
}

void fit_table_finish(const FitErrors *errors, FitTable *out) {
    out->max_error = errors->max;
    out->rms_error = sqrt(errors->squares / fmax(1, errors->count));
    out->integral_error =
        errors->integral_source > 0 ? errors->integral / errors->integral_source - 1 : 0;
    out->outliers = errors->outliers;
    out->outlier_error = errors->outlier_max;
}

json_t *fit_table_json(const FitTable *t) {
    json_t *out =
        json_pack("{s:s, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "name", t->name,
                  "source_bytes_text", (json_int_t)t->text_bytes, "source_bytes_float32",
                  (json_int_t)t->float32_bytes, "stored_values", t->stored_values, "bytes",
                  t->bytes, "max_error", t->max_error, "rms_error", t->rms_error, "integral_error",
                  t->integral_error, "noise", t->noise, "extrapolated_share", t->extrapolated);
    if (t->outliers > 0) {
        json_object_set_new(out, "outliers", json_integer((json_int_t)t->outliers));
        json_object_set_new(out, "outliers_max_error", json_real(t->outlier_error));
    }
    return out;
}

void fit_table_append(json_t *tables, FitTable *total, const FitTable *one) {
    json_array_append_new(tables, fit_table_json(one));
    total->text_bytes += one->text_bytes;
    total->float32_bytes += one->float32_bytes;
    total->stored_values += one->stored_values;
    total->max_error = fmax(total->max_error, one->max_error);
    total->rms_error = fmax(total->rms_error, one->rms_error);
    total->integral_error = fmax(total->integral_error, fabs(one->integral_error));
    total->noise = fmax(total->noise, one->noise);
    total->outliers += one->outliers;
    total->outlier_error = fmax(total->outlier_error, one->outlier_error);
    total->extrapolated = fmax(total->extrapolated, one->extrapolated);
}
