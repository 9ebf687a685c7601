/* parhelion compare: are two frames, pictures or folders of them the same? */
#include <stdio.h>

#include "base/file.h"
#include "cli/compare_command.h"
#include "compare/report/comparison_json.h"
#include "compare/folders.h"
#include "compare/report/html_report.h"
#include "compare/report/junit.h"

#define MEMORY_BYTES ((size_t)64 << 30) /* address space; pages cost nothing until touched */

/* What is collected on the way, for every kind of answer. */
typedef struct Work {
    const CompareRequest *request;
    Arena     *arena;
    HtmlReport html;
    Junit      junit;
    json_t    *pairs; /* of folders */
    int        count, different, failed; /* failed: could not be compared */
    ErrorCode  first_failure;
} Work;

static Work start(const CompareRequest *request, bool is_folder, Arena *arena)
{
    return (Work){.request = request, .arena = arena, .html = {.is_folder = is_folder},
                  .pairs = json_array()};
}

static void end(Work *work)
{
    html_report_release(&work->html);
    junit_release(&work->junit);
    json_decref(work->pairs);
}

static bool collect(Work *work, const char *name, const Comparison *c, Arena scratch,
                    Error *err)
{
    work->count++;
    work->different += !c->same;
    if (work->request->junit) junit_add(&work->junit, name, c);
    return !work->request->report ||
           html_report_add(&work->html, name, c, &work->request->options, scratch, err);
}

static bool write_files(const Work *work, Error *err)
{
    const CompareRequest *r = work->request;
    if (r->report && !html_report_write(&work->html, r->reference, r->test, r->report, err))
        return false;
    return !r->junit || junit_write(&work->junit, "parhelion compare", r->junit, err);
}

/* The answer is on stdout: nothing more is to be said. */
static bool answered(ErrorCode code, Error *err)
{
    *err = (Error){.code = code};
    return code == ERROR_NONE;
}

/* ---- two files --------------------------------------------------------------------------- */

static bool compare_two(Work *work, Error *err)
{
    const CompareRequest *r = work->request;
    Comparison            c;
    if (!compare_files(r->reference, r->test, &r->options, work->arena, &c, err)) return false;
    if (!collect(work, r->test, &c, *work->arena, err) || !write_files(work, err)) return false;
    if (r->cli.json) {
        if (!cli_print_json(comparison_json(&c, &r->options), err)) return false;
    } else {
        compare_print_pair(r, &c);
    }
    return answered(c.same ? ERROR_NONE : ERROR_DIFFERENT, err);
}

/* ---- two folders ------------------------------------------------------------------------- */

static void add_pair_json(Work *work, const char *name, json_t *pair)
{
    json_object_set_new(pair, "name", json_of_text(name));
    json_array_append_new(work->pairs, pair);
}

/* A file that is on one side only. */
static void add_missing(Work *work, const char *name, const char *why)
{
    work->count++;
    work->different++;
    if (work->request->junit) junit_add_failure(&work->junit, name, why, false);
    if (work->request->report) html_report_add_failure(&work->html, name, why);
    if (!work->request->cli.json) printf("%-10s %s: %s\n", "different", name, why);
    add_pair_json(work, name, json_pack("{s:b, s:o, s:[o], s:[]}", "same", 0, "verdict",
                                        json_of_text(why), "reasons", json_of_text(why),
                                        "notes"));
}

/* A pair that cannot be compared: said on stderr, and the others go on. */
static void add_failed(Work *work, const char *name, const Error *error)
{
    char line[2048];
    work->count++;
    work->failed++;
    if (work->first_failure == ERROR_NONE) work->first_failure = error->code;
    cli_error_line(error, line, (int)sizeof line);
    fprintf(stderr, "%s\n", line);
    if (work->request->junit) junit_add_failure(&work->junit, name, line, true);
    if (work->request->report) html_report_add_failure(&work->html, name, line);
    if (!work->request->cli.json) printf("%-10s %s: see the error\n", "failed", name);
    add_pair_json(work, name,
                  json_pack("{s:b, s:[o], s:[], s:{s:i, s:o, s:o}}", "same", 0, "reasons",
                            json_of_text(line), "notes", "error", "status",
                            error_exit_status(error->code), "file", json_of_text(error->file),
                            "message", json_of_text(error->text)));
}

