/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/scatter.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"

/* ---- directions -------------------------------------------------------------------------- */

Direction direction_from_degrees(double theta_deg, double phi_deg) {
    double theta = radians_from_degrees(theta_deg), phi = radians_from_degrees(phi_deg);
    return (Direction){sin_d(theta) * cos_d(phi), sin_d(theta) * sin_d(phi), cos_d(theta)};
}

void direction_to_degrees(Direction d, double *theta_deg, double *phi_deg) {
    double across = hypot_d(d.x, d.y);
    double phi = degrees_from_radians(atan2_d(d.y, d.x));
    *theta_deg = degrees_from_radians(atan2_d(across, d.z));
    *phi_deg = across < 1e-12 ? 0 : phi < 0 ? phi + 360 : phi;
}

static Direction cross(Direction a, Direction b) {
    return (Direction){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double direction_dot(Direction a, Direction b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Direction direction_scaled_sum(Direction a, double s, Direction b, double t) {
    return (Direction){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

Direction direction_unit(Direction a) {
    double length = sqrt(direction_dot(a, a));
    return (Direction){a.x / length, a.y / length, a.z / length};
}

Direction direction_about_mirror(double incidence_deg, double radial_deg, double azimuth_deg) {
    double lean = radians_from_degrees(incidence_deg);
    double radial = radians_from_degrees(radial_deg);
    double azimuth = radians_from_degrees(azimuth_deg);
    Direction mirror = {sin_d(lean), 0, cos_d(lean)};
    Direction zero = {-cos_d(lean), 0, sin_d(lean)}; /* towards the normal */
    Direction side = cross(mirror, zero);
    Direction tangent = direction_scaled_sum(zero, cos_d(azimuth), side, sin_d(azimuth));
    return direction_scaled_sum(mirror, cos_d(radial), tangent, sin_d(radial));
}

/* ---- rows -------------------------------------------------------------------------------- */

ImportRows scatter_rows(Arena *arena, int capacity, int channels) {
    return import_rows(arena, capacity, capacity, channels);
}

/* Rounding at the horizon must not lose it. */
#define HORIZON_SLACK_DEG 1e-6

void scatter_put(ImportRows *rows, double theta_deg, double phi_deg, const double *value) {
    if (theta_deg <= 90 + HORIZON_SLACK_DEG)
        import_rows_put(rows, theta_deg > 90 ? 90 : theta_deg, phi_deg, value);
}

void scatter_mask(ImportRows *rows, double theta_deg, double phi_deg) {
    if (theta_deg <= 90 + HORIZON_SLACK_DEG) import_rows_mask(rows, theta_deg, phi_deg);
}

static double whole_turn(double phi_deg) {
    double phi = fmod(phi_deg, 360);
    if (phi < 0) phi += 360;
    return phi >= 360 ? 0 : phi; /* a rounding below 0 */
}

void scatter_put_measured(ImportRows *rows, double theta_deg, double phi_deg, const double *value) {
    bool any = false;
    for (int c = 0; c < rows->channels; c++) any |= value[c] != 0;
    if (any) scatter_put(rows, theta_deg, whole_turn(phi_deg), value);
    else scatter_mask(rows, theta_deg, whole_turn(phi_deg));
}

/* The azimuth means nothing at normal incidence. */
static bool is_turned(const ImportSet *set, double azimuth_deg) {
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source == IMPORT_REFLECTION && table->incidence_deg > 0 &&
            fabs(table->incidence_phi_deg - azimuth_deg) > 1e-6)
            return true;
    }
    return false;
}

/* One azimuth of the light per file is enough for a material that the user calls isotropic. */
static bool is_spared(ImportSet *set, const char *file, ScatterLight light, float nm) {
    for (int i = 0; i < set->count && set->is_isotropic; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source != IMPORT_REFLECTION || strcmp(table->file, file) ||
            fabs(table->incidence_deg - light.incidence_deg) > 1e-6 ||
            fabsf(table->wavelength_nm[0] - nm) > 1e-3f)
            continue;
        import_note(set,
                    "%s: isotropic as declared: of several azimuths of the light the "
                    "first one is taken",
                    path_name(file));
        return true;
    }
    return false;
}

bool scatter_add(ImportSet *set, const char *file, const ImportRows *rows, ScatterLight light,
                 const float *wavelength_nm, Error *err) {
    double azimuth = whole_turn(light.azimuth_deg);
    if (is_spared(set, file, light, wavelength_nm[0])) return true;
    if (light.incidence_deg > 0 && is_turned(set, azimuth)) set->is_anisotropic = true;
    ImportTable table = {.source = IMPORT_REFLECTION,
                         .file = file,
                         .incidence_deg = light.incidence_deg,
                         .incidence_phi_deg = azimuth,
                         .wavelength_nm = wavelength_nm};
    import_rows_give(rows, &table);
    return import_add(set, &table, err);
}

/* ---- wavelengths ------------------------------------------------------------------------- */

const float *scatter_band(double nm, ImportSet *set) {
    float *band = ARENA_NEW(set->arena, float, 1);
    *band = (float)nm;
    return band;
}

const float *scatter_wavelength(const ImportOptions *options, const char *file, ImportSet *set,
                                Error *err) {
    if (options->wavelength_nm > 0) return scatter_band(options->wavelength_nm, set);
    error_at(err, ERROR_INPUT, file, "",
             "does not say the wavelength of its values — give it "
             "as --wavelength NM");
    return NULL;
}

const float *scatter_xyz(const ImportOptions *options, const char *file, ImportSet *set) {
    double nm = options->wavelength_nm > 0 ? options->wavelength_nm : PHOTOPIC_NM;
    if (!(options->wavelength_nm > 0))
        import_note(set,
                    "%s: photopic values (weighted with the eye's sensitivity) stand as one "
                    "band at %g nm",
                    path_name(file), nm);
    import_note(set, "%s: of X, Y and Z only Y is taken", path_name(file));
    return scatter_band(nm, set);
}

const float *scatter_rgb_bands(const char *file, ImportSet *set) {
    static const float band_nm[RGB_BANDS] = {465, 550, 612};
    import_note(set,
                "%s: blue, green and red stand as three bands at %g, %g and %g nm, near "
                "the dominant wavelengths of the primaries of Rec. 709; they are no spectrum",
                path_name(file), (double)band_nm[0], (double)band_nm[1], (double)band_nm[2]);
    return band_nm;
}

/* ---- grids ------------------------------------------------------------------------------- */

#define STEP_RADIAL_DEG 0.5
#define STEP_AZIMUTH_DEG 2.0

typedef struct PolarCell {
    double radial[2], azimuth[2]; /* degrees */
    double value[2][2];           /* [azimuth][radial] */
} PolarCell;

static double integrate_cell(const PolarCell *cell, double axis_deg) {
    double width = cell->radial[1] - cell->radial[0];
    double turn = cell->azimuth[1] - cell->azimuth[0];
    int across = (int)ceil(width / STEP_RADIAL_DEG);
    int around = (int)ceil(turn / STEP_AZIMUTH_DEG);
    double sum = 0;
    for (int j = 0; j < around; j++)
        for (int i = 0; i < across; i++) {
            double u = (i + 0.5) / across, v = (j + 0.5) / around;
            double radial = cell->radial[0] + u * width;
            double value = (1 - v) * ((1 - u) * cell->value[0][0] + u * cell->value[0][1]) +
                           v * ((1 - u) * cell->value[1][0] + u * cell->value[1][1]);
            Direction d = direction_about_mirror(axis_deg, radial, cell->azimuth[0] + v * turn);
            if (d.z > 0) sum += value * d.z * sin_d(radians_from_degrees(radial));
        }
    if (!across || !around) return 0;
    return sum * radians_from_degrees(width / across) * radians_from_degrees(turn / around);
}

double scatter_grid_integral(const ScatterGrid *grid, Arena scratch) {
    int count = grid->azimuths;
    double *azimuth = ARENA_NEW(&scratch, double, count + 1), sum = 0;
    memcpy(azimuth, grid->azimuth_deg, sizeof *azimuth * (size_t)count);
    azimuth[count] = azimuth[0] + 360;
    /* One azimuth serves the whole turn; a turn that is nearly whole is closed. */
    bool closes = !grid->is_half && (count == 1 || azimuth[count] - azimuth[count - 1] <=
                                                       1.5 * (azimuth[1] - azimuth[0]) + 1e-9);
    for (int j = 0; j < count - 1 + closes; j++) {
        const double *low = grid->value + (size_t)j * (size_t)grid->radials;
        const double *high = grid->value + (size_t)((j + 1) % count) * (size_t)grid->radials;
        for (int i = 0; i < grid->radials - 1; i++) {
            PolarCell cell = {{grid->radial_deg[i], grid->radial_deg[i + 1]},
                              {azimuth[j], azimuth[j + 1]},
                              {{low[i], low[i + 1]}, {high[i], high[i + 1]}}};
            sum += integrate_cell(&cell, grid->axis_deg);
        }
    }
    return grid->is_half ? 2 * sum : sum;
}

void totals_add(TotalsNote *note, double incidence_deg, double stated, double integrated) {
    size_t used = strlen(note->text);
    note->count++;
    if (used + 48 > sizeof note->text) {
        if (!strstr(note->text, "...")) strcat(note->text, ", ...");
        return;
    }
    snprintf(note->text + used, sizeof note->text - used, "%s%g deg %.4g (%.4g)", used ? ", " : "",
             incidence_deg, stated, integrated);
}

void totals_report(const TotalsNote *note, const char *file, ImportSet *set) {
    if (note->count)
        import_note(set,
                    "%s: total integrated scatter as stated, and (in brackets) as the "
                    "imported values integrate: %s",
                    path_name(file), note->text);
}

bool angles_check(const char *file, const char *what, const double *list, int count,
                  const double range[2], Error *err) {
    for (int i = 0; i < count; i++) {
        if (!(list[i] >= range[0] && list[i] <= range[1]))
            return error_at(err, ERROR_INPUT, file, "", "%s is %g, required: %g to %g degrees",
                            what, list[i], range[0], range[1]);
        if (i && !(list[i] > list[i - 1]))
            return error_at(err, ERROR_INPUT, file, "",
                            "%s %g follows %g, required: rising "
                            "angles",
                            what, list[i], list[i - 1]);
    }
    return true;
}
