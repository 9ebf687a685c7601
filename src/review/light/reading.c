#include "review/light/reading.h"

#include <math.h>

#include "base/parallel.h"

#define CHUNK 64
#define LEAST (16 * CHUNK)

typedef struct ChunkSums {
    double reflected, mirror;
    long   found;
} ChunkSums;

typedef struct Round {
    const ProbeAim *aim;
    const Kernel   *kernel;
    int             first; /* chunk */
    ChunkSums      *sums;  /* of the round's chunks */
} Round;

static void read_chunk(void *user, int item, int worker)
{
    (void)worker;
    const Round   *round = user;
    ProbeLook      looks[CHUNK];
    PathStatistics statistics = {0};
    int            first = (round->first + item) * CHUNK;
    ChunkSums     *sums = &round->sums[item];
    round->kernel->look(round->aim, first, first + CHUNK, looks, &statistics);
    for (int i = 0; i < CHUNK; i++) {
        sums->reflected += (double)looks[i].reflected[1];
        sums->mirror += (double)looks[i].mirror[1];
        sums->found += looks[i].is_found;
    }
}

/* Of all rounds so far. */
typedef struct ReadingSums {
    double reflected, mirror, squares; /* squares: of the chunks' means */
    long   found, chunks;
} ReadingSums;

static void add_round(ReadingSums *to, const ChunkSums *sums, int chunks)
{
    for (int k = 0; k < chunks; k++) {
        double mean = sums[k].reflected / CHUNK;
        to->reflected += mean;
        to->mirror += sums[k].mirror / CHUNK;
        to->squares += mean * mean;
        to->found += sums[k].found;
    }
    to->chunks += chunks;
}

static Reading reading_of(const ReadingSums *sums)
{
    double  n = (double)sums->chunks, share = (double)sums->found / (n * CHUNK);
    double  mean = sums->reflected / n;
    Reading reading = {.found_share = share, .paths = sums->chunks * CHUNK};
    if (!(share > 0)) return reading;
    double variance = fmax(sums->squares / n - mean * mean, 0) / (n - 1);
    reading.reflected = mean / share;
    reading.mirror = sums->mirror / n / share;
    reading.sigma = sqrt(variance) / share;
    return reading;
}

/* By how much of itself one standard error moves what counts. */
static double uncertainty(const Reading *reading, const ReadingGoal *goal)
{
    double r = fmax(reading->reflected, 0);
    if (goal->brighter <= 0 && goal->darker <= 0)
        return r > 0 ? reading->sigma / r : 0;
    double bright = goal->brighter + r, dark = goal->darker + r;
    if (!(dark > 0)) return reading->sigma > 0 ? (double)INFINITY : 0;
    return fabs(1 / bright - 1 / dark) * reading->sigma;
}

Reading reading_take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                     Arena scratch)
{
    ReadingSums sums = {0};
    Reading     reading;
    int         chunks = LEAST / CHUNK;
    do {
        Arena room = scratch;
        Round round = {aim, tools->kernel, (int)sums.chunks,
                       ARENA_NEW(&room, ChunkSums, chunks)};
        parallel_for(tools->threads, chunks, read_chunk, &round);
        add_round(&sums, round.sums, chunks);
        reading = reading_of(&sums);
        chunks = (int)sums.chunks;
    } while (uncertainty(&reading, goal) > goal->precision && 2 * reading.paths <= goal->most);
    return reading;
}
