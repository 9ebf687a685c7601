/* SPDX-License-Identifier: Apache-2.0 */
/* profile_format.h -- a profile's keys (record/record.h).
 *
 * Threads  constant.
 */
#pragma once
#include "record/record.h"

extern const RecordFormat profile_format; /* of a Profile (profile.h) */
