/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/panel_facts.h"

#include <math.h>
#include <stdbool.h>

#include "print/print.h"
#include "base/count.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "panel/figures/panel_figure.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"
#include "panel/set/dimming_keys.h"
#include "panel/set/display_traits.h"
#include "panel/set/halo_square.h"
#include "spectrum/gamut.h"
#include "plot/report/file_report.h"
#include "plot/report/panel_tables.h"
#include "table/table.h"
#include "text/json_text.h"

static void put(json_t *out, const char *key, double value) {
    json_object_set_new(out, key, json_real(value));
}

/* ---- gamut ------------------------------------------------------------------------------- */

static void add_gamut(const Panel *panel, json_t *out) {
    GamutTriangle srgb = gamut_triangle(GAMUT_SRGB), p3 = gamut_triangle(GAMUT_DCI_P3);
    GamutTriangle own = panel_figure_primaries(panel);
    json_t *list = json_array();
    for (int p = 0; p < 3; p++)
        json_array_append_new(list, json_pack("[f, f]", own.at[p][0], own.at[p][1]));
    json_object_set_new(out, "primaries_xy", list);
    put(out, "srgb_coverage", gamut_coverage(&own, &srgb));
    put(out, "dci_p3_coverage", gamut_coverage(&own, &p3));
}

/* ---- emission ---------------------------------------------------------------------------- */

/* null: one level. */
static json_t *gamma_of(const Panel *panel, int primary) {
    return json_figure(panel_figure_gamma(panel, primary, 0, 0));
}

/* To the right, up, left and down, degrees; null: not within what was measured. */
static json_t *cones(const Panel *panel, const json_t *report, PanelLimit limit) {
    json_t *list = json_array();
    for (int i = 0; i < 4; i++) {
        double angle = report_has_azimuth(report, 2 * i)
                           ? panel_figure_viewing_angle(panel, NULL, limit, i * PI / 2)
                           : NAN;
        json_array_append_new(list, json_figure(round(degrees_from_radians(angle) * 1e4) / 1e4));
    }
    return list;
}

/* Absent: unpolarised, or nobody said. */
static void add_polarisation(const Panel *panel, json_t *out) {
    PanelPolarisation p = panel_polarisation(panel);
    double degree = round((double)p.degree * 1e6) / 1e6;
    double azimuth = round(degrees_from_radians((double)p.azimuth) * 1e4) / 1e4;
    if (p.degree > 0)
        json_object_set_new(out, "polarisation",
                            json_pack("{s:f, s:f}", "degree", degree, "azimuth_deg", azimuth));
}

static const double HALO_MM[] = {10, 20, 40}; /* from the square's middle */

/* Absent: the backlight is one, always full. */
static void add_zones(const Panel *panel, json_t *out) {
    if (!panel_zones(panel)) return;
    Arena arena = arena_reserve((size_t)1 << 32);
    HaloSquare halo = halo_square_make(panel, &arena);
    json_t *zones = dimming_keys_json(panel_zones(panel)), *beside = json_array();
    for (int i = 0; i < COUNT_OF(HALO_MM); i++)
        json_array_append_new(beside,
                              json_pack("{s:f, s:f, s:f}", "mm", HALO_MM[i], "backlight",
                                        halo_square_backlight(&halo, HALO_MM[i]), "black_cd_m2",
                                        halo_square_black(&halo, HALO_MM[i], vec3(0, 0, 1))));
    json_object_set_new(zones, "mean_drive_black", json_real(halo.black_drive));
    json_object_set_new(zones, "halo",
                        json_pack("{s:f, s:f, s:o}", "square_mm", halo.side_mm, "mean_drive",
                                  halo.backlight->mean_drive, "beside", beside));
    json_object_set_new(out, "local_dimming", zones);
    arena_release(&arena);
}

static void add_emission(const Panel *panel, const json_t *report, json_t *out) {
    const json_t *emission = json_object_get(report, "emission");
    bool is_white_only = json_is_true(json_object_get(emission, "white_only"));
    double black = panel_figure_luminance(panel, 0, 0, PANEL_BLACK);
    PanelColour white = panel_figure_colour(panel, 0, 0, PANEL_WHITE);
    put(out, "white_cd_m2", white.xyz[1]);
    json_object_set_new(out, "white_xy", json_pack("[f, f]", white.xy[0], white.xy[1]));
    json_object_set_new(out, "black_cd_m2", black > 0 ? json_real(black) : json_null());
    json_object_set_new(out, "contrast", json_figure(panel_figure_contrast(panel, 0, 0)));
    if (!is_white_only) {
        add_gamut(panel, out);
        json_object_set_new(
            out, "gamma",
            json_pack("[o, o, o]", gamma_of(panel, 0), gamma_of(panel, 1), gamma_of(panel, 2)));
    }
    add_polarisation(panel, out);
    add_zones(panel, out);
    json_object_set_new(out, "half_luminance_deg",
                        cones(panel, report, (PanelLimit){PANEL_LEAST_LUMINANCE, 0.5}));
    if (black > 0 && !is_white_only) /* of which black is measured on the axis alone */
        json_object_set_new(out, "contrast_10_deg",
                            cones(panel, report, (PanelLimit){PANEL_LEAST_CONTRAST, 10}));
}

