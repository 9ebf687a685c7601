/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/export.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/number.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_report.h"
#include "panel/query/panel_zones.h"
#include "panel/set/angle_table.h"
#include "panel/set/dimming_keys.h"
#include "panel/set/display_traits.h"
#include "panel/set/set_writer.h"
#include "spectrum/spectral_table.h"

#define STEPS_OF_FWHM 2.4  /* how well the mirror's image is sampled */
#define MOST_FWHM_DEG 15.0 /* that a manifest may declare */

typedef struct Export {
    const Panel *panel;
    const char *prefix; /* of its tables' names: "", "spot_1/" */
    const ExportOptions *options;
    SetWriter *writer;  /* NULL: one table alone */
    bool is_white_only; /* fitted to a white table, without levels */
    Arena scratch;
    Progress progress;
    int done;
    Error *err;
} Export;

static PolarGrid grid_of(const ExportOptions *options, double cone, bool is_reflection) {
    double theta = options->theta_step_deg, phi = options->phi_step_deg;
    double edge = options->extrapolates ? 90 : degrees_from_radians(cone);
    if (!(theta > 0)) theta = is_reflection ? 0.5 : 1;
    if (!(phi > 0)) phi = is_reflection ? 1 : 3;
    return polar_grid(theta, phi, (int)(edge / theta + 1e-4));
}

static Vec3 direction_deg(double theta_deg, double phi_deg) {
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg);
    return vec3((float)(sin_d(t) * cos_d(p)), (float)(sin_d(t) * sin_d(p)), (float)cos_d(t));
}

static bool write_table(Export *export, const char *name, const Text *text) {
    bool ok = export->writer ? set_writer_add(export->writer, name, text)
                             : text_write(text, name, export->err);
    progress_update(&export->progress, ++export->done);
    return ok;
}

/* A table's name beside the manifest. */
static const char *named(Export *export, const char *name) {
    return arena_format(&export->scratch, "%s%s", export->prefix, name);
}

/* ---- emission -------------------------------------------------------------------------- */

static bool write_emission(Export *export, const double rgb[3], const char *name) {
    Arena arena = export->scratch;
    PolarGrid grid = grid_of(export->options, panel_info_emission_cone(export->panel), false);
    Text text = {.arena = &arena};
    float codes[3] = {(float)rgb[0], (float)rgb[1], (float)rgb[2]}, xyz[3];
    text_format(&text,
                "# codes %.10g,%.10g,%.10g; theta and phi in degrees; CIE 1931 XYZ, "
                "Y in cd/m2, black not subtracted\ntheta,phi,X,Y,Z\n",
                rgb[0], rgb[1], rgb[2]);
    for (int i = 0; i < polar_grid_count(&grid); i++) {
        double degrees[2];
        polar_grid_direction(&grid, i, degrees);
        panel_emission_xyz(export->panel, direction_deg(degrees[0], degrees[1]), codes, xyz);
        text_format(&text, "%.10g,%.10g,%.9g,%.9g,%.9g\n", degrees[0], degrees[1], (double)xyz[0],
                    (double)xyz[1], (double)xyz[2]);
    }
    return write_table(export, name, &text);
}

static bool write_spectra(Export *export, const char *name) {
    Arena arena = export->scratch;
    Text text = {.arena = &arena};
    text_format(&text, "# spectral radiance in W m^-2 sr^-1 nm^-1 at 1 cd/m2 on the axis; "
                       "wavelength in nm\nnm,red,green,blue\n");
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        text_format(&text, "%d", SPECTRAL_FIRST_NM + i);
        for (int p = 0; p < 3; p++)
            text_format(&text, ",%.9g", (double)panel_info_spectrum(export->panel, p)[i]);
        text_add(&text, "\n");
    }
    return write_table(export, name, &text);
}

static bool write_all_emission(Export *export, json_t *manifest) {
    json_t *emission = json_object();
    json_object_set_new(manifest, "emission", emission);
    if (export->is_white_only) {
        const char *name = named(export, "emission/white.csv");
        json_object_set_new(emission, "white", json_string(name));
        return write_emission(export, (double[]){255, 255, 255}, name);
    }
    const char *black = named(export, "emission/black.csv");
    json_object_set_new(emission, "black", json_string(black));
    bool ok = write_emission(export, (double[]){0, 0, 0}, black);
    for (int p = 0; p < 3 && ok; p++) {
        double code[PANEL_INFO_LEVELS_MAX];
        json_t *levels = json_object();
        int count = panel_info_levels(export->panel, p, code);
        json_object_set_new(emission, primary_names[p], levels);
        for (int i = 0; i < count && ok; i++) {
            double rgb[3] = {0, 0, 0};
            char table[64], level[32];
            snprintf(table, sizeof table, "emission/%s_%03g.csv", primary_names[p], code[i]);
            const char *file = named(export, table);
            snprintf(level, sizeof level, "%.10g", code[i]);
            rgb[p] = code[i];
            json_object_set_new(levels, level, json_string(file));
            ok = write_emission(export, rgb, file);
        }
    }
    json_object_set_new(manifest, "primaries", json_string("primaries.csv"));
    return ok && write_spectra(export, "primaries.csv");
}

