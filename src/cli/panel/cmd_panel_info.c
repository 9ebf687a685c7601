/* SPDX-License-Identifier: Apache-2.0 */
/* panel info: what a panel file holds, its sizes and errors. */
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_facts.h"
#include "cli/panel/panel_level.h"
#include "panel/query/panel.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_report.h"

static json_t *degrees_json(const double *radians, int count) {
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        json_array_append_new(list, json_real(round(degrees_from_radians(radians[i]) * 1e4) / 1e4));
    return list;
}

/* The light's measured incidences, and its azimuths where they matter. */
static void add_lights(const Panel *panel, json_t *report) {
    double theta[PANEL_INFO_INCIDENCES_MAX], phi[PANEL_INFO_AZIMUTHS_MAX];
    int thetas = panel_info_incidences(panel, theta);
    int phis = panel_info_azimuths(panel, phi);
    json_t *reflection = json_object_get(report, "reflection");
    if (!json_is_object(reflection)) return;
    json_object_set_new(reflection, "incidence_deg", degrees_json(theta, thetas));
    if (phis > 1) json_object_set_new(reflection, "incidence_phi_deg", degrees_json(phi, phis));
}

static bool print_report(const Panel *panel, const Cli *cli, Error *err) {
    json_t *report = NULL;
    if (!panel_report(panel, &report, err)) return error_in_file(err, cli->arguments[0]);
    add_lights(panel, report);
    panel_facts_add(panel, report);
    return panel_print_report(report, cli->json, err);
}

static Outcome run_info(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    Panel *panel = NULL;
    bool wants_levels = false;
    const Option options[] = {
        {"--levels", OPTION_FLAG, NULL,
         "only how far each level of its trees is off, for --level of other commands",
         &wants_levels},
    };
    const CliCommand command = {
        "panel info",
        command_panel_info.summary,
        "X.panel [--levels]",
        "parhelion panel info assets/panels/ips_cluster.panel",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers =
            (const Answer[]){{"", &panel_report_kind}, {"--levels", &panel_level_kind}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    if (!panel_open(cli.arguments[0], arena, &panel, err)) return OUTCOME_FAILED;
    bool ok = wants_levels ? cli_print_answer(&panel_level_kind, panel_level_list(panel, arena),
                                              cli.json, err)
                           : print_report(panel, &cli, err);
    panel_close(panel);
    return outcome_of(ok);
}

const Command command_panel_info = {"info", "what a panel file holds, its sizes and errors",
                                    run_info};
