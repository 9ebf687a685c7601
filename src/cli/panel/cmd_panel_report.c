/* SPDX-License-Identifier: Apache-2.0 */
/* panel report: what a laboratory states of a panel, as a page to sign, CSV and JSON. */
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/number.h"
#include "base/reference.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_facts.h"
#include "cli/panel/panel_level.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_report.h"
#include "plot/report/report.h"
#include "text/json_text.h"

/* The command line of `panel report`. */
typedef struct ReportRequest {
    const char *measured, *root, *ambient, *directed;
    ReportSpec spec;
    PanelLevel level;
} ReportRequest;

/* ---- light ------------------------------------------------------------------------------- */

#define LARGEST_LUX 1e7
#define DIRECTED_DEG 45.0

/* Numbers above 0 with commas between, at most so many; how many, 0: *err has the reason. */
static int read_list(const char *option, const char *text, int most, double *out, Error *err) {
    const char *at = text;
    for (int count = 0; count < most;) {
        const char *after = number_read(at, &out[count]);
        if (!after || !(out[count] > 0 && out[count] <= LARGEST_LUX)) {
            error_set(err, ERROR_USAGE,
                      "%s is '%s', required: numbers above 0 and up to 1e7 with commas between",
                      option, text);
            return 0;
        }
        count++;
        if (!*after) return count;
        if (*after != ',') {
            error_set(err, ERROR_USAGE, "%s is '%s': '%s' is no comma and no end", option, text,
                      after);
            return 0;
        }
        at = after + 1;
    }
    error_set(err, ERROR_USAGE, "%s has more than %d values", option, most);
    return 0;
}

/* --directed adds to each of --ambient, or stands alone. */
static bool read_ambient(const ReportRequest *request, Ambient *out, Error *err) {
    double lux[AMBIENT_MAX] = {0}, beam[2] = {0, 0};
    if (request->ambient &&
        !(out->count = read_list("--ambient", request->ambient, AMBIENT_MAX, lux, err)))
        return false;
    if (request->directed && !read_list("--directed", request->directed, 2, beam, err))
        return false;
    if (!(beam[1] > 0)) beam[1] = DIRECTED_DEG;
    if (!(beam[1] < 90))
        return error_set(err, ERROR_USAGE, "--directed is '%s': %g degrees, required: below 90",
                         request->directed, beam[1]);
    if (request->directed && !request->ambient) out->count = 1;
    for (int i = 0; i < out->count; i++)
        out->light[i] = (AmbientLight){lux[i], beam[0], radians_from_degrees(beam[1])};
    return true;
}

/* ---- the command ------------------------------------------------------------------------- */

static bool open_and_write(ReportRequest *request, const Cli *cli, Arena *arena, json_t **answer,
                           Error *err) {
    ReportSpec *spec = &request->spec;
    Panel *panel = NULL;
    json_t *info = NULL;
    Measurement *measured = request->measured ? ARENA_NEW(arena, Measurement, 1) : NULL;
    if (measured &&
        (!measurement_read_below(request->measured, request->root, arena, measured, err) ||
         !outputs_spare(&cli->outputs, measured->inputs.list, measured->inputs.count, err)))
        return false;
    request->level.parts = PANEL_COARSE_ALL;
    if (!panel_level_open(spec->input.file, &request->level, arena, &panel, err)) return false;
    bool ok = panel_report(panel, &info, err) || error_in_file(err, spec->input.file);
    if (ok) {
        panel_facts_add(panel, info);
        spec->info = info;
        spec->input.panel = panel;
        spec->input.measured = measured;
        spec->input.reading = panel_level_words(&request->level, arena);
        ok = panel_report_write(spec, arena, answer, err);
        json_decref(info);
    }
    if (ok) panel_level_add(&request->level, *answer);
    panel_close(panel);
    return ok;
}

static bool check_request(const ReportRequest *request, const Cli *cli, Error *err) {
    const char *page = request->spec.page;
    if (!page && !request->spec.tables && !cli->json)
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
    ReportSpec *spec = &request.spec;
    double incidence_phi = 180;
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.html", "the page, which prints on A4", &spec->page,
         .file = OPTION_OUTPUT},
        {"--csv", OPTION_TEXT, "DIR",
         "a folder for every table and the values of every chart as CSV, and report.json",
         &spec->tables, .file = OPTION_OUTPUT},
        {"--measured", OPTION_TEXT, "MANIFEST.json",
         "the set that the panel was fitted from: its samples beside the curves",
         &request.measured},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &request.root},
        {"--ambient", OPTION_TEXT, "LUX[,LUX...]",
         "contrast also in even diffuse light of this illuminance", &request.ambient},
        {"--directed", OPTION_TEXT, "LUX[,DEG]",
         "to it a directed source: its illuminance on the panel and its angle to the normal "
         "(default 45); alone without --ambient",
         &request.directed},
        {"--incidence-phi", OPTION_NUMBER, "DEG",
         "azimuth of the light for reflection (default 180: from the left)", &incidence_phi, -360,
         360},
        PANEL_LEVEL_OPTION(request.level),
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
    spec->input.file = cli.arguments[0];
    spec->input.incidence_phi = radians_from_degrees(incidence_phi);
    spec->info_kind = &panel_report_kind;
    if (!check_request(&request, &cli, err) || !read_ambient(&request, &spec->ambient, err))
        return OUTCOME_FAILED;
    return outcome_of(run(&request, &cli, arena, err));
}

const Command command_panel_report = {
    "report", "a page to sign: viewing angles, colour, gamma, inversion, reflectance, contrast",
    run_report};