/* ---- reflection -------------------------------------------------------------------------- */

#define LIGHT_DEG 8.0 /* from the normal: the usual geometry of reflectance (CIE 15: 8:d) */

/* Absent: no peak, the same all round. */
static void add_haze(const Panel *panel, json_t *out) {
    PanelHaze haze = panel_figure_haze(panel, radians_from_degrees(LIGHT_DEG));
    put(out, "haze_peak_sr", haze.peak_sr);
    if (isfinite(haze.fwhm))
        put(out, "haze_fwhm_deg", round(degrees_from_radians(haze.fwhm) * 1e4) / 1e4);
}

static void add_reflection(const Panel *panel, json_t *out) {
    double theta = radians_from_degrees(LIGHT_DEG);
    put(out, "reflectance_incidence_deg", LIGHT_DEG);
    put(out, "mirror_reflectance", panel_figure_mirror(panel, theta, 0));
    put(out, "diffuse_reflectance", panel_figure_diffuse(panel, theta));
    add_haze(panel, out);
}

/* ---- places ------------------------------------------------------------------------------ */

static json_t *evenness_json(const Panel *panel, const float rgb[3]) {
    PanelEvenness e = panel_figure_evenness(panel, rgb);
    json_t *nine = json_array();
    for (int i = 0; i < PANEL_NINE; i++) json_array_append_new(nine, json_real(e.nine[i]));
    return json_pack("{s:o, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "nine_cd_m2", nine,
                     "nine_least", e.nine_least, "nine_most", e.nine_most, "nine_mean", e.nine_mean,
                     "nine_non_uniformity", panel_non_uniformity(e.nine_least, e.nine_most),
                     "least", e.least, "most", e.most, "mean", e.mean, "non_uniformity",
                     panel_non_uniformity(e.least, e.most));
}

static void add_places(const Panel *panel, json_t *out) {
    float place[PANEL_EVENNESS_SPOTS][2];
    int map[2], spots = panel_spots(panel, place, map);
    json_t *list = json_array();
    for (int i = 0; i < spots; i++)
        json_array_append_new(list, json_pack("[f, f]", (double)place[i][0], (double)place[i][1]));
    json_t *places = json_pack("{s:o}", "spots", list);
    if (map[0]) json_object_set_new(places, "map", json_pack("[i, i]", map[0], map[1]));
    if (panel_info_emits(panel)) {
        json_object_set_new(places, "white", evenness_json(panel, PANEL_WHITE));
        if (panel_figure_luminance(panel, 0, 0, PANEL_BLACK) > 0)
            json_object_set_new(places, "black", evenness_json(panel, PANEL_BLACK));
    }
    json_object_set_new(out, "places", places);
}

void panel_facts_add(const Panel *panel, json_t *report) {
    json_t *out = json_object();
    if (panel_varies(panel)) add_places(panel, out);
    if (panel_info_emits(panel)) add_emission(panel, report, out);
    if (panel_reflects(panel)) add_reflection(panel, out);
    json_object_set_new(report, "display", out);
}

/* ---- as text ----------------------------------------------------------------------------- */

#define PARTS_SIDES "right|up|left|down"
#define PARTS_PRIMARIES "red|green|blue"
#define BEYOND "beyond what was measured"

static const Column BESIDE[] = {COLUMN_DIGITS("mm", "from its middle", "mm", 4),
                                COLUMN_DIGITS("black_cd_m2", "black", "cd/m2", 3),
                                COLUMN_KEY("backlight", "over full")};
static const TableKind BESIDE_KIND = TABLE_KIND("halo", "black beside the white square", BESIDE);

static const Column SPOTS[] = {{.key = "position", .words = "spot (right, down)", .places = 4},
                               COLUMN_FIXED("bytes", "bytes", NULL, 0),
                               COLUMN_SHARE("max_error", "largest error"),
                               COLUMN_TEXT("verdict", "verdict"),
                               COLUMN_KEY("emission", "true: has its own"),
                               COLUMN_KEY("reflection", "true: has its own")};
