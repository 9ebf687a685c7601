/* SPDX-License-Identifier: Apache-2.0 */
/* fit_report_reflection.h -- the reflection in the report of a fit. */
#pragma once
#include "panel/fit/fit_file.h"
#include "panel/fit/fit_table.h"
#include "panel/query/panel.h"

/* The tables' rows. */
void fit_report_reflection_tables(const FitParts *parts, const Panel *panel, json_t *tables,
                                  FitTable *total, FitErrors *all);

/* Adds the parameters, and the parts at every incidence, to *out as "reflection". */
void fit_report_reflection(const FitParts *parts, const Panel *panel, json_t *out);
