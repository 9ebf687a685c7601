/* SPDX-License-Identifier: Apache-2.0 */
/* The command line of `parhelion compare`. */
#include <math.h>
#include <string.h>

#include "base/count.h"
#include "cli/compare_request.h"
#include "compare/report/html_report.h"
#include "image/exposure.h"
#include "text/nearest_word.h"

#define EV_MOST 60

/* Lists as they were typed. */
typedef struct CompareWords {
    CliTexts metrics, at_most, at_least, ignored;
    double   region[4];
    bool     has_level;
} CompareWords;

/* ---- names of metrics -------------------------------------------------------------------- */

static bool unknown_metric(const char *option, const char *name, Error *err)
{
    const char *names[METRIC_COUNT];
    char        advice[512];
    for (int i = 0; i < METRIC_COUNT; i++) names[i] = metric_info((Metric)i)->name;
    return error_set(err, ERROR_USAGE, "%s: there is no figure %s — %s", option, name,
                     nearest_word_advice(name, names, METRIC_COUNT, advice,
                                         (int)sizeof advice));
}

static bool read_groups(const CliTexts *texts, Arena *arena, CompareOptions *out, Error *err)
{
    for (int i = 0; i < texts->count; i++) {
        for (const char *word = texts->list[i]; *word;) {
            size_t      length = strcspn(word, ",");
            const char *name = arena_string(arena, word, length);
            unsigned    group = metric_group_find(name);
            if (!group) return unknown_metric("--metric", name, err);
            out->groups |= group;
            out->wants_stat = out->wants_stat || group == GROUP_STAT;
            word += length + (word[length] == ',');
        }
    }
    return true;
}

static bool read_limit(const char *text, bool is_min, Arena *arena, Threshold *out, Error *err)
{
    const char *option = is_min ? "--min" : "--max", *name, *value;
    if (!cli_name_value(option, text, arena, &name, &value, err)) return false;
    Metric metric = metric_find(name);
    if (metric == METRIC_COUNT) return unknown_metric(option, name, err);
    if (metric_info(metric)->is_min != is_min)
        return error_set(err, ERROR_USAGE, "%s %s: %s is the better the %s it is — say %s %s",
                         option, text, name, is_min ? "smaller" : "greater",
                         is_min ? "--max" : "--min", text);
    *out = (Threshold){.metric = metric};
    return cli_numbers(value, 1, &out->limit) ||
           error_set(err, ERROR_USAGE, "%s %s: %s is no number", option, text, value);
}

static bool read_limits(const CompareWords *words, Arena *arena, CompareOptions *out,
                        Error *err)
{
    int        room = words->at_most.count + words->at_least.count;
    Threshold *list = ARENA_NEW(arena, Threshold, room);
    for (int i = 0; i < room; i++) {
        bool        is_min = i >= words->at_most.count;
        const char *text = is_min ? words->at_least.list[i - words->at_most.count]
                                  : words->at_most.list[i];
        if (!read_limit(text, is_min, arena, &list[i], err)) return false;
    }
    out->thresholds = list;
    out->threshold_count = room;
    return true;
}

/* ---- the rest ---------------------------------------------------------------------------- */

static bool read_region(const CompareWords *words, SelectionRequest *out, Error *err)
{
    const double *r = words->region;
    for (int i = 0; i < 4 && out->has_region; i++)
        if (r[i] != floor(r[i]))
            return error_set(err, ERROR_USAGE, "--region: %g is no whole number of pixels",
                             r[i]);
    if (out->has_region) out->region = (ExrWindow){(int)r[0], (int)r[1], (int)r[2], (int)r[3]};
    return true;
}

