/* SPDX-License-Identifier: Apache-2.0 */
/* panel_print.h -- the report of a panel file or of a fit as a table on stdout. */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/error.h"

/* The report as a table, or as_json as it is; releases it. False: stdout is full. */
bool panel_print_report(json_t *report, bool as_json, Error *err);
