/* HOT: what a panel emits. No allocation, no lock, no libm. */
#include <string.h>

#include "hemisphere/tree_query.h"
#include "panel/panel_query.h"

/* ln of `blocks` times four neighbouring channels in cd m^-2, without the cosine's power. */
static inline void channel_logs(const Panel *panel, int first, int blocks,
                                const float *components, float *out)
{
    PanelFloat4  sum[PANEL_CHANNELS_AT_ONCE / 4];
    const float *row = panel->channel_rows + first;
    for (int b = 0; b < blocks; b++) sum[b] = *(const PanelFloat4 *)(row + 4 * b);
    for (int k = 0; k < (int)panel->emission->components; k++) {
        row += panel->channel_stride;
        for (int b = 0; b < blocks; b++)
            sum[b] += components[k] * *(const PanelFloat4 *)(row + 4 * b);
    }
    memcpy(out, sum, sizeof *sum * (size_t)blocks);
}

LevelPosition panel_level_position(const Panel *panel, int primary, float code)
{
    const PanelEmission *e = panel->emission;
    const float *level = e->level[primary], *x = panel->log_level[primary];
    int last = (int)e->level_count[primary] - 1, i = 0;
    if (!(code > 0)) return (LevelPosition){.kind = LEVEL_DARK};
    while (i < last && level[i + 1] <= code) i++;
    LevelPosition at = {LEVEL_EXACT, i, log_f(code), {0, 0, 0, 0}};
    if (code == level[i]) return at;
    at.kind = last == 0 ? LEVEL_POWER : code < level[0] ? LEVEL_BELOW
            : i == last ? LEVEL_ABOVE : LEVEL_BETWEEN;
    for (int k = 0; k < 4; k++) {
        int j = i - 1 + k;
        at.node[k] = x[j < 0 ? 0 : j > last ? last : j];
    }
    return at;
}

/* Slope at a node between two intervals of widths h and steepness d: the harmonic mean of
 * Fritsch and Butland (1984), 0 at an extremum, so that the interpolant is monotone. */
static float monotone_slope(float h0, float h1, float d0, float d1)
{
    if (!(d0 * d1 > 0)) return 0;
    float w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    return (w0 + w1) * d0 * d1 / (w0 * d1 + w1 * d0);
}

float panel_level_interpolate(const Panel *panel, const LevelPosition *at, const float y[4])
{
    const float *x = at->node;
    switch (at->kind) {
    case LEVEL_DARK: return -INFINITY;
    case LEVEL_EXACT: return y[1];
    case LEVEL_POWER: return y[1] + panel->emission->level_power * (at->x - x[1]);
    case LEVEL_BELOW: {
        float slope = (y[2] - y[1]) / (x[2] - x[1]);
        return y[1] + (slope > 0.1f ? slope : 0.1f) * (at->x - x[1]);
    }
    case LEVEL_ABOVE: {
        float slope = (y[1] - y[0]) / (x[1] - x[0]);
        return y[1] + (slope > 0 ? slope : 0) * (at->x - x[1]);
    }
    case LEVEL_BETWEEN: break;
    }
    float h = x[2] - x[1], d = (y[2] - y[1]) / h, m1 = d, m2 = d;
    if (x[0] < x[1]) m1 = monotone_slope(x[1] - x[0], h, (y[1] - y[0]) / (x[1] - x[0]), d);
    if (x[3] > x[2]) m2 = monotone_slope(h, x[3] - x[2], d, (y[3] - y[2]) / (x[3] - x[2]));
    float t = (at->x - x[1]) / h, t2 = t * t, t3 = t2 * t;
    return y[1] * (2 * t3 - 3 * t2 + 1) + y[2] * (3 * t2 - 2 * t3) +
           h * (m1 * (t3 - 2 * t2 + t) + m2 * (t3 - t2));
}

/* ln of the three tristimulus values that a primary adds at this level; fall is the part that
 * all channels share. */
