/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_open_emission.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/query/panel_components.h"
#include "panel/query/panel_emission.h"
#include "panel/shape/panel_levels.h"

_Static_assert(sizeof(PanelEmissionHead) == 20, "the file's layout");
_Static_assert(sizeof(PanelPrimariesHead) == 24, "the file's layout");

/* ---- the section ------------------------------------------------------------------------ */

/* The unread rest of a section. */
typedef struct Rest {
    const unsigned char *at;
    size_t size;
} Rest;

static bool take(Rest *rest, void *to, size_t bytes) {
    if (rest->size < bytes) return false;
    if (bytes) memcpy(to, rest->at, bytes);
    rest->at += bytes;
    rest->size -= bytes;
    return true;
}

static bool take_levels(Rest *rest, PanelEmission *e) {
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < e->level_count[p]; i++) {
            uint16_t stored;
            if (!take(rest, &stored, sizeof stored)) return false;
            e->level[p][i] = (float)stored / PANEL_LEVEL_UNIT;
        }
    return true;
}

static bool take_means(Rest *rest, PanelEmission *e, Arena *arena) {
    float *mean = ARENA_NEW(arena, float, e->channels);
    for (int c = 0; c < e->channels; c++) {
        int16_t stored;
        if (!take(rest, &stored, sizeof stored)) return false;
        mean[c] = ldexpf((float)stored, -PANEL_MEAN_BITS);
    }
    e->mean = mean;
    return true;
}

static bool take_loadings(Rest *rest, PanelEmission *e, Arena *arena) {
    uint8_t exponent[PANEL_COMPONENTS_MAX], width[PANEL_COMPONENTS_MAX];
    float *loading = ARENA_NEW(arena, float, e->channels * e->components);
    if (!take(rest, exponent, (size_t)e->components) || !take(rest, width, (size_t)e->components))
        return false;
    for (int pass = 2; pass >= 1; pass--)
        for (int k = 0; k < e->components; k++) {
            if (width[k] < 1 || width[k] > 2 || exponent[k] > 30) return false;
            for (int c = 0; c < e->channels && width[k] == pass; c++) {
                int16_t wide = 0;
                int8_t narrow = 0;
                if (pass == 2 ? !take(rest, &wide, 2) : !take(rest, &narrow, 1)) return false;
                loading[c * e->components + k] = ldexpf((float)(wide + narrow), -(int)exponent[k]);
            }
        }
    e->loading = loading;
    return true;
}

static bool read_head(const PanelBytes *at, Rest *rest, PanelEmission *e) {
    PanelEmissionHead head;
    if (!take(rest, &head, sizeof head)) return panel_refuse(at, "emission", "is too short");
    *e = (PanelEmission){.components = head.components,
                         .has_black = head.has_black != 0,
                         .stride = (head.components + 3) / 4 * 4,
                         .cone_cos = head.cone_cos,
                         .level_power = head.level_power,
                         .cosine_power = head.cosine_power,
                         .channels = head.has_black ? 3 : 0};
    for (int p = 0; p < 3; p++) {
        e->level_count[p] = head.level_count[p];
        e->channels += 3 * e->level_count[p];
        if (e->level_count[p] < 1 || e->level_count[p] > PANEL_LEVELS_MAX)
            return panel_refuse(at, "emission", "level count out of range");
    }
    if (head.has_black > 1 || e->components < 1 || e->components > PANEL_COMPONENTS_MAX)
        return panel_refuse(at, "emission", "component count out of range");
    if (!(e->cone_cos >= 0 && e->cone_cos <= 1) || !(e->level_power > 0 && e->level_power < 10) ||
        !(e->cosine_power >= 0 && e->cosine_power < 10))
        return panel_refuse(at, "emission", "cone or level power out of range");
    return true;
}

static bool check_levels(const PanelBytes *at, const PanelEmission *e) {
    for (int p = 0; p < 3; p++)
        if (!(e->level[p][0] > 0) || !(e->level[p][e->level_count[p] - 1] <= 255) ||
            !panel_rising(e->level[p], (uint32_t)e->level_count[p]))
            return panel_refuse(at, "emission", "levels do not rise from above 0 to 255");
    return true;
}

