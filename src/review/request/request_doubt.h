/* SPDX-License-Identifier: Apache-2.0 */
/* request_doubt.h -- what a request and its scene say and cannot mean together: a vehicle that
 * points elsewhere than its eyes look, displays and distances of no car or cockpit, pictures
 * that stand upside down.
 *
 * Memory   the problems' arena. Threads: const data.
 */
#pragma once
#include "base/problems.h"
#include "review/request/request.h"

/* The request's names are known to be right (request_check.h). Sizes of displays that are read
 * are errors, the rest are warnings. */
void review_request_doubt(const ReviewRequest *request, const Scene *scene,
                          Problems *problems);
