/* SPDX-License-Identifier: Apache-2.0 */
/* The command line of `parhelion compare`. */
#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "cli/commands.h"
#include "cli/compare_request.h"
#include "compare/report/html_report.h"
#include "image/exposure.h"
#include "text/nearest_word.h"
#include "text/text.h"

#define EV_MOST 60
#define REGION_MOST 65536
#define PAIRS_BYTES ((size_t)1 << 24)

/* Lists as they were typed. */
typedef struct CompareWords {
    CliTexts metrics, at_most, at_least, ignored, regions;
    bool has_level;
} CompareWords;

/* ---- names of metrics -------------------------------------------------------------------- */

static bool unknown_metric(const char *option, const char *name, Error *err) {
    const char *names[METRIC_COUNT];
    char advice[512];
    for (int i = 0; i < METRIC_COUNT; i++) names[i] = metric_info((Metric)i)->name;
    return error_set(err, ERROR_USAGE, "%s: there is no figure %s — %s", option, name,
                     nearest_word_advice(name, names, METRIC_COUNT, advice, (int)sizeof advice));
}

static bool read_groups(const CliTexts *texts, Arena *arena, CompareOptions *out, Error *err) {
    for (int i = 0; i < texts->count; i++) {
        for (const char *word = texts->list[i]; *word;) {
            size_t length = strcspn(word, ",");
            const char *name = arena_string(arena, word, length);
            unsigned group = metric_group_find(name);
            if (!group) return unknown_metric("--metric", name, err);
            out->groups |= group;
            out->wants_stat = out->wants_stat || group == GROUP_STAT;
            word += length + (word[length] == ',');
        }
    }
    return true;
}

