/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion compare: are two frames, pictures or folders of them the same? */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "print/print.h"
#include "cli/commands.h"
#include "cli/compare_request.h"
#include "cli/options/answer.h"
#include "cli/options/outputs.h"
#include "compare/folders.h"
#include "compare/metrics.h"
#include "compare/report/comparison_json.h"
#include "compare/report/html_report.h"
#include "compare/report/junit.h"
#include "text/json_text.h"

#define FAILED_BYTES 4096

/* Results so far, for every kind of answer. */
typedef struct CompareRun {
    const CompareRequest *request;
    Arena *arena;
    HtmlReport html;
    Junit junit;
    json_t *pairs;                /* of folders */
    int count, different, failed; /* failed: could not be compared */
    ErrorCode first_failure;
} CompareRun;

static void start(const CompareRequest *request, bool is_folder, Arena *arena, CompareRun *run) {
    *run = (CompareRun){.request = request, .arena = arena, .pairs = json_array()};
    if (request->report) html_report_start(&run->html, is_folder);
    if (request->junit) junit_start(&run->junit);
}

static void end(CompareRun *run) {
    if (run->request->report) html_report_release(&run->html);
    if (run->request->junit) junit_release(&run->junit);
    json_decref(run->pairs);
}

static bool collect(CompareRun *run, const char *name, const Comparison *c,
                    const CompareOptions *options, Arena scratch, Error *err) {
    run->count++;
    run->different += !c->same;
    if (run->request->junit) junit_add(&run->junit, name, c);
    return !run->request->report || html_report_add(&run->html, name, c, options, scratch, err);
}

static bool write_files(const CompareRun *run, Error *err) {
    const CompareRequest *r = run->request;
    if (r->report && !html_report_write(&run->html, r->reference, r->test, r->report, err))
        return false;
    return !r->junit || junit_write(&run->junit, "parhelion compare", r->junit, err);
}

static bool wants_json(const CompareRequest *request) {
    return request->cli.json || request->answer;
}

/* Into the file and to stdout, as far as they are requested; releases it. */
static bool answer_json(const CompareRequest *request, json_t *document, Error *err) {
    if (request->answer && !cli_write_json(document, request->answer, err)) {
        json_decref(document);
        return false;
    }
    if (request->cli.json) return cli_print_json(document, err);
    json_decref(document);
    return true;
}

/* ---- as text ----------------------------------------------------------------------------- */

static bool is_known(const Comparison *c, Metric metric) {
    return !isnan(c->value[metric]);
}

static void print_flip(const Comparison *c) {
    if (!is_known(c, METRIC_FLIP)) return;
    print("%-12s %.4g, median %.4g, p95 %.4g, max %.4g", "flip", c->value[METRIC_FLIP],
          c->value[METRIC_FLIP_MEDIAN], c->value[METRIC_FLIP_P95], c->value[METRIC_FLIP_MAX]);
    if (c->reference.kind == INPUT_FRAME)
        print(" (%d exposures, EV %.1f to %.1f)", c->exposures.count,
              ev_of_stops(c->exposures.stop_ev), ev_of_stops(c->exposures.start_ev));
    print("\n");
}

static void print_errors(const Comparison *c) {
    const char *unit = c->reference.kind == INPUT_FRAME ? " cd/m2" : "";
    if (is_known(c, METRIC_MEAN_SHIFT))
        print("%-12s %+.4g %%\n", "mean_shift", 100 * c->value[METRIC_MEAN_SHIFT]);
    if (is_known(c, METRIC_MSE))
        print("%-12s mae %.4g%s, mse %.4g, relmse %.4g, max %.4g%s\n", "error",
              c->value[METRIC_MAE], unit, c->value[METRIC_MSE], c->value[METRIC_RELMSE],
              c->value[METRIC_MAX_DIFFERENCE], unit);
    if (is_known(c, METRIC_PSNR)) print("%-12s %.4g dB\n", "psnr", c->value[METRIC_PSNR]);
    if (is_known(c, METRIC_SSIM)) print("%-12s %.6g\n", "ssim", c->value[METRIC_SSIM]);
    if (is_known(c, METRIC_DELTAE_MEAN))
        print("%-12s mean %.4g, p95 %.4g, max %.4g\n", "deltae", c->value[METRIC_DELTAE_MEAN],
              c->value[METRIC_DELTAE_P95], c->value[METRIC_DELTAE_MAX]);
}

