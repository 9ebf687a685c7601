/* SPDX-License-Identifier: Apache-2.0 */
/* Text of any layout: columns or matrices, as the user and the file state. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "import/set/import_rows.h"
#include "import/text/text_conventions.h"

/* ---- the table -------------------------------------------------------------------------- */

/* A text file's rows as tables of the set. */

#define CHANNELS_MAX TEXT_COLUMNS_MAX
#define DIRECTIONS_MIN 3 /* fewer are no angular table */
#define KEYS_MAX 3

/* The rows of one pattern or light: what they share in the columns that identify it. */
typedef struct RowGroup {
    double key[KEYS_MAX];
    int row;
} RowGroup;

typedef struct TextChannels {
    int count;
    int column[CHANNELS_MAX]; /* of reflection, by rising wavelength */
    float nm[CHANNELS_MAX];
    char component;     /* emission of one component */
    Quantity source[3]; /* emission: the three columns to take */
} TextChannels;

static double cell_of(const TextReader *in, int row, int column) {
    return in->raw->rows.cell[(size_t)row * (size_t)in->raw->rows.width + (size_t)column];
}

static const char *row_place(const TextReader *in, int row) {
    return text_place(in->raw->rows.line[row], in->set->arena);
}

/* ---- which channels ---------------------------------------------------------------------- */

static bool has(const TextReader *in, Quantity quantity) {
    return in->column[quantity] >= 0;
}

static bool emission_channels(TextReader *in, TextChannels *out) {
    Quantity luminance = has(in, QUANTITY_Y) ? QUANTITY_Y : QUANTITY_LUMINANCE;
    static const char letters[] = "XYZ";
    const Quantity colours[3][3] = {{QUANTITY_X, QUANTITY_Y, QUANTITY_Z},
                                    {luminance, QUANTITY_CHROMA_X, QUANTITY_CHROMA_Y},
                                    {luminance, QUANTITY_UPRIME, QUANTITY_VPRIME}};
    out->count = 3;
    for (int k = 0; k < 3; k++) {
        const Quantity *colour = colours[k];
        if (!has(in, colour[0]) || !has(in, colour[1]) || !has(in, colour[2])) continue;
        memcpy(out->source, colour, sizeof out->source);
        return true;
    }
    int found = 0;
    for (int q = QUANTITY_X; q <= QUANTITY_VPRIME; q++) found += has(in, (Quantity)q);
    out->count = 1;
    for (int j = 0; j < 3 && found == 1; j++) {
        Quantity alone = (Quantity)(QUANTITY_X + j);
        if (has(in, alone) || (j == 1 && has(in, QUANTITY_LUMINANCE))) {
            out->source[0] = has(in, alone) ? alone : QUANTITY_LUMINANCE;
            out->component = letters[j];
            return true;
        }
    }
    return error_at(in->err, ERROR_INPUT, in->file, "header line",
                    "has not what makes a colour: X, Y, Z; or luminance with x, y or u', v'; "
                    "or luminance alone — name the columns with --columns");
}

static float column_wavelength(const TextReader *in, int column) {
    double nm = in->raw->column[column].name.wavelength_nm;
    if (nm > 0) return (float)nm;
    return (float)(in->role.wavelength_nm > 0 ? in->role.wavelength_nm : in->import->wavelength_nm);
}

static bool reflection_channels(TextReader *in, TextChannels *out) {
    for (int c = 0; c < in->raw->rows.width; c++) {
        if (in->raw->column[c].name.quantity != QUANTITY_REFLECTION) continue;
        float nm = column_wavelength(in, c);
        if (!(nm > 0) && !has(in, QUANTITY_WAVELENGTH))
            return error_at(in->err, ERROR_INPUT, in->file, "header line",
                            "does not say the wavelength of '%s' — say it with --wavelength NM "
                            "or --role FILE=brdf:INCIDENCE:AZIMUTH:NM",
                            in->raw->column[c].text);
        int at = out->count++;
        for (; at > 0 && out->nm[at - 1] > nm; at--) {
            out->nm[at] = out->nm[at - 1];
            out->column[at] = out->column[at - 1];
        }
        out->nm[at] = nm;
        out->column[at] = c;
    }
    return out->count == 1 || !has(in, QUANTITY_WAVELENGTH) ||
           error_at(in->err, ERROR_INPUT, in->file, "header line",
                    "has a column of wavelengths and more than one of reflection");
}

