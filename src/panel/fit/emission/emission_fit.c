/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_fit.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "hemisphere/tree/tree_open.h"
#include "panel/fit/common/scatter_gaps.h"
#include "panel/fit/common/table_rows.h"
#include "panel/query/panel_file.h"
#include "panel/set/primary_bands.h"
#include "panel/set/primary_spectra.h"
#include "panel/shape/spectral_warp.h"

/* Relative. Conoscopes repeat within 1 to 2 %; what is left of the noise is in the surface
 * through the samples already. */
#define TOLERANCE 0.005

/* ---- what is known of the tables -------------------------------------------------------- */

/* A black pattern whose light is below every meter's reach is a true black. */
static bool black_shines(const Measurement *set) {
    double sum = 0, noise = 0;
    if (!set->has_black) return false;
    for (int i = 0; i < set->black.rows; i++) {
        sum += (double)set->black.value[3 * i + 1];
        noise += fabs((double)set->black.value[3 * i + 1]);
    }
    return sum > 0.5 * noise && sum / set->black.rows > 1e-4;
}

/* What every table shows in one direction may be a peak of the display as well: no other table
 * says that it is not. */
static void find_shared(const Measurement *set, EmissionResult *out) {
    const AngleTable *first = emission_samples_table(set, out->has_black, 0).table;
    for (int row = 0; first && row < first->rows; row++) {
        EmissionTable one;
        bool is_shared = true;
        for (int i = 0; (one = emission_samples_table(set, out->has_black, i)).table; i++)
            is_shared &=
                one.primary == 3 || (one.table->rows == first->rows && out->outlier[i][row]);
        if (is_shared && !out->shared++)
            out->shared_first =
                (EmissionFlag){.theta = (double)first->theta[row], .phi = (double)first->phi[row]};
    }
}

static void survey_tables(const Measurement *set, Arena *arena, EmissionResult *out) {
    const AngleTable *table;
    out->outliers.flag = ARENA_NEW(arena, EmissionFlag, EMISSION_FLAGS_MAX);
    out->holes.flag = ARENA_NEW(arena, EmissionFlag, EMISSION_FLAGS_MAX);
    for (int i = 0; (table = emission_samples_table(set, out->has_black, i).table); i++) {
        out->table_count = i + 1;
        out->outlier[i] = ARENA_NEW(arena, uint8_t, table->rows);
        out->outlier_count +=
            emission_outliers_find(table, out->outlier[i], &out->outliers, *arena);
        out->noise[i] = emission_samples_noise(table, out->outlier[i], *arena);
        out->hole_count += emission_outliers_find_holes(table, &out->holes, *arena);
    }
    find_shared(set, out);
}

static void note_flags(const EmissionResult *e, FitNotes *notes) {
    if (e->outlier_count)
        fit_note(notes,
                 "%d emission samples stand out of their neighbours and are not "
                 "followed; the errors leave them out",
                 e->outlier_count);
    if (e->hole_count)
        fit_note(notes,
                 "%d directions of the emission tables' grids are not measured; the "
                 "other tables and their neighbours fill them",
                 e->hole_count);
}

/* ---- the section of the file (layout: panel_file.h) -------------------------------------- */

static void put(unsigned char **to, const void *from, size_t bytes) {
    memcpy(*to, from, bytes);
    *to += bytes;
}

static void put_levels(unsigned char **to, const Measurement *set) {
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++) {
            double units = rint(set->primary[p].level[i] * (double)PANEL_LEVEL_UNIT);
            uint16_t level = (uint16_t)fmax(1, fmin(255 * (double)PANEL_LEVEL_UNIT, units));
            put(to, &level, sizeof level);
        }
}

/* The step of a component's loadings: what is left of the rounding, times scores of up to five
 * times their deviation, must not matter. */
static int loading_exponent(const EmissionModel *model) {
    double step = 2 * model->tolerance / (24 * 5 * sqrt((double)model->rank->components));
    int exponent = 0;
    frexp(step, &exponent);
    return 1 - exponent < 0 ? 0 : 1 - exponent > 20 ? 20 : 1 - exponent;
}

typedef struct LoadingCode {
    uint8_t exponent, width;
} LoadingCode;

