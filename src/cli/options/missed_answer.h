/* SPDX-License-Identifier: Apache-2.0 */
/* missed_answer.h -- light that may be missed, in an answer. */
#pragma once
#include <jansson.h>

#include "missed/missed.h"

/* [{"light", "name", "by", "part", "then", "is_lost", "eye", "eye_name", "cd_m2" or
 * "lx", "share"}] of the
 * pairs. */
json_t *missed_pairs_json(const Scene *scene, const MissedLight *missed);