/* ---- values of a row --------------------------------------------------------------------- */

/* Luminance and chromaticity (CIE 15) to X, Y, Z; a row without light may have any. */
static bool xyz_from_chromaticity(const TextReader *in, int row, bool is_uv, double xyz[3]) {
    double luminance = xyz[0], a = xyz[1], b = xyz[2];
    bool is_valid =
        is_uv ? a >= 0 && b > 0 && 12 - 3 * a - 20 * b >= 0 : a >= 0 && b > 0 && a + b <= 1 + 1e-9;
    if (luminance == 0) {
        memset(xyz, 0, 3 * sizeof *xyz);
        return true;
    }
    if (!is_valid)
        return error_at(in->err, ERROR_INPUT, in->file, row_place(in, row),
                        "chromaticity is %g, %g, required: a point of the CIE diagram", a, b);
    xyz[0] = is_uv ? luminance * 9 * a / (4 * b) : luminance * a / b;
    xyz[1] = luminance;
    xyz[2] = is_uv ? luminance * (12 - 3 * a - 20 * b) / (4 * b) : luminance * (1 - a - b) / b;
    return true;
}

/* False: an error. *is_masked: a value is marked as not measured. */
static bool emission_values(const TextReader *in, const TextChannels *channels, int row,
                            double *value, bool *is_masked) {
    double scale = value_unit_cd_m2(in->unit);
    for (int j = 0; j < channels->count; j++) {
        value[j] = cell_of(in, row, in->column[channels->source[j]]);
        *is_masked |= isnan(value[j]);
    }
    if (*is_masked) return true;
    bool is_uv = channels->source[1] == QUANTITY_UPRIME && channels->count == 3;
    bool is_xy = channels->source[1] == QUANTITY_CHROMA_X && channels->count == 3;
    if ((is_uv || is_xy) && !xyz_from_chromaticity(in, row, is_uv, value)) return false;
    for (int j = 0; j < channels->count; j++) value[j] *= scale;
    return true;
}

/* To sr^-1 without the cosine. A cosine-corrected value at the horizon is masked. */
static void reflection_values(const TextReader *in, const TextChannels *channels, int row,
                              double theta_deg, double *value, bool *is_masked) {
    double cosine = cos_d(radians_from_degrees(theta_deg));
    double scale = 1;
    if (in->unit == UNIT_FACTOR)
        scale *= (in->options->white_reflectance > 0 ? in->options->white_reflectance : 1) / PI;
    if (in->unit == UNIT_BRDF_COS) {
        *is_masked |= cosine < 1e-3;
        scale /= cosine < 1e-3 ? 1 : cosine;
    }
    for (int c = 0; c < channels->count; c++) {
        double raw = cell_of(in, row, channels->column[c]);
        value[c] = scale * raw;
        *is_masked |= isnan(raw);
    }
}

/* ---- one table --------------------------------------------------------------------------- */