static LoadingCode loading_code(const EmissionModel *model, int component) {
    const EmissionRank *rank = model->rank;
    int channels = model->samples->channels, e = loading_exponent(model);
    float most = 0;
    for (int c = 0; c < channels; c++)
        most = fmaxf(most, fabsf(rank->loading[c * rank->components + component]));
    while (e > 0 && most > ldexpf(32766, -e)) e--;
    return (LoadingCode){(uint8_t)e, ldexpf(most, e) < 126.5f ? 1 : 2};
}

static int rounded_to(float value, int exponent) {
    return (int)fminf(32767, fmaxf(-32767, rintf(ldexpf(value, exponent))));
}

/* Means and loadings become what the section holds. */
static void round_model(EmissionModel *model) {
    EmissionRank *rank = model->rank;
    for (int c = 0; c < model->samples->channels; c++)
        rank->mean[c] = ldexpf((float)rounded_to(rank->mean[c], PANEL_MEAN_BITS), -PANEL_MEAN_BITS);
    for (int k = 0; k < rank->components; k++) {
        LoadingCode code = loading_code(model, k);
        for (int c = 0; c < model->samples->channels; c++) {
            float *at = &rank->loading[c * rank->components + k];
            *at = ldexpf((float)rounded_to(*at, code.exponent), -code.exponent);
        }
    }
}

static PanelEmissionHead section_head(const EmissionModel *model) {
    const EmissionSamples *s = model->samples;
    PanelEmissionHead head = {.components = (uint8_t)model->rank->components,
                              .has_black = s->black >= 0,
                              .cone_cos = fmaxf(0, (float)cos_d(s->cone)),
                              .level_power = 2.2f,
                              .cosine_power = model->rank->cosine_power};
    for (int p = 0; p < 3; p++) head.level_count[p] = (uint8_t)s->set->primary[p].level_count;
    return head;
}

static void put_loadings(unsigned char **to, const EmissionModel *model) {
    const EmissionRank *rank = model->rank;
    LoadingCode code[PANEL_COMPONENTS_MAX];
    for (int k = 0; k < rank->components; k++) code[k] = loading_code(model, k);
    for (int k = 0; k < rank->components; k++) put(to, &code[k].exponent, 1);
    for (int k = 0; k < rank->components; k++) put(to, &code[k].width, 1);
    for (int pass = 2; pass >= 1; pass--)
        for (int k = 0; k < rank->components; k++)
            for (int c = 0; c < model->samples->channels && code[k].width == pass; c++) {
                int value = rounded_to(rank->loading[c * rank->components + k], code[k].exponent);
                int16_t wide = (int16_t)value;
                int8_t narrow = (int8_t)value;
                put(to, pass == 2 ? (const void *)&wide : (const void *)&narrow, (size_t)pass);
            }
}

static const void *write_section(const EmissionModel *model, Arena *arena, size_t *size) {
    size_t channels = (size_t)model->samples->channels;
    size_t most = sizeof(PanelEmissionHead) + 4 * channels +
                  (size_t)model->rank->components * (2 + 2 * channels) + model->spline_size;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, most), *at = bytes;
    PanelEmissionHead head = section_head(model);
    put(&at, &head, sizeof head);
    put_levels(&at, model->samples->set);
    for (size_t c = 0; c < channels; c++) {
        int16_t mean = (int16_t)rounded_to(model->rank->mean[c], PANEL_MEAN_BITS);
        put(&at, &mean, sizeof mean);
    }
    put_loadings(&at, model);
    put(&at, model->spline_bytes, model->spline_size);
    *size = (size_t)(at - bytes);
    return bytes;
}

/* ---- the model ------------------------------------------------------------------------- */

/* Noise of every component's score at a row, from differences of neighbours. */
static void find_score_noise(EmissionModel *model, Arena *arena) {
    const EmissionSamples *s = model->samples;
    int n = model->rank->components;
    AngleTable table = *s->master;
    table.channels = n;
    table.value = model->rank->score;
    model->score_noise = ARENA_NEW(arena, float, n);
    for (int k = 0; k < n; k++)
        model->score_noise[k] =
            (float)(model->is_scattered ? scatter_surface_table_noise(&table, k, false, *arena)
                                        : table_noise_plain(&table, k, *arena));
}