static bool take_spline(Rest *rest, PanelEmission *e, Arena *arena) {
    size_t used = 0;
    if (!panel_spline_open(rest->at, rest->size, e->components, arena, &e->spline, &used))
        return false;
    rest->at += used, rest->size -= used;
    return true;
}

static bool read_section(const PanelBytes *at, Arena *arena, PanelEmission *e) {
    Rest rest = {at->data, at->size};
    if (!read_head(at, &rest, e)) return false;
    if (!take_levels(&rest, e) || !take_means(&rest, e, arena) || !take_loadings(&rest, e, arena) ||
        !take_spline(&rest, e, arena) || rest.size != 0)
        return panel_refuse(at, "emission", "has another size than its counts say");
    return check_levels(at, e);
}

/* ---- tables of codes -------------------------------------------------------------------- */

/* One row of PanelEmission.code_rows: weights of a primary's levels, channel by channel. */
static void code_row(const PanelEmission *e, int primary, const float *log_level, float log_code,
                     float *row) {
    int first = (int)panel_first_channel(e, primary), count = e->level_count[primary];
    for (int j = 0; j < 3; j++) {
        float curve[PANEL_LEVELS_MAX];
        for (int i = 0; i < count; i++) curve[i] = e->mean[first + 3 * i + j];
        PanelLevelWeights w =
            panel_level_weights(log_level, curve, count, e->level_power, log_code);
        row[j] += w.offset;
        for (int i = 0; i < 4 && w.first + i < count; i++) {
            int channel = first + 3 * (w.first + i) + j;
            row[j] += w.weight[i] * e->mean[channel];
            for (int k = 0; k < e->components; k++)
                row[4 * (k + 1) + j] += w.weight[i] * e->loading[channel * e->components + k];
        }
    }
}

/* Codes 1 .. 255; row 0: the change from code 1 to e. */
static const float *code_rows(const PanelEmission *e, int primary, Arena *arena) {
    size_t size = 4 * (size_t)(e->components + 1);
    float *rows = ARENA_NEW(arena, float, 256 * size), log_level[PANEL_LEVELS_MAX];
    for (int i = 0; i < e->level_count[primary]; i++) log_level[i] = log_f(e->level[primary][i]);
    for (int code = 1; code < 256; code++)
        code_row(e, primary, log_level, e->log_code[code], rows + size * (size_t)code);
    float *below = ARENA_NEW(arena, float, size);
    code_row(e, primary, log_level, -1, below);
    for (size_t i = 0; i < size; i++) rows[i] = rows[size + i] - below[i];
    return rows;
}

static void expand_codes(PanelEmission *e, Arena *arena) {
    for (int code = 1; code < 256; code++) e->log_code[code] = log_f((float)code);
    for (int p = 0; p < 3; p++) e->code_rows[p] = code_rows(e, p, arena);
    if (!e->has_black) return;
    float *row = ARENA_NEW(arena, float, 4 * (size_t)(e->components + 1));
    int first = (int)panel_first_channel(e, 3);
    for (int j = 0; j < 3; j++) {
        row[j] = e->mean[first + j];
        for (int k = 0; k < e->components; k++)
            row[4 * (k + 1) + j] = e->loading[(first + j) * e->components + k];
    }
    e->black_rows = row;
}

/* ---- what the panel emits as a whole ---------------------------------------------------- */

#define MEAN_LEVEL 5 /* of the triangles that a mean is taken over */

/* ln E of the channels at a direction. */
static void channel_logs(const Panel *panel, Vec3 direction, float *logs) {
    const PanelEmission *e = panel->emission;
    float components[PANEL_COMPONENTS_MAX];
    float fall = panel_components(panel, direction, components);
    for (int c = 0; c < e->channels; c++) {
        logs[c] = fall + e->mean[c];
        for (int k = 0; k < e->components; k++)
            logs[c] += components[k] * e->loading[c * e->components + k];
    }
}

/* Colours of the levels over the cone, where the light is above a fiftieth of its maximum. */
typedef struct Clouds {
    float *ratio[4][2];
    int count[4];
} Clouds;

