/* SPDX-License-Identifier: Apache-2.0 */
/* panel eval: what a panel emits or reflects in one direction. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/number.h"
#include "print/print.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_level.h"
#include "cli/panel/panel_question.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_reflection.h"
#include "text/csv_table.h"

/* The command line of `panel eval`. */
typedef struct EvalRequest {
    PanelQuestion question;
    const char *batch, *grid;
    bool has_theta, has_rgb, has_incidence, wants_csv;
    PanelLevel level;
    int layout;   /* 0: rows, a table that `panel fit` reads; 1: a matrix */
    int quantity; /* index of PANEL_QUANTITIES */
} EvalRequest;

/* ---- a grid of directions ---------------------------------------------------------------- */

/* first, first + step, ... up to last (degrees). */
typedef struct PanelRange {
    double first, last, step;
} PanelRange;

typedef struct PanelGrid {
    PanelRange theta, phi;
} PanelGrid;

/* The quantities of a matrix: the names of --quantity. */
#define PANEL_QUANTITIES "X|Y|Z|u|v|brdf"

#define POINTS_MAX 20000000

static int range_count(const PanelRange *range) {
    return 1 + (int)floor((range->last - range->first) / range->step + 1e-9);
}

static double range_at(const PanelRange *range, int i) {
    return range->first + i * range->step;
}

/* ---- the option ------------------------------------------------------------------------ */

static bool parse_range(const char **text, PanelRange *out) {
    double *const to[3] = {&out->first, &out->last, &out->step};
    for (int i = 0; i < 3; i++) {
        const char *after = number_read(*text, to[i]);
        if (!after) return false;
        *text = after;
        if (i < 2 && *(*text)++ != ':') return false;
    }
    return out->step > 0 && out->last >= out->first && out->last - out->first <= 720 &&
           (out->last - out->first) / out->step < POINTS_MAX;
}

/* "THETA0:THETA1:STEP,PHI0:PHI1:STEP"; theta within 0..90, phi within -360..360. */
static bool panel_grid_parse(const char *text, PanelGrid *out, Error *err) {
    const char *at = text;
    bool ok = parse_range(&at, &out->theta) && *at++ == ',' && parse_range(&at, &out->phi) &&
              !*at && out->theta.first >= 0 && out->theta.last <= 90 && out->phi.first >= -360 &&
              out->phi.last <= 360;
    if (ok && (double)range_count(&out->theta) * range_count(&out->phi) > POINTS_MAX)
        return error_set(err, ERROR_USAGE, "--grid %s has more than %d directions", text,
                         POINTS_MAX);
    return ok || error_set(err, ERROR_USAGE,
                           "--grid is '%s', required: THETA0:THETA1:STEP,PHI0:PHI1:STEP in "
                           "degrees, theta within 0 to 90, steps above 0",
                           text);
}

/* ---- CSV ------------------------------------------------------------------------------- */

/* Describes the numbers below it. */
static void print_comment(const PanelQuestion *q) {
    if (q->is_brdf)
        print("# reflection in sr^-1, the cosine not included, mirror part left out; light "
              "at theta %g, phi %g; angles in degrees, columns in nm\n",
              q->incidence, q->incidence_phi);
    else
        print("# emission at codes %g,%g,%g: CIE 1931 XYZ, Y in cd/m2; angles in degrees\n",
              q->rgb[0], q->rgb[1], q->rgb[2]);
}

/* Channels of one direction; returns whether it is measured. */
static bool channels_at(const Panel *panel, const PanelQuestion *q, float *out) {
    PanelReflected r;
    if (!q->is_brdf) return panel_query_emission(panel, q, out);
    panel_query_reflection(panel, q, &r);
    memcpy(out, r.brdf, sizeof *out * (size_t)r.count);
    return r.is_measured;
}

