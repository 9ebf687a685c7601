/* sampler.h -- the random numbers of one sample of one pixel.
 *
 * Owen-scrambled Sobol points, two dimensions at a time, with the order of the points shuffled
 * anew for every pair (Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4)):
 * every pair of numbers is a (0,2)-sequence over the samples of a pixel, and pairs and pixels
 * are independent. Numbers depend on (seed, pixel, sample, call count) and on nothing else.
 *
 * Threads  a Sampler is a plain value; nothing is shared.
 */
#pragma once
#include <stdint.h>

#include "base/vec.h"

typedef struct Sampler {
    uint32_t pixel_hash;
    uint32_t index_reversed; /* sample index, lowest bit first */
    uint32_t dimension;      /* pairs handed out so far */
} Sampler;

/* A good 32-bit mixer (full avalanche; constants of Wellons' "lowbias32"). */
static inline uint32_t hash_u32(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

static inline uint32_t hash_combine(uint32_t hash, uint32_t value)
{
    return hash_u32(hash ^ (value + 0x9e3779b9u + (hash << 6) + (hash >> 2)));
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = __builtin_bswap32(x);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

/* Owen scrambling of bits in reversed order (lowest first): a hash whose bits flow up only
 * (Laine and Karras 2011, constants of Vegdahl's "Building a better LK hash"). */
static inline uint32_t owen_scramble_reversed(uint32_t x, uint32_t seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The second Sobol dimension with its bits reversed, by Pascal's matrix modulo 2 in five steps
 * of shifts: x'_i = sum over j of binomial(j, i) x_j. (The first is the index itself.) */
static inline uint32_t sobol_second_reversed(uint32_t index)
{
    uint32_t x = index;
    x ^= (x & 0xffff0000u) >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xaaaaaaaau) >> 1;
    return x;
}

/* 32 random bits as a float in [0, 1), 24 bits of it. */
static inline float unit_float(uint32_t bits)
{
    return (float)(bits >> 8) * 0x1p-24f;
}

/* x, y: pixel of the whole frame; index: sample, 0 <= index < 2^32 - 1. */
static inline Sampler sampler_start(uint32_t seed, int x, int y, uint32_t index)
{
    uint32_t hash = hash_combine(hash_combine(hash_u32(seed), (uint32_t)x), (uint32_t)y);
    return (Sampler){.pixel_hash = hash, .index_reversed = reverse_bits(index)};
}

/* Two numbers in [0, 1), well spread over the samples of the pixel. */
static inline Vec2 sampler_2d(Sampler *sampler)
{
    uint32_t seed = hash_combine(sampler->pixel_hash, sampler->dimension++);
    /* The order is shuffled so that blocks of 2^k samples stay blocks. */
    uint32_t index = reverse_bits(owen_scramble_reversed(sampler->index_reversed, seed));
    uint32_t a = owen_scramble_reversed(index, seed * 0x9e3779b1u + 0xa511e9b3u);
    uint32_t b = owen_scramble_reversed(sobol_second_reversed(index),
                                        seed * 0x85ebca77u + 0x63d83595u);
    return (Vec2){unit_float(reverse_bits(a)), unit_float(reverse_bits(b))};
}

/* One number in [0, 1). */
static inline float sampler_1d(Sampler *sampler)
{
    return sampler_2d(sampler).x;
}