static const TableKind SPOTS_KIND = TABLE_KIND("spots", "spots", SPOTS);

static const Column FLAGS[] = {
    COLUMN_TEXT("table", "table"), COLUMN_DIGITS("theta_deg", "theta", "degrees", 0),
    COLUMN_DIGITS("phi_deg", "phi", "degrees", 0), COLUMN_DIGITS("value", "value", "cd/m2", 5),
    COLUMN_DIGITS("expected", "expected", "cd/m2", 5)};
static const TableKind OUTLIERS_KIND = TABLE_KIND("outliers", "outliers", FLAGS);
static const TableKind HOLES_KIND = {
    .key = "holes", .words = "holes", .columns = FLAGS, .column_count = 3};

#define EVENNESS(pattern) \
    COLUMN_DIGITS("display.places." pattern ".nine_least", pattern ", nine points, least", \
                  "cd/m2", 4), \
        COLUMN_DIGITS("display.places." pattern ".nine_most", pattern ", nine points, most", \
                      "cd/m2", 4), \
        COLUMN_DIGITS("display.places." pattern ".nine_mean", pattern ", nine points, mean", \
                      "cd/m2", 4), \
        COLUMN_SHARE("display.places." pattern ".nine_non_uniformity", \
                     pattern ", non-uniformity"), \
        COLUMN_DIGITS("display.places." pattern ".least", pattern ", anywhere, least", "cd/m2", \
                      4), \
        COLUMN_DIGITS("display.places." pattern ".most", pattern ", anywhere, most", "cd/m2", 4), \
        COLUMN_DIGITS("display.places." pattern ".mean", pattern ", anywhere, mean", "cd/m2", 4)

