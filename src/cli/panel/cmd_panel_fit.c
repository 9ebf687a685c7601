/* panel fit: from files of a laboratory to a panel file. */
#include <stdio.h>
#include <sys/resource.h>
#include <time.h>

#include "base/reference.h"
#include "cli/options/cli.h"
#include "cli/panel/panel_commands.h"
#include "panel/fit/fit.h"

#define ARENA_BYTES ((size_t)64 << 30) /* address space; pages cost nothing until touched */
#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

static void print_table(const json_t *table)
{
    printf("%-16s %10.0f %12.0f %9.0f %8.1f %9.2g %9.2g %9.2g %9.2g %6.2f%%\n",
           json_string_value(json_object_get(table, "name")),
           json_number_value(json_object_get(table, "source_bytes_text")),
           json_number_value(json_object_get(table, "stored_values")),
           json_number_value(json_object_get(table, "bytes")),
           json_number_value(json_object_get(table, "ratio")),
           json_number_value(json_object_get(table, "max_error")),
           json_number_value(json_object_get(table, "rms_error")),
           json_number_value(json_object_get(table, "integral_error")),
           json_number_value(json_object_get(table, "noise")),
           100 * json_number_value(json_object_get(table, "extrapolated_share")));
}

static void print_numbers(const char *key, const json_t *list)
{
    size_t  i;
    json_t *value;
    if (!json_is_number(json_array_get(list, 0))) return;
    printf(" %s", key);
    json_array_foreach((json_t *)list, i, value)
        printf("%s%.6g", i ? "," : " ", json_number_value(value));
    printf(";");
}

/* "a name": its text or numbers behind the line's label, for everything a fit has chosen. */
static void print_choices(const char *label, const json_t *choices)
{
    const char *key;
    json_t     *value;
    if (!choices) return;
    printf("%-10s", label);
    json_object_foreach((json_t *)choices, key, value) {
        if (json_is_string(value)) printf(" %s %s;", key, json_string_value(value));
        if (json_is_number(value)) printf(" %s %.4g;", key, json_number_value(value));
        if (json_is_boolean(value)) printf(" %s %s;", key, json_is_true(value) ? "yes" : "no");
        print_numbers(key, value);
    }
    printf("\n");
}

/* Samples that stand out, and directions that are missing: of a fit, not of a file. */
static void print_flags(const char *label, const json_t *flags)
{
    size_t  i;
    json_t *flag, *value;
    json_array_foreach((json_t *)flags, i, flag) {
        printf("%-10s %s, theta %.6g, phi %.6g", label,
               json_string_value(json_object_get(flag, "table")),
               json_number_value(json_object_get(flag, "theta_deg")),
               json_number_value(json_object_get(flag, "phi_deg")));
        if ((value = json_object_get(flag, "value")))
            printf(": %.5g cd/m2, expected %.5g", json_number_value(value),
                   json_number_value(json_object_get(flag, "expected")));
        printf("\n");
    }
}

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

void panel_print_report(const json_t *report)
{
    size_t  i;
    json_t *value;
    printf("panel      %s\nsource     %s (%s)\n",
           json_string_value(json_object_get(report, "panel")),
           json_string_value(json_object_get(report, "source")),
           json_string_value(json_object_get(report, "instrument")));
    print_choices("emission", json_object_get(report, "emission"));
    print_choices("reflection", json_object_get(report, "reflection"));
    json_array_foreach(json_object_get(report, "notes"), i, value)
        printf("note       %s\n", json_string_value(value));
    print_flags("outlier", json_object_get(report, "outliers"));
    print_flags("hole", json_object_get(report, "holes"));
    printf("errors are relative; sizes in bytes; trees are shared, a table's part is its even "
           "share\n%-16s %10s %12s %9s %8s %9s %9s %9s %9s %7s\n", "table", "text", "values",
           "bytes", "ratio", "max err", "rms err", "integral", "noise", "extrap.");
    json_array_foreach(json_object_get(report, "tables"), i, value) print_table(value);
    print_table(json_object_get(report, "total"));
    if ((value = json_object_get(report, "peak_memory_bytes")))
        printf("took       %.1f s of processor time, %.0f MB at most\n",
               json_number_value(json_object_get(report, "cpu_seconds")),
               1e-6 * json_number_value(value));
}

bool cmd_panel_fit(int argc, char **argv, Error *err)
{
    Arena       arena = arena_reserve(ARENA_BYTES);
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
        "parhelion panel fit measured/MANIFEST.json -o cluster.panel", options, COUNT(options),
        1, 1};
    if (!cli_parse(&command, argc, argv, &arena, &cli, err)) return false;
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
    Measurement *set = ARENA_NEW(&arena, Measurement, 1);
    json_t      *report = NULL;
    bool ok = reference_check_root(root, err) &&
              measurement_read_below(cli.arguments[0], root, &arena, set, err) &&
              panel_fit(set, &fit, output, &arena, &report, err);
    if (ok) add_usage(report);
    if (ok && cli.json) {
        ok = cli_print_json(report, err);
    } else if (ok) {
        panel_print_report(report);
        json_decref(report);
    }
    arena_release(&arena);
    return ok;
}
