/* SPDX-License-Identifier: Apache-2.0 */
/* light_fixture.h -- what tests of lights share: random numbers, means with their error, and
 * the illuminance that a set of lights gives by its own samples. */
#pragma once
#include "fixture.h"

#include "base/units.h"
#include "light/light.h"
#include "scene_builder.h"

#define SAMPLES 200000

static inline float random_unit(uint32_t *state) {
    *state = *state * 747796405u + 2891336453u;
    return unit_float(hash_u32(*state));
}

static inline void random3(uint32_t *state, float u[3]) {
    for (int i = 0; i < 3; i++) u[i] = random_unit(state);
}

/* Mean and standard error of a running sum. */
typedef struct Mean {
    double sum, squares;
    long count;
} Mean;

static inline void mean_add(Mean *mean, double value) {
    mean->sum += value;
    mean->squares += value * value;
    mean->count++;
}

static inline void assert_mean(const char *what, Mean mean, double expected) {
    double value = mean.sum / (double)mean.count;
    double variance = mean.squares / (double)mean.count - value * value;
    double sigma = sqrt(fmax(variance, 0) / (double)mean.count) + 1e-6 * fabs(expected);
    if (!(fabs(value - expected) <= 4 * sigma) || !(sigma < 0.02 * fabs(expected)))
        fail_msg("%s: %.7g +- %.2g, expected %.7g", what, value, sigma, expected);
}

/* Illuminance, lx, of one set at `position` on a plane with normal n, by its own samples. */
static inline Mean illuminance(const Lights *lights, LightSet set, Vec3 position, Vec3 n) {
    Mean mean = {0};
    uint32_t random = 11;
    LitPoint point = {position, n, false};
    for (int i = 0; i < SAMPLES; i++) {
        Wavelengths w;
        LightSample sample;
        float u[3], xyz[3] = {0};
        random3(&random, u);
        wavelengths_sample(random_unit(&random), &w);
        if (lights_sample(lights, set, point, u, &sample)) {
            float cosine = fmaxf(vec3_dot(n, sample.wi), 0);
            spectrum_add_xyz(
                &w, lights_radiance(lights, &sample, &w) * spectrum_all(cosine / sample.pdf), xyz);
        }
        mean_add(&mean, (double)xyz[1]);
    }
    return mean;
}

/* By the set's own samples at the origin, facing n. */
static inline void assert_illuminance(const char *what, const Lights *lights, LightSet set, Vec3 n,
                                      double expected) {
    assert_mean(what, illuminance(lights, set, vec3(0, 0, 0), n), expected);
}

static inline const Lights *build(const Scene *scene, Arena *arena) {
    Lights *lights;
    assert_done(lights_build(scene, arena, &lights, &err));
    return lights;
}

/* The expectation's own relative variance; how many cells must show it; and by how many
 * standard deviations chi-square may lie above its mean. */
typedef struct ChiLimits {
    double variance;
    int cells;
    double sigmas;
} ChiLimits;

/* Pearson's test, of the case `which`: what was found in cells against what was expected there,
 * in samples, where that is ten or more. */
static inline void assert_chi_square(int which, const double *found, const double *expected,
                                     int count, ChiLimits limits) {
    double chi = 0;
    int cells = 0;
    for (int i = 0; i < count; i++) {
        if (expected[i] < 10) continue;
        chi += (found[i] - expected[i]) * (found[i] - expected[i]) /
               (expected[i] + limits.variance * expected[i] * expected[i]);
        cells++;
    }
    if (!(cells > limits.cells && chi < cells + limits.sigmas * sqrt(2.0 * cells)))
        fail_msg("case %d: chi-square %.1f over %d cells", which, chi, cells);
}
