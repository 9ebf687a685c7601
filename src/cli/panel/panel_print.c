/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/panel_print.h"

#include <stdio.h>

#include "cli/options/answer.h"
#include "cli/panel/panel_facts.h"

static void print_table(const json_t *table)
{
    printf("%-16s %10.0f %12.0f %9.0f %8.1f %8.3g%% %8.2g%% %8.2g%% %8.2g%% %6.2f%%\n",
           json_string_value(json_object_get(table, "name")),
           json_number_value(json_object_get(table, "source_bytes_text")),
           json_number_value(json_object_get(table, "stored_values")),
           json_number_value(json_object_get(table, "bytes")),
           json_number_value(json_object_get(table, "ratio")),
           100 * json_number_value(json_object_get(table, "max_error")),
           100 * json_number_value(json_object_get(table, "rms_error")),
           100 * json_number_value(json_object_get(table, "integral_error")),
           100 * json_number_value(json_object_get(table, "noise")),
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

/* The verdict and why; files from before verdicts have none. */
static void print_verdict(const json_t *report)
{
    size_t      i;
    json_t     *reason;
    const char *verdict = json_string_value(json_object_get(report, "verdict"));
    printf("verdict    %s\n", verdict ? verdict : "none in this file: fit the set again");
    json_array_foreach(json_object_get(report, "reasons"), i, reason)
        printf("reason     %s\n", json_string_value(reason));
}

static void print_text(const json_t *report)
{
    size_t  i;
    json_t *value;
    printf("panel      %s\nsource     %s (%s)\n",
           json_string_value(json_object_get(report, "panel")),
           json_string_value(json_object_get(report, "source")),
           json_string_value(json_object_get(report, "instrument")));
    print_verdict(report);
    panel_facts_print(report);
    print_choices("emission", json_object_get(report, "emission"));
    print_choices("reflection", json_object_get(report, "reflection"));
    json_array_foreach(json_object_get(report, "notes"), i, value)
        printf("note       %s\n", json_string_value(value));
    print_flags("outlier", json_object_get(report, "outliers"));
    print_flags("hole", json_object_get(report, "holes"));
    printf("each table: bytes of its text; numbers and bytes that the panel keeps of it (an "
           "even share of what all share); how many times smaller than 32-bit numbers that "
           "is;\nerrors relative to the measured values: the largest, the root of the mean "
           "square, that of the hemispherical integral; the table's own noise; share of the "
           "hemisphere that was not measured\n%-16s %10s %12s %9s %8s %9s %9s %9s %9s %7s\n",
           "table", "text", "values", "bytes", "ratio", "max err", "rms err", "integral",
           "noise", "extrap.");
    json_array_foreach(json_object_get(report, "tables"), i, value) print_table(value);
    print_table(json_object_get(report, "total"));
    if ((value = json_object_get(report, "peak_memory_bytes")))
        printf("took       %.1f s of processor time, %.0f MB at most\n",
               json_number_value(json_object_get(report, "cpu_seconds")),
               1e-6 * json_number_value(value));
}

bool panel_print_report(json_t *report, bool as_json, Error *err)
{
    if (as_json) return cli_print_json(report, err);
    print_text(report);
    json_decref(report);
    return true;
}
