/* SPDX-License-Identifier: Apache-2.0 */
#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>

/* One call's items, and who works on them. */
typedef struct Job {
    atomic_int next; /* the first item nobody has taken */
    int item_count;
    ParallelWork *work;
    void *context;
    int wanted;  /* threads that may still join it; */
    int workers; /* that have joined, the caller among them; */
    int busy;    /* and of those but the caller, who are not done */
    struct Job *more;
} Job;

/* Threads wait here between two calls: of the many waves of a short reading each would else
 * begin and end all of them. */
static struct {
    pthread_mutex_t lock;
    pthread_cond_t wake, done;
    Job *jobs; /* that want threads, the last call's first: calls within calls end sooner */
    int running;
    bool ends;
    int count;
    pthread_t threads[PARALLEL_THREADS_MAX];
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER,
          .wake = PTHREAD_COND_INITIALIZER,
          .done = PTHREAD_COND_INITIALIZER};

static void take_items(Job *job, int worker) {
    for (;;) {
        int item = atomic_fetch_add(&job->next, 1);
        if (item >= job->item_count) return;
        job->work(job->context, item, worker);
    }
}

static void close_job(const Job *job) {
    for (Job **at = &pool.jobs; *at; at = &(*at)->more)
        if (*at == job) {
            *at = job->more;
            return;
        }
}

static void *wait_for_jobs(void *unused) {
    (void)unused;
    pthread_mutex_lock(&pool.lock);
    for (;;) {
        while (!pool.jobs && !pool.ends) pthread_cond_wait(&pool.wake, &pool.lock);
        if (pool.ends) break;
        Job *job = pool.jobs;
        int worker = job->workers++;
        job->busy++;
        if (!--job->wanted) close_job(job);
        pthread_mutex_unlock(&pool.lock);
        take_items(job, worker);
        pthread_mutex_lock(&pool.lock);
        if (!--job->busy) pthread_cond_broadcast(&pool.done);
    }
    pthread_mutex_unlock(&pool.lock);
    return NULL;
}

/* Signals stay the callers': who blocks them for a while is not stopped by another thread. */
static void grow_pool(int count) {
    sigset_t all, before;
    if (pool.count >= count) return;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    while (pool.count < count &&
           !pthread_create(&pool.threads[pool.count], NULL, wait_for_jobs, NULL))
        pool.count++;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

void parallel_for(int thread_count, int item_count, ParallelWork *work, void *context) {
    Job job = {.item_count = item_count, .work = work, .context = context, .workers = 1};
    if (thread_count > PARALLEL_THREADS_MAX) thread_count = PARALLEL_THREADS_MAX;
    if (thread_count > item_count) thread_count = item_count;
    job.wanted = thread_count - 1;
    if (job.wanted > 0) {
        pthread_mutex_lock(&pool.lock);
        grow_pool(job.wanted);
        pool.running++;
        job.more = pool.jobs;
        pool.jobs = &job;
        for (int i = 0; i < job.wanted; i++) pthread_cond_signal(&pool.wake);
        pthread_mutex_unlock(&pool.lock);
    }
    take_items(&job, 0); /* the calling thread is worker 0 */
    if (thread_count < 2) return;
    pthread_mutex_lock(&pool.lock);
    close_job(&job);
    while (job.busy) pthread_cond_wait(&pool.done, &pool.lock);
    pool.running--;
    pthread_mutex_unlock(&pool.lock);
}

/* Those that wait count as granted: they go, and come again with the next call. Within a call
 * they stay. */
static void end_pool(void) {
    pthread_mutex_lock(&pool.lock);
    bool is_idle = !pool.running;
    pool.ends = is_idle;
    pthread_cond_broadcast(&pool.wake);
    pthread_mutex_unlock(&pool.lock);
    for (; is_idle && pool.count; pool.count--) pthread_join(pool.threads[pool.count - 1], NULL);
    if (is_idle) pool.ends = false;
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
    end_pool();
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