static void print_list(const Panel *panel, const PanelQuestion *question, const PanelGrid *grid) {
    PanelQuestion q = *question;
    PanelReflected r = {.count = 3};
    print_comment(&q);
    print("theta,phi%s", q.is_brdf ? "" : ",X,Y,Z");
    if (q.is_brdf) panel_query_reflection(panel, &q, &r);
    for (int i = 0; i < r.count && q.is_brdf; i++) print(",%.9g", (double)r.nm[i]);
    for (int t = 0; t < range_count(&grid->theta); t++)
        for (int p = 0; p < range_count(&grid->phi); p++) {
            float value[PANEL_INFO_WAVELENGTHS_MAX];
            q.theta = range_at(&grid->theta, t);
            q.phi = range_at(&grid->phi, p);
            channels_at(panel, &q, value);
            print("\n%.10g,%.10g", q.theta, q.phi);
            for (int i = 0; i < r.count; i++) print(",%.9g", (double)value[i]);
        }
    print("\n");
}

typedef enum Quantity {
    QUANTITY_X,
    QUANTITY_Y,
    QUANTITY_Z,
    QUANTITY_U,
    QUANTITY_V,
    QUANTITY_BRDF
} Quantity;

static double quantity_at(const Panel *panel, const PanelQuestion *q, Quantity quantity) {
    float value[PANEL_INFO_WAVELENGTHS_MAX];
    channels_at(panel, q, value);
    if (q->is_brdf) return (double)value[0];
    double x = (double)value[0], y = (double)value[1], z = (double)value[2], d = x + 15 * y + 3 * z;
    switch (quantity) {
    case QUANTITY_U: return d > 0 ? 4 * x / d : 0;
    case QUANTITY_V: return d > 0 ? 9 * y / d : 0;
    case QUANTITY_X: return x;
    case QUANTITY_Z: return z;
    default: return y;
    }
}

static void print_matrix(const Panel *panel, const PanelQuestion *question, const PanelGrid *grid,
                         Quantity quantity) {
    static const char *const names[] = {"X, cd/m2 as Y", "Y, cd/m2",      "Z, cd/m2 as Y",
                                        "u' (CIE 1976)", "v' (CIE 1976)", "BRDF, sr^-1"};
    PanelQuestion q = *question;
    print_comment(&q);
    print("# %s", names[q.is_brdf ? QUANTITY_BRDF : quantity]);
    if (q.is_brdf) print(" at %g nm", q.wavelength_nm);
    print("; theta down, phi across\ntheta\\phi");
    for (int p = 0; p < range_count(&grid->phi); p++) print(",%.10g", range_at(&grid->phi, p));
    for (int t = 0; t < range_count(&grid->theta); t++) {
        q.theta = range_at(&grid->theta, t);
        print("\n%.10g", q.theta);
        for (int p = 0; p < range_count(&grid->phi); p++) {
            q.phi = range_at(&grid->phi, p);
            print(",%.9g", quantity_at(panel, &q, quantity));
        }
    }
    print("\n");
}

/* ---- JSON ------------------------------------------------------------------------------ */

static json_t *range_json(const PanelRange *range) {
    json_t *list = json_array();
    for (int i = 0; i < range_count(range); i++)
        json_array_append_new(list, json_real(range_at(range, i)));
    return list;
}

/* The thetas at which some directions are extrapolated; which, theta x phi. */
typedef struct FarLists {
    json_t *theta, *at;
} FarLists;