static const Column INFO[] = {
    COLUMN_TEXT("panel", "panel"),
    COLUMN_TEXT("source", "source"),
    COLUMN_TEXT("instrument", "instrument"),
    {.key = "verdict",
     .words = "verdict",
     .none = "none in this file: fit the set again",
     .about = "`good`, `usable with care`, `not usable`: then `fit` ends with status 1 and writes "
              "no file unless forced"},
    {.key = "reasons", .words = "reason", .about = "sentences, the worst first"},
    COLUMN_DIGITS("display.white_cd_m2", "white", "cd/m2", 4),
    {.key = "display.white_xy", .words = "white, xy", .is_fixed = true, .places = 4},
    {.key = "display.contrast",
     .words = "contrast",
     .unit = ": 1",
     .places = 4,
     .none = "black not measured"},
    {.key = "display.primaries_xy",
     .words = "primaries, xy",
     .is_fixed = true,
     .places = 4,
     .parts = PARTS_PRIMARIES,
     .about = "of the whole pattern, black included"},
    {.key = "display.srgb_coverage",
     .words = "covers of sRGB",
     .unit = "% by area in xy",
     .is_fixed = true,
     .places = 1,
     .times = 100},
    {.key = "display.dci_p3_coverage",
     .words = "covers of DCI-P3",
     .unit = "% by area in xy",
     .is_fixed = true,
     .places = 1,
     .times = 100},
    {.key = "display.gamma",
     .words = "gamma",
     .is_fixed = true,
     .places = 2,
     .parts = PARTS_PRIMARIES,
     .none = "not measured"},
    COLUMN_SHARE("display.polarisation.degree", "polarised"),
    COLUMN_DIGITS("display.polarisation.azimuth_deg", "polarised along", "degrees", 0),
    {.key = "display.local_dimming.zones",
     .words = "zones (across, down)",
     .about = "absent: one backlight, always full, as all of `local_dimming`"},
    COLUMN_DIGITS("display.local_dimming.spread.sigma_mm", "light spread, sigma", "mm", 4),
    COLUMN_DIGITS("display.local_dimming.spread.radius_mm", "light spread, radii", "mm", 4),
    COLUMN_TEXT("display.local_dimming.drive.rule", "zones driven by"),
    COLUMN_SHARE("display.local_dimming.mean_drive_black", "drive of black"),
    COLUMN_TEXT("display.local_dimming.compensates", "pixels keep their light"),
    COLUMN_DIGITS("display.local_dimming.halo.square_mm", "white square on black", "mm", 4),
    COLUMN_SHARE("display.local_dimming.halo.mean_drive", "its mean drive"),
    {.key = "display.half_luminance_deg",
     .words = "half luminance",
     .unit = "degrees",
     .is_fixed = true,
     .places = 2,
     .parts = PARTS_SIDES,
     .none = BEYOND,
     .about = "to the right, up, left, down; each null: likewise, or not along that azimuth"},
    {.key = "display.contrast_10_deg",
     .words = "contrast 10 : 1",
     .unit = "degrees",
     .is_fixed = true,
     .places = 2,
     .parts = PARTS_SIDES,
     .none = BEYOND},
    COLUMN_DIGITS("display.reflectance_incidence_deg", "reflectance, light from", "degrees", 0),
    COLUMN_SHARE("display.mirror_reflectance", "like a mirror"),
    {.key = "display.diffuse_reflectance",
     .words = "diffusely (haze and floor)",
     .unit = "%",
     .places = 4,
     .times = 100},
    COLUMN_DIGITS("display.haze_peak_sr", "haze, mirror direction", "sr^-1", 4),
    {.key = "display.haze_fwhm_deg",
     .words = "haze, width at half",
     .unit = "degrees",
     .places = 3,
     .about = "in the plane of incidence, halfway between peak and what is left 60 degrees "
              "further; absent where there is no peak"},
    COLUMN_TEXT("display.places.map", "uniformity map, pixels"),
    EVENNESS("white"),
    EVENNESS("black"),
    {.key = "emission",
     .words = "emission",
     .about = "of the fit: `tolerance` is the bound required (or chosen), `bound` the one met: the "
              "largest error beside five sigmas of noise; below the share `error_floor` of a "
              "table's largest value errors are relative to it; `azimuths_deg`: those measured, "
              "where they are 8 at most and somewhere more than 45 degrees apart (else absent); "
              "`spectra_assumed`: in words, where the primaries' spectra were not measured"},
    {.key = "reflection", .words = "reflection", .about = "likewise"},
    COLUMN_TEXT("notes", "note"),
    COLUMN_DIGITS("cpu_seconds", "processor time", "s", 3),
    {.key = "peak_memory_bytes",
     .words = "memory, at most",
     .unit = "MB",
     .is_fixed = true,
     .times = 1e-6},
    {.key = "display.local_dimming.halo.beside", .of = &BESIDE_KIND},
    {.key = "spots", .of = &SPOTS_KIND},
    {.key = "outliers", .of = &OUTLIERS_KIND},
    {.key = "holes", .of = &HOLES_KIND},
    COLUMN_KEY(
        "judged",
        "what the verdict was made of. `emission` and `reflection`: `beyond_share`, "
        "`rms_beside_noise`; `emission_between_samples` and `reflection_between_samples` (of "
        "samples without a grid's order): what may be missed between them, `light` as a share "
        "of it and `worst` in a direction; "
        "`reflection_spread`: their noise, relative, rms, of which structure finer than the "
        "samples cannot be told; `coarse`: incidences whose mirror or haze the samples do not "
        "tell, `incidence_deg`, `step_deg`, `mirror` [least, most], maybe `haze_sr` and "
        "`haze_fwhm_deg` the same way"),
    COLUMN_KEY("coarse", "true where a reason begins with \"coarse: \"; else absent"),
    COLUMN_KEY("tables", "each with its sizes and errors; of one whose samples the fit does not "
                         "follow also `outliers` and `outliers_max_error`, which no error counts"),
    COLUMN_KEY("total", "the same of all tables"),
    COLUMN_KEY("basis", "of the trees: `vertex` or `haar`"),
    COLUMN_KEY("file_bytes", "of the file"),
    COLUMN_KEY("date", "as the manifest states it, as the three that follow"),
    COLUMN_KEY("operator", NULL),
    COLUMN_KEY("conditions", NULL),
    COLUMN_KEY("note", NULL),
    COLUMN_KEY("size_mm", "width, height"),
    COLUMN_KEY("pixels", "across, down"),
    COLUMN_KEY("source_hash_xxh3", "of the files that were fitted"),
    COLUMN_KEY("display.black_cd_m2", "along the normal; null: not measured"),
    COLUMN_KEY("display.local_dimming", "the manifest's keys, and what `halo`, a white square on "
                                        "black, does"),
    COLUMN_KEY("display.places",
               "of a panel that is not the same everywhere. `spots`: positions; of "
               "`white` and `black`: `nine_cd_m2`, row by row; non-uniformity is "
               "1 - least / most"),
};
const TableKind panel_report_kind = TABLE_KIND("info", NULL, INFO);

bool panel_print_report(json_t *report, bool as_json, Error *err) {
    if (as_json) return cli_print_json(report, err);
    Arena arena = arena_reserve((size_t)1 << 30);
    Text text = {.arena = &arena};
    table_add_document(&panel_report_kind, report, &text);
    const Table *tables = panel_file_table(report, &arena);
    if (tables) {
        text_add(&text, "\n");
        table_add_text(tables, &text);
    }
    print_own(stdout, text.data);
    arena_release(&arena);
    json_decref(report);
    return true;
}
