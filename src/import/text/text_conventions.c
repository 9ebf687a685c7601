/* SPDX-License-Identifier: Apache-2.0 */
#include "import/text/text_conventions.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

static bool contradicts(TextReader *in, int line, const char *stated, const char *option) {
    return error_at(in->err, ERROR_INPUT, in->file,
                    line >= 0 ? text_place(line, in->set->arena) : "header line",
                    "says %s, and %s says otherwise", stated, option);
}

/* ---- azimuths ---------------------------------------------------------------------------- */

static double turned(double degrees) {
    double angle = fmod(degrees, 360);
    return angle < 0 ? angle + 360 : angle;
}

static bool find_azimuths(TextReader *in) {
    const TextOptions *d = in->options;
    const AzimuthWords *stated = &in->metadata.azimuth;
    bool is_behind = stated->has_side ? stated->is_behind : d->seen_from < 0;
    if (stated->has_zero && d->has_azimuth_zero &&
        fabs(turned(stated->zero_deg) - turned(d->azimuth_zero_deg)) > 1e-6)
        return contradicts(in, in->metadata.zero_line, "where azimuth 0 points", "--azimuth-zero");
    if (stated->has_sense && d->azimuth_sense && stated->sense != d->azimuth_sense)
        return contradicts(in, in->metadata.sense_line, "how azimuths run", "--azimuth-sense");
    if (stated->has_side && d->seen_from && stated->is_behind != (d->seen_from < 0))
        return contradicts(in, in->metadata.side_line, "from which side", "--azimuth-seen-from");
    bool knows_zero = stated->has_zero || d->has_azimuth_zero;
    bool knows_sense = stated->has_sense || d->azimuth_sense;
    in->zero_deg = stated->has_zero ? stated->zero_deg : d->azimuth_zero_deg;
    in->sense = stated->has_sense ? stated->sense : d->azimuth_sense < 0 ? -1 : 1;
    if (is_behind) { /* left and right change places */
        in->zero_deg = 180 - in->zero_deg;
        in->sense = -in->sense;
    }
    if (!knows_zero)
        import_note(in->set, "azimuth 0 is taken to point right: neither the files nor "
                             "--azimuth-zero say where");
    if (!knows_sense)
        import_note(in->set, "azimuths are taken to run counter-clockwise: neither the files "
                             "nor --azimuth-sense say how");
    return true;
}

double text_conventions_azimuth(const TextReader *in, double raw) {
    double degrees = in->is_radians ? degrees_from_radians(raw) : raw;
    return turned(in->zero_deg + in->sense * degrees);
}

/* ---- the two angles ---------------------------------------------------------------------- */

static double largest(const TextReader *in, int column) {
    double most = 0;
    size_t width = (size_t)in->raw->rows.width;
    for (size_t i = 0; i < (size_t)in->raw->rows.count; i++)
        most = fmax(most, fabs(in->raw->rows.cell[i * width + (size_t)column]));
    return most;
}

static bool find_angle_unit(TextReader *in, int column) {
    AngleUnit header = in->raw->column[column].name.angle, stated = in->metadata.angle;
    AngleUnit given = in->options->angle_unit;
    AngleUnit file = header != ANGLE_AUTO ? header : stated;
    if (file != ANGLE_AUTO && given != ANGLE_AUTO && file != given)
        return contradicts(in, in->metadata.angle_line, "the unit of its angles", "--angle-unit");
    AngleUnit unit = file != ANGLE_AUTO ? file : given;
    double most = largest(in, column);
    if (unit == ANGLE_AUTO && most > 0 && most <= 1.6)
        return error_at(in->err, ERROR_INPUT, in->file, "",
                        "has angles up to %g: radians, or a cone of so many degrees — say "
                        "--angle-unit rad or deg",
                        most);
    in->is_radians = unit == ANGLE_RADIANS;
    return true;
}

static bool find_angles(TextReader *in) {
    bool is_pair = in->column[QUANTITY_THETA] < 0;
    AnglePair given = in->options->angles;
    int column = in->column[is_pair ? QUANTITY_HORIZONTAL : QUANTITY_THETA];
    if (is_pair && (given == ANGLES_AUTO || given == ANGLES_POLAR))
        return error_at(in->err, ERROR_INPUT, in->file, "header line",
                        "has a horizontal and a vertical angle — say which with --angles "
                        "projected, equidistant, north-polar or east-polar");
    if (!is_pair && given > ANGLES_POLAR)
        return error_at(in->err, ERROR_INPUT, in->file, "header line",
                        "has theta and phi, and --angles declares a horizontal and a vertical "
                        "angle");
    in->angles = is_pair ? given : ANGLES_POLAR;
    return find_angle_unit(in, column);
}