/* Fills one theta x phi table a channel. */
static FarLists fill_tables(const Panel *panel, const PanelQuestion *question,
                            const PanelGrid *grid, int channels, json_t **table) {
    FarLists far = {json_array(), json_array()};
    PanelQuestion q = *question;
    float value[PANEL_INFO_WAVELENGTHS_MAX];
    for (int t = 0; t < range_count(&grid->theta); t++) {
        bool is_all = true;
        json_t *row = json_array();
        q.theta = range_at(&grid->theta, t);
        for (int c = 0; c < channels; c++) json_array_append_new(table[c], json_array());
        for (int p = 0; p < range_count(&grid->phi); p++) {
            q.phi = range_at(&grid->phi, p);
            bool is_measured = channels_at(panel, &q, value);
            is_all &= is_measured;
            json_array_append_new(row, json_boolean(!is_measured));
            for (int c = 0; c < channels; c++)
                json_array_append_new(json_array_get(table[c], (size_t)t),
                                      json_real((double)value[c]));
        }
        json_array_append_new(far.theta, json_boolean(!is_all));
        json_array_append_new(far.at, row);
    }
    return far;
}

static json_t *reflection_grid_json(const Panel *panel, const PanelQuestion *q,
                                    const PanelGrid *grid) {
    json_t *table[PANEL_INFO_WAVELENGTHS_MAX], *nm = json_array();
    json_t *brdf = json_array(), *mirror = json_array();
    PanelReflected r;
    panel_query_reflection(panel, q, &r);
    for (int i = 0; i < r.count; i++) {
        table[i] = json_array();
        json_array_append_new(brdf, table[i]);
        json_array_append_new(nm, json_real((double)r.nm[i]));
        json_array_append_new(mirror, json_real((double)r.mirror[i]));
    }
    FarLists far = fill_tables(panel, q, grid, r.count, table);
    return json_pack("{s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "incidence_deg", q->incidence,
                     "incidence_phi_deg", q->incidence_phi, "theta_deg", range_json(&grid->theta),
                     "phi_deg", range_json(&grid->phi), "wavelengths_nm", nm, "brdf_sr", brdf,
                     "mirror", mirror, "extrapolated", far.theta, "extrapolated_at", far.at);
}

static json_t *emission_grid_json(const Panel *panel, const PanelQuestion *q,
                                  const PanelGrid *grid) {
    json_t *table[3] = {json_array(), json_array(), json_array()};
    FarLists far = fill_tables(panel, q, grid, 3, table);
    return json_pack("{s:[f,f,f], s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "rgb", q->rgb[0], q->rgb[1],
                     q->rgb[2], "theta_deg", range_json(&grid->theta), "phi_deg",
                     range_json(&grid->phi), "X", table[0], "Y", table[1], "Z", table[2],
                     "extrapolated", far.theta, "extrapolated_at", far.at);
}

/* ---- the answer in a direction ----------------------------------------------------------- */

