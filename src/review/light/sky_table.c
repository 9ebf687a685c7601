/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/sky_table.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/units.h"

/* ---- bands ------------------------------------------------------------------------------- */

#define OFFSETS 4 /* in a band */

static void add_bands(const Wavelengths *w, Spectrum radiance, double weight,
                      float bands[LIGHT_BANDS]) {
    Spectrum luminance = radiance * w->xyz[1] * spectrum_all((float)weight);
    for (int i = 0; i < LIGHT_BANDS; i++) bands[i] += luminance[i];
}

static Wavelengths wavelengths_of(int offset) {
    Wavelengths w;
    wavelengths_sample(((float)offset + 0.5f) / OFFSETS, &w);
    return w;
}

void light_bands_sky(const Daylight *daylight, float elevation, float azimuth,
                     float bands[LIGHT_BANDS]) {
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    for (int k = 0; k < OFFSETS; k++) {
        Wavelengths w = wavelengths_of(k);
        add_bands(&w, daylight_radiance(daylight, elevation, azimuth, &w), 1.0 / OFFSETS, bands);
    }
}

void light_bands_curve(const Curve *curve, float bands[LIGHT_BANDS]) {
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    for (int k = 0; k < OFFSETS; k++) {
        Wavelengths w = wavelengths_of(k);
        add_bands(&w, curve_lookup(curve, &w), 1.0 / OFFSETS, bands);
    }
}

void light_bands_white(float bands[LIGHT_BANDS]) {
    float sum = 0;
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    for (int k = 0; k < OFFSETS; k++) {
        Wavelengths w = wavelengths_of(k);
        add_bands(&w, spectrum_all(1), 1, bands);
    }
    for (int b = 0; b < LIGHT_BANDS; b++) sum += bands[b];
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] /= sum;
}

/* The limb darkens around the disc's own mean, which so is all that counts. */
void light_bands_sun(const Daylight *daylight, float bands[LIGHT_BANDS]) {
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    if (!daylight->has_sun) return;
    double sine = sin(daylight->sun_radius);
    light_bands_curve(&daylight->sun_mean, bands);
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] *= (float)(PI * sine * sine);
}

double light_bands_sum(const float shares[LIGHT_BANDS], const float bands[LIGHT_BANDS]) {
    double sum = 0;
    for (int b = 0; b < LIGHT_BANDS; b++) sum += (double)shares[b] * (double)bands[b];
    return sum;
}

/* ---- skies ------------------------------------------------------------------------------- */

/* Close where the air mass changes fast. */
static const double elevations[] = {-12, -9, -6, -4, -2, -1, 0,  0.5, 1,  1.5, 2,
                                    2.5, 3,  4,  5,  6,  8,  10, 13,  16, 20,  25,
                                    30,  36, 42, 48, 54, 60, 66, 72,  78, 84,  90};

/* Those from the last at or below `low` to the first at or above `high`. */
static int elevations_within(double low, double high, int *first) {
    int last = COUNT_OF(elevations) - 1;
    *first = 0;
    while (*first < last && elevations[*first + 1] <= low) (*first)++;
    while (last > *first && elevations[last - 1] >= high) last--;
    return last - *first + 1;
}

SkyTable sky_table_start(const DaylightInput *like, double low_deg, double high_deg, Arena *arena) {
    int first, count = elevations_within(low_deg, high_deg, &first);
    return (SkyTable){
        *like,
        elevations + first,
        arena_alloc(arena, sizeof(float[LIGHT_BANDS]), _Alignof(float), (size_t)count),
        count,
        0,
        SKY_AZIMUTHS,
        NULL};
}

void sky_table_between(SkyTable *table, double low_deg, double high_deg) {
    int first = (int)floor(low_deg / 360 * SKY_AZIMUTHS);
    int last = (int)floor(high_deg / 360 * SKY_AZIMUTHS) + 1; /* to interpolate */
    if (last - first + 1 >= SKY_AZIMUTHS) return;
    table->first_azimuth = (first % SKY_AZIMUTHS + SKY_AZIMUTHS) % SKY_AZIMUTHS;
    table->azimuths = last - first + 1;
}

