/* SPDX-License-Identifier: Apache-2.0 */
#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

typedef struct Job {
    atomic_int next; /* the first item nobody has taken */
    int item_count;
    ParallelWork *work;
    void *context;
} Job;

typedef struct Worker {
    Job *job;
    int index;
    pthread_t thread;
} Worker;

static void take_items(Job *job, int worker) {
    for (;;) {
        int item = atomic_fetch_add(&job->next, 1);
        if (item >= job->item_count) return;
        job->work(job->context, item, worker);
    }
}

static void *run_worker(void *argument) {
    Worker *worker = argument;
    take_items(worker->job, worker->index);
    return NULL;
}

void parallel_for(int thread_count, int item_count, ParallelWork *work, void *context) {
    Job job = {.item_count = item_count, .work = work, .context = context};
    Worker workers[PARALLEL_THREADS_MAX];
    int started = 1; /* the calling thread is worker 0 */
    if (thread_count > PARALLEL_THREADS_MAX) thread_count = PARALLEL_THREADS_MAX;
    if (thread_count > item_count) thread_count = item_count;
    for (; started < thread_count; started++) {
        Worker *worker = &workers[started];
        *worker = (Worker){.job = &job, .index = started};
        if (pthread_create(&worker->thread, NULL, run_worker, worker)) break;
    }
    take_items(&job, 0);
    for (int i = 1; i < started; i++) pthread_join(workers[i].thread, NULL);
}

typedef struct Tries {
    ParallelTry *work;
    void *context;
    bool *failed; /* of each item, as errors: */
    Error *errors;
} Tries;

static void try_item(void *context, int item, int worker) {
    const Tries *tries = context;
    (void)worker;
    tries->failed[item] = !tries->work(tries->context, item, &tries->errors[item]);
}

bool parallel_try(int thread_count, int item_count, ParallelTry *work, void *context, Arena scratch,
                  Error *err) {
    Tries tries = {work, context, ARENA_NEW(&scratch, bool, item_count),
                   ARENA_NEW(&scratch, Error, item_count)};
    parallel_for(thread_count, item_count, try_item, &tries);
    for (int i = 0; i < item_count; i++)
        if (tries.failed[i]) {
            *err = tries.errors[i];
            return false;
        }
    return true;
}

static void *wait_at(void *gate) {
    pthread_mutex_lock(gate);
    pthread_mutex_unlock(gate);
    return NULL;
}

int parallel_grantable_threads(int wanted) {
    pthread_t threads[PARALLEL_THREADS_MAX];
    pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
    int started = 1; /* the caller's own */
    if (wanted > PARALLEL_THREADS_MAX) wanted = PARALLEL_THREADS_MAX;
    pthread_mutex_lock(&gate);
    while (started < wanted && !pthread_create(&threads[started], NULL, wait_at, &gate)) started++;
    pthread_mutex_unlock(&gate);
    for (int i = 1; i < started; i++) pthread_join(threads[i], NULL);
    return started;
}

int parallel_default_threads(void) {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed)) return 1;
    int count = CPU_COUNT(&allowed);
    return count < 1 ? 1 : count > PARALLEL_THREADS_MAX ? PARALLEL_THREADS_MAX : count;
}