static void print_statistic(const StatisticResult *s) {
    print("%-12s p = %.3g, %.3g %% of %d x %d blocks beyond the level, mean %+.4g %%\n", "stat",
          s->p_value, 100 * s->fraction_failed, s->blocks_x, s->blocks_y, 100 * s->mean_shift);
    for (int i = 0; i < s->region_count; i++) {
        const StatisticRegion *r = &s->regions[i];
        if (r->moved)
            print("%-12s %s: %.5g to %.5g cd/m2, %+.3g +- %.2g %% (p = %.2g)\n", "  moved", r->name,
                  r->reference, r->test, 100 * r->shift, 196 * r->shift_sigma, r->p_value);
    }
}

static void print_contrasts(const Comparison *c) {
    for (int i = 0; i < c->contrast_count; i++) {
        const ContrastChange *d = &c->contrasts[i];
        print("%-12s %s: %.4g : 1 to %.4g : 1, %+.3g", "contrast", d->display,
              d->reference.contrast.value, d->test.contrast.value, 100 * (d->ratio.value - 1));
        if (isfinite(d->ratio.low)) print(" +- %.2g", 100 * measured_half_width(d->ratio));
        print(" %%\n");
    }
}

/* Metrics, notes and the verdict of two files. */
static void compare_print_pair(const CompareRequest *request, const Comparison *c) {
    if (c->has_pixels) {
        print_contrasts(c);
        if (c->has_stat) print_statistic(&c->stat);
        print("%-12s %ld of %ld differ\n", "pixels", c->channels.differing, c->selection.pixels);
        print_errors(c);
        print_flip(c);
    }
    for (int i = 0; i < c->notes.count; i++) print("note: %s\n", c->notes.list[i]);
    for (int i = 0; i < c->reasons.count && c->reasons.count > 1; i++)
        print("reason: %s\n", c->reasons.list[i]);
    if (request->report) print("report: %s\n", request->report);
    print("%s: %s%s%s\n", c->same ? "same" : "different", c->verdict, c->mean[0] ? ". " : "",
          c->mean);
}

/* One line for a pair of two folders. */
static void compare_print_line(const char *name, const Comparison *c) {
    print("%-10s %s: %s", c->same ? "same" : "different", name, c->verdict);
    if (c->has_pixels && is_known(c, METRIC_FLIP) && c->channels.differing > 0)
        print(" [flip %.3g]", c->value[METRIC_FLIP]);
    print("\n");
}

/* ---- two files --------------------------------------------------------------------------- */

static Outcome compare_two(CompareRun *run, Error *err) {
    const CompareRequest *r = run->request;
    Comparison c;
    if (!compare_files(r->reference, r->test, &r->options, run->arena, &c, err) ||
        !collect(run, r->test, &c, &r->options, *run->arena, err) || !write_files(run, err) ||
        (wants_json(r) && !answer_json(r, comparison_json(&c, &r->options), err)))
        return OUTCOME_FAILED;
    if (!r->cli.json) compare_print_pair(r, &c);
    return c.same ? OUTCOME_DONE : OUTCOME_NO;
}

/* ---- two folders ------------------------------------------------------------------------- */

static void add_pair_json(CompareRun *run, const char *name, json_t *pair) {
    json_object_set_new(pair, "name", json_text(name));
    json_array_append_new(run->pairs, pair);
}