static void add_colours(const PanelEmission *e, const float *logs, Clouds *clouds) {
    for (int p = 0; p < 4; p++) {
        int first = (int)panel_first_channel(e, p);
        int count = p < 3 ? e->level_count[p] : e->has_black ? 1 : 0;
        for (int i = 0; i < count; i++) {
            const float *at = logs + first + 3 * i;
            if (at[1] < e->mean[first + 3 * i + 1] - 4) continue;
            clouds->ratio[p][0][clouds->count[p]] = at[0] - at[1];
            clouds->ratio[p][1][clouds->count[p]++] = at[2] - at[1];
        }
    }
}

static void start_clouds(const PanelEmission *e, int directions, Arena *arena, Clouds *out) {
    for (int p = 0; p < 4; p++)
        for (int k = 0; k < 2; k++)
            out->ratio[p][k] = ARENA_NEW(arena, float, directions *(p < 3 ? e->level_count[p] : 1));
}

/* The mean luminance of every code, by the same curve over codes as at a direction. */
static void spread_means(PanelEmission *e, const double *mean_y) {
    for (int p = 0; p < 3; p++) {
        float x[PANEL_LEVELS_MAX], y[PANEL_LEVELS_MAX];
        int first = (int)panel_first_channel(e, p) / 3, count = e->level_count[p];
        for (int i = 0; i < count; i++) {
            x[i] = log_f(e->level[p][i]);
            y[i] = log_f((float)mean_y[first + i]);
        }
        for (int code = 1; code < 256; code++) {
            PanelLevelWeights w =
                panel_level_weights(x, y, count, e->level_power, e->log_code[code]);
            float sum = w.offset;
            for (int i = 0; i < 4 && w.first + i < count; i++) sum += w.weight[i] * y[w.first + i];
            e->mean_y[p][code] = exp_f(sum);
        }
    }
    e->black_mean_y = e->has_black ? (float)mean_y[e->channels / 3 - 1] : 0;
}

/* Whether the curve over codes can be followed without leaving single precision, and nowhere
 * divides nothing by nothing. */
#define MEAN_Y_MAX 1e18f

static bool means_fit(const PanelEmission *e) {
    for (int p = 0; p < 3; p++)
        for (int code = 1; code < 256; code++)
            if (!(e->mean_y[p][code] >= 1 / MEAN_Y_MAX && e->mean_y[p][code] <= MEAN_Y_MAX))
                return false;
    return e->black_mean_y >= 0 && e->black_mean_y <= MEAN_Y_MAX;
}

/* Means over the hemisphere, and where the colours lie. */
static void survey(Panel *panel, PanelEmission *e, Arena *arena, PanelPrimaries *primaries) {
    int directions = (int)geodesic_count(MEAN_LEVEL);
    float *logs = ARENA_NEW(arena, float, e->channels);
    double *mean_y = ARENA_NEW(arena, double, e->channels / 3), weight = 0;
    Clouds clouds = {.count = {0}};
    start_clouds(e, directions, arena, &clouds);
    for (int i = 0; i < directions; i++) {
        Vec3 d = geodesic_center(MEAN_LEVEL, (uint32_t)i);
        double w = geodesic_area(MEAN_LEVEL, (uint32_t)i) * (double)d.z;
        channel_logs(panel, d, logs);
        weight += w;
        for (int c = 1; c < e->channels; c += 3) mean_y[c / 3] += w * (double)exp_f(logs[c]);
        if (d.z >= e->cone_cos) add_colours(e, logs, &clouds);
    }
    for (int t = 0; t < e->channels / 3; t++) mean_y[t] /= weight;
    spread_means(e, mean_y);
    for (int p = 0; p < 4; p++)
        primaries->warp[p].range = spectral_warp_range(clouds.ratio[p], clouds.count[p]);
}

/* ---- spectra ---------------------------------------------------------------------------- */

/* Linear between stored wavelengths, 0 outside. */
static void expand_spectrum(const PanelPrimariesHead *head, const uint16_t *value, int primary,
                            float *out) {
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        float at = ((float)(SPECTRAL_FIRST_NM + i) - head->first_nm) / head->step_nm;
        if (!(at >= 0) || at > (float)(head->count - 1)) continue;
        int n = (int)at < head->count - 1 ? (int)at : head->count - 2;
        float low = (float)value[n], high = (float)value[n + 1];
        out[i] = head->scale[primary] * lerpf(low, high, at - (float)n);
    }
}