/* ---- reflection ------------------------------------------------------------------------ */

/* Width of the instrument that is declared to have seen the mirror part; 0: left out. */
static double mirror_fwhm(const Export *export) {
    PolarGrid grid = grid_of(export->options, 0, true);
    double fwhm = export->options->mirror_fwhm_deg;
    if (fwhm < 0)
        fwhm = fmin(MOST_FWHM_DEG, STEPS_OF_FWHM * fmax(grid.theta_step, 0.5 * grid.phi_step));
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    int count = panel_info_wavelengths(export->panel, nm);
    for (int first = 0; first < count; first++) {
        Wavelengths w = {0};
        for (int i = 0; i < SPECTRUM_LANES; i++) w.nm[i] = nm[first];
        if (panel_mirror(export->panel, 0.8f, &w)[0] > 0) return fwhm;
    }
    return 0;
}

/* A mirror's image of reflectance 1 at so many degrees from its centre, sr^-1: a normal
 * distribution of the instrument's width over the sphere, divided by the cosine. */
static double image_of_mirror(double fwhm_deg, double incidence_deg, const double degrees[2]) {
    if (!(fwhm_deg > 0)) return 0;
    double a = radians_from_degrees(incidence_deg), b = radians_from_degrees(degrees[0]);
    double dt = sin_d(0.5 * (a - b)), dp = sin_d(0.5 * radians_from_degrees(degrees[1]));
    double d = 2 * asin_d(sqrt(fmin(1, dt * dt + sin_d(a) * sin_d(b) * dp * dp)));
    double sigma = radians_from_degrees(fwhm_deg) / sqrt(8 * log_d(2));
    return exp_d(-0.5 * d * d / (sigma * sigma)) / (2 * PI * sigma * sigma * cos_d(a));
}

typedef struct Light {
    double theta_deg, phi_deg;
} Light;

/* One row; phi counts from the mirror direction, the light is at 180. */
static void add_row(const Export *export, const Light *light, double fwhm_deg,
                    const double degrees[2], Text *text) {
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    int count = panel_info_wavelengths(export->panel, nm);
    double image = image_of_mirror(fwhm_deg, light->theta_deg, degrees);
    Vec3 wi = direction_deg(light->theta_deg, light->phi_deg);
    Vec3 wo = direction_deg(degrees[0], light->phi_deg - 180 + degrees[1]);
    text_format(text, "%.10g,%.10g", degrees[0], degrees[1]);
    for (int first = 0; first < count; first += SPECTRUM_LANES) {
        Wavelengths w = {0};
        for (int i = 0; i < SPECTRUM_LANES; i++)
            w.nm[i] = nm[first + i < count ? first + i : count - 1];
        Spectrum f = panel_brdf(export->panel, wo, wi, &w);
        Spectrum r = panel_mirror(export->panel, wi.z, &w);
        for (int i = 0; i < SPECTRUM_LANES && first + i < count; i++)
            text_format(text, ",%.9g", (double)f[i] + image * (double)r[i]);
    }
    text_add(text, "\n");
}

static bool write_brdf(Export *export, const Light *light, double fwhm_deg, const char *name) {
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    int count = panel_info_wavelengths(export->panel, nm);
    Arena arena = export->scratch;
    double cone = panel_info_reflection_cone(export->panel);
    PolarGrid grid = grid_of(export->options, cone, true);
    Text text = {.arena = &arena};
    text_format(&text,
                "# light from theta %.10g, phi %.10g; angles in degrees, phi from "
                "the mirror direction; sr^-1 without the cosine; columns in nm\n",
                light->theta_deg, light->phi_deg);
    text_format(&text, "# the mirror part %s\ntheta,phi",
                fwhm_deg > 0 ? "as the instrument that the manifest declares sees it"
                             : "(a delta) is not in these numbers");
    for (int i = 0; i < count; i++) text_format(&text, ",%.9g", (double)nm[i]);
    text_add(&text, "\n");
    for (int i = 0; i < polar_grid_count(&grid); i++) {
        double degrees[2];
        polar_grid_direction(&grid, i, degrees);
        add_row(export, light, fwhm_deg, degrees, &text);
    }
    return write_table(export, name, &text);
}

