/* SPDX-License-Identifier: Apache-2.0 */
/* panel export: a panel's tables written back. */
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_level.h"
#include "panel/query/panel_open.h"
#include "panel/set/export.h"
#include "text/json_text.h"

typedef struct ExportRequest {
    ExportOptions options;
    const char *output, *table;
    PanelLevel level;
} ExportRequest;

/* The trees that a table is read from; spectra are in none. */
static bool find_parts(const char *table, PanelLevel *level, Error *err) {
    level->parts = !table                       ? PANEL_COARSE_ALL
                   : !strncmp(table, "brdf", 4) ? PANEL_COARSE_REFLECTION
                                                : PANEL_COARSE_EMISSION;
    if (!level->is_asked || !table || strcmp(table, "primaries") != 0) return true;
    return error_set(err, ERROR_USAGE,
                     "--level is %ld, required: none: the table 'primaries' "
                     "is read from no tree",
                     level->asked);
}

static bool export_from(const char *path, ExportRequest *request, Arena *arena, Error *err) {
    Panel *panel = NULL;
    if (!find_parts(request->table, &request->level, err) ||
        !panel_level_open(path, &request->level, arena, &panel, err))
        return false;
    const char *words = panel_level_words(&request->level, arena);
    const char *name = words ? arena_format(arena, "%s, %s", path, words) : path;
    bool ok = request->table ? panel_export_table(panel, request->table, &request->options,
                                                  request->output, err)
                             : panel_export(panel, name, &request->options, request->output, err);
    panel_close(panel);
    return ok;
}

static const Column DONE[] = {COLUMN_TEXT("output", "output"),
                              COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind DONE_KIND = TABLE_KIND("export", NULL, DONE);

static bool print_done(const ExportRequest *request, const Cli *cli, Error *err) {
    if (cli->quiet && !cli->json) return true;
    json_t *done = json_pack("{s:o}", "output", json_text(request->output));
    panel_level_add(&request->level, done);
    if (!cli_print_answer(&DONE_KIND, done, cli->json, err)) return false;
    if (!cli->json) panel_level_print(&request->level, stdout);
    return true;
}

static Outcome run_export(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    ExportRequest r = {.options = {.mirror_fwhm_deg = -1}};
    const Option options[] = {
        {"-o", OPTION_TEXT, "DIR|TABLE.csv",
         "a new or empty folder for MANIFEST.json and its tables, or one table's file", &r.output,
         .file = OPTION_OUTPUT},
        {"--table", OPTION_TEXT, "NAME",
         "one table: black, white CODE, red CODE, ..., primaries, brdf DEG [at DEG]", &r.table},
        {"--theta-step", OPTION_NUMBER, "DEG",
         "between rings, degrees (default 1, of reflection 0.5)", &r.options.theta_step_deg, 0.05,
         30},
        {"--phi-step", OPTION_NUMBER, "DEG",
         "between azimuths, degrees (default 3, of reflection 1)", &r.options.phi_step_deg, 0.05,
         90},
        PANEL_LEVEL_OPTION(r.level),
        {"--extrapolate", OPTION_FLAG, NULL, "to 90 degrees instead of the measured cone only",
         &r.options.extrapolates},
        {"--mirror-fwhm", OPTION_NUMBER, "DEG",
         "draw the mirror part as an instrument so wide sees it (default 2.4 steps; 0: not)",
         &r.options.mirror_fwhm_deg, 0, 10},
    };
    const CliCommand command = {
        "panel export",
        command_panel_export.summary,
        "X.panel -o DIR | --table NAME -o TABLE.csv",
        "parhelion panel export assets/panels/ips_cluster.panel --table 'red 255' -o red.csv",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers = (const Answer[]){{"", &DONE_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    if (!r.output)
        return error_set(err, ERROR_USAGE,
                         "panel export wants -o DIR (or --table NAME -o TABLE.csv)");
    r.options.progress = cli.progress;
    return outcome_of(export_from(cli.arguments[0], &r, arena, err) && print_done(&r, &cli, err));
}

const Command command_panel_export = {
    "export", "a panel's tables written back, readable by fit: cd/m2, sr^-1, degrees", run_export};
