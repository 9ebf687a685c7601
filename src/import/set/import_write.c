/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_write.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>

#include "base/count.h"
#include "base/file.h"
#include "base/number.h"
#include "panel/set/level_table.h"
#include "panel/set/set_writer.h"
#include "panel/set/specular_table.h"
#include "text/json_text.h"

typedef struct SetOutput {
    const ImportSet *set;
    SetWriter writer;
    Arena scratch;
} SetOutput;

const char *import_table_file(const ImportSet *set, const ImportTable *table, Arena *arena) {
    const char *name = import_source_name(table->source);
    if (table->source == IMPORT_BLACK || table->source == IMPORT_WHITE)
        return arena_format(arena, "emission/%s.csv", name);
    if (table->source != IMPORT_REFLECTION)
        return arena_format(arena, "emission/%s_%03.10g.csv", name, table->level);
    if (set->is_anisotropic)
        return arena_format(arena, "brdf/i%.10g_a%.10g.csv", table->incidence_deg,
                            table->incidence_phi_deg);
    return arena_format(arena, "brdf/i%.10g.csv", table->incidence_deg);
}

#define LEVELS_FILE "emission/levels.csv"
#define SPECULAR_FILE "brdf/specular.csv"

/* ---- tables ------------------------------------------------------------------------------ */

/* The fewest of 6 to 9 digits that give the same float again. */
static void add_value(Text *text, double value) {
    char shortest[40];
    float wanted = (float)value;
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(shortest, sizeof shortest, "%.*g", digits, (double)wanted);
        float again;
        if (digits == 9 || (number_read_float(shortest, &again) && again == wanted)) break;
    }
    text_format(text, ",%s", shortest);
}

static double wrapped(double phi_deg) {
    double phi = fmod(phi_deg, 360);
    return phi < 0 ? phi + 360 : phi + 0; /* no negative zero */
}

static void add_rows(Text *text, const ImportTable *table) {
    size_t size = (size_t)table->channels;
    for (int i = 0; i < table->rows; i++) {
        text_format(text, "%.9g,%.9g", table->theta_deg[i], wrapped(table->phi_deg[i]));
        for (size_t c = 0; c < size; c++) add_value(text, table->value[(size_t)i * size + c]);
        text_add(text, "\n");
    }
}

static void add_masked(Text *text, const ImportTable *table) {
    if (table->masked)
        text_format(text, "# %d directions are marked as not measured\n", table->masked);
    for (int i = 0; table->masked_theta_deg && i < table->masked; i++)
        text_format(text, "# not measured: theta %.9g phi %.9g\n", table->masked_theta_deg[i],
                    wrapped(table->masked_phi_deg[i]));
}

static bool write_table(SetOutput *out, const ImportTable *table) {
    Arena arena = out->scratch;
    Text text = {.arena = &arena};
    if (table->source == IMPORT_REFLECTION) {
        text_add(&text, "theta,phi");
        for (int c = 0; c < table->channels; c++)
            text_format(&text, ",%.9g", (double)table->wavelength_nm[c]);
        text_add(&text, "\n");
    } else {
        text_add(&text, "theta,phi,X,Y,Z\n");
    }
    text_format(&text, "# from %s\n", path_name(table->file));
    add_masked(&text, table);
    add_rows(&text, table);
    return set_writer_add(&out->writer, import_table_file(out->set, table, &arena), &text);
}

static bool write_spectra(SetOutput *out) {
    const ImportSpectra *spectra = &out->set->spectra;
    Arena arena = out->scratch;
    Text text = {.arena = &arena};
    if (!spectra->rows) return true;
    text_format(&text, "nm,red,green,blue%s\n", spectra->value[3] ? ",black" : "");
    for (int i = 0; i < spectra->rows; i++) {
        text_format(&text, "%.7g", spectra->nm[i]); /* of a float */
        for (int p = 0; p < 4 && spectra->value[p]; p++) add_value(&text, spectra->value[p][i]);
        text_add(&text, "\n");
    }
    return set_writer_add(&out->writer, "primaries.csv", &text);
}

/* What stands beside the tables; `content` lies in the scratch. */
static bool write_text(SetOutput *out, const char *name, const char *content) {
    Text text = {.arena = &out->scratch};
    text_add(&text, content);
    return set_writer_add(&out->writer, name, &text);
}

/* ---- the manifest ------------------------------------------------------------------------ */

static json_t *emission_object(SetOutput *out) {
    json_t *emission = json_object();
    for (int i = 0; i < out->set->count; i++) {
        const ImportTable *table = &out->set->table[i];
        const char *name = import_source_name(table->source);
        json_t *file = json_string(import_table_file(out->set, table, &out->scratch));
        if (table->source == IMPORT_REFLECTION) {
            json_decref(file);
        } else if (table->source == IMPORT_BLACK || table->source == IMPORT_WHITE) {
            json_object_set_new(emission, name, file);
        } else {
            if (!json_object_get(emission, name))
                json_object_set_new(emission, name, json_object());
            json_object_set_new(json_object_get(emission, name),
                                arena_format(&out->scratch, "%.10g", table->level), file);
        }
    }
    if (out->set->levels) json_object_set_new(emission, "levels", json_string(LEVELS_FILE));
    return emission;
}

static json_t *number(double value) {
    return value == floor(value) ? json_integer((json_int_t)value) : json_real(value);
}

