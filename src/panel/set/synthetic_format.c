/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/synthetic_format.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/mathd.h"
#include "base/units.h"
#include "record/rows.h"
#include "spectrum/spectral_table.h"

#define DEGREES(key, member, least, most, words) \
    NUMBER(key, RECORD_RADIANS, member, least, most, words)

/* ---- emission ---------------------------------------------------------------------------- */

#define OWNER SyntheticPrimary
#define PEAKS SYNTHETIC_PEAKS_MAX

static const RecordRow PRIMARY[] = {
    NUMBER("luminance_cd_m2", 0, luminance_cd_m2, 1e-3, 1e5,
           "Of this primary at code 255 on the axis."),
    NUMBERS("peaks_nm", MUST, peak_nm, peak_count, PEAKS, 360, 830,
            "Centres of the spectrum's Gaussians, nm."),
    NUMBERS("fwhm_nm", MUST, fwhm_nm, fwhm_count, PEAKS, 2, 400, "Their widths, nm."),
    NUMBERS("weights", MUST, weight, weight_count, PEAKS, 1e-6, 1e6, "Their heights, relative."),
    {"shift", RECORD_NUMBERS, RECORD_AT(OWNER, shift), RECORD_RANGE(-5, 5), .least = 1, .most = 3,
     .doc = "Exponents of X, Y, Z over the square of theta's sine: the colour's "
            "change with the angle."},
    {0}};

/* W_p: the spectrum as the CIE 1931 observer sees it, scaled to the primary's luminance. */
static void find_white_point(SyntheticPrimary *primary) {
    double xyz[3] = {0, 0, 0};
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        double value = synthetic_panel_spectrum(primary, SPECTRAL_FIRST_NM + i);
        xyz[0] += value * (double)spectral_table[i].x;
        xyz[1] += value * (double)spectral_table[i].y;
        xyz[2] += value * (double)spectral_table[i].z;
    }
    for (int j = 0; j < 3; j++) primary->white_xyz[j] = primary->luminance_cd_m2 * xyz[j] / xyz[1];
}

static bool check_primary(const JsonView *view, void *item, Error *err) {
    SyntheticPrimary *p = item;
    if (p->peak_count != p->fwhm_count || p->peak_count != p->weight_count)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "peaks_nm, fwhm_nm and "
                        "weights have %d, %d and %d values, required: equal numbers",
                        p->peak_count, p->fwhm_count, p->weight_count);
    find_white_point(p);
    return true;
}

static const RecordFormat primary_format = {"primary", sizeof(OWNER), PRIMARY,
                                            .check = check_primary};
#undef OWNER
#define OWNER SyntheticEmission

static const RecordRow LOBE[] = {DEGREES("theta_deg", lobe_theta, 0, 90, "Where it points."),
                                 DEGREES("phi_deg", lobe_phi, -360, 360, "Where it points."),
                                 DEGREES("width_deg", lobe_width, 0.5, 90, "Standard deviation."),
                                 NUMBER("gain", 0, lobe_gain, 0, 1000, "Height; 0: none."),
                                 {0}};

static const RecordFormat lobe_format = {"lobe", sizeof(OWNER), LOBE, .doc = NULL};

#define PRIMARY_ROW(key, index) \
    {key, RECORD_OBJECT, MUST, RECORD_AT(OWNER, primary[index]), .of = &primary_format}

static const RecordRow EMISSION[] = {
    PRIMARY_ROW("red", 0),
    PRIMARY_ROW("green", 1),
    PRIMARY_ROW("blue", 2),
    NUMBER("gamma", 0, gamma, 0.3, 5, "Of the grey levels."),
    NUMBER("gamma_drop", 0, gamma_drop, -1, 1,
           "Loss of gamma at an angle, times the square of theta's sine."),
    {"cosine_power", RECORD_NUMBERS, RECORD_AT(OWNER, cosine_power), RECORD_RANGE(0, 20),
     .least = 1, .most = 2, .doc = "How fast luminance falls to the sides, and up and down."},
    NUMBER("black_cd_m2", 0, black_cd_m2, 0, 1000, "Of black on the axis."),
    NUMBER("leak", 0, leak, 0, 1000, "More black at 45 degrees of azimuth."),
    {"lobe", RECORD_OBJECT, .of = &lobe_format, .doc = "A broad extra peak of the emission."},
    NUMBERS("levels", 0, level, level_count, SYNTHETIC_LEVELS_MAX, 1, 255,
            "Codes that are measured, rising."),
    {0}};

static bool check_emission(const JsonView *view, void *item, Error *err) {
    const SyntheticEmission *e = item;
    for (int i = 1; i < e->level_count; i++)
        if (!(e->level[i] > e->level[i - 1]))
            return record_fails(view, "levels", err, "%g follows %g, required: rising levels",
                                e->level[i], e->level[i - 1]);
    return true;
}

static const RecordFormat emission_format = {"emission", sizeof(OWNER), EMISSION,
                                             .check = check_emission};
#undef OWNER

/* ---- reflection -------------------------------------------------------------------------- */

