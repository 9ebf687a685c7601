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
#include "compare/headline.h"
#include "compare/report/answer.h"
#include "compare/report/html_report.h"

#define FAILED_BYTES 4096

/* Results so far, for every kind of answer. */
typedef struct CompareRun {
    const CompareRequest *request;
    Arena *arena;
    HtmlReport html;
    CompareAnswer answer;
    ErrorCode first_failure;
} CompareRun;

static void start(const CompareRequest *request, bool is_folder, Arena *arena, CompareRun *run) {
    *run = (CompareRun){.request = request, .arena = arena};
    answer_start(&run->answer);
    if (request->report) html_report_start(&run->html, is_folder);
}

static void end(CompareRun *run) {
    if (run->request->report) html_report_release(&run->html);
    answer_release(&run->answer);
}

/* folders: the document of both; NULL of two files. */
static bool write_files(const CompareRun *run, const json_t *folders, Error *err) {
    const CompareRequest *r = run->request;
    const char *const sides[2] = {r->reference, r->test};
    if (r->report && !html_report_write(&run->html, folders, sides, r->report, err)) return false;
    return !r->junit || answer_write_junit(&run->answer, r->junit, err);
}

/* ---- the answers ------------------------------------------------------------------------- */

static const Column ROWS[] = {COLUMN_TEXT("label", "figure"),
                              COLUMN_TEXT("text", "found"),
                              {.key = "limit", .words = "limit", .none = ""},
                              {.key = "verdict",
                               .words = "verdict",
                               .none = "",
                               .about = "`within`, `beyond`, `moved`, `below the noise`, or empty"},
                              COLUMN_KEY("figure", "its name"),
                              COLUMN_KEY("of", "display or region; empty: all"),
                              COLUMN_KEY("reference", "null: the figure is of both, as `test`"),
                              COLUMN_KEY("test", NULL),
                              COLUMN_KEY("value", "the figure, or test / reference - 1"),
                              COLUMN_KEY("half_width", "of its 95 % interval; null: not known"),
                              COLUMN_KEY("p", "of the statistical test; or null"),
                              COLUMN_KEY("change", "`value` in words"),
                              COLUMN_KEY("is_key", "one of the page's first figures")};
static const TableKind ROWS_KIND = TABLE_KIND("rows", NULL, ROWS);

#define OUTCOMES \
    "`same` (no value differs), `same light`, `within noise`, `within limits`, `different`"

static const Column PAIR[] = {
    {.key = "rows", .of = &ROWS_KIND},
    {.key = "notes", .words = "note", .about = "one for all metadata"},
    COLUMN_TEXT("reasons", "reason"),
    COLUMN_KEY("name", "of the test"),
    COLUMN_KEY("reference", "the file, as `test`"),
    COLUMN_KEY("test", NULL),
    COLUMN_KEY("same", "the exit status is 0"),
    COLUMN_KEY("outcome", OUTCOMES),
    COLUMN_KEY("verdict", "the headline"),
    COLUMN_KEY("judged_by", "`limits`, `stat`, `equality`"),
    COLUMN_KEY("metrics", "by their names"),
    COLUMN_KEY("limits", "`metric`, `kind` (`min`, `max`), `limit`, `value`, `holds` of each"),
    COLUMN_KEY("stands_out", "a pixel, or null: none does; `x`, `y`, `reference_cd_m2`, "
                             "`test_cd_m2`, `count` of such, `is_explained` (by its own noise)"),
    COLUMN_KEY("metadata", "key by key, what differs only: `name`, `reference`, `test`, `decides`, "
                           "`ignored`"),
    COLUMN_KEY("inputs_changed", "null: not stated"),
    COLUMN_KEY("settings_changed", NULL),
    COLUMN_KEY("kind", "`frame` or `picture`"),
    COLUMN_KEY("size", "absent, as all that follow: there are no pixels"),
    COLUMN_KEY("pixels", "that were compared"),
    COLUMN_KEY("differing_pixels", NULL),
    COLUMN_KEY("channels", "`name`, `differing`, `mean`, `max`, `nonfinite`, `gaps` of each"),
    COLUMN_KEY("shown_ev", "of the report's pictures; of frames, as `shown_with`"),
    COLUMN_KEY("shown_with", NULL),
    COLUMN_KEY("seconds", NULL)};
static const TableKind PAIR_KIND = TABLE_KIND("compare", NULL, PAIR);

