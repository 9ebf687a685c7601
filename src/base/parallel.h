/* SPDX-License-Identifier: Apache-2.0 */
/* parallel.h -- does many small pieces of work with several threads.
 *
 * The workers take items off one atomic counter, so that a slow item holds nobody up. The
 * calling thread is worker 0 and works too; when the system refuses more threads, or all of them
 * are at work for another call, the work is done with fewer. Threads wait for the next call,
 * without state of their own; they block signals, which the callers get.
 *
 * Fails    parallel_for never.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PARALLEL_THREADS_MAX 1024

/* item: 0 .. item_count - 1, each exactly once, begun in rising order. worker: 0 ..
 * thread_count - 1, one thread at a time each: an index for scratch memory. */
typedef void ParallelWork(void *context, int item, int worker);

/* Returns when every item is done. thread_count at least 1;
 * more than PARALLEL_THREADS_MAX count as that many. */
void parallel_for(int thread_count, int item_count, ParallelWork *work, void *context);

/* The same for items that may fail, each with an error of its own. When all are done, the
 * error of the first item that failed is returned. */
typedef bool ParallelTry(void *context, int item, Error *err);
bool parallel_try(int thread_count, int item_count, ParallelTry *work, void *context, Arena scratch,
                  Error *err);

/* How many threads the scheduler lets this process have (its affinity), at least 1. */
int parallel_default_threads(void);

/* How many of wanted threads, the caller among them, the system grants now (RLIMIT_NPROC, a
 * control group's pids.max): for libraries that end their work where they cannot have one. */
int parallel_grantable_threads(int wanted);

#ifdef __cplusplus
}
#endif