static double tidy_degrees(double radians) {
    return round(degrees_from_radians(radians) * 1e4) / 1e4;
}

static bool write_all_brdf(Export *export, json_t *manifest) {
    double theta[PANEL_INFO_INCIDENCES_MAX], phi[PANEL_INFO_AZIMUTHS_MAX];
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    int thetas = panel_info_incidences(export->panel, theta), nms;
    int phis = panel_info_azimuths(export->panel, phi);
    json_t *reflection = json_object(), *incidences = json_array(), *azimuths = json_array();
    json_t *wavelengths = json_array();
    double fwhm = mirror_fwhm(export);
    bool ok = true;
    nms = panel_info_wavelengths(export->panel, nm);
    for (int i = 0; i < nms; i++) json_array_append_new(wavelengths, json_real((double)nm[i]));
    for (int i = 0; i < thetas; i++)
        json_array_append_new(incidences, json_real(tidy_degrees(theta[i])));
    for (int i = 0; i < phis; i++) json_array_append_new(azimuths, json_real(tidy_degrees(phi[i])));
    json_object_set_new(reflection, "wavelengths_nm", wavelengths);
    json_object_set_new(reflection, "incidence_deg", incidences);
    if (phis > 1) json_object_set(reflection, "incidence_phi_deg", azimuths);
    json_decref(azimuths);
    json_object_set_new(reflection, "files",
                        json_string(named(export, phis > 1 ? "brdf/i{incidence}_a{azimuth}.csv"
                                                           : "brdf/i{incidence}.csv")));
    json_object_set_new(manifest, "reflection", reflection);
    if (fwhm > 0) json_object_set_new(manifest, "instrument_fwhm_deg", json_real(fwhm));
    for (int i = 0; i < thetas * phis && ok; i++) {
        Light light = {tidy_degrees(theta[i / phis]), tidy_degrees(phi[i % phis])};
        char azimuth[32] = "", file[80];
        if (phis > 1) snprintf(azimuth, sizeof azimuth, "_a%.10g", light.phi_deg);
        snprintf(file, sizeof file, "brdf/i%.10g%s.csv", light.theta_deg, azimuth);
        ok = write_brdf(export, &light, fwhm, named(export, file));
    }
    return ok;
}

/* ---- the set --------------------------------------------------------------------------- */

static void add_polarisation(const Panel *panel, json_t *manifest) {
    PanelPolarisation p = panel_polarisation(panel);
    double degree = round((double)p.degree * 1e6) / 1e6;
    if (p.degree > 0)
        json_object_set_new(manifest, "polarisation",
                            json_pack("{s:f, s:f}", "degree", degree, "azimuth_deg",
                                      tidy_degrees((double)p.azimuth)));
}

static void add_zones(const Panel *panel, json_t *manifest) {
    const DimmingZones *zones = panel_zones(panel);
    if (zones) json_object_set_new(manifest, "local_dimming", dimming_keys_json(zones));
}

/* The panel's names, sizes and note, from its report. */
static bool add_names(Export *export, const char *name, json_t *manifest) {
    static const char *const keys[] = {"panel",      "instrument", "date",   "operator",
                                       "conditions", "pixels",     "size_mm"};
    json_t *report = NULL;
    if (!panel_report(export->panel, &report, export->err)) return false;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        json_t *value = json_object_get(report, keys[i]);
        bool has_size = json_number_value(json_array_get(value, 0)) > 0;
        if (json_string_length(value) || has_size) json_object_set(manifest, keys[i], value);
    }
    json_t *note = json_object_get(report, "note");
    json_object_set_new(manifest, "note",
                        json_sprintf("%s%sexported from %s",
                                     json_is_string(note) ? json_string_value(note) : "",
                                     json_is_string(note) && *json_string_value(note) ? "; " : "",
                                     path_name(name)));
    json_decref(report);
    return true;
}

/* ---- places ------------------------------------------------------------------------------ */

static bool is_white_only(const Panel *panel, bool *out, Error *err) {
    json_t *report = NULL;
    if (!panel_report(panel, &report, err)) return false;
    const json_t *emission = json_object_get(report, "emission");
    *out = json_is_true(json_object_get(emission, "white_only")) &&
           !json_is_true(json_object_get(emission, "levels_measured"));
    json_decref(report);
    return true;
}

/* A panel's tables, named in an object of the manifest. */
static bool write_parts(Export *export, bool emits, bool reflects, json_t *to) {
    return (!emits || write_all_emission(export, to)) && (!reflects || write_all_brdf(export, to));
}

