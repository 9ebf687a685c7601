#include "panel/set/simulate.h"

#include <math.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/sampler.h"
#include "base/units.h"
#include "panel/set/closed_form.h"
#include "panel/set/polar_grid.h"
#include "panel/set/set_writer.h"
#include "spectrum/spectral_table.h"

static const char *const primary_names[3] = {"red", "green", "blue"};

typedef struct Instrument {
    const SyntheticPanel *panel;
    SetWriter writer;
    Progress  progress;
    int       tables_done;
    Arena     scratch;
} Instrument;

/* A normal deviate by Box and Muller from two hashes of (seed, table, value). */
static double normal_deviate(const SyntheticInstrument *instrument, int table, uint32_t value)
{
    uint32_t h = hash_combine(hash_combine(hash_u32((uint32_t)instrument->seed),
                                           (uint32_t)table), value);
    double u = ((double)hash_u32(h) + 0.5) / 4294967296.0;
    double v = ((double)hash_u32(h ^ 0x5bd1e995u) + 0.5) / 4294967296.0;
    return sqrt(-2 * log_d(u)) * cos_d(2 * PI * v);
}

static double noisy(const Instrument *instrument, double value, double absolute, uint32_t index)
{
    const SyntheticInstrument *i = &instrument->panel->instrument;
    if (i->noise_relative == 0 && absolute == 0) return value;
    int table = instrument->tables_done;
    return value * (1 + i->noise_relative * normal_deviate(i, table, 2 * index)) +
           absolute * normal_deviate(i, table, 2 * index + 1);
}

static bool write_table(Instrument *instrument, const char *name, const Text *text)
{
    bool ok = set_writer_add(&instrument->writer, name, text);
    progress_update(&instrument->progress, ++instrument->tables_done);
    return ok;
}

static PolarGrid grid_of(const Instrument *instrument, double theta_step, double phi_step)
{
    double theta_max = instrument->panel->instrument.theta_max_deg;
    return polar_grid(theta_step, phi_step, (int)(theta_max / theta_step + 1e-9));
}

/* ---- emission -------------------------------------------------------------------------- */

/* primary -1: the black pattern. */
static bool write_emission(Instrument *instrument, int primary, double level)
{
    const SyntheticPanel *panel = instrument->panel;
    Arena arena = instrument->scratch;
    Text  text = {.arena = &arena};
    PolarGrid grid = grid_of(instrument, panel->instrument.theta_step_deg,
                             panel->instrument.phi_step_deg);
    text_add(&text, "theta,phi,X,Y,Z\n");
    for (int i = 0; i < polar_grid_count(&grid); i++) {
        double degrees[2], xyz[3], add[3] = {0, 0, 0};
        polar_grid_direction(&grid, i, degrees);
        double angles[2] = {radians_from_degrees(degrees[0]), radians_from_degrees(degrees[1])};
        closed_form_black_xyz(panel, angles, xyz);
        if (primary >= 0) closed_form_emission_xyz(panel, primary, level, angles, add);
        text_format(&text, "%.10g,%.10g", degrees[0], degrees[1]);
        for (int j = 0; j < 3; j++)
            text_format(&text, ",%.6g", noisy(instrument, xyz[j] + add[j],
                                           panel->instrument.noise_cd_m2,
                                           (uint32_t)(3 * i + j)));
        text_add(&text, "\n");
    }
    const char *name = primary < 0 ? "emission/black.csv"
        : arena_format(&arena, "emission/%s_%03g.csv", primary_names[primary], level);
    return write_table(instrument, name, &text);
}

static bool write_all_emission(Instrument *instrument)
{
    const SyntheticEmission *emission = &instrument->panel->emission;
    bool ok = write_emission(instrument, -1, 0);
    for (int p = 0; p < 3 && ok; p++)
        for (int i = 0; i < emission->level_count && ok; i++)
            ok = write_emission(instrument, p, emission->level[i]);
    return ok;
}

/* ---- reflection ------------------------------------------------------------------------ */

static void add_brdf_row(Instrument *instrument, Text *text, double incidence,
                         const double degrees[2], uint32_t index)
{
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticReflection *r = &panel->reflection;
    text_format(text, "%.10g,%.10g", degrees[0], degrees[1]);
    for (int w = 0; w < r->wavelength_count; w++) {
        double value = closed_form_instrument_brdf(panel, incidence,
            radians_from_degrees(degrees[0]), radians_from_degrees(degrees[1]),
            r->wavelength_nm[w]);
        text_format(text, ",%.5g", noisy(instrument, value, panel->instrument.noise_brdf_sr,
                                      index * (uint32_t)r->wavelength_count + (uint32_t)w));
    }
    text_add(text, "\n");
}

