/* SPDX-License-Identifier: Apache-2.0 */
/* request_parameters.h -- the "sensitivity" of REVIEW.json: numbers that may be turned; and the
 * variant that a value of one of them is.
 *
 * Units    as files have them: degrees, metres; times as bright; reflectance 0..1.
 * Memory   of a variant the arena that is passed in. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/request/request.h"

/* The review with the parameter at a value within its range. */
ReviewVariant review_parameter_at(const ReviewRequest *request,
                                  const ReviewParameter *parameter, double value, Arena *arena);

/* A step below where it stands and one above, within its range: slopes lie between them. */
void review_parameter_ends(const ReviewParameter *parameter, double ends[2]);

/* The unit of slopes: "degree", "mm", ...; and how many of the file's it is. */
const char *review_parameter_unit(const ReviewParameter *parameter, double *scale);
