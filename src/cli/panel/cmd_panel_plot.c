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
#include "plot/panel/plot_answer.h"
#include "text/json_text.h"

#define LEAST_SIZE 160
#define LARGEST_SIZE 20000

/* The command line of `panel plot`. */
typedef struct PlotRequest {
    const char *panel, *measured, *root, *picture, *contours, *ambient, *directed;
    PanelLevel level;
    PlotOptions options;
} PlotRequest;

/* The lines and contrasts that were requested, besides the pictures of them. */
static bool add_numbers(const PlotRequest *request, const PlotInput *input, Arena *arena,
                        json_t *answer, Error *err) {
    json_t *report = NULL;
    PlotData *data = plot_query(input, &request->options, arena, &report, err);
    if (!data) return false;
    plot_answer_add(data, request->options.kind, answer);
    json_decref(report);
    return true;
}

static bool draw(const PlotRequest *request, const PlotInput *input, Arena *arena, json_t *answer,
                 Error *err) {
    int count = 0;
    if (!plot_write(input, &request->options, request->picture, arena, &count, err)) return false;
    json_object_set_new(
        answer, "picture",
        json_pack("{s:o, s:i}", "file", json_text(request->picture), "figures", count));
    return (!request->contours && !request->options.ambient.count) ||
           add_numbers(request, input, arena, answer, err);
}

static bool open_and_draw(PlotRequest *request, const Cli *cli, Arena *arena, json_t *answer,
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
    bool ok = draw(request, &input, arena, answer, err);
    if (ok) panel_level_add(&request->level, answer);
    panel_close(panel);
    return ok;
}

/* Lines and light belong to maps over the viewing cone. */
static bool read_lists(PlotRequest *request, Error *err) {
    PlotOptions *options = &request->options;
    bool has_contrast = options->kind == PLOT_CONTRAST || options->kind == PLOT_ALL;
    if (request->contours && !has_contrast && options->kind != PLOT_LUMINANCE)
        return error_set(err, ERROR_USAGE,
                         "--contour draws over luminance and contrast, "
                         "not over --kind %s",
                         plot_kind_name(options->kind));
    if ((request->ambient || request->directed) && !has_contrast)
        return error_set(err, ERROR_USAGE,
                         "%s is for --kind contrast or all, not for "
                         "--kind %s",
                         request->ambient ? "--ambient" : "--directed",
                         plot_kind_name(options->kind));
    return (!request->contours || plot_contours_read(request->contours, &options->contours, err)) &&
           plot_ambient_read(request->ambient, request->directed, &options->ambient, err);
}

static bool check_request(const PlotRequest *request, Error *err) {
    int w = request->options.width, h = request->options.height;
    if (!request->picture)
        return error_set(err, ERROR_USAGE,
                         "panel plot wants -o X.svg or -o X.png; a page of "
                         "all figures is 'panel report'");
    if (w > 0 && (w < LEAST_SIZE || h < LEAST_SIZE || w > LARGEST_SIZE || h > LARGEST_SIZE))
        return error_set(err, ERROR_USAGE, "--size is %dx%d, required: %d to %d each way", w, h,
                         LEAST_SIZE, LARGEST_SIZE);
    return true;
}

static bool run(PlotRequest *request, const Cli *cli, Arena *arena, Error *err) {
    json_t *answer = json_object();
    if (!open_and_draw(request, cli, arena, answer, err)) {
        json_decref(answer);
        return false;
    }
    if (cli->json) return cli_print_json(answer, err);
    json_decref(answer);
    if (!cli->quiet) panel_level_print(&request->level, stdout);
    return true;
}

static const Column ANSWER[] = {
    COLUMN_KEY("picture", "`file`, and how many `figures` it has"),
    COLUMN_KEY("contours", "with `--contour`: `chart`, `asked`, `percent_of_axis`, `level`, "
                           "`lines_theta_phi_deg` (each a list of [theta, phi]) of each"),
    COLUMN_KEY("ambient", "with `--ambient`: `illuminance_lx`, `formula`, and `angles`, each with "
                          "`theta_deg`, `phi_deg`, `reflectance`, `reflected_cd_m2`, `contrast`; "
                          "with `--directed` also `directed_lx`, `directed_theta_deg`, "
                          "`directed_phi_deg`"),
    COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind ANSWER_KIND = TABLE_KIND("plot", NULL, ANSWER);

static Outcome run_plot(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    PlotRequest request = {0};
    int kind = 0, size[2] = {0, 0};
    double incidence_phi = 180;
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.svg|X.png", "the picture to write", &request.picture,
         .file = OPTION_OUTPUT},
        {"--kind", OPTION_CHOICE, PLOT_KINDS, "what to draw (default all: one sheet)", &kind},
        {"--measured", OPTION_TEXT, "MANIFEST.json",
         "the set that the panel was fitted from: its points over the curves, and the errors",
         &request.measured},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &request.root},
        {"--contour", OPTION_TEXT, "V[,V...]",
         "lines of luminance (cd/m2) or contrast at these values, with % of that on the axis",
         &request.contours},
        {"--ambient", OPTION_TEXT, "LUX[,LUX...]", AMBIENT_HELP, &request.ambient},
        {"--directed", OPTION_TEXT, "LUX[,DEG]", DIRECTED_HELP, &request.directed},
        {"--incidence-phi", OPTION_NUMBER, "DEG",
         "azimuth of the light for reflection (default 180: from the left)", &incidence_phi, -360,
         360},
        PANEL_LEVEL_OPTION(request.level),
        {"--size", OPTION_SIZE, "WxH", "of the picture, pixels (default: as it needs)", size},
        {"--dark", OPTION_FLAG, NULL, "light lines on a dark ground", &request.options.is_dark},
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
    request.options.kind = (PlotKind)kind;
    request.options.width = size[0];
    request.options.height = size[1];
    request.options.incidence_phi = radians_from_degrees(incidence_phi);
    request.options.threads = cli.threads;
    return outcome_of(check_request(&request, err) && read_lists(&request, err) &&
                      reference_check_root(request.root, err) && run(&request, &cli, arena, err));
}

const Command command_panel_plot = {"plot", "pictures of a panel, one by one or on one sheet",
                                    run_plot};