static bool row_angles(const TextReader *in, int row, double *theta, double *phi) {
    bool is_pair = in->column[QUANTITY_THETA] < 0;
    int a = in->column[is_pair ? QUANTITY_HORIZONTAL : QUANTITY_THETA];
    int b = in->column[is_pair ? QUANTITY_VERTICAL : QUANTITY_PHI];
    double phi_unit = in->is_radians ? PI / 180 : 1; /* --section is always in degrees */
    double raw[2] = {cell_of(in, row, a),
                     in->is_section ? in->section_phi * phi_unit : cell_of(in, row, b)};
    if (isnan(raw[0]) || isnan(raw[1]))
        return error_at(in->err, ERROR_INPUT, in->file, row_place(in, row),
                        "has no angle, required: two numbers");
    text_conventions_direction(in, raw, theta, phi);
    if (!(*theta <= 180 + 1e-6))
        return error_at(in->err, ERROR_INPUT, in->file, row_place(in, row),
                        "theta is %g, required: -90 to 90 degrees", raw[0]);
    if (!(fabs(raw[1]) <= 720))
        return error_at(in->err, ERROR_INPUT, in->file, row_place(in, row),
                        "phi is %g, required: -360 to 360 degrees", raw[1]);
    return true;
}

/* *beyond counts directions beyond 90 degrees. */
static bool fill_row(const TextReader *in, const TextChannels *channels, int row,
                     const ImportTable *light, ImportRows *to, int *beyond) {
    double theta, phi, *value = import_rows_next(to);
    bool is_masked = false;
    if (!row_angles(in, row, &theta, &phi)) return false;
    if (in->is_reflection) phi = fmod(phi + 540 - light->incidence_phi_deg, 360);
    if (theta > 90 + 1e-6) {
        (*beyond)++;
        return true;
    }
    theta = theta > 90 ? 90 : theta;
    if (in->is_reflection) reflection_values(in, channels, row, theta, value, &is_masked);
    else if (!emission_values(in, channels, row, value, &is_masked)) return false;
    if (is_masked) import_rows_mask(to, theta, phi);
    else import_rows_end(to, theta, phi);
    return true;
}

static bool fill_table(TextReader *in, const TextChannels *channels, const RowGroup *group,
                       int count, ImportTable *table) {
    ImportRows to = import_rows(in->set->arena, count, count, channels->count);
    int beyond = 0;
    for (int i = 0; i < count; i++)
        if (!fill_row(in, channels, group[i].row, table, &to, &beyond)) return false;
    import_rows_give(&to, table);
    if (beyond)
        import_note(in->set, "%s: %d of %d directions lie beyond 90 degrees and are left out",
                    path_name(in->file), beyond, count);
    if (table->rows < DIRECTIONS_MIN)
        return error_at(in->err, ERROR_INPUT, in->file, row_place(in, group[0].row),
                        "begins a table of %d measured direction%s, required: an angular "
                        "table of at least %d — leave the file out (--role FILE=skip) if it "
                        "is none",
                        table->rows, table->rows == 1 ? "" : "s", DIRECTIONS_MIN);
    return import_add(in->set, table, in->err);
}

/* ---- groups ------------------------------------------------------------------------------ */

static int by_key(const void *a, const void *b) {
    const RowGroup *p = a, *q = b;
    for (int k = 0; k < KEYS_MAX; k++)
        if (p->key[k] != q->key[k]) return p->key[k] < q->key[k] ? -1 : 1;
    return p->row < q->row ? -1 : p->row > q->row;
}

static RowGroup *group_rows(TextReader *in, const Quantity keys[KEYS_MAX]) {
    RowGroup *group = ARENA_NEW(in->set->arena, RowGroup, in->raw->rows.count);
    bool any = false;
    for (int i = 0; i < in->raw->rows.count; i++) {
        group[i].row = i;
        for (int k = 0; k < KEYS_MAX; k++) {
            int column = in->column[keys[k]];
            if (column < 0) continue;
            any = true;
            group[i].key[k] = cell_of(in, i, column) + 0.0; /* no negative zero */
            if (isnan(group[i].key[k])) {
                error_at(in->err, ERROR_INPUT, in->file, row_place(in, i),
                         "column '%s' holds no number", in->raw->column[column].text);
                return NULL;
            }
        }
    }
    if (any) qsort(group, (size_t)in->raw->rows.count, sizeof *group, by_key);
    return group;
}

