/* SPDX-License-Identifier: Apache-2.0 */
/* condition_rows.h -- which members of a review's structs are kept in a file of one condition,
 * and of what range they are: the tables by which keep/pack.h writes and reads them.
 *
 * Left out is what is found of all conditions together: differences, ranks, names of tables;
 * and, of a case, its frame (CaseSight).
 *
 * Threads  the tables are constant.
 */
#pragma once
#include "keep/pack.h"
#include "review/verdict.h"
#include "review/suns/sweep_suns.h"

/* Of one review under one condition: its rows, without a title. */
extern const PackFormat condition_review;

/* What a frame adds to its case. */
typedef struct CaseSight {
    int case_id; /* review_case_at */
    const char *frame;
    const CaseView *view;
    const Vec3 *rim;
    int rim_count;
} CaseSight;
extern const PackFormat condition_sight;

/* A sweep's figures under one sun: contrast, low, high, margin, reflected, mirror, level, lux. */
enum { STEP_FIGURES = 8 };
typedef struct StepKept {
    float figures[STEP_FIGURES];
    int verdict;
} StepKept;

/* SweepTable, less the suns themselves: they follow from the request. */
typedef struct TableKept {
    int sweep_id, worst;
    bool is_private;
    SweepSun worst_sun;
    const StepKept *steps;
    int step_count;
} TableKept;
extern const PackFormat condition_table;