/* A file that is on one side only. */
static void add_missing(CompareRun *run, const char *name, const char *why) {
    run->count++;
    run->different++;
    if (run->request->junit) junit_add_failure(&run->junit, name, why, false);
    if (run->request->report) html_report_add_failure(&run->html, name, why);
    if (!run->request->cli.json) print("%-10s %s: %s\n", "different", name, why);
    add_pair_json(run, name,
                  json_pack("{s:b, s:o, s:[o], s:[]}", "same", 0, "verdict", json_text(why),
                            "reasons", json_text(why), "notes"));
}

/* A pair that cannot be compared: said on stderr, and the others go on. */
static void add_failed(CompareRun *run, const char *name, const Error *error) {
    char line[2048];
    run->count++;
    run->failed++;
    if (run->first_failure == ERROR_NONE) run->first_failure = error->code;
    cli_error_line(error, line, (int)sizeof line);
    print_to(stderr, "%s\n", line);
    if (run->request->junit) junit_add_failure(&run->junit, name, line, true);
    if (run->request->report) html_report_add_failure(&run->html, name, line);
    if (!run->request->cli.json) print("%-10s %s: see the error\n", "failed", name);
    add_pair_json(run, name,
                  json_pack("{s:b, s:[o], s:[], s:{s:i, s:o, s:o}}", "same", 0, "reasons",
                            json_text(line), "notes", "error", "status",
                            error_exit_status(error->code), "file", json_text(error->file),
                            "message", json_text(error->text)));
}

/* "noon" and "noon.exr" both name noon.exr. */
static bool is_named(const char *picture, const char *name) {
    size_t length = strlen(name);
    return !strncmp(picture, name, length) &&
           (!picture[length] || picture + length == path_ending(picture));
}

/* What was requested of this pair, or else of all. */
static const CompareOptions *options_of(const CompareRequest *request, const char *picture) {
    for (int i = 0; i < request->pair_count; i++)
        if (is_named(picture, request->pairs[i].name)) return &request->pairs[i].options;
    return &request->options;
}

static bool check_pairs(const CompareRequest *request, const FolderPairs *pairs, Error *err) {
    for (int i = 0; i < request->pair_count; i++) {
        const ComparePair *asked = &request->pairs[i];
        int k = 0;
        while (k < pairs->count && !is_named(pairs->list[k].name, asked->name)) k++;
        if (k == pairs->count)
            return error_at(err, ERROR_INPUT, request->pairs_file, asked->place,
                            "no picture is named %.200s, in neither %.200s nor %.200s", asked->name,
                            request->reference, request->test);
    }
    return true;
}

/* No output is a picture of a pair, or the mask of one. */
static bool spare_pairs(const CompareRequest *request, const FolderPairs *pairs, Error *err) {
    for (int i = 0; i < pairs->count; i++) {
        const FolderPair *pair = &pairs->list[i];
        const char *const files[] = {pair->reference, pair->test, pair->failed,
                                     options_of(request, pair->name)->selection.mask};
        if (!outputs_spare(&request->cli.outputs, files, COUNT_OF(files), err)) return false;
    }
    return true;
}

static bool add_compared(CompareRun *run, const FolderPair *pair, Arena arena, Error *err) {
    const CompareOptions *options = options_of(run->request, pair->name);
    Comparison c;
    Error why;
    if (!compare_files(pair->reference, pair->test, options, &arena, &c, &why)) {
        add_failed(run, pair->name, &why);
        return true;
    }
    if (!collect(run, pair->name, &c, options, arena, err)) return false;
    if (wants_json(run->request)) add_pair_json(run, pair->name, comparison_json(&c, options));
    if (!run->request->cli.json) compare_print_line(pair->name, &c);
    return true;
}

/* A picture that could not be made: whoever tried left the line that says why. */
static void add_not_made(CompareRun *run, const FolderPair *pair, Arena scratch) {
    FileBytes bytes;
    Error why;
    if (file_read_start(pair->failed, FAILED_BYTES, &scratch, &bytes, &why)) {
        char *line = arena_string(&scratch, (const char *)bytes.data, bytes.size);
        line[strcspn(line, "\r\n")] = '\0';
        error_at(&why, ERROR_INPUT, pair->failed, "", "it was not made: %.900s",
                 arena_printable(&scratch, line));
    }
    add_failed(run, pair->name, &why);
}

