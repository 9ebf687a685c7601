/* SPDX-License-Identifier: Apache-2.0 */
/* panel import: the files of a laboratory as one measurement set. */
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/number.h"
#include "base/reference.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "import/import_request.h"
#include "import/importers.h"
#include "import/set/import_write.h"
#include "panel/set/measured.h"
#include "text/json_text.h"

static void show_progress(void *context, int done) {
    progress_update(context, done);
}

/* Reads every file and makes the set; the bar ends before anything else is printed. */
static bool read_files(const Cli *cli, ImportRequest *request, ImportSet *set, Error *err) {
    Progress progress = progress_start(cli->progress, "import", "files", cli->argument_count);
    request->step = show_progress;
    request->context = &progress;
    bool ok = import_run(cli->arguments, cli->argument_count, request, set, err);
    if (ok) progress_end(&progress, cli->argument_count);
    else progress_clear(&progress);
    return ok;
}

/* ---- the answer -------------------------------------------------------------------------- */

static const Column TABLES[] = {COLUMN_TEXT("file", "table"),
                                COLUMN_TEXT("rows", "directions"),
                                COLUMN_TEXT("values", "values"),
                                COLUMN_TEXT("masked", "masked"),
                                COLUMN_TEXT("from", "from"),
                                COLUMN_KEY("channels", "values of a direction"),
                                COLUMN_KEY("not_measured", "theta, phi of those that are masked")};
static const TableKind TABLES_KIND = TABLE_KIND("tables", NULL, TABLES);
static const Column SUMMARY[] = {
    COLUMN_TEXT("manifest", "manifest"),
    COLUMN_FIXED("rows", "directions", NULL, 0),
    COLUMN_FIXED("masked", "masked", NULL, 0),
    COLUMN_TEXT("notes", "note"),
    {.key = "not_stated", .words = "not stated, for a report", .parts = ""},
    {.key = "tables", .of = &TABLES_KIND}};
static const TableKind SUMMARY_KIND = TABLE_KIND("import", NULL, SUMMARY);

static json_t *table_summary(const ImportSet *set, const ImportTable *table, Arena *arena) {
    json_t *list = json_array();
    for (int i = 0; table->masked_theta_deg && i < table->masked; i++)
        json_array_append_new(
            list, json_pack("[f,f]", table->masked_theta_deg[i], table->masked_phi_deg[i]));
    return json_pack(
        "{s:s, s:o, s:i, s:i, s:I, s:i, s:o}", "file", import_table_file(set, table, arena), "from",
        json_text(table->file), "rows", table->rows, "channels", table->channels, "values",
        (json_int_t)table->rows * table->channels, "masked", table->masked, "not_measured", list);
}

/* What a report of the panel would lack. */
static json_t *unstated(const ImportSet *set) {
    const struct {
        const char *option, *text;
    } words[] = {{"--instrument", set->instrument},
                 {"--date", set->date},
                 {"--operator", set->operator_name},
                 {"--conditions", set->conditions}};
    json_t *list = json_array();
    for (int i = 0; i < COUNT_OF(words); i++)
        if (!words[i].text) json_array_append_new(list, json_string(words[i].option));
    return list;
}

static json_t *summary(const ImportSet *set, const char *manifest, Arena *arena) {
    json_t *tables = json_array();
    double rows = 0, masked = 0;
    for (int i = 0; i < set->count; i++) {
        json_array_append_new(tables, table_summary(set, &set->table[i], arena));
        rows += set->table[i].rows;
        masked += set->table[i].masked;
    }
    return json_pack("{s:o, s:o, s:f, s:f, s:o, s:o}", "manifest", json_text(manifest), "tables",
                     tables, "rows", rows, "masked", masked, "notes",
                     json_texts(set->note, set->note_count), "not_stated", unstated(set));
}

/* ---- options ----------------------------------------------------------------------------- */

#define KEYS_MAX 32
#define OPTIONS_MAX (KEYS_MAX + 32)

/* The command line before it is put on top of the declaration file. */
typedef struct Words {
    const char *output, *layout, *root, *primaries, *levels, *panel, *instrument, *date,
        *operator_name, *conditions, *format, *symmetry;
    const char *specular, *backlight;
    double peaks_nm[3];
    bool has_peaks;
    double aperture_deg, instrument_fwhm_deg;
    CliTexts roles, skip, gloss, list[KEYS_MAX];
    const char *key[KEYS_MAX]; /* of the text tables' keys */
    double wavelength_nm, area_mm[2];
    bool has_area, is_isotropic, black_is_zero, accepts_repeats;
} Words;

/* "azimuth_zero" is the option --azimuth-zero. */
static const char *option_name(const char *key, Arena *arena) {
    char *name = arena_format(arena, "--%s", key);
    for (char *c = name; *c; c++)
        if (*c == '_') *c = '-';
    return name;
}

static bool is_list(const char *key) {
    return !strcmp(key, "comment") || !strcmp(key, "mask") || !strcmp(key, "section");
}