static void primary_logs(const Panel *panel, int primary, const LevelPosition *at,
                         const float *components, float fall, float logs[3])
{
    int   first = (int)panel_first_channel(panel->emission, primary);
    int   levels = (int)panel->emission->level_count[primary];
    float values[PANEL_CHANNELS_AT_ONCE];
    if (at->kind == LEVEL_EXACT) {
        channel_logs(panel, first + 3 * at->first, 1, components, values);
        for (int j = 0; j < 3; j++) logs[j] = fall + values[j];
        return;
    }
    int window = at->first - 1 > levels - 4 ? levels - 4 : at->first - 1; /* four levels */
    if (window < 0) window = 0;
    channel_logs(panel, first + 3 * window, PANEL_CHANNELS_AT_ONCE / 4, components, values);
    for (int j = 0; j < 3; j++) {
        float y[4];
        for (int k = 0; k < 4; k++) {
            int i = at->first - 1 + k;
            i = i < 0 ? 0 : i > levels - 1 ? levels - 1 : i;
            y[k] = values[3 * (i - window) + j];
        }
        logs[j] = fall + panel_level_interpolate(panel, at, y);
    }
}

static bool is_measured(const Panel *panel, Vec3 direction)
{
    return direction.z >= panel->emission->cone_cos - 1e-6f;
}

/* ln XYZ of the four sources of light: three primaries (-infinity: dark) and black. */
static void source_logs(const Panel *panel, Vec3 direction, const float rgb[3],
                        float logs[4][3], bool lit[4])
{
    float components[PANEL_COMPONENTS_MAX];
    int   count = (int)panel->emission->components;
    tree_interpolate(&panel->emission_tree, direction, components);
    panel_add_profile(&panel->emission_profile, direction, 0, count, components);
    float fall = panel->emission->cosine_power * log_f(clampf(direction.z, 1e-4f, 1));
    for (int p = 0; p < 3; p++) {
        LevelPosition at = panel_level_position(panel, p, rgb[p]);
        lit[p] = at.kind != LEVEL_DARK;
        if (lit[p]) primary_logs(panel, p, &at, components, fall, logs[p]);
    }
    lit[3] = panel->emission->has_black;
    if (!lit[3]) return;
    float black[4];
    channel_logs(panel, (int)panel_first_channel(panel->emission, 3), 1, components, black);
    for (int j = 0; j < 3; j++) logs[3][j] = fall + black[j];
}

bool panel_emission_xyz(const Panel *panel, Vec3 direction, const float rgb[3], float xyz[3])
{
    float logs[4][3];
    bool  lit[4];
    xyz[0] = xyz[1] = xyz[2] = 0;
    if (!(direction.z > 0)) return false;
    source_logs(panel, direction, rgb, logs, lit);
    for (int s = 0; s < 4; s++)
        for (int j = 0; j < 3 && lit[s]; j++) xyz[j] += exp_f(logs[s][j]);
    return is_measured(panel, direction);
}

/* ---- spectra --------------------------------------------------------------------------- */

/* Weights of a Catmull-Rom cubic over four neighbours of an even row. */
static int cubic_cell(float at, float low, float high, float weight[4])
{
    float s = (at - low) / (high - low) * (PANEL_BEND_SIDE - 1);
    s = clampf(s, 0, PANEL_BEND_SIDE - 1);
    int   cell = (int)s;
    if (cell > PANEL_BEND_SIDE - 2) cell = PANEL_BEND_SIDE - 2;
    float t = s - (float)cell, t2 = t * t, t3 = t2 * t;
    weight[0] = 0.5f * (2 * t2 - t3 - t);
    weight[1] = 0.5f * (3 * t3 - 5 * t2 + 2);
    weight[2] = 0.5f * (4 * t2 - 3 * t3 + t);
    weight[3] = 0.5f * (t3 - t2);
    if (cell == 0) { /* one neighbour is missing: the straight line goes on */
        weight[1] += 2 * weight[0];
        weight[2] -= weight[0];
        weight[0] = 0;
    }
    if (cell == PANEL_BEND_SIDE - 2) {
        weight[2] += 2 * weight[3];
        weight[1] -= weight[3];
        weight[3] = 0;
    }
    return cell - 1;
}

