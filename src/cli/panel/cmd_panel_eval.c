/* SPDX-License-Identifier: Apache-2.0 */
/* panel eval: what a panel emits or reflects in one direction. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_grid.h"
#include "cli/panel/panel_level.h"
#include "cli/panel/panel_question.h"
#include "text/csv_table.h"
#include "panel/fit/fit.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_reflection.h"
#include "panel/query/panel_report.h"

/* The command line of `panel eval`. */
typedef struct EvalRequest {
    PanelQuestion question;
    const char   *batch, *grid;
    bool          has_theta, has_rgb, has_incidence, wants_csv;
    long          level;     /* below 0: all */
    int           layout, quantity; /* indices of the choices; layout: list, matrix */
} EvalRequest;

/* ---- many rows at once ----------------------------------------------------------------- */

static bool fill_question(const CsvTable *csv, int row, Arena *arena, PanelQuestion *q,
                          Error *err)
{
    for (int c = 0; c < csv->columns; c++) {
        double *to = panel_question_member(q, csv->name[c]);
        if (!to)
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "column '%s' is unknown, wanted theta, phi, r, g, b, incidence, "
                            "incidence_phi, wavelength, u or v", csv->name[c]);
        *to = (double)csv->cell[(size_t)row * (size_t)csv->columns + (size_t)c];
    }
    if (panel_question_check(q, err)) return true;
    return error_at(err, ERROR_INPUT, csv->file, csv_table_place(csv, row, arena), "%s",
                    arena_string(arena, err->text, strlen(err->text)));
}

static bool answer_batch(const Panel *panel, const EvalRequest *request, const Cli *cli,
                         Arena *arena, Error *err)
{
    CsvTable       csv;
    PanelQuestion *list;
    if (!csv_table_read(request->batch, arena, &csv, err)) return false;
    list = ARENA_NEW(arena, PanelQuestion, csv.rows);
    for (int i = 0; i < csv.rows; i++) {
        list[i] = request->question;
        if (!fill_question(&csv, i, arena, &list[i], err)) return false;
    }
    json_t *answers = json_array();
    if (request->wants_csv) panel_answer_csv_header(panel, &list[0], stdout);
    for (int i = 0; i < csv.rows; i++) {
        if (request->wants_csv)
            panel_answer_csv(panel, &list[i], stdout);
        else if (cli->json)
            json_array_append_new(answers, panel_answer_json(panel, &list[i]));
        else
            panel_answer_print(panel, &list[i]);
    }
    if (cli->json) return cli_print_json(answers, err);
    json_decref(answers);
    return true;
}

/* ---- one answer ------------------------------------------------------------------------ */

static bool answer_one(const Panel *panel, const EvalRequest *request,
                       const PanelCoarse *coarse, const Cli *cli, Error *err)
{
    const PanelQuestion *q = &request->question;
    if (cli->json) {
        json_t *one = panel_answer_json(panel, q);
        if (coarse->level >= 0) json_object_set_new(one, "level", panel_level_json(coarse));
        return cli_print_json(one, err);
    }
    if (request->wants_csv) {
        panel_answer_csv_header(panel, q, stdout);
        panel_answer_csv(panel, q, stdout);
    } else {
        panel_answer_print(panel, q);
    }
    return true;
}

static bool answer_grid(const Panel *panel, const EvalRequest *request, const Cli *cli,
                        Error *err)
{
    PanelGrid       grid;
    PanelGridFormat format = cli->json ? PANEL_GRID_JSON
                             : request->layout ? PANEL_GRID_MATRIX : PANEL_GRID_LIST;
    return panel_grid_parse(request->grid, &grid, err) &&
           panel_grid_print(panel, &request->question, &grid, format, request->quantity, err);
}

static bool answer(const char *path, const EvalRequest *request, const Cli *cli, Arena *arena,
                   Error *err)
{
    Panel      *panel = NULL;
    PanelCoarse coarse;
    bool        ok;
    if (!panel_level_open(path, request->level, arena, &panel, &coarse, err)) return false;
    if (request->question.is_brdf && !panel_reflects(panel))
        ok = error_at(err, ERROR_INPUT, path, "",
                      "has no reflection data; fit a set with a 'reflection' entry");
    else if (request->grid)
        ok = answer_grid(panel, request, cli, err);
    else if (request->batch)
        ok = answer_batch(panel, request, cli, arena, err);
    else
        ok = answer_one(panel, request, &coarse, cli, err);
    bool is_listed = request->grid || request->batch || request->wants_csv;
    if (ok && !cli->quiet && (is_listed || !cli->json))
        panel_level_print(&coarse, is_listed ? stderr : stdout);
    panel_close(panel);
    return ok;
}

