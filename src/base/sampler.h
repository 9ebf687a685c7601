/* SPDX-License-Identifier: Apache-2.0 */
/* sampler.h -- the random numbers of one sample of one pixel.
 *
 * Owen-scrambled Sobol points, two dimensions at a time, with the order of the points shuffled
 * anew for every pair (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)):
 * every pair of numbers is a (0,2)-sequence over the samples of a pixel, and pairs and pixels
 * are independent. Numbers depend on (seed, pixel, sample, dimension) and on nothing else.
 * What is drawn at one dimension in every sample is well spread over the samples.
 *
 * Threads  a Sampler is a plain value; nothing is shared.
 */
#pragma once
#include <stdint.h>

#include "base/vec.h"

typedef struct Sampler {
    uint32_t pixel_hash;
    uint32_t index_reversed; /* sample index, lowest bit first */
    uint32_t dimension;      /* of the next pair: pairs handed out so far, unless it was set */
} Sampler;

/* A good 32-bit mixer (full avalanche; constants of Wellons' "lowbias32"). */
static inline uint32_t hash_u32(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

static inline uint32_t hash_combine(uint32_t hash, uint32_t value) {
    return hash_u32(hash ^ (value + 0x9e3779b9u + (hash << 6) + (hash >> 2)));
}

static inline uint32_t reverse_bits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/* Two pairs of numbers on their way at once: first and second of one, first and second of the
 * next. The functions below do to each lane what those above do to one number. */
typedef uint32_t SamplerBits __attribute__((vector_size(16)));

static inline SamplerBits reverse_lanes(SamplerBits x) {
    typedef uint8_t Bytes __attribute__((vector_size(16)));
    x = (SamplerBits)__builtin_shufflevector((Bytes)x, (Bytes)x, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9,
                                             8, 15, 14, 13, 12);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

static inline SamplerBits hash_lanes(uint32_t hash, SamplerBits value) {
    SamplerBits x = hash ^ (value + (0x9e3779b9u + (hash << 6) + (hash >> 2)));
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

/* Owen scrambling of bits in reversed order (lowest first): a hash whose bits flow up only
 * (Laine and Karras 2011, constants of Vegdahl's "Building a better LK hash"). */
static inline SamplerBits owen_scramble_reversed(SamplerBits x, SamplerBits seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The two Sobol dimensions with their bits reversed: the first is the index itself, the second
 * comes by Pascal's matrix modulo 2 in five steps of shifts: x'_i = sum over j of
 * binomial(j, i) x_j. */
static inline SamplerBits sobol_pairs_reversed(SamplerBits x) {
    x ^= (x & (SamplerBits){0, 0xffff0000u, 0, 0xffff0000u}) >> 16;
    x ^= (x & (SamplerBits){0, 0xff00ff00u, 0, 0xff00ff00u}) >> 8;
    x ^= (x & (SamplerBits){0, 0xf0f0f0f0u, 0, 0xf0f0f0f0u}) >> 4;
    x ^= (x & (SamplerBits){0, 0xccccccccu, 0, 0xccccccccu}) >> 2;
    return x ^ (x & (SamplerBits){0, 0xaaaaaaaau, 0, 0xaaaaaaaau}) >> 1;
}

/* x, y: pixel of the whole frame; index: sample, 0 <= index < 2^32 - 1. */
static inline Sampler sampler_start(uint32_t seed, int x, int y, uint32_t index) {
    uint32_t hash = hash_combine(hash_combine(hash_u32(seed), (uint32_t)x), (uint32_t)y);
    return (Sampler){.pixel_hash = hash, .index_reversed = reverse_bits(index)};
}

/* The pair of this dimension and that of the next. */
static inline SamplerBits sampler_bits(const Sampler *sampler) {
    uint32_t d = sampler->dimension, index = sampler->index_reversed;
    SamplerBits seed = hash_lanes(sampler->pixel_hash, (SamplerBits){d, d, d + 1, d + 1});
    /* The order is shuffled so that blocks of 2^k samples stay blocks. */
    SamplerBits place =
        reverse_lanes(owen_scramble_reversed((SamplerBits){index, index, index, index}, seed));
    SamplerBits own = seed * (SamplerBits){0x9e3779b1u, 0x85ebca77u, 0x9e3779b1u, 0x85ebca77u} +
                      (SamplerBits){0xa511e9b3u, 0x63d83595u, 0xa511e9b3u, 0x63d83595u};
    return reverse_lanes(owen_scramble_reversed(sobol_pairs_reversed(place), own));
}

/* 32 random bits as a float in [0, 1), 24 bits of it. */
static inline float unit_float(uint32_t bits) {
    return (float)(int)(bits >> 8) * 0x1p-24f;
}

/* Two numbers in [0, 1), well spread over the samples of the pixel. */
static inline Vec2 sampler_2d(Sampler *sampler) {
    SamplerBits bits = sampler_bits(sampler);
    sampler->dimension++;
    return (Vec2){unit_float(bits[0]), unit_float(bits[1])};
}

/* One number in [0, 1). */
static inline float sampler_1d(Sampler *sampler) {
    return sampler_2d(sampler).x;
}

/* True with probability prob, in [0, 1]. *u becomes as good a number again, and those of either
 * outcome stay as well spread as the strip of u that they come from: another number for the
 * choice would leave a random part of the points. */
static inline bool unit_choose(float *u, float prob) {
    bool chosen = *u < prob;
    float rest = chosen ? *u / prob : (*u - prob) / (1 - prob);
    *u = rest < 0x1.fffffep-1f ? rest : 0x1.fffffep-1f;
    return chosen;
}

/* Two pairs, for less than twice the work: as two calls of sampler_2d. */
static inline void sampler_4d(Sampler *sampler, float u[4]) {
    SamplerBits bits = sampler_bits(sampler);
    sampler->dimension += 2;
    for (int i = 0; i < 4; i++) u[i] = unit_float(bits[i]);
}