/* Moves a key that a spot's tables brought, but that belongs to the whole set. */
static void lift(json_t *spot, const char *key, json_t *manifest) {
    json_t *value = json_object_get(spot, key);
    if (value) json_object_set(manifest, key, value);
    json_object_del(spot, key);
}

/* Was it measured at this spot, or does the file's own panel only serve there? */
static bool is_at_spot(const PanelPlaces *places, int spot, int panel) {
    return panel > 0 || (places->ground.at[spot][0] == places->measured_at[0][0] &&
                         places->ground.at[spot][1] == places->measured_at[0][1]);
}

static bool write_spot(Export *export, const Panel *whole, int spot, json_t *manifest) {
    const PanelPlaces *places = whole->places;
    const float *at = places->ground.at[spot];
    int panel[2] = {places->emission[spot], places->reflection[spot]};
    json_t *list = json_object_get(manifest, "spots");
    json_t *one = json_pack("{s:[f,f]}", "position", round((double)at[0] * 1e7) / 1e7,
                            round((double)at[1] * 1e7) / 1e7);
    bool is_there = false, ok = true;
    for (int k = 0; k < 2 && ok; k++) {
        export->panel = places->panel[panel[k]];
        bool has = k ? panel_reflects(export->panel) : panel_info_emits(export->panel);
        bool is_own = is_at_spot(places, spot, panel[k]) || (k && !is_there);
        if (!has || !is_own) continue;
        is_there = true;
        export->prefix = arena_format(&export->scratch, "spot_%d/", spot + 1);
        ok = is_white_only(export->panel, &export->is_white_only, export->err) &&
             write_parts(export, !k, k, one);
    }
    lift(one, "primaries", manifest);
    lift(one, "instrument_fwhm_deg", manifest);
    json_array_append_new(list, one);
    export->panel = whole;
    export->prefix = "";
    return ok;
}

/* Does the file's own panel serve at a spot where it was not measured? */
static bool serves_elsewhere(const PanelPlaces *places, const uint16_t *panel) {
    for (int i = 0; i < places->spots; i++)
        if (!is_at_spot(places, i, panel[i])) return true;
    return !places->spots;
}

static bool write_map(Export *export, json_t *manifest) {
    const PanelMap *map = export->panel->places->map;
    Arena arena = export->scratch;
    Text text = {.arena = &arena};
    if (!map) return true;
    text_format(&text, "# relative; the first row is the top\ncolumn,row,X,Y,Z%s\n",
                map->has_black ? ",black_X,black_Y,black_Z" : "");
    for (int i = 0; i < map->width * map->height; i++) {
        text_format(&text, "%d,%d", i % map->width, i / map->width);
        for (int k = 0; k < (map->has_black ? 6 : 3); k++)
            text_format(&text, ",%.7g",
                        (double)map->scale[k / 3][k % 3] * (double)map->value[k / 3][k % 3][i]);
        text_add(&text, "\n");
    }
    json_object_set_new(manifest, "uniformity", json_pack("{s:s}", "file", "uniformity.csv"));
    return write_table(export, "uniformity.csv", &text);
}

static bool write_places(Export *export, json_t *manifest) {
    const Panel *panel = export->panel;
    const PanelPlaces *places = panel->places;
    bool emits = panel_info_emits(panel), reflects = panel_reflects(panel), ok;
    ok = write_parts(export, emits && serves_elsewhere(places, places->emission),
                     reflects && serves_elsewhere(places, places->reflection), manifest);
    if (places->spots) json_object_set_new(manifest, "spots", json_array());
    for (int i = 0; i < places->spots && ok; i++) ok = write_spot(export, panel, i, manifest);
    return ok && write_map(export, manifest);
}

/* ---- the whole set ----------------------------------------------------------------------- */

static int count_tables(const Panel *panel) {
    double number[PANEL_INFO_INCIDENCES_MAX], phi[PANEL_INFO_AZIMUTHS_MAX];
    int count = 1 + panel_info_incidences(panel, number) * panel_info_azimuths(panel, phi);
    if (panel_info_emits(panel)) count += 2;
    for (int p = 0; p < 3; p++) count += panel_info_levels(panel, p, number);
    for (int k = 1; panel->places && k < panel->places->panels; k++)
        count += count_tables(panel->places->panel[k]);
    return count;
}

