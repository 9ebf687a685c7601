/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_share.h"

#include <string.h>

#include "base/count.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "kernel/kernel.h"

bool review_share_check(const ShareRequest *share, const char *not_traced, Error *err)
{
    if (share->parts)
        return !not_traced || error_set(err, ERROR_USAGE, "%s does not go with --slurm",
                                        not_traced);
    return !(share->submits || share->dir) ||
           error_set(err, ERROR_USAGE, "%s says how a review is shared — add --slurm N, the "
                                       "number of parts",
                     share->submits ? "--submit" : "--job");
}

/* How many words, this one first, a part has of its own. */
static int own_words(const char *word)
{
    static const struct {
        const char *name;
        bool        has_value;
    } own[] = {{"-o", true}, {"--slurm", true}, {"--job", true}, {"--submit", false},
               {"--threads", true}, {"--progress", true}, {"--json", false},
               {"--quiet", false}};
    for (int i = 0; i < COUNT_OF(own); i++)
        if (cli_is_option(word, own[i].name)) return cli_option_words(word, own[i].has_value);
    return 0;
}

void review_share_set(ShareRequest *share, int argc, char **argv, const char *output,
                      const Cli *cli, Arena *arena)
{
    bool has_options = true;
    if (!share->dir) share->dir = arena_format(arena, "%s.parts", output);
    share->split_name = "questions";
    share->threads = cli->threads_given ? cli->threads : 0;
    share->words = ARENA_NEW(arena, const char *, argc);
    for (int i = 1; i < argc; i++) {
        int skipped = has_options ? own_words(argv[i]) : 0;
        if (!strcmp(argv[i], "--")) has_options = false;
        if (skipped) i += skipped - 1;
        else share->words[share->word_count++] = argv[i];
    }
}

bool review_share(const ShareRequest *share, ReviewFolder *folder, ReviewRun *run, bool json,
                  Arena *arena, Error *err)
{
    ReviewPlan    found;
    const Kernel *kernel;
    json_t       *answer = NULL;
    review_folder_responses(folder, arena);
    run->responses = folder->responses;
    run->responses_shown = "";
    bool ok = review_plan(run, arena, &found, err) && kernel_choose(run->isa, &kernel, err);
    cli_print_warnings(run->problems);
    if (!ok) return false;
    SharedJob job = {.kind = JOB_REVIEW, .line = review_folder_command(folder, arena),
                     .output = folder->target, .identity = found.identity, .isa = kernel->isa};
    return job_share(share, &job, arena, json ? &answer : NULL, err) &&
           (!answer || cli_print_json(answer, err));
}
