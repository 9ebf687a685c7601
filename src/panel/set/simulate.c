/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/simulate.h"

#include <math.h>
#include <stdlib.h>

#include "base/mathd.h"
#include "base/sampler.h"
#include "base/units.h"
#include "panel/set/angle_table.h"
#include "panel/set/dimming_keys.h"
#include "panel/set/set_writer.h"
#include "panel/set/synthetic_panel.h"
#include "spectrum/spectral_table.h"

typedef struct Instrument {
    const SyntheticPanel *panel; /* where it measures */
    const char *prefix;          /* of its tables' names: "", "spot_1/" */
    SetWriter writer;
    Progress progress;
    int tables_done;
    Arena scratch;
} Instrument;

/* A normal deviate by Box and Muller from two hashes of (seed, table, value). */
static double normal_deviate(const SyntheticInstrument *instrument, int table, uint32_t value) {
    uint32_t h =
        hash_combine(hash_combine(hash_u32((uint32_t)instrument->seed), (uint32_t)table), value);
    double u = ((double)hash_u32(h) + 0.5) / 4294967296.0;
    double v = ((double)hash_u32(h ^ 0x5bd1e995u) + 0.5) / 4294967296.0;
    return sqrt(-2 * log_d(u)) * cos_d(2 * PI * v);
}

static double noisy(const Instrument *instrument, double value, double absolute, uint32_t index) {
    const SyntheticInstrument *i = &instrument->panel->instrument;
    if (i->noise_relative == 0 && absolute == 0) return value;
    int table = instrument->tables_done;
    return value * (1 + i->noise_relative * normal_deviate(i, table, 2 * index)) +
           absolute * normal_deviate(i, table, 2 * index + 1);
}

static bool write_table(Instrument *instrument, const char *name, const Text *text) {
    bool ok = set_writer_add(&instrument->writer, name, text);
    progress_update(&instrument->progress, ++instrument->tables_done);
    return ok;
}

static PolarGrid grid_of(const Instrument *instrument, double theta_step, double phi_step) {
    double theta_max = instrument->panel->instrument.theta_max_deg;
    return polar_grid(theta_step, phi_step, (int)(theta_max / theta_step + 1e-9));
}

/* ---- emission -------------------------------------------------------------------------- */

/* primary -1: the black pattern. */
static bool write_emission(Instrument *instrument, int primary, double level) {
    const SyntheticPanel *panel = instrument->panel;
    Arena arena = instrument->scratch;
    Text text = {.arena = &arena};
    PolarGrid grid =
        grid_of(instrument, panel->instrument.theta_step_deg, panel->instrument.phi_step_deg);
    text_add(&text, "theta,phi,X,Y,Z\n");
    for (int i = 0; i < polar_grid_count(&grid); i++) {
        double degrees[2], xyz[3], add[3] = {0, 0, 0};
        polar_grid_direction(&grid, i, degrees);
        double angles[2] = {radians_from_degrees(degrees[0]), radians_from_degrees(degrees[1])};
        closed_form_black_xyz(panel, angles, xyz);
        if (primary >= 0) closed_form_emission_xyz(panel, primary, level, angles, add);
        text_format(&text, "%.10g,%.10g", degrees[0], degrees[1]);
        for (int j = 0; j < 3; j++)
            text_format(&text, ",%.6g",
                        noisy(instrument, xyz[j] + add[j], panel->instrument.noise_cd_m2,
                              (uint32_t)(3 * i + j)));
        text_add(&text, "\n");
    }
    const char *name = primary < 0
                           ? arena_format(&arena, "%semission/black.csv", instrument->prefix)
                           : arena_format(&arena, "%semission/%s_%03g.csv", instrument->prefix,
                                          primary_names[primary], level);
    return write_table(instrument, name, &text);
}

static bool write_all_emission(Instrument *instrument) {
    const SyntheticEmission *emission = &instrument->panel->emission;
    bool ok = write_emission(instrument, -1, 0);
    for (int p = 0; p < 3 && ok; p++)
        for (int i = 0; i < emission->level_count && ok; i++)
            ok = write_emission(instrument, p, emission->level[i]);
    return ok;
}

/* ---- reflection ------------------------------------------------------------------------ */

