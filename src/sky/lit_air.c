/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/lit_air.h"

#include "spectrum/photometry.h"

static void index_nodes(LitAir *out) {
    int k = 0;
    for (int i = 0; i < CURVE_COUNT; i++) {
        while (k + 2 < SPECTRUM_LANES && AIR_NM[k + 1] <= (float)(CURVE_FIRST_NM + i)) k++;
        out->node[i] = (uint8_t)k;
    }
}

static float node_share(int node, float nm) {
    return (nm - AIR_NM[node]) / (AIR_NM[node + 1] - AIR_NM[node]);
}

/* A relative quantity at 16 wavelengths times the beam outside, every nm. */
void lit_air_curve(const LitAir *air, Spectrum relative, Curve *out) {
    for (int i = 0; i < CURVE_COUNT; i++) {
        int k = air->node[i];
        float t = node_share(k, (float)(CURVE_FIRST_NM + i));
        out->value[i] = lerpf(relative[k], relative[k + 1], t) * air->beam.value[i];
    }
}

double lit_air_luminance(const LitAir *air, Spectrum relative) {
    double sum = 0;
    for (int i = 0; i < SPECTRUM_LANES; i++)
        sum += (double)relative[i] * (double)air->luminance_weight[i];
    return sum;
}

static void weigh_luminance(LitAir *out) {
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        Spectrum unit = spectrum_all(0);
        Curve curve;
        unit[k] = 1;
        lit_air_curve(out, unit, &curve);
        out->luminance_weight[k] =
            (float)luminance_cd_m2(curve.value, CURVE_COUNT, CURVE_FIRST_NM, 1);
    }
}

bool lit_air_build(const AtmosphereInput *input, const Curve *beam, Arena *arena, LitAir *out,
                   Error *err) {
    if (!atmosphere_build(input, arena, &out->atmosphere, err)) return false;
    out->beam = *beam;
    index_nodes(out);
    weigh_luminance(out);
    return true;
}

/* From the lanes of air.h to those of a path. */
static Spectrum between_nodes(const LitAir *air, Spectrum at, const Wavelengths *wavelengths) {
    Spectrum value;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float nm = wavelengths->nm[i];
        int k = air->node[(int)clampf(nm - CURVE_FIRST_NM, 0, CURVE_COUNT - 1)];
        value[i] = lerpf(at[k], at[k + 1], node_share(k, nm));
    }
    return value;
}

/* A relief only where there is one: adding 0 would turn a -0 into 0. */
static Spectrum seen_radiance(const Atmosphere *air, float elevation, float azimuth) {
    Spectrum at = atmosphere_radiance(air, elevation, azimuth);
    return air->relief ? at + atmosphere_relief(air, elevation, azimuth) : at;
}

Spectrum lit_air_radiance(const LitAir *air, float elevation, float azimuth,
                          const Wavelengths *wavelengths) {
    Spectrum at = seen_radiance(&air->atmosphere, elevation, azimuth);
    return between_nodes(air, at, wavelengths) * curve_lookup(&air->beam, wavelengths);
}

Spectrum lit_air_polarisation(const LitAir *air, float elevation, float azimuth,
                              const Wavelengths *wavelengths) {
    Spectrum all = seen_radiance(&air->atmosphere, elevation, azimuth);
    Spectrum part = atmosphere_polarised(&air->atmosphere, elevation, azimuth);
    return spectrum_clamp(
        between_nodes(air, part, wavelengths) /
            spectrum_max(between_nodes(air, all, wavelengths), spectrum_all(1e-30f)),
        0, 1);
}