static bool write_set(Export *export, const char *name) {
    json_t *manifest = json_object();
    const Panel *panel = export->panel;
    add_polarisation(panel, manifest);
    add_zones(panel, manifest);
    bool ok = add_names(export, name, manifest) &&
              is_white_only(panel, &export->is_white_only, export->err) &&
              (panel->places ? write_places(export, manifest)
                             : write_parts(export, panel_info_emits(panel), panel_reflects(panel),
                                           manifest)) &&
              set_writer_add_manifest(export->writer, manifest, 9);
    json_decref(manifest);
    progress_update(&export->progress, ++export->done);
    return ok;
}

static bool is_new_or_empty(const char *folder, Error *err) {
    struct stat status;
    int entries = 0;
    DIR *list = opendir(folder);
    if (!list && stat(folder, &status)) return true;
    while (list && readdir(list)) entries++;
    if (list) closedir(list);
    if (list && entries <= 2) return true; /* . and .. */
    return error_at(err, ERROR_OUTPUT, folder, "",
                    "holds something already, required: a new or an empty folder");
}

bool panel_export(const Panel *panel, const char *name, const ExportOptions *options,
                  const char *folder, Error *err) {
    SetWriter writer;
    if (!is_new_or_empty(folder, err)) return false;
    Arena arena = arena_reserve((size_t)16 << 30);
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/') length--;
    const Lines none = {.count = 0}; /* the folder is empty */
    bool ok = set_writer_open(arena_format(&arena, "%.*s/MANIFEST.json", (int)length, folder),
                              &none, &writer, err);
    if (ok) {
        Export export = {
            .panel = panel,
            .prefix = "",
            .options = options,
            .writer = &writer,
            .scratch = arena,
            .err = err,
            .progress = progress_start(options->progress, "export", "tables", count_tables(panel))};
        ok = set_writer_close(&writer, write_set(&export, name));
        progress_end(&export.progress, export.done);
    }
    arena_release(&arena);
    return ok;
}

/* ---- one table ------------------------------------------------------------------------- */

/* Codes of "black", "white 255", "green 31". */
static bool emission_codes(const char *table, double rgb[3]) {
    char word[8] = "";
    double code = 0;
    size_t letters = strspn(table, "abcdefghijklmnopqrstuvwxyz");
    rgb[0] = rgb[1] = rgb[2] = 0;
    if (!strcmp(table, "black")) return true;
    if (letters >= sizeof word || !number_is(table + letters, &code) || !(code >= 0 && code <= 255))
        return false;
    memcpy(word, table, letters);
    for (int p = 0; p < 3; p++)
        if (!strcmp(word, "white") || !strcmp(word, primary_names[p])) rgb[p] = code;
    return rgb[0] + rgb[1] + rgb[2] > 0;
}

/* Behind these words and a number; NULL: something else stands at `text`. */
static const char *take(const char *text, const char *words, double *out) {
    const char *at = text + strlen(words);
    return strncmp(text, words, strlen(words)) ? NULL : number_read(at, out);
}

static const char *behind_degrees(const char *text) {
    return text && !strncmp(text, " deg", 4) ? text + 4 : NULL;
}

/* Light of "brdf 30", "brdf 30 deg", "brdf 30 at 90", "brdf 30 deg, light from 90 deg". */
static bool brdf_light(const char *table, Light *light) {
    *light = (Light){0, 180};
    const char *at = take(table, "brdf ", &light->theta_deg), *behind = behind_degrees(at);
    if (behind) at = behind;
    if (at && *at)
        at = *at == ',' ? behind_degrees(take(at, ", light from ", &light->phi_deg))
                        : take(at, " at ", &light->phi_deg);
    if (!at || *at) return false;
    return light->theta_deg >= 0 && light->theta_deg < 90 && fabs(light->phi_deg) <= 360;
}

bool panel_export_table(const Panel *panel, const char *table, const ExportOptions *options,
                        const char *file, Error *err) {
    double rgb[3];
    Light light;
    Export export = {.panel = panel,
                     .prefix = "",
                     .options = options,
                     .scratch = arena_reserve((size_t)16 << 30),
                     .err = err,
                     .progress = progress_start(options->progress, "export", "tables", 1)};
    bool emits = panel_info_emits(panel), ok;
    if (emits && !strcmp(table, "primaries")) ok = write_spectra(&export, file);
    else if (emits && emission_codes(table, rgb)) ok = write_emission(&export, rgb, file);
    else if (panel_reflects(panel) && brdf_light(table, &light))
        ok = write_brdf(&export, &light, fmax(0, options->mirror_fwhm_deg), file);
    else
        ok = error_set(err, ERROR_USAGE,
                       "--table '%s' is no table of this panel, required: black, white CODE, "
                       "red|green|blue CODE, primaries or brdf DEG [at DEG]",
                       table);
    progress_end(&export.progress, export.done);
    arena_release(&export.scratch);
    return ok;
}
