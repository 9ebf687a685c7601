/* SPDX-License-Identifier: Apache-2.0 */
/* Text of any layout: columns or matrices, as the user and the file state. */
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "import/text/text_table.h"

/* ---- what the file is -------------------------------------------------------------------- */

static bool fails_unstated(TextReader *in, bool is_ambiguous)
{
    const char *wanted =
        in->is_reflection ? "brdf:INCIDENCE" : "red:255 (or green, blue, black, white)";
    return error_at(in->err, ERROR_INPUT, in->file, "",
                    "%s %s — say it with --role %s=%s", is_ambiguous ? "tells more than one"
                    : "does not tell, by its contents or its name,",
                    in->is_reflection ? is_ambiguous ? "angle of incidence"
                                                     : "the light's angle of incidence"
                    : is_ambiguous ? "pattern" : "which pattern it shows",
                    path_name(in->file), wanted);
}

static bool fits_kind(const TextReader *in, const Role *role)
{
    bool is_light = role->source == IMPORT_REFLECTION || role->source == IMPORT_REFERENCE;
    return role->source == IMPORT_DARK || is_light == in->is_reflection;
}

static bool role_from_option(TextReader *in, const char *text)
{
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
static const char *name_without_ending(TextReader *in)
{
    const char *name = path_name(in->file), *ending = path_ending(in->file);
    size_t      length = strlen(name) - strlen(ending);
    return arena_string(in->set->arena, name, length ? length : strlen(name));
}

/* The role of a reflection table whose own text states the incidence. */
static Role stated_light(const TextReader *in)
{
    return (Role){.is_known = in->metadata.has_incidence, .source = IMPORT_REFLECTION,
                  .has_incidence = in->metadata.has_incidence,
                  .incidence_deg = in->metadata.incidence_deg,
                  .wavelength_nm = in->metadata.wavelength_nm};
}

static bool fails_twice(TextReader *in, const Role *stated, const Role *named)
{
    Arena *arena = in->set->arena;
    return error_at(in->err, ERROR_INPUT, in->file, in->metadata.words_line >= 0 ?
                    text_place(in->metadata.words_line, arena) : "",
                    "is %s by its contents and %s by its name — say which with --role %s=...",
                    role_text(stated, arena), role_text(named, arena), path_name(in->file));
}

static bool find_role(TextReader *in)
{
    double most = text_options_level_max(in->options);
    bool   is_mixed[2] = {false, false};
    bool   by_column = in->is_reflection ? in->column[QUANTITY_INCIDENCE] >= 0
                                         : in->column[QUANTITY_CODE_R] >= 0;
    const char *text = text_options_role(in->options, in->file);
    if (text) return role_from_option(in, text);
    Role stated = in->is_reflection ? stated_light(in)
                                  : role_from_words(in->metadata.words, most, &is_mixed[0]);
    Role named = role_from_words(name_without_ending(in), most, &is_mixed[1]);
    if (named.is_known && !fits_kind(in, &named)) named = (Role){.is_known = false};
    in->role = stated.is_known ? stated : named;
    if (by_column) {
        in->role.source = IMPORT_REFLECTION;
        return true;
    }
    if (stated.is_known && named.is_known && !role_agrees(&stated, &named))
        return fails_twice(in, &stated, &named);
    if (stated.is_known && named.is_known) { /* each may know what the other leaves open */
        if (!stated.has_level && named.has_level) in->role.level = named.level;
        if (!stated.component) in->role.component = named.component;
        if (!stated.has_azimuth && named.has_azimuth) {
            in->role.has_azimuth = true;
            in->role.azimuth_deg = named.azimuth_deg;
        }
        if (!(stated.wavelength_nm > 0)) in->role.wavelength_nm = named.wavelength_nm;
    }
    bool is_ambiguous = is_mixed[0] || (!stated.is_known && is_mixed[1]);
    return in->role.is_known || fails_unstated(in, is_ambiguous);
}

/* ---- columns ----------------------------------------------------------------------------- */

static void index_columns(TextReader *in)
{
    for (int q = 0; q < QUANTITY_COUNT; q++) in->column[q] = -1;
    for (int c = in->raw->rows.width - 1; c >= 0; c--)
        in->column[in->raw->column[c].name.quantity] = c;
}

/* A matrix without a label: --quantity names what it holds, or a component in role or name. */
static bool name_unlabelled(TextReader *in)
{
    int c = in->column[QUANTITY_NONE];
    if (c < 0) return true;
    ColumnName *name = &in->raw->column[c].name;
    const char *given = in->options->quantity,
               *role = text_options_role(in->options, in->file);
    double most = text_options_level_max(in->options);
    bool   is_mixed;
    Role   named = role_from_words(name_without_ending(in), most, &is_mixed);
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
static bool find_kind(TextReader *in)
{
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
                        "%s=DEG", path_name(in->file));
    bool has_polar = in->column[QUANTITY_THETA] >= 0;
    bool has_pair = in->column[QUANTITY_HORIZONTAL] >= 0 && in->column[QUANTITY_VERTICAL] >= 0;
    return has_polar != has_pair ||
           error_at(in->err, ERROR_INPUT, in->file, "header line",
                    "has %s, required: one pair of angles", has_polar ? "theta and phi and "
                    "also a horizontal and a vertical angle" : "no pair of angles");
}

static bool check_wavelength(TextReader *in)
{
    double given = in->import->wavelength_nm, stated = in->metadata.wavelength_nm;
    if (given > 0 && stated > 0 && fabs(given - stated) > 1e-3)
        return error_at(in->err, ERROR_INPUT, in->file, "",
                        "says a wavelength of %g nm, and --wavelength says %g", stated, given);
    return true;
}

/* ---- the importer ------------------------------------------------------------------------ */

static void note_names(TextReader *in)
{
    if (!in->set->panel) in->set->panel = in->metadata.panel;
    if (!in->set->instrument) in->set->instrument = in->metadata.instrument;
    if (!in->set->date) in->set->date = in->metadata.date;
    if (!in->set->operator_name) in->set->operator_name = in->metadata.operator_name;
    if (in->metadata.unused_columns)
        import_note(in->set, "%s: %d columns with other names are not used",
                    path_name(in->file), in->metadata.unused_columns);
}

static bool read_text(const char *file, const ImportOptions *options, ImportSet *set,
                      Error *err)
{
    static const TextOptions nothing;
    TextReader in = {.file = file, .import = options, .set = set, .err = err,
                     .options = options->text ? options->text : &nothing,
                     .raw = ARENA_NEW(set->arena, NamedRows, 1)};
    if (!text_scan(file, in.options, set->arena, in.raw, &in.metadata, err)) return false;
    index_columns(&in);
    if (!name_unlabelled(&in) || !find_kind(&in) || !check_wavelength(&in) ||
        !find_role(&in) || !text_conventions_find(&in))
        return false;
    note_names(&in);
    return text_table_add(&in);
}

/* Text holds no zero bytes but as half of UTF-16's; DOS ends it with a control-Z. */
static bool is_text(const char *file, const char *head, size_t size)
{
    (void)file;
    size_t zeros = 0, odd = 0;
    for (size_t i = 0; i < size; i++) {
        zeros += head[i] == 0;
        odd += head[i] > 0 && head[i] < ' ' && !strchr("\t\r\n\f\x1A", head[i]);
    }
    return odd == 0 && (zeros == 0 || zeros * 5 > size * 2);
}

const Importer importer_text = {"text", "columns and matrices of any layout, as declared",
                              is_text, read_text};
