/* SPDX-License-Identifier: Apache-2.0 */
/* task_threads.h -- how many threads oneTBB, and so Embree, may have.
 *
 * Threads  any.
 * Memory   the limit stays until the process ends.
 */
#pragma once
#include <stdbool.h>

#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/* most: at least 1, the caller's own thread among them. The least of all limits counts. */
bool task_threads_limit(int most, Error *err);

#ifdef __cplusplus
}
#endif
