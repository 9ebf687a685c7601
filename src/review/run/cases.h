/* SPDX-License-Identifier: Apache-2.0 */
/* cases.h -- a setup that is lit becomes cases: each symbol as each eye sees it.
 *
 * An eye box is judged by its worst point.
 *
 * Units    verdict.h's.
 * Memory   what cases point to lies in the arena.
 * Threads  starts its own; the same figures for any count.
 */
#pragma once
#include "review/eye/eye_reading.h"
#include "review/profile.h"
#include "review/run/symbols.h"
#include "review/run/review_run.h"
#include "review/verdict.h"

typedef struct CaseTools {
    const Setup *setup;
    const Profile *profile;
    const SetupSymbol *symbols;
    int symbol_count;
    long cause_paths;   /* by which causes are found; 0: CAUSE_PATHS */
    int cause_rays;     /* that are kept of each; 0: CAUSE_RAYS */
    Progress *progress; /* of setup_cases, in cases; or NULL */
    const Review *base; /* of a variant: the review itself. Cases are bare then
                           (setup_verdict), and read from no fewer paths than its
                           own, so that what differs is known sharply; or NULL */
} CaseTools;

/* Share of what a display reflects from which on its light is that of direct sun. */
#define CASE_SUNLIT 0.5

/* symbol_count * eye_count cases, symbols fastest. Fails where an eye's camera is missing. */
bool setup_cases(const CaseTools *tools, Arena *arena, ReviewCase *out, Error *err);

/* One of them. */
bool setup_case(const CaseTools *tools, const SetupSymbol *symbol, const ReviewEye *eye,
                Arena *arena, ReviewCase *out, Error *err);

/* The same without causes and remedies, and without stray light unless the profile's verdicts
 * hang on it: for variants, and trials of many seeds. out->display_lux
 * is the illuminance of its face. */
bool setup_verdict(const CaseTools *tools, const SetupSymbol *symbol, const ReviewEye *eye,
                   Arena *arena, ReviewCase *out, Error *err);