static bool check_request(const EvalRequest *request, const Cli *cli, Error *err)
{
    const PanelQuestion *q = &request->question;
    PanelGrid grid;
    if (request->wants_csv && cli->json)
        return error_set(err, ERROR_USAGE, "--csv and --json exclude each other");
    if (request->batch && request->grid)
        return error_set(err, ERROR_USAGE, "--batch and --grid exclude each other");
    if (request->grid && !panel_grid_parse(request->grid, &grid, err)) return false;
    if (request->batch) return true;
    if (!request->grid && !request->has_theta)
        return error_set(err, ERROR_USAGE, "panel eval wants --theta T (or --grid, --batch)");
    if (!q->is_brdf && !request->has_rgb)
        return error_set(err, ERROR_USAGE, "panel eval wants --rgb R,G,B (or --brdf)");
    if (q->is_brdf && !request->has_incidence)
        return error_set(err, ERROR_USAGE, "panel eval --brdf wants --incidence T");
    if (request->grid && request->layout && q->is_brdf && !(q->wavelength_nm > 0))
        return error_set(err, ERROR_USAGE, "a matrix of --brdf wants --wavelength NM");
    return true;
}

static bool run_eval(int argc, char **argv, Arena *arena, Error *err)
{
    Cli     cli;
    EvalRequest r = {.question = {.rgb = {255, 255, 255}, .incidence_phi = 180,
                                  .at = {NAN, NAN}}, .quantity = 1, .level = -1};
    PanelQuestion *q = &r.question;
    const Option   options[] = {
        {"--theta", OPTION_NUMBER, "DEG", "angle from the normal, degrees", &q->theta, 0, 90, 0,
         &r.has_theta},
        {"--phi", OPTION_NUMBER, "DEG", "azimuth, degrees: 0 right, 90 up (default 0)", &q->phi,
         -360, 360, .given = NULL},
        {"--rgb", OPTION_NUMBERS, "R,G,B", "the pixel's codes, 0 to 255", q->rgb, 0, 255, 3,
         &r.has_rgb},
        {"--brdf", OPTION_FLAG, NULL, "reflection (sr^-1, no cosine) instead of emission",
         &q->is_brdf, .given = NULL},
        {"--incidence", OPTION_NUMBER, "DEG", "angle of the light from the normal, degrees",
         &q->incidence, 0, 90, 0, &r.has_incidence},
        {"--incidence-phi", OPTION_NUMBER, "DEG",
         "azimuth of the light, degrees (default 180: the mirror direction is at phi 0)",
         &q->incidence_phi, -360, 360, .given = NULL},
        {"--at", OPTION_NUMBERS, "U,V",
         "place on the active area, 0 to 1 from its upper left corner, right and down "
         "(default: the panel's own tables)", q->at, 0, 1, 2, .given = NULL},
        {"--wavelength", OPTION_NUMBER, "NM",
         "one wavelength, nm, instead of all measured ones", &q->wavelength_nm, 360, 830,
         .given = NULL},
        {"--grid", OPTION_TEXT, "T0:T1:DT,P0:P1:DP",
         "theta and phi from, to, step, degrees, instead of one direction", &r.grid,
         .given = NULL},
        {"--layout", OPTION_CHOICE, "list|matrix",
         "of a grid: rows theta,phi,values, or theta down and phi across (default list)",
         &r.layout, .given = NULL},
        {"--quantity", OPTION_CHOICE, PANEL_QUANTITIES,
         "in a matrix: X, Y, Z in cd/m2, u' or v' (default Y); brdf in sr^-1 with --brdf",
         &r.quantity, .given = NULL},
        {"--level", OPTION_INTEGER, "N", PANEL_LEVEL_HELP, &r.level, 0, 10, .given = NULL},
        {"--batch", OPTION_TEXT, "FILE.csv",
         "one question a row; columns theta, phi, r, g, b, incidence, ...", &r.batch,
         .given = NULL},
        {"--csv", OPTION_FLAG, NULL,
         "answers as comma-separated rows: XYZ in cd/m2, or sr^-1 a wavelength in nm",
         &r.wants_csv, .given = NULL},
    };
    const CliCommand command = {"panel eval",
        "what a panel emits (cd/m2) or reflects (sr^-1) in one direction, or on a grid",
        "X.panel --theta T --phi P --rgb R,G,B | --brdf --incidence T --theta T --phi P",
        "parhelion panel eval assets/panels/ips_cluster.panel --theta 30 --phi 0 "
        "--rgb 255,255,255", options, COUNT_OF(options), 1, 1};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return false;
    if (cli.help_shown) return true;
    return check_request(&r, &cli, err) &&
           answer(cli.arguments[0], &r, &cli, arena, err);
}

const Command command_panel_eval = {
    "eval", "what a panel emits or reflects in one direction", run_eval};
