/* SPDX-License-Identifier: Apache-2.0 */
/* panel_facts.h -- what a display engineer reads of a panel first: white, contrast, gamut,
 * gamma, viewing cone, reflectance; and with it the report of a panel file or of a fit.
 *
 * Units    cd m^-2, CIE 1931 xy, degrees, sr^-1; luminous reflectances under
 *          an equal-energy light.
 * Frame    azimuths are right, up, left and down as a viewer sees them (phi 0, 90, 180, 270).
 * Threads  one at a time.
 */
#pragma once
#include <jansson.h>

#include "base/error.h"
#include "panel/query/panel.h"
#include "table/table.h"

extern const TableKind panel_report_kind;

/* Puts "display" into the report: only what was measured. */
void panel_facts_add(const Panel *panel, json_t *report);

/* The report as a table, or as_json as it is; releases it. False: stdout is full. */
bool panel_print_report(json_t *report, bool as_json, Error *err);
