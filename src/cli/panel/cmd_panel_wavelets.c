/* SPDX-License-Identifier: Apache-2.0 */
/* panel wavelets: one measured table in the paper's basis, with all that the paper says. */
#include <stdio.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "base/reference.h"
#include "print/print.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/panel/panel_commands.h"
#include "panel/set/measurement.h"
#include "panel/wavelets/wavelet_study.h"
#include "plot/panel/wavelet_sheet.h"
#include "text/json_text.h"
#include "text/text.h"

/* ---- the answer: one document, of which text and tables are made ------------------------- */

static json_t *size_row(const WaveletStudy *study, const WaveletSize *size)
{
    json_t *row = json_pack("{s:f, s:i, s:I, s:f, s:f, s:f, s:f, s:f}", "share", size->share,
        "rows", (int)size->rows, "bytes", (json_int_t)size->bytes, "bytes_share",
        (double)size->bytes / (double)study->source_bytes, "leaf_rms", size->leaf_rms,
        "leaf_max", size->leaf_max, "rms", size->errors.rms, "interpolated_rms",
        size->errors.smooth_rms);
    if (study->noise > 0) json_object_set_new(row, "truth_rms", json_real(size->truth_rms));
    return row;
}

static json_t *level_rows(const WaveletStudy *study)
{
    json_t *rows = json_array();
    for (int i = 0; i <= study->level; i++) {
        const WaveletLevel *level = &study->levels[i];
        json_array_append_new(rows, json_pack("{s:i, s:i, s:f, s:f, s:f, s:f, s:f}", "level", i,
            "triangles", (int)level->triangles, "resolution_deg", level->resolution_deg, "rms",
            level->errors.rms, "max", level->errors.max, "interpolated_rms",
            level->errors.smooth_rms, "interpolated_max", level->errors.smooth_max));
    }
    return rows;
}

static json_t *spectrum_rows(const WaveletStudy *study)
{
    json_t *rows = json_array();
    for (int i = 0; i < WAVELET_SPECTRUM_SIZES && study->spectrum.count; i++)
        json_array_append_new(rows, json_pack("{s:f, s:f, s:f, s:f}", "share",
            study->spectrum.share[i], "haar", study->spectrum.rms[0][i], "cdf53",
            study->spectrum.rms[1][i], "cdf97", study->spectrum.rms[2][i]));
    return rows;
}

static json_t *answer_of(const WaveletStudy *study)
{
    uint32_t details = (study->levels[study->level].triangles - 4) / 3;
    json_t  *sizes = json_array(), *queries = json_array();
    for (int i = 0; i < study->size_count; i++)
        json_array_append_new(sizes, size_row(study, &study->sizes[i]));
    for (int i = 0; i <= WAVELET_TIMED_LEVEL; i++)
        json_array_append_new(queries, json_pack("{s:i, s:i, s:f, s:f}", "level", i,
            "triangles", 4 << 2 * i, "mean_ns", study->query_ns[i], "interpolated_ns",
            study->smooth_ns[i]));
    json_t *out = json_pack("{s:o, s:o, s:i, s:i, s:I, s:i, s:i, s:i, s:f, s:o}",
        "file", json_text(study->file), "table", json_text(study->source->name),
        "directions", study->source->rows, "channels", study->source->channels,
        "source_bytes_float32", (json_int_t)study->source_bytes, "level", study->level,
        "triangles", (int)study->levels[study->level].triangles, "fathers", (int)details,
        "mean_difference", study->mean_miss, "kept", size_row(study, &study->kept));
    if (study->noise > 0)
        json_object_set_new(out, "noise_rms", json_real(study->noise_rms));
    json_object_set_new(out, "levels", level_rows(study));
    json_object_set_new(out, "sizes", sizes);
    json_object_set_new(out, "spectrum", spectrum_rows(study));
    json_object_set_new(out, "queries", queries);
    return out;
}

/* ---- text and CSV ------------------------------------------------------------------------ */

static const struct {
    const char *key, *title;
} TABLES[] = {{"levels", "each level beside the samples, as means and interpolated"},
              {"sizes", "size beside error"},
              {"spectrum", "the spectrum's error in three wavelets, by the share kept"},
              {"queries", "time of a query"}};

static void print_table(const json_t *rows)
{
    size_t      i;
    json_t     *row, *value;
    const char *key;
    json_object_foreach(json_array_get(rows, 0), key, value) print("  %16s", key);
    print("\n");
    json_array_foreach(rows, i, row) {
        json_object_foreach(row, key, value) print("  %16.6g", json_number_value(value));
        print("\n");
    }
}

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static void print_answer(const json_t *answer)
{
    const json_t *kept = json_object_get(answer, "kept");
    print("table         %s of %s: %.0f directions x %.0f, %.0f bytes as float32\n",
          json_string_value(json_object_get(answer, "table")),
          json_string_value(json_object_get(answer, "file")), number(answer, "directions"),
          number(answer, "channels"), number(answer, "source_bytes_float32"));
    print("triangles     level %.0f, %.0f = 4 means and 3 details of each of %.0f fathers\n",
          number(answer, "level"), number(answer, "triangles"), number(answer, "fathers"));
    print("kept          %.0f rows, %.3g %% of the source's numbers, %.0f bytes, %.3g %% of "
          "its bytes\n", number(kept, "rows"), 100 * number(kept, "share"),
          number(kept, "bytes"), 100 * number(kept, "bytes_share"));
    print("leaves        rms error %.3g, largest %.3g\n", number(kept, "leaf_rms"),
          number(kept, "leaf_max"));
    print("samples       rms error %.3g, interpolated %.3g\n", number(kept, "rms"),
          number(kept, "interpolated_rms"));
    print("fathers       are the means of their children within %.2g\n",
          number(answer, "mean_difference"));
    if (json_object_get(answer, "noise_rms"))
        print("noise         added with rms %.3g; the kept tree is %.3g from the truth\n",
              number(answer, "noise_rms"), number(kept, "truth_rms"));
    print("Errors are relative to the rms of the table's values.\n");
    for (int i = 0; i < COUNT_OF(TABLES); i++) {
        const json_t *rows = json_object_get(answer, TABLES[i].key);
        if (!json_array_size(rows)) continue;
        print("\n%s\n", TABLES[i].title);
        print_table(rows);
    }
}