#define OWNER SyntheticReflection

static const RecordRow REFLECTION[] = {
    NUMBER("coating", 0, coating, 0.01, 1,
           "Share of Fresnel's reflectance that the coating leaves."),
    NUMBER("coating_blue", 0, coating_blue, 0, 1, "Its rise towards both ends of the spectrum."),
    NUMBER("haze_share", 0, haze_share, 0, 1, "Share of haze; the rest is mirror."),
    NUMBER("haze_width", 0, haze_width, 1e-3, 1, "In direction cosines."),
    NUMBER("haze_power", 0, haze_power, 1.1, 10, "How steeply haze falls."),
    NUMBER("floor_albedo", 0, lambertian_albedo, 0, 0.5, "Albedo of the lambertian part."),
    NUMBERS("incidence_deg", 0, incidence_deg, incidence_count, SYNTHETIC_INCIDENCES_MAX, 0, 85,
            "Angles of the light, degrees."),
    NUMBERS("wavelengths_nm", 0, wavelength_nm, wavelength_count, SYNTHETIC_WAVELENGTHS_MAX, 360,
            830, "At which it is measured."),
    {0}};

static const RecordFormat reflection_format = {"reflection", sizeof(OWNER), REFLECTION,
                                               .doc = NULL};
#undef OWNER

/* ---- instrument -------------------------------------------------------------------------- */

#define OWNER SyntheticInstrument

static const RecordRow INSTRUMENT[] = {
    NUMBER("theta_max_deg", 0, theta_max_deg, 10, 89.5, "Its cone."),
    NUMBER("theta_step_deg", 0, theta_step_deg, 0.05, 10, "Between rings."),
    NUMBER("phi_step_deg", 0, phi_step_deg, 0.05, 30, "Between azimuths."),
    NUMBER("brdf_theta_step_deg", 0, brdf_theta_step_deg, 0.05, 10,
           "Of reflection; default: as emission."),
    NUMBER("brdf_phi_step_deg", 0, brdf_phi_step_deg, 0.05, 30,
           "Of reflection; default: as emission."),
    NUMBER("fwhm_deg", 0, fwhm_deg, 0.05, 10, "How wide the mirror image of a point looks."),
    NUMBER("noise_relative", 0, noise_relative, 0, 0.5, "Standard deviation, share of the value."),
    NUMBER("noise_cd_m2", 0, noise_cd_m2, 0, 10, "Added to emission."),
    NUMBER("noise_brdf_sr", 0, noise_brdf_sr, 0, 10, "Added to reflection."),
    NUMBER("seed", 0, seed, 0, 4294967295.0, "Of the noise."),
    {0}};

static const RecordFormat instrument_format = {"instrument", sizeof(OWNER), INSTRUMENT,
                                               .doc = NULL};
#undef OWNER

/* ---- places ------------------------------------------------------------------------------ */

#define OWNER SyntheticPlaces
#define SPOTS SYNTHETIC_SPOTS_MAX

static const RecordRow PLACES[] = {
    NUMBERS("u", 0, u, spots, SPOTS, 0, 1,
            "Of the spots that are measured: to the right, from the upper left corner."),
    NUMBERS("v", 0, v, rows, SPOTS, 0, 1, "Down; as many as of u."),
    VECTOR("map", RECORD_WHOLE, map, 2, 1, 2048,
           "Pixels of the uniformity map, width and height; absent: none is made."),
    {"slope", RECORD_NUMBERS, RECORD_AT(OWNER, slope), RECORD_RANGE(-0.9, 0.9), .least = 1,
     .most = 2, .doc = "How the light rises over the width, and over the height downwards."},
    NUMBER("mura", 0, mura, -0.5, 0.5, "Height of the waves in the backlight."),
    {"mura_cycles", RECORD_NUMBERS, RECORD_AT(OWNER, mura_cycles), RECORD_RANGE(0, 100), .least = 1,
     .most = 2, .doc = "How many of them, across and down."},
    NUMBER("tint", 0, tint, -0.5, 0.5, "How X rises and Z falls over the width."),
    NUMBER("clouding", 0, clouding, 0, 100,
           "How much brighter than in the middle black is in the corners."),
    NUMBER("lobe_slope", 0, lobe_slope, -1.9, 1.9,
           "How the lobe's gain rises over the width: the viewing angle by place."),
    NUMBER("haze_slope", 0, haze_slope, -1.9, 1.9,
           "How the share of haze rises over the width, to 1 at most; then spots have a "
           "reflection each."),
    DEGREES("bend_deg", bend, -150, 150,
            "Angle between the normals of the left and the right edge; above 0: concave."),
    {0}};

static bool check_places(const JsonView *view, void *item, Error *err) {
    const SyntheticPlaces *p = item;
    if (p->rows != p->spots)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "u and v have %d and %d "
                        "values, required: equal numbers, one pair a spot",
                        p->spots, p->rows);
    for (int i = 0; i < p->rows; i++)
        for (int k = 0; k < i; k++)
            if (p->u[i] == p->u[k] && p->v[i] == p->v[k])
                return error_at(err, ERROR_INPUT, view->file, view->path,
                                "spots %d and %d are at one place", k, i);
    return p->map[0] > 0 || p->spots ||
           error_at(err, ERROR_INPUT, view->file, view->path,
                    "has neither spots ('u' and 'v') nor a 'map'");
}

