/* Where a fit reads its functions, and the smooth part that the trees leave out. */
#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/geodesic.h"
#include "panel/fit/fit_parts.h"

/* Azimuth of a ring's direction. */
static double ring_azimuth(const FitPlaces *places, int i)
{
    return (places->octants == 4 ? 2 * PI : PI) * (i % FIT_RING + 0.5) / FIT_RING;
}

FitPlaces fit_places(int level, int octants, Arena *arena)
{
    FitPlaces places = {.level = level, .octants = octants, .leaves = octants << 2 * level};
    places.count = places.leaves + PANEL_ANGLES * FIT_RING;
    places.direction = ARENA_NEW(arena, Vec3, places.count);
    places.area = ARENA_NEW(arena, double, places.count);
    for (int i = 0; i < places.leaves; i++) {
        places.direction[i] = geodesic_center(level, (uint32_t)i);
        places.area[i] = geodesic_area(level, (uint32_t)i);
    }
    for (int i = 0; i < PANEL_ANGLES * FIT_RING; i++) {
        double theta = fmin(radians_from_degrees(0.5 * (i / FIT_RING)), 0.5 * PI - 1e-4);
        double phi = ring_azimuth(&places, i);
        places.direction[places.leaves + i] =
            vec3((float)(sin_d(theta) * cos_d(phi)), (float)(sin_d(theta) * sin_d(phi)),
                 (float)cos_d(theta));
    }
    return places;
}

/* Factor of a term at an azimuth: 1, cos phi, sin phi, ... or 1, cos phi, cos 2 phi, ... */
static double term_factor(int term, bool has_sines, double phi)
{
    if (!has_sines) return cos_d(term * phi);
    int m = (term + 1) / 2;
    return term % 2 || !term ? cos_d(m * phi) : sin_d(m * phi);
}

float *fit_profile(const FitPlaces *places, float *values, int components, int harmonics,
                   Arena *arena)
{
    bool   has_sines = places->octants == 4;
    int    terms = panel_profile_terms(harmonics, has_sines);
    size_t size = (size_t)components;
    float *out = ARENA_NEW(arena, float, PANEL_ANGLES * (size_t)terms * size);
    const float *ring = values + (size_t)places->leaves * size;
    for (int i = 0; i < PANEL_ANGLES * FIT_RING; i++)
        for (int term = 0; term < terms; term++) {
            float  factor = (float)((term ? 2.0 : 1.0) / FIT_RING *
                                    term_factor(term, has_sines, ring_azimuth(places, i)));
            float *to = out + (size_t)(i / FIT_RING * terms + term) * size;
            for (size_t k = 0; k < size; k++) to[k] += factor * ring[(size_t)i * size + k];
        }
    PanelProfile profile = {out, components, harmonics, has_sines};
    float       *smooth = ARENA_NEW(arena, float, size);
    for (int i = 0; i < places->leaves; i++) {
        for (size_t k = 0; k < size; k++) smooth[k] = 0;
        panel_add_profile(&profile, places->direction[i], 0, components, smooth);
        for (size_t k = 0; k < size; k++) values[(size_t)i * size + k] -= smooth[k];
    }
    return out;
}