static const Column EMISSION[] = {
    COLUMN_DIGITS("theta_deg", "theta", "degrees", 0),
    COLUMN_DIGITS("phi_deg", "phi", "degrees", 0),
    {.key = "position", .words = "place (right, down)"},
    {.key = "rgb", .words = "codes"},
    COLUMN_DIGITS("luminance_cd_m2", "luminance", "cd/m2", 0),
    {.key = "XYZ", .words = "X, Y, Z"},
    {.key = "uv", .words = "u', v'", .is_fixed = true, .places = 4},
    {.key = "extrapolated", .words = "extrapolated", .hides_zero = true},
    COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind EMISSION_KIND = TABLE_KIND("emission", NULL, EMISSION);

static const Column SPECTRUM[] = {COLUMN_DIGITS("wavelengths_nm", "wavelength", "nm", 0),
                                  COLUMN_DIGITS("brdf_sr", "BRDF", "sr^-1", 0),
                                  COLUMN_DIGITS("lambertian_sr", "lambertian of it", "sr^-1", 0),
                                  COLUMN_DIGITS("mirror", "mirror", NULL, 0)};
static const TableKind SPECTRUM_KIND = TABLE_KIND("spectrum", NULL, SPECTRUM);
static const Column REFLECTION[] = {
    COLUMN_DIGITS("incidence_deg", "light from theta", "degrees", 0),
    COLUMN_DIGITS("incidence_phi_deg", "phi", "degrees", 0),
    COLUMN_DIGITS("theta_deg", "to theta", "degrees", 0),
    COLUMN_DIGITS("phi_deg", "phi", "degrees", 0),
    {.key = "position", .words = "place (right, down)"},
    {.key = "extrapolated",
     .words = "extrapolated",
     .hides_zero = true,
     .about = "neither these directions nor the two exchanged were measured"},
    {.key = "wavelengths_nm", .lists = &SPECTRUM_KIND},
    COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind REFLECTION_KIND = TABLE_KIND("reflection", NULL, REFLECTION);

/* A batch of them is a list. */
static bool print_answers(const Panel *panel, const EvalRequest *request, const Cli *cli,
                          const PanelQuestion *list, int count, Error *err) {
    bool is_brdf = request->question.is_brdf;
    if (request->wants_csv) {
        panel_answer_csv_header(list, stdout);
        for (int i = 0; i < count; i++) panel_answer_csv(panel, &list[i], stdout);
        return true;
    }
    json_t *answers = json_array();
    for (int i = 0; i < count; i++) {
        json_t *one = panel_answer_json(panel, &list[i]);
        panel_level_add(&request->level, one);
        json_array_append_new(answers, one);
    }
    if (!request->batch) {
        json_t *all = answers;
        answers = json_incref(json_array_get(all, 0));
        json_decref(all);
    }
    return cli_print_answer(is_brdf ? &REFLECTION_KIND : &EMISSION_KIND, answers, cli->json, err);
}

/* ---- many rows at once ----------------------------------------------------------------- */

static bool fill_question(const CsvTable *csv, int row, Arena *arena, PanelQuestion *q,
                          Error *err) {
    for (int c = 0; c < csv->columns; c++) {
        double *to = panel_question_member(q, csv->name[c]);
        if (!to)
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "column '%s' is unknown, required: theta, phi, r, g, b, incidence, "
                            "incidence_phi, wavelength, u or v",
                            csv->name[c]);
        *to = (double)csv->cell[(size_t)row * (size_t)csv->columns + (size_t)c];
    }
    if (panel_question_check(q, err)) return true;
    return error_at(err, ERROR_INPUT, csv->file, csv_table_place(csv, row, arena), "%s",
                    arena_string(arena, err->text, strlen(err->text)));
}

/* Columns of the kind that is requested, so that none is passed over. */
static bool check_columns(const CsvTable *csv, const EvalRequest *request, Error *err) {
    bool is_brdf = request->question.is_brdf, has_incidence = request->has_incidence;
    for (int c = 0; c < csv->columns; c++) {
        const char *name = csv->name[c];
        has_incidence |= !strcmp(name, "incidence");
        if (is_brdf ? panel_question_is_of_emission(name) : panel_question_is_of_brdf(name))
            return error_at(err, ERROR_INPUT, csv->file, "header line",
                            "column '%s' is of "
                            "%s",
                            name,
                            is_brdf ? "an emission, and --brdf requests reflection"
                                    : "a reflection, which --brdf requests");
    }
    return !is_brdf || has_incidence ||
           error_at(err, ERROR_INPUT, csv->file, "header line",
                    "has no column 'incidence', "
                    "required with --brdf (or --incidence T)");
}

static bool answer_batch(const Panel *panel, const EvalRequest *request, const Cli *cli,
                         Arena *arena, Error *err) {
    CsvTable csv;
    PanelQuestion *list;
    if (!csv_table_read(request->batch, arena, &csv, err) || !check_columns(&csv, request, err))
        return false;
    list = ARENA_NEW(arena, PanelQuestion, csv.rows);
    for (int i = 0; i < csv.rows; i++) {
        list[i] = request->question;
        if (!fill_question(&csv, i, arena, &list[i], err)) return false;
    }
    return print_answers(panel, request, cli, list, csv.rows, err);
}

/* ---- a grid ------------------------------------------------------------------------------ */

#define THETAS_ABOUT "the thetas at which some directions are"
#define DIRECTIONS_ABOUT "which directions are, over theta, then phi"

static const Column EMISSION_GRID[] = {COLUMN_KEY("rgb", "codes"),
                                       COLUMN_KEY("theta_deg", "a list, as `phi_deg`"),
                                       COLUMN_KEY("phi_deg", NULL),
                                       COLUMN_KEY("X", "lists over theta, then phi, as Y and Z"),
                                       COLUMN_KEY("Y", "cd/m2"),
                                       COLUMN_KEY("Z", NULL),
                                       COLUMN_KEY("extrapolated", THETAS_ABOUT),
                                       COLUMN_KEY("extrapolated_at", DIRECTIONS_ABOUT),
                                       COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind EMISSION_GRID_KIND = TABLE_KIND("emission", NULL, EMISSION_GRID);
static const Column REFLECTION_GRID[] = {COLUMN_KEY("incidence_deg", "of the light"),
                                         COLUMN_KEY("incidence_phi_deg", NULL),
                                         COLUMN_KEY("theta_deg", "a list, as `phi_deg`"),
                                         COLUMN_KEY("phi_deg", NULL),
                                         COLUMN_KEY("wavelengths_nm", NULL),
                                         COLUMN_KEY("brdf_sr", "of each of them lists over theta, "
                                                               "then phi, without the mirror part"),
                                         COLUMN_KEY("mirror", "of each of them"),
                                         COLUMN_KEY("extrapolated", THETAS_ABOUT),
                                         COLUMN_KEY("extrapolated_at", DIRECTIONS_ABOUT),
                                         COLUMN_KEY("level", PANEL_LEVEL_ABOUT)};
static const TableKind REFLECTION_GRID_KIND = TABLE_KIND("reflection", NULL, REFLECTION_GRID);

static bool answer_grid(const Panel *panel, const EvalRequest *request, const Cli *cli,
                        Error *err) {
    PanelGrid grid;
    const PanelQuestion *q = &request->question;
    if (!panel_grid_parse(request->grid, &grid, err)) return false;
    if (!cli->json) {
        if (request->layout)
            print_matrix(panel, &request->question, &grid, (Quantity)request->quantity);
        else print_list(panel, &request->question, &grid);
        return true;
    }
    json_t *tables =
        q->is_brdf ? reflection_grid_json(panel, q, &grid) : emission_grid_json(panel, q, &grid);
    panel_level_add(&request->level, tables);
    return cli_print_json(tables, err);
}

static bool answer(const char *path, EvalRequest *request, const Cli *cli, Arena *arena,
                   Error *err) {
    Panel *panel = NULL;
    bool ok;
    request->level.parts =
        request->question.is_brdf ? PANEL_COARSE_REFLECTION : PANEL_COARSE_EMISSION;
    if (!panel_level_open(path, &request->level, arena, &panel, err)) return false;
    if (request->question.is_brdf && !panel_reflects(panel))
        ok = error_at(err, ERROR_INPUT, path, "",
                      "has no reflection data; fit a set with a 'reflection' entry");
    else if (request->grid) ok = answer_grid(panel, request, cli, err);
    else if (request->batch) ok = answer_batch(panel, request, cli, arena, err);
    else ok = print_answers(panel, request, cli, &request->question, 1, err);
    bool is_listed = request->grid || request->batch || request->wants_csv;
    if (ok && !cli->quiet && (is_listed || !cli->json))
        panel_level_print(&request->level, is_listed ? stderr : stdout);
    panel_close(panel);
    return ok;
}

static bool check_request(const EvalRequest *request, const Cli *cli, Error *err) {
    const PanelQuestion *q = &request->question;
    PanelGrid grid;
    if (request->wants_csv && cli->json)
        return error_set(err, ERROR_USAGE, "--csv and --json exclude each other");
    if (request->batch && request->grid)
        return error_set(err, ERROR_USAGE, "--batch and --grid exclude each other");
    if (request->grid && !panel_grid_parse(request->grid, &grid, err)) return false;
    if (!q->is_brdf && (request->has_incidence || q->wavelength_nm > 0))
        return error_set(err, ERROR_USAGE, "%s is of a reflection, which --brdf requests",
                         request->has_incidence ? "--incidence" : "--wavelength");
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

static Outcome run_eval(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    EvalRequest r = {.question = {.rgb = {255, 255, 255}, .incidence_phi = 180, .at = {NAN, NAN}},
                     .quantity = 1};
    PanelQuestion *q = &r.question;
    const Option options[] = {
        {"--theta", OPTION_NUMBER, "DEG", "angle from the normal, degrees", &q->theta, 0, 90, 0,
         &r.has_theta},
        {"--phi", OPTION_NUMBER, "DEG", "azimuth, degrees: 0 right, 90 up (default 0)", &q->phi,
         -360, 360},
        {"--rgb", OPTION_NUMBERS, "R,G,B", "the pixel's codes, 0 to 255", q->rgb, 0, 255, 3,
         &r.has_rgb},
        {"--brdf", OPTION_FLAG, NULL, "reflection (sr^-1, no cosine) instead of emission",
         &q->is_brdf},
        {"--incidence", OPTION_NUMBER, "DEG", "angle of the light from the normal, degrees",
         &q->incidence, 0, 90, 0, &r.has_incidence},
        {"--incidence-phi", OPTION_NUMBER, "DEG",
         "azimuth of the light, degrees (default 180: the mirror direction is at phi 0)",
         &q->incidence_phi, -360, 360},
        {"--at", OPTION_NUMBERS, "U,V",
         "place on the active area, 0 to 1 from its upper left corner, right and down "
         "(default: the panel's own tables)",
         q->at, 0, 1, 2},
        {"--wavelength", OPTION_NUMBER, "NM", "one wavelength, nm, instead of all measured ones",
         &q->wavelength_nm, 360, 830},
        {"--grid", OPTION_TEXT, "T0:T1:DT,P0:P1:DP",
         "theta and phi from, to, step, degrees, instead of one direction", &r.grid},
        {"--layout", OPTION_CHOICE, "list|matrix",
         "of a grid: rows theta,phi,values, or theta down and phi across (default list)",
         &r.layout},
        {"--quantity", OPTION_CHOICE, PANEL_QUANTITIES,
         "in a matrix: X, Y, Z in cd/m2, u' or v' (default Y); brdf in sr^-1 with --brdf",
         &r.quantity},
        PANEL_LEVEL_OPTION(r.level),
        {"--batch", OPTION_TEXT, "FILE.csv",
         "one question a row; columns theta, phi, r, g, b, incidence, ...", &r.batch},
        {"--csv", OPTION_FLAG, NULL,
         "answers as comma-separated rows: XYZ in cd/m2, or sr^-1, a row a wavelength",
         &r.wants_csv},
    };
    const CliCommand command = {
        "panel eval",
        command_panel_eval.summary,
        "X.panel --theta T --phi P --rgb R,G,B | --brdf --incidence T --theta T --phi P",
        "parhelion panel eval assets/panels/ips_cluster.panel --theta 30 --phi 0 "
        "--rgb 255,255,255",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers = (const Answer[]){{"", &EMISSION_KIND},
                                    {"--brdf", &REFLECTION_KIND},
                                    {"--grid", &EMISSION_GRID_KIND},
                                    {"--brdf --grid", &REFLECTION_GRID_KIND},
                                    {0}}};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    return outcome_of(check_request(&r, &cli, err) &&
                      answer(cli.arguments[0], &r, &cli, arena, err));
}

const Command command_panel_eval = {
    "eval", "what a panel emits (cd/m2) or reflects (sr^-1) in one direction, or on a grid",
    run_eval};