/* Those of the text tables' keys, behind `count` others. */
static int list_keys(Words *words, int count, Option *option, Arena *arena) {
    for (int i = 0; i < text_key_count && i < KEYS_MAX; i++) {
        bool many = is_list(text_keys[i].key);
        option[count++] =
            (Option){option_name(text_keys[i].key, arena), many ? OPTION_TEXTS : OPTION_TEXT,
                     text_keys[i].values, text_keys[i].help,
                     many ? (void *)&words->list[i] : (void *)&words->key[i]};
    }
    return count;
}

static int list_options(Words *words, Option *option, Arena *arena) {
    const Option fixed[] = {
        {"-o", OPTION_TEXT, "MANIFEST.json", "the set to write, with its tables beside it",
         &words->output, .file = OPTION_OUTPUT},
        {"--layout", OPTION_TEXT, "DECLARATION.json",
         "all of the following, written once (keys: src/import/README.md)", &words->layout},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &words->root},
        {"--role", OPTION_TEXTS, "PATTERN=ROLE",
         "what files are: red:255, black, white, "
         "brdf:INCIDENCE[:AZIMUTH[:NM]], skip",
         &words->roles},
        {"--skip", OPTION_TEXTS, "PATTERN", "files to leave out", &words->skip},
        {"--format", OPTION_TEXT, "NAME", "the files' format (default: found from each file)",
         &words->format},
        {"--wavelength", OPTION_NUMBER, "NM", "of reflection files that do not say theirs",
         &words->wavelength_nm, 360, 830},
        {"--primaries", OPTION_TEXT, "FILE", "spectra: columns nm, red, green, blue",
         &words->primaries},
        {"--backlight", OPTION_TEXT, "NAME",
         "of primaries without spectra: wled-ysf, "
         "wled-ksf, oled, qd, rgb-led or laser",
         &words->backlight},
        {"--peaks-nm", OPTION_NUMBERS, "R,G,B", "peak wavelengths of primaries without spectra",
         words->peaks_nm, 380, 780, 3, &words->has_peaks},
        {"--levels", OPTION_TEXT, "FILE.csv",
         "gamma table of white alone: columns level and "
         "luminance (or red, green, blue), cd/m2 on the axis or relative",
         &words->levels},
        {"--specular", OPTION_TEXT, "FILE.csv",
         "specular reflectance: columns incidence, "
         "wavelength and reflectance (0 to 1)",
         &words->specular},
        {"--specular-aperture", OPTION_NUMBER, "DEG",
         "full angle that --specular was measured "
         "in, degrees (default: the mirror alone)",
         &words->aperture_deg, 0, SPECULAR_APERTURE_MOST_DEG},
        {"--instrument-fwhm", OPTION_NUMBER, "DEG", INSTRUMENT_FWHM_HELP,
         &words->instrument_fwhm_deg, INSTRUMENT_FWHM_LEAST, INSTRUMENT_FWHM_MOST},
        {"--gloss", OPTION_TEXTS, "DEG=GU", "a gloss meter's reading at 20, 60 or 85 degrees",
         &words->gloss},
        {"--area-mm", OPTION_NUMBERS, "W,H", "luminous area for luminaire files", words->area_mm,
         1e-3, 1e6, 2, &words->has_area},
        {"--isotropic", OPTION_FLAG, NULL, "the light's azimuth makes no difference",
         &words->is_isotropic},
        {"--symmetry", OPTION_TEXT, "left-right|up-down|both|half-turn",
         "of the sample: fills what was not measured", &words->symmetry},
        {"--no-black", OPTION_FLAG, NULL, "the black pattern was subtracted already",
         &words->black_is_zero},
        {"--accept", OPTION_FLAG, NULL,
         "take the mean of repeated directions or runs also "
         "where they contradict each other",
         &words->accepts_repeats},
        {"--panel", OPTION_TEXT, "NAME", "the panel's name in the manifest", &words->panel},
        {"--instrument", OPTION_TEXT, "NAME", "the instrument's name in the manifest",
         &words->instrument},
        {"--date", OPTION_TEXT, "DATE", "of the measurement, as 2026-03-14, for the report",
         &words->date},
        {"--operator", OPTION_TEXT, "NAME", "who measured", &words->operator_name},
        {"--conditions", OPTION_TEXT, "TEXT", "room, warm-up, drive, for the report",
         &words->conditions},
    };
    memcpy(option, fixed, sizeof fixed);
    return list_keys(words, COUNT_OF(fixed), option, arena);
}

static bool add_roles(const CliTexts *roles, Arena *arena, TextOptions *text, Error *err) {
    double most = text->level_max > 0 ? text->level_max : 255;
    for (int i = 0; i < roles->count; i++) {
        const char *pattern, *role;
        Role parsed;
        if (!cli_name_value("--role", roles->list[i], arena, &pattern, &role, err) ||
            !role_parse(role, most, &parsed, err))
            return false;
        if (text->role_count == TEXT_ENTRIES_MAX)
            return error_set(err, ERROR_USAGE, "--role is given too often");
        text->role[text->role_count++] = (RoleRow){pattern, role};
    }
    return true;
}