static const Daylight *build_sky(const DaylightInput *input, Arena *arena, Error *err) {
    Daylight *sky = ARENA_NEW(arena, Daylight, 1);
    return daylight_build(input, arena, sky, err) ? sky : NULL;
}

static DaylightInput row_input(const SkyTable *table, int row) {
    DaylightInput input = table->like;
    input.has_sun = true;
    input.sun_azimuth = 0;
    input.sun_elevation = radians_from_degrees(table->elevation_deg[row]);
    input.sun_lux = -1;
    input.no_moon = true;
    return input;
}

struct KeptSky {
    DaylightInput input;
    const Daylight *sky;
    const KeptSky *before;
};

/* Inputs are the same where all their bytes are: one that differs in none but its padding is
 * made again. */
static const Daylight *build_once(SkiesKept *kept, const DaylightInput *input, Error *err) {
    for (const KeptSky *k = kept->first; k; k = k->before)
        if (!memcmp(&k->input, input, sizeof *input)) return k->sky;
    KeptSky *fresh = ARENA_NEW(kept->room, KeptSky, 1);
    memcpy(&fresh->input, input, sizeof *input);
    fresh->sky = build_sky(input, kept->room, err);
    fresh->before = kept->first;
    if (fresh->sky) kept->first = fresh;
    return fresh->sky;
}

const Daylight *sky_table_make(SkyTable *table, int row, Arena *arena, Error *err) {
    DaylightInput input = row_input(table, row);
    const Daylight *sky =
        table->kept ? build_once(table->kept, &input, err) : build_sky(&input, arena, err);
    if (sky) light_bands_sun(sky, table->sun_bands[row]);
    return sky;
}

bool sky_table_make_suns(SkyTable *table, const Arena *arena, Error *err) {
    for (int row = 0; row < table->count; row++) {
        Arena room = *arena;
        DaylightInput input = row_input(table, row);
        input.sun_alone = true;
        const Daylight *sky = build_sky(&input, &room, err);
        if (!sky) return false;
        light_bands_sun(sky, table->sun_bands[row]);
    }
    return true;
}

int sky_table_row(const SkyTable *table, double elevation_deg, double *share) {
    int row = 0;
    *share = 0;
    if (table->count == 1) return 0;
    while (row < table->count - 2 && table->elevation_deg[row + 1] <= elevation_deg) row++;
    double low = table->elevation_deg[row], high = table->elevation_deg[row + 1];
    *share = fmin(fmax((elevation_deg - low) / (high - low), 0), 1);
    return row;
}

/* The share of the way to the next row in the air mass that the sun's light passes. */
static double share_by_air(const SkyTable *table, int row, double elevation_deg) {
    double low = daylight_air_mass(table->elevation_deg[row]);
    double high = daylight_air_mass(table->elevation_deg[row + 1]);
    return fmin(fmax((daylight_air_mass(elevation_deg) - low) / (high - low), 0), 1);
}

/* Light falls off by powers of the air mass: between two rows that both have some it is the
 * logarithm that is linear. */
void sky_table_sun(const SkyTable *table, double elevation_deg, double light,
                   float bands[LIGHT_BANDS]) {
    double share;
    int row = sky_table_row(table, elevation_deg, &share), next = row + (share > 0);
    if (share > 0 && table->elevation_deg[row] >= 0)
        share = share_by_air(table, row, elevation_deg);
    for (int b = 0; b < LIGHT_BANDS; b++) {
        double low = (double)table->sun_bands[row][b], high = (double)table->sun_bands[next][b];
        bands[b] = (float)(light * (low > 0 && high > 0 ? low * pow(high / low, share)
                                                        : low + share * (high - low)));
    }
}
