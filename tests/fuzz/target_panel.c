/* SPDX-License-Identifier: Apache-2.0 */
/* Panel files: what opens answers every question with finite numbers. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/units.h"
#include "harness.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_file.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_sampling.h"
#include "panel/query/panel_zones.h"
#include "panel/zones/backlight_at.h"

static bool all_in(const float *value, int count, float low) {
    for (int i = 0; i < count; i++)
        if (!(value[i] >= low && value[i] < INFINITY)) return false;
    return true;
}

static Vec3 direction(float theta, float phi) {
    return vec3(sinf(theta) * cosf(phi), sinf(theta) * sinf(phi), cosf(theta));
}

static void claim_emission(const Panel *panel, Vec3 wo, const Wavelengths *w) {
    const float rgb[3] = {255, 90.5f, 3};
    float xyz[3];
    panel_emission_xyz(panel, wo, rgb, xyz);
    fuzz_claim(all_in(xyz, 3, 0), "emission is finite and not negative");
    Spectrum spectrum = panel_emission_spectrum(panel, wo, rgb, w);
    fuzz_claim(all_in((const float *)&spectrum, SPECTRUM_LANES, -1e30f), "so is its spectrum");
    fuzz_claim(panel_mean_luminance(panel, rgb) >= 0, "the mean is not negative");
    const float place[2] = {wo.x, 0.5f + wo.y};
    fuzz_claim(panel_place_emission_xyz(panel, place, wo, rgb, xyz) ==
                   panel_place_emission_is_measured(panel, place, wo),
               "a direction is measured or not");
    fuzz_claim(all_in(xyz, 3, 0), "nor is it at a place");
    spectrum = panel_place_emission_spectrum(panel, place, wo, rgb, w);
    fuzz_claim(all_in((const float *)&spectrum, SPECTRUM_LANES, -1e30f), "so is that there");
}

static void claim_reflection(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *w) {
    const float u[3] = {0.3f, 0.7f, 0.9f};
    float pdf = 1;
    Spectrum brdf = panel_brdf(panel, wo, wi, w), mirror = panel_mirror(panel, wo.z, w);
    fuzz_claim(all_in((const float *)&brdf, SPECTRUM_LANES, 0) &&
                   all_in((const float *)&mirror, SPECTRUM_LANES, 0),
               "reflection is finite and not negative");
    fuzz_claim(panel_pdf(panel, wo, wi) >= 0, "a density is not negative");
    fuzz_claim(panel_reflects(panel) || !panel_brdf_is_measured(panel, wo, wi),
               "nothing is measured of a panel that reflects nothing");
    const float place[2] = {wo.x, 0.5f + wo.y};
    PanelMix mix = panel_place_reflection(panel, place);
    brdf = panel_mix_brdf(&mix, wo, wi, w);
    fuzz_claim(all_in((const float *)&brdf, SPECTRUM_LANES, 0) && panel_mix_pdf(&mix, wo, wi) >= 0,
               "nor is it at a place");
    if (!panel_sample(panel, wo, u, &wi, &pdf)) return;
    fuzz_claim(pdf > 0 && isfinite(pdf), "a chosen direction has a density");
    fuzz_claim(fabsf(vec3_dot(wi, wi) - 1) < 1e-3f, "and unit length");
}

/* ---- local dimming ----------------------------------------------------------------------- */

#define FEW_ZONES 256 /* a map of more takes a while */

static void checkered(const void *user, const float place[2], float codes[3]) {
    bool is_lit = (int)(4 * place[0]) % 2 == (int)(4 * place[1]) % 2;
    (void)user;
    for (int p = 0; p < 3; p++) codes[p] = is_lit ? 200 : 0;
}

static void claim_zones(const Panel *panel, Arena *arena) {
    const DimmingZones *zones = panel_zones(panel);
    const char *key;
    LevelShares levels;
    ShownPicture picture = {64, 64, checkered, NULL};
    if (!zones) return;
    fuzz_claim(!dimming_zones_fault(zones, &key), "zones that were taken are some");
    int count = zones->count[0] * zones->count[1];
    if (count > FEW_ZONES) return;
    double *drive = ARENA_NEW(arena, double, count);
    panel_level_shares(panel, &levels);
    double mean = backlight_drives(zones, &levels, &picture, drive);
    fuzz_claim(mean >= 0 && mean <= 1, "the mean drive is a share");
    for (int i = 0; i < count; i++)
        fuzz_claim(drive[i] >= zones->least && drive[i] <= 1, "no drive is below the least");
    const Backlight *light = backlight_make(zones, &levels, drive, arena);
    for (int i = 0; i < 25; i++) {
        const float place[2] = {0.25f * (float)(i % 5), 0.25f * (float)(i / 5)};
        const float shown[3] = {255, 90.5f, 0};
        float codes[3], b = backlight_at(light, place);
        fuzz_claim(b > 0 && b <= 1.0001f, "the backlight is a share of full");
        backlight_codes(light, b, shown, codes);
        fuzz_claim(all_in(codes, 3, 0) && codes[0] <= 255 && codes[2] == 0,
                   "pixels get codes, black ones none");
    }
}

void fuzz_panel(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Panel *panel;
    double number[PANEL_INFO_AZIMUTHS_MAX];
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    if (!panel_from_bytes(data, size, "x.panel", arena, &panel, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    Wavelengths w;
    wavelengths_sample(0.4f, &w);
    for (int i = 0; i < 4; i++) {
        Vec3 wo = direction(0.5f * (float)i, 1.7f * (float)i);
        claim_emission(panel, wo, &w);
        claim_reflection(panel, wo, direction(1.4f - 0.4f * (float)i, (float)i), &w);
        if (i < 3) panel_info_levels(panel, i, number);
    }
    PanelPolarisation polarised = panel_polarisation(panel);
    fuzz_claim(polarised.degree >= 0 && polarised.degree <= 1 && polarised.azimuth >= 0 &&
                   polarised.azimuth < PI_F,
               "the polarisation is one");
    panel_info_wavelengths(panel, nm);
    panel_info_incidences(panel, number);
    panel_info_azimuths(panel, number);
    claim_zones(panel, arena);
    if (!panel_open_memory(data, size, "x.panel", arena, &panel, &err))
        fuzz_claim_refusal(&err); /* without its sampling */
}

/* ---- mutation ---------------------------------------------------------------------------- */

/* As if somebody had written the file with ill intent: size and checksum fit, but for one in
 * sixteen. */
size_t fuzz_mutate_panel(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    uint64_t state = seed;
    if (fuzz_random(&state) % 8 || size < sizeof(PanelHeader))
        fuzz_mutate_places(data, size, fuzz_random(&state));
    else size = fuzz_mutate_bytes(data, size, max_size);
    if (size < sizeof(PanelHeader) || fuzz_random(&state) % 16 == 0) return size;
    uint64_t whole = size;
    memcpy(data, PANEL_MAGIC, 8);
    memcpy(data + offsetof(PanelHeader, size), &whole, sizeof whole);
    size_t from = offsetof(PanelHeader, size);
    uint64_t checksum = XXH3_64bits(data + from, size - from);
    memcpy(data + offsetof(PanelHeader, checksum), &checksum, sizeof checksum);
    return size;
}