void panel_bend_lookup(const PanelBend *bend, const float logs[3], float coefficient[3])
{
    float wu[4], wv[4];
    float du = logs[0] - logs[1] - bend->origin[0], dv = logs[2] - logs[1] - bend->origin[1];
    float along = du * bend->along[0] + dv * bend->along[1];
    float across = dv * bend->along[0] - du * bend->along[1];
    int   u = cubic_cell(along, bend->low[0], bend->high[0], wu);
    int   v = cubic_cell(across, bend->low[1], bend->high[1], wv);
    coefficient[0] = coefficient[1] = coefficient[2] = 0;
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            float w = wu[i] * wv[j];
            if (w == 0) continue;
            const float *from = bend->coefficient[(v + j) * PANEL_BEND_SIDE + u + i];
            for (int k = 0; k < 3; k++) coefficient[k] += w * from[k];
        }
}

/* The spectrum of a source at the lanes' wavelengths, linear between whole nm. */
static Spectrum spectrum_of(const float *spectrum, const Wavelengths *wavelengths)
{
    Spectrum out;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float at = clampf(wavelengths->nm[i] - SPECTRAL_FIRST_NM, 0, SPECTRAL_COUNT - 1.001f);
        int   n = (int)at;
        out[i] = lerpf(spectrum[n], spectrum[n + 1], at - (float)n);
    }
    return out;
}

#define EXPONENT_MOST 60.0f

/* S = T exp(c0 + c1 t + c2 t^2) Y, t = (lambda - 560 nm) / 180 nm; strictly positive where T
 * is (design: panel, section 7). */
Spectrum panel_emission_spectrum(const Panel *panel, Vec3 direction, const float rgb[3],
                                 const Wavelengths *wavelengths)
{
    float    logs[4][3];
    bool     lit[4];
    Spectrum sum = spectrum_all(0);
    if (!(direction.z > 0)) return sum;
    source_logs(panel, direction, rgb, logs, lit);
    Spectrum t = (wavelengths->nm - spectrum_all(560)) * spectrum_all(1.0f / 180);
    for (int s = 0; s < 4; s++) {
        float c[3];
        if (!lit[s]) continue;
        panel_bend_lookup(&panel->primaries->bend[s], logs[s], c);
        Spectrum exponent = (spectrum_all(c[2]) * t + spectrum_all(c[1])) * t +
                            spectrum_all(c[0] + logs[s][1]);
        /* Far from a narrow primary the curve may run away where the primary is dark: infinity
         * times nothing would be no number. */
        exponent = spectrum_min(exponent, spectrum_all(EXPONENT_MOST));
        /* far from the primary's light, where T is 0, the exponent may be anything */
        sum += spectrum_of(panel->primaries->spectrum[s], wavelengths) *
               spectrum_exp(spectrum_min(exponent, spectrum_all(80)));
    }
    return sum;
}

/* ---- mean ------------------------------------------------------------------------------ */

float panel_mean_luminance(const Panel *panel, const float rgb[3])
{
    const PanelEmission *e = panel->emission;
    float sum = e->has_black ? panel->mean_y[panel_first_channel(e, 3) / 3] : 0;
    for (int p = 0; p < 3; p++) {
        LevelPosition at = panel_level_position(panel, p, rgb[p]);
        float y[4];
        if (at.kind == LEVEL_DARK) continue;
        for (int k = 0; k < 4; k++) {
            int i = at.first - 1 + k, last = (int)e->level_count[p] - 1;
            i = i < 0 ? 0 : i > last ? last : i;
            y[k] = log_f(panel->mean_y[panel_first_channel(e, p) / 3 + (uint32_t)i]);
        }
        sum += exp_f(panel_level_interpolate(panel, &at, y));
    }
    return sum;
}
