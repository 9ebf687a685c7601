/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: a panel at a place. No allocation, no lock, no libm. */
#include "panel/query/panel_place.h"

#include "panel/query/panel_components.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_sampling.h"

bool panel_varies(const Panel *panel) {
    return panel->places != NULL;
}

/* ---- which panels ------------------------------------------------------------------------ */

/* Panels by number, the same one once. */
typedef struct PlaceMix {
    int count;
    int panel[SPOT_GROUND_COUNT];
    float weight[SPOT_GROUND_COUNT];
} PlaceMix;

static PlaceMix mix_of(const PanelPlaces *places, const uint16_t *of_spot, const float place[2]) {
    PlaceMix out = {.count = 1, .weight = {1}};
    if (!places->spots) return out;
    SpotWeights at = spot_ground_weights(&places->ground, place);
    out.count = 0;
    for (int i = 0; i < at.count; i++) {
        int panel = of_spot[at.spot[i]], k = 0;
        while (k < out.count && out.panel[k] != panel) k++;
        if (k == out.count) {
            out.panel[k] = panel;
            out.weight[k] = 0;
            out.count++;
        }
        out.weight[k] += at.weight[i];
    }
    return out;
}

PanelMix panel_place_reflection(const Panel *panel, const float place[2]) {
    PanelMix out = {.count = 1, .panel = {panel}, .weight = {1}};
    if (!panel->places) return out;
    PlaceMix mix = mix_of(panel->places, panel->places->reflection, place);
    out.count = mix.count;
    for (int i = 0; i < mix.count; i++) {
        out.panel[i] = panel->places->panel[mix.panel[i]];
        out.weight[i] = mix.weight[i];
    }
    return out;
}

/* ---- the map ----------------------------------------------------------------------------- */

void panel_map_at(const PanelMap *map, const float place[2], float white[3], float black[3]) {
    int right, below;
    float s, t;
    int x = sample_place(place[0], map->width, &right, &s);
    int y = sample_place(place[1], map->height, &below, &t);
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 3; j++) {
            const uint16_t *top = map->value[k][j] + (size_t)y * (size_t)map->width;
            const uint16_t *low = map->value[k][j] + (size_t)below * (size_t)map->width;
            float a = lerpf((float)top[x], (float)top[right], s);
            float b = lerpf((float)low[x], (float)low[right], s);
            (k ? black : white)[j] = map->scale[k][j] * lerpf(a, b, t);
        }
}

#define LEAST_FACTOR 1e-9f /* of a pixel that is dead */

/* ln of what the map makes of a panel's sources: the primaries', then black's. With w and b
 * relative white and black, and c the panel's black over its white, white is w and black b
 * when the primaries are multiplied by (w - b c) / (1 - c). */
static void map_logs(const PanelPlaces *places, int panel, const float place[2],
                     PanelFloat4 logs[2]) {
    float white[3], black[3];
    panel_map_at(places->map, place, white, black);
    logs[0] = logs[1] = (PanelFloat4){0};
    for (int j = 0; j < 3; j++) {
        float w = white[j] / places->white[panel][j], b = black[j] / places->black[panel][j];
        float c = places->dark[panel][j], added = (w - b * c) / (1 - c);
        logs[0][j] = log_f(added > LEAST_FACTOR ? added : LEAST_FACTOR);
        logs[1][j] = log_f(b > LEAST_FACTOR ? b : LEAST_FACTOR);
    }
}

/* ---- emission ---------------------------------------------------------------------------- */

/* The sources of a panel as the map has them at a place. */
static void place_logs(const PanelPlaces *places, int panel, const float place[2],
                       PanelFloat4 logs[4]) {
    PanelFloat4 by_map[2];
    if (!places->map) return;
    map_logs(places, panel, place, by_map);
    for (int s = 0; s < 4; s++)
        if (logs[s][1] > PANEL_DARK) logs[s] += by_map[s == 3];
}

static bool mix_is_measured(const PanelPlaces *places, const PlaceMix *mix, Vec3 direction) {
    for (int i = 0; i < mix->count; i++)
        if (!panel_sources_are_measured(places->panel[mix->panel[i]], direction)) return false;
    return true;
}

bool panel_place_emission_is_measured(const Panel *panel, const float place[2], Vec3 direction) {
    const PanelPlaces *places = panel->places;
    if (!panel->emission || !(direction.z > 0)) return false;
    if (!places) return panel_sources_are_measured(panel, direction);
    PlaceMix mix = mix_of(places, places->emission, place);
    return mix_is_measured(places, &mix, direction);
}

