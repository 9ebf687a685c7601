/* SPDX-License-Identifier: Apache-2.0 */
/* pilot.h -- gives samples to the pixels where the noise is.
 *
 * Before the first sample that counts, PILOT_SAMPLES of other random numbers are taken of every
 * pixel of the crop. Squares of PILOT_SIDE pixels, which lie in the frame the same way for
 * every crop, share what theirs show: e, the standard error of a sample by the luminance (as
 * film.h's relative error). A pixel's samples go with e^(2/3): of all ways to spend a number of
 * samples that one leaves the least mean error, the least sum of e_i / sqrt(n_i) with the sum
 * of n_i given. A square of usual noise has PILOT_USUAL of SAMPLE_SHARE_ALL samples; none has
 * less than PILOT_LEAST. What is usual is found from some rows of squares of the whole frame,
 * so that the pixels of each crop take what they take in the frame.
 *
 * The pilot's samples and rays stand in no count of the frame's; its time is building time.
 * The same shares for every seed and sample range. Black frames have all samples everywhere.
 *
 * Memory   the shares are the arena's; meanwhile a film of PILOT_BAND rows.
 * Threads  starts its own.
 */
#pragma once
#include "base/progress.h"
#include "film/sample_shares.h"
#include "kernel/kernel.h"

#define PILOT_SAMPLES 4u
#define PILOT_SIDE 4
#define PILOT_USUAL 16
#define PILOT_LEAST 4
#define PILOT_BAND 64

typedef struct Pilot {
    const Kernel *kernel;
    const PathContext *context; /* with its guide */
    const Camera *camera;
    FilmRect crop;
    int threads;
    ProgressMode progress;
} Pilot;

/* Of the crop's pixels. */
SampleShares pilot_shares(const Pilot *pilot, Arena *arena);
