/* SPDX-License-Identifier: Apache-2.0 */
/* glare_found.h -- what was read of glare, as a review keeps it.
 *
 * Threads  pure functions.
 */
#pragma once
#include "review/eye/eye_reading.h"
#include "review/verdict.h"

CaseGlare glare_found(const GlareReading *reading, const GlareSettings *settings);