#define NOISY 0.5 /* of the tolerance */

/* Noise of a channel due to the scores' noise; the median of all. */
static double channel_noise(const EmissionModel *model, Arena scratch) {
    const EmissionRank *rank = model->rank;
    int n = rank->components, channels = model->samples->channels;
    double *list = ARENA_NEW(&scratch, double, channels);
    for (int c = 0; c < channels; c++) {
        for (int k = 0; k < n; k++)
            list[c] += pow_d((double)rank->loading[c * n + k] * (double)model->score_noise[k], 2);
        list[c] = sqrt(list[c]);
    }
    return sort_median(list, channels);
}

/* Rounding steps of the components: together they may cost a sixth of the tolerance. */
static void choose_steps(EmissionModel *model, Arena *arena) {
    const EmissionRank *rank = model->rank;
    int n = rank->components;
    model->step = ARENA_NEW(arena, float, n);
    for (int k = 0; k < n; k++) {
        float most = 1e-6f;
        for (int c = 0; c < model->samples->channels; c++)
            most = fmaxf(most, fabsf(rank->loading[c * n + k]));
        model->step[k] = (float)(2 * model->tolerance / (6 * sqrt((double)n))) / most;
    }
}

static bool build_model(const Measurement *set, const FitOptions *options, Arena *arena,
                        FitNotes *notes, EmissionResult *out, EmissionModel *model) {
    EmissionSamples *samples = ARENA_NEW(arena, EmissionSamples, 1);
    samples->tolerance = options->bound > 0 ? (double)options->bound : TOLERANCE;
    samples->floor_share = (double)options->error_floor;
    EmissionRank *rank = ARENA_NEW(arena, EmissionRank, 1);
    *model = (EmissionModel){
        .samples = samples, .rank = rank, .noise = out->noise, .tolerance = samples->tolerance};
    emission_samples_gather(set, out->has_black, out->outlier, out->noise, arena, samples);
    emission_rank_find(samples, arena, rank);
    model->is_scattered = emission_samples_are_scattered(samples->master, *arena);
    for (int i = 0; i < out->table_count - out->has_black; i++)
        model->has_edges |= out->noise[i].has_edges;
    emission_samples_note(samples, *arena, notes);
    if (model->has_edges)
        fit_note(notes, "the light ends sharply: between samples it is interpolated as it is, "
                        "not as its logarithm");
    find_score_noise(model, arena);
    model->is_noisy = channel_noise(model, *arena) > NOISY * model->tolerance;
    round_model(model);
    choose_steps(model, arena);
    return emission_model_fit_smooth(model, arena);
}

/* ---- holes in the data ------------------------------------------------------------------ */

/* What a panel may miss of an emission between samples.
 *
 * Of the brightest channel. */

typedef struct LightRead {
    const EmissionModel *model;
    const ScatterSurface *surface;
    Tree tree;
    int channel;
    float *total; /* of all channels */
} LightRead;

static double log_of(const LightRead *read, float value) {
    return log_d(fmax((double)value, fmax(read->model->samples->floor[read->channel], 1e-9)));
}

static double read_gap(void *context, Vec3 at, double *off) {
    const LightRead *read = context;
    float components[PANEL_COMPONENTS_MAX], log;
    emission_tree_components(read->model, &read->tree, at, components);
    emission_model_totals(read->model, components, at, read->total);
    scatter_surface_read(read->surface, at, &log);
    double panel = log_of(read, read->total[read->channel]);
    *off = (double)log - panel;
    return panel;
}

static int brightest(const EmissionSamples *s) {
    double most = -1;
    int out = 0;
    for (int c = 0; c < s->channels; c++) {
        double sum = 0;
        for (int i = 0; i < s->rows; i++) sum += (double)s->total[i * s->channels + c];
        if (sum > most) most = sum, out = c;
    }
    return out;
}