static const Column FOLDERS[] = {COLUMN_KEY("same", "the exit status is 0"),
                                 COLUMN_KEY("outcome", "the worst of: " OUTCOMES ", `missing`, "
                                                       "`failed`"),
                                 COLUMN_KEY("verdict", "the headline"),
                                 COLUMN_KEY("total", NULL),
                                 COLUMN_KEY("equal", "that pass"),
                                 COLUMN_KEY("different", NULL),
                                 COLUMN_KEY("failed", NULL),
                                 COLUMN_KEY("pairs", "as of two files")};
static const TableKind FOLDERS_KIND = TABLE_KIND("folders", NULL, FOLDERS);

const Answer compare_answers[] = {{"", &PAIR_KIND}, {"FOLDER FOLDER", &FOLDERS_KIND}, {0}};

/* Into the file and to stdout, as far as they are requested. */
static bool print_answer(const CompareRequest *request, const TableKind *kind, json_t *answer,
                         Error *err) {
    bool as_json = request->cli.json;
    if ((request->answer && !cli_write_json(answer, request->answer, err)) ||
        !cli_print_answer(kind, json_incref(answer), as_json, err))
        return false;
    if (as_json) return true;
    if (request->report) print("report: %s\n", request->report);
    print("%s: %s\n", json_string_value(json_object_get(answer, "outcome")),
          json_string_value(json_object_get(answer, "verdict")));
    return true;
}

/* One line for a pair of two folders. */
static void print_line(const CompareRun *run, const char *outcome, const char *name,
                       const char *finding) {
    if (!run->request->cli.json) print("%-13s %s: %s\n", outcome, name, finding);
}

/* ---- two files --------------------------------------------------------------------------- */

static Outcome compare_two(CompareRun *run, Error *err) {
    const CompareRequest *r = run->request;
    Comparison c;
    if (!compare_files(r->reference, r->test, &r->options, run->arena, &c, err))
        return OUTCOME_FAILED;
    json_t *pair = answer_add(&run->answer, r->test, &c);
    if ((r->report && !html_report_add(&run->html, pair, &c, *run->arena, err)) ||
        !write_files(run, NULL, err) || !print_answer(r, &PAIR_KIND, pair, err))
        return OUTCOME_FAILED;
    return c.same ? OUTCOME_DONE : OUTCOME_NO;
}

/* ---- two folders ------------------------------------------------------------------------- */

static void add_missing(CompareRun *run, const char *name, bool is_in_test) {
    const json_t *pair = answer_add_missing(&run->answer, name, is_in_test);
    const char *verdict = json_string_value(json_object_get(pair, "verdict"));
    if (run->request->report) html_report_add_failure(&run->html, pair);
    print_line(run, "missing", name, strrchr(verdict, ':') + 2);
}

/* A pair that cannot be compared: said on stderr, and the others go on. */
static void add_failed(CompareRun *run, const char *name, const Error *error) {
    char line[2048];
    if (run->first_failure == ERROR_NONE) run->first_failure = error->code;
    cli_error_line(error, line, (int)sizeof line);
    print_to(stderr, "%s\n", line);
    const json_t *pair = answer_add_failed(&run->answer, name, line, error);
    if (run->request->report) html_report_add_failure(&run->html, pair);
    print_line(run, "failed", name, "see the error");
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
    CompareOptions options = *options_of(run->request, pair->name);
    Comparison c;
    Error why;
    options.name = pair->name;
    if (!compare_files(pair->reference, pair->test, &options, &arena, &c, &why)) {
        add_failed(run, pair->name, &why);
        return true;
    }
    const json_t *document = answer_add(&run->answer, pair->name, &c);
    print_line(run, compare_outcome_names[c.outcome], pair->name, c.finding);
    return !run->request->report || html_report_add(&run->html, document, &c, arena, err);
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
    if (pair->reference || !run->request->allow_extra)
        add_missing(run, pair->name, !pair->reference);
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
    if (run->answer.count == 0)
        return error_at(err, ERROR_INPUT, r->reference, "",
                        "there is no picture in this folder: nothing was compared");
    json_auto_t *folders = answer_json(&run->answer, *run->arena);
    if (!write_files(run, folders, err) || !print_answer(r, &FOLDERS_KIND, folders, err))
        return OUTCOME_FAILED;
    if (!run->answer.failed) return run->answer.different ? OUTCOME_NO : OUTCOME_DONE;
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
