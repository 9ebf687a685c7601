/* SPDX-License-Identifier: Apache-2.0 */
/* panel_stated.h -- what a panel file says of itself: the verdict of its fit, how far it may be
 * from what was measured, and by whom that was.
 *
 * Nothing is measured that a simulated instrument read (`panel simulate` writes that into its
 * sets), or whose name or note calls it synthetic.
 *
 * Units    relative errors: the root of the mean square over its tables of each table's own
 *          (each relative to the measured values, noise included), as `panel info` prints them.
 * Memory   texts live in the arena.  Threads  pure function.
 * Fails    a report that cannot be read states nothing.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/arena.h"
#include "panel/query/panel.h"

/* How far the file's emission, or its reflection, is from what was measured; shares. */
typedef struct PanelPartError {
    int tables;        /* of that part; 0: all else is 0 */
    double rms;        /* the root of the mean square over the tables of each table's own */
    double largest;    /* of all tables */
    const char *worst; /* the table of the largest: a text of the report; "": none */
    double outliers, outlier_largest; /* left out of both: how many, the largest */
} PanelPartError;

/* report: what `panel_report` gives. Tables of the reflection are named "brdf ...". */
PanelPartError panel_part_error(const json_t *report, bool of_reflection);

typedef struct PanelStated {
    const char *verdict; /* "good", "usable with care", "not usable"; NULL: an older file */
    const char *reason;  /* the worst; NULL: none */
    bool is_coarse;
    bool is_unusable;
    double emission_error, reflection_error; /* 0: not stated */
    const char *name;                        /* the product's; NULL: not stated */
    const char *instrument; /* with which it was measured, and by whom where that stands there;
                               NULL likewise */
    const char *assumed;    /* of the emission's spectra; NULL: they were measured, or an
                               older file */
    bool is_synthetic;
} PanelStated;

PanelStated panel_stated(const Panel *panel, Arena *arena);