static bool add_keys(const Words *words, TextOptions *text, Error *err) {
    for (int i = 0; i < text_key_count; i++) {
        const char *key = text_keys[i].key;
        if (words->key[i] && !text_options_set(text, key, words->key[i], err)) return false;
        for (int k = 0; k < words->list[i].count; k++)
            if (!text_options_set(text, key, words->list[i].list[k], err)) return false;
    }
    return true;
}

/* --gloss 60=82.5 */
static bool add_gloss(const CliTexts *texts, Arena *arena, Gloss *gloss, Error *err) {
    if (texts->count) *gloss = (Gloss){0};
    for (int i = 0; i < texts->count; i++) {
        const char *angle, *value;
        double numbers[2];
        if (!cli_name_value("--gloss", texts->list[i], arena, &angle, &value, err)) return false;
        if (!number_is(angle, &numbers[0]) || !number_is(value, &numbers[1]))
            return error_set(err, ERROR_USAGE,
                             "--gloss is '%s', required: an angle and gloss "
                             "units, as 60=82.5",
                             texts->list[i]);
        if (!specular_gloss_add(gloss, numbers[0], numbers[1], err))
            return error_prefix(err, "--gloss %s", texts->list[i]);
    }
    return true;
}

static bool add_specular(const Words *words, Arena *arena, ImportSpecular *out, Error *err) {
    if (words->specular) out->file = words->specular;
    if (words->aperture_deg > 0) out->aperture_deg = words->aperture_deg;
    return add_gloss(&words->gloss, arena, &out->gloss, err);
}

/* The declaration file first, the command line on top of it. */
static bool make_request(const Words *words, Arena *arena, ImportRequest *request, Error *err) {
    request->root = words->root;
    if (!reference_check_root(words->root, err)) return false;
    if (words->layout && !import_request_read(words->layout, arena, request, err)) return false;
    if (!add_keys(words, &request->text, err) ||
        !add_roles(&words->roles, arena, &request->text, err) ||
        !add_specular(words, arena, &request->specular, err))
        return false;
    for (int i = 0; i < words->skip.count; i++) {
        if (request->skip.count == TEXT_ENTRIES_MAX)
            return error_set(err, ERROR_USAGE, "--skip is given too often");
        request->skip.text[request->skip.count++] = words->skip.list[i];
    }
    if (words->symmetry && !import_symmetry_named(words->symmetry, &request->symmetry, err))
        return false;
    if (words->format) request->options.format = words->format;
    if (words->wavelength_nm > 0) request->options.wavelength_nm = words->wavelength_nm;
    if (words->has_area)
        memcpy(request->options.area_mm, words->area_mm, sizeof request->options.area_mm);
    if (words->primaries) request->primaries = words->primaries;
    if (words->levels) request->levels = words->levels;
    if (words->instrument_fwhm_deg > 0) request->instrument_fwhm_deg = words->instrument_fwhm_deg;
    if (words->backlight) request->backlight = words->backlight;
    if (words->has_peaks) memcpy(request->peaks_nm, words->peaks_nm, sizeof request->peaks_nm);
    if (words->panel) request->panel = words->panel;
    if (words->instrument) request->instrument = words->instrument;
    if (words->date) request->date = words->date;
    if (words->operator_name) request->operator_name = words->operator_name;
    if (words->conditions) request->conditions = words->conditions;
    request->is_isotropic |= words->is_isotropic;
    request->black_is_zero |= words->black_is_zero;
    request->accepts_repeats |= words->accepts_repeats;
    return true;
}

/* ---- the command ------------------------------------------------------------------------- */

static void each_format(HelpRow *row, void *user) {
    for (int i = 0; importers[i]; i++) row(user, importers[i]->name, importers[i]->summary);
}

static bool run(const Cli *cli, const Words *words, Arena *arena, Error *err) {
    ImportRequest *request = ARENA_NEW(arena, ImportRequest, 1);
    ImportSet set = import_set(arena);
    if (words->layout) lines_put(&set.inputs, words->layout);
    if (!make_request(words, arena, request, err) || !read_files(cli, request, &set, err) ||
        !import_write(&set, words->output, err))
        return false;
    return cli_print_answer(&SUMMARY_KIND, summary(&set, words->output, arena), cli->json, err);
}

static Outcome run_import(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    Words *words = ARENA_NEW(arena, Words, 1);
    Option options[OPTIONS_MAX];
    int count = list_options(words, options, arena);
    const CliCommand command = {
        "panel import",
        command_panel_import.summary,
        "FILE... -o MANIFEST.json [options]",
        "parhelion panel import ips_cluster/emission/*.csv ips_cluster/brdf/*.csv "
        "-o again/MANIFEST.json",
        options,
        count,
        1,
        -1,
        "formats",
        each_format,
        .answers = (const Answer[]){{"", &SUMMARY_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    if (!words->output) return error_set(err, ERROR_USAGE, "panel import wants -o MANIFEST.json");
    return outcome_of(run(&cli, words, arena, err));
}

const Command command_panel_import = {
    "import", "the files that laboratories have as one measurement set", run_import};
