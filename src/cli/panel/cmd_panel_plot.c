/* SPDX-License-Identifier: Apache-2.0 */
/* panel plot: pictures of a panel. */

#include "base/count.h"
#include "base/reference.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_level.h"
#include "panel/query/panel_open.h"
#include "plot/panel/plot.h"
#include "text/json_text.h"

/* The command line of `panel plot`. */
typedef struct PlotRequest {
    const char *panel, *measured, *root, *picture;
    int kind;
    double incidence_phi; /* degrees */
    PanelLevel level;
} PlotRequest;

static bool open_and_draw(PlotRequest *request, const Cli *cli, Arena *arena, int *figures,
                          Error *err) {
    Panel *panel = NULL;
    Measurement *measured = request->measured ? ARENA_NEW(arena, Measurement, 1) : NULL;
    if (measured &&
        (!measurement_read_below(request->measured, request->root, arena, measured, err) ||
         !outputs_spare(&cli->outputs, measured->inputs.list, measured->inputs.count, err)))
        return false;
    request->level.parts = PANEL_COARSE_ALL;
    if (!panel_level_open(request->panel, &request->level, arena, &panel, err)) return false;
    PlotInput input = {panel, request->panel, measured, panel_level_words(&request->level, arena),
                       radians_from_degrees(request->incidence_phi)};
    bool ok = plot_write(&input, (PlotKind)request->kind, request->picture, arena, figures, err);
    panel_close(panel);
    return ok;
}

static bool run(PlotRequest *request, const Cli *cli, Arena *arena, Error *err) {
    int figures = 0;
    if (!open_and_draw(request, cli, arena, &figures, err)) return false;
    if (cli->json) {
        json_t *answer = json_pack("{s:{s:o, s:i}}", "picture", "file", json_text(request->picture),
                                   "figures", figures);
        panel_level_add(&request->level, answer);
        return cli_print_json(answer, err);
    }
    if (!cli->quiet) panel_level_print(&request->level, stdout);
    return true;
}

static const Column ANSWER[] = {COLUMN_KEY("picture", "`file`, and how many `figures` it has"),
                                COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind ANSWER_KIND = TABLE_KIND("plot", NULL, ANSWER);

static Outcome run_plot(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    PlotRequest request = {.incidence_phi = 180};
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.svg|X.png", "the picture to write", &request.picture,
         .file = OPTION_OUTPUT},
        {"--kind", OPTION_CHOICE, PLOT_KINDS, "what to draw (default all: one sheet)",
         &request.kind},
        {"--measured", OPTION_TEXT, "MANIFEST.json",
         "the set that the panel was fitted from: its samples beside the curves, and what is left",
         &request.measured},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &request.root},
        {"--incidence-phi", OPTION_NUMBER, "DEG",
         "azimuth of the light for reflection (default 180: from the left)", &request.incidence_phi,
         -360, 360},
        PANEL_LEVEL_OPTION(request.level),
    };
    const CliCommand command = {
        "panel plot",
        command_panel_plot.summary,
        "X.panel -o X.svg|X.png [--kind KIND] [--measured MANIFEST.json]",
        "parhelion panel plot assets/panels/ips_cluster.panel --kind luminance "
        "-o luminance.png",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers = (const Answer[]){{"", &ANSWER_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    request.panel = cli.arguments[0];
    if (!request.picture) {
        error_set(err, ERROR_USAGE,
                  "panel plot wants -o X.svg or -o X.png; a page of all figures is 'panel report'");
        return OUTCOME_FAILED;
    }
    return outcome_of(reference_check_root(request.root, err) && run(&request, &cli, arena, err));
}

const Command command_panel_plot = {"plot", "pictures of a panel, one by one or on one sheet",
                                    run_plot};
