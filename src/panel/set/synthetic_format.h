/* SPDX-License-Identifier: Apache-2.0 */
/* synthetic_format.h -- a recipe's keys (record/record.h).
 *
 * Threads  constant.
 */
#pragma once
#include "record/record.h"

extern const RecordFormat synthetic_format; /* of a SyntheticPanel (synthetic_panel.h) */
