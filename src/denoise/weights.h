/* SPDX-License-Identifier: Apache-2.0 */
/* weights.h -- reads a file of trained weights (.tza, as Open Image Denoise has them).
 *
 * File     little endian: u16 0x41d7, u8 major version 2, u8 minor, u64 offset of the table.
 *          Table: u32 count, then of each tensor u16 length and name, u8 dimensions, u32 each,
 *          a letter each of the layout ("oihw"; "x" of biases), a letter of the type ("f"
 *          32 bits, "h" 16), u64 offset of the numbers.
 * Memory   the arena's.
 * Threads  one at a time; what was read is plain data.
 * Fails    with the file, the tensor and what was required: every byte that is used is checked,
 *          and every number is finite.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

/* A convolution of 3x3 that the network requires. */
typedef struct WeightShape {
    const char *name; /* "enc_conv0": NAME.weight and NAME.bias */
    int inputs, outputs;
} WeightShape;

typedef struct Weights {
    const float *weights; /* as convolution.h orders them, inputs and outputs filled up with
                             zeros to a multiple of CONVOLUTION_GROUP */
    const float *biases;
} Weights;

typedef struct WeightFile {
    const void *bytes;
    size_t size;
    const char *name; /* for messages */
} WeightFile;

/* out: as many as shapes. The file holds these and no other tensors. */
bool weights_read(const WeightFile *file, const WeightShape *shapes, int count, Arena *arena,
                  Weights *out, Error *err);
