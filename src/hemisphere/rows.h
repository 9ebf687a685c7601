/* SPDX-License-Identifier: Apache-2.0 */
/* rows.h -- rows of 8- and 16-bit integers to vectors of floats, for tree sums. HOT. */
#pragma once
#include <stdint.h>
#include <string.h>

typedef float Float4 __attribute__((vector_size(16)));
typedef float Float8 __attribute__((vector_size(32)));
typedef int32_t Int4 __attribute__((vector_size(16)));
typedef int16_t Short8 __attribute__((vector_size(16)));
typedef int8_t Byte16 __attribute__((vector_size(16)));

static inline Float4 load_floats(const float *from) {
    Float4 value;
    memcpy(&value, from, sizeof value);
    return value;
}

/* Integers to floats: put into the upper bits of 32-bit lanes and shifted down with their sign
 * (compilers make scalar conversions of the direct way). */
static inline Float4 lower_shorts(Short8 value, int shift) {
    Short8 zero = {0};
    Short8 upper = __builtin_shufflevector(zero, value, 0, 8, 1, 9, 2, 10, 3, 11);
    return __builtin_convertvector((Int4)upper >> shift, Float4);
}

static inline Float4 upper_shorts(Short8 value, int shift) {
    Short8 zero = {0};
    Short8 upper = __builtin_shufflevector(zero, value, 4, 12, 5, 13, 6, 14, 7, 15);
    return __builtin_convertvector((Int4)upper >> shift, Float4);
}

/* Eight bytes to the upper halves of 16 bits. */
static inline Short8 lower_bytes(Byte16 value) {
    Byte16 zero = {0};
    return (Short8)__builtin_shufflevector(zero, value, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6,
                                           22, 7, 23);
}

static inline Short8 upper_bytes(Byte16 value) {
    Byte16 zero = {0};
    return (Short8)__builtin_shufflevector(zero, value, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13,
                                           29, 14, 30, 15, 31);
}

static inline Float4 all_lanes(float value) {
    return (Float4){value, value, value, value};
}
