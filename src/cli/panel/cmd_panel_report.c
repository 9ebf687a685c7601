/* SPDX-License-Identifier: Apache-2.0 */
/* panel report: what a laboratory states of a panel, as a page to sign, CSV and JSON. */
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/reference.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_level.h"
#include "panel/query/panel_open.h"
#include "plot/report/report.h"
#include "text/json_text.h"

/* The command line of `panel report`. */
typedef struct ReportRequest {
    const char *panel, *measured, *root, *contours, *ambient, *directed;
    ReportOutput output;
    PanelLevel level;
    PlotOptions options;
} ReportRequest;

static bool open_and_write(ReportRequest *request, const Cli *cli, Arena *arena, json_t **answer,
                           Error *err) {
    Panel *panel = NULL;
    Measurement *measured = request->measured ? ARENA_NEW(arena, Measurement, 1) : NULL;
    if (measured &&
        (!measurement_read_below(request->measured, request->root, arena, measured, err) ||
         !outputs_spare(&cli->outputs, measured->inputs.list, measured->inputs.count, err)))
        return false;
    request->level.parts = PANEL_COARSE_ALL;
    if (!panel_level_open(request->panel, &request->level, arena, &panel, err)) return false;
    PlotInput input = {panel, request->panel, measured, panel_level_words(&request->level, arena)};
    bool ok = panel_report_write(&input, &request->options, &request->output, arena, answer, err);
    if (ok) panel_level_add(&request->level, *answer);
    panel_close(panel);
    return ok;
}

static bool check_request(const ReportRequest *request, const Cli *cli, Error *err) {
    const char *page = request->output.page;
    if (!page && !request->output.tables && !cli->json)
        return error_set(err, ERROR_USAGE, "panel report wants -o X.html, --csv DIR or --json");
    if (page && strcmp(path_ending(page), ".html") && strcmp(path_ending(page), ".htm"))
        return error_set(err, ERROR_USAGE, "-o is '%s', required: a name that ends in .html", page);
    return reference_check_root(request->root, err);
}

static bool run(ReportRequest *request, const Cli *cli, Arena *arena, Error *err) {
    json_t *answer = NULL;
    if (!open_and_write(request, cli, arena, &answer, err)) return false;
    if (cli->json) return cli_print_json(answer, err);
    json_decref(answer);
    if (!cli->quiet) panel_level_print(&request->level, stdout);
    return true;
}

/* What --csv writes as report.json. */
static const Column REPORT[] = {
    COLUMN_KEY("panel", "as the manifest states it, as all up to the hash; null: not stated"),
    COLUMN_KEY("instrument", NULL),
    COLUMN_KEY("date", NULL),
    COLUMN_KEY("operator", NULL),
    COLUMN_KEY("conditions", NULL),
    COLUMN_KEY("source", NULL),
    COLUMN_KEY("source_hash_xxh3", NULL),
    COLUMN_KEY("verdict", "null: not stated"),
    COLUMN_KEY("file", "the panel"),
    COLUMN_KEY("emission_to_theta_deg", "null: none"),
    COLUMN_KEY("reflection_to_incidence_deg", "null: none"),
    COLUMN_KEY("tables",
               "each with `name`, `title`, `note`, `missing` (why there is none; or null) "
               "and `rows`, objects of the columns of NAME.csv: numbers, or texts such "
               "as `\"> 60\"`, `\"not measured\"`"),
};
static const TableKind REPORT_KIND = TABLE_KIND("report", NULL, REPORT);

static Outcome run_report(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    ReportRequest request = {0};
    PlotOptions *plot = &request.options;
    double incidence_phi = 180;
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.html", "the page, which prints on A4", &request.output.page,
         .file = OPTION_OUTPUT},
        {"--csv", OPTION_TEXT, "DIR",
         "a folder for every table and the values of every chart as CSV, and report.json",
         &request.output.tables, .file = OPTION_OUTPUT},
        {"--measured", OPTION_TEXT, "MANIFEST.json",
         "the set that the panel was fitted from: its points over the curves", &request.measured},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &request.root},
        {"--contour", OPTION_TEXT, "V[,V...]",
         "lines of luminance (cd/m2) and contrast at these values, with % of that on the axis",
         &request.contours},
        {"--ambient", OPTION_TEXT, "LUX[,LUX...]", AMBIENT_HELP, &request.ambient},
        {"--directed", OPTION_TEXT, "LUX[,DEG]", DIRECTED_HELP, &request.directed},
        {"--incidence-phi", OPTION_NUMBER, "DEG",
         "azimuth of the light for reflection (default 180: from the left)", &incidence_phi, -360,
         360},
        PANEL_LEVEL_OPTION(request.level),
        {"--dark", OPTION_FLAG, NULL, "light lines on a dark ground", &plot->is_dark},
    };
    const CliCommand command = {
        "panel report",
        command_panel_report.summary,
        "X.panel -o X.html [--csv DIR] [--measured MANIFEST.json]",
        "parhelion panel report assets/panels/ips_cluster.panel -o ips.html --csv ips_tables",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers = (const Answer[]){{"", &REPORT_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    request.panel = cli.arguments[0];
    plot->incidence_phi = radians_from_degrees(incidence_phi);
    plot->threads = cli.threads;
    if (!check_request(&request, &cli, err) ||
        (request.contours && !plot_contours_read(request.contours, &plot->contours, err)) ||
        !plot_ambient_read(request.ambient, request.directed, &plot->ambient, err))
        return OUTCOME_FAILED;
    return outcome_of(run(&request, &cli, arena, err));
}

const Command command_panel_report = {
    "report", "a page to sign: viewing angles, colour, gamma, inversion, reflectance, contrast",
    run_report};
