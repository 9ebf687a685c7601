/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/reading.h"

#include <math.h>

#include "base/count.h"
#include "base/parallel.h"
#include "base/sampler.h"
#include "review/light/question.h"
#include "review/light/response.h"

/* Batches are alike and independent: each has a seed of its own, its samples are well spread
 * among themselves. */
#define BATCHES 32
#define PIECE 64 /* paths that are looked at together */

typedef struct Batch {
    double reflected, mirror; /* sums */
    long   found;
} Batch;

typedef struct Round {
    const ProbeAim *aim;
    const Kernel   *kernel;
    int             first, end; /* paths of every batch */
    Batch          *batches;
} Round;

static void add_looks(Batch *to, const ProbeLook *looks, int count)
{
    for (int i = 0; i < count; i++) {
        to->reflected += (double)looks[i].reflected[1];
        to->mirror += (double)looks[i].mirror[1];
        to->found += looks[i].is_found;
    }
}

static void read_batch(void *user, int item, int worker)
{
    (void)worker;
    const Round   *round = user;
    ProbeLook      looks[PIECE];
    PathStatistics statistics = {0};
    ProbeAim       aim = *round->aim;
    aim.seed = hash_combine(hash_u32(aim.seed), (uint32_t)item);
    aim.is_spread = true;
    for (int first = round->first; first < round->end; first += PIECE) {
        int end = first + PIECE < round->end ? first + PIECE : round->end;
        round->kernel->look(&aim, first, end, looks, &statistics);
        add_looks(&round->batches[item], looks, end - first);
    }
}

static void add_known(double known, Reading *to)
{
    double error = RESPONSE_MIRROR_ERROR * known;
    to->reflected += known;
    to->mirror += known;
    to->sigma = hypot(to->sigma, error);
    to->interval.low += known - 2 * error;
    to->interval.high += known + 2 * error;
}

/* Of batches with so many paths each; miss: chance that its interval may miss with. */
static Reading reading_of(const Batch batches[BATCHES], int paths, double known, double miss)
{
    BatchSums sums = {0};
    Reading   reading = {.paths = (long)paths * BATCHES};
    double    mirror = 0, found = 0;
    for (int i = 0; i < BATCHES; i++) {
        batch_add(&sums, batches[i].reflected / paths);
        mirror += batches[i].mirror;
        found += (double)batches[i].found;
    }
    if (!(found > 0)) return reading;
    MeanInterval interval = batch_interval(&sums, miss);
    double   share = found / (double)reading.paths;
    reading.found_share = share;
    reading.reflected = sums.sum / BATCHES / share;
    reading.mirror = mirror / found;
    reading.sigma = batch_error(&sums) / share;
    reading.interval = (MeanInterval){fmax(interval.low, 0) / share, interval.high / share};
    add_known(known, &reading);
    return reading;
}

static double relative_error(const Reading *reading)
{
    return reading->reflected > 0 ? reading->sigma / reading->reflected : 0;
}

/* By how much of itself one standard error moves what counts. */
static double uncertainty(const Reading *reading, const ReadingGoal *goal)
{
    double r = fmax(reading->reflected, 0);
    if (goal->brighter <= 0 && goal->darker <= 0) return relative_error(reading);
    double bright = goal->brighter + r, dark = goal->darker + r;
    if (!(dark > 0)) return reading->sigma > 0 ? (double)INFINITY : 0;
    return fabs(1 / bright - 1 / dark) * reading->sigma;
}

static bool is_decided(const Reading *reading, const ReadingGoal *goal, Arena scratch)
{
    const ReadingQuestion *question = goal->question;
    return question && uncertainty(reading, goal) <= question->precision &&
           relative_error(reading) <= question->precision &&
           question->is_decided(question->user, reading->interval, scratch);
}

/* How many rounds a reading may take after its first. */
static int rounds_after(long first, long most)
{
    int rounds = 0;
    for (long paths = 2 * first; paths <= most; paths *= 2) rounds++;
    return rounds;
}

static Reading take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                    Arena scratch)
{
    Batch  *batches = ARENA_NEW(&scratch, Batch, BATCHES);
    int     least = goal->question ? READING_ASKED_LEAST : READING_LEAST;
    int     looks = goal->question ? rounds_after(least, goal->most) : 0;
    Round   round = {aim, tools->kernel, 0, least / BATCHES, batches};
    Reading reading;
    do {
        parallel_for(tools->threads, BATCHES, read_batch, &round);
        reading = reading_of(batches, round.end, goal->known, look_miss(false, looks));
        if (is_decided(&reading, goal, scratch)) return reading;
        round.first = round.end;
        round.end *= 2;
    } while (uncertainty(&reading, goal) > goal->precision && 2 * reading.paths <= goal->most);
    return reading_of(batches, round.first, goal->known, look_miss(true, looks));
}

static JournalKey key_of(const ProbeAim *aim, const ReadingGoal *goal,
                         const ReadingTools *tools, Arena scratch)
{
    const ReadingQuestion *asked = goal->question;
    double   numbers[] = {goal->brighter, goal->darker, goal->precision, (double)goal->most,
                          goal->known, asked ? asked->precision : 0};
    Question question = {.base = tools->base, .kind = asked ? asked->name : "reading",
                         .numbers = numbers, .number_count = COUNT_OF(numbers)};
    return question_key(&question, aim, scratch);
}

Reading reading_take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                     Arena scratch)
{
    Reading reading;
    if (!tools->journal) return take(aim, goal, tools, scratch);
    JournalKey key = key_of(aim, goal, tools, scratch);
    if (journal_find(tools->journal, key, &reading, sizeof reading)) return reading;
    reading = take(aim, goal, tools, scratch);
    journal_add(tools->journal, key, &reading, sizeof reading);
    return reading;
}
