/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/rank.h"

#include <stdbool.h>

#include "base/mathf.h"

/* Radix selection: three rounds over digits of 11, 11 and 10 bits find the one value whose
 * rank is searched for, the highest digit first. */
enum { DIGITS = 2048 };

typedef struct Digit {
    int shift;
    uint32_t mask;
} Digit;

static const Digit DIGIT_OF_ROUND[3] = {{21, 0x7FF}, {10, 0x7FF}, {0, 0x3FF}};

/* Unsigned numbers in the order of the floats. */
static uint32_t ordered_bits(float value) {
    uint32_t bits = bits_from_float(value);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

static float float_of_ordered(uint32_t ordered) {
    return float_from_bits(ordered >> 31 ? ordered & 0x7FFFFFFFu : ~ordered);
}

static size_t values_that_count(size_t count, PixelMask mask) {
    size_t sum = 0;
    if (!mask) return count;
    for (size_t i = 0; i < count; i++) sum += mask[i] != 0;
    return sum;
}

static size_t rank_of_fraction(double fraction, size_t count) {
    double rank = ceil(fraction * (double)count);
    if (!(rank >= 1)) return 0;
    return rank > (double)count ? count - 1 : (size_t)rank - 1;
}

float rank_value(const float *values, size_t count, PixelMask mask, double fraction) {
    size_t members = values_that_count(count, mask);
    uint32_t found = 0, known = 0; /* the digits found so far, and which bits they are */
    if (!members) return NAN;
    size_t rank = rank_of_fraction(fraction, members);
    for (int round = 0; round < 3; round++) {
        const Digit digit = DIGIT_OF_ROUND[round];
        size_t histogram[DIGITS] = {0};
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = ordered_bits(values[i]);
            bool belongs = (!mask || mask[i]) && (bits & known) == found;
            histogram[bits >> digit.shift & digit.mask] += belongs;
        }
        uint32_t chosen = 0;
        while (rank >= histogram[chosen]) rank -= histogram[chosen++];
        found |= chosen << digit.shift;
        known |= digit.mask << digit.shift;
    }
    return float_of_ordered(found);
}

MapSummary map_summary(const float *map, size_t count, PixelMask mask) {
    double sum = 0, members = 0;
    for (size_t i = 0; i < count; i++) {
        if (mask && !mask[i]) continue;
        sum += (double)map[i];
        members++;
    }
    return (MapSummary){.mean = sum / members, /* 0 / 0: no pixel, NaN as promised */
                        .median = (double)rank_value(map, count, mask, 0.5),
                        .p95 = (double)rank_value(map, count, mask, 0.95),
                        .max = (double)rank_value(map, count, mask, 1)};
}
