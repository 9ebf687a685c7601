/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/bent_ray.h"

#include <math.h>

#define NODE_STEP_M 20.0
#define REFRACTIVITY 2.778e-4
#define SEA_LEVEL_DENSITY 1.18561e-4 /* m^-1, of air.h's molecules: g / (R T) */

BentAir bent_air_build(const AirOptics *optics, Arena *arena) {
    BentAir air = {.optics = optics, .count = (int)(optics->top_m / NODE_STEP_M) + 1};
    for (int p = 0; p < AIR_PARTS; p++) air.above[p] = ARENA_NEW(arena, double, (size_t)air.count);
    air.radius = ARENA_NEW(arena, double, (size_t)air.count);
    for (int i = 0; i < air.count; i++) {
        double z = i * NODE_STEP_M, column[AIR_PARTS];
        double density = air_density(optics, AIR_MOLECULES, z) / SEA_LEVEL_DENSITY;
        air_vertical(optics, z, optics->top_m, column);
        for (int p = 0; p < AIR_PARTS; p++) air.above[p][i] = column[p];
        air.radius[i] = (AIR_EARTH_M + z) * (1 + REFRACTIVITY * density);
    }
    return air;
}

static double read_at(const BentAir *air, const double *value, double altitude_m) {
    double x = fmax(0, fmin(altitude_m / NODE_STEP_M, air->count - 1.000001));
    int i = (int)x;
    return value[i] + (value[i + 1] - value[i]) * (x - i);
}

/* Altitude at which n r is p: it rises with r, since n falls by less than 1 / r. */
static double perigee(const BentAir *air, double p) {
    int low = 0, high = air->count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (air->radius[middle] <= p) low = middle;
        else high = middle;
    }
    double share = (p - air->radius[low]) / (air->radius[low + 1] - air->radius[low]);
    return (low + fmax(0, fmin(1, share))) * NODE_STEP_M;
}

double bent_ray_edge_cosine(const BentAir *air, double altitude_m, double floor_m) {
    double ratio =
        read_at(air, air->radius, floor_m) / read_at(air, air->radius, fmax(altitude_m, floor_m));
    return -sqrt(fmax(0, 1 - ratio * ratio));
}

/* Shells as air.c's, from an altitude up; adds their columns and gives the ray's turn. */
static double add_shells(const BentAir *air, double from_m, double p, double column[AIR_PARTS]) {
    double low = from_m, bending = 0, a = fmax(p, read_at(air, air->radius, low));
    for (int i = 1; low < air->optics->top_m; i++) {
        double high = fmin(air->optics->top_m, from_m + 2.0 * i * i * i + 40.0 * i);
        double b = fmax(a + 1e-3, read_at(air, air->radius, high));
        double slant = (sqrt(b * b - p * p) - sqrt(fmax(0, a * a - p * p))) / (b - a);
        for (int k = 0; k < AIR_PARTS; k++)
            column[k] +=
                slant * (read_at(air, air->above[k], low) - read_at(air, air->above[k], high));
        double thinner = a / (AIR_EARTH_M + low) - b / (AIR_EARTH_M + high);
        bending += thinner * slant * 2 * p / (a + b);
        low = high;
        a = b;
    }
    return bending;
}

double bent_ray_column(const BentAir *air, double altitude_m, double cosine,
                       double column[AIR_PARTS]) {
    double p = read_at(air, air->radius, altitude_m) * sqrt(fmax(0, 1 - cosine * cosine));
    double here[AIR_PARTS] = {0, 0, 0};
    for (int k = 0; k < AIR_PARTS; k++) column[k] = 0;
    if (cosine >= 0) return add_shells(air, altitude_m, p, column);
    double whole = add_shells(air, perigee(air, p), p, column);
    double bending = 2 * whole - add_shells(air, altitude_m, p, here);
    for (int k = 0; k < AIR_PARTS; k++) column[k] = 2 * column[k] - here[k];
    return bending;
}
