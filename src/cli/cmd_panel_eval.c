/* panel info, panel eval: what a panel file says. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/units.h"
#include "cli/cli.h"
#include "cli/panel_commands.h"
#include "panel/csv_table.h"
#include "panel/fit.h"
#include "panel/panel_info.h"

#define ARENA_BYTES ((size_t)16 << 30)
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

bool cmd_panel_info(int argc, char **argv, Error *err)
{
    Arena   arena = arena_reserve(ARENA_BYTES);
    Cli     cli;
    Panel  *panel = NULL;
    json_t *report = NULL;
    const CliCommand command = {"panel info", "what a panel file holds, its sizes and errors",
        "X.panel", "parhelion panel info assets/panels/ips_cluster.panel", NULL, 0, 1, 1};
    if (!cli_parse(&command, argc, argv, &arena, &cli, err)) return false;
    if (cli.help_shown) return true;
    bool ok = panel_open(cli.arguments[0], &arena, &panel, err) &&
              (panel_report(panel, &report, err) || error_in_file(err, cli.arguments[0]));
    if (ok && cli.json) {
        ok = cli_print_json(report, err);
    } else if (ok) {
        panel_print_report(report);
        json_decref(report);
    }
    panel_close(panel);
    arena_release(&arena);
    return ok;
}

/* One question; angles in degrees. */
typedef struct Question {
    double theta, phi, rgb[3];
    double incidence, incidence_phi;
    bool   is_brdf;
    double wavelength_nm; /* 0: all measured ones */
} Question;

static Vec3 direction_deg(double theta_deg, double phi_deg)
{
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg);
    return vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
}

static json_t *answer_emission(const Panel *panel, const Question *q)
{
    float xyz[3], rgb[3] = {(float)q->rgb[0], (float)q->rgb[1], (float)q->rgb[2]};
    bool  measured = panel_emission_xyz(panel, direction_deg(q->theta, q->phi), rgb, xyz);
    double x = (double)xyz[0], y = (double)xyz[1], z = (double)xyz[2], d = x + 15 * y + 3 * z;
    return json_pack("{s:f, s:f, s:[f,f,f], s:[f,f,f], s:f, s:[f,f], s:b}",
        "theta_deg", q->theta, "phi_deg", q->phi, "rgb", q->rgb[0], q->rgb[1], q->rgb[2],
        "XYZ", x, y, z, "luminance_cd_m2", y,
        "uv", d > 0 ? 4 * x / d : 0, d > 0 ? 9 * y / d : 0,
        "extrapolated", (int)!measured);
}

static void add_wavelengths(const Panel *panel, const Question *q, const float *nm, int count,
                            json_t *lists[3])
{
    Vec3 wo = direction_deg(q->theta, q->phi);
    Vec3 wi = direction_deg(q->incidence, q->incidence_phi);
    for (int first = 0; first < count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = {0};
        for (int i = 0; i < SPECTRUM_LANES; i++)
            wavelengths.nm[i] = nm[first + i < count ? first + i : count - 1];
        Spectrum f = panel_brdf(panel, wo, wi, &wavelengths);
        Spectrum r = panel_mirror(panel, wi.z, &wavelengths);
        for (int i = 0; i < SPECTRUM_LANES && first + i < count; i++) {
            json_array_append_new(lists[0], json_real((double)nm[first + i]));
            json_array_append_new(lists[1], json_real((double)f[i]));
            json_array_append_new(lists[2], json_real((double)r[i]));
        }
    }
}

static json_t *answer_brdf(const Panel *panel, const Question *q)
{
    json_t *lists[3] = {json_array(), json_array(), json_array()};
    float   nm[PANEL_INFO_WAVELENGTHS_MAX];
    int     count = panel_info_wavelengths(panel, nm);
    if (q->wavelength_nm > 0) {
        nm[0] = (float)q->wavelength_nm;
        count = 1;
    }
    add_wavelengths(panel, q, nm, count, lists);
    bool measured = panel_info_brdf_is_measured(panel, radians_from_degrees(q->incidence),
                                                radians_from_degrees(q->theta));
    return json_pack("{s:f, s:f, s:f, s:f, s:o, s:o, s:o, s:b}", "incidence_deg", q->incidence,
        "incidence_phi_deg", q->incidence_phi, "theta_deg", q->theta, "phi_deg", q->phi,
        "wavelengths_nm", lists[0], "brdf_sr", lists[1], "mirror", lists[2],
        "extrapolated", (int)!measured);
}