/* tree: of what the smooth part leaves. */
static bool emission_gaps_find(const EmissionModel *model, const EmissionTree *tree, Arena scratch,
                               ScatterGaps *out, Error *err) {
    const EmissionSamples *s = model->samples;
    LightRead read = {
        .model = model, .channel = brightest(s), .total = ARENA_NEW(&scratch, float, s->channels)};
    float *log = ARENA_NEW(&scratch, float, s->rows);
    for (int i = 0; i < s->rows; i++)
        log[i] = (float)log_of(&read, s->total[i * s->channels + read.channel]);
    read.surface = scatter_surface_make(s->master, false, log, 1, &scratch);
    if (!tree_open(tree->bytes, tree_size(tree->bytes), geodesic_create(tree->level, &scratch),
                   &scratch, &read.tree, err))
        return false;
    ScatterAsked asked = {read.surface, read_gap, &read};
    *out = scatter_gaps_find(&asked, scratch);
    return true;
}

/* ---- all of it --------------------------------------------------------------------------- */

bool emission_fit(const Measurement *set, const FitOptions *options, Arena *arena, FitNotes *notes,
                  EmissionResult *out, Error *err) {
    EmissionModel *model = ARENA_NEW(arena, EmissionModel, 1);
    out->has_black = black_shines(set);
    survey_tables(set, arena, out);
    note_flags(out, notes);
    if (set->has_black && !out->has_black)
        fit_note(notes, "the black pattern is below 0.0001 cd/m2 or noise: black is 0");
    if (!build_model(set, options, arena, notes, out, model))
        return error_set(err, ERROR_INPUT, "emission: the smooth part cannot be stored");
    if (!emission_tree_build(model, options, arena, &out->tree, err)) return false;
    if (!emission_gaps_find(model, &out->tree, *arena, &out->gaps, err)) return false;
    if (out->tree.missed)
        fit_note(notes, "emission: %d of %d directions miss %.2g%% beyond 5 sigma of noise",
                 out->tree.missed, model->samples->rows, 100 * model->tolerance);
    out->section = write_section(model, arena, &out->section_size);
    out->model = model;
    return true;
}

/* ---- the primaries' section -------------------------------------------------------------- */

#define SPECTRA_STEPS 6

static float most_of(const float *spectrum) {
    float most = 0;
    for (int i = 0; i < SPECTRAL_COUNT; i++) most = fmaxf(most, spectrum[i]);
    return most;
}

/* Range of whole nm that hold light in any primary. */
static void lit_range(const float (*spectrum)[SPECTRAL_COUNT], int *first, int *last) {
    *first = SPECTRAL_COUNT;
    *last = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            if (spectrum[p][i] > 0) {
                if (i < *first) *first = i;
                if (i > *last) *last = i;
            }
}

/* Do samples every `step` nm from `first` on determine everything in between? */
static bool is_told_by(const float (*spectrum)[SPECTRAL_COUNT], int first, int last, int step) {
    for (int p = 0; p < 3; p++) {
        const float *s = spectrum[p];
        float small = 1e-5f * most_of(s);
        for (int i = first; i <= last; i++) {
            int a = first + (i - first) / step * step, b = a + step;
            float t = (float)(i - a) / (float)step;
            if (b > last && i > a) return false;
            if (b > last) continue;
            if (fabsf(s[a] + (s[b] - s[a]) * t - s[i]) > small) return false;
        }
    }
    return true;
}

static int choose_step(const float (*spectrum)[SPECTRAL_COUNT], int first, int last) {
    static const int steps[SPECTRA_STEPS] = {20, 10, 5, 4, 2, 1};
    for (int k = 0; k < SPECTRA_STEPS; k++)
        if ((last - first) % steps[k] == 0 && is_told_by(spectrum, first, last, steps[k]))
            return steps[k];
    return 1;
}

/* A spectrum that is 0 at its ends may have begun and ended one step outside of the light. */
static int widen(const float (*spectrum)[SPECTRAL_COUNT], int *first, int *last) {
    int best = choose_step(spectrum, *first, *last), low = *first, high = *last;
    for (int before = 0; before < 20 && low - before >= 0; before++)
        for (int after = 0; after < 20 && high + after < SPECTRAL_COUNT; after++) {
            int step = choose_step(spectrum, low - before, high + after);
            if (step <= best) continue;
            best = step;
            *first = low - before;
            *last = high + after;
        }
    return best;
}