static bool write_csv(const json_t *rows, const char *path, Arena *arena, Error *err)
{
    Text        text = {.arena = arena};
    size_t      i;
    json_t     *row, *value;
    const char *key, *comma = "";
    json_object_foreach(json_array_get(rows, 0), key, value) {
        text_format(&text, "%s%s", comma, key);
        comma = ",";
    }
    text_add(&text, "\n");
    json_array_foreach(rows, i, row) {
        comma = "";
        json_object_foreach(row, key, value) {
            text_format(&text, "%s%.9g", comma, json_number_value(value));
            comma = ",";
        }
        text_add(&text, "\n");
    }
    return file_write(path, text.data, text.size, err);
}

/* ---- the command ------------------------------------------------------------------------- */

/* What the folder will hold is no input either. */
static void note_files(const char *folder, Arena *arena, Outputs *outputs)
{
    for (int i = 0; i < COUNT_OF(TABLES); i++)
        outputs_note(outputs, "-o", arena_format(arena, "%s/%s.csv", folder, TABLES[i].key));
    outputs_note(outputs, "-o", arena_format(arena, "%s/levels.png", folder));
    outputs_note(outputs, "-o", arena_format(arena, "%s/curves.png", folder));
}

static bool write_folder(const WaveletStudy *study, const json_t *answer, const char *folder,
                         Arena *arena, Error *err)
{
    PlotBytes levels, curves;
    if (!wavelet_levels_picture(study, arena, &levels, err) ||
        !wavelet_curves_picture(study, arena, &curves, err) || !folder_make(folder, err))
        return false;
    for (int i = 0; i < COUNT_OF(TABLES); i++) {
        const json_t *rows = json_object_get(answer, TABLES[i].key);
        const char   *path = arena_format(arena, "%s/%s.csv", folder, TABLES[i].key);
        if (json_array_size(rows) && !write_csv(rows, path, arena, err)) return false;
    }
    return file_write(arena_format(arena, "%s/levels.png", folder), levels.data, levels.size,
                      err) &&
           file_write(arena_format(arena, "%s/curves.png", folder), curves.data, curves.size,
                      err);
}

typedef struct WaveletWords {
    Cli            cli;
    WaveletOptions options;
    const char    *root, *folder;
    long           level;
    double         noise;
} WaveletWords;

static bool parse(int argc, char **argv, Arena *arena, WaveletWords *out, Error *err)
{
    const Option options[] = {
        {"-o", OPTION_TEXT, "DIR", "folder for levels.png, curves.png and the tables as CSV",
         &out->folder, .file = OPTION_OUTPUT},
        {"--table", OPTION_TEXT, "NAME", "'red 255', 'black', 'brdf 30 deg' (default: the "
         "brightest emission, else reflection)", &out->options.table},
        {"--level", OPTION_INTEGER, "N", "of the smallest triangles (default: as many as "
         "samples)", &out->level, 0, WAVELET_LEVEL_MAX},
        {"--keep", OPTION_NUMBER, "SHARE", "of the table's numbers (default 0.05)",
         &out->options.keep, 1e-5, 1},
        {"--lossless", OPTION_FLAG, NULL, "keep every number, as float32",
         &out->options.is_lossless},
        {"--noise", OPTION_NUMBER, "PERCENT", "of each value, added to the table: errors also "
         "beside the table without it", &out->noise, 0.01, 100},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &out->root},
    };
    const CliCommand command = {"panel wavelets",
        "a measured table in Haar wavelets on triangles: levels, sizes, errors, pictures",
        "MANIFEST.json|TABLE.csv [-o DIR] [options]",
        "parhelion panel wavelets measured/MANIFEST.json --keep 0.02 -o wavelets", options,
        COUNT_OF(options), 1, 1};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (!out->cli.help_shown && out->options.keep > 0 && out->options.is_lossless)
        return error_set(err, ERROR_USAGE, "--keep and --lossless exclude each other");
    out->options.noise = 0.01 * out->noise;
    out->options.level = (int)out->level;
    return true;
}

static Outcome run_wavelets(int argc, char **argv, Arena *arena, Error *err)
{
    WaveletWords words = {.level = -1};
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    Measurement  *set = ARENA_NEW(arena, Measurement, 1);
    WaveletStudy *study = ARENA_NEW(arena, WaveletStudy, 1);
    if (words.folder) note_files(words.folder, arena, &words.cli.outputs);
    if (!reference_check_root(words.root, err) ||
        !measurement_read_below(words.cli.arguments[0], words.root, arena, set, err) ||
        !outputs_spare(&words.cli.outputs, set->inputs.list, set->inputs.count, err) ||
        !wavelet_study(set, &words.options, arena, study, err))
        return OUTCOME_FAILED;
    json_t *answer = answer_of(study);
    bool ok = !words.folder || write_folder(study, answer, words.folder, arena, err);
    if (ok && words.cli.json) return outcome_of(cli_print_json(answer, err));
    if (ok && !words.cli.quiet) print_answer(answer);
    json_decref(answer);
    return outcome_of(ok);
}

const Command command_panel_wavelets = {
    "wavelets", "a measured table in Haar wavelets on triangles", run_wavelets};