static int group_length(const RowGroup *group, int left) {
    int count = 1;
    while (count < left && !memcmp(group[count].key, group->key, sizeof group->key)) count++;
    return count;
}

/* Codes as the panel showed them: one primary, black or white. */
static bool codes_role(TextReader *in, const RowGroup *group, Role *role) {
    double most = text_options_level_max(in->options);
    int lit = 0;
    *role = (Role){.is_known = true, .source = IMPORT_BLACK, .has_level = true};
    for (int p = 0; p < 3; p++)
        if (group->key[p] != 0) {
            lit++;
            role->source = (ImportSource)p;
            role->level = group->key[p];
        }
    bool is_white =
        lit == 3 && group->key[0] == most && group->key[1] == most && group->key[2] == most;
    if (is_white) role->source = IMPORT_WHITE;
    return lit <= 1 || is_white ||
           error_at(in->err, ERROR_INPUT, in->file, row_place(in, group->row),
                    "the codes %g, %g, %g are a mixture, required: one primary at a time, "
                    "black or white — leave the file out (--role FILE=skip) if it is no table "
                    "of one pattern",
                    group->key[0], group->key[1], group->key[2]);
}

static void light_of(const TextReader *in, const RowGroup *group, ImportTable *table) {
    bool has_column = has(in, QUANTITY_INCIDENCE), has_azimuth = has(in, QUANTITY_LIGHT_PHI);
    double incidence =
        has_column ? group->key[0] * (in->is_radians ? 180 / PI : 1) : in->role.incidence_deg;
    double azimuth = 180;
    if (has_azimuth) {
        azimuth = text_conventions_azimuth(in, group->key[1]);
    } else if (in->role.has_azimuth || in->options->has_light_azimuth) {
        double raw = in->role.has_azimuth ? in->role.azimuth_deg : in->options->light_azimuth_deg;
        azimuth = fmod(in->zero_deg + in->sense * raw + 720, 360);
    } else {
        import_note(in->set, "reflection azimuths are taken to count from the mirror "
                             "direction: no azimuth of the light is stated (--light-azimuth)");
    }
    if (incidence < 0) azimuth += 180;
    table->incidence_deg = fabs(incidence);
    table->incidence_phi_deg = fmod(azimuth, 360);
}

static void emission_of(const TextReader *in, const Role *role, const TextChannels *channels,
                        ImportTable *table) {
    double most = text_options_level_max(in->options);
    table->level = role->source == IMPORT_BLACK   ? 0
                   : role->source == IMPORT_WHITE ? 255
                                                  : role->level * 255 / most;
    table->component = channels->component;
}

static bool add_group(TextReader *in, const TextChannels *channels, const RowGroup *group,
                      int count) {
    Role role = in->role;
    TextChannels *own = (TextChannels *)channels;
    ImportTable table = {.file = in->file, .is_section = in->is_section};
    if (has(in, QUANTITY_CODE_R) && !codes_role(in, group, &role)) return false;
    table.source = role.source;
    if (in->is_reflection) {
        light_of(in, group, &table);
        if (has(in, QUANTITY_WAVELENGTH)) {
            own = ARENA_NEW(in->set->arena, TextChannels, 1);
            *own = *channels;
            own->nm[0] = (float)group->key[2];
        }
        table.wavelength_nm = own->nm;
    } else {
        emission_of(in, &role, channels, &table);
    }
    return fill_table(in, own, group, count, &table);
}

/* One table for each pattern or light; the conventions are found already. */
static bool text_table_add(TextReader *in) {
    static const Quantity codes[] = {QUANTITY_CODE_R, QUANTITY_CODE_G, QUANTITY_CODE_B};
    static const Quantity lights[] = {QUANTITY_INCIDENCE, QUANTITY_LIGHT_PHI, QUANTITY_WAVELENGTH};
    TextChannels *channels = ARENA_NEW(in->set->arena, TextChannels, 1);
    bool ok =
        in->is_reflection ? reflection_channels(in, channels) : emission_channels(in, channels);
    RowGroup *group = ok ? group_rows(in, in->is_reflection ? lights : codes) : NULL;
    if (!group) return false;
    for (int i = 0; i < in->raw->rows.count;) {
        int count = group_length(group + i, in->raw->rows.count - i);
        if (!add_group(in, channels, group + i, count)) return false;
        i += count;
    }
    return true;
}

