/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/light_bands.h"

#include <math.h>
#include <string.h>

#include "base/units.h"

#define OFFSETS 4 /* in a band */

static void add_bands(const Wavelengths *w, Spectrum radiance, double weight,
                      float bands[LIGHT_BANDS])
{
    Spectrum luminance = radiance * w->xyz[1] * spectrum_all((float)weight);
    for (int i = 0; i < LIGHT_BANDS; i++) bands[i] += luminance[i];
}

static Wavelengths wavelengths_of(int offset)
{
    Wavelengths w;
    wavelengths_sample(((float)offset + 0.5f) / OFFSETS, &w);
    return w;
}

void light_bands_sky(const Daylight *daylight, float elevation, float azimuth,
                     float bands[LIGHT_BANDS])
{
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    for (int k = 0; k < OFFSETS; k++) {
        Wavelengths w = wavelengths_of(k);
        add_bands(&w, daylight_radiance(daylight, elevation, azimuth, &w), 1.0 / OFFSETS,
                  bands);
    }
}

void light_bands_curve(const Curve *curve, float bands[LIGHT_BANDS])
{
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    for (int k = 0; k < OFFSETS; k++) {
        Wavelengths w = wavelengths_of(k);
        add_bands(&w, curve_lookup(curve, &w), 1.0 / OFFSETS, bands);
    }
}

void light_bands_white(float bands[LIGHT_BANDS])
{
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
void light_bands_sun(const Daylight *daylight, float bands[LIGHT_BANDS])
{
    memset(bands, 0, LIGHT_BANDS * sizeof *bands);
    if (!daylight->has_sun) return;
    double sine = sin(daylight->sun_radius);
    light_bands_curve(&daylight->sun_mean, bands);
    for (int b = 0; b < LIGHT_BANDS; b++) bands[b] *= (float)(PI * sine * sine);
}

double light_bands_sum(const float shares[LIGHT_BANDS], const float bands[LIGHT_BANDS])
{
    double sum = 0;
    for (int b = 0; b < LIGHT_BANDS; b++) sum += (double)shares[b] * (double)bands[b];
    return sum;
}
