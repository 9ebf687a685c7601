/* Where a fit reads its functions, and the mean over azimuths that the trees leave out. */
#include <math.h>

#include "base/units.h"
#include "hemisphere/geodesic.h"
#include "panel/fit_parts.h"

FitPlaces fit_places(int level, int octants, Arena *arena)
{
    FitPlaces places = {.level = level, .leaves = octants << 2 * level};
    places.count = places.leaves + PANEL_ANGLES * FIT_RING;
    places.direction = ARENA_NEW(arena, Vec3, places.count);
    places.area = ARENA_NEW(arena, double, places.count);
    for (int i = 0; i < places.leaves; i++) {
        places.direction[i] = geodesic_center(level, (uint32_t)i);
        places.area[i] = geodesic_area(level, (uint32_t)i);
    }
    double turn = octants == 4 ? 2 * PI : PI;
    for (int i = 0; i < PANEL_ANGLES * FIT_RING; i++) {
        double theta = fmin(radians_from_degrees(0.5 * (i / FIT_RING)), 0.5 * PI - 1e-4);
        double phi = turn * (i % FIT_RING + 0.5) / FIT_RING;
        places.direction[places.leaves + i] =
            vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                 (float)cos(theta));
    }
    return places;
}

float *fit_profile(const FitPlaces *places, float *values, int components, Arena *arena)
{
    size_t size = (size_t)components;
    float *profile = ARENA_NEW(arena, float, PANEL_ANGLES * size);
    const float *ring = values + (size_t)places->leaves * size;
    for (int i = 0; i < PANEL_ANGLES * FIT_RING; i++)
        for (size_t k = 0; k < size; k++)
            profile[(size_t)(i / FIT_RING) * size + k] += ring[(size_t)i * size + k] / FIT_RING;
    for (int i = 0; i < places->leaves; i++) {
        float t;
        int   node = panel_angle_node(panel_polar_angle(places->direction[i]), &t);
        const float *a = profile + (size_t)node * size, *b = a + size;
        for (size_t k = 0; k < size; k++)
            values[(size_t)i * size + k] -= lerpf(a[k], b[k], t);
    }
    return profile;
}