static void assume_bands(const Measurement *set, Arena *arena, EmissionPrimaries *out,
                         FitNotes *notes) {
    PrimaryBands *bands = ARENA_NEW(arena, PrimaryBands, 1);
    double xyz[3][3];
    const char *missed = "", *moved = "";
    for (int p = 0; p < 3; p++) primary_colour(set, p, set->primary[p].level_count - 1, xyz[p]);
    primary_bands_find(set->backlight, set->peaks_nm, (const double(*)[3])xyz, bands);
    if (set->peaks_nm[0] > 0 && memcmp(bands->peak_nm, set->peaks_nm, sizeof bands->peak_nm))
        moved = arena_format(arena,
                             " (stated: %g, %g, %g nm, from where the colours are out "
                             "of reach)",
                             set->peaks_nm[0], set->peaks_nm[1], set->peaks_nm[2]);
    if (bands->miss > PRIMARY_BANDS_MISS)
        missed = arena_format(arena,
                              "; no light has the measured colours, which are missed by "
                              "delta u'v' %.2g",
                              bands->miss);
    out->assumed = arena_format(
        arena,
        "spectra of the primaries assumed: bands of a backlight "
        "'%s'%s at %.4g, %.4g and %.4g nm%s, %.3g, %.3g and %.3g nm wide, mixed to the "
        "measured colours",
        primary_backlights[bands->backlight], set->backlight ? "" : " (not stated)",
        bands->peak_nm[0], bands->peak_nm[1], bands->peak_nm[2], moved, bands->fwhm_nm[0],
        bands->fwhm_nm[1], bands->fwhm_nm[2]);
    fit_note(notes,
             "%s%s; white may be off by delta u'v' %.2g behind a pane whose "
             "transmittance changes twofold from 400 to 700 nm, and by %.2g behind a sharp "
             "edge (to the narrowest bands of the same colours): measure spectra (primaries)",
             out->assumed, missed, bands->off_uv, bands->off_edge);
    out->spectrum = (const float(*)[SPECTRAL_COUNT])bands->spectrum;
}

/* The section at the sampling of the spectra. */
static void write_primaries(EmissionPrimaries *out, PanelPrimariesHead head, Arena *arena) {
    const float(*spectrum)[SPECTRAL_COUNT] = out->spectrum;
    int first = 0, last = -1, step = 1;
    if (spectrum) {
        lit_range(spectrum, &first, &last);
        step = widen(spectrum, &first, &last);
        if (last == first) last++;
        head.first_nm = (float)(SPECTRAL_FIRST_NM + first);
        head.step_nm = (float)step;
        head.count = (uint16_t)((last - first) / step + 1);
    }
    out->size = sizeof head + 6 * (size_t)head.count;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, out->size);
    unsigned char *at = bytes + sizeof head;
    for (int p = 0; p < 3; p++) {
        head.scale[p] = fmaxf(spectrum ? most_of(spectrum[p]) : 0, 1e-30f) / 65535;
        for (int i = first; i <= last && head.count; i += step) {
            uint16_t value = (uint16_t)rintf(spectrum[p][i] / head.scale[p]);
            memcpy(at, &value, sizeof value);
            at += sizeof value;
        }
    }
    memcpy(bytes, &head, sizeof head);
    out->bytes = bytes;
}

void emission_fit_primaries(const Measurement *set, FitNotes *notes, Arena *arena,
                            EmissionPrimaries *out) {
    PanelPrimariesHead head = {.kind = PANEL_SPECTRA_STORED};
    Twice worst;
    bool is_split =
        set->is_white_only && !(set->white_miss > 0) && !set->backlight && !(set->peaks_nm[0] > 0);
    *out = (EmissionPrimaries){.spectrum = NULL};
    if (set->has_spectra) {
        out->spectrum = (const float(*)[SPECTRAL_COUNT])set->spectrum;
        if (primary_twice(set, &worst)) fit_note(notes, "%s", twice_text(&worst, arena));
    } else if (is_split) {
        head.kind = PANEL_SPECTRA_REC709;
        out->assumed = "spectra of the primaries assumed: the Rec.709 primaries' smooth "
                       "spectra under D65";
        fit_note(notes, "%s, bent to the measured colours", out->assumed);
    } else {
        assume_bands(set, arena, out, notes);
    }
    write_primaries(out, head, arena);
}
