/* SPDX-License-Identifier: Apache-2.0 */
/* panel fit: from files of a laboratory to a panel file. */
#include <time.h>

#include "base/count.h"
#include "base/file.h"
#include "base/machine.h"
#include "base/reference.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_facts.h"
#include "panel/fit/fit.h"
#include "panel/fit/fit_judge.h"
#include "panel/query/panel_open.h"

/* The memory and CPU time of the process. */
static void add_usage(json_t *report) {
    struct timespec now;
    if (clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now)) return;
    json_object_set_new(report, "peak_memory_bytes",
                        json_integer((json_int_t)machine_peak_bytes()));
    json_object_set_new(report, "cpu_seconds",
                        json_real((double)now.tv_sec + 1e-9 * (double)now.tv_nsec));
}

/* The command line of `panel fit`. */
typedef struct FitWords {
    Cli cli;
    const char *output, *root, *levels;
    int basis; /* place in the list of the option */
    long level;
    double level_max, keep, max_error, error_floor, instrument_fwhm_deg;
    bool force;
} FitWords;

static bool parse(int argc, char **argv, Arena *arena, FitWords *out, Error *err) {
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.panel", "the file to write", &out->output, .file = OPTION_OUTPUT},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &out->root},
        {"--levels", OPTION_TEXT, "FILE.csv",
         "gamma table of a set of white alone: columns "
         "level and luminance (or red, green, blue), cd/m2 on the axis or relative",
         &out->levels},
        {"--level-max", OPTION_NUMBER, "N",
         "highest code of --levels (default: 255, 1023, "
         "4095 or 65535, whichever it ends at)",
         &out->level_max, 1, 65535},
        {"--basis", OPTION_CHOICE, "vertex|haar",
         "basis on the hemisphere (default vertex); haar: `parhelion help the-paper`", &out->basis},
        {"--level", OPTION_INTEGER, "N",
         "subdivision level of the trees (default: what the samples need, up to 9)", &out->level, 2,
         9},
        {"--keep", OPTION_NUMBER, "SHARE",
         "of the Haar basis: share of its coefficients (default: what 5 % of the source have "
         "room for)",
         &out->keep, 1e-5, 1},
        {"--max-error", OPTION_NUMBER, "R",
         "relative error allowed at every sample besides its noise (default: 0.0025 for "
         "emission, 0.02 for reflection, or what the noise needs)",
         &out->max_error, 1e-5, 1},
        {"--error-floor", OPTION_NUMBER, "PERCENT",
         "of an emission table's largest value: errors of what is less are relative to it "
         "(default 0.1)",
         &out->error_floor, 1e-4, 10},
        {"--instrument-fwhm", OPTION_NUMBER, "DEG", INSTRUMENT_FWHM_HELP, &out->instrument_fwhm_deg,
         INSTRUMENT_FWHM_LEAST, INSTRUMENT_FWHM_MOST},
        {"--force", OPTION_FLAG, NULL,
         "write the panel also where it is judged not usable; its report says so", &out->force},
    };
    const CliCommand command = {"panel fit",
                                command_panel_fit.summary,
                                "MANIFEST.json|TABLE.csv -o X.panel [options]",
                                "parhelion panel fit measured/MANIFEST.json -o cluster.panel",
                                options,
                                COUNT_OF(options),
                                1,
                                1,
                                .answers = (const Answer[]){{"", &panel_report_kind}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (out->cli.help_shown) return true;
    if (!out->output) return error_set(err, ERROR_USAGE, "panel fit wants -o X.panel");
    if (out->basis == FIT_HAAR && out->max_error > 0)
        return error_set(err, ERROR_USAGE,
                         "--max-error is for --basis vertex, --basis haar "
                         "has --keep");
    if (out->basis != FIT_HAAR && out->keep > 0)
        return error_set(err, ERROR_USAGE,
                         "--keep is for --basis haar, --basis vertex has "
                         "--max-error");
    return true;
}

static FitOptions options_of(const FitWords *words) {
    FitOptions fit = fit_options_default();
    fit.level = (int)words->level;
    fit.progress = words->cli.progress;
    fit.threads = words->cli.threads;
    fit.basis = (FitBasis)words->basis;
    fit.force = words->force;
    if (words->max_error > 0) fit.bound = (float)words->max_error;
    if (words->error_floor > 0) fit.error_floor = 0.01f * (float)words->error_floor;
    fit.keep_share = (float)words->keep;
    return fit;
}

/* Of every place; 0: as the set has it. */
static bool declare_width(Measurement *set, double fwhm_deg) {
    if (fwhm_deg > 0) set->instrument_fwhm_deg = fwhm_deg;
    for (int i = 0; i < set->spot_count; i++)
        set->spot[i].set->instrument_fwhm_deg = set->instrument_fwhm_deg;
    return true;
}

/* Read back from the file that was written. */
static bool add_facts(const char *path, json_t *report, Arena *arena, Error *err) {
    Panel *panel = NULL;
    if (!panel_open(path, arena, &panel, err)) return false;
    panel_facts_add(panel, report);
    panel_close(panel);
    return true;
}

/* As JSON the report of a panel that is not written is the answer; stderr has the reason. */
static Outcome print_refused(json_t *report, Error *err) {
    cli_report_error(err, false);
    return panel_print_report(report, true, err) ? OUTCOME_NO : OUTCOME_FAILED;
}

static Outcome run_fit(int argc, char **argv, Arena *arena, Error *err) {
    FitWords words = {0};
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    FitOptions fit = options_of(&words);
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    json_t *report = NULL;
    bool ok = reference_check_root(words.root, err) &&
              measurement_read_below(words.cli.arguments[0], words.root, arena, set, err) &&
              outputs_spare(&words.cli.outputs, set->inputs.list, set->inputs.count, err) &&
              declare_width(set, words.instrument_fwhm_deg) &&
              (!words.levels ||
               measurement_read_levels(set, words.levels, words.level_max, arena, err)) &&
              panel_fit(set, &fit, words.output, arena, &report, err);
    if (!ok && (!report || !words.cli.json)) {
        json_decref(report);
        return OUTCOME_FAILED;
    }
    add_usage(report);
    if (!ok) return print_refused(report, err);
    if (!add_facts(words.output, report, arena, err)) {
        json_decref(report);
        return OUTCOME_FAILED;
    }
    bool is_left_out =
        json_is_true(json_object_get(json_object_get(report, "judged"), JUDGE_LEFT_OUT));
    if (!panel_print_report(report, words.cli.json, err)) return OUTCOME_FAILED;
    return is_left_out ? OUTCOME_NO : OUTCOME_DONE;
}

const Command command_panel_fit = {"fit", "measurement files to one compressed panel file",
                                   run_fit};
