/* panel fit: from files of a laboratory to a panel file. */
#include <stdio.h>
#include <sys/resource.h>
#include <time.h>

#include "base/count.h"
#include "base/reference.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "cli/panel/panel_print.h"
#include "panel/fit/fit.h"

/* What the process took. */
static void add_usage(json_t *report)
{
    struct rusage usage;
    struct timespec now;
    if (getrusage(RUSAGE_SELF, &usage) || clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now)) return;
    json_object_set_new(report, "peak_memory_bytes",
                        json_integer((json_int_t)usage.ru_maxrss * 1024));
    json_object_set_new(report, "cpu_seconds",
                        json_real((double)now.tv_sec + 1e-9 * (double)now.tv_nsec));
}

static bool run_fit(int argc, char **argv, Arena *arena, Error *err)
{
    Cli         cli;
    const char *output = NULL, *root = NULL;
    int         basis = 0, wavelet = 0, weights = 0, incidence = 0;
    long        level = 0;
    double      keep = 0, max_error = 0, frame = 0;
    bool        mask = false, lobe = false;
    const Option options[] = {
        {"-o", OPTION_TEXT, "X.panel", "the file to write", &output, .given = NULL},
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &root, .given = NULL},
        {"--basis", OPTION_CHOICE, "vertex|haar",
         "basis on the hemisphere (default vertex)", &basis, .given = NULL},
        {"--weights", OPTION_CHOICE, "area|equal",
         "Haar's means by area or equal (default area)", &weights, .given = NULL},
        {"--level", OPTION_INTEGER, "N",
         "subdivision level of the trees (default: what the samples need, up to 9)", &level,
         2, 9, .given = NULL},
        {"--keep", OPTION_NUMBER, "SHARE", "share of coefficients to keep, instead of a bound",
         &keep, 1e-5, 1, .given = NULL},
        {"--max-error", OPTION_NUMBER, "R",
         "relative error allowed at every sample besides its noise (default: 0.0025 for "
         "emission, 0.02 for reflection, or what the noise asks for)", &max_error, 1e-5, 1,
         .given = NULL},
        {"--mask-outliers", OPTION_FLAG, NULL,
         "errors leave out hot and dead pixels of emission tables", &mask, .given = NULL},
        {"--lobe-is-mirror", OPTION_FLAG, NULL,
         "a narrow peak on the haze is the mirror's image as wide as the instrument, where the "
         "set does not declare that width", &lobe, .given = NULL},
        {"--wavelet", OPTION_CHOICE, "principal|haar|cdf53|cdf97",
         "basis along the wavelengths: a few principal spectra, or a wavelet (default "
         "principal)", &wavelet, .given = NULL},
        {"--frame", OPTION_NUMBER, "K",
         "specular frame's exponent, 1 to 3 (default: the least error)", &frame, 1, 3,
         .given = NULL},
        {"--incidence", OPTION_CHOICE, "cubic|linear",
         "between incidences: four slices or two (default cubic)", &incidence, .given = NULL},
    };
    const CliCommand command = {"panel fit", "measurement files to one compressed panel file",
        "MANIFEST.json|TABLE.csv -o X.panel [options]",
        "parhelion panel fit measured/MANIFEST.json -o cluster.panel", options,
        COUNT_OF(options), 1, 1};
    if (!cli_parse(&command, argc, argv, arena, &cli, err)) return false;
    if (cli.help_shown) return true;
    if (!output) return error_set(err, ERROR_USAGE, "panel fit wants -o X.panel");
    if (keep > 0 && max_error > 0)
        return error_set(err, ERROR_USAGE, "--keep and --max-error exclude each other");
    FitOptions fit = fit_options_default();
    fit.level = (int)level;
    fit.has_wavelet = wavelet > 0;
    fit.wavelet = (WaveletKind)(wavelet > 0 ? wavelet - 1 : 0);
    fit.weights = weights ? HAAR_EQUAL : HAAR_AREA;
    fit.frame_exponent = (float)frame;
    fit.is_linear_in_incidence = incidence == 1;
    fit.progress = cli.progress;
    fit.threads = cli.threads;
    fit.basis = (FitBasis)basis;
    fit.mask_outliers = mask;
    fit.lobe_is_mirror = lobe;
    if (max_error > 0) fit.bound = (float)max_error;
    if (keep > 0) {
        fit.keep_share = (float)keep;
        fit.max_error = 0;
    }
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    json_t      *report = NULL;
    bool ok = reference_check_root(root, err) &&
              measurement_read_below(cli.arguments[0], root, arena, set, err) &&
              panel_fit(set, &fit, output, arena, &report, err);
    if (!ok) return false;
    add_usage(report);
    return panel_print_report(report, cli.json, err);
}

const Command command_panel_fit = {
    "fit", "measurement files to one compressed panel file", run_fit};
