/* SPDX-License-Identifier: Apache-2.0 */
/* noise_stop.h -- finds how many samples a frame takes for a relative error, from samples that
 * the frame does not have.
 *
 * A frame that stops as soon as its own error is small stops early where rare bright samples
 * have not come yet: it is too dark on average. So some pixels of it, spread evenly over the
 * area that counts and over the rest, are sampled beforehand with other random numbers, pass by
 * pass as the frame will be, until their error (film.h's) and its own standard error are
 * together below what is required. That many samples the frame then has, whatever it shows:
 * its mean is without bias, and its error is measured anew.
 *
 * Rare light  Where one sample in many brings most of a pixel's light, pixels that have had
 *          none of these show no noise, and the mean error is too small. Of the pixels above,
 *          those count as rare of whose noise few samples made the most: (sum d^2)^2 below
 *          NOISE_FEW times sum d^4, d being a sample's distance from the pixel's mean; these
 *          pixels and the frame's have NOISE_LEAST_PATHS samples of the area at least, if need
 *          be by more samples of the former. Spread over all pixels of the area, the noise of
 *          those that count as rare, or of the frame's spikes (film.h) if that is more, makes
 *          the error that there may be. If it is more than NOISE_DOUBT times the measured one
 *          (and chance), the latter is not known yet. What no sample met cannot be reported.
 *
 * The number follows from scene, view, seed and first sample alone: a run that goes on from a
 * checkpoint finds it again. These samples and rays are in no count of the frame's.
 *
 * Memory   the arena's: half a kilobyte for each of the pixels, NOISE_PIXELS_MOST at most.
 * Threads  starts its own; the same for any number.
 */
#pragma once
#include "base/progress.h"
#include "film/sample_shares.h"
#include "kernel/kernel.h"

#define NOISE_LEAST_SAMPLES 16u /* of a frame */
#define NOISE_LEAST_PATHS 65536u
#define NOISE_FEW 4.0
#define NOISE_DOUBT 1.15
#define NOISE_PIXELS_LEAST 512 /* of the area, or all that it has; */
#define NOISE_PIXELS_MOST 4096
#define NOISE_PIXELS_SHARE 64 /* else one in so many of it */

typedef struct NoiseArgs {
    const Kernel *kernel;
    const PathContext *context; /* with its guide */
    const Camera *camera;
    FilmRect crop;
    FilmArea area;               /* whose error counts */
    SampleShares shares;         /* of the crop's pixels */
    uint32_t seed;               /* of the frame */
    uint32_t first_sample, most; /* its first sample, and how many it has at most */
    double error;                /* that is required: above 0 */
    int threads;
    bool stops_at_once; /* at a signal: what is found then is worth nothing */
    ProgressMode progress;
} NoiseArgs;

typedef struct NoisePixel NoisePixel;

/* What was found. */
typedef struct NoiseStop {
    uint32_t samples; /* of the frame */
    bool reached;     /* by them; else they are all that it may have */
    double error;     /* of the pixels then; NaN: none shows the area */
    int pixels;       /* of the area, that decided */
    uint64_t paths;   /* that were traced for it */
    double seconds;
    const NoisePixel *of; /* private: all pixels, */
    int count;
    double lowest; /* the luminance that their noise was judged by at least, cd m^-2 */
    uint32_t first_sample;
} NoiseStop;

NoiseStop noise_stop_find(const NoiseArgs *args, Arena *arena);

/* The relative error that there may be, if what few samples brought is everywhere in the area;
 * spikes: of the frame, after so many samples. NaN: no pixel shows the area. */
double noise_stop_doubt(const NoiseStop *stop, FilmSpikes spikes, uint32_t samples);

/* Whether that is so much more than the frame's own error that the latter is not known. */
bool noise_stop_is_rare(const NoiseStop *stop, double told, double doubt);