static bool write_brdf(Instrument *instrument, double incidence_deg)
{
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticReflection *r = &panel->reflection;
    Arena arena = instrument->scratch;
    Text  text = {.arena = &arena};
    PolarGrid grid = grid_of(instrument, panel->instrument.brdf_theta_step_deg,
                             panel->instrument.brdf_phi_step_deg);
    text_add(&text, "theta,phi");
    for (int w = 0; w < r->wavelength_count; w++)
        text_format(&text, ",%.10g", r->wavelength_nm[w]);
    text_add(&text, "\n");
    for (int i = 0; i < polar_grid_count(&grid); i++) {
        double degrees[2];
        polar_grid_direction(&grid, i, degrees);
        add_brdf_row(instrument, &text, radians_from_degrees(incidence_deg), degrees,
                     (uint32_t)i);
    }
    const char *name = arena_format(&arena, "brdf/i%.10g.csv", incidence_deg);
    return write_table(instrument, name, &text);
}

/* ---- spectra and manifest -------------------------------------------------------------- */

static bool write_spectra(Instrument *instrument)
{
    Arena arena = instrument->scratch;
    Text  text = {.arena = &arena};
    text_add(&text, "nm,red,green,blue\n");
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        int nm = SPECTRAL_FIRST_NM + i;
        text_format(&text, "%d", nm);
        for (int p = 0; p < 3; p++)
            text_format(&text, ",%.6g",
                     synthetic_panel_spectrum(&instrument->panel->emission.primary[p], nm));
        text_add(&text, "\n");
    }
    return set_writer_add(&instrument->writer, "primaries.csv", &text);
}

static void add_quoted(Text *text, const char *key, const char *value)
{
    text_format(text, "  \"%s\": \"", key);
    for (; *value; value++) {
        if (*value == '"' || *value == '\\') text_add(text, "\\");
        if ((unsigned char)*value >= ' ') text_format(text, "%c", *value);
    }
    text_add(text, "\",\n");
}

static void add_list(Text *text, const char *key, const double *value, int count)
{
    text_format(text, "\"%s\": [", key);
    for (int i = 0; i < count; i++) text_format(text, "%s%.10g", i ? ", " : "", value[i]);
    text_add(text, "]");
}

static void add_emission(Text *text, const SyntheticEmission *emission)
{
    text_add(text, "  \"emission\": {\n    \"black\": \"emission/black.csv\"");
    for (int p = 0; p < 3; p++) {
        text_format(text, ",\n    \"%s\": {", primary_names[p]);
        for (int i = 0; i < emission->level_count; i++)
            text_format(text, "%s\"%g\": \"emission/%s_%03g.csv\"", i ? ", " : "",
                     emission->level[i], primary_names[p], emission->level[i]);
        text_add(text, "}");
    }
    text_add(text, "\n  },\n");
}

static bool write_manifest(Instrument *instrument)
{
    const SyntheticPanel *panel = instrument->panel;
    Arena arena = instrument->scratch;
    Text  text = {.arena = &arena};
    text_add(&text, "{\n");
    add_quoted(&text, "panel", panel->name);
    text_format(&text, "  \"instrument\": \"simulated Fourier optics, %g deg\",\n",
             panel->instrument.theta_max_deg);
    add_quoted(&text, "note", panel->note);
    text_format(&text, "  \"instrument_fwhm_deg\": %g,\n  ", panel->instrument.fwhm_deg);
    add_list(&text, "pixels", panel->pixels, 2);
    text_add(&text, ",\n  ");
    add_list(&text, "size_mm", panel->size_mm, 2);
    text_add(&text, ",\n");
    add_emission(&text, &panel->emission);
    text_add(&text, "  \"primaries\": \"primaries.csv\"");
    if (panel->reflection.exists) {
        text_add(&text, ",\n  \"reflection\": {");
        add_list(&text, "wavelengths_nm", panel->reflection.wavelength_nm,
                 panel->reflection.wavelength_count);
        text_add(&text, ",\n    ");
        add_list(&text, "incidence_deg", panel->reflection.incidence_deg,
                 panel->reflection.incidence_count);
        text_add(&text, ",\n    \"files\": \"brdf/i{incidence}.csv\"}");
    }
    text_add(&text, "\n}\n");
    return set_writer_add(&instrument->writer, "MANIFEST.json", &text);
}

bool simulate_measurement(const SyntheticPanel *panel, const char *folder, ProgressMode mode,
                          Error *err)
{
    const SyntheticReflection *r = &panel->reflection;
    int        slices = r->exists ? r->incidence_count : 0;
    int        tables = 1 + 3 * panel->emission.level_count + slices;
    Instrument instrument = {.panel = panel};
    Arena      arena = arena_reserve((size_t)16 << 30);
    bool       ok = set_writer_open(arena_format(&arena, "%s/MANIFEST.json", folder),
                                    &instrument.writer, err);
    if (ok) {
        instrument.progress = progress_start(mode, "simulate", "tables", tables);
        instrument.scratch = arena;
        ok = write_all_emission(&instrument);
        for (int i = 0; i < slices && ok; i++)
            ok = write_brdf(&instrument, r->incidence_deg[i]);
        ok = ok && write_spectra(&instrument) && write_manifest(&instrument);
        ok = set_writer_close(&instrument.writer, ok);
        progress_end(&instrument.progress, instrument.tables_done);
    }
    arena_release(&arena);
    return ok;
}