static bool add_compared(Work *work, const FolderPair *pair, Arena arena, Error *err)
{
    const CompareRequest *r = work->request;
    Comparison            c;
    Error                 why;
    if (!compare_files(pair->reference, pair->test, &r->options, &arena, &c, &why)) {
        add_failed(work, pair->name, &why);
        return true;
    }
    if (!collect(work, pair->name, &c, arena, err)) return false;
    if (r->cli.json) add_pair_json(work, pair->name, comparison_json(&c, &r->options));
    else compare_print_line(pair->name, &c);
    return true;
}

static bool add_pair(Work *work, const FolderPair *pair, Error *err)
{
    if (pair->reference && pair->test) return add_compared(work, pair, *work->arena, err);
    if (pair->reference) add_missing(work, pair->name, "is missing in the test");
    else if (!work->request->allow_extra)
        add_missing(work, pair->name,
                    "is only in the test (--allow-extra lets that pass)");
    return true;
}

static bool print_total(const Work *work, Error *err)
{
    int same = work->count - work->different - work->failed;
    if (work->request->cli.json)
        return cli_print_json(json_pack("{s:b, s:i, s:i, s:i, s:i, s:O}", "same",
                                        same == work->count, "total", work->count, "equal",
                                        same, "different", work->different, "failed",
                                        work->failed, "pairs", work->pairs),
                              err);
    if (work->request->report) printf("report: %s\n", work->request->report);
    printf("%s: %d of %d pairs are the same", same == work->count ? "same" : "different", same,
           work->count);
    if (work->different) printf(", %d differ", work->different);
    if (work->failed) printf(", %d could not be compared", work->failed);
    printf("\n");
    return true;
}

static bool compare_folders(Work *work, Error *err)
{
    const CompareRequest *r = work->request;
    FolderPairs           pairs;
    if (!folders_match(r->reference, r->test, work->arena, &pairs, err)) return false;
    Progress progress = progress_start(r->cli.progress, "compare", "pairs", pairs.count);
    for (int i = 0; i < pairs.count; i++) {
        progress_clear(&progress);
        if (!add_pair(work, &pairs.list[i], err)) return false;
        progress_update(&progress, i + 1);
    }
    progress_end(&progress, pairs.count);
    if (!write_files(work, err) || !print_total(work, err)) return false;
    if (work->failed) return answered(work->first_failure, err);
    return answered(work->different ? ERROR_DIFFERENT : ERROR_NONE, err);
}

static bool compare(const CompareRequest *request, Arena *arena, Error *err)
{
    bool both = is_folder(request->reference);
    if (is_folder(request->test) != both)
        return error_set(err, ERROR_USAGE, "%s is a folder and %s is not: wanted two files or "
                         "two folders", both ? request->reference : request->test,
                         both ? request->test : request->reference);
    if ((request->report && !file_check_writable(request->report, err)) ||
        (request->junit && !file_check_writable(request->junit, err)))
        return false;
    Work work = start(request, both, arena);
    bool ok = both ? compare_folders(&work, err) : compare_two(&work, err);
    end(&work);
    return ok;
}

bool cmd_compare(int argc, char **argv, Error *err)
{
    Arena          arena = arena_reserve(MEMORY_BYTES);
    CompareRequest request = {0};
    bool ok = compare_parse(argc, argv, &arena, &request, err) &&
              (request.cli.help_shown || compare(&request, &arena, err));
    arena_release(&arena);
    return ok;
}
