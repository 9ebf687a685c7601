/* SPDX-License-Identifier: Apache-2.0 */
/* network.h -- the trained network over a picture of any size.
 *
 * A U-Net of 3x3 convolutions (README.md has its table): 9 numbers a pixel in, 3 out. It runs
 * through the picture from top to bottom, and every step of it keeps only the rows that a later
 * one still needs. So there are no tiles and no seams, and the memory grows with the width
 * alone: 132 KB for each of 1,280 pixels, 149 KB for each of 4,096.
 *
 * Threads  as many as requested; the same bits for any number.
 * Memory   of the rows: scratch.
 * Fails    reading the weights does, with the file's name.
 */
#pragma once
#include "denoise/weights.h"

enum { NETWORK_CONVOLUTIONS = 16, NETWORK_INPUTS = 9, NETWORK_OUTPUTS = 3 };

typedef struct Network {
    Weights layers[NETWORK_CONVOLUTIONS];
} Network;

bool network_read(const WeightFile *file, Arena *arena, Network *out, Error *err);

enum { NETWORK_STRIDE = 16 }; /* numbers from one pixel of a row to the next, in and out */

typedef struct NetworkPicture {
    int width, height;
    void *user;
    /* Fills the first NETWORK_INPUTS numbers of each pixel of a row; called by several
     * threads, for the last row perhaps more than once. Numbers that are not finite spread over
     * the picture. */
    void (*fill)(void *user, int y, float *row);
    /* Takes the first NETWORK_OUTPUTS numbers of each pixel: at least 0. */
    void (*take)(void *user, int y, const float *row);
} NetworkPicture;

void network_run(const Network *network, const NetworkPicture *picture, int threads, Arena scratch);
