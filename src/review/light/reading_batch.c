/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/reading_batch.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Moments of light x that no level changes and light y of displays: sums of x^i y^k over paths,
 * for the squares and fourths of x + y at any level. */
static const int MOMENT[BATCH_MOMENTS][2] = {{2, 0}, {1, 1}, {0, 2}, {4, 0},
                                             {3, 1}, {2, 2}, {1, 3}, {0, 4}};

static double power(double x, int exponent)
{
    double out = 1;
    while (exponent-- > 0) out *= x;
    return out;
}

static void add_own(Batch *to, const ProbeLook *look)
{
    double y = 0;
    for (int d = 0; d < PROBE_DISPLAYS; d++) {
        to->display[d].reflected += (double)look->display[d].reflected;
        to->display[d].mirror += (double)look->display[d].mirror;
        y += (double)look->display[d].reflected;
    }
    double x = (double)look->reflected[1] - y;
    for (int m = 0; m < BATCH_MOMENTS; m++)
        to->moments[m] += power(x, MOMENT[m][0]) * power(y, MOMENT[m][1]);
}

void reading_batch_add(Batch *to, const ProbeLook *looks, int count, bool with_own)
{
    for (int i = 0; i < count; i++) {
        to->reflected += (double)looks[i].reflected[1];
        to->mirror += (double)looks[i].mirror[1];
        bright_add(&to->bright, (double)looks[i].reflected[1]);
        to->found += looks[i].is_found;
        if (with_own && looks[i].is_found) add_own(to, &looks[i]);
    }
}

static double greatest(const double *scale, int displays)
{
    double most = displays ? scale[0] : 1;
    for (int d = 1; d < displays; d++) most = fmax(most, scale[d]);
    return most;
}

/* Displays that are scaled differently count as the brightest of them: it widens. */
static BrightSamples scaled_bright(const double moments[BATCH_MOMENTS], double scale)
{
    double s2 = scale * scale;
    return (BrightSamples){
        .squares = moments[0] + 2 * scale * moments[1] + s2 * moments[2],
        .fourths = moments[3] + 4 * scale * moments[4] + 6 * s2 * moments[5] +
                   4 * s2 * scale * moments[6] + s2 * s2 * moments[7]};
}

void reading_batches_scale(Batch *batches, const double *scale, int displays)
{
    for (int i = 0; i < ESTIMATE_BATCHES; i++) {
        Batch *b = &batches[i];
        for (int d = 0; d < displays; d++) {
            b->reflected += (scale[d] - 1) * b->display[d].reflected;
            b->mirror += (scale[d] - 1) * b->display[d].mirror;
        }
        b->bright = scaled_bright(b->moments, greatest(scale, displays));
    }
}

/* A sum of numbers is finite only if each of them is. */
bool reading_batches_are_sound(const Batch *batches, long paths, int displays)
{
    bool ok = true;
    for (int i = 0; i < ESTIMATE_BATCHES; i++) {
        const Batch *b = &batches[i];
        double sum = b->reflected + b->mirror + b->sent_on + b->bright.squares +
                     b->bright.fourths;
        for (int m = 0; m < BATCH_MOMENTS; m++) sum += b->moments[m];
        for (int d = 0; d < displays; d++)
            sum += b->display[d].reflected + b->display[d].mirror;
        ok = ok && isfinite(sum) && b->found >= 0 && b->found <= paths && b->sky_finds >= 0;
    }
    return ok;
}

size_t reading_batch_bytes(int displays)
{
    return offsetof(Batch, display) + (size_t)displays * sizeof(Own);
}

void reading_batches_pack(const Batch *batches, int displays, unsigned char **to)
{
    for (int i = 0; i < ESTIMATE_BATCHES; i++, *to += reading_batch_bytes(displays))
        memcpy(*to, &batches[i], reading_batch_bytes(displays));
}

void reading_batches_unpack(const unsigned char **from, int displays, Batch *batches)
{
    for (int i = 0; i < ESTIMATE_BATCHES; i++, *from += reading_batch_bytes(displays)) {
        batches[i] = (Batch){0};
        memcpy(&batches[i], *from, reading_batch_bytes(displays));
    }
}
