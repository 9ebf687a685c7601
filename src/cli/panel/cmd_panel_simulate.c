/* SPDX-License-Identifier: Apache-2.0 */
/* panel simulate: a virtual instrument measures a synthetic panel. */

#include "base/count.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "panel/set/synthetic_format.h"
#include "panel/set/simulate.h"

/* The closed form at one direction: the answer of a perfect fit. */
static bool print_closed_form(const SyntheticPanel *panel, const double at[5], Error *err) {
    double xyz[3], angles[2] = {radians_from_degrees(at[0]), radians_from_degrees(at[1])};
    json_t *brdf = json_array(), *mirror = json_array(), *nm = json_array();
    closed_form_black_xyz(panel, angles, xyz);
    for (int p = 0; p < 3; p++) {
        double add[3];
        closed_form_emission_xyz(panel, p, at[2 + p], angles, add);
        for (int j = 0; j < 3; j++) xyz[j] += add[j];
    }
    json_t *document = json_pack("{s:f, s:f, s:[f,f,f], s:[f,f,f]}", "theta_deg", at[0], "phi_deg",
                                 at[1], "rgb", at[2], at[3], at[4], "XYZ", xyz[0], xyz[1], xyz[2]);
    for (int w = 0; w < panel->reflection.wavelength_count && panel->reflection.exists; w++) {
        double l = panel->reflection.wavelength_nm[w];
        json_array_append_new(nm, json_real(l));
        double haze = closed_form_brdf(panel, angles[0], angles[0], 0, l);
        json_array_append_new(brdf, json_real(haze));
        json_array_append_new(mirror, json_real(closed_form_mirror(panel, angles[0], l)));
    }
    json_object_set_new(document, "wavelengths_nm", nm);
    json_object_set_new(document, "brdf_at_mirror_sr", brdf);
    json_object_set_new(document, "mirror", mirror);
    return cli_print_json(document, err);
}

static void switch_noise_off(SyntheticInstrument *instrument) {
    instrument->noise_relative = instrument->noise_cd_m2 = instrument->noise_brdf_sr = 0;
}

/* So many rings, the normal not counted, and azimuths. */
static bool set_grid(SyntheticInstrument *instrument, const int grid[2], Error *err) {
    double theta = instrument->theta_max_deg / grid[0], phi = 360.0 / grid[1];
    if (theta < 0.05 || phi < 0.05)
        return error_set(err, ERROR_USAGE,
                         "--grid %dx%d has steps of %.3g x %.3g degrees, required: at least "
                         "0.05",
                         grid[0], grid[1], theta, phi);
    instrument->theta_step_deg = instrument->brdf_theta_step_deg = theta;
    instrument->phi_step_deg = instrument->brdf_phi_step_deg = phi;
    return true;
}

static Outcome run_simulate(int argc, char **argv, Arena *arena, Error *err) {
    Cli cli;
    SyntheticPanel panel;
    const char *folder = NULL;
    double at[5];
    int noise = 0, grid[2] = {0, 0};
    double place[2] = {0.5, 0.5};
    bool wants_truth = false, has_grid = false, has_place = false;
    const Option options[] = {
        {"-o", OPTION_TEXT, "DIR", "folder for MANIFEST.json and its tables", &folder,
         .file = OPTION_OUTPUT},
        {"--truth", OPTION_NUMBERS, "THETA,PHI,R,G,B",
         "print the recipe's exact value instead: degrees and codes", at, -360, 360, 5,
         &wants_truth},
        {"--at", OPTION_NUMBERS, "U,V",
         "of --truth: place on the active area, 0 to 1 from its upper left corner, right and "
         "down (default 0.5,0.5)",
         place, 0, 1, 2, &has_place},
        {"--noise", OPTION_CHOICE, "recipe|off", "the instrument's noise (default recipe)", &noise},
        {"--grid", OPTION_SIZE, "RINGSxAZIMUTHS",
         "directions of every table up to the cone, instead of the recipe's steps", grid,
         .given = &has_grid},
    };
    const CliCommand command = {
        "panel simulate",
        command_panel_simulate.summary,
        "RECIPE.json -o DIR",
        "parhelion panel simulate assets/panels/ips_cluster.recipe.json -o ips_cluster",
        options,
        COUNT_OF(options),
        1,
        1};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return OUTCOME_FAILED;
    if (cli.help_shown) return OUTCOME_DONE;
    if (!folder && !wants_truth) return error_set(err, ERROR_USAGE, "panel simulate wants -o DIR");
    if (has_place && !wants_truth)
        return error_set(err, ERROR_USAGE, "--at places the values of --truth; required: both");
    bool ok = synthetic_panel_read(cli.arguments[0], arena, &panel, err);
    if (ok && noise) switch_noise_off(&panel.instrument);
    if (ok && has_grid) ok = set_grid(&panel.instrument, grid, err);
    if (ok && wants_truth) {
        SyntheticPanel local = closed_form_at(&panel, place);
        ok = print_closed_form(&local, at, err);
    }
    if (ok && folder) ok = simulate_measurement(&panel, folder, cli.progress, err);
    return outcome_of(ok);
}

const Command command_panel_simulate = {
    "simulate", "a virtual Fourier-optics instrument writes a recipe's measurement set",
    run_simulate};