static json_t *answer(const Panel *panel, const Question *question)
{
    return question->is_brdf ? answer_brdf(panel, question) : answer_emission(panel, question);
}

static void print_answer(const json_t *a, bool is_brdf)
{
    bool        is_far = json_is_true(json_object_get(a, "extrapolated"));
    const char *flag = is_far ? "  (extrapolated)" : "";
    if (!is_brdf) {
        json_t *xyz = json_object_get(a, "XYZ"), *uv = json_object_get(a, "uv");
        printf("%.6g cd/m2  XYZ %.6g %.6g %.6g  u'v' %.4f %.4f%s\n",
               json_number_value(json_object_get(a, "luminance_cd_m2")),
               json_number_value(json_array_get(xyz, 0)),
               json_number_value(json_array_get(xyz, 1)),
               json_number_value(json_array_get(xyz, 2)),
               json_number_value(json_array_get(uv, 0)),
               json_number_value(json_array_get(uv, 1)), flag);
        return;
    }
    for (size_t i = 0; i < json_array_size(json_object_get(a, "brdf_sr")); i++)
        printf("%g nm  %.6g sr^-1  mirror %.6g%s\n",
               json_number_value(json_array_get(json_object_get(a, "wavelengths_nm"), i)),
               json_number_value(json_array_get(json_object_get(a, "brdf_sr"), i)),
               json_number_value(json_array_get(json_object_get(a, "mirror"), i)), flag);
}

/* ---- many rows at once ----------------------------------------------------------------- */

/* A batch column fills the question's member of the same name as the option. */
static double *question_member(Question *q, const char *name)
{
    struct { const char *name; double *to; } members[] = {
        {"theta", &q->theta}, {"phi", &q->phi}, {"r", &q->rgb[0]}, {"g", &q->rgb[1]},
        {"b", &q->rgb[2]}, {"incidence", &q->incidence}, {"incidence_phi", &q->incidence_phi},
        {"wavelength", &q->wavelength_nm}};
    for (int i = 0; i < COUNT(members); i++)
        if (!strcmp(members[i].name, name)) return members[i].to;
    return NULL;
}

static bool check_question(const Question *q, Error *err)
{
    if (q->is_brdf && !(q->incidence >= 0 && q->incidence <= 90))
        return error_set(err, ERROR_USAGE, "incidence is %g, wanted 0 to 90 degrees",
                         q->incidence);
    if (!(q->theta >= 0 && q->theta <= 90))
        return error_set(err, ERROR_USAGE, "theta is %g, wanted 0 to 90 degrees", q->theta);
    for (int i = 0; i < 3; i++)
        if (!(q->rgb[i] >= 0 && q->rgb[i] <= 255))
            return error_set(err, ERROR_USAGE, "a code is %g, wanted 0 to 255", q->rgb[i]);
    return true;
}

static bool answer_batch(const Panel *panel, const char *file, const Question *first,
                         const Cli *cli, Arena *arena, Error *err)
{
    CsvTable csv;
    if (!csv_table_read(file, arena, &csv, err)) return false;
    json_t *list = json_array();
    for (int i = 0; i < csv.rows; i++) {
        Question q = *first;
        for (int c = 0; c < csv.columns; c++) {
            double *to = question_member(&q, csv.name[c]);
            if (!to) {
                json_decref(list);
                return error_at(err, ERROR_INPUT, file, "header line",
                                "column '%s' is unknown, wanted theta, phi, r, g, b, "
                                "incidence, incidence_phi or wavelength", csv.name[c]);
            }
            *to = (double)csv.cell[(size_t)i * (size_t)csv.columns + (size_t)c];
        }
        if (!check_question(&q, err)) {
            json_decref(list);
            return error_at(err, ERROR_INPUT, file, csv_table_place(&csv, i, arena), "%s",
                            arena_string(arena, err->text, strlen(err->text)));
        }
        json_t *one = answer(panel, &q);
        if (cli->json) {
            json_array_append_new(list, one);
        } else {
            print_answer(one, q.is_brdf);
            json_decref(one);
        }
    }
    if (cli->json) return cli_print_json(list, err);
    json_decref(list);
    return true;
}

