/* SPDX-License-Identifier: Apache-2.0 */
/* case_json.h -- a case of a review as review.json has it, and parts of one.
 *
 * Memory   documents are jansson's: whoever gets one releases it.
 * Threads  pure.
 * Fails    never; what is read names the JSON path, what was found and what is required.
 */
#pragma once
#include <jansson.h>

#include "record/record.h"
#include "review/verdict.h"

/* Of a ReviewCase, a LimitVerdict, a RemedyBreak and a CasePanel, and of two doubles: the sun's
 * azimuth and elevation. */
extern const RecordFormat case_json, limit_json, break_json, panel_json, sun_json;

/* A row's verdict, also by the names that older reviews have. */
bool case_read_verdict(const JsonView *view, const RecordRow *row, void *item, Error *err);

/* Some members of a case, by their keys, into `to`; NULL behind the last key. */
void case_members_json(const ReviewCase *c, const char *const *keys, json_t *to);

/* {"light": [{"what", "share", "cd_m2"}, ...], "opening": ..., "surface": ...} */
json_t *case_groups_json(const ReviewCase *c);

/* [{"what", "contrast_ratio", "level", "then", "verdict", "breaks"}, ...] */
json_t *case_remedies_json(const ReviewCase *c);

/* Sets "symbol_mean", "lit_share" and "judged_part_uv" of a symbol's case. */
void case_whole_json(const ReviewCase *c, json_t *to);

/* [{"what", "share"}, ...] */
json_t *case_hiders_json(const ReviewCase *c);