/* Unit vector of two angles in radians, x right and y up as the file means them. */
static void pair_vector(AnglePair pair, double h, double v, double d[3]) {
    switch (pair) {
    case ANGLES_PROJECTED: {
        double x = tan_d(h), y = tan_d(v), length = sqrt(x * x + y * y + 1);
        d[0] = x / length, d[1] = y / length, d[2] = 1 / length;
        return;
    }
    case ANGLES_NORTH_POLAR:
        d[0] = cos_d(v) * sin_d(h), d[1] = sin_d(v), d[2] = cos_d(v) * cos_d(h);
        return;
    case ANGLES_EAST_POLAR:
        d[0] = sin_d(h), d[1] = cos_d(h) * sin_d(v), d[2] = cos_d(h) * cos_d(v);
        return;
    default: {
        double theta = hypot_d(h, v), scale = theta > 0 ? sin_d(theta) / theta : 1;
        d[0] = h * scale, d[1] = v * scale, d[2] = cos_d(theta);
        return;
    }
    }
}

void text_conventions_direction(const TextReader *in, const double raw[2], double *theta_deg,
                                double *phi_deg) {
    double to_degrees = in->is_radians ? 180 / PI : 1;
    if (in->angles == ANGLES_POLAR) {
        double theta = raw[0] * to_degrees;
        *theta_deg = fabs(theta);
        *phi_deg = turned(text_conventions_azimuth(in, raw[1]) + (theta < 0 ? 180 : 0));
        return;
    }
    double d[3], to_radians = in->is_radians ? 1 : PI / 180;
    pair_vector(in->angles, raw[0] * to_radians, raw[1] * to_radians, d);
    if (in->options->seen_from < 0) d[0] = -d[0];
    *theta_deg = degrees_from_radians(atan2_d(hypot_d(d[0], d[1]), d[2]));
    *phi_deg = turned(degrees_from_radians(atan2_d(d[1], d[0])));
}

/* ---- values ------------------------------------------------------------------------------ */

static ValueUnit canonical(ValueUnit unit) {
    return unit == UNIT_NIT ? UNIT_CD_M2 : unit;
}

static bool fits_kind(ValueUnit unit, bool is_reflection) {
    return unit != UNIT_AUTO && (value_unit_cd_m2(unit) == 0) == is_reflection;
}

/* The unit that the columns' names give; they must agree. */
static bool header_unit(TextReader *in, ValueUnit *out) {
    *out = UNIT_AUTO;
    for (int c = 0; c < in->raw->rows.width; c++) {
        ValueUnit unit = canonical(in->raw->column[c].name.unit);
        if (!fits_kind(unit, in->is_reflection)) continue;
        if (*out != UNIT_AUTO && *out != unit)
            return error_at(in->err, ERROR_INPUT, in->file, "header line",
                            "has columns in %s and in %s, required: one unit",
                            value_unit_name(*out), value_unit_name(unit));
        *out = unit;
    }
    return true;
}

static bool find_unit(TextReader *in) {
    ValueUnit header, stated = canonical(in->metadata.unit);
    ValueUnit given = canonical(in->options->unit);
    if (!header_unit(in, &header)) return false;
    if (!fits_kind(stated, in->is_reflection)) stated = UNIT_AUTO;
    if (!fits_kind(given, in->is_reflection)) given = UNIT_AUTO;
    ValueUnit file = header != UNIT_AUTO ? header : stated;
    if (header != UNIT_AUTO && stated != UNIT_AUTO && header != stated)
        return contradicts(in, in->metadata.unit_line, value_unit_name(stated), "the header line");
    /* "brdf" heads values of any scattering unit in practice: there the user has the word */
    bool is_loose = header == UNIT_BRDF && stated == UNIT_AUTO;
    if (file != UNIT_AUTO && given != UNIT_AUTO && file != given && !is_loose)
        return contradicts(in, in->metadata.unit_line, value_unit_name(file), "--unit");
    in->unit = given != UNIT_AUTO ? given : file;
    if (in->unit != UNIT_AUTO) return true;
    in->unit = in->is_reflection ? UNIT_BRDF : UNIT_CD_M2;
    import_note(in->set, "%s are taken in %s: neither the files nor --unit say their unit",
                in->is_reflection ? "reflection values" : "luminances",
                in->is_reflection ? "sr^-1, without the cosine" : "cd/m2");
    return true;
}

bool text_conventions_find(TextReader *in) {
    return find_azimuths(in) && find_angles(in) && find_unit(in);
}