static bool answer_all(const char *path, const Question *question, const char *batch,
                       const Cli *cli, Arena *arena, Error *err)
{
    Panel *panel = NULL;
    if (!panel_open(path, arena, &panel, err)) return false;
    bool ok = true;
    if (question->is_brdf && !panel_reflects(panel)) {
        ok = error_at(err, ERROR_INPUT, path, "",
                      "has no reflection data; fit a set with a 'reflection' entry");
    } else if (batch) {
        ok = answer_batch(panel, batch, question, cli, arena, err);
    } else {
        json_t *one = answer(panel, question);
        if (cli->json) {
            ok = cli_print_json(one, err);
        } else {
            print_answer(one, question->is_brdf);
            json_decref(one);
        }
    }
    panel_close(panel);
    return ok;
}

bool cmd_panel_eval(int argc, char **argv, Error *err)
{
    Arena       arena = arena_reserve(ARENA_BYTES);
    Cli         cli;
    const char *batch = NULL;
    bool        has_theta = false, has_rgb = false, has_incidence = false;
    Question    q = {.rgb = {255, 255, 255}, .incidence_phi = 180};
    const Option options[] = {
        {"--theta", OPTION_NUMBER, "DEG", "angle from the normal", &q.theta, 0, 90, 0,
         &has_theta},
        {"--phi", OPTION_NUMBER, "DEG", "azimuth: 0 right, 90 up (default 0)", &q.phi, -360,
         360, .given = NULL},
        {"--rgb", OPTION_NUMBERS, "R,G,B", "the pixel's codes, 0 to 255", q.rgb, 0, 255, 3,
         &has_rgb},
        {"--brdf", OPTION_FLAG, NULL, "reflection instead of emission", &q.is_brdf,
         .given = NULL},
        {"--incidence", OPTION_NUMBER, "DEG", "angle of the light from the normal",
         &q.incidence, 0, 90, 0, &has_incidence},
        {"--incidence-phi", OPTION_NUMBER, "DEG", "azimuth of the light (default 180)",
         &q.incidence_phi, -360, 360, .given = NULL},
        {"--wavelength", OPTION_NUMBER, "NM", "one wavelength instead of the measured ones",
         &q.wavelength_nm, 360, 830, .given = NULL},
        {"--batch", OPTION_TEXT, "FILE.csv",
         "one question a row; columns theta, phi, r, g, b, incidence, ...", &batch,
         .given = NULL},
    };
    const CliCommand command = {"panel eval", "what a panel emits or reflects in one direction",
        "X.panel --theta T --phi P --rgb R,G,B | --brdf --incidence T --theta T --phi P",
        "parhelion panel eval assets/panels/ips_cluster.panel --theta 30 --phi 0 "
        "--rgb 255,255,255", options, COUNT(options), 1, 1};
    if (!cli_parse(&command, argc, argv, &arena, &cli, err)) return false;
    if (cli.help_shown) return true;
    if (!batch && !has_theta) return error_set(err, ERROR_USAGE, "panel eval wants --theta T");
    if (!batch && !q.is_brdf && !has_rgb)
        return error_set(err, ERROR_USAGE, "panel eval wants --rgb R,G,B (or --brdf)");
    if (!batch && q.is_brdf && !has_incidence)
        return error_set(err, ERROR_USAGE, "panel eval --brdf wants --incidence T");
    bool ok = answer_all(cli.arguments[0], &q, batch, &cli, &arena, err);
    arena_release(&arena);
    return ok;
}