bool panel_place_emission_xyz(const Panel *panel, const float place[2], Vec3 direction,
                              const float rgb[3], float xyz[3]) {
    const PanelPlaces *places = panel->places;
    if (!places) return panel_emission_xyz(panel, direction, rgb, xyz);
    xyz[0] = xyz[1] = xyz[2] = 0;
    if (!panel->emission || !(direction.z > 0)) return false;
    PlaceMix mix = mix_of(places, places->emission, place);
    for (int i = 0; i < mix.count; i++) {
        const Panel *one = places->panel[mix.panel[i]];
        PanelFloat4 logs[4];
        float add[3];
        panel_source_logs(one, direction, rgb, logs);
        place_logs(places, mix.panel[i], place, logs);
        panel_sources_xyz(logs, add);
        for (int j = 0; j < 3; j++) xyz[j] += mix.weight[i] * add[j];
    }
    return mix_is_measured(places, &mix, direction);
}

Spectrum panel_place_emission_spectrum(const Panel *panel, const float place[2], Vec3 direction,
                                       const float rgb[3], const Wavelengths *wavelengths) {
    const PanelPlaces *places = panel->places;
    Spectrum sum = spectrum_all(0);
    if (!places) return panel_emission_spectrum(panel, direction, rgb, wavelengths);
    if (!panel->emission || !(direction.z > 0)) return sum;
    PlaceMix mix = mix_of(places, places->emission, place);
    for (int i = 0; i < mix.count; i++) {
        const Panel *one = places->panel[mix.panel[i]];
        PanelFloat4 logs[4];
        panel_source_logs(one, direction, rgb, logs);
        place_logs(places, mix.panel[i], place, logs);
        sum += panel_sources_spectrum(one, logs, wavelengths) * spectrum_all(mix.weight[i]);
    }
    return sum;
}

/* ---- reflection -------------------------------------------------------------------------- */

Spectrum panel_mix_brdf(const PanelMix *mix, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths) {
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < mix->count; i++)
        sum += panel_brdf(mix->panel[i], wo, wi, wavelengths) * spectrum_all(mix->weight[i]);
    return sum;
}

Spectrum panel_mix_lambertian(const PanelMix *mix, Spectrum brdf, Vec3 wi,
                              const Wavelengths *wavelengths) {
    Spectrum sum = spectrum_all(0);
    PanelLanes lanes;
    for (int i = 0; i < mix->count; i++) {
        panel_lanes(mix->panel[i], wavelengths, &lanes);
        sum += panel_lambertian_at(mix->panel[i], brdf, wi, &lanes) * spectrum_all(mix->weight[i]);
    }
    return sum;
}

Spectrum panel_mix_mirror(const PanelMix *mix, float cos_theta, const Wavelengths *wavelengths) {
    Spectrum sum = spectrum_all(0);
    for (int i = 0; i < mix->count; i++)
        sum += panel_mirror(mix->panel[i], cos_theta, wavelengths) * spectrum_all(mix->weight[i]);
    return sum;
}

float panel_mix_haze_albedo(const PanelMix *mix, float cos_theta) {
    float sum = 0;
    for (int i = 0; i < mix->count; i++)
        sum += mix->weight[i] * panel_haze_albedo(mix->panel[i], cos_theta);
    return sum;
}

float panel_mix_pdf(const PanelMix *mix, Vec3 wo, Vec3 wi) {
    float sum = 0;
    for (int i = 0; i < mix->count; i++) sum += mix->weight[i] * panel_pdf(mix->panel[i], wo, wi);
    return sum;
}

bool panel_mix_sample(const PanelMix *mix, Vec3 wo, const float u[3], Vec3 *wi, float *pdf) {
    float rest = u[0];
    int i = 0;
    for (; i + 1 < mix->count && rest >= mix->weight[i]; i++) rest -= mix->weight[i];
    float one[3] = {clampf(rest / mix->weight[i], 0, 0x1.fffffep-1f), u[1], u[2]};
    if (!panel_sample(mix->panel[i], wo, one, wi, pdf)) return false;
    *pdf = panel_mix_pdf(mix, wo, *wi);
    return *pdf > 0;
}

bool panel_has_mirror(const Panel *panel) {
    Wavelengths wavelengths;
    int panels = panel->places ? panel->places->panels : 1;
    wavelengths_sample(0.5f, &wavelengths);
    for (int k = 0; k < panels; k++) {
        const Panel *one = panel->places ? panel->places->panel[k] : panel;
        if (panel_reflects(one) && !spectrum_is_zero(panel_mirror(one, 1, &wavelengths)))
            return true;
    }
    return false;
}