static void append_once(json_t *list, double value) {
    size_t i;
    json_t *known;
    json_array_foreach(list, i,
                       known) if (fabs(json_number_value(known) - value) < SAME_ANGLE_DEG) return;
    for (i = 0; i < json_array_size(list); i++)
        if (json_number_value(json_array_get(list, i)) > value) break;
    json_array_insert_new(list, i, number(value));
}

/* The set's specular measurements, which its tables do not hold. */
static void add_specular(const ImportSet *set, json_t *object) {
    json_t *list = json_array();
    for (int i = 0; set->gloss && i < set->gloss->count; i++)
        json_array_append_new(list, json_pack("{s:o, s:o}", "geometry_deg",
                                              number(set->gloss->reading[i].geometry_deg), "gu",
                                              number(set->gloss->reading[i].gu)));
    if (set->gloss) json_object_set(object, "gloss", list);
    json_decref(list);
    if (set->specular)
        json_object_set_new(object, "specular",
                            json_pack("{s:s, s:o}", "file", SPECULAR_FILE, "aperture_deg",
                                      number(set->specular_aperture_deg)));
}

static json_t *reflection_object(const ImportSet *set) {
    json_t *object = NULL, *nm = json_array(), *incidence = json_array(), *azimuth = json_array();
    for (int i = 0; i < set->count; i++) {
        const ImportTable *table = &set->table[i];
        if (table->source != IMPORT_REFLECTION) continue;
        for (int c = 0; c < table->channels && !object; c++)
            json_array_append_new(nm, number(round((double)table->wavelength_nm[c] * 1e4) / 1e4));
        if (!object) object = json_object();
        append_once(incidence, table->incidence_deg);
        append_once(azimuth, table->incidence_phi_deg);
    }
    if (object) {
        json_object_set(object, "wavelengths_nm", nm);
        json_object_set(object, "incidence_deg", incidence);
        if (set->is_anisotropic) json_object_set(object, "incidence_phi_deg", azimuth);
        json_object_set_new(object, "files",
                            json_string(set->is_anisotropic ? "brdf/i{incidence}_a{azimuth}.csv"
                                                            : "brdf/i{incidence}.csv"));
        add_specular(set, object);
    }
    json_decref(nm);
    json_decref(incidence);
    json_decref(azimuth);
    return object;
}

/* The name in the files or of the user; else that of their folder, or of the only file. */
static const char *panel_name(SetOutput *out) {
    const char *file = out->set->table[0].file, *name = path_name(file);
    if (out->set->panel) return out->set->panel;
    if (out->set->count == 1 || name - file < 2) return name;
    char *folder = arena_string(&out->scratch, file, (size_t)(name - file) - 1);
    name = path_name(folder);
    return *name && *name != '.' ? name : path_name(file);
}

static json_t *manifest_object(SetOutput *out) {
    const ImportSet *set = out->set;
    const char *note = "";
    for (int i = 0; i < set->note_count; i++)
        note = arena_format(&out->scratch, "%s%s%s", note, i ? "; " : "", set->note[i]);
    json_t *root = json_object(), *emission = emission_object(out);
    json_object_set_new(root, "panel", json_text(panel_name(out)));
    const struct {
        const char *key, *text;
    } stated[] = {{"instrument", set->instrument},
                  {"date", set->date},
                  {"operator", set->operator_name},
                  {"conditions", set->conditions}};
    for (int i = 0; i < COUNT_OF(stated); i++)
        if (stated[i].text) json_object_set_new(root, stated[i].key, json_text(stated[i].text));
    if (*note) json_object_set_new(root, "note", json_text(note));
    if (json_object_size(emission)) json_object_set(root, "emission", emission);
    json_decref(emission);
    if (set->spectra.rows) json_object_set_new(root, "primaries", json_string("primaries.csv"));
    if (set->instrument_fwhm_deg > 0)
        json_object_set_new(root, "instrument_fwhm_deg", number(set->instrument_fwhm_deg));
    if (set->white_apart[0] > 0 || set->white_apart[1] > 0)
        json_object_set_new(root, "white_apart",
                            json_pack("[f,f]", set->white_apart[0], set->white_apart[1]));
    if (set->backlight) json_object_set_new(root, "backlight", json_text(set->backlight));
    if (set->peaks_nm[0] > 0)
        json_object_set_new(root, "peaks_nm",
                            json_pack("[o,o,o]", number(set->peaks_nm[0]), number(set->peaks_nm[1]),
                                      number(set->peaks_nm[2])));
    json_t *reflection = reflection_object(set);
    if (reflection) json_object_set_new(root, "reflection", reflection);
    return root;
}

static bool write_manifest(SetOutput *out) {
    json_t *root = manifest_object(out);
    bool ok = set_writer_add_manifest(&out->writer, root, 12);
    json_decref(root);
    return ok;
}

bool import_write(const ImportSet *set, const char *manifest, Error *err) {
    SetOutput out = {.set = set};
    if (!set_writer_open(manifest, &set->inputs, &out.writer, err)) return false;
    Arena arena = arena_reserve((size_t)16 << 30);
    out.scratch = arena;
    bool ok = true;
    for (int i = 0; i < set->count && ok; i++) ok = write_table(&out, &set->table[i]);
    ok = ok &&
         (!set->levels ||
          write_text(&out, LEVELS_FILE, level_table_text(set->levels, &out.scratch))) &&
         write_spectra(&out) &&
         (!set->specular ||
          write_text(&out, SPECULAR_FILE, specular_table_text(set->specular, &out.scratch))) &&
         write_manifest(&out);
    ok = set_writer_close(&out.writer, ok);
    arena_release(&arena);
    return ok;
}