static void add_brdf_row(Instrument *instrument, Text *text, double incidence,
                         const double degrees[2], uint32_t index) {
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticReflection *r = &panel->reflection;
    text_format(text, "%.10g,%.10g", degrees[0], degrees[1]);
    for (int w = 0; w < r->wavelength_count; w++) {
        double value =
            closed_form_instrument_brdf(panel, incidence, radians_from_degrees(degrees[0]),
                                        radians_from_degrees(degrees[1]), r->wavelength_nm[w]);
        text_format(text, ",%.5g",
                    noisy(instrument, value, panel->instrument.noise_brdf_sr,
                          index * (uint32_t)r->wavelength_count + (uint32_t)w));
    }
    text_add(text, "\n");
}

static bool write_brdf(Instrument *instrument, double incidence_deg) {
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticReflection *r = &panel->reflection;
    Arena arena = instrument->scratch;
    Text text = {.arena = &arena};
    PolarGrid grid = grid_of(instrument, panel->instrument.brdf_theta_step_deg,
                             panel->instrument.brdf_phi_step_deg);
    text_add(&text, "theta,phi");
    for (int w = 0; w < r->wavelength_count; w++) text_format(&text, ",%.10g", r->wavelength_nm[w]);
    text_add(&text, "\n");
    for (int i = 0; i < polar_grid_count(&grid); i++) {
        double degrees[2];
        polar_grid_direction(&grid, i, degrees);
        add_brdf_row(instrument, &text, radians_from_degrees(incidence_deg), degrees, (uint32_t)i);
    }
    const char *name = arena_format(&arena, "%sbrdf/i%.10g.csv", instrument->prefix, incidence_deg);
    return write_table(instrument, name, &text);
}

static bool has_mirror(const SyntheticPanel *panel) {
    return panel->reflection.exists && panel->reflection.haze_share < 1;
}

/* The mirror as a reflectometer with the instrument's aperture reads it. Written behind all
 * tables, whose noise is numbered by their order. */
static bool write_specular(Instrument *instrument) {
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticReflection *r = &panel->reflection;
    double aperture = radians_from_degrees(panel->instrument.fwhm_deg);
    Arena arena = instrument->scratch;
    Text text = {.arena = &arena};
    text_add(&text, "incidence,wavelength,reflectance\n");
    for (int i = 0; i < r->incidence_count; i++)
        for (int w = 0; w < r->wavelength_count; w++) {
            double value = closed_form_specular(panel, radians_from_degrees(r->incidence_deg[i]),
                                                aperture, r->wavelength_nm[w]);
            uint32_t index = (uint32_t)(i * r->wavelength_count + w);
            text_format(&text, "%.10g,%.10g,%.5g\n", r->incidence_deg[i], r->wavelength_nm[w],
                        fmin(1, fmax(0, noisy(instrument, value, 0, index))));
        }
    const char *name = arena_format(&arena, "%sspecular.csv", instrument->prefix);
    return set_writer_add(&instrument->writer, name, &text);
}

/* ---- spectra and manifest -------------------------------------------------------------- */

