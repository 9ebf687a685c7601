/* SPDX-License-Identifier: Apache-2.0 */
/* reading_batch.h -- the sums of one batch of a reading's paths: added up, scaled to other
 * levels of displays, and as bytes that are kept.
 *
 * Units    cd m^-2 (a luxmeter: lx).
 * Threads  a batch belongs to one thread.
 */
#pragma once
#include "estimate/estimate.h"
#include "kernel/probe.h"

#define BATCH_MOMENTS 8

/* The light of one display. */
typedef struct Own {
    double reflected, mirror; /* sums */
} Own;

typedef struct Batch {
    double reflected, mirror; /* sums */
    long   found;
    long   sky_finds;       /* PathStatistics' */
    double sent_on;
    BrightSamples bright;
    double moments[BATCH_MOMENTS];          /* a shared reading's, */
    Own    display[PROBE_DISPLAYS];   /* and its scene's displays' */
} Batch;

/* with_own: what displays send is kept apart. */
void reading_batch_add(Batch *to, const ProbeLook *looks, int count, bool with_own);

/* batches: ESTIMATE_BATCHES, as below. The light of each display times scale[display]. */
void reading_batches_scale(Batch *batches, const double *scale, int displays);

/* As a file keeps them, with as many displays as the scene has: bytes of one; to and from move
 * on. */
size_t reading_batch_bytes(int displays);
void   reading_batches_pack(const Batch *batches, int displays, unsigned char **to);
void   reading_batches_unpack(const unsigned char **from, int displays, Batch *batches);

/* Whether so many paths in each may have made them. */
bool reading_batches_are_sound(const Batch *batches, long paths, int displays);