static bool finish(const CompareWords *words, Arena *arena, CompareRequest *out, Error *err)
{
    CompareOptions *o = &out->options;
    ExposureRequest unused;
    out->reference = out->cli.arguments[0];
    out->test = out->cli.arguments[1];
    o->wants_stat = words->has_level;
    o->threads = out->cli.threads;
    o->rules.ignored = words->ignored.list;
    o->rules.ignored_count = words->ignored.count;
    if (o->has_range && o->range_ev[0] > o->range_ev[1])
        return error_set(err, ERROR_USAGE, "--exposure-range %g,%g: wanted A,B with A <= B",
                         o->range_ev[0], o->range_ev[1]);
    return (!o->exposure || exposure_parse(o->exposure, &unused, err)) &&
           (!out->report || html_report_check_name(out->report, err)) &&
           read_region(words, &o->selection, err) &&
           read_groups(&words->metrics, arena, o, err) && read_limits(words, arena, o, err);
}

bool compare_parse(int argc, char **argv, Arena *arena, CompareRequest *out, Error *err)
{
    CompareWords words = {0};
    CompareOptions *o = &out->options;
    const Option options[] = {
        {"--max", OPTION_TEXTS, "METRIC=VALUE",
         "different when a figure is above: flip, flip_p95, flip_max, deltae_mean, deltae_p95, "
         "deltae_max, mse, relmse, mae, max_difference, mean_shift, differing, "
         "fraction_failed, contrast_change (changes and shares: 0.01 is 1 %)",
         .out = &words.at_most},
        {"--min", OPTION_TEXTS, "METRIC=VALUE", "or below: psnr, ssim, p_value",
         .out = &words.at_least},
        {"--metric", OPTION_TEXTS, "flip|mse|psnr|ssim|deltae|stat|contrast",
         "compute these only (default: all)", .out = &words.metrics},
        {"--level", OPTION_NUMBER, "P",
         "share of false alarms of the statistical test (default 0.01), which then judges "
         "besides the limits", .out = &o->level, .low = 1e-12, .high = 0.5,
         .given = &words.has_level},
        {"--report", OPTION_TEXT, "OUT.html", "one page to look at it", .out = &out->report,
         .file = OPTION_OUTPUT},
        {"--junit", OPTION_TEXT, "FILE.xml", "the answer for a CI service", .out = &out->junit,
         .file = OPTION_OUTPUT},
        {"--mask", OPTION_TEXT, "FILE.png", "a picture of the same size: black is left out",
         .out = &o->selection.mask},
        {"--region", OPTION_NUMBERS, "X0,Y0,X1,Y1",
         "pixels, half-open, the origin at the top left (default: all)", .out = words.region,
         .low = -65536, .high = 65536, .count = 4, .given = &o->selection.has_region},
        {"--display", OPTION_TEXT, "NAME", "only pixels that show this display (material)",
         .out = &o->selection.display},
        {"--exposure-range", OPTION_NUMBERS, "A,B",
         "HDR-FLIP looks at exposure values from A to B (as develop --exposure: 15 is full "
         "sun; default: from the reference)", .out = o->range_ev, .low = -EV_MOST,
         .high = EV_MOST, .count = 2, .given = &o->has_range},
        {"--exposure", OPTION_TEXT, "auto|EV|white:CD_M2",
         "that frames are developed with for ssim and deltae (default: auto, of the "
         "reference)", .out = &o->exposure},
        {"--ignore", OPTION_TEXTS, "NAME",
         "leave out a metadata key, channel or layer", .out = &words.ignored},
        {"--strict", OPTION_FLAG, NULL,
         "different program, seed, inputs ..., and layers of one side, are failures too",
         .out = &o->rules.strict},
        {"--allow-extra", OPTION_FLAG, NULL,
         "of folders: files that only the test has are no failure", .out = &out->allow_extra},
    };
    const CliCommand command = {
        "compare", "are two frames, pictures or folders of them the same, given their noise?",
        "REFERENCE TEST [--max METRIC=VALUE ...] [--report OUT.html]",
        "parhelion compare before.exr after.exr --max flip=0.05 --report after.html",
        options, COUNT_OF(options), 2, 2};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    return out->cli.help_shown || finish(&words, arena, out, err);
}