/* ---- what the file is -------------------------------------------------------------------- */

static bool fails_unstated(TextReader *in, bool is_ambiguous) {
    const char *wanted =
        in->is_reflection ? "brdf:INCIDENCE" : "red:255 (or green, blue, black, white)";
    return error_at(in->err, ERROR_INPUT, in->file, "", "%s %s — say it with --role %s=%s",
                    is_ambiguous ? "tells more than one" : "does not tell by its name",
                    in->is_reflection
                        ? is_ambiguous ? "angle of incidence" : "the light's angle of incidence"
                    : is_ambiguous ? "pattern"
                                   : "which pattern it shows",
                    path_name(in->file), wanted);
}

static bool fits_kind(const TextReader *in, const Role *role) {
    return (role->source == IMPORT_REFLECTION) == in->is_reflection;
}

static bool role_from_option(TextReader *in, const char *text) {
    double most = text_options_level_max(in->options);
    if (!role_parse(text, most, &in->role, in->err)) return false;
    if (!fits_kind(in, &in->role))
        return error_at(in->err, ERROR_INPUT, in->file, "", "holds %s, and its role is '%s'",
                        in->is_reflection ? "reflection" : "luminances", text);
    if (in->role.has_incidence && in->column[QUANTITY_INCIDENCE] >= 0)
        return error_at(in->err, ERROR_INPUT, in->file, "",
                        "has the angle of incidence in a column, and its role is '%s'", text);
    bool is_reflection = in->role.source == IMPORT_REFLECTION;
    if (is_reflection && !in->role.has_incidence && in->column[QUANTITY_INCIDENCE] < 0)
        return fails_unstated(in, false);
    return true;
}

/* "R_031" of ".../R_031.csv". */
static const char *name_without_ending(TextReader *in) {
    const char *name = path_name(in->file), *ending = path_ending(in->file);
    size_t length = strlen(name) - strlen(ending);
    return arena_string(in->set->arena, name, length ? length : strlen(name));
}

/* By --role, a column, or the file's name. */
static bool find_role(TextReader *in) {
    bool is_mixed = false;
    const char *text = text_options_role(in->options, in->file);
    if (text) return role_from_option(in, text);
    in->role =
        role_from_words(name_without_ending(in), text_options_level_max(in->options), &is_mixed);
    if (in->role.is_known && !fits_kind(in, &in->role)) in->role = (Role){.is_known = false};
    if (in->column[in->is_reflection ? QUANTITY_INCIDENCE : QUANTITY_CODE_R] >= 0) {
        in->role.source = IMPORT_REFLECTION;
        return true;
    }
    return in->role.is_known || fails_unstated(in, is_mixed);
}

/* ---- columns ----------------------------------------------------------------------------- */

static void index_columns(TextReader *in) {
    for (int q = 0; q < QUANTITY_COUNT; q++) in->column[q] = -1;
    for (int c = in->raw->rows.width - 1; c >= 0; c--)
        in->column[in->raw->column[c].name.quantity] = c;
}

