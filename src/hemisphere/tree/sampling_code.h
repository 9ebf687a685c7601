/* SPDX-License-Identifier: Apache-2.0 */
/* sampling_code.h -- bits of a sampling tree's blob. Private to src/hemisphere.
 *
 * Rice's code with parameter k (R. F. Rice 1979): a whole number n as n >> k in ones, a zero,
 * and the k low bits; differences d as n = 2 d or -2 d - 1. Bits are filled from the lowest of
 * each byte.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "hemisphere/tree/sampling_tree.h"

#define SAMPLING_RICE_BITS 3 /* of the parameter, in front of every function's steps */

/* The probability that a stored step stands for: 0 at step 0, 1 at the last. Steps are about
 * as wide as the error that adds the same variance anywhere between 0 and 1. */
static inline float sampling_probability(uint32_t step) {
    double x = (double)step / SAMPLING_STEPS;
    return (float)(x * x * (3 - 2 * x));
}

/* The probability of a child under the very floats that sampling compares with. */
static inline double sampling_child_probability(const SamplingChoice *choice, uint32_t child) {
    double pair = (double)choice->pair, inside = (double)choice->inside[child / 2];
    return (child < 2 ? pair : 1 - pair) * (child % 2 == 0 ? inside : 1 - inside);
}

/* How many steps a function's node has. The two octants of a symmetric function have their
 * mirror images' probabilities: one step chooses among them. */
static inline uint32_t sampling_steps_of(int octants, uint32_t node) {
    return node == 0 && octants == 2 ? 1 : 3;
}

/* Steps of a node to probabilities. */
static inline SamplingChoice sampling_choice(int octants, uint32_t node, const uint8_t *step) {
    float first = sampling_probability(step[0]);
    if (sampling_steps_of(octants, node) == 1) return (SamplingChoice){0.5f, {first, first}};
    return (SamplingChoice){first, {sampling_probability(step[1]), sampling_probability(step[2])}};
}

static inline uint32_t sampling_zigzag(int difference) {
    return difference < 0 ? (uint32_t)(-2 * difference - 1) : (uint32_t)(2 * difference);
}

typedef struct SamplingBits {
    uint8_t *bytes; /* writing: zeros */
    size_t at, end; /* in bits; writing beyond the end only counts */
} SamplingBits;

static inline void sampling_put(SamplingBits *bits, uint32_t value, int count) {
    for (int i = 0; i < count; i++, bits->at++)
        if (bits->at < bits->end && value >> i & 1)
            bits->bytes[bits->at / 8] |= (uint8_t)(1u << bits->at % 8);
}

static inline void sampling_put_rice(SamplingBits *bits, uint32_t value, int k) {
    for (uint32_t i = 0; i < value >> k; i++) sampling_put(bits, 1, 1);
    sampling_put(bits, 0, 1);
    sampling_put(bits, value, k);
}

/* false at the end of the bytes. */
static inline bool sampling_get(SamplingBits *bits, int count, uint32_t *value) {
    *value = 0;
    for (int i = 0; i < count; i++, bits->at++) {
        if (bits->at >= bits->end) return false;
        *value |= (uint32_t)(bits->bytes[bits->at / 8] >> bits->at % 8 & 1) << i;
    }
    return true;
}

/* false also for values that no difference of steps has. */
static inline bool sampling_get_rice(SamplingBits *bits, int k, uint32_t *value) {
    uint32_t one = 1, high = 0, low;
    for (; high <= 2 * SAMPLING_STEPS; high++) {
        if (!sampling_get(bits, 1, &one)) return false;
        if (!one) break;
    }
    if (one || !sampling_get(bits, k, &low)) return false;
    *value = high << k | low;
    return true;
}
