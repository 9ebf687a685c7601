/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: what a panel emits. No allocation, no lock, no libm. */
#include "panel/query/panel_emission.h"

#include "panel/query/panel_components.h"

bool panel_emission_xyz(const Panel *panel, Vec3 direction, const float rgb[3], float xyz[3]) {
    PanelFloat4 logs[4];
    xyz[0] = xyz[1] = xyz[2] = 0;
    if (!panel->emission || !(direction.z > 0)) return false;
    panel_source_logs(panel, direction, rgb, logs);
    panel_sources_xyz(logs, xyz);
    return panel_sources_are_measured(panel, direction);
}

Spectrum panel_emission_spectrum(const Panel *panel, Vec3 direction, const float rgb[3],
                                 const Wavelengths *wavelengths) {
    PanelFloat4 source[4];
    if (!panel->emission || !(direction.z > 0)) return spectrum_all(0);
    panel_source_logs(panel, direction, rgb, source);
    return panel_sources_spectrum(panel, source, wavelengths);
}

PanelPolarisation panel_polarisation(const Panel *panel) {
    return panel->polarisation;
}

/* ---- mean ------------------------------------------------------------------------------ */

/* At any code, by the same curve between whole codes. */
static float mean_of_code(const PanelEmission *e, const float *mean, float code) {
    int whole = code < 255 ? (int)code : 255;
    if (!(code > 0)) return 0;
    if (whole == 0) { /* the power law of the two lowest codes */
        float slope = log_f(mean[2] / mean[1]) / e->log_code[2];
        return mean[1] * exp_f((slope > 0 ? slope : 0) * log_f(code));
    }
    if ((float)whole >= code) return mean[whole];
    float span = e->log_code[whole + 1] - e->log_code[whole];
    float t = (log_f(code) - e->log_code[whole]) / span;
    return mean[whole] * exp_f(t * log_f(mean[whole + 1] / mean[whole]));
}

float panel_mean_luminance(const Panel *panel, const float rgb[3]) {
    const PanelEmission *e = panel->emission;
    if (!e) return 0;
    float sum = e->black_mean_y;
    for (int p = 0; p < 3; p++) sum += mean_of_code(e, e->mean_y[p], rgb[p]);
    return sum;
}