/* A matrix without a label: --quantity names what it holds, or a component in the role. */
static bool name_unlabelled(TextReader *in) {
    int c = in->column[QUANTITY_NONE];
    if (c < 0) return true;
    ColumnName *name = &in->raw->column[c].name;
    const char *given = in->options->quantity, *role = text_options_role(in->options, in->file);
    double most = text_options_level_max(in->options);
    Role named = {.is_known = false};
    if (role && !role_parse(role, most, &named, in->err)) return false;
    if (given) {
        *name = column_name((TextCell){given, (int)strlen(given)});
    } else if (named.is_known && named.source == IMPORT_REFLECTION) {
        name->quantity = QUANTITY_REFLECTION;
    } else if (named.component) {
        name->quantity = (Quantity)(QUANTITY_X + named.component - 'X');
    } else {
        return error_at(in->err, ERROR_INPUT, in->file, "",
                        "does not say what its matrix holds — say --quantity X, Y, Z, L or "
                        "brdf, or the component in the role, as --role %s=red:255:X",
                        path_name(in->file));
    }
    index_columns(in);
    return true;
}

/* Luminance or reflection; both, or codes without all three, are refused. */
static bool find_kind(TextReader *in) {
    bool emission = false;
    for (int q = QUANTITY_X; q <= QUANTITY_VPRIME; q++) emission |= in->column[q] >= 0;
    in->is_reflection = in->column[QUANTITY_REFLECTION] >= 0;
    if (emission == in->is_reflection)
        return error_at(in->err, ERROR_INPUT, in->file, "header line",
                        emission ? "has columns of luminance and of reflection, required: one "
                                   "kind — skip some with --columns"
                                 : "has no column of luminance or reflection — name them with "
                                   "--columns");
    int codes = 0;
    for (int q = QUANTITY_CODE_R; q <= QUANTITY_CODE_B; q++) codes += in->column[q] >= 0;
    if (codes && codes < 3)
        return error_at(in->err, ERROR_INPUT, in->file, "header line",
                        "has %d of the three columns R, G and B", codes);
    in->is_section = in->column[QUANTITY_THETA] >= 0 && in->column[QUANTITY_PHI] < 0;
    if (in->is_section && !text_options_section(in->options, in->file, &in->section_phi))
        return error_at(in->err, ERROR_INPUT, in->file, "header line",
                        "has theta but no azimuth — say the section's azimuth with --section "
                        "%s=DEG",
                        path_name(in->file));
    bool has_polar = in->column[QUANTITY_THETA] >= 0;
    bool has_pair = in->column[QUANTITY_HORIZONTAL] >= 0 && in->column[QUANTITY_VERTICAL] >= 0;
    return has_polar != has_pair || error_at(in->err, ERROR_INPUT, in->file, "header line",
                                             "has %s, required: one pair of angles",
                                             has_polar ? "theta and phi and "
                                                         "also a horizontal and a vertical angle"
                                                       : "no pair of angles");
}

/* ---- the importer ------------------------------------------------------------------------ */

static bool read_text(const char *file, const ImportOptions *options, ImportSet *set, Error *err) {
    static const TextOptions nothing;
    TextReader in = {.file = file,
                     .import = options,
                     .set = set,
                     .err = err,
                     .options = options->text ? options->text : &nothing,
                     .raw = ARENA_NEW(set->arena, NamedRows, 1)};
    if (!text_scan(file, in.options, set->arena, in.raw, &in.metadata, err)) return false;
    index_columns(&in);
    if (!name_unlabelled(&in) || !find_kind(&in) || !find_role(&in) || !text_conventions_find(&in))
        return false;
    if (in.metadata.unused_columns)
        import_note(set, "%s: %d columns with other names are not used", path_name(file),
                    in.metadata.unused_columns);
    return text_table_add(&in);
}

/* Text holds no zero bytes but as half of UTF-16's; DOS ends it with a control-Z. */
static bool is_text(const char *file, const char *head, size_t size) {
    (void)file;
    size_t zeros = 0, odd = 0;
    for (size_t i = 0; i < size; i++) {
        zeros += head[i] == 0;
        odd += head[i] > 0 && head[i] < ' ' && !strchr("\t\r\n\f\x1A", head[i]);
    }
    return odd == 0 && (zeros == 0 || zeros * 5 > size * 2);
}

const Importer importer_text = {"text", "columns and matrices of any layout, as declared", is_text,
                                read_text};