static const RecordFormat places_format = {
    "places",
    sizeof(OWNER),
    PLACES,
    .check = check_places,
    .rules = "{'dependentRequired': {'u': ['v'], 'v': ['u']}, "
             "'anyOf': [{'required': ['u']}, {'required': ['map']}]}",
    .doc = "What changes over the active area (x and y: from the middle, -0.5 to 0.5, right "
           "and down), and what is measured of it."};
#undef OWNER

/* ---- the whole --------------------------------------------------------------------------- */

#define OWNER SyntheticPanel

static const RecordRow PANEL[] = {
    TEXT("panel", 0, name, "Name of the panel."),
    TEXT("note", 0, note, "Anything else."),
    VECTOR("pixels", 0, pixels, 2, 1, 65536, "Width and height."),
    VECTOR("size_mm", 0, size_mm, 2, 1, 1e5, "Width and height, mm."),
    NUMBER("refractive_index", 0, refractive_index, 1, 3, "Of the cover."),
    OBJECT("emission", MUST, emission, emission_format, NULL),
    PART("reflection", reflection, reflection.exists, reflection_format, NULL),
    OBJECT("instrument", 0, instrument, instrument_format, NULL),
    OBJECT("places", 0, places, places_format, NULL),
    DISPLAY_TRAITS_ROWS(OWNER, traits),
    {0}};

static void start_emission(SyntheticEmission *emission) {
    static const double levels[] = {31, 63, 95, 127, 159, 191, 223, 255};
    emission->gamma = 2.2;
    emission->cosine_power[0] = emission->cosine_power[1] = 1;
    emission->lobe_theta = radians_from_degrees(40);
    emission->lobe_phi = radians_from_degrees(90);
    emission->lobe_width = radians_from_degrees(10);
    emission->level_count = COUNT_OF(levels);
    for (int i = 0; i < COUNT_OF(levels); i++) emission->level[i] = levels[i];
    for (int p = 0; p < 3; p++) emission->primary[p].luminance_cd_m2 = 100;
}

static void start(void *item) {
    SyntheticPanel *panel = item;
    *panel = (SyntheticPanel){.name = "synthetic panel",
                              .note = "synthetic",
                              .pixels = {1920, 720},
                              .size_mm = {292, 109.5},
                              .refractive_index = 1.5};
    start_emission(&panel->emission);
    SyntheticReflection *r = &panel->reflection;
    *r = (SyntheticReflection){.coating = 1,
                               .haze_width = 0.05,
                               .haze_power = 1.5,
                               .incidence_count = 6,
                               .wavelength_count = 31};
    for (int i = 0; i < 6; i++) r->incidence_deg[i] = 10 * (i + 1);
    for (int i = 0; i < 31; i++) r->wavelength_nm[i] = 400 + 10 * i;
    panel->traits = (DisplayTraits){.zones.compensates = true};
    panel->instrument = (SyntheticInstrument){.theta_max_deg = 88,
                                              .theta_step_deg = 1,
                                              .phi_step_deg = 2,
                                              .brdf_theta_step_deg = NAN,
                                              .brdf_phi_step_deg = NAN,
                                              .fwhm_deg = 2,
                                              .seed = 1};
}

static bool check(const JsonView *view, void *item, Error *err) {
    SyntheticPanel *panel = item;
    SyntheticInstrument *i = &panel->instrument;
    if (isnan(i->brdf_theta_step_deg)) i->brdf_theta_step_deg = i->theta_step_deg;
    if (isnan(i->brdf_phi_step_deg)) i->brdf_phi_step_deg = i->phi_step_deg;
    /* At the edges the haze has the most: no more than all of what is reflected. */
    double most = panel->reflection.haze_share * (1 + 0.5 * fabs(panel->places.haze_slope));
    if (panel->reflection.exists && most > 1)
        return error_at(err, ERROR_INPUT, view->file, "/places/haze_slope",
                        "is %g: at an edge "
                        "haze_share %g would be %g, required: at most 1",
                        panel->places.haze_slope, panel->reflection.haze_share, most);
    return display_traits_check(view, panel->size_mm, &panel->traits, err);
}

const RecordFormat synthetic_format = {
    "recipe",
    sizeof(OWNER),
    PANEL,
    start,
    check,
    .doc = "A panel known in closed form (src/panel/set/synthetic_panel.h has the formulas), "
           "and the virtual instrument of panel simulate."};

bool synthetic_panel_read(const char *file, Arena *arena, SyntheticPanel *out, Error *err) {
    JsonView root;
    SyntheticPanel panel;
    synthetic_format.start(&panel);
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = record_read(&root, &synthetic_format, &panel, err);
    json_view_close(&root);
    panel.file = arena_string(arena, file, strlen(file));
    if (ok) *out = panel;
    return ok;
}
