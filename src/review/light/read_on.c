/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/read_on.h"

#include <math.h>

#include "base/sampler.h"

#define TIMES 8
#define SEED 0x64656369u

/* After rounds of last / 8, last / 64 ... one of `needed` paths more is in READ_ON_BUDGET times
 * `needed`: 1 + 1 + 1/8 + 1/64 ... */
long read_on_paths(long last, long left)
{
    if (left < READING_LEAST) return 0;
    return left < 2 * TIMES * last ? left : TIMES * last;
}

double read_on_widening(int round)
{
    double freedom = READING_BATCHES - 1;
    return student_quantile_missing(freedom, ldexp(CONFIDENCE_MISS, -round)) /
           student_quantile(freedom);
}

static void widen(Reading *reading, double factor)
{
    MeanInterval *in = &reading->interval;
    in->low = fmax(reading->reflected - factor * (reading->reflected - in->low), 0);
    in->high = reading->reflected + factor * (in->high - reading->reflected);
}

Reading setup_read_on(const Setup *setup, const ProbeAim *aim, const ReadingGoal *goal,
                      const ReadOn *from, Arena scratch)
{
    Reading     reading = from->reading;
    ReadingGoal plain = *goal;
    ProbeAim    own = *aim;
    long        left = from->budget - reading.paths;
    plain.question = NULL;
    plain.precision = 0;
    plain.times = 1;
    plain.least = 0;
    for (int round = 1; from->is_worth(goal->question->user, &reading, scratch); round++) {
        plain.most = read_on_paths(reading.paths, left);
        if (!plain.most) break;
        own.seed = hash_combine(own.seed, SEED);
        reading = reading_take(&own, &plain, &setup->tools, scratch);
        widen(&reading, read_on_widening(round));
        left -= reading.paths;
    }
    return reading;
}