static bool add_pair(CompareRun *run, const FolderPair *pair, Error *err) {
    if (pair->failed) {
        add_not_made(run, pair, *run->arena);
        return true;
    }
    if (pair->reference && pair->test) return add_compared(run, pair, *run->arena, err);
    if (pair->reference) add_missing(run, pair->name, "is missing in the test");
    else if (!run->request->allow_extra)
        add_missing(run, pair->name, "is only in the test (--allow-extra lets that pass)");
    return true;
}

static bool print_total(const CompareRun *run, Error *err) {
    int same = run->count - run->different - run->failed;
    if (wants_json(run->request) &&
        !answer_json(run->request,
                     json_pack("{s:b, s:i, s:i, s:i, s:i, s:O}", "same", same == run->count,
                               "total", run->count, "equal", same, "different", run->different,
                               "failed", run->failed, "pairs", run->pairs),
                     err))
        return false;
    if (run->request->cli.json) return true;
    if (run->request->report) print("report: %s\n", run->request->report);
    print("%s: %d of %d pairs are the same", same == run->count ? "same" : "different", same,
          run->count);
    if (run->different) print(", %d differ", run->different);
    if (run->failed) print(", %d could not be compared", run->failed);
    print("\n");
    return true;
}

static Outcome compare_folders(CompareRun *run, Error *err) {
    const CompareRequest *r = run->request;
    FolderPairs pairs;
    if (!folders_match(r->reference, r->test, run->arena, &pairs, err) ||
        !check_pairs(r, &pairs, err) || !spare_pairs(r, &pairs, err))
        return OUTCOME_FAILED;
    Progress progress = progress_start(r->cli.progress, "compare", "pairs", pairs.count);
    for (int i = 0; i < pairs.count; i++) {
        progress_clear(&progress);
        if (!add_pair(run, &pairs.list[i], err)) return OUTCOME_FAILED;
        progress_update(&progress, i + 1);
    }
    progress_end(&progress, pairs.count);
    if (run->count == 0)
        return error_at(err, ERROR_INPUT, r->reference, "",
                        "there is no picture in this folder: nothing was compared");
    if (!write_files(run, err) || !print_total(run, err)) return OUTCOME_FAILED;
    if (!run->failed) return run->different ? OUTCOME_NO : OUTCOME_DONE;
    *err = (Error){.code = run->first_failure}; /* said already, pair by pair */
    return OUTCOME_FAILED;
}

static Outcome compare(const CompareRequest *request, Arena *arena, Error *err) {
    bool both = is_folder(request->reference);
    if (is_folder(request->test) != both)
        return error_set(err, ERROR_USAGE,
                         "%s is a folder and %s is not: required: two files "
                         "or two folders",
                         both ? request->reference : request->test,
                         both ? request->test : request->reference);
    if (request->pairs_file && !both)
        return error_set(err, ERROR_USAGE, "--pairs %s goes with two folders: %s is none",
                         request->pairs_file, request->reference);
    if ((request->report && !file_check_writable(request->report, err)) ||
        (request->junit && !file_check_writable(request->junit, err)) ||
        (request->answer && !file_check_writable(request->answer, err)))
        return OUTCOME_FAILED;
    CompareRun run;
    start(request, both, arena, &run);
    Outcome outcome = both ? compare_folders(&run, err) : compare_two(&run, err);
    end(&run);
    return outcome;
}

static Outcome run_compare(int argc, char **argv, Arena *arena, Error *err) {
    CompareRequest request = {0};
    if (!compare_parse(argc, argv, arena, &request, err)) return OUTCOME_FAILED;
    return request.cli.help_shown ? OUTCOME_DONE : compare(&request, arena, err);
}

const Command command_compare = {
    "compare", "are two frames, pictures or folders of them the same, given their noise?",
    run_compare};