static bool write_spectra(Instrument *instrument) {
    Arena arena = instrument->scratch;
    Text text = {.arena = &arena};
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

static void add_quoted(Text *text, const char *key, const char *value) {
    text_format(text, "  \"%s\": \"", key);
    for (; *value; value++) {
        if (*value == '"' || *value == '\\') text_add(text, "\\");
        if ((unsigned char)*value >= ' ') text_format(text, "%c", *value);
    }
    text_add(text, "\",\n");
}

static void add_list(Text *text, const char *key, const double *value, int count) {
    text_format(text, "\"%s\": [", key);
    for (int i = 0; i < count; i++) text_format(text, "%s%.10g", i ? ", " : "", value[i]);
    text_add(text, "]");
}

static void add_emission(Text *text, const SyntheticEmission *emission, const char *prefix) {
    text_format(text, "\"emission\": {\n    \"black\": \"%semission/black.csv\"", prefix);
    for (int p = 0; p < 3; p++) {
        text_format(text, ",\n    \"%s\": {", primary_names[p]);
        for (int i = 0; i < emission->level_count; i++)
            text_format(text, "%s\"%g\": \"%semission/%s_%03g.csv\"", i ? ", " : "",
                        emission->level[i], prefix, primary_names[p], emission->level[i]);
        text_add(text, "}");
    }
    text_add(text, "\n  }");
}

static void add_reflection(Text *text, const SyntheticPanel *panel, const char *prefix) {
    const SyntheticReflection *reflection = &panel->reflection;
    text_add(text, ",\n  \"reflection\": {");
    add_list(text, "wavelengths_nm", reflection->wavelength_nm, reflection->wavelength_count);
    text_add(text, ",\n    ");
    add_list(text, "incidence_deg", reflection->incidence_deg, reflection->incidence_count);
    text_format(text, ",\n    \"files\": \"%sbrdf/i{incidence}.csv\"", prefix);
    if (has_mirror(panel))
        text_format(text,
                    ",\n    \"specular\": {\"file\": \"%sspecular.csv\", "
                    "\"aperture_deg\": %.10g}",
                    prefix, panel->instrument.fwhm_deg);
    text_add(text, "}");
}

/* ---- places ------------------------------------------------------------------------------ */

static bool reflects_by_place(const SyntheticPanel *panel) {
    return panel->reflection.exists && panel->places.spots && panel->places.haze_slope != 0;
}

static const char *spot_prefix(int spot, Arena *arena) {
    return arena_format(arena, "spot_%d/", spot + 1);
}

static void add_spots(Text *text, const SyntheticPanel *panel) {
    const SyntheticPlaces *places = &panel->places;
    text_add(text, "  \"spots\": [");
    for (int i = 0; i < places->spots; i++) {
        const char *prefix = spot_prefix(i, text->arena);
        text_format(text, "%s\n  {\"position\": [%.10g, %.10g],\n   ", i ? "," : "", places->u[i],
                    places->v[i]);
        add_emission(text, &panel->emission, prefix);
        if (reflects_by_place(panel)) add_reflection(text, panel, prefix);
        text_add(text, "}");
    }
    text_add(text, "],\n");
}

static void add_uniformity(Text *text, const SyntheticPlaces *places) {
    text_add(text, ",\n  \"uniformity\": {\"file\": \"uniformity.csv\"");
    if (places->bend != 0)
        text_format(text, ", \"bend_deg\": %.10g", degrees_from_radians(places->bend));
    text_add(text, "}");
}

/* White and black of one pixel, as a distant camera in front of the middle sees them. */
static void add_pixel(Instrument *instrument, Text *text, int column, int row) {
    const SyntheticPanel *panel = instrument->panel;
    const int map[2] = {(int)panel->places.map[0], (int)panel->places.map[1]};
    double place[2] = {(column + 0.5) / map[0], (row + 0.5) / map[1]}, xyz[2][3];
    double turn = panel->places.bend * (place[0] - 0.5);
    double angles[2] = {fabs(turn), turn < 0 ? PI : 0};
    SyntheticPanel local = closed_form_at(panel, place);
    closed_form_black_xyz(&local, angles, xyz[1]);
    for (int j = 0; j < 3; j++) xyz[0][j] = xyz[1][j];
    for (int p = 0; p < 3; p++) {
        double add[3];
        closed_form_emission_xyz(&local, p, 255, angles, add);
        for (int j = 0; j < 3; j++) xyz[0][j] += add[j];
    }
    text_format(text, "%d,%d", column, row);
    for (int k = 0; k < 6; k++) {
        uint32_t index = 6 * (uint32_t)(row * map[0] + column) + (uint32_t)k;
        double value = noisy(instrument, xyz[k / 3][k % 3], panel->instrument.noise_cd_m2, index);
        text_format(text, ",%.6g", fmax(0, value));
    }
    text_add(text, "\n");
}

static bool write_map(Instrument *instrument) {
    const double *map = instrument->panel->places.map;
    Arena arena = instrument->scratch;
    Text text = {.arena = &arena};
    text_add(&text, "column,row,X,Y,Z,black_X,black_Y,black_Z\n");
    for (int row = 0; row < map[1]; row++)
        for (int column = 0; column < map[0]; column++) add_pixel(instrument, &text, column, row);
    return write_table(instrument, "uniformity.csv", &text);
}

static bool write_all_brdf(Instrument *instrument) {
    const SyntheticReflection *r = &instrument->panel->reflection;
    bool ok = true;
    for (int i = 0; i < r->incidence_count && ok && r->exists; i++)
        ok = write_brdf(instrument, r->incidence_deg[i]);
    return ok;
}

static bool write_all_specular(Instrument *instrument) {
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticPlaces *places = &panel->places;
    bool ok = true;
    if (!has_mirror(panel)) return true;
    if (!reflects_by_place(panel)) return write_specular(instrument);
    for (int i = 0; i < places->spots && ok; i++) {
        SyntheticPanel local = closed_form_at(panel, (double[2]){places->u[i], places->v[i]});
        instrument->panel = &local;
        instrument->prefix = spot_prefix(i, &instrument->writer.arena);
        ok = write_specular(instrument);
        instrument->panel = panel;
        instrument->prefix = "";
    }
    return ok;
}

/* Every table: of the middle, or of all spots. */
static bool write_places(Instrument *instrument) {
    const SyntheticPanel *panel = instrument->panel;
    const SyntheticPlaces *places = &panel->places;
    Arena *arena = &instrument->writer.arena;
    double middle[2] = {0.5, 0.5};
    bool ok = true;
    for (int i = 0; i < (places->spots ? places->spots : 1) && ok; i++) {
        double at[2] = {places->u[i], places->v[i]};
        SyntheticPanel local = closed_form_at(panel, places->spots ? at : middle);
        instrument->panel = &local;
        if (places->spots) instrument->prefix = spot_prefix(i, arena);
        ok = write_all_emission(instrument) &&
             (!reflects_by_place(panel) || write_all_brdf(instrument));
        instrument->panel = panel;
        instrument->prefix = "";
    }
    return ok && (reflects_by_place(panel) || write_all_brdf(instrument)) &&
           (!(places->map[0] > 0) || write_map(instrument)) && write_all_specular(instrument);
}

static int count_tables(const SyntheticPanel *panel) {
    const SyntheticPlaces *places = &panel->places;
    int spots = places->spots ? places->spots : 1;
    int slices = panel->reflection.exists ? panel->reflection.incidence_count : 0;
    return spots * (1 + 3 * panel->emission.level_count) +
           (reflects_by_place(panel) ? spots : 1) * slices + (places->map[0] > 0);
}

/* ---- the set ----------------------------------------------------------------------------- */

/* In the words of the recipe. */
static void add_traits(Text *text, const DisplayTraits *traits) {
    if (traits->polarisation_degree > 0)
        text_format(text, ",\n  \"polarisation\": {\"degree\": %.10g, \"azimuth_deg\": %.10g}",
                    traits->polarisation_degree, traits->polarisation_azimuth_deg);
    if (traits->has_zones) {
        json_t *zones = dimming_keys_json(&traits->zones);
        char *words = json_dumps(zones, JSON_COMPACT | JSON_REAL_PRECISION(9));
        text_format(text, ",\n  \"local_dimming\": %s", words);
        free(words);
        json_decref(zones);
    }
}

static bool write_manifest(Instrument *instrument) {
    const SyntheticPanel *panel = instrument->panel;
    Arena arena = instrument->scratch;
    Text text = {.arena = &arena};
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
    if (panel->places.spots) {
        add_spots(&text, panel);
    } else {
        text_add(&text, "  ");
        add_emission(&text, &panel->emission, "");
        text_add(&text, ",\n");
    }
    text_add(&text, "  \"primaries\": \"primaries.csv\"");
    add_traits(&text, &panel->traits);
    if (panel->reflection.exists && !reflects_by_place(panel)) add_reflection(&text, panel, "");
    if (panel->places.map[0] > 0) add_uniformity(&text, &panel->places);
    text_add(&text, "\n}\n");
    return set_writer_add(&instrument->writer, "MANIFEST.json", &text);
}

bool simulate_measurement(const SyntheticPanel *panel, const char *folder, ProgressMode mode,
                          Error *err) {
    Instrument instrument = {.panel = panel, .prefix = ""};
    Arena arena = arena_reserve((size_t)16 << 30);
    const Lines inputs = {.list = (const char *[]){panel->file}, .count = panel->file != NULL};
    bool ok = set_writer_open(arena_format(&arena, "%s/MANIFEST.json", folder), &inputs,
                              &instrument.writer, err);
    if (ok) {
        instrument.progress = progress_start(mode, "simulate", "tables", count_tables(panel));
        instrument.scratch = arena;
        ok = write_places(&instrument) && write_spectra(&instrument) && write_manifest(&instrument);
        ok = set_writer_close(&instrument.writer, ok);
        progress_end(&instrument.progress, instrument.tables_done);
    }
    arena_release(&arena);
    return ok;
}
