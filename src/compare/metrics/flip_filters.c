/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/flip_filters.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

/* a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees. */
typedef struct Sensitivity {
    double a, b;
} Sensitivity;

static const Sensitivity LIGHTNESS = {1, 0.0047}, RED_GREEN = {1, 0.0053},
                         BLUE_YELLOW[2] = {{34.1, 0.04}, {13.5, 0.025}};

#define FEATURE_WIDTH 0.082 /* degrees: of the edges that the eye sees best */

/* exp(-k^2 falloff) out to `radius`, without the tail that double precision hides. */
static FlipFilter bell(double falloff, int radius, Arena *arena) {
    FlipFilter filter = {.weights = ARENA_NEW(arena, double, radius + 1)};
    for (int k = 0; k <= radius; k++) {
        filter.weights[k] = exp_d(-k * k * falloff);
        if (filter.weights[k] > 1e-15) filter.radius = k;
    }
    return filter;
}

static double sum_of(const FlipFilter *filter) {
    double sum = filter->weights[0];
    for (int k = 1; k <= filter->radius; k++) sum += 2 * filter->weights[k];
    return sum;
}

static void scale(FlipFilter *filter, double factor) {
    for (int k = 0; k <= filter->radius; k++) filter->weights[k] *= factor;
}

/* Both parts stay in proportion and together have the sum 1 over the plane, where the sum of
 * a product f(x) f(y) is the square of f's; so f carries the root of its amplitude. */
static void create_blue_yellow(FlipFilters *filters, double pixels_per_degree, int radius,
                               Arena *arena) {
    double whole = 0;
    for (int i = 0; i < 2; i++) {
        const Sensitivity s = BLUE_YELLOW[i];
        FlipFilter *part = &filters->blue_yellow[i];
        *part = bell(PI * PI / (s.b * pixels_per_degree * pixels_per_degree), radius, arena);
        scale(part, sqrt(s.a * sqrt(PI / s.b)));
        whole += sum_of(part) * sum_of(part);
    }
    for (int i = 0; i < 2; i++) scale(&filters->blue_yellow[i], 1 / sqrt(whole));
}

/* Positive and negative weights to the sums 1 and -1, each for itself. Of filters so narrow
 * that a neighbour's weight is 0 nothing is left. */
static void balance(FlipFilter *filter) {
    double positive = 0, negative = 0;
    for (int k = 0; k <= filter->radius; k++) {
        double weight = filter->weights[k] * (k ? 2 : 1);
        positive += weight > 0 ? weight : 0;
        negative -= weight < 0 ? weight : 0;
    }
    for (int k = 0; k <= filter->radius; k++) {
        double sum = filter->weights[k] > 0 ? positive : negative;
        if (sum > 0) filter->weights[k] /= sum;
    }
}

/* With s the standard deviation: exp(-x^2 / 2s^2), its first derivative as x exp(...) and its
 * second as (x^2 / s^2 - 1) exp(...), each up to a factor. */
static void create_features(FlipFilters *filters, double pixels_per_degree, Arena *arena) {
    const double s = 0.5 * FEATURE_WIDTH * pixels_per_degree;
    const int radius = (int)ceil(3 * s);
    filters->gauss = bell(1 / (2 * s * s), radius, arena);
    filters->slope = bell(1 / (2 * s * s), radius, arena);
    filters->curve = bell(1 / (2 * s * s), radius, arena);
    double half = 0;
    for (int k = 0; k <= filters->gauss.radius; k++) {
        filters->slope.weights[k] *= k;
        half += filters->slope.weights[k];
        filters->curve.weights[k] *= k * k / (s * s) - 1;
    }
    scale(&filters->gauss, 1 / sum_of(&filters->gauss));
    if (half > 0) scale(&filters->slope, 1 / half);
    balance(&filters->curve);
}

FlipFilters flip_filters_create(double pixels_per_degree, Arena *arena) {
    const double area = pixels_per_degree * pixels_per_degree;
    /* three standard deviations of the widest: 0.135 degrees, the features' are 0.123 */
    const int radius = (int)ceil(3 * sqrt(BLUE_YELLOW[0].b / 2) / PI * pixels_per_degree);
    FlipFilters filters = {
        .radius = radius,
        .lightness = bell(PI * PI / (LIGHTNESS.b * area), radius, arena),
        .red_green = bell(PI * PI / (RED_GREEN.b * area), radius, arena),
    };
    scale(&filters.lightness, 1 / sum_of(&filters.lightness));
    scale(&filters.red_green, 1 / sum_of(&filters.red_green));
    create_blue_yellow(&filters, pixels_per_degree, radius, arena);
    create_features(&filters, pixels_per_degree, arena);
    return filters;
}