static bool read_spectra(const PanelBytes *at, Arena *arena, PanelPrimaries *out) {
    PanelPrimariesHead head;
    Rest rest = {at->data, at->size};
    if (!take(&rest, &head, sizeof head) || head.kind > PANEL_SPECTRA_REC709 ||
        (head.kind != PANEL_SPECTRA_STORED) != (head.count == 0) || head.count == 1 ||
        head.count > PANEL_SPECTRUM_MAX || rest.size != 6 * (size_t)head.count)
        return panel_refuse(at, "primaries", "has a wrong size");
    if (!panel_all_finite(&head.first_nm, 2) || !panel_all_finite(head.scale, 3) ||
        (head.count && !(head.step_nm > 0.01f)))
        return panel_refuse(at, "primaries", "wavelengths or scales are out of range");
    for (int p = 0; p < 3; p++) {
        uint16_t *value = ARENA_NEW(arena, uint16_t, head.count);
        if (!head.count) panel_spectrum_default((PanelSpectraKind)head.kind, p, out->spectrum[p]);
        if (!take(&rest, value, 2 * (size_t)head.count)) return false;
        if (head.count) expand_spectrum(&head, value, p, out->spectrum[p]);
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            if (!(out->spectrum[p][i] >= 0))
                return panel_refuse(at, "primaries", "a spectrum is negative");
        if (!panel_spectrum_normalise(out->spectrum[p]))
            return panel_refuse(at, "primaries", "a spectrum holds no light");
    }
    return true;
}

/* Black leaks through all three, in the share that they have at full level on the axis. */
static void black_spectrum(const Panel *panel, PanelPrimaries *out) {
    for (int p = 0; p < 3; p++) {
        float rgb[3] = {0, 0, 0}, xyz[3], dark[3], zero[3] = {0, 0, 0};
        rgb[p] = 255;
        panel_emission_xyz(panel, vec3(0, 0, 1), rgb, xyz);
        panel_emission_xyz(panel, vec3(0, 0, 1), zero, dark);
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            out->spectrum[3][i] += fmaxf(xyz[1] - dark[1], 0) * out->spectrum[p][i];
    }
    if (!panel_spectrum_normalise(out->spectrum[3]))
        memcpy(out->spectrum[3], out->spectrum[1], sizeof out->spectrum[3]);
}

bool panel_open_emission(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                         Panel *panel) {
    PanelBytes at, tree, spectra;
    bool found;
    if (!panel_find_section(bytes, PANEL_EMISSION, 0, &at, &found)) return false;
    if (!found) return true;
    if (!panel_need_section(bytes, PANEL_EMISSION_TREE, 0, &tree) ||
        !panel_need_section(bytes, PANEL_PRIMARIES, 0, &spectra))
        return false;
    PanelEmission *e = ARENA_NEW(arena, PanelEmission, 1);
    PanelPrimaries *primaries = ARENA_NEW(arena, PanelPrimaries, 1);
    if (!read_section(&at, arena, e) || !read_spectra(&spectra, arena, primaries)) return false;
    if (!tree_open(tree.data, tree.size, geodesic, arena, &panel->emission_tree, tree.err))
        return error_prefix(bytes->err, "emission tree") || error_in_file(bytes->err, bytes->name);
    if (panel->emission_tree.components != e->components || panel->emission_tree.octants != 4)
        return panel_refuse(&at, "emission", "does not fit its tree");
    expand_codes(e, arena);
    panel->emission = e;
    survey(panel, e, arena, primaries);
    if (!means_fit(e)) return panel_refuse(&at, "emission", "a mean luminance is out of range");
    black_spectrum(panel, primaries);
    panel->primaries = primaries;
    return true;
}

void panel_open_warps(Panel *panel) {
    PanelPrimaries *primaries = (PanelPrimaries *)panel->primaries;
    for (int p = 0; primaries && p < (panel->emission->has_black ? 4 : 3); p++)
        spectral_warp_fill(primaries->spectrum[p], &primaries->warp[p]);
}
