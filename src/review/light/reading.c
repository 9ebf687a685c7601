/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/reading.h"

#include <math.h>

#include "base/count.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/sampler.h"
#include "review/light/question.h"
#include "review/light/response.h"

#define BATCHES READING_BATCHES
#define PIECE 64 /* paths that are looked at together */

typedef struct Batch {
    double reflected, mirror; /* sums */
    long   found;
    BrightSamples bright;
} Batch;

/* Paths that go on where they ended. */
typedef struct Stream {
    ProbeAim      aim;
    const Kernel *kernel;
    int           threads;
    int           first, end; /* paths of every batch */
    Batch        *batches;
} Stream;

static void add_looks(Batch *to, const ProbeLook *looks, int count)
{
    for (int i = 0; i < count; i++) {
        to->reflected += (double)looks[i].reflected[1];
        to->mirror += (double)looks[i].mirror[1];
        bright_add(&to->bright, (double)looks[i].reflected[1]);
        to->found += looks[i].is_found;
    }
}

static void read_batch(void *user, int item, int worker)
{
    (void)worker;
    const Stream  *stream = user;
    ProbeLook      looks[PIECE];
    PathStatistics statistics = {0};
    ProbeAim       aim = stream->aim;
    aim.seed = hash_combine(hash_u32(aim.seed), (uint32_t)item);
    aim.is_spread = true;
    for (int first = stream->first; first < stream->end; first += PIECE) {
        int end = first + PIECE < stream->end ? first + PIECE : stream->end;
        stream->kernel->look(&aim, first, end, looks, &statistics);
        add_looks(&stream->batches[item], looks, end - first);
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

/* Of the light that the found paths bring, of so many times the reading's. */
static double missing(const Reading *reading, double repeated)
{
    return bright_missing(&reading->bright, (double)reading->paths * reading->found_share,
                          repeated);
}

/* Of batches with so many paths each. */
static Reading reading_of(const Batch batches[BATCHES], int paths, double known)
{
    BatchSums sums = {0};
    Reading   reading = {.paths = (long)paths * BATCHES};
    double    mirror = 0, found = 0;
    for (int i = 0; i < BATCHES; i++) {
        batch_add(&sums, batches[i].reflected / paths);
        mirror += batches[i].mirror;
        found += (double)batches[i].found;
        reading.bright.squares += batches[i].bright.squares;
        reading.bright.fourths += batches[i].bright.fourths;
    }
    if (!(found > 0)) return reading;
    MeanInterval interval = batch_interval(&sums);
    double   share = found / (double)reading.paths;
    reading.found_share = share;
    reading.reflected = sums.sum / BATCHES / share;
    reading.mirror = mirror / found;
    reading.sigma = batch_error(&sums) / share;
    reading.interval = (MeanInterval){fmax(interval.low, 0) / share, interval.high / share};
    reading.interval.high += missing(&reading, 1);
    for (int i = 0; i < BATCHES; i++)
        reading.batches[i] = batches[i].reflected / paths / share + known;
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

static bool is_sure(const Reading *reading, const ReadingGoal *goal)
{
    return uncertainty(reading, goal) <= goal->precision;
}

static bool is_decided(const Reading *reading, const ReadingGoal *goal, Arena scratch)
{
    const ReadingQuestion *question = goal->question;
    return uncertainty(reading, goal) <= question->precision &&
           relative_error(reading) <= question->precision &&
           question->is_decided(question->user, reading->interval, scratch);
}

/* ---- one stream -------------------------------------------------------------------------- */

static Stream stream_start(const ProbeAim *aim, const ReadingTools *tools, Arena *arena)
{
    return (Stream){*aim, tools->kernel, tools->threads, 0, 0,
                    ARENA_NEW(arena, Batch, BATCHES)};
}

/* All of its paths, up to so many. */
static Reading stream_read(Stream *stream, long paths, const ReadingGoal *goal)
{
    stream->end = (int)(paths / BATCHES);
    parallel_for(stream->threads, BATCHES, read_batch, stream);
    stream->first = stream->end;
    return reading_of(stream->batches, stream->end, goal->known);
}

/* Until it is sure enough by itself. */
static Reading take_plain(const ProbeAim *aim, const ReadingGoal *goal,
                          const ReadingTools *tools, Arena scratch)
{
    Stream  stream = stream_start(aim, tools, &scratch);
    Reading reading = stream_read(&stream, READING_LEAST, goal);
    while (!is_sure(&reading, goal) && 2 * reading.paths <= goal->most)
        reading = stream_read(&stream, 2 * reading.paths, goal);
    return reading;
}

/* ---- a pilot, and what it asks for ------------------------------------------------------- */

/* What a fresh reading by so many paths may be expected to say, as far as the pilot knows: its
 * interval is as wide as paths make it, and lies somewhere in the pilot's. */
static Reading expected(const Reading *pilot, const ReadingGoal *goal, long paths)
{
    double  scale = sqrt((double)pilot->paths / (double)paths);
    double  known = RESPONSE_MIRROR_ERROR * goal->known;
    double  sampled = sqrt(fmax(pilot->sigma * pilot->sigma - known * known, 0));
    Reading fresh = *pilot;
    fresh.sigma = hypot(sampled * scale, known);
    fresh.interval.low -= (pilot->reflected - pilot->interval.low) * scale;
    fresh.interval.high +=
        (pilot->interval.high - missing(pilot, 1) - pilot->reflected) * scale +
        missing(pilot, (double)paths / (double)pilot->paths);
    fresh.interval.low = fmax(fresh.interval.low, 0);
    return fresh;
}

/* The fewest that will do; the most there are, where none will. */
static long paths_wanted(const Reading *pilot, const ReadingGoal *goal, Arena scratch)
{
    long paths = READING_ASKED_LEAST;
    for (; 2 * paths <= goal->most; paths *= 2) {
        Reading fresh = expected(pilot, goal, paths);
        if (is_sure(&fresh, goal) || is_decided(&fresh, goal, scratch)) break;
    }
    return paths;
}

/* A pilot grows until it asks for no more than so many times its own paths: what it says of
 * fewer is known too badly, and a longer one would cost more than it saves. */
#define PILOT_REACH 4
#define PILOT_SEED 0x70696c6fu

static Reading take_asked(const ProbeAim *aim, const ReadingGoal *goal,
                          const ReadingTools *tools, Arena scratch)
{
    Stream fresh = stream_start(aim, tools, &scratch);
    Stream first = stream_start(aim, tools, &scratch);
    first.aim.seed = hash_combine(hash_u32(aim->seed), PILOT_SEED);
    Reading pilot = stream_read(&first, READING_PILOT, goal);
    long    wanted = paths_wanted(&pilot, goal, scratch);
    while (wanted > PILOT_REACH * pilot.paths) {
        pilot = stream_read(&first, 2 * pilot.paths, goal);
        wanted = paths_wanted(&pilot, goal, scratch);
    }
    if (goal->times > 1) wanted *= goal->times;
    return stream_read(&fresh, wanted > goal->least ? wanted : goal->least, goal);
}

static Reading take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                    Arena scratch)
{
    double  start = monotonic_seconds();
    Reading reading = goal->question ? take_asked(aim, goal, tools, scratch)
                                     : take_plain(aim, goal, tools, scratch);
    reading.reached = uncertainty(&reading, goal);
    reading.seconds = monotonic_seconds() - start;
    return reading;
}

static JournalKey key_of(const ProbeAim *aim, const ReadingGoal *goal,
                         const ReadingTools *tools, Arena scratch)
{
    const ReadingQuestion *asked = goal->question;
    double   numbers[] = {goal->brighter, goal->darker, goal->precision, (double)goal->most,
                          goal->known, asked ? asked->precision : 0,
                          (double)goal->times, (double)goal->least};
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