static bool read_limit(const char *text, bool is_min, Arena *arena, Threshold *out, Error *err) {
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

static bool limits_it(const Threshold *list, int count, Metric metric) {
    int i = 0;
    while (i < count && list[i].metric != metric) i++;
    return i < count;
}

/* Limits of a pair go before those of all pairs that are of the same figure. */
static bool read_limits(const CompareWords *words, Arena *arena, CompareOptions *out, Error *err) {
    int own = words->at_most.count + words->at_least.count, count = own;
    Threshold *list = ARENA_NEW(arena, Threshold, own + out->threshold_count);
    for (int i = 0; i < own; i++) {
        bool is_min = i >= words->at_most.count;
        const char *text =
            is_min ? words->at_least.list[i - words->at_most.count] : words->at_most.list[i];
        if (!read_limit(text, is_min, arena, &list[i], err)) return false;
    }
    for (int i = 0; i < out->threshold_count; i++)
        if (!limits_it(list, own, out->thresholds[i].metric)) list[count++] = out->thresholds[i];
    out->thresholds = list;
    out->threshold_count = count;
    return true;
}

/* ---- the rest ---------------------------------------------------------------------------- */

static bool read_region(const char *text, ExrWindow *out, Error *err) {
    double r[4];
    if (!cli_numbers(text, 4, r))
        return error_set(err, ERROR_USAGE,
                         "--region %.200s: required X0,Y0,X1,Y1, four "
                         "numbers of pixels",
                         text);
    for (int i = 0; i < 4; i++)
        if (r[i] != floor(r[i]) || fabs(r[i]) > REGION_MOST)
            return error_set(err, ERROR_USAGE,
                             "--region: %g is no whole number of pixels "
                             "from %d to %d",
                             r[i], -REGION_MOST, REGION_MOST);
    *out = (ExrWindow){(int)r[0], (int)r[1], (int)r[2], (int)r[3]};
    return true;
}

static bool read_regions(const CliTexts *texts, Arena *arena, SelectionRequest *out, Error *err) {
    ExrWindow *list = ARENA_NEW(arena, ExrWindow, texts->count);
    for (int i = 0; i < texts->count; i++)
        if (!read_region(texts->list[i], &list[i], err)) return false;
    if (texts->count == 0) return true;
    out->regions = list;
    out->region_count = texts->count;
    return true;
}

static void add_ignored(const CliTexts *texts, Arena *arena, CompareRules *out) {
    const char **list = ARENA_NEW(arena, const char *, out->ignored_count + texts->count);
    for (int i = 0; i < out->ignored_count; i++) list[i] = out->ignored[i];
    for (int i = 0; i < texts->count; i++) list[out->ignored_count++] = texts->list[i];
    out->ignored = list;
}

/* `out` holds what goes for all pairs where the words are those of one. A pair with limits of
 * its own is judged by them: by the statistical test as well where it has its own level. */
static bool read_options(const CompareWords *words, Arena *arena, CompareOptions *out, Error *err) {
    ExposureRequest unused;
    if (words->at_most.count || words->at_least.count) out->wants_stat = false;
    if (words->metrics.count) out->groups = 0;
    out->wants_stat = out->wants_stat || words->has_level;
    add_ignored(&words->ignored, arena, &out->rules);
    if (out->has_range && out->range_ev[0] > out->range_ev[1])
        return error_set(err, ERROR_USAGE, "--exposure-range %g,%g: required: A,B with A <= B",
                         out->range_ev[0], out->range_ev[1]);
    return (!out->exposure || exposure_parse(out->exposure, &unused, err)) &&
           read_regions(&words->regions, arena, &out->selection, err) &&
           read_groups(&words->metrics, arena, out, err) && read_limits(words, arena, out, err);
}

static bool parse_line(int argc, char **argv, Arena *arena, CompareWords *words,
                       CompareRequest *out, Error *err) {
    CompareOptions *o = &out->options;
    const Option options[] = {
        {"--max", OPTION_TEXTS, "METRIC=VALUE",
         "different when a figure is above: flip, flip_p95, flip_max, deltae_mean, deltae_p95, "
         "deltae_max, mse, relmse, mae, max_difference, mean_shift, differing, "
         "fraction_failed, contrast_change (changes and shares: 0.01 is 1 %). Without a limit "
         "frames are judged by their noise: no mean moved, and no single pixel is 10 times "
         "brighter than all around it and beyond 4 of its standard errors; all others by "
         "equality",
         .out = &words->at_most},
        {"--min", OPTION_TEXTS, "METRIC=VALUE", "or below: psnr, ssim, p_value",
         .out = &words->at_least},
        {"--metric", OPTION_TEXTS, "flip|mse|psnr|ssim|deltae|stat|contrast",
         "compute these only (default: all)", .out = &words->metrics},
        {"--level", OPTION_NUMBER, "P",
         "share of false alarms of the statistical test (default 0.01), which then judges "
         "besides the limits",
         .out = &o->level, .low = 1e-12, .high = 0.5, .given = &words->has_level},
        {"--report", OPTION_TEXT, "OUT.html", "one page to look at it", .out = &out->report,
         .file = OPTION_OUTPUT},
        {"--junit", OPTION_TEXT, "FILE.xml", "the answer for a CI service", .out = &out->junit,
         .file = OPTION_OUTPUT},
        {"--answer", OPTION_TEXT, "FILE.json", "the document of --json, as a file besides",
         .out = &out->answer, .file = OPTION_OUTPUT},
        {"--mask", OPTION_TEXT, "FILE.png", "a picture of the same size: black is left out",
         .out = &o->selection.mask},
        {"--region", OPTION_TEXTS, "X0,Y0,X1,Y1",
         "pixels, half-open, the origin at the top left (default: all)", .out = &words->regions},
        {"--display", OPTION_TEXT, "NAME", "only pixels that show this display (material)",
         .out = &o->selection.display},
        {"--exposure-range", OPTION_NUMBERS, "A,B",
         "HDR-FLIP looks at exposure values from A to B (as develop --exposure: 15 is full "
         "sun; default: from the reference)",
         .out = o->range_ev, .low = -EV_MOST, .high = EV_MOST, .count = 2, .given = &o->has_range},
        {"--exposure", OPTION_TEXT, "auto|EV|white:CD_M2",
         "that frames are developed with for ssim and deltae (default: auto, of the "
         "reference)",
         .out = &o->exposure},
        {"--ignore", OPTION_TEXTS, "NAME", "leave out a metadata key, channel or layer",
         .out = &words->ignored},
        {"--strict", OPTION_FLAG, NULL,
         "different program, seed, inputs ..., and layers of one side, are failures too",
         .out = &o->rules.strict},
        {"--allow-extra", OPTION_FLAG, NULL,
         "of folders: files that only the test has are no failure", .out = &out->allow_extra},
        {"--pairs", OPTION_TEXT, "FILE",
         "of folders: a line for each pair that has limits, masks, regions ... of its own: "
         "its name and such options",
         .out = &out->pairs_file},
    };
    const CliCommand command = {
        "compare",
        command_compare.summary,
        "REFERENCE TEST [--max METRIC=VALUE ...] [--report OUT.html]",
        "parhelion compare before.exr after.exr --max flip=0.05 --report after.html",
        options,
        COUNT_OF(options),
        2,
        2,
        .answers = compare_answers};
    return cli_parse(&command, argc, argv, arena, &out->cli, err);
}

/* ---- pairs with options of their own ----------------------------------------------------- */

/* What is not about one pair. */
static bool check_pair_words(const Lines *words, Error *err) {
    static const char *const others[] = {"--report",      "--junit", "--answer", "--pairs",
                                         "--allow-extra", "--json",  "--quiet",  "--progress",
                                         "--threads",     "--"};
    for (int i = 1; i < words->count; i++) {
        bool is_other = cli_is_help(words->list[i]) || cli_is_version(words->list[i]);
        for (int k = 0; k < COUNT_OF(others); k++)
            is_other = is_other || cli_is_option(words->list[i], others[k]);
        if (is_other)
            return error_set(err, ERROR_INPUT, "%.200s does not go for one pair", words->list[i]);
    }
    return true;
}

static bool parse_pair(const Lines *words, const CompareRequest *all, Arena *arena,
                       ComparePair *out, Error *err) {
    CompareWords typed = {0};
    CompareRequest own = {.options = all->options};
    int count = words->count + 2;
    char **argv = ARENA_NEW(arena, char *, count);
    const char *first[] = {"compare", all->reference, all->test};
    for (int i = 0; i < count; i++) {
        const char *word = i < 3 ? first[i] : words->list[i - 2];
        argv[i] = arena_string(arena, word, strlen(word));
    }
    if (!check_pair_words(words, err) || !parse_line(count, argv, arena, &typed, &own, err) ||
        !read_options(&typed, arena, &own.options, err))
        return false;
    out->name = words->list[0];
    out->options = own.options;
    return true;
}

static bool add_pair(const Lines *words, const char *place, Arena *arena, CompareRequest *out,
                     Error *err) {
    ComparePair *pair = &out->pairs[out->pair_count];
    for (int i = 0; i < out->pair_count; i++)
        if (!strcmp(out->pairs[i].name, words->list[0]))
            return error_at(err, ERROR_INPUT, out->pairs_file, place,
                            "%.200s stands in %s already: required at most once", words->list[0],
                            out->pairs[i].place);
    Error why;
    if (!parse_pair(words, out, arena, pair, &why))
        return error_at(err, ERROR_INPUT, out->pairs_file, place, "%s", why.text);
    pair->place = place;
    out->pair_count++;
    return true;
}

/* Empty lines and those that begin with # say nothing. */
static bool read_pairs(Arena *arena, CompareRequest *out, Error *err) {
    FileBytes bytes;
    int lines = 1;
    if (!file_read(out->pairs_file, PAIRS_BYTES, arena, &bytes, err)) return false;
    const char *text;
    if (!file_text(out->pairs_file, &bytes, &text, err)) return false;
    for (const char *c = text; *c; c++) lines += *c == '\n';
    out->pairs = ARENA_NEW(arena, ComparePair, lines);
    for (int i = 1; i <= lines; i++) {
        size_t length = strcspn(text, "\n");
        const char *place = arena_format(arena, "line %d", i);
        Lines words = {.arena = arena};
        if (!shell_words(arena_string(arena, text, length), &words))
            return error_at(err, ERROR_INPUT, out->pairs_file, place, "a quote is open");
        text += length + 1;
        if (words.count && words.list[0][0] != '#' && !add_pair(&words, place, arena, out, err))
            return false;
    }
    return true;
}

bool compare_parse(int argc, char **argv, Arena *arena, CompareRequest *out, Error *err) {
    CompareWords words = {0};
    if (!parse_line(argc, argv, arena, &words, out, err)) return false;
    if (out->cli.help_shown) return true;
    out->reference = out->cli.arguments[0];
    out->test = out->cli.arguments[1];
    out->options.threads = out->cli.threads;
    return (!out->report || html_report_check_name(out->report, err)) &&
           read_options(&words, arena, &out->options, err) &&
           (!out->pairs_file || read_pairs(arena, out, err));
}
